//! The shell: the only doer. Terminal in and out, signals, the frame loop, and what the application asks for.
//!
//! In: what to open and how to show it. Out: how it ended; the terminal as it was. Never here: what a key means, what
//! anything looks like, or how a system moves. The lower part ([`perform`]) knows only a [`Screen`] that takes inputs and
//! can be drawn.
//!
//! It is at home on Unix terminals, and speaks to them itself: crossterm's reader panics on a malformed mouse report,
//! spins once the terminal is gone and takes a cut arrow key for Esc; its writer blocks, and asks `NO_COLOR` by itself.
//! No question is ever put to the terminal: answers arrive late over a slow line, or as text in tmux and screen; the
//! environment says what there is to know.

mod bandwidth;
mod cast_player;
mod checker;
pub mod config;
mod demo;
mod diagnosis;
mod file_writer;
mod files;
mod frame_loop;
mod fresh;
mod governor;
mod input;
mod job;
mod lab;
mod loader;
mod log;
pub mod options;
mod panic;
mod partial;
mod product;
mod queue;
mod recorder;
mod regular;
mod request;
mod session;
mod signals;
mod store;
mod terminal;
pub(crate) mod whole;

pub use bandwidth::{Bandwidth, BandwidthError};
pub use cast_player::CastPlayer;
pub use diagnosis::{Finding, diagnosis};
pub use frame_loop::{Ending, Pace, Screen, ScreenRequest, perform};
pub use input::{Input, PASTE_LIMIT};
pub use lab::{perform_demo, run, show};
pub use log::{LogError, LogFile};
pub use options::Options;
pub use panic::report_panics;
pub(crate) use partial::remove_all as remove_partial_files;
pub use request::{LabError, MOST_FRAMES, Request};
pub use store::SessionError;
pub use terminal::TerminalError;
