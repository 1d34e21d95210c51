//! The conserved quantities of a system term by term, in `f64`: cheap enough to be evaluated after
//! every step.
//!
//! In: the state of any method. Out: the value of each quantity, and the varying part of it: the
//! amount by which its terms exceed their values at rest, and by which the latter have changed, those of an energy
//! all together. A constant in the potential, or the origin of a coordinate, does not contribute to it. Never here:
//! references, drifts, verdicts.

use std::sync::Arc;

use super::native_states::NativeStates;
use super::terms::{AtRest, OutputPlace, Terms};
use super::value::Evaluator;
use super::{Form, State, System};

/// Evaluates the quantities of one system's states at one set of parameters. It owns its registers.
#[derive(Clone, Debug)]
pub struct TermWatch {
    system: System,
    places: Arc<[Option<OutputPlace>]>,
    native: Evaluator<f64>,
    canonical: Option<Evaluator<f64>>,
    native_states: NativeStates,
    inputs: Vec<f64>,
    /// The time of the last state, and whether its numbers are canonical variables beside a native form that is not.
    time: f64,
    at_canonical: bool,
    /// The terms at the last state, some followed by their values at rest.
    outputs: Vec<f64>,
    work: f64,
}

impl TermWatch {
    /// The number of the energy among the quantities.
    pub const ENERGY: usize = 0;

    fn new(system: System, terms: &Terms, parameters: &[f64]) -> TermWatch {
        let inputs = system.motion_len() + 2;
        let mut watch = TermWatch {
            places: Arc::clone(&terms.places),
            native: Evaluator::new(Arc::clone(&terms.native)),
            canonical: terms.canonical.clone().map(Evaluator::new),
            native_states: NativeStates::new(&system),
            inputs: vec![0.0; inputs],
            time: 0.0,
            at_canonical: false,
            outputs: Vec::new(),
            work: 0.0,
            system,
        };
        watch.set_parameters(parameters);
        watch
    }

