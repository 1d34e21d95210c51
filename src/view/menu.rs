//! A pop-up list over the page.
//!
//! In: the menu. Out: cells. Never here: what its items do.

use ratatui::layout::Rect;
use unicode_width::UnicodeWidthStr;

use super::canvas::{Canvas, columns, row};
use super::help::named;
use super::highlight::found_in;
use super::layout::split_rows;
use super::theme::Role;
use super::values::window;
use super::wrap::{capitalised, words, words_in};
use crate::app::{Choice, Choosing, FuzzyMatch, HitTarget, Item, Menu};

/// Draws the list in the middle of an area, with the meaning of the selected item below it.
pub(super) fn draw(canvas: &mut Canvas<'_>, area: Rect, menu: &Menu) {
    let width = width(canvas, menu).clamp(MOST.0, MOST.1).min(area.width.saturating_sub(2));
    let shown = menu.found();
    let search = u16::from(menu.filter.is_some());
    let about = about(canvas, menu, (width, area.height));
    // The height fits all items, so that it does not change during a search.
    let most = (area.height * 3 / 5).max(24);
    let wanted = (menu.items.len() as u16).clamp(1, most) + 2 + search + about;
    let height = wanted.min(area.height.saturating_sub(u16::from(area.height > 12) * 2));
    let title = canvas.span(Role::Title, &menu.title);
    let (place, inner) = canvas.dialog(area, (width, height), title);
    canvas.target(place, HitTarget::Menu);
    let (field, rest) = split_rows(inner, search);
    if let Some(input) = &menu.filter {
        let used = canvas.left(field, Role::Accent, "/ ");
        canvas.left(columns(field, used, field.width), Role::Text, input.value());
        let cursor = used + input.visual_cursor() as u16;
        canvas.point(columns(field, cursor, 1).as_position());
    }
    let (list, below) = split_rows(rest, rest.height.saturating_sub(about).max(1));
    let rows = usize::from(list.height);
    let columns_of = MenuColumns::of(canvas, menu, list.width);
    let first = window(menu.selected, shown.len(), rows);
    canvas.out_of_sight(place, first, shown.len().saturating_sub(first + rows));
    for (place, (index, fit)) in shown.iter().enumerate().skip(first).take(rows) {
        let area = row(list, place - first);
        let marked = menu.marked.contains(index);
        let mark = if marked {
            canvas.style.glyphs.pick("✓", "*")
        } else if place == menu.selected {
            canvas.style.glyphs.pick("›", ">")
        } else {
            " "
        };
        canvas.left(columns(area, 0, 1), Role::Accent, mark);
        canvas.target(area, HitTarget::Line(place));
        line(canvas, area, (&menu.items[*index], fit), &columns_of);
        if place == menu.selected {
            canvas.tint(area, Role::Selected);
        }
    }
    if shown.is_empty() {
        let text = match menu.purpose {
            Choosing::Contents { .. } | Choosing::Axis { .. } => {
                "no match; Enter uses it as an expression"
            }
            Choosing::Action => "no match: F1 lists all keys",
            _ => "no match",
        };
        canvas.left(columns(row(list, 0), 2, list.width), Role::Dim, text);
    }
    if let Some((_, item)) = menu.current() {
        let role = if item.unavailable.is_some() { Role::Warn } else { Role::Text };
        let text = meaning(canvas, item, &columns_of);
        let room = usize::from(below.height.saturating_sub(1));
        for (index, line) in words_in(&text, inner.width.into(), room).iter().enumerate() {
            canvas.left(row(below, index + 1), role, line);
        }
    }
}

/// The least and greatest width of a list.
const MOST: (u16, u16) = (78, 120);

/// Columns between the parts of a row.
const GAP: u16 = 2;

/// The rightmost column at which a note may begin.
const NOTE: u16 = 48;

/// The width that fits all labels and keys, and part of the notes.
fn width(canvas: &Canvas<'_>, menu: &Menu) -> u16 {
    let line = |item: &Item| canvas.text(&item.label).width() + keys_of(canvas, item).width();
    let widest = menu.items.iter().map(line).max().unwrap_or(0).min(usize::from(MOST.1)) as u16;
    widest + 3 * GAP + 2
}

