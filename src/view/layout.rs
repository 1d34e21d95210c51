//! The layout: the areas of the screen's parts, as a pure function of the area and the focus.
//!
//! In: an area, the glyphs of the terminal. Out: rectangles. Never here: drawing.

use ratatui::layout::Rect;

use super::glyphs::Glyphs;
use super::verdict::reasons_below;
use super::wrap::words;
use crate::app::{Lab, Pane, ValueId};
use crate::expr::{Expr, Rank};
use crate::instrument::{MotionCurve, Plot, Properties};
use crate::model::Shape;

/// The smallest usable screen.
pub(super) const LEAST: (u16, u16) = (40, 10);

/// The smallest size of a plot beside others, and of a column of lists.
const PLOT: (u16, u16) = (50, 13);
const LISTS: (u16, u16) = (40, 52);

/// A screen's parts: a header, the body, a status line and a line of hints, if there are any.
pub(super) struct ScreenLayout {
    pub(super) header: Rect,
    pub(super) body: Rect,
    pub(super) status: Rect,
    pub(super) footer: Rect,
}

impl ScreenLayout {
    pub(super) fn of(area: Rect, status: bool, footer: bool) -> Self {
        let line = |y: u16| Rect { y, height: 1, ..area };
        let (status, footer) = (u16::from(status), u16::from(footer));
        let below = status + footer;
        Self {
            header: line(area.y),
            body: Rect { y: area.y + 1, height: area.height - 1 - below, ..area },
            status: Rect { height: status, ..line(area.bottom() - below) },
            footer: Rect { height: footer, ..line(area.bottom() - footer) },
        }
    }
}

/// The content of an area of the lab.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Slot {
    /// A pane that can be focused.
    Pane(Pane),
    /// The parameters or, while they are focused, the initial values or the law; all titles are in the frame.
    Values(Pane),
    /// One of the three lists, or the law; all titles are in the frame.
    Lists(Pane),
    /// The law of motion, if there is room to spare.
    Law,
    /// Its first row, without a frame.
    LineOfLaw,
}

impl Slot {
    /// The pane in it, if it can be focused there.
    pub(super) fn pane(self) -> Option<Pane> {
        match self {
            Self::LineOfLaw => None,
            Self::Pane(pane) | Self::Values(pane) | Self::Lists(pane) => Some(pane),
            Self::Law => Some(Pane::Law),
        }
    }

    /// The index of the picture in it, if it has one.
    pub(super) fn plot(self) -> Option<usize> {
        match self {
            Self::Pane(Pane::Plot(index)) => Some(index),
            _ => None,
        }
    }
}

pub(super) fn panes(area: Rect, lab: &Lab, glyphs: Glyphs) -> Vec<(Slot, Rect)> {
    let Rect { width, height, .. } = area;
    if lab.focus.zoomed {
        vec![(Slot::Pane(lab.focus.pane), area)]
    } else if width >= 110 && height >= 26 {
        wide(area, lab, glyphs)
    } else if width >= 64 && height >= 16 {
        square(area, lab)
    } else if width >= 64 {
        let (left, right) = split_columns(area, width / 2);
        vec![(plot_slot(lab), left), (Slot::Lists(list(lab)), right)]
    } else if height >= 16 {
        let (above, below) = split_rows(area, height / 2);
        vec![(plot_slot(lab), above), (Slot::Lists(list(lab)), below)]
    } else {
        // The motion comes first, until a key has been pressed.
        let motion = lab.motion().filter(|_| lab.focus.untouched);
        vec![(Slot::Pane(motion.unwrap_or(lab.focus.pane)), area)]
    }
}

/// Whether there is room for one pane only.
pub(super) fn is_single(area: Rect) -> bool {
    area.width < 64 && area.height < 16
}

/// Rows for the reason of the selected gauge.
const REASON: u16 = 3;

/// The least rows of a list and of the law of motion, with their frames.
const SHORTEST: u16 = 4;
const LAW: u16 = 6;

/// The rows of the law from which some of its equations of motion are seen, too.
const LAW_WITH_EQUATIONS: u16 = 9;

