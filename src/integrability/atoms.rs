//! The functions of which a constant of the motion may be a polynomial: what the law itself is made of.
//!
//! In: a law. Out: [`MonomialGenerator`]s: momenta (or velocities, or the variables of a Poisson system), coordinates that enter
//! algebraically, sines and cosines of angles, roots, exponentials, reciprocals, and which of them never stand
//! together. Never here: monomials, numbers.

use std::collections::BTreeMap;

use super::law::Law;
use super::reflection::{self, Reflection};
use super::units::terms;
use crate::expr::{Expr, FunctionId, Node, Pool, Symbol};
use crate::num::Number;

/// One of the functions from which monomials are made.
#[derive(Clone, Debug)]
pub(super) struct MonomialGenerator {
    pub(super) expression: Expr,
    /// The highest power that may occur; higher ones are polynomials in the others.
    pub(super) highest: u32,
}

/// How coordinates enter that the law does not contain, and into what angles are divided.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct AnsatzFamily {
    /// Absent coordinates enter by their sine and cosine, and not by themselves.
    pub(super) absent_by_angle: bool,
    pub(super) half_angles: bool,
}

#[derive(Clone, Debug)]
pub(super) struct Atoms {
    pub(super) momenta: Vec<Expr>,
    pub(super) coefficients: Vec<MonomialGenerator>,
    /// Pairs of coefficients that never stand together: their product is a polynomial in the others.
    pub(super) excluded: Vec<(usize, usize)>,
    /// Whether the generators satisfy no algebraic relation.
    pub(super) free: bool,
    /// The reflections that leave the law as it is.
    pub(super) reflections: Vec<Reflection>,
    momentum_symbols: Vec<Symbol>,
    /// The generator e^(c u) of each primitive argument u.
    exponentials: Vec<(Expr, Number)>,
    pub(super) family: AnsatzFamily,
}

#[derive(Default)]
struct LawAtoms {
    algebraic: Vec<Symbol>,
    /// Each term of an angle with the least common denominator of its coefficients.
    angles: Vec<(Expr, i64)>,
    exponents: Vec<(Expr, Vec<Number>)>,
    hyperbolic: Vec<Expr>,
    /// Bases with their exponents that are no whole number above zero.
    powers: Vec<(Expr, Vec<Number>)>,
    /// Logarithms and arctangents.
    others: Vec<Expr>,
    reciprocal_sines: Vec<Expr>,
}

impl Atoms {
    /// The generators of a law, whose parameters are numbers.
    pub(super) fn of(pool: &mut Pool, law: &Law, angles: &[Symbol], family: AnsatzFamily) -> Atoms {
        let mut moving: Vec<Symbol> = law.variables.clone();
        moving.push(law.time);
        let roots = law.expressions();
        let found = LawAtoms::of(pool, &roots, &moving);
        let momentum_symbols = law.momenta().to_vec();
        let mut atoms = Atoms {
            momenta: Vec::new(),
            coefficients: Vec::new(),
            excluded: Vec::new(),
            free: true,
            reflections: Vec::new(),
            momentum_symbols: momentum_symbols.clone(),
            exponentials: Vec::new(),
            family,
        };
        for &p in &momentum_symbols {
            let p = pool.variable(p);
            atoms.momenta.push(p);
        }
        let positions =
            if law.positions == 0 { &law.variables[..] } else { &law.variables[..law.positions] };
        let energy = law.expressions();
        for &q in positions {
            let present = energy.iter().any(|&e| pool.depends(e, q));
            let by_angle = !present && (family.absent_by_angle || angles.contains(&q));
            if by_angle {
                let q = pool.variable(q);
                atoms.add_angle(pool, q, if family.half_angles { 2 } else { 1 });
            } else if !present || found.algebraic.contains(&q) {
                let q = pool.variable(q);
                atoms.add(q, u32::MAX);
            }
        }
        if found.algebraic.contains(&law.time) {
            let time = pool.variable(law.time);
            atoms.add(time, u32::MAX);
        }
        for (term, d) in &found.angles {
            let d = if family.half_angles { 2 * d } else { *d };
            atoms.add_angle(pool, *term, d);
        }
        for (argument, multiples) in &found.exponents {
            atoms.add_exponential(pool, *argument, multiples);
        }
        for &argument in &found.hyperbolic {
            let sinh = pool.call(FunctionId::Sinh, &[argument]);
            let cosh = pool.call(FunctionId::Cosh, &[argument]);
            atoms.add(sinh, u32::MAX);
            atoms.add(cosh, 1);
            atoms.free = false;
        }
        for (base, exponents) in &found.powers {
            atoms.add_powers(pool, *base, exponents);
        }
        for &sine in &found.reciprocal_sines {
            atoms.add_powers(pool, sine, &[Number::MINUS_ONE]);
        }
        for &e in &found.others {
            atoms.add(e, u32::MAX);
        }
        let coefficients: Vec<Expr> = atoms.coefficients.iter().map(|g| g.expression).collect();
        atoms.reflections = reflection::of(pool, law, &atoms.momenta, &coefficients);
        atoms
    }

