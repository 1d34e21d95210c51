//! Coefficients modulo a prime made into exact ones: rationals, and rational functions of the parameters.
//!
//! In: the monomials of one constant of the motion, which determine its coefficients up to a factor. Out: the
//! coefficients. They are guesses until the constant is proved. Never here: the proof.

use rustc_hash::FxHashMap;

use super::ansatz::Ansatz;
use super::atoms::Atoms;
use super::echelon::Echelon;
use super::evaluator::ResidueEvaluator;
use super::formula::cleared;
use super::law::Law;
use super::level::Ground;
use super::random::Random;
use crate::expr::{Expr, Pool, Symbol};
use crate::num::{Number, PrimeField, Residue, rational};

/// Bits by which a fraction from one prime has to be smaller than one by chance.
pub(super) const SPARE_BITS: u32 = 16;

/// The greatest total degree in the parameters of a coefficient that is no monomial.
const HIGHEST: u32 = 4;

/// The greatest number of unknown coefficients of such a function.
const MOST_TERMS: usize = 240;

/// What determines the values of functions of constants in the first sample.
const FIRST: u64 = 1_000;

/// The number of coefficients by which the others are divided in turn, to find the shortest form.
const MOST_LEADS: usize = 12;

/// Coefficients at random parameters, with each parameter quadrupled, and at others for a check.
struct Sampled<'a> {
    field: PrimeField,
    /// The column whose coefficient is one.
    lead: usize,
    at: &'a FxHashMap<Symbol, Residue>,
    first: Vec<Residue>,
    moved: Vec<(Symbol, Vec<Residue>)>,
    check_at: &'a FxHashMap<Symbol, Residue>,
    check: Vec<Residue>,
}

/// The one combination of some columns that is constant, with first coefficient 1; `None` if there is none or more
/// than one.
pub(super) fn only(
    ground: &Ground<'_>,
    atoms: &Atoms,
    ansatz: &Ansatz,
    columns: &[usize],
    random: &mut Random,
) -> Option<Vec<Residue>> {
    let basis = ground.null_space(atoms, ansatz, columns, random).ok()?;
    let [vector] = &basis[..] else { return None };
    let scale = ground.field.inverse(vector[0])?;
    Some(vector.iter().map(|&x| ground.field.mul(x, scale)).collect())
}

/// The rational coefficients of a combination known modulo one prime, whose first is 1.
pub(super) fn rationals(
    ground: &Ground<'_>,
    (atoms, ansatz): (&Atoms, &Ansatz),
    vector: &[(usize, Residue)],
    random: &mut Random,
) -> Option<Vec<Number>> {
    let p = u128::from(ground.field.prime());
    let simple = |spare| {
        vector.iter().map(|&(_, x)| ground.field.fraction(x, spare)).collect::<Option<Vec<_>>>()
    };
    if let Some(all) = simple(SPARE_BITS) {
        return Some(all);
    }
    // a second prime: x ≡ a (mod p), b (mod q)
    let columns: Vec<usize> = vector.iter().map(|(c, _)| *c).collect();
    for n in 0..crate::num::PRIMES.len() {
        let field = PrimeField::nth(n);
        if field == ground.field {
            continue;
        }
        let other = Ground {
            law: ground.law,
            evaluator: ground.evaluator,
            field,
            constants: FxHashMap::default(),
            seed: ground.seed,
            is_over: ground.is_over,
        };
        let Some(second) = only(&other, atoms, ansatz, &columns, random) else { continue };
        let q = u128::from(field.prime());
        let inverse = field.inverse(field.integer(i128::try_from(p).ok()?))?;
        let joined = vector.iter().zip(second).map(|(&(_, x), y)| {
            let a = u128::from(ground.field.value(x));
            let step = field.sub(y, field.integer(i128::try_from(a).ok()?));
            let k = u128::from(field.value(field.mul(step, inverse)));
            rational(a + p * k, p * q, 2 * SPARE_BITS)
        });
        return joined.collect();
    }
    None
}

