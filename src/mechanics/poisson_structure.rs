//! Checks that given brackets are a Poisson structure (Jacobi's identity), and that given Casimirs
//! are Casimirs (B ∇C = 0): by proof, or to 1e-10 of the size of the terms at twenty points near
//! the start and wherever they have values at any distance from it.
//!
//! In: a model and its equations. Out: a [`StructureError`] with its place for each
//! false statement. Never here: antisymmetry, which the reader of files ensures.
//! Source: *The Principles of Dynamics*, § 3.2.3; Hairer, Lubich & Wanner, *Geometric Numerical
//! Integration*, § VII.2.

use super::equations::Equations;
use super::rigid_body;
use super::sampling::{ANY_POINTS, POINTS, TRIES};
use super::structure_error::StructureError;
use super::valuation::Valuation;
use crate::diagnostic::SourceRange;
use crate::expr::{Expr, Zero};
use crate::model::{Mechanics, Model};

/// Values below this, relative to the size of the terms, count as zero.
const TOLERANCE: f64 = 1e-10;

/// The largest number of products multiplied out in search of a proof; beyond it, values decide.
const PROOF_PRODUCTS: usize = 20_000;

/// The largest number of nodes of an expression that a message quotes.
const LONGEST: u64 = 60;

/// Finds what is false in the brackets and Casimirs of a Poisson system, meaningless in a body, or cannot be written down of
/// transformations.
pub fn structure_errors(model: &Model, equations: &Equations) -> Vec<StructureError> {
    let mut structure_errors =
        rigid_body::structure_errors(model, &equations.pool, equations.supplements.body.as_ref());
    structure_errors.extend(super::group::structure_errors(model, equations));
    structure_errors.extend(super::vakonomic::structure_errors(model, equations));
    let Mechanics::Poisson { brackets, casimirs, place, .. } = &model.mechanics else {
        return structure_errors;
    };
    let points: Vec<Valuation> =
        (0..TRIES).map(|n| Valuation::near_start(model, equations, n)).collect();
    let far = (0..ANY_POINTS).map(|n| Valuation::at_any_distance(model, equations, n)).collect();
    let mut structure = Structure { model, equations: equations.clone(), brackets, points, far };
    structure_errors.extend(structure.jacobi(place));
    for (name, casimir, place) in casimirs {
        structure_errors.extend(structure.casimir(name, *casimir, place));
    }
    structure_errors
}

/// The brackets being checked.
struct Structure<'a> {
    model: &'a Model,
    equations: Equations,
    brackets: &'a [Vec<Expr>],
    points: Vec<Valuation>,
    far: Vec<Valuation>,
}

/// Three variables and the terms B_il ∂_l B_jk of their identity, as pairs of factors.
type Triple = ([usize; 3], Vec<(Expr, Expr)>);

