//! The settings of a run, as written.

use toml::Spanned;

use super::table::Table;

/// `[run]` as written.
#[derive(Default)]
pub(in crate::preset) struct DraftRun {
    pub(in crate::preset) method: Option<Spanned<String>>,
    pub(in crate::preset) speed: Option<Spanned<f64>>,
    pub(in crate::preset) start: Option<Spanned<f64>>,
    pub(in crate::preset) until: Option<Spanned<f64>>,
    pub(in crate::preset) step: Option<Spanned<f64>>,
    pub(in crate::preset) tolerance: Option<Spanned<f64>>,
}

pub(super) fn read(top: &mut Table<'_>) -> DraftRun {
    let Some(table) = top.table("run") else { return DraftRun::default() };
    table.read(|table| DraftRun {
        method: table.text("method"),
        speed: table.number("speed"),
        start: table.number("start"),
        until: table.number("until"),
        step: table.number("step"),
        tolerance: table.number("tolerance"),
    })
}
