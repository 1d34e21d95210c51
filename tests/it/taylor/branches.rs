//! Kinks hidden in roots and powers: cones, chords, contacts, angles.

use std::f64::consts::PI;

use super::{Run, near};
use crate::nonempty;
use phaselab::system::MotionErrorKind;

fn line(initial: &str, velocity: &str, rest: &str) -> Run {
    Run::new(&format!(
        "title = \"Hidden kinks\"\n[coordinates]\nx = {{ initial = {initial}, velocity = {velocity} }}\n[lagrangian]\n{rest}\n"
    ))
}

fn potential(initial: &str, velocity: &str, v: &str) -> Run {
    line(initial, velocity, &format!("L = \"1/2*x'^2 - ({v})\""))
}

fn plane(x: [f64; 2], v: [f64; 2], rest: &str) -> Run {
    Run::new(&format!(
        "title = \"Hidden kinks\"\n[coordinates]\nx = {{ initial = {}, velocity = {} }}\ny = {{ initial = {}, velocity = {} }}\n[lagrangian]\n{rest}\n",
        x[0], v[0], x[1], v[1]
    ))
}

#[test]
fn straight_through_the_tip_of_a_cone() {
    // x = 1 − t²/2, reflected at x = 0: a period of 4 √2
    let cone = "L = \"1/2*(x'^2 + y'^2) - sqrt(x^2 + y^2)\"";
    let mut run = plane([1.0, 0.0], [0.0, 0.0], cone);
    let s = 3.0 - 2.0_f64.sqrt();
    near(&run.to(3.0), &[s * s / 2.0 - 2.0_f64.sqrt() * s, 0.0, s - 2.0_f64.sqrt(), 0.0], 2e-15);
    run.to(100.0);
    near(&run.columns()[6..7], &[1.0], 4e-15);
    // along an oblique line the root is not simplified
    let mut run = plane([0.6, 0.8], [0.0, 0.0], cone);
    let there = s * s / 2.0 - 2.0_f64.sqrt() * s;
    near(&run.to(3.0)[..2], &[0.6 * there, 0.8 * there], 2e-15);
}

#[test]
fn close_to_the_tip_of_a_cone() {
    for offset in [1e-2, 1e-4, 1e-6, 1e-8, 1e-12] {
        let mut run =
            plane([1.0, 0.0], [0.0, offset], "L = \"1/2*(x'^2 + y'^2) - sqrt(x^2 + y^2)\"");
        let state = run.to(30.0);
        near(&run.columns()[6..7], &[1.0 + offset * offset / 2.0], 1e-14);
        let momentum = state[0] * state[3] - state[1] * state[2];
        near(&[momentum], &[offset], 1e-14);
    }
}

#[test]
fn a_spring_through_its_own_end() {
    let mut run =
        plane([0.6, 0.7], [0.0, 0.0], "L = \"1/2*(x'^2 + y'^2) - 10*(sqrt(x^2 + y^2) - 0.1)^2\"");
    let energy = run.columns()[6];
    for t in [1.0, 3.0, 6.0, 20.0] {
        run.to(t);
        near(&run.columns()[6..7], &[energy], 4e-14);
    }
}

#[test]
fn chords_on_a_hoop_are_what_abs_says_they_are() {
    let beads = |chord: &str| {
        let mut run = Run::new(&format!(
            "title = \"Beads\"\n[coordinates]\na = {{ initial = 0.0, velocity = 1.2 }}\nb = {{ initial = 1.0, velocity = -0.3 }}\n[lagrangian]\nL = \"1/2*(a'^2 + b'^2) - 2*({chord} - 0.5)^2\"\n"
        ));
        run.to(12.0)
    };
    let expected = beads("2*abs(sin((a - b)/2))");
    near(&beads("sqrt(2 - 2*cos(a - b))"), &expected, 1e-13);
    near(&beads("sqrt((cos(a) - cos(b))^2 + (sin(a) - sin(b))^2)"), &expected, 1e-13);
}

