//! A demo that is recorded on a thread of its own while what there is of it is shown.
//!
//! In: a script and its system. Out: the events of its recording as they come, then the whole recording, the same as without
//! anybody watching, or what was not checked because it was left before. Never here: how it is shown, or what a script does.

use std::ops::ControlFlow;
use std::sync::mpsc::{Receiver, channel};

use crate::diagnostic::{Diagnostic, Document};
use crate::job::{Job, Outcome};
use crate::record::{CastEvent, Micros, Recording, RecordingSoFar, Script, called, play_while};
use crate::worker::SideJob;

#[derive(Debug)]
pub(super) struct NewEvents {
    /// The events since the last ones.
    pub(super) events: Vec<(Micros, CastEvent)>,
    pub(super) reached: Micros,
    /// The number of claims that were checked, and those of them that are false.
    claims: usize,
    false_claims: Vec<Diagnostic>,
}

/// Why there is no recording.
#[derive(Debug)]
pub enum NotRecorded {
    /// The script is wrong.
    Script(Vec<Diagnostic>),
    /// It could not be made, for the reason given in a sentence.
    Failed(String),
    /// It was left before it was complete.
    Left(LeftRecording),
}

/// How far a recording came that was left before it was complete.
#[derive(Clone, Debug)]
pub struct LeftRecording {
    /// The time that was reached, in microseconds.
    pub reached: Micros,
    /// The number of claims that were checked, and of all that the script makes.
    pub claims: (usize, usize),
    /// Those that did not hold so far.
    pub false_claims: Vec<Diagnostic>,
}

/// A recording in progress. It ends when it is dropped.
#[derive(Debug)]
pub struct RecordingAhead {
    /// Columns and rows.
    pub(super) size: (u16, u16),
    side: SideJob<Result<Recording, Vec<Diagnostic>>>,
    new: Receiver<NewEvents>,
    so_far: LeftRecording,
}

impl RecordingAhead {
    /// Begins to record a script about a system, which has this name on the screen; `size` is that of the screen if the
    /// script does not give one.
    pub fn begin(script: Script, system: Document, name: &str, size: (u16, u16)) -> Self {
        let (sender, new) = channel();
        let name = called(name).to_owned();
        let shown = script.head.size.unwrap_or(size);
        let claims = (0, script.claims());
        let job = Job::new(format!("the recording of {name}"), move |progress| {
            let mut wanted = |so_far: RecordingSoFar<'_>| {
                let RecordingSoFar { new, reached, claims, false_claims } = so_far;
                let events = new.iter().cloned().map(|(time, event)| (time, event.into()));
                let (events, false_claims) = (events.collect(), false_claims.to_vec());
                let heard =
                    sender.send(NewEvents { events, reached, claims, false_claims }).is_ok();
                let on = heard && !progress.is_cancelled();
                if on { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
            };
            let recording = play_while(&script, &system, (&name, size), &mut wanted);
            recording.map(|(recording, _)| recording)
        });
        let mut side = SideJob::new("recorder");
        side.begin(0, job);
        let so_far = LeftRecording { reached: 0, claims, false_claims: Vec::new() };
        Self { size: shown, side, new, so_far }
    }

    /// The events that are new, with the time that is reached, and how it ended once it has; then nothing is to come.
    pub(super) fn take(&mut self) -> (Vec<NewEvents>, Option<Result<Recording, NotRecorded>>) {
        // what has ended has sent all its events before
        let ended = self.side.take().and_then(|(_, outcome)| match outcome {
            Outcome::Done(recording) => Some(recording.map_err(NotRecorded::Script)),
            Outcome::Failed(sentence) => Some(Err(NotRecorded::Failed(sentence))),
            Outcome::Cancelled => None,
        });
        let new: Vec<NewEvents> = self.new.try_iter().collect();
        if let Some(last) = new.last() {
            (self.so_far.reached, self.so_far.claims.0) = (last.reached, last.claims);
            self.so_far.false_claims.clone_from(&last.false_claims);
        }
        (new, ended)
    }

    /// How far it came, where nobody waits for its end: what is shown last was handed over before.
    pub(super) fn left(mut self) -> Result<Recording, NotRecorded> {
        match self.take() {
            (_, Some(ended)) => ended,
            (_, None) => Err(NotRecorded::Left(self.so_far)),
        }
    }
}
