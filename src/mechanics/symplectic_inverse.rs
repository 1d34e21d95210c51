//! The inverse of a linear canonical map: M⁻¹ = −𝕁 Mᵀ 𝕁, of which nothing has to be divided or solved.
//!
//! In: an explicit map. Out: the old variables as functions of the new ones, if M does not depend on the old ones; they are
//! right if the map is canonical. Never here: whether it is.
//! Source: *The Principles of Dynamics*, § 3.3.

use std::collections::HashMap;

use super::canonical::PhaseMap;
use super::isolate::Solution;
use crate::expr::{Expr, Pool, Symbol};
use crate::num::Number;

impl PhaseMap {
    /// q = Σ (∂P/∂p)ᵀ (Q − Q₀) − (∂Q/∂p)ᵀ (P − P₀), p = Σ (∂Q/∂q)ᵀ (P − P₀) − (∂P/∂q)ᵀ (Q − Q₀), with Q₀ and P₀ the images of zero.
    pub(super) fn inverse_of_linear(&self, pool: &mut Pool) -> Option<Solution> {
        let n = self.old.len() / 2;
        let mut entries = self.by_old.iter().flatten();
        if !self.is_explicit() || entries.any(|&e| pool.depends_on_any(e, &self.old)) {
            return None;
        }
        // the relations are Q − Q(q, p, t), and those derived by the old variables −M
        let zeros: HashMap<Symbol, Expr> = self.old.iter().map(|&s| (s, Expr::ZERO)).collect();
        let shifted: Vec<Expr> =
            self.implicit.relations.iter().map(|&e| pool.substitute(e, &zeros)).collect();
        let conjugate = |k: usize| if k < n { n + k } else { k - n };
        let mut found = Vec::new();
        for (k, &old) in self.old.iter().enumerate() {
            let mut terms = Vec::new();
            for (j, &image) in shifted.iter().enumerate() {
                let entry = self.by_old[conjugate(j)][conjugate(k)];
                let same_half = (j < n) == (k < n);
                let sign = if same_half { Number::MINUS_ONE } else { Number::ONE };
                terms.push((sign, pool.mul(entry, image)));
            }
            let value = pool.linear(Number::ZERO, &terms);
            found.push((old, pool.simplify(value)));
        }
        Some(found)
    }
}
