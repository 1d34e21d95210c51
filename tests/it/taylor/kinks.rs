//! Kinks, compared with closed forms composed of pieces.

use phaselab::diagnostic::Document;
use phaselab::experiment::Prepared;
use phaselab::integrate::{METHODS, Settings};
use phaselab::num::DoubleDouble;

use super::{Run, near};

/// One coordinate: initial value, velocity, Lagrangian, dissipation, force.
fn one(initial: &str, velocity: &str, l: &str, dissipation: &str, force: &str) -> Run {
    Run::new(&format!(
        "title = \"Kinks\"\n[coordinates]\nx = {{ initial = {initial}, velocity = {velocity} }}\n[parameters]\nn = 2\n[lagrangian]\nL = \"{l}\"\ndissipation = \"{dissipation}\"\nforces = {{ x = \"{force}\" }}\n"
    ))
}

#[test]
fn dry_friction_brings_an_oscillator_to_rest_and_holds_it() {
    // amplitudes decrease by 2F every half period: 1, −0.4, 0.2, where the spring is weaker than F
    let mut run = one("1.0", "0.0", "1/2*x'^2 - 1/2*x^2", "0.3*abs(x')", "0");
    let pi = std::f64::consts::PI;
    near(&run.to(1.0), &[0.3 + 0.7 * 1.0_f64.cos(), -0.7 * 1.0_f64.sin()], 1.2e-16);
    near(&run.to(pi), &[-0.4, 0.0], 2e-16);
    near(&run.to(5.0), &[-0.3 - 0.1 * (5.0 - pi).cos(), 0.1 * (5.0 - pi).sin()], 2e-16);
    near(&run.to(50.0), &[-0.2, 0.0], 1.2e-16);
    assert!(run.steps < 16, "{} steps", run.steps);
}

#[test]
fn friction_holds_from_the_start_until_the_pull_is_strong_enough() {
    // pulled with force t/2 against friction 1: it lets go at t = 2, then x'' = t/2 − 1
    let mut run = one("0.5", "0.0", "1/2*x'^2", "abs(x')", "t/2");
    assert_eq!(run.to(1.9)[..2], [0.5, 0.0]);
    let (t, rest) = (5.0_f64, 2.0);
    let s = t - rest;
    near(&run.to(t), &[0.5 + s.powi(3) / 12.0, s * s / 4.0], 4e-16);
}

#[test]
fn a_block_on_a_belt_sticks_and_slips() {
    // carried by the belt until the spring force equals the friction, x = 1
    let mut run = one("0.0", "0.5", "1/2*x'^2 - 1/2*x^2", "0", "-sign(x' - 1/2)");
    near(&run.to(1.5), &[0.75, 0.5], 1.2e-16);
    // released at t = 2: x = 1 + ½ sin(t − 2) until its speed is ½ again, a whole period later
    near(&run.to(4.0), &[1.0 + 0.5 * 2.0_f64.sin(), 0.5 * 2.0_f64.cos()], 1e-15);
}

#[test]
fn two_contacts_hold_and_let_go_each_by_itself() {
    let mut run = Run::new(
        r#"
title = "Two blocks, one on the other"
[coordinates]
x = { initial = 0.0, velocity = 0.0 }
y = { initial = 0.0, velocity = 0.0 }
[lagrangian]
L = "1/2*x'^2 + 1/2*y'^2"
dissipation = "1/2*abs(x') + 1/4*abs(y' - x')"
forces = { y = "t/4" }
"#,
    );
    // the upper contact slips first, at t = 1, while the lower one still sticks: ¼ < ½
    assert_eq!(run.to(1.0)[..4], [0.0; 4]);
    let s = 2.0_f64;
    near(&run.to(3.0), &[0.0, s.powi(3) / 24.0, 0.0, s * s / 8.0], 2e-16);
}

#[test]
fn quadratic_drag_up_and_down() {
    // m = 1, g, drag k v|v|: up v = √(g/k) tan(c − √(gk) t), down v = −√(g/k) tanh(√(gk)(t − t₁))
    let mut run = one("0.0", "20.0", "1/2*x'^2 - 9.81*x", "0", "-0.02*x'*abs(x')");
    let (w, rate) = ((9.81_f64 / 0.02).sqrt(), (9.81_f64 * 0.02).sqrt());
    let top = (20.0 / w).atan() / rate;
    let height = (1.0 + 400.0 / (w * w)).ln() / 0.04;
    let at = |t: f64| {
        let s = rate * (t - top);
        if t < top {
            [height + s.cos().ln() / 0.02, -w * s.tan()]
        } else {
            [height - s.cosh().ln() / 0.02, -w * s.tanh()]
        }
    };
    for t in [0.5, 1.5, 2.0, 5.0] {
        near(&run.to(t), &at(t), 3e-14);
    }
}

