//! The picker: the list of systems, the selected one, and when its preview is due to be loaded.
//!
//! In: the catalog, moves and searches. Out: the name of the system to load. Never here: loading.

use std::cmp::Reverse;
use std::path::Path;
use std::time::Duration;

use tui_input::Input;

use super::fuzzy::{FuzzyMatch, Query, Texts};
use super::{Guide, LoadError, Saved};
use crate::preset::CatalogEntry;

/// How long a selection must stay unchanged before its system is loaded.
const REST: Duration = Duration::from_millis(120);

/// The list of systems.
#[derive(Clone, Debug, Default)]
pub struct Picker {
    /// All systems, grouped by topic.
    pub entries: Vec<CatalogEntry>,
    /// The search field, while it is open.
    pub search: Option<Input>,
    /// The index of the selected system among those shown.
    pub selected: usize,
    /// The lessons and demos, lessons first.
    pub guides: Vec<Guide>,
    /// The index of the lesson or demo that was taken last.
    pub(super) last_guide: Option<usize>,
    /// Why the preview of the selected system cannot be shown.
    pub error: Option<LoadError>,
    /// The session that can be resumed from the row above the systems.
    session: Option<Saved>,
    /// The title of the unsaved text to which another row leads.
    pub(super) unsaved: Option<String>,
    /// The row above the systems that is selected.
    above: Option<Above>,
    waiting: Option<Duration>,
}

/// A row above the systems.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Above {
    /// It resumes a session.
    Session,
    /// It returns to a text that is not saved and that no session runs.
    Unsaved,
    /// It lists lessons and demos.
    Guides,
    /// It begins a system of one's own.
    NewSystem,
}

impl Picker {
    /// Creates the list from the catalog, in the catalog's order.
    pub fn new(entries: Vec<CatalogEntry>) -> Self {
        Self { entries, ..Self::default() }
    }

    /// Returns the indices of the systems that match the search, best first, and how each matches.
    pub fn found(&self) -> Vec<(usize, FuzzyMatch)> {
        let Some(pattern) = self.pattern() else {
            return (0..self.entries.len()).map(|index| (index, FuzzyMatch::default())).collect();
        };
        let mut query = Query::new(pattern);
        let mut fit = |entry: &CatalogEntry| {
            let info = &entry.info;
            let mut about = vec![info.summary.as_str(), &info.source];
            about.extend(info.topics.iter().map(String::as_str));
            query.fit(Texts { label: &info.title, names: &[&entry.name], about: &about })
        };
        let entries = self.entries.iter().enumerate();
        let mut found: Vec<(usize, FuzzyMatch)> =
            entries.filter_map(|(index, entry)| Some((index, fit(entry)?))).collect();
        // The system whose own name begins so comes first, and of several the one with the shortest name.
        let pattern = pattern.to_lowercase();
        let begins =
            |index: usize| pattern.len() > 2 && self.entries[index].name.starts_with(&pattern);
        let length = |index: usize| self.entries[index].name.len();
        found.sort_by_key(|(index, fit)| {
            let begins = begins(*index);
            (Reverse(begins), if begins { length(*index) } else { 0 }, Reverse(fit.score))
        });
        found
    }

    /// Returns the text searched for, if there is one.
    pub fn pattern(&self) -> Option<&str> {
        self.search.as_ref().map(|input| input.value().trim()).filter(|text| !text.is_empty())
    }

    /// Returns the indices of the systems that match the search, best first.
    pub fn shown(&self) -> Vec<usize> {
        self.found().into_iter().map(|(index, _)| index).collect()
    }

    /// Returns the session that can be resumed, if the search leaves its row there.
    pub fn session(&self) -> Option<&Saved> {
        self.session.as_ref().filter(|_| self.lists(Above::Session))
    }

    /// Returns the rows above the systems: of a search with words in it, those that one of its own words begins with them.
    pub fn above(&self) -> impl Iterator<Item = Above> {
        let session = self.session().map(|_| Above::Session);
        let guides = (!self.guides.is_empty()).then_some(Above::Guides);
        let unsaved = self.unsaved.as_ref().map(|_| Above::Unsaved);
        let all = session.into_iter().chain(unsaved).chain(guides).chain([Above::NewSystem]);
        all.filter(|row| self.lists(*row))
    }

    /// Whether a row above the systems fits the search.
    fn lists(&self, row: Above) -> bool {
        let Some(pattern) = self.pattern().map(str::to_lowercase) else { return true };
        let words: &[&str] = match row {
            Above::Session => &["continue", "resume"],
            Above::Unsaved => &["unsaved"],
            Above::Guides => &["lessons", "demos", "tour"],
            Above::NewSystem => &["new"],
        };
        pattern.len() > 2 && words.iter().any(|word| word.starts_with(&pattern))
    }

