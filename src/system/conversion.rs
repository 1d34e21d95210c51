//! Creates states and converts them between forms: velocities and momenta, and the parameters
//! before and after a change.
//!
//! In: initial values, or a state. Out: a state of the requested form. Never here: steps.

use std::sync::Arc;

use super::compiled::System;
use super::consistent_initial::KnownVelocity;
use super::error::{MotionError, MotionErrorKind};
use super::legendre::{Legendre, LegendreError};
use super::value::Evaluator;
use super::{Channel, ChannelKind, Form, InitialOverride, State};
use crate::num::DoubleDouble;

impl System {
    /// The index in a state of the action ∫ L dt, if it is carried.
    pub fn action_place(&self) -> Option<usize> {
        self.quadratures().action.then(|| self.driven_len())
    }

    /// The initial coordinates, then velocities or momenta, as the file gives them at these
    /// parameters.
    pub fn initial_values(&self, parameters: &[f64]) -> Vec<f64> {
        let values = self.initial_program(&self.inputs(parameters));
        (0..self.moving()).map(|i| values.output(i).high).collect()
    }

    /// The values of all channels of which only the initial coordinates are known; `given` ones replace those of the file.
    pub fn coordinates_of_start(&self, parameters: &[f64], given: &[InitialOverride]) -> Vec<f64> {
        let mut initial = self.initial_values(parameters);
        for &given in given {
            if let InitialOverride::Position(i, x) = given {
                initial[i] = x;
            }
        }
        let coordinate = |channel: &Channel| match channel.kind {
            ChannelKind::Position(i) => initial[i],
            _ => f64::NAN,
        };
        self.channels().iter().map(coordinate).collect()
    }

    /// The initial value of an index in the order of [`System::initial_values`].
    pub fn initial_override(&self, index: usize, value: f64) -> InitialOverride {
        let n = self.degrees();
        match self.form() {
            _ if index < n => InitialOverride::Position(index, value),
            Form::Velocity => InitialOverride::Velocity(index - n, value),
            Form::Momentum | Form::Variables => InitialOverride::Momentum(index - n, value),
        }
    }

    pub(super) fn initial_program(&self, parameters: &[DoubleDouble]) -> Evaluator<DoubleDouble> {
        let mut values = Evaluator::new(Arc::clone(&self.shared.initial));
        values.set_parameters(parameters);
        values
    }

    /// The initial state at these parameters; `given` values replace those of the file.
    ///
    /// # Errors
    /// Returns an error if a value is not finite, no velocities belong to the momenta, or the constraints contradict the
    /// values.
    pub fn initial(
        &self,
        start: f64,
        parameters: &[f64],
        given: &[InitialOverride],
    ) -> Result<State, MotionError> {
        let mut state = self.begin(start, parameters, given)?;
        self.begin_auxiliary(&mut state, parameters)?;
        Ok(state)
    }

    /// Sets the auxiliary numbers of a state in the native form to those with which a motion begins there.
    ///
    /// # Errors
    /// Returns an error if they have no finite values.
    pub fn begin_auxiliary(
        &self,
        state: &mut State,
        parameters: &[f64],
    ) -> Result<(), MotionError> {
        let program = &self.shared.auxiliary;
        if program.outputs() > 0 {
            let values = self.evaluated(program, state, parameters)?;
            for i in 0..program.outputs() {
                state.set(self.moving() + i, values.output(i));
            }
            self.check_finite(state)?;
        }
        Ok(())
    }

