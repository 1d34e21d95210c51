//! The possible contents of a file, and the resulting model.

use std::collections::BTreeSet;
use std::f64::consts::PI;

use phaselab::diagnostic::report;
use phaselab::expr::Expr;
use phaselab::instrument::CameraPose;
use phaselab::model::{Mechanics, Model, RangeSpacing, Shape};
use phaselab::num::Number;
use phaselab::preset::{Catalog, Checked, PresetOrigin, read};

use super::GOOD;

/// Reads a text without errors, or fails with its report.
pub(super) fn checked(text: &str) -> Checked {
    match read(text) {
        Ok(checked) => checked,
        Err(diagnostics) => panic!("{}", report(text, "test.toml", &diagnostics, false)),
    }
}

/// Reads a text without errors or warnings.
pub(super) fn model(text: &str) -> Model {
    let Checked { model, warnings, .. } = checked(text);
    assert!(warnings.is_empty(), "{}", report(text, "test.toml", &warnings, false));
    model
}

/// A file about one free coordinate with more tables below.
pub(super) fn with(more: &str) -> String {
    format!("{GOOD}\n{more}")
}

pub(super) fn text(model: &Model, e: Expr) -> String {
    model.pool.text(e)
}

#[test]
fn every_shipped_preset_can_be_read() {
    let mut names = BTreeSet::new();
    for entry in Catalog::with_folder(None).entries() {
        assert_eq!(entry.origin, PresetOrigin::Shipped);
        assert!(names.insert(entry.name.clone()), "{} is there twice", entry.name);
        let kebab = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        assert!(entry.name.chars().all(kebab), "{} is not kebab-case", entry.name);
        let document = entry.document().unwrap();
        match document.read() {
            Err(diagnostics) => panic!("{}", document.report(&diagnostics, false)),
            Ok(Checked { model, warnings, .. }) => {
                assert!(warnings.is_empty(), "{}", document.report(&warnings, false));
                assert_eq!(model.info.title, entry.info.title);
                assert!(!entry.info.summary.is_empty(), "{} has no summary", entry.name);
            }
        }
    }
    assert!(names.contains("pendulum") && names.contains("heavy-top"));
}

/// The example in FORMAT.md.
#[test]
fn the_heavy_top_of_the_format() {
    let top = model(
        r#"
title   = "Heavy symmetric top"
source  = "Principles of Dynamics, §2.3"
topics  = ["rigid body", "cyclic coordinates"]
notes   = """
Two lines
of notes.
"""
[coordinates]
theta = { symbol = "θ", unit = "rad", initial = 0.6, velocity = 0.0 }
phi   = { symbol = "φ", unit = "rad", initial = 0.0, velocity = 0.0, period = "2*pi" }
psi   = { symbol = "ψ", unit = "rad", initial = 0.0, velocity = "spin", period = "2*pi" }
[parameters]
I1   = { value = 1.0, min = 0.1, max = 5.0, unit = "kg m²", symbol = "I₁", about = "moment" }
I3   = { value = 0.4, min = 0.05, max = 5.0, scale = "log" }
Mgl  = 1.0
spin = { value = 10.0, min = -40, max = 40 }
[definitions]
T = "1/2*I1*(theta'^2 + phi'^2*sin(theta)^2) + 1/2*I3*(psi' + phi'*cos(theta))^2"
V = "Mgl*cos(theta)"
[lagrangian]
L = "T - V"
[[observables]]
name = "nutation energy"
expression = "1/2*I1*(theta'^2 + phi'^2*sin(theta)^2) + V"
[expect]
conserves = ["energy", "p_phi", "p_psi", "nutation energy"]
values = [{ name = "slow steady precession", expression = "(I3*spin - sqrt((I3*spin)^2 - 4*I1*Mgl*cos(0.6)))/(2*I1*cos(0.6))",
            at = 0.0, is = 0.264427, within = 1e-6, source = "§2.3.3" }]
[[views]]
kind = "phase"
x = "theta"
y = "p_theta"
[space]
shapes = [ { line = ["0","0","0"], to = ["sin(theta)*sin(phi)","-sin(theta)*cos(phi)","cos(theta)"] } ]
[run]
method = "auto"
speed = 1.0
start = 0.0
"#,
    );
    assert_eq!(top.info.notes, "Two lines\nof notes.");
    assert_eq!(top.coordinates[2].shown, "ψ");
    assert_eq!(text(&top, top.coordinates[2].initial_rate), "spin");
    assert_eq!(top.coordinates[1].period.map(|e| text(&top, e)).as_deref(), Some("2*pi"));
    assert_eq!(top.parameters[0].about, "moment");
    assert_eq!(top.parameters[1].scale, RangeSpacing::Log);
    assert_eq!((top.parameters[3].min, top.parameters[3].max), (-40.0, 40.0));
    assert_eq!(top.expect.conserves.len(), 4);
    assert_eq!(top.expect.conserves[3].1, top.observables[0].expression);
    assert_eq!(top.expect.values[0].within, Some(1e-6));
    assert!(top.is_lagrangian());
}

