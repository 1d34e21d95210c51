//! Hit testing: what lies under a position of the screen, for the mouse.
//!
//! In: the application, the render style, the area, a position. Out: a [`HitTarget`]. Areas are registered while they are
//! drawn, so the two cannot disagree. Never here: what a click does.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::canvas::Canvas;
use super::region::ScreenRegion;
use super::render_style::RenderStyle;
use super::screen::paint;
use crate::app::{App, Grab, HitTarget};

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
            (Some(Grab::Body { index, shape, .. }), ScreenRegion::Body(i, k, _)) => {
                (index, shape) == (*i, *k)
            }
            (
                Some(Grab::Picture { index, .. }),
                ScreenRegion::Plot(i, _) | ScreenRegion::Space(i),
            ) => index == *i,
            _ => false,
        };
        let found = match self.drag {
            Some(_) => self.regions.iter().find(|(_, region)| is_dragged(region)),
            None => self.regions.iter().rev().find(|(area, _)| area.contains(at)),
        };
        found.and_then(|(area, region)| resolved(*region, *area, at))
    }
}

/// The target of a region at a position, which may lie outside it.
fn resolved(region: ScreenRegion, area: Rect, at: Position) -> Option<HitTarget> {
    let middle = |at: u16, start: u16, length: u16| {
        (f64::from(at) - f64::from(start) + 0.5) / f64::from(length.max(1))
    };
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
        ScreenRegion::Body(index, shape, frame) => {
            let inside = frame.area;
            let place =
                [middle(at.x, inside.x, inside.width), 1.0 - middle(at.y, inside.y, inside.height)];
            HitTarget::Body { index, shape, place, at: frame.at(at) }
        }
        ScreenRegion::Plot(index, frame) => HitTarget::Plot { index, place, at: frame.at(at) },
    })
}
