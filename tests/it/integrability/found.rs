//! Systems whose constants must be found, with how many independent ones there are, H among them.

use phaselab::expr::Zero;
use phaselab::integrability::{Proof, relations};
use phaselab::model::Model;

use super::{drift, hamiltonian, model, search, top};

const PLANE: [&str; 2] = ["x", "y"];
const FREE: &str = "1/2*(p_x^2 + p_y^2)";

/// Some constants are found and proved, and hold on an orbit; with those known there are `independent` ones.
fn check_from(model: &Model, degree: u32, independent: usize, start: &[f64]) {
    let (mut equations, found) = search(model, degree);
    assert!(!found.found.is_empty());
    for constant in &found.found {
        let text = equations.pool.text(constant.expression);
        assert_ne!(constant.proof, Proof::Unproved, "{text}");
        let drift = drift(model, &mut equations, constant.expression, start);
        assert!(drift < 1e-8, "{text} moves by {drift}");
    }
    assert_eq!(found.independent(), independent);
}

fn check(model: &Model, degree: u32, independent: usize) {
    let n = model.coordinates.len();
    let rates = if model.is_poisson() { 0 } else { n };
    let positions = (0..n).map(|i| 0.9 - 0.3 * i as f64 + 0.1 * (i * i) as f64);
    let rates = (0..rates).map(|i| 0.23 - 0.31 * i as f64);
    let mut start: Vec<f64> = positions.chain(rates).collect();
    if model.is_lagrangian() {
        // variables of phase space come in pairs
        start = (0..n).flat_map(|i| [start[i], start[n + i]]).collect();
    }
    check_from(model, degree, independent, &start);
}

#[test]
fn kepler() {
    let m = [("m", 0.7), ("k", 1.3)];
    check(&hamiltonian(&PLANE, &m, "(p_x^2 + p_y^2)/(2*m) - k/sqrt(x^2 + y^2)"), 2, 3);
    check(&hamiltonian(&["r", "phi"], &m, "(p_r^2 + p_phi^2/r^2)/(2*m) - k/r"), 2, 3);
    let h = "1/2*(p_x^2 + p_y^2 + p_z^2) - k/sqrt(x^2 + y^2 + z^2)";
    check(&hamiltonian(&["x", "y", "z"], &m, h), 2, 5);
    // in parabolic coordinates, where even the angular momentum is hidden
    let h = "(p_u^2 + p_v^2)/(2*(u^2 + v^2)) - 2*k/(u^2 + v^2)";
    check(&hamiltonian(&["u", "v"], &m, h), 2, 3);
}

#[test]
fn kepler_from_its_lagrangian_in_polar_coordinates() {
    let text = "title = \"test\"\n[coordinates]\nr = { initial = 1.0 }\n\
                theta = { initial = 0.5, velocity = 1.0 }\n\
                [lagrangian]\nL = \"1/2*(r'^2 + r^2*theta'^2) + 1/r\"\n";
    check(&model(text), 2, 3);
}

#[test]
fn attraction_with_a_uniform_field_and_two_centres() {
    let h = format!("{FREE} - k/sqrt(x^2 + y^2) - F*x");
    check(&hamiltonian(&PLANE, &[("k", 1.0), ("F", 0.2)], &h), 2, 2);
    let h = "(p_x^2 + p_y^2)/(2*m) - k1/sqrt((x + a)^2 + y^2) - k2/sqrt((x - a)^2 + y^2)";
    let at = [("m", 1.0), ("k1", 1.0), ("k2", 1.5), ("a", 1.0)];
    check_from(&hamiltonian(&PLANE, &at, h), 2, 2, &[0.2, 1.9, 0.5, -0.1]);
}

