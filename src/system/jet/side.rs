//! On which side of a kink a series is built.

/// The branch that functions with a kink take while a series is built.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Side {
    /// The branch where the switch is positive.
    Positive,
    /// The branch where the switch is negative.
    Negative,
    /// Between the branches: their mean, plus half their difference times a weight in [−1, 1] that
    /// keeps the switch at zero.
    Between,
    /// On the surface for a while, whatever the weight, as the switch of sign(max(0, x)) is for x < 0: the mean of the branches.
    Level,
}
