//! The sink of the parser: what a character, a control byte or an escape sequence means as an event.
//!
//! In: what `vte` has parsed. Out: crossterm's events, in order; reports that were not enabled are noise. Never here:
//! bytes, or time.

use std::collections::VecDeque;
use std::mem;

use crossterm::event::{
    Event, KeyCode, KeyEvent, KeyModifiers, MouseButton, MouseEvent, MouseEventKind,
};
use vte::{Params, Perform};

use super::super::background;
use super::super::question::{Questions, TerminalReply};
use super::extended_key::ExtendedKey;
use crate::app::{LONGEST_PASTE, key};

/// The maximum size of a paste, in bytes: a character more than the application accepts, so that the cut is
/// reported there.
pub const PASTE_LIMIT: usize = LONGEST_PASTE + 4;

/// A sequence that the parser considers finished although one more character is to come.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum Prefix {
    #[default]
    None,
    /// `ESC O`: keypad and function keys of the VT100.
    Keypad,
    /// `ESC [ [`: function keys of the Linux console.
    Console,
}

/// The reports that the terminal was asked to send.
#[derive(Clone, Copy, Default)]
pub(super) struct Expected {
    pub(super) pastes: bool,
    pub(super) mouse: bool,
    pub(super) focus: bool,
    pub(super) answers: Questions,
}

#[derive(Default)]
pub(super) struct Sink {
    pub(super) events: VecDeque<Event>,
    pub(super) prefix: Prefix,
    /// Whether Alt applies to the next key.
    pub(super) alt: bool,
    pub(super) paste: Option<String>,
    /// The reports that are not noise.
    pub(super) expects: Expected,
    pub(super) answers: VecDeque<TerminalReply>,
    /// The remaining bytes of a mouse report in the old form, which is not supported.
    pub(super) skip: usize,
    /// Whether the parser has completed something since this was last cleared.
    pub(super) settled: bool,
}

impl Sink {
    pub(super) fn press(&mut self, code: KeyCode) {
        self.press_with(code, 1);
    }

    /// Emits a key with modifiers in xterm's encoding: one more than the sum of shift 1, alt 2, ctrl 4.
    fn press_with(&mut self, code: KeyCode, modifiers: u16) {
        let bits = modifiers.saturating_sub(1);
        let pressed = [
            (bits & 1 != 0, KeyModifiers::SHIFT),
            (bits & 2 != 0 || mem::take(&mut self.alt), KeyModifiers::ALT),
            (bits & 4 != 0, KeyModifiers::CONTROL),
        ];
        let pressed =
            pressed.into_iter().filter(|(pressed, _)| *pressed).map(|(_, modifier)| modifier);
        let typed = match code {
            KeyCode::Char(c) => key::character(c),
            code => code.into(),
        };
        if self.paste.is_none() {
            let modifiers = pressed.fold(typed.modifiers, |all, modifier| all | modifier);
            self.events.push_back(Event::Key(KeyEvent::new(code, modifiers)));
        }
    }

    fn write(&mut self, character: char) {
        let Some(paste) = &mut self.paste else {
            self.press(KeyCode::Char(character));
            return;
        };
        if paste.len() + character.len_utf8() <= PASTE_LIMIT {
            paste.push(character);
        }
    }

    /// Handles keys that end in `~`, by their number.
    fn numbered(&mut self, number: u16, modifiers: u16) {
        let code = match number {
            1 | 7 => KeyCode::Home,
            3 => KeyCode::Delete,
            4 | 8 => KeyCode::End,
            5 => KeyCode::PageUp,
            6 => KeyCode::PageDown,
            11..=15 => KeyCode::F((number - 10) as u8),
            17..=21 => KeyCode::F((number - 11) as u8),
            23 | 24 => KeyCode::F((number - 12) as u8),
            200 if self.expects.pastes => {
                self.paste = Some(String::new());
                return;
            }
            201 => {
                self.events.extend(self.paste.take().map(Event::Paste));
                return;
            }
            _ => return,
        };
        self.press_with(code, modifiers);
    }

