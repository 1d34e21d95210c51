//! Orbits that a person adds to a section.
//!
//! In: windows and points of a plane. Out: [`Seed`]s, which sessions keep. Never here: the orbits.

use serde::{Deserialize, Serialize};

/// Orbits added to a section.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Seed {
    /// Orbits whose starts are spread over a window.
    Spread([[f64; 2]; 2]),
    /// The orbit through a point.
    Through([f64; 2]),
}

/// The most additions to a section.
pub const MOST_SEEDS: usize = 32;
