//! Points at which a method stops, or used to stop: it passes them, or reports a method that does.

use phaselab::experiment::{AdvanceOutcome, Experiment, Status};

use crate::cli::with_file;
use crate::experiment::{PLENTY, build, run, value};

fn file(text: &str) -> Experiment {
    build(&format!("title = 'a test'\n{text}"), |_| ())
}

fn by(method: &str, step: Option<f64>, text: &str) -> Experiment {
    build(&format!("title = 'a test'\n{text}"), |setup| {
        method.clone_into(&mut setup.method);
        setup.settings.step = step;
    })
}

/// The message of the failure on the way to a time.
fn error(mut experiment: Experiment, time: f64) -> String {
    assert_ne!(experiment.advance(time, PLENTY), AdvanceOutcome::Arrived);
    match experiment.status() {
        Status::Failed(error) => error.message.clone(),
        other => panic!("{other:?}"),
    }
}

const DRIVEN: &str = r#"
[coordinates]
x = { initial = 0.0 }
y = { initial = 0.0 }
[lagrangian]
L = "1/2*(x'^2 + y'^2)"
forces = { x = "-0.8*x'/sqrt(x'^2+y'^2) + 1.2*sin(t)", y = "-0.8*y'/sqrt(x'^2+y'^2)" }
"#;

const IN_MOMENTA: &str = r#"
[coordinates]
x = { initial = 0.0, momentum = 1.0 }
y = { initial = 0.0, momentum = 0.5 }
[hamiltonian]
H = "1/2*(p_x^2 + p_y^2)"
forces = { x = "-0.8*p_x/sqrt(p_x^2+p_y^2)", y = "-0.8*p_y/sqrt(p_x^2+p_y^2)" }
"#;

/// A body on a plane sticks until the force beats friction, slides, and sticks again.
#[test]
fn dry_friction_in_the_plane_with_a_force_that_depends_on_time() {
    let mut body = file(DRIVEN);
    run(&mut body, 0.7);
    assert_eq!([value(&body, "x"), value(&body, "x'")], [0.0, 0.0]);
    // it begins to move where 1.2 sin t = 0.8
    let begin = (0.8_f64 / 1.2).asin();
    let slides = |t: f64| {
        let after = t - begin;
        let v = 1.2 * (begin.cos() - t.cos()) - 0.8 * after;
        let x = 1.2 * (begin.cos() * after - (t.sin() - begin.sin())) - 0.4 * after * after;
        [x, v]
    };
    for t in [0.75, 1.0, 2.0] {
        run(&mut body, t);
        let [x, v] = slides(t);
        let error = (value(&body, "x") - x).abs().max((value(&body, "x'") - v).abs());
        assert!(error < 1e-14, "at {t}: {error:e}");
    }
    // at rest again before the force turns round
    let (mut moves, mut rests) = (2.0, 4.0);
    for _ in 0..60 {
        let middle = 0.5 * (moves + rests);
        if slides(middle)[1] > 0.0 { moves = middle } else { rests = middle }
    }
    run(&mut body, 3.13);
    if rests < 3.13 {
        assert_eq!(value(&body, "x'"), 0.0);
        assert!((value(&body, "x") - slides(rests)[0]).abs() < 1e-13);
    }
    assert_eq!([value(&body, "y"), value(&body, "y'")], [0.0, 0.0]);
}

/// A body on a plane under a force that turns while it grows: its velocity begins as τ², in a direction that
/// friction holds ever more tightly the slower it is. The numbers are computed with thirty digits: the
/// asymptotic series of the polar coordinates of the velocity, s' = f·e − μ and s φ' = f·n, up to
/// τ = 0.02, where its least term is 1e-32, then extrapolated midpoint steps.
#[test]
fn a_force_that_turns_sets_a_body_in_motion_against_dry_friction() {
    let begin = 0.832_342_100_951;
    for (text, names) in [
        (
            "[coordinates]\nx = { initial = 0 }\ny = { initial = 0 }\n[lagrangian]\n\
             L = \"1/2*x'^2 + 1/2*y'^2 - 0.05*y + 0.4*x*sin(t)\"\n\
             dissipation = \"0.3*sqrt(x'^2+y'^2)\"\n",
            ["x", "y", "x'", "y'"],
        ),
        (
            "[coordinates]\nx = { initial = 0 }\ny = { initial = 0 }\n[hamiltonian]\n\
             H = \"1/2*p_x^2 + 1/2*p_y^2 + 0.05*y - 0.4*x*sin(t)\"\n\
             forces = { x = \"-0.3*p_x/sqrt(p_x^2+p_y^2)\", y = \"-0.3*p_y/sqrt(p_x^2+p_y^2)\" }\n",
            ["x", "y", "p_x", "p_y"],
        ),
    ] {
        let mut body = file(text);
        run(&mut body, begin - 1e-6);
        assert_eq!(names.map(|name| value(&body, name)), [0.0; 4]);
        for (t, expected) in [
            (
                0.9,
                [
                    1.327_889_537_504e-5,
                    -2.150_570_191_505e-6,
                    5.852_615_365_219_73e-4,
                    -9.352_580_752_496_04e-5,
                ],
            ),
            (
                1.5,
                [
                    0.010_434_470_800_188_1,
                    -0.001_379_265_450_051_05,
                    0.042_642_133_835_936_57,
                    -0.005_412_062_193_129,
                ],
            ),
            (
                2.0,
                [
                    0.043_977_287_439_496_93,
                    -0.005_638_639_436_022_64,
                    0.088_587_315_058_768_31,
                    -0.011_543_691_286_748,
                ],
            ),
        ] {
            run(&mut body, t);
            for (name, expected) in names.iter().zip(expected) {
                let off = value(&body, name) - expected;
                assert!(off.abs() < 4e-17, "{name} at {t}: off by {off:e}");
            }
        }
        // it comes to rest and sets out again, every half period
        run(&mut body, 20.0);
        assert!(value(&body, "y") < -0.05);
    }
}

#[test]
fn dry_friction_in_the_plane_of_a_hamiltonian() {
    let mut body = file(IN_MOMENTA);
    run(&mut body, 5.0);
    // p²/2 = 0.8 s
    let (p, length) = (1.25_f64.sqrt(), 1.25 / 1.6);
    let error =
        (value(&body, "x") - length / p).abs().max((value(&body, "y") - 0.5 * length / p).abs());
    assert!(error < 1e-14, "{error:e}");
    assert_eq!([value(&body, "p_x"), value(&body, "p_y")], [0.0, 0.0]);
}

/// The messages of a run of a file.
fn said(text: &str, arguments: &[&str]) -> String {
    let text = format!("title = 'a test'\n{text}");
    with_file(&text, &[&["run", "system.toml"], arguments].concat()).text()
}

#[test]
fn a_motion_that_leaves_the_range_of_numbers_ends() {
    // the methods that are tried from there look for the modes of rates whose squares overflow
    let text = r#"
        [coordinates]
        q1 = { initial = -0.181, velocity = -1.166 }
        q2 = { initial = 0.831, velocity = -1.171 }
        [lagrangian]
        L = """0.4705*q1'^2 + cosh(q2') - 0.085*q1'*q2' + 0.596/sqrt(q1^2 + q2^2 + 0.01)
               - 0.587*q1^2*q2 - 0.212*q2*cos(2.426*t)"""
        dissipation = "0.065*q2'^2"
    "#;
    let said = said(text, &["--at", "30"]);
    assert!(
        said.contains("q₁′ grows beyond the range of numbers, 1.8e308, after t = 21.9"),
        "{said}"
    );
}

