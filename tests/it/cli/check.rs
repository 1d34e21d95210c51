//! `check`: errors in the text, and false claims.

use super::{PENDULUM, phaselab, with_file};

fn claim(lines: &str) -> String {
    format!("{PENDULUM}\n{lines}\n")
}

#[test]
fn a_file_without_errors_is_passed_in_silence() {
    assert_eq!(with_file(PENDULUM, &["check", "system.toml"]).success(), "");
}

#[test]
fn errors_are_shown_at_their_places_with_exit_65() {
    let wrong = PENDULUM.replace("m*cos(theta)", "m*cso(theta) + k");
    with_file(&wrong, &["check", "system.toml"]).fails(
        65,
        &["system.toml:12:", "unknown function `cso`", "`cos`", "`k`", "2 errors in system.toml"],
    );
}

#[test]
fn a_file_with_errors_is_neither_run_nor_derived() {
    let wrong = PENDULUM.replace("theta'^2", "theta''^2");
    for command in ["run", "derive"] {
        with_file(&wrong, &[command, "system.toml"])
            .fails(65, &["system.toml:12:12", "`theta''` may not be used here"]);
    }
}

#[test]
fn a_warning_is_shown_and_is_no_failure() {
    let unused = PENDULUM.replace("m = 2.0", "m = 2.0\nidle = 1.0");
    let done = with_file(&unused, &["check", "system.toml"]);
    assert_eq!((done.code, done.stdout.as_str()), (0, ""));
    assert!(done.stderr.contains("idle"), "{}", done.stderr);
}

/// What makes another motion of it is said wherever the motion is computed; what has no effect on it, by `check` alone.
#[test]
fn degrees_are_warned_of_wherever_a_motion_is_computed() {
    let degrees = PENDULUM
        .replace("initial = 0.0,", "initial = 30.0, unit = \"degree\",")
        .replace("m = 2.0", "m = 2.0\nidle = 1.0");
    for arguments in [&["run", "system.toml", "--until", "1"][..], &["derive", "system.toml"]] {
        let done = with_file(&degrees, arguments);
        assert_eq!(done.code, 0, "{}", done.stderr);
        let warned = ["warning", "system.toml:13:", "`theta` is in degrees, but cos takes radians"];
        assert!(warned.iter().all(|words| done.stderr.contains(words)), "{}", done.stderr);
        assert!(!done.stderr.contains("idle"), "{}", done.stderr);
    }
}

#[test]
fn a_false_claim_of_conservation_is_an_error_where_it_stands() {
    let file =
        claim("[[observables]]\nname = \"speed\"\nexpression = \"theta'\"\nconserved = true");
    with_file(&file, &["check", "system.toml"]).fails(
        65,
        &["`speed` is claimed to be conserved, but it is not", "conserved = true", "drifts by"],
    );
    let file = claim("[expect]\nconserves = [\"energy\", \"p_theta\"]");
    with_file(&file, &["check", "system.toml"])
        .fails(65, &["`p_theta` is claimed to be conserved", "1 error"]);
}

#[test]
fn a_true_claim_is_passed_proved_or_not() {
    let energy = claim("[expect]\nconserves = [\"energy\"]");
    assert_eq!(with_file(&energy, &["check", "system.toml"]).success(), "");
    let hidden = claim(
        "[[observables]]\nname = \"square\"\nexpression = \"(theta'^2/2 - cos(theta))^2\"\nconserved = true",
    );
    assert_eq!(with_file(&hidden, &["check", "system.toml"]).success(), "");
}

#[test]
fn what_is_conserved_may_not_be_denied() {
    let file =
        claim("[[observables]]\nname = \"half\"\nexpression = \"energy/2\"\nconserved = false");
    with_file(&file, &["check", "system.toml"])
        .fails(65, &["`half` is claimed not to be conserved, but it is"]);
}

#[test]
fn a_wrong_number_is_an_error_and_a_right_one_is_not() {
    // the height of the throw: cos θ = 1 − w²/2, at a quarter of the period 4 K(w²/4)
    let value = |at: &str, is: &str| {
        claim(&format!(
            "[expect]\nvalues = [{{ name = \"top\", expression = \"theta\", at = {at}, is = {is}, within = 1e-9 }}]"
        ))
    };
    let right = value("1.685750354812596", "1.0471975511965976");
    assert_eq!(with_file(&right, &["check", "system.toml"]).success(), "");
    let wrong = value("1.685750354812596", "1.04720");
    with_file(&wrong, &["check", "system.toml"])
        .fails(65, &["top: this is 1.04719755", "not 1.0472", "off by 2.4e-6"]);
    let early = value("-1.0", "0.0");
    with_file(&early, &["check", "system.toml"]).fails(65, &["before the start, t = 0"]);
}

