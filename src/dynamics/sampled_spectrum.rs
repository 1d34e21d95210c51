//! The spectrum of a quantity of a motion, taken as often as the quantity needs.
//!
//! At equal intervals a line of ω looks like one of 2π k/h ± ω. Between the values, at the golden section of each interval, no two
//! of these agree: there the quantity is held against the lines that were found, and where they do not give it more values
//! are taken.
//!
//! In: a motion that can be sampled at any times. Out: lines, and what they leave at and between the values. Never here: how the
//! motion is computed, names.

use super::frequency_drift::{FrequencyDrift, frequency_drift};
use super::spectral_line::SpectralLine;
use super::spectrum::{MeanRate, Spectrum, advance, driven_spectrum, mean_rate, straightened};
use crate::num::{math, significant};

/// Where between two values the quantity is evaluated, as a part of the interval.
const BETWEEN: f64 = 0.618_033_988_749_894_9;

/// Lines are those of the quantity if they leave, between the values, no more than this many times what they leave at
/// them.
const MORE: f64 = 3.0;

/// Lines are also those of the quantity if they leave no more than this part of its size.
const NOTICED: f64 = 1e-7;

/// Lines are also those of the quantity if they leave no more than this part of its largest value, which may be
/// rounding.
const ROUNDING: f64 = 1e-12;

/// Lines that leave more than this part of the quantity between the values are not there.
const FALSE: f64 = 0.5;

/// A line that leaves more than this part of itself between the values, and little at them, is the image of a faster one. Those whose order is a large
/// number of Fibonacci's, and few others, leave less: see [`is_faint_image`].
const IMAGE: f64 = 0.3;

/// The orders up to which such images are known.
const ORDERS: u32 = 100;

/// A line is such an image if it leaves what one should to this part of it.
const AGREES: f64 = 0.5;

/// Such an image lies at a multiple of a frequency within this many times the errors.
const SURE: f64 = 3.0;

/// The errors make no more than this part of that frequency, so that it is not met by chance.
const CHANCE: f64 = 1e-2;

/// A request for the spectrum of a quantity.
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
    /// The lines that were left out as images of faster ones, as a motion that jumps has them without end; the strongest first.
    pub images: Vec<SpectralLine>,
    rounding: f64,
}

/// Why there is no spectrum.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
pub enum NoSpectrum {
    /// The motion ends before this time.
    #[error("the motion ends before t = {}", significant(*.0, 4, 1e-3..1e5))]
    Ends(f64),
    /// The quantity is not finite.
    #[error("the motion has no finite values")]
    NotFinite,
}

impl SampledSpectrum {
    /// Whether the lines give the quantity between the values too.
    pub fn is_resolved(&self) -> bool {
        let Spectrum { left, size, .. } = self.spectrum;
        !self.has_images() && self.between <= (MORE * left).max(NOTICED * size).max(self.rounding)
    }

    /// Whether lines were left out that are images of faster ones. The others belong to the quantity.
    pub fn has_images(&self) -> bool {
        !self.images.is_empty()
    }

    /// Whether none of the lines belongs to the quantity: it is faster than the values can show.
    pub fn is_false(&self) -> bool {
        !self.has_images() && self.is_missed()
    }

    /// Whether the strongest line was left out, so that the others are not what is fast in the quantity.
    pub fn is_strongest_left_out(&self) -> bool {
        let amplitude = |lines: &[SpectralLine]| lines.first().map_or(0.0, |line| line.amplitude);
        amplitude(&self.images) > amplitude(&self.spectrum.lines)
    }

    /// Whether what was fitted to the values misses most of the quantity between them.
    fn is_missed(&self) -> bool {
        !self.is_resolved() && self.between > FALSE * self.spectrum.size
    }
}

