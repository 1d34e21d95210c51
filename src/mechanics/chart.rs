//! Poisson brackets in the new variables of a transformation: [f, g] = Σ ∂f/∂Q ∂g/∂P − ∂f/∂P ∂g/∂Q, with f and g as functions of
//! (Q, P, t). It is that in the old variables where the map is canonical, and another where it is not.
//!
//! In: a map, two expressions. Out: their bracket in its new variables, and its value at a point by M = ∂(Q, P)/∂(q, p), without
//! anything being solved for. Never here: whether the map is canonical.
//! Source: *The Principles of Dynamics*, §§ 3.2.1, 3.2.3.

use nalgebra::{DVector, DVectorView};

use super::bracket::{bracket, in_phase_space};
use super::canonical::{PhaseMap, free_of};
use super::equations::{Equations, NoClosedForm};
use super::group;
use super::isolate::Solution;
use super::slope::zero_if_proved;
use super::valuation::Valuation;
use crate::expr::{Expr, Symbol, Zero};
use crate::model::Model;
use crate::num::Number;

/// The points at which what is written down has to agree with M.
const WITNESSES: usize = 4;

/// The relative difference of a bracket and its value by M that may be rounding.
const ROUNDING: f64 = 1e-8;

/// The bracket of two expressions in the new variables of a transformation.
#[derive(Clone, Debug)]
pub struct ChartBracket {
    /// The name of the transformation.
    pub name: String,
    /// Its new variables, Q…, then P….
    pub variables: Vec<Symbol>,
    /// The bracket as a function of them and t, or why it is not known.
    pub bracket: Result<Expr, NoClosedForm>,
    map: PhaseMap,
    /// The slopes of f and of g by the old variables.
    slopes: [Vec<Expr>; 2],
}

impl ChartBracket {
    /// The bracket in the new variables of each transformation of the file; empty if f and g are not functions of (q, p,
    /// t).
    pub fn all(model: &Model, equations: &mut Equations, sides: [Expr; 2]) -> Vec<ChartBracket> {
        let maps = group::phase_maps(model, equations);
        maps.into_iter().filter_map(|map| Self::of(model, equations, map, sides)).collect()
    }

    fn of(
        model: &Model,
        equations: &mut Equations,
        map: PhaseMap,
        sides: [Expr; 2],
    ) -> Option<ChartBracket> {
        let mut slopes = [Vec::new(), Vec::new()];
        for (of, side) in slopes.iter_mut().zip(sides) {
            let side = in_phase_space(equations, side).ok()?;
            for &symbol in &map.old {
                of.push(equations.derivation(side, &[(symbol, Expr::ONE)]).ok()?);
            }
        }
        let bracket = written(model, equations, &map, sides);
        let (name, variables) = (map.name.clone(), map.new_variables().to_vec());
        let mut found = ChartBracket { name, variables, bracket, map, slopes };
        if let Ok(e) = found.bracket
            && !found.agrees(model, equations, e)
        {
            let why = "what is written down holds on another branch of the map";
            found.bracket = Err(NoClosedForm(why.to_owned()));
        }
        Some(found)
    }

    /// The value at a point of (q, p, t); `None` where the map breaks down.
    pub fn value(&self, equations: &Equations, point: &Valuation) -> Option<f64> {
        let pool = &equations.pool;
        let at = self.map.image(pool, point)?;
        let point = equations.with_images(at.clone());
        let tangent = self.map.tangent(pool, &at)?.transpose().full_piv_lu();
        let slope = |of: &[Expr]| {
            let by_old = DVector::from_iterator(of.len(), of.iter().map(|&e| point.value(pool, e)));
            tangent.solve(&by_old)
        };
        let [f, g] = [slope(&self.slopes[0])?, slope(&self.slopes[1])?];
        let n = f.len() / 2;
        let part = |v: &DVector<f64>, k: usize| -> DVector<f64> {
            let rows: DVectorView<'_, f64> = v.rows(k * n, n);
            rows.into_owned()
        };
        let value = part(&f, 0).dot(&part(&g, 1)) - part(&f, 1).dot(&part(&g, 0));
        value.is_finite().then_some(value)
    }

