//! Points of phase space near the start: where an identity that no proof is found for is held
//! against numbers.
//!
//! In: a model with its equations. Out: values for every symbol of q, q̇, p, t and the parameters,
//! the same for everybody; on request they obey the constraints. Never here: motion.

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector};

use super::equations::{ConstraintRow, Equations, Flow};
use super::rigid_body::body_values;
use crate::expr::{Expr, Symbol};
use crate::model::Model;

/// How many points an identity has to hold at.
pub const POINTS: usize = 20;

/// So many are tried to find that many.
pub const TRIES: u64 = 400;

/// How far the points are from the start, in turn, on the scale of the largest start of their kind.
const WIDTHS: [f64; 4] = [1.0, 0.1, 1.0, 0.01];

/// The scales tried in turn where all coordinates, or all velocities, start at 0.
const SIZES: [f64; 6] = [1.0, 1.0, 1e-3, 1e3, 1e-6, 1e-9];

/// A point is on the constraints when it is moved by no more than this part of its size.
const SETTLED: f64 = 1e-14;

/// A value for each symbol of a system.
#[derive(Clone, Debug)]
pub struct Point(HashMap<Symbol, f64>);

impl Point {
    /// The value of a symbol; not a number for one that has none.
    pub fn at(&self, symbol: Symbol) -> f64 {
        self.0.get(&symbol).copied().unwrap_or(f64::NAN)
    }

    /// The n-th point near the start, at the file's parameters. The momenta of a Lagrangian system
    /// are those of its velocities, the velocities of any other those of its state.
    pub fn near_start(model: &Model, equations: &Equations, n: u64) -> Point {
        let mut point = Point(model.parameters.iter().map(|p| (p.symbol, p.value)).collect());
        let parameters = model.parameter_values();
        let body = equations.supplements.body.as_ref();
        point.0.extend(body_values(model, &equations.pool, body, &parameters));
        let mut draws = Draws { n, k: 0 };
        let initial = |point: &Point, e| {
            let value = equations.pool.evaluate(e, &|s| point.at(s));
            if value.is_finite() { value } else { 0.0 }
        };
        let starts: Vec<(f64, f64)> = model
            .coordinates
            .iter()
            .map(|c| (initial(&point, c.initial), initial(&point, c.initial_rate)))
            .collect();
        let span = model.run.until.map_or(1.0, |until| (until - model.run.start).abs().max(1.0));
        let time = model.run.start + span * draws.next();
        point.0.insert(model.symbols.time, time);
        let largest = |of: fn(&(f64, f64)) -> f64| {
            let size = starts.iter().map(|start| of(start).abs()).fold(0.0, f64::max);
            // where everything starts at 0 nothing says how large it will be
            if size > 0.0 { size } else { SIZES[(n % SIZES.len() as u64) as usize] }
        };
        let (length, speed) = (largest(|start| start.0), largest(|start| start.1));
        let width = WIDTHS[(n % WIDTHS.len() as u64) as usize];
        for (c, &(position, rate)) in model.coordinates.iter().zip(&starts) {
            let rate_symbol = if model.is_lagrangian() { c.velocity } else { c.momentum };
            point.0.insert(c.position, draws.near(position, width * length));
            point.0.insert(rate_symbol, draws.near(rate, width * speed));
        }
        let (symbols, values): (Vec<Symbol>, _) = match &equations.flow {
            Flow::Lagrange { .. } => {
                (model.coordinates.iter().map(|c| c.momentum).collect(), &equations.momenta)
            }
            Flow::Hamilton { velocities, .. } | Flow::Poisson { rates: velocities } => {
                (model.coordinates.iter().map(|c| c.velocity).collect(), velocities)
            }
        };
        let values: Vec<f64> =
            values.iter().map(|&e| equations.pool.evaluate(e, &|s| point.at(s))).collect();
        point.0.extend(symbols.into_iter().zip(values));
        point
    }
}

/// How often a point is moved towards the constraints.
const CORRECTIONS: usize = 40;

