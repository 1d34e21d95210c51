//! The gauges: conserved quantities, their drifts, and a verdict on each.
//!
//! In: the snapshot's gauges. Out: cells. Never here: how a verdict is reached.

mod single_row;

use ratatui::layout::Rect;
use ratatui::widgets::Widget;

use super::canvas::{Canvas, columns, row};
use super::glyphs::{Glyphs, TextWidth};
use super::layout::split_rows;
use super::number::{self, fitted, readable};
use super::plot::{Marker, Scale};
use super::sparkline::{ColumnValue, Sparkline};
use super::theme::Role;
use super::values::window;
use super::verdict::{
    BETWEEN, HEADED, IN_FULL, ROUNDING, all_in_full, beside_name, given_by_impulses, is_residual,
    reason, reason_in_a_word, reasons_below, word,
};
use super::wrap::{shortened, shortened_within, words};
use crate::analysis::{Growth, Unseen, Verdict};
use crate::app::{HitTarget, Lab};
use crate::experiment::{Gauge, Snapshot};
use single_row::SingleRow;

/// The widths, in columns, of a verdict in a word and in full, of a drift and of a value.
const VERDICT: u16 = single_row::VERDICT;
const DRIFT: u16 = 9;
const VALUE: u16 = 9;

const VERDICT_HEAD: u16 = 7;

/// The greatest width of a history.
const HISTORY: u16 = 24;

/// The least drift that the sparkline shows, and the least ratio between the ends of its scale.
const FLOOR: f64 = 1e-17;
const LEAST_RATIO: f64 = 100.0;

fn single_row(canvas: &Canvas<'_>, width: u16, gauges: &[Gauge]) -> SingleRow {
    let glyphs = canvas.style.glyphs;
    let name = |gauge: &Gauge| glyphs.pick(&*gauge.shown, &*gauge.name).width();
    let verdict = |gauge: &Gauge| {
        let sign = if given_by_impulses(gauge).is_some() { 2 } else { 0 };
        word(&gauge.verdict).0.width() as u16 + sign
    };
    let longest = gauges.iter().map(name).max().unwrap_or(0);
    SingleRow::of(width, longest, gauges.iter().map(verdict).max().unwrap_or(0))
}

/// Draws the gauges of a lab around the selected one: two rows for each if there is room, else one.
pub(super) fn draw(canvas: &mut Canvas<'_>, area: Rect, lab: &Lab, selected: Option<usize>) {
    let gauges = lab.snapshot.as_ref().map_or(&[][..], |snapshot| &snapshot.gauges);
    if gauges.is_empty() {
        canvas.left(row(area, 0), Role::Dim, "  nothing is conserved here");
        return;
    }
    let (area, below) = match selected.and_then(|index| gauges.get(index)) {
        Some(gauge) => reason_below(canvas, area, gauges.len(), gauge),
        None => (area, Vec::new()),
    };
    for (index, line) in below.iter().enumerate() {
        let at = Rect { y: area.bottom() + index as u16, height: 1, ..area };
        canvas.left(columns(at, 2, at.width), Role::Dim, line);
    }
    let rows = usize::from(area.height);
    let height = if rows >= 2 * gauges.len() { 2 } else { 1 };
    // the columns of a mark and at the edge are no gauge's
    let width = area.width.saturating_sub(3);
    let reasons = reasons_below(lab, gauges, width, canvas.style.glyphs);
    let more: usize = reasons.iter().map(Vec::len).sum();
    // reasons give way to the headings
    let least = 2 * gauges.len() + more + usize::from(area.width >= HEADED);
    let reasons = Some(reasons).filter(|_| rows >= least);
    let taken = height * gauges.len() + if reasons.is_some() { more } else { 0 };
    let headed = rows > taken && area.width >= HEADED;
    let single = (height == 1).then(|| single_row(canvas, area.width.saturating_sub(3), gauges));
    if headed {
        heads(canvas, columns(area, 2, area.width.saturating_sub(3)), single);
    }
    let (_, area) = split_rows(area, u16::from(headed));
    let shown = usize::from(area.height) / height;
    let in_full = all_in_full(lab, gauges, width, canvas.style.glyphs);
    let first = window(selected.unwrap_or(0), gauges.len(), shown);
    let mut top = 0;
    for (place, gauge) in gauges.iter().skip(first).take(shown).enumerate() {
        let here = selected == Some(first + place);
        let mark = if here { canvas.style.glyphs.pick("›", ">") } else { " " };
        let below = reasons.as_ref().map_or(&[][..], |all| &all[first + place]);
        for line in 0..height + below.len() {
            canvas.target(row(area, top + line), HitTarget::Gauge(first + place));
        }
        let at = row(area, top);
        canvas.left(columns(at, 0, 1), Role::Focus, mark);
        let at = columns(at, 2, area.width.saturating_sub(3));
        let residual = is_residual(lab, gauge);
        if let Some(mut single) = single {
            (single.drift, single.residual) = (single.drift.filter(|_| !residual), residual);
            in_one_row(canvas, at, single, (gauge, gauges), here);
        } else {
            let alone = !below.is_empty();
            name_and_reason(canvas, at, (gauge, gauges, residual), (here, in_full, alone));
            let numbers = row(columns(area, 2, at.width), top + 1);
            numbers_and_history(canvas, numbers, (gauge, residual));
            for (index, line) in below.iter().enumerate() {
                canvas.left(columns(row(area, top + 2 + index), 4, area.width), Role::Dim, line);
            }
        }
        top += height + below.len();
    }
}

