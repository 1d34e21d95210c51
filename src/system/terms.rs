//! The conserved quantities of a system term by term, in `f64`: cheap enough to be evaluated after
//! every step.
//!
//! In: the state of any method. Out: the value of each quantity, and the varying part of it: the
//! amount by which its terms exceed their values at rest, and by which the latter have changed. A
//! constant in the potential, or the origin of a coordinate, does not contribute to it. Never here:
//! references, drifts, verdicts.

use std::collections::HashMap;
use std::sync::Arc;

use super::legendre::Legendre;
use super::program::Program;
use super::rhs::ProgramBuilder;
use super::value::Evaluator;
use super::{Form, State, System};
use crate::expr::{Expr, Symbol};
use crate::mechanics::{Equations, Flow};
use crate::model::Model;
use crate::num::DoubleDouble;

/// The value of a term at rest, that is with velocities or momenta zero.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum AtRest {
    /// The same value: the term does not depend on velocities or momenta.
    Same,
    /// Zero.
    Nothing,
    /// Another value, which is the next output.
    Other,
}

/// The place of one quantity among the outputs of the programs.
#[derive(Clone, Debug)]
struct OutputPlace {
    first: usize,
    terms: Vec<AtRest>,
    /// Whether constant terms were left out.
    offset: bool,
}

/// The energy, then the conserved quantities, each by its terms, before compilation.
pub(super) struct Quantities {
    places: Vec<Option<OutputPlace>>,
    outputs: Vec<Expr>,
}

/// The compiled programs of these terms.
#[derive(Clone, Debug)]
pub(super) struct Terms {
    places: Arc<[Option<OutputPlace>]>,
    /// The terms as functions of a state in the native form, action and work.
    native: Arc<Program>,
    /// The terms as functions of a state (q, p), if that form is not native and velocities follow
    /// without iteration.
    canonical: Option<Arc<Program>>,
}

impl Quantities {
    /// The energy and all quantities that `equations` finds conserved, without their constant terms,
    /// beside which a change would have fewer digits.
    pub(super) fn of(model: &Model, equations: &mut Equations) -> Quantities {
        let parameters: Vec<Symbol> = model.parameters.iter().map(|p| p.symbol).collect();
        let mut quantities = Quantities { places: Vec::new(), outputs: Vec::new() };
        let all: Vec<Expr> = std::iter::once(equations.energy)
            .chain(equations.conserved.iter().map(|c| c.expression))
            .collect();
        let rates: Vec<Symbol> = match equations.flow {
            Flow::Lagrange { .. } => equations.coordinates.iter().map(|c| c.velocity).collect(),
            Flow::Hamilton { .. } => equations.coordinates.iter().map(|c| c.momentum).collect(),
            Flow::Poisson { .. } => Vec::new(),
        };
        let at_rest: HashMap<Symbol, Expr> = rates.iter().map(|&r| (r, Expr::ZERO)).collect();
        let unknown: Vec<Symbol> = equations
            .coordinates
            .iter()
            .flat_map(|c| [c.acceleration, c.momentum, c.velocity])
            .filter(|symbol| !rates.contains(symbol))
            .chain(equations.constraints.iter().map(|row| row.multiplier))
            .collect();
        for e in all {
            let e = equations.open(e);
            if equations.pool.depends_on_any(e, &unknown) {
                quantities.places.push(None);
                continue;
            }
            let first = quantities.outputs.len();
            let mut terms = Vec::new();
            let mut summands = equations.pool.summands(e);
            let is_fixed = |&(_, term): &(_, Expr)| {
                equations.pool.symbols_of(term).iter().all(|s| parameters.contains(s))
            };
            let varies = summands.iter().any(|term| !is_fixed(term));
            let offset = varies && summands.iter().any(is_fixed);
            if offset {
                summands.retain(|term| !is_fixed(term));
            }
            for (c, term) in summands {
                let term = equations.pool.scale(c, term);
                quantities.outputs.push(term);
                let rest = if equations.pool.depends_on_any(term, &rates) {
                    match equations.pool.substitute(term, &at_rest) {
                        Expr::ZERO => AtRest::Nothing,
                        rest => {
                            quantities.outputs.push(rest);
                            AtRest::Other
                        }
                    }
                } else {
                    AtRest::Same
                };
                terms.push(rest);
            }
            quantities.places.push(Some(OutputPlace { first, terms, offset }));
        }
        quantities
    }

