//! Large distances, where functions saturate: no overflow is permanent, and a motion without forces costs
//! almost nothing.

use super::{Run, near};
use phaselab::system::MotionErrorKind;

fn potential(initial: &str, velocity: &str, v: &str) -> Run {
    Run::new(&format!(
        "title = \"Far out\"\n[coordinates]\nx = {{ initial = {initial}, velocity = {velocity} }}\n[lagrangian]\nL = \"1/2*x'^2 - ({v})\"\n"
    ))
}

#[test]
fn poschl_and_tellers_hill_is_followed_for_ever() {
    // sinh x = √((E − 1)/E) sinh(√(2E) (t + t₀)), at 30 digits
    for hill in ["1/cosh(x)^2", "4*exp(-2*x)/(1 + exp(-2*x))^2", "1 - tanh(x)^2"] {
        let mut run = potential("1.0", "3.0", hill);
        near(&run.to(100.0)[..1], &[314.661_844_238_315_8], 6e-14);
        near(&run.to(1000.0)[..1], &[3_137.844_168_037_953_5], 6e-13);
        assert!(run.steps < 250, "{hill}: {} steps", run.steps);
        run.to(1e9);
        assert!(run.steps < 350, "{hill}: {} steps", run.steps);
    }
}

#[test]
fn the_edge_of_a_well_however_it_is_written() {
    // ∫ dx/√(2 (E − V)) at 30 digits
    for edge in ["1/(1 + exp(x))", "exp(-x)/(1 + exp(-x))", "1/2*(1 - tanh(x/2))"] {
        let mut run = potential("1.0", "3.0", edge);
        let speed = 3.088_346_295_793_266_5;
        near(&run.to(1e4), &[30_884.429_358_784_11, speed], 8e-12);
        assert!(run.steps < 200, "{edge}: {} steps", run.steps);
    }
}

#[test]
fn a_step_is_flat_at_any_distance() {
    // the exponents of two in exp(−x/0.05) do not fit into 64 bits
    for (x, energy) in [("-4e16", 0.5), ("-4e25", 0.5), ("-1e34", 0.5), ("4e16", 1.5)] {
        let mut run = potential(x, "1.0", "1/(1 + exp(-x/0.05))");
        assert_eq!(run.to(10.0)[1], 1.0, "{x}");
        assert_eq!(run.columns()[3], energy, "{x}");
    }
}

#[test]
fn quotients_of_what_overflows_have_values_on_both_sides() {
    for (bounded, left, right) in [
        ("sinh(x)/cosh(x)", -1.0, 1.0),
        ("exp(x)/(1 + exp(x))^2", 0.0, 0.0),
        ("tanh(5*x)^3", -1.0, 1.0),
        ("exp(-x^2)", 0.0, 0.0),
        ("exp(x^2)/(1 + exp(x^2)) - 1", 0.0, 0.0),
        ("1/cosh(3*x)", 0.0, 0.0),
        ("(exp(x) - exp(-x))/(exp(x) + exp(-x))", -1.0, 1.0),
    ] {
        for (velocity, end) in [("-4.0", left), ("4.0", right)] {
            let mut run = potential("0.5", velocity, bounded);
            let energy = run.columns()[3];
            let state = run.to(1e5);
            let speed = (2.0_f64 * (energy - end)).sqrt();
            near(&[state[1].abs()], &[speed], 2e-14);
            near(&run.columns()[3..4], &[energy], 3e-14);
            assert!(run.steps < 600, "{bounded}: {} steps", run.steps);
        }
    }
}

#[test]
fn slopes_that_saturate_throw_back() {
    for (slope, step) in [("ln(cosh(x))", 1.0), ("ln(1 + exp(x)) + ln(1 + exp(-x))", 1.0)] {
        // far out the force is constant: up to about 1.2e4 and back
        let mut run = potential("0.0", "150.0", slope);
        let energy = run.columns()[3];
        let turn = 150.0 / step;
        run.to(turn);
        near(&run.columns()[3..4], &[energy], 1e-10);
        run.to(4.0 * turn);
        near(&run.columns()[3..4], &[energy], 1e-10);
        assert!(run.steps < 1000, "{slope}: {} steps", run.steps);
    }
}

#[test]
fn an_essential_singularity_is_passed_where_it_is_felt_by_nothing() {
    // from 0.7 to −0.7 takes twice ∫ dx/√(2 (E − V)) from 0 to 0.7
    let mut run = potential("0.7", "-1.3", "exp(-1/x^2)");
    near(&run.to(1.013_639_773_207_069_9), &[-0.7, -1.3], 1e-14);
    let energy = run.columns()[3];
    run.to(200.0);
    near(&run.columns()[3..4], &[energy], 1e-14);
}

