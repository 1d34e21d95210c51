//! The application: what is on the screen and what a key means there.
//!
//! In: [`Event`]s. Out: [`Effect`]s, and the state that `view` draws. Pure: the same events give the same state.
//! Never here: a clock, a thread, a file, a terminal, or how anything looks.
//!
//! A key goes through [`keymap::KEYS`] to an [`Action`]; `perform` carries it out.

mod action;
mod change;
mod choose;
mod edit;
mod editor;
mod event;
mod field;
mod fuzzy;
mod history;
mod key;
pub mod keymap;
mod lab;
mod landscape;
mod menu;
mod meter;
mod mouse;
mod notice;
mod palette;
mod perform;
mod picker;
mod plot;
mod point;
mod potential;
mod prompt;
mod reading;
mod saved;
mod sheet;
mod speed;
mod spot;
mod state;
mod strike;
mod update;
mod value;
mod workbench;

pub use action::{Action, Axes, Way};
pub use edit::{Checked, NotSaved, Work};
pub use editor::{Caret, Editor};
pub use event::{Drawn, Effect, Event, LoadFailure, Loaded};
pub use field::{Field, Purpose};
pub use fuzzy::Fit;
pub use key::{Code, Key};
pub use lab::{Lab, Pane, Selection};
pub use menu::{Choice, Choosing, Item, Menu};
pub use meter::Meter;
pub use mouse::{Act, Mouse};
pub use notice::Notice;
pub use picker::Picker;
pub use plot::{Eye, Lens, Plot};
pub use potential::Potential;
pub use prompt::Prompt;
pub use reading::Reading;
pub use saved::{Quantity, Saved, SavedPlot};
pub use sheet::{Asking, Flaw, Sheet, State as SheetState, Unsaved};
pub use spot::{Hold, Spot};
pub use state::{App, Over, Page};
pub use update::LONGEST_PASTE;
pub use value::{Facts, Target};
pub use workbench::Workbench;
