//! Branches of a map that has several images: where they lead, and what is said where they do not.

use phaselab::app::App;
use phaselab::instrument::{Layer, MarkerShape, Picture, PlotContext, Upwards};

use super::{Course, plots, shown};
use crate::fixtures::{lab, press};

/// P of p = P − h q P²/(1 + q²)² + h q has two roots; the second passes through infinity at q = 0, where its branch ends.
#[test]
fn an_image_to_which_no_grid_leads_is_found() {
    let [right, left] = [2.0, 1.2].map(|time| {
        let mut app = lab("two-roots", time);
        press(&mut app, "Wait");
        app
    });
    let plot = &plots(&right)[0];
    // the branches that were found at q > 0, and the point of either motion
    let drawn = |app: &App| {
        let known = right.lab.as_ref().expect("a lab").answer(plot);
        let present = app.lab.as_ref().expect("a lab").present().expect("a motion");
        let context = PlotContext { plot, present: &present, answer: known };
        let picture = plot.kind.picture(context, [0.0, 1.0]);
        let Some(Picture::Axes { layers, .. }) = picture else { panic!("it has axes") };
        let (mut rings, mut points, mut words) = (Vec::new(), Vec::new(), Vec::new());
        for (_, layer) in layers {
            match layer {
                Layer::Point(at, MarkerShape::Ring, _) => rings.push(at),
                Layer::Point(at, MarkerShape::Disc, _) => points.push(at),
                Layer::Legend(lines) => words = lines,
                _ => {}
            }
        }
        (rings, points, words)
    };
    // Q = q + h P/(1 + q²) of both, and the sum of the roots of the quadratic, (1 + q²)²/(h q)
    let h = 1.5;
    let check = |rings: &[[f64; 2]], points: &[[f64; 2]], sign: f64| {
        let ([ring, other], [point, own]) = (rings[0], points[0]);
        let square = h * (other - own) / (ring - point);
        let q = sign * (square - 1.0).sqrt();
        assert!((point - h * own / square - q).abs() < 1e-8, "{rings:?}, {points:?}");
        assert!((own + other - square * square / (h * q)).abs() < 1e-8, "{rings:?}, {points:?}");
    };
    let (rings, points, words) = drawn(&right);
    assert_eq!((rings.len(), points.len()), (1, 1), "{words:?}");
    check(&rings, &points, 1.0);
    assert!(words.contains(&"ring, dim grid: the second branch".to_owned()), "{words:?}");
    // the second image is there also where the grids that are known do not lead
    let (rings, points, words) = drawn(&left);
    assert_eq!((rings.len(), points.len()), (1, 1), "{words:?}");
    check(&rings, &points, -1.0);
    let said = "ring: the second image".to_owned();
    assert!(words.contains(&said), "{words:?}");
}

/// Wherever the motion has an image it has two, but where q vanishes: as many as the quadratic has roots, of which each is
/// found, before and after the caustics.
#[test]
fn no_image_that_exists_is_denied() {
    let mut course = Course::with(&crate::fixtures::catalog().find("two-roots").unwrap().text);
    let h = 1.5;
    for step in 1..=40 {
        course.go(0.25 * f64::from(step));
        let plot = plots(&course.app)[0].clone();
        let lab = course.app.lab.as_ref().expect("a lab");
        let present = lab.present().expect("a motion");
        let at = |name: &str| {
            let channels = present.physics.system.channels();
            present.value(channels.iter().position(|c| c.name == name).expect("a channel"))
        };
        let (q, p) = (at("q"), at("p_q"));
        let under = 1.0 - 4.0 * h * q * (p - h * q) / (1.0 + q * q).powi(2);
        let picture = plot.kind.picture(lab.context(&plot, &present), [0.0, 1.0]);
        let Some(Picture::Axes { layers, .. }) = picture else { panic!("it has axes") };
        let rings: Vec<[f64; 2]> = layers
            .iter()
            .filter_map(|(_, layer)| match layer {
                Layer::Point(at, MarkerShape::Ring, _) => Some(*at),
                _ => None,
            })
            .collect();
        assert_eq!(rings.len(), usize::from(under > 0.0), "at {}: {under}", present.time);
        if let [[_, other]] = rings[..] {
            let far = (1.0 + q * q).powi(2) / (2.0 * h * q) * (1.0 + under.sqrt());
            assert!((other - far).abs() < 1e-8 * far.abs(), "{other} at {}", present.time);
        }
    }
}

