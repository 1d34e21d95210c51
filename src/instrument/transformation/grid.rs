//! The lines on which one of two old variables is constant, in the plane of two new ones.
//!
//! In: a map in closed form, or one whose relations are solved from a known image along the lines. Out: lines, interrupted
//! where a new variable jumps or has no value. Never here: drawing.

use crate::expr::{Expr, Pool, Symbol};
use crate::instrument::Physics;
use crate::mechanics::{ImplicitMap, Valuation};
use crate::system::ChannelKind;

/// The lines of each old variable, and the points of a line.
const LINES: usize = 7;
const POINTS: usize = 129;

/// A step along a line is a jump if it is so many times the one in the middle of all, and longer than this part of the line.
const JUMP: f64 = 30.0;
const PART: f64 = 0.25;

/// The points on the way from a known image to a line.
const WAY: usize = 16;

/// The places of each old variable at which an image is searched.
const ACROSS: usize = 5;

/// Two old variables, and the range of each.
pub(super) type Old = ([Symbol; 2], [[f64; 2]; 2]);

/// A point of a grid, and the image there: all new variables of the map, in maps one after the other those in between too.
pub(super) struct GridNode {
    pub(super) place: [f64; 2],
    pub(super) image: Vec<f64>,
}

/// The lines of new variables that are written down.
pub(super) fn written(
    pool: &Pool,
    at: &Valuation,
    images: [Expr; 2],
    (old, window): Old,
) -> Vec<Vec<[f64; 2]>> {
    let mut all = Vec::new();
    for constant in [0, 1] {
        for line in 0..LINES {
            let mut point = at.clone();
            point.set(old[constant], place(window[constant], line, LINES));
            let image = |k: usize| {
                point.set(old[1 - constant], place(window[1 - constant], k, POINTS));
                images.map(|e| point.value(pool, e))
            };
            let line: Vec<[f64; 2]> = (0..POINTS).map(image).collect();
            all.extend(pieces(&line));
        }
    }
    all
}

/// The lines of new variables that are solved for, on the branch of the image in `at`, and the points of them.
pub(super) fn solved(
    pool: &Pool,
    map: &ImplicitMap,
    at: &Valuation,
    (new, (old, window)): ([Symbol; 2], Old),
) -> (Vec<Vec<[f64; 2]>>, Vec<GridNode>) {
    let node = |at: &Valuation| GridNode {
        place: old.map(|s| at.at(s)),
        image: map.new.iter().map(|&s| at.at(s)).collect(),
    };
    let (mut all, mut nodes) = (Vec::new(), vec![node(at)]);
    for constant in [0, 1] {
        let other = 1 - constant;
        for line in 0..LINES {
            let level = place(window[constant], line, LINES);
            // a line begins below the image that is known, and is followed both ways
            let from = [0, 1].map(|axis| at.at(old[axis]));
            let way = (1..=WAY).try_fold(at.clone(), |at, k| {
                let share = k as f64 / WAY as f64;
                let next = from[constant] + (level - from[constant]) * share;
                map.near(pool, at.with([(old[constant], next)]))
            });
            let Some(begin) = way else { continue };
            let mut line = vec![[f64::NAN; 2]; POINTS];
            let up: Vec<usize> = (0..POINTS).collect();
            let (below, above): (Vec<usize>, Vec<usize>) =
                up.into_iter().partition(|&k| place(window[other], k, POINTS) < from[other]);
            for side in [above, below.into_iter().rev().collect()] {
                let mut last = begin.clone();
                for k in side {
                    let next = last.with([(old[other], place(window[other], k, POINTS))]);
                    let Some(image) = map.near(pool, next) else { break };
                    line[k] = new.map(|s| image.at(s));
                    nodes.push(node(&image));
                    last = image;
                }
            }
            all.extend(pieces(&line));
        }
    }
    (all, nodes)
}

/// The point itself if its image is known, else that point or one of the window, with the image that is found.
pub(super) fn with_image(
    pool: &Pool,
    map: &ImplicitMap,
    at: &Valuation,
    (new, (old, window)): ([Symbol; 2], Old),
) -> Option<Valuation> {
    if new.iter().all(|&s| at.at(s).is_finite()) {
        return Some(at.clone());
    }
    let places = (0..ACROSS * ACROSS)
        .map(|k| [place(window[0], k / ACROSS, ACROSS), place(window[1], k % ACROSS, ACROSS)]);
    std::iter::once(old.map(|s| at.at(s))).chain(places).find_map(|values| {
        let point = at.clone().with(old.into_iter().zip(values));
        map.search(pool, &point, values.to_vec())
    })
}

