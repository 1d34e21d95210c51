//! Rates of change of states as plain numbers, for every method but the Taylor series.

use std::sync::Arc;

use super::kink_sides::KinkSides;
use super::legendre::{Legendre, LegendreError};
use super::program::Program;
use super::rates_list::RatesList;
use super::separability::NotSeparable;
use super::value::Evaluator;
use super::{Form, MotionError, State, System};
use crate::num::DoubleDouble;

/// The rate of change of every number of a state, as a function of time and these numbers. It owns
/// its registers.
#[derive(Clone, Debug)]
pub struct Rates {
    system: System,
    form: Form,
    /// The index in a state of each output.
    pub(super) places: Vec<usize>,
    pub(super) program: Arc<Program>,
    pub(super) values: Evaluator<f64>,
    /// The same program as a list, once parameters are set, unless it is none.
    list: Option<Box<RatesList<f64>>>,
    is_lowered: bool,
    /// Whether the last evaluation was by the list.
    by_list: bool,
    /// Finds the velocities, if the program needs them and the state has momenta.
    solver: Option<Solver>,
}

/// Finds the velocities of a state (q, p), starting from those of the state before.
#[derive(Clone, Debug)]
struct Solver {
    legendre: Legendre,
    /// The last solution (q, q̇).
    native: Vec<DoubleDouble>,
    /// Whether that solution belongs to the current motion, whose velocities must change
    /// continuously.
    under_way: bool,
    targets: Vec<Option<DoubleDouble>>,
    rounded: Vec<f64>,
}

impl System {
    /// Returns the rates of change of states in [`System::form`].
    pub fn native_rates(&self) -> Rates {
        Rates::new(self, self.form(), 0, &self.motion().native)
    }

    /// Returns the rates of change of states (q, p): q̇ = ∂H/∂p, ṗ = −∂H/∂q + forces, through p =
    /// ∂L/∂q̇ if necessary. A Poisson system has its variables only.
    pub fn canonical_rates(&self) -> Rates {
        let (program, direct) = &self.motion().canonical;
        let form = if self.form() == Form::Variables { Form::Variables } else { Form::Momentum };
        let mut rates = Rates::new(self, form, 0, program);
        if !direct {
            let n = self.degrees();
            rates.solver = Some(Solver {
                legendre: Legendre::new(Arc::clone(&self.shared.legendre), self.form()),
                native: vec![DoubleDouble::ZERO; 2 * n],
                under_way: false,
                targets: vec![None; n],
                rounded: vec![0.0; self.driven_len()],
            });
        }
        rates
    }

    /// Whether the rates of states (q, p) are a function of these numbers, without velocities to be solved for.
    pub fn has_direct_canonical_rates(&self) -> bool {
        self.motion().canonical.1
    }

    /// Checks that H = T(p) + V(q, t) with no other forces.
    ///
    /// # Errors
    /// Returns the reason why it is not, as a sentence.
    pub fn separable(&self) -> Result<(), &str> {
        self.motion().split.as_ref().map(|_| ()).map_err(NotSeparable::why)
    }

    /// Returns the rates of change of states (q, p) under T(p) alone and under V(q, t) alone, where
    /// H = T + V.
    pub fn split_rates(&self) -> Option<(Rates, Rates)> {
        let split = self.motion().split.as_ref().ok()?;
        let drift = Rates::new(self, Form::Momentum, 0, &split.drift);
        let kick = Rates::new(self, Form::Momentum, self.degrees(), &split.kick);
        Some((drift, kick))
    }
}

impl Rates {
    /// The outputs of `program` are the rates of as many numbers of a state, from `first` on, of
    /// the same numbers of its tangent vectors, and of the integrals it carries.
    fn new(system: &System, form: Form, first: usize, program: &Arc<Program>) -> Rates {
        let (all, integrals) = (system.state_len(), system.quadratures().count());
        let tangents = system.tangents();
        // a part of a separable system moves the coordinates or the momenta
        let part = system.motion().split.as_ref().is_ok_and(|split| {
            Arc::ptr_eq(program, &split.drift) || Arc::ptr_eq(program, &split.kick)
        });
        let displaced = if part { system.degrees() } else { system.moving() };
        let moved = program.outputs() - integrals - tangents * displaced;
        let mut places: Vec<usize> = (first..first + moved).collect();
        for vector in 0..tangents {
            let place = system.tangent_place(vector) + first;
            places.extend(place..place + displaced);
        }
        places.extend(all - integrals..all);
        Rates {
            system: system.clone(),
            form,
            places,
            values: Evaluator::new(Arc::clone(program)),
            program: Arc::clone(program),
            list: None,
            is_lowered: false,
            by_list: false,
            solver: None,
        }
    }

