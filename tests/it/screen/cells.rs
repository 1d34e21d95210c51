//! One character in a cell: no terminal, multiplexer or player can then lose a row.

use std::sync::Arc;

use phaselab::app::{App, Event};
use phaselab::view::RenderStyle;
use phaselab::view::colour::ColourDepth;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::{PALETTES, Theme};
use unicode_width::UnicodeWidthStr;

use super::screen;
use crate::hand::{catalog, loaded, press, snapshot};

/// Pages and pop-ups, and how they are reached from a lab that was just opened.
const PAGES: [&str; 8] = ["", "2", "3", "4", "9", "?", ":", "Enter"];

/// What is wrong with the cells of every page of a system.
fn wrong(name: &str, look: &RenderStyle) -> Vec<String> {
    let loaded = loaded(name, 1);
    let seen = Arc::new(snapshot(&loaded, 1.0));
    let mut wrong = Vec::new();
    for page in PAGES {
        let (mut app, _) = App::new(catalog(), Some(name));
        app.themes = PALETTES.iter().map(|palette| (palette.name, palette.about)).collect();
        app.update(Event::Loaded(Ok(loaded.clone())));
        app.update(Event::Snapshot(seen.clone()));
        press(&mut app, page);
        let buffer = screen(&app, look, (150, 60));
        let odd = buffer.content.iter().map(ratatui::buffer::Cell::symbol);
        let odd = odd.filter(|symbol| symbol.chars().count() != 1 || symbol.width() != 1);
        wrong.extend(odd.map(|symbol| format!("{name}, {page:?}: {symbol:?}")));
    }
    wrong
}

#[test]
fn every_cell_of_every_preset_holds_one_character_of_one_column() {
    let theme = Theme::dark(ColourDepth::True);
    for glyphs in [Glyphs::Braille, Glyphs::Ascii] {
        let look = RenderStyle { theme: theme.clone(), glyphs };
        let names = catalog().entries();
        assert!(names.len() > 50);
        let wrong: Vec<String> = names.iter().flat_map(|entry| wrong(&entry.name, &look)).collect();
        assert!(wrong.is_empty(), "{wrong:#?}");
    }
}

#[test]
fn rates_have_primes_and_words_keep_their_letters() {
    let check = |text: &str, shown: &str| assert_eq!(Glyphs::Braille.text(text), shown);
    check("θ\u{307}₁² − 2 ẋ₂ θ\u{308}", "θ₁′² − 2 x₂′ θ″");
    check("ẋ = p/m", "x′ = p/m");
    check("Różycki, Ÿ", "Różycki, Ÿ");
    check("e\u{301}", "e");
    assert_eq!(Glyphs::Ascii.text("θ\u{307}₁"), "theta1'");
}
