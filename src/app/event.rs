//! Events that reach the application, and the effects it asks for.
//!
//! In: nothing. Out: [`AppEvent`]s as the shell reports them, [`Effect`]s as the shell performs them, both plain data.
//! Never here: how an effect is performed.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use crossterm::event::{KeyEvent, MouseEventKind};

use super::{Asker, Computation, Drawn, Guide, HitTarget, LoadError, Loaded};
use crate::diagnostic::Diagnostic;
use crate::experiment::{Command, Snapshot};
use crate::instrument::Answer;
use crate::job::{Outcome, Share};

/// An event from outside.
#[derive(Clone, Debug)]
pub enum AppEvent {
    /// A key was pressed.
    Key(KeyEvent),
    /// Text was pasted; it is ignored unless text is being typed.
    Paste(String),
    /// The screen was resized: columns, rows.
    Resize(u16, u16),
    /// A mouse event on a target that `view` has identified.
    Mouse(MouseEventKind, HitTarget),
    /// The terminal's window has gained or lost the keyboard focus.
    Focus(bool),
    /// The experiment has advanced. Snapshots of an epoch other than the loaded system's are dropped.
    Snapshot(Arc<Snapshot>),
    /// A system requested by [`Effect::Load`] was loaded, or could not be.
    Loaded(Result<Loaded, LoadError>),
    /// A requested file was written, or the reason why not: a sentence.
    Written(Result<String, String>),
    /// A frame has passed; this is the time since the last one.
    Tick(Duration),
    /// The result of [`Effect::Check`]; if the text is correct, its system is already running.
    Checked(Box<CheckedText>),
    /// A text was saved to this file, or could not be.
    FileSaved(Result<(PathBuf, String), SaveError>),
    /// The file of the system was read.
    FileRead {
        /// What it holds now.
        text: String,
        /// Whether it was read because [`Effect::Reread`] asked for it.
        asked: bool,
    },
    /// A job requested by [`Effect::Compute`] has ended.
    Computed {
        /// The number of the computation.
        ticket: u64,
        /// What it came to.
        outcome: Outcome<Answer>,
    },
    /// The progress of a job.
    Progress {
        /// The number of the computation.
        ticket: u64,
        /// The completed share.
        share: Share,
    },
    /// A lesson or demo was left.
    GuideLeft {
        /// All lessons and demos, with how far each lesson was taken.
        guides: Vec<Guide>,
        /// Why it could not be taken, or what is wrong with it.
        wrong: Option<String>,
    },
    /// Whether the watched file of the system exists; sent when that changes.
    FileThere(bool),
    /// The screen was drawn, with this result.
    Drawn(Drawn),
}

/// An effect for the shell to perform.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Send a command to the experiment.
    Execute(Command),
    /// Load a preset or file and start it as a new experiment; [`AppEvent::Loaded`] answers.
    Load(String),
    /// Cancel the last load; there is no response.
    StopLoading,
    /// Export the current state as a system file; [`AppEvent::Written`] answers.
    Export,
    /// Check a text and cancel the previous check; if the text is correct, its system replaces the one in the lab.
    /// [`AppEvent::Checked`] answers.
    Check {
        /// The number of the check, counted over all texts.
        ticket: u64,
        /// The name used in diagnostics.
        title: String,
        /// What is to be checked.
        text: String,
    },
    /// Run a job and cancel the previous one of the same asker; [`AppEvent::Computed`] answers.
    Compute(Computation),
    /// Cancel the job of an asker; there is no response.
    StopComputing(Asker),
    /// Cancel the check; there is no response.
    StopCheck,
    /// Write a text to its file if the file still has the expected contents. [`AppEvent::FileSaved`] answers.
    Save {
        /// The file.
        place: PathBuf,
        /// What is to be written.
        text: String,
        /// The expected contents of the file; with `None` the file is overwritten in any case.
        known: Option<String>,
    },
    /// Write a text to a new user preset, or to a new file. [`AppEvent::FileSaved`] answers.
    SaveCopy {
        /// A preset's name, or a file's path.
        name: String,
        /// What is to be written.
        text: String,
    },
    /// Read the system's file again; [`AppEvent::FileRead`] answers.
    Reread(PathBuf),
    /// Redraw every cell.
    Repaint,
    /// Draw at most this many frames per second.
    Frames(u16),
    /// Capture the mouse, or leave it to the terminal.
    Mouse(bool),
    /// Write a still image of the screen to a new file.
    Still,
    /// Put a text into the terminal's clipboard or, where it has none, write it to a new file with this ending.
    /// [`AppEvent::Written`] answers.
    Copy {
        /// What is copied, for the answer.
        what: &'static str,
        /// What is to be copied.
        text: String,
        /// The ending of the file.
        ending: &'static str,
    },
    /// Write the recorded motion as a table to a new file.
    Data,
    /// Start or stop recording the screen.
    Record(bool),
    /// Take a lesson, or perform a demo, on the screen of the lab; [`AppEvent::GuideLeft`] follows.
    TakeGuide(Guide),
    /// Suspend the process, as Ctrl-Z does.
    Suspend,
    /// End the program.
    Quit,
}

/// The result of checking a text.
#[derive(Clone, Debug)]
pub struct CheckedText {
    /// The ticket of the check.
    pub ticket: u64,
    /// The system it describes, already running, or its errors.
    pub outcome: Result<Loaded, Vec<Diagnostic>>,
    /// How long the check took, where there is a clock.
    pub took: Option<Duration>,
}

/// Why a text could not be saved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SaveError {
    /// The file has changed since it was read.
    Changed,
    /// A file of that name already exists.
    Exists(PathBuf),
    /// Any other reason, as a sentence.
    Refused(String),
}
