//! A system with tangent vectors: small displacements of its state, carried along its motion by
//! the variational equations δẋ = (∂f/∂x) δx.
//!
//! In: a compiled system. Out: the same system whose states carry tangent vectors behind their
//! auxiliary numbers, which no motion depends on. Every method works on it unchanged; under a
//! method of fixed step the tangent vectors are those of the method's own map. Never here: which
//! vectors to carry, and what they tell.
//!
//! A tangent vector has the form of its state: (δq, δq̇), (δq, δp), or the variables of brackets.

use std::ops::Range;
use std::sync::Arc;

use super::compiled::System;
use super::machine_code::CodeCache;
use super::program::Program;
use super::rhs::{MotionPrograms, SplitHamiltonian, Tangents};
use super::separability::NotSeparable;
use super::solve::Factored;
use super::tangent::TangentLayout;
use super::value::Evaluator;
use super::{Form, MotionError, State};
use crate::num::DoubleDouble;

impl System {
    /// The same system with `count` tangent vectors in each state, none for zero.
    #[must_use]
    pub fn with_tangents(&self, count: usize) -> System {
        let plain = self.without_tangents();
        if count == 0 {
            return plain;
        }
        let tangents = self.shared.variations.of(count, || plain.variation(count));
        plain.carrying(Some(tangents))
    }

    /// The programs with `count` tangent vectors, of a system without any.
    fn variation(&self, count: usize) -> Tangents {
        let (moving, first, last) = (self.moving(), self.motion_len(), self.quadratures().count());
        let of = |program: &Program, outputs: usize| {
            program.tangent(TangentLayout { count, moving, first, outputs, last })
        };
        let motion = self.motion();
        let degrees = self.degrees();
        let split = motion.split.as_ref().map_err(NotSeparable::clone).map(|split| {
            SplitHamiltonian { drift: of(&split.drift, degrees), kick: of(&split.kick, degrees) }
        });
        let (canonical, direct) = &motion.canonical;
        let legendre = &self.shared.legendre;
        let outputs = if self.form() == Form::Variables { 0 } else { degrees };
        let layout = TangentLayout { count: 1, moving, first: moving, outputs, last: 0 };
        Tangents {
            count,
            motion: MotionPrograms {
                native: of(&motion.native, moving),
                code: CodeCache::new(),
                canonical: (of(canonical, moving), *direct),
                split,
            },
            legendre: legendre.tangent(layout),
        }
    }

    /// The same system without tangent vectors.
    #[must_use]
    pub fn without_tangents(&self) -> System {
        self.carrying(None)
    }

    /// The number of tangent vectors in each state.
    pub fn tangents(&self) -> usize {
        self.variational().map_or(0, |tangents| tangents.count)
    }

    /// The index in a state of the first component of a tangent vector.
    pub fn tangent_place(&self, vector: usize) -> usize {
        self.motion_len() + vector * self.moving()
    }

    /// A state of this system with the numbers of `state`, a state of the same system with any
    /// number of tangent vectors. Tangent vectors that it does not have are zero.
    #[must_use]
    pub fn extended(&self, state: &State, of: &System) -> State {
        let mut out = state.clone();
        out.values = vec![0.0; self.state_len()];
        out.carry = vec![0.0; self.state_len()];
        let tangents = self.tangents().min(of.tangents()) * self.moving();
        for i in 0..self.motion_len() + tangents {
            out.set(i, state.exact(i));
        }
        for i in 0..self.quadratures().count() {
            out.set(self.driven_len() + i, state.exact(of.driven_len() + i));
        }
        out
    }

    /// Whether the tangent vectors of a state can be converted between velocities and momenta at
    /// every step, as a method that works in the other form requires.
    pub fn has_tangents_in(&self, form: Form) -> bool {
        form == self.form() || !self.has_branches()
    }

    /// Converts the tangent vectors of `from`, whose form is another, into `to`, which is the same
    /// motion: δp = (∂p/∂q) δq + (∂p/∂q̇) δq̇, and back.
    pub(super) fn convert_tangents(
        &self,
        from: &State,
        to: &mut State,
        parameters: &[f64],
    ) -> Result<(), MotionError> {
        if from.form == to.form {
            return Ok(());
        }
        let Some(mut conversion) = self.tangent_conversion(parameters) else { return Ok(()) };
        conversion.convert(self, from, to, 0..self.tangents())
    }

    /// How tangent vectors are converted at these parameters, if there are any.
    pub(super) fn tangent_conversion(&self, parameters: &[f64]) -> Option<TangentConversion> {
        let tangents = self.variational()?;
        let mut values: Evaluator<DoubleDouble> = Evaluator::new(Arc::clone(&tangents.legendre));
        values.set_parameters(&self.inputs(parameters));
        Some(TangentConversion { values, numbers: Vec::new() })
    }
}

/// The conversion of tangent vectors between velocities and momenta.
pub(super) struct TangentConversion {
    values: Evaluator<DoubleDouble>,
    numbers: Vec<DoubleDouble>,
}

impl TangentConversion {
    /// Converts some of the vectors of `from` into `to`, the same motion in another form.
    pub(super) fn convert(
        &mut self,
        system: &System,
        from: &State,
        to: &mut State,
        vectors: Range<usize>,
    ) -> Result<(), MotionError> {
        let Some(tangents) = system.variational() else { return Ok(()) };
        let TangentConversion { values, numbers } = self;
        let (n, time) = (system.degrees(), from.exact_time());
        let forwards = from.form == system.form();
        let native = if forwards { from } else { &*to };
        numbers.clear();
        numbers.extend((0..2 * n).map(|i| native.exact(i)));
        numbers.resize(4 * n, DoubleDouble::ZERO);
        let mut factored = Factored::new(if forwards { 0 } else { n });
        for vector in vectors {
            let first = system.tangent_place(vector);
            for i in 0..n {
                numbers[2 * n + i] = from.exact(first + i);
                let rate = if forwards { from.exact(first + n + i) } else { DoubleDouble::ZERO };
                numbers[3 * n + i] = rate;
            }
            let outcome = values.evaluate(time, numbers);
            let fail = |why| {
                let values: Vec<f64> = numbers.iter().map(|x| x.high).collect();
                system.singular(&tangents.legendre, why, from.time, &values)
            };
            outcome.map_err(fail)?;
            let along = |i: usize| values.output(n + n * n + i);
            if forwards {
                for i in 0..n {
                    to.set(first + n + i, along(i));
                }
                continue;
            }
            let mut rates: Vec<DoubleDouble> = (0..n).map(along).collect();
            if !factored.factor(|i, j| values.output(n + i * n + j)) {
                return Err(system.error(system.without_momenta(), from.time, &from.values));
            }
            for (i, rate) in rates.iter_mut().enumerate() {
                *rate = from.exact(first + n + i) - *rate;
            }
            factored.solve(&mut rates);
            for (i, &rate) in rates.iter().enumerate() {
                to.set(first + n + i, rate);
            }
        }
        Ok(())
    }
}
