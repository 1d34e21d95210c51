//! How the Taylor coefficients of a function follow from those of its arguments, order by order.
//!
//! Every elementary function y(u) and its companion w (cos for sin, 1 + u² for atan, …) satisfy
//! equations that are bilinear in the series of y, w and u and in their slopes. At order k such an
//! equation reads
//!
//! `divisor · f_k = direct + Σ ± (left ∗ right)_k`,
//!
//! where `∗` is the convolution of two series, or of the slope of the first with the second, and
//! what it has of f_k itself is what the divisor stands for. All series are normalised: `u_k =
//! u⁽ᵏ⁾/k!`. The evaluators of all precisions read the same rows.
//!
//! Source: À. Jorba, M. Zou, Experimental Mathematics 14 (2005) 99, section 2.

/// A series in a recurrence.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum SeriesOperand {
    /// The first argument.
    First,
    /// The second argument.
    Second,
    /// The function.
    Value,
    /// The series computed along with it, as the cosine along with a sine.
    Companion,
}

pub(super) const FIRST: SeriesOperand = SeriesOperand::First;
pub(super) const SECOND: SeriesOperand = SeriesOperand::Second;
pub(super) const VALUE: SeriesOperand = SeriesOperand::Value;
pub(super) const COMPANION: SeriesOperand = SeriesOperand::Companion;

/// `Σ_j left_j right_{k−j}`, or with the slope of the left one `Σ_j j left_j right_{k−j}`.
#[derive(Clone, Copy, Debug)]
pub struct Convolution {
    /// 1 or −1.
    pub sign: f64,
    /// Whether it is the slope of the left series that enters.
    pub of_slope: bool,
    /// The left series.
    pub left: SeriesOperand,
    /// The right series.
    pub right: SeriesOperand,
}

impl Convolution {
    pub(super) const fn of(sign: f64, left: SeriesOperand, right: SeriesOperand) -> Convolution {
        Convolution { sign, of_slope: false, left, right }
    }

    pub(super) const fn of_slope(
        sign: f64,
        left: SeriesOperand,
        right: SeriesOperand,
    ) -> Convolution {
        Convolution { sign, of_slope: true, left, right }
    }
}

/// What the k-th coefficient is divided by.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Divisor {
    /// 1.
    One,
    /// k.
    Order,
    /// k times the value of a series.
    OrderTimes(SeriesOperand),
    /// Twice the value of a series.
    Twice(SeriesOperand),
}

/// The recurrence of one series f.
#[derive(Clone, Copy, Debug)]
pub struct BilinearEquation {
    /// `± k u_k` of a series.
    pub slope: Option<(f64, SeriesOperand)>,
    /// The convolutions; what they contain of f_k is left out.
    pub sums: &'static [Convolution],
    /// What the k-th coefficient is divided by at last.
    pub divisor: Divisor,
}

impl BilinearEquation {
    pub(super) const NONE: BilinearEquation =
        BilinearEquation { slope: None, sums: &[], divisor: Divisor::One };

    /// f = Σ left · right.
    pub(super) const fn sum(sums: &'static [Convolution]) -> BilinearEquation {
        BilinearEquation { slope: None, sums, divisor: Divisor::One }
    }

    /// f′ = Σ left′ · right.
    pub(super) const fn over_order(sums: &'static [Convolution]) -> BilinearEquation {
        BilinearEquation { slope: None, sums, divisor: Divisor::Order }
    }

    /// f′ g = ± u′.
    pub(super) const fn slope(
        sign: f64,
        of: SeriesOperand,
        sums: &'static [Convolution],
        divisor: SeriesOperand,
    ) -> BilinearEquation {
        BilinearEquation { slope: Some((sign, of)), sums, divisor: Divisor::OrderTimes(divisor) }
    }
}

/// The recurrences of a function and of its companion.
#[derive(Clone, Copy, Debug)]
pub struct Recurrence {
    /// Whether the companion's coefficient is the first of the two to be computed.
    pub companion_first: bool,
    /// That of the function.
    pub value: BilinearEquation,
    /// The equation for the series beside it, where the function needs one.
    pub companion: Option<BilinearEquation>,
}
