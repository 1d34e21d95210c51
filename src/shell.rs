//! The shell: the only doer. Terminal in and out, signals, the frame loop, and what the application asks for.
//!
//! In: what to open and how to show it. Out: how it ended; the terminal as it was. Never here: what a key means, what
//! anything looks like, or how a system moves. The lower part ([`perform`]) knows only a [`Screen`] that takes inputs and
//! can be drawn.
//!
//! It is at home on Unix terminals. Their vocabulary and their encoding are crossterm's: events, commands for the modes,
//! raw mode, the window's size. Two things are its own: `decoder` reads, for reasons its head lists one by one; and
//! commands are queued into a buffer that the terminal empties as it can (`queue`), so that a stalled one holds nobody
//! up. Whether there are colours the theme decides (`NO_COLOR` leaves it none), so crossterm is not asked to.
//! No question is ever put to the terminal: answers arrive late over a slow line, or as text in tmux and screen; the
//! environment says what there is to know.

pub(crate) mod atomic_file;
mod bandwidth;
mod cast_player;
mod checker;
pub mod config;
mod decoder;
mod demo;
mod diagnosis;
mod events;
mod file_writer;
mod files;
mod frame_loop;
mod governor;
mod lab;
mod loader;
mod log;
pub mod options;
mod panic;
mod queue;
mod recorder;
mod regular;
mod request;
mod session;
mod signals;
mod store;
mod terminal;
mod writer;

pub use bandwidth::{Bandwidth, BandwidthError};
pub use cast_player::CastPlayer;
pub use decoder::{PASTE_LIMIT, decode};
pub use diagnosis::{Finding, diagnosis};
pub use frame_loop::{Ending, Pace, Screen, ScreenRequest, perform};
pub use lab::{perform_demo, run, show};
pub use log::{LogError, LogFile};
pub use options::Options;
pub use panic::report_panics;
pub use request::{LabError, MOST_FRAMES, Request};
pub use store::SessionError;
pub use terminal::TerminalError;
