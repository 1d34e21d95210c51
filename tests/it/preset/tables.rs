//! The tables other than the law: their contents, and the resulting model.

use phaselab::expr::{Expr, Rank};
use phaselab::model::{
    Allowed, AttitudeSource, BodyNames, Coordinate, Direction, EventAction, Mechanics, Model,
    PieceOrientation, Scope, Shape, Solid, multiplier_name,
};

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
    // the velocities cancel by an identity: what remains is a constraint on positions
    check("(sin(x)^2 + cos(x)^2 - 1)*x'^2 + a*x - y", "a*x - y");
    check("abs(x) - y", "abs(x) - y");
    // real nowhere near the sample points of the zero test
    check("sqrt(x - 1e6)*x' - y'", "sqrt(x - 1000000)*x' - y'");
}

/// A parameter `lambda_rod` is reserved only if there is such a constraint.
#[test]
fn lambda_is_a_name_like_others_without_constraints() {
    let text = with(
        "[definitions]\nlambda_0 = \"m\"\n[[observables]]\nname = \"o\"\nexpression = \"lambda_0\"",
    );
    assert!(model(&text).definitions[0].0 == "lambda_0");
}

#[test]
fn impulses_act_at_times_at_intervals_or_by_hand() {
    let text_of = with(
        r#"
[[impulses]]
name = "impulse"
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
    let (impulse, kick) = (vec!["2".to_owned(), "3*m".to_owned()], Some("2*m".to_owned()));
    assert_eq!(
        written,
        [
            ("impulse", impulse, None, "k*x' + t".to_owned()),
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
name = "impulse"
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
action = "impulse: impulse"
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
            ("floor", Direction::Either, EventAction::Mark),
            ("lift-off", Direction::Falling, EventAction::Release(0)),
            ("wall", Direction::Rising, EventAction::Impulse(0)),
            ("end", Direction::Either, EventAction::Stop),
        ]
    );
    assert_eq!(text(&model, model.events[0].when), "m*x - x''");
    assert_eq!(&file[model.events[1].place.clone().expect("a place")], "\"lambda_no_slip\"");
}

/// An impulse at the start or before it is allowed, but probably an error.
#[test]
fn an_impulse_that_is_not_after_the_start_is_a_warning() {
    for (at, place) in [("-1", "before the start"), ("0", "the start itself")] {
        let file =
            with(&format!("[[impulses]]\nname = \"b\"\nat = [{at}]\nchange = {{ p_x = 1 }}"));
        let warnings = checked(&file).warnings;
        assert_eq!(warnings.len(), 1);
        assert_eq!(warnings[0].message, format!("this is {place}, t = 0; it does not act"));
    }
    let file = with("[[impulses]]\nname = \"b\"\nat = [0.5]\nchange = { p_x = 1 }");
    assert!(checked(&file).warnings.is_empty());
}

/// What is negative nowhere, or positive nowhere, crosses zero nowhere.
#[test]
fn an_event_that_only_touches_zero_is_a_warning() {
    let warned = |when: &str| {
        let file = with(&format!("[[events]]\nname = \"e\"\nwhen = \"{when}\""));
        let warnings = checked(&file).warnings;
        warnings.iter().any(|one| one.message.contains("never changes sign"))
    };
    for when in ["abs(x - 2)", "(x - 2)^2", "x^2 - 4*x + 4", "-abs(x)", "sqrt(x^2)", "x^2 + 1"] {
        assert!(warned(when), "{when}");
    }
    // zero on one side of a kink, and of one sign on the other
    for when in [
        "abs(x) - x",
        "abs(x - 2) + x - 2",
        "abs(4 - 2*x) - 2*x + 4",
        "max(x, t) - t",
        "x - sqrt(x^2)",
        "x^3 - abs(x)^3",
        "max(x, 0) - min(x, 0)",
        "x*abs(x) - x^2",
    ] {
        assert!(warned(when), "{when}");
    }
    for when in [
        "x - 2",
        "x^3",
        "abs(x) - 2",
        "x^2 - 1",
        "x*abs(x)",
        "sin(t)",
        "abs(x) - x - 1e-9",
        "abs(x) - 2*x",
        "abs(x - 2) - x",
        "max(x, t) - x + min(x, 0)",
        "x^3 + abs(x)^3 + x",
    ] {
        assert!(!warned(when), "{when}");
    }
}

/// A free rigid body.
const BODY: &str = r#"title = "Body"

[variables]
L1 = { symbol = "L₁", unit = "J s", initial = "k" }
L2 = 0.01
L3 = "2*k"

[parameters]
I1 = 1.0
I2 = 2.0
I3 = 3.0
k = 0.5

[definitions]
w1 = "L1/I1"

[poisson]
H = "L1*w1/2 + L2^2/(2*I2) + L3^2/(2*I3)"
brackets = [["L1", "L2", "-L3"], ["L3", "L2", "L1"], ["L3", "L1", "-L2"], ["L2", "L2", "0"]]
casimirs = { "|L|²" = "L1^2 + L2^2 + L3^2", C = "k*(L1^2 + L2^2 + L3^2)" }
forces = { L2 = "-t*L2" }

[[observables]]
name = "rate"
expression = "L1' + L1'' + C"

[expect]
conserves = ["energy", "|L|²", "C", "L1^2 + L2^2 + L3^2"]

[[impulses]]
name = "impulse"
change = { L1 = "L2 + t" }
"#;

#[test]
fn brackets_become_an_antisymmetric_matrix() {
    let body = model(BODY);
    assert!(body.is_poisson() && body.moving() == 3);
    let Mechanics::Poisson { brackets, casimirs, forces, place, .. } = &body.mechanics else {
        panic!("{:?}", body.mechanics)
    };
    let written: Vec<Vec<String>> =
        brackets.iter().map(|row| row.iter().map(|&e| text(&body, e)).collect()).collect();
    assert_eq!(written, [["0", "-L3", "L2"], ["L3", "0", "-L1"], ["-L2", "L1", "0"]]);
    assert!(BODY[place.clone()].starts_with("[[\"L1\", \"L2\", \"-L3\"]"));
    assert_eq!(casimirs[0].0, "|L|²");
    assert_eq!(&BODY[casimirs[1].2.clone()], "\"k*(L1^2 + L2^2 + L3^2)\"");
    assert_eq!(forces.iter().map(|&e| text(&body, e)).collect::<Vec<_>>(), ["0", "-t*L2", "0"]);
    let starts: Vec<String> = body.coordinates.iter().map(|c| text(&body, c.initial)).collect();
    assert_eq!(starts, ["k", "1/100", "2*k"]);
    assert_eq!(
        (body.coordinates[0].shown.as_str(), body.coordinates[0].unit.as_str()),
        ("L₁", "J s")
    );
    let mut scope = Scope::new(&body, Allowed::Observable, "this");
    let mut pool = body.pool.clone();
    let rate = scope.read(&mut pool, "L1' + L1'' + k*(L1^2 + L2^2 + L3^2)").unwrap();
    assert!(body.observables[0].expression == rate);
    assert_eq!(body.expect.conserves[1].1, casimirs[0].1);
    assert_eq!(text(&body, body.impulses[0].change[0]), "L2 + t");
}

/// Variables may have the names of momenta, since canonical brackets are brackets too.
#[test]
fn a_variable_may_be_called_as_a_momentum() {
    let plane = model(
        r#"title = "canonical"
[variables]
x = 1.0
p_x = 0.5
[poisson]
H = "p_x^2/2 + x^2/2"
brackets = [["x", "p_x", "1"]]
"#,
    );
    let [x, p] = [0, 1].map(|i| plane.coordinates[i].clone());
    assert_ne!(x.momentum, p.position);
    let (_, h) = plane.mechanics.function();
    assert!(plane.pool.depends(h, p.position) && !plane.pool.depends(h, x.momentum));
}

#[test]
fn a_coordinate_may_be_given_by_its_initial_value_alone() {
    let start = |x: &str, y: &str| {
        let file = model(&format!(
            "title = \"t\"\n[coordinates]\nx = {x}\ny = {y}\n[parameters]\nk = 3.0\n\
             [lagrangian]\nL = \"1/2*(x'^2 + y'^2) - 1/2*k*(x^2 + y^2)\"\n"
        ));
        let values = |coordinate: &Coordinate| {
            (text(&file, coordinate.initial), text(&file, coordinate.initial_rate))
        };
        file.coordinates.iter().map(values).collect::<Vec<_>>()
    };
    let short = start("0.5", "\"k/2\"");
    assert_eq!(short, start("{ initial = 0.5 }", "{ initial = \"k/2\", velocity = 0 }"));
    assert_eq!(short[0].0, "1/2");
    assert_ne!(short, start("0.5", "\"k\""));
}

/// A rotating hammer: a head and a handle.
const HAMMER: &str = r#"title = "Hammer"

[coordinates]
phi = { initial = 0.0, velocity = "body_mass" }
theta = { initial = "I1/I3", velocity = 0.0, period = "I2" }

[parameters]
m = 1.0
a = 0.5

[definitions]
T = "Izz*phi'^2/2 + I1*theta'^2/2"
quarter = "pi/2"
edge = "a/2"

[lagrangian]
L = "T - body_mass*body_z*cos(theta)"

[body]
pieces = [
  { solid = "cylinder", mass = "m", radius = "a/10", length = "a", at = ["0", "0", "-a/2"] },
  { solid = "cuboid", mass = "3*m", size = ["a", "edge", "edge"],
    turned = { axis = ["1", "0", 0], angle = "quarter" } },
  { solid = "shell", mass = 0, radius = 0, turned = { euler = ["0", "0", "a"] } },
  { point = true, mass = "-m/10", at = ["a", "0", "0"] },
]

[attitude]
euler = ["phi", "theta", "a*t"]

[[observables]]
name = "tilt"
expression = "acos(A33) + Ixy"

[[events]]
name = "level"
when = "A33 - I1"
"#;

#[test]
fn a_body_is_read_with_the_names_it_defines() {
    let hammer = model(HAMMER);
    let body = hammer.body.as_ref().unwrap();
    let Solid::Cylinder { radius, length } = body.pieces[0].solid else { panic!("{body:?}") };
    assert_eq!((text(&hammer, radius), text(&hammer, length)), ("1/10*a".into(), "a".into()));
    assert_eq!(body.pieces[0].at.map(|e| text(&hammer, e)), ["0", "0", "-1/2*a"]);
    assert!(matches!(body.pieces[0].turn, PieceOrientation::None));
    let Solid::Cuboid(edges) = body.pieces[1].solid else { panic!("{body:?}") };
    assert_eq!(edges.map(|e| text(&hammer, e)), ["a", "1/2*a", "1/2*a"]);
    let PieceOrientation::Axis { axis, angle } = body.pieces[1].turn else { panic!("{body:?}") };
    assert_eq!(axis.map(|e| text(&hammer, e)), ["1", "0", "0"]);
    assert_eq!(text(&hammer, angle), "1/2*pi");
    assert!(matches!(body.pieces[2].solid, Solid::SphericalShell(_)));
    assert!(matches!(body.pieces[2].turn, PieceOrientation::Euler(_)));
    assert!(matches!(body.pieces[3].solid, Solid::Point));
    assert!(HAMMER[body.pieces[3].place.clone()].starts_with("{ point = true"));
    let start = hammer.coordinates[1].initial;
    let symbols = hammer.pool.symbols_of(start);
    assert!(symbols.contains(&body.names.principal[0]), "{symbols:?}");
    assert_eq!(hammer.coordinates[1].period.map(|e| text(&hammer, e)).as_deref(), Some("I2"));
    let names: Vec<String> =
        body.names.all().into_iter().map(|s| hammer.pool.symbol_info(s).name.clone()).collect();
    assert_eq!(names, BodyNames::WRITTEN);
}

#[test]
fn an_attitude_has_angles_or_a_rate() {
    let hammer = model(HAMMER);
    let attitude = hammer.attitude.as_ref().unwrap();
    let AttitudeSource::Euler(angles) = attitude.source else { panic!("{attitude:?}") };
    assert_eq!(angles.map(|e| text(&hammer, e)), ["phi", "theta", "a*t"]);
    let last = hammer.pool.symbol_info(attitude.matrix[2][2]);
    assert_eq!((last.name.as_str(), last.unicode.as_str()), ("A33", "A₃₃"));
    let file = format!("{BODY}[attitude]\nomega = [\"L1/I1\", \"L2/I2\", \"L3/I3\"]\n");
    let body = model(&file);
    let AttitudeSource::Rate { omega, start } = body.attitude.as_ref().unwrap().source else {
        panic!("{:?}", body.attitude)
    };
    assert_eq!(omega.map(|e| text(&body, e)), ["L1/I1", "L2/I2", "L3/I3"]);
    assert_eq!(start, [Expr::ZERO; 3]);
    let file = format!("{file}start = [\"0\", \"k\", 1]\n");
    let body = model(&file);
    let AttitudeSource::Rate { start, .. } = body.attitude.as_ref().unwrap().source else {
        panic!("{:?}", body.attitude)
    };
    assert_eq!(start.map(|e| text(&body, e)), ["0", "k", "1"]);
}

#[test]
fn a_comparison_has_names_for_the_other_motion() {
    let file = format!(
        "{HOOP}\n[comparison]\neliminate = [\"x\"]\n\
         [[observables]]\nname = \"apart\"\nexpression = \"other_x - x + other_theta'\"\n"
    );
    let hoop = model(&file);
    let comparison = hoop.comparison.as_ref().unwrap();
    assert_eq!(comparison.eliminate, [0]);
    let written: Vec<(&str, &str)> = comparison
        .symbols
        .iter()
        .map(|&(x, v)| {
            (hoop.pool.symbol_info(x).name.as_str(), hoop.pool.symbol_info(v).name.as_str())
        })
        .collect();
    assert_eq!(written, [("other_x", "other_x'"), ("other_theta", "other_theta'")]);
    let symbols = hoop.pool.symbols_of(hoop.observables[0].expression);
    assert!(
        symbols.contains(&comparison.symbols[0].0) && symbols.contains(&comparison.symbols[1].1)
    );
}

#[test]
fn a_picture_may_be_seen_from_a_frame() {
    let file = format!(
        r#"{HAMMER}
[[frames]]
name = "table"
angle = "phi + a*t"
[[frames]]
name = "tilted"
axis = ["0", "a", "1"]
angle = "2*t"
origin = ["t", "sin(theta)", "0"]
particles = [ {{ at = ["cos(phi)", "0", "t"], mass = "m" }} ]
[[frames]]
name = "body"
attitude = true
origin = ["0", "0", "1"]
[[views]]
kind = "space"
title = "from the table"
frame = "tilted"
shapes = [ {{ body = ["0", "0", "A33"] }}, {{ trace = ["A31", "A32", "A33"] }} ]
[[views]]
kind = "space"
[space]
shapes = [ {{ body = ["0", "0"] }} ]
"#
    );
    let hammer = model(&file);
    let of = |point: [Expr; 3]| point.map(|e| text(&hammer, e));
    let [table, tilted, body] = &hammer.frames[..] else { panic!("{:?}", hammer.frames) };
    assert_eq!((table.name.as_str(), text(&hammer, table.angle)), ("table", "phi + a*t".into()));
    assert_eq!((of(table.axis), of(table.origin)), (of(body.axis), of([Expr::ZERO; 3])));
    assert_eq!(of(table.axis), ["0", "0", "1"]);
    assert_eq!(of(tilted.axis), ["0", "a", "1"]);
    assert_eq!(of(tilted.origin), ["t", "sin(theta)", "0"]);
    let (at, mass) = tilted.particles[0];
    assert_eq!(
        (of(at), text(&hammer, mass)),
        (["cos(phi)", "0", "t"].map(String::from), "m".into())
    );
    assert!(body.attitude && !table.attitude && !tilted.attitude);
    let [seen, plain] = &hammer.views[..] else { panic!("{:?}", hammer.views) };
    assert_eq!((seen.title.as_str(), seen.frame), ("from the table", Some(1)));
    let Some([Shape::Body { at }, Shape::Trace { .. }]) = seen.shapes.as_deref() else {
        panic!("{:?}", seen.shapes)
    };
    assert_eq!(of(*at), ["0", "0", "A33"]);
    assert!(plain.frame.is_none() && plain.shapes.is_none());
    assert!(matches!(hammer.picture.shapes[..], [Shape::Body { .. }]));
}

#[test]
fn a_file_expects_events_counts_and_brackets() {
    let file = with(
        r#"
[[impulses]]
name = "kick"
change = { p_x = 1 }
[[events]]
name = "lift-off"
when = "x"
[expect]
events = [ { name = "lift-off", at = 0.5, within = 1e-6, source = "book" },
           { name = "kick", nth = 3, at = 2 } ]
count = [ { name = "lift-off", until = 4.0, is = 15, source = "§ 3" } ]
brackets = [ { f = "x ", g = "x'*m", is = "1", source = "3.2.3" }, { f = "energy", g = "t", is = 0 } ]
"#,
    );
    let model = model(&file);
    let [first, second] = &model.expect.events[..] else { panic!("{:?}", model.expect) };
    assert_eq!((first.name.as_str(), first.nth, first.at), ("lift-off", 1, 0.5));
    assert_eq!((first.within, first.source.as_str()), (Some(1e-6), "book"));
    assert_eq!(&file[first.place.clone()], "0.5");
    assert_eq!(
        (second.name.as_str(), second.nth, second.at, second.within),
        ("kick", 3, 2.0, None)
    );
    let count = &model.expect.counts[0];
    assert_eq!((count.name.as_str(), count.until, count.is), ("lift-off", 4.0, 15));
    assert_eq!(&file[count.place.clone()], "15");
    let bracket = &model.expect.brackets[0];
    assert_eq!((bracket.written.as_str(), bracket.source.as_str()), ("[x, x'*m]", "3.2.3"));
    assert_eq!((text(&model, bracket.f), text(&model, bracket.is)), ("x".into(), "1".into()));
    assert_eq!(text(&model, bracket.g), "m*x'");
    assert_eq!(&file[bracket.place.clone()], "\"1\"");
}

/// A name that is used only in one of the new tables counts as used.
#[test]
fn names_used_in_new_tables_only_are_used() {
    let used = r#"title = "used"
[coordinates]
x = { initial = 1 }
y = { initial = 0 }
[parameters]
a = 1
b = 1
c = 1
d = 1
e = 1
f = 1
g = 1
h = 1
[definitions]
circle = "x^2 + y^2 - a"
[lagrangian]
L = "x'^2 + y'^2"
[[constraints]]
name = "circle"
expression = "circle"
[[impulses]]
name = "kick"
every = "b"
change = { p_x = "c" }
[[events]]
name = "turn"
when = "x - d/4"
[body]
pieces = [ { point = true, mass = "e" } ]
[attitude]
euler = [0, 0, "f*t"]
[[frames]]
name = "table"
angle = "g*t"
[expect]
brackets = [ { f = "h*x", g = "p_x", is = "h" } ]
"#;
    assert!(checked(used).warnings.is_empty(), "{:?}", checked(used).warnings);
    let unused = used.replace("\"h*x\"", "\"x\"").replace("is = \"h\"", "is = 1");
    let warnings = checked(&unused).warnings;
    assert_eq!(warnings.len(), 1);
    assert_eq!(warnings[0].message, "the parameter `h` is not used");
}
