//! What must never be called constant: quantities that an impulse, a released constraint, friction, a force, a kink or a
//! parameter's value makes false. Each of these files is refused with a sentence, or has the word.

use phaselab::integrability::{Limits, Proof, invariants, point_symmetries, symmetries};
use phaselab::mechanics;

use super::model;

/// A file of two coordinates, an addition to it, and an observable.
fn file(law: &str, more: &str, observable: &str) -> String {
    format!(
        "title = \"test\"\n[coordinates]\nx = {{ initial = 1.0, velocity = 0.5 }}\n\
         y = {{ initial = 1.0, velocity = 0.5 }}\n{law}\n{more}\n\
         [[observables]]\nname = \"G\"\nexpression = \"{observable}\"\n"
    )
}

fn lagrangian(l: &str) -> String {
    format!("[lagrangian]\nL = \"{l}\"")
}

/// The reason by which G is called conserved.
fn reason(text: &str) -> Option<String> {
    let equations = mechanics::derive(&model(text)).expect("derivable");
    let found = equations.conserved.iter().find(|c| c.name == "G");
    found.map(|c| c.reason.to_string())
}

#[track_caller]
fn is_not_called_conserved(text: &str) {
    assert_eq!(reason(text), None, "{text}");
}

#[track_caller]
fn only_between_impulses(text: &str) {
    let reason = reason(text).unwrap_or_else(|| panic!("{text}"));
    assert!(reason.ends_with("between impulses"), "{reason}: {text}");
}

const FREE: &str = "1/2*x'^2 + 1/2*y'^2";
const TAP: &str = "[[impulses]]\nname = \"tap\"\nat = [1.0]\nchange = { p_x = \"1\" }";

#[test]
fn an_impulse_on_one_momentum_changes_the_velocities_that_it_is_coupled_to() {
    let coupled = lagrangian("1/2*x'^2 + 1/2*y'^2 + 1/2*x'*y'");
    only_between_impulses(&file(&coupled, TAP, "y'"));
    only_between_impulses(&file(&coupled, TAP, "energy"));
    let free = lagrangian(FREE);
    only_between_impulses(&file(&free, TAP, "x'"));
    only_between_impulses(&file(&free, TAP, "x*y' - y*x'"));
    // and what it leaves alone it leaves alone
    for (law, unchanged) in [(&free, "y'"), (&coupled, "p_y"), (&coupled, "p_y^2")] {
        let reason = reason(&file(law, TAP, unchanged)).expect("conserved");
        assert!(!reason.contains("impulses"), "{unchanged}: {reason}");
    }
}

#[test]
fn under_constraints_an_impulse_changes_all_velocities() {
    let bound = format!("[[constraints]]\nname = \"rod\"\nexpression = \"x - y\"\n{TAP}");
    only_between_impulses(&file(&lagrangian(FREE), &bound, "y'"));
    only_between_impulses(&file(&lagrangian(FREE), &bound, "x' + y'"));
}

#[test]
fn an_impulse_on_a_momentum_of_a_hamiltonian_changes_coupled_velocities() {
    let text = "title = \"test\"\n[coordinates]\nx = { initial = 1.0, momentum = 0.5 }\n\
                y = { initial = 1.0, momentum = 0.5 }\n[hamiltonian]\n\
                H = \"1/2*p_x^2 + 1/2*p_y^2 + 1/2*p_x*p_y\"\n";
    let observable = "[[observables]]\nname = \"G\"\nexpression = \"y'\"\n";
    only_between_impulses(&format!("{text}{TAP}\n{observable}"));
}

