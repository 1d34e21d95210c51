//! The workbench: the editor of a system's file with its diagnostics, and beside it the system in motion.
//!
//! In: the workbench, the lab. Out: cells, and how much of the text they show. Never here: what is wrong with a text.

use std::borrow::Cow;

use ratatui::layout::{Position, Rect};
use ratatui::style::{Modifier, Style};
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

use super::canvas::{Canvas, columns, row};
use super::footer::notice_role;
use super::lab_page;
use super::layout::{split_columns, split_rows};
use super::syntax::{long_text_after, roles};
use super::theme::Role;
use super::wrap::words;
use crate::app::{
    App, Asking, BufferDiagnostic, BufferState, Caret, Drawn, Notification, SourceBuffer,
};

/// The width from which the lab is shown beside the text, and the size from which its motion alone is.
const WIDE: u16 = 112;
const NARROW: (u16, u16) = (78, 8);

/// The least width of the text beside the motion: every status fits in it.
const TEXT: u16 = 56;

/// The rows below the text, for its status and the diagnostic at the cursor.
const FOOT: u16 = 4;

/// So few of these rows have no room for a status beside a diagnostic.
const FEW: u16 = 3;

/// Draws the workbench, and the lab if there is room beside it.
pub(super) fn draw(canvas: &mut Canvas<'_>, area: Rect, app: &App, file: &SourceBuffer) -> Drawn {
    let mut left = area;
    if let Some(lab) = app.lab.as_ref().filter(|_| area.width >= WIDE) {
        let (text, beside) = split_columns(area, area.width * 11 / 20);
        canvas.beside = true;
        lab_page::draw(canvas, beside, app, lab);
        canvas.beside = false;
        left = text;
    } else if let Some(lab) = &app.lab
        && area.width >= NARROW.0
        && area.height >= NARROW.1
    {
        let (text, beside) = split_columns(area, (area.width * 2 / 3).max(TEXT));
        canvas.beside = true;
        lab_page::draw_motion(canvas, beside, lab);
        canvas.beside = false;
        left = text;
    }
    let place = file.editor.cursor();
    let title = [
        canvas.span(Role::Title, &file.title),
        canvas.span(Role::Warn, if file.is_modified() { "  unsaved" } else { "" }),
        canvas.span(Role::Dim, format!("  {}:{}", place.row + 1, place.column + 1)),
    ];
    let inner = canvas.pane(left, &title, true);
    let room = usize::from(inner.width.saturating_sub(2));
    let notice = app
        .notifications
        .shown
        .as_ref()
        .map(|notice| words(&canvas.text(&notice.text), room).len());
    let foot = rows_below(file, notice.unwrap_or(0) as u16, inner.height);
    let (text, below) = split_rows(inner, inner.height - foot);
    let drawn = lines(canvas, text, file);
    let below = columns(below, 1, below.width.saturating_sub(2));
    self::foot(canvas, below, file, (app.notifications.shown.as_ref(), app.lab.is_some()));
    drawn
}

/// The rows below the text: one for its status, as many as a notification of so many rows needs, or more where there are
/// errors; a third of few rows, or two where the text is wrong.
fn rows_below(file: &SourceBuffer, notice: u16, height: u16) -> u16 {
    let wrong = file.state == BufferState::Wrong;
    let wanted = if wrong || file.asking.is_some() || !file.diagnostics.is_empty() {
        let others = file.diagnostics.len().saturating_sub(1) as u16;
        FOOT.saturating_add(if file.asking.is_some() { 0 } else { others })
    } else {
        notice.clamp(1, FOOT)
    };
    wanted.min((height / 3).max(if wrong { 2.min(height / 2) } else { 1 }))
}

/// Draws the text with line numbers and diagnostic marks at its left.
fn lines(canvas: &mut Canvas<'_>, area: Rect, file: &SourceBuffer) -> Drawn {
    let all = file.editor.lines();
    let digits = all.len().to_string().len().max(2) as u16;
    let margin = digits + 3;
    let body = columns(area, margin, area.width.saturating_sub(margin));
    // The last column is for the mark of a line that continues.
    let wide = body.width.saturating_sub(1);
    let (first, from) = file.follow(area.height.into(), wide.into());
    let from = in_sight(canvas, file, from, wide);
    let glyphs = canvas.style.glyphs;
    let mut within = long_text_after(all[..first.min(all.len())].iter().map(String::as_str));
    for (index, line) in all.iter().enumerate().skip(first).take(area.height.into()) {
        let at = row(area, index - first);
        let diagnostics: Vec<&BufferDiagnostic> =
            file.diagnostics.iter().filter(|f| f.from.row == index).collect();
        let here = file.editor.cursor().row == index;
        if let Some(diagnostic) = diagnostics.first() {
            let role = if diagnostic.warning { Role::Warn } else { Role::Bad };
            canvas.left(columns(at, 0, 1), role, glyphs.pick("✗", "x"));
        }
        let role = if here { Role::Accent } else { Role::Dim };
        canvas.right(columns(at, 1, digits), role, &(index + 1).to_string());
        // Only the line of the cursor scrolls sideways.
        let from = if here { from } else { 0 };
        let (roles, after) = roles(line, within);
        within = after;
        write(canvas, row(body, index - first), (index, line, &roles), from, &diagnostics, file);
    }
    Drawn { rows: area.height, columns: wide, ..Drawn::default() }
}

