//! The picker: which systems there are, which one is selected, and when its preview is to be loaded.
//!
//! In: the catalog, moves and searches. Out: the name of the system wanted. Never here: loading.

use std::cmp::Reverse;
use std::time::Duration;

use tui_input::Input;

use super::LoadError;
use super::fuzzy::{Fit, Query, Texts};
use crate::preset::Entry;

/// For how long a selection rests before its system is loaded.
const REST: Duration = Duration::from_millis(120);

/// The list of systems.
#[derive(Clone, Debug, Default)]
pub struct Picker {
    /// All systems, those of one topic together.
    pub entries: Vec<Entry>,
    /// What is searched for, while something is.
    pub search: Option<Input>,
    /// The selected system, counted among those shown.
    pub selected: usize,
    /// Why the preview of the selected system cannot be shown.
    pub failure: Option<LoadError>,
    waiting: Option<Duration>,
}

impl Picker {
    /// The systems of the catalog, in its order.
    pub fn new(entries: Vec<Entry>) -> Self {
        Self { entries, ..Self::default() }
    }

    /// The places of the systems that fit what is sought, the best first, and how each fits.
    pub fn found(&self) -> Vec<(usize, Fit)> {
        let Some(sought) = self.sought() else {
            return (0..self.entries.len()).map(|index| (index, Fit::default())).collect();
        };
        let query = Query::new(sought);
        let fit = |entry: &Entry| {
            let info = &entry.info;
            let mut about = vec![info.summary.as_str(), &info.source];
            about.extend(info.topics.iter().map(String::as_str));
            query.fit(Texts { label: &info.title, names: &[&entry.name], about: &about })
        };
        let entries = self.entries.iter().enumerate();
        let mut found: Vec<(usize, Fit)> =
            entries.filter_map(|(index, entry)| Some((index, fit(entry)?))).collect();
        found.sort_by_key(|(_, fit)| Reverse(fit.score));
        found
    }

    /// What is sought, if anything is.
    pub fn sought(&self) -> Option<&str> {
        self.search.as_ref().map(|input| input.value().trim()).filter(|text| !text.is_empty())
    }

    /// The places of the systems that fit what is sought, the best first.
    pub fn shown(&self) -> Vec<usize> {
        self.found().into_iter().map(|(index, _)| index).collect()
    }

    /// The selected system.
    pub fn current(&self) -> Option<&Entry> {
        self.shown().get(self.selected).map(|&index| &self.entries[index])
    }

    /// Selects the system of a name, if it is shown.
    pub fn select(&mut self, name: &str) {
        let place = self.shown().iter().position(|&index| self.entries[index].name == name);
        self.selected = place.unwrap_or(self.selected);
    }

    /// Moves the selection, stopping at the ends.
    pub fn step(&mut self, by: isize) {
        let last = self.shown().len().saturating_sub(1);
        let selected = self.selected.saturating_add_signed(by).min(last);
        if selected != self.selected {
            self.selected = selected;
            self.touch();
        }
    }

    /// Selects the system of a place among those shown.
    pub(super) fn point(&mut self, place: usize) {
        if place != self.selected && place < self.shown().len() {
            self.selected = place;
            self.touch();
        }
    }

    /// Changes the search, and selects the best that fits.
    pub fn search(&mut self, change: impl FnOnce(&mut Input)) {
        change(self.search.get_or_insert_default());
        self.selected = 0;
        self.touch();
    }

    /// Forgets the search; what was selected stays so.
    pub fn forget_search(&mut self) {
        let name = self.current().map(|entry| entry.name.clone());
        self.search = None;
        self.selected = 0;
        match name {
            Some(name) => self.select(&name),
            None => self.touch(),
        }
    }

    /// The selection has changed: its system is to be loaded once it rests.
    fn touch(&mut self) {
        (self.waiting, self.failure) = (Some(REST), None);
    }

    /// Time has passed: the system to be loaded now, if there is one.
    pub fn tick(&mut self, elapsed: Duration) -> Option<String> {
        let left = self.waiting?.saturating_sub(elapsed);
        self.waiting = (!left.is_zero()).then_some(left);
        let due = self.waiting.is_none();
        self.current().filter(|_| due).map(|entry| entry.name.clone())
    }

    /// The system to be loaded at once, without waiting for the selection to rest.
    pub fn take(&mut self) -> Option<String> {
        self.waiting = None;
        self.current().map(|entry| entry.name.clone())
    }
}
