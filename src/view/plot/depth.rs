//! Depth: which dots a surface covers, and how near to the eye it is there.
//!
//! In: faces and balls in the coordinates of the camera: right, up, towards the eye; a ball may be a veil, behind which
//! things are seen dimly. Out: covered dots, and what of a line is in front of them, behind a veil, or hidden. Never here:
//! colours, or the shapes that the surfaces belong to.

mod blocks;
mod light;
mod nearest;

use super::scale::PlotFrame;
use crate::num::math;
use blocks::Blocks;
use light::lit;
use nearest::{Covered, Nearest};

/// How far behind a surface a point still counts as lying on it, relative to the picture.
const TOLERANCE: f64 = 0.03;

/// The length of the pieces, in dots, that are visible or hidden as a whole, and the most of them in a segment.
const PIECE: f64 = 2.0;
const MOST_PIECES: f64 = 512.0;

/// How a dot of something is seen among the surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visibility {
    /// Nothing is in front of it.
    Clear,
    /// Only a veil is in front of it.
    Veiled,
    /// A surface is in front of it.
    Hidden,
}

/// The nearest opaque surface at each dot, and the nearest veil.
#[derive(Clone, Debug)]
pub struct DepthBuffer {
    frame: PlotFrame,
    size: [i32; 2],
    /// The blocks in which surfaces are drawn; `None` where they are dots.
    blocks: Option<Blocks>,
    opaque: Nearest,
    veil: Nearest,
}

impl DepthBuffer {
    /// Creates a buffer without surfaces over a raster of this many dots.
    pub fn new(frame: &PlotFrame, size: [i32; 2]) -> Self {
        let [opaque, veil] = [Nearest::default(), Nearest::default()];
        Self { frame: *frame, size: size.map(|n| n.max(0)), blocks: None, opaque, veil }
    }

    /// The same buffer for surfaces that are drawn in blocks of this many dots: balls end where blocks do.
    #[must_use]
    pub fn with_blocks(self, block: [f64; 2]) -> Self {
        Self { blocks: Some(Blocks(block)), ..self }
    }

    /// Whether there is no surface.
    pub fn is_empty(&self) -> bool {
        self.opaque.is_empty() && self.veil.is_empty()
    }

    /// The covered dots: the nearest surface of each, or the one behind a veil.
    pub fn dots(&self) -> impl Iterator<Item = ([i32; 2], Covered)> {
        let wide = self.size[0].max(1) as usize;
        let slack = self.slack();
        let ranges = [&self.opaque.range, &self.veil.range].into_iter().filter(|r| !r.is_empty());
        let first = ranges.clone().map(|range| range.start).min().unwrap_or(0);
        let end = ranges.map(|range| range.end).max().unwrap_or(0);
        (first..end).filter_map(move |place| {
            let veiled = self.veil.near(place) > self.opaque.near(place) + slack;
            let covered = self.opaque.covered(place, veiled);
            let covered = covered.or_else(|| self.veil.covered(place, false))?;
            Some(([(place % wide) as i32, (place / wide) as i32], covered))
        })
    }

