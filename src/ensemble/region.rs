//! The part of a plane of section that the energy allows, and starts spread over it.
//!
//! In: a [`SectionPlane`]. Out: a window that holds the region, its boundary as line segments, points spread evenly.
//! Never here: orbits, what is drawn.

use std::collections::HashMap;

use super::SectionPlane;
use crate::cancel::Cancel;
use crate::system::{Observer, System};

/// A region of a plane: the part that the energy allows and that hangs together with the motion.
#[derive(Clone, PartialEq, Debug)]
pub struct Region {
    /// The range of each axis.
    pub window: [[f64; 2]; 2],
    /// The boundary of what the energy allows in the window, in segments; empty where the energy does not bound the
    /// plane.
    pub boundary: Vec<[[f64; 2]; 2]>,
    /// The nodes of a grid over the window that belong to the region; empty where the whole plane does.
    nodes: Vec<bool>,
}

/// The cells, along each axis, of the grid on which the boundary is searched for, and of the one by which a window grows.
const CELLS: usize = 56;
const COARSE: usize = 28;

/// Halvings of an edge of the grid that the boundary crosses.
const HALVINGS: u32 = 12;

/// How often a side of a window is moved outwards until it holds the region; a region beyond that has no bound.
const GROWTHS: u32 = 12;

/// A region without a bound is shown as far as the motion has come, and so many times farther.
const OPEN: f64 = 2.0;

/// The margin about the region, as a part of its width.
const MARGIN: f64 = 0.04;

/// Evaluates points of the plane one after the other.
struct RegionScan<'a> {
    plane: &'a SectionPlane,
    system: &'a System,
    observer: Observer,
    cancel: &'a Cancel,
}

/// What the energy allows at the nodes of a grid.
struct EnergyGrid {
    window: [[f64; 2]; 2],
    cells: usize,
    allowed: Vec<bool>,
}

impl EnergyGrid {
    fn of(scan: &mut RegionScan<'_>, window: [[f64; 2]; 2], cells: usize) -> EnergyGrid {
        let mut grid =
            EnergyGrid { window, cells, allowed: vec![false; (cells + 1) * (cells + 1)] };
        for i in 0..=cells {
            for j in 0..=cells {
                if scan.cancel.is_cancelled() {
                    return grid;
                }
                let place = grid.place([i, j]);
                grid.allowed[place] = scan.at(grid.node([i, j]));
            }
        }
        grid
    }

    fn place(&self, [i, j]: [usize; 2]) -> usize {
        j * (self.cells + 1) + i
    }

    fn node(&self, place: [usize; 2]) -> [f64; 2] {
        [0, 1].map(|axis| {
            let [from, to] = self.window[axis];
            from + (to - from) * place[axis] as f64 / self.cells as f64
        })
    }

    fn nodes(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let side = self.cells + 1;
        (0..side * side).map(move |place| [place % side, place / side])
    }

    /// The allowed nodes that hang together with the one next to a point.
    fn component(&self, near: [f64; 2]) -> Vec<bool> {
        let distance = |node: [usize; 2]| {
            let at = self.node(node);
            (0..2)
                .map(|axis| {
                    let [from, to] = self.window[axis];
                    let part = (at[axis] - near[axis]) / (to - from);
                    part * part
                })
                .sum::<f64>()
        };
        let mut found = vec![false; self.allowed.len()];
        let allowed = self.nodes().filter(|node| self.allowed[self.place(*node)]);
        let first = allowed.min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
        let mut open: Vec<[usize; 2]> = first.into_iter().collect();
        while let Some([i, j]) = open.pop() {
            let place = self.place([i, j]);
            if found[place] || !self.allowed[place] {
                continue;
            }
            found[place] = true;
            open.extend((i > 0).then(|| [i - 1, j]));
            open.extend((j > 0).then(|| [i, j - 1]));
            open.extend((i < self.cells).then(|| [i + 1, j]));
            open.extend((j < self.cells).then(|| [i, j + 1]));
        }
        found
    }

    /// The least and greatest place along each axis of some nodes.
    fn extent(&self, nodes: &[bool]) -> Option<[[usize; 2]; 2]> {
        let mut among = self.nodes().filter(|node| nodes[self.place(*node)]);
        let [i, j] = among.next()?;
        Some(among.fold([[i, i], [j, j]], |[[a, b], [c, d]], [i, j]| {
            [[a.min(i), b.max(i)], [c.min(j), d.max(j)]]
        }))
    }
}

