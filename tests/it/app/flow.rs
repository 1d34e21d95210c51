//! The flow of a constant of the motion applied in the lab: the state is carried to another orbit of the same energy.

use phaselab::app::{Item, Overlay};

use super::real::Real;
use crate::fixtures::lowered;

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

/// What is conserved is offered by the first `J`, without a look at the page of the equations.
#[test]
fn constants_are_offered_at_once() {
    let mut real = planet();
    real.press("J");
    let Some(Overlay::Menu(menu)) = &real.app.overlay else { panic!("no list") };
    let labels: Vec<&str> = menu.items.iter().map(|item| item.label.as_str()).collect();
    assert!(labels.len() > 4 && labels[0] == "E", "{labels:?}");
    assert!(menu.items.iter().all(|item| item.unavailable.is_none()), "{labels:?}");
}

#[test]
fn angular_momentum_turns_the_orbit_and_back() {
    let mut real = planet();
    real.press("2");
    real.run(30);
    let before = ["x", "y", "p_x", "p_y", "energy"].map(|name| value(&real, name));
    let time = real.seen().time;
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
    // undone, the motion is where it was when it was first carried away, at that time; redone, it begins where the flow led
    assert_eq!(real.seen().time, 0.0);
    real.press("u u");
    assert_eq!(real.seen().time, time);
    assert_eq!(["x", "y", "p_x", "p_y", "energy"].map(|name| value(&real, name)), before);
    real.press("U");
    assert_eq!(["x", "y", "p_x", "p_y", "energy"].map(|name| value(&real, name)), after);
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

/// The symmetry whose changes are these; its flow is applied.
fn apply_symmetry(real: &mut Real, changes: &str, epsilon: &str) {
    real.press("J");
    let line = |real: &Real, what: &dyn Fn(&Item) -> bool| {
        let Some(Overlay::Menu(menu)) = &real.app.overlay else { panic!("no list") };
        let line = menu.items.iter().position(what);
        line.unwrap_or_else(|| panic!("{changes} is not among {:?}", menu.items))
    };
    let symmetries = line(real, &|item| item.label == "symmetries …");
    real.press(&"Down ".repeat(symmetries));
    real.press("Enter");
    let symmetry = line(real, &|item| item.about == changes);
    real.press(&"Down ".repeat(symmetry));
    real.press("Enter");
    for c in epsilon.chars() {
        real.press(&c.to_string());
    }
    real.press("Enter");
}

/// Kepler's third law. Of t by 3t and q by 2q the flow to ε enlarges orbits by e^{2ε} and divides velocities by e^{ε};
/// the time of revolution grows by e^{3ε}, which is seen where the new orbit closes.
#[test]
fn the_scaling_of_kepler_carries_an_ellipse_to_one_of_another_size() {
    let lagrangian = lowered(
        "title = \"Kepler\"\n[coordinates]\nx = { initial = 1.0, velocity = 0.1 }\n\
         y = { initial = 0.0, velocity = 1.2 }\n[lagrangian]\n\
         L = \"1/2*(x'^2 + y'^2) + 1/sqrt(x^2 + y^2)\"\n",
    );
    let hamiltonian = lowered(
        "title = \"Kepler\"\n[coordinates]\nx = { initial = 1.0, momentum = 0.1 }\n\
         y = { initial = 0.0, momentum = 1.2 }\n[hamiltonian]\n\
         H = \"1/2*(p_x^2 + p_y^2) - 1/sqrt(x^2 + y^2)\"\n",
    );
    for loaded in [lagrangian, hamiltonian] {
        let mut real = Real::with(loaded);
        real.run(90);
        let names = ["x", "y", "x'", "y'", "energy"];
        let before = names.map(|name| value(&real, name));
        apply_symmetry(&mut real, "t by 3 t, x by 2 x, y by 2 y", "0.1");
        let after = names.map(|name| value(&real, name));
        let (size, speed) = (0.2_f64.exp(), (-0.1_f64).exp());
        let factors = [size, size, speed, speed, speed * speed];
        for (k, name) in names.iter().enumerate() {
            let expected = before[k] * factors[k];
            assert!((after[k] - expected).abs() < 1e-12, "{name}: {}, not {expected}", after[k]);
        }
        // T = 2π a^{3/2} with a = −1/2E of the old orbit
        let revolution = std::f64::consts::TAU * (-0.5 / before[4]).powf(1.5) * 0.3_f64.exp();
        real.experiment.advance(revolution, u64::MAX);
        real.look();
        for (k, name) in names.iter().enumerate() {
            assert!((value(&real, name) - after[k]).abs() < 1e-11, "{name} after a revolution");
        }
        // less than zero leads back
        apply_symmetry(&mut real, "t by 3 t, x by 2 x, y by 2 y", "-0.1");
        for (name, value_before) in names.iter().zip(before) {
            assert!((value(&real, name) - value_before).abs() < 1e-11, "{name}");
        }
    }
}

/// Where the law contains the time, the motion as a whole is carried: from x(0) = 1 of x¨ = −x + cos 2t, along
/// x by cos t and along x by sin t, to solutions with the same clock.
#[test]
fn with_a_drive_the_carried_motion_keeps_the_clock() {
    let loaded = lowered(
        "title = \"Driven\"\n[coordinates]\nx = { initial = 1.0, velocity = 0.5 }\n\
         [lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2 + x*cos(2*t)\"\n",
    );
    for (changes, [c, s]) in [("x by cos t", [1.0, 0.0]), ("x by sin t", [0.0, 1.0])] {
        let mut real = Real::with(loaded.clone());
        real.run(100);
        apply_symmetry(&mut real, changes, "0.3");
        real.experiment.advance(2.0, u64::MAX);
        real.look();
        // x = −cos(2t)/3 + (4/3 + 0.3 c) cos t + (1/2 + 0.3 s) sin t
        let (sin, cos) = 2.0_f64.sin_cos();
        let expected = -4.0_f64.cos() / 3.0 + (4.0 / 3.0 + 0.3 * c) * cos + (0.5 + 0.3 * s) * sin;
        assert!((value(&real, "x") - expected).abs() < 1e-12, "{changes}");
    }
}

/// The shift of time needs no energy that is constant: with friction the state is that of ε before.
#[test]
fn the_shift_of_time_leads_back_along_a_motion_with_friction() {
    let mut real = Real::of("damped-pendulum");
    real.run(60);
    let time = real.experiment.time();
    apply_symmetry(&mut real, "t by 1", "0.25");
    let mut own = Real::of("damped-pendulum");
    own.experiment.advance(time - 0.25, u64::MAX);
    own.look();
    for name in ["theta", "theta'"] {
        assert!((value(&real, name) - value(&own, name)).abs() < 1e-12, "{name}");
    }
}

/// Constraints have neither: no flow of a constant, and symmetries are not searched.
#[test]
fn where_nothing_has_a_flow_the_key_says_why() {
    let mut real = Real::of("rolling-coin");
    real.press("J");
    assert!(
        real.app.notifications.shown.as_ref().is_some_and(|n| n.text.contains("nothing to apply"))
    );
    real.press("2 J");
    assert!(real.app.overlay.is_none());
}

/// A generator that does not commute with H: x − ε changes the energy, and that is said; a generator of the file is in the list.
#[test]
fn a_generator_that_is_typed_or_of_the_file_carries_the_state() {
    let mut real = Real::with(lowered(
        "title = \"t\"\n[coordinates]\nx = { initial = 1.0, momentum = 0.5 }\n[parameters]\nk = 4.0\n[hamiltonian]\n\
         H = \"1/2*(p_x^2 + k*x^2)\"\n[[generators]]\nname = \"translation\"\nG = \"p_x\"\n",
    ));
    let before = ["x", "p_x", "energy"].map(|name| value(&real, name));
    apply(&mut real, "generator of the file: p_x", "0.25");
    let after = ["x", "p_x", "energy"].map(|name| value(&real, name));
    assert!((after[0] - before[0] - 0.25).abs() < 1e-14 && after[1] == before[1], "{after:?}");
    let said = real.app.notifications.shown.as_ref().expect("a notice").text.clone();
    assert!(said.contains("H has changed from 2.125 to 3.25"), "{said}");
    // H itself by its own name, a quarter of a turn of ω = 2 on, and back
    let formula = "any function of q and p, typed; H changes unless [H, G] = 0";
    let quarter = std::f64::consts::PI / 4.0;
    for epsilon in [quarter, -quarter] {
        let before = ["x", "p_x"].map(|name| value(&real, name));
        real.press("J");
        let Some(Overlay::Menu(menu)) = &real.app.overlay else { panic!("no list") };
        let line = menu.items.iter().position(|item| item.about == formula).expect("a line");
        real.press(&"Down ".repeat(line));
        real.press("Enter");
        for c in format!("p_x^2/2+k*x^2/2;{epsilon:?}").chars() {
            real.press(&c.to_string());
        }
        real.press("Enter");
        let after = ["x", "p_x"].map(|name| value(&real, name));
        let sign = epsilon.signum();
        assert!((after[0] - sign * before[1] / 2.0).abs() < 1e-13, "{after:?}");
        assert!((after[1] + sign * 2.0 * before[0]).abs() < 1e-13, "{after:?}");
        let said = real.app.notifications.shown.as_ref().expect("a notice").text.clone();
        assert!(said.contains("as before, since [H, G] = 0"), "{said}");
    }
    // what cannot be read is said in the field
    real.press("J");
    let Some(Overlay::Menu(menu)) = &real.app.overlay else { panic!("no list") };
    let line = menu.items.iter().position(|item| item.about == formula).expect("a line");
    real.press(&"Down ".repeat(line));
    real.press("Enter y Enter");
    let Some(Overlay::Field(field)) = &real.app.overlay else { panic!("no field") };
    assert!(field.diagnostic.as_ref().is_some_and(|why| why.contains("unknown name `y`")));
}

/// The flow of a constant in whose formula numbers of the file stand, found as if they were parameters.
#[test]
fn a_flow_knows_the_numbers_that_were_searched_as_parameters() {
    let mut real = Real::with(lowered(
        "title = \"Kepler\"\n[coordinates]\nx = { initial = 1.0, momentum = 0.0 }\n\
         y = { initial = 0.0, momentum = 1.0931e-30 }\n[hamiltonian]\n\
         H = \"1/2*(p_x^2 + p_y^2)/9.1093837e-31 - 1.1204542e-30/sqrt(x^2 + y^2)\"\n",
    ));
    real.press("2");
    let pool = &real.lab().findings().unwrap().unwrap().equations.pool;
    let all: Vec<String> = real.lab().flows().into_iter().map(|(_, e)| pool.unicode(e)).collect();
    let vector = all.iter().find(|text| text.contains("p_x p_y") && text.contains('√'));
    let vector = vector.unwrap_or_else(|| panic!("no Runge–Lenz vector among {all:?}")).clone();
    assert!(vector.contains("10⁻³⁰") || vector.contains("10⁻³¹"), "{vector}");
    let before = ["x", "y", "energy"].map(|name| value(&real, name));
    apply(&mut real, &vector, "0.001");
    let notice = real.app.notifications.shown.as_ref().map(|n| n.text.clone()).unwrap_or_default();
    let after = ["x", "y", "energy"].map(|name| value(&real, name));
    let moved = (after[0] - before[0]).hypot(after[1] - before[1]);
    assert!(moved > 1e-4, "{vector}: {before:?} {after:?} {notice}");
    let kept = (after[2] - before[2]).abs() < 1e-12 * before[2].abs();
    assert!(kept, "{vector}: {before:?} {after:?} {notice}");
}
