//! Equations that are not linear, solved for their unknowns where that can be written down.
//!
//! In: equations e = 0, unknowns, and a test that a solution has to pass. Out: each unknown as an
//! expression that is free of all unknowns. An unknown that occurs once is freed from what is
//! around it; otherwise what occurs in several places is solved for as in a linear or quadratic
//! equation; several unknowns in which the equations are linear are eliminated together; an angle
//! given by the ratio of two of them makes both known up to a common factor. Branches are tried in
//! turn, principal values first. Never here: numbers, and which solution is right.

use std::collections::HashMap;

use super::linear;
use super::slope::zero_if_proved;
use crate::expr::{Expr, FunctionId, Node, Pool, Symbol, Zero};
use crate::num::Number;

/// The number of steps after which a search is given up.
const BUDGET: usize = 400;

/// A solution, or an expression on the way to it, may not be heavier.
const HEAVIEST: u64 = 4_000;

/// Unknowns with their values.
pub(super) type Solution = Vec<(Symbol, Expr)>;

/// The first solution that `accept`s, if one is found.
pub(super) fn solve(
    pool: &mut Pool,
    equations: &[Expr],
    unknowns: &[Symbol],
    accept: &mut dyn FnMut(&mut Pool, &Solution) -> bool,
) -> Option<Solution> {
    let mut search = Search { wanted: unknowns.to_vec(), budget: BUDGET, accept };
    search.step(pool, equations.to_vec(), unknowns, Vec::new())
}

struct Search<'a> {
    wanted: Vec<Symbol>,
    budget: usize,
    accept: &'a mut dyn FnMut(&mut Pool, &Solution) -> bool,
}

impl Search<'_> {
    /// Goes on from what is left to solve and what is found, which may depend on what is left.
    fn step(
        &mut self,
        pool: &mut Pool,
        mut equations: Vec<Expr>,
        unknowns: &[Symbol],
        found: Solution,
    ) -> Option<Solution> {
        if self.budget == 0 || pool.is_full() || pool.cancel().is_cancelled() {
            return None;
        }
        self.budget -= 1;
        equations.retain(|&e| pool.depends_on_any(e, unknowns));
        if unknowns.is_empty() {
            let wanted = self.wanted.clone();
            let solution: Solution =
                found.into_iter().filter(|(s, _)| wanted.contains(s)).collect();
            return (self.accept)(pool, &solution).then_some(solution);
        }
        let of = |pool: &Pool, e: Expr| -> Vec<Symbol> {
            unknowns.iter().copied().filter(|&s| pool.depends(e, s)).collect()
        };
        // an equation for one unknown
        let mut single: Vec<(u64, usize, Symbol)> = Vec::new();
        for (k, &e) in equations.iter().enumerate() {
            if let [one] = of(pool, e)[..] {
                single.push((pool.weight(e), k, one));
            }
        }
        single.sort_unstable();
        for (_, k, unknown) in single {
            for value in isolate(pool, equations[k], unknown) {
                let next = self.with(pool, &equations, unknowns, &found, k, (unknown, value));
                if next.is_some() {
                    return next;
                }
            }
        }
        if let Some((rows, values)) = linear_part(pool, &equations, unknowns) {
            let rest = equations.iter().enumerate().filter(|(k, _)| !rows.contains(k));
            let mut rest: Vec<Expr> = rest.map(|(_, &e)| e).collect();
            let map: HashMap<Symbol, Expr> = values.iter().copied().collect();
            for e in &mut rest {
                *e = tidy(pool, *e, &map);
            }
            let mut found: Solution = found.clone();
            for (_, e) in &mut found {
                *e = tidy(pool, *e, &map);
            }
            found.extend(values);
            let left: Vec<Symbol> =
                unknowns.iter().copied().filter(|s| !map.contains_key(s)).collect();
            if let Some(solution) = self.step(pool, rest, &left, found) {
                return Some(solution);
            }
        }
        // y = s sin c, x = s cos c in place of atan2(y, x) = c
        for (k, &e) in equations.iter().enumerate() {
            let Some((y, x, angle)) = angle_of_two(pool, e, unknowns) else { continue };
            let s = pool.symbol("common factor of sine and cosine");
            if unknowns.contains(&s) {
                continue;
            }
            let factor = pool.variable(s);
            let mut equations = equations.clone();
            equations.remove(k);
            for (side, function) in [(y, FunctionId::Sin), (x, FunctionId::Cos)] {
                let part = pool.call(function, &[angle]);
                let part = pool.mul(factor, part);
                equations.push(pool.sub(side, part));
            }
            let unknowns = [unknowns, &[s]].concat();
            if let Some(solution) = self.step(pool, equations, &unknowns, found.clone()) {
                return Some(solution);
            }
        }
        // one unknown in terms of the others
        for k in 0..equations.len() {
            for unknown in of(pool, equations[k]) {
                for value in isolate(pool, equations[k], unknown) {
                    let next = self.with(pool, &equations, unknowns, &found, k, (unknown, value));
                    if next.is_some() {
                        return next;
                    }
                }
            }
        }
        None
    }

    /// Goes on with one unknown replaced by its value.
    fn with(
        &mut self,
        pool: &mut Pool,
        equations: &[Expr],
        unknowns: &[Symbol],
        found: &Solution,
        used: usize,
        (unknown, value): (Symbol, Expr),
    ) -> Option<Solution> {
        let value = pool.open_inverses(value);
        let value = pool.simplify(value);
        if pool.weight(value) > HEAVIEST {
            return None;
        }
        let map = HashMap::from([(unknown, value)]);
        let mut rest = equations.to_vec();
        rest.remove(used);
        for e in &mut rest {
            *e = tidy(pool, *e, &map);
        }
        let mut found: Solution = found.clone();
        for (_, e) in &mut found {
            *e = tidy(pool, *e, &map);
        }
        found.push((unknown, value));
        let left: Vec<Symbol> = unknowns.iter().copied().filter(|&s| s != unknown).collect();
        self.step(pool, rest, &left, found)
    }
}

