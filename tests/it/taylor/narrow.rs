//! What a series does not show before it is near: steep walls ahead of where a force is zero to all digits, thin barriers, short pulses.

use super::{Run, near};
use crate::nonempty;
use phaselab::num::gauss;

/// ∫ f from a to b, by Gauss's rule on many pieces.
fn integral(f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    const PIECES: u32 = 400;
    let piece = (b - a) / f64::from(PIECES);
    let nodes = gauss(12);
    let at = |k: u32, x: f64| f(a + piece * (f64::from(k) + x));
    let of_piece = |k: u32| nodes.iter().map(|&(x, w)| w * at(k, x)).sum::<f64>();
    piece * (0..PIECES).map(of_piece).sum::<f64>()
}

/// A potential of x/L in units of a square of a speed.
struct Wall {
    text: &'static str,
    value: fn(f64) -> f64,
    /// It is flat to all digits nearer to zero than the first of these, and farther than the second.
    flat: (f64, f64),
}

const WALLS: [Wall; 8] = [
    Wall { text: "1/(1 + X^100)", value: |u| 1.0 / (1.0 + u.powi(100)), flat: (0.6, 1.6) },
    Wall { text: "1/(1 + X^40)", value: |u| 1.0 / (1.0 + u.powi(40)), flat: (0.3, 3.0) },
    Wall { text: "exp(-X^80)", value: |u| (-u.powi(80)).exp(), flat: (0.55, 1.2) },
    Wall { text: "X^100/(1 + X^100)", value: |u| 1.0 / (1.0 + u.powi(-100)), flat: (0.6, 1.6) },
    Wall { text: "tanh(X^200)", value: |u| u.powi(200).tanh(), flat: (0.75, 1.1) },
    Wall {
        text: "X^60/sqrt(1 + X^120)",
        value: |u| 1.0 / (1.0 + u.powi(-120)).sqrt(),
        flat: (0.4, 2.0),
    },
    Wall { text: "1/(2 + X^100)^2", value: |u| (2.0 + u.powi(100)).powi(-2), flat: (0.6, 1.6) },
    Wall { text: "atan(X^150)", value: |u| u.powi(150).atan(), flat: (0.7, 1.4) },
];

/// A motion in the potential of a wall in units of length L and of speed s.
fn run(wall: &Wall, (length, speed): (f64, f64), (u, w): (f64, f64)) -> Run {
    let v = wall.text.replace('X', &format!("(x/{length:e})"));
    Run::new(&format!(
        "title = \"Narrow\"\n[coordinates]\nx = {{ initial = {:e}, velocity = {:e} }}\n[lagrangian]\nL = \"1/2*x'^2 - {:e}*({v})\"\n",
        u * length,
        w * speed,
        speed * speed,
    ))
}

/// Where the potential is an energy, between two places.
fn turning_point(wall: &Wall, energy: f64, (mut a, mut b): (f64, f64)) -> f64 {
    let is_inside = |u: f64| (wall.value)(u) < energy;
    let begin = is_inside(a);
    for _ in 0..200 {
        let middle = 0.5 * (a + b);
        *(if is_inside(middle) == begin { &mut a } else { &mut b }) = middle;
    }
    if begin { a } else { b }
}

/// The time from a place to a turning point, at a speed of √(2 (E − V)).
fn time_to_turn(wall: &Wall, energy: f64, from: f64, turn: f64) -> f64 {
    // u = turn − (turn − from) s²
    let speed = |s: f64| {
        let u = turn - (turn - from) * s * s;
        (2.0 * (energy - (wall.value)(u))).sqrt()
    };
    integral(|s| 2.0 * (turn - from).abs() * s / speed(s), 0.0, 1.0)
}

const UNITS: [(f64, f64); 3] = [(1.0, 1.0), (1e-7, 1e3), (3e9, 1e-4)];

