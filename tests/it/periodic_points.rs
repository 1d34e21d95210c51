//! Periodic orbits on the sections of the lab: their points, held against published numbers and closed forms, and the curves of
//! their families.

use std::f64::consts::{PI, TAU};

use phaselab::app::App;
use phaselab::instrument::{Across, Layer, MarkerShape, Plot, named};

use crate::laboratory::{self, first, open, prepared, see};

/// The lab with the section of a file, and beside it of some kinds the first picture whose label begins with this.
fn opened(text: &str, beside: &[(&str, &str)]) -> App {
    let (mut app, mut experiment) = open(prepared(text));
    let lab = app.lab.as_mut().unwrap();
    let physics = lab.loaded.physics();
    let picture = |&(kind, label): &(&str, &str)| {
        let kind = named(kind).unwrap();
        let offers = kind.offers(physics);
        let offer = offers.into_iter().find(|offer| offer.label.starts_with(label)).unwrap();
        let mut plot = Plot::new(kind, (offer.columns, None), physics.model);
        plot.over = offer.over;
        plot
    };
    let section =
        Plot::opening(physics).into_iter().find(|plot| plot.kind.properties().is_section).unwrap();
    lab.plots = [section].into_iter().chain(beside.iter().map(picture)).collect();
    see(&mut app, &mut experiment, 0.01);
    app
}

/// The layers of the section.
fn layers(app: &App) -> Vec<Layer> {
    laboratory::layers(app, first(app))
}

/// The points that are marked, and whether each is that of a stable orbit.
fn marked(app: &App) -> Vec<([f64; 2], bool)> {
    let mark = |layer: Layer| match layer {
        Layer::Point(at, MarkerShape::Ring, _) => Some((at, true)),
        Layer::Point(at, MarkerShape::Cross, _) => Some((at, false)),
        _ => None,
    };
    layers(app).into_iter().filter_map(mark).collect()
}

fn measure(app: &App, word: &str) -> Option<f64> {
    laboratory::measured(app, first(app), word)
}

/// The orbit B of Hénon and Heiles at E = 1/8, which is unstable, crosses x = 0 once in either direction.
#[test]
fn the_orbit_b_is_marked_where_it_is_published() {
    let text = |direction: &str| {
        format!(
            "title = \"B\"\n[coordinates]\nx = {{ initial = 0.0, momentum = \"sqrt(2*(1/8 - y0^2/2 + y0^3/3) - p0^2)\" }}\n\
             y = {{ initial = \"y0\", momentum = \"p0\" }}\n[parameters]\ny0 = -0.18\np0 = 0.004\n[hamiltonian]\n\
             H = \"1/2*(p_x^2 + p_y^2) + 1/2*(x^2 + y^2) + x^2*y - y^3/3\"\n\
             [[views]]\nkind = \"section\"\non = \"x\"\ndirection = \"{direction}\"\nx = \"y\"\ny = \"p_y\"\n\
             [run]\nuntil = 100.0\n"
        )
    };
    for (direction, count) in [("rising", 1), ("falling", 1), ("either", 2)] {
        let app = opened(&text(direction), &[("orbit", "orbit")]);
        let points = marked(&app);
        assert_eq!(points.len(), count, "{direction}: {points:?}");
        assert_eq!(measure(&app, "periodic"), Some(count as f64));
        for ([y, p], stable) in points {
            assert!(!stable && (y + 0.185_405_087_090_802_14).abs() < 1e-9 && p.abs() < 1e-9);
        }
    }
}

/// x″ + 2γ x′ + x = cos ωt settles to Re e^{iωt}/(1 − ω² + 2iγω), of which a stroboscope sees one point.
#[test]
fn a_driven_oscillation_is_a_point_of_a_stroboscope() {
    let text = "title = \"driven\"\n[coordinates]\nx = { initial = 0.5, velocity = 0.0 }\n[parameters]\ng = 0.2\nw = 0.7\n\
                [lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\ndissipation = \"g*x'^2\"\nforces = { x = \"cos(w*t)\" }\n\
                [[views]]\nkind = \"section\"\non = \"sin(w*t)\"\ndirection = \"falling\"\nx = \"x\"\ny = \"x'\"\n\
                [run]\nuntil = 100.0\n";
    let app = opened(text, &[("orbit", "orbit")]);
    let points = marked(&app);
    let (g, w) = (0.2, 0.7);
    let (re, im) = (1.0 - w * w, 2.0 * g * w);
    let size = re * re + im * im;
    // at ω t = π
    let exact = [-re / size, -(w * im / size)];
    assert_eq!(points.len(), 1, "{points:?}");
    let (at, stable) = points[0];
    assert!(stable && (0..2).all(|k| (at[k] - exact[k]).abs() < 1e-9), "{at:?} {exact:?}");
}