/// x/√(x²) is a sign: its rate is zero wherever it has one.
#[test]
fn a_sign_in_disguise_is_not_conserved() {
    let cases = [
        ("sqrt(x^2)", "x/sqrt(x^2)"),
        ("sqrt((x - y)^2)", "(x - y)/sqrt((x - y)^2)"),
        ("sqrt((x - 1000)^2)", "(x - 1000)/sqrt((x - 1000)^2)"),
        ("abs(x)", "x/abs(x)"),
        ("x^2", "x/max(x, -x)"),
        ("x^2", "x/(x^2)^(1/2)"),
        ("x^2", "atan(x) + atan(1/x)"),
        ("x^2", "sign(x)"),
        ("x^2", "abs(x - y)/(x - y)"),
    ];
    for (potential, observable) in cases {
        is_not_called_conserved(&file(
            &lagrangian(&format!("{FREE} - {potential}")),
            "",
            observable,
        ));
    }
    // what has no kink there, and what has one and no step, is conserved
    for (potential, observable) in [
        ("1/sqrt(x^2 + y^2)", "1/2*x'^2 + 1/2*y'^2 + 1/sqrt(x^2 + y^2)"),
        ("sqrt(x^2)", "1/2*x'^2 + 1/2*y'^2 + sqrt(x^2)"),
        ("1/(1 + abs(x))", "1/2*x'^2 + 1/2*y'^2 + 1/(1 + abs(x))"),
    ] {
        let text = file(&lagrangian(&format!("{FREE} - {potential}")), "", observable);
        assert!(reason(&text).is_some(), "{observable}");
    }
}

/// A root that has no kink in the plane may have one where a constraint holds, and then a quotient by it is a sign.
#[test]
fn a_sign_in_disguise_on_the_constraints_is_not_conserved() {
    let on = |constraint: &str, velocities: [f64; 2], observable: &str| {
        let constraint = format!("[[constraints]]\nname = \"c\"\nexpression = \"{constraint}\"");
        file(&lagrangian(FREE), &constraint, observable)
            .replacen("velocity = 0.5", &format!("velocity = {:?}", velocities[0]), 1)
            .replacen("velocity = 0.5", &format!("velocity = {:?}", velocities[1]), 1)
    };
    let cases = [
        ("y", [0.5, 0.0], "x/sqrt(x^2 + y^2)"),
        ("y", [0.5, 0.0], "sqrt(x^2 + y^2)/x"),
        ("y", [0.5, 0.0], "x/sqrt(x^2 + 3*y^2 + y^4)"),
        ("y", [0.5, 0.0], "x*(x^2 + y^2)^(-1/2)"),
        ("y", [0.5, 0.0], "atan(x) + atan(1/x)"),
        ("y", [0.5, 0.0], "exp(1/2*ln(x^2 + y^2))/x"),
        ("y - 1", [0.5, 0.0], "x/sqrt(x^2 + (y - 1)^2)"),
        ("x - y", [0.5, 0.5], "x/sqrt(x^2 + y^2)"),
        ("x - y", [0.5, 0.5], "x/sqrt(x*y)"),
        ("y - x^2", [0.5, 1.0], "x/sqrt(y)"),
        ("y - x^2", [0.5, 1.0], "sqrt(y)/x"),
        ("x^2 + y^2 - 2", [0.5, -0.5], "x/sqrt(2 - y^2)"),
        ("x^2 + y^2 - 2", [0.5, -0.5], "sqrt(2 - y^2)/x"),
        ("sin(y - 1)", [0.5, 0.0], "x/sqrt(x^2 + (y - 1)^2)"),
    ];
    for (constraint, velocities, observable) in cases {
        let text = on(constraint, velocities, observable);
        let text = if constraint == "y" {
            text.replace("y = { initial = 1.0", "y = { initial = 0.0")
        } else {
            text
        };
        is_not_called_conserved(&text);
        // what a person asks is not answered otherwise
        let model = model(&text);
        let mut equations = mechanics::derive(&model).expect("derivable");
        let class = mechanics::classes(&model, &mut equations).remove(0).class;
        assert!(!class.is_conserved(), "{observable} on {constraint}: {class}");
    }
    let falling =
        on("y' - x'", [0.5, 0.5], "x'/sqrt(x'^2 + y'^2)").replace(FREE, "1/2*x'^2 + 1/2*y'^2 - x");
    is_not_called_conserved(&falling);
    // what has no such place is conserved
    for (constraint, velocities, observable) in [
        ("x^2 + y^2 - 2", [0.5, -0.5], "(x*y' - y*x')/sqrt(x^2 + y^2)"),
        ("x^2 + y^2 - 2", [0.5, -0.5], "sqrt(x^2 + y^2)"),
        ("x - y", [0.5, 0.5], "x'/sqrt(1 + (x - y)^2)"),
        ("y - x^2", [0.5, 1.0], "1/sqrt(1 + x'^2 + y'^2)"),
    ] {
        let text = on(constraint, velocities, observable);
        assert!(reason(&text).is_some(), "{observable} on {constraint}");
    }
}

