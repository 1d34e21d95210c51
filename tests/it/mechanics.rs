//! Derivations from L or H, compared with equations derived by hand at random states.

mod bracket;
mod canonical_far;
mod closed_forms;
mod conserved;
mod frames;
mod gauge;
mod holonomy;
mod infinitesimal;
mod named_ramps;
mod similarity;

use nalgebra::{DMatrix, DVector};
use phaselab::expr::{Expr, Pool, Symbol, Zero};
use phaselab::mechanics::{self, Equations, Flow, Reason};
use phaselab::model::Model;

use crate::build::{dissipative, hamiltonian, lagrangian, read, sample};

/// The accelerations M⁻¹f at a random state.
fn accelerations(equations: &Equations, at: &dyn Fn(Symbol) -> f64) -> Vec<f64> {
    let Flow::Lagrange { mass, force, .. } = &equations.flow else { panic!("not a Lagrangian") };
    let n = force.len();
    let m = DMatrix::from_fn(n, n, |i, j| equations.pool.evaluate(mass[i][j], at));
    let f = DVector::from_fn(n, |i, _| equations.pool.evaluate(force[i], at));
    let a = m.full_piv_lu().solve(&f).expect("a regular mass matrix");
    a.iter().copied().collect()
}

/// Checks accelerations, and the symbolically solved form where there is one, against hand-written
/// expressions.
fn check(mut model: Model, by_hand: &[&str]) -> Equations {
    let expected: Vec<Expr> = by_hand.iter().map(|text| read(&mut model, text)).collect();
    let equations = mechanics::derive(&model).expect("derivable");
    for seed in 0..40 {
        let at = sample(seed);
        let found = accelerations(&equations, &at);
        for (i, &e) in expected.iter().enumerate() {
            let right = equations.pool.evaluate(e, &at);
            let close = |x: f64| (x - right).abs() <= 1e-13 * (1.0 + right.abs()) * 10.0;
            assert!(close(found[i]), "{}: {} is not {right}", by_hand[i], found[i]);
            if let Ok(solved) = &equations.solved {
                let x = equations.pool.evaluate(solved[i], &at);
                assert!(close(x), "solved {}: {x} is not {right}", by_hand[i]);
            }
        }
    }
    equations
}

#[test]
fn pendulum() {
    let model = lagrangian(&["theta"], &["m", "g", "l"], "1/2*m*l^2*theta'^2 + m*g*l*cos(theta)");
    let e = check(model, &["-g/l*sin(theta)"]);
    assert_eq!(e.pool.unicode(e.energy), "½ m l² θ′² − m g l cos θ");
    assert_eq!(e.pool.unicode(*e.hamiltonian.as_ref().expect("H")), "p_θ²/(2 m l²) − m g l cos θ");
    assert!(e.separable.is_ok());
    assert!(e.cyclic.is_empty());
}

#[test]
fn differences_have_one_sign_in_all_equations() {
    for (potential, slope, written) in [
        ("k*(1 - e)*x", "k*(1 - e)", "k (1 − e) x"),
        ("k*(1 - e)/(1 - f)*x^2", "2*k*(1 - e)/(1 - f)*x", "k (1 − e) x²/(1 − f)"),
        ("(e - 1)*(f - 1)*(1 - cos(x))", "(e - 1)*(f - 1)*sin(x)", "(1 − e) (1 − f) (1 − cos x)"),
    ] {
        let law = format!("1/2*m*x'^2 - {potential}");
        let model = lagrangian(&["x"], &["m", "k", "e", "f"], &law);
        let e = check(model, &[&format!("-{slope}/m")]);
        let (l, h) = (e.lagrangian.expect("L"), e.hamiltonian.expect("H"));
        assert_eq!(e.pool.unicode(l), format!("½ m x′² − {written}"));
        assert_eq!(e.pool.unicode(h), format!("p_x²/(2 m) + {written}"));
    }
}

#[test]
fn heavy_symmetric_top() {
    // Goldstein, *Classical Mechanics*, § 5.7, by hand
    let model = lagrangian(
        &["theta", "phi", "psi"],
        &["I1", "I3", "Mgl"],
        "1/2*I1*(theta'^2 + phi'^2*sin(theta)^2) + 1/2*I3*(psi' + phi'*cos(theta))^2 - Mgl*cos(theta)",
    );
    let spin = "(psi' + phi'*cos(theta))";
    let phi = format!("(I3*{spin}*theta' - 2*I1*phi'*theta'*cos(theta))/(I1*sin(theta))");
    let e = check(
        model,
        &[
            &format!("sin(theta)*(I1*phi'^2*cos(theta) - I3*{spin}*phi' + Mgl)/I1"),
            &phi,
            &format!("phi'*theta'*sin(theta) - cos(theta)*{phi}"),
        ],
    );
    assert_eq!(e.cyclic, [1, 2]);
    let h = e.pool.unicode(*e.hamiltonian.as_ref().expect("H"));
    assert_eq!(h, "p_θ²/(2 I₁) + p_ψ²/(2 I₃) + (p_φ − p_ψ cos θ)²/(2 I₁ sin² θ) + Mgl cos θ");
}

