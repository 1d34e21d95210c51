//! What is written and drawn beside the picture in space: the directions of the axes, the names of apparent forces and of
//! two mechanics side by side.
//!
//! In: the camera, the forces present, names beside points. Out: cells. Never here: the shapes.

use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use unicode_width::UnicodeWidthStr;

use crate::view::canvas::Canvas;
use crate::view::layout::split_rows;
use crate::view::plot::{Camera, Pen, PlotFrame, Raster, Scale};
use crate::view::theme::Role;

/// The apparent forces, in the order of their colours.
pub(super) const FORCES: [&str; 4] = ["centrifugal", "Coriolis", "Euler", "of the origin"];

/// Draws the directions of the axes in the lower left corner, each as an arm with its name.
pub(super) fn compass(canvas: &mut Canvas<'_>, area: Rect, camera: &Camera) {
    let (width, height) = match area.height {
        _ if area.width < 30 => return,
        0..9 => return,
        // a low picture leaves the room at its sides
        9..14 => (10, 5),
        _ => (12, 6),
    };
    let corner = Rect { x: area.x + 1, y: area.bottom() - height, width, height };
    let axes = [("x", [1.0, 0.0, 0.0]), ("y", [0.0, 1.0, 0.0]), ("z", [0.0, 0.0, 1.0])];
    let tips = axes.map(|(name, axis)| {
        let [right, up, _] = camera.project(axis);
        (name, [right, up])
    });
    // Where no arm points to the left or down, the place where they meet is the corner itself.
    let reach = |k: usize| {
        let least = tips.iter().map(|(_, tip)| tip[k]).fold(0.0, f64::min);
        Scale::linear(least - 0.1, least + 2.5)
    };
    let frame = PlotFrame::equal(reach(0), reach(1), corner);
    let mut arms = Raster::new(corner, canvas.style.glyphs);
    let pen = Pen::new(canvas.style(Role::Dim), 0);
    for (_, tip) in tips {
        arms.line(&frame, [0.0; 2], tip.map(|v| 0.7 * v), &pen);
    }
    arms.draw(canvas.buffer);
    // the longest arm first: a short one, which points at who looks, has its name beside the others
    let mut tips = tips;
    let length = |[right, up]: [f64; 2]| right * right + up * up;
    tips.sort_by(|(_, one), (_, other)| length(*other).total_cmp(&length(*one)));
    let mut written: Vec<Position> = Vec::new();
    for (name, tip) in tips {
        let Some(tip) = frame.cell(tip) else { continue };
        let around = BESIDE.map(|(right, down)| {
            let at = (i32::from(tip.x) + right, i32::from(tip.y) + down);
            Position::new(at.0.max(0) as u16, at.1.max(0) as u16)
        });
        let is_free = |at: &Position| {
            let apart = |other: &Position| other.y != at.y || other.x.abs_diff(at.x) > 1;
            corner.contains(*at) && written.iter().all(apart)
        };
        if let Some(at) = around.into_iter().find(is_free) {
            canvas.write(at, 1, name, canvas.style(Role::Dim));
            written.push(at);
        }
    }
}

/// Where the name of an arm may stand, from its tip in columns to the right and rows down, best first.
const BESIDE: [(i32, i32); 7] = [(0, 0), (2, 0), (0, 1), (0, -1), (-2, 0), (2, 1), (2, -1)];

pub(super) struct Label {
    /// The point in the coordinates of the picture.
    pub(super) tip: [f64; 2],
    /// Whether the name ends at the point: it stands away from the arrow that it belongs to.
    pub(super) leftwards: bool,
    /// Whether it names a body about the point, which it is to leave visible.
    pub(super) apart: bool,
    pub(super) text: String,
    pub(super) style: Style,
}