/// Places plots at the left and lists in a column at the right.
fn wide(area: Rect, lab: &Lab, glyphs: Glyphs) -> Vec<(Slot, Rect)> {
    let lists = (area.width * 3 / 10).clamp(LISTS.0, LISTS.1);
    let (left, right) = split_columns(area, area.width - lists);
    let mut slots = plots(left, lab);
    slots.extend(column(right, lab, glyphs));
    slots
}

/// The rows from which the law of motion has one of them between two pictures and two lists.
const WITH_LAW: u16 = 20;

/// Places two plots above, and values and gauges below; between them the first row of the law of motion.
fn square(area: Rect, lab: &Lab) -> Vec<(Slot, Rect)> {
    let gauges = lab.snapshot.as_ref().map_or(0, |s| s.gauges.len()) as u16;
    let wanted = (lab.count(ValueId::Parameter) as u16).max(gauges + 1) + 2;
    let below = wanted.clamp(area.height / 3, area.height * 9 / 20);
    let (above, below) = split_rows(area, area.height - below);
    let (left, right) = split_columns(below, below.width / 2);
    let line = u16::from(area.height >= WITH_LAW);
    let (above, law) = split_rows(above, above.height - line);
    let mut slots = side_by_side(above, &chosen(lab, 2));
    if line > 0 {
        slots.push((Slot::LineOfLaw, law));
    }
    slots.push((Slot::Values(values(lab)), left));
    slots.push((Slot::Pane(Pane::Gauges), right));
    slots
}

/// Places plots in two rows: two large ones, and below them as many as fit. Where what is to lie below them alone is as high
/// as wide, both rows have two of equal size.
fn plots(area: Rect, lab: &Lab) -> Vec<(Slot, Rect)> {
    let below = usize::from((area.width / PLOT.0).max(1));
    let count = lab.plots.len();
    if count <= 2 || area.height < 2 * PLOT.1 {
        return side_by_side(area, &chosen(lab, 2));
    }
    let is_square = |index: &usize| {
        let plot = &lab.plots[*index];
        let properties = plot.kind.properties();
        properties.is_transformed() || properties.is_scene && !is_level(plot, lab)
    };
    let four = below == 1 && count > 3 && arranged(lab, 3).last().is_some_and(is_square);
    let (room, above) = if four { (4, area.height / 2) } else { (2 + below, area.height * 3 / 5) };
    let shown = chosen(lab, room);
    let (upper, lower) = split_rows(area, above);
    let (first, rest) = shown.split_at(2);
    let mut slots = side_by_side(upper, first);
    slots.extend(side_by_side(lower, rest));
    slots
}

/// Places the lists below each other, then the law of motion if rows are left.
fn column(area: Rect, lab: &Lab, glyphs: Glyphs) -> Vec<(Slot, Rect)> {
    let gauges = lab.snapshot.as_ref().map_or(0, |s| s.gauges.len()) as u16;
    let parameters = lab.count(ValueId::Parameter) as u16;
    let reasons = rows_of_reasons(lab, area.width, glyphs);
    // A frame takes two rows, a gauge two and the gauges' headings one; the meaning of the selected parameter takes
    // two, and the reason of the selected gauge some more while there is one. Rows to spare are the law's.
    let focused = if lab.focus.pane == Pane::Gauges { REASON } else { 0 };
    let wants = [
        parameters + 2 + meaning(lab, area.width),
        lab.count(ValueId::Initial) as u16 + 2,
        2 * gauges.max(1) + 3 + focused + reasons,
    ];
    let mut heights = wants.map(|want| want.max(SHORTEST));
    let bare = 2 * gauges + 3 + focused;
    // What a value means is below the panes too, and gives way to the rows of gauges, and to reasons but for its first row; then
    // reasons do, also to the equations of motion.
    let excess = (heights.iter().sum::<u16>() + LAW_WITH_EQUATIONS).saturating_sub(area.height);
    if heights[0].saturating_sub(parameters + 4) >= excess {
        heights[0] -= excess;
    }
    for (list, least, law) in [(0, parameters + 2, LAW), (2, bare, LAW_WITH_EQUATIONS)] {
        let excess = (heights.iter().sum::<u16>() + law).saturating_sub(area.height);
        heights[list] -= excess.min(heights[list].saturating_sub(least.max(SHORTEST)));
    }
    let mut total: u16 = heights.iter().sum();
    while total + LAW > area.height && heights.iter().any(|height| *height > SHORTEST) {
        // The tallest list shrinks first.
        let tallest = (0..3).max_by_key(|&i| heights[i]).unwrap_or(0);
        heights[tallest] -= 1;
        total -= 1;
    }
    // Reasons have all of their rows or none.
    if heights[2] < bare + reasons {
        heights[2] = heights[2].min(bare.max(SHORTEST));
    }
    // What two rows a gauge are not enough for is left to the law.
    if heights[2] < 2 * gauges + 3 {
        heights[2] = heights[2].min((gauges + 3 + focused).max(SHORTEST));
    }
    let total: u16 = heights.iter().sum();
    let spare = area.height.saturating_sub(total);
    let law = spare >= LAW;
    if !law {
        heights[2] += spare;
    }
    let panes = [Pane::Parameters, Pane::Initial, Pane::Gauges].map(Slot::Pane);
    let mut y = area.y;
    let mut slots = Vec::new();
    for (slot, height) in panes.into_iter().zip(heights) {
        slots.push((slot, Rect { y, height, ..area }));
        y += height;
    }
    if law {
        slots.push((Slot::Law, Rect { y, height: spare, ..area }));
    }
    slots
}

