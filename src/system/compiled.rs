//! The compiled system: its programs, and what steppers and observers ask of them.
//!
//! In: programs (`compilation`). Out: channels, inputs, and the programs themselves within this room. Never here: values of a state.

use std::sync::Arc;

use super::active_set::{ActiveSet, Constrained};
use super::consistent_initial::KnownVelocity;
use super::inertia::Inertia;
use super::legendre::Legendre;
use super::observables::Observables;
use super::program::Program;
use super::rhs::{MotionPrograms, Quadratures, Tangents};
use super::terms::Terms;
use super::variations::Variations;
use super::{Channel, Discontinuities, Form};
use crate::cancel::Cancel;
use crate::expr::Expr;
use crate::model;
use crate::num::DoubleDouble;

/// A model lowered to numbers. It is immutable and cheap to clone; steppers and observers share it
/// and own their registers.
#[derive(Clone, Debug)]
pub struct System {
    pub(super) shared: Arc<Shared>,
    pub(super) active_set: ActiveSet,
    pub(super) cancel: Cancel,
    pub(super) tangents: Option<Arc<Tangents>>,
    /// Whether events that only mark their times are left out.
    pub(super) unmarked: bool,
    /// Whether its series are never computed by machine code.
    pub(super) interpreted: bool,
}

#[derive(Debug)]
pub(super) struct Shared {
    pub(super) native: Form,
    /// The number of coordinates or variables.
    pub(super) degrees: usize,
    pub(super) quadratures: Quadratures,
    pub(super) motion: MotionPrograms,
    pub(super) observables: Observables,
    pub(super) terms: Terms,
    pub(super) discontinuities: Discontinuities,
    /// The arguments of the exponential functions in the law, of (q, native rates, action, work).
    pub(super) steep: Arc<Program>,
    pub(super) divisors: Arc<Program>,
    pub(super) signed_divisors: Arc<Program>,
    pub(super) inertia: Option<Inertia>,
    pub(super) legendre: Arc<Program>,
    /// The index, among the auxiliary numbers, at which an attitude begins.
    pub(super) attitude: Option<usize>,
    /// The index, among them, at which the coordinates and velocities of the comparison motion begin.
    pub(super) comparison: Option<usize>,
    /// Initial values of the auxiliary numbers, as functions of a state in the native form.
    pub(super) auxiliary: Arc<Program>,
    /// Initial coordinates, rates and periods (zero for none), as functions of the parameters
    /// alone.
    pub(super) initial: Arc<Program>,
    pub(super) constraints: Option<Constrained>,
    /// Which initial rates the file gives.
    pub(super) known: Vec<KnownVelocity>,
    /// The energy as a function of (q, native rates).
    pub(super) energy: Arc<Program>,
    /// Whether the time of its states is −t.
    pub(super) backwards: bool,
    /// The channels that were given beside those of the model.
    pub(super) extra: Vec<model::WrittenExpr>,
    /// The programs with tangent vectors that were asked for.
    pub(super) variations: Variations,
}

impl System {
    /// Whether the time of its states is −t.
    pub fn is_backwards(&self) -> bool {
        self.shared.backwards
    }

    /// This system, with another token that cancels work with it.
    #[must_use]
    pub fn with_cancel(&self, cancel: Cancel) -> System {
        System { cancel, ..self.clone() }
    }

    /// This system, with series that are never computed by machine code. They have the same bits.
    #[must_use]
    pub fn interpreted(&self) -> System {
        System { interpreted: true, ..self.clone() }
    }

    /// The token that cancels work with this system. It is the token of the pool the system was
    /// compiled from.
    pub fn cancel(&self) -> &Cancel {
        &self.cancel
    }

    /// Whether the rates of change have kinks or jumps, from `abs`, `sign`, `min` or `max`.
    pub fn has_kinks(&self) -> bool {
        self.shared.motion.native.switches() > 0
    }

    /// Whether it has kinks at places that depend on the state: those of a ramp come at their times, whatever the state.
    pub fn has_kinks_of_states(&self) -> bool {
        self.shared.motion.native.has_switches_of_inputs()
    }

    /// The native form of its states: velocities for a Lagrangian, momenta for a Hamiltonian.
    pub fn form(&self) -> Form {
        self.shared.native
    }

    /// The channels, in the order of [`Observer::observe`](super::Observer::observe).
    pub fn channels(&self) -> &[Channel] {
        &self.shared.observables.channels
    }

    /// The number of leading channels that are the columns of a run: coordinates, velocities,
    /// momenta, energy, declared observables, extra channels.
    pub fn columns(&self) -> usize {
        self.shared.observables.columns
    }

    /// The channel of an expression of the model (of a view, a shape or an observable) or of the
    /// equations (of a conserved quantity), if it is observed.
    pub fn channel_of(&self, expression: Expr) -> Option<usize> {
        self.shared.observables.index.get(&expression).copied()
    }

    /// The period of a channel at these parameters, if it is periodic.
    pub fn period(&self, channel: usize, parameters: &[f64]) -> Option<f64> {
        let of = self.channels().get(channel).filter(|channel| channel.periodic)?;
        if !matches!(of.kind, super::ChannelKind::Position(_)) {
            return Some(std::f64::consts::TAU);
        }
        let period =
            self.initial_program(&self.inputs(parameters)).output(2 * self.degrees() + channel);
        (period.high > 0.0 && period.is_finite()).then_some(period.high)
    }

    /// The events and impulses of the system.
    pub fn discontinuities(&self) -> &Discontinuities {
        &self.shared.discontinuities
    }

    pub(super) fn constrained(&self) -> Option<&Constrained> {
        self.shared.constraints.as_ref()
    }

    pub(super) fn active_set(&self) -> &ActiveSet {
        &self.active_set
    }

    /// The same system with another set of enforced constraints.
    pub(super) fn with_active_set(&self, active_set: ActiveSet) -> System {
        System { active_set, ..self.clone() }
    }

    /// The same system with other tangent vectors.
    pub(super) fn carrying(&self, tangents: Option<Arc<Tangents>>) -> System {
        System { tangents, ..self.clone() }
    }

    pub(super) fn variational(&self) -> Option<&Tangents> {
        self.tangents.as_deref()
    }

    /// The parameter inputs of the programs: the values, read as the decimals they are written as,
    /// and the quantities derived from them.
    pub fn inputs(&self, parameters: &[f64]) -> Vec<DoubleDouble> {
        let mut inputs: Vec<DoubleDouble> =
            parameters.iter().map(|&x| DoubleDouble::from_decimal(x)).collect();
        if let Some(inertia) = &self.shared.inertia {
            inputs.extend(inertia.values(&inputs));
        }
        if let Some(constraints) = self.constrained().filter(|c| c.switched) {
            inputs.extend(self.active_set.switches(constraints.names.len()));
        }
        inputs
    }

    pub(super) fn motion(&self) -> &MotionPrograms {
        self.variational().map_or(&self.shared.motion, |tangents| &tangents.motion)
    }

    pub(super) fn quadratures(&self) -> Quadratures {
        self.shared.quadratures
    }

    /// The relation between velocities and momenta at these parameters.
    pub(super) fn legendre(&self, parameters: &[DoubleDouble]) -> Legendre {
        let mut legendre = Legendre::new(Arc::clone(&self.shared.legendre), self.form());
        legendre.set_parameters(parameters);
        legendre
    }
}
