//! What is conserved, what is not, and what is unknown: by proof, in any units, and wherever a
//! force is hidden.

use phaselab::diagnostic::Document;
use phaselab::mechanics::{self, Class, Equations, Reason};
use phaselab::model::Model;

fn derived(text: &str) -> (Model, Equations) {
    let document = Document::new("system.toml", text);
    let model = match document.read() {
        Ok(checked) => checked.model,
        Err(diagnostics) => panic!("{text}\n{diagnostics:?}"),
    };
    let equations = mechanics::derive(&model).expect("derivable");
    (model, equations)
}

/// A file with coordinates from these starts, the rest as written, and one observable.
fn file(starts: &str, rest: &str, observable: &str) -> String {
    format!(
        "title = \"T\"\n[coordinates]\n{starts}\n{rest}\n\
         [[observables]]\nname = \"G\"\nexpression = \"{observable}\"\n"
    )
}

fn class(starts: &str, rest: &str, observable: &str) -> Class {
    let (model, mut equations) = derived(&file(starts, rest, observable));
    let classed = mechanics::classes(&model, &mut equations).pop().expect("one observable");
    let listed = equations.conserved.iter().find(|c| c.name == "G");
    if let Some(listed) = listed {
        assert!(classed.class.is_conserved(), "{rest}: listed by {}", listed.reason);
    }
    classed.class
}

const LINE: &str = "x = { initial = 0.0, velocity = 1.0 }";
const PLANE: &str = "x = { initial = 1.0, velocity = 0.1 }\ny = { initial = 0.2, velocity = 0.9 }";
const SPACE: &str = "x = { initial = 1.0, velocity = 0.1 }\ny = { initial = 0.2, velocity = 0.9 }\n\
                     z = { initial = 0.3, velocity = 0.2 }";

fn l(law: &str) -> String {
    format!("[lagrangian]\nL = \"{law}\"")
}

/// The dual of a cyclic coordinate: where p_y is absent from H, y is constant, whatever acts on its momentum.
#[test]
fn a_coordinate_whose_momentum_is_absent_from_h_is_constant() {
    let starts = "x = { initial = 1.0, momentum = 0.3 }\ny = { initial = 0.2, momentum = 0.9 }";
    let listed = |hamiltonian: &str| -> Vec<(String, String)> {
        let rest = format!("[hamiltonian]\n{hamiltonian}");
        let (_, equations) = derived(&file(starts, &rest, "x"));
        equations.conserved.iter().map(|c| (c.name.clone(), c.reason.to_string())).collect()
    };
    let known = |all: &[(String, String)], name: &str| {
        all.iter().find(|(of, _)| of == name).map(|(_, reason)| reason.clone())
    };
    for law in [
        "H = \"1/2*p_x^2 + x*y\"",
        "H = \"1/2*p_x^2 + 1/2*y^2*x^2\"",
        "H = \"1/2*p_x^2*y + x^4\"\nforces = { y = \"1\" }",
    ] {
        let all = listed(law);
        assert_eq!(known(&all, "y").as_deref(), Some("∂H/∂p_y = 0"), "{law} {all:?}");
        assert_eq!(known(&all, "x"), None, "{law} {all:?}");
    }
    for law in ["H = \"1/2*p_x^2 + p_y*exp(-(x - 50)^2)\"", "H = \"1/2*(p_x^2 + p_y^2)\""] {
        let all = listed(law);
        assert_eq!(known(&all, "y"), None, "{law} {all:?}");
    }
}