impl Structure<'_> {
    /// {x_i, {x_j, x_k}} + cyclic = Σ_l B_il ∂_l B_jk + cyclic = 0 for any three variables.
    fn jacobi(&mut self, place: &SourceRange) -> Option<StructureError> {
        let triples = self.triples();
        let products: usize = triples.iter().map(|(_, terms)| terms.len()).sum();
        let mut failing = Vec::new();
        for (triple, terms) in &triples {
            failing.extend(self.sum(terms, products < PROOF_PRODUCTS).map(|is| (triple, is)));
        }
        let (triple, is) = failing.first()?;
        let [i, j, k] = triple.map(|i| self.model.coordinates[i].name.as_str());
        let message = format!("these brackets break Jacobi's identity for {i}, {j}, {k}");
        let identity = format!(
            "{{{i}, {{{j}, {k}}}}} + {{{j}, {{{k}, {i}}}}} + {{{k}, {{{i}, {j}}}}} {is}, not 0"
        );
        let help = match failing.len() {
            1 => identity,
            2 => format!("{identity}; and for one other three"),
            n => format!("{identity}; and for {} other threes", n - 1),
        };
        Some(StructureError { place: Some(place.clone()), message, help })
    }

    /// Σ B_ij ∂_j C = 0 for every x_i.
    fn casimir(
        &mut self,
        name: &str,
        casimir: Expr,
        place: &SourceRange,
    ) -> Option<StructureError> {
        let coordinates = &self.model.coordinates;
        let slopes: Vec<Expr> = coordinates
            .iter()
            .map(|c| self.equations.pool.derivative(casimir, c.position))
            .collect();
        for (c, row) in coordinates.iter().zip(self.brackets) {
            let terms = row.iter().copied().zip(slopes.iter().copied());
            let terms: Vec<(Expr, Expr)> =
                terms.filter(|(b, s)| *b != Expr::ZERO && *s != Expr::ZERO).collect();
            let Some(is) = self.sum(&terms, true) else { continue };
            let message = format!("`{name}` is not a Casimir of these brackets");
            let mut help = format!("{{{}, {name}}} {is}, not 0", c.name);
            if self.equations.is_conserved(casimir) == Some(Zero::Proved) {
                help.push_str("; but this H conserves it: it is an observable");
            }
            return Some(StructureError { place: Some(place.clone()), message, help });
        }
        None
    }

    /// Describes a sum of products, `is x + y`, if it is not zero.
    fn sum(&mut self, terms: &[(Expr, Expr)], provable: bool) -> Option<String> {
        if terms.is_empty() {
            return None;
        }
        let pool = &mut self.equations.pool;
        let mut written = None;
        if provable {
            let products: Vec<Expr> = terms.iter().map(|&(b, s)| pool.mul(b, s)).collect();
            let sum = pool.sum(&products);
            if pool.is_zero(sum) == Zero::Proved {
                return None;
            }
            let sum = pool.simplify(sum);
            written = (pool.weight(sum) <= LONGEST).then(|| format!("is {}", pool.unicode(sum)));
        }
        let mut difference_at = |point: &Valuation| {
            let (mut total, mut size) = (0.0, 0.0);
            for &(b, s) in terms {
                let (b, b_size) = pool.evaluate_with_size(b, &|x| point.at(x));
                let (s, s_size) = pool.evaluate_with_size(s, &|x| point.at(x));
                total += b * s;
                size += (b_size * s_size).abs();
            }
            let known = f64::is_finite(total) && f64::is_finite(size);
            known.then(|| (f64::abs(total) > TOLERANCE * size).then_some((total, size)))
        };
        let near =
            self.points.iter().filter_map(&mut difference_at).take(POINTS).collect::<Vec<_>>();
        let has_values = near.len() == POINTS;
        let refuted = near.into_iter().flatten().map(|found| (found, "near"));
        let far =
            self.far.iter().filter_map(difference_at).flatten().map(|found| (found, "far from"));
        let Some(((total, size), place)) = refuted.chain(far).next() else {
            return (!has_values).then(|| "has no value near the start".to_owned());
        };
        let value = || format!("is {total:.1e} {place} the start, its terms being {size:.1e}");
        Some(written.unwrap_or_else(value))
    }

    /// The triples whose identity has any terms.
    fn triples(&mut self) -> Vec<Triple> {
        let n = self.brackets.len();
        let pool = &mut self.equations.pool;
        let variables: Vec<_> = self.model.coordinates.iter().map(|c| c.position).collect();
        // ∂_l B_jk where it does not vanish
        let slopes: Vec<Vec<Vec<(usize, Expr)>>> = self
            .brackets
            .iter()
            .map(|row| {
                row.iter()
                    .map(|&b| {
                        let slopes = variables.iter().map(|&x| pool.derivative(b, x));
                        slopes.enumerate().filter(|(_, slope)| *slope != Expr::ZERO).collect()
                    })
                    .collect()
            })
            .collect();
        let mut triples = Vec::new();
        for i in 0..n {
            for j in i + 1..n {
                for k in j + 1..n {
                    let mut terms = Vec::new();
                    for (i, j, k) in [(i, j, k), (j, k, i), (k, i, j)] {
                        let factors = slopes[j][k].iter().map(|&(l, s)| (self.brackets[i][l], s));
                        terms.extend(factors.filter(|(b, _)| *b != Expr::ZERO));
                    }
                    if !terms.is_empty() {
                        triples.push(([i, j, k], terms));
                    }
                }
            }
        }
        triples
    }
}
