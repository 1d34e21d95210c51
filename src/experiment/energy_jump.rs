//! The jump of the energy where a parameter is changed, in one step or in several.
//!
//! In: the jump of a step. Out: that of all steps that belong together. Never here: the energy.

/// Steps of one parameter within this time of a running motion are one change, in seconds of the screen.
const TOGETHER: f64 = 0.8;

/// By how much the energy jumped where a parameter was changed.
#[derive(Clone, Copy, Debug)]
pub(super) struct EnergyJump {
    /// The index of the parameter.
    pub(super) parameter: usize,
    /// The reading of the motion's clock at the last step.
    pub(super) clock: f64,
    /// The sum of the jumps.
    pub(super) by: f64,
}

impl EnergyJump {
    /// The jump with the steps before this one, if they belong to it. `second` is the time that the motion takes in a
    /// second of the screen.
    pub(super) fn after(self, earlier: &Self, second: f64) -> Self {
        let is_one = earlier.parameter == self.parameter
            && (self.clock - earlier.clock).abs() <= TOGETHER * second;
        if is_one { Self { by: self.by + earlier.by, ..self } } else { self }
    }
}
