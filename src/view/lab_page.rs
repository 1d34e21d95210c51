//! The lab's page: every pane in its frame, and over them the reason why the motion stopped.
//!
//! In: the lab and the layout. Out: cells. Never here: the contents of a single pane.

use ratatui::layout::Rect;
use unicode_width::UnicodeWidthStr;

use super::canvas::{Canvas, StyledText, columns, row, wide};
use super::layout::{Slot, is_single, panes, view_of_motion};
use super::list_tabs::{ListTabs, add_key, add_targets, name};
use super::number::{brief, with_minus_signs};
use super::quantity::Quantities;
use super::region::ScreenRegion;
use super::text_page::draw_rows;
use super::theme::Role;
use super::values::{ValueList, window};
use super::wrap::{capitalised, words};
use super::{equations, gauges, picture, picture_title, placeholder, tabs};
use crate::app::{
    App, DrawnPanes, HitTarget, InputField, Lab, LawInView, Overlay, Pane, PanesInView, UnderWay,
    ValueId,
};
use crate::experiment::{RunError, Status};

/// Draws all panes of the layout, and returns what that has determined.
pub(super) fn draw(canvas: &mut Canvas<'_>, area: Rect, app: &App, lab: &Lab) -> DrawnPanes {
    let field = match &app.overlay {
        Some(Overlay::Field(field)) => Some(field),
        _ => None,
    };
    let slots = panes(area, lab, canvas.style.glyphs);
    let mut in_view = LawInView::Hidden;
    let shown: Vec<usize> = slots.iter().filter_map(|(slot, _)| slot.plot()).collect();
    let in_sight = PanesInView::of(slots.iter().filter_map(|(slot, _)| slot.pane()));
    for (slot, place) in slots {
        match slot {
            Slot::Pane(Pane::Plot(index)) => {
                // The last picture takes turns with those that have no slot.
                let here = |other: &usize| *other == index || !shown.contains(other);
                let last = shown.last() == Some(&index);
                let sharing: Vec<usize> = (0..lab.plots.len())
                    .filter(here)
                    .take_while(|_| last && !lab.focus.zoomed)
                    .collect();
                plot(canvas, place, lab, (index, &sharing));
            }
            Slot::Law | Slot::Pane(Pane::Law) => {
                let title = [canvas.span(Role::Title, name(Pane::Law))];
                in_view = law(canvas, place, lab, &title);
            }
            Slot::LineOfLaw => line_of_law(canvas, place, lab),
            Slot::Pane(pane) => {
                let mut title = vec![canvas.span(Role::Title, name(pane))];
                if pane == Pane::Gauges {
                    title.extend(since(canvas, lab));
                }
                list(canvas, place, (lab, pane), &title, field);
            }
            Slot::Values(pane) | Slot::Lists(pane) => {
                let shared: &[Pane] = if matches!(slot, Slot::Lists(_)) {
                    &[Pane::Parameters, Pane::Initial, Pane::Gauges, Pane::Law]
                } else {
                    &[Pane::Parameters, Pane::Initial, Pane::Law]
                };
                let tabs = ListTabs::of(canvas, shared, pane, place);
                if pane == Pane::Law {
                    in_view = law(canvas, place, lab, &tabs.title);
                } else {
                    list(canvas, place, (lab, pane), &tabs.title, field);
                }
                tabs.add_targets(canvas, place);
            }
        }
    }
    if let Some(Status::Failed(error)) = lab.snapshot.as_ref().map(|s| &s.status) {
        stopped(canvas, area, (lab, error));
    }
    DrawnPanes { single: is_single(area), law: in_view, in_view: in_sight }
}

/// Draws only the view of the motion, or the first view there is; over it the reason why the motion stopped.
pub(super) fn draw_motion(canvas: &mut Canvas<'_>, area: Rect, lab: &Lab) {
    plot(canvas, area, lab, (view_of_motion(lab).unwrap_or(0), &[]));
    if let Some(Status::Failed(error)) = lab.snapshot.as_ref().map(|s| &s.status) {
        stopped(canvas, area, (lab, error));
    }
}

