//! The jump of the energy where a parameter is changed.
//!
//! In: nothing. Out: [`EnergyJump`]. Never here: the energy, or which steps of a parameter are one change.

/// By how much the energy jumped where a parameter was changed, in all steps of that change so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct EnergyJump {
    /// The index of the parameter.
    pub(super) parameter: usize,
    /// The sum of the jumps.
    pub(super) by: f64,
}
