//! Whether a transformation is canonical: M 𝕁 Mᵀ = 𝕁 at points near the start and far from it, or proved by the brackets of the
//! new variables.
//!
//! In: a [`PhaseMap`]. Out: its [`CanonicalVerdict`], the same in all units. Never here: how the map is solved.
//! Source: *The Principles of Dynamics*, §§ 3.2.1, 3.3.

use nalgebra::DMatrix;

use super::canonical::PhaseMap;
use super::determinant::singular;
use super::equations::Equations;
use super::implicit_map::{departure, guesses};
use super::sampling::{ANY_POINTS, POINTS};
use super::valuation::Valuation;
use crate::expr::{Expr, FunctionId, Node, Pool, Symbol, Zero};
use crate::model::Model;
use crate::num::Number;

/// An entry of M may be off by so many ε of the size of its terms.
const SIZED: f64 = 1e3;

/// The residual below which a map without a proof is canonical, unless rounding leaves more of it; for one that is solved for,
/// relative to the size of M, as its image is.
const CANONICAL: f64 = 1e-10;

/// Points at which M is larger are left out while there are others: they are next to where the map
/// breaks down.
const LARGEST: f64 = 1e4;

/// Whether a map is canonical.
#[derive(Clone, Debug)]
pub struct CanonicalVerdict {
    /// Whether it is: proved, or to rounding at the points tried.
    pub canonical: bool,
    /// Whether that holds by proof, and not only at points.
    pub proved: bool,
    /// The largest entry of |M 𝕁 Mᵀ − 𝕁| at the points, in units in which conjugate variables are of like size; `None` if there
    /// are none.
    pub residual: Option<f64>,
    /// c of M 𝕁 Mᵀ = c 𝕁, if c is another number than 1.
    pub valence: Option<Expr>,
    /// The brackets that are not what they should be.
    pub failing: Vec<FailingBracket>,
    /// The brackets that are what they should be at these values of the parameters, and not at others.
    pub only_here: Vec<FailingBracket>,
    /// Why it is not canonical, or no map.
    pub why: Option<String>,
}

/// A bracket of new variables that is not that of canonical variables.
#[derive(Clone, Debug)]
pub struct FailingBracket {
    /// The two variables.
    pub pair: [Symbol; 2],
    /// Their bracket.
    pub is: Expr,
    /// What it should be.
    pub expected: Expr,
}

/// Units of the old variables in which those of a pair are of like size: √(|q|/|p|) of each pair, and its reciprocal. A common
/// unit of action is left out, as it changes no entry of M of a map that keeps it.
struct PairUnits(Vec<f64>);

impl PairUnits {
    /// Those of the largest values at some points.
    fn of(old: &[Symbol], points: &[Valuation]) -> PairUnits {
        let largest = |s: Symbol| points.iter().map(|at| at.at(s).abs()).fold(0.0, f64::max);
        let (positions, momenta) = old.split_at(old.len() / 2);
        let ratios = positions.iter().zip(momenta).map(|(&q, &p)| largest(q) / largest(p));
        let units = ratios.map(|ratio| {
            let is_known = ratio > 0.0 && ratio.is_finite();
            if is_known { ratio.sqrt() } else { 1.0 }
        });
        let units: Vec<f64> = units.collect();
        let reciprocals = units.iter().map(|unit| 1.0 / unit);
        PairUnits(units.iter().copied().chain(reciprocals).collect())
    }

    /// Puts M into these units of the old variables, and units of the new ones in which those of a pair have rows of like size:
    /// brackets of canonical variables stay 1. Other matrices of its shape are put into the same.
    fn apply(&self, matrices: [&mut DMatrix<f64>; 2]) {
        let [tangent, other] = matrices;
        for (k, &unit) in self.0.iter().enumerate() {
            tangent.column_mut(k).scale_mut(unit);
            other.column_mut(k).scale_mut(unit);
        }
        let n = self.0.len() / 2;
        for i in 0..n {
            let ratio = tangent.row(i).norm() / tangent.row(n + i).norm();
            if ratio > 0.0 && ratio.is_finite() {
                let unit = ratio.sqrt();
                for matrix in [&mut *tangent, &mut *other] {
                    matrix.row_mut(i).unscale_mut(unit);
                    matrix.row_mut(n + i).scale_mut(unit);
                }
            }
        }
    }
}

/// What M at one point says.
struct TangentTest {
    /// The largest entry of M.
    largest: f64,
    /// The largest entry of |M 𝕁 Mᵀ − 𝕁|.
    residual: f64,
    /// What it may be where the map is canonical.
    allowed: f64,
}

impl TangentTest {
    fn passes(&self) -> bool {
        self.residual <= self.allowed
    }
}

