//! A pop-up list over the page.
//!
//! In: the menu. Out: cells. Never here: what its lines do.

use ratatui::layout::Rect;
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

use super::canvas::{Canvas, Span, columns, row};
use super::layout::split_rows;
use super::theme::Role;
use super::values::window;
use super::wrap::{capitalised, words};
use crate::app::{Choice, Fit, Item, Menu, Spot};

/// Draws the list in the middle of an area, with what the selected line means below.
pub(super) fn draw(canvas: &mut Canvas<'_>, area: Rect, menu: &Menu) {
    let width = area.width.saturating_sub(2).min(78);
    let shown = menu.found();
    let search = u16::from(menu.filter.is_some());
    let about = if area.height > 14 { 4 } else { 2 };
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
    canvas.spot(place, Spot::Menu);
    let inner = columns(inner, 1, inner.width.saturating_sub(2));
    let (field, rest) = split_rows(inner, search);
    if let Some(input) = &menu.filter {
        let used = canvas.left(field, Role::Accent, "/ ");
        canvas.left(columns(field, used, field.width), Role::Text, input.value());
        let cursor = used + input.visual_cursor() as u16;
        canvas.point(columns(field, cursor, 1).as_position());
    }
    let (list, below) = split_rows(rest, rest.height.saturating_sub(about).max(1));
    let rows = usize::from(list.height);
    let columns_of = Columns::of(canvas, menu, list.width);
    let first = window(menu.selected, shown.len(), rows);
    for (place, (index, fit)) in shown.iter().enumerate().skip(first).take(rows) {
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
        canvas.spot(area, Spot::Line(place));
        line(canvas, area, (&menu.items[*index], fit), &columns_of);
        if place == menu.selected {
            canvas.tint(area, Role::Selected);
        }
    }
    if shown.is_empty() {
        canvas.left(columns(row(list, 0), 2, list.width), Role::Dim, "nothing fits what is typed");
    }
    if let Some((_, item)) = menu.current() {
        let (role, text) = match &item.refusal {
            Some(reason) => (Role::Warn, format!("{}: {reason}", capitalised(refused(item)))),
            None => (Role::Text, item.about.clone()),
        };
        let text = canvas.text(&text);
        let room = usize::from(below.height.saturating_sub(1));
        for (index, line) in words(&text, inner.width.into()).iter().take(room).enumerate() {
            canvas.left(row(below, index + 1), role, line);
        }
    }
}

/// Where the columns of the lines stand: as wide as the longest label and keys.
struct Columns {
    label: u16,
    keys: u16,
}

impl Columns {
    fn of(canvas: &Canvas<'_>, menu: &Menu, width: u16) -> Self {
        let widest = |text: fn(&Item) -> &str| {
            let wide = menu.items.iter().map(|item| canvas.text(text(item)).width());
            wide.max().unwrap_or(0).min(usize::from(width)) as u16
        };
        let keys = widest(|item| &item.keys).min(width / 3);
        let label = widest(|item| &item.label);
        // Where there are keys they matter more than what is said about the line, which stands below the list too.
        let most = if keys > 0 { width.saturating_sub(keys + 4) } else { width * 3 / 4 };
        Self { label: label.min(most), keys }
    }
}

/// A line: its label with the letters found, what is said about it or why not, the keys at the right.
fn line(canvas: &mut Canvas<'_>, area: Rect, (item, fit): (&Item, &Fit), grid: &Columns) {
    let role = if item.refusal.is_some() { Role::Dim } else { Role::Text };
    canvas.spans(columns(area, 2, grid.label), &label(canvas, item, (fit, role)));
    canvas.right(
        columns(area, area.width.saturating_sub(grid.keys), grid.keys),
        Role::Accent,
        &item.keys,
    );
    let room =
        area.width.saturating_sub(grid.label + 4 + if grid.keys > 0 { grid.keys + 2 } else { 0 });
    let note = if item.refusal.is_some() { refused(item) } else { &item.about };
    if room >= LEAST_NOTE {
        canvas.left(columns(area, grid.label + 4, room), Role::Dim, note);
    }
}

/// What is said about a line needs so many columns beside it.
const LEAST_NOTE: u16 = 8;

/// The label in pieces, those that were found marked.
fn label(canvas: &Canvas<'_>, item: &Item, (fit, role): (&Fit, Role)) -> Vec<Span> {
    let mut spans: Vec<Span> = Vec::new();
    let mut last = None;
    for (place, letter) in item.label.chars().enumerate() {
        let found = fit.letters.binary_search(&place).is_ok();
        // A combining dot goes with its letter.
        let combining = letter.width() == Some(0);
        if last != Some(found) && !combining || spans.is_empty() {
            let marked = canvas.style(Role::Accent).underlined();
            spans.push((String::new(), if found { marked } else { canvas.style(role) }));
            last = Some(found);
        }
        if let Some((text, _)) = spans.last_mut() {
            text.push(letter);
        }
    }
    spans.into_iter().map(|(text, style)| (canvas.text(&text), style)).collect()
}

/// Why a line cannot be taken, in three words.
fn refused(item: &Item) -> &'static str {
    match item.choice {
        Choice::Method(_) => "not for this system",
        _ => "not here",
    }
}
