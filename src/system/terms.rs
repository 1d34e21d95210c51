//! The conserved quantities of a system term by term, compiled to programs.
//!
//! In: the equations of a system. Out: a program whose outputs are the terms of every quantity, and their values at
//! rest where these differ. Never here: states.

use std::collections::HashMap;
use std::sync::Arc;

use super::Form;
use super::program::Program;
use super::rhs::ProgramBuilder;
use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::{CoordinateSymbols, Equations, Flow};
use crate::model::Model;
use crate::num::Number;

/// The value of a term at rest, that is with velocities or momenta zero.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum AtRest {
    /// The same value: the term does not depend on velocities or momenta.
    Same,
    Nothing,
    /// Another value, which is the next output.
    Other,
    /// Zero, as p − A is; the next output is the size of what cancels in the term, by which its rounding errors are larger.
    Cancels,
}

/// The place of one quantity among the outputs of the programs.
#[derive(Clone, Debug)]
pub(super) struct OutputPlace {
    pub(super) first: usize,
    pub(super) terms: Vec<AtRest>,
    /// Whether constant terms were left out.
    pub(super) offset: bool,
    /// Whether it is an energy of which a part is that of the motion, so that what moves between its terms at rest alone does not count.
    pub(super) exchanges: bool,
}

/// The energy, then the conserved quantities, each by its terms, before compilation.
pub(super) struct ConservedTerms {
    places: Vec<Option<OutputPlace>>,
    outputs: Vec<Expr>,
}

/// Σ p ∂T/∂p of a term T of the momenta: what rounding errors of p and of what it cancels against change, in units of both.
fn cancelling(pool: &mut Pool, term: Expr, momenta: &[Symbol]) -> Expr {
    let mut parts = Vec::new();
    for &p in momenta {
        let slope = pool.derivative(term, p);
        let momentum = pool.variable(p);
        parts.push((Number::ONE, pool.mul(momentum, slope)));
    }
    pool.linear(Number::ZERO, &parts)
}

/// The variables whose own rate of change is zero and which no impulse changes: energy that depends on them alone does not move,
/// whatever the method.
fn still(model: &Model, equations: &Equations) -> Vec<Symbol> {
    let coordinates = &equations.coordinates;
    let parameters_alone = |e: Expr| {
        let moves = coordinates.iter().flat_map(|c| [c.position, c.velocity, c.momentum]);
        let moves: Vec<Symbol> = moves.chain([equations.symbols.time]).collect();
        !equations.pool.depends_on_any(e, &moves)
    };
    let is_still = |&(i, _): &(usize, &CoordinateSymbols)| match &equations.flow {
        Flow::Lagrange { mass, force, .. } => {
            let alone = (0..coordinates.len()).all(|j| j == i || mass[i][j] == Expr::ZERO);
            alone && parameters_alone(mass[i][i]) && force[i] == Expr::ZERO
        }
        Flow::Hamilton { momentum_rates, .. } => momentum_rates[i] == Expr::ZERO,
        Flow::Poisson { rates } => rates[i] == Expr::ZERO,
    };
    if !equations.constraints.is_empty() {
        return Vec::new();
    }
    let has_impulse = |i: usize| model.impulses.iter().any(|one| one.change[i] != Expr::ZERO);
    let variable = |(_, c): (usize, &CoordinateSymbols)| match equations.flow {
        Flow::Lagrange { .. } => c.velocity,
        Flow::Hamilton { .. } => c.momentum,
        Flow::Poisson { .. } => c.position,
    };
    let still = coordinates.iter().enumerate().filter(is_still);
    still.filter(|&(i, _)| !has_impulse(i)).map(variable).collect()
}

#[derive(Clone, Debug)]
pub(super) struct Terms {
    pub(super) places: Arc<[Option<OutputPlace>]>,
    /// The terms as functions of a state in the native form, action and work.
    pub(super) native: Arc<Program>,
    /// The terms as functions of a state (q, p), if that form is not native and velocities follow
    /// without iteration.
    pub(super) canonical: Option<Arc<Program>>,
}

impl ConservedTerms {
    /// The energy and all quantities that `equations` finds conserved, without their constant terms,
    /// beside which a change would have fewer digits.
    pub(super) fn of(model: &Model, equations: &mut Equations) -> ConservedTerms {
        let parameters: Vec<Symbol> = model.parameters.iter().map(|p| p.symbol).collect();
        let mut quantities = ConservedTerms { places: Vec::new(), outputs: Vec::new() };
        let all: Vec<Expr> = std::iter::once(equations.energy)
            .chain(equations.conserved.iter().map(|c| c.expression))
            .collect();
        let rates: Vec<Symbol> = match equations.flow {
            Flow::Lagrange { .. } => equations.coordinates.iter().map(|c| c.velocity).collect(),
            Flow::Hamilton { .. } => equations.coordinates.iter().map(|c| c.momentum).collect(),
            Flow::Poisson { .. } => Vec::new(),
        };
        let zeros = || vec![Expr::ZERO; rates.len()];
        let rates_at_rest = equations.momenta_at_rest().unwrap_or_else(zeros);
        let cancels = rates_at_rest.iter().any(|&e| e != Expr::ZERO);
        let at_rest: HashMap<Symbol, Expr> = rates.iter().copied().zip(rates_at_rest).collect();
        let still = still(model, equations);
        let unknown: Vec<Symbol> = equations
            .coordinates
            .iter()
            .flat_map(|c| [c.acceleration, c.momentum, c.velocity])
            .filter(|symbol| !rates.contains(symbol))
            .chain(equations.constraints.iter().map(|row| row.multiplier))
            .chain(equations.supplements.maps.implicit.iter().flat_map(|(map, _)| map.new.clone()))
            .collect();
        for (quantity, e) in all.into_iter().enumerate() {
            let e = equations.open(e);
            if equations.pool.depends_on_any(e, &unknown) {
                quantities.places.push(None);
                continue;
            }
            let first = quantities.outputs.len();
            let mut terms = Vec::new();
            let mut summands = equations.pool.summands(e);
            let is_fixed = |&(_, term): &(_, Expr)| {
                let symbols = equations.pool.symbols_of(term);
                let still = if quantity == 0 { &still[..] } else { &[] };
                symbols.iter().all(|s| parameters.contains(s) || still.contains(s))
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
                        Expr::ZERO if cancels => {
                            quantities.outputs.push(cancelling(&mut equations.pool, term, &rates));
                            AtRest::Cancels
                        }
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
            let exchanges = quantity == 0 && terms.iter().any(|&rest| rest != AtRest::Same);
            quantities.places.push(Some(OutputPlace { first, terms, offset, exchanges }));
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
