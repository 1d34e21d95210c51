//! Key notation: keys as the help, the README and scripts write them.
//!
//! In: crossterm's [`KeyEvent`]s, or their names: `z`, `Tab`, `Shift-Left`, `Ctrl-r`, `F1`. Out: the other of the
//! two.
//! Never here: what a key does, or how a terminal sends it.

use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyEventState, KeyModifiers};

use crate::diagnostic::nearest;

/// The names of keys that are not one character. If a key has several names, the first one is shown.
const NAMES: [(&str, KeyCode); 22] = [
    ("Enter", KeyCode::Enter),
    ("Esc", KeyCode::Esc),
    ("Escape", KeyCode::Esc),
    ("Tab", KeyCode::Tab),
    ("Space", KeyCode::Char(' ')),
    ("Backspace", KeyCode::Backspace),
    ("Delete", KeyCode::Delete),
    ("↑", KeyCode::Up),
    ("↓", KeyCode::Down),
    ("←", KeyCode::Left),
    ("→", KeyCode::Right),
    ("Up", KeyCode::Up),
    ("Down", KeyCode::Down),
    ("Left", KeyCode::Left),
    ("Right", KeyCode::Right),
    ("Home", KeyCode::Home),
    ("End", KeyCode::End),
    ("PgUp", KeyCode::PageUp),
    ("PgDn", KeyCode::PageDown),
    ("PageUp", KeyCode::PageUp),
    ("PageDown", KeyCode::PageDown),
    ("Hash", KeyCode::Char('#')),
];

/// Modifiers in the order in which they are written.
const MODIFIERS: [(&str, KeyModifiers); 3] =
    [("Ctrl", KeyModifiers::CONTROL), ("Alt", KeyModifiers::ALT), ("Shift", KeyModifiers::SHIFT)];

/// A typed character. As everywhere in crossterm, a capital letter carries Shift.
pub fn character(character: char) -> KeyEvent {
    let shift = if character.is_uppercase() { KeyModifiers::SHIFT } else { KeyModifiers::NONE };
    KeyEvent::new(KeyCode::Char(character), shift)
}

/// Normalizes a key to its first press: a repetition counts as a press, and lock states are dropped. Returns `None`
/// if the key was released.
pub fn pressed(key: KeyEvent) -> Option<KeyEvent> {
    let key = KeyEvent { state: KeyEventState::NONE, ..key };
    (!key.is_release()).then_some(KeyEvent { kind: KeyEventKind::Press, ..key })
}

/// Returns the name of a key.
pub fn name(key: &KeyEvent) -> String {
    let (code, mut modifiers) = match key.code {
        KeyCode::BackTab => (KeyCode::Tab, key.modifiers | KeyModifiers::SHIFT),
        code => (code, key.modifiers),
    };
    if let KeyCode::Char(_) = code {
        // The character already implies Shift.
        modifiers.remove(KeyModifiers::SHIFT);
    }
    let mut name = String::new();
    for (written, _) in MODIFIERS.iter().filter(|(_, pressed)| modifiers.contains(*pressed)) {
        name += &format!("{written}-");
    }
    name + &match code {
        KeyCode::Char(' ') => "Space".to_owned(),
        KeyCode::Char(c) => c.to_string(),
        KeyCode::F(number) => format!("F{number}"),
        code => {
            let known = NAMES.iter().find(|(_, known)| *known == code);
            known.map_or_else(|| code.to_string(), |(name, _)| (*name).to_owned())
        }
    }
}

/// Returns the key of a name.
///
/// # Errors
/// Returns the nearest known name, if one is close.
pub fn named(name: &str) -> Result<KeyEvent, Option<String>> {
    let (mut modifiers, mut rest) = (KeyModifiers::NONE, name);
    while let Some((modifier, behind)) =
        rest.split_once(['-', '+']).filter(|(m, b)| !m.is_empty() && !b.is_empty())
    {
        let known = MODIFIERS.iter().find(|(known, _)| *known == modifier);
        modifiers |= known.map(|(_, modifier)| *modifier).ok_or_else(|| {
            nearest(modifier, MODIFIERS.map(|(known, _)| known)).map(str::to_owned)
        })?;
        rest = behind;
    }
    let mut characters = rest.chars();
    let code = match (characters.next(), characters.next()) {
        (Some(one), None) if !NAMES.iter().any(|(known, _)| *known == rest) => KeyCode::Char(one),
        _ => code(rest).ok_or_else(|| {
            let near = nearest(rest, NAMES.iter().map(|(name, _)| *name))?;
            Some(format!("{}{near}", &name[..name.len() - rest.len()]))
        })?,
    };
    let shifted = modifiers.contains(KeyModifiers::SHIFT);
    Ok(match code {
        KeyCode::Char(c) if shifted => {
            let key = character(c.to_ascii_uppercase());
            KeyEvent::new(key.code, key.modifiers | (modifiers - KeyModifiers::SHIFT))
        }
        KeyCode::Char(c) => KeyEvent::new(code, character(c).modifiers | modifiers),
        KeyCode::Tab if shifted => KeyEvent::new(KeyCode::BackTab, modifiers),
        code => KeyEvent::new(code, modifiers),
    })
}

fn code(name: &str) -> Option<KeyCode> {
    let named = NAMES.iter().find(|(known, _)| *known == name).map(|(_, code)| *code);
    named.or_else(|| {
        let number = name.strip_prefix('F')?.parse().ok()?;
        (1..=12).contains(&number).then_some(KeyCode::F(number))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_have_names() {
        let check = |name: &str, code: KeyCode, modifiers: KeyModifiers| {
            assert_eq!(named(name), Ok(KeyEvent::new(code, modifiers)), "{name}");
        };
        let (none, shift) = (KeyModifiers::NONE, KeyModifiers::SHIFT);
        check("Tab", KeyCode::Tab, none);
        check("Shift-Tab", KeyCode::BackTab, shift);
        check("Ctrl+r", KeyCode::Char('r'), KeyModifiers::CONTROL);
        check("Ctrl-Alt-Left", KeyCode::Left, KeyModifiers::CONTROL | KeyModifiers::ALT);
        check("Shift-z", KeyCode::Char('Z'), shift);
        check("Z", KeyCode::Char('Z'), shift);
        check("-", KeyCode::Char('-'), none);
        check("+", KeyCode::Char('+'), none);
        check("[", KeyCode::Char('['), none);
        check("F1", KeyCode::F(1), none);
        assert_eq!(named("Entr"), Err(Some("Enter".to_owned())));
        assert_eq!(named("Shift-Lft"), Err(Some("Shift-Left".to_owned())));
        assert_eq!(named("F13").ok(), None);
    }

    #[test]
    fn names_of_keys_lead_back_to_them() {
        let names = "z Z Ctrl-r Alt-x Space Esc Enter Tab Shift-Tab ↑ ↓ Shift-← Ctrl-→ PgUp PgDn F1 # - θ Θ";
        for written in names.split(' ') {
            let key = named(written).expect("a key");
            assert_eq!(name(&key), written);
        }
        assert_eq!(name(&KeyEvent::new(KeyCode::Char('Z'), KeyModifiers::NONE)), "Z");
    }

    #[test]
    fn a_key_let_go_is_none() {
        let key = character('a');
        assert_eq!(pressed(KeyEvent { kind: KeyEventKind::Repeat, ..key }), Some(key));
        assert_eq!(pressed(KeyEvent { kind: KeyEventKind::Release, ..key }), None);
        assert_eq!(pressed(KeyEvent { state: KeyEventState::CAPS_LOCK, ..key }), Some(key));
    }
}
