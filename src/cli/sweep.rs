//! `phaselab sweep`: one run a row of a table or a grid.

mod identity;
mod journal;
mod merge;
mod table;

use std::collections::BTreeMap;
use std::io::Write;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use serde_json::{Value, json};

use super::advice::size;
use super::assignment::number;
use super::cells::{self, TableCell, TableFormat};
use super::count_bar::CountBar;
use super::error::CommandError;
use super::interrupt::Interrupt;
use super::motion_options::MotionOptions;
use super::output::{Output, OutputForm};
use super::starts::{GridAxis, Starts};
use super::stderr;
use super::threads::ThreadOptions;
use crate::ensemble::in_order;
use crate::orbits::Departed;
use crate::printable;

use identity::{Identity, Shard};
use journal::Journal;
use table::{MeasureName, RowRemark, SweepRow, SweepTable};

/// Run once per row of a table or point of a grid, in parallel.
///
/// Each column of the table, or axis of the grid, sets a parameter or an initial value. One row
/// comes out for each: what was set, the status, the columns of `run` at the end, the drift of the
/// energy, the measures. The bytes are the same whatever the number of threads. With -o the rows
/// are kept in a journal beside the file until all are there, and --resume continues after any interruption.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab sweep pendulum --grid theta=0.1:3:30 --until 30 --measure period > periods.csv
  phaselab sweep duffing --grid gamma=0:0.5:11 --grid x=-1:1:3 --until 100 -o duffing.csv
  phaselab sweep henon-heiles --over starts.csv --measure 'escape=x^2+y^2-4' --resume -o escape.csv
  phaselab sweep planet --over starts.csv --shard 3/16 --resume -o planet-3.csv
  phaselab sweep --merge planet-*.csv -o planet.csv")]
pub(super) struct Arguments {
    #[command(flatten)]
    motion: Option<MotionOptions>,
    /// One run a row; the columns of the table set parameters or initial values.
    #[arg(long, value_name = "TABLE.csv", conflicts_with = "grid")]
    over: Option<PathBuf>,
    /// An axis of a grid, evenly spaced; repeatable, the last varies fastest.
    #[arg(long, value_name = "NAME=FROM:TO:COUNT", allow_hyphen_values = true)]
    grid: Vec<GridAxis>,
    /// When a run ends; by default as the file says, or 10 after the start.
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = number)]
    until: Option<f64>,
    /// One more column: period, period=EXPR, escape=EXPR, crossings=EXPR, lyapunov.
    #[arg(long, value_name = "NAME[=EXPR]", allow_hyphen_values = true)]
    measure: Vec<MeasureName>,
    /// Every Nth row only, from the Ith on, for machines side by side.
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// Continues the sweep that -o names, after an earlier run was ended or killed.
    #[arg(long, requires = "output")]
    resume: bool,
    /// Puts all shards of one sweep together.
    #[arg(long, value_name = "SHARD", num_args = 1..)]
    #[arg(conflicts_with_all = ["name", "over", "grid", "measure", "shard", "resume", "until"])]
    merge: Vec<PathBuf>,
    #[command(flatten)]
    threads: ThreadOptions,
    /// How the rows are written.
    #[arg(long, value_enum, default_value_t = TableFormat::Csv)]
    format: TableFormat,
    /// Writes to a file, which appears when it is complete and replaces an old one.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

pub(super) fn execute(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    let wrong = |message: &str| Err(CommandError::WrongUse(message.to_owned()));
    if !arguments.merge.is_empty() {
        if arguments.format != TableFormat::Csv {
            return wrong("--merge writes comma-separated values, --format csv");
        }
        return merge::execute(&arguments.merge, arguments.output.as_deref());
    }
    let Some(motion) = &arguments.motion else {
        return wrong("name a preset or a file to sweep, or merge shards with --merge");
    };
    if arguments.format != TableFormat::Csv && (arguments.shard.is_some() || arguments.resume) {
        return wrong("--shard and --resume write comma-separated values, --format csv");
    }
    let starts = match &arguments.over {
        Some(path) => Starts::read(path)?,
        None if arguments.grid.is_empty() => {
            return wrong(
                "say what to sweep over: a table, --over TABLE.csv, or a grid, --grid NAME=FROM:TO:COUNT",
            );
        }
        None => Starts::grid(&arguments.grid)?,
    };
    let table = SweepTable::new(motion, &starts, arguments.until, &arguments.measure, interrupt)?;
    let sweep = Sweep {
        identity: Identity::of(&table, arguments.shard),
        places: arguments.shard.map_or(0..table.count(), |s| 0..s.count(table.count())),
        table,
        arguments,
        interrupt,
    };
    interrupt.ends_by_itself(|| {});
    match (arguments.format, &arguments.output) {
        (TableFormat::Csv, Some(path)) if journal::is_regular(path) => sweep.into_file(path),
        (TableFormat::Csv, path) if !arguments.resume => sweep.into_stream(path.as_deref()),
        (TableFormat::Csv, _) => {
            wrong("--resume: -o does not name a regular file, so there is nothing to continue")
        }
        _ => sweep.whole(),
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Shard, String> {
        let form = "write it as I/N, the Ith of N, from 1/N to N/N";
        let (index, of) = text.split_once('/').ok_or(form)?;
        let parse = |part: &str| part.trim().parse::<usize>().map_err(|_| form.to_owned());
        let (index, of) = (parse(index)?, parse(of)?);
        if index == 0 || index > of {
            return Err(form.to_owned());
        }
        Ok(Shard { index, of })
    }
}

/// A sweep that is about to be computed.
struct Sweep<'a> {
    identity: Identity,
    /// The places in this shard, from 0.
    places: std::ops::Range<usize>,
    table: SweepTable,
    arguments: &'a Arguments,
    interrupt: &'a Interrupt,
}

