//! `phaselab plot`: a table of numbers drawn as text.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::failure::CommandError;
use super::interrupt::Interrupt;
use super::output::{Output, OutputForm};
use crate::view::glyphs::Glyphs;
use crate::view::table_plot::{TablePlot, drawn};
use crate::{file, printable};

/// Draw a table of numbers as text: what D writes in the lab, or run, section and sweep.
///
/// Two of its columns are drawn against each other, a third one as shades. By default these are the
/// first two whose numbers differ, or the three of the table of a map; of a section's the number of the orbit and of the
/// crossing and its time are left out.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab plot henon-heiles-section.csv
  phaselab plot pendulum.csv --x theta --y p_theta
  phaselab plot henon-heiles-map.csv --size 120x40
  phaselab plot - --x y --y p_y")]
pub(super) struct Arguments {
    /// A file of comma-separated values, or `-` for standard input.
    #[arg(value_name = "TABLE.csv")]
    file: PathBuf,
    /// The column of the horizontal axis.
    #[arg(long, value_name = "NAME")]
    x: Option<String>,
    /// The column of the vertical axis.
    #[arg(long, value_name = "NAME")]
    y: Option<String>,
    /// The column that is shaded: the mean of its numbers in each cell.
    #[arg(long, value_name = "NAME")]
    of: Option<String>,
    /// The columns and rows of the drawing.
    #[arg(long, value_name = "COLUMNSxROWS", default_value = "80x24", value_parser = size)]
    size: [u16; 2],
    /// Letters instead of dots and shades; by default where the locale has no UTF-8.
    #[arg(long)]
    ascii: bool,
}

/// Numbers of a section that differ by no more than this part of its greatest are the same.
const SAME: f64 = 1e-14;

/// The greatest size of a table that is read, and the sizes of a drawing.
const LIMIT: u64 = 256 << 20;
const LEAST: [u16; 2] = [20, 8];
const MOST: [u16; 2] = [500, 200];

fn size(text: &str) -> Result<[u16; 2], String> {
    let shape = || {
        format!(
            "write it as COLUMNSxROWS, from {}x{} to {}x{}",
            LEAST[0], LEAST[1], MOST[0], MOST[1]
        )
    };
    let (columns, rows) = text.split_once(['x', '×']).ok_or_else(shape)?;
    let number = |text: &str| text.trim().parse::<u16>().map_err(|_| shape());
    let size = [number(columns)?, number(rows)?];
    let fits = (0..2).all(|k| (LEAST[k]..=MOST[k]).contains(&size[k]));
    if fits { Ok(size) } else { Err(shape()) }
}

pub(super) fn perform(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    let path = &arguments.file;
    let table = NumberTable::read(path)?;
    let plot = table.plot(arguments)?;
    let variable = |name: &str| std::env::var(name).ok();
    let glyphs = if arguments.ascii { Glyphs::Ascii } else { Glyphs::from_environment(&variable) };
    let text = drawn(&plot, arguments.size, glyphs);
    interrupt.ends_by_itself(|| ());
    let mut out = Output::open(None, OutputForm::Text)?;
    std::io::Write::write_all(&mut out, text.as_bytes()).map_err(|error| out.failed(&error))?;
    out.finish()
}

