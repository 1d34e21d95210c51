//! The torus on which a motion lies: its frequencies, whether their ratios are those of whole numbers, and the resonance nearest
//! to it.
//!
//! In: the coordinates at equal intervals of time. Out: frequencies with their errors, in a basis in which all strong lines are
//! whole combinations. Whether they are commensurate, and the common period, do not depend on the basis; the nearest resonance
//! of small numbers does. Never here: motions.

use std::f64::consts::TAU;

use super::spectral_fit::FITS;
use super::spectral_line::combination;
use super::spectrum::{MeanRate, mean_rate, spectrum, straightened};
use crate::num::{short, to_its_error};

/// The lines of a coordinate that are searched for.
const LINES: usize = 10;

/// Lines below this part of the size of a coordinate are left out.
const STRONG: f64 = 1e-3;

/// The error of a frequency, as if what is left were noise, is taken this many times.
const SIGMAS: f64 = 10.0;

/// The largest denominator that is tried, and the least below which there must be none for a torus not to be called resonant.
const DENOMINATORS: u32 = 1_000_000;
const NO_RESONANCE: u32 = 200;

/// The largest chance at which a ratio that is not known better may be a fraction by accident.
const CHANCE: f64 = 1e-3;

/// The whole numbers of a resonance that is named.
const WHOLE: u32 = 12;

/// A coordinate at equal intervals of time.
pub(super) struct Signal {
    pub(super) values: Vec<f64>,
    /// Its period, if it is an angle.
    pub(super) turn: Option<f64>,
}

/// The frequencies of a torus with their errors, that of a drive first.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Torus {
    frequencies: Vec<(f64, f64)>,
    is_driven: bool,
}

/// The strong lines of a coordinate, each with its part of the size of the coordinate, and the mean rate of an angle;
/// `None` if the coordinate is not a sum of lines.
fn strong_lines(
    signal: &Signal,
    spacing: f64,
    drive: Option<f64>,
) -> Option<Vec<(f64, (f64, f64))>> {
    let scale = signal.turn.map_or(1.0, |turn| TAU / turn);
    let values: Vec<f64> = signal.values.iter().map(|x| x * scale).collect();
    let rate = signal.turn.and_then(|_| mean_rate(&values, spacing));
    let rate = rate.filter(|found| found.rate.abs() * spacing * values.len() as f64 > TAU);
    let found =
        spectrum(&straightened(&values, spacing, rate), spacing, (LINES, 0), &mut |_| true)?;
    if found.is_continuous() {
        return None;
    }
    let lines = found.lines.iter().filter(|line| line.amplitude > STRONG * found.size);
    let lines = lines.map(|line| (line.amplitude / found.size, (line.frequency, line.error)));
    let rate = rate.map(|MeanRate { rate, error }| match drive {
        Some(drive) => (1.0, (rate.rem_euclid(drive), error)),
        None => (1.0, (rate.abs(), error)),
    });
    Some(lines.chain(rate).collect())
}

/// As many of the lines as are missing, the strongest first, of which all are combinations.
fn basis(
    known: Vec<(f64, f64)>,
    lines: &[(f64, f64)],
    missing: usize,
    spans: &dyn Fn(&[(f64, f64)]) -> bool,
) -> Option<Vec<(f64, f64)>> {
    if missing == 0 {
        return spans(&known).then_some(known);
    }
    (0..lines.len()).find_map(|k| {
        let more: Vec<(f64, f64)> = known.iter().copied().chain([lines[k]]).collect();
        basis(more, &lines[k + 1..], missing - 1, spans)
    })
}

/// Whole numbers in the ratio of frequencies, or near it.
#[derive(Clone, Debug, PartialEq)]
struct Resonance {
    /// The denominator, the number of the first frequency.
    first: u32,
    others: Vec<f64>,
    /// The largest distance of a ratio.
    off: f64,
}

impl Torus {
    /// The torus of as many dimensions as there are independent frequencies; `None` if the lines do not show that many, or are
    /// not all whole combinations of them. A drive has a known frequency, and the intervals are then its period.
    pub(super) fn of(
        signals: &[Signal],
        spacing: f64,
        dimension: usize,
        drive: Option<f64>,
    ) -> Option<Torus> {
        let first: Vec<(f64, f64)> = drive.map(|frequency| (frequency, 0.0)).into_iter().collect();
        if dimension + first.len() < 2 {
            return None;
        }
        let (length, mut lines) = (spacing * signals.first()?.values.len() as f64, Vec::new());
        for signal in signals {
            lines.extend(strong_lines(signal, spacing, drive)?);
        }
        lines.sort_by(|a, b| b.0.total_cmp(&a.0));
        let lines: Vec<(f64, f64)> = lines.into_iter().map(|(_, line)| line).collect();
        let least = FITS * TAU / length;
        let frequencies = basis(first, &lines, dimension, &|known| {
            lines.iter().all(|line| combination(known, *line, least).is_some())
        })?;
        Some(Torus { frequencies, is_driven: drive.is_some() })
    }

