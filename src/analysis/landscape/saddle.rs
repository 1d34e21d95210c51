//! Saddles of the energy: found on a grid, refined by Newton's method.
//!
//! In: the energy over a region of the phase plane. Out: the saddles, and their energies. Never
//! here: which of them matter.

use super::energy::{Energy, spread};
use crate::num::math;

/// A point where the energy has a minimum in one direction and a maximum in another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Saddle {
    /// The coordinate and the rate.
    pub(super) at: [f64; 2],
    pub(super) energy: f64,
}

/// The saddles inside a region, searched for on `count` × `count` points.
pub(super) fn saddles(energy: &mut Energy, region: [[f64; 2]; 2], count: usize) -> Vec<Saddle> {
    let axes = region.map(|range| spread(range, count));
    let values = energy.grid(&axes[0], &axes[1]);
    let mut found: Vec<Saddle> = Vec::new();
    for j in 1..count - 1 {
        for i in 1..count - 1 {
            if !is_saddle(&values, count, i, j) {
                continue;
            }
            let cell = [0, 1].map(|axis| (region[axis][1] - region[axis][0]) / (count - 1) as f64);
            let Some(saddle) = refine(energy, [axes[0][i], axes[1][j]], cell) else { continue };
            let near =
                |other: &Saddle| (0..2).all(|k| (other.at[k] - saddle.at[k]).abs() < cell[k]);
            if !found.iter().any(near) {
                found.push(saddle);
            }
        }
    }
    found
}

/// The second differences that rounding leaves of an energy which is constant, relative to it.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The curvatures along the principal axes of a quadratic.
fn principal(xx: f64, yy: f64, xy: f64) -> [f64; 2] {
    let (middle, half) = (0.5 * (xx + yy), math::hypot(0.5 * (xx - yy), xy));
    [middle - half, middle + half]
}

/// Whether the eight neighbours of a grid point, in cyclic order, change at least twice each from
/// above to below it and back.
fn is_saddle(values: &[f64], count: usize, i: usize, j: usize) -> bool {
    const RING: [(isize, isize); 8] =
        [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];
    let here = values[j * count + i];
    let at = |(di, dj): (isize, isize)| {
        values[j.saturating_add_signed(dj) * count + i.saturating_add_signed(di)]
    };
    let mut above = 0_u8;
    for (k, &place) in RING.iter().enumerate() {
        above |= u8::from(at(place) > here) << k;
    }
    let changes = (above ^ above.rotate_left(1)).count_ones();
    changes >= 4 && RING.iter().all(|&place| (at(place) - here).is_finite())
}

/// Newton's method on a quadratic through nine points that converge. Returns `None` if it leads
/// away or to no saddle, as where one of the curvatures is no more than rounding.
fn refine(energy: &mut Energy, start: [f64; 2], cell: [f64; 2]) -> Option<Saddle> {
    let mut at = start;
    let mut reach = cell.map(|c| 0.5 * c);
    for _ in 0..12 {
        let axes = [0, 1].map(|k| [at[k] - reach[k], at[k], at[k] + reach[k]]);
        let v = energy.grid(&axes[0], &axes[1]);
        // Derivatives in units of `reach`.
        let slope = [(v[5] - v[3]) / 2.0, (v[7] - v[1]) / 2.0];
        let [xx, yy] = [v[5] - 2.0 * v[4] + v[3], v[7] - 2.0 * v[4] + v[1]];
        let xy = (v[8] - v[6] - v[2] + v[0]) / 4.0;
        let determinant = xx * yy - xy * xy;
        let rounding = ROUNDING * v.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let [least, greatest] = principal(xx, yy, xy);
        if determinant.is_nan() || least >= -rounding || greatest <= rounding {
            return None;
        }
        let step = [
            (xy * slope[1] - yy * slope[0]) / determinant,
            (xy * slope[0] - xx * slope[1]) / determinant,
        ];
        for k in 0..2 {
            at[k] += (step[k] * reach[k]).clamp(-cell[k], cell[k]);
            if (at[k] - start[k]).abs() > 2.0 * cell[k] {
                return None;
            }
            // Differences not far above rounding must not shrink any more.
            let curved = [xx, yy][k].abs() > 1e-7 * v[4].abs();
            let least = if curved { 1e-3 * cell[k] } else { reach[k] };
            reach[k] = (0.5 * reach[k]).max(least);
        }
    }
    let energy = energy.grid(&[at[0]], &[at[1]])[0];
    energy.is_finite().then_some(Saddle { at, energy })
}
