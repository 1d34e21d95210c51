//! A closed curve of starts carried by the flow, and the integral of Poincaré around it.
//!
//! ∮ Σ p dq around a curve that moves with the flow is constant where the motion is Hamilton's (H. Poincaré, Les méthodes
//! nouvelles, vol. III, ch. XXII; V. I. Arnold, Mathematical Methods of Classical Mechanics, §44): for one degree of
//! freedom it is the area that the curve encloses. The integral is that of the polygon, of every second and of every
//! fourth of its points, extrapolated; their differences say how well it is known. Where the curve is stretched, starts
//! are put between the others and carried along from the beginning.
//!
//! In: starts by a parameter s from 0 to 1. Out: the curve and the integral at each time. Never here: which curve.

use super::SystemFlow;
use crate::num::math;
use crate::system::State;

/// The intervals of a panel: the polygon is extrapolated twice.
const INTERVALS: usize = 4;

/// The panels at first, and the most of them.
const PANELS: usize = 32;
const MOST: usize = 2048;

/// A panel is cut in two if its part of the integral is known less well than this part of all while there are few
/// panels, and than [`UNKNOWN`] where there is room for no more.
const TOLERANCE: f64 = 1e-11;

/// A panel is cut in two as well if one of its intervals is longer than this part of the extent of the curve.
const LONGEST: f64 = 0.05;

/// A panel that is known less well than this part of all, and can be cut no more, leaves the integral unknown.
const UNKNOWN: f64 = 1e-6;

/// How often panels are cut at one time.
const ROUNDS: usize = 64;

/// A start of the curve, and its motion.
#[derive(Clone, Debug)]
struct CurveNode {
    s: f64,
    start: State,
    /// The state at the last time; `None` if it did not get there.
    end: Option<State>,
    /// At each time the two quantities of a picture, the coordinates, the momenta.
    seen: Vec<Vec<f64>>,
}

/// A closed curve of starts, carried along.
#[derive(Clone, Debug)]
pub struct ClosedCurve {
    /// The nodes in order, [`INTERVALS`] for each panel; the last panel ends at the first node.
    nodes: Vec<CurveNode>,
    channels: Vec<usize>,
    /// What is at most the extent of a picture.
    scales: [f64; 2],
    /// Whether the starts were enough at the last time.
    resolved: bool,
}

/// An integral around a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circulation {
    /// ∮ Σ p dq, in the direction of s.
    pub value: f64,
    /// How far the value may be off.
    pub error: f64,
}

impl ClosedCurve {
    /// The curve of these starts, which closes: s = 1 is s = 0. `channels` are the two quantities of a picture, the
    /// coordinates, and as many momenta; `scales` are the periods of the two quantities, or infinite. `None` if one of the
    /// starts is none.
    pub fn new(
        start: &dyn Fn(f64) -> Option<State>,
        channels: Vec<usize>,
        scales: [f64; 2],
    ) -> Option<ClosedCurve> {
        let count = PANELS * INTERVALS;
        let node = |i: usize| node(i as f64 / count as f64, start);
        let nodes = (0..count).map(node).collect::<Option<_>>()?;
        Some(ClosedCurve { nodes, channels, scales, resolved: true })
    }

    /// Carries the curve on through these times, and puts starts between the others where it takes them at the last.
    /// `start` is the function that the curve was made of.
    ///
    /// # Errors
    /// Returns an error if there are no threads.
    pub fn carry(
        &mut self,
        flow: &SystemFlow,
        times: &[f64],
        start: &(dyn Fn(f64) -> Option<State> + Sync),
    ) -> Result<(), super::PoolError> {
        self.carry_reporting(flow, times, start, &mut |_| ())
    }

    /// The same. `report` is called with the number of the curve's starts carried so far; with `None` once more starts are
    /// put between the others, as many as it takes, which is not known beforehand.
    ///
    /// # Errors
    /// Returns an error if there are no threads.
    pub fn carry_reporting(
        &mut self,
        flow: &SystemFlow,
        times: &[f64],
        start: &(dyn Fn(f64) -> Option<State> + Sync),
        report: &mut dyn FnMut(Option<u64>),
    ) -> Result<(), super::PoolError> {
        let nodes: Vec<CurveNode> = std::mem::take(&mut self.nodes);
        let begun = nodes.iter().any(|node| node.end.is_some());
        let ends =
            |node: &CurveNode| if begun { node.end.clone() } else { Some(node.start.clone()) };
        self.nodes = self.carried(flow, times, nodes, &ends, &mut |done| report(Some(done)))?;
        for _ in 0..ROUNDS {
            let want;
            (want, self.resolved) = self.wanting();
            if flow.system.cancel().is_cancelled() {
                break;
            }
            let added = self.between(&want, start);
            if added.is_empty() {
                break;
            }
            report(None);
            let from = |node: &CurveNode| Some(node.start.clone());
            let added = self.carried(flow, times, added, &from, &mut |_| ())?;
            self.nodes.extend(added);
            self.nodes.sort_by(|a, b| a.s.total_cmp(&b.s));
        }
        Ok(())
    }

