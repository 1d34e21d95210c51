//! What commands on many orbits have in common: threads, the bar of progress, the report before the rows, the end.
//!
//! In: a number of orbits, what is done with one. Out: the results in order; text written. Never here: what an orbit is.

use std::io::{IsTerminal, Write, stderr};
use std::num::NonZeroUsize;
use std::ops::{ControlFlow, Range};
use std::thread;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use serde_json::{Map, Value};

use super::failure::CommandError;
use super::interrupt::{Interrupt, PORTION};
use super::output::Output;
use super::report::Header;
use crate::ensemble::in_order;
use crate::printable;

/// How many orbits are computed at once.
#[derive(Debug, clap::Args)]
pub(super) struct Crowd {
    /// The number of threads; by default all cores; the output is the same.
    #[arg(long, allow_hyphen_values = true, value_name = "N", value_parser = threads)]
    threads: Option<NonZeroUsize>,
}

fn threads(text: &str) -> Result<NonZeroUsize, String> {
    text.trim().parse().map_err(|_| "not a positive whole number".to_owned())
}

impl Crowd {
    pub(super) fn threads(&self) -> usize {
        let cores = || thread::available_parallelism().ok();
        self.threads.or_else(cores).map_or(1, NonZeroUsize::get)
    }
}

/// A shorter computation shows no bar.
const PATIENCE: Duration = Duration::from_millis(500);

/// A bar on standard error, shown only on a terminal and only if the computation is long.
pub(super) struct Tally {
    begun: Instant,
    done: u64,
    count: u64,
    bar: Option<ProgressBar>,
}

impl Tally {
    /// A tally of `count` items, of which `done` are there already.
    pub(super) fn new(done: usize, count: usize) -> Tally {
        Tally { begun: Instant::now(), done: done as u64, count: count as u64, bar: None }
    }

    /// One more is done.
    pub(super) fn add(&mut self) {
        self.done += 1;
        if self.bar.is_none() && self.begun.elapsed() > PATIENCE && stderr().is_terminal() {
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

impl Drop for Tally {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Computes `count` items in groups of `size`; after a signal, those of the groups before the first unfinished one.
pub(super) fn collect<T: Send>(
    crowd: &Crowd,
    (count, size): (usize, usize),
    interrupt: &Interrupt,
    work: impl Fn(Range<usize>) -> Vec<T> + Sync,
) -> Result<Vec<T>, CommandError> {
    interrupt.ends_by_itself(|| {});
    let mut tally = Tally::new(0, count);
    let mut results = Vec::new();
    let group = |i: usize| work(i * size..count.min((i + 1) * size));
    let take = |_, group: Vec<T>| {
        for result in group {
            results.push(result);
            tally.add();
        }
        ControlFlow::Continue(())
    };
    in_order(crowd.threads(), count.div_ceil(size), interrupt.cancel(), group, take)
        .map_err(|why| CommandError::CouldNot(why.to_string()))?;
    Ok(results)
}

/// Writes all of a text. A file that is moved into place is waited for after a signal, and so is a reader that takes what
/// a signal left.
pub(super) fn write(out: Output, text: &str, interrupt: &Interrupt) -> Result<(), CommandError> {
    write_pieces(out, std::iter::once(text.to_owned()), interrupt)
}

/// The same for a text that is put into words piece by piece: that of many rows takes longer than a command has to end
/// by itself.
pub(super) fn write_pieces(
    mut out: Output,
    pieces: impl Iterator<Item = String>,
    interrupt: &Interrupt,
) -> Result<(), CommandError> {
    if out.is_file() {
        interrupt.saves();
    }
    for piece in pieces {
        for portion in piece.as_bytes().chunks(PORTION) {
            if !out.is_file() && interrupt.signal().is_some() {
                interrupt.writes();
            }
            out.write_all(portion).map_err(|error| out.failed(&error))?;
            interrupt.taken();
        }
    }
    out.finish()
}

/// The members of a report that come first: version, title, parameters, method.
pub(super) fn members(header: &Header) -> Map<String, Value> {
    let mut members = Map::new();
    members.insert("phaselab".to_owned(), header.phaselab.into());
    members.insert("title".to_owned(), header.title.clone().into());
    members.insert("parameters".to_owned(), header.parameters.clone().into());
    members.insert("method".to_owned(), header.method.clone().into());
    members
}

/// The same as `#` lines before comma-separated values.
pub(super) fn lead(header: &Header) -> String {
    let one_line = |text: &str| {
        printable::line(&text.split_whitespace().collect::<Vec<_>>().join(" ")).into_owned()
    };
    let fields = |fields: &Map<String, Value>| {
        let fields = fields.iter().map(|(key, value)| match value {
            Value::String(text) => format!("{key}={text}"),
            other => format!("{key}={other}"),
        });
        fields.collect::<Vec<_>>().join(" ")
    };
    format!(
        "# phaselab {}: {}\n# parameters: {}\n# method: {}\n",
        header.phaselab,
        one_line(&header.title),
        fields(&header.parameters),
        fields(&header.method)
    )
}
