//! Whether an action is an adiabatic invariant of a change.
//!
//! In: relative changes. Out: yes or no. Never here: where they come from, changes too small to tell.
//! Source: *The Principles of Dynamics*, § 4.3.

/// The part of what drives it, and of itself, by which an action may change: beside a parameter that grows manifold or changes
/// its sign it must not change with it.
const FAR_LESS: f64 = 0.1;

/// Whether an action that has changed by a part of itself has stayed, beside what drives it: a parameter, or the height of the
/// energy above the bottom of its well, by a part of that.
pub fn is_adiabatic(action: f64, driven: f64) -> bool {
    action.abs() <= FAR_LESS * driven.abs().min(1.0)
}

#[cfg(test)]
mod tests {
    use super::is_adiabatic;

    #[test]
    fn an_action_stays_within_a_tenth_of_what_drives_it_and_of_itself() {
        for driven in [0.3, -0.3] {
            assert!(is_adiabatic(0.029, driven) && is_adiabatic(-0.029, driven));
            assert!(!is_adiabatic(0.031, driven) && !is_adiabatic(-0.031, driven));
        }
        // a hundredfold stiffness allows no more
        assert!(is_adiabatic(-0.09, 99.0) && !is_adiabatic(-0.28, 99.0));
    }
}
