//! The frequencies of a signal: its lines found one after the other under a window, then polished together, and named as
//! combinations k·ω of few; and the mean rate of an angle.
//!
//! A line is looked for where the transform of what is left, under the square of Hann's window, is largest (J. Laskar,
//! Physica D 67 (1993) 257). All lines found so far are then fitted together under the window by Gauss's and Newton's method, so that they
//! do not disturb each other. The mean rate of an angle is a weighted Birkhoff average, which converges faster than any
//! power where the motion is quasi-periodic (S. Das, Y. Saiki, E. Sander and J. Yorke, Nonlinearity 30 (2017) 4111).
//!
//! In: numbers at equal intervals of time. Out: lines with what they are sure of. Never here: motions, pictures.

use std::f64::consts::{PI, TAU};

use nalgebra::{Complex, DMatrix, DVector};
use rustfft::FftPlanner;

use super::linear::least_squares;
use super::rotation::birkhoff_average;
use crate::mechanics::Equations;
use crate::model::Model;
use crate::num::math;
use crate::system::System;

/// A line below this part of the strongest is rounding.
const FAINTEST: f64 = 1e-12;

/// Lines closer than this many turns in the whole time are one that is not a line.
const APART: f64 = 1.5;

/// The steps of Gauss's and Newton's method after each line, and at last.
const STEPS: usize = 3;
const LAST_STEPS: usize = 8;

/// The greatest Σ|k| of a combination, and the greatest multiple of one frequency alone.
const ORDER: i32 = 9;
const MULTIPLE: i32 = 40;

/// A combination fits within this part of a turn in the whole time, and this many times what is not known.
const FITS: f64 = 1e-4;
const SIGMAS: f64 = 10.0;

/// A line of a spectrum: amplitude · cos(ω t + phase), t from the beginning.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectralLine {
    /// ω.
    pub frequency: f64,
    /// The standard deviation of ω, as if what is left of the signal were noise.
    pub error: f64,
    /// Its amplitude.
    pub amplitude: f64,
    /// Its phase.
    pub phase: f64,
    /// The integers k with ω = k·(the fundamental frequencies), if it is such a combination, …
    pub combination: Option<Vec<i32>>,
    /// … to which this multiple of the frequency of a drive is added.
    pub drive: i32,
}

impl SpectralLine {
    /// The combination in words: `ω₁ − 2ω₂`; Ω is the frequency of the drive.
    pub fn name(&self) -> Option<String> {
        self.combination.as_ref().map(|k| named(k, self.drive))
    }
}

fn named(k: &[i32], drive: i32) -> String {
    let index = |i: usize| (i + 1).to_string().chars().map(subscript).collect::<String>();
    let own = k.iter().enumerate().map(|(i, &times)| (times, format!("ω{}", index(i))));
    let mut terms: Vec<(i32, String)> = own.chain([(drive, "Ω".to_owned())]).collect();
    terms.retain(|(times, _)| *times != 0);
    terms.sort_by_key(|(times, _)| *times < 0);
    let mut text = String::new();
    for (times, frequency) in terms {
        let sign = match (text.is_empty(), times < 0) {
            (true, false) => "",
            (true, true) => "−",
            (false, false) => " + ",
            (false, true) => " − ",
        };
        let count = if times.abs() == 1 { String::new() } else { times.abs().to_string() };
        text.push_str(&format!("{sign}{count}{frequency}"));
    }
    text
}

fn subscript(digit: char) -> char {
    digit.to_digit(10).and_then(|d| char::from_u32(0x2080 + d)).unwrap_or(digit)
}

/// The lines of a signal.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// The mean.
    pub mean: f64,
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
}

/// A motion of which the lines leave more than this part is no sum of few lines, as a chaotic one is not.
const CONTINUOUS: f64 = 0.1;

