//! `run`: its rows, columns and numbers.

use serde_json::Value;

use super::{Done, PENDULUM, phaselab, with_file};

/// Runs the pendulum started from the bottom.
fn run(arguments: &[&str]) -> Done {
    let mut all = vec!["run", "system.toml"];
    all.extend(arguments);
    with_file(PENDULUM, &all)
}

/// The rows of CSV without the header.
fn csv(text: &str) -> Vec<Vec<f64>> {
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    rows.map(|row| row.split(',').map(|x| x.parse().unwrap_or(f64::NAN)).collect()).collect()
}

fn rows(object: &Value) -> Vec<Vec<Option<f64>>> {
    let rows = object["rows"].as_array().expect("rows");
    let row = |row: &Value| row.as_array().expect("a row").iter().map(Value::as_f64).collect();
    rows.iter().map(row).collect()
}

#[test]
fn csv_says_what_was_run_and_names_its_columns() {
    let text = run(&["--until", "1"]).success();
    let head: Vec<&str> = text.lines().take(5).collect();
    let version = env!("CARGO_PKG_VERSION");
    assert_eq!(head[0], format!("# phaselab {version}: A pendulum"));
    assert_eq!(head[1], "# parameters: m=2.0 w=1.0");
    assert!(head[2].starts_with("# method: name=taylor"), "{}", head[2]);
    assert_eq!(head[3], "t,theta,theta',p_theta,energy");
    assert_eq!(head[4], "0.0,0.0,1.0,2.0,-1.0");
}

/// What a law proves needs few samples within a step; what only the file states is refuted by them alone.
#[test]
fn a_stated_invariant_is_sampled_often_enough_to_be_refuted() {
    let text = "title = \"Spike\"\n[coordinates]\nx = { initial = 1 }\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n\
                [[observables]]\nname = \"spike\"\n\
                expression = \"1/2*x'^2 + 1/2*x^2 + 1e-6*exp(-(x - 0.3)^2*1e6)\"\nconserved = true\n";
    let done = with_file(text, &["run", "system.toml", "--until", "50"]);
    assert!(done.stderr.contains("contradicted by the run"), "{}", done.stderr);
}

/// A number alone is not read as an expression, but is the same number.
#[test]
fn an_initial_value_is_the_same_as_a_number_and_in_parentheses() {
    let start = |value: &str| {
        let given = format!("theta={value}");
        run(&["--init", &given, "--at", "0"]).success()
    };
    let values =
        ["-0", ".5", "1.", "1E3", "-1e-5", "1e-400", "0.21938145353255928", "9007199254740993"];
    for value in values {
        assert_eq!(start(value), start(&format!("({value})")), "{value}");
    }
    let refused = run(&["--init", "theta=+1", "--at", "0"]);
    assert!(refused.text().contains("a plus sign needs something before it"));
}

#[test]
fn columns_are_in_their_order_and_extra_ones_last() {
    let file = r#"
        title = "Two"
        [coordinates]
        x = { initial = 1, velocity = 0.5 }
        phi = { initial = 0 }
        [lagrangian]
        L = "1/2*x'^2 + 1/2*(1 + x^2)*phi'^2 - x^2/2"
        [[observables]]
        name = "a, with a comma"
        expression = "x + phi"
    "#;
    let arguments = ["run", "system.toml", "--observe", "x*p_phi", "--observe", "acc = x''"];
    let object =
        with_file(file, &[&arguments[..], &["--at", "0", "--format", "json"]].concat()).json();
    let columns = serde_json::json!([
        "t",
        "x",
        "phi",
        "x'",
        "phi'",
        "p_x",
        "p_phi",
        "energy",
        "a, with a comma",
        "x*p_phi",
        "acc"
    ]);
    assert_eq!(object["columns"], columns);
    assert_eq!(rows(&object)[0][10], Some(-1.0));
    let text = with_file(file, &[&arguments[..], &["--at", "0"]].concat()).success();
    assert!(text.contains(",energy,\"a, with a comma\",x*p_phi,acc\n"), "{text}");
}

#[test]
fn a_hamiltonian_has_velocities_too() {
    let file = "title = \"T\"\n[coordinates]\nx = { initial = 1, momentum = 3 }\n\
                [hamiltonian]\nH = \"p_x^2/4 + x^2\"\n";
    let text = with_file(file, &["run", "system.toml", "--at", "0"]).success();
    assert!(text.ends_with("t,x,x',p_x,energy\n0.0,1.0,1.5,3.0,3.25\n"), "{text}");
}

#[test]
fn rows_are_at_the_times_asked_for() {
    let times = |arguments: &[&str]| -> Vec<f64> {
        csv(&run(arguments).success()).iter().map(|row| row[0]).collect()
    };
    assert_eq!(times(&["--at", "0.1,0.30000000000000004,7"]), [0.1, 0.300_000_000_000_000_04, 7.0]);
    assert_eq!(times(&["--at", "0, pi/2"]), [0.0, std::f64::consts::FRAC_PI_2]);
    assert_eq!(times(&["--until", "0.5", "--every", "0.1"]), [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]);
    assert_eq!(times(&["--until", "1", "--every", "0.4"]), [0.0, 0.4, 0.8]);
    assert_eq!(times(&["--until", "0"]), [0.0]);
    let even = times(&["--until", "3"]);
    assert_eq!((even.len(), even[0], even[1], even[200]), (201, 0.0, 0.015, 3.0));
    let long = times(&[]);
    assert_eq!((long.len(), long[200]), (201, 10.0));
}

#[test]
fn a_file_says_when_a_run_begins_and_ends() {
    let file = format!("{PENDULUM}\n[run]\nstart = -2.0\nuntil = 3.0\n");
    let text = with_file(&file, &["run", "system.toml", "--every", "2.5"]).success();
    let times: Vec<f64> = csv(&text).iter().map(|row| row[0]).collect();
    assert_eq!(times, [-2.0, 0.5, 3.0]);
    let text = with_file(&file, &["run", "system.toml", "--at", "-1,-0.5"]).success();
    assert_eq!(csv(&text).len(), 2);
    with_file(&file, &["run", "system.toml", "--at", "-3"]).fails(2, &["begins at -2", "-3"]);
}

#[test]
fn times_out_of_order_are_refused() {
    run(&["--at", "1,1"]).fails(2, &["--at", "1 follows 1"]);
    run(&["--at", "2,1"]).fails(2, &["1 follows 2"]);
    run(&["--at", "2", "--until", "1"]).fails(2, &["2 is after the end"]);
    run(&["--until", "-1"]).fails(2, &["begins at 0"]);
    run(&["--every", "0"]).fails(2, &["--every"]);
    run(&["--every", "-1"]).fails(2, &["--every"]);
    run(&["--at", "soon"]).fails(2, &["--at", "soon"]);
    run(&["--until", "1/0"]).fails(2, &["--until"]);
}

#[test]
fn parameters_are_set_by_name() {
    let object = run(&["--set", "m=3", "--set", "w=-0.5", "--at", "0", "--format", "json"]).json();
    assert_eq!(object["parameters"], serde_json::json!({ "m": 3.0, "w": -0.5 }));
    // the initial velocity is the parameter w
    assert_eq!(rows(&object)[0][2..4], [Some(-0.5), Some(-1.5)]);
    run(&["--set", "mm=3"]).fails(2, &["unknown parameter `mm`", "did you mean `m`?"]);
    run(&["--set", "m"]).fails(2, &["name=value"]);
    run(&["--set", "m=heavy"]).fails(2, &["m=heavy"]);
    run(&["--set", "m=inf"]).fails(2, &["finite"]);
}

#[test]
fn initial_values_are_set_by_name_and_momenta_solve_for_velocities() {
    let first = |arguments: &[&str]| -> Vec<f64> {
        let mut all = vec!["--at", "0"];
        all.extend(arguments);
        csv(&run(&all).success())[0][1..4].to_vec()
    };
    assert_eq!(first(&["--init", "theta=-1"]), [-1.0, 1.0, 2.0]);
    assert_eq!(first(&["--init", "theta=w/4"]), [0.25, 1.0, 2.0]);
    assert_eq!(first(&["--init", "theta'=-3"]), [0.0, -3.0, -6.0]);
    assert_eq!(first(&["--init", "p_theta=5"]), [0.0, 2.5, 5.0]);
    assert_eq!(
        first(&["--init", "p_theta=5", "--init", "theta=2", "--set", "m=4"]),
        [2.0, 1.25, 5.0]
    );
    // names as the screen shows them
    assert_eq!(first(&["--init", "θ′=-3"]), first(&["--init", "theta'=-3"]));
    assert_eq!(first(&["--init", "p_θ=5"]), first(&["--init", "p_theta=5"]));
    run(&["--init", "thta=1"]).fails(2, &["unknown initial value `thta`", "`theta`"]);
    run(&["--init", "theta'=1", "--init", "p_theta=1"]).fails(2, &["theta'", "p_theta"]);
    run(&["--init", "theta=x"]).fails(2, &["theta=x"]);
}