#[test]
fn double_pendulum() {
    // twice: with the difference of the angles, and from Cartesian velocities
    let potential = "(m1+m2)*g*l1*cos(a) + m2*g*l2*cos(b)";
    let kinetic = [
        "1/2*(m1+m2)*l1^2*a'^2 + 1/2*m2*l2^2*b'^2 + m2*l1*l2*a'*b'*cos(a-b)",
        "1/2*m1*l1^2*a'^2 + 1/2*m2*((l1*a'*cos(a) + l2*b'*cos(b))^2 \
         + (l1*a'*sin(a) + l2*b'*sin(b))^2)",
    ];
    for kinetic in kinetic {
        let l = format!("{kinetic} + {potential}");
        let model = lagrangian(&["a", "b"], &["m1", "m2", "l1", "l2", "g"], &l);
        let below = "(m1 + m2*sin(a-b)^2)";
        let e = check(
            model,
            &[
                &format!(
                    "(m2*g*sin(b)*cos(a-b) - m2*sin(a-b)*(l1*a'^2*cos(a-b) + l2*b'^2) - (m1+m2)*g*sin(a))/(l1*{below})"
                ),
                &format!(
                    "((m1+m2)*(l1*a'^2*sin(a-b) - g*sin(b) + g*sin(a)*cos(a-b)) + m2*l2*b'^2*sin(a-b)*cos(a-b))/(l2*{below})"
                ),
            ],
        );
        let h = "p_b²/(2 m₂ l₂²) + (p_a − (l₁/l₂) p_b cos(a − b))²/(2 l₁² (m₁ + m₂ sin²(a − b))) \
                 − (m₁ + m₂) g l₁ cos a − m₂ g l₂ cos b";
        assert_eq!(e.pool.unicode(*e.hamiltonian.as_ref().expect("H")), h);
    }
}

#[test]
fn explicit_time_and_velocity_terms() {
    // a pendulum with an oscillating pivot: SICM § 1.6.2
    let model = lagrangian(
        &["theta"],
        &["m", "g", "l", "a", "w"],
        "1/2*m*((l*theta'*cos(theta))^2 + (l*theta'*sin(theta) - a*w*sin(w*t))^2) \
         + m*g*(l*cos(theta) - a*cos(w*t))",
    );
    let e = check(model, &["-(g - a*w^2*cos(w*t))*sin(theta)/l"]);
    assert!(!e.conserved.iter().any(|c| c.name == "energy"));
    // a charge in uniform fields, Gaussian units
    let model = lagrangian(
        &["x", "y", "z"],
        &["m", "q", "B", "E", "c"],
        "1/2*m*(x'^2+y'^2+z'^2) + q*E*x + q*B/(2*c)*(x*y'-y*x')",
    );
    let e = check(model, &["q/m*(E + B*y'/c)", "-q*B*x'/(m*c)", "0"]);
    assert_eq!(e.cyclic, [2]);
}

#[test]
fn friction_and_forces() {
    let mut model = dissipative(
        &["x", "y"],
        &["m", "k", "c", "d", "A", "w"],
        "1/2*m*(x'^2 + 4*y'^2) - 1/2*k*(x-y)^2 + t*x",
        "1/2*c*x'^2 + 1/4*d*y'^4",
        &["A*cos(w*t)", "-d*x*y'"],
    );
    let rate = read(&mut model, "-x - c*x'^2 - d*y'^4 + x'*A*cos(w*t) - d*x*y'^2");
    let e = check(
        model,
        &["(-k*(x-y) + t - c*x' + A*cos(w*t))/m", "(k*(x-y) - d*y'^3 - d*x*y')/(4*m)"],
    );
    for seed in 0..20 {
        let at = sample(seed);
        let (found, right) = (e.pool.evaluate(e.energy_rate, &at), e.pool.evaluate(rate, &at));
        assert!((found - right).abs() < 1e-13 * (1.0 + right.abs()), "{found} is not {right}");
    }
    assert!(e.conserved.is_empty());
    assert!(e.separable.is_err());
}

