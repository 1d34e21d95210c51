//! The search for constants of the motion in the lab: the page of equations asks for it, gauges follow what it finds, and
//! a change of a parameter takes back what no longer holds.

use std::time::Duration;

use phaselab::app::{App, AppEvent, Asker, Computation, Effect, Page};
use phaselab::experiment::{Command, Gauge};
use phaselab::job::Progress;

use super::real::Real;
use crate::fixtures::{lab, lowered, press};
use crate::screen;

fn kepler(parameters: &str, exponent: &str) -> String {
    format!(
        "title = \"Kepler\"\n[coordinates]\nx = {{ initial = 1.0, momentum = 0.0 }}\n\
         y = {{ initial = 0.0, momentum = 1.2 }}\n[parameters]\n{parameters}\n[hamiltonian]\n\
         H = \"1/2*(p_x^2 + p_y^2) - k/sqrt(x^2 + y^2){exponent}\"\n"
    )
}

fn summary(app: &App) -> String {
    let lab = app.lab.as_ref().expect("a lab");
    lab.findings().expect("a search").expect("it can be searched").summary.clone()
}

fn found(real: &Real) -> Vec<Gauge> {
    real.seen().gauges.iter().filter(|g| g.reason.starts_with("found")).cloned().collect()
}

#[test]
fn what_is_found_becomes_a_gauge_with_its_reason() {
    let mut real = Real::with(lowered(&kepler("k = 1.0", "")));
    assert!(found(&real).is_empty() && real.lab().findings().is_none());
    real.press("2");
    let reported = summary(&real.app);
    assert!(
        reported.starts_with("superintegrable: 3 independent")
            && reported.ends_with("every bounded orbit closes"),
        "{reported}"
    );
    let gauges = found(&real);
    assert!(!gauges.is_empty());
    for gauge in &gauges {
        assert_eq!(gauge.reason, "found at degree 2, proved");
        assert!(gauge.proved);
    }
    // the Runge–Lenz vector of the start: p_y L − x/r = 1.44 − 1 along x, 0 along y
    let values: Vec<f64> = gauges.iter().map(|g| g.value.abs()).collect();
    assert!(values.iter().any(|v| (v - 0.44).abs() < 1e-12), "{values:?}");
    real.press("1");
    real.run(600);
    for gauge in found(&real) {
        assert!(gauge.max_drift < 1e-12, "{} {}", gauge.name, gauge.max_drift);
    }
    // a reset keeps the gauges and takes them anew
    real.press("r");
    assert_eq!(found(&real).len(), gauges.len());
}

/// A gauge of what is no constant would be seen to drift: the same formula where the force is another.
#[test]
fn a_followed_formula_that_is_no_constant_drifts() {
    let mut real = Real::with(lowered(&kepler("k = 1.0", "")));
    real.press("2");
    let text = {
        let findings = real.lab().findings().unwrap().unwrap();
        findings.equations.pool.text(findings.invariants.found[0].expression)
    };
    let mut other = Real::with(lowered(&kepler("k = 1.0", "^2")));
    other.experiment.execute(Command::Follow(vec![phaselab::experiment::FoundConstant {
        name: "I1".to_owned(),
        shown: "I₁".to_owned(),
        expression: text,
        reason: "found by mistake".to_owned(),
        proved: false,
    }]));
    other.look();
    other.run(60);
    assert!(found(&other)[0].max_drift > 1e-3, "{}", found(&other)[0].max_drift);
}

/// Beside the moments I₁ and I₃ of a top a constant I₁ would be taken for one of them.
#[test]
fn what_is_found_has_a_name_that_the_file_does_not_use() {
    let mut real = Real::of("sleeping-top");
    real.press("2 4");
    let found = found(&real);
    assert!(!found.is_empty());
    let model = &real.lab().loaded.model;
    let parameters: Vec<&str> = model.parameters.iter().map(|p| p.shown.as_str()).collect();
    assert!(parameters.contains(&"I₁") && parameters.contains(&"I₃"), "{parameters:?}");
    for gauge in &found {
        assert!(!gauge.shown.starts_with('I'), "{} beside {parameters:?}", gauge.shown);
        let findings = real.lab().findings().expect("a search").expect("it can be searched");
        assert!(findings.names.contains(&gauge.shown), "{:?}", findings.names);
    }
    let mut kepler = Real::with(lowered(&self::kepler("k = 1.0", "")));
    kepler.press("2");
    assert_eq!(self::found(&kepler)[0].shown, "I₁");
}

#[test]
fn where_nothing_else_is_the_line_says_so_and_how_far() {
    let text = "title = \"Hénon–Heiles\"\n[coordinates]\nx = { initial = 0.1, momentum = 0.1 }\n\
                y = { initial = 0.2, momentum = 0.0 }\n[hamiltonian]\n\
                H = \"1/2*(p_x^2 + p_y^2 + x^2 + y^2) + x^2*y - 1/3*y^3\"\n";
    let mut real = Real::with(lowered(text));
    real.press("2");
    assert_eq!(summary(&real.app), "only E found, up to degree 4 (proved)");
    assert!(found(&real).is_empty());
    // further: two degrees beyond
    real.press("I");
    let findings = real.lab().findings().expect("a search").expect("it can be searched");
    assert_eq!(findings.invariants.none_up_to, Some(6));
    assert_eq!(summary(&real.app), "only E found, up to degree 6 (proved)");
}

