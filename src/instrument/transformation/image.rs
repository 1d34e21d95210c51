//! What is said of the image of the moving point, and of those on other branches.
//!
//! In: how the map is given, whether the image is there, how many branches were found and how many of them lead to the
//! point, how many images are on none. Out: lines of the legend. Never here: how images are found (`branches`).

use crate::model::{Transformation, TransformationLaw};
use crate::num::significant;

#[derive(Clone, Copy, Debug)]
pub(super) struct ImageOrigin {
    /// Whether it is found by Newton's method.
    pub(super) solved: bool,
    pub(super) exists: bool,
}

impl ImageOrigin {
    pub(super) fn lines(self, law: &Transformation) -> &'static [&'static str] {
        match (&law.law, self) {
            (_, ImageOrigin { solved: true, exists: true }) => &["solved numerically"],
            (_, ImageOrigin { solved: false, exists: true }) => &[],
            (TransformationLaw::Generating { .. }, _) => {
                &["no image: beyond a caustic", "caustic: det ∂²F/∂old∂new = 0"]
            }
            // a written map has no value where a root in it is negative, or where it divides by zero
            _ => &["no image: the map has no value here"],
        }
    }
}

/// What is said of other images that are too far away to be shown.
pub(super) fn outside(images: &[[f64; 2]], ranges: &[Option<[f64; 2]>; 2]) -> Option<String> {
    let shows = |point: [f64; 2]| {
        let mut along = point.into_iter().zip(ranges);
        along.all(|(x, range)| range.is_none_or(|[lo, hi]| (lo..=hi).contains(&x)))
    };
    let far: Vec<[f64; 2]> = images.iter().copied().filter(|&image| !shows(image)).collect();
    let short = |x: f64| significant(x, 3, 1e-3..1e5).replace('-', "−");
    match far[..] {
        [] => None,
        [[x, y]] => {
            Some(format!("outside of the picture: the image at ({}, {})", short(x), short(y)))
        }
        [..] => Some(format!("outside of the picture: {} images", far.len())),
    }
}

/// What is said of a motion that was farther than is shown along an axis, as beside a pole.
pub(super) fn beyond(
    name: &str,
    range: Option<[f64; 2]>,
    reached: Option<[f64; 2]>,
) -> Option<String> {
    let ([lo, hi], [least, greatest]) = (range?, reached?);
    let far = [least, greatest].into_iter().filter(|x| !(lo..=hi).contains(x));
    let far: Vec<String> = far.map(|x| significant(x, 2, 1e-3..1e5).replace('-', "−")).collect();
    (!far.is_empty()).then(|| format!("outside of the picture: {name} = {}", far.join(", ")))
}

/// What is said of the other branches: how many there are, how many of them lead to the point, and how many images there are
/// to which none leads.
pub(super) fn of_branches(others: usize, rings: usize, beside: usize) -> Option<String> {
    match (others, rings, beside) {
        (0, _, _) => None,
        (1, 0, 0) => Some("dim grid: the second branch, which does not lead here".to_owned()),
        (1, 0, _) => Some("ring: the second image".to_owned()),
        (1, _, _) => Some("ring, dim grid: the second branch".to_owned()),
        (n, k, _) if n == k => Some(format!("rings, dim grids: {n} other branches")),
        (n, k, 0) => Some(format!("rings, dim grids: {n} other branches, {k} lead here")),
        (n, k, m) => Some(format!(
            "rings: {} other images; dim grids: {n} other branches, {k} lead here",
            k + m
        )),
    }
}
