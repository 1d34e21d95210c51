//! Why a system is not separable, in words that are found when they are asked for: to name the
//! derivative of H that does not vanish, M has to be eliminated.
//!
//! In: equations that are not separable. Out: a sentence. Never here: what a separable system is
//! compiled to.

use std::sync::{Arc, OnceLock};

use crate::cancel::Cancel;
use crate::mechanics::Equations;

/// The reason why a system is not separable.
#[derive(Clone, Debug)]
pub(super) struct NotSeparable {
    equations: Arc<Equations>,
    why: OnceLock<String>,
}

impl NotSeparable {
    pub(super) fn of(equations: &Arc<Equations>) -> NotSeparable {
        NotSeparable { equations: Arc::clone(equations), why: OnceLock::new() }
    }

    pub(super) fn why(&self) -> &str {
        self.why.get_or_init(|| {
            let mut equations = Equations::clone(&self.equations);
            // the preparation of the system may have been stopped since it was complete
            equations.pool.set_cancel(Cancel::new());
            match equations.separable() {
                Err(why) => why.to_string(),
                Ok(_) => "the mass matrix changes with the coordinates".to_owned(),
            }
        })
    }
}
