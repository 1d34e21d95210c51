//! Constraints as numbers: how far a state is from satisfying them, and which of them are
//! independent.
//!
//! In: a state (q, q̇). Out: residuals of f(q, t) and A q̇ + A₀, each with the size of its terms. A
//! constraint on the velocities that is holonomic has an f too, whose level is that of the state where
//! the motion began: df = g ω, so that (f − level)/g is its residual.
//! Never here: corrections of a state; see `projection`.

use std::sync::Arc;

use super::program::Program;
use super::rhs::ProgramBuilder;
use super::solve::Factored;
use super::value::Evaluator;
use crate::expr::{Expr, FunctionId, Node, Pool, Symbol};
use crate::mechanics::Holonomy;
use crate::num::{DoubleDouble, Number};

/// A row counts as dependent if its component orthogonal to the rows before it is smaller than
/// this, relative to the row.
const INDEPENDENT: f64 = 1e-9;

/// The orientation of rows is not trusted if an orthogonal component is smaller than this: the rounding of
/// an entry may be 1e-15 of its row.
const SPANS: f64 = 1e-12;

/// The number of passes that scale rows and columns to make entries comparable. Each pass brings
/// them closer.
const SCALINGS: usize = 3;

/// The relative error of an initial value or a parameter that was rounded to an `f64` a few times
/// between the file or the command line and here.
const ROUNDING_OF_INPUTS: f64 = 4.0 * f64::EPSILON;

/// The programs of the constraints, as functions of (q, t).
#[derive(Clone, Debug)]
pub(super) struct Programs {
    /// A, A₀, f and g of each constraint.
    values: Arc<Program>,
    /// For each of these values the size of its terms, then its sensitivity to its inputs, Σ |s
    /// ∂/∂s|.
    sizes: Arc<Program>,
    /// The constraints on the velocities that have an f.
    integrated: Vec<bool>,
}

impl Programs {
    pub(super) fn of(builder: &mut ProgramBuilder<'_>) -> Result<Programs, Symbol> {
        let mut values = Vec::new();
        let mut integrated = Vec::new();
        for (k, row) in builder.equations.constraints.iter().enumerate() {
            values.extend_from_slice(&row.row);
            values.push(row.rate);
            let known = integral(builder, k);
            integrated.push(known.is_some());
            let (f, g) = known.unwrap_or((row.position.unwrap_or(Expr::ZERO), Expr::ONE));
            values.extend([f, g]);
        }
        let pool = &mut builder.pool;
        let sizes = values.iter().flat_map(|&e| [pool.magnitude(e), pool.size_of_inputs(e)]);
        let sizes: Vec<Expr> = sizes.collect();
        let (values, sizes) = (program(builder, &values)?, program(builder, &sizes)?);
        Ok(Programs { values, sizes, integrated })
    }
}

/// f and g of a constraint on the velocities that is holonomic by itself, whatever the parameters.
fn integral(builder: &mut ProgramBuilder<'_>, k: usize) -> Option<(Expr, Expr)> {
    let equations = builder.equations;
    let Holonomy::Holonomic { constant: Some(f), together: false, at_these_parameters: false } =
        *equations.supplements.holonomy.get(k)?
    else {
        return None;
    };
    let pool = &mut builder.pool;
    let mut moving: Vec<Symbol> = equations.coordinates.iter().map(|c| c.position).collect();
    moving.push(equations.symbols.time);
    if !is_entire(pool, f, &moving) {
        return None;
    }
    let (mut along, mut square) = (Vec::new(), Vec::new());
    for (c, &a) in equations.coordinates.iter().zip(&equations.constraints[k].row) {
        let slope = pool.derivative(f, c.position);
        along.push(pool.mul(slope, a));
        square.push(pool.powi(a, 2));
    }
    let (along, square) = (pool.sum(&along), pool.sum(&square));
    let g = pool.div(along, square);
    Some((f, pool.simplify(g)))
}

