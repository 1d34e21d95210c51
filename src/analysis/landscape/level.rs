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

impl Grid<'_> {
    /// Returns the curves on which the values are `level`. Closed ones end where they begin.
    pub fn curves(&self, level: f64) -> Vec<Vec<[f64; 2]>> {
        join(&self.segments(level), self.x.0)
            .into_iter()
            .map(|sides| sides.into_iter().map(|side| self.crossing(side, level)).collect())
            .collect()
    }

    /// The segments of the curve inside each grid cell, as pairs of crossed sides.
    fn segments(&self, level: f64) -> Vec<(CellSide, CellSide)> {
        let mut segments = Vec::new();
        let highs = |row: &[f64]| row.iter().map(|v| u8::from(*v >= level)).collect::<Vec<u8>>();
        let mut above = self.row(0);
        let mut highs_above = highs(&above);
        for row in 1..self.y.0 {
            let (j, below, highs_below) = (row - 1, above, highs_above);
            above = self.row(row);
            highs_above = highs(&above);
            let pairs = highs_below.windows(2).zip(highs_above.windows(2));
            for (i, (a, b)) in pairs.enumerate() {
                // most cells are on one side
                let count = a[0] + a[1] + b[0] + b[1];
                if count == 0 || count == 4 {
                    continue;
                }
                let corners = [below[i], below[i + 1], above[i + 1], above[i]];
                if !corners.iter().all(|v| v.is_finite()) {
                    continue;
                }
                let high = corners.map(|v| v >= level);
                // Below, right, above, left: the sides between one corner and the next.
                let sides = [(i, j, false), (i + 1, j, true), (i, j + 1, false), (i, j, true)];
                let crossed: Vec<CellSide> =
                    (0..4).filter(|&k| high[k] != high[(k + 1) % 4]).map(|k| sides[k]).collect();
                match crossed[..] {
                    [a, b] => segments.push((a, b)),
                    [below, right, above, left] => {
                        let mean: f64 = corners.iter().map(|v| v / 4.0).sum();
                        let joined = (mean >= level) == high[0];
                        let pairs = if joined {
                            [(below, right), (above, left)]
                        } else {
                            [(left, below), (right, above)]
                        };
                        segments.extend(pairs);
                    }
                    _ => {}
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

/// No segment.
const NONE: u32 = u32::MAX;

/// Joins segments on a grid of so many columns into curves: open ones first, from one end to the other, then the closed ones.
fn join(segments: &[(CellSide, CellSide)], columns: usize) -> Vec<Vec<CellSide>> {
    let place = |&(i, j, vertical): &CellSide| 2 * (j * columns + i) + usize::from(vertical);
    let sides = || segments.iter().flat_map(|(a, b)| [a, b]);
    // a side belongs to two cells, and has one segment in each
    let count = sides().map(place).max().map_or(0, |last| last + 1);
    let mut at = vec![[NONE; 2]; count];
    for (index, side) in sides().enumerate() {
        let own = &mut at[place(side)];
        own[usize::from(own[0] != NONE)] = (index / 2) as u32;
    }
    let mut used = vec![false; segments.len()];
    let mut curves = Vec::new();
    let ends = sides().copied().filter(|side| at[place(side)][1] == NONE);
    let all = segments.iter().map(|(a, _)| *a);
    for start in ends.chain(all) {
        let mut curve = vec![start];
        let mut here = start;
        while let Some(next) =
            at[place(&here)].into_iter().find(|&index| index != NONE && !used[index as usize])
        {
            let next = next as usize;
            used[next] = true;
            let (a, b) = segments[next];
            here = if a == here { b } else { a };
            curve.push(here);
        }
        if curve.len() > 1 {
            curves.push(curve);
        }
    }
    curves
}