#[test]
fn powers_of_abs_have_the_periods_of_closed_forms() {
    // 4 √(π/2) Γ(1 + 1/n)/Γ(½ + 1/n), from 1 at rest
    for (potentials, period) in [
        (["abs(x)^1.2", "(x^2)^(3/5)"], 5.280_915_273_991_471),
        (["abs(x)^1.5", "(x^2)^(3/4)"], 4.878_300_568_010_466),
        (["abs(x)^1.8", "max(x, -x)^1.8"], 4.592_136_767_968_899),
        (["abs(x)^2.5", "max(0, x)^2.5 + max(0, -x)^2.5"], 4.162_419_683_468_169),
    ] {
        for potential in nonempty(potentials) {
            let mut run = self::potential("1.0", "0.0", potential);
            near(&run.to(period), &[1.0, 0.0], 2e-13);
            near(&run.to(10.0 * period), &[1.0, 0.0], 2e-12);
            assert!(run.steps < 6000, "{potential}: {} steps", run.steps);
        }
    }
}

#[test]
fn a_contact_after_hertz() {
    // quadrature of the contact at 30 digits
    let mut run = potential("1.0", "0.0", "9.81*x + 1000*max(0, -x)^2.5");
    near(&run.to(1.010_502_474_783_177), &[1.0, 0.0], 1e-12);
    run.to(3.0);
    near(&run.columns()[3..4], &[9.81], 1e-13);
}

#[test]
fn roots_of_differences_of_cosines_and_nested_ones() {
    for (potential, period) in [
        ("sqrt(1 - cos(x))", 7.054_474_419_614_488),
        ("sqrt(1 + sqrt(x^2))", 9.292_151_287_324_760),
    ] {
        let mut run = self::potential("1.0", "0.0", potential);
        near(&run.to(period), &[1.0, 0.0], 1e-12);
    }
    for v in ["((x - 1)^2)^0.5", "sqrt(x^2 - 2*x + 1)"] {
        let mut run = potential("0.0", "0.0", v);
        near(&run.to(4.0 * 2.0_f64.sqrt()), &[0.0, 0.0], 4e-15);
    }
}

#[test]
fn inverse_sines_and_cosines_turn_with_their_arguments() {
    // acos(cos x) = |x| near zero, asin(sin x) is a sawtooth, and across their tops
    for v in ["acos(cos(x))", "asin(sin(x))", "acos(cos(x))^2", "asin(sin(x))^2"] {
        for velocity in ["1.0", "9.0"] {
            let mut run = potential("0.5", velocity, v);
            let energy = run.columns()[3];
            run.to(20.0);
            near(&run.columns()[3..4], &[energy], 1e-13 * energy.abs());
        }
    }
}

#[test]
fn an_angle_is_followed_to_its_cut_and_begins_anew_there() {
    let mut run = plane(
        [1.0, 0.0],
        [0.0, 1.0],
        "L = \"1/2*(x'^2 + y'^2) - 1/2*(x^2 + y^2) - 0.05*atan2(y, x)^2\"",
    );
    let energy = run.columns()[6];
    run.to(30.0);
    // the potential itself is the same on both sides
    near(&run.columns()[6..7], &[energy], 1e-14);
    // a switch that jumps at the cut
    let mut run = plane([-1.0, 0.5], [0.0, -3.0], "L = \"1/2*(x'^2 + y'^2) - abs(atan2(y, x))\"");
    let energy = run.columns()[6];
    run.to(1.0);
    near(&run.columns()[6..7], &[energy], 1e-14);
}

