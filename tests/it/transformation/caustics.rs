//! Where the mark of a caustic stands on the portrait: at det ∂²F/∂old∂new = 0, against the closed form.

use phaselab::app::{App, HitTarget};
use phaselab::instrument::Plot;
use phaselab::view::hit_test;
use ratatui::layout::Rect;

use crate::fixtures::catalog;
use crate::laboratory::{open, prepared, see};
use crate::screen::{rich, screen};

const SIZE: (u16, u16) = (200, 60);

/// The cells of the phase plane with a diamond, each with its centre and half its size in the units of the axes.
fn diamonds(app: &App) -> Vec<([f64; 2], [f64; 2])> {
    let plots: Vec<&Plot> = app.lab.as_ref().unwrap().plots.iter().collect();
    let wanted = plots.iter().position(|plot| plot.kind.name() == "phase").expect("a plot");
    let buffer = screen(app, &rich(), SIZE);
    let at = |x: u16, y: u16| {
        let area = Rect::new(0, 0, SIZE.0, SIZE.1);
        match hit_test(app, &rich(), area, x, y) {
            Some(HitTarget::Plot { index, at, .. }) if index == wanted => Some(at),
            _ => None,
        }
    };
    let mut found = Vec::new();
    for y in 0..SIZE.1 {
        for x in 0..SIZE.0 {
            if buffer[(x, y)].symbol() != "◆" {
                continue;
            }
            // the heading has one too
            let Some((middle, beside, below)) =
                at(x, y).and_then(|here| Some((here, at(x + 1, y)?, at(x, y + 1)?)))
            else {
                continue;
            };
            let half = [0.5 * (beside[0] - middle[0]).abs(), 0.5 * (below[1] - middle[1]).abs()];
            found.push((middle, half));
        }
    }
    found
}

/// H = p²/(2(1 + q²)) + ½ q² and F₂ = q P + h H(q, P): on the orbit of energy E the two roots P meet where p = h q +
/// (1 + q²)²/(4 h q), which is det ∂²F/∂q∂P = 0, and p² = (1 + q²)(2 E − q²).
#[test]
fn a_caustic_is_marked_where_the_roots_meet() {
    let (h, energy): (f64, f64) = (1.5, 1.0 / (2.0 * 1.81) + 0.405);
    let square = |q: f64| (1.0 + q * q) * (1.0 + q * q);
    let momentum = |q: f64| h * q + square(q) / (4.0 * h * q);
    let off = |q: f64| momentum(q).powi(2) - (1.0 + q * q) * (2.0 * energy - q * q);
    let root = |mut a: f64, mut b: f64| {
        assert!(off(a) * off(b) < 0.0, "{a}: {}, {b}: {}", off(a), off(b));
        for _ in 0..200 {
            let middle = 0.5 * (a + b);
            if off(a) * off(middle) <= 0.0 { b = middle } else { a = middle }
        }
        a
    };
    // the orbit crosses the curve on both sides of where that turns
    let places = [root(-0.12, -0.3), root(-0.3, -0.48)].map(|q| [q, momentum(q)]);
    let (mut app, mut experiment) = open(prepared(&catalog().find("two-roots").unwrap().text));
    assert!(diamonds(&app).is_empty());
    see(&mut app, &mut experiment, 3.0);
    assert!(diamonds(&app).is_empty(), "none before the caustic");
    see(&mut app, &mut experiment, 3.6);
    let within = |([x, y], [half_x, half_y]): ([f64; 2], [f64; 2]), place: [f64; 2]| {
        (x - place[0]).abs() <= 1.001 * half_x && (y - place[1]).abs() <= 1.001 * half_y
    };
    let seen = diamonds(&app);
    assert_eq!(seen.len(), 2, "{seen:?}, {places:?}");
    for place in places {
        assert!(seen.iter().any(|&mark| within(mark, place)), "{place:?}: {seen:?}");
    }
}