/// The section of a motion that has only begun shows where it will be, though no file says how far that is.
#[test]
fn a_stroboscope_shows_as_much_as_the_motion_will_reach() {
    let text = "title = \"driven\"\n[coordinates]\nx = { initial = 0.5, velocity = 0.0 }\n[parameters]\ng = 0.2\nw = 0.7\n\
                [lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\ndissipation = \"g*x'^2\"\nforces = { x = \"cos(w*t)\" }\n\
                [[views]]\nkind = \"section\"\non = \"sin(w*t)\"\ndirection = \"falling\"\nx = \"x\"\ny = \"x'\"\n\
                [run]\nuntil = 100.0\n";
    let app = opened(text, &[("orbit", "orbit")]);
    let lab = app.lab.as_ref().unwrap();
    let plot = &lab.plots[0];
    let across = plot.kind.across(lab.context(plot, &lab.present().unwrap()));
    let Across::Channel(_, Some([low, high])) = across else { panic!("{across:?}") };
    // where it settles: −(1 − ω²)/((1 − ω²)² + 4 γ² ω²)
    assert!(low < -1.49 && high > 0.5, "{low} {high}");
}

/// A kicked rotor has fixed points of its return map, and cycles of two: p T = 2π m/n.
#[test]
fn cycles_of_the_standard_map_have_their_points() {
    let text = |theta: f64, p: f64| {
        format!(
            "title = \"rotor\"\n[coordinates]\ntheta = {{ initial = {theta}, momentum = {p}, period = \"2*pi\" }}\n\
             [hamiltonian]\nH = \"1/2*p_theta^2\"\n[[impulses]]\nname = \"kick\"\nevery = \"1\"\n\
             change = {{ p_theta = \"0.5*sin(theta)\" }}\n[[views]]\nkind = \"section\"\non = \"sin(2*pi*t)\"\n\
             direction = \"falling\"\nx = \"theta\"\ny = \"p_theta\"\n[run]\nuntil = 100.0\n"
        )
    };
    // θ → θ + p, p → p + K sin θ: from (0, π) to (π, π) and back
    let app = opened(&text(0.02, PI - 0.01), &[("orbit", "orbit")]);
    let mut points = marked(&app);
    assert_eq!(points.len(), 2, "{points:?}");
    points.sort_by(|a, b| a.0[0].rem_euclid(TAU).total_cmp(&b.0[0].rem_euclid(TAU)));
    // half way between two kicks
    for (([theta, p], _), at) in points.into_iter().zip([0.5 * PI, 1.5 * PI]) {
        assert!((theta.rem_euclid(TAU) - at).abs() < 1e-9 && (p - PI).abs() < 1e-9, "{theta} {p}");
    }
}

/// The orbits x = 0 of ½ p² + ½ y² + ¼ y⁴ have their greatest y where p_y falls through zero; ½ y² + ¼ y⁴ is their energy.
#[test]
fn a_family_is_a_curve_through_the_section() {
    let text = "title = \"one\"\n[coordinates]\nx = { initial = 0.0, momentum = 0.0 }\ny = { initial = 0.5, momentum = 0.0 }\n\
                [hamiltonian]\nH = \"1/2*(p_x^2 + p_y^2) + 1.2*x^2 + 1/2*y^2 + 1/4*y^4\"\n\
                [[views]]\nkind = \"section\"\non = \"p_y\"\ndirection = \"falling\"\nx = \"y\"\ny = \"energy\"\n\
                [run]\nuntil = 100.0\n";
    let app = opened(text, &[("family", "family of orbits: y"), ("orbit", "orbit")]);
    let lines: Vec<_> = layers(&app)
        .into_iter()
        .filter_map(|layer| match layer {
            Layer::Line(points, _) => Some(points),
            _ => None,
        })
        .collect();
    assert_eq!(lines.len(), 1, "{lines:?}");
    assert!(lines[0].len() > 30);
    for [y, energy] in &lines[0] {
        assert!((0.5 * y * y + 0.25 * y.powi(4) - energy).abs() < 1e-7, "{y} {energy}");
    }
    // the orbit itself, at the energy of the motion, is marked once, though it has a picture of its own
    let points = marked(&app);
    assert_eq!(points.len(), 1, "{points:?}");
    assert!((points[0].0[0] - 0.5).abs() < 1e-9, "{points:?}");
    let named = layers(&app)
        .into_iter()
        .any(|layer| matches!(layer, Layer::Name(_, name) if name == "family"));
    assert!(named);
}
