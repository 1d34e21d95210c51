//! A mass dragged in a picture of a plane: the coordinates that bring it there.
//!
//! In: the place of the mouse in the units of the picture. Out: initial values, at rest. Never here: the mouse, or where anything is
//! on the screen.

use std::collections::HashMap;

use nalgebra::DMatrix;

use super::Lab;
use crate::expr::{Expr, Pool, Symbol};
use crate::instrument::CameraPose;
use crate::mechanics::{Equations, Flow};
use crate::model::Shape;
use crate::system::InitialOverride;

/// The most steps of the search for coordinates, and the most halvings of each.
const STEPS: usize = 40;
const HALVINGS: usize = 12;

/// The damping, relative to the squares of the slopes: where a place cannot be reached the nearest one is found.
const DAMPING: f64 = 1e-8;

/// The step of the mass, relative to the way to the mouse, at which the search ends.
const ENOUGH: f64 = 1e-10;

/// The places of the way between two coordinates at which the masses are looked at, and the steps by which the least is found
/// between them: each makes what is left shorter by the golden section.
const PLACES: usize = 64;
const SECTIONS: usize = 80;

/// A determinant of the masses is zero below this, relative to the largest on the way.
const SINGULAR: f64 = 1e-12;

/// The symbols of what moves, and their values.
type Values = HashMap<Symbol, f64>;

/// The momenta of a state at rest, with the pool in which they are written; without momenta there are velocities.
enum Rest {
    Velocities,
    Momenta(Box<Pool>, Vec<Expr>),
}

impl Lab {
    /// Whether a shape is a mass that can be dragged: its place follows from the coordinates, nothing ties these together, and it is
    /// known what is at rest.
    pub fn can_drag(&self, eye: CameraPose, shape: usize) -> bool {
        self.dragged_mass(eye, shape).is_some() && self.rest().is_some()
    }

    /// Whether any mass of a picture can be dragged.
    pub(super) fn has_draggable_mass(&self, eye: CameraPose) -> bool {
        let count = eye.shapes(&self.loaded.model).len();
        (0..count).any(|shape| self.can_drag(eye, shape))
    }

    /// The place of a mass that can be dragged, and the coordinates from which it follows.
    fn dragged_mass(&self, eye: CameraPose, shape: usize) -> Option<([Expr; 2], Vec<usize>)> {
        let (model, equations) = (&self.loaded.model, &self.loaded.equations);
        if eye.frame.is_some() || !model.constraints.is_empty() {
            return None;
        }
        let Some(Shape::Mass { at: [x, y, Expr::ZERO], .. }) = eye.shapes(model).get(shape) else {
            return None;
        };
        let symbols: Vec<Symbol> =
            [x, y].iter().flat_map(|e| equations.pool.symbols_of(**e)).collect();
        let is_place =
            |symbol: &Symbol| equations.coordinates.iter().any(|c| c.position == *symbol);
        let is_known = |symbol: &Symbol| model.parameters.iter().any(|p| p.symbol == *symbol);
        let positions = equations.coordinates.iter().map(|c| c.position).enumerate();
        let moved: Vec<usize> =
            positions.filter(|(_, position)| symbols.contains(position)).map(|(i, _)| i).collect();
        let follows = symbols.iter().all(|symbol| is_place(symbol) || is_known(symbol));
        (follows && !moved.is_empty()).then_some(([*x, *y], moved))
    }

    /// What makes a state one at rest; `None` where it is not known.
    fn rest(&self) -> Option<Rest> {
        let equations = &self.loaded.equations;
        match &equations.flow {
            Flow::Lagrange { .. } => Some(Rest::Velocities),
            Flow::Hamilton { .. } => {
                let mut own = Equations::clone(equations);
                let momenta = own.momenta_at_rest()?;
                Some(Rest::Momenta(Box::new(own.pool), momenta))
            }
            Flow::Poisson { .. } => None,
        }
    }

