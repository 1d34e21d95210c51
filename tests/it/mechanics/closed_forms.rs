//! What takes elimination is found when it is asked for, and no motion waits for it.

use std::f64::consts::FRAC_PI_2;

use phaselab::diagnostic::Document;
use phaselab::expr::Zero;
use phaselab::integrate::{METHODS, Settings, method_named};
use phaselab::mechanics::{self, Equations};
use phaselab::model::Model;
use phaselab::system::{Form, State, System};

use crate::build::{dissipative, lagrangian, read};

/// A chain of pendulums of unit mass and length, all angles from the vertical.
fn chain(n: usize) -> Model {
    let names: Vec<String> = (1..=n).map(|i| format!("a{i}")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let sum = |term: &str, below: usize| {
        let terms: Vec<String> = (1..=below).map(|i| term.replace('#', &i.to_string())).collect();
        terms.join(" + ")
    };
    let speeds =
        (1..=n).map(|k| format!("({})^2 + ({})^2", sum("cos(a#)*a#'", k), sum("sin(a#)*a#'", k)));
    let heights = (1..=n).map(|k| format!("({})", sum("cos(a#)", k)));
    let (speeds, heights): (Vec<_>, Vec<_>) = (speeds.collect(), heights.collect());
    let l = format!("1/2*({}) + g*({})", speeds.join(" + "), heights.join(" + "));
    lagrangian(&names, &["g"], &l)
}

/// The energy of the chain from the Cartesian places and velocities of its bobs.
fn energy(state: &State, g: f64) -> f64 {
    let n = state.values.len() / 2;
    let (mut y, mut v, mut w, mut total) = (0.0, 0.0, 0.0, 0.0);
    for i in 0..n {
        let (angle, rate) = (state.values[i], state.values[n + i]);
        y -= angle.cos();
        v += angle.cos() * rate;
        w += angle.sin() * rate;
        total += 0.5 * (v * v + w * w) + g * y;
    }
    total
}

fn motion(model: &Model) -> (Equations, System) {
    let equations = mechanics::derive_for_motion(model).expect("derivable");
    let system = System::compile(model, &equations, &[]).expect("compiles");
    (equations, system)
}

#[test]
fn a_chain_of_twenty_begins_and_conserves_its_energy() {
    let (n, g) = (20, 9.81);
    let model = chain(n);
    let (_, system) = motion(&model);
    // let go when it is held straight out: all bobs fall freely, and only the first rod turns
    let mut values = vec![FRAC_PI_2; n];
    values.resize(system.state_len(), 0.0);
    let mut rates = system.native_rates();
    rates.set_parameters(&[g]);
    let mut out = vec![0.0; values.len()];
    rates.evaluate(0.0, &values, &mut out).expect("regular");
    assert!((out[n] + g).abs() < 1e-12, "{}", out[n]);
    assert!(out[n + 1..2 * n].iter().all(|a| a.abs() < 1e-11), "{out:?}");
    // and a while later the energy, from Cartesian coordinates, is what it was
    let start = State::new(0.0, Form::Velocity, values);
    let method = method_named("taylor").expect("the default");
    let mut stepper = (method.make)(&system, &Settings::default()).expect("fits");
    stepper.start(&start, &[g]).expect("starts");
    while stepper.time() < 1.0 {
        stepper.step(1.0).expect("goes on");
    }
    let end = stepper.state();
    assert!((end.values[0] - FRAC_PI_2).abs() > 0.1, "it has moved");
    let (before, after) = (energy(&start, g), energy(end, g));
    assert!((after - before).abs() < 1e-10, "{before} became {after}");
}

#[test]
fn what_outgrows_reading_is_not_attempted_and_the_reason_is_true() {
    // on both sides of the limit
    let four = mechanics::derive(&chain(4)).expect("derivable");
    assert_eq!(four.solved.as_ref().expect("four accelerations").len(), 4);
    let five = mechanics::derive(&chain(5)).expect("derivable");
    let why = "the mass matrix changes during the motion and couples 5 coordinates each with each; \
               it is eliminated for up to 4, beyond which the forms outgrow 10000 nodes";
    for found in [five.solved.map(drop), five.hamiltonian.map(drop), five.velocities.map(drop)] {
        assert_eq!(found.unwrap_err().to_string(), why);
    }
    let why = five.separable.map(drop).unwrap_err().to_string();
    assert!(why.starts_with("there is no H in closed form: the mass matrix"), "{why}");
    // a matrix that is constant, or whose coordinates are not all coupled with all, is eliminated
    let springs = lagrangian(
        &["a", "b", "c", "d", "e"],
        &["k"],
        "1/2*(a'^2 + b'^2 + c'^2 + d'^2 + e'^2) + 1/10*(a' + b' + c' + d' + e')^2 - k*a*e",
    );
    assert!(mechanics::derive(&springs).expect("derivable").solved.is_ok());
    let comb = lagrangian(
        &["a", "b", "c", "d", "e"],
        &[],
        "1/2*(a'^2 + b'^2 + c'^2 + d'^2 + e'^2)*2 + a'*sin(a)*(b' + c' + d' + e')/4",
    );
    let comb = mechanics::derive(&comb).expect("derivable");
    let solved = comb.solved.as_ref().expect("two by two").clone();
    assert_eq!(solved.len(), 5);
}

#[test]
fn the_forms_are_the_same_whoever_asks_first() {
    type Ask = fn(&mut Equations) -> bool;
    let l = "a'^2 + b'^2/2 + a'*b'*cos(a - b) + 2*cos(a) + cos(b)";
    let model = lagrangian(&["a", "b"], &[], l);
    let full = mechanics::derive(&model).expect("derivable");
    let text = |e: &Equations, all: &[phaselab::expr::Expr]| -> Vec<String> {
        all.iter().map(|&x| e.pool.text(x)).collect()
    };
    let first: [Ask; 4] = [
        |e| e.separable().is_err(),
        |e| e.velocities().is_ok(),
        |e| e.solved().is_ok(),
        |e| e.hamiltonian().is_ok(),
    ];
    for ask in first {
        let mut e = mechanics::derive_for_motion(&model).expect("derivable");
        assert_eq!(e.solved.as_ref().unwrap_err().to_string(), "it has not been derived yet");
        assert!(e.has_pending_forms());
        assert!(ask(&mut e));
        e.find_closed_forms();
        assert!(!e.has_pending_forms());
        assert_eq!(
            text(&e, &[e.hamiltonian.clone().unwrap()]),
            text(&full, &[full.hamiltonian.clone().unwrap()])
        );
        let (a, b) = (e.solved.clone().unwrap(), full.solved.clone().unwrap());
        assert_eq!(text(&e, &a), text(&full, &b));
        let (a, b) = (e.velocities.clone().unwrap(), full.velocities.clone().unwrap());
        assert_eq!(text(&e, &a), text(&full, &b));
    }
}

/// Why leapfrog does not fit a system, or `None` if it does.
fn why_not_separable(model: &Model) -> Option<String> {
    let (_, system) = motion(model);
    let leapfrog = METHODS.iter().find(|method| method.name == "leapfrog").expect("in the table");
    (leapfrog.fits)(&system).err().map(|why| why.reason)
}

#[test]
fn whether_h_separates_is_known_without_eliminating() {
    let of = |names: &[&str], l: &str| why_not_separable(&lagrangian(names, &[], l));
    // M constant, written plainly and in disguise
    assert_eq!(of(&["x", "y"], "1/2*(x'^2 + x'*y' + y'^2) - x^2*y"), None);
    assert_eq!(of(&["x"], "1/2*x'^2*((1 + x)^2 - x^2 - 2*x) - x^4"), None);
    // a root of a quadratic form: T(p) = √(1 + p²)
    assert_eq!(of(&["x"], "-sqrt(1 - x'^2) - x^2"), None);
    let why = |p: &str, q: &str| {
        Some(format!("H is not of the form T(p) + V(q, t): ∂²H/∂p_{p}∂{q} does not vanish"))
    };
    assert_eq!(of(&["r", "phi"], "1/2*(r'^2 + r^2*phi'^2) + 1/r"), why("phi", "r"));
    assert_eq!(of(&["x"], "1/2*exp(t)*(x'^2 - x^2)"), why("x", "t"));
    // M constant, but not what is linear in the velocities
    assert_eq!(of(&["x", "y"], "1/2*(x'^2 + y'^2) + x*y'"), why("y", "x"));
    let damped = dissipative(&["x"], &[], "1/2*x'^2 - 1/2*x^2", "1/10*x'^2", &["0"]);
    assert_eq!(
        why_not_separable(&damped).as_deref(),
        Some("a force acts that does not come from H")
    );
    let why = why_not_separable(&chain(6)).expect("not separable");
    assert!(why.contains("couples 6 coordinates"), "{why}");
}

#[test]
fn a_rate_is_found_though_the_equations_were_not_solved_before() {
    let text = r#"
        title = "a test"
        [coordinates]
        a1 = { initial = 0.5, unit = "rad" }
        a2 = { initial = 0.1, unit = "rad" }
        [lagrangian]
        L = "a1'^2 + a2'^2/2 + a1'*a2'*cos(a1 - a2) - (a1 - a2)^2"
        [[observables]]
        name = "G"
        expression = "2*a1' + a2'*cos(a1 - a2) + a2' + a1'*cos(a1 - a2)"
    "#;
    let mut model = Document::new("test.toml", text).read().expect("it can be read").model;
    let mut equations = mechanics::derive_for_motion(&model).expect("derivable");
    // the total momentum, which the translation of both angles conserves, needs no acceleration
    assert!(equations.conserved.iter().any(|c| c.name == "G"), "{:?}", equations.conserved);
    assert!(equations.solved.is_err(), "nobody has asked");
    // a rate that is one
    let speed = read(&mut model, "a1'");
    let rate = equations.rate_of(speed).expect("a formula");
    let solved = equations.solved.clone().expect("found on the way");
    assert_eq!(equations.pool.text(rate), equations.pool.text(solved[0]));
}

/// The accelerations as textbooks have them: of a particle on a relativistic orbit, a = (F − v (v·F)/c²)/(γ m), and of a double
/// pendulum.
#[test]
fn accelerations_have_no_fractions_within_fractions() {
    let check = |model: &Model, textbook: &[&str], shown: &[&str]| {
        let mut model = model.clone();
        let textbook: Vec<_> = textbook.iter().map(|plain| read(&mut model, plain)).collect();
        let mut equations = mechanics::derive_for_motion(&model).expect("derivable");
        let solved = equations.solved().clone().expect("a closed form");
        let printed: Vec<String> = solved.iter().map(|&e| equations.pool.unicode(e)).collect();
        assert_eq!(printed, shown);
        for (found, right) in solved.into_iter().zip(textbook) {
            let difference = equations.pool.sub(found, right);
            assert_eq!(equations.pool.is_zero(difference), Zero::Proved, "{printed:?}");
        }
    };
    check(
        &lagrangian(&["r", "a"], &["m", "c", "k"], "k/r - m*c^2*sqrt(1 - (r'^2 + r^2*a'^2)/c^2)"),
        &[
            "r*a'^2 - k/(m*r^2)*(1 - r'^2/c^2)*sqrt(1 - (r'^2 + r^2*a'^2)/c^2)",
            "-2*r'*a'/r + k*r'*a'/(m*c^2*r^2)*sqrt(1 - (r'^2 + r^2*a'^2)/c^2)",
        ],
        &[
            "r a′² − k √(1 − r′²/c² − r² a′²/c²) (c² − r′²)/(m c² r²)",
            "r′ a′ (k √(1 − r′²/c² − r² a′²/c²) − 2 m c² r)/(m c² r²)",
        ],
    );
    check(
        &lagrangian(
            &["a", "b"],
            &["m1", "m2", "l1", "l2", "g"],
            "1/2*m1*l1^2*a'^2 + 1/2*m2*(l1^2*a'^2 + l2^2*b'^2 + 2*l1*l2*a'*b'*cos(a - b)) \
             + (m1 + m2)*g*l1*cos(a) + m2*g*l2*cos(b)",
        ),
        &[
            "(m2*g*sin(b)*cos(a - b) - m2*sin(a - b)*(l1*a'^2*cos(a - b) + l2*b'^2) \
             - (m1 + m2)*g*sin(a))/(l1*(m1 + m2*sin(a - b)^2))",
            "((m1 + m2)*(l1*a'^2*sin(a - b) - g*sin(b) + g*sin(a)*cos(a - b)) \
             + m2*l2*b'^2*sin(a - b)*cos(a - b))/(l2*(m1 + m2*sin(a - b)^2))",
        ],
        &[
            "−(m₂ l₂ b′² sin(a − b) + m₂ (l₁ a′² sin(a − b) − g sin b) cos(a − b) + (m₁ + m₂) g sin a)\
             /(l₁ (m₁ + m₂ sin²(a − b)))",
            "((m₁ + m₂) l₁ a′² sin(a − b) + m₂ l₂ b′² cos(a − b) sin(a − b) \
             + (m₁ + m₂) g cos(a − b) sin a − (m₁ + m₂) g sin b)/(l₂ (m₁ + m₂ sin²(a − b)))",
        ],
    );
}
