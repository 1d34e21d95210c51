//! Input: the bytes a terminal sends, as keys, pasted text and reports of the mouse.
//!
//! In: bytes, in pieces of any size, and the news that no more came for a while; which reports were asked for.
//! Out: [`Input`]s.
//! Never here: reading them, or what a key does. No byte string makes it panic or get stuck.
//!
//! The sequences are taken apart by `vte`, which alacritty's terminal lives on; what a lone Esc is, time tells.

use std::collections::VecDeque;
use std::mem;
use std::time::{Duration, Instant};

use vte::{Params, Parser, Perform};

use super::terminal::Mode;
use crate::app::{Act, Code, Key, LONGEST_PASTE, Mouse};

/// What a person did at the terminal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Input {
    /// A key was pressed.
    Key(Key),
    /// Text was pasted, and the terminal said so; longer text is cut after [`PASTE_LIMIT`] bytes.
    Paste(String),
    /// Something was done with the mouse.
    Mouse(Mouse),
    /// The window has got the keyboard, or lost it.
    Focus(bool),
    /// The window has another size: columns, rows.
    Resize(u16, u16),
}

/// The most that one paste brings, in bytes: a character more than is taken of it, so that it is reported where it was cut.
pub const PASTE_LIMIT: usize = LONGEST_PASTE + 4;

const ESC: u8 = 0x1b;

/// How long the rest of a sequence may take: longer than a line's jitter, shorter than a person notices.
const SEQUENCE: Duration = Duration::from_millis(50);

/// The same for the rest of a paste, which may be long.
const PASTE: Duration = Duration::from_secs(1);

/// How many times as long it may take in all, where more keeps coming and nothing is finished.
const IN_ALL: u32 = 10;

/// The longest sequence that is waited for, in bytes; what is longer is noise.
const SEQUENCE_LIMIT: usize = 16 * 1024;

/// Turns bytes into inputs.
#[derive(Default)]
pub(super) struct Decoder {
    parser: Parser,
    sink: Sink,
    /// The last byte was Esc: a key of its own, or the beginning of a sequence.
    escaped: bool,
    /// Bytes of the sequence begun, 0 where none is.
    begun: usize,
    /// When what is unfinished began, and when the last of it came.
    times: Option<(Instant, Instant)>,
}

impl Decoder {
    /// Takes bytes in that came at that time.
    pub(super) fn feed(&mut self, bytes: &[u8], now: Instant) {
        self.parse(bytes);
        let first = self.times.map_or(now, |(first, _)| first);
        self.times = self.patience().map(|_| (first, now));
    }

    fn parse(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            if self.sink.skip > 0 {
                self.sink.skip -= 1;
                continue;
            }
            if self.escaped && byte == ESC {
                self.sink.press(Code::Esc);
                continue;
            }
            if self.escaped && !(0x20..=0x7e).contains(&byte) {
                // Alt with a control or non-ASCII character, which the parser would lose.
                self.parser = Parser::new();
                self.sink.alt = true;
            }
            self.escaped = byte == ESC;
            self.sink.settled = false;
            self.parser.advance(&mut self.sink, &[byte]);
            if self.sink.settled {
                self.begun = 0;
            } else if self.begun > 0 || byte == ESC || byte >= 0x80 {
                self.begun += 1;
            }
            if self.begun > SEQUENCE_LIMIT {
                self.reset();
            }
        }
    }

    /// Whether the terminal was told to send what a mode brings; if not, it is noise.
    pub(super) fn expect(&mut self, mode: Mode, expected: bool) {
        let expects = &mut self.sink.expects;
        match mode {
            Mode::Paste => expects.pastes = expected,
            Mode::Mouse => expects.mouse = expected,
            Mode::Focus => expects.focus = expected,
            Mode::AlternateScreen | Mode::HiddenCursor => {}
        }
    }

    /// When [`Self::expire`] is due; `None` where nothing is unfinished.
    pub(super) fn deadline(&self) -> Option<Instant> {
        let ((first, last), patience) = (self.times?, self.patience()?);
        Some((last + patience).min(first + IN_ALL * patience))
    }

    /// How long to wait for more of what is unfinished.
    fn patience(&self) -> Option<Duration> {
        if self.sink.paste.is_some() {
            Some(PASTE)
        } else {
            let unfinished =
                self.begun > 0 || self.sink.prefix != Prefix::None || self.sink.skip > 0;
            unfinished.then_some(SEQUENCE)
        }
    }

    /// Nothing more came: what is unfinished is a key of its own, or noise.
    pub(super) fn expire(&mut self) {
        if let Some(text) = self.sink.paste.take() {
            self.sink.inputs.push_back(Input::Paste(text));
        } else if self.escaped {
            self.sink.press(Code::Esc);
        } else if self.sink.prefix == Prefix::Keypad {
            self.sink.alt = true;
            self.sink.press(Code::Char('O'));
        }
        self.reset();
    }

    /// The next input, in the order of the bytes.
    pub(super) fn next(&mut self) -> Option<Input> {
        self.sink.inputs.pop_front()
    }

    fn reset(&mut self) {
        let (inputs, expects) = (mem::take(&mut self.sink.inputs), self.sink.expects);
        *self = Self { sink: Sink { inputs, expects, ..Sink::default() }, ..Self::default() };
    }
}

