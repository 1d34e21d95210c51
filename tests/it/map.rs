//! Maps over two parameters or initial values: closed forms of each number that is shown, points that begin motions, sessions.

use std::sync::Arc;

use phaselab::app::{App, AppEvent, Drawn, Effect, Saved};
use phaselab::experiment::{Command, Experiment, Setup};
use phaselab::instrument::{Field, Layer, Plot, SavedVariations};
use phaselab::model::Variation;
use phaselab::system::InitialOverride;

use crate::fixtures::{begun, press};
use crate::laboratory::{layers, measure};

/// A ball above the floor, g = 2.
const BALL: &str = r#"
title = "ball"
[coordinates]
x = { initial = 1.0, velocity = 0.5 }
[parameters]
g = { value = 2.0, min = 1.0, max = 3.0 }
[lagrangian]
L = "1/2*x'^2 - g*x"
[[views]]
kind = "map"
x = "x"
y = "x'"
on = "x"
direction = "falling"
until = "4"
x_range = ["-1", "3"]
y_range = ["-1", "3"]
"#;

fn map(app: &App) -> Plot {
    let plots = &app.lab.as_ref().unwrap().plots;
    plots.iter().find(|plot| plot.kind.name() == "map").expect("a map").clone()
}

fn field(app: &App) -> Option<Arc<Field>> {
    layers(app, &map(app)).into_iter().find_map(|layer| match layer {
        Layer::Field(field) => Some(field),
        _ => None,
    })
}

/// The places that have a motion of their own where there is no background, every eighth of a row and of a column, with
/// their numbers.
fn own(app: &App) -> Vec<([f64; 2], f64)> {
    let field = field(app).expect("a field");
    let rows = field.values.len() / field.columns;
    let all = (0..rows).step_by(8).flat_map(|j| (0..field.columns).step_by(8).map(move |i| [i, j]));
    all.map(|place| {
        let at = [0, 1].map(|axis| {
            let [from, to] = field.window[axis];
            let count = [field.columns, rows][axis] as f64;
            from + (to - from) * (place[axis] as f64 + 0.5) / count
        });
        (at, field.values[place[1] * field.columns + place[0]])
    })
    .collect()
}

#[test]
fn the_time_of_the_first_crossing_is_that_of_a_fall() {
    let app = begun(BALL);
    assert_eq!(measure(&app, &map(&app), "places"), 128.0);
    let (mut fallen, mut blank) = (0, 0);
    for ([x, v], time) in own(&app) {
        // x + v t − t² falls through zero at t = v/2 + √(v²/4 + x); from below only on the way down
        let under = 0.25 * v * v + x;
        let expected = 0.5 * v + under.sqrt();
        if under > 0.0 && expected > 0.0 && expected < 4.0 && (x > 0.0 || v > 0.0) {
            assert!((time - expected).abs() < 1e-8, "{x} {v}: {time}, not {expected}");
            fallen += 1;
        } else {
            assert!(time.is_nan(), "{x} {v}: {time}");
            blank += 1;
        }
    }
    assert!(fallen > 80 && blank > 10, "{fallen} {blank}");
    // x = 1, v = ½, of the nearest place that has a motion of its own
    assert!((measure(&app, &map(&app), "value") - 1.28).abs() < 0.4);
}

#[test]
fn a_quantity_at_the_end_is_what_the_motion_has_there() {
    let text = BALL
        .replace("on = \"x\"\ndirection = \"falling\"\n", "of = \"x*x'\"\n")
        .replace("x = \"x\"\ny = \"x'\"", "x = \"x\"\ny = \"g\"")
        .replace("y_range = [\"-1\", \"3\"]\n", "");
    let app = begun(&text);
    for ([x, g], value) in own(&app) {
        let t = 4.0;
        let expected = (x + 0.5 * t - 0.5 * g * t * t) * (0.5 - g * t);
        assert!((value - expected).abs() < 1e-9 * expected.abs().max(1.0), "{x} {g}: {value}");
        assert!((1.0..3.0).contains(&g));
    }
}

#[test]
fn exponents_of_saddles_over_two_parameters() {
    let saddle = "title = 'a test'\n[coordinates]\nx = { initial = 0.0 }\n\
                  [parameters]\nk = { value = 1.0, min = 0.25, max = 4.0 }\n\
                  m = { value = 1.0, min = 0.5, max = 2.0 }\n\
                  [lagrangian]\nL = \"1/2*m*x'^2 + 1/2*k*x^2\"\n\
                  [[views]]\nkind = \"map\"\nx = \"k\"\ny = \"m\"\nuntil = \"40\"\n";
    let app = begun(saddle);
    for ([k, m], exponent) in own(&app) {
        assert!((exponent - (k / m).sqrt()).abs() < 0.03, "{k} {m}: {exponent}");
    }
    // a regular motion has none
    let swing = saddle.replace("+ 1/2*k*x^2", "- 1/2*k*x^2").replace("0.0 }", "1.0 }");
    let swing = begun(&swing);
    assert!(own(&swing).iter().all(|(_, exponent)| *exponent == 0.0));
}