/// What an item means, or why it cannot be selected; a label that is cut in its row comes first, in full.
fn meaning(canvas: &Canvas<'_>, item: &Item, columns_of: &MenuColumns) -> String {
    let text = match &item.unavailable {
        Some(reason) => format!("{}: {reason}", capitalised(refused(item))),
        None => item.about.clone(),
    };
    let whole = canvas.text(&item.label).width() <= columns_of.room(canvas, item).into();
    let label = match item.choice {
        // it begins with a symbol
        Choice::Equilibrium(_) | Choice::Mode(..) => item.label.trim_start().to_owned(),
        _ => capitalised(&item.label),
    };
    canvas.text(&if whole { text } else { format!("{label}. {text}") })
}

/// Rows for the meaning of the selected item, the same for all items: as many as the longest needs, if there is room.
fn about(canvas: &Canvas<'_>, menu: &Menu, (width, height): (u16, u16)) -> u16 {
    let most = if height > 14 { 6 } else { 2 };
    let inner = width.saturating_sub(4);
    let columns_of = MenuColumns::of(canvas, menu, inner);
    let needs = |item: &Item| words(&meaning(canvas, item, &columns_of), inner.into()).len() as u16;
    menu.items.iter().map(needs).max().unwrap_or(0).saturating_add(1).clamp(2, most)
}

/// The keys of an item as they are labelled on keyboards.
fn keys_of(canvas: &Canvas<'_>, item: &Item) -> String {
    named(&item.keys, canvas.style)
}

struct MenuColumns {
    width: u16,
    /// The width of the labels; the note begins after it unless the label is longer.
    label: u16,
    keys: u16,
}

impl MenuColumns {
    fn of(canvas: &Canvas<'_>, menu: &Menu, width: u16) -> Self {
        let widest = |wide: &dyn Fn(&Item) -> usize| {
            let wide = menu.items.iter().map(wide);
            wide.max().unwrap_or(0).min(usize::from(width)) as u16
        };
        let keys = widest(&|item| keys_of(canvas, item).width());
        let label = widest(&|item| canvas.text(&item.label).width());
        Self { width, label: label.min(NOTE).min(width * 3 / 4), keys }
    }

    /// The columns available to an item's label, up to its keys.
    fn room(&self, canvas: &Canvas<'_>, item: &Item) -> u16 {
        let keys = keys_of(canvas, item).width() as u16;
        let right = if keys > 0 { keys + GAP } else { 0 };
        self.width.saturating_sub(2 + right)
    }
}

/// Draws a row: the label with the matching letters highlighted, the note or the reason it is disabled, and the keys.
fn line(
    canvas: &mut Canvas<'_>,
    area: Rect,
    (item, fit): (&Item, &FuzzyMatch),
    grid: &MenuColumns,
) {
    let role = if item.unavailable.is_some() { Role::Dim } else { Role::Text };
    let label = found_in(canvas, &item.label, (fit, role));
    let used = canvas.spans(columns(area, 2, grid.room(canvas, item)), &label);
    canvas.right(
        columns(area, area.width.saturating_sub(grid.keys), grid.keys),
        Role::Accent,
        &keys_of(canvas, item),
    );
    let keys = keys_of(canvas, item).width() as u16 + GAP;
    let from = 2 + grid.label + GAP;
    let beside = if used > grid.label { 0 } else { area.width };
    let room = beside.saturating_sub(from + keys);
    let note = if item.unavailable.is_some() { refused(item) } else { &item.about };
    if let Some(note) = shortened(canvas, note, room) {
        canvas.left(columns(area, from, room), Role::Dim, note);
    }
}

/// A note, or its first parts that have room: a name stands before what is said of it. What has no such parts is cut.
fn shortened<'t>(canvas: &Canvas<'_>, note: &'t str, room: u16) -> Option<&'t str> {
    let fits = |part: &&str| canvas.text(part).width() <= usize::from(room);
    let ends = [" · ", ": "].into_iter().flat_map(|mark| note.match_indices(mark));
    let parts = ends.map(|(at, _)| &note[..at]).chain([note]);
    let longest = parts.filter(fits).max_by_key(|part| part.len());
    longest.or(if room >= LEAST_NOTE { Some(note) } else { None })
}

/// The least width of a note that is cut.
const LEAST_NOTE: u16 = 16;

/// A short reason why an item cannot be selected.
fn refused(item: &Item) -> &'static str {
    match item.choice {
        Choice::Method(_) => "not for this system",
        Choice::System(_) => "is open",
        _ => "not here",
    }
}
