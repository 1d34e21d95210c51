//! Infinitesimal transformations cut off at first order, Q = q + ε ∂G/∂p, P = p − ε ∂G/∂q: what they lack to be canonical is
//! exactly −ε² 𝕁 G″ 𝕁 G″ 𝕁.
//! Source: *The Principles of Dynamics*, § 3.3.2: with M = 1 + ε 𝕁 G″, M 𝕁 Mᵀ − 𝕁 has nothing of first order.

use std::collections::HashMap;

use nalgebra::DMatrix;
use phaselab::expr::{Expr, Symbol, Zero};
use phaselab::mechanics::{self, Equations, PhaseMap, Valuation, phase_maps};
use phaselab::model::Model;

use crate::build::{self, read};

/// The model of the map, its equations, the map, and G.
fn first_order(q: &[&str], g: &str, epsilon: f64) -> (Model, Equations, PhaseMap, Expr) {
    let mut model = build::hamiltonian(q, &[], "0");
    let generator = read(&mut model, g);
    let pool = &mut model.pool;
    let mut halves = [Vec::new(), Vec::new()];
    for (i, q) in q.iter().enumerate() {
        let [position, momentum] = [(*q).to_owned(), format!("p_{q}")].map(|s| pool.symbol(&s));
        let [by_q, by_p] = [position, momentum].map(|s| pool.derivative(generator, s));
        let [by_q, by_p] = [by_q, by_p].map(|e| pool.text(e));
        halves[0].push(format!("Q{} = \"{q} + e*({by_p})\"", i + 1));
        halves[1].push(format!("P{} = \"p_{q} - e*({by_q})\"", i + 1));
    }
    let [positions, momenta] = halves.map(|half| half.join(", "));
    let mut text = "title = \"T\"\n[coordinates]\n".to_owned();
    let mut energy = Vec::new();
    for q in q {
        text.push_str(&format!("{q} = {{ initial = 0.7, momentum = 0.4 }}\n"));
        energy.push(format!("p_{q}^2/2"));
    }
    let text = format!(
        "{text}[parameters]\ne = {epsilon:?}\n[hamiltonian]\nH = \"{}\"\n[[transformations]]\n\
         name = \"a\"\nkind = \"explicit\"\nQ = {{ {positions} }}\nP = {{ {momenta} }}\n",
        energy.join(" + ")
    );
    let text = if q.len() == 1 { text.replace("Q1", "Q").replace("P1", "P") } else { text };
    let mut model = crate::integrability::model(&text);
    let generator = read(&mut model, g);
    let mut equations = mechanics::derive(&model).expect("derivable");
    let map = phase_maps(&model, &mut equations).remove(0);
    (model, equations, map, generator)
}

fn unit(n: usize) -> DMatrix<f64> {
    DMatrix::from_fn(2 * n, 2 * n, |i, j| {
        f64::from(i8::from(j == i + n)) - f64::from(i8::from(i == j + n))
    })
}

/// M 𝕁 Mᵀ − 𝕁 of the map, and −ε² 𝕁 G″ 𝕁 G″ 𝕁, at a point.
fn residuals(q: &[&str], g: &str, epsilon: f64, point: &[f64]) -> (DMatrix<f64>, DMatrix<f64>) {
    let (mut model, equations, map, generator) = first_order(q, g, epsilon);
    let values = model.parameter_values();
    let at = Valuation::of_parameters(&model, &values)
        .with(map.old.iter().copied().zip(point.iter().copied()));
    let image = map.image(&equations.pool, &at).expect("an image");
    let tangent = map.tangent(&equations.pool, &image).expect("a derivative");
    let j = unit(q.len());
    let found = &tangent * &j * tangent.transpose() - &j;
    let names: Vec<Symbol> = map.old.clone();
    let known: HashMap<Symbol, f64> = names.iter().copied().zip(point.iter().copied()).collect();
    let pool = &mut model.pool;
    let mut hessian = DMatrix::zeros(2 * q.len(), 2 * q.len());
    for (i, &a) in names.iter().enumerate() {
        for (k, &b) in names.iter().enumerate() {
            let slope = pool.derivative(generator, a);
            let second = pool.derivative(slope, b);
            hessian[(i, k)] = pool.evaluate(second, &|s| known.get(&s).copied().unwrap_or(0.0));
        }
    }
    let expected = &j * &hessian * &j * &hessian * &j * (-epsilon * epsilon);
    (found, expected)
}

#[test]
fn the_residual_is_of_second_order_and_known() {
    let plane = "x^2*p_y + sin(x)*p_x*p_y + y*p_x^3/3 + x*y^2";
    let point = [0.7, -0.4, 0.9, 0.3];
    let mut sizes = Vec::new();
    for epsilon in [0.1, 0.05, 0.025, 0.0125] {
        let (found, expected) = residuals(&["x", "y"], plane, epsilon, &point);
        assert!((&found - &expected).amax() < 4e-16 * 16.0, "{found} is not {expected}");
        assert!(expected.amax() > 1e-5);
        sizes.push(found.amax());
    }
    for pair in sizes.windows(2) {
        let slope = (pair[0] / pair[1]).log2();
        assert!((slope - 2.0).abs() < 1e-9, "{slope}");
    }
    let (found, expected) = residuals(&["x"], "x^2*p_x^3 + cos(x)", 0.2, &[0.8, -1.1]);
    assert!((&found - &expected).amax() < 1e-15, "{found} is not {expected}");
}

/// In one degree of freedom [Q, P] = 1 + ε² det G″: the bracket that fails, as an expression.
#[test]
fn the_bracket_that_fails_is_the_determinant() {
    let (mut model, mut equations, map, generator) = first_order(&["x"], "x^2*p_x^3 + cos(x)", 0.3);
    let verdict = map.verdict(&model, &mut equations);
    assert!(!verdict.canonical && verdict.proved);
    let [x, p] = [map.old[0], map.old[1]];
    let expected = {
        let pool = &mut model.pool;
        let second = |pool: &mut phaselab::expr::Pool, a, b| {
            let slope = pool.derivative(generator, a);
            pool.derivative(slope, b)
        };
        let (xx, pp, xp) = (second(pool, x, x), second(pool, p, p), second(pool, x, p));
        let (product, square) = (pool.mul(xx, pp), pool.mul(xp, xp));
        let determinant = pool.sub(product, square);
        let text = pool.text(determinant);
        format!("1 + e^2*({text})")
    };
    let is = equations.pool.text(verdict.failing[0].is);
    let difference = read(&mut model, &format!("{is} - ({expected})"));
    assert_eq!(model.pool.is_zero(difference), Zero::Proved, "{is} is not {expected}");
}

/// Where G″ 𝕁 G″ vanishes nothing is lacking: a drift, a kick, a translation are canonical as they stand.
#[test]
fn what_is_exact_at_first_order_is_proved_canonical() {
    for g in ["p_x^2/2", "x^4/4", "x", "3*p_x + exp(x)"] {
        let (model, mut equations, map, _) = first_order(&["x"], g, 0.3);
        let verdict = map.verdict(&model, &mut equations);
        assert!(verdict.canonical && verdict.proved, "{g}");
    }
    let (model, mut equations, map, _) = first_order(&["x"], "1/2*(p_x^2 + x^2)", 0.3);
    let verdict = map.verdict(&model, &mut equations);
    assert!(!verdict.canonical);
    // det G″ = 1 everywhere: a scale transformation of valence 1 + ε²
    let valence = verdict.valence.expect("a valence");
    assert_eq!(equations.pool.text(valence), "e^2 + 1");
}
