//! The tables beside the law: what they may say, and what the model then holds.

use phaselab::expr::{Expr, Rank};
use phaselab::model::{Action, Allowed, Direction, Model, Scope, multiplier_name};

use super::good::{checked, model, text, with};

/// A hoop on an incline, with a constraint between.
const HOOP: &str = r#"title = "Hoop"

[coordinates]
x = { initial = 0.0 }
theta = { initial = 0.0, velocity = 0.0 }

[parameters]
m = 1.0
r = 0.5
g = 9.81

[lagrangian]
L = "1/2*m*x'^2 + 1/2*m*r^2*theta'^2 + m*g*x"

[[constraints]]
name = "no slip"
expression = "r*theta' - x'"
unit = "N"
about = "friction"
"#;

/// The constraint of a file about x and y.
fn bound(expression: &str) -> (Model, Expr) {
    let text = format!(
        r#"title = "bound"
[coordinates]
x = {{ initial = 1.0 }}
y = {{ initial = 1.0 }}
[parameters]
a = 1.0
[lagrangian]
L = "a*(x'^2 + y'^2)"
[[constraints]]
name = "c"
expression = "{expression}"
"#
    );
    let model = model(&text);
    let e = model.constraints[0].expression;
    (model, e)
}

#[test]
fn a_constraint_is_kept_as_written_with_its_multiplier() {
    let hoop = model(HOOP);
    let constraint = hoop.constraints[0].clone();
    assert_eq!(text(&hoop, constraint.expression), "r*theta' - x'");
    assert_eq!((constraint.name.as_str(), constraint.unit.as_str()), ("no slip", "N"));
    assert_eq!(constraint.about, "friction");
    assert_eq!(&HOOP[constraint.place.clone()], "\"r*theta' - x'\"");
    let lambda = hoop.pool.symbol_info(constraint.multiplier);
    assert_eq!((lambda.name.as_str(), lambda.unicode.as_str()), ("lambda_no_slip", "λ"));
    assert_eq!(lambda.rank, Rank::Momentum);
    assert!(!hoop.coordinates[0].rate_given && hoop.coordinates[1].rate_given);
    let watched =
        model(&format!("{HOOP}[[observables]]\nname = \"F\"\nexpression = \"-lambda_no_slip\"\n"));
    assert_eq!(text(&watched, watched.observables[0].expression), "-lambda_no_slip");
}

#[test]
fn names_are_mangled_letter_by_letter() {
    assert_eq!(multiplier_name("no slip, left"), "lambda_no_slip__left");
    assert_eq!(multiplier_name("Boden über 2"), "lambda_Boden__ber_2");
}

#[test]
fn what_is_linear_once_simplified_is_a_constraint() {
    let check = |written: &str, expected: &str| {
        let (mut model, e) = bound(written);
        let mut scope = Scope::new(&model, Allowed::Observable, "this");
        let expected = scope.read(&mut model.pool, expected).unwrap();
        assert!(e == expected, "{written} became {}", text(&model, e));
    };
    check("x^2 + y^2 - 2*a", "x^2 + y^2 - 2*a");
    check("x*y' - sin(y)*x' + t", "x*y' - sin(y)*x' + t");
    check("(x' + 1)^2 - x'^2 - 2*x' - 1 + a*y'", "a*y'");
    // the velocities cancel by an identity: what is left holds at the level of positions
    check("(sin(x)^2 + cos(x)^2 - 1)*x'^2 + a*x - y", "a*x - y");
    check("abs(x) - y", "abs(x) - y");
    // real nowhere near the points at which zeros are looked for
    check("sqrt(x - 1e6)*x' - y'", "sqrt(x - 1000000)*x' - y'");
}

/// A parameter `lambda_rod` is reserved only where there is such a constraint.
#[test]
fn lambda_is_a_name_like_others_without_constraints() {
    let text = with(
        "[definitions]\nlambda_0 = \"m\"\n[[observables]]\nname = \"o\"\nexpression = \"lambda_0\"",
    );
    assert!(model(&text).definitions[0].0 == "lambda_0");
}

#[test]
fn blows_strike_at_times_at_intervals_or_by_hand() {
    let text_of = with(
        r#"
[[impulses]]
name = "blow"
at = [2.0, "3*m"]
change = { p_x = "k*x' + t" }
about = "a hammer"
[[impulses]]
name = "once"
at = 1
change = { p_x = 1 }
[[impulses]]
name = "kick"
every = "2*m"
change = { p_x = "-x" }
[[impulses]]
name = "by hand"
change = { p_x = "k" }
"#,
    );
    let model = model(&text_of);
    let written: Vec<(&str, Vec<String>, Option<String>, String)> = model
        .impulses
        .iter()
        .map(|i| {
            let times = i.times.iter().map(|&e| text(&model, e)).collect();
            let period = i.period.map(|e| text(&model, e));
            (i.name.as_str(), times, period, text(&model, i.change[0]))
        })
        .collect();
    let (blow, kick) = (vec!["2".to_owned(), "3*m".to_owned()], Some("2*m".to_owned()));
    assert_eq!(
        written,
        [
            ("blow", blow, None, "k*x' + t".to_owned()),
            ("once", vec!["1".to_owned()], None, "1".to_owned()),
            ("kick", vec![], kick, "-x".to_owned()),
            ("by hand", vec![], None, "k".to_owned()),
        ]
    );
    assert_eq!(model.impulses[0].about, "a hammer");
}

#[test]
fn an_event_watches_and_acts() {
    let file = format!(
        r#"{HOOP}
[[impulses]]
name = "blow"
change = {{ p_x = 1 }}
[[observables]]
name = "height"
expression = "m*x"
[[events]]
name = "floor"
when = "height - x''"
[[events]]
name = "lift-off"
when = "lambda_no_slip"
direction = "falling"
action = "release:no slip"
[[events]]
name = "wall"
when = "p_x - energy"
direction = "rising"
action = "impulse: blow"
[[events]]
name = "end"
when = "t - 3"
direction = "either"
action = "stop"
"#
    );
    let model = model(&file);
    let acts: Vec<_> =
        model.events.iter().map(|e| (e.name.as_str(), e.direction, e.action)).collect();
    assert_eq!(
        acts,
        [
            ("floor", Direction::Either, Action::Mark),
            ("lift-off", Direction::Falling, Action::Release(0)),
            ("wall", Direction::Rising, Action::Impulse(0)),
            ("end", Direction::Either, Action::Stop),
        ]
    );
    assert_eq!(text(&model, model.events[0].when), "m*x - x''");
    assert_eq!(&file[model.events[1].place.clone()], "\"lambda_no_slip\"");
}

/// A blow before the start is allowed, and probably not meant.
#[test]
fn a_blow_before_the_start_is_a_warning() {
    let file = with("[[impulses]]\nname = \"b\"\nat = [-1]\nchange = { p_x = 1 }");
    let warnings = checked(&file).warnings;
    assert_eq!(warnings.len(), 1);
    assert_eq!(warnings[0].message, "this is before the start, t = 0; it does not strike");
}