#[test]
fn a_one_sided_spring_throws_back() {
    // falls from 1 with g = 1 on a spring of stiffness 100 at 0
    let mut run = one("1.0", "0.0", "1/2*x'^2 - x - 50*max(0, -x)^2", "0", "0");
    let (v, w) = (2.0_f64.sqrt(), 10.0_f64);
    // in contact x = −1/w² + A cos(w s + φ); it leaves with its initial speed
    let (shift, speed) = (1.0 / (w * w), v / w);
    let contact = (std::f64::consts::PI + 2.0 * (shift / speed).atan()) / w;
    let period = 2.0 * v + contact;
    near(&run.to(period), &[1.0, 0.0], 2e-15);
    let s = 0.03_f64;
    let inside = [
        -shift + shift * (w * s).cos() - speed * (w * s).sin(),
        -shift * w * (w * s).sin() - v * (w * s).cos(),
    ];
    near(&run.to(period + v + s), &inside, 3e-15);
}

#[test]
fn a_wedge_and_its_square_root_disguise_are_the_same() {
    for potential in ["abs(x)", "sqrt(x^2)", "max(x, -x)"] {
        let mut run = one("0.5", "0.0", &format!("1/2*x'^2 - {potential}"), "0", "0");
        // from x₀ to the kink in √(2 x₀) = 1, and so on
        near(&run.to(1.0), &[0.0, -1.0], 1e-16);
        near(&run.to(2.0), &[-0.5, 0.0], 1e-16);
        near(&run.to(4.0), &[0.5, 0.0], 1e-16);
        near(&run.to(40.5), &[0.375, -0.5], 5e-16);
    }
}

#[test]
fn a_square_wave_switches_with_the_clock() {
    let mut run = one("0.0", "0.0", "1/2*x'^2", "0", "sign(sin(pi*t))");
    near(&run.to(1.0), &[0.5, 1.0], 1e-16);
    near(&run.to(2.0), &[1.0, 0.0], 2e-16);
    near(&run.to(21.0), &[10.5, 1.0], 2e-15);
}

/// √max(0, 1 − x²) is 0 beyond the unit interval, and its slope 0/0 as it is written; at x = 1 the force grows without bound.
#[test]
fn a_root_of_what_vanishes_on_one_side_exerts_no_force_there() {
    for height in ["sqrt(max(0, 1 - x^2))", "max(0, 1 - x^2)^(1/n)"] {
        let mut run = one("2.0", "-1.0", &format!("1/2*x'^2 - {height}"), "0", "0");
        near(&run.to(0.9), &[1.1, -1.0], 1e-16);
        // too slow to pass: V = 1/2 at x = √3/2; thrown back as fast as it came
        let back = run.to(5.0);
        near(&back[1..], &[1.0], 1e-14);
        // fast enough, through both ends
        let mut run = one("2.0", "-2.0", &format!("1/2*x'^2 - {height}"), "0", "0");
        let through = run.to(5.0);
        assert!(through[0] < -1.0);
        near(&through[1..], &[-2.0], 1e-14);
    }
    let mut run = one("-1.0", "1.0", "1/2*x'^2 - sqrt(max(0, x))", "0", "0");
    // s = √x turns at 1/2, after ∫ 2 s ds/√(1 − 2 s) = 2/3
    near(&run.to(1.0 + 2.0 / 3.0), &[0.25, 0.0], 1e-14);
    near(&run.to(1.0 + 4.0 / 3.0 + 1.0), &[-1.0, -1.0], 1e-14);
}

/// A switch with another in it jumps where that one changes its side, and no root of its series shows it.
#[test]
fn a_switch_that_jumps_with_another_is_on_the_side_of_its_value() {
    // drawn to where the target is: x < 4 with x' > 0 when it jumps from −4 to 4
    let mut run = one("0.0", "2.0", "1/2*x'^2", "0", "-sign(x - 4*sign(t - 1))");
    near(&run.to(1.0), &[1.5, 1.0], 0.0);
    near(&run.to(2.0), &[3.0, 2.0], 1e-16);
    // with x' < 0
    let mut run = one("0.0", "0.0", "1/2*x'^2", "0", "-sign(x - 4*sign(t - 1))");
    near(&run.to(2.0), &[-1.0, 0.0], 1e-16);
    // and once more, through a third: max(0, u) + 4 for t > 1 and max(0, u) − 4 before
    let third = "-sign(max(0, x - 4*sign(t - 1)) - 1)";
    let mut run = one("0.0", "1.0", "1/2*x'^2", "0", third);
    near(&run.to(2.0), &[0.5 + 0.5, 0.0 + 1.0], 1e-16);
    // carried by a belt that is turned back at t = 1, and overtaken by it at t = 2
    let belt = "-2*sign(x' - sign(t - 1))";
    let mut run = one("0.0", "0.0", "1/2*x'^2", "0", belt);
    near(&run.to(1.0), &[-0.75, -1.0], 1e-16);
    near(&run.to(1.5), &[-1.0, 0.0], 1e-16);
    near(&run.to(3.0), &[0.25, 1.0], 1e-16);
}

