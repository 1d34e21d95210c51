//! The three actions of a motion, and of what lies beside it with the same ends: Hamilton's ∫ L dt, the abbreviated one of
//! Maupertuis at equal energy, and that in phase space, where q and p are varied apart.
//!
//! In: a Lagrangian or a Hamiltonian, a motion, a coordinate. Out: the action of the motion, and by how much it is
//! greater on paths on which ε sin(kπs)/k is added to the coordinate, s from 0 to 1 along the path. To second order these
//! are parabolas; of Hamilton's action that of the k-th opens downwards once the motion is so long that a shorter way
//! round it exists (*The Principles of Dynamics*, §§ 3.1.3, 3.5). Never here: the search for a path between two ends.

use std::f64::consts::PI;

use super::action::{Lagrangian, unsuited};
use super::error::DynamicsError;
use super::principle::{Hamiltonian, NotOnEnergy, rate_at_energy};

use super::sampled_motion::{
    EndIntegral, LEVELS, Mesh, Motion, MotionSpan, SampledMotion, SineVariation, breaks, half_range,
};

use crate::num::math;

/// The greatest k, and the number of curves.
pub const VARIATIONS: usize = 3;

/// The same of how it changes with the ends, as a part of what is added up; more parts are taken until it changes by no more
/// than rounding, or no less than before.
const SLOPES_SETTLED: f64 = 1e-9;
const SLOPES_ROUNDING: f64 = 1e-14;

/// The first rule where the paths beside the motion have corners: roots of what may vanish.
const WITH_CORNERS: usize = 2;

/// An action beside a motion.
#[derive(Clone, PartialEq, Debug)]
pub struct VariedAction {
    /// That of the motion.
    pub action: f64,
    /// For each variation the points (ε, A(ε) − A(0)), in the units of the coordinate and of the action.
    pub curves: Vec<Vec<[f64; 2]>>,
    /// Of Hamilton's action, how it changes with its ends: the start, and now. Nothing where that does not settle.
    pub ends: Option<[EndSlope; 2]>,
}

/// How Hamilton's action changes with an end of the motion, by the actions of paths whose end is elsewhere, and what the
/// motion has there. To first order a path need not be a motion for that.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct EndSlope {
    /// ∂S/∂q of the coordinate.
    pub by_position: f64,
    /// ∂S/∂t.
    pub by_time: f64,
    /// The sizes of what is added up to these two, in their units.
    pub sizes: [f64; 2],
    /// How far the integrals of these two are known: by how much fewer parts of the path changed them, and rounding.
    pub errors: [f64; 2],
    /// p of the coordinate.
    pub momentum: f64,
    /// H.
    pub energy: f64,
}

/// The action ∫ L dt of a motion of a duration, and of the paths on which a coordinate is varied by up to half of the range that
/// it has on the way (by up to 1, if it rests).
///
/// # Errors
/// Returns an error if the motion cannot be followed, L is not finite on it, or its integral does
/// not settle.
pub fn varied_action<'a>(
    lagrangian: &mut Lagrangian,
    motion: Motion<'_>,
    coordinate: usize,
    span: impl Into<MotionSpan<'a>>,
) -> Result<VariedAction, DynamicsError> {
    let span = span.into();
    let duration = span.duration;
    let mesh = Mesh { span, breaks: breaks(lagrangian, motion, duration) };
    let mut value = |time: f64, state: &[f64]| lagrangian.value(time, state);
    let followed = SampledMotion::of(motion, &mesh, 0, &mut value)?;
    let variation = |k| SineVariation { coordinate, k };
    let curve = |k| followed.curve(variation(k), &mut value);
    let curves = (1..=VARIATIONS).map(curve).collect();
    let slopes = settled_slopes(&followed, motion, coordinate, lagrangian);
    let ends = motion(&[0.0, duration]).filter(|ends| ends.len() == 2);
    let ends = ends.zip(slopes).map(|(ends, slopes)| {
        [0, 1].map(|end| {
            let time = [0.0, duration][end];
            let [by_position, by_time] = slopes[end];
            EndSlope {
                by_position: by_position.value,
                by_time: by_time.value,
                sizes: [by_position.size, by_time.size],
                errors: [by_position.error, by_time.error],
                momentum: lagrangian.momenta(time, &ends[end])[coordinate],
                energy: lagrangian.energy(time, &ends[end]),
            }
        })
    });
    Ok(VariedAction { action: followed.integral, curves, ends })
}

/// How the action changes with the ends, once more parts of the path change it no more; the action itself may settle before.
/// `None` where it does not.
fn settled_slopes(
    followed: &SampledMotion<'_>,
    motion: Motion<'_>,
    coordinate: usize,
    lagrangian: &mut Lagrangian,
) -> Option<[[EndIntegral; 2]; 2]> {
    let mut sampled = |level: usize| {
        let sampled = SampledMotion::sampled(motion, &followed.mesh, level).ok()?;
        Some(sampled.end_slopes(coordinate, lagrangian))
    };
    let mut before = sampled(followed.level.checked_sub(1)?)?;
    let (mut settled, mut change_before) = (None, f64::INFINITY);
    for level in followed.level..LEVELS {
        let mut slopes = sampled(level)?;
        let mut change = 0.0_f64;
        let pairs = slopes.iter_mut().flatten().zip(before.iter().flatten());
        for (now, before) in pairs.filter(|(now, _)| now.size > 0.0) {
            let changed = (now.value - before.value).abs();
            now.error = changed + SLOPES_ROUNDING * now.size;
            // a size that is not finite never settles
            let part = changed / now.size;
            change = if part > change || part.is_nan() { part } else { change };
        }
        if change <= SLOPES_SETTLED && change < change_before {
            settled = Some(slopes);
        }
        if settled.is_some() && (change <= SLOPES_ROUNDING || change >= 0.5 * change_before) {
            return settled;
        }
        (before, change_before) = (slopes, change);
    }
    settled
}

