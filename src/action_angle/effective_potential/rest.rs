//! The state in which a coordinate rests at a place.
//!
//! In: a place. Out: the start, or its momentum alone, which in most systems is zero; whether the energy is greatest there.
//! Never here: that energy.

use super::EffectivePotential;
use crate::ensemble::Start;
use crate::system::{ChannelKind, Form, InitialOverride, MotionError};

/// Secants to a momentum of rest.
const SECANTS: usize = 30;

/// How far beside a momentum of rest the velocities are evaluated: of that momentum, and beside zero.
const BESIDE: f64 = 1e-4;
const BESIDE_ZERO: f64 = 1e-6;

impl EffectivePotential<'_> {
    /// The start with the coordinate at rest at a place.
    pub fn at_rest(&mut self, place: f64) -> Start {
        let mut start = self.base.clone();
        start.replace(InitialOverride::Position(self.coordinate, place));
        if self.system.form() == Form::Momentum {
            // in most systems rest is where the momentum vanishes, and no velocity has to be solved for
            start.replace(InitialOverride::Momentum(self.coordinate, 0.0));
            let velocity = self.observed(&start, ChannelKind::Velocity(self.coordinate));
            if velocity.is_ok_and(|velocity| velocity == 0.0) {
                return start;
            }
            self.rest_elsewhere = Some(self.rest_elsewhere.unwrap_or(0.0));
        }
        start.replace(InitialOverride::Velocity(self.coordinate, 0.0));
        start
    }

    /// The momentum with which the coordinate rests at a place, or the velocity where that is given.
    pub(super) fn resting(&mut self, place: f64) -> Result<f64, MotionError> {
        let momentum = ChannelKind::Momentum(self.coordinate);
        let Some(last) = self.rest_elsewhere else { return Ok(0.0) };
        let found = match self.secant(place, last)? {
            Some(found) => found,
            None => {
                let rest = self.at_rest(place);
                self.observed(&rest, momentum)?
            }
        };
        self.rest_elsewhere = Some(found);
        Ok(found)
    }

    /// The momentum of rest at a place if the energy is greatest there among all momenta near it: an effective potential is the
    /// least energy of each place. With q̇ = ∂H/∂p the velocity is then against p on both sides, whose sign is exact.
    pub(super) fn greatest_at_rest(&mut self, place: f64) -> Result<Option<f64>, MotionError> {
        let start = self.at_rest(place);
        let rest = self.observed(&start, self.momentum())?;
        let step = if rest == 0.0 { BESIDE_ZERO } else { BESIDE * rest.abs() };
        let below = self.velocity_at(place, rest - step)?;
        let above = self.velocity_at(place, rest + step)?;
        Ok((below > 0.0 && above < 0.0).then_some(rest))
    }

    /// The zero of the velocity as a function of the momentum, by secants from one that is near and from zero.
    fn secant(&mut self, place: f64, near: f64) -> Result<Option<f64>, MotionError> {
        let mut before = [0.0, self.velocity_at(place, 0.0)?];
        let mut here = [near, self.velocity_at(place, near)?];
        for _ in 0..SECANTS {
            if here[1] == 0.0 {
                return Ok(Some(here[0]));
            }
            let next = here[0] - here[1] * (here[0] - before[0]) / (here[1] - before[1]);
            if !next.is_finite() {
                return Ok(None);
            }
            if (next - here[0]).abs() <= f64::EPSILON * next.abs() {
                return Ok(Some(next));
            }
            (before, here) = (here, [next, self.velocity_at(place, next)?]);
        }
        Ok(None)
    }

    fn velocity_at(&mut self, place: f64, momentum: f64) -> Result<f64, MotionError> {
        let mut start = self.base.clone();
        start.replace(InitialOverride::Position(self.coordinate, place));
        start.replace(InitialOverride::Momentum(self.coordinate, momentum));
        self.observed(&start, ChannelKind::Velocity(self.coordinate))
    }
}
