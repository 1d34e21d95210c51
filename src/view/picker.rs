//! The picker: the systems by topic, a search, and the selected system's summary and moving preview.
//!
//! In: the picker's state and the lab of the preview. Out: cells. Never here: loading.

use std::collections::HashMap;

use ratatui::layout::Rect;
use tui_input::Input;
use unicode_width::UnicodeWidthStr;

use super::canvas::{Canvas, columns, row};
use super::highlight::found_in;
use super::layout::{split_columns, split_rows};
use super::number::brief;
use super::picture;
use super::quantity::Quantities;
use super::theme::Role;
use super::values::window;
use super::wrap::{capitalised, ending, shortened, words};
use crate::app::{Above, App, FuzzyMatch, HitTarget, Picker, Saved};
use crate::preset::{CatalogEntry, PresetOrigin};

/// The least width of the list if it has something beside it, and of what is beside a list wider than that.
const LIST: u16 = 34;
const BESIDE: u16 = 33;

/// The height from which a narrow screen has room for the preview below the list.
const TALL: u16 = 20;

/// What is said of a system while it is loaded.
const DERIVING: &str = "Deriving its equations of motion; Esc cancels.";

/// Draws the list and the preview.
pub(super) fn draw(canvas: &mut Canvas<'_>, area: Rect, app: &App) {
    if area.width < 64 {
        let about = if area.height > 12 { 4 } else { 0 };
        let moving = if area.height >= TALL { (area.height - about) / 2 } else { 0 };
        let (above, below) = split_rows(area, area.height - about - moving);
        list(canvas, above, &app.picker);
        if let Some(entry) = app.picker.current() {
            let (text, picture) = split_rows(below, about);
            summary(canvas, columns(text, 2, text.width.saturating_sub(4)), entry);
            preview(canvas, picture, app, entry);
        }
        return;
    }
    let (left, right) = split_columns(area, width_of_list(canvas, area.width, &app.picker));
    list(canvas, left, &app.picker);
    let current = app.picker.current();
    if let Some(name) = app.opening().filter(|name| current.is_none_or(|one| one.name != *name)) {
        let inner = canvas.pane(right, &[canvas.span(Role::Title, name)], false);
        sentence(canvas, columns(inner, 1, inner.width.saturating_sub(2)), DERIVING);
        return;
    }
    let Some(entry) = current else {
        let title = match app.picker.selected_above() {
            Some(Above::Guides) => Some("Lessons and demos"),
            Some(Above::NewSystem) => Some("New system"),
            Some(Above::Unsaved) => Some("Unsaved text"),
            Some(Above::Session) | None => None,
        };
        let title = title.map(|title| canvas.span(Role::Title, title));
        let inner = canvas.pane(right, title.as_slice(), false);
        let text = match app.picker.selected_above() {
            Some(Above::Session) => {
                let open = app.picker.session().map_or("it", |session| session.open.as_str());
                format!("Enter continues {open} where you left off.")
            }
            Some(Above::Unsaved) => {
                let title = app.picker.unsaved().unwrap_or("it");
                format!(
                    "Enter returns to {title} in the editor. Its last changes are unsaved; phaselab keeps them until \
                     they are saved."
                )
            }
            Some(Above::Guides) => guided(app),
            Some(Above::NewSystem) => "Enter opens the editor with a small system to begin from: change its \
                 Lagrangian, and the motion runs beside it as soon as there is no error. Nothing is written until you \
                 save it."
                .to_owned(),
            None => "No system fits this search.".to_owned(),
        };
        sentence(canvas, columns(inner, 1, inner.width.saturating_sub(2)), &text);
        return;
    };
    let title = [canvas.span(Role::Title, &entry.info.title)];
    let inner = canvas.pane(right, &title, false);
    let text = columns(inner, 1, inner.width.saturating_sub(2));
    let used = summary(canvas, text, entry);
    let (_, below) = split_rows(inner, used + 1);
    preview(canvas, below, app, entry);
}

/// Writes a sentence at the top of an area.
fn sentence(canvas: &mut Canvas<'_>, area: Rect, sentence: &str) {
    for (index, line) in words(&canvas.text(sentence), area.width.into()).iter().enumerate() {
        if index < area.height.into() {
            canvas.left(row(area, index), Role::Dim, line);
        }
    }
}

/// The width of the list: that of its longest row, or what there is beside the preview.
fn width_of_list(canvas: &Canvas<'_>, width: u16, picker: &Picker) -> u16 {
    let titles = picker.entries.iter().map(|entry| canvas.text(&entry.info.title).width());
    let session = picker.session().map(|session| continuation(canvas, picker, session, usize::MAX));
    // a frame, a mark and a blank at each side
    let longest = titles.chain(session.map(|label| label.width())).max().unwrap_or(0) + 6;
    let longest = u16::try_from(longest).unwrap_or(u16::MAX).max(LIST);
    longest.min(width.saturating_sub(BESIDE).max(LIST))
}

