//! `reverse`: how far motions come back, against what their exponents predict, and motions without a way back.

use super::{phaselab, with_file};

fn reverse(words: &[&str]) -> serde_json::Value {
    phaselab(&[&["reverse"], words, &["--format", "json"]].concat()).json()
}

fn number(object: &serde_json::Value, name: &str) -> f64 {
    object[name].as_f64().unwrap_or_else(|| panic!("{name} of {object}"))
}

#[test]
fn a_regular_motion_returns_to_rounding() {
    let found = reverse(&["pendulum", "--until", "50"]);
    assert!(number(&found, "return_error") < 1e-13, "{found}");
    assert_eq!((number(&found, "turned"), number(&found, "t")), (50.0, 0.0));
    assert_eq!(found["method"]["name"], "taylor");
    let text = phaselab(&["reverse", "pendulum", "--until", "50"]).success();
    assert!(text.starts_with("from t = 50 back to t = 0: "), "{text}");
    let met = text.lines().next().is_some_and(|line| {
        line.ends_with(" from where it began") || line.ends_with("to the last bit")
    });
    assert!(met, "{text}");
}

/// The orbit B of Hénon and Heiles at E = 1/8 has λ = 0.19195453623623.
#[test]
fn a_chaotic_motion_returns_to_the_error_of_a_step_times_its_growth() {
    let start = ["--init=x=0", "--init=y=-0.18", "--init=p_x=0.46", "--init=p_y=0.01"];
    for tolerance in ["1e-9", "1e-12"] {
        let words = [&["henon-heiles", "--until", "60", "--tolerance", tolerance], &start[..]];
        let words = [&words.concat()[..], &["--method", "dop853"]].concat();
        let found = reverse(&words);
        let (error, expected) = (number(&found, "return_error"), number(&found, "expected"));
        let lambda = number(&found, "exponent");
        assert!(lambda > 0.02 && lambda < 0.3, "{found}");
        // errors of many steps add up, each carried by the flow, and cancel in part
        assert!(error < expected && error > 1e-4 * expected, "{error} {expected}");
        assert!(error > 10.0 * number(&found, "step_error"), "{found}");
    }
    // of a series ε is the tolerance
    let found = reverse(
        &[&["henon-heiles", "--until", "100", "--tolerance", "1e-12"], &start[..]].concat(),
    );
    let (error, expected) = (number(&found, "return_error"), number(&found, "expected"));
    assert!(error < 10.0 * expected && error > 1e-5 * expected, "{error:e} {expected:e}");
    assert!(found["step"].is_null(), "{found}");
}

/// The period of a pendulum depends on its amplitude: what is expected of independent errors grows like t^{3/2}, where
/// ε e^{λT} would stay at ε.
#[test]
fn of_a_regular_motion_the_expected_error_grows_with_its_shear() {
    let [short, long] = ["50", "200"].map(|until| {
        let found = reverse(&["pendulum", "--until", until, "--tolerance", "1e-12"]);
        let (error, expected) = (number(&found, "return_error"), number(&found, "expected"));
        assert!(error < expected, "{error:e} {expected:e}");
        assert!(expected > 10.0 * number(&found, "step_error"), "{found}");
        expected
    });
    let power = (long / short).log2() / 2.0;
    assert!((power - 1.5).abs() < 0.1, "{power}");
}

/// A motion subject to constraints comes back too, and its exponent is known; derivatives are not followed backwards there.
#[test]
fn a_motion_under_constraints_returns() {
    let found = reverse(&["pendulum-rod", "--until", "20", "--tolerance", "1e-12"]);
    assert!(number(&found, "return_error") < 1e-9, "{found}");
    assert!(number(&found, "exponent").abs() < 0.5 && found["expected"].is_null(), "{found}");
    let done = phaselab(&["flow", "pendulum-rod", "--until", "-5"]);
    assert!(done.code != 0 && done.stderr.contains("forwards only"), "{}", done.stderr);
}

/// Where a step back is not the inverse of one forwards, truncation makes the return error, not rounding: of order 4 it falls by
/// 2⁵ with half the step, as each step's there and back by 2⁶, and what is expected bounds it closely.
#[test]
fn truncation_is_expected_of_a_method_that_is_not_reversible() {
    for (words, most) in
        [(["pendulum", "--until", "50"], 10.0), (["henon-heiles", "--until", "100"], 10.0)]
    {
        let [coarse, fine] = ["0.04", "0.02"].map(|step| {
            let found = reverse(&[&words[..], &["--method", "rk4", "--step", step]].concat());
            assert!(
                (number(&found, "step") - step.parse::<f64>().unwrap()).abs() < 1e-12,
                "{found}"
            );
            ["return_error", "expected", "step_error"].map(|name| number(&found, name))
        });
        for [error, expected, _] in [coarse, fine] {
            assert!(error < expected && expected < most * error, "{error:e} {expected:e}");
        }
        let order = |k: usize| (coarse[k] / fine[k]).log2();
        assert!(
            (order(0) - 5.0).abs() < 0.3 && (order(2) - 6.0).abs() < 0.3,
            "{coarse:?} {fine:?}"
        );
    }
    let text = phaselab(&["reverse", "pendulum", "--until", "5", "--method", "rk4"]).success();
    assert!(text.contains("of all steps, carried   ≤ ") && !text.contains("ε e^λT"), "{text}");
}

/// Friction −c x' shrinks areas: backwards they grow, by e^{cT}.
#[test]
fn friction_makes_the_way_back_unstable() {
    let text = "title = \"t\"\n[coordinates]\nx = { initial = 1.0, velocity = 0.0 }\n\
        [lagrangian]\nL = \"1/2*x'^2\"\ndissipation = \"1/2*x'^2\"\n";
    let words = ["reverse", "./system.toml", "--until", "200", "--format", "json"];
    let found: serde_json::Value = serde_json::from_str(&with_file(text, &words).stdout).unwrap();
    // the exponents are 0 and −c; over the time T two vectors know them to ln √2 / T, as M = [[1, 1 − e^−T], [0, e^−T]]
    let within = 2f64.sqrt().ln() / 200.0;
    assert!((number(&found, "exponent") - 1.0).abs() < within, "{found}");
}

#[test]
fn where_there_is_no_way_back_it_is_said_why() {
    let done = phaselab(&["reverse", "bouncing-ball", "--until", "1"]);
    assert!(done.code == 1 && done.stdout.is_empty());
    assert!(done.stderr.contains("makes the motion jump"), "{}", done.stderr);
    let done = phaselab(&["reverse", "pendulum", "--until", "-1"]);
    assert!(done.code == 2 && done.stderr.contains("is not after it"), "{}", done.stderr);
}

/// The steps that pass a kink err by more than others, and on the way back by something else: nothing is expected of them.
#[test]
fn nothing_is_expected_of_a_method_that_steps_over_kinks() {
    let file = "title = \"T\"\n[coordinates]\nx = { initial = 0.3, velocity = 0.8 }\n\
                [lagrangian]\nL = \"x'^2/2 - abs(x)\"\n";
    let reverse = |method: &str| {
        with_file(file, &["reverse", "system.toml", "--until", "3", "--method", method]).success()
    };
    let leapfrog = reverse("leapfrog");
    assert!(leapfrog.contains("the method steps over the kinks"), "{leapfrog}");
    assert!(!leapfrog.contains("of all steps"), "{leapfrog}");
    assert!(!reverse("taylor").contains("the method steps over the kinks"));
}
