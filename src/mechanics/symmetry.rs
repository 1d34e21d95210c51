//! Symmetries that move several coordinates at once. Candidates are chosen by name: common
//! translations of `x1, x2, …` or `x, X`, and common rotations of all Cartesian pairs `(x…, y…)`, `(X…, Y…)`. Each one is
//! proved: the rate of its generator vanishes symbolically.
//! Source: *The Principles of Dynamics*, §§ 1.1.2, 1.4.2.

use std::collections::BTreeMap;

use super::equations::{Conserved, Equations, Flow, Reason};
use crate::expr::{Expr, Zero};
use crate::model::{Coordinate, Model};
use crate::num::Number;

/// Adds total momenta and angular momenta to the conserved quantities. `rates` are the ṗ.
pub(super) fn find(equations: &mut Equations, model: &Model, rates: &[Expr]) {
    for (stem, members) in families(model) {
        let name = format!("total p_{stem}");
        let is_known = equations.conserved.iter().any(|known| known.name == name);
        if is_known || members.iter().all(|i| equations.cyclic.contains(i)) {
            continue;
        }
        let momenta: Vec<Expr> = members.iter().map(|&i| equations.momenta[i]).collect();
        let rates: Vec<Expr> = members.iter().map(|&i| rates[i]).collect();
        let rate = equations.pool.sum(&rates);
        if equations.pool.is_zero(rate) == Zero::Proved {
            let shown: Vec<&str> =
                members.iter().map(|&i| model.coordinates[i].shown.as_str()).collect();
            let shown = shown.join(", ");
            // if forces act, the vanishing of their sum is not a symmetry of L
            let reason = if members.iter().any(|&i| is_driven(model, i)) {
                Reason::Proved
            } else if members.iter().all(|&i| is_angle(&model.coordinates[i])) {
                Reason::CommonRotation(shown)
            } else {
                Reason::Translation(shown)
            };
            equations.conserved.push(Conserved {
                name,
                expression: equations.pool.sum(&momenta),
                reason,
            });
        }
    }
    for (first, second, axis) in [('x', 'y', 'z'), ('y', 'z', 'x'), ('z', 'x', 'y')] {
        let capital = |letter: char| letter.to_ascii_uppercase();
        let small = pairs(model, &[(first, second)]);
        let all = pairs(model, &[(first, second), (capital(first), capital(second))]);
        let is_larger = all.len() > small.len();
        // of what moves apart from each other the sum is the constant, as of x1, y1 and x2, y2
        for pairs in [is_larger.then_some(all), Some(small)].into_iter().flatten() {
            let angles =
                pairs.iter().any(|&(i, j)| [i, j].iter().any(|&k| is_angle(&model.coordinates[k])));
            if pairs.is_empty() || angles || !covers(model, first, second, &pairs) {
                continue;
            }
            let (momentum, rate) = angular_momentum(equations, &pairs, rates);
            if equations.pool.is_zero(rate) != Zero::Proved {
                continue;
            }
            let driven = pairs.iter().any(|&(i, j)| is_driven(model, i) || is_driven(model, j));
            // what also turns has a spin beside this, and the sum of both is another constant
            let turns = model.coordinates.iter().any(is_angle);
            equations.conserved.push(Conserved {
                name: if turns { format!("orbital L_{axis}") } else { format!("L_{axis}") },
                expression: equations.pool.simplify_terms(momentum),
                reason: if driven { Reason::Proved } else { Reason::Rotation(axis) },
            });
            break;
        }
    }
}

/// Returns whether a force or dissipation acts on a coordinate.
fn is_driven(model: &Model, i: usize) -> bool {
    let friction = model.mechanics.dissipation();
    model.mechanics.forces().get(i).is_some_and(|&force| force != Expr::ZERO)
        || model.pool.depends(friction, model.coordinates[i].velocity)
}

/// Returns whether a coordinate is an angle, judging by its unit or its period.
fn is_angle(coordinate: &Coordinate) -> bool {
    coordinate.period.is_some() || ["rad", "deg", "°"].contains(&coordinate.unit.as_str())
}

/// Groups of two or more coordinates whose names differ only in a trailing number, then those that differ in that or in
/// being capital letters.
fn families(model: &Model) -> Vec<(String, Vec<usize>)> {
    let mut numbered: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    let mut all: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (i, c) in model.coordinates.iter().enumerate() {
        let stem = c.name.trim_end_matches(|d: char| d.is_ascii_digit());
        if stem.is_empty() {
            continue;
        }
        if stem.len() < c.name.len() {
            numbered.entry(stem).or_default().push(i);
        }
        all.entry(stem.to_lowercase()).or_default().push(i);
    }
    let numbered = numbered.into_iter().map(|(stem, members)| (stem.to_owned(), members));
    numbered.chain(all).filter(|(_, members)| members.len() > 1).collect()
}

/// Cartesian pairs: each `x…` with the `y…` of the same ending, for these letters.
fn pairs(model: &Model, letters: &[(char, char)]) -> Vec<(usize, usize)> {
    let partner = |name: &str| {
        letters.iter().find_map(|&(first, second)| {
            let ending = name.strip_prefix(first)?;
            model.coordinate(&format!("{second}{ending}"))
        })
    };
    model.coordinates.iter().enumerate().filter_map(|(i, c)| Some((i, partner(&c.name)?))).collect()
}

/// Returns whether every coordinate that begins with either letter is in a pair.
fn covers(model: &Model, first: char, second: char, pairs: &[(usize, usize)]) -> bool {
    model.coordinates.iter().enumerate().all(|(i, c)| {
        let is_cartesian = [first, second].iter().any(|&letter| {
            let ending = c.name.strip_prefix(letter);
            ending.is_some_and(|ending| ending.bytes().all(|b| b.is_ascii_digit()))
        });
        !is_cartesian || pairs.iter().any(|&(a, b)| a == i || b == i)
    })
}

/// Σ x p_y − y p_x and its rate Σ ẋ p_y + x ṗ_y − ẏ p_x − y ṗ_x.
fn angular_momentum(
    equations: &mut Equations,
    pairs: &[(usize, usize)],
    rates: &[Expr],
) -> (Expr, Expr) {
    let speeds: Vec<Expr> = match &equations.flow {
        Flow::Hamilton { velocities, .. } => velocities.clone(),
        _ => {
            let symbols: Vec<_> = equations.coordinates.iter().map(|c| c.velocity).collect();
            symbols.into_iter().map(|s| equations.pool.variable(s)).collect()
        }
    };
    let (mut momentum, mut rate) = (Vec::new(), Vec::new());
    for &(i, j) in pairs {
        let pool = &mut equations.pool;
        let x = pool.variable(equations.coordinates[i].position);
        let y = pool.variable(equations.coordinates[j].position);
        let (p_x, p_y) = (equations.momenta[i], equations.momenta[j]);
        momentum.push((Number::ONE, pool.mul(x, p_y)));
        momentum.push((Number::MINUS_ONE, pool.mul(y, p_x)));
        rate.push((Number::ONE, pool.mul(speeds[i], p_y)));
        rate.push((Number::ONE, pool.mul(x, rates[j])));
        rate.push((Number::MINUS_ONE, pool.mul(speeds[j], p_x)));
        rate.push((Number::MINUS_ONE, pool.mul(y, rates[i])));
    }
    let pool = &mut equations.pool;
    (pool.linear(Number::ZERO, &momentum), pool.linear(Number::ZERO, &rate))
}
