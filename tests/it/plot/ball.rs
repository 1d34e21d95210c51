//! Balls that are drawn in blocks.

use std::collections::{BTreeMap, BTreeSet};

use phaselab::view::plot::{DepthBuffer, PlotFrame, Scale};
use ratatui::layout::Rect;

/// In rows of blocks a ball is widest in its middle, alike above and below, and its first row is as wide as a circle is there:
/// 2 √(r² − (r − ½)²) for a radius of r rows, less at most a block at each end.
#[test]
fn a_ball_in_blocks_has_a_round_edge_wherever_it_is() {
    for (step, radius) in (0..8).flat_map(|step| [9.3, 17.0, 22.6].map(|r| (step, r))) {
        let scale = Scale::linear(-50.0, 50.0);
        let frame = PlotFrame::new(scale, scale, Rect::new(0, 0, 50, 25));
        let mut buffer = DepthBuffer::new(&frame, [100, 100]).with_blocks([1.0, 2.0]);
        let shift = f64::from(step) / 4.0;
        buffer.ball([shift / 3.0, shift, 0.0], radius, 0);
        let mut rows = BTreeMap::<i32, BTreeSet<i32>>::new();
        for ([x, y], _) in buffer.dots() {
            rows.entry(y / 2).or_default().insert(x);
        }
        let widths: Vec<usize> = rows.values().map(BTreeSet::len).collect();
        let reversed: Vec<usize> = widths.iter().rev().copied().collect();
        assert_eq!(widths, reversed, "radius {radius}, moved by {shift}");
        assert!(widths[..widths.len() / 2].is_sorted(), "{widths:?}");
        let r = radius / 2.0;
        let first = 4.0 * (r * r - (r - 0.5) * (r - 0.5)).sqrt();
        assert!(widths[0] as f64 >= first - 2.0, "{widths:?}, {first}");
    }
}
