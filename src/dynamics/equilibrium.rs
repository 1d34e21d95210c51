//! An equilibrium, and the order of several.
//!
//! In: what a search finds of it. Out: its numbers. Never here: how it is found.

use std::cmp::Ordering;

use super::equilibrium_kind::EquilibriumKind;
use super::small_oscillation::{LinearMotion, Mode, rests};
use super::virtual_work::VirtualWork;

/// A state in which nothing moves but what is cyclic.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    /// The name that the file gives it, once [`name_equilibria`](super::name_equilibria) has; else nothing.
    pub name: String,
    /// q and p, or the variables of brackets.
    pub variables: Vec<f64>,
    /// The unit of each coordinate in which it was searched for.
    pub(super) units: Vec<f64>,
    /// The value of H there.
    pub energy: f64,
    /// What the effective potential does there; `None` for brackets.
    pub kind: Option<EquilibriumKind>,
    /// Where it is one of a family, a curve or a surface of equilibria: directions along it, as many as its dimension, each with a
    /// part for every variable. It is the member nearest to the start.
    pub family: Vec<Vec<f64>>,
    /// The eigenvalues of the linearised motion, of the coordinates that are not cyclic.
    pub eigenvalues: Vec<[f64; 2]>,
    /// The small oscillations, the slowest first.
    pub modes: Vec<Mode>,
    /// Whether it is stable, where that is proved: it is not where something grows in the linearised motion, and it is where all is
    /// damped, or where the energy, which does not grow, is least or greatest (J.-L. Lagrange, G. Dirichlet). Oscillations of the
    /// linearised motion alone prove nothing (T. M. Cherry, Trans. Cambridge Philos. Soc. 23, 199 (1925)). See
    /// [`Equilibrium::stability`].
    pub stable: Option<bool>,
    pub(super) linear: LinearMotion,
    /// The rates of the cyclic coordinates, by index.
    pub rates: Vec<(usize, f64)>,
    /// The forces that balance there, once [`with_virtual_work`](super::with_virtual_work) has written them.
    pub work: Vec<VirtualWork>,
    /// The multiplier of each constraint, once the same function has written them.
    pub multipliers: Vec<f64>,
}

impl Equilibrium {
    /// Whether all that is known of its stability is that in the linearised motion everything oscillates and nothing grows.
    pub fn is_linearly_stable(&self) -> bool {
        self.stable.is_none() && self.linear == LinearMotion::Bounded
    }

    /// Its stability in words.
    pub fn stability(&self) -> &'static str {
        match self.stable {
            Some(true) => "stable",
            Some(false) => "unstable",
            None if self.eigenvalues.is_empty() => "of unknown stability",
            None if self.is_linearly_stable() => "linearly stable",
            None if rests(&self.eigenvalues) => "neutral in a direction",
            None => "neutral: equal frequencies with fewer modes",
        }
    }
}

/// The equilibria that a search has found.
#[derive(Clone, Debug)]
pub struct Equilibria {
    /// The equilibria by energy.
    pub found: Vec<Equilibrium>,
    /// The coordinates in which the law is periodic, with the period: of places that differ by it one is found.
    pub periods: Vec<(usize, f64)>,
    /// Whether the search was cancelled.
    pub cancelled: bool,
    /// Whether it came to its end; otherwise it has found as many as are listed, and there may be more.
    pub is_complete: bool,
}

/// Energies and places count as the same up to this part of the largest.
const ALIKE: f64 = 1e-7;

/// Sorts by energy, and those of one energy by their places, so that the order is not that in which they were found.
pub(super) fn in_order(found: &mut [Equilibrium]) {
    found.sort_by(|a, b| a.energy.total_cmp(&b.energy));
    let largest = |of: &dyn Fn(&Equilibrium) -> f64| {
        found.iter().map(|one| of(one).abs()).filter(|x| x.is_finite()).fold(0.0, f64::max)
    };
    let energy = ALIKE * largest(&|one| one.energy);
    let count = found.first().map_or(0, |one| one.variables.len());
    let sizes: Vec<f64> = (0..count).map(|k| ALIKE * largest(&|one| one.variables[k])).collect();
    for alike in found.chunk_by_mut(|a, b| (a.energy - b.energy).abs() <= energy) {
        // in whole parts, so that the order is one
        let parts = |one: &Equilibrium| -> Vec<f64> {
            let parts = one.variables.iter().zip(&sizes);
            parts.map(|(x, size)| if *size > 0.0 { (x / size).round() } else { 0.0 }).collect()
        };
        alike.sort_by(|a, b| {
            let pairs = parts(b).into_iter().zip(parts(a));
            let orders = pairs.map(|(x, y)| if x == y { Ordering::Equal } else { x.total_cmp(&y) });
            orders.fold(Ordering::Equal, Ordering::then)
        });
    }
}
