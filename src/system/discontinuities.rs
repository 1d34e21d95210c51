//! Events and impulses compiled: the functions whose zeros are located, and the formulas of the impulses.
//!
//! In: a model's impulses and events, the momenta. Out: programs of `when`, of times and of Q̂. Never here: states.

use std::sync::Arc;

use super::observables;
use super::program::Program;
use super::rhs::ProgramBuilder;
use crate::expr::{Expr, FunctionId, Node, Pool, Symbol};
use crate::mechanics::Equations;
use crate::model::{Direction, EventAction, Model};
use crate::num::Number;

/// The events and impulses of a motion.
#[derive(Clone, Debug)]
pub struct Discontinuities {
    /// Events, in the order of the file, the surfaces of section, and the steps in time of the law.
    pub events: Vec<CompiledEvent>,
    /// Impulses, in the order of the file.
    pub impulses: Vec<CompiledImpulse>,
    /// The functions of the events, of (q, native rates, action, work).
    pub(super) when: Arc<Program>,
    /// Quantities that show how fast these functions change, of the same inputs.
    pub(super) variation: Arc<Program>,
    /// Q̂ of every impulse, of the same inputs.
    pub(super) change: Arc<Program>,
    /// The times of every impulse, followed by its interval (zero for none), as functions of the
    /// parameters.
    pub(super) schedule: Arc<Program>,
    /// The functions of the time alone at whose zeros the law has a step, or a momentum of L as a function of the velocities.
    pub(super) steps: Arc<Program>,
    /// Whether a momentum of L, as a function of the velocities, jumps at a time, at such a zero or at a pole.
    pub momenta_jump: bool,
    quadratic: bool,
}

/// What happens at a zero of a located function.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CompiledAction {
    /// What the event of the file, or the surface of section, says.
    Written(EventAction),
    /// The law has a step in time there, or the momenta of L have one, as functions of the velocities. No file writes it.
    StepInTime,
}

impl CompiledAction {
    /// The action that is written; `None` for a step in time.
    pub fn written(self) -> Option<EventAction> {
        match self {
            CompiledAction::Written(action) => Some(action),
            CompiledAction::StepInTime => None,
        }
    }
}

/// An event without its function.
#[derive(Clone, Debug)]
pub struct CompiledEvent {
    /// The name in the file.
    pub name: String,
    /// The direction in which zeros count.
    pub direction: Direction,
    /// The action that an event triggers.
    pub action: CompiledAction,
    is_constant: bool,
    /// The constraint whose expression its function is, but for a factor.
    constraint: Option<usize>,
}

impl CompiledEvent {
    /// Whether its function has zeros that are no rounding, while these constraints are active.
    pub(super) fn may_cross(&self, is_active: impl Fn(usize) -> bool) -> bool {
        !self.is_constant && !self.constraint.is_some_and(is_active)
    }
}

/// An impulse without its formulas.
#[derive(Clone, Debug)]
pub struct CompiledImpulse {
    /// The name in the file.
    pub name: String,
    pub(super) times: usize,
    /// Whether the impulse recurs.
    pub(super) periodic: bool,
    /// Whether the impulse is applied at scheduled times. If not, an event or a key triggers it.
    pub scheduled: bool,
}

impl Discontinuities {
    pub(super) fn is_quadratic(&self) -> bool {
        self.quadratic
    }

    /// Whether an event or a section of a model depends on a symbol.
    pub(super) fn depend(model: &Model, equations: &Equations, symbol: Symbol) -> bool {
        functions(model).any(|e| equations.pool.depends(e, symbol))
    }

    pub(super) fn of(
        model: &Model,
        builder: &mut ProgramBuilder<'_>,
    ) -> Result<Discontinuities, Symbol> {
        let steps = builder.equations.steps_in_time().into_iter();
        let steps: Vec<Expr> = steps.map(|e| without_factor(&mut builder.pool, e)).collect();
        let mut lowering = builder.lowering();
        let instants = lowering.lower_all(&steps);
        let instants = lowering.finish(instants)?;
        let mut lowering = builder.lowering();
        let mut outputs = Vec::new();
        for impulse in &model.impulses {
            outputs.extend(lowering.lower_all(&impulse.times));
            outputs.push(lowering.lower(impulse.period.unwrap_or(Expr::ZERO)));
        }
        let schedule = lowering.finish(outputs)?;
        let functions: Vec<_> = functions(model).chain(steps.iter().copied()).map(Some).collect();
        let changes = model.impulses.iter().flat_map(|i| i.change.iter().map(|&e| Some(e)));
        let changes: Vec<_> = changes.collect();
        let equations = builder.equations;
        let constraint = |when: Expr| {
            model.constraints.iter().position(|c| equations.are_multiples(when, c.expression))
        };
        Ok(Discontinuities {
            events: model
                .located_events()
                .map(|e| CompiledEvent {
                    name: e.name.clone(),
                    direction: if builder.backwards { e.direction.reversed() } else { e.direction },
                    action: CompiledAction::Written(e.action),
                    is_constant: equations.is_plainly_constant(e.when),
                    constraint: constraint(e.when),
                })
                .chain(steps.iter().map(|_| CompiledEvent {
                    name: "step in time".to_owned(),
                    direction: Direction::Either,
                    action: CompiledAction::StepInTime,
                    is_constant: false,
                    constraint: None,
                }))
                .collect(),
            impulses: model
                .impulses
                .iter()
                .map(|i| CompiledImpulse {
                    name: i.name.clone(),
                    times: i.times.len(),
                    periodic: i.period.is_some(),
                    scheduled: !i.times.is_empty() || i.period.is_some(),
                })
                .collect(),
            when: observables::program(builder, &functions)?,
            variation: variation(builder, &functions)?,
            change: observables::program(builder, &changes)?,
            schedule,
            steps: instants,
            momenta_jump: builder.equations.momenta_jump(),
            quadratic: builder.equations.is_quadratic(),
        })
    }
}

/// The functions of the events and of the surfaces of section.
fn functions(model: &Model) -> impl Iterator<Item = Expr> + '_ {
    model.located_events().map(|event| event.when)
}

/// A function with the same zeros as another, whose numbers are not small for a small factor alone.
fn without_factor(pool: &mut Pool, e: Expr) -> Expr {
    let factor = match pool.node(e) {
        Node::Product(factor, _) => *factor,
        Node::Sum(_, terms) => terms.first().map_or(Number::ONE, |term| term.0),
        _ => Number::ONE,
    };
    pool.linear(Number::ZERO, &[(factor.recip(), e)])
}

/// The program of the functions that are expanded: those of the events, then the arguments of the
/// exponentials in them, which may underflow far away but not nearby.
fn variation(
    builder: &mut ProgramBuilder<'_>,
    functions: &[Option<Expr>],
) -> Result<Arc<Program>, Symbol> {
    let given: Vec<Expr> = functions.iter().flatten().copied().collect();
    let mut all = functions.to_vec();
    for part in builder.pool.reachable(&given) {
        match builder.pool.node(part) {
            Node::Call(
                FunctionId::Exp | FunctionId::Tanh | FunctionId::Sinh | FunctionId::Cosh,
                arguments,
            ) => all.extend(arguments.iter().map(|&u| Some(u))),
            Node::Power(_, exponent) => all.push(Some(*exponent)),
            _ => {}
        }
    }
    observables::program(builder, &all)
}
