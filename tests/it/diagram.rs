//! Diagrams over a parameter: crossings against closed forms and known period doublings, exponents, keys, sessions.

use std::sync::Arc;

use phaselab::app::{App, AppEvent, Drawn, Effect, Pane, Saved};
use phaselab::experiment::Command;
use phaselab::instrument::{Across, Layer, Need, Picture, Plot, SavedVariations, Upwards};
use phaselab::job::{Progress, Share};
use phaselab::model::Variation;

use crate::fixtures::{begun, catalog, lab, press};
use crate::laboratory::{layers, measure};

/// A driven oscillator with friction, x″ + x′/2 + 2 x = A cos t.
const DRIVEN: &str = r#"
title = "driven"
[coordinates]
x = { initial = 0.4 }
[parameters]
A = { value = 1.5, min = 0.0, max = 4.0 }
k = { value = 2.0, min = 0.5, max = 4.0 }
[lagrangian]
L = "1/2*x'^2 - 1/2*k*x^2"
dissipation = "1/4*x'^2"
forces = { x = "A*cos(t)" }
[[views]]
kind = "diagram"
over = "A"
on = "sin(t)"
y = "x"
x_range = ["1", "3"]
"#;

fn diagram(app: &App) -> Plot {
    let plots = &app.lab.as_ref().unwrap().plots;
    plots.iter().find(|plot| plot.kind.name() == "diagram").expect("a diagram").clone()
}

fn points(app: &App) -> Arc<Vec<[f64; 2]>> {
    let found = layers(app, &diagram(app)).into_iter().find_map(|layer| match layer {
        Layer::Bands(points, _) => Some(points),
        _ => None,
    });
    found.expect("points")
}

/// What is awaited is the whole picture, not its next part.
#[test]
fn the_progress_of_a_diagram_grows_with_it() {
    let app = begun(DRIVEN);
    let lab = app.lab.as_ref().unwrap();
    let plot = diagram(&app);
    assert_eq!(measure(&app, &plot, "columns"), 32.0);
    let need = plot.kind.job(lab.context(&plot, &lab.present().unwrap()));
    let (Need::Job(job) | Need::Addition(job)) = need else { panic!("nothing is left to do") };
    let progress = Progress::new();
    job.run(&progress);
    assert_eq!(progress.share(), Share { done: 48, total: Some(256) });
}

#[test]
fn the_answer_of_a_linear_oscillator_grows_with_its_drive() {
    let app = begun(DRIVEN);
    assert_eq!(measure(&app, &diagram(&app), "columns"), 32.0);
    assert_eq!(measure(&app, &diagram(&app), "branches"), 1.0);
    let points = points(&app);
    assert_eq!(points.len(), 32 * 80);
    // x = Re A/(k − 1 + i/2) at t = 2πn: A (k − 1)/((k − 1)² + 1/4) with k = 2
    let answer = |a: f64| a * 0.8;
    assert!(points.iter().all(|at| (at[1] - answer(at[0])).abs() < 1e-8), "{points:?}");
    let ends = points.iter().fold([9.0_f64, 0.0], |[lo, hi], at| [lo.min(at[0]), hi.max(at[0])]);
    assert!(ends[0] == 1.0 && ends[1] > 2.9 && ends[1] <= 3.0, "{ends:?}");
    assert!((measure(&app, &diagram(&app), "value") - 1.2).abs() < 0.05);
}

