//! The spectrum of a quantity of a motion, taken as often as the quantity needs.
//!
//! At equal intervals a line of ω looks like one of 2π k/h ± ω. Between the values, at the golden section of each interval, no two
//! of these agree: there the quantity is held against the lines that were found, and where they do not give it more values
//! are taken.
//!
//! In: a motion that can be sampled at any times. Out: lines, and what they leave at and between the values. Never here: how the
//! motion is computed, names.

use super::frequency_drift::{FrequencyDrift, frequency_drift};
use super::spectrum::{MeanRate, Spectrum, advance, driven_spectrum, mean_rate, straightened};
use crate::num::math;

/// Where between two values the quantity is looked at, as a part of the interval.
const BETWEEN: f64 = 0.618_033_988_749_894_9;

/// Lines are those of the quantity if they leave, between the values, no more than this many times what they leave at them, …
const MORE: f64 = 3.0;

/// … or than this part of the quantity's size, …
const NOTICED: f64 = 1e-7;

/// … or than this part of its largest value, which may be rounding.
const ROUNDING: f64 = 1e-12;

/// Lines that leave more than this part of the quantity between the values are not there.
const FALSE: f64 = 0.5;

/// A line that leaves more than this part of itself between the values is the image of a faster one.
const IMAGE: f64 = 0.3;

/// What is wanted of a quantity.
#[derive(Clone, Copy, Debug)]
pub struct SpectrumRequest {
    /// From when to when it is taken.
    pub span: [f64; 2],
    /// How many values are taken first, and at most.
    pub counts: [usize; 2],
    /// Whether it is an angle, which may go round and round.
    pub is_angle: bool,
    /// How many lines are searched for, and by how many frequencies they are named.
    pub lines: (usize, usize),
    /// The frequency of the drive.
    pub drive: Option<f64>,
}

/// The spectrum of a quantity.
#[derive(Clone, Debug)]
pub struct SampledSpectrum {
    /// How many values were taken.
    pub count: usize,
    /// The lines.
    pub spectrum: Spectrum,
    /// The mean rate of an angle.
    pub rate: Option<MeanRate>,
    /// The strongest line in both halves of the time.
    pub drift: Option<FrequencyDrift>,
    /// The root mean square of what the lines leave between the values.
    pub between: f64,
    /// Whether lines were left out that are images of faster ones, as a motion that jumps has them without end.
    pub has_images: bool,
    /// What may be rounding.
    rounding: f64,
}

/// Why there is no spectrum.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum NoSpectrum {
    /// The motion ends before this time.
    Ends(f64),
    /// The quantity is not finite.
    NotFinite,
}

impl SampledSpectrum {
    /// Whether the lines give the quantity between the values too.
    pub fn is_resolved(&self) -> bool {
        let Spectrum { left, size, .. } = self.spectrum;
        !self.has_images && self.between <= (MORE * left).max(NOTICED * size).max(self.rounding)
    }

    /// Whether most of the quantity is faster than the values can show.
    pub fn is_false(&self) -> bool {
        !self.is_resolved() && self.between > FALSE * self.spectrum.size
    }

    /// Whether there is nothing else in it, so that none of the lines belongs to it.
    pub fn shows_nothing(&self) -> bool {
        self.is_false() && !self.has_images
    }
}

/// The spectrum of a quantity whose values at ascending times `sample` gives, as far as the motion goes. `look` is given each
/// line, and says whether to go on.
///
/// # Errors
/// Returns an error if the motion ends before, or the quantity is not finite.
pub fn sampled_spectrum(
    request: &SpectrumRequest,
    sample: &mut dyn FnMut(&[f64]) -> Vec<f64>,
    look: &mut dyn FnMut(usize) -> bool,
) -> Result<SampledSpectrum, NoSpectrum> {
    let [mut count, most] = request.counts;
    loop {
        let mut goes_on = true;
        let found = taken(request, count, sample, &mut |line| {
            goes_on = look(line);
            goes_on
        })?;
        if found.is_resolved() || count >= most || !goes_on {
            return Ok(found);
        }
        // each time the motion is followed once more
        count = most.min(if found.is_false() { 4 * count } else { 2 * count });
    }
}

