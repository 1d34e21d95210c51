//! Branches of a map that has several images: where they lead, and what is said where they do not.

use phaselab::app::App;
use phaselab::instrument::{Layer, Picture, Sign};

use super::{Course, plots, shown};
use crate::hand::{lab, press};

/// P of p = P − h q P²/(1 + q²)² + h q has two roots; the second passes through infinity at q = 0, where its branch ends.
#[test]
fn a_branch_that_does_not_lead_to_the_point_has_no_ring() {
    let [right, left] = [2.0, 5.0].map(|time| {
        let mut app = lab("two-roots", time);
        press(&mut app, "Wait");
        app
    });
    let plot = &plots(&right)[0];
    // the branches that were found at q > 0, and the point of either motion
    let drawn = |app: &App| {
        let known = right.lab.as_ref().expect("a lab").answer(plot);
        let present = app.lab.as_ref().expect("a lab").present().expect("a motion");
        let picture = plot.kind.picture(plot, &present, [0.0, 1.0], known);
        let Some(Picture::Axes { layers, .. }) = picture else { panic!("it has axes") };
        let (mut rings, mut points, mut words) = (Vec::new(), Vec::new(), Vec::new());
        for (_, layer) in layers {
            match layer {
                Layer::Point(at, Sign::Ring, _) => rings.push(at),
                Layer::Point(at, Sign::Disc, _) => points.push(at),
                Layer::Legend(lines) => words = lines,
                _ => {}
            }
        }
        (rings, points, words)
    };
    let (rings, points, words) = drawn(&right);
    assert_eq!((rings.len(), points.len()), (1, 1), "{words:?}");
    // Q = q + h P/(1 + q²) of both, and the sum of the roots of the quadratic, (1 + q²)²/(h q)
    let h = 1.5;
    let ([ring, other], [point, own]) = (rings[0], points[0]);
    let square = h * (other - own) / (ring - point);
    let q = (square - 1.0).sqrt();
    assert!((point - h * own / square - q).abs() < 1e-8, "{rings:?}, {points:?}");
    assert!((own + other - square * square / (h * q)).abs() < 1e-8, "{rings:?}, {points:?}");
    assert!(words.contains(&"ring, dim grid: the other branch".to_owned()), "{words:?}");
    let (rings, _, words) = drawn(&left);
    assert!(rings.is_empty());
    let said = "dim grid: the other branch, which does not lead to here".to_owned();
    assert!(words.contains(&said), "{words:?}");
}

/// Where 1 + 4 h q (h q − p)/(1 + q²)² is negative the quadratic for P has no root: that is told in both views, by every map
/// that a generating function makes, also if it can be written down; before and after it there is an image.
#[test]
fn a_caustic_is_told_and_stepped_over() {
    let said = "no image: a caustic, det ∂²F/∂old∂new = 0";
    let mut course = Course::with(&crate::hand::catalog().find("two-roots").unwrap().text);
    for (time, beyond) in [(3.0, false), (3.3, true), (3.5, false), (7.3, true)] {
        course.go(time);
        let mut plot = plots(&course.app)[0].clone();
        for active in [false, true] {
            plot.viewport_mut().expect("it has axes").active = active;
            let (_, words) = shown(&course.app, &plot);
            assert_eq!(words.iter().any(|line| line == said), beyond, "at {time}: {words:?}");
        }
    }
}