#[test]
fn cyclic_coordinates_are_seen_through_cartesian_definitions() {
    let model = lagrangian(
        &["r", "phi"],
        &["m", "k"],
        "1/2*m*((r'*cos(phi)-r*phi'*sin(phi))^2+(r'*sin(phi)+r*phi'*cos(phi))^2) \
         + k/sqrt((r*cos(phi))^2 + (r*sin(phi))^2)",
    );
    let e = check(model, &["r*phi'^2 - k/(m*r^2)", "-2*r'*phi'/r"]);
    assert_eq!(e.cyclic, [1]);
    assert_eq!(e.conserved[0].reason, Reason::Cyclic("φ".to_owned()));
    // an approximate identity is not simplified
    let model = lagrangian(&["x"], &["k"], "1/2*x'^2 - k*(sin(x)^2 + cos(x)^2 + 1e-9*x)");
    let e = mechanics::derive(&model).expect("derivable");
    assert!(e.cyclic.is_empty());
}

#[test]
fn a_balanced_force_does_not_make_a_coordinate_cyclic() {
    let model = dissipative(&["x"], &["k"], "1/2*x'^2 - 1/2*k*x^2", "0", &["k*x"]);
    let e = mechanics::derive(&model).expect("derivable");
    assert!(e.cyclic.is_empty());
    assert_eq!(e.conserved[0].name, "p_x");
}

#[test]
fn common_translations_and_rotations_are_found() {
    let potential = "k/sqrt((x1-x2)^2 + (y1-y2)^2)";
    let l = format!("1/2*m*(x1'^2+y1'^2) + x2'^2 + y2'^2 + {potential}");
    let names = |model: &Model| -> Vec<String> {
        let e = mechanics::derive(model).expect("derivable");
        e.conserved.iter().map(|c| c.name.clone()).collect()
    };
    let q = ["x1", "y1", "x2", "y2"];
    let free = lagrangian(&q, &["m", "k"], &l);
    assert_eq!(names(&free), ["energy", "total p_x", "total p_y", "L_z"]);
    let pulled = lagrangian(&q, &["m", "k"], &format!("{l} + x1"));
    assert_eq!(names(&pulled), ["energy", "total p_y"]);
    // two bodies are as often called x, y and X, Y
    let other = l.replace("x1", "x").replace("y1", "y").replace("x2", "X").replace("y2", "Y");
    let capital = lagrangian(&["x", "y", "X", "Y"], &["m", "k"], &other);
    assert_eq!(names(&capital), names(&free));
    let pulled = lagrangian(&["x", "y", "X", "Y"], &["m", "k"], &format!("{other} + X"));
    assert_eq!(names(&pulled), ["energy", "total p_y"]);
    // X turns round by itself, beside a pair that does
    let apart = "1/2*(x'^2 + y'^2 + X'^2 + Y'^2) - (x^2 + y^2)^2 - X^2 - 2*Y^2";
    let apart = lagrangian(&["x", "y", "X", "Y"], &[], apart);
    assert_eq!(names(&apart), ["energy", "L_z"]);
    // what turns by itself has more angular momentum than that of its path
    let mut rod = lagrangian(&["x", "y", "phi"], &[], "1/2*(x'^2 + y'^2) + 1/2*phi'^2");
    assert!(names(&rod).contains(&"L_z".to_owned()), "{:?}", names(&rod));
    rod.coordinates[2].unit = "rad".to_owned();
    assert!(names(&rod).contains(&"orbital L_z".to_owned()), "{:?}", names(&rod));
    let central = hamiltonian(&["x", "y"], &["k"], "1/2*(p_x^2+p_y^2) - k/sqrt(x^2+y^2)");
    assert_eq!(names(&central), ["energy", "L_z"]);
    let oblate = hamiltonian(&["x", "y"], &["k"], "1/2*(p_x^2+p_y^2) - k/sqrt(x^2+2*y^2)");
    assert_eq!(names(&oblate), ["energy"]);
}

/// Checks the text of a model's H, and that transforming back gives L again.
fn check_there_and_back(model: &Model, h: &str) {
    let mut e = mechanics::derive(model).expect("derivable");
    let found = *e.hamiltonian.as_ref().expect("H in closed form");
    assert_eq!(e.pool.text(found), h);
    let l = *e.lagrangian.as_ref().expect("L");
    let coordinates = e.coordinates.clone();
    let back = mechanics::hamiltonian_to_lagrangian(&mut e.pool, &coordinates, found).expect("L");
    let difference = e.pool.sub(l, back);
    assert_ne!(e.pool.is_zero(difference), Zero::No, "{}", e.pool.text(back));
}