#[test]
fn tables_keep_their_order() {
    let ordered = model(
        r#"title = "order"
[coordinates]
z = { initial = 1 }
a = { initial = 2 }
m = { initial = 3 }
[parameters]
w = 1
b = 2
k = 3
[definitions]
second = "w*z"
first = "second + b*a"
[lagrangian]
L = "z'^2 + a'^2 + m'^2 - first - k*m"
"#,
    );
    let names: Vec<&str> = ordered.coordinates.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["z", "a", "m"]);
    let names: Vec<&str> = ordered.parameters.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["w", "b", "k"]);
    let names: Vec<&str> = ordered.definitions.iter().map(|(n, _)| n.as_str()).collect();
    assert_eq!(names, ["second", "first"]);
}

#[test]
fn what_is_left_out_has_its_value() {
    let bare = model(GOOD);
    assert_eq!(bare.coordinates[0].initial_rate, Expr::ZERO);
    assert_eq!(bare.coordinates[0].period, None);
    assert_eq!(bare.run.method, "auto");
    assert_eq!((bare.run.speed, bare.run.start), (1.0, 0.0));
    assert_eq!((bare.run.until, bare.run.step, bare.run.tolerance), (None, None, None));
    let Mechanics::Lagrangian { dissipation, forces, .. } = &bare.mechanics else {
        panic!("a Lagrangian was given")
    };
    assert_eq!((*dissipation, forces.as_slice()), (Expr::ZERO, &[Expr::ZERO][..]));
}

#[test]
fn numbers_are_exact_in_every_notation() {
    for (written, n, d) in [
        ("0.1", 1, 10),
        ("\"0.1\"", 1, 10),
        ("+5", 5, 1),
        ("-2.5e-3", -1, 400),
        ("1_000", 1000, 1),
        ("0x1F", 31, 1),
        ("\"2/6\"", 1, 3),
        ("\".5\"", 1, 2),
    ] {
        let file = model(&GOOD.replace("initial = 1.0", &format!("initial = {written}")));
        let value = file.pool.as_number(file.coordinates[0].initial);
        assert_eq!(value, Some(Number::ratio(n, d)), "{written}");
    }
}

#[test]
fn a_range_left_out_is_filled_with_round_numbers() {
    let range = |entry: &str| {
        let file = model(&GOOD.replace("k = 2.0", &format!("k = {entry}")));
        (file.parameters[1].min, file.parameters[1].max)
    };
    assert_eq!(range("2.0"), (0.0, 5.0));
    assert_eq!(range("9.81"), (0.0, 20.0));
    assert_eq!(range("0.3"), (0.0, 1.0));
    assert_eq!(range("0"), (-1.0, 1.0));
    assert_eq!(range("-4"), (-10.0, 0.0));
    assert_eq!(range("1e-300"), (0.0, 2e-300));
    assert_eq!(range("{ value = 2.0, min = -1.0 }"), (-1.0, 5.0));
    assert_eq!(range("{ value = 2.0, max = 3.0 }"), (0.0, 3.0));
    assert_eq!(range("{ value = -2.0, max = -1.0 }"), (-5.0, -1.0));
    assert_eq!(range("{ value = -2.0, min = -3.0 }"), (-3.0, 0.0));
    assert_eq!(range("{ value = 0.0, min = 0.0 }"), (0.0, 1.0));
    assert_eq!(range("{ value = 3.0, scale = \"log\" }"), (0.2, 50.0));
}

