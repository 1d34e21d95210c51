//! Level curves of a function given on a grid, by marching squares.
//!
//! In: values at grid points, NaN where undefined, and levels. Out: polylines in data coordinates.
//! Never here: where the values come from.
//!
//! Source: W. Lorensen and H. Cline, "Marching cubes" (1987), in two dimensions; a saddle is
//! resolved by the mean of its four corners.

use std::borrow::Cow;

/// Values on a rectangular grid, row by row from the lowest `y`, each row from the lowest `x`.
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a> {
    /// The number of columns, and the coordinates of the first and the last one.
    pub x: (usize, [f64; 2]),
    /// The number of rows, and the coordinates of the first and the last one.
    pub y: (usize, [f64; 2]),
    /// The values; the missing values of short rows are undefined.
    pub values: &'a [f64],
}

/// A side of a grid cell: the point it starts at, and whether it is vertical.
type CellSide = (usize, usize, bool);

/// A segment of a curve inside a cell: the two sides that it crosses.
type Segment = (CellSide, CellSide);

impl Grid<'_> {
    /// Returns the curves on which the values are `level`. Closed ones end where they begin.
    pub fn curves(&self, level: f64) -> Vec<Vec<[f64; 2]>> {
        self.curves_of_all(&[level]).pop().unwrap_or_default()
    }

    /// The same for several levels at once, from the lowest to the highest.
    pub fn curves_of_all(&self, levels: &[f64]) -> Vec<Vec<Vec<[f64; 2]>>> {
        debug_assert!(levels.is_sorted(), "the ranks of values count the levels below them");
        let mut table = SegmentTable::of(self.x.0, self.y.0);
        let curve = |level: f64, sides: Vec<CellSide>| {
            sides.into_iter().map(|side| self.crossing(side, level)).collect()
        };
        let segments = self.segments(levels);
        let of_level = |(&level, segments): (&f64, Vec<Segment>)| {
            table.join(&segments).into_iter().map(|sides| curve(level, sides)).collect()
        };
        levels.iter().zip(segments).map(of_level).collect()
    }

    /// The segments of the curves of each level inside each grid cell.
    fn segments(&self, levels: &[f64]) -> Vec<Vec<Segment>> {
        let mut segments = vec![Vec::new(); levels.len()];
        let mut above = self.row(0);
        let mut ranks_above = ranks(&above, levels);
        for row in 1..self.y.0 {
            let (j, below, ranks_below) = (row - 1, above, ranks_above);
            above = self.row(row);
            ranks_above = ranks(&above, levels);
            for i in 0..self.x.0.saturating_sub(1) {
                let (a, b) = (ranks_below[i], ranks_below[i + 1]);
                let (c, d) = (ranks_above[i], ranks_above[i + 1]);
                // most cells are between two levels
                if a == b && b == c && c == d {
                    continue;
                }
                let (least, most) = (a.min(b).min(c).min(d), a.max(b).max(c).max(d));
                let corners = [below[i], below[i + 1], above[i + 1], above[i]];
                if !corners.iter().all(|v| v.is_finite()) {
                    continue;
                }
                for k in least as usize..most as usize {
                    add_segments((i, j), corners, levels[k], &mut segments[k]);
                }
            }
        }
        segments
    }

    /// The values of a row, those that are missing undefined.
    fn row(&self, j: usize) -> Cow<'_, [f64]> {
        let count = self.x.0;
        match self.values.get(j * count..(j + 1) * count) {
            Some(row) => Cow::Borrowed(row),
            None => Cow::Owned((0..count).map(|i| self.value((i, j))).collect()),
        }
    }

    fn value(&self, (i, j): (usize, usize)) -> f64 {
        self.values.get(j * self.x.0 + i).copied().unwrap_or(f64::NAN)
    }

    /// The point where the level crosses a side, by linear interpolation.
    fn crossing(&self, (i, j, vertical): CellSide, level: f64) -> [f64; 2] {
        let a = self.value((i, j));
        let b = self.value(if vertical { (i, j + 1) } else { (i + 1, j) });
        // Halved to avoid overflow; the two ends differ, or the side would not be crossed.
        let t = ((level / 2.0 - a / 2.0) / (b / 2.0 - a / 2.0)).clamp(0.0, 1.0);
        let (s, t) = if vertical { (0.0, t) } else { (t, 0.0) };
        let place = |(count, [from, to]): (usize, [f64; 2]), at: f64| {
            let share = at / (count - 1) as f64;
            from * (1.0 - share) + to * share
        };
        [place(self.x, i as f64 + s), place(self.y, j as f64 + t)]
    }
}

