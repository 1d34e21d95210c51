//! One equation solved for one unknown, where that can be written down.
//!
//! In: an expression that is to vanish, a symbol. Out: the values of the symbol, principal branches first. What stands
//! around the unknown is taken off step by step; where it occurs several times, the equation has to be linear or
//! quadratic in some part that holds it. Never here: several equations, and which value is right.

use std::collections::HashMap;

use super::slope::zero_if_proved;
use crate::expr::{Expr, FunctionId, Node, Pool, Symbol, Zero};
use crate::num::Number;

/// ∂e/∂symbol, simplified, and 0 if it is proved to vanish.
pub(super) fn slope(pool: &mut Pool, e: Expr, symbol: Symbol) -> Expr {
    if !pool.depends(e, symbol) {
        return Expr::ZERO;
    }
    let slope = pool.derivative(e, symbol);
    let slope = zero_if_proved(pool, slope);
    pool.simplify(slope)
}

/// The values of x that solve e = 0, as far as they can be written down.
pub(super) fn isolate(pool: &mut Pool, e: Expr, x: Symbol) -> Vec<Expr> {
    let mut found = free(pool, e, Expr::ZERO, x, 0);
    if found.is_empty() {
        let simpler = pool.simplify(e);
        if simpler != e {
            found = free(pool, simpler, Expr::ZERO, x, 0);
        }
    }
    if found.is_empty() {
        let numerator = pool.numerator(e);
        if numerator != e {
            found = free(pool, numerator, Expr::ZERO, x, 0);
        }
    }
    found.retain(|&value| !pool.depends(value, x));
    found.dedup();
    found
}

/// Solves left = right for x, which occurs in `left` alone.
fn free(pool: &mut Pool, left: Expr, right: Expr, x: Symbol, depth: usize) -> Vec<Expr> {
    const DEEPEST: usize = 24;
    if depth > DEEPEST || !pool.depends(left, x) {
        return Vec::new();
    }
    match pool.node(left).clone() {
        Node::Symbol(_) => vec![right],
        Node::Sum(constant, terms) => {
            let (bound, rest): (Vec<_>, Vec<_>) =
                terms.iter().partition(|(_, term)| pool.depends(*term, x));
            let rest = pool.linear(constant, &rest);
            let right = pool.sub(right, rest);
            match bound[..] {
                [(c, term)] => {
                    let right = pool.scale(c.recip(), right);
                    free(pool, term, right, x, depth + 1)
                }
                _ => {
                    let left = pool.linear(Number::ZERO, &bound);
                    let difference = pool.sub(left, right);
                    in_a_part(pool, difference, x, depth)
                }
            }
        }
        Node::Product(c, factors) => {
            let (bound, rest): (Vec<_>, Vec<_>) =
                factors.iter().partition(|(base, _)| pool.depends(*base, x));
            let rest = pool.monomial(c, &rest);
            let whole = right;
            let right = pool.div(right, rest);
            let tangent = match bound[..] {
                [(a, n), (b, m)] if n == -m => ratio_of_sines(pool, a, b).map(|tan| (tan, n)),
                _ => None,
            };
            match bound[..] {
                [(base, n)] => power(pool, (base, n), right, x, depth),
                _ => match tangent {
                    Some(tangent) => power(pool, tangent, right, x, depth),
                    None => {
                        let difference = pool.sub(left, whole);
                        in_a_part(pool, difference, x, depth)
                    }
                },
            }
        }
        Node::Power(base, exponent) => match (pool.depends(base, x), pool.depends(exponent, x)) {
            (true, false) => {
                let inverse = pool.powi(exponent, -1);
                let right = pool.pow(right, inverse);
                free(pool, base, right, x, depth + 1)
            }
            (false, true) => {
                let above = pool.call(FunctionId::Ln, &[right]);
                let below = pool.call(FunctionId::Ln, &[base]);
                let right = pool.div(above, below);
                free(pool, exponent, right, x, depth + 1)
            }
            _ => Vec::new(),
        },
        Node::Call(function, arguments) => inverse(pool, function, &arguments, right, x, depth),
        Node::Number(_) | Node::Pi => Vec::new(),
    }
}

/// tan u of sin u and cos u.
fn ratio_of_sines(pool: &mut Pool, a: Expr, b: Expr) -> Option<Expr> {
    let call = |e: Expr| match pool.node(e) {
        Node::Call(function, arguments) => Some((*function, arguments[0])),
        _ => None,
    };
    match (call(a)?, call(b)?) {
        ((FunctionId::Sin, u), (FunctionId::Cos, v)) if u == v => {
            Some(pool.call(FunctionId::Tan, &[u]))
        }
        ((FunctionId::Cos, u), (FunctionId::Sin, v)) if u == v => {
            Some(pool.call(FunctionId::Cot, &[u]))
        }
        _ => None,
    }
}

