//! Keys by name, as a script writes them.
//!
//! In: `Tab`, `Shift-Left`, `Ctrl-r`, `F1`, `z`. Out: a [`Key`]. Never here: what it does.

use crate::app::{Code, Key};
use crate::diagnostic::nearest;

/// The names of keys that are not one character.
const NAMES: [(&str, Code); 18] = [
    ("Enter", Code::Enter),
    ("Esc", Code::Esc),
    ("Escape", Code::Esc),
    ("Tab", Code::Tab),
    ("Space", Code::Char(' ')),
    ("Backspace", Code::Backspace),
    ("Delete", Code::Delete),
    ("Up", Code::Up),
    ("Down", Code::Down),
    ("Left", Code::Left),
    ("Right", Code::Right),
    ("Home", Code::Home),
    ("End", Code::End),
    ("PgUp", Code::PageUp),
    ("PgDn", Code::PageDown),
    ("PageUp", Code::PageUp),
    ("PageDown", Code::PageDown),
    ("Hash", Code::Char('#')),
];

/// The key of a name, or the nearest name there is.
pub(super) fn named(name: &str) -> Result<Key, Option<String>> {
    let (mut key, mut rest) = (Key::plain(Code::Esc), name);
    while let Some((modifier, behind)) =
        rest.split_once(['-', '+']).filter(|(m, b)| !m.is_empty() && !b.is_empty())
    {
        match modifier {
            "Ctrl" => key.ctrl = true,
            "Alt" => key.alt = true,
            "Shift" => key.shift = true,
            other => return Err(nearest(other, ["Ctrl", "Alt", "Shift"]).map(str::to_owned)),
        }
        rest = behind;
    }
    let mut characters = rest.chars();
    key.code = match (characters.next(), characters.next()) {
        (Some(one), None) => Code::Char(one),
        _ => code(rest).ok_or_else(|| {
            let near = nearest(rest, NAMES.iter().map(|(name, _)| *name))?;
            Some(format!("{}{near}", &name[..name.len() - rest.len()]))
        })?,
    };
    // Shift is part of a character.
    if let (Code::Char(c), true) = (key.code, key.shift) {
        (key.code, key.shift) = (Code::Char(c.to_ascii_uppercase()), false);
    }
    Ok(key)
}

fn code(name: &str) -> Option<Code> {
    let named = NAMES.iter().find(|(known, _)| *known == name).map(|(_, code)| *code);
    named.or_else(|| {
        let number = name.strip_prefix('F')?.parse().ok()?;
        (1..=12).contains(&number).then_some(Code::F(number))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_have_names() {
        let check = |name: &str, expected: Key| assert_eq!(named(name), Ok(expected), "{name}");
        check("Tab", Key::plain(Code::Tab));
        check("Shift-Tab", Key::shift(Code::Tab));
        check("Ctrl+r", Key::ctrl('r'));
        check("Shift-z", Key::char('Z'));
        check("-", Key::char('-'));
        check("+", Key::char('+'));
        check("[", Key::char('['));
        check("F1", Key::plain(Code::F(1)));
        assert_eq!(named("Entr"), Err(Some("Enter".to_owned())));
        assert_eq!(named("Shift-Lft"), Err(Some("Shift-Left".to_owned())));
        assert_eq!(named("F13").ok(), None);
    }
}
