//! Gauges and their verdicts.

use phaselab::experiment::{AdvanceOutcome, Command, Experiment, Gauge, Growth, Verdict};
use phaselab::integrate::Settings;
use phaselab::preset::{self, Catalog};

use super::{PLENTY, build, gauge, run, shipped, value};
use crate::nonempty;

#[test]
fn every_preset_has_a_gauge_for_all_that_is_conserved() {
    for entry in nonempty(Catalog::with_folder(None).entries()) {
        let mut system = shipped(&entry.name);
        let time = system.time() + 0.5 * system.speed();
        run(&mut system, time);
        let snapshot = system.snapshot();
        let first = snapshot.gauges.first().expect("a gauge at least");
        assert_eq!(first.name, "energy", "{}", entry.name);
        for gauge in snapshot.gauges.iter() {
            let whole = !gauge.shown.is_empty() && !gauge.reason.is_empty();
            assert!(whole && gauge.value.is_finite(), "{gauge:?}");
            // on another branch of S the constant is another function
            if gauge.verdict == Verdict::OtherBranch {
                continue;
            }
            assert!(gauge.drift.is_finite() && gauge.drift <= gauge.max_drift, "{gauge:?}");
            if !matches!(gauge.verdict, Verdict::Broken(_)) {
                assert!(gauge.max_drift < 1e-13, "{}: {gauge:?}", entry.name);
            }
        }
    }
}

/// Within the long steps of a series a few samples say as much of a gauge as the rows of a smooth curve.
#[test]
fn gauges_need_fewer_rows_than_a_curve() {
    let pendulum = "title = \"T\"\n[coordinates]\nx = { initial = 1 }\n[lagrangian]\nL = \"1/2*x'^2 + cos(x)\"\n";
    let fall =
        "title = \"T\"\n[coordinates]\nx = { initial = 1 }\n[lagrangian]\nL = \"1/2*x'^2 - x\"\n";
    let run = |text: &str, tolerance: Option<f64>, only_gauges: bool| {
        let mut system = build(text, |setup| {
            setup.spacing = 0.01;
            setup.settings.tolerance = tolerance;
        });
        if only_gauges {
            system.record_for_gauges_only();
        }
        run(&mut system, 10.0);
        let snapshot = system.snapshot();
        (snapshot.trail.len(), gauge(&snapshot, "energy"))
    };
    for text in [pendulum, fall] {
        let ((shown, _), (sampled, energy)) = (run(text, None, false), run(text, None, true));
        assert!(shown > 500 && (250..=510).contains(&sampled), "{shown} {sampled}");
        assert!(matches!(energy.verdict, Verdict::Exact(_)), "{energy:?}");
    }
    let drifts = [false, true].map(|only| run(pendulum, Some(1e-3), only).1.max_drift);
    assert!(drifts[1] > 1e-7 && (0.5..=1.0).contains(&(drifts[1] / drifts[0])), "{drifts:?}");
}

#[test]
fn cyclic_momenta_say_why() {
    let mut top = shipped("heavy-top");
    run(&mut top, 10.0);
    let snapshot = top.snapshot();
    let names: Vec<&str> = snapshot.gauges.iter().map(|gauge| gauge.name.as_str()).collect();
    assert_eq!(names, ["energy", "p_phi", "p_psi", "nutation energy", "axial spin"]);
    assert_eq!(gauge(&snapshot, "p_phi").reason, "cyclic φ");
    assert_eq!(gauge(&snapshot, "energy").reason, "∂L/∂t = 0");
    for gauge in snapshot.gauges.iter() {
        assert!(matches!(gauge.verdict, Verdict::Exact(_)), "{gauge:?}");
    }
}

#[test]
fn energy_broken_by_the_physics_names_its_law_and_the_ledger_holds() {
    for (preset, cause, law) in [
        ("damped-pendulum", "friction", "dE/dt = −c θ′²"),
        ("driven-damped-pendulum", "forces", "dE/dt = "),
        ("kapitza", "explicit time", "dE/dt = "),
        ("turning-wire", "moving constraint", "dE/dt = ω λ"),
    ] {
        let mut system = shipped(preset);
        let time = system.time() + 20.0 * system.speed();
        run(&mut system, time);
        let snapshot = system.snapshot();
        let energy = gauge(&snapshot, "energy");
        let Verdict::Broken(reported) = &energy.verdict else { panic!("{preset}: {energy:?}") };
        assert!(reported.starts_with(law), "{preset}: {reported}");
        assert!(energy.reason.contains(cause), "{preset}: {}", energy.reason);
        assert!(energy.max_drift > 1e-3, "{preset}: {energy:?}");
        let balance = gauge(&snapshot, "energy balance");
        assert!(matches!(balance.verdict, Verdict::Exact(_)), "{preset}: {balance:?}");
        assert!(balance.max_drift < 1e-13, "{preset}: {balance:?}");
    }
}

