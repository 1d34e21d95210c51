//! What a section says of regular and chaotic orbits: rotation numbers and colours.
//!
//! In: crossings. Out: words and colours. Never here: how a rotation number is measured (`dynamics`).

use super::super::{Ink, Physics, Plot, Present, Seed};
use super::portrait::Portrait;
use crate::dynamics::{Rotation, rotation};
use crate::num::math;

/// The newest crossings of the running motion by which its rotation number is measured.
const COUNT_OWN: usize = 1000;

/// The rotation number of the running motion on a surface, if it has one, by its newest crossings.
pub(super) fn own_rotation(plot: &Plot, present: &Present<'_>, section: usize) -> Option<Rotation> {
    let Physics { system, .. } = present.physics;
    let axes = [plot.column(0)?, plot.column(1)?];
    let rows = present.crossings.rows(section, present.values.len());
    let newest = rows.rev().take(COUNT_OWN).map(|row| axes.map(|axis| row[1 + axis]));
    let mut points: Vec<[f64; 2]> = newest.collect();
    points.reverse();
    rotation(&points, axes.map(|axis| system.period(axis, present.parameters))).ok()
}

/// The rotation number of the newest orbit, if it goes through a point that a person chose; a list would cover the picture.
pub(super) fn newest_rotation(portrait: &Portrait) -> Option<String> {
    let chosen = matches!(portrait.seeds.last(), Some(Seed::Through(_)));
    let newest = portrait.orbits.last().filter(|_| chosen)?;
    Some(match &newest.rotation {
        Ok(found) => {
            format!("rotation {}", to_its_error(found.number, found.error))
        }
        Err(why) => format!("no rotation number: {why}"),
    })
}

/// A number between 0 and 1 with the decimals that its error leaves.
pub(super) fn to_its_error(number: f64, error: f64) -> String {
    let decimals = (1..12).take_while(|k| error < 0.5 * math::powi(10.0, -k)).count();
    format!("{number:.decimals$}")
}

/// Whether orbits are coloured by whether they are regular.
pub(super) fn by_chaos(plot: &Plot) -> bool {
    plot.viewport().is_some_and(|viewport| viewport.by_chaos)
}

/// The colour of an orbit that is regular, chaotic, or neither for sure.
pub(super) fn chaos_ink(regular: Option<bool>) -> Ink {
    match regular {
        Some(true) => Ink::Curve(0),
        Some(false) => Ink::Warn,
        // the faintest: nothing is said of it
        None => Ink::Level,
    }
}
