//! What can happen to the application, and what it then asks to be done.
//!
//! In: nothing. Out: [`Event`]s as the shell reports them, [`Effect`]s as the shell performs them, both plain data.
//! Never here: how anything is done.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use super::{Act, Checked, HitTarget, Key, SaveError};
use crate::diagnostic::Document;
use crate::experiment::{Command, Snapshot};
use crate::mechanics::Equations;
use crate::model::Model;
use crate::system::System;

/// Something that happened.
#[derive(Clone, Debug)]
pub enum Event {
    /// A key was pressed.
    Key(Key),
    /// Text was pasted; it counts only where text is typed.
    Paste(String),
    /// The screen has another size: columns, rows.
    Resize(u16, u16),
    /// The mouse did something at a spot that `view` has found.
    Mouse(Act, HitTarget),
    /// The window of the terminal has got the keyboard, or lost it.
    Focus(bool),
    /// The experiment has moved on. Snapshots of another epoch than the loaded system's are dropped.
    Snapshot(Arc<Snapshot>),
    /// A system asked for by [`Effect::Load`] is there, or is not.
    Loaded(Result<Loaded, LoadError>),
    /// A file that was asked for is written, or why it is not: a sentence.
    Written(Result<String, String>),
    /// The system in the lab was built anew from its changed file.
    Rebuilt(Loaded),
    /// A frame has passed, and this much time since the last one.
    Tick(Duration),
    /// A text that [`Effect::Check`] asked about is right and runs already, or is wrong.
    Checked(Box<Checked>),
    /// A text was saved to this file, or was not.
    FileSaved(Result<(PathBuf, String), SaveError>),
    /// The file of the system holds this text now.
    FileRead {
        /// Its text.
        text: String,
        /// Whether it was read because [`Effect::Reread`] asked for it.
        asked: bool,
    },
    /// The watched file of the system is there again, or is there no longer.
    FileThere(bool),
    /// The screen was drawn, and this is what came of it.
    Drawn(Drawn),
}

/// What drawing the screen has shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Drawn {
    /// How many rows of the page of text lie beyond the screen when it stands at its beginning.
    pub beyond: u16,
    /// How many of its rows the screen holds.
    pub rows: u16,
    /// How many columns of a text being edited it holds.
    pub columns: u16,
    /// Where the terminal's cursor belongs, column and row: in the text being typed, or at the line being read.
    pub cursor: Option<(u16, u16)>,
}

/// A system ready to be looked at.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// What was asked for: a preset's name or a file's path.
    pub name: String,
    /// The epoch of its snapshots.
    pub epoch: u64,
    /// The file's text.
    pub document: Arc<Document>,
    /// What the file says.
    pub model: Arc<Model>,
    /// What follows from it.
    pub equations: Arc<Equations>,
    /// The same as a program, with its channels.
    pub system: Arc<System>,
}

/// Why a system could not be loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadError {
    /// What was asked for.
    pub name: String,
    /// What is wrong, as it would be printed, in one or many lines.
    pub message: String,
}

/// Something to be done by the shell.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Hand a command to the experiment.
    Tell(Command),
    /// Load a preset or file and start it as a new experiment; [`Event::Loaded`] answers.
    Load(String),
    /// Load no longer what was asked for last; nothing answers.
    StopLoading,
    /// Write the present as a file of a system; [`Event::Written`] answers.
    Export,
    /// Check a text, and no longer the one before; where it is right, what it describes takes the place of the system in
    /// the lab. [`Event::Checked`] answers.
    Check {
        /// Counts the checks of all texts.
        ticket: u64,
        /// What reports call it.
        title: String,
        /// The text.
        text: String,
    },
    /// Check no text any more; nothing answers.
    StopCheck,
    /// Write a text to its file, if that still holds what is known of it. [`Event::FileSaved`] answers.
    Save {
        /// The file.
        place: PathBuf,
        /// The text.
        text: String,
        /// What the file should hold; `None` writes over whatever it holds.
        known: Option<String>,
    },
    /// Write a text to a new preset of the user's, or to a new file. [`Event::FileSaved`] answers.
    SaveCopy {
        /// A preset's name, or a file's path.
        name: String,
        /// The text.
        text: String,
    },
    /// Read the system's file anew; [`Event::FileRead`] answers.
    Reread(PathBuf),
    /// Draw every cell anew.
    Repaint,
    /// Draw at most so many frames in a second.
    Frames(u16),
    /// Have the terminal report the mouse, or leave it alone.
    Mouse(bool),
    /// Write a still of the screen into a fresh file.
    Still,
    /// Write the recorded motion as a table into a fresh file.
    Data,
    /// Begin to record what is shown, or end it.
    Record(bool),
    /// Stop the process as the terminal's Ctrl-Z does.
    Suspend,
    /// End the program.
    Quit,
}
