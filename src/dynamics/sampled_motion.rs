//! A motion at the nodes of a rule by which integrals along it settle.
//!
//! In: a motion, the times at which it is not smooth. Out: times, weights and states, and sums over them. Never here: actions.

use std::f64::consts::PI;

use super::action::{Lagrangian, unsuited};
use super::error::DynamicsError;
use crate::num::{gauss, math};

/// The nodes of the rule on each part of the path, and the number of parts, doubled until the action
/// of the motion changes by less than a share of the size of its terms, and that size by less than
/// another: on either side of a pole they may cancel.
const NODES: usize = 12;
const PARTS: [usize; LEVELS] = [4, 8, 16, 32, 64, 128, 256, 512];
pub(super) const LEVELS: usize = 8;

/// Between the ends of the steps of a method more nodes are taken instead, and the path has at least so many parts.
const NODES_IN_A_STEP: [usize; LEVELS] = [2, 3, 4, 5, 6, 8, 10, 12];
const PARTS_OF_STEPS: usize = 16;

/// Of more steps no integral is taken step by step.
const MOST_STEPS: usize = 16_384;

const SETTLED: f64 = 1e-13;
const SIZE_SETTLED: f64 = 1e-3;

/// Kinks of the law by the time are searched for between so many times.
const SAMPLES: usize = 128;

/// The number of values of ε on either side of 0.
const SIDE: i32 = 12;

/// The duration of a motion, and the times on the way at which it is not smooth.
#[derive(Clone, Copy, Debug)]
pub struct MotionSpan<'a> {
    /// From its beginning.
    pub duration: f64,
    /// The ends of the steps of its method, where its dense output has corners; none if it is smooth.
    pub step_ends: &'a [f64],
}

impl From<f64> for MotionSpan<'_> {
    fn from(duration: f64) -> Self {
        MotionSpan { duration, step_ends: &[] }
    }
}

/// What gives q and then q̇ of a motion at ascending times from its beginning, or `None` where it cannot be followed.
pub(super) type Motion<'a> = &'a mut dyn FnMut(&[f64]) -> Option<Vec<Vec<f64>>>;

/// An integral along the path.
#[derive(Clone, Copy)]
pub(super) struct EndIntegral {
    pub(super) value: f64,
    /// The sum of the absolute values of its terms.
    pub(super) size: f64,
    pub(super) error: f64,
}

/// Half of the range of a number on the way; 1 if it stays.
pub(super) fn half_range(path: &[Vec<f64>], index: usize) -> f64 {
    let (least, greatest) = path.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), q| {
        (lo.min(q[index]), hi.max(q[index]))
    });
    let half = 0.5 * (greatest - least);
    if half.is_normal() { half } else { 1.0 }
}

/// ε sin(kπs)/k, added to a coordinate.
#[derive(Clone, Copy)]
pub(super) struct SineVariation {
    pub(super) coordinate: usize,
    pub(super) k: usize,
}

impl SineVariation {
    /// q and q̇ of the varied path.
    pub(super) fn of(self, state: &[f64], (time, duration): (f64, f64), epsilon: f64) -> Vec<f64> {
        let mut varied = state.to_vec();
        let (k, n) = (self.k as f64, state.len() / 2);
        let rate = k * PI / duration;
        varied[self.coordinate] += epsilon / k * math::sin(rate * time);
        varied[n + self.coordinate] += epsilon / k * rate * math::cos(rate * time);
        varied
    }
}

/// The rules by which integrals along a motion are found, each finer than the one before.
#[derive(Clone)]
pub(super) struct Mesh<'a> {
    pub(super) span: MotionSpan<'a>,
    /// The times at which the law has a kink.
    pub(super) breaks: Vec<f64>,
}

impl Mesh<'_> {
    /// The times and weights of a rule.
    fn nodes(&self, level: usize) -> Vec<(f64, f64)> {
        let MotionSpan { duration, step_ends } = self.span;
        let (parts, nodes) = if step_ends.is_empty() {
            (PARTS[level], NODES)
        } else {
            (PARTS_OF_STEPS, NODES_IN_A_STEP[level])
        };
        let mut rule = gauss(nodes);
        rule.sort_by(|a, b| a.0.total_cmp(&b.0));
        let even = (0..=parts).map(|k| duration * (k as f64 / parts as f64));
        let within = step_ends.iter().copied().filter(|time| (0.0..duration).contains(time));
        let mut edges: Vec<f64> = even.chain(self.breaks.iter().copied()).chain(within).collect();
        edges.sort_by(f64::total_cmp);
        let part = |edges: &[f64]| {
            let (begin, width) = (edges[0], edges[1] - edges[0]);
            rule.iter().map(|&(x, weight)| (begin + width * x, width * weight)).collect::<Vec<_>>()
        };
        edges.windows(2).filter(|edges| edges[0] < edges[1]).flat_map(part).collect()
    }
}

/// A motion at the nodes of a rule by which the integral of its action settles.
pub(super) struct SampledMotion<'a> {
    pub(super) mesh: Mesh<'a>,
    pub(super) level: usize,
    /// Times and weights.
    pub(super) nodes: Vec<(f64, f64)>,
    /// q and q̇ at each.
    pub(super) path: Vec<Vec<f64>>,
    pub(super) integral: f64,
}