/// Asserts that a motion is at u with the velocity w at a time, whatever rows are asked for before.
#[track_caller]
fn arrives(wall: &Wall, from: (f64, f64), time: f64, (u, w): (f64, f64), size: f64) {
    for (units, rows) in [(UNITS[0], 1), (UNITS[0], 60), (UNITS[1], 1), (UNITS[2], 1)] {
        let mut run = run(wall, units, from);
        for k in 1..=rows {
            run.to(time * units.0 / units.1 * (f64::from(k) / f64::from(rows)));
        }
        assert!(rows > 1 || run.steps < 1000, "{}: {} steps", wall.text, run.steps);
        let state = &run.stepper.state().values;
        let (x, v) = (state[0] / units.0, state[1] / units.1);
        // the force of a quotient is a difference of terms that grow within a step: some 1e-14 of the speed is lost in each step
        // across the wall
        let within = 3e-10 + 1e-12 * size;
        assert!(
            (x - u).abs() < within && (v - w).abs() < 1e-9,
            "{} from {from:?}, {units:?}, {rows} rows: {x} {v}, not {u} {w}",
            wall.text
        );
    }
}

#[test]
fn a_wall_ahead_of_where_the_force_is_zero_reflects() {
    for wall in nonempty(&WALLS) {
        let (near, far) = wall.flat;
        let (inside, outside) = ((wall.value)(0.0), (wall.value)(10.0));
        let (low, high) = (inside.min(outside), inside.max(outside));
        let energy = low + 0.6 * (high - low);
        let speed = (2.0 * (energy - low)).sqrt();
        let turn = turning_point(wall, energy, (near, far));
        // from the lower side: from inside a well, or from outside a hill, after one, ten and a thousand widths of it
        let is_well = inside < outside;
        let edge = if is_well { near } else { far };
        let there = time_to_turn(wall, energy, edge, turn);
        let starts = if is_well { [0.0, 0.2, -0.31] } else { [far, 13.0, 2000.0] };
        for start in nonempty(starts) {
            let time = 2.0 * ((edge - start).abs() / speed + there);
            let toward = if is_well { speed } else { -speed };
            arrives(wall, (start, toward), time, (start, -toward), start.abs());
        }
    }
}

#[test]
fn a_wall_is_passed_with_the_speed_that_it_leaves() {
    for wall in nonempty(&WALLS) {
        let (near, far) = wall.flat;
        let (inside, outside) = ((wall.value)(0.0), (wall.value)(10.0));
        let energy = inside.max(outside) + 0.3;
        let speeds = [inside, outside].map(|v| (2.0 * (energy - v)).sqrt());
        let across = integral(|u| 1.0 / (2.0 * (energy - (wall.value)(u))).sqrt(), near, far);
        for (from, to) in [(0.0, 30.0), (-0.2, 4e3)] {
            let time = (near - from) / speeds[0] + across + (to - far) / speeds[1];
            arrives(wall, (from, speeds[0]), time, (to, speeds[1]), to);
            arrives(wall, (to, -speeds[1]), time, (from, -speeds[0]), to);
        }
    }
}

#[test]
fn thin_barriers_reflect_in_any_unit() {
    for (c, n) in [(1e-25, 2), (1e-40, 4), (1e-60, 12), (1e-34, 3)] {
        for (length, speed) in nonempty(UNITS) {
            let strength = c * speed * speed * length.powi(n);
            let mut run = Run::new(&format!(
                "title = \"Thin\"\n[coordinates]\nx = {{ initial = {length:e}, velocity = {:e} }}\n[lagrangian]\nL = \"1/2*x'^2 - {strength:e}/x^{n}\"\n",
                -speed
            ));
            let state = run.to(3.0 * length / speed);
            // a hard wall at the turning point, but for its thickness
            let turn = (2.0 * c).powf(1.0 / f64::from(n));
            near(&[state[0] / length, state[1] / speed], &[2.0, 1.0], 4.0 * turn + 1e-12);
        }
    }
}

/// Of a place 30 the last digit of an `f64` is 3.6e-15.
#[test]
fn bodies_that_are_thinner_than_the_last_digit_of_their_place_collide() {
    let mut run = Run::new(
        "title = \"Two\"\n[coordinates]\nx = { initial = 30.0, velocity = 1.0 }\ny = { initial = 31.0, velocity = -1.0 }\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2) - 1e-30/(x - y)^2\"\n",
    );
    near(&run.to(2.0), &[29.0, 32.0, -1.0, 1.0], 1e-13);
}

