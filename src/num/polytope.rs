//! A convex polytope around points of space with faces of fixed directions (a discrete orientation polytope): tighter
//! than a box, and as cheap to widen.
//!
//! In: points. Out: how far they reach in any direction, at most 13 % too far for a ball. Never here: the points
//! themselves, or what they are.

/// The directions of the faces; each has one opposite to it. They are the axes, the diagonals of the faces of a cube and
/// those of the cube.
const DIRECTIONS: [[f64; 3]; 13] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, 1.0, -1.0],
    [1.0, 1.0, 1.0],
    [1.0, 1.0, -1.0],
    [1.0, -1.0, 1.0],
    [1.0, -1.0, -1.0],
];

/// The polytope around points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientationPolytope {
    /// The least and greatest product of a point with each direction.
    ranges: [[f64; 2]; DIRECTIONS.len()],
}

impl OrientationPolytope {
    /// The polytope around no point.
    pub const EMPTY: Self = Self { ranges: [[f64::INFINITY, f64::NEG_INFINITY]; DIRECTIONS.len()] };

    /// The polytope around one point.
    pub fn around(point: [f64; 3]) -> Self {
        let mut one = Self::EMPTY;
        one.include(point);
        one
    }

    /// Widens the polytope to contain a point; one that is not finite is passed over.
    pub fn include(&mut self, point: [f64; 3]) {
        if !point.iter().all(|x| x.is_finite()) {
            return;
        }
        for ([least, greatest], direction) in self.ranges.iter_mut().zip(&DIRECTIONS) {
            let along = dot(*direction, point);
            *least = least.min(along);
            *greatest = greatest.max(along);
        }
    }

    /// Whether there is no point in it.
    pub fn is_empty(&self) -> bool {
        self.ranges[0][0] > self.ranges[0][1]
    }

    /// The polytope around the points of both.
    #[must_use]
    pub fn joined(&self, other: &Self) -> Self {
        let join = |k: usize| {
            let ([low, high], [least, greatest]) = (self.ranges[k], other.ranges[k]);
            [low.min(least), high.max(greatest)]
        };
        Self { ranges: std::array::from_fn(join) }
    }

