//! Frames for viewing a picture: how they turn, and whose apparent forces are drawn in them.

use toml::Spanned;

use super::ModelBuilder;
use super::names::report_twice;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::nearest;
use crate::expr::Expr;
use crate::model::{Allowed, Frame, Point, Scope};
use crate::preset::draft::{DraftFrame, Formulas};

impl ModelBuilder<'_> {
    pub(super) fn frames(&mut self, written: &[DraftFrame]) {
        let mut scope = Scope::new(&self.model, Allowed::Configuration, "a frame");
        let mut fixed = Scope::new(&self.model, Allowed::Parameters, "the axis of a frame");
        let mut before: Vec<&Spanned<String>> = Vec::new();
        for frame in written {
            if let Some(name) = &frame.name {
                match before.iter().find(|known| known.get_ref() == name.get_ref()) {
                    Some(first) => report_twice(name, first.span(), "a frame", self.diagnostics),
                    None => before.push(name),
                }
            }
            if let (Some(place), None) = (&frame.attitude, &self.model.attitude) {
                let message = "there is no [attitude] for this frame to turn with";
                let help = "give the orientation of the body in [attitude]";
                self.diagnostics.push(Diagnostic::error(place.clone(), message).with_help(help));
            }
            let axis = frame.axis.as_ref().map(|f| self.axis(f, &mut fixed));
            let angle = frame.angle.as_ref().map(|f| self.formula(&mut scope, "a frame", f));
            let origin = frame.origin.as_ref().map(|f| self.of_frame(f, "a frame", &mut scope));
            let mut particles = Vec::new();
            for (at, mass) in &frame.particles {
                let called = "a particle of a frame";
                let at = at.as_ref().and_then(|f| self.of_frame(f, called, &mut scope));
                let mass = mass.as_ref().and_then(|f| self.formula(&mut scope, called, f));
                particles.extend(at.zip(mass));
            }
            let z = [Expr::ZERO, Expr::ZERO, Expr::ONE];
            self.model.frames.push(Frame {
                name: frame.name.as_ref().map_or(String::new(), |n| n.get_ref().clone()),
                axis: axis.flatten().unwrap_or(z),
                angle: angle.flatten().unwrap_or(Expr::ZERO),
                origin: origin.flatten().unwrap_or([Expr::ZERO; 3]),
                particles,
                attitude: frame.attitude.is_some(),
            });
        }
    }

    fn of_frame(&mut self, written: &Formulas, called: &str, scope: &mut Scope) -> Option<Point> {
        let read: Vec<Option<Expr>> =
            written.get_ref().iter().map(|f| self.formula(scope, called, f)).collect();
        Some([read[0]?, read[1]?, read[2]?])
    }

    /// A constant direction.
    fn axis(&mut self, written: &Formulas, scope: &mut Scope) -> Option<Point> {
        let axis = self.of_frame(written, "the axis of a frame", scope)?;
        if axis.into_iter().all(|e| self.at_start(e) == 0.0) {
            self.error(written.span(), "this axis has no length, and so no direction");
            return None;
        }
        Some(axis)
    }

    pub(super) fn frame_of_view(&mut self, name: &Spanned<String>) -> Option<usize> {
        let found = self.model.frames.iter().position(|frame| frame.name == *name.get_ref());
        if found.is_none() {
            let known: Vec<&str> = self.model.frames.iter().map(|f| f.name.as_str()).collect();
            let help = match nearest(name.get_ref(), known.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None if known.is_empty() => "the file has no [[frames]]".to_owned(),
                None => format!("the frames are {}", known.join(", ")),
            };
            let message = format!("unknown frame `{}`", name.get_ref());
            self.diagnostics.push(Diagnostic::error(name.span(), message).with_help(help));
        }
        found
    }
}
