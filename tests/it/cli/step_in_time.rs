//! `run` where a mass jumps at an instant: no force acts there, so that p keeps its value and the velocities jump. All numbers here
//! are closed forms, and impulses and events may come at the same instant.

mod signs;

use super::with_file;

const METHODS: [&[&str]; 11] = [
    &["taylor"],
    &["taylor", "--tolerance", "fast"],
    &["dop853"],
    &["dop853", "--tolerance", "fast"],
    &["rk4"],
    &["gauss4"],
    &["gauss6"],
    &["leapfrog"],
    &["yoshida4"],
    &["yoshida8"],
    &["symplectic-euler"],
];

const TIMES: &str = "0.5,1,1.0000000000000004,2,3,3.5";

/// x, x' and p at each of the times.
fn rows(law: &str, more: &str, method: &[&str], times: &str) -> Vec<[f64; 4]> {
    let text = format!(
        "title = \"A step\"\n[coordinates]\nx = {{ initial = 0.3, velocity = 0.8 }}\n{law}\n{more}"
    );
    rows_of(&text, method, times)
}

fn rows_of(text: &str, method: &[&str], times: &str) -> Vec<[f64; 4]> {
    let arguments = ["run", "system.toml", "--strict", "--at", times, "--method"];
    let done = with_file(text, &[&arguments[..], method].concat());
    assert_eq!(done.code, 0, "{method:?}: {}\n{text}", done.stderr);
    // what is said before the run, and nothing after it
    let known = |line: &str| line.contains("while the velocities jump");
    assert!(done.stderr.lines().all(known), "{method:?}: {}", done.stderr);
    let lines: Vec<&str> = done.stdout.lines().filter(|line| !line.starts_with('#')).collect();
    let head: Vec<&str> = lines[0].split(',').collect();
    let row = |line: &&str| -> [f64; 4] {
        let row: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
        ["t", "x", "x'", "p_x"].map(|name| row[head.iter().position(|h| *h == name).unwrap()])
    };
    let rows: Vec<[f64; 4]> = lines[1..].iter().map(row).collect();
    assert_eq!(rows.len(), times.split(',').count(), "{}", done.stdout);
    rows
}

fn law(mass: &str, potential: &str) -> String {
    format!("[lagrangian]\nL = \"1/2*{mass}*x'^2 - {potential}\"")
}

fn assert_close(found: &[f64; 4], wanted: [f64; 3], within: f64, what: &str) {
    for (found, wanted) in found[1..].iter().zip(wanted) {
        let size = wanted.abs().max(1.0);
        assert!((found - wanted).abs() <= within * size, "{what}: {found} and not {wanted}");
    }
}

/// The mass is halved at t = 1, where the velocity is 0.8. An impulse at that instant adds to p, whether it is given in velocities,
/// which are those after the step, or caused by an event that comes then; at the instant itself all has happened.
#[test]
fn momenta_keep_their_values_where_a_mass_is_halved_beside_impulses_and_events() {
    let halved = law("(3 - sign(t - 1))/2", "0");
    let kick = |change: &str, at: &str| {
        format!("[[impulses]]\nname = \"kick\"\nchange = {{ p_x = \"{change}\" }}\n{at}")
    };
    let by_event = "[[events]]\nname = \"wall\"\nwhen = \"x - 1.1\"\naction = \"impulse:kick\"\n";
    let mark = "[[events]]\nname = \"mark\"\nwhen = \"x' - 1.2\"\n";
    for (more, after) in [
        (String::new(), 1.6),
        (mark.to_owned(), 1.6),
        (kick("1", "at = [1.0]\n"), 2.6),
        (kick("-0.5*x'", "at = [1.0]\n"), 0.8),
        (kick("1", by_event), 2.6),
    ] {
        let is_late = more.contains("wall");
        for method in METHODS {
            for row in rows(&halved, &more, method, TIMES) {
                let time = row[0];
                // where rounding brings the wall later than the step, its row is that of the step
                if is_late && (time - 1.0).abs() < 1e-14 {
                    continue;
                }
                let x = 0.3 + 0.8 * time.min(1.0) + after * (time - 1.0).max(0.0);
                let (velocity, momentum) = if time < 1.0 { (0.8, 1.6) } else { (after, after) };
                let what = format!("{method:?}, {more}, t = {time}");
                assert_close(&row, [x, velocity, momentum], 2e-14, &what);
            }
        }
    }
}

