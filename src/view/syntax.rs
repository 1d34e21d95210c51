//! The parts of a line of TOML in the editor: tables, keys, texts, numbers and comments.
//!
//! In: a line, and the text of several lines in which it begins. Out: the role of each character. Never here: colours.

use super::theme::Role;

/// What begins and ends a text of several lines.
const LONG_TEXTS: [&str; 2] = ["\"\"\"", "'''"];

/// The mark that began the text of several lines in which a line begins, if it begins within one.
pub(super) type LongText = Option<&'static str>;

/// The text of several lines that goes on after these lines.
pub(super) fn long_text_after<'a>(lines: impl Iterator<Item = &'a str>) -> LongText {
    lines.fold(None, |within, line| {
        let marks = within.as_slice();
        let marks = if marks.is_empty() { &LONG_TEXTS } else { marks };
        let may_change = marks.iter().any(|mark| line.contains(mark));
        if may_change { roles(line, within).1 } else { within }
    })
}

/// The role of each character of a line, and the text of several lines that goes on after it; prose, within such a
/// text, is plain.
pub(super) fn roles(line: &str, mut within: LongText) -> (Vec<Role>, LongText) {
    let letters: Vec<char> = line.chars().collect();
    let mut roles = vec![Role::Text; letters.len()];
    let code = line.split('#').next().unwrap_or_default().trim();
    let is_code = within.is_none();
    let is_table =
        is_code && code.starts_with('[') && code.ends_with(']') && !code.contains(['"', ',']);
    // keys stand before an equals sign, at the beginning of a line or within braces
    let mut is_key = is_code && line.contains('=') && !is_table;
    let mut quote = None;
    let mut in_number = false;
    let mut column = 0;
    while let Some(&c) = letters.get(column) {
        let escapes = c == '\\' && (quote == Some('"') || within == Some(LONG_TEXTS[0]));
        let mark = if quote.is_none() { mark_at(&letters[column..]) } else { None };
        if let Some(mark) = mark.filter(|mark| within.is_none_or(|within| within == *mark)) {
            within = if within.is_none() { Some(mark) } else { None };
            let end = column + mark.len();
            roles[column..end].fill(Role::Good);
            column = end;
            continue;
        }
        roles[column] = match (quote, c) {
            _ if within.is_some() => Role::Text,
            (Some(open), _) => {
                if c == open {
                    quote = None;
                }
                Role::Good
            }
            (None, '"' | '\'') => {
                quote = Some(c);
                Role::Good
            }
            (None, '#') => {
                roles[column..].fill(Role::Dim);
                break;
            }
            _ if is_table => Role::Title,
            (None, '=') => {
                is_key = false;
                Role::Dim
            }
            (None, '{' | ',') => {
                is_key = letters[column..].contains(&'=') && letters[..column].contains(&'{')
                    || c == '{';
                Role::Dim
            }
            (None, '}' | '[' | ']') => Role::Dim,
            _ if is_key => Role::Text,
            _ => {
                let before = column.checked_sub(1).map(|at| letters[at]);
                let begins = before.is_none_or(|before| !before.is_alphanumeric() && before != '_');
                let goes_on = in_number && (c.is_alphanumeric() || "._+-".contains(c));
                let signed =
                    "+-".contains(c) && letters.get(column + 1).is_some_and(char::is_ascii_digit);
                in_number = goes_on || begins && (c.is_ascii_digit() || signed);
                if in_number { Role::Accent } else { Role::Text }
            }
        };
        in_number &= roles[column] == Role::Accent;
        // what is escaped ends nothing
        if escapes && column + 1 < letters.len() {
            column += 1;
            roles[column] = roles[column - 1];
        }
        column += 1;
    }
    (roles, within)
}

/// The mark of a text of several lines with which these characters begin.
fn mark_at(letters: &[char]) -> LongText {
    let begins =
        |mark: &&str| letters.len() >= mark.len() && mark.chars().eq(letters[..3].iter().copied());
    LONG_TEXTS.into_iter().find(begins)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One letter for each character: `t`ext, `T`able, `s`tring, `n`umber, `-` for what is dim.
    fn letters(line: &str) -> String {
        let letter = |role| match role {
            Role::Title => 'T',
            Role::Good => 's',
            Role::Accent => 'n',
            Role::Dim => '-',
            _ => 't',
        };
        roles(line, None).0.into_iter().map(letter).collect()
    }

    #[test]
    fn each_part_has_its_role() {
        let check = |line: &str, expected: &str| assert_eq!(letters(line), expected, "{line}");
        check("[parameters]", "TTTTTTTTTTTT");
        check("[[views]] # x", "TTTTTTTTTT---");
        check("  [1, 2],", "tt-n-tn--");
        check("l = 1.5e-3 # m", "tt-tnnnnnnt---");
        check("L = \"x' # 2\"", "tt-tssssssss");
        check("x2 = { min = -1, b = 'a' }", "ttt-t-ttttt-tnn-ttt-tssst-");
        check("flag = true", "ttttt-ttttt");
    }

    /// For each line whether it begins within a text of several lines.
    fn within(text: &[&str]) -> Vec<bool> {
        let before = |row: usize| long_text_after(text[..row].iter().copied());
        (0..text.len()).map(|row| before(row).is_some()).collect()
    }

    #[test]
    fn prose_is_plain() {
        let text = ["notes = \"\"\"", "It's 2 rad # not a comment", "\"\"\"", "m = 1"];
        assert_eq!(within(&text), [false, true, true, false]);
        let (prose, after) = roles(text[1], Some(LONG_TEXTS[0]));
        assert!(prose.iter().all(|role| *role == Role::Text) && after.is_some());
    }

    #[test]
    fn a_text_ends_at_the_mark_that_began_it() {
        let jerk = ["notes = \"\"\"", "the jerk x'''", "\"\"\"", "[parameters]"];
        assert_eq!(within(&jerk), [false, true, true, false]);
        let literal = ["notes = '''", "a \"\"\" within", "''' # \"\"\"", "m = 1"];
        assert_eq!(within(&literal), [false, true, true, false]);
        assert_eq!(within(&["# \"\"\"", "m = 1"]), [false, false]);
        assert_eq!(within(&["a = \"'''\"", "m = 1"]), [false, false]);
        assert_eq!(within(&["a = \"\"\"b\"\"\"", "m = 1"]), [false, false]);
        assert_eq!(
            within(&["a = \"\"\"", "\\\"\"\" b", "\"\"\"", "m = 1"]),
            [false, true, true, false]
        );
    }

    #[test]
    fn a_quote_may_be_escaped() {
        assert_eq!(letters(r#"a = "b\"c" # d"#), "tt-tsssssst---");
        assert_eq!(letters(r#"a = "b\\" # d"#), "tt-tssssst---");
    }
}
