//! A list of values: parameters or initial values, each with its number, its unit and, if it has a range, a bar.
//!
//! In: the lab's values and the selection. Out: cells. Never here: how a value is changed.

use ratatui::layout::{Position, Rect};
use ratatui::widgets::Widget;

use super::canvas::{Canvas, columns, row};
use super::glyphs::{Glyphs, TextWidth};
use super::number::brief_in;
use super::plot::Scale;
use super::region::ScreenRegion;
use super::sparkline::RangeBar;
use super::theme::Role;
use super::wrap::words;
use crate::app::{HitTarget, InputField, Lab, Purpose, ValueId, ValueInfo};
use crate::model;
use crate::num::significant;

const NUMBER: u16 = 10;

/// The greatest width of a name.
const NAME: u16 = 12;

/// The columns of a list: as wide as its longest name and unit.
struct ListColumns {
    number: u16,
    unit: u16,
    bar: u16,
}

pub(super) struct ValueList<'a> {
    pub(super) lab: &'a Lab,
    /// Makes the identifier: parameters or initial values.
    pub(super) kind: fn(usize) -> ValueId,
    /// The index of the selected value.
    pub(super) selected: usize,
    pub(super) focused: bool,
    /// The field in which one of the values is being edited.
    pub(super) field: Option<&'a InputField>,
}

impl ValueList<'_> {
    /// Draws the rows around the selected one and, if there is room, its meaning.
    pub(super) fn draw(&self, canvas: &mut Canvas<'_>, area: Rect) {
        let count = self.lab.count(self.kind);
        if count == 0 {
            canvas.left(row(area, 0), Role::Dim, "  none");
            return;
        }
        let about = self.about(area, count, canvas.style.glyphs);
        canvas.explained |= self.focused && !about.is_empty();
        let grid = self.columns(canvas, count, area.width);
        let rows = usize::from(area.height).saturating_sub(about.len());
        let first = window(self.selected, count, rows);
        for index in first..count.min(first + rows) {
            self.line(canvas, row(area, index - first), (index, &grid));
        }
        let start = usize::from(area.height) - about.len();
        for (index, line) in about.iter().enumerate() {
            let place = columns(row(area, start + index), 2, area.width);
            canvas.left(place, Role::Dim, line);
        }
    }

    /// The meaning of the selected value, whole or not at all: the line below the panes has it too.
    fn about(&self, area: Rect, count: usize, glyphs: Glyphs) -> Vec<String> {
        let spare = usize::from(area.height).saturating_sub(count);
        let target = (self.kind)(self.selected);
        let info = self.lab.value_info(target);
        let text = info.map_or_else(String::new, |info| meaning(self.lab, target, &info, glyphs));
        let width = usize::from(area.width.saturating_sub(3));
        let mut lines = words(&text, width);
        lines.retain(|line| !line.is_empty());
        if lines.len() > spare { Vec::new() } else { lines }
    }

    /// The bars have what names, numbers and units leave.
    fn columns(&self, canvas: &Canvas<'_>, count: usize, width: u16) -> ListColumns {
        let glyphs = canvas.style.glyphs;
        let info: Vec<ValueInfo> =
            (0..count).filter_map(|i| self.lab.value_info((self.kind)(i))).collect();
        let widest = |text: &dyn Fn(&ValueInfo) -> String, most: u16| {
            let wide = info.iter().map(|f| canvas.text(&text(f)).width() as u16).max();
            wide.unwrap_or(0).min(most)
        };
        let name = widest(&|f| glyphs.pick(&f.shown, &f.name).clone(), NAME);
        let number = 3 + name;
        let unit = widest(&unit, width.saturating_sub(number + NUMBER + 1));
        ListColumns { number, unit: number + NUMBER + 1, bar: number + NUMBER + unit + 3 }
    }

    fn line(&self, canvas: &mut Canvas<'_>, area: Rect, (index, grid): (usize, &ListColumns)) {
        let target = (self.kind)(index);
        let Some(info) = self.lab.value_info(target) else { return };
        let value = self.lab.current_value(target);
        let glyphs = canvas.style.glyphs;
        canvas.target(area, HitTarget::Value(target));
        let here = self.selected == index;
        let mark = if here { glyphs.pick("›", ">") } else { " " };
        canvas.left(columns(area, 0, 1), if self.focused { Role::Focus } else { Role::Dim }, mark);
        let name = glyphs.pick(&info.shown, &info.name);
        let role = if here && self.focused { Role::Title } else { Role::Text };
        canvas.left(columns(area, 2, grid.number - 3), role, name);
        let number = columns(area, grid.number, NUMBER);
        let typed = self.field.filter(|field| field.purpose == Purpose::Value(target));
        if let Some(field) = typed {
            typing(canvas, number, field);
        } else {
            let text = value
                .map_or_else(|| "·".to_owned(), |value| brief_in(value, 6, NUMBER.into(), glyphs));
            canvas.right(number, Role::Accent, &text);
            if here && self.focused {
                canvas.tint(number, Role::Selected);
            }
        }
        canvas.left(columns(area, grid.unit, grid.bar - grid.unit - 2), Role::Dim, &unit(&info));
        if let Some(text) = of_file(self.lab, &info, glyphs) {
            let place = columns(area, grid.bar, area.width.saturating_sub(grid.bar + 1));
            if text.width() <= place.width.into() {
                canvas.left(place, Role::Dim, &text);
            }
        }
        if let Some(value) = value {
            let place = columns(area, grid.bar, area.width);
            bar(canvas, place, (target, &info), value, here && self.focused);
        }
    }
}

