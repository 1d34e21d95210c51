//! Starts from which more than one motion follows.

use phaselab::integrate::several_motions;

use crate::taylor::Run;

/// The sides to which a motion may leave rest at zero.
fn sides(potential: &str, dissipation: &str, velocity: &str) -> Option<[bool; 2]> {
    let Run { system, parameters, .. } = Run::new(&format!(
        "title = \"Rest\"\n[coordinates]\nx = {{ initial = 0, velocity = {velocity} }}\n[lagrangian]\n\
         L = \"1/2*x'^2 - ({potential})\"\ndissipation = \"{dissipation}\"\n"
    ));
    let state = system.initial(0.0, &parameters, &[]).expect("a state");
    several_motions(&system, &state, &parameters).map(|found| found.sides)
}

#[test]
fn a_top_that_is_not_smooth_is_left_at_any_time() {
    for potential in ["-abs(x)", "-abs(x)^1.5", "-abs(x)^1.2", "-sqrt(x^2)", "-abs(x) - x/3"] {
        assert_eq!(sides(potential, "0", "0"), Some([true; 2]), "{potential}");
    }
    for potential in ["-max(0, x)", "-max(0, x)^1.5"] {
        assert_eq!(sides(potential, "0", "0"), Some([false, true]), "{potential}");
    }
    assert_eq!(sides("-max(0, -x)^1.5", "0", "0"), Some([true, false]));
}

#[test]
fn other_starts_have_one_motion() {
    for potential in [
        "-x^2",
        "x^2",
        "-x^4",
        "abs(x)",
        "abs(x)^1.5",
        "x + abs(x - 5)",
        "-abs(x) - 3*x",
        "cos(x + 1e-9)",
    ] {
        assert_eq!(sides(potential, "0", "0"), None, "{potential}");
    }
    assert_eq!(sides("-abs(x)", "0", "1"), None);
    // friction holds it, or does not
    assert_eq!(sides("-abs(x)", "1.5*abs(x')", "0"), None);
    assert_eq!(sides("-abs(x)", "0.5*abs(x')", "0"), Some([true; 2]));
}

/// The force grows with the power s = p − 1 of the distance.
#[test]
fn a_force_is_not_smooth_up_to_the_power_nine_tenths() {
    assert_eq!(sides("-abs(x)^1.89", "0", "0"), Some([true; 2]));
    assert_eq!(sides("-abs(x)^1.91", "0", "0"), None);
}
