//! Jobs: what is computed on the side, asked for, under way and answered.
//!
//! In: what instruments and the prompt need. Out: [`Effect::Compute`], and the answers in their places. An answer to what
//! nobody waits for any more is dropped: its number is not known. Never here: threads, or what is computed.

use std::time::Duration;

use super::{App, Effect, Event, Lab, Overlay};
use crate::instrument::{Answer, Columns, Instrument, Need, Plot};
use crate::job::{Job, Outcome, Progress, Share};

/// A job that takes longer than this is shown to be under way.
const PATIENCE: Duration = Duration::from_millis(300);

/// Who asked for a job; each has one at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Asker {
    /// The plot of this place.
    Plot(usize),
    /// The prompt for brackets.
    Prompt,
}

/// A job to be run on the side.
#[derive(Clone, Debug, PartialEq)]
pub struct Computation {
    /// Its number.
    pub ticket: u64,
    /// Who asked for it.
    pub asker: Asker,
    /// The job.
    pub job: Job<Answer>,
}

/// A job that has not ended.
#[derive(Clone, Debug)]
pub struct UnderWay {
    pub(super) ticket: u64,
    name: String,
    since: Duration,
    share: Share,
}

impl UnderWay {
    /// A job that begins now.
    pub(super) fn new(computation: &Computation) -> Self {
        let name = computation.job.name.clone();
        let (since, share) = (Duration::ZERO, Share::default());
        Self { ticket: computation.ticket, name, since, share }
    }

    /// Time has passed.
    pub(super) fn tick(&mut self, elapsed: Duration) {
        self.since = self.since.saturating_add(elapsed);
    }

    /// How far it is.
    pub(super) fn reach(&mut self, ticket: u64, share: Share) {
        if ticket == self.ticket {
            self.share = share;
        }
    }

    /// What is reported of it once it has taken a while: its name and how far it is.
    pub fn told(&self) -> Option<String> {
        let share = self.share.total.map_or_else(String::new, |total| {
            format!(" {} %", self.share.done * 100 / total.max(1))
        });
        (self.since >= PATIENCE).then(|| format!("{}{share} …", self.name))
    }
}

/// What was computed for the plots of a lab, and what is.
#[derive(Clone, Debug, Default)]
pub(super) struct Answers {
    entries: Vec<Entry>,
    /// Whether something has changed since it was last looked at what is needed.
    pub(super) stale: bool,
}

/// The answer to what a plot needed last, and the job under way.
#[derive(Clone, Debug)]
struct Entry {
    kind: &'static dyn Instrument,
    columns: Columns,
    view: Option<usize>,
    answer: Option<Answer>,
    under_way: Option<UnderWay>,
}

impl Entry {
    /// Whether it is that of a plot, however that is looked at.
    fn is_of(&self, plot: &Plot) -> bool {
        self.kind == plot.kind && self.columns == plot.columns && self.view == plot.view
    }
}

impl Answers {
    /// Time has passed.
    pub(super) fn tick(&mut self, elapsed: Duration) {
        self.all_under_way().for_each(|job| job.tick(elapsed));
    }

    fn all_under_way(&mut self) -> impl Iterator<Item = &mut UnderWay> {
        self.entries.iter_mut().filter_map(|entry| entry.under_way.as_mut())
    }

    fn of(&self, plot: &Plot) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.is_of(plot))
    }

    /// Takes a result in; whether somebody waited for it.
    fn take(&mut self, ticket: u64, outcome: &Outcome<Answer>) -> bool {
        let waits =
            |entry: &&mut Entry| entry.under_way.as_ref().is_some_and(|job| job.ticket == ticket);
        let Some(entry) = self.entries.iter_mut().find(waits) else { return false };
        entry.under_way = None;
        self.stale = true;
        if let Outcome::Done(answer) = outcome {
            entry.answer = Some(answer.clone());
        }
        true
    }
}

impl Lab {
    /// What was computed for a plot.
    pub fn answer(&self, plot: &Plot) -> Option<&Answer> {
        self.answers.of(plot)?.answer.as_ref()
    }

