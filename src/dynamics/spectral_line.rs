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

/// The integers k of least Σ|k| with which a frequency is k·ω, if there are some.
pub(super) fn combination(
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
