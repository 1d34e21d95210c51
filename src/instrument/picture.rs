//! A picture as data: axes and the layers drawn on them.
//!
//! In: channels and numbers. Out: [`Picture`]s, which `view` draws in the characters and colours of a terminal. Never
//! here: cells, colours, or how a curve becomes dots.

use std::sync::Arc;

use super::{CameraPose, PlaneField};
use crate::analysis::Landscape;

/// The line above a picture.
#[derive(Clone, Debug, Default)]
pub struct Heading {
    /// The title, used if the file gives none.
    pub title: String,
    /// Whether the title is the file's own, which is never replaced.
    pub given: bool,
    /// The entries after it, as far as there is room.
    pub entries: Vec<Entry>,
}

/// An entry of a heading.
#[derive(Clone, Debug)]
pub enum Entry {
    /// A channel and its current value.
    Channel(usize),
    /// A curve of the picture by its index, with its channel and the current value.
    Curve(usize, usize),
    /// A named number.
    Number(String, f64),
    /// Text.
    Words(String),
    /// What points of an ink stand for, in it.
    Key(Ink, String),
    /// What the line of the curve of this index stands for, in its colour and pattern.
    Line(usize, String),
    /// The names of recent occurrences, whose marks are in the picture.
    Occurrences,
}

/// The horizontal axis.
#[derive(Clone, Debug)]
pub enum Across {
    /// The picture has no axes.
    Nothing,
    /// A channel, over all of its motion or a range.
    Channel(usize, Option<[f64; 2]>),
    /// Time, which moves along with the motion.
    Time,
    /// Time over a range.
    Times([f64; 2]),
    /// A number of this name, over a range.
    Named(String, [f64; 2]),
}

/// The vertical axis.
#[derive(Clone, Debug)]
pub enum Upwards {
    /// A channel, over all of its motion or a range.
    Channel(usize, Option<[f64; 2]>),
    /// Several channels on one axis.
    Shared(Vec<usize>),
    /// The name and unit of a channel, over a range that is rounded outwards.
    Around(usize, [f64; 2]),
    /// A channel, over all of its motion or a range, with words behind its name.
    Annotated {
        /// The quantity, by its index.
        channel: usize,
        /// The range.
        range: Option<[f64; 2]>,
        /// What is written behind its name.
        words: String,
    },
    /// A number of this name, over a range that is rounded outwards.
    Named(String, [f64; 2]),
}

/// The contents of a pane.
#[derive(Clone, Debug)]
pub enum Picture {
    /// Shapes through a camera.
    Scene(CameraPose),
    /// Curves and points on axes.
    Axes {
        /// The vertical axis.
        upwards: Upwards,
        /// The layers; the level of each gives the drawing order.
        layers: Vec<(Level, Layer)>,
        /// The level and channels at which occurrences are marked; `None` for the horizontal channel means time.
        occurrences: Option<(Level, [Option<usize>; 2])>,
    },
}

/// A greater level lies over a lesser one.
pub type Level = u8;

/// A layer drawn on axes.
#[derive(Clone, Debug)]
pub enum Layer {
    /// Level curves, one in so many, and separatrices; the separatrices and saddles are one level higher.
    Landscape(Arc<Landscape>, usize),
    /// Arrows along a vector field, where nothing else is drawn.
    VectorField(Arc<PlaneField>),
    /// The nullclines of a vector field, as the curves of two indices.
    Nullclines(Arc<PlaneField>, [usize; 2]),
    /// The past of two channels, fading with age.
    Trail([usize; 2]),
    /// Their past since a time, if one is given: what they were before is another quantity.
    RecentTrail([usize; 2], Option<f64>),
    /// A channel against time, drawn as the curve of this index.
    Curve {
        /// The index of the curve.
        index: usize,
        /// The quantity, by its index.
        channel: usize,
    },
    /// A line through points.
    Line(Vec<[f64; 2]>, Stroke),
    /// Single points.
    Points(Arc<Vec<[f64; 2]>>, Ink),
    /// Many points, shaded by how many there are in each cell.
    Cloud(Arc<Vec<[f64; 2]>>),
    /// Many points in the colour of a curve, the stronger the more of them fall on a dot.
    Bands(Arc<Vec<[f64; 2]>>, usize),
    /// A number at each place of a plane, shaded.
    Field(Arc<Field>),
    /// Where the running motion has crossed a surface of section.
    Crossings {
        /// The index of the surface.
        section: usize,
        /// The channels of the axes.
        channels: [usize; 2],
        /// The colour.
        ink: Ink,
    },
    /// The last of these points.
    LastCrossing {
        /// The index of the surface.
        section: usize,
        /// The channels of the axes.
        channels: [usize; 2],
        /// The marker.
        shape: MarkerShape,
    },
    /// The past of two channels of each motion beside the main one, and where it is now.
    Companions([usize; 2]),
    /// A channel of each of them against time.
    CompanionCurves(usize),
    /// Where each of them has crossed a surface of section.
    CompanionCrossings {
        /// The index of the surface.
        section: usize,
        /// The channels of the axes.
        channels: [usize; 2],
    },
    /// A marker at a point.
    Point([f64; 2], MarkerShape, Ink),
    /// A name beside a point, where there is room.
    Name([f64; 2], String),
    /// Lines of text in a corner, over everything else.
    Legend(Vec<String>),
}

/// A number at each place of a lattice over a window.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// The range of each axis.
    pub window: [[f64; 2]; 2],
    /// The places of a row.
    pub columns: usize,
    /// The numbers, the lowest row first; NaN where there is none.
    pub values: Vec<f64>,
    /// The numbers from the faintest shade to the strongest.
    pub range: [f64; 2],
}

impl Field {
    /// The number at a point, if the window has it.
    pub fn at(&self, point: [f64; 2]) -> Option<f64> {
        let rows = self.values.len() / self.columns.max(1);
        let [i, j] = [(0, self.columns), (1, rows)].map(|(axis, count)| {
            let [from, to] = self.window[axis];
            let place = (point[axis] - from) / (to - from) * count as f64;
            (place >= 0.0 && place < count as f64).then_some(place as usize)
        });
        self.values.get(j? * self.columns + i?).copied().filter(|x| x.is_finite())
    }

    /// How far a number is from the faintest shade, 0, to the strongest, 1.
    pub fn share(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        if high > low { ((value - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 }
    }
}

/// The style of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// The colour.
    pub ink: Ink,
    /// The fraction of its dots that is drawn; `None` for all of them.
    pub covering: Option<f64>,
}

/// A colour by its purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    /// The plain colour of text.
    Plain,
    /// The most important part.
    Accent,
    /// What a person should look at.
    Warn,
    /// A faint level curve.
    Level,
    /// The level curve through a saddle.
    Separatrix,
    /// The colour of the curve of this index.
    Curve(usize),
    /// The colour of the motion of this number beside the main one.
    Companion(usize),
}

/// A marker on a plot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkerShape {
    /// The current state.
    Disc,
    /// A point near the current state, or a stable one.
    Ring,
    /// An unstable point.
    Cross,
}

impl From<Ink> for Stroke {
    fn from(ink: Ink) -> Self {
        Self { ink, covering: None }
    }
}
