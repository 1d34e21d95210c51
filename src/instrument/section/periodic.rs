//! The periodic orbits of the lab on a section: their points, and the curves along which those of a family move.
//!
//! In: the periodic points that other pictures have found. Out: layers. Never here: how they are found.

use std::sync::Arc;

use super::super::periodic_points::{PeriodicOrbits, PeriodicPoints};
use super::super::{Ink, Layer, Level, MarkerShape, Present, Stroke};
use super::portrait::SectionConditions;
use crate::expr::Expr;
use crate::num::math;

/// The level of the marks, over the motion's own crossings.
const MARKS: Level = 4;

/// Points of two orbits that differ by no more than this part of their size are those of one orbit.
const SAME: f64 = 1e-6;

/// The part of the dots that is drawn of the curve of a family.
const SPARSE: f64 = 0.5;

/// The points on a surface, in two channels, of each orbit that has the parameters of the motion and, where that is conserved,
/// its energy, once.
pub(super) fn points<'a>(
    present: &'a Present<'_>,
    section: usize,
    channels: [usize; 2],
) -> impl Iterator<Item = (Option<bool>, Vec<[f64; 2]>)> + 'a {
    let now = SectionConditions::of(present);
    let physics = present.physics;
    let is_conserved =
        physics.equations.energy_rate == Expr::ZERO && physics.model.impulses.is_empty();
    let is_here = move |orbit: &&PeriodicPoints| {
        let near = !is_conserved || now.is_near(orbit.energy);
        near && orbit.parameters == now.parameters
    };
    let orbits = present.periodic.iter().map(|found| &found.orbit).filter(is_here);
    let all = orbits.map(move |orbit| (orbit.stable, orbit.on(section, channels).collect()));
    distinct(all.collect()).into_iter()
}

/// The orbits without those that another picture has found, too, whichever of the points is their first.
fn distinct(all: Vec<(Option<bool>, Vec<[f64; 2]>)>) -> Vec<(Option<bool>, Vec<[f64; 2]>)> {
    let sizes = [0, 1].map(|axis| {
        let values = all.iter().flat_map(|(_, points)| points).map(|at| at[axis].abs());
        values.fold(0.0, f64::max)
    });
    let near = |a: &[f64; 2], b: &[f64; 2]| (0..2).all(|k| (a[k] - b[k]).abs() <= SAME * sizes[k]);
    let mut distinct: Vec<(Option<bool>, Vec<[f64; 2]>)> = Vec::new();
    for (stable, points) in all {
        let is_known = distinct.iter().any(|(_, known)| {
            known.len() == points.len()
                && points.iter().all(|at| known.iter().any(|other| near(at, other)))
        });
        if !is_known {
            distinct.push((stable, points));
        }
    }
    distinct
}

/// The layers that show them, and the families.
pub(super) fn marks(
    present: &Present<'_>,
    section: usize,
    channels: [usize; 2],
) -> Vec<(Level, Layer)> {
    let periods =
        channels.map(|channel| present.physics.system.period(channel, present.parameters));
    let mut layers = Vec::new();
    // until a family is there at new parameters, that at the old ones is another
    let holds = |found: &&Arc<PeriodicOrbits>| found.orbit.parameters == present.parameters;
    for found in present.periodic.iter().filter(holds) {
        let family: Vec<Vec<[f64; 2]>> =
            found.family.iter().map(|orbit| orbit.on(section, channels).collect()).collect();
        for curve in curves(&family, periods) {
            let stroke = Stroke { ink: Ink::Plain, covering: Some(SPARSE) };
            let end = curve.last().copied();
            layers.push((MARKS, Layer::Line(curve, stroke)));
            layers.extend(end.map(|at| (MARKS, Layer::Name(at, "family".to_owned()))));
        }
    }
    for (stable, points) in points(present, section, channels) {
        let (shape, word) = match stable {
            Some(true) => (MarkerShape::Ring, "stable"),
            Some(false) => (MarkerShape::Cross, "unstable"),
            None => (MarkerShape::Ring, "periodic"),
        };
        let name = points.first().map(|at| (MARKS, Layer::Name(*at, word.to_owned())));
        layers.extend(points.into_iter().map(|at| (MARKS, Layer::Point(at, shape, Ink::Plain))));
        layers.extend(name);
    }
    layers
}

/// The curves through the points of the orbits of a family: one for each point, as long as orbits have as many. From an orbit
/// to the next points keep their order along it, but not the first of them.
fn curves(family: &[Vec<[f64; 2]>], periods: [Option<f64>; 2]) -> Vec<Vec<[f64; 2]>> {
    let extent = [0, 1].map(|axis| {
        let all = family.iter().flatten().map(|at| at[axis]);
        let (lo, hi) =
            all.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| (lo.min(x), hi.max(x)));
        if hi > lo { hi - lo } else { 1.0 }
    });
    // the difference of two values, less whole turns
    let apart = |axis: usize, from: f64, to: f64| match periods[axis] {
        Some(period) => (to - from) - period * ((to - from) / period).round(),
        None => to - from,
    };
    let distance = |from: &[f64; 2], to: &[f64; 2]| -> f64 {
        (0..2).map(|k| math::powi(apart(k, from[k], to[k]) / extent[k], 2)).sum()
    };
    let mut done: Vec<Vec<[f64; 2]>> = Vec::new();
    let mut open: Vec<Vec<[f64; 2]>> = Vec::new();
    for points in family {
        let ends: Vec<[f64; 2]> = open.iter().filter_map(|curve| curve.last().copied()).collect();
        if points.len() != ends.len() {
            done.append(&mut open);
            open = points.iter().map(|&at| vec![at]).collect();
            continue;
        }
        let turned = |by: usize| points.iter().cycle().skip(by).take(points.len());
        let total = |by: &usize| -> f64 {
            ends.iter().zip(turned(*by)).map(|(from, to)| distance(from, to)).sum()
        };
        let best = (0..points.len()).min_by(|a, b| total(a).total_cmp(&total(b))).unwrap_or(0);
        for ((curve, from), to) in open.iter_mut().zip(ends).zip(turned(best)) {
            curve.push([0, 1].map(|k| from[k] + apart(k, from[k], to[k])));
        }
    }
    done.append(&mut open);
    done.retain(|curve| curve.len() > 1);
    done
}
