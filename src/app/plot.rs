//! What a pane with a picture shows: the motion in space, two quantities against each other, or some against time.
//!
//! In: the views of a model and the channels of its system. Out: [`Plot`]s. Never here: how they are drawn.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use serde::{Deserialize, Serialize};

use super::Loaded;
use super::action::{Axes, Direction};
use crate::model::{Model, Shape, ViewKind};
use crate::system::ChannelKind;

/// The contents of a pane.
#[derive(Clone, Debug, PartialEq)]
pub enum Plot {
    /// The file's shapes, seen through a camera.
    Space(CameraPose),
    /// One channel against another.
    Phase {
        /// The channel along the axis.
        x: usize,
        /// The channel upwards.
        y: usize,
        /// How it is looked at.
        viewport: Viewport,
    },
    /// The potential of a view of the file.
    Potential {
        /// The view's place among the views.
        view: usize,
        /// How it is looked at.
        viewport: Viewport,
    },
    /// Channels against time.
    Time {
        /// The channels.
        y: Vec<usize>,
        /// How it is looked at.
        viewport: Viewport,
    },
}

/// What is seen, from which frame, and where the camera stands in it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CameraPose {
    /// Turn about the vertical axis, in radians.
    pub yaw: f64,
    /// Height above the horizon, in radians; π/2 looks straight down on the plane of x and y.
    pub pitch: f64,
    /// Magnification.
    pub zoom: f64,
    /// The frame of the file it moves and turns with; none for the axes in which the shapes are written.
    pub frame: Option<usize>,
    /// The view of the file it shows, which may have a title and shapes of its own.
    pub view: Option<usize>,
}

/// How a plot is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Viewport {
    /// Magnification across and upwards.
    pub zoom: [f64; 2],
    /// How far the window is moved, in parts of its width and height.
    pub pan: [f64; 2],
    /// Whether the axis upwards is logarithmic.
    pub log: bool,
    /// Whether a unit is as long across as upwards.
    #[serde(default)]
    pub equal: bool,
    /// Where the cursor stands, in parts of the width from the left and of the height from below.
    pub cursor: Option<[f64; 2]>,
}

impl Viewport {
    /// All of the motion.
    pub const WHOLE: Self =
        Self { zoom: [1.0; 2], pan: [0.0; 2], log: false, equal: false, cursor: None };

    /// One step in a direction: of the cursor if there is one, else of the window.
    fn shift(&mut self, step: [f64; 2]) {
        match &mut self.cursor {
            Some(cursor) => *cursor = [0, 1].map(|k| (cursor[k] + step[k] / 40.0).clamp(0.0, 1.0)),
            None => self.pan = [0, 1].map(|k| self.pan[k] + step[k] / 10.0),
        }
    }
}

impl CameraPose {
    /// Plane motion is seen face on, motion in space from the side and from above.
    pub(super) fn for_shapes(loaded: &Loaded) -> Self {
        Self { yaw: 0.0, pitch: 0.0, zoom: 1.0, frame: None, view: None }.at_first(loaded)
    }

    /// What a view of the file shows.
    fn of_view(loaded: &Loaded, index: usize) -> Self {
        let frame = loaded.model.views[index].frame;
        Self { frame, view: Some(index), ..Self::for_shapes(loaded) }.at_first(loaded)
    }

    /// The same picture from the place where the camera first stands.
    fn at_first(self, loaded: &Loaded) -> Self {
        let plane = self.shapes(&loaded.model).iter().all(is_plane);
        let (yaw, pitch) = if plane { (0.0, FRAC_PI_2) } else { (PI / 6.0, PI / 9.0) };
        Self { yaw, pitch, zoom: 1.0, ..self }
    }

    /// The shapes seen: those of the view, or the model's.
    pub fn shapes(self, model: &Model) -> &[Shape] {
        self.own_shapes(model)
            .map_or(&model.space, |view| model.views[view].shapes.as_deref().unwrap_or_default())
    }

    /// The view, if it has shapes of its own.
    pub fn own_shapes(self, model: &Model) -> Option<usize> {
        self.view.filter(|&view| model.views.get(view).is_some_and(|view| view.shapes.is_some()))
    }
}

