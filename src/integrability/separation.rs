//! Whether the Hamilton–Jacobi equation separates additively in the coordinates of the file, at the parameters' values.
//!
//! In: H(q, p) of a motion on which nothing else acts. Out: yes or no, where either is proved. Never here: Levi-Civita's
//! conditions, which are `mechanics`'.

use std::collections::HashMap;

use super::law::is_hamiltonian;
use crate::expr::{Expr, Symbol};
use crate::mechanics::{Equations, exact_constants, separation};
use crate::model::Model;

/// Whether Levi-Civita's conditions hold at the parameters' values. `None` where there is no H without time, or neither
/// answer is proved.
pub fn separates(model: &Model, equations: &mut Equations) -> Option<bool> {
    if model.is_poisson() || !is_hamiltonian(model, equations) {
        return None;
    }
    let values: HashMap<Symbol, Expr> = exact_constants(model, equations)
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
    separation(pool, &coordinates, h).answer()
}