#[test]
fn a_long_law_is_given_in_its_general_form() {
    let text = "title = \"T\"\n[coordinates]\nx = { initial = 1 }\ny = { initial = 0 }\n\
                [lagrangian]\nL = \"1/2*x'^2 + 1/2*y'^2 - x*y*cos(t)*exp(-t/100) - x^2 - y^4\"\n\
                dissipation = \"x'^2*y^2 + x'^2*y'^2 + y'^4\"\nforces = { x = \"sin(3*t)\" }\n";
    let system = build(text, |_| ());
    let energy = gauge(&system.snapshot(), "energy");
    assert_eq!(energy.verdict, Verdict::Broken("dE/dt = −∂L/∂t − q′·∂F/∂q′ + q′·Q".to_owned()));
    assert_eq!(energy.reason, "explicit time, friction, forces");
}

/// dE/dt = −c x'² + A' … : of what changes the energy in general, a drive of amplitude 0 and a damper without friction do not.
#[test]
fn what_does_not_act_at_the_values_of_the_parameters_is_no_cause() {
    let reason = |drive: f64, friction: f64, wall: f64| {
        let text = format!(
            "title = \"T\"\n[parameters]\nA = {drive:?}\nc = {friction:?}\nw = {wall:?}\n[coordinates]\nx = {{ initial = 1 }}\n\
             [lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2 + A*x*cos(1.3*t)\"\ndissipation = \"1/2*c*x'^2\"\n\
             forces = {{ x = \"-w*x'^3\" }}\n"
        );
        let mut system = build(&text, |_| ());
        run(&mut system, 5.0);
        gauge(&system.snapshot(), "energy").reason
    };
    assert_eq!(reason(0.3, 0.1, 0.2), "explicit time, friction, forces");
    assert_eq!(reason(0.0, 0.1, 0.0), "friction");
    assert_eq!(reason(0.3, 0.0, 0.0), "explicit time");
    assert_eq!(reason(0.0, 0.1, 0.2), "friction, forces");
    assert!(reason(0.0, 0.0, 0.0).starts_with("constant at "));
}

#[test]
fn drift_is_measured_by_the_size_of_the_terms() {
    // in equilibrium on top of the hill, E = 0 is the difference of two terms of size 1e6
    let text = "title = \"T\"\n[coordinates]\nx = { initial = 1e3, velocity = 1e3 }\n\
                [lagrangian]\nL = \"1/2*x'^2 + 1/2*x^2*1.0\"\n\
                [[observables]]\nname = \"nothing\"\nexpression = \"x' - x\"\n";
    let mut system = build(text, |_| ());
    run(&mut system, 1.0);
    let energy = gauge(&system.snapshot(), "energy");
    assert_eq!(energy.reference, 0.0);
    assert!(energy.max_drift < 1e-14, "{energy:?}");
}

/// On the circle r is conserved, and on no other orbit; Kepler's A_x is on all, and is proved.
#[test]
fn what_is_conserved_along_one_motion_only_is_called_that() {
    let text = "title = \"Circle\"\n[coordinates]\nr = { initial = 1 }\nphi = { initial = 0, velocity = 1 }\n\
                [lagrangian]\nL = \"1/2*(r'^2 + r^2*phi'^2) + 1/r\"\n[[observables]]\nname = \"radius\"\n\
                expression = \"r\"\nconserved = true\n[[observables]]\nname = \"A_x\"\n\
                expression = \"r^3*phi'^2*cos(phi) + r^2*r'*phi'*sin(phi) - cos(phi)\"\nconserved = true\n";
    let mut system = build(text, |_| ());
    run(&mut system, 60.0);
    let snapshot = system.snapshot();
    let radius = gauge(&snapshot, "radius");
    assert_eq!(radius.reason, "stated by the file, along this motion only");
    assert!(!radius.proved && radius.left.is_none());
    let vector = gauge(&snapshot, "A_x");
    assert!(vector.proved && vector.reason.contains("proved"), "{}", vector.reason);
}

