//! What is said of the action in phase space: by how much it is greater on the curves beside the motion.
//!
//! In: the curves. Out: lines of the legend. Never here: how they are found (`dynamics`).

use crate::dynamics::VariedAction;
use crate::num::significant;

/// What is less than this part of the greatest of some actions is rounding of the others.
const ROUNDING: f64 = 1e-13;

/// By how much the action in phase space is greater on the last curve of each kind, so that they are known without colours.
pub(super) fn beside_by(varied: &VariedAction, name: &str) -> Vec<String> {
    let short = |x: f64| significant(x, 2, 1e-3..1e5).replace('-', "−");
    let ends: Vec<[f64; 2]> =
        varied.curves.iter().filter_map(|curve| curve.last().copied()).collect();
    let [q, p, both] = ends[..] else { return Vec::new() };
    let largest = ends.iter().map(|end| end[1].abs()).fold(0.0, f64::max);
    // linear in what is varied: rounding of the others is no value
    let known = |rise: f64| if rise.abs() <= ROUNDING * largest { 0.0 } else { rise };
    let [q, p, both, epsilon] = [known(q[1]), known(p[1]), known(both[1]), q[0]].map(short);
    vec![format!("ε = {epsilon}: {name} {q}, p {p}, both {both}")]
}

/// Whether an action in phase space is greater or less on the curves beside the motion.
pub(super) fn nature(varied: &VariedAction) -> String {
    let rises = varied.curves.iter().flatten().map(|at| at[1]);
    let (least, greatest) =
        rises.fold((0.0_f64, 0.0_f64), |(lo, hi), rise| (lo.min(rise), hi.max(rise)));
    let word = match (least < 0.0, greatest > 0.0) {
        (true, true) => "neither least nor greatest",
        (true, false) => "greater than on these curves",
        (false, true) => "less than on these curves",
        (false, false) => "the same on these curves",
    };
    word.to_owned()
}
