//! A place at which the rates vanish, approached from one near it.
//!
//! Each step solves f + J s = 0 by the method of Levenberg and Marquardt, damped by |f| over a distance: where J falls away in some
//! direction with f, as along a family of equilibria, the step has no part in that direction, and elsewhere it is Newton's (N. Yamashita,
//! M. Fukushima, Computing Suppl. 15, 239 (2001)). Where the rates vanish to a higher order, as those of V = x⁴ do, the steps shrink by a
//! constant factor 1 − 1/m, and m of them are taken at once (E. Schröder, Math. Ann. 2, 317 (1870)).
//!
//! In: a place in the units of the search, and directions in which it must not move. Out: the place, to rounding. Never here: what is
//! around it.

use nalgebra::{DMatrix, DVector};

use super::search::{EquilibriumSearch, size_of};

const STEPS: usize = 80;

/// The distance over which rates are compared with their derivative, in the size of the place.
const REACH: f64 = 0.1;

/// Where no step makes the rates smaller there is a zero only if the last one is no more than this part of the place: in the tails of
/// forces, as x⁻⁷, it is a seventh.
const NEAR_ITS_ZERO: f64 = 1e-3;

/// Where the last step is no more than this part of the place, the rates need not be their rounding error: those of V = x²⁰ are smaller
/// far from their zero.
const AT_ITS_ZERO: f64 = 1e-9;

/// A step leads on where the next one is less than this part of it, or what is left of the rates less than this part of them.
const SHRINKS: f64 = 0.97;
const FALLS: f64 = 0.9;

/// Along a curved valley the way leads now across it, now along: so many steps are taken that do not lead on.
const IN_VAIN: usize = 3;

/// A zero is no farther than this multiple of a step towards it.
const ABOVE_STEP: f64 = 8.0;

/// A step is a part of the one before it where it converges linearly: that of a zero of order m is 1 − 1/m.
const LINEAR: std::ops::Range<f64> = 0.4..0.999;

/// The error of rates is searched for in so many places beside one, this far apart in its size, and counts so many times.
const NOISE_SAMPLES: u32 = 8;
const NOISE_DISTANCE: f64 = 1e-11;
const ABOVE_NOISE: f64 = 64.0;

impl EquilibriumSearch<'_> {
    /// The place at which the rates vanish that is reached from one near it, without a step along the `excluded` directions, which are
    /// orthonormal. `None` where the rates do not vanish, or keep shrinking without a zero, as in the tail of V = exp(−x²).
    pub(super) fn approached(
        &mut self,
        from: &DVector<f64>,
        excluded: &[DVector<f64>],
    ) -> Option<DVector<f64>> {
        let mut place = from.clone();
        let (mut f, df) = self.evaluate(&place)?;
        let mut correction = Correction::new(&df, &f, excluded, size_of(&place))?;
        let mut best = (place.clone(), f.clone(), correction.clone());
        let (mut before, mut vain): (Option<DVector<f64>>, usize) = (None, 0);
        for _ in 0..STEPS {
            let size = size_of(&place);
            let step = &correction.step;
            let ratio = before.as_ref().map_or(0.0, |last| step.dot(last) / last.norm_squared());
            let jump = multiplicity(ratio);
            let least = best.2.step.amax() <= f64::EPSILON * size;
            let mut next = None;
            for multiple in jump.into_iter().chain([1.0]).filter(|_| !least) {
                let there = &place + step * multiple;
                let Some((g, dg)) = self.evaluate(&there) else { continue };
                let Some(after) = Correction::new(&dg, &g, excluded, size) else { continue };
                let (_, f, one) = &best;
                let steps = [after.step.norm(), one.step.norm()];
                let shrinks = leads_on(steps, [one.left(&g), one.left(f)]);
                next = Some((there, g, after, multiple, shrinks));
                if shrinks {
                    break;
                }
            }
            let is_better = next.as_ref().is_some_and(|next| next.4);
            vain = if is_better { 0 } else { vain + 1 };
            let Some((there, g, after, multiple, _)) = next.filter(|_| vain < IN_VAIN) else {
                let (place, _, last) = best;
                return self.vanishes(&place, excluded, &last.step).then_some(place);
            };
            let last = std::mem::replace(&mut correction, after).step;
            before = (multiple == 1.0).then_some(last);
            (place, f) = (there, g);
            if is_better {
                best = (place.clone(), f.clone(), correction.clone());
            }
        }
        None
    }

    /// How far from a place at which the rates vanish their zero may be, across the `excluded` directions: by what is left of them, and by
    /// their rounding error.
    pub(super) fn uncertainty(
        &mut self,
        place: &DVector<f64>,
        excluded: &[DVector<f64>],
    ) -> Option<DVector<f64>> {
        let (f, df) = self.evaluate(place)?;
        let noise = self.noise(place, &f, &df)?;
        let size = size_of(place);
        let [left, lost] = [f, noise].map(|f| Correction::new(&df, &f, excluded, size));
        Some((left?.step.abs() + lost?.step.abs()) * ABOVE_STEP)
    }

    /// Whether rates that no step across the `excluded` directions makes smaller vanish, the last of which was this one: there is a zero, and
    /// it is no farther along these directions either, or what is left is rounding.
    fn vanishes(
        &mut self,
        place: &DVector<f64>,
        excluded: &[DVector<f64>],
        step: &DVector<f64>,
    ) -> bool {
        let size = size_of(place);
        if is_far_from_zero(step.amax(), size) {
            return false;
        }
        let Some((f, df)) = self.evaluate(place) else { return false };
        let whole = if excluded.is_empty() {
            Some(step.clone())
        } else {
            Correction::new(&df, &f, &[], size).map(|one| one.step)
        };
        whole.is_some_and(|step| is_at_zero(step.amax(), size))
            || self
                .noise(place, &f, &df)
                .is_some_and(|noise| f.iter().zip(&noise).all(|(&f, &noise)| is_noise(f, noise)))
    }

    /// The rounding error of each rate at a place: what its change over a tiny distance has beside the linear part.
    pub(super) fn noise(
        &mut self,
        place: &DVector<f64>,
        f: &DVector<f64>,
        df: &DMatrix<f64>,
    ) -> Option<DVector<f64>> {
        let mut noise = DVector::zeros(f.len());
        for (i, row) in df.row_iter().enumerate() {
            let terms = row.iter().zip(place).map(|(slope, x)| slope.abs() * x.abs().max(1.0));
            noise[i] = f64::EPSILON * terms.sum::<f64>();
        }
        for step in 1..=NOISE_SAMPLES {
            let moved = NOISE_DISTANCE * size_of(place) * f64::from(step);
            let (g, _) = self.evaluate(&place.add_scalar(moved))?;
            let linear = f + df * DVector::from_element(df.ncols(), moved);
            let apart = g - linear;
            noise.zip_apply(&apart, |noise, apart| *noise = noise.max(apart.abs()));
        }
        Some(noise)
    }
}