#[test]
fn a_claim_beyond_an_error_cannot_be_checked() {
    let file = "title = \"T\"\n[coordinates]\nx = { initial = 1 }\n[lagrangian]\n\
                L = \"1/2*x'^2 + 1/x\"\n[expect]\nvalues = [\n  \
                { name = \"after the fall\", expression = \"x\", at = 9.0, is = 1.0 },\n]\n";
    with_file(file, &["check", "system.toml"])
        .fails(65, &["`after the fall` cannot be checked", "t = 1.11"]);
}

#[test]
fn several_files_are_all_checked() {
    let done = with_file(PENDULUM, &["check", "system.toml", "system.toml"]);
    assert_eq!(done.success(), "");
    let wrong = PENDULUM.replace("m*cos", "n*cos");
    with_file(&wrong, &["check", "system.toml", "system.toml"]).fails(65, &["errors in 2 files"]);
}

#[test]
fn json_goes_to_standard_output() {
    let wrong = PENDULUM.replace("m*cos", "n*cos");
    let done = with_file(&wrong, &["check", "system.toml", "--format", "json"]);
    assert_eq!(done.code, 65);
    let object: serde_json::Value = serde_json::from_str(&done.stdout).expect("JSON");
    let diagnostic = &object["files"][0]["mistakes"][0];
    assert_eq!(diagnostic["severity"], "error");
    assert_eq!((diagnostic["line"].as_u64(), diagnostic["column"].as_u64()), (Some(12), Some(23)));
    assert!(diagnostic["message"].as_str().is_some_and(|m| m.contains("`n`")), "{object}");
}

#[test]
fn every_shipped_preset_keeps_its_claims() {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/presets");
    let mut files = Vec::new();
    for folder in std::fs::read_dir(root).expect("the presets are there") {
        let folder = folder.expect("a folder can be read").path();
        for file in std::fs::read_dir(folder).expect("a folder of presets") {
            let path = file.expect("a file").path();
            if path.extension().is_some_and(|extension| extension == "toml") {
                files.push(path.display().to_string());
            }
        }
    }
    files.sort();
    assert!(files.len() > 20, "{files:?}");
    let arguments: Vec<&str> =
        ["check"].into_iter().chain(files.iter().map(String::as_str)).collect();
    assert_eq!(phaselab(&arguments).success(), "");
}

fn one(start: &str, law: &str) -> String {
    format!("title = \"T\"\n[coordinates]\n{start}\n{law}\n")
}

#[test]
fn what_cannot_start_is_said_with_the_coordinate_and_the_reason() {
    let rest = "x = { initial = 0, velocity = 1.5 }";
    let late = "x = { initial = 1, velocity = 0.5 }";
    let two = "x = { initial = 1, velocity = 0.5 }\ny = { initial = 1 }";
    let l = |law: &str| format!("[lagrangian]\nL = \"{law}\"");
    for (start, law, reported) in [
        (rest, l("1/2*x'^2 - 1/x"), ["`1/x` has no finite value at x = 0", ":3:1"]),
        (rest, "[hamiltonian]\nH = \"p_x^2/2 + 1/x\"".to_owned(), ["`1/x` has no", ":3:"]),
        (rest, l("-sqrt(1 - x'^2)"), ["has no finite value at x' = 1.5", ":3:1"]),
        (late, l("1/2*x'^2 + ln(x - 2)"), ["`ln(x - 2)` has no finite value at x = 1", ":3:1"]),
        (late, l("1/2*x'^2 + 5*x/t"), ["no finite value at t = 0", ":5:5"]),
        (two, l("1/2*x'^2 - x*y"), ["`y` has no kinetic term", ":4:1"]),
        (two, l("x*y' - x^2 - y^2"), ["`x`, `y` have no kinetic term", "first order in time"]),
        (
            "x = { initial = \"pi/2\", velocity = 1 }",
            l("1/2*x'^2 - tan(x)"),
            ["`tan(x)` has a pole at x = 1.57", ":3:1"],
        ),
        (
            "x = { initial = \"-pi\", velocity = 1 }",
            l("1/2*x'^2 - 1/sin(x)^2"),
            [" has a pole at x = -3.14", ":3:1"],
        ),
        (
            "theta = { initial = 0, velocity = 0.5 }\nphi = { initial = 0, velocity = 1 }",
            l("1/2*(theta'^2 + sin(theta)^2*phi'^2) - cos(theta)"),
            ["the mass matrix is singular", "θ = 0"],
        ),
        (late, l("1/2*x'^2/(x - 1)^2"), ["x'^2/(x - 1)^2` has no finite value at x = 1", ":3:1"]),
        (late, l("1/2*x'^2 - (-1)^x"), ["`ln(-1)` has no finite value\n", "u must be above zero"]),
        (
            "x = { initial = 1 }",
            l("1/12*x'^4 - 1/2*x^2"),
            ["the mass matrix is singular", "x′ = 0"],
        ),
    ] {
        let law = if law.contains("hamiltonian") {
            one(&start.replace("velocity", "momentum"), &law)
        } else {
            one(start, &law)
        };
        let reported = ["the motion cannot start", reported[0], reported[1]];
        with_file(&law, &["check", "system.toml"]).fails(65, &reported);
    }
}

