//! The current state as a file: the text of a system with every changed value, starting where the motion is now.
//!
//! In: a document, its system, a [`Snapshot`]. Out: a text without errors. Never here: writing the file.

use super::{Checkpoint, Prepared, Snapshot};
use crate::claims::false_claims;
use crate::diagnostic::{Diagnostic, Document, Severity};
use crate::model::{AttitudeSource, Model};
use crate::num::math;
use crate::preset::{InitialValue, Rewrite};
use crate::system::{ChannelKind, System};

/// The exported file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Export {
    /// A preset, as it would be written.
    pub text: String,
    /// Sentences about what the file cannot express.
    pub missing: Vec<String>,
}

impl Export {
    /// Exports a document's system as a snapshot shows it.
    ///
    /// # Errors
    /// Returns a sentence if no file can express the current state.
    pub fn of(
        document: &Document,
        (model, system): (&Model, &System),
        snapshot: &Snapshot,
    ) -> Result<Export, String> {
        let checkpoint = Checkpoint::of(model, system, snapshot);
        let mut missing = Vec::new();
        let begun = checkpoint.present.is_some();
        let all_active = snapshot.released.is_empty();
        if !all_active {
            missing.push("A constraint was released, so the file begins at the start.".to_owned());
        }
        if begun && all_active && model.impulses.iter().any(|impulse| impulse.period.is_some()) {
            missing.push("Periodic impulses count from the new start.".to_owned());
        }
        let mut rewrite = Rewrite {
            parameters: checkpoint.parameters.iter().map(|p| (p.name.clone(), p.value)).collect(),
            method: checkpoint.method.clone(),
            run: [
                ("step", checkpoint.step),
                ("tolerance", checkpoint.tolerance),
                ("speed", checkpoint.speed),
            ]
            .into_iter()
            .filter_map(|(key, value)| Some((key, value.filter(|v| v.is_finite())?)))
            .collect(),
            ..Rewrite::default()
        };
        if begun && all_active {
            rewrite.start = Some(snapshot.time).filter(|time| *time != model.run.start);
            rewrite.initial = initial_values(model, |kind| value(system, snapshot, kind));
            rewrite.attitude = attitude(system, snapshot).filter(|_| is_integrated(model));
        } else {
            let count = model.coordinates.len();
            rewrite.initial = initial_values(model, |kind| match kind {
                ChannelKind::Position(i) => snapshot.initial.get(i).copied(),
                ChannelKind::Velocity(i) | ChannelKind::Momentum(i) => {
                    snapshot.initial.get(count + i).copied()
                }
                _ => None,
            });
        }
        let words = rewrite.of(&document.text).map_err(|error| error.to_string())?;
        let (text, left_out) = with_what_holds(document, words, &wrong_as_written)?;
        missing.extend(left_out.then(|| LEFT_OUT.to_owned()));
        Ok(Export { text, missing })
    }

    /// Removes the expectations that the new motion does not fulfil. The motion is integrated for that, as far as the
    /// expectations reach.
    ///
    /// # Errors
    /// Returns a sentence if the resulting file cannot be opened.
    pub fn with_what_holds(self, document: &Document) -> Result<Export, String> {
        let Export { text, mut missing } = self;
        let (text, left_out) = with_what_holds(document, text, &wrong_in_motion)?;
        if left_out && !missing.iter().any(|name| name == LEFT_OUT) {
            missing.push(LEFT_OUT.to_owned());
        }
        Ok(Export { text, missing })
    }
}

/// The note for a file from which expectations were removed.
const LEFT_OUT: &str = "Expectations of the file that no longer hold are left out.";

/// The errors of a text, and a report if it cannot be opened at all.
type ExportErrors = (Vec<Diagnostic>, Option<String>);

/// Removes the expectations that fail because they were made for other values. Also returns whether there were any.
fn with_what_holds(
    document: &Document,
    words: String,
    wrong_with: &dyn Fn(&Document) -> ExportErrors,
) -> Result<(String, bool), String> {
    let mut text = words;
    let mut left_out = false;
    loop {
        let (diagnostics, report) = wrong_with(&Document::new(&document.path, &text));
        let places: Vec<_> =
            diagnostics.iter().map(|diagnostic| diagnostic.place.clone()).collect();
        let fewer = Rewrite::without_expectations(&text, &places).map_err(|why| why.to_string())?;
        match (fewer, report) {
            // each pass removes at least one
            (Some(fewer), _) => (text, left_out) = (fewer, true),
            (None, Some(report)) => return Err(report),
            (None, None) => return Ok((text, left_out)),
        }
    }
}

/// The errors of a text, without its motion.
fn wrong_as_written(document: &Document) -> ExportErrors {
    match Prepared::of(document) {
        Err(error) => (error.diagnostics, Some(error.report)),
        Ok(_) => (Vec::new(), None),
    }
}

/// The errors of a text, including the expectations that its motion does not fulfil.
fn wrong_in_motion(document: &Document) -> ExportErrors {
    match Prepared::of(document) {
        Err(error) => (error.diagnostics, Some(error.report)),
        Ok(Prepared { model, equations, .. }) => {
            let diagnostics = false_claims(&model, &equations).into_iter();
            (diagnostics.filter(|m| m.severity == Severity::Error).collect(), None)
        }
    }
}

/// The start of every coordinate or variable, from the values of channels.
fn initial_values(model: &Model, value: impl Fn(ChannelKind) -> Option<f64>) -> Vec<InitialValue> {
    let of = |(i, c): (usize, &crate::model::Coordinate)| {
        let rate = if model.is_poisson() {
            None
        } else if model.is_lagrangian() {
            Some(("velocity", value(ChannelKind::Velocity(i))?))
        } else {
            Some(("momentum", value(ChannelKind::Momentum(i))?))
        };
        Some(InitialValue { name: c.name.clone(), value: value(ChannelKind::Position(i))?, rate })
    };
    model.coordinates.iter().enumerate().filter_map(of).collect()
}

/// Whether the attitude of a body is integrated along with the motion.
fn is_integrated(model: &Model) -> bool {
    let source = model.attitude.as_ref().map(|attitude| &attitude.source);
    matches!(source, Some(AttitudeSource::Rate { .. }))
}

fn value(system: &System, snapshot: &Snapshot, kind: ChannelKind) -> Option<f64> {
    let place = system.channels().iter().position(|channel| channel.kind == kind)?;
    snapshot.values.get(place).copied().filter(|value| value.is_finite())
}

/// Euler's angles φ, θ, ψ of the attitude. Its third column is (sin ψ sin θ, cos ψ sin θ, cos θ) and its third row
/// (sin θ sin φ, −sin θ cos φ, cos θ): Goldstein, *Classical Mechanics*, (4-46).
fn attitude(system: &System, snapshot: &Snapshot) -> Option<[f64; 3]> {
    let entry = |i: usize, j: usize| value(system, snapshot, ChannelKind::Attitude(3 * i + j));
    let sine = math::hypot(entry(2, 0)?, entry(2, 1)?);
    let theta = math::atan2(sine, entry(2, 2)?);
    if sine < 1e-12 {
        return Some([math::atan2(entry(0, 1)?, entry(0, 0)?), theta, 0.0]);
    }
    let phi = math::atan2(entry(2, 0)?, -entry(2, 1)?);
    Some([phi, theta, math::atan2(entry(0, 2)?, entry(1, 2)?)])
}
