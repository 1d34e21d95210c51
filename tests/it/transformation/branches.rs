//! Branches of a map that has several images: where they lead, and what is said where they do not.

use phaselab::app::App;
use phaselab::instrument::{Layer, Picture, Sign};

use super::plots;
use crate::hand::{lab, press};

/// P of p = P − h q P²/(1 + q²)² + h q has two roots; the second passes through infinity at q = 0, where its branch ends.
#[test]
fn a_branch_that_does_not_lead_to_the_point_has_no_ring() {
    let [right, left] = [2.0, 3.0].map(|time| {
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
        let (mut rings, mut words) = (Vec::new(), Vec::new());
        for (_, layer) in layers {
            match layer {
                Layer::Point(at, Sign::Ring, _) => rings.push(at),
                Layer::Legend(lines) => words = lines,
                _ => {}
            }
        }
        (rings, words)
    };
    let (rings, words) = drawn(&right);
    // t = 2: the greater root of the quadratic, and Q = q + h P/(1 + q²)
    let (q, p) = (0.508_378_956_371_997_5_f64, -0.772_221_423_796_494_8_f64);
    let a = q / (1.0 + q * q).powi(2);
    let root = (1.0 + (1.0 + 4.0 * a * (q - p)).sqrt()) / (2.0 * a);
    assert_eq!(rings.len(), 1, "{words:?}");
    assert!((rings[0][1] - root).abs() < 1e-8, "{rings:?} has not {root}");
    assert!((rings[0][0] - (q + root / (1.0 + q * q))).abs() < 1e-8, "{rings:?}");
    assert!(words.contains(&"ring, dim grid: the other branch".to_owned()), "{words:?}");
    let (rings, words) = drawn(&left);
    assert!(rings.is_empty());
    let said = "dim grid: the other branch, which does not lead to here".to_owned();
    assert!(words.contains(&said), "{words:?}");
}
