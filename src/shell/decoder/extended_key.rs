//! Keys that a terminal sends by their number, with modifiers: as kitty and fixterms do (`CSI 13;2u`), and as xterm does
//! with modifyOtherKeys (`CSI 27;2;13~`).
//!
//! In: the numbers of a sequence. Out: a key and its modifiers in xterm's encoding, such that every key is the one that it is
//! on a terminal without these forms: Ctrl-i is Tab, Ctrl-[ is Esc. Never here: bytes.
//!
//! Kitty: <https://sw.kovidgoyal.net/kitty/keyboard-protocol>; xterm: `modifyOtherKeys` in its manual.

use crossterm::event::KeyCode;
use vte::Params;

/// The bits of the modifiers: a number is one more than their sum. Locks are none of ours, and keys with modifiers that no
/// other terminal reports are left to the window manager.
const SHIFT: u16 = 1;
const ALT: u16 = 2;
const CONTROL: u16 = 4;
const FOREIGN: u16 = 8 | 16 | 32;

/// The kind of event of a key that was released.
const RELEASED: u16 = 3;

/// The number that the parser makes of any that is too large.
const TOO_LARGE: u16 = u16::MAX;

/// A key that came by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ExtendedKey {
    pub(super) code: KeyCode,
    /// One more than the sum of shift 1, alt 2, ctrl 4.
    pub(super) modifiers: u16,
}

impl ExtendedKey {
    /// Returns the key of a sequence with this last character, if it is one.
    pub(super) fn of(params: &Params, last: char) -> Option<Self> {
        let parts: Vec<&[u16]> = params.iter().collect();
        let number = |part: &[u16], at: usize| part.get(at).copied().unwrap_or(0);
        let (key, pressed) = match (last, &*parts) {
            ('u', [key]) => (*key, &[1][..]),
            ('u', [key, pressed, ..]) => (*key, *pressed),
            ('~', [[27], pressed, key]) => (*key, *pressed),
            _ => return None,
        };
        let bits = number(pressed, 0).saturating_sub(1);
        if bits & FOREIGN != 0 || number(pressed, 1) == RELEASED {
            return None;
        }
        let bits = bits & (SHIFT | ALT | CONTROL);
        let (code, bits) = match code(number(key, 0))? {
            KeyCode::Tab if bits & SHIFT != 0 => (KeyCode::BackTab, bits),
            KeyCode::Char(c) if bits & CONTROL != 0 => with_control(c, bits & !SHIFT),
            KeyCode::Char(c) if bits & SHIFT != 0 => {
                let other = u32::from(number(key, 1));
                let shifted = char::from_u32(other).filter(|c| !c.is_control());
                (KeyCode::Char(shifted.unwrap_or(c.to_ascii_uppercase())), bits & !SHIFT)
            }
            code => (code, bits),
        };
        Some(Self { code, modifiers: bits + 1 })
    }
}

/// The key of a number: a character, or a key that kitty numbers in Unicode's private use area.
fn code(number: u16) -> Option<KeyCode> {
    const KEYPAD: &[u8] = b"0123456789./*-+";
    Some(match number {
        8 | 127 => KeyCode::Backspace,
        9 => KeyCode::Tab,
        13 | 57414 => KeyCode::Enter,
        27 => KeyCode::Esc,
        57399..=57413 => KeyCode::Char(KEYPAD[usize::from(number - 57399)].into()),
        57415 => KeyCode::Char('='),
        57416 => KeyCode::Char(','),
        57417 => KeyCode::Left,
        57418 => KeyCode::Right,
        57419 => KeyCode::Up,
        57420 => KeyCode::Down,
        57421 => KeyCode::PageUp,
        57422 => KeyCode::PageDown,
        57423 => KeyCode::Home,
        57424 => KeyCode::End,
        57426 => KeyCode::Delete,
        0xe000..=0xf8ff | TOO_LARGE => return None,
        character => KeyCode::Char(char::from_u32(character.into()).filter(|c| !c.is_control())?),
    })
}

/// What a character is with Ctrl, as a control byte has always said it.
fn with_control(character: char, bits: u16) -> (KeyCode, u16) {
    let code = match character.to_ascii_lowercase() {
        'h' => KeyCode::Backspace,
        'i' => KeyCode::Tab,
        'j' | 'm' => KeyCode::Enter,
        '[' => KeyCode::Esc,
        '@' => return (KeyCode::Char(' '), bits),
        other => return (KeyCode::Char(other), bits),
    };
    (code, bits & !CONTROL)
}
