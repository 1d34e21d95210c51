//! Where events come from: the one thing the frame loop knows of reading a terminal.
//!
//! In: a terminal at which something was typed. Out: crossterm's [`Event`]s, without waiting for any. Never here: bytes.
//!
//! The reader behind it is [`super::decoder`]. crossterm's own would fit as well: `event::poll` and `event::read` for
//! `read`, and no deadline.

use std::io;
use std::time::Instant;

use crossterm::event::Event;

use super::terminal::{Mode, Terminal};

/// A reader of a terminal.
pub(super) trait EventSource {
    /// Reads what has come; call it when there is something. `false` if the terminal is gone.
    fn read(&mut self, terminal: &Terminal) -> io::Result<bool>;

    /// The next event of those that have come until now, in their order.
    fn next(&mut self, now: Instant) -> Option<Event>;

    /// When there may be an event although nothing more has come; `None` where nothing is unfinished.
    fn deadline(&self) -> Option<Instant>;

    /// Whether the terminal was told to send what a mode brings; if not, it is noise.
    fn expect(&mut self, mode: Mode, expected: bool);
}
