//! What jobs have found for the lab, and those that have not ended.
//!
//! In: outcomes. Out: the last answer for each plot, the equilibria and symmetries found. Never here: which jobs are needed.

use std::sync::Arc;
use std::time::Duration;

use super::InvariantSearch;
use super::computation::UnderWay;
use crate::instrument::{Answer, Columns, FoundEquilibria, Instrument, PeriodicOrbits, Plot};
use crate::integrability::PointSymmetry;
use crate::job::Outcome;
use crate::mechanics::{Equations, Further};
use crate::model::{Model, Variation};

/// The results and running jobs for the plots of a lab.
#[derive(Clone, Debug, Default)]
pub(super) struct Answers {
    pub(super) entries: Vec<PlotJob>,
    pub(super) periodic: Vec<Arc<PeriodicOrbits>>,
    /// Whether something has changed since the needs were last determined.
    pub(super) stale: bool,
    /// Whether a job waits until the values rest.
    pub(super) waits: bool,
    /// The bits of the values when jobs were last asked for, and for how long they have been these.
    resting: (Vec<u64>, Duration),
}

/// How long values have not changed when they rest: longer than a frame.
const REST: Duration = Duration::from_millis(100);

/// The last result for a plot, and the job under way.
#[derive(Clone, Debug)]
pub(super) struct PlotJob {
    pub(super) kind: &'static dyn Instrument,
    pub(super) columns: Columns,
    pub(super) view: Option<usize>,
    pub(super) over: Vec<Variation>,
    pub(super) answer: Option<Answer>,
    pub(super) under_way: Option<UnderWay>,
    /// Whether the last frame drew its plot: what nobody sees is not carried on.
    pub(super) is_drawn: bool,
}

impl PlotJob {
    /// Whether it belongs to a plot with these contents, whatever its view.
    pub(super) fn is_of(&self, plot: &Plot) -> bool {
        (self.kind, &self.columns) == (plot.kind, &plot.columns)
            && (self.view, &self.over) == (plot.view, &plot.over)
    }
}

/// The search for the equilibria of a lab, and what it has found.
#[derive(Clone, Debug, Default)]
pub(super) struct EquilibriaSearch {
    pub(super) under_way: Option<UnderWay>,
    pub(super) found: Option<Arc<FoundEquilibria>>,
}

#[derive(Clone, Debug, Default)]
pub(super) struct SymmetrySearch {
    /// The symmetries that were found, with the values of the parameters.
    pub(super) found: Option<Arc<FoundSymmetries>>,
    /// The ticket of the search that is waited for.
    pub(super) awaited: Option<u64>,
}

#[derive(Clone, Debug)]
pub(super) struct FoundSymmetries {
    /// The system with its numbers that are no short fractions as parameters.
    pub(super) model: Model,
    /// The equations, in which the changes stand.
    pub(super) equations: Equations,
    pub(super) parameters: Vec<f64>,
    pub(super) found: Vec<PointSymmetry>,
    /// How many more there are that are not written.
    pub(super) missing: usize,
}

impl EquilibriaSearch {
    pub(super) fn tick(&mut self, elapsed: Duration) {
        self.under_way.iter_mut().for_each(|job| job.tick(elapsed));
    }
}

impl Answers {
    pub(super) fn tick(&mut self, elapsed: Duration) {
        self.resting.1 = self.resting.1.saturating_add(elapsed);
        self.all_under_way().for_each(|job| job.tick(elapsed));
    }

    /// Whether these values have not changed for a while.
    pub(super) fn rest(&mut self, values: impl Iterator<Item = f64>) -> bool {
        let values: Vec<u64> = values.map(f64::to_bits).collect();
        if values != self.resting.0 {
            self.resting = (values, Duration::ZERO);
        }
        self.resting.1 >= REST
    }

    pub(super) fn all_under_way(&mut self) -> impl Iterator<Item = &mut UnderWay> {
        self.entries.iter_mut().filter_map(|entry| entry.under_way.as_mut())
    }

    pub(super) fn of(&self, plot: &Plot) -> Option<&PlotJob> {
        self.entries.iter().find(|entry| entry.is_of(plot))
    }

    /// Takes over what stays of another law's answers, whose columns have these places now; a plot without all of its columns
    /// is left out.
    pub(super) fn inherit(&mut self, old: &Answers, place: &dyn Fn(usize) -> Option<usize>) {
        for entry in &old.entries {
            let columns = entry.columns.iter();
            let columns: Option<Columns> =
                columns.map(|axis| axis.iter().map(|&column| place(column)).collect()).collect();
            let answer = entry.answer.as_ref().and_then(|answer| entry.kind.inherited(answer));
            if let (Some(columns), Some(answer)) = (columns, answer) {
                let answer = Some(answer);
                self.entries.push(PlotJob { columns, answer, under_way: None, ..entry.clone() });
            }
        }
    }

    /// Replaces the plots, and collects the periodic orbits among their answers.
    pub(super) fn replace(&mut self, entries: Vec<PlotJob>) {
        self.entries = entries;
        let found = |entry: &PlotJob| entry.kind.periodic(entry.answer.as_ref()?);
        self.periodic = self.entries.iter().filter_map(found).collect();
    }

    /// Up to when everything that is drawn and carried along beside the motion is known; infinite if there is no such thing.
    pub(super) fn known_until(&self) -> f64 {
        let known = |entry: &PlotJob| entry.kind.known_until(entry.answer.as_ref()?);
        self.entries
            .iter()
            .filter(|entry| entry.is_drawn)
            .filter_map(known)
            .fold(f64::INFINITY, f64::min)
    }

    /// Takes in an outcome. Returns whether it was wanted.
    pub(super) fn take(&mut self, ticket: u64, outcome: &Outcome<Answer>) -> bool {
        let waits =
            |entry: &&mut PlotJob| entry.under_way.as_ref().is_some_and(|job| job.ticket == ticket);
        let Some(entry) = self.entries.iter_mut().find(waits) else { return false };
        entry.under_way = None;
        self.stale = true;
        if let Outcome::Done(answer) = outcome {
            entry.answer = Some(answer.clone());
        }
        true
    }
}

/// What was found, with the equations in whose pool it is.
#[derive(Debug)]
pub struct FurtherForms {
    /// Those in whose pool the results are.
    pub equations: Equations,
    /// What was found.
    pub further: Further,
}

/// What takes longer to derive from the law, each by one job.
#[derive(Clone, Debug, Default)]
pub(super) struct Derivations {
    /// The ticket of the job that finds the closed forms of the equations, once it was requested.
    pub(super) closed_forms: Option<u64>,
    /// The ticket of the job that finds the further forms.
    pub(super) further_job: Option<u64>,
    pub(super) further: Option<Arc<FurtherForms>>,
}

/// What a person has the lab search for.
#[derive(Clone, Debug, Default)]
pub struct Searches {
    /// The constants of the motion.
    pub constants: InvariantSearch,
    pub(super) equilibria: EquilibriaSearch,
    pub(super) symmetries: SymmetrySearch,
    pub(super) flow: Option<u64>,
}

impl Searches {
    pub(super) fn tick(&mut self, elapsed: Duration) {
        self.constants.tick(elapsed);
        self.equilibria.tick(elapsed);
    }
}
