//! The compiled system.

use std::sync::Arc;

use super::active_set::{ActiveSet, Constrained};
use super::consistent_initial::KnownVelocity;
use super::error::{MotionError, MotionErrorKind};
use super::inertia::Inertia;
use super::kkt::ConstraintSystem;
use super::legendre::{self, Legendre};
use super::machine_code::CodeCache;
use super::observables::{ObservableList, Observables, has_work};
use super::program::Program;
use super::rhs::{MotionPrograms, ProgramBuilder, Quadratures, Tangents};
use super::separability::NotSeparable;
use super::terms::{ConservedTerms, Terms};
use super::value::Evaluator;
use super::variations::Variations;
use super::{Channel, Discontinuities, Form, State, steep_program};
use crate::cancel::Cancel;
use crate::expr::{Expr, Symbol};
use crate::mechanics::Equations;
use crate::model::{self, Model};
use crate::num::{DoubleDouble, Real};

/// A model lowered to numbers. It is immutable and cheap to clone; steppers and observers share it
/// and own their registers.
#[derive(Clone, Debug)]
pub struct System {
    pub(super) shared: Arc<Shared>,
    active_set: ActiveSet,
    cancel: Cancel,
    tangents: Option<Arc<Tangents>>,
    /// Whether events that only mark their times are left out.
    pub(super) unmarked: bool,
    /// Whether its series are never computed by machine code.
    pub(super) interpreted: bool,
}

#[derive(Debug)]
pub(super) struct Shared {
    native: Form,
    /// The number of coordinates or variables.
    pub(super) degrees: usize,
    pub(super) quadratures: Quadratures,
    motion: MotionPrograms,
    watch: Observables,
    terms: Terms,
    discontinuities: Discontinuities,
    /// The arguments of the exponential functions in the law, of (q, native rates, action, work).
    steep: Arc<Program>,
    divisors: Arc<Program>,
    signed_divisors: Arc<Program>,
    inertia: Option<Inertia>,
    legendre: Arc<Program>,
    /// The index, among the auxiliary numbers, at which an attitude begins.
    pub(super) attitude: Option<usize>,
    /// The index, among them, at which the coordinates and velocities of the comparison motion begin.
    pub(super) comparison: Option<usize>,
    /// Initial values of the auxiliary numbers, as functions of a state in the native form.
    pub(super) auxiliary: Arc<Program>,
    /// Initial coordinates, rates and periods (zero for none), as functions of the parameters
    /// alone.
    pub(super) initial: Arc<Program>,
    constraints: Option<Constrained>,
    /// Which initial rates the file gives.
    pub(super) known: Vec<KnownVelocity>,
    /// The energy as a function of (q, native rates).
    energy: Arc<Program>,
    /// Whether the time of its states is −t.
    backwards: bool,
    /// The channels that were given beside those of the model.
    extra: Vec<model::WrittenExpr>,
    /// The programs with tangent vectors that were asked for.
    pub(super) variations: Variations,
}

/// Returns what the file specifies about an initial rate.
fn known(coordinate: &model::Coordinate) -> KnownVelocity {
    if coordinate.rate_given { KnownVelocity::InitialOverride } else { KnownVelocity::LeftOut }
}

/// Why a model cannot be compiled.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum CompileError {
    /// The equations exceed the size of the pool.
    #[error("the equations of this system grow beyond a million nodes")]
    TooLarge,
    /// A symbol has no meaning where it is used.
    #[error("`{0}` has no value where it is used")]
    Unknown(String),
}

impl System {
    /// Compiles `equations`, which were derived from `model`. All expressions, including those of
    /// the `extra` channels, belong to `equations.pool`.
    ///
    /// # Errors
    /// Returns an error if an expression depends on a symbol that has no number in a state.
    pub fn compile(
        model: &Model,
        equations: &Equations,
        extra: &[model::WrittenExpr],
    ) -> Result<System, CompileError> {
        Self::compile_along(model, equations, extra, false)
    }

    /// The same system run the other way: the time of its states is −t, and their rates of change are dx/d(−t) =
    /// −dx/dt. Coordinates, velocities, momenta and all channels mean what they mean here, so that a state
    /// belongs to both systems but for the sign of its time. Functions of events that only count in one direction count
    /// in the same direction of t. Impulses are not undone. `model` and `equations` are those it was compiled from.
    ///
    /// # Errors
    /// As [`System::compile`].
    pub fn reversed(&self, model: &Model, equations: &Equations) -> Result<System, CompileError> {
        let backwards = !self.is_backwards();
        let reversed = Self::compile_along(model, equations, &self.shared.extra, backwards)?;
        Ok(reversed.with_cancel(self.cancel.clone()))
    }

