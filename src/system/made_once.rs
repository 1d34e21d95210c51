//! What is made of a thing once it is wanted often enough, and shared by all who want it.
//!
//! In: how often it must be wanted, the way to make it. Out: what was made. Never here: what it is, so that the thing need not know
//! its makers.

#![cfg(target_arch = "x86_64")]

use std::any::Any;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

/// A place for it beside the thing that it is made of. A copy of the thing has nothing yet.
#[derive(Debug, Default)]
pub(super) struct MadeOnce {
    wanted: AtomicUsize,
    made: OnceLock<Arc<dyn Any + Send + Sync>>,
}

impl Clone for MadeOnce {
    fn clone(&self) -> MadeOnce {
        MadeOnce::default()
    }
}

impl MadeOnce {
    /// What was made, or is made now that it was wanted so often before; `None` where it was not, or where something of another
    /// type is there.
    pub(super) fn get<T: Send + Sync + 'static>(
        &self,
        threshold: usize,
        make: impl FnOnce() -> T,
    ) -> Option<Arc<T>> {
        if self.made.get().is_none() && self.wanted.fetch_add(1, Ordering::Relaxed) < threshold {
            return None;
        }
        let made = self.made.get_or_init(|| Arc::new(make()));
        Arc::clone(made).downcast().ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_made_once_after_it_was_wanted_so_often() {
        let place = MadeOnce::default();
        let wanted: Vec<Option<Arc<usize>>> = (0..5).map(|k| place.get(3, || k)).collect();
        assert_eq!(wanted, [None, None, None, Some(Arc::new(3)), Some(Arc::new(3))]);
        assert_eq!(place.get::<String>(3, String::new), None);
        assert_eq!(place.clone().get(3, || 9_usize), None);
    }
}
