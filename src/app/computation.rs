//! A job in the background: who asked for it, and how far it is.
//!
//! In: jobs. Out: [`Computation`]s for the shell, [`UnderWay`] while they run. Never here: threads, or what is computed.

use std::time::Duration;

use crate::instrument::Answer;
use crate::job::{Job, Share};

/// A job that takes longer than this is reported as under way.
pub(super) const NOTICE_DELAY: Duration = Duration::from_millis(300);

/// The requester of a job; each has at most one job at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Asker {
    /// The plot of this index.
    Plot(usize),
    /// The prompt for brackets.
    Prompt,
    /// The lab, for the equilibria of its system.
    Equilibria,
    /// The lab, for the closed forms of its equations.
    Equations,
    /// The page of equations, for constants of the motion.
    Search,
    /// The lab, for the state that a flow leads to.
    Flow,
    /// The lab, for the symmetries of its equations.
    Symmetries,
}

/// The background jobs requested by an application.
#[derive(Clone, Debug, Default)]
pub struct Jobs {
    /// Whether jobs are sent out by [`Effect::Compute`](super::Effect::Compute), so that no frame waits for them; otherwise they run at once.
    pub in_background: bool,
    /// The number requested so far.
    count: u64,
}

impl Jobs {
    pub(super) fn request(&mut self, asker: Asker, job: Job<Answer>) -> Computation {
        self.count += 1;
        Computation { ticket: self.count, asker, job }
    }
}

/// A job to be run in the background.
#[derive(Clone, Debug, PartialEq)]
pub struct Computation {
    /// The number by which its outcome finds whoever asked for it.
    pub ticket: u64,
    /// Its requester.
    pub asker: Asker,
    /// What is to be computed, for a thread beside the screen.
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
    /// A job that starts now.
    pub(super) fn new(computation: &Computation) -> Self {
        let name = computation.job.name.clone();
        let (since, share) = (Duration::ZERO, Share::default());
        Self { ticket: computation.ticket, name, since, share }
    }

    pub(super) fn tick(&mut self, elapsed: Duration) {
        self.since = self.since.saturating_add(elapsed);
    }

    pub(super) fn reach(&mut self, ticket: u64, share: Share) {
        if ticket == self.ticket {
            self.share = share;
        }
    }

    /// Returns the name and progress of a job that has taken a while.
    pub fn status(&self) -> Option<String> {
        let share = self.share.total.map_or_else(String::new, |total| {
            format!(" {} %", self.share.done * 100 / total.max(1))
        });
        (self.since >= NOTICE_DELAY).then(|| format!("{}{share} …", self.name))
    }
}
