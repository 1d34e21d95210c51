//! What the nodes of an expression are made of, as far as their residues go.
//!
//! In: the residues of the parts of a sum or product, of the units of an angle. Out: that of the whole. Never here: points.

use rustc_hash::FxHashMap;

use super::radicals::Radicals;
use crate::expr::Symbol;
use crate::num::{Number, PrimeField, Residue};

/// One node in terms of those before it.
#[derive(Clone, Debug)]
pub(super) enum NodeOperation {
    Number(Number),
    /// The same residue at every point of a seed: π, and a logarithm or arctangent of a constant.
    Constant,
    Symbol(Symbol),
    Sum(Number, Vec<(Number, usize)>),
    /// A coefficient and factors: base, the order of the root taken of it, the power of that root.
    Product(Number, Vec<(usize, u64, i64)>),
    /// The sine (or cosine) of the sum of multiples of the arguments of units, and quarter turns.
    Sine(Angle, usize),
    Cosine(Angle, usize),
    /// Of the product of powers of units.
    Exp(Vec<(usize, i64)>, usize),
    Sinh(Vec<(usize, i64)>, usize),
    Cosh(Vec<(usize, i64)>, usize),
    /// A random residue, and the node of its argument.
    Ln(usize),
    Atan(usize),
}

/// Multiples of units, and quarter turns.
#[derive(Clone, Debug)]
pub(super) struct Angle {
    pub(super) parts: Vec<(usize, i64)>,
    pub(super) quarters: i64,
}

impl NodeOperation {
    /// The nodes that a sum or product is made of; `None` for anything else.
    pub(super) fn parts(&self) -> Option<Box<dyn Iterator<Item = usize> + '_>> {
        match self {
            NodeOperation::Sum(_, terms) => Some(Box::new(terms.iter().map(|&(_, term)| term))),
            NodeOperation::Product(_, factors) => Some(Box::new(factors.iter().map(|f| f.0))),
            _ => None,
        }
    }

    /// The value of a number, sum or product of nodes that have values; `roots` has the roots taken so far. `None` for
    /// another function.
    pub(super) fn algebraic(
        &self,
        field: PrimeField,
        radicals: &Radicals,
        values: &[Residue],
        roots: &mut FxHashMap<(usize, u64), Residue>,
    ) -> Option<Residue> {
        match self {
            NodeOperation::Number(n) => field.number(*n),
            NodeOperation::Sum(c, terms) => {
                let mut sum = field.number(*c)?;
                for &(c, term) in terms {
                    let term = values[term];
                    sum = if c.is_one() {
                        field.add(sum, term)
                    } else {
                        field.add(sum, field.mul(field.number(c)?, term))
                    };
                }
                Some(sum)
            }
            NodeOperation::Product(c, factors) => {
                let mut product = field.number(*c)?;
                for &(base, d, n) in factors {
                    let root = match roots.get(&(base, d)) {
                        Some(&root) => root,
                        None => {
                            let root = field.root(values[base], d)?;
                            let sign = radicals.of.get(&base);
                            let negative = sign.is_some_and(|k| radicals.negative >> k & 1 == 1);
                            let root = if negative { field.neg(root) } else { root };
                            roots.insert((base, d), root);
                            root
                        }
                    };
                    product = field.mul(product, field.integer_power(root, n)?);
                }
                Some(product)
            }
            _ => None,
        }
    }
}

impl Angle {
    /// Its sine and cosine.
    pub(super) fn open(
        &self,
        field: &PrimeField,
        circles: &[(Residue, Residue)],
    ) -> (Residue, Residue) {
        let one = field.one();
        let mut whole = match self.quarters.rem_euclid(4) {
            0 => (Residue::ZERO, one),
            1 => (one, Residue::ZERO),
            2 => (Residue::ZERO, field.neg(one)),
            _ => (field.neg(one), Residue::ZERO),
        };
        let turn = |a: (Residue, Residue), b: (Residue, Residue)| {
            let sine = field.add(field.mul(a.0, b.1), field.mul(a.1, b.0));
            (sine, field.sub(field.mul(a.1, b.1), field.mul(a.0, b.0)))
        };
        for &(unit, n) in &self.parts {
            let (sine, cosine) = circles[unit];
            let mut power = if n < 0 { (field.neg(sine), cosine) } else { (sine, cosine) };
            let mut n = n.unsigned_abs();
            while n > 0 {
                if n & 1 == 1 {
                    whole = turn(whole, power);
                }
                power = turn(power, power);
                n >>= 1;
            }
        }
        whole
    }
}
