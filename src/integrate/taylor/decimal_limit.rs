//! The limit of a step as the decimal number that it is written as.
//!
//! In: a limit. Out: the number in double-double, computed once while the limit is the same. Never here: the time to go.

use crate::num::DoubleDouble;

/// The last limit, and the decimal number it is written as.
#[derive(Clone, Debug)]
pub(super) struct DecimalLimit {
    pub(super) rounded: f64,
    exact: DoubleDouble,
}

impl DecimalLimit {
    pub(super) const NONE: DecimalLimit =
        DecimalLimit { rounded: f64::NAN, exact: DoubleDouble::ZERO };

    #[inline]
    pub(super) fn exact(&mut self, limit: f64) -> DoubleDouble {
        if self.rounded != limit {
            *self = DecimalLimit { rounded: limit, exact: DoubleDouble::from_decimal(limit) };
        }
        self.exact
    }
}