/// A motion that begins exactly at the instant begins after it, whether its velocity is given or its momentum.
#[test]
fn a_motion_that_begins_at_the_instant_has_the_law_after_it() {
    for start in [1.0, 0.0] {
        let halved = law(&format!("(3 - sign(t - {start}))/2"), "0");
        let begins = format!("[run]\nstart = {start}\n");
        for method in METHODS {
            for given in [&[][..], &["--init", "p_x=0.8"]] {
                let times = if start == 1.0 { "1,1.0000000000000004,2" } else { "0,1e-300,1" };
                for row in rows(&halved, &begins, &[method, given].concat(), times) {
                    let x = 0.3 + 0.8 * (row[0] - start);
                    assert_close(&row, [x, 0.8, 0.8], 1e-14, &format!("{method:?}, {given:?}"));
                }
            }
        }
    }
}

/// x and p of a mass on a spring of strength 1 that begins with x = 0.3 and a velocity of 0.8: each part of the way, on which the mass
/// is 1 or 2, is a rotation.
fn on_spring(time: f64, instants: &[f64], first: f64) -> [f64; 3] {
    let (mut x, mut p, mut now, mut mass) = (0.3, 0.8 * first, 0.0, first);
    for end in instants.iter().copied().filter(|&t| t <= time).chain([time]) {
        let rate = 1.0 / mass.sqrt();
        let (sin, cos) = (rate * (end - now)).sin_cos();
        (x, p) = (x * cos + p / (mass * rate) * sin, p * cos - x * mass * rate * sin);
        now = end;
        mass = 3.0 - mass;
    }
    [x, p / (3.0 - mass), p]
}

/// The mass jumps with the sign of sin 3t, at instants that no number is, and at one that is a number. Each method is as accurate as
/// it is without steps.
#[test]
fn every_method_keeps_its_accuracy_on_a_spring() {
    let third = std::f64::consts::FRAC_PI_3;
    let bounds = [1e-15, 3e-15, 3e-12, 3e-14, 2e-6, 3e-7, 1e-11, 1e-3, 1e-5, 1e-12, 6e-2];
    for (mass, instants, first) in [
        ("(3 - sign(sin(3*t)))/2", vec![third, 2.0 * third, 3.0 * third], 1.0),
        ("(3 - sign(t - 1))/2", vec![1.0], 2.0),
    ] {
        let law = law(mass, "1/2*x^2");
        for (method, within) in METHODS.iter().zip(bounds) {
            for row in rows(&law, "", method, "0.5,1,2,3,3.5") {
                let wanted = on_spring(row[0], &instants, first);
                assert_close(&row, wanted, within, &format!("{mass}, {method:?}, t = {}", row[0]));
            }
        }
    }
}

/// The error is of the order of the method, also where the mass jumps.
#[test]
fn errors_of_equal_steps_are_of_their_order() {
    let law = law("(3 - sign(t - 1.03))/2", "1/2*x^2");
    for (method, order) in
        [("symplectic-euler", 1), ("leapfrog", 2), ("rk4", 4), ("yoshida4", 4), ("gauss4", 4)]
    {
        let error = |step: &str| {
            let row = rows(&law, "", &[method, "--step", step], "3")[0];
            let [x, _, p] = on_spring(3.0, &[1.03], 2.0);
            (row[1] - x).hypot(row[3] - p)
        };
        let gain = error("0.02") / error("0.01");
        let wanted = f64::from(2_u32.pow(order));
        assert!((0.8 * wanted..1.25 * wanted).contains(&gain), "{method}: {gain}");
    }
}

