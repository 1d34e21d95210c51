//! The table of instruments: every kind of plot is one row here and one file.
//!
//! A file of this room defines one kind: its name in files, sessions and assertions, the keys of a view, the choices
//! of the user, what it opens with, its title, its picture as data, its background job, and its measures. In: a
//! system and its current state. Out: [`Plot`]s, [`Picture`]s, [`Job`](crate::job::Job)s. Never here: cells and
//! colours (`view` draws any picture), keys, threads.

mod action;
mod actions;
mod angle;
mod answer;
mod closed_orbit;
mod conditions;
mod diagram;
mod ensemble;
mod equilibria;
mod exponents;
mod family;
mod field_plane;
mod flow;
mod frequency;
mod kind;
mod legendre;
mod map;
mod mode_amplitude;
mod motion_state;
mod opening;
mod orbit;
mod orbit_crossings;
mod path_so_far;
mod paths;
mod periodic_points;
mod phase;
mod picture;
mod plot;
mod plot_table;
mod potential;
mod present;
mod saved;
mod section;
mod seed;
mod separation;
mod sight;
mod space;
mod spectrum;
mod straight_line;
mod table;
mod time;
mod transformation;
mod varied;
mod vector_field;

pub use answer::{Answer, Need};
pub use equilibria::{
    FoundEquilibria, classes, described, described_mode, displaced, equilibria_search, start_along,
    start_at, value_at,
};
pub use field_plane::{NoField, has_field};
pub use kind::{
    Axis, Columns, Instrument, Measure, MotionCurve, NoStart, Offer, Plot, PlotContext, Properties,
    StartValues,
};
pub use periodic_points::{PeriodicOrbits, PeriodicPoints};
pub use picture::{
    Across, Entry, Field, Heading, Ink, Layer, Level, MarkerShape, Picture, Stroke, Upwards,
};
pub use plot_table::PlotTable;
pub use potential::PotentialView;
pub use present::{Physics, Present, Returned};
pub use saved::{Quantity, SavedPlot, SavedVariations};
pub use seed::{MOST_SEEDS, Seed};
pub use sight::{CameraPose, Sight, Viewport};
pub use table::{INSTRUMENTS, listed, named, offers};
pub use vector_field::{FieldRates, PlaneField};