/// Whether a shape stays in the plane z = 0.
fn is_plane(shape: &Shape) -> bool {
    use crate::expr::Expr;
    let flat = |point: &[Expr; 3]| point[2] == Expr::ZERO;
    match shape {
        Shape::Line { from, to } | Shape::Spring { from, to } => flat(from) && flat(to),
        Shape::Circle { centre, normal, .. } => {
            flat(centre) && normal[0] == Expr::ZERO && normal[1] == Expr::ZERO
        }
        Shape::Mass { at, .. } | Shape::Trace { at } => flat(at),
        Shape::Vector { at, components } => flat(at) && flat(components),
        Shape::Path { points } => points.iter().all(flat),
        Shape::Plane { .. } | Shape::Body { .. } => false,
    }
}

impl Plot {
    /// What the screen opens with: the file's views, then what every system has, so that a large screen is used.
    pub fn opening(loaded: &Loaded) -> Vec<Self> {
        let mut plots: Vec<Self> = Vec::new();
        let mut add = |plot: Option<Self>| {
            plots.extend(
                plot.filter(|plot| !plots.iter().any(|p| p.shows_the_same(plot, &loaded.model))),
            );
        };
        for view in 0..loaded.model.views.len() {
            add(Self::of_view(loaded, view));
        }
        if !loaded.model.space.is_empty() {
            add(Some(Self::Space(CameraPose::for_shapes(loaded))));
        }
        let channel = |kind| loaded.system.channels().iter().position(|c| c.kind == kind);
        for i in 0..loaded.model.coordinates.len() {
            let (x, y) = (channel(ChannelKind::Position(i)), channel(ChannelKind::Momentum(i)));
            add(x.zip(y).map(|(x, y)| Self::Phase { x, y, viewport: Viewport::WHOLE }));
        }
        let positions = (0..loaded.model.coordinates.len())
            .filter_map(|i| channel(ChannelKind::Position(i)))
            .collect::<Vec<_>>();
        for q in positions {
            add(Some(Self::Time { y: vec![q], viewport: Viewport::WHOLE }));
        }
        plots
    }

    fn of_view(loaded: &Loaded, index: usize) -> Option<Self> {
        let view = &loaded.model.views[index];
        let channel = |c: &crate::model::Channel| loaded.system.channel_of(c.expression);
        match view.kind {
            ViewKind::Space => Some(Self::Space(CameraPose::of_view(loaded, index))),
            ViewKind::Phase => {
                let (x, y) = (channel(view.x.as_ref()?)?, channel(view.y.first()?)?);
                Some(Self::Phase { x, y, viewport: Viewport::WHOLE })
            }
            ViewKind::Potential => Some(Self::Potential { view: index, viewport: Viewport::WHOLE }),
            ViewKind::Time => {
                let y: Vec<_> = view.y.iter().filter_map(channel).collect();
                (!y.is_empty()).then_some(Self::Time { y, viewport: Viewport::WHOLE })
            }
        }
    }

