//! The contents of a pane: a kind, the quantities chosen for it, and its camera or window.
//!
//! In: views of a file, choices, moves. Out: [`Plot`]s, and what a session saves of them. Never here: what a single
//! kind shows.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::table::is_view_of;
use super::{
    Answer, CameraPose, Entry, Heading, INSTRUMENTS, Instrument, MOST_SEEDS, Physics, Present,
    Seed, Sight, Viewport, named,
};
use crate::model::Model;
use crate::system::{Channel, ChannelKind};

/// The channels of each axis, in the order of the axes.
pub type Columns = Vec<Vec<usize>>;

/// The contents of a pane.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// The kind.
    pub kind: &'static dyn Instrument,
    /// The channels chosen for its axes.
    pub columns: Columns,
    /// The view of the file that it shows, if nothing is chosen.
    pub view: Option<usize>,
    /// The camera or the window.
    pub sight: Sight,
    /// The orbits added to a section.
    pub seeds: Vec<Seed>,
}

/// A plot as saved in a session, with quantities by name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedPlot {
    /// The kind's name.
    pub kind: String,
    /// The index of the view of the file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub view: Option<usize>,
    /// The camera, if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub eye: Option<CameraPose>,
    /// The window on its axes, if it has axes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[serde(rename = "lens")]
    pub viewport: Option<Viewport>,
    /// The orbits added to a section.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub seeds: Vec<Seed>,
    /// The quantities chosen for each axis, by the axis's key.
    #[serde(flatten)]
    pub axes: BTreeMap<String, Chosen>,
}

/// The quantities chosen for an axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Chosen {
    /// For an axis that takes one quantity.
    One(Quantity),
    /// For an axis that takes several.
    Several(Vec<Quantity>),
}

/// A channel by its name, or by its index if it has none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quantity {
    name: String,
    place: usize,
}

impl Plot {
    /// Creates a plot with the initial camera or window.
    pub fn new(
        kind: &'static dyn Instrument,
        (columns, view): (Columns, Option<usize>),
        model: &Model,
    ) -> Self {
        let (view, sight) = if kind.is_scene() {
            (None, Sight::Camera(CameraPose::on(model, view)))
        } else {
            (view, Sight::Axes(Viewport::WHOLE))
        };
        Self { kind, columns, view, sight, seeds: Vec::new() }
    }

    /// The plots that the lab opens with: the file's views, then those that every system has, to fill a large screen.
    pub fn opening(physics: Physics<'_>) -> Vec<Self> {
        let mut plots: Vec<Self> = Vec::new();
        let views = 0..physics.model.views.len();
        let of_file = views.filter_map(|view| Self::of_view(physics, view));
        let of_every = INSTRUMENTS.into_iter().flat_map(|kind| {
            let all = kind.opening(physics).into_iter();
            all.map(move |columns| Self::new(kind, (columns, None), physics.model).opened(physics))
        });
        for plot in of_file.chain(of_every) {
            if !plots.iter().any(|p| p.shows_the_same(&plot, physics.model)) {
                plots.push(plot);
            }
        }
        plots
    }

