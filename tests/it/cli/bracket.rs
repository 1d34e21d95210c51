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
    let text = oscillator(&["-y", "p_y*exp(ln(2))", "--init", "y=-1"]).success();
    assert_eq!(text, "[-y, p_y*exp(ln(2))] = −e^(ln 2)\nat the start: -2.0\n");
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
    assert!(object["why"].as_str().expect("a reason").contains("q̇ is not known"), "{object}");
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
    phaselab(&["bracket", "pendulum", "theta", "1", "--set", "q=1"]).fails(2, &["no parameter"]);
}
