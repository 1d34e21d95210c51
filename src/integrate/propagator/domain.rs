//! Where in phase space a motion may go: as far as its velocities stay on one branch, and its energy has a value.
//!
//! In: a system and the state at which the motion begins. Out: whether another state is in its reach. Never here: what is to be done if
//! it is not.

use crate::system::{Branch, Logarithms, State, System};

/// The domain of a motion; by default all of phase space.
#[derive(Default)]
pub(super) struct MotionDomain {
    /// The branch of the velocities, if several belong to the momenta.
    branch: Option<Branch>,
    /// The logarithms of the energy, if it has any.
    logarithms: Option<Logarithms>,
}

impl MotionDomain {
    pub(super) fn around(system: &System, state: &State, parameters: &[f64]) -> MotionDomain {
        MotionDomain {
            branch: system.branch(state, parameters),
            logarithms: system.logarithms(parameters),
        }
    }

    /// Whether it is all of phase space.
    pub(super) fn is_unbounded(&self) -> bool {
        self.branch.is_none() && self.logarithms.is_none()
    }

    pub(super) fn is_on_branch(&mut self, state: &State) -> bool {
        self.branch.as_mut().is_none_or(|branch| branch.holds(state))
    }

    pub(super) fn has_energy(&mut self, state: &State) -> bool {
        self.logarithms.as_mut().is_none_or(|logarithms| logarithms.have_values(state))
    }
}
