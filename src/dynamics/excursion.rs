//! How far a motion goes from where it began, and whether it comes back: what neighbours that separate show depends on it. Chaos is a
//! growth of neighbours of a motion that is bounded and keeps returning; those of one that is at rest, escapes or follows linear
//! equations may part as fast.
//!
//! In: a motion, step by step. Out: what it shows of its way. Never here: tangent vectors, verdicts.

use nalgebra::{DMatrix, DVector};

use super::error::DynamicsError;
use super::flow_direction::FlowDirection;
use super::phase_space::PhaseSpace;
use crate::num::math;
use crate::system::State;

/// The rates of a motion that escapes or comes to rest grow or fall by this power of e at least in each quarter of the time.
const QUARTERS: usize = 4;
const EACH_QUARTER: f64 = 2.0;

/// A motion of one degree of freedom that comes as near an unstable equilibrium as this part of its way is on a separatrix within
/// rounding: its energy differs by the square.
const AT_SADDLE: f64 = 3e-7;

/// The coefficients of the linearised motion are the same up to this part of the largest.
const SAME: f64 = 1e-12;

/// The way of a motion.
pub(super) struct Excursion {
    start: State,
    until: f64,
    /// The periods of the variables, and units of displacements.
    turns: Vec<Option<f64>>,
    units: DVector<f64>,
    moves: bool,
    is_autonomous: bool,
    /// The largest distance of each variable from its start, and its largest size.
    extents: Vec<f64>,
    sizes: Vec<f64>,
    /// The largest distance in units up to half of the time, and up to now.
    reach: [f64; 2],
    /// ln of the largest rate, in units, in each quarter of the time.
    speeds: [f64; QUARTERS],
    /// The coefficients of the linearised motion at the start, by how much they have differed from these, and the largest.
    first: Option<DMatrix<f64>>,
    change: f64,
    steepest: f64,
    one: Option<OneDegree>,
}

/// A motion of one degree of freedom whose energy is conserved.
#[derive(Default)]
struct OneDegree {
    forwards: Option<bool>,
    turned: u32,
    displacement: f64,
    /// Whether it has come round, or closed otherwise.
    revolved: bool,
    last: Option<f64>,
    saddle: Option<f64>,
}

/// How a motion differs from one that keeps returning.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Departure {
    /// At this time it is at rest at an unstable equilibrium, within rounding.
    Separatrix(f64),
    /// Its rates grow exponentially all the time.
    Escape,
    /// Its rates fall exponentially all the time.
    Rest,
    /// It has not come back.
    Unreturned,
}

impl Excursion {
    /// The way of a motion from a state, in these units of displacements.
    pub(super) fn begin(
        space: &PhaseSpace,
        (start, until): (&State, f64),
        units: &DVector<f64>,
        moves: bool,
    ) -> Excursion {
        let n = space.dimension();
        Excursion {
            start: start.clone(),
            until,
            turns: space.turns().to_vec(),
            units: units.clone(),
            moves,
            is_autonomous: space.is_autonomous(),
            extents: vec![0.0; n],
            sizes: space.variables(start).iter().map(|x| x.abs()).collect(),
            reach: [0.0; 2],
            speeds: [f64::NEG_INFINITY; QUARTERS],
            first: None,
            // across jumps no equations are linear
            change: if space.has_jumps() { f64::INFINITY } else { 0.0 },
            steepest: 0.0,
            one: None,
        }
    }

    /// The motion has one degree of freedom, and its energy is conserved.
    pub(super) fn of_one_degree(&mut self) {
        self.one = Some(OneDegree::default());
    }

    /// Whether each step is observed with its rates.
    pub(super) fn wants_rates(&self) -> bool {
        self.one.is_some()
    }

    /// The difference of two values of a variable, which may have a period.
    fn difference(&self, i: usize, x: f64, y: f64) -> f64 {
        let apart = x - y;
        self.turns[i].map_or(apart, |period| apart - period * (apart / period).round())
    }

