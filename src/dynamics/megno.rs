//! MEGNO, the mean exponential growth of nearby orbits (P. M. Cincotta, C. Simó, Astron. Astrophys.
//! Suppl. 147 (2000) 205): about 2 for regular motion, λt/2 for chaotic.
//!
//! In: times, and the logarithm of a tangent vector's length there. Out: MEGNO, averaged over the time. Never here: a verdict.

use crate::num::math;

/// The mean exponential growth of nearby orbits.
pub(super) struct Megno {
    start: f64,
    time: f64,
    /// ln |δ| now, and what was taken off when it was made shorter.
    logarithm: f64,
    taken: f64,
    /// ∫ s d ln|δ|, and ∫ Y dt.
    moment: f64,
    sum: f64,
    last: f64,
    /// The mean at times that grow by a factor.
    course: Vec<(f64, f64)>,
}

/// The factor by which these times grow.
const APART: f64 = 1.05;

impl Megno {
    pub(super) fn new(start: f64) -> Megno {
        let (time, course) = (start, Vec::new());
        Megno { start, time, logarithm: 0.0, taken: 0.0, moment: 0.0, sum: 0.0, last: 0.0, course }
    }

    pub(super) fn add(&mut self, time: f64, logarithm: f64) {
        let logarithm = logarithm + self.taken;
        let middle = 0.5 * (time + self.time) - self.start;
        self.moment += middle * (logarithm - self.logarithm);
        let now = 2.0 * self.moment / (time - self.start);
        self.sum += 0.5 * (now + self.last) * (time - self.time);
        (self.time, self.logarithm, self.last) = (time, logarithm, now);
        let after = time - self.start;
        if self.course.last().is_none_or(|(last, _)| after >= APART * last) {
            self.course.push((after, self.mean()));
        }
    }

    pub(super) fn rescale(&mut self, length: f64) {
        self.taken += math::ln(length);
    }

    pub(super) fn mean(&self) -> f64 {
        self.sum / (self.time - self.start)
    }

    /// By how many times it has grown since half of the time; of chaotic motion it doubles.
    pub(super) fn growth(&self) -> f64 {
        let half = 0.5 * (self.time - self.start);
        let before = self.course.iter().rfind(|(after, _)| *after <= half);
        before.map_or(1.0, |(_, mean)| self.mean() / mean)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn megno_is_two_for_linear_growth_and_half_the_exponents_for_exponential() {
        let (mut linear, mut exponential) = (Megno::new(0.0), Megno::new(0.0));
        for i in 1..=200_000 {
            let time = f64::from(i) * 0.01;
            linear.add(time, math::ln(1.0 + time));
            exponential.add(time, 0.1 * time);
        }
        // 2 − (2/T) ∫ ln(1 + t)/t dt, and the integral is (ln T)²/2 + π²/6 up to 1/T
        let (end, log) = (2000.0, math::ln(2000.0));
        let wanted =
            2.0 - 2.0 / end * (log * log / 2.0 + math::powi(std::f64::consts::PI, 2) / 6.0);
        assert!((linear.mean() - wanted).abs() < 2e-5, "{} {wanted}", linear.mean());
        assert!((exponential.mean() - 0.05 * 2000.0).abs() < 0.1, "{}", exponential.mean());
        assert!((1.0..1.05).contains(&linear.growth()), "{}", linear.growth());
        // by up to 5 % more than from the middle
        assert!((2.0..2.11).contains(&exponential.growth()), "{}", exponential.growth());
    }
}
