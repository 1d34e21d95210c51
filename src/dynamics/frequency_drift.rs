//! The drift of a frequency, a measure of chaos.
//!
//! On a torus the strongest line of a motion has the same frequency in the first half of the time as in the second, to the
//! digits of the analysis; in chaos the motion diffuses among tori, and its frequency with it (J. Laskar, Physica D 67 (1993)
//! 257).
//!
//! In: numbers at equal intervals of time, the frequency of their strongest line. Out: that line in both halves.
//! Never here: motions.

use super::spectrum::spectrum;

/// The lines of a half that are searched for, so that they do not disturb the strongest.
const LINES: usize = 6;

/// A line of a half is the one that was the strongest if it is at least this part of the half's own strongest.
const STRONG: f64 = 0.1;

/// The frequency of a line in the two halves of the time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrequencyDrift {
    /// In the first half.
    pub first: f64,
    /// In the second.
    pub second: f64,
    /// What is not known of their difference, as if what the lines of a half leave were noise: much where lines are
    /// closer than a half can tell apart, and in chaos.
    pub error: f64,
}

impl FrequencyDrift {
    /// The difference as a part of the frequency.
    pub fn relative(&self) -> f64 {
        2.0 * (self.second - self.first).abs() / (self.first + self.second)
    }

    /// The error of that part.
    pub fn relative_error(&self) -> f64 {
        2.0 * self.error / (self.first + self.second)
    }
}

/// The frequency of a signal's strongest line in the halves of the time; `None` if a half has no lines.
pub fn frequency_drift(signal: &[f64], spacing: f64, strongest: f64) -> Option<FrequencyDrift> {
    let half = signal.len() / 2;
    let nearest = |signal: &[f64]| {
        let found = spectrum(signal, spacing, (LINES, 0), &mut |_| true)?;
        let largest = found.lines.iter().map(|line| line.amplitude).fold(0.0, f64::max);
        let strong = found.lines.iter().filter(|line| line.amplitude >= STRONG * largest);
        let away = |frequency: f64| (frequency - strongest).abs();
        let known = strong.map(|line| (line.frequency, line.error));
        known.min_by(|a, b| away(a.0).total_cmp(&away(b.0)))
    };
    let ((first, one), (second, other)) = (nearest(&signal[..half])?, nearest(&signal[half..])?);
    Some(FrequencyDrift { first, second, error: one + other })
}