#[test]
fn a_velocity_in_a_hamiltonian_solves_for_the_momentum() {
    let file = "title = \"T\"\n[coordinates]\nx = { initial = 1, momentum = 3 }\n\
                y = { initial = 0, momentum = 1 }\n\
                [hamiltonian]\nH = \"sqrt(1 + p_x^2 + p_y^2) + x\"\n";
    let text = with_file(file, &["run", "system.toml", "--at", "0", "--init", "x'=0.6"]).success();
    let row = &csv(&text)[0];
    // p_y stays 1, and 0.6 = p_x/√(2 + p_x²)
    assert!((row[3] - 0.6).abs() < 1e-15 && (row[6] - 1.0).abs() < 1e-15, "{row:?}");
    assert!((row[5] - 0.6 * (2.0_f64 / 0.64).sqrt()).abs() < 1e-14, "{row:?}");
}

#[test]
fn json_holds_everything() {
    let object = run(&["--until", "20", "--format", "json"]).json();
    assert_eq!(object["phaselab"], env!("CARGO_PKG_VERSION"));
    assert_eq!(object["title"], "A pendulum");
    assert_eq!(object["method"]["name"], "taylor");
    assert_eq!(rows(&object).len(), 201);
    let energy = &object["invariants"][0];
    assert_eq!((&energy["name"], &energy["reason"]), (&"energy".into(), &"∂L/∂t = 0".into()));
    assert_eq!(energy["initial"].as_f64(), Some(-1.0));
    assert_eq!(energy["verdict"], "exact");
    assert!(energy["final"].as_f64().is_some_and(|x| (x + 1.0).abs() < 1e-14));
    assert!(energy["max_drift"].as_f64().is_some_and(|x| x < 1e-14));
    assert_eq!(object["events"], serde_json::json!([]));
    assert_eq!(object["status"], "completed");
    assert!(object["message"].is_null());
    let keys: Vec<&String> = object.as_object().expect("an object").keys().collect();
    let order = [
        "phaselab",
        "title",
        "parameters",
        "method",
        "columns",
        "rows",
        "invariants",
        "events",
        "status",
        "message",
    ];
    assert_eq!(keys, order);
}

/// A method of fixed step that chooses the step itself says which: given, it repeats the run to the last bit.
#[test]
fn the_step_in_use_is_in_the_head() {
    for method in ["yoshida8", "gauss4", "gauss6", "rk4"] {
        let with = |more: &[&str]| {
            let options = ["--until", "3", "--format", "json", "--method", method];
            run(&[&options, more].concat()).json()
        };
        let chosen = with(&[]);
        let step = chosen["method"]["step"].as_f64().expect("a step");
        assert!(step > 0.0 && step < 1.0, "{method}: {step}");
        assert_eq!(with(&["--step", &step.to_string()]), chosen, "{method}");
        assert_ne!(
            with(&["--step", &(0.9 * step).to_string()])["rows"],
            chosen["rows"],
            "{method}"
        );
        // one that is given is kept as it is
        assert_eq!(
            with(&["--step", "0.0123"])["method"]["step"].as_f64(),
            Some(0.0123),
            "{method}"
        );
    }
    let head = run(&["--until", "1", "--method", "rk4"]).success();
    assert!(!head.contains("step=null"), "{head}");
}

#[test]
fn json_lines_hold_the_same() {
    let whole = run(&["--until", "2", "--format", "json"]).json();
    let text = run(&["--until", "2", "--format", "jsonl"]).success();
    let lines: Vec<Value> =
        text.lines().map(|line| serde_json::from_str(line).expect("JSON on every line")).collect();
    assert_eq!(lines.len(), 203);
    for key in ["phaselab", "title", "parameters", "method", "columns"] {
        assert_eq!(lines[0][key], whole[key], "{key}");
    }
    assert_eq!(Value::Array(lines[1..202].to_vec()), whole["rows"]);
    for key in ["invariants", "events", "status", "message"] {
        assert_eq!(lines[202][key], whole[key], "{key}");
    }
}

#[test]
fn numbers_read_back_to_the_same_bits_in_every_format() {
    let arguments = ["--until", "3", "--every", "0.7"];
    let json = run(&[&arguments[..], &["--format", "json"]].concat()).json();
    let csv = csv(&run(&arguments).success());
    let json: Vec<Vec<f64>> =
        rows(&json).into_iter().map(|row| row.into_iter().flatten().collect()).collect();
    assert_eq!(json, csv);
}

/// Numbers without a short decimal form, in every format.
#[test]
fn a_number_read_back_has_the_bits_it_had() {
    let known = [2.0_f64.sqrt(), 1.0 / 3.0, 5e-324, f64::MAX, -1e-300 / 3.0];
    let written = ["a=sqrt(2)", "b=1/3", "c=5e-324", "d=1.7976931348623157e308", "e=-1e-300/3"];
    let mut arguments = vec!["--at", "0"];
    arguments.extend(written.iter().flat_map(|expression| ["--observe", expression]));
    let last = |row: &[f64]| row[row.len() - known.len()..].iter().map(|x| x.to_bits()).collect();
    let bits: Vec<u64> = known.iter().map(|x| x.to_bits()).collect();
    let given: Vec<u64> = last(&csv(&run(&arguments).success())[0]);
    assert_eq!(given, bits, "CSV");
    // the digits themselves are compared, because not all JSON readers are exact
    for format in ["json", "jsonl"] {
        let text = run(&[&arguments[..], &["--format", format]].concat()).success();
        let text: String = text.split_whitespace().collect();
        let rows = if format == "json" { "\"rows\":[[" } else { "}[" };
        let row = &text[text.find(rows).unwrap() + rows.len()..];
        let row = row[..row.find(']').unwrap()].split(',');
        let row: Vec<f64> = row.map(|digits| digits.parse().unwrap()).collect();
        let given: Vec<u64> = last(&row);
        assert_eq!(given, bits, "{format}");
    }
}

#[test]
fn what_is_not_finite_is_null_or_empty() {
    let observe = ["--at", "0,1", "--observe", "u=ln(theta)", "--observe", "v=1/theta"];
    let object = run(&[&observe[..], &["--format", "json"]].concat()).json();
    assert_eq!(rows(&object)[0][5..], [None, None]);
    assert!(rows(&object)[1][5..].iter().all(Option::is_some));
    let text = run(&observe).success();
    assert!(text.contains("0.0,0.0,1.0,2.0,-1.0,,\n"), "{text}");
}

#[test]
fn an_observable_that_cannot_be_read_is_shown_with_a_caret() {
    run(&["--observe", "thta + 1"]).fails(2, &["--observe:1:1", "^^^^", "did you mean `theta`?"]);
    run(&["--observe", "theta", "--observe", "energy=1"]).fails(2, &["two columns `theta`"]);
    run(&["--observe", "=1"]).fails(2, &["name"]);
}

#[test]
fn friction_breaks_the_energy_and_the_ledger_keeps_it() {
    let object =
        phaselab(&["run", "driven-damped-pendulum", "--format", "json", "--until", "20"]).json();
    let invariants = object["invariants"].as_array().expect("a list");
    let find = |name: &str| invariants.iter().find(|i| i["name"] == name).expect("a gauge");
    assert_eq!(find("energy")["verdict"], "not conserved");
    assert_eq!(find("energy balance")["verdict"], "exact");
}

#[test]
fn an_error_on_the_way_keeps_the_rows_before_it() {
    // reaches the centre at π/(2√2) = 1.1107…
    let file = "title = \"T\"\n[coordinates]\nx = { initial = 1 }\n[lagrangian]\n\
                L = \"1/2*x'^2 + 1/x\"\n";
    let run = |format: &str| {
        with_file(file, &["run", "system.toml", "--every", "0.5", "--format", format])
    };
    for format in ["csv", "json", "jsonl"] {
        let done = run(format);
        assert_eq!(done.code, 1, "{}", done.stderr);
        assert!(done.stderr.starts_with("phaselab: ") && done.stderr.contains("1.110"));
        assert!(done.stdout.contains("faulted"), "{}", done.stdout);
        assert!(done.stdout.lines().any(|line| line.contains("1.0,0.")), "{}", done.stdout);
    }
    let object: Value = serde_json::from_str(&run("json").stdout).expect("JSON");
    assert_eq!(object["status"], "faulted");
    assert_eq!(rows(&object).len(), 3);
    assert!(object["message"].as_str().is_some_and(|why| why.contains("1.110")), "{object}");
}

#[test]
fn a_motion_that_cannot_begin_is_an_error() {
    let file = "title = \"T\"\n[coordinates]\nx = { initial = 0 }\n[lagrangian]\n\
                L = \"1/2*x^2*x'^2 - x\"\n";
    let run = |arguments: &[&str]| {
        let all = [&["run", "system.toml", "--format", "json"], arguments].concat();
        let done = with_file(file, &all);
        assert_eq!(done.code, 1, "{}", done.stderr);
        let object: Value = serde_json::from_str(&done.stdout).expect("JSON");
        assert_eq!(object["status"], "faulted");
        (rows(&object).len(), done.stderr)
    };
    // there is a state at the start, but the motion cannot continue
    let (count, reported) = run(&[]);
    assert!(count == 1 && reported.contains("the mass matrix is singular at t = 0"), "{reported}");
    // there is not even an initial state
    let (count, reported) = run(&["--init", "p_x=1"]);
    assert!(count == 0 && reported.contains("singular"), "{reported}");
}

