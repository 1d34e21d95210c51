//! A start completed to a given energy by one of its velocities or momenta.
//!
//! In: a start without that number, the energy, the sign of the root. Out: the number, or why there is none. Never
//! here: the other numbers, which stay as they are.
//!
//! The energy as a function of one rate v is a quadratic a v² + b v + c for every system whose L or H is quadratic in
//! the rates. It is measured at three places, tested at two more, solved, and the root corrected by Newton's method on
//! the energy itself. Where it is not a quadratic (a relativistic particle) the root is bracketed from where the energy
//! is extremal outwards and bisected.

use super::Start;
use crate::num::{false_position, short};
use crate::system::{ChannelKind, InitialOverride, MotionError, MotionErrorKind, Observer, System};

/// Which of the two roots completes a start.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Root {
    /// The one with the positive square root.
    Positive,
    /// The one with the negative square root.
    Negative,
}

/// The energy of all starts, and the number that follows from it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct EnergyShell {
    /// Jacobi's h, or H.
    pub energy: f64,
    /// The velocity or momentum that completes a start; its value does not matter.
    pub by: InitialOverride,
    /// Which root it is.
    pub root: Root,
    /// Where an energy that is no quadratic is least, or greatest: its roots lie on both sides.
    pub about: f64,
}

/// Why a start cannot be completed.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum NotOnShell {
    /// No real value has that energy.
    #[error(
        "the start lies outside the region that the energy {} allows: whatever {by} is, the energy is {side} {} there", short(*.energy), short(*.bound)
    )]
    Forbidden {
        /// The energy asked for.
        energy: f64,
        /// The number that was to complete it.
        by: String,
        /// `at least` or `at most`.
        side: &'static str,
        /// The extremal energy at this place.
        bound: f64,
    },
    /// The energy does not depend on that number.
    #[error("the energy does not depend on {0} there, which cannot complete the start")]
    Independent(String),
    /// No root was found on that side.
    #[error("no {by} on the {side} side has the energy {}", short(*.energy))]
    NotFound {
        /// The energy asked for.
        energy: f64,
        /// The number that was to complete it.
        by: String,
        /// `positive` or `negative`.
        side: &'static str,
    },
    /// There is no state to complete.
    #[error(transparent)]
    NoState(#[from] MotionError),
}

/// Corrections of a root by Newton's method.
const CORRECTIONS: u32 = 4;

/// The energies at the two places of the test agree with those of a quadratic to this part of their terms.
const QUADRATIC: f64 = 1e-11;

/// Doublings outwards and secants inwards of a root that is not that of a quadratic.
const DOUBLINGS: u32 = 200;
const ROUNDS: u32 = 200;

/// Sections by the golden ratio in the search for the least distance from an energy.
const SECTIONS: u32 = 60;

/// The smallest value evaluated, relative to one.
const INNERMOST: f64 = 1e-30;

/// Where the energy has changed by less than this part of what is missing, the next value is as many times farther out.
const FLAT: f64 = 1e-6;
const FAR: f64 = 32.0;

/// Between values as near as this Newton's method finds the last digits.
const CLOSE: f64 = 1e-14;

impl EnergyShell {
    /// Completes a start.
    ///
    /// # Errors
    /// Returns an error if the energy forbids the place, or if the number does not determine the energy.
    pub fn complete(&self, system: &System, start: &mut Start) -> Result<(), NotOnShell> {
        let mut observer = system.observer(&start.parameters);
        self.complete_by(system, &mut observer, start)
    }

    /// The same with an observer of the system at the parameters of the start.
    ///
    /// # Errors
    /// Returns the errors of [`EnergyShell::complete`].
    pub fn complete_by(
        &self,
        system: &System,
        observer: &mut Observer,
        start: &mut Start,
    ) -> Result<(), NotOnShell> {
        let mut energies =
            Energies { system, observer, values: vec![0.0; system.columns()], start, by: self.by };
        let name = energies.name();
        let rate = match energies.quadratic() {
            Some([a, b, c]) => self.root_of([a, b, c - self.energy], &name)?,
            None => self.bracketed(&mut energies, &name)?,
        };
        let rate = self.corrected(&mut energies, rate)?;
        start.replace(self.by.with_value(rate));
        Ok(())
    }