/// At the start the sign is 0, and so is the switch of what it is in, which no term of a series leads away from there.
#[test]
fn a_motion_may_begin_where_a_switch_jumps_with_another() {
    for (force, wanted) in [
        ("max(0, sign(t))", 1.0),
        ("max(sign(t), 0)", 1.0),
        ("max(0, -sign(t))", 0.0),
        ("min(0, -sign(t))", -1.0),
        ("abs(sign(t) + 1)", 2.0),
        ("sign(max(0, sign(t)) - 1/2)", 1.0),
        ("max(0, sign(x' + t))", 1.0),
    ] {
        let mut run = one("0.0", "0.0", "1/2*x'^2", "0", force);
        near(&run.to(2.0), &[2.0 * wanted, 2.0 * wanted], 1e-15);
    }
    // the switch of the maximum is off its surface, and leads back to it at t = 1
    let mut run = one("0.0", "0.0", "1/2*x'^2", "0", "max(abs(t), sign(t))");
    near(&run.to(1.0), &[0.5, 1.0], 1e-15);
    near(&run.to(2.0), &[0.5 + 1.0 + 2.0 / 3.0, 2.5], 1e-15);
    // it comes to its surface where the sign is that of t > 0
    let mut run = one("0.0", "0.0", "1/2*x'^2", "0", "min(1 - t, sign(t))");
    near(&run.to(1.0), &[1.0 / 3.0, 0.5], 1e-15);
    // on and off, eight times
    let mut run = one("0.0", "0.0", "1/2*x'^2", "0", "max(0, sign(sin(pi*t)))");
    near(&run.to(16.0), &[64.0 + 4.0, 8.0], 1e-14);
}

/// The sign of what is zero for a while is zero as long: a force that is there for x > 0 only, in both directions, and in time.
#[test]
fn a_sign_is_zero_where_its_argument_is() {
    for step in ["sign(max(0, x))", "max(0, sign(max(0, x)))", "sign(x + abs(x))"] {
        let mut run = one("-1.0", "1.0", "1/2*x'^2", "0", &format!("-{step}"));
        near(&run.to(0.5), &[-0.5, 1.0], 1e-15);
        near(&run.to(2.0), &[0.5, 0.0], 1e-15);
        near(&run.to(4.0), &[-1.0, -1.0], 1e-14);
    }
    let mut run = one("0.0", "0.0", "1/2*x'^2", "0", "sign(min(0, sign(t - 1)))");
    near(&run.to(1.0), &[-0.5, -1.0], 1e-15);
    near(&run.to(2.0), &[-1.5, -1.0], 1e-15);
    let mut run = one("0.0", "1.0", "1/2*x'^2", "0", "sign(max(0, t - 1))");
    near(&run.to(3.0), &[3.0 + 2.0, 3.0], 1e-14);
}

#[test]
fn a_live_exponent_makes_no_kink_where_it_is_an_integer() {
    // V = x^n/2 with n = 2 known only at run time: the oscillator, through x = 0
    let mut run = one("1.0", "0.0", "1/2*x'^2 - x^n/2", "0", "0");
    near(&run.to(10.0), &[10.0_f64.cos(), -10.0_f64.sin()], 1.2e-16);
}

#[test]
fn backwards_through_a_kink() {
    let mut run = one("0.5", "0.0", "1/2*x'^2 - abs(x)", "0", "0");
    run.to(7.25);
    near(&run.to(0.0), &[0.5, 0.0], 1e-16);
}

#[test]
fn at_rest_on_the_ridge_of_a_roof_it_falls_and_in_the_valley_it_rests() {
    let mut run = one("0.0", "0.0", "1/2*x'^2 + abs(x)", "0", "0");
    near(&run.to(2.0), &[2.0, 2.0], 0.0);
    // at the bottom of the wedge both sides push back
    let mut run = one("0.0", "0.0", "1/2*x'^2 - abs(x)", "0", "0");
    assert_eq!(run.to(1e3), [0.0, 0.0]);
    // until the pull exceeds their force: from t = 2 on x'' = t/2 − 1
    let mut run = one("0.0", "0.0", "1/2*x'^2 - abs(x)", "0", "t/2");
    near(&run.to(1.9), &[0.0, 0.0], 0.0);
    let s = 3.0_f64;
    near(&run.to(5.0), &[s.powi(3) / 12.0, s * s / 4.0], 4e-16);
}

