//! The laboratory: one loaded system, its snapshots, and the selection.
//!
//! In: a loaded system and its snapshots. Out: the state of the panes, and commands for changed values.
//! Never here: keys, pop-ups, other pages.

use std::sync::Arc;
use std::time::Duration;

use super::answers::{Answers, Derivations, Searches};
use super::dragged_mass::DraggedMass;
use super::earlier_window::EarlierWindow;
use super::history::UndoHistory;
use super::pane::Focus;
use super::pending::PendingChanges;
use super::restoration::Restoration;
use super::shape_traits::ShapeTraits;
use super::steady_verdicts::SteadyVerdicts;
use super::{DrawnPanes, LawInView, LeastRange, Loaded, Pane, Prediction, Selection, ValueId};
use crate::experiment::{Snapshot, Status};
use crate::instrument::{CameraPose, MotionCurve, Plot, Present, Returned};
use crate::mechanics::Valuation;
use crate::model::Shape;
use crate::num::OrientationPolytope;
use crate::preset::NewObservable;

/// A loaded system and its view.
#[derive(Clone, Debug)]
pub struct Lab {
    /// The system.
    pub loaded: Loaded,
    /// Its newest snapshot.
    pub snapshot: Option<Arc<Snapshot>>,
    /// The pictures.
    pub plots: Vec<Plot>,
    /// The pane with the keyboard focus, and those that had it.
    pub focus: Focus,
    /// What is selected in the lists.
    pub selection: Selection,
    /// The number of rows by which the law of motion is scrolled.
    pub law_scroll: u16,
    pub(super) drawn: DrawnPanes,
    shapes: ShapeTraits,
    pub(super) dragged: Option<Box<DraggedMass>>,
    /// The results computed in the background for the pictures, and the jobs under way.
    pub(super) answers: Answers,
    pub(super) derivations: Derivations,
    /// The searches for constants of the motion, equilibria and symmetries.
    pub searches: Searches,
    /// Changes requested and not yet confirmed by a snapshot.
    pub(super) pending: PendingChanges,
    pub(super) history: UndoHistory,
    steady: SteadyVerdicts,
    /// What a person predicts on a picture.
    pub prediction: Option<Box<Prediction>>,
    /// The least ranges of quantities in the pictures, as a script sets them.
    pub(super) least_ranges: Vec<LeastRange>,
    /// The times that are marked, in order.
    pub marks: Vec<f64>,
    /// The quantities that were typed for axes: they belong to the view, and are no part of the text.
    pub typed: Vec<NewObservable>,
    /// The motion that the experiment is to restore.
    pub(super) restoration: Restoration,
    /// What the pictures keep in view of the motions before the current one was begun elsewhere.
    pub(super) earlier_window: EarlierWindow,
}

impl Lab {
    /// Creates the initial view of a system.
    pub fn new(loaded: Loaded) -> Self {
        let plots = Plot::opening(loaded.physics());
        Self {
            shapes: ShapeTraits::of(&loaded),
            loaded,
            dragged: None,
            snapshot: None,
            plots,
            focus: Focus::default(),
            selection: Selection::default(),
            law_scroll: 0,
            drawn: DrawnPanes::default(),
            answers: Answers::default(),
            derivations: Derivations::default(),
            searches: Searches::default(),
            pending: PendingChanges::default(),
            history: UndoHistory::default(),
            steady: SteadyVerdicts::default(),
            prediction: None,
            least_ranges: Vec::new(),
            marks: Vec::new(),
            typed: Vec::new(),
            restoration: Restoration::default(),
            earlier_window: EarlierWindow::default(),
        }
    }

    /// Takes in a new snapshot. Returns whether it belongs to this system.
    pub(super) fn see(&mut self, snapshot: &Arc<Snapshot>) -> bool {
        if snapshot.epoch != self.loaded.epoch || !self.restoration.see(snapshot) {
            return false;
        }
        self.pending.see(snapshot);
        let steady = self.steady.see(snapshot);
        let with = |gauges| Arc::new(Snapshot { gauges, ..Snapshot::clone(snapshot) });
        self.snapshot = Some(steady.map_or_else(|| Arc::clone(snapshot), with));
        self.answers.stale = true;
        let mut values = std::mem::take(&mut self.pending.values);
        values.retain(|(id, value)| self.fact(*id) != Some(*value));
        self.pending.values = values;
        true
    }

