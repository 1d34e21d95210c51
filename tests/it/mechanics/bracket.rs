//! Brackets compared with the tables of textbooks, their own algebra, and the motion.

use nalgebra::{DMatrix, DVector};
use phaselab::expr::{Expr, Zero};
use phaselab::integrate::{Settings, Stepper, method_named};
use phaselab::mechanics::{
    self, ChainRule, Equations, Flow, NoClosedForm, bracket, in_phase_space, recognise,
};
use phaselab::model::{Allowed, Mechanics, Model, Observable, Scope, WrittenExpr};
use phaselab::preset::Catalog;
use phaselab::system::System;
use proptest::prelude::*;

use crate::build::{hamiltonian, lagrangian, names, read, sample};

fn observe(model: &mut Model, name: &str, text: &str) {
    let expression = read(model, text);
    let name = name.to_owned();
    model.observables.push(Observable {
        name,
        expression,
        conserved: None,
        unit: String::new(),
        place: 0..0,
    });
}

/// Kepler's problem in space, with its angular momentum and Runge–Lenz vector, by L or by H.
fn kepler(by_velocities: bool) -> Model {
    let (names, r) = (["x", "y", "z"], "sqrt(x^2 + y^2 + z^2)");
    let mut model = if by_velocities {
        let l = format!("1/2*m*(x'^2 + y'^2 + z'^2) + k/{r}");
        lagrangian(&names, &["m", "k"], &l)
    } else {
        let h = format!("(p_x^2 + p_y^2 + p_z^2)/(2*m) - k/{r}");
        hamiltonian(&names, &["m", "k"], &h)
    };
    observe(&mut model, "L_x", "y*p_z - z*p_y");
    observe(&mut model, "L_y", "z*p_x - x*p_z");
    observe(&mut model, "L_z", "x*p_y - y*p_x");
    observe(&mut model, "A_x", &format!("p_y*L_z - p_z*L_y - m*k*x/{r}"));
    observe(&mut model, "A_y", &format!("p_z*L_x - p_x*L_z - m*k*y/{r}"));
    observe(&mut model, "A_z", &format!("p_x*L_y - p_y*L_x - m*k*z/{r}"));
    model
}

/// Reads an expression in the names of a model.
fn look(model: &Model, equations: &mut Equations, text: &str) -> Expr {
    let mut scope = Scope::new(model, Allowed::Observable, "a test");
    scope
        .read(&mut equations.pool, text)
        .unwrap_or_else(|| panic!("{text}: {:?}", scope.diagnostics))
}

/// The bracket of two observables as text, and how its form was established.
fn reported(model: &Model, equations: &mut Equations, f: &str, g: &str) -> (String, Zero) {
    let (f, g) = (look(model, equations, f), look(model, equations, g));
    let e = bracket(model, equations, f, g).expect("a closed form");
    match recognise(model, equations, e) {
        Some(known) => (equations.pool.text(known.expression), known.proof),
        None => (equations.pool.text(e), Zero::No),
    }
}

#[test]
fn kepler_has_the_algebra_of_rotations_in_four_dimensions() {
    // Goldstein, *Classical Mechanics*, § 9.7: [L_i, L_j] = ε L_k, [A_i, L_j] = ε A_k,
    // [A_i, A_j] = −2 m H ε L_k
    let proved = |text: &str| (text.to_owned(), Zero::Proved);
    for by_velocities in [false, true] {
        let model = kepler(by_velocities);
        let mut e = mechanics::derive(&model).expect("derivable");
        for (f, g, is) in [
            ("L_x", "L_y", "L_z"),
            ("L_y", "L_x", "-L_z"),
            ("L_z", "L_x", "L_y"),
            ("A_x", "L_y", "A_z"),
            ("A_x", "L_z", "-A_y"),
            ("A_x", "L_x", "0"),
            ("A_x", "A_y", "-2*m*energy*L_z"),
            ("A_y", "A_z", "-2*m*energy*L_x"),
            ("A_z", "A_x", "-2*m*energy*L_y"),
            ("A_x", "energy", "0"),
            ("L_z", "energy", "0"),
            ("x*L_x + y*L_y", "L_z", "0"),
        ] {
            assert_eq!(reported(&model, &mut e, f, g), proved(is), "[{f}, {g}]");
        }
        assert_eq!(reported(&model, &mut e, "x", "p_x").0, "1");
        assert_eq!(reported(&model, &mut e, "x", "p_y"), proved("0"));
        assert_eq!(reported(&model, &mut e, "x'", "x").0, "-1/m");
    }
}

