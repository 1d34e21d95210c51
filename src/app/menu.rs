//! A pop-up list: methods, variables for an axis, or all actions.
//!
//! In: lines and what each denotes. Out: the chosen line. Never here: the effect of a choice.

use tui_input::Input;

use super::action::Action;
use super::fuzzy::{FuzzyMatch, Query, Texts};
use super::keymap::KeyContext;
use super::synonyms::synonyms;
use super::{Pane, ValueId};
use crate::instrument::Plot;

/// A list from which one or more lines can be chosen.
#[derive(Clone, Debug)]
pub struct Menu {
    /// Its heading.
    pub title: String,
    /// What is chosen.
    pub purpose: Choosing,
    /// All lines.
    pub items: Vec<Item>,
    /// The search field above the lines, if there is one.
    pub filter: Option<Input>,
    /// The index of the selected line among those shown.
    pub selected: usize,
    /// The indices of additionally marked lines among all.
    pub marked: Vec<usize>,
    /// A partly specified plot, and its label in the list where it was begun.
    pub begun: Option<(Plot, String)>,
}

/// What a list is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choosing {
    /// A method of integration.
    Method,
    /// Any action.
    Action,
    /// Which one is applied.
    Impulse,
    /// The colours of the screen.
    Theme,
    /// A lesson or a demo.
    Guide,
    /// A constant of the motion or a symmetry whose flow is applied.
    Flow,
    /// Where a motion begins: at an equilibrium, or along a mode.
    Equilibrium,
    /// The contents of the plot of this index.
    Contents {
        /// Its index among the plots.
        plot: usize,
    },
    /// The quantity on the next axis of a partly specified plot.
    Axis {
        /// Its index among the plots.
        plot: usize,
        /// Whether the axis takes several quantities.
        several: bool,
    },
}

/// A line.
#[derive(Clone, Debug)]
pub struct Item {
    /// Its name.
    pub label: String,
    /// A one-line description.
    pub about: String,
    /// The keys with the same effect, separated by spaces.
    pub keys: String,
    /// Why it cannot be chosen at present.
    pub unavailable: Option<String>,
    /// What choosing it means.
    pub choice: Choice,
}

/// What a line denotes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// The method of this name.
    Method(&'static str),
    /// What a key would do.
    Action(Action),
    /// An action in the nearest pane of this context, which then has the focus.
    ActionAt(KeyContext, Action),
    /// The impulse of this index.
    Impulse(usize),
    /// The constant of the motion of this index among those that have a flow.
    Flow(usize),
    /// The generator of this index of the file.
    Generator(usize),
    /// One that is not in the file: a field asks for it.
    TypedGenerator,
    /// The symmetries of the equations of motion, which have flows, too.
    Symmetries,
    /// The symmetry of this index among those found.
    Symmetry(usize),
    /// The offer of this index, among all offers for a plot.
    Offer(usize),
    /// The same offer, in the nearest plot, which then has the focus.
    Show(usize),
    /// A quantity for an axis, by its index.
    Channel(usize),
    /// The system of this index in the catalog.
    System(usize),
    /// A value to be typed.
    Value(ValueId),
    /// A pane of the lab.
    Pane(Pane),
    /// The theme of this index among all.
    Theme(usize),
    /// The lesson or demo of this index among all.
    Guide(usize),
    /// The equilibrium of this index among those found.
    Equilibrium(usize),
    /// The mode of the second index of that equilibrium.
    Mode(usize, usize),
}

impl Item {
    /// A line that has no keys and can be chosen.
    pub(super) fn plain(
        label: impl Into<String>,
        about: impl Into<String>,
        choice: Choice,
    ) -> Self {
        let (label, about) = (label.into(), about.into());
        Self { label, about, keys: String::new(), unavailable: None, choice }
    }
}

impl Item {
    /// The action that it carries out, if it is one.
    fn action(&self) -> Option<Action> {
        match self.choice {
            Choice::Action(action) | Choice::ActionAt(_, action) => Some(action),
            _ => None,
        }
    }

    /// Whether its title, after the word for what is done with it, or its name begins with a text.
    fn is_called(&self, text: &str) -> bool {
        let text = text.trim().to_lowercase();
        let title = self.label.split_once(": ").map_or(&*self.label, |(_, title)| title);
        [title, &self.about].iter().any(|name| name.to_lowercase().starts_with(&text))
    }
}