    /// Adds a flat convex face.
    pub fn face(&mut self, corners: &[[f64; 3]], surface: usize) {
        let [first, second, .., last] = corners else { return };
        let (a, b) = (difference(*second, *first), difference(*last, *first));
        let normal =
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        let light = lit(normal);
        let dots: Vec<[f64; 2]> =
            corners.iter().map(|[x, y, _]| self.frame.dot([*x, *y], self.size)).collect();
        // The largest triangle tells which way round the face is seen and how near each dot of it is.
        let triangles = (1..corners.len() - 1).map(|k| [0, k, k + 1]);
        let twice = |corners: [usize; 3]| side(corners.map(|k| dots[k]));
        let largest = triangles.max_by(|a, b| twice(*a).abs().total_cmp(&twice(*b).abs()));
        let Some(chosen) = largest.filter(|corners| twice(*corners).abs() > 1e-9) else { return };
        let Some([columns, rows]) = self.box_of(&dots) else { return };
        let ([a, b, c], whole) = (chosen.map(|k| dots[k]), twice(chosen));
        let nearness = chosen.map(|k| corners[k][2]);
        let near = |dot: [f64; 2]| {
            let [p, q, r] = [side([b, c, dot]), side([c, a, dot]), side([a, b, dot])];
            p / whole * nearness[0] + q / whole * nearness[1] + r / whole * nearness[2]
        };
        // A face is flat: along a row its nearness grows by the same with each dot.
        let growth = near([1.0, 0.0]) - near([0.0, 0.0]);
        self.opaque.prepare(self.size);
        for row in rows {
            let middle = |column: i32| [f64::from(column) + 0.5, f64::from(row) + 0.5];
            // How far right of the first column each edge lets the row begin and end.
            let (mut from, mut to) = (f64::from(columns.start), f64::from(columns.end));
            let height = f64::from(row) + 0.5;
            let mut previous = dots[dots.len() - 1];
            let mut crossed = false;
            for &dot in &dots {
                let (p, q) = (previous, dot);
                previous = dot;
                // The face is convex: only the edges that pass this height bound the row.
                if (p[1] < height && q[1] < height) || (p[1] > height && q[1] > height) {
                    continue;
                }
                crossed = true;
                let inside = whole.signum() * side([p, q, middle(0)]);
                let slope = whole.signum() * (p[1] - q[1]);
                if slope > 0.0 {
                    from = from.max(-(whole_below(inside / slope)));
                } else if slope < 0.0 {
                    to = to.min(whole_below(-inside / slope) + 1.0);
                } else if inside < 0.0 {
                    to = from;
                }
            }
            if !crossed {
                continue;
            }
            let (from, to) = (from as i32, to as i32);
            if from >= to {
                continue;
            }
            let first = near(middle(from));
            let nears = (0..to - from).map(|right| first + growth * f64::from(right));
            let start = row * self.size[0];
            let places = (start + from) as usize..(start + to) as usize;
            self.opaque.cover(places, (surface, light), nears);
        }
    }

    /// Adds an opaque ball.
    pub fn ball(&mut self, centre: [f64; 3], radius: f64, surface: usize) {
        let mut opaque = std::mem::take(&mut self.opaque);
        self.round(centre, radius, surface, &mut opaque);
        self.opaque = opaque;
    }

    /// Adds a ball through which things are seen dimly.
    pub fn veil(&mut self, centre: [f64; 3], radius: f64, surface: usize) {
        let mut veil = std::mem::take(&mut self.veil);
        self.round(centre, radius, surface, &mut veil);
        self.veil = veil;
    }

    fn round(&self, [x, y, near]: [f64; 3], radius: f64, surface: usize, nearest: &mut Nearest) {
        let low = self.frame.dot([x - radius, y + radius], self.size);
        let high = self.frame.dot([x + radius, y - radius], self.size);
        let [low, high] = self.blocks.map_or([low, high], |blocks| blocks.around(low, high));
        let Some([columns, rows]) = self.box_of(&[low, high]) else { return };
        nearest.prepare(self.size);
        let off = |dot: i32, k: usize| {
            (f64::from(dot) + 0.5 - f64::midpoint(low[k], high[k])) * 2.0 / (high[k] - low[k])
        };
        for row in rows {
            for column in columns.clone() {
                let (right, up) = (off(column, 0), -off(row, 1));
                let rest = 1.0 - right * right - up * up;
                if rest >= 0.0 {
                    let (out, place) = (rest.sqrt(), (row * self.size[0] + column) as usize);
                    let light = lit([right, up, out]);
                    let nears = std::iter::once(near + radius * out);
                    nearest.cover(place..place + 1, (surface, light), nears);
                }
            }
        }
    }

    /// How far behind a surface a point still counts as lying on it.
    fn slack(&self) -> f64 {
        TOLERANCE * (self.frame.x.hi - self.frame.x.lo).abs()
    }

    /// How a dot of something at this depth is seen.
    pub fn sight(&self, [x, y]: [i32; 2], near: f64) -> Visibility {
        let [wide, high] = self.size;
        if self.is_empty() || !(0..wide).contains(&x) || !(0..high).contains(&y) {
            return Visibility::Clear;
        }
        let (place, slack) = ((y * wide + x) as usize, self.slack());
        if self.opaque.near(place) > near + slack {
            Visibility::Hidden
        } else if self.veil.near(place) > near + slack {
            Visibility::Veiled
        } else {
            Visibility::Clear
        }
    }

    /// How a point is seen.
    pub fn sight_of(&self, [x, y, near]: [f64; 3]) -> Visibility {
        if self.is_empty() {
            return Visibility::Clear;
        }
        let dot = self.frame.dot([x, y], self.size);
        if dot[0].is_finite() && dot[1].is_finite() {
            self.sight([whole_below(dot[0]) as i32, whole_below(dot[1]) as i32], near)
        } else {
            Visibility::Clear
        }
    }

