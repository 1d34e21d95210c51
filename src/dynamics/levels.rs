//! The functions whose level sets hold the motions of a system that is given by its brackets: its energy and its Casimirs.
//!
//! In: a Poisson system whose energy, or some of whose Casimirs, no force changes. Out: their values and gradients at a state.
//! Canonical variables need none of this: there ∇H = −𝕁ż, and nothing else is constant by the brackets alone. Never here: what
//! becomes of directions across them.

use std::sync::Arc;

use nalgebra::DVector;

use super::error::DynamicsError;
use crate::expr::{Expr, Symbol};
use crate::mechanics::{Equations, Reason, body_constants};
use crate::model::Model;
use crate::num::DoubleDouble;
use crate::system::{Evaluator, Program, State};

/// The functions of one system.
#[derive(Debug)]
pub(super) struct Levels {
    model: Model,
    program: Arc<Program>,
    /// The names of those that no force changes, the energy first if it is one of them.
    names: Vec<String>,
    has_energy: bool,
}

/// The value of a function at a state, and its gradient.
#[derive(Clone, Debug)]
pub(super) struct LevelValue {
    pub(super) value: f64,
    pub(super) gradient: DVector<f64>,
}

impl Levels {
    /// Those of a model given by brackets, with its energy where that is conserved and varies from place to place; nothing of any
    /// other model.
    pub(super) fn of(
        model: &Model,
        equations: &Equations,
        has_energy: bool,
    ) -> Result<Option<Levels>, DynamicsError> {
        if !model.is_poisson() {
            return Ok(None);
        }
        let mut pool = equations.pool.clone();
        let variables: Vec<Symbol> = model.coordinates.iter().map(|c| c.position).collect();
        // a function that is the same everywhere, as H = 0 beside forces, has no level sets
        let mut varies =
            |function: Expr| variables.iter().any(|&x| pool.derivative(function, x) != Expr::ZERO);
        let energy = (has_energy && varies(equations.energy))
            .then(|| ("energy".to_owned(), equations.energy));
        let has_energy = energy.is_some();
        let casimirs = equations.conserved.iter().filter(|one| one.reason == Reason::Casimir);
        let casimirs = casimirs.map(|one| (one.name.clone(), one.expression));
        let (names, functions): (Vec<String>, Vec<Expr>) =
            energy.into_iter().chain(casimirs).unzip();
        let mut outputs = functions.clone();
        for function in functions {
            outputs.extend(variables.iter().map(|&x| pool.derivative(function, x)));
        }
        let nominal: Vec<f64> = vec![0.0; model.parameters.len()];
        let named = model.parameters.iter().map(|p| p.symbol);
        let built = body_constants(model, &nominal).into_iter().map(|(symbol, _)| symbol);
        let parameters: Vec<Symbol> = named.chain(built).collect();
        let time = model.symbols.time;
        let program = Program::compile(&mut pool, &parameters, time, &variables, &outputs)
            .map_err(|_| {
                let why = "a Casimir has no value where it is used";
                DynamicsError::Unsuited(why.to_owned())
            })?;
        Ok(Some(Levels { model: model.clone(), program, names, has_energy }))
    }

    /// The names of all of them, the energy first.
    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    /// Whether the energy is the first of them.
    pub(super) fn has_energy(&self) -> bool {
        self.has_energy
    }

    pub(super) fn at(
        &self,
        state: &State,
        parameters: &[f64],
    ) -> Result<Vec<LevelValue>, DynamicsError> {
        let count = self.model.coordinates.len();
        let built = body_constants(&self.model, parameters).into_iter().map(|(_, value)| value);
        let values: Vec<DoubleDouble> =
            parameters.iter().copied().chain(built).map(DoubleDouble::from_decimal).collect();
        let mut evaluator: Evaluator<f64> = Evaluator::new(Arc::clone(&self.program));
        evaluator.set_parameters(&values);
        let variables = &state.values[..count];
        let singular = |_| DynamicsError::Unsuited("a Casimir has no value here".to_owned());
        evaluator.evaluate(state.time, variables).map_err(singular)?;
        let total = self.names.len();
        let slope =
            |k: usize| DVector::from_fn(count, |i, _| evaluator.output(total + k * count + i));
        let level = |k: usize| LevelValue { value: evaluator.output(k), gradient: slope(k) };
        Ok((0..total).map(level).collect())
    }
}
