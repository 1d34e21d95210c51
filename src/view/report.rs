//! A report of errors in colour: what is wrong, where, and what would help.
//!
//! In: a line of a report. Out: its parts with their roles. Never here: the wording, or the wrapping.

use super::theme::Role;

/// The parts of a line: the kind of the report, the gutter beside the text of the file, the marks below it, and help.
pub(super) fn coloured(line: &str) -> Vec<(Role, String)> {
    let parts = |parts: &[(Role, &str)]| {
        parts.iter().map(|(role, text)| (*role, (*text).to_owned())).collect()
    };
    for (kind, role) in [("error", Role::Bad), ("warning", Role::Warn)] {
        if let Some(message) = line.strip_prefix(kind).filter(|rest| rest.starts_with(':')) {
            return parts(&[(role, kind), (Role::Title, message)]);
        }
    }
    let margin = line.len() - line.trim_start().len();
    let (blank, text) = line.split_at(margin);
    if text.starts_with("--> ") {
        return parts(&[(Role::Dim, line)]);
    }
    for label in ["= help: ", "= note: "] {
        if let Some(rest) = text.strip_prefix(label) {
            return parts(&[(Role::Dim, blank), (Role::Accent, label), (Role::Text, rest)]);
        }
    }
    let gutter = text.trim_start_matches(|c: char| c.is_ascii_digit()).trim_start();
    if let Some(source) = gutter.strip_prefix('|') {
        let (gutter, source) = line.split_at(line.len() - source.len());
        let marks = !source.trim().is_empty() && source.chars().all(|c| c == '^' || c == ' ');
        return parts(&[(Role::Dim, gutter), (if marks { Role::Bad } else { Role::Text }, source)]);
    }
    parts(&[(Role::Text, line)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_of_a_report_have_roles_of_their_own_and_stay_whole() {
        for (line, roles) in [
            ("error: unknown name `k`", &[Role::Bad, Role::Title][..]),
            ("  --> a.toml:3:1", &[Role::Dim]),
            ("   |", &[Role::Dim, Role::Text]),
            (" 3 | x = {}", &[Role::Dim, Role::Text]),
            ("   |     ^^^", &[Role::Dim, Role::Bad]),
            ("   = help: give it a value", &[Role::Dim, Role::Accent, Role::Text]),
            ("     of more words", &[Role::Text]),
            ("errors are many", &[Role::Text]),
        ] {
            let parts = coloured(line);
            assert_eq!(parts.iter().map(|(_, text)| text.as_str()).collect::<String>(), line);
            assert_eq!(parts.iter().map(|(role, _)| *role).collect::<Vec<_>>(), roles, "{line}");
        }
    }
}
