//! The drift of the energies of several motions side by side.
//!
//! In: the states where they begin, those of all at the ends of their steps, and where each ends. Out: what a [`DriftWatch`] of each
//! alone gives, to the last bit. Never here: which motions, the steps themselves.

use std::sync::Arc;

use super::drift_watch::DriftWatch;
use super::snapshot::Gauge;
use crate::integrate::{BatchPropagator, LaneStatus};
use crate::mechanics::Equations;
use crate::model::Model;
use crate::num::{BATCH, Batch};
use crate::system::{BatchTerms, Form, MotionError, State, System, TermSums};

/// What is watched of several motions, one in each lane.
pub struct DriftWatchBatch {
    lanes: [DriftWatch; BATCH],
    /// The terms of all lanes, where they can be evaluated together.
    terms: Option<BatchTerms>,
    summed: Vec<SummedQuantity>,
}

/// A quantity whose terms are added up after every step.
struct SummedQuantity {
    /// Its place in a watch.
    place: usize,
    quantity: usize,
    /// What each term was at rest.
    at_rest: Vec<Batch>,
    /// The sums at the last states.
    sums: [TermSums; BATCH],
}

impl DriftWatchBatch {
    /// A watch for motions of a system, whose states have this form. Each must [begin](DriftWatchBatch::begin).
    pub fn new(
        model: &Arc<Model>,
        equations: &Arc<Equations>,
        system: &System,
        form: Form,
    ) -> DriftWatchBatch {
        let watch = DriftWatch::new(model, equations, system);
        DriftWatchBatch {
            lanes: std::array::from_fn(|_| watch.clone()),
            terms: system.batch_terms(form),
            summed: Vec::new(),
        }
    }

    /// Begins a motion in a lane.
    ///
    /// # Errors
    /// Returns an error if the state cannot be observed.
    pub fn begin(
        &mut self,
        lane: usize,
        state: &State,
        parameters: &[f64],
    ) -> Result<(), MotionError> {
        self.lanes[lane].begin(state, parameters)?;
        if let Some(terms) = &mut self.terms {
            terms.set_parameters(lane, parameters);
            let has = |&(_, quantity, _): &(usize, usize, &[f64])| terms.has(quantity);
            for (i, (place, quantity, own)) in self.lanes[lane].summed().filter(has).enumerate() {
                if i == self.summed.len() {
                    let at_rest = vec![Batch::splat(0.0); own.len()];
                    let sums = [TermSums::NOTHING; BATCH];
                    self.summed.push(SummedQuantity { place, quantity, at_rest, sums });
                }
                for (all, &own) in self.summed[i].at_rest.iter_mut().zip(own) {
                    all.0[lane] = own;
                }
            }
        }
        Ok(())
    }

    /// Observes the ends of steps, in the lanes that are under way.
    pub fn step(&mut self, batch: &mut BatchPropagator) {
        let mut together = [false; BATCH];
        if let Some(terms) = &mut self.terms {
            let states = batch.states();
            terms.evaluate_numbers(states.times(), states.numbers());
            together = terms.regular_lanes();
            for own in &mut self.summed {
                own.sums = terms.sums_of_each(own.quantity, &own.at_rest);
            }
        }
        for lane in 0..BATCH {
            if batch.status(lane) != LaneStatus::Underway {
                continue;
            }
            match self.terms.as_ref().filter(|_| together[lane]) {
                Some(terms) => {
                    let sums = self.summed.iter().map(|own| (own.place, own.sums[lane]));
                    let (time, batch) = (batch.time(lane), &mut *batch);
                    let own = &mut self.lanes[lane];
                    own.step_with(time, move || batch.state(lane), sums, terms.work(lane));
                }
                None => self.lanes[lane].step(batch.state(lane)),
            }
        }
    }

    /// Ends the motion of a lane at a state, and returns the value of every channel and the gauges there.
    ///
    /// # Errors
    /// Returns an error if the state cannot be observed.
    pub fn end(
        &mut self,
        lane: usize,
        state: &State,
    ) -> Result<(&[f64], Arc<[Gauge]>), MotionError> {
        self.lanes[lane].end(state)
    }
}