    /// Whether some value of the number gives a start this energy.
    pub fn allows(&self, system: &System, observer: &mut Observer, start: &Start) -> bool {
        let mut energies =
            Energies { system, observer, values: vec![0.0; system.columns()], start, by: self.by };
        match energies.quadratic() {
            Some([a, b, c]) => self.root_of([a, b, c - self.energy], "").is_ok(),
            None => self.bracketed(&mut energies, "").is_ok(),
        }
    }

    /// The root of a v² + b v + c, without cancellation: Press et al., Numerical Recipes, §5.6.
    fn root_of(&self, [a, b, c]: [f64; 3], by: &str) -> Result<f64, NotOnShell> {
        if a == 0.0 && b == 0.0 {
            return Err(NotOnShell::Independent(by.to_owned()));
        }
        if a == 0.0 {
            return Ok(-c / b);
        }
        let square = b * b - 4.0 * a * c;
        // at the boundary of the region the root is the bound itself
        let rounding =
            8.0 * f64::EPSILON * (b * b + (4.0 * a * c).abs() + 4.0 * a.abs() * self.energy.abs());
        if square < -rounding {
            let bound = c + self.energy - b * b / (4.0 * a);
            let side = if a > 0.0 { "at least" } else { "at most" };
            return Err(NotOnShell::Forbidden {
                energy: self.energy,
                by: by.to_owned(),
                side,
                bound,
            });
        }
        let root = square.max(0.0).sqrt();
        let upper = (self.root == Root::Positive) == (a > 0.0);
        // the sum of two numbers of one sign has all its digits, the other root follows from the product of both
        let numerator = -b + if upper { root } else { -root };
        Ok(if (b <= 0.0) == upper || b == 0.0 {
            numerator / (2.0 * a)
        } else {
            2.0 * c / (-b - if upper { root } else { -root })
        })
    }

    /// The root next to the extremum on its side, for an energy that is no quadratic: where the energy passes what is asked for
    /// between two places, or is nearest to it between three. Where it has no value, as beyond the velocity of light, the edge is
    /// approached.
    fn bracketed(&self, energies: &mut Energies<'_>, by: &str) -> Result<f64, NotOnShell> {
        let (sign, side) = match self.root {
            Root::Positive => (1.0, "positive"),
            Root::Negative => (-1.0, "negative"),
        };
        let missing = energies.at(self.about)? - self.energy;
        if missing == 0.0 {
            return Ok(self.about);
        }
        // above zero on the side of the extremum, below behind the root
        let mut left = |v: f64| {
            energies.at(self.about + sign * v).map(|e| (e - self.energy) * missing.signum())
        };
        let mut before = [0.0, 0.0];
        let mut known = [missing.abs(); 2];
        let (mut next, mut edge) = (INNERMOST, f64::INFINITY);
        for _ in 0..DOUBLINGS {
            let found = match left(next) {
                Err(why) if why.kind == MotionErrorKind::Cancelled => return Err(why.into()),
                Ok(found) if !found.is_nan() => found,
                // next to the extremum a momentum may have too few digits beside the terms that it is the sum of
                _ if before[1] == 0.0 && edge.is_infinite() => {
                    next *= 2.0;
                    continue;
                }
                _ => {
                    edge = next;
                    next = f64::midpoint(before[1], edge);
                    if next <= before[1] || next >= edge {
                        break;
                    }
                    continue;
                }
            };
            let lowest = known[1] < known[0] && known[1] < found;
            let within = if found <= 0.0 {
                Some([(before[1], known[1]), (next, found)])
            } else if lowest {
                let behind = passed([before[0], before[1], next], &mut left)?;
                behind.map(|outer| [(before[0], known[0]), outer])
            } else {
                None
            };
            if let Some(within) = within {
                let [_, v] = false_position(within, (ROUNDS, CLOSE), &mut left)?;
                return Ok(self.about + sign * v);
            }
            // next to the extremum nothing happens
            let is_flat = (found - known[1]).abs() < FLAT * missing.abs();
            (before, known) = ([before[1], next], [known[1], found]);
            next = match edge.is_finite() {
                true => f64::midpoint(next, edge),
                false if is_flat => FAR * next,
                false => 2.0 * next,
            };
        }
        Err(NotOnShell::NotFound { energy: self.energy, by: by.to_owned(), side })
    }

