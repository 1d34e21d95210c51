//! The last line of every page: input, a notification, the meaning of the focused item, and the key hints.
//!
//! In: the application. Out: a row of cells, and the box of a notification that is longer. Never here: the lines above (`header`).

use ratatui::layout::Rect;
use ratatui::symbols::border;

use super::canvas::{Canvas, StyledText, columns, row};
use super::gauges::finding;
use super::glyphs::TextWidth;
use super::help::keys;
use super::layout;
use super::number::{brief, with_minus_signs};
use super::theme::Role;
use super::values::{meaning as value_meaning, typing};
use super::wrap::words_in;
use crate::app::keymap::{Binding, KEYS, KeyContext};
use crate::app::{
    Action, App, HitTarget, InputField, KeyHints, Lab, Notification, NotificationKind, Overlay,
    Page, Pane, Purpose, ValueId,
};
use crate::experiment::{Snapshot, Status};

/// Draws the input, the notification or the meaning of the focused item, and at the right the most useful keys for what the body
/// of the page shows.
pub(super) fn footer(canvas: &mut Canvas<'_>, area: Rect, (app, body): (&App, Rect)) {
    let area = columns(area, 1, area.width.saturating_sub(2));
    if let Some(Overlay::Field(field)) = &app.overlay {
        return open_field(canvas, (area, body), app, field);
    }
    let ended = app.snapshot().filter(|_| app.page == Page::Lab).and_then(ended);
    let meaning = match (&app.overlay, &app.lab, app.page) {
        (None, _, Page::Lab) if ended.is_some() => [ended.clone().unwrap_or_default()].into(),
        (None, Some(lab), Page::Lab) => meaning(canvas, lab),
        _ => Vec::new(),
    };
    let role = if ended.is_some() { Role::Warn } else { Role::Text };
    // The plain page has no room for a notification above the footer.
    let (meaning, role) = match current_notification(app).filter(|_| reads(app)) {
        Some((text, role)) => (vec![canvas.text(&text)], role),
        None => (meaning, role),
    };
    let mut hints = hints(canvas, (app, body));
    let long = Hint::width;
    let mut wide = hints.iter().map(long).sum::<usize>() + 3 * hints.len();
    // The last hints, help and quit, and pause where there is room, are always shown; the others are dropped to make room for
    // the meaning.
    let room = usize::from(area.width);
    let pauses = |hint: &Hint| hint.action == Action::PlayPause && room >= ROOM_FOR_PAUSE;
    let mut shown = if let Some(place) = hints.iter().position(pauses) {
        let pause = hints.remove(place);
        hints.insert(hints.len().saturating_sub(2), pause);
        3
    } else {
        2
    };
    // If its pane is small, a gauge's reason appears in full nowhere else.
    let gauge = app.lab.as_ref().is_some_and(|lab| lab.focus.pane == Pane::Gauges);
    let beside = |shown: usize| {
        let last: usize = hints.iter().rev().take(shown).map(|hint| long(hint) + 3).sum();
        room.saturating_sub(last.saturating_sub(3) + 2)
    };
    let [narrow, whole] = [shown, 2].map(beside);
    let first = if gauge { whole } else { narrow.min(room * 2 / 3) };
    let meaning = fitting(&meaning, [first, narrow, whole]);
    if meaning.width() > narrow {
        shown = 2;
    }
    let meant = if meaning.is_empty() { 0 } else { meaning.width().min(whole) + 2 };
    while hints.len() > shown && meant + wide > room + 3 {
        // the way to panes out of sight comes before the pause
        let leads_on = hints.first().is_some_and(|hint| hint.action == Action::NextPane);
        let dropped = if shown == 3 && hints.len() == 4 && leads_on {
            shown = 2;
            hints.len() - 3
        } else {
            hints.len() - shown - 1
        };
        wide -= long(&hints.remove(dropped)) + 3;
    }
    let all = (wide as u16).saturating_sub(3).min(area.width);
    canvas.left(columns(area, 0, area.width.saturating_sub(all + 2)), role, &meaning);
    let start = if meaning.is_empty() { 0 } else { area.width - all };
    draw_hints(canvas, columns(area, start, area.width), &hints);
}

fn draw_hints(canvas: &mut Canvas<'_>, area: Rect, hints: &[Hint]) {
    let mut start = 0;
    for hint in hints {
        let place = columns(area, start, area.width);
        let used = canvas.spans(place, &hint.spans);
        canvas.target(columns(place, 0, used), HitTarget::Hint(hint.action));
        start += used + 3;
    }
}

