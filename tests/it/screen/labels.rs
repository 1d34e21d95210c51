//! Names and colours in the picture, and the words beside them: what a thing is must be readable off the screen.

use std::sync::Arc;

use phaselab::app::Event;
use phaselab::experiment::{Gauge, Growth, Verdict};
use phaselab::model::{Model, Shape};
use phaselab::view::RenderStyle;
use phaselab::view::glyphs::Glyphs;
use ratatui::buffer::Buffer;
use ratatui::style::Color;

use super::{rich, rows, screen};
use crate::hand::{catalog, gauge, in_lab, lab, loaded, press, snapshot};

/// The arrows of a picture in space, as their labels.
fn arrows(model: &Model) -> Vec<&str> {
    let shapes = model.space.iter();
    let labels = shapes.filter_map(|shape| match shape {
        Shape::Vector { label, .. } => Some(label.as_str()),
        _ => None,
    });
    labels.collect()
}

#[test]
fn every_arrow_of_the_shipped_presets_has_a_name() {
    let mut count = 0;
    for entry in catalog().entries() {
        let model = catalog().find(&entry.name).unwrap().read().unwrap().model;
        let labels = arrows(&model);
        assert!(labels.iter().all(|label| !label.is_empty()), "{}: {labels:?}", entry.name);
        count += labels.len();
    }
    assert!(count > 40, "{count} arrows were seen");
}

/// The places of the filled markers in this colour within the left-hand frame.
fn markers(buffer: &Buffer, colour: Option<Color>) -> Vec<(u16, u16)> {
    let cells = (1..24).flat_map(|y| (0..40).map(move |x| (x, y)));
    let alike = |&(x, y): &(u16, u16)| {
        let cell = &buffer[(x, y)];
        cell.symbol() == "●" && Some(cell.fg) == colour
    };
    cells.filter(alike).collect()
}

#[test]
fn masses_that_parameters_fix_leave_the_first_colour_to_what_moves() {
    let buffer = screen(&lab("two-centres", 1.0), &rich(), (120, 40));
    let places = [0, 1, 2].map(|curve| markers(&buffer, rich().theme.curve(curve).fg));
    let [planet, left, right] = &places;
    assert!([planet, left, right].iter().all(|one| one.len() == 1), "{places:?}");
    // the suns lie on the horizontal axis, the amber one on the left
    assert_eq!(left[0].1, right[0].1, "{places:?}");
    assert!(left[0].0 < right[0].0, "{places:?}");
}

#[test]
fn the_sun_is_amber_although_it_moves() {
    let shipped = loaded("solar-system", 1);
    let shapes = shipped.model.space.iter();
    let mut masses = shapes.filter_map(|shape| match shape {
        Shape::Mass { at, .. } => Some(shipped.model.pool.text(at[0])),
        _ => None,
    });
    assert_eq!(masses.nth(1).as_deref(), Some("x0"), "the second colour is the amber one");
    let buffer = screen(&lab("solar-system", 1.0), &rich(), (120, 40));
    let amber = rich().theme.curve(1).fg;
    let mut picture = (2..22).flat_map(|y| (1..38).map(move |x| (x, y)));
    assert!(picture.any(|at| Some(buffer[at].fg) == amber));
}

/// The residual of a constraint is no conserved quantity, and is not written twice.
#[test]
fn a_residual_is_called_a_residual() {
    let mut app = lab("pendulum-rod", 1.0);
    let name = loaded("pendulum-rod", 1).model.constraints[0].name.clone();
    let mut seen = snapshot(&loaded("pendulum-rod", 1), 1.0);
    let exact = Verdict::Exact(Growth::Level);
    let energy = gauge("energy", "E", 4.0, exact.clone());
    let residual = Gauge {
        initial: 0.0,
        reference: 0.0,
        drift: 3.25e-16,
        proved: false,
        reason: "λ_rod = 1.5 N/m, tension of the rod, with a sentence that no pane has room for"
            .into(),
        ..gauge(&name, &name, 3.25e-16, exact)
    };
    seen.gauges = [energy, residual].into();
    app.update(Event::Snapshot(Arc::new(seen)));
    let text = rows(&screen(&app, &rich(), (120, 40)));
    let at = text.iter().position(|row| row.contains(&format!("  {name} "))).unwrap();
    assert!(text[at].contains("residual") && text[at].contains(" exact "), "{text:#?}");
    assert!(!text[at].contains("conserved"), "{text:#?}");
    assert_eq!(text[at + 1].matches("10⁻¹⁶").count(), 1, "{text:#?}");
    assert_eq!(text.join("\n").matches("conserved (exact)").count(), 1, "that is the energy");
    press(&mut app, "4");
    let text = rows(&screen(&app, &rich(), (120, 100)));
    let row = text.iter().rfind(|row| row.contains(&format!("  {name} "))).unwrap();
    assert!(row.contains("  residual") && !row.contains("drift"), "{text:#?}");
}

/// The last hint says what `q` does now: it closes what lies on top, and leaves where nothing does.
#[test]
fn the_hint_for_q_says_what_it_does() {
    let mut app = in_lab();
    for (keys, word) in [("?", "q close"), ("q", "q quit"), ("T", "q close"), ("q", "q quit")] {
        press(&mut app, keys);
        let text = rows(&screen(&app, &rich(), (80, 24)));
        assert!(text[23].contains(word), "{keys}: {text:#?}");
    }
}

/// The names of the axes stand in the corner of the frame, beside what is drawn.
#[test]
fn the_triad_stands_in_the_corner() {
    for glyphs in [Glyphs::Braille, Glyphs::Ascii] {
        let look = RenderStyle { glyphs, ..rich() };
        let buffer = screen(&lab("heavy-top-body", 1.0), &look, (120, 40));
        let floor = (2..40).find(|&y| "╰+".contains(buffer[(0, y)].symbol()));
        let floor = floor.unwrap_or_else(|| panic!("{:#?}", rows(&buffer)));
        let row: String = (1..9).map(|x| buffer[(x, floor - 1)].symbol()).collect();
        assert!(row.trim_end().ends_with('x'), "{:#?}", rows(&buffer));
        assert_eq!(buffer[(2, floor - 3)].symbol(), "z", "{:#?}", rows(&buffer));
    }
}
