//! A family of periodic orbits: its members, and the folds and bifurcations between them.
//!
//! In: orbits with their values. Out: nothing but these data. Never here: how a family is followed; see `continuation`.

use super::orbit::Orbit;

/// What changes along a family.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Along {
    /// The energy.
    Energy,
    /// The period.
    Period,
    /// The parameter of this index; the energy or the period stays what it is.
    Parameter(usize),
}

/// What happens to a family at an orbit.
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
    /// Its name.
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
    /// The orbit.
    pub orbit: Orbit,
    /// What happens here; `None` at the values asked for.
    pub bifurcation: Option<Bifurcation>,
}

/// A family as far as it was followed.
#[derive(Clone, Debug)]
pub struct Family {
    /// Its members in their order along it.
    pub members: Vec<Member>,
    /// Why it was not followed to the end of the values on either side.
    pub ended: Vec<String>,
    /// Whether the work was cancelled.
    pub cancelled: bool,
}
