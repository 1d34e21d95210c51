//! `path`: stationary paths and their action, by closed forms and published numbers.

use std::f64::consts::PI;

use serde_json::Value;

use super::with_file;

const PENDULUM: &str = "title = \"Pendulum\"\n[coordinates]\ntheta = { initial = 0.0, velocity = 1.0 }\n\
                        [lagrangian]\nL = \"1/2*theta'^2 + cos(theta)\"\n";

const OSCILLATOR: &str = "title = \"Oscillator\"\n[coordinates]\nx = { initial = 0.5, momentum = 0 }\n\
                          [parameters]\nw = 1.0\n[hamiltonian]\nH = \"p_x^2/2 + w^2*x^2/2\"\n";

const PLANE: &str = "title = \"Plane\"\n[coordinates]\nx = { initial = 0.5 }\ny = { initial = 0.2 }\n\
                     [lagrangian]\nL = \"1/2*(x'^2 + y'^2) - 1/2*(x^2 + y^2)\"\n";

fn path(file: &str, words: &[&str]) -> Value {
    let words = [&["path", "system.toml", "--format", "json"], words].concat();
    with_file(file, &words).json()
}

fn action(found: &Value) -> f64 {
    found["action"].as_f64().unwrap()
}

fn close(a: f64, b: f64, within: f64) {
    assert!((a - b).abs() <= within, "{a} is not {b}");
}

#[test]
fn several_true_paths_between_the_same_ends() {
    // numbers of an independent computation with 30 digits: rest, and the swing
    let ends = ["--in", "4", "--from", "theta=0", "--to", "theta=0"];
    let rest = path(PENDULUM, &ends);
    close(action(&rest), 4.0, 1e-14);
    assert_eq!((&rest["kind"], &rest["index"]), (&"saddle".into(), &1.into()));
    close(rest["conjugate"][0].as_f64().unwrap(), std::f64::consts::PI, 1e-13);
    assert_eq!(rest["conjugate"].as_array().unwrap().len(), 1);
    let swing = path(PENDULUM, &[&ends[..], &["--near", "theta=2*sin(pi*t/4)"]].concat());
    close(action(&swing), 3.344_291_248_362_989_3, 1e-14);
    assert_eq!((&swing["kind"], &swing["index"]), (&"minimum".into(), &0.into()));
    assert_eq!(swing["stationary"], true);
    // the swing turns at 1.8: what is nearer to it than to rest leads there, and what is nearer to rest to rest
    for (guess, nearest) in [("1.0*sin(pi*t/4)", 3.344_291_248_362_989_3), ("0.8*sin(pi*t/4)", 4.0)]
    {
        let guess = format!("theta={guess}");
        let found = path(PENDULUM, &[&ends[..], &["--near", &guess]].concat());
        close(action(&found), nearest, 1e-14);
    }
    assert_eq!(swing["conjugate"], serde_json::json!([]));
    // before the conjugate point rest is least
    let short = path(PENDULUM, &["--in", "3", "--from", "theta=0", "--to", "theta=0"]);
    assert_eq!((&short["kind"], &short["index"]), (&"minimum".into(), &0.into()));
    // at it the second variation vanishes in one direction
    let pi = std::f64::consts::PI.to_string();
    let at = path(PENDULUM, &["--in", &pi, "--along", "theta=0"]);
    assert_eq!(at["kind"], "degenerate");
}

#[test]
fn the_principal_function_of_the_oscillator() {
    // S = w ((a² + b²) cos wT − 2ab)/(2 sin wT)
    let found = path(OSCILLATOR, &["--in", "1", "--to", "x=1.2"]);
    close(action(&found), -0.170_468_803_002_363, 2e-15);
    let exact =
        |a: f64, b: f64, t: f64| ((a * a + b * b) * t.cos() - 2.0 * a * b) / (2.0 * t.sin());
    for (a, b, t) in [(0.5, 1.2, 0.3), (-1.0, 0.7, 2.9), (0.4, 0.4, 4.5), (0.1, -2.0, 8.0)] {
        let words =
            ["--in", &t.to_string(), "--from", &format!("x={a}"), "--to", &format!("x={b}")];
        let found = path(OSCILLATOR, &words);
        close(action(&found), exact(a, b, t), 1e-12);
        // the index is the number of half periods
        let halves = (t / std::f64::consts::PI).floor() as usize;
        assert_eq!(found["index"], halves);
        let conjugate = found["conjugate"].as_array().unwrap();
        assert_eq!(conjugate.len(), halves);
        for (k, time) in conjugate.iter().enumerate() {
            close(time.as_f64().unwrap(), std::f64::consts::PI * (k + 1) as f64, 1e-11);
        }
    }
    // in a plane each of them is double
    let found = path(PLANE, &["--in", "7", "--to", "x=0.3", "--to", "y=1"]);
    assert_eq!((&found["index"], found["conjugate"].as_array().unwrap().len()), (&4.into(), 4));
    close(action(&found), exact(0.5, 0.3, 7.0) + exact(0.2, 1.0, 7.0), 1e-12);
}

