//! The equations of motion from the expressions alone: accelerations from the derivatives of L, the energy from its
//! definition. It uses nothing of the program.

use super::case::{Case, Law};
use super::jet::Jet;
use super::tree::{Branches, Tree};

/// The largest system of linear equations: three accelerations and a multiplier.
const MOST: usize = 4;

fn total(trees: &[Tree], point: &[f64], branches: &mut Branches) -> Jet {
    let start = Jet::constant(point.len(), 0.0);
    trees.iter().fold(start, |sum, tree| sum.plus(&tree.jet(point, branches)))
}

fn negative(jet: &Jet) -> Jet {
    jet.chain([-jet.value, -1.0, 0.0])
}

/// Coordinates, velocities or momenta, and the time.
fn point(case: &Case, time: f64, state: &[f64]) -> Vec<f64> {
    let mut point = state.to_vec();
    point.resize(2 * case.count(), 0.0);
    point.push(time);
    point
}

/// The rates of a state's components. The values that decide kinks, and the event function last, are left in `branches`.
pub(crate) fn rates(case: &Case, time: f64, state: &[f64], branches: &mut Branches) -> Vec<f64> {
    branches.values.clear();
    let n = case.count();
    let at = point(case, time, state);
    let kinetic = total(&case.kinetic, &at, branches);
    let potential = total(&case.potential, &at, branches);
    let force = |i: usize, branches: &mut Branches| -> f64 {
        let of = case.forces.iter().filter(|(j, _)| *j == i);
        of.map(|(_, tree)| tree.jet(&at, branches).value).sum()
    };
    let rates = match case.law {
        Law::Lagrangian => {
            let l = kinetic.plus(&negative(&potential));
            let loss = total(&case.dissipation, &at, branches);
            let mut right = vec![0.0; n];
            for i in 0..n {
                right[i] = l.slope[i] - l.second(n + i, 2 * n) - loss.slope[n + i];
                right[i] += force(i, branches);
                for j in 0..n {
                    right[i] -= l.second(n + i, j) * state[n + j];
                }
            }
            let mut rates = state[n..].to_vec();
            rates.extend(accelerations(case, &l, right, &at, branches));
            rates
        }
        Law::Hamiltonian => {
            let h = kinetic.plus(&potential);
            let mut rates = h.slope[n..2 * n].to_vec();
            for i in 0..n {
                rates.push(-h.slope[i] + force(i, branches));
            }
            rates
        }
        Law::Poisson => {
            let slope = kinetic.plus(&potential).slope;
            // {a, b} = −(A x)_c, and cyclic
            let row = |i: usize| (0..3).map(|j| case.structure[i][j] * state[j]).sum::<f64>();
            let x = [row(0), row(1), row(2)];
            vec![
                -x[2] * slope[1] + x[1] * slope[2],
                x[2] * slope[0] - x[0] * slope[2],
                -x[1] * slope[0] + x[0] * slope[1],
            ]
        }
    };
    if let Some(stop) = &case.stop {
        let value = stop.jet(&at, &mut Branches::default()).value;
        branches.watch(value);
    }
    rates
}

fn accelerations(
    case: &Case,
    l: &Jet,
    mut right: Vec<f64>,
    at: &[f64],
    branches: &mut Branches,
) -> Vec<f64> {
    let n = case.count();
    let mut rows: Vec<Vec<f64>> =
        (0..n).map(|i| (0..n).map(|j| l.second(n + i, n + j)).collect()).collect();
    if let Some(constraint) = &case.constraint {
        let c = constraint.expression.jet(at, branches);
        let velocity = |i: usize| at[n + i];
        let (row, rest): (Vec<f64>, f64) = if constraint.holonomic {
            let mut rest = c.second(2 * n, 2 * n);
            for i in 0..n {
                rest += 2.0 * c.second(i, 2 * n) * velocity(i);
                for j in 0..n {
                    rest += c.second(i, j) * velocity(i) * velocity(j);
                }
            }
            (c.slope[..n].to_vec(), rest)
        } else {
            let along: f64 = (0..n).map(|i| c.slope[i] * velocity(i)).sum();
            (c.slope[n..2 * n].to_vec(), along + c.slope[2 * n])
        };
        for i in 0..n {
            rows[i].push(-row[i]);
        }
        rows.push(row.iter().copied().chain([0.0]).collect());
        right.push(-rest);
    }
    let mut solution = solve(rows, right);
    solution.truncate(n);
    solution
}

