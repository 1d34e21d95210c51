//! Many orbits of one system, computed side by side on all cores.
//!
//! In: a compiled [`System`](crate::system::System), a method, a [`Start`] for each orbit. Out: one result an orbit, in
//! the order asked for and the same to the last bit whatever the number of threads. Never here: files, tables, what is
//! printed.

mod actions;
mod effective_potential;
mod energy_shell;
mod measure;
mod outcome;
mod pool;
mod section;
mod start;

pub use actions::{
    ActionRow, ActionSystems, NoAction, RegionKind, action_between, action_row, cyclic_row,
};
pub use effective_potential::{EffectivePotential, Region};
pub use energy_shell::{EnergyShell, NotOnShell, Root};
pub use measure::{MEASURES, Measure, MeasuredOrbit, Zeros, measure_named};
pub use outcome::{Outcome, RunPlan};
pub use pool::{PoolError, in_order};
pub use section::{Crossings, OrbitStatus, SectionPlan, add_section, crossings};
pub use start::Start;