#[test]
fn a_young_gauge_is_open_and_a_conserved_declared_one_is_judged_by_its_drift() {
    let text = "title = \"T\"\n[coordinates]\nx = { initial = 1 }\n[lagrangian]\n\
                L = \"1/2*x'^2 - 1/2*x^2\"\n[[observables]]\nname = \"amplitude\"\n\
                expression = \"x + 2\"\nconserved = true\n";
    let mut system = build(text, |_| ());
    assert_eq!(gauge(&system.snapshot(), "energy").verdict, Verdict::Open);
    run(&mut system, 60.0);
    let snapshot = system.snapshot();
    let wrong = gauge(&snapshot, "amplitude");
    assert_eq!(wrong.reason, "stated by the file, along this motion only; contradicted by the run");
    assert_eq!(wrong.verdict, Verdict::Lost);
    assert!(wrong.max_drift > 0.6);
    assert_eq!(gauge(&snapshot, "energy").verdict, Verdict::Exact(Growth::Level));
    assert!(wrong.history.len() >= 64 && wrong.history.iter().all(|x| x.is_finite()));
}

/// The energy gauge of a shipped preset, after a run to a time by a method with a fixed step.
fn energy_under(preset: &str, method: &str, step: f64, time: f64) -> Gauge {
    let document = Catalog::with_folder(None).find(preset).expect("it is shipped");
    let mut system = build(&document.text, |setup| {
        method.clone_into(&mut setup.method);
        setup.settings = Settings { step: Some(step), tolerance: None };
    });
    run(&mut system, time);
    gauge(&system.snapshot(), "energy")
}

/// A step far too long leads to spurious close encounters, and energy is lost unevenly. Neither is bounded, and
/// briefly large terms are not a scale for it.
#[test]
fn what_a_method_ruins_is_neither_bounded_nor_small() {
    for (preset, time, least) in [
        // its first steps are those of the encounter, and are compared with what moves a few steps later
        ("restricted-three-body", 20.0, 0.25),
        ("double-pendulum", 25.0, 0.03),
        ("double-pendulum", 60.0, 0.1),
        ("swinging-atwood", 60.0, 0.05),
    ] {
        let energy = energy_under(preset, "rk4", 0.05, time);
        assert!(energy.max_drift > least, "{preset}: {energy:?}");
        match energy.verdict {
            Verdict::Secular(rate) => {
                assert!(energy.max_drift <= 0.1, "{preset}: {energy:?}");
                assert_eq!(rate > 0.0, energy.value > energy.reference, "{preset}: {rate}");
            }
            Verdict::Lost => assert!(energy.max_drift > 0.1, "{preset}: {energy:?}"),
            _ => panic!("{preset}: {energy:?}"),
        }
    }
}

#[test]
fn what_a_symplectic_method_swings_is_bounded() {
    for (preset, method, step, time) in [
        ("henon-heiles", "leapfrog", 0.2, 60.0),
        ("henon-heiles", "yoshida4", 0.2, 200.0),
        ("swinging-atwood", "gauss4", 0.05, 60.0),
        ("heavy-top", "gauss4", 0.05, 25.0),
        ("pendulum", "gauss4", 0.1, 60.0),
    ] {
        let energy = energy_under(preset, method, step, time);
        assert_eq!(energy.verdict, Verdict::Bounded, "{preset} under {method}: {energy:?}");
        assert!(energy.max_drift > 1e-10, "{preset} under {method}: {energy:?}");
    }
}

/// The error of the first step from rest is as large as all that has moved by then, and is compared with what moves later.
#[test]
fn the_first_steps_from_rest_lose_nothing() {
    for (preset, step, time) in [
        ("pendulum", 0.01, 0.2),
        ("pendulum", 0.01, 20.0),
        ("double-pendulum", 0.002, 2.0),
        ("elastic-pendulum", 0.01, 20.0),
    ] {
        let energy = energy_under(preset, "symplectic-euler", step, time);
        assert!(energy.max_drift < 0.1, "{preset}: {energy:?}");
        assert!(energy.max_drift > 1e-4, "{preset}: {energy:?}");
        assert_ne!(energy.verdict, Verdict::Lost, "{preset}: {energy:?}");
    }
}