#[test]
fn what_can_start_is_passed() {
    let l = |law: &str| format!("[lagrangian]\nL = \"{law}\"");
    let at_zero = "x = { initial = 0, velocity = 1 }";
    for law in [
        // rounding that is small, or that a factor takes away
        l("1/2*x'^2 - cos(x + pi)"),
        l("1/2*x'^2 - x*cot(x + 1)"),
        // finite on the side that the motion takes, and at the start
        l("1/2*x'^2 - abs(x)"),
        l("1/2*x'^2 - 1/(x + 1e-3)"),
        l("-sqrt(1 - x'^2/1.0001)"),
        l("1/2*x'^2 + 5*x/(t + 1)"),
    ] {
        assert_eq!(
            with_file(&one(at_zero, &law), &["check", "system.toml"]).success(),
            "",
            "{law}"
        );
    }
}

/// At θ = π the rounding of sin θ is not 0, but p_φ is.
#[test]
fn a_body_on_the_axis_of_its_chart_can_start_at_pi() {
    let text = "title = \"T\"\n[coordinates]\ntheta = { initial = \"pi\", momentum = 1 }\nphi = { initial = 0 }\n\
                [hamiltonian]\nH = \"p_theta^2/2 + p_phi^2/(2*sin(theta)^2) - cos(theta)\"\n";
    assert_eq!(with_file(text, &["check", "system.toml"]).success(), "");
}

/// The axis and a parabola touch where the motion begins, and have no other point in common.
#[test]
fn constraints_that_only_touch_at_the_start_cannot_be_kept() {
    let text = "title = \"T\"\n[coordinates]\nx = { initial = 0, velocity = 1 }\ny = { initial = 0, velocity = 0 }\n\
                [lagrangian]\nL = \"1/2*(x'^2 + y'^2)\"\n[[constraints]]\nname = \"a\"\nexpression = \"y\"\n\
                [[constraints]]\nname = \"b\"\nexpression = \"y - x^2\"\n";
    let reported =
        ["the motion cannot begin", "`b`", "contradicts them after t = 0, x = 0", ":12:"];
    with_file(text, &["check", "system.toml"]).fails(65, &reported);
    let run = with_file(text, &["run", "system.toml"]);
    assert!(run.code == 1 && run.stderr.contains("after t = 0, x = 0"), "{}", run.stderr);
}

/// A claim that would take forever is abandoned after a limited number of steps, with the result so far.
#[test]
fn a_claim_has_a_budget() {
    let stiff = "[lagrangian]\nL = \"1/2*x'^2 - 1e12*x^2\"\n[run]\nuntil = 1e6\n\
                 [[observables]]\nname = \"G\"\nexpression = \"x\"\nconserved = true";
    let file = one("x = { initial = 1 }", stiff);
    let done = with_file(&file, &["check", "system.toml"]);
    assert_eq!(done.code, 65);
    // a third of four million: its law has three parts, 1, x and the force
    let said = "`G` cannot be checked: the 1333333 steps that a check may take led only to t = ";
    let (_, rest) = done.stderr.split_once(said).expect("the number of steps");
    // a step is of the order of 1/w, and the next sample, at t = 5025, is far away
    let reached: f64 = rest.lines().next().and_then(|time| time.parse().ok()).expect("a time");
    let step = reached / 1_333_333.0 * 2e12_f64.sqrt();
    assert!((0.1..100.0).contains(&step), "{reached}");
    let events = "[lagrangian]\nL = \"1/2*x'^2\"\n[run]\nuntil = 1e6\n\
                  [[events]]\nname = \"tick\"\nwhen = \"sin(100*t)\"\n\
                  [expect]\ncount = [{ name = \"tick\", until = 1e6, is = 1 }]";
    let file = one("x = { initial = 1 }", events);
    with_file(&file, &["check", "system.toml"]).fails(65, &["`tick` happens", "and more, not 1"]);
    let more = file.replace("is = 1 }", "is = 31830988 }");
    with_file(&more, &["check", "system.toml"]).fails(
        65,
        &[
            "`tick` cannot be counted until t = 1000000: the ",
            " steps that a check may take led only to t = ",
        ],
    );
}

