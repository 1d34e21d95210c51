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

pub(super) fn read(top: &mut Table<'_>, mistakes: &mut Diagnostics) -> DraftRun {
    let Some(mut table) = top.table("run", mistakes) else { return DraftRun::default() };
    let run = DraftRun {
        method: table.text("method", mistakes),
        speed: table.number("speed", mistakes),
        start: table.number("start", mistakes),
        until: table.number("until", mistakes),
        step: table.number("step", mistakes),
        tolerance: table.number("tolerance", mistakes),
    };
    table.finish(mistakes);
    run
}
