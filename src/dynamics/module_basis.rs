//! A basis of the combinations of frequencies, changed where a line is half of one.
//!
//! The strongest lines need not be a basis: of the lines m·ω with m₁ + m₂ odd alone, ω₁ + ω₂ may never appear, and two lines span
//! every second combination only. A further line that is half of a combination of theirs then takes the place of one of them.
//!
//! In: fundamental frequencies, lines with their integers. Out: the same by another basis. Never here: the signal.

use super::spectral_line::combination;

/// A line changes the basis only if it is known to this part of a turn in the whole time: what is known less is near some
/// combination by chance.
const KNOWN: f64 = 1e-3;

/// Names a line that is half of a combination of the frequencies, of which the first are `fixed`, and changes these and
/// the other names accordingly. `least` is what always fits, and `turn` one turn in the whole time.
pub(super) fn halved(
    known: &mut [(f64, f64)],
    fixed: usize,
    lines: &[(f64, f64)],
    names: &mut [Option<Vec<i32>>],
    (least, turn): (f64, f64),
) {
    for line in 0..lines.len() {
        let (frequency, error) = lines[line];
        if names[line].is_none() {
            names[line] = combination(known, (frequency, error), least);
        }
        if names[line].is_some() || error > KNOWN * turn {
            continue;
        }
        let Some(twice) = combination(known, (2.0 * frequency, 2.0 * error), 2.0 * least) else {
            continue;
        };
        let unit = |k: &[i32]| (fixed..k.len()).rev().find(|&j| k[j].abs() == 1);
        // the line itself, if one of the frequencies is an integer combination of it and the others
        let (half, at, new) = match unit(&twice) {
            Some(at) => (twice.clone(), at, lines[line]),
            None => {
                let odd: Vec<i32> = twice.iter().map(|k| k.rem_euclid(2)).collect();
                let Some(at) = unit(&odd) else { continue };
                let sum = |of: fn(&(f64, f64)) -> f64| {
                    known.iter().zip(&odd).map(|(f, &k)| f64::from(k) * of(f)).sum::<f64>()
                };
                let new = (0.5 * sum(|f| f.0), 0.5 * sum(|f| f.1));
                (odd, at, new)
            }
        };
        let changed = |name: &[i32]| -> Vec<i32> {
            let times = name[at] * half[at];
            let entry = |(i, (&own, &k)): (usize, (&i32, &i32))| {
                if i == at { 2 * times } else { own - times * k }
            };
            name.iter().zip(&half).enumerate().map(entry).collect()
        };
        for name in names.iter_mut().flatten() {
            name.resize(half.len(), 0);
            *name = changed(name);
        }
        // half of 2ω, which is even in all entries by the new basis
        names[line] = Some(changed(&twice).into_iter().map(|k| k / 2).collect());
        known[at] = new;
    }
    // those before the last change
    for (name, &line) in names.iter_mut().zip(lines) {
        if name.is_none() {
            *name = combination(known, line, least);
        }
    }
}
