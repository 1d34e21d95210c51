//! Point symmetries of the equations of motion, counted against the literature; each one carries a solution that is
//! integrated here to a solution.
//! Source: P. J. Olver, *Applications of Lie Groups to Differential Equations*, § 2.3 and exercise 2.26; G. E. Prince and
//! C. J. Eliezer, *On the Lie symmetries of the classical Kepler problem*, J. Phys. A 14 (1981) 587.

use phaselab::expr::{Expr, Symbol};
use phaselab::integrability::{PointSymmetries, point_symmetries, symmetries};
use phaselab::mechanics::{self, Equations};

use super::model;

fn find(coordinates: &[&str], law: &str) -> (Equations, PointSymmetries) {
    let mut text = "title = \"test\"\n[coordinates]\n".to_owned();
    for q in coordinates {
        text.push_str(&format!("{q} = {{ initial = 1.0, velocity = 0.5 }}\n"));
    }
    let model = model(&format!("{text}[lagrangian]\n{law}\n[run]\nstart = 1.0\n"));
    let mut equations = mechanics::derive(&model).expect("derivable");
    let mut noether = symmetries(&model, &mut equations, &|| false).ok();
    let found = point_symmetries(&model, &mut equations, noether.as_mut(), &|| false)
        .unwrap_or_else(|why| panic!("{law}: {why}"));
    (equations, found)
}

/// A motion, by the classical method of fourth order: states after each of `steps` steps.
fn motion(equations: &Equations, start: &[f64], begin: f64, h: f64, steps: usize) -> Vec<Vec<f64>> {
    let solved = equations.solved.clone().expect("accelerations");
    let n = solved.len();
    let rate = |t: f64, x: &[f64]| -> Vec<f64> {
        let at = |s: Symbol| {
            if s == equations.symbols.time {
                return t;
            }
            let k = equations.coordinates.iter().position(|c| c.position == s);
            k.map_or_else(
                || {
                    let k = equations.coordinates.iter().position(|c| c.velocity == s);
                    x[n + k.expect("a velocity")]
                },
                |k| x[k],
            )
        };
        let forces = solved.iter().map(|&e| equations.pool.evaluate(e, &at));
        x[n..].iter().copied().chain(forces).collect()
    };
    let plus = |x: &[f64], c: f64, k: &[f64]| -> Vec<f64> {
        x.iter().zip(k).map(|(x, k)| x + c * k).collect()
    };
    let mut all = vec![start.to_vec()];
    for i in 0..steps {
        let (t, x) = (begin + h * i as f64, all[i].clone());
        let k1 = rate(t, &x);
        let k2 = rate(t + h / 2.0, &plus(&x, h / 2.0, &k1));
        let k3 = rate(t + h / 2.0, &plus(&x, h / 2.0, &k2));
        let k4 = rate(t + h, &plus(&x, h, &k3));
        let mean = (0..2 * n).map(|j| (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]) / 6.0);
        let mean: Vec<f64> = mean.collect();
        all.push(plus(&x, h, &mean));
    }
    all
}

/// Moves each point (t, q) of a motion by ε (ξ, η): what remains of q'' = F along the moved curve, with the derivatives
/// taken by differences, is small beside ε.
fn residual(equations: &Equations, xi: Expr, eta: &[Expr]) -> f64 {
    let n = eta.len();
    let start: Vec<f64> = (0..2 * n)
        .map(|i| if i < n { 1.1 - 0.4 * i as f64 } else { 0.3 + 0.2 * i as f64 })
        .collect();
    let (h, steps, begin) = (0.01, 60, 0.9);
    let states = motion(equations, &start, begin, h, steps);
    let left = |epsilon: f64| {
        let curve: Vec<Vec<f64>> = states
            .iter()
            .enumerate()
            .map(|(i, x)| {
                let t = begin + h * i as f64;
                let at = |s: Symbol| {
                    let k = equations.coordinates.iter().position(|c| c.position == s);
                    if s == equations.symbols.time { t } else { x[k.expect("a coordinate")] }
                };
                let value = |e: Expr| equations.pool.evaluate(e, &at);
                let moved = (0..n).map(|k| x[k] + epsilon * value(eta[k]));
                [t + epsilon * value(xi)].into_iter().chain(moved).collect()
            })
            .collect();
        // derivatives by the number of the point, of fourth order
        let first = |k: usize, i: usize| {
            (8.0 * (curve[i + 1][k] - curve[i - 1][k]) - (curve[i + 2][k] - curve[i - 2][k])) / 12.0
        };
        let second = |k: usize, i: usize| {
            (16.0 * (curve[i + 1][k] + curve[i - 1][k])
                - (curve[i + 2][k] + curve[i - 2][k])
                - 30.0 * curve[i][k])
                / 12.0
        };
        let solved = equations.solved.clone().expect("accelerations");
        let mut worst: f64 = 0.0;
        for i in (4..steps - 4).step_by(4) {
            let (t1, t2) = (first(0, i), second(0, i));
            let speed = |k: usize| first(k + 1, i) / t1;
            let at = |s: Symbol| {
                if s == equations.symbols.time {
                    return curve[i][0];
                }
                let position = equations.coordinates.iter().position(|c| c.position == s);
                position.map_or_else(
                    || {
                        let k = equations.coordinates.iter().position(|c| c.velocity == s);
                        speed(k.expect("a velocity"))
                    },
                    |k| curve[i][k + 1],
                )
            };
            for k in 0..n {
                let bend = (second(k + 1, i) - speed(k) * t2) / (t1 * t1);
                worst = worst.max((bend - equations.pool.evaluate(solved[k], &at)).abs());
            }
        }
        worst
    };
    // what is left of first order in ε
    let epsilon = 1e-3;
    (left(epsilon) - left(0.0)).abs() / epsilon
}