/// Draws the first row of the law of motion, and how many more it has.
fn line_of_law(canvas: &mut Canvas<'_>, area: Rect, lab: &Lab) {
    canvas.target(area, HitTarget::Pane(Pane::Law));
    let mut cache = std::mem::take(&mut canvas.cache);
    let rows = cache.law(&lab.loaded.equations, area.width, || {
        equations::law(lab, canvas.style).wrapped(canvas, area.width)
    });
    let glyphs = canvas.style.glyphs;
    let more = match rows.len() {
        0 | 1 => String::new(),
        all => format!("+{} {}", all - 1, glyphs.pick("↓", "down")),
    };
    let used = canvas.right(columns(area, 0, area.width - 1), Role::Dim, &more);
    if let Some(first) = rows.first() {
        canvas.spans(columns(area, 2, area.width.saturating_sub(used + 4)), first);
    }
    canvas.cache = cache;
}

/// Draws the law of motion, and returns how much of it is in view.
fn law(canvas: &mut Canvas<'_>, area: Rect, lab: &Lab, title: &[StyledText]) -> LawInView {
    let inner = canvas.pane(area, title, lab.focus.pane == Pane::Law);
    canvas.target(area, HitTarget::Pane(Pane::Law));
    let mut cache = std::mem::take(&mut canvas.cache);
    let rows = cache.law(&lab.loaded.equations, inner.width, || {
        equations::law(lab, canvas.style).wrapped(canvas, inner.width)
    });
    let drawn = draw_rows(canvas, inner, lab.law_scroll, rows);
    canvas.cache = cache;
    let above = lab.law_scroll.min(drawn.beyond);
    canvas.out_of_sight(area, above.into(), usize::from(drawn.beyond - above));
    if drawn.beyond == 0 { LawInView::Whole } else { LawInView::Clipped(drawn.beyond) }
}

/// The time from which the gauges measure, if it is not the beginning.
fn since(canvas: &Canvas<'_>, lab: &Lab) -> Option<StyledText> {
    let time = lab.snapshot.as_ref()?.gauges.first()?.reference_time;
    let begun = lab.loaded.model.run.start;
    let text = || format!("  since t = {}", brief(time, 6, canvas.style.glyphs));
    (time != begun).then(|| canvas.span(Role::Dim, text()))
}

fn list(
    canvas: &mut Canvas<'_>,
    area: Rect,
    (lab, pane): (&Lab, Pane),
    title: &[StyledText],
    field: Option<&InputField>,
) {
    let focused = lab.focus.pane == pane;
    let inner = canvas.pane(area, title, focused);
    canvas.target(area, HitTarget::Pane(pane));
    let values = |kind, selected| ValueList { lab, kind, selected, focused, field };
    beyond(canvas, area, lab, pane);
    match pane {
        Pane::Parameters => {
            values(ValueId::Parameter, lab.selection.parameter).draw(canvas, inner);
        }
        Pane::Initial => values(ValueId::Initial, lab.selection.initial).draw(canvas, inner),
        Pane::Gauges => {
            let selected = focused.then_some(lab.selection.gauge);
            gauges::draw(canvas, inner, lab, selected);
        }
        Pane::Plot(_) | Pane::Law => {}
    }
}

/// Says in the lower border of a list how many of its lines are out of sight.
fn beyond(canvas: &mut Canvas<'_>, area: Rect, lab: &Lab, pane: Pane) {
    let gauges = lab.snapshot.as_ref().map_or(0, |s| s.gauges.len());
    let (count, selected) = match pane {
        Pane::Parameters => (lab.count(ValueId::Parameter), lab.selection.parameter),
        Pane::Initial => (lab.count(ValueId::Initial), lab.selection.initial),
        Pane::Gauges => (gauges, lab.selection.gauge),
        Pane::Plot(_) | Pane::Law => return,
    };
    let rows = usize::from(area.height.saturating_sub(2));
    let hidden = count.saturating_sub(rows);
    let above = if hidden == 0 { 0 } else { window(selected, count, rows) };
    canvas.out_of_sight(area, above, hidden.saturating_sub(above));
}