/// Solves baseⁿ = right.
fn power(
    pool: &mut Pool,
    (base, n): (Expr, Number),
    right: Expr,
    x: Symbol,
    depth: usize,
) -> Vec<Expr> {
    let root = root_of(pool, right, n);
    let mut found = free(pool, base, root, x, depth + 1);
    if n.as_integer().is_some_and(|n| n % 2 == 0) {
        let other = pool.neg(root);
        found.extend(free(pool, base, other, x, depth + 1));
    }
    found
}

/// The n-th root; of squares it is a branch, the other one has the other sign.
fn root_of(pool: &mut Pool, e: Expr, n: Number) -> Expr {
    let Some(degree) = n.as_integer().filter(|n| n % 2 == 0) else {
        return pool.monomial(Number::ONE, &[(e, n.recip())]);
    };
    let Node::Product(c, factors) = pool.node(e).clone() else {
        return pool.monomial(Number::ONE, &[(e, n.recip())]);
    };
    let taken = |power: &Number| power.as_integer().filter(|m| m % degree == 0).map(|m| m / degree);
    let (out, under): (Vec<_>, Vec<_>) = factors.iter().partition(|(_, m)| taken(m).is_some());
    let out: Vec<(Expr, Number)> =
        out.into_iter().map(|(base, m)| (base, Number::integer(taken(&m).unwrap_or(0)))).collect();
    let under = pool.monomial(c, &under);
    let root = pool.monomial(Number::ONE, &[(under, n.recip())]);
    let out = pool.monomial(Number::ONE, &out);
    pool.mul(out, root)
}

/// Solves f(…) = right.
fn inverse(
    pool: &mut Pool,
    function: FunctionId,
    arguments: &[Expr],
    right: Expr,
    x: Symbol,
    depth: usize,
) -> Vec<Expr> {
    use FunctionId::{
        Acos, Asin, Atan, Atan2, Cos, Cosh, Cot, Exp, Ln, Sin, Sinh, Sqrt, Tan, Tanh,
    };
    let u = arguments[0];
    let mut values: Vec<Expr> = Vec::new();
    match function {
        Sin => {
            let principal = pool.call(Asin, &[right]);
            let pi = pool.pi();
            values.extend([principal, pool.sub(pi, principal)]);
        }
        Cos => {
            let principal = pool.call(Acos, &[right]);
            values.extend([principal, pool.neg(principal)]);
        }
        Tan | Cot => {
            let (above, below) = fraction(pool, right);
            let (y, x) = if function == Tan { (above, below) } else { (below, above) };
            let opposite = [pool.neg(y), pool.neg(x)];
            values.extend([pool.call(Atan2, &[y, x]), pool.call(Atan2, &opposite)]);
        }
        Asin => values.push(pool.call(Sin, &[right])),
        Acos => values.push(pool.call(Cos, &[right])),
        Atan => values.push(pool.call(Tan, &[right])),
        Exp => values.push(pool.call(Ln, &[right])),
        Ln => values.push(pool.call(Exp, &[right])),
        Sqrt => values.push(pool.powi(right, 2)),
        Sinh | Cosh => {
            let square = pool.powi(right, 2);
            let one = pool.integer(if function == Sinh { 1 } else { -1 });
            let under = pool.add(square, one);
            let root = pool.sqrt(under);
            let sum = pool.add(right, root);
            let principal = pool.call(Ln, &[sum]);
            values.push(principal);
            if function == Cosh {
                values.push(pool.neg(principal));
            }
        }
        Tanh => {
            let (plus, minus) = (pool.add(Expr::ONE, right), pool.sub(Expr::ONE, right));
            let ratio = pool.div(plus, minus);
            let logarithm = pool.call(Ln, &[ratio]);
            values.push(pool.scale(Number::HALF, logarithm));
        }
        Atan2 => {
            let v = arguments[1];
            let (of_u, of_v) = (pool.depends(u, x), pool.depends(v, x));
            let (part, value) = match (of_u, of_v) {
                (true, false) => {
                    let tangent = pool.call(Tan, &[right]);
                    (u, pool.mul(v, tangent))
                }
                (false, true) => {
                    let cotangent = pool.call(Cot, &[right]);
                    (v, pool.mul(u, cotangent))
                }
                _ => return Vec::new(),
            };
            return free(pool, part, value, x, depth + 1);
        }
        FunctionId::Abs | FunctionId::Sign | FunctionId::Min | FunctionId::Max => {}
    }
    values.into_iter().flat_map(|value| free(pool, u, value, x, depth + 1)).collect()
}

