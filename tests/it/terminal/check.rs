//! What `check` says on a terminal where there is nothing to report.

use super::session::Setup;

const PROGRAM: &str = env!("CARGO_BIN_EXE_phaselab");

/// A kick changes the momentum of the rotor and its energy, which are conserved from one to the next only.
#[test]
fn what_impulses_change_is_conserved_between_them() {
    for (name, sentence) in [
        ("pendulum", "pendulum: no errors; 1 coordinate, conserved: E"),
        (
            "kicked-rotor",
            "kicked-rotor: no errors; 1 coordinate, conserved between impulses: p_theta, E",
        ),
    ] {
        let mut checked = Setup::new(PROGRAM, &["check", name]).size(160, 24).start();
        assert_eq!(checked.ends().0, 0, "{name}");
        assert!(checked.text().contains(sentence), "{}", checked.text());
    }
}