#[test]
fn a_root_that_is_squared_away_is_reported() {
    let file = one("x = { initial = 1 }", "[lagrangian]\nL = \"1/2*x'^2 - (1 + sqrt(x)^2)\"");
    let said = "`x` is under a root that is squared away";
    with_file(&file, &["check", "system.toml"]).says(said);
    with_file(&file, &["derive", "system.toml"]).says("x ≥ 0");
    let kept = file.replace("(1 + sqrt(x)^2)", "(sqrt(x) + sqrt(x)^2)");
    assert!(!with_file(&kept, &["check", "system.toml"]).text().contains(said));
    // 1/cos a may be beyond 1, where cos a cannot
    let chord = |part: &str| {
        let law = format!("L = \"1/2*(x'^2 + y'^2 + a'^2) - sqrt(x^2 + y^2 + 2*x*y{part})^2\"");
        let file = one(
            "x = { initial = 1 }\ny = { initial = 1 }\na = { initial = 0.3 }",
            "[lagrangian]\n",
        ) + &law;
        with_file(&file, &["derive", "system.toml"]).success()
    };
    assert!(chord("/cos(a)").contains("its root is squared away"));
    assert!(!chord("*cos(a)").contains("its root is squared away"));
}

/// What is zero at most is never below: the squared length of a chord, by the law of cosines, under a function's range. Just
/// beside each there is one that may be negative.
#[test]
fn a_root_of_what_is_never_negative_is_not_reported() {
    for (never, sometimes) in [
        ("2 - 2*cos(x - y)", "2 - 2.01*cos(x - y)"),
        ("1 - cos(x)*sin(y)^2", "1 - 1.01*cos(x)*sin(y)^2"),
        ("x^2 + y^2 - 2*x*y*cos(y)", "x^2 + y^2 - 2.01*x*y*cos(y)"),
        ("x^2 + 2*x + 1", "x^2 + 2*x + 0.99"),
        ("4*k^2*x^2 - 4*k^2*x^2*sin(y)", "4*k^2*x^2 - 4.01*k^2*x^2*sin(y)"),
        ("cosh(x) - 1", "cosh(x) - 1.01"),
        ("1 - tanh(x)^2", "0.99 - tanh(x)^2"),
        ("abs(x)", "abs(x) - 1"),
        ("max(0, x)", "min(0, x)"),
        ("acos(cos(x))", "asin(sin(x))"),
        ("x^2 + y^2 - 2*x*y", "x^2 - 2*x*y"),
    ] {
        let warned = |e: &str| {
            let file = "title = \"r\"\n[coordinates]\nx = { initial = 0.5 }\ny = { initial = 0.3 }\n\
                        [parameters]\nk = 1.5\n[lagrangian]\n\
                        L = \"1/2*x'^2 + 1/2*y'^2 - 1/2*k*sqrt(";
            let file = format!("{file}{e})^2\"\n");
            with_file(&file, &["derive", "system.toml"]).success().contains("squared away")
        };
        assert!(!warned(never), "{never}");
        assert!(warned(sometimes), "{sometimes}");
    }
}

/// A claim is not true because the run ends before it becomes false; nor is its denial false.
#[test]
fn a_claim_that_holds_by_a_short_run_only_is_false() {
    let barrier = |rest: &str| {
        let law = "[lagrangian]\nL = \"1/2*x'^2 - 0.7*exp(-10*(x-6)^2)\"\n[run]\nuntil = 3\n";
        one("x = { initial = 0, velocity = 1 }", &format!("{law}{rest}"))
    };
    with_file(&barrier("[expect]\nconserves = [\"p_x\"]"), &["check", "system.toml"]).fails(
        65,
        &[
            "`p_x` is claimed to be conserved, but it is not",
            "only keeps its value to rounding until t = 3",
        ],
    );
    let denied = "[[observables]]\nname = \"v\"\nexpression = \"x'\"\nconserved = false";
    assert_eq!(with_file(&barrier(denied), &["check", "system.toml"]).success(), "");
}

