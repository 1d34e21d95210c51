//! Laws whose parameters change with the time, written with the parameter's symbol: against equations by hand, and against the
//! same law with the ramp's function written out, at random states and times.

use std::collections::HashMap;

use phaselab::cancel::Cancel;
use phaselab::diagnostic::Document;
use phaselab::expr::{Expr, Pool};
use phaselab::mechanics::{self, Equations, Further, NamedRamps};
use phaselab::model::Model;

const RAMP: &str =
    "[[ramps]]\nparameter = \"l\"\nto = 3\nstart = 1\nduration = 4\nform = \"cubic\"\n";
const PENDULUM: &str = "title = \"t\"\n[coordinates]\nx = { initial = 0.3, velocity = 0.1 }\n[parameters]\nm = 1.5\ng = 9.0\nl = 2.0\n\
                        [lagrangian]\nL = \"1/2*m*l^2*x'^2 + m*g*l*cos(x)\"\n[[observables]]\nname = \"length\"\nexpression = \"l\"\n";
const STRING: &str = "title = \"t\"\n[coordinates]\nx = { initial = 2.0, velocity = 0.0 }\ny = { initial = 0.0, velocity = 1.0 }\n\
                      [parameters]\nm = 1.5\ng = 9.0\nl = 2.0\n[lagrangian]\nL = \"1/2*m*(x'^2 + y'^2) - m*g*y*l\"\n\
                      [[constraints]]\nname = \"string\"\nexpression = \"x^2 + y^2 - l^2\"\n";

fn derived(text: &str) -> (Model, Equations) {
    let model = Document::new("t", text).read().unwrap().model;
    let equations = mechanics::derive(&model).unwrap();
    (model, equations)
}

/// The value of an expression with these values of its symbols, by name.
fn value(pool: &Pool, e: Expr, at: &HashMap<&str, f64>) -> f64 {
    let of = |name: &str| *at.get(name).unwrap_or_else(|| panic!("{name} in {}", pool.text(e)));
    pool.evaluate(e, &|symbol| of(&pool.symbol_info(symbol).name))
}

/// States at times before, in and after the ramp: with the parameter's own value, and with the value and rates of the ramp.
fn states() -> Vec<[HashMap<&'static str, f64>; 2]> {
    let state = |(k, t): (usize, f64)| {
        let s = k as f64;
        let mut own = HashMap::from([("m", 1.5), ("g", 9.0), ("l", 2.0), ("t", t)]);
        own.insert("lambda_string", 0.8 - 0.3 * s);
        own.extend([
            ("x", 0.3 + 0.2 * s),
            ("y", 0.9 - 0.1 * s),
            ("x'", 0.5 - 0.3 * s),
            ("y'", 0.2 * s),
        ]);
        own.extend([("p_x", 0.7 - 0.2 * s), ("p_y", 0.4 + 0.1 * s)]);
        let u = ((t - 1.0) / 4.0).clamp(0.0, 1.0);
        let mut named = own.clone();
        named.insert("l", 2.0 + 3.0 * u * u - 2.0 * u.powi(3));
        named.insert("l'", 6.0 * (u - u * u) / 4.0);
        named.insert("l'''", if u > 0.0 && u < 1.0 { -12.0 / 64.0 } else { 0.0 });
        named.insert("l''", if u > 0.0 && u < 1.0 { 6.0 * (1.0 - 2.0 * u) / 16.0 } else { 0.0 });
        [own, named]
    };
    [0.2, 1.4, 2.6, 4.5, 6.0].into_iter().enumerate().map(state).collect()
}

fn compare(what: &str, written_out: (&Pool, &[Expr]), named: (&Pool, &[Expr])) {
    assert_eq!(written_out.1.len(), named.1.len(), "{what}");
    for (&e, &by_name) in written_out.1.iter().zip(named.1) {
        for [own, at] in states() {
            let (expected, found) = (value(written_out.0, e, &own), value(named.0, by_name, &at));
            let off = (found - expected).abs();
            assert!(off <= 1e-11 * (1.0 + expected.abs()), "{what}: {found} is not {expected}");
        }
    }
}