/// A particle that hits a wall at x = 2 at t = 2 and receives an impulse on its way.
const WALL: &str = r#"
title = "wall"
[coordinates]
x = { initial = 0.0, velocity = 1.0 }
[lagrangian]
L = "1/2*x'^2"
[[impulses]]
name = "push"
at = 1.0
change = { p_x = "-1/2" }
[[events]]
name = "wall"
when = "x - 2"
action = "stop"
"#;

#[test]
fn an_event_that_stops_ends_the_run_well_and_its_moment_still_has_a_row() {
    // to 1 by t = 1, then at half the speed: at 2 by t = 3
    for every in [["--every", "1"], ["--at", "0,1,2,3,4"], ["--every", "0.5"], ["--every", "0.7"]] {
        let arguments =
            ["run", "system.toml", "--until", "4", every[0], every[1], "--format", "json"];
        let arguments = if every[0] == "--at" {
            [&arguments[..2], &arguments[4..]].concat()
        } else {
            arguments.to_vec()
        };
        let object: Value = serde_json::from_str(&with_file(WALL, &arguments).success()).unwrap();
        let rows = rows(&object);
        let last = rows.last().expect("a row");
        assert_eq!((last[0], last[1]), (Some(3.0), Some(2.0)), "{every:?}");
        assert_eq!(object["status"], "stopped");
        let message = object["message"].as_str().expect("a sentence");
        assert!(message.contains("`wall` ended the motion at t = 3"), "{message}");
        let events = object["events"].as_array().expect("a list");
        let named: Vec<_> = events.iter().map(|e| (e["name"].as_str(), e["t"].as_f64())).collect();
        assert_eq!(named, [(Some("push"), Some(1.0)), (Some("wall"), Some(3.0))]);
        assert_eq!(events[0]["jump"]["p_x"], -0.5);
        assert!(events[1]["jump"].is_null(), "a stop is no impulse");
    }
}

#[test]
fn a_clock_that_cannot_tell_rows_or_steps_apart_is_refused_before_the_first_row() {
    for (arguments, why) in [
        (&["--until", "1e-320"][..], "closer than a motion can be followed"),
        (&["--until", "1.9e-278"], "closer than a motion can be followed"),
        (&["--until", "1e-320", "--every", "1"], "shorter than a motion can be followed"),
        (&["--until", "0.9e-280", "--every", "1"], "shorter than a motion can be followed"),
        (&["--init", "t=1e300"], "cannot tell t = 1e300 from 10 later"),
        (&["--init", "t=1e17"], "cannot tell rows"),
        (&["--every", "1e-300"], "cannot tell rows 1e-300 apart"),
        (&["--until", "1", "--every", "2e-16"], "cannot tell rows 2e-16 apart"),
        (&["--until", "1.7e38"], "cannot tell steps of"),
        (&["--until", "1e300", "--every", "1e299"], "cannot tell steps of"),
        (&["--method", "rk4", "--step", "1e-300"], "cannot tell steps of 1e-300 apart"),
        (
            &["--method", "leapfrog", "--until", "1", "--step", "2e-16"],
            "cannot tell steps of 2e-16",
        ),
        (&["--init", "t=-1.7e308", "--until", "1.7e308"], "farther than the clock reaches"),
    ] {
        run(arguments).fails(2, &["phaselab: ", why]);
    }
    // a first step that is shorter than the digits of the time is no collision
    let late = run(&["--init", "t=1e17", "--until", "1.0000000001e17"]);
    assert_eq!(late.code, 1);
    let why = "the clock cannot continue from t = 1e17: its digits are 16 apart there";
    assert!(late.stderr.contains(why), "{}", late.stderr);
    // the other side of each
    assert_eq!(csv(&run(&["--until", "2.1e-278"]).success()).len(), 201);
    assert_eq!(csv(&run(&["--until", "1.1e-280", "--every", "1"]).success()).len(), 1);
    assert_eq!(csv(&run(&["--init", "t=1e300", "--at", "1e300"]).success()).len(), 1);
    assert_eq!(csv(&run(&["--until", "1.4e-15", "--every", "2e-16"]).success()).len(), 8);
    let steps = ["--method", "rk4", "--until", "1e-13", "--step", "2e-16", "--at", "1e-13"];
    assert_eq!(csv(&run(&steps).success()).len(), 1);
    // a free particle takes a single step, whatever the time
    let free = "title = 'free'\n[coordinates]\nx = { initial = 0, velocity = 1 }\n\
                [lagrangian]\nL = \"1/2*x'^2\"\n";
    let far = with_file(free, &["run", "system.toml", "--at", "1e38"]).success();
    assert_eq!(csv(&far)[0][1], 1e38);
}

#[test]
fn which_constraints_repeat_others_is_judged_where_the_run_begins() {
    let file = r#"
        title = "a slope that is none"
        [coordinates]
        k = { initial = 1, velocity = 0 }
        y = { initial = 0, velocity = 0 }
        z = { initial = 0, velocity = 0 }
        [lagrangian]
        L = "1/2*(k'^2 + y'^2 + z'^2) + y"
        [[constraints]]
        name = "level"
        expression = "z'"
        [[constraints]]
        name = "slope"
        expression = "z' + k*y'"
    "#;
    let at = |init: &str| {
        let done = with_file(file, &["run", "system.toml", "--init", init, "--at", "2"]);
        (csv(&done.stdout)[0][2], done.stderr.contains("`slope` depends"))
    };
    assert_eq!((at("k=1"), at("k=0")), ((0.0, false), (2.0, true)));
}

#[test]
fn a_run_tells_of_the_singular_configurations_it_passed() {
    let file = r#"
        title = "crossing lines"
        [coordinates]
        x = { initial = -1, velocity = 1 }
        y = { initial = -1 }
        [lagrangian]
        L = "1/2*(x'^2 + y'^2)"
        [[constraints]]
        name = "lines"
        expression = "x^2 - y^2"
    "#;
    let reported = |until: &str| with_file(file, &["run", "system.toml", "--until", until]).stderr;
    assert_eq!(reported("0.9"), "");
    let passed = reported("3");
    assert!(
        passed.contains("passed a singular configuration of the constraints at t = 1"),
        "{passed}"
    );
}
/// Finds the one line that reports a lost quantity, and checks its words; other lines may explain why.
fn reported(done: &Done, words: &[&str]) {
    let mut lines = done.stderr.lines().filter(|line| line.contains("of what moves"));
    let line = lines.next().unwrap_or_default();
    assert_eq!(lines.next(), None, "{}", done.stderr);
    for word in words {
        assert!(line.contains(word), "no `{word}` in: {}", done.stderr);
    }
}

#[test]
fn an_invariant_that_is_lost_is_reported_in_one_line() {
    let coarse = ["--method", "leapfrog", "--step", "2.5", "--until", "100"];
    let done = run(&coarse);
    assert_eq!(done.code, 0, "{}", done.stderr);
    reported(&done, &["`energy` is lost", "of what moves since t = ", "--step below 2.5"]);
    assert_eq!(csv(&done.stdout).len(), 201);
    let strict = run(&[&coarse[..], &["--strict"]].concat());
    assert_eq!(strict.code, 1, "{}", strict.stderr);
    assert_eq!(
        (strict.stderr.as_str(), strict.stdout.as_str()),
        (done.stderr.as_str(), done.stdout.as_str())
    );
}

#[test]
fn a_symplectic_swing_is_reported_as_what_it_is() {
    let done = run(&["--method", "leapfrog", "--step", "0.1", "--until", "60", "--strict"]);
    assert_eq!(done.code, 1, "{}", done.stderr);
    reported(&done, &["`energy` oscillates without trend, by "]);
    let fine = run(&["--method", "yoshida8", "--step", "0.05", "--until", "60", "--strict"]);
    assert_eq!((fine.code, fine.stderr.as_str()), (0, ""));
}

/// An atom in a lattice, a metre from the origin: its energy is off by 2e-6 of what moves, and from the origin it is not.
#[test]
fn an_energy_changed_by_rounding_of_the_place_is_reported() {
    for (x, code) in [("1.0", 1), ("1e-10", 0)] {
        let text = format!(
            "title = \"Lattice\"\n[coordinates]\nx = {{ initial = {x}, velocity = 100.0 }}\n[lagrangian]\n\
             L = \"1/2*1e-26*x'^2 - 1e-20*cos(1e10*x)\"\n"
        );
        let done = with_file(&text, &["run", "system.toml", "--at", "0,1e-11", "--strict"]);
        assert_eq!(done.code, code, "{}", done.stderr);
        if code == 1 {
            reported(&done, &["`energy` departs from its value by ", "as rounding of x explains"]);
            assert!(!done.stderr.contains("singular"), "{}", done.stderr);
        }
    }
}

