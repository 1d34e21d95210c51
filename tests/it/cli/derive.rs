//! `derive`: the keys and the syntax for other programs.

use std::collections::HashMap;

use serde_json::Value;

use super::{PENDULUM, done, phaselab, program, with_file};
use crate::nonempty;
use phaselab::model::{Allowed, Scope};
use phaselab::preset::Catalog;

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_else(|| panic!("{value} is not an expression"))
}

#[test]
fn a_pendulum_as_an_object() {
    let object = with_file(PENDULUM, &["derive", "system.toml", "--format", "json"]).json();
    assert_eq!(object["coordinates"], serde_json::json!(["theta"]));
    assert_eq!(text(&object["momenta"]["p_theta"]), "m*theta'");
    assert_eq!(text(&object["equations"]["theta''"]), "-sin(theta)");
    assert_eq!(object["mass_matrix"], serde_json::json!([["m"]]));
    assert_eq!(object["right_hand_side"], serde_json::json!(["-m*sin(theta)"]));
    assert_eq!(text(&object["hamiltonian"]), "1/2*p_theta^2/m - m*cos(theta)");
    assert_eq!(text(&object["energy"]), "1/2*m*theta'^2 - m*cos(theta)");
    assert_eq!(object["cyclic"], serde_json::json!([]));
    assert_eq!(object["conserved"][0]["name"], "energy");
    assert_eq!(object["constraints"], serde_json::json!([]));
    assert_eq!(object["transformations"], serde_json::json!([]));
    assert!(object.get("why").is_none());
}

#[test]
fn a_hamiltonian_gives_both_rates() {
    let file = "title = \"T\"\n[coordinates]\nx = { initial = 1, momentum = 0 }\n\
                [hamiltonian]\nH = \"p_x^2/2 + x^4/4\"\n";
    let object = with_file(file, &["derive", "system.toml", "--format", "json"]).json();
    assert_eq!(text(&object["equations"]["x'"]), "p_x");
    assert_eq!(text(&object["equations"]["p_x'"]), "-x^3");
    assert_eq!(text(&object["hamiltonian"]), "1/2*p_x^2 + 1/4*x^4");
    assert!(object["mass_matrix"].is_null());
}

#[test]
fn what_has_no_closed_form_is_null_and_says_why() {
    let file = "title = \"T\"\n[coordinates]\nx = { initial = 1, velocity = 0.1 }\n\
                [lagrangian]\nL = \"1/2*x'^2 + x'^4/4 + x'^6/6 - x^2/2\"\n";
    let object = with_file(file, &["derive", "system.toml", "--format", "json"]).json();
    assert!(object["hamiltonian"].is_null(), "{object}");
    assert!(text(&object["why"]).contains("hamiltonian: "), "{object}");
    // five coordinates coupled each with each by a mass matrix that moves
    let names = ["a", "b", "c", "d", "e"];
    let starts: Vec<String> = names.iter().map(|q| format!("{q} = {{ initial = 1 }}")).collect();
    let speed: Vec<String> = names.iter().map(|q| format!("{q}'*cos({q})")).collect();
    let squares: Vec<String> = names.iter().map(|q| format!("{q}'^2")).collect();
    let file = format!(
        "title = \"T\"\n[coordinates]\n{}\n[lagrangian]\nL = \"{} + ({})^2\"\n",
        starts.join("\n"),
        squares.join(" + "),
        speed.join(" + ")
    );
    let object = with_file(&file, &["derive", "system.toml", "--format", "json"]).json();
    assert!(object["equations"].is_null() && object["hamiltonian"].is_null(), "{object}");
    assert_eq!(object["mass_matrix"].as_array().map(Vec::len), Some(5));
    let why = text(&object["why"]);
    for part in ["equations: ", "; hamiltonian: "] {
        let sentence = "the mass matrix changes during the motion and couples 5 coordinates each";
        assert!(why.contains(&format!("{part}{sentence}")), "{why}");
    }
}

#[test]
fn every_preset_derives_in_its_own_syntax() {
    for entry in nonempty(Catalog::with_folder(None).entries()) {
        let name = entry.name.as_str();
        let object = phaselab(&["derive", name, "--format", "json"]).json();
        let document = entry.document().expect("a shipped preset is at hand");
        let mut model = document.read().expect("a shipped preset is right").model;
        let mut scope = Scope::new(&model, Allowed::Observable, "a test");
        let momenta = object["momenta"].as_object().expect("an object of momenta");
        let equations = object["equations"].as_object().cloned().unwrap_or_default();
        let conserved = object["conserved"].as_array().expect("a list").iter();
        let all: HashMap<String, &Value> = momenta
            .iter()
            .chain(&equations)
            .map(|(name, e)| (name.clone(), e))
            .chain(conserved.map(|c| (c["name"].to_string(), &c["expression"])))
            .chain([("energy".to_owned(), &object["energy"])])
            .collect();
        for (quantity, e) in all {
            let read = scope.read(&mut model.pool, text(e));
            assert!(read.is_some(), "{name}, {quantity}: {:?}", scope.diagnostics);
        }
    }
}