fn write(
    canvas: &mut Canvas<'_>,
    at: Rect,
    (index, line, roles): (usize, &str, &[Role]),
    from: usize,
    diagnostics: &[&BufferDiagnostic],
    file: &SourceBuffer,
) {
    let selection = file.editor.selection();
    let cursor = file.editor.cursor();
    let mut used = 0;
    // There is one more position than there are characters, because the cursor may be after the last.
    for (column, c) in line.chars().chain([' ']).enumerate().skip(from) {
        let mut room = [0; 4];
        let shown = shown(canvas, c, &mut room);
        let width = shown.width() as u16;
        if used + width > at.width {
            // The line continues.
            let mark = Rect { x: at.right().saturating_sub(1), width: 1, ..at };
            canvas.left(mark, Role::Dim, canvas.style.glyphs.pick("…", ">"));
            break;
        }
        let caret = Caret { row: index, column };
        let mut style = canvas.style(roles.get(column).copied().unwrap_or(Role::Text));
        if let Some(diagnostic) = diagnostics.iter().find(|diagnostic| covers(diagnostic, caret)) {
            let role = if diagnostic.warning { Role::Warn } else { Role::Bad };
            style = canvas.style(role).add_modifier(Modifier::UNDERLINED);
        }
        if selection.is_some_and(|(from, to)| from <= caret && caret < to) {
            style = canvas.style(Role::Selected);
        }
        if caret == cursor && file.asking.is_none() {
            style = style.add_modifier(Modifier::REVERSED);
        }
        put(canvas, Position::new(at.x + used, at.y), &shown, style);
        used += width;
    }
    let covered = Caret { row: index, column: from };
    if from > 0 && !line.is_empty() && cursor != covered {
        canvas.left(columns(at, 0, 1), Role::Dim, canvas.style.glyphs.pick("…", "<"));
    }
}

fn put(canvas: &mut Canvas<'_>, at: Position, shown: &str, style: Style) {
    if canvas.buffer.area.contains(at) {
        canvas.buffer.set_string(at.x, at.y, shown, style);
    }
}

/// How a character is shown: as itself if it occupies cells, in ASCII by its spelling (`<theta>`), otherwise by its
/// number (`<U+6F22>`). Thus every character can be identified.
fn shown<'r>(canvas: &Canvas<'_>, c: char, room: &'r mut [u8; 4]) -> Cow<'r, str> {
    let itself = c.width().is_some_and(|width| width > 0);
    let text: &'r str = c.encode_utf8(room);
    if itself && (c.is_ascii() || !canvas.style.glyphs.is_ascii()) {
        return Cow::Borrowed(text);
    }
    let named = canvas.text(text);
    let known = itself && named.is_ascii() && !named.is_empty() && named != "?";
    let spelt = if known { format!("<{named}>") } else { format!("<U+{:04X}>", u32::from(c)) };
    Cow::Owned(spelt)
}

/// The first column shown, chosen so that the cursor is visible even if characters take several cells.
fn in_sight(canvas: &Canvas<'_>, file: &SourceBuffer, from: usize, wide: u16) -> usize {
    let cursor = file.editor.cursor();
    let line = file.editor.lines().get(cursor.row).map_or("", String::as_str);
    let cells = |c: char| shown(canvas, c, &mut [0; 4]).width();
    // This includes the character under the cursor, or the blank after the last.
    let seen = line.chars().chain([' ']).take(cursor.column + 1);
    let widths: Vec<usize> = seen.map(cells).collect();
    let mut from = from.min(cursor.column);
    let mut used: usize = widths.iter().skip(from).sum();
    while used > usize::from(wide) && from < cursor.column {
        used -= widths[from];
        from += 1;
    }
    from
}

/// Whether a diagnostic underlines this position; an empty one covers one character.
fn covers(diagnostic: &BufferDiagnostic, caret: Caret) -> bool {
    caret == diagnostic.from || diagnostic.from <= caret && caret < diagnostic.to
}

