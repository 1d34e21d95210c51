//! The action of a motion, and of the paths beside it that have the same ends.
//!
//! In: a Lagrangian, a motion, a coordinate. Out: S(ε) − S(0) of paths on which ε sin(kπs)/k is added
//! to the coordinate, s from 0 to 1 along the path. To second order they are parabolas; that of the
//! k-th opens downwards once the motion is so long that a shorter way round it exists (*The
//! Principles of Dynamics*, § 3.5). Never here: the search for a path between two ends.

use std::f64::consts::PI;

use super::action::Lagrangian;
use super::error::DynamicsError;
use super::quadrature::gauss;
use crate::num::math;

/// The greatest k.
pub const VARIATIONS: usize = 3;

/// The number of values of ε on either side of 0.
const SIDE: i32 = 12;

/// The nodes of the rule on each part of the path, and the number of parts, doubled until the action
/// of the motion changes by less than a share of the size of its terms, and that size by less than
/// another: on either side of a pole they may cancel.
const NODES: usize = 12;
const PARTS: [usize; 8] = [4, 8, 16, 32, 64, 128, 256, 512];
const SETTLED: f64 = 1e-13;
const SIZE_SETTLED: f64 = 1e-3;

/// The action beside a motion.
#[derive(Clone, PartialEq, Debug)]
pub struct VariedAction {
    /// ∫ L dt along the motion.
    pub action: f64,
    /// For each k the points (ε, S(ε) − S(0)), in the units of the coordinate and of the action.
    pub curves: Vec<Vec<[f64; 2]>>,
}

/// The action of a motion of a duration, and of the paths on which a coordinate is varied by up to
/// half of the range that it has on the way (by up to 1, if it rests). `motion` gives q and then q̇
/// at ascending times from the beginning, or `None` where it cannot be followed.
///
/// # Errors
/// Returns an error if the motion cannot be followed, L is not finite on it, or its integral does
/// not settle.
pub fn varied_action(
    lagrangian: &mut Lagrangian,
    motion: &mut dyn FnMut(&[f64]) -> Option<Vec<Vec<f64>>>,
    coordinate: usize,
    duration: f64,
) -> Result<VariedAction, DynamicsError> {
    let unsuited = |why: &str| DynamicsError::Unsuited(why.to_owned());
    let (mut before, mut size_before) = (f64::NAN, f64::NAN);
    for parts in PARTS {
        let nodes = nodes(parts, duration);
        let times: Vec<f64> = nodes.iter().map(|&(time, _)| time).collect();
        let path = motion(&times).filter(|path| path.len() == nodes.len());
        let path = path.ok_or_else(|| unsuited("the motion cannot be followed so far"))?;
        let terms: Vec<f64> = (nodes.iter().zip(&path))
            .map(|(&(time, weight), state)| weight * lagrangian.value(time, state))
            .collect();
        let action: f64 = terms.iter().sum();
        if !action.is_finite() {
            return Err(unsuited("L is not finite on this motion"));
        }
        let size: f64 = terms.iter().map(|term| term.abs()).sum();
        let bounded = (size - size_before).abs() <= SIZE_SETTLED * size;
        if bounded && (action - before).abs() <= SETTLED * size {
            let curve = |k| curve(lagrangian, (&nodes, &path), (coordinate, k), duration);
            return Ok(VariedAction { action, curves: (1..=VARIATIONS).map(curve).collect() });
        }
        (before, size_before) = (action, size);
    }
    Err(unsuited("the integral of L along this motion does not settle: it is not smooth"))
}

/// The times and weights of the rule on so many parts of a duration.
fn nodes(parts: usize, duration: f64) -> Vec<(f64, f64)> {
    let mut rule = gauss(NODES);
    rule.sort_by(|a, b| a.0.total_cmp(&b.0));
    let width = duration / parts as f64;
    let part =
        |part| rule.iter().map(move |&(x, weight)| (width * (part as f64 + x), width * weight));
    (0..parts).flat_map(part).collect()
}

/// S(ε) − S(0) of the k-th variation of a coordinate, where L is finite.
fn curve(
    lagrangian: &mut Lagrangian,
    (nodes, path): (&[(f64, f64)], &[Vec<f64>]),
    (coordinate, k): (usize, usize),
    duration: f64,
) -> Vec<[f64; 2]> {
    let n = lagrangian.degrees();
    let (least, greatest) = path.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), q| {
        (lo.min(q[coordinate]), hi.max(q[coordinate]))
    });
    let half = 0.5 * (greatest - least);
    let reach = if half.is_normal() { half } else { 1.0 };
    let rate = k as f64 * PI / duration;
    let mut values = |epsilon: f64| {
        let terms = nodes.iter().zip(path).map(|(&(time, weight), state)| {
            let mut varied = state.clone();
            let (sine, cosine) = (math::sin(rate * time), math::cos(rate * time));
            varied[coordinate] += epsilon / k as f64 * sine;
            varied[n + coordinate] += epsilon / k as f64 * rate * cosine;
            weight * (lagrangian.value(time, &varied) - lagrangian.value(time, state))
        });
        terms.sum::<f64>()
    };
    let epsilons = (-SIDE..=SIDE).map(|i| reach * f64::from(i) / f64::from(SIDE));
    epsilons.map(|epsilon| [epsilon, values(epsilon)]).filter(|at| at[1].is_finite()).collect()
}
