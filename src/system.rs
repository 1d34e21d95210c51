//! A compiled system: from here on there are only numbers.
//!
//! In: a [`Model`](crate::model::Model), the [`Equations`](crate::mechanics::Equations) that
//! follow from it, and expressions to be watched. Out: a [`System`], which makes initial states
//! ([`System::initial`]), carries them through a change of parameters
//! ([`System::change_parameters`]), tells what can be seen of them ([`System::observer`]) and
//! gives the steppers of `integrate` their equations of motion. Never here: steps in time, files,
//! symbols after compiling.

mod attitude;
mod beginning;
mod branch;
mod channel;
mod compiled;
mod conditions;
mod constrained;
mod exact;
mod fault;
mod hold;
mod jet;
mod kept;
mod legendre;
mod lower;
mod moments;
mod motion;
mod observe;
mod occasions;
mod program;
mod rates;
mod resolution;
mod series;
mod solve;
mod state;
mod terms;
mod value;
mod watch;

pub use branch::Branch;
pub use channel::{Channel, ChannelKind};
pub use compiled::{CompileError, System};
pub use constrained::{Directions, Keeper};
pub use exact::ExactRates;
pub use fault::{Fault, FaultKind, Passage};
pub use jet::{Jet, Side};
pub use observe::Observer;
pub use occasions::{Blow, Occasions, Schedule, Struck, Trigger, Triggers};
pub use program::{Program, Singular};
pub use rates::Rates;
pub use series::Series;
pub use state::{Form, Given, State};
pub use terms::TermWatch;
pub use value::Values;