    fn add(&mut self, expression: Expr, highest: u32) -> usize {
        if let Some(known) = self.coefficients.iter().position(|g| g.expression == expression) {
            return known;
        }
        self.coefficients.push(MonomialGenerator { expression, highest });
        self.coefficients.len() - 1
    }

    fn add_angle(&mut self, pool: &mut Pool, term: Expr, denominator: i64) {
        let argument = pool.scale(Number::Rational(1, denominator), term);
        let sine = pool.call(FunctionId::Sin, &[argument]);
        let cosine = pool.call(FunctionId::Cos, &[argument]);
        self.add(sine, u32::MAX);
        self.add(cosine, 1);
        self.free = false;
    }

    fn add_exponential(&mut self, pool: &mut Pool, argument: Expr, multiples: &[Number]) {
        let smallest = multiples.iter().map(|c| c.abs()).min().unwrap_or(Number::ONE);
        let whole = multiples.iter().all(|&c| (c * smallest.recip()).as_integer().is_some());
        let unit = if whole {
            smallest
        } else {
            let d = multiples.iter().map(|c| if let Number::Rational(_, d) = c { *d } else { 1 });
            Number::Rational(1, d.product())
        };
        let mut both = Vec::new();
        for (sign, wanted) in [
            (Number::ONE, multiples.iter().any(|c| !c.is_negative())),
            (Number::MINUS_ONE, multiples.iter().any(|c| c.is_negative())),
        ] {
            if wanted {
                let argument = pool.scale(sign * unit, argument);
                let e = pool.call(FunctionId::Exp, &[argument]);
                both.push(self.add(e, u32::MAX));
            }
        }
        if let [up, down] = both[..] {
            self.excluded.push((up, down));
        }
        // products of exponentials of different arguments may be related
        self.free &= self.exponentials.is_empty() && both.len() < 2;
        self.exponentials.push((argument, unit));
    }

    fn add_powers(&mut self, pool: &mut Pool, base: Expr, exponents: &[Number]) {
        let d = exponents.iter().fold(1, |d, n| match n {
            Number::Rational(_, own) if d % own != 0 => d * own,
            _ => d,
        });
        let mut both: Vec<usize> = Vec::new();
        if exponents.iter().any(|n| n.is_negative()) {
            let inverse = pool.monomial(Number::ONE, &[(base, Number::Rational(-1, d))]);
            both.push(self.add(inverse, u32::MAX));
            if d == 1
                && let Some(own) = self.coefficients.iter().position(|g| g.expression == base)
            {
                both.push(own);
            }
        }
        if d > 1 && exponents.iter().any(|n| !n.is_negative()) {
            let root = pool.monomial(Number::ONE, &[(base, Number::Rational(1, d))]);
            // a higher power is a polynomial in the others, of the degree of the base
            let degree = self.degrees(pool, base).into_values().max().unwrap_or(0);
            let highest =
                if i128::from(degree) > i128::from(d) { u32::MAX } else { (d - 1) as u32 };
            both.push(self.add(root, highest));
        }
        if let [a, b] = both[..] {
            self.excluded.push((a, b));
        }
        self.free = false;
    }

