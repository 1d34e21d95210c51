//! `bracket`: its output for people and for programs.

use serde_json::json;

use super::{PENDULUM, done, phaselab, program, with_file};

const OSCILLATOR: &str = r#"
title = "An oscillator in the plane"

[coordinates]
x = { initial = 1.0, momentum = 0.5 }
y = { initial = "a", momentum = 2.0 }

[parameters]
m = 2.0
a = 3.0

[hamiltonian]
H = "(p_x^2 + p_y^2)/(2*m) + (x^2 + y^2)/2"

[[observables]]
name = "L"
expression = "x*p_y - y*p_x"

[[observables]]
name = "D"
expression = "x*p_x + y*p_y"
"#;

fn oscillator(arguments: &[&str]) -> super::Done {
    with_file(OSCILLATOR, &[&["bracket", "system.toml"], arguments].concat())
}

#[test]
fn a_bracket_is_reported_with_its_name_and_its_value() {
    let text = oscillator(&["D", "L + p_x^2", "--set", "a=7"]).success();
    assert_eq!(text, "[D, L + p_x^2] = 2 p_x²\nat the start: 0.5\n");
    let text = oscillator(&["x^2 + y^2", "energy"]).success();
    let named = "                    = 2 D/m   (proved)\n";
    assert!(text.ends_with(&format!("{named}at the start: 6.5\n")), "{text}");
    let text = oscillator(&["L", "energy"]).success();
    assert_eq!(text, "[L, energy] = 0   (proved)\nat the start: 0.0\n");
    let text = oscillator(&["-y", "p_y*exp(2)", "--init", "y=-1"]).success();
    assert_eq!(text, "[-y, p_y*exp(2)] = −e^2\nat the start: -7.38905609893065\n");
}

#[test]
fn the_object_has_named_fields() {
    let object = oscillator(&["x^2 + y^2", "energy", "--format", "json"]).json();
    assert_eq!(object["f"], "x^2 + y^2");
    assert_eq!(object["g"], "energy");
    assert_eq!(object["recognised"], json!({ "is": "2*D/m", "how": "proved" }));
    assert_eq!(object["value"], json!(6.5));
    assert!(object["bracket"].is_string() && object.get("why").is_none());
    let object = oscillator(&["x", "p_x", "--format", "json"]).json();
    assert_eq!((&object["bracket"], &object["recognised"]), (&json!("1"), &json!(null)));
}

#[test]
fn a_lagrangian_without_closed_velocities_gives_the_value_and_says_why() {
    let file = "title = \"T\"\n[coordinates]\nx = { initial = 1, velocity = 0.5 }\n\
                [lagrangian]\nL = \"1/2*x'^2 + x^2*x'^4\"\n";
    let object = with_file(file, &["bracket", "system.toml", "x", "x'", "--format", "json"]).json();
    assert!(object["bracket"].is_null());
    assert!(object["why"].as_str().expect("a reason").contains("q′ is not known"), "{object}");
    let value = object["value"].as_f64().expect("a value");
    assert!((value - 0.25).abs() < 1e-15, "1/(1 + 12 x² x'²) is not {value}");
    let text = with_file(file, &["bracket", "system.toml", "x", "x'"]).success();
    assert!(text.ends_with("at the start: 0.25\n"), "{text}");
}

#[test]
fn a_bracket_in_latex_and_in_ascii() {
    let latex = oscillator(&["x^2", "energy", "--format", "latex"]).success();
    assert!(latex.starts_with("\\begin{align*}\n\\left[ {x}^{2},\\, E \\right] &= "), "{latex}");
    let home = tempfile::tempdir().expect("a temporary folder");
    let words = ["bracket", "pendulum", "theta'", "energy"];
    let ascii = done(program(home.path()).env("LC_ALL", "C").args(words)).success();
    assert!(ascii.is_ascii() && ascii.starts_with("[theta', energy] = "), "{ascii}");
}

#[test]
fn wrong_words_get_a_caret() {
    with_file(PENDULUM, &["bracket", "system.toml", "theta", "thet'"])
        .fails(2, &["unknown name `thet`", "did you mean `theta'`?", "G: "]);
    phaselab(&["bracket", "pendulum", "theta"]).fails(2, &["<G>"]);
    phaselab(&["bracket", "pendulum", "theta", "1", "--set", "q=1"])
        .fails(2, &["unknown parameter"]);
}