#[test]
fn friction_may_be_written_as_a_quotient() {
    for friction in ["-0.3*sign(x')", "-0.3*x'/abs(x')", "-0.3*x'/sqrt(x'^2)"] {
        // a spring that is too weak from the start
        let mut run = one("0.2", "0.0", "1/2*x'^2 - 1/2*x^2", "0", friction);
        assert_eq!(run.to(10.0)[..2], [0.2, 0.0], "{friction}");
        let mut run = one("0.3", "0.0", "1/2*x'^2 - 1/2*x^2", "0", friction);
        assert_eq!(run.to(10.0)[..2], [0.3, 0.0], "{friction}");
        // a spring that is stronger
        let mut run = one("1.0", "0.0", "1/2*x'^2 - 1/2*x^2", "0", friction);
        near(&run.to(1.0), &[0.3 + 0.7 * 1.0_f64.cos(), -0.7 * 1.0_f64.sin()], 1.2e-16);
        near(&run.to(50.0), &[-0.2, 0.0], 1.2e-16);
    }
}

/// A block on a rough table: potential, initial position and velocity, friction.
fn table(potential: &str, x: [f64; 2], v: [f64; 2], mu: f64) -> Run {
    Run::new(&format!(
        "title = \"A rough table\"\n[coordinates]\nx = {{ initial = {}, velocity = {} }}\ny = {{ initial = {}, velocity = {} }}\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2) - ({potential})\"\nforces = {{ x = \"-{mu}*x'/sqrt(x'^2 + y'^2)\", y = \"-{mu}*y'/sqrt(x'^2 + y'^2)\" }}\n",
        x[0], v[0], x[1], v[1]
    ))
}

#[test]
fn friction_in_the_plane_brings_to_rest_and_holds() {
    // from speed 5 with deceleration ½: at rest after 10, 25 away
    let mut run = table("0", [0.0, 0.0], [3.0, 4.0], 0.5);
    near(&run.to(4.0), &[9.6, 12.8, 1.8, 2.4], 4e-15);
    near(&run.to(100.0), &[15.0, 20.0, 0.0, 0.0], 4e-14);
    assert!(run.steps < 100, "{} steps", run.steps);
    // on an incline that is not too steep it curves and comes to rest: v (1 + sin)^…, by the law
    // v' = −µ + g cos θ; the energy lost is µ times the path length
    let mut run = table("0.2*y", [0.0, 0.0], [3.0, 4.0], 0.5);
    let end = run.to(1000.0);
    near(&end[2..], &[0.0, 0.0], 0.0);
    near(&end[..2], &[13.125, 14.047_619_047_619_047], 1e-9);
}

#[test]
fn on_a_steep_incline_it_sets_out_and_on_a_flat_one_it_does_not() {
    let mut run = table("0.7*y", [0.0, 0.0], [0.0, 0.0], 0.5);
    near(&run.to(10.0), &[0.0, -10.0, 0.0, -2.0], 1e-14);
    let mut run = table("0.3*x + 0.3*y", [0.0, 0.0], [0.0, 0.0], 0.5);
    assert_eq!(run.to(10.0)[..4], [0.0; 4]);
}

#[test]
fn kinks_a_trillionth_of_the_way_apart_are_crossed_in_one_step_and_farther_ones_in_two() {
    let steps = |apart: &str| {
        let l = format!("1/2*x'^2 - abs(x) - abs(x - {apart})");
        let mut run = one("-1.0", "1.0", &l, "0", "0");
        // x'' = 2 up to the kinks: x = −1 + t + t², there at the golden section, with velocity √5
        run.to(1.0);
        run.steps
    };
    assert_eq!(steps("2.2e-12"), steps("7e-13") + 1);
}

/// A body whose mass becomes four times as large within a very short time keeps its momentum. A short change of a force is the control.
#[test]
fn what_changes_within_a_short_time_is_not_stepped_over() {
    for (potential, at_3) in [("0", [1.5, 0.25]), ("1/2*x^2", [0.0; 2])] {
        for width in [1e-7, 1e-8, 1e-9, 1e-10] {
            let ramp = format!("min(1, max(0, (t - 1)/{width:e}))");
            let mut run =
                one("0.0", "1.0", &format!("1/2*(1 + 3*{ramp})*x'^2 - {potential}"), "0", "0");
            // x = sin t, x' = cos t up to the change; then x' is a quarter, and the frequency a half
            let expected = if potential == "0" {
                at_3
            } else {
                let (x, v) = (1.0_f64.sin(), 1.0_f64.cos() / 4.0);
                [
                    x * 1.0_f64.cos() + 2.0 * v * 1.0_f64.sin(),
                    -0.5 * x * 1.0_f64.sin() + v * 1.0_f64.cos(),
                ]
            };
            near(&run.to(3.0)[..2], &expected, 2.0 * width + 1e-9);
        }
    }
}