/// A force that jumps at the same instant is followed by methods that evaluate it within steps only, and the others say that it is not.
#[test]
fn a_force_that_jumps_with_the_mass_is_followed_or_it_says_that_it_is_not() {
    let law = law("(3 - sign(t - 1))/2", "1/2*x^2*(3 - sign(t - 1))/2");
    for (method, within) in
        [("taylor", 1e-15), ("dop853", 1e-11), ("rk4", 2e-6), ("gauss6", 1e-10), ("leapfrog", 1e-3)]
    {
        let row = rows(&law, "", &[method], "3")[0];
        // mass and spring are doubled before: the frequency is the same
        let (sin, cos) = 1.0_f64.sin_cos();
        let (x, p) = (0.3 * cos + 0.8 * sin, 1.6 * cos - 0.6 * sin);
        let (sin, cos) = 2.0_f64.sin_cos();
        let wanted = [x * cos + p * sin, p * cos - x * sin];
        assert_close(&row, [wanted[0], wanted[1], wanted[1]], within, method);
    }
    let text =
        format!("title = \"T\"\n[coordinates]\nx = {{ initial = 0.3, velocity = 0.8 }}\n{law}");
    let reported = |text: &str, method: &str| {
        with_file(text, &["run", "system.toml", "--at", "3", "--method", method]).stderr
    };
    assert!(reported(&text, "yoshida4").contains("yoshida4 steps over the kinks"));
    // a step ends where the potential jumps, too, and not where a force alone does
    let apart = text.replace("x^2*(3 - sign(t - 1))", "x^2*(3 - sign(t - 1.5))");
    let alone = format!("{}\nforces = {{ x = \"sign(t - 1.5)\" }}", text.trim_end());
    for method in ["dop853", "rk4", "gauss6"] {
        assert!(!reported(&apart, method).contains(" kinks "), "{method}");
        assert!(reported(&alone, method).contains(" steps over the kinks"), "{method}");
    }
    for text in [&apart, &alone] {
        assert!(!reported(text, "taylor").contains(" kinks "));
    }
}

