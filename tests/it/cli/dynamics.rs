//! `flow`, `lyapunov`, `orbit`, `spectrum` and `equilibria` as commands.

use super::{phaselab, with_file};

#[test]
fn the_tangent_map_is_an_object_with_named_fields() {
    let found = phaselab(&["flow", "damped-pendulum", "--until", "2", "--format", "json"]).json();
    assert_eq!(found["variables"], serde_json::json!(["theta", "p_theta"]));
    assert_eq!(found["t"], 2.0);
    assert_eq!(found["status"], "completed");
    assert_eq!(found["method"]["name"], "taylor");
    assert!(found["title"].is_string() && found["parameters"].is_object());
    let m = |i: usize, j: usize| found["matrix"][i][j].as_f64().unwrap();
    let determinant = m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0);
    assert!((determinant - found["determinant"].as_f64().unwrap()).abs() < 1e-14);
    assert!((determinant - found["determinant_expected"].as_f64().unwrap()).abs() < 1e-13);
    // friction is not canonical: for one degree of freedom the residual is |det − 1|
    let residual = found["symplectic_residual"].as_f64().unwrap();
    assert!((residual - (1.0 - determinant)).abs() < 1e-14);
    assert!(found["state"]["p_theta"].is_f64());
    let text = phaselab(&["flow", "pendulum", "--until", "1"]).success();
    assert!(text.contains("det M = 1, expected 1"), "{text}");
}

#[test]
fn exponents_come_with_a_verdict_and_as_many_as_asked() {
    let words = ["lyapunov", "henon-heiles", "--init", "x=0", "--init", "y=-0.18540508709080214"];
    let words = [&words[..], &["--init", "p_x=0.45975654576795759", "--init", "p_y=0"]].concat();
    let words = [&words[..], &["--until", "69", "--format", "json"]].concat();
    let found = phaselab(&words).json();
    assert_eq!(found["verdict"], "unstable");
    assert_eq!(found["exponents"].as_array().unwrap().len(), 4);
    assert!((found["exponents"][0].as_f64().unwrap() - 0.19195).abs() < 2e-4);
    assert!(found["pairing_residual"].as_f64().unwrap() < 1e-14);
    assert_eq!(found["trivial"], serde_json::json!(["flow", "energy"]));
    assert_eq!(found["curve"].as_array().unwrap().len(), 200);
    let one = phaselab(&[&words[..], &["--exponents", "1"]].concat()).json();
    assert_eq!(one["exponents"].as_array().unwrap().len(), 1);
    let none = phaselab(&["lyapunov", "pendulum", "--exponents", "0"]);
    assert_eq!(none.code, 2);
}

#[test]
fn an_orbit_and_its_family_are_written() {
    let words = ["orbit", "pendulum", "--init", "theta=0.3", "--format", "json"];
    let found = phaselab(&[&words[..], &["--along", "energy=-9:-6:2"]].concat()).json();
    assert!((found["period"].as_f64().unwrap() - 2.01740933501252).abs() < 1e-12);
    assert_eq!(found["multipliers"], serde_json::json!([[1.0, 0.0], [1.0, 0.0]]));
    assert_eq!((&found["stable"], &found["stability"]), (&true.into(), &"neutral".into()));
    assert_eq!(found["family"][0]["stability"], "neutral");
    let values: Vec<f64> =
        found["family"].as_array().unwrap().iter().map(|m| m["value"].as_f64().unwrap()).collect();
    assert_eq!(values, [-9.0, -6.0]);
    for wrong in ["energy", "energy=1:2", "energy=1:2:1", "energy=1:1:3", "gg=1:2:3"] {
        let done = phaselab(&["orbit", "pendulum", "--along", wrong]);
        assert_eq!(done.code, 2, "{wrong}: {}", done.stderr);
    }
    let done = phaselab(&["orbit", "damped-pendulum", "--energy", "1"]);
    assert_eq!(done.code, 2);
}

