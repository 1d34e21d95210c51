//! Noether's symmetries, counted against the tables of the literature.
//! Source: P. J. Olver, *Applications of Lie Groups to Differential Equations*, §§ 2.4, 4.4; for the damped quintic,
//! the Emden–Fowler equation of index 5.

use phaselab::integrability::{Limits, Symmetries, invariants, symmetries};
use phaselab::mechanics::{self, Equations};

use super::{drift, model};

fn find(coordinates: &[&str], lagrangian: &str) -> (phaselab::model::Model, Equations, Symmetries) {
    let mut text = "title = \"test\"\n[coordinates]\n".to_owned();
    for q in coordinates {
        text.push_str(&format!("{q} = {{ initial = 1.0, velocity = 0.5 }}\n"));
    }
    let model = model(&format!("{text}[lagrangian]\nL = \"{lagrangian}\"\n[run]\nstart = 1.0\n"));
    let mut equations = mechanics::derive(&model).expect("derivable");
    let found = symmetries(&model, &mut equations, &|| false).expect("it can be searched");
    (model, equations, found)
}

/// The number of symmetries; each is proved, and the constants without time hold on an orbit.
fn check(coordinates: &[&str], lagrangian: &str, count: usize) {
    let (model, mut equations, found) = find(coordinates, lagrangian);
    let names: Vec<String> = found
        .found
        .iter()
        .map(|s| format!("{}: {}", s.name, equations.pool.text(s.conserved)))
        .collect();
    assert_eq!(found.found.len(), count, "{names:#?}");
    assert!(found.complete);
    let n = coordinates.len();
    let start: Vec<f64> = (0..2 * n)
        .map(|i| if i < n { 1.0 - 0.3 * i as f64 } else { 0.4 + 0.1 * i as f64 })
        .collect();
    for symmetry in &found.found {
        assert!(symmetry.proved);
        let time = equations.symbols.time;
        let law = *equations.lagrangian.as_ref().expect("L");
        if !equations.pool.depends(symmetry.conserved, time) && !equations.pool.depends(law, time) {
            let drift = drift(&model, &mut equations, symmetry.conserved, &start);
            assert!(drift < 1e-8, "{} moves by {drift}", symmetry.name);
        }
    }
}

#[test]
fn free_particles() {
    check(&["x"], "1/2*x'^2", 5);
    check(&["x", "y"], "1/2*(x'^2 + y'^2)", 8);
}

#[test]
fn oscillators() {
    check(&["x"], "1/2*x'^2 - 1/2*x^2", 5);
    check(&["x"], "1/2*x'^2 - 9/8*x^2", 5);
}

#[test]
fn attractions() {
    check(&["x", "y"], "1/2*(x'^2 + y'^2) + 1/sqrt(x^2 + y^2)", 2);
    check(&["x"], "1/2*x'^2 - 1/x^2", 3);
}

#[test]
fn a_charge_in_a_uniform_field() {
    check(&["x", "y"], "1/2*(x'^2 + y'^2) + 1/2*(x*y' - y*x')", 8);
}

#[test]
fn emden_and_henon_heiles() {
    check(&["x"], "t^2*(1/2*x'^2 - 1/6*x^6)", 1);
    check(&["x", "y"], "1/2*(x'^2 + y'^2) - 1/2*(x^2 + y^2) - x^2*y + 1/3*y^3", 1);
}

#[test]
fn emdens_constant_is_the_textbooks() {
    let (_, mut equations, found) = find(&["x"], "t^2*(1/2*x'^2 - 1/6*x^6)");
    let symmetry = &found.found[0];
    let pool = &mut equations.pool;
    let (t, x, v) = (pool.named("t"), pool.named("x"), pool.named("x'"));
    // t³x'² + t²xx' + t³x⁶/3, up to a factor
    let three = pool.powi(t, 3);
    let squares = [pool.powi(v, 2), pool.powi(x, 6), pool.powi(t, 2)];
    let third = pool.ratio(1, 3);
    let first = pool.product(&[three, squares[0]]);
    let second = pool.product(&[squares[2], x, v]);
    let last = pool.product(&[third, three, squares[1]]);
    let known = pool.sum(&[first, second, last]);
    let quotient = pool.div(symmetry.conserved, known);
    let at = crate::build::sample(3);
    let ratio = pool.evaluate(quotient, &at);
    let other = pool.evaluate(quotient, &crate::build::sample(8));
    assert!(ratio != 0.0 && (ratio - other).abs() < 1e-12 * ratio.abs(), "{ratio} {other}");
}

