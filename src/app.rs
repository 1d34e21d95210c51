//! The application: what is on the screen and what a key means there.
//!
//! In: [`Event`]s. Out: [`Effect`]s, and the state that `view` draws. Pure: the same events give the same state.
//! Never here: a clock, a thread, a file, a terminal, or how anything looks.
//!
//! A key goes through [`keymap::KEYS`] to an [`Action`]; `perform` carries it out.

mod action;
mod buffer;
mod change;
mod choose;
mod edit;
mod editor;
mod event;
mod field;
mod fuzzy;
mod history;
mod hit_target;
mod impulse;
mod key;
pub mod keymap;
mod lab;
mod landscape;
mod menu;
mod mouse;
mod notification;
mod palette;
mod perform;
mod picker;
mod plot;
mod pointer;
mod potential;
mod prompt;
mod rate;
mod reading;
mod saved;
mod speed;
mod update;
mod value;
mod workbench;

pub use action::{Action, Axes, Direction};
pub use buffer::{Asking, BufferDiagnostic, SourceBuffer, State as SheetState, Unsaved};
pub use edit::{Checked, EditCommand, SaveError};
pub use editor::{Caret, Editor};
pub use event::{Drawn, Effect, Event, LoadError, Loaded};
pub use field::{Field, Purpose};
pub use fuzzy::Fit;
pub use hit_target::{Drag, HitTarget};
pub use key::{Code, Key};
pub use lab::{Lab, Pane, Selection};
pub use menu::{Choice, Choosing, Item, Menu};
pub use mouse::{Act, Mouse};
pub use notification::Notification;
pub use picker::Picker;
pub use plot::{CameraPose, Plot, Viewport};
pub use potential::Potential;
pub use prompt::Prompt;
pub use rate::RateMeter;
pub use reading::Reading;
pub use saved::{Quantity, Saved, SavedPlot};
pub use update::LONGEST_PASTE;
pub use value::{ValueId, ValueInfo};
pub use workbench::Workbench;

use serde::{Deserialize, Serialize};

use crate::experiment::Snapshot;
use crate::preset::Catalog;
use keymap::{CHAINS, Place};

/// The application's state.
#[derive(Clone, Debug)]
pub struct App {
    /// What is shown.
    pub page: Page,
    /// What lies over it.
    pub overlay: Option<Overlay>,
    /// The systems to choose from.
    pub picker: Picker,
    /// The loaded system, shown as a preview beside the picker.
    pub lab: Option<Lab>,
    /// What is reported in passing.
    pub notice: Option<Notification>,
    /// How fast things go.
    pub meter: RateMeter,
    /// Whether the terminal is to report the mouse; its own selection of text does not work meanwhile.
    pub mouse: bool,
    /// Whether time is held from outside, as that of a demo is.
    pub held: bool,
    /// Whether what is shown is being recorded.
    pub recording: bool,
    /// How many rows the page of text is scrolled down.
    pub scroll: u16,
    /// The files being edited, also while the editor is closed.
    pub workbench: Workbench,
    /// The themes there are, each with a line about it.
    pub themes: Vec<(&'static str, &'static str)>,
    /// The theme chosen, in place of the one phaselab was opened with.
    pub theme: Option<&'static str>,
    /// What is read on the page of plain reading.
    pub reading: Reading,
    /// What is to be reported after that.
    notifications: notification::NotificationQueue,
    /// What the mouse holds on to.
    pub hold: Option<Drag>,
    drawn: Drawn,
    /// The name last asked for, and whether the lab is to open once it is there.
    asked: Option<(String, bool)>,
    /// The session to go on with once its system is there.
    resuming: Option<Saved>,
    /// The session as it was when the lab was left for the list of systems.
    left: Option<Saved>,
}

/// A whole screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Page {
    /// The systems, and a preview of the selected one.
    Picker,
    /// The panes.
    Lab,
    /// What follows from L or H.
    Equations,
    /// What the file says about itself.
    PendingSignals,
    /// Every channel as a number.
    Numbers,
    /// All that is on the screen as lines of plain text, which keep still.
    Plain,
}

/// Something that lies over a page and takes its keys.
#[derive(Clone, Debug)]
pub enum Overlay {
    /// The keys.
    Help {
        /// How far the page below was scrolled.
        scroll: u16,
        /// Whether the editor lay there.
        editing: bool,
    },
    /// A text that must be read: what is wrong with a file.
    Message(LoadError),
    /// A pop-up list.
    Menu(Menu),
    /// A field.
    Field(Field),
    /// The prompt for brackets.
    Prompt(Prompt),
    /// The editor of the system's file, which lies on top of [`App::workbench`].
    Workbench,
}

