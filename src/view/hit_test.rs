//! Spots: what lies under a place of the screen, for the mouse.
//!
//! In: the application, the look, the area, a place. Out: a [`HitTarget`]. What is drawn says where it stands while it is
//! drawn, so the two cannot disagree. Never here: what a click does.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::canvas::Canvas;
use super::plot::{Frame, Scale};
use super::{RenderStyle, paint};
use crate::app::{App, Drag, HitTarget, ValueId};

/// What something on the screen is for the mouse, told while it is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) enum Region {
    /// It hides what was there before.
    Blank,
    /// The same spot wherever it is touched.
    Plain(HitTarget),
    /// The bar of a value.
    Bar(ValueId, Scale),
    /// The inside of a plot's axes.
    Plot(usize, Frame),
    /// The inside of a picture of the motion in space.
    Space(usize),
}

/// All that a screen shows, to be asked by place.
#[derive(Clone, Debug)]
pub struct HitTest {
    /// What lies where; the later lies over the earlier.
    regions: Vec<(Rect, Region)>,
    hold: Option<Drag>,
}

/// What lies where on the screen of an application.
pub fn spots(app: &App, look: &RenderStyle, area: Rect) -> HitTest {
    let mut buffer = Buffer::empty(area);
    let mut canvas = Canvas { buffer: &mut buffer, look, regions: Some(Vec::new()), cursor: None };
    paint(&mut canvas, app, area);
    HitTest { regions: canvas.regions.unwrap_or_default(), hold: app.hold }
}

/// What lies at one place of it.
pub fn spot(app: &App, look: &RenderStyle, area: Rect, column: u16, row: u16) -> Option<HitTarget> {
    spots(app, look, area).at(column, row)
}

impl HitTest {
    /// What lies at a place; while the mouse holds something, that, wherever the mouse is.
    pub fn at(&self, column: u16, row: u16) -> Option<HitTarget> {
        let at = Position::new(column, row);
        let held = |region: &Region| match (self.hold, region) {
            (Some(Drag::Bar(held)), Region::Bar(target, _)) => held == *target,
            (Some(Drag::Picture { index, .. }), Region::Plot(i, _) | Region::Space(i)) => {
                index == *i
            }
            _ => false,
        };
        let found = match self.hold {
            Some(_) => self.regions.iter().find(|(_, region)| held(region)),
            None => self.regions.iter().rev().find(|(area, _)| area.contains(at)),
        };
        found.and_then(|(area, region)| resolved(*region, *area, at))
    }
}

/// The spot of a region at a place, which may be beside it.
fn resolved(region: Region, area: Rect, at: Position) -> Option<HitTarget> {
    let middle = |at: u16, start: u16, length: u16| {
        (f64::from(at) - f64::from(start) + 0.5) / f64::from(length.max(1))
    };
    let place = [middle(at.x, area.x, area.width), 1.0 - middle(at.y, area.y, area.height)];
    Some(match region {
        Region::Blank => return None,
        Region::Plain(spot) => spot,
        Region::Bar(target, scale) => {
            let along = f64::from(at.x) - f64::from(area.x);
            let share = along / f64::from(area.width.saturating_sub(1).max(1));
            HitTarget::Bar { target, value: scale.value(share.clamp(0.0, 1.0)) }
        }
        Region::Space(index) => HitTarget::Space { index, place },
        Region::Plot(index, frame) => HitTarget::Plot { index, place, at: frame.at(at) },
    })
}
