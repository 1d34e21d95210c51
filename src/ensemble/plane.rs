//! A plane of section: two quantities of a motion, where it crosses a surface.
//!
//! In: a surface of a model, two channels, the energy of the motion. Out: for a point of the plane the start whose orbit
//! passes it, completed by the surface and the energy, or why there is none. Never here: orbits, what is drawn.
//!
//! On a surface that fixes one coordinate an autonomous system of two degrees of freedom has two numbers left beside the
//! two of the plane: the coordinate, from the surface, and a rate, from the energy (M. Hénon and C. Heiles, Astronomical
//! Journal 69, 73 (1964)). On a stroboscope, a surface of the time alone, a system of one degree of freedom has none.

use super::{EnergyShell, NotInPlane, PhaseShift, Root, Start};
use crate::model::{Direction, Model};
use crate::system::{ChannelKind, InitialOverride, MotionError, Observer, System};

/// A plane of section at one energy and one set of parameters.
#[derive(Clone, PartialEq, Debug)]
pub struct SectionPlane {
    /// The two numbers that a point gives.
    axes: [ChannelKind; 2],
    surface: SurfaceCondition,
    direction: Direction,
    time: f64,
    parameters: Vec<f64>,
}

#[derive(Clone, PartialEq, Debug)]
enum SurfaceCondition {
    /// A coordinate; the energy fixes the rate that is left.
    Place {
        coordinate: usize,
        value: f64,
        /// Whether the expression of the surface grows with it.
        grows: bool,
        /// The rate that completes a start.
        solved: InitialOverride,
        energy: f64,
    },
    /// Only the time.
    Stroboscope {
        /// Whether the initial values lie on it.
        begins: bool,
    },
}

/// The largest value of a surface's expression, relative to its change over a period, at which it counts as zero.
const ON: f64 = 1e-9;

/// Corrections of a root by Newton's method.
const CORRECTIONS: u32 = 60;

impl SectionPlane {
    /// The plane of two channels on a surface of the model, for starts at a time, if its points are starts: if the
    /// surface fixes one coordinate, or only the time, and all numbers of the state follow.
    pub fn new(
        (model, system): (&Model, &System),
        section: usize,
        axes: [usize; 2],
        (time, parameters, energy): (f64, &[f64], f64),
    ) -> Option<SectionPlane> {
        let event = model.sections.get(section)?;
        let axes = [system.channels().get(axes[0])?.kind, system.channels().get(axes[1])?.kind];
        let degrees = model.coordinates.len();
        if model.is_poisson() || !model.constraints.is_empty() {
            return None;
        }
        let mut free: Vec<(usize, bool)> =
            (0..degrees).flat_map(|i| [(i, false), (i, true)]).collect();
        for axis in axes {
            let slot = slot(axis)?;
            let place = free.iter().position(|other| *other == slot)?;
            free.remove(place);
        }
        let symbols = model.pool.symbols_of(event.when);
        let fixed: Vec<usize> =
            (0..degrees).filter(|&i| symbols.contains(&model.coordinates[i].position)).collect();
        let known = |coordinate: Option<(usize, f64)>, time: f64| {
            let value = |symbol| {
                if symbol == model.symbols.time {
                    return time;
                }
                if let Some((i, value)) = coordinate
                    && symbol == model.coordinates[i].position
                {
                    return value;
                }
                let place = model.parameters.iter().position(|p| p.symbol == symbol);
                place.and_then(|i| parameters.get(i).copied()).unwrap_or(f64::NAN)
            };
            model.pool.evaluate(event.when, &value)
        };
        let driven = symbols.contains(&model.symbols.time);
        let surface = match (fixed[..].first(), driven) {
            (None, true) if free.is_empty() => {
                let at = known(None, time);
                let width = 1e-6 * time.abs().max(1.0);
                let rises = known(None, time + width) > known(None, time - width);
                let wanted = match event.direction {
                    Direction::Either => true,
                    Direction::Rising => rises,
                    Direction::Falling => !rises,
                };
                SurfaceCondition::Stroboscope { begins: at.abs() <= ON && wanted }
            }
            (Some(&coordinate), false) if fixed.len() == 1 => {
                let place = free.iter().position(|slot| *slot == (coordinate, false))?;
                free.remove(place);
                let [(rate, true)] = free[..] else { return None };
                let value = root(|x| known(Some((coordinate, x)), time))?;
                let width = 1e-6 * value.abs().max(1.0);
                let [below, above] =
                    [value - width, value + width].map(|x| known(Some((coordinate, x)), time));
                let solved = if model.is_lagrangian() {
                    InitialOverride::Velocity(rate, 0.0)
                } else {
                    InitialOverride::Momentum(rate, 0.0)
                };
                SurfaceCondition::Place { coordinate, value, grows: above > below, solved, energy }
            }
            _ => return None,
        };
        let parameters = parameters.to_vec();
        Some(SectionPlane { axes, surface, direction: event.direction, time, parameters })
    }

    /// Whether the energy bounds the plane.
    pub fn is_bounded(&self) -> bool {
        matches!(self.surface, SurfaceCondition::Place { .. })
    }

