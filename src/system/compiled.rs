//! The compiled system.

use std::sync::Arc;

use super::beginning::Known;
use super::constrained::{Constrained, Holding};
use super::fault::{Fault, FaultKind};
use super::hold::Hold;
use super::legendre::{self, Legendre, Unsolved};
use super::moments::Moments;
use super::motion::{Quadratures, Split, Writer};
use super::program::{Program, Singular};
use super::terms::{Quantities, TermWatch, Terms};
use super::value::Values;
use super::watch::{List, Watch};
use super::{Channel, Form, Observer, Occasions, State};
use crate::cancel::Cancel;
use crate::expr::{Double, Expr, Symbol};
use crate::mechanics::Equations;
use crate::model::{self, Model};

/// A model lowered to numbers. Immutable and cheap to clone: steppers and observers share it and
/// hold their own registers.
#[derive(Clone, Debug)]
pub struct System {
    pub(super) shared: Arc<Shared>,
    holding: Holding,
    cancel: Cancel,
}

#[derive(Debug)]
pub(super) struct Shared {
    native: Form,
    /// How many coordinates or variables there are.
    degrees: usize,
    quadratures: Quadratures,
    motion: Motion,
    watch: Watch,
    terms: Terms,
    occasions: Occasions,
    moments: Option<Moments>,
    legendre: Arc<Program>,
    /// Where among the numbers carried along an attitude begins.
    attitude: Option<usize>,
    /// Of a state in the native form: the numbers carried along, as they start.
    pub(super) carried: Arc<Program>,
    /// Of the parameters alone: initial coordinates, rates, periods (zero where there is none).
    pub(super) initial: Arc<Program>,
    constraints: Option<Constrained>,
    /// Which rates the file gives at the start.
    pub(super) known: Vec<Known>,
    /// The energy of (q, native rates).
    energy: Arc<Program>,
}

/// The equations of motion, in every form a method may ask for.
#[derive(Debug)]
pub(super) struct Motion {
    /// Of a state in the native form.
    pub(super) native: Arc<Program>,
    /// Of a state (q, p); where the flag is false, of (q, q̇).
    pub(super) canonical: (Arc<Program>, bool),
    /// The two halves of a separable system, or why it is none.
    pub(super) split: Result<Split, String>,
}

