//! Questions typed by the user: brackets and conserved quantities, compared with textbooks.

use phaselab::analysis::{Inquiry, InquiryAnswer};
use phaselab::expr::{Symbol, Zero};
use phaselab::mechanics::{Class, Equations, derive};
use phaselab::model::Model;
use phaselab::preset;

use crate::build::sample;

const PLANE: &str = "title = 'a test'\n[coordinates]\nx = { initial = 1.0 }\ny = { initial = 0.0, velocity = 1.0 }\n\
    [parameters]\nm = 2.0\nk = 1.0\n";

fn system(law: &str) -> (Model, Equations) {
    let text = format!("{PLANE}{law}");
    let model = preset::read(&text).unwrap_or_else(|diagnostics| panic!("{diagnostics:?}")).model;
    let equations = derive(&model).unwrap();
    (model, equations)
}

fn kepler() -> (Model, Equations) {
    system("[lagrangian]\nL = \"m/2*(x'^2 + y'^2) + k/sqrt(x^2 + y^2)\"\n")
}

fn ask((model, equations): &(Model, Equations), text: &str) -> Inquiry {
    Inquiry::of(model, equations, text, equations.pool.cancel())
        .unwrap_or_else(|diagnostic| panic!("{text}: {diagnostic:?}"))
}

#[test]
fn brackets_are_found_and_whether_they_vanish() {
    let system = kepler();
    for (text, wanted, vanishes) in [
        ("x, p_x", "1", Zero::No),
        ("[x, p_x]", "1", Zero::No),
        (" { p_x , x } ", "-1", Zero::No),
        ("x, y", "0", Zero::Proved),
        ("x*p_y - y*p_x, H", "0", Zero::Proved),
        ("x*p_y - y*p_x, energy", "0", Zero::Proved),
        ("x*y' - y*x', x", "y/m", Zero::No),
        ("p_x, x*p_y - y*p_x", "-p_y", Zero::No),
        ("atan2(y, x), x*p_y - y*p_x", "1", Zero::No),
    ] {
        let inquiry = ask(&system, text);
        let InquiryAnswer::Bracket { bracket: Ok(e), .. } = &inquiry.answer else {
            panic!("{text}")
        };
        assert_eq!(inquiry.written(*e, false), wanted, "{text}");
        assert_eq!(inquiry.answer.vanishes(), vanishes, "{text}");
    }
}

#[test]
fn one_expression_alone_asks_whether_it_is_conserved() {
    let class = |system: &(Model, Equations), text: &str| match ask(system, text).answer {
        InquiryAnswer::Conservation { class, .. } => class,
        InquiryAnswer::Bracket { .. } => panic!("{text} is one expression"),
    };
    let free = kepler();
    assert_eq!(class(&free, "H"), Class::Proved);
    assert_eq!(class(&free, "x*p_y - y*p_x"), Class::Proved);
    assert_eq!(class(&free, "p_y*(x*p_y - y*p_x) - m*k*x/sqrt(x^2 + y^2)"), Class::Proved);
    assert_eq!(class(&free, "p_x"), Class::Changing);
    // dx/dt = p_x/m
    let inquiry = ask(&free, "x");
    let names = |s: Symbol| free.1.pool.symbol_info(s).name.clone();
    let at = |s: Symbol| sample(1)(s);
    let symbol = |name: &str| free.1.pool.find_symbol(name).unwrap();
    let velocity = at(symbol("x'"));
    let momentum = at(symbol("p_x")) / at(symbol("m"));
    let value = inquiry.value(&at).unwrap();
    assert!([velocity, momentum].contains(&value), "{value} {}", names(symbol("x'")));
    // friction dissipates the energy, though [H, H] = 0
    let slowed = system("[lagrangian]\nL = \"m/2*(x'^2 + y'^2)\"\ndissipation = \"k/2*x'^2\"\n");
    assert_eq!(class(&slowed, "H"), Class::Changing);
    assert_eq!(class(&slowed, "p_y"), Class::Proved);
    assert_eq!(ask(&slowed, "H, H").answer.vanishes(), Zero::Proved);
    // a constraint can conserve a quantity whose bracket with H does not vanish
    let held = system(
        "[lagrangian]\nL = \"m/2*(x'^2 + y'^2) - k*y\"\n[[constraints]]\nname = 'rod'\n\
         expression = 'x^2 + y^2 - 1'\n",
    );
    assert!(class(&held, "x*x' + y*y'").is_conserved());
    assert_eq!(class(&held, "y"), Class::Changing);
    assert_eq!(ask(&held, "x*p_x + y*p_y, H").answer.vanishes(), Zero::No);
}

#[test]
fn an_error_is_reported_at_its_place_in_the_whole_text() {
    let (model, equations) = kepler();
    for (text, place, says) in [
        ("x*p_y - y*p_z, H", "p_z", "p_z"),
        ("x, 2*lenght", "lenght", "lenght"),
        ("[x, y +]", "", "too early"),
        ("x, y, p_x", " p_x", "third"),
        ("x, ", "", "missing"),
        ("x 2", "x 2", "comes after"),
    ] {
        let Err(diagnostic) = Inquiry::of(&model, &equations, text, equations.pool.cancel()) else {
            panic!("{text} is read")
        };
        assert!(diagnostic.span.start <= text.len(), "{text}: {diagnostic:?}");
        if !place.is_empty() {
            assert_eq!(&text[diagnostic.span.start..diagnostic.span.end], place, "{text}");
        }
        assert!(diagnostic.message.contains(says), "{text}: {diagnostic:?}");
    }
}

/// In the new variables of a map the same bracket, at any time.
#[test]
fn a_bracket_is_answered_in_the_new_variables_too() {
    let text = include_str!("../../../presets/canonical/moving-axes.toml");
    let model = preset::read(text).unwrap_or_else(|diagnostics| panic!("{diagnostics:?}")).model;
    let equations = derive(&model).unwrap();
    let inquiry = ask(&(model, equations), "X, p_x");
    let InquiryAnswer::Bracket { charts, .. } = &inquiry.answer else { panic!("a bracket") };
    let reported: Vec<(String, String)> = charts
        .iter()
        .map(|chart| {
            let bracket = chart.bracket.as_ref().expect("a closed form");
            (inquiry.variables(chart, false), inquiry.written(*bracket, false))
        })
        .collect();
    let expected = [("X, Y, P_X, P_Y", "cos(Omega*t)"), ("x1, x2, p1, p2", "cos(Omega*t)")];
    assert_eq!(reported, expected.map(|(a, b)| (a.to_owned(), b.to_owned())));
}
