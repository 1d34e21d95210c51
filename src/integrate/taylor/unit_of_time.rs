//! The unit of time of the next series: the size of the step before it.
//!
//! In: the size of each step. Out: the scale of the series. Never here: the series.

#[derive(Clone, Debug, Default)]
pub(super) struct UnitOfTime {
    /// The size of the last step, until the next series takes its unit from it. The current series still represents the states
    /// inside that step.
    pub(super) taken: Option<f64>,
    /// Whether the unit in use was determined for this motion.
    is_known: bool,
}

impl UnitOfTime {
    /// The scale of the next series, with `left` to go, after one of this scale.
    #[inline]
    pub(super) fn next(&mut self, scale: f64, left: f64) -> f64 {
        let scale = if self.is_known { scale } else { left };
        let step = self.taken.take().unwrap_or(scale).abs();
        self.is_known = true;
        step.clamp(1e-300, 1e300).copysign(left)
    }

    /// Takes the unit from a step of this size, where the series allowed `allowed` of the time that was `left`.
    #[inline]
    pub(super) fn take(&mut self, size: f64, allowed: f64, left: f64) {
        self.taken = Some(allowed.min(left.abs()).min(4.0 * size));
    }
}
