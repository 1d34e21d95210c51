//! Runs with known verdicts, which follow from the properties of the method and the system.
//!
//! The oscillator under a Runge–Kutta method of order four loses (hω)⁶/72 of its energy per step (Hairer, Lubich,
//! Wanner, *Geometric Numerical Integration*, § IX). Under symplectic methods the energy oscillates by a power of the
//! step without trend, and angular momenta are conserved; Gauss methods conserve quadratic invariants (§ IV.2). A
//! Taylor series to the last digit conserves everything.

use std::f64::consts::TAU;

use phaselab::analysis::{Growth, Verdict};
use phaselab::experiment::Experiment;
use phaselab::integrate::Settings;

use super::{build, gauge, run};

/// The lengths in periods: integer and not, short and long.
const LENGTHS: [f64; 4] = [10.0, 10.3, 100.0, 97.31];

/// A method, its step as a fraction of a period (none if adaptive), and the verdict on the energy by the length.
type Label = (&'static str, f64, fn(f64) -> &'static str);

/// Runs a file as `phaselab run` does, with a thousand rows.
fn carried(text: &str, method: &str, step: Option<f64>, time: f64) -> Experiment {
    let mut experiment = build(text, |setup| {
        method.clone_into(&mut setup.method);
        setup.settings = Settings { step, tolerance: None };
        setup.end = Some(time);
        setup.spacing = time / 1000.0;
    });
    run(&mut experiment, time);
    experiment
}

