//! Adiabatic invariants: how ∮ p dq changes with the smoothness of a ramp, and what a run says of it.

use serde_json::Value;

use super::{phaselab, with_file};

const OSCILLATOR: &str = "title = \"Oscillator\"\n[coordinates]\nq = { initial = 1.0, momentum = 0.0 }\n\
                          [parameters]\nw = 1.0\n[hamiltonian]\nH = \"p_q^2/2 + w^2*q^2/2\"\n";

/// E/w at the end of a run, by the last row.
fn action(file: &str, words: &[&str]) -> f64 {
    let words =
        [&["run", "system.toml", "--format", "json", "--observe", "J=energy/w"], words].concat();
    let found = with_file(file, &words).json();
    let names = found["columns"].as_array().unwrap();
    let at = names.iter().position(|name| name == "J").unwrap();
    found["rows"].as_array().unwrap().last().unwrap()[at].as_f64().unwrap()
}

/// The greatest change of the action over all phases, which is sinusoidal in twice the phase.
fn swing(file: &str, words: &[&str]) -> f64 {
    let [along, across, between] =
        [(1.0_f64, 0.0_f64), (0.0, 1.0), (0.5_f64.sqrt(), 0.5_f64.sqrt())].map(|(q, p)| {
            let start = [format!("q={q:?}"), format!("p_q={p:?}")];
            let words = [words, &["--init", &start[0], "--init", &start[1]]].concat();
            2.0 * action(file, &words)
        });
    let mean = 0.5 * (along + across);
    (along - mean).hypot(between - mean)
}

/// The exponents of the change in ε = 1/T, at times after which the phases of both ends agree.
fn slopes(of: impl Fn(f64) -> f64) -> [f64; 2] {
    let changes = [5.0, 10.0, 20.0].map(|turns| of(std::f64::consts::TAU * turns));
    [(changes[0] / changes[1]).log2(), (changes[1] / changes[2]).log2()]
}

#[test]
fn the_change_of_the_action_follows_the_smoothness_of_the_ramp() {
    // jumps of the first, the second and the third derivative: ε, ε², ε³
    let ramped = |form: &'static str| {
        move |time: f64| {
            let (ramp, end) = (format!("w=1:2:0:{time:?}{form}"), format!("{time:?}"));
            swing(OSCILLATOR, &["--ramp", &ramp, "--at", &end])
        }
    };
    let cubic = OSCILLATOR.replace("w = 1.0", "T = 1.0").replace(
        "[hamiltonian]",
        "[definitions]\nu = \"min(max(t/T, 0), 1)\"\nw = \"1 + u^2*(3 - 2*u)\"\n[hamiltonian]",
    );
    let cubic = |time: f64| {
        let (set, end) = (format!("T={time:?}"), format!("{time:?}"));
        swing(&cubic, &["--set", &set, "--at", &end])
    };
    for (found, expected) in
        [(slopes(ramped(":linear")), 1.0), (slopes(cubic), 2.0), (slopes(ramped("")), 3.0)]
    {
        for slope in found {
            assert!((slope - expected).abs() < 0.1, "{slope} is not {expected}");
        }
    }
    // without a jump in any derivative: less than any power
    let smooth = OSCILLATOR.replace("w = 1.0", "T = 1.0").replace(
        "[hamiltonian]",
        "[definitions]\nw = \"sqrt(2.5 + 1.5*tanh(t/T))\"\n[hamiltonian]",
    );
    let smooth = |time: f64| {
        let [set, start, end] =
            [format!("T={time:?}"), format!("t={:?}", -18.0 * time), format!("{:?}", 18.0 * time)];
        swing(&smooth, &["--set", &set, "--init", &start, "--at", &end])
    };
    // closed form of N. D. Birrell and P. C. W. Davies, Quantum Fields in Curved Space, § 3.4: 2|αβ|
    for time in [0.5, 1.0] {
        let pi = std::f64::consts::PI;
        let sinh = |x: f64| (pi * time * x).sinh();
        let beta = sinh(0.5) * sinh(0.5) / (sinh(1.0) * sinh(2.0));
        let exact = 2.0 * (beta * (1.0 + beta)).sqrt();
        let found = smooth(time);
        assert!((found - exact).abs() < 1e-9, "{found} is not {exact}");
    }
    assert!(smooth(2.0) < smooth(1.0) / 16.0);
}

fn gauge(found: &Value) -> Value {
    let mut all = found["invariants"].as_array().unwrap().iter();
    all.find(|one| one["name"] == "action variable").cloned().unwrap_or(Value::Null)
}

