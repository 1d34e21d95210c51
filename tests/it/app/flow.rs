//! The flow of a constant of the motion applied in the lab: the state is carried to another orbit of the same energy.

use phaselab::app::Overlay;

use super::real::Real;
use crate::hand::lowered;

fn planet() -> Real {
    Real::with(lowered(
        "title = \"Kepler\"\n[coordinates]\nx = { initial = 1.0, momentum = 0.0 }\n\
         y = { initial = 0.0, momentum = 1.2 }\n[hamiltonian]\n\
         H = \"1/2*(p_x^2 + p_y^2) - 1/sqrt(x^2 + y^2)\"\n",
    ))
}

/// The line of the list whose formula contains this.
fn apply(real: &mut Real, formula: &str, epsilon: &str) {
    real.press("J");
    let Some(Overlay::Menu(menu)) = &real.app.overlay else { panic!("no list") };
    let about: Vec<String> = menu.items.iter().map(|item| item.about.clone()).collect();
    let line = about.iter().position(|a| a == formula);
    let line = line.unwrap_or_else(|| panic!("{formula} is not among {about:?}"));
    for _ in 0..line {
        real.press("Down");
    }
    real.press("Enter");
    for c in epsilon.chars() {
        real.press(&c.to_string());
    }
    real.press("Enter");
}

fn value(real: &Real, name: &str) -> f64 {
    let channels = real.lab().loaded.system.channels();
    real.seen().values[channels.iter().position(|c| c.name == name).expect("a channel")]
}

#[test]
fn angular_momentum_turns_the_orbit_and_back() {
    let mut real = planet();
    real.press("2");
    real.run(30);
    let before = ["x", "y", "p_x", "p_y", "energy"].map(|name| value(&real, name));
    let all = real.lab().flows();
    let pool = &real.lab().findings().unwrap().unwrap().equations.pool;
    let momentum = all
        .iter()
        .map(|(_, e)| pool.unicode(*e))
        .find(|text| text.contains('x') && text.contains('y') && !text.contains(['√', '²', '/']))
        .unwrap_or_else(|| panic!("no angular momentum among {all:?}"));
    apply(&mut real, &momentum, "0.5");
    let after = ["x", "y", "p_x", "p_y", "energy"].map(|name| value(&real, name));
    // a rotation by ε, in one sense or the other
    let (sin, cos) = (0.5_f64.sin(), 0.5_f64.cos());
    let turned = |s: f64| {
        [
            before[0] * cos - s * before[1] * sin,
            s * before[0] * sin + before[1] * cos,
            before[2] * cos - s * before[3] * sin,
            s * before[2] * sin + before[3] * cos,
            before[4],
        ]
    };
    let differs =
        |s: f64| turned(s).iter().zip(&after).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(differs(1.0).min(differs(-1.0)) < 1e-12, "{before:?} {after:?}");
    // less than zero leads back
    apply(&mut real, &momentum, "-0.5");
    for (name, value_before) in ["x", "y", "p_x", "p_y", "energy"].iter().zip(before) {
        assert!((value(&real, name) - value_before).abs() < 1e-12, "{name}");
    }
}

/// Along the flow of the Runge–Lenz vector the energy stays and the eccentricity does not.
#[test]
fn the_runge_lenz_vector_leads_to_another_ellipse_of_the_same_energy() {
    let mut real = planet();
    real.press("2");
    real.run(20);
    let l =
        |real: &Real| value(real, "x") * value(real, "p_y") - value(real, "y") * value(real, "p_x");
    let (energy, momentum) = (value(&real, "energy"), l(&real));
    let findings = real.lab().findings().unwrap().unwrap();
    let found: Vec<String> = findings
        .invariants
        .found
        .iter()
        .map(|c| findings.equations.pool.unicode(c.expression))
        .collect();
    let mut farthest = 0.0_f64;
    for formula in found {
        apply(&mut real, &formula, "0.3");
        assert!((value(&real, "energy") - energy).abs() < 1e-12, "{formula}");
        farthest = farthest.max((l(&real) - momentum).abs());
    }
    assert!(farthest > 1e-2, "{farthest}");
}

#[test]
fn where_constants_have_no_flow_the_key_says_why() {
    let mut real = Real::of("damped-pendulum");
    real.press("J");
    assert!(real.app.notice.as_ref().is_some_and(|n| n.text.contains("nothing to apply")));
    real.press("2 J");
    assert!(real.app.overlay.is_none());
}
