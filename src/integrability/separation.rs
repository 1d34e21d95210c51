//! Whether the Hamilton–Jacobi equation separates additively in the coordinates of the file.
//!
//! In: H(q, p) of a motion on which nothing else acts. Out: yes or no, where either is proved. Never here: the complete
//! integral.
//! Source: T. Levi-Civita, *Sulla integrazione della equazione di Hamilton–Jacobi per separazione di variabili*,
//! Mathematische Annalen 59 (1904) 383.

use std::collections::HashMap;

use super::law::{self, is_hamiltonian};
use crate::expr::{Expr, Symbol, Zero};
use crate::mechanics::Equations;
use crate::model::Model;

/// Levi-Civita's conditions: for all i ≠ j, H^i H^j H_ij − H^i H_j H_i^j − H_i H^j H^i_j + H_i H_j H^ij = 0, with lower
/// indices for ∂/∂q and upper ones for ∂/∂p, at the parameters' values. `None` where there is no H without time, or
/// neither answer is proved.
pub fn separates(model: &Model, equations: &mut Equations) -> Option<bool> {
    if model.is_poisson() || !is_hamiltonian(model, equations) {
        return None;
    }
    let values: HashMap<Symbol, Expr> = law::constants(model, equations)
        .into_iter()
        .map(|(s, n)| (s, equations.pool.number(n)))
        .collect();
    let h = equations.hamiltonian().clone().ok()?;
    let (coordinates, time) = (equations.coordinates.clone(), equations.symbols.time);
    let pool = &mut equations.pool;
    let h = pool.substitute(h, &values);
    if pool.depends(h, time) {
        return None;
    }
    let mut proved = true;
    for (i, a) in coordinates.iter().enumerate() {
        for b in &coordinates[i + 1..] {
            let first = [a.position, a.momentum, b.position, b.momentum];
            let [h_i, hi, h_j, hj] = first.map(|s| pool.derivative(h, s));
            let h_ij = pool.derivative(h_i, b.position);
            let h_i_j = pool.derivative(h_i, b.momentum);
            let hi_j = pool.derivative(hi, b.position);
            let hij = pool.derivative(hi, b.momentum);
            let terms = [
                pool.product(&[hi, hj, h_ij]),
                pool.product(&[hi, h_j, h_i_j]),
                pool.product(&[h_i, hj, hi_j]),
                pool.product(&[h_i, h_j, hij]),
            ];
            let (plus, minus) = (pool.add(terms[0], terms[3]), pool.add(terms[1], terms[2]));
            let condition = pool.sub(plus, minus);
            match pool.is_zero(condition) {
                Zero::Proved => {}
                Zero::No => return Some(false),
                Zero::Numerically | Zero::Unknown => proved = false,
            }
        }
    }
    proved.then_some(true)
}
