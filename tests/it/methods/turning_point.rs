//! The implicit methods where some numbers rest for a moment while those they depend on move: the
//! apsides of an ellipse in polar coordinates, r' = 0.

use super::{case, named};
use crate::build::hamiltonian;
use phaselab::system::Form;

/// r, θ, p_r, p_θ under H = p_r²/2 + p_θ²/(2 r²) − k/r.
fn rates(k: f64, x: [f64; 4]) -> [f64; 4] {
    let [r, _, p_r, p_theta] = x;
    [p_r, p_theta / (r * r), p_theta * p_theta / (r * r * r) - k / (r * r), 0.0]
}

/// One step of the method of Gauss with this tableau, its stages iterated until nothing changes.
fn step(k: f64, a: &[&[f64]], b: &[f64], h: f64, x: [f64; 4]) -> [f64; 4] {
    let mut slopes = vec![rates(k, x); b.len()];
    for _ in 0..400 {
        slopes = a
            .iter()
            .map(|row| {
                let mut stage = x;
                for (i, y) in stage.iter_mut().enumerate() {
                    *y += h * row.iter().zip(&slopes).map(|(a, s)| a * s[i]).sum::<f64>();
                }
                rates(k, stage)
            })
            .collect();
    }
    std::array::from_fn(|i| x[i] + h * b.iter().zip(&slopes).map(|(b, s)| b * s[i]).sum::<f64>())
}

#[test]
fn stages_are_solved_where_a_number_rests() {
    let (root, other) = (3.0_f64.sqrt() / 6.0, 15.0_f64.sqrt());
    let two: &[&[f64]] = &[&[0.25, 0.25 - root], &[0.25 + root, 0.25]];
    let three: &[&[f64]] = &[
        &[5.0 / 36.0, 2.0 / 9.0 - other / 15.0, 5.0 / 36.0 - other / 30.0],
        &[5.0 / 36.0 + other / 24.0, 2.0 / 9.0, 5.0 / 36.0 - other / 24.0],
        &[5.0 / 36.0 + other / 30.0, 2.0 / 9.0 + other / 15.0, 5.0 / 36.0],
    ];
    let k = 4.0 * std::f64::consts::PI.powi(2);
    let model = || {
        let h = format!("p_r^2/2 + p_theta^2/(2*r^2) - {k:?}/r");
        hamiltonian(&["r", "theta"], &[], &h)
    };
    for e in [0.1_f64, 0.6, 0.9] {
        for r in [1.0 - e, 1.0 + e] {
            let start = [r, 0.0, 0.0, (k * (1.0 - e * e)).sqrt()];
            for h in [0.002, 0.005, 0.015] {
                let h = h * r.powf(1.5);
                for (name, a, b) in [
                    ("gauss4", two, &[0.5, 0.5][..]),
                    ("gauss6", three, &[5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0]),
                ] {
                    let case = case(model(), Form::Momentum, &start);
                    let mut stepper = case.stepper(named(name), h);
                    let mut x = start;
                    for n in 0..5 {
                        stepper.step(f64::INFINITY).expect("goes on");
                        x = step(k, a, b, h, x);
                        for (own, wanted) in stepper.state().values.iter().zip(x) {
                            let off = (own - wanted).abs() / (wanted.abs() + h);
                            assert!(
                                off < 1e-13,
                                "{name}, e = {e}, r = {r}, h = {h}, step {n}: {own} is not {wanted}"
                            );
                        }
                    }
                }
            }
        }
    }
}