/// The number of symmetries, and of those that are Noether's.
fn check(
    coordinates: &[&str],
    law: &str,
    count: usize,
    own: usize,
) -> (Equations, PointSymmetries) {
    let (equations, found) = find(coordinates, law);
    let names: Vec<String> = found
        .found
        .iter()
        .map(|s| {
            let all: Vec<String> = s.coordinates.iter().map(|&e| equations.pool.text(e)).collect();
            format!("{}: {}; {}", s.name, equations.pool.text(s.time), all.join(", "))
        })
        .collect();
    assert_eq!(found.found.len(), count, "{law}: {names:#?}");
    assert!(found.complete, "{law}");
    let noether = found.found.iter().filter(|s| s.noether == Some(true)).count();
    assert_eq!(noether, own, "{law}: {names:#?}");
    for (symmetry, name) in found.found.iter().zip(&names) {
        let left = residual(&equations, symmetry.time, &symmetry.coordinates);
        assert!(left < 0.05, "{law}: {name} leaves {left}");
    }
    (equations, found)
}

#[test]
fn one_degree_of_freedom() {
    check(&["x"], "L = \"1/2*x'^2\"", 8, 5);
    check(&["x"], "L = \"1/2*x'^2 - 1/2*x^2\"", 8, 5);
    check(&["x"], "L = \"1/2*x'^2 - 1/x^2\"", 3, 3);
    check(&["x"], "L = \"t^2*(1/2*x'^2 - 1/6*x^6)\"", 1, 1);
    // a pendulum has the time alone; x⁴ its similarity as well
    check(&["x"], "L = \"1/2*x'^2 + cos(x)\"", 1, 1);
    let (_, found) = check(&["x"], "L = \"1/2*x'^2 - 1/4*x^4\"", 2, 1);
    let scaling = found.found[1].scaling.clone().expect("a scaling");
    assert!((scaling[1].value() / scaling[0].value() + 1.0).abs() < 1e-15, "{scaling:?}");
}

#[test]
fn in_the_plane() {
    check(&["x", "y"], "L = \"1/2*(x'^2 + y'^2)\"", 15, 8);
    check(&["x", "y"], "L = \"1/2*(x'^2 + y'^2) - 1/2*(x^2 + y^2)\"", 15, 8);
    let henon = "L = \"1/2*(x'^2 + y'^2) - 1/2*(x^2 + y^2) - x^2*y + 1/3*y^3\"";
    check(&["x", "y"], henon, 1, 1);
}

/// t → λ³ t, r → λ² r takes ellipses to ellipses and leaves no integral.
#[test]
fn keplers_third_law() {
    for (q, law) in [
        (["x", "y"], "L = \"1/2*(x'^2 + y'^2) + 1/sqrt(x^2 + y^2)\""),
        (["r", "phi"], "L = \"1/2*(r'^2 + r^2*phi'^2) + 1/r\""),
    ] {
        let (_, found) = check(&q, law, 3, 2);
        let law = &found.found[2];
        assert_eq!((law.name.as_str(), law.noether), ("dilation", Some(false)));
        let scaling: Vec<f64> =
            law.scaling.as_ref().expect("a scaling").iter().map(|n| n.value()).collect();
        assert!((scaling[1] / scaling[0] - 2.0 / 3.0).abs() < 1e-15, "{scaling:?}");
        let second = if q[1] == "phi" { 0.0 } else { 2.0 / 3.0 };
        assert!((scaling[2] / scaling[0] - second).abs() < 1e-15, "{scaling:?}");
    }
}