#[test]
fn a_run_by_the_default_method_is_strict() {
    run(&["--strict", "--until", "50"]).success();
    phaselab(&["run", "damped-pendulum", "--strict"]).success();
}

/// Friction −1/v brings a body from v = 1 to rest at t = ½, v² = 1 − 2t, where it has no value: what equal steps compute behind it is no
/// motion.
#[test]
fn equal_steps_over_the_end_of_a_motion_are_an_error() {
    let file = "title = 'pole'\n[coordinates]\nx = { initial = 1, velocity = 1 }\n\
                [lagrangian]\nL = \"1/2*x'^2\"\nforces = { x = \"-1/x'\" }\n";
    let with = |until: &str| {
        let fixed = ["--method", "rk4", "--step", "0.01", "--until", until];
        with_file(file, &[&["run", "system.toml"][..], &fixed].concat())
    };
    let past = with("2");
    assert_eq!(past.code, 1, "{}", past.stderr);
    assert!(past.stderr.contains("rk4 has stepped past the end of the motion"), "{}", past.stderr);
    assert!(past.stderr.contains("t = 0.5"), "{}", past.stderr);
    assert_eq!(csv(&past.stdout).len(), 201);
    assert_eq!((with("0.4").code, with("0.4").stderr.as_str()), (0, ""));
}

/// V = −|tan x| has poles at ±π/2, which the motion reaches at t = 0.4: the steps of `dop853`, chosen by their error, go over them too.
#[test]
fn adaptive_steps_over_the_end_of_a_motion_are_an_error() {
    let file = |law: &str| {
        format!(
            "title = 'pole'\n[coordinates]\nx = {{ initial = 1, velocity = 0.2 }}\n[lagrangian]\nL = \"{law}\"\n"
        )
    };
    for (law, tolerance) in [
        ("1/2*x'^2 + abs(tan(x))", "1e-4"),
        ("1/2*x'^2 + abs(tan(x))", "1e-11"),
        ("1/2*x'^2 + 1/abs(x)", "1e-4"),
        ("1/2*x'^2 - ln(abs(x))", "1e-5"),
    ] {
        let adaptive =
            ["run", "system.toml", "--method", "dop853", "--tolerance", tolerance, "--at", "5.3"];
        let past = with_file(&file(law), &adaptive);
        assert_eq!(past.code, 1, "{law}: {}", past.stderr);
    }
    // through a smooth well as narrow as this one the motion goes on
    let through = with_file(
        &file("1/2*x'^2 + 1/sqrt(x^2 + 1e-4)"),
        &["run", "system.toml", "--method", "dop853", "--at", "5.3"],
    );
    assert_eq!(through.code, 0, "{}", through.stderr);
}

/// The poles of friction at which energy is not lost by much: a force of 10 leads on, or the pole is weak. A larger force
/// or friction without a pole ends nothing, and no shorter step is recommended where there is no motion.
#[test]
fn equal_steps_over_a_weak_pole_of_friction_are_an_error() {
    let file = |law: &str, force: &str| {
        format!(
            "title = 'pole'\n[coordinates]\nx = {{ initial = 1, velocity = 1 }}\n\
             [lagrangian]\nL = \"{law}\"\nforces = {{ x = \"{force}\" }}\n"
        )
    };
    // x'' = −10 − 1/x' ends where x' = 0: t = ∫₀¹ v dv/(10 v + 1) = 1/10 − ln(11)/100 = 0.0760210;
    // v = 1 + 0.02 ln(1 − (x − 1)/0.37) … has no bound below at x = 1.37, and stops where v = 0, beside it
    let poles = [
        (file("1/2*x'^2 - 10*x", "-1/x'"), "t = 0.0760210"),
        (file("1/2*x'^2", "-0.02*x'/(x - 1.37)"), "t = 0.36287"),
    ];
    for (text, end) in &poles {
        for step in ["0.01", "0.1", "0.3"] {
            let fixed = ["run", "system.toml", "--method", "rk4", "--step", step, "--until", "20"];
            let past = with_file(text, &fixed);
            assert_eq!(past.code, 1, "{}", past.stderr);
            assert!(
                past.stderr.contains("has stepped past the end of the motion"),
                "{}",
                past.stderr
            );
            assert!(past.stderr.contains(end), "{}", past.stderr);
            assert!(!past.stderr.contains("--step below"), "{}", past.stderr);
        }
    }
    let drifting = file("1/2*x'^2 - 1/2*x^2", "-0.02*x'/(2 + x)");
    let fixed = ["run", "system.toml", "--method", "rk4", "--step", "0.3", "--until", "20"];
    let whole = with_file(&drifting, &fixed);
    assert_eq!(whole.code, 0, "{}", whole.stderr);
    assert!(whole.stderr.contains("try a --step below 0.3"), "{}", whole.stderr);
}

/// An event that ends the motion exactly at the end of the run leaves its state as the last row, as a moment earlier; so has
/// one whose impulse acts there.
#[test]
fn what_happens_exactly_at_the_end_of_a_run_has_its_row() {
    let file = "title = 'wall'\n[coordinates]\nx = { initial = 0, velocity = 1 }\n\
                [lagrangian]\nL = \"1/2*x'^2\"\n[[impulses]]\nname = 'turn'\nchange = { p_x = \"-2*x'\" }\n\
                [[events]]\nname = 'wall'\nwhen = 'x - 0.55'\naction = 'stop'\n";
    for until in ["0.55", "0.6"] {
        let run = ["run", "system.toml", "--until", until, "--every", "0.5"];
        let ended = with_file(file, &run);
        let rows = csv(&ended.stdout);
        assert_eq!(rows.len(), 3, "{}", ended.stdout);
        assert_eq!(rows[2][..2], [0.55, 0.55]);
    }
    let bounce = file.replace("'stop'", "'impulse:turn'");
    let run = ["run", "system.toml", "--until", "0.55", "--every", "0.55", "--format", "json"];
    let read: serde_json::Value =
        serde_json::from_str(&with_file(&bounce, &run).stdout).expect("JSON");
    assert_eq!(read["events"].as_array().map(Vec::len), Some(1));
    assert_eq!(read["rows"][1].as_array().map(|row| row[2].clone()), Some((-1.0).into()));
}

/// An impulse at t = 1 leads to where the law has no value. A run that ends there is complete, with the state after it; one that is to
/// continue ends with an error at that time.
#[test]
fn a_motion_that_an_impulse_leads_out_of_its_law_ends_there() {
    let file = "title = 'kick'\n[coordinates]\nx = { initial = 0, velocity = 1 }\n\
                [lagrangian]\nL = \"1/2*x'^2\"\nforces = { x = \"sqrt(4 - x'^2)/1e9\" }\n\
                [[impulses]]\nname = 'kick'\nat = 1.0\nchange = { p_x = \"2\" }\n";
    for method in ["taylor", "dop853", "rk4"] {
        let run = |until: &str| {
            let options = ["--until", until, "--every", "0.5", "--method", method];
            let step = if method == "rk4" { &["--step", "0.25"][..] } else { &[] };
            with_file(file, &[&["run", "system.toml"], &options[..], step].concat())
        };
        let there = run("1");
        assert_eq!(there.code, 0, "{method}: {}", there.stderr);
        let last = csv(&there.stdout).pop().expect("a row");
        assert!((last[2] - 3.0).abs() < 1e-8, "{method}: {last:?}");
        let beyond = run("2");
        assert_eq!(beyond.code, 1, "{method}: {}", beyond.stderr);
        assert!(beyond.stderr.contains("t = 1"), "{method}: {}", beyond.stderr);
    }
}