/// What the file says of a rate at the start.
fn known(coordinate: &model::Coordinate) -> Known {
    if coordinate.rate_given { Known::Given } else { Known::LeftOut }
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
        let list = List::of(model, &mut equations, extra);
        let quantities = Quantities::of(&mut equations);
        let quadratures = Quadratures {
            action: list.depends(&equations, equations.symbols.action),
            work: equations.energy_rate != Expr::ZERO || !model.impulses.is_empty(),
        };
        let mut writer = Writer {
            pool: equations.pool.clone(),
            parameters: model.parameters.iter().map(|p| p.symbol).collect(),
            equations: &equations,
            quadratures,
            hold: Hold::default(),
        };
        let unknown =
            |symbol| CompileError::Unknown(equations.pool.symbol_info(symbol).name.clone());
        let moments = Moments::of(model, &mut writer).map_err(unknown)?;
        writer.parameters.extend(moments.iter().flat_map(|m| m.names().to_vec()));
        let constraints = Constrained::of(model, &mut writer, moments.as_ref()).map_err(unknown)?;
        let (constraints, holding) = constraints.unzip();
        let shared =
            Self::write(model, &mut writer, (list, quantities), constraints).map_err(unknown)?;
        if writer.pool.is_full() {
            return Err(CompileError::TooLarge);
        }
        let holding = holding.unwrap_or_default();
        let cancel = equations.pool.cancel().clone();
        Ok(System { shared: Arc::new(Shared { moments, ..shared }), holding, cancel })
    }

    /// The token by which work with this system is stopped: that of the pool it was made from.
    pub fn cancel(&self) -> &Cancel {
        &self.cancel
    }

    fn write(
        model: &Model,
        writer: &mut Writer<'_>,
        (list, quantities): (List, Quantities),
        constraints: Option<Constrained>,
    ) -> Result<Shared, Symbol> {
        let split = match writer.split() {
            Some(split) => Ok(split?),
            None => Err(match (&writer.equations.hamiltonian, &writer.equations.separable) {
                (_, Err(why)) | (Err(why), _) => why.to_string(),
                _ => String::new(),
            }),
        };
        let motion =
            Motion { native: writer.native_rates()?, canonical: writer.canonical_rates()?, split };
        let mut lowering = writer.lowering();
        let coordinates = &model.coordinates;
        let mut outputs: Vec<_> = coordinates.iter().map(|c| lowering.lower(c.initial)).collect();
        outputs.extend(coordinates.iter().map(|c| lowering.lower(c.initial_rate)));
        let periods = coordinates.iter().map(|c| c.period.unwrap_or(Expr::ZERO));
        outputs.extend(periods.map(|e| lowering.lower(e)));
        let initial = lowering.finish(outputs)?;
        let energy = writer.equations.energy;
        let mut lowering = writer.on_native_state();
        let outputs = vec![lowering.lower(energy)];
        let energy = lowering.finish(outputs)?;
        Ok(Shared {
            native: writer.native(),
            degrees: coordinates.len(),
            quadratures: writer.quadratures,
            motion,
            legendre: legendre::program(writer)?,
            initial,
            constraints,
            attitude: writer.attitude(),
            carried: writer.carried_start()?,
            known: coordinates.iter().map(known).collect(),
            energy,
            occasions: Occasions::of(model, writer)?,
            watch: list.compile(writer)?,
            terms: quantities.compile(writer)?,
            moments: None,
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
    pub fn driven(&self) -> usize {
        self.moving() + self.shared.carried.outputs()
    }

    /// How many numbers a state has: those that rates depend on, and the integrals.
    pub fn state_len(&self) -> usize {
        self.driven() + self.shared.quadratures.count()
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

    /// The inputs of programs that look at states: a state in the system's own form, then action
    /// and work, zero where they are not carried.
    pub(super) fn inputs_of(&self, state: &State, out: &mut [Double]) {
        let driven = self.driven();
        for (i, x) in out[..driven].iter_mut().enumerate() {
            *x = state.exact(i);
        }
        let quadratures = self.quadratures();
        let mut next = driven;
        for (carried, place) in [(quadratures.action, driven), (quadratures.work, driven + 1)] {
            out[place] = Double::ZERO;
            if carried {
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
        quadratures.work.then(|| self.driven() + usize::from(quadratures.action))
    }

    /// The energy of a state in the system's own form.
    pub(super) fn energy_of(&self, state: &State, parameters: &[f64]) -> Result<Double, Fault> {
        let program = self.energy_program();
        let mut values: Values<Double> = Values::new(Arc::clone(&program));
        values.set_parameters(&self.inputs(parameters));
        let numbers: Vec<Double> = (0..self.moving()).map(|i| state.exact(i)).collect();
        let found = values.evaluate(state.exact_time(), &numbers);
        found.map_err(|why| self.singular(&program, why, state.time, &state.values))?;
        Ok(values.output(0))
    }

    /// A fault where a state in the system's own form has no finite energy: where its Lagrangian
    /// or Hamiltonian has no value, though its derivatives may have.
    pub(crate) fn check_energy(&self, state: &State, parameters: &[f64]) -> Result<(), Fault> {
        if self.energy_of(state, parameters)?.is_finite() {
            return Ok(());
        }
        let kind = FaultKind::NotFinite("the energy".to_owned());
        Err(self.fault(kind, state.time, &state.values))
    }

    /// What may happen to its motions.
    pub fn occasions(&self) -> &Occasions {
        &self.shared.occasions
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

    pub(super) fn holding(&self) -> &Holding {
        &self.holding
    }

    /// The same system with other constraints held.
    pub(super) fn with_holding(&self, holding: Holding) -> System {
        System { shared: Arc::clone(&self.shared), holding, cancel: self.cancel.clone() }
    }

    /// What programs are given for parameters: their values as the decimals they are written as,
    /// and what follows from them.
    pub fn inputs(&self, parameters: &[f64]) -> Vec<Double> {
        let mut inputs: Vec<Double> = parameters.iter().map(|&x| Double::written(x)).collect();
        if let Some(moments) = &self.shared.moments {
            inputs.extend(moments.values(&inputs));
        }
        if let Some(constraints) = self.constrained().filter(|c| c.switched) {
            inputs.extend(self.holding.switches(constraints.names.len()));
        }
        inputs
    }

    /// What the names of the file's body stand for at these parameters; nothing where there is no
    /// body.
    pub fn body_values(&self, parameters: &[f64]) -> Vec<(Symbol, f64)> {
        let Some(moments) = &self.shared.moments else { return Vec::new() };
        let written: Vec<Double> = parameters.iter().map(|&x| Double::written(x)).collect();
        let values = moments.values(&written).into_iter().map(|x| x.high);
        moments.names().iter().copied().zip(values).collect()
    }

    pub(super) fn watch(&self) -> &Watch {
        &self.shared.watch
    }

    pub(super) fn motion(&self) -> &Motion {
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
    pub(super) fn legendre(&self, parameters: &[Double]) -> Legendre {
        let mut legendre = self.blank_legendre();
        legendre.set_parameters(parameters);
        legendre
    }

    /// The same before parameters are set.
    pub(super) fn blank_legendre(&self) -> Legendre {
        Legendre::new(Arc::clone(&self.shared.legendre), self.form())
    }

    pub(super) fn state_of(&self, time: Double, form: Form, numbers: &[Double]) -> State {
        let mut state = State::new(time.high, form, vec![0.0; self.state_len()]);
        state.time_carry = time.low;
        for (i, &x) in numbers.iter().enumerate() {
            state.set(i, x);
        }
        state
    }

    /// A fault where a number of a state is not finite.
    pub fn check_finite(&self, state: &State) -> Result<(), Fault> {
        match state.values.iter().position(|x| !x.is_finite()) {
            None => Ok(()),
            Some(i) => {
                let name = FaultKind::NotFinite(self.name_of(i, state.form));
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
    pub fn fault(&self, kind: FaultKind, time: f64, values: &[f64]) -> Fault {
        let named = self.channels().iter().zip(values).take(self.degrees().min(4));
        let place = named.map(|(c, &x)| (c.shown.clone(), x)).filter(|(_, x)| x.is_finite());
        Fault { time, kind, place: place.collect() }
    }

    /// The fault of a singular matrix, told with the coordinates the matrix depends on.
    pub(super) fn singular(
        &self,
        program: &Program,
        singular: Singular,
        time: f64,
        values: &[f64],
    ) -> Fault {
        let named = program.inputs_of(singular).iter().filter(|&&i| i < self.degrees());
        let place = named.map(|&i| (self.channels()[i].shown.clone(), values[i]));
        let held = self.constraints() > 0;
        let kind =
            if held { FaultKind::SingularConstraints(None) } else { FaultKind::SingularMass };
        Fault { time, kind, place: place.take(4).collect() }
    }

    /// The fault of given momenta (or velocities) that do not say with which rates the motion
    /// starts.
    pub(super) fn several(
        &self,
        time: f64,
        solutions: &[Vec<Double>],
        targets: &[Option<Double>],
    ) -> Fault {
        let n = self.degrees();
        let unknown: Vec<usize> = (0..n).filter(|&i| targets[i].is_some()).collect();
        let first = if self.form() == Form::Momentum { 2 * n } else { n };
        let told = |solution: &Vec<Double>| {
            let rate = |&i: &usize| {
                format!("{} = {}", self.channels()[first + i].name, solution[n + i].high)
            };
            unknown.iter().map(rate).collect::<Vec<_>>().join(", ")
        };
        let kind = FaultKind::SeveralStarts(solutions.iter().map(told).collect());
        Fault { time, kind, place: Vec::new() }
    }

    /// The fault of a relation between velocities and momenta that was not solved.
    pub(super) fn unsolved(&self, why: Unsolved, time: f64, numbers: &[Double]) -> Fault {
        let kind = match why {
            Unsolved::Singular => FaultKind::SingularMass,
            Unsolved::NotConverging => FaultKind::NoVelocities,
        };
        let values: Vec<f64> = numbers.iter().map(|x| x.high).collect();
        self.fault(kind, time, &values)
    }
}