/// Rounding, and thus drift, is relative to the greatest terms in a motion so far: a comet's energy at perihelion
/// is the difference of terms a thousand times as large as those at its start.
#[test]
fn terms_may_grow_while_a_value_is_kept() {
    let text = "title = \"Comet\"\n[coordinates]\nr = { initial = 1 }\n\
                phi = { initial = 0, velocity = 0.03 }\n[lagrangian]\n\
                L = \"1/2*r'^2 + 1/2*r^2*phi'^2 + 1/r\"\n";
    let mut comet = build(text, |_| ());
    run(&mut comet, 10.0);
    let energy = gauge(&comet.snapshot(), "energy");
    assert!(energy.max_drift < 1e-14, "{energy:?}");
    assert!(matches!(energy.verdict, Verdict::Exact(_)), "{energy:?}");
}

/// A change by an impulse is no drift, and the reported initial value does not change.
#[test]
fn an_impulse_moves_the_reference_and_not_the_initial_value() {
    let mut rotor = shipped("kicked-rotor");
    let first = gauge(&rotor.snapshot(), "energy");
    run(&mut rotor, 5.5);
    let energy = gauge(&rotor.snapshot(), "energy");
    assert_eq!((energy.initial, energy.reference_time), (first.value, first.reference_time));
    assert!((energy.reference - energy.initial).abs() > 1e-3, "{energy:?}");
    assert!(energy.max_drift < 1e-14, "{energy:?}");
}

/// A coordinate on which no force acts has an energy that does not move, but for its impulses.
#[test]
fn an_impulse_on_what_no_force_moves_is_no_drift() {
    let lagrangian = "[coordinates]\nx = { initial = 0, velocity = 1 }\nz = { initial = 0, velocity = 3 }\n\
                      [lagrangian]\nL = \"1/2*(x'^2 + z'^2) - cos(x)\"\n";
    let hamiltonian = "[coordinates]\nx = { initial = 0, momentum = 1 }\nz = { initial = 0, momentum = 2 }\n\
                       [hamiltonian]\nH = \"1/2*(p_x^2 + p_z^2) + 1/2*x^2\"\n";
    let top = "[variables]\nL1 = 1\nL2 = 0.1\nL3 = 2\n[poisson]\nH = \"L1^2/2 + L2^2/2 + L3^2/4\"\n\
               brackets = [[\"L1\", \"L2\", \"-L3\"], [\"L2\", \"L3\", \"-L1\"], [\"L3\", \"L1\", \"-L2\"]]\n";
    for (law, struck) in [(lagrangian, "p_z"), (hamiltonian, "p_z"), (top, "L3")] {
        let impulse = format!(
            "[[impulses]]\nname = \"kick\"\nat = 1.0\nchange = {{ {struck} = \"-1.5\" }}\n"
        );
        let mut motion = build(&format!("title = \"T\"\n{law}{impulse}"), |_| ());
        run(&mut motion, 5.0);
        let snapshot = motion.snapshot();
        for name in ["energy", "energy balance"] {
            let gauge = gauge(&snapshot, name);
            assert!(gauge.max_drift < 1e-14, "{struck}: {gauge:?}");
        }
        // it has changed, and by the impulse
        assert!(
            (gauge(&snapshot, "energy").value - gauge(&snapshot, "energy").initial).abs() > 0.1
        );
    }
}

/// An impulse may change what is conserved between impulses; what is lost has left its value by itself.
#[test]
fn no_shipped_motion_loses_what_it_conserves() {
    for entry in Catalog::with_folder(None).entries() {
        let mut experiment = shipped(&entry.name);
        let (start, speed) = (experiment.time(), experiment.speed());
        // three seconds, frame by frame
        for k in 1..=90 {
            experiment.advance(start + f64::from(k) * speed / 30.0, PLENTY);
        }
        for gauge in experiment.snapshot().gauges.iter() {
            assert!(gauge.verdict != Verdict::Lost, "{}: {}", entry.name, gauge.name);
        }
    }
    // inelastic impacts: exact between them, and a balance of what they take
    let mut experiment = shipped("bouncing-ball");
    run(&mut experiment, 4.0);
    let seen = experiment.snapshot();
    for name in ["energy", "energy balance"] {
        let verdict = gauge(&seen, name).verdict;
        assert!(matches!(verdict, Verdict::Exact(_)), "{name}: {verdict:?}");
    }
}

