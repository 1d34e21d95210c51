//! `run` where a mass jumps at an instant: no force acts there, so that p keeps its value and the velocities jump. All numbers here
//! are closed forms, and impulses and events may come at the same instant.

use super::with_file;

/// The methods that take steps of any kind, and those of a fixed step whose steps end at the instant or are cut there.
const METHODS: [&[&str]; 6] = [
    &["taylor"],
    &["taylor", "--tolerance", "fast"],
    &["dop853"],
    &["dop853", "--tolerance", "fast"],
    &["rk4"],
    &["gauss4"],
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
    let known =
        |line: &&str| line.contains("while the velocities jump") || line.contains(" kinks ");
    assert!(done.stderr.lines().all(|line| known(&line)), "{method:?}: {}", done.stderr);
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

/// A mass that jumps with the sign of sin 3t, on a spring: each part of the way is a rotation.
#[test]
fn momenta_keep_their_values_at_instants_that_no_number_is() {
    let law = law("(3 - sign(sin(3*t)))/2", "1/2*x^2");
    let times = [0.0, 0.5, 1.0, 2.0, 3.0, 3.5];
    let instants = [1.0, 2.0, 3.0].map(|k| k * std::f64::consts::PI / 3.0);
    let exactly = |time: f64| {
        let (mut x, mut p, mut now, mut mass) = (0.3, 0.8, 0.0, 1.0_f64);
        for end in instants.into_iter().filter(|&t| t < time).chain([time]) {
            let rate = 1.0 / mass.sqrt();
            let (sin, cos) = (rate * (end - now)).sin_cos();
            (x, p) = (x * cos + p / (mass * rate) * sin, p * cos - x * mass * rate * sin);
            now = end;
            mass = 3.0 - mass;
        }
        (x, p)
    };
    for (method, within) in METHODS.iter().zip([4e-15, 2e-14, 1e-11, 1e-12, 2e-2, 1e-6]) {
        let words = times.map(|t| t.to_string()).join(",");
        for row in rows(&law, "", method, &words) {
            let (x, p) = exactly(row[0]);
            let passed = instants.iter().filter(|&&t| t < row[0]).count();
            let mass = if passed % 2 == 0 { 1.0 } else { 2.0 };
            assert_close(&row, [x, p / mass, p], within, &format!("{method:?}, t = {}", row[0]));
        }
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
    for method in &METHODS[..4] {
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