/// The same constant of the motion for parameters that are symbols.
pub(super) struct Lift<'a> {
    pub(super) law: &'a Law,
    pub(super) evaluator: &'a ResidueEvaluator,
    pub(super) atoms: &'a Atoms,
    pub(super) ansatz: &'a Ansatz,
    pub(super) columns: Vec<usize>,
    pub(super) parameters: &'a [Symbol],
    /// What coefficients may be made of, with the highest powers: the parameters, and functions of them.
    pub(super) constants: &'a [(Expr, u32)],
    pub(super) is_over: &'a dyn Fn() -> bool,
}

impl Lift<'_> {
    fn sample(
        &self,
        field: PrimeField,
        values: &FxHashMap<Symbol, Residue>,
        seed: u64,
        random: &mut Random,
    ) -> Option<Vec<Residue>> {
        let ground = self.ground(field, values, seed);
        only(&ground, self.atoms, self.ansatz, &self.columns, random)
    }

    fn ground(
        &self,
        field: PrimeField,
        values: &FxHashMap<Symbol, Residue>,
        seed: u64,
    ) -> Ground<'_> {
        Ground {
            law: self.law,
            evaluator: self.evaluator,
            field,
            constants: values.clone(),
            seed,
            is_over: self.is_over,
        }
    }

    /// The values of the constants of which coefficients may be made.
    fn constants_at(
        &self,
        field: PrimeField,
        values: &FxHashMap<Symbol, Residue>,
        seed: u64,
        random: &mut Random,
    ) -> Option<Vec<Residue>> {
        let drawn = self.ground(field, values, seed).draw(random).ok()?;
        let all = self.constants.iter();
        Some(all.map(|(e, _)| self.evaluator.value(&drawn.point, *e)).collect())
    }

    /// Random parameters; squares, so that their roots exist.
    fn draw(&self, field: PrimeField, random: &mut Random) -> FxHashMap<Symbol, Residue> {
        let square = |&s: &Symbol| {
            let root = random.residue(&field);
            (s, field.mul(root, root))
        };
        self.parameters.iter().map(square).collect()
    }

    /// The coefficients as functions of the parameters, up to a common factor.
    pub(super) fn coefficients(
        &self,
        pool: &mut Pool,
        field: PrimeField,
        random: &mut Random,
    ) -> Option<Vec<Expr>> {
        let draw = |random: &mut Random| self.draw(field, random);
        let (at, first) = (0..20).find_map(|_| {
            let at = draw(random);
            Some((at.clone(), self.sample(field, &at, FIRST, random)?))
        })?;
        let four = field.residue(4);
        let mut scaled: Vec<(Symbol, Vec<Residue>)> = Vec::new();
        for &s in self.parameters {
            let mut moved = at.clone();
            moved.insert(s, field.mul(four, at[&s]));
            scaled.push((s, self.sample(field, &moved, FIRST, random)?));
        }
        let check_at = draw(random);
        let check = self.sample(field, &check_at, FIRST + 1, random)?;
        let mut dense: Option<Dense> = None;
        let mut best: Option<(u64, Vec<Expr>)> = None;
        for lead in 0..self.columns.len().min(MOST_LEADS) {
            let scale = |all: &[Residue]| -> Option<Vec<Residue>> {
                let by = field.inverse(all[lead])?;
                Some(all.iter().map(|&x| field.mul(x, by)).collect())
            };
            let moved = scaled.iter().map(|(s, all)| Some((*s, scale(all)?)));
            let Some(moved) = moved.collect::<Option<Vec<_>>>() else { continue };
            let (Some(first), Some(check)) = (scale(&first), scale(&check)) else { continue };
            let sampled =
                Sampled { field, lead, at: &at, first, moved, check_at: &check_at, check };
            let Some(all) = self.functions(pool, &sampled, &mut dense, random) else {
                continue;
            };
            let all = cleared(pool, &all);
            let weight = all.iter().map(|&e| pool.weight(e)).sum();
            if best.as_ref().is_none_or(|(least, _)| weight < *least) {
                best = Some((weight, all));
            }
            if dense.is_none() {
                break;
            }
        }
        best.map(|(_, all)| all)
    }

    /// The coefficients over that of one column.
    fn functions(
        &self,
        pool: &mut Pool,
        sampled: &Sampled<'_>,
        dense: &mut Option<Dense>,
        random: &mut Random,
    ) -> Option<Vec<Expr>> {
        let Sampled { field, lead, at, first, moved: scaled, check_at, check } = sampled;
        let (field, lead) = (*field, *lead);
        // functions of parameters show only in samples that differ in them
        let plain = self.constants.len() == self.parameters.len();
        let mut all = Vec::new();
        for i in 0..self.columns.len() {
            let monomial = monomial_of(field, at, first[i], i, scaled).filter(|_| plain);
            let fits = monomial.as_ref().is_some_and(|(c, powers)| {
                value_of(field, *c, powers, check_at).is_some_and(|x| x == check[i])
            });
            match monomial.filter(|_| fits) {
                Some((c, powers)) => {
                    let factors: Vec<(Expr, Number)> =
                        powers.iter().map(|&(s, n)| (pool.variable(s), n)).collect();
                    all.push(pool.monomial(c, &factors));
                }
                None => {
                    if dense.is_none() {
                        *dense = Some(Dense::of(self, pool, field, first, scaled, random)?);
                    }
                    all.push(dense.as_ref()?.function(pool, field, i, lead)?);
                }
            }
        }
        Some(all)
    }
}