    /// The greatest degree of the coefficients of each degree in the momenta, as the expression is written.
    pub(super) fn degrees(&self, pool: &mut Pool, e: Expr) -> BTreeMap<u32, u32> {
        let mut known: BTreeMap<Expr, BTreeMap<u32, u32>> = BTreeMap::new();
        for part in pool.reachable(&[e]) {
            let degrees = match &pool.node(part).clone() {
                Node::Number(_) | Node::Pi => BTreeMap::from([(0, 0)]),
                Node::Symbol(s) if self.momentum_symbols.contains(s) => BTreeMap::from([(1, 0)]),
                Node::Symbol(_) => {
                    let own = self.coefficients.iter().any(|g| g.expression == part);
                    BTreeMap::from([(0, u32::from(own))])
                }
                Node::Sum(_, parts) => {
                    let mut all = BTreeMap::from([(0, 0)]);
                    for (_, part) in parts {
                        for (&k, &degree) in &known[part] {
                            let entry = all.entry(k).or_insert(0);
                            *entry = degree.max(*entry);
                        }
                    }
                    all
                }
                Node::Product(_, factors) => {
                    let mut all = BTreeMap::from([(0, 0)]);
                    for &(base, n) in factors {
                        let power = power_degrees(&known[&base], n);
                        all = convolved(&all, &power);
                    }
                    all
                }
                Node::Call(FunctionId::Exp, u) => {
                    let degree = unit_of(pool, u[0]).and_then(|(argument, c)| {
                        let (_, unit) = self.exponentials.iter().find(|(a, _)| *a == argument)?;
                        (c * unit.recip()).as_integer()
                    });
                    BTreeMap::from([(0, degree.map_or(1, |n| n.unsigned_abs() as u32))])
                }
                Node::Call(FunctionId::Sin | FunctionId::Cos, u) => {
                    let halves = if self.family.half_angles { 2.0 } else { 1.0 };
                    let turns: f64 =
                        terms(pool, u[0]).iter().map(|(c, _)| c.value().abs().ceil()).sum();
                    BTreeMap::from([(0, (halves * turns) as u32)])
                }
                Node::Power(..) | Node::Call(..) => BTreeMap::from([(0, 1)]),
            };
            known.insert(part, degrees);
        }
        known.remove(&e).unwrap_or_default()
    }
}

fn power_degrees(base: &BTreeMap<u32, u32>, n: Number) -> BTreeMap<u32, u32> {
    match n.as_integer() {
        Some(n @ 0..=12) => {
            let once = BTreeMap::from([(0, 0)]);
            (0..n).fold(once, |power, _| convolved(&power, base))
        }
        _ => {
            let Number::Rational(above, _) = n else { return BTreeMap::from([(0, 1)]) };
            BTreeMap::from([(0, above.unsigned_abs().min(64) as u32)])
        }
    }
}

fn convolved(a: &BTreeMap<u32, u32>, b: &BTreeMap<u32, u32>) -> BTreeMap<u32, u32> {
    let mut all = BTreeMap::new();
    for (&k, &m) in a {
        for (&l, &n) in b {
            let entry = all.entry(k + l).or_insert(0);
            *entry = (*entry).max(m + n);
        }
    }
    all
}

/// An argument as a multiple of one whose first coefficient is 1.
fn unit_of(pool: &mut Pool, argument: Expr) -> Option<(Expr, Number)> {
    let (first, _) = *terms(pool, argument).first()?;
    Some((pool.scale(first.recip(), argument), first))
}

