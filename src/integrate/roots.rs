//! The first root of a polynomial in an interval, found for certain: intervals are halved until
//! Descartes' rule of signs, applied to Bernstein coefficients, leaves one root or none
//! (G. E. Collins, A. G. Akritas, Proc. SYMSAC '76, 272; J. M. Lane, R. F. Riesenfeld, BIT 21
//! (1981) 112), and a bracketed Newton iteration finishes.

/// The most coefficients a polynomial may have.
const CAPACITY: usize = 64;

/// Roots closer together than `end / 2^DEPTH` count as a touch, not as two crossings.
const DEPTH: u32 = 48;

/// The first place in `(0, end]` where a polynomial that is positive just after 0 becomes
/// negative. `coefficients[k]` belongs to `x^k`; there are at most 64.
pub fn first_crossing(coefficients: &[f64], end: f64) -> Option<f64> {
    let n = coefficients.len().min(CAPACITY);
    let mut bernstein = [0.0; CAPACITY];
    let mut power = 1.0;
    let mut others = 0.0;
    for (b, &c) in bernstein.iter_mut().zip(coefficients) {
        *b = c * power;
        others += b.abs();
        power *= end;
    }
    if !others.is_finite() || bernstein[0] > others - bernstein[0].abs() {
        return None;
    }
    to_bernstein(&mut bernstein[..n]);
    let piece = Piece { bernstein, from: 0.0, width: 1.0, depth: 0 };
    let [from, to] = piece.first_bracket(n)?;
    Some(refine(&coefficients[..n], from * end, to * end))
}

/// A polynomial on a part of the unit interval.
struct Piece {
    bernstein: [f64; CAPACITY],
    from: f64,
    width: f64,
    depth: u32,
}

impl Piece {
    /// The first part of this piece that holds exactly one change to negative values.
    fn first_bracket(mut self, n: usize) -> Option<[f64; 2]> {
        let mut waiting: Vec<Piece> = Vec::new();
        loop {
            let (changes, falls) = sign_changes(&self.bernstein[..n]);
            if changes == 1 && falls {
                return Some([self.from, self.from + self.width]);
            }
            if changes > 1 && self.depth < DEPTH {
                let (left, right) = self.halves(n);
                waiting.push(right);
                self = left;
            } else {
                self = waiting.pop()?;
            }
        }
    }

    /// Both halves, by de Casteljau's scheme.
    fn halves(&self, n: usize) -> (Piece, Piece) {
        let mut right = self.bernstein;
        let mut left = [0.0; CAPACITY];
        for i in 0..n {
            left[i] = right[0];
            for j in 0..n - 1 - i {
                right[j] = 0.5 * (right[j] + right[j + 1]);
            }
        }
        // what is left in `right` is the other half, from its end to its beginning
        let (width, depth) = (0.5 * self.width, self.depth + 1);
        let middle = self.from + width;
        (
            Piece { bernstein: left, from: self.from, width, depth },
            Piece { bernstein: right, from: middle, width, depth },
        )
    }
}

/// From powers to Bernstein's basis: `b_i = Σ_{k≤i} C(i,k)/C(n,k) a_k`.
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

/// How often the signs of a list change, and whether the first change is one to minus.
fn sign_changes(list: &[f64]) -> (u32, bool) {
    let (mut changes, mut falls, mut last) = (0, false, 0.0);
    for &x in list.iter().filter(|x| **x != 0.0) {
        if last * x.signum() < 0.0 {
            falls |= changes == 0 && x < 0.0;
            changes += 1;
        }
        last = x.signum();
    }
    (changes, falls)
}

/// The root between `low`, where the polynomial is positive, and `high`, where it is negative:
/// Newton's step where it stays inside, else halving.
fn refine(coefficients: &[f64], mut low: f64, mut high: f64) -> f64 {
    let mut x = 0.5 * (low + high);
    for _ in 0..200 {
        let (value, slope) = value_and_slope(coefficients, x);
        if value > 0.0 {
            low = x;
        } else if value < 0.0 {
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

/// A polynomial and its derivative.
pub(super) fn value_and_slope(coefficients: &[f64], x: f64) -> (f64, f64) {
    coefficients
        .iter()
        .rev()
        .fold((0.0, 0.0), |(value, slope), &c| (value * x + c, slope * x + value))
}
