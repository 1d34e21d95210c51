//! Checks the claims of a file on brackets: `[f, g] = is` of `[expect] brackets`.
//!
//! In: a model and its equations. Out: a diagnostic for each claim that is neither proved nor true
//! to 1e-10 at twenty points near the start and wherever it has a value far from it. Never here: how claims are written.

use crate::diagnostic::Diagnostic;
use crate::expr::{Expr, Symbol, Zero};
use crate::mechanics::{self, ANY_POINTS, ChainRule, Equations, POINTS, TRIES, Valuation};
use crate::model::{ExpectedBracket, Model};
use crate::num::Number;

/// The tolerated error of a bracket, relative to the size of its terms.
const TOLERANCE: f64 = 1e-10;

pub(super) fn false_brackets(model: &Model, equations: &Equations) -> Vec<Diagnostic> {
    if model.expect.brackets.is_empty() {
        return Vec::new();
    }
    let mut equations = equations.clone();
    model.expect.brackets.iter().filter_map(|claim| check(model, &mut equations, claim)).collect()
}

fn check(model: &Model, equations: &mut Equations, claim: &ExpectedBracket) -> Option<Diagnostic> {
    match mechanics::bracket(model, equations, claim.f, claim.g) {
        Ok(bracket) => match mechanics::in_phase_space(equations, claim.is) {
            Ok(is) => compare(model, equations, claim, bracket, is),
            Err(why) => Some(unchecked(claim, &why)),
        },
        Err(_) if equations.is_lagrangian() => at_points(model, equations, claim),
        Err(why) => Some(unchecked(claim, &why)),
    }
}

/// Compares both sides as functions of phase space.
fn compare(
    model: &Model,
    equations: &mut Equations,
    claim: &ExpectedBracket,
    bracket: Expr,
    is: Expr,
) -> Option<Diagnostic> {
    let difference = equations.pool.sub(bracket, is);
    if equations.pool.is_zero(difference) == Zero::Proved {
        return None;
    }
    let value = |point: &Valuation| equations.pool.evaluate_with_size(difference, &|s| point.at(s));
    let short = equations.pool.weight(bracket) <= LONGEST;
    let found = short.then(|| equations.pool.unicode(bracket));
    judge(model, equations, claim, found.as_deref(), &value).or_else(|| {
        // what may differ between the points only, as exp(−(x − 9000)²) does, is not seen there
        let hides = may_hide(model, equations, difference);
        hides.then(|| {
            unchecked(
                claim,
                &"a kink or a localised term in it leaves open whether this holds everywhere",
            )
        })
    })
}

/// Whether a difference, at the file's own values of the parameters, is not known to vanish and has parts that points may miss.
fn may_hide(model: &Model, equations: &mut Equations, difference: Expr) -> bool {
    let pool = &mut equations.pool;
    let values = model.parameters.iter().map(|p| (p.symbol, Number::Real(p.value).canonical()));
    let values = values.map(|(symbol, n)| (symbol, pool.number(n))).collect();
    let here = pool.substitute(difference, &values);
    let zero = pool.is_zero(here);
    matches!(zero, Zero::Unknown | Zero::No)
        && pool.as_number(here).is_none()
        && pool.may_hide(here)
}

/// A bracket longer than this is not reported in a message.
const LONGEST: u64 = 60;

/// Evaluates the left side by the chain rule, if velocities are not known in terms of momenta.
fn at_points(
    model: &Model,
    equations: &mut Equations,
    claim: &ExpectedBracket,
) -> Option<Diagnostic> {
    let rule = match ChainRule::of(equations, claim.f, claim.g) {
        Ok(rule) => rule,
        Err(why) => return Some(unchecked(claim, &why)),
    };
    let is = equations.open(claim.is);
    let value = |point: &Valuation| {
        let at = |symbol: Symbol| point.at(symbol);
        let (right, size) = equations.pool.evaluate_with_size(is, &at);
        match rule.value(equations, &at) {
            Some(left) => (left - right, size.max(left.abs())),
            None => (f64::NAN, f64::NAN),
        }
    };
    judge(model, equations, claim, None, &value)
}

/// Compares the two sides: `value` gives their difference and the size of terms.
fn judge(
    model: &Model,
    equations: &Equations,
    claim: &ExpectedBracket,
    found: Option<&str>,
    value: &dyn Fn(&Valuation) -> (f64, f64),
) -> Option<Diagnostic> {
    let wrong = |point: &Valuation, place: &str| {
        let (off, size) = value(point);
        if !off.is_finite() || !size.is_finite() {
            return None;
        }
        let help = match found {
            Some(found) => format!("it is {found}"),
            None => format!("{place} the start it is off by {off:.1e}, its terms being {size:.1e}"),
        };
        Some((off.abs() > TOLERANCE * size).then_some(help))
    };
    let near = (0..TRIES).map(|n| Valuation::near_start(model, equations, n));
    let near: Vec<Option<String>> =
        near.filter_map(|point| wrong(&point, "near")).take(POINTS).collect();
    if near.len() < POINTS {
        return Some(unchecked(claim, &"it has no value near the start"));
    }
    let far = (0..ANY_POINTS).map(|n| Valuation::at_any_distance(model, equations, n));
    let far = far.filter_map(|point| wrong(&point, "far from").flatten());
    let help = near.into_iter().flatten().chain(far).next()?;
    let message = format!("{} is not what this says", claim.written);
    Some(Diagnostic::error(claim.place.clone(), message).with_help(help))
}

fn unchecked(claim: &ExpectedBracket, why: &dyn std::fmt::Display) -> Diagnostic {
    let message = format!("{} cannot be checked: {why}", claim.written);
    Diagnostic::error(claim.place.clone(), message)
}