/// Draws a picture; `sharing` are the pictures that take turns in its frame.
fn plot(canvas: &mut Canvas<'_>, area: Rect, lab: &Lab, (index, sharing): (usize, &[usize])) {
    let focused = lab.focus.pane == Pane::Plot(index);
    let (Some(plot), Some(q)) = (lab.plots.get(index), Quantities::of(lab, canvas.style)) else {
        let inner = canvas.pane(area, &[], focused);
        placeholder::draw(canvas, inner, "The motion will be shown here; it is being prepared.");
        return;
    };
    // Between the corners, with a blank at each side.
    let room = usize::from(area.width.saturating_sub(6));
    // how far what it shows is computed has precedence over the names of the others
    let status = lab
        .under_way(plot)
        .and_then(UnderWay::status)
        .map_or(0, |status| format!("{}    {status}", tabs::label(&q, plot)).width());
    let tabs = tabs::of(canvas, &q, (index, sharing), room.saturating_sub(status));
    let pictures = tabs.as_ref().map_or(Vec::new(), |tabs| tabs.pictures.clone());
    let mut title = match tabs.map(|tabs| tabs.spans) {
        Some(tabs) => {
            let label = tabs::label(&q, plot);
            // its name is among the tabs already
            let left = room.saturating_sub(wide(&tabs) + 2);
            let named = picture_title::title(canvas, &q, plot, left + label.width());
            let is_named = named.first().is_some_and(|(text, _)| text.trim() == label);
            let own = if is_named { named } else { picture_title::title(canvas, &q, plot, left) };
            let rest: Vec<StyledText> =
                own.into_iter().filter(|(text, _)| text.trim() != label).collect();
            let gap = canvas.span(Role::Dim, "  ");
            let is_alone = rest.is_empty();
            let whole: Vec<StyledText> = tabs.iter().cloned().chain([gap]).chain(rest).collect();
            // Values are shown beside tabs where all of them fit.
            let mut shown = if wide(&whole) <= room && !is_alone { whole } else { tabs };
            add_key(canvas, &mut shown, room);
            shown
        }
        None => picture_title::title(canvas, &q, plot, room),
    };
    let mark = gauges::departed(q.snapshot, canvas.style.glyphs).map(|(role, _)| role);
    let tabs_from = if mark.is_some() { 2 } else { 0 };
    title.splice(0..0, mark.map(|role| canvas.span(role, "! ")));
    let inner = canvas.pane(area, &title, focused);
    canvas.target(area, HitTarget::Pane(Pane::Plot(index)));
    if !pictures.is_empty() {
        let panes: Vec<Pane> = pictures.into_iter().map(Pane::Plot).collect();
        let own = &title[usize::from(mark.is_some())..];
        add_targets(canvas, columns(area, tabs_from, area.width), own, &panes);
    }
    // What the frame has no room for is written above the axes.
    let keys = picture_title::keys_beyond(canvas, &q, plot, &title);
    match picture::draw(canvas, inner, (&q, plot), &keys) {
        Some(frame) => canvas.region(frame.area, ScreenRegion::Plot(index, frame)),
        None if plot.kind.properties().is_scene => {
            canvas.region(inner, ScreenRegion::Space(index));
            for (place, shape, frame) in std::mem::take(&mut canvas.masses) {
                canvas.region(place, ScreenRegion::Mass(index, shape, frame));
            }
        }
        None => {}
    }
}

/// Draws a box over the panes that explains why the motion cannot begin or continue, and what may help.
fn stopped(canvas: &mut Canvas<'_>, area: Rect, (lab, error): (&Lab, &RunError)) {
    let (title, keys) = if error.time == lab.loaded.model.run.start {
        ("The motion cannot begin", "E edit the file   u undo the last change")
    } else {
        ("The motion cannot continue", "r back to the start   u undo the last change")
    };
    let width = area.width.saturating_sub(4).min(70);
    let text = with_minus_signs(&capitalised(&error.message), canvas.style.glyphs);
    let text = canvas.text(&text);
    let lines = words(&text, usize::from(width.saturating_sub(4)));
    let height = (lines.len() as u16 + 4).min(area.height);
    let title = canvas.span(Role::Bad, title);
    // the keys are those of the pane below it
    let beside = std::mem::replace(&mut canvas.beside, true);
    let (_, inner) = canvas.dialog(area, (width, height), title);
    canvas.beside = beside;
    for (index, line) in lines.iter().enumerate() {
        canvas.left(row(inner, index), Role::Text, line);
    }
    canvas.left(row(inner, lines.len() + 1), Role::Dim, keys);
}
