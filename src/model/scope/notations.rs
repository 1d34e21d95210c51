//! Names as other notations would write them: velocities and momenta.
//!
//! In: an unknown name, and whether a name is a coordinate. Out: how it is written here. Never here: names that are misspelt.

/// What velocities are called elsewhere: `x_dot`, `xdot`, `v_x`, `dx`.
const VELOCITY_ENDS: [&str; 2] = ["_dot", "dot"];
const VELOCITY_BEGINNINGS: [&str; 2] = ["v_", "d"];

/// How what a name means elsewhere is written here, where `first` is a coordinate.
pub(super) fn written_here(
    name: &str,
    first: Option<&str>,
    is_coordinate: &dyn Fn(&str) -> bool,
) -> Option<String> {
    let ends = VELOCITY_ENDS.iter().filter_map(|end| name.strip_suffix(end));
    let begins = VELOCITY_BEGINNINGS.iter().filter_map(|begin| name.strip_prefix(begin));
    if let Some(coordinate) = ends.chain(begins).find(|rest| is_coordinate(rest)) {
        return Some(format!("the velocity of `{coordinate}` is written `{coordinate}'`"));
    }
    let first = first?;
    match name {
        "dt" => Some(format!("a derivative by the time has a prime: `{first}'`")),
        "p" => Some(format!("the momentum of `{first}` is written `p_{first}`")),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::written_here;

    #[test]
    fn velocities_and_momenta_of_other_notations_are_known() {
        let is_coordinate = |name: &str| ["x", "theta"].contains(&name);
        let known = |name: &str| written_here(name, Some("x"), &is_coordinate);
        let help = |name: &str| known(name).unwrap_or_default();
        for name in ["x_dot", "xdot", "dx", "v_x"] {
            assert_eq!(help(name), "the velocity of `x` is written `x'`", "{name}");
        }
        assert!(help("thetadot").contains("`theta'`"));
        assert!(help("dt").contains("`x'`") && help("p").contains("`p_x`"));
        for name in ["dy", "dot", "d", "v_", "mass", "y_dot"] {
            assert_eq!(known(name), None, "{name}");
        }
        assert_eq!(written_here("p", None, &|_| false), None);
    }
}
