//! Emphasis in the notes of a file: `*words*` and `` `what is typed` ``.
//!
//! In: a paragraph. Out: the same paragraph with marks of no width in place of the signs, so that it is wrapped by what
//! is seen, and the spans of its lines. Never here: the styles, or the wrapping.

use ratatui::style::Style;

use super::canvas::StyledText;

/// Marks of no width: emphasis begins or ends, and what is typed begins or ends.
const EMPHASIS: char = '\u{2061}';
const TYPED: char = '\u{2060}';

/// The paragraph with marks in place of its signs. A sign that has no partner stays, as a product does: `2*x`.
pub(super) fn marked(text: &str) -> String {
    let typed = paired(text, '`', TYPED, |_, _| true);
    let word = |c: Option<char>| c.is_some_and(char::is_alphanumeric);
    paired(&typed, '*', EMPHASIS, |before, after| {
        let opens = !word(before) && word(after);
        let closes = word(before) && !word(after);
        opens || closes
    })
}

/// The text with every pair of signs that `stands` allows by its neighbours replaced by a mark.
fn paired(
    text: &str,
    sign: char,
    mark: char,
    stands: impl Fn(Option<char>, Option<char>) -> bool,
) -> String {
    let at: Vec<usize> = (text.match_indices(sign).map(|(at, _)| at))
        .filter(|&at| {
            let before = text[..at].chars().next_back();
            stands(before, text[at + sign.len_utf8()..].chars().next())
        })
        .collect();
    let mut out = String::new();
    let mut from = 0;
    for pair in at.chunks_exact(2) {
        for &at in pair {
            out.push_str(&text[from..at]);
            out.push(mark);
            from = at + sign.len_utf8();
        }
    }
    out.push_str(&text[from..]);
    out
}

#[derive(Clone, Copy)]
pub(super) struct Styles {
    pub(super) plain: Style,
    pub(super) emphasis: Style,
    pub(super) typed: Style,
}

/// The lines of a marked paragraph as spans, without the marks.
pub(super) fn spans(lines: Vec<String>, styles: Styles) -> Vec<Vec<StyledText>> {
    let (mut emphasis, mut typed) = (false, false);
    let line = |line: String| {
        let mut spans: Vec<StyledText> = Vec::new();
        let mut rest = line.as_str();
        while !rest.is_empty() {
            let end = rest.find([EMPHASIS, TYPED]).unwrap_or(rest.len());
            let style = match (typed, emphasis) {
                (true, _) => styles.typed,
                (false, true) => styles.emphasis,
                (false, false) => styles.plain,
            };
            if end > 0 {
                spans.push((rest[..end].to_owned(), style));
            }
            let mut after = rest[end..].chars();
            match after.next() {
                Some(EMPHASIS) => emphasis = !emphasis,
                Some(_) => typed = !typed,
                None => {}
            }
            rest = after.as_str();
        }
        spans
    };
    lines.into_iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_in_pairs_are_marks_and_products_are_not() {
        let shown = |text: &str| marked(text).replace(EMPHASIS, "<>").replace(TYPED, "[]");
        assert_eq!(shown("the pane *Action variable* has"), "the pane <>Action variable<> has");
        assert_eq!(shown("*Action*: least"), "<>Action<>: least");
        assert_eq!(shown("2*x and x*y"), "2*x and x*y");
        assert_eq!(shown("one * alone"), "one * alone");
        assert_eq!(
            shown("run `phaselab flow x --until 3` (`m`)"),
            "run []phaselab flow x --until 3[] ([]m[])"
        );
        assert_eq!(shown("an odd ` stays"), "an odd ` stays");
    }

    #[test]
    fn a_style_lasts_from_line_to_line() {
        let [plain, emphasis, typed] =
            [Style::new(), Style::new().bold(), Style::new().underlined()];
        let lines = super::super::wrap::words(&marked("so *one two* ends"), 7);
        assert_eq!(lines.len(), 3, "{lines:?}");
        let spans = spans(lines, Styles { plain, emphasis, typed });
        let expected = [
            vec![("so ".to_owned(), plain), ("one".to_owned(), emphasis)],
            vec![("two".to_owned(), emphasis), (" ".to_owned(), plain)],
        ];
        assert_eq!(spans[0], expected[0]);
        assert_eq!(spans[1][0], expected[1][0]);
    }
}
