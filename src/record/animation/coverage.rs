//! How much of each pixel a shape covers.
//!
//! In: closed contours, rectangles, discs and strokes, in pixels. Out: a coverage from 0 to 1 for each pixel. Contours
//! are summed exactly: the signed area to the right of each edge. Never here: characters.

/// The number of samples across a pixel, for what is not a contour.
const SAMPLES: usize = 8;

/// The number of straight pieces of a curve.
const PIECES: usize = 8;

/// A place in pixels.
pub(super) type PixelPoint = (f64, f64);

/// The coverage of a grid of pixels.
#[derive(Clone, Debug)]
pub(super) struct Coverage {
    width: usize,
    height: usize,
    pixels: Vec<f64>,
}

impl Coverage {
    pub(super) fn new(width: usize, height: usize) -> Coverage {
        Coverage { width, height, pixels: vec![0.0; width * height] }
    }

    /// The coverages row by row.
    pub(super) fn pixels(&self) -> &[f64] {
        &self.pixels
    }

    /// Covers what lies in the rectangle from `(x, y)` up to another corner, in whole pixels.
    pub(super) fn rectangle(&mut self, (x, y): (usize, usize), to: (usize, usize), share: f64) {
        for row in y..to.1.min(self.height) {
            for column in x..to.0.min(self.width) {
                self.cover(row * self.width + column, share);
            }
        }
    }

    /// Covers the places for which something holds, as sampled in each pixel.
    pub(super) fn sampled(&mut self, inside: impl Fn(PixelPoint) -> bool) {
        let place =
            |pixel: usize, sample: usize| pixel as f64 + (sample as f64 + 0.5) / SAMPLES as f64;
        for index in 0..self.pixels.len() {
            let (x, y) = (index % self.width, index / self.width);
            let samples = (0..SAMPLES * SAMPLES).map(|n| (n % SAMPLES, n / SAMPLES));
            let hits = samples.filter(|(i, j)| inside((place(x, *i), place(y, *j)))).count();
            self.cover(index, hits as f64 / (SAMPLES * SAMPLES) as f64);
        }
    }

    fn cover(&mut self, index: usize, share: f64) {
        self.pixels[index] = self.pixels[index].max(share);
    }

    /// Covers the inside of contours.
    pub(super) fn fill(&mut self, contours: &Contours) {
        let mut sums = vec![0.0; self.pixels.len()];
        for [from, to] in &contours.edges {
            self.edge(&mut sums, *from, *to);
        }
        for row in 0..self.height {
            let mut sum = 0.0_f64;
            for column in 0..self.width {
                let index = row * self.width + column;
                sum += sums[index];
                self.cover(index, sum.abs().min(1.0));
            }
        }
    }

    /// Adds the changes that an edge makes to the signed area on its right, from pixel to pixel.
    fn edge(&self, sums: &mut [f64], from: PixelPoint, to: PixelPoint) {
        let (sign, (x0, y0), (x1, y1)) =
            if from.1 < to.1 { (1.0, from, to) } else { (-1.0, to, from) };
        if y0 == y1 {
            return;
        }
        let slope = (x1 - x0) / (y1 - y0);
        let limit = self.width as f64;
        let first = y0.max(0.0).floor() as usize;
        let last = y1.min(self.height as f64).ceil() as usize;
        for row in first..last {
            let (top, bottom) = (y0.max(row as f64), y1.min((row + 1) as f64));
            let (a, b) = (x0 + slope * (top - y0), x0 + slope * (bottom - y0));
            let (left, right) = (a.min(b).clamp(0.0, limit), a.max(b).clamp(0.0, limit));
            let mut begin = left;
            loop {
                let column = begin.floor();
                let end = right.min(column + 1.0);
                let part = if right > left { (end - begin) / (right - left) } else { 1.0 };
                let height = sign * (bottom - top) * part;
                let within = 0.5 * (begin + end) - column;
                let index = row * self.width + column as usize;
                if (column as usize) < self.width {
                    sums[index] += height * (1.0 - within);
                }
                if column as usize + 1 < self.width {
                    sums[index + 1] += height * within;
                }
                if end >= right {
                    break;
                }
                begin = end;
            }
        }
    }
}