    /// Handles a mouse report of xterm's mode 1006: button and modifiers, column and row counted from 1.
    fn report(&mut self, [button, column, row]: [u16; 3], released: bool) {
        let kind = match (button & !0b1_1100, released) {
            (0, false) => MouseEventKind::Down(MouseButton::Left),
            (0, true) => MouseEventKind::Up(MouseButton::Left),
            (2, false) => MouseEventKind::Down(MouseButton::Right),
            (2, true) => MouseEventKind::Up(MouseButton::Right),
            (32, false) => MouseEventKind::Drag(MouseButton::Left),
            (64, false) => MouseEventKind::ScrollUp,
            (65, false) => MouseEventKind::ScrollDown,
            _ => return,
        };
        let pressed =
            [(4, KeyModifiers::SHIFT), (8, KeyModifiers::ALT), (16, KeyModifiers::CONTROL)];
        let pressed = pressed.into_iter().filter(|(bit, _)| button & bit != 0);
        let modifiers = pressed.fold(KeyModifiers::NONE, |all, (_, modifier)| all | modifier);
        if let (Some(column), Some(row)) = (column.checked_sub(1), row.checked_sub(1))
            && self.paste.is_none()
        {
            self.events.push_back(Event::Mouse(MouseEvent { kind, column, row, modifiers }));
        }
    }

    fn focus(&mut self, gained: bool) {
        if self.paste.is_none() {
            self.events.push_back(if gained { Event::FocusGained } else { Event::FocusLost });
        }
    }

    fn lettered(&mut self, letter: char, modifiers: u16) {
        let code = match letter {
            'A' => KeyCode::Up,
            'B' => KeyCode::Down,
            'C' => KeyCode::Right,
            'D' => KeyCode::Left,
            'F' => KeyCode::End,
            'H' => KeyCode::Home,
            'P' => KeyCode::F(1),
            'Q' => KeyCode::F(2),
            'R' => KeyCode::F(3),
            'S' => KeyCode::F(4),
            'Z' => {
                self.press_with(KeyCode::BackTab, 2);
                return;
            }
            _ => return,
        };
        self.press_with(code, modifiers);
    }
}

impl Perform for Sink {
    fn print(&mut self, character: char) {
        self.settled = true;
        match mem::take(&mut self.prefix) {
            Prefix::None if character == '\x7f' => self.press(KeyCode::Backspace),
            Prefix::None => self.write(character),
            Prefix::Keypad => match character {
                'M' => self.press(KeyCode::Enter),
                'j'..='y' => self.write(char::from(character as u8 - 0x40)),
                letter => self.lettered(letter, 1),
            },
            Prefix::Console => {
                if let 'A'..='E' = character {
                    self.press(KeyCode::F(character as u8 - b'A' + 1));
                }
            }
        }
    }

    fn execute(&mut self, byte: u8) {
        self.settled = true;
        self.prefix = Prefix::None;
        match byte {
            b'\t' | b'\n' | b'\r' if self.paste.is_some() => self.write(byte.into()),
            0 => self.press_with(KeyCode::Char(' '), 5),
            8 | 0x7f => self.press(KeyCode::Backspace),
            b'\t' => self.press(KeyCode::Tab),
            b'\n' | b'\r' => self.press(KeyCode::Enter),
            1..=26 => self.press_with(KeyCode::Char((byte + 0x60).into()), 5),
            _ => self.press_with(KeyCode::Char((byte + 0x40).into()), 5),
        }
    }

    fn csi_dispatch(&mut self, params: &Params, intermediates: &[u8], _: bool, action: char) {
        self.settled = true;
        let numbers = || params.iter().map(|p| p.first().copied().unwrap_or(0));
        let (first, modifiers) = (numbers().next().unwrap_or(0), numbers().nth(1).unwrap_or(1));
        match action {
            'M' | 'm' if intermediates == b"<" && self.expects.mouse => {
                if let [button, column, row] = numbers().collect::<Vec<_>>()[..] {
                    self.report([button, column, row], action == 'm');
                }
            }
            // Terminals answer in order: whoever reports its attributes has answered all else before, or never will.
            'c' if intermediates == b"?" => self.expects.answers = Questions::default(),
            'u' if intermediates == b"?" => {
                if mem::take(&mut self.expects.answers.keyboard) {
                    self.answers.push_back(TerminalReply::Keyboard);
                }
            }
            // These are answers to queries that this program never sends.
            _ if !intermediates.is_empty() => {}
            // A terminal that supports only the oldest mouse protocol sends three more bytes.
            'M' if self.expects.mouse => self.skip = 3,
            'I' | 'O' if self.expects.focus && first == 0 => self.focus(action == 'I'),
            '[' => self.prefix = Prefix::Console,
            'u' | '~' => match ExtendedKey::of(params, action) {
                Some(key) => self.press_with(key.code, key.modifiers),
                None if action == '~' => self.numbered(first, modifiers),
                None => {}
            },
            // With another number it is an answer, such as the cursor position.
            letter if first <= 1 => self.lettered(letter, modifiers),
            _ => {}
        }
    }

