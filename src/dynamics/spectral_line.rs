//! A line of a spectrum, and its name: the combination k·ω of the fundamental frequencies that it is.
//!
//! In: frequencies with their errors. Out: the integers k, if there are few and small ones. Never here: the signal.

use crate::expr::subscripts;

/// The greatest Σ|k| of a combination, and the greatest multiple of one frequency alone.
const ORDER: i32 = 9;
const MULTIPLE: i32 = 40;

/// A combination fits within this many times what is not known.
const SIGMAS: f64 = 10.0;

/// A line of a spectrum: amplitude · cos(ω t + phase), t from the beginning.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectralLine {
    /// ω.
    pub frequency: f64,
    /// How far ω is known: its standard deviation, as if what is left of the signal were noise, or what an unresolved line beside it
    /// may have moved it by, if that is more.
    pub error: f64,
    /// Half the distance between crest and trough.
    pub amplitude: f64,
    /// At t = 0, in radians.
    pub phase: f64,
    /// The integers k with ω = k·(the fundamental frequencies), if it is such a combination.
    pub combination: Option<Vec<i32>>,
    /// The multiple of the frequency of a drive that is added to that combination.
    pub drive: i32,
}

impl SpectralLine {
    /// The combination in words: `ω₁ − 2ω₂`; Ω is the frequency of the drive.
    pub fn name(&self) -> Option<String> {
        self.combination.as_ref().map(|k| named(k, self.drive))
    }
}

fn named(k: &[i32], drive: i32) -> String {
    let index = |i: usize| subscripts(&(i + 1).to_string());
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

/// Whether a line is known so well that it can be given to one of these frequencies, each with its error: to less than half
/// of the least of them, and of the least difference of two.
pub(super) fn is_distinguishable(known: &[(f64, f64)], error: f64) -> bool {
    let apart = |(i, one): (usize, &(f64, f64))| {
        let others = known[..i].iter().map(move |other| {
            let apart = (one.0 - other.0).abs();
            // frequencies of a resonance are one
            if apart > SIGMAS * (one.1 + other.1) { apart } else { f64::INFINITY }
        });
        others.fold(one.0.abs(), f64::min)
    };
    error < 0.5 * known.iter().enumerate().map(apart).fold(f64::INFINITY, f64::min)
}

/// The integers k of least Σ|k| with which a frequency is k·ω, if there are some; of several the nearest one, where the
/// error of the frequency tells. `None` where it tells nothing.
pub(super) fn combination(
    known: &[(f64, f64)],
    (frequency, error): (f64, f64),
    least: f64,
) -> Option<Vec<i32>> {
    if !is_distinguishable(known, error) {
        return None;
    }
    let mut search = CombinationSearch { error, k: Vec::new(), best: None };
    let most = if known.len() == 1 { MULTIPLE } else { ORDER };
    (1..=most).find_map(|order| {
        search.visit(known, (frequency, SIGMAS * error + least), order);
        search.best.take().map(|(_, k)| k)
    })
}

struct CombinationSearch {
    error: f64,
    k: Vec<i32>,
    /// How far the best combination is from the frequency, and its integers.
    best: Option<(f64, Vec<i32>)>,
}

impl CombinationSearch {
    /// Visits all combinations with this Σ|k| left for these frequencies, where `rest` is what is left of the frequency, known
    /// to `doubt`.
    fn visit(&mut self, known: &[(f64, f64)], (rest, doubt): (f64, f64), room: i32) {
        let Some(((frequency, error), others)) = known.split_first() else {
            let nearer = self.best.as_ref().is_none_or(|(best, _)| rest.abs() + self.error < *best);
            if room == 0 && rest.abs() <= doubt && nearer {
                self.best = Some((rest.abs(), self.k.clone()));
            }
            return;
        };
        for size in 0..=room {
            for sign in if size == 0 { &[1][..] } else { &[1, -1][..] } {
                let times = sign * size;
                self.k.push(times);
                let next = rest - f64::from(times) * frequency;
                let doubt = doubt + SIGMAS * error * f64::from(size);
                self.visit(others, (next, doubt), room - size);
                self.k.pop();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Beside ω₁ = 1.05 and ω₂ = 0.97 a line at 3.08 ± 0.01 is 2ω₁ + ω₂, and not ω₁ + 2ω₂, although ten errors allow both.
    #[test]
    fn of_two_combinations_the_nearer_one_is_named() {
        let known = [(1.05, 1e-4), (0.97, 2e-3)];
        let name = |frequency, error| combination(&known, (frequency, error), 1e-6);
        assert_eq!(name(3.08, 0.01), Some(vec![2, 1]));
        assert_eq!(name(2.98, 0.01), Some(vec![1, 2]));
        // a resonance: both are the same frequency, and the first one is taken
        let resonant = [(3.0, 1e-6), (1.0, 1e-6)];
        assert_eq!(combination(&resonant, (2.0, 1e-6), 1e-9), Some(vec![0, 2]));
    }

    /// Half of the difference 0.08 of the two frequencies is the limit.
    #[test]
    fn a_line_that_is_not_known_well_enough_has_no_name() {
        let known = [(1.05, 1e-4), (0.97, 2e-3)];
        for (error, named) in [(0.039, true), (0.041, false), (8.0, false)] {
            assert_eq!(is_distinguishable(&known, error), named, "{error}");
            assert_eq!(combination(&known, (1.0, error), 0.0).is_some(), named, "{error}");
        }
        assert!(is_distinguishable(&[], 8.0));
        assert!(
            is_distinguishable(&[(2.0, 0.0)], 0.99) && !is_distinguishable(&[(2.0, 0.0)], 1.01)
        );
        // two that their own errors do not tell apart are one
        assert!(is_distinguishable(&[(2.0, 1e-3), (2.001, 1e-3)], 0.5));
    }
}