/// Writes names beside their points. Where there is no room on one side the name is above the point, and ends at the edge.
/// No name is written over another: it goes to the other side, or a row or two above or below, nor over a mark, if there is a
/// place beside it. A name for which there is no room at all is left out. Returns the cells of each that is written.
pub(super) fn labels(
    canvas: &mut Canvas<'_>,
    area: Rect,
    frame: &PlotFrame,
    labels: &[Label],
    is_mark: impl Fn(Position) -> bool,
) -> Vec<Rect> {
    let mut written: Vec<Rect> = Vec::new();
    for label in labels {
        let Some(at) = frame.cell(label.tip) else { continue };
        let free = |place: &Rect| {
            // a blank keeps two names in one row apart
            let apart = Rect { x: place.x.saturating_sub(1), width: place.width + 2, ..*place };
            written.iter().all(|other| !other.intersects(apart))
        };
        let blank = |place: &Rect| {
            place.positions().all(|cell| canvas.buffer[cell].symbol().trim().is_empty())
        };
        let apart = if label.apart { places_apart(at, label, area) } else { Vec::new() };
        let apart = apart.into_iter().find(|place| free(place) && blank(place));
        let uncovered = |place: &Rect| !place.positions().any(&is_mark);
        let all = places(at, label, area);
        let beside = all.iter().find(|place| free(place) && uncovered(place));
        let place =
            apart.or_else(|| beside.or_else(|| all.iter().find(|place| free(place))).copied());
        let Some(place) = place else { continue };
        canvas.write(place.as_position(), place.width, &label.text, label.style);
        written.push(place);
    }
    written
}

/// Where a name may stand, best first.
fn places(at: Position, label: &Label, area: Rect) -> Vec<Rect> {
    let width = (label.text.width() as u16).min(area.width);
    let right = Some(at.x + 1).filter(|x| x + width <= area.right());
    let left = Some(at.x).filter(|x| *x >= area.x + width).map(|x| x - width);
    let last = area.right() - width;
    // Without room on its own side a name stands above the point rather than on the wrong side of an arrow's tip.
    let [first, second] = if label.leftwards { [left.or(right), right] } else { [right, left] };
    let second = second.filter(|_| first.is_some());
    let beside = first.into_iter().chain(second).map(|x| (x, 0));
    let elsewhere = [-1, 1, -2, 2].map(|rows| (first.unwrap_or(last), rows));
    let all = beside.chain(elsewhere);
    let rows = i32::from(area.y)..i32::from(area.bottom());
    all.filter_map(|(x, down)| {
        let y = i32::from(at.y) + down;
        rows.contains(&y).then_some(Rect { x, y: y as u16, width, height: 1 })
    })
    .collect()
}

/// Where the name of a body may stand so that it covers nothing of it, nearest first.
fn places_apart(at: Position, label: &Label, area: Rect) -> Vec<Rect> {
    let width = label.text.width() as u16;
    let beside = |columns: i32| {
        [i32::from(at.x) + columns, i32::from(at.x) - columns - i32::from(width) + 1]
    };
    let near = (1..=FARTHEST).flat_map(|far| {
        let rows = (0..=far / 2).flat_map(|down| [down, -down]);
        rows.flat_map(move |down| beside(far).map(|x| (x, i32::from(at.y) + down)))
    });
    near.filter(|(x, y)| {
        (i32::from(area.x)..=i32::from(area.right()) - i32::from(width)).contains(x)
            && (i32::from(area.y)..i32::from(area.bottom())).contains(y)
    })
    .map(|(x, y)| Rect { x: x as u16, y: y as u16, width, height: 1 })
    .collect()
}

/// How many columns from its point the name of a body may stand.
const FARTHEST: i32 = 10;

/// A line of a legend: its sign and name, and the curve whose colour it has.
pub(super) type LegendLine = (String, usize);

/// The names of these apparent forces.
pub(super) fn forces(canvas: &Canvas<'_>, forces: &[usize]) -> Vec<LegendLine> {
    let arrow = canvas.style.glyphs.pick("→", "->");
    forces.iter().map(|&force| (format!("{arrow} {}", FORCES[force]), force + 1)).collect()
}

/// The names of the right mechanics and of the wrong one beside it, whose traces have these colours.
pub(super) fn mechanics(canvas: &Canvas<'_>, [right, wrong]: [usize; 2]) -> Vec<LegendLine> {
    let sign = canvas.style.glyphs.pick("━", "-");
    vec![(format!("{sign} right mechanics"), right), (format!("{sign} wrong mechanics"), wrong)]
}

