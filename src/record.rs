//! Recordings: a script of keys, waits and captions is played on a virtual clock.
//!
//! In: a [`Script`] and its system. Out: a [`Recording`], written as a cast for asciinema ([`cast_writer`]), as an
//! animated picture ([`animation`]) or as a transcript ([`transcript`]); a live performance ([`ScriptRunner`]); casts read back ([`RecordedCast`]). Time is
//! counted in whole microseconds and passes only by frames, so the same script gives the same bytes on every machine.
//! Never here: a clock, a terminal, a thread, a file, the environment.

pub mod animation;
pub mod cast_writer;
pub mod data;
pub mod screenshot;
pub mod script;
pub mod transcript;

mod assertion;
mod cast_reader;
mod cast_theme;
mod clock;
mod headless_lab;
mod lesson;
mod lesson_check;
mod lesson_finding;
mod lesson_judge;
mod lesson_keys;
mod lesson_order;
mod lesson_pointing;
mod lesson_question;
mod lesson_speech;
mod lesson_view;
mod plain;
mod recording;
mod script_runner;
mod shown_keys;

pub use cast_reader::{CastError, CastEvent, RecordedCast};
pub use cast_theme::CastTheme;
pub use clock::Micros;
pub use lesson::Lesson;
pub use lesson_check::{LessonReport, check_lesson};
pub use lesson_keys::Pressed;
pub use plain::plain;
pub use recording::{
    ChapterMarker, Recording, RecordingEvent, RecordingSoFar, TranscriptEntry, play, play_while,
};
pub use script::{Script, ScriptHeader, called};
pub use script_runner::ScriptRunner;
