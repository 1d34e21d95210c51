//! A demo that is recorded on a thread of its own while what there is of it is shown.
//!
//! In: a script and its system. Out: the events of its recording as they come, then the whole recording, the same as without
//! anybody watching. Never here: how it is shown, or what a script does.

use std::ops::ControlFlow;
use std::sync::mpsc::{Receiver, channel};

use crate::diagnostic::{Diagnostic, Document};
use crate::job::{Job, Outcome};
use crate::record::{CastEvent, Recording, RecordingEvent, Script, called, play_while};
use crate::worker::SideJob;

/// A time in microseconds.
type Micros = u64;

/// The events of a recording since the last ones, and the time that is reached.
type NewEvents = (Vec<(Micros, CastEvent)>, Micros);

/// Why there is no recording.
#[derive(Debug)]
pub enum NotRecorded {
    /// The script is wrong.
    Script(Vec<Diagnostic>),
    /// It could not be made, for the reason given in a sentence.
    Failed(String),
}

/// A recording in progress. It ends when it is dropped.
#[derive(Debug)]
pub struct RecordingAhead {
    /// Columns and rows.
    pub(super) size: (u16, u16),
    side: SideJob<Result<Recording, Vec<Diagnostic>>>,
    new: Receiver<NewEvents>,
}

impl RecordingAhead {
    /// Begins to record a script about a system, which has this name on the screen; `size` is that of the screen if the
    /// script does not give one.
    pub fn begin(script: Script, system: Document, name: &str, size: (u16, u16)) -> Self {
        let (sender, new) = channel();
        let name = called(name).to_owned();
        let shown = script.head.size.unwrap_or(size);
        let job = Job::new(format!("the recording of {name}"), move |progress| {
            let mut wanted = |events: &[(Micros, RecordingEvent)], reached| {
                let events = events.iter().cloned().map(|(time, event)| (time, event.into()));
                let heard = sender.send((events.collect(), reached)).is_ok();
                let on = heard && !progress.is_cancelled();
                if on { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
            };
            let recording = play_while(&script, &system, (&name, size), &mut wanted);
            recording.map(|(recording, _)| recording)
        });
        let mut side = SideJob::new("recorder");
        side.begin(0, job);
        Self { size: shown, side, new }
    }

    /// The events that are new, with the time that is reached, and how it ended once it has; then nothing is to come.
    pub(super) fn take(&mut self) -> (Vec<NewEvents>, Option<Result<Recording, NotRecorded>>) {
        // what has ended has sent all its events before
        let ended = self.side.take().and_then(|(_, outcome)| match outcome {
            Outcome::Done(recording) => Some(recording.map_err(NotRecorded::Script)),
            Outcome::Failed(sentence) => Some(Err(NotRecorded::Failed(sentence))),
            Outcome::Cancelled => None,
        });
        (self.new.try_iter().collect(), ended)
    }
}
