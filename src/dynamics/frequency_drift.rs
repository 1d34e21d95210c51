//! The drift of a frequency, a measure of chaos.
//!
//! On a torus the strongest line of a motion has the same frequency in the first half of the time as in the second, to the
//! digits of the analysis; in chaos the motion diffuses among tori, and its frequency with it (J. Laskar, Physica D 67 (1993)
//! 257).
//!
//! In: numbers at equal intervals of time, their lines. Out: that line in both halves.
//! Never here: motions.

use std::f64::consts::TAU;

use super::spectral_line::SpectralLine;
use super::spectrum::spectrum;

/// The lines of a half that are searched for, so that they do not disturb the strongest.
const LINES: usize = 6;

/// A line of a half may be the one that was the strongest if it is at least this part of the half's own strongest.
const STRONG: f64 = 0.1;

/// Of these lines the strongest within this many turns in the time of a half comes first.
const WINDOW: f64 = 4.0;

/// A line does not count if it is within this many turns another line of the whole time, with the same amplitude up
/// to a factor.
const SAME: f64 = 0.25;
const LASTS: f64 = 0.7;

/// Another line of at least this part of its amplitude may be the same one.
const ALIKE: f64 = 0.5;

/// The frequency of a line in the two halves of the time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrequencyDrift {
    /// In the first half.
    pub first: f64,
    /// The same in the second half of the time.
    pub second: f64,
    /// What is not known of their difference, as if what the lines of a half leave were noise: much where lines are
    /// closer than a half can tell apart, where several lines may be the same one, and in chaos.
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

/// The frequency of a signal's strongest line in the halves of the time; `None` if a half has no lines, or there are none
/// of the whole time. A line may be followed as far as it stays the strongest that is not another one of the whole time.
pub fn frequency_drift(
    signal: &[f64],
    spacing: f64,
    lines: &[SpectralLine],
) -> Option<FrequencyDrift> {
    let half = signal.len() / 2;
    let (first, one) = followed(&signal[..half], spacing, lines)?;
    let (second, other) = followed(&signal[half..], spacing, lines)?;
    Some(FrequencyDrift { first, second, error: one + other })
}

/// The frequency of the first of the lines in a half, and its error.
fn followed(half: &[f64], spacing: f64, lines: &[SpectralLine]) -> Option<(f64, f64)> {
    let (first, others) = lines.split_first()?;
    let found = spectrum(half, spacing, (LINES, 0), &mut |_| true)?;
    let turn = TAU / (spacing * half.len() as f64);
    let largest = found.lines.iter().map(|line| line.amplitude).fold(0.0, f64::max);
    let away = |line: &SpectralLine| (line.frequency - first.frequency).abs();
    let is_other = |line: &SpectralLine| {
        others.iter().any(|other| {
            let apart = (other.frequency - line.frequency).abs();
            let ratio = other.amplitude / line.amplitude;
            let lasts = (LASTS..1.0 / LASTS).contains(&ratio);
            apart < SAME * turn && apart < away(line) && lasts
        })
    };
    let strong = || found.lines.iter().filter(|line| line.amplitude >= STRONG * largest);
    let near: Vec<&SpectralLine> =
        strong().filter(|line| away(line) < WINDOW * turn && !is_other(line)).collect();
    let strongest = near.iter().copied().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    let nearest = || strong().min_by(|a, b| away(a).total_cmp(&away(b)));
    let line = strongest.or_else(nearest)?;
    // which of several lines it is may not be known
    let rivals = near.iter().filter(|rival| rival.amplitude >= ALIKE * line.amplitude);
    let apart = rivals.map(|rival| (rival.frequency - line.frequency).abs()).fold(0.0, f64::max);
    Some((line.frequency, line.error + apart))
}