/// A force that acts nowhere near the start, is small beside others, or is in units in which everything
/// is small.
#[test]
fn what_changes_is_never_called_conserved() {
    for (starts, rest, observable) in [
        (LINE, l("1/2*x'^2 - 0.7*exp(-10*(x-6)^2)"), "p_x"),
        (LINE, l("1/2*x'^2 - 50*max(0, abs(x) - 3)^2"), "p_x"),
        (LINE, l("1/2*x'^2 - 1/2*x^2 + x*max(0, t-3)"), "energy"),
        (LINE, l("1/2*x'^2 - 1/2*x^2 + x*max(0, t-4000)"), "energy"),
        (LINE, l("1/2*x'^2 - max(0, x - 100)^2"), "x'"),
        (LINE, l("1/2*x'^2 - max(0, x - 1e7)^3"), "x'"),
        (LINE, l("1/2*x'^2 - tanh(20*(x - 50))"), "p_x"),
        (LINE, l("1/2*x'^2 - 1/(1 + exp(x - 60))"), "p_x"),
        (LINE, l("1/2*x'^2 - 1/cosh(5*(x - 20))^2"), "p_x"),
        (LINE, l("1/2*x'^2 - exp(-20*(x-3)^2) - exp(-20*(x-4)^2) - exp(-20*(x-5)^2)"), "p_x"),
        (LINE, l("1/2*x'^2 - 1/2*x^2 + x*exp(-(t - 40)^2)"), "energy"),
        (LINE, l("1/2*x'^2 - x^40"), "p_x"),
        (LINE, l("1/2*x'^2 - (x/50)^200"), "p_x"),
        (LINE, l("1/2*x'^2 - 1e-40*x"), "p_x"),
        (LINE, l("1/2*x'^2 - 1/2*x^2 + 1e-40*x*t"), "energy"),
        (LINE, l("1/2*x'^2 - sqrt((x - 9)^2 + 1e-12)"), "p_x"),
        (LINE, l("1/2*x'^2 - (1 + cos(x - 3))^40/2^40"), "p_x"),
        (LINE, format!("{}\ndissipation = \"1/2*1e-9*x'^2\"", l("1/2*x'^2 - 1/2*x^2")), "energy"),
        (LINE, format!("{}\ndissipation = \"1/2*1e-60*x'^2\"", l("1/2*x'^2 - 1/2*x^2")), "energy"),
        (PLANE, l("1/2*(x'^2 + y'^2) - exp(-(x-30)^2 - (y-40)^2)"), "x*p_y - y*p_x"),
        (PLANE, l("1/2*(x'^2 + y'^2) - 1/2*x^2 - 1/2*(1 + 1e-15)*y^2"), "x*p_y - y*p_x"),
        (
            "x = { initial = 1e-10, velocity = 0.0 }",
            format!(
                "{}\ndissipation = \"1/2*2e-15*x'^2\"",
                l("1/2*9.109e-31*x'^2 - 1/2*1.6e-15*x^2")
            ),
            "energy",
        ),
        (
            "x = { initial = 1e20, velocity = 1e5 }",
            format!("{}\ndissipation = \"1/2*1e20*x'^2\"", l("1/2*2e42*x'^2 - 1/2*1.6e12*x^2")),
            "energy",
        ),
        (
            "x = { initial = \"6e-9\" }\ny = { initial = \"8e-9\", velocity = 0.0 }",
            "[parameters]\nm = 1.0e-26\nq = 1e-12\nb = 1e-8\n\
             [lagrangian]\nL = \"1/2*m*(x'^2+y'^2) - q*x\"\n\
             [[constraints]]\nname = \"rod\"\nexpression = \"x^2+y^2-b^2\"\n\
             [[constraints]]\nname = \"rod2\"\nexpression = \"(x^2+y^2)/b^2-1\""
                .to_owned(),
            "1/2*m*(x'^2+y'^2)",
        ),
    ] {
        assert_eq!(class(starts, &rest, observable), Class::Changing, "{observable}: {rest}");
    }
}

/// A kink whose other side was never evaluated is no evidence, and neither is a root without real
/// values.
#[test]
fn what_nobody_saw_is_not_known() {
    let narrow = l("1/2*x'^2 - 1e-3*max(0, 1e-30 - abs(x - 5.123456))");
    let reported = class(LINE, &narrow, "x'");
    assert!(matches!(reported, Class::Unknown | Class::Changing), "{reported}");
    // a step: its force is an impulse, which no derivative shows
    let step = l("1/2*x'^2 - (1 + sign(x - 77))");
    assert_eq!(class(LINE, &step, "x'"), Class::Unknown);
    let (_, equations) = derived(&file(LINE, &step, "x"));
    assert!(equations.conserved.is_empty(), "{:?}", equations.conserved);
    assert_eq!(class(LINE, &l("1/2*x'^2"), "sign(x)"), Class::Unknown);
    let nowhere = l("1/2*x'^2 + sqrt(-1 - x^2)");
    assert_eq!(class(LINE, &nowhere, "x'"), Class::Unknown);
}