/// √r is as √|x| on a line through the origin, where its force grows without bound in every direction.
#[test]
fn a_motion_passes_through_and_beside_the_tip_of_a_radial_root() {
    // to r = 0 in ∫ dr/√(3 − 2 √r) = 2 √3 − 8/3, and as far beyond
    let there = 2.0 * 3.0_f64.sqrt() - 8.0 / 3.0;
    let law = "L = \"1/2*(x'^2 + y'^2) - sqrt(sqrt(x^2 + y^2))\"";
    let mut run = plane([-1.0, 0.0], [1.0, 0.0], law);
    near(&run.to(2.0 * there)[..4], &[1.0, 0.0, 1.0, 0.0], 2e-15);
    // a line on which x and y are rounded, to 1e-22 beside the origin: that deflects the motion by its root
    let (c, s) = (0.8, 0.6);
    let mut run = plane([-c, -s], [c, s], law);
    near(&run.to(2.0 * there)[..4], &[c, s, c, s], 1e-11);
    // beside it, where the motion is deflected, it keeps E and the angular momentum
    for beside in [1e-26, 1e-20, 1e-17, 1e-15, 1e-13, 1e-11, 1e-9] {
        let mut run = plane([-1.0, beside], [1.0, 0.0], law);
        let passed = run.to(2.0 * there);
        let [x, y, vx, vy] = [passed[0], passed[1], passed[2], passed[3]];
        assert!(x > 0.9, "{beside:e}: {passed:?}");
        let energy = 0.5 * (vx * vx + vy * vy) + (x * x + y * y).sqrt().sqrt();
        assert!((energy - 1.5).abs() < 2e-14, "{beside:e}: {energy}");
        let momentum = x * vy - y * vx;
        assert!((momentum + beside).abs() < 1e-15, "{beside:e}: {momentum:e}");
    }
}

/// The curve y = |x|^(5/2) has a curvature everywhere, though no series at x = 0.
#[test]
fn a_bead_passes_the_vertex_of_a_curve_that_has_two_derivatives_there() {
    let mut bead = plane(
        [-1.0, 1.0],
        [1.0, -2.5],
        "L = \"1/2*(x'^2 + y'^2) - y\"\n[[constraints]]\nname = \"wire\"\nexpression = \"y - abs(x)^2.5\"",
    );
    // the same in one coordinate
    let mut along = line("-1.0", "1.0", "L = \"1/2*x'^2*(1 + 25/4*abs(x)^3) - abs(x)^2.5\"");
    for t in [0.4, 0.6, 5.0] {
        let [bead, along] = [bead.to(t), along.to(t)];
        near(&[bead[0], bead[2]], &along[..2], 2e-14);
        near(&bead[1..2], &[along[0].abs().powf(2.5)], 2e-14);
    }
}

#[test]
fn drag_with_a_fractional_power_turns_the_motion() {
    // v' = −0.36 |v|^0.8: |v|^0.2 falls by 0.072 a second and ends at rest
    let mut run = line("0.0", "1.0", "L = \"1/2*x'^2\"\ndissipation = \"0.2*abs(x')^1.8\"");
    near(&run.to(1.0)[1..], &[(1.0_f64 - 0.072).powi(5)], 1e-15);
    near(&run.to(100.0), &[1.0 / (6.0 * 0.072), 0.0], 1e-12);
    let mut run =
        line("1.0", "0.0", "L = \"1/2*x'^2 - 1/2*x^2\"\ndissipation = \"0.3*abs(x')^1.8\"");
    let state = run.to(20.0);
    assert!(state[0].abs() < 0.1 && state[1].abs() < 0.1, "{state:?}");
}

#[test]
fn sides_are_chosen_before_a_series_is_judged() {
    let mut run = plane([4.0, 0.0], [1.0, 0.5], "L = \"1/2*(x'^2 + y'^2)*(1 + max(0, x - 5))\"");
    let energy = run.columns()[6];
    run.to(30.0);
    near(&run.columns()[6..7], &[energy], 1e-15);
    // on the wrong side of its kink this mass would be negative, then zero
    let mut run = line("0.0", "1.0", "L = \"1/2*x'^2*max(x + 1, -x - 1)\"");
    near(&run.to(1.0)[..1], &[2.5_f64.powf(2.0 / 3.0) - 1.0], 1e-15);
}

