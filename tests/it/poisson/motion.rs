//! The motion under each method.

use phaselab::experiment::Setup;
use phaselab::integrate::{METHODS, Preserves, Stepping};
use phaselab::system::System;
use phaselab::{mechanics, preset};

use super::{BODY, LOTKA_VOLTERRA, TOP};
use crate::experiment::{build, gauge, run, value};

/// Jacobi's sn, cn, dn of parameter m = k², by the descending Landen transformation (Abramowitz &
/// Stegun, 16.4).
fn jacobi(u: f64, m: f64) -> [f64; 3] {
    let (mut a, mut b, mut c) = (vec![1.0], (1.0 - m).sqrt(), vec![m.sqrt()]);
    while c.last().unwrap().abs() > 1e-17 && a.len() < 40 {
        let old = *a.last().unwrap();
        a.push(0.5 * (old + b));
        c.push(0.5 * (old - b));
        b = (old * b).sqrt();
    }
    let n = a.len() - 1;
    let mut phi = a[n] * u * f64::exp2(n as f64);
    let mut before = phi;
    for i in (1..=n).rev() {
        before = phi;
        phi = 0.5 * (phi + (c[i] / a[i] * phi.sin()).clamp(-1.0, 1.0).asin());
    }
    [phi.sin(), phi.cos(), phi.cos() / (before - phi).cos()]
}

#[test]
fn a_free_body_moves_by_elliptic_functions() {
    // Landau & Lifshitz, *Mechanics*, § 37, for M² > 2 E I₂, from ω₂ = 0
    let [i1, i2, i3] = [1.0, 2.0, 3.0_f64];
    let [w1, w3] = [0.7, 0.9_f64];
    let energy2 = i1 * w1 * w1 + i3 * w3 * w3;
    let momentum2 = (i1 * w1).powi(2) + (i3 * w3).powi(2);
    assert!(momentum2 > energy2 * i2);
    let (low, high) = (momentum2 - energy2 * i1, energy2 * i3 - momentum2);
    let rate = ((i3 - i2) * low / (i1 * i2 * i3)).sqrt();
    let m = (i2 - i1) * high / ((i3 - i2) * low);
    let text = BODY.replace("w1 = 0.01", "w1 = 0.7").replace("w2 = 1.0", "w2 = 0.0");
    let text = text.replace("w3 = 0.01", "w3 = 0.9");
    let mut experiment = build(&text, |_| ());
    for time in [0.5, 3.0, 17.0, 50.0] {
        run(&mut experiment, time);
        let [sn, cn, dn] = jacobi(rate * time, m);
        let expected = [
            i1 * (high / (i1 * (i3 - i1))).sqrt() * cn,
            i2 * (high / (i2 * (i3 - i2))).sqrt() * sn,
            i3 * (low / (i3 * (i3 - i1))).sqrt() * dn,
        ];
        for (name, right) in ["L1", "L2", "L3"].into_iter().zip(expected) {
            let found = value(&experiment, name);
            assert!(
                (found - right).abs() < 2e-14 * (1.0 + time),
                "{name}({time}) = {found}, not {right}"
            );
        }
    }
}

#[test]
fn a_racket_turns_over_when_it_should() {
    // the zeros of ω₂ for I = (1, 2, 3), ω = (0.01, 1, 0.01): closed form and integration agree
    let mut experiment = build(BODY, |_| ());
    for time in [10.9169134942402, 30.4697805928746, 50.0226476915090] {
        run(&mut experiment, time);
        assert!(value(&experiment, "L2").abs() < 1e-12, "{}", value(&experiment, "L2"));
    }
    let snapshot = experiment.snapshot();
    for name in ["energy", "|L|²"] {
        let gauge = gauge(&snapshot, name);
        assert!(gauge.max_drift < 1e-14, "{name} drifts by {:e}", gauge.max_drift);
    }
    assert_eq!(gauge(&snapshot, "|L|²").reason, "Casimir, B ∇C = 0");
}

