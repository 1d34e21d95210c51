//! Whether constraints on the velocities are holonomic: Frobenius' theorem.
//!
//! In: the constraints A_β·q̇ + A_β0 = 0 of a system. Out: of each one whether it follows from a relation between the
//! coordinates and the time, proved or refuted, with the relation where one is found. Never here: motion; constraints that
//! are given between the coordinates.
//!
//! The forms ω_β = Σ A_βα dq_α + A_β0 dt are holonomic together iff dω_β ∧ ω_1 ∧ … ∧ ω_m = 0 for each β. Of those for
//! which it fails, none is holonomic; the others are examined again without them.
//! Source: V. I. Arnold, *Mathematical Methods of Classical Mechanics*, appendix 4; Ju. I. Neimark and N. A. Fufaev,
//! *Dynamics of Nonholonomic Systems*, ch. I.

use std::collections::{BTreeMap, HashMap};

use super::equations::{ConstraintRow, Equations};
use super::modulo::Determined;
use super::potential::potential;
use super::structure::Holonomy;
use crate::expr::{Expr, Pool, Symbol, Zero};

/// More components than this of a product of forms are not examined.
const MOST_COMPONENTS: usize = 3_000;

/// A form of some degree: its components by their ascending variables.
type ExteriorForm = BTreeMap<Vec<usize>, Expr>;

impl Equations {
    pub(super) fn find_holonomy(&mut self) {
        let rows = self.constraints.clone();
        if rows.iter().all(|row| row.position.is_some()) {
            self.supplements.holonomy = vec![Holonomy::Given; rows.len()];
            return;
        }
        let before = self.pool.clone();
        self.supplements.holonomy = self.judge_constraints(&rows);
        if self.pool.is_full() {
            self.pool = before;
            let given = |row: &ConstraintRow| match row.position {
                Some(_) => Holonomy::Given,
                None => Holonomy::Unknown,
            };
            self.supplements.holonomy = rows.iter().map(given).collect();
        }
    }

    fn judge_constraints(&mut self, rows: &[ConstraintRow]) -> Vec<Holonomy> {
        let general = self.holonomy(rows);
        if general.iter().all(|h| h.answer() == Some(true)) {
            return general;
        }
        // of what is not holonomic for all values of the parameters, the file's may be an exception
        let values = self.parameter_values();
        let mut here = rows.to_vec();
        for row in &mut here {
            for e in row.row.iter_mut().chain([&mut row.rate]) {
                *e = self.pool.substitute(*e, &values);
            }
        }
        let special = self.holonomy(&here);
        let chosen = general.into_iter().zip(special).map(|(general, special)| {
            match (general, special) {
                (general, _) if general.answer() == Some(true) => general,
                (_, Holonomy::Holonomic { constant, together, .. }) => {
                    Holonomy::Holonomic { constant, together, at_these_parameters: true }
                }
                // with the parameters' names, where it is also refuted for them
                (general @ Holonomy::Not { .. }, Holonomy::Not { .. }) => general,
                (_, special) => special,
            }
        });
        chosen.collect()
    }

    fn holonomy(&mut self, rows: &[ConstraintRow]) -> Vec<Holonomy> {
        let mut variables: Vec<Symbol> = self.coordinates.iter().map(|c| c.position).collect();
        variables.push(self.symbols.time);
        let places = self.fixed_positions();
        let holonomic = rows.iter().filter(|row| row.position.is_some()).count();
        let on: Vec<(Symbol, Expr)> = places
            .iter()
            .filter_map(|place| match place {
                Determined::Value(q, value) => Some((*q, *value)),
                Determined::Square(..) => None,
            })
            .collect();
        // with other relations between the coordinates a value elsewhere refutes nothing
        let refutable = on.len() == holonomic;
        let forms: Vec<Vec<Expr>> =
            rows.iter().map(|row| row.row.iter().copied().chain([row.rate]).collect()).collect();
        let mut system =
            Pfaffian { pool: &mut self.pool, variables, on, refutable, forms: forms.clone() };
        system.judge(rows)
    }
}

/// Forms on the coordinates and the time.
struct Pfaffian<'a> {
    pool: &'a mut Pool,
    variables: Vec<Symbol>,
    /// Coordinates that other constraints determine.
    on: Vec<(Symbol, Expr)>,
    refutable: bool,
    forms: Vec<Vec<Expr>>,
}