#[test]
fn the_legendre_transform_goes_there_and_back() {
    check_there_and_back(
        &lagrangian(&["x"], &["m", "k"], "1/2*m*x'^2 - 1/2*k*x^2"),
        "1/2*p_x^2/m + 1/2*k*x^2",
    );
    check_there_and_back(
        &lagrangian(&["x", "y"], &["b"], "1/2*x'^2 + x'*y' + y'^2 + b*x*y'"),
        "1/2*p_x^2 + 1/2*(p_x - p_y + b*x)^2",
    );
    check_there_and_back(
        &lagrangian(&["x"], &["m", "c", "k"], "-m*c^2*sqrt(1 - x'^2/c^2) - 1/2*k*x^2"),
        "m*c^2*sqrt(p_x^2/(m^2*c^2) + 1) + 1/2*k*x^2",
    );
}

#[test]
fn where_there_is_no_hamiltonian_the_reason_is_said() {
    let why = |l: &str| {
        let e = mechanics::derive(&lagrangian(&["x", "y"], &["m"], l)).expect("derivable");
        e.hamiltonian.expect_err("no closed form").to_string()
    };
    assert_eq!(why("m*x'^4 + y'^2"), "L is not quadratic in the velocities");
    assert_eq!(
        why("1/2*m*(x' + y')^2"),
        "velocities cannot be eliminated with the mass matrix: the matrix is singular"
    );
}

#[test]
fn splitting_is_refused_by_name_and_reason() {
    let separable = |h: &str| {
        let e = mechanics::derive(&hamiltonian(&["x", "y"], &["k"], h)).expect("derivable");
        e.separable.map(|_| ()).map_err(|why| why.to_string())
    };
    assert_eq!(separable("1/2*(p_x^2 + p_y^2) + x^2*y"), Ok(()));
    assert_eq!(separable("sqrt(1 + p_x^2) + p_y^4 + x^2*y*cos(t)"), Ok(()));
    assert_eq!(
        separable("1/2*(p_x^2 + p_y^2) + k*(x*p_y - y*p_x)"),
        Err("H is not of the form T(p) + V(q, t): ∂²H/∂p_x∂y does not vanish".to_owned())
    );
}

#[test]
fn declared_observables_are_proved_or_not() {
    // Laplace–Runge–Lenz vector, Goldstein § 3.9
    let mut model = hamiltonian(&["x", "y"], &["k"], "1/2*(p_x^2+p_y^2) - k/sqrt(x^2+y^2)");
    let lenz = read(&mut model, "p_y*(x*p_y - y*p_x) - k*x/sqrt(x^2+y^2)");
    let other = read(&mut model, "p_y*(x*p_y - y*p_x) - k*y/sqrt(x^2+y^2)");
    let boost = read(&mut model, "x - p_x*t");
    let mut e = mechanics::derive(&model).expect("derivable");
    assert_eq!(e.is_conserved(lenz), Some(Zero::Proved));
    assert_eq!(e.is_conserved(other), Some(Zero::No));
    assert_eq!(e.is_conserved(boost), Some(Zero::No));
    let free = hamiltonian(&["x"], &[], "1/2*p_x^2");
    let mut e = mechanics::derive(&free).expect("derivable");
    let mut model = free;
    let boost = read(&mut model, "x - p_x*t");
    e.pool = model.pool;
    assert_eq!(e.is_conserved(boost), Some(Zero::Proved));
}

/// The energy function and its law agree with a finite difference along the flow.
#[test]
fn the_energy_law_holds_along_the_flow() {
    let model = dissipative(
        &["x", "y"],
        &["k", "c"],
        "1/2*(1 + x^2)*x'^2 + x'*y'*cos(t) + y'^2 + t*x'*y - k*x^2*y^2",
        "1/4*c*(x'^2 + y'^2)^2",
        &["sin(t)", "x*y'"],
    );
    let mut e = mechanics::derive(&model).expect("derivable");
    let energy = e.energy;
    let mut seeds = vec![(e.symbols.time, Expr::ONE)];
    let solved = e.solved.clone().expect("two degrees of freedom");
    for (c, a) in e.coordinates.clone().into_iter().zip(solved) {
        let v = e.pool.variable(c.velocity);
        seeds.extend([(c.position, v), (c.velocity, a)]);
    }
    let rate = e.pool.derivation(energy, &seeds);
    agree(&e.pool, rate, e.energy_rate);
}

fn agree(pool: &Pool, a: Expr, b: Expr) {
    for seed in 0..40 {
        let at = sample(seed);
        let (x, y) = (pool.evaluate(a, &at), pool.evaluate(b, &at));
        assert!((x - y).abs() <= 1e-12 * (1.0 + x.abs()), "{x} is not {y}");
    }
}