#[test]
fn a_top_without_angles_is_the_top_in_angles() {
    let angles = r#"
title = "T"
[coordinates]
theta = { initial = 0.6, velocity = 0.3 }
phi   = { initial = 0.0, velocity = 0.2 }
psi   = { initial = 0.0, velocity = 5.0 }
[parameters]
I1 = 1.0
I3 = 0.4
Mgl = 1.0
[lagrangian]
L = "1/2*I1*(theta'^2 + phi'^2*sin(theta)^2) + 1/2*I3*(psi' + phi'*cos(theta))^2 - Mgl*cos(theta)"
"#;
    let (mut free, mut angled) = (build(TOP, |_| ()), build(angles, |_| ()));
    for time in [1.0, 5.0, 20.0] {
        run(&mut free, time);
        run(&mut angled, time);
        let of = |name: &str| value(&angled, name);
        let [theta, psi] = ["theta", "psi"].map(of);
        let [dtheta, dphi, dpsi] = ["theta'", "phi'", "psi'"].map(of);
        for (name, right) in [
            ("G1", theta.sin() * psi.sin()),
            ("G2", theta.sin() * psi.cos()),
            ("G3", theta.cos()),
            ("L1", dphi * theta.sin() * psi.sin() + dtheta * psi.cos()),
            ("L2", dphi * theta.sin() * psi.cos() - dtheta * psi.sin()),
            ("L3", 0.4 * (dpsi + dphi * theta.cos())),
            ("energy", of("energy")),
            ("vertical", of("p_phi")),
        ] {
            let found = value(&free, name);
            assert!((found - right).abs() < 3e-13, "{name}({time}) = {found}, not {right}");
        }
    }
    // spin is not declared conserved, but found to be
    assert_eq!(gauge(&free.snapshot(), "spin").reason, "[G,H] + ∂G/∂t = 0, proved");
}

#[test]
fn a_sleeping_top_passes_through_the_pole() {
    let pole = TOP.replace("theta0 = 0.6", "theta0 = 0.0").replace("phidot = 0.2", "phidot = 0.0");
    // fast enough to sleep: (I₃ω₃)² = 9 > 4 I₁ Mgl; started at θ' = 0.3 it returns through θ = 0
    let pole = pole.replace("psidot = 5.0", "psidot = 7.5");
    let mut experiment = build(&pole, |_| ());
    let (mut lowest, mut returned) = (1.0_f64, -1.0_f64);
    for k in 1..=400 {
        run(&mut experiment, f64::from(k) * 0.05);
        let up = value(&experiment, "G3");
        lowest = lowest.min(up);
        if lowest < 0.999 {
            returned = returned.max(up);
        }
    }
    // u̇² = (1−u)²(…): the greatest angle follows from E and p_φ = p_ψ = 3
    let energy = |u: f64| 9.0 * (1.0 - u) / (2.0 * (1.0 + u)) + u;
    let target = 0.5 * 0.09 + 1.0;
    assert!((energy(lowest) - target).abs() < 1e-3, "{} is not {target}", energy(lowest));
    assert!(returned > 0.9999, "it comes back to the pole: {returned}");
    assert!(gauge(&experiment.snapshot(), "length").max_drift < 1e-14);
}

#[test]
fn foxes_and_rabbits_are_canonical_in_their_logarithms() {
    let canonical = r#"
title = "T"
[coordinates]
u = { initial = "ln(2)", momentum = "ln(1/2)" }
[parameters]
a = 1.0
b = 1.5
c = 0.75
d = 1.25
[hamiltonian]
H = "a*p_u - b*exp(p_u) + c*u - d*exp(u)"
"#;
    let (mut own, mut other) = (build(LOTKA_VOLTERRA, |_| ()), build(canonical, |_| ()));
    for time in [1.0, 7.0, 30.0] {
        run(&mut own, time);
        run(&mut other, time);
        for (name, log) in [("x", "u"), ("y", "p_u")] {
            let (found, right) = (value(&own, name), value(&other, log).exp());
            assert!((found - right).abs() < 1e-13 * (1.0 + time), "{name}: {found}, not {right}");
        }
    }
    assert!(gauge(&own.snapshot(), "energy").max_drift < 1e-14);
}

