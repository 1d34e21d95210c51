//! Observables in the variables of the state: `energy`, the momenta of a Lagrangian system, and the
//! velocities and accelerations of a Hamiltonian one are replaced by their expressions.

use std::collections::HashMap;

use super::equations::{Equations, Flow};
use crate::expr::{Expr, Symbol};

impl Equations {
    /// The rates of change of time, coordinates and momenta (or variables), for a flow of first
    /// order in time.
    pub fn along_the_flow(&self) -> Vec<(Symbol, Expr)> {
        let mut seeds = self.by_time();
        match &self.flow {
            Flow::Lagrange { .. } => {}
            Flow::Hamilton { velocities, momentum_rates } => {
                for (i, c) in self.coordinates.iter().enumerate() {
                    seeds.push((c.position, velocities[i]));
                    seeds.push((c.momentum, momentum_rates[i]));
                }
            }
            Flow::Poisson { rates } => {
                seeds.extend(self.coordinates.iter().zip(rates).map(|(c, &x)| (c.position, x)));
            }
        }
        seeds
    }

    /// The rates of change of the time, and of parameters that change with it under their own names.
    pub(super) fn by_time(&self) -> Vec<(Symbol, Expr)> {
        let mut seeds = vec![(self.symbols.time, Expr::ONE)];
        seeds.extend(&self.supplements.ramp_rates);
        seeds
    }

    /// The entries of an attitude matrix in terms of Euler's angles, and the new variables of
    /// transformations in terms of (q, p, t).
    pub fn attitude_map(&self) -> HashMap<Symbol, Expr> {
        let symbols = self.supplements.attitude_symbols.iter().flat_map(|m| m.concat());
        let entries = symbols.zip(self.supplements.attitude.iter().flat_map(|m| m.concat()));
        entries.chain(self.supplements.maps.new_variables.iter().copied()).collect()
    }

    /// An observable as a function of the state: of (q, q̇, t) and accelerations q̈ for a
    /// Lagrangian system, of (q, p, t) for a Hamiltonian one. The symbol `action` remains.
    pub fn open(&mut self, observable: Expr) -> Expr {
        let energy = HashMap::from([(self.symbols.energy, self.energy)]);
        let e = self.pool.substitute(observable, &energy);
        let e = self.pool.substitute(e, &self.attitude_map());
        let mut replacements: HashMap<Symbol, Expr> = HashMap::new();
        match self.flow.clone() {
            Flow::Lagrange { .. } => {
                for (c, &p) in self.coordinates.iter().zip(&self.momenta) {
                    replacements.insert(c.momentum, p);
                }
                let symbols: Vec<Symbol> = self.constraints.iter().map(|c| c.multiplier).collect();
                if self.pool.depends_on_any(e, &symbols)
                    && let Ok(multipliers) = self.multipliers()
                {
                    replacements.extend(symbols.into_iter().zip(multipliers.iter().copied()));
                }
            }
            Flow::Hamilton { velocities, .. } | Flow::Poisson { rates: velocities } => {
                // q̈ = d/dt ∂H/∂p along the flow
                let seeds = self.along_the_flow();
                for (i, c) in self.coordinates.iter().enumerate() {
                    replacements.insert(c.velocity, velocities[i]);
                    if self.pool.depends(e, c.acceleration) {
                        let acceleration = self.pool.derivation(velocities[i], &seeds);
                        replacements.insert(c.acceleration, acceleration);
                    }
                }
            }
        }
        self.pool.substitute(e, &replacements)
    }
}
