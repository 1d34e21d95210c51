//! The worker's protocol with a real thread. Nothing here sleeps to make something likely: every
//! test waits for a condition, for at most a minute.

mod protocol;
mod side;