#[test]
fn what_a_bracket_is_called_by_parameters_and_names() {
    let mut model = hamiltonian(&["x", "y"], &["m", "w"], "(p_x^2 + p_y^2)/(2*m)");
    observe(&mut model, "spread", "m*w*(x^2 + y^2)");
    observe(&mut model, "L", "x*p_y - y*p_x");
    observe(&mut model, "D", "x*p_x + y*p_y");
    let mut e = mechanics::derive(&model).expect("derivable");
    assert_eq!(reported(&model, &mut e, "spread", "energy").0, "2*w*D");
    assert_eq!(reported(&model, &mut e, "D", "energy").0, "2*energy");
    assert_eq!(reported(&model, &mut e, "D", "spread^2").0, "-4*spread^2");
    // an expression without a name is written out
    assert_eq!(reported(&model, &mut e, "L", "x").0, "y");
    assert_eq!(reported(&model, &mut e, "x", "p_x^3"), ("3*p_x^2".to_owned(), Zero::No));
}

#[test]
fn a_bracket_needs_velocities_in_terms_of_momenta_or_a_point() {
    // L is not quadratic: q̇(p) is the root of a cubic
    let model = lagrangian(&["x", "y"], &["a"], "1/2*x'^2 + a*x'^4 + 1/2*y'^2 + x*y*x'*y'");
    let mut e = mechanics::derive(&model).expect("derivable");
    let [f, g, h, x, action] =
        ["x*x'", "y'^2*x", "p_x", "x^3", "action"].map(|text| look(&model, &mut e, text));
    let why = bracket(&model, &mut e, f, g).expect_err("no closed form").to_string();
    assert!(why.starts_with("q′ is not known in terms of p: "), "{why}");
    // but an expression in q and p has a bracket
    let e_text = bracket(&model, &mut e, x, h).expect("a function of q and p");
    assert_eq!(e.pool.text(e_text), "3*x^2");
    assert!(bracket(&model, &mut e, x, action).is_err());
    // and the value is known: [f, g] = Σ ∂f/∂q ∂g/∂p − …, q̇(p) differenced by Newton's method
    let chain = ChainRule::of(&mut e, f, g).expect("functions of q and q'");
    let at = sample(3);
    let coordinates = e.coordinates.clone();
    let base: Vec<f64> = coordinates
        .iter()
        .map(|c| at(c.position))
        .chain(e.momenta.iter().map(|&p| e.pool.evaluate(p, &at)))
        .collect();
    let value = |of: Expr, z: &[f64]| {
        let mut v: Vec<f64> = coordinates.iter().map(|c| at(c.velocity)).collect();
        let place = |v: &[f64], s| match coordinates.iter().position(|c| c.position == s) {
            Some(i) => z[i],
            None => {
                coordinates.iter().position(|c| c.velocity == s).map_or_else(|| at(s), |i| v[i])
            }
        };
        let Flow::Lagrange { mass, .. } = &e.flow else { unreachable!() };
        for _ in 0..30 {
            let m = DMatrix::from_fn(2, 2, |i, j| e.pool.evaluate(mass[i][j], &|s| place(&v, s)));
            let r = DVector::from_fn(2, |i, _| {
                e.pool.evaluate(e.momenta[i], &|s| place(&v, s)) - z[2 + i]
            });
            let step = m.lu().solve(&r).expect("regular");
            v.iter_mut().zip(step.iter()).for_each(|(v, s)| *v -= s);
        }
        e.pool.evaluate(of, &|s| place(&v, s))
    };
    let slope = |of: Expr, i: usize| {
        let shifted = |h: f64| {
            let mut z = base.clone();
            z[i] += h;
            value(of, &z)
        };
        (8.0 * (shifted(1e-3) - shifted(-1e-3)) - shifted(2e-3) + shifted(-2e-3)) / 12e-3
    };
    let by_hand: f64 =
        (0..2).map(|i| slope(f, i) * slope(g, 2 + i) - slope(f, 2 + i) * slope(g, i)).sum();
    let found = chain.value(&e, &at).expect("a value");
    assert!((found - by_hand).abs() < 1e-9 * by_hand.abs().max(1.0), "{found} is not {by_hand}");
    assert!(by_hand.abs() > 1e-2);
}

