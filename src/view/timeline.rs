//! The time bar: the recorded past of the motion, the marks on it, and the time that is seen.
//!
//! In: the lab. Out: a line of cells, and what the mouse points at there. Never here: what is seen at that time.

use ratatui::layout::Rect;
use unicode_width::UnicodeWidthStr;

use super::canvas::{Canvas, StyledText, columns};
use super::number::brief;
use super::region::ScreenRegion;
use super::theme::Role;
use crate::app::Lab;
use crate::experiment::{Recorded, Snapshot, Status};

/// The fewest columns of the bar itself, and the most.
const SHORTEST: u16 = 10;
const LONGEST: u16 = 60;

/// The columns that the bar takes at least where it is shown.
pub(super) const LEAST: u16 = SHORTEST + 18;

/// Whether the bar is shown: while time stands still, runs backwards, or has marks.
pub(super) fn is_shown(lab: &Lab, snapshot: &Snapshot) -> bool {
    let Recorded { from, to, scrubbed, .. } = snapshot.recorded;
    let stands = matches!(snapshot.status, Status::Paused | Status::Ended(_));
    from != to && (scrubbed || stands || snapshot.backwards || !lab.marks.is_empty())
}

/// Draws the bar at the right end of a line.
pub(super) fn draw(canvas: &mut Canvas<'_>, area: Rect, lab: &Lab, snapshot: &Snapshot) {
    let Recorded { from, to, .. } = snapshot.recorded;
    // time runs to the right, whichever way the motion took
    let (low, high) = (from.min(to), from.max(to));
    let glyphs = canvas.style.glyphs;
    let ends = [low, high].map(|time| brief(time, 4, glyphs));
    let words = ends.iter().map(|text| text.width() as u16 + 1).sum::<u16>();
    if area.width < words + SHORTEST {
        return;
    }
    let wide = (area.width - words).min(LONGEST);
    let from_left = area.width - words - wide;
    let cell = |time: f64| {
        let share = ((time - low) / (high - low)).clamp(0.0, 1.0);
        (share * f64::from(wide - 1)).round() as usize
    };
    let (here, now) = (cell(snapshot.time), cell(to));
    let marked: Vec<usize> =
        lab.marks.iter().filter(|mark| **mark >= low && **mark <= high).map(|m| cell(*m)).collect();
    let mut spans: Vec<StyledText> = vec![canvas.span(Role::Dim, format!("{} ", ends[0]))];
    for place in 0..usize::from(wide) {
        let (role, sign) = if place == here {
            (Role::Accent, glyphs.pick("●", "O"))
        } else if marked.contains(&place) {
            (Role::Warn, glyphs.pick("◆", "#"))
        } else if place == now {
            (Role::Text, glyphs.pick("┃", "|"))
        } else if (place < here) == (to >= from) {
            (Role::Level, glyphs.pick("━", "="))
        } else {
            (Role::Border, glyphs.pick("─", "-"))
        };
        spans.push(canvas.span(role, sign));
    }
    spans.push(canvas.span(Role::Dim, format!(" {}", ends[1])));
    canvas.spans(columns(area, from_left, area.width), &spans);
    let bar = columns(area, from_left + ends[0].width() as u16 + 1, wide);
    canvas.region(bar, ScreenRegion::Time([low, high]));
}
