//! What is done with the contents of a pane: plots of views, words, titles, moves of the camera or window.
//!
//! In: a kind, views of a file, choices, moves. Out: [`Plot`]s. Never here: what a single kind shows, which kinds there
//! are, what a session saves.

use std::f64::consts::PI;

use super::{
    Across, Answer, CameraPose, Columns, Entry, Heading, Instrument, MOST_SEEDS, Physics, Plot,
    PlotContext, Present, Seed, Sight, Viewport,
};
use crate::model::{Model, View};

/// Up to this zoom a camera sees the whole scene; it is 1 but for the rounding of steps.
const WHOLE_SCENE: f64 = 1.0 + 1e-9;

impl Plot {
    /// Creates a plot with the initial camera or window.
    pub fn new(
        kind: &'static dyn Instrument,
        (columns, view): (Columns, Option<usize>),
        model: &Model,
    ) -> Self {
        let (view, sight) = if kind.properties().is_scene {
            (None, Sight::Camera(CameraPose::on(model, view)))
        } else {
            (view, Sight::Axes(Viewport::WHOLE))
        };
        let over = view.and_then(|view| model.views.get(view)).map(|view| view.over.clone());
        Self { kind, columns, view, over: over.unwrap_or_default(), sight, seeds: Vec::new() }
    }

    /// The plot of a kind that shows a view of the file, or `None` if one of its quantities is not a channel.
    pub(super) fn viewing(
        kind: &'static dyn Instrument,
        physics: Physics<'_>,
        index: usize,
    ) -> Option<Self> {
        let view = physics.model.views.get(index)?;
        let channel = |c: &crate::model::WrittenExpr| physics.system.channel_of(c.expression);
        let chosen = kind.chosen();
        let columns: Columns = (chosen.iter().enumerate())
            .map(|(axis, _)| {
                view.axes.get(axis).into_iter().flatten().filter_map(channel).collect()
            })
            .collect();
        let whole = columns.iter().all(|column| !column.is_empty());
        let shown = (chosen.is_empty() || kind.properties().shows_a_view).then_some(index);
        let mut plot = Self::new(kind, (columns, shown), physics.model).opened(physics);
        if let Some(viewport) = plot.viewport_mut() {
            viewport.field = view.field;
        }
        whole.then_some(plot)
    }

    /// The same plot as it is first shown: a plane has equal units.
    #[must_use]
    pub fn opened(mut self, physics: Physics<'_>) -> Self {
        let equal = self.is_plane(physics);
        if let Some(viewport) = self.viewport_mut() {
            viewport.equal = equal;
        }
        self
    }

    /// Whether it shows a plane with one scale: two quantities of the same unit, or two places where there are no units.
    pub fn is_plane(&self, physics: Physics<'_>) -> bool {
        if let Some(known) = self.kind.is_plane(self, physics) {
            return known;
        }
        let channel = |axis: usize| physics.system.channels().get(self.column(axis)?);
        let Some((x, y)) = channel(0).zip(channel(1)) else { return false };
        let alike = if x.unit.is_empty() { x.is_place && y.is_place } else { true };
        self.kind.properties().has_equal_axes
            && self.column(0) != self.column(1)
            && x.unit == y.unit
            && alike
    }

    /// The only channel, or the first, of an axis.
    pub fn column(&self, axis: usize) -> Option<usize> {
        self.columns.get(axis)?.first().copied()
    }

    /// The horizontal axis of its first column, over a range.
    pub(super) fn across(&self, range: Option<[f64; 2]>) -> Across {
        self.column(0).map_or(Across::Nothing, |x| Across::Channel(x, range))
    }

    /// The name of the plot without a picture.
    pub fn words(&self, physics: Physics<'_>) -> String {
        self.title(physics).map_or_else(|| self.kind.words(self, physics), str::to_owned)
    }