#[test]
fn another_value_of_a_parameter_is_another_question() {
    let text = "title = \"springs\"\n[coordinates]\nx = { initial = 1.0, momentum = 0.0 }\n\
                y = { initial = 0.0, momentum = 1.2 }\n[parameters]\n\
                a = { value = 1.0, min = 0.0, max = 4.0 }\nb = 1.0\n[hamiltonian]\n\
                H = \"1/2*(p_x^2 + p_y^2) + 1/2*a*x^2 + 1/2*b*y^2\"\n";
    let mut real = Real::with(lowered(text));
    real.press("2");
    assert!(summary(&real.app).starts_with("superintegrable"), "{}", summary(&real.app));
    let here = found(&real);
    real.press("1");
    assert!(here.iter().any(|g| g.reason.ends_with("proved at these parameters")));
    real.experiment.execute(Command::Parameter { index: 0, value: 1.7 });
    let snapshot = std::sync::Arc::new(real.experiment.snapshot());
    let effects = real.app.update(AppEvent::Snapshot(snapshot));
    real.execute(effects);
    real.press("1");
    // what held at the other value is gone; what holds for all values stays
    let left = found(&real);
    assert!(left.iter().all(|g| g.reason.ends_with(", proved")), "{left:?}");
    assert!(left.len() < here.len() && real.lab().findings().is_none());
    real.press("2");
    assert!(summary(&real.app).starts_with("integrable: 2 invariants in involution"));
}

/// The searches for constants that these keys begin.
fn searches(app: &mut App, keys: &str) -> Vec<Computation> {
    let computed = press(app, keys).into_iter().filter_map(|effect| match effect {
        Effect::Compute(computation) => Some(computation),
        _ => None,
    });
    computed.filter(|computation| computation.asker == Asker::Search).collect()
}

#[test]
fn the_search_is_a_job_with_a_budget_that_can_be_stopped() {
    let mut app = lab("henon-heiles", 0.0);
    app.jobs.in_background = true;
    let [computation] = &searches(&mut app, "2")[..] else { panic!("one search") };
    assert_eq!(computation.job.budget, Some(Duration::from_secs(1)));
    let stopped = press(&mut app, "Esc");
    assert_eq!(stopped, [Effect::StopComputing(Asker::Search)]);
    assert_eq!(app.page, Page::Equations);
    // it is not begun again by itself, and I begins it
    assert!(searches(&mut app, "1 2").is_empty());
    let [computation] = &searches(&mut app, "I")[..] else { panic!("one search") };
    // a job whose budget is spent ends with what it has, and claims nothing beyond
    let progress = Progress::new();
    progress.spend();
    let (ticket, outcome) = (computation.ticket, computation.job.run(&progress));
    app.update(AppEvent::Computed { ticket, outcome });
    let findings = app.lab.as_ref().unwrap().findings().unwrap().unwrap();
    assert_eq!(findings.invariants.none_up_to, None);
    assert!(findings.invariants.ended.is_some() && !findings.summary.contains("proved"));
}

#[test]
fn what_cannot_be_searched_says_why() {
    let text = "title = \"bounce\"\n[coordinates]\nx = { initial = 1.0, momentum = 0.0 }\n\
                [hamiltonian]\nH = \"1/2*p_x^2 + abs(x)\"\n";
    let mut real = Real::with(lowered(text));
    real.press("2");
    let why = real.lab().findings().expect("an answer").expect_err("a kink");
    assert!(why.contains("no search is made through `abs`"), "{why}");
    real.press("I 1 2 B B");
}

/// Numbers in units of SI are no short fractions, and their products are rounded: what is searched takes them as it takes
/// parameters of the same values.
#[test]
fn numbers_of_the_file_are_searched_like_parameters() {
    let head = "title = \"Hydrogen\"\n[coordinates]\nx = { initial = 5.29e-11, momentum = 0.0 }\n\
                y = { initial = 0.0, momentum = 1.7e-24 }\n";
    let law = "[hamiltonian]\nH = \"(p_x^2 + p_y^2)/(2*M) - K/sqrt(x^2 + y^2)\"\n";
    let literals = law.replace('M', "9.1093837e-31").replace('K', "2.3070775e-28");
    let named = format!("{head}[parameters]\nM = 9.1093837e-31\nK = 2.3070775e-28\n{law}");
    let of = |text: &str| {
        let mut real = Real::with(lowered(text));
        real.press("2");
        let gauges: Vec<(String, bool)> =
            found(&real).into_iter().map(|g| (g.reason, g.proved)).collect();
        let reported = summary(&real.app);
        (reported, gauges)
    };
    let by_name = of(&named);
    assert!(by_name.0.starts_with("superintegrable: 3 independent"), "{by_name:?}");
    let literal = of(&format!("{head}{literals}"));
    assert_eq!(literal, by_name);
    assert!(literal.1.iter().all(|(_, proved)| *proved), "{literal:?}");
}

/// Page 2 is long: it opens at the answer, and stays there until it is scrolled.
#[test]
fn page_two_opens_at_what_was_asked_for() {
    let text = "title = \"Kepler\"\n[coordinates]\nx = { initial = 1.0, momentum = 0.0 }\n\
                y = { initial = 0.0, momentum = 1.2 }\n[hamiltonian]\n\
                H = \"1/2*(p_x^2 + p_y^2) - 1/sqrt(x^2 + y^2)\"\n";
    let mut real = Real::with(lowered(text));
    let shown = |real: &Real| {
        screen::rows(&screen::screen(&real.app, &screen::rich(), (80, 12))).join("\n")
    };
    for (keys, seen) in [("I", "Further constants of the motion"), ("B", "Brackets")] {
        real.press(keys);
        assert!(shown(&real).contains(seen), "{keys}\n{}", shown(&real));
    }
    real.press("1 2");
    let top = shown(&real);
    assert!(!top.contains("Brackets") && !top.contains("Further constants"), "{top}");
}
