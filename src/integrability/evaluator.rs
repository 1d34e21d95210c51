//! Expressions evaluated at random points over a prime field, with their derivatives along any direction.
//!
//! In: expressions of a pool, residues for its symbols, a direction. Out: residues. Each sine and cosine is a point of
//! a circle (by its rational parametrisation), each exponential a random unit, each logarithm and arctangent a random
//! residue, each root the positive one: algebraically they satisfy what the functions satisfy, and nothing else. A
//! point at which something has no value is refused, and another is drawn.
//!
//! It walks the nodes of the pool; it could become a third evaluation of the compiled program of `system`, which has the
//! same operations. Nothing outside this file knows which it is.
//! Never here: what the expressions mean.

use rustc_hash::FxHashMap;

use super::node_operation::NodeOperation;
use super::occurring_functions::OccurringFunctions;
use super::positive_roots::PositiveRoots;
use super::radicals::Radicals;
use super::random::Random;
use super::units::{ArgumentUnits, Unsupported};
use crate::expr::{Expr, Pool, Symbol};
use crate::num::{Number, PrimeField, Residue};

/// Compiled expressions.
#[derive(Clone, Debug)]
pub(super) struct ResidueEvaluator {
    steps: Vec<NodeOperation>,
    index: FxHashMap<Expr, usize>,
    /// For each circle, and each unit, whether it is the same at all points.
    circles: Vec<bool>,
    units: Vec<bool>,
    /// Whether logarithms or arctangents may be related, so that points are too general.
    pub(super) overgeneral: bool,
    /// Whether numbers are not short fractions. Their products are rounded, so that relations between them are lost.
    pub(super) inexact: bool,
    radicals: Radicals,
    positive: PositiveRoots,
}

#[derive(Clone, Debug)]
pub(super) struct SamplePoint {
    pub(super) field: PrimeField,
    values: Vec<Residue>,
    /// cos for sin, cosh for sinh, and the reverse.
    companions: Vec<Residue>,
}

impl ResidueEvaluator {
    /// Compiles expressions. Functions of what does not contain the `moving` symbols have the same value at every
    /// point of a seed.
    pub(super) fn new(
        pool: &mut Pool,
        roots: &[Expr],
        moving: &[Symbol],
    ) -> Result<ResidueEvaluator, Unsupported> {
        let nodes = pool.reachable(roots);
        let index: FxHashMap<Expr, usize> =
            nodes.iter().enumerate().map(|(i, &e)| (e, i)).collect();
        let functions = OccurringFunctions::of(pool, &nodes, moving)?;
        let mut steps = Vec::with_capacity(nodes.len());
        for &e in &nodes {
            steps.push(functions.operation(pool, e, &index, moving)?);
        }
        let fixed = |all: &ArgumentUnits| -> Vec<bool> {
            all.order.iter().map(|&term| !pool.depends_on_any(term, moving)).collect()
        };
        let OccurringFunctions { circles, units, roots_of, opaque, inexact } = &functions;
        let radicals = Radicals::new(pool, roots_of, &index);
        let orders = roots_of.iter().map(|(base, &order)| (index[base], order)).collect();
        let positive = PositiveRoots::new(&steps, &orders);
        Ok(ResidueEvaluator {
            steps,
            circles: fixed(circles),
            units: fixed(units),
            overgeneral: *opaque > 1 || *inexact,
            inexact: *inexact,
            index,
            radicals,
            positive,
        })
    }

    /// The square-free numbers of which square roots are taken; none where there are other roots of numbers.
    pub(super) fn radicals(&self) -> &[i64] {
        &self.radicals.numbers
    }

    /// The same with the negative roots of some of those numbers, a bit for each.
    pub(super) fn conjugate(&self, negative: u32) -> ResidueEvaluator {
        let radicals = Radicals { negative, ..self.radicals.clone() };
        ResidueEvaluator { radicals, ..self.clone() }
    }

    /// Draws these symbols so that roots have values where that can be seen beforehand; `state` has those that are given.
    pub(super) fn draw(
        &self,
        field: PrimeField,
        random: &mut Random,
        symbols: impl Iterator<Item = Symbol>,
        state: &mut FxHashMap<Symbol, Residue>,
    ) {
        let symbols: Vec<Symbol> = symbols.collect();
        self.positive.draw((&self.steps, &self.radicals), (field, random), &symbols, state);
    }

