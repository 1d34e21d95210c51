//! One coordinate of a system that conserves its energy, with the other coordinates as they are at the start: the least
//! energy at each place, where the motion of the coordinate turns, and the tops that separate its kinds of motion.
//!
//! In: a system, a start, a coordinate. Out: regions and tops at an energy. Never here: times, actions.

mod profile;
mod regions;
mod rest;
mod sampling;

use crate::ensemble::{EnergyShell, NotOnShell, Root, Start};
use crate::system::{ChannelKind, Form, InitialOverride, MotionError, Observer, System};
pub use profile::{AllowedInterval, PotentialProfile};

/// One coordinate as a system of its own.
pub struct EffectivePotential<'a> {
    system: &'a System,
    base: Start,
    coordinate: usize,
    observer: Observer,
    values: Vec<f64>,
    /// What was seen of it.
    pub profile: PotentialProfile,
    /// The momentum of rest at the last place, where that is not zero everywhere, as with terms odd in p.
    rest_elsewhere: Option<f64>,
    /// Where the coordinate begins, with its momentum of rest, if the energy is greatest there.
    greatest: Option<[f64; 2]>,
}

impl<'a> EffectivePotential<'a> {
    /// Surveys a coordinate.
    ///
    /// # Errors
    /// Returns an error if there is no state at the start.
    pub fn survey(
        system: &'a System,
        start: &Start,
        coordinate: usize,
    ) -> Result<EffectivePotential<'a>, MotionError> {
        let mut observer = system.observer(&start.parameters);
        let mut values = vec![0.0; system.columns()];
        observer.observe_columns(&start.state(system)?, &mut values)?;
        let mut base = start.clone();
        // the other coordinates keep their places and momenta, of which those of cyclic ones are constant
        for i in (0..system.degrees()).filter(|&i| i != coordinate) {
            let momentum = values[column(system, ChannelKind::Momentum(i))];
            base.replace(InitialOverride::Momentum(i, momentum));
        }
        let place = column(system, ChannelKind::Position(coordinate));
        let period = system.period(place, &start.parameters);
        let at = values[place];
        let mut potential = EffectivePotential {
            system,
            base,
            coordinate,
            observer,
            values,
            profile: PotentialProfile::unseen(at, period),
            rest_elsewhere: None,
            greatest: None,
        };
        // a velocity without a value is no reason to refuse anything
        let greatest = potential.greatest_at_rest(at).ok().flatten();
        potential.greatest = greatest.map(|rest| [at, rest]);
        potential.sample();
        Ok(potential)
    }

    /// The period of the coordinate.
    pub fn period(&self) -> Option<f64> {
        self.profile.period
    }

    /// Where the coordinate begins, and its momentum of rest there, if that has the greatest energy and not the least: then the
    /// energies at rest are no effective potential.
    pub fn greatest(&self) -> Option<[f64; 2]> {
        self.greatest
    }

    /// The energy with the coordinate at rest; infinite where there is none.
    pub fn at(&mut self, place: f64) -> f64 {
        let energy = match self.rest_elsewhere {
            Some(_) => self.resting(place).and_then(|momentum| {
                let mut start = self.base.clone();
                start.replace(InitialOverride::Position(self.coordinate, place));
                start.replace(InitialOverride::Momentum(self.coordinate, momentum));
                self.observed(&start, ChannelKind::Energy)
            }),
            None => {
                let start = self.at_rest(place);
                self.observed(&start, ChannelKind::Energy)
            }
        };
        energy.ok().filter(|energy| !energy.is_nan()).unwrap_or(f64::INFINITY)
    }

    pub(super) fn momentum(&self) -> ChannelKind {
        ChannelKind::Momentum(self.coordinate)
    }

    pub(super) fn velocity(&mut self, start: &Start) -> Result<f64, MotionError> {
        self.observed(start, ChannelKind::Velocity(self.coordinate))
    }

    pub(super) fn observed(
        &mut self,
        start: &Start,
        kind: ChannelKind,
    ) -> Result<f64, MotionError> {
        let state = start.state(self.system)?;
        self.observer.observe_columns(&state, &mut self.values)?;
        Ok(self.values[column(self.system, kind)])
    }

    /// The start that moves through a place with this energy, to the right or to the left.
    ///
    /// # Errors
    /// Returns an error if the energy forbids the place.
    pub fn moving(&mut self, place: f64, energy: f64, root: Root) -> Result<Start, NotOnShell> {
        let about = self.resting(place)?;
        self.moving_about(about, place, energy, root)
    }

    fn moving_about(
        &mut self,
        about: f64,
        place: f64,
        energy: f64,
        root: Root,
    ) -> Result<Start, NotOnShell> {
        let mut start = self.base.clone();
        start.replace(InitialOverride::Position(self.coordinate, place));
        let by = match self.system.form() {
            Form::Momentum => InitialOverride::Momentum(self.coordinate, 0.0),
            Form::Velocity | Form::Variables => InitialOverride::Velocity(self.coordinate, 0.0),
        };
        EnergyShell { energy, by, root, about }.complete_by(
            self.system,
            &mut self.observer,
            &mut start,
        )?;
        Ok(start)
    }

    /// |q̇| through a place with this energy.
    pub(super) fn speed(&mut self, place: f64, energy: f64, root: Root) -> Result<f64, NotOnShell> {
        let start = self.moving(place, energy, root)?;
        Ok(self.observed(&start, ChannelKind::Velocity(self.coordinate))?.abs())
    }

    /// p to the right less p to the left at a place, zero where the energy forbids it by rounding.
    pub(super) fn width(&mut self, place: f64, energy: f64) -> Result<f64, NotOnShell> {
        let right = self.momentum_at(place, energy, Root::Positive)?;
        let left = self.momentum_at(place, energy, Root::Negative)?;
        Ok(right.zip(left).map_or(0.0, |(right, left)| right - left))
    }

    /// p to the right or to the left at a place, `None` where the energy forbids it by rounding.
    pub(super) fn momentum_at(
        &mut self,
        place: f64,
        energy: f64,
        root: Root,
    ) -> Result<Option<f64>, NotOnShell> {
        match self.moving(place, energy, root) {
            Ok(start) => Ok(Some(self.observed(&start, ChannelKind::Momentum(self.coordinate))?)),
            Err(NotOnShell::Forbidden { .. } | NotOnShell::NotFound { .. }) => Ok(None),
            Err(why) => Err(why),
        }
    }
}

fn column(system: &System, kind: ChannelKind) -> usize {
    system.channels().iter().position(|channel| channel.kind == kind).unwrap_or(0)
}
