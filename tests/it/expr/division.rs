//! Division of sums by long division, against products multiplied out.

use super::text;

#[test]
fn what_divides_is_cancelled_and_nothing_else() {
    for (written, expected) in [
        ("(q^2 - q*u)/(q - u)^2", "q/(q - u)"),
        ("(q^2 + u^2 - 2*q*u)/(q - u)^2", "1"),
        ("(a^2 - b^2)/(a + b)", "a - b"),
        ("(q^2 + 1)/(q - u)", "(q^2 + 1)/(q - u)"),
        ("(q^2 + u)/(q^2 - u)", "(q^2 + u)/(q^2 - u)"),
    ] {
        let expected = text(expected, |_, e| e);
        assert_eq!(text(written, phaselab::expr::Pool::divided_out), expected, "{written}");
    }
}

#[test]
fn products_come_apart_again() {
    for (a, b) in [("q - u", "q^2 + u^2 + q*u"), ("q + 2*u", "q - u^3"), ("q*u + a", "q + b")] {
        let whole = text(&format!("({a})*({b})"), phaselab::expr::Pool::multiplied_out);
        let found = text(&format!("({whole})/({a})"), phaselab::expr::Pool::divided_out);
        assert!(!found.contains('/'), "{found}");
        let left = text(&format!("({found}) - ({b})"), phaselab::expr::Pool::multiplied_out);
        assert_eq!(left, "0", "({a})({b})");
    }
}
