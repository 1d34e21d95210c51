//! The running experiment: a system, a method and a recorder, synchronous and deterministic.
//!
//! In: a compiled [`System`], a [`Setup`] and [`Command`]s. Out: [`Snapshot`]s, cheap to clone.
//! Never here: threads, clocks, terminals.

mod attitude;
mod chronicle;
mod command;
mod course;
mod deviation;
mod export;
mod gauges;
mod law;
mod moment;
mod motion;
mod obey;
mod ready;
mod recorder;
mod reference;
mod residual;
mod setup;
mod snapshot;
mod trail;

pub use crate::analysis::{Growth, Verdict};
pub use chronicle::{Chronicle, Tally};
pub use command::Command;
pub use course::{Experiment, Progress};
pub use export::Export;
pub use moment::{Changed, Moment, Named, Past, Whereabouts};
pub use ready::{Derived, Ready, Unready};
pub use reference::Reference;
pub use setup::{NoMethod, Setup, choose_method, with_given};
pub use snapshot::{Fault, Gauge, MethodFact, Snapshot, Status};
pub use trail::Trail;
