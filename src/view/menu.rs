//! A pop-up list over the page.
//!
//! In: the menu. Out: cells. Never here: what its lines do.

use ratatui::layout::Rect;
use unicode_width::UnicodeWidthStr;

use super::canvas::{Canvas, columns, row};
use super::layout::split_rows;
use super::theme::Role;
use super::values::window;
use super::wrap::words;
use crate::app::Menu;

/// Draws the list in the middle of an area, with what the selected line means below.
pub(super) fn draw(canvas: &mut Canvas<'_>, area: Rect, menu: &Menu) {
    let width = area.width.saturating_sub(2).min(78);
    let shown = menu.shown();
    let search = u16::from(menu.filter.is_some());
    let about = 4;
    // As high as for all its lines, so that it does not jump while they are searched.
    let wanted = (menu.items.len() as u16).clamp(1, 24) + 2 + search + about;
    let height = wanted.min(area.height.saturating_sub(u16::from(area.height > 12) * 2));
    let place = Rect {
        x: area.x + (area.width - width) / 2,
        y: area.y + (area.height - height) / 2,
        width,
        height,
    };
    canvas.clear(place);
    let title = [canvas.span(Role::Title, &menu.title)];
    let inner = canvas.pane(place, &title, true);
    let inner = columns(inner, 1, inner.width.saturating_sub(2));
    let (field, rest) = split_rows(inner, search);
    if let Some(input) = &menu.filter {
        let used = canvas.left(field, Role::Accent, "/ ");
        canvas.left(columns(field, used, field.width), Role::Text, input.value());
        let cursor = used + input.visual_cursor() as u16;
        canvas.tint(columns(field, cursor, 1), Role::Selected);
    }
    let (list, below) = split_rows(rest, rest.height.saturating_sub(about));
    let rows = usize::from(list.height);
    let widest = menu.items.iter().map(|item| canvas.text(&item.label).width()).max().unwrap_or(0);
    let widest = (widest as u16).min(list.width * 3 / 4);
    let first = window(menu.selected, shown.len(), rows);
    for (place, index) in shown.iter().enumerate().skip(first).take(rows) {
        let item = &menu.items[*index];
        let area = row(list, place - first);
        let marked = menu.marked.contains(index);
        let mark = if marked {
            canvas.look.glyphs.pick("✓", "*")
        } else if place == menu.selected {
            canvas.look.glyphs.pick("›", ">")
        } else {
            " "
        };
        canvas.left(columns(area, 0, 1), Role::Accent, mark);
        let role = if item.refusal.is_some() { Role::Dim } else { Role::Text };
        canvas.left(columns(area, 2, widest), role, &item.label);
        let note = item.refusal.as_ref().map_or(item.about.as_str(), |_| "not for this system");
        canvas.left(columns(area, widest + 4, area.width), Role::Dim, note);
        if place == menu.selected {
            canvas.tint(area, Role::Selected);
        }
    }
    if shown.is_empty() {
        canvas.left(columns(row(list, 0), 2, list.width), Role::Dim, "nothing fits what is typed");
    }
    if let Some((_, item)) = menu.current() {
        let (role, text) = match &item.refusal {
            Some(reason) => (Role::Warn, format!("Not for this system: {reason}")),
            None => (Role::Text, item.about.clone()),
        };
        let text = canvas.text(&text);
        for (index, line) in words(&text, inner.width.into()).iter().enumerate() {
            canvas.left(row(below, index + 1), role, line);
        }
    }
}
