//! The action beside a motion: of the principle, on the motion as its method gives it.
//!
//! In: a system, a motion's conditions. Out: [`ActionAlongMotion`]. Never here: what is said and drawn of it.

use super::principle::Principle;
use crate::dynamics::{
    Hamiltonian, Lagrangian, MotionSpan, PhaseSpace, VariedAction, conjugate_points,
    conjugate_points_at_energy, varied_abbreviated_action, varied_action, varied_phase_action,
};
use crate::ensemble::SystemFlow;
use crate::instrument::conditions::PlotConditions;
use crate::integrate::Method;
use crate::mechanics::Equations;
use crate::model::Model;
use crate::system::ChannelKind;

/// So many ends of steps are given; along a motion with more no integral is taken step by step.
const MOST_STEP_ENDS: usize = 20_000;

/// Where on the way a motion is held against one without the errors of its method.
const PARTS: [f64; 8] = [0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0];

pub(super) struct ActionAlongMotion {
    pub(super) varied: VariedAction,
    /// The times from its beginning at which it passes a kinetic focus of the principle; none are searched for where forces
    /// act that have no potential, so that the motion does not make the action stationary.
    pub(super) foci: Option<Vec<f64>>,
    /// The number of coordinates.
    pub(super) degrees: usize,
    /// How far the p of the coordinate and H are from those of a motion without the errors of the method.
    pub(super) method_errors: [f64; 2],
}

/// The functions whose integral is the action of a principle.
pub(super) struct Actions {
    lagrangian: Lagrangian,
    principle: Principle,
    /// Of the principle in phase space.
    hamiltonian: Option<Hamiltonian>,
}

impl Actions {
    pub(super) fn of(
        (model, equations): (&Model, &mut Equations),
        parameters: &[f64],
        (principle, begin): (Principle, f64),
    ) -> Result<Actions, String> {
        let lagrangian = Lagrangian::of(model, equations, parameters);
        let lagrangian = lagrangian.map_err(|why| why.to_string())?.beginning_at(begin);
        let hamiltonian = (principle == Principle::PhaseSpace)
            .then(|| Hamiltonian::of(model, equations, parameters).map_err(|why| why.to_string()));
        let hamiltonian = hamiltonian.transpose()?.map(|h| h.beginning_at(begin));
        Ok(Actions { lagrangian, principle, hamiltonian })
    }
}

pub(super) fn beside(
    space: &PhaseSpace,
    mut actions: Actions,
    (method, conditions, (begin, start)): (&'static Method, &PlotConditions, (f64, f64)),
    coordinate: usize,
    duration: f64,
) -> Result<ActionAlongMotion, String> {
    let system = space.system();
    let first = conditions.state(system, begin).map_err(|error| error.to_string())?;
    let (parameters, method) = (conditions.parameters.clone(), (method, conditions.settings));
    let flow = SystemFlow { system: system.clone(), method, parameters, start, effort: None };
    let channel = |kind: ChannelKind| system.channels().iter().position(|c| c.kind == kind);
    let n = system.degrees();
    let kinds = (0..n).map(ChannelKind::Position).chain((0..n).map(ChannelKind::Velocity));
    let channels: Option<Vec<usize>> = kinds.map(channel).collect();
    let channels = channels.ok_or("the motion has no velocities")?;
    let followed = |flow: &SystemFlow, times: &[f64]| {
        let times: Vec<f64> = times.iter().map(|time| begin + time).collect();
        let carried = flow.carry(&first, &times, &channels);
        carried.end.map(|_| carried.seen)
    };
    let mut motion = |times: &[f64]| followed(&flow, times);
    let step_ends = flow.step_ends(&first, duration, MOST_STEP_ENDS);
    let span = MotionSpan { duration, step_ends: &step_ends };
    let (lagrangian, principle) = (&mut actions.lagrangian, actions.principle);
    let varied = match (principle, &mut actions.hamiltonian) {
        (Principle::Maupertuis, _) => {
            varied_abbreviated_action(lagrangian, &mut motion, coordinate, span)
        }
        (Principle::PhaseSpace, Some(hamiltonian)) => {
            varied_phase_action((hamiltonian, lagrangian), &mut motion, coordinate, span)
        }
        _ => varied_action(lagrangian, &mut motion, coordinate, span),
    };
    let varied = varied.map_err(|why| why.to_string())?;
    let times = PARTS.map(|part| part * duration);
    let exact = flow.by_default_method().and_then(|exact| followed(&exact, &times));
    let method_errors = match exact.zip(motion(&times)) {
        None => [0.0; 2],
        Some((exact, seen)) => {
            let mut errors = [0.0_f64; 2];
            for ((time, a), b) in times.iter().zip(&exact).zip(&seen) {
                let [p, q] = [a, b].map(|at| lagrangian.momenta(*time, at)[coordinate]);
                let [h, k] = [a, b].map(|at| lagrangian.energy(*time, at));
                errors = [errors[0].max((p - q).abs()), errors[1].max((h - k).abs())];
            }
            errors
        }
    };
    let foci = if space.is_hamiltonian() {
        let state = space.state(&first).map_err(|error| error.to_string())?;
        let foci = match principle {
            Principle::Maupertuis => conjugate_points_at_energy(space, method, &state, duration),
            _ => conjugate_points(space, method, &state, duration),
        };
        Some(foci.map_err(|why| why.to_string())?)
    } else {
        None
    };
    Ok(ActionAlongMotion { varied, foci, degrees: n, method_errors })
}