    /// Evaluates everything at a point whose symbols have the values `at`. `None` where something has no value.
    pub(super) fn point(
        &self,
        field: PrimeField,
        random: &mut Random,
        seed: u64,
        at: &dyn Fn(Symbol) -> Option<Residue>,
    ) -> Option<SamplePoint> {
        let mut same = Random::new(seed);
        let mut circle = |fixed: &bool| -> Option<(Residue, Residue)> {
            let tau = if *fixed { same.residue(&field) } else { random.residue(&field) };
            let square = field.mul(tau, tau);
            let below = field.inverse(field.add(field.one(), square))?;
            let sine = field.mul(field.add(tau, tau), below);
            Some((sine, field.mul(field.sub(field.one(), square), below)))
        };
        let circles: Vec<(Residue, Residue)> =
            self.circles.iter().map(&mut circle).collect::<Option<_>>()?;
        // exponentials are positive, so that they have roots
        let unit = |fixed: &bool| {
            let root = if *fixed { same.residue(&field) } else { random.residue(&field) };
            field.mul(root, root)
        };
        let units: Vec<Residue> = self.units.iter().map(unit).collect();
        let mut roots: FxHashMap<(usize, u64), Residue> = FxHashMap::default();
        let mut values = vec![Residue::ZERO; self.steps.len()];
        let mut companions = vec![Residue::ZERO; self.steps.len()];
        let unit_power = |parts: &[(usize, i64)]| {
            parts.iter().try_fold(field.one(), |product, &(unit, n)| {
                Some(field.mul(product, field.integer_power(units[unit], n)?))
            })
        };
        for (i, step) in self.steps.iter().enumerate() {
            values[i] = match step {
                NodeOperation::Constant => same.residue(&field),
                NodeOperation::Ln(_) | NodeOperation::Atan(_) => random.residue(&field),
                NodeOperation::Symbol(s) => at(*s)?,
                NodeOperation::Number(_) | NodeOperation::Sum(..) | NodeOperation::Product(..) => {
                    step.algebraic(field, &self.radicals, &values, &mut roots)?
                }
                NodeOperation::Sine(angle, _) | NodeOperation::Cosine(angle, _) => {
                    let (sine, cosine) = angle.open(&field, &circles);
                    let (value, companion) = match step {
                        NodeOperation::Sine(..) => (sine, cosine),
                        _ => (cosine, sine),
                    };
                    companions[i] = companion;
                    value
                }
                NodeOperation::Exp(parts, _) => unit_power(parts)?,
                NodeOperation::Sinh(parts, _) | NodeOperation::Cosh(parts, _) => {
                    let up = unit_power(parts)?;
                    let down = field.inverse(up)?;
                    let half = field.number(Number::HALF)?;
                    let sinh = field.mul(half, field.sub(up, down));
                    let cosh = field.mul(half, field.add(up, down));
                    let odd = matches!(step, NodeOperation::Sinh(..));
                    companions[i] = if odd { cosh } else { sinh };
                    if odd { sinh } else { cosh }
                }
            };
        }
        Some(SamplePoint { field, values, companions })
    }

    pub(super) fn value(&self, point: &SamplePoint, e: Expr) -> Residue {
        point.values[self.index[&e]]
    }

    /// The value of a symbol, zero if it occurs nowhere.
    pub(super) fn symbol_value(&self, point: &SamplePoint, symbol: Symbol) -> Residue {
        let is = |step: &NodeOperation| matches!(step, NodeOperation::Symbol(s) if *s == symbol);
        self.steps.iter().position(is).map_or(Residue::ZERO, |i| point.values[i])
    }

    /// The derivatives of everything along a direction, given by the rate of each symbol.
    pub(super) fn rates(
        &self,
        point: &SamplePoint,
        seed: &dyn Fn(Symbol) -> Residue,
    ) -> Option<ResidueRates> {
        let field = &point.field;
        let mut rates = vec![Residue::ZERO; self.steps.len()];
        for (i, step) in self.steps.iter().enumerate() {
            let (value, companion) = (point.values[i], point.companions[i]);
            rates[i] = match step {
                NodeOperation::Number(_) | NodeOperation::Constant => Residue::ZERO,
                NodeOperation::Symbol(s) => seed(*s),
                NodeOperation::Sum(_, terms) => {
                    let mut sum = Residue::ZERO;
                    for &(c, term) in terms.iter().filter(|(_, t)| !rates[*t].is_zero()) {
                        sum = field.add(sum, field.mul(field.number(c)?, rates[term]));
                    }
                    sum
                }
                NodeOperation::Product(_, factors) => {
                    if factors.iter().all(|&(base, ..)| rates[base].is_zero()) {
                        Residue::ZERO
                    } else {
                        let mut sum = Residue::ZERO;
                        for &(base, d, n) in factors.iter().filter(|f| !rates[f.0].is_zero()) {
                            // the rate of b^(n/d) is n/d · b^(n/d) · b'/b; a vanishing base is improbable
                            let exponent = field.number(Number::ratio(n.into(), d.into()))?;
                            let relative =
                                field.mul(rates[base], field.inverse(point.values[base])?);
                            sum = field.add(sum, field.mul(exponent, relative));
                        }
                        field.mul(value, sum)
                    }
                }
                NodeOperation::Sine(_, u) => field.mul(companion, rates[*u]),
                NodeOperation::Cosine(_, u) => field.neg(field.mul(companion, rates[*u])),
                NodeOperation::Exp(_, u) => field.mul(value, rates[*u]),
                NodeOperation::Sinh(_, u) | NodeOperation::Cosh(_, u) => {
                    field.mul(companion, rates[*u])
                }
                NodeOperation::Ln(u) if rates[*u].is_zero() => Residue::ZERO,
                NodeOperation::Ln(u) => field.mul(rates[*u], field.inverse(point.values[*u])?),
                NodeOperation::Atan(u) => {
                    let u2 = field.mul(point.values[*u], point.values[*u]);
                    field.mul(rates[*u], field.inverse(field.add(field.one(), u2))?)
                }
            };
        }
        Some(ResidueRates(rates))
    }

    pub(super) fn rate(&self, rates: &ResidueRates, e: Expr) -> Residue {
        rates.0[self.index[&e]]
    }
}

/// The derivatives of everything along one direction.
#[derive(Clone, Debug)]
pub(super) struct ResidueRates(Vec<Residue>);