enum ListLine<'a> {
    Above(Above),
    Topic(&'a str),
    System(usize, &'a CatalogEntry, &'a FuzzyMatch),
}

/// A list with fewer rows has no blank one.
const FEW_ROWS: u16 = 8;

fn list(canvas: &mut Canvas<'_>, frame: Rect, picker: &Picker) {
    let shown = picker.found();
    let all = picker.entries.len();
    let count = match picker.search {
        Some(_) => format!("  {} of {all}", shown.len()),
        None => format!("  {all}"),
    };
    let title = [canvas.span(Role::Title, "Systems"), canvas.span(Role::Dim, count)];
    let inner = canvas.pane(frame, &title, true);
    canvas.target(frame, HitTarget::Systems);
    search(
        canvas,
        columns(row(inner, 0), 1, inner.width.saturating_sub(2)),
        picker.search.as_ref(),
    );
    // where there are few rows, none is blank
    let (_, body) = split_rows(inner, if inner.height < FEW_ROWS { 1 } else { 2 });
    let mut lines: Vec<ListLine<'_>> = Vec::new();
    let mut topic = None;
    let mut here = 0;
    for above in picker.above() {
        if picker.selected_above() == Some(above) {
            here = lines.len();
        }
        lines.push(ListLine::Above(above));
    }
    for (place, (index, fit)) in shown.iter().enumerate() {
        let entry = &picker.entries[*index];
        // Search results are ordered by quality of the match, not by topic.
        if picker.pattern().is_none() && topic != Some(entry.topic()) {
            topic = Some(entry.topic());
            lines.push(ListLine::Topic(entry.topic()));
        }
        if picker.is_selected(place) {
            here = lines.len();
        }
        lines.push(ListLine::System(place, entry, fit));
    }
    let rows = usize::from(body.height);
    // what stands above the systems is in sight at the start
    let first = if here < rows { 0 } else { window(here, lines.len(), rows) };
    let choices = |lines: &[ListLine<'_>]| {
        lines.iter().filter(|line| !matches!(line, ListLine::Topic(_))).count()
    };
    let (above, below) = (&lines[..first], lines.get(first + rows..).unwrap_or_default());
    canvas.out_of_sight(frame, choices(above), choices(below));
    let ends = ends_of_titles(canvas, picker, usize::from(body.width.saturating_sub(4)));
    for (index, line) in lines.iter().skip(first).take(rows).enumerate() {
        let area = row(body, index);
        match line {
            ListLine::Topic(topic) => {
                canvas.left(columns(area, 1, area.width - 1), Role::Dim, &capitalised(topic));
            }
            ListLine::Above(above) => {
                canvas.target(area, HitTarget::Above(*above));
                let selected = picker.selected_above() == Some(*above);
                let mark = if selected { canvas.style.glyphs.pick("›", ">") } else { " " };
                canvas.left(columns(area, 1, 1), Role::Accent, mark);
                let field = columns(area, 3, area.width.saturating_sub(4));
                let label = match (above, picker.session()) {
                    (Above::Session, Some(session)) => {
                        continuation(canvas, picker, session, field.width.into())
                    }
                    (Above::Unsaved, _) => {
                        let title = canvas.text(picker.unsaved().unwrap_or_default());
                        let room = usize::from(field.width).saturating_sub("Unsaved: ".len());
                        let mark = canvas.style.glyphs.pick("…", "~");
                        format!("Unsaved: {}", ending(&title, room, mark))
                    }
                    (Above::Guides, _) => canvas.text("Lessons and demos …"),
                    _ => canvas.text("New system …"),
                };
                canvas.left(field, Role::Text, &label);
                if selected {
                    canvas.tint(columns(area, 1, area.width.saturating_sub(2)), Role::Selected);
                }
            }
            ListLine::System(place, entry, fit) => {
                canvas.target(area, HitTarget::System(*place));
                let selected = picker.is_selected(*place);
                let mark = if selected { canvas.style.glyphs.pick("›", ">") } else { " " };
                canvas.left(columns(area, 1, 1), Role::Accent, mark);
                let role = if entry.diagnostic.is_some() { Role::Bad } else { Role::Text };
                let name = columns(area, 3, area.width.saturating_sub(4));
                let whole = &entry.info.title;
                let title = found_in(canvas, ends.get(whole).unwrap_or(whole), (fit, role));
                canvas.spans(name, &title);
                if selected {
                    canvas.tint(columns(area, 1, area.width.saturating_sub(2)), Role::Selected);
                }
            }
        }
    }
}

/// The ends of the titles for which there is no room and whose beginnings are the same as those of others, by the whole
/// titles. The letters of a search are found in whole titles.
fn ends_of_titles<'a>(
    canvas: &Canvas<'_>,
    picker: &'a Picker,
    width: usize,
) -> HashMap<&'a String, String> {
    if picker.pattern().is_some() {
        return HashMap::new();
    }
    let mark = canvas.style.glyphs.pick("…", "~");
    let mut long: HashMap<String, Vec<&String>> = HashMap::new();
    for title in picker.entries.iter().map(|entry| &entry.info.title) {
        if title.width() > width {
            long.entry(shortened(title, width, mark)).or_default().push(title);
        }
    }
    let alike = long.into_values().filter(|titles| titles.len() > 1).flatten();
    alike.map(|title| (title, ending(title, width, mark))).collect()
}

