//! The record room: a script of keys, waits and captions played on a virtual clock, and what comes of it.
//!
//! In: a [`Script`] and the system it is about. Out: a [`Recording`], written as a cast for asciinema ([`cast_writer`]) or as a
//! textual account ([`transcript`]); the same as someone watches ([`ScriptRunner`]); casts read back ([`RecordedCast`]). Time is counted in whole microseconds and passes only
//! by frames, so the same script gives the same bytes on every machine. Never here: a clock, a terminal, a thread,
//! a file, the environment.

pub mod transcript;
pub mod cast_writer;
pub mod data;
pub mod script;
pub mod screenshot;

mod assertion;
mod clock;
mod headless_lab;
mod script_runner;
mod plain;
mod recording;
mod cast_reader;

pub use script_runner::ScriptRunner;
pub use plain::plain;
pub use recording::{Entry, Event, Marker, Recording, play};
pub use script::Script;
pub use cast_reader::{RecordedCast, CastError, CastEvent};
