//! Between which values an expression lies, as far as its form alone shows.
//!
//! In: an expression. Out: whether it is negative for no values of its symbols, or keeps one sign. Never here: values of
//! symbols.

use super::{Expr, FunctionId, Node, Pool};
use crate::num::Number;

/// The range of an expression with more nodes than this, written out, is not computed.
const HEAVY: u64 = 10_000;

/// The number of kinks on both sides of which an expression is evaluated, in all combinations.
const KINKS: usize = 4;

/// A function that is known to be positive, or negative.
type Sided = (Expr, bool);

/// Returns whether the form of an expression alone shows that it is negative nowhere, or positive nowhere, on every side of
/// each kink, as |x| − x.
pub fn keeps_its_sign(pool: &mut Pool, e: Expr) -> bool {
    if pool.weight(e) > HEAVY {
        return false;
    }
    let opened = pool.open_roots(e);
    [e, opened].into_iter().any(|e| {
        let opposite = pool.neg(e);
        [e, opposite].into_iter().any(|e| is_never_negative_beside(pool, e, &mut Vec::new()))
    })
}

/// Whether an expression is nonnegative where some functions have these signs.
fn is_never_negative_beside(pool: &mut Pool, e: Expr, known: &mut Vec<Sided>) -> bool {
    if is_nonnegative(pool, e, known) {
        return true;
    }
    let Some(switch) = pool.first_switch(e).filter(|_| known.len() < KINKS) else { return false };
    [true, false].into_iter().all(|positive| {
        let side = pool.on_side(e, switch, positive);
        known.push((switch, positive));
        let holds = is_never_negative_beside(pool, side, known);
        known.pop();
        holds
    })
}

/// Returns whether the form of an expression alone shows that it is nonnegative for all real values of its symbols: by the
/// ranges of its functions, or in a sum because each term that may be negative is outweighed by two squares, as in the law
/// of cosines.
pub fn is_never_negative(pool: &Pool, e: Expr) -> bool {
    is_nonnegative(pool, e, &[])
}

fn is_nonnegative(pool: &Pool, e: Expr, known: &[Sided]) -> bool {
    if pool.weight(e) > HEAVY {
        return false;
    }
    if range(pool, e, known).0 >= 0.0 {
        return true;
    }
    let Node::Sum(constant, terms) = pool.node(e) else { return false };
    let monomial = |&(c, term): &(Number, Expr)| match pool.node(term) {
        Node::Product(k, factors) => (c.value() * k.value(), factors.to_vec()),
        _ => (c.value(), vec![(term, Number::ONE)]),
    };
    let (mut squares, mut others) = (vec![(constant.value(), Vec::new())], Vec::new());
    for (c, factors) in terms.iter().map(monomial) {
        let even = |(_, n): &(Expr, Number)| matches!(n, Number::Rational(n, 1) if n % 2 == 0);
        let list = if factors.iter().all(even) { &mut squares } else { &mut others };
        list.push((c, factors));
    }
    squares.iter().all(|(c, _)| *c >= 0.0)
        && others.iter().all(|(c, factors)| {
            // what lies between −1 and 1 counts as 1
            let free: Vec<(Expr, Number)> = factors
                .iter()
                .filter(|(b, n)| n.value() < 0.0 || !within_one(pool, *b, known))
                .copied()
                .collect();
            let pairs = (0..squares.len()).flat_map(|j| (0..=j).map(move |i| (i, j)));
            let outweighs = |&(i, j): &(usize, usize)| {
                let ((p, a), (q, b)) = (&squares[i], &squares[j]);
                // a single square is its own half
                let most = if i == j { p * p } else { 4.0 * p * q };
                c * c <= most && is_square_of(&free, a, b)
            };
            let found = pairs.collect::<Vec<_>>().into_iter().find(outweighs);
            found.is_some_and(|(i, j)| {
                squares.remove(j);
                if i != j {
                    squares.remove(i);
                }
                true
            })
        })
}

/// Whether a monomial squared is the product of two others.
fn is_square_of(m: &[(Expr, Number)], a: &[(Expr, Number)], b: &[(Expr, Number)]) -> bool {
    let power = |list: &[(Expr, Number)], base: Expr| {
        list.iter().filter(|(b, _)| *b == base).map(|(_, n)| n.value()).sum::<f64>()
    };
    let bases = m.iter().chain(a).chain(b).map(|(base, _)| *base);
    bases.into_iter().all(|base| 2.0 * power(m, base) == power(a, base) + power(b, base))
}