/// Closed contours of straight edges.
#[derive(Debug, Default)]
pub(super) struct Contours {
    edges: Vec<[PixelPoint; 2]>,
    start: PixelPoint,
    at: PixelPoint,
}

impl Contours {
    pub(super) fn begin(&mut self, at: PixelPoint) {
        self.close();
        (self.start, self.at) = (at, at);
    }

    pub(super) fn line(&mut self, to: PixelPoint) {
        self.edges.push([self.at, to]);
        self.at = to;
    }

    /// A quadratic Bézier curve.
    pub(super) fn curve(&mut self, by: PixelPoint, to: PixelPoint) {
        for point in curve(self.at, by, to) {
            self.line(point);
        }
    }

    pub(super) fn close(&mut self) {
        if self.at != self.start {
            self.line(self.start);
        }
    }
}

/// The ends of the straight pieces of a quadratic Bézier curve.
pub(super) fn curve(
    from: PixelPoint,
    by: PixelPoint,
    to: PixelPoint,
) -> impl Iterator<Item = PixelPoint> {
    (1..=PIECES).map(move |piece| {
        let s = piece as f64 / PIECES as f64;
        let r = 1.0 - s;
        let at = |a: f64, b: f64, c: f64| r * r * a + 2.0 * r * s * b + s * s * c;
        (at(from.0, by.0, to.0), at(from.1, by.1, to.1))
    })
}

/// The square of the distance from a place to a segment.
pub(super) fn distance_squared((x, y): PixelPoint, [from, to]: [PixelPoint; 2]) -> f64 {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = dx * dx + dy * dy;
    let along = if length > 0.0 { ((x - from.0) * dx + (y - from.1) * dy) / length } else { 0.0 };
    let along = along.clamp(0.0, 1.0);
    let (x, y) = (x - from.0 - along * dx, y - from.1 - along * dy);
    x * x + y * y
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(points: &[PixelPoint], size: usize) -> f64 {
        let mut contours = Contours::default();
        contours.begin(points[0]);
        points[1..].iter().for_each(|point| contours.line(*point));
        contours.close();
        let mut coverage = Coverage::new(size, size);
        coverage.fill(&contours);
        coverage.pixels().iter().sum()
    }

    /// Against the shoelace formula.
    #[test]
    fn what_is_covered_is_the_area() {
        let check = |points: &[PixelPoint]| {
            let next = points.iter().cycle().skip(1);
            let twice: f64 = points.iter().zip(next).map(|(a, b)| a.0 * b.1 - b.0 * a.1).sum();
            let covered = area(points, 12);
            assert!((covered - 0.5 * twice.abs()).abs() < 1e-12, "{points:?}: {covered}");
        };
        check(&[(1.0, 1.0), (9.0, 1.0), (9.0, 4.0), (1.0, 4.0)]);
        check(&[(0.3, 0.7), (11.2, 3.1), (4.4, 10.9)]);
        check(&[(0.3, 0.7), (4.4, 10.9), (11.2, 3.1)]);
        check(&[(2.0, 2.5), (10.0, 2.6), (10.0, 2.7)]);
        check(&[(6.0, 0.0), (12.0, 6.0), (6.0, 12.0), (0.0, 6.0)]);
    }

    #[test]
    fn what_lies_outside_is_cut_off() {
        let covered = area(&[(-5.0, -5.0), (20.0, -5.0), (20.0, 20.0), (-5.0, 20.0)], 6);
        assert!((covered - 36.0).abs() < 1e-12, "{covered}");
        let covered = area(&[(-4.0, 0.0), (4.0, 0.0), (4.0, 6.0), (-4.0, 6.0)], 6);
        assert!((covered - 24.0).abs() < 1e-12, "{covered}");
    }

    #[test]
    fn a_curve_ends_where_it_should() {
        let points: Vec<PixelPoint> = curve((0.0, 0.0), (4.0, 8.0), (8.0, 0.0)).collect();
        assert_eq!((points[PIECES / 2 - 1], points[PIECES - 1]), ((4.0, 4.0), (8.0, 0.0)));
    }
}
