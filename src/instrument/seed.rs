//! Orbits that a person adds to a section, and where a cloud begins.
//!
//! In: windows and points of a plane. Out: [`Seed`]s, which sessions keep. Never here: the orbits.

use serde::{Deserialize, Serialize};

/// Orbits added to a section, or the place of a cloud.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Seed {
    /// Orbits whose starts are spread over a window.
    Spread([[f64; 2]; 2]),
    /// Many orbits of a section, with many crossings each, whose starts are spread over a window.
    Fill([[f64; 2]; 2]),
    /// The orbit through a point.
    Through([f64; 2]),
    /// Starts spread over the states of the motion's energy.
    Shell,
}

/// The most additions to a section.
pub const MOST_SEEDS: usize = 32;
