//! Whether a transformation is canonical: M 𝕁 Mᵀ = 𝕁 at points near the start and far from it, or proved by the brackets of the
//! new variables.
//!
//! In: a [`PhaseMap`]. Out: its [`CanonicalVerdict`]. Never here: how the map is solved.
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

/// Far from the start an entry of M may be off by so many ε of the size of its terms.
const SIZED: f64 = 1e3;

/// The residual below which a map without a proof is canonical, relative to the size of M.
const CANONICAL: f64 = 1e-10;

/// Points at which M is larger are left out while there are others: they are next to where the map
/// breaks down.
const LARGEST: f64 = 1e4;

/// Whether a map is canonical.
#[derive(Clone, Debug)]
pub struct CanonicalVerdict {
    /// Whether it is: proved, or to rounding at the points tried.
    pub canonical: bool,
    /// Whether that is proved.
    pub proved: bool,
    /// The largest entry of |M 𝕁 Mᵀ − 𝕁| at the points; `None` if there are none.
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

impl PhaseMap {
    /// Withdraws the verdict on an explicit map that fails far from the start.
    fn look_far_away(&self, model: &Model, equations: &Equations, verdict: &mut CanonicalVerdict) {
        for n in 0..ANY_POINTS {
            let point = Valuation::at_any_distance(model, equations, n);
            let image = self.image(&equations.pool, &point);
            let matrix = image.and_then(|at| self.tangent(&equations.pool, &at));
            let Some(matrix) = matrix.filter(|matrix| matrix.amax() <= LARGEST) else { continue };
            let residual = departure(&matrix);
            // entries whose terms cancel have an error of their own
            let sizes = self.by_old.iter().flatten().map(|&entry| {
                equations.pool.evaluate_with_size(entry, &|symbol| point.at(symbol)).1
            });
            let size: f64 = sizes.map(|size| size * size).sum();
            let rounding = SIZED * f64::EPSILON * size;
            if residual > CANONICAL * matrix.norm_squared().max(1.0) + rounding {
                verdict.canonical = false;
                verdict.residual = Some(verdict.residual.unwrap_or(0.0).max(residual));
                return;
            }
        }
    }

    /// Whether the map is canonical.
    pub fn verdict(&self, model: &Model, equations: &mut Equations) -> CanonicalVerdict {
        let mut matrices: Vec<DMatrix<f64>> = Vec::new();
        let mut wild: Vec<DMatrix<f64>> = Vec::new();
        for at in self.images(model, equations, 2 * POINTS) {
            if let Some(matrix) = self.tangent(&equations.pool, &at) {
                if matrix.amax() <= LARGEST { &mut matrices } else { &mut wild }.push(matrix);
            }
        }
        matrices.truncate(POINTS);
        if matrices.is_empty() {
            matrices = wild;
        }
        let residual = matrices.iter().map(departure).reduce(f64::max);
        let relative = matrices
            .iter()
            .map(|matrix| departure(matrix) / matrix.norm_squared().max(1.0))
            .reduce(f64::max);
        let mut verdict = CanonicalVerdict {
            canonical: relative.is_some_and(|r| r < CANONICAL),
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
                self.look_far_away(model, equations, &mut verdict);
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
