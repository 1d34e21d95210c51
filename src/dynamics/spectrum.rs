//! The frequencies of a signal: its lines found one after the other under a window, then polished together, and named as
//! combinations k·ω of few; and the mean rate of an angle.
//!
//! A line is searched for where the transform of what is left, under the square of Hann's window, is largest (J. Laskar,
//! Physica D 67 (1993) 257). All lines found so far are then fitted together under the window by Gauss's and Newton's method, so that they
//! do not disturb each other. Where the strongest of what is left makes hardly a turn, the mean changes slowly, by a polynomial of
//! third to ninth degree that is fitted together with the lines. The mean rate of an angle is a weighted Birkhoff average, which converges faster than any
//! power where the motion is quasi-periodic (S. Das, Y. Saiki, E. Sander and J. Yorke, Nonlinearity 30 (2017) 4111).
//!
//! In: numbers at equal intervals of time. Out: lines with what they are sure of. Never here: motions, pictures.

use std::f64::consts::{PI, TAU};

use super::close_lines::CloseLines;
use super::spectral_fit::{SpectralFit, Wave};
use super::spectral_line::SpectralLine;
use super::unresolved_lines::UnresolvedLines;
use crate::mechanics::Equations;
use crate::model::Model;
use crate::num::birkhoff_average;
use crate::system::System;

/// A line below this part of the strongest is rounding.
const FAINTEST: f64 = 1e-12;

/// Lines closer than this many turns in the whole time are one that is not a line.
const APART: f64 = 1.5;

/// A line that was fitted for two is within so many turns in the whole time of what is left.
const STRAY: f64 = 3.0;

/// A line beside which no more than this part of it is left is one.
const SINGLE: f64 = 1e-3;

/// So many times as many lines as are wanted are tried: some are not resolved from others.
const TRIES: usize = 2;

/// Where what is left beside a line is evaluated, as parts of that.
const BESIDE: [f64; 6] = [-1.0, -0.67, -0.33, 0.33, 0.67, 1.0];

/// The steps of Gauss's and Newton's method after each line, and at last.
const STEPS: usize = 3;
const LAST_STEPS: usize = 8;

/// A slow change beside the lines is a polynomial of the first of these degrees. Where what was found without it is no sum of few
/// lines, the others are tried as well, and each takes the place of a lower one if it leaves much less.
const DEGREES: [usize; 4] = [3, 5, 7, 9];

/// Lines that make fewer turns in the whole time than this may be parts of a slow change, and are none where one is fitted.
const SLOW: f64 = 3.0;

/// A slow change is one that leaves no more than this part of what lines alone leave, and beside which lines are more than what they
/// leave of it: of a change that is no polynomial some is left.
const BETTER: f64 = 0.5;

/// The lines of a signal.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// The constant part of the signal.
    pub mean: f64,
    /// How the mean changes in time, beside the lines, at the times of the numbers; empty where it does not.
    pub trend: Vec<f64>,
    /// The lines in the order in which they were found, the strongest first.
    pub lines: Vec<SpectralLine>,
    /// The fundamental frequencies: those of the strongest lines that are no combination of stronger ones.
    pub fundamentals: Vec<f64>,
    /// ω and the amplitude of the signal there, under the window.
    pub curve: Vec<[f64; 2]>,
    /// The root mean square of what the lines leave, and of the signal about its mean.
    pub left: f64,
    /// See `left`.
    pub size: f64,
    /// The turns that the strongest line would make in the whole time, where these are less than one: nothing has come back
    /// yet, as where a motion escapes, and there are no lines.
    pub turns: Option<f64>,
    /// Where two lines lie so close together that the time does not tell them apart, and one is fitted for them.
    pub close: Option<CloseLines>,
}

/// A motion of which the lines leave more than this part is no sum of few lines, as a chaotic one is not.
const CONTINUOUS: f64 = 0.1;

impl Spectrum {
    /// The part of the signal that the lines leave.
    pub fn part_left(&self) -> f64 {
        if self.size > 0.0 { self.left / self.size } else { 0.0 }
    }

    /// By how much the mean changes from the first number to the last.
    pub fn change_of_mean(&self) -> Option<f64> {
        Some(self.trend.last()? - self.trend.first()?)
    }

    /// A signal of these lines without the slow change of its mean.
    pub fn without_trend(&self, signal: &[f64]) -> Vec<f64> {
        let slow = self.trend.iter().copied().chain(std::iter::repeat(0.0));
        signal.iter().zip(slow).map(|(x, slow)| x - slow).collect()
    }

    /// Whether the signal is more than a sum of the lines.
    pub fn is_continuous(&self) -> bool {
        self.part_left() > CONTINUOUS
    }
}

/// The mean rate of an angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanRate {
    /// The rate.
    pub rate: f64,
    /// How far it is from that of the first half of the time.
    pub error: f64,
}

/// The spectrum of a signal at intervals of `spacing`: at most `most` lines, named by at most `fundamentals` frequencies.
/// `report` is given each line, and returns whether to continue. `None` if there are too few numbers or one is not finite.
pub fn spectrum(
    signal: &[f64],
    spacing: f64,
    (most, fundamentals): (usize, usize),
    report: &mut dyn FnMut(usize) -> bool,
) -> Option<Spectrum> {
    driven_spectrum(signal, spacing, (most, fundamentals), None, report)
}

