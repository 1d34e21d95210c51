//! The path between two configurations that makes the action stationary, by Newton's method on
//! polynomials, and its Morse index.
//!
//! In: a Lagrangian, both ends, a duration, a path to begin with. Out: a [`StationaryPath`]. The
//! action is integrated by Lobatto's rule on the nodes of the polynomial, so that its stationary
//! points converge faster than any power of their number; the number of negative eigenvalues of the
//! second derivative is that of the second variation. Never here: conjugate points.
//! Source: *The Principles of Dynamics*, §§ 1.4.1, 3.5; J. Milnor, Morse Theory, § 15.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::action::{ActionExpansion, Lagrangian};
use super::error::DynamicsError;
use super::lobatto::Lobatto;

/// The degrees of the polynomials, one after the other until nothing changes.
const DEGREES: [usize; 7] = [12, 18, 26, 38, 56, 80, 112];

/// A path is resolved if a finer one differs by less, relative to its size.
const RESOLVED: f64 = 1e-11;

/// The number of steps of Newton's method.
const STEPS: usize = 80;

/// An eigenvalue of the second variation counts as zero below this fraction of the first of a free
/// particle.
const ZERO: f64 = 1e-8;

/// What is said of a search that is not wanted any more, and of one that takes too long.
const CANCELLED: &str = "the search was cancelled";
const TOO_LONG: &str = "the search takes too long";

/// The kind of a stationary path: whether its action is least among its neighbours.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum PathKind {
    /// The action is less on all of them.
    Minimum,
    /// It is not.
    Saddle,
    /// The second variation vanishes in some direction.
    Degenerate,
}

/// A path that makes the action stationary.
#[derive(Clone, Debug)]
pub struct StationaryPath {
    rule: Lobatto,
    /// The coordinates at the nodes, one column each.
    values: DMatrix<f64>,
    duration: f64,
    /// ∫ L dt.
    pub action: f64,
    /// The number of negative eigenvalues of the second variation.
    pub index: usize,
    /// What it is among its neighbours.
    pub kind: PathKind,
}

impl StationaryPath {
    /// q and q̇ at a time from the beginning.
    pub fn at(&self, time: f64) -> Vec<f64> {
        let coefficients = self.rule.interpolation(2.0 * time / self.duration - 1.0);
        let coefficients = DVector::from_vec(coefficients);
        let positions = &self.values * &coefficients;
        let slopes = &self.values * self.rule.derivative.transpose() * (2.0 / self.duration);
        let velocities = slopes * coefficients;
        positions.iter().chain(velocities.iter()).copied().collect()
    }
}

/// Why a search that is over has no path.
fn over(lagrangian: &Lagrangian) -> DynamicsError {
    no_path(if lagrangian.is_cancelled() { CANCELLED } else { TOO_LONG })
}

fn no_path(why: &str) -> DynamicsError {
    DynamicsError::Unsuited(why.to_owned())
}

/// Finds the stationary path near a guess, whose ends must be right.
///
/// # Errors
/// Returns an error if Newton's method comes to none, its path is not resolved, or the search is cancelled.
pub fn stationary_path(
    lagrangian: &mut Lagrangian,
    guess: &dyn Fn(f64) -> Vec<f64>,
    duration: f64,
) -> Result<StationaryPath, DynamicsError> {
    let n = lagrangian.degrees();
    let mut before: Option<StationaryPath> = None;
    for degree in DEGREES {
        if lagrangian.is_over() {
            return Err(over(lagrangian));
        }
        let rule = Lobatto::new(degree);
        let times: Vec<f64> = rule.nodes.iter().map(|x| 0.5 * duration * (1.0 + x)).collect();
        let at = |time: f64| match &before {
            Some(path) => path.at(time),
            None => guess(time),
        };
        let columns: Vec<Vec<f64>> = times.iter().map(|&time| at(time)).collect();
        let mut first = DMatrix::from_fn(n, degree + 1, |a, k| columns[k][a]);
        for (k, time) in [(0, 0.0), (degree, duration)] {
            // the ends stay exactly where they are given
            let end = guess(time);
            (0..n).for_each(|a| first[(a, k)] = end[a]);
        }
        let Some((values, expansion)) = newton(lagrangian, &rule, first.clone(), duration) else {
            if lagrangian.is_over() {
                return Err(over(lagrangian));
            }
            if before.is_some() || degree < DEGREES[2] {
                // a coarse polynomial may have no stationary point where a finer one has
                continue;
            }
            return Err(no_path(
                "Newton's method does not converge to a stationary path from there: begin with another one, \
                 --near x=EXPR(t)",
            ));
        };
        let settled = before.is_some() && {
            let size =
                values.amax().max((values.column(0) - values.column(degree)).amax()).max(1e-3);
            (&values - &first).amax() <= RESOLVED * size
        };
        let path = judged(rule, values, duration, &expansion);
        if settled {
            return Ok(path);
        }
        before = Some(path);
    }
    let over_kink = before.is_some_and(|path| passes_kink(lagrangian, &path));
    let why = if over_kink {
        "the path passes a kink of L, which no polynomial resolves: it cannot be computed"
    } else {
        "the path is not resolved by polynomials of degree 112: take a shorter time"
    };
    Err(DynamicsError::Unresolved(why.to_owned()))
}