/// In the field of a magnetic monopole of strength g, with p_f = 2 g, the motion passes the pole θ = π: f' = g/(r² (1 − cos θ)) is
/// finite there. By p_f it has no derivative, as f jumps by π where p_f passes 2 g. That is no collision. So it is for a spherical
/// pendulum that swings through its lowest point, where f jumps by π with the sign of p_f.
#[test]
fn a_pole_of_the_coordinates_is_told_from_a_collision() {
    let monopole = "title = \"MICZ\"\n[coordinates]\nr = { initial = 1, momentum = 0.1 }\n\
                    th = { initial = 1.2, momentum = 0.3 }\nf = { initial = 0, momentum = 0.8 }\n[parameters]\ng = 0.4\n\
                    [hamiltonian]\nH = \"1/2*(p_r^2 + p_th^2/r^2 + (p_f-g*(1-cos(th)))^2/(r*sin(th))^2) + g^2/(2*r^2) - 1/r\"\n";
    let pendulum = "title = \"Spherical pendulum\"\n[coordinates]\nth = { initial = 1, velocity = 0 }\nf = { initial = 0, velocity = 0 }\n\
                    [lagrangian]\nL = \"1/2*(th'^2 + sin(th)^2*f'^2) + cos(th)\"\n";
    let falling = "title = \"Falling\"\n[coordinates]\nr = { initial = 1, momentum = 0 }\n\
                   [hamiltonian]\nH = \"1/2*p_r^2 - 1/r\"\n";
    let study = |file: &str, words: &[&str]| with_file(file, &[words, &["--until=3"]].concat());
    for words in [&["flow", "system.toml"][..], &["lyapunov", "system.toml", "--exponents=all"]] {
        for file in [monopole, pendulum] {
            assert_eq!(study(file, &["run", "system.toml"]).code, 0);
            let done = study(file, words);
            assert_eq!(done.code, 1, "{}", done.stdout);
            assert!(done.stderr.contains("a pole of the coordinates"), "{}", done.stderr);
            assert!(!done.stdout.contains("rounding may be"), "{}", done.stdout);
            assert!(!done.stdout.contains("regular from"), "{}", done.stdout);
        }
        let done = study(falling, words);
        assert!(done.stderr.contains("a collision or another"), "{}", done.stderr);
    }
}

/// The Lorenz system is written as forces beside H = 0, whose energy is constant and selects nothing. Its orbit AB is that of
/// D. Viswanath, Nonlinearity 16 (2003), 1035, table 1: T = 1.5586522107161747, z = 27 at x = −13.763610682134,
/// y = −19.578751942452; the multipliers' product is e^((−10 − 1 − 8/3) T).
#[test]
fn the_orbit_of_forces_beside_no_energy_is_found() {
    let lorenz = "title = \"Lorenz\"\n[variables]\nx = { initial = -13.76 }\ny = { initial = -19.58 }\n\
                  z = { initial = 27 }\n[poisson]\nH = \"0\"\nbrackets = []\n\
                  forces = { x = \"10*(y-x)\", y = \"x*(28-z)-y\", z = \"x*y-8/3*z\" }\n";
    let found =
        with_file(lorenz, &["orbit", "system.toml", "--period", "1.5586", "--format=json"]).json();
    let period = found["period"].as_f64().expect("a period");
    assert!((period - 1.558_652_210_716_174_7).abs() < 1e-10, "{period}");
    let energy = ["orbit", "system.toml", "--energy", "0"];
    with_file(lorenz, &energy).fails(2, &["everywhere the same"]);
}

