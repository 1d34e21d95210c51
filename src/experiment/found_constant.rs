//! A constant of the motion that was found while the motion runs, to be followed by a gauge.
//!
//! In: its formula as text. Out: plain data for a command. Never here: how it was found.

/// A constant of the motion that was found.
#[derive(Clone, PartialEq, Debug)]
pub struct FoundConstant {
    /// The gauge's name: `I1`.
    pub name: String,
    /// The name as shown: `I₁`.
    pub shown: String,
    /// The formula, in the syntax of files.
    pub expression: String,
    /// Why it is constant: *found at degree 2, proved*.
    pub reason: String,
    /// Whether that is proved, and not only seen at points.
    pub proved: bool,
}
