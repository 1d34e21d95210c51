//! An instant of a motion of which the action is known, and what has changed since another.
//!
//! In: the motion of the frozen system at a time. Out: its action and energy, their relative changes, as written. Never here:
//! whether a change is slow.

use crate::action_angle::{FrozenMotion, OwnMotion, RegionKind};
use crate::num::significant;

/// An instant of the motion.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct ActionAtTime {
    pub(super) time: f64,
    pub(super) energy: f64,
    /// The energy above the least one of the coordinate.
    pub(super) height: f64,
    pub(super) action: f64,
}

impl ActionAtTime {
    pub(super) fn of(
        motion: &FrozenMotion<'_>,
        own: &OwnMotion,
        time: f64,
    ) -> Option<ActionAtTime> {
        let row = own.row.as_ref().ok().filter(|row| row.kind != RegionKind::Unbounded)?;
        let height = own.energy - motion.bottom(own);
        Some(ActionAtTime { time, energy: own.energy, height, action: row.action })
    }

    /// Its place in the picture of J over the energy, or over the height of the energy where a least one is drawn at 0.
    pub(super) fn seen(&self, bottom: Option<f64>) -> [f64; 2] {
        [if bottom.is_some() { self.height } else { self.energy }, self.action]
    }

    /// By which part action and height have changed since another moment; `None` where there was nothing to have parts.
    pub(super) fn changes_since(&self, first: &ActionAtTime) -> Option<[f64; 2]> {
        let part = |from: f64, to: f64| (from > 0.0).then(|| (to - from) / from);
        Some([part(first.action, self.action)?, part(first.height, self.height)?])
    }
}

/// A relative change with its sign; 0 has none.
pub(super) fn signed(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let size = significant(x.abs(), 2, 1e-3..1e5);
    if x < 0.0 { format!("−{size}") } else { format!("+{size}") }
}

#[cfg(test)]
mod tests {
    use super::{ActionAtTime, signed};

    #[test]
    fn what_has_not_changed_has_no_sign() {
        assert_eq!([0.0, -0.0, 0.25, -0.25].map(signed), ["0", "0", "+0.25", "−0.25"]);
    }

    /// A motion that began at rest has no action of which a part could be changed.
    #[test]
    fn of_no_action_there_is_no_part() {
        let moment = |action, height| ActionAtTime { time: 0.0, energy: 0.0, height, action };
        let (rest, later) = (moment(0.0, 0.0), moment(2.0, 1.0));
        assert_eq!(later.changes_since(&rest), None);
        assert_eq!(moment(3.0, 3.0).changes_since(&later), Some([0.5, 2.0]));
    }
}
