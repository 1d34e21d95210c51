//! Closed forms and published numbers, to the last digits.

use super::{Run, near};

const KEPLER: &str = r#"
title = "Kepler's ellipse, e = 0.9"
[coordinates]
x = { initial = 0.1, velocity = 0.0 }
y = { initial = 0.0, velocity = "sqrt(19)" }
[lagrangian]
L = "1/2*(x'^2 + y'^2) + 1/sqrt(x^2 + y^2)"
"#;

const THREE_BODIES: &str = r#"
title = "Figure eight"
[coordinates]
x1 = { initial = -1.0, velocity = "vx" }
y1 = { initial = 0.0, velocity = "vy" }
x2 = { initial = 1.0, velocity = "vx" }
y2 = { initial = 0.0, velocity = "vy" }
x3 = { initial = 0.0, velocity = "-2*vx" }
y3 = { initial = 0.0, velocity = "-2*vy" }
[parameters]
vx = 0.34711688811892694
vy = 0.53272494538803023
[definitions]
V = "-1/sqrt((x1 - x2)^2 + (y1 - y2)^2) - 1/sqrt((x1 - x3)^2 + (y1 - y3)^2) - 1/sqrt((x2 - x3)^2 + (y2 - y3)^2)"
[lagrangian]
L = "1/2*(x1'^2 + y1'^2 + x2'^2 + y2'^2 + x3'^2 + y3'^2) - V"
"#;

#[test]
fn periods_of_the_pendulum() {
    // θ₀ = 2 rad, g/l = 1: T = 4 K(sin² 1) = 8.34975292691849473…
    let mut run = Run::new(
        "title = \"Pendulum\"\n[coordinates]\nx = { initial = 2.0, velocity = 0.0 }\n[lagrangian]\nL = \"1/2*x'^2 + cos(x)\"\n",
    );
    // the nearest f64 is up to 9e-16 away, the force there is 0.91
    near(&run.to(8.349_752_926_918_495), &[2.0, 0.0], 8.2e-16);
    // 83.4975292691849473… is not an f64 either: half a last place of it is 7e-15
    near(&run.to(83.497_529_269_184_95), &[2.0, 0.0], 7e-15);
}

#[test]
fn the_oscillator_for_a_thousand_periods() {
    let mut run = Run::new(
        "title = \"Oscillator\"\n[coordinates]\nx = { initial = 1.0, velocity = 0.0 }\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n",
    );
    near(&run.to(6283.0), &[6283.0_f64.cos(), -6283.0_f64.sin()], 1.2e-16);
}

/// To t = 20 a disturbance grows by many powers of ten. The reference is a series in 113 bits (heyoka, `real128`, tolerance 1e-31).
#[test]
fn a_chaotic_double_pendulum_beside_a_reference_in_113_bits() {
    let mut run = Run::new(
        "title = \"Double pendulum\"\n[coordinates]\na = { initial = 1.5 }\nb = { initial = 2.0 }\n[parameters]\ng = 9.81\n[lagrangian]\nL = \"a'^2 + 1/2*b'^2 + a'*b'*cos(a - b) + 2*g*cos(a) + g*cos(b)\"\n",
    );
    let reference = [
        2.007_929_433_812_212,
        0.290_543_939_961_414_9,
        -1.431_714_225_349_443,
        -2.084_988_182_921_548,
    ];
    near(&run.to(20.0), &reference, 2e-13);
}

#[test]
fn keplers_ellipse_over_ten_periods() {
    // after whole and half periods it is at its initial position, 0.1 and 1.9 from the centre; in between
    // E − e sin E = t
    let mut run = Run::new(KEPLER);
    let pi = std::f64::consts::PI;
    // the time given for ten periods is wrong by up to 7e-15, the acceleration there is 100
    near(&run.to(20.0 * pi), &[0.1, 0.0, 0.0, 19.0_f64.sqrt()], 7e-13);
    let mut anomaly = 2.0_f64;
    for _ in 0..60 {
        anomaly -= (anomaly - 0.9 * anomaly.sin() - 2.0) / (1.0 - 0.9 * anomaly.cos());
    }
    let mut run = Run::new(KEPLER);
    let root = 0.19_f64.sqrt();
    near(&run.to(2.0), &[anomaly.cos() - 0.9, root * anomaly.sin()], 4e-16);
    // the error of the given period does not affect energy and angular momentum
    let energy = run.columns()[6];
    for _ in 0..10 {
        run.to(run.stepper.time() + 6.0);
    }
    assert_eq!(run.columns()[6], energy);
    assert!((energy + 0.5).abs() < 1.2e-16);
}