impl<'a> SampledMotion<'a> {
    /// At the nodes of a rule; nothing is integrated yet.
    pub(super) fn sampled(
        motion: Motion<'_>,
        mesh: &Mesh<'a>,
        level: usize,
    ) -> Result<SampledMotion<'a>, DynamicsError> {
        let nodes = mesh.nodes(level);
        let times: Vec<f64> = nodes.iter().map(|&(time, _)| time).collect();
        let path = motion(&times).filter(|path| path.len() == nodes.len());
        let path = path.ok_or_else(|| unsuited("the motion cannot be followed so far"))?;
        Ok(SampledMotion { mesh: mesh.clone(), level, nodes, path, integral: f64::NAN })
    }

    /// By the first rule, not before the `least`, that changes the integral no more: where the motion as a whole is not smooth
    /// enough, step by step.
    pub(super) fn of(
        motion: Motion<'_>,
        mesh: &Mesh<'a>,
        least: usize,
        integrand: &mut dyn FnMut(f64, &[f64]) -> f64,
    ) -> Result<SampledMotion<'a>, DynamicsError> {
        let whole = Mesh { span: mesh.span.duration.into(), breaks: mesh.breaks.clone() };
        if let Some(found) = SampledMotion::settled(motion, &whole, least, integrand)? {
            return Ok(found);
        }
        let steps = mesh.span.step_ends.len();
        if steps > MOST_STEPS {
            return Err(unsuited(
                "the integral of L along this motion does not settle: it has a corner after each of too many steps",
            ));
        }
        let by_steps =
            if steps == 0 { None } else { SampledMotion::settled(motion, mesh, least, integrand)? };
        by_steps.ok_or_else(|| {
            unsuited("the integral of L along this motion does not settle: it is not smooth")
        })
    }

    fn settled(
        motion: Motion<'_>,
        mesh: &Mesh<'a>,
        least: usize,
        integrand: &mut dyn FnMut(f64, &[f64]) -> f64,
    ) -> Result<Option<SampledMotion<'a>>, DynamicsError> {
        let (mut before, mut size_before) = (f64::NAN, f64::NAN);
        for level in least..LEVELS {
            let sampled = SampledMotion::sampled(motion, mesh, level)?;
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
                return Ok(Some(SampledMotion { integral, ..sampled }));
            }
            (before, size_before) = (integral, size);
        }
        Ok(None)
    }

    /// A(ε) − A(0) of a variation, where there is an action.
    pub(super) fn curve(
        &self,
        variation: SineVariation,
        integrand: &mut dyn FnMut(f64, &[f64]) -> f64,
    ) -> Vec<[f64; 2]> {
        let mut rise = |epsilon: f64| {
            let terms = self.nodes.iter().zip(&self.path).map(|(&(time, weight), state)| {
                let varied = variation.of(state, (time, self.mesh.span.duration), epsilon);
                weight * (integrand(time, &varied) - integrand(time, state))
            });
            terms.sum::<f64>()
        };
        self.points(variation.coordinate, &mut rise)
    }

    /// ∂S/∂q of a coordinate and ∂S/∂t at both ends, on paths that are moved by ever less towards the other end, and the sizes
    /// of what each adds up: with a share s that is 1 at the end and 0 at the other, ∫ (s ∂L/∂q + ṡ p) dt, and
    /// ∫ (s ∂L/∂t − ṡ H) dt of times t + ε s.
    pub(super) fn end_slopes(
        &self,
        coordinate: usize,
        lagrangian: &mut Lagrangian,
    ) -> [[EndIntegral; 2]; 2] {
        let mut slopes = [[EndIntegral { value: 0.0, size: 0.0, error: 0.0 }; 2]; 2];
        for (&(time, weight), state) in self.nodes.iter().zip(&self.path) {
            let by_position = [
                lagrangian.force(time, state, coordinate),
                lagrangian.momenta(time, state)[coordinate],
            ];
            let by_time = [lagrangian.explicit_rate(time, state), -lagrangian.energy(time, state)];
            let part = time / self.mesh.span.duration;
            for (end, (share, rate)) in [(1.0 - part, -1.0), (part, 1.0)].into_iter().enumerate() {
                for (slope, [by_share, by_rate]) in
                    slopes[end].iter_mut().zip([by_position, by_time])
                {
                    let terms = [share * by_share, rate / self.mesh.span.duration * by_rate];
                    slope.value += weight * (terms[0] + terms[1]);
                    slope.size += weight * (terms[0].abs() + terms[1].abs());
                }
            }
        }
        slopes
    }

    /// The points (ε, rise) up to half of the range of a coordinate, where the rise is finite.
    pub(super) fn points(
        &self,
        coordinate: usize,
        rise: &mut dyn FnMut(f64) -> f64,
    ) -> Vec<[f64; 2]> {
        let reach = half_range(&self.path, coordinate);
        let epsilons = (-SIDE..=SIDE).map(|i| reach * f64::from(i) / f64::from(SIDE));
        epsilons.map(|epsilon| [epsilon, rise(epsilon)]).filter(|at| at[1].is_finite()).collect()
    }
}

/// The times at which the law has a kink by the time, as a ramp has at its ends: between them alone an integral along the motion
/// converges fast.
pub(super) fn breaks(lagrangian: &mut Lagrangian, motion: Motion<'_>, duration: f64) -> Vec<f64> {
    let mut found = Vec::new();
    if !lagrangian.has_switches() {
        return found;
    }
    let times: Vec<f64> = (0..=SAMPLES).map(|k| duration * (k as f64 / SAMPLES as f64)).collect();
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
