//! Steps in time: one table of methods, one file per method.
//!
//! In: a [`System`](crate::system::System) and a state. Out: steppers, which advance the state step
//! by step and evaluate it anywhere inside the last one. Never here: rows, gauges, wall clocks.

mod batch;
mod batch_events;
mod blow_up;
mod clock;
mod convergence;
mod dense_output;
mod dop853;
mod equal_steps;
mod equal_steps_batch;
mod event_location;
mod fixed;
mod gauss;
mod implicit;
mod impulse_schedule;
mod initial_step;
mod lane_status;
mod leapfrog;
mod located_event;
mod method;
mod methods;
mod narrow_place;
mod passed_poles;
mod piece_count;
mod polynomial;
mod probe;
mod propagator;
mod rk4;
mod rk4_batch;
mod root_correction;
mod roots;
mod roundoff;
mod sampling;
mod series_piece;
mod several_motions;
mod side_by_side;
mod splitting;
mod stability;
mod stage_lanes;
mod step_block;
mod stepper;
mod symplectic_euler;
mod tableau;
mod taylor;
mod yoshida;
mod zeno;

pub use batch::BatchPropagator;
pub use batch_events::LaneEvent;
pub use blow_up::StoppedMotion;
pub use clock::spacing;
pub use dense_output::DenseOutput;
pub use lane_status::LaneStatus;
pub use method::{ACCURACIES, Method, MethodError, Preserves, Settings, StepperResult, Stepping};
pub use methods::{METHODS, method_named};
pub use propagator::{NarrowPassage, NarrowPlace, Occurrence, OccurrenceKind, Propagator, Reached};
pub use roots::first_crossing;
pub use several_motions::{SeveralMotions, several_motions};
pub use side_by_side::{Follower, OrbitCourse, side_by_side};
pub use stability::Unstable;
pub use step_block::StepBlock;
pub use stepper::Stepper;