/// A body that hangs at rest at 3π/2, where x is zero to the rounding of its constraints: at rest, not too slow to be resolved.
#[test]
fn a_constrained_body_at_rest_beside_zero_is_at_rest() {
    let text = "title = 'a test'\n[coordinates]\nx = { initial = \"cos(3*pi/2)\", velocity = 0 }\n\
                y = { initial = \"sin(3*pi/2)\", velocity = 0 }\ntheta = { initial = \"3*pi/2\", velocity = 0 }\n\
                [lagrangian]\nL = \"1/2*(x'^2 + y'^2) - 9.81*y\"\n\
                [[constraints]]\nname = \"a\"\nexpression = \"x - cos(theta)\"\n\
                [[constraints]]\nname = \"b\"\nexpression = \"y - sin(theta)\"\n";
    let mut experiment = build(text, |_| ());
    run(&mut experiment, 20.0);
    let energy = gauge(&experiment.snapshot(), "energy");
    assert!(matches!(energy.verdict, Verdict::Exact(_)), "{energy:?}");
    assert!(energy.reason.ends_with("at rest"), "{energy:?}");
}

/// Carries an experiment to a time with this many steps at once.
fn carried(experiment: &mut Experiment, time: f64, budget: u64) {
    while experiment.advance(time, budget) == AdvanceOutcome::Underway {}
    assert_eq!(experiment.time(), time);
}

#[test]
fn steps_that_are_seen_together_are_seen_as_one_by_one() {
    let hamiltonian = "[coordinates]\nx = { initial = 0, momentum = 0.42081 }\n\
         y = { initial = -0.25, momentum = 0 }\n[parameters]\nk = { value = 1 }\n[hamiltonian]\n\
         H = \"(p_x^2 + p_y^2 + x^2 + y^2)/2 + k*(x^2*y - y^3/3)\"\n";
    let lagrangian = "[coordinates]\nx = { initial = 1, velocity = 0 }\n\
         y = { initial = 0, velocity = 1.1 }\n[parameters]\nk = { value = 1 }\n[lagrangian]\n\
         L = \"x'^2 + y'^2 + k/sqrt(x^2 + y^2) + 1000\"\n";
    for law in [hamiltonian, lagrangian] {
        for (method, step) in [("leapfrog", Some(0.01)), ("yoshida4", Some(0.13)), ("dop853", None)]
        {
            for (spacing, end) in [(1e9, 20.0), (0.17, 12.0)] {
                let [together, single] = [PLENTY, 1].map(|budget| {
                    let mut experiment = build(&format!("title = \"t\"\n{law}"), |setup| {
                        method.clone_into(&mut setup.method);
                        setup.settings = Settings { step, tolerance: None };
                        setup.spacing = spacing;
                    });
                    carried(&mut experiment, 0.4 * end, budget);
                    // states of another form in between, then another parameter
                    experiment.execute(Command::Method("taylor".to_owned()));
                    carried(&mut experiment, 0.5 * end, budget);
                    experiment.execute(Command::Method(method.to_owned()));
                    carried(&mut experiment, 0.7 * end, budget);
                    experiment.execute(Command::Parameter { index: 0, value: 1.1 });
                    carried(&mut experiment, end, budget);
                    experiment.snapshot()
                });
                let case = format!("{law} {method} {step:?} {spacing}");
                assert_eq!(together.state, single.state, "{case}");
                let gauges = [&together, &single].map(|s| format!("{:?}", s.gauges));
                assert_eq!(gauges[0], gauges[1], "{case}");
                assert!(together.gauges[0].farthest > 0.0, "{case}");
            }
        }
    }
}