impl PhaseMap {
    /// What M says at a point with its image; `None` where the map breaks down.
    fn test_at(&self, pool: &Pool, units: &PairUnits, at: &Valuation) -> Option<TangentTest> {
        let mut matrix = self.tangent(pool, at)?;
        let (rows, columns) = matrix.shape();
        if !self.is_explicit() {
            units.apply([&mut matrix, &mut DMatrix::zeros(rows, columns)]);
            let allowed = CANONICAL * matrix.norm_squared().max(1.0);
            let (largest, residual) = (matrix.amax(), departure(&matrix));
            return Some(TangentTest { largest, residual, allowed });
        }
        // entries whose terms cancel have an error of their own
        let mut sizes = DMatrix::from_fn(rows, columns, |i, j| at.size(pool, self.by_old[i][j]));
        units.apply([&mut matrix, &mut sizes]);
        let rounding = SIZED * f64::EPSILON * sizes.norm_squared();
        let (largest, residual) = (matrix.amax(), departure(&matrix));
        Some(TangentTest { largest, residual, allowed: rounding.max(CANONICAL) })
    }

    /// Withdraws the verdict on an explicit map that fails far from the start.
    fn evaluate_far_away(
        &self,
        model: &Model,
        equations: &Equations,
        units: &PairUnits,
        verdict: &mut CanonicalVerdict,
    ) {
        let pool = &equations.pool;
        for n in 0..ANY_POINTS {
            let point = Valuation::at_any_distance(model, equations, n);
            let image = self.image(pool, &point);
            let Some(test) = image.and_then(|at| self.test_at(pool, units, &at)) else { continue };
            if test.largest <= LARGEST && !test.passes() {
                verdict.canonical = false;
                verdict.residual = Some(verdict.residual.unwrap_or(0.0).max(test.residual));
                return;
            }
        }
    }

    /// Whether the map is canonical.
    pub fn verdict(&self, model: &Model, equations: &mut Equations) -> CanonicalVerdict {
        let images = self.images(model, equations, 2 * POINTS);
        let units = PairUnits::of(&self.old, &images);
        let pool = &equations.pool;
        let tests = images.iter().filter_map(|at| self.test_at(pool, &units, at));
        let (mut tests, wild): (Vec<TangentTest>, Vec<TangentTest>) =
            tests.partition(|test| test.largest <= LARGEST);
        tests.truncate(POINTS);
        if tests.is_empty() {
            tests = wild;
        }
        let residual = tests.iter().map(|test| test.residual).reduce(f64::max);
        let mut verdict = CanonicalVerdict {
            canonical: !tests.is_empty() && tests.iter().all(TangentTest::passes),
            proved: false,
            residual,
            valence: None,
            failing: Vec::new(),
            only_here: Vec::new(),
            why: None,
        };
        if !self.parts.is_empty() {
            self.by_parts(model, equations, &mut verdict);
        } else if self.is_explicit() {
            if verdict.canonical {
                self.evaluate_far_away(model, equations, &units, &mut verdict);
            }
            self.by_brackets(equations, &mut verdict);
        } else if residual.is_none() {
            verdict.why = Some(self.no_map(model, equations));
        } else {
            verdict.proved = verdict.canonical;
        }
        verdict
    }

    /// Judges maps one after the other: they are canonical where all of them are.
    fn by_parts(&self, model: &Model, equations: &mut Equations, verdict: &mut CanonicalVerdict) {
        let all: Vec<CanonicalVerdict> =
            self.parts.iter().map(|(map, _)| map.verdict(model, equations)).collect();
        let names = self.parts.iter().map(|(map, _)| map.name.as_str()).zip(&all);
        let mut wrong: Vec<&str> = names
            .filter(|(_, of)| !of.canonical && of.valence.is_none())
            .map(|(name, _)| name)
            .collect();
        wrong.sort_unstable();
        wrong.dedup();
        let pool = &mut equations.pool;
        let mut valence = Some(Expr::ONE);
        for (of, (_, inverted)) in all.iter().zip(&self.parts) {
            let own = of.valence.or(of.canonical.then_some(Expr::ONE));
            valence = valence.zip(own).map(|(valence, own)| {
                if *inverted { pool.div(valence, own) } else { pool.mul(valence, own) }
            });
        }
        verdict.valence = valence.filter(|&valence| valence != Expr::ONE);
        if verdict.residual.is_none() {
            verdict.why = Some("no point with an image was found near the start".to_owned());
        } else if verdict.canonical {
            verdict.proved = all.iter().all(|of| of.canonical && of.proved);
        } else if !wrong.is_empty() {
            let names: Vec<String> = wrong.iter().map(|name| format!("`{name}`")).collect();
            let is = if names.len() == 1 { "is" } else { "are" };
            verdict.why = Some(format!("{} {is} not canonical", names.join(" and ")));
        }
    }

    /// Why a generating function gives no map.
    fn no_map(&self, model: &Model, equations: &Equations) -> String {
        let new = &self.implicit.new;
        let points = guesses(new.len()).zip(0..).map(|(guess, n)| {
            Valuation::near_start(model, equations, n).with(new.iter().copied().zip(guess))
        });
        if singular(&equations.pool, &self.implicit.by_new, &points.collect::<Vec<_>>()) {
            "its equations cannot be solved: the determinant of ∂²F/∂old∂new vanishes everywhere"
        } else {
            "no point of its domain was found near the start"
        }
        .to_owned()
    }

