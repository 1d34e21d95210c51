//! Two lines that lie so close together that the time does not tell them apart: how close.
//!
//! Turned back by the frequency between them, their sum is a slow envelope a·αᵏ + b·βᵏ at equal intervals, so that z₂ = (α + β) z₁ − αβ z₀
//! and likewise z₃: R. de Prony's method of 1795, with four means of the signal as its numbers.
//!
//! In: a signal in which nothing else is left. Out: the distance of two frequencies. Never here: which lines there are.

use std::f64::consts::TAU;

use nalgebra::Complex;

use crate::num::math;

/// Each mean is taken over this part of the time.
const PART: f64 = 0.5;

/// Each mean begins this part of the time later than the one before.
const LATER: f64 = 1.0 / 6.0;

/// α and β of lines lie on the unit circle to this.
const LINES: f64 = 0.02;

/// Lines that make so many turns about each other in the whole time are told apart.
const APART: f64 = 2.0;

/// Two lines for which one was fitted.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct CloseLines {
    /// The frequency of what was fitted for them.
    pub frequency: f64,
    /// How far their frequencies lie apart.
    pub apart: f64,
}

impl CloseLines {
    /// For how long a motion would have to be followed to part them.
    pub fn time_to_part(&self) -> f64 {
        APART * TAU / self.apart
    }

    /// Of a signal at intervals of `spacing` that has nothing else around the first of these frequencies, for which one line was fitted
    /// at the other; `None` if it is not two lines.
    pub(super) fn of(
        signal: &[f64],
        spacing: f64,
        (at, frequency): (f64, f64),
    ) -> Option<CloseLines> {
        Some(CloseLines { frequency, apart: apart(signal, spacing, at)? })
    }
}

fn apart(signal: &[f64], spacing: f64, frequency: f64) -> Option<f64> {
    let count = signal.len() as f64;
    let length = (PART * count) as usize;
    let later = (LATER * count) as usize;
    let interval = later as f64 * spacing;
    let [z0, z1, z2, z3] = [0, 1, 2, 3].map(|k| {
        let first = k * later;
        let mut mean = Complex::new(0.0, 0.0);
        for (k, x) in signal[first..first + length].iter().enumerate() {
            let (_, cos) = math::sin_cos(TAU * (k as f64 + 0.5) / length as f64);
            let half = (1.0 - cos) / 2.0;
            let (sin, cos) = math::sin_cos(frequency * spacing * (first + k) as f64);
            mean += Complex::new(cos, -sin) * (half * half * x);
        }
        mean
    });
    let determinant = z0 * z2 - z1 * z1;
    let sum = (z0 * z3 - z1 * z2) / determinant;
    let product = (z1 * z3 - z2 * z2) / determinant;
    let root = (sum * sum - product * 4.0).sqrt();
    let [alpha, beta] = [(sum + root) * 0.5, (sum - root) * 0.5];
    let is_line = |z: Complex<f64>| (math::hypot(z.re, z.im) - 1.0).abs() < LINES;
    if !(is_line(alpha) && is_line(beta)) {
        return None;
    }
    let between = alpha * beta.conj();
    // what grows like the time has both in one place
    let turned = math::atan2(between.im, between.re).abs();
    (turned > LINES).then_some(turned / interval)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is found of cos t and another line so many turns in the whole time beside it, of this amplitude.
    fn found(turns: f64, amplitude: f64) -> Option<f64> {
        let beside = 1.0 + turns * TAU / 1000.0;
        let at = |t: f64| math::sin_cos(t).1 + amplitude * math::sin_cos(beside * t + 1.0).1;
        let signal: Vec<f64> = (0..4000).map(|k| at(0.25 * f64::from(k))).collect();
        let found = CloseLines::of(&signal, 0.25, (1.0 + 0.3 * turns * TAU / 1000.0, 1.0))?;
        Some(found.apart * 1000.0 / TAU)
    }

    #[test]
    fn the_distance_of_two_lines_is_known_long_before_they_are_distinguished() {
        for amplitude in [1.0, 0.9, 0.1] {
            for turns in [0.1, 0.5, 1.0, 1.4] {
                let apart = found(turns, amplitude).expect("two lines");
                assert!((apart / turns - 1.0).abs() < 1e-3, "{amplitude}, {turns}: {apart}");
            }
        }
    }

    /// t sin t, as an oscillator has at resonance, is no sum of two lines.
    #[test]
    fn what_grows_like_the_time_is_not_two_lines() {
        let at = |t: f64| (1.0 + 0.05 * t) * math::sin_cos(t).0;
        let signal: Vec<f64> = (0..4000).map(|k| at(0.25 * f64::from(k))).collect();
        assert_eq!(CloseLines::of(&signal, 0.25, (1.0, 1.0)), None);
    }

    #[test]
    fn what_grows_is_not_two_lines() {
        let at = |t: f64| (1.0 + 2.0 * math::exp(t / 300.0)) * math::sin_cos(t).1;
        let signal: Vec<f64> = (0..4000).map(|k| at(0.25 * f64::from(k))).collect();
        assert_eq!(CloseLines::of(&signal, 0.25, (1.0, 1.0)), None);
    }
}
