//! Blocks of dots, at whose corners the box of a ball begins and ends.
//!
//! In: a box. Out: one of whole blocks. Never here: which dots of it are covered.

/// The least number of blocks across a box that ends where they do.
const LEAST: f64 = 4.0;

/// The number of dots in a block: columns, rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blocks(pub(super) [f64; 2]);

impl Blocks {
    /// The corners of a box moved to the nearest corners of blocks, so that a ball in it is as round at its top as at its bottom, with
    /// no bump of half a block. The size of the box depends on that of the ball alone, so that it does not change while the ball
    /// moves. A small box stays as it is.
    pub(super) fn around(self, low: [f64; 2], high: [f64; 2]) -> [[f64; 2]; 2] {
        let Blocks(block) = self;
        let sizes = [0, 1].map(|k| ((high[k] - low[k]) / block[k]).round());
        if sizes.iter().any(|size| size.is_nan() || *size < LEAST) {
            return [low, high];
        }
        let low = [0, 1].map(|k| (low[k] / block[k]).round() * block[k]);
        [low, [0, 1].map(|k| low[k] + sizes[k] * block[k])]
    }
}