/// What is conserved only as long as a motion stays on one side of a kink, until t = 10 or always, is refused with the side.
#[test]
fn a_claim_that_holds_on_one_side_of_a_kink_only_is_false() {
    let file = |law: &str, claim: &str| {
        let start = "x = { initial = 0, velocity = 1 }";
        one(start, &format!("[lagrangian]\n{law}\n[run]\nuntil = 10\n{claim}"))
    };
    let momentum = "[expect]\nconserves = [\"p_x\"]";
    let energy = "[expect]\nconserves = [\"energy\"]";
    let of = |expression: &str| {
        format!("[[observables]]\nname = \"s\"\nexpression = \"{expression}\"\nconserved = true")
    };
    let [far, near, quotient, disguised, root] = [
        "sign(x + 1.0001)",
        "max(x, 2)",
        "(x + 10)/abs(x + 10)",
        "(x + 10)/sqrt((x + 10)^2)",
        "sqrt((x + 10)^2)/(x + 10)",
    ]
    .map(of);
    let oscillator = "L = \"1/2*x'^2 - 1/2*x^2\"";
    let ramp = "L = \"1/2*x'^2 - k*x^2/2\"\n[parameters]\nk = 1\n[[ramps]]\nparameter = \"k\"\nto = 2\nstart = 50\n\
                duration = 5";
    for (law, claim, side) in [
        ("L = \"1/2*x'^2 - max(0, x - 20)^3\"", momentum, "x − 20 < 0"),
        ("L = \"1/2*x'^2 - (x - 20 + sqrt((x - 20)^2))\"", momentum, "x − 20 < 0"),
        ("L = \"1/2*x'^2 - 1/2*x^2 + x*max(0, t - 100)^1.5\"", energy, "t − 100 < 0"),
        ("L = \"1/2*x'^2 - 1/2*x^2 + x*(t - 50 + abs(t - 50))\"", energy, "t − 50 < 0"),
        (
            &format!("{oscillator}\nforces = {{ x = \"1e-3*max(0, t - 100)\" }}"),
            energy,
            "t − 100 < 0",
        ),
        (
            &format!("{oscillator}\ndissipation = \"0.1*max(0, abs(x) - 5)^2*x'^2\""),
            energy,
            "|x| − 5 < 0",
        ),
        // nowhere but in a small piece far away
        ("L = \"1/2*x'^2 - max(0, 1e-7 - abs(x - 20))^2\"", momentum, "< 0"),
        (ramp, energy, "< 0"),
        (oscillator, &far, "x + 1.0001 > 0"),
        (oscillator, &near, "x − 2 < 0"),
        (oscillator, &quotient, "x + 10 > 0"),
        (oscillator, &disguised, "x + 10 > 0"),
        (oscillator, &root, "x + 10 > 0"),
    ] {
        with_file(&file(law, claim), &["check", "system.toml"]).fails(
            65,
            &[
                "is claimed to be conserved, but it is not",
                "it is only where ",
                side,
                "where this motion stays as far as it is seen until t = 10",
            ],
        );
    }
}

/// What is conserved on every side of its kinks, on sides that nothing reaches, or at rest, is.
#[test]
fn a_claim_that_no_kink_ends_is_passed() {
    let file = |start: &str, law: &str, claims: &str| {
        one(
            start,
            &format!(
                "[lagrangian]\nL = \"{law}\"\n[run]\nuntil = 10\n[expect]\nconserves = [{claims}]"
            ),
        )
    };
    let moving = "x = { initial = 1, velocity = 0.3 }";
    let plane = "x = { initial = 1, velocity = 0.3 }\ny = { initial = 0, velocity = 1 }";
    let rest = "x = { initial = 0, velocity = 0 }";
    for (start, law, claims) in [
        (moving, "1/2*x'^2 - max(0, x - 20)^3", "\"energy\", \"(x'^2/2 + max(0, x - 20)^3)^2\""),
        (moving, "1/2*x'^2 - (x - 20)*sign(x - 20)", "\"energy\""),
        (
            moving,
            "1/2*x'^2 - x^2/2",
            "\"max(energy, 0)\", \"sign(energy)\", \"x'^2 + x*abs(x)*sign(x)\"",
        ),
        (moving, "1/2*x'^2 - max(0, -x^2 - 1)", "\"p_x\""),
        (plane, "1/2*(x'^2 + y'^2) - max(x - y - 5, 0)^1.5", "\"p_x + p_y\""),
        (rest, "1/2*x'^2 - abs(x)*x^2", "\"p_x\", \"x\""),
    ] {
        assert_eq!(
            with_file(&file(start, law, claims), &["check", "system.toml"]).success(),
            "",
            "{law}"
        );
    }
}

/// A circle and a parabola touch at the start, and part.
#[test]
fn constraints_that_touch_are_said_to_repeat_each_other_at_the_start() {
    let touch = "y = { initial = 1, velocity = 0 }\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2)\"\n\
                 [[constraints]]\nname = \"c\"\nexpression = \"x^2 + y^2 - 1\"\n\
                 [[constraints]]\nname = \"d\"\nexpression = \"y - 1 + x^2/2\"\n";
    let file = one("x = { initial = 0, velocity = 1 }", touch);
    let done = with_file(&file, &["check", "system.toml"]);
    let said = "the constraint `d` depends at the start on those before it";
    assert!(done.stderr.contains(said), "{}", done.stderr);
}

