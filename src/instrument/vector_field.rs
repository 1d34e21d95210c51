//! The vector field of a plane of a coordinate and its own momentum or velocity, with its nullclines.
//!
//! In: a coordinate, the present state. Out: a [`PlaneField`], its rates at points of the plane, the curves on which one of them
//! vanishes. Never here: which planes have one, strokes and colours.

use std::sync::Arc;

use super::{Physics, Present};
use crate::analysis::{Curve, Grid};
use crate::system::{ChannelKind, Form, Rates, State, System};

/// The grid points, horizontal and vertical, on which signs of the rates are looked at: of a field that stays, and of one that
/// changes with the motion.
const STEADY_GRID: [usize; 2] = [121, 91];
const MOVING_GRID: [usize; 2] = [49, 37];

/// A zero between two grid points is located by so many halvings; there a rate is at most this part of what it is at them.
const HALVINGS: usize = 12;
const VANISHING: f64 = 0.1;

/// The rates of change (ẋ, ẏ) over a plane of a coordinate and its own momentum or velocity. What is not in the plane – other
/// coordinates and their rates, the time – is that of the present.
#[derive(Clone, Debug)]
pub struct PlaneField {
    system: Arc<System>,
    parameters: Vec<f64>,
    form: Form,
    /// The index of the horizontal and the vertical axis among the numbers of a state.
    places: [usize; 2],
    /// The present numbers of a state; zero in the plane, and all zero where the field is the same at all times.
    numbers: Vec<f64>,
    time: f64,
    is_momentary: bool,
    /// Where velocities are solved for, of which momenta may allow several: the present ones, on the branch of the motion, and the
    /// initial values with which that began.
    near: Option<(State, Vec<f64>)>,
}

/// The field at single points; it has the registers for that.
#[derive(Debug)]
pub struct FieldRates {
    rates: Rates,
    near: Option<State>,
    places: [usize; 2],
    time: f64,
    numbers: Vec<f64>,
    out: Vec<f64>,
}

impl PlaneField {
    /// The field of the plane of a coordinate and its momentum or velocity, at a present state; `is_upright` where the coordinate is
    /// on the horizontal axis.
    pub(super) fn new(
        present: &Present<'_>,
        (index, form): (usize, Form),
        is_upright: bool,
    ) -> Self {
        let system = present.physics.system;
        let (n, has_time) = (system.degrees(), depends_on_time(present.physics));
        let rate_of = |i: usize| match form {
            Form::Momentum => ChannelKind::Momentum(i),
            _ => ChannelKind::Velocity(i),
        };
        let mut numbers = vec![0.0; system.state_len()];
        for i in (0..n).filter(|&i| i != index) {
            for (place, kind) in [(i, ChannelKind::Position(i)), (n + i, rate_of(i))] {
                numbers[place] = present.physics.channel(kind).map_or(0.0, |k| present.value(k));
            }
        }
        let native = (0..n).map(|i| [ChannelKind::Position(i), ChannelKind::Velocity(i)]);
        let native: Option<Vec<[f64; 2]>> = native
            .map(|[q, v]| {
                let value = |kind| Some(present.value(present.physics.channel(kind)?));
                Some([value(q)?, value(v)?])
            })
            .collect();
        let is_solved = form == Form::Momentum && !system.has_direct_canonical_rates();
        let near = native.filter(|_| is_solved);
        let near = near.map(|pairs| {
            let mut values = vec![0.0; system.state_len()];
            for (i, [q, v]) in pairs.into_iter().enumerate() {
                (values[i], values[n + i]) = (q, v);
            }
            (State::new(present.time, Form::Velocity, values), present.initial.to_vec())
        });
        Self {
            near,
            system: Arc::clone(system),
            parameters: present.parameters.to_vec(),
            form,
            places: if is_upright { [index, n + index] } else { [n + index, index] },
            numbers,
            time: if has_time { present.time } else { 0.0 },
            is_momentary: has_time || n > 1,
        }
    }

    /// Whether it changes with the motion: with the time, or with coordinates that are not in the plane.
    pub fn is_momentary(&self) -> bool {
        self.is_momentary
    }

    /// Whether another one is the same everywhere.
    pub fn is_same(&self, other: &Self) -> bool {
        let same = |a: &[f64], b: &[f64]| {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
        };
        Arc::ptr_eq(&self.system, &other.system)
            && (self.form, self.places) == (other.form, other.places)
            && self.time.to_bits() == other.time.to_bits()
            && same(&self.parameters, &other.parameters)
            && same(&self.numbers, &other.numbers)
            && same(self.motion(), other.motion())
    }

    /// The initial values of the motion whose branch it follows, if there may be several.
    fn motion(&self) -> &[f64] {
        self.near.as_ref().map_or(&[][..], |(_, initial)| initial)
    }

