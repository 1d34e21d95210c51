//! An inner product of one order as code.
//!
//! In: where both series lie, the order. Out: the sum, with the bits of
//! [`Analytic::inner_products`](crate::num::Analytic::inner_products). Never here: what it is for.
//!
//! Four sums are kept apart there; here they are the lanes of two vectors:
//!
//! ```text
//!   a_1 a_2 │ a_3 a_4 │ a_5 a_6 │ a_7 a_8 │ a_9      (s0 s1) and (s2 s3) take every second pair,
//!      ·    │    ·    │    ·    │    ·    │  ·       then (s0 + s2) + (s1 + s3) + rest
//!   s0  s1    s2  s3    s0  s1    s2  s3    rest
//! ```

use cranelift_codegen::ir::{InstBuilder, Value};

use super::emitter::Emitter;
use super::layout::Address;

/// The number of sums that are kept apart.
const APART: usize = 4;

impl Emitter<'_> {
    /// `Σ_{j=1}^{k−1} a_j b_{k−j}`, where `left` is the place of `a_0` and `right` that of the last order of `b`, whose
    /// series is read from its end.
    pub(super) fn inner_product(&mut self, left: Address, right: Address, k: usize) -> Value {
        let (left, right) = (left.plus(1), right.plus(self.layout.stride - k));
        let terms = k - 1;
        let whole = terms / APART * APART;
        let mut sums: [Option<Value>; 2] = [None; 2];
        for (i, j) in (0..whole).step_by(2).enumerate() {
            let (a, b) = (self.load_pair(left.plus(j)), self.load_pair(right.plus(j)));
            let product = self.builder.ins().fmul(a, b);
            let sum = &mut sums[i % 2];
            *sum = Some(match *sum {
                Some(sum) => self.builder.ins().fadd(sum, product),
                None => product,
            });
        }
        // begins with zero, so that the whole is never −0
        let mut rest = self.zero();
        for j in whole..terms {
            let (a, b) = (self.load(left.plus(j)), self.load(right.plus(j)));
            let product = self.builder.ins().fmul(a, b);
            rest = self.builder.ins().fadd(rest, product);
        }
        let [Some(even), Some(odd)] = sums else { return rest };
        let both = self.builder.ins().fadd(even, odd);
        let first = self.builder.ins().extractlane(both, 0_u8);
        let second = self.builder.ins().extractlane(both, 1_u8);
        let sum = self.builder.ins().fadd(first, second);
        self.builder.ins().fadd(sum, rest)
    }
}