impl Point {
    /// The n-th point near the start that obeys the constraints, moved onto them the shortest way
    /// (positions by Newton's method, then velocities); `None` where that does not succeed.
    pub fn on_constraints(model: &Model, equations: &Equations, n: u64) -> Option<Point> {
        let mut point = Point::near_start(model, equations, n);
        let rows = &equations.constraints;
        if rows.is_empty() {
            return Some(point);
        }
        let positions: Vec<Symbol> = equations.coordinates.iter().map(|c| c.position).collect();
        let velocities: Vec<Symbol> = equations.coordinates.iter().map(|c| c.velocity).collect();
        let held: Vec<(&ConstraintRow, Expr)> =
            rows.iter().filter_map(|c| Some((c, c.position?))).collect();
        let mut settled = held.is_empty();
        for _ in 0..CORRECTIONS {
            if settled {
                break;
            }
            let residual: Vec<f64> = held.iter().map(|(_, e)| point.value(equations, *e)).collect();
            let rows: Vec<&ConstraintRow> = held.iter().map(|(c, _)| *c).collect();
            let moved = point.correct(equations, &rows, &residual, &positions)?;
            settled = moved <= SETTLED;
        }
        let residual: Vec<f64> = rows
            .iter()
            .map(|c| {
                let terms = c.row.iter().zip(&velocities);
                let terms = terms.map(|(&a, &v)| point.value(equations, a) * point.at(v));
                terms.sum::<f64>() + point.value(equations, c.rate)
            })
            .collect();
        point.correct(equations, &rows.iter().collect::<Vec<_>>(), &residual, &velocities)?;
        for (c, &p) in equations.coordinates.iter().zip(&equations.momenta) {
            let value = point.value(equations, p);
            point.0.insert(c.momentum, value);
        }
        settled.then_some(point)
    }

    fn value(&self, equations: &Equations, e: Expr) -> f64 {
        equations.pool.evaluate(e, &|s| self.at(s))
    }

    /// Moves `symbols` by the least change that takes the residual of `rows` away, to first order;
    /// gives the greatest change
    /// relative to the largest of them.
    fn correct(
        &mut self,
        equations: &Equations,
        rows: &[&ConstraintRow],
        residual: &[f64],
        symbols: &[Symbol],
    ) -> Option<f64> {
        let matrix = DMatrix::from_fn(rows.len(), symbols.len(), |i, j| {
            self.value(equations, rows[i].row[j])
        });
        let mut matrix = matrix;
        let mut residual = DVector::from_column_slice(residual);
        // constraints have units of their own
        for i in 0..rows.len() {
            let size = matrix.row(i).amax();
            if size > 0.0 && size.is_finite() {
                matrix.row_mut(i).scale_mut(1.0 / size);
                residual[i] /= size;
            }
        }
        if !matrix.iter().chain(residual.iter()).all(|x| x.is_finite()) {
            return None;
        }
        let scale = matrix.amax();
        let change = matrix.svd(true, true).solve(&residual, 1e-12 * scale).ok()?;
        let size = symbols.iter().map(|&s| self.at(s).abs()).fold(0.0, f64::max);
        let moved = change.amax();
        for (&s, &by) in symbols.iter().zip(change.iter()) {
            let value = self.at(s);
            self.0.insert(s, value - by);
        }
        Some(if size > 0.0 { moved / size } else { moved })
    }
}

/// Numbers that look random and are the same each time.
struct Draws {
    n: u64,
    k: u64,
}

impl Draws {
    /// In (−½, ½).
    fn next(&mut self) -> f64 {
        self.k += 1;
        let mut x = self.n.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ self.k.wrapping_mul(0xD1B5_4A32);
        x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((x >> 11) as f64 + 0.5) / (1_u64 << 53) as f64 - 0.5
    }

    /// Near a value, on the scale of the value, or of its kind where that is larger.
    fn near(&mut self, value: f64, kind: f64) -> f64 {
        value + self.next() * value.abs().max(kind)
    }
}
