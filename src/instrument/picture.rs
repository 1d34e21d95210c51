//! A picture as data: axes, and what is drawn on them, one layer over the other.
//!
//! In: channels and numbers. Out: [`Picture`]s, which `view` draws in the characters and colours of a terminal. Never here:
//! cells, colours, or how a curve becomes dots.

use std::sync::Arc;

use super::CameraPose;
use crate::analysis::Landscape;

/// What the line above a picture says.
#[derive(Clone, Debug, Default)]
pub struct Heading {
    /// What the picture is called where the file gives it no title.
    pub title: String,
    /// Whether that is the file's own title, which gives way to nothing.
    pub given: bool,
    /// What follows it, as far as there is room.
    pub entries: Vec<Entry>,
}

/// An entry of a heading.
#[derive(Clone, Debug)]
pub enum Entry {
    /// A channel and its present value.
    Channel(usize),
    /// A curve of the picture, counted from the first, with its channel and the present value.
    Curve(usize, usize),
    /// A number by its name.
    Number(String, f64),
    /// Words.
    Words(String),
    /// The names of what happened lately, whose marks are in the picture.
    Happenings,
}

/// The range across.
#[derive(Clone, Debug)]
pub enum Across {
    /// The picture has no axes.
    Nothing,
    /// A channel, over all of its motion or a range.
    Channel(usize, Option<[f64; 2]>),
    /// Time, which runs along with the motion.
    Time,
}

/// The axis upwards.
#[derive(Clone, Debug)]
pub enum Upwards {
    /// A channel, over all of its motion or a range.
    Channel(usize, Option<[f64; 2]>),
    /// Several channels on one axis.
    Shared(Vec<usize>),
    /// The name and unit of a channel, over a range that is rounded outwards.
    Around(usize, [f64; 2]),
}

/// What a pane shows.
#[derive(Clone, Debug)]
pub enum Picture {
    /// Shapes through a camera.
    Scene(CameraPose),
    /// Curves and points on axes.
    Axes {
        /// The axis upwards.
        upwards: Upwards,
        /// What is drawn. The level of each says what lies over what.
        layers: Vec<(Level, Layer)>,
        /// The axis and channels along which what happened is marked; time where there is no channel across.
        occurrences: Option<(Level, [Option<usize>; 2])>,
    },
}

/// A greater level lies over a lesser one.
pub type Level = u8;

/// Something drawn on axes.
#[derive(Clone, Debug)]
pub enum Layer {
    /// Level curves and separatrices; the separatrices and saddles one level higher.
    Landscape(Arc<Landscape>),
    /// Where two channels have been, fading with age.
    Trail([usize; 2]),
    /// A channel against time, drawn as the curve of this number.
    Curve {
        /// Its number.
        index: usize,
        /// The channel.
        channel: usize,
    },
    /// A line through points.
    Line(Vec<[f64; 2]>, Stroke),
    /// One sign at a point.
    Point([f64; 2], Sign, Ink),
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Stroke {
    /// In which colour.
    pub ink: Ink,
    /// The share of its dots that is drawn, where not all of them are.
    pub covering: Option<f64>,
}

/// A colour by what it is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    /// Plain.
    Plain,
    /// What matters most.
    Accent,
    /// What is to be noticed.
    Warn,
    /// A level, faint.
    Level,
    /// What parts kinds of motion.
    Separatrix,
    /// That of the curve of a number.
    Curve(usize),
}

/// A sign on a plot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// Where the motion is now.
    Disc,
    /// A place beside it.
    Ring,
}

impl From<Ink> for Stroke {
    fn from(ink: Ink) -> Self {
        Self { ink, covering: None }
    }
}