#[test]
fn a_force_that_grows_without_bound_is_passed_where_the_velocity_does_not() {
    // from rest at 1, √|x| is passed after (4/3) √2, |x|^(1/3) after ∫ dx / √(2 (1 − x^(1/3)))
    let quarter = 4.0 / 3.0 * 2.0_f64.sqrt();
    let mut run = potential("1.0", "0.0", "sqrt(abs(x))");
    near(&run.to(4.0 * quarter), &[1.0, 0.0], 1e-13);
    near(&run.columns()[3..4], &[1.0], 1e-14);
    let quarter = 3.0 / 2.0_f64.sqrt() * 16.0 / 15.0;
    let mut run = potential("1.0", "0.0", "abs(x)^(1/3)");
    // the tip is reached to 1e-30, whose third root is 1e-10
    near(&run.to(4.0 * quarter), &[1.0, 0.0], 4e-9);
}

#[test]
fn a_tip_that_is_only_touched_is_not_met_again_later() {
    // x = 1 − t²/2 + … reaches the tip |x| = 0 at rest at t = 2, and the inner one at 1 and 3
    let mut run = potential("1.0", "0.0", "abs(abs(x) - 0.5)");
    let state = run.to(3.5).clone();
    near(&[state[0].abs(), state[1].abs()], &[0.875, 0.5], 1e-7);
    near(&run.columns()[3..4], &[0.5], 1e-14);
}

#[test]
fn a_place_without_a_limit_is_reported() {
    let mut run = potential("1.0", "0.0", "ln(abs(x))");
    let error = run.try_to(10.0).expect_err("the velocity grows beyond all bounds");
    assert!(
        matches!(error.kind, MotionErrorKind::Rough | MotionErrorKind::StepUnderflow(_)),
        "{error}"
    );
    assert!(error.place[0].1.abs() < 1e-9 && run.steps < 500, "{error}");
}

#[test]
fn a_root_whose_argument_grows_slowly_from_zero_is_left() {
    // u leaves 0 as t³; the numbers by an extrapolated midpoint rule at 30 digits
    for power in ["(u^2)^1.25", "abs(u)^2.5"] {
        let mut run = Run::new(&format!(
            "title = \"slow\"\n[coordinates]\nu = {{ initial = 0.0 }}\nv = {{ initial = 1.0 }}\n[lagrangian]\n\
             L = \"1/2*u'^2 + 1/2*v'^2 + 0.4*u*v' - 1/2*v^2 - {power}\"\n"
        ));
        let state = run.to(3.0);
        let expected = [
            -0.434_359_920_062_244_24,
            -0.831_239_576_842_103_97,
            0.213_556_604_381_441_72,
            -0.121_435_634_313_768_17,
        ];
        near(&state[..4], &expected, 1e-13);
        assert!(run.steps < 200, "{power}: {} steps", run.steps);
    }
}

#[test]
fn a_step_shorter_than_the_last_digit_of_its_time_has_values_at_both_ends() {
    // near the kink, at t ≈ 7.5e9, steps are shorter than the distance between two numbers there
    let mut run = Run::new(
        "title = \"in SI units\"\n[coordinates]\n\
         x = { initial = 0.0, momentum = -1.78e-14 }\n\
         y = { initial = -28299999999.999996, momentum = 9.09e-14 }\n\
         z = { initial = -92900000000.0, momentum = 2.3e-15 }\n[hamiltonian]\n\
         H = \"500000000000000.06*(p_x^2 + p_y^2*(1 + (y/1e11)^2) + p_z^2) + \
              7.58e-12*sqrt((z/1e11 - 2.59e-12*x)^2)\"\n",
    );
    let energy = run.columns()[9];
    let mut observer = run.system.observer(&run.parameters);
    let (mut out, mut short) = (vec![0.0; run.system.columns()], 0);
    let mut state = run.stepper.state().clone();
    while run.stepper.time() != 1.4e10 {
        run.stepper.step(1.4e10).unwrap();
        let (begin, end) = run.stepper.interval();
        short += usize::from(end - begin < 1e-5);
        for time in [begin, 0.5 * (begin + end), end] {
            run.stepper.at(time, &mut state).unwrap();
            observer.observe_columns(&state, &mut out).unwrap();
            assert!((out[9] / energy - 1.0).abs() < 1e-14, "{} at {time}", out[9]);
        }
    }
    assert!(short > 3, "{short} steps are short");
}

