//! The operands of the inner products of a jet.
//!
//! In: the pairs of a schedule, the coefficients of all registers order by order. Out: all inner
//! products of one order, in one batch. Never here: what they are for.
//!
//! [`Analytic::SIDE`] pairs lie side by side in a group. The series of the right operands are stored
//! from their ends, so that both series of a product are read forwards:
//!
//! ```text
//!   left    a_0  a_1  a_2  …  a_{k−1}  …
//!   right   …  b_{k−1}  …  b_2  b_1  b_0        Σ_{j=1}^{k−1} a_j b_{k−j}: one stretch of each
//! ```

use crate::num::Analytic;
use crate::system::schedule::Pair;

/// The operands of all inner products, and the products of the current order.
#[derive(Clone, Debug)]
pub(super) struct Operands<R: Analytic> {
    /// The number of orders.
    stride: usize,
    /// The pairs, group by group. The last group may be filled up.
    pairs: Vec<Pair>,
    /// The series of each group, one after another.
    left: Vec<R::Lanes>,
    right: Vec<R::Lanes>,
    products: Vec<R>,
}

impl<R: Analytic> Operands<R> {
    /// Zeros, for these pairs and so many orders.
    pub(super) fn new(pairs: &[Pair], stride: usize) -> Operands<R> {
        let count = pairs.len().next_multiple_of(R::SIDE);
        let last = pairs.last().copied().into_iter().cycle();
        let series = vec![R::ZEROS; count / R::SIDE * stride];
        Operands {
            stride,
            pairs: pairs.iter().copied().chain(last).take(count).collect(),
            right: series.clone(),
            left: series,
            products: vec![R::ZERO; count],
        }
    }

    #[inline(always)]
    pub(super) fn slices(&mut self) -> OperandSlices<'_, R> {
        OperandSlices {
            stride: self.stride,
            pairs: &self.pairs,
            left: &mut self.left,
            right: &mut self.right,
            products: &mut self.products,
        }
    }
}

/// The operands, and the products of the current order, as slices.
pub(super) struct OperandSlices<'a, R: Analytic> {
    stride: usize,
    pairs: &'a [Pair],
    left: &'a mut [R::Lanes],
    right: &'a mut [R::Lanes],
    /// The inner products of the current order.
    pub(super) products: &'a mut [R],
}

impl<R: Analytic> OperandSlices<'_, R> {
    /// Computes all inner products of order `k`, which is above zero.
    #[inline(always)]
    pub(super) fn multiply<const FUSED: bool>(&mut self, k: usize) {
        let stride = self.stride;
        let (mut left, mut right) = (&*self.left, &*self.right);
        for products in self.products.chunks_exact_mut(R::SIDE) {
            // split off, since to divide a table into chunks of any length takes a division
            let (own_left, others_left) = left.split_at(stride);
            let (own_right, others_right) = right.split_at(stride);
            let (a, b) = (&own_left[1..k], &own_right[stride - k..stride - 1]);
            R::inner_products::<FUSED>(a, b, products);
            (left, right) = (others_left, others_right);
        }
    }

    /// Stores the coefficients of order `k` of all registers and slopes.
    #[inline(always)]
    pub(super) fn store(&mut self, now: &[R], k: usize) {
        let stride = self.stride;
        let (mut left, mut right) = (&mut *self.left, &mut *self.right);
        for pairs in self.pairs.chunks_exact(R::SIDE) {
            let (own_left, others_left) = left.split_at_mut(stride);
            let (own_right, others_right) = right.split_at_mut(stride);
            own_left[k] = R::side_by_side(|lane| now[pairs[lane].left as usize]);
            own_right[stride - 1 - k] = R::side_by_side(|lane| now[pairs[lane].right as usize]);
            (left, right) = (others_left, others_right);
        }
    }

    /// The same slices, to be given away for a while.
    #[inline(always)]
    pub(super) fn again(&mut self) -> OperandSlices<'_, R> {
        OperandSlices {
            stride: self.stride,
            pairs: self.pairs,
            left: &mut *self.left,
            right: &mut *self.right,
            products: &mut *self.products,
        }
    }
}