#[test]
fn a_hamiltonian_starts_from_momenta() {
    let file = model(
        r#"title = "H"
[coordinates]
x = { initial = 1.0 }
y = { initial = 0.0, momentum = "2*c" }
[parameters]
c = 0.5
[hamiltonian]
H = "p_x^2/2 + p_y^2/2 + x^2*y"
forces = { y = "-c*p_y" }
"#,
    );
    assert_eq!(text(&file, file.coordinates[1].initial_rate), "2*c");
    let Mechanics::Hamiltonian { forces, .. } = &file.mechanics else {
        panic!("a Hamiltonian was given")
    };
    assert_eq!(forces[0], Expr::ZERO);
    assert_eq!(text(&file, forces[1]), "-c*p_y");
}

#[test]
fn shapes_of_every_kind() {
    let file = model(&with(
        r#"[definitions]
a = "x + 1"
[[observables]]
name = "A_x"
expression = "a*p_x"
[space]
shapes = [
  { line = [0, 0], to = ["a", 0] },
  { spring = ["0", "0", "0"], to = ["x", "0", "0"] },
  { trace = ["x", "A_x", "energy"] },
  { circle = ["x", 0, 0], radius = 0.5 },
  { circle = ["x", 0], radius = "a", normal = [1, 0] },
  { mass = ["x", 0] },
  { mass = ["x", 0], radius = 0.1 },
  { path = ["a*cos(s)", "sin(s)"], from = 0, to = "2*pi", samples = 4 },
  { vector = ["x", 0], to = ["x'", 0] },
  { plane = [0, 0, 0], size = 2 },
]
"#,
    ));
    let shapes = &file.picture.shapes;
    assert_eq!(shapes.len(), 10);
    let Shape::Line { from, to } = &shapes[0] else { panic!("{:?}", shapes[0]) };
    assert_eq!((*from, text(&file, to[0]).as_str()), ([Expr::ZERO; 3], "x + 1"));
    assert_eq!(to[2], Expr::ZERO);
    let Shape::Circle { normal, .. } = &shapes[3] else { panic!("{:?}", shapes[3]) };
    assert_eq!(*normal, [Expr::ZERO, Expr::ZERO, Expr::ONE]);
    let Shape::Mass { radius, .. } = &shapes[5] else { panic!("{:?}", shapes[5]) };
    assert_eq!(*radius, None);
    let Shape::Path { points } = &shapes[7] else { panic!("{:?}", shapes[7]) };
    let points: Vec<[String; 2]> =
        points.iter().map(|p| [text(&file, p[0]), text(&file, p[1])]).collect();
    let expected = [["x + 1", "0"], ["0", "1"], ["-x - 1", "0"], ["0", "-1"], ["x + 1", "0"]];
    assert_eq!(points, expected);
}

/// Inside a path `s` is the path's own, and its use there does not count as a use of another `s`.
#[test]
fn the_parameter_of_a_path_is_its_own() {
    let text = GOOD.replace("k = 2.0", "k = 2.0\ns = 3.0")
        + "[space]\nshapes = [{ path = [\"s*x\", 0], from = 0, to = 1, samples = 1 }]\n";
    let Checked { model, warnings, .. } = checked(&text);
    let Shape::Path { points } = &model.picture.shapes[0] else {
        panic!("{:?}", model.picture.shapes[0])
    };
    assert_eq!(model.pool.text(points[1][0]), "x");
    assert_eq!(warnings.len(), 1);
    assert_eq!(warnings[0].message, "the parameter `s` is not used");
}

/// A unit is a label, so a sine of degrees is allowed, with a warning; ratios and factors of the file's own may convert.
#[test]
fn degrees_that_are_taken_for_radians_are_warned_of() {
    let text = r#"
title = "Degrees"

[coordinates]
theta = { initial = 90, unit = "degree" }

[parameters]
alpha = { value = 30, unit = "°" }
beta = { value = 30, unit = "°" }
k = { value = 0.017453292519943295, unit = "rad/deg" }

[lagrangian]
L = "1/2*theta'^2 + cos(theta) + sin(beta*pi/180)*theta + cos(theta/beta)*cos(k*theta)*tan(0.017453*theta)"

[[observables]]
name = "slope"
expression = "tan(1 + alpha/2)"

[[observables]]
name = "converted"
expression = "tan(k*(alpha + theta)/2) + sin(theta^2/beta^2)"
"#;
    let Checked { warnings, .. } = checked(text);
    let messages: Vec<&str> = warnings.iter().map(|w| w.message.as_str()).collect();
    let expected = [
        "`theta` is in degrees, but cos takes radians",
        "`alpha` is in degrees, but tan takes radians",
    ];
    assert_eq!(messages, expected);
    assert_eq!(
        warnings[1].help.as_deref(),
        Some("write tan(alpha*pi/180), or give `alpha` in radians")
    );
}

