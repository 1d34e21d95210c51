//! The monomials whose linear combinations are searched.
//!
//! In: generators and degrees. Out: columns, and their values and rates at points. Never here: what is done with them.

use super::atoms::Atoms;
use super::evaluator::ResidueEvaluator;
use super::law::DrawnPoint;
use super::random::Random;
use crate::expr::{Expr, Pool};
use crate::num::{Number, PrimeField, Residue};

type MonomialExponents = Vec<u32>;

/// A finite set of monomials: one in the momenta times one in the other generators.
#[derive(Clone, Debug)]
pub(super) struct Ansatz {
    momenta: Vec<MonomialExponents>,
    coefficients: Vec<MonomialExponents>,
    /// The two factors of each column; by ascending degree.
    pub(super) columns: Vec<(usize, usize)>,
    /// The greatest degree of the coefficients of each degree in the momenta.
    pub(super) bounds: Vec<(u32, u32)>,
}

/// The value of each column, and its rate.
pub(super) struct AnsatzRow {
    pub(super) values: Vec<Residue>,
    pub(super) rates: Vec<Residue>,
}

/// How many monomials of that many generators there are up to a degree, counted no further than `most`.
fn count(generators: usize, degree: u32, most: usize) -> usize {
    let mut count = 1_usize;
    for k in 1..=generators {
        count = count.saturating_mul(degree as usize + k) / k;
        if count > most.saturating_mul(1000) {
            return usize::MAX;
        }
    }
    count
}

impl Ansatz {
    /// The monomials within bounds: for each degree in the momenta, the greatest degree of the coefficient. `None` if
    /// there are more than `most`.
    pub(super) fn new(atoms: &Atoms, bounds: Vec<(u32, u32)>, most: usize) -> Option<Ansatz> {
        let greatest = bounds.iter().map(|&(_, n)| n).max().unwrap_or(0);
        let highest: Vec<u32> = atoms.coefficients.iter().map(|g| g.highest).collect();
        if count(highest.len(), greatest, most) > 400 * most {
            return None;
        }
        let mut coefficients = Vec::new();
        for degree in 0..=greatest {
            monomials(&highest, degree, &mut |m| {
                let excluded = |&(a, b): &(usize, usize)| m[a] > 0 && m[b] > 0;
                if !atoms.excluded.iter().any(excluded) {
                    coefficients.push(m.to_vec());
                }
            });
        }
        let mut momenta: Vec<MonomialExponents> = Vec::new();
        let unlimited = vec![u32::MAX; atoms.momenta.len()];
        let mut columns: Vec<(usize, usize)> = Vec::new();
        for &(k, bound) in &bounds {
            if count(unlimited.len(), k, most) > most {
                return None;
            }
            monomials(&unlimited, k, &mut |m| momenta.push(m.to_vec()));
            let within = coefficients.iter().take_while(|m| m.iter().sum::<u32>() <= bound).count();
            let begin = momenta.iter().position(|m| m.iter().sum::<u32>() == k).unwrap_or(0);
            if (momenta.len() - begin).saturating_mul(within) + columns.len() > most {
                return None;
            }
            for a in begin..momenta.len() {
                columns.extend((0..within).map(|b| (a, b)));
            }
        }
        let mut ansatz = Ansatz { momenta, coefficients, columns, bounds };
        let degree = |m: &[u32]| m.iter().sum::<u32>();
        let mut columns = std::mem::take(&mut ansatz.columns);
        columns.sort_by_key(|&(a, b)| degree(&ansatz.momenta[a]) + degree(&ansatz.coefficients[b]));
        ansatz.columns = columns;
        Some(ansatz)
    }

    pub(super) fn degree(&self, column: usize) -> u32 {
        self.momenta[self.columns[column].0].iter().sum()
    }

    /// The class of a column: by which of the law's reflections it changes its sign.
    pub(super) fn class(&self, atoms: &Atoms, column: usize) -> u64 {
        let (a, b) = self.columns[column];
        let odd = |exponents: &[u32], signs: &[bool]| {
            exponents.iter().zip(signs).filter(|(n, odd)| **odd && **n % 2 == 1).count() % 2 == 1
        };
        let reflections = atoms.reflections.iter().take(u64::BITS as usize).enumerate();
        reflections.fold(0, |class, (i, reflection)| {
            let momenta = odd(&self.momenta[a], &reflection.momenta);
            let coefficients = odd(&self.coefficients[b], &reflection.coefficients);
            class | u64::from(momenta != coefficients) << i
        })
    }

