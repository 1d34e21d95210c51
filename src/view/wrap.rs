//! Wrapping: paragraphs and formulas in lines of a given width.
//!
//! In: text. Out: its lines. Never here: styles, or the positions of lines.

use unicode_width::UnicodeWidthChar;

use super::glyphs::TextWidth;

/// The lines of a paragraph, broken at spaces; a word longer than a line is broken anywhere.
pub fn words(text: &str, width: usize) -> Vec<String> {
    let spaced = |text: &str| text.contains("  ") || text.trim().len() < text.len();
    let plain = text.bytes().all(|byte| matches!(byte, b' '..=b'~'));
    if plain && (1..=width).contains(&text.len()) && !spaced(text) {
        return vec![text.to_owned()];
    }
    let piece = |word: &str| TextPiece { text: word.to_owned(), spaced: true, nested: 0 };
    fill(text.split_whitespace().map(piece), width, 0, 0)
}

/// The lines of a paragraph, at most `rows` of them: the last contains all the rest, so that the caller can mark the cut.
pub(super) fn words_in(text: &str, width: usize, rows: usize) -> Vec<String> {
    let mut lines = words(text, width);
    if lines.len() > rows {
        let rest = lines.split_off(rows.saturating_sub(1)).join(" ");
        lines.extend((rows > 0).then_some(rest));
    }
    lines
}

/// The text in `width` columns, with `mark` in place of the rest. It ends with a whole word and says something: no article
/// or preposition is left at its end, and no single word of a further clause. Where that would leave less than a third
/// of the width the last words stay; only where these are less too is a word torn.
pub(super) fn shortened(text: &str, width: usize, mark: &str) -> String {
    if text.width() <= width {
        return text.to_owned();
    }
    let Some(room) = width.checked_sub(mark.width()) else { return String::new() };
    let mut used = 0;
    let fits = |(_, character): &(usize, char)| {
        used += character.width().unwrap_or(0);
        used <= room
    };
    let end = text.char_indices().take_while(fits).map(|(at, c)| at + c.len_utf8()).last();
    let (torn, rest) = text.split_at(end.unwrap_or(0));
    let mut whole = torn.trim_end();
    if whole.len() == torn.len() && !rest.starts_with(char::is_whitespace) {
        whole = whole.rsplit_once(char::is_whitespace).map_or("", |(before, _)| before);
    }
    let words_only = whole;
    let words = |text: &str| text.split_whitespace().next_back().map(str::to_lowercase);
    while words(whole).is_some_and(|word| LINKS.contains(&word.as_str())) {
        whole = whole.rsplit_once(char::is_whitespace).map_or("", |(before, _)| before).trim_end();
    }
    if let Some((clause, further)) = whole.rsplit_once([',', ';'])
        && further.split_whitespace().count() < 2
    {
        whole = clause;
    }
    let whole = whole.trim_end_matches(|c: char| ",;:–—".contains(c) || c.is_whitespace());
    let enough = |text: &&str| 3 * text.width() >= room;
    let shown = [whole, words_only].into_iter().find(enough).unwrap_or_else(|| torn.trim_end());
    format!("{shown}{mark}")
}

/// The same with its last words in place of those in the middle.
pub(super) fn shortened_within(text: &str, width: usize, mark: &str) -> String {
    let mut ends =
        text.char_indices().filter(|(_, c)| c.is_whitespace()).map(|(at, _)| &text[at..]);
    let room = |end: &str| width.checked_sub(end.width() + mark.width() + 1);
    // Of the ends that leave as much room to the beginning the longest is taken.
    let end = ends.find(|end| room(end).is_some_and(|room| room >= end.width()));
    let Some(end) = end.filter(|_| text.width() > width) else {
        return shortened(text, width, mark);
    };
    let begin = shortened(text, width - end.width(), mark);
    format!("{begin}{end}")
}

/// The last words in `width` columns, with `mark` in place of those before, for a text of which others begin alike.
pub(super) fn ending(text: &str, width: usize, mark: &str) -> String {
    let mut ends =
        text.char_indices().filter(|(_, c)| c.is_whitespace()).map(|(at, _)| &text[at..]);
    let fits = |end: &&str| end.trim_start().width() + mark.width() <= width;
    let end = ends.find(fits).filter(|_| text.width() > width);
    end.map_or_else(|| shortened(text, width, mark), |end| format!("{mark}{}", end.trim_start()))
}

/// Words that a shortened text does not end with.
const LINKS: &[&str] = &[
    "=", "+", "−", "a", "about", "along", "an", "and", "as", "at", "by", "for", "from", "if", "in",
    "is", "its", "of", "on", "one", "or", "per", "that", "the", "their", "through", "to", "when",
    "where", "which", "with",
];