#[test]
fn text_is_mathematics_in_unicode_and_in_ascii() {
    let unicode = phaselab(&["derive", "pendulum"]).success();
    for line in ["  L = ½ m l² θ′² + m g l cos θ", "  θ″ = −(g/l) sin θ", "  E   (∂L/∂t = 0)"]
    {
        assert!(unicode.contains(line), "no `{line}` in {unicode}");
    }
    let home = tempfile::tempdir().expect("a temporary folder");
    for preset in Catalog::with_folder(None).entries() {
        let name = preset.name.as_str();
        let ascii = done(program(home.path()).env("LC_ALL", "C").args(["derive", name])).success();
        assert!(ascii.is_ascii(), "{name}: {ascii}");
    }
    let root = "[coordinates]\nx = { initial = 1 }\n[lagrangian]\nL = \"1/2*x'^2 - sqrt(x)^2\"\n";
    std::fs::write(home.path().join("root.toml"), root).expect("a file");
    let derive = ["derive", "./root.toml"];
    let ascii = done(program(home.path()).current_dir(home.path()).env("LC_ALL", "C").args(derive));
    let ascii = ascii.success();
    assert!(ascii.is_ascii() && ascii.contains("x >= 0"), "{ascii}");
}

#[test]
fn latex_is_one_aligned_block() {
    let latex = phaselab(&["derive", "damped-pendulum", "--format", "latex"]).success();
    assert!(latex.contains("\\begin{align*}\nL &= \\frac{1}{2} m {l}^{2} {\\dot{\\theta}}^{2}"));
    assert!(latex.contains("\\ddot{\\theta} &= "), "{latex}");
    assert!(latex.contains("F &= \\frac{1}{2} c {\\dot{\\theta}}^{2}"), "{latex}");
    assert!(latex.ends_with("\\end{align*}\n"), "{latex}");
    let opened = latex.matches('{').count();
    assert_eq!(opened, latex.matches('}').count());
}

/// What would be a command of LaTeX in a symbol is a letter.
#[test]
fn symbols_are_no_commands_of_latex() {
    let file = "title = \"T\"\n[coordinates]\nx = { symbol = \"x&\\\\input{a}\", initial = 1 }\n\
                y = { symbol = \"v_y\", initial = 1 }\n\
                [lagrangian]\nL = \"(x'^2 + y'^2)/2\"\n";
    let latex = with_file(file, &["derive", "system.toml", "--format", "latex"]).success();
    assert!(latex.contains("\\dot{x\\&\\backslash input\\{a\\}}"), "{latex}");
    assert!(latex.contains("\\dot{v_y}"), "{latex}");
}

/// Without a damper the energy is conserved, although the law has one.
#[test]
fn an_energy_that_is_conserved_at_the_values_of_the_file_is_listed() {
    let file = |c: &str| {
        format!(
            "title = \"T\"\n[coordinates]\nx = 1\n[parameters]\nc = {c}\n\
             [lagrangian]\nL = \"(x'^2 - x^2)/2\"\ndissipation = \"c*x'^2/2\"\n"
        )
    };
    let derived = |c: &str| {
        with_file(&file(c), &["derive", "system.toml", "--format", "json"]).json()["conserved"]
            .clone()
    };
    let known = derived("0");
    assert_eq!(known[0]["name"], "energy", "{known}");
    assert_eq!(known[0]["reason"], "constant at c = 0");
    assert_eq!(derived("0.1"), serde_json::json!([]));
}

#[test]
fn every_observable_is_classed() {
    let file = "title = \"T\"\n[coordinates]\nx = { initial = 1, velocity = 0 }\n\
                y = { initial = 0, velocity = 1 }\n\
                [lagrangian]\nL = \"(x'^2 + y'^2)/2 - sqrt(x^2 + y^2)\"\n\
                [[observables]]\nname = \"Lz\"\nexpression = \"x*y' - y*x'\"\n\
                [[observables]]\nname = \"still\"\nexpression = \"energy*exp(ln(2 + x^2)) - energy*(2 + x^2)\"\n\
                [[observables]]\nname = \"r2\"\nexpression = \"x^2 + y^2\"\n";
    let object = with_file(file, &["derive", "system.toml", "--format", "json"]).json();
    let class = |i: usize| text(&object["observables"][i]["class"]).to_owned();
    assert_eq!(text(&object["observables"][0]["name"]), "Lz");
    assert_eq!(
        (class(0).as_str(), text(&object["observables"][0]["rate"])),
        ("conserved (proved)", "0")
    );
    assert_eq!(class(1), "conserved (proved)");
    assert_eq!(class(2), "not conserved");
    assert_eq!(text(&object["observables"][2]["rate"]), "2*x*x' + 2*y*y'");
    let page = with_file(file, &["derive", "system.toml"]).success();
    assert!(page.contains("\nNot conserved\n  d(r2)/dt = 2 x x′ + 2 y y′\n"), "{page}");
}