impl App {
    /// The application at its start, and what is to be done first: load the system of a name, or the first preview.
    pub fn new(catalog: &Catalog, open: Option<&str>) -> (Self, Vec<Effect>) {
        let mut app = Self {
            page: Page::Picker,
            overlay: None,
            picker: Picker::new(catalog.entries().to_vec()),
            lab: None,
            notice: None,
            meter: RateMeter::default(),
            mouse: false,
            held: false,
            recording: false,
            scroll: 0,
            workbench: Workbench::default(),
            themes: Vec::new(),
            theme: None,
            reading: Reading::default(),
            notifications: notification::NotificationQueue::default(),
            hold: None,
            drawn: Drawn::default(),
            asked: None,
            resuming: None,
            left: None,
        };
        let first = match open {
            Some(name) => {
                app.picker.select(name);
                Some(name.to_owned())
            }
            None => app.picker.take(),
        };
        let effects = first.map(|name| app.ask(name, open.is_some()));
        (app, effects.into_iter().collect())
    }

    /// The newest snapshot of the loaded system.
    pub fn snapshot(&self) -> Option<&Snapshot> {
        self.lab.as_ref()?.snapshot.as_deref()
    }

    /// The name of what is being loaded.
    pub fn loading(&self) -> Option<&str> {
        self.asked.as_ref().map(|(name, _)| name.as_str())
    }

    /// Whether an action can do something with the loaded system; most always can.
    pub fn offers(&self, action: Action) -> bool {
        self.lack(action).is_none()
    }

    /// The theme to be shown: the one selected while they are chosen from, else the one chosen.
    pub fn theme_shown(&self) -> Option<&'static str> {
        let previewed = match &self.overlay {
            Some(Overlay::Menu(menu)) => menu.current().and_then(|(_, item)| match item.choice {
                Choice::Theme(index) => self.themes.get(index).map(|(name, _)| *name),
                _ => None,
            }),
            _ => None,
        };
        previewed.or(self.theme)
    }

    /// Whether text is being typed, so that a paste means something.
    pub fn is_typing(&self) -> bool {
        self.places().contains(&Place::Typing)
    }

    /// Where keys hold now, the innermost place first.
    pub fn places(&self) -> &'static [Place] {
        match &self.overlay {
            Some(Overlay::Help { .. } | Overlay::Message(_)) => {
                chain([Place::Text, Place::Anywhere])
            }
            Some(Overlay::Menu(Menu { filter: None, .. })) => chain([Place::Menu, Place::Anywhere]),
            Some(Overlay::Menu(_)) => chain([Place::Menu, Place::Typing]),
            Some(Overlay::Field(_) | Overlay::Prompt(_)) => chain([Place::Field, Place::Typing]),
            Some(Overlay::Workbench) => {
                let asks = self.workbench.top().is_some_and(|buffer| buffer.asking.is_some());
                let inner = if asks { Place::Field } else { Place::Workbench };
                chain([inner, Place::Typing])
            }
            None => self.places_below(),
        }
    }

    /// Where keys hold on the page, or in the editor, under the help that lies over it.
    pub fn places_below(&self) -> &'static [Place] {
        match self.overlay {
            Some(Overlay::Help { editing: true, .. }) => chain([Place::Workbench, Place::Typing]),
            _ => chain(self.places_of_page()),
        }
    }

    fn places_of_page(&self) -> [Place; 2] {
        match (self.page, &self.lab) {
            (Page::Picker, _) | (_, None) if self.picker.search.is_some() => {
                [Place::Search, Place::Typing]
            }
            (Page::Picker, _) | (_, None) => [Place::Picker, Place::Anywhere],
            (Page::Lab, Some(lab)) => match (lab.focus, lab.focused_plot()) {
                (_, Some((_, Plot::Space(_)))) => [Place::Space, Place::Lab],
                (Pane::Plot(_), _) => [Place::Plot, Place::Lab],
                (Pane::Parameters | Pane::Initial, _) => [Place::Values, Place::Lab],
                (Pane::Gauges, _) => [Place::Gauges, Place::Lab],
            },
            (Page::Equations | Page::PendingSignals | Page::Numbers, Some(_)) => {
                [Place::Text, Place::Experiment]
            }
            (Page::Plain, Some(_)) => [Place::Plain, Place::Experiment],
        }
    }
}

/// The chain of places that begins with these two.
fn chain(innermost: [Place; 2]) -> &'static [Place] {
    CHAINS.into_iter().find(|chain| chain.starts_with(&innermost)).unwrap_or_default()
}
