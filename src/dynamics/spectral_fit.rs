//! Waves fitted to a signal under a window, all of them together.
//!
//! The window is the square of Hann's. The strongest frequency of what is left is found in the transform and between its
//! points; all frequencies and amplitudes are then corrected together by Gauss's and Newton's method.
//!
//! In: numbers at equal intervals of time. Out: waves with the errors of their frequencies. Never here: when to stop.

use std::convert::Infallible;
use std::f64::consts::{PI, TAU};

use nalgebra::{Complex, DMatrix, DVector};
use rustfft::FftPlanner;

use super::linear::least_squares;
use super::module_basis::halved;
use super::spectral_line::{SpectralLine, combination, is_distinguishable};
use crate::num::{golden_section, math};

/// Golden sections for the frequency of the largest amplitude between two points of the transform.
const SECTIONS: u32 = 24;

/// A combination fits within this part of a turn in the whole time.
pub(super) const FITS: f64 = 1e-4;

/// A line that is being fitted, in the time from the middle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wave {
    pub(super) frequency: f64,
    pub(super) cosine: f64,
    pub(super) sine: f64,
}

impl Wave {
    pub(super) fn amplitude(&self) -> f64 {
        math::hypot(self.cosine, self.sine)
    }
}

/// A signal and the lines fitted to it.
pub(super) struct SpectralFit<'a> {
    signal: &'a [f64],
    spacing: f64,
    window: Vec<f64>,
    pub(super) size: f64,
    pub(super) mean: f64,
    /// What changes slowly beside the lines: the coefficients of Legendre's polynomials from the first degree on, of the time
    /// from −1 to 1.
    pub(super) trend: Vec<f64>,
    pub(super) lines: Vec<Wave>,
}

impl<'a> SpectralFit<'a> {
    /// Of a signal with a trend of at most this degree.
    pub(super) fn new(signal: &'a [f64], spacing: f64, degree: usize) -> Self {
        let count = signal.len() as f64;
        let hann = |k: usize| {
            let (_, cos) = math::sin_cos(TAU * (k as f64 + 0.5) / count);
            let half = (1.0 - cos) / 2.0;
            half * half
        };
        let window: Vec<f64> = (0..signal.len()).map(hann).collect();
        let size = signal.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
        let trend = vec![0.0; degree];
        Self { signal, spacing, window, size, mean: 0.0, trend, lines: Vec::new() }
    }

    pub(super) fn spacing(&self) -> f64 {
        self.spacing
    }

    pub(super) fn length(&self) -> f64 {
        self.spacing * self.signal.len() as f64
    }

    fn time(&self, k: usize) -> f64 {
        (k as f64 - (self.signal.len() as f64 - 1.0) / 2.0) * self.spacing
    }

    /// Legendre's polynomials of this time from the middle, from the first degree on.
    fn legendre(&self, time: f64) -> impl Iterator<Item = f64> {
        let x = 2.0 * time / self.length();
        let mut pair = [1.0, x];
        (1..=self.trend.len()).map(move |n| {
            let (n, [before, here]) = (n as f64, pair);
            pair = [here, ((2.0 * n + 1.0) * x * here - n * before) / (n + 1.0)];
            here
        })
    }

    /// The trend about the mean.
    pub(super) fn slow(&self) -> Vec<f64> {
        let at = |k| self.legendre(self.time(k)).zip(&self.trend).map(|(p, c)| p * c).sum();
        (0..self.signal.len()).map(at).collect()
    }

    /// The signal without the lines.
    pub(super) fn left(&self) -> Vec<f64> {
        self.left_of(&|_| true)
    }

    /// The signal without the lines that are farther than this from a frequency.
    pub(super) fn left_around(&self, frequency: f64, reach: f64) -> Vec<f64> {
        self.left_of(&|line| (line.frequency - frequency).abs() > reach)
    }

    fn left_of(&self, taken: &dyn Fn(&Wave) -> bool) -> Vec<f64> {
        let one = |(k, x): (usize, &f64)| {
            let time = self.time(k);
            let lines: f64 = self
                .lines
                .iter()
                .filter(|line| taken(line))
                .map(|line| {
                    let (sin, cos) = math::sin_cos(line.frequency * time);
                    line.cosine * cos + line.sine * sin
                })
                .sum();
            x - self.mean - lines
        };
        let mut left: Vec<f64> = self.signal.iter().enumerate().map(one).collect();
        if !self.trend.is_empty() {
            left.iter_mut().zip(self.slow()).for_each(|(x, slow)| *x -= slow);
        }
        left
    }

