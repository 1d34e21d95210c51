//! Rest from which more than one motion follows, as on the top of V = −|x| or of Norton's dome, V = −|x|^{3/2}.
//!
//! In: a law that does not depend on the time, a state at rest. Out: a coordinate along which the motion may leave it at any time,
//! or to more than one side. Never here: which motion a method follows.
//!
//! From ẍ = a(x) with a ~ x^s the motion x(t) leaves x = 0 in the time ∫ dx/√(2 ∫ a dx), which is finite where s < 1 (the condition
//! of Lipschitz has s = 1). It is one of several motions unless what is on the other side drives it to this side as well. Source:
//! J. D. Norton, "Causation as Folk Science", Philosophers' Imprint 3, no. 4 (2003), §3; W. F. Osgood, Monatshefte für Mathematik
//! und Physik 9 (1898) 331.

use crate::num::{DoubleDouble, math};
use crate::system::{ExactRates, Form, State, System};

/// The distance from the state at which forces are evaluated, relative to the coordinate, and by what part of it nearer they are
/// evaluated twice more.
const BESIDE: f64 = 1e-6;
const NEARER: f64 = 1e-4;

/// The powers from one distance to the next are the same to this: where a smooth force does not quite vanish at the state they are
/// 1 and then 0.
const ALIKE: f64 = 0.05;

/// The greatest power s: near the top of a smooth hill it is 1, and that of x ln x looks like 1 − 1/ln(1/x) ≥ 0.95 there.
const STEEPEST: f64 = 0.9;

/// A force below this part of that on the other side is none.
const NOTHING: f64 = 1e-9;

/// A velocity, relative to that with which the force would move it over the distance: dry friction acts on it.
const BARELY: f64 = 1e-3;

/// The sides of a coordinate to which the motion may leave.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct SeveralMotions {
    /// The index of the coordinate.
    pub coordinate: usize,
    /// Whether to smaller values, and to larger ones.
    pub sides: [bool; 2],
}

/// The first coordinate along which the motion from a state is not unique. Also `None` where nothing is claimed: if the
/// state moves, the law depends on the time, or there are constraints or brackets.
pub fn several_motions(
    system: &System,
    state: &State,
    parameters: &[f64],
) -> Option<SeveralMotions> {
    let n = system.degrees();
    if n == 0 || system.constraints() > 0 || state.values.len() < 2 * n {
        return None;
    }
    let still = match state.form {
        Form::Velocity => state.clone(),
        Form::Momentum => system.convert(state, Form::Velocity, parameters).ok()?,
        Form::Variables => return None,
    };
    if !(n..2 * n).all(|i| still.values[i] == 0.0) {
        return None;
    }
    let mut rates = system.exact_rates();
    rates.set_parameters(&system.inputs(parameters));
    if rates.depends_on_time() {
        return None;
    }
    let mut beside = SidePush { system, rates, parameters, still, n };
    (0..n).find_map(|i| {
        let sides = [-1.0, 1.0].map(|side| beside.push(i, side));
        let [left, right] = sides;
        let (left, right) = (left?, right?);
        let leaves = [left.leaves(), right.leaves()];
        // what drives it across drives it off one side
        let across = |from: &Push, to: &Push| from.force < -NOTHING * to.force.abs();
        let several = match leaves {
            [true, true] => true,
            [true, false] => !across(&right, &left),
            [false, true] => !across(&left, &right),
            [false, false] => false,
        };
        several.then_some(SeveralMotions { coordinate: i, sides: leaves })
    })
}

/// The force beside a state, away from it, and the power of the distance that it grows with.
struct Push {
    force: f64,
    power: f64,
}

impl Push {
    fn leaves(&self) -> bool {
        self.force > 0.0 && self.power < STEEPEST
    }
}

/// Where forces are evaluated.
struct SidePush<'a> {
    system: &'a System,
    rates: ExactRates,
    parameters: &'a [f64],
    still: State,
    n: usize,
}

impl SidePush<'_> {
    /// The push on one side of a coordinate; `None` where forces have no value.
    fn push(&mut self, i: usize, side: f64) -> Option<Push> {
        let x = self.still.values[i].abs();
        let far = BESIDE * if x > 0.0 { x } else { 1.0 };
        let distances = [far, NEARER * far, NEARER * NEARER * far];
        let [force, near, nearest] = distances.map(|distance| self.force(i, side, distance));
        let (force, near, nearest) = (force?, near?, nearest?);
        let power = |far: f64, near: f64| math::ln(far / near) / -math::ln(NEARER);
        let [first, second] = [power(force, near), power(near, nearest)];
        // of forces of two signs, or none, it is not a number
        let is_power = (first - second).abs() < ALIKE;
        Some(Push { force, power: if is_power { first.max(second) } else { f64::INFINITY } })
    }

    /// The force away from the state at a distance, against the friction there.
    fn force(&mut self, i: usize, side: f64, distance: f64) -> Option<f64> {
        let free = self.rate(i, side * distance, 0.0)?;
        let speed = BARELY * (2.0 * free.abs() * distance).sqrt();
        let moving = self.rate(i, side * distance, side * speed)?;
        Some(side * moving)
    }

    /// The rate of the velocity or momentum of a coordinate at a distance with a velocity.
    fn rate(&mut self, i: usize, distance: f64, velocity: f64) -> Option<f64> {
        let mut state = self.still.clone();
        state.set(i, state.exact(i) + DoubleDouble::from(distance));
        state.set(self.n + i, DoubleDouble::from(velocity));
        let state = self.system.convert(&state, self.system.form(), self.parameters).ok()?;
        let numbers: Vec<DoubleDouble> = (0..state.values.len()).map(|k| state.exact(k)).collect();
        self.rates.evaluate(state.exact_time(), &numbers).ok()?;
        Some(self.rates.rate(self.n + i).high).filter(|rate| rate.is_finite())
    }
}
