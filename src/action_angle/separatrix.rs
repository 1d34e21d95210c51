//! A separatrix: tops of the effective potential with ∮ p dq of their lobes, of libration below it and of a turn above it.
//!
//! In: an effective potential. Out: [`Separatrix`]. Never here: how an action is computed.
//! Source: *The Principles of Dynamics*, § 4.2.

use super::quadrature::{action_between, common_part};
use super::row::SAME;
use super::{AllowedInterval, EffectivePotential};
use crate::ensemble::NotOnShell;

/// A separatrix, and ∮ p dq of each of its lobes, from left to right; of a coordinate with a period, of one turn.
#[derive(Clone, PartialEq, Debug)]
pub struct Separatrix {
    /// The energy at the top.
    pub energy: f64,
    /// The actions; infinite where a lobe does not close.
    pub actions: Vec<f64>,
    /// Of the highest top of a coordinate with a period: the actions of one turn, to the right and to the left.
    pub turn: Option<[f64; 2]>,
}

/// The lobes of tops of the same energy that are connected with each other.
struct Lobes {
    energy: f64,
    lobes: Vec<AllowedInterval>,
}

impl Separatrix {
    /// The separatrices, from left to right; those found before `stop` if that asks for an end.
    ///
    /// # Errors
    /// Returns an error if a lobe has no momentum somewhere.
    pub fn all(
        potential: &mut EffectivePotential<'_>,
        mut stop: impl FnMut() -> bool,
    ) -> Result<Vec<Separatrix>, NotOnShell> {
        let mut all = Vec::new();
        for Lobes { energy, lobes } in connected(potential) {
            let mut actions = Vec::new();
            for lobe in &lobes {
                actions.push(match (lobe.left, lobe.right) {
                    (Some(left), Some(right)) => action_between(potential, left, right, energy)?,
                    _ => f64::INFINITY,
                });
                if stop() {
                    return Ok(all);
                }
            }
            let turn = match potential.period().filter(|_| is_of_rotation(potential, energy)) {
                Some(period) => {
                    let half = 0.5 * actions.iter().sum::<f64>();
                    let common = common_part(potential, (period, half), energy)?;
                    let is_same = common.abs() <= SAME * half;
                    Some(if is_same { [half; 2] } else { [half + common, half - common] })
                }
                None => None,
            };
            all.push(Separatrix { energy, actions, turn });
        }
        Ok(all)
    }
}

/// The lobes of each top; tops of the same energy that share a lobe have one separatrix. The lobes of the highest tops of a
/// period fill it, since it begins at such a top.
fn connected(potential: &mut EffectivePotential<'_>) -> Vec<Lobes> {
    let mut all: Vec<Lobes> = Vec::new();
    for top in potential.profile.tops() {
        let mut lobes = potential.lobes(top);
        if let Some(last) = all.last_mut()
            && potential.profile.is_same_energy(last.energy, top[1])
            && let (Some(before), Some(first)) = (last.lobes.last(), lobes.first())
            && is_same_lobe(*before, *first)
        {
            last.energy = last.energy.max(top[1]);
            last.lobes.extend(lobes.drain(1..));
        } else {
            all.push(Lobes { energy: top[1], lobes });
        }
    }
    all
}

/// Whether two lobes have the same ends, to what is known of the place of a top.
fn is_same_lobe(one: AllowedInterval, other: AllowedInterval) -> bool {
    let ends = [one.left.zip(other.left), one.right.zip(other.right)];
    let width = one.left.zip(one.right).map_or(0.0, |(left, right)| right - left);
    ends.iter().all(|end| end.is_some_and(|(a, b)| (a - b).abs() <= 1e-4 * width))
}

/// Whether beyond an energy the coordinate goes round and round.
fn is_of_rotation(potential: &EffectivePotential<'_>, energy: f64) -> bool {
    let tops = potential.profile.tops();
    let is_below = |other: f64| other <= energy || potential.profile.is_same_energy(other, energy);
    potential.period().is_some() && tops.iter().all(|top| is_below(top[1]))
}