/// The same of a motion with a drive, of which the frequency is known: it belongs to the combinations.
pub(super) fn driven_spectrum(
    signal: &[f64],
    spacing: f64,
    (most, fundamentals): (usize, usize),
    drive: Option<f64>,
    report: &mut dyn FnMut(usize) -> bool,
) -> Option<Spectrum> {
    if signal.len() < 16
        || spacing.is_nan()
        || spacing <= 0.0
        || signal.iter().any(|x| !x.is_finite())
    {
        return None;
    }
    let wanted = (most, fundamentals, drive);
    let plain = fitted(signal, spacing, wanted, (0, 1.0), report);
    if plain.fewest >= SLOW {
        return Some(plain.spectrum);
    }
    // what changes slowly would hide the lines beside it
    let hidden = plain.spectrum.turns.is_some() || plain.spectrum.is_continuous();
    let tried = if hidden { DEGREES.len() } else { 1 };
    let mut best = plain.spectrum;
    for degree in &DEGREES[..tried] {
        let detrended = fitted(signal, spacing, wanted, (*degree, SLOW), report).spectrum;
        let is_better = !detrended.lines.is_empty()
            && detrended.part_left() < BETTER
            && detrended.left < BETTER * best.left;
        if is_better {
            best = detrended;
        }
    }
    Some(best)
}

/// Lines fitted to a signal.
struct Fitted {
    spectrum: Spectrum,
    /// The turns of the slowest line that was met in the whole time.
    fewest: f64,
}

/// The lines of a signal with a trend of at most this degree: those that make at least so many turns in the whole time.
fn fitted(
    signal: &[f64],
    spacing: f64,
    (most, fundamentals, drive): (usize, usize, Option<f64>),
    (degree, least): (usize, f64),
    report: &mut dyn FnMut(usize) -> bool,
) -> Fitted {
    let mut fit = SpectralFit::new(signal, spacing, degree);
    fit.polish(1);
    let (mut curve, mut turns, mut slowest) = (Vec::new(), None, f64::INFINITY);
    let mut beside = UnresolvedLines::default();
    for _ in 0..TRIES * most {
        let left = fit.left();
        let transform = fit.transform(&left);
        if curve.is_empty() {
            curve.clone_from(&transform);
        }
        let free = beside.masked(&transform, fit.length());
        if free.iter().all(|point| point[1] == 0.0) {
            break;
        }
        let Some(at) = fit.strongest(&left, &free) else { break };
        let strongest = fit.lines.iter().map(Wave::amplitude).fold(0.0, f64::max);
        let amplitude = fit.amplitude(&left, at);
        if is_rounding(amplitude, strongest.max(fit.size)) {
            break;
        }
        if fit.lines.iter().any(|line| (line.frequency - at).abs() < APART * TAU / fit.length()) {
            beside.add(at, amplitude);
            continue;
        }
        // where there are no lines the first one goes anywhere
        slowest = slowest.min(at * fit.length() / TAU);
        let before = (fit.lines.clone(), fit.mean, fit.trend.clone());
        fit.lines.push(Wave { frequency: at, cosine: 0.0, sine: 0.0 });
        fit.polish(STEPS);
        let turned = |line: &Wave| line.frequency.abs() * fit.length() / TAU;
        let fewest = fit.lines.iter().map(turned).fold(f64::INFINITY, f64::min);
        slowest = slowest.min(fewest);
        if fit.has_merged() {
            // those that were found run into each other
            (fit.lines, fit.mean, fit.trend) = before;
            if fit.lines.is_empty() {
                // a line alone runs away where there is none
                break;
            }
            beside.add(at, amplitude);
            continue;
        }
        if fewest < least {
            // a line that has made no turn is none
            turns = before.0.is_empty().then_some(fewest);
            (fit.lines, fit.mean, fit.trend) = before;
            break;
        }
        if !report(fit.lines.len()) || fit.lines.len() == most {
            break;
        }
    }
    let errors = polished(&mut fit, least);
    let (mut lines, fundamentals) = fit.named(&errors, fundamentals, drive);
    let root_mean_square = |numbers: &[f64]| {
        let squares: f64 = numbers.iter().map(|x| x * x).sum();
        (squares / numbers.len() as f64).sqrt()
    };
    let left = fit.left();
    for line in &mut lines {
        line.error = line.error.max(unresolved(&fit, &left, line));
    }
    let close = close_lines(&fit, &left, &beside);
    let left = root_mean_square(&left);
    let mean = signal.iter().sum::<f64>() / signal.len() as f64;
    let trend = if degree > 0 { fit.slow() } else { Vec::new() };
    let slow = |k: usize| trend.get(k).copied().unwrap_or(0.0);
    let about: Vec<f64> = signal.iter().enumerate().map(|(k, x)| x - mean - slow(k)).collect();
    let size = root_mean_square(&about);
    let mean = fit.mean;
    let spectrum = Spectrum { mean, trend, lines, fundamentals, curve, left, size, turns, close };
    Fitted { spectrum, fewest: slowest }
}

