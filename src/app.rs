//! The application: what is on the screen and what each key does there.
//!
//! In: [`Event`]s. Out: [`Effect`]s, and the state that `view` draws. Pure: the same events give the same state.
//! Never here: a clock, a thread, a file, a terminal, or how anything looks.
//!
//! A key is looked up in [`keymap::KEYS`], which gives an [`Action`]; `perform` carries it out.

mod action;
mod buffer;
mod change;
mod choose;
mod companions;
mod edit;
mod editor;
mod equilibria;
mod event;
mod field;
mod findings;
mod flow;
mod fuzzy;
mod history;
mod hit_target;
mod impulse;
pub mod key;
pub mod keymap;
mod lab;
mod mend;
mod menu;
mod nearest;
mod notification;
mod palette;
mod perform;
mod picker;
mod pointer;
mod prompt;
mod rate;
mod reading;
mod saved;
mod search;
mod side;
mod speed;
mod state;
mod timeline;
mod update;
mod value;
mod workbench;

pub use action::{Action, Axes, Direction};
pub use buffer::{Asking, BufferDiagnostic, SourceBuffer, State as SheetState, Unsaved};
pub use edit::{Checked, EditCommand, SaveError};
pub use editor::{Caret, Editor};
pub use event::{Drawn, DrawnPanes, Effect, Event, LawInView, LoadError, Loaded};
pub use field::{Field, Purpose};
pub use findings::{Findings, Search};
pub use fuzzy::Fit;
pub use hit_target::{Grab, HitTarget};
pub use lab::{Lab, Pane, Selection};
pub use menu::{Choice, Choosing, Item, Menu};
pub use notification::Notification;
pub use picker::Picker;
pub use prompt::Prompt;
pub use rate::RateMeter;
pub use reading::Reading;
pub use saved::Saved;
pub use side::{Asker, Computation, UnderWay};
pub use state::{App, Overlay, Page};
pub use update::LONGEST_PASTE;
pub use value::{ValueId, ValueInfo};
pub use workbench::Workbench;