/// A barrier twice as high as the energy throws back, however narrow it is and however far away the end of the run.
#[test]
fn a_narrow_barrier_throws_back_whatever_the_end_of_the_run() {
    for width in [1e-3, 1e-6, 1e-9] {
        for end in [20.0, 1e3, 1e5, 1e7] {
            let barrier = format!("max(0, 1 - abs(x - 10)/{width:e})");
            let mut run = one("0.0", "1.0", &format!("1/2*x'^2 - 2*{barrier}"), "0", "0");
            // within it the velocity falls at the rate 2/w, to zero at a quarter of the way up
            let returned = 2.0 * (10.0 - width) + width - end;
            near(&run.to(end)[..2], &[returned, -1.0], 1e-14 * end + 1e-7);
        }
    }
}

/// Roots of functions whose terms cancel at their zero, in `f64`: the same laws written with `abs` are the reference.
#[test]
fn kinks_hidden_in_cancelling_terms_are_passed_in_f64() {
    let run = |potential: &str, (x, v): (&str, &str), tolerance: Option<f64>| {
        let text = format!(
            "title = \"hidden\"\n[coordinates]\nx = {{ initial = {x}, velocity = {v} }}\n[lagrangian]\n\
             L = \"1/2*x'^2 - {potential}\"\n"
        );
        Run::with(&text, tolerance).to(100.0)
    };
    let start = ("0.3", "1.2");
    for (hidden, plain, start) in [
        ("sqrt(1 - cos(x))", "sqrt(2)*abs(sin(x/2))", start),
        ("(1 - cos(x))^(3/4)", "2^(3/4)*abs(sin(x/2))^1.5", ("0.4", "0.6")),
        ("sqrt((x - 1)^2*(x + 1)^2)", "abs(x^2 - 1)", ("0.3", "1.5")),
        ("sqrt(2 + 2*cos(x))", "2*abs(cos(x/2))", ("0.2", "3.3")),
    ] {
        let (found, expected) = (run(hidden, start, Some(1e-15)), run(plain, start, None));
        near(&found[..2], &expected[..2], 1e-8);
    }
}

#[test]
fn at_rest_on_a_kink_it_stays_to_the_last_bit() {
    // the pull of 0.3 is less than the jump of 1 to both sides
    for (initial, potential, force) in [
        ("0.0", "abs(x) + 0.3*x", "0"),
        ("0.7", "abs(x - 0.7) + 0.3*x", "0"),
        ("0.0", "abs(x)", "0.3*sin(t)"),
        ("0.0", "3*max(x, -x/2)", "-0.7*cos(2*t) - t/40"),
    ] {
        let mut run = one(initial, "0.0", &format!("1/2*x'^2 - {potential}"), "0", force);
        let x: f64 = initial.parse().unwrap();
        for t in [0.3, 1.0, 10.0, 20.0] {
            assert_eq!(run.to(t)[..2], [x, 0.0], "{potential} with {force} at {t}");
        }
    }
}

#[test]
fn one_rests_on_a_kink_while_another_that_is_coupled_to_it_swings() {
    // the pendulum's support is held by the kink as long as |T sin θ| is less than its jump
    let text = |support: &str| {
        format!(
            "title = \"Pendulum\"\n[coordinates]\nx = {{ initial = 0.0 }}\n\
             q = {{ initial = 0.5 }}\n[lagrangian]\n\
             L = \"x'^2 + x'*q'*cos(q) + 1/2*q'^2 + cos(q) - {support}\"\n"
        )
    };
    let mut held = Run::new(&text("5*abs(x)"));
    let alone = "title = \"Pendulum\"\n[coordinates]\nq = { initial = 0.5 }\n[lagrangian]\n\
                 L = \"1/2*q'^2 + cos(q)\"\n";
    let mut alone = Run::new(alone);
    for t in [0.4, 2.0, 7.0] {
        let held = held.to(t);
        assert_eq!([held[0], held[2]], [0.0, 0.0], "at {t}");
        near(&[held[1], held[3]], &alone.to(t)[..2], 2e-16);
    }
    // a jump of ±0.2 does not hold it
    assert!(Run::new(&text("1/5*abs(x)")).to(2.0)[0].abs() > 1e-3);
}