/// Whether L has a kink between the nodes of a path.
fn passes_kink(lagrangian: &mut Lagrangian, path: &StationaryPath) -> bool {
    let times = path.rule.nodes.iter().map(|x| 0.5 * path.duration * (1.0 + x));
    let sides: Vec<Vec<bool>> =
        times.map(|time| lagrangian.switches(time, &path.at(time))).collect();
    sides.windows(2).any(|pair| pair[0] != pair[1])
}

/// The multiples of a guess that the search for the nearest path begins with: Newton's method may come to another one from a
/// guess that lies between two.
const MULTIPLES: [f64; 7] = [1.0, 1.2, 0.8, 1.5, 0.6, 2.0, 0.4];

const COMPARED: u32 = 64;

/// Finds, of the stationary paths to which Newton's method comes from a guess and from multiples of its distance to the
/// straight line, the one that is nearest to the guess.
///
/// # Errors
/// Returns the error from the guess itself, if it comes to none from the others either.
pub fn nearest_stationary_path(
    lagrangian: &mut Lagrangian,
    guess: &dyn Fn(f64) -> Vec<f64>,
    duration: f64,
) -> Result<StationaryPath, DynamicsError> {
    let ends = [guess(0.0), guess(duration)];
    let straight = |time: f64| -> Vec<f64> {
        let part = time / duration;
        ends[0].iter().zip(&ends[1]).map(|(a, b)| a + part * (b - a)).collect()
    };
    let distance = |path: &StationaryPath| {
        let at = |k: u32| {
            let time = duration * f64::from(k) / f64::from(COMPARED);
            let apart = guess(time).into_iter().zip(path.at(time)).map(|(a, b)| (a - b) * (a - b));
            apart.sum::<f64>()
        };
        (1..COMPARED).map(at).sum::<f64>()
    };
    let mut nearest: Option<(f64, StationaryPath)> = None;
    let mut failed = None;
    for multiple in MULTIPLES {
        if lagrangian.is_cancelled() {
            return Err(no_path(CANCELLED));
        }
        let begin = |time: f64| -> Vec<f64> {
            if time <= 0.0 || time >= duration {
                return guess(time);
            }
            let line = straight(time);
            guess(time).iter().zip(line).map(|(x, line)| line + multiple * (x - line)).collect()
        };
        match stationary_path(lagrangian, &begin, duration) {
            Ok(path) => {
                let away = distance(&path);
                if nearest.as_ref().is_none_or(|(least, _)| away < *least) {
                    nearest = Some((away, path));
                }
            }
            Err(why) => failed = failed.or(Some(why)),
        }
    }
    match (nearest, failed) {
        (Some((_, path)), _) => Ok(path),
        (None, Some(why)) => Err(why),
        (None, None) => Err(no_path("there is no path")),
    }
}

