//! The three actions of a motion, and of what lies beside it with the same ends: Hamilton's ∫ L dt, the abbreviated one of
//! Maupertuis at equal energy, and that in phase space, where q and p are varied apart.
//!
//! In: a Lagrangian or a Hamiltonian, a motion, a coordinate. Out: the action of the motion, and by how much it is
//! greater on paths on which ε sin(kπs)/k is added to the coordinate, s from 0 to 1 along the path. To second order these
//! are parabolas; of Hamilton's action that of the k-th opens downwards once the motion is so long that a shorter way
//! round it exists (*The Principles of Dynamics*, §§ 3.1.3, 3.5). Never here: the search for a path between two ends.

use std::f64::consts::PI;

use super::action::Lagrangian;
use super::error::DynamicsError;
use super::principle::{Hamiltonian, NotOnEnergy, rate_at_energy};

use crate::num::{gauss, math};

/// The greatest k, and the number of curves.
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

/// The same of how it changes with the ends, as a part of what is added up; more parts are taken until it changes by no more
/// than rounding, or no less than before.
const SLOPES_SETTLED: f64 = 1e-9;
const SLOPES_ROUNDING: f64 = 1e-14;

/// Kinks of the law by the time are searched for between so many times.
const LOOKS: usize = 128;

/// The least number of parts where the paths beside the motion have corners: roots of what may vanish.
const WITH_CORNERS: usize = 16;

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

/// What gives q and then q̇ of a motion at ascending times from its beginning, or `None` where it cannot be followed.
type Motion<'a> = &'a mut dyn FnMut(&[f64]) -> Option<Vec<Vec<f64>>>;