    /// The initial values with which a mass is at rest at a place in the plane, or as near to it as it can be; the other
    /// coordinates stay as they are. `None` where there are none, and where the masses become singular on the way.
    pub(super) fn dragged_to(
        &self,
        eye: CameraPose,
        shape: usize,
        at: [f64; 2],
    ) -> Option<Vec<InitialOverride>> {
        let (mass, moved) = self.dragged_mass(eye, shape)?;
        let rest = self.rest()?;
        let (model, equations) = (&self.loaded.model, &self.loaded.equations);
        let now = self.valuation();
        let positions: Vec<Symbol> = equations.coordinates.iter().map(|c| c.position).collect();
        let search = MassSearch::new(
            equations.pool.clone(),
            mass,
            moved.iter().map(|i| positions[*i]).collect(),
        );
        let before: Vec<f64> = moved.iter().map(|i| now.at(positions[*i])).collect();
        let after = search.nearest(at, before.clone(), &|symbol| now.at(symbol))?;
        // the motion that begins there begins at the start, at rest
        let mut here: Values = HashMap::from([(model.symbols.time, model.run.start)]);
        here.extend(equations.coordinates.iter().map(|c| (c.velocity, 0.0)));
        let momenta: Vec<Symbol> = equations.coordinates.iter().map(|c| c.momentum).collect();
        let masses = MassMatrix::of(&equations.flow, &equations.pool, &momenta);
        let determinant = |share: f64| {
            let mut here = here.clone();
            let ways = before.iter().zip(&after).map(|(from, to)| from + share * (to - from));
            here.extend(moved.iter().map(|i| positions[*i]).zip(ways));
            let value = |symbol: Symbol, here: &Values| {
                here.get(&symbol).copied().unwrap_or_else(|| now.at(symbol))
            };
            if let Rest::Momenta(pool, momenta) = &rest {
                let found: Vec<f64> =
                    momenta.iter().map(|e| pool.evaluate(*e, &|s| value(s, &here))).collect();
                here.extend(equations.coordinates.iter().map(|c| c.momentum).zip(found));
            }
            masses.determinant(&|symbol| value(symbol, &here))
        };
        if is_singular_on_the_way(determinant) {
            return None;
        }
        let place = |i: usize| {
            let new = moved.iter().position(|other| *other == i).map(|at| after[at]);
            new.unwrap_or_else(|| now.at(positions[i]))
        };
        let places: Vec<f64> = (0..positions.len()).map(place).collect();
        here.extend(positions.iter().copied().zip(places.iter().copied()));
        let rates: Vec<InitialOverride> = match &rest {
            Rest::Velocities => {
                (0..places.len()).map(|i| InitialOverride::Velocity(i, 0.0)).collect()
            }
            Rest::Momenta(pool, momenta) => {
                let value =
                    |symbol: Symbol| here.get(&symbol).copied().unwrap_or_else(|| now.at(symbol));
                let momenta = momenta.iter().map(|e| pool.evaluate(*e, &value)).enumerate();
                momenta.map(|(i, p)| InitialOverride::Momentum(i, p)).collect()
            }
        };
        let is_finite = |given: &InitialOverride| !matches!(given, InitialOverride::Momentum(_, p) if !p.is_finite());
        let places = places.into_iter().enumerate().map(|(i, q)| InitialOverride::Position(i, q));
        rates.iter().all(is_finite).then(|| places.chain(rates).collect())
    }
}

/// The masses of a system: M = ∂p/∂q̇, or ∂q̇/∂p, its inverse.
struct MassMatrix {
    pool: Pool,
    entries: Vec<Vec<Expr>>,
    is_inverse: bool,
}

impl MassMatrix {
    fn of(flow: &Flow, pool: &Pool, momenta: &[Symbol]) -> Self {
        let mut pool = pool.clone();
        let (entries, is_inverse) = match flow {
            Flow::Lagrange { mass, .. } => (mass.clone(), false),
            Flow::Hamilton { velocities, .. } => {
                let row = |v: &Expr| momenta.iter().map(|p| pool.derivative(*v, *p)).collect();
                (velocities.iter().map(row).collect(), true)
            }
            Flow::Poisson { .. } => (Vec::new(), false),
        };
        Self { pool, entries, is_inverse }
    }