/// The first of some texts, from the longest, that fits into a width, or else into one with fewer keys beside it. What the
/// shorter ones leave out stands in the list, too.
fn fitting(texts: &[String], widths: [usize; 3]) -> String {
    let fits = |width| texts.iter().find(move |text| text.width() <= width);
    widths.into_iter().find_map(fits).or(texts.last()).cloned().unwrap_or_default()
}

/// Whether the plain-text page is open, on which nothing may cover the text.
fn reads(app: &App) -> bool {
    app.page == Page::Plain
        && !matches!(app.overlay, Some(Overlay::Help { .. } | Overlay::Message(_)))
}

/// The current notification, or the error that lasts until the file is correct.
fn current_notification(app: &App) -> Option<(String, Role)> {
    // The editor has its own place for notifications.
    if app.open_buffer().is_some() {
        return None;
    }
    let notice =
        app.notifications.shown.as_ref().map(|notice| (notice.text.clone(), notice_role(notice)));
    notice.or_else(|| app.banner().map(|banner| (banner, Role::Bad)))
}

pub(super) fn notice_role(notice: &Notification) -> Role {
    match notice.kind {
        NotificationKind::Info => Role::Good,
        NotificationKind::Hint => Role::Text,
        NotificationKind::Warning => Role::Warn,
        NotificationKind::Error => Role::Bad,
    }
}

/// The width from which how to pause is always said.
const ROOM_FOR_PAUSE: usize = 70;

/// The most rows that a notification takes.
const NOTICE: usize = 3;

/// Draws the notification over the lower frame of the page, so that the key hints below stay visible.
pub(super) fn notice(canvas: &mut Canvas<'_>, body: Rect, app: &App) {
    let Some((text, role)) = current_notification(app).filter(|_| !reads(app)) else { return };
    let room = usize::from(body.width.saturating_sub(6));
    let text = with_minus_signs(&text, canvas.style.glyphs);
    let lines = words_in(&canvas.text(&text), room, NOTICE);
    let wide = lines.iter().map(|line| line.width()).max().unwrap_or(0).min(room);
    let framed = is_frame(canvas, row(body, usize::from(body.height).saturating_sub(1)));
    for (index, line) in lines.iter().enumerate() {
        let at = usize::from(body.height).saturating_sub(lines.len()) + index;
        let at = columns(row(body, at), 2, body.width.saturating_sub(4));
        let on_frame = framed && index + 1 == lines.len();
        // A short last line takes no more of the frame than it needs.
        let wide = if on_frame { line.width().min(room) } else { wide };
        let torn = framed && tears_a_word(canvas, columns(at, wide as u16 + 1, 2));
        // Nothing of the frame below is left, its weight included.
        canvas.blank(columns(at, 0, wide as u16 + 2));
        if torn {
            erase_while(canvas, columns(at, wide as u16 + 2, at.width), is_of_word);
        }
        canvas.left(columns(at, 1, wide as u16), role, line);
        if on_frame {
            // such as `wn` of `+1 down`
            let rest = |c: char| c.is_alphanumeric() || c == ' ' || c == '↓';
            erase_while(canvas, columns(at, wide as u16 + 2, at.width), rest);
        }
    }
}

/// Whether a row is the lower border of a frame, and not text.
fn is_frame(canvas: &Canvas<'_>, row: Rect) -> bool {
    let corner = canvas.buffer.cell((row.x, row.y)).map_or("", |cell| cell.symbol());
    let own = canvas.style.glyphs.border().bottom_left;
    row.width > 0 && [own, border::THICK.bottom_left].contains(&corner)
}

/// Whether a word or a row of bars stands in both of two cells, so that blanking the first leaves a rest of it.
fn tears_a_word(canvas: &Canvas<'_>, cells: Rect) -> bool {
    let part = |x: u16| {
        let symbol = canvas.buffer.cell((x, cells.y)).map_or("", |cell| cell.symbol());
        symbol.chars().any(is_of_word)
    };
    cells.width == 2 && part(cells.x) && part(cells.x + 1)
}

/// Whether a character stands in words, numbers, formulas and bars: not a blank, a frame or a dot of a picture.
fn is_of_word(c: char) -> bool {
    !(c.is_whitespace() || matches!(c, '\u{2500}'..='\u{257f}' | '\u{2800}'..='\u{28ff}' | '|'))
}

