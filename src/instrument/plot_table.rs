//! What an instrument has computed, as a table.
//!
//! In: numbers. Out: [`PlotTable`]. Never here: files.

/// Named columns and rows of numbers.
#[derive(Clone, PartialEq, Debug)]
pub struct PlotTable {
    /// The names of the columns.
    pub columns: Vec<String>,
    /// How many of the columns, from the first on, hold whole numbers.
    pub counts: usize,
    /// The rows, each with a number for every column.
    pub rows: Vec<Vec<f64>>,
}
