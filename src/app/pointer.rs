//! Pointing: the mouse selects, clicks, drags, turns and zooms, and restarts the motion from another point; so does the
//! cursor of a plot, where orbits are added to a section too.
//!
//! In: what the left button or the wheel did, and the hit target; the coordinates of the cursor, as the last drawing
//! found them. Out: the changed state and the effects.
//! Never here: bytes, or hit testing.

use std::f64::consts::FRAC_PI_2;

use crossterm::event::{MouseButton, MouseEventKind};

use super::hit_target::{Grab, HitTarget};
use super::{Action, App, Effect, InputField, Lab, Notification, Overlay, Page, Pane, ValueId};
use crate::experiment::{Command, Status};
use crate::instrument::{Answer, NoStart, Plot, PlotContext, Present, Sight, StartValues};
use crate::model::Model;

/// The number of lines of text or of a list per notch of the wheel.
const LINES: isize = 3;

/// The magnification per notch of the wheel.
const NOTCH: f64 = 1.25;

/// Why orbits are not added to a section.
const NO_STARTS: &str = "No orbits can be added here: points of this section cannot be starts.";
const NO_MORE: &str = "No more orbits can be added; N removes those added.";

/// Why a picture in a plane does not turn under the mouse.
const PLANE: &str = "This motion stays in a plane and is seen face on; to start elsewhere, click in a phase portrait.";
const PLANE_OF_MASSES: &str = "This motion stays in a plane and is seen face on; to start elsewhere, drag a mass, or click in a phase portrait.";

/// Whether a picture is of a motion in a plane, seen face on.
fn is_face_on(plot: &Plot, model: &Model) -> bool {
    matches!(plot.sight, Sight::Camera(eye) if eye.is_plane(model) && eye.pitch == FRAC_PI_2)
}

impl App {
    /// Handles a mouse event; the left button and the wheel have an effect, and the right button, which Shift makes of the
    /// left one, adds a motion.
    pub(super) fn point(&mut self, kind: MouseEventKind, hit: HitTarget) -> Vec<Effect> {
        match kind {
            MouseEventKind::Down(MouseButton::Left) => self.touch(hit),
            MouseEventKind::Drag(MouseButton::Left) => self.drag(hit),
            MouseEventKind::Up(MouseButton::Left) => self.let_go(hit),
            MouseEventKind::Up(MouseButton::Right) => self.add_start(hit),
            MouseEventKind::ScrollUp => self.wheel(hit, 1),
            MouseEventKind::ScrollDown => self.wheel(hit, -1),
            _ => Vec::new(),
        }
    }

    /// Ends a drag, even if the terminal did not report the release of the button. A motion that was paused by it runs again.
    pub fn end_group(&mut self) {
        self.end_drag();
        if let Some(lab) = &mut self.lab {
            lab.history.end_group();
        }
    }

    fn end_drag(&mut self) {
        if let Some(Grab::Mass { moved: true, resumes, .. }) = self.mouse.drag.take() {
            self.mouse.resumes = resumes;
        }
    }