/// Named columns of numbers; where there is none, NaN.
struct NumberTable {
    title: String,
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl NumberTable {
    fn read(path: &Path) -> Result<NumberTable, CommandError> {
        let shown = printable::path(path);
        let read = if path == Path::new("-") {
            let mut bytes = Vec::new();
            let input = std::io::Read::take(std::io::stdin().lock(), LIMIT + 1);
            let mut input = input;
            std::io::Read::read_to_end(&mut input, &mut bytes).map(|_| bytes)
        } else {
            file::read(path, LIMIT).map(|(bytes, _)| bytes)
        };
        let bytes = read.map_err(|why| CommandError::reading(path, &why))?;
        let wrong = |what: String| CommandError::WrongFile(format!("{shown}: {what}"));
        if bytes.len() as u64 > LIMIT {
            return Err(wrong("a table may have 256 MiB; this one has more".to_owned()));
        }
        let text =
            String::from_utf8(bytes).map_err(|_| wrong("it is not a text in UTF-8".to_owned()))?;
        let first = text.lines().find_map(|line| line.strip_prefix("# phaselab "));
        let title = first.and_then(|line| line.split_once(": ")).map_or("", |(_, title)| title);
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        let head = reader.headers().map_err(|why| wrong(why.to_string()))?;
        let columns: Vec<String> = head.iter().map(str::to_owned).collect();
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|why| wrong(why.to_string()))?;
            rows.push(record.iter().map(|cell| cell.parse().unwrap_or(f64::NAN)).collect());
        }
        if columns.len() < 2 || rows.is_empty() {
            return Err(wrong("it has no two columns with rows".to_owned()));
        }
        Ok(NumberTable { title: title.to_owned(), columns, rows })
    }

    fn named(&self, name: &str) -> Result<usize, CommandError> {
        self.columns.iter().position(|column| column == name).ok_or_else(|| {
            let known: Vec<String> = self.columns.iter().map(|c| printable::quoted(c)).collect();
            CommandError::WrongUse(format!(
                "there is no column `{}`; the columns are {}",
                printable::quoted(name),
                known.join(", ")
            ))
        })
    }

    /// What is drawn of it: the columns asked for, or those that follow from its shape.
    fn plot(&self, arguments: &Arguments) -> Result<TablePlot, CommandError> {
        let numbered = self.columns[0] == "orbit" && self.columns.len() > 2;
        let (across, upwards) = self.axes(numbered);
        let given = |name: &Option<String>| name.as_ref().map(|name| self.named(name)).transpose();
        let x = given(&arguments.x)?.unwrap_or(across);
        let y = given(&arguments.y)?.unwrap_or(upwards);
        let is_map = !numbered && self.columns.len() == 3 && self.is_lattice();
        let of = given(&arguments.of)?.or(is_map.then_some(2));
        let points: Vec<[f64; 3]> = (self.rows.iter())
            .map(|row| [row[x], row[y], of.map_or(1.0, |of| row[of])])
            .filter(|point| point.iter().all(|x| x.is_finite()))
            .collect();
        if points.is_empty() {
            let [x, y] = [x, y].map(|k| printable::quoted(&self.columns[k]));
            let what = match of.map(|k| printable::quoted(&self.columns[k])) {
                None => format!("no row has numbers for both `{x}` and `{y}`"),
                Some(of) => format!("no row has numbers for all of `{x}`, `{y}` and `{of}`"),
            };
            return Err(CommandError::WrongUse(what));
        }
        let title = printable::quoted(&self.title);
        let name = |k: usize| printable::quoted(&self.columns[k]);
        Ok(TablePlot { title, x: name(x), y: name(y), of: of.map(name), points })
    }

    /// The columns that are drawn where none is asked for: the first two that have numbers, in front of those that are the
    /// same in all rows, as the time at the end of a sweep. Of a section, whose rows begin with the `orbit`, its number and
    /// the time of a crossing come last as well.
    fn axes(&self, numbered: bool) -> (usize, usize) {
        let finite = |k: usize| self.rows.iter().map(move |row| row[k]).filter(|x| x.is_finite());
        let all = || self.rows.iter().flatten().filter(|x| x.is_finite());
        // what a section holds is the same but for rounding
        let greatest = all().fold(0.0, |most: f64, x| most.max(x.abs()));
        let rounding = if numbered { SAME * greatest } else { 0.0 };
        let worth = |k: &usize| {
            let of_crossing = numbered && ["orbit", "n", "t"].contains(&self.columns[*k].as_str());
            match (finite(*k).next(), of_crossing) {
                (None, _) => 3,
                (_, true) => 2,
                (Some(first), false) => u8::from(finite(*k).all(|x| (x - first).abs() <= rounding)),
            }
        };
        let mut all: Vec<usize> = (0..self.columns.len()).collect();
        // those of equal worth stay in their order
        all.sort_by_key(worth);
        (all[0].min(all[1]), all[0].max(all[1]))
    }

    /// Whether the first two columns are places of a lattice: few values, each with many. Where there are only two of
    /// either, each place is there.
    fn is_lattice(&self) -> bool {
        let different = |of: &dyn Fn(&Vec<f64>) -> [u64; 2]| {
            let all: BTreeSet<[u64; 2]> = self.rows.iter().map(of).collect();
            all.len()
        };
        let columns = different(&|row| [row[0].to_bits(); 2]);
        let rows = different(&|row| [row[1].to_bits(); 2]);
        let places = different(&|row| [row[0].to_bits(), row[1].to_bits()]);
        let is_whole = places == columns * rows;
        columns > 1
            && rows > 1
            && (is_whole || (columns.min(rows) > 2 && columns * rows <= 2 * places))
    }
}