/// u sign(c u) has a kink and no step, whatever the factor c; u sign(c u − 1) has a step.
#[test]
fn a_sign_beside_its_argument_is_no_step() {
    for kink in ["x*sign(1e-5*x)", "3e-7*x*sign(x/0.3)", "(2*x - 1)*sign(x - 0.5)", "x^2*sign(-x)"]
    {
        let law = l(&format!("1/2*x'^2 - {kink}"));
        let (_, equations) = derived(&file(LINE, &law, "x"));
        assert_eq!(equations.conserved.len(), 1, "{kink}");
    }
    // a unit by which both are divided
    let units = "[parameters]\nu = 3.0\n".to_owned() + &l("1/2*x'^2 - x/u*sign(x/u)");
    assert_eq!(derived(&file(LINE, &units, "x")).1.conserved.len(), 1);
    // numbers that are rounded where the product is multiplied out
    let rounded = l(
        "5e-10*(x'^2 + y'^2) - 1.1000000000000001e-8*(x/1e14 + 3.62e-15*y)*sign(x/1e14 + 3.62e-15*y)",
    );
    assert_eq!(derived(&file(PLANE, &rounded, "x")).1.conserved.len(), 1);
    let both = l("1/2*(x'^2 + y'^2) - 2*x*y*sign(3*x*y)");
    assert_eq!(derived(&file(PLANE, &both, "x")).1.conserved.len(), 1);
    for kink in [
        "x^2/abs(x)",
        "abs(x - 3)^3/(x - 3)",
        "x/abs(x - 3)*(x - 3)^2",
        "x*atan(1/x)",
        "atan(1/(x^2 + 1))",
        "atan(1/x^2)",
        "tanh(1000*x)",
    ] {
        let law = l(&format!("1/2*x'^2 - {kink}"));
        assert_eq!(derived(&file(LINE, &law, "x")).1.conserved.len(), 1, "{kink}");
    }
    for step in [
        "x*sign(2*x - 1)",
        "sign(2*x)/x",
        "(x - 1)*sign(x + 1)",
        "x/abs(x)",
        "3*(2*x - 6)/abs(x - 3)",
        "x^3/abs(x)^3",
        "x/sqrt(x^2)",
        "atan(1/x)",
        "tanh(1/(x - 3))",
        "atan(1/(1000*x))",
        "1/(1 + exp(1/x))",
        "atan(tan(x))",
        "x*atan(2/(x - 1))",
    ] {
        let law = l(&format!("1/2*x'^2 - {step}"));
        let (_, equations) = derived(&file(LINE, &law, "x"));
        assert!(equations.conserved.is_empty(), "{step}");
    }
    // a root or a maximum over what it was made of
    for step in [
        "sqrt(x^2)/x",
        "(x^2)^0.5/x",
        "(x^4)^0.25/x",
        "(x^2)^1.5/x^3",
        "sqrt((x - 3)^2)/(x - 3)",
        "sqrt(sin(x)^2)/sin(x)",
        "x*sqrt(1/x^2)",
        "sqrt(x^2*(1 + x^2))/(x*sqrt(1 + x^2))",
        "sqrt(x^2 + x^4)/x",
        "(abs(x) + x)/(2*x)",
        "max(x, 0)/x",
        "(x - 2)*max(0, x - 2)/(x - 2)^2",
        "exp(ln(x^2)/2)/x",
        "atan2(x, 0)",
        "atan2(0, x)",
        "(x^2)^(1/3)/abs(x)^(5/3)*x",
    ] {
        let law = l(&format!("1/2*x'^2 - 0.1*{step}"));
        let (_, equations) = derived(&file(LINE, &law, "x"));
        assert!(equations.conserved.is_empty(), "{step}: {:?}", equations.conserved);
    }
    for kink in [
        "sqrt(x^2)*x",
        "x^2/sqrt(x^2)",
        "sqrt(x^4)/x",
        "max(x, 0)^2/x",
        "abs(x)^1.5/x",
        "sqrt(x^2*(1 + x^2))/sqrt(1 + x^2)",
        "(sqrt((x - 1)^2) - 1)^2/sqrt((x - 1)^2 + 1)",
        "exp(ln(x^2)/2)",
        "abs(sin(x))^3/sin(x)",
    ] {
        let law = l(&format!("1/2*x'^2 - 0.1*{kink}"));
        let (_, equations) = derived(&file(LINE, &law, "x"));
        assert_eq!(equations.conserved.len(), 1, "{kink}");
    }
    // however small it is beside the other terms, and however far away
    for step in ["sqrt(x^2)/x", "x/sqrt(x^2)", "max(x, 0)/x", "x/abs(x)", "atan(1/x)"] {
        let far = step.replace('x', "(x - 1e6)").replace("ma(x - 1e6)", "max");
        for (factor, step) in [("1e-8", step), ("1e-20", step), ("0.1", &far)] {
            let law = l(&format!("1/2*(x'^2 + y'^2) - 1/2*x^2 - {factor}*{step}"));
            let (_, equations) = derived(&file(PLANE, &law, "x"));
            let wrong = equations.conserved.iter().find(|c| c.name != "p_y");
            assert!(wrong.is_none(), "{factor}*{step}: {wrong:?}");
        }
    }
    let plane = l("1/2*(x'^2 + y'^2) - sqrt(x^2)/x*y");
    assert!(derived(&file(PLANE, &plane, "x")).1.conserved.is_empty());
    let in_time = l("1/2*x'^2 - x*(cos(t)^2)^0.5/cos(t)");
    assert!(derived(&file(LINE, &in_time, "x")).1.conserved.is_empty());
    // negative: a quotient also changes its sign where what it is divided by does
    let quotient = l("1/2*(x'^2 + y'^2) - x*sign(x/y)");
    assert!(derived(&file(PLANE, &quotient, "x")).1.conserved.is_empty());
    let one = l("1/2*(x'^2 + y'^2) - x*sign(x*y)");
    assert!(derived(&file(PLANE, &one, "x")).1.conserved.is_empty());
}