    /// Takes other values, in the order of the model, for all evaluations to come.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        let inputs = self.system.inputs(parameters);
        self.native.set_parameters(&inputs);
        if let Some(canonical) = &mut self.canonical {
            canonical.set_parameters(&inputs);
        }
        self.native_states.set_parameters(parameters, &inputs);
    }

    /// Evaluates a state. Returns `false` if that is not possible.
    pub fn observe(&mut self, state: &State) -> bool {
        self.at_canonical = state.form != self.system.form() && self.canonical.is_some();
        if self.at_canonical {
            self.system.inputs_of(state, &mut self.inputs);
        } else if self.native_states.write(state, &mut self.inputs).is_err() {
            return false;
        }
        self.work = self.inputs[self.inputs.len() - 1];
        self.time = state.time;
        self.evaluate()
    }

    fn evaluate(&mut self) -> bool {
        let terms = match &mut self.canonical {
            Some(canonical) if self.at_canonical => canonical,
            _ => &mut self.native,
        };
        let is_known = terms.evaluate(self.time, &self.inputs).is_ok();
        self.outputs.clear();
        self.outputs.extend(terms.outputs());
        is_known
    }

    /// By how much half a digit of each number of the last state changes a quantity, and the number that changes it most, by its
    /// name, with its value; `None` if the quantity has no value beside the state.
    pub fn change_by_rounding(&self, quantity: usize) -> Option<(f64, &str, f64)> {
        let mut beside = self.clone();
        let value = self.sums(quantity, &[]).value;
        let (mut sum, mut most) = (0.0, (0.0, 0));
        for (i, &x) in self.inputs.iter().enumerate().filter(|(_, x)| **x != 0.0) {
            beside.inputs[i] = x.next_up();
            if !beside.evaluate() {
                return None;
            }
            beside.inputs[i] = x;
            let change = 0.5 * (beside.sums(quantity, &[]).value - value).abs();
            sum += change;
            if change > most.0 {
                most = (change, i);
            }
        }
        let (n, place) = (self.system.degrees(), most.1);
        let has_momenta = self.at_canonical || self.system.form() == Form::Momentum;
        let channel = if place >= n && has_momenta { place + n } else { place };
        let name = self.system.channels().get(channel)?.name.as_str();
        Some((sum, name, self.inputs[place]))
    }

    /// The work done on the motion, if the state carries it.
    pub fn work(&self) -> f64 {
        self.work
    }

    /// Whether a quantity (0 for the energy, then the conserved quantities in order) can be
    /// evaluated.
    pub fn has(&self, quantity: usize) -> bool {
        self.places.get(quantity).is_some_and(Option::is_some)
    }

    /// Whether a quantity has constant terms, which its sums are without.
    pub fn has_offset(&self, quantity: usize) -> bool {
        self.places.get(quantity).is_some_and(|place| place.as_ref().is_some_and(|p| p.offset))
    }

    /// The terms of a quantity, each with its value at rest and its size, to which its rounding errors are proportional.
    fn terms(&self, quantity: usize) -> impl Iterator<Item = [f64; 3]> + '_ {
        let place = self.places.get(quantity).and_then(Option::as_ref);
        let (first, terms) = place.map_or((0, &[][..]), |place| (place.first, &place.terms));
        let mut outputs = self.outputs.get(first..).unwrap_or_default().iter();
        terms.iter().map_while(move |rest| {
            let term = *outputs.next()?;
            Some(match rest {
                AtRest::Same => [term, term, term.abs()],
                AtRest::Nothing => [term, 0.0, term.abs()],
                AtRest::Other => [term, *outputs.next()?, term.abs()],
                AtRest::Cancels => [term, 0.0, term.abs() + outputs.next()?.abs()],
            })
        })
    }

    /// The value of each term of a quantity at rest.
    pub fn at_rest(&self, quantity: usize) -> Vec<f64> {
        self.terms(quantity).map(|[_, rest, _]| rest).collect()
    }

    /// The sums over the terms of a quantity whose values at rest were these.
    pub fn sums(&self, quantity: usize, were: &[f64]) -> TermSums {
        let place = self.places.get(quantity).and_then(Option::as_ref);
        let as_a_whole = place.is_some_and(|place| place.exchanges);
        let mut sums = TermSums::NOTHING;
        let mut changed_at_rest = 0.0;
        let mut were = were.iter();
        for [term, rest, size] in self.terms(quantity) {
            sums.value += term;
            sums.size += size;
            sums.beyond += (term - rest).abs();
            if let Some(were) = were.next() {
                let (beyond, change) = ((term - rest).abs(), rest - were);
                if !(beyond + change.abs()).is_finite() {
                    sums.moving += term.abs();
                } else if as_a_whole {
                    sums.moving += beyond;
                    changed_at_rest += change;
                } else {
                    sums.moving += beyond + change.abs();
                }
            }
        }
        sums.moving += changed_at_rest.abs();
        sums
    }
}

impl System {
    /// Returns an evaluator of the terms of the conserved quantities at these parameters.
    pub fn term_watch(&self, parameters: &[f64]) -> TermWatch {
        TermWatch::new(self.clone(), &self.shared.terms, parameters)
    }
}

/// Sums over the terms of a quantity.
#[derive(Clone, Copy, Debug)]
pub struct TermSums {
    /// Its value, but for constant terms.
    pub value: f64,
    /// The size of the terms, to which its rounding errors are at least proportional.
    pub size: f64,
    /// The size of its varying part: the sum of the amounts by which the terms exceed their values
    /// at rest, and by which the latter have changed. Where the quantity is an energy of motion and
    /// of place, the latter is the change of their sum, since the terms of a potential may cancel
    /// each other. A term that has no value at rest counts entirely.
    pub moving: f64,
    /// The sum of the amounts by which the terms differ from their values at rest: of an energy, that of motion.
    pub beyond: f64,
}

impl TermSums {
    /// Those over no terms.
    pub const NOTHING: TermSums = TermSums { value: -0.0, size: -0.0, moving: -0.0, beyond: 0.0 };
}