#[test]
fn views_of_every_kind() {
    let text = with(
        r#"
[[views]]
kind = "space"
title = "the thing itself"
[[views]]
kind = "phase"
x = "x"
y = "p_x"
[[views]]
kind = "time"
y = ["x", "energy", "x''"]
[[views]]
kind = "time"
y = "x'"
[[views]]
kind = "section"
on = "x"
x = "x"
y = "p_x"
x_range = ["-k", "k"]
[[views]]
kind = "action"
x = "x"
"#,
    );
    let Checked { model, warnings, .. } = checked(&text);
    let kinds: Vec<&str> = model.views.iter().map(|v| v.kind.as_str()).collect();
    assert_eq!(kinds, ["space", "phase", "time", "time", "section", "action"]);
    assert_eq!((model.views[4].section, model.sections.len()), (Some(0), 1));
    assert!(model.views[4].ranges[0].is_some() && model.views[4].ranges[1].is_none());
    assert!(model.events.is_empty(), "a surface is no event of the file");
    assert_eq!(model.views[0].title, "the thing itself");
    let written: Vec<&str> = model.views[2].axes[0].iter().map(|c| c.written.as_str()).collect();
    assert_eq!(written, ["x", "energy", "x''"]);
    assert_eq!(warnings, []);
}

#[test]
fn what_nothing_uses_is_a_warning() {
    let text = GOOD
        .replace("k = 2.0", "k = 2.0\nidle = 3.0\nstart = 1.0")
        .replace("= 1.0 }", "= \"start\" }")
        + "[definitions]\nV = \"k*x\"\n";
    let warnings = checked(&text).warnings;
    let messages: Vec<&str> = warnings.iter().map(|w| w.message.as_str()).collect();
    assert_eq!(messages, ["the parameter `idle` is not used", "the definition `V` is not used"]);
    assert_eq!(&text[warnings[0].place.clone()], "idle");
}

/// A definition may contain what its place of use allows: here an observable, not L.
#[test]
fn a_definition_is_judged_where_it_is_used() {
    let file = model(&with(
        r#"[definitions]
rate = "p_x/m + 0*energy"
[[observables]]
name = "rate"
expression = "rate"
[[observables]]
name = "twice"
expression = "2*rate - x''"
"#,
    ));
    assert_eq!(text(&file, file.observables[1].expression), "2*p_x/m - x''");
}

#[test]
fn claims_keep_their_places() {
    let written = with(
        r#"[[observables]]
name = "A"
expression = "x"
conserved = false
[expect]
conserves = ["energy", "p_x", "A", "x*p_x"]
values = [{ expression = "x'", at = 1, is = 2.5 }]
"#,
    );
    let file = model(&written);
    assert_eq!(file.observables[0].conserved, Some(false));
    assert_eq!(&written[file.observables[0].place.clone()], "false");
    let places: Vec<&str> =
        file.expect.conserves.iter().map(|(_, _, place)| &written[place.clone()]).collect();
    assert_eq!(places, ["\"energy\"", "\"p_x\"", "\"A\"", "\"x*p_x\""]);
    let value = &file.expect.values[0];
    assert_eq!((value.name.as_str(), value.within), ("x'", None));
    assert_eq!(&written[value.place.clone()], "2.5");
}

#[test]
fn the_method_keeps_its_place() {
    let written = with("[run]\nmethod = \"rk5\"\n");
    let run = model(&written).run;
    assert_eq!(&written[run.method_place.unwrap()], "\"rk5\"");
}

