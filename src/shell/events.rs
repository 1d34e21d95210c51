//! The source of events: all that the frame loop knows about reading a terminal.
//!
//! In: a terminal with input. Out: crossterm's [`Event`]s, without blocking. Never here: bytes.
//!
//! It is implemented by [`super::decoder`]. crossterm's own reader would fit as well: `event::poll` and
//! `event::read` for `read`, and no deadline.

use std::io;
use std::time::Instant;

use crossterm::event::Event;

use super::terminal::{Terminal, TerminalMode};
use crate::view::colour::Rgb;

/// A reader of a terminal.
pub(super) trait EventSource {
    /// Reads the available input; call it when there is some. Returns `false` if the terminal is gone.
    fn read(&mut self, terminal: &Terminal) -> io::Result<bool>;

    /// Returns the next of the events that have arrived, in order.
    fn next(&mut self, now: Instant) -> Option<Event>;

    /// Returns when there may be an event even without further input, or `None` if no input is unfinished.
    fn deadline(&self) -> Option<Instant>;

    /// Sets whether the reports of a mode are enabled; if they are not, they are noise.
    fn expect(&mut self, mode: TerminalMode, expected: bool);

    /// Sets whether the terminal has been asked for its background; an answer that is not expected is noise.
    fn expect_background(&mut self, expected: bool);

    /// Whether the answer about the background is still to come.
    fn awaits_background(&self) -> bool;

    /// Returns the colour of the terminal's background, once, if it has answered.
    fn background(&mut self) -> Option<Rgb>;
}