/// At a pole no function that can be evaluated shows the step: the velocities are kept, and that is reported.
#[test]
fn a_step_at_a_pole_keeps_the_velocities_and_says_so() {
    for mass in
        ["(3 - sign(atan(1/(t - 1)) + t/100))/2", "(3 - sign(atan(tan(t + 0.5)) + t/100))/2"]
    {
        let text = format!(
            "title = \"T\"\n[coordinates]\nx = {{ initial = 0.3, velocity = 0.8 }}\n{}",
            law(mass, "0")
        );
        let done = with_file(&text, &["run", "system.toml", "--at", "3"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        assert!(
            done.stderr.contains("at a pole, where the motion keeps the velocities"),
            "{}",
            done.stderr
        );
        assert!(!done.stderr.contains("keep their values"), "{}", done.stderr);
        let last: Vec<&str> = done.stdout.lines().last().unwrap().split(',').collect();
        assert!((last[1].parse::<f64>().unwrap() - 2.7).abs() < 1e-14, "{}", done.stdout);
    }
}

/// The way back from the instant itself begins before the step.
#[test]
fn a_motion_reversed_at_the_instant_returns() {
    let text = format!(
        "title = \"T\"\n[coordinates]\nx = {{ initial = 0.3, velocity = 0.8 }}\n{}",
        law("(3 - sign(t - 1))/2", "1/2*x^2")
    );
    for until in ["1", "1.5"] {
        let done = with_file(&text, &["reverse", "system.toml", "--until", until]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let (_, distance) = done.stdout.split_once(": to ").unwrap();
        let distance = distance.split(' ').next().unwrap();
        let is_exact = distance == "the" || distance.parse::<f64>().unwrap() < 1e-15;
        assert!(is_exact, "{}", done.stdout);
    }
}

/// So does one that begins at an instant, which may be t = 0; and the error of a step is that of one beside which the law does not jump.
#[test]
fn a_motion_that_begins_at_the_instant_returns_to_it() {
    let reverse = |mass: &str, start: &str, until: &str, method: &str| {
        let text = format!(
            "title = \"T\"\n[coordinates]\nx = {{ initial = 0.3, velocity = 0.8 }}\n[parameters]\neps = 1e-150\n{}\n[run]\nstart = {start}\n",
            law(mass, "1/2*x^2")
        );
        let arguments = ["reverse", "system.toml", "--until", until, "--method", method];
        with_file(&text, &[&arguments[..], &["--format", "json"]].concat()).json()
    };
    let (often, once) = ("(3 - sign(sin(3*t)))/2", "(3 - sign(t - 1))/2");
    for (mass, start, until) in [
        // whose sign is lost at 1e-200
        ("(3 - sign(eps*t))/2", "0", "0.5"),
        (often, "0", "0.5"),
        (often, "0", "2"),
        (once, "1", "2"),
        (once, "0", "1"),
        (once, "0", "1.5"),
    ] {
        for (method, within) in [("taylor", 1e-15), ("dop853", 2e-11)] {
            let found = reverse(mass, start, until, method);
            let number =
                |key: &str| found[key].as_f64().unwrap_or_else(|| panic!("{key} in {found}"));
            let what = format!("{mass} from {start} to {until} by {method}: {found}");
            assert_eq!(number("t").to_string(), start, "{what}");
            assert!(number("return_error") < within && number("step_error") < within, "{what}");
        }
    }
}

/// No event of the file acts on the motion.
#[test]
fn what_needs_derivatives_refuses_the_step_and_no_event() {
    let text = format!(
        "title = \"T\"\n[coordinates]\nx = {{ initial = 0.3, velocity = 0.8 }}\n{}",
        law("(3 - sign(t - 1))/2", "1/2*x^2")
    );
    for command in ["equilibria", "lyapunov"] {
        let done = with_file(&text, &[command, "system.toml"]);
        assert_ne!(done.code, 0);
        assert!(done.stderr.contains("L has a step in time in its momenta"), "{}", done.stderr);
    }
}

/// So often that a step ends at each instant: no gauge sees a velocity on the wrong side.
#[test]
fn a_mass_that_jumps_often_loses_no_momentum() {
    for row in rows(&law("(3 - sign(sin(100*t)))/2", "0"), "", &["taylor"], "0.5,2") {
        // sin 50 < 0 and sin 200 < 0: the mass is doubled, and begins so with its first half
        assert!((row[3] - 0.8).abs() < 1e-14 && (row[2] - 0.4).abs() < 1e-14, "{row:?}");
    }
}

/// As by H: the mass of a particle on a spring is tripled at t = 1, and that of before again at t = 3.
#[test]
fn velocities_after_a_step_are_those_of_the_same_law_as_h() {
    let mass = "(2 + sign(t - 1)*sign(3 - t))";
    let by_h = format!(
        "title = \"H\"\n[coordinates]\nx = {{ initial = 0.3, momentum = 0.8 }}\n\
         [hamiltonian]\nH = \"p_x^2/(2*{mass}) + x^2\"\n"
    );
    let expected = rows_of(&by_h, &["taylor"], "0.5,2,3.5");
    for method in [METHODS[0], METHODS[1]] {
        let found = rows(&law(mass, "x^2"), "", method, "0.5,2,3.5");
        for (a, b) in expected.iter().zip(&found) {
            assert_close(b, [a[1], a[2], a[3]], 1e-14, &format!("{method:?}"));
        }
    }
}

/// In atomic units, where t = 10⁻¹⁶ and the mass is 9.1·10⁻³¹.
#[test]
fn momenta_keep_their_values_in_any_units() {
    let text = format!(
        "title = \"SI\"\n[coordinates]\nx = {{ initial = 1e-10, velocity = 1e6 }}\n{}",
        law("9.1e-31*(3 - sign(t - 1e-16))/2", "0")
    );
    for method in METHODS {
        let rows = rows_of(&text, method, "5e-17,1e-16,2e-16");
        for ([_, x, velocity, p], wanted) in
            rows.into_iter().zip([[1.5e-10, 1e6], [2e-10, 2e6], [4e-10, 2e6]])
        {
            let is = |found: f64, wanted: f64| (found / wanted - 1.0).abs() < 1e-14;
            assert!(is(x, wanted[0]) && is(velocity, wanted[1]), "{method:?}: {x} {velocity}");
            assert!(is(p, 1.82e-24), "{method:?}: {p}");
        }
    }
}

/// A sign of another coordinate in its own momentum does not concern that which jumps in time.
#[test]
fn a_step_at_places_in_another_momentum_changes_nothing() {
    for other in ["sign(y)*y'/9 + 1/2*y'^2", "1/2*(2 + sign(y - t))*y'^2"] {
        let text = format!(
            "title = \"Two\"\n[coordinates]\nx = {{ initial = 0.3, velocity = 0.8 }}\n\
             y = {{ initial = 9, velocity = 0.1 }}\n[lagrangian]\n\
             L = \"1/4*(3 - sign(t - 1))*x'^2 + {other}\"\n"
        );
        let arguments = ["run", "system.toml", "--at", "0.5,1,3", "--strict"];
        let done = with_file(&text, &arguments);
        assert_eq!(done.code, 0, "{}", done.stderr);
        assert_eq!(done.stderr.lines().count(), 2, "{}", done.stderr);
        assert!(done.stderr.contains("while the velocities jump\n"), "{}", done.stderr);
        assert!(done.stderr.contains("the force is an impulse"), "{}", done.stderr);
        let last: Vec<&str> = done.stdout.lines().last().unwrap().split(',').collect();
        let x: f64 = last[1].parse().unwrap();
        assert!((x - (0.3 + 0.8 + 3.2)).abs() < 1e-14, "{}", done.stdout);
    }
}

/// A bead on a ring keeps its momentum along it, and the constraint.
#[test]
fn momenta_along_constraints_keep_their_values() {
    let text = "title = \"Ring\"\n[coordinates]\nx = { initial = 1, velocity = 0 }\n\
                y = { initial = 0, velocity = 0.8 }\n[lagrangian]\n\
                L = \"1/4*(3 - sign(t - 1))*(x'^2 + y'^2)\"\n[[constraints]]\nname = \"ring\"\nexpression = \"x^2 + y^2 - 1\"\n";
    for method in ["taylor", "dop853"] {
        let done = with_file(
            text,
            &["run", "system.toml", "--strict", "--at", "0.5,1,2", "--method", method],
        );
        assert_eq!(done.code, 0, "{}", done.stderr);
        let rows = done.stdout.lines().filter(|line| !line.starts_with(['#', 't']));
        for row in rows.map(|row| row.split(',').map(|x| x.parse().unwrap()).collect::<Vec<f64>>())
        {
            let angle = 0.8 * row[0].min(1.0) + 1.6 * (row[0] - 1.0).max(0.0);
            let (sin, cos) = angle.sin_cos();
            assert!((row[1] - cos).abs() < 1e-12 && (row[2] - sin).abs() < 1e-12, "{row:?}");
        }
    }
}

/// A mass that changes smoothly for long after its step is followed as smoothly, however few digits of the clock a change of it has.
#[test]
fn a_mass_that_changes_slowly_is_followed_long_after_its_step() {
    let end = |step: &str| {
        let text = format!(
            "title = \"m\"\n[coordinates]\nx = {{ initial = 1.0, velocity = 0.0 }}\n[lagrangian]\n\
             L = \"(1 + {step} + 0.5*sin(t))*x'^2/2 - x^2/2\"\n[run]\nstart = 1e9\n"
        );
        let done = with_file(&text, &["run", "system.toml", "--at", "1000000010"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let last: Vec<&str> = done.stdout.lines().last().unwrap().split(',').collect();
        last[1].parse::<f64>().unwrap()
    };
    let (stepped, smooth) = (end("(1 + sign(t - 3))/2"), end("1"));
    assert!((stepped - smooth).abs() < 1e-7, "{stepped} and {smooth}");
}

/// A spring that is stiffer by a half from t = 1.03 on, an instant that no step ends at by itself. Until then x = cos t; the energy
/// jumps by x²/4, and every method that stays within its steps keeps its balance as well as it keeps an energy.
#[test]
fn the_energy_is_balanced_where_the_potential_jumps() {
    let (at, w) = (1.03_f64, 1.5_f64.sqrt());
    let after = |t: f64| at.cos() * (w * (t - at)).cos() - at.sin() / w * (w * (t - at)).sin();
    for law in [
        "velocity = 0 }\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2*(5 + sign(t - 1.03))/4\"\n",
        "momentum = 0 }\n[hamiltonian]\nH = \"1/2*p_x^2 + 1/2*x^2*(5 + sign(t - 1.03))/4\"\n",
    ] {
        let text = format!("title = \"T\"\n[coordinates]\nx = {{ initial = 1, {law}");
        for (method, step, error) in [
            ("taylor", None, 1e-15),
            ("dop853", None, 1e-11),
            ("gauss6", Some("0.05"), 1e-9),
            ("rk4", Some("0.01"), 1e-8),
            ("leapfrog", Some("0.01"), 1e-3),
        ] {
            let step = step.map_or(Vec::new(), |step| vec!["--step", step]);
            let words = ["run", "system.toml", "--at", "3", "--format", "json", "--method", method];
            let done = with_file(&text, &[&words[..], &step].concat());
            assert_eq!(done.code, 0, "{method} {law}");
            assert!(!done.stderr.contains("kinks"), "{method} {law}: {}", done.stderr);
            let read: serde_json::Value = serde_json::from_str(&done.stdout).unwrap();
            let x = read["rows"][0][1].as_f64().unwrap();
            assert!((x - after(3.0)).abs() < error, "{method}: {x} is not {}", after(3.0));
            let gauge = |name: &str| {
                let gauges = read["invariants"].as_array().unwrap();
                gauges.iter().find(|gauge| gauge["name"] == name).unwrap().clone()
            };
            assert_eq!(gauge("energy")["verdict"], "not conserved", "{method}");
            let jump = at.cos().powi(2) / 4.0;
            let gained = gauge("energy")["final"].as_f64().unwrap() - 0.5;
            assert!((gained - jump).abs() < error, "{method}: {gained} is not {jump}");
            let drift = gauge("energy balance")["max_drift"].as_f64().unwrap();
            assert!(drift < error, "{method}: {drift}");
        }
    }
}

/// Derivatives of a motion whose energy jumps and whose state does not are those of the motion.
#[test]
fn a_potential_that_jumps_in_time_has_tangents() {
    let text = "title = \"T\"\n[coordinates]\nx = { initial = 1, velocity = 0 }\n[lagrangian]\n\
        L = \"1/2*x'^2 - 1/2*x^2*(5 + sign(t - 1.03))/4\"\n";
    let read = with_file(text, &["flow", "system.toml", "--until", "3", "--format", "json"]).json();
    let (at, w) = (1.03_f64, 1.5_f64.sqrt());
    let wanted = at.cos() * (w * (3.0 - at)).cos() - at.sin() / w * (w * (3.0 - at)).sin();
    let found = read["matrix"][0][0].as_f64().unwrap();
    assert!((found - wanted).abs() < 1e-13, "{found} is not {wanted}");
}