/// Whether an expression is smooth everywhere and has one value: an angle of a point jumps, and a
/// quotient has a pole, where the constraint on the velocities has neither.
fn is_entire(pool: &Pool, f: Expr, moving: &[Symbol]) -> bool {
    let varies = |e: Expr| pool.depends_on_any(e, moving);
    pool.reachable(&[f]).into_iter().filter(|&e| varies(e)).all(|e| match pool.node(e) {
        Node::Product(_, factors) => {
            let whole = |n: Number| n.as_integer().is_some_and(|n| n >= 0);
            factors.iter().all(|&(base, n)| !varies(base) || whole(n))
        }
        Node::Call(function, _) => matches!(
            function,
            FunctionId::Sin
                | FunctionId::Cos
                | FunctionId::Exp
                | FunctionId::Sinh
                | FunctionId::Cosh
                | FunctionId::Tanh
        ),
        Node::Power(..) => false,
        Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Sum(..) => true,
    })
}

fn program(builder: &mut ProgramBuilder<'_>, outputs: &[Expr]) -> Result<Arc<Program>, Symbol> {
    let equations = builder.equations;
    let mut lowering = builder.lowering();
    for c in &equations.coordinates {
        let register = lowering.input();
        lowering.bind(c.position, register);
    }
    let outputs = lowering.lower_all(outputs);
    lowering.finish(outputs)
}

/// A residual, and the sizes it is measured by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Residual {
    pub(super) value: DoubleDouble,
    /// The size of the terms of the sum.
    pub(super) size: f64,
    /// The sensitivity to the inputs relative to their sizes, Σ |s ∂/∂s|. It is also large where
    /// all terms vanish, as those of sin θ do at π.
    pub(super) inputs: f64,
}

impl Residual {
    /// The residual relative to its terms and inputs; zero if the residual is zero.
    pub(super) fn relative(self) -> f64 {
        let value = self.value.high.abs();
        if value == 0.0 { 0.0 } else { value / (self.size + self.inputs) }
    }

    /// The residual of given values relative to its terms, beyond what rounding of the values
    /// explains.
    pub(super) fn missed(self) -> f64 {
        let beyond = self.value.high.abs() - ROUNDING_OF_INPUTS * self.inputs;
        if beyond <= 0.0 { 0.0 } else { beyond / self.size }
    }
}

/// The constraints of one system at one set of parameters.
#[derive(Clone, Debug)]
pub(super) struct Conditions {
    values: Evaluator<DoubleDouble>,
    sizes: Evaluator<f64>,
    rounded: Vec<f64>,
    degrees: usize,
    count: usize,
    integrated: Vec<bool>,
    /// The level of each f that was integrated, once a motion has begun.
    levels: Vec<Option<DoubleDouble>>,
}

impl Conditions {
    pub(super) fn new(programs: &Programs, count: usize) -> Conditions {
        let degrees = programs.values.inputs();
        Conditions {
            values: Evaluator::new(Arc::clone(&programs.values)),
            sizes: Evaluator::new(Arc::clone(&programs.sizes)),
            rounded: vec![0.0; degrees],
            degrees,
            count,
            integrated: programs.integrated.clone(),
            levels: vec![None; count],
        }
    }

    /// Takes the levels of what the constraints on the velocities keep constant from where the
    /// constraints were looked at last.
    pub(super) fn take_levels(&mut self) {
        for k in (0..self.count).filter(|&k| self.integrated[k]) {
            self.levels[k] = Some(self.output(k, self.degrees + 1));
        }
    }

    pub(super) fn set_parameters(&mut self, parameters: &[DoubleDouble]) {
        self.values.set_parameters(parameters);
        self.sizes.set_parameters(parameters);
    }

    /// The number of coordinates.
    pub(super) fn degrees(&self) -> usize {
        self.degrees
    }

    /// The number of constraints.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Evaluates the constraints at a time and coordinates, which all other methods then refer to.
    pub(super) fn look(&mut self, time: DoubleDouble, positions: &[DoubleDouble]) {
        let positions = &positions[..self.degrees];
        self.rounded.iter_mut().zip(positions).for_each(|(rounded, x)| *rounded = x.high);
        // the programs contain no equations to solve, so they cannot meet a singular matrix
        let _regular = self.values.evaluate(time, positions);
        let _regular = self.sizes.evaluate(time.high, &self.rounded);
    }

    fn output(&self, constraint: usize, place: usize) -> DoubleDouble {
        self.values.output(constraint * (self.degrees + 3) + place)
    }

    /// The size of the terms of the value at this place.
    fn size(&self, constraint: usize, place: usize) -> f64 {
        self.sizes.output(2 * (constraint * (self.degrees + 3) + place))
    }