/// A method that stops names one that can continue.
#[test]
fn an_error_names_the_method_that_passes() {
    let message = said(IN_MOMENTA, &["--method", "dop853", "--until", "12"]);
    assert!(message.contains("; --method taylor passes it"), "{message}");
    let root = "[coordinates]\nx = { initial = 1.0 }\n[lagrangian]\n\
                L = \"1/2*x'^2 - sqrt(abs(x))\"";
    let message = said(root, &["--method", "dop853", "--until", "6"]);
    assert!(message.contains("; --method taylor passes it"), "{message}");
    // no method passes a collision
    let message = said(&root.replace("- sqrt(abs(x))", "+ 1/x^2"), &["--until", "5"]);
    assert!(message.contains("# faulted") && !message.contains("passes"), "{message}");
}

/// Steps that are too long lead within one of them from where the motion is not to beyond the range of numbers.
#[test]
fn steps_that_run_away_are_blamed_themselves() {
    let quartic = "[coordinates]\nx = { initial = 1.0, velocity = 0.5 }\n[lagrangian]\n\
                   L = \"1/2*x'^2 - x^4/4 - x^2/2\"";
    for step in ["0.9", "1.25", "2"] {
        let words = ["--method", "yoshida4", "--step", step, "--until", "200"];
        let message = said(quartic, &words);
        assert!(message.contains("is too long for it"), "{message}");
        assert!(!message.contains("passes it"), "{message}");
    }
}

const PARALLELOGRAM: &str = r#"
[coordinates]
a = { initial = 0, velocity = 1 }
p = { initial = 0 }
b = { initial = 0 }
[lagrangian]
L = "1/2*(a'^2 + b'^2 + p'^2) - cos(a)"
[[constraints]]
name = "x1"
expression = "sin(a) + cos(p) - 1 - sin(b)"
[[constraints]]
name = "y1"
expression = "cos(a) + sin(p) - cos(b)"
"#;

#[test]
fn bars_in_line_are_reported_whether_they_are_passed_or_not() {
    // the bars are in line twice; by rounding the motion goes on there or does not
    let message = said(PARALLELOGRAM, &["--until", "4"]);
    assert!(message.contains("singular configuration of the constraints at t = 1.37"), "{message}");
    if message.contains("# faulted") {
        assert!(message.contains("; --method rk4 --step "), "{message}");
    } else {
        let both = "passed a singular configuration of the constraints at t = 1.37 and 1 more";
        assert!(message.contains(both), "{message}");
    }
}

/// x (z' − 0.2) = 0.1 x' z on a circle, falling to its bottom, where x and z vanish and with them the row of the constraint: the
/// circle itself is met there.
#[test]
fn a_constraint_whose_row_vanishes_is_singular_and_no_other_is_lost() {
    let text = "[coordinates]\nx = { initial = 0.6 }\ny = { initial = -0.8 }\nz = { initial = 0.3, velocity = 0.2 }\n\
                [lagrangian]\nL = \"1/2*(x'^2 + y'^2 + z'^2) - 9.81*y - z^2\"\n\
                [[constraints]]\nname = 'circle'\nexpression = 'x^2 + y^2 - 1'\n\
                [[constraints]]\nname = 'again'\nexpression = \"2*x*x' + 2*y*y'\"\n\
                [[constraints]]\nname = 'row'\nexpression = \"x*z' - 0.1*x'*z - 0.2*x\"\n";
    let why = error(file(text), 1.0);
    assert!(why.contains("singular configuration") && why.contains("t = 0.672"), "{why}");
}

/// The dense output of a method keeps the constraints to its tolerance only, and seems to turn their directions fast where they
/// are reversed.
#[test]
fn bars_in_line_are_reported_at_every_tolerance() {
    for tolerance in [1e-4, 1e-6, 1e-9, 1e-13] {
        let words = format!("--until 3 --method dop853 --tolerance {tolerance:e}");
        let words: Vec<&str> = words.split(' ').collect();
        let message = said(PARALLELOGRAM, &words);
        let reported = "passed a singular configuration of the constraints at t = ";
        let time = message.split(reported).nth(1).and_then(|rest| rest.split(':').next());
        let time: f64 = time.and_then(|time| time.parse().ok()).expect("it is reported");
        // a step may be off by a hundred tolerances here, and four digits are said
        let error = 200.0 * tolerance + 1e-3;
        assert!((time - 1.370).abs() < error, "{tolerance}: {message}");
    }
    // a coupler that is a little longer passes its narrow place without one
    let near = PARALLELOGRAM.replace("cos(p) - 1", "1.05*cos(p) - 1.05");
    let message = said(&near, &["--until", "1", "--method", "dop853"]);
    assert!(!message.contains("singular"), "{message}");
}

/// x^(3/2) ends at 0, where its rate of change has a limit.
#[test]
fn the_end_of_a_domain_is_called_so() {
    let power =
        "[coordinates]\nx = { initial = 1, velocity = -2 }\n[lagrangian]\nL = \"1/2*x'^2 - x^1.5\"";
    let message = said(power, &["--until", "9"]);
    assert!(
        message.contains("# faulted") && message.contains("the end of a function's domain"),
        "{message}"
    );
}

/// p = v³ − v turns back at v = 1/√3.
#[test]
fn a_fixed_step_does_not_jump_to_another_branch() {
    let branched = "[coordinates]\nx = { initial = 0.3, velocity = 1.5 }\n[lagrangian]\n\
                    L = \"1/4*x'^4 - 1/2*x'^2 - 1/2*x^2\"";
    for step in [0.3, 0.01] {
        let message = error(by("rk4", Some(step), branched), 10.0);
        assert!(message.starts_with("the branch of the velocities ends after t = 1."), "{message}");
    }
}

/// The constraint whose multiplier is solved for may become degenerate while another one does not.
#[test]
fn redundant_constraints_are_chosen_anew_on_the_way() {
    let hoop = r#"
[coordinates]
x = { initial = 0.0, velocity = 1.0 }
y = { initial = 1.0 }
[lagrangian]
L = "1/2*(x'^2 + y'^2)"
[[constraints]]
name = "product"
expression = "y*(x^2 + y^2 - 1)"
[[constraints]]
name = "hoop"
expression = "x^2 + y^2 - 1"
"#;
    let mut bead = file(hoop);
    run(&mut bead, 10.0);
    let error =
        (value(&bead, "x") - 10.0_f64.sin()).abs().max((value(&bead, "y") - 10.0_f64.cos()).abs());
    assert!(error < 1e-13, "{error:e}");
}

