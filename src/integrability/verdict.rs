//! What constants of the motion are to each other: their brackets, which commute, and what follows for the motion.
//!
//! In: what a search found. Out: a table of brackets and a verdict. Never here: the search.
//! Source: V. I. Arnold, *Mathematical Methods of Classical Mechanics*, § 49 (Liouville's theorem).

use std::collections::HashMap;

use super::invariants::{Invariants, Proof};
use super::involution::{self, Commuting, Given};
use super::stand_in;
use super::vanishing::vanishes;
use crate::expr::{Expr, Symbol, Zero};
use crate::mechanics::{Equations, bracket};
use crate::model::Model;

/// The brackets among the constants of the motion, known first, then found.
#[derive(Clone, Debug)]
pub struct Relations {
    /// \[I_i, I_j\], 0 where that is proved; `None` where brackets are not defined.
    pub brackets: Vec<Vec<Option<Expr>>>,
    /// A largest set of independent constants that commute with each other, as indices.
    pub in_involution: Vec<usize>,
    /// Constants made of the others that commute with those and among themselves, and are independent of them.
    pub completing: Vec<Commuting>,
    /// The number of degrees of freedom: half the dimension, less Casimirs.
    pub freedoms: Option<usize>,
    /// The number of independent Casimirs among the constants.
    pub casimirs: usize,
    /// The verdict in words.
    pub verdict: String,
}

/// The brackets of all constants, and the verdict. Only of motions that follow from H alone.
pub fn relations(
    model: &Model,
    equations: &mut Equations,
    invariants: &Invariants,
    hamiltonian: bool,
) -> Relations {
    let known = invariants.known.iter().map(|k| (k.expression, k.here));
    let found = invariants.found.iter().map(|c| (c.expression, c.here));
    let functions: Vec<(Expr, Expr)> = known.chain(found).collect();
    let independent: Vec<bool> = invariants
        .known_independent
        .iter()
        .copied()
        .chain(invariants.found.iter().map(|c| c.independent))
        .collect();
    let values: HashMap<Symbol, Expr> = stand_in::constants(model, equations)
        .into_iter()
        .map(|(s, n)| (s, equations.pool.number(n)))
        .collect();
    let positions: Vec<Symbol> = if model.is_poisson() {
        Vec::new()
    } else {
        equations.coordinates.iter().map(|c| c.position).collect()
    };
    let n = functions.len();
    let mut brackets: Vec<Vec<Option<Expr>>> = vec![vec![None; n]; n];
    // that each is constant is proved, and without time this is that it commutes with H
    let energy = invariants.known.iter().position(|k| k.name == "energy");
    let proofs = invariants.found.iter().map(|c| c.proof != Proof::Unproved);
    let proved: Vec<bool> = vec![true; invariants.known.len()].into_iter().chain(proofs).collect();
    let is_given = |i: usize, j: usize| {
        !invariants.driven && (energy == Some(i) && proved[j] || energy == Some(j) && proved[i])
    };
    if hamiltonian {
        for i in 0..n {
            brackets[i][i] = Some(Expr::ZERO);
            for j in i + 1..n {
                if is_given(i, j) {
                    brackets[i][j] = Some(Expr::ZERO);
                    brackets[j][i] = Some(Expr::ZERO);
                    continue;
                }
                let Ok(mut e) = bracket(model, equations, functions[i].0, functions[j].0) else {
                    continue;
                };
                let pool = &mut equations.pool;
                if e != Expr::ZERO {
                    let here = pool.substitute(e, &values);
                    if vanishes(pool, &positions, here) {
                        e = Expr::ZERO;
                    }
                }
                brackets[i][j] = Some(e);
                brackets[j][i] = Some(pool.neg(e));
            }
        }
    }
    let commute = |i: usize, j: usize| brackets[i][j] == Some(Expr::ZERO);
    let in_involution = if hamiltonian { largest(&independent, &commute) } else { Vec::new() };
    let casimirs = (0..n)
        .filter(|&i| model.is_poisson() && independent.get(i) == Some(&true))
        .filter(|&i| {
            // at the parameters' values, or for all of them, as the brackets are written
            let (named, here) = functions[i];
            is_casimir(model, equations, here) || is_casimir(model, equations, named)
        })
        .count();
    let freedoms =
        hamiltonian.then(|| (invariants.dimension - casimirs.min(invariants.dimension)) / 2);
    let completing = match freedoms {
        Some(n) if !invariants.driven => {
            let given = Given { functions: &functions, brackets: &brackets, proved: &proved };
            involution::completed(model, equations, &given, &in_involution, n + casimirs)
        }
        _ => Vec::new(),
    };
    let commuting = in_involution.len() + completing.len();
    let mut verdict = verdict(invariants, freedoms, casimirs, commuting);
    if !model.impulses.is_empty() {
        verdict.push_str(" (between impulses)");
    }
    Relations { brackets, in_involution, completing, freedoms, casimirs, verdict }
}