    /// Sets the parameters. Must be called before the first evaluation.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        let parameters = self.system.inputs(parameters);
        self.values.set_parameters(&parameters);
        if !self.is_lowered {
            self.is_lowered = true;
            self.list = RatesList::new(self.outputs(), self.system.state_len()).map(Box::new);
        }
        if let Some(list) = &mut self.list {
            list.set_parameters(&self.values);
        }
        if let Some(solver) = &mut self.solver {
            solver.legendre.set_parameters(&parameters);
            solver.under_way = false;
        }
    }

    /// Chooses the branch of these velocities if the momenta alone do not determine them. Has no effect in another form.
    pub fn begin_near(&mut self, state: &State) {
        if let Some(solver) = self.solver.as_mut().filter(|_| state.form == Form::Velocity) {
            for (i, x) in solver.native.iter_mut().enumerate() {
                *x = state.exact(i);
            }
            solver.under_way = true;
        }
    }

    /// Continues from the velocities that `other` found last.
    pub fn continue_from(&mut self, other: &Rates) {
        if let (Some(own), Some(other)) = (&mut self.solver, &other.solver) {
            own.native.clone_from(&other.native);
            own.under_way = other.under_way;
        }
    }

    /// The form of the states.
    pub fn form(&self) -> Form {
        self.form
    }

    /// The program, and the index in a state of each of its outputs.
    pub(super) fn outputs(&self) -> (&Arc<Program>, &[usize]) {
        (&self.program, &self.places)
    }

    /// Whether they are a function of the numbers of a state alone, without velocities to be solved for.
    pub(super) fn is_direct(&self) -> bool {
        self.solver.is_none()
    }

    /// The system whose rates these are.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// On which side of each kink the rates were last evaluated.
    pub fn sides(&mut self) -> KinkSides {
        if let (true, Some(list)) = (std::mem::take(&mut self.by_list), &mut self.list) {
            let numbers: Vec<f64> = (0..self.program.inputs()).map(|i| *list.number(i)).collect();
            let outcome = self.values.evaluate(list.time(), &numbers);
            // an error would be a singular matrix, where the list has no finite rates
            debug_assert!(outcome.is_ok(), "the list found finite rates there");
        }
        self.values.sides()
    }

    /// Writes the rates at a time and at the numbers of a state into `out`; the entries of numbers
    /// that do not move are left unchanged.
    ///
    /// # Errors
    /// Returns an error if the mass matrix is singular there, or no velocities belong to the momenta.
    pub fn evaluate(
        &mut self,
        time: f64,
        numbers: &[f64],
        out: &mut [f64],
    ) -> Result<(), MotionError> {
        let numbers = &numbers[..self.system.driven_len()];
        let inputs = match &mut self.solver {
            None => numbers,
            Some(solver) => {
                let outcome = solver.solve(time, numbers);
                outcome.map_err(|why| self.system.unsolved(why, time, &solver.native))?;
                let moving = solver.native.len();
                solver.rounded[moving..].copy_from_slice(&numbers[moving..]);
                &solver.rounded
            }
        };
        self.by_list = match &mut self.list {
            Some(list) if list.suits() => evaluate_by(list, time, inputs, &self.places, out),
            _ => false,
        };
        if self.by_list {
            return Ok(());
        }
        self.values
            .evaluate(time, inputs)
            .map_err(|singular| self.system.singular(&self.program, singular, time, numbers))?;
        for (i, &place) in self.places.iter().enumerate() {
            out[place] = self.values.output(i);
        }
        Ok(())
    }
}

/// Writes the rates of a list into `out`. Returns false where one of them is not finite.
fn evaluate_by(
    list: &mut RatesList<f64>,
    time: f64,
    numbers: &[f64],
    places: &[usize],
    out: &mut [f64],
) -> bool {
    for (i, &x) in numbers.iter().enumerate() {
        *list.number(i) = x;
    }
    list.set_time(time);
    list.evaluate();
    let mut is_finite = true;
    for (&place, &rate) in places.iter().zip(list.rates()) {
        is_finite &= rate.is_finite();
        out[place] = rate;
    }
    is_finite
}

impl Solver {
    fn solve(&mut self, time: f64, numbers: &[f64]) -> Result<(), LegendreError> {
        let n = self.targets.len();
        for i in 0..n {
            self.native[i] = DoubleDouble::from(numbers[i]);
            self.targets[i] = Some(DoubleDouble::from(numbers[n + i]));
        }
        let (time, native) = (DoubleDouble::from(time), &mut self.native);
        if self.under_way {
            self.legendre.follow(time, native, &self.targets)?;
        } else {
            self.legendre.solve(time, native, &self.targets)?;
            self.under_way = true;
        }
        for (rounded, x) in self.rounded.iter_mut().zip(&self.native) {
            *rounded = x.high;
        }
        Ok(())
    }
}
