//! Constraints: linear in the velocities, not trivial, each with a multiplier of its own name.

use std::collections::HashMap;

use toml::Spanned;

use super::ModelBuilder;
use super::names::report_twice;
use crate::diagnostic::Diagnostic;
use crate::expr::{Expr, Node, Pool, Rule, Symbol, Zero};
use crate::model::{Allowed, Constraint, Scope, multiplier_name};
use crate::preset::draft::{Draft, DraftConstraint, Formula};

/// The limit on the nodes visited to prove that all constraints of a file are linear. The nodes of
/// a constraint count once for each velocity in it.
const PROOF_LIMIT: usize = 4_000_000;

impl ModelBuilder<'_> {
    /// Declares the constraints' names, so that all expressions know their multipliers. The
    /// constraints themselves are read by [`ModelBuilder::constraints`].
    pub(super) fn multipliers(&mut self, draft: &Draft) {
        let mut taken: Vec<(String, &DraftConstraint)> = Vec::new();
        for written in &draft.constraints {
            let Some(name) = &written.name else { continue };
            let multiplier = multiplier_name(name.get_ref());
            let same = taken.iter().find(|(known, _)| *known == multiplier);
            let first = same.and_then(|(_, first)| first.name.as_ref());
            if let Some(first) = first.filter(|first| first.get_ref() == name.get_ref()) {
                report_twice(name, first.span(), "a constraint", self.diagnostics);
            } else if let Some(first) = first {
                let message =
                    format!("a constraint before this one has the multiplier `{multiplier}` too");
                let diagnostic =
                    Diagnostic::error(name.span(), message).with_help("rename one of them");
                self.diagnostics.push(diagnostic.with_also(first.span(), "the first one"));
            }
            taken.push((multiplier, written));
        }
        let only = draft.constraints.len() == 1;
        for written in &draft.constraints {
            let name = written.name.as_ref().map_or("", |name| name.get_ref());
            let pool = &mut self.model.pool;
            let mut constraint = Constraint::new(pool, name, Expr::ZERO, only);
            constraint.unit.clone_from(&written.unit);
            constraint.about.clone_from(&written.about);
            constraint.place = written.expression.as_ref().map_or(0..0, Spanned::span);
            self.model.constraints.push(constraint);
        }
    }

    /// Reads the constraints, expressions that must vanish. They are allowed only with a
    /// Lagrangian.
    pub(super) fn constraints(&mut self, written: &[DraftConstraint]) {
        if let Some(first) = written.first()
            && !self.model.is_lagrangian()
        {
            let law = if self.model.is_poisson() { "[poisson]" } else { "[hamiltonian]" };
            let message = format!("constraints belong to a Lagrangian; {law} cannot have them");
            let help = "give the law in [lagrangian], or leave the constrained coordinate out";
            self.diagnostics.push(Diagnostic::error(first.place.clone(), message).with_help(help));
            return;
        }
        let mut scope = Scope::new(&self.model, Allowed::Lagrangian, "a constraint");
        let mut walked = 0;
        for (index, constraint) in written.iter().enumerate() {
            let Some(formula) = &constraint.expression else { continue };
            let name = constraint.name.as_ref().map_or("", |name| name.get_ref());
            let called = format!("the constraint `{name}`");
            let Some(e) = self.formula(&mut scope, &called, formula) else { continue };
            walked += self.effort(e);
            if walked > PROOF_LIMIT {
                let message = "with this, the constraints of the file are too long to be proved \
                               linear in the velocities";
                self.error(formula.span(), message);
                return;
            }
            if let Some(e) = self.linear(e, &called, formula) {
                self.model.constraints[index].expression = e;
            }
        }
    }

    /// The number of nodes visited to prove that a constraint is linear.
    fn effort(&self, e: Expr) -> usize {
        let parts = self.model.pool.reachable(&[e]);
        let velocities: Vec<Symbol> = self.model.coordinates.iter().map(|c| c.velocity).collect();
        let present = parts.iter().filter_map(|&part| self.model.pool.as_symbol(part));
        let present = present.filter(|symbol| velocities.contains(symbol)).count();
        parts.len() * (1 + present)
    }

    /// Proves that a constraint has the form Σ A_α(q, t) q̇_α + A(q, t), and returns that form if
    /// it is not evident from the expression. Reports a constraint that is not linear or is
    /// trivial.
    fn linear(&mut self, e: Expr, called: &str, formula: &Formula) -> Option<Expr> {
        let coordinates = &self.model.coordinates;
        let positions: Vec<Symbol> = coordinates.iter().map(|c| c.position).collect();
        let velocities: Vec<Symbol> = coordinates.iter().map(|c| c.velocity).collect();
        let pool = &mut self.model.pool;
        let rest: HashMap<Symbol, Expr> = velocities.iter().map(|&v| (v, Expr::ZERO)).collect();
        // e = Σ A_α q̇_α + A is e|₀ + Σ q̇_α ∂e/∂q̇_α|₀, with 0 for q̇ = 0
        let present: Vec<Symbol> =
            velocities.iter().copied().filter(|&v| pool.depends(e, v)).collect();
        let mut rows: Vec<(Symbol, Expr)> = Vec::new();
        let mut terms = vec![pool.substitute(e, &rest)];
        let mut evident = true;
        for &velocity in &present {
            let slope = pool.derivative(e, velocity);
            evident &= !pool.depends_on_any(slope, &velocities);
            let slope = pool.substitute(slope, &rest);
            if pool.is_zero(slope) == Zero::Proved {
                evident = false;
                continue;
            }
            let rate = pool.variable(velocity);
            terms.push(pool.mul(slope, rate));
            rows.push((velocity, slope));
        }
        let form = pool.sum(&terms);
        let residue = pool.sub(e, form);
        let linear =
            !kinked(pool, e, &velocities) && (evident || pool.is_zero(residue) != Zero::No);
        if pool.is_full() {
            let message = "with this, the file's expressions grow beyond a million nodes";
            self.error(formula.span(), message);
            return None;
        }
        if !linear {
            self.not_linear(e, &present, called, formula);
            return None;
        }
        let form = if evident { e } else { form };
        let binds = if rows.is_empty() {
            let involved: Vec<Symbol> =
                positions.into_iter().filter(|&q| pool.depends(form, q)).collect();
            involved.into_iter().any(|q| {
                let slope = pool.derivative(form, q);
                pool.is_zero(slope) != Zero::Proved
            })
        } else {
            true
        };
        if !binds {
            let diagnostic = Diagnostic::error(
                formula.span(),
                format!("{called} contains no coordinate or velocity"),
            );
            self.diagnostics.push(
                diagnostic.with_help("what is to vanish must depend on coordinates or velocities"),
            );
            return None;
        }
        Some(form)
    }

    /// Reports the velocities in which a constraint is not linear.
    fn not_linear(&mut self, e: Expr, present: &[Symbol], called: &str, formula: &Formula) {
        let pool = &mut self.model.pool;
        let mut culprit = "in the velocities".to_owned();
        'all: for (i, &first) in present.iter().enumerate() {
            let slope = pool.derivative(e, first);
            for &second in &present[i..] {
                let curvature = pool.derivative(slope, second);
                if pool.is_zero(curvature) == Zero::No {
                    let name = |s| pool.symbol_info(s).name.clone();
                    culprit = if first == second {
                        format!("in the velocity `{}`", name(first))
                    } else {
                        let names = (name(first), name(second));
                        format!("in the velocities: it multiplies `{}` and `{}`", names.0, names.1)
                    };
                    break 'all;
                }
            }
        }
        let message = format!("{called} is not linear {culprit}");
        let help = "a constraint is a sum of velocities, each times a function of q and t, and of \
                    such a function";
        self.diagnostics.push(Diagnostic::error(formula.span(), message).with_help(help));
    }
}

/// Whether a function with a kink is applied to a velocity, in which case the derivatives do not
/// prove linearity.
fn kinked(pool: &Pool, e: Expr, velocities: &[Symbol]) -> bool {
    pool.reachable(&[e]).into_iter().any(|part| match pool.node(part) {
        Node::Call(function, _) => {
            matches!(function.row().rule, Rule::Branch(_)) && pool.depends_on_any(part, velocities)
        }
        _ => false,
    })
}