/// A sequence that the parser takes for finished, while one character is still to come.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
enum Prefix {
    #[default]
    None,
    /// `ESC O`: keypad and function keys of the VT100.
    Keypad,
    /// `ESC [ [`: function keys of the Linux console.
    Console,
}

/// What the terminal was told to send.
#[derive(Clone, Copy, Default)]
struct Expected {
    /// Pastes in brackets.
    pastes: bool,
    /// Reports of the mouse.
    mouse: bool,
    /// Reports of the window's focus.
    focus: bool,
}

/// What the parser has found.
#[derive(Default)]
struct Sink {
    inputs: VecDeque<Input>,
    prefix: Prefix,
    /// Alt goes with the next key.
    alt: bool,
    paste: Option<String>,
    /// What is no noise.
    expects: Expected,
    /// Bytes still to come of a mouse report of the old form, which is not understood.
    skip: usize,
    /// The parser has finished something since it was last asked.
    settled: bool,
}

impl Sink {
    fn press(&mut self, code: Code) {
        self.press_with(code, 1);
    }

    /// A key with modifiers as xterm counts them: one more than shift 1, alt 2, ctrl 4.
    fn press_with(&mut self, code: Code, modifiers: u16) {
        let bits = modifiers.saturating_sub(1);
        let (shift, alt, ctrl) = (bits & 1 != 0, bits & 2 != 0, bits & 4 != 0);
        let alt = mem::take(&mut self.alt) || alt;
        if self.paste.is_none() {
            self.inputs.push_back(Input::Key(Key { code, ctrl, alt, shift }));
        }
    }

    fn write(&mut self, character: char) {
        let Some(paste) = &mut self.paste else {
            self.press(Code::Char(character));
            return;
        };
        if paste.len() + character.len_utf8() <= PASTE_LIMIT {
            paste.push(character);
        }
    }

    /// Keys that end in `~`, by their number.
    fn numbered(&mut self, number: u16, modifiers: u16) {
        let code = match number {
            1 | 7 => Code::Home,
            3 => Code::Delete,
            4 | 8 => Code::End,
            5 => Code::PageUp,
            6 => Code::PageDown,
            11..=15 => Code::F((number - 10) as u8),
            17..=21 => Code::F((number - 11) as u8),
            23 | 24 => Code::F((number - 12) as u8),
            200 if self.expects.pastes => {
                self.paste = Some(String::new());
                return;
            }
            201 => {
                self.inputs.extend(self.paste.take().map(Input::Paste));
                return;
            }
            _ => return,
        };
        self.press_with(code, modifiers);
    }

