//! Coordinates that leave the mass matrix before it is factored.
//!
//! In: the mass matrix as expressions. Out: a congruent one in which such coordinates are coupled to no other, and how accelerations
//! and forces follow. Never here: numbers.
//!
//! Where a velocity enters T only in ½ c (ψ̇ + Σ aᵢ q̇ᵢ)², as the spin of a symmetric top, c depends on parameters alone and the aᵢ do
//! not depend on those of c, then M = Lᵀ D L, where L has ones on its diagonal and the aᵢ in the row of ψ, and D no coupling of ψ
//! (Golub & Van Loan, Matrix Computations, 4.1). That holds for every value of c, also for 0, where M and D are singular alike: ψ is
//! a pivot that needs no search. What the square had in other entries leaves them, so D is shorter than M. Where it is not, as in a
//! double pendulum, nothing is gained and M stays as it is.

use crate::expr::{Expr, Node, Pool, Symbol};
use crate::num::Number;

/// With more couplings than these a matrix is left as it is.
const MOST_COUPLINGS: usize = 3;

/// The coordinates that leave a matrix, one after the other.
#[derive(Clone, Debug, Default)]
pub(super) struct Elimination {
    pub(super) coordinates: Vec<EliminatedCoordinate>,
    /// What is not a parameter.
    varying: Vec<Symbol>,
}

/// A row of L.
#[derive(Clone, Debug)]
pub(super) struct EliminatedCoordinate {
    pub(super) place: usize,
    /// The entries beside the diagonal, with their columns.
    pub(super) couplings: Vec<(usize, Expr)>,
}

/// Eliminates what it can from a symmetric matrix, which depends on symbols that vary and on parameters.
pub(super) fn eliminate(
    pool: &mut Pool,
    matrix: &mut [Vec<Expr>],
    varying: Vec<Symbol>,
) -> Elimination {
    let mut coordinates = Vec::new();
    for place in 0..matrix.len() {
        let pivot = matrix[place][place];
        if pivot == Expr::ZERO || pool.depends_on_any(pivot, &varying) {
            continue;
        }
        let coupled: Vec<usize> =
            (0..matrix.len()).filter(|&i| i != place && matrix[i][place] != Expr::ZERO).collect();
        if !(1..=MOST_COUPLINGS).contains(&coupled.len()) {
            continue;
        }
        let mut coupling = |i: usize| (i, pool.div(matrix[i][place], pivot));
        let couplings: Vec<(usize, Expr)> = coupled.iter().map(|&i| coupling(i)).collect();
        let of_pivot = pool.symbols_of(pivot);
        if couplings.iter().any(|&(_, a)| pool.depends_on_any(a, &of_pivot)) {
            continue;
        }
        // constants are shorter than what varies
        let mut among = coupled.iter().flat_map(|&i| coupled.iter().map(move |&j| (i, j)));
        if couplings.iter().any(|&(_, a)| pool.depends_on_any(a, &varying))
            && !among.any(|(i, j)| pool.depends_on_any(matrix[i][j], &varying))
        {
            continue;
        }
        let Some(rest) = shorter_rest(pool, matrix, place, &couplings) else { continue };
        for (i, j, entry) in rest {
            (matrix[i][j], matrix[j][i]) = (entry, entry);
        }
        for &i in &coupled {
            (matrix[i][place], matrix[place][i]) = (Expr::ZERO, Expr::ZERO);
        }
        coordinates.push(EliminatedCoordinate { place, couplings });
    }
    Elimination { coordinates, varying }
}

/// The entries of the coupled rows and columns without what a pivot has in them, if they are shorter.
fn shorter_rest(
    pool: &mut Pool,
    matrix: &[Vec<Expr>],
    place: usize,
    couplings: &[(usize, Expr)],
) -> Option<Vec<(usize, usize, Expr)>> {
    let (mut rest, mut before, mut after) = (Vec::new(), 0_u64, 0_u64);
    for (n, &(i, coupling)) in couplings.iter().enumerate() {
        for &(j, _) in &couplings[n..] {
            let square = pool.mul(coupling, matrix[place][j]);
            let entry = pool.sub(matrix[i][j], square);
            let entry = pool.simplify(entry);
            before = before.saturating_add(pool.weight(matrix[i][j]));
            after = after.saturating_add(pool.weight(entry));
            rest.push((i, j, entry));
        }
    }
    (after < before).then_some(rest)
}

impl Elimination {
    /// Makes the forces f′ of D q̈′ = f′ from f. Where a row of D has come down to its diagonal, factors that it shares with its force
    /// leave both, but for one power of each: where a factor vanishes D stays singular.
    pub(super) fn transform(&self, pool: &mut Pool, matrix: &mut [Vec<Expr>], force: &mut [Expr]) {
        for own in &self.coordinates {
            for &(i, a) in &own.couplings {
                let moved = pool.mul(a, force[own.place]);
                let rest = pool.sub(force[i], moved);
                force[i] = pool.simplify(rest);
            }
        }
        // the forces of one row enter those of others above: no factor leaves before all are made
        let mut coupled: Vec<usize> =
            self.coordinates.iter().flat_map(|own| &own.couplings).map(|&(i, _)| i).collect();
        coupled.sort_unstable();
        coupled.dedup();
        for i in coupled {
            let mut beside = matrix[i].iter().enumerate().filter(|(j, _)| *j != i);
            if beside.all(|(_, &entry)| entry == Expr::ZERO) {
                let shared = self.common_factors(pool, matrix[i][i], force[i]);
                matrix[i][i] = pool.div(matrix[i][i], shared);
                force[i] = pool.div(force[i], shared);
            }
        }
    }