    pub(super) fn compile(self, builder: &mut ProgramBuilder<'_>) -> Result<Terms, Symbol> {
        let action = builder.equations.symbols.action;
        let mut lowering = builder.on_full_state();
        let input = lowering.input();
        lowering.bind(action, input);
        let outputs = lowering.lower_all(&self.outputs);
        let native = lowering.finish(outputs)?;
        let canonical = match (builder.native(), builder.on_full_canonical_state()) {
            (Form::Velocity, Some(mut lowering)) => {
                let input = lowering.input();
                lowering.bind(action, input);
                let outputs = lowering.lower_all(&self.outputs);
                Some(lowering.finish(outputs)?)
            }
            _ => None,
        };
        Ok(Terms { places: self.places.into(), native, canonical })
    }
}

/// Evaluates the quantities of one system's states at one set of parameters. It owns its registers.
#[derive(Clone, Debug)]
pub struct TermWatch {
    system: System,
    places: Arc<[Option<OutputPlace>]>,
    native: Evaluator<f64>,
    canonical: Option<Evaluator<f64>>,
    legendre: Legendre,
    inputs: Vec<f64>,
    exact: Vec<DoubleDouble>,
    /// The terms at the last state, some followed by their values at rest.
    outputs: Vec<f64>,
    /// If several velocities belong to a momentum: the last state evaluated, in the system's native
    /// form.
    near: Option<State>,
    work: f64,
}

impl TermWatch {
    pub(super) fn new(system: System, terms: &Terms, parameters: &[f64]) -> TermWatch {
        let inputs = system.motion_len() + 2;
        let mut watch = TermWatch {
            places: Arc::clone(&terms.places),
            native: Evaluator::new(Arc::clone(&terms.native)),
            canonical: terms.canonical.clone().map(Evaluator::new),
            legendre: system.legendre(&system.inputs(parameters)),
            inputs: vec![0.0; inputs],
            exact: vec![DoubleDouble::ZERO; inputs],
            outputs: Vec::new(),
            near: None,
            work: 0.0,
            system,
        };
        watch.set_parameters(parameters);
        watch
    }

    /// Sets the parameters.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        let parameters = self.system.inputs(parameters);
        self.native.set_parameters(&parameters);
        if let Some(canonical) = &mut self.canonical {
            canonical.set_parameters(&parameters);
        }
        self.legendre.set_parameters(&parameters);
    }

    /// Evaluates a state. Returns `false` if that is not possible.
    pub fn look(&mut self, state: &State) -> bool {
        let native = state.form == self.system.form();
        let at_canonical = !native && self.canonical.is_some();
        if native || at_canonical {
            self.take_in(state);
            self.near = (native && self.system.has_branches()).then(|| state.clone());
        } else {
            let form = self.system.form();
            let near = self.near.as_ref();
            match self.system.convert_by(&mut self.legendre, state, form, near) {
                Ok(state) => {
                    self.take_in(&state);
                    self.near = self.system.has_branches().then_some(state);
                }
                Err(_) => return false,
            }
        }
        let terms = match &mut self.canonical {
            Some(canonical) if at_canonical => canonical,
            _ => &mut self.native,
        };
        let looked = terms.evaluate(state.time, &self.inputs).is_ok();
        self.outputs.clear();
        self.outputs.extend(terms.outputs());
        looked
    }

    fn take_in(&mut self, state: &State) {
        self.system.inputs_of(state, &mut self.exact);
        for (rounded, x) in self.inputs.iter_mut().zip(&self.exact) {
            *rounded = x.high;
        }
        self.work = self.inputs[self.inputs.len() - 1];
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

    /// The terms of a quantity, each with its value at rest.
    fn terms(&self, quantity: usize) -> impl Iterator<Item = (f64, f64)> + '_ {
        let place = self.places.get(quantity).and_then(Option::as_ref);
        let (first, terms) = place.map_or((0, &[][..]), |place| (place.first, &place.terms));
        let mut outputs = self.outputs.get(first..).unwrap_or_default().iter();
        terms.iter().map_while(move |rest| {
            let term = *outputs.next()?;
            Some(match rest {
                AtRest::Same => (term, term),
                AtRest::Nothing => (term, 0.0),
                AtRest::Other => (term, *outputs.next()?),
            })
        })
    }

    /// The value of each term of a quantity at rest.
    pub fn at_rest(&self, quantity: usize) -> Vec<f64> {
        self.terms(quantity).map(|(_, rest)| rest).collect()
    }

    /// The sums over the terms of a quantity whose values at rest were these.
    pub fn sums(&self, quantity: usize, were: &[f64]) -> TermSums {
        let mut sums = TermSums { value: -0.0, size: -0.0, moving: -0.0 };
        let mut were = were.iter();
        for (term, rest) in self.terms(quantity) {
            sums.value += term;
            sums.size += term.abs();
            if let Some(were) = were.next() {
                let moved = (term - rest).abs() + (rest - were).abs();
                sums.moving += if moved.is_finite() { moved } else { term.abs() };
            }
        }
        sums
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
    /// at rest, and by which the latter have changed. A term that has no value at rest counts
    /// entirely.
    pub moving: f64,
}
