//! The decoder: turns the bytes that a terminal sends into crossterm's events.
//!
//! In: bytes, in pieces of any size, and timeouts without input; which reports are enabled.
//! Out: [`Event`]s. Never here: what a key does. No byte string makes it panic or get stuck.
//!
//! The sequences are parsed by `vte`, the parser of alacritty's terminal; a timeout distinguishes a lone Esc.
//!
//! It replaces crossterm's own reader because of that reader's bugs in version 0.29. Each row was observed on a
//! pseudo-terminal, and has its upstream thread (crossterm-rs/crossterm) and the test that covers it here. Once all
//! of them are fixed upstream, this file and its folder can go: `event::poll` and `event::read` fit behind [`EventSource`].
//!
//! | crossterm's reader | thread | test |
//! |---|---|---|
//! | A paste without an end swallows all further keys, with no limit of bytes or time, and `poll` does not return. | #1060 | `a_paste_without_an_end_is_taken_when_it_rests`, `pastes_are_one_event_and_bounded`, `a_paste_that_never_ends_does_not_keep_it` |
//! | `CSI <`, `CSI M` and `CSI ?` without an end do the same … | #1104 | `a_sequence_without_an_end_swallows_no_key_for_long`, `a_report_that_never_ends_does_not_keep_it` |
//! | … and so does a complete answer `CSI ? … y`. | #1104, #1106 | `an_answer_that_is_not_understood_swallows_no_key` |
//! | An arrow key split after its first byte, as on a slow connection, is read as Esc and two letters. | #993 | `a_cut_arrow_key_is_no_esc` |
//! | A report of the mouse from column or row 0 panics, or wraps to 65535 in a release. | #835, #590, #1049 | `a_report_from_row_or_column_zero_is_none` |
//! | An unsolicited answer (OSC, DCS, `CSI >`) is read as typed text, letter by letter. | #834 | `what_nobody_asked_for_is_no_key` |
//! | Once the terminal is gone, `poll` spins and never returns. | #793, #1067, #1116 | `a_dead_line_ends_it_soon_and_without_a_loop` |

mod extended_key;
mod sink;

use std::time::{Duration, Instant};
use std::{io, mem};

use crossterm::event::{Event, KeyCode};
use vte::Parser;

pub use self::sink::PASTE_LIMIT;
use self::sink::{Prefix, Sink};
use super::events::EventSource;
use super::question::{Questions, TerminalReply};
use super::terminal::{Terminal, TerminalMode};

const ESC: u8 = 0x1b;

/// How long the rest of a sequence may take: longer than a connection's jitter, shorter than a user notices.
const SEQUENCE: Duration = Duration::from_millis(50);

/// How long the rest of a paste may take, which may be long.
const PASTE: Duration = Duration::from_secs(1);

/// The factor by which it may take longer in total if more input keeps coming but nothing is completed.
const IN_ALL: u32 = 10;

/// The number of consecutive reads, each of [`READ`] bytes, before the input is processed; a flood must not stall
/// the screen.
const READS: usize = 64;
const READ: usize = 4096;

/// The maximum length of a sequence, in bytes; anything longer is noise.
const SEQUENCE_LIMIT: usize = 16 * 1024;

/// Decodes bytes that come in pieces without a pause, followed by silence, with all reports enabled.
pub fn decode<'a>(pieces: impl IntoIterator<Item = &'a [u8]>) -> Vec<Event> {
    let (mut decoder, now) = (Decoder::default(), Instant::now());
    for mode in [TerminalMode::Paste, TerminalMode::Mouse, TerminalMode::Focus] {
        decoder.expect(mode, true);
    }
    pieces.into_iter().for_each(|piece| decoder.feed(piece, now));
    if decoder.deadline().is_some() {
        decoder.expire();
    }
    decoder.sink.events.drain(..).collect()
}

/// Turns bytes into events.
#[derive(Default)]
pub(super) struct Decoder {
    parser: Parser,
    sink: Sink,
    /// Whether the last byte was Esc: a key of its own, or the start of a sequence.
    escaped: bool,
    /// The number of bytes of the unfinished sequence, 0 if there is none.
    begun: usize,
    /// When the unfinished input began, and when its last byte came.
    times: Option<(Instant, Instant)>,
}