/// Of a ball that is thrown up α is ½ m v₀², and β = ∂S/∂α is −v₀/g for as long as it rises; S has the other root of p where it
/// falls. Of an oscillator β is a number on each way to the right, lower by a period from one to the next.
/// Source: *The Principles of Dynamics*, § 3.5.
#[test]
fn the_constants_of_a_complete_integral_are_gauged() {
    let mut ball = shipped("falling-body");
    run(&mut ball, 1.9);
    let snapshot = ball.snapshot();
    let beta = gauge(&snapshot, "beta_alpha");
    assert!((beta.value + 2.0).abs() < 1e-12 && beta.proved, "{beta:?}");
    assert!(matches!(beta.verdict, Verdict::Exact(_)), "{beta:?}");
    assert_eq!(beta.reason, "∂S/∂α, while p = ∂S/∂q");
    let alphas = snapshot.gauges.iter().filter(|one| one.name == "α" || one.name == "alpha");
    let alphas: Vec<&Gauge> = alphas.collect();
    assert_eq!(alphas.len(), 1, "{alphas:?}");
    assert!((alphas[0].value - 192.4722).abs() < 1e-11);
    assert!(matches!(alphas[0].verdict, Verdict::Exact(_)), "{:?}", alphas[0]);
    run(&mut ball, 3.0);
    let beta = gauge(&ball.snapshot(), "beta_alpha");
    assert_eq!((beta.left, beta.verdict.word()), (None, "other branch"), "{beta:?}");
    assert_eq!(beta.reason, "∂S/∂α, while p = ∂S/∂q");
    // the drift of the first branch is not that of this one
    assert!(beta.drift.is_nan() && beta.max_drift.is_nan() && beta.history.is_empty());

    // to the right from the start until π/4 − β₀ = 0.23, and again after every π of 2t
    let mut oscillator = shipped("oscillator-hamilton-jacobi");
    let first = 0.5535743588970452;
    let mut known = Vec::new();
    for step in 1..=300 {
        run(&mut oscillator, 0.02 * f64::from(step));
        let beta = gauge(&oscillator.snapshot(), "beta_alpha");
        let to_the_right = value(&oscillator, "p_q") > 0.1;
        if to_the_right {
            assert!(!matches!(beta.verdict, Verdict::Broken(_) | Verdict::Lost), "{beta:?}");
            assert!(beta.max_drift < 1e-9, "{beta:?}");
            let turns = ((first - beta.value) / std::f64::consts::PI).round();
            assert!((beta.value - first + turns * std::f64::consts::PI).abs() < 1e-10, "{beta:?}");
            if !known.contains(&turns) {
                known.push(turns);
            }
        } else if value(&oscillator, "p_q") < -0.1 {
            assert_eq!(beta.verdict, Verdict::OtherBranch, "{beta:?}");
        }
    }
    assert_eq!(known, [0.0, 1.0, 2.0]);
}

/// Three particles of Toda's far from the origin, whose forces depend on differences alone: what moves is as near there as anywhere, the
/// energy swings as leapfrog's does and is not called exact.
#[test]
fn what_depends_on_differences_is_gauged_far_from_the_origin() {
    let text = "[coordinates]\nx = { initial = 1000000000.125, momentum = 0.3 }\ny = { initial = 999999999.75, momentum = -0.1 }\n\
                z = { initial = 1000000000.375, momentum = 0.2 }\n[hamiltonian]\n\
                H = \"(p_x^2 + p_y^2 + p_z^2)/2 + exp(x - y) + exp(y - z) + exp(z - x)\"\n\
                [run]\nmethod = \"leapfrog\"\nstep = 0.2\n\
                [[observables]]\nname = \"I3\"\nconserved = true\n\
                expression = \"p_x*p_y*p_z - p_x*exp(y - z) - p_y*exp(z - x) - p_z*exp(x - y)\"\n";
    let mut chain = build(text, |_| ());
    run(&mut chain, 100.0);
    let snapshot = chain.snapshot();
    for name in ["energy", "I3"] {
        let gauge = gauge(&snapshot, name);
        assert_eq!(gauge.verdict, Verdict::Bounded, "{gauge:?}");
        assert!(gauge.max_drift > 1e-4 && gauge.max_drift < 1e-1, "{gauge:?}");
    }
}

