//! The tabs of the lists that share a frame.
//!
//! In: the panes that share it, which of them is shown, the room. Out: spans of a title, and where each is clicked. Never
//! here: the lists themselves.

use ratatui::layout::Rect;
use unicode_width::UnicodeWidthStr;

use super::canvas::{Canvas, StyledText, columns, row, wide};
use super::theme::Role;
use crate::app::{HitTarget, Pane};

/// The title of a pane that has a frame of its own.
pub(super) fn name(pane: Pane) -> &'static str {
    match pane {
        Pane::Plot(_) => "Plot",
        Pane::Parameters => "Parameters",
        Pane::Initial => "Initial values",
        Pane::Gauges => "Gauges",
        Pane::Law => "Law of motion",
    }
}

/// The title of a pane among others, in full or shortened.
fn among_others(pane: Pane, short: bool) -> &'static str {
    match pane {
        Pane::Law => "Law",
        Pane::Initial if short => "Initial",
        pane => name(pane),
    }
}

/// A row of titles. The shown one is highlighted and always there.
pub(super) struct ListTabs {
    pub(super) title: Vec<StyledText>,
    /// The pane of every second span, if all titles are there.
    panes: Vec<Pane>,
}

impl ListTabs {
    /// The titles of panes with a line between neighbours, shortened where they do not fit into the frame. Where they do not
    /// fit even so, the shown one with its place among all.
    pub(super) fn of(canvas: &Canvas<'_>, panes: &[Pane], shown: Pane, frame: Rect) -> Self {
        let glyphs = canvas.style.glyphs;
        let room = usize::from(frame.width.saturating_sub(6));
        let between = [glyphs.pick(" │ ", " | "), glyphs.pick("│", "|")];
        for (short, between) in [(false, between[0]), (true, between[0]), (true, between[1])] {
            let mut title = Vec::new();
            for pane in panes {
                if !title.is_empty() {
                    title.push(canvas.span(Role::Border, between));
                }
                let role = if *pane == shown { Role::Title } else { Role::Dim };
                title.push(canvas.span(role, among_others(*pane, short)));
            }
            if wide(&title) <= room {
                add_key(canvas, &mut title, room);
                return Self { title, panes: panes.to_vec() };
            }
        }
        let place = panes.iter().position(|pane| *pane == shown).unwrap_or(0) + 1;
        let own = canvas.span(Role::Title, among_others(shown, false));
        let counted = canvas.span(Role::Dim, format!(" {place}/{}", panes.len()));
        let mut title = vec![own, counted];
        add_key(canvas, &mut title, room);
        Self { title, panes: Vec::new() }
    }

    pub(super) fn add_targets(&self, canvas: &mut Canvas<'_>, frame: Rect) {
        add_targets(canvas, frame, &self.title, &self.panes);
    }
}

/// Writes the key that shows the next tab after the tabs, where there is room for it.
pub(super) fn add_key(canvas: &Canvas<'_>, title: &mut Vec<StyledText>, room: usize) {
    if wide(title) + KEY.len() <= room {
        title.push(canvas.span(Role::Accent, KEY));
    }
}

const KEY: &str = "  \\";

/// Makes the titles of panes in a frame clickable; a line separates neighbouring titles.
pub(super) fn add_targets(
    canvas: &mut Canvas<'_>,
    frame: Rect,
    title: &[StyledText],
    panes: &[Pane],
) {
    let mut from = 3;
    for (index, (text, _)) in title.iter().enumerate() {
        let long = text.width() as u16;
        if let (0, Some(pane)) = (index % 2, panes.get(index / 2)) {
            let place =
                columns(row(frame, 0), from, long.min(frame.width.saturating_sub(from + 2)));
            canvas.target(place, HitTarget::Pane(*pane));
        }
        from += long;
    }
}