/// The end of the run is the only length of time known at first.
#[test]
fn rest_under_friction_ends_when_the_force_says_however_far_the_end_of_the_run_is() {
    let text = "title = \"Friction\"\n[coordinates]\nx = { initial = 0 }\ny = { initial = 0 }\n\
                [lagrangian]\nL = \"1/2*x'^2 + 1/2*y'^2 - 0.05*y + 0.4*x*sin(t)\"\n\
                dissipation = \"0.3*sqrt(x'^2 + y'^2)\"\n";
    for end in [2.5, 300.0, 20_000.0, 7e6] {
        let mut run = Run::new(text);
        while run.stepper.time() < 2.0 {
            run.stepper.step(end).unwrap();
        }
        let mut state = run.stepper.state().clone();
        run.stepper.at(2.0, &mut state).unwrap();
        // the numbers of `a_force_that_turns_sets_a_body_in_motion_against_dry_friction`
        near(&state.values[..2], &[0.043_977_287_439_496_93, -0.005_638_639_436_022_64], 4e-17);
    }
}

/// In the plane along a line, where all is as on the line: a block dragged by a spring, whose end moves evenly. The spring's
/// work is zero where the rest begins and not on the way, and places count as soon as it moves: it sets out at 3/8 with
/// x'' = 0.8 τ − 4 x, so that x' = (1 − cos 2τ)/5.
#[test]
fn a_block_that_is_dragged_sets_out_as_on_a_line() {
    for (x, y) in [("x", "y"), ("y", "x")] {
        let mut run = Run::new(&format!(
            "title = \"Dragged\"\n[coordinates]\nx = {{ initial = 0 }}\ny = {{ initial = 0 }}\n\
             [lagrangian]\nL = \"1/2*(x'^2 + y'^2) - 2*(({x} - 0.2*t)^2 + {y}^2)\"\n\
             dissipation = \"0.3*sqrt(x'^2 + y'^2)\"\n"
        ));
        let place = usize::from(x == "y");
        for t in [0.3_f64, 0.376, 0.38, 0.4, 0.5, 1.0] {
            let tau = (t - 0.375).max(0.0);
            let (v, moved) =
                ((1.0 - (2.0 * tau).cos()) / 5.0, tau / 5.0 - (2.0 * tau).sin() / 10.0);
            let found = run.to(t);
            near(&[found[place], found[place + 2]], &[moved, v], 1e-15);
            near(&[found[1 - place], found[3 - place]], &[0.0, 0.0], 1e-25);
        }
    }
}

/// Dragged diagonally it touches rest once a period, with v = 0 and v' = 0, and goes on the same way: at 1 − cos 2τ times the
/// velocity of the pull, up to any time, also one within a touch.
#[test]
fn a_block_dragged_diagonally_touches_rest_and_goes_on() {
    let pi = std::f64::consts::PI;
    let check = |[a, b]: [f64; 2], end: f64, within: f64| {
        let mut run = Run::new(&format!(
            "title = \"Dragged\"\n[coordinates]\nx = {{ initial = 0 }}\ny = {{ initial = 0 }}\n\
             [lagrangian]\nL = \"1/2*(x'^2 + y'^2) - 2*((x - ({a})*t)^2 + (y - ({b})*t)^2)\"\n\
             dissipation = \"0.3*sqrt(x'^2 + y'^2)\"\n"
        ));
        let tau = end - 0.3 / 4.0 / a.hypot(b);
        let (v, moved) = (1.0 - (2.0 * tau).cos(), tau - 0.5 * (2.0 * tau).sin());
        near(&run.to(end), &[a * moved, b * moved, a * v, b * v], within);
    };
    // exactly diagonal too, where the velocities are the same number; by rounding, some steps land on a touch
    for (a, b) in
        [(0.2_f64, 0.1_f64), (0.1, -0.2), (0.17, 0.17), (-0.3, 0.3), (0.07, 0.3), (0.25, 0.25)]
    {
        for tau in [1.0, 3.0, 3.13, pi, 3.15, 3.2, 4.0, 6.0, 2.0 * pi, 7.0, 20.0, 60.0] {
            check([a, b], 0.3 / 4.0 / a.hypot(b) + tau, 2e-14);
        }
    }
    // and some so close before one that friction leaves no longer steps than 1e-19 and 1e-12
    check([-0.467, -0.006], 61.7, 1e-13);
    check([0.488, 0.488], 40.3, 1e-13);
}

/// Friction at rest does no work, and what drags it does: the energy balance holds, also where it is zero at first.
#[test]
fn the_energy_of_what_drags_a_block_at_rest_is_its_work() {
    for start in ["0", "1e-3", "-0.02"] {
        let text = format!(
            "title = \"Dragged\"\n[coordinates]\nx = {{ initial = {start} }}\ny = {{ initial = 0 }}\n\
             [lagrangian]\nL = \"1/2*(x'^2 + y'^2) - 2*((x - 0.2*t)^2 + y^2)\"\n\
             dissipation = \"0.3*sqrt(x'^2 + y'^2)\"\n"
        );
        for end in [0.2, 1.0, 6.0] {
            let mut ready = Prepared::of(&Document::new("dragged.toml", text.clone())).unwrap();
            ready.experiment.advance(end, u64::MAX);
            let gauges = ready.experiment.snapshot().gauges;
            let balance = gauges.iter().find(|g| g.name == "energy balance").expect("a gauge");
            let (drift, word) = (balance.max_drift, balance.verdict.word());
            assert!(drift < 1e-13, "from {start} to {end}: {drift}, {word}");
        }
    }
}

