//! The command palette: every action of the program, and everything that can be chosen or typed, by name.
//!
//! In: the table of keys, the loaded system, the catalog. Out: a menu; unavailable lines are listed with the
//! reason.
//! Never here: how a line is searched, drawn or carried out.

use super::keymap::{Binding, KEYS, KeyContext};
use super::{Action, App, Choice, Choosing, Effect, Item, Lab, Menu, Overlay, Pane, ValueId};
use crate::instrument::{INSTRUMENTS, Instrument, Offer, offers};
use crate::integrate::METHODS;
use crate::system::System;

impl App {
    pub(super) fn open_palette(&mut self) -> Vec<Effect> {
        // A choice applies to the page, not to the help above it.
        if let Some(Overlay::Help { scroll, .. }) = self.overlay {
            self.text.scroll = scroll;
        }
        self.overlay = None;
        let contexts = self.key_contexts_below();
        let rows = |wanted: fn(&Binding) -> bool| {
            // Actions on the motion come first, global ones last.
            let outer = contexts.iter().filter(|context| OUTER.contains(context));
            let inner = contexts.iter().filter(|context| !OUTER.contains(context)).rev();
            let contexts = inner.chain(outer);
            contexts.flat_map(move |context| {
                let of_context =
                    KEYS.iter().filter(move |row| row.context == *context && !repeats(row));
                of_context.filter(move |row| wanted(row))
            })
        };
        let often = rows(|row| !row.hint.is_empty() && !moves(row.action));
        let seldom = rows(|row| row.hint.is_empty() && !moves(row.action));
        let elsewhere = || {
            let rows = KEYS.iter().filter(|row| !contexts.contains(&row.context));
            rows.filter(|row| !repeats(row))
        };
        let near = |row: &&Binding| self.nearest(row.context).is_some();
        let line = |row: &Binding| self.line_of(row, None);
        let (mut items, refused): (Vec<Item>, Vec<Item>) =
            often.map(line).partition(|item| item.unavailable.is_none());
        if let Some(lab) = &self.lab {
            items.extend(lab.impulse_lines());
            items.extend(lab.value_lines());
        }
        items.extend(seldom.map(line));
        let nearby = elsewhere().filter(near).map(|row| self.line_nearby(row));
        let (nearby, moving): (Vec<Item>, Vec<Item>) = nearby.partition(|item| match item.choice {
            Choice::ActionAt(_, action) => !moves(action),
            _ => true,
        });
        items.extend(nearby);
        if let Some(lab) = &self.lab {
            items.extend(lab.pane_lines());
            items.extend(lab.picture_lines());
            items.extend(method_lines(&lab.loaded.system));
        }
        items.extend(self.theme_lines());
        items.extend(self.system_lines());
        items.extend(rows(|row| moves(row.action)).map(line));
        items.extend(moving);
        items.extend(refused);
        let far = elsewhere().filter(|row| !near(row));
        items.extend(far.map(|row| self.line_of(row, Some(where_active(row.context)))));
        self.overlay =
            Some(Overlay::Menu(Menu::new("What do you want to do?", Choosing::Action, items)));
        Vec::new()
    }

    /// The line of an action that is carried out in the nearest pane of its context.
    fn line_nearby(&self, row: &Binding) -> Item {
        let item = self.line_of(row, None);
        let name = match (self.nearest(row.context), &self.lab) {
            (Some(pane), Some(lab)) => lab.titled(pane),
            _ => return item,
        };
        Item {
            about: format!("{}: acts on {name}, which gets the focus", item.about),
            choice: Choice::ActionAt(row.context, row.action),
            ..item
        }
    }

    fn line_of(&self, row: &Binding, elsewhere: Option<&str>) -> Item {
        let unavailable = elsewhere.or_else(|| self.lack(row.action));
        Item {
            label: row.help.to_owned(),
            about: row.context.title().to_owned(),
            keys: row.key_names().join(" "),
            unavailable: unavailable.map(str::to_owned),
            choice: Choice::Action(row.action),
        }
    }

