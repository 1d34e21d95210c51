//! The compiled system.

use std::sync::Arc;

use super::consistent_initial::Known;
use super::constrained::{ActiveSet, Constrained};
use super::error::{MotionError, MotionErrorKind};
use super::inertia::Inertia;
use super::kkt::ConstraintSystem;
use super::legendre::{self, Legendre, LegendreError};
use super::observables::{ObservableList, Observables};
use super::program::{Program, Singular};
use super::rhs::{ProgramBuilder, Quadratures, Split};
use super::terms::{Quantities, TermWatch, Terms};
use super::value::Evaluator;
use super::{Channel, Discontinuities, Form, InitialOverride, Observer, State};
use crate::cancel::Cancel;
use crate::expr::{Expr, Symbol};
use crate::mechanics::Equations;
use crate::model::{self, Model};
use crate::num::DoubleDouble;

/// A model lowered to numbers. Immutable and cheap to clone: steppers and observers share it and
/// hold their own registers.
#[derive(Clone, Debug)]
pub struct System {
    shared: Arc<Shared>,
    holding: ActiveSet,
    cancel: Cancel,
}

#[derive(Debug)]
struct Shared {
    native: Form,
    /// How many coordinates or variables there are.
    degrees: usize,
    quadratures: Quadratures,
    motion: MotionPrograms,
    watch: Observables,
    terms: Terms,
    discontinuities: Discontinuities,
    inertia: Option<Inertia>,
    legendre: Arc<Program>,
    /// Where among the numbers carried along an attitude begins.
    attitude: Option<usize>,
    /// Of a state in the native form: the numbers carried along, as they start.
    auxiliary: Arc<Program>,
    /// Of the parameters alone: initial coordinates, rates, periods (zero where there is none).
    initial: Arc<Program>,
    constraints: Option<Constrained>,
    /// Which rates the file gives at the start.
    known: Vec<Known>,
    /// The energy of (q, native rates).
    energy: Arc<Program>,
}

/// The equations of motion, in every form a method may ask for.
#[derive(Debug)]
pub(super) struct MotionPrograms {
    /// Of a state in the native form.
    pub(super) native: Arc<Program>,
    /// Of a state (q, p); where the flag is false, of (q, q̇).
    pub(super) canonical: (Arc<Program>, bool),
    /// The two halves of a separable system, or why it is none.
    pub(super) split: Result<Split, String>,
}

/// What the file says of a rate at the start.
fn known(coordinate: &model::Coordinate) -> Known {
    if coordinate.rate_given { Known::InitialOverride } else { Known::LeftOut }
}

/// Why a model cannot be compiled.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum CompileError {
    /// The equations have outgrown the pool.
    #[error("the equations of this system grow beyond a million nodes")]
    TooLarge,
    /// A symbol stands for nothing where it is used.
    #[error("`{0}` has no value where it is used")]
    Unknown(String),
}

impl System {
    /// Compiles `equations`, which were derived from `model`. All expressions, those of the
    /// `extra` channels included, are of `equations.pool`.
    pub fn compile(
        model: &Model,
        equations: &Equations,
        extra: &[model::Channel],
    ) -> Result<System, CompileError> {
        let mut equations = equations.clone();
        let list = ObservableList::of(model, &mut equations, extra);
        let quantities = Quantities::of(&mut equations);
        let quadratures = Quadratures {
            action: list.depends(&equations, equations.symbols.action),
            work: equations.energy_rate != Expr::ZERO || !model.impulses.is_empty(),
        };
        let mut builder = ProgramBuilder {
            pool: equations.pool.clone(),
            parameters: model.parameters.iter().map(|p| p.symbol).collect(),
            equations: &equations,
            quadratures,
            kkt: ConstraintSystem::default(),
        };
        let unknown =
            |symbol| CompileError::Unknown(equations.pool.symbol_info(symbol).name.clone());
        let inertia = Inertia::of(model, &mut builder).map_err(unknown)?;
        builder.parameters.extend(inertia.iter().flat_map(|m| m.names().to_vec()));
        let constraints =
            Constrained::of(model, &mut builder, inertia.as_ref()).map_err(unknown)?;
        let (constraints, holding) = constraints.unzip();
        let shared =
            Self::write(model, &mut builder, (list, quantities), constraints).map_err(unknown)?;
        if builder.pool.is_full() {
            return Err(CompileError::TooLarge);
        }
        let holding = holding.unwrap_or_default();
        let cancel = equations.pool.cancel().clone();
        Ok(System { shared: Arc::new(Shared { inertia, ..shared }), holding, cancel })
    }

