//! How many numbers a state has, and where each stands.
//!
//! In: a compiled system. Out: lengths and places. Never here: the numbers themselves.
//!
//! A state holds the dynamical variables, auxiliary numbers, the components of tangent vectors, and the integrals (action, work),
//! in this order.

use super::{Form, System};

impl System {
    /// The number of coordinates, or of the variables of a Poisson system.
    pub fn degrees(&self) -> usize {
        self.shared.degrees
    }

    /// The number of dynamical variables of a state: coordinates and as many rates, or the
    /// variables of a Poisson system.
    pub fn moving(&self) -> usize {
        if self.form() == Form::Variables { self.degrees() } else { 2 * self.degrees() }
    }

    /// The number of dynamical variables and auxiliary numbers: everything that the rates of the
    /// motion depend on.
    pub fn motion_len(&self) -> usize {
        self.moving() + self.shared.auxiliary.outputs()
    }

    /// The number of dynamical variables, auxiliary numbers and components of tangent vectors:
    /// everything that the rates of change depend on.
    pub fn driven_len(&self) -> usize {
        self.motion_len() + self.tangents() * self.moving()
    }

    /// The length of a state: the numbers that rates depend on, and the integrals.
    pub fn state_len(&self) -> usize {
        self.driven_len() + self.shared.quadratures.count()
    }

    /// Whether a state carries the action and the work, in this order.
    pub(super) fn carries(&self) -> [bool; 2] {
        let quadratures = self.quadratures();
        [quadratures.action, quadratures.work]
    }

    /// The index in a state of the nine entries of an attitude, in row-major order.
    pub(crate) fn attitude_place(&self) -> Option<usize> {
        self.shared.attitude.map(|place| self.moving() + place)
    }

    /// The index in a state of the coordinates of the comparison motion, which its velocities follow.
    pub fn comparison_place(&self) -> Option<usize> {
        self.shared.comparison.map(|place| self.moving() + place)
    }

    /// The index in a state of the work done on it.
    pub fn work_place(&self) -> Option<usize> {
        let quadratures = self.quadratures();
        quadratures.work.then(|| self.driven_len() + usize::from(quadratures.action))
    }
}