    /// The polytope around the sums of a point of this one and a point of the other.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        let sum = |k: usize| [0, 1].map(|end| self.ranges[k][end] + other.ranges[k][end]);
        Self { ranges: std::array::from_fn(sum) }
    }

    /// The polytope with its faces moved outwards to multiples of a length, except where it is flat.
    #[must_use]
    pub fn rounded(&self, step: f64) -> Self {
        let round = |[least, greatest]: [f64; 2]| {
            if least == greatest {
                [least, greatest]
            } else {
                [(least / step).floor() * step, (greatest / step).ceil() * step]
            }
        };
        Self { ranges: self.ranges.map(round) }
    }

    /// How far it reaches in a direction: no point in it has a greater product with the direction than this.
    ///
    /// The direction is a sum of multiples, none negative, of one of the axes, a diagonal of a face beside it and the
    /// diagonal of the cube beside both; so is the bound.
    pub fn reach(&self, direction: [f64; 3]) -> f64 {
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| direction[j].abs().total_cmp(&direction[i].abs()));
        let [first, second, third] = order.map(|k| direction[k].abs());
        let mut corner = [0.0; 3];
        let mut bound = 0.0;
        for (k, multiple) in order.into_iter().zip([first - second, second - third, third]) {
            corner[k] = if direction[k] < 0.0 { -1.0 } else { 1.0 };
            if multiple > 0.0 {
                bound += multiple * self.along(corner);
            }
        }
        bound
    }

    /// A distance from the origin that no point in it exceeds.
    ///
    /// For directions between an axis, a diagonal of a face beside it and the diagonal of the cube beside both, the reach is the
    /// product with one vector: a unit vector has none greater than its length.
    pub fn farthest(&self) -> f64 {
        let orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
        let cones = orders.iter().flat_map(|order| (0..8).map(move |signs| (order, signs)));
        let squares = cones.map(|(order, signs)| {
            let (mut corner, mut before, mut square) = ([0.0; 3], 0.0, 0.0);
            for &k in order {
                corner[k] = if signs >> k & 1 == 0 { 1.0 } else { -1.0 };
                let along = self.along(corner);
                square += (along - before) * (along - before);
                before = along;
            }
            square
        });
        squares.fold(0.0, f64::max).sqrt()
    }

    /// The greatest product with one of the fixed directions or its opposite.
    fn along(&self, direction: [f64; 3]) -> f64 {
        let opposite = direction.map(|x| 0.0 - x);
        let place = |d: [f64; 3]| DIRECTIONS.iter().position(|fixed| *fixed == d);
        match (place(direction), place(opposite)) {
            (Some(k), _) => self.ranges[k][1],
            (None, Some(k)) => -self.ranges[k][0],
            (None, None) => f64::NAN,
        }
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::math;

    /// Directions evenly about the sphere (a spiral of the golden angle).
    fn everywhere(count: i32) -> impl Iterator<Item = [f64; 3]> {
        (0..count).map(move |i| {
            let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
            let (sin, cos) = math::sin_cos(2.399_963_229_728_653 * f64::from(i));
            let r = (1.0 - z * z).sqrt();
            [r * cos, r * sin, z]
        })
    }

    #[test]
    fn no_point_lies_beyond_and_a_ball_reaches_thirteen_per_cent_too_far_at_most() {
        let mut ball = OrientationPolytope::EMPTY;
        everywhere(4000).for_each(|point| ball.include(point));
        let reaches: Vec<f64> = everywhere(1000).map(|direction| ball.reach(direction)).collect();
        let (least, most) =
            reaches.iter().fold((9.0_f64, 0.0_f64), |(l, m), r| (l.min(*r), m.max(*r)));
        assert!(least > 0.999 && (1.1..1.13).contains(&most), "{least} {most}");
    }

    #[test]
    fn a_box_reaches_as_far_as_its_farthest_corner() {
        let corners: Vec<[f64; 3]> = (0..8)
            .map(|i: usize| {
                [0, 1, 2].map(|k| if i >> k & 1 == 0 { -1.0 - f64::from(k) } else { 2.0 })
            })
            .collect();
        let mut all = OrientationPolytope::EMPTY;
        assert!(all.is_empty());
        for corner in &corners {
            all.include(*corner);
        }
        all.include([f64::NAN, 99.0, 0.0]);
        for direction in everywhere(200) {
            let farthest =
                corners.iter().map(|c| dot(*c, direction)).fold(f64::NEG_INFINITY, f64::max);
            assert!((all.reach(direction) - farthest).abs() < 1e-12, "{direction:?}");
        }
    }

    #[test]
    fn the_farthest_point_of_a_ball_and_of_a_box() {
        let mut ball = OrientationPolytope::EMPTY;
        everywhere(4000).for_each(|point| ball.include(point));
        assert!((0.999..1.13).contains(&ball.farthest()), "{}", ball.farthest());
        let point = OrientationPolytope::around([1.0, -2.0, 2.0]);
        assert!((point.farthest() - 3.0).abs() < 1e-12, "{}", point.farthest());
        let mut segment = OrientationPolytope::around([-2.0, 3.0, -6.0]);
        segment.include([0.0, 0.0, 1.0]);
        assert!((segment.farthest() - 7.0).abs() < 1e-12, "{}", segment.farthest());
    }

    /// A circle that is seen from its edge is a line: the box around it would be higher.
    #[test]
    fn a_tilted_circle_is_narrow_across_its_plane() {
        let mut circle = OrientationPolytope::EMPTY;
        for k in 0..360 {
            let (sin, cos) = math::sin_cos(f64::from(k).to_radians());
            circle.include([cos, sin, cos]);
        }
        let across = [0.5_f64.sqrt(), 0.0, -(0.5_f64.sqrt())];
        assert!(circle.reach(across).abs() < 1e-12, "{}", circle.reach(across));
    }

    #[test]
    fn sums_and_rounding_only_widen_as_far_as_documented() {
        let (mut a, b) = (OrientationPolytope::around([0.1, 0.2, 0.3]), [1.0, -1.0, 0.5]);
        a.include([0.9, 0.2, 0.3]);
        let sum = a.plus(&OrientationPolytope::around(b));
        assert!((sum.reach([1.0, 0.0, 0.0]) - 1.9).abs() < 1e-12);
        assert!((sum.reach([0.0, -1.0, 0.0]) - 0.8).abs() < 1e-12);
        let rounded = a.rounded(0.5);
        assert_eq!(rounded.reach([1.0, 0.0, 0.0]), 1.0);
        assert_eq!(rounded.reach([-1.0, 0.0, 0.0]), 0.0);
        assert_eq!(rounded.reach([0.0, 1.0, 0.0]), 0.2, "where it is flat it stays");
    }
}
