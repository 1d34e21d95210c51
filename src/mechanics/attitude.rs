//! The attitude of a body: A = B(ψ) C(θ) D(φ) by Euler's angles, or A′ = −\[ω\]× A integrated
//! alongside the motion.
//!
//! In: the model's attitude. Out: the nine entries as expressions, or as numbers integrated with
//! the state. Never here: the body's tensor; torques.
//! Source: *The Principles of Dynamics*, §§ 2.1.2–3. A takes components along space axes to those
//! along body axes.

use super::equations::{Auxiliary, AuxiliaryRates, Equations};
use super::rigid_body;
use crate::expr::{Expr, Symbol};
use crate::model::{AttitudeSource, Model};

/// Adds the attitude of a model, if it has one.
pub(super) fn find(equations: &mut Equations, model: &Model) {
    let Some(attitude) = &model.attitude else { return };
    match &attitude.source {
        AttitudeSource::Euler(angles) => {
            equations.supplements.attitude =
                Some(rigid_body::attitude(&mut equations.pool, *angles));
        }
        AttitudeSource::Rate { omega, start } => {
            let omega = omega.map(|e| equations.open(e));
            let pool = &mut equations.pool;
            let entries = attitude.matrix.map(|row| row.map(|s| pool.variable(s)));
            // the rows of −[ω]×: A₁′ = ω₃ A₂ − ω₂ A₃ and cyclic
            let mut rates: Vec<Expr> = Vec::new();
            for i in 0..3 {
                let (next, last) = ((i + 1) % 3, (i + 2) % 3);
                for j in 0..3 {
                    let gain = pool.mul(omega[last], entries[next][j]);
                    let loss = pool.mul(omega[next], entries[last][j]);
                    rates.push(pool.sub(gain, loss));
                }
            }
            let initial = rigid_body::attitude(pool, *start).concat();
            let symbols: Vec<Symbol> = attitude.matrix.concat();
            let plain = |plain| AuxiliaryRates { plain, matrix: Vec::new(), right: Vec::new() };
            let (rates, initial) = (plain(rates), plain(initial));
            equations.supplements.auxiliary.push(Auxiliary { symbols, rates, initial });
        }
    }
}
