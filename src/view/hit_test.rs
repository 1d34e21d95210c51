//! Hit testing: what lies under a position of the screen, for the mouse.
//!
//! In: the application, the render style, the area, a position. Out: a [`HitTarget`]. Areas are registered while they are
//! drawn, so the two cannot disagree. Never here: what a click does.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::canvas::Canvas;
use super::plot::{PlotFrame, Scale};
use super::region::ScreenRegion;
use super::render_style::RenderStyle;
use super::screen::paint;
use crate::app::{App, DragWindow, Grab, HitTarget};

/// The regions of a screen.
#[derive(Clone, Debug)]
pub struct HitMap {
    /// The regions; later ones lie over earlier ones.
    regions: Vec<(Rect, ScreenRegion)>,
    drag: Option<Grab>,
}

/// Collects the regions of an application's screen.
pub fn hit_targets(app: &App, style: &RenderStyle, area: Rect) -> HitMap {
    let mut buffer = Buffer::empty(area);
    let mut canvas = Canvas::over(&mut buffer, style);
    canvas.regions = Some(Vec::new());
    paint(&mut canvas, app, area);
    HitMap { regions: canvas.regions.unwrap_or_default(), drag: app.mouse.drag }
}

/// Returns what lies at one position of the screen.
pub fn hit_test(
    app: &App,
    style: &RenderStyle,
    area: Rect,
    column: u16,
    row: u16,
) -> Option<HitTarget> {
    hit_targets(app, style, area).at(column, row)
}

impl HitMap {
    /// Returns what lies at a position; during a drag, that is the dragged item wherever the mouse is.
    pub fn at(&self, column: u16, row: u16) -> Option<HitTarget> {
        let at = Position::new(column, row);
        let is_dragged = |region: &ScreenRegion| match (self.drag, region) {
            (Some(Grab::Bar(dragged)), ScreenRegion::Bar(target, _)) => dragged == *target,
            (Some(Grab::Time), ScreenRegion::Time(_)) => true,
            (
                Some(Grab::Picture { index, .. }),
                ScreenRegion::Plot(i, _) | ScreenRegion::Space(i),
            ) => index == *i,
            _ => false,
        };
        if let Some(Grab::Mass { index, shape, window, .. }) = self.drag {
            return Some(dragged_mass(index, shape, window, at));
        }
        let found = match self.drag {
            Some(_) => self.regions.iter().find(|(_, region)| is_dragged(region)),
            None => self.regions.iter().rev().find(|(area, _)| area.contains(at)),
        };
        found.and_then(|(area, region)| resolved(*region, *area, at))
    }
}

/// A mass that is dragged to a position, in the window in which it was grabbed; beyond it, to the nearest position in it.
fn dragged_mass(index: usize, shape: usize, window: DragWindow, at: Position) -> HitTarget {
    let ([[left, right], [low, high]], [x, y]) = (window.ranges, window.corner);
    let [wide, tall] = window.cells;
    let area = Rect::new(x, y, wide, tall);
    let frame = PlotFrame::new(Scale::linear(left, right), Scale::linear(low, high), area);
    let inside = |at: u16, start: u16, count: u16| {
        at.clamp(start, start.saturating_add(count.saturating_sub(1)))
    };
    mass(index, shape, &frame, Position::new(inside(at.x, x, wide), inside(at.y, y, tall)))
}

fn mass(index: usize, shape: usize, frame: &PlotFrame, at: Position) -> HitTarget {
    let Rect { x, y, width, height } = frame.area;
    let place = [middle(at.x, x, width), 1.0 - middle(at.y, y, height)];
    let window = DragWindow {
        ranges: [frame.x, frame.y].map(|scale| [scale.lo, scale.hi]),
        corner: [x, y],
        cells: [width, height],
    };
    HitTarget::Mass { index, shape, place, at: frame.at(at), window }
}

/// The share of a length at which the middle of a cell is.
fn middle(at: u16, start: u16, length: u16) -> f64 {
    (f64::from(at) - f64::from(start) + 0.5) / f64::from(length.max(1))
}

/// The target of a region at a position, which may lie outside it.
fn resolved(region: ScreenRegion, area: Rect, at: Position) -> Option<HitTarget> {
    let place = [middle(at.x, area.x, area.width), 1.0 - middle(at.y, area.y, area.height)];
    Some(match region {
        ScreenRegion::Blank => return None,
        ScreenRegion::Plain(target) => target,
        ScreenRegion::Bar(target, scale) => {
            let along = f64::from(at.x) - f64::from(area.x);
            let share = along / f64::from(area.width.saturating_sub(1).max(1));
            HitTarget::Bar { target, value: scale.value(share.clamp(0.0, 1.0)) }
        }
        ScreenRegion::Time([from, to]) => {
            let along = f64::from(at.x) - f64::from(area.x);
            let share = (along / f64::from(area.width.saturating_sub(1).max(1))).clamp(0.0, 1.0);
            // both ends are met exactly
            HitTarget::Time(if share < 1.0 { from + share * (to - from) } else { to })
        }
        ScreenRegion::Space(index) => HitTarget::Space { index, place },
        ScreenRegion::Mass(index, shape, frame) => mass(index, shape, &frame, at),
        ScreenRegion::Plot(index, frame) => HitTarget::Plot { index, place, at: frame.at(at) },
    })
}