#[test]
fn the_chain_rule_agrees_where_both_ways_are_open() {
    let model = lagrangian(
        &["theta", "phi", "psi"],
        &["I1", "I3", "Mgl"],
        "1/2*I1*(theta'^2 + phi'^2*sin(theta)^2) + 1/2*I3*(psi' + phi'*cos(theta))^2 - Mgl*cos(theta)",
    );
    let written =
        ["theta'*sin(phi)", "phi'*psi'", "p_theta*psi'", "energy", "psi' + phi'*cos(theta)"];
    let mut e = mechanics::derive(&model).expect("derivable");
    let all: Vec<Expr> = written.iter().map(|text| look(&model, &mut e, text)).collect();
    for (i, &f) in all.iter().enumerate() {
        for &g in &all[..i] {
            let closed = bracket(&model, &mut e, f, g).expect("closed");
            let chain = ChainRule::of(&mut e, f, g).expect("a chain rule");
            for seed in 0..10 {
                let at = sample(seed);
                let momenta: Vec<f64> =
                    e.momenta.iter().map(|&p| e.pool.evaluate(p, &at)).collect();
                let with_momenta = |s| {
                    let i = e.coordinates.iter().position(|c| c.momentum == s);
                    i.map_or_else(|| at(s), |i| momenta[i])
                };
                let (right, size) = e.pool.evaluate_with_size(closed, &with_momenta);
                let found = chain.value(&e, &at).expect("a value");
                assert!((found - right).abs() <= 1e-11 * size.max(1.0), "{found} is not {right}");
            }
        }
    }
    // the angular velocities about the body's axes: [ω_i, ω_j] is not zero though [φ, ψ] is
    let (spin, nod) = (all[4], look(&model, &mut e, "p_theta"));
    let conserved = bracket(&model, &mut e, spin, nod).expect("closed");
    assert_eq!(e.pool.is_zero(conserved), Zero::Proved, "I₃ω₃ = p_ψ commutes with p_θ");
}

/// Functions of (x, y, p_x, p_y, t): sums and products of terms common in mechanics.
fn function() -> impl Strategy<Value = String> {
    let leaf = prop::sample::select(vec![
        "x",
        "y",
        "p_x",
        "p_y",
        "t",
        "m",
        "2",
        "-1/3",
        "sin(x)",
        "cos(y)",
        "x^2",
        "p_y^2",
        "sqrt(x^2 + y^2)",
        "exp(p_x/m)",
    ]);
    leaf.prop_map(str::to_owned).prop_recursive(2, 8, 2, |inner| {
        (inner.clone(), prop::sample::select(vec!['+', '-', '*']), inner)
            .prop_map(|(a, op, b)| format!("({a}) {op} ({b})"))
    })
}

proptest! {
    #![proptest_config(crate::cases(48))]

    /// Antisymmetry, Leibniz's rule and Jacobi's identity, of the canonical bracket and of the
    /// bracket of a body's angular momentum.
    #[test]
    fn brackets_are_a_lie_algebra_of_derivations(
        f in function(), g in function(), h in function(), turning in any::<bool>(),
    ) {
        let mut model = if turning {
            // x, y, p_x stand for the three components, {x, y} = −p_x and cyclic
            let mut model = names(&["x", "y", "z"], &["m", "p_x", "p_y"]);
            let z = read(&mut model, "z");
            let (x, y) = (read(&mut model, "x"), read(&mut model, "y"));
            let minus: Vec<Expr> = [x, y, z].into_iter().map(|e| model.pool.neg(e)).collect();
            let o = Expr::ZERO;
            let brackets = vec![vec![o, minus[2], y], vec![z, o, minus[0]], vec![minus[1], x, o]];
            model.mechanics = Mechanics::Poisson {
                hamiltonian: x, brackets, casimirs: Vec::new(), forces: Vec::new(), place: 0..0,
            };
            model
        } else {
            hamiltonian(&["x", "y"], &["m"], "(p_x^2 + p_y^2)/(2*m)")
        };
        let [f, g, h] = [&f, &g, &h].map(|text| {
            let text = if turning { text.replace("p_y", "z") } else { text.clone() };
            read(&mut model, &text)
        });
        let mut e = mechanics::derive(&model).expect("derivable");
        let mut of = |f, g| bracket(&model, &mut e, f, g).expect("closed");
        let (fg, gh, hf, gf) = (of(f, g), of(g, h), of(h, f), of(g, f));
        let cyclic = [of(fg, h), of(gh, f), of(hf, g)];
        let product = e.pool.mul(g, h);
        let of_product = bracket(&model, &mut e, f, product).expect("closed");
        let pool = &mut e.pool;
        let fh = pool.neg(hf);
        let (first, second) = (pool.mul(fg, h), pool.mul(g, fh));
        let leibniz = pool.sum(&[first, second]);
        let leibniz = pool.sub(of_product, leibniz);
        for (name, zero) in [
            ("antisymmetry", pool.add(fg, gf)),
            ("Leibniz", leibniz),
            ("Jacobi", pool.sum(&cyclic)),
        ] {
            prop_assert_ne!(pool.is_zero(zero), Zero::No, "{}: {}", name, pool.text(zero));
        }
    }
}