    /// The sensitivity to its inputs of the value at this place; zero where it cannot be computed,
    /// as at the branch point of a root.
    fn inputs(&self, constraint: usize, place: usize) -> f64 {
        let inputs = self.sizes.output(2 * (constraint * (self.degrees + 3) + place) + 1);
        if inputs.is_finite() { inputs } else { 0.0 }
    }

    /// The entry of A for one constraint and one coordinate.
    pub(super) fn entry(&self, constraint: usize, coordinate: usize) -> DoubleDouble {
        self.output(constraint, coordinate)
    }

    /// A₀ of one constraint.
    pub(super) fn rate(&self, constraint: usize) -> DoubleDouble {
        self.output(constraint, self.degrees)
    }

    /// f of a holonomic constraint, or what f has moved from its level over g; zero for others.
    pub(super) fn position(&self, constraint: usize) -> Residual {
        let place = self.degrees + 1;
        let f = Residual {
            value: self.output(constraint, place),
            size: self.size(constraint, place),
            inputs: self.inputs(constraint, place),
        };
        if !self.integrated[constraint] {
            return f;
        }
        let g = self.output(constraint, place + 1);
        let known = self.levels[constraint].filter(|_| g.high != 0.0 && g.is_finite());
        let Some(level) = known else {
            return Residual { value: DoubleDouble::ZERO, size: 1.0, inputs: 0.0 };
        };
        let scale = g.high.abs();
        Residual {
            value: (f.value - level) / g,
            size: (f.size + level.high.abs()) / scale,
            inputs: f.inputs / scale,
        }
    }

    /// A q̇ + A₀.
    pub(super) fn velocity(&self, constraint: usize, velocities: &[DoubleDouble]) -> Residual {
        let mut value = self.output(constraint, self.degrees);
        let mut size = self.size(constraint, self.degrees);
        let mut inputs = self.inputs(constraint, self.degrees);
        for (i, &v) in velocities.iter().enumerate() {
            let speed = v.high.abs();
            value = value + self.entry(constraint, i) * v;
            size += self.size(constraint, i) * speed;
            inputs += (self.size(constraint, i) + self.inputs(constraint, i)) * speed;
        }
        Residual { value, size, inputs }
    }

    /// The multipliers of least norm of all `active` constraints that are equivalent to those of
    /// the `enforced` ones: λ = B (BᵀB)⁻¹ G ν, as in `kkt`.
    pub(super) fn least(
        &self,
        active: &[bool],
        enforced: &[bool],
        multipliers: Vec<DoubleDouble>,
    ) -> Vec<DoubleDouble> {
        if active == enforced {
            return multipliers;
        }
        let rows = |which: &[bool]| (0..self.count).filter(|&k| which[k]).collect::<Vec<_>>();
        let (all, independent) = (rows(active), rows(enforced));
        let product = |a: usize, b: usize| {
            let terms = (0..self.degrees).map(|i| self.entry(a, i) * self.entry(b, i));
            terms.fold(DoubleDouble::ZERO, |sum, x| sum + x)
        };
        let sum = |terms: &mut dyn Iterator<Item = DoubleDouble>| {
            terms.fold(DoubleDouble::ZERO, |s, x| s + x)
        };
        let b: Vec<Vec<DoubleDouble>> =
            all.iter().map(|&k| independent.iter().map(|&j| product(k, j)).collect()).collect();
        let force =
            |&j: &usize| sum(&mut independent.iter().map(|&k| product(j, k) * multipliers[k]));
        let mut weights: Vec<DoubleDouble> = independent.iter().map(force).collect();
        let mut factored = Factored::new(independent.len());
        if !factored.factor(|i, j| sum(&mut b.iter().map(|row| row[i] * row[j]))) {
            return multipliers;
        }
        factored.solve(&mut weights);
        let mut least = vec![DoubleDouble::ZERO; self.count];
        for (&k, row) in all.iter().zip(&b) {
            least[k] = sum(&mut row.iter().zip(&weights).map(|(&x, &w)| x * w));
        }
        least
    }

    /// Returns which of the `active` constraints are independent of those before them, by the
    /// Gram–Schmidt process.
    pub(super) fn independent(&self, active: &[bool]) -> Vec<bool> {
        let units = self.units(active);
        let mut basis = Basis { rows: Vec::new(), volume: 1.0 };
        let mut chosen = vec![false; self.count];
        for k in (0..self.count).filter(|&k| active[k]) {
            // a row of zeros means a singular configuration, not a redundant constraint
            chosen[k] = basis.add(self.row(k, &units)).is_none_or(|left| left > INDEPENDENT);
            if !chosen[k] {
                basis.drop_last();
            }
        }
        chosen
    }

