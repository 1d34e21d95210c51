//! Initial states and singular points of constraints: valid starts are accepted, inconsistent ones are refused, and
//! a point at which motions branch is reported.

use phaselab::experiment::{Experiment, Setup, Status};

use crate::experiment::{build, run, value};

/// A pin straight above or beside a block: `expression` contains x and the angle w.
fn pin(x: &str, w: &str, expression: &str) -> String {
    format!(
        "title = 'pin'\n[coordinates]\nx = {{ initial = '{x}' }}\n\
         w = {{ initial = '{w}', velocity = 0.5 }}\n\
         [lagrangian]\nL = \"1/2*x'^2 + 1/2*w'^2\"\n\
         [[constraints]]\nname = 'pin'\nexpression = '{expression}'\n"
    )
}

fn error(experiment: &Experiment) -> Option<String> {
    match experiment.status() {
        Status::Failed(error) => Some(error.message),
        _ => None,
    }
}

fn begins(text: &str) -> bool {
    let refused = error(&build(text, |_| ()));
    let off = |why: &String| why.contains("do not keep the constraint `pin`");
    assert!(refused.as_ref().is_none_or(off), "{refused:?}");
    refused.is_none()
}

fn by(method: &str) -> impl FnOnce(&mut Setup) {
    let (method, fixed) = (method.to_owned(), ["rk4", "leapfrog"].contains(&method));
    move |setup| {
        setup.method = method;
        setup.settings.step = fixed.then_some(0.01);
    }
}

#[test]
fn a_start_where_all_terms_of_a_constraint_are_rounding_is_valid() {
    let valid = [
        ("0", "pi", "x + sin(w)"),
        ("0", "-3*pi", "x + sin(w)"),
        ("0", "pi/2", "x - cos(w)"),
        ("0", "pi", "x + 1e-9*sin(w)"),
        ("0", "pi", "x + 1e12*sin(w)"),
        ("0", "pi/4", "x + sin(w) - cos(w)"),
        ("0", "3.141592653589793", "x + sin(w)"),
        ("1.2e-16", "3.141592653589793", "x + sin(w)"),
    ];
    for (x, w, expression) in valid {
        let text = pin(x, w, expression);
        assert!(begins(&text), "{x} {w} {expression}");
        // with x' = 5e11 w races to 3π/2, for which no fixed step is small enough
        let all = ["taylor", "dop853", "rk4"];
        for method in &all[..if expression.contains("e12") { 1 } else { 3 }] {
            let mut pinned = build(&text, by(method));
            run(&mut pinned, 2.0);
            let worst = pinned.snapshot().gauges.iter().map(|g| g.drift.abs()).fold(0.0, f64::max);
            assert!(worst < 1e-6, "{method} {expression}: {worst:e}");
        }
    }
}

#[test]
fn a_start_off_by_more_than_rounding_is_refused_in_any_units() {
    // the tolerance is 4 ε of what the angle moves, π; and 1e-9 of the terms, which vanish
    assert!(begins(&pin("2.7e-15", "pi", "x + sin(w)")));
    assert!(!begins(&pin("2.9e-15", "pi", "x + sin(w)")));
    assert!(begins(&pin("2.7e-24", "pi", "x + 1e-9*sin(w)")));
    assert!(!begins(&pin("2.9e-24", "pi", "x + 1e-9*sin(w)")));
    assert!(!begins(&pin("1e-9", "pi/2", "x - cos(w)")));
    // of terms that do not vanish 1e-9
    assert!(begins(&pin("1 + 1.9e-9", "pi/2", "x - sin(w)")));
    assert!(!begins(&pin("1 + 2.1e-9", "pi/2", "x - sin(w)")));
    assert!(begins(&pin("1e12*(1 + 1.9e-9)", "pi/2", "x - 1e12*sin(w)")));
    assert!(!begins(&pin("1e12*(1 + 2.1e-9)", "pi/2", "x - 1e12*sin(w)")));
}

#[test]
fn the_solution_of_a_pin_at_pi_is_that_of_one_angle() {
    // (1 + cos² w) w'' = sin w cos w w'², so (1 + cos² w) w'² is constant
    let mut pinned = build(&pin("0", "pi", "x + sin(w)"), |_| ());
    run(&mut pinned, 7.0);
    let (x, w, rate) = (value(&pinned, "x"), value(&pinned, "w"), value(&pinned, "w'"));
    assert!((x + w.sin()).abs() < 1e-15);
    assert!(((1.0 + w.cos().powi(2)) * rate * rate - 0.5).abs() < 1e-14);
}

/// A four-bar linkage as a parallelogram, which is collinear at a = 0.
fn parallelogram(law: &str) -> String {
    format!(
        "title = 'parallelogram'\n[coordinates]\na = {{ initial = 1, velocity = -1 }}\n\
         p = {{ initial = 0 }}\nb = {{ initial = 1 }}\n[lagrangian]\nL = \"{law}\"\n\
         [[constraints]]\nname = 'x'\nexpression = 'cos(a) + 2*cos(p) - 2 - cos(b)'\n\
         [[constraints]]\nname = 'y'\nexpression = 'sin(a) + 2*sin(p) - sin(b)'\n"
    )
}