/// Rows for the reasons of gauges that have no room beside their names.
fn rows_of_reasons(lab: &Lab, width: u16, glyphs: Glyphs) -> u16 {
    let gauges = lab.snapshot.as_ref().map_or(&[][..], |snapshot| &snapshot.gauges);
    // a frame, a mark and the columns at its edges
    let below = reasons_below(lab, gauges, width.saturating_sub(5), glyphs);
    below.iter().map(Vec::len).sum::<usize>() as u16
}

/// Rows for the meaning of the selected parameter: as many as the longest text needs, from two to four.
fn meaning(lab: &Lab, width: u16) -> u16 {
    let room = usize::from(width.saturating_sub(5));
    let info =
        (0..lab.count(ValueId::Parameter)).filter_map(|i| lab.value_info(ValueId::Parameter(i)));
    let longest = info.map(|info| words(&info.about, room).len() as u16).max();
    (longest.unwrap_or(0) + 1).clamp(2, 4)
}

/// As many plots as there is room for, in their order; those against time come last and have the wide slots, where
/// one of them replaces a phase portrait if there is none, and a section comes after the motion in space. If the motion
/// is in none of them although there is a view of it, that view replaces the last phase portrait, or else the last one that
/// is not against time; with room for three, it leaves (q, p) beside (Q, P) and replaces one against time or another map. Of the rest the plot that is focused, or was last, takes the last slot.
fn chosen(lab: &Lab, room: usize) -> Vec<Pane> {
    let mut shown = arranged(lab, room);
    // What was in the last slot stays there while another one has the focus.
    if let Some((last, others)) = shown.split_last_mut()
        && let Some(front) = lab.focused_before().find(|index| !others.contains(index))
    {
        *last = front;
    }
    shown.into_iter().map(Pane::Plot).collect()
}

/// The same whatever has the focus, or had it.
fn arranged(lab: &Lab, room: usize) -> Vec<usize> {
    let kind = |index: &usize| lab.plots[*index].kind.properties();
    let mut shown: Vec<usize> = (0..lab.plots.len().min(room)).collect();
    let against_time = (0..lab.plots.len()).find(|index| kind(index).is_over_time);
    if let (Some(time), Some(last)) = (against_time.filter(|t| *t >= room), shown.get_mut(2..))
        && let Some(last) = last.last_mut().filter(|last| is_portrait(kind(last)))
    {
        *last = time;
    }
    shown.sort_by_key(|index| kind(index).is_over_time);
    let is_motion = |index: &usize| lab.shows_motion(&lab.plots[*index]);
    if !shown.iter().any(is_motion)
        && let Some(motion) = view_of_motion(lab)
    {
        let last =
            |is: &dyn Fn(&Properties) -> bool| shown.iter().rposition(|index| is(kind(index)));
        let maps = shown.iter().filter(|index| kind(index).is_transformed()).count();
        let replaced = match (maps, shown.len()) {
            (0, _) | (_, ..=2) => last(&is_portrait),
            (1, _) => last(&|kind| kind.is_over_time),
            _ => last(&|kind| kind.is_over_time).or(last(&|kind| kind.is_transformed())),
        };
        let replaced = replaced.or(last(&|kind| !kind.is_over_time));
        if let Some(place) = replaced.or(shown.len().checked_sub(1)) {
            shown[place] = motion;
        }
    }
    // A cloud of points says nothing before what it is of has been seen moving.
    if let [first, second, ..] = &mut shown[..]
        && kind(first).is_section
        && kind(first).takes_seeds
        && lab.plots[*second].kind.properties().is_scene
    {
        std::mem::swap(first, second);
    }
    shown
}

