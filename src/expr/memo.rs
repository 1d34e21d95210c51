//! Results of passes over expressions, remembered by handle.
//!
//! In: handles. Out: handles. Never here: what a pass does.

use super::node::Expr;

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Pass {
    Simplify,
    /// Terms combined and factors taken out, as the expression stands.
    Shorten,
    /// Sines and cosines of sums opened.
    OpenAngles,
    /// Multiplied out as far as a trial goes.
    ExpandInTrial,
    /// Multiplied out as far as a proof goes.
    ExpandInProof,
}

const PASSES: usize = 5;

/// The mark of a node without a result.
const UNKNOWN: u32 = u32::MAX;

/// For each pass the result of every node, as far as it is known.
#[derive(Clone, Debug, Default)]
pub(super) struct Memo {
    results: [Vec<u32>; PASSES],
}

impl Memo {
    pub(super) fn get(&self, pass: Pass, e: Expr) -> Option<Expr> {
        let known = *self.results[pass as usize].get(e.index())?;
        (known != UNKNOWN).then_some(Expr(known))
    }

    pub(super) fn insert(&mut self, pass: Pass, e: Expr, result: Expr) {
        let results = &mut self.results[pass as usize];
        if results.len() <= e.index() {
            results.resize(e.index() + 1, UNKNOWN);
        }
        results[e.index()] = result.0;
    }
}
