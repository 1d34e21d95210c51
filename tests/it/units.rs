//! Units of what a file observes: those it gives, and those that follow.

use phaselab::system::ChannelKind;

use crate::fixtures::{catalog, lowered};
use crate::nonempty;

fn units<const N: usize>(text: &str, names: [&str; N]) -> [String; N] {
    let loaded = lowered(text);
    let channels = loaded.system.channels();
    names.map(|name| {
        let found = channels.iter().find(|channel| channel.name == name);
        found.unwrap_or_else(|| panic!("{name}")).unit.clone()
    })
}

/// A torque has the dimension of an energy, and only the file knows which of them a quantity is.
#[test]
fn a_file_says_that_an_observable_is_a_torque() {
    let text = |unit: &str| {
        format!(
            "title = 'a test'\n[coordinates]\nphi = {{ initial = 1.0, unit = 'rad' }}\n\
             [parameters]\nI = {{ value = 1.0, unit = 'kg m²' }}\nk = {{ value = 1.0, unit = 'kg m²/s²' }}\n\
             [lagrangian]\nL = \"1/2*I*phi'^2 - 1/2*k*phi^2\"\n\
             [[observables]]\nname = 'restoring torque'\nexpression = '-k*phi'\n{unit}\n"
        )
    };
    let names = ["restoring torque", "energy"];
    assert_eq!(units(&text(""), names), ["J", "J"]);
    assert_eq!(units(&text("unit = 'N m'"), names), ["N m", "J"]);
}

/// The multiplier of a constraint on lengths is a force, of one on their squares a force by a length, of one on angles a torque, of one on
/// a number an energy: λ times the constraint is an energy in each case.
#[test]
fn a_multiplier_without_a_unit_has_the_one_that_follows() {
    let text = |constraint: &str| {
        format!(
            "title = 'a test'\n[coordinates]\nx = {{ initial = 1.0, velocity = 0.0, unit = 'm' }}\ny = {{ initial = 0.0, velocity = 0.0, unit = 'm' }}\n\
             phi = {{ initial = 0.0, velocity = 0.0, unit = 'rad' }}\n\
             [parameters]\nm = {{ value = 1.0, unit = 'kg' }}\nI = {{ value = 1.0, unit = 'kg m²' }}\n\
             r = {{ value = 1.0, unit = 'm' }}\ng = {{ value = 1.0, unit = 'm/s²' }}\n\
             [lagrangian]\nL = \"1/2*m*(x'^2 + y'^2) + 1/2*I*phi'^2 - m*g*y\"\n\
             [[constraints]]\nname = 'c'\nexpression = \"{constraint}\"\n\
             [[observables]]\nname = 'power'\nexpression = \"lambda_c*x'\"\n"
        )
    };
    for (constraint, expected) in [
        ("y", ["N", "W"]),
        ("y' - r*phi'", ["N", "W"]),
        ("x^2 + y^2 - r^2", ["N/m", "kg m/s³"]),
        ("phi", ["N m", "kg m³/s³"]),
        ("phi'", ["N m", "kg m³/s³"]),
        ("phi - 2*pi", ["N m", "kg m³/s³"]),
        ("phi' - x'/r", ["N m", "kg m³/s³"]),
        ("x^2/r^2 + y^2/r^2 - 1", ["J", "kg m³/s³"]),
        ("sin(phi)", ["N m", "kg m³/s³"]),
        ("x'/r - y'/r", ["J", "kg m³/s³"]),
    ] {
        assert_eq!(units(&text(constraint), ["lambda_c", "power"]), expected, "{constraint}");
    }
}

/// The units that the shipped presets write beside their constraints are those that would follow without them.
#[test]
fn units_of_constraints_agree_with_those_that_follow() {
    let mut compared = 0;
    for entry in catalog().entries() {
        let text = catalog().find(&entry.name).unwrap().text;
        if !text.contains("[[constraints]]") || !text.contains("\nunit = \"N") {
            continue;
        }
        let without: String = text
            .lines()
            .filter(|line| !line.starts_with("unit = \"N"))
            .collect::<Vec<_>>()
            .join("\n");
        let units = |text: &str| {
            let loaded = lowered(text);
            let channels = loaded.system.channels().iter();
            let multipliers =
                channels.filter(|channel| matches!(channel.kind, ChannelKind::Multiplier(_)));
            multipliers.map(|c| (c.name.clone(), c.unit.clone())).collect::<Vec<_>>()
        };
        let given = units(&text);
        compared += nonempty(&given).len();
        assert_eq!(given, units(&without), "{}", entry.name);
    }
    assert!(compared >= 12, "{compared} were compared");
}