    fn touch(&mut self, hit: HitTarget) -> Vec<Effect> {
        self.end_group();
        // nothing has been typed in this field yet: the click closes it and does what it does without it
        let untyped = |field: &InputField| field.whole || field.input.value().is_empty();
        if let (Some(Overlay::Field(field)), false) =
            (&self.overlay, matches!(hit, HitTarget::Hint(_)))
            && untyped(field)
        {
            self.overlay = None;
        }
        match (&mut self.overlay, hit) {
            (_, HitTarget::Hint(action)) => return self.handle_action(action),
            (Some(Overlay::Menu(menu)), HitTarget::Line(line)) => {
                menu.selected = line;
                return self.handle_action(Action::Accept);
            }
            // A click beside a list closes it; an accidental click does not discard text being typed.
            (Some(Overlay::Menu(_)), HitTarget::Menu)
            | (Some(Overlay::Field(_) | Overlay::Prompt(_)), _) => {}
            (Some(Overlay::Menu(_)), _) => return self.handle_action(Action::Back),
            (_, HitTarget::Page(page)) if self.lab.is_some() => self.go(page),
            (None, HitTarget::System(place)) => {
                if self.picker.is_selected(place) {
                    return self.handle_action(Action::Open);
                }
                self.picker.point(place);
            }
            (None, HitTarget::Above(row)) => {
                if self.picker.selected_above() == Some(row) {
                    return self.handle_action(Action::Open);
                }
                self.picker.point_above(row);
            }
            _ => {}
        }
        let (None, Some(lab)) = (&self.overlay, &mut self.lab) else { return Vec::new() };
        match hit {
            HitTarget::Pane(pane) => lab.focus.pane = pane,
            HitTarget::Gauge(index) => {
                (lab.focus.pane, lab.selection.gauge) = (Pane::Gauges, index);
            }
            HitTarget::Value(target) => {
                if lab.selected() == Some(target) {
                    return self.handle_action(Action::TypeValue);
                }
                lab.choose(target);
            }
            HitTarget::Bar { target, value } => {
                lab.choose(target);
                lab.history.begin_group();
                self.mouse.drag = Some(Grab::Bar(target));
                return self.pull(target, value);
            }
            HitTarget::Time(time) => {
                self.mouse.drag = Some(Grab::Time);
                return vec![Effect::Execute(Command::ScrubTo(time))];
            }
            HitTarget::Mass { index, shape, window, .. } => {
                lab.focus.pane = Pane::Plot(index);
                lab.history.begin_group();
                let resumes = lab.seen().is_some_and(|seen| seen.status != Status::Paused);
                let eye = lab.plots.get(index).and_then(Plot::eye);
                if let Some(Err(why)) = eye.map(|eye| lab.take_mass(eye, shape)) {
                    return self.notify(why);
                }
                let grab = Grab::Mass { index, shape, window, resumes, moved: false };
                self.mouse.drag = Some(grab);
            }
            HitTarget::Plot { index, place, .. } | HitTarget::Space { index, place } => {
                lab.focus.pane = Pane::Plot(index);
                lab.history.begin_group();
                self.mouse.drag = Some(Grab::Picture { index, place, moved: false });
            }
            _ => {}
        }
        Vec::new()
    }