    /// The title that the file gives to a view of the same quantities.
    pub fn title<'a>(&self, loaded: &'a Loaded) -> Option<&'a str> {
        let views = loaded.model.views.iter().enumerate();
        let same = |index| {
            let plot = Self::of_view(loaded, index);
            plot.is_some_and(|plot| plot.shows_the_same(self, &loaded.model))
        };
        let titled = views.filter(|(_, view)| !view.title.is_empty());
        titled.filter(|(index, _)| same(*index)).map(|(_, view)| view.title.as_str()).next()
    }

    /// Whether both show the same quantities, however they are looked at.
    fn shows_the_same(&self, other: &Self, model: &Model) -> bool {
        match (self, other) {
            (Self::Space(eye), Self::Space(other)) => {
                let what = |eye: &CameraPose| (eye.frame, eye.own_shapes(model));
                what(eye) == what(other)
            }
            (Self::Phase { x, y, .. }, Self::Phase { x: x2, y: y2, .. }) => (x, y) == (x2, y2),
            (Self::Time { y, .. }, Self::Time { y: y2, .. }) => y == y2,
            (Self::Potential { view, .. }, Self::Potential { view: other, .. }) => view == other,
            _ => false,
        }
    }

    /// Whether the other shows the same from another place: turned, moved, closer or with another cursor.
    pub(super) fn differs_smoothly(&self, other: &Self) -> bool {
        self.at_rest() == other.at_rest()
    }

    /// The same seen from the place of the beginning.
    fn at_rest(&self) -> Self {
        let mut plot = self.clone();
        match &mut plot {
            Self::Space(eye) => (eye.yaw, eye.pitch, eye.zoom) = (0.0, 0.0, 1.0),
            Self::Phase { viewport, .. }
            | Self::Time { viewport, .. }
            | Self::Potential { viewport, .. } => {
                let cursor = viewport.cursor.map(|_| [0.0; 2]);
                *viewport = Viewport {
                    log: viewport.log,
                    equal: viewport.equal,
                    cursor,
                    ..Viewport::WHOLE
                };
            }
        }
        plot
    }

    /// Turns the picture, or moves the window.
    pub(super) fn shift(&mut self, way: Direction) {
        let [right, up] = match way {
            Direction::Left => [-1.0, 0.0],
            Direction::Right => [1.0, 0.0],
            Direction::Up => [0.0, 1.0],
            Direction::Down => [0.0, -1.0],
        };
        match self {
            Self::Space(eye) => {
                eye.yaw = (eye.yaw - right * PI / 24.0).rem_euclid(TAU);
                eye.pitch = (eye.pitch + up * PI / 24.0).clamp(-FRAC_PI_2, FRAC_PI_2);
            }
            Self::Phase { viewport, .. }
            | Self::Time { viewport, .. }
            | Self::Potential { viewport, .. } => {
                viewport.shift([right, up]);
            }
        }
    }

    /// Looks closer or from farther away, along the axes named.
    pub(super) fn zoom(&mut self, factor: f64, axes: Axes) {
        let nearer = |zoom: &mut f64| *zoom = (*zoom * factor).clamp(0.05, 200.0);
        match self {
            Self::Space(eye) => nearer(&mut eye.zoom),
            Self::Phase { viewport, .. }
            | Self::Time { viewport, .. }
            | Self::Potential { viewport, .. } => {
                let chosen = match axes {
                    Axes::Both => &mut viewport.zoom[..],
                    Axes::Across => &mut viewport.zoom[..1],
                    Axes::Upwards => &mut viewport.zoom[1..],
                };
                chosen.iter_mut().for_each(nearer);
            }
        }
    }

    /// What the mouse holds goes with it, by parts of the width and of the height: the picture turns, the window moves.
    pub(super) fn drag(&mut self, by: [f64; 2]) {
        match self {
            Self::Space(eye) => {
                eye.yaw = (eye.yaw - by[0] * PI).rem_euclid(TAU);
                eye.pitch = (eye.pitch - by[1] * PI).clamp(-FRAC_PI_2, FRAC_PI_2);
            }
            Self::Phase { viewport, .. }
            | Self::Time { viewport, .. }
            | Self::Potential { viewport, .. } => {
                viewport.pan = [0, 1].map(|k| viewport.pan[k] - by[k]);
            }
        }
    }

    /// Looks closer or from farther away, so that what is at a place (parts of the width and of the height) stays there.
    pub(super) fn zoom_about(&mut self, factor: f64, place: [f64; 2]) {
        // A window on time ends at the present, any other has its own middle.
        let anchor = [if matches!(self, Self::Time { .. }) { 1.0 } else { 0.5 }, 0.5];
        let before = self.viewport().map(|viewport| viewport.zoom);
        self.zoom(factor, Axes::Both);
        if let (Some(before), Some(viewport)) = (before, self.viewport()) {
            viewport.pan = [0, 1].map(|k| {
                let nearer = viewport.zoom[k] / before[k];
                (viewport.pan[k] + place[k] - anchor[k]) * nearer - place[k] + anchor[k]
            });
        }
    }

    /// How it is looked at, if it has axes.
    pub(super) fn viewport(&mut self) -> Option<&mut Viewport> {
        match self {
            Self::Space(_) => None,
            Self::Phase { viewport, .. }
            | Self::Time { viewport, .. }
            | Self::Potential { viewport, .. } => Some(viewport),
        }
    }

    /// The view as it was at first.
    pub(super) fn home(&mut self, loaded: &Loaded) {
        match self {
            Self::Space(eye) => *eye = eye.at_first(loaded),
            Self::Phase { viewport, .. }
            | Self::Time { viewport, .. }
            | Self::Potential { viewport, .. } => {
                *viewport = Viewport::WHOLE;
            }
        }
    }
}