/// An expression with values put in, in a shorter form.
pub(super) fn tidy(pool: &mut Pool, e: Expr, map: &HashMap<Symbol, Expr>) -> Expr {
    if !map.keys().any(|&s| pool.depends(e, s)) {
        return e;
    }
    let e = pool.substitute(e, map);
    let e = pool.open_inverses(e);
    pool.simplify(e)
}

/// Equations that are linear in as many unknowns, and the values of these.
fn linear_part(
    pool: &mut Pool,
    equations: &[Expr],
    unknowns: &[Symbol],
) -> Option<(Vec<usize>, Solution)> {
    let zeros: HashMap<Symbol, Expr> = unknowns.iter().map(|&s| (s, Expr::ZERO)).collect();
    let mut rows: Vec<(usize, Vec<Expr>)> = Vec::new();
    for (k, &e) in equations.iter().enumerate() {
        let slopes: Vec<Expr> = unknowns.iter().map(|&s| slope(pool, e, s)).collect();
        if slopes.iter().all(|&slope| !pool.depends_on_any(slope, unknowns)) {
            rows.push((k, slopes));
        }
    }
    let occurs: Vec<usize> =
        (0..unknowns.len()).filter(|&j| rows.iter().any(|(_, row)| row[j] != Expr::ZERO)).collect();
    if occurs.len() < 2 || occurs.len() != rows.len() {
        return None;
    }
    let matrix: Vec<Vec<Expr>> =
        rows.iter().map(|(_, row)| occurs.iter().map(|&j| row[j]).collect()).collect();
    let mut right = Vec::new();
    for (k, _) in &rows {
        let at_zero = pool.substitute(equations[*k], &zeros);
        right.push(pool.neg(at_zero));
    }
    let values = linear::solve(pool, &matrix, &right).ok()?.x.ok()?;
    let values: Vec<Expr> = values.into_iter().map(|e| without_inner_fractions(pool, e)).collect();
    let found = occurs.iter().map(|&j| unknowns[j]).zip(values).collect();
    Some((rows.into_iter().map(|(k, _)| k).collect(), found))
}

/// An equal expression in which no factor is a sum of fractions: `a/(x + y²/x) = a x/(x² + y²)`.
fn without_inner_fractions(pool: &mut Pool, e: Expr) -> Expr {
    let Node::Product(c, factors) = pool.node(e).clone() else { return e };
    let mut parts: Vec<(Expr, Number)> = Vec::new();
    for (base, n) in factors {
        let Node::Sum(constant, terms) = pool.node(base).clone() else {
            parts.push((base, n));
            continue;
        };
        let mut below: Vec<(Expr, i64)> = Vec::new();
        for (_, term) in &terms {
            let Node::Product(_, factors) = pool.node(*term) else { continue };
            for &(factor, power) in factors {
                let Some(power) = power.as_integer().filter(|&power| power < 0) else { continue };
                match below.iter_mut().find(|(known, _)| *known == factor) {
                    Some(known) => known.1 = known.1.max(-power),
                    None => below.push((factor, -power)),
                }
            }
        }
        let common: Vec<(Expr, Number)> =
            below.into_iter().map(|(factor, power)| (factor, Number::integer(power))).collect();
        let common = pool.monomial(Number::ONE, &common);
        let mut above = vec![(constant, common)];
        for (c, term) in terms {
            above.push((c, pool.mul(term, common)));
        }
        let above = pool.linear(Number::ZERO, &above);
        parts.extend([(above, n), (common, -n)]);
    }
    let e = pool.monomial(c, &parts);
    pool.simplify(e)
}

fn slope(pool: &mut Pool, e: Expr, symbol: Symbol) -> Expr {
    if !pool.depends(e, symbol) {
        return Expr::ZERO;
    }
    let slope = pool.derivative(e, symbol);
    let slope = zero_if_proved(pool, slope);
    pool.simplify(slope)
}

/// y, x and c of an equation atan2(y, x) = c in which unknowns occur in y and x alone.
fn angle_of_two(pool: &mut Pool, e: Expr, unknowns: &[Symbol]) -> Option<(Expr, Expr, Expr)> {
    for part in pool.reachable(&[e]) {
        let (y, x) = match pool.node(part) {
            Node::Call(FunctionId::Atan2, arguments) => (arguments[0], arguments[1]),
            Node::Call(FunctionId::Atan, arguments) => {
                let ratio = arguments[0];
                fraction(pool, ratio)
            }
            _ => continue,
        };
        if !pool.depends_on_any(y, unknowns) || !pool.depends_on_any(x, unknowns) {
            continue;
        }
        let z = pool.symbol("an angle to be found");
        let variable = pool.variable(z);
        let replaced = pool.replace(e, part, variable);
        if pool.depends_on_any(replaced, unknowns) {
            continue;
        }
        if let Some(angle) = isolate(pool, replaced, z).into_iter().next() {
            return Some((y, x, angle));
        }
    }
    None
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
fn fraction(pool: &mut Pool, e: Expr) -> (Expr, Expr) {
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