    /// A line through points in short pieces, each end with whether a veil is in front of the piece that leads there; a
    /// point without a position (NaN) stands for what is hidden.
    pub fn visible(&self, points: &[[f64; 3]]) -> Vec<([f64; 3], bool)> {
        let mut seen = Vec::with_capacity(2 * points.len());
        let mut at = None;
        let dot = |[x, y, _]: [f64; 3]| self.frame.dot([x, y], self.size);
        let mut end = points.first().map_or([f64::NAN; 2], |first| dot(*first));
        for pair in points.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let begin = std::mem::replace(&mut end, dot(b));
            let length = math::hypot(end[0] - begin[0], end[1] - begin[1]);
            let count = (length / PIECE).ceil().clamp(1.0, MOST_PIECES);
            let place = |share: f64| {
                let along = |k: usize| a[k] + share * (b[k] - a[k]);
                [along(0), along(1), along(2)]
            };
            let mut begins = place(0.0);
            for piece in 0..count as u32 {
                let share = |more: f64| (f64::from(piece) + more) / count;
                let ends = place(share(1.0));
                let sight = self.sight_of(place(share(0.5)));
                let veiled = sight == Visibility::Veiled;
                if sight == Visibility::Hidden {
                    seen.push(([f64::NAN; 3], false));
                    at = None;
                } else {
                    if at != Some(begins) {
                        seen.extend([([f64::NAN; 3], false), (begins, veiled)]);
                    }
                    seen.push((ends, veiled));
                    at = Some(ends);
                }
                begins = ends;
            }
        }
        seen
    }

    /// The columns and rows of dots around points, or `None` if one of them has no position.
    fn box_of(&self, points: &[[f64; 2]]) -> Option<[std::ops::Range<i32>; 2]> {
        let finite = points.iter().flatten().all(|v| v.is_finite());
        finite.then(|| {
            [0, 1].map(|k| {
                let most = f64::from(self.size[k]);
                let along = || points.iter().map(|point| point[k].clamp(0.0, most));
                let (low, high) = (along().fold(most, f64::min), along().fold(0.0, f64::max));
                low.floor() as i32..high.ceil() as i32
            })
        })
    }
}

/// The greatest whole number that is not above one of the size of a screen, without a call.
fn whole_below(x: f64) -> f64 {
    let whole = x as i64 as f64;
    if whole > x { whole - 1.0 } else { whole }
}

