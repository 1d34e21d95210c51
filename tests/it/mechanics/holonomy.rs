//! Whether constraints on the velocities are holonomic, against textbook cases, and with negatives: what is not proved
//! is not claimed. A constant that is found is checked along random admissible velocities, by differences.
//! Sources: Ju. I. Neimark, N. A. Fufaev, *Dynamics of Nonholonomic Systems*, ch. I; H. Goldstein, *Classical Mechanics*,
//! § 1.3; for three-term forms, L. A. Pars, *A Treatise on Analytical Dynamics*, §§ 1.5–1.7.

use nalgebra::{DMatrix, DVector};
use phaselab::expr::Expr;
use phaselab::mechanics::{self, Equations, Holonomy};

use crate::build::{constrain, lagrangian, sample};

fn find(coordinates: &[&str], constraints: &[&str]) -> Equations {
    let squares: Vec<String> = coordinates.iter().map(|q| format!("1/2*{q}'^2")).collect();
    let mut model = lagrangian(coordinates, &["r", "a"], &squares.join(" + "));
    let names: Vec<String> = (0..constraints.len()).map(|k| format!("c{k}")).collect();
    let named: Vec<(&str, &str)> =
        names.iter().map(String::as_str).zip(constraints.iter().copied()).collect();
    constrain(&mut model, &named);
    mechanics::derive_for_motion(&model).expect("derivable")
}

fn answers(coordinates: &[&str], constraints: &[&str]) -> Vec<Option<bool>> {
    let equations = find(coordinates, constraints);
    equations.supplements.holonomy.iter().map(Holonomy::answer).collect()
}

/// The constants that were found; each one moves by nothing along velocities that satisfy all constraints.
fn constants(coordinates: &[&str], constraints: &[&str]) -> Vec<Option<String>> {
    let equations = find(coordinates, constraints);
    let pool = &equations.pool;
    let n = coordinates.len();
    let of = |h: &Holonomy| match h {
        Holonomy::Holonomic { constant, .. } => *constant,
        other => panic!("{constraints:?}: {other:?}"),
    };
    let all: Vec<Option<Expr>> = equations.supplements.holonomy.iter().map(of).collect();
    for &f in all.iter().flatten() {
        for seed in 0..10 {
            let at = sample(seed);
            let rows = &equations.constraints;
            let a = DMatrix::from_fn(rows.len(), n, |k, i| pool.evaluate(rows[k].row[i], &at));
            let rate = DVector::from_fn(rows.len(), |k, _| pool.evaluate(rows[k].rate, &at));
            let wanted = DVector::from_fn(n, |i, _| {
                pool.evaluate(Expr::ONE, &at) * (0.3 + 0.7 * i as f64 - 0.2 * seed as f64)
            });
            // the nearest admissible velocity
            let inverse = a.clone().pseudo_inverse(1e-12).expect("regular");
            let velocity = &wanted - inverse * (&a * &wanted + rate);
            let value = |h: f64| {
                pool.evaluate(f, &|s| {
                    let i = equations.coordinates.iter().position(|c| c.position == s);
                    if s == equations.symbols.time {
                        at(s) + h
                    } else {
                        at(s) + i.map_or(0.0, |i| h * velocity[i])
                    }
                })
            };
            let h = 1e-5;
            let slope = (value(h) - value(-h)) / (2.0 * h);
            assert!(slope.abs() < 1e-7, "{}: {slope}", pool.text(f));
        }
    }
    all.iter().map(|f| f.map(|f| pool.text(f))).collect()
}

#[test]
fn what_is_not_holonomic_is_not_called_so() {
    // the edge of a knife, and of a skate that is not above its own centre
    assert_eq!(answers(&["x", "y", "phi"], &["x'*sin(phi) - y'*cos(phi)"]), [Some(false)]);
    let off = "y'*cos(phi) - x'*sin(phi) - a*phi'";
    assert_eq!(answers(&["x", "y", "phi"], &[off]), [Some(false)]);
    // a disc rolling upright: neither condition
    let disc = ["x' - r*cos(phi)*psi'", "y' - r*sin(phi)*psi'"];
    assert_eq!(answers(&["x", "y", "phi", "psi"], &disc), [Some(false), Some(false)]);
    // Heisenberg's form, Pars's example, and one with the time
    assert_eq!(answers(&["x", "y", "z"], &["z' - y*x'"]), [Some(false)]);
    assert_eq!(answers(&["x", "y", "z"], &["z' - x*y' + y*x'"]), [Some(false)]);
    assert_eq!(answers(&["x", "y"], &["y' - t*x'"]), [Some(false)]);
    // a rate that depends on another coordinate: dy − x y dt
    assert_eq!(answers(&["x", "y"], &["y' - x*y"]), [Some(false)]);
    assert_eq!(answers(&["x", "y"], &["x' - y"]), [Some(false)]);
    // a small term is a term
    assert_eq!(answers(&["x", "y", "z"], &["z' - x' - 1e-9*y*x'"]), [Some(false)]);
}