    /// The token by which work with this system is stopped: that of the pool it was made from.
    pub fn cancel(&self) -> &Cancel {
        &self.cancel
    }

    fn write(
        model: &Model,
        builder: &mut ProgramBuilder<'_>,
        (list, quantities): (ObservableList, Quantities),
        constraints: Option<Constrained>,
    ) -> Result<Shared, Symbol> {
        let split = match builder.split() {
            Some(split) => Ok(split?),
            None => Err(match (&builder.equations.hamiltonian, &builder.equations.separable) {
                (_, Err(why)) | (Err(why), _) => why.to_string(),
                _ => String::new(),
            }),
        };
        let motion = MotionPrograms {
            native: builder.native_rates()?,
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
            auxiliary: builder.auxiliary_start()?,
            known: coordinates.iter().map(known).collect(),
            energy,
            discontinuities: Discontinuities::of(model, builder)?,
            watch: list.compile(builder)?,
            terms: quantities.compile(builder)?,
            inertia: None,
        })
    }

    /// The number of coordinates, or of the variables of a Poisson system.
    pub fn degrees(&self) -> usize {
        self.shared.degrees
    }

    /// How many numbers of a state say where the motion is: coordinates and as many rates, or the
    /// variables of a Poisson system.
    pub fn moving(&self) -> usize {
        if self.form() == Form::Variables { self.degrees() } else { 2 * self.degrees() }
    }

    /// The same and the numbers that are carried along beside the motion: all that rates of change
    /// depend on.
    pub fn driven_len(&self) -> usize {
        self.moving() + self.shared.auxiliary.outputs()
    }

    /// How many numbers a state has: those that rates depend on, and the integrals.
    pub fn state_len(&self) -> usize {
        self.driven_len() + self.shared.quadratures.count()
    }

    /// Whether the rates of change have kinks or jumps: of `abs`, `sign`, `min`, `max`.
    pub fn has_kinks(&self) -> bool {
        self.shared.motion.native.switches() > 0
    }

    /// The form its states have where no method asks for another: velocities for a Lagrangian,
    /// momenta for a Hamiltonian.
    pub fn form(&self) -> Form {
        self.shared.native
    }

    /// What can be seen of a state, in the order of [`Observer::observe`].
    pub fn channels(&self) -> &[Channel] {
        &self.shared.watch.channels
    }

    /// The first so many channels are the columns of a run: coordinates, velocities, momenta,
    /// energy, declared observables, extra channels.
    pub fn columns(&self) -> usize {
        self.shared.watch.columns
    }

    /// The channel of an expression of the model (a view's, a shape's, an observable's) or of the
    /// equations (a conserved quantity's), if it is watched.
    pub fn channel_of(&self, expression: Expr) -> Option<usize> {
        self.shared.watch.index.get(&expression).copied()
    }

    /// After what a channel repeats at these parameters, if it does.
    pub fn period(&self, channel: usize, parameters: &[f64]) -> Option<f64> {
        if !self.channels().get(channel)?.periodic {
            return None;
        }
        let period =
            self.initial_program(&self.inputs(parameters)).output(2 * self.degrees() + channel);
        (period.high > 0.0 && period.is_finite()).then_some(period.high)
    }

    /// The initial coordinates, then velocities or momenta, as the file gives them at these
    /// parameters.
    pub fn initial_values(&self, parameters: &[f64]) -> Vec<f64> {
        let values = self.initial_program(&self.inputs(parameters));
        (0..self.moving()).map(|i| values.output(i).high).collect()
    }

    fn initial_program(&self, parameters: &[DoubleDouble]) -> Evaluator<DoubleDouble> {
        let mut values = Evaluator::new(Arc::clone(&self.shared.initial));
        values.set_parameters(parameters);
        values
    }

    /// The initial state at these parameters; `given` values take the place of the file's.
    pub fn initial(
        &self,
        start: f64,
        parameters: &[f64],
        given: &[InitialOverride],
    ) -> Result<State, MotionError> {
        let mut state = self.begin(start, parameters, given)?;
        let program = &self.shared.auxiliary;
        if program.outputs() > 0 {
            let mut values: Evaluator<DoubleDouble> = Evaluator::new(Arc::clone(program));
            values.set_parameters(&self.inputs(parameters));
            let numbers: Vec<DoubleDouble> = (0..self.moving()).map(|i| state.exact(i)).collect();
            let found = values.evaluate(state.exact_time(), &numbers);
            found.map_err(|why| self.singular(program, why, state.time, &state.values))?;
            for i in 0..program.outputs() {
                state.set(self.moving() + i, values.output(i));
            }
            self.check_finite(&state)?;
        }
        Ok(state)
    }

    /// The initial state but for the numbers carried along.
    fn begin(
        &self,
        start: f64,
        parameters: &[f64],
        given: &[InitialOverride],
    ) -> Result<State, MotionError> {
        let n = self.degrees();
        let inputs = self.inputs(parameters);
        let values = self.initial_program(&inputs);
        let mut state: Vec<DoubleDouble> = (0..self.moving()).map(|i| values.output(i)).collect();
        let mut targets = vec![None; n];
        let mut known = self.shared.known.clone();
        for &given in given {
            match (given, self.form()) {
                (InitialOverride::Position(i, x), _) => state[i] = DoubleDouble::written(x),
                (InitialOverride::Velocity(i, x), Form::Velocity)
                | (InitialOverride::Momentum(i, x), Form::Momentum) => {
                    (state[n + i], targets[i]) = (DoubleDouble::written(x), None);
                    known[i] = Known::InitialOverride;
                }
                (InitialOverride::Velocity(i, x) | InitialOverride::Momentum(i, x), _) => {
                    targets[i] = Some(DoubleDouble::written(x));
                    known[i] = Known::Momentum(DoubleDouble::written(x));
                }
            }
        }
        let time = DoubleDouble::written(start);
        if self.constraints() > 0 {
            let state = self.state_of(time, self.form(), &state);
            self.check_finite(&state)?;
            return self.begin_on_constraints(state, &known, parameters);
        }
        if targets.iter().any(Option::is_some) {
            let mut legendre = self.legendre(&inputs);
            legendre
                .solve(time, &mut state, &targets)
                .map_err(|why| self.unsolved(why, time.high, &state))?;
            let solutions = legendre.solutions(time, &state, &targets);
            if solutions.len() > 1 {
                return Err(self.several(time.high, &solutions, &targets));
            }
        }
        let state = self.state_of(time, self.form(), &state);
        self.check_finite(&state)?;
        Ok(state)
    }

    /// The same state in another form. Where several velocities belong to the momenta, those are
    /// looked for that the file's lead to; who knows better asks [`System::convert_near`].
    pub fn convert(
        &self,
        state: &State,
        form: Form,
        parameters: &[f64],
    ) -> Result<State, MotionError> {
        let inputs = self.inputs(parameters);
        let mut legendre = self.legendre(&inputs);
        if state.form != form && self.has_branches() && form == self.form() {
            let values = self.initial_program(&inputs);
            let rates = (self.degrees()..self.moving()).map(|i| values.output(i)).collect();
            return self.convert_from(&mut legendre, state, rates);
        }
        self.convert_by(&mut legendre, state, form, None)
    }

    /// To the native form, from a guess of the rates that need not be near.
    fn convert_from(
        &self,
        legendre: &mut Legendre,
        state: &State,
        rates: Vec<DoubleDouble>,
    ) -> Result<State, MotionError> {
        let n = self.degrees();
        let targets: Vec<_> = (n..2 * n).map(|i| Some(state.exact(i))).collect();
        let mut numbers: Vec<DoubleDouble> = (0..n).map(|i| state.exact(i)).chain(rates).collect();
        let outcome = legendre.solve(state.exact_time(), &mut numbers, &targets);
        outcome.map_err(|why| self.unsolved(why, state.time, &numbers))?;
        let mut result = state.clone();
        result.form = self.form();
        for (i, &x) in numbers.iter().enumerate() {
            result.set(i, x);
        }
        self.check_finite(&result)?;
        Ok(result)
    }

    /// Whether velocities are found from momenta by iteration only: several may belong to the
    /// same.
    pub(super) fn has_branches(&self) -> bool {
        self.form() == Form::Velocity && !self.motion().canonical.1
    }

    /// Carries a state through a jump of the parameters: q and p are kept, and so q̇ may change.
    /// Where the constraints change with them, q is moved by the least amount that keeps them, and
    /// p by their reactions.
    pub fn change_parameters(
        &self,
        state: &State,
        old: &[f64],
        new: &[f64],
    ) -> Result<State, MotionError> {
        if state.form != Form::Velocity {
            return Ok(state.clone());
        }
        let mut legendre = self.legendre(&self.inputs(old));
        let canonical = self.convert_by(&mut legendre, state, Form::Momentum, None)?;
        if let Some(mut projector) = self.projector(new) {
            let n = self.degrees();
            let target: Vec<DoubleDouble> = (n..2 * n).map(|i| canonical.exact(i)).collect();
            let mut after = state.clone();
            projector.project(&mut after)?;
            return Ok(self.impulse_outcome(&after, &target, new)?.0);
        }
        legendre.set_parameters(&self.inputs(new));
        self.convert_by(&mut legendre, &canonical, Form::Velocity, Some(state))
    }

    /// Converts with a relation at hand; `guess` is a state near the result.
    pub(super) fn convert_by(
        &self,
        legendre: &mut Legendre,
        state: &State,
        form: Form,
        guess: Option<&State>,
    ) -> Result<State, MotionError> {
        if state.form == form {
            return Ok(state.clone());
        }
        let n = self.degrees();
        let time = state.exact_time();
        let mut result = state.clone();
        result.form = form;
        let mut numbers: Vec<DoubleDouble> = (0..self.moving()).map(|i| state.exact(i)).collect();
        let outcome = if form == legendre.native() {
            let targets: Vec<_> = numbers[n..].iter().copied().map(Some).collect();
            for i in n..2 * n {
                numbers[i] = guess.map_or(DoubleDouble::ZERO, |guess| guess.exact(i));
            }
            match guess {
                Some(_) => legendre.follow(time, &mut numbers, &targets),
                None => legendre.solve(time, &mut numbers, &targets),
            }
        } else {
            let mut other = vec![DoubleDouble::ZERO; n];
            let outcome = legendre.other_rates(time, &numbers, &mut other);
            numbers[n..].copy_from_slice(&other);
            outcome
        };
        outcome.map_err(|why| self.unsolved(why, state.time, &numbers))?;
        for (i, &x) in numbers.iter().enumerate() {
            result.set(i, x);
        }
        self.check_finite(&result)?;
        Ok(result)
    }

    /// The same in the system's own form, near a state that has it already: on the same branch,
    /// where several velocities belong to the momenta.
    pub fn convert_near(
        &self,
        state: &State,
        near: &State,
        parameters: &[f64],
    ) -> Result<State, MotionError> {
        let mut legendre = self.legendre(&self.inputs(parameters));
        self.convert_by(&mut legendre, state, self.form(), Some(near))
    }

    /// The inputs of programs that look at states: a state in the system's own form, then action
    /// and work, zero where they are not carried.
    pub(super) fn inputs_of(&self, state: &State, out: &mut [DoubleDouble]) {
        let driven_len = self.driven_len();
        for (i, x) in out[..driven_len].iter_mut().enumerate() {
            *x = state.exact(i);
        }
        let quadratures = self.quadratures();
        let mut next = driven_len;
        for (auxiliary, place) in
            [(quadratures.action, driven_len), (quadratures.work, driven_len + 1)]
        {
            out[place] = DoubleDouble::ZERO;
            if auxiliary {
                out[place] = state.exact(next);
                next += 1;
            }
        }
    }

    /// Whether a state carries the action and the work.
    pub(super) fn carries(&self) -> [bool; 2] {
        let quadratures = self.quadratures();
        [quadratures.action, quadratures.work]
    }

    /// Where a state carries the nine numbers of an attitude, by rows.
    pub(crate) fn attitude_place(&self) -> Option<usize> {
        self.shared.attitude.map(|place| self.moving() + place)
    }

    /// Where a state carries the work done on it.
    pub(super) fn work_place(&self) -> Option<usize> {
        let quadratures = self.quadratures();
        quadratures.work.then(|| self.driven_len() + usize::from(quadratures.action))
    }

    /// The energy of a state in the system's own form.
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

    /// A fault where a state in the system's own form has no finite energy: where its Lagrangian
    /// or Hamiltonian has no value, though its derivatives may have.
    pub(crate) fn check_energy(
        &self,
        state: &State,
        parameters: &[f64],
    ) -> Result<(), MotionError> {
        if self.energy_of(state, parameters)?.is_finite() {
            return Ok(());
        }
        let kind = MotionErrorKind::NotFinite("the energy".to_owned());
        Err(self.fault(kind, state.time, &state.values))
    }

    /// What may happen to its motions.
    pub fn discontinuities(&self) -> &Discontinuities {
        &self.shared.discontinuities
    }

    /// What looks at states of this system.
    pub fn observer(&self, parameters: &[f64]) -> Observer {
        Observer::new(self.clone(), parameters)
    }

    /// Looks at the terms of what is conserved, at these parameters.
    pub fn term_watch(&self, parameters: &[f64]) -> TermWatch {
        TermWatch::new(self.clone(), &self.shared.terms, parameters)
    }

    pub(super) fn constrained(&self) -> Option<&Constrained> {
        self.shared.constraints.as_ref()
    }

    pub(super) fn holding(&self) -> &ActiveSet {
        &self.holding
    }

    /// The same system with other constraints held.
    pub(super) fn with_holding(&self, holding: ActiveSet) -> System {
        System { shared: Arc::clone(&self.shared), holding, cancel: self.cancel.clone() }
    }

    /// What programs are given for parameters: their values as the decimals they are written as,
    /// and what follows from them.
    pub fn inputs(&self, parameters: &[f64]) -> Vec<DoubleDouble> {
        let mut inputs: Vec<DoubleDouble> =
            parameters.iter().map(|&x| DoubleDouble::written(x)).collect();
        if let Some(inertia) = &self.shared.inertia {
            inputs.extend(inertia.values(&inputs));
        }
        if let Some(constraints) = self.constrained().filter(|c| c.switched) {
            inputs.extend(self.holding.switches(constraints.names.len()));
        }
        inputs
    }

    /// What the names of the file's body stand for at these parameters; nothing where there is no
    /// body.
    pub fn body_values(&self, parameters: &[f64]) -> Vec<(Symbol, f64)> {
        let Some(inertia) = &self.shared.inertia else { return Vec::new() };
        let written: Vec<DoubleDouble> =
            parameters.iter().map(|&x| DoubleDouble::written(x)).collect();
        let values = inertia.values(&written).into_iter().map(|x| x.high);
        inertia.names().iter().copied().zip(values).collect()
    }

    pub(super) fn watch(&self) -> &Observables {
        &self.shared.watch
    }

    pub(super) fn motion(&self) -> &MotionPrograms {
        &self.shared.motion
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

    /// The same before parameters are set.
    pub(super) fn blank_legendre(&self) -> Legendre {
        Legendre::new(Arc::clone(&self.shared.legendre), self.form())
    }

    fn state_of(&self, time: DoubleDouble, form: Form, numbers: &[DoubleDouble]) -> State {
        let mut state = State::new(time.high, form, vec![0.0; self.state_len()]);
        state.time_carry = time.low;
        for (i, &x) in numbers.iter().enumerate() {
            state.set(i, x);
        }
        state
    }

    /// A fault where a number of a state is not finite.
    pub fn check_finite(&self, state: &State) -> Result<(), MotionError> {
        match state.values.iter().position(|x| !x.is_finite()) {
            None => Ok(()),
            Some(i) => {
                let name = MotionErrorKind::NotFinite(self.name_of(i, state.form));
                Err(self.fault(name, state.time, &state.values))
            }
        }
    }

    /// How a number of a state is shown.
    fn name_of(&self, i: usize, form: Form) -> String {
        let n = self.degrees();
        let channel = match form {
            Form::Momentum if i >= n => i + n,
            _ => i,
        };
        if i < self.moving() {
            self.channels()[channel].shown.clone()
        } else {
            "an integral".to_owned()
        }
    }

    /// A fault at a state, told with its coordinates.
    pub fn fault(&self, kind: MotionErrorKind, time: f64, values: &[f64]) -> MotionError {
        let named = self.channels().iter().zip(values).take(self.degrees().min(4));
        let place = named.map(|(c, &x)| (c.shown.clone(), x)).filter(|(_, x)| x.is_finite());
        MotionError { time, kind, place: place.collect() }
    }

    /// The fault of a singular matrix, told with the coordinates the matrix depends on.
    pub(super) fn singular(
        &self,
        program: &Program,
        singular: Singular,
        time: f64,
        values: &[f64],
    ) -> MotionError {
        let named = program.inputs_of(singular).iter().filter(|&&i| i < self.degrees());
        let place = named.map(|&i| (self.channels()[i].shown.clone(), values[i]));
        let held = self.constraints() > 0;
        let kind = if held {
            MotionErrorKind::SingularConstraints(None)
        } else {
            MotionErrorKind::SingularMass
        };
        MotionError { time, kind, place: place.take(4).collect() }
    }

    /// The fault of given momenta (or velocities) that do not say with which rates the motion
    /// starts.
    fn several(
        &self,
        time: f64,
        solutions: &[Vec<DoubleDouble>],
        targets: &[Option<DoubleDouble>],
    ) -> MotionError {
        let n = self.degrees();
        let unknown: Vec<usize> = (0..n).filter(|&i| targets[i].is_some()).collect();
        let first = if self.form() == Form::Momentum { 2 * n } else { n };
        let told = |solution: &Vec<DoubleDouble>| {
            let rate = |&i: &usize| {
                format!("{} = {}", self.channels()[first + i].name, solution[n + i].high)
            };
            unknown.iter().map(rate).collect::<Vec<_>>().join(", ")
        };
        let kind = MotionErrorKind::SeveralStarts(solutions.iter().map(told).collect());
        MotionError { time, kind, place: Vec::new() }
    }

    /// The fault of a relation between velocities and momenta that was not solved.
    pub(super) fn unsolved(
        &self,
        why: LegendreError,
        time: f64,
        numbers: &[DoubleDouble],
    ) -> MotionError {
        let kind = match why {
            LegendreError::Singular => MotionErrorKind::SingularMass,
            LegendreError::NotConverging => MotionErrorKind::NoVelocities,
        };
        let values: Vec<f64> = numbers.iter().map(|x| x.high).collect();
        self.fault(kind, time, &values)
    }
}