/// A ball whose bounce leaves it at rest on the floor falls on: that is said. One that bounces, a push or a brake on the way and a
/// ball that a ceiling stops are nothing to speak of.
#[test]
fn an_impulse_that_turns_nothing_back_is_reported() {
    let file = |start: f64, velocity: f64, direction: &str, change: &str| {
        format!(
            "title = 'ball'\n[coordinates]\ny = {{ initial = {start}, velocity = {velocity} }}\n\
             [lagrangian]\nL = \"1/2*y'^2 - 9.81*y\"\n[[impulses]]\nname = \"bounce\"\n\
             change = {{ p_y = \"{change}\" }}\n[[events]]\nname = \"floor\"\nwhen = \"y\"\n\
             direction = \"{direction}\"\naction = \"impulse:bounce\"\n"
        )
    };
    let reported = |text: &str, method: &str| {
        let done = with_file(text, &["run", "system.toml", "--until", "0.6", "--method", method]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        done.stderr
    };
    // √(2/9.81) = 0.4515236
    let words = "the impulse of `floor` at t = 0.4515 ";
    for method in ["taylor", "rk4"] {
        let said = reported(&file(1.0, 0.0, "falling", "-y'"), method);
        assert!(said.contains(words) && said.contains("not turn the motion back"), "{said}");
    }
    let quiet = [
        file(1.0, 0.0, "falling", "-0.5*y'"),
        file(1.0, 0.0, "falling", "-1.5*y'"),
        file(1.0, 0.0, "falling", "-2*y'"),
        file(1.0, 0.0, "falling", "y'"),
        file(-0.1, 3.0, "rising", "-y'"),
    ];
    for text in &quiet {
        assert_eq!(reported(text, "taylor"), "");
    }
}

#[test]
fn looks_at_steps_stay_on_the_branch_of_the_velocity() {
    // p = v³ − v has three velocities for small p
    let file = "title = 'three velocities'\n[coordinates]\nx = { initial = 0.3, velocity = 1.1 }\n\
                [lagrangian]\nL = \"1/4*x'^4 - 1/2*x'^2 - 1/2*x^2\"\n";
    for method in ["gauss4", "gauss6"] {
        let done = with_file(file, &["run", "system.toml", "--method", method, "--until", "0.5"]);
        assert_eq!((done.code, done.stderr.as_str()), (0, ""), "{method}");
    }
}

/// The drift of an energy does not depend on a constant added to the potential.
#[test]
fn a_constant_in_the_potential_hides_no_drift() {
    let drift = |constant: &str| {
        let file = format!(
            "title = \"T\"\n[coordinates]\ntheta = {{ initial = 2.0 }}\n\
             [lagrangian]\nL = \"1/2*theta'^2 + 9.81*cos(theta){constant}\"\n"
        );
        let arguments = [
            "run",
            "system.toml",
            "--method",
            "leapfrog",
            "--step",
            "0.05",
            "--until",
            "20",
            "--format",
            "json",
        ];
        let done = with_file(&file, &arguments);
        reported(&done, &["`energy` oscillates without trend"]);
        let object: Value = serde_json::from_str(&done.stdout).expect("JSON");
        assert_eq!(object["invariants"][0]["verdict"], "bounded");
        object["invariants"][0]["max_drift"].as_f64().expect("a number")
    };
    let (without, with) = (drift(""), drift(" - 1e6"));
    assert!((with / without - 1.0).abs() < 1e-5, "{with:e} and {without:e}");
}

#[test]
fn a_method_that_passes_over_kinks_says_which_one_does_not() {
    let kinked = r#"
        title = "A well with a kink"
        [coordinates]
        x = { initial = 1 }
        [lagrangian]
        L = "1/2*x'^2 - abs(x)"
    "#;
    let run = |method: &str| {
        let arguments = ["run", "system.toml", "--until", "1", "--at", "1", "--method", method];
        with_file(kinked, &arguments)
    };
    let done = run("dop853");
    let line = "phaselab: dop853 steps over the kinks of this motion and loses accuracy there; \
                taylor locates them\n";
    assert_eq!((done.code, done.stderr.as_str()), (0, line));
    run("taylor").success();
}

/// Which constraints repeat others is found where this run begins: at z = 0 the second does, and at z = 1 it holds x = 1.
#[test]
fn redundant_constraints_are_those_of_the_start_of_this_run() {
    let text = "title = \"Two\"\n[coordinates]\nx = { initial = 1 }\ny = { initial = 1 }\nz = { initial = 0 }\n[lagrangian]\n\
                L = \"1/2*(x'^2 + y'^2 + z'^2) + x + y\"\n[[constraints]]\nname = \"one\"\nexpression = \"y - x\"\n\
                [[constraints]]\nname = \"other\"\nexpression = \"y - x + z*(x + y - 2)\"\n";
    let arguments = [
        "run",
        "system.toml",
        "--init",
        "z=1",
        "--init",
        "z'=0",
        "--until",
        "1",
        "--at",
        "1",
        "--format",
        "json",
    ];
    let rows = &with_file(text, &arguments).json()["rows"];
    assert_eq!(rows[0][1], 1.0, "{rows}");
}

#[test]
fn a_start_of_several_motions_is_reported_with_the_one_that_is_followed() {
    let text = |potential: &str| {
        format!(
            "title = \"Rest\"\n[coordinates]\nx = {{ initial = 0 }}\n[lagrangian]\nL = \"1/2*x'^2 - ({potential})\"\n"
        )
    };
    for (potential, said) in [
        ("-abs(x)", "the one followed here leaves at once to larger x"),
        ("-abs(x)^1.5", "the one followed here stays at rest"),
    ] {
        for arguments in [&["check", "system.toml"][..], &["run", "system.toml", "--until", "1"]] {
            let done = with_file(&text(potential), arguments);
            assert_eq!(done.code, 0, "{}", done.stderr);
            for words in ["the motion from rest at x = 0 is not unique", said] {
                assert!(
                    done.stderr.replace('\n', " ").contains(words),
                    "{potential}: {}",
                    done.stderr
                );
            }
        }
    }
    let done = with_file(&text("-x^2"), &["check", "system.toml"]);
    assert!(!done.stderr.contains("not unique"), "{}", done.stderr);
}

/// An angle that is folded back has a kink that no switch shows.
#[test]
fn kinks_of_folded_angles_are_reported() {
    for (angle, reported) in
        [("acos(cos(x))", true), ("asin(sin(2*x))", true), ("asin(x/9)", false)]
    {
        let text = format!(
            "title = \"Folded\"\n[coordinates]\nx = {{ initial = 1 }}\n[lagrangian]\nL = \"1/2*x'^2 - {angle}\"\n"
        );
        for method in ["dop853", "gauss6"] {
            let arguments = ["run", "system.toml", "--until", "1", "--at", "1", "--method", method];
            let done = with_file(&text, &arguments);
            assert_eq!(done.code, 0, "{}", done.stderr);
            let said = format!("{method} steps over the kinks of this motion");
            assert_eq!(done.stderr.contains(&said), reported, "{angle} {method}: {}", done.stderr);
        }
    }
}

/// At the cut of an angle nothing is kinked that is the same one turn on.
#[test]
fn the_cut_of_an_angle_is_a_kink_where_the_law_shows_it() {
    for (potential, reported) in [
        ("cos(3*atan2(y,x))", false),
        ("(x^2 + y^2)*sin(atan2(2*y,x - 3))^2", false),
        ("cos(atan2(y,x)/2)", true),
        ("atan2(y,x)^2", true),
        ("cos(2.5*atan2(y,x))", true),
    ] {
        let text = format!(
            "title = \"Cut\"\n[coordinates]\nx = {{ initial = 1 }}\ny = {{ initial = 1 }}\n[lagrangian]\n\
             L = \"1/2*(x'^2 + y'^2) - {potential}\"\n"
        );
        let arguments = ["run", "system.toml", "--until", "0.1", "--method", "dop853"];
        let said = with_file(&text, &arguments).stderr;
        assert_eq!(said.contains("steps over the kinks"), reported, "{potential}: {said}");
    }
}

/// A force that changes smoothly has no kink where it begins or ends to change. What else the law has is none of its concern.
#[test]
fn a_smooth_ramp_is_no_kink() {
    let reported = |law: &str, ramps: &[&str], option: Option<&str>| {
        let mut text = format!(
            "title = \"A swing\"\n[coordinates]\nx = {{ initial = 1 }}\n[parameters]\ng = 1.0\nh = 1.0\n\
             [lagrangian]\nL = \"1/2*x'^2 - {law}\"\n"
        );
        for ramp in ramps {
            text.push_str(&format!("[[ramps]]\n{ramp}\n"));
        }
        let mut arguments = vec!["run", "system.toml", "--until", "3", "--at", "3"];
        arguments.extend(["--method", "leapfrog", "--step", "0.01"]);
        arguments.extend(option.iter().flat_map(|ramp| ["--ramp", ramp]));
        let done = with_file(&text, &arguments);
        assert_eq!(done.code, 0, "{}", done.stderr);
        done.stderr.contains("steps over the kinks of this motion")
    };
    let part = |name: &str, to: f64, start: f64, form: &str| {
        format!(
            "parameter = \"{name}\"\nto = {to}\nstart = {start}\nduration = 1\nform = \"{form}\""
        )
    };
    let smooth = &part("g", 2.0, 1.0, "smooth")[..];
    let later = part("g", 3.0, 2.0, "smooth");
    let sooner = part("g", 3.0, 1.5, "smooth");
    let linear = part("g", 2.0, 1.0, "linear");
    let other = part("h", 2.0, 1.0, "linear");
    let law = "1/2*(g + h)*x^2";
    assert!(!reported(law, &[smooth], None));
    assert!(!reported(law, &[smooth, &later], None));
    assert!(!reported("1/2*max(h, 2)*g*x^2", &[smooth], None), "a number");
    assert!(!reported(law, &[], Some("g=1:2:0:2")));
    assert!(
        !reported("x*atan2(x, 1) + x*atan2(x^2, g)", &[], None),
        "the cut is where the second is negative"
    );
    assert!(reported("x*atan2(x, x - 3)", &[], None));
    assert!(reported("x*atan2(x, -g)", &[], None));
    assert!(reported("abs(x)", &[], None));
    assert!(reported("g*abs(x)", &[smooth], None));
    assert!(reported("g*abs(x)", &[], Some("g=1:2:0:2")));
    assert!(reported("1/2*(g + max(t - 1, 0))*x^2", &[smooth], None), "the same switch");
    assert!(reported(law, &[&linear], None));
    assert!(reported(law, &[], Some("g=1:2:0:2:linear")));
    assert!(reported(law, &[smooth, &other], None), "at the same times");
    assert!(reported(law, &[smooth, &sooner], None), "stopped half-way");
}

/// With E = 0.2 a particle would be thrown back by a step of 0.6 that is a slope; of −0.3 sign x no derivative shows the force.
#[test]
fn a_step_of_the_law_is_reported() {
    let law = |potential: &str| {
        let text = format!(
            "title = \"A step\"\n[coordinates]\nx = {{ initial = -1.0, velocity = 1.0 }}\n\
             [lagrangian]\nL = \"1/2*x'^2 - {potential}\"\n"
        );
        with_file(&text, &["run", "system.toml", "--until", "4", "--at", "4"])
    };
    let done = law("0.3*sign(x)");
    assert!(done.code == 0 && done.stderr.contains("phaselab: L has a step"), "{}", done.stderr);
    let slope = law("0.3*tanh(50*x)");
    assert_eq!((slope.code, slope.stderr.as_str()), (0, ""));
    let x: f64 = slope.stdout.lines().last().unwrap().split(',').nth(1).unwrap().parse().unwrap();
    assert!(x < -1.0, "thrown back: {x}");
    // a step in time makes no impulse where a force jumps, but velocities jump where the mass does
    let plain = law("0.5*(1 + 0.5*sign(sin(3*t)))*x^2");
    assert_eq!((plain.code, plain.stderr.as_str()), (0, ""));
    let mass = law("0 + 1/2*max(0, sign(t - 2))*x'^2");
    assert!(
        mass.stderr.contains("phaselab: L has a step in time in its momenta"),
        "{}",
        mass.stderr
    );
    // |x| has a kink and no step
    law("abs(x)").success();
}

/// Where V jumps at a time the energy jumps with it, by as much as the motion makes it: the motion is right, and no balance is lost.
/// From t = 2 on x = ½·s·t + A cos t + B sin t with s = sign(t − 2), here at t = 5.
#[test]
fn the_energy_jumps_with_the_law_at_a_time_and_no_balance_is_lost() {
    let run = |drive: &str, until: &str| {
        let text = format!(
            "title = \"A step\"\n[coordinates]\nx = {{ initial = 1.0, velocity = 0.2 }}\n\
             [lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2 + x*{drive}\"\n"
        );
        with_file(&text, &["run", "system.toml", "--strict", "--until", until, "--at", until])
    };
    let done = run("0.5*t*sign(t - 2)", "5");
    assert_eq!((done.code, done.stderr.as_str()), (0, ""));
    let x: f64 = done.stdout.lines().last().unwrap().split(',').nth(1).unwrap().parse().unwrap();
    let (mut at, mut rate) = (1.0_f64, 0.2_f64);
    for (from, until, slope) in [(0.0, 2.0, -0.5), (2.0, 5.0, 0.5)] {
        let (sin, cos) = f64::sin_cos(until - from);
        let (a, b) = (at - slope * from, rate - slope);
        (at, rate) = (slope * until + a * cos + b * sin, slope - a * sin + b * cos);
    }
    assert!((x - at).abs() < 1e-12, "{x} {at}");
    for drive in [
        "sign(t - 2)*sqrt(abs(t - 2))",
        "sign(t - 2)*exp(-1/(t - 2)^2)",
        "max(0, sign(sin(40*t)))",
        "sin(t)*sign(sin(3*t))",
        "(max(0, t - 1) + sign(t - 2))",
        "acos(cos(t))*sign(sin(t))",
        "atan(tan(2*t))",
        "atan2(sin(t), cos(t))",
        "t*atan(1/(t - 2))",
        "(cos(t)^2)^0.5/cos(t)",
    ] {
        let done = run(drive, "8");
        assert_eq!((done.code, done.stderr.as_str()), (0, ""), "{drive}");
    }
    // where the instants can be located the energy is balanced across them
    for (located, drive) in [
        (true, "0.5*t*sign(t - 2)"),
        (true, "sin(t)*sign(sin(3*t))"),
        (true, "(max(0, t - 1) + sign(t - 2))"),
        (true, "max(0, sign(sin(40*t)))"),
        (false, "(cos(t)^2)^0.5/cos(t)"),
        (false, "sign(t - 2)*sqrt(abs(t - 2))"),
        (false, "sign(t - 2)*exp(-1/(t - 2)^2)"),
        (false, "sign(max(0, t - 2))"),
        (false, "atan(tan(2*t))"),
        (false, "t*atan(1/(t - 2))"),
    ] {
        let text = format!(
            "title = \"A step\"\n[coordinates]\nx = {{ initial = 1.0, velocity = 0.2 }}\n\
             [lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2 + x*{drive}\"\n"
        );
        let words = ["run", "system.toml", "--until", "8", "--format", "json"];
        let read = with_file(&text, &words).json();
        let invariants = read["invariants"].as_array().unwrap();
        let balance = invariants.iter().find(|gauge| gauge["name"] == "energy balance");
        assert_eq!(balance.is_some(), located, "{drive}: {invariants:?}");
        let verdict = balance.map_or("exact", |gauge| gauge["verdict"].as_str().unwrap());
        assert_eq!(verdict, "exact", "{drive}: {balance:?}");
    }
    // a force that does work without a step has its balance
    let text = "title = \"Driven\"\n[coordinates]\nx = { initial = 1.0 }\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2 + x*max(0, t - 2)\"\n";
    let told =
        with_file(text, &["run", "system.toml", "--until", "8", "--format", "json"]).success();
    assert!(told.contains("energy balance"), "{told}");
}

/// An angle jumps by 2π at its cut, y = 0 and x < 0, and with it a law that is no function on the circle.
#[test]
fn a_law_that_jumps_at_the_cut_of_an_angle_is_reported() {
    let law = |potential: &str| {
        let text = format!(
            "title = \"A cut\"\n[coordinates]\nx = {{ initial = -1.0 }}\ny = {{ initial = 0.5, velocity = -3.0 }}\n\
             [parameters]\nk = 2\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2) - {potential}\"\n"
        );
        with_file(&text, &["run", "system.toml", "--until", "1", "--at", "1"])
    };
    for jumping in ["atan2(y, x)", "k*atan2(2*y, 2*x + 1)^3", "sin(atan2(y, x)/2)", "atan2(y, -1)"]
    {
        let done = law(jumping);
        let reported = done.stderr.contains("phaselab: L jumps at the cut of atan2(");
        assert!(done.code == 0 && reported && !done.stderr.contains("lost"), "{}", done.stderr);
    }
    // beside an angle of the time alone, which has no impulse, in either order
    for both in ["x*atan2(sin(t), cos(t)) + atan2(y, x)", "atan2(y, x) + x*atan2(sin(t), cos(t))"] {
        let done = law(both);
        assert!(done.stderr.contains("L jumps at the cut of atan2(y, x)"), "{}", done.stderr);
    }
    for continuous in [
        "atan2(y, x)^2/10",
        "sin(3*atan2(y, x))",
        "abs(atan2(y, x))",
        "y*atan2(y, x)",
        "atan2(y, 1)",
        "atan2(y, k)",
        "atan2(y, 1 + x^2)",
        "atan2(abs(y), x)",
    ] {
        let done = law(continuous);
        assert_eq!((done.code, done.stderr.as_str()), (0, ""), "{continuous}");
    }
}

/// cosh t overflows at t = 710.5, far from all singularities.
#[test]
fn what_grows_beyond_the_range_of_numbers_is_not_called_a_collision() {
    let growing = r#"
        title = "Upside down"
        [coordinates]
        x = { initial = 1 }
        [lagrangian]
        L = "1/2*x'^2 + 1/2*x^2"
    "#;
    for method in [&["taylor"][..], &["dop853"], &["rk4", "--step=0.1"]] {
        let until = ["run", "system.toml", "--until=1000", "--method"];
        let done = with_file(growing, &[&until[..], method].concat());
        assert_eq!(done.code, 1);
        let said = "x grows beyond the range of numbers, 1.8e308, after t = 7";
        assert!(done.stderr.contains(said), "{}", done.stderr);
    }
}

/// Dry friction of 0.8 holds an oscillator that comes to rest within |x| ≤ 0.8, and carries it on a belt of velocity 0.3 until the
/// spring exceeds it at x = 0.8. Equal steps that are not solved there say which method passes.
#[test]
fn what_sticks_is_held_or_said_to_stick() {
    let friction = r#"
        title = "Dry friction"
        [coordinates]
        x = { initial = 1, velocity = 1 }
        [lagrangian]
        L = "1/2*x'^2 - 1/2*x^2"
        forces = { x = "-0.8*sign(x')" }
    "#;
    let belt = friction.replace("= 1", "= 0").replace("sign(x')", "sign(x' - 0.3)");
    for file in [friction, &belt] {
        let run = |method: &str| {
            let done = with_file(file, &["run", "system.toml", "--at=1,5,12", "--method", method]);
            assert_eq!(done.code, 0, "{}", done.stderr);
            assert!(!done.stderr.contains("lost"), "{}", done.stderr);
            let rows = done.stdout.lines().filter(|line| !line.starts_with(['#', 't']));
            let numbers = rows.flat_map(|row| row.split(',').map(|x| x.parse::<f64>().unwrap()));
            numbers.collect::<Vec<f64>>()
        };
        let (expected, found) = (run("taylor"), run("dop853"));
        for (a, b) in expected.iter().zip(&found) {
            assert!((a - b).abs() < 1e-10, "{expected:?} {found:?}");
        }
    }
    let stopped = with_file(&belt, &["run", "system.toml", "--at=5", "--method=gauss4"]);
    assert!(stopped.code == 1 && stopped.stderr.contains("taylor passes it"), "{}", stopped.stderr);
}

#[test]
fn a_step_beyond_what_is_stable_is_reported() {
    // small oscillations of frequency 1: the leapfrog's limit is 2
    let run = |step: &str| run(&["--until", "20", "--method", "leapfrog", "--step", step]);
    let done = run("2.5");
    assert_eq!(done.code, 0);
    assert!(done.stderr.contains("leapfrog is not stable with the step 2.5"), "{}", done.stderr);
    let done = run("1.5");
    assert_eq!(done.code, 0);
    assert!(!done.stderr.contains("not stable"), "{}", done.stderr);
}

#[test]
fn an_accuracy_may_be_asked_for_by_name() {
    let rows = |tolerance: &str| csv(&run(&["--until", "3", "--tolerance", tolerance]).success());
    assert_eq!(rows("fast"), rows("1e-15"));
    assert_eq!(rows("exact"), rows("1e-18"));
    assert_ne!(rows("fast"), rows("exact"), "they are two");
    let refused = run(&["--tolerance", "quick"]);
    assert_eq!(refused.code, 2);
    assert!(refused.stderr.contains("`fast` and `exact`"), "{}", refused.stderr);
}

/// The energy is 5e-341, which is 0 in `f64`: a drift of it would not be seen.
#[test]
fn of_an_energy_that_underflows_no_drift_is_known() {
    let file = "title = \"Tiny\"\n[coordinates]\nx = { initial = 1e-170 }\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n";
    let arguments = ["run", "system.toml", "--until", "20", "--every", "1", "--format", "json"];
    let Done { code, stdout, stderr } = with_file(file, &arguments);
    assert_eq!(code, 0, "{stderr}");
    assert!(
        stderr.contains("it is not known whether `energy` is conserved: its terms underflow"),
        "{stderr}"
    );
    let object: Value = serde_json::from_str(&stdout).expect("JSON");
    let energy = &object["invariants"][0];
    assert_eq!(energy["verdict"], "unknown");
    assert_eq!(energy["max_drift"], Value::Null);
    assert_eq!(energy["reason"], "∂L/∂t = 0; its terms underflow");
}

/// Across a kink a force has no slope: what starts on it is judged by the side it moves to.
#[test]
fn stability_is_judged_beside_a_kink() {
    let unstable = |method: &str, velocity: &str, law: &str| {
        let file = format!(
            "title = \"K\"\n[coordinates]\nx = {{ initial = 0, velocity = {velocity} }}\n[lagrangian]\n\
             L = \"1/2*x'^2 - {law}\"\n"
        );
        let arguments =
            ["run", "system.toml", "--until", "0.1", "--step", "0.1", "--method", method];
        let done = with_file(&file, &arguments);
        assert_eq!(done.code, 0, "{}", done.stderr);
        done.stderr.contains("is not stable with the step 0.1")
    };
    for method in ["rk4", "leapfrog", "symplectic-euler"] {
        // constant forces on both sides
        for velocity in ["1", "-1", "1e-9"] {
            assert!(!unstable(method, velocity, "abs(x)"), "{method} {velocity}");
        }
        // a wall of frequency 100 on the left, nothing on the right
        let wall = "5000*max(0, -x)^2";
        assert!(unstable(method, "-1", wall), "{method} into the wall");
        assert!(!unstable(method, "1", wall), "{method} away from the wall");
    }
}

/// A body left on a kink with a velocity of 1e-10 meets it every 2e-10, and would do so fifty thousand million times.
#[test]
fn a_run_from_kink_to_kink_that_has_no_end_is_given_up_with_its_rows() {
    let wedge = |velocity: &str, step: &str| {
        format!(
            "title = \"Wedge\"\n[coordinates]\nx = {{ initial = 0, velocity = {velocity} }}\n\
             [lagrangian]\nL = \"1/2*x'^2 - abs(x)\"\n[run]\n{step}"
        )
    };
    for method in ["taylor", "rk4"] {
        let words = ["run", "system.toml", "--method", method, "--at", "0,1e-8,10"];
        let done = with_file(&wedge("1e-10", ""), &words);
        assert_eq!(done.code, 1, "{method}: {}", done.stderr);
        assert!(done.stderr.contains("from one kink to the next"), "{}", done.stderr);
        assert!(done.stdout.contains("\n1e-8,"), "{}", done.stdout);
    }
    // this one has an end, and at rest on the kink nothing is ever to be done
    for velocity in ["1e-3", "0"] {
        let done = with_file(&wedge(velocity, ""), &["run", "system.toml", "--at", "0,1,10"]);
        assert_eq!((done.code, done.stderr.as_str()), (0, ""), "{velocity}");
    }
}

/// A start whose velocities alone violate a constraint is told so, with these velocities, and shows nothing of what the
/// constraint would be.
#[test]
fn velocities_that_do_not_fit_are_named() {
    for (law, place) in [("x^2 - y^2", "x' = 0, y' = 1"), ("x - tan(y - 1) - 1", "x' = 0, y' = 1")]
    {
        let text = format!(
            "title = \"a\"\n[coordinates]\nx = {{ initial = 1, velocity = 0 }}\n\
             y = {{ initial = 1, velocity = 1 }}\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2)\"\n\
             [[constraints]]\nname = \"c\"\nexpression = \"{law}\"\n"
        );
        let done = with_file(&text, &["run", "system.toml", "--format", "json"]);
        let expected =
            "the velocities at the start do not keep the constraint `c`: its rate is off by";
        assert!(done.stderr.contains(expected), "{}", done.stderr);
        let shown = done.stderr.replace('′', "'");
        assert!(shown.contains(place), "{}", done.stderr);
        let answer: Value = serde_json::from_str(&done.stdout).expect("JSON");
        let gauges = answer["invariants"].as_array().expect("a list");
        let gauge = gauges.iter().find(|gauge| gauge["name"] == "c").expect("its gauge");
        assert_eq!(gauge["verdict"], "open");
        assert!(!gauge["reason"].as_str().expect("text").contains("NaN"), "{gauge}");
    }
}

/// A run that stops for this reason, which is also in its rows.
fn stops(text: &str, options: &[&str], why: &str) {
    let mut all = vec!["run", "system.toml"];
    all.extend(options);
    let done = with_file(text, &all);
    assert_eq!(done.code, 1, "{}", done.stderr);
    assert!(done.stderr.contains(why) && done.stdout.contains(why), "{}", done.stderr);
}

/// What a check of the same file says, also where the start is given.
#[test]
fn a_start_without_a_value_is_refused_as_by_check() {
    let law = |coordinate: &str, l: &str| {
        format!(
            "title = \"A start\"\n[coordinates]\nx = {{ {coordinate} }}\n[lagrangian]\nL = \"{l}\"\n"
        )
    };
    let root = law("initial = 1", "1/2*x'^2 - (x - 2)^1.5");
    let why = "the motion cannot start: `(x - 2)^(3/2)` has no finite value at x = 1";
    with_file(&root, &["check", "system.toml"]).fails(65, &[why]);
    stops(&root, &[], why);
    let fast = law("initial = 0, velocity = 0.1", "-sqrt(1 - x'^2) - 0.1*x");
    stops(&fast, &["--init", "x'=1.5"], "`sqrt(1 - x'^2)` has no finite value at x' = 1.5");
}

#[test]
fn a_coordinate_without_inertia_is_named_and_a_start_without_a_state_is_an_error() {
    let file = |l: &str, rest: &str| {
        format!(
            "title = \"Massless\"\n[coordinates]\nx = {{ initial = 0, velocity = 1 }}\ns = {{ initial = 0 }}\n\
             [lagrangian]\nL = \"{l}\"\n{rest}"
        )
    };
    stops(&file("1/2*x'^2 - x - s*x", ""), &[], "the coordinate `s` has no kinetic term in L");
    let held = "[[constraints]]\nname = \"a\"\nexpression = \"x - s^3\"\n";
    stops(&file("1/2*x'^2 - x", held), &[], "leave velocities at the start undetermined");
}

#[test]
fn an_impulse_without_a_finite_value_is_named() {
    for change in ["ln(-x)", "1e308*x' + 1e308"] {
        let text = format!(
            "title = \"Hit\"\n[coordinates]\nx = {{ initial = 0, velocity = 1 }}\n[lagrangian]\nL = \"1/2*x'^2\"\n\
             [[impulses]]\nname = \"a\"\nat = [1.0]\nchange = {{ p_x = \"{change}\" }}\n"
        );
        stops(&text, &[], "the impulse `a` has no finite value at t = 1, x = 1");
    }
}

/// ∂²L/∂x'² = 3 x'² vanishes where the motion turns, and 3 x'² − 1 at x' = 1/√3.
#[test]
fn a_mass_that_vanishes_on_the_way_is_no_collision() {
    for l in ["x'^4/4 - x^2/2", "abs(x')^3/3 - x^2/2", "1/4*x'^4 - 1/2*x'^2 - 1/2*x^2"] {
        let text = format!(
            "title = \"Mass\"\n[coordinates]\nx = {{ initial = 0.3, velocity = 1.5 }}\n[lagrangian]\nL = \"{l}\"\n"
        );
        stops(&text, &["--until", "10"], "the mass matrix is singular at t = ");
    }
    let fall = "title = \"Fall\"\n[coordinates]\nx = { initial = 1 }\n[lagrangian]\nL = \"1/2*x'^2 + 1/x\"\n";
    stops(fall, &["--until", "10"], "collision");
}

/// √y has no value below the floor, so that it never changes its sign there.
#[test]
fn an_event_whose_function_has_lost_its_value_is_named() {
    let ball = |when: &str| {
        format!(
            "title = \"Ball\"\n[coordinates]\ny = {{ initial = 1 }}\n[lagrangian]\nL = \"1/2*y'^2 - 9.81*y\"\n\
             [[events]]\nname = \"floor\"\nwhen = \"{when}\"\ndirection = \"falling\"\naction = \"mark\"\n"
        )
    };
    let said = "at the end the function of the event `floor` has no value";
    let arguments = ["run", "system.toml", "--until", "1"];
    let (root, height) =
        (with_file(&ball("sqrt(y)"), &arguments), with_file(&ball("y"), &arguments));
    assert!(root.code == 0 && root.stderr.contains(said), "{}", root.stderr);
    assert!(height.code == 0 && height.stderr.is_empty(), "{}", height.stderr);
}

#[test]
fn a_parameter_with_the_name_of_a_unit_is_pointed_out() {
    let text = PENDULUM.to_owned();
    let done = with_file(&text, &["run", "system.toml", "--init", "theta=0.5 m", "--until", "1"]);
    let said = "--init theta=0.5 m: `m` is the parameter, not a unit, so this is 1.0";
    assert!(done.code == 0 && done.stderr.contains(said), "{}", done.stderr);
}

/// A large momentum belongs to one velocity, which differs from that of light by p⁻²/2: for 1e12 m c that is more than the digits tell,
/// and the start is refused as that; its opposite has not that momentum.
#[test]
fn a_start_near_the_velocity_of_light_is_one() {
    let file = "title = 'p'\n[coordinates]\nx = { initial = 0, velocity = 0.5 }\n[lagrangian]\n\
                L = \"-sqrt(1 - x'^2) - 1/2*x^2\"\n";
    let with = |momentum: &str| {
        let words = ["run", "system.toml", "--init", momentum, "--until", "1", "--every", "1"];
        with_file(file, &words)
    };
    for momentum in ["p_x=1e3", "p_x=-1e6"] {
        let done = with(momentum);
        assert_eq!((done.code, done.stderr.as_str()), (0, ""), "{momentum}");
    }
    let done = with("p_x=1e12");
    assert_eq!(done.code, 1);
    assert!(done.stderr.contains("no velocities were found"), "{}", done.stderr);
}

/// Only an event at places can be one whose impulse is to turn the motion back: one of the velocities is passed by its impulse.
#[test]
fn an_impulse_at_an_event_of_the_velocities_is_not_said_to_miss_its_wall() {
    let file = "title = \"Plane\"\n[coordinates]\nx = { initial = 0.3, velocity = 0.5 }\n\
                y = { initial = 0.2, velocity = -0.4 }\n[lagrangian]\n\
                L = \"1/2*x'^2+1/2*y'^2-(x^2+0.7*y^2+0.2*x*y^2)+0.1*y*sin(t)\"\n[[impulses]]\nname = \"k\"\n\
                change = { p_x = \"-0.1*x'\", p_y = \"0.2*x\" }\n[[events]]\nname = \"en\"\n\
                when = \"energy-0.4*(1+0.3*sin(t))\"\naction = \"impulse:k\"\n[[events]]\nname = \"an\"\n\
                when = \"(x*y'-y*x')*p_x-0.05\"\ndirection = \"rising\"\naction = \"impulse:k\"\n[[events]]\n\
                name = \"st\"\nwhen = \"sin(3*t+0.2)\"\ndirection = \"rising\"\naction = \"impulse:k\"\n";
    for velocity in ["0.5", "0.50001", "0.49999"] {
        let start = format!("x'={velocity}");
        with_file(file, &["run", "system.toml", "--until=7", "--every=7", "--init", &start])
            .success();
    }
}

/// Turning points under dry friction and a drive, where the velocity goes to zero and `dop853` finds no step short enough for its
/// error relative to that: it goes on as the default method does.
#[test]
fn dop853_turns_under_dry_friction_and_a_drive_as_the_default_method_does() {
    let run = |(law, force, start): (&str, &str, &str), method: &[&str]| {
        let text = format!(
            "title = \"A block\"\n[coordinates]\nx = {{ initial = 0.2, velocity = {start} }}\n[lagrangian]\n\
             L = \"1/2*x'^2 {law}\"\nforces = {{ x = \"{force}*sign(x')\" }}\n"
        );
        let words = ["run", "system.toml", "--until", "50", "--every", "10", "--method"];
        let done = with_file(&text, &[&words[..], method].concat());
        assert_eq!(done.code, 0, "{law}, {force}, {method:?}: {}", done.stderr);
        csv(&done.stdout)
    };
    for system in [
        ("- 2*x^4", "2.7*sin(t/3) - 0.45", "0"),
        ("- 2*x^4", "2.7*sin(t/3) - 0.45", "0.5"),
        ("", "2.7*sin(2.1*t) - 0.3", "0.5"),
        ("- 2*x^4", "1.3*sin(t) - 0.45", "0"),
        ("", "1.3*sin(t) - 0.3", "0.5"),
        ("", "1.3*sin(2.1*t) - 0.45", "0"),
    ] {
        let expected = run(system, &["taylor"]);
        for (tolerance, within) in [("1e-13", 1e-9), ("1e-10", 1e-6)] {
            let found = run(system, &["dop853", "--tolerance", tolerance]);
            assert_eq!(expected.len(), found.len(), "{system:?}");
            for (a, b) in expected.iter().flatten().zip(found.iter().flatten()) {
                assert!((a - b).abs() <= within * a.abs().max(1.0), "{system:?}: {a} and {b}");
            }
        }
    }
}

/// A block at rest under dry friction stays, or sets out where the force exceeds it, by `dop853` as by the default method: the force
/// F sin t at t = arcsin(μ/F), the spring that is drawn away at v at t = μ/(k v).
#[test]
fn dop853_rests_and_sets_out_under_dry_friction_as_the_default_method_does() {
    let run = |law: &str, force: &str, start: &str, method: &str| {
        let text = format!(
            "title = \"A block\"\n[coordinates]\nx = {{ initial = 0.2, velocity = {start} }}\n[lagrangian]\nL = \"{law}\"\n\
             forces = {{ x = \"{force} - 0.3*sign(x')\" }}\n"
        );
        let done = with_file(
            &text,
            &["run", "system.toml", "--until", "10", "--method", method, "--at", "0.6,2,5,10"],
        );
        assert_eq!(done.code, 0, "{}", done.stderr);
        for word in ["lost", "clock", "resolve", "sticks"] {
            assert!(!done.stderr.contains(word), "{law}, {force}, {method}: {}", done.stderr);
        }
        let rows = done.stdout.lines().filter(|line| !line.starts_with(['#', 't']));
        let row = |line: &str| line.split(',').map(|x| x.parse().unwrap()).collect::<Vec<f64>>();
        rows.map(row).collect::<Vec<_>>()
    };
    for (law, force, start, moves_at) in [
        ("1/2*x'^2", "0.5*sin(t)", "0", 0.6_f64.asin()),
        ("1/2*x'^2 - 1/2*(x - 0.2 - 0.1*t)^2", "0", "0", 3.0),
        ("1/2*x'^2 - 1/2*x^2", "0", "0", f64::INFINITY),
        ("1/2*x'^2 - 1/2*(x - 0.2)^2", "0", "0.5", 0.0),
    ] {
        let expected = run(law, force, start, "taylor");
        let found = run(law, force, start, "dop853");
        for (a, b) in expected.iter().zip(&found) {
            let is_at_rest = a[0] < moves_at;
            assert!(!is_at_rest || b[1] == 0.2 && b[2] == 0.0, "{law}, {force}: {b:?}");
            for (a, b) in a.iter().zip(b) {
                assert!((a - b).abs() < 1e-11, "{law}, {force}: {expected:?} {found:?}");
            }
        }
    }
}
