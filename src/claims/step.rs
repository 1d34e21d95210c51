//! Checks whether a transformation is one step of a method: `[expect] steps`.
//!
//! In: a model, its equations, its system. Out: a diagnostic for each claim that is false, or cannot be checked. Never here:
//! how a step is compared (`dynamics`).

use crate::diagnostic::{Diagnostic, nearest};
use crate::dynamics::MethodStep;
use crate::integrate::{METHODS, Stepping};
use crate::mechanics::{Equations, Valuation};
use crate::model::{ExpectedStep, Model};
use crate::system::System;

pub(super) fn false_steps(
    model: &Model,
    equations: &Equations,
    system: &System,
) -> Vec<Diagnostic> {
    let all = model.expect.steps.iter();
    all.filter_map(|claim| diagnostic(model, equations, system, claim)).collect()
}

fn diagnostic(
    model: &Model,
    equations: &Equations,
    system: &System,
    claim: &ExpectedStep,
) -> Option<Diagnostic> {
    let ExpectedStep { transformation, method, within, .. } = claim;
    let message = |what: &str| format!("`{transformation}` {what} a step of `{method}`");
    let error = |what: &str, help: String| {
        Some(Diagnostic::error(claim.place.clone(), message(what)).with_help(help))
    };
    let fixed = || METHODS.iter().filter(|method| method.stepping == Stepping::Fixed);
    let Some(known) = fixed().find(|known| known.name == method) else {
        let names: Vec<&str> = fixed().map(|method| method.name).collect();
        let help = match nearest(method, names.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("fixed-step methods are {}", names.join(", ")),
        };
        return error("cannot be compared with", help);
    };
    let parameters = Valuation::of_parameters(model, &model.parameter_values());
    let step = parameters.value(&model.pool, claim.step);
    if !(step.is_finite() && step > 0.0) {
        return error("cannot be compared with", "its step is not above 0".to_owned());
    }
    let mut equations = equations.clone();
    match MethodStep::beside((model, &mut equations, system), transformation, (known, step)) {
        Err(why) => error("cannot be compared with", why.to_string()),
        // what is not a number is within nothing
        Ok(found) if found.image <= *within && found.derivative <= *within => None,
        Ok(found) => error(
            "is not",
            format!(
                "near the start their images lie {:.1e} apart, and their derivatives {:.1e}",
                found.image, found.derivative
            ),
        ),
    }
}
