//! The changes of the law on the way of a motion.
//!
//! In: what was changed, and by how much the energy jumped there. Out: the last change, and the jump of the change that is under
//! way. Never here: how the law is changed (`execute`).

use std::sync::Arc;

use super::last_change::LastChange;

#[derive(Debug, Default)]
pub(super) struct LawChanges {
    pub(super) last: Option<Arc<LastChange>>,
    /// The index of the parameter that is being changed, and the jump of the energy in all steps of that change so far.
    jump: Option<(usize, f64)>,
}

impl LawChanges {
    /// The next change is another one than the one before.
    pub(super) fn end_jump(&mut self) {
        self.jump = None;
    }

    /// Adds a jump of the energy, and returns that of all steps in which this parameter is being changed.
    pub(super) fn add_jump(&mut self, parameter: usize, jump: f64) -> f64 {
        let earlier = self.jump.filter(|(earlier, _)| *earlier == parameter);
        let sum = jump + earlier.map_or(0.0, |(_, sum)| sum);
        self.jump = Some((parameter, sum));
        sum
    }
}