/// Returns the area left for the list, and the lines of the selected gauge's reason below it; no lines if the gauges
/// leave too few rows.
fn reason_below(
    canvas: &Canvas<'_>,
    area: Rect,
    count: usize,
    gauge: &Gauge,
) -> (Rect, Vec<String>) {
    let glyphs = canvas.style.glyphs;
    let reason = number::with_minus_signs(&gauge.reason, glyphs);
    let text = format!("{reason}; {}", finding(gauge, glyphs));
    let lines = words(&canvas.text(&text), usize::from(area.width.saturating_sub(3)));
    let spare = usize::from(area.height).saturating_sub(count.min(MOST_ABOVE));
    if lines.len() > spare {
        return (area, Vec::new());
    }
    (split_rows(area, area.height - lines.len() as u16).0, lines)
}

/// The most gauges that must stay visible above the reason.
const MOST_ABOVE: usize = 3;

/// Writes the headings of the columns, those of a single row for each gauge or of two rows.
fn heads(canvas: &mut Canvas<'_>, area: Rect, single: Option<SingleRow>) {
    let verdict = area.width.saturating_sub(VERDICT);
    let has_room = single.is_none_or(|row| row.verdicts(area.width) >= VERDICT_HEAD);
    if has_room {
        canvas.right(columns(area, verdict, VERDICT), Role::Dim, "verdict");
    }
    if let Some(row) = single {
        if let Some(drift) = row.drift {
            canvas.right(columns(area, drift, single_row::DRIFT), Role::Dim, "change");
        }
        canvas.right(columns(area, row.value, row.value_width), Role::Dim, "value");
    } else {
        canvas.right(columns(area, 0, VALUE + 2), Role::Dim, "value");
        canvas.right(columns(area, VALUE + 3, DRIFT), Role::Dim, "change");
    }
}

/// Reports the deviation from the law of motion, if a gauge has detected one.
pub(super) fn departed(snapshot: &Snapshot, glyphs: Glyphs) -> Option<(Role, String)> {
    let gauge = Gauge::departed(&snapshot.gauges)?;
    let (word, role) = match gauge.verdict {
        Verdict::Lost => ("lost", Role::Bad),
        Verdict::Bounded => ("swings", Role::Warn),
        _ => ("off", Role::Bad),
    };
    let name = glyphs.pick(&gauge.shown, &gauge.name);
    let drift = shown_drift(gauge.max_drift, usize::MAX, glyphs);
    Some((role, format!("! {name} {word} {drift}")))
}

fn sentence(verdict: &Verdict, glyphs: Glyphs) -> String {
    match verdict {
        Verdict::Open => "the motion is too short for a verdict".to_owned(),
        Verdict::Unknown(Unseen::Underflow) => {
            "its terms are too small for numbers with all their digits (underflow)".to_owned()
        }
        Verdict::Unknown(Unseen::Rounded(input)) => format!(
            "rounding of {} explains its change: its digits are {} apart",
            input.name,
            number::drift(input.digits, glyphs)
        ),
        Verdict::Unknown(Unseen::Unresolved(factor)) => format!(
            "it cannot resolve the motion: its terms are larger than what moves by {}",
            number::drift(*factor, glyphs)
        ),
        Verdict::Exact(Growth::Level) => "exact to rounding, and stays so".to_owned(),
        Verdict::Exact(Growth::Root) => {
            "exact to rounding; the error grows like √t, the least that rounding allows".to_owned()
        }
        Verdict::Exact(Growth::Faster) => {
            "exact to rounding, but the error grows faster than √t".to_owned()
        }
        Verdict::Bounded => "oscillates without trend, as under a symplectic method".to_owned(),
        Verdict::Secular(slope) => {
            format!(
                "grows by {} per unit of time, an error of the method",
                number::drift(*slope, glyphs)
            )
        }
        Verdict::Lost => "has left its value by more than a tenth of what moves".to_owned(),
        Verdict::Broken(law) => format!("by the physics: {law}"),
        Verdict::OtherBranch => {
            "p is that of the other root of S, where another number is conserved".to_owned()
        }
        Verdict::Released => "there is no residual to judge any more".to_owned(),
    }
}

