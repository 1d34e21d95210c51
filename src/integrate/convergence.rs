//! When the iteration for the stages of an implicit method has converged.
//!
//! It ends when no number of any stage moves less from one pass to the next, each by itself and all together: the rest is
//! rounding. Fewer passes would leave an error of the same sign at every step. A number may rest for a pass while what it
//! depends on still moves, as at a turning point; when it moves on, it no longer counts as at rest.
//!
//! In: the movements of a number. Out: whether it has come to rest. Never here: the iteration.
//!
//! Source: E. Hairer, R. McLachlan, A. Razakarivony, BIT Numerical Mathematics 48 (2008) 231.

/// The maximal number of passes.
pub(super) const PASSES: usize = 120;

/// A number counts as moving by rounding alone only if it moves by less than this part of its size.
pub(super) const SMALL: f64 = 1e-9;

/// After every so many passes a number also counts as moving by rounding alone if it moves by less than this multiple
/// of the rounding of its rate.
pub(super) const PASSES_PER_ROUND: usize = 12;
const _: () = assert!(PASSES.is_multiple_of(PASSES_PER_ROUND), "passes are made by so many");
pub(super) const ROUNDINGS: f64 = 64.0;

/// A number that has come to rest moves on if it moves by more than this multiple of what it moved
/// by then, or of its last digit.
pub(super) const RESUMES: f64 = 4.0;

/// The bound of a number that has not come to rest.
pub(super) const MOVING: f64 = -1.0;

/// The size of a number beside which its movements are judged. Numbers below the range of `f64` have digits of the same size
/// as those at its edge.
#[inline(always)]
pub(super) const fn size_of(magnitude: f64) -> f64 {
    magnitude.max(f64::MIN_POSITIVE)
}

/// The bound of a number after a pass in which it `moved`: the movement up to which it has come to rest, or [`MOVING`].
/// `before` is its movement two passes before, as positions and momenta may shrink alternately; infinite where there was
/// none. `small` is a movement that may be rounding, `size` that of the number.
#[expect(
    clippy::needless_bitwise_bool,
    reason = "choices without branches become vector instructions"
)]
#[inline(always)]
pub(super) fn bound_after(bound: f64, moved: f64, before: f64, small: f64, size: f64) -> f64 {
    let level = (moved >= before) & (moved <= small);
    let digit = f64::EPSILON * size;
    let most = RESUMES * if digit > moved { digit } else { moved };
    let settled = if (moved == 0.0) | level { most } else { MOVING };
    let rests = if moved > bound { MOVING } else { bound };
    if bound < 0.0 { settled } else { rests }
}