/// A free particle in a plane with S = a x + b y − (a² + b²) t/2, where α is the momentum itself and S has one branch:
/// β = ∂S/∂α = x − a t is where the particle started. S leaves friction out, and an impulse ends both constants.
/// Source: *The Principles of Dynamics*, § 3.5.
#[test]
fn a_complete_integral_of_one_branch_is_gauged() {
    let text = |law: &str, impulse: &str| {
        format!(
            "[coordinates]\nx = {{ initial = 1.0, velocity = 0.3 }}\ny = {{ initial = 0.5, velocity = 0.2 }}\n\
             [lagrangian]\nL = \"1/2*(x'^2 + y'^2)\"\n{law}{impulse}\
             [hamilton_jacobi]\nS = \"a*x + b*y - (a^2 + b^2)/2*t\"\nconstants = [\"a\", \"b\"]\n"
        )
    };
    let gauges = |text: &str, until: f64| {
        let mut particle = build(text, |_| ());
        run(&mut particle, until);
        let snapshot = particle.snapshot();
        ["a", "beta_a", "beta_b"].map(|name| gauge(&snapshot, name))
    };
    let [a, beta_a, beta_b] = gauges(&text("", ""), 4.0);
    for (gauge, value) in [(a, 0.3), (beta_a, 1.0), (beta_b, 0.5)] {
        assert!((gauge.value - value).abs() < 1e-14 && gauge.proved, "{gauge:?}");
        assert!(matches!(gauge.verdict, Verdict::Exact(_)), "{gauge:?}");
    }

    // x′ = 0.3 e^{−0.2 t}: the friction of a dissipation 0.1 x′² is 0.2 x′
    let [a, beta_a, _] = gauges(&text("dissipation = \"0.1*x'^2\"\n", ""), 4.0);
    assert!((a.value - 0.3 * (-0.8_f64).exp()).abs() < 1e-13, "{a:?}");
    for gauge in [a, beta_a] {
        let Verdict::Broken(law) = &gauge.verdict else { panic!("{gauge:?}") };
        assert_eq!(law, "S leaves friction out");
        assert!(!gauge.proved, "{gauge:?}");
    }

    let kick = "[[impulses]]\nname = \"kick\"\nat = 2.0\nchange = { p_x = \"0.5\" }\n";
    let [a, beta_a, _] = gauges(&text("", kick), 4.0);
    assert!((a.value - 0.8).abs() < 1e-14 && matches!(a.verdict, Verdict::Exact(_)), "{a:?}");
    assert_eq!(a.reason, "constant of the complete integral S, between impulses");
    // of another momentum it says nothing
    let kick = "[[impulses]]\nname = \"kick\"\nat = 2.0\nchange = { p_y = \"0.5\" }\n";
    let [a, _, beta_b] = gauges(&text("", kick), 4.0);
    assert_eq!(a.reason, "constant of the complete integral S");
    assert!(beta_b.reason.ends_with(", between impulses"), "{beta_b:?}");
    // after the kick x = 1.6 + 0.8 (t − 2) = 0.8 t
    assert!(
        beta_a.value.abs() < 1e-14 && matches!(beta_a.verdict, Verdict::Exact(_)),
        "{beta_a:?}"
    );
}

/// In the few steps of a ramp that is about as wide as the clock has digits these alone would be seen.
#[test]
fn a_ramp_of_some_digits_of_the_clock_leaves_no_gauge() {
    for width in ["1e-8", "1e-10", "1e-12", "1e-14"] {
        for ramp in [
            "tanh((t - 2)/w)",
            "2*min(1, max(0, (t - 2)/w))^2*(3 - 2*min(1, max(0, (t - 2)/w))) - 1",
        ] {
            let ramp = ramp.replace('w', width);
            let text = format!(
                "title = \"A ramp\"\n[coordinates]\nx = {{ initial = 0 }}\n[lagrangian]\nL = \"1/2*x'^2 + x*({ramp})\"\n"
            );
            let mut experiment = build(&text, |_| ());
            run(&mut experiment, 5.0);
            assert!(
                (value(&experiment, "x") + 3.5).abs() < 1e-7,
                "{ramp}: {}",
                value(&experiment, "x")
            );
            let snapshot = experiment.snapshot();
            let balance = gauge(&snapshot, "energy balance");
            assert!(balance.max_drift < 1e-6 && balance.left.is_none(), "{ramp}: {balance:?}");
        }
    }
}

/// Parameters are live: where a damper, a drive or a thruster has the value 0 nothing acts, and the gauge says so until it has
/// another value.
#[test]
fn what_changes_in_general_is_conserved_where_nothing_acts() {
    let law = |l: &str, rest: &str| {
        format!(
            "title = \"T\"\n[coordinates]\nx = {{ initial = 1, velocity = 0.3 }}\n[parameters]\na = 0.5\nb = 0.5\n\
             [lagrangian]\nL = \"{l}\"\n{rest}"
        )
    };
    let spring = "1/2*x'^2 - x^2 - x^4";
    let [friction, dry, force, drive, step, balanced] = [
        law(spring, "dissipation = \"1/2*a*x'^2\"\n"),
        law(spring, "forces = { x = \"-a*sign(x')\" }\n"),
        law(spring, "forces = { x = \"a*cos(2*t)\" }\n"),
        law(&format!("{spring} + a*x*cos(2*t)"), ""),
        law(&format!("{spring} + a*x*sign(sin(2*t))"), ""),
        law(&format!("{spring} + (a - b)*x*cos(2*t)"), "dissipation = \"(a - b)*x'^2\"\n"),
    ];
    let ramp = law(spring, "dissipation = \"a*t*x'^2\"\n");
    let spin = Catalog::with_folder(None).find("spin-up").expect("a preset").text.clone();
    for (text, name, parameter, at, reason) in [
        (&friction, "energy", "a", 0.0, "constant at a = 0"),
        (&dry, "energy", "a", 0.0, "constant at a = 0"),
        (&force, "energy", "a", 0.0, "constant at a = 0"),
        (&drive, "energy", "a", 0.0, "constant at a = 0"),
        (&step, "energy", "a", 0.0, "constant at a = 0"),
        (&ramp, "energy", "a", 0.0, "constant at a = 0"),
        (&balanced, "energy", "a", 0.5, "constant at a = 0.5, b = 0.5"),
        (&spin, "|L|²", "N", 0.0, "constant at N = 0"),
    ] {
        let mut experiment = build(text, |_| ());
        let model = preset::read(text).expect("a file").model;
        let index = model.parameters.iter().position(|p| p.name == parameter).expect("it is there");
        for (round, value) in [at, 0.125, at].into_iter().enumerate() {
            experiment.execute(Command::Parameter { index, value });
            let end = experiment.time() + 10.0;
            run(&mut experiment, end);
            let shown = gauge(&experiment.snapshot(), name);
            if round == 1 {
                assert!(matches!(shown.verdict, Verdict::Broken(_)), "{text}: {shown:?}");
                assert!(shown.max_drift > 1e-6 && !shown.proved, "{text}: {shown:?}");
            } else {
                assert!(matches!(shown.verdict, Verdict::Exact(_)), "{text}: {shown:?}");
                assert!(shown.max_drift < 1e-13 && shown.proved, "{text}: {shown:?}");
                assert_eq!(shown.reason, reason, "{text}");
            }
        }
    }
}

