//! The search in a page of text: its matches are marked, counted, and brought into view one after the other.

use phaselab::app::AppEvent;
use ratatui::style::Modifier;

use super::{find, rich, rows};
use crate::app::real::Real;
use crate::fixtures::press;

/// Draws, and lets the application know what was drawn.
fn look(real: &mut Real, size: (u16, u16)) -> ratatui::buffer::Buffer {
    let (buffer, drawn) = super::drawn(&real.app, &rich(), size);
    real.app.update(AppEvent::Drawn(drawn));
    buffer
}

#[test]
fn a_page_of_text_is_searched() {
    let size = (80, 24);
    let mut real = Real::of("pendulum");
    real.press("3");
    look(&mut real, size);
    real.press("/");
    real.app.update(AppEvent::Paste("separatrix".to_owned()));
    let buffer = look(&mut real, size);
    let (x, y) = find(&buffer, "1 of ").unwrap_or_else(|| panic!("{:#?}", rows(&buffer)));
    assert!(x > 60 && y == 2, "{x} {y}");
    let marked = |buffer: &ratatui::buffer::Buffer| {
        let cells = buffer.content.iter().filter(|c| c.modifier.contains(Modifier::REVERSED));
        cells.map(ratatui::buffer::Cell::symbol).collect::<String>()
    };
    assert!(marked(&buffer).to_lowercase().contains("separatrix"), "{}", marked(&buffer));
    // n types a letter until Enter ends the typing
    real.press("Enter");
    look(&mut real, size);
    let places: Vec<u16> = (0..3)
        .map(|_| {
            real.press("n");
            look(&mut real, size);
            real.app.text.search.as_ref().expect("a search").place as u16
        })
        .collect();
    assert!(places.iter().any(|place| *place > 0), "{places:?}");
    press(&mut real.app, "Esc");
    assert!(real.app.text.search.is_none());
    let text = rows(&look(&mut real, size)).join("\n");
    assert!(!text.contains("1 of") && text.contains("Notes"), "{text}");
}

#[test]
fn the_next_match_is_brought_into_view_and_scrolling_leaves_it() {
    let size = (80, 24);
    let mut real = Real::of("heavy-top");
    real.press("2");
    look(&mut real, size);
    assert!(real.app.text.scroll == 0);
    real.press("n");
    let reported = real.app.notifications.shown.take().map(|n| n.text).unwrap_or_default();
    assert!(reported.contains("/ searches"), "{reported}");
    real.press("/");
    real.app.update(AppEvent::Paste("Hamiltonian".to_owned()));
    real.press("Enter");
    let mut seen = Vec::new();
    for _ in 0..12 {
        let text = rows(&look(&mut real, size));
        let text = rows(&look(&mut real, size)).into_iter().chain(text).collect::<Vec<_>>();
        assert!(text.iter().skip(3).any(|row| row.contains("Hamiltonian")), "{text:#?}");
        seen.push(real.app.text.scroll);
        real.press("n");
    }
    assert!(seen.iter().any(|scroll| *scroll > 0), "{seen:?}");
    real.press("N Home");
    look(&mut real, size);
    assert_eq!(real.app.text.scroll, 0);
    // a capital letter matches itself only
    real.press("/");
    real.app.update(AppEvent::Paste("HAMILTONIAN".to_owned()));
    let text = rows(&look(&mut real, size)).join("\n");
    assert!(text.contains("no match"), "{text}");
}
