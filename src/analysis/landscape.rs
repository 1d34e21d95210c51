//! The landscape of the energy over the phase plane of one degree of freedom: level curves, saddles
//! and the separatrices through them.
//!
//! In: the compiled system and the region of the motion. Out: a [`Landscape`]. Never here: when to
//! compute it again, or how it is drawn.

mod energy;
mod level;
mod orbit;
mod saddle;

use crate::num::math;
use crate::system::{Form, System};

use energy::{Energy, spread};
pub use level::Grid;
use saddle::saddles;

/// The number of grid points, horizontal and vertical.
const GRID: [usize; 2] = [161, 121];

/// The number of points per side of the coarse grid that is searched for saddles; odd, so that it
/// has a middle row.
const SEARCH: usize = 81;

const LEVELS: usize = 11;

/// A curve in the phase plane, through coordinates and rates.
pub type Curve = Vec<[f64; 2]>;

/// The energy over a window of the phase plane.
#[derive(Clone, Debug)]
pub struct Landscape {
    /// The least and greatest coordinate, and the least and greatest rate.
    pub window: [[f64; 2]; 2],
    /// Curves of equal energy, about evenly spaced, grouped by energy.
    pub levels: Vec<Vec<Curve>>,
    /// Curves at the energies of saddles, which separate kinds of motion.
    pub separatrices: Vec<Curve>,
    /// The positions of the saddles.
    pub saddles: Vec<[f64; 2]>,
}

/// The phase plane to survey.
#[derive(Clone, Copy, Debug)]
pub struct Plane<'a> {
    /// A system of one degree of freedom.
    pub system: &'a System,
    /// Those that the level curves belong to, in the order of the model.
    pub parameters: &'a [f64],
    /// The time at which the energy is taken.
    pub time: f64,
    /// Whether the plane is (q, q̇) or (q, p).
    pub form: Form,
    /// The period of the coordinate, if it is periodic.
    pub period: Option<f64>,
}

impl Landscape {
    /// Surveys the energy around a motion, given by its least and greatest coordinate and rate and by where it is. The
    /// window contains all of the orbit if it is bounded. Returns `None` if the energy has no finite values there.
    pub fn survey(plane: &Plane<'_>, motion: [[f64; 2]; 2], at: [f64; 2]) -> Option<Self> {
        if !motion.as_flattened().iter().all(|v| v.is_finite()) {
            return None;
        }
        let mut energy = Energy {
            observer: plane.system.observer(plane.parameters),
            time: plane.time,
            form: plane.form,
        };
        let period = plane.period;
        let [x, y] = search_region(motion, period);
        let saddles = saddles(&mut energy, [x, y], SEARCH);
        let tops = saddles.iter().map(|s| s.energy).filter(|energy| energy.is_finite());
        let mut tops: Vec<f64> = tops.collect();
        tops.sort_by(f64::total_cmp);
        tops.dedup_by(|a, b| (*a - *b).abs() <= 1e-6 * (a.abs() + b.abs()));
        let orbit = orbit::extent(&mut energy, into_period(at, period), [x, y], period.is_some());
        let reached = orbit.map_or(motion, |orbit| [0, 1].map(|k| join(motion[k], orbit[k])));
        let window = window(&mut energy, reached, period, [x, y], &tops);
        let values = energy.grid(&spread(window[0], GRID[0]), &spread(window[1], GRID[1]));
        let grid = Grid { x: (GRID[0], window[0]), y: (GRID[1], window[1]), values: &values };
        Some(Self {
            window,
            levels: grid.curves_of_all(&levels(&values)?),
            separatrices: grid.curves_of_all(&tops).into_iter().flatten().collect(),
            saddles: saddles.into_iter().map(|s| s.at).collect(),
        })
    }
}

/// A point of the phase plane with its coordinate in the period about zero.
fn into_period([x, y]: [f64; 2], period: Option<f64>) -> [f64; 2] {
    [period.map_or(x, |period| x - period * (x / period).round()), y]
}