/// Steps in other disguises, without constraints.
#[test]
fn a_step_in_disguise_is_not_conserved() {
    for observable in ["exp(1/2*ln(x^2))/x", "atan(tan(x)) - x", "atan(cot(x)) + x"] {
        is_not_called_conserved(&file(&lagrangian(FREE), "", observable));
    }
}

#[test]
fn a_root_with_a_kink_on_the_constraints_is_not_searched_through() {
    let text = |constraint: &str| {
        let constraint = format!("[[constraints]]\nname = \"c\"\nexpression = \"{constraint}\"");
        let law = lagrangian(&format!("{FREE} - sqrt(x^2 + (y - 1)^2)"));
        file(&law, &constraint, "x")
            .replace("y = { initial = 1.0, velocity = 0.5", "y = { initial = 1.0, velocity = 0.0")
    };
    let search = |text: &str| {
        let model = model(text);
        let mut equations = mechanics::derive(&model).expect("derivable");
        invariants(&model, &mut equations, &Limits { degree: Some(1), is_over: &|| false })
    };
    let refused = search(&text("y - 1")).expect_err("a kink");
    assert!(refused.to_string().contains("on the constraints"), "{refused}");
    let plain = text("y - 1").replace("- sqrt(x^2 + (y - 1)^2)", "- x^2");
    search(&plain).expect("it can be searched");
}

#[test]
fn roots_with_kinks_are_not_searched_through() {
    let potentials = [
        "sqrt(x^2)",
        "sqrt((x - y)^2)",
        "sqrt((x - 30)^2)",
        "sqrt(x^2 - 60*x + 900)",
        "sqrt(x^2*(1 + y^2))",
        "(x^2)^(3/2)",
        "(x^2)^(1/3)",
        "sqrt(1 - cos(x))",
        "sqrt(1 - cos(x)^2)",
        "abs(x)",
        "max(0, x - 30)^2",
        "sign(x - 30)",
        "acos(cos(x))",
        "atan2(y, x)",
    ];
    for potential in potentials {
        let model = model(&file(&lagrangian(&format!("{FREE} - {potential}")), "", "x"));
        let mut equations = mechanics::derive(&model).expect("derivable");
        let limits = Limits { degree: Some(1), is_over: &|| false };
        let refused = invariants(&model, &mut equations, &limits).expect_err(potential);
        assert!(refused.to_string().starts_with("no search is made through"), "{refused}");
        symmetries(&model, &mut equations, &|| false).expect_err(potential);
    }
    for potential in ["sqrt(x^2 + y^2)", "1/sqrt((x - 1)^2 + y^2)", "sqrt(1 + x^2)"] {
        let model = model(&file(&lagrangian(&format!("{FREE} - {potential}")), "", "x"));
        let mut equations = mechanics::derive(&model).expect("derivable");
        let limits = Limits { degree: Some(1), is_over: &|| false };
        invariants(&model, &mut equations, &limits).expect(potential);
    }
}