#[test]
fn the_figure_eight_closes() {
    let mut run = Run::new(THREE_BODIES);
    let start = run.stepper.state().values.clone();
    let energy = run.columns()[18];
    // digits and residual: NUMBERS of Simó and of Šuvakov & Dmitrašinović, recomputed to 1e-29
    near(&run.to(6.325_913_982_926_211_7), &start, 4e-15);
    assert!((energy + 1.287_141_995_631_857_7).abs() < 3e-16);
}

#[test]
fn arenstorfs_orbit_returns() {
    // Hairer, Nørsett & Wanner I, II.0; small changes grow some 10⁴-fold in one period
    let mut run = Run::new(
        r#"
title = "Arenstorf"
[coordinates]
x = { initial = 0.994, velocity = 0.0 }
y = { initial = 0.0, velocity = -2.00158510637908252240537862224 }
[parameters]
mu = 0.012277471
[lagrangian]
L = "1/2*((x' - y)^2 + (y' + x)^2) + (1 - mu)/sqrt((x + mu)^2 + y^2) + mu/sqrt((x - 1 + mu)^2 + y^2)"
"#,
    );
    let state = run.to(17.065_216_560_157_963);
    near(&state, &[0.994, 0.0, 0.0, -2.001_585_106_379_082_5], 2e-10);
}

#[test]
fn the_pleiades_at_three() {
    // test set for IVP solvers (Bari), problem `plei`; reference recomputed to 24 digits
    let x = [3.0, 3.0, -1.0, -3.0, 2.0, -2.0, 2.0];
    let y = [3.0, -3.0, 2.0, 0.0, 0.0, -4.0, 4.0];
    let vx = [0.0, 0.0, 0.0, 0.0, 0.0, 1.75, -1.5];
    let vy = [0.0, 0.0, 0.0, -1.25, 1.0, 0.0, 0.0];
    let mut text = "title = \"Pleiades\"\n[coordinates]\n".to_owned();
    for i in 0..7 {
        text += &format!("x{i} = {{ initial = {:?}, velocity = {:?} }}\n", x[i], vx[i]);
        text += &format!("y{i} = {{ initial = {:?}, velocity = {:?} }}\n", y[i], vy[i]);
    }
    let kinetic: Vec<String> = (0..7).map(|i| format!("{}/2*(x{i}'^2 + y{i}'^2)", i + 1)).collect();
    let pairs = (0..7).flat_map(|i| (0..i).map(move |j| (i, j)));
    let potential: Vec<String> = pairs
        .map(|(i, j)| format!("{}/sqrt((x{i} - x{j})^2 + (y{i} - y{j})^2)", (i + 1) * (j + 1)))
        .collect();
    text += &format!("[lagrangian]\nL = \"{} + {}\"\n", kinetic.join(" + "), potential.join(" + "));
    let state = Run::new(&text).to(3.0);
    let expected_x = [
        0.370613914397051,
        3.23728409205723,
        -3.22255903241832,
        0.659709145577531,
        0.342558170715658,
        1.56217210140063,
        -0.700309292221250,
    ];
    let expected_y = [
        -3.94343758551739,
        -3.27138097397255,
        5.22508184345654,
        -2.59061243497747,
        1.19821369339227,
        -0.242968234493582,
        1.09144924042898,
    ];
    for i in 0..7 {
        near(&state[2 * i..], &[expected_x[i], expected_y[i]], 6e-15);
    }
}

#[test]
fn henon_and_heiles() {
    // chaotic start of ChaosTools' tests; values by Taylor series of order 40 in 45 digits
    let text = "title = \"HH\"\n[coordinates]\nx = { initial = 0.0, momentum = 0.42081 }\ny = { initial = -0.25, momentum = 0.0 }\n[hamiltonian]\nH = \"1/2*(p_x^2 + p_y^2 + x^2 + y^2) + x^2*y - 1/3*y^3\"\n";
    let mut run = Run::new(text);
    for (t, expected) in [
        (
            10.0,
            [0.014060888838030187, 0.20875242557896421, -0.43470066274587278, -0.15244620311643078],
        ),
        (
            50.0,
            [
                -0.19620416025713324,
                -0.10274817446381300,
                -0.45552058538437485,
                -0.025161618819876597,
            ],
        ),
        (
            100.0,
            [0.090750966286360898, -0.13487305767091454, 0.37248314296726268, 0.29225585093114511],
        ),
    ] {
        near(&run.to(t), &expected, 1.2e-16);
    }
}