#[test]
fn slopes_of_the_action_are_momenta_and_energy_at_both_ends() {
    let s = |a: f64, b: f64, t: f64| {
        let words = ["--in", &t.to_string(), "--from", &format!("theta={a}")];
        path(PENDULUM, &[&words[..], &["--to", &format!("theta={b}")]].concat())
    };
    let (a, b, t, h) = (0.2, 1.1, 1.7, 1e-3);
    let middle = s(a, b, t);
    let rows = middle["rows"].as_array().unwrap();
    let cell = |row: &Value, k: usize| row[k].as_f64().unwrap();
    let (first, last) = (&rows[0], &rows[rows.len() - 1]);
    assert_eq!(middle["columns"], serde_json::json!(["t", "theta", "theta'", "p_theta", "energy"]));
    close(cell(first, 1), a, 1e-14);
    close(cell(last, 1), b, 1e-14);
    // five-point differences of the action, whose error is h⁴
    let slope = |of: &dyn Fn(f64) -> f64| {
        (8.0 * (of(h) - of(-h)) - (of(2.0 * h) - of(-2.0 * h))) / (12.0 * h)
    };
    close(slope(&|d| action(&s(a, b + d, t))), cell(last, 3), 1e-10);
    close(slope(&|d| action(&s(a + d, b, t))), -cell(first, 3), 1e-10);
    close(slope(&|d| action(&s(a, b, t + d))), -cell(last, 4), 1e-10);
    close(cell(first, 4), cell(last, 4), 1e-12);
}

#[test]
fn written_paths_and_their_variations() {
    // G. J. Sussman and J. Wisdom, SICM, § 1.4: 435, and 436.29121428571443 varied
    let file = "title = \"Free\"\n[coordinates]\nx = { initial = 0 }\ny = { initial = 0 }\nz = { initial = 0 }\n\
                [parameters]\nm = 3\n[lagrangian]\nL = \"m/2*(x'^2 + y'^2 + z'^2)\"\n";
    let straight = ["--in", "10", "--along", "x=4*t+7", "--along", "y=3*t+5", "--along", "z=2*t+1"];
    let variation = ["--vary", "x=t*(t-10)*sin(t)", "--vary", "y=t*(t-10)*cos(t)"];
    let rest = ["--vary", "z=t*(t-10)*t^2", "--epsilons", "0:0.001:2"];
    let found = path(file, &[&straight[..], &variation, &rest].concat());
    close(action(&found), 435.0, 1e-12);
    assert_eq!((&found["stationary"], &found["kind"]), (&true.into(), &"minimum".into()));
    let varied = &found["varied"];
    close(varied[0]["action"].as_f64().unwrap(), 435.0, 1e-12);
    assert_eq!(varied[1]["epsilon"], 0.001);
    close(varied[1]["action"].as_f64().unwrap(), 436.291_214_285_714_3, 1e-12);
    // a path that is none of the motion
    let found = path(PENDULUM, &["--in", "1", "--along", "theta=1"]);
    close(action(&found), 1.0_f64.cos(), 1e-14);
    assert_eq!(found["stationary"], false);
    assert!(found["kind"].is_null() && found["index"].is_null());
    // the action of a true path varied with fixed ends is least at ε = 0, to second order
    let words = ["--in", "1", "--to", "x=1.2", "--vary", "x=sin(pi*t)", "--epsilons", "-0.1:0.1:3"];
    let found = path(OSCILLATOR, &words);
    let varied: Vec<f64> = (0..3).map(|k| found["varied"][k]["action"].as_f64().unwrap()).collect();
    let second = 0.01 * (std::f64::consts::PI.powi(2) - 1.0) / 4.0;
    close(varied[0] - action(&found), second, 1e-13);
    close(varied[2] - action(&found), second, 1e-13);
    close(varied[1], action(&found), 1e-13);
    // the time of a path begins at 0, and L knows its own
    let driven = "title = \"Driven\"\n[coordinates]\nx = { initial = 0 }\n[run]\nstart = 2.0\n\
                  [lagrangian]\nL = \"1/2*x'^2 + t*x\"\n";
    let found = path(driven, &["--in", "1", "--along", "x=t^3/6+t^2"]);
    assert_eq!(found["stationary"], true);
    let found = path(driven, &["--in", "1", "--along", "x=t^3/6"]);
    assert_eq!(found["stationary"], false);
}

