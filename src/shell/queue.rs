//! The output queue: bytes for a terminal that may be slow, stalled or gone.
//!
//! In: frames. Out: as many bytes as the terminal accepts at the time. Never here: waiting.

use std::io::{Error, ErrorKind, Result, Write};

/// Bytes not yet sent.
#[derive(Debug, Default)]
pub(super) struct Queue {
    bytes: Vec<u8>,
    sent: usize,
}

impl Queue {
    /// Whether bytes are still to be sent; no frame should be drawn then.
    pub(super) fn is_busy(&self) -> bool {
        self.sent < self.bytes.len()
    }

    /// Drops all unsent bytes.
    pub(super) fn clear(&mut self) {
        (self.bytes, self.sent) = (Vec::new(), 0);
    }

    /// Sends what can be sent without blocking. After an error the queue is empty, and the terminal's contents are
    /// unknown.
    pub(super) fn send(&mut self, mut write: impl FnMut(&[u8]) -> Result<usize>) -> Result<()> {
        while self.is_busy() {
            match write(&self.bytes[self.sent..]) {
                Ok(0) => {
                    self.clear();
                    return Err(Error::from(ErrorKind::WriteZero));
                }
                Ok(count) => self.sent += count,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => return Ok(()),
                Err(error) => {
                    self.clear();
                    return Err(error);
                }
            }
        }
        self.clear();
        Ok(())
    }
}

/// Appends bytes; this is how crossterm's commands are queued.
impl Write for Queue {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        self.bytes.extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use ratatui::layout::Size;
    use ratatui::style::Style;

    use super::*;
    use crate::view::frame::Frames;

    /// Simulates a terminal that accepts at most this many bytes at a time, with the given results in between.
    fn sent(
        queue: &mut Queue,
        answers: &[std::result::Result<usize, ErrorKind>],
    ) -> (Vec<u8>, bool) {
        let mut shown = Vec::new();
        let mut answers = answers.iter();
        let result = queue.send(|bytes| match answers.next().expect("no more writes are needed") {
            Ok(room) => {
                let count = bytes.len().min(*room);
                shown.extend(&bytes[..count]);
                Ok(count)
            }
            Err(kind) => Err(Error::from(*kind)),
        });
        (shown, result.is_ok())
    }

    #[test]
    fn what_is_not_taken_waits_in_order() {
        let mut queue = Queue::default();
        queue.write_all(b"frame one").expect("memory");
        let busy = [Ok(3), Err(ErrorKind::Interrupted), Ok(2), Err(ErrorKind::WouldBlock)];
        assert_eq!(sent(&mut queue, &busy), (b"frame".to_vec(), true));
        assert!(queue.is_busy());
        queue.write_all(b", frame two").expect("memory");
        assert_eq!(sent(&mut queue, &[Ok(99)]), (b" one, frame two".to_vec(), true));
        assert!(!queue.is_busy());
    }

    #[test]
    fn an_error_empties_it() {
        for answer in [Err(ErrorKind::Other), Ok(0)] {
            let mut queue = Queue::default();
            queue.write_all(b"frame").expect("memory");
            assert_eq!(sent(&mut queue, &[Ok(2), answer]), (b"fr".to_vec(), false));
            assert!(!queue.is_busy());
        }
    }

    #[test]
    fn the_frame_after_a_failed_write_paints_every_cell() {
        let (mut queue, mut frames) = (Queue::default(), Frames::new(true).expect("memory"));
        let mut terminal = vt100::Parser::new(4, 20, 0);
        let mut paint = |text: &str, queue: &mut Queue, answers: &[_], forget: bool| {
            if forget {
                frames.forget();
            }
            let frame = frames.next(Size::new(20, 4), |area, buffer| {
                for y in area.rows() {
                    buffer.set_string(0, y.y, text, Style::new());
                }
            });
            queue.write_all(&frame.expect("bytes")).expect("memory");
            let (shown, whole) = sent(queue, answers);
            terminal.process(&shown);
            (whole, terminal.screen().contents())
        };
        let all = [Ok(9999)];
        let (whole, _) = paint("first", &mut queue, &[Ok(30), Err(ErrorKind::Other)], false);
        assert!(!whole);
        // The frame loop does the same after an error.
        let (whole, contents) = paint("second", &mut queue, &all, true);
        assert!(whole);
        assert_eq!(contents, ["second"; 4].join("\n"));
    }
}
