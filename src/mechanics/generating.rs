//! The other generating functions of a canonical transformation, by Legendre's transformation: F2 = F1 + QP, F3 = F1 − qp,
//! F4 = F1 + QP − qp.
//!
//! In: a map whose new variables are known in closed form. Out: F1 … F4 as functions of their variables, each with its
//! relations proved or holding at points near the start; where one does not exist, why. Of a map given by mixed types, one
//! for each pair, those of mixed types too. Never here: whether the map is canonical.
//! Source: *The Principles of Dynamics*, § 3.2.1.

mod function_test;

use std::collections::HashMap;

use super::canonical::{ALLOWANCE, PhaseMap};
use super::determinant::singular;
use super::equations::Equations;
use super::isolate::{self, Solution};
use super::potential::potential;
use super::valuation::Valuation;
use crate::expr::{Expr, Pool, Symbol, Zero};
use crate::model::{GeneratingType, Model, Transformation, TransformationLaw};
use crate::num::Number;
use function_test::FunctionTest;

/// Of so many pairs every choice of types is tried, of more those that differ from the given one at a single pair.
const PAIRS: usize = 2;

/// The points at which a function has to give the map.
const POINTS: u64 = 24;

/// A generating function of a map, if it has one of this type.
#[derive(Clone, Debug)]
pub struct GeneratingFunction {
    /// Its type for each pair.
    pub types: Vec<GeneratingType>,
    /// The function, or why it is not there.
    pub function: Result<Expr, NoFunction>,
    /// Whether its relations are proved; else they hold at points near the start.
    pub proved: bool,
}

/// Why a map has no generating function of a type, or none that can be written down.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum NoFunction {
    /// Its variables, which are these, are not independent: Legendre's transformation does not exist.
    #[error("none: {0} are not independent")]
    Dependent(String),
    /// There is one wherever these variables are independent; no solution in closed form of the equations of Legendre's
    /// transformation was found.
    #[error("exists where {0} are independent; no closed form of it was found")]
    NotWritten(String),
}

impl GeneratingFunction {
    /// The name of its type, or the names of those of each pair.
    pub fn name(&self) -> String {
        self.named(GeneratingType::name)
    }

    /// The name of its type as it is shown.
    pub fn shown(&self) -> String {
        self.named(GeneratingType::shown)
    }

    fn named(&self, name: fn(GeneratingType) -> &'static str) -> String {
        let names: Vec<&str> = self.types.iter().map(|of| name(*of)).collect();
        let single = names.windows(2).all(|pair| pair[0] == pair[1]);
        if single {
            names.first().map_or_else(String::new, |&name| name.into())
        } else {
            names.join(", ")
        }
    }
}

/// The types to be tried for a map: one for all pairs; and where the map is given by several, one for each pair.
fn choices(given: &Transformation) -> Vec<Vec<GeneratingType>> {
    let n = given.new.len();
    let mut all: Vec<Vec<GeneratingType>> =
        GeneratingType::ALL.into_iter().map(|of| vec![of; n]).collect();
    let TransformationLaw::Generating { types, .. } = &given.law else { return all };
    if types.windows(2).all(|pair| pair[0] == pair[1]) {
        return all;
    }
    let with = |list: &[GeneratingType], i: usize, of: GeneratingType| {
        let mut list = list.to_vec();
        list[i] = of;
        list
    };
    let mut mixed = vec![types.clone()];
    for i in 0..n {
        let from = if n <= PAIRS { mixed.clone() } else { vec![types.clone()] };
        for list in from {
            mixed.extend(GeneratingType::ALL.into_iter().map(|of| with(&list, i, of)));
        }
    }
    for list in mixed {
        if !all.contains(&list) {
            all.push(list);
        }
    }
    all
}

/// A generating function with q p and Q P, by their signs, of each pair whose q or Q it does not have.
fn with_products(
    pool: &mut Pool,
    (function, types): (Expr, &[GeneratingType]),
    [of_old, of_new]: [Number; 2],
    [old, new]: [&[Expr]; 2],
) -> Expr {
    let n = types.len();
    let mut terms = vec![(Number::ONE, function)];
    for (i, of) in types.iter().enumerate() {
        if !of.has_position() {
            terms.push((of_old, pool.mul(old[i], old[n + i])));
        }
        if !of.has_new_position() {
            terms.push((of_new, pool.mul(new[i], new[n + i])));
        }
    }
    pool.linear(Number::ZERO, &terms)
}

/// The letters of the variables of a function of some types: `q and Q`, or `q, p and P, Q` of two pairs.
fn variables_of(types: &[GeneratingType]) -> String {
    let alike = types.iter().all(|of| *of == types[0]);
    let shown = &types[..if alike { 1 } else { types.len() }];
    let list = |letter: fn(&GeneratingType) -> &'static str| {
        shown.iter().map(letter).collect::<Vec<_>>().join(", ")
    };
    let old = list(|of| if of.has_position() { "q" } else { "p" });
    let new = list(|of| if of.has_new_position() { "Q" } else { "P" });
    format!("{old} and {new}")
}