    /// A mouse report of xterm's mode 1006: button and modifiers, column and row from 1.
    fn report(&mut self, [button, column, row]: [u16; 3], released: bool) {
        // Shift, alt and ctrl held with it make no difference.
        let act = match (button & !0b1_1100, released) {
            (0, false) => Act::Press,
            (0, true) => Act::Release,
            (32, false) => Act::Drag,
            (64, false) => Act::WheelUp,
            (65, false) => Act::WheelDown,
            _ => return,
        };
        if let (Some(column), Some(row)) = (column.checked_sub(1), row.checked_sub(1))
            && self.paste.is_none()
        {
            self.inputs.push_back(Input::Mouse(Mouse { column, row, act }));
        }
    }

    fn focus(&mut self, gained: bool) {
        if self.paste.is_none() {
            self.inputs.push_back(Input::Focus(gained));
        }
    }

    /// Keys that end in a letter of their own.
    fn lettered(&mut self, letter: char, modifiers: u16) {
        let code = match letter {
            'A' => Code::Up,
            'B' => Code::Down,
            'C' => Code::Right,
            'D' => Code::Left,
            'F' => Code::End,
            'H' => Code::Home,
            'P' => Code::F(1),
            'Q' => Code::F(2),
            'R' => Code::F(3),
            'S' => Code::F(4),
            'Z' => {
                self.press_with(Code::Tab, 2);
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
            Prefix::None if character == '\x7f' => self.press(Code::Backspace),
            Prefix::None => self.write(character),
            Prefix::Keypad => match character {
                'M' => self.press(Code::Enter),
                'j'..='y' => self.write(char::from(character as u8 - 0x40)),
                letter => self.lettered(letter, 1),
            },
            Prefix::Console => {
                if let 'A'..='E' = character {
                    self.press(Code::F(character as u8 - b'A' + 1));
                }
            }
        }
    }

    fn execute(&mut self, byte: u8) {
        self.settled = true;
        self.prefix = Prefix::None;
        match byte {
            b'\t' | b'\n' | b'\r' if self.paste.is_some() => self.write(byte.into()),
            0 => self.press_with(Code::Char(' '), 5),
            8 | 0x7f => self.press(Code::Backspace),
            b'\t' => self.press(Code::Tab),
            b'\n' | b'\r' => self.press(Code::Enter),
            1..=26 => self.press_with(Code::Char((byte + 0x60).into()), 5),
            _ => self.press_with(Code::Char((byte + 0x40).into()), 5),
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
            // Answers to questions nobody here asks.
            _ if !intermediates.is_empty() => {}
            // A terminal that knows the mouse only in its oldest form: three bytes more.
            'M' if self.expects.mouse => self.skip = 3,
            'I' | 'O' if self.expects.focus && first == 0 => self.focus(action == 'I'),
            '[' => self.prefix = Prefix::Console,
            '~' => self.numbered(first, modifiers),
            // With another number it is an answer, such as the cursor's place.
            letter if first <= 1 => self.lettered(letter, modifiers),
            _ => {}
        }
    }

    fn esc_dispatch(&mut self, intermediates: &[u8], _: bool, byte: u8) {
        self.settled = true;
        match byte {
            // The end of a string that the parser has swallowed.
            b'\\' => {}
            _ if !intermediates.is_empty() => {}
            b'O' => self.prefix = Prefix::Keypad,
            _ => {
                self.alt = true;
                self.press(Code::Char(byte.into()));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// What whole bytes, and then silence, mean.
    fn decode(bytes: &[u8]) -> Vec<Input> {
        decode_with(Mode::Paste, bytes)
    }

    /// The same where a mode is on.
    fn decode_with(mode: Mode, bytes: &[u8]) -> Vec<Input> {
        let mut decoder = Decoder::default();
        decoder.expect(mode, true);
        decoder.feed(bytes, Instant::now());
        if decoder.deadline().is_some() {
            decoder.expire();
        }
        std::iter::from_fn(|| decoder.next()).collect()
    }

    fn check(bytes: &str, keys: &[Key]) {
        let expected: Vec<_> = keys.iter().copied().map(Input::Key).collect();
        assert_eq!(decode(bytes.as_bytes()), expected, "{bytes:?} at once");
        let mut decoder = Decoder::default();
        bytes.bytes().for_each(|byte| decoder.feed(&[byte], Instant::now()));
        decoder.expire();
        let pieces: Vec<_> = std::iter::from_fn(|| decoder.next()).collect();
        assert_eq!(pieces, expected, "{bytes:?} in pieces");
    }

    const fn alt(code: Code) -> Key {
        Key { alt: true, ..Key::plain(code) }
    }

    #[test]
    fn keys_of_every_kind() {
        check("aZ θ", &[Key::char('a'), Key::char('Z'), Key::char(' '), Key::char('θ')]);
        check("\r\n\t", &[Code::Enter, Code::Enter, Code::Tab].map(Key::plain));
        check("\x7f\x08", &[Code::Backspace, Code::Backspace].map(Key::plain));
        check("\x03\x1a\0", &[Key::ctrl('c'), Key::ctrl('z'), Key::ctrl(' ')]);
        check("\x1c\x1f", &[Key::ctrl('\\'), Key::ctrl('_')]);
        check("\x1b[A\x1bOA\x1b[D", &[Code::Up, Code::Up, Code::Left].map(Key::plain));
        check("\x1b[H\x1b[4~\x1bOF", &[Code::Home, Code::End, Code::End].map(Key::plain));
        check(
            "\x1b[5~\x1b[6~\x1b[3~",
            &[Code::PageUp, Code::PageDown, Code::Delete].map(Key::plain),
        );
        check("\x1bOP\x1b[15~\x1b[24~\x1b[[B", &[1, 5, 12, 2].map(|n| Key::plain(Code::F(n))));
        check("\x1b[Z\x1b[1;2C", &[Key::shift(Code::Tab), Key::shift(Code::Right)]);
        check("\x1b[1;5A", &[Key { ctrl: true, ..Key::plain(Code::Up) }]);
        check("\x1bx\x1b\r", &[alt(Code::Char('x')), alt(Code::Enter)]);
        check("\x1bé\x1b\x7f", &[alt(Code::Char('é')), alt(Code::Backspace)]);
        check("\x1bOp\x1bOM", &[Key::char('0'), Key::plain(Code::Enter)]);
    }

    #[test]
    fn esc_is_a_key_when_nothing_follows() {
        check("\x1b", &[Key::plain(Code::Esc)]);
        check("\x1b\x1b", &[Code::Esc, Code::Esc].map(Key::plain));
        check("\x1b\x1b[A", &[Code::Esc, Code::Up].map(Key::plain));
        check("\x1bO", &[alt(Code::Char('O'))]);
    }

    #[test]
    fn what_nobody_asked_for_is_no_key() {
        for noise in [
            "\x1b[<0;0;0M",
            "\x1b[<0;10;3M",
            "\x1b[<0;10;3m",
            "\x1b[M",
            "\x1b]11;rgb:1010/1010/1414\x1b\\",
            "\x1b]0;q\x07",
            "\x1bP1$r0m\x1b\\",
            "\x1b[?62;22c",
            "\x1b[12;40R",
            "\x1b[I\x1b[O",
        ] {
            check(&format!("{noise}q"), &[Key::char('q')]);
        }
    }

    #[test]
    fn the_mouse_is_its_left_button_and_its_wheel() {
        let check = |bytes: &str, expected: &[(u16, u16, Act)]| {
            let expected: Vec<_> = expected
                .iter()
                .map(|&(column, row, act)| Input::Mouse(Mouse { column, row, act }))
                .collect();
            assert_eq!(decode_with(Mode::Mouse, bytes.as_bytes()), expected, "{bytes:?}");
        };
        check("\x1b[<0;1;1M\x1b[<0;1;1m", &[(0, 0, Act::Press), (0, 0, Act::Release)]);
        check("\x1b[<32;80;24M", &[(79, 23, Act::Drag)]);
        check("\x1b[<64;5;6M\x1b[<65;5;6M", &[(4, 5, Act::WheelUp), (4, 5, Act::WheelDown)]);
        // With shift, alt and ctrl.
        check("\x1b[<28;2;3M", &[(1, 2, Act::Press)]);
        check("\x1b[<0;99999;99999M", &[(65534, 65534, Act::Press)]);
        for nothing in [
            "\x1b[<0;0;0M",
            "\x1b[<0;1;0M",
            "\x1b[<0;1M",
            "\x1b[<0;1;1;1M",
            "\x1b[<M",
            // The middle and the right button, motion without a button, the wheel aside, more buttons.
            "\x1b[<1;1;1M\x1b[<2;1;1m",
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
    fn focus_is_reported_where_it_was_asked_for() {
        let expected = [false, true].map(Input::Focus);
        assert_eq!(decode_with(Mode::Focus, b"\x1b[O\x1b[I"), expected);
        assert_eq!(decode_with(Mode::Mouse, b"\x1b[O\x1b[I"), []);
        assert_eq!(decode_with(Mode::Focus, b"\x1b[5I\x1b[2;2O\x1b[?I"), []);
    }

    #[test]
    fn pastes_are_one_input_and_bounded() {
        let paste = |text: &str| vec![Input::Paste(text.to_owned())];
        assert_eq!(decode(b"\x1b[200~q\r2*x\x1b[A\x1b[201~"), paste("q\r2*x"));
        assert_eq!(decode(b"\x1b[200~never ended"), paste("never ended"));
        let long = format!("\x1b[200~{}\x1b[201~", "θ".repeat(500_000));
        assert_eq!(decode(long.as_bytes()), paste(&"θ".repeat(PASTE_LIMIT / 2)));
    }

    #[test]
    fn a_hundred_thousand_strings_of_noise_do_no_harm() {
        // Bytes that sequences are made of come often; the rest is anything.
        const OFTEN: &[u8] = b"\x1b\x1b\x1b[[<<;;0019MmO?]P_^X\\~200~201~\x07\x18\x9b\xc3\xff";
        let mut seed = 0x2545_f491_4f6c_dd1d_u64;
        let mut random = || {
            seed ^= seed << 13;
            seed ^= seed >> 7;
            seed ^= seed << 17;
            (seed >> 32) as usize
        };
        let mut now = Instant::now();
        let mut decoder = Decoder::default();
        for mode in [Mode::Paste, Mode::Mouse, Mode::Focus] {
            decoder.expect(mode, true);
        }
        for _ in 0..100_000 {
            let bytes: Vec<u8> =
                (0..=random() % 24)
                    .map(|_| {
                        if random() % 4 > 0 {
                            OFTEN[random() % OFTEN.len()]
                        } else {
                            random() as u8
                        }
                    })
                    .collect();
            decoder.feed(&bytes, now);
            now += Duration::from_millis(20);
            while decoder.next().is_some() {}
        }
        decoder.feed(b"\x1b[<0;0;0M\x1b]0;never ended", now);
        decoder.expire();
        while decoder.next().is_some() {}
        decoder.feed(b"q", now);
        assert_eq!(decoder.next(), Some(Input::Key(Key::char('q'))));
    }

    proptest! {
        #[test]
        fn nothing_swallows_q_for_ever(
            modes in prop::sample::subsequence(vec![Mode::Paste, Mode::Mouse, Mode::Focus], 0..=3),
            bytes: Vec<u8>,
            tail in "\x1b[\\[\\]PO_X]?(200~|M|<[0-9]{0,6}(;[0-9]{0,6}){0,4}[Mm])?.{0,8}",
        ) {
            let mut decoder = Decoder::default();
            for mode in modes {
                decoder.expect(mode, true);
            }
            let mut now = Instant::now();
            decoder.feed(&bytes, now);
            decoder.feed(tail.as_bytes(), now);
            // A key that repeats must not keep it waiting either.
            for _ in 0..1000 {
                if decoder.deadline().is_none_or(|deadline| deadline <= now) {
                    break;
                }
                decoder.feed(b"q", now);
                now += Duration::from_millis(30);
            }
            prop_assert!(decoder.deadline().is_none_or(|deadline| deadline <= now));
            decoder.expire();
            while decoder.next().is_some() {}
            decoder.feed(b"q", now);
            prop_assert_eq!(decoder.next(), Some(Input::Key(Key::char('q'))));
            prop_assert_eq!(decoder.deadline(), None);
        }
    }
}
