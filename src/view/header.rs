//! The lines above every page, and the one of its status: tabs, the clock, the method.
//!
//! In: the application. Out: two rows of cells. Never here: the body below them, the last line (`footer`).

use ratatui::layout::Rect;

use super::canvas::{Canvas, StyledText, columns};
use super::gauges::departed;
use super::glyphs::{Glyphs, TextWidth};
use super::number::{brief, fitted};
use super::quantity::Quantities;
use super::theme::Role;
use super::timeline;
use crate::app::{App, HitTarget, Lab, Page};
use crate::experiment::{Snapshot, Status};
use crate::num::rounded;

/// The key of a page and its name.
type Tab = (&'static str, &'static str, Page);

/// The pages of a loaded system and their keys.
const PAGES: [Tab; 5] = [
    ("1", "Lab", Page::Lab),
    ("2", "Equations", Page::Equations),
    ("3", "Notes", Page::Notes),
    ("4", "Numbers", Page::Numbers),
    ("9", "Plain", Page::Plain),
];

const NAME: &str = "phaselab";

/// Draws the program's name, the system's name, and the pages.
pub(super) fn header(canvas: &mut Canvas<'_>, area: Rect, app: &App) {
    let area = columns(area, 1, area.width.saturating_sub(2));
    let title = match (&app.lab, app.page) {
        (_, Page::Picker) | (None, _) => "a laboratory for analytical mechanics",
        (Some(lab), _) => &lab.loaded.model.info.title,
    };
    let tabs = |gap: &str, pages: &[Tab]| {
        let none = app.page == Page::Picker || app.lab.is_none();
        if none { Vec::new() } else { tabs(canvas, app, gap, pages) }
    };
    let width = |tabs: &[StyledText]| tabs.iter().map(|(text, _)| text.width()).sum::<usize>();
    let fits =
        |tabs: &[StyledText], others: usize| others + 2 + width(tabs) <= usize::from(area.width);
    // The title has priority over the gaps between the pages, over the program's name and over the last page, which the help
    // names too.
    let both = NAME.len() + 2 + title.width();
    let (all, last) = (PAGES.len(), PAGES.len() - usize::from(app.page != Page::Plain));
    let own = title.width();
    let layouts = [("   ", all, both), ("  ", all, own), ("  ", last, own), (" ", last, own)];
    let layouts = layouts.map(|(gap, count, others)| (tabs(gap, &PAGES[..count]), others));
    let fitting = layouts.into_iter().find(|(tabs, others)| fits(tabs, *others));
    let tabs = fitting.map_or_else(|| tabs("  ", &PAGES), |(tabs, _)| tabs);
    let wide = width(&tabs);
    let paged = usize::from(area.width) > wide;
    let room = if paged { area.width.saturating_sub(wide as u16 + 2) } else { area.width };
    let alone = !tabs.is_empty() && both > usize::from(room) && room > 12;
    let mut used = 0;
    if !alone && room >= NAME.len() as u16 {
        used = canvas.left(area, Role::Accent, NAME);
        used += canvas.left(columns(area, used, 2), Role::Dim, "  ");
    }
    if room > used + 8 {
        canvas.left(columns(area, used, room - used), Role::Title, title);
    }
    if paged {
        let mut from = area.width - wide as u16;
        canvas.spans(columns(area, from, area.width), &tabs);
        // Each tab is a key and a name.
        for (pair, (_, _, page)) in tabs.chunks(2).zip(PAGES) {
            let long = pair.iter().map(|(text, _)| text.width()).sum::<usize>() as u16;
            canvas.target(columns(area, from, long), HitTarget::Page(page));
            from += long;
        }
    }
}

fn tabs(canvas: &Canvas<'_>, app: &App, gap: &str, pages: &[Tab]) -> Vec<StyledText> {
    let mut spans = Vec::new();
    for (index, (key, name, page)) in pages.iter().enumerate() {
        let here = *page == app.page;
        let gap = if index == 0 { "" } else { gap };
        spans.push(canvas.span(Role::Accent, format!("{gap}{key} ")));
        spans.push(canvas.span(if here { Role::Title } else { Role::Dim }, *name));
    }
    spans
}

