//! Checks the claim of a file on its constants of the motion: `invariants = N` of `[expect]`.
//!
//! In: a model and its equations. Out: a diagnostic if a search finds another number. Never here: the search.

use crate::diagnostic::Diagnostic;
use crate::integrability::{Limits, invariants};
use crate::mechanics::{Equations, derive};
use crate::model::Model;

/// Returns a diagnostic if the claim is false, or cannot be checked.
pub(super) fn false_count(model: &Model, equations: &Equations) -> Option<Diagnostic> {
    let claim = model.expect.invariants.as_ref()?;
    let cancel = equations.pool.cancel().clone();
    let mut named = model.clone();
    let derived = if named.name_literals() { derive(&named).ok() } else { None };
    let (model, mut equations) = match derived {
        Some(derived) => (&named, derived),
        None => (model, equations.clone()),
    };
    equations.pool.set_cancel(cancel.clone());
    let is_over = || cancel.is_cancelled();
    let limits = Limits { degree: Some(claim.degree), is_over: &is_over };
    let found = match invariants(model, &mut equations, &limits) {
        Ok(found) => found,
        Err(why) => {
            let message = format!("the constants of the motion cannot be counted: {why}");
            return Some(Diagnostic::error(claim.place.clone(), message));
        }
    };
    let count = found.independent();
    if count == claim.is {
        return None;
    }
    let message = format!(
        "up to degree {} there are {count} independent constants of the motion, not {}",
        claim.degree, claim.is
    );
    Some(Diagnostic::error(claim.place.clone(), message))
}