impl Pfaffian<'_> {
    fn judge(&mut self, rows: &[ConstraintRow]) -> Vec<Holonomy> {
        let m = self.forms.len();
        let given = |k: usize| rows[k].position.is_some();
        let mut found: Vec<Holonomy> =
            (0..m).map(|k| if given(k) { Holonomy::Given } else { Holonomy::Unknown }).collect();
        let smooth: Vec<bool> = (0..m)
            .map(|k| !self.forms[k].iter().any(|&a| self.pool.may_have_kink(a, &self.variables)))
            .collect();
        // each by itself: dω ∧ ω = 0
        for k in (0..m).filter(|&k| !given(k) && smooth[k]) {
            let own = self.one(k);
            let closed = self.derivative(k);
            let product = self.wedge(&closed, &own);
            if product.is_some_and(|product| self.is_zero(&product) == Zero::Proved) {
                let constant = self.constant(k, &own, &[]);
                found[k] =
                    Holonomy::Holonomic { constant, together: false, at_these_parameters: false };
            }
        }
        // all together; of several that depend on each other the product vanishes, and says nothing
        let mut left: Vec<usize> = (0..m).collect();
        for round in 0..m {
            let Some(volume) = self.product(&left) else { break };
            if self.is_zero(&volume) != Zero::No {
                break;
            }
            let mut dropped = Vec::new();
            let mut sure = true;
            for &k in &left {
                let closed = self.derivative(k);
                let Some(product) = self.wedge(&closed, &volume) else { return found };
                match self.is_zero(&product) {
                    Zero::Proved => {}
                    // beyond the first round a combination of the forms left out may close it
                    Zero::No if self.refutable => {
                        dropped.push(k);
                        if round == 0 && found[k] == Holonomy::Unknown {
                            found[k] = self.refutation(&product);
                        }
                    }
                    _ => sure = false,
                }
            }
            if !sure {
                break;
            }
            if dropped.is_empty() {
                for k in left.clone() {
                    if found[k] == Holonomy::Unknown && left.iter().all(|&k| smooth[k]) {
                        let fixed = self.fixed(&left, &found);
                        let constant = self.constant(k, &volume, &fixed);
                        found[k] = Holonomy::Holonomic {
                            constant,
                            together: true,
                            at_these_parameters: false,
                        };
                    }
                }
                break;
            }
            left.retain(|k| !dropped.contains(k));
        }
        found
    }

    /// Variables that are constant because a holonomic form has no other.
    fn fixed(&self, of: &[usize], found: &[Holonomy]) -> Vec<usize> {
        let alone = |&k: &usize| {
            let form = &self.forms[k];
            let mut acting = (0..form.len()).filter(|&i| form[i] != Expr::ZERO);
            let first = acting.next()?;
            (acting.next().is_none() && found[k].answer() == Some(true)).then_some(first)
        };
        of.iter().filter_map(alone).collect()
    }

    /// A function f ≠ const with df a combination of the forms whose product is given: one with df = g ω_k on where the
    /// fixed variables are constant, for a few factors g.
    fn constant(&mut self, k: usize, volume: &ExteriorForm, fixed: &[usize]) -> Option<Expr> {
        let mut form = self.forms[k].clone();
        for &i in fixed {
            form[i] = Expr::ZERO;
        }
        let free: Vec<usize> = (0..form.len()).filter(|i| !fixed.contains(i)).collect();
        let names: Vec<Symbol> = free.iter().map(|&i| self.variables[i]).collect();
        let mut factors = vec![Expr::ONE];
        let acting: Vec<Expr> = form.iter().copied().filter(|&a| a != Expr::ZERO).collect();
        for (i, &a) in acting.iter().enumerate() {
            factors.push(self.pool.powi(a, -1));
            for &b in &acting[i..] {
                let product = self.pool.mul(a, b);
                factors.push(self.pool.powi(product, -1));
            }
        }
        for &i in &free {
            let x = self.pool.variable(self.variables[i]);
            factors.extend([-1, -2].map(|n| self.pool.powi(x, n)));
        }
        factors.into_iter().find_map(|factor| {
            let mut scaled = Vec::new();
            for &i in &free {
                let a = self.pool.mul(factor, form[i]);
                scaled.push(self.pool.simplify(a));
            }
            let found = potential(self.pool, &scaled, &names)?;
            // df ∧ ω_1 ∧ … ∧ ω_m = 0, and df ≠ 0
            let slopes: Vec<Expr> =
                self.variables.clone().iter().map(|&x| self.pool.derivative(found, x)).collect();
            let slopes = form_of(&slopes);
            let product = self.wedge(&slopes, volume)?;
            let right = self.is_zero(&product) == Zero::Proved && self.is_zero(&slopes) == Zero::No;
            right.then_some(found)
        })
    }

    fn refutation(&mut self, product: &ExteriorForm) -> Holonomy {
        let mut components: Vec<(&Vec<usize>, Expr)> = Vec::new();
        for (place, &e) in product {
            let e = self.pool.simplify(e);
            components.push((place, e));
        }
        components.sort_by_key(|&(_, e)| self.pool.weight(e));
        let found = components.into_iter().find(|&(_, e)| {
            let here = self.here(e);
            self.pool.is_zero(here) == Zero::No
        });
        found.map_or(Holonomy::Unknown, |(place, component)| Holonomy::Not {
            variables: place.iter().map(|&i| self.variables[i]).collect(),
            component,
        })
    }

    /// An expression where the other constraints hold.
    fn here(&mut self, e: Expr) -> Expr {
        let on = self.on.clone();
        on.into_iter()
            .fold(e, |e, (q, value)| self.pool.substitute(e, &HashMap::from([(q, value)])))
    }

    /// Whether all components vanish where the other constraints hold.
    fn is_zero(&mut self, form: &ExteriorForm) -> Zero {
        let mut all = Zero::Proved;
        for &e in form.values() {
            let here = self.here(e);
            match self.pool.is_zero(here) {
                Zero::Proved => {}
                Zero::No => return Zero::No,
                other => all = other,
            }
        }
        all
    }

    fn one(&self, k: usize) -> ExteriorForm {
        form_of(&self.forms[k])
    }

    /// dω_k.
    fn derivative(&mut self, k: usize) -> ExteriorForm {
        let form = self.forms[k].clone();
        let mut all = ExteriorForm::new();
        for i in 0..form.len() {
            for j in i + 1..form.len() {
                let a = self.pool.derivative(form[j], self.variables[i]);
                let b = self.pool.derivative(form[i], self.variables[j]);
                let curl = self.pool.sub(a, b);
                if curl != Expr::ZERO {
                    all.insert(vec![i, j], curl);
                }
            }
        }
        all
    }

    /// ω_1 ∧ … ∧ ω_m of these forms.
    fn product(&mut self, of: &[usize]) -> Option<ExteriorForm> {
        let mut all = ExteriorForm::from([(Vec::new(), Expr::ONE)]);
        for &k in of {
            let one = self.one(k);
            all = self.wedge(&all, &one)?;
        }
        Some(all)
    }

    /// The exterior product of two forms; `None` if it has too many components.
    fn wedge(&mut self, a: &ExteriorForm, b: &ExteriorForm) -> Option<ExteriorForm> {
        let mut terms: BTreeMap<Vec<usize>, Vec<Expr>> = BTreeMap::new();
        for (left, &x) in a {
            for (right, &y) in b {
                let Some((place, even)) = sorted(left, right) else { continue };
                let product = self.pool.mul(x, y);
                let product = if even { product } else { self.pool.neg(product) };
                terms.entry(place).or_default().push(product);
                if terms.len() > MOST_COMPONENTS || self.pool.is_full() {
                    return None;
                }
            }
        }
        let sums = terms.into_iter().map(|(place, terms)| (place, self.pool.sum(&terms)));
        Some(sums.filter(|(_, e)| *e != Expr::ZERO).collect())
    }
}

fn form_of(components: &[Expr]) -> ExteriorForm {
    let all = components.iter().enumerate().filter(|(_, e)| **e != Expr::ZERO);
    all.map(|(i, &e)| (vec![i], e)).collect()
}

/// Both lists in ascending order, and whether the permutation is even; `None` if an index is in both.
fn sorted(left: &[usize], right: &[usize]) -> Option<(Vec<usize>, bool)> {
    let mut all = [left, right].concat();
    let mut even = true;
    for i in 1..all.len() {
        let mut k = i;
        while k > 0 && all[k - 1] >= all[k] {
            if all[k - 1] == all[k] {
                return None;
            }
            all.swap(k - 1, k);
            even = !even;
            k -= 1;
        }
    }
    Some((all, even))
}
