//! The lab on virtual time: the application and its experiment, without threads.
//!
//! In: events and the passing of frames. Out: an application whose effects are performed at once; effects on a
//! terminal or a file are ignored. Never here: scripts, or how anything looks.

use std::mem;
use std::sync::Arc;

use super::clock::{Clock, Micros};
use crate::app::{App, AppEvent, CheckedText, Effect, LoadError, Loaded, ValueId};
use crate::diagnostic::Document;
use crate::experiment::{AdvanceOutcome, Command, Experiment, Prepared, Status};
use crate::preset::Catalog;

/// The most steps and rows of a motion in one frame, at a finite speed and at an unlimited speed. A motion that is
/// too slow for its speed falls behind by the same amount on every machine.
#[derive(Clone, Copy, Debug)]
pub(super) struct Budget {
    paced: u64,
    flat_out: u64,
    /// The number of frames that may use up their steps before the motion is overdue; `None` for any number.
    overdue_after: Option<u32>,
}

impl Budget {
    /// For a recording, which runs unattended.
    pub(super) const RECORDED: Budget =
        Budget { paced: 100_000, flat_out: 20_000, overdue_after: Some(20) };

    /// For a live performance, in which a viewer may press a key.
    pub(super) const WATCHED: Budget =
        Budget { paced: 20_000, flat_out: 5_000, overdue_after: None };

    /// Whether nobody watches.
    pub(super) fn is_unattended(self) -> bool {
        self.overdue_after.is_some()
    }
}

/// The application and its experiment.
pub(super) struct HeadlessLab {
    pub(super) app: App,
    pub(super) clock: Clock,
    /// The system's name on the screen.
    pub(super) called: String,
    /// Whether the application was quit.
    pub(super) left: bool,
    document: Document,
    catalog: Catalog,
    experiment: Option<Experiment>,
    epoch: u64,
    /// The base of simulated time: the frame, the time, the speed.
    base: (u64, f64, f64),
    budget: Budget,
    /// The number of frames that used up their steps.
    behind: u32,
    repaint: bool,
}

impl HeadlessLab {
    /// Opens the lab with a system.
    pub(super) fn open(document: &Document, called: &str, fps: u32, budget: Budget) -> HeadlessLab {
        // the user's own presets are excluded, so that a demo is the same everywhere
        let catalog = Catalog::with_folder(None);
        let (app, effects) = App::new(&catalog, Some(called));
        let mut lab = HeadlessLab {
            app,
            clock: Clock::new(fps),
            called: called.to_owned(),
            left: false,
            document: document.clone(),
            catalog,
            experiment: None,
            epoch: 0,
            base: (0, 0.0, 1.0),
            budget,
            behind: 0,
            repaint: false,
        };
        lab.run_effects(effects);
        lab
    }

    /// Opens the same system in a new lab, as its file says.
    pub(super) fn anew(&self, fps: u32) -> HeadlessLab {
        HeadlessLab::open(&self.document, &self.called, fps, self.budget)
    }

    pub(super) fn now(&self) -> Micros {
        self.clock.now()
    }

    /// Advances to the next frame if it is due.
    pub(super) fn tick(&mut self) -> bool {
        let Some(elapsed) = self.clock.tick() else { return false };
        self.advance();
        self.update(AppEvent::Tick(elapsed));
        self.observe_motion();
        true
    }

    /// Why the recording stops, if the motion needs more steps than it may take.
    pub(super) fn overdue(&self) -> Option<String> {
        let (overdue_after, experiment) = (self.budget.overdue_after?, self.experiment.as_ref()?);
        (self.behind >= overdue_after).then(|| {
            format!(
                "the motion is too slow for this: {} frames took {} steps each and led only to t = {}",
                self.behind,
                self.budget.paced,
                experiment.time()
            )
        })
    }

    pub(super) fn update(&mut self, event: AppEvent) {
        let effects = self.app.update(event);
        self.run_effects(effects);
    }

    /// Sets a parameter or an initial value.
    pub(super) fn set(&mut self, target: ValueId, value: f64) {
        let effects = self.app.give(target, value);
        self.run_effects(effects);
    }

    pub(super) fn execute(&mut self, command: Command) {
        let Some(experiment) = &mut self.experiment else { return };
        let clockwork = |e: &Experiment| (e.status() == Status::Running, e.clock(), e.speed());
        let before = clockwork(experiment);
        experiment.execute(command);
        let after = clockwork(experiment);
        if after != before {
            self.base = (self.clock.frame(), after.1, after.2);
        }
        self.observe_motion();
    }

    /// Whether every cell must be painted again; resets the flag.
    pub(super) fn takes_repaint(&mut self) -> bool {
        mem::take(&mut self.repaint)
    }

    /// Advances the motion to its time at this frame.
    fn advance(&mut self) {
        let Some(experiment) = &mut self.experiment else { return };
        if experiment.status() != Status::Running {
            return;
        }
        let (frame, time, speed) = self.base;
        let now = self.clock.frame();
        let (target, budget) = if speed.is_finite() {
            (time + speed * self.clock.seconds(now - frame), self.budget.paced)
        } else {
            (f64::INFINITY, self.budget.flat_out)
        };
        let progress = experiment.advance(target, budget);
        if progress == AdvanceOutcome::Underway && target.is_finite() {
            self.behind += 1;
        }
        if progress != AdvanceOutcome::Arrived {
            self.base = (now, experiment.clock(), speed);
        }
    }

    fn observe_motion(&mut self) {
        if let Some(experiment) = &self.experiment {
            let snapshot = Arc::new(experiment.snapshot());
            self.update(AppEvent::Snapshot(snapshot));
        }
    }

    fn run_effects(&mut self, effects: Vec<Effect>) {
        for effect in effects {
            match effect {
                Effect::Execute(command) => self.execute(command),
                Effect::Load(name) => {
                    let loaded = self.load(name);
                    self.update(AppEvent::Loaded(loaded));
                    self.observe_motion();
                }
                Effect::Check { ticket, title, text } => self.check(ticket, title, text),
                Effect::Repaint => self.repaint = true,
                Effect::Quit => self.left = true,
                // A demo has no terminal to configure and no files to write.
                _ => {}
            }
        }
    }

    fn load(&mut self, name: String) -> Result<Loaded, LoadError> {
        let found = if name == self.called {
            Ok(self.document.clone())
        } else {
            self.catalog.find(&name).map_err(|why| why.to_string())
        };
        let ready = found.and_then(|document| Prepared::of(&document).map_err(|why| why.report));
        match ready {
            Err(message) => Err(LoadError { name, message }),
            Ok(ready) => Ok(self.begin(name, ready)),
        }
    }

    fn begin(&mut self, name: String, ready: Prepared) -> Loaded {
        self.epoch += 1;
        Loaded::of(name, ready, |mut experiment| {
            experiment.set_epoch(self.epoch);
            self.base = (self.clock.frame(), experiment.clock(), experiment.speed());
            self.experiment = Some(experiment);
            self.epoch
        })
    }

    /// Checks a text being edited; one without errors runs at once.
    fn check(&mut self, ticket: u64, title: String, text: String) {
        let Some(name) = self.app.checked_system().filter(|_| self.app.awaits(ticket)) else {
            return;
        };
        let outcome = match Prepared::of(&Document::new(title, text)) {
            Ok(ready) => Ok(self.begin(name, ready)),
            Err(error) => Err(error.diagnostics),
        };
        self.update(AppEvent::Checked(Box::new(CheckedText { ticket, outcome, took: None })));
        self.observe_motion();
    }
}
