//! The search in the page of text that is shown: opened, continued with the next match, ended.
//!
//! In: keys, the number of matches that were drawn. Out: the [`PageSearch`]. Never here: where the matches are, or the pages.

use super::page_search::PageSearch;
use super::{App, Effect, Page};

impl App {
    /// Returns the search in the page of text that is shown.
    pub fn search_of_page(&self) -> Option<&PageSearch> {
        self.text.search.as_ref().filter(|_| self.overlay.is_none() && self.is_on_text())
    }

    /// The same, while words are typed.
    pub(super) fn typed_search(&mut self) -> Option<&mut PageSearch> {
        let shown = self.overlay.is_none() && self.is_on_text();
        self.text.search.as_mut().filter(|search| shown && search.typing)
    }

    /// Whether a page is shown that is searched.
    fn is_on_text(&self) -> bool {
        matches!(self.page, Page::Equations | Page::Notes | Page::Numbers) && self.lab.is_some()
    }

    /// Opens the search in the page that is shown, or reports where there is one.
    pub(super) fn search_page(&mut self) -> Vec<Effect> {
        if !self.is_on_text() || self.overlay.is_some() {
            return self.notify("There is nothing to search here.");
        }
        self.text.search =
            Some(PageSearch { typing: true, from: self.text.scroll, ..PageSearch::default() });
        Vec::new()
    }

    /// Brings the next match into view, or the one before.
    pub(super) fn next_match(&mut self, forwards: bool) -> Vec<Effect> {
        let count = self.drawn.matches;
        if self.search_of_page().is_none() {
            let here = self.overlay.is_none() && self.is_on_text();
            let sentence = if here {
                "/ searches the text first."
            } else {
                "There are no matches to go to here."
            };
            return self.notify(sentence);
        }
        if let Some(search) = self.text.search.as_mut().filter(|_| count > 0) {
            let by = if forwards { 1 } else { count - 1 };
            (search.place, search.seeks) = ((search.place.min(count - 1) + by) % count, true);
        }
        Vec::new()
    }

    /// Ends the search, and returns to where it began if its words are still being typed. Returns whether there was one.
    pub(super) fn end_page_search(&mut self) -> bool {
        let shown = self.search_of_page().is_some();
        let ended = self.text.search.take_if(|_| shown);
        if let Some(search) = ended.as_ref().filter(|search| search.typing) {
            self.text.scroll = search.from;
        }
        ended.is_some()
    }
}