/// Half-waves of a force to the power 3/2, which begin and end where a root is zero to rounding, 60 times. The velocity grows by the area
/// under each, a beta function.
#[test]
fn a_power_of_half_waves_is_passed_at_every_zero() {
    for rate in ["1.3", "1.7", "0.9", "2.1"] {
        let mut run = Run::new(&format!(
            "title = \"half-waves\"\n[coordinates]\nx = {{ initial = 0.3, velocity = 0.9 }}\n[lagrangian]\nL = \"1/2*x'^2\"\n\
             forces = {{ x = \"max(0, sin({rate}*t))^1.5\" }}\n"
        ));
        let w: f64 = rate.parse().unwrap();
        let waves = 60.0;
        let state = run.to(waves * std::f64::consts::TAU / w);
        // ∫₀^π sin^{3/2} = √π Γ(5/4)/Γ(7/4)
        let area = std::f64::consts::PI.sqrt() * 0.906_402_477_055_477_1 / 0.919_062_526_848_883_2;
        near(&state[1..2], &[0.9 + waves * area / w], 1e-12);
    }
}

/// Close to a pole, whose power has no branch to land on: an ellipse of eccentricity 1 − v² closes after its period.
#[test]
fn close_to_a_pole() {
    for speed in [1e-2, 1e-3, 1e-4] {
        let text = format!(
            "title = \"Close to the sun\"\n[coordinates]\nx = {{ initial = 1 }}\n\
             y = {{ initial = 0, momentum = {speed} }}\n[hamiltonian]\n\
             H = \"(p_x^2 + p_y^2)/2 - 1/sqrt(x^2 + y^2)\"\n"
        );
        let axis: f64 = 1.0 / (2.0 - speed * speed);
        let period = std::f64::consts::TAU * axis.powf(1.5);
        for (tolerance, within) in [(Some(1e-12), 1e-5), (Some(1e-15), 1e-6), (None, 1e-11)] {
            let mut run = Run::with(&text, tolerance);
            near(&run.to(period)[..2], &[1.0, 0.0], within);
        }
    }
}

/// Two unequal masses in two directions: the pole is passed at 1e-7 of the distance from which it is reached, after many
/// passages that are wider.
#[test]
fn close_to_a_pole_by_chance() {
    let text = "title = \"By chance\"\n[coordinates]\nu = { initial = 0.034, velocity = 0.205 }\n\
         v = { initial = 0.375, velocity = 0.83 }\n[lagrangian]\n\
         L = \"0.37*u'^2 + 0.5*exp(0.984*v)*v'^2 - 0.614*u^2 - 0.338*v^2 + 1.332/sqrt(u^2 + v^2) + 1.478/sqrt(u^2 + v^2 + 1)\"\n";
    for (tolerance, within) in [(1e-12, 1e-6), (1e-14, 1e-6), (1e-16, 1e-6), (1e-20, 1e-8)] {
        let mut run = Run::with(text, Some(tolerance));
        let energy = run.columns()[6];
        // dop853 with the tolerance 1e-13 agrees to 2e-5, its own error there
        near(&run.to(3.0)[..2], &[0.0231676295084, -0.2415027963868], within);
        near(&run.columns()[6..7], &[energy], within);
    }
}

/// arctan(tan t) is a sawtooth s, and a step may not go over its jumps on the branch of before: v = s²/2.
#[test]
fn a_tangent_passes_its_poles_one_by_one() {
    let mut run = line("0", "0", "L = \"1/2*x'^2\"\nforces = { x = \"atan(tan(t))\" }");
    // a pole is leapt over by a short step, which costs 2e-13 each
    for (time, poles) in [(1.5, 0.0), (3.0, 1.0), (4.5, 1.0), (10.0, 3.0), (31.0, 10.0_f64)] {
        let s = time - poles * PI;
        let x = poles * PI.powi(3) / 24.0 + s.powi(3) / 6.0;
        near(&run.to(time), &[x, s * s / 2.0], 4e-12);
    }
}

