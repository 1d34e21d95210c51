//! Systems in which nothing may be found. What is claimed of them is that the stated ansatz holds nothing.

use phaselab::integrability::relations;
use phaselab::model::Model;

use super::{hamiltonian, model, search, top};

const FREE: &str = "1/2*(p_x^2 + p_y^2)";

/// Nothing is found up to a degree, and that is stated.
fn check_absent(model: &Model, degree: u32) {
    let (equations, found) = search(model, degree);
    let texts: Vec<String> =
        found.found.iter().map(|c| equations.pool.text(c.expression)).collect();
    assert!(texts.is_empty(), "{texts:?}");
    assert_eq!(found.none_up_to, Some(degree), "{:?}", found.ended);
    assert!(found.searched.iter().any(|s| s.degree == degree && s.standard));
}

#[test]
fn henon_heiles() {
    let h = format!("{FREE} + 1/2*(x^2 + y^2) + x^2*y - 1/3*y^3");
    check_absent(&hamiltonian(&["x", "y"], &[], &h), 4);
    // turned by an angle with rational sine and cosine, and scaled
    let (x, y) = ("(3*x + 4*y)/5", "(3*y - 4*x)/5");
    let h = format!("{FREE} + 1/2*(x^2 + y^2) + 2*(({x})^2*({y}) - 1/3*({y})^3)");
    check_absent(&hamiltonian(&["x", "y"], &[], &h), 3);
}

#[test]
fn relatives_of_henon_heiles_off_their_values() {
    let h =
        |a: f64, b: f64, c: &str| format!("{FREE} + 1/2*({a}*x^2 + {b}*y^2) + x^2*y + ({c})*y^3");
    for (a, b, c) in [(1.0, 2.0, "1/3"), (1.0, 15.0, "16/3"), (1.0, 1.0, "1/2"), (1.0, 1.0, "1")] {
        check_absent(&hamiltonian(&["x", "y"], &[], &h(a, b, c)), 4);
    }
}

#[test]
fn a_quartic_and_an_anisotropic_attraction() {
    check_absent(&hamiltonian(&["x", "y"], &[], &format!("{FREE} + 1/2*x^2*y^2")), 4);
    let kepler = "1/2*(p_x^2 + 1/2*p_y^2) - 1/sqrt(x^2 + y^2)";
    check_absent(&hamiltonian(&["x", "y"], &[], kepler), 2);
}

#[test]
fn pendulums() {
    let double = "a'^2 + 1/2*b'^2 + a'*b'*cos(a - b) + 2*cos(a) + cos(b)";
    let start = "a = { initial = 1.0 }\nb = { initial = 0.5 }";
    let text =
        format!("title = \"test\"\n[coordinates]\n{start}\n[lagrangian]\nL = \"{double}\"\n");
    check_absent(&model(&text), 1);
    let elastic = "1/2*(x'^2 + y'^2) - g*y - 1/2*k*(sqrt(x^2 + y^2) - l)^2";
    let start =
        "x = { initial = 1.0 }\ny = { initial = 0.5 }\n[parameters]\ng = 1.0\nk = 5.0\nl = 1.0";
    let text =
        format!("title = \"test\"\n[coordinates]\n{start}\n[lagrangian]\nL = \"{elastic}\"\n");
    check_absent(&model(&text), 3);
}

#[test]
fn restricted_three_bodies() {
    let h = "1/2*(p_x^2 + p_y^2) + y*p_x - x*p_y - (1 - mu)/sqrt((x + mu)^2 + y^2) \
             - mu/sqrt((x - 1 + mu)^2 + y^2)";
    check_absent(&hamiltonian(&["x", "y"], &[("mu", 0.1)], h), 1);
}

#[test]
fn a_generic_heavy_body() {
    check_absent(&top("1/2*(M1^2 + 1/2*M2^2 + 1/3*M3^2) - g1 - 1/2*g2"), 4);
    // Kovalevskaya's moments with the centre of mass off the plane of the equal ones
    check_absent(&top("1/2*(M1^2 + M2^2 + 2*M3^2) - g1 - 1/2*g3"), 4);
}

#[test]
fn swinging_atwood_off_its_ratio() {
    let h = "p_r^2/(2*(M + m)) + p_theta^2/(2*m*r^2) + g*r*(M - m*cos(theta))";
    for ratio in [2.0, 2.5, 3.1] {
        let at = [("M", ratio), ("m", 1.0), ("g", 9.81)];
        check_absent(&hamiltonian(&["r", "theta"], &at, h), 2);
    }
}