/// Asserts every verdict at every length for a file of this period; returns the number of runs.
fn hold(text: &str, period: f64, labels: &[Label], gauges: &[(&str, Option<&str>)]) -> usize {
    let mut wrong = Vec::new();
    for &(method, part, word) in labels {
        for length in LENGTHS {
            let step = (part > 0.0).then_some(part * period);
            let snapshot = carried(text, method, step, length * period).snapshot();
            for &(name, of_its_own) in gauges {
                let gauge = gauge(&snapshot, name);
                let label = of_its_own.unwrap_or_else(|| word(length));
                if gauge.verdict.word() != label {
                    let (is, drift) = (gauge.verdict.word(), gauge.max_drift);
                    wrong.push(format!(
                        "{name} under {method}, {part} for {length}: {is} is not {label} ({drift:e})"
                    ));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{text}\n{}", wrong.join("\n"));
    labels.len() * LENGTHS.len()
}

/// The mass, the frequency and the amplitude of an oscillator in different units.
const UNITS: [(f64, f64, f64); 3] =
    [(1.0, 1.0, 1.0), (9.1e-31, 4.1e16, 5.3e-11), (2.0e30, 7.9e-16, 3.1e20)];

/// An oscillator, with a constant in V given as a multiple of its energy.
fn oscillator((m, w, x): (f64, f64, f64), offset: f64) -> String {
    let (k, v) = (m * w * w, x * w * 0.8);
    let constant = offset * 0.5 * k * x * x;
    format!(
        "title = \"Oscillator\"\n[coordinates]\nx = {{ initial = {x:e}, velocity = {v:e} }}\n\
         [lagrangian]\nL = \"1/2*{m:e}*x'^2 - 1/2*{k:e}*x^2 - {constant:e}\"\n"
    )
}

#[test]
fn an_oscillator_in_any_units() {
    let labels: [Label; 7] = [
        ("taylor", 0.0, |_| "exact"),
        ("leapfrog", 0.03, |_| "bounded"),
        ("yoshida4", 0.03, |_| "bounded"),
        ("yoshida6", 0.03, |_| "bounded"),
        ("gauss4", 0.03, |_| "exact"),
        ("rk4", 0.03, |_| "secular"),
        // (hω)⁶/72 = 4.5e-4 a step, eleven of them a period: 0.05 after ten, a third after a hundred
        ("rk4", 0.09, |length| if length > 50.0 { "lost" } else { "secular" }),
    ];
    let runs: usize = UNITS
        .iter()
        .map(|&units| {
            let period = TAU / units.1;
            hold(&oscillator(units, 0.0), period, &labels, &[("energy", None)])
        })
        .sum();
    assert_eq!(runs, 84);
}

/// A constant in V changes no verdict: neither a large one, nor one beside which the energy is small.
#[test]
fn an_oscillator_with_a_constant_in_its_potential() {
    let labels: [Label; 5] = [
        ("taylor", 0.0, |_| "exact"),
        ("leapfrog", 0.03, |_| "bounded"),
        ("yoshida4", 0.03, |_| "bounded"),
        ("rk4", 0.03, |_| "secular"),
        ("rk4", 0.09, |length| if length > 50.0 { "lost" } else { "secular" }),
    ];
    let mut runs = 0;
    for (units, offset) in [(UNITS[0], 1e12), (UNITS[1], 1e6), (UNITS[2], -1e4)] {
        let period = TAU / units.1;
        runs += hold(&oscillator(units, offset), period, &labels, &[("energy", None)]);
    }
    assert_eq!(runs, 60);
}

/// A pendulum that swings by so little that its energy, whose terms are 1, cannot tell whether it moves: E − E₀ may be ε = 2e-16, and
/// what moves is θ₀²/2. Nothing is known then, and from amplitudes on that are large enough E is exact.
#[test]
fn an_energy_that_cannot_resolve_the_motion_is_not_exact() {
    for (from, word) in [(1e-9, "unknown"), (1e-7, "unknown"), (1e-5, "exact"), (1e-3, "exact")] {
        let text = format!(
            "title = \"Pendulum\"\n[coordinates]\ntheta = {{ initial = {from} }}\n\
             [lagrangian]\nL = \"1/2*theta'^2 + cos(theta)\"\n"
        );
        let snapshot = carried(&text, "taylor", None, 50.0).snapshot();
        let energy = gauge(&snapshot, "energy");
        assert_eq!(energy.verdict.word(), word, "{from}: {energy:?}");
    }
}

/// A bead at the tilted equilibrium of a turning hoop, cos θ = g/(a ω²), moves by the last digits of its place: nothing is lost there.
/// A body that falls at 1e20 m has a place that does not change for long, and is not at rest.
#[test]
fn a_body_at_rest_conserves_what_a_body_too_far_away_may_lose() {
    let bead = "title = \"Bead\"\n[coordinates]\ntheta = { initial = 1.167556903805043 }\n\
        [lagrangian]\nL = \"1/2*(theta'^2 + 25*sin(theta)^2) + 9.81*cos(theta)\"\n";
    let far = "title = \"Far\"\n[coordinates]\nx = { initial = 1e20 }\n\
        [lagrangian]\nL = \"1/2*x'^2 - x\"\n";
    for (text, word, rests) in [(bead, "exact", true), (far, "unknown", false)] {
        let snapshot = carried(text, "taylor", None, 50.0).snapshot();
        let energy = gauge(&snapshot, "energy");
        assert_eq!(energy.verdict.word(), word, "{energy:?}");
        assert_eq!(energy.reason.ends_with("; at rest"), rests, "{energy:?}");
    }
}

/// A pendulum that swings by 1e-9 is where it began at every row of a period, and no energy of 9.81 has the digits of its swing.
#[test]
fn what_every_row_meets_where_it_began_is_not_at_rest() {
    let text = "title = \"Swing\"\n[coordinates]\nx = { initial = 1e-9 }\n\
        [lagrangian]\nL = \"1/2*x'^2 + 9.81*cos(x)\"\n";
    let period = TAU / 9.81_f64.sqrt();
    for (from, word) in [("1e-9", "unknown"), ("0", "exact")] {
        let mut experiment = build(&text.replace("1e-9", from), |setup| {
            setup.end = Some(20.0 * period);
            setup.spacing = period;
        });
        run(&mut experiment, 20.0 * period);
        let energy = gauge(&experiment.snapshot(), "energy");
        assert_eq!(energy.verdict.word(), word, "from {from}: {energy:?}");
    }
}

/// The energy of x'²/2 − V from this place at rest, until t = 100.
fn energy_in(
    potential: &str,
    from: f64,
    method: &str,
    step: Option<f64>,
) -> phaselab::experiment::Gauge {
    let text = format!(
        "title = \"V\"\n[coordinates]\nx = {{ initial = {from} }}\n[lagrangian]\nL = \"1/2*x'^2 - ({potential})\"\n"
    );
    gauge(&carried(&text, method, step, 100.0).snapshot(), "energy")
}

/// The terms of a potential cancel each other where it is written about another place, and a drift is a part of what moves all the
/// same: (x − a)ⁿ multiplied out, a spring under a weight, and Lennard-Jones' potential but for a constant as a square.
#[test]
fn one_potential_drifts_alike_however_it_is_written() {
    for (one, from, other, there) in [
        ("x^2/2", 0.7, "x^2/2 - 1000*x", 1000.7),
        ("x^4/4", 0.7, "x^4/4 - 10*x^3 + 150*x^2 - 1000*x", 10.7),
        ("4*(1/x^6 - 0.5)^2", 1.14, "4*(1/x^12 - 1/x^6)", 1.14),
    ] {
        let drifts = [(one, from), (other, there)].map(|(potential, from)| {
            let energy = energy_in(potential, from, "leapfrog", Some(0.05));
            assert_eq!(energy.verdict, Verdict::Bounded, "{potential}: {energy:?}");
            let exact = energy_in(potential, from, "auto", None);
            assert_eq!(exact.verdict.word(), "exact", "{potential}: {exact:?}");
            energy.max_drift
        });
        let ratio = drifts[1] / drifts[0];
        assert!((0.5..2.0).contains(&ratio) && drifts[0] > 1e-4, "{other}: {drifts:?}");
    }
}

/// The terms of (x − 1000)⁴/4 are 4e12 times as great as what moves, and have four digits fewer than would show it.
#[test]
fn what_terms_that_cancel_do_not_show_is_not_exact() {
    let quartic = "x^4/4 - 1000*x^3 + 1.5e6*x^2 - 1e9*x + 2.5e11";
    for (method, step) in [("leapfrog", Some(0.05)), ("auto", None)] {
        let energy = energy_in(quartic, 1000.7, method, step);
        assert_eq!(energy.verdict.word(), "unknown", "{method}: {energy:?}");
    }
}

/// The period of L = θ'²/2 + cos θ from rest at θ₀: 2π over the arithmetic-geometric mean of 1 and cos θ₀/2.
fn period_of_pendulum(from: f64) -> f64 {
    let (mut a, mut b) = (1.0, (from / 2.0).cos());
    while (a - b).abs() > 1e-15 {
        (a, b) = (f64::midpoint(a, b), (a * b).sqrt());
    }
    TAU / a
}

#[test]
fn a_pendulum_from_rest() {
    let labels: [Label; 6] = [
        ("taylor", 0.0, |_| "exact"),
        ("leapfrog", 0.025, |_| "bounded"),
        ("yoshida4", 0.025, |_| "bounded"),
        ("gauss4", 0.025, |_| "bounded"),
        ("rk4", 0.025, |_| "secular"),
        ("leapfrog", 0.4, |_| "lost"),
    ];
    let mut runs = 0;
    for (from, constant) in [(1.0, 0.0), (2.0, 0.0), (2.0, 1e9)] {
        let text = format!(
            "title = \"Pendulum\"\n[coordinates]\ntheta = {{ initial = {from} }}\n\
             [lagrangian]\nL = \"1/2*theta'^2 + cos(theta) - {constant}\"\n"
        );
        runs += hold(&text, period_of_pendulum(from), &labels, &[("energy", None)]);
    }
    assert_eq!(runs, 72);
}

/// Side by side from the same start: the energy of a symplectic method stays in the band of its first periods, and that of RK4
/// leaves it, always in the same direction.
#[test]
fn the_drift_of_a_symplectic_method_is_bounded_and_that_of_rk4_grows() {
    let text = "title = \"Pendulum\"\n[coordinates]\ntheta = { initial = 2.0 }\n\
                [lagrangian]\nL = \"1/2*theta'^2 + cos(theta)\"\n";
    let period = period_of_pendulum(2.0);
    let energy = |method: &str, periods: u32| {
        let time = f64::from(periods) * period;
        gauge(&carried(text, method, Some(0.025 * period), time).snapshot(), "energy")
    };
    let after: [u32; 6] = [10, 20, 40, 80, 160, 320];
    let bounded = after.map(|periods| energy("leapfrog", periods).max_drift);
    let first = bounded[0];
    assert!(first > 1e-4 && bounded.iter().all(|most| *most <= 1.02 * first), "{bounded:?}");
    // h⁵ a step: the loss is proportional to the time
    let lost = after.map(|periods| energy("rk4", periods).drift);
    assert!(lost.windows(2).all(|pair| pair[1].abs() > 1.5 * pair[0].abs()), "{lost:?}");
    assert!(lost.windows(2).all(|pair| pair[0].signum() == pair[1].signum()), "{lost:?}");
}

#[test]
fn a_planet_in_a_plane() {
    let text = "title = \"Planet\"\n[coordinates]\nx = { initial = 1.5 }\n\
                y = { initial = 0, velocity = \"1/sqrt(3)\" }\n\
                [lagrangian]\nL = \"1/2*(x'^2 + y'^2) + 1/sqrt(x^2 + y^2)\"\n\
                [[observables]]\nname = \"A\"\n\
                expression = \"x'*(x*y' - y*x') + y/sqrt(x^2 + y^2)\"\nconserved = true\n";
    let period = TAU;
    let swung: [Label; 2] =
        [("leapfrog", 0.002, |_| "bounded"), ("yoshida4", 0.005, |_| "bounded")];
    let mut runs = hold(text, period, &swung, &[("energy", None), ("L_z", Some("exact"))]);
    runs += hold(text, period, &[("taylor", 0.0, |_| "exact")], &[("energy", None), ("A", None)]);
    runs += hold(text, period, &[("rk4", 0.005, |_| "secular")], &[("energy", None)]);
    assert_eq!(runs, 16);
}

#[test]
fn friction_breaks_the_energy_under_any_method() {
    let text = "title = \"Damped\"\n[coordinates]\nx = { initial = 1 }\n\
                [lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\ndissipation = \"0.02*x'^2\"\n";
    let broken: Label = ("taylor", 0.0, |_| "not conserved");
    let coarse: Label = ("rk4", 0.05, |_| "not conserved");
    let period = TAU;
    let runs =
        hold(text, period, &[broken], &[("energy", None), ("energy balance", Some("exact"))])
            + hold(text, period, &[coarse], &[("energy", None)]);
    assert_eq!(runs, 8);
}

/// Samples at whole periods only would miss these oscillations, or see a trend in them.
#[test]
fn a_swing_is_as_great_whenever_rows_are_written() {
    let period = TAU;
    let text = oscillator(UNITS[0], 0.0);
    let drift = |length: f64| {
        let snapshot = carried(&text, "yoshida4", Some(0.01 * period), length * period).snapshot();
        gauge(&snapshot, "energy").max_drift
    };
    let (whole, other) = (drift(1000.0), drift(1000.3));
    assert!((whole / other - 1.0).abs() < 0.01, "{whole:e} and {other:e}");
}

/// Two free particles: G = y' + a x changes steadily, and so does the scale of its changing part.
fn leaving(a: f64) -> phaselab::experiment::Gauge {
    let text = format!(
        "title = \"Free\"\n[coordinates]\nx = {{ initial = 0, velocity = 1 }}\n\
         y = {{ initial = 0, velocity = 1 }}\n[lagrangian]\nL = \"1/2*x'^2 + 1/2*y'^2\"\n\
         [[observables]]\nname = \"G\"\nexpression = \"y' + {a:e}*x\"\nconserved = true\n"
    );
    gauge(&carried(&text, "taylor", None, 1.0).snapshot(), "G")
}

/// The changing part a/(1 + a) is a tenth at a = 1/9.
#[test]
fn beyond_a_tenth_of_what_moves_a_quantity_is_lost() {
    let (kept, lost) = (leaving(0.1100), leaving(0.1122));
    assert_eq!(kept.verdict.word(), "secular", "{kept:?}");
    assert_eq!(lost.verdict.word(), "lost", "{lost:?}");
    assert!((kept.max_drift - 0.11 / 1.11).abs() < 1e-9, "{kept:?}");
}

#[test]
fn beyond_a_millionth_of_what_moves_it_is_reported() {
    let (kept, left) = (leaving(0.99e-6), leaving(1.01e-6));
    assert_eq!(kept.left, None, "{kept:?}");
    assert!(left.left.is_some_and(|since| (0.9..=1.0).contains(&since)), "{left:?}");
    assert_eq!(kept.reason, "stated by the file, along this motion only");
    assert_eq!(left.reason, "stated by the file, along this motion only; contradicted by the run");
}

/// From a velocity that first leads to a turning point nearby little moves until the motion is on its way back, and the error
/// of these steps is no greater a part of what moves than later: by symplectic Euler E + (h/2) k x v is constant for each frequency
/// (Hairer, Lubich, Wanner, § IX.3), so that E swings by h/2 (x v)_max = h/4 of the amplitude's square, and by what x v was at first.
/// What moves is E and the change of V, on the mean as much as E.
#[test]
fn a_motion_that_begins_near_its_turning_point_is_judged_like_any_other() {
    let mut seen = Vec::new();
    for velocity in [0.03, 0.1, 0.3] {
        for friction in ["", "dissipation = \"0.0079*x'^2\"\n"] {
            let text = format!(
                "title = \"Near\"\n[coordinates]\nx = {{ initial = 1, velocity = {velocity} }}\n\
                 [lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n{friction}"
            );
            let name = if friction.is_empty() { "energy" } else { "energy balance" };
            for (step, length) in [(0.02, 10.0), (0.02, 31.4), (0.005, 20.0), (0.02, 200.0)] {
                let run = carried(&text, "symplectic-euler", Some(step), length);
                let gauge = gauge(&run.snapshot(), name);
                let amplitude = 1.0 + velocity * velocity;
                let most = step / 2.0 * (amplitude / 2.0 + velocity);
                if gauge.verdict != Verdict::Bounded
                    || gauge.max_drift > 2.5 * most / (amplitude / 2.0)
                {
                    seen.push(format!("{velocity} {name} {step} {length}: {gauge:?}"));
                }
            }
        }
    }
    assert!(seen.is_empty(), "{}", seen.join("\n"));
}

/// A Runge–Kutta method loses energy for good. Toda's ring of three has two frequencies, so that it loses it unevenly: it is never
/// said that it oscillates without trend, and not at any length that it does after it was seen to drift.
#[test]
fn an_uneven_loss_is_never_bounded() {
    let text = "title = \"Ring\"\n[coordinates]\na = { initial = 0.47, velocity = -0.37 }\n\
        b = { initial = -0.18, velocity = -0.51 }\nc = { initial = -0.44, velocity = -0.37 }\n[lagrangian]\n\
        L = \"1/2*(a'^2 + b'^2 + c'^2) - exp(a - b) - exp(b - c) - exp(c - a)\"\n";
    let energy = |time: f64| {
        let mut experiment = build(text, |setup| {
            "dop853".clone_into(&mut setup.method);
            setup.settings = Settings { step: None, tolerance: Some(1.5e-9) };
            setup.end = Some(time);
            setup.spacing = time / 1000.0;
        });
        run(&mut experiment, time);
        gauge(&experiment.snapshot(), "energy")
    };
    let gauges = [92.4, 135.0, 184.8, 270.0, 369.6, 739.2].map(energy);
    for gauge in &gauges {
        assert!(matches!(gauge.verdict, Verdict::Open | Verdict::Secular(_)), "{gauge:?}");
    }
    // so it is: twice the time, about twice the loss
    let [first, .., last] = &gauges;
    assert!((3.0..16.0).contains(&(last.drift / first.drift)), "{first:?} {last:?}");
}

/// In equilibrium nothing moves, and nothing drifts.
#[test]
fn an_equilibrium_is_exact() {
    let text = "title = \"Rest\"\n[coordinates]\nx = { initial = 0 }\n\
                [lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2 - 5\"\n";
    for (method, step) in [("taylor", None), ("leapfrog", Some(0.1)), ("rk4", Some(0.1))] {
        let energy = gauge(&carried(text, method, step, 20.0).snapshot(), "energy");
        assert_eq!(
            (energy.verdict.word(), energy.max_drift),
            ("exact", 0.0),
            "{method}: {energy:?}"
        );
    }
}

/// A ball whose every step of dop853 ends at the floor: at the top of its path nothing moves, but what moves is known.
#[test]
fn a_motion_of_impulses_alone_is_judged_by_what_moves_between_them() {
    let text = "title = \"Ball\"\n[coordinates]\nx = { initial = 1e-3 }\n[lagrangian]\nL = \"1/2*x'^2 - 9.8*x\"\n\
                [[impulses]]\nname = \"bounce\"\nchange = { p_x = \"-2*x'\" }\n[[events]]\nname = \"floor\"\n\
                when = \"x\"\ndirection = \"falling\"\naction = \"impulse:bounce\"\n";
    let energy = gauge(&carried(text, "dop853", None, 0.2).snapshot(), "energy");
    assert!(energy.max_drift < 1e-11 && energy.left.is_none(), "{energy:?}");
}

/// The radius of a planet on a circle, started with a velocity too great by this part.
fn radius(by: f64) -> phaselab::experiment::Gauge {
    let text = format!(
        "title = \"Circle\"\n[coordinates]\nx = {{ initial = 1 }}\ny = {{ initial = 0, velocity = {:?} }}\n\
         [lagrangian]\nL = \"1/2*(x'^2 + y'^2) + 1/sqrt(x^2 + y^2)\"\n\
         [[observables]]\nname = \"radius\"\nexpression = \"sqrt(x^2 + y^2)\"\nconserved = true\n",
        1.0 + by
    );
    gauge(&carried(&text, "dop853", None, 30.0).snapshot(), "radius")
}

/// What of a constant term moves is the error of the motion: compared with itself it would always be all.
#[test]
fn a_value_kept_to_rounding_is_not_lost() {
    let kept = radius(0.0);
    assert!(["exact", "bounded"].contains(&kept.verdict.word()), "{kept:?}");
    assert!(kept.max_drift < 1e-13 && kept.left.is_none(), "{kept:?}");
    // r = 1 + 2δ (1 − cos t) to the first order
    for by in [1e-9, 1e-6] {
        let lost = radius(by);
        assert_eq!(lost.verdict.word(), "lost", "{lost:?}");
        assert!((lost.farthest / (4.0 * by) - 1.0).abs() < 1e-3, "{lost:?}");
    }
}

/// The angle θ of a steady precession, kept to 5e-14 by a method of order eight.
#[test]
fn the_angle_of_a_steady_precession_is_not_lost() {
    let preset = include_str!("../../../presets/rigid-body/rotations.toml");
    let angle = gauge(&carried(preset, "dop853", None, 30.0).snapshot(), "θ");
    assert_ne!(angle.verdict.word(), "lost", "{angle:?}");
    assert!(angle.max_drift < 1e-12 && angle.left.is_none(), "{angle:?}");
    assert!(!angle.reason.contains("contradicted"), "{angle:?}");
}

/// An oscillator of momentum p − a, and one beside a rotor that nothing acts on or an invariable variable, whose energies
/// are large: what they lose is a part of what moves. A step ω h = ½ of `rk4` takes about (ω h)⁶/72 of it, 200 of them 0.042.
#[test]
fn what_a_gauge_loses_is_a_part_of_what_moves() {
    let shifted = |a: f64| {
        format!(
            "title = \"A gauge of p\"\n[coordinates]\nx = {{ initial = 1, momentum = {a:e} }}\n[hamiltonian]\n\
             H = \"1/2*(p_x - {a:e})^2 + 1/2*x^2\"\n"
        )
    };
    let field = |y: f64| {
        format!(
            "title = \"A circle in a field\"\n[coordinates]\nx = {{ initial = 1, momentum = {:e} }}\n\
             y = {{ initial = {y:e}, momentum = 0.5 }}\n[hamiltonian]\n\
             H = \"1/2*(p_x + y/2)^2 + 1/2*(p_y - x/2)^2 + 1/2*(x^2 + (y - {y:e})^2)\"\n",
            -0.5 * y
        )
    };
    let rotor = "title = \"Beside a rotor\"\n[coordinates]\nx = { initial = 1, velocity = 0 }\nf = { initial = 0, velocity = 1 }\n\
        [lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2 + 1/2*1e16*f'^2\"\n";
    let casimir = "title = \"Beside a constant\"\n[variables]\nx = { initial = 1 }\ny = { initial = 0 }\nz = { initial = 1e9 }\n\
        [poisson]\nH = \"x^2/2 + y^2/2 + z^2/2\"\n\
        brackets = [[\"x\", \"y\", \"1\"], [\"x\", \"z\", \"0\"], [\"y\", \"z\", \"0\"]]\n";
    let lost = |text: &str| {
        let snapshot = carried(text, "rk4", Some(0.5), 100.0).snapshot();
        gauge(&snapshot, "energy").max_drift
    };
    let texts =
        [1.0, 1e3, 1e6].map(shifted).into_iter().chain([rotor.to_owned(), casimir.to_owned()]);
    let usual = lost(&shifted(0.0));
    assert!((0.03..0.05).contains(&usual), "{usual:e}");
    for text in texts {
        let drift = lost(&text);
        assert!((drift / usual - 1.0).abs() < 0.01, "{drift:e} and {usual:e}\n{text}");
    }
    let here = lost(&field(0.0));
    assert!(here > 1e-3, "{here:e}");
    for y in [1e2, 1e4] {
        let there = lost(&field(y));
        assert!((there / here - 1.0).abs() < 0.1, "{there:e} and {here:e} at {y}");
    }
    // and what rounding of p − a makes is no loss
    let word = |text: &str| {
        gauge(&carried(text, "taylor", None, 100.0).snapshot(), "energy").verdict.word()
    };
    for text in [shifted(0.0), shifted(1e3), shifted(1e6), field(1e4), rotor.to_owned()] {
        assert_eq!(word(&text), "exact", "{text}");
    }
}

/// The total momentum of Toda's ring moves by less than a digit of its terms: in no `f64` is that seen to grow.
#[test]
fn what_moves_by_less_than_a_digit_of_its_terms_does_not_grow() {
    let mut experiment = super::shipped("toda");
    let mut seen = Vec::new();
    for time in 1..60 {
        run(&mut experiment, f64::from(time));
        let momentum = gauge(&experiment.snapshot(), "P");
        if momentum.verdict != Verdict::Open {
            assert!(momentum.farthest < 1e-18, "{}", momentum.farthest);
            seen.push(momentum.verdict);
        }
    }
    assert!(seen.len() > 20, "{seen:?}");
    assert!(seen.iter().all(|verdict| *verdict == Verdict::Exact(Growth::Level)), "{seen:?}");
}
