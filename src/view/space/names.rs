//! What a scene has names for: its points, and two mechanics side by side.
//!
//! In: points of shapes, words. Out: labels, colours. Never here: where a name has room.

use super::ScenePainter;
use super::annotation::Label;
use crate::expr::Symbol;
use crate::model::Shape;
use crate::view::plot::Visibility;
use crate::view::theme::Role;

impl ScenePainter<'_> {
    /// Writes words beside a point, away from another one.
    pub(super) fn label(&mut self, at: [f64; 3], foot: Option<[f64; 3]>, text: &str) {
        let veiled = self.sight(at) == Visibility::Veiled;
        let [tip, foot] = [at, foot.unwrap_or(at)].map(|point| self.flat(point));
        let role = match () {
            () if veiled => Role::Dim,
            () if foot == tip => Role::Text,
            () => Role::Accent,
        };
        let text = self.q.look.glyphs.text(text).into_owned();
        self.labels.push(Label { tip, leftwards: tip[0] < foot[0], text, role });
    }

    /// The colours of the traces of the right mechanics and of the wrong one beside it, where both leave one.
    pub(super) fn mechanics(&self) -> Option<[usize; 2]> {
        let other = &self.q.lab.loaded.model.comparison.as_ref()?.symbols;
        let other: Vec<Symbol> = other.iter().flat_map(|&(place, rate)| [place, rate]).collect();
        let pool = &self.q.lab.loaded.equations.pool;
        let trace = |wrong: bool| {
            self.q.lab.shapes(self.eye).find_map(|(shape, _)| match shape {
                Shape::Trace { at } => {
                    let is_wrong = at.iter().any(|&e| pool.depends_on_any(e, &other));
                    (is_wrong == wrong).then(|| self.colour(at))
                }
                _ => None,
            })
        };
        Some([trace(false)?, trace(true)?])
    }
}
