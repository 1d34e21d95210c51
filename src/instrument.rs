//! The table of instruments: all kinds of plots, each one row here and one file.
//!
//! A file of this room says all there is to a kind: its name in files, sessions and claims, what a file writes and a
//! person chooses, what it opens with, its title, its picture as data, what it computes on the side, what can be claimed
//! of it. In: a system and its present. Out: [`Plot`]s, [`Picture`]s, [`Job`]s. Never here: cells and colours (`view` draws
//! any picture), keys, threads.

mod phase;
mod picture;
mod plot;
mod potential;
mod present;
mod sight;
mod space;
mod time;

use std::any::Any;
use std::fmt;
use std::sync::Arc;

use crate::job::Job;
use crate::model::Model;
use crate::system::InitialOverride;

pub use picture::{Across, Entry, Heading, Ink, Layer, Level, Picture, Sign, Stroke, Upwards};
pub use plot::{Columns, Plot, Quantity, SavedPlot};
pub use potential::Along;
pub use present::{Physics, Present};
pub use sight::{CameraPose, Sight, Viewport};

/// All kinds, in the order in which the lab opens with them.
pub static INSTRUMENTS: [&dyn Instrument; 4] =
    [&space::Space, &phase::Phase, &potential::Potential, &time::Time];

/// Kinds that the format of files names and this version leaves out.
pub const NOT_YET: [&str; 5] = ["section", "spectrum", "ensemble", "transformation", "action"];

/// A kind of plot or instrument: one row of [`INSTRUMENTS`]. What most kinds share has a default.
pub trait Instrument: Sync {
    /// Its name in files, sessions and claims.
    fn name(&self) -> &'static str;

    /// What a view of a file writes.
    fn written(&self) -> &'static [Axis] {
        &[]
    }

    /// What a person chooses, axis after axis. A kind of which nothing is chosen shows a view of the file.
    fn chosen(&self) -> &'static [Axis] {
        self.written()
    }

    /// Whether it shows shapes through a camera, so that a file may give it a frame and shapes of its own.
    fn is_scene(&self) -> bool {
        false
    }

    /// Whether its axes have a unit in common that can be made equally long on both.
    fn has_equal_axes(&self) -> bool {
        false
    }

    /// What stays in place across when one looks closer, in parts of the width.
    fn anchor(&self) -> f64 {
        0.5
    }

    /// What the lab opens with besides the views of the file, by the columns of its axes.
    fn opening(&self, _physics: Physics<'_>) -> Vec<Columns> {
        Vec::new()
    }

    /// What a person is offered.
    fn offers(&self, physics: Physics<'_>) -> Vec<Offer>;

    /// What it is called where there is no picture: in lists and on the page of plain reading.
    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String;

    /// What is said before those words in a list where they are but names of quantities.
    fn lead(&self) -> &'static str {
        ""
    }

    /// The line above the picture; `answer` is what its job came to.
    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading>;

    /// The range across.
    fn across(&self, plot: &Plot, present: &Present<'_>, answer: Option<&Answer>) -> Across;

    /// The picture, where so much is seen across; nothing where there is nothing to be drawn.
    fn picture(
        &self,
        plot: &Plot,
        present: &Present<'_>,
        seen: [f64; 2],
        answer: Option<&Answer>,
    ) -> Option<Picture>;

    /// The initial values that a point of the picture stands for, if it stands for some.
    fn start(
        &self,
        _plot: &Plot,
        _physics: Physics<'_>,
        _at: [f64; 2],
    ) -> Option<[InitialOverride; 2]> {
        None
    }

    /// What is to be computed on the side for the picture, with what came of it last.
    fn job(&self, _plot: &Plot, _present: &Present<'_>, _answer: Option<&Answer>) -> Need {
        Need::Nothing
    }

    /// The numbers that can be claimed of it.
    fn measures(&self) -> &'static [Measure] {
        &[]
    }
}

/// One axis of a kind: a key of files and sessions, and a step of choosing.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    /// The key.
    pub key: &'static str,
    /// The heading of the list from which it is chosen.
    pub heading: &'static str,
    /// Whether it takes several quantities.
    pub several: bool,
    /// Whether only a coordinate will do, for all else is held while it varies.
    pub coordinate: bool,
}

impl Axis {
    /// One quantity across.
    pub const ACROSS: Self =
        Self { key: "x", heading: "Along the axis", several: false, coordinate: false };
    /// One quantity upwards.
    pub const UPWARDS: Self =
        Self { key: "y", heading: "Upwards", several: false, coordinate: false };
}

/// Something a person can choose for a pane.
#[derive(Clone, Debug)]
pub struct Offer {
    /// Its name.
    pub label: String,
    /// What it is, in a line.
    pub about: String,
    /// The columns that are chosen with it; the further ones are asked for.
    pub columns: Columns,
    /// The view of the file it shows.
    pub view: Option<usize>,
}

/// A number of a plot that a script can make a claim of: `Assert KIND.WORD > 2`.
pub struct Measure {
    /// The word.
    pub word: &'static str,
    /// What it is, in a line.
    pub about: &'static str,
    /// Its value; nothing where there is none.
    pub value: fn(&Plot, &Present<'_>, Option<&Answer>) -> Option<f64>,
}

/// What a job of an instrument came to. Its own file knows the type.
#[derive(Clone)]
pub struct Answer(Arc<dyn Any + Send + Sync>);

/// What is to be computed for a picture.
#[derive(Debug)]
pub enum Need {
    /// Nothing is; an answer of before is dropped.
    Nothing,
    /// What is there still holds.
    Held,
    /// This. Until it is there the last answer stays.
    Job(Job<Answer>),
}

impl Answer {
    /// A result as it is handed on.
    pub fn new(result: impl Any + Send + Sync) -> Self {
        Self(Arc::new(result))
    }

    /// The result, if it is of this type.
    pub fn of<T: Any>(&self) -> Option<&T> {
        self.0.downcast_ref()
    }
}

impl fmt::Debug for Answer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Answer")
    }
}

/// Answers are equal where they are the same.
impl PartialEq for Answer {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for dyn Instrument {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl PartialEq for dyn Instrument {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

/// The kind of a name.
pub fn named(name: &str) -> Option<&'static dyn Instrument> {
    INSTRUMENTS.into_iter().find(|kind| kind.name() == name)
}

/// The names of all kinds, with a word before the last: `a, b and c`.
pub fn listed(quote: &str, before_last: &str) -> String {
    let names: Vec<String> =
        INSTRUMENTS.iter().map(|kind| format!("{quote}{}{quote}", kind.name())).collect();
    match names.split_last() {
        Some((last, rest)) if !rest.is_empty() => {
            format!("{} {before_last} {last}", rest.join(", "))
        }
        _ => names.concat(),
    }
}

/// What can be chosen for a pane: first what is chosen as a whole or begins with no quantity, then the quantities.
pub fn offers(physics: Physics<'_>) -> Vec<(&'static dyn Instrument, Offer)> {
    let of = |kind: &'static dyn Instrument| {
        kind.offers(physics).into_iter().map(move |offer| (kind, offer))
    };
    let mut all: Vec<_> = INSTRUMENTS.into_iter().flat_map(of).collect();
    all.sort_by_key(|(_, offer)| !offer.columns.is_empty());
    all
}

/// Whether a view of the file is of a kind.
fn is_view_of(model: &Model, view: usize, kind: &dyn Instrument) -> bool {
    model.views.get(view).is_some_and(|view| view.kind == kind.name())
}