/// A momentum may correspond to a velocity far from rest.
#[test]
fn a_single_momentum_is_solved_for_however_far_its_velocity() {
    for (kinetic, momentum, velocity) in [
        ("cosh(x')", 1e12, 1e12_f64.asinh()),
        ("x'*atan(x') - 1/2*ln(1 + x'^2)", 1.5705, 1.5705_f64.tan()),
        ("-sqrt(1 - x'^2)", 1e4, 1e4 / (1.0 + 1e8_f64).sqrt()),
        ("exp(x')", 1e-12, 1e-12_f64.ln()),
    ] {
        let text = format!(
            "title = 'a test'\n[coordinates]\nx = {{ initial = 0.0 }}\n[lagrangian]\nL = \"{kinetic}\""
        );
        let (model, system) = crate::system::compile(&text);
        let given = [phaselab::system::InitialOverride::Momentum(0, momentum)];
        let state = system.initial(0.0, &model.parameter_values(), &given);
        let state = state.unwrap_or_else(|error| panic!("{kinetic}: {error}"));
        let error = (state.values[1] - velocity).abs() / velocity.abs();
        assert!(error < 1e-11, "{kinetic}: {} for {velocity}", state.values[1]);
    }
}

/// A velocity that is given beside the momentum of another coordinate is not turned in the search for further starts.
#[test]
fn a_velocity_beside_a_momentum_gives_one_start() {
    // p_y = y' + x', where x' is given and L is quadratic or not
    for further in ["", " + x'^3/10"] {
        let coupled = format!(
            "title = 'coupled'\n[coordinates]\nx = {{ initial = 0 }}\ny = {{ initial = 0 }}\n[lagrangian]\n\
             L = \"1/2*(x'^2 + y'^2) + x'*y'/2{further}\"\n"
        );
        let given = ["--init", "x'=1", "--init", "p_y=0.25", "--at", "0", "--until", "1"];
        let reported = with_file(&coupled, &[&["run", "system.toml"][..], &given].concat()).text();
        let row = reported.lines().find(|line| line.starts_with("0.0,")).expect(&reported);
        assert!(row.starts_with("0.0,0.0,0.0,1.0,-0.25,"), "{reported}");
    }
}

/// The value of an expression at the end of a motion by the default method, after a tolerance if one is given.
fn reached(text: &str, tolerance: Option<f64>, time: f64, name: &str) -> f64 {
    let mut experiment = build(&format!("title = 'a test'\n{text}"), |setup| {
        setup.settings.tolerance = tolerance;
    });
    run(&mut experiment, time);
    value(&experiment, name)
}

/// Contacts of fractional power, where a velocity is exactly 0 before and friction acts on it after: its work is next to
/// nothing at first, and must not be asked for more digits than it has.
#[test]
fn friction_on_what_a_contact_sets_in_motion() {
    for power in ["1.5", "2.5", "3.5"] {
        let text = format!(
            "[coordinates]\nu = {{ initial = 0.152 }}\nv = {{ initial = -0.656, velocity = 0.478 }}\n[lagrangian]\n\
             L = \"1/2*(u'^2 + v'^2) - 0.562*max(0, u + 0.67*v)^{power}\"\ndissipation = \"0.04*u'^2\"\n"
        );
        let by_series = reached(&text, None, 2.0, "u");
        let mut other = by("dop853", None, &text);
        run(&mut other, 2.0);
        let off = (by_series - value(&other, "u")).abs();
        assert!(by_series < 0.1519 && off < 1e-8, "{power}: {by_series}, {off:e}");
    }
}

/// A contact far from the origin in plain `f64`, whose digits do not tell the nearest points apart; and one that is met so
/// fast that steps on the way to it hardly move the clock.
#[test]
fn contacts_are_met_where_digits_are_few() {
    let slow = "[coordinates]\nu = { initial = 0.645, velocity = -1.392 }\n[lagrangian]\nL = \"1/2*(2 + sin(u))*u'^2 - \
                (12.08*u^2 + 6.64*max(0, u + 0.049)^2.5 + 19.248*abs(u + 0.615) + 2.588*u^4)\"\n";
    let exactly = reached(slow, None, 1.25, "u");
    for tolerance in [1e-12, 1e-15] {
        let off = (reached(slow, Some(tolerance), 1.25, "u") - exactly).abs();
        assert!(off < 1e3 * tolerance, "{tolerance:e}: {off:e}");
    }
    // thrown back by a wall at a speed of some millions, and met again by nothing else: E = ½ v² + far terms
    let fast = "[coordinates]\nx = { initial = 1.0, velocity = 1.0 }\n[lagrangian]\nL = \"1/2*x'^2 - (3*exp(5*(x + \
                4.507)) + 1.079*max(0, x)^2.5 + 0.49*x^2)\"\n";
    let (x, v) = (reached(fast, None, 3.257, "x"), reached(fast, None, 3.257, "x'"));
    let energy = |x: f64, v: f64| {
        0.5 * v * v + 3.0 * (5.0 * (x + 4.507)).exp() + 1.079 * x.max(0.0).powf(2.5) + 0.49 * x * x
    };
    let (first, last) = (energy(1.0, 1.0), energy(x, v));
    assert!((last / first - 1.0).abs() < 1e-12, "{first:e} {last:e}");
}

/// About 0 the series of u⁴⁰ has no term below the fortieth. With E = ½: t = u + u⁴¹/(41 a⁴⁰) up to the square of that.
#[test]
fn a_steep_power_is_not_beyond_the_order() {
    let text = "[coordinates]\nu = { initial = 0.0, velocity = 1.0 }\n[lagrangian]\nL = \"1/2*u'^2 - (u/1.469)^40\"\n";
    let small = 1.469_f64.powi(-40);
    let off = reached(text, None, 1.0, "u") - (1.0 - small / 41.0);
    assert!(off.abs() < 1e-13, "{off:e}");
    let off = reached(text, None, 1.0, "u'") - (1.0 - small);
    assert!(off.abs() < 1e-12, "{off:e}");
    // the product of two such factors, and an exponent that is a parameter
    let energy =
        |text: &str| reached(text, None, 3.0, "energy") - reached(text, None, 0.0, "energy");
    let product = "[coordinates]\nu = { initial = 0.0, velocity = 1.0 }\nv = { initial = 0.0, velocity = 0.9 }\n\
                   [lagrangian]\nL = \"1/2*(u'^2 + v'^2) - (u/1.3)^20*(v/1.2)^20\"\n";
    let parametric = "[coordinates]\nu = { initial = 0.0, velocity = 1.0 }\n[parameters]\nn = 36\n[lagrangian]\n\
                      L = \"1/2*u'^2 - (u^2)^(n/2)\"\n";
    for text in [product, parametric] {
        let off = energy(text);
        assert!(off.abs() < 1e-11, "{off:e} {text}");
    }
}

/// Parameters of ordinary size with powers beyond the range of numbers: (x/u)⁴⁰ with u = 10⁻⁸, where 1/u⁴⁰ divides by what
/// has lost its digits. The gauge saw a drift of 2·10⁻⁶ that was none.
#[test]
fn a_power_of_a_parameter_leaves_the_range_and_no_gauge_drifts() {
    let text = "[coordinates]\nx = { initial = 1e-8, velocity = 8.82e-7 }\n[parameters]\nu = 1e-8\nT = 0.01\nE = 2.5e-10\n\
                [lagrangian]\nL = \"E*(1/2*(x'*T/u)^2 - 0.911*sin(3*x/u) - (x/u/2.307)^40)\"\n";
    let mut experiment = file(text);
    run(&mut experiment, 0.2);
    let gauge = &experiment.snapshot().gauges[0];
    assert!(gauge.name == "energy" && gauge.max_drift < 1e-13, "{:e}", gauge.max_drift);
    // the same with numbers of ordinary size
    let natural = "[coordinates]\nx = { initial = 1, velocity = 0.882 }\n[lagrangian]\n\
                   L = \"1/2*x'^2 - 0.911*sin(3*x) - (x/2.307)^40\"\n";
    let off = value(&experiment, "x") * 1e8 - reached(natural, None, 20.0, "x");
    assert!(off.abs() < 1e-10, "{off:e}");
}