impl Relations {
    /// The number of independent constants that commute with each other.
    pub fn commuting(&self) -> usize {
        self.in_involution.len() + self.completing.len()
    }

    /// What commutes with each other, by the names of the constants: `energy`, `p_phi`, `I1^2 + I2^2`.
    pub fn commuting_names(&self, names: &[String]) -> Vec<String> {
        let own = self.in_involution.iter().map(|&i| names[i].clone());
        own.chain(self.completing.iter().map(|c| c.in_names(names))).collect()
    }
}

/// Whether a function has zero bracket with every variable.
fn is_casimir(model: &Model, equations: &mut Equations, f: Expr) -> bool {
    let variables: Vec<Symbol> = equations.coordinates.iter().map(|c| c.position).collect();
    variables.into_iter().all(|x| {
        let x = equations.pool.variable(x);
        let bracket = bracket(model, equations, f, x);
        bracket.is_ok_and(|e| equations.pool.is_zero(e) == Zero::Proved)
    })
}

/// A largest set of independent functions that commute pairwise.
fn largest(independent: &[bool], commute: &dyn Fn(usize, usize) -> bool) -> Vec<usize> {
    fn grow(
        chosen: &mut Vec<usize>,
        rest: &[usize],
        commute: &dyn Fn(usize, usize) -> bool,
        best: &mut Vec<usize>,
        budget: &mut u32,
    ) {
        if chosen.len() > best.len() {
            best.clone_from(chosen);
        }
        if *budget == 0 || chosen.len() + rest.len() <= best.len() {
            return;
        }
        *budget -= 1;
        for (k, &i) in rest.iter().enumerate() {
            let next: Vec<usize> =
                rest[k + 1..].iter().copied().filter(|&j| commute(i, j)).collect();
            chosen.push(i);
            grow(chosen, &next, commute, best, budget);
            chosen.pop();
        }
    }
    let all: Vec<usize> = (0..independent.len()).filter(|&i| independent[i]).collect();
    let mut best = Vec::new();
    grow(&mut Vec::new(), &all, commute, &mut best, &mut 20_000);
    best
}

fn verdict(
    invariants: &Invariants,
    freedoms: Option<usize>,
    casimirs: usize,
    in_involution: usize,
) -> String {
    let total = invariants.independent();
    let unproved = invariants.found.iter().any(|c| c.proof == Proof::Unproved);
    let caution = if unproved { " (not all of them proved)" } else { "" };
    let nothing = match invariants.none_up_to {
        Some(n) if invariants.found.is_empty() => {
            format!("; nothing else of the form searched, up to degree {n} (proved)")
        }
        _ => String::new(),
    };
    let count = |n: usize| match n {
        1 => "1 independent constant of the motion".to_owned(),
        n => format!("{n} independent constants of the motion"),
    };
    let Some(n) = freedoms else {
        return format!("{}{caution}{nothing}", count(total));
    };
    let freedom =
        if n == 1 { "1 degree of freedom".to_owned() } else { format!("{n} degrees of freedom") };
    if invariants.driven {
        return format!(
            "{freedom}, a law that contains the time: {}{caution}{nothing}",
            count(total)
        );
    }
    let commuting = in_involution.saturating_sub(casimirs);
    if commuting >= n && total - casimirs > n {
        let closed = if total + 1 >= invariants.dimension {
            "maximally superintegrable, every bounded orbit closes"
        } else {
            "superintegrable"
        };
        return format!(
            "{freedom}, {}, {n} of them in involution{caution}: {closed}",
            count(total - casimirs)
        );
    }
    if commuting >= n && n > 0 {
        return format!("{freedom}, {n} in involution{caution}: integrable (Liouville){nothing}");
    }
    format!("{freedom}, {}, {commuting} in involution{caution}{nothing}", count(total - casimirs))
}