/// Everything that is shown of a law, by name and written out.
fn compare_all(written_out: &Equations, named: &NamedRamps) {
    let (pool, by_name) = (&written_out.pool, &named.equations);
    let pairs = [
        ("momenta", written_out.momenta.clone(), by_name.momenta.clone()),
        ("motion", written_out.solved.clone().unwrap(), by_name.solved.clone().unwrap()),
        ("λ", written_out.multipliers.clone().unwrap(), by_name.multipliers.clone().unwrap()),
        ("h", vec![written_out.energy], vec![by_name.energy]),
        ("dh/dt", vec![written_out.energy_rate], vec![by_name.energy_rate]),
        (
            "H",
            vec![written_out.hamiltonian.clone().unwrap()],
            vec![by_name.hamiltonian.clone().unwrap()],
        ),
    ];
    for (what, all, named) in &pairs {
        compare(what, (pool, all), (&by_name.pool, named));
    }
}

#[test]
fn a_ramped_law_is_written_with_the_parameter_and_its_rate() {
    let (_, equations) = derived(&format!("{PENDULUM}{RAMP}"));
    let named = equations.supplements.named_ramps.as_deref().expect("a law by name");
    compare_all(&equations, named);
    // by hand: d/dt(m l² ẋ) = −m g l sin x, so ẍ = −(2 l̇ ẋ + g sin x)/l; dh/dt = −∂L/∂t at fixed x and ẋ
    let by_hand = |at: &HashMap<&str, f64>| {
        let [x, v, l, rate] = ["x", "x'", "l", "l'"].map(|name| at[name]);
        let motion = -(2.0 * rate * v + 9.0 * x.sin()) / l;
        let energy = -rate * (1.5 * l * v * v + 1.5 * 9.0 * x.cos());
        [motion, energy]
    };
    let pool = &named.equations.pool;
    let motion = named.equations.solved.as_ref().unwrap()[0];
    for [_, at] in states() {
        let [x, energy] = by_hand(&at);
        assert!((value(pool, motion, &at) - x).abs() < 1e-12 * (1.0 + x.abs()));
        let found = value(pool, named.equations.energy_rate, &at);
        assert!((found - energy).abs() < 1e-12 * (1.0 + energy.abs()), "{found} {energy}");
    }
    assert_eq!(pool.text(named.equations.momenta[0]), "m*l^2*x'");
    // l(t) itself, once
    let [ramp] = named.model.ramped.named() else { panic!("one ramp") };
    let [progress] = ramp.progress[..] else { panic!("one part") };
    let [start, end] = progress.times.map(|e| value(&named.model.pool, e, &HashMap::new()));
    let name = named.model.pool.symbol_info(progress.symbol).name.clone();
    let at = HashMap::from([(name.as_str(), (2.0 - start) / (end - start)), ("l_i", 2.0)]);
    let length = value(&named.model.pool, ramp.function, &at);
    assert!((length - (2.0 + 3.0 / 16.0 - 2.0 / 64.0)).abs() < 1e-14, "{length}");
}

/// A holonomic constraint is differentiated twice, and so is its parameter.
#[test]
fn a_constraint_has_the_second_rate_of_its_parameter() {
    let (_, equations) = derived(&format!("{STRING}{RAMP}"));
    let named = equations.supplements.named_ramps.as_deref().expect("a law by name");
    compare_all(&equations, named);
    let pool = &named.equations.pool;
    let multiplier = named.equations.multipliers.as_ref().unwrap()[0];
    assert!(pool.symbols_of(multiplier).iter().any(|&s| pool.symbol_info(s).name == "l''"));
}