    /// det M.
    fn determinant(&self, at: &dyn Fn(Symbol) -> f64) -> f64 {
        let n = self.entries.len();
        let entry = |i: usize, k: usize| self.pool.evaluate(self.entries[i][k], at);
        let determinant = DMatrix::from_fn(n, n, entry).determinant();
        if self.is_inverse { 1.0 / determinant } else { determinant }
    }
}

/// Whether a determinant vanishes, has another sign, or is not a number between the ends 0 and 1 of a way. What is small is measured
/// against the largest on the way, so units do not matter.
fn is_singular_on_the_way(determinant: impl Fn(f64) -> f64) -> bool {
    let share = |i: usize| i as f64 / PLACES as f64;
    let values: Vec<f64> = (0..=PLACES).map(|i| determinant(share(i))).collect();
    let largest = values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let is_zero =
        |value: f64| !value.is_finite() || value * values[0].signum() <= SINGULAR * largest;
    if values.iter().any(|value| is_zero(*value)) {
        return true;
    }
    let size = |i: usize| values[i].abs();
    let beside = |i: usize| [i.saturating_sub(1), (i + 1).min(PLACES)];
    let mut lows = (0..=PLACES).filter(|&i| beside(i).into_iter().all(|k| size(i) <= size(k)));
    lows.any(|i| {
        let [mut from, mut to] = beside(i).map(share);
        let part = (5.0_f64.sqrt() - 1.0) / 2.0;
        (0..SECTIONS).any(|_| {
            let [left, right] = [to - part * (to - from), from + part * (to - from)];
            let [one, other] = [left, right].map(&determinant);
            if one.abs() < other.abs() {
                to = right;
            } else {
                from = left;
            }
            is_zero(one) || is_zero(other)
        })
    })
}

/// The search for the coordinates of a mass.
struct MassSearch {
    pool: Pool,
    mass: [Expr; 2],
    symbols: Vec<Symbol>,
    /// The derivatives of its place by each coordinate.
    slopes: Vec<[Expr; 2]>,
}

impl MassSearch {
    fn new(mut pool: Pool, mass: [Expr; 2], symbols: Vec<Symbol>) -> Self {
        let slopes =
            symbols.iter().map(|symbol| mass.map(|e| pool.derivative(e, *symbol))).collect();
        Self { pool, mass, symbols, slopes }
    }