/// Where 1 + 4 h q (h q − p)/(1 + q²)² is negative the quadratic for P has no root: that is reported in both views, by every map
/// that a generating function makes, also if it can be written down; before and after it there is an image.
#[test]
fn a_caustic_is_reported_and_stepped_over() {
    let said = "no image: beyond a caustic";
    let mut course = Course::with(&crate::fixtures::catalog().find("two-roots").unwrap().text);
    for (time, beyond) in [(3.0, false), (3.3, true), (3.5, false), (7.3, true)] {
        course.go(time);
        let mut plot = plots(&course.app)[0].clone();
        for active in [false, true] {
            plot.viewport_mut().expect("it has axes").active = active;
            let (_, words) = shown(&course.app, &plot);
            assert_eq!(words.iter().any(|line| line == said), beyond, "at {time}: {words:?}");
            // what comes last may have no room
            assert!(active || !beyond || words[0] == said, "at {time}: {words:?}");
        }
    }
}

/// What is drawn of the first view at a time: the range upwards, the rings, and the words.
fn drawn(course: &mut Course, time: f64) -> ([f64; 2], Vec<[f64; 2]>, Vec<String>) {
    course.go(time);
    let plot = plots(&course.app)[0].clone();
    let lab = course.app.lab.as_ref().expect("a lab");
    let present = lab.present().expect("a motion");
    let picture = plot.kind.picture(lab.context(&plot, &present), [0.0, 1.0]);
    let Some(Picture::Axes { upwards: Upwards::Channel(_, range), layers, .. }) = picture else {
        panic!("it has axes")
    };
    let (mut rings, mut words) = (Vec::new(), Vec::new());
    for (_, layer) in layers {
        match layer {
            Layer::Point(at, MarkerShape::Ring, _) => rings.push(at),
            Layer::Legend(said) => words = said,
            _ => {}
        }
    }
    (range.expect("a range"), rings, words)
}

/// Q = ±√(2p), P = −q Q + 1/3: both images are in the picture, and where p < 0 there are none.
/// P = p/q² has a pole at q = 0: the orbit is not drawn flat once it has passed there, and how far it was is reported.
#[test]
fn the_picture_holds_the_other_root_and_not_a_pole() {
    let file = |law: &str| {
        format!(
            "title = 't'\n[coordinates]\nq = {{ initial = 0.9, momentum = 0.4 }}\n[hamiltonian]\n\
             H = 'p_q^2/2 + q^2/2'\n[[transformations]]\nname = 'm'\n{law}\n\
             [[views]]\nkind = 'transformation'\nx = 'Q'\ny = 'P'\n"
        )
    };
    let mut roots = Course::with(&file("kind = 'F1'\nF = 'q*Q^2/2 - Q/3'"));
    for (time, exists) in [(0.1, true), (1.0, false), (4.5, true)] {
        let ([lo, hi], rings, words) = drawn(&mut roots, time);
        assert_eq!(rings.len(), usize::from(exists), "{time}: {words:?}");
        assert!(rings.iter().all(|ring| lo <= ring[1] && ring[1] <= hi), "{rings:?} {lo} {hi}");
    }
    let mut pole =
        Course::with(&file("kind = 'explicit'\nQ = { Q = 'q^3/3' }\nP = { P = 'p_q/q^2' }"));
    let ([lo, hi], _, words) = drawn(&mut pole, 9.0);
    assert!(hi - lo < 100.0 && lo < -1.0 && hi > 0.5, "{lo} {hi}");
    assert!(words.iter().any(|line| line.starts_with("outside of the picture: P")), "{words:?}");
}
