//! The coefficients of implicit Runge–Kutta methods: Gauss's with two and three stages, and one stage at the end.
//!
//! Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, tables II.1.1, II.1.2.

use crate::num::{Analytic, DoubleDouble};

#[derive(Clone, Debug)]
pub(super) struct Tableau {
    /// c, the times of the stages as parts of a step.
    pub(super) nodes: Vec<DoubleDouble>,
    pub(super) weights: Vec<DoubleDouble>,
    pub(super) matrix: Vec<Vec<DoubleDouble>>,
    /// Row i: the polynomial through the slopes at the nodes, evaluated at 1 + c_i.
    pub(super) onward: Vec<Vec<f64>>,
}

/// A single stage that has moved by the whole step; it is taken at the time at which the step begins.
pub(super) fn of_the_end() -> Tableau {
    let one = DoubleDouble::from(1.0);
    Tableau::new(vec![DoubleDouble::ZERO], vec![one], vec![vec![one]])
}

pub(super) fn of_two_stages() -> Tableau {
    let root = root_of(3);
    let quarter = DoubleDouble::from(0.25);
    Tableau::new(
        vec![half() - root / 6.0, half() + root / 6.0],
        vec![half(), half()],
        vec![vec![quarter, quarter - root / 6.0], vec![quarter + root / 6.0, quarter]],
    )
}

pub(super) fn of_three_stages() -> Tableau {
    let root = root_of(15);
    let [outer, middle] = [DoubleDouble::from(5.0) / 36.0, DoubleDouble::from(2.0) / 9.0];
    Tableau::new(
        vec![half() - root / 10.0, half(), half() + root / 10.0],
        vec![outer * 2.0, middle * 2.0, outer * 2.0],
        vec![
            vec![outer, middle - root / 15.0, outer - root / 30.0],
            vec![outer + root / 24.0, middle, outer - root / 24.0],
            vec![outer + root / 30.0, middle + root / 15.0, outer],
        ],
    )
}

fn root_of(n: i64) -> DoubleDouble {
    DoubleDouble::integer(n).sqrt()
}

fn half() -> DoubleDouble {
    DoubleDouble::from(0.5)
}

impl Tableau {
    fn new(
        nodes: Vec<DoubleDouble>,
        weights: Vec<DoubleDouble>,
        matrix: Vec<Vec<DoubleDouble>>,
    ) -> Tableau {
        let c: Vec<f64> = nodes.iter().map(|c| c.high).collect();
        let row = |x: f64| (0..c.len()).map(|j| lagrange(&c, j, 1.0 + x)).collect();
        let onward = c.iter().map(|&x| row(x)).collect();
        Tableau { nodes, weights, matrix, onward }
    }
}

/// The polynomial that is 1 at node j and 0 at the others, at `x`.
fn lagrange(nodes: &[f64], j: usize, x: f64) -> f64 {
    let others = nodes.iter().enumerate().filter(|&(k, _)| k != j);
    others.map(|(_, c)| (x - c) / (nodes[j] - c)).product()
}
