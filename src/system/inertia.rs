//! The inertia of a body at one set of parameters: its tensor, principal moments, mass and centre
//! of mass, in double-double. Programs take these numbers as further parameters.
//!
//! In: parameters. Out: the values of the body's names. Never here: how the tensor was derived.

use std::sync::Arc;

use super::program::Program;
use super::rhs::ProgramBuilder;
use super::value::Evaluator;
use crate::expr::Symbol;
use crate::mechanics::principal;
use crate::model::Model;
use crate::num::DoubleDouble;

#[derive(Clone, Debug)]
pub(super) struct Inertia {
    /// Six tensor components, mass and three coordinates, as functions of the parameters alone.
    program: Arc<Program>,
    names: Vec<Symbol>,
}

impl Inertia {
    /// The inertia of a model's body, if it has one. Must be called while the builder knows only
    /// the parameters.
    pub(super) fn of(
        model: &Model,
        builder: &mut ProgramBuilder<'_>,
    ) -> Result<Option<Inertia>, Symbol> {
        let (Some(body), Some(whole)) = (&model.body, &builder.equations.supplements.body) else {
            return Ok(None);
        };
        let mut lowering = builder.lowering();
        let mut outputs = lowering.lower_all(&whole.inertia);
        outputs.push(lowering.lower(whole.mass));
        outputs.extend(lowering.lower_all(&whole.centre));
        let program = lowering.finish(outputs)?;
        Ok(Some(Inertia { program, names: body.names.all() }))
    }

    /// The symbols of these numbers, in order.
    pub(super) fn names(&self) -> &[Symbol] {
        &self.names
    }

    pub(super) fn values(&self, parameters: &[DoubleDouble]) -> Vec<DoubleDouble> {
        let mut values: Evaluator<DoubleDouble> = Evaluator::new(Arc::clone(&self.program));
        values.set_parameters(parameters);
        let inertia = [0, 1, 2, 3, 4, 5].map(|i| values.output(i));
        let (moments, _) = principal(&inertia);
        let others = (6..10).map(|i| values.output(i));
        inertia.into_iter().chain(moments).chain(others).collect()
    }
}