/// Along y = 0 the root of y² + x^{2k} is |x|^k, which only touches zero for k > 1, so that its zero is known to some digits only. The
/// kink that lies there as well is where the step ends: the motion is that with |x|^k written out.
#[test]
fn a_kink_where_a_root_touches_zero() {
    let mut passed = 0;
    for (kinks, root, power) in [
        ("tanh(x)^2 + abs(x)", "sqrt(y^2 + x^4)", "x^2"),
        ("abs(x)", "sqrt(y^2 + x^4)", "x^2"),
        ("sqrt(x^2 + y^2)", "sqrt(y^2 + x^4)", "x^2"),
        ("3*abs(x)", "sqrt(4*y^2 + x^6)", "abs(x)^3"),
        ("max(x, -2*x)", "2*sqrt(y^2 + x^4)", "2*x^2"),
        ("abs(sin(x))^1.5", "acos(cos(x))/5", "abs(x)/5"),
    ] {
        let begun = |v: &str| {
            let l = format!("L = \"1/2*(x'^2 + y'^2) - 1/2*y^2 - ({kinks} + {v})\"");
            plane([0.7, 0.0], [0.0, 0.0], &l)
        };
        let (mut run, mut plain) = (begun(root), begun(power));
        let energy = plain.columns()[6];
        let mut side = true;
        for k in 1..=120 {
            let time = 0.25 * f64::from(k);
            let (there, here) = (plain.to(time), run.to(time));
            near(&here, &there, 2e-13);
            near(&run.columns()[6..7], &[energy], 2e-14);
            passed += u32::from((here[0] > 0.0) != side);
            side = here[0] > 0.0;
        }
    }
    assert!(passed > 100, "{passed}");
}

/// A root whose exponent a parameter gives has the kinks of one that is written: (1 − sin 2x)^p = |sin x − cos x| for p = ½, and so has
/// e^(p ln u). A whole power has none, and a pole stays one.
#[test]
fn a_power_with_the_exponent_of_a_parameter_is_followed_through_its_kinks() {
    let end = |v: &str, p: f64| {
        let mut run = Run::new(&format!(
            "title = \"Kinks\"\n[coordinates]\nx = {{ initial = 0.5, velocity = 1.3 }}\n[parameters]\np = {p:?}\n\
             [lagrangian]\nL = \"1/2*x'^2 - {v}\"\n"
        ));
        run.to(20.0)
    };
    let wanted = end("abs(sin(x) - cos(x))", 0.5);
    for v in ["(1 - sin(2*x))^p", "(1 - sin(2*x))^(p/2 + 0.25)", "exp(p*ln(1 - sin(2*x)))"] {
        near(&end(v, 0.5), &wanted, 1e-13);
    }
    near(&end("(1 - sin(2*x))^p", 1.25), &end("abs(sin(x) - cos(x))^2.5", 0.0), 1e-13);
    near(&end("(1 - sin(2*x))^p", 2.0), &end("(1 - sin(2*x))^2", 0.0), 1e-13);
    near(&end("(sin(x) - cos(x))^p", 3.0), &end("(sin(x) - cos(x))^3", 0.0), 1e-13);
}

/// Beside a power whose exponent a parameter gives a pole is seen as ever: the particle turns back before x = 0, where 1/x² is larger
/// than its energy, and with the exponent written in it does the same.
#[test]
fn a_pole_beside_a_power_with_the_exponent_of_a_parameter_turns_back() {
    let end = |v: &str, n: f64| {
        let mut run = Run::new(&format!(
            "title = \"Pole\"\n[coordinates]\nx = {{ initial = 3, velocity = -1 }}\n[parameters]\nn = {n:?}\n\
             [lagrangian]\nL = \"1/2*x'^2 - ({v})\"\n"
        ));
        run.to(8.0)
    };
    for (n, written) in [(-2.0, "x^(-2)"), (2.0, "x^2"), (2.5, "x^2.5"), (-0.5, "1/sqrt(x)")] {
        let by_parameter = end("1e-3/x + 0.01*x^n", n);
        let wanted = end(&format!("1e-3/x + 0.01*{written}"), n);
        near(&by_parameter, &wanted, 1e-12);
        assert!(wanted[1] > 0.0, "{written}: {wanted:?}");
    }
}