impl Menu {
    /// Creates a list with its first line selected.
    pub fn new(title: impl Into<String>, purpose: Choosing, items: Vec<Item>) -> Self {
        let plain = matches!(
            purpose,
            Choosing::Impulse | Choosing::Theme | Choosing::Flow | Choosing::Equilibrium
        );
        let filter = (!plain).then(Input::default);
        Self {
            title: title.into(),
            purpose,
            items,
            filter,
            selected: 0,
            marked: Vec::new(),
            begun: None,
        }
    }

    /// Selects the line of a choice.
    #[must_use]
    pub fn on(mut self, choice: Choice) -> Self {
        self.selected = self.items.iter().position(|item| item.choice == choice).unwrap_or(0);
        self
    }

    /// Selects the line of a choice if there is one.
    #[must_use]
    pub fn at(self, choice: Option<Choice>) -> Self {
        match choice {
            Some(choice) => self.on(choice),
            None => self,
        }
    }

    /// Replaces the lines; the line that was moved to stays selected.
    pub(super) fn replace_items(&mut self, items: Vec<Item>) {
        let chosen = self.current().map(|(_, item)| item.choice).filter(|_| self.selected > 0);
        self.items = items;
        let available = |item: &Item| Some(item.choice) == chosen && item.unavailable.is_none();
        self.selected = self.items.iter().position(available).unwrap_or(0);
    }

    /// Returns the indices of the lines that match the search, best first, and how each matches.
    pub fn found(&self) -> Vec<(usize, FuzzyMatch)> {
        let text = self.filter.as_ref().map_or("", Input::value);
        if text.trim().is_empty() {
            return (0..self.items.len()).map(|index| (index, FuzzyMatch::default())).collect();
        }
        let mut query = Query::new(text);
        let lines = self.items.iter().enumerate();
        let mut fit = |item: &Item| {
            let names = item.action().map_or(&[][..], synonyms);
            query.fit(Texts { label: &item.label, names, about: &[&item.about] })
        };
        let mut found: Vec<(usize, FuzzyMatch)> =
            lines.filter_map(|(index, item)| Some((index, fit(item)?))).collect();
        // Opening another system leaves this one, so a system comes after what can be done here, unless it is called so.
        // Among equal matches, available lines come first, then the order of the list decides.
        found.sort_by_key(|(index, fit)| {
            let item = &self.items[*index];
            let leaves = matches!(item.choice, Choice::System(_)) && !item.is_called(text);
            (item.unavailable.is_some(), leaves, std::cmp::Reverse(fit.score))
        });
        // An action is listed once under its name, and what cannot be done here only if nothing of the same name or effect can.
        let mut listed: Vec<&Item> = Vec::new();
        found.retain(|(index, _)| {
            let item = &self.items[*index];
            let again = listed.iter().any(|other| {
                let acts = item.action().is_some() && other.action() == item.action();
                let named = other.label == item.label;
                acts && named || item.unavailable.is_some() && (acts || named)
            });
            listed.push(item);
            !again
        });
        found
    }

    /// Returns the indices of the lines that match the search, best first.
    pub fn shown(&self) -> Vec<usize> {
        self.found().into_iter().map(|(index, _)| index).collect()
    }

    /// Returns the selected line and its index.
    pub fn current(&self) -> Option<(usize, &Item)> {
        let index = *self.shown().get(self.selected)?;
        Some((index, &self.items[index]))
    }

    /// Moves the selection, stopping at the ends.
    pub fn step(&mut self, by: isize) {
        let last = self.shown().len().saturating_sub(1);
        self.selected = self.selected.saturating_add_signed(by).min(last);
    }

    /// Whether several lines may be chosen.
    pub fn takes_several(&self) -> bool {
        matches!(self.purpose, Choosing::Axis { several: true, .. })
    }

    /// Marks the selected line, or removes its mark.
    pub fn mark(&mut self) {
        let Some((index, _)) = self.current().filter(|_| self.takes_several()) else { return };
        match self.marked.iter().position(|marked| *marked == index) {
            Some(place) => drop(self.marked.remove(place)),
            None => self.marked.push(index),
        }
    }

    /// Returns the chosen channels: the marked ones, or else the selected one.
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
