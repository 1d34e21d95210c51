//! Parameters of a law that change with the time by a ramp: the law is another one before, on the way and after, so that it has
//! no one formula of which an ansatz could be asked.
//!
//! In: a model. Out: why it is not searched. Never here: searches.

use super::units::Unsupported;
use crate::expr::{Expr, FunctionId, Node};
use crate::model::Model;

/// Refuses a law with parameters that a ramp changes, which it names.
pub(super) fn refuse(model: &Model) -> Result<(), Unsupported> {
    let pool = &model.pool;
    // a ramp stands still before and after, by what is in no other formula of the same times
    let bounds = |of: &[Expr]| -> Vec<Expr> {
        let all = pool.reachable(of).into_iter();
        all.filter(|&e| matches!(pool.node(e), Node::Call(FunctionId::Max | FunctionId::Min, _)))
            .collect()
    };
    let law = [model.mechanics.function().1, model.mechanics.dissipation()];
    let constraints = model.constraints.iter().map(|constraint| constraint.expression);
    let law: Vec<Expr> = law
        .into_iter()
        .chain(model.mechanics.forces().iter().copied())
        .chain(constraints)
        .collect();
    let law = bounds(&law);
    let ramps = model.ramped.functions();
    let mut names: Vec<&str> = ramps
        .filter(|&(_, e)| bounds(&[e]).iter().any(|bound| law.contains(bound)))
        .map(|(symbol, _)| pool.symbol_info(symbol).unicode.as_str())
        .collect();
    names.sort_unstable();
    if names.is_empty() {
        return Ok(());
    }
    Err(Unsupported(format!(
        "no search is made of a law in which a ramp changes {}",
        names.join(", ")
    )))
}
