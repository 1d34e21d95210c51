//! What gauges watch and say.

use phaselab::experiment::{Growth, Verdict};
use phaselab::preset::Catalog;

use super::{build, gauge, run, shipped};

#[test]
fn every_preset_has_a_gauge_for_all_that_is_conserved() {
    for entry in Catalog::with_folder(None).entries() {
        let mut system = shipped(&entry.name);
        let time = system.time() + 0.5 * system.speed();
        run(&mut system, time);
        let snapshot = system.snapshot();
        let first = snapshot.gauges.first().expect("a gauge at least");
        assert_eq!(first.name, "energy", "{}", entry.name);
        for gauge in snapshot.gauges.iter() {
            let whole = !gauge.shown.is_empty() && !gauge.reason.is_empty();
            assert!(whole && gauge.value.is_finite() && gauge.drift.is_finite(), "{gauge:?}");
            assert!(gauge.drift <= gauge.max_drift, "{gauge:?}");
            if !matches!(gauge.verdict, Verdict::Broken(_)) {
                assert!(gauge.max_drift < 1e-13, "{}: {gauge:?}", entry.name);
            }
        }
    }
}

#[test]
fn cyclic_momenta_say_why() {
    let mut top = shipped("heavy-top");
    run(&mut top, 10.0);
    let snapshot = top.snapshot();
    let names: Vec<&str> = snapshot.gauges.iter().map(|gauge| gauge.name.as_str()).collect();
    assert_eq!(names, ["energy", "p_phi", "p_psi", "nutation energy", "spin about the axis"]);
    assert_eq!(gauge(&snapshot, "p_phi").reason, "cyclic φ");
    assert_eq!(gauge(&snapshot, "energy").reason, "∂L/∂t = 0");
    for gauge in snapshot.gauges.iter() {
        assert!(matches!(gauge.verdict, Verdict::Exact(_)), "{gauge:?}");
    }
}

#[test]
fn energy_broken_by_the_physics_names_its_law_and_the_ledger_holds() {
    for (preset, cause, law) in [
        ("damped-pendulum", "friction", "dE/dt = −c θ̇²"),
        ("driven-damped-pendulum", "forces", "dE/dt = "),
        ("kapitza", "explicit time", "dE/dt = "),
        ("turning-wire", "a moving constraint", "dE/dt = ω λ"),
    ] {
        let mut system = shipped(preset);
        let time = system.time() + 20.0 * system.speed();
        run(&mut system, time);
        let snapshot = system.snapshot();
        let energy = gauge(&snapshot, "energy");
        let Verdict::Broken(told) = &energy.verdict else { panic!("{preset}: {energy:?}") };
        assert!(told.starts_with(law), "{preset}: {told}");
        assert!(energy.reason.contains(cause), "{preset}: {}", energy.reason);
        assert!(energy.max_drift > 1e-3, "{preset}: {energy:?}");
        let ledger = gauge(&snapshot, "energy ledger");
        assert!(matches!(ledger.verdict, Verdict::Exact(_)), "{preset}: {ledger:?}");
        assert!(ledger.max_drift < 1e-13, "{preset}: {ledger:?}");
    }
}

#[test]
fn a_long_law_is_given_in_its_general_form() {
    let text = "title = \"T\"\n[coordinates]\nx = { initial = 1 }\ny = { initial = 0 }\n\
                [lagrangian]\nL = \"1/2*x'^2 + 1/2*y'^2 - x*y*cos(t)*exp(-t/100) - x^2 - y^4\"\n\
                dissipation = \"x'^2*y^2 + x'^2*y'^2 + y'^4\"\nforces = { x = \"sin(3*t)\" }\n";
    let system = build(text, |_| ());
    let energy = gauge(&system.snapshot(), "energy");
    assert_eq!(energy.verdict, Verdict::Broken("dE/dt = −∂L/∂t − q̇·∂F/∂q̇ + q̇·Q".to_owned()));
    assert_eq!(energy.reason, "explicit time, friction, forces");
}

#[test]
fn drift_is_measured_by_the_size_of_the_terms() {
    // at rest on top of the hill E = 0 is the difference of two terms of size 1e6
    let text = "title = \"T\"\n[coordinates]\nx = { initial = 1e3, velocity = 1e3 }\n\
                [lagrangian]\nL = \"1/2*x'^2 + 1/2*x^2*1.0\"\n\
                [[observables]]\nname = \"nothing\"\nexpression = \"x' - x\"\n";
    let mut system = build(text, |_| ());
    run(&mut system, 1.0);
    let energy = gauge(&system.snapshot(), "energy");
    assert_eq!(energy.reference, 0.0);
    assert!(energy.max_drift < 1e-14, "{energy:?}");
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
    assert_eq!((wrong.reason.as_str(), &wrong.verdict), ("declared", &Verdict::Bounded));
    assert!(wrong.max_drift > 0.6);
    assert_eq!(gauge(&snapshot, "energy").verdict, Verdict::Exact(Growth::Level));
    assert!(wrong.history.len() >= 64 && wrong.history.iter().all(|x| x.is_finite()));
}