/// Draws the name, the reason for its conservation and, at the right, the verdict, in full or in a word. A residual is called
/// so; it is satisfied rather than conserved, so its verdict is a word. A reason that stands alone has rows of its own below.
fn name_and_reason(
    canvas: &mut Canvas<'_>,
    area: Rect,
    (gauge, all, residual): (&Gauge, &[Gauge], bool),
    (here, full, alone): (bool, bool, bool),
) {
    let words = beside_name(gauge, full);
    let room = if full { IN_FULL + 2 } else { VERDICT.max(words.0.width() as u16) };
    let used = verdict(canvas, columns(area, area.width.saturating_sub(room), room), gauge, words);
    let area = columns(area, 0, area.width.saturating_sub(used + 1));
    let used = name(canvas, area, (gauge, all), here) + 2;
    // A reason is shown whole, or in a word.
    let whole = canvas.text(&reason(gauge, residual, canvas.style.glyphs));
    let in_a_word = if alone { "" } else { reason_in_a_word(gauge, residual) };
    let room = usize::from(area.width.saturating_sub(used));
    if let Some(reason) = [&*whole, in_a_word].into_iter().find(|text| text.width() <= room) {
        canvas.left(columns(area, used, area.width), Role::Dim, reason);
    }
}

/// Draws value, drift, and the history of the drift on a logarithmic scale; of what is not conserved that of its change, on a linear
/// one. A residual is its own drift, and is shown once.
fn numbers_and_history(canvas: &mut Canvas<'_>, area: Rect, (gauge, residual): (&Gauge, bool)) {
    value(canvas, columns(area, 0, VALUE + 2), shown_value(gauge, residual), 6);
    if !residual {
        drift(canvas, columns(area, VALUE + 3, DRIFT), gauge);
    }
    let room = area.width.saturating_sub(VALUE + DRIFT + 5);
    let sparkline = columns(area, area.width.saturating_sub(room.min(HISTORY)), HISTORY);
    let is_broken = matches!(gauge.verdict, Verdict::Broken(_));
    let value =
        |change: &f32| if is_broken { f64::from(*change) } else { f64::from(*change).abs() };
    let values: Vec<f64> = gauge.history.iter().map(value).collect();
    let shown = || values.iter().copied().filter(|drift| *drift >= FLOOR && drift.is_finite());
    let ends = values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], &value| {
        [lo.min(value), hi.max(value)]
    });
    // what rounding leaves is flat, however little it is
    let is_rounding = matches!(gauge.verdict, Verdict::Exact(_));
    let most = shown().fold(if is_rounding { ROUNDING } else { FLOOR * LEAST_RATIO }, f64::max);
    let least = shown().fold(most / LEAST_RATIO, f64::min);
    let history = Sparkline {
        values: &values,
        column: if is_broken { ColumnValue::Mean } else { ColumnValue::Greatest },
        scale: if is_broken {
            Scale::linear(ends[0], ends[1])
        } else {
            Scale::log(if is_rounding { FLOOR } else { least }, most)
        },
        style: canvas.style(drift_role(gauge)),
        glyphs: canvas.style.glyphs,
    };
    history.render(sparkline, canvas.buffer);
}

/// Draws name, value, drift and verdict in a single row.
fn in_one_row(
    canvas: &mut Canvas<'_>,
    area: Rect,
    row: SingleRow,
    (gauge, all): (&Gauge, &[Gauge]),
    here: bool,
) {
    verdict(canvas, columns(area, row.verdict, area.width), gauge, word(&gauge.verdict));
    if let Some(at) = row.drift {
        drift(canvas, columns(area, at, single_row::DRIFT), gauge);
    }
    let shown = shown_value(gauge, row.residual);
    let used = value(canvas, columns(area, row.value, row.value_width), shown, 4);
    // The name has the columns that the value leaves blank, too.
    let room = (row.value + row.value_width).saturating_sub(used + 1);
    name(canvas, columns(area, 0, room), (gauge, all), here);
}

/// Draws the words for the verdict at the right, with a sign if impulses have changed the value: after the words that refer
/// to it, else before them. Returns the number of columns used.
fn verdict(canvas: &mut Canvas<'_>, area: Rect, gauge: &Gauge, (text, role): (&str, Role)) -> u16 {
    let width = text.width() as u16;
    if given_by_impulses(gauge).is_none() || width + 2 > area.width {
        return canvas.right(area, role, text);
    }
    let sign = Marker::Diamond.symbol(canvas.style.glyphs).to_string();
    let after = if text == BETWEEN { 2 } else { 0 };
    let used = canvas.right(columns(area, 0, area.width - after), role, text);
    let at = if after > 0 { area.width - 1 } else { area.width - used - 2 };
    canvas.left(columns(area, at, 1), Role::Warn, &sign);
    used + 2
}