impl Spectrum {
    /// The part of the signal that the lines leave.
    pub fn part_left(&self) -> f64 {
        if self.size > 0.0 { self.left / self.size } else { 0.0 }
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
/// `look` is given each line, and says whether to go on. `None` if there are too few numbers or one is not finite.
pub fn spectrum(
    signal: &[f64],
    spacing: f64,
    (most, fundamentals): (usize, usize),
    look: &mut dyn FnMut(usize) -> bool,
) -> Option<Spectrum> {
    driven_spectrum(signal, spacing, (most, fundamentals), None, look)
}

/// The same of a motion with a drive, of which the frequency is known: it belongs to the combinations.
pub fn driven_spectrum(
    signal: &[f64],
    spacing: f64,
    (most, fundamentals): (usize, usize),
    drive: Option<f64>,
    look: &mut dyn FnMut(usize) -> bool,
) -> Option<Spectrum> {
    if signal.len() < 16
        || spacing.is_nan()
        || spacing <= 0.0
        || signal.iter().any(|x| !x.is_finite())
    {
        return None;
    }
    let mut fit = Fit::new(signal, spacing);
    fit.polish(1);
    let mut curve = Vec::new();
    for count in 0..most {
        let left = fit.left();
        let transform = fit.transform(&left);
        if count == 0 {
            curve.clone_from(&transform);
        }
        let Some(at) = fit.strongest(&left, &transform) else { break };
        let strongest = fit.lines.iter().map(Wave::amplitude).fold(0.0, f64::max);
        let near = |line: &Wave| (line.frequency - at).abs() < APART * TAU / fit.length();
        let amplitude = fit.amplitude(&left, at);
        if amplitude <= FAINTEST * strongest.max(fit.size) || fit.lines.iter().any(near) {
            break;
        }
        let before = (fit.lines.clone(), fit.mean);
        fit.lines.push(Wave { frequency: at, cosine: 0.0, sine: 0.0 });
        fit.polish(STEPS);
        if fit.has_merged() {
            // what has no lines makes those that were found run into each other
            (fit.lines, fit.mean) = before;
            break;
        }
        if !look(count + 1) {
            break;
        }
    }
    let errors = fit.polish(LAST_STEPS);
    let (lines, fundamentals) = fit.named(&errors, fundamentals, drive);
    let root_mean_square = |numbers: &[f64]| {
        let squares: f64 = numbers.iter().map(|x| x * x).sum();
        (squares / numbers.len() as f64).sqrt()
    };
    let left = root_mean_square(&fit.left());
    let mean = signal.iter().sum::<f64>() / signal.len() as f64;
    let about: Vec<f64> = signal.iter().map(|x| x - mean).collect();
    let size = root_mean_square(&about);
    Some(Spectrum { mean: fit.mean, lines, fundamentals, curve, left, size })
}

/// An angle that goes round less its mean advance, so that what is left has lines.
pub fn straightened(values: &[f64], spacing: f64, rate: Option<MeanRate>) -> Vec<f64> {
    let turned = |rate: &MeanRate| rate.rate.abs() * spacing * values.len() as f64;
    let rate = rate.filter(|rate| turned(rate) > std::f64::consts::TAU);
    let rate = rate.map_or(0.0, |rate| rate.rate);
    values.iter().enumerate().map(|(k, x)| x - rate * spacing * k as f64).collect()
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

/// A line that is being fitted, in the time from the middle.
#[derive(Clone, Copy, Debug)]
struct Wave {
    frequency: f64,
    cosine: f64,
    sine: f64,
}

impl Wave {
    fn amplitude(&self) -> f64 {
        math::hypot(self.cosine, self.sine)
    }
}

/// A signal and the lines fitted to it.
struct Fit<'a> {
    signal: &'a [f64],
    spacing: f64,
    window: Vec<f64>,
    size: f64,
    mean: f64,
    lines: Vec<Wave>,
}

impl<'a> Fit<'a> {
    fn new(signal: &'a [f64], spacing: f64) -> Self {
        let count = signal.len() as f64;
        let hann = |k: usize| {
            let (_, cos) = math::sin_cos(TAU * (k as f64 + 0.5) / count);
            let half = (1.0 - cos) / 2.0;
            half * half
        };
        let window: Vec<f64> = (0..signal.len()).map(hann).collect();
        let size = signal.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
        Self { signal, spacing, window, size, mean: 0.0, lines: Vec::new() }
    }

    fn length(&self) -> f64 {
        self.spacing * self.signal.len() as f64
    }

    /// The time from the middle.
    fn time(&self, k: usize) -> f64 {
        (k as f64 - (self.signal.len() as f64 - 1.0) / 2.0) * self.spacing
    }

    /// The signal without the lines.
    fn left(&self) -> Vec<f64> {
        let one = |(k, x): (usize, &f64)| {
            let time = self.time(k);
            let lines: f64 = self
                .lines
                .iter()
                .map(|line| {
                    let (sin, cos) = math::sin_cos(line.frequency * time);
                    line.cosine * cos + line.sine * sin
                })
                .sum();
            x - self.mean - lines
        };
        self.signal.iter().enumerate().map(one).collect()
    }

    /// The amplitude of a signal at a frequency, under the window.
    fn amplitude(&self, left: &[f64], frequency: f64) -> f64 {
        let (sin, cos) = math::sin_cos(frequency * self.spacing);
        let (mut a, mut b, mut re, mut im, mut weights) = (1.0, 0.0, 0.0, 0.0, 0.0);
        for (x, weight) in left.iter().zip(&self.window) {
            re += weight * x * a;
            im += weight * x * b;
            weights += weight;
            (a, b) = (a * cos - b * sin, a * sin + b * cos);
        }
        2.0 * math::hypot(re, im) / weights
    }

    /// The amplitude at frequencies half a turn in the whole time from each other, up to what the spacing can tell apart.
    fn transform(&self, left: &[f64]) -> Vec<[f64; 2]> {
        let mut numbers: Vec<Complex<f64>> = left
            .iter()
            .zip(&self.window)
            .map(|(x, weight)| Complex::new(weight * x, 0.0))
            .collect();
        // zeros as many again halve the distance of the frequencies
        numbers.resize(2 * left.len(), Complex::new(0.0, 0.0));
        FftPlanner::new().plan_fft_forward(numbers.len()).process(&mut numbers);
        let (step, weights) = (PI / self.length(), self.window.iter().sum::<f64>());
        let at = |(k, z): (usize, &Complex<f64>)| {
            [step * k as f64, 2.0 * math::hypot(z.re, z.im) / weights]
        };
        numbers[..left.len()].iter().enumerate().map(at).collect()
    }

    /// The frequency at which the amplitude is largest, between those of the transform.
    fn strongest(&self, left: &[f64], transform: &[[f64; 2]]) -> Option<f64> {
        // next to zero there is the mean and its drift
        let inner = transform.iter().enumerate().skip(3);
        let (place, _) = inner.max_by(|a, b| a.1[1].total_cmp(&b.1[1]))?;
        let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
        let [mut from, mut to] = [place - 1, place + 1].map(|k| k as f64 * PI / self.length());
        let value = |x: f64| self.amplitude(left, x);
        let (mut a, mut b) = (to - golden * (to - from), from + golden * (to - from));
        let (mut high, mut low) = (value(a), value(b));
        for _ in 0..24 {
            if high > low {
                (to, b, low) = (b, a, high);
                a = to - golden * (to - from);
                high = value(a);
            } else {
                (from, a, high) = (a, b, low);
                b = from + golden * (to - from);
                low = value(b);
            }
        }
        Some(f64::midpoint(from, to))
    }

    /// Corrects the mean and all lines together, so often. Returns the standard deviation of each frequency.
    fn polish(&mut self, steps: usize) -> Vec<f64> {
        let size = 1 + 3 * self.lines.len();
        let scale = self.length();
        let mut errors = vec![f64::INFINITY; self.lines.len()];
        for _ in 0..steps {
            let left = self.left();
            let mut gram: DMatrix<f64> = DMatrix::zeros(size, size);
            let mut right: DVector<f64> = DVector::zeros(size);
            let (mut squares, mut weights) = (0.0, 0.0);
            let mut row = vec![1.0; size];
            for (k, (x, weight)) in left.iter().zip(&self.window).enumerate() {
                let time = self.time(k);
                for (line, entries) in self.lines.iter().zip(row[1..].chunks_exact_mut(3)) {
                    let (sin, cos) = math::sin_cos(line.frequency * time);
                    entries[0] = time / scale * (line.sine * cos - line.cosine * sin);
                    entries[1] = cos;
                    entries[2] = sin;
                }
                for i in 0..size {
                    let part = weight * row[i];
                    right[i] += part * x;
                    for j in 0..=i {
                        gram[(i, j)] += part * row[j];
                    }
                }
                squares += weight * x * x;
                weights += weight;
            }
            gram.fill_upper_triangle_with_lower_triangle();
            // columns of one size, so that faint lines count as strong ones do
            let units: Vec<f64> = (0..size)
                .map(|i| Some(1.0 / gram[(i, i)].sqrt()).filter(|x| x.is_finite()).unwrap_or(0.0))
                .collect();
            let unit = DMatrix::from_diagonal(&DVector::from_vec(units.clone()));
            let scaled = &unit * &gram * &unit;
            let Some(step) = least_squares(&scaled, &(&unit * &right), 0.0) else { break };
            self.mean += units[0] * step[0];
            for (k, line) in self.lines.iter_mut().enumerate() {
                let at = 1 + 3 * k;
                // a line that has no amplitude yet has no better frequency either
                if line.amplitude() > 0.0 {
                    line.frequency += units[at] * step[at] / scale;
                }
                line.cosine += units[at + 1] * step[at + 1];
                line.sine += units[at + 2] * step[at + 2];
            }
            let noise = (squares / weights).sqrt();
            for (k, error) in errors.iter_mut().enumerate() {
                let at = 1 + 3 * k;
                let rounding = f64::EPSILON * self.lines[k].frequency;
                // what the window lets through counts as so many numbers
                *error = (noise * units[at] * weights.sqrt() / (left.len() as f64).sqrt() / scale)
                    .max(rounding);
            }
        }
        errors
    }

    /// Whether two lines have become one, or one has gone to zero.
    fn has_merged(&self) -> bool {
        let turn = TAU / self.length();
        let lines = self.lines.iter().enumerate();
        lines.clone().any(|(i, line)| {
            let mut others = self.lines[..i].iter();
            line.frequency <= 0.0
                || others.any(|other| (other.frequency - line.frequency).abs() < turn)
        })
    }

    /// The lines with their names, and the fundamental frequencies.
    fn named(
        &self,
        errors: &[f64],
        most: usize,
        drive: Option<f64>,
    ) -> (Vec<SpectralLine>, Vec<f64>) {
        // the drive comes first, and is known
        let mut known: Vec<(f64, f64)> = drive.iter().map(|&frequency| (frequency, 0.0)).collect();
        let first = known.len();
        let most = most + first;
        let mut lines: Vec<SpectralLine> = Vec::new();
        let turn = TAU / self.length();
        let middle = -self.time(0);
        for (line, &error) in self.lines.iter().zip(errors) {
            let mut combination = combination(&known, (line.frequency, error), FITS * turn);
            if combination.is_none() && known.len() < most {
                known.push((line.frequency, error));
                let mut own = vec![0; known.len()];
                own[known.len() - 1] = 1;
                combination = Some(own);
            }
            // from the middle to the beginning
            let phase = math::atan2(-line.sine, line.cosine) - line.frequency * middle;
            lines.push(SpectralLine {
                frequency: line.frequency,
                error,
                amplitude: line.amplitude(),
                phase: phase - TAU * (phase / TAU).round(),
                drive: combination.as_ref().filter(|_| first > 0).map_or(0, |k| k[0]),
                combination: combination.map(|k| k[first..].to_vec()),
            });
        }
        let count = known.len() - first;
        lines
            .iter_mut()
            .filter_map(|line| line.combination.as_mut())
            .for_each(|k| k.resize(count, 0));
        (lines, known.into_iter().skip(first).map(|(frequency, _)| frequency).collect())
    }
}

/// The integers k of least Σ|k| with which a frequency is k·ω, if there are some.
fn combination(
    known: &[(f64, f64)],
    (frequency, error): (f64, f64),
    least: f64,
) -> Option<Vec<i32>> {
    fn search(
        known: &[(f64, f64)],
        (rest, doubt): (f64, f64),
        room: i32,
        k: &mut Vec<i32>,
    ) -> bool {
        let Some(((frequency, error), others)) = known.split_first() else {
            return room == 0 && rest.abs() <= doubt;
        };
        for size in 0..=room {
            for sign in if size == 0 { &[1][..] } else { &[1, -1][..] } {
                let times = sign * size;
                k.push(times);
                let next = rest - f64::from(times) * frequency;
                let doubt = doubt + SIGMAS * error * f64::from(size);
                if search(others, (next, doubt), room - size, k) {
                    return true;
                }
                k.pop();
            }
        }
        false
    }
    let most = if known.len() == 1 { MULTIPLE } else { ORDER };
    (1..=most).find_map(|order| {
        let mut k = Vec::new();
        search(known, (frequency, SIGMAS * error + least), order, &mut k).then_some(k)
    })
}