/// Constraints on the same velocity, which no velocity meets: it is not what the file gives that is wrong.
#[test]
fn constraints_that_contradict_each_other_are_named() {
    let law = "[lagrangian]\nL = \"1/2*x'^2\"\n[[constraints]]\nname = \"c\"\nexpression = \"x' - 2\"\n\
               [[constraints]]\nname = \"d\"\nexpression = \"x' - 3\"\n";
    let done = with_file(&one("x = 0", law), &["check", "system.toml"]);
    done.fails(65, &["the constraint `d` contradicts those before it at the start", ":11:14"]);
}

/// At a place where the force is infinite no motion begins, and none of several is chosen.
#[test]
fn a_start_without_a_force_is_not_said_to_have_several_motions() {
    let law = "[lagrangian]\nL = \"1/2*x'^2\"\nforces = { x = \"1/x\" }\n";
    let done = with_file(&one("x = 0", law), &["run", "system.toml"]);
    assert!(!done.stderr.contains("not unique"), "{}", done.stderr);
    assert!(done.stderr.contains("`1/x` has no finite value at x = 0"), "{}", done.stderr);
}

/// What a law changes along a motion is not conserved, however little of that a run shows: by a force too weak to see, or a
/// constant that makes the change small beside it. The sentence says which.
#[test]
fn what_a_law_changes_is_not_conserved_however_little_is_seen() {
    let weak = ("1/2*x'^2 - 1e-30*x", "", "p_x");
    let offset =
        ("1/2*x'^2 - 1/2*x^2", "dissipation = \"0.05*x'^2\"\n", "1/2*x'^2 + 1/2*x^2 - 1e12");
    for ((law, rest, quantity), seen) in [
        (weak, "it only keeps its value to rounding until t = 3; its rate of change is"),
        (offset, "until t = 3, small beside its terms; its rate of change is"),
    ] {
        let file = |claim: &str| {
            let law = format!("[lagrangian]\nL = \"{law}\"\n{rest}[run]\nuntil = 3\n");
            let observable = format!(
                "[[observables]]\nname = \"G\"\nexpression = \"{quantity}\"\nconserved = {claim}\n"
            );
            one("x = { initial = 0.2, velocity = 1 }", &format!("{law}{observable}"))
        };
        with_file(&file("true"), &["check", "system.toml"])
            .fails(65, &["`G` is claimed to be conserved, but it is not", seen]);
        assert_eq!(with_file(&file("false"), &["check", "system.toml"]).success(), "");
        // and it stands in one place only
        let reported = with_file(&file("true"), &["derive", "system.toml"]).success();
        assert!(
            !reported.contains("(stated by the file)") && reported.contains("d(G)/dt"),
            "{reported}"
        );
    }
}

/// Nor by a force behind a kink, of which it is not decided symbolically whether it acts: the motion comes there.
#[test]
fn what_a_weak_force_behind_a_kink_changes_is_not_conserved() {
    let checked = |force: &str| {
        let law = format!("[lagrangian]\nL = \"1/2*x'^2 - {force}\"\n[run]\nuntil = 3\n");
        let claim = "[[observables]]\nname = \"G\"\nexpression = \"x'\"\nconserved = true\n";
        let file = one("x = { initial = 0.2, velocity = 1 }", &format!("{law}{claim}"));
        with_file(&file, &["check", "system.toml"])
    };
    for force in ["1e-20*max(0, 1 - abs(x - 2)/0.2)^2", "1e-20*max(0, x - 2)^2.5"] {
        let said = "it only keeps its value to rounding until t = 3";
        checked(force).fails(65, &["`G` is claimed to be conserved, but it is not", said]);
    }
    assert_eq!(checked("0*max(0, x - 2)^2.5").success(), "");
}

/// The energy is expected to be the same after an impulse as before it, as any other quantity is: at x = cos 2 with x' = −sin 2
/// an impulse of 1/2 leaves it another, one of 2 sin 2 turns the velocity round.
#[test]
fn an_impulse_that_changes_what_is_expected_to_be_conserved_is_seen() {
    let file = |change: &str| {
        format!(
            "title = \"E\"\n[coordinates]\nx = {{ initial = 1.0 }}\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n\
             [[impulses]]\nname = \"one\"\nat = [2.0]\nchange = {{ p_x = \"{change}\" }}\n\
             [expect]\nconserves = [\"energy\"]\n"
        )
    };
    with_file(&file("0.5"), &["check", "system.toml"])
        .fails(65, &["`energy` is claimed to be conserved, but it is not"]);
    with_file(&file("2*sin(2)"), &["check", "system.toml"]).success();
}