/// A root elsewhere in the law hides no barrier.
#[test]
fn a_thin_barrier_beside_a_root_reflects() {
    for root in ["sqrt(1 + x^2)", "1/sqrt(x^2 + 0.01)", "(x + 9)^1.5", "sqrt(5 - x^2)"] {
        let end = |barrier: &str| {
            Run::new(&format!(
                "title = \"Root\"\n[coordinates]\nx = {{ initial = 2.0, velocity = -1.0 }}\n[lagrangian]\nL = \"1/2*x'^2 {barrier} - 1e-3*{root}\"\n"
            ))
            .to(4.0)[0]
        };
        assert!(end("") < -1.9 && end("- 1e-25/x^2") > 1.9, "{root}");
    }
}

#[test]
fn a_thin_barrier_in_the_way_of_an_oscillation_reflects() {
    // x² = cos² t + 2 c sin² t
    for c in [1e-10, 1e-25, 1e-45] {
        let mut run = Run::new(&format!(
            "title = \"Thin\"\n[coordinates]\nx = {{ initial = 1.0, velocity = 0.0 }}\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2 - {c:e}/x^2\"\n"
        ));
        for time in [1.0_f64, 3.0, 6.0, 20.0] {
            let (sin, cos) = time.sin_cos();
            let x = (cos * cos + 2.0 * c * sin * sin).sqrt();
            near(&run.to(time)[..1], &[x], 3e-13);
        }
    }
}

#[test]
fn a_wall_across_an_oscillation_is_seen() {
    // the energy is 40.5 at the bottom; the hill of height 1 is passed in both directions
    let mut run = Run::new(
        "title = \"Wall\"\n[coordinates]\nx = { initial = 0.0, velocity = 9.0 }\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2 - 1/(1 + (x/5)^100)\"\n",
    );
    let v = |x: f64| 0.5 * x * x + 1.0 / (1.0 + (x / 5.0).powi(100));
    let energy = 41.5;
    let across = |a: f64, b: f64| integral(|x| 1.0 / (2.0 * (energy - v(x))).sqrt(), a, b);
    let time = across(0.0, 3.0) + across(3.0, 8.0);
    near(&run.to(time), &[8.0, (2.0 * (energy - v(8.0))).sqrt()], 1e-11);
    run.to(300.0);
    near(&run.columns()[3..4], &[energy], 1e-10);
}

#[test]
fn bodies_collide_as_hard_spheres_do() {
    // masses 1 and 3 that repel each other where they are closer than 1
    let mut run = Run::new(
        "title = \"Two\"\n[coordinates]\nx = { initial = 0.0, velocity = 2.0 }\ny = { initial = 50.0, velocity = -1.0 }\n[lagrangian]\nL = \"1/2*x'^2 + 3/2*y'^2 - 100/(1 + (x - y)^100)\"\n",
    );
    let state = run.to(100.0);
    let centre = -0.25;
    near(&state[2..], &[2.0 * centre - 2.0, 2.0 * centre + 1.0], 1e-12);
}

/// Seen from the wall, which moves at a speed of 2, the body comes with this speed.
#[test]
fn a_wall_that_moves_throws_a_body_at_rest() {
    for (height, thrown) in [(5.0, -4.0), (1.0, 0.0)] {
        let mut run = Run::new(&format!(
            "title = \"Bat\"\n[coordinates]\nx = {{ initial = 0.0, velocity = 0.0 }}\n[lagrangian]\nL = \"1/2*x'^2 - {height}/(1 + (x - 50 + 2*t)^100)\"\n"
        ));
        near(&run.to(100.0)[1..], &[thrown], 1e-12);
    }
}

