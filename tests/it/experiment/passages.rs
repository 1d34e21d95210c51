//! Verdicts on motions that pass narrow places, at many run lengths: under a symplectic method each passage changes the
//! level of the energy by what depends on where the steps fall, in both directions. One passage is no trend, and neither
//! is what precedes it.

use phaselab::integrate::Settings;

use super::{build, gauge, run};

/// A particle on a line, at rest, in units of mass, length and time.
fn particle(potential: &str, from: f64, (mass, length, time): (f64, f64, f64)) -> String {
    let energy = mass * length * length / (time * time);
    let potential = potential.replace('X', &format!("(x/{length:e})"));
    format!(
        "title = \"A particle\"\n[coordinates]\nx = {{ initial = {:e} }}\n\
         [lagrangian]\nL = \"1/2*{mass:e}*x'^2 - {energy:e}*({potential})\"\n",
        from * length
    )
}

/// A planet from its aphelion, with semi-axis 1 and this eccentricity.
fn planet(eccentricity: f64) -> String {
    let (far, speed) = (1.0 + eccentricity, ((1.0 - eccentricity) / (1.0 + eccentricity)).sqrt());
    format!(
        "title = \"A planet\"\n[coordinates]\nx = {{ initial = {far:e} }}\n\
         y = {{ initial = 0, velocity = {speed:e} }}\n\
         [lagrangian]\nL = \"1/2*(x'^2 + y'^2) + 1/sqrt(x^2 + y^2)\"\n"
    )
}

/// The verdicts on the energy after every twentieth of so many periods, as `phaselab run` has them at those lengths.
fn words(
    text: &str,
    method: &str,
    step: Option<f64>,
    period: f64,
    periods: u32,
) -> Vec<&'static str> {
    let mut experiment = build(text, |setup| {
        method.clone_into(&mut setup.method);
        setup.settings = Settings { step, tolerance: None };
        setup.end = Some(period * f64::from(periods));
        setup.spacing = period / 40.0;
    });
    let word = |k: u32| {
        run(&mut experiment, period * (f64::from(k) / 20.0 + 1e-3 * f64::from(k % 7)));
        gauge(&experiment.snapshot(), "energy").verdict.word()
    };
    (1..=20 * periods).map(word).collect()
}

/// Asserts that the energy neither drifts away at any length nor fails to be called bounded from the second period on.
fn swings(text: &str, method: &str, step: Option<f64>, period: f64) {
    let words = words(text, method, step, period, 4);
    assert!(!words.contains(&"secular") && !words.contains(&"lost"), "{method}: {text}\n{words:?}");
    assert!(words[40..].iter().all(|word| *word == "bounded"), "{method}: {text}\n{words:?}");
}

const NATURAL: (f64, f64, f64) = (1.0, 1.0, 1.0);
const ATOMIC: (f64, f64, f64) = (9.1e-31, 5.3e-11, 2.4e-17);
const GALACTIC: (f64, f64, f64) = (2.0e30, 3.1e16, 3.2e13);

#[test]
fn one_passage_is_no_trend_under_a_symplectic_method() {
    // a period of ln cosh x from 400 is that of |x| from 400 − ln 2, less than a thousandth of it
    for units in [NATURAL, ATOMIC, GALACTIC] {
        let text = particle("ln(cosh(X))", 400.0, units);
        for method in ["leapfrog", "gauss4"] {
            swings(&text, method, None, 113.0 * units.2);
        }
    }
    let well = particle("5*tanh(X)^2 + 0.01*X^2", 50.0, NATURAL);
    for (method, part) in [("leapfrog", 0.003), ("yoshida4", 0.0007), ("yoshida8", 0.0007)] {
        swings(&well, method, Some(part * 44.4), 44.4);
    }
    for (method, part) in [("leapfrog", 0.0007), ("yoshida4", 0.0007), ("gauss4", 0.0007)] {
        swings(&planet(0.9), method, Some(part * std::f64::consts::TAU), std::f64::consts::TAU);
    }
}

/// Between its passages the motion has left its level for good, if the method conserves nothing.
#[test]
fn one_passage_is_a_loss_where_errors_accumulate() {
    let text = particle("ln(cosh(X))", 400.0, NATURAL);
    let words = words(&text, "rk4", Some(0.3), 113.0, 2);
    // a quarter of a period to the first passage, half a period to the next
    assert!(words[6..14].iter().all(|word| *word == "secular"), "{words:?}");
}

/// A quantity that is only claimed to be conserved may change with the motion, whatever the method preserves.
#[test]
fn what_is_only_claimed_drifts_under_a_symplectic_method_too() {
    let text = "title = \"Free\"\n[coordinates]\nx = { initial = 0, velocity = 1 }\n\
         y = { initial = 0, velocity = 1 }\n[lagrangian]\nL = \"1/2*x'^2 + 1/2*y'^2\"\n\
         [[observables]]\nname = \"G\"\nexpression = \"y' + 1e-5*x\"\nconserved = true\n";
    let mut experiment = build(text, |setup| {
        "leapfrog".clone_into(&mut setup.method);
        setup.settings.step = Some(0.01);
    });
    run(&mut experiment, 1.0);
    let claimed = gauge(&experiment.snapshot(), "G");
    assert_eq!(claimed.verdict.word(), "secular", "{claimed:?}");
}