/// c Π s^n with half-integer powers, as far as quadrupling each parameter shows.
fn monomial_of(
    field: PrimeField,
    at: &FxHashMap<Symbol, Residue>,
    value: Residue,
    i: usize,
    scaled: &[(Symbol, Vec<Residue>)],
) -> Option<(Number, Vec<(Symbol, Number)>)> {
    let below = field.inverse(value)?;
    let mut powers = Vec::new();
    let mut rest = value;
    for (s, moved) in scaled {
        let ratio = field.mul(moved[i], below);
        let two = field.residue(2);
        let twice = (-24_i64..=24).find(|&j| field.integer_power(two, j) == Some(ratio))?;
        if twice != 0 {
            let n = Number::ratio(twice.into(), 2);
            powers.push((*s, n));
            let root = field.root(at[s], 2)?;
            rest = field.mul(rest, field.integer_power(root, -twice)?);
        }
    }
    Some((field.fraction(rest, SPARE_BITS)?, powers))
}

fn value_of(
    field: PrimeField,
    c: Number,
    powers: &[(Symbol, Number)],
    at: &FxHashMap<Symbol, Residue>,
) -> Option<Residue> {
    powers.iter().try_fold(field.number(c)?, |whole, (s, n)| {
        let twice = (*n * Number::integer(2)).as_integer()?;
        Some(field.mul(whole, field.integer_power(field.root(at[s], 2)?, twice)?))
    })
}

/// Samples from which a rational function of the parameters is made.
struct Dense {
    constants: Vec<(Expr, u32)>,
    /// The values of the constants, and the coefficients.
    samples: Vec<(Vec<Residue>, Vec<Residue>)>,
}