/// What is computed is written as a table that reads as it was computed: every value of the parameter with its crossings.
#[test]
fn a_diagram_is_saved_as_a_table() {
    let mut app = begun(DRIVEN);
    let index =
        app.lab.as_ref().unwrap().plots.iter().position(|plot| plot.kind.name() == "diagram");
    let focus = |app: &mut App, pane: Pane| app.lab.as_mut().unwrap().focus.pane = pane;
    // the motion itself where no diagram is focused
    focus(&mut app, Pane::Parameters);
    assert_eq!(app.lab.as_ref().unwrap().focused_table(), None);
    focus(&mut app, Pane::Plot(index.unwrap()));
    let lab = app.lab.as_ref().unwrap();
    let (kind, table) = lab.focused_table().unwrap();
    assert_eq!((kind, table.columns[0].as_str(), table.columns.len()), ("diagram", "A", 2));
    let mut text = Vec::new();
    let snapshot = lab.seen().unwrap();
    phaselab::record::data::write_table(&lab.loaded, snapshot, &table, &mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    assert!(lines.next().unwrap().starts_with("A,"), "{text}");
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    assert_eq!(rows, table.rows);
    assert_eq!(rows.len(), points(&app).len());
    assert!(rows.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
    assert!(rows.iter().all(|row| (row[1] - 0.8 * row[0]).abs() < 1e-8));
}

/// The straight line of least squares, only where the file asks for it: the crossings are 0.8 A.
#[test]
fn a_diagram_has_the_slope_of_its_points() {
    let app = begun(&DRIVEN.replace("over = \"A\"", "over = \"A\"\nslope = true"));
    assert!((measure(&app, &diagram(&app), "slope") - 0.8).abs() < 1e-7);
    let of = |app: &App| -> (usize, Vec<String>) {
        let layers = layers(app, &diagram(app));
        let lines = layers.iter().filter(|layer| matches!(layer, Layer::Line(..))).count();
        let words = layers.into_iter().find_map(|layer| match layer {
            Layer::Legend(words) => Some(words),
            _ => None,
        });
        (lines, words.unwrap_or_default())
    };
    let (lines, words) = of(&app);
    assert_eq!(lines, 2);
    assert!(words[0].starts_with("slope 0.80000"), "{words:?}");
    assert_eq!(of(&begun(DRIVEN)), (1, Vec::new()));
}

/// The ramps of the preset: ΔJ ∝ ε and ε² are slopes of −1 and −2 for each doubling of the time.
#[test]
fn three_ramps_measure_their_slopes() {
    let app = lab("three-ramps", 1.0);
    let plots: Vec<Plot> = app
        .lab
        .as_ref()
        .unwrap()
        .plots
        .iter()
        .filter(|plot| plot.kind.name() == "diagram")
        .cloned()
        .collect();
    let [corner, second, ..] = &plots[..] else { panic!("three diagrams") };
    let [first, other] = [corner, second].map(|plot| measure(&app, plot, "slope"));
    assert!((first + 1.0).abs() < 0.1, "{first}");
    assert!((other + 2.0).abs() < 0.1, "{other}");
}

/// A quantity that is no column of the motion, but an expression of the view.
#[test]
fn an_expression_is_shown_as_a_coordinate_is() {
    let app = begun(&DRIVEN.replace("y = \"x\"", "y = \"x^2 + 1\""));
    let points = points(&app);
    assert_eq!(points.len(), 32 * 80);
    let answer = |a: f64| (a * 0.8).powi(2) + 1.0;
    assert!(points.iter().all(|at| (at[1] - answer(at[0])).abs() < 1e-7), "{points:?}");
}

/// The pendulum of Baker and Gollub at a value of its drive: how many crossings are different.
fn branches(drive: &str) -> f64 {
    let text = catalog().find("driven-damped-pendulum").unwrap().text.clone();
    let text = text.replace(
        r#"x_range = ["0.9", "1.5"]"#,
        &format!("x_range = [\"{drive}\", \"{drive} + 1e-9\"]"),
    );
    let app = begun(&text.replace("A = { value = 1.5", &format!("A = {{ value = {drive}")));
    measure(&app, &diagram(&app), "branches")
}

#[test]
fn periods_double_where_they_are_known_to() {
    // G. L. Baker, J. P. Gollub, Chaotic Dynamics, ch. 3: q = 2, ω_D = 2/3
    assert_eq!(branches("0.9"), 1.0);
    assert_eq!(branches("1.07"), 2.0);
    assert!(branches("1.5") > 40.0, "chaos");
}

#[test]
fn a_zoom_computes_what_is_seen() {
    let mut app = begun(DRIVEN);
    press(&mut app, "v + + + + + +");
    let seen = points(&app);
    assert!(seen.iter().all(|at| (1.7..2.3).contains(&at[0])), "{seen:?}");
    assert_eq!(measure(&app, &diagram(&app), "columns"), 32.0);
}

#[test]
fn a_key_shows_the_exponent_where_there_is_no_section() {
    let saddle = "title = 'a test'\n[coordinates]\nx = { initial = 0.0 }\n\
                  [parameters]\nk = { value = 1.0, min = 0.25, max = 4.0 }\n\
                  [lagrangian]\nL = \"1/2*x'^2 + 1/2*k*x^2\"\n[run]\nspeed = 0.1\n";
    let mut app = begun(saddle);
    press(&mut app, "v Q Q");
    let plot = diagram(&app);
    let lab = app.lab.as_ref().unwrap();
    assert_eq!(lab.focused_plot().map(|(_, shown)| shown), Some(&plot));
    let present = lab.present().unwrap();
    let Some(Picture::Axes { layers, .. }) =
        plot.kind.picture(lab.context(&plot, &present), [0.25, 4.0])
    else {
        panic!("no picture")
    };
    let mut lines = layers.iter().filter_map(|(_, layer)| match layer {
        Layer::Line(points, _) if points.len() == 32 => Some(points),
        _ => None,
    });
    for [k, exponent] in lines.next_back().expect("a curve") {
        // the vector turns into the direction that grows by e^{√k t} within a few units of time
        assert!((exponent - k.sqrt()).abs() < 0.15, "{k} {exponent}");
    }
    // a regular motion has none, however short it was followed
    let swing = saddle.replace("+ 1/2*k*x^2", "- 1/2*k*x^2").replace("0.0 }", "1.0 }");
    let mut regular = begun(&swing.replace("speed = 0.1", "speed = 1.0"));
    press(&mut regular, "v");
    // and its frequency is shown in place of an exponent that is always 0: √k
    assert!(reported(&mut regular).contains("every motion is regular"));
    let of = |app: &App, kind: &str| {
        let plot = &app.lab.as_ref().unwrap().focused_plot().unwrap().1.clone();
        assert_eq!(plot.kind.name(), kind);
        computed(app, plot)
    };
    let found = of(&regular, "frequency");
    assert_eq!(found.len(), 32);
    assert!(found.iter().all(|[k, omega]| (omega / k.sqrt() - 1.0).abs() < 1e-8), "{found:?}");
    press(&mut regular, "Q");
    let found = of(&regular, "period");
    let period = |k: f64| std::f64::consts::TAU / k.sqrt();
    assert!(found.iter().all(|[k, t]| (t / period(*k) - 1.0).abs() < 1e-8), "{found:?}");
    press(&mut regular, "Q");
    assert_eq!(measure(&regular, &diagram(&regular), "value"), 0.0);
}

fn reported(app: &mut App) -> String {
    app.notifications.shown.take().map(|notice| notice.text).unwrap_or_default()
}

/// The rows of what a plot over a range has computed.
fn computed(app: &App, plot: &Plot) -> Vec<[f64; 2]> {
    let lab = app.lab.as_ref().unwrap();
    let table = plot.kind.table(lab.context(plot, &lab.present().unwrap())).expect("a table");
    table.rows.iter().map(|row| [row[0], row[1]]).collect()
}

/// Over the angle at which a pendulum is let go, and over its velocity at the bottom: to and fro and round, by the complete
/// elliptic integral K(k) as an arithmetic-geometric mean.
#[test]
fn the_frequency_over_an_initial_value_is_that_of_the_elliptic_integral() {
    let quarter = |k: f64| {
        let (mut a, mut b) = (1.0_f64, (1.0 - k * k).sqrt());
        for _ in 0..60 {
            (a, b) = (0.5 * (a + b), (a * b).sqrt());
        }
        std::f64::consts::FRAC_PI_2 / a
    };
    let frequency = |k: f64| std::f64::consts::FRAC_PI_2 / quarter(k);
    let text = "title = 'a test'\n[coordinates]\n\
                q = { initial = 1.0, velocity = 0.0, period = \"2*pi\" }\n\
                [lagrangian]\nL = \"1/2*q'^2 + cos(q)\"\n[run]\nspeed = 1.0\n";
    let mut app = begun(text);
    press(&mut app, "Tab v");
    let plot = app.lab.as_ref().unwrap().focused_plot().unwrap().1.clone();
    assert_eq!((plot.kind.name(), &plot.over[..]), ("frequency", &[Variation::Initial(0)][..]));
    let found = computed(&app, &plot);
    assert!(found.len() >= 28, "{found:?}");
    for [q, omega] in found {
        let exact = frequency((0.5 * q).sin().abs());
        assert!((omega / exact - 1.0).abs() < 1e-5, "{q} {omega} {exact}");
    }
    let mut app =
        begun(&text.replace("initial = 1.0, velocity = 0.0", "initial = 0.0, velocity = 1.5"));
    press(&mut app, "Tab Down v");
    let plot = app.lab.as_ref().unwrap().focused_plot().unwrap().1.clone();
    assert_eq!((plot.kind.name(), &plot.over[..]), ("frequency", &[Variation::Initial(1)][..]));
    let found = computed(&app, &plot);
    assert!(found.iter().any(|[v, _]| v.abs() > 2.1), "{found:?}");
    for [v, omega] in found {
        let k = 0.5 * v.abs();
        // round it goes in 2K(1/k)/k
        let exact = if k < 1.0 { frequency(k) } else { 2.0 * k * frequency(1.0 / k) };
        assert!((omega / exact - 1.0).abs() < 1e-5, "{v} {omega} {exact}");
    }
}

/// Where an oscillator has settled the frequency is that of its limit cycle: T = 6.6632868593231301896… for μ = 1 (D. Viswanath).
#[test]
fn the_period_of_a_limit_cycle_is_that_after_it_has_settled() {
    let text = "title = 'a test'\n[coordinates]\nx = { initial = 0.5, velocity = 0.0 }\n\
                [parameters]\nmu = { value = 1.0, min = 1.0, max = 1.000001 }\n\
                [lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n\
                forces = { x = \"mu*(1 - x^2)*x'\" }\n[run]\nspeed = 1.0\n\
                [[views]]\nkind = \"period\"\nover = \"mu\"\n";
    let (tables, view) = text.split_at(text.find("[[views]]").unwrap());
    let place = tables.find("[run]").unwrap();
    let app = begun(&[&tables[..place], view, &tables[place..]].concat());
    let plots = &app.lab.as_ref().unwrap().plots;
    let plot = plots.iter().find(|plot| plot.kind.name() == "period").expect("the view").clone();
    let found = computed(&app, &plot);
    assert_eq!(found.len(), 32);
    assert!(found.iter().all(|[_, t]| (t / 6.663_286_859_323_13 - 1.0).abs() < 2e-6), "{found:?}");
}

/// A chaotic motion has no frequency, and leaves a gap.
#[test]
fn what_is_offered_over_a_range_is_there_where_it_is_known() {
    let saddle = "title = 'a test'\n[coordinates]\nx = { initial = 1.0 }\n\
                  [parameters]\nk = { value = 1.0, min = 0.25, max = 4.0 }\n\
                  [lagrangian]\nL = \"1/2*x'^2 + 1/2*k*x^2\"\n[run]\nspeed = 0.1\n";
    let mut app = begun(saddle);
    press(&mut app, "v Q");
    let plot = app.lab.as_ref().unwrap().focused_plot().unwrap().1.clone();
    assert!(computed(&app, &plot).is_empty(), "what runs away has no frequency or period");
}

/// The axes of the section whose surface it shares are others: the parameter has its own range, and upwards is the
/// section's horizontal axis.
#[test]
fn a_key_on_a_parameter_shows_all_of_its_range() {
    let section = "kind = \"section\"\non = \"sin(t)\"\nx = \"x\"\ny = \"x'\"\n\
                   x_range = [\"-7\", \"7\"]\ny_range = [\"-5\", \"5\"]\n";
    let at = DRIVEN.find("kind = \"diagram\"").unwrap();
    let mut app = begun(&[&DRIVEN[..at], section].concat());
    press(&mut app, "v");
    let (plot, lab) = (diagram(&app), app.lab.as_ref().unwrap());
    let present = lab.present().unwrap();
    let Across::Named(_, range) = plot.kind.across(lab.context(&plot, &present)) else {
        panic!("an axis")
    };
    assert_eq!(range, [0.0, 4.0]);
    match plot.kind.picture(lab.context(&plot, &present), range) {
        Some(Picture::Axes { upwards: Upwards::Named(_, range), .. }) => {
            assert_eq!(range, [-7.0, 7.0]);
        }
        other => panic!("{other:?}"),
    }
    let points = points(&app);
    assert!(points.iter().all(|at| (0.0..=4.0).contains(&at[0])));
    assert!(points.iter().any(|at| at[0] > 3.5) && points.iter().any(|at| at[0] < 0.5));
}

/// Crossings of an angle may fill all of its values whatever the parameter: of a section with an angle the other axis is drawn.
#[test]
fn of_a_section_with_an_angle_the_momentum_is_shown() {
    let mut app = begun(&catalog().find("kicked-rotor").unwrap().text);
    press(&mut app, "v");
    let (plot, lab) = (diagram(&app), app.lab.as_ref().unwrap());
    let present = lab.present().unwrap();
    match plot.kind.picture(lab.context(&plot, &present), [f64::NAN; 2]) {
        Some(Picture::Axes { upwards: Upwards::Named(name, [low, high]), .. }) => {
            assert!(name.starts_with("p_θ where"), "{name}");
            let pi = std::f64::consts::PI;
            assert!((low + pi).abs() < 1e-12 && (high - 3.0 * pi).abs() < 1e-12);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_point_of_it_is_a_value_of_the_parameter() {
    let mut app = begun(DRIVEN);
    press(&mut app, "v");
    press(&mut app, "c");
    app.update(AppEvent::Drawn(Drawn { reading: Some([2.25, 0.5]), ..Drawn::default() }));
    let effects = press(&mut app, "Enter");
    let [Effect::Execute(Command::Parameter { index: 0, value })] = effects[..] else {
        panic!("{effects:?}")
    };
    // as a slider would be left there
    assert!((value - 2.25).abs() < 0.02, "{value}");
    // which changes nothing of the diagram
    let before = points(&app);
    assert!(Arc::ptr_eq(&before, &points(&app)));
}

#[test]
fn sessions_have_it_with_its_parameter() {
    let mut app = begun(DRIVEN);
    // over the other parameter, on the same surface
    press(&mut app, "Down v");
    let plot = diagram(&app);
    assert_eq!((&plot.over[..], plot.view), (&[Variation::Parameter(1)][..], Some(0)));
    let text = toml::to_string(&app.saved().unwrap()).unwrap();
    let read: Saved = toml::from_str(&text).unwrap();
    let saved = read.plots.iter().find(|plot| plot.kind == "diagram").unwrap();
    assert_eq!(saved.over, SavedVariations::One("k".to_owned()));
    let physics = app.lab.as_ref().unwrap().loaded.physics();
    assert_eq!(saved.place(physics), Some(plot));
    let mut strange = saved.clone();
    strange.over = SavedVariations::One("nothing".to_owned());
    assert_eq!(strange.place(physics), None);
    strange = saved.clone();
    strange.view = Some(7);
    assert_eq!(strange.place(physics), None);
}

#[test]
fn a_parameter_without_motions_says_why() {
    let wall = DRIVEN.replace("1/2*k*x^2", "1/2*k*sqrt(x - 1)");
    let app = begun(&wall);
    let reported = layers(&app, &diagram(&app)).into_iter().find_map(|layer| match layer {
        Layer::Legend(lines) => Some(lines.concat()),
        _ => None,
    });
    assert!(reported.is_some_and(|why| !why.is_empty()));
    assert!(points(&app).is_empty());
}

#[test]
fn an_angle_is_shown_within_a_turn() {
    let text = catalog().find("kicked-rotor").unwrap().text.clone();
    let text = text
        + "\n[[views]]\nkind = \"diagram\"\nover = \"K\"\non = \"sin(2*pi*t/T - pi)\"\n\
                       y = \"theta\"\nx_range = [\"0.1\", \"6\"]\n";
    // views stand before [space] and [run]
    let (tables, view) = text.split_at(text.rfind("\n[[views]]").unwrap());
    let place = tables.find("[[views]]").unwrap();
    let app = begun(&[&tables[..place], view, "\n", &tables[place..]].concat());
    let points = points(&app);
    assert_eq!(points.len(), 32 * 80);
    assert!(points.iter().all(|at| at[1].abs() <= std::f64::consts::PI), "within a turn");
    // for a strong kick all of it is reached
    let strong = points.iter().filter(|at| at[0] > 5.0).map(|at| at[1]);
    let (low, high) = strong.fold((9.0_f64, -9.0_f64), |(lo, hi), y| (lo.min(y), hi.max(y)));
    assert!(low < -3.0 && high > 3.0, "{low} {high}");
}
