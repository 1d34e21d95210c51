//! Constants of the motion: found, proved, and proved absent. Each one found is checked on an orbit that is integrated
//! here in floating point, which shares nothing with the arithmetic that found and proved it.

mod absent;
mod found;
mod involution;
mod lie;
mod negatives;
mod noether;
mod relations;
mod textbook;

use phaselab::expr::{Expr, Symbol};
use phaselab::integrability::{Invariants, Limits, invariants};
use phaselab::mechanics::{self, Equations, Flow};
use phaselab::model::Model;
use phaselab::preset::read;
use std::fmt::Write;

/// The model of a file.
pub(crate) fn model(text: &str) -> Model {
    read(text).unwrap_or_else(|diagnostics| panic!("{text}: {diagnostics:?}")).model
}

/// A file of canonical coordinates with parameters that have values.
pub(crate) fn hamiltonian(coordinates: &[&str], parameters: &[(&str, f64)], h: &str) -> Model {
    let mut text = "title = \"test\"\n[coordinates]\n".to_owned();
    for (i, q) in coordinates.iter().enumerate() {
        let (x, p) = (0.9 + 0.37 * i as f64, 0.23 - 0.31 * i as f64);
        text.push_str(&format!("{q} = {{ initial = {x}, momentum = {p} }}\n"));
    }
    if !parameters.is_empty() {
        text.push_str("[parameters]\n");
        for (name, value) in parameters {
            writeln!(text, "{name} = {value}").expect("memory");
        }
    }
    model(&format!("{text}[hamiltonian]\nH = \"{h}\"\n"))
}

/// A free rigid body or a top: M and the vertical g in body axes, with brackets of the Euclidean group e(3).
pub(crate) fn top(h: &str) -> Model {
    model(&format!(
        r#"
        title = "top"
        [variables]
        M1 = {{ initial = 0.3 }}
        M2 = {{ initial = -0.4 }}
        M3 = {{ initial = 0.7 }}
        g1 = {{ initial = 0.6 }}
        g2 = {{ initial = 0.0 }}
        g3 = {{ initial = 0.8 }}
        [poisson]
        H = "{h}"
        brackets = [["M1","M2","-M3"], ["M2","M3","-M1"], ["M3","M1","-M2"],
                    ["M1","g2","-g3"], ["M1","g3","g2"], ["M2","g1","g3"],
                    ["M2","g3","-g1"], ["M3","g1","-g2"], ["M3","g2","g1"]]
        casimirs = {{ "gamma²" = "g1^2 + g2^2 + g3^2", "M·gamma" = "M1*g1 + M2*g2 + M3*g3" }}
        "#
    ))
}

/// Searches up to a degree without a limit of time.
pub(crate) fn search(model: &Model, degree: u32) -> (Equations, Invariants) {
    let mut equations = mechanics::derive(model).expect("derivable");
    let limits = Limits { degree: Some(degree), is_over: &|| false };
    let found = invariants(model, &mut equations, &limits).expect("a law that can be searched");
    (equations, found)
}

/// The variables of a motion with their rates, at the model's parameters; accelerations are those solved symbolically.
fn flow(equations: &mut Equations, of_phase_space: bool) -> Vec<(Symbol, Expr)> {
    let coordinates = equations.coordinates.clone();
    match equations.flow.clone() {
        Flow::Poisson { rates } => coordinates.iter().map(|c| c.position).zip(rates).collect(),
        Flow::Hamilton { velocities, momentum_rates } => {
            let q = coordinates.iter().map(|c| c.position).zip(velocities);
            q.chain(coordinates.iter().map(|c| c.momentum).zip(momentum_rates)).collect()
        }
        Flow::Lagrange { .. } if of_phase_space => {
            let h = *equations.hamiltonian.as_ref().expect("H in closed form");
            let pool = &mut equations.pool;
            let mut all = Vec::new();
            for c in &coordinates {
                let (velocity, slope) =
                    (pool.derivative(h, c.momentum), pool.derivative(h, c.position));
                all.extend([(c.position, velocity), (c.momentum, pool.neg(slope))]);
            }
            all
        }
        Flow::Lagrange { .. } => {
            let solved = equations.solved.clone().expect("accelerations in closed form");
            let pool = &mut equations.pool;
            let q: Vec<_> =
                coordinates.iter().map(|c| (c.position, pool.variable(c.velocity))).collect();
            q.into_iter().chain(coordinates.iter().map(|c| c.velocity).zip(solved)).collect()
        }
    }
}

/// The greatest relative change of an expression along an orbit by the classical Runge–Kutta method.
pub(crate) fn drift(
    model: &Model,
    equations: &mut Equations,
    quantity: Expr,
    start: &[f64],
) -> f64 {
    let momenta: Vec<Symbol> = equations.coordinates.iter().map(|c| c.momentum).collect();
    let of_phase_space =
        equations.pool.depends_on_any(quantity, &momenta) || !equations.is_lagrangian();
    let flow = flow(equations, of_phase_space);
    let pool = &equations.pool;
    let parameters: Vec<(Symbol, f64)> =
        model.parameters.iter().map(|p| (p.symbol, p.value)).collect();
    let value = |state: &[f64], e: Expr| {
        pool.evaluate(e, &|s| {
            let at = flow.iter().position(|(v, _)| *v == s).map(|i| state[i]);
            let of_model = || parameters.iter().find(|(p, _)| *p == s).map(|(_, x)| *x);
            at.or_else(of_model).unwrap_or(0.0)
        })
    };
    let rates =
        |state: &[f64]| -> Vec<f64> { flow.iter().map(|(_, e)| value(state, *e)).collect() };
    let moved = |state: &[f64], by: &[f64], h: f64| -> Vec<f64> {
        state.iter().zip(by).map(|(x, v)| x + h * v).collect()
    };
    let (mut state, h) = (start.to_vec(), 1.0 / 512.0);
    let first = value(&state, quantity);
    let mut farthest: f64 = 0.0;
    for _ in 0..256 {
        let k1 = rates(&state);
        let k2 = rates(&moved(&state, &k1, h / 2.0));
        let k3 = rates(&moved(&state, &k2, h / 2.0));
        let k4 = rates(&moved(&state, &k3, h));
        for i in 0..state.len() {
            state[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
        farthest = farthest.max((value(&state, quantity) - first).abs() / (1.0 + first.abs()));
    }
    assert!(state.iter().zip(start).any(|(a, b)| (a - b).abs() > 1e-3), "nothing moved");
    farthest
}
