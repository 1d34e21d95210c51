//! Checks the claims of a file against its law and its motion.
//!
//! In: a model and its equations. Out: a diagnostic for each false claim. Claims proved
//! symbolically are not integrated. Never here: how claims are written.

use super::brackets::false_brackets;
use super::conservation::{known, open_claims};
use super::dissipation;
use super::invariants::false_count;
use super::motion::ClaimedMotion;
use super::own_method;
use super::step::false_steps;
use super::uniqueness;
use crate::diagnostic::{Diagnostic, SourceRange};
use crate::mechanics::{self, Equations, HamiltonJacobi, StructureError};
use crate::model::Model;
use crate::system::System;

/// Returns a diagnostic for each false claim of a model, at its place.
pub fn false_claims(model: &Model, equations: &Equations) -> Vec<Diagnostic> {
    false_claims_followed(model, equations, &|_, _| {})
}

/// As [`false_claims`]; `follow` receives from time to time which claim the motion is followed for, and to what time it has come.
pub fn false_claims_followed(
    model: &Model,
    equations: &Equations,
    follow: &dyn Fn(&str, f64),
) -> Vec<Diagnostic> {
    let mut diagnostics = structure_diagnostics(model, equations);
    if !diagnostics.is_empty() {
        // without a Poisson structure the motion is meaningless
        return diagnostics;
    }
    diagnostics.extend(denied(model, equations));
    diagnostics.extend(false_brackets(model, equations));
    diagnostics.extend(false_count(model, equations));
    diagnostics.extend(incomplete(model, equations));
    let mut extended = equations.clone();
    let claims = open_claims(model, &mut extended);
    let equations = &extended;
    let system = match System::compile(model, equations, &[]) {
        Ok(system) => system,
        Err(why) => {
            diagnostics.push(Diagnostic::error(0..0, why.to_string()));
            return diagnostics;
        }
    };
    match ClaimedMotion::begin(model, equations, &system) {
        Ok(motion) => {
            diagnostics.extend(own_method::diagnostic(model, &system));
            diagnostics.extend(false_steps(model, equations, &system));
            diagnostics.extend(uniqueness::diagnostic(model, &system));
            diagnostics.extend(motion.unresolved_feature(model, equations));
            motion.follow((model, equations), claims, &mut diagnostics, follow);
        }
        Err(diagnostic) => diagnostics.push(diagnostic),
    }
    diagnostics.extend(dissipation::odd(model));
    for e in mechanics::widened(model, equations) {
        let message = format!(
            "`{}` is under a root that is squared away: the equations continue where it is below zero",
            equations.pool.text(e)
        );
        diagnostics.push(Diagnostic::warning(model.law_place.clone(), message));
    }
    for name in system.redundant() {
        let constraint = model.constraints.iter().find(|c| c.name == name);
        let message = format!("the constraint `{name}` depends at the start on those before it");
        let warning = Diagnostic::warning(
            constraint.map_or_else(|| model.law_place.clone(), |c| c.place.clone()),
            message,
        );
        diagnostics.push(warning.with_help("their multipliers are those of least norm"));
    }
    diagnostics
}

/// Returns the errors in the brackets and Casimirs of a file, with which it has no motion.
pub fn structure_diagnostics(model: &Model, equations: &Equations) -> Vec<Diagnostic> {
    let errors = mechanics::structure_errors(model, equations).into_iter();
    errors.filter_map(StructureError::diagnostic).collect()
}

/// A complete integral that is none.
fn incomplete(model: &Model, equations: &Equations) -> Option<Diagnostic> {
    let integral = model.complete_integral.as_ref()?;
    let found = HamiltonJacobi::of(model, &mut equations.clone())?;
    let message = format!("this is not a complete integral: {}", found.why?);
    let help = match found.residual {
        Some(residual) if residual > 0.0 => {
            format!("|H(q, ∂S/∂q, t) + ∂S/∂t| reaches {residual:.1e} at points near the start")
        }
        _ => "S(q, α, t) solves the equation with det ∂²S/∂q∂α ≠ 0".to_owned(),
    };
    Some(Diagnostic::error(integral.place.clone(), message).with_help(help))
}

/// Observables declared not conserved that are conserved.
fn denied(model: &Model, equations: &Equations) -> Vec<Diagnostic> {
    let wrong = |name: &str, place: &SourceRange| {
        let reason = &known(equations, name)?.reason;
        let message = format!("`{name}` is claimed not to be conserved, but it is");
        Some(Diagnostic::error(place.clone(), message).with_help(format!("why: {reason}")))
    };
    let denied = model.observables.iter().filter(|o| o.conserved == Some(false));
    denied.filter_map(|o| wrong(&o.name, &o.place)).collect()
}
