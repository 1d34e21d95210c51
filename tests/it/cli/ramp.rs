//! `run --ramp`: closed forms, adiabatic invariants, refusals.

use std::f64::consts::PI;

use super::{phaselab, with_file};

/// The last row of a run.
fn end(file: &str, arguments: &[&str]) -> Vec<f64> {
    let object =
        with_file(file, &[&["run", "system.toml", "--format=json"], arguments].concat()).json();
    let rows = object["rows"].as_array().expect("rows");
    rows.last().unwrap().as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

#[track_caller]
fn near(found: f64, expected: f64, within: f64) {
    assert!((found - expected).abs() <= within, "{found} is not {expected} within {within}");
}

/// A free particle whose mass changes keeps p = m ẋ: the term −(∂²L/∂ẋ∂m) ṁ is there.
#[test]
fn a_mass_that_changes_keeps_the_momentum() {
    let file = r#"
        title = "Free"
        [coordinates]
        x = { initial = 0, velocity = "v" }
        [parameters]
        m = 7
        v = 3
        [lagrangian]
        L = "1/2*m*x'^2"
        [[observables]]
        name = "twice m"
        expression = "2*m"
    "#;
    let smooth = |u: f64| 2.0 + 4.0 * (10.0 * u.powi(3) - 15.0 * u.powi(4) + 6.0 * u.powi(5));
    for (ramp, time, mass) in [
        ("m=2:6:1:4", 0.5, 2.0),
        ("m=2:6:1:4", 2.0, smooth(0.25)),
        ("m=2:6:1:4", 4.5, smooth(0.875)),
        ("m=2:6:1:4", 7.0, 6.0),
        ("m=2:6:1:4:linear", 2.0, 3.0),
        ("m=2:6:1:4:cubic", 2.0, 2.0 + 4.0 * (3.0 / 16.0 - 2.0 / 64.0)),
        ("m=6:2:-1:4", 1.0, 4.0),
    ] {
        let (ramp, at) = (format!("--ramp={ramp}"), format!("--at={time}"));
        let row = end(file, &[&ramp, &at, "--observe=m^2"]);
        // t, x, x', p_x, energy, twice m, m^2, m
        let first = if ramp.contains("-1") { smooth(0.75) } else { 2.0 };
        near(row[3], 3.0 * first, 1e-14);
        near(row[2], 3.0 * first / mass, 1e-14);
        near(row[5], 2.0 * mass, 4e-15);
        near(row[6], mass * mass, 2e-14);
        near(row[7], mass, 2e-15);
    }
    let text = with_file(file, &["run", "system.toml", "--ramp=m=2:6:1:4", "--at=0"]).success();
    assert!(text.contains("\nt,x,x',p_x,energy,twice m,m\n"), "{text}");
    assert!(text.contains("# parameters: m=2.0 v=3.0"), "{text}");
}

/// The change of J = E/ω when the frequency goes from 1 to 2: its amplitude over all phases of the start.
fn change_of_action(duration: f64, kind: &str) -> f64 {
    let file = r#"
        title = "Oscillator"
        [coordinates]
        x = { initial = "cos(phase)", momentum = "-sin(phase)" }
        [parameters]
        w = 1
        phase = 0
        [hamiltonian]
        H = "1/2*p_x^2 + 1/2*w^2*x^2"
    "#;
    let ramp = format!("--ramp=w=1:2:0:{duration:?}{kind}");
    let at = format!("--at={duration:?}");
    let change = |phase: &str| {
        let row = end(file, &[&ramp, &at, "--set", phase]);
        let (x, p) = (row[1], row[3]);
        // E/ω at the end over E/ω at the start, which are (p²/2 + 2x²)/2 and 1/2
        0.5 * p * p + 2.0 * x * x - 1.0
    };
    // to first order it is A cos(2 phase + …)
    change("phase=0").hypot(change("phase=pi/4"))
}

/// A corner changes J in proportion to the rate ε, the smooth ramp, whose third derivative jumps, to ε³. The durations are
/// such that the jumps at both ends meet in the same phase, 2 ∫ω dt = 3 D = 2π n.
#[test]
fn ramps_change_the_action_as_their_smoothness_says() {
    let duration = 2.0 * PI * 20.0 / 3.0;
    let slope = |kind| {
        let [slow, slower] = [1.0, 2.0].map(|factor| change_of_action(factor * duration, kind));
        assert!(slow > 1e-7, "{kind}: {slow}");
        (slow / slower).log2()
    };
    near(slope(":linear"), 1.0, 0.05);
    near(slope(""), 3.0, 0.1);
}

#[test]
fn what_cannot_be_ramped_is_refused() {
    let refused = |arguments: &[&str], said: &[&str]| {
        phaselab(&[&["run"], arguments].concat()).fails(2, said);
    };
    refused(&["pendulum", "--ramp=l=1:2"], &["name=from:to:start:duration"]);
    refused(&["pendulum", "--ramp=l=1:2:0:0"], &["above zero"]);
    refused(&["pendulum", "--ramp=ll=1:2:0:1"], &["unknown parameter `ll`", "`l`"]);
    refused(&["pendulum", "--ramp=l=1:2:0:1", "--ramp=l=1:2:0:1"], &["twice"]);
    refused(&["pendulum", "--ramp=l=1:2:0:1", "--set=l=1"], &["--set and --ramp"]);
    refused(&["kicked-rotor", "--ramp=T=1:2:0:1"], &["`T`", "kick"]);
}

/// A ramp of the file is that of the option, in the law, in observables, and in what is said of the action.
#[test]
fn a_file_may_have_its_ramps() {
    let plain = "title = \"t\"\n[coordinates]\nq = { initial = 1.0, momentum = \"w/4\" }\n[parameters]\nw = 1.0\nT = 20\n\
                 [hamiltonian]\nH = \"p_q^2/2 + w^2*q^2/2\"\n[[observables]]\nname = \"J\"\nexpression = \"energy/w\"\n";
    let forms = [("", "smooth"), (":linear", "linear"), (":cubic", "cubic")];
    for (option, form) in forms {
        let ramped = format!(
            "{plain}[[ramps]]\nparameter = \"w\"\nto = 2\nstart = \"T/4\"\nduration = \"T\"\nform = \"{form}\"\n"
        );
        let by_option = format!("--ramp=w=1:2:5:20{option}");
        for at in ["0", "4", "15", "30"] {
            let at = format!("--at={at}");
            let [mut own, given] =
                [end(&ramped, &[&at, "--observe=w"]), end(plain, &[&at, &by_option])];
            // t, q, q', p_q, energy, J, w
            assert_eq!(own.len(), given.len());
            own.iter_mut().zip(&given).for_each(|(x, y)| near(*x, *y, 1e-13));
        }
        // the slider of the duration acts on it, and so does the value before the ramp
        let faster = end(&ramped, &["--at=20", "--set=T=10", "--set=w=1.5", "--observe=w"]);
        near(faster[6], 2.0, 1e-15);
        assert!((faster[5] - end(&ramped, &["--at=20", "--observe=w"])[5]).abs() > 1e-3);
        let object = with_file(&ramped, &["run", "system.toml", "--format=json", "--at=40"]).json();
        let found = object["invariants"].as_array().unwrap().clone();
        let action = found.iter().find(|one| one["name"] == "action variable").expect("an action");
        near(action["initial"].as_f64().unwrap(), 2.0 * PI * (0.5 + 1.0 / 32.0), 1e-12);
        assert_eq!(action["verdict"], "adiabatic", "{action}");
    }
    // one that begins before the last has ended, or before it has begun, goes on from the value of that moment and ends it
    let cubic = |u: f64| u * u * (3.0 - 2.0 * u);
    for start in ["4", "T/5"] {
        let overlapping = format!(
            "{plain}[[ramps]]\nparameter = \"w\"\nto = 3\nstart = 2\nduration = 8\nform = \"cubic\"\n\
             [[ramps]]\nparameter = \"w\"\nto = 0.5\nstart = \"{start}\"\nduration = 2\nform = \"linear\"\n"
        );
        let reached = 1.0 + 2.0 * cubic(0.25);
        for (at, value) in [
            (3.0, 1.0 + 2.0 * cubic(0.125)),
            (4.0, reached),
            (5.0, 0.5 * (reached + 0.5)),
            (6.0, 0.5),
            (20.0, 0.5),
        ] {
            near(end(&overlapping, &[&format!("--at={at}"), "--observe=w"])[6], value, 4e-15);
        }
        let report = with_file(&overlapping, &["derive", "system.toml"]).success();
        assert!(report.contains("from t = 2 to t = 10, stays from t = "), "{report}");
        let early = overlapping.replace("start = 2", "start = 9");
        for (at, value) in [(4.0, 1.0), (5.0, 0.75), (6.0, 0.5), (15.0, 0.5)] {
            near(end(&early, &[&format!("--at={at}"), "--observe=w"])[6], value, 4e-15);
        }
    }
    // two after each other: up and down again
    let twice = format!(
        "{plain}[[ramps]]\nparameter = \"w\"\nto = 3\nduration = 2\n[[ramps]]\nparameter = \"w\"\nto = 1.5\nstart = 4\nduration = 2\n"
    );
    for (at, value) in [("2", 3.0), ("4", 3.0), ("6", 1.5), ("9", 1.5)] {
        near(end(&twice, &[&format!("--at={at}"), "--observe=w"])[6], value, 1e-15);
    }
}

/// A ramp to 0 that begins before another one has come to its end leaves nothing of it, to the last bit.
#[test]
fn a_ramp_ends_exactly_where_it_leads() {
    let own = 0.1;
    for (first, start) in [(0.3, 3.0), (1.0 / 3.0, 7.0)] {
        for form in ["smooth", "linear"] {
            for to in [0.0, -1.1] {
                let file = format!(
                    "title = \"t\"\n[coordinates]\nx = {{ initial = 1 }}\n[parameters]\nk = {own}\n\
                     [lagrangian]\nL = \"1/2*x'^2 - 1/2*k^2*x^2\"\n\
                     [[ramps]]\nparameter = \"k\"\nto = {first}\nstart = 0.5\nduration = 10\nform = \"{form}\"\n\
                     [[ramps]]\nparameter = \"k\"\nto = {to:?}\nstart = {start}\nduration = 1.7\nform = \"{form}\"\n\
                     [[observables]]\nname = \"kk\"\nexpression = \"k\"\n"
                );
                let run = ["run", "system.toml", "--format=json", "--at=15"];
                let object = with_file(&file, &run).json();
                let columns = object["columns"].as_array().expect("columns");
                let place = columns.iter().position(|name| name == "kk").expect("k");
                let rows = object["rows"].as_array().expect("rows");
                let found = rows.last().unwrap()[place].as_f64().expect("a number");
                assert_eq!(
                    found.abs().to_bits(),
                    f64::abs(to).to_bits(),
                    "{own} {first} {start} {form} {to}: {found:e}"
                );
            }
        }
    }
}

/// A force that a ramp turns on moves a particle that has done no work before, and one whose mass t² it changes from
/// t = 1 to 2 has ẋ = 1/t² there.
#[test]
fn corners_of_ramps_are_no_singularities_to_any_adaptive_method() {
    let force = r#"
        title = "A force turned on"
        [coordinates]
        x = { initial = 0 }
        [parameters]
        k = 0
        [lagrangian]
        L = "1/2*x'^2 + k*x"
    "#;
    let mass = r#"
        title = "A mass that changes"
        [coordinates]
        x = { initial = 0, velocity = 1 }
        [parameters]
        k = 1
        [lagrangian]
        L = "1/2*k^2*x'^2"
    "#;
    for method in ["taylor", "dop853"] {
        let method = format!("--method={method}");
        let end = |file: &str, arguments: &[&str]| -> Vec<f64> {
            let done = with_file(file, &[&["run", "system.toml", &method], arguments].concat());
            assert_eq!(done.code, 0, "{}", done.stderr);
            assert!(!done.stderr.contains("lost"), "{}", done.stderr);
            let row = done.stdout.lines().last().expect("a row");
            row.split(',').map(|x| x.parse().expect("a number")).collect()
        };
        let row = end(force, &["--ramp=k=0:1:1:2:linear", "--at=4"]);
        near(row[1], 13.0 / 6.0, 1e-12);
        near(row[2], 2.0, 1e-12);
        let row = end(mass, &["--ramp=k=1:2:1:1:linear", "--at=3"]);
        near(row[1], 1.75, 1e-12);
    }
}

/// The mass 3 of a free particle goes to 0 by s(v) = v³ (10 − 15 v + 6 v²) or its relatives, with the time v to the end in parts of the
/// ramp: near the end it has the digits that the time has, and its momentum all of them.
#[test]
fn what_leads_to_zero_keeps_its_digits_to_its_end() {
    let file = |form: &str, before: &str| {
        format!(
            "title = \"t\"\n[coordinates]\nx = {{ initial = 0, velocity = 0.5 }}\n[parameters]\nm = 3.0\n\
             [lagrangian]\nL = \"1/2*m*x'^2\"\n{before}[[ramps]]\nparameter = \"m\"\nto = 0\nstart = 2\n\
             duration = 2\nform = \"{form}\"\n[[observables]]\nname = \"mass\"\nexpression = \"m\"\n"
        )
    };
    let earlier = "[[ramps]]\nparameter = \"m\"\nto = 6\nstart = 0.5\nduration = 1\n";
    for (form, share) in [
        ("smooth", (|v: f64| v.powi(3) * (10.0 - 15.0 * v + 6.0 * v * v)) as fn(f64) -> f64),
        ("cubic", |v| v * v * (3.0 - 2.0 * v)),
        ("linear", |v| v),
    ] {
        for (before, mass) in [("", 3.0), (earlier, 6.0)] {
            // a time is the decimal that is written
            for (left, at) in [(0.0078125, "--at=3.9921875"), (1e-6, "--at=3.999999")] {
                let text = file(form, before);
                let row = end(&text, &[at]);
                let wanted = mass * share(left / 2.0);
                // t, x, x', p_x, energy, mass
                near(row[5] / wanted, 1.0, 1e-14);
                near(row[2] * wanted / 1.5, 1.0, 1e-14);
                near(row[3] / 1.5, 1.0, 1e-14);
                let done = with_file(&text, &["run", "system.toml", "--strict", at]);
                assert_eq!((done.code, done.stderr.as_str()), (0, ""), "{form} {left}");
            }
        }
        // the option is the same function
        let text = file(form, "").replace("[[ramps]]", "[unused]");
        let text = text.split("[unused]").next().unwrap();
        let left = 2.0_f64.powi(-12);
        let (ramp, at) = (format!("--ramp=m=3:0:2:2:{form}"), format!("--at={}", 4.0 - left));
        let row = end(text, &[&ramp, &at, "--observe=mass=m"]);
        near(row[5] / (3.0 * share(left / 2.0)), 1.0, 1e-14);
    }
}
