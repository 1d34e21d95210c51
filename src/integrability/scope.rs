//! Which ansätze are searched for a law: the families of generators, and the degrees of coefficients.
//!
//! In: a law. Out: families, bounds, and what coefficients may be made of. Never here: the search.

use super::atoms::{AnsatzFamily, Atoms, parity};
use super::law::{Law, RateRule};
use crate::expr::{Expr, FunctionId, Node, Pool, Symbol};
use crate::model::Model;

/// A law with the coordinates that are angles.
#[derive(Clone, Debug)]
pub(super) struct SearchScope {
    pub(super) law: Law,
    pub(super) angles: Vec<Symbol>,
}

impl SearchScope {
    pub(super) fn of(model: &Model, law: Law) -> SearchScope {
        let is_angle = |c: &&crate::model::Coordinate| {
            c.period.is_some() || ["rad", "deg", "°"].contains(&c.unit.as_str()) || greek(&c.name)
        };
        let angles = model.coordinates.iter().filter(is_angle).map(|c| c.position).collect();
        SearchScope { law, angles }
    }

    /// The standard family, and the others that are tried where the law has what they need.
    pub(super) fn families(&self, model: &Model, pool: &Pool) -> Vec<AnsatzFamily> {
        let standard = AnsatzFamily { absent_by_angle: false, half_angles: false };
        let mut all = vec![standard];
        let roots = self.law.expressions();
        let absent = |s: &&Symbol| !roots.iter().any(|&e| pool.depends(e, **s));
        let positions = &self.law.variables[..self.law.positions];
        if positions.iter().filter(absent).any(|s| !self.angles.contains(s)) {
            all.push(AnsatzFamily { absent_by_angle: true, ..standard });
        }
        let turns = |e: &Expr| {
            let parts = pool.reachable(&[*e]);
            parts
                .into_iter()
                .any(|e| matches!(pool.node(e), Node::Call(FunctionId::Sin | FunctionId::Cos, _)))
        };
        if !model.is_poisson() && roots.iter().any(turns) {
            all.push(AnsatzFamily { half_angles: true, ..standard });
        }
        all
    }

    /// By how much the degree of coefficients exceeds what the law itself needs: nothing, then as much as a Killing
    /// tensor of flat space has.
    pub(super) fn extras(&self, degree: u32) -> Vec<u32> {
        if self.law.positions == 0 { vec![0] } else { vec![0, degree] }
    }

    /// The greatest degree of the coefficients of each degree in the momenta.
    pub(super) fn bounds(
        &self,
        pool: &mut Pool,
        atoms: &Atoms,
        degree: u32,
        extra: u32,
    ) -> Vec<(u32, u32)> {
        if self.law.positions == 0 {
            return vec![(0, degree)];
        }
        let of_energy = atoms.degrees(pool, self.law.energy);
        let potential = of_energy.get(&0).copied().unwrap_or(0);
        let linear = of_energy.get(&1).copied().unwrap_or(0);
        let kinetic = of_energy.iter().filter(|(k, _)| **k >= 2);
        let kinetic = kinetic.map(|(&k, &n)| (2 * n).div_ceil(k)).max().unwrap_or(0);
        let reversible = self.is_reversible(pool);
        let all = (0..=degree).filter(|k| !reversible || (degree - k).is_multiple_of(2));
        let bound = |k: u32| {
            let missing = degree - k;
            let of_potential = (missing * potential.max(2 * linear)).div_ceil(2);
            (k, extra + of_potential + (k * kinetic) / 2)
        };
        all.map(bound).collect()
    }

    /// Whether the motion is unchanged where time and momenta are reversed, so that even and odd constants separate. A law
    /// that contains the time is another one then.
    fn is_reversible(&self, pool: &Pool) -> bool {
        if self.law.expressions().iter().any(|&e| pool.depends(e, self.law.time)) {
            return false;
        }
        let momenta = self.law.momenta();
        let even = |e: &Expr| parity(pool, *e, momenta) == Some(true);
        match &self.law.rule {
            RateRule::Explicit(rates) => {
                let (velocities, forces) = rates.split_at(self.law.positions);
                let odd = |e: &Expr| *e == Expr::ZERO || parity(pool, *e, momenta) == Some(false);
                velocities.iter().all(odd) && forces.iter().all(even)
            }
            RateRule::Solved { mass, force, rows } => {
                mass.iter().flatten().chain(force).all(even)
                    && rows.iter().all(|row| row.is_scleronomic(pool, self.law.time))
            }
        }
    }
}

/// What coefficients may be made of: the parameters, and sines, cosines and exponentials of constants, each with its
/// highest power.
pub(super) fn constants_of(pool: &mut Pool, law: &Law, parameters: &[Symbol]) -> Vec<(Expr, u32)> {
    let moving = law.moving();
    let mut all: Vec<(Expr, u32)> = Vec::new();
    for e in pool.reachable(&law.expressions()) {
        if pool.depends_on_any(e, &moving) {
            continue;
        }
        let Node::Call(function, u) = pool.node(e).clone() else { continue };
        let found = match function {
            FunctionId::Sin | FunctionId::Cos => vec![
                (pool.call(FunctionId::Sin, &u), u32::MAX),
                (pool.call(FunctionId::Cos, &u), 1),
            ],
            FunctionId::Exp => vec![(e, u32::MAX)],
            _ => continue,
        };
        for one in found {
            if !all.contains(&one) {
                all.push(one);
            }
        }
    }
    let inside: Vec<Expr> = all.iter().map(|(e, _)| *e).collect();
    let parameters = parameters.iter().map(|&s| pool.variable(s)).collect::<Vec<_>>();
    // what occurs in such a function only is no further constant
    let opened = outside(pool, &law.expressions(), &inside);
    let plain = parameters.into_iter().filter(|e| inside.is_empty() || opened.contains(e));
    plain.map(|e| (e, u32::MAX)).chain(all).collect()
}

/// The nodes that are reached without passing through some of them.
fn outside(pool: &Pool, roots: &[Expr], closed: &[Expr]) -> Vec<Expr> {
    let mut seen: Vec<Expr> = Vec::new();
    let mut stack: Vec<Expr> = roots.to_vec();
    while let Some(e) = stack.pop() {
        if !closed.contains(&e) && !seen.contains(&e) {
            seen.push(e);
            stack.extend(pool.node(e).parts());
        }
    }
    seen
}

/// Letters by which angles are usually named.
fn greek(name: &str) -> bool {
    let letters = name.trim_end_matches(|c: char| c.is_ascii_digit() || c == '_');
    ["theta", "phi", "psi", "varphi", "chi", "alpha", "beta", "gamma"].contains(&letters)
}
