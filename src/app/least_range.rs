//! The least range of a quantity in the pictures.
//!
//! In: nothing. Out: data. Never here: who sets it, or how pictures are drawn.

/// The least range of a quantity in the pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct LeastRange {
    /// The quantity as it is written.
    pub of: String,
    /// The range.
    pub range: [f64; 2],
    /// The channel of the quantity, if the system has one.
    pub channel: Option<usize>,
}
