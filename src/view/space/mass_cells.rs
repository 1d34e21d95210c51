//! The masses under the mouse: the cells of those that can be dragged.
//!
//! In: the shapes of a plane seen face on. Out: cells by rows. Never here: what a drag does.

use ratatui::layout::{Position, Rect};

use super::ScenePainter;
use crate::model::Shape;
use crate::view::plot::{Camera, PlotFrame};

impl ScenePainter<'_> {
    /// The masses that can be dragged, in a plane seen face on: the cells of each by rows, its index among the shapes, and the frame.
    pub(super) fn draggable(&self) -> Vec<(Rect, usize, PlotFrame)> {
        let is_face_on =
            [self.camera.yaw, self.camera.pitch] == [Camera::FACE_ON.yaw, Camera::FACE_ON.pitch];
        if !is_face_on || self.range.is_some() {
            return Vec::new();
        }
        let mut found = Vec::new();
        for (index, (shape, _)) in self.q.lab.shapes(self.eye).enumerate() {
            if let Shape::Mass { at, radius } = shape
                && self.q.lab.can_drag(self.eye, index)
            {
                let radius = self.disc_radius(radius.map(|radius| self.q.number(radius)));
                let rows = self.mass_rows(self.flat(self.point(at)), radius);
                found.extend(rows.into_iter().map(|row| (row, index, self.frame)));
            }
        }
        found
    }

    /// The cells that a mass covers, by rows. Those of a marker have one more at each side: nobody hits a single one.
    fn mass_rows(&self, [x, y]: [f64; 2], radius: Option<f64>) -> Vec<Rect> {
        let (frame, area) = (&self.frame, self.frame.area);
        let Some(radius) = radius else {
            let around = |centre: Position| Rect::new(centre.x.saturating_sub(1), centre.y, 3, 1);
            let centre = frame.cell([x, y]).map(around);
            return centre.map(|cells| cells.intersection(area)).into_iter().collect();
        };
        let [wide, tall] = [area.width, area.height].map(f64::from);
        // the row and the columns in cells from the upper left corner
        let column = |x: f64| (frame.x.fraction(x) * wide).clamp(0.0, wide);
        let end = |row: u16| frame.y.value(1.0 - f64::from(row) / tall);
        let cells = |row: u16| {
            let [above, below] = [end(row), end(row + 1)];
            let off = y - y.clamp(below.min(above), below.max(above));
            let half = (radius * radius - off * off).max(0.0).sqrt();
            let [from, to] = [column(x - half).floor() as u16, column(x + half).ceil() as u16];
            (half > 0.0 && from < to).then(|| Rect::new(area.x + from, area.y + row, to - from, 1))
        };
        (0..area.height).filter_map(cells).collect()
    }
}
