//! One character per cell, so that no terminal, multiplexer or player can misalign a row.

use phaselab::view::RenderStyle;
use phaselab::view::colour::ColourDepth;
use phaselab::view::glyphs::Glyphs;
use phaselab::view::theme::Theme;
use unicode_width::UnicodeWidthStr;

use super::screen;
use crate::fixtures::{catalog, lab, press};

/// Pages and pop-ups, as the keys that open them in a new lab.
const PAGES: [&str; 8] = ["", "2", "3", "4", "9", "?", ":", "Enter"];

/// The faulty cells on all pages of a system.
fn wrong(name: &str, looks: &[RenderStyle]) -> Vec<String> {
    let opened = lab(name, 1.0);
    let mut wrong = Vec::new();
    for page in PAGES {
        let mut app = opened.clone();
        press(&mut app, page);
        for look in looks {
            let buffer = screen(&app, look, (150, 60));
            let odd = buffer.content.iter().map(ratatui::buffer::Cell::symbol);
            let odd = odd.filter(|symbol| symbol.chars().count() != 1 || symbol.width() != 1);
            wrong.extend(odd.map(|symbol| format!("{name}, {page:?}: {symbol:?}")));
        }
    }
    wrong
}

#[test]
fn every_cell_of_every_preset_holds_one_character_of_one_column() {
    let theme = Theme::dark(ColourDepth::True);
    let looks =
        [Glyphs::Braille, Glyphs::Ascii].map(|glyphs| RenderStyle { theme: theme.clone(), glyphs });
    let names = catalog().entries();
    assert!(names.len() > 50);
    let wrong: Vec<String> = names.iter().flat_map(|entry| wrong(&entry.name, &looks)).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn rates_have_primes_and_words_keep_their_letters() {
    let check = |text: &str, shown: &str| assert_eq!(Glyphs::Braille.text(text), shown);
    check("θ\u{307}₁² − 2 ẋ₂ θ\u{308}", "θ₁′² − 2 x₂′ θ″");
    check("L\u{307}_x = ẋ_max L_y", "L_x′ = x_max′ L_y");
    check("ẋ = p/m", "x′ = p/m");
    check("Różycki, Ÿ", "Różycki, Ÿ");
    check("e\u{301}", "e");
    assert_eq!(Glyphs::Ascii.text("θ\u{307}₁"), "theta1'");
}
