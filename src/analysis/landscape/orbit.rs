//! The orbit of a conserved energy in the phase plane: how far it reaches, if it is bounded.
//!
//! In: the energy as a function, a point. Out: the least and greatest coordinate and rate of the level curve through it. Never
//! here: how the orbit is run through.

use super::energy::{Energy, spread};
use super::level::Grid;
use super::{Curve, wider};

/// The number of points per side of a grid that is searched.
const SIDE: usize = 41;

/// So many grids are searched at most, each twice as wide as the one before or closer about the curve; an orbit that has not
/// closed by then is treated as unbounded.
const GRIDS: usize = 20;

/// A curve that fills less than this part of a grid is drawn on a finer one.
const SMALL: f64 = 0.25;

/// The horizontal and vertical extent of the level curve through a point, or `None` if it is not closed. The search begins in a
/// region around the point. A periodic coordinate has its whole period, and a curve is closed that goes through it.
pub(super) fn extent(
    energy: &mut Energy,
    at: [f64; 2],
    [mut x, mut y]: [[f64; 2]; 2],
    periodic: bool,
) -> Option<[[f64; 2]; 2]> {
    let level = *energy.grid(&[at[0]], &[at[1]]).first()?;
    for _ in 0..GRIDS {
        let values = energy.grid(&spread(x, SIDE), &spread(y, SIDE));
        let grid = Grid { x: (SIDE, x), y: (SIDE, y), values: &values };
        let curve = through(grid.curves(level), at, [x, y])?;
        let reached = [0, 1].map(|axis| {
            let values = || curve.iter().map(|point| point[axis]);
            [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
        });
        let touches = |[low, high]: [f64; 2], [from, to]: [f64; 2]| {
            let rounding = 1e-9 * (to - from);
            low <= from + rounding || high >= to - rounding
        };
        let leaves = [touches(reached[0], x) && !periodic, touches(reached[1], y)];
        let small = |[low, high]: [f64; 2], [from, to]: [f64; 2]| {
            high > low && high - low < SMALL * (to - from)
        };
        let is_small = [small(reached[0], x) && !periodic, small(reached[1], y)];
        if leaves == [false; 2] && is_small == [false; 2] {
            let ends = curve.first()? == curve.last()? || periodic && touches(reached[0], x);
            return ends.then_some(reached);
        }
        for (axis, region) in [&mut x, &mut y].into_iter().enumerate() {
            if leaves[axis] {
                *region = wider(*region, 2.0);
            } else if is_small[axis] && !leaves[1 - axis] {
                *region = wider(reached[axis], 1.5);
            }
        }
    }
    None
}

/// The curve that passes a point within the cell of a grid over a region.
fn through(curves: Vec<Curve>, at: [f64; 2], region: [[f64; 2]; 2]) -> Option<Curve> {
    let cell = region.map(|[from, to]| (to - from) / (SIDE - 1) as f64);
    let distance = |curve: &Curve| {
        let from = |point: &[f64; 2]| {
            (0..2).map(|k| ((point[k] - at[k]) / cell[k]).abs()).fold(0.0, f64::max)
        };
        curve.iter().map(from).fold(f64::INFINITY, f64::min)
    };
    let nearest = curves.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    (distance(&nearest) <= 1.0).then_some(nearest)
}