    /// Whether an expression of the new variables has the values that M gives, wherever both are known.
    fn agrees(&self, model: &Model, equations: &Equations, e: Expr) -> bool {
        let images = self.map.images(model, equations, WITNESSES);
        images.iter().all(|at| {
            let value = at.value(&equations.pool, e);
            match self.value(equations, at) {
                Some(by_matrix) if value.is_finite() => {
                    (value - by_matrix).abs() <= ROUNDING * (1.0 + by_matrix.abs())
                }
                _ => true,
            }
        })
    }
}

/// The bracket of f and g as functions of the new variables.
fn written(
    model: &Model,
    equations: &mut Equations,
    map: &PhaseMap,
    sides: [Expr; 2],
) -> Result<Expr, NoClosedForm> {
    let new = map.new_variables();
    let mut charted = equations.supplements.maps.new_variables.clone();
    std::mem::swap(&mut charted, &mut equations.supplements.maps.new_variables);
    equations.supplements.maps.new_variables.retain(|(symbol, _)| !new.contains(symbol));
    let opened = sides.map(|side| in_phase_space(equations, side));
    equations.supplements.maps.new_variables = charted;
    let [f, g] = opened;
    let (mut f, mut g) = (f?, g?);
    let mut shorter = None;
    if [f, g].iter().any(|&e| equations.pool.depends_on_any(e, &map.old)) {
        let Some(backwards) = map.backwards(model, equations) else {
            let why = "no expression of the old variables in terms of the new ones was found";
            return Err(NoClosedForm(why.to_owned()));
        };
        shorter = from_old(model, equations, (map, &backwards), sides);
        let pool = &mut equations.pool;
        let mut eliminated = |e| {
            free_of(pool, e, &backwards, &map.old)
                .ok_or_else(|| NoClosedForm("the old variables cannot be eliminated".to_owned()))
        };
        (f, g) = (eliminated(f)?, eliminated(g)?);
    }
    let others = equations.supplements.maps.implicit.iter().flat_map(|(other, _)| &other.new);
    let own = &map.implicit.new;
    let others: Vec<Symbol> = others.copied().filter(|symbol| !own.contains(symbol)).collect();
    let pool = &mut equations.pool;
    if pool.depends_on_any(f, &others) || pool.depends_on_any(g, &others) {
        let why = "it contains new variables of another map without a closed form";
        return Err(NoClosedForm(why.to_owned()));
    }
    let n = new.len() / 2;
    let mut terms = Vec::new();
    for k in 0..n {
        let [by_position, by_momentum] = [new[k], new[n + k]];
        let (f_q, f_p) = (pool.derivative(f, by_position), pool.derivative(f, by_momentum));
        let (g_q, g_p) = (pool.derivative(g, by_position), pool.derivative(g, by_momentum));
        terms.push((Number::ONE, pool.mul(f_q, g_p)));
        terms.push((Number::MINUS_ONE, pool.mul(f_p, g_q)));
    }
    let sum = pool.linear(Number::ZERO, &terms);
    let sum = zero_if_proved(pool, sum);
    let sum = pool.simplify(sum);
    let mut best = sum;
    for e in shorter.into_iter().flatten() {
        let difference = pool.sub(e, sum);
        if pool.weight(e) < pool.weight(best) && pool.is_zero(difference) == Zero::Proved {
            best = e;
        }
    }
    Ok(best)
}

/// What the bracket in the new variables is where the map is canonical up to a valence c: that in the old ones over c, with
/// the new variables put in, and the same simplified. Both may be far shorter than what derivatives in the new variables give.
fn from_old(
    model: &Model,
    equations: &mut Equations,
    (map, backwards): (&PhaseMap, &Solution),
    [f, g]: [Expr; 2],
) -> Option<[Expr; 2]> {
    let old = bracket(model, equations, f, g).ok()?;
    let pool = &mut equations.pool;
    let valence = map.proved_valence(pool)?;
    let old = pool.div(old, valence);
    let values = backwards.iter().copied().collect();
    let plain = pool.substitute(old, &values);
    let found = [plain, pool.simplify(plain)];
    found.iter().all(|&e| !pool.depends_on_any(e, &map.old)).then_some(found)
}
