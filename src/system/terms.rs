//! The conserved quantities of a system term by term, in `f64`: cheap enough to be looked at after every step.
//!
//! In: the state of whatever method runs. Out: the value of each quantity, and how much of it moves: what its terms
//! have more than at rest, and by how much the rest of them has changed. A constant in the potential, or the origin of a
//! coordinate, has no part in that. Never here: references, drifts, verdicts.

use std::collections::HashMap;
use std::sync::Arc;

use super::legendre::Legendre;
use super::program::Program;
use super::rhs::ProgramBuilder;
use super::value::Evaluator;
use super::{Form, State, System};
use crate::expr::{Expr, Symbol};
use crate::mechanics::{Equations, Flow};
use crate::num::DoubleDouble;

/// What a term of a quantity is at rest.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum AtRest {
    /// The same: it does not depend on velocities or momenta.
    Same,
    /// Nothing.
    Nothing,
    /// Something else, which the next output is.
    Other,
}

/// One quantity among the outputs of the programs.
#[derive(Clone, Debug)]
struct Place {
    first: usize,
    terms: Vec<AtRest>,
}

/// The energy, then what is conserved, each by its terms; before it is compiled.
pub(super) struct Quantities {
    places: Vec<Option<Place>>,
    outputs: Vec<Expr>,
}

/// The same as programs.
#[derive(Clone, Debug)]
pub(super) struct Terms {
    places: Arc<[Option<Place>]>,
    /// Of a state in the native form, action and work.
    native: Arc<Program>,
    /// Of a state (q, p), where that is another and velocities follow without iteration.
    canonical: Option<Arc<Program>>,
}

impl Quantities {
    /// The energy and all that `equations` find conserved.
    pub(super) fn of(equations: &mut Equations) -> Quantities {
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
            for (c, term) in equations.pool.summands(e) {
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
            quantities.places.push(Some(Place { first, terms }));
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

/// Looks at the quantities of states of one system at one set of parameters; holds its own registers.
#[derive(Clone, Debug)]
pub struct TermWatch {
    system: System,
    places: Arc<[Option<Place>]>,
    native: Evaluator<f64>,
    canonical: Option<Evaluator<f64>>,
    legendre: Legendre,
    inputs: Vec<f64>,
    exact: Vec<DoubleDouble>,
    /// The last look was at a state in the canonical form.
    at_canonical: bool,
    /// Where several velocities belong to a momentum: the state last looked at, in the system's own form.
    near: Option<State>,
    work: f64,
}

impl TermWatch {
    pub(super) fn new(system: System, terms: &Terms, parameters: &[f64]) -> TermWatch {
        let inputs = system.driven_len() + 2;
        let mut watch = TermWatch {
            places: Arc::clone(&terms.places),
            native: Evaluator::new(Arc::clone(&terms.native)),
            canonical: terms.canonical.clone().map(Evaluator::new),
            legendre: system.legendre(&system.inputs(parameters)),
            inputs: vec![0.0; inputs],
            exact: vec![DoubleDouble::ZERO; inputs],
            at_canonical: false,
            near: None,
            work: 0.0,
            system,
        };
        watch.set_parameters(parameters);
        watch
    }

    /// Looks at these parameters from now on.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        let parameters = self.system.inputs(parameters);
        self.native.set_parameters(&parameters);
        if let Some(canonical) = &mut self.canonical {
            canonical.set_parameters(&parameters);
        }
        self.legendre.set_parameters(&parameters);
    }

    /// Looks at a state; `false` where that cannot be.
    pub fn look(&mut self, state: &State) -> bool {
        let native = state.form == self.system.form();
        self.at_canonical = !native && self.canonical.is_some();
        if native || self.at_canonical {
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
        match (&mut self.canonical, self.at_canonical) {
            (Some(canonical), true) => canonical.evaluate(state.time, &self.inputs).is_ok(),
            _ => self.native.evaluate(state.time, &self.inputs).is_ok(),
        }
    }

    fn take_in(&mut self, state: &State) {
        self.system.inputs_of(state, &mut self.exact);
        for (rounded, x) in self.inputs.iter_mut().zip(&self.exact) {
            *rounded = x.high;
        }
        self.work = self.inputs[self.inputs.len() - 1];
    }

    fn output(&self, i: usize) -> f64 {
        match &self.canonical {
            Some(canonical) if self.at_canonical => canonical.output(i),
            _ => self.native.output(i),
        }
    }

    /// The work done on the motion, where a state carries it.
    pub fn work(&self) -> f64 {
        self.work
    }

    /// Whether a quantity (0 the energy, then what is conserved, in order) can be looked at.
    pub fn has(&self, quantity: usize) -> bool {
        self.places.get(quantity).is_some_and(Option::is_some)
    }

    /// The terms of a quantity, each with what it is at rest.
    fn terms(&self, quantity: usize) -> impl Iterator<Item = (f64, f64)> + '_ {
        let place = self.places.get(quantity).and_then(Option::as_ref);
        let mut next = place.map_or(0, |place| place.first);
        place.into_iter().flat_map(|place| &place.terms).map(move |rest| {
            let term = self.output(next);
            next += 1;
            match rest {
                AtRest::Same => (term, term),
                AtRest::Nothing => (term, 0.0),
                AtRest::Other => {
                    next += 1;
                    (term, self.output(next - 1))
                }
            }
        })
    }

    /// The value of a quantity.
    pub fn value(&self, quantity: usize) -> f64 {
        self.terms(quantity).map(|(term, _)| term).sum()
    }

    /// The size of the terms of a quantity: what rounding is relative to, at least.
    pub fn size(&self, quantity: usize) -> f64 {
        self.terms(quantity).map(|(term, _)| term.abs()).sum()
    }

    /// What each term of a quantity is at rest.
    pub fn at_rest(&self, quantity: usize) -> Vec<f64> {
        self.terms(quantity).map(|(_, rest)| rest).collect()
    }

    /// How much of a quantity moves: the sum of the sizes of what its terms have more than at rest, and of what they are
    /// more at rest than they `were`. A term that has no value at rest counts whole.
    pub fn moving(&self, quantity: usize, were: &[f64]) -> f64 {
        let terms = self.terms(quantity).zip(were);
        terms
            .map(|((term, rest), were)| {
                let moved = (term - rest).abs() + (rest - were).abs();
                if moved.is_finite() { moved } else { term.abs() }
            })
            .sum()
    }
}
