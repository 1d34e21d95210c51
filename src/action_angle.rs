//! Action variables of one coordinate: J = ∮ p dq, its period and frequency, its angle variable, the
//! separatrices between kinds of motion.
//!
//! In: a system that conserves its energy, or one frozen at an instant, a coordinate, an energy. Out: one row for each region
//! in which the coordinate may move; whether a change of the action is small. Never here: names, files, pictures, runs.
//! Source: *The Principles of Dynamics*, §§ 4.2, 4.3.

mod adiabatic;
mod angle;
mod effective_potential;
mod extremum;
mod frozen;
mod mean_return;
mod moment;
mod quadrature;
mod row;
mod separatrix;

pub use adiabatic::is_adiabatic;
pub use angle::angle;
pub use effective_potential::{AllowedInterval, EffectivePotential, PotentialProfile};
pub use frozen::{FrozenMotion, FrozenSystem, NotFrozen, OwnMotion};
pub use mean_return::average_returns;
pub use moment::AngleMoment;
pub use row::{
    ActionRow, ActionSystems, NoAction, RegionKind, action_row, action_rows, cyclic_row,
};
pub use separatrix::Separatrix;
