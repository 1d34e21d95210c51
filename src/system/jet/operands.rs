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
    groups: Vec<OperandGroup<R>>,
    products: Vec<R>,
}

/// Pairs side by side. The last ones may be filled up.
#[derive(Clone, Debug)]
struct OperandGroup<R: Analytic> {
    pairs: Vec<Pair>,
    left: Vec<R::Lanes>,
    right: Vec<R::Lanes>,
}

impl<R: Analytic> Operands<R> {
    /// Zeros, for these pairs and so many orders.
    pub(super) fn new(pairs: &[Pair], stride: usize) -> Operands<R> {
        let group = |pairs: &[Pair]| {
            let last = pairs.last().copied().into_iter().cycle();
            OperandGroup {
                pairs: pairs.iter().copied().chain(last).take(R::SIDE).collect(),
                left: vec![R::ZEROS; stride],
                right: vec![R::ZEROS; stride],
            }
        };
        let groups: Vec<OperandGroup<R>> = pairs.chunks(R::SIDE).map(group).collect();
        let products = vec![R::ZERO; groups.len() * R::SIDE];
        Operands { stride, groups, products }
    }

    /// Computes all inner products of order `k`, which is above zero.
    #[inline(always)]
    pub(super) fn multiply<const FUSED: bool>(&mut self, k: usize) {
        let room = self.stride;
        let places = self.products.chunks_exact_mut(R::SIDE);
        for (group, products) in self.groups.iter().zip(places) {
            let (left, right) = (&group.left[1..k], &group.right[room - k..room - 1]);
            R::inner_products::<FUSED>(left, right, products);
        }
    }

    /// Stores the coefficients of order `k` of all registers and slopes.
    #[inline(always)]
    pub(super) fn store(&mut self, now: &[R], k: usize) {
        let last = self.stride - 1;
        for OperandGroup { pairs, left, right } in &mut self.groups {
            let pairs = &pairs[..R::SIDE];
            left[k] = R::side_by_side(|lane| now[pairs[lane].left as usize]);
            right[last - k] = R::side_by_side(|lane| now[pairs[lane].right as usize]);
        }
    }

    /// The inner products of the current order.
    #[inline(always)]
    pub(super) fn products(&self) -> &[R] {
        &self.products
    }
}
