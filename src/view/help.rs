//! The help: every key, from the one table.
//!
//! In: the table of keys. Out: a page of text. Never here: a key that is not in the table.

use super::RenderStyle;
use super::text_page::TextPage;
use crate::app::keymap::{Binding, KEYS, Place};

/// The page; the places where keys hold now come first.
pub(super) fn document(look: &RenderStyle, active: &[Place]) -> TextPage {
    let mut page = TextPage::default();
    let (here, elsewhere): (Vec<Place>, Vec<Place>) =
        Place::ALL.into_iter().partition(|place| active.contains(place));
    for place in here.into_iter().chain(elsewhere) {
        page.heading(place.title());
        for row in KEYS.iter().filter(|row| row.place == place) {
            page.item(&keys(row, look), row.help);
        }
    }
    page
}

/// The keys of a row, as they are named on keyboards.
pub(super) fn keys(row: &Binding, look: &RenderStyle) -> String {
    let names: Vec<String> = row.keys.iter().map(ToString::to_string).collect();
    named(&names.join(" "), look)
}

/// Names of keys, the arrows as words where they cannot be drawn.
pub(super) fn named(keys: &str, look: &RenderStyle) -> String {
    const ARROWS: [(&str, &str); 4] = [("↑", "Up"), ("↓", "Down"), ("←", "Left"), ("→", "Right")];
    let spelt =
        || ARROWS.iter().fold(keys.to_owned(), |name, (sign, word)| name.replace(sign, word));
    if look.glyphs.is_ascii() { spelt() } else { keys.to_owned() }
}