#[test]
fn where_friction_or_forces_act_nothing_is_said_to_be_constant() {
    let friction = "[lagrangian]\nL = \"1/2*x'^2 - 1/2*x^2\"\ndissipation = \"1/2*x'^2\"\n";
    let force = "[lagrangian]\nL = \"1/2*x'^2\"\nforces = { x = \"1\" }\n";
    for law in [friction, force] {
        let text = format!("title = \"test\"\n[coordinates]\nx = {{ initial = 1.0 }}\n{law}");
        let model = model(&text);
        let mut equations = mechanics::derive(&model).expect("derivable");
        let refused =
            symmetries(&model, &mut equations, &|| false).expect_err("something else acts");
        assert!(refused.to_string().contains("friction or forces"), "{refused}");
    }
}

#[test]
fn a_quantity_of_odd_degree_under_a_mass_that_is_odd_is_not_missed() {
    // M = diag(x', y'): x'³/3 + x and the like in y are constant
    let model = model(
        "title = \"test\"\n[coordinates]\nx = { initial = 0.0, velocity = 1.0 }\n\
         y = { initial = 0.0, velocity = 1.5 }\n[lagrangian]\nL = \"x'^3/6 + y'^3/6 - x - y\"\n",
    );
    let mut equations = mechanics::derive(&model).expect("derivable");
    let limits = Limits { degree: Some(3), is_over: &|| false };
    let found = invariants(&model, &mut equations, &limits).expect("it can be searched");
    assert!(
        found.independent() >= 2,
        "{} found, and nothing else up to {:?}",
        found.independent(),
        found.none_up_to
    );
}

/// The names of the symmetries, sorted.
fn names(coordinates: &[&str], lagrangian: &str) -> Vec<String> {
    let (_, _, found) = find(coordinates, lagrangian);
    let mut names: Vec<String> = found.found.into_iter().map(|s| s.name).collect();
    names.sort();
    names
}

/// A rotation turns, a boost adds a velocity: what does something else is not called so.
#[test]
fn a_symmetry_is_called_what_it_is() {
    let oscillations = "translation that depends on the time";
    // a fall: the translation changes L by a derivative, and is no boost
    let fall = names(&["x"], "1/2*x'^2 - x");
    assert!(fall.contains(&"translation".to_owned()), "{fall:?}");
    // in Minkowski's plane x ∂_y + y ∂_x turns nothing
    let hyperbolic = names(&["x", "y"], "1/2*(x'^2 - y'^2) - (x^2 - y^2)^2");
    assert_eq!(hyperbolic, ["linear transformation of the coordinates", "time shift"]);
    let circular = names(&["x", "y"], "1/2*(x'^2 + y'^2) - (x^2 + y^2)^2");
    assert_eq!(circular, ["rotation", "time shift"]);
    let free = names(&["x"], "1/2*x'^2");
    let expected = ["boost", "conformal transformation", "dilation", "time shift", "translation"];
    assert_eq!(free, expected);
    // solutions of an oscillator added to each other are no boosts
    let oscillator = names(&["x"], "1/2*x'^2 - 1/2*x^2");
    assert_eq!(oscillator.iter().filter(|name| *name == oscillations).count(), 2, "{oscillator:?}");
    assert!(!oscillator.contains(&"boost".to_owned()), "{oscillator:?}");
}

