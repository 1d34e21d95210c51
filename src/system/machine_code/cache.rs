//! The functions that were compiled for one program.
//!
//! In: what is wanted. Out: its function, compiled when it is wanted first, for all threads. Never here: when it pays.

use std::sync::{Arc, Mutex, PoisonError};

use super::emitter::{self, Extent};
use super::function::CompiledFunction;
use crate::system::jet::JetPlan;

/// The functions for one program; clones share them.
#[derive(Clone, Debug, Default)]
pub(in crate::system) struct CodeCache {
    known: Arc<Mutex<Vec<Entry>>>,
}

/// The number of orders, the extent, and the function, unless there can be none.
type Entry = (usize, Extent, Option<Arc<CompiledFunction>>);

impl CodeCache {
    /// An empty one.
    pub(in crate::system) fn new() -> CodeCache {
        CodeCache::default()
    }

    /// The function for a jet of this program; `None` if there is none.
    pub(super) fn function(
        &self,
        plan: &JetPlan<'_>,
        extent: Extent,
    ) -> Option<Arc<CompiledFunction>> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let same = |entry: &&Entry| (entry.0, entry.1) == (plan.stride, extent);
        if let Some((.., function)) = known.iter().find(same) {
            return function.clone();
        }
        let function = emitter::compile(plan, extent).ok().map(Arc::new);
        known.push((plan.stride, extent, function.clone()));
        function
    }
}