    /// Returns why an action has no effect on the loaded system, or `None` if it has one.
    pub fn lack(&self, action: Action) -> Option<&'static str> {
        if let (Action::Mark, Some(Overlay::Menu(menu))) = (action, &self.overlay) {
            return (!menu.takes_several()).then_some("only one line can be selected here");
        }
        if let (Action::Search, Some(Overlay::Message(_))) = (action, &self.overlay) {
            return Some("this page is not searched");
        }
        let lab = self.lab.as_ref()?;
        match action {
            Action::ApplyImpulse if lab.impulses().is_empty() => {
                Some("this system has no impulse that waits for a key")
            }
            Action::ApplyFlow
                if lab.flows().is_empty()
                    && !lab.may_have_symmetries()
                    && lab.loaded.model.generators.is_empty() =>
            {
                Some(
                    "no constants of the motion with a flow are known yet; page 2 searches for them",
                )
            }
            Action::Ramp if lab.loaded.model.parameters.is_empty() => {
                Some("this system has no parameters")
            }
            Action::ClearCompanions if lab.seen().is_some_and(|s| s.companions.is_empty()) => {
                Some("there are no motions beside the main one")
            }
            Action::Active if lab.with_other_way().is_none() => {
                Some("no picture here is of a transformation or of an action")
            }
            Action::VectorField if lab.with_vector_field().is_none() => {
                Some("no picture here is a phase portrait with a vector field")
            }
            Action::NextFrame if lab.loaded.model.frames.is_empty() => {
                Some("this system has no frames to look from")
            }
            _ => None,
        }
    }

    fn theme_lines(&self) -> impl Iterator<Item = Item> {
        self.themes.available.iter().enumerate().map(|(index, (name, about))| Item {
            label: format!("theme: {name}"),
            about: (*about).to_owned(),
            keys: String::new(),
            unavailable: None,
            choice: Choice::Theme(index),
        })
    }

    fn system_lines(&self) -> Vec<Item> {
        let open = self.lab.as_ref().filter(|_| self.page != super::Page::Picker);
        let open = open.map(|lab| lab.loaded.name.as_str());
        let entries = self.picker.entries.iter().enumerate();
        entries
            .map(|(index, entry)| Item {
                label: format!("open: {}", entry.info.title),
                about: format!("{} · {}", entry.name, entry.info.summary),
                keys: String::new(),
                unavailable: (open == Some(&entry.name)).then(|| "it is open".to_owned()),
                choice: Choice::System(index),
            })
            .collect()
    }

    /// Shows the pane of a value and opens the field for typing it.
    pub(super) fn type_into(&mut self, target: ValueId) -> Vec<Effect> {
        self.go(super::Page::Lab);
        if let Some(lab) = &mut self.lab {
            lab.choose(target);
        }
        self.handle_action(Action::TypeValue)
    }

    pub(super) fn show_pane(&mut self, pane: Pane) -> Vec<Effect> {
        self.go(super::Page::Lab);
        if let Some(lab) = &mut self.lab {
            lab.focus.pane = pane;
        }
        Vec::new()
    }

    pub(super) fn open_system(&mut self, index: usize) -> Vec<Effect> {
        let Some(name) = self.picker.entries.get(index).map(|entry| entry.name.clone()) else {
            return Vec::new();
        };
        self.picker.forget_search();
        self.picker.select(&name);
        self.open_selected()
    }
}

/// The contexts whose keys are active everywhere; their lines follow those of the page.
const OUTER: [KeyContext; 2] = [KeyContext::Anywhere, KeyContext::Always];

/// Whether an action only moves a selection or a window; nobody searches for such an action by name.
fn moves(action: Action) -> bool {
    use Action::{Change, First, Last, Move, PageDown, PageUp};
    matches!(action, Move(_) | First | Last | PageUp | PageDown | Change { .. })
}

/// Whether a row does what that of plots does, to the nearest of them.
fn repeats(row: &Binding) -> bool {
    row.action == Action::Cursor && row.context != KeyContext::Plot
}

/// Returns where the keys of a context are active, as a hint to a user who is elsewhere.
fn where_active(context: KeyContext) -> &'static str {
    match context {
        KeyContext::Always | KeyContext::Anywhere => "it works while no text is being typed",
        KeyContext::Picker => "it is for the list of systems, which Esc opens",
        KeyContext::Search => "it is for a search among the systems",
        KeyContext::Experiment => "it is for a system that is open",
        KeyContext::Lab => "it is for page 1, the lab",
        KeyContext::Space => "it is for a picture of the motion in space; Tab focuses one",
        KeyContext::Plot => "it is for a plot; Tab focuses one",
        KeyContext::Values => "it is for parameters or initial values; Tab focuses them",
        KeyContext::Gauges => "it is for the gauges; Tab focuses them",
        KeyContext::Law => "it is for the law of motion, if it is longer than its pane",
        KeyContext::Equations => "it is for page 2, the equations",
        KeyContext::Text => "it is for pages of text",
        KeyContext::Message => "it is for a file that cannot be opened",
        KeyContext::Help => "it is for the help, which ? opens",
        KeyContext::HelpSearch => "it is for a search in the help or a text, which / begins there",
        KeyContext::Plain => "it is for page 9, the plain reading",
        KeyContext::Menu => "it is for pop-up lists, as this one",
        KeyContext::Workbench => "it is for the editor of the system's file, which E opens",
        KeyContext::Field => "it is for a field in which a value is typed",
        KeyContext::Typing => "it is for fields in which text is typed",
    }
}