    /// The initial state without its auxiliary numbers.
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
                (InitialOverride::Position(i, x), _) => state[i] = DoubleDouble::from_decimal(x),
                (InitialOverride::Velocity(i, x), Form::Velocity)
                | (InitialOverride::Momentum(i, x), Form::Momentum) => {
                    (state[n + i], targets[i]) = (DoubleDouble::from_decimal(x), None);
                    known[i] = KnownVelocity::InitialOverride;
                }
                (InitialOverride::Velocity(i, x) | InitialOverride::Momentum(i, x), _) => {
                    targets[i] = Some(DoubleDouble::from_decimal(x));
                    known[i] = KnownVelocity::Momentum(DoubleDouble::from_decimal(x));
                }
            }
        }
        let time = self.after_step_in_time(DoubleDouble::from_decimal(start), parameters)?;
        let small = |x: &DoubleDouble| x.high.is_subnormal();
        let other = if self.form() == Form::Velocity { Form::Momentum } else { Form::Velocity };
        let given = targets.iter().position(|x| x.as_ref().is_some_and(small));
        let too_small = (state.iter().position(small).map(|i| self.name_of(i, self.form())))
            .or_else(|| given.map(|i| self.name_of(n + i, other)));
        if let Some(name) = too_small {
            let kind = MotionErrorKind::TooSmall(name);
            let values: Vec<f64> = state.iter().map(|x| x.high).collect();
            return Err(self.error(kind, start, &values));
        }
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
            // p is linear in the velocities of an L that is quadratic in them
            if self.form() != Form::Velocity || !self.discontinuities().is_quadratic() {
                if legendre.is_rough(time, &state, &targets) {
                    let why = LegendreError::NotConverging;
                    return Err(self.unsolved(why, time.high, &state));
                }
                let solutions = legendre.solutions(time, &state, &targets);
                if solutions.len() > 1 {
                    return Err(self.several(time.high, &solutions, &targets));
                }
            }
        }
        let state = self.state_of(time, self.form(), &state);
        self.check_finite(&state)?;
        Ok(state)
    }

    /// The same state in another form. If several velocities belong to the momenta, the search
    /// starts from the file's initial velocities; [`System::convert_near`] takes a better guess, but
    /// leaves tangent vectors as they are.
    ///
    /// # Errors
    /// Returns an error if the state has no such form: the mass matrix is singular, or no velocities belong to the momenta.
    pub fn convert(
        &self,
        state: &State,
        form: Form,
        parameters: &[f64],
    ) -> Result<State, MotionError> {
        if state.form == form {
            // without the programs of a conversion
            return Ok(state.clone());
        }
        let inputs = self.inputs(parameters);
        let mut legendre = self.legendre(&inputs);
        let mut found = if self.has_branches() && form == self.form() {
            let values = self.initial_program(&inputs);
            let rates = (self.degrees()..self.moving()).map(|i| values.output(i)).collect();
            self.convert_from(&mut legendre, state, rates)?
        } else {
            self.convert_by(&mut legendre, state, form, None)?
        };
        self.convert_tangents(state, &mut found, parameters)?;
        Ok(found)
    }

    /// Converts to the native form from a guess of the rates, which need not be close.
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

    /// Whether velocities are found from momenta by iteration only, so that several may belong to
    /// the same momenta.
    pub(super) fn has_branches(&self) -> bool {
        self.form() == Form::Velocity && !self.motion().canonical.1
    }

    /// Transfers a state across a jump of the parameters. q and p are unchanged, so q̇ may change.
    /// If the constraints change with the parameters, q moves by the least amount that satisfies
    /// them, and p changes by their reactions.
    ///
    /// # Errors
    /// Returns an error if no state with these q and p exists at the new parameters.
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

    /// Converts with the given relation; `guess` is a state near the result.
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

    /// The energy of a state in either form, in the units of the file.
    ///
    /// # Errors
    /// Returns an error if the state has no velocities or momenta that the energy needs.
    pub fn energy(&self, state: &State, parameters: &[f64]) -> Result<f64, MotionError> {
        let native = self.convert(state, self.form(), parameters)?;
        Ok(self.energy_of(&native, parameters)?.high)
    }

    /// The same state in the system's native form, near a state that already has it: on the same
    /// branch, if several velocities belong to the momenta.
    ///
    /// # Errors
    /// Returns an error if the state has no such form near the other.
    pub fn convert_near(
        &self,
        state: &State,
        near: &State,
        parameters: &[f64],
    ) -> Result<State, MotionError> {
        let mut legendre = self.legendre(&self.inputs(parameters));
        self.convert_by(&mut legendre, state, self.form(), Some(near))
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