#[test]
fn an_observable_is_classed_where_accelerations_have_no_closed_form() {
    // nine coupled links: q̈ is too long to write
    let names: Vec<String> = (1..=9).map(|i| format!("a{i}")).collect();
    let mut file = String::from("title = \"T\"\n[coordinates]\n");
    for name in &names {
        file.push_str(&format!("{name} = {{ initial = 0.3, velocity = 0.1 }}\n"));
    }
    let mut terms = Vec::new();
    for i in 1..=9 {
        for j in 1..=9 {
            terms.push(format!("{}*a{i}'*a{j}'*cos(a{i} - a{j})", 10 - i.max(j)));
        }
    }
    file.push_str(&format!("[lagrangian]\nL = \"1/2*({})\"\n", terms.join(" + ")));
    file.push_str("[[observables]]\nname = \"doubled\"\nexpression = \"2*energy\"\n");
    file.push_str("[[observables]]\nname = \"turn\"\nexpression = \"a1'\"\n");
    let sum = names.iter().map(|n| format!("p_{n}")).collect::<Vec<_>>().join(" + ");
    file.push_str(&format!("[[observables]]\nname = \"spin\"\nexpression = \"{sum}\"\n"));
    let object = with_file(&file, &["derive", "system.toml", "--format", "json"]).json();
    assert!(object["equations"].is_null(), "this has a closed form after all");
    let class = |i: usize| text(&object["observables"][i]["class"]);
    // by the law of the energy and by ṗ, for which no q̈ is needed
    assert_eq!(class(0), "conserved (proved)");
    assert_eq!((class(1), &object["observables"][1]["rate"]), ("not conserved", &Value::Null));
    assert_eq!(class(2), "conserved (proved)");
}

/// Knife edge and rolling hoop; a central force in polar and in Cartesian coordinates.
#[test]
fn holonomic_and_separable_are_said() {
    let object = phaselab(&["derive", "knife-edge", "--format", "json"]).json();
    assert_eq!(object["constraints"][0]["holonomic"], false);
    assert_eq!(object["constraints"][0]["given"], "velocity");
    let object = phaselab(&["derive", "rolling-hoop", "--format", "json"]).json();
    assert_eq!(object["constraints"][0]["holonomic"], true);
    assert_eq!(text(&object["constraints"][0]["holonomy"]["constant"]), "r*theta - x");
    let object = phaselab(&["derive", "rolling-disc", "--format", "json"]).json();
    for constraint in object["constraints"].as_array().expect("constraints") {
        assert_eq!(constraint["holonomic"], false, "{constraint}");
    }
    let object = phaselab(&["derive", "smooth-sphere", "--format", "json"]).json();
    assert_eq!(object["constraints"][0]["given"], "position");
    assert!(object["separates"].is_null(), "{object}");
    let object = phaselab(&["derive", "planet", "--format", "json"]).json();
    assert_eq!(object["separates"], true);
    assert_eq!(object["separation"]["for_all_parameters"], true);
    let object = phaselab(&["derive", "kepler-brackets", "--format", "json"]).json();
    assert_eq!(object["separates"], false, "{object}");
    let words = phaselab(&["derive", "spherical-pendulum"]).success();
    assert!(words.contains("separates in these coordinates"), "{words}");
    let words = phaselab(&["derive", "henon-heiles"]).success();
    assert!(words.contains("does not separate in these coordinates"), "{words}");
}

/// What separates for one value of a parameter only is said to do so.
#[test]
fn a_special_value_of_a_parameter_is_distinguishable() {
    let file = "title = \"T\"\n[coordinates]\nx = { initial = 1, momentum = 0 }\n\
                y = { initial = 1, momentum = 0 }\n[parameters]\nc = 0\n\
                [hamiltonian]\nH = \"p_x^2/2 + p_y^2/2 + x^4 + y^4 + c*x*y\"\n";
    let object = with_file(file, &["derive", "system.toml", "--format", "json"]).json();
    assert_eq!(object["separates"], true);
    assert_eq!(object["separation"]["for_all_parameters"], false);
}

#[test]
fn another_lagrangian_is_compared() {
    let other = "1/2*m*theta'^2 + m*cos(theta) + 2*theta*theta'";
    let command = ["derive", "system.toml", "--against", other, "--format", "json"];
    let object = with_file(PENDULUM, &command).json();
    assert_eq!(object["against"]["total_derivative"], true, "{object}");
    assert_eq!(text(&object["against"]["of"]), "-theta^2");
    let words = with_file(PENDULUM, &["derive", "system.toml", "--against", "theta^2"]).success();
    assert!(words.contains("not a total derivative"), "{words}");
    let itself = phaselab(&["derive", "pendulum", "--against", "pendulum"]).success();
    assert!(itself.contains("the same equations of motion"), "{itself}");
}
