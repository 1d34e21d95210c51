//! Points at which identities are tested. They are reproducible and different for each symbol,
//! first of ordinary size and then of increasingly different magnitudes.

use super::symbol::Symbol;
use crate::num::math;

/// The number of points of ordinary size.
const ORDINARY: u64 = 24;

/// The largest spread of the other points in powers of ten, in turn.
const SPANS: [f64; 5] = [1.5, 3.0, 6.0, 12.0, 20.0];

/// A value for a symbol at the n-th point. The first points lie in (0.1, 2.1), so that logarithms,
/// roots and quotients are mostly defined, with other signs at every third point; later points
/// spread over all magnitudes.
pub(super) fn sample(symbol: Symbol, point: u64) -> f64 {
    let mut x = (symbol.index() as u64 + 1)
        .wrapping_mul(0x9E37_79B9_7F4A_7C15)
        .wrapping_add((point + 1).wrapping_mul(0xD1B5_4A32_D192_ED03));
    x ^= x >> 30;
    x = x.wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x ^= x >> 27;
    x = x.wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^= x >> 31;
    let unit = (x >> 11) as f64 / (1_u64 << 53) as f64;
    let turned = x & 1 == 1;
    if point < ORDINARY {
        let value = 0.1 + 2.0 * unit;
        return if point % 3 == 2 && turned { -value } else { value };
    }
    let span = SPANS[(point % SPANS.len() as u64) as usize];
    let value = math::powf(10.0, span * (2.0 * unit - 1.0));
    if point % 2 == 1 && turned { -value } else { value }
}