/// Constants of the motion in unusual forms: all of them are proved.
#[test]
fn what_is_conserved_is_proved() {
    let kepler = l("1/2*(x'^2 + y'^2) + 1/sqrt(x^2 + y^2)");
    let si =
        l("1/2*5.972e24*(x'^2 + y'^2 + z'^2) + 6.6743e-11*1.98847e30*5.972e24/sqrt(x^2+y^2+z^2)");
    let integrable = l("1/2*(x'^2 + y'^2) - 1/2*(3*x^2 + 5*y^2) - x^2*y - 2*y^3");
    let sixteen = l("1/2*(x'^2 + y'^2) - 1/2*(x^2 + 16*y^2) - x^2*y - 16/3*y^3");
    let relativistic = l("-sqrt(1 - x'^2 - y'^2) + 0.2*x + 0.9*(x*y' - y*x')/2");
    let toda =
        "[hamiltonian]\nH = \"1/2*(p_x^2 + p_y^2 + p_z^2) + exp(x-y) + exp(y-z) + exp(z-x)\"";
    let damped = format!("{}\ndissipation = \"1/2*0.3*x'^2\"", l("1/2*x'^2"));
    let rod = "[lagrangian]\nL = \"1/2*(x'^2 + y'^2)\"\n\
               [[constraints]]\nname = \"rod\"\nexpression = \"x^2 + y^2 - 1.04\"";
    let bowl = "[lagrangian]\nL = \"1/2*(x'^2 + y'^2 + z'^2) - z\"\n\
                [[constraints]]\nname = \"bowl\"\nexpression = \"z - x^2 - y^2\"";
    let momentum = "x = { initial = 0.3, momentum = 0.1 }\ny = { initial = 0.1, momentum = 0.2 }\n\
                    z = { initial = 0.0, momentum = -0.3 }";
    let held = "x = { initial = 1.0 }\ny = { initial = 0.2, velocity = 0.9 }";
    let sliding = "x = { initial = 1.0, velocity = 0.1 }\ny = { initial = 0.0, velocity = 0.9 }\n\
                   z = { initial = 1.0 }";
    let cases: &[(&str, &str, &str)] = &[
        (PLANE, kepler.as_str(), "y'*(x*y' - y*x') - x/sqrt(x^2 + y^2)"),
        (
            PLANE,
            &kepler,
            "(y'*(x*y' - y*x') - x/sqrt(x^2 + y^2))^2 + (-x'*(x*y' - y*x') - y/sqrt(x^2 + y^2))^2",
        ),
        (
            SPACE,
            &si,
            "y'*(x*y' - y*x') - z'*(z*x' - x*z') - 6.6743e-11*1.98847e30*x/sqrt(x^2+y^2+z^2)",
        ),
        (PLANE, &integrable, "x^4 + 4*x^2*y^2 - 4*x'*(x'*y - y'*x) + 12*x^2*y + 7*(x'^2 + 3*x^2)"),
        (
            PLANE,
            &sixteen,
            "3*x'^4 + 6*(1 + 2*y)*x^2*x'^2 - 4*x^3*x'*y' - 4*x^4*(y + y^2) + 3*x^4 - 2/3*x^6",
        ),
        (PLANE, &relativistic, "p_y + 0.9*x/2"),
        (PLANE, &relativistic, "p_x - 0.9*y/2 - 0.2*t"),
        (PLANE, &relativistic, "y'/sqrt(1 - x'^2 - y'^2) + 0.9*x"),
        (momentum, toda, "p_x*p_y*p_z - p_x*exp(y-z) - p_y*exp(z-x) - p_z*exp(x-y)"),
        (LINE, &l("1/2*x'^2 - 9.81*x"), "x - x'*t - 1/2*9.81*t^2"),
        (LINE, &l("1/2*x'^2 - abs(x)"), "(1/2*x'^2 + abs(x))^3"),
        (LINE, &l("1/2*x'^2 - max(0, x - 3)^2"), "(1/2*x'^2 + max(0, x - 3)^2)^2"),
        (LINE, &l("1/2*x'^2 - sqrt(x^2)"), "(1/2*x'^2 + abs(x))^2"),
        (LINE, &l("exp(0.3*t)*1/2*x'^2"), "x'*exp(0.3*t)"),
        (LINE, &damped, "p_x + 0.3*x"),
        (LINE, &damped, "x'*exp(0.3*t)"),
        (held, rod, "x^2 + y^2"),
        (held, rod, "x'^2 + y'^2"),
        (sliding, bowl, "x*y' - y*x'"),
        (sliding, bowl, "z - x^2 - y^2"),
        (sliding, bowl, "1/2*(x'^2 + y'^2) + 2*(x*x' + y*y')^2 + x^2 + y^2"),
    ];
    for &(starts, rest, observable) in cases {
        assert_eq!(class(starts, rest, observable), Class::Proved, "{observable}: {rest}");
    }
}

