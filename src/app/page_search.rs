//! A search in a page of text: words that are typed, and the match that is in view.
//!
//! In: nothing. Out: [`PageSearch`]. Never here: where the matches are, or the keys.

use tui_input::Input;

/// A search in the page of text that is shown.
#[derive(Clone, Debug, Default)]
pub struct PageSearch {
    /// What is searched for, with the cursor.
    pub input: Input,
    /// Whether it is being typed.
    pub typing: bool,
    /// Which of the matches is meant, counted from the first.
    pub place: usize,
    /// The first row that was in view before it.
    pub from: u16,
    /// Whether that match is to be in view: until the page is scrolled.
    pub seeks: bool,
}

impl PageSearch {
    /// Begins with the first match, since other words are searched for.
    pub(super) fn begin(&mut self) {
        (self.place, self.seeks) = (0, true);
    }
}