    /// The ratios of the other frequencies to the first, and what is not known of them.
    fn ratios(&self) -> Vec<(f64, f64)> {
        let [(first, doubt), others @ ..] = &self.frequencies[..] else { return Vec::new() };
        let ratio = |&(frequency, error): &(f64, f64)| {
            let ratio = frequency / first;
            (ratio, SIGMAS * (error + ratio * doubt) / first + 4.0 * f64::EPSILON * ratio)
        };
        others.iter().map(ratio).collect()
    }

    /// The resonance with this denominator that is nearest.
    fn resonance(&self, first: u32) -> Resonance {
        let n = f64::from(first);
        let ratios = self.ratios();
        let others: Vec<f64> = ratios.iter().map(|(ratio, _)| (ratio * n).round()).collect();
        let apart = ratios.iter().zip(&others).map(|((ratio, _), whole)| (ratio - whole / n).abs());
        Resonance { first, off: apart.fold(0.0, f64::max), others }
    }

    /// The least denominator with which fractions are the ratios, within what is not known of them.
    fn least_denominator(&self) -> Option<u32> {
        let ratios = self.ratios();
        (1..=DENOMINATORS).find(|&first| {
            let n = f64::from(first);
            ratios.iter().all(|(ratio, doubt)| (ratio * n - (ratio * n).round()).abs() <= doubt * n)
        })
    }

    /// The nearest resonance of small whole numbers.
    fn nearest(&self) -> Option<Resonance> {
        let small = |whole: &f64| (1.0..=f64::from(WHOLE)).contains(whole);
        let all = (1..=WHOLE).map(|first| self.resonance(first));
        all.filter(|found| found.others.iter().all(small)).min_by(|a, b| a.off.total_cmp(&b.off))
    }

    fn period(&self, resonance: &Resonance) -> f64 {
        TAU * f64::from(resonance.first) / self.frequencies[0].0
    }

    fn period_error(&self, resonance: &Resonance) -> f64 {
        let (frequency, error) = self.frequencies[0];
        self.period(resonance) * SIGMAS * error / frequency
    }

    pub(super) fn sentence(&self) -> String {
        let frequencies: Vec<String> =
            self.frequencies.iter().map(|&(x, error)| digits(x, SIGMAS * error)).collect();
        let ratios = self.ratios();
        let values: Vec<String> = (ratios.iter())
            .map(|(ratio, doubt)| format!("{} ± {}", digits(*ratio, *doubt), in_one_digit(*doubt)))
            .collect();
        let whose = if self.is_driven { " (the first is that of the drive)" } else { "" };
        let all = format!("its frequencies {}{whose}", frequencies.join(" and "));
        let over = if ratios.len() > 1 { "ratios to the first" } else { "ratio to the first" };
        let values = format!("{over} {}", values.join(" and "));
        let denominator = self.least_denominator();
        let doubt = ratios.iter().fold(0.0, |most: f64, (_, doubt)| most.max(*doubt));
        let is_certain = |first: &u32| doubt * f64::from(first * first) <= CHANCE;
        if let Some(first) = denominator.filter(|first| *first <= WHOLE && is_certain(first)) {
            let found = self.resonance(first);
            return format!(
                "lies on a resonant torus: {all} are in the ratio {}, and it closes after {}",
                found.numbers(),
                digits(self.period(&found), self.period_error(&found))
            );
        }
        let is_free = denominator.is_none_or(|first| first >= NO_RESONANCE);
        let what = if is_free { "a torus that is not resonant" } else { "a torus" };
        let mut text = format!("lies on {what}: {all}, {values}");
        if is_free {
            let below = denominator.unwrap_or(DENOMINATORS);
            text.push_str(&format!(
                ", within which there is no fraction with a denominator below {below}"
            ));
        }
        if let Some(found) = self.nearest() {
            text.push_str(&format!(
                ". The nearest resonance of these frequencies of whole numbers up to {WHOLE} is {}, {} away in the ratio, whose orbits close after about {}",
                found.numbers(),
                format_args!("{:.1e}", found.off),
                short(self.period(&found))
            ));
        }
        text
    }
}