#[test]
fn what_is_no_structure_fails_the_identity() {
    // the test above can fail: {x,y} = x, {y,z} = y, {z,x} = z is antisymmetric and no more
    let mut model = names(&["x", "y", "z"], &[]);
    let [x, y, z] = ["x", "y", "z"].map(|text| read(&mut model, text));
    let minus: Vec<Expr> = [x, y, z].into_iter().map(|e| model.pool.neg(e)).collect();
    let o = Expr::ZERO;
    let brackets = vec![vec![o, x, minus[2]], vec![minus[0], o, y], vec![z, minus[1], o]];
    model.mechanics = Mechanics::Poisson {
        hamiltonian: o,
        brackets,
        casimirs: Vec::new(),
        forces: Vec::new(),
        place: 0..0,
    };
    let mut e = mechanics::derive(&model).expect("derivable");
    let mut of = |f, g| bracket(&model, &mut e, f, g).expect("closed");
    let (xy, yz, zx) = (of(x, y), of(y, z), of(z, x));
    let cyclic = [of(xy, z), of(yz, x), of(zx, y)];
    let sum = e.pool.sum(&cyclic);
    assert_eq!(e.pool.text(sum), "-x - y - z");
}

/// df/dt = [f, H] + ∂f/∂t.
fn rate_by_bracket(model: &Model, e: &mut Equations, f: Expr) -> Result<Expr, NoClosedForm> {
    let hamiltonian = e.hamiltonian().clone()?;
    let by_motion = bracket(model, e, f, hamiltonian)?;
    let f = in_phase_space(e, f)?;
    let by_time = e.pool.derivative(f, e.symbols.time);
    Ok(e.pool.add(by_motion, by_time))
}

#[test]
fn the_bracket_with_h_is_the_rate_seen_along_the_motion() {
    let mut followed = 0;
    for entry in Catalog::with_folder(None).entries() {
        let document = entry.document().expect("a shipped preset is at hand");
        let model = document.read().expect("a shipped preset is right").model;
        let free = model.mechanics.forces().iter().all(|&f| f == Expr::ZERO)
            && model.mechanics.dissipation() == Expr::ZERO
            && model.constraints.is_empty();
        let mut e = mechanics::derive(&model).expect("derivable");
        if !free || e.velocities.is_err() {
            continue;
        }
        // each q, p and observable, and its rate by the bracket
        let mut watched: Vec<(String, Expr)> = Vec::new();
        for c in e.coordinates.clone() {
            let momentum = (!model.is_poisson()).then_some(c.momentum);
            for s in [c.position].into_iter().chain(momentum) {
                watched.push((e.pool.symbol_info(s).name.clone(), e.pool.variable(s)));
            }
        }
        watched.extend(model.observables.iter().map(|o| (o.name.clone(), o.expression)));
        let mut channels = Vec::new();
        for (name, f) in watched {
            let Ok(rate) = rate_by_bracket(&model, &mut e, f) else { continue };
            channels.push(WrittenExpr { written: name.clone(), expression: f });
            channels.push(WrittenExpr { written: format!("{name}'s rate"), expression: rate });
        }
        let system = System::compile(&model, &e, &channels).expect("compiles");
        let parameters = model.parameter_values();
        let start = model.run.start;
        let state = system.initial(start, &parameters, &[]).expect("a start");
        let method = method_named("taylor").expect("the table has it");
        let mut stepper = (method.make)(&system, &Settings::default()).expect("it fits");
        stepper.start(&state, &parameters).expect("a start");
        let mut observer = system.observer(&parameters);
        let mut values = |stepper: &mut dyn Stepper, time: f64| {
            while stepper.time() < time {
                stepper.step(start + 10.0).expect("a step");
            }
            let mut now = state.clone();
            stepper.at(time, &mut now).expect("inside the step");
            let mut values = vec![f64::NAN; system.channels().len()];
            observer.observe(&now, &mut values).expect("values");
            values
        };
        // a difference of sixth order around a time within one step
        stepper.step(start + 10.0).expect("a step");
        let (middle, h) =
            (0.5 * (start + stepper.time()), (0.02 * (stepper.time() - start)).min(0.01));
        let at: Vec<Vec<f64>> =
            (-3..=3).map(|k| values(stepper.as_mut(), middle + f64::from(k) * h)).collect();
        let first = system.columns() - channels.len();
        for (i, pair) in channels.chunks(2).enumerate() {
            let value = |k: usize| at[k][first + 2 * i];
            let seen = (45.0 * (value(4) - value(2)) - 9.0 * (value(5) - value(1)) + value(6)
                - value(0))
                / (60.0 * h);
            let rate = at[3][first + 2 * i + 1];
            let noise = 4.0 * f64::EPSILON * (0..7).map(|k| value(k).abs()).fold(0.0, f64::max) / h;
            let allowed = 1e-7 * rate.abs() + noise;
            assert!(
                (seen - rate).abs() <= allowed.max(1e-12),
                "{}, {}: {seen} is not {rate}",
                entry.name,
                pair[0].written
            );
            followed += 1;
        }
    }
    assert!(followed > 60, "only {followed} rates were looked at");
}