/// A quantity conserved only at the file's parameter values is reported as such.
#[test]
fn a_symmetry_of_the_numbers_is_told_from_one_of_the_law() {
    let springs = |stiffness: f64| {
        format!(
            "[parameters]\nk1 = 2.5\nk2 = {stiffness:?}\n[lagrangian]\n\
             L = \"1/2*(x'^2 + y'^2) - 1/2*k1*x^2 - 1/2*k2*y^2\""
        )
    };
    let l_z = "x*p_y - y*p_x";
    assert_eq!(class(PLANE, &springs(2.5), l_z), Class::AtTheseParameters);
    assert_eq!(class(PLANE, &springs(2.6), l_z), Class::Changing);
}

fn reason(text: &str, name: &str) -> Reason {
    let (_, equations) = derived(text);
    let found = equations.conserved.iter().find(|c| c.name == name);
    found.unwrap_or_else(|| panic!("{name} is not conserved in {text}")).reason.clone()
}

/// A reason names what was proved: the bracket only if the motion is Hamilton's, ∂L/∂t = 0 only
/// if nothing drives or dissipates, a translation only for lengths.
#[test]
fn reasons_are_true() {
    let damped = format!("{}\ndissipation = \"1/2*0.3*x'^2\"", l("1/2*x'^2"));
    assert_eq!(reason(&file(LINE, &damped, "p_x + 0.3*x"), "G"), Reason::Proved);
    assert_eq!(Reason::Proved.to_string(), "dG/dt = 0, proved");
    let free = file(LINE, &l("1/2*x'^2 - 9.81*x"), "x - x'*t - 1/2*9.81*t^2");
    assert_eq!(reason(&free, "G"), Reason::Commutes);
    let rod = "[lagrangian]\nL = \"1/2*(x'^2 + y'^2)\"\n\
               [[constraints]]\nname = \"rod\"\nexpression = \"x^2 + y^2 - 1.04\"";
    let held = "x = { initial = 1.0 }\ny = { initial = 0.2, velocity = 0.9 }";
    assert_eq!(reason(&file(held, rod, "x^2 + y^2"), "G"), Reason::ProvedOnConstraints);
    assert_eq!(reason(&file(held, rod, "x*p_y - y*p_x"), "G"), Reason::Rotation('z'));
    let balanced = format!("{}\nforces = {{ x = \"-sin(t)\" }}", l("1/2*x'^2 + x*sin(t)"));
    assert_eq!(reason(&file(LINE, &balanced, "x"), "p_x"), Reason::Proved);
    let angles = |unit: &str| {
        let start = format!("{{ unit = \"{unit}\", initial = 0.1 }}");
        file(
            &format!("phi1 = {start}\nphi2 = {start}"),
            &l("1/2*phi1'^2 + 1/2*phi2'^2 - (phi1 - phi2)^2"),
            "phi1",
        )
    };
    let name = "total p_phi";
    assert_eq!(reason(&angles("rad"), name), Reason::CommonRotation("φ₁, φ₂".to_owned()));
    assert_eq!(reason(&angles("m"), name), Reason::Translation("φ₁, φ₂".to_owned()));
}

