//! The collocation methods of Gauss, of order 4 and 6, in canonical form: symplectic for any H, and
//! through p = ∂L/∂q̇ for any L. The c are the zeros of the Legendre polynomial on [0, 1].
//!
//! In: the coefficients. Out: two rows of the table. Never here: how the stages are solved for.
//!
//! Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, II.1.3.

use super::fixed::FixedStep;
use super::implicit::{self, Implicit};
use super::method::{Method, Preserves, Stepping};
use super::tableau;

pub(super) const FOURTH_ORDER: Method = Method {
    name: "gauss4",
    title: "Gauss, order 4",
    order: Some(4),
    stepping: Stepping::Fixed,
    preserves: Preserves::SymplecticReversible,
    locates_kinks: false,
    stays_within_steps: true,
    needs: "",
    about: "Collocation at two points, solved by iteration: symplectic for any system that has \
            momenta, whatever its H; for brackets it keeps every quadratic Casimir. Hairer, Lubich & Wanner, Geometric Numerical Integration, \
            II.1.3.",
    fits: |system| implicit::fits(&FOURTH_ORDER, system),
    leapfrogs: Vec::new,
    make: |system, settings| {
        implicit::fits(&FOURTH_ORDER, system)?;
        let scheme = Implicit::new(system, tableau::of_two_stages());
        Ok(Box::new(FixedStep::new(FOURTH_ORDER.name, system, settings, scheme)?))
    },
};

pub(super) const SIXTH_ORDER: Method = Method {
    name: "gauss6",
    title: "Gauss, order 6",
    order: Some(6),
    stepping: Stepping::Fixed,
    preserves: Preserves::SymplecticReversible,
    locates_kinks: false,
    stays_within_steps: true,
    needs: "",
    about: "Collocation at three points, solved by iteration: symplectic for any system that has \
            momenta, whatever its H; for brackets it keeps every quadratic Casimir. Hairer, Lubich & Wanner, Geometric Numerical Integration, \
            II.1.3.",
    fits: |system| implicit::fits(&SIXTH_ORDER, system),
    leapfrogs: Vec::new,
    make: |system, settings| {
        implicit::fits(&SIXTH_ORDER, system)?;
        let scheme = Implicit::new(system, tableau::of_three_stages());
        Ok(Box::new(FixedStep::new(SIXTH_ORDER.name, system, settings, scheme)?))
    },
};