/// Whether a picture is of a plane in which all that moves, moves along the horizontal.
fn is_level(plot: &Plot, lab: &Lab) -> bool {
    let (Some(eye), model) = (plot.eye(), &lab.loaded.model) else { return false };
    let is_constant = |e: Expr| {
        let symbols = model.pool.symbols_of(e).into_iter();
        symbols.map(|s| model.pool.symbol_info(s).rank).all(|rank| rank == Rank::Constant)
    };
    let is_level = |shape: &Shape| {
        !matches!(shape, Shape::Path { .. }) && shape.points().iter().all(|at| is_constant(at[1]))
    };
    eye.frame.is_none() && eye.is_plane(model) && eye.shapes(model).iter().all(is_level)
}

fn is_portrait(kind: &Properties) -> bool {
    kind.curve == Some(MotionCurve::Portrait)
}

/// The best view of the motion: a scene, or else a plane of places.
pub(super) fn view_of_motion(lab: &Lab) -> Option<usize> {
    let scene = lab.plots.iter().position(|plot| plot.kind.properties().is_scene);
    scene.or_else(|| lab.plots.iter().position(|plot| lab.shows_motion(plot)))
}

fn plot_slot(lab: &Lab) -> Slot {
    let focused = matches!(lab.focus.pane, Pane::Plot(_)).then_some(lab.focus.pane);
    // If there is room for one picture only, it is the scene.
    let motion = lab.plots.iter().position(|plot| plot.kind.properties().is_scene);
    // What was predicted stays beside its outcome.
    let predicted = lab
        .prediction
        .as_ref()
        .and_then(|prediction| lab.plots.iter().position(|plot| prediction.is_on(plot)));
    Slot::Pane(focused.unwrap_or(Pane::Plot(predicted.or(motion).unwrap_or(0))))
}

/// The list shown if there is room for only one.
fn list(lab: &Lab) -> Pane {
    if matches!(lab.focus.pane, Pane::Plot(_)) { Pane::Parameters } else { lab.focus.pane }
}

/// The list of values shown if there is room for only one.
fn values(lab: &Lab) -> Pane {
    match lab.focus.pane {
        Pane::Initial | Pane::Law => lab.focus.pane,
        _ => Pane::Parameters,
    }
}

/// Places panes side by side in equal widths.
fn side_by_side(area: Rect, panes: &[Pane]) -> Vec<(Slot, Rect)> {
    let count = panes.len().max(1) as u16;
    let edge = |i: u16| area.x + (u32::from(area.width) * u32::from(i) / u32::from(count)) as u16;
    let place = |(i, pane): (usize, &Pane)| {
        let i = i as u16;
        (Slot::Pane(*pane), Rect { x: edge(i), width: edge(i + 1) - edge(i), ..area })
    };
    panes.iter().enumerate().map(place).collect()
}

/// Splits off the first `width` columns.
pub(super) fn split_columns(area: Rect, width: u16) -> (Rect, Rect) {
    let width = width.min(area.width);
    let left = Rect { width, ..area };
    (left, Rect { x: left.right(), width: area.width - width, ..area })
}

/// Splits off the first `height` rows.
pub(super) fn split_rows(area: Rect, height: u16) -> (Rect, Rect) {
    let height = height.min(area.height);
    let above = Rect { height, ..area };
    (above, Rect { y: above.bottom(), height: area.height - height, ..area })
}
