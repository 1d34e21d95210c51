//! The mean time of a return, of a coordinate whose rate depends on other coordinates as well.
//!
//! In: a row whose returns take different times. Out: their mean, 1/ν with ν = ∂E/∂J at constant other actions. The times of
//! the returns are a smooth function along the turning of the other coordinates, so that their weighted average settles soon.
//! Never here: whether the times differ.

use super::row::follow;
use super::{ActionRow, ActionSystems, EffectivePotential, NoAction, RegionKind};
use crate::ensemble::{Root, Start};
use crate::num::birkhoff_average;
use crate::system::System;

/// The numbers of returns averaged over, one after the other until the average settles.
const RETURNS: [u64; 5] = [128, 256, 512, 1024, 4096];

/// The average has settled where it differs by this part of it from that over half of the returns.
const SETTLED: f64 = 1e-10;

/// Puts the mean time of a return in the place of the period of the rows that are [uneven](ActionRow::is_uneven).
///
/// # Errors
/// Returns an error if a motion does not return, or a mean does not settle.
pub fn average_returns(
    potential: &mut EffectivePotential<'_>,
    systems: &ActionSystems<'_>,
    rows: &mut [ActionRow],
) -> Result<(), NoAction> {
    for row in rows.iter_mut().filter(|row| row.is_uneven) {
        row.period = mean_return(potential, systems, row)?;
    }
    Ok(())
}

fn mean_return(
    potential: &mut EffectivePotential<'_>,
    systems: &ActionSystems<'_>,
    row: &ActionRow,
) -> Result<f64, NoAction> {
    let MeanStart { start, event, crossings } = MeanStart::of(potential, systems, row)?;
    for returns in RETURNS {
        let found = follow(systems, event, &start, crossings * returns)?;
        let each = crossings as usize;
        let ends = found.iter().skip(each - 1).step_by(each).map(|row| row[0]);
        let times: Vec<f64> = std::iter::once(0.0).chain(ends).collect();
        let times: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let mean = birkhoff_average(&times);
        let half = birkhoff_average(&times[times.len() / 4..3 * times.len() / 4]);
        if has_settled(mean, half) {
            return Ok(mean);
        }
    }
    let why = "the times of its returns have no mean that settles: the other coordinates turn in step with it";
    Err(NoAction::NoReturn(why.to_owned()))
}

/// Whether an average has settled, by that over half of the returns.
fn has_settled(mean: f64, half: f64) -> bool {
    (mean - half).abs() <= SETTLED * mean
}

/// Where the returns that are averaged over begin.
struct MeanStart<'a> {
    start: Start,
    event: (&'a System, usize),
    /// How often it happens in a return.
    crossings: u64,
}

impl<'a> MeanStart<'a> {
    fn of(
        potential: &mut EffectivePotential<'_>,
        systems: &ActionSystems<'a>,
        row: &ActionRow,
    ) -> Result<MeanStart<'a>, NoAction> {
        let no_period = || NoAction::NoReturn("the coordinate has no period".to_owned());
        if let [Some(left), Some(_)] = row.turning_points {
            let start = potential.at_rest(left);
            return Ok(MeanStart { start, event: (systems.turning, systems.turns), crossings: 2 });
        }
        let event = systems.rotating.ok_or_else(no_period)?;
        let way = match row.kind {
            RegionKind::BackwardRotation => Root::Negative,
            _ => Root::Positive,
        };
        let start = potential.moving(0.0, row.energy, way)?;
        Ok(MeanStart { start, event, crossings: 1 })
    }
}

#[cfg(test)]
mod tests {
    use super::has_settled;

    #[test]
    fn an_average_has_settled_to_1e_10_of_it() {
        assert!(has_settled(2.0, 2.0 - 1.9e-10) && !has_settled(2.0, 2.0 - 2.1e-10));
    }
}
