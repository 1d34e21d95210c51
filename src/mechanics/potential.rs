//! Potentials of differential forms: f with ∂f/∂x_i = A_i.
//!
//! In: the components of a form and its variables. Out: f, where it is found by elementary integration of each term; its
//! slopes are then proved to be the components. Never here: what a form means.

use crate::expr::{Expr, FunctionId, Node, Pool, Symbol, Zero};
use crate::num::Number;

/// Components heavier than this are not integrated.
const WEIGHT_LIMIT: u64 = 2_000;

/// A function whose slopes by the variables are proved to be the components; `None` where none is found.
pub(super) fn potential(pool: &mut Pool, form: &[Expr], variables: &[Symbol]) -> Option<Expr> {
    if form.iter().any(|&a| pool.weight(a) > WEIGHT_LIMIT) {
        return None;
    }
    let mut found = Expr::ZERO;
    let mut rest = form.to_vec();
    let mut pending: Vec<usize> = (0..variables.len()).collect();
    while !pending.is_empty() {
        // what is left of a component may be integrated once others are
        let integrated = pending
            .iter()
            .enumerate()
            .find_map(|(k, &i)| Some((k, antiderivative(pool, rest[i], variables[i])?)));
        let (k, part) = integrated?;
        pending.remove(k);
        for (left, &y) in rest.iter_mut().zip(variables) {
            let slope = pool.derivative(part, y);
            let difference = pool.sub(*left, slope);
            *left = pool.simplify(difference);
            if pool.is_zero(*left) == Zero::Proved {
                *left = Expr::ZERO;
            }
        }
        found = pool.add(found, part);
    }
    if rest.iter().any(|&left| left != Expr::ZERO) || pool.is_full() {
        return None;
    }
    Some(pool.simplify(found))
}

/// ∫ e dx, term by term.
fn antiderivative(pool: &mut Pool, e: Expr, x: Symbol) -> Option<Expr> {
    if !pool.depends(e, x) {
        let x = pool.variable(x);
        return Some(pool.mul(e, x));
    }
    let whole: Option<Vec<(Number, Expr)>> = terms_of(pool, e, x);
    if let Some(parts) = whole {
        return Some(pool.linear(Number::ZERO, &parts));
    }
    // the same multiplied out
    let opened = pool.multiplied_out(e);
    let parts = terms_of(pool, opened, x)?;
    Some(pool.linear(Number::ZERO, &parts))
}

fn terms_of(pool: &mut Pool, e: Expr, x: Symbol) -> Option<Vec<(Number, Expr)>> {
    let terms = pool.summands(e);
    let mut parts = Vec::new();
    for (c, term) in terms {
        parts.push((c, of_term(pool, term, x)?));
    }
    Some(parts)
}

/// ∫ g(u) u' c dx, where g is a power, a sine, a cosine or an exponential, and c does not depend on x.
fn of_term(pool: &mut Pool, term: Expr, x: Symbol) -> Option<Expr> {
    if !pool.depends(term, x) {
        let x = pool.variable(x);
        return Some(pool.mul(term, x));
    }
    let factors = match pool.node(term).clone() {
        Node::Product(_, factors) => factors.to_vec(),
        _ => vec![(term, Number::ONE)],
    };
    for (base, n) in factors {
        if !pool.depends(base, x) {
            continue;
        }
        let factor = pool.monomial(Number::ONE, &[(base, n)]);
        let rest = pool.div(term, factor);
        // g = uⁿ
        if let Some(c) = constant_ratio(pool, rest, base, x) {
            let next = n + Number::ONE;
            let integral = if next.is_zero() {
                let square = pool.powi(base, 2);
                let log = pool.call(FunctionId::Ln, &[square]);
                pool.scale(Number::HALF, log)
            } else {
                pool.monomial(next.recip(), &[(base, next)])
            };
            return Some(pool.mul(c, integral));
        }
        // g = f(u)
        let Node::Call(function, arguments) = pool.node(base).clone() else { continue };
        if !n.is_one() || arguments.len() != 1 {
            continue;
        }
        let Some(c) = constant_ratio(pool, rest, arguments[0], x) else { continue };
        let integral = match function {
            FunctionId::Sin => {
                let cosine = pool.call(FunctionId::Cos, &arguments);
                pool.neg(cosine)
            }
            FunctionId::Cos => pool.call(FunctionId::Sin, &arguments),
            FunctionId::Exp => base,
            FunctionId::Sinh => pool.call(FunctionId::Cosh, &arguments),
            FunctionId::Cosh => pool.call(FunctionId::Sinh, &arguments),
            _ => continue,
        };
        return Some(pool.mul(c, integral));
    }
    None
}

/// e/(∂u/∂x), if it does not depend on x.
fn constant_ratio(pool: &mut Pool, e: Expr, u: Expr, x: Symbol) -> Option<Expr> {
    let slope = pool.derivative(u, x);
    if slope == Expr::ZERO {
        return None;
    }
    let ratio = pool.div(e, slope);
    let ratio = pool.simplify(ratio);
    (!pool.depends(ratio, x)).then_some(ratio)
}