/// The spectrum by this number of values.
fn taken(
    request: &SpectrumRequest,
    count: usize,
    sample: &mut dyn FnMut(&[f64]) -> Vec<f64>,
    look: &mut dyn FnMut(usize) -> bool,
) -> Result<SampledSpectrum, NoSpectrum> {
    let [from, until] = request.span;
    let spacing = (until - from) / count as f64;
    let times: Vec<f64> = (0..count)
        .flat_map(|k| [k as f64, k as f64 + BETWEEN].map(|place| from + place * spacing))
        .collect();
    let all = sample(&times);
    if let Some(&missing) = times.get(all.len()) {
        return Err(NoSpectrum::Ends(missing));
    }
    let part = |first: usize| all.iter().skip(first).step_by(2).copied().collect::<Vec<f64>>();
    let (values, others) = (part(0), part(1));
    let rate = mean_rate(&values, spacing).filter(|_| request.is_angle);
    let straight = straightened(&values, spacing, rate);
    let spectrum = driven_spectrum(&straight, spacing, request.lines, request.drive, look);
    let mut spectrum = spectrum.ok_or(NoSpectrum::NotFinite)?;
    let drift = frequency_drift(&spectrum.without_trend(&straight), spacing, &spectrum.lines);
    let rate_taken = advance(count, spacing, rate);
    let off = |(k, value): (usize, &f64)| {
        let time = (k as f64 + BETWEEN) * spacing;
        value - rate_taken * time - given(&spectrum, k, time)
    };
    let off: Vec<f64> = others.iter().enumerate().map(off).collect();
    let squares: f64 = off.iter().map(|off| off * off).sum();
    let between = (squares / count as f64).sqrt();
    // what is no sum of lines at all, as noise, has no lines that others could be images of
    let is_image = |frequency: f64, size: f64| amplitude(&off, frequency * spacing) > IMAGE * size;
    let images: Vec<bool> =
        spectrum.lines.iter().map(|line| is_image(line.frequency, line.amplitude)).collect();
    let has_images = images.contains(&true) && images.contains(&false);
    if has_images {
        without(&mut spectrum, &images);
    }
    let rounding = ROUNDING * all.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
    Ok(SampledSpectrum { count, spectrum, rate, drift, between, has_images, rounding })
}

/// Takes lines out of a spectrum, with the names that others have by them.
fn without(spectrum: &mut Spectrum, images: &[bool]) {
    let gone: Vec<f64> = spectrum
        .lines
        .iter()
        .zip(images)
        .filter(|(_, image)| **image)
        .map(|(line, _)| line.frequency)
        .collect();
    spectrum.lines.retain(|line| !gone.contains(&line.frequency));
    let is_gone: Vec<bool> = spectrum.fundamentals.iter().map(|f| gone.contains(f)).collect();
    for line in &mut spectrum.lines {
        let by_the_rest = |k: Vec<_>| {
            let mut rest = Vec::new();
            for (n, &gone) in k.into_iter().zip(&is_gone) {
                match (gone, n) {
                    (false, n) => rest.push(n),
                    (true, 0) => {}
                    (true, _) => return None,
                }
            }
            Some(rest)
        };
        line.combination = line.combination.take().and_then(by_the_rest);
    }
    spectrum.fundamentals.retain(|f| !gone.contains(f));
}

/// The amplitude of numbers at this advance of the phase from each to the next, under Hann's window.
fn amplitude(numbers: &[f64], advance: f64) -> f64 {
    let turn = std::f64::consts::TAU / numbers.len() as f64;
    let (mut re, mut im, mut weights) = (0.0, 0.0, 0.0);
    for (k, x) in numbers.iter().enumerate() {
        let weight = 1.0 - math::cos(turn * (k as f64 + 0.5));
        let (sin, cos) = math::sin_cos(advance * k as f64);
        re += weight * x * cos;
        im += weight * x * sin;
        weights += weight;
    }
    2.0 * math::hypot(re, im) / weights
}

/// What the lines give at a time from the beginning, behind the value of this index.
fn given(spectrum: &Spectrum, index: usize, time: f64) -> f64 {
    let slow = |k: usize| spectrum.trend.get(k).copied();
    let trend = slow(index).map_or(0.0, |here| {
        let next = slow(index + 1).unwrap_or(here);
        here + BETWEEN * (next - here)
    });
    let lines = spectrum.lines.iter().map(|line| {
        let (_, cos) = math::sin_cos(line.frequency * time + line.phase);
        line.amplitude * cos
    });
    spectrum.mean + trend + lines.sum::<f64>()
}