    /// The brackets of the new variables of an explicit map, as functions of the old ones.
    fn brackets(&self, pool: &mut Pool) -> Vec<FailingBracket> {
        let n = self.implicit.new.len() / 2;
        let mut all = Vec::new();
        for i in 0..2 * n {
            for j in i + 1..2 * n {
                // the relation is Q − Q(q, p, t)
                let mut terms = Vec::new();
                for k in 0..n {
                    let a = pool.mul(self.by_old[i][k], self.by_old[j][n + k]);
                    let b = pool.mul(self.by_old[i][n + k], self.by_old[j][k]);
                    terms.extend([(Number::ONE, a), (Number::MINUS_ONE, b)]);
                }
                let is = pool.linear(Number::ZERO, &terms);
                let is = super::slope::zero_if_proved(pool, is);
                let is = pool.simplify(is);
                let is = pool.divided_out(is);
                let expected = if j == i + n { Expr::ONE } else { Expr::ZERO };
                let pair = [self.implicit.new[i], self.implicit.new[j]];
                all.push(FailingBracket { pair, is, expected });
            }
        }
        all
    }

    /// c of M 𝕁 Mᵀ = c 𝕁, if that is proved: 1 for a map that is given by a generating function.
    pub(super) fn proved_valence(&self, pool: &mut Pool) -> Option<Expr> {
        if !self.is_explicit() {
            return Some(Expr::ONE);
        }
        let all = self.compared_brackets(pool);
        self.valence(pool, &all)
    }

    /// Whether all brackets of an explicit map are proved to be those of canonical variables.
    pub(super) fn has_canonical_brackets(&self, pool: &mut Pool) -> bool {
        self.compared_brackets(pool).iter().all(|(_, zero)| *zero == Zero::Proved)
    }

    /// The brackets of an explicit map, and whether they are what they should be.
    fn compared_brackets(&self, pool: &mut Pool) -> Vec<(FailingBracket, Zero)> {
        let mut all = Vec::new();
        for bracket in self.brackets(pool) {
            let difference = pool.sub(bracket.is, bracket.expected);
            let zero = pool.is_zero(difference);
            all.push((bracket, zero));
        }
        all
    }

    /// The largest entry of |M 𝕁 Mᵀ − 𝕁| of an explicit map, as a function of the old variables and t.
    pub(super) fn largest_residual(&self, pool: &mut Pool) -> Expr {
        let mut largest = Expr::ZERO;
        for FailingBracket { is, expected, .. } in self.brackets(pool) {
            let difference = pool.sub(is, expected);
            let difference = pool.simplify(difference);
            let size = pool.call(FunctionId::Abs, &[difference]);
            largest = match largest {
                Expr::ZERO => size,
                _ => pool.call(FunctionId::Max, &[largest, size]),
            };
        }
        largest
    }

    /// Compares the brackets of an explicit map with those of canonical variables.
    fn by_brackets(&self, equations: &mut Equations, verdict: &mut CanonicalVerdict) {
        let pool = &mut equations.pool;
        let all = self.compared_brackets(pool);
        let proved = all.iter().all(|(_, zero)| *zero == Zero::Proved);
        let refuted = all.iter().any(|(_, zero)| *zero == Zero::No);
        if proved {
            (verdict.canonical, verdict.proved) = (true, true);
            return;
        }
        verdict.valence = self.valence(pool, &all);
        if verdict.canonical {
            // a number that is one to rounding is no scale
            verdict.valence.take_if(|c| matches!(pool.node(*c), Node::Number(_)));
            // at these values of the parameters; a number that is nearly one has no others
            let other = all.into_iter().filter(|(bracket, zero)| {
                *zero == Zero::No && !matches!(pool.node(bracket.is), Node::Number(_))
            });
            verdict.only_here = other.map(|(bracket, _)| bracket).collect();
            return;
        }
        verdict.proved = refuted;
        let wrong = |zero: Zero| if refuted { zero == Zero::No } else { zero != Zero::Proved };
        verdict.failing =
            all.into_iter().filter(|(_, zero)| wrong(*zero)).map(|(bracket, _)| bracket).collect();
        let failing = verdict.failing.iter().map(|bracket| {
            let [a, b] = bracket.pair.map(|s| pool.symbol_info(s).name.clone());
            let (is, expected) = (pool.text(bracket.is), pool.text(bracket.expected));
            format!("[{a}, {b}] = {is}, not {expected}")
        });
        verdict.why = Some(failing.collect::<Vec<_>>().join("; "));
    }

    /// The common number of all brackets [Q, P], if the others vanish.
    fn valence(&self, pool: &mut Pool, all: &[(FailingBracket, Zero)]) -> Option<Expr> {
        let mut variables = self.old.clone();
        variables.extend(pool.find_symbol("t"));
        let mut valence = None;
        for (bracket, zero) in all {
            if bracket.expected == Expr::ZERO {
                if *zero != Zero::Proved {
                    return None;
                }
                continue;
            }
            let c = *valence.get_or_insert(bracket.is);
            let difference = pool.sub(c, bracket.is);
            if pool.depends_on_any(c, &variables) || pool.is_zero(difference) != Zero::Proved {
                return None;
            }
        }
        valence.filter(|&c| pool.is_zero(c) == Zero::No)
    }
}