/// A step far beyond what the method can follow: the function of the event swings thousands of times within it.
#[test]
fn an_event_that_swings_beyond_a_step_is_reported() {
    let text = "[coordinates]\nx = { initial = 1.0, velocity = 0.0 }\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n\
                [[events]]\nname = \"hit\"\nwhen = \"2 + sin(1e8*x)\"\naction = \"stop\"\n";
    let message = error(by("rk4", Some(0.1), text), 1.0);
    assert!(message.contains("oscillates too often within one step"), "{message}");
    assert!(message.contains("try a smaller step"), "{message}");
    // negative: a thousand swings are followed
    let mut slower = by("rk4", Some(0.1), &text.replace("1e8", "1e4"));
    run(&mut slower, 1.0);
    assert!((value(&slower, "x") - 1.0_f64.cos()).abs() < 1e-5);
}

/// Where an event is looked for in several pieces of each step, the gauges look at the ends of the steps all the same: after one
/// whole period nothing seems to have moved, and the first look must not be there.
#[test]
fn gauges_look_at_steps_in_which_an_event_is_sought_piece_by_piece() {
    let text = "[coordinates]\nx = { initial = 1.0, velocity = 0.0 }\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2 - 1/4*x^4\"\n\
                [[events]]\nname = \"far\"\nwhen = \"x + 3\"\naction = \"stop\"\n";
    let drift = |tolerance: f64| {
        let mut experiment = build(&format!("title = 'a test'\n{text}"), |setup| {
            setup.settings.tolerance = Some(tolerance);
        });
        run(&mut experiment, 40.0);
        experiment.snapshot().gauges[0].max_drift
    };
    for tolerance in [1e-6, 1e-8, 1e-10, 1e-12] {
        let drift = drift(tolerance);
        assert!(drift < 100.0 * tolerance, "{tolerance:e}: {drift:e}");
    }
}

/// A fixed step so long that the state at its end is far from what the constraint allows: the step is to blame, which is
/// said; by adaptive steps the same motion goes as far as it is asked to.
#[test]
fn a_constraint_that_is_lost_in_a_long_step_asks_for_a_smaller_one() {
    let text = "[coordinates]\nu = { initial = -0.32328956686350335, velocity = -1.045661596894593 }\n\
                v = { initial = 0.9463000876874145, velocity = -0.3572349713841712 }\n[lagrangian]\n\
                L = \"0.5*u'^2 + 0.5*v'^2 - 3.0*exp(5.0*(v + 5.0))\"\n\
                [[constraints]]\nname = \"held\"\nexpression = \"u^2 + v^2 - 1\"\n";
    let message = error(by("rk4", Some(0.01), text), 1.0);
    assert!(message.contains("the constraint `held` cannot be kept at t = 0.01"), "{message}");
    assert!(message.contains("try a smaller step"), "{message}");
    let mut adaptive = file(text);
    run(&mut adaptive, 1e-6);
    let (u, v) = (value(&adaptive, "u"), value(&adaptive, "v"));
    assert!((u * u + v * v - 1.0).abs() < 1e-14, "{u} {v}");
}

/// A motion that returns to a kink at rest only touches it: with what velocity it arrives is a matter of rounding, which
/// may count on one side and not on the other.
#[test]
fn a_kink_that_is_touched_at_rest_is_left_again() {
    let held = |law: &str| {
        format!(
            "[coordinates]\nx = {{ initial = 1, velocity = 0 }}\ny = {{ initial = 0, velocity = 0 }}\n\
             [lagrangian]\nL = \"{law}\"\n[[constraints]]\nname = \"held\"\nexpression = \"x^2 + y^2 - 1\"\n"
        )
    };
    let smooth = "0.4625*x'^2 + 1.2895*y'^2 + 0.022*x*y' - (0.825/(1.0 + exp(-y)) + 0.742*abs(y)^3 + (x/2.02)^20)";
    let equal = "1.2895*x'^2 + 1.2895*y'^2 - (0.206*y + 0.742*abs(y)^3)";
    for law in [smooth, equal] {
        let mut experiment = file(&held(law));
        run(&mut experiment, 100.0);
        let gauge = &experiment.snapshot().gauges[0];
        assert!(gauge.name == "energy" && gauge.max_drift < 1e-12, "{law}: {:e}", gauge.max_drift);
    }
}

/// A square touches zero where its root passes it: there are two kinks at one place, of v and of v', and over the moment
/// between them the direction is still that of the whole step.
#[test]
fn two_kinks_at_one_place_are_passed_together() {
    let text = "[coordinates]\nu = { initial = 1.175, velocity = 1.117 }\n\
                v = { initial = 1.3184968750000001, velocity = 2.50682725 }\n[lagrangian]\n\
                L = \"0.5*(2 + sin(v))*u'^2 + 0.6225*v'^2 + 0.0265*v'^4 - 0.47*max(0, v)^2\"\n\
                forces = { u = \"-0.296*v'*abs(v')\" }\n\
                [[constraints]]\nname = \"held\"\nexpression = \"v - 0.955*u^2\"\n";
    let mut taylor = file(text);
    run(&mut taylor, 7.0);
    let mut other = by("dop853", None, text);
    run(&mut other, 7.0);
    let off = value(&taylor, "u") - value(&other, "u");
    assert!(off.abs() < 1e-6, "{off:e}");
}

/// A force that turns while it fades lets a body come to rest in a way whose steps vanish: their last ones are shorter than
/// the last digit of the time, and rest is looked at at times that are rounded to it. The numbers: an integration in polar
/// coordinates of the velocity (SciPy, Radau, rtol 1e-12), from each onset to the next rest.
#[test]
fn a_body_comes_to_rest_within_the_last_digit_of_the_time_and_starts_again() {
    let text = "[coordinates]\nx = { initial = 0 }\ny = { initial = 0 }\n[lagrangian]\n\
                L = \"1/2*(x'^2 + y'^2) + 0.4*x*sin(t) + 0.4*y*cos(1.7*t)*sin(t)\"\n\
                dissipation = \"0.3*sqrt(x'^2 + y'^2)\"\n[run]\nuntil = 8\n";
    let mut body = file(text);
    for (time, expected) in [
        (6.7, [-0.000_376_401_78, -0.084_166_982_8, 0.0, 0.0]),
        (8.0, [0.058_915_781_268, -0.030_222_902_264, 0.139_781_562_94, 0.108_596_534_73]),
        (10.0, [0.302_058_753_217, 0.004_940_736_016_6, 0.0, 0.0]),
        (20.0, [-0.025_992_446_51, -0.014_801_659_656, 0.026_262_021_81, -0.020_824_475_553]),
    ] {
        run(&mut body, time);
        for (name, expected) in ["x", "y", "x'", "y'"].into_iter().zip(expected) {
            let found = value(&body, name);
            assert!((found - expected).abs() < 2e-11, "{name} = {found} at t = {time}");
        }
    }
}

