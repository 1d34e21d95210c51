//! Tables of numbers in files: comma-separated values, and what commands write as JSON.
//!
//! In: a file. Out: a [`NumberTable`]. Never here: which of its columns are drawn.

use std::path::Path;

use serde_json::{Map, Value};

use super::error::CommandError;
use crate::{file, printable};

/// The greatest size of a file that is read.
const LIMIT: u64 = 256 << 20;

/// What has no table, and what can be done about it.
const ADVICE: &str = "a table is what D writes in the lab, `run`, `section` and `sweep` with `--format csv` or `json`, and \
                      `lyapunov`, `spectrum` and `orbit --along` with `--format json`";

/// Named columns of numbers; where there is none, NaN.
pub(super) struct NumberTable {
    /// What was computed; may be empty.
    pub(super) title: String,
    pub(super) columns: Vec<String>,
    pub(super) rows: Vec<Vec<f64>>,
    /// The expression that vanishes in all rows of a section, if the file says it.
    pub(super) surface: Option<String>,
    /// Whether its rows are the lines of a spectrum.
    pub(super) is_spectrum: bool,
}

impl NumberTable {
    /// Reads a file, or standard input for `-`.
    ///
    /// # Errors
    /// Returns an error if it cannot be read, or if there is no table in it.
    pub(super) fn read(path: &Path) -> Result<NumberTable, CommandError> {
        let shown = printable::path(path);
        let read = if path == Path::new("-") {
            let mut bytes = Vec::new();
            let mut input = std::io::Read::take(std::io::stdin().lock(), LIMIT + 1);
            std::io::Read::read_to_end(&mut input, &mut bytes).map(|_| bytes)
        } else {
            file::read(path, LIMIT).map(|(bytes, _)| bytes)
        };
        let bytes = read.map_err(|why| CommandError::reading(path, &why))?;
        let wrong = |what: String| CommandError::WrongFile(format!("{shown}: {what}"));
        if bytes.len() as u64 > LIMIT {
            return Err(wrong("a table may be 256 MiB at most; this one is larger".to_owned()));
        }
        let text =
            String::from_utf8(bytes).map_err(|_| wrong("it is not UTF-8 text".to_owned()))?;
        let is_json = text.trim_start().starts_with('{');
        let table = if is_json { of_json(&text) } else { of_values(&text) }.map_err(wrong)?;
        if table.columns.len() < 2 || table.rows.is_empty() {
            return Err(wrong(format!("it does not have two columns with rows; {ADVICE}")));
        }
        Ok(table)
    }
}

/// The table of comma-separated values. What else is said stands in lines that begin with `#`.
fn of_values(text: &str) -> Result<NumberTable, String> {
    let header = |word: &str| text.lines().find_map(|line| line.strip_prefix(word));
    let title = header("# phaselab ").and_then(|line| line.split_once(": "));
    // the direction in which it is crossed stands last
    let surface = header("# section: ").and_then(|line| line.rsplit_once(' '));
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let what = |why: csv::Error| match title {
        Some(_) => why.to_string(),
        None => format!("it is not a table ({why}); {ADVICE}"),
    };
    let head = reader.headers().map_err(what)?;
    let columns: Vec<String> = head.iter().map(str::to_owned).collect();
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(what)?;
        rows.push(record.iter().map(|cell| cell.parse().unwrap_or(f64::NAN)).collect());
    }
    Ok(NumberTable {
        title: title.map_or("", |(_, title)| title).to_owned(),
        columns,
        rows,
        surface: surface.map(|(on, _)| on.to_owned()),
        is_spectrum: false,
    })
}

/// JSON of one value a line, as `--format jsonl` writes it: an object with the names of columns, then a row in each line, and another
/// object at the end.
fn of_lines(text: &str) -> Option<Value> {
    let mut values = serde_json::Deserializer::from_str(text).into_iter::<Value>();
    let mut all = values.next()?.ok().filter(|head| head["columns"].is_array())?;
    let values: Vec<Value> = values.collect::<Result<_, _>>().ok()?;
    all["rows"] = Value::Array(values.into_iter().filter(Value::is_array).collect());
    Some(all)
}

/// The table in a JSON object that a command wrote: its rows, the course of an exponent, the lines of a spectrum, or a family of
/// orbits.
fn of_json(text: &str) -> Result<NumberTable, String> {
    let all = serde_json::from_str(text)
        .or_else(|why| of_lines(text).ok_or(why))
        .map_err(|why| format!("it is not JSON: {why}"))?;
    let word = |key: &str| all[key].as_str().map(str::to_owned);
    let list = |key: &str| all[key].as_array();
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let cells = |row: &Value| row.as_array().map(|row| row.iter().map(number).collect());
    let (columns, rows): (Vec<String>, Vec<Option<Vec<f64>>>) = if let Some(names) = list("columns")
    {
        let names = names.iter().map(|name| name.as_str().unwrap_or_default().to_owned());
        (
            names.collect(),
            list("rows").map_or_else(Vec::new, |rows| rows.iter().map(cells).collect()),
        )
    } else if let Some(curve) = list("curve") {
        (vec!["t".to_owned(), "exponent".to_owned()], curve.iter().map(cells).collect())
    } else if let Some(lines) = list("lines") {
        // amplitudes of lines differ by powers of ten
        let row = |line: &Value| {
            let amplitude = crate::num::math::log10(number(&line["amplitude"]));
            Some(vec![number(&line["frequency"]), amplitude])
        };
        (
            vec!["frequency".to_owned(), "log10 amplitude".to_owned()],
            lines.iter().map(row).collect(),
        )
    } else if let (Some(along), Some(family)) = (word("along"), list("family")) {
        of_family(along, family)
    } else {
        return Err(format!("it contains no table; {ADVICE}"));
    };
    let count = columns.len();
    let rows: Option<Vec<Vec<f64>>> =
        rows.into_iter().map(|row| row.filter(|row| row.len() == count)).collect();
    Ok(NumberTable {
        title: word("title").unwrap_or_default(),
        columns,
        rows: rows.ok_or("its rows do not have one number for each column")?,
        surface: word("on"),
        is_spectrum: list("columns").is_none()
            && list("curve").is_none()
            && list("lines").is_some(),
    })
}

/// A family of orbits: the number along which it was followed, then those of each orbit that are not this one.
fn of_family(along: String, family: &[Value]) -> (Vec<String>, Vec<Option<Vec<f64>>>) {
    let whole = |orbit: &Value| orbit["start"].as_object().cloned().unwrap_or_default();
    let start: Vec<String> =
        family.first().map(whole).unwrap_or_default().keys().cloned().collect();
    let own = ["period", "energy", "trace"].into_iter().filter(|name| *name != along);
    let own: Vec<String> = own.map(str::to_owned).collect();
    let number = |orbit: &Map<String, Value>, name: &String| {
        orbit.get(name).and_then(Value::as_f64).unwrap_or(f64::NAN)
    };
    let row = |orbit: &Value| {
        let first = orbit["value"].as_f64().unwrap_or(f64::NAN);
        let values = orbit.as_object().cloned().unwrap_or_default();
        let values = own.iter().map(move |name| number(&values, name));
        let at = whole(orbit);
        let at = start.iter().map(move |name| number(&at, name));
        Some([first].into_iter().chain(values).chain(at).collect())
    };
    let rows = family.iter().map(row).collect();
    ([vec![along], own.clone(), start.clone()].concat(), rows)
}