#[test]
fn a_singular_configuration_that_is_passed_is_reported_each_time() {
    let free = "1/2*(a'^2 + b'^2 + p'^2)";
    for method in ["taylor", "dop853", "rk4"] {
        let mut bars = build(&parallelogram(free), by(method));
        bars.advance(0.9, 100_000);
        assert_eq!(bars.singular_passages(), None, "{method}");
        // a = 1 − t vanishes at 1 and is −π at 1 + π
        bars.advance(6.0, 100_000);
        let Some(reported) = bars.singular_passages() else {
            panic!("{method}: {:?}", bars.status())
        };
        assert!(
            reported.contains("t = 1") || reported.contains("t = 0.99"),
            "{method}: {reported}"
        );
        if error(&bars).is_none() {
            assert!(reported.contains("and 1 more"), "{method}: {reported}");
        }
    }
    let cross = "title = 'cross'\n[coordinates]\nx = { initial = -1, velocity = 1 }\n\
                 y = { initial = -1 }\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2)\"\n\
                 [[constraints]]\nname = 'lines'\nexpression = 'x^2 - y^2'\n";
    let mut cross = build(cross, |_| ());
    run(&mut cross, 3.0);
    assert!(cross.singular_passages().is_some_and(|reported| reported.contains("t = 1")));
    assert!(cross.snapshot().notices.iter().any(|n| n.contains("singular configuration")));
}

#[test]
fn a_constraint_that_turns_fast_is_not_taken_for_a_singular_one() {
    let rod = "title = 'rod'\n[coordinates]\nx = { initial = 1, velocity = 0 }\n\
               y = { initial = 0, velocity = 40 }\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2) - y\"\n\
               [[constraints]]\nname = 'rod'\nexpression = 'x^2 + y^2 - 1'\n";
    for step in [None, Some(0.05)] {
        let mut rod = build(rod, |setup| {
            if step.is_some() {
                "rk4".clone_into(&mut setup.method);
                setup.settings.step = step;
            }
        });
        rod.advance(5.0, 100_000);
        assert_eq!(rod.singular_passages(), None, "{step:?}");
    }
}

#[test]
fn which_constraints_repeat_others_does_not_depend_on_units() {
    // two directions that differ by a right angle, in units of 1e12
    let text = |scale: &str| {
        format!(
            "title = 'two'\n[coordinates]\nx = {{ initial = 0 }}\ny = {{ initial = 0 }}\n\
             z = {{ initial = 0, velocity = 1 }}\n\
             [lagrangian]\nL = \"1/2*(x'^2 + y'^2 + z'^2)\"\n\
             [[constraints]]\nname = 'one'\nexpression = '{scale}*x + y - z'\n\
             [[constraints]]\nname = 'two'\nexpression = '{scale}*x + 2*y - z'\n"
        )
    };
    for scale in ["1", "1e12", "1e-12"] {
        let two = build(&text(scale), |_| ());
        assert!(two.system().redundant().is_empty(), "{scale}");
        let twice = text(scale).replace("2*y - z", "y - z");
        assert_eq!(build(&twice, |_| ()).system().redundant(), ["two"], "{scale}");
    }
}

#[test]
fn an_interval_that_a_parameter_makes_none_is_an_error() {
    let text = "title = 'kicked'\n[coordinates]\nx = { initial = 0 }\n[parameters]\n\
                T = { value = 1, min = -1 }\n[lagrangian]\nL = \"1/2*x'^2\"\n[[impulses]]\nname = 'kick'\n\
                every = 'T'\nchange = { p_x = 1 }\n";
    for (interval, stops) in [(1e-3, false), (0.0, true), (-1.0, true)] {
        let mut kicked = build(text, |setup| setup.parameters[0] = interval);
        kicked.advance(0.0105, 100_000);
        let why = error(&kicked);
        assert_eq!(why.is_some(), stops, "{interval}: {why:?}");
        assert!(why.is_none_or(|why| why.contains("the impulse `kick` cannot act every")));
    }
}

#[test]
fn a_clock_without_digits_is_an_error_and_no_endless_loop() {
    let text = "title = 'late'\n[coordinates]\nx = { initial = 1 }\n[lagrangian]\n\
                L = \"1/2*x'^2 - 1/2*x^2\"\n[run]\nstart = 1e19\n";
    let mut late = build(text, |_| ());
    late.advance(1e19 + 1e7, 10_000);
    assert!(error(&late).is_some(), "{:?} at {}", late.status(), late.time());
    // equal steps can be counted beyond the digits of the time: at the least, the run is bounded
    for method in ["rk4", "leapfrog"] {
        let mut late = build(text, by(method));
        late.advance(1e19 + 1e7, 1000);
        assert!(late.time() < 1e19 + 1e7, "{method}");
    }
    let kicked = "title = 'kicked'\n[coordinates]\nx = { initial = 0 }\n[lagrangian]\nL = \"1/2*x'^2\"\n\
                  [[impulses]]\nname = 'kick'\nevery = 1e-6\nchange = { p_x = 1e-9 }\n";
    let mut kicked = build(kicked, |_| ());
    kicked.advance(1000.0, 5000);
    assert!(kicked.occurrences().count() <= 5000, "what happens is part of the budget");
    assert!(kicked.occurrences().count() > 1000);
}
