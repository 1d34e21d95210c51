//! The constraints of a system compiled, and which of them are enforced.
//!
//! In: a model with constraints. Out: their programs, and the active set where the file's motion begins. Never here: the
//! states of a motion.

use super::conditions::Conditions;
use super::constraint_programs::ConstraintPrograms;
use super::inertia::Inertia;
use super::kkt::ConstraintSystem;
use super::rhs::ProgramBuilder;
use super::value::Evaluator;
use crate::expr::{Expr, Symbol};
use crate::model::{EventAction, Model};
use crate::num::DoubleDouble;

/// What is known of the constraints before any state.
#[derive(Clone, Debug)]
pub(super) struct Constrained {
    pub(super) programs: ConstraintPrograms,
    pub(super) names: Vec<String>,
    /// Whether any constraint involves each coordinate's velocity.
    pub(super) touched: Vec<bool>,
    /// Whether the programs take two switches for each constraint.
    pub(super) switched: bool,
}

#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(super) struct ActiveSet {
    /// The constraints that have not been released.
    pub(super) active: Vec<bool>,
    /// The active constraints whose multipliers are solved for. The others depend on these.
    pub(super) enforced: Vec<bool>,
}

impl ActiveSet {
    /// The switches of the programs: enforced and active, for each constraint.
    pub(super) fn switches(&self, count: usize) -> impl Iterator<Item = DoubleDouble> {
        let number = |on: bool| if on { DoubleDouble::ONE } else { DoubleDouble::ZERO };
        (0..count).flat_map(move |k| [number(self.enforced[k]), number(self.active[k])])
    }
}

impl Constrained {
    /// Evaluates the constraints at the file's initial state and makes `builder` write their
    /// multipliers accordingly.
    pub(super) fn of(
        model: &Model,
        builder: &mut ProgramBuilder<'_>,
        inertia: Option<&Inertia>,
    ) -> Result<Option<(Constrained, ActiveSet)>, Symbol> {
        let rows = &builder.equations.constraints;
        if rows.is_empty() {
            // the mass matrix alone
            builder.kkt = ConstraintSystem::of(&mut builder.pool, builder.equations, false, false);
            return Ok(None);
        }
        let programs = ConstraintPrograms::of(builder)?;
        let enforced = independent_at_start(model, builder, &programs, inertia)?;
        let redundant = enforced.contains(&false);
        let released = model.events.iter().any(|e| matches!(e.action, EventAction::Release(_)));
        let switched = redundant || released;
        let kkt = ConstraintSystem::of(&mut builder.pool, builder.equations, switched, redundant);
        builder.parameters.extend(kkt.switches.iter().flat_map(|s| [s.enforced, s.active]));
        builder.kkt = kkt;
        let constrained = Constrained {
            programs,
            touched: (0..model.coordinates.len())
                .map(|i| rows.iter().any(|row| row.row[i] != Expr::ZERO))
                .collect(),
            names: rows.iter().map(|row| row.name.clone()).collect(),
            switched,
        };
        let active = vec![true; rows.len()];
        Ok(Some((constrained, ActiveSet { active, enforced })))
    }
}

/// Returns which constraints are independent of those before them at the file's initial state.
fn independent_at_start(
    model: &Model,
    builder: &mut ProgramBuilder<'_>,
    programs: &ConstraintPrograms,
    inertia: Option<&Inertia>,
) -> Result<Vec<bool>, Symbol> {
    let count = builder.equations.constraints.len();
    let mut lowering = builder.lowering();
    let outputs = model.coordinates.iter().map(|c| lowering.lower(c.initial)).collect();
    let start = lowering.finish(outputs)?;
    let mut parameters: Vec<DoubleDouble> =
        model.parameters.iter().map(|p| DoubleDouble::from_decimal(p.value)).collect();
    if let Some(inertia) = inertia {
        parameters.extend(inertia.values(&parameters));
    }
    let mut values: Evaluator<DoubleDouble> = Evaluator::new(start);
    values.set_parameters(&parameters);
    let positions: Vec<DoubleDouble> =
        (0..model.coordinates.len()).map(|i| values.output(i)).collect();
    let mut conditions = Conditions::new(programs, count);
    conditions.set_parameters(&parameters);
    conditions.observe(DoubleDouble::from_decimal(model.run.start), &positions);
    Ok(conditions.independent(&vec![true; count]))
}