    /// Returns the title of the unsaved text to which a row leads.
    pub fn unsaved(&self) -> Option<&str> {
        self.unsaved.as_deref()
    }

    /// Returns the one of these rows that is selected.
    pub fn selected_above(&self) -> Option<Above> {
        self.above.filter(|selected| self.above().any(|row| row == *selected))
    }

    /// Returns the session while its row is selected.
    pub fn selected_session(&self) -> Option<&Saved> {
        self.session().filter(|_| self.above == Some(Above::Session))
    }

    /// Returns the title of the session's system: its own, or the name of its file.
    pub fn title_of(&self, session: &Saved) -> String {
        match self.entries.iter().find(|entry| entry.name == session.open) {
            Some(entry) => entry.info.title.clone(),
            None => Path::new(&session.open)
                .file_name()
                .map_or_else(|| session.open.clone(), |name| name.to_string_lossy().into_owned()),
        }
    }

    /// Offers a session above the systems, selected if `first`.
    pub(super) fn offer(&mut self, session: Saved, first: bool) {
        self.session = Some(session);
        if first {
            self.point_above(Above::Session);
        }
    }

    /// Selects a row above the systems, if it is there.
    pub(super) fn point_above(&mut self, row: Above) {
        if self.above().any(|one| one == row) && self.above != Some(row) {
            self.above = Some(row);
            self.touch();
        }
    }

    /// Whether the first system is selected, and nothing is searched for.
    pub(super) fn is_at_its_start(&self) -> bool {
        self.search.is_none() && self.is_selected(0)
    }

    /// Whether the system of this index among those shown is selected.
    pub fn is_selected(&self, place: usize) -> bool {
        self.selected == place && self.selected_above().is_none()
    }

    /// Returns the selected system; for a session, the one it is of, if that is in the catalog. A new one is none yet.
    pub fn current(&self) -> Option<&CatalogEntry> {
        match self.selected_above() {
            Some(Above::Session) => {
                let session = self.session()?;
                return self.entries.iter().find(|entry| entry.name == session.open);
            }
            Some(Above::Unsaved | Above::Guides | Above::NewSystem) => return None,
            None => {}
        }
        self.shown().get(self.selected).map(|&index| &self.entries[index])
    }

    /// Selects the system of a name, if it is shown.
    pub fn select(&mut self, name: &str) {
        let place = self.shown().iter().position(|&index| self.entries[index].name == name);
        self.selected = place.unwrap_or(self.selected);
        self.above = None;
    }

    /// Moves the selection, stopping at the ends.
    pub fn step(&mut self, by: isize) {
        let above: Vec<Above> = self.above().collect();
        let last = (self.shown().len() + above.len()).saturating_sub(1);
        let selected = self.selected_above();
        let row = above.iter().position(|row| Some(*row) == selected);
        let row = row.unwrap_or(self.selected + above.len());
        let to = row.saturating_add_signed(by).min(last);
        if to != row {
            self.above = above.get(to).copied();
            self.selected = to.saturating_sub(above.len());
            self.touch();
        }
    }

    /// Selects the system of this index among those shown.
    pub(super) fn point(&mut self, place: usize) {
        if !self.is_selected(place) && place < self.shown().len() {
            (self.above, self.selected) = (None, place);
            self.touch();
        }
    }

    /// Changes the search, and selects the best match.
    pub fn search(&mut self, change: impl FnOnce(&mut Input)) {
        change(self.search.get_or_insert_default());
        let best = if self.found().is_empty() { self.above().next() } else { None };
        (self.above, self.selected) = (best, 0);
        self.touch();
    }

    /// Closes the search; the selection stays.
    pub fn forget_search(&mut self) {
        if self.search.is_none() {
            return;
        }
        let name = self.current().map(|entry| entry.name.clone());
        self.search = None;
        self.selected = 0;
        match name {
            Some(name) => self.select(&name),
            None => self.touch(),
        }
    }

    /// Schedules the selected system for loading once the selection stays unchanged.
    fn touch(&mut self) {
        (self.waiting, self.error) = (Some(REST), None);
    }

    /// Advances the time. Returns the system that is now due to be loaded, if there is one.
    pub fn tick(&mut self, elapsed: Duration) -> Option<String> {
        let left = self.waiting?.saturating_sub(elapsed);
        self.waiting = (!left.is_zero()).then_some(left);
        let due = self.waiting.is_none();
        self.current().filter(|_| due).map(|entry| entry.name.clone())
    }

    /// Returns the system to load at once, without the delay.
    pub fn take(&mut self) -> Option<String> {
        self.waiting = None;
        self.current().map(|entry| entry.name.clone())
    }
}
