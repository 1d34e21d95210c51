//! The state of the user interface, as one value.
//!
//! In: the parts of this room. Out: an [`App`] and its queries. Never here: how it changes (`update`).

use tui_input::Input;

use super::action::Action;
use super::computation::Jobs;
use super::drawn::Drawn;
use super::event::Effect;
use super::field::InputField;
use super::hit_target::Grab;
use super::keymap::{CHAINS, KeyContext};
use super::lab::Lab;
use super::loaded::LoadError;
use super::menu::{Choice, Menu};
use super::notification::Notifications;
use super::page::{EquationsSection, Page};
use super::page_search::PageSearch;
use super::pane::Pane;
use super::pending::Awaited;
use super::picker::Picker;
use super::prompt::Prompt;
use super::rate::RateMeter;
use super::reading::Reading;
use super::saved::Saved;
use super::workbench::Workbench;
use crate::experiment::Snapshot;
use crate::preset::Catalog;

/// The application's state.
#[derive(Clone, Debug)]
pub struct App {
    /// The page shown.
    pub page: Page,
    /// The overlay above it.
    pub overlay: Option<Overlay>,
    /// The systems to choose from.
    pub picker: Picker,
    /// The loaded system, shown as a preview beside the picker.
    pub lab: Option<Lab>,
    /// The notification shown, and those that wait.
    pub notifications: Notifications,
    /// Frame and step rates.
    pub meter: RateMeter,
    /// The mouse.
    pub mouse: Mouse,
    /// Whether time is suspended from outside, as by a demo that pauses.
    pub suspended: bool,
    /// Whether the screen is being recorded.
    pub recording: bool,
    /// What of a page of text is in view.
    pub text: TextInView,
    /// The files being edited, also while the editor is closed.
    pub workbench: Workbench,
    /// What is shown below the panes.
    pub footer: Footer,
    /// The available themes, and the one chosen.
    pub themes: Themes,
    /// The state of the plain-reading page.
    pub reading: Reading,
    /// The background jobs requested.
    pub jobs: Jobs,
    pub(super) drawn: Drawn,
    pub(super) awaited: Awaited,
    /// The session as it was when the user left the lab for the list of systems.
    pub(super) left: Option<Saved>,
}

/// The mouse: whether it is used here, and what it drags.
#[derive(Clone, Debug, Default)]
pub struct Mouse {
    /// Whether the terminal reports it; the terminal's own text selection does not work meanwhile.
    pub is_reported: bool,
    /// What it drags.
    pub drag: Option<Grab>,
    /// Whether the motion that a drag has paused is to run again.
    pub(super) resumes: bool,
}

/// What of a page of text is in view.
#[derive(Clone, Debug, Default)]
pub struct TextInView {
    /// The number of rows by which the page is scrolled.
    pub scroll: u16,
    /// The section of the page of equations that is kept in view until the page is scrolled.
    pub section: Option<EquationsSection>,
    /// The search in the page.
    pub search: Option<PageSearch>,
}

/// What is shown below the panes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Footer {
    /// Whether the status and the keys are shown, which demos may leave out.
    pub shown: bool,
    /// What is said of the keys.
    pub hints: KeyHints,
}

/// The available themes, and the one chosen.
#[derive(Clone, Debug, Default)]
pub struct Themes {
    /// The names, each with a description.
    pub available: Vec<(&'static str, &'static str)>,
    /// The name chosen by the user, instead of the one at the start.
    pub chosen: Option<&'static str>,
}

impl Themes {
    pub(super) fn name(&self, index: usize) -> Option<&'static str> {
        self.available.get(index).map(|(name, _)| *name)
    }
}

/// What the footer says of the keys: never of one that does something else.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyHints {
    /// The keys are the lab's.
    Lab,
    /// The keys are the lab's within a lesson, which the key for quitting leaves.
    LabInLesson,
    /// The keys are a lesson's, which says itself which they are.
    Hidden,
    /// They are a lesson's too, and move the cursor of a plot.
    Cursor,
}

/// Something that covers a page and takes its keys.
#[derive(Clone, Debug)]
pub enum Overlay {
    /// The key help.
    Help {
        /// How far the page below was scrolled.
        scroll: u16,
        /// What was open below.
        below: Option<Box<Overlay>>,
        /// What is searched for among the keys, once a search was begun.
        search: Option<Input>,
        /// Whether the search is being typed.
        typing: bool,
    },
    /// A message that must be read: what is wrong with a file.
    Message(LoadError),
    /// A pop-up list.
    Menu(Menu),
    /// A line of input, with what is asked for.
    Field(InputField),
    /// The prompt for brackets.
    Prompt(Prompt),
    /// The editor of the system's file, which shows the top of [`App::workbench`].
    Workbench,
}

