//! What all kinds of plots and instruments have in common: the trait, its axes, choices and measures, and the contents of
//! a pane, which are of a kind.
//!
//! In: a model and the current state. Out: words, pictures as data, jobs. Never here: the list of kinds, or what a single
//! one does.

use std::fmt;
use std::sync::Arc;

use super::{
    Across, Answer, Entry, Heading, Need, PeriodicOrbits, Physics, Picture, PlotTable, Present,
    Seed, Sight,
};
use crate::model::{Variation, View};
use crate::system::InitialOverride;

/// The channels of each axis, in the order of the axes.
pub type Columns = Vec<Vec<usize>>;

/// The contents of a pane.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// The row of the table that draws it.
    pub kind: &'static dyn Instrument,
    /// The channels chosen for its axes.
    pub columns: Columns,
    /// The view of the file that it shows, if nothing is chosen.
    pub view: Option<usize>,
    /// What it runs over, in the order of the axes.
    pub over: Vec<Variation>,
    /// The camera or the window.
    pub sight: Sight,
    /// The orbits added to a section.
    pub seeds: Vec<Seed>,
}

/// What a plot is drawn from.
#[derive(Clone, Copy)]
pub struct PlotContext<'a> {
    /// The plot, with the channels chosen for its axes.
    pub plot: &'a Plot,
    /// The current state of the motion.
    pub present: &'a Present<'a>,
    /// The last result of its job.
    pub answer: Option<&'a Answer>,
}

/// A kind of plot: one row of [`INSTRUMENTS`](super::INSTRUMENTS). Common behaviour has defaults.
pub trait Instrument: Sync {
    /// Its constants.
    fn properties(&self) -> &'static Properties;

    /// Its name in files, sessions and assertions.
    fn name(&self) -> &'static str {
        self.properties().name
    }

    /// The axes that the user chooses, in order. A kind without them shows a view of the file.
    fn chosen(&self) -> &'static [Axis] {
        let properties = self.properties();
        properties.chosen.unwrap_or(properties.written)
    }

    /// The number that a script asserts by this word.
    fn measure(&self, word: &str) -> Option<&'static Measure> {
        self.properties().measures.iter().find(|measure| measure.word == word)
    }

    /// Whether it can show this view of the file, or be without one.
    fn shows(&self, view: Option<&View>) -> bool {
        match view {
            Some(view) => view.kind == self.name(),
            None => !self.properties().shows_a_view,
        }
    }

    /// Whether its two quantities are a plane with one scale, where units and places do not say it.
    fn is_plane(&self, _plot: &Plot, _physics: Physics<'_>) -> Option<bool> {
        None
    }

    /// What the lab opens with besides the views of the file, as the columns of its axes.
    fn opening(&self, _physics: Physics<'_>) -> Vec<Columns> {
        Vec::new()
    }

    /// The choices offered to the user.
    fn offers(&self, physics: Physics<'_>) -> Vec<Offer>;

    /// Its name without a picture: in lists and in plain text.
    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String;

    /// The line above the picture.
    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading>;

    /// What is counted in its picture as it is drawn; it stands first in the line above it.
    fn counted(&self, _context: PlotContext<'_>) -> Option<Entry> {
        None
    }

    /// The horizontal range.
    fn across(&self, context: PlotContext<'_>) -> Across;

    /// The picture over a horizontal range, or `None` if there is nothing to draw.
    fn picture(&self, context: PlotContext<'_>, seen: [f64; 2]) -> Option<Picture>;

    /// What it will show and what begins it, while there is none of it yet, or why there is none: said in place of empty axes.
    fn awaits(&self, _context: PlotContext<'_>) -> Option<String> {
        None
    }

    /// The initial values that a point of the picture represents.
    ///
    /// # Errors
    /// Returns an error if points of the picture are no initial values, or if this one is none.
    fn start(&self, _context: PlotContext<'_>, _at: [f64; 2]) -> StartValues {
        Err(NoStart::Nothing)
    }

    /// The parameters, and their values, that a point of the picture stands for.
    fn parameters_at(&self, _plot: &Plot, _at: [f64; 2]) -> Vec<(usize, f64)> {
        Vec::new()
    }

    /// The further orbits that are spread over what a viewport shows, if it is a section of orbits.
    fn seed(&self, _context: PlotContext<'_>) -> Option<Seed> {
        None
    }

    /// The background job that the picture needs, given the last result.
    fn job(&self, _context: PlotContext<'_>) -> Need {
        Need::Nothing
    }

    /// What of the last result stays when the law is replaced and the motion continues; `None` if nothing does.
    fn inherited(&self, _answer: &Answer) -> Option<Answer> {
        None
    }

    /// Up to when the last result is known, of what is carried along beside the motion: pictures of such results show the
    /// same time.
    fn known_until(&self, _answer: &Answer) -> Option<f64> {
        None
    }

    /// The periodic orbits that its job has found, which sections mark.
    fn periodic(&self, _answer: &Answer) -> Option<Arc<PeriodicOrbits>> {
        None
    }

    /// What its job has computed, as a table to be written to a file; `None` if it is the motion itself.
    fn table(&self, _context: PlotContext<'_>) -> Option<PlotTable> {
        None
    }
}

/// What is the same for all plots of a kind.
pub struct Properties {
    /// Its name in files, sessions and assertions.
    pub name: &'static str,
    /// The axes that a view of a file specifies.
    pub written: &'static [Axis],
    /// The axes that the user chooses, in order, if they are not those of a view.
    pub chosen: Option<&'static [Axis]>,
    /// The curve of the motion itself that it draws over its axes, if that is what it shows.
    pub curve: Option<MotionCurve>,
    /// The kind that a key shows in its place, with the same axes.
    pub other: Option<&'static dyn Instrument>,
    /// Whether it shows shapes through a camera, so that a file may give it a frame and its own shapes.
    pub is_scene: bool,
    /// Whether it is a curve over the time, which a wide and flat pane suits.
    pub is_over_time: bool,
    /// Whether it shows a surface of section, which a file specifies beside its axes.
    pub is_section: bool,
    /// Whether it runs over the range of a parameter, which a file names in `over`.
    pub is_over_a_parameter: bool,
    /// Whether it follows motions for a time, at whose end, or up to whose first crossing of a surface, a number is taken.
    pub follows_motions: bool,
    /// Whether a person adds starts to it by a key: through a point, or over what is seen.
    pub takes_seeds: bool,
    /// Whether it shows a view of the file, besides what is chosen.
    pub shows_a_view: bool,
    /// Whether it can colour its orbits by whether they are regular.
    pub classifies_orbits: bool,
    /// Whether it draws the vector field of its plane, where that has one.
    pub has_vector_field: bool,
    /// Whether its axes share a unit that can be drawn at the same scale on both.
    pub has_equal_axes: bool,
    /// The horizontal position that stays fixed when zooming, as a fraction of the width.
    pub anchor: f64,
    /// The text before its words in a list, if these are only names of quantities.
    pub lead: &'static str,
    /// The numbers that a script can assert about it.
    pub measures: &'static [Measure],
}

impl Properties {
    /// Those of a kind without axes and without anything special.
    pub(super) const PLAIN: Self = Self {
        name: "",
        written: &[],
        chosen: None,
        curve: None,
        other: None,
        is_scene: false,
        is_over_time: false,
        is_section: false,
        is_over_a_parameter: false,
        follows_motions: false,
        takes_seeds: false,
        shows_a_view: false,
        classifies_orbits: false,
        has_vector_field: false,
        has_equal_axes: false,
        anchor: 0.5,
        lead: "",
        measures: &[],
    };

    /// Whether its axes are new variables of a transformation.
    pub fn is_transformed(&self) -> bool {
        self.written.iter().any(|axis| axis.transformed)
    }
}

/// How a plot draws the motion itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionCurve {
    /// Quantities over the time.
    AgainstTime,
    /// One quantity over another.
    Portrait,
}

/// An axis of a kind: a key of files and sessions, and a step of the choice.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    /// Its key in files and sessions.
    pub key: &'static str,
    /// The heading of the list of choices.
    pub heading: &'static str,
    /// Whether it takes several quantities.
    pub several: bool,
    /// Whether it must be a coordinate, because everything else is fixed while it varies.
    pub coordinate: bool,
    /// Whether it must be a new variable of a transformation.
    pub transformed: bool,
    /// Whether it must be a parameter or an initial value, which differs between the motions of the picture.
    pub varied: bool,
}