impl Resonance {
    /// The whole numbers, that of the first frequency first.
    fn numbers(&self) -> String {
        let all: Vec<String> = std::iter::once(f64::from(self.first))
            .chain(self.others.iter().copied())
            .map(|whole| whole.to_string())
            .collect();
        all.join(" : ")
    }
}

/// A number with ten digits, or as many as its error leaves.
fn digits(x: f64, error: f64) -> String {
    to_its_error(x, error, 10, 1e-4..1e6)
}

/// A number with one digit; as a decimal where that is short.
fn in_one_digit(x: f64) -> String {
    match x {
        0.095..0.95 => format!("{x:.1}"),
        0.0095..0.095 => format!("{x:.2}"),
        _ => format!("{x:.0e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::math;

    #[test]
    fn an_error_has_one_digit() {
        for (x, text) in
            [(0.096, "0.1"), (0.094, "0.09"), (0.02, "0.02"), (0.004, "4e-3"), (1.2, "1e0")]
        {
            assert_eq!(in_one_digit(x), text);
        }
    }

    fn sentence(ratio: f64, doubt: f64) -> String {
        let frequencies = vec![(1.0, 0.0), (ratio, doubt / SIGMAS)];
        Torus { frequencies, is_driven: false }.sentence()
    }

    /// Within 0.01 every ratio is near a fraction of denominator twelve or less.
    #[test]
    fn a_ratio_that_is_hardly_known_is_no_resonance() {
        assert!(sentence(1.5, 1e-9).starts_with("lies on a resonant torus"));
        assert!(sentence(1.5, 2.4e-4).starts_with("lies on a resonant torus"));
        for doubt in [2.6e-4, 1e-2, 0.04, 0.6] {
            let text = sentence(1.5, doubt);
            assert!(text.starts_with("lies on a torus: "), "{doubt}: {text}");
        }
        let mean = f64::midpoint(1.0, 5.0_f64.sqrt());
        let golden = sentence(mean, 1e-9);
        assert!(golden.starts_with("lies on a torus that is not resonant"), "{golden}");
        let golden = sentence(mean, 0.01);
        assert!(golden.starts_with("lies on a torus: "), "{golden}");
    }

    #[test]
    fn no_digit_goes_beyond_what_is_known() {
        let text = sentence(0.920_604_232_837, 3e-5);
        assert!(text.contains("ratio to the first 0.9206 ± 3e-5"), "{text}");
        assert!(text.contains("its frequencies 1 and 0.9206,"), "{text}");
    }

    /// A ratio that is known to nine digits, with this denominator.
    fn of_denominator(first: u32) -> String {
        sentence(f64::from(first + 1) / f64::from(first), 1e-9)
    }

    #[test]
    fn a_resonance_is_named_up_to_twelve() {
        assert!(of_denominator(12).starts_with("lies on a resonant torus"));
        let beyond = of_denominator(13);
        assert!(beyond.starts_with("lies on a torus: "), "{beyond}");
        assert!(beyond.contains("whole numbers up to 12 is 11 : 12"), "{beyond}");
    }

    #[test]
    fn a_torus_is_called_free_of_resonance_from_a_denominator_of_two_hundred_on() {
        let below = of_denominator(199);
        assert!(below.starts_with("lies on a torus: "), "{below}");
        let beyond = of_denominator(200);
        assert!(beyond.starts_with("lies on a torus that is not resonant"), "{beyond}");
    }

    /// A coordinate with lines at 1 and √3, and a third one with this amplitude and frequency.
    fn with_third(amplitude: f64, frequency: f64) -> Option<Torus> {
        let value = |k: u32| {
            let t = 0.1 * f64::from(k);
            let [one, two] = [math::cos(t), math::cos(3.0_f64.sqrt() * t)];
            one + 0.4 * two + amplitude * math::cos(frequency * t)
        };
        let signal = Signal { values: (0..4096).map(value).collect(), turn: None };
        Torus::of(&[signal], 0.1, 2, None)
    }

    /// The root mean square of the two lines is √(0.58).
    #[test]
    fn a_line_counts_from_a_thousandth_of_the_size_on() {
        let size = 0.58_f64.sqrt();
        assert!(with_third(0.8e-3 * size, 0.377).is_some());
        assert!(with_third(1.25e-3 * size, 0.377).is_none());
    }

    #[test]
    fn a_line_is_a_combination_within_a_ten_thousandth_of_a_turn() {
        let turn = TAU / 409.6;
        assert!(with_third(0.1, 2.0 + 0.8e-4 * turn).is_some());
        assert!(with_third(0.1, 2.0 + 1.25e-4 * turn).is_none());
    }
}
