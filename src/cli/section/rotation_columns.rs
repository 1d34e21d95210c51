//! The rotation number of an orbit from its crossings of a section.
//!
//! In: the names of one or two columns, rows. Out: the rotation number. Never here: how crossings are found.

use super::super::error::CommandError;
use super::super::motion_options::CompiledMotion;
use crate::dynamics::{NoRotation, Rotation, angle_rotation, rotation};
use crate::printable;

/// What turns from one crossing to the next: the places of one or two columns in a row, and their periods.
pub(super) struct RotationColumns {
    places: Vec<usize>,
    periods: [Option<f64>; 2],
}

impl RotationColumns {
    pub(super) fn of(
        compiled: &CompiledMotion,
        names: &[String],
    ) -> Result<RotationColumns, CommandError> {
        let wrong = |why: String| Err(CommandError::WrongUse(format!("--rotation: {why}")));
        if names.is_empty() || names.len() > 2 {
            return wrong("name one column that is an angle, or two columns".to_owned());
        }
        let columns = compiled.header().columns;
        let mut turning = RotationColumns { places: Vec::new(), periods: [None; 2] };
        for (i, name) in names.iter().enumerate() {
            let called = name.split_once('=').map_or(name.as_str(), |(name, _)| name).trim();
            let place = columns.iter().position(|column| column == called);
            let Some(place) = place.filter(|&place| place > 0) else {
                return wrong(format!("unknown column `{}`", printable::quoted(called)));
            };
            turning.places.push(place);
            turning.periods[i] = compiled.system.period(place - 1, &compiled.start.parameters);
        }
        if names.len() == 1 && turning.periods[0].is_none() {
            return wrong(format!(
                "`{}` has no period, so two columns are needed to count turns, such as {0},p_{0}",
                printable::quoted(&names[0])
            ));
        }
        Ok(turning)
    }

    pub(super) fn rotation(&self, rows: &[Vec<f64>]) -> Result<Rotation, NoRotation> {
        match (&self.places[..], self.periods) {
            (&[x, y], periods) => {
                let points: Vec<[f64; 2]> = rows.iter().map(|row| [row[x], row[y]]).collect();
                rotation(&points, periods)
            }
            (&[x], [Some(period), _]) => {
                let angle: Vec<f64> = rows.iter().map(|row| row[x]).collect();
                angle_rotation(&angle, period)
            }
            _ => Err(NoRotation::TooFew(rows.len())),
        }
    }
}