/// A drive |t − t₀|^p does its work at a rate that grows without bound at t₀, and its balance does not drift away, whatever p. The
/// motion is a sum of powers.
#[test]
fn the_energy_balance_holds_where_a_drive_has_a_vertical_tangent() {
    for power in [0.9_f64, 0.5, 0.3, 0.25, 0.1, 0.05] {
        for instant in [0.3_f64, 1.25] {
            let text = format!(
                "title = \"Driven\"\n[coordinates]\nx = {{ initial = -0.4, velocity = 1.3 }}\n\
                 [lagrangian]\nL = \"1/2*x'^2 - 0.5*abs(t - {instant})^{power}*x\"\n"
            );
            let mut ready = Prepared::of(&Document::new("driven.toml", text)).unwrap();
            ready.experiment.advance(3.0, u64::MAX);
            let snapshot = ready.experiment.snapshot();
            let (n, left) = (power + 1.0, 3.0 - instant);
            let v = 1.3 - 0.5 / n * (left.powf(n) + instant.powf(n));
            let way = (left.powf(n + 1.0) - instant.powf(n + 1.0)) / (n + 1.0);
            let x = -0.4 + 1.3 * 3.0 - 0.5 / n * (way + instant.powf(n) * 3.0);
            near(&snapshot.values[..2], &[x, v], 1e-14);
            let gauge = snapshot.gauges.iter().find(|g| g.name == "energy balance");
            let (drift, word) = gauge.map(|g| (g.max_drift, g.verdict.word())).expect("a gauge");
            assert!(drift < 1e-10, "|t - {instant}|^{power}: {drift:e}, {word}");
            assert!(!["secular", "lost"].contains(&word), "|t - {instant}|^{power}: {word}");
        }
    }
}

/// Where the motion between kinks is a polynomial no step is too long, and a step may be asked for that is any number of
/// times longer than the way to the kink. A wedge from rest at 20 is passed at √40 with this velocity, and then at every
/// 2 √40.
#[test]
fn a_kink_is_passed_in_any_long_step() {
    let text = "title = \"Wedge\"\n[coordinates]\nx = { initial = 20 }\n\
                [lagrangian]\nL = \"1/2*x'^2 - abs(x)\"\n";
    let root = 40.0_f64.sqrt();
    for far in [1e3, 1e8, 1e12, 1e20, 1e40, 1e88, 1e140] {
        let mut run = Run::new(text);
        for passage in 0..4 {
            run.stepper.step(far).unwrap_or_else(|error| panic!("to {far:e}: {error}"));
            let turned = if passage % 2 == 0 { -root } else { root };
            let time = root * f64::from(1 + 2 * passage);
            near(&run.stepper.state().values, &[0.0, turned], 1e-13);
            assert!((run.stepper.time() - time).abs() < 1e-13, "{far:e}: {}", run.stepper.time());
        }
    }
}

/// The default step of a fixed-step method is a part of the way between two kinks, where nothing else sets a scale, in any
/// units and wherever the motion begins.
#[test]
fn the_default_step_in_a_wedge_is_a_part_of_its_period() {
    let rk4 = METHODS.iter().find(|method| method.name == "rk4").expect("a method");
    // from rest at x, or from the kink at v, with this acceleration
    for (x, v, a) in [
        (20.0, 0.0, 1.0),
        (1e-27, 0.0, 1.0),
        (1e-27, 0.0, 1e10),
        (-1e-27, 0.0, 1e10),
        (0.0, 1e-27, 1.0),
        (1e-200, 0.0, 1.0),
        (1e60, 0.0, 1e-20),
    ] {
        let Run { system, parameters, .. } = Run::new(&format!(
            "title = \"Wedge\"\n[coordinates]\nx = {{ initial = {x:e}, velocity = {v:e} }}\n\
             y = {{ initial = 1, velocity = 1e-3 }}\n[lagrangian]\n\
             L = \"1/2*x'^2 + 1/2*y'^2 - {a:e}*abs(x)\"\n"
        ));
        let state = system.initial(0.0, &parameters, &[]).expect("regular");
        let mut stepper =
            (rk4.make)(&system, &Settings { step: None, tolerance: None }).expect("it fits");
        stepper.start(&state, &parameters).expect("regular");
        stepper.step(f64::INFINITY).expect("regular");
        let half_a_period =
            if x == 0.0 { 2.0 * v / a } else { 2.0 * (2.0 * f64::abs(x) / a).sqrt() };
        let part = stepper.step_size() / half_a_period;
        assert!((0.05..0.2).contains(&part), "{part} from {x:e}, {v:e} at {a:e}");
    }
}

