//! The screen: what the laboratory looks like, as cells of a ratatui buffer.
//!
//! In: the application's state and the newest snapshot. Out: cells. Never here: a clock, a terminal, the worker,
//! or a change of anything that is drawn.
//!
//! One file per pane or page. The lower half knows nothing of phaselab and could serve any program that draws curves
//! in a terminal: [`card`], [`colour`], [`glyphs`], [`theme`], [`number`], [`strip`], [`plot`] and [`frame`].

mod bars;
mod canvas;
pub mod caption;
pub mod card;
pub mod colour;
mod cursor;
mod desk;
mod detail;
mod document;
mod equations;
mod found;
pub mod frame;
mod gauges;
pub mod glyphs;
mod help;
mod layout;
mod look;
mod marks;
mod menu;
mod notes;
pub mod number;
mod numbers;
mod phase;
mod picker;
mod plain;
pub mod plot;
mod potential;
mod prompt;
mod quantity;
mod region;
mod screen;
mod series;
pub mod sgr;
mod space;
mod spot;
pub mod strip;
pub mod theme;
mod values;
mod workbench;
mod wrap;

pub use detail::Detail;
pub use look::Look;
pub use screen::draw;
pub use spot::{Spots, spot, spots};