/// The step that a method of fixed size takes where none is given is a part of the motion's own time, in any unit of it.
#[test]
fn steps_that_nobody_gave_do_not_depend_on_units() {
    let swung = |unit: f64| {
        let text = format!(
            "title = \"A pendulum\"\n[coordinates]\nq = {{ initial = 1.1 }}\n[lagrangian]\n\
             L = \"1/2*({unit:e}*q')^2 + cos(q)\"\n"
        );
        let end = format!("--at={:e}", 10.0 * unit);
        let rows = with_file(&text, &["run", "system.toml", "--method=rk4", &end]).success();
        let last = rows.lines().rfind(|line| !line.starts_with('#')).expect("a row");
        last.split(',').nth(1).expect("a column").parse::<f64>().expect("a number")
    };
    let natural = swung(1.0);
    for unit in [1e-60, 1e15, 1e25, 1e60] {
        assert!((swung(unit) - natural).abs() < 1e-8, "{unit:e}");
    }
}

/// From a start on a kink that a root hides a method that does not locate kinks leaves it as the default method does.
#[test]
fn a_start_on_a_hidden_kink_is_passed() {
    let text = "[coordinates]\nu = { initial = 0.321, velocity = -0.432 }\nv = { initial = 0, velocity = 0.689 }\n[lagrangian]\n\
                L = \"0.5*u'^2 + 0.5*v'^2 + 0.581*exp(-v^2) - 1.466*(v^2)^0.5\"\n";
    let mut other = by("dop853", None, text);
    run(&mut other, 1.0);
    let mut taylor = file(text);
    run(&mut taylor, 1.0);
    assert!((value(&taylor, "v") - value(&other, "v")).abs() < 1e-11, "{}", value(&other, "v"));
    let mut written = file(&text.replace("(v^2)^0.5", "abs(v)"));
    run(&mut written, 1.0);
    assert!((value(&taylor, "v") - value(&written, "v")).abs() < 1e-13);
}

/// A collision on a line, of a body that something else drives as well: methods that step over it give numbers, and as the
/// attraction is weak beside the velocity these even agree. No method passes it, and none is named.
#[test]
fn a_collision_that_others_step_over_names_none_of_them() {
    let text = "[coordinates]\nr = { initial = 1.191, velocity = -0.765 }\ntheta = { initial = 1.046889, velocity = -0.672435 }\n\
                [lagrangian]\nL = \"0.5*r'^2 + 0.5*theta'^2 + 0.808/sqrt(r^2 + theta^2) - 3*exp(5*(theta + 5))\"\n\
                [[constraints]]\nname = \"held\"\nexpression = \"theta - 0.879*r\"\n";
    let free = "[coordinates]\nx = { initial = 1, velocity = -1e6 }\n[lagrangian]\nL = \"1/2*x'^2 + 1/abs(x)\"\n";
    for text in [text, free] {
        let message = error(file(text), 0.25);
        assert!(message.contains("collision") && !message.contains("passes it"), "{message}");
    }
}

/// The force −1/x goes on where ln x has no value: no method ends a step there, and none is called to pass.
#[test]
fn a_motion_ends_where_a_logarithm_of_its_energy_does() {
    let text = "[coordinates]\nx = { initial = 1.0, velocity = -0.5 }\n[lagrangian]\nL = \"1/2*x'^2 - ln(x)\"";
    let steps = [("rk4", Some(0.01)), ("gauss4", Some(0.01)), ("gauss6", Some(0.01))];
    for (method, step) in steps.into_iter().chain([("dop853", None), ("taylor", None)]) {
        let mut fall = by(method, step, text);
        assert_ne!(fall.advance(5.0, PLENTY), AdvanceOutcome::Arrived, "{method}");
        let Status::Failed(error) = fall.status() else { panic!("{method}: {:?}", fall.status()) };
        let message = error.message.clone();
        assert!(!message.contains("passes it"), "{method}: {message}");
        assert!(value(&fall, "x") > 0.0, "{method}: {message}");
        // ½v² = ⅛ − ln x: it falls in after ∫ dx/√(¼ − 2 ln x) = 0.876
        assert!((fall.time() - 0.876).abs() < 0.02, "{method}: {} {message}", fall.time());
        if step.is_some() {
            assert!(message.contains("leaves the domain of ln"), "{method}: {message}");
        }
    }
}

/// A step that ends beyond it has not led there if an event or the end of the run comes before.
#[test]
fn a_step_beyond_a_logarithm_counts_up_to_what_comes_before() {
    let law = "[coordinates]\nx = { initial = 1.0, velocity = -0.5 }\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*ln(x)\"\n";
    let wall = "[[events]]\nname = \"wall\"\nwhen = \"x - 0.05\"\n";
    let mut free = by("rk4", Some(0.1), law);
    // the step from 1 ends at 1.1, beyond 0
    let mut fine = file(law);
    run(&mut free, 1.02);
    run(&mut fine, 1.02);
    assert!((value(&free, "x") - value(&fine, "x")).abs() < 1e-2, "{}", value(&free, "x"));
    assert_ne!(free.advance(3.0, PLENTY), AdvanceOutcome::Arrived);
    assert!(value(&free, "x") > 0.0 && free.time() >= 1.0, "{}", free.time());
    let stop = format!("{law}{wall}action = \"stop\"\n");
    let mut stopped = by("rk4", Some(0.1), &stop);
    stopped.advance(3.0, PLENTY);
    assert!(matches!(stopped.status(), Status::Ended(_)), "{:?}", stopped.status());
}

/// A logarithm that keeps its value stops nothing: the logarithmic potential of a galaxy.
#[test]
fn a_logarithm_of_what_stays_positive_stops_nothing() {
    let text = "[coordinates]\nx = { initial = 1.0 }\ny = { initial = 0.0, velocity = 0.4 }\n[lagrangian]\n\
                L = \"1/2*(x'^2 + y'^2) - 1/2*ln(0.1 + x^2 + y^2)\"";
    for (method, step) in
        [("rk4", Some(0.01)), ("gauss4", Some(0.01)), ("leapfrog", Some(0.001)), ("dop853", None)]
    {
        let mut orbit = by(method, step, text);
        run(&mut orbit, 20.0);
        assert!(value(&orbit, "x").abs() < 1.1, "{method}");
    }
}

/// Falls into a centre end for every method, and none is called to pass them.
#[test]
fn no_method_is_named_where_all_collide() {
    for potential in ["-1/x^2", "2*ln(x)", "-1/sqrt(x)", "-1/abs(x)"] {
        let text = format!(
            "[coordinates]\nx = {{ initial = 1.0, velocity = -1.0 }}\n[lagrangian]\nL = \"1/2*x'^2 - ({potential})\""
        );
        let message = error(by("dop853", None, &text), 9.0);
        assert!(!message.contains("passes it"), "{potential}: {message}");
    }
}

/// In V = |x|^0.1 the motion passes x = 0 with a finite velocity, though the force there has no bound.
#[test]
fn a_force_without_bound_is_no_collision() {
    let line = |potential: &str| {
        format!(
            "[coordinates]\nx = {{ initial = 1 }}\n[lagrangian]\nL = \"1/2*x'^2 - ({potential})\"\n"
        )
    };
    let message = error(file(&line("abs(x)^0.1")), 10.0);
    assert!(message.contains("the force grows without bound there"), "{message}");
    assert!(!message.contains("collision"), "{message}");
    let message = error(file(&line("-1/abs(x)")), 10.0);
    assert!(message.contains("collision"), "{message}");
}