/// The stationary point near a path on nodes.
fn newton(
    lagrangian: &mut Lagrangian,
    rule: &Lobatto,
    mut path: DMatrix<f64>,
    duration: f64,
) -> Option<(DMatrix<f64>, ActionExpansion)> {
    let (n, inner) = (path.nrows(), rule.nodes.len() - 2);
    let norm = |expansion: &ActionExpansion| {
        let parts = expansion.gradient.iter().enumerate();
        // the gradient is that of an integral: weights are taken out
        parts.map(|(i, g)| g * g / rule.weights[i / n + 1]).sum::<f64>().sqrt()
    };
    let mut expansion = lagrangian.expand(rule, &path, duration)?;
    let mut last = f64::INFINITY;
    for _ in 0..STEPS {
        let step = expansion.hessian.clone().lu().solve(&expansion.gradient)?;
        let left = norm(&expansion);
        let size = path.amax().max(1e-3);
        let moved = |part: f64| {
            let mut trial = path.clone();
            for j in 0..inner {
                for a in 0..n {
                    trial[(a, j + 1)] -= part * step[j * n + a];
                }
            }
            trial
        };
        let small = step.amax() <= 1e-12 * size;
        let mut part = 1.0;
        let next = loop {
            let trial = moved(part);
            let after = lagrangian.expand(rule, &trial, duration);
            if let Some(after) = after.filter(|after| small || norm(after) < left) {
                break Some((trial, after));
            }
            part *= 0.5;
            if part < 1e-4 {
                break None;
            }
        };
        let Some(next) = next else {
            // at rounding there is nothing left to gain
            return (step.amax() <= 1e-9 * size).then_some((path, expansion));
        };
        (path, expansion) = next;
        if step.amax() <= 1e-15 * size || (small && step.amax() >= 0.5 * last) {
            return Some((path, expansion));
        }
        last = step.amax();
    }
    (last <= 1e-10 * path.amax().max(1e-3)).then_some((path, expansion))
}

/// The Morse index of a stationary path.
fn judged(
    rule: Lobatto,
    values: DMatrix<f64>,
    duration: f64,
    found: &ActionExpansion,
) -> StationaryPath {
    let n = values.nrows();
    let weight = |i: usize| (0.5 * duration * rule.weights[i / n + 1]).sqrt();
    let size = found.gradient.len();
    let scaled =
        DMatrix::from_fn(size, size, |i, j| found.hessian[(i, j)] / (weight(i) * weight(j)));
    let eigenvalues = SymmetricEigen::new(scaled).eigenvalues;
    let lowest = std::f64::consts::PI / duration;
    let free = found.inertia * lowest * lowest;
    let (index, kind) = index_and_kind(eigenvalues.as_slice(), free);
    StationaryPath { rule, values, duration, action: found.action, index, kind }
}

/// The number of negative eigenvalues of a second variation, and what they make of a path, where `free` is the first of a free
/// particle.
fn index_and_kind(eigenvalues: &[f64], free: f64) -> (usize, PathKind) {
    let zero = ZERO * free;
    let index = eigenvalues.iter().filter(|&&e| e < -zero).count();
    let degenerate = eigenvalues.iter().any(|&e| e.abs() <= zero);
    let kind = match (degenerate, index) {
        (true, _) => PathKind::Degenerate,
        (false, 0) => PathKind::Minimum,
        (false, _) => PathKind::Saddle,
    };
    (index, kind)
}

/// The index and kind of a path that is known to be stationary.
///
/// # Errors
/// Returns an error if L is not finite on the path.
pub fn morse_index(
    lagrangian: &mut Lagrangian,
    path: &dyn Fn(f64) -> Vec<f64>,
    duration: f64,
) -> Result<(usize, PathKind), DynamicsError> {
    let rule = Lobatto::new(56);
    let columns: Vec<Vec<f64>> =
        rule.nodes.iter().map(|x| path(0.5 * duration * (1.0 + x))).collect();
    let n = lagrangian.degrees();
    let values = DMatrix::from_fn(n, columns.len(), |a, k| columns[k][a]);
    let expansion = lagrangian
        .expand(&rule, &values, duration)
        .ok_or_else(|| no_path("L is not finite on this path"))?;
    let judged = judged(rule, values, duration, &expansion);
    Ok((judged.index, judged.kind))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_eigenvalue_is_zero_below_1e_8_of_the_first_of_a_free_particle() {
        for (eigenvalue, found) in [
            (2.1e-8, (0, PathKind::Minimum)),
            (1.9e-8, (0, PathKind::Degenerate)),
            (-1.9e-8, (0, PathKind::Degenerate)),
            (-2.1e-8, (1, PathKind::Saddle)),
        ] {
            assert_eq!(index_and_kind(&[3.0, eigenvalue], 2.0), found, "{eigenvalue}");
        }
    }
}
