//! The table of methods. To add one, write its file, ending in its row, and add its line here;
//! picker, command line, documents and tests follow.

use super::method::Method;
use super::{dop853, gauss, leapfrog, rk4, symplectic_euler, taylor, yoshida};

/// The table; the first row is the default.
pub const METHODS: &[Method] = &[
    taylor::METHOD,
    leapfrog::METHOD,
    yoshida::FOURTH_ORDER,
    yoshida::SIXTH_ORDER,
    yoshida::EIGHTH_ORDER,
    gauss::FOURTH_ORDER,
    gauss::SIXTH_ORDER,
    symplectic_euler::METHOD,
    dop853::METHOD,
    rk4::METHOD,
];

/// Returns the method of a name; `auto` is the first.
pub fn method_named(name: &str) -> Option<&'static Method> {
    if name == "auto" {
        return METHODS.first();
    }
    METHODS.iter().find(|method| method.name == name)
}