    /// The nodes after they were carried from where `from` says; what is lost stays so.
    fn carried(
        &self,
        flow: &SystemFlow,
        times: &[f64],
        mut nodes: Vec<CurveNode>,
        from: &(dyn Fn(&CurveNode) -> Option<State> + Sync),
        done: &mut dyn FnMut(u64),
    ) -> Result<Vec<CurveNode>, super::PoolError> {
        let from: Vec<Option<State>> = nodes.iter().map(from).collect();
        let from: Vec<Option<&State>> = from.iter().map(Option::as_ref).collect();
        let results = flow.carry_all(&from, times, &self.channels, done)?;
        for (node, carried) in nodes.iter_mut().zip(results) {
            (node.end, node.seen) = (carried.end, carried.seen);
        }
        Ok(nodes)
    }

    /// The first of a panel's nodes and those after it, with the one at which it ends.
    fn panel(&self, panel: usize) -> [&CurveNode; INTERVALS + 1] {
        let count = self.nodes.len();
        std::array::from_fn(|i| &self.nodes[(panel * INTERVALS + i) % count])
    }

    fn panels(&self) -> usize {
        self.nodes.len() / INTERVALS
    }

    /// How much each panel wants to be cut, above 1 where it does, by what is seen at the last time; and whether the
    /// integral is known without.
    fn wanting(&self) -> (Vec<f64>, bool) {
        let last = self.nodes.first().and_then(|node| node.seen.len().checked_sub(1));
        let parts = last.and_then(|last| {
            (0..self.panels()).map(|k| self.part(k, last)).collect::<Option<Vec<PanelIntegral>>>()
        });
        // where a start was lost there is no integral, however many others there are
        let (Some(last), Some(parts)) = (last, parts) else { return (Vec::new(), false) };
        let size: f64 = parts.iter().map(|part| part.size).sum();
        let extent = self.extent(last);
        let length = |panel: usize| {
            let nodes = self.panel(panel);
            let pairs = nodes.windows(2).filter_map(|pair| {
                let [a, b] = [pair[0].seen.get(last)?, pair[1].seen.get(last)?];
                let part = |k: usize| (a[k] - b[k]).abs() / (LONGEST * extent[k]);
                Some(part(0).max(part(1)))
            });
            pairs.fold(0.0, f64::max)
        };
        let room = self.panels() as f64 / MOST as f64;
        let tolerance = TOLERANCE * math::powf(UNKNOWN / TOLERANCE, math::powi(room, 4));
        let want =
            |(k, part): (usize, &PanelIntegral)| (part.error / (tolerance * size)).max(length(k));
        let known =
            |(k, part): (usize, &PanelIntegral)| part.error <= UNKNOWN * size && length(k) <= 1.0;
        (parts.iter().enumerate().map(want).collect(), parts.iter().enumerate().all(known))
    }