impl RegionScan<'_> {
    fn at(&mut self, point: [f64; 2]) -> bool {
        self.plane.is_accessible(self.system, &mut self.observer, point)
    }

    /// A window that holds the region which hangs together with a point. An axis that is `given` keeps its range.
    fn grown(
        &mut self,
        window: [[f64; 2]; 2],
        given: [Option<[f64; 2]>; 2],
        near: [f64; 2],
    ) -> Option<[[f64; 2]; 2]> {
        let mut window = window;
        for _ in 0..GROWTHS {
            let grid = EnergyGrid::of(self, window, COARSE);
            let extent = grid.extent(&grid.component(near))?;
            let mut whole = true;
            for axis in [0, 1].into_iter().filter(|axis| given[*axis].is_none()) {
                let ([from, to], [least, greatest]) = (window[axis], extent[axis]);
                if least == 0 {
                    (window[axis][0], whole) = (from - 0.5 * (to - from), false);
                }
                if greatest == COARSE {
                    (window[axis][1], whole) = (to + 0.5 * (to - from), false);
                }
            }
            if self.cancel.is_cancelled() {
                return None;
            }
            if !whole {
                continue;
            }
            // a small part of a large window is sampled more closely
            let mut small = false;
            for axis in [0, 1].into_iter().filter(|axis| given[*axis].is_none()) {
                let [least, greatest] = extent[axis];
                small |= greatest - least < 3 * COARSE / 4;
                let ends = [least.saturating_sub(1), (greatest + 1).min(COARSE)];
                let [from, to] = ends.map(|end| grid.node([end; 2])[axis]);
                let margin = MARGIN * (to - from);
                window[axis] = [from - margin, to + margin];
            }
            if !small {
                return Some(window);
            }
        }
        None
    }
}

impl Region {
    /// The region of a plane that holds some values of the motion. Ranges that are `given` are kept.
    pub fn of(
        plane: &SectionPlane,
        system: &System,
        given: [Option<[f64; 2]>; 2],
        around: [[f64; 2]; 2],
        cancel: &Cancel,
    ) -> Region {
        let observer = system.observer(plane.parameters());
        let mut scan = RegionScan { plane, system, observer, cancel };
        let near = around.map(|[lo, hi]| f64::midpoint(lo, hi));
        let window = [0, 1].map(|axis| given[axis].unwrap_or_else(|| wide(around[axis], 1.0)));
        if !plane.is_bounded() {
            return Region { window, boundary: Vec::new(), nodes: Vec::new() };
        }
        let open = [0, 1].map(|axis| given[axis].unwrap_or_else(|| wide(around[axis], OPEN)));
        let window = scan.grown(window, given, near).unwrap_or(open);
        let grid = EnergyGrid::of(&mut scan, window, CELLS);
        let nodes = grid.component(near);
        let boundary = boundary(&mut scan, &grid);
        Region { window, boundary, nodes }
    }

    /// Whether a point of the window belongs to the region, as far as a grid shows.
    pub fn contains(&self, at: [f64; 2]) -> bool {
        if self.nodes.is_empty() {
            return true;
        }
        let place = [0, 1].map(|axis| {
            let [from, to] = self.window[axis];
            let share = ((at[axis] - from) / (to - from)).clamp(0.0, 1.0);
            (share * CELLS as f64).round() as usize
        });
        self.nodes.get(place[1] * (CELLS + 1) + place[0]).copied().unwrap_or(false)
    }
}

/// A range wider than a motion by a factor, and not empty.
fn wide([lo, hi]: [f64; 2], factor: f64) -> [f64; 2] {
    let [lo, hi] = if lo.is_finite() && hi.is_finite() { [lo, hi] } else { [-1.0, 1.0] };
    let width = (hi - lo).max(0.1 * lo.abs().max(hi.abs())).max(0.1);
    let half = (0.5 * factor + 0.1) * width;
    let middle = f64::midpoint(lo, hi);
    [middle - half, middle + half]
}

/// The boundary of what is allowed: the lines that part the nodes of a grid, exact on its edges.
fn boundary(scan: &mut RegionScan<'_>, grid: &EnergyGrid) -> Vec<[[f64; 2]; 2]> {
    let at = |node: [usize; 2]| grid.allowed[grid.place(node)];
    let mut known: HashMap<[[usize; 2]; 2], [f64; 2]> = HashMap::new();
    let mut segments = Vec::new();
    for j in 0..grid.cells {
        if scan.cancel.is_cancelled() {
            return Vec::new();
        }
        for i in 0..grid.cells {
            let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
            let mut points = Vec::new();
            for k in 0..4 {
                let (mut a, mut b) = (corners[k], corners[(k + 1) % 4]);
                if at(a) == at(b) {
                    continue;
                }
                if b < a {
                    std::mem::swap(&mut a, &mut b);
                }
                let inside = at(a);
                let point = *known.entry([a, b]).or_insert_with(|| {
                    let (mut near, mut far) = (grid.node(a), grid.node(b));
                    for _ in 0..HALVINGS {
                        let middle = [0, 1].map(|k| f64::midpoint(near[k], far[k]));
                        if scan.at(middle) == inside {
                            near = middle;
                        } else {
                            far = middle;
                        }
                    }
                    [0, 1].map(|k| f64::midpoint(near[k], far[k]))
                });
                points.push(point);
            }
            segments.extend(points.chunks_exact(2).map(|pair| [pair[0], pair[1]]));
        }
    }
    segments
}

/// The point of this index of a sequence that fills a window evenly however many are taken: the additive recurrence in
/// the powers of the plastic number (M. Roberts; H. Niederreiter, Random Number Generation, §3.1).
pub fn spread(index: usize, window: [[f64; 2]; 2]) -> [f64; 2] {
    const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];
    [0, 1].map(|axis| {
        let share = (0.5 + STEPS[axis] * (index + 1) as f64).fract();
        window[axis][0] + share * (window[axis][1] - window[axis][0])
    })
}