/// What is to be said of the rows: how many were not completed, and in how many a conserved quantity has left its value.
#[derive(Default)]
struct Remarks {
    failed: u64,
    /// The first that failed.
    first: Option<String>,
    departed: u64,
    /// The row of the greatest drift.
    worst: Option<(usize, Departed)>,
}

impl Remarks {
    fn note(&mut self, index: usize, remark: &RowRemark) {
        if let Some(message) = &remark.message {
            self.failed += 1;
            self.first.get_or_insert_with(|| format!("row {}, {message}", index + 1));
        }
        if let Some(departed) = &remark.departed {
            self.departed += 1;
            let worse = self.worst.as_ref().is_none_or(|(_, worst)| departed.drift > worst.drift);
            if worse {
                self.worst = Some((index, departed.clone()));
            }
        }
    }

    fn report(&self, advice: &str) {
        let rows = |count| if count == 1 { "row" } else { "rows" };
        if let Some(first) = &self.first {
            let (count, were) = (self.failed, if self.failed == 1 { "was" } else { "were" });
            let first = first.split_whitespace().collect::<Vec<_>>().join(" ");
            let rows = rows(count);
            stderr::report(&format!("{count} {rows} {were} not completed; the first: {first}"));
        }
        if let Some((index, worst)) = &self.worst {
            let (count, rows) = (self.departed, rows(self.departed));
            let (name, drift) = (printable::line(&worst.name), size(worst.drift));
            let row = index + 1;
            let of_them = match count {
                1 => format!("in row {row} a conserved quantity departs from its value"),
                _ => format!(
                    "in {count} {rows} a conserved quantity departs from its value, most in row {row}"
                ),
            };
            stderr::report(&format!(
                "{of_them}: `{name}` is off by {drift} of what moves; {advice}"
            ));
        }
    }
}