    fn osc_dispatch(&mut self, params: &[&[u8]], bell_terminated: bool) {
        // Otherwise the last byte of its end is still to come.
        self.settled = bell_terminated;
        if let ([b"11", answer], true) = (params, self.expects.answers.background)
            && let Some(colour) = background::colour(answer)
        {
            self.answers.push_back(TerminalReply::Background(colour));
        }
    }

    fn esc_dispatch(&mut self, intermediates: &[u8], _: bool, byte: u8) {
        self.settled = true;
        match byte {
            // This ends a string that the parser has skipped.
            b'\\' => {}
            _ if !intermediates.is_empty() => {}
            b'O' => self.prefix = Prefix::Keypad,
            _ => {
                self.alt = true;
                self.press(KeyCode::Char(byte.into()));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::super::{Decoder, decode_with};
    use super::*;
    use crate::shell::events::EventSource;
    use crate::shell::terminal::TerminalMode;
    use crate::view::colour::Rgb;

    #[test]
    fn the_mouse_is_its_left_and_right_button_and_its_wheel() {
        let check = |bytes: &str, expected: &[(u16, u16, MouseEventKind)]| {
            let plain = |&(column, row, kind): &(u16, u16, MouseEventKind)| {
                Event::Mouse(MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE })
            };
            let expected: Vec<_> = expected.iter().map(plain).collect();
            assert_eq!(decode_with(TerminalMode::Mouse, bytes.as_bytes()), expected, "{bytes:?}");
        };
        let (press, release) =
            (MouseEventKind::Down(MouseButton::Left), MouseEventKind::Up(MouseButton::Left));
        check("\x1b[<0;1;1M\x1b[<0;1;1m", &[(0, 0, press), (0, 0, release)]);
        let (press_right, release_right) =
            (MouseEventKind::Down(MouseButton::Right), MouseEventKind::Up(MouseButton::Right));
        check("\x1b[<2;1;1M\x1b[<2;1;1m", &[(0, 0, press_right), (0, 0, release_right)]);
        check("\x1b[<32;80;24M", &[(79, 23, MouseEventKind::Drag(MouseButton::Left))]);
        let (up, down) = (MouseEventKind::ScrollUp, MouseEventKind::ScrollDown);
        check("\x1b[<64;5;6M\x1b[<65;5;6M", &[(4, 5, up), (4, 5, down)]);
        check("\x1b[<0;99999;99999M", &[(65534, 65534, press)]);
        let modifiers = KeyModifiers::SHIFT | KeyModifiers::ALT | KeyModifiers::CONTROL;
        let pressed = Event::Mouse(MouseEvent { kind: press, column: 1, row: 2, modifiers });
        assert_eq!(decode_with(TerminalMode::Mouse, b"\x1b[<28;2;3M"), [pressed]);
        for nothing in [
            "\x1b[<0;1M",
            "\x1b[<0;1;1;1M",
            "\x1b[<M",
            // The middle button, the right one dragged, motion without a button, horizontal scrolling, extra buttons.
            "\x1b[<1;1;1M\x1b[<1;1;1m",
            "\x1b[<34;1;1M\x1b[<35;1;1M",
            "\x1b[<66;1;1M\x1b[<67;1;1M\x1b[<64;1;1m",
            "\x1b[<128;1;1M\x1b[<65535;1;1M",
            // Without mode 1006.
            "\x1b[M !!\x1b[M#!\x7f",
            "\x1b[M",
        ] {
            check(nothing, &[]);
        }
    }

    #[test]
    fn a_report_from_row_or_column_zero_is_none() {
        for report in ["\x1b[<0;0;0M", "\x1b[<0;1;0M", "\x1b[<0;0;1M", "\x1b[M   ", "\x1b[0;0;0M"] {
            assert_eq!(decode_with(TerminalMode::Mouse, report.as_bytes()), [], "{report:?}");
        }
    }

    #[test]
    fn focus_is_reported_where_it_was_asked_for() {
        let expected = [Event::FocusLost, Event::FocusGained];
        assert_eq!(decode_with(TerminalMode::Focus, b"\x1b[O\x1b[I"), expected);
        assert_eq!(decode_with(TerminalMode::Mouse, b"\x1b[O\x1b[I"), []);
        assert_eq!(decode_with(TerminalMode::Focus, b"\x1b[5I\x1b[2;2O\x1b[?I"), []);
    }

    /// What a terminal that was asked for its background is understood to say, the keys typed meanwhile, and whether
    /// more is awaited.
    fn answered(bytes: &[u8]) -> (Option<Rgb>, Vec<Event>, bool) {
        let mut decoder = Decoder::default();
        decoder.expect_answers(Questions { background: true, keyboard: false });
        for byte in bytes {
            decoder.feed(&[*byte], Instant::now());
        }
        if decoder.deadline().is_some() {
            decoder.expire();
        }
        let colour = decoder.answer().map(|answer| match answer {
            TerminalReply::Background(colour) => colour,
            TerminalReply::Keyboard => panic!("nobody asked"),
        });
        let keys = decoder.sink.events.drain(..).collect();
        (colour, keys, decoder.awaits_answer())
    }

    #[test]
    fn a_background_is_heard_where_it_was_asked_for() {
        let white = Some(Rgb(255, 255, 255));
        let q = vec![Event::Key(key::character('q'))];
        for end in ["\x07", "\x1b\\"] {
            let answer = format!("\x1b]11;rgb:ffff/ffff/ffff{end}");
            let whole = format!("q{answer}\x1b[?62;22c");
            assert_eq!(answered(whole.as_bytes()), (white, q.clone(), false), "{end:?}");
            // The attributes may not come, or come first: then there is nothing to say.
            assert_eq!(answered(answer.as_bytes()), (white, vec![], true), "{end:?}");
            let late = format!("\x1b[?62;22c{answer}q");
            assert_eq!(answered(late.as_bytes()), (None, q.clone(), false), "{end:?}");
        }
    }

    #[test]
    fn an_answer_about_something_else_is_no_background() {
        let q = vec![Event::Key(key::character('q'))];
        for noise in [
            "\x1b]10;rgb:ffff/ffff/ffff\x07",
            "\x1b]11\x07",
            "\x1b]11;\x07",
            "\x1b]11;?\x07",
            "\x1b]11;rgb:ffff/ffff\x07",
            "\x1b]11;rgb:ffff/ffff/ffff;x\x07",
            "\x1b]111;rgb:ffff/ffff/ffff\x07",
            "\x1b]11;\u{fffd}\x1b\\",
        ] {
            assert_eq!(
                answered(format!("{noise}q").as_bytes()),
                (None, q.clone(), true),
                "{noise:?}"
            );
        }
        for other in ["\x1b[>1;2c", "\x1b[=1c", "\x1b[c", "\x1b[?1;2n"] {
            assert!(answered(other.as_bytes()).2, "{other:?} is no answer to DA1");
        }
    }

    #[test]
    fn the_keyboard_protocol_is_known_where_the_terminal_says_so_when_asked() {
        let answers = |keyboard: bool, bytes: &[u8]| {
            let mut decoder = Decoder::default();
            decoder.expect_answers(Questions { background: false, keyboard });
            decoder.feed(bytes, Instant::now());
            let answers: Vec<TerminalReply> = std::iter::from_fn(|| decoder.answer()).collect();
            (answers, decoder.sink.events.len(), decoder.awaits_answer())
        };
        assert_eq!(answers(true, b"\x1b[?0u\x1b[?62c"), (vec![TerminalReply::Keyboard], 0, false));
        assert_eq!(
            answers(true, b"\x1b[?1u\x1b[?0u\x1b[?62c"),
            (vec![TerminalReply::Keyboard], 0, false)
        );
        // It does not know it, nobody has asked, or it comes too late.
        for silent in [&b"\x1b[?62c"[..], b"\x1b[?62c\x1b[?0u", b"\x1b[u\x1b[>1u\x1b[?62c"] {
            assert_eq!(answers(true, silent), (vec![], 0, false), "{silent:?}");
        }
        assert_eq!(answers(false, b"\x1b[?0u"), (vec![], 0, false));
    }
}