    /// The line above it: the file's own title, or else this one.
    pub(super) fn heading(
        &self,
        physics: Physics<'_>,
        otherwise: &str,
        entries: Vec<Entry>,
    ) -> Heading {
        let own = self.title(physics);
        Heading { title: own.unwrap_or(otherwise).to_owned(), given: own.is_some(), entries }
    }

    /// Its two quantities in words: `p against q`.
    pub(super) fn against(&self, physics: Physics<'_>) -> String {
        let [x, y] = [0, 1].map(|k| self.column(k).map_or("?", |channel| physics.shown(channel)));
        format!("{y} against {x}")
    }

    /// The title that the file gives to a view of the same quantities.
    pub fn title<'a>(&self, physics: Physics<'a>) -> Option<&'a str> {
        let views = physics.model.views.iter().enumerate();
        let same = |index| {
            let plot = Self::viewing(self.kind, physics, index);
            plot.is_some_and(|plot| plot.shows_the_same(self, physics.model))
        };
        let of_kind = |view: &View| !view.title.is_empty() && view.kind == self.kind.name();
        let mut titled = views.filter(|(_, view)| of_kind(view));
        titled.find(|(index, _)| same(*index)).map(|(_, view)| view.title.as_str())
    }

    /// Whether both plots show the same quantities, whatever their camera or window.
    pub fn shows_the_same(&self, other: &Self, model: &Model) -> bool {
        let seen = |plot: &Self| match plot.sight {
            Sight::Camera(eye) => Some((eye.frame, eye.own_shapes(model))),
            Sight::Axes(_) => None,
        };
        self.kind == other.kind
            && self.columns == other.columns
            && self.view == other.view
            && self.over == other.over
            && seen(self) == seen(other)
    }

    /// Whether the other differs at most in what changes smoothly: rotation, position, zoom or cursor.
    pub fn differs_smoothly(&self, other: &Self) -> bool {
        self.at_rest() == other.at_rest()
    }

    /// The same plot with the smooth settings at their defaults.
    fn at_rest(&self) -> Self {
        let sight = match self.sight {
            Sight::Camera(eye) => Sight::Camera(eye.at_rest()),
            Sight::Axes(viewport) => Sight::Axes(viewport.at_rest()),
        };
        Self { sight, ..self.clone() }
    }

    /// Rotates the picture or moves the window by steps to the right and up.
    pub fn shift(&mut self, [right, up]: [f64; 2]) {
        match &mut self.sight {
            Sight::Camera(eye) => eye.turn(-right * PI / 24.0, up * PI / 24.0),
            Sight::Axes(viewport) => viewport.shift([right, up]),
        }
    }

    /// Drags the picture by fractions of the width and height: a camera rotates, a window moves.
    pub fn drag(&mut self, by: [f64; 2]) {
        match &mut self.sight {
            Sight::Camera(eye) => eye.turn(-by[0] * PI, -by[1] * PI),
            Sight::Axes(viewport) => viewport.pan = [0, 1].map(|k| viewport.pan[k] - by[k]),
        }
    }

    /// Moves the window of a camera by fractions of the width and height, if it sees a part of the scene alone. Returns whether it
    /// does.
    pub fn slide(&mut self, by: [f64; 2]) -> bool {
        match &mut self.sight {
            Sight::Camera(eye) if eye.zoom > WHOLE_SCENE => {
                eye.pan = [0, 1].map(|k| eye.pan[k] - by[k]);
                true
            }
            _ => false,
        }
    }

    /// Zooms horizontally, vertically, or both, about a point that stays where it is, given in fractions of the width and height.
    /// Where all is seen again it is in the middle.
    pub fn zoom_about(&mut self, factor: f64, axes: [bool; 2], place: [f64; 2]) {
        let nearer = |zoom: f64| (zoom * factor).clamp(0.05, 200.0);
        // what a point keeps from the middle of the window, or from its end, while all grows by a ratio
        let panned = |pan: f64, ratio: f64, off: f64| (pan + off) * ratio - off;
        match &mut self.sight {
            Sight::Camera(eye) => {
                let zoom = nearer(eye.zoom);
                let ratio = zoom / eye.zoom;
                let whole = zoom < WHOLE_SCENE;
                eye.pan = [0, 1]
                    .map(|k| if whole { 0.0 } else { panned(eye.pan[k], ratio, place[k] - 0.5) });
                eye.zoom = zoom;
            }
            Sight::Axes(viewport) => {
                let anchor = [self.kind.properties().anchor, 0.5];
                for k in [0, 1].into_iter().filter(|&k| axes[k]) {
                    let zoom = nearer(viewport.zoom[k]);
                    let ratio = zoom / viewport.zoom[k];
                    let panned = panned(viewport.pan[k], ratio, place[k] - anchor[k]);
                    viewport.pan[k] = if zoom < WHOLE_SCENE { 0.0 } else { panned };
                    viewport.zoom[k] = zoom;
                }
            }
        }
    }

    /// The place about which keys zoom: the cursor, or else the moving point if it is in the window, given in fractions of the
    /// width and height; the middle where there is neither, and in time the end of the window.
    pub fn centre_of_zoom(&self, moving: Option<[f64; 2]>) -> [f64; 2] {
        let is_seen = |place: &[f64; 2]| place.iter().all(|share| (0.0..=1.0).contains(share));
        let cursor = self.viewport().and_then(|viewport| viewport.cursor);
        cursor.or(moving.filter(is_seen)).unwrap_or([self.kind.properties().anchor, 0.5])
    }

    /// Adds orbits to a section: the one through a point, or some spread over what is seen; or begins a cloud there.
    /// Returns whether there is something to add them to, and room for them.
    pub fn add_orbits(
        &mut self,
        present: &Present<'_>,
        answer: Option<&Answer>,
        through: Option<[f64; 2]>,
    ) -> bool {
        let seen = self.kind.seed(PlotContext { plot: self, present, answer });
        let seed = through.map_or(seen, |at| seen.map(|_| Seed::Through(at)));
        // a cloud has one place, a section many orbits
        if seed.is_some() && !self.kind.properties().is_section {
            self.seeds.clear();
        }
        let added = seed.filter(|_| self.seeds.len() < MOST_SEEDS);
        self.seeds.extend(added);
        added.is_some()
    }

    /// Fills what is seen of a section with orbits, and says whether it could.
    pub fn fill(&mut self, present: &Present<'_>, answer: Option<&Answer>) -> bool {
        let added = match self.kind.seed(PlotContext { plot: self, present, answer }) {
            Some(Seed::Spread(window)) if self.seeds.len() < MOST_SEEDS => Seed::Fill(window),
            _ => return false,
        };
        self.seeds.push(added);
        true
    }

    /// The camera, if it has one.
    pub fn eye(&self) -> Option<CameraPose> {
        match self.sight {
            Sight::Camera(eye) => Some(eye),
            Sight::Axes(_) => None,
        }
    }

    /// The window on its axes, if it has axes.
    pub fn viewport(&self) -> Option<Viewport> {
        match self.sight {
            Sight::Camera(_) => None,
            Sight::Axes(viewport) => Some(viewport),
        }
    }

    /// Mutable access to the window.
    pub fn viewport_mut(&mut self) -> Option<&mut Viewport> {
        match &mut self.sight {
            Sight::Camera(_) => None,
            Sight::Axes(viewport) => Some(viewport),
        }
    }

    /// Restores the initial camera or window.
    pub fn home(&mut self, model: &Model) {
        self.sight = match self.sight {
            Sight::Camera(eye) => Sight::Camera(eye.at_first(model)),
            Sight::Axes(viewport) => {
                let Viewport { equal, active, by_chaos, field, .. } = viewport;
                Sight::Axes(Viewport { equal, active, by_chaos, field, ..Viewport::WHOLE })
            }
        };
    }
}