#[test]
fn energy_stays_at_the_last_digit_for_ten_thousand_periods() {
    let text = include_str!("../../../presets/pendulums/pendulum.toml");
    let mut run = Run::new(text);
    let energy = run.columns()[3];
    let mut worst = 0.0_f64;
    for i in 1..=100 {
        run.to(266.587_094_283_492_6 * f64::from(i));
        worst = worst.max((run.columns()[3] - energy).abs());
    }
    assert!(worst <= 2.0 * f64::EPSILON * energy.abs(), "{worst:e} of {energy}");
}

#[test]
fn in_plain_doubles_energy_walks_at_random() {
    // without double-double arithmetic each step has an error of about 1e-16 of the energy, with either sign
    let text = include_str!("../../../presets/pendulums/pendulum.toml");
    let mut run = Run::with(text, Some(1e-15));
    let energy = run.columns()[3];
    run.to(2665.87);
    let drift = (run.columns()[3] - energy).abs() / energy.abs();
    let walk = 1e-15 * f64::from(run.steps).sqrt();
    assert!(drift > 0.0 && drift < walk, "{drift:e} after {} steps", run.steps);
}

#[test]
fn the_action_is_integrated_with_the_motion() {
    // L = ½(x'² − x²) along cos t: −½ ∫ cos 2t
    let text = "title = \"Oscillator\"\n[coordinates]\nx = { initial = 1.0, velocity = 0.0 }\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n[[observables]]\nname = \"S\"\nexpression = \"action\"\n";
    let mut run = Run::new(text);
    run.to(7.0);
    near(&run.columns()[4..], &[-0.25 * 14.0_f64.sin()], 1e-16);
}

#[test]
fn the_ledger_balances() {
    let mut run = Run::new(include_str!("../../../presets/pendulums/damped-pendulum.toml"));
    let system = run.system.clone();
    let balance = system.channels().iter().position(|c| c.name == "energy balance");
    let balance = balance.expect("friction does work");
    let mut observer = system.observer(&run.parameters);
    let mut out = vec![0.0; system.channels().len()];
    observer.observe(run.stepper.state(), &mut out).expect("regular");
    let before = out[balance];
    for t in [1.0, 5.0, 20.0, 200.0] {
        run.to(t);
        observer.observe(run.stepper.state(), &mut out).expect("regular");
        assert!((out[balance] - before).abs() < 1.5e-14, "{t}: {:e}", out[balance] - before);
    }
}

/// Near a pole that is not at the origin, and of bodies far from it, what is squared is a small difference of large numbers.
#[test]
fn differences_that_are_squared_keep_their_digits() {
    let one = |initial: &str, potential: &str, to: f64| {
        Run::new(&format!(
            "title = \"One\"\n[coordinates]\nx = {{ {initial} }}\n[lagrangian]\nL = \"1/2*x'^2 - ({potential})\"\n"
        ))
        .to(to)
    };
    let back = one("initial = 2, velocity = -1", "1e-25/(x - 1)^2", 5.0);
    near(&back, &[5.0, 1.0], 1e-11);
    // away from a zero of the divisor that is none of the quotient
    let start = "initial = 1e-3, velocity = 1";
    let plain = one(start, "1/(4*cos(x/2)^4)", 0.5);
    near(&one(start, "(1 - cos(x))^2/sin(x)^4", 0.5), &plain, 1e-13);
    let two = |from: f64, (place, velocity): (&str, &str), law: &str, to: f64| {
        let mut run = Run::new(&format!(
            "title = \"Two\"\n[coordinates]\nx1 = {{ initial = {from}, velocity = {velocity} }}\ny1 = {{ initial = 0, velocity = 1e-4 }}\nx2 = {{ initial = {place} }}\ny2 = 0\n[lagrangian]\nL = \"1/2*(x1'^2 + y1'^2 + x2'^2 + y2'^2) + {law}\"\n"
        ));
        run.to(to)
    };
    let law = "1/sqrt((x1 - x2)^2 + (y1 - y2)^2)";
    let (far, near_by) = (two(1000.0, ("1001", "0"), law, 3.0), two(0.0, ("1", "0"), law, 3.0));
    near(&[far[0] - 1000.0, far[1]], &near_by[..2], 1e-9);
}