/// What acts on a motion only where it is not now, or at another time, still acts.
#[test]
fn where_something_may_act_nothing_is_called_conserved() {
    for (l, rest) in [
        ("1/2*x'^2 - x^2", "forces = { x = \"-max(0, x - 40 - a)*x'\" }"),
        ("1/2*x'^2 - x^2 + x*exp(-(t - 60)^2 - a)", ""),
        ("1/2*x'^2 - x^2 + x*sign(t - 60 - a)", ""),
        ("1/2*x'^2 - x^2", "dissipation = \"1e-30*x'^2 + a*x'^2\""),
    ] {
        let text = format!(
            "title = \"T\"\n[coordinates]\nx = 1\n[parameters]\na = 0\n[lagrangian]\nL = \"{l}\"\n{rest}\n"
        );
        let mut experiment = build(&text, |_| ());
        run(&mut experiment, 5.0);
        let energy = gauge(&experiment.snapshot(), "energy");
        assert!(matches!(energy.verdict, Verdict::Broken(_)), "{l} {rest}: {energy:?}");
    }
}

/// Beyond x = 370 the square of x⁶⁰ overflows, and the potential is 1 there all the same.
#[test]
fn a_quotient_of_what_overflows_has_its_value() {
    let text = "title = \"A shelf\"\n[coordinates]\nx = { initial = -3, velocity = 2.5 }\n[lagrangian]\n\
                L = \"1/2*x'^2 - x^60/sqrt(1 + x^120)\"\n";
    let mut experiment = build(text, |_| ());
    run(&mut experiment, 1000.0);
    assert!(value(&experiment, "x") > 2000.0);
    let energy = gauge(&experiment.snapshot(), "energy");
    assert!(matches!(energy.verdict, Verdict::Exact(_)), "{energy:?}");
    assert!(energy.max_drift < 1e-12 && energy.left.is_none(), "{energy:?}");
}

/// A force that is 1 there, in the plain numbers of every method.
#[test]
fn a_force_made_of_what_overflows_acts_by_every_method() {
    for force in
        ["x^60/sqrt(1 + x^120)", "x^60*(1 + x^180)^(-1/3)", "atan2(2*x^120, x^120 + 1)/atan(2)"]
    {
        let text = format!(
            "title = \"A shelf\"\n[coordinates]\nx = {{ initial = 1000 }}\n[lagrangian]\nL = \"1/2*x'^2\"\n\
             forces = {{ x = \"{force}\" }}\n"
        );
        for method in ["taylor", "dop853", "rk4", "gauss4"] {
            let mut experiment = build(&text, |setup| {
                method.clone_into(&mut setup.method);
                let has_step = matches!(method, "rk4" | "gauss4");
                setup.settings = Settings { step: has_step.then_some(0.125), tolerance: None };
            });
            run(&mut experiment, 8.0);
            let x = value(&experiment, "x");
            assert!((x - 1032.0).abs() < 1e-9, "{force} by {method}: {x}");
        }
    }
}