    /// Selects `count` of the `active` constraints, each the one with the largest component
    /// orthogonal to those selected before. Returns `None` if there are not enough.
    pub(super) fn most_independent(&self, active: &[bool], count: usize) -> Option<Vec<bool>> {
        let mut chosen = vec![false; self.count];
        for _ in 0..count {
            let mut best: Option<(f64, usize)> = None;
            let open = (0..self.count).filter(|&k| active[k] && !chosen[k]);
            for k in open.collect::<Vec<_>>() {
                chosen[k] = true;
                let strength = self.strength(active, &chosen);
                chosen[k] = false;
                if strength > INDEPENDENT && best.is_none_or(|(most, _)| strength > most) {
                    best = Some((strength, k));
                }
            }
            chosen[best?.1] = true;
        }
        Some(chosen)
    }

    /// The smallest component that a row of the `enforced` constraints has orthogonal to those before
    /// it, relative to the largest row of the `active` ones.
    pub(super) fn strength(&self, active: &[bool], enforced: &[bool]) -> f64 {
        let units = self.units(active);
        let rows = |which: &[bool]| -> Vec<Vec<f64>> {
            (0..self.count).filter(|&k| which[k]).map(|k| self.row(k, &units)).collect()
        };
        let largest = rows(active).iter().map(|row| norm(row)).fold(0.0, f64::max);
        let mut basis = Basis { rows: Vec::new(), volume: 1.0 };
        let own = rows(enforced).into_iter().map(|row| {
            let size = norm(&row);
            basis.add(row).unwrap_or(0.0) * (size / largest)
        });
        own.fold(1.0, f64::min)
    }

    /// How independent the `enforced` constraints are: the least sine of the angle between a row and
    /// the span of those before it; zero if a row vanishes.
    pub(super) fn independence(&self, enforced: &[bool]) -> f64 {
        let units = self.units(enforced);
        let mut basis = Basis { rows: Vec::new(), volume: 1.0 };
        let rows = (0..self.count).filter(|&k| enforced[k]).map(|k| self.row(k, &units));
        rows.map(|row| basis.add(row).unwrap_or(0.0)).fold(1.0, f64::min)
    }

    /// The space spanned by the rows of the `enforced` constraints, with its orientation, or `None` if
    /// the rows are dependent. Uses the given units of the coordinates, or else units that make the
    /// entries comparable.
    pub(super) fn span(&self, enforced: &[bool], units: Option<&[f64]>) -> Option<ConstraintSpan> {
        let units = units.map_or_else(|| self.units(enforced), <[f64]>::to_vec);
        let rows = (0..self.count).filter(|&k| enforced[k]).map(|k| self.row(k, &units));
        let basis = Basis::spanned_by(rows)?;
        Some(ConstraintSpan { rows: basis.rows, volume: basis.volume, units })
    }

    /// The row of a constraint in units of the coordinates, with rounding errors set to zero.
    fn row(&self, constraint: usize, units: &[f64]) -> Vec<f64> {
        (0..self.degrees).map(|i| self.clean(constraint, i) * units[i]).collect()
    }

    /// An entry of A, or zero if rounding of its inputs explains its value.
    fn clean(&self, constraint: usize, coordinate: usize) -> f64 {
        let entry = self.entry(constraint, coordinate).high;
        let rounding = ROUNDING_OF_INPUTS * self.inputs(constraint, coordinate);
        if entry.abs() <= rounding { 0.0 } else { entry }
    }

    /// Units of the coordinates in which the entries of the rows are comparable, so that the choice
    /// of metres or radians does not matter (D. Ruiz, RAL-TR-2001-034: rows and columns are scaled
    /// in turn).
    fn units(&self, which: &[bool]) -> Vec<f64> {
        let rows: Vec<Vec<f64>> = (0..self.count)
            .filter(|&k| which[k])
            .map(|k| (0..self.degrees).map(|i| self.clean(k, i).abs()).collect())
            .collect();
        let inverse = |x: f64| Some(1.0 / x).filter(|x| x.is_normal()).unwrap_or(1.0);
        let mut units = vec![1.0; self.degrees];
        for _ in 0..SCALINGS {
            let scaled =
                |row: &Vec<f64>| row.iter().zip(&units).map(|(a, c)| a * c).fold(0.0, f64::max);
            let scales: Vec<f64> = rows.iter().map(|row| inverse(scaled(row))).collect();
            for (i, unit) in units.iter_mut().enumerate() {
                *unit = inverse(
                    rows.iter().zip(&scales).map(|(row, s)| row[i] * s).fold(0.0, f64::max),
                );
            }
        }
        units
    }
}