/// The unit of a value, and whether it changes with the time.
fn unit(info: &ValueInfo) -> String {
    let ramped = if info.ramped { "ramped" } else { "" };
    [info.unit.as_str(), ramped]
        .into_iter()
        .filter(|part| !part.is_empty())
        .collect::<Vec<_>>()
        .join(", ")
}

/// What a value means, what it is in the file if it follows parameters, and whether it is ramped.
pub(super) fn meaning(lab: &Lab, target: ValueId, info: &ValueInfo, glyphs: Glyphs) -> String {
    match lab.value(target) {
        Some(before) if info.ramped => ramped_in_words(&info.about, before),
        _ => {
            let of_file = of_file(lab, info, glyphs);
            let parts = of_file.into_iter().chain([info.about.clone()]);
            parts.filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
        }
    }
}

/// The formula that an initial value follows: `= θ₀`.
pub(super) fn of_file(lab: &Lab, info: &ValueInfo, glyphs: Glyphs) -> Option<String> {
    let pool = &lab.loaded.model.pool;
    info.follows.map(|e| format!("= {}", glyphs.formula(pool, e)))
}

/// The meaning of a value that changes with the time, and what it was before.
fn ramped_in_words(about: &str, before: f64) -> String {
    let about = if about.is_empty() { String::new() } else { format!("{about}; ") };
    let before = significant(before, 6, 1e-4..1e6).replace('-', "−");
    format!("{about}ramped from {before}; the keys change that start value")
}

/// Draws the bar of a value within its range, if it has one and there is room.
fn bar(
    canvas: &mut Canvas<'_>,
    area: Rect,
    (target, info): (ValueId, &ValueInfo),
    value: f64,
    here: bool,
) {
    let Some((min, max, scale)) = info.range else { return };
    if area.width < 6 {
        return;
    }
    let scale = match scale {
        model::RangeSpacing::Linear => Scale::linear(min, max),
        model::RangeSpacing::Log => Scale::log(min, max),
    };
    let filled = canvas.style(if here { Role::Focus } else { Role::Level });
    let rest = canvas.style(Role::Border);
    let bar = RangeBar { value, scale, filled, rest, glyphs: canvas.style.glyphs };
    let place = columns(area, 0, area.width.saturating_sub(1).min(30));
    bar.render(place, canvas.buffer);
    canvas.region(place, ScreenRegion::Bar(target, scale));
}

/// Draws the text of a field with its end in view, and its cursor.
pub(super) fn typing(canvas: &mut Canvas<'_>, area: Rect, field: &InputField) {
    if area.width < 2 {
        return;
    }
    let room = usize::from(area.width - 1);
    let skipped = if field.whole { 0 } else { field.input.visual_scroll(room) };
    let text: String = field.input.value().chars().skip(skipped).take(room).collect();
    let role = if field.diagnostic.is_some() { Role::Bad } else { Role::Text };
    canvas.left(area, role, &format!("{text:<room$}"));
    canvas.tint(area, Role::Title);
    if field.whole {
        canvas.tint(columns(area, 0, text.chars().count() as u16), Role::Selected);
    }
    let cursor = area.x + (field.input.visual_cursor().saturating_sub(skipped)).min(room) as u16;
    canvas.point(Position::new(cursor, area.y));
}

/// The first visible row of a list that shows the selected one as near the middle as possible.
pub(super) fn window(selected: usize, count: usize, rows: usize) -> usize {
    selected.saturating_sub(rows / 2).min(count.saturating_sub(rows))
}