/// An oscillator that is the same in all directions has ellipses only: its periodic orbits fill tori, and none has a stability
/// of its own. Beside it: orbit B of Hénon and Heiles, and one about which neighbours turn.
#[test]
fn an_orbit_on_a_torus_of_periodic_orbits_is_called_parabolic() {
    let isotropic = "title = 't'\n[coordinates]\nx = { initial = 1.0, velocity = 0.2 }\n\
                     y = { initial = 0.3, velocity = 0.8 }\n[lagrangian]\n\
                     L = \"1/2*(x'^2 + y'^2) - 1/2*(x^2 + y^2)\"\n";
    let orbit = |words: &[&str]| match words {
        ["system.toml", ..] => with_file(isotropic, &[&["orbit"], words].concat()),
        _ => phaselab(&[&["orbit"], words].concat()),
    };
    let table = [
        (&["system.toml"][..], "parabolic"),
        (
            &["henon-heiles", "--init=y=-0.18540508709080214", "--init=p_x=0.45975654576795759"],
            "unstable",
        ),
        (&["henon-heiles", "--init=y=0.3", "--init=p_x=0.4"], "stable"),
        (&["pendulum"], "neutral"),
    ];
    for (words, stability) in table {
        let found = orbit(&[words, &["--format=json"]].concat()).json();
        assert_eq!(found["stability"], stability, "{words:?}");
        // where all multipliers are 1 it is open
        let stable = (stability != "parabolic").then_some(stability != "unstable");
        assert_eq!(found["stable"].as_bool(), stable, "{words:?}");
        let text = orbit(words).success();
        let first = text.lines().next().unwrap();
        match stability {
            "neutral" => assert_eq!(first, "periodic orbit, one of a family in E"),
            "parabolic" => assert!(
                first.starts_with("parabolic periodic orbit: all multipliers are 1"),
                "{first}"
            ),
            _ => assert_eq!(first, format!("{stability} periodic orbit")),
        }
    }
}

/// ω = √(g/l) agm(1, cos ½θ₀) and its odd multiples; of a pendulum that turns over the mean rate 2π/T.
#[test]
fn a_spectrum_has_lines_that_are_named() {
    let words = ["spectrum", "pendulum", "--init", "theta=2", "--until", "60", "--format", "json"];
    let found = phaselab(&[&words[..], &["--lines", "4"]].concat()).json();
    let (mut a, mut b) = (1.0_f64, 1.0_f64.cos());
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    let exact = 9.81_f64.sqrt() * a;
    assert_eq!((&found["of"], &found["count"]), (&"theta".into(), &2048.into()));
    let lines = found["lines"].as_array().unwrap();
    assert_eq!(lines.len(), 4);
    for (line, times) in lines.iter().zip([1, 3, 5, 7]) {
        assert_eq!(line["combination"], serde_json::json!([times]));
        let off = line["frequency"].as_f64().unwrap() - f64::from(times) * exact;
        assert!(off.abs() < 1e-8, "{line} {off:e}");
    }
    assert!(found["mean_rate"]["rate"].as_f64().unwrap().abs() < 1e-6);
    // an expression; its mean is that of θ², and its lines are even multiples
    let square = phaselab(&[&words[..], &["--of", "theta^2"]].concat()).json();
    assert_eq!(square["of"], "theta^2");
    assert!(square["mean"].as_f64().unwrap() > 1.0 && square["mean_rate"].is_null());
    let off = square["lines"][0]["frequency"].as_f64().unwrap() - 2.0 * exact;
    assert!(off.abs() < 1e-8, "{off:e}");
    // a coordinate, a momentum and the energy by their names
    for (of, lines) in [("theta", 3), ("p_theta", 3), ("energy", 0)] {
        let words = ["spectrum", "pendulum", "--of", of, "--lines", "3", "--format", "json"];
        let found = phaselab(&words).json();
        assert_eq!(found["lines"].as_array().unwrap().len(), lines, "{of}");
    }
    let text = phaselab(&["spectrum", "pendulum"]).success();
    assert!(text.contains("ω₁") && text.contains("3ω₁") && text.contains("amplitude"), "{text}");
    // negatives
    assert_eq!(phaselab(&["spectrum", "pendulum", "--until", "-1"]).code, 2);
    assert_eq!(phaselab(&["spectrum", "pendulum", "--of", "nonsense"]).code, 2);
    let text = "title = \"t\"\n[coordinates]\nr = { initial = 1.0, momentum = 0.0 }\n\
                [hamiltonian]\nH = \"1/2*p_r^2 - 1/r\"\n";
    let ended = with_file(text, &["spectrum", "./system.toml", "--until", "3"]);
    assert_eq!((ended.code, ended.stdout.as_str()), (1, ""));
    // it falls into the centre at π/√8
    assert!(ended.stderr.contains("the motion ends before t = 1.11"), "{}", ended.stderr);
}

