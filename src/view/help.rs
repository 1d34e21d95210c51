//! The help: every key, from the one table.
//!
//! In: the table of keys. Out: a page of text. Never here: a key that is not in the table.

use unicode_width::UnicodeWidthStr;

use super::Look;
use super::document::Document;
use super::theme::Role;
use crate::app::keymap::{Binding, KEYS, Place};

/// Columns of the keys.
const KEYS_WIDE: usize = 18;

/// The page; the places where keys hold now come first.
pub(super) fn document(look: &Look, active: &[Place]) -> Document {
    let mut page = Document::default();
    let (here, elsewhere): (Vec<Place>, Vec<Place>) =
        Place::ALL.into_iter().partition(|place| active.contains(place));
    for place in here.into_iter().chain(elsewhere) {
        page.heading(place.title());
        for row in KEYS.iter().filter(|row| row.place == place) {
            let keys = keys(row, look);
            let gap = " ".repeat(KEYS_WIDE.saturating_sub(keys.width()));
            page.row(vec![
                (Role::Accent, format!("  {keys}{gap}")),
                (Role::Text, row.help.to_owned()),
            ]);
        }
    }
    page
}

/// The keys of a row, as they are named on keyboards.
pub(super) fn keys(row: &Binding, look: &Look) -> String {
    let named = |key: &crate::app::Key| {
        let name = key.to_string();
        let plain = [("↑", "Up"), ("↓", "Down"), ("←", "Left"), ("→", "Right")];
        let spelt = plain.iter().fold(name.clone(), |name, (sign, word)| name.replace(sign, word));
        look.glyphs.pick(name, spelt)
    };
    row.keys.iter().map(named).collect::<Vec<_>>().join(" ")
}