#[test]
fn a_steep_wall_is_no_trouble_in_any_unit() {
    let mut run = potential("1.6", "0.0", "x^40");
    let energy = run.columns()[3];
    run.to(1e-3);
    near(&[run.columns()[3] / energy], &[1.0], 1e-13);
    for x in ["1e-300", "1e-150", "1e150"] {
        let mut run = potential(x, "0.0", "1/2*x^2");
        let state = run.to(3.0);
        let start: f64 = x.parse().expect("a number");
        near(&[state[0] / start], &[3.0_f64.cos()], 1e-15);
    }
}

#[test]
fn powers_that_leave_the_range_of_numbers_have_the_motion_of_their_units() {
    // V = a x^n from x = u: x/u as a function of t √(a uⁿ)/u does not depend on u
    for (power, units) in [
        (20, [("1e17", "1e-298"), ("1e-17", "1e298"), ("1e25", "1e-300")]),
        (40, [("1e10", "1e-300"), ("1e-10", "1e300"), ("1e8", "1e-300")]),
    ] {
        let time = 1.3_f64;
        let expected = potential("1.0", "0.0", &format!("x^{power}")).to(time);
        for (unit, factor) in units {
            let (u, a): (f64, f64) = (unit.parse().unwrap(), factor.parse().unwrap());
            let exponent = (a.log10() + f64::from(power) * u.log10()).round() as i32;
            let speed = 10.0_f64.powf(f64::from(exponent) / 2.0);
            let mut run = potential(unit, "0.0", &format!("{factor}*x^{power}"));
            let state = run.to(time * u / speed);
            near(&[state[0] / u, state[1] / speed], &expected, 1e-12);
        }
    }
    // 1e300 e^−x = e^−(x − ln 1e300), where e^−x alone is below the smallest numbers
    let shifted = "exp(-(x - 690.775527898213705205))";
    let expected = potential("745.0", "0.0", shifted).to(1e12);
    let state = potential("745.0", "0.0", "1e300*exp(-x)").to(1e12);
    near(&[state[0] - 745.0, 1e12 * state[1]], &[expected[0] - 745.0, 1e12 * expected[1]], 1e-11);
    assert!(expected[0] > 746.0);
}

/// c x^−n, too small to be a number where the motion begins, throws back: with ½ = c r^−n the way from 5 to r takes
/// 5 + r Γ(−1/n) Γ(½)/(n Γ(½ − 1/n)), at 30 digits.
#[test]
fn a_high_negative_power_throws_back_from_where_it_is_below_the_smallest_numbers() {
    for (v, place) in [
        ("x^(-400)", 6.996_516_663_929_919),
        ("x^(-600)", 6.997_681_693_232_4),
        ("(x^2)^(-300)", 6.997_681_693_232_4),
        ("x^(-700)/3", 6.994_880_522_629_43),
        ("x^(-600.5)", 6.997_683_630_058_92),
        ("1e-100*x^(-400)", 6.122_723_826_558_96),
    ] {
        let mut run = potential("5.0", "-1.0", v);
        near(&run.to(10.0), &[place, 1.0], 1e-12);
        assert!(run.steps < 1000, "{v}: {} steps", run.steps);
        run.to(1e9);
        assert!(run.steps < 1100, "{v}: {} steps", run.steps);
    }
    // with the exponent as a parameter, too
    for (n, place) in [("400", 6.996_516_663_929_919), ("600", 6.997_681_693_232_4)] {
        let mut run = Run::new(&format!(
            "title = \"F\"\n[coordinates]\nx = {{ initial = 5, velocity = -1 }}\n[parameters]\nn = {n}.0\n\
             [lagrangian]\nL = \"1/2*x'^2 - x^(-n)\"\n"
        ));
        near(&run.to(10.0)[..2], &[place, 1.0], 1e-12);
    }
}

/// About x = 0 the series of 1/(1 + x^n) begins with as many zeros, and far beyond the wall all is flat again: it is met in a
/// step of any length, as a potential and as a force of which no energy is known. Beyond it v² = v₀² + 2, and it reflects
/// what is slower than √2 on its other side.
#[test]
fn a_wall_that_no_term_of_the_series_shows_is_met() {
    for n in [30, 40, 100] {
        let potential = format!("1/(1 + x^{n})");
        let hill = format!("x^{n}/(1 + x^{n})");
        let force = format!("{n}*x^{}/(1 + x^{n})^2", n - 1);
        let forced = format!(
            "title = \"F\"\n[coordinates]\nx = {{ initial = 0, velocity = 1.2 }}\n\
             [lagrangian]\nL = \"1/2*x'^2\"\nforces = {{ x = \"{force}\" }}\n"
        );
        for end in [3.0, 4.0, 50.0, 1e3, 1e6] {
            for mut run in [super::far::potential("0", "1.2", &potential), Run::new(&forced)] {
                near(&run.to(end)[1..2], &[3.44_f64.sqrt()], 1e-13);
            }
            let mut run = super::far::potential("0", "1.2", &hill);
            let v = run.to(1.5)[1];
            near(&[v], &[-1.2], 1e-9);
        }
    }
}