/// About θ = π nothing is left of (p − g (1 − cos θ))²/sin² θ = g² cot² (θ/2) where p = 2g: cos (θ/2) is that of an oscillator.
#[test]
fn a_pole_that_can_be_removed_is_passed() {
    let mut run = Run::new(
        "title = \"Monopole\"\n[coordinates]\nth = { initial = 2.0, momentum = 1.0 }\nf = { initial = 0.0, momentum = 0.8 }\n[hamiltonian]\nH = \"1/2*(p_th^2 + (p_f - 0.4*(1 - cos(th)))^2/sin(th)^2)\"\n",
    );
    let (g, u, slope) = (0.4_f64, 1.0_f64.cos(), -0.5 * 1.0_f64.sin());
    let energy = 0.5 + 0.5 * g * g / 1.0_f64.tan().powi(2);
    let rate = 0.5 * (2.0 * energy + g * g).sqrt();
    for k in 1..=20 {
        let time = f64::from(k);
        let (sin, cos) = (rate * time).sin_cos();
        near(&run.to(time)[..1], &[2.0 * (u * cos + slope / rate * sin).acos()], 1e-12);
    }
    assert!(run.steps < 500, "{}", run.steps);
}

#[test]
fn a_disc_keeps_what_bounces_in_it() {
    let mut run = Run::new(
        "title = \"Disc\"\n[coordinates]\nx = { initial = 0.3, velocity = 0.2 }\ny = { initial = 0.0, velocity = 1.0 }\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2) - tanh((x^2 + y^2)^60)\"\n",
    );
    for k in 1..=40 {
        let state = run.to(2.5 * f64::from(k));
        let (x, y, u, v) = (state[0], state[1], state[2], state[3]);
        let energy = 0.5 * (u * u + v * v) + (x * x + y * y).powi(60).tanh();
        near(&[energy, x * v - y * u], &[0.52, 0.3], 1e-12);
    }
}

#[test]
fn pulses_move_what_is_at_rest() {
    // ∫ cos²⁰⁰ over half a turn is π C(200, 100)/2²⁰⁰, ∫ e^(−(t/w)⁸⁰) is 2 w Γ(1 + 1/80)
    let half_turn =
        std::f64::consts::PI * (1..=100).map(|k| 1.0 - 0.5 / f64::from(k)).product::<f64>();
    for (force, times, gained) in [
        ("cos(t)^200", 100.0, 32.0 * half_turn - 0.5 * half_turn),
        ("exp(-((t - 50)/0.1)^80)", 100.0, 0.198_587_519_087_992_35),
        ("exp(-((t - 50)/0.1)^2)", 100.0, 0.1 * std::f64::consts::PI.sqrt()),
        (
            "1/(1 + ((t - 50)/0.1)^100)",
            100.0,
            0.2 / (std::f64::consts::PI / 100.0).sin() * (std::f64::consts::PI / 100.0),
        ),
    ] {
        for start in [(0.0, 0.0), (1.0, 1.0)] {
            for rows in [1, 3, 50] {
                let mut run = Run::new(&format!(
                    "title = \"Pulse\"\n[coordinates]\nx = {{ initial = {}, velocity = {} }}\n[lagrangian]\nL = \"1/2*x'^2 + x*{force}\"\n",
                    start.0, start.1
                ));
                for k in 1..=rows {
                    run.to(times * f64::from(k) / f64::from(rows));
                }
                near(&run.stepper.state().values[1..], &[start.1 + gained], 1e-12);
            }
        }
    }
}

#[test]
fn what_only_seems_to_be_divided_by_is_passed_at_once() {
    for (v, limit) in [("sin(x)/x", 200), ("(1 - cos(x))/x^2", 200), ("x^2/(x^2 + 1)", 100)] {
        let mut run = Run::new(&format!(
            "title = \"Removable\"\n[coordinates]\nx = {{ initial = -10.0, velocity = 2.0 }}\n[lagrangian]\nL = \"1/2*x'^2 - {v}\"\n"
        ));
        let energy = run.columns()[3];
        run.to(12.0);
        near(&run.columns()[3..4], &[energy], 1e-13);
        assert!(run.steps < limit, "{v}: {} steps", run.steps);
    }
}
