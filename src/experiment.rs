//! The running experiment: a system, a method and a recorder, synchronous and deterministic.
//!
//! In: a compiled [`System`](crate::system::System), a [`Setup`] and [`Command`]s. Out: [`Snapshot`]s, cheap to clone.
//! Never here: threads, clocks, terminals.

mod advance;
mod attitude;
mod checkpoint;
mod command;
mod companion;
mod companion_commands;
mod companions;
mod course;
mod deviation;
mod drift_watch;
mod echo;
mod event_log;
mod execute;
mod export;
mod found_constant;
mod gauges;
mod hull;
mod last_change;
mod law;
mod named;
mod observed_motion;
mod occurred;
mod past_step;
mod prepared;
mod recorder;
mod reference;
mod rerun;
mod residual;
mod restore;
mod returned;
mod reverse;
mod rewind;
mod row_spacing;
mod saved_companion;
mod scrub;
mod scrubbed;
mod setup;
mod snapshot;
mod step_log;
mod step_sampler;
mod trail;

pub use crate::analysis::{Growth, Verdict};
pub use advance::AdvanceOutcome;
pub use checkpoint::{Changed, Checkpoint, MotionState, Past};
pub use command::Command;
pub use companion::{Companion, CompanionOrigin};
pub use companions::MOST_COMPANIONS;
pub use course::Experiment;
pub use drift_watch::DriftWatch;
pub use event_log::{EventCount, EventLog};
pub use export::Export;
pub use found_constant::FoundConstant;
pub use hull::Hull;
pub use last_change::{LastChange, SavedChange};
pub use named::Named;
pub use prepared::{Derived, PrepareError, Prepared};
pub use reference::Reference;
pub use returned::Return;
pub use saved_companion::{OriginKind, SavedCompanion};
pub use setup::{MethodNotFound, Setup, choose_method, with_override};
pub use snapshot::{Failure, Gauge, MethodFact, Recorded, Snapshot, Status, energy_drift};
pub use trail::Trail;