pub(super) fn finding(gauge: &Gauge, glyphs: Glyphs) -> String {
    let sentence = sentence(&gauge.verdict, glyphs);
    match given_by_impulses(gauge) {
        None => sentence,
        Some(given) => {
            format!("{sentence}; impulses have changed it by {}", readable(given, 6, glyphs).trim())
        }
    }
}

/// Writes the name of a gauge; if it is too long, with its last words where another one begins in the same way.
fn name(canvas: &mut Canvas<'_>, area: Rect, (gauge, all): (&Gauge, &[Gauge]), here: bool) -> u16 {
    let glyphs = canvas.style.glyphs;
    let (room, mark) = (usize::from(area.width), glyphs.pick("…", "~"));
    let short = |gauge: &Gauge| {
        shortened(&canvas.text(glyphs.pick(&*gauge.shown, &*gauge.name)), room, mark)
    };
    let mut text = short(gauge);
    if all.iter().filter(|other| short(other) == text).count() > 1 {
        text = shortened_within(&canvas.text(glyphs.pick(&*gauge.shown, &*gauge.name)), room, mark);
    }
    canvas.left(area, if here { Role::Title } else { Role::Text }, &text)
}

/// The value of a gauge as it is shown: zero where it is below the last digit of its terms, unless it is a residual, of which
/// only that much is left.
pub(super) fn shown_value(gauge: &Gauge, residual: bool) -> f64 {
    let below = gauge.value.abs() < f64::EPSILON * gauge.scale;
    if below && !residual { 0.0 } else { gauge.value }
}

/// Draws the value at the right. Returns the number of columns used.
fn value(canvas: &mut Canvas<'_>, area: Rect, value: f64, digits: usize) -> u16 {
    let glyphs = canvas.style.glyphs;
    let text = if value.is_nan() {
        glyphs.pick("–", "-").to_owned()
    } else {
        fitted(value, digits, area.width.into(), glyphs)
    };
    canvas.right(area, Role::Accent, text.trim_start())
}

fn drift(canvas: &mut Canvas<'_>, area: Rect, gauge: &Gauge) {
    let (width, glyphs) = (usize::from(area.width), canvas.style.glyphs);
    let text = change(gauge, width, glyphs);
    let text = text.unwrap_or_else(|| match gauge.drift {
        drift if drift.is_nan() => glyphs.pick("–", "-").to_owned(),
        drift => shown_drift(drift, width, glyphs),
    });
    canvas.right(area, drift_role(gauge), &text);
}

/// The change of what is not conserved since the reference was taken, with its sign: in per cent of the value there, or in its
/// own unit where that is zero or many times smaller. `None` for what is conserved.
pub(super) fn change(gauge: &Gauge, width: usize, glyphs: Glyphs) -> Option<String> {
    let is_broken = matches!(gauge.verdict, Verdict::Broken(_)) && !gauge.drift.is_nan();
    let by = Some(gauge.value - gauge.initial).filter(|_| is_broken)?;
    let sign = if by < 0.0 { glyphs.pick("−", "-") } else { "+" };
    let share = 100.0 * (by / gauge.initial).abs();
    let is_zero = gauge.initial.abs() <= ROUNDING * gauge.scale;
    Some(match share {
        _ if by.abs() <= ROUNDING * gauge.scale => "0".to_owned(),
        _ if is_zero || share.is_nan() || share >= 1000.0 => {
            let room = width.saturating_sub(1);
            format!("{sign}{}", fitted(by.abs(), 3, room, glyphs).trim_start())
        }
        ..0.01 => glyphs.pick("≈ 0 %", "~ 0 %").to_owned(),
        ..1.0 => format!("{sign}{share:.2} %"),
        ..10.0 => format!("{sign}{share:.1} %"),
        _ => format!("{sign}{share:.0} %"),
    })
}

/// A drift in a column: a large one in per cent of what moves.
fn shown_drift(drift: f64, width: usize, glyphs: Glyphs) -> String {
    match drift {
        0.01..10.0 => format!("{:.0} %", 100.0 * drift),
        _ => number::drift_in(drift, width, glyphs),
    }
}

/// The role of a drift: a change with a physical cause is not an error of the method.
fn drift_role(gauge: &Gauge) -> Role {
    let physical = matches!(gauge.verdict, Verdict::Broken(_));
    if physical { Role::Dim } else { word(&gauge.verdict).1 }
}