#[test]
fn a_run_with_a_ramp_says_what_became_of_the_action() {
    let run = |ramp: &str, until: &str| {
        let words = ["run", "pendulum", "--init", "theta=1", "--init", "theta'=0", "--ramp", ramp];
        let rest = ["--at", until, "--format", "json"];
        gauge(&phaselab(&[&words[..], &rest].concat()).json())
    };
    let slow = run("l=1:2:0:60", "60");
    assert_eq!(slow["verdict"], "adiabatic", "{slow}");
    let [first, last] = ["initial", "final"].map(|name| slow[name].as_f64().unwrap());
    assert!((last / first - 1.0).abs() < 1e-4 && last != first, "{slow}");
    let change = slow["max_drift"].as_f64().unwrap();
    assert!((change - (last - first).abs() / first).abs() < 1e-15);
    assert_eq!(run("l=1:2:0:0.2", "0.2")["verdict"], "not conserved");
    assert_eq!(run("l=1:2:5:10", "2")["verdict"], "open");
    // without a ramp there is nothing to say
    let still = phaselab(&["run", "pendulum", "--at", "1", "--format", "json"]).json();
    assert_eq!(gauge(&still), Value::Null);
    // of an oscillator it is 2π E/w
    let words = ["run", "system.toml", "--ramp", "w=1:3:0:40", "--at", "40", "--format", "json"];
    let found = with_file(OSCILLATOR, &words).json();
    let row = found["rows"][0].as_array().unwrap();
    let energy = row[row.len() - 2].as_f64().unwrap();
    let known = gauge(&found);
    assert!(
        (known["final"].as_f64().unwrap() - std::f64::consts::TAU * energy / 3.0).abs() < 1e-12
    );
    assert!((known["initial"].as_f64().unwrap() - std::f64::consts::PI).abs() < 1e-13);
}

/// A well that divides into two: the motion is left in one of them, with half its action.
/// The event that ends the preset's run happens just when the run ends.
#[test]
fn what_became_of_the_action_is_said_where_an_event_ends_the_run() {
    let run = ["run", "opening-well", "--format", "json", "--every", "100"];
    let found = gauge(&phaselab(&run).json());
    let [before, after] = ["initial", "final"].map(|name| found[name].as_f64().expect("a number"));
    // ∮ p dq of ½ p² + ¼ q⁴ − ¼ q² through (1.35, 0): 4.511237108659841 by quadrature; one well has half of it
    assert!((before - 4.511_237_108_659_841).abs() < 1e-10, "{before}");
    assert!((after / before - 0.5).abs() < 0.01, "{after}");
}

#[test]
fn a_well_that_opens_halves_the_action() {
    let file = "title = \"Well\"\n[coordinates]\nq = { initial = 1.0, momentum = 0.0 }\n[parameters]\n\
                a = 0.5\n[hamiltonian]\nH = \"p_q^2/2 + q^4/4 - a*q^2/2\"\n";
    for start in ["q=1.3", "q=1.35", "q=-1.4"] {
        let words = ["run", "system.toml", "--ramp", "a=0.5:2.5:0:600", "--at", "600"];
        let rest = ["--init", start, "--format", "json"];
        let known = gauge(&with_file(file, &[&words[..], &rest].concat()).json());
        let [first, last] = ["initial", "final"].map(|name| known[name].as_f64().unwrap());
        assert!((last / first - 0.5).abs() < 0.02, "{known}");
        assert_eq!(known["verdict"], "not conserved");
    }
}

/// The well that a motion comes out in, by the sign of q, at a grid of starts.
fn wells(arguments: &[&str]) -> Vec<f64> {
    let words = [&["sweep", "opening-well"], arguments, &["--tolerance=fast", "--format=json"]];
    let found = phaselab(&words.concat()).json();
    let names = found["columns"].as_array().unwrap();
    // what was set stands before what was found
    let [q, energy] =
        ["q", "energy"].map(|name| names.iter().rposition(|known| known == name).expect(name));
    let rows = found["rows"].as_array().unwrap().iter();
    let end = |row: &Value| {
        assert!(row[energy].as_f64().unwrap() < 0.0, "it is in a well: {row}");
        row[q].as_f64().unwrap().signum()
    };
    rows.map(end).collect()
}

/// Starts of other actions come to the separatrix at other phases, through ten turns or so, and each well takes half of them:
/// nothing in this sample is its own mirror image.
#[test]
fn each_well_takes_half_of_the_starts() {
    let found = wells(&["--grid=q=1.2:1.5:200", "--set=T=200"]);
    let right = found.iter().filter(|side| **side > 0.0).count();
    // three standard deviations of chance
    assert_eq!(found.len(), 200);
    assert!((right as f64 / 200.0 - 0.5).abs() < 0.106, "{right} of 200");
    let changes = found.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert!(changes >= 10, "{changes}");
}

