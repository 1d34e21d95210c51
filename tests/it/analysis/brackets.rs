//! A file's claims about brackets, true and false.

use phaselab::claims::false_claims;
use phaselab::mechanics::derive;
use phaselab::model::{ExpectedBracket, Model};

use crate::build::{hamiltonian, lagrangian, read};

fn claim(model: &mut Model, f: &str, g: &str, is: &str) {
    let written = format!("[{f}, {g}]");
    let [f, g, is] = [f, g, is].map(|text| read(model, text));
    let place = 3..7;
    let source = String::new();
    model.expect.brackets.push(ExpectedBracket { f, g, is, written, source, place });
}

/// The report on one claim; empty if the claim is true.
fn reported(mut model: Model, f: &str, g: &str, is: &str) -> String {
    claim(&mut model, f, g, is);
    let equations = derive(&model).expect("derivable");
    let diagnostics = false_claims(&model, &equations);
    assert!(diagnostics.iter().all(|m| m.place == (3..7)), "{diagnostics:?}");
    let lines =
        diagnostics.iter().map(|m| format!("{}; {}", m.message, m.help.as_deref().unwrap_or("")));
    lines.collect::<Vec<_>>().join("\n")
}

fn oscillator() -> Model {
    let mut model = hamiltonian(&["x", "y"], &["m", "k"], "(p_x^2+p_y^2)/(2*m) + k*(x^2+y^2)/2");
    for (c, value) in model.coordinates.iter_mut().zip([1, 2]) {
        c.initial = model.pool.integer(value);
    }
    model
}

#[test]
fn a_true_bracket_is_silent_and_a_false_one_is_reported_with_the_right_one() {
    assert_eq!(reported(oscillator(), "x*p_y - y*p_x", "energy", "0"), "");
    assert_eq!(reported(oscillator(), "x", "p_x", "1"), "");
    assert_eq!(reported(oscillator(), "x*p_y - y*p_x", "x", "y"), "");
    let wrong = reported(oscillator(), "x*p_y - y*p_x", "x", "-y");
    assert_eq!(wrong, "[x*p_y - y*p_x, x] is not what this says; it is y");
    let nearly = reported(oscillator(), "x", "p_x", "1 + 1e-9");
    assert_eq!(nearly, "[x, p_x] is not what this says; it is 1");
    let open = reported(oscillator(), "x", "action", "1");
    assert!(open.contains("cannot be checked: the action is an integral"), "{open}");
}

#[test]
fn what_no_proof_is_found_for_is_held_against_twenty_points() {
    // exp(ln(1 + x²)) = 1 + x² has no proof in this algebra
    assert_eq!(reported(oscillator(), "x", "p_x*exp(ln(1 + x^2))", "1 + x^2"), "");
    let wrong = reported(oscillator(), "x", "p_x*exp(ln(1 + x^2))", "1 + x^2 + 1e-8*y");
    assert!(wrong.contains("is not what this says"), "{wrong}");
    // outside the domain of both expressions nothing can be evaluated
    let nowhere = reported(oscillator(), "x*ln(-1 - x^2)", "p_x*ln(-1 - y^2)", "3");
    assert!(nowhere.contains("it has no value near the start"), "{nowhere}");
}

#[test]
fn a_lagrangian_without_a_hamiltonian_is_judged_through_its_velocities() {
    let quartic = || lagrangian(&["x"], &["a"], "1/2*x'^2 + a*x^2*x'^4");
    assert_eq!(reported(quartic(), "x", "x'", "1/(1 + 12*a*x^2*x'^2)"), "");
    let wrong = reported(quartic(), "x", "x'", "1/(1 + 12*a*x^2*x'^2) + 1e-8");
    assert!(wrong.contains("near the start it is off by"), "{wrong}");
}