impl Axis {
    /// One quantity on the horizontal axis.
    pub const ACROSS: Self = Self {
        key: "x",
        heading: "Horizontal axis",
        several: false,
        coordinate: false,
        transformed: false,
        varied: false,
    };
    /// One quantity on the vertical axis.
    pub const UPWARDS: Self = Self {
        key: "y",
        heading: "Vertical axis",
        several: false,
        coordinate: false,
        transformed: false,
        varied: false,
    };
}

/// A choice for the contents of a pane.
#[derive(Clone, Debug, Default)]
pub struct Offer {
    /// Its name.
    pub label: String,
    /// A description on one line.
    pub about: String,
    /// The columns chosen with it; the user is asked for the remaining ones.
    pub columns: Columns,
    /// The view of the file that it shows.
    pub view: Option<usize>,
    /// What it runs over, where no view says so.
    pub over: Vec<Variation>,
}

impl Offer {
    /// Quantities on axes, without a view of the file.
    pub(super) fn new(
        label: impl Into<String>,
        about: impl Into<String>,
        columns: Columns,
    ) -> Self {
        Self { label: label.into(), about: about.into(), columns, ..Self::default() }
    }
}

/// The initial values that a point of a picture stands for.
pub type StartValues = Result<Vec<InitialOverride>, NoStart>;

/// Why a point of a picture does not begin a motion.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoStart {
    /// No point of the picture does.
    Nothing,
    /// This one does not, for the reason given in a sentence.
    Refused(String),
}

/// A number of a plot that a script can assert: `Assert KIND.WORD > 2`.
pub struct Measure {
    /// Its word in scripts: `KIND.WORD`.
    pub word: &'static str,
    /// A description on one line.
    pub about: &'static str,
    /// Its value, or `None` if it has none.
    pub value: fn(PlotContext<'_>) -> Option<f64>,
}

impl Measure {
    pub(super) const fn new(
        word: &'static str,
        about: &'static str,
        value: fn(PlotContext<'_>) -> Option<f64>,
    ) -> Self {
        Self { word, about, value }
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
