//! Where parameters make a map canonical: λ μ = 1 is solved for μ, so that K and generating functions can be written with it.
//!
//! In: a map whose brackets are those of canonical variables at the file's values of the parameters, and not at others. Out:
//! parameters as functions of the others, and the map in which they are that. Never here: the verdict.

use std::collections::HashMap;

use super::canonical::PhaseMap;
use super::canonical_verdict::CanonicalVerdict;
use super::equations::Equations;
use super::isolate::{Solution, tidy};
use super::rearrange::isolate;
use super::valuation::Valuation;
use crate::expr::{Expr, Pool, Symbol, Zero};
use crate::model::{Mechanics, Model};
use crate::num::Number;

/// What is solved for has the file's value to this part of it, as canonical maps have their brackets.
const SAME: f64 = 1e-9;

/// Parameters that may be solved for.
struct Unknowns<'a> {
    model: &'a Model,
    at: Valuation,
    /// What no value may depend on.
    moving: Vec<Symbol>,
}

impl PhaseMap {
    /// The parameters, as functions of the others, of which the map is canonical; empty if it is for all, or if no such function is
    /// found.
    pub(super) fn canonical_where(
        &self,
        model: &Model,
        equations: &mut Equations,
        verdict: &CanonicalVerdict,
    ) -> Solution {
        let at = Valuation::of_parameters(model, &model.parameter_values());
        let mut moving = self.old.clone();
        moving.push(model.symbols.time);
        let unknowns = Unknowns { model, at, moving };
        let pool = &mut equations.pool;
        let mut found: Solution = Vec::new();
        for bracket in &verdict.only_here {
            let difference = pool.sub(bracket.is, bracket.expected);
            let rest = tidy(pool, difference, &found.iter().copied().collect());
            if pool.is_zero(rest) == Zero::Proved {
                continue;
            }
            let one = unknowns.solved(pool, rest).map(|one| vec![one]);
            let next = one.or_else(|| unknowns.solved_with_a_number(pool, rest));
            let Some(next) = next else { return Vec::new() };
            let replaced: HashMap<Symbol, Expr> = next.iter().copied().collect();
            for (_, e) in &mut found {
                *e = tidy(pool, *e, &replaced);
            }
            found.extend(next);
        }
        if found.is_empty() {
            // a chain of maps among them, whose brackets are not compared
            return found;
        }
        let is_canonical = self.at_parameters(pool, &found).has_canonical_brackets(pool);
        if is_canonical { found } else { Vec::new() }
    }

    /// The same map with some parameters replaced.
    pub(super) fn at_parameters(&self, pool: &mut Pool, values: &Solution) -> PhaseMap {
        let mut map = self.clone();
        let values: HashMap<Symbol, Expr> = values.iter().copied().collect();
        let implicit = &mut map.implicit;
        let matrices = implicit.by_new.iter_mut().chain(&mut map.by_old).flatten();
        let forwards = map.forwards.iter_mut().flatten().map(|(_, e)| e);
        for e in implicit.relations.iter_mut().chain(matrices).chain(forwards) {
            *e = tidy(pool, *e, &values);
        }
        map
    }
}

impl Unknowns<'_> {
    /// A parameter with the value that makes an expression vanish, as a function of the others: one that is not in the law, if there
    /// is one, the shortest, and of these the last in the file.
    fn solved(&self, pool: &mut Pool, e: Expr) -> Option<(Symbol, Expr)> {
        let law = match self.model.mechanics {
            Mechanics::Lagrangian { lagrangian, .. } => lagrangian,
            Mechanics::Hamiltonian { hamiltonian, .. } | Mechanics::Poisson { hamiltonian, .. } => {
                hamiltonian
            }
        };
        let mut best: Option<((bool, u64), Symbol, Expr)> = None;
        for symbol in self.model.parameters.iter().map(|parameter| parameter.symbol) {
            if !pool.depends(e, symbol) {
                continue;
            }
            for value in isolate(pool, e, symbol) {
                let value = pool.simplify(value);
                let (own, is) = (self.at.at(symbol), self.at.value(pool, value));
                let value = as_one_root(pool, value, is < 0.0);
                let rank = (pool.depends(law, symbol), pool.weight(value));
                if (is - own).abs() <= SAME * own.abs()
                    && !pool.depends_on_any(value, &self.moving)
                    && best.is_none_or(|(least, ..)| rank <= least)
                {
                    best = Some((rank, symbol, value));
                }
            }
        }
        best.map(|(_, symbol, value)| (symbol, value))
    }

    /// The same where it takes the number that another parameter has in the file, as an exponent.
    fn solved_with_a_number(&self, pool: &mut Pool, e: Expr) -> Option<Solution> {
        for parameter in &self.model.parameters {
            let symbol = parameter.symbol;
            if !pool.depends(e, symbol) {
                continue;
            }
            let number = Number::from_literal(&format!("{:?}", self.at.at(symbol)))?;
            let number = pool.number(number);
            let rest = tidy(pool, e, &HashMap::from([(symbol, number)]));
            if pool.is_zero(rest) == Zero::Proved {
                return Some(vec![(symbol, number)]);
            }
            if let Some(other) = self.solved(pool, rest) {
                return Some(vec![(symbol, number), other]);
            }
        }
        None
    }
}

/// A value of one sign as the root of its square, where that is shorter: `2 √½/√(1/x)` is `√(2 x)`.
fn as_one_root(pool: &mut Pool, value: Expr, is_negative: bool) -> Expr {
    let square = pool.powi(value, 2);
    let square = pool.simplify(square);
    let root = pool.sqrt(square);
    let root = if is_negative { pool.neg(root) } else { root };
    if pool.weight(root) < pool.weight(value) { root } else { value }
}
