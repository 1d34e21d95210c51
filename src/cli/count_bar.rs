//! A bar of progress over a number of items.
//!
//! In: how many there are, and one more that is done. Out: a line on standard error. Never here: the simulated time (`study`).

use std::io::{IsTerminal, stderr};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// A shorter computation shows no bar.
const NOTICE_DELAY: Duration = Duration::from_millis(500);

/// A bar on standard error, shown only on a terminal and only if the computation is long.
pub(super) struct CountBar {
    begun: Instant,
    done: u64,
    count: u64,
    bar: Option<ProgressBar>,
}

impl CountBar {
    /// A bar for `count` items, of which `done` are there already.
    pub(super) fn new(done: usize, count: usize) -> CountBar {
        CountBar { begun: Instant::now(), done: done as u64, count: count as u64, bar: None }
    }

    /// One more is done.
    pub(super) fn add(&mut self) {
        self.done += 1;
        if self.bar.is_none() && self.begun.elapsed() > NOTICE_DELAY && stderr().is_terminal() {
            let style = ProgressStyle::with_template("{bar:40} {pos} of {len}  {eta} left");
            let bar = ProgressBar::new(self.count);
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            self.bar = Some(bar);
        }
        if let Some(bar) = &self.bar {
            bar.set_position(self.done);
        }
    }
}

impl Drop for CountBar {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