/// Numerator and denominator, as they stand.
pub(super) fn fraction(pool: &mut Pool, e: Expr) -> (Expr, Expr) {
    let Node::Product(c, factors) = pool.node(e).clone() else {
        if let Some(Number::Rational(n, d)) = pool.as_number(e) {
            return (pool.integer(n), pool.integer(d));
        }
        return (e, Expr::ONE);
    };
    let (below, above): (Vec<_>, Vec<_>) = factors.iter().partition(|(_, n)| n.is_negative());
    let below: Vec<(Expr, Number)> = below.into_iter().map(|(b, n)| (b, -n)).collect();
    let (n, d) = match c {
        Number::Rational(n, d) => (Number::integer(n), Number::integer(d)),
        Number::Real(_) => (c, Number::ONE),
    };
    (pool.monomial(n, &above), pool.monomial(d, &below))
}

/// Solves e = 0 where x occurs in several places, all of them within the same part.
fn in_a_part(pool: &mut Pool, e: Expr, x: Symbol, depth: usize) -> Vec<Expr> {
    let variable = pool.variable(x);
    let mut parts: Vec<Expr> = vec![variable];
    for node in pool.reachable(&[e]) {
        if !pool.depends(node, x) || node == e || node == variable {
            continue;
        }
        match pool.node(node) {
            Node::Call(..) | Node::Power(..) => parts.push(node),
            Node::Product(_, factors) => {
                let bound = factors.iter().filter(|(base, _)| pool.depends(*base, x));
                parts.extend(bound.map(|(base, _)| *base).filter(|base| *base != variable));
            }
            _ => {}
        }
    }
    parts.dedup();
    let z = pool.symbol("a part to be found");
    let unknown = pool.variable(z);
    let forms = [e, pool.numerator(e)];
    for part in parts {
        for form in forms {
            let replaced = pool.replace(form, part, unknown);
            if pool.depends(replaced, x) {
                continue;
            }
            for value in polynomial(pool, replaced, z) {
                let found = free(pool, part, value, x, depth + 1);
                if !found.is_empty() {
                    // the other root of a quadratic equation is a branch, too
                    let mut all = found;
                    for other in polynomial(pool, replaced, z).into_iter().skip(1) {
                        all.extend(free(pool, part, other, x, depth + 1));
                    }
                    return all;
                }
            }
        }
    }
    Vec::new()
}

/// The roots of a linear or quadratic equation.
fn polynomial(pool: &mut Pool, e: Expr, z: Symbol) -> Vec<Expr> {
    let first = slope(pool, e, z);
    let second = slope(pool, first, z);
    let zero = HashMap::from([(z, Expr::ZERO)]);
    let c = pool.substitute(e, &zero);
    if !c_is_finite(pool, c) {
        return Vec::new();
    }
    let b = pool.substitute(first, &zero);
    if second == Expr::ZERO {
        if b == Expr::ZERO {
            return Vec::new();
        }
        let above = pool.neg(c);
        return vec![pool.div(above, b)];
    }
    if slope(pool, second, z) != Expr::ZERO || pool.is_zero(second) != Zero::No {
        return Vec::new();
    }
    // a z² + b z + c with a = second/2
    let square = pool.powi(b, 2);
    let product = pool.mul(second, c);
    let under = pool.linear(Number::ZERO, &[(Number::ONE, square), (Number::integer(-2), product)]);
    let under = pool.simplify(under);
    let root = pool.sqrt(under);
    let minus_b = pool.neg(b);
    let (plus, minus) = (pool.add(minus_b, root), pool.sub(minus_b, root));
    vec![pool.div(plus, second), pool.div(minus, second)]
}

/// Whether no part of an expression is infinite.
fn c_is_finite(pool: &Pool, e: Expr) -> bool {
    pool.reachable(&[e]).into_iter().all(|part| match pool.node(part) {
        Node::Number(n) => n.is_finite(),
        Node::Sum(c, terms) => c.is_finite() && terms.iter().all(|(c, _)| c.is_finite()),
        Node::Product(c, factors) => c.is_finite() && factors.iter().all(|(_, n)| n.is_finite()),
        _ => true,
    })
}