/// Whether the values of an expression lie between −1 and 1.
fn within_one(pool: &Pool, e: Expr, known: &[Sided]) -> bool {
    let (least, most) = range(pool, e, known);
    least >= -1.0 && most <= 1.0
}

/// The sign of an expression that is a multiple of a function whose sign is known: whether it is positive.
fn known_sign(pool: &Pool, e: Expr, known: &[Sided]) -> Option<bool> {
    known.iter().find_map(|&(function, positive)| {
        let ratio = ratio(pool, e, function)?;
        Some(positive == (ratio > 0.0))
    })
}

/// The constant ratio of two expressions, if their forms show one.
fn ratio(pool: &Pool, a: Expr, b: Expr) -> Option<f64> {
    let [(c, first), (d, second)] = [a, b].map(|e| match pool.node(e) {
        Node::Sum(constant, terms) => (*constant, terms.to_vec()),
        Node::Product(k, factors) => match factors[..] {
            [(base, Number::Rational(1, 1))] => (Number::ZERO, vec![(*k, base)]),
            _ => (Number::ZERO, vec![(Number::ONE, e)]),
        },
        _ => (Number::ZERO, vec![(Number::ONE, e)]),
    });
    let ratio = first.first()?.0 * second.first()?.0.recip();
    let mut pairs = first.iter().zip(&second);
    let same = first.len() == second.len()
        && c == ratio * d
        && pairs.all(|(&(m, a), &(n, b))| a == b && m == ratio * n);
    same.then_some(ratio.value())
}

/// Between which values the form of an expression shows it to lie.
fn range(pool: &Pool, e: Expr, known: &[Sided]) -> (f64, f64) {
    const ALL: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);
    match known_sign(pool, e, known) {
        Some(true) => return (0.0, f64::INFINITY),
        Some(false) => return (f64::NEG_INFINITY, 0.0),
        None => {}
    }
    match pool.node(e) {
        Node::Number(n) => (n.value(), n.value()),
        Node::Pi => (3.0, 4.0),
        Node::Symbol(_) | Node::Power(..) => ALL,
        Node::Sum(constant, terms) => {
            let start = (constant.value(), constant.value());
            terms.iter().fold(start, |(least, most), (c, term)| {
                let (a, b) = times((c.value(), c.value()), range(pool, *term, known));
                (least + a, most + b)
            })
        }
        Node::Product(c, factors) => {
            factors.iter().fold((c.value(), c.value()), |product, (base, n)| {
                let (least, most) = range(pool, *base, known);
                let factor = match n {
                    Number::Rational(1, 1) => (least, most),
                    Number::Rational(n, 1) if n % 2 == 0 => {
                        let size = least.abs().max(most.abs());
                        (0.0, if *n > 0 && size <= 1.0 { 1.0 } else { f64::INFINITY })
                    }
                    _ if least >= 0.0 => (0.0, f64::INFINITY),
                    Number::Rational(_, 1) if most <= 0.0 => (f64::NEG_INFINITY, 0.0),
                    // an even root is nonnegative wherever it has a value
                    Number::Rational(_, below) if below % 2 == 0 => (0.0, f64::INFINITY),
                    _ => ALL,
                };
                times(product, factor)
            })
        }
        Node::Call(function, arguments) => match function {
            FunctionId::Sin | FunctionId::Cos | FunctionId::Tanh | FunctionId::Sign => (-1.0, 1.0),
            FunctionId::Cosh => (1.0, f64::INFINITY),
            FunctionId::Exp | FunctionId::Abs | FunctionId::Acos => (0.0, f64::INFINITY),
            FunctionId::Max | FunctionId::Min => {
                let ranges = arguments.iter().map(|a| range(pool, *a, known));
                let larger = *function == FunctionId::Max;
                let of = |a: f64, b: f64| if larger { a.max(b) } else { a.min(b) };
                ranges.reduce(|(a, b), (c, d)| (of(a, c), of(b, d))).unwrap_or(ALL)
            }
            _ => ALL,
        },
    }
}

fn times((a, b): (f64, f64), (c, d): (f64, f64)) -> (f64, f64) {
    // nothing times what is unbounded is nothing
    let product = |x: f64, y: f64| if x == 0.0 || y == 0.0 { 0.0 } else { x * y };
    let all = [product(a, c), product(a, d), product(b, c), product(b, d)];
    let least = all.iter().copied().fold(f64::INFINITY, f64::min);
    (least, all.iter().copied().fold(f64::NEG_INFINITY, f64::max))
}
