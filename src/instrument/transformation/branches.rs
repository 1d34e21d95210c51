//! The branches of a map whose relations have several images at a point, as both square roots.
//!
//! In: the relations of one pair of variables, or of maps of it one after the other, a point with an image. Out: the grid of that image's branch and of the
//! others, and the images of the moving point on each, found next to those of the grid. Never here: drawing.
//!
//! An image found next to one of the grid belongs to the branch on which that was drawn; where the motion's own image is
//! another, it has changed its branch, and the grids are drawn anew.

use std::sync::Arc;

use super::grid::{self, GridNode, Old};
use crate::expr::Symbol;
use crate::mechanics::{Equations, ImplicitMap, Valuation};

/// So many other branches are drawn; where there are more, as of an angle without a period, none.
const MOST: usize = 7;

/// The steps from a point of a grid to one next to it.
const WAY: u32 = 8;

/// The points of a grid that are tried, by their rank among the nearest ones.
const RANKS: [usize; 6] = [0, 1, 2, 4, 8, 16];

/// Images are the same if they differ by less than this part of their size.
const SAME: f64 = 1e-6;

/// The branches of a map around a point.
pub(super) struct Branches {
    equations: Arc<Equations>,
    map: ImplicitMap,
    new: [Symbol; 2],
    periods: [Option<f64>; 2],
    old: Old,
    main: Vec<GridNode>,
    others: Vec<Vec<GridNode>>,
    pub(super) lines: Vec<Vec<[f64; 2]>>,
}

/// The images of a point beside its own.
#[derive(Default)]
pub(super) struct OtherImages {
    /// Those on the other branches that are drawn.
    pub(super) on_grids: Vec<[f64; 2]>,
    /// Those to which no grid leads, as beyond a caustic or a pole.
    pub(super) beside: Vec<[f64; 2]>,
}

impl OtherImages {
    pub(super) fn all(&self) -> Vec<[f64; 2]> {
        self.on_grids.iter().chain(&self.beside).copied().collect()
    }
}

impl Branches {
    /// The lines of the branch of the image in `at`, and the branches around it; `None` if no image is found.
    pub(super) fn around(
        (equations, map): (Arc<Equations>, ImplicitMap),
        at: &Valuation,
        (new, periods): ([Symbol; 2], [Option<f64>; 2]),
        old: Old,
    ) -> Option<(Vec<Vec<[f64; 2]>>, Branches)> {
        let pool = &equations.pool;
        let at =
            whole(&equations, &map, grid::with_image(pool, &map, at, (new, old))?, new, periods)?;
        let (lines, main) = grid::solved(pool, &map, &at, (new, old));
        let of = |image: &Valuation| new.map(|s| image.at(s));
        let mut images = vec![at.clone()];
        // one more than is drawn tells that there are too many; those of whole turns are one
        for image in map.images(pool, &at, 2 * MOST + 3) {
            if images.iter().all(|known| !same(of(known), of(&image), periods)) {
                images.push(image);
            }
        }
        if images.len() > 1 + MOST {
            images.truncate(1);
        }
        let (mut all, mut others) = (Vec::new(), Vec::new());
        for image in &images[1..] {
            let (lines, nodes) = grid::solved(pool, &map, image, (new, old));
            all.extend(lines);
            others.push(nodes);
        }
        let branches = Branches { map, new, periods, old, main, others, lines: all, equations };
        Some((lines, branches))
    }

    pub(super) fn others(&self) -> usize {
        self.others.len()
    }

    pub(super) fn images(&self, at: &Valuation) -> OtherImages {
        let own = self.new.map(|s| at.at(s));
        let mut found = OtherImages::default();
        let known = |found: &OtherImages, image: [f64; 2]| {
            let mut all = found.on_grids.iter().chain(&found.beside).chain([&own]);
            all.any(|x| same(*x, image, self.periods))
        };
        for nodes in &self.others {
            let image = self.next_to(nodes, at).filter(|&image| !known(&found, image));
            found.on_grids.extend(image);
        }
        let missing = self.others.len() - found.on_grids.len();
        if missing > 0 && own.iter().all(|x| x.is_finite()) {
            for image in self.map.images(&self.equations.pool, at, 2 * MOST + 3) {
                let image = self.new.map(|s| image.at(s));
                if found.beside.len() < missing && !known(&found, image) {
                    found.beside.push(image);
                }
            }
        }
        found
    }

    /// Whether the image in `at` is not on the branch of the grid, which may have ended there, or another image is on none.
    pub(super) fn has_left(&self, at: &Valuation) -> bool {
        let image = self.new.map(|s| at.at(s));
        let leads = |own| same(own, image, self.periods);
        image.iter().all(|x| x.is_finite())
            && (!self.next_to(&self.main, at).is_some_and(leads)
                || !self.images(at).beside.is_empty())
    }

    /// The image of a point on the branch of the nodes, from the nearest of them from which a way leads there.
    fn next_to(&self, nodes: &[GridNode], at: &Valuation) -> Option<[f64; 2]> {
        let (symbols, window) = self.old;
        let here = symbols.map(|s| at.at(s));
        let distance = |node: &GridNode| {
            let part = |k: usize| (node.place[k] - here[k]) / (window[k][1] - window[k][0]);
            part(0) * part(0) + part(1) * part(1)
        };
        let mut nearest: Vec<(f64, &GridNode)> =
            nodes.iter().map(|node| (distance(node), node)).collect();
        nearest.sort_by(|a, b| a.0.total_cmp(&b.0));
        RANKS.into_iter().filter_map(|rank| nearest.get(rank)).find_map(|(_, node)| {
            let begin = at.clone().with(self.map.new.iter().copied().zip(node.image.clone()));
            let found = (1..=WAY).try_fold(begin, |near, k| {
                let share = f64::from(k) / f64::from(WAY);
                let place = |i: usize| {
                    let from = node.place[i];
                    if k == WAY { here[i] } else { from + (here[i] - from) * share }
                };
                let next = near.with([0, 1].map(|i| (symbols[i], place(i))));
                self.map.near(&self.equations.pool, next)
            })?;
            Some(self.new.map(|s| found.at(s)))
        })
    }
}

/// A point with all new variables of a map, of which maps one after the other have others than the two shown: those with which
/// these are the image. `None` if none are found.
fn whole(
    equations: &Equations,
    map: &ImplicitMap,
    at: Valuation,
    new: [Symbol; 2],
    periods: [Option<f64>; 2],
) -> Option<Valuation> {
    if map.new.iter().all(|&s| at.at(s).is_finite()) {
        return Some(at);
    }
    let own = new.map(|s| at.at(s));
    let is_own = |image: &Valuation| same(own, new.map(|s| image.at(s)), periods);
    let near_start = equations.with_images(at.clone());
    let known = map.near(&equations.pool, near_start);
    known
        .filter(is_own)
        .or_else(|| map.images(&equations.pool, &at, 2 * MOST + 3).into_iter().find(is_own))
}

/// Whether two images are the same, but for whole turns.
fn same(a: [f64; 2], b: [f64; 2], periods: [Option<f64>; 2]) -> bool {
    (0..2).all(|k| {
        let apart = a[k] - b[k];
        let apart = periods[k].map_or(apart, |turn| apart - turn * (apart / turn).round());
        apart.abs() <= SAME * (1.0 + a[k].abs().max(b[k].abs()))
    })
}
