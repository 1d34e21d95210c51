//! The settings of a run, as written.

use toml::Spanned;

use super::table::Table;
use crate::diagnostic::Diagnostics;

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

pub(super) fn read(top: &mut Table<'_>, diagnostics: &mut Diagnostics) -> DraftRun {
    let Some(mut table) = top.table("run", diagnostics) else { return DraftRun::default() };
    let run = DraftRun {
        method: table.text("method", diagnostics),
        speed: table.number("speed", diagnostics),
        start: table.number("start", diagnostics),
        until: table.number("until", diagnostics),
        step: table.number("step", diagnostics),
        tolerance: table.number("tolerance", diagnostics),
    };
    table.finish(diagnostics);
    run
}