impl Dense {
    fn of(
        lift: &Lift<'_>,
        pool: &Pool,
        field: PrimeField,
        first: &[Residue],
        scaled: &[(Symbol, Vec<Residue>)],
        random: &mut Random,
    ) -> Option<Dense> {
        // a parameter that changes no coefficient is left out
        let idle = |e: Expr| {
            let moved = |(s, moved): &&(Symbol, Vec<Residue>)| {
                pool.as_symbol(e) == Some(*s) && moved == first
            };
            scaled.iter().any(|pair| moved(&pair))
        };
        let used: Vec<usize> =
            (0..lift.constants.len()).filter(|&k| !idle(lift.constants[k].0)).collect();
        let constants: Vec<(Expr, u32)> = used.iter().map(|&k| lift.constants[k]).collect();
        let mut highest = HIGHEST;
        while highest > 1 && 2 * terms(&constants, highest).len() > MOST_TERMS {
            highest -= 1;
        }
        let wanted = 2 * terms(&constants, highest).len() + 8;
        if wanted > MOST_TERMS + 8 {
            return None;
        }
        let mut samples = Vec::new();
        let mut tries = 0;
        while samples.len() < wanted {
            tries += 1;
            if tries > 3 * wanted || (lift.is_over)() {
                return None;
            }
            let (at, seed) = (lift.draw(field, random), FIRST + 1 + tries as u64);
            if let Some(sample) = lift.sample(field, &at, seed, random)
                && let Some(values) = lift.constants_at(field, &at, seed, random)
            {
                samples.push((used.iter().map(|&k| values[k]).collect(), sample));
            }
        }
        Some(Dense { constants, samples })
    }

    /// The quotient of polynomials of least degree that the i-th coefficient is.
    fn function(&self, pool: &mut Pool, field: PrimeField, i: usize, lead: usize) -> Option<Expr> {
        for degree in 1..=HIGHEST {
            let terms = terms(&self.constants, degree);
            let n = terms.len();
            if 2 * n + 6 > self.samples.len() {
                return None;
            }
            let mut echelon = Echelon::new(field, 2 * n);
            for (at, values) in self.samples.iter().take(2 * n + 6) {
                let monomial = |powers: &Vec<u32>| {
                    at.iter().zip(powers).fold(field.one(), |whole, (&x, &k)| {
                        field.mul(whole, field.pow(x, k.into()))
                    })
                };
                let above: Vec<Residue> = terms.iter().map(monomial).collect();
                let value = field.mul(values[i], field.inverse(values[lead])?);
                let below = above.iter().map(|&m| field.neg(field.mul(m, value)));
                let row = above.iter().copied().chain(below).collect();
                echelon.add(row);
            }
            let basis = echelon.null_space();
            let nonzero = |v: &&Vec<Residue>| v[n..].iter().any(|x| !x.is_zero());
            let Some(vector) = basis.iter().find(nonzero) else { continue };
            let lead = vector.iter().rev().find(|x| !x.is_zero())?;
            let scale = field.inverse(*lead)?;
            let mut polynomial = |half: &[Residue]| -> Option<Expr> {
                let mut parts = Vec::new();
                for (powers, &x) in terms.iter().zip(half).filter(|(_, x)| !x.is_zero()) {
                    let coefficient = field.fraction(field.mul(x, scale), SPARE_BITS)?;
                    let factors: Vec<(Expr, Number)> = self
                        .constants
                        .iter()
                        .zip(powers)
                        .map(|(&(e, _), &k)| (e, Number::integer(k.into())))
                        .collect();
                    let monomial = pool.monomial(Number::ONE, &factors);
                    parts.push((coefficient, monomial));
                }
                Some(pool.linear(Number::ZERO, &parts))
            };
            let above = polynomial(&vector[..n])?;
            let below = polynomial(&vector[n..])?;
            return Some(pool.div(above, below));
        }
        None
    }
}

/// The exponents of all monomials of some constants up to a degree.
fn terms(constants: &[(Expr, u32)], degree: u32) -> Vec<Vec<u32>> {
    let mut all: Vec<Vec<u32>> = vec![Vec::new()];
    for &(_, highest) in constants {
        all = all
            .into_iter()
            .flat_map(|m| {
                let left = degree - m.iter().sum::<u32>();
                (0..=left.min(highest)).map(move |k| {
                    let mut longer = m.clone();
                    longer.push(k);
                    longer
                })
            })
            .collect();
    }
    all
}