    /// What is computed for a plot, if it is.
    pub fn under_way(&self, plot: &Plot) -> Option<&UnderWay> {
        self.answers.of(plot)?.under_way.as_ref()
    }

    /// The jobs that plots need and that are not under way, numbered on from `tickets`.
    fn needs(&mut self, tickets: &mut u64) -> Vec<Computation> {
        let mut kept = Vec::new();
        let mut wanted: Vec<Computation> = Vec::new();
        for (place, plot) in self.plots.iter().enumerate() {
            let Some(present) = self.present() else { return Vec::new() };
            let entry = self.answers.of(plot);
            if kept.iter().any(|entry: &Entry| entry.is_of(plot)) {
                continue;
            }
            if let Some(entry) = entry.filter(|entry| entry.under_way.is_some()) {
                kept.push(entry.clone());
                continue;
            }
            let answer = entry.and_then(|entry| entry.answer.clone());
            let under_way = match plot.kind.job(plot, &present, answer.as_ref()) {
                Need::Nothing => continue,
                Need::Held => None,
                Need::Job(job) => {
                    *tickets += 1;
                    let asker = Asker::Plot(place);
                    let computation = Computation { ticket: *tickets, asker, job };
                    let under_way = UnderWay::new(&computation);
                    wanted.push(computation);
                    Some(under_way)
                }
            };
            let (kind, columns, view) = (plot.kind, plot.columns.clone(), plot.view);
            kept.push(Entry { kind, columns, view, answer, under_way });
        }
        self.answers.entries = kept;
        wanted
    }
}

impl App {
    /// A job as it is handed out.
    pub(super) fn computation(&mut self, asker: Asker, job: Job<Answer>) -> Computation {
        self.jobs += 1;
        Computation { ticket: self.jobs, asker, job }
    }

    /// The jobs that the pictures need now; they run at once where they are not handed out.
    pub(super) fn look_after_jobs(&mut self, effects: &mut Vec<Effect>) {
        let Some(lab) = &mut self.lab else { return };
        // a flood of keys that change no picture costs nothing
        let stale = std::mem::take(&mut lab.answers.stale);
        let wanted = if stale { lab.needs(&mut self.jobs) } else { Vec::new() };
        effects.extend(wanted.into_iter().map(Effect::Compute));
        if self.aside {
            return;
        }
        let (jobs, rest) = std::mem::take(effects)
            .into_iter()
            .partition(|effect| matches!(effect, Effect::Compute(_) | Effect::StopComputing(_)));
        *effects = rest;
        let jobs: Vec<Effect> = jobs;
        for effect in jobs {
            if let Effect::Compute(Computation { ticket, job, .. }) = effect {
                let outcome = job.run(&Progress::new());
                effects.extend(self.handle(Event::Computed { ticket, outcome }));
            }
        }
    }

    /// A job has ended. What nobody waits for is dropped.
    pub(super) fn computed(&mut self, ticket: u64, outcome: Outcome<Answer>) -> Vec<Effect> {
        let lab = self.lab.as_mut();
        let waited = match &mut self.overlay {
            Some(Overlay::Prompt(prompt)) if prompt.awaits(ticket) => {
                prompt.take(&outcome);
                true
            }
            _ => lab.is_some_and(|lab| lab.answers.take(ticket, &outcome)),
        };
        match outcome {
            Outcome::Failed(sentence) if waited => self.notify(sentence),
            _ => Vec::new(),
        }
    }

    /// A job is so far.
    pub(super) fn progressed(&mut self, ticket: u64, share: Share) {
        let answers = self.lab.as_mut().map(|lab| &mut lab.answers);
        answers
            .into_iter()
            .flat_map(Answers::all_under_way)
            .for_each(|job| job.reach(ticket, share));
        if let Some(Overlay::Prompt(prompt)) = &mut self.overlay {
            prompt.under_way.iter_mut().for_each(|(_, job)| job.reach(ticket, share));
        }
    }
}