/// A ramp is no formula that an ansatz could be made for; it is named, and not the functions that it is written with. One that
/// the law does not contain changes nothing.
#[test]
fn a_law_with_a_ramp_is_refused_by_the_name_of_its_parameter() {
    let ramp = "[parameters]\nomega = { value = 1.0, symbol = \"ω\" }\n[[ramps]]\nparameter = \"omega\"\nto = 2\nstart = 1\n\
                duration = 5\n";
    for (potential, refused) in [("omega^2*x^2/2", true), ("x^2/2", false)] {
        let text = file(&lagrangian(&format!("{FREE} - {potential}")), ramp, "omega*x");
        let model = model(&text);
        let mut equations = mechanics::derive(&model).expect("derivable");
        let limits = Limits { degree: Some(1), is_over: &|| false };
        let answers = [
            invariants(&model, &mut equations, &limits).err(),
            symmetries(&model, &mut equations, &|| false).err(),
            point_symmetries(&model, &mut equations, None, &|| false).err(),
        ];
        for answer in answers {
            let why = answer.map(|why| why.to_string());
            let said = "no search is made of a law in which a ramp changes ω";
            assert_eq!(why.as_deref(), refused.then_some(said));
        }
    }
}

#[test]
fn friction_forces_time_and_coordinates_make_momenta_and_energies_move() {
    let with = |l: &str, more: &str| file(&format!("{}\n{more}", lagrangian(l)), "", "x");
    let cases: [(String, &[&str]); 20] = [
        (with(FREE, "dissipation = \"0.1*x'^2\""), &["p_x", "energy"]),
        (with(FREE, "dissipation = \"1e-14*x'^2\""), &["p_x", "energy"]),
        (with("1/2*9.1e-31*x'^2 + 1/2*y'^2", "dissipation = \"1e-45*x'^2\""), &["p_x", "energy"]),
        (with(FREE, "dissipation = \"1/3*abs(x')^3\""), &["p_x", "energy"]),
        (with(FREE, "forces = { x = \"sin(t)\" }"), &["p_x", "energy"]),
        (with(FREE, "forces = { x = \"max(0, t - 50)\" }"), &["p_x", "energy"]),
        (with(FREE, "forces = { x = \"max(0, x - 40)\" }"), &["p_x", "energy"]),
        (with(FREE, "forces = { x = \"exp(-(t - 80)^2)\" }"), &["p_x", "energy"]),
        (with(FREE, "forces = { x = \"y'\", y = \"-x'\" }"), &["p_x", "p_y"]),
        (with("1/2*x'^2 + 1/2*y'^2 - max(0, x - 30)^2", ""), &["p_x"]),
        (with("1/2*x'^2 + 1/2*y'^2 - exp(-(x - 40)^2)", ""), &["p_x"]),
        (with("1/2*x'^2 + 1/2*y'^2 - sign(x - 30)", ""), &["p_x", "energy"]),
        (with("1/2*x^3*x'^2 + 1/2*y'^2", ""), &["p_x"]),
        (with("1/2*(1 + x^2)*x'^2 + 1/2*y'^2", ""), &["p_x"]),
        (with("1/2*exp(0.1*t)*x'^2 + 1/2*y'^2", ""), &["energy"]),
        (with("1/2*x'^2 + 1/2*y'^2 - 1e-13*t*x", ""), &["p_x", "energy"]),
        (with("1/2*x'^2 + 1/2*y'^2 - 1/2*(1 + exp(-(t - 80)^2))*x^2", ""), &["energy"]),
        (with("1/2*x'^2 + 1/2*y'^2 - atan2(y, x)", ""), &["p_x", "p_y", "L_z"]),
        (with("1/2*x'^2 + 1/2*y'^2 - 1/2*x^2 - 0.500000001*y^2", ""), &["L_z"]),
        (with("1/2*x'^2 + 1/2*y'^2 - x*y", ""), &["p_x", "p_y", "L_z"]),
    ];
    for (text, moving) in cases {
        let equations = mechanics::derive(&model(&text)).expect("derivable");
        let called: Vec<&str> = equations.conserved.iter().map(|c| c.name.as_str()).collect();
        assert!(!called.iter().any(|name| moving.contains(name)), "{called:?}: {text}");
    }
}

