//! The progress of a run, shown on a terminal.

use std::io::{IsTerminal, stderr};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::printable;

/// A shorter run shows no bar.
const NOTICE_DELAY: Duration = Duration::from_millis(500);

/// The least time between two updates of the bar.
const BETWEEN: Duration = Duration::from_millis(100);

const PARTS: f64 = 1000.0;

/// A bar on standard error, shown only on a terminal and only if the run is long.
pub(crate) struct Bar {
    start: f64,
    length: f64,
    due: Instant,
    shown: Option<ProgressBar>,
    watched: bool,
}

impl Bar {
    pub(crate) fn new(start: f64, end: f64) -> Bar {
        let watched = stderr().is_terminal();
        Bar { start, length: end - start, due: Instant::now() + NOTICE_DELAY, shown: None, watched }
    }

    pub(crate) fn show(&mut self, time: f64) {
        if !self.watched || Instant::now() < self.due {
            return;
        }
        self.due = Instant::now() + BETWEEN;
        let bar = self.shown.get_or_insert_with(|| {
            let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {msg}  {eta} left");
            let bar = ProgressBar::new(PARTS as u64);
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar
        });
        bar.set_position((PARTS * (time - self.start) / self.length) as u64);
        bar.set_message(format!("t = {}", printable::number(time)));
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        if let Some(bar) = &self.shown {
            bar.finish_and_clear();
        }
    }
}
