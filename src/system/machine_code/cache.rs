//! The functions that were compiled for one program.
//!
//! In: what is wanted. Out: its function once it pays, for all threads. Never here: what it computes.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::compile::{Compiled, Extent, compile};
use crate::system::jet::JetPlan;

/// The series of so many orbits are computed before a function is compiled: short motions end before it pays.
const PATIENCE: usize = 64;

/// The functions for one program; clones share them.
#[derive(Clone, Debug, Default)]
pub(in crate::system) struct CodeCache {
    /// The number of series that were asked for.
    asked: Arc<AtomicUsize>,
    known: Arc<Mutex<Vec<Entry>>>,
}

/// The numbers of orders, exact ones second, the extent, and the function, unless there can be none.
type Entry = ([usize; 2], Extent, Option<Arc<Compiled>>);

impl CodeCache {
    /// An empty one.
    pub(in crate::system) fn new() -> CodeCache {
        CodeCache::default()
    }

    /// Whether functions pay, now that one more series is asked for, of so many orbits.
    pub(super) fn pays(&self, orbits: usize) -> bool {
        self.asked.fetch_add(orbits, Ordering::Relaxed) + orbits >= PATIENCE
    }

    /// The function for a jet of this program, and for an exact one of its lowest orders; `None` if there is none.
    pub(super) fn function(
        &self,
        plan: &JetPlan<'_>,
        exact: Option<&JetPlan<'_>>,
        extent: Extent,
    ) -> Option<Arc<Compiled>> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let orders = [plan.stride, exact.map_or(0, |exact| exact.stride)];
        let same = |entry: &&Entry| (entry.0, entry.1) == (orders, extent);
        if let Some((.., function)) = known.iter().find(same) {
            return function.clone();
        }
        let function = compile(plan, exact, extent).ok().map(Arc::new);
        known.push((orders, extent, function.clone()));
        function
    }
}