/// One at rest, which a steep power of another begins to move: its rates come out of underflow. p_x + 10 p_y is conserved.
#[test]
fn a_steep_power_sets_in_motion_what_is_at_rest() {
    let file = |v: &str| {
        format!(
            "title = \"Two\"\n[coordinates]\nx = {{ initial = 0, velocity = 1.2 }}\ny = {{ initial = 0 }}\n\
             [lagrangian]\nL = \"1/2*x'^2 + 1/2*y'^2 - {v}\"\n"
        )
    };
    // x'² + (1.2 − x')²/100 = 3.44 beyond the wall, and 1.44 where all of the energy is in the motion again
    let root = |twice: f64, side: f64| {
        (0.012 + side * (0.012_f64.powi(2) - 1.01 * (0.0144 - twice)).sqrt()) / 1.01
    };
    for n in [40, 50] {
        let x = root(3.44, 1.0);
        let mut run = Run::new(&file(&format!("1/(1 + (x - y/10)^{n})")));
        near(&run.to(3.0)[2..4], &[x, (1.2 - x) / 10.0], 1e-13);
        let x = root(1.44, -1.0);
        let mut run = Run::new(&file(&format!("(x - y/10)^{n}")));
        near(&run.to(1.6)[2..4], &[x, (1.2 - x) / 10.0], 1e-12);
    }
}

#[test]
fn a_step_ends_when_it_is_asked_to() {
    let mut run = potential("1.0", "0.0", "x^2/2 + sin(x)");
    run.to(1.0);
    run.system.cancel().cancel();
    let error = run.try_to(2.0).expect_err("stopped");
    assert_eq!(error.kind, MotionErrorKind::Cancelled);
    assert_eq!(run.stepper.time(), 1.0);
}

/// Where the coefficients of a series, and the products of numbers that a law has, are near the least that `f64` has.
#[test]
fn a_motion_has_all_its_digits_however_small_it_is() {
    for tolerance in [None, Some(1e-12)] {
        let within = if tolerance.is_none() { 2e-15 } else { 1e-11 };
        let run = |x: f64, v: f64, law: &str, until: f64| {
            let text = format!(
                "title = \"Small\"\n[coordinates]\nx = {{ initial = {x:e}, velocity = {v:e} }}\n\
                 [lagrangian]\nL = \"1/2*x'^2 - {law}\"\n"
            );
            Run::with(&text, tolerance).to(until)
        };
        let (sine, cosine) = (10.0_f64.sin(), 10.0_f64.cos());
        for size in [1e-180, 1e-270, 1e-280, 1e-290, 1e-300, 1e-306] {
            let pulled = run(size, 0.0, "1/2*x^2", 10.0);
            near(&[pulled[0] / size, pulled[1] / size], &[cosine, -sine], within);
            let kicked = run(0.0, size, "1/2*x^2", 10.0);
            near(&[kicked[0] / size, kicked[1] / size], &[sine, cosine], within);
        }
        // forces are cubes: the motion of size A is that of size 1, A times as slow
        let whole = run(1.0, 0.0, "1/4*x^4", 16.0);
        for size in [2.0_f64.powi(-300), 2.0_f64.powi(-340)] {
            let small = run(size, 0.0, "1/4*x^4", 16.0 / size);
            near(&[small[0] / size, small[1] / size / size], &whole, within);
        }
    }
}