/// With a constraint that may be released, only what is conserved under any force of it is conserved.
#[test]
fn what_a_constraint_conserves_ends_with_it() {
    let released = |observable: &str| {
        let rest = "[lagrangian]\nL = \"1/2*(x'^2 + y'^2) - 1/2*(x^2 + y^2)\"\n\
                    [[constraints]]\nname = \"rod\"\nexpression = \"x^2 + y^2 - 1.04\"\n\
                    [[events]]\nname = \"snap\"\nwhen = \"x - 0.5\"\naction = \"release:rod\"";
        let held = "x = { initial = 1.0 }\ny = { initial = 0.2, velocity = 0.9 }";
        let (_, equations) = derived(&file(held, rest, observable));
        equations.conserved.iter().any(|c| c.name == "G" && !c.reason.is_declared())
    };
    assert!(!released("x^2 + y^2"));
    assert!(released("x*p_y - y*p_x + 1"));
}

/// The size of a law is computed before the law is expanded.
#[test]
fn a_law_too_large_is_refused_before_it_is_expanded() {
    let mut rest = String::from("[definitions]\na0 = \"x + 1\"\n");
    for i in 1..200 {
        let last = i - 1;
        rest += &format!("a{i} = \"sin(a{last}*x)*cos(a{last} + x) + a{last}^2\"\n");
    }
    rest += "[lagrangian]\nL = \"1/2*x'^2 - a199\"";
    let document = Document::new("system.toml", file(LINE, &rest, "x"));
    let model = document.read().expect("it can be read").model;
    let before = model.pool.reachable(&[model.mechanics.function().1]).len();
    let why = mechanics::derive(&model).expect_err("it is too large");
    assert!(why.to_string().contains("1000000 nodes"), "{why}");
    assert!(before < 2000, "the text itself is small: {before}");
}

/// New variables of a map without a closed form change as its relations do: where p = P + ⅒ sin P, P is conserved if p is, and
/// is not if p is not; Q moves.
#[test]
fn new_variables_without_a_closed_form_are_judged_by_their_relations() {
    let by = |law: &str, start: &str, function: &str, observable: &str| {
        let rest = format!(
            "{law}\n[[transformations]]\nname = \"map\"\nkind = \"F2\"\nF = \"{function}\""
        );
        class(&format!("q = {{ initial = 0.3, {start} }}"), &rest, observable)
    };
    let stretched = "q*(P + 1/10*sin(P))";
    let wave = "q*P + 1/10*sin(q)*cos(P)*(1 + t)";
    // p = √(2 h(P) − q²) with h = P + ⅒ sin P: h(P) is the energy of the oscillator
    let root = "sqrt(2*(P + 1/10*sin(P)) - q^2)";
    let action = format!("1/2*q*{root} + (P + 1/10*sin(P))*asin(q/sqrt(2*(P + 1/10*sin(P))))");
    for (law, start) in [("hamiltonian", "momentum"), ("lagrangian", "velocity")] {
        let [free, bound] = if law == "hamiltonian" {
            ["H = \"p_q^2/2\"", "H = \"p_q^2/2 + q^2/2\""]
        } else {
            ["L = \"q'^2/2\"", "L = \"q'^2/2 - q^2/2\""]
        };
        let [free, bound] = [free, bound].map(|written| format!("[{law}]\n{written}"));
        let start = format!("{start} = 0.9");
        let class =
            |law: &str, function: &str, observable: &str| by(law, &start, function, observable);
        assert_eq!(class(&free, stretched, "P"), Class::Proved, "{free}");
        assert_eq!(class(&free, stretched, "P^2 + cos(P)"), Class::Proved, "{free}");
        assert_eq!(class(&free, stretched, "Q"), Class::Changing, "{free}");
        assert_eq!(class(&bound, stretched, "P"), Class::Changing, "{bound}");
        assert_eq!(class(&free, wave, "P"), Class::Changing, "{free}");
        assert_eq!(class(&bound, wave, "Q"), Class::Changing, "{bound}");
        assert_ne!(class(&bound, &action, "P"), Class::Changing, "{bound}");
        assert_eq!(class(&bound, &action, "Q"), Class::Changing, "{bound}");
    }
}
