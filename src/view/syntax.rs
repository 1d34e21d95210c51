//! The parts of a line of TOML in the editor: tables, keys, texts, numbers and comments.
//!
//! In: a line, and whether it begins within a text of several lines. Out: the role of each character. Never here: colours.

use super::theme::Role;

/// What begins and ends a text of several lines.
const LONG_TEXTS: [&str; 2] = ["\"\"\"", "'''"];

/// Whether the line that follows these is within a text of several lines.
pub(super) fn is_within_text<'a>(lines: impl Iterator<Item = &'a str>) -> bool {
    let marks =
        |line: &str| LONG_TEXTS.map(|mark| line.matches(mark).count()).iter().sum::<usize>();
    lines.map(marks).sum::<usize>() % 2 == 1
}

/// The role of each character of a line; prose, within a text of several lines, is plain.
pub(super) fn roles(line: &str, within_text: bool) -> Vec<Role> {
    if within_text {
        return vec![Role::Text; line.chars().count()];
    }
    let letters: Vec<char> = line.chars().collect();
    let mut roles = vec![Role::Text; letters.len()];
    let code = line.split('#').next().unwrap_or_default().trim();
    let is_table = code.starts_with('[') && code.ends_with(']') && !code.contains(['"', ',']);
    // keys stand before an equals sign, at the beginning of a line or within braces
    let mut is_key = line.contains('=') && !is_table;
    let mut quote = None;
    let mut in_number = false;
    for (column, &c) in letters.iter().enumerate() {
        roles[column] = match (quote, c) {
            (Some(open), _) => {
                let escaped = open == '"' && column > 0 && letters[column - 1] == '\\';
                if c == open && !escaped {
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
                return roles;
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
    }
    roles
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
        roles(line, false).into_iter().map(letter).collect()
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

    #[test]
    fn prose_is_plain() {
        let text = ["notes = \"\"\"", "It's 2 rad # not a comment", "\"\"\"", "m = 1"];
        let within: Vec<bool> =
            (0..text.len()).map(|row| is_within_text(text[..row].iter().copied())).collect();
        assert_eq!(within, [false, true, true, false]);
        assert!(roles(text[1], true).iter().all(|role| *role == Role::Text));
    }

    #[test]
    fn a_quote_may_be_escaped() {
        assert_eq!(letters(r#"a = "b\"c" # d"#), "tt-tsssssst---");
    }
}