    /// The powers of what varies that two products share, where the first keeps one power of each.
    fn common_factors(&self, pool: &mut Pool, a: Expr, b: Expr) -> Expr {
        let (Node::Product(_, of_a), Node::Product(_, of_b)) = (pool.node(a), pool.node(b)) else {
            return Expr::ONE;
        };
        let power = |&(base, n): &(Expr, Number)| {
            let (_, m) = of_b.iter().find(|(other, _)| *other == base)?;
            let (n, m) = (n.as_integer()?, m.as_integer()?);
            let varies = pool.depends_on_any(base, &self.varying);
            Some((base, Number::integer((n - 1).min(m)))).filter(|_| varies && n > 1 && m > 0)
        };
        let shared: Vec<(Expr, Number)> = of_a.iter().filter_map(power).collect();
        pool.monomial(Number::ONE, &shared)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::FunctionId;

    /// The kinetic energies' matrices of a symmetric top and of a double pendulum, by θ, and what is eliminated from them.
    fn eliminated(
        of: impl Fn(&mut Pool, Expr, [Expr; 2]) -> Vec<Vec<Expr>>,
    ) -> (String, Vec<usize>) {
        let mut pool = Pool::new();
        let [theta, a, c] = ["theta", "A", "C"].map(|name| pool.symbol(name));
        let [angle, transverse, axial] = [theta, a, c].map(|symbol| pool.variable(symbol));
        let mut matrix = of(&mut pool, angle, [transverse, axial]);
        let eliminated = eliminate(&mut pool, &mut matrix, vec![theta]).coordinates;
        let couplings = eliminated.iter().flat_map(|own| &own.couplings);
        let shown: Vec<String> = couplings.map(|&(_, e)| pool.unicode(e)).collect();
        let entries: Vec<String> =
            matrix.iter().flatten().map(|&entry| pool.unicode(entry)).collect();
        let places = eliminated.iter().map(|own| own.place).collect();
        (format!("{} | {}", entries.join(", "), shown.join(", ")), places)
    }

    /// A sin² θ + C cos² θ, C cos θ, C.
    fn top(pool: &mut Pool, angle: Expr, [a, c]: [Expr; 2]) -> [Expr; 3] {
        let [sine, cosine] = [FunctionId::Sin, FunctionId::Cos].map(|f| pool.call(f, &[angle]));
        let two = Number::integer(2);
        let first = pool.monomial(Number::ONE, &[(a, Number::ONE), (sine, two)]);
        let second = pool.monomial(Number::ONE, &[(c, Number::ONE), (cosine, two)]);
        [pool.add(first, second), pool.mul(c, cosine), c]
    }

    #[test]
    fn the_spin_of_a_symmetric_top_leaves_its_matrix() {
        let (matrix, places) = eliminated(|pool, angle, parameters| {
            let [m, coupling, c] = top(pool, angle, parameters);
            vec![vec![m, coupling], vec![coupling, c]]
        });
        assert_eq!((matrix.as_str(), &places[..]), ("A sin² θ, 0, 0, C | cos θ", &[1][..]));
    }

    #[test]
    fn a_pivot_that_varies_stays() {
        let (_, places) = eliminated(|pool, angle, parameters| {
            let [m, coupling, c] = top(pool, angle, parameters);
            let varying = pool.mul(c, angle);
            vec![vec![m, coupling], vec![coupling, varying]]
        });
        assert!(places.is_empty(), "{places:?}");
    }

    #[test]
    fn a_pivot_that_couplings_are_divided_by_stays() {
        // T = ½ A ẋ² + A ẋ (ψ̇ + θ ẏ) + ½ C (ψ̇ + θ ẏ)², regular at C = 0
        let (_, places) = eliminated(|pool, angle, [a, c]| {
            let [across, along] = [pool.mul(a, angle), pool.mul(c, angle)];
            let square = pool.mul(along, angle);
            vec![vec![a, across, a], vec![across, square, along], vec![a, along, c]]
        });
        assert!(places.is_empty(), "{places:?}");
    }

    #[test]
    fn what_would_not_be_shorter_stays() {
        // a double pendulum: 2 A, A cos θ, A
        let (matrix, places) = eliminated(|pool, angle, [a, _]| {
            let cosine = pool.call(FunctionId::Cos, &[angle]);
            let (coupling, twice) = (pool.mul(a, cosine), pool.scale(Number::integer(2), a));
            vec![vec![twice, coupling], vec![coupling, a]]
        });
        assert_eq!((matrix.as_str(), places.len()), ("2 A, A cos θ, A cos θ, A | ", 0));
    }
}
