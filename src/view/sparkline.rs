//! One-row charts: a history of values, and a value within its range.
//!
//! In: any numbers. Out: cells. Never here: a panic on NaN or on a value outside its range, unlike ratatui's gauges.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::widgets::Widget;

use super::glyphs::Glyphs;
use super::plot::Scale;

/// What a column of a history shows of its values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnValue {
    /// The greatest: of drifts, none of which is to be missed.
    Greatest,
    /// The mean: of what rises and falls.
    Mean,
}

impl ColumnValue {
    /// That of some values; NaN where all of them are.
    fn of(self, values: &[f64]) -> f64 {
        let known = values.iter().copied().filter(|value| !value.is_nan());
        match self {
            Self::Greatest => known.fold(f64::NAN, f64::max),
            Self::Mean => {
                let (sum, count) = known.fold((0.0, 0.0), |(sum, count), x| (sum + x, count + 1.0));
                sum / count
            }
        }
    }
}

/// A history with the newest value at the right.
#[derive(Clone, Copy, Debug)]
pub struct Sparkline<'a> {
    /// The values, oldest first. NaN leaves a gap.
    pub values: &'a [f64],
    /// What each column shows.
    pub column: ColumnValue,
    /// The vertical scale.
    pub scale: Scale,
    /// Style of the columns.
    pub style: Style,
    /// The characters used.
    pub glyphs: Glyphs,
}

impl Widget for Sparkline<'_> {
    fn render(self, area: Rect, buffer: &mut Buffer) {
        let area = area.intersection(buffer.area);
        if area.is_empty() || self.values.is_empty() {
            return;
        }
        let steps: &[&str] = self.glyphs.pick(
            &["▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"],
            &[".", ":", "-", "=", "+", "*", "#", "@"],
        );
        let columns = usize::from(area.width).min(self.values.len());
        let start = area.right() - columns as u16;
        for column in 0..columns {
            let share = |column: usize| column * self.values.len() / columns;
            let values = &self.values[share(column)..share(column + 1)];
            let value = self.column.of(values);
            if value.is_nan() {
                continue;
            }
            let fraction = self.scale.fraction(value);
            // A value that a logarithmic scale cannot show is below its range.
            let fraction = if fraction.is_nan() { 0.0 } else { fraction.clamp(0.0, 1.0) };
            let step = ((fraction * steps.len() as f64) as usize).min(steps.len() - 1);
            let place = (start + column as u16, area.bottom() - 1);
            if let Some(cell) = buffer.cell_mut(place) {
                cell.set_symbol(steps[step]).set_style(self.style);
            }
        }
    }
}

/// A value within its range: `━━━━●────`. Outside the range an arrow marks the end; NaN has no knob.
#[derive(Clone, Copy, Debug)]
pub struct RangeBar {
    /// What the knob stands at.
    pub value: f64,
    /// Its range, linear or logarithmic.
    pub scale: Scale,
    /// Style of the part up to the value, and of the knob.
    pub filled: Style,
    /// Style of the rest.
    pub rest: Style,
    /// The characters used.
    pub glyphs: Glyphs,
}

impl Widget for RangeBar {
    fn render(self, area: Rect, buffer: &mut Buffer) {
        let area = area.intersection(buffer.area);
        if area.is_empty() {
            return;
        }
        let fraction = self.scale.fraction(self.value);
        let last = f64::from(area.width - 1);
        let knob = (!fraction.is_nan()).then(|| (fraction.clamp(0.0, 1.0) * last).round() as u16);
        // Rounding at an end of the range must not turn the knob into an arrow.
        let slack = 1e-9;
        let sign = match fraction {
            f if f < -slack => self.glyphs.pick("◂", "<"),
            f if f > 1.0 + slack => self.glyphs.pick("▸", ">"),
            _ => self.glyphs.pick("●", "o"),
        };
        for column in 0..area.width {
            let (symbol, style) = match knob {
                Some(knob) if column == knob => (sign, self.filled),
                Some(knob) if column < knob => (self.glyphs.pick("━", "="), self.filled),
                _ => (self.glyphs.pick("─", "-"), self.rest),
            };
            if let Some(cell) = buffer.cell_mut((area.x + column, area.y)) {
                cell.set_symbol(symbol).set_style(style);
            }
        }
    }
}