/// A map without a closed form, at any time: its brackets follow from derivatives of its relations.
#[test]
fn new_variables_without_a_closed_form_have_their_brackets() {
    let file = r#"
title = "A map without a closed form"
[coordinates]
q = { initial = 0.7, momentum = 0.4 }
[parameters]
a = 0.1
[hamiltonian]
H = "p_q^2/2 + q^2/2"
[[transformations]]
name = "wave"
kind = "F2"
F = "q*P + a*sin(q)*cos(P)*(1 + t)"
"#;
    let bracket = |f: &str, g: &str| {
        let words = ["bracket", "system.toml", f, g, "--init", "t=2", "--format", "json"];
        with_file(file, &words).json()
    };
    let canonical = bracket("Q", "P");
    assert_eq!((&canonical["bracket"], &canonical["value"]), (&json!("1"), &json!(1.0)));
    assert_eq!(bracket("P", "P^2")["recognised"]["how"], "proved");
    // p = P + a (1 + t) cos q cos P and Q = q − a (1 + t) sin q sin P, solved here by iteration
    let (q, p, b) = (0.7_f64, 0.4_f64, 0.3_f64);
    let new = |q: f64, p: f64| {
        let momentum = (0..200).fold(p, |x, _| p - b * q.cos() * x.cos());
        [q - b * q.sin() * momentum.sin(), momentum]
    };
    let h = 1e-5;
    let slope = |k: usize, [dq, dp]: [f64; 2]| {
        (new(q + h * dq, p + h * dp)[k] - new(q - h * dq, p - h * dp)[k]) / (2.0 * h)
    };
    let cases = [
        (bracket("q", "P"), slope(1, [0.0, 1.0])),
        (bracket("q", "Q"), slope(0, [0.0, 1.0])),
        (bracket("Q", "p_q"), slope(0, [1.0, 0.0])),
        (bracket("P", "H"), p * slope(1, [1.0, 0.0]) - q * slope(1, [0.0, 1.0])),
    ];
    for (found, expected) in cases {
        let value = found["value"].as_f64().expect("a value");
        assert!((value - expected).abs() < 1e-8, "{found} is not {expected}");
        // and the same in the new variables, since the map is canonical
        let there = found["charts"][0]["value"].as_f64().expect("a value");
        assert!((there - value).abs() < 1e-12, "{found}");
    }
}

/// The bracket in the variables of a map: equal where it is canonical, with the time in it too, and another where it is not.
#[test]
fn a_bracket_is_reported_in_the_new_variables_of_each_transformation() {
    let charts = |preset: &str, f: &str, g: &str, more: &[&str]| {
        let words = [&["bracket", preset, f, g, "--format", "json"], more].concat();
        let object = phaselab(&words).json();
        let charts = object["charts"].as_array().expect("charts").clone();
        let value = object["value"].as_f64().expect("a value");
        let all = charts.into_iter().map(|chart| {
            let name = chart["transformation"].as_str().expect("a name").to_owned();
            (name, chart["bracket"].clone(), chart["value"].as_f64().expect("a value"))
        });
        (value, all.collect::<Vec<_>>())
    };
    let near = |found: f64, expected: f64| {
        assert!((found - expected).abs() < 1e-12, "{found} is not {expected}");
    };
    let at = ["--init", "t=2", "--set", "Omega=0.3"];
    // [X, p_x] = cos Ωt, and with p_x of the moving axes too; [x p_x, y] and its like do not know of the time
    for (f, g, expected) in [
        ("X", "p_x", 0.6_f64.cos()),
        ("Y", "p_x", -0.6_f64.sin()),
        ("x1*p1", "p2^2 + x1", 1.0 - 0.2 * 2.0),
        ("P_X", "H", -0.6_f64.cos()),
    ] {
        let (value, charts) = charts("moving-axes", f, g, &at);
        // x1 = x − u t at x = 1, u = 0.2: [x₁ p₁, x₁] = −x₁
        let expected = if f == "x1*p1" { -(1.0 - 0.4) } else { expected };
        near(value, expected);
        assert_eq!(charts.len(), 2);
        for (name, written, there) in charts {
            assert!(written.is_string(), "{name}: {written}");
            near(there, expected);
        }
    }
    // m = 1, ω = 2, q = 1, p = ½: θ = atan2(q, p) and r are not canonical, [θ, r] = 1/r; X = λ q, Y = μ p with λ = 3, μ = ½
    let (value, charts) = charts("angle-of-the-oscillator", "theta", "r", &["--set", "lambda=3"]);
    near(value, 1.0 / 1.25_f64.sqrt());
    let found = |name: &str| charts.iter().find(|chart| chart.0 == name).expect("a chart").clone();
    near(found("action-angle").2, value);
    near(found("euler").2, value);
    assert_eq!(found("polar").1, "1");
    near(found("polar").2, 1.0);
    near(found("scaled").2, value / 1.5);
    let text = phaselab(&["bracket", "moving-axes", "X", "p_x", "--init", "t=2"]).success();
    assert!(
        text.contains("in X, Y, P_X, P_Y of rotating axes: cos(Ω t); at the start: 0.82533"),
        "{text}"
    );
    // what no transformation is in has no other charts
    let plain = phaselab(&["bracket", "planet", "p_theta", "energy"]).success();
    assert!(!plain.contains(" of "), "{plain}");
}
