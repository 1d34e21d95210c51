//! Whether the Hamilton–Jacobi equation separates additively in the coordinates of the file.
//!
//! In: H(q, p) of a motion on which nothing else acts. Out: yes or no, where either is proved. Never here: the complete
//! integral.
//! Source: T. Levi-Civita, *Sulla integrazione della equazione di Hamilton–Jacobi per separazione di variabili*,
//! Mathematische Annalen 59 (1904) 383.

use super::equations::{CoordinateSymbols, Equations, Flow};
use super::structure::Separation;
use crate::expr::{Expr, Pool, Symbol, Zero};

impl Equations {
    /// Finds whether Hamilton–Jacobi separates: with the parameters' names, and if not, at their values.
    pub(super) fn find_separation(&mut self) {
        let found = self.separation_of_hamiltonian();
        self.supplements.separation = Some(found);
    }

    fn separation_of_hamiltonian(&mut self) -> Separation {
        let unknown = |why: &str| Separation::Unknown(why.to_owned());
        if matches!(self.flow, Flow::Poisson { .. }) {
            return unknown("there are no canonical coordinates");
        }
        if let Some(why) = self.beside {
            return unknown(why);
        }
        let Ok(h) = self.hamiltonian().clone() else {
            return unknown("H is not known in closed form");
        };
        let (coordinates, time) = (self.coordinates.clone(), self.symbols.time);
        if self.pool.depends(h, time) {
            return unknown("H depends on the time");
        }
        let general = separation(&mut self.pool, &coordinates, h);
        if general.answer() == Some(true) {
            return general;
        }
        let values = self.parameter_values();
        let here = self.pool.substitute(h, &values);
        match separation(&mut self.pool, &coordinates, here) {
            Separation::Separates { .. } => Separation::Separates { at_these_parameters: true },
            other => other,
        }
    }
}

/// Levi-Civita's conditions: for all i ≠ j, H^i H^j H_ij − H^i H_j H_i^j − H_i H^j H^i_j + H_i H_j H^ij = 0, with lower
/// indices for ∂/∂q and upper ones for ∂/∂p. They are proved on each side of a kink, which proves nothing across it.
pub fn separation(pool: &mut Pool, coordinates: &[CoordinateSymbols], h: Expr) -> Separation {
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
                Zero::No => return Separation::Not(a.position, b.position),
                Zero::Numerically | Zero::Unknown => proved = false,
            }
        }
    }
    let moving: Vec<Symbol> = coordinates.iter().flat_map(|c| [c.position, c.momentum]).collect();
    if coordinates.len() > 1 && pool.may_have_kink(h, &moving) {
        return Separation::Unknown(
            "H has kinks, on each side of which Levi-Civita's conditions may hold".to_owned(),
        );
    }
    if proved {
        Separation::Separates { at_these_parameters: false }
    } else {
        Separation::Unknown("Levi-Civita's conditions are neither proved nor refuted".to_owned())
    }
}