/// Whether a step leads on: by the next step and itself, or by what is left of the rates and what they were.
fn leads_on([after, step]: [f64; 2], [left, rates]: [f64; 2]) -> bool {
    after < SHRINKS * step || left < FALLS * rates
}

/// The order of a zero to which steps shrink by a constant ratio, if they do.
fn multiplicity(ratio: f64) -> Option<f64> {
    LINEAR.contains(&ratio).then_some(1.0 / (1.0 - ratio))
}

/// Whether a last step is too long for a zero to be there, in the size of the place.
fn is_far_from_zero(step: f64, size: f64) -> bool {
    step > NEAR_ITS_ZERO * size
}

/// Whether a last step is so short that a zero is there, whatever the rates.
fn is_at_zero(step: f64, size: f64) -> bool {
    step <= AT_ITS_ZERO * size
}

/// Whether a rate is no more than its rounding error.
fn is_noise(rate: f64, noise: f64) -> bool {
    rate.abs() <= ABOVE_NOISE * noise
}

/// A step towards a zero.
#[derive(Clone)]
struct Correction {
    step: DVector<f64>,
    /// The largest slope of each rate.
    slopes: DVector<f64>,
}

impl Correction {
    /// The damped step in which f + J s vanishes, across the `excluded` directions. Rates count by their own slopes, so that something soft
    /// is seen beside what is stiff.
    fn new(
        df: &DMatrix<f64>,
        f: &DVector<f64>,
        excluded: &[DVector<f64>],
        size: f64,
    ) -> Option<Correction> {
        let across = |vector: &mut DVector<f64>| {
            for one in excluded {
                let along = one.dot(vector);
                vector.axpy(-along, one, 1.0);
            }
        };
        let (rows, columns) = df.shape();
        // the rows of the damping are below those of the slopes
        let mut matrix = df.clone().resize_vertically(rows + columns, 0.0);
        let mut rates = f.clone().resize_vertically(rows + columns, 0.0);
        let mut slopes = DVector::from_element(rows, 1.0);
        for i in 0..rows {
            let mut row = df.row(i).transpose();
            across(&mut row);
            if row.amax() > 0.0 {
                slopes[i] = row.amax();
            }
            matrix.row_mut(i).copy_from(&(row / slopes[i]).transpose());
            rates[i] /= slopes[i];
        }
        let damping = rates.norm() / (REACH * size);
        matrix.view_mut((rows, 0), (columns, columns)).fill_diagonal(damping);
        let mut step = DVector::zeros(columns);
        if damping > 0.0 {
            let factors = matrix.qr();
            factors.q_tr_mul(&mut rates);
            step = -factors.unpack_r().solve_upper_triangular(&rates.rows(0, columns))?;
            across(&mut step);
        }
        step.iter().all(|x| x.is_finite()).then_some(Correction { step, slopes })
    }

    fn left(&self, rates: &DVector<f64>) -> f64 {
        rates.component_div(&self.slopes).amax()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_leads_on_if_the_next_or_the_rates_become_smaller() {
        for (steps, rates, leads) in [
            ([1.93, 2.0], [2.0, 2.0], true),
            ([1.95, 2.0], [2.0, 2.0], false),
            ([2.0, 2.0], [1.79, 2.0], true),
            ([2.0, 2.0], [1.81, 2.0], false),
        ] {
            assert_eq!(leads_on(steps, rates), leads, "{steps:?} {rates:?}");
        }
    }

    /// Newton's steps to a zero of order m shrink by 1 − 1/m.
    #[test]
    fn zeros_of_order_two_to_a_thousand_are_met_at_once() {
        for order in [2.0, 3.0, 900.0] {
            let found = multiplicity(1.0 - 1.0 / order);
            assert!(found.is_some_and(|found| (found - order).abs() < 1e-9 * order), "{order}");
        }
        assert!(multiplicity(0.401).is_some() && multiplicity(0.399).is_none());
        assert!(multiplicity(0.9989).is_some() && multiplicity(0.9991).is_none());
    }

    #[test]
    fn a_zero_is_within_a_thousandth_and_certain_within_a_billionth() {
        assert!(is_far_from_zero(2.1e-3, 2.0) && !is_far_from_zero(1.9e-3, 2.0));
        assert!(is_at_zero(1.9e-9, 2.0) && !is_at_zero(2.1e-9, 2.0));
        assert!(is_noise(-127.0, 2.0) && !is_noise(-129.0, 2.0));
    }
}