/// Twice the area of a triangle, with a sign for the way round.
fn side([p, q, r]: [[f64; 2]; 3]) -> f64 {
    (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
}

fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

#[cfg(test)]
mod tests {
    use ratatui::layout::Rect;

    use super::*;
    use crate::view::plot::Scale;

    /// A hundred dots of unit length across and upwards; the origin is in the middle.
    fn buffer() -> DepthBuffer {
        let scale = Scale::linear(-50.0, 50.0);
        DepthBuffer::new(&PlotFrame::new(scale, scale, Rect::new(0, 0, 50, 25)), [100, 100])
    }

    fn hides(buffer: &DepthBuffer, point: [f64; 3]) -> bool {
        buffer.sight_of(point) == Visibility::Hidden
    }

    #[test]
    fn a_ball_hides_what_is_behind_its_front_and_nothing_else() {
        let mut buffer = buffer();
        assert!(buffer.is_empty() && !hides(&buffer, [0.0, 0.0, -40.0]));
        buffer.ball([0.0, 0.0, 0.0], 20.0, 3);
        // The front at 12 to the right is √(20² − 12²) = 16 nearer than the centre.
        let seen = [[0.0, 0.0, 21.0], [12.0, 0.0, 16.0], [0.0, 22.0, -90.0], [15.0, 15.0, -9.0]];
        let hidden = [[0.0, 0.0, 15.0], [12.0, 0.0, 11.0], [0.0, 0.0, -20.0], [13.0, 13.0, -9.0]];
        assert!(seen.iter().all(|point| !hides(&buffer, *point)));
        assert!(hidden.iter().all(|point| hides(&buffer, *point)));
        let area = buffer.dots().count() as f64;
        assert!((area - 400.0 * std::f64::consts::PI).abs() < 30.0, "{area}");
        assert!(buffer.dots().all(|(_, covered)| covered.surface == 3));
    }

    #[test]
    fn the_depth_of_a_tilted_face_is_that_of_its_plane() {
        let mut buffer = buffer();
        // The plane near = x/2 over a square.
        let corner = |x: f64, y: f64| [x, y, x / 2.0];
        let square = [(-30.0, -30.0), (30.0, -30.0), (30.0, 30.0), (-30.0, 30.0)];
        buffer.face(&square.map(|(x, y)| corner(x, y)), 0);
        for ([column, row], covered) in buffer.dots() {
            let x = f64::from(column) + 0.5 - 50.0;
            assert!((covered.near - x / 2.0).abs() < 1e-9, "{column} {row} {covered:?}");
        }
        assert_eq!(buffer.dots().count(), 3600);
        assert!(hides(&buffer, [20.0, 0.0, 5.0]) && !hides(&buffer, [-20.0, 0.0, 5.0]));
    }

    #[test]
    fn the_nearer_of_two_faces_covers_in_either_order() {
        let face = |near: f64| [[-9.0, -9.0, near], [9.0, -9.0, near], [0.0, 9.0, near]];
        for order in [[1.0, 2.0], [2.0, 1.0]] {
            let mut buffer = buffer();
            for near in order {
                buffer.face(&face(near), near as usize);
            }
            assert!(buffer.dots().count() > 100);
            assert!(buffer.dots().all(|(_, covered)| covered.surface == 2));
        }
    }

    #[test]
    fn a_line_through_a_ball_is_seen_up_to_where_it_enters() {
        let mut buffer = buffer();
        buffer.ball([0.0, 0.0, 0.0], 20.0, 0);
        let line = buffer.visible(&[[-40.0, 0.0, 0.0], [40.0, 0.0, 0.0]]);
        let seen = line.iter().map(|(point, _)| point[0].abs()).filter(|x| x.is_finite());
        assert!(seen.clone().all(|x| x > 17.0), "{line:?}");
        let reach = seen.fold(f64::INFINITY, f64::min);
        assert!(reach < 22.0, "{reach}");
        // In front of the ball nothing is hidden.
        let front = buffer.visible(&[[-40.0, 0.0, 25.0], [40.0, 0.0, 25.0]]);
        assert!(front[1..].iter().all(|(point, veiled)| point[0].is_finite() && !veiled));
    }

    /// Behind a veil things are seen dimly, and in front of it as ever; what an opaque surface hides stays hidden.
    #[test]
    fn a_veil_dims_what_is_behind_it() {
        let mut buffer = buffer();
        buffer.veil([0.0, 0.0, 0.0], 20.0, 0);
        let sights = |buffer: &DepthBuffer| {
            [25.0, -10.0, -40.0].map(|near| buffer.sight_of([0.0, 0.0, near]))
        };
        assert_eq!(sights(&buffer), [Visibility::Clear, Visibility::Veiled, Visibility::Veiled]);
        let line = buffer.visible(&[[-40.0, 0.0, 0.0], [40.0, 0.0, 0.0]]);
        assert!(line[1..].iter().all(|(point, _)| point[0].is_finite()), "it is seen everywhere");
        let dim = line.iter().filter(|(_, veiled)| *veiled).map(|(point, _)| point[0].abs());
        assert!(dim.clone().count() > 10 && dim.clone().all(|x| x < 22.0), "{line:?}");
        buffer.ball([0.0, 0.0, -20.0], 5.0, 1);
        assert_eq!(sights(&buffer), [Visibility::Clear, Visibility::Veiled, Visibility::Hidden]);
        // The ball behind the veil is drawn in its place, and marked as veiled.
        let covered: Vec<_> = buffer.dots().map(|(_, covered)| covered).collect();
        assert!(covered.iter().all(|dot| dot.veiled == (dot.surface == 1)), "{covered:?}");
        assert!(covered.iter().filter(|dot| dot.veiled).count() > 50);
    }

    #[test]
    fn no_number_causes_a_panic() {
        let mut buffer = buffer();
        for v in [f64::NAN, f64::INFINITY, 1e300, -1e300, 0.0] {
            buffer.ball([v, 0.0, v], 1.0, 0);
            buffer.ball([0.0, 0.0, 0.0], v, 0);
            buffer.face(&[[v, 0.0, 0.0], [1.0, v, 0.0], [0.0, 1.0, v]], 0);
            buffer.visible(&[[v, 0.0, 0.0], [0.0, v, 1.0], [1.0, 1.0, 1.0]]);
            buffer.veil([v, 0.0, v], v, 0);
            buffer.sight_of([v; 3]);
        }
        buffer.face(&[], 0);
        assert!(buffer.dots().count() > 0, "what is finite is drawn");
    }
}