/// A line of an error report: a message is wrapped, below its first word if it is a note; source text and its marks
/// stay as they are, because they stand in columns.
pub(super) fn report_line(line: &str, width: usize) -> Vec<String> {
    let body = line.trim_start();
    let margin = line.width() - body.width();
    let indent = ["= help: ", "= note: "]
        .into_iter()
        .find(|label| body.starts_with(label))
        .map_or(2, str::len);
    let message = indent > 2
        || (margin == 0 && ["error: ", "warning: "].iter().any(|label| body.starts_with(label)));
    let room = width.saturating_sub(margin + indent);
    if line.width() <= width || !message || room == 0 {
        return vec![line.to_owned()];
    }
    let (label, text) = if indent > 2 { body.split_at(indent) } else { ("", body) };
    let lines = words(text, room).into_iter().enumerate();
    let lead = if label.is_empty() { 0 } else { margin };
    lines
        .map(|(i, text)| match i {
            0 => format!("{:lead$}{label}{text}", ""),
            _ => format!("{:1$}{text}", "", margin + indent),
        })
        .collect()
}

/// The text with its first letter capitalised.
pub(super) fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// The lines of a formula, broken before `+`, `−` and `=`: outside all parentheses if that suffices, else between factors
/// that are parentheses, else inside these, where a line begins further right, else at spaces and before `*`. All lines but
/// the first are indented.
pub(super) fn formula(text: &str, width: usize, indent: usize) -> Vec<String> {
    formula_after(text, width, 0, indent)
}

/// The lines of a formula whose first line begins after `first` columns, with an indent of the others that leaves its terms
/// whole where one of these does.
pub(super) fn formula_beside(
    text: &str,
    width: usize,
    first: usize,
    indents: [usize; 2],
) -> Vec<String> {
    let [wide, narrow] = indents;
    let whole = terms(text, 0).iter().all(|term| term.width() + wide <= width);
    formula_after(text, width, first, if whole { wide } else { narrow })
}

fn formula_after(text: &str, width: usize, first: usize, indent: usize) -> Vec<String> {
    let mut pieces = Vec::new();
    for (place, term) in terms(text, 0).iter().enumerate() {
        let before = if place == 0 { first.max(indent) } else { indent };
        break_up(term, width.saturating_sub(before).max(1), [0, 0], &mut pieces);
    }
    fill(pieces.into_iter(), width, first, indent)
}

/// The depth of parentheses down to which a formula is broken before its operators.
const DEEPEST: usize = 6;

/// How much further right a line begins for each parenthesis that is open.
const NESTED: usize = 2;

/// Cuts a formula into pieces that fit, at a depth of parentheses whose lines begin so much further right.
pub(super) fn break_up(
    text: &str,
    room: usize,
    [depth, nested]: [usize; 2],
    pieces: &mut Vec<TextPiece>,
) {
    let fits = |text: &str| text.width() + nested <= room;
    for term in terms(text, depth) {
        if fits(&term) {
            pieces.push(TextPiece { text: term, spaced: true, nested });
        } else if depth >= DEEPEST || nested + NESTED >= room {
            for (i, factor) in factors(&term).into_iter().enumerate() {
                // There is no space after a `*` sign.
                let spaced = i == 0 || factor.starts_with(' ');
                pieces.push(TextPiece { text: factor.trim_start().to_owned(), spaced, nested });
            }
        } else {
            // A parenthesis stays whole if a line of its own suffices.
            for (place, part) in signed(parts(&term, depth), fits).into_iter().enumerate() {
                let spaced = place == 0 || !part.starts_with('*');
                if fits(&part) {
                    pieces.push(TextPiece { text: part, spaced, nested });
                    continue;
                }
                let begins = pieces.len();
                let inside = terms(&part, depth + 1).len() > 1 || parts(&part, depth + 1).len() > 1;
                let nested_more = nested + if inside { NESTED } else { 0 };
                break_up(&part, room, [depth + 1, nested_more], pieces);
                if let Some(piece) = pieces.get_mut(begins) {
                    (piece.nested, piece.spaced) = (nested, spaced);
                }
            }
        }
    }
}

/// The parts of a term of a sum, of which the first two are one where they fit: a line that ended with `+ g` would end with a term.
fn signed(mut parts: Vec<String>, fits: impl Fn(&str) -> bool) -> Vec<String> {
    if let [first, second, ..] = &parts[..]
        && first.starts_with(['+', '−', '-'])
        && first.contains(' ')
    {
        let space = if second.starts_with('*') { "" } else { " " };
        let both = format!("{first}{space}{second}");
        if fits(&both) {
            parts[0] = both;
            parts.remove(1);
        }
    }
    parts
}

