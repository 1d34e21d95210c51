//! `phaselab plot`: a table of numbers drawn as text.

use std::collections::BTreeSet;
use std::path::PathBuf;

use super::error::CommandError;
use super::interrupt::Interrupt;
use super::number_table::NumberTable;
use super::output::{Output, OutputForm};
use crate::printable;
use crate::view::glyphs::Glyphs;
use crate::view::table_plot::{TablePlot, drawn};

/// Draw a table of numbers as text.
///
/// The table is what D writes in the lab, or run, section and sweep, and others as JSON.
/// Two of its columns are drawn against each other, a third one as shades. By default these are, of
/// a map, its three columns; of a section, a coordinate and its momentum; of a sweep, the first
/// measure over the one or two numbers that were set; otherwise the first two columns whose numbers
/// differ. From what `lyapunov`, `spectrum` and `orbit --along` write with `--format json` the exponent
/// is drawn against the time, the amplitudes against the frequencies, and the family against what it
/// was followed along.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab plot henon-heiles-section.csv
  phaselab plot pendulum.csv --x theta --y p_theta
  phaselab plot henon-heiles-map.csv --size 120x40
  phaselab plot henon-heiles-lyapunov.json
  phaselab plot - --x y --y p_y")]
pub(super) struct Arguments {
    /// A file of comma-separated values or of JSON, or `-` for standard input.
    #[arg(value_name = "TABLE")]
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

/// Numbers of a column of a section that differ by no more than this part of its greatest are the same.
const SAME: f64 = 1e-14;

/// The sizes of a drawing.
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

pub(super) fn execute(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    let path = &arguments.file;
    let table = NumberTable::read(path)?;
    let plot = table.plot(arguments)?;
    let variable = |name: &str| std::env::var(name).ok();
    let glyphs = if arguments.ascii { Glyphs::Ascii } else { Glyphs::from_environment(&variable) };
    let text = drawn(&plot, arguments.size, glyphs);
    interrupt.ends_by_itself(|| ());
    Output::print(OutputForm::Text, &text)
}

/// What a column without a number is worth to be drawn.
const NOTHING: u8 = 3;

struct DrawnColumns {
    x: usize,
    y: usize,
    of: Option<usize>,
}

impl NumberTable {
    fn named(&self, name: &str) -> Result<usize, CommandError> {
        self.columns.iter().position(|column| column == name).ok_or_else(|| {
            let known: Vec<String> = self.columns.iter().map(|c| printable::quoted(c)).collect();
            CommandError::WrongUse(format!(
                "unknown column `{}`; the columns are {}",
                printable::quoted(name),
                known.join(", ")
            ))
        })
    }

    /// What is drawn of it: the columns asked for, or those that follow from its shape.
    fn plot(&self, arguments: &Arguments) -> Result<TablePlot, CommandError> {
        let shape = self.default_columns();
        let given = |name: &Option<String>| name.as_ref().map(|name| self.named(name)).transpose();
        let [x, y] = [given(&arguments.x)?, given(&arguments.y)?];
        let of = given(&arguments.of)?;
        // what is shaded by default belongs to the axes by default
        let shaded = shape.of.filter(|_| self.is_map() || (x, y) == (None, None));
        let (x, y, of) = (x.unwrap_or(shape.x), y.unwrap_or(shape.y), of.or(shaded));
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
        let stems = self.is_spectrum && self.columns[x] == "frequency";
        Ok(TablePlot { title, x: name(x), y: name(y), of: of.map(name), points, stems })
    }

    /// Whether its rows are crossings, which begin with the `orbit`.
    fn is_of_section(&self) -> bool {
        self.columns[0] == "orbit" && self.columns.len() > 2
    }

    /// Whether it has a number at each place of a lattice, and nothing else.
    fn is_map(&self) -> bool {
        !self.is_of_section() && self.columns.len() == 3 && self.is_lattice()
    }

    /// The columns that are drawn where none is asked for.
    fn default_columns(&self) -> DrawnColumns {
        let (x, y) = self.axes();
        if self.is_map() {
            return DrawnColumns { x, y, of: Some(2) };
        }
        let number_of = |name: &str| self.columns.iter().position(|column| column == name);
        // a sweep has what was set in front of what became of it, and what was measured behind
        if let Some(set) = number_of("status").filter(|&k| k > 0 && self.worth(k) == NOTHING) {
            let first = number_of("energy_drift").map_or(set, |drift| drift + 1);
            let differs = |from: usize| (from..self.columns.len()).find(|&k| self.worth(k) == 0);
            let measured = differs(first).or_else(|| differs(set));
            match (set, measured) {
                (1, Some(y)) => return DrawnColumns { x: 0, y, of: None },
                (2, Some(of)) => return DrawnColumns { x: 0, y: 1, of: Some(of) },
                _ => {}
            }
        }
        // of a coordinate and the columns after it its momentum or its rate is drawn
        let conjugate = self.is_of_section().then(|| {
            let name = &self.columns[x];
            let names = [format!("p_{name}"), format!("{name}'")];
            names.iter().find_map(|name| number_of(name).filter(|&k| self.worth(k) == 0))
        });
        DrawnColumns { x, y: conjugate.flatten().unwrap_or(y), of: None }
    }

    /// The first two columns that have numbers, in front of those that are the same in all rows, as the time at the end of a
    /// sweep. Of a section its number and the time of a crossing come last as well.
    fn axes(&self) -> (usize, usize) {
        let mut all: Vec<usize> = (0..self.columns.len()).collect();
        // those of equal worth stay in their order
        all.sort_by_key(|&k| self.worth(k));
        (all[0].min(all[1]), all[0].max(all[1]))
    }

    /// How little a column is worth to be drawn: 0 where its numbers differ.
    fn worth(&self, k: usize) -> u8 {
        let finite = || self.rows.iter().map(|row| row[k]).filter(|x| x.is_finite());
        let of_section = self.is_of_section();
        let of_crossing = of_section && ["orbit", "n", "t"].contains(&self.columns[k].as_str());
        // what a section holds is the same but for rounding
        let greatest = finite().fold(0.0, |most: f64, x| most.max(x.abs()));
        let rounding = if of_section { SAME * greatest } else { 0.0 };
        match finite().next() {
            None => NOTHING,
            Some(_) if of_crossing => 2,
            Some(first) => {
                let is_same = finite().all(|x| (x - first).abs() <= rounding);
                u8::from(is_same || of_section && self.is_on_surface(k))
            }
        }
    }

    /// Whether the surface of a section leaves a column its zeros alone, as it is a function of nothing else: these may be zero
    /// but for rounding, which nothing in the column itself can be compared with.
    fn is_on_surface(&self, k: usize) -> bool {
        let Some(surface) = &self.surface else { return false };
        let of_name = |c: char| c.is_alphanumeric() || c == '_' || c == '\'';
        let names: BTreeSet<&str> = surface.split(|c| !of_name(c)).collect();
        let is_in = |column: &String| names.contains(column.as_str());
        is_in(&self.columns[k]) && self.columns.iter().filter(|column| is_in(column)).count() == 1
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
