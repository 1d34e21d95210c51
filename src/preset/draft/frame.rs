//! The frames for viewing a picture, as written.

use toml::Spanned;

use super::table::Table;
use super::vector::{self, Formulas};
use super::{Formula, value};
use crate::diagnostic::{Diagnostic, SourceRange};

pub(in crate::preset) struct DraftFrame {
    pub(in crate::preset) name: Option<Spanned<String>>,
    pub(in crate::preset) axis: Option<Formulas>,
    pub(in crate::preset) angle: Option<Formula>,
    pub(in crate::preset) origin: Option<Formulas>,
    /// The position and mass of each particle.
    pub(in crate::preset) particles: Vec<(Option<Formulas>, Option<Formula>)>,
    /// The range of the key that makes it the frame of the body.
    pub(in crate::preset) attitude: Option<SourceRange>,
    pub(in crate::preset) place: SourceRange,
}

pub(super) fn frames(top: &mut Table<'_>) -> Vec<DraftFrame> {
    top.each("frames", "this frame", frame)
}

fn frame(table: &mut Table<'_>) -> DraftFrame {
    let name = table.name();
    let attitude = table.flag("attitude").filter(|flag| *flag.get_ref());
    let (axis_key, _) = table.take("axis").unzip();
    let axis = vector::triple(table, "axis");
    let (angle_key, found) = match &attitude {
        Some(_) => table.take("angle"),
        None => {
            let help = "write angle = \"...\", or attitude = true for the frame of the body";
            table.require("angle", help)
        }
    }
    .unzip();
    let angle = found.and_then(|found| value::formula(found, "`angle`", table.diagnostics));
    if attitude.is_some() {
        for key in [axis_key, angle_key].into_iter().flatten() {
            let message = "the frame of the body turns with [attitude]; it has no axis and angle";
            table.diagnostics.push(Diagnostic::error(key, message));
        }
    }
    let origin = vector::triple(table, "origin");
    let particle = ("this particle", "{ at = [\"x\", \"y\", \"0\"], mass = \"m\" }");
    let particles = table
        .items("particles", particle, |entry| (vector::triple(entry, "at"), entry.formula("mass")));
    let attitude = attitude.map(|flag| flag.span());
    DraftFrame { name, axis, angle, origin, particles, attitude, place: table.place.clone() }
}
