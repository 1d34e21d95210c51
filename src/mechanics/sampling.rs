//! Points of phase space near the start, at which identities without a proof are checked
//! numerically.
//!
//! In: a model with its equations. Out: reproducible values for every symbol of q, q̇, p, t and the
//! parameters, which satisfy the constraints on request. Never here: motion.

use nalgebra::{DMatrix, DVector};

use super::equations::{ConstraintRow, Equations, Flow};
use super::rigid_body::body_values;
use super::valuation::Valuation;
use crate::expr::{Expr, Symbol};
use crate::model::Model;
use crate::num::math;

/// The number of points at which an identity has to hold.
pub const POINTS: usize = 20;

/// The number of points tried in order to find that many.
pub const TRIES: u64 = 400;

/// The distances of the points from the start, in turn, relative to the largest initial value of
/// their kind.
const WIDTHS: [f64; 4] = [1.0, 0.1, 1.0, 0.01];

/// The distance of points beside the start, relative to each initial value.
const BESIDE: f64 = 0.02;

/// The distances of those at which an identity that holds near the start is evaluated as well.
const FAR: [f64; 3] = [10.0, 100.0, 1000.0];

/// The number of points far from the start.
pub(super) const FAR_POINTS: u64 = 60;

/// A term of however small a coefficient, as 10⁻³⁰ x⁹, is large at one of so many powers of ten; beyond them squares and fourth
/// powers have no value.
const DECADES: u64 = 36;

/// The number of points at any distance: those far from the start, and three at each power of ten.
pub const ANY_POINTS: u64 = FAR_POINTS + 3 * DECADES;

/// The scales tried in turn if all coordinates, or all velocities, start at 0.
const SIZES: [f64; 6] = [1.0, 1.0, 1e-3, 1e3, 1e-6, 1e-9];

/// A point is on the constraints if a correction moves it by no more than this fraction of its
/// size.
const SETTLED: f64 = 1e-14;

impl Valuation {
    /// The n-th point near the start, at the file's parameters. The momenta of a Lagrangian system
    /// follow from its velocities; the velocities of any other system follow from its state.
    pub fn near_start(model: &Model, equations: &Equations, n: u64) -> Valuation {
        let width = WIDTHS[(n % WIDTHS.len() as u64) as usize];
        Valuation::around_start(model, equations, n, (n, width))
    }

    pub(super) fn at_start(model: &Model, equations: &Equations) -> Valuation {
        Valuation::around_start(model, equations, 0, (0, 0.0))
    }

    /// The n-th point at distances of up to a hundredth of each initial value by itself, whatever the others are: a length of
    /// 5e-11 beside an angle keeps its sign. Where a value begins at 0, as those near the start.
    pub(super) fn beside_start(model: &Model, equations: &Equations, n: u64) -> Valuation {
        let (start, near) =
            (Valuation::at_start(model, equations), Valuation::near_start(model, equations, 4 * n));
        let moving = model.coordinates.iter().flat_map(|c| [c.position, c.velocity, c.momentum]);
        let mut draws = Draws { n, k: 0 };
        let values: Vec<(Symbol, f64)> = moving
            .map(|symbol| {
                let own = start.at(symbol);
                let value =
                    if own == 0.0 { near.at(symbol) } else { own * (1.0 + BESIDE * draws.next()) };
                (symbol, value)
            })
            .collect();
        start.with(values)
    }

    /// The n-th point far from the start, where an identity may fail that holds near it, as that of max(0, x − 30) or
    /// exp(−(x − 50)²) does. A function may have no value there.
    pub(super) fn far_from_start(model: &Model, equations: &Equations, n: u64) -> Valuation {
        let count = FAR.len() as u64;
        Valuation::around_start(model, equations, n, (n / count, FAR[(n % count) as usize]))
    }

    /// The n-th point at any distance from the start: first those far from it, which are close
    /// enough to each other to see what is there alone, then others by powers of ten.
    pub fn at_any_distance(model: &Model, equations: &Equations, n: u64) -> Valuation {
        let Some(n) = n.checked_sub(FAR_POINTS) else {
            return Valuation::far_from_start(model, equations, n);
        };
        let width = math::powi(10.0, (n % DECADES) as i32 + 1);
        Valuation::around_start(model, equations, n, (n / DECADES, width))
    }