/// One of so many places of a range.
fn place([lo, hi]: [f64; 2], k: usize, count: usize) -> f64 {
    lo + (hi - lo) * k as f64 / (count - 1) as f64
}

/// A line without what joins the two sides of a jump, and without places that have no value.
fn pieces(line: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let length = |pair: &[[f64; 2]]| [0, 1].map(|k| (pair[1][k] - pair[0][k]).abs());
    let steps: Vec<[f64; 2]> = line.windows(2).map(length).collect();
    let bound = [0, 1].map(|k| {
        let mut sizes: Vec<f64> = steps.iter().map(|s| s[k]).filter(|s| s.is_finite()).collect();
        sizes.sort_by(f64::total_cmp);
        let values = line.iter().map(|point| point[k]).filter(|x| x.is_finite());
        let (lo, hi) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| (lo.min(x), hi.max(x)));
        let middle = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
        (JUMP * middle).max(PART * (hi - lo))
    });
    let mut parts = vec![Vec::new()];
    for (i, &point) in line.iter().enumerate() {
        let breaks = |k: usize| steps[i - 1][k].is_nan() || steps[i - 1][k] > bound[k];
        let jumps = i > 0 && (breaks(0) || breaks(1));
        if jumps {
            parts.push(Vec::new());
        }
        if point.iter().all(|x| x.is_finite())
            && let Some(part) = parts.last_mut()
        {
            part.push(point);
        }
    }
    parts.retain(|part| part.len() > 1);
    parts
}

/// The two old variables on which new ones, or their relations, depend, with their channels; `None` if there are others.
pub(super) fn old_variables(
    pool: &Pool,
    physics: Physics<'_>,
    of: &[Expr],
) -> Option<[(Symbol, usize); 2]> {
    let model = physics.model;
    let coordinates = model.coordinates.iter().enumerate();
    let all = coordinates.flat_map(|(i, c)| {
        [(c.position, ChannelKind::Position(i)), (c.momentum, ChannelKind::Momentum(i))]
    });
    let on = all.filter(|(symbol, _)| of.iter().any(|&e| pool.depends(e, *symbol)));
    let on: Vec<(Symbol, usize)> =
        on.map(|(s, kind)| Some((s, physics.channel(kind)?))).collect::<Option<_>>()?;
    on.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where steps have one length a jump is 30 times that, and where they are short a fourth of the whole.
    #[test]
    fn a_jump_is_long_beside_other_steps_and_beside_the_line() {
        let up_and_down = |jump: f64| {
            let high = |k: i32| if k < 50 { 0.0 } else { jump };
            let line: Vec<[f64; 2]> = (0..100).map(|k| [0.0, f64::from(k % 2) + high(k)]).collect();
            pieces(&line).len()
        };
        // from 1 to the jump
        assert_eq!(up_and_down(1.0 + 27.0), 1);
        assert_eq!(up_and_down(1.0 + 33.0), 2);
        let along = |part: f64| {
            let jump = 0.999 * part / (1.0 - part);
            let high = |k: i32| if k < 500 { 0.0 } else { jump };
            let line: Vec<[f64; 2]> =
                (0..1000).map(|k| [0.0, 0.001 * f64::from(k) + high(k)]).collect();
            pieces(&line).len()
        };
        assert_eq!(along(0.22), 1);
        assert_eq!(along(0.28), 2);
    }

    #[test]
    fn a_line_is_not_joined_across_a_jump() {
        let angle = |k: i32| [f64::from((k + 40) % 100), f64::from(k)];
        let parts = pieces(&(0..100).map(angle).collect::<Vec<_>>());
        assert_eq!(parts.iter().map(Vec::len).collect::<Vec<_>>(), [60, 40]);
        let whole = pieces(&(0..100).map(|k| [f64::from(k * k), 1.0]).collect::<Vec<_>>());
        assert_eq!(whole.len(), 1);
        let holes = pieces(&[[0.0, 0.0], [1.0, 0.0], [f64::NAN, 0.0], [3.0, 0.0], [4.0, 0.0]]);
        assert_eq!(holes.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2]);
    }
}
