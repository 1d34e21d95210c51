//! The generalised alignment indices of a motion.
//!
//! GALIₖ is the volume spanned by k unit tangent vectors carried along the motion (Ch. Skokos, T. Bountis, Ch. Antonopoulos,
//! Physica D 231 (2007) 30). Where the motion is chaotic it falls like exp(−((λ₁ − λ₂) + … + (λ₁ − λₖ)) t); on a torus of
//! N dimensions it stays of order 1 up to k = N and falls like t^{−2(k − N)} beyond.
//!
//! The vectors are Q C, with Q orthonormal and carried along, C upper triangular with unit columns. Each factor R of Q is
//! multiplied into C, whose diagonal is kept by its logarithms: the volume Π cᵢᵢ is known to its last digits, however small.
//!
//! In: a state, a time, a number of vectors. Out: ln GALI₂ … ln GALIₖ over time. Never here: verdicts, text.

use nalgebra::{DMatrix, DVector};

use super::carrier::Carrier;
use super::displacement_units::{displacement_units, scaled};
use super::error::DynamicsError;
use super::flow_direction::basis_of_range;
use super::lyapunov_course::{GROWN, LEAST_ROUNDS};
use super::phase_space::PhaseSpace;
use crate::integrate::{Method, Settings};
use crate::num::math;
use crate::system::State;

/// The indices of a motion.
#[derive(Clone, Debug)]
pub struct Gali {
    /// The times at which they were measured.
    pub times: Vec<f64>,
    /// At each time ln GALI₂, ln GALI₃, …
    pub logarithms: Vec<Vec<f64>>,
    /// Why the motion ended early.
    pub error: Option<DynamicsError>,
}

impl Gali {
    /// ln GALIₖ over time.
    pub fn of(&self, k: usize) -> Vec<(f64, f64)> {
        let place = k.wrapping_sub(2);
        let rows = self.times.iter().zip(&self.logarithms);
        rows.filter_map(|(t, row)| Some((*t, *row.get(place)?))).collect()
    }
}

/// Follows a motion from a state of the space until a time, with so many tangent vectors, and `report`s the time after each step.
///
/// # Errors
/// Returns an error if there are fewer than two vectors or more than variables, or the motion cannot begin. If it cannot
/// continue, or is cancelled, the result is that of the time reached.
pub fn gali(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    (start, until): (&State, f64),
    count: usize,
    report: &mut dyn FnMut(f64),
) -> Result<Gali, DynamicsError> {
    let n = space.dimension();
    let (allowed, dimension) = space.allowed_displacements(start)?;
    if !(2..=dimension).contains(&count) {
        let why = format!(
            "GALI takes from 2 to {dimension} tangent vectors here, as many as are independent"
        );
        return Err(DynamicsError::WrongRequest(why));
    }
    if until <= start.time {
        let why = "GALI is measured over the time to come: the end lies after the start";
        return Err(DynamicsError::WrongRequest(why.to_owned()));
    }
    // vectors in general position
    let general = DMatrix::from_fn(n, count, |i, j| {
        math::sin(1.0 + 2.4 * (i as f64 + 1.0) * (j as f64 + 1.0)) + f64::from(u8::from(i == j))
    });
    // in units, else a volume is that of the largest component
    let units = displacement_units(space, start, until - start.time);
    let in_units = units.map(|unit| 1.0 / unit);
    let mut vectors = (allowed * general).qr().q();
    let mut carrier = Carrier::new(space, method, settings, count)?;
    carrier.start(start, &scaled(&vectors, &units))?;
    let mut unit = DMatrix::<f64>::identity(count, count);
    let mut diagonal = vec![0.0; count];
    let mut found = Gali { times: Vec::new(), logarithms: Vec::new(), error: None };
    let (round, mut last) = ((until - start.time) / LEAST_ROUNDS, start.time);
    while carrier.is_before(until, true) {
        if let Err(error) = carrier.step(until) {
            found.error = Some(DynamicsError::Motion(error));
            break;
        }
        let (_, end) = carrier.interval();
        let (state, now) = carrier.at(end)?;
        report(end);
        vectors = scaled(&now, &in_units);
        let grown = vectors.column_iter().any(|v| !(1.0 / GROWN..GROWN).contains(&v.norm()));
        let due = grown || end - last >= round || end >= until;
        if !due || carrier.awaits_occurrence() {
            continue;
        }
        if space.is_constrained() {
            // what rounding has left outside grows, beside vectors that shrink
            let (allowed, dimension) = space.allowed_displacements(&state)?;
            let basis = basis_of_range(&allowed, dimension);
            vectors = &basis * (basis.transpose() * vectors);
        }
        let (q, r) = positive(vectors.clone());
        unit = &r * unit;
        for (i, sum) in diagonal.iter_mut().enumerate() {
            let norm = unit.column(i).norm();
            *sum += math::ln(r[(i, i)]) - math::ln(norm);
            let column: DVector<f64> = unit.column(i) / norm;
            unit.set_column(i, &column);
        }
        let mut volume = diagonal[0];
        let row = diagonal[1..].iter().map(|x| {
            volume += x;
            volume
        });
        found.logarithms.push(row.collect());
        found.times.push(end);
        last = end;
        carrier.start(&state, &scaled(&q, &units))?;
    }
    Ok(found)
}

/// Q R of a matrix, with a positive diagonal of R.
fn positive(matrix: DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let (mut q, mut r) = matrix.qr().unpack();
    for i in 0..r.nrows() {
        if r[(i, i)] < 0.0 {
            r.row_mut(i).neg_mut();
            q.column_mut(i).neg_mut();
        }
    }
    (q, r)
}