#[test]
fn what_cannot_be_asked_of_a_path() {
    let refused = |words: &[&str], said: &str| {
        with_file(PLANE, &[&["path", "system.toml"], words].concat()).fails(2, &[said]);
    };
    refused(&["--in", "1", "--to", "x=1"], "say where `y` ends, too");
    refused(&["--in", "1"], "--along");
    refused(&["--in", "-1", "--to", "x=1", "--to", "y=1"], "above zero");
    refused(&["--in", "1", "--to", "x'=1", "--to", "y=1"], "are coordinates");
    refused(&["--in", "1", "--along", "x=t"], "`y` is missing");
    refused(&["--in", "1", "--along", "x=y", "--along", "y=t"], "function of t");
    refused(&["--in", "1", "--along", "z=t"], "unknown coordinate `z`");
    let along = ["--in", "1", "--along", "x=t", "--along", "y=t"];
    refused(&[&along[..], &["--vary", "p_z=t"]].concat(), "unknown coordinate `p_z`");
    refused(&["--in", "1", "--to", "x=1", "--to", "y=1", "--epsilons", "1:2"], "from:to:count");
    let text =
        with_file(PENDULUM, &["path", "system.toml", "--in", "1", "--to", "theta=1"]).success();
    let lead = "action 1.331\nabbreviated action ∫ p dq 1.023\nstationary: minimum, index 0\n";
    assert!(text.starts_with(lead), "{text}");
}

/// Friction and forces are no part of ∫ L dt: a path that makes it stationary is no motion of such a file.
#[test]
fn a_path_says_that_friction_is_left_out() {
    let words = ["path", "system.toml", "--in", "1", "--to", "theta=1"];
    for more in ["dissipation = \"0.1*theta'^2\"\n", "forces = { theta = \"-theta'\" }\n"] {
        let left_out = with_file(&format!("{PENDULUM}{more}"), &words);
        left_out.says("is a motion of L alone, not of this file");
    }
    assert!(!with_file(PENDULUM, &words).success().contains("not of this file"));
}

/// Among the ways from one place to another a motion of an energy makes ∫ p dq stationary (Maupertuis); a free particle's
/// is v times the length.
#[test]
fn the_abbreviated_action_of_a_free_particle_is_the_length_of_its_way() {
    let free = PLANE.replace(" - 1/2*(x^2 + y^2)", "");
    let words = ["--in", "2", "--along", "x=t", "--along", "y=0", "--vary", "y=sin(pi*t/2)"];
    let found = path(&free, &[&words[..], &["--epsilons", "-0.5:0.5:3"]].concat());
    close(found["abbreviated"].as_f64().unwrap(), 2.0, 1e-14);
    // ∫ √(1 + ε² (π/2)² cos²(πt/2)) dt by the trapezoidal rule, which is exact for periodic functions
    let slope = |t: f64| 0.25 * PI * (0.5 * PI * t).cos();
    let nodes = (0..4000).map(|i| 2.0 * f64::from(i) / 4000.0);
    let length: f64 = nodes.map(|t| (1.0 + slope(t) * slope(t)).sqrt()).sum::<f64>() / 2000.0;
    let varied = |i: usize, key: &str| found["varied"][i][key].as_f64().unwrap();
    close(varied(0, "abbreviated"), length, 1e-9);
    close(varied(1, "abbreviated"), 2.0, 1e-12);
    close(varied(2, "abbreviated"), length, 1e-9);
    // Hamilton's action is that of the same time instead: ½ ∫ (1 + y′²) dt
    close(varied(0, "action"), 1.0 + 0.25 * 0.25 * PI * PI * 0.5, 1e-12);
}

/// A way that turns back has a corner there in √((E − V) T): it counts there and back.
#[test]
fn the_abbreviated_action_of_a_way_that_turns_back_is_its_length() {
    let free = PLANE.replace(" - 1/2*(x^2 + y^2)", "");
    let words = ["--in", "2", "--along", "x=t", "--along", "y=0", "--vary", "x=sin(pi*t)"];
    let found = path(&free, &[&words[..], &["--epsilons", "-1:1:3"]].concat());
    // x = t + sin(πt) turns where cos(πt) = −1/π
    let turn = (-1.0 / PI).acos() / PI;
    let at = |t: f64| t + (PI * t).sin();
    let length = 2.0 * at(turn) - 2.0 * at(2.0 - turn) + 2.0;
    close(found["varied"][2]["abbreviated"].as_f64().unwrap(), length, 1e-9);
}