/// Gaussian elimination with pivoting.
fn solve(mut rows: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    let n = right.len();
    assert!(n <= MOST);
    for k in 0..n {
        let size = |i: &usize| rows[*i][k].abs();
        let pivot = (k..n).max_by(|i, j| size(i).total_cmp(&size(j))).unwrap_or(k);
        rows.swap(k, pivot);
        right.swap(k, pivot);
        for i in k + 1..n {
            let factor = rows[i][k] / rows[k][k];
            for j in k..n {
                rows[i][j] -= factor * rows[k][j];
            }
            right[i] -= factor * right[k];
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| rows[k][j] * right[j]).sum();
        right[k] = (right[k] - known) / rows[k][k];
    }
    right
}

/// Σ q' ∂L/∂q' − L, or H; and the magnitude of its terms.
pub(crate) fn energy(case: &Case, time: f64, state: &[f64]) -> (f64, f64) {
    let n = case.count();
    let at = point(case, time, state);
    let mut branches = Branches::default();
    let kinetic = total(&case.kinetic, &at, &mut branches);
    let potential = total(&case.potential, &at, &mut branches);
    match case.law {
        Law::Lagrangian => {
            let l = kinetic.plus(&negative(&potential));
            let work: f64 = (0..n).map(|i| at[n + i] * l.slope[n + i]).sum();
            (work - l.value, work.abs() + kinetic.value.abs() + potential.value.abs())
        }
        _ => (kinetic.value + potential.value, kinetic.value.abs() + potential.value.abs()),
    }
}

/// A bound of the rounding error of the kinetic and the potential terms of the energy.
pub(crate) fn rounding_of_terms(case: &Case, time: f64, state: &[f64]) -> f64 {
    let at = point(case, time, state);
    case.kinetic.iter().chain(&case.potential).map(|tree| tree.rounded(&at).1).sum()
}

/// The momentum of a coordinate of a Lagrangian.
pub(crate) fn momentum(case: &Case, time: f64, state: &[f64], i: usize) -> f64 {
    let at = point(case, time, state);
    let kinetic = total(&case.kinetic, &at, &mut Branches::default());
    let potential = total(&case.potential, &at, &mut Branches::default());
    let n = case.count();
    kinetic.slope[n + i] - potential.slope[n + i]
}

/// The state after an impulse on a coordinate, or `None` if the velocities cannot be found.
pub(crate) fn after_impulse(
    case: &Case,
    time: f64,
    state: &[f64],
    i: usize,
    by: f64,
) -> Option<Vec<f64>> {
    let n = case.count();
    let mut after = state.to_vec();
    if case.law != Law::Lagrangian {
        after[n + i] += by;
        return Some(after);
    }
    let momenta = |state: &[f64]| {
        let at = point(case, time, state);
        total(&case.kinetic, &at, &mut Branches::default()).plus(&negative(&total(
            &case.potential,
            &at,
            &mut Branches::default(),
        )))
    };
    let mut wanted = momenta(state).slope[n..2 * n].to_vec();
    wanted[i] += by;
    for _ in 0..50 {
        let l = momenta(&after);
        let miss: Vec<f64> = (0..n).map(|i| wanted[i] - l.slope[n + i]).collect();
        let rows = (0..n).map(|i| (0..n).map(|j| l.second(n + i, n + j)).collect()).collect();
        let change = solve(rows, miss);
        let size = change.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
        (0..n).for_each(|i| after[n + i] += change[i]);
        if size.is_nan() {
            return None;
        }
        if size < 1e-14 {
            return Some(after);
        }
    }
    None
}
