//! Orbits computed on several threads.
//!
//! In: a number of orbits, what is done with a group of them. Out: the results in order. Never here: what an orbit is.

use std::num::NonZeroUsize;
use std::ops::{ControlFlow, Range};
use std::thread;

use super::count_bar::CountBar;
use super::error::CommandError;
use super::interrupt::Interrupt;
use crate::ensemble::in_order;

/// How many orbits are computed at once.
#[derive(Debug, clap::Args)]
pub(super) struct ThreadOptions {
    /// The number of threads; by default all cores; the output is the same.
    #[arg(long, allow_hyphen_values = true, value_name = "N", value_parser = threads)]
    threads: Option<NonZeroUsize>,
}

fn threads(text: &str) -> Result<NonZeroUsize, String> {
    text.trim().parse().map_err(|_| "not a positive whole number".to_owned())
}

impl ThreadOptions {
    pub(super) fn count(&self) -> usize {
        let cores = || thread::available_parallelism().ok();
        self.threads.or_else(cores).map_or(1, NonZeroUsize::get)
    }
}

/// Computes `count` items in groups of `size`; after a signal, those of the groups before the first unfinished one.
pub(super) fn collect<T: Send>(
    options: &ThreadOptions,
    (count, size): (usize, usize),
    interrupt: &Interrupt,
    work: impl Fn(Range<usize>) -> Vec<T> + Sync,
) -> Result<Vec<T>, CommandError> {
    interrupt.ends_by_itself(|| {});
    let mut bar = CountBar::new(0, count);
    let mut results = Vec::new();
    let group = |i: usize| work(i * size..count.min((i + 1) * size));
    let take = |_, group: Vec<T>| {
        for result in group {
            results.push(result);
            bar.add();
        }
        ControlFlow::Continue(())
    };
    in_order(options.count(), count.div_ceil(size), interrupt.cancel(), group, take)
        .map_err(|why| CommandError::CouldNot(why.to_string()))?;
    Ok(results)
}