/// The action ∫ L dt of a motion of a duration, and of the paths on which a coordinate is varied by up to half of the range that
/// it has on the way (by up to 1, if it rests).
///
/// # Errors
/// Returns an error if the motion cannot be followed, L is not finite on it, or its integral does
/// not settle.
pub fn varied_action(
    lagrangian: &mut Lagrangian,
    motion: Motion<'_>,
    coordinate: usize,
    duration: f64,
) -> Result<VariedAction, DynamicsError> {
    let breaks = breaks(lagrangian, motion, duration);
    let mut value = |time: f64, state: &[f64]| lagrangian.value(time, state);
    let followed = SampledMotion::of(motion, (duration, &breaks), 0, &mut value)?;
    let variation = |k| SineVariation { coordinate, k };
    let curve = |k| followed.curve(variation(k), &mut value);
    let curves = (1..=VARIATIONS).map(curve).collect();
    let slopes = settled_slopes(&followed, motion, (coordinate, &breaks), lagrangian);
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

/// An integral along the path.
#[derive(Clone, Copy)]
struct EndIntegral {
    value: f64,
    /// The sum of the absolute values of its terms.
    size: f64,
    error: f64,
}

/// How the action changes with the ends, once more parts of the path change it no more; the action itself may settle before.
/// `None` where it does not.
fn settled_slopes(
    followed: &SampledMotion,
    motion: Motion<'_>,
    (coordinate, breaks): (usize, &[f64]),
    lagrangian: &mut Lagrangian,
) -> Option<[[EndIntegral; 2]; 2]> {
    let known = followed.parts;
    let mut sampled = |parts: usize| {
        Some(
            SampledMotion::sampled(motion, (followed.duration, breaks), parts)
                .ok()?
                .end_slopes(coordinate, lagrangian),
        )
    };
    let mut before = sampled(known / 2)?;
    let (mut settled, mut change_before) = (None, f64::INFINITY);
    for parts in PARTS.into_iter().filter(|&parts| parts >= known) {
        let mut slopes = sampled(parts)?;
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

/// The abbreviated action ∫ Σ p dq of a motion, and of the same ways as of [`varied_action`], each gone with the energy of the
/// motion, at whatever time. Where the energy forbids a way there is no point.
///
/// # Errors
/// Returns an error if L is not of the second degree in the velocities or depends on the time, or the motion cannot be
/// followed.
pub fn varied_abbreviated_action(
    lagrangian: &mut Lagrangian,
    motion: Motion<'_>,
    coordinate: usize,
    duration: f64,
) -> Result<VariedAction, DynamicsError> {
    let mut own = |time: f64, state: &[f64]| {
        let momenta = lagrangian.momenta(time, state);
        product(&momenta, state)
    };
    let followed = SampledMotion::of(motion, (duration, &[]), WITH_CORNERS, &mut own)?;
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
pub fn varied_phase_action(
    (hamiltonian, lagrangian): (&mut Hamiltonian, &mut Lagrangian),
    motion: Motion<'_>,
    coordinate: usize,
    duration: f64,
) -> Result<VariedAction, DynamicsError> {
    let breaks = breaks(lagrangian, motion, duration);
    let mut at = |time: f64, state: &[f64], momenta: &[f64]| {
        let product = product(momenta, state);
        product - hamiltonian.value(time, &[&state[..momenta.len()], momenta].concat())
    };
    let mut own = |time: f64, state: &[f64]| {
        let momenta = lagrangian.momenta(time, state);
        at(time, state, &momenta)
    };
    let followed = SampledMotion::of(motion, (duration, &breaks), 0, &mut own)?;
    let nodes = followed.nodes.iter().zip(&followed.path);
    let momenta: Vec<Vec<f64>> =
        nodes.map(|(&(time, _), state)| lagrangian.momenta(time, state)).collect();
    let scale = half_range(&momenta, coordinate) / half_range(&followed.path, coordinate);
    let variation = SineVariation { coordinate, k: 1 };
    let mut curves = Vec::new();
    for (with_q, with_p) in
        [(true, MomentumRule::Kept), (false, MomentumRule::Varied), (true, MomentumRule::OfPath)]
    {
        let mut rise = |epsilon: f64| {
            let terms = followed.nodes.iter().zip(followed.path.iter().zip(&momenta));
            let terms = terms.map(|(&(time, weight), (state, own))| {
                let size = if with_q { epsilon } else { 0.0 };
                let varied = variation.of(state, (time, duration), size);
                let mut p = own.clone();
                match with_p {
                    MomentumRule::Kept => {}
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

/// What becomes of the momenta.
#[derive(Clone, Copy)]
enum MomentumRule {
    /// They are those of the motion.
    Kept,
    /// They are varied by themselves.
    Varied,
    /// They are those of the velocities.
    OfPath,
}

fn unsuited(why: &str) -> DynamicsError {
    DynamicsError::Unsuited(why.to_owned())
}

/// Σ p q̇.
fn product(momenta: &[f64], state: &[f64]) -> f64 {
    momenta.iter().zip(&state[momenta.len()..]).map(|(p, v)| p * v).sum()
}

/// Half of the range of a number on the way; 1 if it stays.
fn half_range(path: &[Vec<f64>], index: usize) -> f64 {
    let (least, greatest) = path.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), q| {
        (lo.min(q[index]), hi.max(q[index]))
    });
    let half = 0.5 * (greatest - least);
    if half.is_normal() { half } else { 1.0 }
}

/// ε sin(kπs)/k, added to a coordinate.
#[derive(Clone, Copy)]
struct SineVariation {
    coordinate: usize,
    k: usize,
}

impl SineVariation {
    /// q and q̇ of the varied path.
    fn of(self, state: &[f64], (time, duration): (f64, f64), epsilon: f64) -> Vec<f64> {
        let mut varied = state.to_vec();
        let (k, n) = (self.k as f64, state.len() / 2);
        let rate = k * PI / duration;
        varied[self.coordinate] += epsilon / k * math::sin(rate * time);
        varied[n + self.coordinate] += epsilon / k * rate * math::cos(rate * time);
        varied
    }
}

/// A motion at the nodes of a rule by which the integral of its action settles.
struct SampledMotion {
    duration: f64,
    /// The number of even parts of the path; kinks of the law by the time divide them.
    parts: usize,
    /// Times and weights.
    nodes: Vec<(f64, f64)>,
    /// q and q̇ at each.
    path: Vec<Vec<f64>>,
    integral: f64,
}

impl SampledMotion {
    /// At the nodes of so many parts; nothing is integrated yet.
    fn sampled(
        motion: Motion<'_>,
        (duration, breaks): (f64, &[f64]),
        parts: usize,
    ) -> Result<SampledMotion, DynamicsError> {
        let nodes = nodes(parts, (duration, breaks));
        let times: Vec<f64> = nodes.iter().map(|&(time, _)| time).collect();
        let path = motion(&times).filter(|path| path.len() == nodes.len());
        let path = path.ok_or_else(|| unsuited("the motion cannot be followed so far"))?;
        Ok(SampledMotion { duration, parts, nodes, path, integral: f64::NAN })
    }

    fn of(
        motion: Motion<'_>,
        (duration, breaks): (f64, &[f64]),
        fewest: usize,
        integrand: &mut dyn FnMut(f64, &[f64]) -> f64,
    ) -> Result<SampledMotion, DynamicsError> {
        let (mut before, mut size_before) = (f64::NAN, f64::NAN);
        for parts in PARTS.into_iter().filter(|&parts| parts >= fewest) {
            let sampled = SampledMotion::sampled(motion, (duration, breaks), parts)?;
            let terms: Vec<f64> = (sampled.nodes.iter().zip(&sampled.path))
                .map(|(&(time, weight), state)| weight * integrand(time, state))
                .collect();
            let integral: f64 = terms.iter().sum();
            if !integral.is_finite() {
                return Err(unsuited("L is not finite on this motion"));
            }
            let size: f64 = terms.iter().map(|term| term.abs()).sum();
            let bounded = (size - size_before).abs() <= SIZE_SETTLED * size;
            if bounded && (integral - before).abs() <= SETTLED * size {
                return Ok(SampledMotion { integral, ..sampled });
            }
            (before, size_before) = (integral, size);
        }
        Err(unsuited("the integral of L along this motion does not settle: it is not smooth"))
    }

    /// A(ε) − A(0) of a variation, where there is an action.
    fn curve(
        &self,
        variation: SineVariation,
        integrand: &mut dyn FnMut(f64, &[f64]) -> f64,
    ) -> Vec<[f64; 2]> {
        let mut rise = |epsilon: f64| {
            let terms = self.nodes.iter().zip(&self.path).map(|(&(time, weight), state)| {
                let varied = variation.of(state, (time, self.duration), epsilon);
                weight * (integrand(time, &varied) - integrand(time, state))
            });
            terms.sum::<f64>()
        };
        self.points(variation.coordinate, &mut rise)
    }

    /// ∂S/∂q of a coordinate and ∂S/∂t at both ends, on paths that are moved by ever less towards the other end, and the sizes
    /// of what each adds up: with a share s that is 1 at the end and 0 at the other, ∫ (s ∂L/∂q + ṡ p) dt, and
    /// ∫ (s ∂L/∂t − ṡ H) dt of times t + ε s.
    fn end_slopes(&self, coordinate: usize, lagrangian: &mut Lagrangian) -> [[EndIntegral; 2]; 2] {
        let mut slopes = [[EndIntegral { value: 0.0, size: 0.0, error: 0.0 }; 2]; 2];
        for (&(time, weight), state) in self.nodes.iter().zip(&self.path) {
            let by_position = [
                lagrangian.force(time, state, coordinate),
                lagrangian.momenta(time, state)[coordinate],
            ];
            let by_time = [lagrangian.explicit_rate(time, state), -lagrangian.energy(time, state)];
            let part = time / self.duration;
            for (end, (share, rate)) in [(1.0 - part, -1.0), (part, 1.0)].into_iter().enumerate() {
                for (slope, [by_share, by_rate]) in
                    slopes[end].iter_mut().zip([by_position, by_time])
                {
                    let terms = [share * by_share, rate / self.duration * by_rate];
                    slope.value += weight * (terms[0] + terms[1]);
                    slope.size += weight * (terms[0].abs() + terms[1].abs());
                }
            }
        }
        slopes
    }

    /// The points (ε, rise) up to half of the range of a coordinate, where the rise is finite.
    fn points(&self, coordinate: usize, rise: &mut dyn FnMut(f64) -> f64) -> Vec<[f64; 2]> {
        let reach = half_range(&self.path, coordinate);
        let epsilons = (-SIDE..=SIDE).map(|i| reach * f64::from(i) / f64::from(SIDE));
        epsilons.map(|epsilon| [epsilon, rise(epsilon)]).filter(|at| at[1].is_finite()).collect()
    }
}

/// The times and weights of the rule on so many parts of a duration, which are divided at these times.
fn nodes(parts: usize, (duration, breaks): (f64, &[f64])) -> Vec<(f64, f64)> {
    let mut rule = gauss(NODES);
    rule.sort_by(|a, b| a.0.total_cmp(&b.0));
    let even = (0..=parts).map(|k| duration * (k as f64 / parts as f64));
    let mut edges: Vec<f64> = even.chain(breaks.iter().copied()).collect();
    edges.sort_by(f64::total_cmp);
    let part = |edges: &[f64]| {
        let (begin, width) = (edges[0], edges[1] - edges[0]);
        rule.iter().map(|&(x, weight)| (begin + width * x, width * weight)).collect::<Vec<_>>()
    };
    edges.windows(2).filter(|edges| edges[0] < edges[1]).flat_map(part).collect()
}

/// The times at which the law has a kink by the time, as a ramp has at its ends: between them alone an integral along the motion
/// converges fast.
fn breaks(lagrangian: &mut Lagrangian, motion: Motion<'_>, duration: f64) -> Vec<f64> {
    let mut found = Vec::new();
    if !lagrangian.has_switches() {
        return found;
    }
    let times: Vec<f64> = (0..=LOOKS).map(|k| duration * (k as f64 / LOOKS as f64)).collect();
    let states = motion(&times).unwrap_or_default();
    for (pair, state) in times.windows(2).zip(&states) {
        let mut sides = |time: f64| lagrangian.switches(time, state);
        let (before, after) = (sides(pair[0]), sides(pair[1]));
        for switch in (0..before.len()).filter(|&i| before[i] != after[i]) {
            let [mut low, mut high] = [pair[0], pair[1]];
            loop {
                let middle = f64::midpoint(low, high);
                if middle <= low || middle >= high {
                    break;
                }
                let side = sides(middle)[switch];
                *(if side == before[switch] { &mut low } else { &mut high }) = middle;
            }
            found.push(high);
        }
    }
    found
}