/// Whether a function of the momenta is even (`true`) or odd in them all together, as it is written.
pub(super) fn parity(pool: &Pool, e: Expr, momenta: &[Symbol]) -> Option<bool> {
    let mut known: BTreeMap<Expr, Option<bool>> = BTreeMap::new();
    for part in pool.reachable(&[e]) {
        let even = |e: &Expr| known[e] == Some(true);
        let parity = match pool.node(part) {
            Node::Number(_) | Node::Pi => Some(true),
            Node::Symbol(s) => Some(!momenta.contains(s)),
            Node::Sum(c, parts) => {
                let first = known[&parts[0].1];
                let alike = parts.iter().all(|(_, t)| known[t] == first);
                first.filter(|&even| alike && (even || c.is_zero()))
            }
            Node::Product(_, factors) => {
                factors.iter().try_fold(true, |whole, (base, n)| match n.as_integer() {
                    Some(n) => known[base].map(|even| whole == (even || n % 2 == 0)),
                    None => even(base).then_some(whole),
                })
            }
            Node::Power(a, b) => (even(a) && even(b)).then_some(true),
            Node::Call(_, u) => u.iter().all(even).then_some(true),
        };
        known.insert(part, parity);
    }
    known.remove(&e).flatten()
}

impl LawAtoms {
    fn of(pool: &mut Pool, roots: &[Expr], moving: &[Symbol]) -> LawAtoms {
        let mut found = LawAtoms::default();
        let mut stack: Vec<Expr> = roots.to_vec();
        let mut seen: rustc_hash::FxHashSet<Expr> = rustc_hash::FxHashSet::default();
        while let Some(e) = stack.pop() {
            if !seen.insert(e) || !pool.depends_on_any(e, moving) {
                continue;
            }
            match pool.node(e).clone() {
                Node::Symbol(s) => found.algebraic.push(s),
                Node::Call(function, u) => found.call(pool, function, &u, e, &mut stack),
                Node::Product(_, factors) => {
                    for (base, n) in factors {
                        stack.push(base);
                        let whole = n.as_integer().is_some_and(|n| n > 0);
                        if !whole && pool.depends_on_any(base, moving) {
                            // x − y and y − x have the same powers up to a sign
                            let opposite = pool.neg(base);
                            let known = n.as_integer().is_some()
                                && found.powers.iter().any(|(b, _)| *b == opposite);
                            let base = if known { opposite } else { base };
                            push_to(&mut found.powers, base, n);
                        }
                    }
                }
                other => stack.extend(other.parts()),
            }
        }
        // the order of discovery is that of a stack; the order of handles is that of writing
        found.angles.sort_unstable();
        found.exponents.sort_unstable_by_key(|(e, _)| *e);
        found.powers.sort_unstable_by_key(|(e, _)| *e);
        found
    }

    fn call(
        &mut self,
        pool: &mut Pool,
        function: FunctionId,
        u: &[Expr],
        e: Expr,
        stack: &mut Vec<Expr>,
    ) {
        match function {
            FunctionId::Sin | FunctionId::Cos | FunctionId::Tan | FunctionId::Cot => {
                for (c, term) in terms(pool, u[0]) {
                    let Number::Rational(_, d) = c else { continue };
                    match self.angles.iter_mut().find(|(t, _)| *t == term) {
                        Some((_, known)) if *known % d != 0 => *known *= d,
                        Some(_) => {}
                        None => self.angles.push((term, d)),
                    }
                }
                if matches!(function, FunctionId::Tan | FunctionId::Cot) {
                    let below =
                        if function == FunctionId::Tan { FunctionId::Cos } else { FunctionId::Sin };
                    let below = pool.call(below, u);
                    self.reciprocal_sines.push(below);
                }
            }
            FunctionId::Exp => {
                let Some((unit, first)) = unit_of(pool, u[0]) else { return };
                push_to(&mut self.exponents, unit, first);
            }
            FunctionId::Sinh | FunctionId::Cosh | FunctionId::Tanh => {
                if !self.hyperbolic.contains(&u[0]) {
                    self.hyperbolic.push(u[0]);
                }
                if function == FunctionId::Tanh {
                    let below = pool.call(FunctionId::Cosh, u);
                    self.reciprocal_sines.push(below);
                }
            }
            _ => {
                self.others.push(e);
                stack.extend(u);
            }
        }
    }
}

fn push_to(all: &mut Vec<(Expr, Vec<Number>)>, key: Expr, n: Number) {
    match all.iter_mut().find(|(e, _)| *e == key) {
        Some((_, known)) => known.push(n),
        None => all.push((key, vec![n])),
    }
}