/// How many of the levels each value reaches. One that is undefined reaches none. Ranks are as wide as values, so that vector
/// instructions count several at once.
fn ranks(values: &[f64], levels: &[f64]) -> Vec<u64> {
    let mut ranks = vec![0; values.len()];
    for level in levels {
        for (rank, value) in ranks.iter_mut().zip(values) {
            *rank += u64::from(value >= level);
        }
    }
    ranks
}

/// Adds the segments inside a cell, given by its lower left point and by the values at its corners, counterclockwise from there.
fn add_segments(
    (i, j): (usize, usize),
    corners: [f64; 4],
    level: f64,
    segments: &mut Vec<Segment>,
) {
    let [a, b, c, d] = corners;
    let high = [a >= level, b >= level, c >= level, d >= level];
    // below, right, above, left: the sides between one corner and the next
    let sides = [(i, j, false), (i + 1, j, true), (i, j + 1, false), (i, j, true)];
    let mut crossed = (0..4).filter(|&k| high[k] != high[(k + 1) % 4]).map(|k| sides[k]);
    let (Some(first), Some(second)) = (crossed.next(), crossed.next()) else { return };
    if crossed.next().is_none() {
        segments.push((first, second));
        return;
    }
    let [below, right, above, left] = sides;
    let mean: f64 = corners.iter().map(|v| v / 4.0).sum();
    let joined = (mean >= level) == high[0];
    let pairs =
        if joined { [(below, right), (above, left)] } else { [(left, below), (right, above)] };
    segments.extend(pairs);
}

/// No segment.
const NONE: u32 = u32::MAX;

/// The segments at each side of a grid: a side belongs to two cells, and has at most one segment in each.
struct SegmentTable {
    columns: usize,
    at: Vec<[u32; 2]>,
}

impl SegmentTable {
    /// An empty table of a grid of so many columns and rows.
    fn of(columns: usize, rows: usize) -> SegmentTable {
        SegmentTable { columns, at: vec![[NONE; 2]; 2 * columns * rows] }
    }

    fn place(&self, (i, j, vertical): CellSide) -> usize {
        2 * (j * self.columns + i) + usize::from(vertical)
    }

    /// Joins segments into curves: open ones first, from one end to the other, then the closed ones. The table is empty before
    /// and after it.
    fn join(&mut self, segments: &[Segment]) -> Vec<Vec<CellSide>> {
        let sides = || segments.iter().flat_map(|(a, b)| [*a, *b]);
        for (index, side) in sides().enumerate() {
            let place = self.place(side);
            let own = &mut self.at[place];
            own[usize::from(own[0] != NONE)] = (index / 2) as u32;
        }
        let mut used = vec![false; segments.len()];
        let mut curves = Vec::new();
        let ends = sides().filter(|&side| self.at[self.place(side)][1] == NONE);
        let all = segments.iter().map(|(a, _)| *a);
        let unused = |here: CellSide, used: &[bool]| {
            let own = self.at[self.place(here)];
            own.into_iter()
                .map(|index| index as usize)
                .find(|&index| used.get(index) == Some(&false))
        };
        for start in ends.chain(all) {
            let Some(first) = unused(start, &used) else { continue };
            let (mut curve, mut here, mut next) = (vec![start], start, Some(first));
            while let Some(index) = next {
                used[index] = true;
                let (a, b) = segments[index];
                here = if a == here { b } else { a };
                curve.push(here);
                next = unused(here, &used);
            }
            curves.push(curve);
        }
        for side in sides() {
            let place = self.place(side);
            self.at[place] = [NONE; 2];
        }
        curves
    }
}