    /// Corrects a root by Newton's method; the slope is that of a secant. Unlike `num::newton` it stays on its side of the
    /// extremum, and where no step leaves less.
    fn corrected(&self, energies: &mut Energies<'_>, rate: f64) -> Result<f64, NotOnShell> {
        let mut best = (rate, (energies.at(rate)? - self.energy).abs());
        let mut rate = rate;
        for _ in 0..CORRECTIONS {
            if best.1 <= f64::EPSILON * self.energy.abs() {
                break;
            }
            let missing = energies.at(rate)? - self.energy;
            let width = 1e-4 * rate.abs();
            let (Ok(above), Ok(below)) = (energies.at(rate + width), energies.at(rate - width))
            else {
                break;
            };
            let slope = (above - below) / (2.0 * width);
            let next = rate - missing / slope;
            if !next.is_finite() || (next < self.about) != (rate < self.about) {
                break;
            }
            let Ok(found) = energies.at(next) else { break };
            let distance = (found - self.energy).abs();
            if distance.is_nan() || distance >= best.1 {
                break;
            }
            (best, rate) = ((next, distance), next);
        }
        Ok(best.0)
    }
}

/// A place between the first and the last of three at which a function that is least at the middle one is not above zero, and its
/// value there.
fn passed(
    [mut low, mut middle, mut high]: [f64; 3],
    value: &mut impl FnMut(f64) -> Result<f64, MotionError>,
) -> Result<Option<(f64, f64)>, NotOnShell> {
    const GOLDEN: f64 = 0.381_966_011_250_105_1;
    let mut least = value(middle)?;
    for _ in 0..SECTIONS {
        let right = high - middle > middle - low;
        let step = GOLDEN * if right { high - middle } else { low - middle };
        let place = middle + step;
        let found = value(place)?;
        if found <= 0.0 {
            return Ok(Some((place, found)));
        }
        if found < least {
            (low, high) = if right { (middle, high) } else { (low, middle) };
            (middle, least) = (place, found);
        } else if right {
            high = place;
        } else {
            low = place;
        }
    }
    Ok(None)
}

/// The energy as a function of one number of a start.
struct Energies<'a> {
    system: &'a System,
    observer: &'a mut Observer,
    values: Vec<f64>,
    start: &'a Start,
    by: InitialOverride,
}

impl Energies<'_> {
    fn at(&mut self, rate: f64) -> Result<f64, MotionError> {
        let mut start = self.start.clone();
        start.replace(self.by.with_value(rate));
        let state = start.state(self.system)?;
        self.observer.observe_columns(&state, &mut self.values)?;
        Ok(self.values[self.energy_column()])
    }

    fn energy_column(&self) -> usize {
        let energy = |kind: ChannelKind| kind == ChannelKind::Energy;
        let place = self.system.channels().iter().position(|c| energy(c.kind));
        place.unwrap_or(0)
    }

    fn name(&self) -> String {
        let kind = match self.by {
            InitialOverride::Position(i, _) => ChannelKind::Position(i),
            InitialOverride::Velocity(i, _) => ChannelKind::Velocity(i),
            InitialOverride::Momentum(i, _) => ChannelKind::Momentum(i),
        };
        let channel = self.system.channels().iter().find(|c| c.kind == kind);
        channel.map_or_else(String::new, |channel| channel.name.clone())
    }

    /// The coefficients of v², v and 1, if the energy is a quadratic.
    fn quadratic(&mut self) -> Option<[f64; 3]> {
        if matches!(self.by, InitialOverride::Position(..)) {
            return None;
        }
        let [low, middle, high] = self.three(-1.0, 0.0, 1.0).ok()?;
        let (a, b) = (f64::midpoint(high, low) - middle, 0.5 * (high - low));
        for v in [-2.5, 3.0] {
            let found = self.at(v).ok()?;
            let terms = (a * v * v).abs() + (b * v).abs() + middle.abs();
            let missing = (a * v * v + b * v + middle - found).abs();
            if missing.is_nan() || missing > QUADRATIC * terms {
                return None;
            }
        }
        Some([a, b, middle])
    }

    fn three(&mut self, low: f64, middle: f64, high: f64) -> Result<[f64; 3], MotionError> {
        Ok([self.at(low)?, self.at(middle)?, self.at(high)?])
    }
}
