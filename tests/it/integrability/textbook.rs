//! What is found, compared with the formula of the textbook: a combination of it with the known constants, its products
//! included, is that formula.

use phaselab::expr::{Expr, Zero};
use phaselab::integrability::{Constant, Invariants};
use phaselab::mechanics::Equations;
use phaselab::model::Model;

use super::{hamiltonian, search, top};
use crate::build::read;

/// The found constant times a number is the formula, up to a multiple of the `others`, all found by one linear system
/// in floating point and then proved.
fn check(model: &mut Model, degree: u32, formula: &str, others: &[&str]) {
    let (mut equations, found) = search(model, degree);
    model.pool = equations.pool.clone();
    let formula = read(model, formula);
    let others: Vec<Expr> = others.iter().map(|text| read(model, text)).collect();
    equations.pool = model.pool.clone();
    let Invariants { found, .. } = found;
    let fits = |c: &Constant, equations: &mut Equations| {
        let mut parts = vec![c.expression];
        parts.extend(&others);
        combination(equations, formula, &parts)
    };
    assert!(found.iter().any(|c| fits(c, &mut equations)), "{}", equations.pool.text(formula));
}

/// Whether a formula is proved to be a combination of some functions with rational coefficients.
fn combination(equations: &mut Equations, formula: Expr, parts: &[Expr]) -> bool {
    use nalgebra::{DMatrix, DVector};
    let pool = &mut equations.pool;
    let n = parts.len();
    let rows = n + 6;
    let matrix =
        DMatrix::from_fn(rows, n, |i, j| pool.evaluate(parts[j], &crate::build::sample(i as u64)));
    let right =
        DVector::from_fn(rows, |i, _| pool.evaluate(formula, &crate::build::sample(i as u64)));
    let Ok(solution) = matrix.svd(true, true).solve(&right, 1e-12) else { return false };
    let terms: Vec<Expr> = parts
        .iter()
        .zip(solution.iter())
        .map(|(&e, &x)| {
            let n = (x * 2520.0).round() as i64;
            let c = pool.ratio(n, 2520);
            pool.mul(c, e)
        })
        .collect();
    let sum = pool.sum(&terms);
    let difference = pool.sub(formula, sum);
    pool.is_zero(difference) == Zero::Proved
}

#[test]
fn laplace_runge_lenz() {
    // Goldstein, *Classical Mechanics*, § 3.9
    let h = "1/2*(p_x^2 + p_y^2) - 1/sqrt(x^2 + y^2)";
    let mut model = hamiltonian(&["x", "y"], &[], h);
    check(&mut model, 2, "p_y*(x*p_y - y*p_x) - x/sqrt(x^2 + y^2)", &[]);
    check(&mut model, 2, "-p_x*(x*p_y - y*p_x) - y/sqrt(x^2 + y^2)", &[]);
}

#[test]
fn kovalevskaya() {
    // S. Kovalevskaya, Acta Mathematica 12 (1889) 177: |ξ|² with ξ = ½(M₁ + iM₂)² + c(γ₁ + iγ₂), for H with −g₁
    let mut model = top("1/2*(M1^2 + M2^2 + 2*M3^2) - g1");
    let k = "(M1^2/2 - M2^2/2 + g1)^2 + (M1*M2 + g2)^2";
    let h = "1/2*(M1^2 + M2^2 + 2*M3^2) - g1";
    let l = "M1*g1 + M2*g2 + M3*g3";
    let others = [&format!("({h})^2"), "g1^2 + g2^2 + g3^2", &format!("({l})^2"), h]
        .map(ToString::to_string);
    let others: Vec<&str> = others.iter().map(String::as_str).collect();
    check(&mut model, 4, k, &others);
}

#[test]
fn henon_heiles_with_sixteen() {
    // J. Hietarinta, Physics Reports 147 (1987) 87, § 3.2.1: the case (1, 16, 16/3)
    let h = "1/2*(p_x^2 + p_y^2) + 1/2*(x^2 + 16*y^2) + x^2*y + 16/3*y^3";
    let mut model = hamiltonian(&["x", "y"], &[], h);
    let i = "p_x^4 + 2*x^2*p_x^2 + 4*x^2*y*p_x^2 - 4/3*x^3*p_x*p_y + x^4 - 4/3*x^4*y - 4/3*x^4*y^2 - 2/9*x^6";
    check(&mut model, 4, i, &[]);
}

#[test]
fn tufillaro() {
    // N. B. Tufillaro, American Journal of Physics 54 (1986) 142, at M = 3m, m = 1
    let h = "p_r^2/8 + p_theta^2/(2*r^2) + r*(3 - cos(theta))";
    let mut model = hamiltonian(&["r", "theta"], &[], h);
    let i = "p_theta*(p_r/4*cos(theta/2) - p_theta/(2*r)*sin(theta/2)) + r^2*sin(theta/2)*cos(theta/2)^2";
    check(&mut model, 2, i, &[]);
}

#[test]
fn toda() {
    // M. Hénon, Physical Review B 9 (1974) 1921
    let h = "1/2*(p_q1^2 + p_q2^2 + p_q3^2) + exp(q1 - q2) + exp(q2 - q3) + exp(q3 - q1)";
    let mut model = hamiltonian(&["q1", "q2", "q3"], &[], h);
    let i = "p_q1*p_q2*p_q3 - p_q1*exp(q2 - q3) - p_q2*exp(q3 - q1) - p_q3*exp(q1 - q2)";
    check(&mut model, 3, i, &[]);
}