/// A galaxy's file says how long its motion is: ninety of its seconds are nothing.
#[test]
fn a_spectrum_ends_as_the_file_says_if_that_is_long() {
    let text = "title = \"t\"\n[coordinates]\nz = { initial = 3e18 }\n[lagrangian]\nL = \"1/2*z'^2 - 1/2*4e-30*z^2\"\n";
    for (run, until) in
        [("", 90.0), ("[run]\nuntil = 20.0\n", 90.0), ("[run]\nuntil = 1e18\n", 1e18)]
    {
        let words = ["spectrum", "./system.toml", "--format", "json"];
        let found = with_file(&format!("{text}{run}"), &words).json();
        assert_eq!(found["until"], until, "{found}");
        if until > 90.0 {
            let frequency = found["lines"][0]["frequency"].as_f64().unwrap();
            assert!((frequency / 2e-15 - 1.0).abs() < 1e-9, "{found}");
        }
    }
}

/// Of cos t + b cos 7t, at intervals of 1, the second line has its image at 7 − 2π.
#[test]
fn a_spectrum_of_few_values_names_the_images_it_leaves_out() {
    let text = "title = \"t\"\n[coordinates]\na = { initial = 1.0 }\nb = { initial = 0.3 }\n[lagrangian]\n\
                L = \"1/2*(a'^2 + b'^2) - 1/2*a^2 - 49/2*b^2\"\n";
    let words = ["spectrum", "./system.toml", "--of", "a+b", "--until", "400", "--count", "400"];
    let found = with_file(text, &[&words[..], &["--format", "json"]].concat()).json();
    let (lines, images) = (found["lines"].as_array().unwrap(), found["images"].as_array().unwrap());
    assert!(lines.len() == 1 && images.len() == 1, "{found}");
    assert!((lines[0]["frequency"].as_f64().unwrap() - 1.0).abs() < 1e-9);
    let image = 7.0 - std::f64::consts::TAU;
    assert!((images[0].as_f64().unwrap() - image).abs() < 1e-9);
    assert_eq!(found["resolved"], false);
    let shown = with_file(text, &words).success();
    assert!(shown.contains("values, whose image at ω = 0.7168"), "{shown}");
    let fast = with_file(
        text,
        &["spectrum", "./system.toml", "--of", "b", "--until", "400", "--count", "400"],
    );
    assert!(fast.stderr.contains("none of the lines found belongs to it"), "{}", fast.stderr);
}

