//! Periodic orbits of systems that are given by brackets: they stay on their energy and on their Casimirs, whose multipliers are
//! trivial.

use phaselab::dynamics::{Along, Fixed, OrbitStability, Removed, family, periodic_orbit};

use super::{file, preset, taylor};
use crate::poisson::BODY;

/// Hénon and Heiles's system by its canonical brackets, with the strength c of its cubic terms as a Casimir.
const HENON_HEILES: &str = r#"
title = "Hénon and Heiles, by brackets"

[variables]
x = 0
y = -0.18
p_x = 0.46
p_y = 0
c = 1

[poisson]
H = "1/2*(p_x^2 + p_y^2 + x^2 + y^2) + c*(x^2*y - y^3/3)"
brackets = [["x", "p_x", "1"], ["y", "p_y", "1"]]
casimirs = { strength = "c" }
"#;

/// Orbit B at E = 1/8 has the published period and trace, as in canonical variables.
#[test]
fn the_multipliers_of_the_flow_the_energy_and_a_casimir_are_taken_out() {
    let case = file(HENON_HEILES, &[]);
    let found = periodic_orbit(&case.space, taylor(), &case.start, None, Fixed::Energy(0.125));
    let found = found.unwrap();
    assert!((found.period - 6.900_599_447_648_208_6).abs() < 1e-12, "{}", found.period);
    assert_eq!(
        (found.trivial, &found.levels[..]),
        (Removed::Flow, &["energy", "strength"].map(String::from)[..])
    );
    assert_eq!(found.trivial_names(), ["flow", "energy", "strength"]);
    assert_eq!(found.multipliers.len(), 2);
    assert!((found.transverse.trace() - 4.026_594_859_728_68).abs() < 1e-10);
    assert!((found.residue().unwrap() - (2.0 - 4.026_594_859_728_68) / 4.0).abs() < 1e-10);
    assert_eq!(found.stability(), OrbitStability::Unstable);
    assert!((found.state.values[4] - 1.0).abs() < 1e-14 && (found.energy - 0.125).abs() < 1e-14);
}

/// The family over the energy is that of canonical variables.
#[test]
fn a_family_over_the_energy_keeps_the_casimirs() {
    let case = file(HENON_HEILES, &[]);
    let canonical = preset("henon-heiles", &[], &[0.0, -0.18, 0.46, 0.0]);
    let members = |case: &super::Case| {
        let fixed = Fixed::Energy(0.125);
        let orbit = periodic_orbit(&case.space, taylor(), &case.start, None, fixed).unwrap();
        let along = (Along::Energy, fixed);
        family(&case.space, taylor(), &orbit, along, (&[0.12, 0.13], &|_| ())).unwrap().members
    };
    let (found, others) = (members(&case), members(&canonical));
    assert_eq!((found.len(), others.len()), (2, 2));
    for (one, other) in found.iter().zip(&others) {
        assert!((one.orbit.period - other.orbit.period).abs() < 1e-9, "{one:?}");
        assert!((one.orbit.transverse.trace() - other.orbit.transverse.trace()).abs() < 1e-6);
        assert!((one.orbit.state.values[4] - 1.0).abs() < 1e-12);
    }
}

/// The polhode of a free body has Landau's period 4 K(k) √(I₁I₂I₃/((I₃ − I₂)(M² − 2E I₁))), and nothing is left across it within
/// its energy and |L|².
#[test]
fn nothing_is_left_across_a_polhode() {
    let text = BODY.replace("w1 = 0.01", "w1 = 0.3").replace("w2 = 1.0", "w2 = 0.2");
    let case = file(&text.replace("w3 = 0.01", "w3 = 1.0"), &[]);
    let energy = 0.5 * (0.09 + 2.0 * 0.04 + 3.0);
    let found = periodic_orbit(&case.space, taylor(), &case.start, None, Fixed::Energy(energy));
    let found = found.unwrap();
    let square = 0.09 + 4.0 * 0.04 + 9.0;
    let slow = square - 2.0 * energy;
    let modulus = (2.0 * energy * 3.0 - square) / slow;
    let (mut a, mut b) = (1.0_f64, (1.0 - modulus).sqrt());
    for _ in 0..8 {
        (a, b) = (f64::midpoint(a, b), (a * b).sqrt());
    }
    // 4 K = 2π over the arithmetic-geometric mean
    let period = std::f64::consts::TAU / a * (6.0 / slow).sqrt();
    assert!((found.period - period).abs() < 1e-12, "{} {period}", found.period);
    assert_eq!(found.trivial_names(), ["flow", "energy", "|L|²"]);
    assert!(found.multipliers.is_empty());
    assert_eq!(found.stability(), OrbitStability::Neutral);
}

/// The upward unit vector of a top stays one, and L·G what it was: an orbit with others would be that of another top.
#[test]
fn an_orbit_of_a_top_has_the_casimirs_of_its_start() {
    let case = preset("heavy-top-body", &[], &[]);
    let energy = case.space.system().energy(&case.start, case.space.parameters()).unwrap();
    let found = periodic_orbit(&case.space, taylor(), &case.start, None, Fixed::Energy(energy));
    let found = found.unwrap();
    let casimirs = |values: &[f64]| {
        let named: Vec<f64> = case.space.names().iter().zip(values).map(|one| *one.1).collect();
        let (g, l) = (&named[0..3], &named[3..6]);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        [dot(g, g), dot(l, g)]
    };
    let [one, other] = [&found.state, &case.start].map(|state| casimirs(&state.values));
    assert!((one[0] - other[0]).abs() < 1e-12 && (one[1] - other[1]).abs() < 1e-12, "{one:?}");
    assert_eq!(found.trivial_names().len(), 4);
    assert_eq!(found.multipliers.len(), 2);
}

/// With L₃ conserved beside the energy, the closed orbits of Lagrange's top fill a torus each and form a family in both: none is
/// stable or unstable, no energy is left out, and nothing turns back. They shrink to a steady precession, at which their family ends.
#[test]
fn orbits_of_an_integrable_top_are_parabolic_and_turn_back_nowhere() {
    let case = preset("heavy-top-body", &[], &[]);
    let along = (Along::Energy, Fixed::Energy(10.6));
    let orbit = periodic_orbit(&case.space, taylor(), &case.start, None, along.1).unwrap();
    // from the energy of the start downwards
    let values = [9.2, 8.0, 6.8, 5.6];
    let found = family(&case.space, taylor(), &orbit, along, (&values, &|_| ())).unwrap();
    assert!(!found.isolated);
    let seen: Vec<_> = found.members.iter().map(|m| (m.value, m.bifurcation)).collect();
    assert_eq!(seen, [9.2, 8.0, 6.8].map(|value| (value, None)), "{:?}", found.ended);
    // two turns of the spin to a nutation: the steady precession with these Casimirs and this ratio has E = 6.021547 and
    // T = 3.807922, by I₁ φ̇² cos θ − L₃ φ̇ + Mgl = 0 and the second derivative of the effective potential of θ
    let [why] = &found.ended[..] else { panic!("{:?}", found.ended) };
    let said = "the family ends near 6.022, at an orbit of another, from which it branches off, where its period is 3.808";
    assert_eq!(why, said);
    for member in &found.members {
        assert_eq!(member.stability(), OrbitStability::Parabolic, "{}", member.value);
        assert_eq!(member.is_stable(), None, "{}", member.value);
        assert!(member.orbit.closes_to_rounding, "{}", member.orbit.closure);
    }
}
