//! Many starts of one system: where their orbits cross a surface of section, and where the flow carries them.
//!
//! In: a compiled [`System`](crate::system::System), a method, a [`Start`] for each orbit. Out: one result an orbit, in
//! the order asked for and the same to the last bit whatever the number of threads. Never here: whole runs with their
//! gauges (`orbits`), files, what is printed.

mod closed_curve;
mod energy_shell;
mod flow;
mod not_in_plane;
mod phase_shift;
mod plane;
mod pool;
mod region;
mod section;
mod section_batch;
mod start;

pub use closed_curve::{Circulation, ClosedCurve};
pub use energy_shell::{EnergyShell, NotOnShell, Root};
pub use flow::{Carried, SystemFlow};
pub use not_in_plane::NotInPlane;
pub use phase_shift::PhaseShift;
pub use plane::SectionPlane;
pub use pool::{PoolError, in_order};
pub use region::{Region, spread};
pub use section::{
    Crossings, OrbitStatus, SectionPlan, add_section, crossings, crossings_from, section_name,
};
pub use section_batch::{crossings_of_all, section_group};
pub use start::Start;