/// Motions that reach infinity in a finite time, with the time: x = 1/(1 − t)², 1/(1 − t), and −2 ln of what is left of π/2.
#[test]
fn a_motion_that_reaches_infinity_is_said_to() {
    let second = |potential: &str, x: f64, v: f64| {
        format!(
            "[coordinates]\nx = {{ initial = {x}, velocity = {v} }}\n[lagrangian]\nL = \"1/2*x'^2 - ({potential})\""
        )
    };
    let first =
        "[coordinates]\nx = { initial = 1.0, momentum = 1.0 }\n[hamiltonian]\nH = \"p_x*x^2\"";
    let half_turn = std::f64::consts::FRAC_PI_2;
    for (law, time) in [
        (second("-2*x^3", 1.0, 2.0), 1.0),
        (second("-x^4/2", 1.0, 1.0), 1.0),
        (second("-x^4/2 + 1e-9*x^2", 1.0, 1.0), 1.0),
        (second("-exp(x)", 0.0, 1.0), half_turn),
        (first.to_owned(), 1.0),
        // begun at −1, it does so at 0
        (format!("{}\n[run]\nstart = -1", second("-2*x^3", 1.0, 2.0)), 0.0),
    ] {
        let steps =
            [("taylor", None), ("dop853", None), ("rk4", Some(0.01)), ("gauss4", Some(0.01))];
        for (method, step) in steps {
            let mut motion = by(method, step, &law);
            assert_ne!(motion.advance(3.0, PLENTY), AdvanceOutcome::Arrived, "{method} {law}");
            let Status::Failed(error) = motion.status() else { panic!("{:?}", motion.status()) };
            let said = "the motion grows without bound: x reaches infinity at t = ";
            let Some(at) = error.message.strip_prefix(said) else {
                panic!("{method} {law}: {}", error.message)
            };
            let at: f64 = at.parse().expect("a time and nothing more");
            let within = if law.contains("e-9") { 1e-8 } else { 1e-10 };
            assert!((at - time).abs() < within, "{method} {law}: {at}");
        }
    }
}

/// What falls into a centre, however it turns on the way, reaches no infinity; neither does what grows exponentially.
#[test]
fn collisions_and_exponential_growth_reach_no_infinity() {
    let plane = |potential: &str| {
        format!(
            "[coordinates]\nx = {{ initial = 1.0, velocity = 0.0 }}\ny = {{ initial = 0.0, velocity = 0.5 }}\n\
             [lagrangian]\nL = \"1/2*(x'^2 + y'^2) - ({potential})\""
        )
    };
    let polar = "[coordinates]\nr = { initial = 1.0, velocity = 0.0 }\nphi = { initial = 0.0, velocity = 0.5 }\n\
                 [lagrangian]\nL = \"1/2*(r'^2 + r^2*phi'^2) + 1/r^2\"";
    let line = |potential: &str, v: f64| {
        format!(
            "[coordinates]\nx = {{ initial = 1.0, velocity = {v} }}\n[lagrangian]\nL = \"1/2*x'^2 - ({potential})\""
        )
    };
    for law in [
        plane("-1/(x^2 + y^2)"),
        plane("-1/(x^2 + y^2)^2"),
        polar.to_owned(),
        line("-1/x", 0.0),
        line("-1/x^20", 0.0),
        line("ln(x)", 0.0),
    ] {
        for method in ["taylor", "dop853"] {
            let message = error(by(method, None, &law), 9.0);
            assert!(!message.contains("infinity"), "{method} {law}: {message}");
            assert!(message.contains("collision"), "{method} {law}: {message}");
        }
    }
    for (method, step) in [
        ("taylor", None),
        ("dop853", None),
        ("rk4", Some(0.1)),
        ("rk4", Some(8.0)),
        ("leapfrog", Some(2.0)),
    ] {
        let message = error(by(method, step, &line("-1/2*x^2", 1.0)), 2000.0);
        assert!(message.contains("grows beyond the range of numbers"), "{method}: {message}");
        assert!(!message.contains("too long"), "{method}: {message}");
    }
}

/// A bounded motion in steps beyond stability: numbers grow beyond all range, and it is the step that is blamed; where they do so at
/// once, a method is named that passes. With a fifth of the step, or less, the same method stays in range.
#[test]
fn fixed_steps_that_diverge_are_called_too_long() {
    let stiff = "[coordinates]\nx = { initial = 1.0 }\n[lagrangian]\nL = \"1/2*x'^2 - 50*x^2\"";
    let quartic = "[coordinates]\nx = { initial = 1.0, velocity = 0.3 }\n[lagrangian]\nL = \"1/2*x'^2 - x^4\"";
    let canonical = "[coordinates]\nq = { initial = 1.0, momentum = 0.7 }\n[hamiltonian]\nH = \"p_q^4 + q^2 + q^4\"";
    for (law, step) in [(stiff, 1.0), (quartic, 2.0), (canonical, 1.25)] {
        for method in ["symplectic-euler", "leapfrog", "yoshida4", "yoshida6", "rk4"] {
            let message = error(by(method, Some(step), law), 2000.0);
            let at_once = step > 1.0 && message.contains(" passes it");
            let blamed = at_once || message.contains(&format!("the step {step} is too long"));
            assert!(blamed, "{method} {law}: {message}");
            let mut shorter = by(method, Some(0.01), law);
            assert_eq!(shorter.advance(20.0, PLENTY), AdvanceOutcome::Arrived, "{method} {law}");
        }
    }
}

/// Barriers whose force is lost in the digits of others until the motion is there. All turn it back within 10⁻⁴ of x = 0, so that x = |cos t + ½ sin t| to about as much.
#[test]
fn no_barrier_of_a_negative_power_is_stepped_over_by_dop853() {
    for barrier in [
        "1e-60/x^12",
        "1e-40/x^4",
        "1e-300/x^60",
        "1e-20/x^2",
        "3/(1 + 1e16*x^2)",
        "3/(1 + 1e16*x^2)^2",
        "3/(1 + 1e12*x^2)^4",
    ] {
        let text = format!(
            "[coordinates]\nx = {{ initial = 1.0, velocity = 0.5 }}\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2 - {barrier}\""
        );
        let mut experiment = by("dop853", None, &text);
        for time in [4.0, 7.0_f64] {
            run(&mut experiment, time);
            let (x, free) = (value(&experiment, "x"), time.cos() + 0.5 * time.sin());
            let off = (x - free.abs()).abs();
            assert!(off < 2e-4, "{barrier}: {x} at {time}");
        }
    }
}