    fn extent(&self, time: usize) -> [f64; 2] {
        [0, 1].map(|k| {
            let all = self.nodes.iter().filter_map(|node| Some(node.seen.get(time)?[k]));
            let (lo, hi) =
                all.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| (lo.min(x), hi.max(x)));
            (hi - lo).min(self.scales[k])
        })
    }

    /// The nodes that cut the panels that want it, one between each two; those that want it most first, as far as there
    /// is room.
    fn between(&self, want: &[f64], start: &dyn Fn(f64) -> Option<State>) -> Vec<CurveNode> {
        let mut cut: Vec<usize> = (0..want.len()).filter(|&panel| want[panel] > 1.0).collect();
        cut.sort_by(|a, b| want[*b].total_cmp(&want[*a]));
        let halves = |panel: usize| {
            let ends = self.panel(panel).map(|node| node.s);
            let middle = |i: usize| {
                let to = if ends[i + 1] > ends[i] { ends[i + 1] } else { 1.0 };
                let s = f64::midpoint(ends[i], to);
                (s > ends[i] && s < to).then(|| node(s, start)).flatten()
            };
            (0..INTERVALS).map(middle).collect::<Option<Vec<_>>>()
        };
        let room = MOST.saturating_sub(self.panels());
        cut.into_iter().filter_map(halves).take(room).flatten().collect()
    }

    /// The part of the integral along a panel; `None` where a node was lost.
    fn part(&self, panel: usize, time: usize) -> Option<PanelIntegral> {
        let nodes = self.panel(panel);
        let degrees = (self.channels.len() - 2) / 2;
        // around a closed curve it makes no difference what is taken from p, and less is rounded
        let level = &self.nodes.first()?.seen.get(time)?[2 + degrees..];
        let mut rows: [&[f64]; INTERVALS + 1] = [&[]; INTERVALS + 1];
        for (row, node) in rows.iter_mut().zip(nodes) {
            *row = node.seen.get(time)?;
        }
        let along = |step: usize| -> f64 {
            let ends = (0..INTERVALS).step_by(step).map(|i| (rows[i], rows[i + step]));
            ends.map(|(a, b)| trapezoid(level, a, b)).sum()
        };
        let (fine, middle, coarse) = (along(1), along(2), along(4));
        let (once, before) = ((4.0 * fine - middle) / 3.0, (4.0 * middle - coarse) / 3.0);
        let value = (16.0 * once - before) / 15.0;
        let size = (0..INTERVALS).map(|i| trapezoid(level, rows[i], rows[i + 1]).abs()).sum();
        Some(PanelIntegral { value, error: (value - once).abs(), size })
    }

    /// The integral around the curve at one of the last times; `None` where a start was lost on the way, or the curve is
    /// stretched too far for the number of its starts.
    pub fn circulation(&self, time: usize) -> Option<Circulation> {
        if !self.resolved {
            return None;
        }
        let parts: Vec<PanelIntegral> =
            (0..self.panels()).map(|panel| self.part(panel, time)).collect::<Option<_>>()?;
        let size: f64 = parts.iter().map(|part| part.size).sum();
        let rounding = f64::EPSILON * size;
        Some(Circulation {
            value: parts.iter().map(|part| part.value).sum(),
            error: parts.iter().map(|part| part.error).sum::<f64>() + rounding,
        })
    }

    /// The curve in the plane of the picture at one of the last times, from its first point to its first point: where a
    /// start was lost, and between two that are too far apart to be joined, one that is not a number.
    pub fn points(&self, time: usize) -> Vec<[f64; 2]> {
        let lost = [f64::NAN; 2];
        let at = |node: &CurveNode| node.seen.get(time).map_or(lost, |row| [row[0], row[1]]);
        let longest = self.extent(time).map(|extent| LONGEST * extent);
        let mut points: Vec<[f64; 2]> = Vec::with_capacity(self.nodes.len() + 1);
        for here in self.nodes.iter().chain(self.nodes.first()).map(at) {
            if let Some(last) = points.last()
                && (0..2).any(|k| (here[k] - last[k]).abs() > longest[k])
            {
                points.push(lost);
            }
            points.push(here);
        }
        points
    }

    /// The number of starts.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Whether the starts were enough for the curve at the last time.
    pub fn is_resolved(&self) -> bool {
        self.resolved
    }

    /// Whether all starts got to the last time.
    pub fn is_whole(&self) -> bool {
        self.nodes.iter().all(|node| node.end.is_some())
    }
}

/// The part of an integral along a panel, and how far it may be off; the size is that without cancellation.
#[derive(Clone, Copy)]
struct PanelIntegral {
    value: f64,
    error: f64,
    size: f64,
}

fn node(s: f64, start: &dyn Fn(f64) -> Option<State>) -> Option<CurveNode> {
    Some(CurveNode { s, start: start(s)?, end: None, seen: Vec::new() })
}

/// Σ (p − level) dq along a straight line between two rows.
fn trapezoid(level: &[f64], a: &[f64], b: &[f64]) -> f64 {
    let pair = |i: usize| {
        let (q, p) = (2 + i, 2 + level.len() + i);
        (f64::midpoint(a[p], b[p]) - level[i]) * (b[q] - a[q])
    };
    (0..level.len()).map(pair).sum()
}