/// The least range that contains two.
fn join(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// The region in which saddles are searched for: somewhat more than one period, or than the motion,
/// and around zero if the motion is not too far from there.
fn search_region([x, y]: [[f64; 2]; 2], period: Option<f64>) -> [[f64; 2]; 2] {
    let horizontal = if let Some(period) = period {
        [-0.55 * period, 0.55 * period]
    } else {
        let (middle, half) = middle_and_half(x);
        let far = middle.abs() + 2.0 * half;
        if far <= 20.0 * half { [-far, far] } else { [middle - 3.0 * half, middle + 3.0 * half] }
    };
    let far = y[0].abs().max(y[1].abs()) * 1.5;
    let far = if far > 0.0 { far } else { 1.0 };
    [horizontal, [-far, far]]
}

/// The middle of a range, and half its length, or a substitute if that is negligible.
fn middle_and_half([lo, hi]: [f64; 2]) -> (f64, f64) {
    let middle = lo / 2.0 + hi / 2.0;
    let half = hi / 2.0 - lo / 2.0;
    let least = 1e-3 * middle.abs();
    let half = if half > least {
        half
    } else if middle == 0.0 {
        1.0
    } else {
        0.5 * middle.abs()
    };
    (middle, half)
}

/// A range widened about its middle.
fn wider(range: [f64; 2], by: f64) -> [f64; 2] {
    let (middle, half) = middle_and_half(range);
    [middle - by * half, middle + by * half]
}

/// The window that contains the motion and, if they are not far larger, the separatrices.
fn window(
    energy: &mut Energy,
    motion: [[f64; 2]; 2],
    period: Option<f64>,
    search: [[f64; 2]; 2],
    separatrices: &[f64],
) -> [[f64; 2]; 2] {
    let mut x = period.map_or(motion[0], |period| [-period / 2.0, period / 2.0]);
    let mut y = motion[1];
    if let Some(top) = separatrices.iter().copied().reduce(f64::max) {
        // For a periodic coordinate everything else is flat compared with the separatrix; otherwise
        // it may be out of reach.
        let farthest = if period.is_some() { 1e6 } else { 50.0 };
        let horizontal = if period.is_some() { x } else { wider(search[0], 1.6) };
        if let Some([wide, high]) = reach(energy, horizontal, search[1], top, farthest) {
            x = if period.is_some() { x } else { join(x, wide) };
            y = join(y, high);
        }
    }
    [if period.is_some() { x } else { wider(x, 1.15) }, wider(y, 1.15)]
}

/// The horizontal and vertical extent of the region below an energy within the horizontal range.
/// Returns `None` if it does not end within `farthest` times the vertical range.
fn reach(
    energy: &mut Energy,
    horizontal: [f64; 2],
    mut vertical: [f64; 2],
    top: f64,
    farthest: f64,
) -> Option<[[f64; 2]; 2]> {
    let positions = spread(horizontal, SEARCH);
    let limit = vertical.map(|end| end * farthest);
    // Widened by factors of four until the region ends inside, then sampled once more in its own
    // range.
    let mut closer = false;
    while vertical[1] <= limit[1] && limit[1].is_finite() {
        let rates = spread(vertical, SEARCH);
        let values = energy.grid(&positions, &rates);
        let below = |i: usize, j: usize| values[j * SEARCH + i] <= top;
        let row = |j: usize| (0..SEARCH).any(|i| below(i, j));
        let column = |i: usize| (0..SEARCH).any(|j| below(i, j));
        let (low, high) = ((0..SEARCH).find(|&j| row(j))?, (0..SEARCH).rfind(|&j| row(j))?);
        if low == 0 || high == SEARCH - 1 {
            vertical = vertical.map(|end| end * 4.0);
            continue;
        }
        vertical = [rates[low - 1], rates[high + 1]];
        if closer || vertical[1] - vertical[0] > 0.5 * (rates[SEARCH - 1] - rates[0]) {
            let left = (0..SEARCH).find(|&i| column(i))?;
            let right = (0..SEARCH).rfind(|&i| column(i))?;
            return Some([[positions[left], positions[right]], vertical]);
        }
        closer = true;
    }
    None
}

/// Energies whose curves are about evenly spaced, as around a quadratic minimum. Returns `None` if
/// the energy is constant or nowhere finite.
fn levels(values: &[f64]) -> Option<Vec<f64>> {
    let mut finite = values.to_vec();
    finite.retain(|v| v.is_finite());
    let low = finite.iter().copied().reduce(f64::min)?;
    // A wall of a few points must not take all levels.
    let most = (finite.len() - 1) * 19 / 20;
    let (_, &mut high, _) = finite.select_nth_unstable_by(most, f64::total_cmp);
    let level = |k: usize| low + (high - low) * math::powi((k as f64 + 0.7) / LEVELS as f64, 2);
    (high > low).then(|| (0..LEVELS).map(level).collect())
}