/// Equal steps do not see a barrier of a negative power, and say so; what only seems to be one is passed without a word.
#[test]
fn equal_steps_over_a_pole_are_reported() {
    let passage = |method: &str, potential: &str| {
        let text = format!(
            "[coordinates]\nx = {{ initial = 1.0, velocity = 0.5 }}\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2 - {potential}\""
        );
        let mut experiment = by(method, Some(0.013), &text);
        run(&mut experiment, 4.0);
        experiment.narrow_passage()
    };
    for method in ["symplectic-euler", "leapfrog", "yoshida4", "rk4"] {
        for barrier in ["1e-25/x^2", "1e-40/x^4", "1e-60/x^12", "1e-20/(x + 0.3)^2"] {
            let said = passage(method, barrier);
            assert!(
                said.as_ref().is_some_and(|said| said.contains("steps over a pole of the law")),
                "{method} {barrier}: {said:?}"
            );
        }
        for harmless in ["sin(x)/x", "(1 - cos(x))/x^2", "1e-25/(x - 10)^2", "1/(1 + x^2)"] {
            assert_eq!(passage(method, harmless), None, "{method} {harmless}");
        }
    }
}

/// Equal steps of which one ends on a pole to all digits: 1 − 10 · 0.1 is 1e-16.
#[test]
fn a_step_that_ends_on_a_pole_is_an_error_there() {
    for method in ["symplectic-euler", "leapfrog", "rk4"] {
        for (potential, reached) in [("1e-6/x^2", true), ("-1e-3/x", true), ("sin(x)/x", false)] {
            let text = format!(
                "[coordinates]\nx = {{ initial = 1.0, velocity = -1.0 }}\n[lagrangian]\nL = \"1/2*x'^2 - 1e-15*({potential})\""
            );
            let mut experiment = by(method, Some(0.1), &text);
            if !reached {
                run(&mut experiment, 2.0);
                continue;
            }
            let message = error(experiment, 2.0);
            let place = "a force is no longer finite at t = 1, x = ";
            assert!(message.contains(place), "{method} {potential}: {message}");
        }
    }
}

/// A velocity that turns while another coordinate passes what is no pole is changed by much of itself, and not by a pole.
#[test]
fn a_velocity_that_turns_beside_a_zero_is_no_pole() {
    let text = "[coordinates]\nx = { initial = 1.0, velocity = 0.0 }\ny = { initial = -0.004, velocity = 0.9999 }\n[lagrangian]\n\
                L = \"1/2*(x'^2 + y'^2) - 1/2*(x^2 + y^2) - 1e-9*(1 - cos(x))/x^2\"";
    for step in [0.01, 0.1] {
        let mut experiment = by("rk4", Some(step), text);
        run(&mut experiment, 30.0);
        assert_eq!(experiment.narrow_passage(), None, "{step}");
    }
}

/// A force without bound at a kink that the motion passes, as |x|^−0.3: what the digits of a place beside it make of the force is no
/// rounding that a step may err by. The period from rest at 1 is 4 √π Γ(1 + 1/a)/(√2 Γ(½ + 1/a)).
#[test]
fn a_force_without_bound_at_a_kink_is_no_rounding() {
    // Γ(1 + 1/a) and Γ(½ + 1/a)
    for (power, gammas) in [
        ("0.7", [1.265_823_506_057_283_3, 0.971_874_550_668_194_6]),
        ("0.5", [2.0, 1.329_340_388_179_137]),
    ] {
        let text = format!(
            "[coordinates]\nx = {{ initial = 1.0 }}\n[lagrangian]\nL = \"1/2*x'^2 - abs(x)^{power}\""
        );
        let period = 4.0 * (std::f64::consts::PI / 2.0).sqrt() * gammas[0] / gammas[1];
        for method in ["taylor", "dop853"] {
            let mut experiment = by(method, None, &text);
            if experiment.advance(2.0 * period, PLENTY) == AdvanceOutcome::Arrived {
                let x = value(&experiment, "x");
                assert!((x - 1.0).abs() < 1e-5, "{method} {power}: {x}");
            } else {
                // it says so
                assert_eq!(method, "dop853", "{power}");
                assert!(matches!(experiment.status(), Status::Failed(_)));
            }
        }
    }
}

/// Where the law on both sides of a kink leads to it the motion follows it, by dop853 as well; after however long a rest it passes
/// the others.
#[test]
fn what_follows_a_kink_is_known_by_the_forces_on_its_sides() {
    let law = |x: f64, force: &str| {
        format!(
            "[coordinates]\nx = {{ initial = {x}, velocity = 0.0 }}\n[lagrangian]\nL = \"1/2*x'^2\"\nforces = {{ x = \"{force}\" }}\n"
        )
    };
    // x' = −x/2 from where t = ½ (1 − ½t²) on
    let sliding = law(1.0, "-sign(x' + 0.5*x)");
    let (mut exact, mut other) = (file(&sliding), by("dop853", None, &sliding));
    run(&mut exact, 4.0);
    run(&mut other, 4.0);
    let begin = 6.0_f64.sqrt() - 2.0;
    let expected = (1.0 - 0.5 * begin * begin) * (-(4.0 - begin) / 2.0).exp();
    assert!((value(&exact, "x") - expected).abs() < 1e-13, "{}", value(&exact, "x"));
    assert!((value(&other, "x") - expected).abs() < 1e-11, "{}", value(&other, "x"));
    let passing = law(0.0, "-max(0, min(1, t - 1e4))*sign(x - 1)");
    let mut exact = file(&passing);
    let mut other = by("dop853", None, &passing);
    for time in [1e4, 1e4 + 3.0, 1e4 + 12.0] {
        run(&mut exact, time);
        run(&mut other, time);
        let [exact, other] = [&exact, &other].map(|motion| value(motion, "x"));
        // the clock tells times of 1e4 apart to 2e-12
        assert!((exact - other).abs() < 1e-9, "{time}: {exact} and {other}");
    }
}

/// The time in a message.
fn error_time(message: &str) -> f64 {
    let (_, rest) = message.split_once(" t = ").expect("a time");
    rest.split([',', ':']).next().expect("a number").parse().expect("a number")
}

/// Friction that grows without bound towards rest has no strength there: the motion ends, for every method that chooses its
/// steps, where v² = 1 − 2t has reached zero.
#[test]
fn a_pole_of_friction_ends_the_motion() {
    let text = "[coordinates]\nx = { initial = 0.0, velocity = 1.0 }\n[lagrangian]\nL = \"1/2*x'^2\"\nforces = { x = \"-1/x'\" }";
    for method in ["taylor", "dop853"] {
        let message = error(by(method, None, text), 3.0);
        assert!((error_time(&message) - 0.5).abs() < 1e-10, "{method}: {message}");
        assert!(!message.contains("passes it"), "{method}: {message}");
    }
}

/// An oscillator under a force 0.3 sign(sin(ωt)), from x = 1 at rest, at a time: an arc of a circle about ±0.3 between one jump and
/// the next.
fn pushed(omega: f64, time: f64) -> f64 {
    let (mut x, mut v, mut begin, mut centre) = (1.0_f64, 0.0_f64, 0.0_f64, 0.3_f64);
    let mut jumps = 0_u32;
    while begin < time {
        jumps += 1;
        let end = (f64::from(jumps) * std::f64::consts::PI / omega).min(time);
        let (sin, cos) = (end - begin).sin_cos();
        (x, v) = (centre + (x - centre) * cos + v * sin, v * cos - (x - centre) * sin);
        (begin, centre) = (end, -centre);
    }
    x
}

