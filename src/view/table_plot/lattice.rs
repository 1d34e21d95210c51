//! Numbers at the places of a lattice, to be read between them.
//!
//! In: points with a number each. Out: the number of the place nearest to a point. Never here: cells.

use std::collections::BTreeMap;

/// Numbers at the places of a lattice, whose columns and rows need not be equally far apart.
pub(super) struct Lattice {
    axes: [Vec<f64>; 2],
    numbers: BTreeMap<[usize; 2], f64>,
}

impl Lattice {
    /// The lattice of points, if they are one: few values of either coordinate, with a point for each of their pairs, or of
    /// more than two for at least half of these.
    pub(super) fn of(points: &[[f64; 3]]) -> Option<Self> {
        let axes = [0, 1].map(|k| {
            let mut all: Vec<f64> = points.iter().map(|point| point[k]).collect();
            all.sort_by(f64::total_cmp);
            all.dedup();
            all
        });
        let [columns, rows] = [axes[0].len(), axes[1].len()];
        if columns < 2 || rows < 2 {
            return None;
        }
        let place = |point: &[f64; 3]| {
            let index = |k: usize| axes[k].partition_point(|x| *x < point[k]);
            ([index(0), index(1)], point[2])
        };
        let numbers: BTreeMap<[usize; 2], f64> = points.iter().map(place).collect();
        let places = columns.checked_mul(rows)?;
        let is_lattice =
            places == numbers.len() || (columns.min(rows) > 2 && places <= 2 * numbers.len());
        is_lattice.then_some(Self { axes, numbers })
    }

    /// The number of the place that is nearest to a point; `None` beyond half a spacing from the outermost places.
    pub(super) fn nearest(&self, at: [f64; 2]) -> Option<f64> {
        let [i, j] = [0, 1].map(|k| nearest(&self.axes[k], at[k]));
        self.numbers.get(&[i?, j?]).copied()
    }
}

/// The nearest of at least two numbers in their order; `None` beyond half a spacing from the first or the last.
fn nearest(all: &[f64], x: f64) -> Option<usize> {
    let last = all.len() - 1;
    let above = all.partition_point(|other| *other < x).clamp(1, last);
    let below = above - 1;
    let half = 0.5 * all[above] - 0.5 * all[below];
    // halves, since the sum of two numbers may be larger than any
    let near = if x - all[below] <= all[above] - x { below } else { above };
    let beyond = (x - all[near]).abs() > half;
    (!beyond).then_some(near)
}
