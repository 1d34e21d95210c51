//! Corners of constraints: places where their directions jump, as that of y = |x| at x = 0.
//!
//! In: a state with velocities, two times beside it. Out: on which sides of the kinks of the constraints a motion is that goes
//! straight on, and which constraint has a corner between the two times that it does not pass without an impulse. The direction of
//! this impulse would be that of the constraint, of which there are two: the law does not determine it. Where a rate alone jumps,
//! as that of x = |t|, the direction is known, and so is the impulse. Never here: steps, where a kink lies within one.

use super::State;
use super::conditions::Conditions;
use super::projector::ConstraintProjector;
use crate::num::DoubleDouble;

/// What differs by no more than this part of its terms on both sides of a place is the same there: rounding, and what a smooth
/// constraint turns by on the way from one side to the other.
const SAME: f64 = 1e-9;

/// A constraint on one side of a place: its row, A q̇ + A₀, and the sizes of their terms.
struct OneSide {
    row: Vec<f64>,
    speed: f64,
    size: f64,
}

impl ConstraintProjector {
    /// Whether its constraints may have corners.
    pub fn may_have_corners(&mut self) -> bool {
        let conditions = self.projection.conditions();
        conditions.switches() > 0 || conditions.has_branches()
    }

    /// The signs of the switches of the constraints where the motion is a time `after` a state.
    pub fn sides(&mut self, state: &State, after: f64) -> Vec<f64> {
        let conditions = self.observed(state, after);
        (0..conditions.switches()).map(|i| conditions.switch(i).signum()).collect()
    }

    /// The name of a constraint that has a corner between two times beside a state, and that its velocities do not satisfy on both
    /// sides of it.
    pub fn corner(&mut self, state: &State, [before, after]: [f64; 2]) -> Option<String> {
        let active = self.system.active_set().active.clone();
        let velocities = self.velocities(state);
        let [here, beyond] = [before, after].map(|time| {
            let conditions = self.observed(state, time);
            (0..active.len()).map(|k| one_side(conditions, k, &velocities)).collect::<Vec<_>>()
        });
        let mut pairs = here.iter().zip(&beyond).zip(active);
        let corner = pairs.position(|((here, beyond), active)| active && parts(here, beyond))?;
        self.system.constrained().map(|constrained| constrained.names[corner].clone())
    }

    /// The constraints where the motion is a time `after` a state.
    fn observed(&mut self, state: &State, after: f64) -> &mut Conditions {
        self.load(state);
        let after = DoubleDouble::from(after);
        for (i, &v) in self.velocities(state).iter().enumerate() {
            self.numbers[i] = self.numbers[i] + v * after;
        }
        let conditions = self.projection.conditions();
        conditions.observe(state.exact_time() + after, &self.numbers);
        conditions
    }

    fn velocities(&self, state: &State) -> Vec<DoubleDouble> {
        let n = self.system.degrees();
        (n..2 * n).map(|i| state.exact(i)).collect()
    }
}

fn one_side(conditions: &Conditions, k: usize, velocities: &[DoubleDouble]) -> OneSide {
    let velocity = conditions.velocity(k, velocities);
    let row = (0..velocities.len()).map(|i| conditions.entry(k, i).high).collect();
    OneSide { row, speed: velocity.value.high, size: velocity.size }
}

/// Whether both the direction of a constraint and the rate that it demands jump between two sides.
fn parts(here: &OneSide, beyond: &OneSide) -> bool {
    let jumps = |jump: f64, size: f64| jump.abs() > SAME * size;
    let largest = here.row.iter().chain(&beyond.row).fold(0.0_f64, |most, a| most.max(a.abs()));
    let mut entries = here.row.iter().zip(&beyond.row);
    jumps(beyond.speed - here.speed, here.size.max(beyond.size))
        && entries.any(|(a, b)| jumps(b - a, largest))
}

#[cfg(test)]
mod tests {
    use super::{OneSide, parts};

    #[test]
    fn a_corner_is_a_jump_of_both_by_a_billionth() {
        for size in [1e-12, 1.0, 1e12] {
            let side = |turn: f64, speed: f64| OneSide {
                row: vec![size, turn * size],
                speed: speed * size,
                size,
            };
            for (turn, speed, corner) in
                [(1.1e-9, 1.1e-9, true), (0.9e-9, 1.1e-9, false), (1.1e-9, 0.9e-9, false)]
            {
                let found = parts(&side(0.5, 0.0), &side(0.5 + turn, speed));
                assert_eq!(found, corner, "{turn:e} {speed:e} of {size:e}");
            }
        }
    }
}