    /// The greatest total degree of some columns.
    pub(super) fn total(&self, columns: &[usize]) -> u32 {
        let degree = |&c: &usize| {
            let (a, b) = self.columns[c];
            self.momenta[a].iter().chain(&self.coefficients[b]).sum::<u32>()
        };
        columns.iter().map(degree).max().unwrap_or(0)
    }

    /// Whether a column is the constant 1.
    pub(super) fn expression_is_one(&self, column: usize) -> bool {
        let (a, b) = self.columns[column];
        self.momenta[a].iter().chain(&self.coefficients[b]).all(|&n| n == 0)
    }

    /// The values and rates of some columns at a point.
    pub(super) fn row(
        &self,
        atoms: &Atoms,
        evaluator: &ResidueEvaluator,
        drawn: &DrawnPoint,
        columns: &[usize],
    ) -> AnsatzRow {
        let field = drawn.point.field;
        let tables = |all: &[MonomialExponents], generators: &[Expr]| -> Vec<(Residue, Residue)> {
            let powers: Vec<Vec<(Residue, Residue)>> = generators
                .iter()
                .enumerate()
                .map(|(i, &g)| {
                    let value = evaluator.value(&drawn.point, g);
                    let rate = evaluator.rate(&drawn.rates, g);
                    let top = all.iter().map(|m| m[i]).max().unwrap_or(0);
                    let mut powers = vec![(field.one(), Residue::ZERO)];
                    for k in 0..top as usize {
                        powers.push(product(field, powers[k], (value, rate)));
                    }
                    powers
                })
                .collect();
            let whole = |m: &MonomialExponents| {
                m.iter()
                    .enumerate()
                    .filter(|(_, n)| **n > 0)
                    .fold((field.one(), Residue::ZERO), |whole, (i, &n)| {
                        product(field, whole, powers[i][n as usize])
                    })
            };
            all.iter().map(whole).collect()
        };
        let momenta = tables(&self.momenta, &atoms.momenta);
        let generators: Vec<Expr> = atoms.coefficients.iter().map(|g| g.expression).collect();
        let coefficients = tables(&self.coefficients, &generators);
        let mut row = AnsatzRow { values: Vec::new(), rates: Vec::new() };
        for &c in columns {
            let (a, b) = self.columns[c];
            let (value, rate) = product(field, momenta[a], coefficients[b]);
            row.values.push(value);
            row.rates.push(rate);
        }
        row
    }

    pub(super) fn expression(&self, pool: &mut Pool, atoms: &Atoms, column: usize) -> Expr {
        let (a, b) = self.columns[column];
        let momenta = atoms.momenta.iter().zip(&self.momenta[a]);
        let others = atoms.coefficients.iter().map(|g| &g.expression).zip(&self.coefficients[b]);
        let factors: Vec<(Expr, Number)> = momenta
            .chain(others)
            .filter(|(_, n)| **n > 0)
            .map(|(&e, &n)| (e, Number::integer(n.into())))
            .collect();
        pool.monomial(Number::ONE, &factors)
    }
}

/// (f g, f' g + f g').
fn product(field: PrimeField, f: (Residue, Residue), g: (Residue, Residue)) -> (Residue, Residue) {
    let rate = field.add(field.mul(f.1, g.0), field.mul(f.0, g.1));
    (field.mul(f.0, g.0), rate)
}

/// All exponents of a total degree, none above its limit, in a fixed order.
fn monomials(highest: &[u32], degree: u32, found: &mut dyn FnMut(&[u32])) {
    fn go(highest: &[u32], left: u32, i: usize, m: &mut Vec<u32>, found: &mut dyn FnMut(&[u32])) {
        if i + 1 == highest.len() {
            if left <= highest[i] {
                m[i] = left;
                found(m);
                m[i] = 0;
            }
            return;
        }
        for n in (0..=left.min(highest[i])).rev() {
            m[i] = n;
            go(highest, left - n, i + 1, m, found);
        }
        m[i] = 0;
    }
    let mut m = vec![0; highest.len()];
    if highest.is_empty() {
        if degree == 0 {
            found(&m);
        }
        return;
    }
    go(highest, degree, 0, &mut m, found);
}

/// Random orders of `n` columns, the first two ascending and descending.
pub(super) fn orders(n: usize, count: usize) -> Vec<Vec<usize>> {
    let ascending: Vec<usize> = (0..n).collect();
    let mut all = vec![ascending.clone(), ascending.iter().rev().copied().collect()];
    let mut random = Random::new(n as u64);
    while all.len() < count {
        let mut order = ascending.clone();
        for i in (1..n).rev() {
            order.swap(i, (random.next() % (i as u64 + 1)) as usize);
        }
        all.push(order);
    }
    all
}