/// Says what lessons and demos are, and how many of them there are.
fn guided(app: &App) -> String {
    let (finished, lessons) = app.lessons_finished();
    let demos = app.picker.guides.len() - lessons;
    let progress = match finished {
        0 => "The first is a tour of three minutes.".to_owned(),
        1 => "One is finished.".to_owned(),
        all if all == lessons => "All are finished.".to_owned(),
        some => format!("{some} are finished."),
    };
    format!(
        "Enter lists {lessons} lessons and {demos} demos. In a lesson you say what you expect before it happens; a demo \
         is watched. {progress}"
    )
}

/// What is left of a title beside the time of a session, at least.
const LEAST_TITLE: usize = 6;

/// Returns the label of the row of a session: its system and its time. Where there is no room for both the title is
/// shortened, and only where little would be left of it the time goes.
fn continuation(canvas: &Canvas<'_>, picker: &Picker, session: &Saved, width: usize) -> String {
    let title = canvas.text(&picker.title_of(session));
    let Some(present) = &session.checkpoint.present else { return format!("Continue: {title}") };
    let time = brief(present.time, 2, canvas.style.glyphs);
    let unit = canvas.text(&session.time_unit);
    let time = format!(", t = {time} {unit}").trim_end().to_owned();
    let room = width.saturating_sub("Continue: ".len());
    let beside = room.saturating_sub(time.width());
    let (room, time) = if beside < LEAST_TITLE { (room, "") } else { (beside, time.as_str()) };
    let title = shortened(&title, room, canvas.style.glyphs.pick("…", "~"));
    format!("Continue: {title}{time}")
}

fn search(canvas: &mut Canvas<'_>, area: Rect, search: Option<&Input>) {
    let Some(input) = search else {
        canvas.left(area, Role::Dim, "/ to search, or begin to type");
        return;
    };
    let used = canvas.left(area, Role::Accent, "/ ");
    let field = columns(area, used, area.width);
    let room = usize::from(field.width.saturating_sub(1));
    let skipped = input.visual_scroll(room);
    let text: String = input.value().chars().skip(skipped).take(room).collect();
    canvas.left(field, Role::Text, &text);
    let cursor = (input.visual_cursor().saturating_sub(skipped)).min(room) as u16;
    canvas.point(columns(field, cursor, 1).as_position());
}

/// Draws a description of the selected system, and returns the number of rows used.
fn summary(canvas: &mut Canvas<'_>, area: Rect, entry: &CatalogEntry) -> u16 {
    let width = usize::from(area.width);
    let mut lines: Vec<(Role, String)> = Vec::new();
    let text = canvas.text(&entry.info.summary);
    lines.extend(words(&text, width).into_iter().map(|line| (Role::Text, line)));
    let own = matches!(entry.origin, PresetOrigin::User(_)) && entry.info.source.is_empty();
    let source = if own { "your own presets" } else { entry.info.source.as_str() };
    let source = canvas.text(source);
    lines.extend(words(&source, width).into_iter().map(|line| (Role::Dim, line)));
    let topics = canvas.text(&entry.info.topics.join(" · "));
    lines.extend(words(&topics, width).into_iter().map(|line| (Role::Dim, line)));
    lines.retain(|(_, line)| !line.is_empty());
    for (index, (role, line)) in lines.iter().enumerate() {
        canvas.left(row(area, index), *role, line);
    }
    lines.len().min(usize::from(area.height)) as u16
}

/// Draws the selected system in motion, or the reason why it cannot be shown.
fn preview(canvas: &mut Canvas<'_>, area: Rect, app: &App, entry: &CatalogEntry) {
    let text = columns(area, 1, area.width.saturating_sub(2));
    if let Some(error) = app.picker.error.as_ref().filter(|error| error.name == entry.name) {
        canvas.left(row(text, 0), Role::Bad, "This file has errors; Enter shows all of them.");
        for (index, line) in error.message.lines().take(usize::from(text.height)).enumerate() {
            canvas.left(row(text, index + 2), Role::Text, line);
        }
        return;
    }
    let lab = app.lab.as_ref().filter(|lab| lab.loaded.name == entry.name);
    let Some((q, lab)) = lab.and_then(|lab| Some((Quantities::of(lab, canvas.style)?, lab))) else {
        let message = match app.loading() {
            Some(name) if name == entry.name => DERIVING.to_owned(),
            Some(name) => format!("Loading {name}; Esc cancels."),
            None => "…".to_owned(),
        };
        sentence(canvas, text, &message);
        return;
    };
    let space = lab.plots.iter().find(|plot| plot.kind.properties().is_scene);
    if let Some(plot) = space.or(lab.plots.first()) {
        picture::draw(canvas, area, (&q, plot), &[]);
    }
}
