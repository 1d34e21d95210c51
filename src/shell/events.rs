//! The source of events: all that the frame loop knows about reading a terminal.
//!
//! In: a terminal with input. Out: crossterm's [`Event`]s, without blocking. Never here: bytes.
//!
//! It is implemented by [`super::decoder`]. crossterm's own reader would fit as well: `event::poll` and
//! `event::read` for `read`, and no deadline.

use std::io;
use std::time::Instant;

use crossterm::event::Event;

use super::question::{Questions, TerminalReply};
use super::terminal::{Terminal, TerminalMode};

pub(super) trait EventSource {
    /// Reads the available input; call it when there is some. Returns `false` if the terminal is gone.
    fn read(&mut self, terminal: &Terminal) -> io::Result<bool>;

    /// Returns the next of the events that have arrived, in order.
    fn next(&mut self, now: Instant) -> Option<Event>;

    /// Returns when there may be an event even without further input, or `None` if no input is unfinished.
    fn deadline(&self) -> Option<Instant>;

    /// Sets whether the reports of a mode are enabled; if they are not, they are noise.
    fn expect(&mut self, mode: TerminalMode, expected: bool);

    /// Sets what the terminal has been asked; an answer that is not expected is noise.
    fn expect_answers(&mut self, asked: Questions);

    /// Whether an answer is still to come.
    fn awaits_answer(&self) -> bool;

    /// Returns the next answer of the terminal, once.
    fn answer(&mut self) -> Option<TerminalReply>;
}