impl EventSource for Decoder {
    fn read(&mut self, terminal: &Terminal) -> io::Result<bool> {
        let mut buffer = [0; READ];
        for _ in 0..READS {
            match terminal.read(&mut buffer) {
                Ok(0) => return Ok(false),
                Ok(count) => self.feed(&buffer[..count], Instant::now()),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => break,
                Err(_) => return Ok(false),
            }
            if !terminal.has_input()? {
                break;
            }
        }
        Ok(true)
    }

    fn next(&mut self, now: Instant) -> Option<Event> {
        if self.deadline().is_some_and(|deadline| deadline <= now) {
            self.expire();
        }
        self.sink.events.pop_front()
    }

    fn deadline(&self) -> Option<Instant> {
        let ((first, last), timeout) = (self.times?, self.timeout()?);
        Some((last + timeout).min(first + IN_ALL * timeout))
    }

    fn expect(&mut self, mode: TerminalMode, expected: bool) {
        let expects = &mut self.sink.expects;
        match mode {
            TerminalMode::Paste => expects.pastes = expected,
            TerminalMode::Mouse => expects.mouse = expected,
            TerminalMode::Focus => expects.focus = expected,
            TerminalMode::AlternateScreen | TerminalMode::HiddenCursor | TerminalMode::Keyboard => {
            }
        }
    }

    fn expect_answers(&mut self, asked: Questions) {
        self.sink.expects.answers = asked;
    }

    fn awaits_answer(&self) -> bool {
        self.sink.expects.answers.any()
    }

    fn answer(&mut self) -> Option<TerminalReply> {
        self.sink.answers.pop_front()
    }
}

impl Decoder {
    /// Takes in bytes that came at this time.
    fn feed(&mut self, bytes: &[u8], now: Instant) {
        self.parse(bytes);
        let first = self.times.map_or(now, |(first, _)| first);
        self.times = self.timeout().map(|_| (first, now));
    }