/// Makes blank what a notification has left of the words in a row: the cells up to the first that holds anything else.
fn erase_while(canvas: &mut Canvas<'_>, row: Rect, is_rest: impl Fn(char) -> bool) {
    let rest = (0..row.width).take_while(|x| {
        let symbol = canvas.buffer.cell((row.x + x, row.y)).map_or("", |cell| cell.symbol());
        symbol.chars().all(&is_rest)
    });
    let rest = rest.count() as u16;
    canvas.blank(columns(row, 0, rest));
}

/// What ended the motion, and how to continue.
fn ended(snapshot: &Snapshot) -> Option<String> {
    let Status::Ended(event) = &snapshot.status else { return None };
    Some(format!("ended at: {event}; r restarts"))
}

/// The meaning, unit and range of the selected item, and the same with less of what its list says already.
fn meaning(canvas: &Canvas<'_>, lab: &Lab) -> Vec<String> {
    let glyphs = canvas.style.glyphs;
    if lab.focus.pane == Pane::Gauges {
        let gauge = lab.snapshot.as_ref().and_then(|s| s.gauges.get(lab.selection.gauge));
        return gauge.map_or_else(Vec::new, |gauge| {
            let name = glyphs.pick(&gauge.shown, &gauge.name);
            let reason = with_minus_signs(&gauge.reason, glyphs);
            let named = format!("{name} ({reason})");
            let found = format!("{named}: {}", finding(gauge, canvas.style.glyphs));
            [found, named, reason].map(|text| canvas.text(&text)).into()
        });
    }
    let selected = lab.selected().and_then(|target| Some((target, lab.value_info(target)?)));
    let Some((target, info)) = selected else { return Vec::new() };
    let text = value_meaning(lab, target, &info, canvas.style.glyphs);
    let name = glyphs.pick(&info.shown, &info.name);
    // the keys have precedence over what the list itself says
    let explained = text.is_empty() || canvas.explained;
    let about = if explained { String::new() } else { format!(": {text}") };
    let unit = if info.unit.is_empty() { String::new() } else { format!(" [{}]", info.unit) };
    let range = info.range.map_or_else(String::new, |(min, max, _)| {
        format!(", {} to {}", brief(min, 4, glyphs), brief(max, 4, glyphs))
    });
    let named = format!("{name}{unit}{about}");
    let alone = if explained { named.clone() } else { text };
    [format!("{named}{range}"), named, alone].map(|text| canvas.text(&text)).into()
}

/// A key and a word for its action.
struct Hint {
    spans: Vec<StyledText>,
    action: Action,
}

impl Hint {
    fn width(&self) -> usize {
        self.spans.iter().map(|(text, _)| text.width()).sum()
    }
}

/// The most useful keys in the current context, innermost first; help and quit come last. None where a script hides them. The key to
/// the next pane comes before all others where there are panes that the body of the page does not show.
fn hints(canvas: &Canvas<'_>, (app, body): (&App, Rect)) -> Vec<Hint> {
    if matches!(app.footer.hints, KeyHints::Hidden | KeyHints::Cursor) {
        return Vec::new();
    }
    // A text that is edited is kept, and a list is closed, when it is left.
    let closes_with_esc = app
        .key_contexts()
        .iter()
        .any(|context| matches!(context, KeyContext::Workbench | KeyContext::Menu));
    let rows = app.key_contexts().iter().flat_map(|context| {
        KEYS.iter().filter(move |row| {
            let back = (row.context, row.action) == (KeyContext::Space, Action::Home)
                && app.lab.as_ref().is_some_and(Lab::is_seen_otherwise);
            let named = !row.hint.is_empty() || back;
            row.context == *context && named && app.offers(row.action)
        })
    });
    let hint = |row: &Binding| {
        let keys = keys(row, canvas.style);
        let first = keys.split(' ').next().unwrap_or_default().to_owned();
        // What lies on top is closed before the program is left.
        let closes = match row.action {
            Action::Back => closes_with_esc,
            Action::Quit => app.closes_with_quit(),
            _ => false,
        };
        let leaves = row.action == Action::Quit && app.footer.hints == KeyHints::LabInLesson;
        let pointed = row.action == Action::Cursor && app.lab.as_ref().is_some_and(Lab::has_cursor);
        let is_paused = app.snapshot().is_some_and(|snapshot| snapshot.status == Status::Paused);
        let word = match row.hint {
            _ if row.action == Action::PlayPause && is_paused => "resume",
            _ if pointed => "no cursor",
            _ if closes => "close",
            _ if leaves => "leave",
            "" => "initial view",
            hint => hint,
        };
        let word = canvas.span(Role::Dim, format!(" {word}"));
        Hint { spans: vec![canvas.span(Role::Accent, first), word], action: row.action }
    };
    let mut hints: Vec<Hint> = rows.map(hint).collect();
    let hides =
        |lab: &Lab| layout::panes(body, lab, canvas.style.glyphs).len() < lab.panes().count();
    if app.page == Page::Lab && app.lab.as_ref().is_some_and(hides) {
        hints.sort_by_key(|hint| match hint.action {
            Action::NextPane => 0,
            Action::NextTab => 1,
            _ => 2,
        });
    } else {
        hints.retain(|hint| hint.action != Action::NextTab);
    }
    hints
}