#[test]
fn what_is_holonomic_is_proved_with_its_constant() {
    assert_eq!(constants(&["x", "theta"], &["r*theta' - x'"]), [Some("r*theta - x".to_owned())]);
    // an integrating factor
    for one in ["y*x' - x*y'", "x*x' + y*y'", "cos(y)*x' - x*sin(y)*y'", "y' - 2*t*y"] {
        let found = constants(&["x", "y"], &[one]);
        assert!(found[0].is_some(), "{one}");
    }
    let found = constants(&["x", "y", "z"], &["y*z*x' + x*z*y' + x*y*z'"]);
    assert_eq!(found, [Some("x*y*z".to_owned())]);
    let found = constants(&["x", "y", "z"], &["(y + z)*x' + (z + x)*y' + (x + y)*z'"]);
    assert!(found[0].is_some());
    // with the time
    let found = constants(&["x", "y"], &["x' + t*y' + y"]);
    assert_eq!(found, [Some("t*y + x".to_owned())]);
    // a function of one coordinate has an integral, known or not
    assert_eq!(answers(&["x", "y"], &["x' - sin(y^2)*y'"]), [Some(true)]);
    assert_eq!(answers(&["x", "y"], &["(1 + x*y)*x' + exp(x*y^2)*y'"]), [Some(true)]);
}

#[test]
fn a_disc_upright_in_a_line_is_holonomic() {
    let q = ["x", "y", "phi", "psi"];
    let all = ["x' - r*cos(phi)*psi'", "y' - r*sin(phi)*psi'", "phi'"];
    let found = constants(&q, &all);
    assert_eq!(found[2].as_deref(), Some("phi"));
    for (k, f) in found.iter().enumerate() {
        assert!(f.is_some(), "{k}");
    }
    let equations = find(&q, &all);
    let alone = |k: usize| match &equations.supplements.holonomy[k] {
        Holonomy::Holonomic { together, .. } => !together,
        other => panic!("{other:?}"),
    };
    assert!(alone(2) && !alone(0) && !alone(1));
    // in a plane with one of the two conditions only on a line
    let partly = answers(&q, &["x' - r*cos(phi)*psi'", "y'"]);
    assert_eq!(partly, [Some(false), Some(true)]);
}

#[test]
fn several_constraints_hide_nothing() {
    // Engel's system: dy − z dx closes modulo dz − w dx, which does not: neither is holonomic, and the first is not
    // claimed to be
    let engel = answers(&["x", "y", "z", "w"], &["y' - z*x'", "z' - w*x'"]);
    assert_eq!(engel[1], Some(false));
    assert_ne!(engel[0], Some(true));
    // a constraint given twice makes every product of forms vanish, which proves nothing
    let twice = answers(&["x", "y", "z"], &["z' - y*x'", "2*z' - 2*y*x'"]);
    assert!(twice.iter().all(|answer| *answer != Some(true)), "{twice:?}");
    // held to a plane, what was not integrable is
    assert_eq!(answers(&["x", "y", "z"], &["z' - y*x'", "y"])[0], Some(true));
    assert_eq!(answers(&["x", "y", "z"], &["z' - y*x'", "z - 1"])[0], Some(true));
    // held to another surface it stays as it is
    assert_eq!(answers(&["x", "y", "z", "w"], &["z' - y*x'", "w"])[0], Some(false));
}

#[test]
fn pieces_that_are_holonomic_are_not_together() {
    // on each side of x = 0 an integral exists, and across it none: with s = ±1 every point is reached
    for one in ["sign(x)*y' + z'", "x/abs(x)*y' + z'", "x/sqrt(x^2)*y' + z'"] {
        assert_ne!(answers(&["x", "y", "z"], &[one]), [Some(true)], "{one}");
    }
    assert_eq!(answers(&["x", "y", "z"], &["abs(x)*y' + z'"]), [Some(false)]);
    assert_eq!(answers(&["x", "y", "z"], &["max(x, 0)*y' + z'"]), [Some(false)]);
}