    /// The n-th point at distances of up to `width` from the start, relative to the largest initial value of a kind, or to the scale of
    /// this number if all are 0.
    fn around_start(
        model: &Model,
        equations: &Equations,
        n: u64,
        (scale, width): (u64, f64),
    ) -> Valuation {
        let parameters = model.parameter_values();
        let body = equations.supplements.body.as_ref();
        let body = body_values(model, &equations.pool, body, &parameters);
        let mut point = Valuation::of_parameters(model, &parameters).with(body);
        let mut draws = Draws { n, k: 0 };
        let initial = |point: &Valuation, e| {
            let value = point.value(&equations.pool, e);
            if value.is_finite() { value } else { 0.0 }
        };
        let starts: Vec<(f64, f64)> = model
            .coordinates
            .iter()
            .map(|c| (initial(&point, c.initial), initial(&point, c.initial_rate)))
            .collect();
        let span = model.run.until.map_or(1.0, |until| (until - model.run.start).abs().max(1.0));
        let later = span * draws.next();
        let time = model.run.start + if width > 0.0 { later } else { 0.0 };
        point.set(model.symbols.time, time);
        let largest = |of: fn(&(f64, f64)) -> f64| {
            let size = starts.iter().map(|start| of(start).abs()).fold(0.0, f64::max);
            // if everything starts at 0, nothing indicates how large it will become
            if size > 0.0 { size } else { SIZES[(scale % SIZES.len() as u64) as usize] }
        };
        let (length, speed) = (largest(|start| start.0), largest(|start| start.1));
        for (c, &(position, rate)) in model.coordinates.iter().zip(&starts) {
            let rate_symbol = if model.is_lagrangian() { c.velocity } else { c.momentum };
            point.set(c.position, draws.near(position, width * length));
            point.set(rate_symbol, draws.near(rate, width * speed));
        }
        let (symbols, values): (Vec<Symbol>, _) = match &equations.flow {
            Flow::Lagrange { .. } => {
                (model.coordinates.iter().map(|c| c.momentum).collect(), &equations.momenta)
            }
            Flow::Hamilton { velocities, .. } | Flow::Poisson { rates: velocities } => {
                (model.coordinates.iter().map(|c| c.velocity).collect(), velocities)
            }
        };
        let values: Vec<f64> = values.iter().map(|&e| point.value(&equations.pool, e)).collect();
        point.with(symbols.into_iter().zip(values))
    }
}

/// The largest number of corrections towards the constraints.
const CORRECTIONS: usize = 40;

impl Valuation {
    /// The n-th point near the start that satisfies the constraints, projected onto them along the
    /// shortest path (positions by Newton's method, then velocities). Returns `None` if that does
    /// not succeed.
    pub fn on_constraints(model: &Model, equations: &Equations, n: u64) -> Option<Valuation> {
        let mut point = Valuation::near_start(model, equations, n);
        let rows = &equations.constraints;
        if rows.is_empty() {
            return Some(point);
        }
        let positions: Vec<Symbol> = equations.coordinates.iter().map(|c| c.position).collect();
        let velocities: Vec<Symbol> = equations.coordinates.iter().map(|c| c.velocity).collect();
        let holonomic: Vec<(&ConstraintRow, Expr)> =
            rows.iter().filter_map(|c| Some((c, c.position?))).collect();
        let mut settled = holonomic.is_empty();
        for _ in 0..CORRECTIONS {
            if settled {
                break;
            }
            let residual: Vec<f64> =
                holonomic.iter().map(|(_, e)| point.value(&equations.pool, *e)).collect();
            let rows: Vec<&ConstraintRow> = holonomic.iter().map(|(c, _)| *c).collect();
            let moved = point.correct(equations, &rows, &residual, &positions)?;
            settled = moved <= SETTLED;
        }
        let residual: Vec<f64> = rows
            .iter()
            .map(|c| {
                let terms = c.row.iter().zip(&velocities);
                let terms = terms.map(|(&a, &v)| point.value(&equations.pool, a) * point.at(v));
                terms.sum::<f64>() + point.value(&equations.pool, c.rate)
            })
            .collect();
        point.correct(equations, &rows.iter().collect::<Vec<_>>(), &residual, &velocities)?;
        for (c, &p) in equations.coordinates.iter().zip(&equations.momenta) {
            let value = point.value(&equations.pool, p);
            point.set(c.momentum, value);
        }
        settled.then_some(point)
    }

    /// Changes `symbols` by the least amount that removes the residual of `rows`, to first order.
    /// Returns the greatest change relative to the largest of them.
    fn correct(
        &mut self,
        equations: &Equations,
        rows: &[&ConstraintRow],
        residual: &[f64],
        symbols: &[Symbol],
    ) -> Option<f64> {
        let matrix = DMatrix::from_fn(rows.len(), symbols.len(), |i, j| {
            self.value(&equations.pool, rows[i].row[j])
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
            self.set(s, value - by);
        }
        Some(if size > 0.0 { moved / size } else { moved })
    }
}

/// A reproducible sequence of pseudo-random numbers.
struct Draws {
    n: u64,
    k: u64,
}

impl Draws {
    /// A number in (−½, ½).
    fn next(&mut self) -> f64 {
        self.k += 1;
        let mut x = self.n.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ self.k.wrapping_mul(0xD1B5_4A32);
        x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((x >> 11) as f64 + 0.5) / (1_u64 << 53) as f64 - 0.5
    }

    /// A number near a value, on the scale of the value, or of its kind if that is larger.
    fn near(&mut self, value: f64, kind: f64) -> f64 {
        value + self.next() * value.abs().max(kind)
    }
}