    /// The plot of a view of the file, or `None` if one of its quantities is not a channel.
    pub fn of_view(physics: Physics<'_>, index: usize) -> Option<Self> {
        let view = physics.model.views.get(index)?;
        let kind = named(&view.kind)?;
        let channel = |c: &crate::model::Channel| physics.system.channel_of(c.expression);
        let chosen = kind.chosen();
        let columns: Columns = (chosen.iter().enumerate())
            .map(|(axis, _)| {
                view.axes.get(axis).into_iter().flatten().filter_map(channel).collect()
            })
            .collect();
        let whole = columns.iter().all(|column| !column.is_empty());
        let view = (chosen.is_empty() || kind.shows_a_view()).then_some(index);
        whole.then(|| Self::new(kind, (columns, view), physics.model).opened(physics))
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

    /// Whether it shows places in a plane: two coordinates, or two observed quantities, of the same unit.
    pub fn is_plane(&self, physics: Physics<'_>) -> bool {
        let place = |axis: usize| {
            let channel = physics.system.channels().get(self.column(axis)?)?;
            let observed =
                matches!(channel.kind, ChannelKind::Observable(_) | ChannelKind::Expression);
            let placed = matches!(channel.kind, ChannelKind::Position(_));
            (placed || observed && !channel.unit.is_empty()).then_some((placed, &channel.unit))
        };
        let places = (place(0), place(1));
        self.kind.has_equal_axes()
            && self.column(0) != self.column(1)
            && matches!(places, (Some(x), Some(y)) if x == y)
    }

    /// The only channel, or the first, of an axis.
    pub fn column(&self, axis: usize) -> Option<usize> {
        self.columns.get(axis)?.first().copied()
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
            let plot = Self::of_view(physics, index);
            plot.is_some_and(|plot| plot.shows_the_same(self, physics.model))
        };
        let titled = views.filter(|(_, view)| !view.title.is_empty());
        titled.filter(|(index, _)| same(*index)).map(|(_, view)| view.title.as_str()).next()
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

    /// Zooms horizontally, vertically, or both.
    pub fn zoom(&mut self, factor: f64, axes: [bool; 2]) {
        let nearer = |zoom: &mut f64| *zoom = (*zoom * factor).clamp(0.05, 200.0);
        match &mut self.sight {
            Sight::Camera(eye) => nearer(&mut eye.zoom),
            Sight::Axes(viewport) => {
                let chosen = viewport.zoom.iter_mut().zip(axes).filter(|(_, chosen)| *chosen);
                chosen.for_each(|(zoom, _)| nearer(zoom));
            }
        }
    }

    /// Drags the picture by fractions of the width and height: a camera rotates, a window moves.
    pub fn drag(&mut self, by: [f64; 2]) {
        match &mut self.sight {
            Sight::Camera(eye) => eye.turn(-by[0] * PI, -by[1] * PI),
            Sight::Axes(viewport) => viewport.pan = [0, 1].map(|k| viewport.pan[k] - by[k]),
        }
    }

    /// Zooms about a fixed point, given in fractions of the width and height.
    pub fn zoom_about(&mut self, factor: f64, place: [f64; 2]) {
        let anchor = [self.kind.anchor(), 0.5];
        let before = self.viewport().map(|viewport| viewport.zoom);
        self.zoom(factor, [true; 2]);
        if let (Some(before), Some(viewport)) = (before, self.viewport_mut()) {
            viewport.pan = [0, 1].map(|k| {
                let nearer = viewport.zoom[k] / before[k];
                (viewport.pan[k] + place[k] - anchor[k]) * nearer - place[k] + anchor[k]
            });
        }
    }

    /// Adds orbits to a section: the one through a point, or some spread over what is seen; or begins a cloud there.
    /// Returns whether there is something to add them to, and room for them.
    pub fn add_orbits(
        &mut self,
        present: &Present<'_>,
        answer: Option<&Answer>,
        through: Option<[f64; 2]>,
    ) -> bool {
        let seen = self.kind.seed(self, present, answer);
        let seed = through.map_or(seen, |at| seen.map(|_| Seed::Through(at)));
        // a cloud has one place, a section many orbits
        if seed.is_some() && !self.kind.is_section() {
            self.seeds.clear();
        }
        let added = seed.filter(|_| self.seeds.len() < MOST_SEEDS);
        self.seeds.extend(added);
        added.is_some()
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
                Sight::Axes(Viewport { equal: viewport.equal, ..Viewport::WHOLE })
            }
        };
    }
}

impl SavedPlot {
    /// Converts a plot for saving.
    pub fn of(plot: &Plot, physics: Physics<'_>) -> Self {
        let quantity = |&place: &usize| {
            let channel = physics.system.channels().get(place);
            Quantity { name: channel.map_or_else(String::new, |c| c.name.clone()), place }
        };
        let axes = plot.kind.chosen().iter().zip(&plot.columns).filter_map(|(axis, column)| {
            let mut quantities = column.iter().map(quantity);
            let chosen = if axis.several {
                Chosen::Several(quantities.collect())
            } else {
                Chosen::One(quantities.next()?)
            };
            Some((axis.key.to_owned(), chosen))
        });
        Self {
            kind: plot.kind.name().to_owned(),
            view: plot.view,
            eye: plot.eye(),
            viewport: plot.viewport(),
            seeds: plot.seeds.clone(),
            axes: axes.collect(),
        }
    }

    /// The plot in a system, or `None` if the system lacks something that it shows.
    pub fn place(&self, physics: Physics<'_>) -> Option<Plot> {
        let (model, channels) = (physics.model, physics.system.channels());
        let kind = named(&self.kind)?;
        let channel = |quantity: &Quantity| {
            let named = |c: &Channel| c.name == quantity.name;
            match quantity.name.as_str() {
                "" => Some(quantity.place).filter(|&i| channels.get(i).is_some_and(named)),
                _ => channels.iter().position(named),
            }
        };
        let column = |key: &str| -> Option<Vec<usize>> {
            let found: Vec<usize> = match self.axes.get(key)? {
                Chosen::One(quantity) => channel(quantity).into_iter().collect(),
                Chosen::Several(all) => all.iter().filter_map(channel).collect(),
            };
            (!found.is_empty()).then_some(found)
        };
        let columns = kind.chosen().iter().map(|axis| column(axis.key)).collect::<Option<_>>()?;
        let sight = match (kind.is_scene(), self.eye, self.viewport) {
            (true, Some(eye), _) => {
                let framed = eye.frame.is_none_or(|frame| frame < model.frames.len());
                let viewed = eye.view.is_none_or(|view| is_view_of(model, view, kind));
                let fits = framed && viewed && !eye.shapes(model).is_empty();
                fits.then_some(Sight::Camera(eye))?
            }
            (false, _, Some(viewport)) => Sight::Axes(viewport),
            _ => return None,
        };
        let needs_view = kind.shows_a_view();
        let viewed = self.view.is_some_and(|view| is_view_of(model, view, kind));
        let view = self.view.filter(|_| needs_view);
        let finite = |seed: &Seed| match seed {
            Seed::Spread(window) => window.as_flattened().iter().all(|x| x.is_finite()),
            Seed::Through(point) => point.iter().all(|x| x.is_finite()),
        };
        let seeds: Vec<Seed> =
            self.seeds.iter().filter(|seed| finite(seed)).take(MOST_SEEDS).copied().collect();
        (!needs_view || viewed).then_some(Plot { kind, columns, view, sight, seeds })
    }
}
