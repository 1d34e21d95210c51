//! Parameters: value, range and scale, with a default range if the file gives none.

use toml::Spanned;

use super::ModelBuilder;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::nearest;
use crate::expr::{Rank, latex_of_unicode, unicode_name};
use crate::model::{Parameter, RangeSpacing};
use crate::num::math;
use crate::preset::draft::DraftParameter;

impl ModelBuilder<'_> {
    pub(super) fn parameter(&mut self, written: &DraftParameter) {
        let name = written.name.get_ref();
        let shown =
            if written.symbol.is_empty() { unicode_name(name) } else { written.symbol.clone() };
        let symbol = self.model.pool.symbol(name);
        self.model.pool.describe(symbol, &shown, &latex_of_unicode(&shown), Rank::Constant);
        self.note_degrees(symbol, &written.unit);
        let scale = written.scale.as_ref().map_or(RangeSpacing::Linear, |scale| self.scale(scale));
        let value = written.value.as_ref().map_or(1.0, |v| *v.get_ref());
        let (min, max) = self.range(written, value, scale);
        self.model.parameters.push(Parameter {
            name: name.clone(),
            shown,
            symbol,
            value,
            min,
            max,
            scale,
            unit: written.unit.clone(),
            about: written.about.clone(),
        });
    }

    fn scale(&mut self, written: &Spanned<String>) -> RangeSpacing {
        match written.get_ref().as_str() {
            "linear" => RangeSpacing::Linear,
            "log" => RangeSpacing::Log,
            other => {
                let help = match nearest(other, ["linear", "log"]) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => "a scale is `linear` or `log`".to_owned(),
                };
                let message = format!("unknown scale `{other}`");
                self.diagnostics.push(Diagnostic::error(written.span(), message).with_help(help));
                RangeSpacing::Linear
            }
        }
    }

    /// The range, with missing ends filled in.
    fn range(&mut self, written: &DraftParameter, value: f64, scale: RangeSpacing) -> (f64, f64) {
        let given = |end: &Option<Spanned<f64>>| end.as_ref().map(|v| *v.get_ref());
        let (min, max) = (given(&written.min), given(&written.max));
        let name = written.name.get_ref();
        if let (Some(min), Some(max), Some(place)) = (min, max, &written.max)
            && min >= max
        {
            let message = format!("the range of `{name}` is empty: min is {min}, max is {max}");
            self.error(place.span(), message);
        } else if let Some(place) = &written.value {
            let beyond = match (min, max) {
                (Some(min), _) if value < min => Some(format!("below its min, {min}")),
                (_, Some(max)) if value > max => Some(format!("above its max, {max}")),
                _ => None,
            };
            if let Some(beyond) = beyond {
                self.error(place.span(), format!("the value of `{name}` is {beyond}"));
            }
        }
        if scale == RangeSpacing::Log {
            let end =
                [&written.min, &written.value].into_iter().flatten().find(|v| *v.get_ref() <= 0.0);
            if let Some(end) = end {
                let message = format!("on a log scale the range of `{name}` must be positive");
                self.error(end.span(), message);
            }
        }
        fill(value, min, max, scale)
    }
}

/// Fills in the missing ends of a range: 0 to twice the value, −1 to 1 for zero, or a factor of ten
/// to each side on a log scale, widened to 1, 2 or 5 times a power of ten.
fn fill(value: f64, min: Option<f64>, max: Option<f64>, scale: RangeSpacing) -> (f64, f64) {
    let (low, high) = if scale == RangeSpacing::Log && value > 0.0 {
        (1.0 / nice_above(10.0 / value), nice_above(10.0 * value))
    } else if value > 0.0 {
        (0.0, nice_above(2.0 * value))
    } else if value < 0.0 {
        (-nice_above(-2.0 * value), 0.0)
    } else {
        (-1.0, 1.0)
    };
    match (min, max) {
        (Some(min), Some(max)) => (min, max),
        (Some(min), None) if high > min => (min, high),
        (Some(min), None) => (min, min + nice_above(min.abs().max(f64::MIN_POSITIVE))),
        (None, Some(max)) if low < max => (low, max),
        (None, Some(max)) => (max - nice_above(max.abs().max(f64::MIN_POSITIVE)), max),
        (None, None) => (low, high),
    }
}

/// The least of 1, 2, 5, 10, … times a power of ten that is not below a positive number, or the
/// number itself if none is finite.
fn nice_above(x: f64) -> f64 {
    let power = math::log10(x).floor();
    let steps = [1.0, 2.0, 5.0, 10.0];
    let nice = steps.into_iter().map(|s| decimal(s, power)).find(|&nice| nice >= x);
    nice.filter(|nice| nice.is_finite()).unwrap_or(x)
}

/// `digit · 10^power`, as the f64 nearest to that decimal.
fn decimal(digit: f64, power: f64) -> f64 {
    format!("{digit}e{power}").parse().unwrap_or(f64::INFINITY)
}