/// The spectrum of a quantity whose values at ascending times `sample` gives, as far as the motion goes. `report` is given each
/// line, and returns whether to continue.
///
/// # Errors
/// Returns an error if the motion ends before, or the quantity is not finite.
pub fn sampled_spectrum(
    request: &SpectrumRequest,
    sample: &mut dyn FnMut(&[f64]) -> Vec<f64>,
    report: &mut dyn FnMut(usize) -> bool,
) -> Result<SampledSpectrum, NoSpectrum> {
    let [mut count, most] = request.counts;
    loop {
        let mut continues = true;
        let found = taken(request, count, sample, &mut |line| {
            continues = report(line);
            continues
        })?;
        if found.is_resolved() || count >= most || !continues {
            return Ok(found);
        }
        // each time the motion is followed once more
        count = most.min(if found.is_missed() { 4 * count } else { 2 * count });
    }
}

fn taken(
    request: &SpectrumRequest,
    count: usize,
    sample: &mut dyn FnMut(&[f64]) -> Vec<f64>,
    report: &mut dyn FnMut(usize) -> bool,
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
    let spectrum = driven_spectrum(&straight, spacing, request.lines, request.drive, report);
    let mut spectrum = spectrum.ok_or(NoSpectrum::NotFinite)?;
    let drift = frequency_drift(&spectrum.without_trend(&straight), spacing, &spectrum.lines);
    let rate_taken = advance(count, spacing, rate);
    let off = |(k, value): (usize, &f64)| {
        let time = (k as f64 + BETWEEN) * spacing;
        value - rate_taken * time - given(&spectrum, (k, BETWEEN), time)
    };
    let left = |(k, value): (usize, &f64)| value - given(&spectrum, (k, 0.0), k as f64 * spacing);
    let left: Vec<f64> = straight.iter().enumerate().map(left).collect();
    let off: Vec<f64> = others.iter().enumerate().map(off).collect();
    let squares: f64 = off.iter().map(|off| off * off).sum();
    let between = (squares / count as f64).sqrt();
    let images = images(&spectrum, [&left, &off], spacing);
    without(&mut spectrum, &images.iter().map(|line| line.frequency).collect::<Vec<f64>>());
    let rounding = ROUNDING * all.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
    Ok(SampledSpectrum { count, spectrum, rate, drift, between, images, rounding })
}

/// The lines that are images of faster ones, by what all lines leave at and between the values. What is no sum of lines at
/// all, as noise, has none that others could be images of.
fn images(spectrum: &Spectrum, [left, off]: [&[f64]; 2], spacing: f64) -> Vec<SpectralLine> {
    let part = |off: &[f64], line: &SpectralLine| {
        amplitude(off, line.frequency * spacing) / line.amplitude
    };
    // a line for which several stand, closer than the time tells apart, leaves as much at the values
    let at_values = |line: &SpectralLine| MORE * part(left, line);
    let left = |line: &SpectralLine| part(off, line);
    let (mut images, own): (Vec<&SpectralLine>, Vec<_>) =
        spectrum.lines.iter().partition(|line| left(line) > at_values(line).max(IMAGE));
    let is_named_by = |line: &&&SpectralLine| spectrum.fundamentals.contains(&line.frequency);
    let bases: Vec<&SpectralLine> = own.iter().filter(is_named_by).copied().collect();
    let is_faint = |line: &&SpectralLine| {
        bases.iter().any(|base| is_faint_image(line, base, left(line), spacing))
    };
    images.extend(own.iter().copied().filter(is_faint));
    if images.len() == spectrum.lines.len() {
        return Vec::new();
    }
    images.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
    images.into_iter().cloned().collect()
}

/// Whether a line that leaves this part of itself between the values is the image of a multiple of a base frequency. The image
/// of order k of a line lies at |ω − 2π k/h| and leaves 2 |sin π k g| of itself at the part g of the interval: little where
/// k g is nearly an integer.
fn is_faint_image(line: &SpectralLine, base: &SpectralLine, left: f64, spacing: f64) -> bool {
    let is_multiple = |frequency: f64| {
        let times = (frequency / base.frequency).round();
        let error = SURE * (line.error + times * base.error);
        error <= CHANCE * base.frequency && (frequency - times * base.frequency).abs() <= error
    };
    if is_multiple(line.frequency) {
        return false;
    }
    (1..=ORDERS).map(f64::from).any(|order| {
        let leaves = 2.0 * math::sin(std::f64::consts::PI * order * BETWEEN).abs();
        let shift = std::f64::consts::TAU * order / spacing;
        leaves <= IMAGE
            && (left - leaves).abs() <= AGREES * leaves
            && [shift - line.frequency, shift + line.frequency].into_iter().any(is_multiple)
    })
}

