//! A pop-up list: methods, variables for an axis, or all actions.
//!
//! In: lines and what each stands for. Out: the line taken. Never here: what taking it does.

use tui_input::Input;

use super::action::Action;
use super::fuzzy::{Fit, Query, Texts};
use super::{Pane, ValueId};

/// A list from which one line, or several, can be taken.
#[derive(Clone, Debug)]
pub struct Menu {
    /// Its heading.
    pub title: String,
    /// What is chosen.
    pub purpose: Choosing,
    /// All lines.
    pub items: Vec<Item>,
    /// The search above the lines, where there is one.
    pub filter: Option<Input>,
    /// The selected line, counted among those shown.
    pub selected: usize,
    /// The lines marked besides, counted among all.
    pub marked: Vec<usize>,
}

/// What a list is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choosing {
    /// A method of integration.
    Method,
    /// Any action.
    Action,
    /// An impulse.
    Impulse,
    /// A theme.
    Theme,
    /// What runs along the axis of the plot of this index.
    Across {
        /// Its place among the plots.
        plot: usize,
    },
    /// What runs up its other axis; several against time.
    Upwards {
        /// Its place among the plots.
        plot: usize,
        /// The channel across, or time.
        x: Option<usize>,
    },
}

/// A line.
#[derive(Clone, Debug)]
pub struct Item {
    /// Its name.
    pub label: String,
    /// What it is, in a line.
    pub about: String,
    /// The keys that do the same, with spaces between them.
    pub keys: String,
    /// Why it cannot be taken here.
    pub refusal: Option<String>,
    /// What it stands for.
    pub choice: Choice,
}

/// What a line stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// The method of this name.
    Method(&'static str),
    /// An action.
    Action(Action),
    /// The impulse of this index.
    Impulse(usize),
    /// The picture in space.
    Space,
    /// The view of the file of this index.
    View(usize),
    /// Time.
    Time,
    /// A channel.
    Channel(usize),
    /// The system of this place in the catalog.
    System(usize),
    /// A value to be typed.
    Value(ValueId),
    /// A pane of the lab.
    Pane(Pane),
    /// The theme of this place among all.
    Theme(usize),
}

impl Menu {
    /// A list on its first line.
    pub fn new(title: impl Into<String>, purpose: Choosing, items: Vec<Item>) -> Self {
        let plain = matches!(purpose, Choosing::Method | Choosing::Impulse | Choosing::Theme);
        let filter = (!plain).then(Input::default);
        Self { title: title.into(), purpose, items, filter, selected: 0, marked: Vec::new() }
    }

    /// The list with the line of a choice selected.
    #[must_use]
    pub fn on(mut self, choice: Choice) -> Self {
        self.selected = self.items.iter().position(|item| item.choice == choice).unwrap_or(0);
        self
    }

    /// The places of the lines that fit what is typed, the best first, and how each fits.
    pub fn found(&self) -> Vec<(usize, Fit)> {
        let text = self.filter.as_ref().map_or("", Input::value);
        if text.trim().is_empty() {
            return (0..self.items.len()).map(|index| (index, Fit::default())).collect();
        }
        let query = Query::new(text);
        let lines = self.items.iter().enumerate();
        let fit = |item: &Item| {
            query.fit(Texts { label: &item.label, names: &[], about: &[&item.about] })
        };
        let mut found: Vec<(usize, Fit)> =
            lines.filter_map(|(index, item)| Some((index, fit(item)?))).collect();
        // Of equals what can be done comes first, and then the order of the list.
        found.sort_by_key(|(index, fit)| {
            let item = &self.items[*index];
            (item.refusal.is_some(), std::cmp::Reverse(fit.score))
        });
        found
    }

    /// The places of the lines that fit what is typed, the best first.
    pub fn shown(&self) -> Vec<usize> {
        self.found().into_iter().map(|(index, _)| index).collect()
    }

    /// The selected line.
    pub fn current(&self) -> Option<(usize, &Item)> {
        let index = *self.shown().get(self.selected)?;
        Some((index, &self.items[index]))
    }

    /// Moves the selection, stopping at the ends.
    pub fn step(&mut self, by: isize) {
        let last = self.shown().len().saturating_sub(1);
        self.selected = self.selected.saturating_add_signed(by).min(last);
    }

    /// Whether several lines may be taken.
    pub fn takes_several(&self) -> bool {
        matches!(self.purpose, Choosing::Upwards { x: None, .. })
    }

    /// Marks the selected line, or takes its mark away.
    pub fn mark(&mut self) {
        let Some((index, _)) = self.current().filter(|_| self.takes_several()) else { return };
        match self.marked.iter().position(|marked| *marked == index) {
            Some(place) => drop(self.marked.remove(place)),
            None => self.marked.push(index),
        }
    }

    /// The channels taken: those marked, and else the selected one.
    pub fn channels(&self) -> Vec<usize> {
        let current = self.current().map(|(index, _)| index);
        let taken = if self.marked.is_empty() {
            current.into_iter().collect()
        } else {
            self.marked.clone()
        };
        taken
            .into_iter()
            .filter_map(|index| match self.items[index].choice {
                Choice::Channel(channel) => Some(channel),
                _ => None,
            })
            .collect()
    }
}