/// A claim of what is conserved holds until an event ends the motion, and is checked until there.
#[test]
fn what_is_conserved_is_checked_until_an_event_ends_the_motion() {
    let file = |l: &str| {
        format!(
            "title = \"E\"\n[coordinates]\nx = {{ initial = 1.0, velocity = -0.4 }}\n\
             [lagrangian]\nL = \"1/2*x'^2 - {l}\"\n\
             [[events]]\nname = \"end\"\nwhen = \"x - 0.7\"\naction = \"stop\"\n\
             [expect]\nconserves = [\"energy\"]\n"
        )
    };
    with_file(&file("max(x, 0)^2*exp(-(x + 5)^2)"), &["check", "system.toml"]).success();
    with_file(&file("sin(t)*x"), &["check", "system.toml"])
        .fails(65, &["`energy` is claimed to be conserved, but it is not"]);
}

#[test]
fn a_shipped_system_is_checked_by_its_name() {
    assert_eq!(phaselab(&["check", "harmonic-oscillator"]).success(), "");
    phaselab(&["check", "harmonic-oscilator"])
        .fails(2, &["unknown preset `harmonic-oscilator`; did you mean `harmonic-oscillator`?"]);
    phaselab(&["check", "./harmonic-oscillator"]).fails(2, &["cannot read ./harmonic-oscillator"]);
}

/// A square of 1e-170 is 0 in `f64`, and x² seems to be constant.
#[test]
fn what_underflows_is_not_claimed_to_be_conserved() {
    let square = |start: &str| {
        let law = "[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n[[observables]]\nname = \"square\"\n\
                   expression = \"x^2\"\nconserved = true";
        with_file(&one(&format!("x = {{ initial = {start} }}"), law), &["check", "system.toml"])
    };
    square("1e-170").fails(65, &["`square` cannot be checked: its terms underflow"]);
    square("1e-100").fails(65, &["`square` is claimed to be conserved, but it is not"]);
    // 0 is constant
    assert_eq!(square("0").code, 0);
}