    /// Observes the state after a step.
    pub(super) fn reaches(&mut self, space: &PhaseSpace, state: &State) {
        let began = space.variables(&self.start).to_vec();
        let in_first_half = state.time - self.start.time <= 0.5 * (self.until - self.start.time);
        for (i, (&x, begin)) in space.variables(state).iter().zip(began).enumerate() {
            let apart = self.difference(i, x, begin).abs();
            self.extents[i] = self.extents[i].max(apart);
            self.sizes[i] = self.sizes[i].max(x.abs());
            self.reach[1] = self.reach[1].max(apart / self.units[i]);
        }
        if in_first_half {
            self.reach[0] = self.reach[1];
        }
    }

    /// Observes the rates at a state, and the linearised motion there.
    ///
    /// # Errors
    /// Returns an error if there are none.
    pub(super) fn moves_on(
        &mut self,
        space: &PhaseSpace,
        state: &State,
        direction: &mut FlowDirection,
    ) -> Result<DVector<f64>, DynamicsError> {
        let fixed = match &self.first {
            Some(first) if self.is_autonomous => Some(first.clone()),
            _ => {
                // at the same time where the motion began
                let place = State { time: state.time, ..self.start.clone() };
                direction.at(&place).ok().and_then(|_| direction.derivative())
            }
        };
        let rates = direction.at(state)?;
        if let (Some(fixed), Some(here)) = (&fixed, direction.derivative()) {
            for ((i, j), here) in indices(&here) {
                let part = self.units[j] / self.units[i];
                self.change = self.change.max((here - fixed[(i, j)]).abs() * part);
                self.steepest = self.steepest.max(here.abs() * part);
            }
        } else {
            self.change = f64::INFINITY;
        }
        self.first = self.first.take().or(fixed);
        let speed = math::ln(rates.component_div(&self.units).norm());
        let part = (state.time - self.start.time) / (self.until - self.start.time);
        let quarter = ((part * QUARTERS as f64) as usize).min(QUARTERS - 1);
        self.speeds[quarter] = self.speeds[quarter].max(speed);
        if let Some(derivative) = direction.derivative().filter(|_| self.one.is_some()) {
            self.turns_back(space, state, (&rates, &derivative));
        }
        Ok(rates)
    }

    /// Observes a motion of one degree of freedom.
    fn turns_back(
        &mut self,
        space: &PhaseSpace,
        state: &State,
        (rates, derivative): (&DVector<f64>, &DMatrix<f64>),
    ) {
        let x = space.variables(state)[0];
        let Some(mut one) = self.one.take() else { return };
        let forwards = rates[0] > 0.0;
        one.turned += u32::from(rates[0] != 0.0 && one.forwards.is_some_and(|was| was != forwards));
        if rates[0] != 0.0 {
            one.forwards = Some(forwards);
        }
        one.displacement += one.last.map_or(0.0, |last| self.difference(0, x, last));
        one.last = Some(x);
        one.revolved |= self.turns[0].is_some_and(|period| one.displacement.abs() >= period);
        let hyperbolic = derivative.determinant() < 0.0;
        let near = |step: &DVector<f64>| {
            step.iter().zip(&self.extents).all(|(&step, &extent)| is_at_saddle(step, extent))
        };
        if hyperbolic
            && one.saddle.is_none()
            && derivative.clone().lu().solve(rates).is_some_and(|step| near(&step))
        {
            one.saddle = Some(state.time);
        }
        self.one = Some(one);
    }

    /// How the motion departs from one that keeps returning, by which the directions of its flow and of its energy have other exponents
    /// than 0.
    pub(super) fn departure(&self) -> Option<Departure> {
        let exponential = steady_change(&self.speeds).filter(|_| self.moves);
        match &self.one {
            Some(OneDegree { saddle: Some(time), .. }) if *time > self.start.time => {
                Some(Departure::Separatrix(*time))
            }
            _ if exponential.is_some() => exponential,
            Some(one) if one.turned < 2 && !one.revolved => Some(Departure::Unreturned),
            _ => None,
        }
    }

