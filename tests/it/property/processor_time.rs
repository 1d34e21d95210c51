//! The time that a thread has spent on a processor, which other programs on the same machine do not lengthen.
//!
//! In: nothing. Out: a clock of the thread that made it, which any thread may read. Never here: limits.

use std::path::PathBuf;
use std::time::Duration;

/// The clock of a thread; without a value where the system does not tell.
pub(crate) struct ProcessorTime {
    statistics: Option<PathBuf>,
}

impl ProcessorTime {
    /// The clock of the thread that calls this.
    pub(crate) fn of_this_thread() -> ProcessorTime {
        // `PID/task/TID`
        let thread = std::fs::read_link("/proc/thread-self").ok();
        let statistics = thread.map(|own| PathBuf::from("/proc").join(own).join("schedstat"));
        ProcessorTime { statistics }
    }

    /// The time spent so far.
    pub(crate) fn spent(&self) -> Option<Duration> {
        let text = std::fs::read_to_string(self.statistics.as_ref()?).ok()?;
        // nanoseconds on a processor, nanoseconds of waiting for one, and how often
        let spent = text.split_whitespace().next()?.parse().ok()?;
        Some(Duration::from_nanos(spent))
    }
}