#[test]
fn oscillators() {
    let h = format!("{FREE} + 1/2*w^2*(x^2 + y^2)");
    check(&hamiltonian(&PLANE, &[("w", 1.5)], &h), 2, 3);
    let h = format!("{FREE} + 1/2*w^2*(x^2 + 4*y^2)");
    check(&hamiltonian(&PLANE, &[("w", 1.2)], &h), 2, 3);
    check(&hamiltonian(&PLANE, &[], &format!("{FREE} + 1/2*(x^2 + 9*y^2)")), 3, 3);
    let h = format!("{FREE} + 1/2*(a*x^2 + b*y^2)");
    check(&hamiltonian(&PLANE, &[("a", 1.0), ("b", 2.0)], &h), 3, 2);
    let h = format!("{FREE} + 1/2*w^2*(x^2 + y^2) + a/x^2 + b/y^2");
    check(&hamiltonian(&PLANE, &[("w", 1.0), ("a", 0.3), ("b", 0.7)], &h), 2, 3);
}

#[test]
fn integrable_relatives_of_henon_heiles() {
    let h =
        |a: &str, b: &str, c: &str| format!("{FREE} + 1/2*({a}*x^2 + {b}*y^2) + x^2*y + {c}*y^3");
    check(&hamiltonian(&PLANE, &[], &h("1", "1", "1/3")), 2, 2);
    check(&hamiltonian(&PLANE, &[("A", 1.7), ("B", 0.4)], &h("A", "B", "2")), 2, 2);
    check(&hamiltonian(&PLANE, &[], &h("1", "16", "16/3")), 4, 2);
}

#[test]
fn relatives_turned_by_an_angle() {
    let (x, y) = ("(3*x + 4*y)/5", "(4*x - 3*y)/5");
    let h = format!("{FREE} + 1/2*(x^2 + y^2) + ({x})^2*({y}) + ({y})^3/3");
    check(&hamiltonian(&PLANE, &[], &h), 2, 2);
    // by an angle that is a parameter: the coefficients contain its sine and cosine
    let (x, y) = ("(x*cos(a) + y*sin(a))", "(y*cos(a) - x*sin(a))");
    let h = format!("{FREE} + {x}^4 + 6*{x}^2*{y}^2 + {y}^4");
    check(&hamiltonian(&PLANE, &[("a", 0.3)], &h), 2, 2);
}

#[test]
fn quartic_potentials() {
    let h = |a: &str, b: &str| format!("{FREE} + x^4 + {a}*x^2*y^2 + {b}*y^4");
    check(&hamiltonian(&PLANE, &[], &h("6", "1")), 2, 2);
    check(&hamiltonian(&PLANE, &[], &h("12", "16")), 2, 2);
    check(&hamiltonian(&PLANE, &[], &h("6", "8")), 4, 2);
}

#[test]
fn holt() {
    let h = format!("{FREE} + k*(x^2 + 3/4*y^2)*y^(-2/3)");
    check_from(&hamiltonian(&PLANE, &[("k", 1.0)], &h), 3, 2, &[0.4, 1.1, 0.2, 0.3]);
}

#[test]
fn toda_and_calogero() {
    let q = ["q1", "q2", "q3"];
    let kinetic = "1/2*(p_q1^2 + p_q2^2 + p_q3^2)";
    let toda = format!("{kinetic} + exp(q1 - q2) + exp(q2 - q3)");
    check(&hamiltonian(&q, &[], &toda), 3, 3);
    check(&hamiltonian(&q, &[], &format!("{toda} + exp(q3 - q1)")), 3, 3);
    // Calogero: the constant of degree 1 + 1 is of the same order as H in the momenta
    let (_, found) = {
        let pairs = "g/(q1 - q2)^2 + g/(q1 - q3)^2 + g/(q2 - q3)^2";
        search(&hamiltonian(&q, &[("g", 1.0)], &format!("{kinetic} + {pairs}")), 2)
    };
    assert!(found.independent() >= 3 && found.found.iter().any(|c| c.proof == Proof::Proved));
}

