//! A table that is not a Poisson structure is refused with the triple that fails; a false Casimir is refused too.

use phaselab::claims::{false_claims, structure_diagnostics};
use phaselab::{mechanics, preset};

use super::{BODY, LOTKA_VOLTERRA, TOP};

/// The reports on a file's brackets and Casimirs, each with the text at its position.
fn reported(text: &str) -> Vec<String> {
    let model = preset::read(text).unwrap_or_else(|diagnostics| panic!("{diagnostics:?}")).model;
    let equations = mechanics::derive(&model).expect("derivable");
    let found = structure_diagnostics(&model, &equations);
    let claims = false_claims(&model, &equations);
    assert_eq!(found.is_empty(), claims.is_empty(), "{claims:?}");
    let line = |m: &phaselab::diagnostic::Diagnostic| {
        let place = &text[m.place.clone()];
        format!("{place}: {}; {}", m.message, m.help.as_deref().unwrap_or(""))
    };
    found.iter().map(line).collect()
}

#[test]
fn what_is_a_structure_is_silent() {
    for text in [BODY, TOP, LOTKA_VOLTERRA] {
        assert_eq!(reported(text), Vec::<String>::new());
    }
    // any table of two variables is a structure, and so is any function times a structure of three
    assert!(reported(&LOTKA_VOLTERRA.replace("\"x*y\"", "\"exp(x*y) + 3\"")).is_empty());
    let scaled = BODY.replace("\"-L3\"", "\"-L3*(1 + L1^2)\"");
    let scaled = scaled.replace("\"-L1\"", "\"-L1*(1 + L1^2)\"");
    assert!(reported(&scaled.replace("\"-L2\"", "\"-L2*(1 + L1^2)\"")).is_empty());
    // no proof is found that this is zero, so it is decided numerically
    let hidden = BODY.replace("\"-L3\"", "\"-L3 + L1*L2*(exp(ln(2 + L3^2)) - 2 - L3^2)\"");
    assert!(reported(&hidden).is_empty());
}

#[test]
fn the_triple_that_fails_is_named_where_the_brackets_stand() {
    let wrong = BODY.replace("[\"L1\", \"L2\", \"-L3\"]", "[\"L1\", \"L2\", \"L1\"]");
    let wrong = wrong.replace("casimirs", "# casimirs");
    let all = reported(&wrong);
    assert_eq!(all.len(), 1, "{all:?}");
    assert!(all[0].starts_with("[[\"L1\", \"L2\", \"L1\"]"), "{all:?}");
    let said = "these brackets break Jacobi's identity for L1, L2, L3; \
                {L1, {L2, L3}} + {L2, {L3, L1}} + {L3, {L1, L2}} is −L₂, not 0";
    assert!(all[0].ends_with(said), "{all:?}");
    // a wrong sign in the top's table
    let wrong = TOP.replace("[\"L1\", \"G3\", \"G2\"]", "[\"L1\", \"G3\", \"-G2\"]");
    let all = reported(&wrong);
    assert!(all[0].contains("break Jacobi's identity for L1, "), "{all:?}");
    assert!(all[0].contains(" other threes"), "{all:?}");
    // refused numerically
    let wrong = BODY.replace("\"-L3\"", "\"-L3 + 1e-8*exp(ln(2 + L1^2))\"");
    assert!(reported(&wrong)[0].contains("break Jacobi's identity"), "{:?}", reported(&wrong));
}

#[test]
fn a_false_casimir_is_reported_with_the_bracket_that_does_not_vanish() {
    let casimir = "\"|L|²\" = \"L1^2 + L2^2 + L3^2\"";
    let all = reported(&BODY.replace(casimir, "C = \"L1^2 + 2*L2^2 + L3^2\""));
    assert_eq!(
        all,
        [
            "\"L1^2 + 2*L2^2 + L3^2\": `C` is not a Casimir of these brackets; {L1, C} is −2 L₂ L₃, not 0"
        ]
    );
    let energy = "C = \"L1^2/I1 + L2^2/I2 + L3^2/I3\"";
    let all = reported(&BODY.replace(casimir, energy));
    assert!(all[0].ends_with("not 0; but this H conserves it: it is an observable"), "{all:?}");
}