/// Cuts a formula before each `+`, `−`, `-` and `=` between spaces that is at most `depth` deep in parentheses.
fn terms(text: &str, depth: usize) -> Vec<String> {
    cut(text, depth, |_, word| matches!(word, "+" | "−" | "-" | "="))
}

/// Cuts a term before and after each factor that is a parenthesis, and after each comma, at most `depth` deep; a term without
/// such spaces before each `*` there.
fn parts(term: &str, depth: usize) -> Vec<String> {
    let opens = |word: &str| word.trim_start_matches('√').starts_with(['(', '[']);
    let closes = |word: &str| {
        let base = word.trim_end_matches(|c: char| "⁰¹²³⁴⁵⁶⁷⁸⁹⁻".contains(c) || c.is_ascii_digit());
        base.trim_end_matches('^').ends_with([')', ']'])
    };
    let operator = |word: &str| matches!(word, "+" | "−" | "-" | "=" | "/" | "*" | "·");
    let parts = cut(term, depth, |before, word| {
        before.ends_with(',') || !operator(before) && (opens(word) || closes(before))
    });
    if parts.len() > 1 {
        return parts;
    }
    let mut factors = vec![String::new()];
    let mut open = 0_usize;
    for character in term.chars() {
        open += usize::from(matches!(character, '(' | '['));
        open = open.saturating_sub(usize::from(matches!(character, ')' | ']')));
        if character == '*' && open <= depth {
            factors.push(String::new());
        }
        if let Some(factor) = factors.last_mut() {
            factor.push(character);
        }
    }
    factors
}

/// Cuts a text at its spaces, at most `depth` deep in parentheses, where the words before and after are to be separated.
fn cut(text: &str, depth: usize, is_cut: impl Fn(&str, &str) -> bool) -> Vec<String> {
    let mut pieces: Vec<String> = Vec::new();
    let (mut open, mut before) = (0_usize, "");
    // the parentheses that were open where an exponent began
    let mut exponent: Option<usize> = None;
    for word in text.split(' ').filter(|word| !word.is_empty()) {
        match pieces.last_mut() {
            Some(piece) if open > depth || exponent.is_some() || !is_cut(before, word) => {
                piece.push(' ');
                piece.push_str(word);
            }
            _ => pieces.push(word.to_owned()),
        }
        let mut last = ' ';
        for character in word.chars() {
            match character {
                '(' | '[' => {
                    exponent = exponent.or((last == '^').then_some(open));
                    open += 1;
                }
                ')' | ']' => {
                    open = open.saturating_sub(1);
                    exponent = exponent.filter(|&outside| open > outside);
                }
                _ => {}
            }
            last = character;
        }
        before = word;
    }
    pieces
}

/// Cuts a long term at its spaces, which stay in front of the next piece, and before each `*`.
fn factors(term: &str) -> Vec<String> {
    let mut factors = vec![String::new()];
    for character in term.chars() {
        if matches!(character, ' ' | '*') {
            factors.push(String::new());
        }
        if let Some(factor) = factors.last_mut() {
            factor.push(character);
        }
    }
    factors
}

/// A part of a text that stays on one line.
pub(super) struct TextPiece {
    pub(super) text: String,
    /// Whether a space precedes it on the same line.
    pub(super) spaced: bool,
    /// How much further right a line that begins with it begins.
    pub(super) nested: usize,
}

/// Fills lines with pieces, the first after `first` columns.
pub(super) fn fill(
    pieces: impl Iterator<Item = TextPiece>,
    width: usize,
    first: usize,
    indent: usize,
) -> Vec<String> {
    let width = width.max(1);
    let mut lines: Vec<String> = vec![String::new()];
    let mut fresh = true;
    for TextPiece { text, spaced, nested } in pieces {
        let mut piece = text;
        let indent = (indent + nested).min(width / 2);
        loop {
            let (before, margin) = if lines.len() > 1 { (0, indent) } else { (first, 0) };
            let Some(line) = lines.last_mut() else { break };
            let gap = usize::from(spaced && !fresh);
            if fresh && line.is_empty() {
                line.push_str(&" ".repeat(margin));
            }
            if before + line.width() + gap + piece.width() <= width {
                line.push_str(&" ".repeat(gap));
                line.push_str(&piece);
                fresh = false;
                break;
            }
            if !fresh {
                lines.push(String::new());
                fresh = true;
                continue;
            }
            // The piece is alone on its line and still too long, so it is cut between letters.
            let room = width.saturating_sub(before + line.width()).max(1);
            let (head, rest) = split(&piece, room);
            line.push_str(&head);
            if rest.is_empty() {
                fresh = false;
                break;
            }
            lines.push(String::new());
            piece = rest;
        }
    }
    lines
}

