//! Shrinking: the smallest case that still fails in the same way, found by leaving out parts.

use super::case::{Case, ROTATIONS, Units};
use super::tree::Tree;

/// Simpler cases, the simplest first.
fn simpler(case: &Case) -> Vec<Case> {
    let mut cases = Vec::new();
    let mut add = |change: &dyn Fn(&mut Case)| {
        let mut simpler = case.clone();
        change(&mut simpler);
        if simpler != *case {
            cases.push(simpler);
        }
    };
    add(&|c| c.units = Units::natural(c.count()));
    add(&|c| c.units.as_parameters = false);
    add(&|c| c.by_momentum.clear());
    add(&|c| c.claims = false);
    add(&|c| c.structure = ROTATIONS);
    add(&|c| c.impulse = None);
    add(&|c| c.stop = None);
    add(&|c| c.release = None);
    add(&|c| c.constraint = None);
    add(&|c| c.forces.clear());
    add(&|c| c.dissipation.clear());
    add(&|c| {
        "auto".clone_into(&mut c.method);
        c.step = None;
        c.tolerance = None;
    });
    for k in 0..case.potential.len() {
        add(&|c| {
            c.potential.remove(k);
        });
    }
    for k in case.count()..case.kinetic.len() {
        add(&|c| {
            c.kinetic.remove(k);
        });
    }
    for k in 0..case.count().min(case.kinetic.len()) {
        let velocity = Tree::Power(Box::new(Tree::Variable(case.count() + k)), 2);
        let plain = Tree::Product(vec![Tree::Number(0.5), velocity]);
        add(&|c| c.kinetic[k] = plain.clone());
    }
    add(&|c| c.length *= 0.5);
    add(&|c| c.length = c.length.round().max(1.0));
    if case.constraint.is_none() {
        for i in 0..case.start.len() {
            add(&|c| c.start[i] = 0.0);
            add(&|c| c.start[i] = c.start[i].signum());
        }
    }
    cases
}

/// Leaves out parts while `fails` is true, in at most `looks` attempts.
pub(crate) fn shrunk(case: &Case, mut looks: u32, fails: &dyn Fn(&Case) -> bool) -> Case {
    let mut smallest = case.clone();
    'smaller: loop {
        for simpler in simpler(&smallest) {
            if looks == 0 {
                break 'smaller;
            }
            looks -= 1;
            if fails(&simpler) {
                smallest = simpler;
                continue 'smaller;
            }
        }
        break;
    }
    smallest
}
