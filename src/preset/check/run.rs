//! The settings of a run, validated.

use toml::Spanned;

use super::ModelBuilder;
use crate::model::RunSettings;
use crate::preset::draft::DraftRun;
use crate::printable;

impl ModelBuilder<'_> {
    /// Reads the settings of a run over the defaults.
    pub(super) fn run(&mut self, written: &DraftRun) {
        let usual = RunSettings::default();
        let given = |number: &Option<Spanned<f64>>| number.as_ref().map(|n| *n.get_ref());
        for (number, name) in
            [(&written.speed, "speed"), (&written.step, "step"), (&written.tolerance, "tolerance")]
        {
            if let Some(number) = number.as_ref().filter(|n| *n.get_ref() <= 0.0) {
                self.error(number.span(), format!("`{name}` must be positive"));
            }
        }
        if let Some(tolerance) = written.tolerance.as_ref().filter(|n| *n.get_ref() >= 1.0) {
            self.error(tolerance.span(), "`tolerance` is relative and must be below 1");
        }
        let start = given(&written.start).unwrap_or(usual.start);
        if let Some(until) = written.until.as_ref().filter(|n| *n.get_ref() <= start) {
            self.error(
                until.span(),
                format!("the run ends before its start, t = {}", printable::number(start)),
            );
        }
        self.model.run = RunSettings {
            method: written.method.as_ref().map_or(usual.method, |m| m.get_ref().clone()),
            method_place: written.method.as_ref().map(Spanned::span),
            speed: given(&written.speed).unwrap_or(usual.speed),
            start,
            until: given(&written.until),
            step: given(&written.step),
            tolerance: given(&written.tolerance),
            settings_place: written.tolerance.as_ref().or(written.step.as_ref()).map(Spanned::span),
        };
    }
}
