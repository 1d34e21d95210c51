//! Mouse input: it selects, clicks, drags, turns and zooms, and restarts the motion from another point.
//!
//! In: what the left button or the wheel did, and the hit target. Out: the changed state and the effects.
//! Never here: bytes, or hit testing.

use crossterm::event::{MouseButton, MouseEventKind};

use super::hit_target::{Grab, HitTarget};
use super::{Action, App, Effect, Lab, Overlay, Page, Pane, ValueId};
use crate::system::InitialOverride;

/// The number of lines of text or of a list per notch of the wheel.
const LINES: isize = 3;

/// The magnification per notch of the wheel.
const NOTCH: f64 = 1.25;

impl App {
    /// Handles a mouse event; only the left button and the wheel have an effect.
    pub(super) fn point(&mut self, kind: MouseEventKind, hit: HitTarget) -> Vec<Effect> {
        match kind {
            MouseEventKind::Down(MouseButton::Left) => self.touch(hit),
            MouseEventKind::Drag(MouseButton::Left) => self.drag(hit),
            MouseEventKind::Up(MouseButton::Left) => self.let_go(hit),
            MouseEventKind::ScrollUp => self.wheel(hit, 1),
            MouseEventKind::ScrollDown => self.wheel(hit, -1),
            _ => Vec::new(),
        }
    }

    /// Ends a drag, even if the terminal did not report the release of the button.
    pub fn drop_hold(&mut self) {
        self.hold = None;
        if let Some(lab) = &mut self.lab {
            lab.history.end_group();
        }
    }

    fn touch(&mut self, hit: HitTarget) -> Vec<Effect> {
        self.drop_hold();
        match (&mut self.overlay, hit) {
            (_, HitTarget::Hint(action)) => return self.perform(action),
            (Some(Overlay::Menu(menu)), HitTarget::Line(line)) => {
                menu.selected = line;
                return self.perform(Action::Accept);
            }
            // A click beside a list closes it; an accidental click does not discard text being typed.
            (Some(Overlay::Menu(_)), HitTarget::Menu)
            | (Some(Overlay::Field(_) | Overlay::Prompt(_)), _) => {}
            (Some(Overlay::Menu(_)), _) => return self.perform(Action::Back),
            (_, HitTarget::Page(page)) if self.lab.is_some() => self.go(page),
            (None, HitTarget::System(place)) => {
                if self.picker.selected == place {
                    return self.perform(Action::Open);
                }
                self.picker.point(place);
            }
            _ => {}
        }
        let (None, Some(lab)) = (&self.overlay, &mut self.lab) else { return Vec::new() };
        match hit {
            HitTarget::Pane(pane) => lab.focus = pane,
            HitTarget::Gauge(index) => (lab.focus, lab.selection.gauge) = (Pane::Gauges, index),
            HitTarget::Value(target) => {
                if lab.selected() == Some(target) {
                    return self.perform(Action::TypeValue);
                }
                lab.choose(target);
            }
            HitTarget::Bar { target, value } => {
                lab.choose(target);
                lab.history.begin_group();
                self.hold = Some(Grab::Bar(target));
                return self.pull(target, value);
            }
            HitTarget::Plot { index, place, .. } | HitTarget::Space { index, place } => {
                lab.focus = Pane::Plot(index);
                lab.history.begin_group();
                self.hold = Some(Grab::Picture { index, place, moved: false });
            }
            _ => {}
        }
        Vec::new()
    }

    fn drag(&mut self, hit: HitTarget) -> Vec<Effect> {
        match (self.hold, hit) {
            (Some(Grab::Bar(grabbed)), HitTarget::Bar { target, value }) if grabbed == target => {
                self.pull(target, value)
            }
            (
                Some(Grab::Picture { index: grabbed, place: from, .. }),
                HitTarget::Plot { index, place, .. } | HitTarget::Space { index, place },
            ) if grabbed == index && place != from => {
                self.hold = Some(Grab::Picture { index, place, moved: true });
                let by = [0, 1].map(|k| place[k] - from[k]);
                if let Some(lab) = &mut self.lab {
                    lab.redraw(index, |plot, _| plot.drag(by));
                }
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    fn let_go(&mut self, hit: HitTarget) -> Vec<Effect> {
        let grabbed = self.hold.take();
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let effects = match (grabbed, hit) {
            (Some(Grab::Picture { moved: false, .. }), HitTarget::Plot { index, place, at }) => {
                match lab.beginning_at(index, at) {
                    Some(_) if !lab.loaded.model.constraints.is_empty() => {
                        let why =
                            "Constraints tie the initial values together; type them one by one.";
                        return self.notify(why);
                    }
                    Some(given) => lab.start(&given),
                    None => {
                        lab.redraw(index, |plot, _| {
                            if let Some(viewport) = plot.viewport_mut() {
                                viewport.cursor = Some(place);
                            }
                        });
                        Vec::new()
                    }
                }
            }
            _ => Vec::new(),
        };
        if let Some(lab) = &mut self.lab {
            lab.history.end_group();
        }
        effects
    }

    fn wheel(&mut self, hit: HitTarget, up: isize) -> Vec<Effect> {
        match (&mut self.overlay, hit) {
            (Some(Overlay::Menu(menu)), HitTarget::Menu | HitTarget::Line(_)) => menu.step(-up),
            (_, HitTarget::Text) => return self.jump(-up * LINES),
            (None, HitTarget::Systems | HitTarget::System(_)) => self.picker.step(-up),
            (None, hit) => {
                let Some(lab) = &mut self.lab else { return Vec::new() };
                let factor = if up > 0 { NOTCH } else { 1.0 / NOTCH };
                match hit {
                    HitTarget::Plot { index, place, .. } | HitTarget::Space { index, place } => {
                        lab.redraw(index, |plot, _| plot.zoom_about(factor, place));
                    }
                    HitTarget::Value(target) | HitTarget::Bar { target, .. } => {
                        lab.focus = match target {
                            ValueId::Parameter(_) => Pane::Parameters,
                            ValueId::Initial(_) => Pane::Initial,
                        };
                        lab.select(|place| place.saturating_add_signed(-up));
                    }
                    HitTarget::Gauge(_) => {
                        lab.focus = Pane::Gauges;
                        lab.select(|place| place.saturating_add_signed(-up));
                    }
                    _ => {}
                }
            }
            _ => {}
        }
        Vec::new()
    }

    /// Sets a value to the position of its knob under the mouse.
    fn pull(&mut self, target: ValueId, value: f64) -> Vec<Effect> {
        let Some(lab) = self.lab.as_mut().filter(|_| self.page == Page::Lab) else {
            return Vec::new();
        };
        let value = lab.rounded(target, value);
        lab.change(target, value)
    }
}

impl Lab {
    /// Returns the initial values that a point of a plot represents, if it does represent some.
    fn beginning_at(&self, index: usize, at: [f64; 2]) -> Option<[InitialOverride; 2]> {
        let plot = self.plots.get(index)?;
        plot.kind.start(plot, self.loaded.physics(), at)
    }
}
