//! A separatrix: a top of the effective potential with ∮ p dq of its lobes, of libration below it and of a turn above it.
//!
//! In: a top, and the actions of its lobes. Out: [`Separatrix`]. Never here: how an action is computed.
//! Source: *The Principles of Dynamics*, § 4.2.

use super::EffectivePotential;

/// A separatrix, and ∮ p dq of each of its lobes, from left to right; of a coordinate with a period, of one turn.
#[derive(Clone, PartialEq, Debug)]
pub struct Separatrix {
    /// The energy at the top.
    pub energy: f64,
    /// The actions; infinite where a lobe does not close.
    pub actions: Vec<f64>,
    /// Of the highest top of a coordinate with a period: the action of one turn, which goes one way only.
    pub turn: Option<f64>,
}

impl Separatrix {
    /// The separatrix of a top with the actions of its lobes.
    pub fn of(
        potential: &EffectivePotential<'_>,
        [_, energy]: [f64; 2],
        actions: Vec<f64>,
    ) -> Separatrix {
        let highest = potential.tops().iter().all(|other| other[1] <= energy);
        let turns = potential.period().is_some() && highest && actions.len() == 1;
        let turn = actions.first().filter(|_| turns).map(|action| 0.5 * action);
        Separatrix { energy, actions, turn }
    }
}