/// Draws the time, the speed, the method and the rate of computation.
pub(super) fn status(canvas: &mut Canvas<'_>, area: Rect, app: &App) {
    let area = columns(area, 1, area.width.saturating_sub(2));
    let Some(snapshot) = app.snapshot().filter(|_| app.page != Page::Picker) else { return };
    let glyphs = canvas.style.glyphs;
    let waits = app.lab.as_ref().is_some_and(Lab::waits_for_law);
    let (sign, word, role) = match &snapshot.status {
        Status::Running if waits => (glyphs.pick("‖", "="), "waiting", Role::Warn),
        Status::Running if !app.suspended && snapshot.backwards => {
            (glyphs.pick("◀", "<"), "back   ", Role::Warn)
        }
        Status::Running if !app.suspended => (glyphs.pick("▶", ">"), "running", Role::Good),
        Status::Running | Status::Paused => (glyphs.pick("‖", "="), "paused ", Role::Warn),
        Status::Ended(_) => (glyphs.pick("■", "#"), "ended  ", Role::Warn),
        Status::Failed(_) => (glyphs.pick("■", "#"), "stopped", Role::Bad),
    };
    let rate = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), short);
    let (method, step) = method(snapshot, canvas);
    // The pieces are in order of importance; those that do not fit are dropped from the end.
    let mut pieces: Vec<Vec<StyledText>> =
        vec![
            vec![canvas.span(
                role,
                if area.width < 100 { sign.to_owned() } else { format!("{sign} {word}") },
            )],
            vec![
                canvas.span(Role::Dim, "t "),
                canvas.span(Role::Accent, format!("{:<8}", fitted(snapshot.time, 6, 8, glyphs))),
            ],
            vec![
                canvas.span(Role::Dim, "speed "),
                canvas.span(Role::Text, format!("{:<5}", speed(snapshot, glyphs))),
            ],
            vec![canvas.span(Role::Text, &method)],
        ];
    if let Some((role, text)) = departed(snapshot, glyphs) {
        pieces.insert(1, vec![canvas.span(role, text)]);
    }
    if app.recording {
        let mark = canvas.span(Role::Bad, format!("{} rec", glyphs.pick("●", "o")));
        pieces.insert(1, vec![mark]);
    }
    pieces.push(if outlasts(snapshot) {
        vec![canvas.span(Role::Dim, "longer than the motion so far")]
    } else {
        vec![
            // A shorter step leaves its room to the rate, so that nothing jumps.
            canvas.span(Role::Text, format!("{:>1$}", rate(app.meter.steps), STEP + 3 - step)),
            canvas.span(Role::Dim, " steps/s"),
        ]
    });
    pieces.push(vec![
        canvas.span(Role::Text, format!("{:>2}", rate(app.meter.frames))),
        canvas.span(
            Role::Dim,
            if area.width < 100 { " fps".to_owned() } else { format!("/{} fps", app.meter.asked) },
        ),
    ]);
    let timed = app.lab.as_ref().filter(|lab| timeline::is_shown(lab, snapshot));
    // the rates are of no use while nothing runs
    let room =
        if timed.is_some() { area.width.saturating_sub(timeline::LEAST) } else { area.width };
    let mut used = 0;
    for piece in pieces {
        let wide: usize = piece.iter().map(|(text, _)| text.width()).sum();
        if used + wide as u16 > room {
            break;
        }
        used += canvas.spans(columns(area, used, area.width), &piece) + 2;
    }
    if let Some(lab) = timed {
        timeline::draw(canvas, columns(area, used, area.width.saturating_sub(used)), lab, snapshot);
    }
}

/// Whether a step is longer than the motion so far and than what is shown of it in a second: a rate of steps would be close to
/// zero, though the motion is under way.
fn outlasts(snapshot: &Snapshot) -> bool {
    let shown = (snapshot.recorded.to - snapshot.recorded.from).abs();
    let step = snapshot.method.step.abs();
    snapshot.status == Status::Running && step > shown && step > snapshot.speed
}

fn speed(snapshot: &Snapshot, glyphs: Glyphs) -> String {
    if snapshot.speed.is_infinite() {
        "flat out".to_owned()
    } else {
        // below ten two digits say how fast it is
        format!("×{}", brief(snapshot.speed, if snapshot.speed < 10.0 { 2 } else { 3 }, glyphs))
    }
}

pub(super) fn status_words(q: &Quantities<'_>) -> String {
    let (snapshot, glyphs) = (q.snapshot, q.style.glyphs);
    let status = match &snapshot.status {
        Status::Running if q.lab.waits_for_law() => "waiting until the law is rebuilt".to_owned(),
        Status::Running => "running".to_owned(),
        Status::Paused => "paused".to_owned(),
        Status::Ended(event) => format!("ended by {event}"),
        Status::Failed(error) => format!("stopped: {}", error.message),
    };
    let unit = q.lab.loaded.model.time_unit();
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    let tolerance = snapshot.method.tolerance;
    let tolerance =
        tolerance.map_or_else(String::new, |t| format!(", tolerance {}", brief(t, 2, glyphs)));
    format!(
        "Time {}{unit}, {status}, speed {}, method {}{tolerance}, step {}.",
        brief(snapshot.time, 6, glyphs),
        speed(snapshot, glyphs),
        snapshot.method.name,
        brief(rounded(snapshot.method.step, 3), 3, glyphs),
    )
}

/// Formats a count in five columns: `940`, `12k`, `3.4M`.
fn short(value: f64) -> String {
    match value {
        v if v < 9_950.0 => format!("{v:.0}"),
        v if v < 999_500.0 => format!("{:.0}k", v / 1e3),
        v => format!("{:.1}M", v / 1e6),
    }
}

/// The greatest width of a step.
const STEP: usize = 7;

/// The method with its step and tolerance, and the width of the step.
fn method(snapshot: &Snapshot, canvas: &Canvas<'_>) -> (String, usize) {
    let glyphs = canvas.style.glyphs;
    // Before the first step there is no length of one.
    let step = match snapshot.method.step {
        0.0 => glyphs.pick("–", "-").to_owned(),
        step => fitted(rounded(step, 2), 2, STEP, glyphs),
    };
    let tolerance = snapshot.method.tolerance.map_or_else(String::new, |tolerance| {
        format!(" {} {}", glyphs.pick("ε", "tol"), brief(tolerance, 2, glyphs))
    });
    let width = step.width().min(STEP);
    (format!("{}{tolerance} step {step}", snapshot.method.name), width)
}
