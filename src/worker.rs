//! The thread that keeps an experiment in motion: commands in, the newest snapshot out.
//!
//! In: an experiment ([`Worker::load`]) and [`Command`]s. Out: [`Snapshot`]s through a slot of
//! one, where the newest wins and nobody waits. The mailbox is emptied before each slice of about
//! two milliseconds, so a held key costs one slice; nothing is computed, and nothing wakes, while
//! time is held. A panic of the experiment becomes a fault in a snapshot. What is no longer wanted is
//! stopped within its step, by its token. Beside it a [`Side`] runs jobs, each on a thread of its own. Never here: terminals, physics, drawing.

mod handle;
mod pace;
mod runnable;
mod side;
mod slice;
mod thread;

pub use handle::{THREAD_NAME, Worker};
pub use runnable::Runnable;
pub use side::Side;
