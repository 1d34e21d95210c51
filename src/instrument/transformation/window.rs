//! What of the plane of two new variables is shown: the bulk of the grid, the motion, and other images that are not too far.
//!
//! In: lines, images, how far the motion went. Out: the range of an axis. Never here: how lines and images are found.

/// One of so many points of the grid may be out of the picture at each end of an axis.
const OUTER: usize = 40;

/// How far from the middle half of the grid its bulk reaches, in widths of that half: beside a pole few points are far away.
const FENCES: f64 = 3.0;

/// What is on other branches is shown if the range becomes no wider than so many times that of the motion's own.
const WIDER: f64 = 4.0;

/// What may be shown, in numbers along one axis.
pub(super) struct ShownCoordinates<'a> {
    pub(super) own: &'a [Vec<[f64; 2]>],
    pub(super) others: &'a [Vec<[f64; 2]>],
    /// The other images of the moving point.
    pub(super) images: &'a [[f64; 2]],
    pub(super) reached: [f64; 2],
}

impl ShownCoordinates<'_> {
    /// The range of an axis; `None` without a grid.
    pub(super) fn range(&self, axis: usize) -> Option<[f64; 2]> {
        let own = Bulk::of(self.own, axis)?;
        let [lo, hi] = own.ends;
        let [least, greatest] = self.reached.map(|x| x.clamp(own.fences[0], own.fences[1]));
        let own = [lo.min(least), hi.max(greatest)];
        let widened = |[lo, hi]: [f64; 2], [a, b]: [f64; 2]| {
            let wide = [lo.min(a), hi.max(b)];
            if wide[1] - wide[0] <= WIDER * (own[1] - own[0]) { wide } else { [lo, hi] }
        };
        let others = Bulk::of(self.others, axis).map(|bulk| bulk.ends);
        let images = self.images.iter().map(|image| [image[axis]; 2]);
        Some(others.into_iter().chain(images).fold(own, widened))
    }
}

/// The bulk of some points along an axis, and beyond what nothing belongs to it.
struct Bulk {
    ends: [f64; 2],
    fences: [f64; 2],
}

impl Bulk {
    fn of(lines: &[Vec<[f64; 2]>], axis: usize) -> Option<Bulk> {
        let mut all: Vec<f64> = lines.iter().flatten().map(|point| point[axis]).collect();
        all.sort_by(f64::total_cmp);
        let at = |index: usize| all.get(index).copied();
        let cut = all.len() / OUTER;
        let (lower, upper) = (at(all.len() / 4)?, at(3 * all.len() / 4)?);
        let fence = FENCES * (upper - lower);
        let fences = [lower - fence, upper + fence];
        let [least, greatest] = [at(cut)?, at(all.len().checked_sub(cut + 1)?)?];
        Some(Bulk { ends: [least.max(fences[0]), greatest.min(fences[1])], fences })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(of: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
        (-50..=50).map(|k| [f64::from(k) / 50.0, of(f64::from(k) / 50.0)]).collect()
    }

    /// Beside the pole of 1/x² the bulk is shown; a motion that has passed it does not make the picture flat.
    #[test]
    fn a_pole_does_not_make_the_picture_flat() {
        let own = [line(|x| 1.0 / (x * x + 1e-12))];
        let along = ShownCoordinates { own: &own, others: &[], images: &[], reached: [1.0, 8e10] };
        let [lo, hi] = along.range(1).expect("a range");
        assert!(lo > -100.0 && (10.0..100.0).contains(&hi), "{lo} {hi}");
        // nor is anything cut that is spread evenly
        let own = [line(|x| x)];
        let along = ShownCoordinates { own: &own, others: &[], images: &[], reached: [-1.2, 0.5] };
        assert_eq!(along.range(0).expect("a range")[0], -1.2);
        assert!(along.range(0).expect("a range")[1] > 0.9);
    }

    /// The other image is in the picture, but for one that is far away.
    #[test]
    fn another_image_is_shown_unless_it_is_far() {
        let own = [line(|x| x)];
        for (image, shown) in [(-2.5, true), (-33.0, false)] {
            let images = [[0.0, image]];
            let along =
                ShownCoordinates { own: &own, others: &[], images: &images, reached: [-1.0, 1.0] };
            assert_eq!(along.range(1).expect("a range")[0] <= image, shown);
        }
    }
}