fn method_lines(system: &System) -> impl Iterator<Item = Item> {
    METHODS.iter().map(|method| Item {
        label: format!("method: {}", method.name),
        about: format!("{}. {}", method.title, method.about),
        keys: String::new(),
        unavailable: (method.fits)(system).err().map(|error| error.reason),
        choice: Choice::Method(method.name),
    })
}

impl Lab {
    pub(super) fn choose(&mut self, target: ValueId) {
        match target {
            ValueId::Parameter(index) => {
                (self.focus.pane, self.selection.parameter) = (Pane::Parameters, index);
            }
            ValueId::Initial(index) => {
                (self.focus.pane, self.selection.initial) = (Pane::Initial, index);
            }
        }
    }

    fn value_lines(&self) -> Vec<Item> {
        let parameters = (0..self.count(ValueId::Parameter)).map(ValueId::Parameter);
        let initial = (0..self.count(ValueId::Initial)).map(ValueId::Initial);
        let line = |target: ValueId| {
            let value_info = self.value_info(target)?;
            let what = match target {
                ValueId::Parameter(_) => "set",
                ValueId::Initial(_) => "set the initial",
            };
            let unit = if value_info.unit.is_empty() {
                String::new()
            } else {
                format!(" in {}", value_info.unit)
            };
            let (meaning, about) = match target {
                ValueId::Parameter(_) if !value_info.about.is_empty() => (
                    format!(", {}", value_info.about),
                    format!("{}, a parameter{unit}", value_info.name),
                ),
                _ => (String::new(), format!("{}: {}", value_info.name, value_info.about)),
            };
            Some(Item::plain(
                format!("{what} {}{meaning}", value_info.shown),
                about,
                Choice::Value(target),
            ))
        };
        parameters.chain(initial).filter_map(line).collect()
    }

    fn pane_lines(&self) -> Vec<Item> {
        let line = |pane: Pane| Item {
            label: format!("focus: {}", self.titled(pane)),
            about: "a pane of the lab".to_owned(),
            keys: String::new(),
            unavailable: None,
            choice: Choice::Pane(pane),
        };
        self.panes().map(line).collect()
    }

    /// Returns a line for each picture that a plot can show, with the name of its kind, and one for each kind of which this
    /// system has none.
    fn picture_lines(&self) -> Vec<Item> {
        let offered = offers(self.loaded.physics());
        let named = |kind: &str, label: &str| {
            let is_named = label.to_lowercase().contains(kind);
            if is_named { format!("show {label}") } else { format!("show {kind}: {label}") }
        };
        let line = |(index, (kind, offer)): (usize, &(&dyn Instrument, Offer))| {
            Item::plain(named(kind.name(), &offer.label), offer.about.clone(), Choice::Show(index))
        };
        let lacking = INSTRUMENTS.into_iter().map(Instrument::name);
        let lacking = lacking.filter(|name| !offered.iter().any(|(kind, _)| kind.name() == *name));
        let none = |name: &str| Item {
            unavailable: Some("this system has nothing that it could show".to_owned()),
            ..Item::plain(format!("show {name}"), "a kind of plot", Choice::Show(usize::MAX))
        };
        offered.iter().enumerate().map(line).chain(lacking.map(none)).collect()
    }

    pub(super) fn titled(&self, pane: Pane) -> String {
        format!("{}{}", self.kind_of(pane), self.name_of(pane))
    }

    /// Returns the name of a pane within a sentence: with an article where it is a common noun.
    pub(super) fn spoken(&self, pane: Pane) -> String {
        let named = self.titled(pane);
        match pane {
            Pane::Plot(_) if self.kind_of(pane).is_empty() => named,
            _ => format!("the {named}"),
        }
    }

    /// Returns the prefix of a pane's name if the name itself consists only of quantities.
    fn kind_of(&self, pane: Pane) -> &'static str {
        let plot = if let Pane::Plot(index) = pane { self.plots.get(index) } else { None };
        plot.map_or("", |plot| plot.kind.properties().lead)
    }

    /// Returns the name of a pane: its title, or the quantities it shows.
    pub fn name_of(&self, pane: Pane) -> String {
        let name = match pane {
            Pane::Plot(index) => {
                let plot = self.plots.get(index);
                return plot
                    .map_or_else(|| "nothing".to_owned(), |p| p.words(self.loaded.physics()));
            }
            Pane::Parameters => "parameters",
            Pane::Initial => "initial values",
            Pane::Gauges => "gauges",
            Pane::Law => "law of motion",
        };
        name.to_owned()
    }
}
