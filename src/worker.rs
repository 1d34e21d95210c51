//! The thread that runs an experiment: commands in, the newest snapshot out.
//!
//! In: an experiment ([`Worker::load`]) and [`Command`](crate::experiment::Command)s. Out: [`Snapshot`](crate::experiment::Snapshot)s through a slot of one, in which the
//! newest replaces the last without blocking. The mailbox is emptied before each slice of about two milliseconds, so
//! a repeating key costs one slice per press. While time is paused nothing is computed and the thread sleeps. A panic
//! of the experiment becomes an error in a snapshot. Obsolete work is cancelled within its step by a token. A [`SideJob`]
//! runs background jobs, each on its own thread. Never here: terminals, physics, drawing.

mod handle;
mod pace;
mod runnable;
mod side;
mod slice;
mod thread;

pub use handle::{THREAD_NAME, Worker};
pub use runnable::Runnable;
pub use side::SideJob;