#[test]
fn equilibria_are_listed_by_energy() {
    let found = phaselab(&["equilibria", "double-pendulum", "--format", "json"]).json();
    let all = found["equilibria"].as_array().unwrap();
    let kinds: Vec<&str> = all.iter().map(|one| one["kind"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["minimum", "saddle", "saddle", "maximum"]);
    assert_eq!(all[0]["frequencies"].as_array().unwrap().len(), 2);
    let near = phaselab(&["equilibria", "double-pendulum", "--around", "theta1=pi"]).success();
    assert!(near.starts_with("minimum, stable"), "{near}");
    let wrong = phaselab(&["equilibria", "double-pendulum", "--around", "theta1'=1"]);
    assert_eq!(wrong.code, 2);
}

/// The rod of a bob at rest below or above carries its weight: m g = 2 y λ.
#[test]
fn equilibria_under_constraints_have_their_multipliers() {
    let found = phaselab(&["equilibria", "pendulum-rod", "--format", "json"]).json();
    for (one, side) in found["equilibria"].as_array().unwrap().iter().zip([-1.0, 1.0]) {
        let multiplier = one["multipliers"]["lambda_rod"].as_f64().unwrap();
        assert!((multiplier - side * 4.905).abs() < 1e-13, "{one}");
        assert!(one["virtual_work"][1]["sum"].as_f64().unwrap().abs() < 1e-14, "{one}");
    }
    let text = phaselab(&["equilibria", "knife-edge"]).success();
    assert!(text.contains("δW/δy = 0\n"), "rounding is no force: {text}");
    let driven = phaselab(&["equilibria", "smooth-sphere"]);
    assert!(driven.stderr.contains("events act"), "{}", driven.stderr);
}

/// At a point of Lagrange the centrifugal force balances both bodies' pull; on a turning hoop, the weight.
#[test]
fn virtual_work_vanishes_term_by_term() {
    let words = ["equilibria", "restricted-three-body", "--set", "mu=0.01215", "--format", "json"];
    let found = phaselab(&words).json();
    let one = &found["equilibria"][0];
    let x = one["state"]["x"].as_f64().unwrap();
    let along = &one["virtual_work"][0];
    assert_eq!(along["coordinate"], "x");
    let values: Vec<f64> =
        along["terms"].as_array().unwrap().iter().map(|t| t["value"].as_f64().unwrap()).collect();
    let (a, b) = (x + 0.01215, x - 1.0 + 0.01215);
    let expected = [x, -(1.0 - 0.01215) * a / a.abs().powi(3), -0.01215 * b / b.abs().powi(3)];
    assert_eq!(values.len(), 3, "{along}");
    for (value, expected) in values.iter().zip(expected) {
        assert!((value - expected).abs() < 1e-12, "{along}");
    }
    assert!(along["sum"].as_f64().unwrap().abs() < 1e-13);
    assert!(one["virtual_work"][1]["terms"].as_array().unwrap().is_empty(), "nothing along y");
    // cos θ = g/(ω² a): the centrifugal force on the bead is m g tan θ
    let text = phaselab(&["equilibria", "bead-on-hoop"]).success();
    let line = text.lines().find(|line| line.contains("δW/δtheta")).unwrap();
    assert!(line.ends_with("= −9.023 + 9.023 = 0"), "{line}");
    // where the motion is not at rest there is nothing to balance: all other coordinates are listed
    let text = phaselab(&["equilibria", "spherical-pendulum"]).success();
    assert!(text.contains("φ′²") && !text.contains("δW/δphi"), "{text}");
}

#[test]
fn what_has_no_derivative_ends_with_a_sentence() {
    for command in ["flow", "lyapunov", "orbit", "equilibria"] {
        // under constraints some follow the displacements that these allow, others need independent coordinates
        let words = [command, "pendulum-rod", "--method", "rk4", "--step", "0.1"];
        if command != "equilibria" {
            let done = phaselab(&words);
            assert_eq!((done.code, done.stdout.as_str()), (1, ""), "{command}");
            assert!(done.stderr.contains("constraints"), "{command}: {}", done.stderr);
        }
        let done = phaselab(&[command, "pendulum", "--step", "0.1"]);
        assert_eq!(done.code, 2, "{command}");
        let done = phaselab(&[command, "no-such-thing"]);
        assert_eq!(done.code, 2, "{command}");
    }
    // a motion that ends early has its map so far, and the reason
    let text = "title = \"t\"\n[coordinates]\nr = { initial = 1.0, momentum = 0.0 }\n\
                [hamiltonian]\nH = \"1/2*p_r^2 - 1/r\"\n";
    let done = with_file(text, &["flow", "./system.toml", "--until", "3", "--format", "json"]);
    assert_eq!(done.code, 1);
    let found: serde_json::Value = serde_json::from_str(&done.stdout).unwrap();
    assert_eq!(found["status"], "faulted");
    assert!(found["t"].as_f64().unwrap() > 1.0 && found["message"].is_string());
}

#[test]
fn constrained_motions_have_tangent_maps_and_exponents() {
    let done = phaselab(&["flow", "neumann", "--until", "1", "--format", "json"]);
    let found: serde_json::Value = serde_json::from_str(&done.stdout).unwrap();
    assert_eq!((done.code, &found["dimension"]), (0, &4.into()));
    assert!((found["determinant"].as_f64().unwrap() - 1.0).abs() < 1e-12);
    assert!(found["symplectic_residual"].as_f64().unwrap() < 1e-13);
    // a blade is not holonomic: nothing is claimed of volumes
    let done = phaselab(&["flow", "knife-edge", "--until", "1"]);
    assert_eq!(done.code, 0);
    assert!(done.stdout.contains("M of the 5 of 6 displacements that the constraints allow"));
    assert!(!done.stdout.contains("det M"), "{}", done.stdout);
    let done = phaselab(&["lyapunov", "pendulum-rod", "--until", "20"]);
    assert!(done.code == 0 && done.stdout.starts_with("regular"), "{}", done.stdout);
}

#[test]
fn the_orbit_of_a_kicked_system_closes_over_its_kicks() {
    let words = ["orbit", "kicked-rotor", "--init", "theta=3", "--init", "p_theta=6.2"];
    let text = phaselab(&words).success();
    // K/4 with K = 0.971635406
    assert!(text.contains("residue     0.2429089"), "{text}");
    let json = phaselab(&[&words[..], &["--format", "json"]].concat()).json();
    assert_eq!((json["period"].as_f64(), json["stable"].as_bool()), (Some(1.0), Some(true)));
    // a ball that loses energy at each bounce has none
    let done = phaselab(&["orbit", "bouncing-ball"]);
    assert!(done.code == 1 && done.stderr.contains("no periodic orbit"), "{}", done.stderr);
    assert!(done.stdout.is_empty());
    // what rests closes after any time, and is no orbit
    let rest =
        ["orbit", "henon-heiles", "--init", "y=0.001", "--init", "p_x=0.001", "--period", "3"];
    let done = phaselab(&rest);
    let place = "ended at the equilibrium x = 0, y = 0, p_x = 0, p_y = 0;";
    assert!(done.code == 1 && done.stderr.contains(place), "{}", done.stderr);
    assert!(!done.stderr.contains("misses itself"), "{}", done.stderr);
    let done = phaselab(&["orbit", "pendulum", "--init", "theta=0"]);
    assert!(
        done.code == 1 && done.stderr.contains("the start is an equilibrium"),
        "{}",
        done.stderr
    );
    // one that loses none comes back after 2 √(2 h/g)
    let ball = ["orbit", "bouncing-ball", "--set", "eps=1", "--set", "vx=0", "--format", "json"];
    let period = phaselab(&ball).json()["period"].as_f64().unwrap();
    assert!((period - 2.0 * (2.0 / 9.81_f64).sqrt()).abs() < 1e-9, "{period}");
}

/// Units of mass, length and time: those of the equations, SI for an atom, SI for a galaxy, and small ones of the laboratory.
const UNITS: [[f64; 3]; 4] =
    [[1.0, 1.0, 1.0], [9.1e-31, 5.3e-11, 2.4e-17], [2e30, 3e19, 3e15], [1e-3, 1e-2, 1.0]];

fn kepler([mass, length, time]: [f64; 3]) -> String {
    let (speed, k) = (0.9 * length / time, mass * length.powi(3) / (time * time));
    format!(
        "title = \"Kepler\"\n[coordinates]\nx = {{ initial = {length:?} }}\ny = {{ initial = 0, velocity = {speed:?} }}\n\
         [parameters]\nm = {mass:?}\nk = {k:?}\n[lagrangian]\nL = \"1/2*m*(x'^2 + y'^2) + k/sqrt(x^2 + y^2)\"\n"
    )
}

/// A force that falls with the distance vanishes nowhere.
#[test]
fn far_from_the_sun_nothing_rests_in_any_units() {
    for units in UNITS {
        let said = with_file(&kepler(units), &["equilibria", "system.toml"]).success();
        assert_eq!(said, "no equilibrium was found near the start\n", "{units:?}");
    }
}

/// A vector from p to q grows by the ratio of their units, which is no growth of the motion's.
#[test]
fn an_ellipse_is_regular_in_any_units() {
    for units in UNITS {
        let until = (500.0 * units[2]).to_string();
        let words = ["lyapunov", "system.toml", "--until", &until, "--format", "json"];
        let found = with_file(&kepler(units), &words).json();
        assert_eq!(found["verdict"], "regular", "{units:?}: {}", found["reason"]);
        let pairs = found["pairing_residual"].as_f64().unwrap() * units[2];
        assert!(pairs < 1e-13, "{units:?}: {pairs:e}");
    }
}

/// The frequency of a torus stays, that of a chaotic motion drifts (Hénon and Heiles' system, whose exponents say the same).
#[test]
fn the_frequency_of_chaos_drifts() {
    let drift = |given: &[&str]| {
        let all = [
            &[
                "spectrum",
                "henon-heiles",
                "--until=1200",
                "--count=2048",
                "--lines=4",
                "--format=json",
            ],
            given,
        ]
        .concat();
        phaselab(&all).json()["frequency_drift"]["relative"].as_f64().unwrap()
    };
    let torus = drift(&["--init=x=0", "--init=y=0.1", "--init=p_x=0.3", "--init=p_y=0.1"]);
    let chaos = drift(&[]);
    assert!(torus < 1e-6, "{torus}");
    assert!(chaos > 1e-4, "{chaos}");
}

/// An error that is exactly nothing is written 0.
#[test]
fn a_residual_of_nothing_is_zero() {
    let step = ["--method=symplectic-euler", "--step=0.1", "--until=0.1"];
    let run = phaselab(&[&["flow", "symplectic-euler"][..], &step[..]].concat());
    let text = run.text();
    assert!(text.contains("J|: 0, of which"), "{text}");
}

#[test]
fn what_cannot_move_has_neither_equilibria_nor_exponents() {
    let file = "title = \"held\"\n[coordinates]\nx = { initial = 1.0 }\n\
                [lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n\
                [[constraints]]\nname = \"c\"\nexpression = \"x - 1\"\n";
    for words in [&["equilibria", "system.toml"][..], &["lyapunov", "system.toml", "--until", "3"]]
    {
        with_file(file, words).fails(1, &["the constraints leave nothing that could move"]);
    }
}

/// A bead on a curve with a parameter, which the constraints alone move: its motion is known, and what works with momenta says
/// what it lacks.
#[test]
fn a_coordinate_without_mass_is_named_as_that() {
    let cycloid = "[coordinates]\nx = { initial = \"s0 - sin(s0)\" }\ny = { initial = \"1 - cos(s0)\" }\n\
        s = { initial = \"s0\", velocity = 0 }\n[parameters]\ns0 = 2.0\n[lagrangian]\n\
        L = \"1/2*(x'^2 + y'^2) + y\"\n[[constraints]]\nname = \"a\"\nexpression = \"x - s + sin(s)\"\n\
        [[constraints]]\nname = \"b\"\nexpression = \"y - 1 + cos(s)\"\n";
    for command in ["equilibria", "orbit", "flow", "lyapunov"] {
        with_file(cycloid, &[command, "system.toml"]).fails(1, &["has no mass of its own"]);
    }
    // the tautochrone: at the bottom, s = π, after π √(1/g) from wherever it starts
    let words = ["run", "system.toml", "--at", "3.141592653589793"];
    let rows = with_file(cycloid, &words).success();
    let last = rows.lines().last().unwrap();
    let s: f64 = last.split(',').nth(3).unwrap().parse().unwrap();
    assert!((s - std::f64::consts::PI).abs() < 1e-12, "{rows}");
}

/// ẍ = 2x³ has the solution x = 1/(1 − t). That it reaches infinity is said whatever the method and whatever follows the motion.
#[test]
fn a_motion_to_infinity_is_called_so_by_every_command() {
    let text = "title = 'it'\n[coordinates]\nx = { initial = 1, velocity = 1 }\n\
                [lagrangian]\nL = \"1/2*x'^2 + 1/2*x^4\"\n";
    for (method, step) in [("rk4", "0.01"), ("gauss4", "0.01"), ("leapfrog", "0.01")] {
        for command in ["flow", "lyapunov"] {
            let words =
                [command, "./system.toml", "--until", "5", "--method", method, "--step", step];
            let done = with_file(text, &words);
            assert_eq!(done.code, 1);
            let said = "the motion grows without bound: x reaches infinity at t = 1\n";
            assert!(done.stderr.ends_with(said), "{command} {method}: {}", done.stderr);
        }
    }
}