    /// The field at single points.
    pub fn rates(&self) -> FieldRates {
        let rates = match self.form {
            Form::Momentum => self.system.canonical_rates(),
            _ => self.system.native_rates(),
        };
        let mut rates = FieldRates {
            rates,
            near: self.near.as_ref().map(|(state, _)| state.clone()),
            places: self.places,
            time: self.time,
            numbers: self.numbers.clone(),
            out: vec![0.0; self.numbers.len()],
        };
        rates.rates.set_parameters(&self.parameters);
        rates
    }

    /// The curves in a window on which the rate of the horizontal axis vanishes, and those on which that of the vertical one does.
    /// They reach a little beyond the window. Where a rate jumps through a pole there is none.
    pub fn nullclines(&self, window: [[f64; 2]; 2]) -> [Vec<Curve>; 2] {
        let counts = if self.is_momentary { MOVING_GRID } else { STEADY_GRID };
        let steps = [0, 1].map(|k| (window[k][1] - window[k][0]) / (counts[k] - 3) as f64);
        let ends = [0, 1].map(|k| [window[k][0] - steps[k], window[k][1] + steps[k]]);
        let mut rates = self.rates();
        let place = |k: usize, i: usize| ends[k][0] + steps[k] * i as f64;
        let mut values = [Vec::new(), Vec::new()];
        for j in 0..counts[1] {
            for i in 0..counts[0] {
                let found = rates.at([place(0, i), place(1, j)]).unwrap_or([f64::NAN; 2]);
                values.iter_mut().zip(found).for_each(|(values, found)| values.push(found));
            }
        }
        [0, 1].map(|k| {
            let values = &values[k];
            // where it vanishes everywhere there is no curve
            if values.iter().all(|value| *value == 0.0 || value.is_nan()) {
                return Vec::new();
            }
            let grid = Grid { x: (counts[0], ends[0]), y: (counts[1], ends[1]), values };
            let curves = grid.curves(0.0).into_iter();
            curves.flat_map(|curve| without_poles(&mut rates, k, steps, &curve)).collect()
        })
    }
}

/// The parts of a curve on which a rate vanishes indeed, and does not jump from one sign to the other; their points are located by
/// halving.
fn without_poles(rates: &mut FieldRates, k: usize, steps: [f64; 2], curve: &Curve) -> Vec<Curve> {
    let located: Vec<Option<[f64; 2]>> =
        curve.iter().map(|at| rates.zero_near(*at, k, steps)).collect();
    let runs = located.split(Option::is_none).map(|run| run.iter().flatten().copied().collect());
    runs.filter(|run: &Curve| run.len() > 1).collect()
}

impl FieldRates {
    /// The rates of change of the horizontal and the vertical quantity at a point of the plane; `None` where there are none.
    pub fn at(&mut self, point: [f64; 2]) -> Option<[f64; 2]> {
        for (place, value) in self.places.into_iter().zip(point) {
            self.numbers[place] = value;
        }
        // the velocities are those of the branch on which the motion is
        if let Some(state) = &self.near {
            self.rates.begin_near(state);
        }
        self.rates.evaluate(self.time, &self.numbers, &mut self.out).ok()?;
        let found = self.places.map(|place| self.out[place]);
        found.iter().all(|rate| rate.is_finite()).then_some(found)
    }

    /// A zero of a rate within a step of a point, along the axis on which it changes most; `None` at a pole.
    fn zero_near(&mut self, at: [f64; 2], k: usize, steps: [f64; 2]) -> Option<[f64; 2]> {
        let moved = |axis: usize, by: f64| {
            let mut moved = at;
            moved[axis] += by;
            moved
        };
        let mut axes = Vec::new();
        for axis in [0, 1] {
            let mut rate = |by: f64| Some(self.at(moved(axis, by))?[k]);
            if let Some((low, high)) = rate(-steps[axis]).zip(rate(steps[axis])) {
                axes.push((axis, low, high));
            }
        }
        let (axis, low, high) = axes.into_iter().max_by(|a, b| {
            let change = |(_, low, high): &(usize, f64, f64)| (high - low).abs();
            change(a).total_cmp(&change(b))
        })?;
        if low == 0.0 || high == 0.0 || (low < 0.0) == (high < 0.0) {
            // two branches of the curve, or its end, are this close
            return self
                .at(at)
                .filter(|rate| rate[k].abs() <= low.abs().max(high.abs()))
                .map(|_| at);
        }
        let [mut from, mut to] = [-steps[axis], steps[axis]];
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(from, to);
            if (self.at(moved(axis, middle))?[k] < 0.0) == (low < 0.0) {
                from = middle;
            } else {
                to = middle;
            }
        }
        let place = moved(axis, f64::midpoint(from, to));
        let left = self.at(place)?[k].abs();
        (left <= VANISHING * low.abs().max(high.abs())).then_some(place)
    }
}

/// Whether the time enters the law of motion.
pub(super) fn depends_on_time(Physics { model, equations, .. }: Physics<'_>) -> bool {
    let law = equations.flow.expressions();
    law.iter().any(|&e| equations.pool.depends(e, model.symbols.time))
}