/// Parts an area into one for the lines of a legend, side by side as far as they have room, and one for the picture below, of which
/// they cover nothing. A small picture has no legend.
pub(super) fn legend_above(area: Rect, lines: &[LegendLine]) -> (Rect, Rect) {
    if lines.is_empty() || area.width < 24 || area.height < 8 {
        return split_rows(area, 0);
    }
    let rows = legend_places(area, lines).map(Rect::bottom).max().unwrap_or(area.y);
    split_rows(area, rows - area.y)
}

pub(super) fn legend(canvas: &mut Canvas<'_>, area: Rect, lines: &[LegendLine]) {
    for (place, (text, curve)) in legend_places(area, lines).zip(lines) {
        if area.contains(place.as_position()) {
            let style = canvas.style.theme.curve(*curve);
            canvas.write(place.as_position(), place.width, text, style);
        }
    }
}

/// The blanks between two lines of a legend in one row.
const APART: u16 = 2;

/// Where each line of a legend stands: beside the one before it, or where it has no room there below it.
fn legend_places(area: Rect, lines: &[LegendLine]) -> impl Iterator<Item = Rect> {
    lines.iter().scan((area.x, area.y), move |(x, y), (text, _)| {
        let width = (text.width() as u16).min(area.width);
        if *x > area.x && *x + width > area.right() {
            (*x, *y) = (area.x, *y + 1);
        }
        let place = Rect { x: *x, y: *y, width, height: 1 };
        *x += width + APART;
        Some(place)
    })
}

#[cfg(test)]
mod tests {
    use ratatui::buffer::Buffer;

    use super::*;
    use crate::view::RenderStyle;
    use crate::view::colour::ColourDepth;
    use crate::view::glyphs::Glyphs;
    use crate::view::theme::Theme;

    /// The Earth beside the Moon: a name leaves the mark of the other body free, if it has another place.
    #[test]
    fn no_name_is_written_over_a_mark() {
        let style = RenderStyle { theme: Theme::dark(ColourDepth::None), glyphs: Glyphs::Ascii };
        let area = Rect::new(0, 0, 30, 9);
        let frame = PlotFrame::equal(Scale::linear(-1.0, 1.0), Scale::linear(-1.0, 1.0), area);
        let at = frame.cell([0.0; 2]).expect("a cell");
        let label = || Label {
            tip: [0.0; 2],
            leftwards: false,
            apart: false,
            text: "Earth".to_owned(),
            style: Style::new(),
        };
        let place = |is_mark: &dyn Fn(Position) -> bool| {
            let mut buffer = Buffer::empty(area);
            let mut canvas = Canvas::over(&mut buffer, &style);
            labels(&mut canvas, area, &frame, &[label()], is_mark)[0]
        };
        let moon = Position::new(at.x + 3, at.y);
        assert!(place(&|_| false).contains(moon));
        let beside = place(&|cell| cell == moon);
        assert!(!beside.contains(moon) && beside.y == at.y, "{beside:?}");
        assert!(place(&|_| true).contains(moon), "over all of them rather than nowhere");
    }

    /// The name of a body stands beside its cells, and over them only where nothing else is left.
    #[test]
    fn the_name_of_a_body_covers_nothing_of_it() {
        let style = RenderStyle { theme: Theme::dark(ColourDepth::None), glyphs: Glyphs::Ascii };
        let area = Rect::new(0, 0, 30, 9);
        let frame = PlotFrame::equal(Scale::linear(-1.0, 1.0), Scale::linear(-1.0, 1.0), area);
        let at = frame.cell([0.0; 2]).expect("a cell");
        for (body, covered) in [(Rect::new(at.x - 2, at.y - 1, 6, 3), 0), (area, 5)] {
            let mut buffer = Buffer::empty(area);
            for cell in body.positions() {
                buffer[cell].set_char('#');
            }
            let all = body.area() as usize;
            let mut canvas = Canvas::over(&mut buffer, &style);
            let label = Label {
                tip: [0.0; 2],
                leftwards: false,
                apart: true,
                text: "right".to_owned(),
                style: Style::new(),
            };
            let written = labels(&mut canvas, area, &frame, &[label], |_| false);
            assert_eq!(written.len(), 1);
            let left = area.positions().filter(|cell| buffer[*cell].symbol() == "#").count();
            assert_eq!(all - left, covered, "{buffer:?}");
        }
    }
}
