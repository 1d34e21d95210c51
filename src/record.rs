//! The record room: a script of keys, waits and captions played on a virtual clock, and what comes of it.
//!
//! In: a [`Script`] and the system it is about. Out: a [`Recording`], written as a cast for asciinema ([`cast`]) or as a
//! textual account ([`account`]); the same as someone watches ([`Performance`]); casts read back ([`Tape`]). Time is counted in whole microseconds and passes only
//! by frames, so the same script gives the same bytes on every machine. Never here: a clock, a terminal, a thread,
//! a file, the environment.

pub mod account;
pub mod cast;
pub mod data;
pub mod script;
pub mod still;

mod assertion;
mod clock;
mod laboratory;
mod performance;
mod plain;
mod recording;
mod tape;

pub use performance::Performance;
pub use plain::plain;
pub use recording::{Entry, Event, Marker, Recording, play};
pub use script::Script;
pub use tape::{Tape, TapeError, Turn};