    /// The coordinates that bring the mass nearest to a place, by damped Gauss-Newton steps from these.
    fn nearest(
        &self,
        at: [f64; 2],
        mut values: Vec<f64>,
        known: &dyn Fn(Symbol) -> f64,
    ) -> Option<Vec<f64>> {
        let evaluate = |e: Expr, values: &[f64]| {
            let own = |symbol: Symbol| self.symbols.iter().position(|other| *other == symbol);
            self.pool
                .evaluate(e, &|symbol| own(symbol).map_or_else(|| known(symbol), |i| values[i]))
        };
        let off = |values: &[f64]| [0, 1].map(|k| at[k] - evaluate(self.mass[k], values));
        let length = |[x, y]: [f64; 2]| x * x + y * y;
        let way = off(&values);
        let mut left = way;
        for _ in 0..STEPS {
            let slopes: Vec<[f64; 2]> =
                self.slopes.iter().map(|slope| slope.map(|e| evaluate(e, &values))).collect();
            let sum =
                |i: usize, k: usize| slopes.iter().map(|slope| slope[i] * slope[k]).sum::<f64>();
            let damping = DAMPING * (sum(0, 0) + sum(1, 1));
            let (a, b, d) = (sum(0, 0) + damping, sum(0, 1), sum(1, 1) + damping);
            let determinant = a * d - b * b;
            let pull = [
                (d * left[0] - b * left[1]) / determinant,
                (a * left[1] - b * left[0]) / determinant,
            ];
            let step: Vec<f64> =
                slopes.iter().map(|slope| slope[0] * pull[0] + slope[1] * pull[1]).collect();
            if step.iter().any(|change| !change.is_finite()) {
                break;
            }
            let parts = (0..HALVINGS).map(|halved| 1.0 / f64::from(1_u32 << halved));
            let tried = parts.map(|part| {
                values.iter().zip(&step).map(|(value, change)| value + part * change).collect()
            });
            let nearer = |values: &Vec<f64>| length(off(values)) < length(left);
            let Some(next) = tried.into_iter().find(nearer) else { break };
            let then = off(&next);
            let is_enough =
                length([then[0] - left[0], then[1] - left[1]]) <= ENOUGH * ENOUGH * length(way);
            (left, values) = (then, next);
            if is_enough {
                break;
            }
        }
        (length(left).is_finite() && values.iter().all(|value| value.is_finite())).then_some(values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Polar coordinates: r² vanishes between r and −r, by whatever unit it is measured, and near the end of a way, too; not where r
    /// only becomes small, or where the masses change without vanishing.
    #[test]
    fn a_way_is_singular_where_the_determinant_vanishes() {
        for unit in [1e-30, 1.0, 1e30] {
            let way = |from: f64, to: f64| {
                move |share: f64| unit * (from + share * (to - from)) * (from + share * (to - from))
            };
            for (from, to) in [(0.5, -0.875), (1.0, -1e-3), (1e-3, -1.0), (-1.0, 0.7), (1.0, 0.0)] {
                assert!(is_singular_on_the_way(way(from, to)), "{unit} {from} {to}");
            }
            for (from, to) in [(0.5, 0.8), (1.0, 1e-3), (-1.0, -0.2)] {
                assert!(!is_singular_on_the_way(way(from, to)), "{unit} {from} {to}");
            }
            // a cart with a pendulum of a thousandth of its mass, or a thousand times as heavy
            for ratio in [1e-3, 1e3] {
                let masses = |share: f64| {
                    let sine = crate::num::math::sin(6.0 * share - 3.0);
                    unit * (1.0 + ratio * sine * sine)
                };
                assert!(!is_singular_on_the_way(masses), "{unit} {ratio}");
            }
            assert!(is_singular_on_the_way(|share| unit * (share - 0.3)), "{unit}");
            assert!(is_singular_on_the_way(|share| -unit * (share - 0.3)), "{unit}");
            assert!(!is_singular_on_the_way(|share| -unit * (share + 0.3)), "{unit}");
        }
        assert!(is_singular_on_the_way(|_| 0.0));
        assert!(is_singular_on_the_way(|_| f64::NAN));
    }

    /// A bead on the parabola y = x²/a: with all lengths 2⁻⁵⁰ times as long the same place is found, to the last bit.
    #[test]
    fn the_search_does_not_depend_on_the_unit_of_length() {
        let found = |unit: f64| {
            let mut pool = Pool::new();
            let symbols = [pool.symbol("x"), pool.symbol("a")];
            let [x, size] = symbols.map(|symbol| pool.variable(symbol));
            let square = pool.mul(x, x);
            let height = pool.div(square, size);
            let search = MassSearch::new(pool, [x, height], vec![symbols[0]]);
            let at = [0.9 * unit, 1.7 * unit];
            search.nearest(at, vec![0.2 * unit], &|_| unit).expect("a place")[0] / unit
        };
        let one = found(1.0);
        // the foot of the perpendicular: (x − 0.9) + 2 x (x² − 1.7) = 0
        assert!((one - 0.9 + 2.0 * one * (one * one - 1.7)).abs() < 1e-7, "{one}");
        let small = crate::num::math::powi(2.0, -50);
        assert_eq!(found(small), one);
    }
}
