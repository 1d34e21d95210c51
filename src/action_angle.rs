//! Action variables of one coordinate: J = ∮ p dq, its period and frequency, its angle variable, the
//! separatrices between kinds of motion.
//!
//! In: a system that conserves its energy, or one frozen at an instant, a coordinate, an energy. Out: one row for each region
//! in which the coordinate may move; whether a change of the action is small. Never here: names, files, pictures, runs.
//! Source: *The Principles of Dynamics*, §§ 4.2, 4.3.

mod adiabatic;
mod angle;
mod angle_at_time;
mod effective_potential;
mod extremum;
mod frozen;
mod mean_return;
mod no_action;
mod quadrature;
mod row;
mod separatrix;

pub use adiabatic::is_adiabatic;
pub use angle::angle;
pub use angle_at_time::AngleAtTime;
pub use effective_potential::{AllowedInterval, EffectivePotential, PotentialProfile};
pub use frozen::{FrozenMotion, FrozenSystem, NotFrozen, OwnMotion};
pub use mean_return::average_returns;
pub use no_action::NoAction;
pub use row::{ActionRow, ActionSystems, RegionKind, action_row, action_rows, cyclic_row};
pub use separatrix::Separatrix;