#[test]
fn friction_leaves_nothing_without_time() {
    let text = "title = \"test\"\n[coordinates]\nx = { initial = 1.0 }\n[lagrangian]\n\
                L = \"1/2*x'^2 - 1/2*x^2\"\ndissipation = \"1/2*x'^2\"\n";
    check_absent(&model(text), 4);
}

#[test]
fn functions_of_the_energy_are_not_new() {
    // H = ½(A − B) + 1 with A = p_y² + 2y⁴ and B = 4e⁻ˣ − p_x² − 2e⁻²ˣ: two independent constants, not three
    let model = hamiltonian(&["x", "y"], &[], "1/2*(p_x^2 + p_y^2) + (1 - exp(-x))^2 + y^4");
    let (mut equations, found) = search(&model, 3);
    assert_eq!(found.independent(), 2);
    let verdict = relations(&model, &mut equations, &found, true).verdict;
    assert!(verdict.contains("2 in involution: integrable (Liouville)"), "{verdict}");
    // one degree of freedom: all is a function of H
    let one = hamiltonian(&["x"], &[], "1/2*p_x^2 + x^4");
    assert!(search(&one, 4).1.found.is_empty());
}

#[test]
fn the_energy_is_not_found_again() {
    // Lotka and Volterra: H has logarithms, and is all there is
    let model = model(
        "title = \"test\"\n[variables]\nx = { initial = 1.0 }\ny = { initial = 2.0 }\n[poisson]\n\
         H = \"x - ln(x) + y - 2*ln(y)\"\nbrackets = [[\"x\", \"y\", \"x*y\"]]\n",
    );
    assert!(search(&model, 2).1.found.is_empty());
}

#[test]
fn what_separates_where() {
    use phaselab::integrability::separates;
    use phaselab::mechanics;
    let check = |q: [&str; 2], h: &str, expected: bool| {
        let model = hamiltonian(&q, &[], h);
        let mut equations = mechanics::derive(&model).expect("derivable");
        assert_eq!(separates(&model, &mut equations), Some(expected), "{h}");
    };
    // Kepler: not in Cartesian coordinates, but in polar ones; with a field in parabolic ones
    check(["x", "y"], "1/2*(p_x^2 + p_y^2) - 1/sqrt(x^2 + y^2)", false);
    check(["r", "phi"], "1/2*(p_r^2 + p_phi^2/r^2) - 1/r", true);
    let parabolic = "(p_u^2 + p_v^2)/(2*(u^2 + v^2)) - 2/(u^2 + v^2) - 1/10*(u^2 - v^2)";
    check(["u", "v"], parabolic, true);
    check(["x", "y"], "1/2*(p_x^2 + p_y^2) + x^2*y - 1/3*y^3", false);
    check(["x", "y"], "1/2*(p_x^2 + p_y^2) + x^4 + y^2", true);
    // the isotropic oscillator in both, any other central force in polar coordinates only
    check(["x", "y"], "1/2*(p_x^2 + p_y^2) + 3*(x^2 + y^2)", true);
    check(["x", "y"], "1/2*(p_x^2 + p_y^2) + (x^2 + y^2)^2", false);
    check(["r", "phi"], "1/2*(p_r^2 + p_phi^2/r^2) + r^4 - exp(-r)/r", true);
    // two centres: in elliptic coordinates, with H of Liouville's form
    let elliptic = "(p_u^2 + p_v^2)/(2*(cosh(u)^2 - cos(v)^2)) \
                    - (3*cosh(u) + cos(v))/(cosh(u)^2 - cos(v)^2)";
    check(["u", "v"], elliptic, true);
    check(["x", "y"], "1/2*(p_x^2 + p_y^2) - 1/sqrt((x-1)^2 + y^2) - 1/sqrt((x+1)^2 + y^2)", false);
}

/// Levi-Civita's conditions hold on each side of a kink, and nothing separates across it.
#[test]
fn what_separates_in_pieces_is_not_proved_to_separate() {
    use phaselab::integrability::separates;
    use phaselab::mechanics;
    let kinks = [
        "max(x, y)",
        "sign(x)*sign(y)",
        "sign(x)*y",
        "x/abs(x)*y",
        "abs(x + y)",
        "sqrt((x + y)^2)",
        "asin(sin(x + y))",
        "min(x^2, y^2)",
    ];
    for v in kinks {
        let h = format!("1/2*(p_x^2 + p_y^2) + {v}");
        let model = hamiltonian(&["x", "y"], &[], &h);
        let mut equations = mechanics::derive(&model).expect("derivable");
        assert_ne!(separates(&model, &mut equations), Some(true), "{v}");
    }
}
