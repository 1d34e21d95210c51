//! Names beside points of a plot.
//!
//! In: layers, the frame of a plot. Out: cells. Never here: what has a name.

use unicode_width::UnicodeWidthStr;

use super::canvas::Canvas;
use super::plot::PlotFrame;
use super::theme::Role;
use crate::instrument::{Layer, Level};

/// What of a range is left free beyond a point that it was made longer for.
const MARGIN: f64 = 0.06;

/// The ranges that show all named points which lie in reach of what is shown: no farther beyond it than it is long. `None` if
/// these show them already.
pub(super) fn in_reach(layers: &[(Level, Layer)], shown: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
    let length = shown.map(|[lo, hi]| hi - lo);
    let is_near = |at: &[f64; 2]| {
        (0..2).all(|k| at[k] >= shown[k][0] - length[k] && at[k] <= shown[k][1] + length[k])
    };
    let mut ranges = shown;
    for (_, layer) in layers {
        let Layer::Name(at, ..) = layer else { continue };
        for k in (0..2).filter(|_| is_near(at)) {
            let margin = MARGIN * length[k];
            if at[k] < shown[k][0] {
                ranges[k][0] = ranges[k][0].min(at[k] - margin);
            } else if at[k] > shown[k][1] {
                ranges[k][1] = ranges[k][1].max(at[k] + margin);
            }
        }
    }
    (ranges != shown).then_some(ranges)
}

/// Writes each name beside its point: to the right, or to the left where it would leave the plot or cover another such point, then above
/// or below; a name for which there is no room beside those before it is left out.
pub(super) fn draw(canvas: &mut Canvas<'_>, frame: &PlotFrame, layers: &[(Level, Layer)]) {
    // what is taken: the columns of a row
    let mut taken: Vec<(u16, u16, u16)> = Vec::new();
    for (_, layer) in layers {
        if let Layer::Name(at, ..) = layer
            && let Some(cell) = frame.cell(*at)
        {
            taken.push((cell.x, cell.x, cell.y));
        }
    }
    for (_, layer) in layers {
        let Layer::Name(at, name) = layer else { continue };
        let Some(cell) = frame.cell(*at) else { continue };
        let name = canvas.text(name);
        let width = u16::try_from(name.width()).unwrap_or(u16::MAX);
        let right = Some(cell.x.saturating_add(2));
        let left = cell.x.checked_sub(width.saturating_add(1));
        let (above, below) = (cell.y.checked_sub(1), cell.y.checked_add(1));
        let over = Some(cell.x.saturating_sub(width / 2));
        let places = [(right, Some(cell.y)), (left, Some(cell.y)), (over, above), (over, below)];
        let inside = |(x, y): &(u16, u16)| {
            *x >= frame.area.x
                && x.saturating_add(width) <= frame.area.right()
                && (frame.area.y..frame.area.bottom()).contains(y)
        };
        let free = |(x, y): &(u16, u16)| {
            let apart = |&(from, to, row): &(u16, u16, u16)| {
                row != *y || *x > to || x.saturating_add(width) < from
            };
            taken.iter().all(apart)
        };
        let places = places.into_iter().filter_map(|(x, y)| Some((x?, y?)));
        let Some((x, y)) = places.into_iter().find(|place| inside(place) && free(place)) else {
            continue;
        };
        taken.push((x, x.saturating_add(width), y));
        let style = canvas.style(Role::Title);
        canvas.write(ratatui::layout::Position { x, y }, width, &name, style);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_made_longer_for_what_is_in_reach_alone() {
        let names = |points: &[[f64; 2]]| -> Vec<(Level, Layer)> {
            let name = |at: &[f64; 2]| (4, Layer::Name(*at, "L".to_owned()));
            points.iter().map(name).collect()
        };
        let shown = [[0.0, 1.0], [0.0, 10.0]];
        assert_eq!(in_reach(&names(&[[0.5, 5.0], [1.0, 0.0]]), shown), None);
        let longer = in_reach(&names(&[[0.5, -9.0], [0.5, 5.0]]), shown).expect("one is in reach");
        assert_eq!(longer, [[0.0, 1.0], [-9.6, 10.0]]);
        // far away in either direction, or nowhere
        for far in [[0.5, -11.0], [2.5, -9.0], [f64::NAN, -9.0], [0.5, f64::INFINITY]] {
            assert_eq!(in_reach(&names(&[far]), shown), None);
        }
    }
}