/// A ramp that begins half a period later, 7.1635/2, leaves the mirror image: over all phases each well has one half.
#[test]
fn half_a_period_later_it_is_the_other_well() {
    let [now, later] = ["--grid=t0=0.1:3.5:18", "--grid=t0=3.68175:7.08175:18"]
        .map(|grid| wells(&[grid, "--set=T=100"]));
    let other = now.iter().zip(&later).filter(|(a, b)| a != b).count();
    // a start at the edge of its band may be on either side
    assert!(now.len() == 18 && other >= 17, "{now:?} {later:?}");
}

/// The preset of the three ramps: ε, ε², and the closed form that is less than any power of ε.
#[test]
fn three_ramps_have_three_slopes() {
    let changes = |n: u32| {
        let (set, end) = (format!("n={n}"), format!("{}", 40 * (1 << n)));
        let names = ["corner", "second", "smooth"];
        let mut words = vec!["run", "three-ramps", "--set", &set, "--at", &end];
        for name in &names {
            words.extend(["--observe", name]);
        }
        words.extend(["--format", "json"]);
        let found = phaselab(&words).json();
        let columns = found["columns"].as_array().unwrap();
        names.map(|name| {
            let place = columns.iter().position(|known| known == name).expect("a column");
            found["rows"][0][place].as_f64().unwrap()
        })
    };
    let [first, last] = [changes(0), changes(4)];
    for (k, slope) in [(0, 1.0), (1, 2.0)] {
        let found = (first[k] / last[k]).log2() / 4.0;
        assert!((found - slope).abs() < 0.2, "{found} is not {slope}");
    }
    // N. D. Birrell and P. C. W. Davies, Quantum Fields in Curved Space, § 3.4: 2|αβ| with ρ = 8/T
    for n in 0..3 {
        let rho = 1.0 / f64::from(1 << n);
        let sinh = |x: f64| (std::f64::consts::PI * x / rho).sinh();
        let beta = sinh(0.5) * sinh(0.5) / (sinh(1.0) * sinh(2.0));
        let exact = 2.0 * (beta * (1.0 + beta)).sqrt();
        let found = changes(n)[2];
        assert!((found / exact - 1.0).abs() < 1e-6, "{n}: {found} is not {exact}");
    }
    assert!(last[2] < 1e-12, "{}", last[2]);
}

/// What the notes of `slow-oscillator` say of three ramps; J by DOP853 of SciPy, to thirteen digits a step.
#[test]
fn the_oscillator_of_the_notes_loses_what_they_say() {
    for (time, expected, words) in [
        ("60", 0.500_016_426_424_5, "3 parts in 10⁵"),
        ("5", 0.495_690_827_187_4, "0.9 per cent"),
        ("1", 0.402_571_192_895_3, "a fifth of J"),
    ] {
        let set = format!("T={time}");
        let run = ["run", "slow-oscillator", "--set", &set, "--at", "80", "--format", "json"];
        let found = phaselab(&[&run[..], &["--observe", "J=energy/omega"]].concat()).json();
        let names = found["columns"].as_array().unwrap();
        let at = names.iter().position(|name| name == "J").unwrap();
        let action = found["rows"][0][at].as_f64().unwrap();
        assert!((action - expected).abs() < 1e-10, "T = {time}: {action}");
        let file = include_str!("../../../presets/adiabatic/slow-oscillator.toml");
        assert!(file.contains(words), "{words}");
    }
}

/// The work that a ramp does is zero before it, and at first grows by steps of the clock: that is the rounding of its rate.
#[test]
fn dop853_passes_the_beginning_of_a_ramp() {
    for (preset, tolerance) in [
        ("slow-oscillator", "1e-7"),
        ("slow-oscillator", "2.1544346900318777e-11"),
        ("pendulum-drawn-up", "4.641588833612782e-8"),
    ] {
        let run = ["run", preset, "--at", "15", "--format", "json"];
        let last = |words: &[&str]| {
            let found = phaselab(&[&run[..], words].concat()).json();
            assert_eq!(found["status"], "completed", "{preset} {tolerance}: {}", found["message"]);
            found["rows"][0][1].as_f64().unwrap()
        };
        let (exact, found) = (last(&[]), last(&["--method", "dop853", "--tolerance", tolerance]));
        let allowed = 100.0 * tolerance.parse::<f64>().unwrap();
        assert!((found - exact).abs() < allowed, "{preset} {tolerance}: {found} is not {exact}");
    }
}