#[test]
fn swinging_atwood_at_its_ratio() {
    let h = "p_r^2/(2*(M + m)) + p_theta^2/(2*m*r^2) + g*r*(M - m*cos(theta))";
    let model = hamiltonian(&["r", "theta"], &[("M", 3.0), ("m", 1.0), ("g", 9.81)], h);
    let (_, found) = search(&model, 2);
    assert_eq!(found.found[0].proof, Proof::AtTheseParameters);
    check(&model, 2, 2);
}

#[test]
fn tops() {
    let start = [0.3, -0.4, 0.7, 0.6, 0.0, 0.8];
    check_from(&top("1/2*(M1^2 + M2^2 + 2*M3^2) - g1"), 4, 4, &start);
    check_from(&top("1/3*(M1^2 + M2^2) + M3^2 - g3"), 1, 4, &start);
}

#[test]
fn neumann_and_geodesics_on_an_ellipsoid() {
    let text = |l: &str, f: &str| {
        format!(
            "title = \"test\"\n[coordinates]\nx = {{ initial = 0.6 }}\ny = {{ initial = 0.8 }}\n\
             z = {{ initial = 0.0, velocity = 0.4 }}\n[lagrangian]\nL = \"1/2*(x'^2 + y'^2 + z'^2){l}\"\n\
             [[constraints]]\nname = \"surface\"\nexpression = \"{f}\"\n"
        )
    };
    let start = [0.6, 0.8, 0.0, 0.4, -0.3, 0.7];
    let neumann = model(&text(" - 1/2*(x^2 + 2*y^2 + 7/2*z^2)", "x^2 + y^2 + z^2 - 1"));
    check_from(&neumann, 2, 2, &start);
    let ellipsoid = model(&text("", "x^2 + 1/2*y^2 + 1/3*z^2 - 1"));
    let start = [0.6, 0.8 * 2_f64.sqrt(), 0.0, 0.4 / 0.6, -0.3 * 2_f64.sqrt() / 0.8, 0.7];
    let v = [0.4, -0.3 * 2_f64.sqrt(), 0.7];
    check_from(&ellipsoid, 2, 2, &[start[0], start[1], start[2], v[0], v[1], v[2]]);
}

#[test]
fn parameters_keep_their_names() {
    // Hénon–Heiles with c = 2: integrable for all A and B
    let h = format!("{FREE} + 1/2*(A*x^2 + B*y^2) + x^2*y + 2*y^3");
    let (mut equations, found) = search(&hamiltonian(&PLANE, &[("A", 1.7), ("B", 0.4)], &h), 2);
    let [constant] = &found.found[..] else { panic!("{}", found.found.len()) };
    assert_eq!(constant.proof, Proof::Proved);
    let pool = &mut equations.pool;
    let names = pool.symbols_of(constant.expression);
    for name in ["A", "B"] {
        assert!(names.contains(&pool.symbol(name)), "{}", pool.text(constant.expression));
    }
}

#[test]
fn the_brackets_are_known_and_kepler_closes() {
    let model = hamiltonian(&PLANE, &[("k", 1.0)], &format!("{FREE} - k/sqrt(x^2 + y^2)"));
    let (mut equations, found) = search(&model, 2);
    let relations = relations(&model, &mut equations, &found, true);
    assert!(relations.verdict.contains("every bounded orbit closes"), "{}", relations.verdict);
    // [L, A] is ± the other component
    let n = found.known.len();
    let l = found.known.iter().position(|k| k.name == "L_z").expect("the angular momentum");
    let [a, b] = [found.found[0].expression, found.found[1].expression];
    let e = relations.brackets[l][n].expect("a bracket");
    let pool = &mut equations.pool;
    let (sum, difference) = (pool.add(e, b), pool.sub(e, b));
    assert!(pool.is_zero(sum) == Zero::Proved || pool.is_zero(difference) == Zero::Proved);
    assert_ne!(pool.is_zero(a), Zero::Proved);
}