    fn parse(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            if self.sink.skip > 0 {
                self.sink.skip -= 1;
                continue;
            }
            if self.escaped && byte == ESC {
                self.sink.press(KeyCode::Esc);
                continue;
            }
            if self.escaped && !(0x20..=0x7e).contains(&byte) {
                // The parser would lose Alt with a control or non-ASCII character.
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

    /// Returns how long to wait for the rest of unfinished input.
    fn timeout(&self) -> Option<Duration> {
        if self.sink.paste.is_some() {
            Some(PASTE)
        } else {
            let unfinished =
                self.begun > 0 || self.sink.prefix != Prefix::None || self.sink.skip > 0;
            unfinished.then_some(SEQUENCE)
        }
    }

    /// Ends unfinished input after a timeout: it is a complete key, or noise.
    fn expire(&mut self) {
        if let Some(text) = self.sink.paste.take() {
            self.sink.events.push_back(Event::Paste(text));
        } else if self.escaped {
            self.sink.press(KeyCode::Esc);
        } else if self.sink.prefix == Prefix::Keypad {
            self.sink.alt = true;
            self.sink.press(KeyCode::Char('O'));
        }
        self.reset();
    }

    fn reset(&mut self) {
        let Sink { events, expects, answers, .. } = mem::take(&mut self.sink);
        let sink = Sink { events, expects, answers, ..Sink::default() };
        *self = Self { sink, ..Self::default() };
    }
}

#[cfg(test)]
/// Decodes complete input, followed by silence, with a mode enabled.
fn decode_with(mode: TerminalMode, bytes: &[u8]) -> Vec<Event> {
    let mut decoder = Decoder::default();
    decoder.expect(mode, true);
    decoder.feed(bytes, Instant::now());
    if decoder.deadline().is_some() {
        decoder.expire();
    }
    decoder.sink.events.drain(..).collect()
}

#[cfg(test)]
mod tests {
    use crossterm::event::KeyEvent;
    use proptest::prelude::*;

    use super::*;
    use crate::app::key;

    fn check(bytes: &str, keys: &[KeyEvent]) {
        let expected: Vec<_> = keys.iter().copied().map(Event::Key).collect();
        assert_eq!(
            decode_with(TerminalMode::Paste, bytes.as_bytes()),
            expected,
            "{bytes:?} at once"
        );
        let mut decoder = Decoder::default();
        bytes.bytes().for_each(|byte| decoder.feed(&[byte], Instant::now()));
        decoder.expire();
        let pieces = taken(&mut decoder);
        assert_eq!(pieces, expected, "{bytes:?} in pieces");
    }

    fn keys(names: &str) -> Vec<KeyEvent> {
        names.split_whitespace().map(|name| key::named(name).expect("a key")).collect()
    }

    fn taken(decoder: &mut Decoder) -> Vec<Event> {
        decoder.sink.events.drain(..).collect()
    }

    #[test]
    fn a_cut_arrow_key_is_no_esc() {
        let (mut decoder, now) = (Decoder::default(), Instant::now());
        for (part, soon) in ["\x1b", "[", "A"].iter().zip(0..) {
            decoder.feed(part.as_bytes(), now + SEQUENCE / 2 * soon);
            let found = decoder.next(now + SEQUENCE / 2 * soon);
            assert_eq!(found, (*part == "A").then(|| Event::Key(KeyCode::Up.into())));
        }
        assert_eq!(decoder.deadline(), None);
        decoder.feed(b"\x1b", now);
        assert_eq!(decoder.next(now + SEQUENCE), Some(Event::Key(KeyCode::Esc.into())));
    }

    /// Decodes a `q` typed a while after an unfinished sequence.
    fn q_after(unfinished: &[u8], timeout: Duration) -> Vec<Event> {
        let (mut decoder, now) = (Decoder::default(), Instant::now());
        for mode in [TerminalMode::Paste, TerminalMode::Mouse, TerminalMode::Focus] {
            decoder.expect(mode, true);
        }
        decoder.feed(unfinished, now);
        let mut events: Vec<Event> = decoder.next(now + timeout).into_iter().collect();
        decoder.feed(b"q", now + timeout);
        events.extend(taken(&mut decoder));
        events
    }

    #[test]
    fn a_sequence_without_an_end_swallows_no_key_for_long() {
        for unfinished in [
            "\x1b[<",
            "\x1b[<0;1",
            "\x1b[?",
            "\x1b[?2026;2$",
            "\x1b[200",
            "\x1b[M",
            "\x1b]0;",
            "\x1bP",
        ] {
            let found = q_after(unfinished.as_bytes(), SEQUENCE);
            assert_eq!(found, [Event::Key(key::character('q'))], "{unfinished:?}");
        }
    }

    #[test]
    fn a_paste_without_an_end_is_taken_when_it_rests() {
        let found = q_after(b"\x1b[200~text", PASTE);
        assert_eq!(found, [Event::Paste("text".into()), Event::Key(key::character('q'))]);
    }

    #[test]
    fn what_is_not_utf_8_is_no_key_and_keeps_none() {
        for noise in [b"\xff".as_slice(), b"\xc3", b"\xe2\x82", b"\x9b", b"\x90", b"\xf0\x9f\x98"] {
            let found = q_after(noise, SEQUENCE);
            assert_eq!(found.last(), Some(&Event::Key(key::character('q'))), "{noise:?}");
            assert!(found.iter().all(|event| matches!(event, Event::Key(_))), "{found:?}");
        }
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
            check(&format!("{noise}q"), &keys("q"));
        }
    }

    #[test]
    fn a_hundred_thousand_strings_of_noise_do_no_harm() {
        // Bytes of escape sequences are frequent; the others are arbitrary.
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
        for mode in [TerminalMode::Paste, TerminalMode::Mouse, TerminalMode::Focus] {
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
            taken(&mut decoder);
        }
        decoder.feed(b"\x1b[<0;0;0M\x1b]0;never ended", now);
        decoder.expire();
        taken(&mut decoder);
        decoder.feed(b"q", now);
        assert_eq!(taken(&mut decoder), [Event::Key(key::character('q'))]);
    }

    proptest! {
        #[test]
        fn nothing_swallows_q_for_ever(
            modes in prop::sample::subsequence(vec![TerminalMode::Paste, TerminalMode::Mouse, TerminalMode::Focus], 0..=3),
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
            // A repeating key must not keep it waiting either.
            for _ in 0..1000 {
                if decoder.deadline().is_none_or(|deadline| deadline <= now) {
                    break;
                }
                decoder.feed(b"q", now);
                now += Duration::from_millis(30);
            }
            prop_assert!(decoder.deadline().is_none_or(|deadline| deadline <= now));
            decoder.expire();
            taken(&mut decoder);
            decoder.feed(b"q", now);
            prop_assert_eq!(taken(&mut decoder), [Event::Key(key::character('q'))]);
            prop_assert_eq!(decoder.deadline(), None);
        }
    }
}
