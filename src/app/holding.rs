//! A mass that the mouse holds in a picture of a plane: the coordinates that bring it there.
//!
//! In: the place of the mouse in the units of the picture. Out: initial values, at rest. Never here: the mouse, or where anything is
//! on the screen.

use super::Lab;
use crate::expr::{Expr, Pool, Symbol};
use crate::instrument::CameraPose;
use crate::model::{Mechanics, Shape};
use crate::system::InitialOverride;

/// The most steps of the search for coordinates, and the most halvings of each.
const STEPS: usize = 40;
const HALVINGS: usize = 12;

/// The damping, relative to the squares of the slopes: where a place cannot be reached the nearest one is found.
const DAMPING: f64 = 1e-8;

/// The change of the coordinates, relative to their size, at which the search ends.
const ENOUGH: f64 = 1e-10;

impl Lab {
    /// Whether a shape is a mass that can be held: its place follows from the coordinates and nothing ties these together.
    pub fn can_hold(&self, eye: CameraPose, shape: usize) -> bool {
        self.held_mass(eye, shape).is_some()
    }

    /// The place of a mass that can be held, and the coordinates from which it follows.
    fn held_mass(&self, eye: CameraPose, shape: usize) -> Option<([Expr; 2], Vec<usize>)> {
        let (model, equations) = (&self.loaded.model, &self.loaded.equations);
        let has_motions =
            model.is_lagrangian() || matches!(model.mechanics, Mechanics::Hamiltonian { .. });
        if eye.frame.is_some() || !has_motions || !model.constraints.is_empty() {
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

    /// The initial values with which a mass is at rest at a place in the plane, or as near to it as it can be; the other
    /// coordinates stay as they are. `None` where there are none.
    pub(super) fn held_at(
        &self,
        eye: CameraPose,
        shape: usize,
        at: [f64; 2],
    ) -> Option<Vec<InitialOverride>> {
        let (mass, moved) = self.held_mass(eye, shape)?;
        let (model, equations) = (&self.loaded.model, &self.loaded.equations);
        let now = self.valuation();
        let position = |i: usize| equations.coordinates[i].position;
        let search = MassSearch::new(
            equations.pool.clone(),
            mass,
            moved.iter().map(|i| position(*i)).collect(),
        );
        let before: Vec<f64> = moved.iter().map(|i| now.at(position(*i))).collect();
        let after = search.nearest(at, before.clone(), &|symbol| now.at(symbol))?;
        // beside an angle a length keeps its sign: a negative distance is not what the picture shows
        let has_angle = moved.iter().any(|i| model.coordinates[*i].period.is_some());
        let turns = moved.iter().zip(before.iter().zip(&after)).any(|(i, (before, after))| {
            model.coordinates[*i].period.is_none() && before * after <= 0.0
        });
        if has_angle && turns {
            return None;
        }
        let count = model.coordinates.len();
        let place = |i: usize| {
            let new = moved.iter().position(|other| *other == i).map(|at| after[at]);
            InitialOverride::Position(i, new.unwrap_or_else(|| now.at(position(i))))
        };
        let is_lagrangian = model.is_lagrangian();
        let rest = |i: usize| {
            if is_lagrangian {
                InitialOverride::Velocity(i, 0.0)
            } else {
                InitialOverride::Momentum(i, 0.0)
            }
        };
        Some((0..count).map(place).chain((0..count).map(rest)).collect())
    }
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
        let mut left = off(&values);
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
            let moved = values.iter().zip(&next).map(|(a, b)| (a - b).abs() / (1.0 + b.abs()));
            let is_enough = moved.fold(0.0, f64::max) < ENOUGH;
            left = off(&next);
            values = next;
            if is_enough {
                break;
            }
        }
        (length(left).is_finite() && values.iter().all(|value| value.is_finite())).then_some(values)
    }
}
