//! The verdict in a line: integrable, superintegrable, or what little was found, and how far nothing else exists.
//!
//! In: what a search found, and its relations. Out: a line. Never here: the search.

use super::invariants::{Invariants, Proof};
use super::verdict::Relations;

/// The verdict in a line.
pub fn summary(invariants: &Invariants, relations: &Relations) -> String {
    let Some(n) = relations.freedoms.filter(|_| !invariants.driven) else {
        return relations.verdict.clone();
    };
    let unproved = invariants.found.iter().any(|c| c.proof == Proof::Unproved);
    let caution = if unproved { " (not all of them proved)" } else { "" };
    let total = invariants.independent().saturating_sub(relations.casimirs);
    let commuting = relations.commuting().saturating_sub(relations.casimirs);
    let plural = if n == 1 { "invariant" } else { "invariants" };
    if n > 0 && commuting >= n {
        if total > n {
            let closed = if total + 1 >= 2 * n { ", every bounded orbit closes" } else { "" };
            return format!(
                "superintegrable: {total} independent invariants, {n} in involution{closed}{caution}"
            );
        }
        let alone = if n == 1 { "" } else { " in involution" };
        return format!("integrable: {n} {plural}{alone}{caution}");
    }
    let known = invariants.known.iter().zip(&invariants.known_independent);
    let names: Vec<&str> = known
        .filter(|(_, independent)| **independent)
        .map(|(k, _)| if k.name == "energy" { "E" } else { k.name.as_str() })
        .collect();
    match invariants.none_up_to {
        Some(degree) if invariants.found.is_empty() && !names.is_empty() => {
            format!("only {} found, up to degree {degree} (proved)", names.join(", "))
        }
        _ => relations.verdict.clone(),
    }
}
