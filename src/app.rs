//! The application: what is on the screen and what each key does there.
//!
//! In: [`Event`]s. Out: [`Effect`]s, and the state that `view` draws. Pure: the same events give the same state.
//! Never here: a clock, a thread, a file, a terminal, or how anything looks.
//!
//! A key is looked up in [`keymap::KEYS`], which gives an [`Action`]; `perform` carries it out.

mod action;
mod answers;
mod buffer;
mod change;
mod choose;
mod companions;
mod computation;
mod diagram;
mod drawn;
mod edit;
mod editor;
mod equilibria;
mod event;
mod field;
mod findings;
mod flow;
mod fuzzy;
mod guide;
mod guide_list;
mod history;
mod hit_target;
mod impulse;
mod inquiry;
pub mod key;
pub mod keymap;
mod lab;
mod lab_value;
mod loaded;
mod mend;
mod menu;
mod nearest;
mod notification;
mod page;
mod palette;
mod pane;
mod pending;
mod perform;
mod picker;
mod plain;
mod pointer;
mod prompt;
mod rate;
mod reading;
mod saved;
mod search;
mod session;
mod side;
mod speed;
mod state;
mod symmetries;
mod timeline;
mod update;
mod value;
mod workbench;

pub use action::{Action, Axes, Direction, EditCommand};
pub use buffer::{Asking, BufferDiagnostic, SourceBuffer, State as SheetState, Unsaved};
pub use computation::{Asker, Computation, UnderWay};
pub use drawn::{Drawn, DrawnPanes, LawInView, PlotsInView};
pub use editor::{Caret, Editor};
pub use event::{Checked, Effect, Event, SaveError};
pub use field::{Field, Purpose};
pub use findings::{Findings, Search};
pub use fuzzy::Fit;
pub use guide::{Guide, GuideKind, Taken};
pub use hit_target::{Grab, HitTarget};
pub use lab::Lab;
pub use loaded::{LoadError, Loaded};
pub use menu::{Choice, Choosing, Item, Menu};
pub use notification::Notification;
pub use page::Page;
pub use pane::{Pane, Selection};
pub use picker::{Above, Picker};
pub use prompt::Prompt;
pub use rate::RateMeter;
pub use reading::Reading;
pub use saved::Saved;
pub use state::{App, Overlay};
pub use update::LONGEST_PASTE;
pub use value::{ValueId, ValueInfo};
pub use workbench::Workbench;