impl PhaseMap {
    /// The generating functions of one type for all pairs, and of a map given by mixed types of one for each; none where the new variables are not known in closed form. The
    /// map has to be canonical.
    pub fn generating_functions(
        &self,
        model: &Model,
        equations: &mut Equations,
        given: &Transformation,
    ) -> Vec<GeneratingFunction> {
        let Some(forwards) = self.forwards.clone() else { return Vec::new() };
        let value =
            equations.pool.attempt(ALLOWANCE, |pool| self.value_of_first(pool, given, &forwards));
        let Some(value) = value else { return Vec::new() };
        let all = choices(given).into_iter().map(|wanted| {
            let written = match &given.law {
                TransformationLaw::Generating { types, function } if *types == wanted => {
                    Some(*function)
                }
                _ => None,
            };
            let (function, proved) = match written {
                Some(function) => (Ok(function), true),
                None => {
                    let found = equations.attempt(ALLOWANCE, |equations| {
                        Some(self.of_types(model, equations, given, (&forwards, value), &wanted))
                    });
                    let too_long = || (Err(NoFunction::NotWritten(variables_of(&wanted))), false);
                    found.unwrap_or_else(too_long)
                }
            };
            GeneratingFunction { types: wanted, function, proved }
        });
        all.collect()
    }

    /// The new variables in order, as functions of the old ones.
    fn images_of(&self, forwards: &Solution) -> Option<Vec<Expr>> {
        let value = |s: &Symbol| forwards.iter().find(|(found, _)| found == s).map(|&(_, e)| e);
        self.implicit.new.iter().map(value).collect()
    }

    /// F1 as a function of (q, p, t): dF1 = p dq − P dQ at fixed t.
    fn value_of_first(
        &self,
        pool: &mut Pool,
        given: &Transformation,
        forwards: &Solution,
    ) -> Option<Expr> {
        let n = self.old.len() / 2;
        let images = self.images_of(forwards)?;
        let old: Vec<Expr> = self.old.iter().map(|&s| pool.variable(s)).collect();
        if let TransformationLaw::Generating { types, function } = &given.law {
            let map: HashMap<Symbol, Expr> = forwards.iter().copied().collect();
            let function = pool.substitute(*function, &map);
            let signs = [Number::ONE, Number::MINUS_ONE];
            let value = with_products(pool, (function, types), signs, [&old, &images]);
            return Some(pool.simplify(value));
        }
        let mut form = Vec::new();
        for (k, &s) in self.old.iter().enumerate() {
            let mut terms = Vec::new();
            if k < n {
                terms.push((Number::ONE, old[n + k]));
            }
            for i in 0..n {
                let slope = pool.derivative(images[i], s);
                terms.push((Number::MINUS_ONE, pool.mul(images[n + i], slope)));
            }
            let slope = pool.linear(Number::ZERO, &terms);
            form.push(pool.simplify(slope));
        }
        potential(pool, &form, &self.old)
    }

    fn of_types(
        &self,
        model: &Model,
        equations: &mut Equations,
        given: &Transformation,
        (forwards, first): (&Solution, Expr),
        types: &[GeneratingType],
    ) -> (Result<Expr, NoFunction>, bool) {
        let n = self.old.len() / 2;
        let Some(images) = self.images_of(forwards) else {
            return (Err(NoFunction::NotWritten(variables_of(types))), false);
        };
        // the old half that it does not have follows from the new half that it has
        let half = |i: usize, first: bool| if first { i } else { n + i };
        let each = || types.iter().enumerate();
        let missing: Vec<Symbol> =
            each().map(|(i, of)| self.old[half(i, !of.has_position())]).collect();
        let halves: Vec<usize> = each().map(|(i, of)| half(i, of.has_new_position())).collect();
        let pool = &mut equations.pool;
        let mut matrix = Vec::new();
        let mut relations = Vec::new();
        for k in halves {
            let (name, value) = (self.implicit.new[k], images[k]);
            let row: Vec<Expr> = missing.iter().map(|&s| pool.derivative(value, s)).collect();
            matrix.push(row);
            let variable = pool.variable(name);
            relations.push(pool.sub(variable, value));
        }
        let points: Vec<Valuation> = (0..POINTS)
            .filter_map(|k| {
                let at = Valuation::near_start(model, equations, k);
                self.image(&equations.pool, &at)
            })
            .collect();
        if singular(&equations.pool, &matrix, &points) {
            return (Err(NoFunction::Dependent(variables_of(types))), false);
        }
        let pool = &mut equations.pool;
        let old: Vec<Expr> = self.old.iter().map(|&s| pool.variable(s)).collect();
        let signs = [Number::MINUS_ONE, Number::ONE];
        let value = with_products(pool, (first, types), signs, [&old, &images]);
        let mut ways = vec![(relations, missing.clone(), value)];
        ways.splice(0..0, self.of_given(pool, given, types));
        let direct = self.of_linear_map(pool, &images, types);
        ways.splice(0..0, direct.map(|value| (Vec::new(), Vec::new(), value)));
        let test = FunctionTest {
            model,
            given,
            types,
            variables: [&self.old[..], self.new_variables()].concat(),
            map: forwards.iter().copied().collect(),
            points: &points,
        };
        let mut best: Option<(Expr, bool)> = None;
        for (relations, unknowns, value) in ways {
            let mut found: Option<(Expr, bool)> = None;
            let mut accept = |pool: &mut Pool, solution: &Solution| {
                found = test.function(pool, value, &unknowns, solution);
                found.is_some()
            };
            let pool = &mut equations.pool;
            let (is_direct, solved) = if unknowns.is_empty() {
                (true, accept(pool, &Vec::new()))
            } else {
                (false, isolate::solve(pool, &relations, &unknowns, &mut accept).is_some())
            };
            let lighter = |found: &(Expr, bool)| {
                best.is_none_or(|best| pool.weight(found.0) < pool.weight(best.0))
            };
            if let Some(found) = found.filter(|found| solved && lighter(found)) {
                best = Some(found);
            }
            if solved && !is_direct {
                break;
            }
        }
        match best {
            Some((function, proved)) => (Ok(function), proved),
            None => (Err(NoFunction::NotWritten(variables_of(types))), false),
        }
    }