/// Draws the status of the text or the open prompt; a notification replaces the first line.
fn foot(
    canvas: &mut Canvas<'_>,
    area: Rect,
    file: &SourceBuffer,
    (notice, runs): (Option<&Notification>, bool),
) {
    if let Some(asking) = &file.asking {
        return self::asking(canvas, area, asking, notice);
    }
    let count = file.error_count();
    let (role, text) = match file.state {
        BufferState::Runs => (Role::Dim, "Running this version.".to_owned()),
        BufferState::Rebuilt(None) => {
            (Role::Good, "No errors: this version runs; the motion continues.".to_owned())
        }
        BufferState::Rebuilt(Some(took)) => {
            let time = took.as_secs_f64() * 1e3;
            let time = if time < 10.0 { format!("{time:.1}") } else { format!("{time:.0}") };
            (Role::Good, format!("No errors: rebuilt in {time} ms; the motion continues."))
        }
        BufferState::Changed if file.is_long_checked() => {
            (Role::Dim, "This check is slow; Esc stops it.".to_owned())
        }
        BufferState::Changed | BufferState::Left => (Role::Dim, "Checking…".to_owned()),
        BufferState::Wrong if !runs => {
            let errors = if count == 1 { "1 error".to_owned() } else { format!("{count} errors") };
            (
                Role::Bad,
                format!(
                    "{errors}: Ctrl-n goes to the next. The motion begins once there are none."
                ),
            )
        }
        BufferState::Wrong if count == 1 => {
            (Role::Bad, "1 error – still running the last valid version.".to_owned())
        }
        BufferState::Wrong => {
            (Role::Bad, format!("{count} errors – still running the last valid version."))
        }
    };
    // where there are few rows, the diagnostic is worth more than that there is one
    let few = area.height < FEW && file.diagnostic().is_some();
    let used = match notice {
        Some(notice) => draw_notification(canvas, area, notice),
        None if few => 0,
        None => usize::from(canvas.left(row(area, 0), role, &text) > 0),
    };
    let area = Rect { y: area.y + used as u16, height: area.height - used as u16, ..area };
    let Some(diagnostic) = file.diagnostic() else { return };
    let (row_of, column) = (diagnostic.from.row + 1, diagnostic.from.column + 1);
    let text = format!("{row_of}:{column} {}", diagnostic.message);
    let help = diagnostic.help.as_ref().map(|help| format!("help: {help}"));
    let width = usize::from(area.width);
    let message = words(&canvas.text(&text), width);
    let help = help.map_or_else(Vec::new, |help| words(&canvas.text(&help), width));
    let role = if diagnostic.warning { Role::Warn } else { Role::Text };
    // If both are long, one row is reserved for the help.
    let room = usize::from(area.height).saturating_sub(usize::from(!help.is_empty()));
    let shown = message.iter().take(room).map(|line| (role, line.clone()));
    let helped = help.iter().map(|line| (Role::Accent, line.clone()));
    let others = others(file, diagnostic).map(|text| (Role::Dim, text));
    for (index, (role, line)) in shown.chain(helped).chain(others).enumerate() {
        if index < area.height.into() {
            canvas.left(row(area, index), role, &line);
        }
    }
}

/// The places and messages of the other diagnostics, from the one after this on.
fn others<'s>(
    file: &'s SourceBuffer,
    shown: &'s BufferDiagnostic,
) -> impl Iterator<Item = String> + 's {
    let all = &file.diagnostics;
    let at = all.iter().position(|other| std::ptr::eq(other, shown)).unwrap_or(0);
    let others = all.iter().cycle().skip(at + 1).take(all.len().saturating_sub(1));
    others
        .map(|other| format!("{}:{} {}", other.from.row + 1, other.from.column + 1, other.message))
}

/// Draws a notification and returns the number of rows it takes.
fn draw_notification(canvas: &mut Canvas<'_>, area: Rect, notice: &Notification) -> usize {
    let role = notice_role(notice);
    let lines = words(&canvas.text(&notice.text), area.width.into());
    let used = lines.len().min(area.height.into());
    for (index, line) in lines.iter().take(used).enumerate() {
        canvas.left(row(area, index), role, line);
    }
    used
}

fn asking(canvas: &mut Canvas<'_>, area: Rect, asking: &Asking, notice: Option<&Notification>) {
    let (label, input, whole, help) = match asking {
        Asking::Words(input) => {
            ("find: ", input, false, "Enter goes to the next match, Ctrl-g to the one after it.")
        }
        Asking::Name { input, whole } => (
            "save a copy as: ",
            input,
            *whole,
            "A bare name is saved among your presets; a name with / or .toml as that file.",
        ),
    };
    let field = row(area, 0);
    let used = canvas.left(field, Role::Accent, label);
    let place = columns(field, used, field.width);
    let room = usize::from(place.width.saturating_sub(1));
    let skipped = input.visual_scroll(room);
    let text: String = input.value().chars().skip(skipped).take(room).collect();
    let shown = canvas.left(place, Role::Text, &text);
    if whole {
        canvas.tint(columns(place, 0, shown), Role::Selected);
    }
    let cursor = input.visual_cursor().saturating_sub(skipped).min(room) as u16;
    canvas.tint(columns(place, cursor, 1), Role::Selected);
    let below = Rect { y: area.y + 1, height: area.height.saturating_sub(1), ..area };
    if let Some(notice) = notice {
        draw_notification(canvas, below, notice);
        return;
    }
    for (index, line) in words(help, area.width.into()).iter().enumerate() {
        if index < below.height.into() {
            canvas.left(row(below, index), Role::Dim, line);
        }
    }
}