/// Splits off the first `room` columns of a text, at least one character.
fn split(text: &str, room: usize) -> (String, String) {
    let mut head = String::new();
    for (index, character) in text.char_indices() {
        let longer = format!("{head}{character}");
        if longer.width() > room && !head.is_empty() {
            return (head, text[index..].to_owned());
        }
        head = longer;
    }
    (head, String::new())
}

#[cfg(test)]
mod tests {
    use super::{ending, formula, report_line, shortened, shortened_within};

    #[test]
    fn a_shortened_text_ends_with_a_word_that_says_something() {
        let short = |text: &str, width: usize| shortened(text, width, "…");
        assert_eq!(short("energy", 6), "energy");
        assert_eq!(short("areal velocity seen from above", 28), "areal velocity seen…");
        assert_eq!(short("moment of inertia about an axis", 27), "moment of inertia…");
        assert_eq!(short("Charge in electric and magnetic fields", 30), "Charge in electric…");
        for width in 11..19 {
            assert_eq!(short("A Aᵀ = 1, det A = 1", width), "A Aᵀ = 1…", "{width}");
        }
        assert_eq!(short("centre of mass along x", 15), "centre of mass…");
        assert_eq!(short("moment of inertia about a transverse axis", 36), "moment of inertia…");
        assert_eq!(short("moment on the bearing", 17), "moment…");
        assert_eq!(short("work of the hinge, when the pin holds", 17), "work of the…");
        // A single word is torn, and so is one after too little.
        assert_eq!(short("Phasenraumvolumen", 9), "Phasenra…");
        assert_eq!(short("a Phasenraumvolumen", 9), "a Phasen…");
        assert_eq!([short("energy", 1), short("energy", 0)], ["…", ""]);
    }

    #[test]
    fn texts_that_begin_alike_keep_their_ends() {
        let short = |text: &str, width: usize| shortened_within(text, width, "…");
        assert_eq!(short("centre of mass along x", 17), "centre of mass… x");
        assert_eq!(short("centre of mass along x", 22), "centre of mass along x");
        for width in 0..24 {
            for text in ["centre of mass along x", "x", "", " ", "a bc def ghij klmnop"] {
                let short = short(text, width);
                assert!(unicode_width::UnicodeWidthStr::width(&*short) <= width, "{short} {width}");
            }
        }
    }

    #[test]
    fn an_ending_is_whole_words_after_the_mark() {
        let title = "Charge in the field of a magnetic dipole";
        assert_eq!(ending(title, 27, "…"), "…field of a magnetic dipole");
        assert_eq!(ending(title, 26, "…"), "…of a magnetic dipole");
        assert_eq!(ending(title, 40, "…"), title);
        assert_eq!(ending("unbroken", 5, "…"), "unbr…");
    }

    #[test]
    fn a_formula_is_broken_between_its_parentheses_before_it_is_inside_them() {
        let broken = |text: &str, width: usize| formula(text, width, 2);
        assert_eq!(broken("a = (b + c) (d + e)", 30), ["a = (b + c) (d + e)"]);
        assert_eq!(broken("a = √(b + c)² (d + e)", 14), ["a = √(b + c)²", "  (d + e)"]);
        // A function stays with its argument, a quotient with its denominator.
        assert_eq!(broken("(b + c) sin θ/(d + e)", 14), ["(b + c)", "  sin θ/(d", "    + e)"]);
        // So is a product of the files.
        let product = "m*l1*l2*theta1'*cos(theta1 - theta2)";
        assert_eq!(broken(product, 24), ["m*l1*l2*theta1'", "  *cos(theta1 - theta2)"]);
        // What is inside a parenthesis begins further right.
        let long = "a (b c d + e f g (h + i) + j k l)";
        assert_eq!(broken(long, 16), ["a (b c d + e f g", "    (h + i)", "    + j k l)"]);
        assert_eq!(broken("min(max(t/T, 0), 1)³ x", 16), ["min(max(t/T, 0),", "    1)³ x"]);
        for width in 1..40 {
            let lines = broken(long, width);
            assert_eq!(lines.concat().replace(' ', ""), long.replace(' ', ""), "{width}");
        }
    }

    #[test]
    fn a_report_wraps_its_messages_and_never_its_source() {
        let note = "  = help: write a product with a sign";
        let lines = ["  = help: write a product", "          with a sign"];
        assert_eq!(report_line(note, 26), lines);
        assert_eq!(report_line(note, note.len()), [note]);
        let error = "error: a word too many here";
        assert_eq!(report_line(error, 20), ["error: a word too", "  many here"]);
        for source in
            ["11 | L = \"a long line of = help: text\"", "   |           ^^^^^^^^^^^^^^^^"]
        {
            assert_eq!(report_line(source, 12), [source]);
        }
    }
}