    /// That of a linear map of one pair, Q = A q + B p and P = C q + D p, by its coefficients, with nothing solved for: with
    /// A D − B C = 1, F1 = (q Q − ½ A q² − ½ D Q²)/B, and the others alike.
    fn of_linear_map(
        &self,
        pool: &mut Pool,
        images: &[Expr],
        types: &[GeneratingType],
    ) -> Option<Expr> {
        let (&[q, p], [of]) = (&self.old[..], types) else { return None };
        let mut entries = Vec::new();
        let origin = HashMap::from([(q, Expr::ZERO), (p, Expr::ZERO)]);
        for &image in images {
            for s in [q, p] {
                let slope = pool.derivative(image, s);
                entries.push(pool.simplify(slope));
            }
            let at_origin = pool.substitute(image, &origin);
            if pool.is_zero(at_origin) != Zero::Proved {
                return None;
            }
        }
        let &[a, b, c, d] = &entries[..] else { return None };
        if entries.iter().any(|&e| pool.depends_on_any(e, &self.old)) {
            return None;
        }
        let sign = if of.has_position() { Number::ONE } else { Number::MINUS_ONE };
        let (divisor, old, new) = match (of.has_position(), of.has_new_position()) {
            (true, true) => (b, pool.neg(a), pool.neg(d)),
            (true, false) => (d, pool.neg(c), b),
            (false, true) => (a, b, pool.neg(c)),
            (false, false) => (c, d, a),
        };
        let x = pool.variable(if of.has_position() { q } else { p });
        let y = pool.variable(self.implicit.new[usize::from(!of.has_new_position())]);
        let product = pool.mul(x, y);
        let mut terms = vec![(sign, product)];
        for (coefficient, variable) in [(old, x), (new, y)] {
            let square = pool.mul(variable, variable);
            terms.push((Number::HALF, pool.mul(coefficient, square)));
        }
        let numerator = pool.linear(Number::ZERO, &terms);
        Some(pool.div(numerator, divisor))
    }

    /// Legendre's transformation of the function that is given: its own relations are solved for the variables that the wanted
    /// one does not have. No branch of the map is chosen by that, so that what is found holds on all of them.
    fn of_given(
        &self,
        pool: &mut Pool,
        given: &Transformation,
        types: &[GeneratingType],
    ) -> Option<(Vec<Expr>, Vec<Symbol>, Expr)> {
        let TransformationLaw::Generating { types: own, function } = &given.law else {
            return None;
        };
        let n = types.len();
        let mut terms = vec![(Number::ONE, *function)];
        let mut unknowns = Vec::new();
        for (i, (own, wanted)) in own.iter().zip(types).enumerate() {
            let halves = [
                (&self.old, own.has_position(), wanted.has_position(), Number::MINUS_ONE),
                (
                    &self.implicit.new,
                    own.has_new_position(),
                    wanted.has_new_position(),
                    Number::ONE,
                ),
            ];
            for (variables, has, is_to_have, sign) in halves {
                let [position, momentum] =
                    [variables[i], variables[n + i]].map(|s| pool.variable(s));
                unknowns.push(variables[if is_to_have { n + i } else { i }]);
                if has != is_to_have {
                    let product = pool.mul(position, momentum);
                    terms.push((if is_to_have { -sign } else { sign }, product));
                }
            }
        }
        let value = pool.linear(Number::ZERO, &terms);
        Some((self.implicit.relations.clone(), unknowns, value))
    }
}