/// What an impulse changes, and what holds at these parameters only, is said so.
#[test]
fn constants_are_constant_where_they_are() {
    let model = model(
        "title = \"test\"\n[coordinates]\nx = { initial = 0.0, velocity = 1.0 }\n\
         y = { initial = 0.0, velocity = 1.5 }\n[parameters]\nk = 0.0\n\
         [lagrangian]\nL = \"1/2*x'^2 + 1/2*y'^2 - k*y\"\n\
         [[impulses]]\nname = \"tap\"\nat = [1.0]\nchange = { p_x = \"1\" }\n",
    );
    let mut equations = mechanics::derive(&model).expect("derivable");
    let found = symmetries(&model, &mut equations, &|| false).expect("it can be searched").found;
    let of = |constant: &str| {
        let at =
            |s: &&phaselab::integrability::Symmetry| equations.pool.text(s.conserved) == constant;
        found.iter().find(at).unwrap_or_else(|| panic!("{constant}"))
    };
    assert!(of("-x'").between_impulses && of("-x'").for_all_parameters);
    assert!(!of("-y'").between_impulses && !of("-y'").for_all_parameters);
}

/// Bodies of masses 1, 2, … in a plane, each pair with a potential of its distance.
fn bodies(count: usize, potential: &dyn Fn(&str) -> String) -> (Vec<String>, String) {
    let names = (1..=count).flat_map(|k| [format!("x{k}"), format!("y{k}")]).collect();
    let mut law = "0".to_owned();
    for j in 1..=count {
        law.push_str(&format!(" + {j}/2*(x{j}'^2 + y{j}'^2)"));
        for i in 1..j {
            law.push_str(" + ");
            law.push_str(&potential(&format!("((x{i} - x{j})^2 + (y{i} - y{j})^2)")));
        }
    }
    (names, law)
}

/// Of every number of bodies: the shifts, two boosts, the rotation, and that about the centre of mass alone.
#[test]
fn many_distances_have_values_at_one_point() {
    for count in [4, 6] {
        let (names, law) = bodies(count, &|square| format!("1/sqrt({square} + 1/10)"));
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        check(&names, &law, 7);
    }
}

/// Masses with many digits have others in their place while boosts are searched for, whose gauge terms have them.
#[test]
fn the_solar_system_has_its_ten() {
    let model =
        crate::integrability::model(include_str!("../../../presets/gravity/solar-system.toml"));
    let mut equations = mechanics::derive(&model).expect("derivable");
    let found = symmetries(&model, &mut equations, &|| false).expect("it can be searched").found;
    let count = |name: &str| found.iter().filter(|s| s.name == name && s.proved).count();
    let names = ["time shift", "translation", "rotation", "boost"];
    assert_eq!(names.map(count), [1, 3, 3, 3]);
    for boost in found.iter().filter(|s| s.name == "boost") {
        let text = equations.pool.text(boost.gauge);
        assert!((0..5).all(|k| text.contains(&format!("m{k}*"))), "{text}");
    }
}

/// The solutions that were written when the time ran out are reported, and how many were not.
#[test]
fn what_was_found_before_the_time_ran_out_is_kept() {
    let calls = std::cell::Cell::new(0);
    let search = |most: usize| {
        let (coordinates, law) = (["x", "y"], "1/2*(x'^2 + y'^2)");
        let initial = "{ initial = 1.0, velocity = 0.5 }";
        let [x, y] = coordinates;
        let text = format!(
            "title = \"test\"\n[coordinates]\n{x} = {initial}\n{y} = {initial}\n[lagrangian]\nL = \"{law}\"\n"
        );
        let model = model(&text);
        let mut equations = mechanics::derive(&model).expect("derivable");
        calls.set(0);
        symmetries(&model, &mut equations, &|| {
            calls.set(calls.get() + 1);
            calls.get() > most
        })
    };
    let whole = search(usize::MAX).expect("it can be searched");
    assert_eq!((whole.found.len(), whole.unfinished, whole.complete), (8, 0, true));
    let all = calls.get();
    let part = search(all - 3).expect("it was searched");
    assert_eq!((part.found.len(), part.unfinished, part.complete), (5, 3, false));
    assert!(search(1).is_err());
}
