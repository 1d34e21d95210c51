//! A scope by itself, as `--observe` and the prompts of the laboratory use it.

use phaselab::model::Allowed::{self, Hamiltonian, Lagrangian, Observable, Parameters};
use phaselab::model::{Model, Scope};
use phaselab::preset::read;

use super::GOOD;

fn oscillator() -> Model {
    let text = GOOD.replace("m = 1.0", "m = 1.0\nlength = 1.0");
    let text = format!(
        "{text}[definitions]\nV = \"k*x^2*length\"\nM = \"p_x + x'\"\nGamma_x = \"k*x\"\nGamma_y = \"m*x\"\n"
    );
    read(&text).unwrap().model
}

/// The messages about one expression in a context.
fn messages(allowed: Allowed, place: &str, text: &str) -> Vec<String> {
    let mut model = oscillator();
    let mut scope = Scope::new(&model, allowed, place);
    let read = scope.read(&mut model.pool, text);
    assert_eq!(read.is_none(), !scope.diagnostics.is_empty());
    let errors = scope.diagnostics.iter();
    errors
        .map(|m| match &m.help {
            Some(help) => format!("{}..{} {m}; {help}", m.span.start, m.span.end),
            None => format!("{}..{} {m}", m.span.start, m.span.end),
        })
        .collect()
}

#[test]
fn each_place_says_what_it_may_not_use() {
    let check = |allowed, place, text, expected: &[&str]| {
        assert_eq!(messages(allowed, place, text), expected, "{text} in {place}");
    };
    check(Observable, "an observable", "x + x' + x'' + p_x + t + energy + action + M + V", &[]);
    check(Lagrangian, "the Lagrangian", "x + x' + t + V + m", &[]);
    check(Hamiltonian, "the Hamiltonian", "x + p_x + t + V + m", &[]);
    check(Parameters, "an initial value", "m*sin(pi/4) + length", &[]);
    check(
        Lagrangian,
        "the Lagrangian",
        "x''*p_x + action",
        &[
            "0..3 `x''` may not be used here: the Lagrangian is a function of q, q' and t",
            "4..7 `p_x` may not be used here: the Lagrangian is a function of q, q' and t; write it \
             in velocities, or give the law in [hamiltonian]",
            "10..16 `action` may not be used here: the Lagrangian comes before energy and action, \
             which follow from it",
        ],
    );
    check(
        Hamiltonian,
        "a force",
        "2*M",
        &["2..3 `M` may not be used here: it uses `x'`, and a force is a function of q, p and t; \
           write it in momenta, or give the law in [lagrangian]"],
    );
    check(
        Parameters,
        "an initial value",
        "V + t",
        &[
            "0..1 `V` may not be used here: it uses `x`, and an initial value is made of parameters \
             only",
            "4..5 `t` may not be used here: an initial value is made of parameters only",
        ],
    );
}

#[test]
fn the_nearest_name_is_one_that_may_stand_there() {
    let check = |allowed, text, expected: &str| {
        assert_eq!(messages(allowed, "this", text), [expected], "{text}");
    };
    check(Observable, "lenght", "0..6 unknown name `lenght`; did you mean `length`?");
    check(Observable, "LENGTH", "0..6 unknown name `LENGTH`; did you mean `length`?");
    check(Observable, "q_x", "0..3 unknown name `q_x`; did you mean `p_x`?");
    check(Parameters, "q_x", "0..3 unknown name `q_x`; give it a value in [parameters]");
    check(Observable, "X'", "0..2 unknown name `X`; did you mean `x'`?");
    check(Observable, "Gamma", "0..5 unknown name `Gamma`; did you mean `Gamma_x` or `Gamma_y`?");
    check(Observable, "enrgy", "0..5 unknown name `enrgy`; did you mean `energy`?");
    check(
        Observable,
        "y",
        "0..1 unknown name `y`; give it a value in [parameters], or define it in [definitions]",
    );
    check(Observable, "sqr(x)", "0..3 unknown function `sqr`; did you mean `sqrt`?");
}

/// An unknown function hides no unknown name beside it or in it.
#[test]
fn every_unknown_name_is_reported_at_once() {
    let check = |text, expected: &[&str]| {
        let found = messages(Lagrangian, "the Lagrangian", text);
        let names: Vec<&str> = found.iter().filter_map(|text| text.split('`').nth(1)).collect();
        assert_eq!(names, expected, "{text}: {found:?}");
    };
    check("x'^2 + 2*length*sni(x)*kk", &["sni", "kk"]);
    check("x'^2 + 2 length sni(x) kk", &["sni", "kk"]);
    check("sni(kk)*csc2(x)", &["sni", "csc2", "kk"]);
}

/// The same text gives the same messages, whatever the order of tables in memory.
#[test]
fn messages_do_not_change_from_run_to_run() {
    let text = "a*b + M'*V'' + p_y + lenth + sinn(x) + x'''";
    let first = messages(Lagrangian, "the Lagrangian", text);
    assert_eq!(first.len(), 8);
    for _ in 0..20 {
        assert_eq!(messages(Lagrangian, "the Lagrangian", text), first);
    }
}

#[test]
fn a_scope_tells_what_was_used() {
    let mut model = oscillator();
    let mut scope = Scope::new(&model, Observable, "an observable");
    assert!(scope.read(&mut model.pool, "V*x' + p_x*V").is_some());
    assert_eq!(scope.used.iter().map(String::as_str).collect::<Vec<_>>(), ["V", "p_x", "x"]);
    assert!(scope.knows("length") && !scope.knows("width"));
}

/// A name that is announced gives a separate kind of error until it is defined.
#[test]
fn announced_names_wait_for_their_definition() {
    let mut model = oscillator();
    let mut scope = Scope::new(&model, Observable, "an observable");
    scope.announce("speed");
    assert!(scope.read(&mut model.pool, "2*speed").is_none());
    assert_eq!(scope.diagnostics[0].message, "`speed` is not defined yet at this place");
    scope.diagnostics.clear();
    let rate = scope.read(&mut model.pool, "x'").unwrap();
    scope.define("speed", rate);
    let twice = scope.read(&mut model.pool, "2*speed").unwrap();
    assert_eq!(model.pool.text(twice), "2*x'");
}