/// Every kind of TOML quotation gives the same expression, and errors in it have their exact position.
#[test]
fn places_pass_through_quotes_and_escapes() {
    for quoted in [
        "\"k*zzz\"",
        "'k*zzz'",
        "\"\"\"\nk*zzz\"\"\"",
        "'''\r\nk*zzz'''",
        "\"\\u006b*zzz\"",
        "\"\\U0000006b\\x2azzz\"",
        "\"k\\t*zzz + \\\"\"",
        "\"\"\"k \\\n   *zzz\"\"\"",
        "\"\"\"k\r\n*zzz\"\"\"",
    ] {
        let text = GOOD.replace("\"1/2*m*x'^2 - 1/2*k*x^2\"", quoted);
        let diagnostics = read(&text).unwrap_err();
        let first = diagnostics.iter().find(|m| m.message.contains("zzz"));
        match first {
            Some(diagnostic) => assert_eq!(&text[diagnostic.place.clone()], "zzz", "{quoted}"),
            None => assert_eq!(&text[diagnostics[0].place.clone()], "\\\"", "{quoted}"),
        }
    }
}

/// A byte order mark before the text does not change any position.
#[test]
fn a_byte_order_mark_is_passed_over() {
    let text = format!("\u{feff}{GOOD}");
    model(&text);
    let text = text.replace("k*x", "zzz*x");
    let diagnostics = read(&text).unwrap_err();
    assert_eq!(&text[diagnostics[0].place.clone()], "zzz");
}

/// Names that a constraint or another coordinate would reserve are free if there is none.
#[test]
fn only_what_means_something_is_reserved() {
    model(&GOOD.replace('k', "lambda_k").replace("m = ", "p_m = ").replace("m*", "p_m*"));
}

#[test]
fn solids_a_label_and_the_point_that_the_camera_follows() {
    let file = model(&with(
        r#"[space]
follow = ["x", "0", "1/2"]
reach = "3"
azimuth = -45
elevation = 60.5
shapes = [
  { disc = ["x", "0", "0"], radius = "2" },
  { sphere = ["0", "x", "0"], radius = "2" },
  { cone = ["0", "0", "0"], to = ["0", "0", "x"], radius = "1/4" },
  { vector = ["0", "0"], to = ["x", "0"], label = "v" },
  { cylinder = ["0", "0", "x"], to = ["0", "1", "0"], radius = "1/8" },
  { caption = ["x", "0", "0"], text = "the bob" },
]
"#,
    ));
    let shapes = &file.picture.shapes;
    assert_eq!(shapes.len(), 6);
    let Shape::Caption { at, text: words } = &shapes[5] else { panic!("{:?}", shapes[5]) };
    assert_eq!((text(&file, at[0]).as_str(), words.as_str()), ("x", "the bob"));
    let Shape::Cylinder { from, to, radius } = &shapes[4] else { panic!("{:?}", shapes[4]) };
    assert_eq!([from[2], to[1], *radius].map(|e| text(&file, e)), ["x", "1", "1/8"]);
    let Shape::Disc { normal, .. } = &shapes[0] else { panic!("{:?}", shapes[0]) };
    assert_eq!(*normal, [Expr::ZERO, Expr::ZERO, Expr::ONE]);
    let Shape::Sphere { centre, radius } = &shapes[1] else { panic!("{:?}", shapes[1]) };
    assert_eq!([text(&file, centre[1]), text(&file, *radius)], ["x", "2"]);
    let Shape::Cone { tip, base, .. } = &shapes[2] else { panic!("{:?}", shapes[2]) };
    assert_eq!((*tip, text(&file, base[2]).as_str()), ([Expr::ZERO; 3], "x"));
    let Shape::Vector { label, .. } = &shapes[3] else { panic!("{:?}", shapes[3]) };
    assert_eq!(label, "v");
    let Some(follow) = &file.picture.follow else { panic!("a point to follow") };
    assert_eq!([text(&file, follow.at[0]), text(&file, follow.reach)], ["x", "3"]);
    let eye = CameraPose::on(&file, None);
    assert_eq!([eye.yaw, eye.pitch], [315.0, 60.5].map(f64::to_radians));
    // Without them a picture in space is seen from the front, a little from the right and from above.
    let usual = model(&with("[space]\nshapes = [{ mass = [\"0\", \"0\", \"x\"] }]\n"));
    let eye = CameraPose::on(&usual, None);
    assert_eq!([eye.yaw, eye.pitch], [PI / 6.0, PI / 9.0]);
}
