//! Constraints as numbers: how far a state is from satisfying them, and which of them are
//! independent.
//!
//! In: a state (q, q̇). Out: residuals of f(q, t) and A q̇ + A₀, each with the size of its terms. A
//! constraint on the velocities that is holonomic has an f too, whose level is that of the state where
//! the motion began: df = g ω, so that (f − level)/g is its residual.
//! Never here: corrections of a state; see `projection`.

use std::sync::Arc;

use super::constraint_programs::{ConstraintPrograms, GIVEN_WITHIN, JUMPS, VALUES};
use super::constraint_span::{Basis, ConstraintSpan, norm};
use super::solve::Factored;
use super::value::Evaluator;
use crate::num::DoubleDouble;

/// A row counts as dependent if its component orthogonal to the rows before it is smaller than
/// this, relative to the row.
const INDEPENDENT: f64 = 1e-9;

/// The number of passes that scale rows and columns to make entries comparable. Each pass brings
/// them closer.
const SCALINGS: usize = 3;

/// The relative error of an initial value or a parameter that was rounded to an `f64` a few times
/// between the file or the command line and here.
const ROUNDING_OF_INPUTS: f64 = 4.0 * f64::EPSILON;

/// The part of the least jump of an angle up to which a constraint counts as missed rather than turned.
const PART_OF_JUMP: f64 = 0.25;

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
    /// What each f has jumped by at the cuts of angles without a common measure, up to the last state on the constraints.
    jumped: Vec<DoubleDouble>,
}

impl Conditions {
    pub(super) fn new(programs: &ConstraintPrograms, count: usize) -> Conditions {
        let degrees = programs.values.inputs();
        Conditions {
            values: Evaluator::new(Arc::clone(&programs.values)),
            sizes: Evaluator::new(Arc::clone(&programs.sizes)),
            rounded: vec![0.0; degrees],
            degrees,
            count,
            integrated: programs.integrated.clone(),
            levels: vec![None; count],
            jumped: vec![DoubleDouble::ZERO; count],
        }
    }

    /// Takes the levels of what the constraints on the velocities keep constant from where the
    /// constraints were evaluated last.
    pub(super) fn take_levels(&mut self) {
        for k in (0..self.count).filter(|&k| self.integrated[k]) {
            self.levels[k] = Some(self.output(k, self.degrees + 1));
        }
        for k in 0..self.count {
            self.jumped[k] = DoubleDouble::ZERO;
            let (value, jumped) = (self.output(k, self.degrees + 1), self.jumps(k));
            let off = (value - jumped).high.abs();
            let wound = off > GIVEN_WITHIN * self.size(k, self.degrees + 1);
            // a state on the constraint, after turns that are not known
            self.jumped[k] = if wound && self.least_jump(k).is_finite() { value } else { jumped };
        }
    }

    /// Takes the turns of angles from where the constraints were evaluated last, a state that satisfies them.
    pub(super) fn take_turns(&mut self) {
        for k in 0..self.count {
            self.jumped[k] = self.jumps(k);
        }
    }

    /// The jumps of f at the cuts of angles without a common measure.
    fn each_jump(&self, constraint: usize) -> impl Iterator<Item = DoubleDouble> {
        let places = self.degrees + VALUES - JUMPS..self.degrees + VALUES;
        let jumps = places.map(move |place| self.output(constraint, place));
        jumps.filter(|jump| jump.high.is_normal())
    }

    /// The least of them; infinite if there are none.
    fn least_jump(&self, constraint: usize) -> f64 {
        self.each_jump(constraint).map(|jump| jump.high.abs()).fold(f64::INFINITY, f64::min)
    }

    /// What f has jumped by: as much as at the last state, unless f is off by a good part of a jump. Then each angle may have
    /// passed its cut once, either way.
    fn jumps(&self, constraint: usize) -> DoubleDouble {
        let before = self.jumped[constraint];
        let value = self.output(constraint, self.degrees + 1);
        let off = |jumped: &DoubleDouble| (value - *jumped).high.abs();
        if off(&before) <= PART_OF_JUMP * self.least_jump(constraint) {
            return before;
        }
        let mut known = vec![before];
        for jump in self.each_jump(constraint) {
            let beside = known.iter().flat_map(|&x| [x, x + jump, x - jump]);
            known = beside.collect();
        }
        known.into_iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(before)
    }

    pub(super) fn set_parameters(&mut self, parameters: &[DoubleDouble]) {
        self.values.set_parameters(parameters);
        self.sizes.set_parameters(parameters);
    }

    pub(super) fn switches(&self) -> usize {
        self.values.switches()
    }

    pub(super) fn switch(&self, i: usize) -> f64 {
        self.values.switch(i).high
    }

    /// Whether a function of the constraints has branches, as a root or an arccosine.
    pub(super) fn has_branches(&self) -> bool {
        !self.values.program().guards.is_empty()
    }

    pub(super) fn degrees(&self) -> usize {
        self.degrees
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Evaluates the constraints at a time and coordinates, which all other methods then refer to.
    pub(super) fn observe(&mut self, time: DoubleDouble, positions: &[DoubleDouble]) {
        let positions = &positions[..self.degrees];
        self.rounded.iter_mut().zip(positions).for_each(|(rounded, x)| *rounded = x.high);
        // the programs contain no equations to solve, so they cannot meet a singular matrix
        let _regular = self.values.evaluate(time, positions);
        let _regular = self.sizes.evaluate(time.high, &self.rounded);
    }

    fn output(&self, constraint: usize, place: usize) -> DoubleDouble {
        self.values.output(constraint * (self.degrees + VALUES) + place)
    }

    /// The size of the terms of the value at this place.
    fn size(&self, constraint: usize, place: usize) -> f64 {
        self.sizes.output(2 * (constraint * (self.degrees + VALUES) + place))
    }

    /// The sensitivity to its inputs of the value at this place; zero where it cannot be computed,
    /// as at the branch point of a root.
    fn inputs(&self, constraint: usize, place: usize) -> f64 {
        let inputs = self.sizes.output(2 * (constraint * (self.degrees + VALUES) + place) + 1);
        if inputs.is_finite() { inputs } else { 0.0 }
    }

    pub(super) fn entry(&self, constraint: usize, coordinate: usize) -> DoubleDouble {
        self.output(constraint, coordinate)
    }

    /// A₀ of one constraint.
    pub(super) fn rate(&self, constraint: usize) -> DoubleDouble {
        self.output(constraint, self.degrees)
    }

    /// f of a holonomic constraint, on the nearest turn of an angle in it, or what f has moved from its level over g; zero for
    /// others.
    pub(super) fn position(&self, constraint: usize) -> Residual {
        let place = self.degrees + 1;
        let turn = self.output(constraint, place + 2);
        let value = self.output(constraint, place);
        let turns = (value / turn).high.round();
        let jumped = if turns.is_normal() { turn * turns } else { self.jumps(constraint) };
        let f = Residual {
            value: value - jumped,
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