/// λ has l̈ in it, and its rate the third derivative.
#[test]
fn the_rate_of_a_multiplier_has_the_third_rate_of_its_parameter() {
    let tension = "[[observables]]\nname = \"tension\"\nexpression = \"lambda_string\"\n";
    let (model, mut equations) = derived(&format!("{STRING}{RAMP}{tension}"));
    let further = Further::of(&model, &mut equations);
    let (named, own) = NamedRamps::readable(&equations, &further).expect("a law by name");
    let rate = |further: &Further| {
        let classed = further.classes.iter().find(|classed| classed.name == "tension");
        *classed.expect("an observable").rate.as_ref().expect("a rate")
    };
    let (written_out, by_name) = (rate(&further), rate(&own));
    let pool = &named.equations.pool;
    let multiplier = named.equations.multipliers.as_ref().unwrap()[0];
    for [mut own, mut at] in states() {
        // on the constraint, with the λ that keeps it
        let ([l, rate, turning], (sin, cos)) = ([at["l"], at["l'"], 0.7], at["x"].sin_cos());
        let moved = [
            ("x", l * sin),
            ("y", l * cos),
            ("x'", rate * sin + turning * l * cos),
            ("y'", rate * cos - turning * l * sin),
        ];
        at.extend(moved);
        let tension = value(pool, multiplier, &at);
        at.insert("lambda_string", tension);
        own.extend(moved);
        own.insert("lambda_string", tension);
        let (expected, found) =
            (value(&equations.pool, written_out, &own), value(pool, by_name, &at));
        assert!((found - expected).abs() <= 1e-10 * (1.0 + expected.abs()), "{found}, {expected}");
    }
    assert!(pool.symbols_of(by_name).iter().any(|&s| pool.symbol_info(s).name == "l'''"));
}

/// What the progress of a ramp is called, and the value before it, means nothing else in the file.
#[test]
fn the_names_of_a_ramp_are_free() {
    let file = PENDULUM.replace(
        "[lagrangian]\nL = \"",
        "[definitions]\nu = \"m*l\"\nl_i = \"l^2\"\n[lagrangian]\nL = \"0*u*l_i + ",
    ) + "[[observables]]\nname = \"u2\"\nexpression = \"l\"\n";
    let (_, equations) = derived(&format!("{file}{RAMP}"));
    let named = equations.supplements.named_ramps.as_deref().expect("a law by name");
    let [ramp] = named.model.ramped.named() else { panic!("one ramp") };
    let pool = &named.model.pool;
    let mut names: Vec<&str> =
        pool.symbols_of(ramp.function).iter().map(|&s| pool.symbol_info(s).name.as_str()).collect();
    names.sort_unstable();
    assert_eq!(names, ["l_i2", "u3"]);
}

/// A motion needs the law with the functions of the time only; by name it is derived once somebody reads it. A cancelled
/// derivation is not taken for one that cannot be had.
#[test]
fn a_motion_is_derived_once_and_the_law_by_name_on_request() {
    let model = Document::new("t", format!("{PENDULUM}{RAMP}")).read().unwrap().model;
    let mut equations = mechanics::derive_for_motion(&model).unwrap();
    assert!(equations.supplements.named_ramps.is_none() && equations.has_pending_forms());
    let cancel = Cancel::new();
    cancel.cancel();
    equations.pool.set_cancel(cancel);
    equations.find_closed_forms();
    assert!(equations.supplements.named_ramps.is_none() && equations.has_pending_forms());
    equations.pool.set_cancel(Cancel::new());
    equations.find_closed_forms();
    assert!(equations.supplements.named_ramps.is_some() && !equations.has_pending_forms());
}

#[test]
fn what_is_said_by_name_is_true_of_the_ramp() {
    // no ramp, nothing to be named; and a transformation is derived with the function itself
    assert!(derived(PENDULUM).1.supplements.named_ramps.is_none());
    let map = "[[transformations]]\nname = \"a\"\nkind = \"F2\"\nF = \"x*P/l\"\n";
    assert!(derived(&format!("{PENDULUM}{RAMP}{map}")).1.supplements.named_ramps.is_none());
    // the energy is not conserved by name, although l̇ = 0 before the ramp
    let (_, equations) = derived(&format!("{PENDULUM}{RAMP}"));
    assert!(equations.supplements.named_ramps.as_ref().unwrap().equations.conserved.is_empty());
    // a momentum that no ramp touches is
    let free = "title = \"t\"\n[coordinates]\nx = 0.0\n[parameters]\nl = 2.0\n[lagrangian]\nL = \"1/2*l*x'^2\"\n";
    let (_, equations) = derived(&format!("{free}{RAMP}"));
    let named = equations.supplements.named_ramps.as_ref().unwrap();
    let names: Vec<&str> = named.equations.conserved.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["p_x"]);
}
