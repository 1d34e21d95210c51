//! What to try where a conserved quantity has drifted.
//!
//! In: a method and its settings. Out: half a sentence. Never here: how far it has drifted.

use crate::integrate::{METHODS, Stepping};
use crate::num::short;

/// Advice for a smaller drift, by a method with this step or tolerance, where it is one for all motions.
pub(super) fn advice(method: &str, step: Option<f64>, tolerance: Option<f64>) -> String {
    let row = METHODS.iter().find(|row| row.name == method);
    match (row.map(|row| row.stepping), tolerance) {
        (Some(Stepping::Fixed), _) => {
            let smaller = match step {
                Some(step) => format!("a --step below {}", short(step)),
                None => "a smaller --step".to_owned(),
            };
            format!("try {smaller}, or the default method")
        }
        (_, Some(tolerance)) => {
            format!("try a --tolerance below {}, or leave it out", short(tolerance))
        }
        (_, None) => {
            let other = if method == "dop853" { "taylor" } else { "dop853" };
            format!("the motion may have passed a singular point: compare with --method {other}")
        }
    }
}

/// A relative size with two digits.
pub(super) fn size(x: f64) -> String {
    match x {
        0.01..1000.0 => format!("{x:.2}"),
        _ if x.is_finite() => format!("{x:.1e}"),
        _ => "more than can be reported".to_owned(),
    }
}