    /// Returns the current state as instruments see it, once there is a snapshot.
    pub fn present(&self) -> Option<Present<'_>> {
        self.seen().map(|snapshot| self.present_of(snapshot))
    }

    /// Returns the same for a snapshot that fits the system.
    pub fn present_of<'a>(&'a self, snapshot: &'a Snapshot) -> Present<'a> {
        Present {
            physics: self.loaded.physics(),
            time: snapshot.time,
            running: snapshot.status == Status::Running,
            carried: self.answers.known_until().min(snapshot.time),
            changed: snapshot
                .recorded
                .changed
                .as_deref()
                .map(|last| (last.what.as_str(), &last.state)),
            parameters: &snapshot.parameters,
            initial: &snapshot.initial,
            values: &snapshot.values,
            bounds: &snapshot.bounds,
            crossings: &snapshot.crossings,
            separations: &snapshot.separations,
            equilibria: self.equilibria_at(&snapshot.parameters),
            periodic: &self.answers.periodic,
            method: snapshot.method.name,
            settings: snapshot.setup.settings,
            returned: returned(snapshot),
            turned: snapshot.returned.as_ref().map(|seen| (&seen.state, seen.start)),
        }
    }

    /// Returns the range that a channel had before the motion was begun at a point of a picture.
    pub fn window_before(&self, channel: usize) -> Option<(f64, f64)> {
        self.earlier_window.bounds(channel)
    }

    /// The hull that a point in space has kept from before the motion was begun elsewhere.
    pub fn hull_before(&self, channels: [Option<usize>; 3]) -> Option<&OrientationPolytope> {
        self.earlier_window.hull(channels)
    }

    /// The ranges that a picture of a plane has kept from before a mass was dragged in it.
    pub fn plane_before(&self, eye: CameraPose) -> Option<[[f64; 2]; 2]> {
        self.earlier_window.plane(eye.view).filter(|_| eye.frame.is_none())
    }

    /// Keeps what the pictures show for the motion that is begun next.
    pub(super) fn keep_windows(&mut self) {
        let Some(snapshot) = &self.snapshot else { return };
        self.earlier_window = self.earlier_window.with(snapshot);
    }

    /// Returns the current values of the system's symbols, which are empty before the first snapshot.
    pub fn valuation(&self) -> Valuation {
        self.present().map(|present| present.valuation()).unwrap_or_default()
    }

    /// Returns each shape that a camera sees, and whether it is a rod.
    pub fn shapes(&self, eye: CameraPose) -> impl Iterator<Item = (&Shape, bool)> {
        let model = &self.loaded.model;
        eye.shapes(model).iter().zip(self.shapes.seen_by(eye, model).iter().map(|one| one.is_rod))
    }

    /// Whether a shape is a mass that can be dragged in a picture.
    pub fn can_drag(&self, eye: CameraPose, shape: usize) -> bool {
        let shape = self.shapes.seen_by(eye, &self.loaded.model).get(shape);
        eye.frame.is_none() && shape.is_some_and(|shape| shape.is_draggable)
    }

    /// Returns the newest snapshot, if it is complete; one that reports a panic is not.
    pub fn seen(&self) -> Option<&Snapshot> {
        self.snapshot.as_deref().filter(|snapshot| self.fits(snapshot))
    }

    /// Whether a snapshot has all the data that the system's views need.
    pub fn fits(&self, snapshot: &Snapshot) -> bool {
        snapshot.parameters.len() == self.loaded.model.parameters.len()
            && snapshot.values.len() == self.loaded.system.channels().len()
    }

    pub(super) fn tick(&mut self, elapsed: Duration) {
        self.history.tick(elapsed);
        self.steady.tick(elapsed);
        self.answers.tick(elapsed);
        self.searches.tick(elapsed);
    }

    /// Returns all panes that can be focused, in view or not: pictures, the law, lists.
    pub fn panes(&self) -> impl DoubleEndedIterator<Item = Pane> + Clone {
        let lists = [Pane::Parameters, Pane::Initial, Pane::Gauges];
        let clipped = self.drawn.law != LawInView::Whole || self.focus.pane == Pane::Law;
        let law = clipped.then_some(Pane::Law);
        (0..self.plots.len()).map(Pane::Plot).chain(law).chain(lists)
    }

    /// Takes in what drawing the panes has determined. Where there is room for one only, the motion comes first.
    pub(super) fn take_drawn(&mut self, drawn: DrawnPanes) {
        // what comes into view may be refined
        self.answers.stale |= drawn.in_view != self.drawn.in_view;
        self.drawn = drawn;
        if let LawInView::Clipped(beyond) = self.drawn.law {
            self.law_scroll = self.law_scroll.min(beyond);
        } else if self.drawn.law == LawInView::Whole {
            self.law_scroll = 0;
        }
        if self.drawn.single && self.focus.untouched {
            self.focus.pane = self.motion().unwrap_or(self.focus.pane);
        }
    }

    /// Returns the cameras of the pictures in view that show the system's own shapes.
    pub fn eyes_in_view(&self) -> impl Iterator<Item = CameraPose> {
        let model = &self.loaded.model;
        let seen = |index: usize| self.drawn.in_view.has(Pane::Plot(index));
        let plots = self.plots.iter().enumerate().filter(move |(index, _)| seen(*index));
        let eyes = plots.filter_map(|(_, plot)| plot.eye());
        eyes.filter(|eye| eye.own_shapes(model).is_none())
    }

    /// Returns the pane in which the motion is seen: the first one in space, or else the first picture.
    pub fn motion(&self) -> Option<Pane> {
        let scene = self.plots.iter().position(|plot| plot.kind.properties().is_scene);
        let first = (!self.plots.is_empty()).then_some(0);
        scene.or(first).map(Pane::Plot)
    }

    /// Whether the motion is seen in a plot: a scene, or a plane of two places drawn at one scale.
    pub fn shows_motion(&self, plot: &Plot) -> bool {
        let physics = self.loaded.physics();
        let channels = physics.system.channels();
        let is_place = |axis: usize| {
            plot.column(axis).and_then(|column| channels.get(column)).is_some_and(|c| c.is_place)
        };
        let is_portrait = plot.kind.properties().curve == Some(MotionCurve::Portrait);
        plot.kind.properties().is_scene
            || is_portrait && plot.is_plane(physics) && is_place(0) && is_place(1)
    }

    /// Scrolls the law of motion.
    pub(super) fn roll_law(&mut self, by: isize) {
        let LawInView::Clipped(beyond) = self.drawn.law else { return };
        let rows = usize::from(self.law_scroll).saturating_add_signed(by);
        self.law_scroll = rows.min(beyond.into()) as u16;
    }

    /// Returns the pictures that were focused, the last one first.
    pub fn focused_before(&self) -> impl Iterator<Item = usize> {
        self.focus.recent.iter().copied().filter(|index| *index < self.plots.len())
    }

    /// Returns the focused picture and its index.
    pub fn focused_plot(&self) -> Option<(usize, &Plot)> {
        match self.focus.pane {
            Pane::Plot(index) => self.plots.get(index).map(|plot| (index, plot)),
            _ => None,
        }
    }

    /// Whether there is a cursor on the focused plot.
    pub fn has_cursor(&self) -> bool {
        let viewport = self.focused_plot().and_then(|(_, plot)| plot.viewport());
        viewport.is_some_and(|viewport| viewport.cursor.is_some())
    }

    /// Returns the value that keys would change.
    pub fn selected(&self) -> Option<ValueId> {
        let target = match self.focus.pane {
            Pane::Parameters => ValueId::Parameter(self.selection.parameter),
            Pane::Initial => ValueId::Initial(self.selection.initial),
            Pane::Plot(_) | Pane::Gauges | Pane::Law => return None,
        };
        self.value_info(target).map(|_| target)
    }

    /// Moves the selection of the focused list to `to(place)`, clamped to the list.
    pub(super) fn select(&mut self, to: impl FnOnce(usize) -> usize) {
        let gauges = self.snapshot.as_ref().map_or(0, |s| s.gauges.len());
        let (count, place) = match self.focus.pane {
            Pane::Parameters => (self.count(ValueId::Parameter), &mut self.selection.parameter),
            Pane::Initial => (self.loaded.model.moving(), &mut self.selection.initial),
            Pane::Gauges => (gauges, &mut self.selection.gauge),
            Pane::Plot(_) | Pane::Law => return,
        };
        *place = to(*place).min(count.saturating_sub(1));
    }

    pub(super) fn of_file(&self, target: ValueId) -> Option<f64> {
        match target {
            ValueId::Parameter(index) => self.loaded.model.parameters.get(index).map(|p| p.value),
            ValueId::Initial(index) => {
                let parameters = &self.seen()?.parameters;
                self.loaded.system.initial_values(parameters).get(index).copied()
            }
        }
    }
}

/// How a motion whose time was reversed returns, as instruments see it.
fn returned(snapshot: &Snapshot) -> Option<Returned> {
    let seen = snapshot.returned.as_ref()?;
    Some(Returned {
        elapsed: [(snapshot.time - seen.turned).abs(), (seen.start - seen.turned).abs()],
        step_error: (seen.step_error, seen.mean_step, seen.step.is_none()),
        distance: seen.distance,
        error: seen.error,
    })
}