/// Draws the text being typed, what is wrong with it, and at the right the keys that end it: at least how to leave.
fn open_field(canvas: &mut Canvas<'_>, (area, body): (Rect, Rect), app: &App, field: &InputField) {
    let info = match (&app.lab, field.purpose) {
        (Some(lab), Purpose::Value(target)) => lab.value_info(target),
        (Some(lab), Purpose::Ramp(index)) => lab.value_info(ValueId::Parameter(index)),
        _ => None,
    };
    let glyphs = canvas.style.glyphs;
    let name = match (field.purpose, &info) {
        (Purpose::Flow(_) | Purpose::SymmetryFlow(_) | Purpose::GeneratorFlow(_), _) => {
            "how far, ε; a negative value goes back".to_owned()
        }
        (Purpose::TypedFlow, _) => "G; ε".to_owned(),
        (Purpose::Ramp(_), Some(info)) => {
            format!("ramp {}: value in time", glyphs.pick(&info.shown, &info.name))
        }
        (Purpose::Surface(_), _) => "section at".to_owned(),
        (Purpose::Step, _) => "step".to_owned(),
        (Purpose::Tolerance, _) => "tolerance".to_owned(),
        (_, Some(info)) => glyphs.pick(&info.shown, &info.name).clone(),
        _ => "value".to_owned(),
    };
    let is_surface = matches!(field.purpose, Purpose::Surface(_));
    let sign = if is_surface { " " } else { " = " };
    let used = canvas.left(area, Role::Title, &format!("{name}{sign}"));
    let room = (if is_surface { 30 } else { 20 }).min(area.width / 3);
    typing(canvas, columns(area, used, room), field);
    // What is wrong is shown right after what was typed, where there is more room for it.
    let typed = (canvas.text(field.input.value()).width() as u16).saturating_add(2).min(room);
    let taken = if field.diagnostic.is_some() { typed } else { room };
    let rest = columns(area, used + taken + 2, area.width);
    let mut shorter = None;
    let (role, text) = match (&field.diagnostic, info) {
        (Some(diagnostic), _) => (Role::Bad, diagnostic.clone()),
        (None, _) if field.purpose == Purpose::TypedFlow => {
            (Role::Dim, "a function of q, p and t; p_x*y - p_y*x; 0.1".to_owned())
        }
        (None, _) if matches!(field.purpose, Purpose::Ramp(_)) => {
            (Role::Dim, "2 in 60; smooth, cubic, linear".to_owned())
        }
        (None, _) if is_surface => {
            (Role::Dim, "x = 0, rising (falling, either); every 2*pi/w; event NAME".to_owned())
        }
        (None, Some(info)) => {
            let range = info.range.map_or_else(String::new, |(min, max, _)| {
                let [min, max] = [min, max].map(|x| brief(x, 6, glyphs));
                format!("{min} to {max} ")
            });
            let unit = if info.unit.is_empty() { "" } else { "   " };
            let range = format!("{range}{}", info.unit);
            let whole = format!("{range}{unit}{}", info.about);
            shorter = Some(range);
            (Role::Dim, whole)
        }
        (None, None) => (Role::Dim, String::new()),
    };
    let mut hints = hints(canvas, (app, body));
    let wide = |hints: &[Hint]| hints.iter().map(|hint| hint.width() + 3).sum::<usize>();
    let room = usize::from(rest.width);
    while hints.len() > 1 && canvas.text(&text).width() + wide(&hints) > room {
        hints.remove(0);
    }
    let wide = wide(&hints).min(room) as u16;
    let left = rest.width - wide;
    // what it means is left out whole, not cut
    let text = match shorter {
        Some(range) if canvas.text(&text).width() > left.into() => range,
        _ => text,
    };
    canvas.left(columns(rest, 0, left), role, &text);
    draw_hints(canvas, columns(rest, (rest.width + 3).saturating_sub(wide), rest.width), &hints);
}
