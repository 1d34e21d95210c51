//! The leapfrog, also known as the method of Störmer and Verlet.
//!
//! Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, I.1.4.

use super::method::{Method, Preserves, Stepping};
use super::splitting;

pub(super) const METHOD: Method = Method {
    name: "leapfrog",
    title: "Leapfrog (Störmer–Verlet)",
    order: Some(2),
    stepping: Stepping::Fixed,
    preserves: Preserves::SymplecticReversible,
    locates_kinks: false,
    stays_within_steps: true,
    needs: splitting::NEEDS,
    about: "Half a kick, a drift, half a kick: the simplest symplectic method. The energy \
            oscillates a little but does not drift. Hairer, Lubich & Wanner, Geometric Numerical Integration, \
            I.1.4.",
    fits: |system| splitting::fits(&METHOD, system),
    leapfrogs: || vec![1.0],
    make: |system, settings| splitting::make(&METHOD, system, settings),
};
