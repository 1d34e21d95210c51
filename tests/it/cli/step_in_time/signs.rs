//! Signs whose functions have poles, small values, or a zero that rounding brings a little later.

use super::{assert_close, law, rows};

/// A sign that changes at a pole, or at a zero of what has poles elsewhere, is that of a function without poles: at t = 1 the mass is
/// halved, and other instants are those of the same mass written so.
#[test]
fn signs_of_quotients_are_located_at_their_zeros_and_at_their_poles() {
    for (mass, same) in [
        ("(3 - sign(1 - 1/t))/2", "(3 - sign(t - 1))/2"),
        ("(3 - sign(1/(t - 1)))/2", "(3 - sign(t - 1))/2"),
        ("(3 - sign(1/(t - 1)^3))/2", "(3 - sign(t - 1))/2"),
        ("(3 - sign(1 - 1/t^2))/2", "(3 - sign(t - 1))/2"),
        ("(3 - sign(tan(t - 1)))/2", "(3 - sign(sin(2*t - 2)))/2"),
        (
            "(3 - sign(1 + cot(t + 3*pi/4 - 1)))/2",
            "(3 - sign(sin(t + pi - 1)*sin(t + 3*pi/4 - 1)))/2",
        ),
        ("(3 - sign(t/(t - 1)))/2", "(3 - sign(t - 1))/2"),
        ("(3 - sign(1e-300*(t - 1)))/2", "(3 - sign(t - 1))/2"),
        ("(3 - sign(eps*(t - 1)^3))/2", "(3 - sign(t - 1))/2"),
        ("(3 - sign(sinh(1/(t - 1))))/2", "(3 - sign(t - 1))/2"),
        ("(3 - sign(atan(1/(t - 1))))/2", "(3 - sign(t - 1))/2"),
        ("(3 - sign(eps*(exp(1/(t - 1)) - 1)^3))/2", "(3 - sign(t - 1))/2"),
        ("(3 - sign(eps*tanh(1/(t - 1))^3))/2", "(3 - sign(t - 1))/2"),
        ("(3 + sign(1 - exp(1/(t - 1))))/2", "(3 - sign(t - 1))/2"),
        ("(3 - sign(exp(1/(t - 1)) - exp(-1/(t - 1))))/2", "(3 - sign(t - 1))/2"),
        ("(3 - sign(atan(tan(t + 0.5))))/2", "(3 - sign(sin(2*t + 1)))/2"),
    ] {
        let [law, same] = [mass, same].map(|mass| {
            format!("[parameters]\neps = 1e-300\n{}\n[run]\nstart = 0.25", law(mass, "1/2*x^2"))
        });
        for method in [&["taylor"], &["dop853"], &["leapfrog"]] {
            let times = "0.5,1,1.2,3";
            for (row, wanted) in
                rows(&law, "", method, times).iter().zip(rows(&same, "", method, times))
            {
                assert_close(
                    row,
                    [wanted[1], wanted[2], wanted[3]],
                    1e-12,
                    &format!("{mass}, {method:?}"),
                );
            }
        }
    }
}

/// A function whose values are too small for a product of two of them has its signs all the same.
#[test]
fn signs_of_small_functions_count() {
    for function in ["(t - 1)^3", "1e-90*(t - 1)"] {
        let law = law(&format!("(3 - sign({function}))/2"), "0");
        for method in [&["rk4"], &["dop853"]] {
            let row = rows(&law, "", method, "3")[0];
            assert_close(&row, [4.3, 1.6, 1.6], 1e-14, function);
        }
    }
}

/// However the function is written whose zero the instant is, and where rounding brings that a little later.
#[test]
fn a_row_at_the_instant_is_that_after_it() {
    for function in [
        "1e-10*(t - 1)",
        "1e-200*(t - 1)",
        "t/1000 - 1/1000",
        "0.1*t - 0.1",
        "t^2 - 1",
        "exp(t) - exp(1)",
        "ln(t)",
    ] {
        // a logarithm has no value at 0
        let law = law(&format!("(3 - sign({function}))/2"), "0") + "\n[run]\nstart = 0.25";
        for method in [&["taylor"], &["dop853"], &["leapfrog"]] {
            for row in rows(&law, "", method, "0.5,1,2") {
                let velocity = if row[0] < 1.0 { 0.8 } else { 1.6 };
                let x = 0.1 + 0.8 * row[0].min(1.0) + 1.6 * (row[0] - 1.0).max(0.0);
                assert_close(&row, [x, velocity, 1.6], 1e-14, function);
            }
        }
    }
}
