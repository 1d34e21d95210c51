//! The functions that were compiled for one program.
//!
//! In: what is wanted. Out: its function once it pays, for all threads. Never here: what it computes.

use std::sync::{Arc, Mutex, PoisonError};

use super::compile::{Compiled, SeriesExtent, compile};
use crate::system::jet::JetPlan;

/// A function is compiled when it is wanted for so many orbits: short motions end before it pays. To compile all orders of a series
/// takes as many instructions as the code then spares in 100 to 300 of them; values alone, whose code is far shorter, pay sooner.
const COMPILE_THRESHOLD: usize = 192;

/// Or as soon as so many are expected to follow; their number is not known better than by a factor of two.
const EXPECTED_THRESHOLD: f64 = 300.0;

/// So many series are wanted before it is asked what is expected: the first steps of a motion may be short, and say nothing of
/// those that follow.
const FIRST_SERIES: usize = 8;

/// The functions for one program; clones share them.
#[derive(Clone, Debug, Default)]
pub(in crate::system) struct CodeCache {
    known: Arc<Mutex<Vec<CacheEntry>>>,
}

#[derive(Clone, Debug)]
pub(super) enum Availability {
    /// It does not pay yet.
    NotYet,
    /// There can be none.
    Never,
    Compiled(Arc<Compiled>),
}

/// What is wanted of one kind.
#[derive(Debug)]
struct CacheEntry {
    /// The numbers of orders, exact ones second.
    orders: [usize; 2],
    extent: SeriesExtent,
    wanted: usize,
    code: Availability,
}

impl CodeCache {
    /// An empty one.
    pub(in crate::system) fn new() -> CodeCache {
        CodeCache::default()
    }

    /// The function for a jet of this program, and for an exact one of its lowest orders, now that one more series is wanted and
    /// so many are expected to follow.
    pub(super) fn function(
        &self,
        plan: &JetPlan<'_>,
        exact: Option<&JetPlan<'_>>,
        extent: SeriesExtent,
        expected: f64,
    ) -> Availability {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let orders = [plan.stride, exact.map_or(0, |exact| exact.stride)];
        let same = |entry: &CacheEntry| (entry.orders, entry.extent) == (orders, extent);
        let place = known.iter().position(same).unwrap_or_else(|| {
            known.push(CacheEntry { orders, extent, wanted: 0, code: Availability::NotYet });
            known.len() - 1
        });
        let entry = &mut known[place];
        entry.wanted += extent.orbits.numbers();
        let expected = entry.wanted > FIRST_SERIES && expected >= EXPECTED_THRESHOLD;
        let pays = expected || entry.wanted >= COMPILE_THRESHOLD;
        if matches!(entry.code, Availability::NotYet) && pays {
            let compiled = compile(plan, exact, extent).map(Arc::new);
            entry.code = compiled.map_or(Availability::Never, Availability::Compiled);
        }
        entry.code.clone()
    }
}