/// A force that jumps at times leads nowhere back: no motion sticks there, however the last digits of these times are rounded.
#[test]
fn no_motion_sticks_where_a_force_jumps_at_a_time() {
    for omega in [0.5, 1.0, 3.5, 6.9, 8.4, 10.0] {
        let text = format!(
            "[coordinates]\nx = {{ initial = 1.0, velocity = 0.0 }}\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n\
             forces = {{ x = \"0.3*sign(sin({omega}*t))\" }}\n"
        );
        for method in ["dop853", "taylor"] {
            let mut motion = by(method, None, &text);
            run(&mut motion, 100.0);
            let off = value(&motion, "x") - pushed(omega, 100.0);
            assert!(off.abs() < 1e-9, "{method} at {omega}: {off:e}");
        }
    }
}

/// What jumps at times that a law is written with is seen by every method, as the same events.
#[test]
fn jumps_are_the_same_events_for_every_method() {
    let text = "[coordinates]\nx = { initial = 1.0, velocity = 0.0 }\n[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\n\
                forces = { x = \"0.3*sign(sin(t))\" }\n\
                [[events]]\nname = \"half\"\nwhen = \"x - 0.5\"\n\
                [[events]]\nname = \"push\"\nwhen = \"sign(sin(t))\"\n\
                [[events]]\nname = \"free\"\nwhen = \"x''\"\n";
    let events = |method: &str| {
        let mut motion = by(method, None, text);
        run(&mut motion, 30.0);
        let found = motion.occurrences().iter();
        found.map(|found| (found.name.clone(), found.time)).collect::<Vec<_>>()
    };
    let (exact, other) = (events("taylor"), events("dop853"));
    assert_eq!(exact.iter().filter(|(name, _)| name == "push").count(), 9);
    assert_eq!(exact.len(), other.len(), "{exact:?} and {other:?}");
    for of in ["half", "push", "free"] {
        let times = |events: &[(String, f64)]| -> Vec<f64> {
            events.iter().filter(|(name, _)| name == of).map(|(_, time)| *time).collect()
        };
        for (one, another) in times(&exact).iter().zip(&times(&other)) {
            assert!((one - another).abs() < 1e-8, "{of}: {one} and {another}");
        }
    }
}

/// A sleigh on a slope beside its comparison motion, whose f reaches π/2, where the row of y' = x' tan f has a pole, before that
/// of the sleigh does. The comparison motion is that of H = ½ (p_x cos f + p_y sin f)² + p_f²/0.6 + y/2, which is smooth there.
#[test]
fn a_singular_configuration_of_the_comparison_motion_is_called_its_own() {
    let sleigh = "[coordinates]\nx = { initial = 0, velocity = 0.5 }\ny = { initial = 0 }\nf = { initial = 0.3, velocity = 1.1 }\n\
                  [lagrangian]\nL = \"1/2*(x'^2 + y'^2) + 0.15*f'^2 - 0.5*y\"\n\
                  [[constraints]]\nname = \"edge\"\nexpression = \"y' - x'*tan(f)\"\n";
    let both = format!("{sleigh}[comparison]\neliminate = [\"y\"]\n");
    let smooth = "[coordinates]\nx = { initial = 0, momentum = \"0.5/cos(0.3)^2\" }\ny = { initial = 0, momentum = 0 }\n\
                  f = { initial = 0.3, momentum = 0.33 }\n\
                  [hamiltonian]\nH = \"1/2*(p_x*cos(f) + p_y*sin(f))^2 + p_f^2/0.6 + 1/2*y\"\n";
    let message = error(file(&both), 1.1);
    assert!(message.starts_with("the motion of [comparison]: "), "{message}");
    let time = error_time(&message);
    let mut other = file(smooth);
    run(&mut other, time);
    assert!((value(&other, "f") - std::f64::consts::FRAC_PI_2).abs() < 1e-9, "{message}");
    assert!(message.contains("f (wrong) = 1.5707963267"), "{message}");
    let x = message.split("x (wrong) = ").nth(1).and_then(|rest| rest.split(',').next());
    let x: f64 = x.and_then(|x| x.parse().ok()).expect("a place");
    assert!((x - value(&other, "x")).abs() < 1e-9, "{message}");

    for method in ["dop853", "rk4"] {
        let passed = "the motion of [comparison] passed a singular configuration of its constraints at t = 1.021";
        let until = |until: &str| said(&both, &["--until", until, "--method", method]);
        assert!(until("1.1").contains(passed), "{method}: {}", until("1.1"));
        assert!(!until("1").contains("comparison"), "{method}: {}", until("1"));
    }
    // the motion itself comes to its own at t = (π/2 − 0.3)/1.1
    let message = error(file(sleigh), 1.3);
    assert!((error_time(&message) - (std::f64::consts::FRAC_PI_2 - 0.3) / 1.1).abs() < 1e-9);
    assert!(!message.contains("comparison"), "{message}");
}

/// At an essential singularity of the law every number of steps ends before it, which is known after 131,072 of them. What lies
/// before it is computed, and a pole that is no such singularity is named as ever.
#[test]
fn an_essential_singularity_is_reported_where_steps_never_arrive() {
    let driven = |drive: &str| {
        format!(
            "[coordinates]\nx = {{ initial = 0.3, velocity = 0.1 }}\n[lagrangian]\nL = \"1/2*x'^2 - x*{drive}\"\n"
        )
    };
    for drive in ["sin(1/(1 - t))", "sin(exp(1/(1 - t)))"] {
        let message = error(file(&driven(drive)), 2.0);
        assert!(message.starts_with("no number of steps reaches t = 1:"), "{drive}: {message}");
        assert!(message.contains("essential singularity"), "{drive}: {message}");
        run(&mut file(&driven(drive)), 0.9);
    }
    let message = error(file(&driven("1/(1 - t)")), 2.0);
    assert!(!message.contains("essential"), "{message}");
    let stop = "[[events]]\nname = \"near\"\nwhen = \"t - 0.999997\"\naction = \"stop\"\n";
    let mut stopped = file(&format!("{}{stop}", driven("sin(1/(1 - t))")));
    stopped.advance(2.0, PLENTY);
    assert!((stopped.snapshot().time - 0.999997).abs() < 1e-15, "{:?}", stopped.status());
}

/// The narrow passage of x″ = −x/((t − 1)⁴ + ε) takes tens of thousands of steps, each shorter than the last, and is passed. What leads
/// over it is the same backwards in time: of the motions that begin with x = 1 and with y′ = 1 the first ends where the
/// velocity of the second does, and x y′ − x′ y stays 1.
#[test]
fn a_narrow_passage_is_no_essential_singularity() {
    let mut narrow = file(
        "[coordinates]\nx = { initial = 1, velocity = 0 }\ny = { initial = 0, velocity = 1 }\n\
         [lagrangian]\nL = \"1/2*(x'^2 + y'^2) - 1/2*(x^2 + y^2)/((t - 1)^4 + 1e-20)\"\n",
    );
    run(&mut narrow, 1.0);
    assert!(narrow.snapshot().method.steps > 16_384);
    run(&mut narrow, 2.0);
    let [x, y, vx, vy] = ["x", "y", "x'", "y'"].map(|name| value(&narrow, name));
    assert!((x - vy).abs() < 1e-9 * x.abs(), "{x} {vy}");
    assert!((x * vy - vx * y - 1.0).abs() < 1e-9, "{x} {y} {vx} {vy}");
}