#[test]
fn a_point_of_it_begins_a_motion_and_changes_nothing_of_it() {
    let mut app = begun(BALL);
    let before = field(&app).expect("a field");
    press(&mut app, "Tab Tab");
    while app.lab.as_ref().unwrap().focused_plot().is_none_or(|(_, p)| p.kind.name() != "map") {
        press(&mut app, "Tab");
    }
    press(&mut app, "c");
    app.update(AppEvent::Drawn(Drawn { reading: Some([2.0, -0.25]), ..Drawn::default() }));
    let effects = press(&mut app, "Enter");
    let [Effect::Execute(Command::Start(given))] = &effects[..] else { panic!("{effects:?}") };
    assert_eq!(given[..], [InitialOverride::Position(0, 2.0), InitialOverride::Velocity(0, -0.25)]);
    let loaded = &app.lab.as_ref().unwrap().loaded;
    let setup = Setup { overrides: given.clone(), ..Setup::of(&loaded.model) };
    let mut experiment =
        Experiment::new(&loaded.model, &loaded.equations, &loaded.system, setup).unwrap();
    experiment.set_epoch(loaded.epoch);
    app.update(AppEvent::Snapshot(Arc::new(experiment.snapshot())));
    assert!(Arc::ptr_eq(&before, &field(&app).expect("a field")));
    assert!((measure(&app, &map(&app), "value") - 1.295).abs() < 0.4);
}

#[test]
fn sessions_have_it_and_the_list_of_contents_offers_others() {
    let app = begun(BALL);
    let text = toml::to_string(&app.saved().unwrap()).unwrap();
    let read: Saved = toml::from_str(&text).unwrap();
    let saved = read.plots.iter().find(|plot| plot.kind == "map").unwrap();
    assert_eq!(saved.over, SavedVariations::Several(vec!["x".to_owned(), "x'".to_owned()]));
    let physics = app.lab.as_ref().unwrap().loaded.physics();
    let placed = saved.place(physics).expect("a place");
    assert_eq!(placed, map(&app));
    assert_eq!(placed.over, [Variation::Initial(0), Variation::Initial(1)]);
    let mut strange = saved.clone();
    strange.over = SavedVariations::Several(vec!["x".to_owned(), "z".to_owned()]);
    assert_eq!(strange.place(physics), None);
    let offers = placed.kind.offers(physics);
    assert!(offers.iter().any(|offer| offer.view.is_none() && offer.over == placed.over));
}

/// One axis is an initial value, the other a parameter: a point stands for both.
#[test]
fn a_point_sets_parameters_and_initial_values() {
    let text = BALL
        .replace("x = \"x\"\ny = \"x'\"", "x = \"x\"\ny = \"g\"")
        .replace("y_range = [\"-1\", \"3\"]\n", "");
    let mut app = begun(&text);
    while app.lab.as_ref().unwrap().focused_plot().is_none_or(|(_, p)| p.kind.name() != "map") {
        press(&mut app, "Tab");
    }
    press(&mut app, "c");
    app.update(AppEvent::Drawn(Drawn { reading: Some([1.5, 2.5]), ..Drawn::default() }));
    let effects = press(&mut app, "Enter");
    let [
        Effect::Execute(Command::Parameter { index: 0, value }),
        Effect::Execute(Command::Start(given)),
    ] = &effects[..]
    else {
        panic!("{effects:?}")
    };
    assert!((value - 2.5).abs() < 0.02);
    assert_eq!(given[..], [InitialOverride::Position(0, 1.5)]);
}

#[test]
fn an_end_before_the_start_is_refused() {
    for wrong in ["-1", "0", "g - g", "0/0"] {
        let text = BALL.replace("until = \"4\"", &format!("until = \"{wrong}\""));
        let diagnostics = phaselab::preset::read(&text).expect_err(wrong);
        let why = if wrong == "0/0" { "division by zero" } else { "the motions of a map begin at" };
        let text = format!("{diagnostics:?}");
        assert!(text.contains(why), "{wrong}: {text}");
    }
}

#[test]
fn an_axis_that_is_no_number_of_the_motion_is_refused() {
    for wrong in ["x + 1", "energy", "t"] {
        let text = BALL.replacen("x = \"x\"", &format!("x = \"{wrong}\""), 1);
        let diagnostics = phaselab::preset::read(&text).expect_err(wrong);
        let text = format!("{diagnostics:?}");
        assert!(text.contains("a parameter or an initial value"), "{wrong}: {text}");
    }
}
