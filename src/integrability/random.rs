//! Random residues, the same for the same seed.
//!
//! In: a seed. Out: numbers, residues. Never here: the points at which something is evaluated.
//! Source: `SplitMix64`, G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014.

use crate::num::{PrimeField, Residue};

#[derive(Clone, Debug)]
pub(super) struct Random(u64);

impl Random {
    pub(super) fn new(seed: u64) -> Random {
        Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0xD1B5_4A32_D192_ED03)
    }

    pub(super) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        x ^ (x >> 31)
    }

    pub(super) fn residue(&mut self, field: &PrimeField) -> Residue {
        field.residue(self.next())
    }
}
