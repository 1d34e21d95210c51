//! The roots of a polynomial in an interval, with guaranteed isolation: intervals are halved until
//! Descartes' rule of signs, applied to Bernstein coefficients, leaves one root or none (G. E.
//! Collins, A. G. Akritas, Proc. SYMSAC '76, 272; J. M. Lane, R. F. Riesenfeld, BIT 21 (1981) 112),
//! and a bracketed Newton iteration refines it.

use crate::num::{ALL_HALVINGS, DoubleDouble};

/// The maximal number of coefficients of a polynomial.
const CAPACITY: usize = 64;

/// The truncation error of a series, as a part of its function, and the multiple of it that a root is kept away by.
pub(super) const CUT_OFF: f64 = 1e-13;
const MARGIN: f64 = 4.0;

/// Roots closer together than `end / 2^DEPTH` count as a touch, not as two crossings.
const DEPTH: u32 = 48;

/// The first point in `(0, end]` where a polynomial that is positive just after 0 becomes negative; `None` if it stays
/// positive. `coefficients[k]` belongs to `x^k`; there are at most 64.
pub fn first_crossing(coefficients: &[f64], end: f64) -> Option<f64> {
    sign_changes(coefficients, end).find(|change| !change.rises).map(|change| change.x)
}

/// A point where a polynomial changes its sign.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct SignChange {
    pub(super) x: f64,
    /// Whether the polynomial is positive after it.
    pub(super) rises: bool,
}

/// Returns the points in `(0, end]` where a polynomial changes its sign, in order.
/// `coefficients[k]` belongs to `x^k`; there are at most 64. Points where it only touches zero are
/// not included.
pub(super) fn sign_changes(coefficients: &[f64], end: f64) -> impl Iterator<Item = SignChange> {
    let n = coefficients.len().min(CAPACITY);
    let mut bernstein = [0.0; CAPACITY];
    let mut power = 1.0;
    let mut others = 0.0;
    for (b, &c) in bernstein.iter_mut().zip(coefficients) {
        *b = c * power;
        others += b.abs();
        power *= end;
    }
    let mut waiting = Vec::new();
    let mut straight = None;
    if n > 0 && others.is_finite() && bernstein[0].abs() <= others - bernstein[0].abs() {
        match monotone(&bernstein[..n], others) {
            Some(ends) => straight = bracket(ends, 0.0, 1.0),
            None => {
                to_bernstein(&mut bernstein[..n]);
                waiting.push(PolynomialPiece { bernstein, from: 0.0, width: 1.0, depth: 0 });
            }
        }
    }
    let brackets = straight.into_iter().chain(Brackets { n, waiting, sign: 0.0 });
    brackets.map(move |Bracket { from, to, rises }| {
        let sign = if rises { 1.0 } else { -1.0 };
        let x = if from == to {
            from * end
        } else {
            refine(&coefficients[..n], sign, from * end, to * end)
        };
        SignChange { x, rises }
    })
}

/// A value at an end that is less than this part of the terms may be rounding.
const SIGNLESS: f64 = 1e-12;

/// The values at both ends of the unit interval of a polynomial whose slope surely keeps its sign there, so that all its
/// Bernstein coefficients rise, or all fall; `None` otherwise, and where a value may be rounding.
fn monotone(c: &[f64], size: f64) -> Option<(f64, f64)> {
    let (first, slope) = (*c.first()?, *c.get(1)?);
    let (mut end, mut others) = (first + slope, 0.0);
    for (k, x) in c.iter().enumerate().skip(2) {
        end += x;
        others += k as f64 * x.abs();
    }
    let is_clear = |value: f64| value.abs() > SIGNLESS * size;
    (others < slope.abs() && is_clear(first) && is_clear(end)).then_some((first, end))
}

/// The interval as a bracket, if the values at its ends have opposite signs.
fn bracket((first, last): (f64, f64), from: f64, to: f64) -> Option<Bracket> {
    (first * last < 0.0).then_some(Bracket { from, to, rises: last > 0.0 })
}

/// A part of the unit interval in which a polynomial changes its sign once.
struct Bracket {
    from: f64,
    to: f64,
    rises: bool,
}

/// An iterator over the parts in which a polynomial changes its sign.
struct Brackets {
    n: usize,
    /// The parts still to be examined, the first one last.
    waiting: Vec<PolynomialPiece>,
    /// The sign at the end of the examined parts; zero before it is known.
    sign: f64,
}

impl Iterator for Brackets {
    type Item = Bracket;