/// The same of a motion under forces: it is stationary, at its own energy, and at no other path.
#[test]
fn a_motion_makes_the_abbreviated_action_stationary() {
    let slope = |x: &str, y: &str| {
        let (x, y) = (format!("x={x}"), format!("y={y}"));
        let words = ["--in", "1.2", "--along", &x, "--along", &y, "--vary", "y=sin(pi*t/1.2)"];
        let found = path(PLANE, &[&words[..], &["--epsilons", "-1e-3:1e-3:3"]].concat());
        let varied = |i: usize| found["varied"][i]["abbreviated"].as_f64().unwrap();
        (varied(2) - varied(0)) / 2e-3
    };
    // an ellipse of the oscillator in the plane, and one that is gone too fast in one direction
    assert!(slope("cos(t)", "0.5*sin(t)").abs() < 1e-6);
    assert!(slope("cos(t)", "0.5*sin(2*t)").abs() > 1e-2);
    // a way through where the energy does not reach has none
    let far = ["--in", "1.2", "--along", "x=cos(t)", "--along", "y=0.5*sin(t)"];
    let vary = ["--vary", "y=sin(pi*t/1.2)", "--epsilons", "3:4:2"];
    let found = path(PLANE, &[&far[..], &vary[..]].concat());
    assert!(found["varied"][0]["abbreviated"].is_null() && found["varied"][0]["action"].is_f64());
    let text = with_file(PLANE, &[&["path", "system.toml"], &far[..], &vary[..]].concat());
    assert!(text.success().contains("the path leaves the region that its energy allows"));
}

/// In phase space q and p are varied independently: along p the action of an oscillator is greatest.
#[test]
fn the_action_in_phase_space_is_stationary_for_both() {
    let words = ["--in", "2", "--along", "x=sin(t)", "--epsilons", "-0.5:0.5:3"];
    let varied = |vary: &[&str]| {
        let found = path(OSCILLATOR, &[&words[..], vary].concat());
        let of = |i: usize| found["varied"][i]["action"].as_f64().unwrap();
        let own = found["action"].as_f64().unwrap();
        close(of(1), own, 1e-13);
        assert!(found["varied"][0]["abbreviated"].is_null());
        [of(0) - own, of(2) - own]
    };
    // −½ ε² ∫ π² dt, whatever the motion
    for rise in varied(&["--vary", "p_x=1"]) {
        close(rise, -0.25, 1e-13);
    }
    // with δ = sin(πt/2): ε² ∫ (π δ′ − ½ π² − ½ δ²) dt, π = cos(πt/2), ∫ cos² = ∫ sin² = 1
    for rise in varied(&["--vary", "p_x=cos(pi*t/2)", "--vary", "x=sin(pi*t/2)"]) {
        close(rise, 0.25 * (0.5 * PI - 0.5 - 0.5), 1e-13);
    }
}

/// Two coupled wells, between whose ends Newton's method comes to nothing from the straight line: a motion that begins as the path that is
/// found does arrives where that ends.
#[test]
fn a_path_is_found_where_the_straight_line_leads_to_none() {
    let file = "title = \"wells\"\n[coordinates]\nx = { initial = 0.5 }\ny = { initial = 0.2 }\n[lagrangian]\n\
                L = \"1/2*(x'^2 + y'^2) + 1/2*x^2 - 1/4*x^4 - y^2 - 3/10*x^2*y^2\"\n";
    let found = path(file, &["--in", "2", "--to", "x=1", "--to", "y=1"]);
    assert_eq!(found["stationary"], true);
    let first = |k: usize| found["rows"][0][k].as_f64().unwrap();
    let [x, y] = [3, 4].map(|k| format!("{}'={:e}", ["x", "y"][k - 3], first(k)));
    let run = ["run", "system.toml", "--init", &x, "--init", &y, "--until", "2", "--every", "2"];
    let end = with_file(file, &[&run[..], &["--format", "json"]].concat()).json();
    close(end["rows"][1][1].as_f64().unwrap(), 1.0, 1e-8);
    close(end["rows"][1][2].as_f64().unwrap(), 1.0, 1e-8);
}

/// No polynomial follows a motion over a kink of L, in however short a time.
#[test]
fn a_path_over_a_kink_is_refused_for_the_kink() {
    let file = "title = \"kink\"\n[coordinates]\nx = { initial = -1.0 }\n[lagrangian]\nL = \"1/2*x'^2 - abs(x)\"\n";
    let ends = ["path", "system.toml", "--in", "3", "--to", "x=1"];
    with_file(file, &ends).fails(1, &["the path passes a kink of L"]);
}
