//! Mechanical similarity and the virial theorem, against Landau and Lifshitz, § 10, and against averages of a motion.

use phaselab::mechanics::{self, Similarity};

use crate::build::{hamiltonian, lagrangian, sample};

fn find(coordinates: &[&str], l: &str) -> Option<(String, String, usize)> {
    let model = lagrangian(coordinates, &["m", "k", "n"], l);
    let mut e = mechanics::derive(&model).expect("derivable");
    let Similarity { scaled, degree, virial, kinetic, potential } = e.similarity()?;
    // 2T − kV is the rate of Σ q p along the motion
    let solved = e.solved.clone().expect("accelerations");
    let mut along = Vec::new();
    for (c, a) in e.coordinates.clone().into_iter().zip(solved) {
        let v = e.pool.variable(c.velocity);
        along.extend([(c.position, v), (c.velocity, a)]);
    }
    let rate = e.pool.derivation(virial, &along);
    for seed in 0..20 {
        let at = sample(seed);
        let value = |x| e.pool.evaluate(x, &at);
        let right = 2.0 * value(kinetic) - value(degree) * value(potential);
        let size = value(kinetic).abs() + (value(degree) * value(potential)).abs();
        let left = value(rate);
        if left.is_finite() {
            assert!((left - right).abs() < 1e-12 * (1.0 + size), "{left} is not {right}");
        }
    }
    Some((e.pool.text(degree), e.pool.text(virial), scaled.len()))
}

#[test]
fn degrees() {
    let degree = |q: &[&str], l: &str| find(q, l).map(|(degree, _, n)| (degree, n));
    let known = |k: &str, n: usize| Some((k.to_owned(), n));
    assert_eq!(degree(&["x"], "1/2*m*x'^2 - 1/2*k*x^2"), known("2", 1));
    assert_eq!(degree(&["x", "y"], "1/2*(x'^2 + y'^2) + k/sqrt(x^2 + y^2)"), known("-1", 2));
    assert_eq!(degree(&["r", "phi"], "1/2*m*(r'^2 + r^2*phi'^2) + k/r"), known("-1", 1));
    assert_eq!(degree(&["z"], "1/2*m*z'^2 - m*k*z"), known("1", 1));
    assert_eq!(degree(&["x", "y"], "1/2*(x'^2 + y'^2) - x^2*y^2"), known("4", 2));
    // an exponent that is a parameter
    assert_eq!(degree(&["r", "phi"], "1/2*m*(r'^2 + r^2*phi'^2) - k*r^n"), known("n", 1));
}

#[test]
fn what_is_not_homogeneous() {
    assert!(find(&["x"], "1/2*x'^2 - 1/2*x^2 - 1/4*x^4").is_none());
    assert!(find(&["x"], "1/2*x'^2 + cos(x)").is_none());
    assert!(find(&["x"], "1/2*x'^2").is_none());
    assert!(find(&["x", "y"], "1/2*(x'^2 + y'^2) + k*x*y' - x^2").is_none());
    assert!(find(&["x"], "1/2*x'^2 - t*x^2").is_none());
    assert!(find(&["x"], "1/2*x'^2 - x^2 - 1e-9*x^4").is_none());
    assert!(find(&["x"], "1/4*x'^4 - x^2").is_none());
    // H without a Lagrangian of degree 2
    let model = hamiltonian(&["x"], &[], "1/2*p_x^2 + p_x*x + x^2");
    assert!(mechanics::derive(&model).expect("derivable").similarity().is_none());
}
