//! What is seen of a cloud at one time, and the extent of all that was seen.
//!
//! In: the points of a cloud. Out: plain data. Never here: how a cloud is carried.

use std::sync::Arc;

use crate::ensemble::Circulation;

/// How far from the middle half of the cloud its bulk reaches, in widths of that half. Evenly spread points reach half of one.
const FENCES: f64 = 3.0;

#[derive(Clone)]
pub(super) struct CloudFrame {
    pub(super) time: f64,
    pub(super) cloud: Arc<Vec<[f64; 2]>>,
    pub(super) curve: Arc<Vec<[f64; 2]>>,
    pub(super) action: Option<Circulation>,
    pub(super) own: [f64; 2],
}

/// The extent of the bulk in all that was seen, with what is in these frames. Few that escape do not make it wider: a point
/// belongs to the bulk that is no farther from the middle half of the cloud than [`FENCES`] of its width.
pub(super) fn extent(known: Option<[[f64; 2]; 2]>, frames: &[CloudFrame]) -> [[f64; 2]; 2] {
    let mut extent = known.unwrap_or([[f64::INFINITY, f64::NEG_INFINITY]; 2]);
    for frame in frames {
        for (axis, ends) in extent.iter_mut().enumerate() {
            let finite = |at: &[f64; 2]| Some(at[axis]).filter(|x| x.is_finite());
            let mut seen: Vec<f64> = frame.cloud.iter().filter_map(finite).collect();
            if seen.is_empty() {
                seen = frame.curve.iter().filter_map(finite).collect();
            }
            seen.sort_by(f64::total_cmp);
            let (Some(lower), Some(upper)) =
                (seen.get(seen.len() / 4), seen.get(3 * seen.len() / 4))
            else {
                continue;
            };
            let fence = FENCES * (upper - lower);
            let bulk = lower - fence..=upper + fence;
            for x in seen.iter().filter(|x| bulk.contains(x)) {
                *ends = [ends[0].min(*x), ends[1].max(*x)];
            }
        }
    }
    extent
}
