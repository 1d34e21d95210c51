//! Functions that other programs have, and how they are written here.
//!
//! In: the name of a function that is unknown. Out: the sentence of help. Never here: names that are misspelt.

/// What a function is called elsewhere, and what to write.
const ELSEWHERE: [(&[&str], &str); 20] = [
    (&["sgn", "signum"], "sign(x)"),
    (&["heaviside", "Heaviside", "step", "theta", "H"], "(1 + sign(x))/2, which is 1 where x > 0"),
    (
        &["if", "ifelse", "where", "piecewise", "Piecewise"],
        "cases by sign, max, min and abs: (1 + sign(x))/2 is 1 where x > 0, and 0 where x < 0",
    ),
    (&["log"], "ln(x), the natural logarithm, or ln(x)/ln(10), that to base 10"),
    (&["log10", "lg"], "ln(x)/ln(10)"),
    (&["log2", "ld"], "ln(x)/ln(2)"),
    (&["pow", "power"], "a power with `^`: x^2"),
    (&["cbrt"], "sign(x)*abs(x)^(1/3)"),
    (&["hypot", "norm"], "sqrt(x^2 + y^2)"),
    (&["sec"], "1/cos(x)"),
    (&["csc", "cosec"], "1/sin(x)"),
    (&["coth"], "1/tanh(x)"),
    (&["sech"], "1/cosh(x)"),
    (&["csch"], "1/sinh(x)"),
    (&["asinh", "arsinh", "arcsinh"], "ln(x + sqrt(x^2 + 1))"),
    (&["acosh", "arcosh", "arccosh"], "ln(x + sqrt(x^2 - 1))"),
    (&["atanh", "artanh", "arctanh"], "ln((1 + x)/(1 - x))/2"),
    (&["acot", "arccot"], "atan2(1, x)"),
    (
        &["mod", "fmod", "rem"],
        "nothing for an angle, whose `period` stands beside its `initial`; else atan2(sin(x), cos(x))",
    ),
    (
        &["floor", "ceil", "round", "frac"],
        "steps by sign, and a saw-tooth by atan2(sin(x), cos(x))",
    ),
];

/// What to write in place of a function that other programs have.
pub(super) fn written_here(name: &str) -> Option<String> {
    let row = ELSEWHERE.iter().find(|(names, _)| names.contains(&name))?;
    Some(format!("write {}", row.1))
}

#[cfg(test)]
mod tests {
    use super::ELSEWHERE;
    use crate::expr::FunctionId;

    /// A row for a function that there is would never be read.
    #[test]
    fn no_function_of_ours_is_among_them() {
        for name in ELSEWHERE.iter().flat_map(|(names, _)| *names) {
            assert!(FunctionId::by_name(name).is_none(), "{name}");
        }
    }
}