#[test]
fn a_torque_changes_the_casimir_by_its_law() {
    let text = format!("{BODY}forces = {{ L3 = \"1/5\" }}\n");
    let mut experiment = build(&text, |_| ());
    run(&mut experiment, 5.0);
    let snapshot = experiment.snapshot();
    let squared = gauge(&snapshot, "|L|²");
    assert_eq!(squared.reason, "Casimir; a force acts");
    assert_eq!(format!("{:?}", squared.verdict), "Broken(\"dC/dt = ⅖ L₃\")");
    // the energy balance: E less ∫ N·ω dt
    assert!(gauge(&snapshot, "energy balance").max_drift < 1e-14);
    assert!(gauge(&snapshot, "energy").max_drift > 1e-2);
    // and a force along the gradient's plane leaves it: ∇C·f = 0
    let text = format!("{BODY}forces = {{ L1 = \"L2\", L2 = \"-L1\" }}\n");
    let experiment = build(&text, |_| ());
    assert_eq!(gauge(&experiment.snapshot(), "|L|²").reason, "Casimir, B ∇C = 0");
}

#[test]
fn every_method_moves_it_and_splitting_is_refused_by_name() {
    let model = preset::read(BODY).expect("a right file").model;
    let equations = mechanics::derive(&model).expect("derivable");
    let system = System::compile(&model, &equations, &[]).expect("compiles");
    let exact = {
        let mut experiment = build(BODY, |_| ());
        run(&mut experiment, 12.0);
        ["L1", "L2", "L3"].map(|name| value(&experiment, name))
    };
    let mut refused = Vec::new();
    for method in METHODS {
        if let Err(error) = (method.fits)(&system) {
            let text = error.to_string();
            assert!(text.contains(method.name) && text.contains("brackets"), "{text}");
            refused.push(method.name);
            continue;
        }
        let by = |setup: &mut Setup| {
            setup.method = method.name.to_owned();
            if method.stepping == Stepping::Fixed {
                setup.settings.step = Some(0.01);
            }
        };
        let mut experiment = build(BODY, by);
        run(&mut experiment, 12.0);
        for (name, right) in ["L1", "L2", "L3"].into_iter().zip(exact) {
            let found = value(&experiment, name);
            assert!((found - right).abs() < 1e-7, "{}: {name} = {found}, not {right}", method.name);
        }
    }
    assert_eq!(refused, ["leapfrog", "yoshida4", "yoshida6", "yoshida8", "symplectic-euler"]);
}

#[test]
fn gauss_keeps_quadratic_casimirs_and_others_do_not() {
    // Hairer, Lubich & Wanner, IV.2: Gauss methods conserve every quadratic invariant
    let drift = |method: &str, name: &str| {
        let by = |setup: &mut Setup| {
            setup.method = method.to_owned();
            setup.settings.step = Some(0.25);
        };
        let mut experiment = build(TOP, by);
        run(&mut experiment, 100.0);
        gauge(&experiment.snapshot(), name).max_drift
    };
    for method in METHODS.iter().filter(|m| m.name.starts_with("gauss")) {
        assert_eq!(method.preserves, Preserves::SymplecticReversible);
        for name in ["length", "vertical"] {
            let drift = drift(method.name, name);
            assert!(drift < 2e-15, "{}: {name} drifts by {drift:e}", method.name);
        }
        // the energy is quadratic here too; for a top in a field it is not, and would oscillate
    }
    for name in ["length", "vertical"] {
        let lost = drift("rk4", name);
        assert!(lost > 1e-6, "rk4 keeps {name} to {lost:e}");
    }
}