    fn next(&mut self) -> Option<Bracket> {
        while let Some(piece) = self.waiting.pop() {
            let Signs { changes, first, last } = signs(&piece.bernstein[..self.n]);
            let (from, to) = (piece.from, piece.from + piece.width);
            if first != 0.0 && self.sign * first < 0.0 {
                // between two pieces; this one is still to be examined
                self.waiting.push(piece);
                self.sign = first;
                return Some(Bracket { from, to: from, rises: first > 0.0 });
            }
            if changes > 1 && piece.depth < DEPTH {
                let (left, right) = piece.halves(self.n);
                self.waiting.extend([right, left]);
                continue;
            }
            if last != 0.0 {
                self.sign = last;
            }
            if let Some(found) = bracket((first, last), from, to) {
                return Some(found);
            }
        }
        None
    }
}

/// A polynomial on a part of the unit interval.
struct PolynomialPiece {
    bernstein: [f64; CAPACITY],
    from: f64,
    width: f64,
    depth: u32,
}

impl PolynomialPiece {
    /// Returns both halves, by de Casteljau's algorithm.
    fn halves(&self, n: usize) -> (PolynomialPiece, PolynomialPiece) {
        let mut right = self.bernstein;
        let mut left = [0.0; CAPACITY];
        for i in 0..n {
            left[i] = right[0];
            for j in 0..n - 1 - i {
                right[j] = 0.5 * (right[j] + right[j + 1]);
            }
        }
        // `right` now contains the other half, from its end to its beginning
        let (width, depth) = (0.5 * self.width, self.depth + 1);
        let middle = self.from + width;
        (
            PolynomialPiece { bernstein: left, from: self.from, width, depth },
            PolynomialPiece { bernstein: right, from: middle, width, depth },
        )
    }
}

/// Converts from powers to Bernstein's basis: `b_i = Σ_{k≤i} C(i,k)/C(n,k) a_k`.
fn to_bernstein(a: &mut [f64]) {
    let n = a.len() - 1;
    let mut binomial = 1.0;
    for k in 0..=n {
        a[k] /= binomial;
        binomial = binomial * (n - k) as f64 / (k + 1) as f64;
    }
    for k in 1..=n {
        for i in (k..=n).rev() {
            a[i] += a[i - 1];
        }
    }
}

struct Signs {
    changes: u32,
    /// The first sign that is not zero; zero if there is none.
    first: f64,
    last: f64,
}

fn signs(list: &[f64]) -> Signs {
    let mut signs = Signs { changes: 0, first: 0.0, last: 0.0 };
    for sign in list.iter().filter(|x| **x != 0.0).map(|x| x.signum()) {
        if signs.first == 0.0 {
            signs.first = sign;
        } else if sign != signs.last {
            signs.changes += 1;
        }
        signs.last = sign;
    }
    signs
}

/// The root between `low` and `high`, after which the polynomial has this sign: by Newton's step if
/// it stays inside, else by bisection.
fn refine(coefficients: &[f64], sign: f64, mut low: f64, mut high: f64) -> f64 {
    let mut x = 0.5 * (low + high);
    for _ in 0..ALL_HALVINGS {
        let (value, slope) = value_and_slope(coefficients, x);
        if value * sign < 0.0 {
            low = x;
        } else if value * sign > 0.0 {
            high = x;
        } else {
            return x;
        }
        let newton = x - value / slope;
        let next = if low < newton && newton < high { newton } else { 0.5 * (low + high) };
        if next == x || next == low || next == high {
            return next;
        }
        x = next;
    }
    x
}

/// A root of a truncated series on the function itself, to the precision of the lowest orders. A root of higher order is known to
/// fewer digits and stays.
pub(super) fn refined(
    coefficients: &[f64],
    x: f64,
    function: impl Fn(DoubleDouble) -> DoubleDouble,
) -> DoubleDouble {
    let mut x = DoubleDouble::from(x);
    for _ in 0..2 {
        let correction = function(x) / value_and_slope(coefficients, x.high).1;
        if correction.high.abs() < 1e-6 * x.high {
            x = x - correction;
        }
    }
    x
}

/// How far a root of a function may lie from that of its truncated series.
pub(super) fn root_error(coefficients: &[f64], x: f64) -> f64 {
    let size = coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c.abs());
    let error = MARGIN * CUT_OFF * size / value_and_slope(coefficients, x).1.abs();
    if error.is_finite() { error } else { 0.0 }
}

/// Evaluates a polynomial and its derivative.
pub(super) fn value_and_slope(coefficients: &[f64], x: f64) -> (f64, f64) {
    coefficients
        .iter()
        .rev()
        .fold((0.0, 0.0), |(value, slope), &c| (value * x + c, slope * x + value))
}