    /// The amplitude of a signal at a frequency, under the window.
    pub(super) fn amplitude(&self, left: &[f64], frequency: f64) -> f64 {
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
    pub(super) fn transform(&self, left: &[f64]) -> Vec<[f64; 2]> {
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
    pub(super) fn strongest(&self, left: &[f64], transform: &[[f64; 2]]) -> Option<f64> {
        // next to zero there is the mean and its drift
        let inner = transform.iter().enumerate().skip(3);
        let (place, _) = inner.max_by(|a, b| a.1[1].total_cmp(&b.1[1]))?;
        let ends = [place - 1, place + 1].map(|k| k as f64 * PI / self.length());
        let value = |x| Ok::<_, Infallible>(-self.amplitude(left, x));
        let Ok([from, to]) = golden_section(ends, SECTIONS, value);
        Some(f64::midpoint(from, to))
    }

    /// Corrects the mean, the trend and all lines together, so often. Returns the standard deviation of each frequency.
    pub(super) fn polish(&mut self, steps: usize) -> Vec<f64> {
        // the columns of the mean and of the trend come first
        let first = 1 + self.trend.len();
        let size = first + 3 * self.lines.len();
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
                for (entry, p) in row[1..first].iter_mut().zip(self.legendre(time)) {
                    *entry = p;
                }
                for (line, entries) in self.lines.iter().zip(row[first..].chunks_exact_mut(3)) {
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
            for (k, slow) in self.trend.iter_mut().enumerate() {
                *slow += units[1 + k] * step[1 + k];
            }
            for (k, line) in self.lines.iter_mut().enumerate() {
                let at = first + 3 * k;
                // a line that has no amplitude yet has no better frequency either
                if line.amplitude() > 0.0 {
                    line.frequency += units[at] * step[at] / scale;
                }
                line.cosine += units[at + 1] * step[at + 1];
                line.sine += units[at + 2] * step[at + 2];
            }
            let noise = (squares / weights).sqrt();
            for (k, error) in errors.iter_mut().enumerate() {
                let at = first + 3 * k;
                let rounding = f64::EPSILON * self.lines[k].frequency;
                // what the window lets through counts as so many numbers
                *error = (noise * units[at] * weights.sqrt() / (left.len() as f64).sqrt() / scale)
                    .max(rounding);
            }
        }
        errors
    }

    /// Whether two lines have become one, or one has gone to zero.
    pub(super) fn has_merged(&self) -> bool {
        let turn = TAU / self.length();
        let lines = self.lines.iter().enumerate();
        lines.clone().any(|(i, line)| {
            let mut others = self.lines[..i].iter();
            line.frequency <= 0.0
                || others.any(|other| (other.frequency - line.frequency).abs() < turn)
        })
    }

    /// The lines with their names, and the fundamental frequencies.
    pub(super) fn named(
        &self,
        errors: &[f64],
        most: usize,
        drive: Option<f64>,
    ) -> (Vec<SpectralLine>, Vec<f64>) {
        // the drive comes first, and is known
        let mut known: Vec<(f64, f64)> = drive.iter().map(|&frequency| (frequency, 0.0)).collect();
        let first = known.len();
        let most = most + first;
        let (turn, middle) = (TAU / self.length(), -self.time(0));
        let frequencies = self.lines.iter().map(|line| line.frequency);
        let frequencies: Vec<(f64, f64)> = frequencies.zip(errors.iter().copied()).collect();
        let mut names = Vec::new();
        for &line in &frequencies {
            let mut name = combination(&known, line, FITS * turn);
            if name.is_none() && known.len() < most && is_distinguishable(&known, line.1) {
                known.push(line);
                let mut own = vec![0; known.len()];
                own[known.len() - 1] = 1;
                name = Some(own);
            }
            names.push(name);
        }
        halved(&mut known, first, &frequencies, &mut names, (FITS * turn, turn));
        let lines = self.lines.iter().zip(errors).zip(names).map(|((line, &error), mut name)| {
            if let Some(name) = &mut name {
                name.resize(known.len(), 0);
            }
            // from the middle to the beginning
            let phase = math::atan2(-line.sine, line.cosine) - line.frequency * middle;
            SpectralLine {
                frequency: line.frequency,
                error,
                amplitude: line.amplitude(),
                phase: phase - TAU * (phase / TAU).round(),
                drive: name.as_ref().filter(|_| first > 0).map_or(0, |k| k[0]),
                combination: name.map(|k| k[first..].to_vec()),
            }
        });
        let lines = lines.collect();
        (lines, known.into_iter().skip(first).map(|(frequency, _)| frequency).collect())
    }
}