/// Rows orthonormalised one after the other.
#[derive(Clone, Debug)]
struct Basis {
    rows: Vec<Vec<f64>>,
    /// The volume spanned by the rows before normalisation.
    volume: f64,
}

impl Basis {
    /// Adds a row. Returns the sine of its angle to the span of those before it, or `None` if the
    /// row vanishes.
    fn add(&mut self, mut rest: Vec<f64>) -> Option<f64> {
        let size = norm(&rest);
        if size == 0.0 || !size.is_finite() {
            self.rows.push(vec![0.0; rest.len()]);
            return None;
        }
        for x in &mut rest {
            *x /= size;
        }
        // two passes are enough (Golub & Van Loan, Matrix Computations, 5.2.9)
        for other in self.rows.iter().chain(&self.rows) {
            let part: f64 = rest.iter().zip(other).map(|(x, y)| x * y).sum();
            rest.iter_mut().zip(other).for_each(|(x, y)| *x -= part * y);
        }
        let left = norm(&rest);
        self.volume *= size * left;
        let scale = if left > 0.0 { 1.0 / left } else { 0.0 };
        self.rows.push(rest.iter().map(|x| x * scale).collect());
        Some(left)
    }

    /// The basis of the span of rows, or `None` if they are dependent.
    fn spanned_by(rows: impl Iterator<Item = Vec<f64>>) -> Option<Basis> {
        let mut basis = Basis { rows: Vec::new(), volume: 1.0 };
        for row in rows {
            basis.add(row).filter(|&left| left > SPANS)?;
        }
        Some(basis)
    }

    fn drop_last(&mut self) {
        self.rows.pop();
    }
}

/// The space spanned by the rows of constraints, with its orientation.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct ConstraintSpan {
    /// Orthonormal rows, with the orientation of the constraints' own rows.
    rows: Vec<Vec<f64>>,
    /// The volume spanned by the constraints' own rows.
    volume: f64,
    units: Vec<f64>,
}

impl ConstraintSpan {
    /// The units of the coordinates the span was computed in.
    pub(super) fn units(&self) -> &[f64] {
        &self.units
    }

    /// The volume that the rows of the constraints span, in these units.
    pub(super) fn volume(&self) -> f64 {
        self.volume
    }

    /// The cosine of the angle between two such spaces: 1 if they are equal, −1 if they are equal
    /// with the opposite orientation. It is the determinant of the rows' inner products.
    pub(super) fn cosine(&self, other: &ConstraintSpan) -> f64 {
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let mut matrix: Vec<Vec<f64>> =
            self.rows.iter().map(|a| other.rows.iter().map(|b| product(a, b)).collect()).collect();
        let n = matrix.len();
        let mut determinant = 1.0;
        for k in 0..n {
            let largest = (k..n).max_by(|&a, &b| matrix[a][k].abs().total_cmp(&matrix[b][k].abs()));
            let Some(best) = largest.filter(|&best| matrix[best][k] != 0.0) else { return 0.0 };
            if best != k {
                matrix.swap(best, k);
                determinant = -determinant;
            }
            determinant *= matrix[k][k];
            for i in k + 1..n {
                let factor = matrix[i][k] / matrix[k][k];
                for j in k..n {
                    let product = factor * matrix[k][j];
                    matrix[i][j] -= product;
                }
            }
        }
        determinant
    }
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_directions_a_trillionth_apart_span_a_plane() {
        let spans = |angle: f64| {
            let rows = [vec![1.0, 0.0], vec![3.0, 3.0 * angle]];
            Basis::spanned_by(rows.into_iter()).map(|basis| basis.volume)
        };
        assert_eq!(spans(0.0), None);
        assert_eq!(spans(0.9e-12), None);
        assert_eq!(spans(1.1e-12), Some(3.0 * 1.1e-12));
    }
}
