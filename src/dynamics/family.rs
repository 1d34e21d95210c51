//! A family of periodic orbits: its members, and the folds and bifurcations between them.
//!
//! In: orbits with their values. Out: these data, and what becomes of the neighbours of a member. Never here: how a family is followed; see `continuation`.

use super::orbit::Orbit;
use super::orbit_stability::OrbitStability;
use crate::num::math;

/// Of a family whose orbits are not isolated.
pub const NOT_ISOLATED: &str = "each orbit has others of the same value beside it: the family has more parameters, and one path through it is followed";

/// The quantity that changes along a family.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Along {
    /// Members differ by their energies.
    Energy,
    /// Members differ by their periods.
    Period,
    /// The parameter of this index; the energy or the period stays what it is.
    Parameter(usize),
}

/// A bifurcation of a family at an orbit.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Bifurcation {
    /// It turns back.
    Fold,
    /// A multiplier passes −1: orbits of twice the period branch off.
    PeriodDoubling,
    /// A multiplier passes 1 without a fold: others of the same period branch off.
    Branching,
}

impl Bifurcation {
    /// Its name in reports.
    pub fn word(self) -> &'static str {
        match self {
            Bifurcation::Fold => "fold",
            Bifurcation::PeriodDoubling => "period doubling",
            Bifurcation::Branching => "branching",
        }
    }
}

/// An orbit of a family.
#[derive(Clone, Debug)]
pub struct Member {
    /// What changes along the family, here.
    pub value: f64,
    /// A closed one, corrected by Newton's method.
    pub orbit: Orbit,
    /// What happens here; `None` at the values asked for.
    pub bifurcation: Option<Bifurcation>,
}

impl Member {
    /// Its stability, to first order. Where it bifurcates and volumes across it are preserved, two multipliers have met
    /// at 1 or −1, and the others decide; they are known to the part of a step to which the place is.
    pub fn stability(&self) -> OrbitStability {
        let meets = match self.bifurcation {
            Some(Bifurcation::Fold | Bifurcation::Branching) => 1.0,
            Some(Bifurcation::PeriodDoubling) => -1.0,
            None => return self.orbit.stability(),
        };
        if !self.orbit.preserves_volume() {
            return self.orbit.stability();
        }
        let known = self.orbit.known();
        let off = |&i: &usize| {
            let [re, im] = known.multipliers[i];
            math::hypot(re - meets, im)
        };
        let mut others: Vec<usize> = (0..known.multipliers.len()).collect();
        others.sort_by(|a, b| off(a).total_cmp(&off(b)));
        if others.iter().skip(2).any(|&i| known.is_outside(i)) {
            OrbitStability::Unstable
        } else {
            OrbitStability::Parabolic
        }
    }

    /// Whether no multiplier lies outside the unit circle; `None` where that is not known.
    pub fn is_stable(&self) -> Option<bool> {
        match self.stability() {
            OrbitStability::Parabolic => None,
            OrbitStability::Unstable => Some(false),
            _ => self.orbit.is_stable(),
        }
    }
}

/// A family as far as it was followed.
#[derive(Clone, Debug)]
pub struct Family {
    /// Its members in their order along it.
    pub members: Vec<Member>,
    /// Why it was not followed to the end of the values on either side.
    pub ended: Vec<String>,
    /// Whether each orbit is the only one beside it with its value of what changes. Of others the one in whose direction that
    /// changes most is followed.
    pub isolated: bool,
}