/// A small number beside large ones is followed as well, and a motion that ends at zero may pass all smaller ones.
#[test]
fn what_is_small_beside_other_numbers_grows_and_decays_as_it_should() {
    let mut run = Run::new(
        "title = \"A saddle\"\n[coordinates]\nx = { initial = 1e-290, velocity = 1e-290 }\n\
         y = { initial = 1 }\n[lagrangian]\nL = \"1/2*x'^2 + 1/2*y'^2 + 1/2*x^2 - 1/2*y^2\"\n",
    );
    let state = run.to(660.0);
    let grown = 1e-290 * 330.0_f64.exp() * 330.0_f64.exp();
    assert!((state[0] / grown - 1.0).abs() < 1e-12, "{} {grown}", state[0]);
    let mut run = Run::new(
        "title = \"Decay\"\n[coordinates]\nx = { initial = 1, velocity = -1 }\n[lagrangian]\n\
         L = \"1/2*x'^2 - 1/2*x^2\"\ndissipation = \"x'^2\"\n",
    );
    let state = run.to(690.0);
    let left = (-345.0_f64).exp() * (-345.0_f64).exp();
    assert!((state[0] / left - 1.0).abs() < 1e-12, "{} {left}", state[0]);
    assert!(run.to(2000.0)[0].abs() < 1e-300);
    assert!(run.steps < 2000, "{} steps", run.steps);
}

/// About x = 0 the series of x³⁰ has no term below the thirtieth, and the force of 1/(1 + x³⁰) vanishes on both sides of
/// x = 1: nothing in the series shows it, and a step must not pass over it.
#[test]
fn forces_whose_series_begin_beyond_its_order_are_not_passed_over() {
    // each falls by its height from about 0 to far away; beyond the time given there numbers overflow
    let falls: [(fn(u32) -> String, f64, f64); 4] = [
        (|n| format!("1/(1 + x^{n})"), 1.0, 1e4),
        (|n| format!("exp(-x^{n})"), 1.0, 1e4),
        (|n| format!("-tanh(x^{n})"), 1.0, 3.0),
        (|n| format!("-atan(x^{n})"), std::f64::consts::FRAC_PI_2, 1e4),
    ];
    for (potential_of, height, end) in falls {
        for n in [6, 7, 8, 12, 29, 30, 41] {
            for start in ["0.0", "1e-6"] {
                let v = potential_of(n);
                let mut run = potential(start, "1.2", &v);
                let state = run.to(end);
                let speed = (1.44_f64 + 2.0 * height).sqrt();
                let off = state[1] / speed - 1.0;
                assert!(off.abs() < 2e-15, "{v} from {start}: {state:?} {speed} {off:e}");
                assert!(run.steps < 1000, "{v} from {start}: {} steps", run.steps);
            }
        }
    }
}

/// e^u of u = x⁴¹ leaves every range of exponents that fits into an integer soon after x = 7.
#[test]
fn functions_of_any_steepness_saturate() {
    for (v, start, end) in [
        ("tanh(x^41)", 0.0, 1.0),
        ("1/(1 + exp(x^21))", 0.5, 0.0),
        ("exp(x^21)/(1 + exp(x^21)) - 1", -0.5, 0.0),
        ("exp(-x^40)", 1.0, 0.0),
        ("1/cosh(x^31)", 1.0, 0.0),
        ("tanh(1e200*x)", 1.0, 1.0),
        ("exp(-1e300*x^2)", 0.0, 0.0),
        ("exp(-exp(x))", (-(0.1_f64.exp())).exp(), 0.0),
        ("tanh(1e200*tanh(x^9))", 1.0, 1.0),
        ("atan(x^41)", 0.0, std::f64::consts::FRAC_PI_2),
    ] {
        let mut run = potential("0.1", "2.0", v);
        let speed = (4.0_f64 + 2.0 * (start - end)).sqrt();
        for time in [10.0, 100.0, 1e6] {
            near(&run.to(time)[1..], &[speed], 1e-13);
        }
        assert!(run.steps < 2000, "{v}: {} steps", run.steps);
    }
}

/// ½v² is ½v₀² + ∫ F dx, with ∫ (π/2 − atan uⁿ) du = π/2/cos(π/2n) and ∫ (1 − tanh uⁿ) du, n = 41 and 5 from 0 to ∞.
#[test]
fn forces_of_any_steepness_saturate() {
    use std::f64::consts::{FRAC_PI_2, PI};
    let missing = FRAC_PI_2 / (PI / 82.0).cos();
    for (force, limit, missing) in
        [("atan(x^41)", FRAC_PI_2, missing), ("tanh(x^41)", 1.0, 0.980_607_569_570_413_7)]
    {
        let mut run = Run::new(&format!(
            "title = \"Pushed\"\n[coordinates]\nx = {{ initial = 0.0, velocity = 2.0 }}\n[lagrangian]\nL = \"1/2*x'^2\"\nforces = {{ x = \"{force}\" }}\n"
        ));
        for time in [10.0, 100.0, 1e3] {
            let state = run.to(time);
            let expected = (4.0 + 2.0 * (limit * state[0] - missing)).sqrt();
            near(&[state[1] / expected], &[1.0], 1e-14);
        }
        assert!(run.steps < 20_000, "{force}: {} steps", run.steps);
    }
}