#[test]
fn a_dissipation_that_feeds_energy_in_one_direction_is_warned_of() {
    let odd = "the dissipation function is odd in the velocities";
    let warned = |dissipation: &str| {
        let file = format!(
            "title = 'a test'\n[coordinates]\nx = {{ initial = 1.0 }}\ny = {{ initial = 0.0 }}\n[parameters]\nc = 0.1\n\
             [lagrangian]\nL = \"1/2*(x'^2 + y'^2) - 1/2*x^2\"\ndissipation = \"{dissipation}\""
        );
        let done = with_file(&file, &["check", "system.toml"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        done.stderr.contains(odd)
    };
    for dissipation in ["c*x'^3", "c*x'^3*cos(y) + x*y'", "c*x'*y'^2", "c*sin(x')"] {
        assert!(warned(dissipation), "{dissipation}");
    }
    for dissipation in
        ["1/2*c*x'^2", "c*abs(x')^3", "c*abs(x')", "c*x'^3 + c*x'^2", "-c*(1 - x^2)*x'^2"]
    {
        assert!(!warned(dissipation), "{dissipation}");
    }
}

/// A comparison whose constraint has not the velocity that is to be eliminated: the reason is said where it is asked for.
#[test]
fn a_coordinate_that_no_constraint_has_is_not_eliminated() {
    let text = |eliminate: &str| {
        format!(
            "title = \"T\"\n[coordinates]\nx = {{ initial = 1.0 }}\ny = {{ initial = 0.5, velocity = 0.2 }}\n[lagrangian]\n\
             L = \"1/2*(x'^2 + y'^2) - 1/2*y^2\"\n[[constraints]]\nname = \"c\"\nexpression = \"x'\"\n\
             [comparison]\neliminate = [\"{eliminate}\"]\n"
        )
    };
    for command in ["check", "run"] {
        let said = ["`c` cannot be solved for y'", "11 | eliminate = [\"y\"]", "velocities of `x`"];
        with_file(&text("y"), &[command, "system.toml"]).fails(65, &said);
    }
    with_file(&text("x"), &["check", "system.toml"]).success();
}

#[test]
fn a_bracket_that_differs_only_far_from_the_start_is_refused() {
    let file = |f: &str| {
        format!(
            "title = 'T'\n[coordinates]\nx = {{ initial = 1.0, velocity = 0.3 }}\n\
             [lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n\
             [expect]\nbrackets = [{{ f = '{f}', g = 'p_x', is = '1' }}]\n"
        )
    };
    for (f, said) in [
        ("x + 1e-30*x^9", "is not what this says"),
        ("x + 1e-60*x^9", "is not what this says"),
        ("x + max(0, x - 9000)", "is not what this says"),
        ("x + max(0, x - 1e12)", "is not what this says"),
        ("x + exp(-(x - 9000)^2)", "cannot be checked"),
    ] {
        with_file(&file(f), &["check", "system.toml"]).fails(65, &[said, "1 error"]);
    }
    assert_eq!(with_file(&file("x + 1e-30*t^9"), &["check", "system.toml"]).success(), "");
}

/// An oscillator x = a cos ωt whose lengths and times are those of an atom, of a room, or of a galaxy: an expected number of which
/// the file gives no tolerance is held against the size of the quantity, also where that is zero then.
#[test]
fn what_is_expected_is_held_against_its_size_in_all_units() {
    for (a, omega) in [(5e-11, 4e16), (1.0, 2.0), (3e20, 1e-15)] {
        let quarter = std::f64::consts::FRAC_PI_2 / omega;
        let (third, two) = (2.0 / 3.0 * quarter, 2.0 * quarter);
        let file = |x: f64, zero: f64, time: f64| {
            format!(
                "title = \"T\"\n[coordinates]\nx = {{ initial = {a:e} }}\n[parameters]\nw = {omega:e}\n\
                 [lagrangian]\nL = \"1/2*(x'^2 - w^2*x^2)\"\n[[events]]\nname = \"middle\"\nwhen = \"x\"\n\
                 [expect]\nvalues = [\n{{ expression = \"x\", at = {third:e}, is = {x:e} }},\n\
                 {{ expression = \"x'\", at = {two:e}, is = {zero:e} }},\n]\n\
                 events = [{{ name = \"middle\", at = {time:e} }}]\n"
            )
        };
        let check = |text: String| with_file(&text, &["check", "system.toml"]);
        assert_eq!(check(file(0.5 * a, 0.0, quarter)).success(), "", "{a}");
        let off = 1.0 + 1e-8;
        check(file(0.5 * a * off, 0.0, quarter)).fails(65, &["x: this is", "1 error"]);
        check(file(0.5 * a, 1e-8 * a * omega, quarter)).fails(65, &["x': this is", "1 error"]);
        check(file(0.5 * a, 0.0, quarter * off)).fails(65, &["`middle` happens at t =", "1 error"]);
    }
}

/// A velocity that decays as e⁻ᵗ is held against what it has become, and one that swings against its swing, where it is zero as well.
#[test]
fn what_has_decayed_is_held_against_what_is_left_of_it() {
    let check = |law: &str, at: &str, is: &str| {
        let text = format!(
            "title = \"T\"\n[coordinates]\nx = {{ initial = 0, velocity = 1 }}\n[lagrangian]\n{law}\n\
             [expect]\nvalues = [{{ expression = \"x'\", at = {at}, is = {is} }}]\n"
        );
        with_file(&text, &["check", "system.toml"])
    };
    let decays = "L = \"1/2*x'^2\"\nforces = { x = \"-x'\" }";
    for (at, is, wrong) in [
        // e⁻¹⁵, e⁻³⁰, e⁻⁴⁰
        ("15", "3.059023205018258e-7", ["3.0590233e-7", "3.06e-7"]),
        ("30", "9.357622968840175e-14", ["9.4e-14", "1.2e-13"]),
        ("40", "4.248354255291589e-18", ["5e-16", "4.2484e-18"]),
    ] {
        assert_eq!(check(decays, at, is).success(), "");
        for wrong in wrong {
            check(decays, at, wrong).fails(65, &["x': this is", "1 error"]);
        }
    }
    // zero but for rounding of what it was
    assert_eq!(check(decays, "40", "0").success(), "");
    check(decays, "30", "0").fails(65, &["x': this is", "1 error"]);
    let swings = "L = \"1/2*x'^2 - 1/2*x^2\"";
    // π/2 and 201π/2
    for at in ["1.5707963267948966", "315.7300616857742"] {
        assert_eq!(check(swings, at, "0").success(), "");
        check(swings, at, "1e-9").fails(65, &["x': this is", "1 error"]);
    }
}

/// Two blocks on a string: without any velocity the constraint leaves one of them open.
#[test]
fn a_velocity_that_constraints_leave_open_is_named_with_what_to_write() {
    let file = "[coordinates]\nx = 0\ny = 0\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2) - x\"\n\
                [[constraints]]\nname = \"string\"\nexpression = \"x + y\"\n";
    let said = [
        "leave velocities at the start undetermined: give y'",
        "y = { initial = ..., velocity = 0 }",
    ];
    with_file(file, &["check", "system.toml"]).fails(65, &said);
    let given = file.replace("y = 0", "y = { initial = 0, velocity = 0 }");
    assert_eq!(with_file(&given, &["check", "system.toml"]).success(), "");
}