    fn drag(&mut self, hit: HitTarget) -> Vec<Effect> {
        match (self.mouse.drag, hit) {
            (Some(Grab::Bar(grabbed)), HitTarget::Bar { target, value }) if grabbed == target => {
                self.pull(target, value)
            }
            (Some(Grab::Time), HitTarget::Time(time)) => {
                vec![Effect::Execute(Command::ScrubTo(time))]
            }
            (
                Some(Grab::Mass { index, shape, window, resumes, moved }),
                HitTarget::Mass { at, .. },
            ) => {
                let Some(lab) = &mut self.lab else { return Vec::new() };
                let Some(values) = lab.dragged_to(at) else { return Vec::new() };
                self.mouse.drag = Some(Grab::Mass { index, shape, window, resumes, moved: true });
                if moved {
                    return lab.start_in_window(&values, lab.earlier_window.clone());
                }
                // what is dragged does not move by itself
                let mut effects = vec![Effect::Execute(Command::Pause)];
                effects.extend(match lab.plots.get(index).and_then(Plot::eye) {
                    Some(eye) => lab.start_drag(&values, (eye, window.ranges)),
                    None => lab.start(&values),
                });
                effects
            }
            (
                Some(Grab::Picture { index: grabbed, place: from, .. }),
                HitTarget::Plot { index, place, .. } | HitTarget::Space { index, place },
            ) if grabbed == index && place != from => {
                self.mouse.drag = Some(Grab::Picture { index, place, moved: true });
                let by = [0, 1].map(|k| place[k] - from[k]);
                let Some(lab) = &mut self.lab else { return Vec::new() };
                if lab.plots.get(index).is_some_and(|plot| is_face_on(plot, &lab.loaded.model)) {
                    let mut slid = false;
                    lab.redraw(index, |plot, _| slid = plot.slide(by));
                    if !slid {
                        let eye = lab.plots.get(index).and_then(Plot::eye);
                        let of_masses = eye.is_some_and(|eye| lab.has_draggable_mass(eye));
                        let text = if of_masses { PLANE_OF_MASSES } else { PLANE };
                        self.notifications.show(Notification::info(text));
                    }
                    return Vec::new();
                }
                lab.redraw(index, |plot, _| plot.drag(by));
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    fn let_go(&mut self, hit: HitTarget) -> Vec<Effect> {
        let grabbed = self.mouse.drag;
        self.end_drag();
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let effects = match (grabbed, hit) {
            (Some(Grab::Picture { moved: false, .. }), HitTarget::Plot { index, place, at }) => {
                match lab.begun_at(index, at) {
                    Ok(effects) => effects,
                    Err(NoStart::Refused(why)) => {
                        lab.history.end_group();
                        return self.fail(why);
                    }
                    Err(NoStart::Nothing) => {
                        lab.redraw(index, |plot, _| {
                            if let Some(viewport) = plot.viewport_mut() {
                                viewport.put_cursor(Some(place));
                            }
                        });
                        Vec::new()
                    }
                }
            }
            (Some(Grab::Mass { moved: true, .. }), _) => match lab.release_mass() {
                Some(values) => lab.start_in_window(&values, lab.earlier_window.clone()),
                None => Vec::new(),
            },
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
            (None, HitTarget::Systems | HitTarget::System(_) | HitTarget::Above(_)) => {
                self.picker.step(-up);
            }
            (None, HitTarget::Pane(Pane::Law)) => {
                if let Some(lab) = &mut self.lab {
                    lab.roll_law(-up * LINES);
                }
            }
            (None, hit) => {
                let Some(lab) = &mut self.lab else { return Vec::new() };
                let factor = if up > 0 { NOTCH } else { 1.0 / NOTCH };
                match hit {
                    HitTarget::Plot { index, place, .. }
                    | HitTarget::Space { index, place }
                    | HitTarget::Mass { index, place, .. } => {
                        lab.redraw(index, |plot, _| plot.zoom_about(factor, [true; 2], place));
                    }
                    HitTarget::Value(target) | HitTarget::Bar { target, .. } => {
                        lab.focus.pane = match target {
                            ValueId::Parameter(_) => Pane::Parameters,
                            ValueId::Initial(_) => Pane::Initial,
                        };
                        lab.select(|place| place.saturating_add_signed(-up));
                    }
                    HitTarget::Gauge(_) => {
                        lab.focus.pane = Pane::Gauges;
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

/// What keys do at the cursor of a plot, and on a section.
impl App {
    /// Keeps the cursor of the focused plot at the coordinates at which it was drawn.
    pub(super) fn fix_cursor(&mut self) {
        let (Some(at), Some(place)) = (self.drawn.reading, self.drawn.cursor_place) else { return };
        let Some(lab) = &mut self.lab else { return };
        let Some((index, _)) = lab.focused_plot() else { return };
        let viewport = lab.plots.get_mut(index).and_then(Plot::viewport_mut);
        if let Some(viewport) = viewport.filter(|viewport| viewport.cursor.is_some()) {
            (viewport.cursor, viewport.cursor_at) = (Some(place), Some(at));
        }
    }

    /// Begins the motion at the cursor of the focused plot. Without a cursor, chooses what the plot shows.
    pub(super) fn start_here(&mut self) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let Some((index, _)) = lab.focused_plot() else { return Vec::new() };
        let reading = self.drawn.reading.filter(|_| lab.has_cursor());
        let Some(at) = reading else { return self.open_axes() };
        match lab.begun_at(index, at) {
            Ok(effects) => effects,
            Err(NoStart::Refused(why)) => self.fail(why),
            Err(NoStart::Nothing) => self.notify(
                "No motion can start from a point of this plot: that takes a coordinate and its rate, or a section.",
            ),
        }
    }

    pub(super) fn add_orbits(&mut self) -> Vec<Effect> {
        let reading = self.drawn.reading;
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let Some((index, plot)) = lab.focused_plot() else { return Vec::new() };
        if !plot.kind.properties().takes_seeds {
            return self
                .notify("n adds orbits to a section, or restarts an ensemble; v chooses one.");
        }
        let cursor = plot.viewport().and_then(|viewport| viewport.cursor);
        let through = reading.filter(|_| cursor.is_some());
        if let Some(at) = through
            && let Err(NoStart::Refused(why)) = lab.beginning_at(index, at)
        {
            return self.fail(why);
        }
        self.seed(|plot, present, answer| plot.add_orbits(present, answer, through))
    }

    /// Adds orbits to the focused plot; `add` returns whether there are any.
    fn seed(
        &mut self,
        add: impl FnOnce(&mut Plot, &Present<'_>, Option<&Answer>) -> bool,
    ) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let Some((index, plot)) = lab.focused_plot() else { return Vec::new() };
        let mut changed = plot.clone();
        let present = lab.present();
        if !present.is_some_and(|present| add(&mut changed, &present, lab.answer(plot))) {
            let why = if plot.seeds.is_empty() { NO_STARTS } else { NO_MORE };
            return self.fail(why);
        }
        lab.redraw(index, |plot, _| *plot = changed);
        Vec::new()
    }

    pub(super) fn fill_section(&mut self) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let Some((_, plot)) = lab.focused_plot() else { return Vec::new() };
        if !(plot.kind.properties().is_section && plot.kind.properties().takes_seeds) {
            return self.notify("G fills a section with orbits; v chooses one.");
        }
        self.seed(Plot::fill)
    }

    /// Removes the orbits that were added to the focused section, and the past crossings of the motion.
    pub(super) fn clear_orbits(&mut self) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let Some((index, plot)) = lab.focused_plot() else { return Vec::new() };
        if !plot.kind.properties().takes_seeds {
            return self.notify("Only a section has orbits and crossings to clear.");
        }
        let section = plot.kind.properties().is_section;
        lab.redraw(index, |plot, _| plot.seeds.clear());
        if !section {
            return Vec::new();
        }
        vec![Effect::Execute(Command::ForgetCrossings)]
    }
}

impl Lab {
    /// Begins the motion at a point of a plot, or sets the values that the point stands for.
    fn begun_at(&mut self, index: usize, at: [f64; 2]) -> Result<Vec<Effect>, NoStart> {
        let given = self.beginning_at(index, at);
        if let Err(NoStart::Refused(_)) = given {
            return given.map(|_| Vec::new());
        }
        let parameters = self.plots.get(index).map(|plot| plot.kind.parameters_at(plot, at));
        let parameters = parameters.unwrap_or_default();
        let mut effects = Vec::new();
        for &(parameter, value) in &parameters {
            let target = ValueId::Parameter(parameter);
            let value = self.rounded(target, value);
            effects.extend(self.change(target, value));
        }
        match given {
            Ok(given) => effects.extend(self.start(&given)),
            Err(why) if parameters.is_empty() => return Err(why),
            Err(_) => {}
        }
        Ok(effects)
    }

    /// Returns the initial values that a point of a plot represents, or why it represents none.
    pub(super) fn beginning_at(&self, index: usize, at: [f64; 2]) -> StartValues {
        let (Some(plot), Some(present)) = (self.plots.get(index), self.present()) else {
            return Err(NoStart::Nothing);
        };
        let given = plot.kind.start(PlotContext { plot, present: &present, answer: None }, at)?;
        if self.loaded.model.constraints.is_empty() {
            return Ok(self.as_listed(given));
        }
        let why = "Constraints tie the initial values together; type them one by one.";
        Err(NoStart::Refused(why.to_owned()))
    }
}