/// Takes lines of these frequencies out of a spectrum, with the names that others have by them.
fn without(spectrum: &mut Spectrum, removed: &[f64]) {
    if removed.is_empty() {
        return;
    }
    spectrum.lines.retain(|line| !removed.contains(&line.frequency));
    let is_removed: Vec<bool> = spectrum.fundamentals.iter().map(|f| removed.contains(f)).collect();
    for line in &mut spectrum.lines {
        let by_the_rest = |k: Vec<_>| {
            let mut rest = Vec::new();
            for (n, &removed) in k.into_iter().zip(&is_removed) {
                match (removed, n) {
                    (false, n) => rest.push(n),
                    (true, 0) => {}
                    (true, _) => return None,
                }
            }
            Some(rest)
        };
        line.combination = line.combination.take().and_then(by_the_rest);
    }
    spectrum.fundamentals.retain(|f| !removed.contains(f));
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

/// What the lines give at a time from the beginning, this part of an interval behind the value of this index.
fn given(spectrum: &Spectrum, (index, part): (usize, f64), time: f64) -> f64 {
    let slow = |k: usize| spectrum.trend.get(k).copied();
    let trend = slow(index).map_or(0.0, |here| {
        let next = slow(index + 1).unwrap_or(here);
        here + part * (next - here)
    });
    let lines = spectrum.lines.iter().map(|line| {
        let (_, cos) = math::sin_cos(line.frequency * time + line.phase);
        line.amplitude * cos
    });
    spectrum.mean + trend + lines.sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(frequency: f64, error: f64) -> SpectralLine {
        let combination = None;
        SpectralLine { frequency, error, amplitude: 1.0, phase: 0.0, combination, drive: 0 }
    }

    /// Whether the image of the multiple next to 2π k of a frequency of 1 is seen, at intervals of 1. The frequency has this error;
    /// the image is off by a part of what that makes, and leaves this multiple of what it should.
    fn is_seen(order: u32, error: f64, off: f64, leaves: f64) -> bool {
        let shift = std::f64::consts::TAU * f64::from(order);
        let times = shift.round();
        let place = (shift - times).abs() + off * SURE * times * error;
        let left = 2.0 * math::sin(std::f64::consts::PI * f64::from(order) * BETWEEN).abs();
        is_faint_image(&line(place, 0.0), &line(1.0, error), left * leaves, 1.0)
    }

    /// 89 and 102 are the nearest orders whose images leave as little of themselves as faint ones may.
    #[test]
    fn a_faint_image_has_an_order_up_to_a_hundred() {
        assert!(is_seen(89, 1e-6, 0.0, 1.0));
        assert!(!is_seen(102, 1e-6, 0.0, 1.0));
    }

    #[test]
    fn a_faint_image_leaves_what_it_should_to_one_half() {
        for leaves in [0.55, 1.0, 1.45] {
            assert!(is_seen(89, 1e-6, 0.0, leaves), "{leaves}");
        }
        for leaves in [0.45, 1.55] {
            assert!(!is_seen(89, 1e-6, 0.0, leaves), "{leaves}");
        }
    }

    /// 2π · 89 is nearest to 559: three errors of that multiple may be a hundredth of the frequency.
    #[test]
    fn a_faint_image_is_not_met_by_chance() {
        let error = 1e-2 / (3.0 * 559.0);
        assert!(is_seen(89, 0.9 * error, 0.0, 1.0));
        assert!(!is_seen(89, 1.1 * error, 0.0, 1.0));
        assert!(is_seen(89, 0.5 * error, 0.9, 1.0));
        assert!(!is_seen(89, 0.5 * error, 1.1, 1.0));
    }
}