/// A parameter that happens to be zero, or equal to another, makes constants that hold at its value only.
#[test]
fn what_holds_at_these_parameters_is_said_to() {
    let cases = [
        ("k = 0.0", "1/2*x'^2 + 1/2*y'^2 - k*x", "p_x"),
        ("e = 0.0", "1/2*x'^2 + 1/2*y'^2 + e*x*y'^2", "p_x"),
        ("a = 1.0\nb = 1.0", "1/2*x'^2 + 1/2*y'^2 - 1/2*a*x^2 - 1/2*b*y^2", "p_x*y - x*p_y"),
    ];
    for (parameters, l, constant) in cases {
        let law = format!("[parameters]\n{parameters}\n{}", lagrangian(l));
        let model = model(&file(&law, "", "x"));
        let mut equations = mechanics::derive(&model).expect("derivable");
        assert!(equations.conserved.iter().all(|c| c.name != "p_x" && c.name != "L_z"));
        let limits = Limits { degree: Some(2), is_over: &|| false };
        let found = invariants(&model, &mut equations, &limits).expect("it can be searched").found;
        let one = found.iter().find(|c| equations.pool.text(c.expression) == constant);
        let one = one.unwrap_or_else(|| panic!("{constant} is not found for {l}"));
        assert_eq!(one.proof, Proof::AtTheseParameters, "{l}");
    }
}

#[test]
fn what_a_constraint_keeps_is_lost_with_it() {
    let circle = "[[constraints]]\nname = \"c\"\nexpression = \"x^2 + y^2 - 2\"\n";
    let release = "[[events]]\nname = \"go\"\nwhen = \"t - 3\"\naction = \"release:c\"\n";
    let text = |more: &str, observable: &str| {
        file(&lagrangian(FREE), more, observable).replacen("velocity = 0.5", "velocity = -0.5", 1)
    };
    assert!(reason(&text(circle, "x^2 + y^2")).is_some());
    is_not_called_conserved(&text(&format!("{circle}{release}"), "x^2 + y^2"));
    // angular momentum is kept by the constraint's force, and without it
    assert!(reason(&text(&format!("{circle}{release}"), "x*y' - y*x'")).is_some());
    let moving = circle.replace("- 2", "- 2 - sin(t)^3");
    let equations = mechanics::derive(&model(&text(&moving, "x"))).expect("derivable");
    assert!(equations.conserved.iter().all(|c| c.name != "energy"));
}

/// u sign(u) is |u|: a law with it has no step, and conserves what it conserves.
#[test]
fn a_sign_that_is_no_step_keeps_the_energy() {
    let conserved = |l: &str| {
        let equations =
            mechanics::derive(&model(&file(&lagrangian(l), "", "x"))).expect("derivable");
        equations.conserved.iter().any(|c| c.name == "energy")
    };
    assert!(conserved("1/2*x'^2 + 1/2*y'^2 - 0.163*x*sign(x)"));
    assert!(conserved("1/2*x'^2 + 1/2*y'^2 - 0.934*(y + 0.939*x)*sign(y + 0.939*x)"));
    assert!(!conserved("1/2*x'^2 + 1/2*y'^2 - sign(x)"));
    assert!(!conserved("1/2*x'^2 + 1/2*y'^2 - y*sign(x)"));
    assert!(!conserved("1/2*x'^2 + 1/2*y'^2 - sign(x)/x"));
    assert!(!conserved("1/2*x'^2 + 1/2*y'^2 - x*sign(x) - exp(sign(x))"));
}
