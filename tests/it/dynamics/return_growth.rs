//! The growth of errors on the way back, against flows whose derivative is known in closed form.

use phaselab::dynamics::{ReturnGrowth, growth_after, return_growth};

use super::{file, taylor};

/// The growth on the way back over this time in the potential V of one coordinate.
fn growth(potential: &str, time: f64) -> Vec<ReturnGrowth> {
    let text = format!(
        "title = \"one\"\n[coordinates]\nq = {{ initial = 1.0 }}\n[lagrangian]\n\
         L = \"1/2*q'^2 - ({potential})\"\n"
    );
    let case = file(&text, &[1.0, 0.5]);
    let mut turned = case.start.clone();
    turned.time = time;
    return_growth(&case.space, taylor(), &turned, 0.0).unwrap()
}

fn near(value: f64, exact: f64, within: f64) {
    assert!((value / exact - 1.0).abs() < within, "{value} {exact}");
}

/// Without forces ∂φ = [[1, −τ], [0, 1]], of norm (τ + √(τ² + 4))/2: the shear of every motion whose period depends on its
/// amplitude.
#[test]
fn shear_adds_up_as_the_closed_form_says() {
    let time = 50.0;
    let known = growth("0*q", time);
    for gone in [time, 0.5 * time, 0.7 * time] {
        let found = growth_after(&known, gone).unwrap();
        let root = (gone * gone + 4.0).sqrt();
        let sum = gone * gone / 4.0 + gone * root / 4.0 + (gone / 2.0).asinh();
        let squares = gone + gone.powi(3) / 6.0 + (root.powi(3) - 8.0) / 6.0;
        near(found.sum, sum, 2e-3);
        near(found.squares, squares, 2e-3);
    }
    // errors of one sign grow like t², independent ones like t^{3/2}: neither stays as it was, though the exponent is 0
    let longer = *growth("0*q", 4.0 * time).last().unwrap();
    let last = *known.last().unwrap();
    let ratio = |independent| {
        longer.expected(1e-16, 0.1, independent) / last.expected(1e-16, 0.1, independent)
    };
    near(ratio(false), 16.0, 0.02);
    near(ratio(true), 8.0, 0.02);
}

/// The oscillator turns its phase plane: an error stays as it is, and only their number grows.
#[test]
fn an_isochronous_motion_has_no_shear() {
    let last = *growth("1/2*q^2", 30.0).last().unwrap();
    near(last.sum, 30.0, 1e-9);
    near(last.squares, 30.0, 1e-9);
    near(last.expected(1e-16, 0.3, false), 1e-14, 1e-9);
    near(last.expected(1e-16, 0.3, true), 1e-16 * 200.0_f64.sqrt(), 1e-9);
}

/// On the top of a hill ∂φ has the norm e^τ.
#[test]
fn instability_grows_exponentially() {
    let known = growth("-1/2*q^2", 10.0);
    near(known.last().unwrap().sum, 10.0_f64.exp() - 1.0, 5e-3);
    near(growth_after(&known, 5.0).unwrap().sum, 5.0_f64.exp() - 1.0, 5e-3);
    assert!(growth_after(&known, 10.5).is_none(), "beyond the way nothing is known");
}