/// Those of Noether's whose gauge terms are beyond the family, of fourth degree in the time and with a denominator, have their
/// constants, which are so along a motion that is integrated here.
#[test]
fn gauge_terms_beyond_the_family() {
    for (law, count) in [
        ("L = \"1/2*(x'^2 + y'^2) + 3*x*t - 1/2*(x - y - 2*t)^2\"", 3),
        ("L = \"1/2*(x'^2 + y'^2)/(x^2 + y^2)^2\"", 8),
    ] {
        let model = model(&format!(
            "title = \"test\"\n[coordinates]\nx = {{ initial = 1 }}\ny = {{ initial = 1 }}\n[lagrangian]\n{law}\n"
        ));
        let mut equations = mechanics::derive(&model).expect("derivable");
        let mut noether = symmetries(&model, &mut equations, &|| false).expect("searched");
        let all = point_symmetries(&model, &mut equations, Some(&mut noether), &|| false);
        let own = all.expect("searched").found.iter().filter(|s| s.noether == Some(true)).count();
        assert_eq!((own, noether.found.len()), (count, count), "{law}");
        let (h, begin) = (0.01, 0.9);
        let states = motion(&equations, &[1.1, 0.7, 0.3, 0.5], begin, h, 60);
        for symmetry in &noether.found {
            let value = |i: usize| {
                let at = |s: Symbol| {
                    let place = |c: &[Symbol]| c.iter().position(|&q| q == s);
                    let [q, v]: [Vec<Symbol>; 2] = [
                        equations.coordinates.iter().map(|c| c.position).collect(),
                        equations.coordinates.iter().map(|c| c.velocity).collect(),
                    ];
                    match (place(&q), place(&v)) {
                        (Some(k), _) => states[i][k],
                        (_, Some(k)) => states[i][2 + k],
                        _ => begin + h * i as f64,
                    }
                };
                equations.pool.evaluate(symmetry.conserved, &at)
            };
            let (first, last) = (value(0), value(60));
            let name = equations.pool.text(symmetry.conserved);
            assert!((last - first).abs() < 1e-7 * (1.0 + first.abs()), "{name}: {first} {last}");
        }
    }
}

/// Four bodies in a plane: shifts, boosts, the rotation, those of the centre of mass, and Kepler's third law, whose proof
/// multiplied out is too long.
#[test]
fn the_third_law_of_four_bodies() {
    let bodies = [1, 2, 3, 4];
    let names: Vec<String> =
        bodies.iter().flat_map(|k| [format!("x{k}"), format!("y{k}")]).collect();
    let mut terms = Vec::new();
    for m in bodies {
        terms.push(format!("{m}/2*(x{m}'^2 + y{m}'^2)"));
        for n in m + 1..=4 {
            terms.push(format!("{}/sqrt((x{m} - x{n})^2 + (y{m} - y{n})^2)", m * n));
        }
    }
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let (_, found) = find(&names, &format!("L = \"{}\"", terms.join(" + ")));
    assert_eq!((found.found.len(), found.unwritten, found.complete), (11, 0, true));
    let law = found.found.iter().find(|s| s.name == "dilation").expect("the third law");
    let scaling: Vec<f64> = law.scaling.iter().flatten().map(|n| n.value()).collect();
    assert!(scaling[1..].iter().all(|b| (b / scaling[0] - 2.0 / 3.0).abs() < 1e-15), "{scaling:?}");
}

/// The range that a count is proved in is named as it was searched, although powers of an exponential are exponentials.
#[test]
fn the_degree_of_the_range_is_that_searched() {
    let (_, found) = find(&["x"], "L = \"1/2*x'^2*exp(7/10*t)\"");
    let highest =
        found.searched.split("degree up to ").nth(1).and_then(|rest| rest.split(' ').next());
    let highest: u32 = highest.and_then(|k| k.parse().ok()).expect("a degree");
    assert!(found.complete && highest >= 2, "{}", found.searched);
}

/// Where friction acts, motions are still carried to motions.
#[test]
fn friction() {
    let law = "L = \"1/2*x'^2\"\ndissipation = \"1/3*x'^3\"";
    let (_, found) = find(&["x"], law);
    assert!(found.found.len() >= 3);
    assert!(found.found.iter().all(|s| s.noether.is_none()));
}

/// What is changed is no symmetry: a small term takes it away.
#[test]
fn what_is_nearly_a_symmetry_is_none() {
    check(&["x", "y"], "L = \"1/2*(x'^2 + y'^2) + 1/sqrt(x^2 + y^2) - 1/1000*x\"", 1, 1);
    check(&["x"], "L = \"1/2*x'^2 - 1/4*x^4 - 1/1000*x^6\"", 1, 1);
}

#[test]
fn kinks_and_constraints_are_refused() {
    let text = "title = \"test\"\n[coordinates]\nx = { initial = 1.0 }\n\
                [lagrangian]\nL = \"1/2*x'^2 - abs(x)\"\n";
    let model = model(text);
    let mut equations = mechanics::derive(&model).expect("derivable");
    let refused = point_symmetries(&model, &mut equations, None, &|| false).expect_err("kinks");
    assert!(refused.to_string().contains("kinks"), "{refused}");
}
