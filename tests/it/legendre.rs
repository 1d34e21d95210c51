//! The picture of the Legendre transform: slope and intercept against closed forms, and what has none.

use phaselab::app::App;
use phaselab::instrument::{Layer, Picture, Plot, Upwards, named, offers};

use crate::fixtures::begun;
use crate::laboratory::measure;

/// A law with the view of its transform, v = 0.6 at the start.
fn law(table: &str, law: &str, rate: &str) -> String {
    format!(
        "title = 'a test'\n[coordinates]\nx = {{ initial = 0.5, {rate} = 0.6 }}\n\
         [{table}]\n{law}\n[[views]]\nkind = \"legendre\"\nx = \"x\"\n"
    )
}

fn plot(app: &App) -> Plot {
    let plots = &app.lab.as_ref().unwrap().plots;
    plots.iter().find(|plot| plot.kind.name() == "legendre").expect("a picture").clone()
}

/// The layers over a range.
fn drawn(app: &App) -> Vec<Layer> {
    let (lab, plot) = (app.lab.as_ref().unwrap(), plot(app));
    let picture = plot.kind.picture(lab.context(&plot, &lab.present().unwrap()), [-0.9, 0.9]);
    let Some(Picture::Axes { layers, .. }) = picture else { panic!("no axes") };
    layers.into_iter().map(|(_, layer)| layer).collect()
}

fn reported(app: &App) -> String {
    let legend = drawn(app).into_iter().find_map(|layer| match layer {
        Layer::Legend(lines) => Some(lines.join("\n")),
        _ => None,
    });
    legend.expect("words")
}

fn near(found: f64, wanted: f64) {
    assert!((found - wanted).abs() < 1e-13, "{found} {wanted}");
}

#[test]
fn the_slope_is_the_momentum_and_the_intercept_minus_the_hamiltonian() {
    let app = begun(&law("lagrangian", "L = \"-sqrt(1 - x'^2) + x\"", "velocity"));
    // γ = 1/0.8: p = γ v, H = γ − x
    near(measure(&app, &plot(&app), "slope"), 0.75);
    near(measure(&app, &plot(&app), "intercept"), -(1.25 - 0.5));
    assert_eq!(reported(&app), "slope p_x = 0.75\nintercept −H = −0.75");
    // the tangent touches the curve from below, and meets the axis at the intercept
    let lines = drawn(&app).into_iter().filter_map(|layer| match layer {
        Layer::Line(points, _) => Some(points),
        _ => None,
    });
    let lines: Vec<Vec<[f64; 2]>> = lines.collect();
    let [axis, tangent, curve] = &lines[..] else { panic!("{}", lines.len()) };
    near(axis[0][1], -0.75);
    let at = |x: f64| tangent[0][1] + 0.75 * (x - tangent[0][0]);
    near(at(0.0), -0.75);
    let above: Vec<f64> = curve.iter().map(|[x, y]| y - at(*x)).collect();
    assert!(above.iter().all(|gap| *gap > -1e-13), "{above:?}");
    assert_eq!(above.iter().filter(|gap| gap.abs() < 1e-13).count(), 1);
}

#[test]
fn a_hamiltonian_is_transformed_back() {
    let app = begun(&law("hamiltonian", "H = \"p_x^2/4 + x^2\"", "momentum"));
    // x' = p/2, L = x'² − x²
    near(measure(&app, &plot(&app), "slope"), 0.3);
    near(measure(&app, &plot(&app), "intercept"), -(0.09 - 0.25));
    assert_eq!(reported(&app), "slope x′ = 0.3\nintercept −L = 0.16");
}

#[test]
fn a_slope_that_several_velocities_have_is_reported() {
    let app = begun(&law("lagrangian", "L = \"x'^4/4 - x'^2/2\"", "velocity"));
    assert!(
        reported(&app).contains("not convex: several x′ may have one p_x"),
        "{}",
        reported(&app)
    );
    let app = begun(&law("hamiltonian", "H = \"x*p_x\"", "momentum"));
    assert!(reported(&app).contains("straight: x′ does not determine p_x"), "{}", reported(&app));
}

#[test]
fn of_several_velocities_one_is_transformed() {
    let text = law("lagrangian", "L = \"1/2*(x'^2 + y'^2) + x'*y' - y\"", "velocity")
        .replace("[lagrangian]", "y = { initial = 2.0, velocity = -0.1 }\n[lagrangian]")
        .replace("x'^2 + y'^2", "2*x'^2 + y'^2");
    let app = begun(&text);
    // p_x = 2 x' + y', L − p_x x'
    near(measure(&app, &plot(&app), "slope"), 1.1);
    let lagrangian = 0.5 * (0.72 + 0.01) - 0.06 - 2.0;
    near(measure(&app, &plot(&app), "intercept"), lagrangian - 1.1 * 0.6);
    assert_eq!(reported(&app), "slope p_x = 1.1\nintercept L − p_x x′ = −2.355");
}

#[test]
fn variables_of_brackets_have_no_transform() {
    let kind = named("legendre").unwrap();
    let text = "title = 'a test'\n[variables]\nx = { initial = 1.0 }\ny = { initial = 0.0 }\n\
                [poisson]\nH = \"x^2 + y^2\"\nbrackets = [[\"x\", \"y\", \"1\"]]\n";
    let lowered = crate::fixtures::lowered(text);
    assert!(lowered.model.is_poisson());
    assert!(offers(lowered.physics()).iter().all(|(of, _)| *of != kind));
}

/// The vertical axis of a pendulum stays where it is while the curve goes up and down with −V.
#[test]
fn the_vertical_axis_stays_while_the_curve_moves() {
    let text = "title = 'a test'\n[coordinates]\nx = { initial = 2.0, velocity = 0.0 }\n\
                [lagrangian]\nL = \"x'^2/2 + 9.81*cos(x)\"\n[[views]]\nkind = \"legendre\"\nx = \"x\"\n";
    let app = begun(text);
    let lab = app.lab.as_ref().unwrap();
    let plot = plot(&app);
    let mut present = lab.present().unwrap();
    let bounds: Vec<(f64, f64)> = present.bounds.iter().map(|_| (-2.0, 2.0)).collect();
    present.bounds = &bounds;
    let Some(Picture::Axes { upwards, .. }) =
        plot.kind.picture(lab.context(&plot, &present), [-7.0, 7.0])
    else {
        panic!("no axes")
    };
    let Upwards::Named(_, [low, high]) = upwards else { panic!("no range") };
    // at the lowest point L is 9.81 more than ½ v², at the turning point 9.81 cos 2
    near(high, 24.5 + 9.81);
    near(low, 9.81 * 2.0_f64.cos());
}