/// Where a motion begins on a kink its velocity counts, however small it is beside what forces do until the end of the run.
#[test]
fn a_motion_that_begins_on_a_kink_leaves_it_to_the_side_of_its_velocity() {
    for v in [1e-3, 1e-8, 1e-10, -1e-10, 1e-13, -1e-13, -1e-100] {
        let speed = f64::abs(v);
        for far in [1e-3, 1.0, 1e4, 1e10, 1e30] {
            // down from the ridge of a roof
            let mut run = one("0.0", &format!("{v:e}"), "1/2*x'^2 + abs(x)", "0", "0");
            run.stepper.step(far).unwrap();
            let (x, t) = (run.stepper.state().values[0], run.stepper.time());
            let expected = v * t + 0.5 * t * t * v.signum();
            assert!((x / expected - 1.0).abs() < 1e-15, "from {v:e} to {far:e}: {x:e}");
            // up the side of a wedge, and back at its bottom
            if 2.0 * speed < far {
                let mut run = one("0.0", &format!("{v:e}"), "1/2*x'^2 - abs(x)", "0", "0");
                run.stepper.step(far).unwrap_or_else(|error| panic!("to {far:e}: {error}"));
                let t = run.stepper.time();
                assert!((t / (2.0 * speed) - 1.0).abs() < 1e-15, "from {v:e} to {far:e}: {t:e}");
                let back = run.stepper.state().values[1];
                assert!((back / v + 1.0).abs() < 1e-15, "from {v:e} to {far:e}: {back:e}");
            }
        }
    }
    // a step that opens to one side only: back at once, then away for ever, and a rest that is left at t = 2
    let mut run = one("0.0", "1e-10", "1/2*x'^2 - max(x, 0)", "0", "0");
    near(&run.to(1e4), &[-1e-10 * (1e4 - 2e-10), -1e-10], 1e-21);
    for far in [1e6, 1e9, 1e12, 1e20] {
        let mut run = one("0.5", "0.0", "1/2*x'^2", "abs(x')", "t/2");
        while run.stepper.time() < 5.0 {
            run.stepper.step(far).unwrap();
        }
        let mut state = run.stepper.state().clone();
        run.stepper.at(5.0, &mut state).unwrap();
        near(&state.values[..2], &[2.75, 2.25], 4e-16);
    }
}

/// After an impulse whose sum with the velocity is not quite zero the rest is no velocity.
#[test]
fn what_an_impulse_leaves_by_rounding_does_not_make_it_hop() {
    let mut run = one("-1.0", "0.0", "1/2*x'^2 - abs(x)", "0", "0");
    let root = 2.0_f64.sqrt();
    while run.stepper.state().values[0] != 0.0 {
        run.stepper.step(10.0).unwrap();
    }
    let mut state = run.stepper.state().clone();
    near(&state.values[1..2], &[root], 3e-16);
    let rest = DoubleDouble::from(1e-17);
    state.set(1, rest);
    let parameters = run.parameters.clone();
    run.stepper.start(&state, &parameters).unwrap();
    near(&run.to(10.0), &[0.0, 0.0], 1e-15);
    assert!(run.steps < 10, "{} steps", run.steps);
}

/// Where the speed has come down to 1 the dissipation max(|sin 3t|, max(1, v)) brakes no more: at the kink of the inner maximum the body
/// goes on, and that of the outer one is only touched.
#[test]
fn a_kink_that_is_touched_on_another_is_passed() {
    for speed in [1.0, 1.5, 2.0, 3.0] {
        let mut run =
            one("0.0", &format!("{speed}"), "1/2*x'^2", "max(abs(sin(3*t)), max(1, x'))", "0");
        let braked = speed - 1.0;
        for time in [4.0, 50.0] {
            near(&run.to(time), &[0.5 * braked * braked + time, 1.0], 1e-13);
        }
    }
}

/// Along the bottom of the valley |x² + y² − 1| a body goes round with the speed that it has, up to any time.
#[test]
fn a_curved_valley_is_followed() {
    let mut run = Run::new(
        "title = \"Valley\"\n[coordinates]\nx = { initial = 1.0, velocity = 0.0 }\ny = { initial = 0.0, velocity = 0.5 }\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2) - abs(x^2 + y^2 - 1)\"\n",
    );
    for time in [4.0_f64, 6.0, 30.0, 100.0] {
        let (sin, cos) = (0.5 * time).sin_cos();
        near(&run.to(time), &[cos, sin, -0.5 * sin, 0.5 * cos], 1e-12);
        assert!(run.steps < 200, "{} steps", run.steps);
    }
}
