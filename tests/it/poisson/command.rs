//! The command line with files of Poisson systems.

use serde_json::{Value, json};

use super::{BODY, TOP};
use crate::cli::with_file;

#[test]
fn derive_prints_brackets_casimirs_and_rates() {
    let page = with_file(BODY, &["derive", "system.toml"]).success();
    for lines in [
        "\nBrackets\n  {L₁, L₂} = −L₃\n  {L₁, L₃} = L₂\n  {L₂, L₃} = −L₁\n",
        "\nCasimirs\n  |L|² = L₁² + L₂² + L₃²\n",
        "\nConserved\n  E   (∂H/∂t = 0)\n  |L|²   (Casimir, B ∇C = 0)\n",
    ] {
        assert!(page.contains(lines), "no {lines} in {page}");
    }
    assert!(page.contains("\nEquations of motion\n  L₁′ = "), "{page}");
    assert!(!page.contains("Cyclic") && !page.contains("Momenta"), "{page}");

    let object = with_file(BODY, &["derive", "system.toml", "--format", "json"]).json();
    let brackets = json!([["L1", "L2", "-L3"], ["L1", "L3", "L2"], ["L2", "L3", "-L1"]]);
    assert_eq!(object["brackets"], brackets);
    assert_eq!(object["variables"], json!(["L1", "L2", "L3"]));
    assert_eq!(object["casimirs"][0]["name"], "|L|²");
    assert_eq!(object["casimirs"][0]["rate"], "0");
    assert_eq!(object["equations"]["L1'"], "L2*L3*(1/I3 - 1/I2)");
    assert_eq!((&object["mass_matrix"], &object["momenta"]), (&Value::Null, &json!({})));

    let latex = with_file(BODY, &["derive", "system.toml", "--format", "latex"]).success();
    assert!(latex.contains("\\{L_{1}, L_{2}\\} &= -L_{3} \\\\\n"), "{latex}");
    assert!(latex.contains("C_{1} &= {L_{1}}^{2} + {L_{2}}^{2} + {L_{3}}^{2}"), "{latex}");
}

#[test]
fn run_has_variables_energy_casimirs_and_observables() {
    let words = ["run", "system.toml", "--at", "0,0.5", "--format", "json", "--init", "L1=0.25"];
    let object = with_file(TOP, &words).json();
    let columns = ["t", "L1", "L2", "L3", "G1", "G2", "G3", "energy", "length", "vertical", "spin"];
    assert_eq!(object["columns"], json!(columns));
    assert_eq!(object["rows"][0][1], json!(0.25));
    let names: Vec<&str> = object["invariants"]
        .as_array()
        .unwrap()
        .iter()
        .map(|i| i["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["energy", "length", "vertical", "spin"]);
    with_file(TOP, &["run", "system.toml", "--init", "L1'=1"])
        .fails(2, &["unknown initial value `L1'`"]);
    with_file(TOP, &["run", "system.toml", "--init", "p_L1=1"])
        .fails(2, &["unknown initial value `p_L1`", "there are L1, L2"]);
    with_file(TOP, &["run", "system.toml", "--method", "yoshida4"])
        .fails(2, &["yoshida4", "brackets"]);
}

#[test]
fn brackets_are_written_in_braces() {
    let text = with_file(BODY, &["bracket", "system.toml", "L1", "L2"]).success();
    assert_eq!(text, "{L1, L2} = −L₃\nat the start: -0.03\n");
    let text =
        with_file(BODY, &["bracket", "system.toml", "L1*L2 + L3", "L1^2+L2^2+L3^2"]).success();
    assert_eq!(text, "{L1*L2 + L3, L1^2+L2^2+L3^2} = 0   (proved)\nat the start: 0.0\n");
}

#[test]
fn what_is_no_structure_is_refused_by_every_command_at_its_place() {
    let wrong = BODY.replace("[\"L1\", \"L2\", \"-L3\"]", "[\"L1\", \"L2\", \"L1\"]");
    let wrong = wrong.replace("casimirs", "# casimirs");
    let said = ["break Jacobi's identity for L1, L2, L3", "system.toml:19:12", "is −L₂, not 0"];
    for command in [&["check"][..], &["run"], &["derive"]] {
        with_file(&wrong, &[command, &["system.toml"]].concat()).fails(65, &said);
    }
    let wrong = BODY.replace("L1^2 + L2^2 + L3^2", "L1^2 - L2^2 + L3^2");
    with_file(&wrong, &["check", "system.toml"]).fails(65, &["`|L|²` is not a Casimir", ":20:"]);
}

/// Brackets have no Lagrangian, so that nothing has its integral: a column of zeros would be none.
#[test]
fn brackets_have_no_action() {
    let run = ["run", "system.toml", "--observe", "action", "--until", "1"];
    let lacks = "brackets have no Lagrangian";
    with_file(BODY, &run).fails(2, &["unknown name `action`", lacks]);
}