/// The errors of the lines after the last corrections, without those that these carry out of the range of frequencies: where a wave
/// decays, as under friction, there is no line for some of what is left.
fn polished(fit: &mut SpectralFit<'_>, least: f64) -> Vec<f64> {
    let turn = TAU / fit.length();
    let fastest = PI / fit.spacing();
    loop {
        let before = (fit.lines.clone(), fit.mean, fit.trend.clone());
        let errors = fit.polish(LAST_STEPS);
        let stays = |line: &Wave| (least * turn..=fastest).contains(&line.frequency);
        let stay: Vec<bool> = fit.lines.iter().map(stays).collect();
        if stay.iter().all(|&stays| stays) {
            return errors;
        }
        (fit.lines, fit.mean, fit.trend) = before;
        let mut stay = stay.into_iter();
        fit.lines.retain(|_| stay.next().unwrap_or(false));
    }
}

/// Whether a line is rounding beside the strongest, or the size of the signal.
fn is_rounding(amplitude: f64, strongest: f64) -> bool {
    amplitude <= FAINTEST * strongest
}

/// How far a frequency may be off because of what is left so close to it that the time does not tell them apart: a line beside
/// it pulls it by no more than their distance, in the ratio of their amplitudes.
fn unresolved(fit: &SpectralFit<'_>, left: &[f64], line: &SpectralLine) -> f64 {
    let turn = TAU / fit.length();
    let beside = BESIDE.map(|part| fit.amplitude(left, line.frequency + part * APART * turn));
    let amplitude = beside.into_iter().fold(0.0, f64::max);
    if line.amplitude > 0.0 { APART * turn * amplitude / line.amplitude } else { 0.0 }
}

/// Two lines where most is left beside one that was fitted for them.
fn close_lines(
    fit: &SpectralFit<'_>,
    left: &[f64],
    unresolved: &UnresolvedLines,
) -> Option<CloseLines> {
    let at = unresolved.strongest()?;
    let turn = TAU / fit.length();
    let distance = |line: &&Wave| (line.frequency - at).abs();
    let nearest = fit.lines.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    // a line between two that are nearly equal goes astray in the last corrections
    if distance(&nearest) > STRAY * turn || fit.amplitude(left, at) <= SINGLE * nearest.amplitude()
    {
        return None;
    }
    let around = fit.left_around(nearest.frequency, APART * turn);
    CloseLines::of(&around, fit.spacing(), (at, nearest.frequency))
}

/// An angle that goes round less its mean advance, so that what is left has lines.
pub(super) fn straightened(values: &[f64], spacing: f64, rate: Option<MeanRate>) -> Vec<f64> {
    let rate = advance(values.len(), spacing, rate);
    values.iter().enumerate().map(|(k, x)| x - rate * spacing * k as f64).collect()
}

/// The rate of the mean advance that is subtracted from so many values of an angle: none if it is less than a turn in all.
pub(super) fn advance(count: usize, spacing: f64, rate: Option<MeanRate>) -> f64 {
    let turned = |rate: &MeanRate| rate.rate.abs() * spacing * count as f64;
    rate.filter(|rate| turned(rate) > TAU).map_or(0.0, |rate| rate.rate)
}

/// The most frequencies of a quasi-periodic motion that are no combinations of each other: one for each degree of freedom, and
/// one of a drive.
pub fn independent_frequencies(model: &Model, equations: &Equations, system: &System) -> usize {
    let timed = |e| equations.pool.depends(e, model.symbols.time);
    let is_driven =
        timed(equations.energy) || timed(equations.energy_rate) || !model.impulses.is_empty();
    system.degrees().max(1) + usize::from(is_driven)
}

/// The mean rate of an angle that is given without jumps, at intervals of `spacing`; `None` if there are too few.
pub fn mean_rate(angle: &[f64], spacing: f64) -> Option<MeanRate> {
    let average = |angle: &[f64]| {
        angle.len().checked_sub(1).filter(|count| *count >= 8)?;
        let steps: Vec<f64> = angle.windows(2).map(|pair| pair[1] - pair[0]).collect();
        Some(birkhoff_average(&steps) / spacing)
    };
    let (rate, before) = (average(angle)?, average(&angle[..angle.len() / 2])?);
    rate.is_finite().then_some(MeanRate { rate, error: (rate - before).abs() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_signal_of_which_lines_leave_a_tenth_is_continuous() {
        let of = |left: f64| {
            let (trend, lines, fundamentals, curve) = Default::default();
            let (mean, size, turns, close) = (0.0, 2.0, None, None);
            Spectrum { mean, trend, lines, fundamentals, curve, left, size, turns, close }
        };
        assert!(of(0.201).is_continuous() && !of(0.199).is_continuous());
    }

    #[test]
    fn a_line_is_rounding_below_1e_12_of_the_strongest() {
        assert!(is_rounding(1.9e-12, 2.0) && !is_rounding(2.1e-12, 2.0));
    }
}
