//! What the mouse does: it selects, takes, drags, turns, zooms, and throws the motion to another beginning.
//!
//! In: an act, the spot it happened at. Out: the changed state and the effects. Never here: bytes, or where a spot is.

use super::change::place;
use super::hit_target::{Drag, HitTarget};
use super::mouse::Act;
use super::{Action, App, Effect, Lab, Overlay, Page, Pane, Plot, ValueId};
use crate::system::{ChannelKind, InitialOverride};

/// Lines of text or of a list that the wheel moves by.
const LINES: isize = 3;

/// A notch of the wheel magnifies by this much.
const NOTCH: f64 = 1.25;

impl App {
    /// Takes in what the mouse did.
    pub(super) fn point(&mut self, act: Act, spot: HitTarget) -> Vec<Effect> {
        match act {
            Act::Press => self.touch(spot),
            Act::Drag => self.drag(spot),
            Act::Release => self.let_go(spot),
            Act::WheelUp => self.wheel(spot, 1),
            Act::WheelDown => self.wheel(spot, -1),
        }
    }

    /// The mouse holds nothing any more, though no terminal said that its button came up.
    pub fn drop_hold(&mut self) {
        self.hold = None;
        if let Some(lab) = &mut self.lab {
            lab.history.end_group();
        }
    }

    fn touch(&mut self, spot: HitTarget) -> Vec<Effect> {
        self.drop_hold();
        match (&mut self.overlay, spot) {
            (_, HitTarget::Hint(action)) => return self.perform(action),
            (Some(Overlay::Menu(menu)), HitTarget::Line(line)) => {
                menu.selected = line;
                return self.perform(Action::Accept);
            }
            // Beside a list it closes; a text being typed is not given up by a slip of the hand.
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
        match spot {
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
                self.hold = Some(Drag::Bar(target));
                return self.pull(target, value);
            }
            HitTarget::Plot { index, place, .. } | HitTarget::Space { index, place } => {
                lab.focus = Pane::Plot(index);
                lab.history.begin_group();
                self.hold = Some(Drag::Picture { index, place, moved: false });
            }
            _ => {}
        }
        Vec::new()
    }

    fn drag(&mut self, spot: HitTarget) -> Vec<Effect> {
        match (self.hold, spot) {
            (Some(Drag::Bar(held)), HitTarget::Bar { target, value }) if held == target => {
                self.pull(target, value)
            }
            (
                Some(Drag::Picture { index: held, place: from, .. }),
                HitTarget::Plot { index, place, .. } | HitTarget::Space { index, place },
            ) if held == index && place != from => {
                self.hold = Some(Drag::Picture { index, place, moved: true });
                let by = [0, 1].map(|k| place[k] - from[k]);
                if let Some(lab) = &mut self.lab {
                    lab.redraw(index, |plot, _| plot.drag(by));
                }
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    fn let_go(&mut self, spot: HitTarget) -> Vec<Effect> {
        let held = self.hold.take();
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let effects = match (held, spot) {
            (Some(Drag::Picture { moved: false, .. }), HitTarget::Plot { index, place, at }) => {
                match lab.beginning_at(index, at) {
                    Some(_) if !lab.loaded.model.constraints.is_empty() => {
                        let why =
                            "Constraints tie the initial values together; type them one by one.";
                        return self.notify(why);
                    }
                    Some(given) => lab.start(&given),
                    None => {
                        lab.redraw(index, |plot, _| {
                            if let Some(viewport) = plot.viewport() {
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

    fn wheel(&mut self, spot: HitTarget, up: isize) -> Vec<Effect> {
        match (&mut self.overlay, spot) {
            (Some(Overlay::Menu(menu)), HitTarget::Menu | HitTarget::Line(_)) => menu.step(-up),
            (_, HitTarget::Text) => return self.jump(-up * LINES),
            (None, HitTarget::Systems | HitTarget::System(_)) => self.picker.step(-up),
            (None, spot) => {
                let Some(lab) = &mut self.lab else { return Vec::new() };
                let factor = if up > 0 { NOTCH } else { 1.0 / NOTCH };
                match spot {
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

    /// The knob of a value is where the mouse has it.
    fn pull(&mut self, target: ValueId, value: f64) -> Vec<Effect> {
        let Some(lab) = self.lab.as_mut().filter(|_| self.page == Page::Lab) else {
            return Vec::new();
        };
        let value = lab.rounded(target, value);
        lab.change(target, value)
    }
}

impl Lab {
    /// The initial values that a place in a plot stands for, if both its axes are of the state.
    fn beginning_at(&self, index: usize, at: [f64; 2]) -> Option<Vec<InitialOverride>> {
        let Plot::Phase { x, y, .. } = self.plots.get(index)? else { return None };
        let given =
            |channel: usize, value: f64| match self.loaded.system.channels().get(channel)?.kind {
                ChannelKind::Position(i) => Some(InitialOverride::Position(i, value)),
                ChannelKind::Velocity(i) => Some(InitialOverride::Velocity(i, value)),
                ChannelKind::Momentum(i) => Some(InitialOverride::Momentum(i, value)),
                _ => None,
            };
        let both = [given(*x, at[0])?, given(*y, at[1])?];
        (place(&both[0]) != place(&both[1])).then(|| both.to_vec())
    }
}