impl App {
    /// Creates the application, and returns its first effects: loading the named system, or the first preview.
    pub fn new(catalog: &Catalog, open: Option<&str>) -> (Self, Vec<Effect>) {
        let mut app = Self {
            page: Page::Picker,
            overlay: None,
            picker: Picker::new(catalog.entries().to_vec()),
            lab: None,
            notifications: Notifications::default(),
            meter: RateMeter::default(),
            mouse: Mouse::default(),
            suspended: false,
            recording: false,
            text: TextInView::default(),
            workbench: Workbench::default(),
            footer: Footer { shown: true, hints: KeyHints::Lab },
            themes: Themes::default(),
            reading: Reading::default(),
            jobs: Jobs::default(),
            drawn: Drawn::default(),
            awaited: Awaited::default(),
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

    /// Returns the newest snapshot of the loaded system.
    pub fn snapshot(&self) -> Option<&Snapshot> {
        self.lab.as_ref()?.snapshot.as_deref()
    }

    /// Returns the name of the system being loaded.
    pub fn loading(&self) -> Option<&str> {
        self.awaited.system.as_ref().map(|request| request.name.as_str())
    }

    /// Returns the name of the system being loaded, if the lab opens with it.
    pub fn opening(&self) -> Option<&str> {
        let request = self.awaited.system.as_ref().filter(|request| request.opens);
        request.map(|request| request.name.as_str())
    }

    /// Whether an action has an effect on the loaded system; most actions always do.
    pub fn offers(&self, action: Action) -> bool {
        self.lack(action).is_none()
    }

    /// Returns the theme to show: the one selected while the user is choosing, or else the chosen one.
    pub fn theme_shown(&self) -> Option<&'static str> {
        let previewed = match &self.overlay {
            Some(Overlay::Menu(menu)) => menu.current().and_then(|(_, item)| match item.choice {
                Choice::Theme(index) => self.themes.name(index),
                _ => None,
            }),
            _ => None,
        };
        previewed.or(self.themes.chosen)
    }

    /// Whether text is being typed, so that a paste is meaningful.
    pub fn is_typing(&self) -> bool {
        self.key_contexts().contains(&KeyContext::Typing)
    }

    /// Returns the active key contexts, innermost first.
    pub fn key_contexts(&self) -> &'static [KeyContext] {
        self.key_contexts_over(self.overlay.as_ref())
    }

    /// Returns the active key contexts while this lies over the page.
    fn key_contexts_over(&self, overlay: Option<&Overlay>) -> &'static [KeyContext] {
        match overlay {
            Some(Overlay::Help { typing: true, .. }) => {
                chain([KeyContext::HelpSearch, KeyContext::Typing])
            }
            Some(Overlay::Help { .. }) => chain([KeyContext::Help, KeyContext::Text]),
            Some(Overlay::Message(_)) => chain([KeyContext::Message, KeyContext::Text]),
            Some(Overlay::Menu(Menu { filter: None, .. })) => {
                chain([KeyContext::Menu, KeyContext::Anywhere])
            }
            Some(Overlay::Menu(_)) => chain([KeyContext::Menu, KeyContext::Typing]),
            Some(Overlay::Field(_) | Overlay::Prompt(_)) => {
                chain([KeyContext::Field, KeyContext::Typing])
            }
            Some(Overlay::Workbench) => {
                let asks = self.workbench.top().is_some_and(|buffer| buffer.asking.is_some());
                let inner = if asks { KeyContext::Field } else { KeyContext::Workbench };
                chain([inner, KeyContext::Typing])
            }
            None if self.search_of_page().is_some_and(|search| search.typing) => {
                chain([KeyContext::HelpSearch, KeyContext::Typing])
            }
            None => chain(self.key_contexts_of_page()),
        }
    }

    /// Returns the active key contexts of what is under the help: a prompt, the editor, or else the page.
    pub fn key_contexts_below(&self) -> &'static [KeyContext] {
        match &self.overlay {
            Some(Overlay::Help { below, .. }) => self.key_contexts_over(below.as_deref()),
            _ => self.key_contexts_over(None),
        }
    }

    fn key_contexts_of_page(&self) -> [KeyContext; 2] {
        match (self.page, &self.lab) {
            (Page::Picker, _) | (_, None) if self.picker.search.is_some() => {
                [KeyContext::Search, KeyContext::Typing]
            }
            (Page::Picker, _) | (_, None) => [KeyContext::Picker, KeyContext::Anywhere],
            (Page::Lab, Some(lab)) => match (lab.focus.pane, lab.focused_plot()) {
                (_, Some((_, plot))) if plot.kind.properties().is_scene => {
                    [KeyContext::Space, KeyContext::Lab]
                }
                (Pane::Plot(_), _) => [KeyContext::Plot, KeyContext::Lab],
                (Pane::Parameters | Pane::Initial, _) => [KeyContext::Values, KeyContext::Lab],
                (Pane::Gauges, _) => [KeyContext::Gauges, KeyContext::Lab],
                (Pane::Law, _) => [KeyContext::Law, KeyContext::Lab],
            },
            (Page::Equations, Some(_)) => [KeyContext::Equations, KeyContext::Text],
            (Page::Notes | Page::Numbers, Some(_)) => [KeyContext::Text, KeyContext::Experiment],
            (Page::Plain, Some(_)) => [KeyContext::Plain, KeyContext::Experiment],
        }
    }
}

/// Returns the chain of contexts that starts with these two.
fn chain(innermost: [KeyContext; 2]) -> &'static [KeyContext] {
    CHAINS.into_iter().find(|chain| chain.starts_with(&innermost)).unwrap_or_default()
}