    /// The values that the plane is at, in the order of the model.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// Whether the energy allows a motion through a point, in either direction.
    pub fn is_accessible(&self, system: &System, observer: &mut Observer, at: [f64; 2]) -> bool {
        let start = self.given(at);
        match self.surface {
            SurfaceCondition::Place { solved, energy, .. } => {
                let root = Root::Positive;
                let shell = EnergyShell { energy, by: solved, root, about: 0.0 };
                shell.allows(system, observer, &start)
            }
            SurfaceCondition::Stroboscope { .. } => start.state(system).is_ok(),
        }
    }

    /// Whether initial values at a point of the plane lie at another phase than its points do, and need a [`PhaseShift`].
    pub fn is_at_another_phase(&self) -> bool {
        matches!(self.surface, SurfaceCondition::Stroboscope { begins: false })
    }

    /// The start whose orbit begins at a point of the plane; of a stroboscope its initial values, at whatever phase.
    ///
    /// # Errors
    /// Returns an error if the energy forbids the point, or if no motion crosses there in the direction shown.
    pub fn start(
        &self,
        system: &System,
        observer: &mut Observer,
        at: [f64; 2],
    ) -> Result<Start, NotInPlane> {
        let given = self.given(at);
        let SurfaceCondition::Place { coordinate, grows, solved, energy, .. } = self.surface else {
            given.state(system)?;
            return Ok(given);
        };
        for root in [Root::Positive, Root::Negative] {
            let mut start = given.clone();
            let shell = EnergyShell { energy, by: solved, root, about: 0.0 };
            shell.complete_by(system, observer, &mut start)?;
            let rising = (velocity(system, observer, &start, coordinate)? >= 0.0) == grows;
            let wanted = match self.direction {
                Direction::Either => true,
                Direction::Rising => rising,
                Direction::Falling => !rising,
            };
            if wanted {
                return Ok(start);
            }
        }
        Err(NotInPlane::OtherDirection)
    }

    /// The start of a motion that passes a point of the picture: at once, or at the first instant of a stroboscope, from which
    /// the point was carried back.
    ///
    /// # Errors
    /// Returns the errors of [`SectionPlane::start`] and [`PhaseShift::back`], or an error if a shift is needed and not given.
    pub fn through(
        &self,
        system: &System,
        observer: &mut Observer,
        (at, shift): ([f64; 2], Option<&PhaseShift>),
    ) -> Result<Start, NotInPlane> {
        let start = self.start(system, observer, at)?;
        match shift {
            _ if !self.is_at_another_phase() => Ok(start),
            Some(shift) => shift.back(system, &start),
            None => Err(NotInPlane::OtherPhase(self.time)),
        }
    }

    /// A start without the rate that the energy determines.
    fn given(&self, at: [f64; 2]) -> Start {
        let mut overrides = Vec::new();
        if let SurfaceCondition::Place { coordinate, value, .. } = self.surface {
            overrides.push(InitialOverride::Position(coordinate, value));
        }
        for (kind, value) in self.axes.into_iter().zip(at) {
            overrides.extend(match kind {
                ChannelKind::Position(i) => Some(InitialOverride::Position(i, value)),
                ChannelKind::Velocity(i) => Some(InitialOverride::Velocity(i, value)),
                ChannelKind::Momentum(i) => Some(InitialOverride::Momentum(i, value)),
                _ => None,
            });
        }
        Start { time: self.time, parameters: self.parameters.clone(), overrides }
    }
}

fn velocity(
    system: &System,
    observer: &mut Observer,
    start: &Start,
    coordinate: usize,
) -> Result<f64, MotionError> {
    let kind = ChannelKind::Velocity(coordinate);
    let place = system.channels().iter().position(|channel| channel.kind == kind);
    let mut values = vec![f64::NAN; system.columns()];
    observer.observe_columns(&start.state(system)?, &mut values)?;
    Ok(place.and_then(|place| values.get(place).copied()).unwrap_or(f64::NAN))
}

/// The coordinate that a number of the state belongs to, and whether it is a rate.
fn slot(kind: ChannelKind) -> Option<(usize, bool)> {
    match kind {
        ChannelKind::Position(i) => Some((i, false)),
        ChannelKind::Velocity(i) | ChannelKind::Momentum(i) => Some((i, true)),
        _ => None,
    }
}

/// The root of a function next to zero, by Newton's method with the slopes of secants. Unlike `num::newton` it says where
/// there is none.
fn root(function: impl Fn(f64) -> f64) -> Option<f64> {
    let mut x = 0.0_f64;
    for _ in 0..CORRECTIONS {
        let value = function(x);
        if value == 0.0 {
            return Some(x);
        }
        let width = 1e-6 * x.abs().max(1.0);
        let slope = (function(x + width) - function(x - width)) / (2.0 * width);
        let next = x - value / slope;
        if !next.is_finite() {
            return None;
        }
        if (next - x).abs() <= 4.0 * f64::EPSILON * x.abs() {
            return Some(next);
        }
        x = next;
    }
    (function(x).abs() <= ON).then_some(x)
}
