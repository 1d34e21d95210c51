//! The help: every key, from the table of key bindings.
//!
//! In: the table of key bindings. Out: a page of text. Never here: a key that is not in the table.

use super::RenderStyle;
use super::text_page::TextPage;
use crate::app::keymap::{Binding, KEYS, Place};

/// Builds the page; the active contexts come first.
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

/// The keys of a binding, as they are labelled on keyboards.
pub(super) fn keys(row: &Binding, look: &RenderStyle) -> String {
    named(&row.key_names().join(" "), look)
}

/// Names of keys, with words for the arrows if they cannot be drawn.
pub(super) fn named(keys: &str, look: &RenderStyle) -> String {
    const ARROWS: [(&str, &str); 4] = [("↑", "Up"), ("↓", "Down"), ("←", "Left"), ("→", "Right")];
    let spelt =
        || ARROWS.iter().fold(keys.to_owned(), |name, (sign, word)| name.replace(sign, word));
    if look.glyphs.is_ascii() { spelt() } else { keys.to_owned() }
}