    /// Whether the time of its states is −t.
    pub fn is_backwards(&self) -> bool {
        self.shared.backwards
    }

    fn compile_along(
        model: &Model,
        equations: &Equations,
        extra: &[model::WrittenExpr],
        backwards: bool,
    ) -> Result<System, CompileError> {
        let mut equations = equations.clone();
        let list = ObservableList::of(model, &mut equations, extra);
        let quantities = ConservedTerms::of(model, &mut equations);
        if !equations.has_moving_mass() {
            // splitting methods need it; where M moves there is nothing to find
            equations.separable();
        }
        if equations.is_lagrangian() && !equations.is_quadratic() {
            // where L is not quadratic, no block of linear equations gives q̇ in terms of p
            equations.velocities();
        }
        let equations = Arc::new(equations);
        let quadratures = Quadratures {
            action: list.depends(&equations, equations.symbols.action)
                || Discontinuities::depend(model, &equations, equations.symbols.action),
            work: has_work(model, &equations),
        };
        let mut builder = ProgramBuilder {
            pool: equations.pool.clone(),
            parameters: model.parameters.iter().map(|p| p.symbol).collect(),
            equations: &equations,
            quadratures,
            kkt: ConstraintSystem::default(),
            backwards,
        };
        let unknown =
            |symbol| CompileError::Unknown(equations.pool.symbol_info(symbol).name.clone());
        let inertia = Inertia::of(model, &mut builder).map_err(unknown)?;
        builder.parameters.extend(inertia.iter().flat_map(|m| m.names().to_vec()));
        let constraints =
            Constrained::of(model, &mut builder, inertia.as_ref()).map_err(unknown)?;
        let (constraints, active_set) = constraints.unzip();
        let shared = Self::write(model, &equations, &mut builder, (list, quantities), constraints)
            .map_err(unknown)?;
        if builder.pool.is_full() {
            return Err(CompileError::TooLarge);
        }
        let active_set = active_set.unwrap_or_default();
        let cancel = equations.pool.cancel().clone();
        let shared = Arc::new(Shared { inertia, extra: extra.to_vec(), ..shared });
        Ok(System {
            shared,
            active_set,
            cancel,
            tangents: None,
            unmarked: false,
            interpreted: false,
        })
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

    fn write(
        model: &Model,
        equations: &Arc<Equations>,
        builder: &mut ProgramBuilder<'_>,
        (list, quantities): (ObservableList, ConservedTerms),
        constraints: Option<Constrained>,
    ) -> Result<Shared, Symbol> {
        let split = match builder.split() {
            Some(split) => Ok(split?),
            None => Err(NotSeparable::of(equations)),
        };
        let motion = MotionPrograms {
            native: builder.native_rates()?,
            code: CodeCache::new(),
            canonical: builder.canonical_rates()?,
            split,
        };
        let mut lowering = builder.lowering();
        let coordinates = &model.coordinates;
        let mut outputs: Vec<_> = coordinates.iter().map(|c| lowering.lower(c.initial)).collect();
        outputs.extend(coordinates.iter().map(|c| lowering.lower(c.initial_rate)));
        let periods = coordinates.iter().map(|c| c.period.unwrap_or(Expr::ZERO));
        outputs.extend(periods.map(|e| lowering.lower(e)));
        let initial = lowering.finish(outputs)?;
        let energy = builder.equations.energy;
        let mut lowering = builder.on_native_state();
        let outputs = vec![lowering.lower(energy)];
        let energy = lowering.finish(outputs)?;
        Ok(Shared {
            native: builder.native(),
            degrees: coordinates.len(),
            quadratures: builder.quadratures,
            motion,
            legendre: legendre::program(builder)?,
            initial,
            constraints,
            attitude: builder.attitude(),
            comparison: builder.comparison(),
            auxiliary: builder.auxiliary_start()?,
            known: coordinates.iter().map(known).collect(),
            energy,
            discontinuities: Discontinuities::of(model, builder)?,
            steep: steep_program::program(builder)?,
            divisors: steep_program::divisors(builder)?,
            signed_divisors: steep_program::signed_divisors(builder)?,
            watch: list.compile(builder)?,
            terms: quantities.compile(builder)?,
            inertia: None,
            backwards: builder.backwards,
            extra: Vec::new(),
            variations: Variations::default(),
        })
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
        &self.shared.watch.channels
    }

    /// The number of leading channels that are the columns of a run: coordinates, velocities,
    /// momenta, energy, declared observables, extra channels.
    pub fn columns(&self) -> usize {
        self.shared.watch.columns
    }

    /// The channel of an expression of the model (of a view, a shape or an observable) or of the
    /// equations (of a conserved quantity), if it is observed.
    pub fn channel_of(&self, expression: Expr) -> Option<usize> {
        self.shared.watch.index.get(&expression).copied()
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

    /// Writes the inputs of the observing programs: a state in the system's native form, then
    /// action and work, which are zero if the state does not carry them.
    pub(super) fn inputs_of<R: Real>(&self, state: &State, out: &mut [R]) {
        let motion_len = self.motion_len();
        for (i, x) in out[..motion_len].iter_mut().enumerate() {
            *x = R::of(state.exact(i));
        }
        let quadratures = self.quadratures();
        let mut next = self.driven_len();
        for (auxiliary, place) in
            [(quadratures.action, motion_len), (quadratures.work, motion_len + 1)]
        {
            out[place] = R::ZERO;
            if auxiliary {
                out[place] = R::of(state.exact(next));
                next += 1;
            }
        }
    }

    /// The energy of a state in the system's native form.
    pub(super) fn energy_of(
        &self,
        state: &State,
        parameters: &[f64],
    ) -> Result<DoubleDouble, MotionError> {
        let program = self.energy_program();
        let mut values: Evaluator<DoubleDouble> = Evaluator::new(Arc::clone(&program));
        values.set_parameters(&self.inputs(parameters));
        let numbers: Vec<DoubleDouble> = (0..self.moving()).map(|i| state.exact(i)).collect();
        let found = values.evaluate(state.exact_time(), &numbers);
        found.map_err(|why| self.singular(&program, why, state.time, &state.values))?;
        Ok(values.output(0))
    }

    /// Returns an error if a state in the system's native form has no finite energy, that is where
    /// its Lagrangian or Hamiltonian has no value, though its derivatives may have one.
    pub(crate) fn check_energy(
        &self,
        state: &State,
        parameters: &[f64],
    ) -> Result<(), MotionError> {
        if self.energy_of(state, parameters)?.is_finite() {
            return Ok(());
        }
        let kind = MotionErrorKind::NotFinite("the energy".to_owned());
        Err(self.error(kind, state.time, &state.values))
    }

    /// The events and impulses of the system.
    pub fn discontinuities(&self) -> &Discontinuities {
        &self.shared.discontinuities
    }

    pub(super) fn steep_program(&self) -> &Arc<Program> {
        &self.shared.steep
    }

    pub(super) fn divisor_program(&self) -> &Arc<Program> {
        &self.shared.divisors
    }

    pub(super) fn signed_divisor_program(&self) -> &Arc<Program> {
        &self.shared.signed_divisors
    }

    pub(super) fn terms(&self) -> &Terms {
        &self.shared.terms
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

    /// The values of the body's symbols at these parameters, empty if there is no body.
    pub fn body_values(&self, parameters: &[f64]) -> Vec<(Symbol, f64)> {
        let Some(inertia) = &self.shared.inertia else { return Vec::new() };
        let written: Vec<DoubleDouble> =
            parameters.iter().map(|&x| DoubleDouble::from_decimal(x)).collect();
        let values = inertia.values(&written).into_iter().map(|x| x.high);
        inertia.names().iter().copied().zip(values).collect()
    }

    pub(super) fn watch(&self) -> &Observables {
        &self.shared.watch
    }

    pub(super) fn motion(&self) -> &MotionPrograms {
        self.variational().map_or(&self.shared.motion, |tangents| &tangents.motion)
    }

    pub(super) fn quadratures(&self) -> Quadratures {
        self.shared.quadratures
    }

    pub(super) fn legendre_program(&self) -> Arc<Program> {
        Arc::clone(&self.shared.legendre)
    }

    pub(super) fn energy_program(&self) -> Arc<Program> {
        Arc::clone(&self.shared.energy)
    }

    /// The relation between velocities and momenta at these parameters.
    pub(super) fn legendre(&self, parameters: &[DoubleDouble]) -> Legendre {
        let mut legendre = self.blank_legendre();
        legendre.set_parameters(parameters);
        legendre
    }

    /// The same relation before parameters are set.
    pub(super) fn blank_legendre(&self) -> Legendre {
        Legendre::new(Arc::clone(&self.shared.legendre), self.form())
    }

    pub(super) fn state_of(
        &self,
        time: DoubleDouble,
        form: Form,
        numbers: &[DoubleDouble],
    ) -> State {
        let mut state = State::new(time.high, form, vec![0.0; self.state_len()]);
        state.time_carry = time.low;
        for (i, &x) in numbers.iter().enumerate() {
            state.set(i, x);
        }
        state
    }
}
