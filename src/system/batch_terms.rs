//! The terms of the conserved quantities of several orbits at once.
//!
//! In: a state and parameters for each lane, which may be one orbit's at several times. Out: the terms
//! that a [`TermWatch`](super::TermWatch) of that orbit alone evaluates, and their sums, to the last bit; none in lanes whose numbers may leave the range of
//! `f64`. Never here: systems whose terms take the solution of linear equations.

use std::sync::Arc;

use super::batch_values::BatchValues;
use super::compiled::System;
use super::state::Form;
use super::term_watch::TermSums;
use super::terms::{AtRest, OutputPlace};
use crate::num::{Analytic, BATCH, Batch, Kernel, vectorized};

/// Evaluates the terms of several orbits.
#[derive(Clone, Debug)]
pub struct BatchTerms {
    system: System,
    values: BatchValues,
    places: Arc<[Option<OutputPlace>]>,
    /// The number of a state that each input of the program is, if any.
    numbers: Vec<Option<usize>>,
    /// The number of a state that is the work done, if states carry it, and its values.
    work_place: Option<usize>,
    work: Batch,
}

impl System {
    /// The terms of the conserved quantities of several orbits, whose states have this form; `None`
    /// where they have to be evaluated one by one.
    pub fn batch_terms(&self, form: Form) -> Option<BatchTerms> {
        let terms = &self.shared.terms;
        let native = form == self.form();
        let program = if native { &terms.native } else { terms.canonical.as_ref()? };
        if self.has_branches() {
            return None;
        }
        let values = BatchValues::new(program)?;
        let [carries_action, _] = self.carries();
        let action = carries_action.then_some(self.driven_len());
        let numbers = (0..self.motion_len()).map(Some).chain([action]).collect();
        Some(BatchTerms {
            system: self.clone(),
            values,
            places: Arc::clone(&terms.places),
            numbers,
            work_place: self.work_place(),
            work: Batch::ZERO,
        })
    }
}

impl BatchTerms {
    /// Sets the parameters of a lane.
    pub fn set_parameters(&mut self, lane: usize, parameters: &[f64]) {
        self.values.set_parameters(lane, &self.system.inputs(parameters));
    }

    /// Evaluates the states that have these numbers at these times, one in each lane.
    pub fn evaluate_numbers(&mut self, times: Batch, numbers: &[Batch]) {
        let input = |place: &Option<usize>| place.map_or(Batch::ZERO, |place| numbers[place]);
        self.values.evaluate(times, self.numbers.iter().map(input));
        self.work = self.work_place.map_or(Batch::ZERO, |place| numbers[place]);
    }

    /// Whether the terms of the first lanes need not be evaluated alone.
    pub fn are_regular(&self, lanes: usize) -> bool {
        self.regular_lanes()[..lanes].iter().all(|&regular| regular)
    }

    /// The lanes whose terms need not be evaluated alone.
    pub fn regular_lanes(&self) -> [bool; BATCH] {
        self.values.regular_lanes()
    }

    /// Whether a quantity (0 for the energy, then the conserved quantities in order) can be evaluated.
    pub fn has(&self, quantity: usize) -> bool {
        self.places.get(quantity).is_some_and(Option::is_some)
    }

    /// The sums over the terms of a quantity whose values at rest were these.
    pub fn sums(&self, quantity: usize, were: &[f64]) -> [TermSums; BATCH] {
        let were = |k: usize| were.get(k).copied().map(Batch::splat);
        vectorized(SumsKernel { terms: self, quantity, were })
    }

    /// The same where each lane had its own values at rest.
    pub fn sums_of_each(&self, quantity: usize, were: &[Batch]) -> [TermSums; BATCH] {
        vectorized(SumsKernel { terms: self, quantity, were: |k: usize| were.get(k).copied() })
    }

    /// The work done on the motion of a lane; zero if states do not carry it.
    pub fn work(&self, lane: usize) -> f64 {
        self.work.0[lane]
    }
}

struct SumsKernel<'a, W> {
    terms: &'a BatchTerms,
    quantity: usize,
    /// What each term was at rest, if it is known.
    were: W,
}

impl<W: Fn(usize) -> Option<Batch>> Kernel for SumsKernel<'_, W> {
    type Output = [TermSums; BATCH];
    const OF_SEVERAL: bool = true;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> [TermSums; BATCH] {
        let SumsKernel { terms, quantity, were } = self;
        let negative_zero = Batch::splat(-0.0);
        let (mut value, mut size, mut moving) = (negative_zero, negative_zero, negative_zero);
        let place = terms.places.get(quantity).and_then(Option::as_ref);
        let as_a_whole = place.is_some_and(|place| place.exchanges);
        let (mut all_beyond, mut changed_at_rest) = (Batch::ZERO, Batch::ZERO);
        let (first, rests) = place.map_or((0, &[][..]), |place| (place.first, &place.terms));
        let mut outputs = terms.values.outputs_from(first);
        let mut next = || outputs.next();
        for (k, rest) in rests.iter().enumerate() {
            let Some(term) = next() else { break };
            let mut its_size = term.abs();
            let rest = match rest {
                AtRest::Same => term,
                AtRest::Nothing => Batch::ZERO,
                AtRest::Other => next().unwrap_or(term),
                AtRest::Cancels => {
                    its_size = its_size + next().unwrap_or(Batch::ZERO).abs();
                    Batch::ZERO
                }
            };
            value = value + term;
            size = size + its_size;
            let beyond = (term - rest).abs();
            all_beyond = all_beyond + beyond;
            if let Some(were) = were(k) {
                let change = rest - were;
                let both = beyond + change.abs();
                // zero times what is not finite is NaN, and equal to nothing
                let finite = both * 0.0;
                let own = if as_a_whole { beyond } else { both };
                moving = moving + finite.where_equal(0.0, own, term.abs());
                if as_a_whole {
                    let change = finite.where_equal(0.0, change, Batch::ZERO);
                    changed_at_rest = changed_at_rest + change;
                }
            }
        }
        moving = moving + changed_at_rest.abs();
        std::array::from_fn(|lane| TermSums {
            value: value.0[lane],
            size: size.0[lane],
            moving: moving.0[lane],
            beyond: all_beyond.0[lane],
        })
    }
}
