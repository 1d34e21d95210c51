//! The shell, which has all the side effects: terminal input and output, signals, the frame loop, and the
//! application's effects.
//!
//! In: what to open and how to show it. Out: how it ended, and the restored terminal. Never here: what a key means,
//! what anything looks like, or how a system moves. The lower part ([`run_screen`]) knows only a [`Screen`], which
//! takes input and can be drawn.
//!
//! It supports Unix terminals. The vocabulary and the encoding are crossterm's: events, commands for the modes, raw
//! mode, the window's size. Two parts replace crossterm's: `decoder` reads input, for reasons listed in its head;
//! and commands are queued in a buffer that the terminal drains at its own speed (`queue`), so that a stalled
//! terminal blocks nothing. The theme decides whether there are colours (`NO_COLOR` turns them off), so crossterm
//! is not asked.
//! The terminal is asked at the start for its background and whether it knows the keyboard protocol of kitty (`question`), and
//! nothing waits for the answers: these arrive late over a slow connection, or as text in tmux and screen. All else follows from
//! the environment.

pub(crate) mod atomic_file;
mod background;
mod bandwidth;
mod cast_player;
mod cast_screen;
mod checker;
mod clipboard;
pub mod config;
mod decoder;
mod demo;
mod diagnosis;
mod events;
mod file_writer;
mod files;
mod frame_loop;
mod governor;
mod guided;
mod lab;
mod lab_error;
mod lesson;
mod loader;
mod log;
mod mouse;
mod new_file;
pub mod options;
mod panic;
mod progress;
mod question;
mod queue;
mod recorder;
mod recording_ahead;
mod regular;
mod request;
mod screen_style;
mod session;
mod session_file;
mod signals;
mod store;
mod terminal;
mod writer;

pub use bandwidth::{Bandwidth, BandwidthError};
pub use cast_player::CastPlayer;
pub use decoder::{PASTE_LIMIT, decode};
pub use diagnosis::{DoctorFinding, diagnosis};
pub use frame_loop::{Ending, FramePace, Screen, ScreenRequest, run_screen};
pub use governor::Governor;
pub use guided::Guided;
pub use lab::{play_demo, run, show, show_ahead, take_lesson};
pub use lab_error::LabError;
pub use log::{LogError, LogFile};
pub use options::{MOST_FRAMES, Options};
pub use panic::report_panics;
pub use progress::{LessonMark, LessonProgress, ProgressError};
pub use question::Questions;
pub use recording_ahead::{LeftRecording, NotRecorded, RecordingAhead};
pub use request::Request;
pub use session_file::{SessionError, has_session};
pub use terminal::TerminalError;