    /// The motion is known to be back where it began.
    pub(super) fn has_closed(&mut self) {
        if let Some(one) = &mut self.one {
            one.revolved = true;
        }
    }

    /// Whether it stays where it is.
    pub(super) fn rests(&self) -> bool {
        self.is_autonomous && !self.moves
    }

    /// The logarithm of the growth of its distance from the start over the second half of the time.
    pub(super) fn widening(&self) -> f64 {
        let [half, whole] = self.reach;
        if half > 0.0 { math::ln(whole / half) } else { 0.0 }
    }

    /// Whether neighbours follow linear equations with coefficients that do not depend on the place, nor on the time but by the law.
    pub(super) fn is_linear(&self) -> bool {
        self.first.is_some() && is_unchanged(self.change, self.steepest)
    }

    pub(super) fn start(&self) -> &State {
        &self.start
    }

    /// The distance of a state from the start, each variable as a part of how far it goes, and of its size where that is rounding.
    pub(super) fn apart(&self, space: &PhaseSpace, state: &State) -> Vec<Apart> {
        let pairs = space.variables(state).iter().zip(space.variables(&self.start));
        let parts = pairs.enumerate().map(|(i, (&x, &begin))| Apart {
            distance: self.difference(i, x, begin),
            extent: self.extents[i],
            size: self.sizes[i],
        });
        parts.collect()
    }
}

/// The departure of a motion whose rates, of which the logarithms are given, grow or fall in each quarter of the time.
fn steady_change(speeds: &[f64; QUARTERS]) -> Option<Departure> {
    let steps = || speeds.windows(2).map(|pair| pair[1] - pair[0]);
    if steps().all(|step| step >= EACH_QUARTER) {
        Some(Departure::Escape)
    } else if steps().all(|step| step <= -EACH_QUARTER) {
        Some(Departure::Rest)
    } else {
        None
    }
}

/// Whether a variable is at a saddle point to rounding: so far from it, having gone as far as `extent`.
fn is_at_saddle(distance: f64, extent: f64) -> bool {
    distance.abs() <= AT_SADDLE * extent
}

/// Whether coefficients that differ by this much from those at the start are the same.
fn is_unchanged(change: f64, largest: f64) -> bool {
    change <= SAME * largest
}

/// The distance of a variable from its start, how far it moves on the whole way, and its largest size.
pub(super) struct Apart {
    pub(super) distance: f64,
    pub(super) extent: f64,
    pub(super) size: f64,
}

/// The entries of a matrix with their places.
fn indices(matrix: &DMatrix<f64>) -> impl Iterator<Item = ((usize, usize), f64)> + '_ {
    let columns = 0..matrix.ncols();
    columns.flat_map(move |j| (0..matrix.nrows()).map(move |i| ((i, j), matrix[(i, j)])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_escapes_or_comes_to_rest_if_its_rates_change_by_e_squared_in_each_quarter() {
        let speeds = |least: f64| [1.0, 3.5, 3.5 + least, 6.0 + least];
        assert_eq!(steady_change(&speeds(2.01)), Some(Departure::Escape));
        assert_eq!(steady_change(&speeds(1.99)), None);
        assert_eq!(steady_change(&speeds(2.01).map(|speed| -speed)), Some(Departure::Rest));
        assert_eq!(steady_change(&speeds(1.99).map(|speed| -speed)), None);
    }

    #[test]
    fn a_saddle_point_is_reached_to_the_root_of_rounding() {
        assert!(is_at_saddle(-5.9e-7, 2.0) && !is_at_saddle(-6.1e-7, 2.0));
    }

    #[test]
    fn coefficients_are_constant_to_a_part_of_1e_12() {
        assert!(is_unchanged(1.9e-12, 2.0) && !is_unchanged(2.1e-12, 2.0));
        assert!(!is_unchanged(f64::NAN, 2.0));
    }
}
