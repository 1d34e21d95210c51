//! The pane with the flow map: symplectic to rounding for the exact flow and a symplectic method, not for another one; and the
//! decay of its determinant under friction.

use crate::record::played;

#[test]
fn the_map_of_a_method_is_held_beside_the_exact_flow() {
    played(
        "back-to-the-start",
        "Open back-to-the-start\nSize 120x40\nSet eps = 0.5\nWait 3s\n\
         Assert flow.residual < 1e-13\nAssert flow.determinant > 0.9999999999\nAssert flow.determinant < 1.0000000001\n\
         Press :\nType \"method rk4\"\nPress Enter\nWait 1s\n\
         Assert flow.residual > 1e-10\nAssert flow.exact_residual < 1e-13\n\
         Press :\nType \"method leapfrog\"\nPress Enter\nWait 1s\n\
         Assert flow.residual < 1e-12\nAssert flow.expected = 1 within 1e-15\n",
    );
}

/// det M = exp(−c t/m), by closed form: at t = 3, with c/m = 0.4, e^(−1.2), to the time between two points.
#[test]
fn under_friction_the_determinant_decays() {
    played(
        "damped-oscillator",
        "Open damped-oscillator\nSize 120x40\nWait 3s\n\
         Assert flow.determinant > 0.300\nAssert flow.determinant < 0.312\n\
         Assert flow.expected > 0.300\nAssert flow.expected < 0.312\n",
    );
}