impl Sweep<'_> {
    /// The row of the table at a place of this shard.
    fn index(&self, place: usize) -> usize {
        self.arguments.shard.map_or(place, |shard| shard.row(place))
    }

    /// The lines before the rows.
    fn head(&self) -> String {
        self.table.header().lines()
            + &format!("{}\n", self.identity.line())
            + &cells::record(self.table.columns())
    }

    /// Ends with the signal, if one came.
    fn ended(&self) -> Result<(), CommandError> {
        self.interrupt.signal().map_or(Ok(()), |signal| Err(CommandError::Signal(signal)))
    }

    /// Computes the rows at these places of the shard. `note` sees each as soon as it is there, on the thread that computed
    /// it, and `take` what it made of them, in order; `None` where the sweep was cancelled.
    fn compute<T: Send>(
        &self,
        places: &[usize],
        note: impl Fn(usize, SweepRow) -> T + Sync,
        mut take: impl FnMut(usize, Option<T>) -> ControlFlow<()>,
    ) -> Result<(), CommandError> {
        let (threads, cancel) = (self.arguments.threads.count(), self.interrupt.cancel());
        let size = self.table.group(places.len(), threads);
        let groups: Vec<&[usize]> = places.chunks(size).collect();
        let work = |group: usize| {
            let group = groups[group];
            let indices: Vec<usize> = group.iter().map(|&place| self.index(place)).collect();
            let mut made: Vec<Option<T>> = group.iter().map(|_| None).collect();
            self.table.rows(&indices, |i, row| made[i] = Some(note(group[i], row)));
            made
        };
        let take = |group: usize, made: Vec<Option<T>>| {
            let mut made = made.into_iter().enumerate();
            made.try_for_each(|(i, one)| take(group * size + i, one))
        };
        in_order(threads, groups.len(), cancel, work, take)
            .map_err(|why| CommandError::CouldNot(why.to_string()))
    }

    /// Writes each row as soon as all before it are written.
    fn into_stream(self, path: Option<&Path>) -> Result<(), CommandError> {
        let mut out = Output::open(path, OutputForm::Text)?;
        let (mut remarks, mut failed) = (Remarks::default(), None);
        let mut bar = CountBar::new(0, self.places.len());
        let head = out.write_all(self.head().as_bytes());
        head.map_err(|error| out.failed(&error))?;
        let mut written = 0;
        let take = |place, row: Option<SweepRow>| {
            let Some(row) = row else { return ControlFlow::Break(()) };
            row.remark.iter().for_each(|remark| remarks.note(self.index(place), remark));
            let line = row.line();
            if let Err(error) = out.write_all(line.as_bytes()).and_then(|()| out.flush()) {
                failed = Some(out.failed(&error));
                return ControlFlow::Break(());
            }
            written += 1;
            bar.add();
            ControlFlow::Continue(())
        };
        let places: Vec<usize> = self.places.clone().collect();
        self.compute(&places, |_, row| row, take)?;
        drop(bar);
        if let Some(failed) = failed {
            return Err(failed);
        }
        if self.interrupt.signal().is_some() {
            let line = format!("# stopped: {written} of {} rows\n", self.places.len());
            out.write_all(line.as_bytes()).map_err(|error| out.failed(&error))?;
        }
        out.finish()?;
        remarks.report(&self.table.advice());
        self.ended()
    }

    /// Keeps rows in a journal, and writes the file when all are there.
    fn into_file(self, path: &Path) -> Result<(), CommandError> {
        let resume = self.arguments.resume;
        if resume && journal::is_complete(path, &self.identity, self.places.len())? {
            journal::discard(path);
            stderr::report(&format!("{} is complete", printable::path(path)));
            return Ok(());
        }
        let (journal, mut lines, known) =
            Journal::open(path, &self.identity, self.places.len(), resume)?;
        let missing: Vec<usize> = self.places.clone().filter(|&p| lines[p].is_none()).collect();
        let mut bar = CountBar::new(lines.len() - missing.len(), lines.len());
        let mut failed = None;
        let mut remarks: BTreeMap<usize, RowRemark> = (known.into_iter())
            .filter_map(|(place, remark)| Some((place, serde_json::from_value(remark).ok()?)))
            .collect();
        // a row is in the journal before anything waits for those before it
        let note = |place: usize, row: SweepRow| {
            let line = row.line();
            let noted = journal.note(
                place,
                &line,
                row.remark.as_ref().map(|remark| json!(remark)).as_ref(),
            );
            (row, line, noted)
        };
        let take = |i: usize, done: Option<(SweepRow, String, std::io::Result<()>)>| {
            let Some((row, line, noted)) = done else { return ControlFlow::Break(()) };
            if let Err(error) = noted {
                failed = Some(CommandError::writing(&journal.name(), &error));
                return ControlFlow::Break(());
            }
            remarks.extend(row.remark.map(|remark| (missing[i], remark)));
            lines[missing[i]] = Some(line);
            bar.add();
            ControlFlow::Continue(())
        };
        self.compute(&missing, note, take)?;
        drop(bar);
        if let Some(failed) = failed {
            return Err(failed);
        }
        if self.interrupt.signal().is_some() {
            stderr::report(&format!(
                "the rows so far are in {}; --resume continues",
                journal.name()
            ));
            return self.ended();
        }
        let out = Output::open(Some(path), OutputForm::Text)?;
        let rows = || lines.into_iter().flatten().collect::<String>();
        out.write_after_signal(|| self.head() + &rows(), self.interrupt)?;
        journal.remove();
        let mut all = Remarks::default();
        for (&place, remark) in &remarks {
            all.note(self.index(place), remark);
        }
        all.report(&self.table.advice());
        Ok(())
    }

    /// Writes all rows at once, as JSON or for reading.
    fn whole(self) -> Result<(), CommandError> {
        let out = Output::open(self.arguments.output.as_deref(), self.arguments.format.form())?;
        let (mut rows, mut bar) = (Vec::new(), CountBar::new(0, self.places.len()));
        let places: Vec<usize> = self.places.clone().collect();
        let take = |_, row: Option<SweepRow>| {
            let Some(row) = row else { return ControlFlow::Break(()) };
            rows.push(row);
            bar.add();
            ControlFlow::Continue(())
        };
        self.compute(&places, |_, row| row, take)?;
        drop(bar);
        let mut remarks = Remarks::default();
        for (i, row) in rows.iter().enumerate() {
            row.remark.iter().for_each(|remark| remarks.note(i, remark));
        }
        let cells: Vec<Vec<TableCell>> = rows.iter().map(|row| row.cells.clone()).collect();
        let columns = self.table.columns();
        let text = || match self.arguments.format {
            TableFormat::Json => {
                let mut members = self.table.header().members();
                members.insert("columns".to_owned(), columns.into());
                let messages = (1..).zip(&rows).filter_map(|(n, row): (u64, &SweepRow)| {
                    let message = row.remark.as_ref()?.message.as_ref()?;
                    Some(json!({ "row": n, "message": message }))
                });
                let messages: Value = messages.collect();
                let rows =
                    cells.iter().map(|row| row.iter().map(TableCell::value).collect::<Value>());
                members.insert("rows".to_owned(), rows.collect());
                members.insert("messages".to_owned(), messages);
                let status =
                    if self.interrupt.signal().is_some() { "stopped" } else { "completed" };
                members.insert("status".to_owned(), status.into());
                cells::object(&members)
            }
            _ => cells::text(&columns, &cells),
        };
        out.write_after_signal(text, self.interrupt)?;
        remarks.report(&self.table.advice());
        self.ended()
    }
}
