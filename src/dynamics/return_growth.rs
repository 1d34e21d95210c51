//! How much the errors of steps have grown on the way back of a motion whose time was reversed.
//!
//! A step that errs at the time s, on the way there or back, changes the state at an earlier time t by ∂φ(t)/∂φ(s) times its
//! error. That grows like e^{λ(s − t)} in chaos, and in proportion to s − t on a torus whose frequencies depend on the actions.
//! Errors of one sign add up, which makes (s − t)² of the latter; independent ones add up as the root of their squares, which
//! makes (s − t)^{3/2} (D. Brouwer, Astron. J. 46 (1937) 149).
//!
//! In: the state at which time was reversed, the time at which the way back ends. Out: both sums, as integrals, at times on the
//! way. Never here: how large the error of a step is.

use nalgebra::DMatrix;

use super::flow_map::flow_map;
use super::phase_space::PhaseSpace;
use crate::integrate::{Method, Settings};
use crate::num::math;
use crate::system::State;

const PARTS: u32 = 64;

/// The growth of errors on the way back, after some time.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct ReturnGrowth {
    /// The time elapsed back.
    pub elapsed: f64,
    /// ∫ ‖∂φ(t)/∂φ(s)‖ ds over the way.
    pub sum: f64,
    /// ∫ ‖∂φ(t)/∂φ(s)‖² ds.
    pub squares: f64,
}

impl ReturnGrowth {
    /// The error that is expected, where each step of this mean size errs by `error` there and back: errors of one sign
    /// (those of truncation), or independent ones (those of rounding, and within a tolerance).
    pub fn expected(&self, error: f64, step: f64, independent: bool) -> f64 {
        if independent {
            error * (2.0 * self.squares / step).sqrt()
        } else {
            error * self.sum / step
        }
    }
}

/// The growth of errors along the way back from a state to a time; `None` where derivatives are not known on all of it,
/// for example backwards under constraints.
pub fn return_growth(
    space: &PhaseSpace,
    method: (&'static Method, Settings),
    turned: &State,
    start: f64,
) -> Option<Vec<ReturnGrowth>> {
    let way = start - turned.time;
    let mut state = turned.clone();
    // ∂φ(t)/∂φ(s) from the end of each part to where the motion has come
    let mut since: Vec<DMatrix<f64>> = Vec::new();
    let (mut norms, mut all) = (vec![1.0], Vec::new());
    for k in 1..=PARTS {
        let end =
            if k == PARTS { start } else { turned.time + way * f64::from(k) / f64::from(PARTS) };
        since.push(DMatrix::identity(space.dimension(), space.dimension()));
        let part = flow_map(space, method, &state, end, &mut |_| {}).ok()?;
        if part.error.is_some() {
            return None;
        }
        norms.clear();
        for map in &mut since {
            *map = &part.matrix * &*map;
            norms.push(map.singular_values().max());
        }
        // what has just been made has not grown
        norms.push(1.0);
        state = part.state;
        let width = way.abs() / f64::from(PARTS);
        let sum = integral(&norms, width, &|norm| norm);
        let squares = integral(&norms, width, &|norm| norm * norm);
        if !squares.is_finite() {
            break;
        }
        all.push(ReturnGrowth { elapsed: (end - turned.time).abs(), sum, squares });
    }
    (!all.is_empty()).then_some(all)
}

/// The growth after a time, between those that are known.
pub fn growth_after(known: &[ReturnGrowth], elapsed: f64) -> Option<ReturnGrowth> {
    let after = known.partition_point(|growth| growth.elapsed < elapsed);
    let next = known.get(after).or_else(|| known.last().filter(|last| elapsed <= last.elapsed))?;
    let before = after.checked_sub(1).and_then(|before| known.get(before));
    let Some(before) = before.filter(|before| before.elapsed < next.elapsed) else {
        // on the first part of the way little has grown
        let part = elapsed / next.elapsed;
        return Some(ReturnGrowth { elapsed, sum: part * next.sum, squares: part * next.squares });
    };
    let part = (elapsed - before.elapsed) / (next.elapsed - before.elapsed);
    let between = |a: f64, b: f64| math::exp((1.0 - part) * math::ln(a) + part * math::ln(b));
    Some(ReturnGrowth {
        elapsed,
        sum: between(before.sum, next.sum),
        squares: between(before.squares, next.squares),
    })
}

/// The integral of a function of values at equal distances, by trapezia.
fn integral(values: &[f64], width: f64, of: &dyn Fn(f64) -> f64) -> f64 {
    values.windows(2).map(|pair| 0.5 * width * (of(pair[0]) + of(pair[1]))).sum()
}