/// The abbreviated action ∫ Σ p dq of a motion, and of the same curves as in [`varied_action`], each traversed at the
/// energy of the motion, whatever time that takes. A curve that enters a region forbidden at this energy has no point.
///
/// # Errors
/// Returns an error if L is not of the second degree in the velocities or depends on the time, or the motion cannot be
/// followed.
pub fn varied_abbreviated_action<'a>(
    lagrangian: &mut Lagrangian,
    motion: Motion<'_>,
    coordinate: usize,
    span: impl Into<MotionSpan<'a>>,
) -> Result<VariedAction, DynamicsError> {
    let mesh = Mesh { span: span.into(), breaks: Vec::new() };
    let mut own = |time: f64, state: &[f64]| {
        let momenta = lagrangian.momenta(time, state);
        product(&momenta, state)
    };
    let followed = SampledMotion::of(motion, &mesh, WITH_CORNERS, &mut own)?;
    let Some(((time, _), state)) = followed.nodes.first().zip(followed.path.first()) else {
        return Err(unsuited("the motion cannot be followed so far"));
    };
    let energy = lagrangian.energy(*time, state);
    let mut law = true;
    let mut value =
        |time: f64, state: &[f64]| match rate_at_energy(lagrangian, (time, state), energy) {
            Ok(value) => value,
            Err(why) => {
                law &= why != NotOnEnergy::Law;
                f64::NAN
            }
        };
    let curve = |k| followed.curve(SineVariation { coordinate, k }, &mut value);
    let curves = (1..=VARIATIONS).map(curve).collect();
    if law {
        Ok(VariedAction { action: followed.integral, curves, ends: None })
    } else {
        Err(NotOnEnergy::Law.into())
    }
}

/// The action in phase space ∫ (Σ p q̇ − H) dt of a motion, and of paths beside it: first with q varied alone, by ε sin πs;
/// then with p varied alone, by ε c cos πs, whose ends are free; then with q varied and p = ∂L/∂q̇ with it, where it is
/// Hamilton's. c is the ratio of the ranges that p and q have on the way.
///
/// # Errors
/// Returns an error if the motion cannot be followed, or H has no value on it.
pub fn varied_phase_action<'a>(
    (hamiltonian, lagrangian): (&mut Hamiltonian, &mut Lagrangian),
    motion: Motion<'_>,
    coordinate: usize,
    span: impl Into<MotionSpan<'a>>,
) -> Result<VariedAction, DynamicsError> {
    let span = span.into();
    let duration = span.duration;
    let mesh = Mesh { span, breaks: breaks(lagrangian, motion, duration) };
    let mut at = |time: f64, state: &[f64], momenta: &[f64]| {
        let product = product(momenta, state);
        product - hamiltonian.value(time, &[&state[..momenta.len()], momenta].concat())
    };
    let mut own = |time: f64, state: &[f64]| {
        let momenta = lagrangian.momenta(time, state);
        at(time, state, &momenta)
    };
    let followed = SampledMotion::of(motion, &mesh, 0, &mut own)?;
    let nodes = followed.nodes.iter().zip(&followed.path);
    let momenta: Vec<Vec<f64>> =
        nodes.map(|(&(time, _), state)| lagrangian.momenta(time, state)).collect();
    let scale = half_range(&momenta, coordinate) / half_range(&followed.path, coordinate);
    let variation = SineVariation { coordinate, k: 1 };
    let mut curves = Vec::new();
    for (with_q, with_p) in
        [(true, MomentumRule::Fixed), (false, MomentumRule::Varied), (true, MomentumRule::OfPath)]
    {
        let mut rise = |epsilon: f64| {
            let terms = followed.nodes.iter().zip(followed.path.iter().zip(&momenta));
            let terms = terms.map(|(&(time, weight), (state, own))| {
                let size = if with_q { epsilon } else { 0.0 };
                let varied = variation.of(state, (time, duration), size);
                let mut p = own.clone();
                match with_p {
                    MomentumRule::Fixed => {}
                    MomentumRule::Varied => {
                        p[coordinate] += epsilon * scale * math::cos(PI * time / duration);
                    }
                    MomentumRule::OfPath => p = lagrangian.momenta(time, &varied),
                }
                weight * (at(time, &varied, &p) - at(time, state, own))
            });
            terms.sum::<f64>()
        };
        curves.push(followed.points(coordinate, &mut rise));
    }
    Ok(VariedAction { action: followed.integral, curves, ends: None })
}

#[derive(Clone, Copy)]
enum MomentumRule {
    Fixed,
    Varied,
    OfPath,
}

/// Σ p q̇.
fn product(momenta: &[f64], state: &[f64]) -> f64 {
    momenta.iter().zip(&state[momenta.len()..]).map(|(p, v)| p * v).sum()
}
