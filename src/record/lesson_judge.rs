//! What the motion says to an answer.
//!
//! In: an answer that was committed, a [`Lesson`] at the outcome. Out: whether it is right, what is right, and what is said.
//! Never here: keys, or what comes next.

use super::assertion::short;
use super::assertion::{self, AssertionResult};
use super::lesson::{Lesson, paragraph};
use super::lesson_finding::in_words;
use super::lesson_question::{AnswerChoice, Truth};
use super::script::{AskedAxis, LineText};
use crate::app::{PredictedAxis, Prediction};
use crate::diagnostic::{Diagnostic, SourceRange};
use crate::num::significant;
use crate::view::lesson::{Paragraph, ParagraphKind};

/// A number this small relative to how far a prediction may be off is zero.
const ROUNDING: f64 = 1e-9;

/// What is said, whether the answer was right, and what is right.
type JudgedAnswer = (Vec<Paragraph>, (bool, Truth));

impl Lesson {
    pub(super) fn judge_choice(
        &self,
        options: &[AnswerChoice],
        chosen: Option<usize>,
    ) -> Result<JudgedAnswer, Diagnostic> {
        let findings: Vec<AssertionResult> =
            options.iter().map(|option| self.find(&option.claim)).collect::<Result<_, _>>()?;
        let holds: Vec<bool> = findings.iter().map(|finding| finding.holds).collect();
        let chosen = chosen.unwrap_or(0);
        let right = holds[chosen];
        let own = letter(chosen, &options[chosen].text);
        let mut spoken = vec![match (right, &options[chosen].why) {
            (true, _) => paragraph(ParagraphKind::Right, format!("Right: {own}")),
            (false, None) => paragraph(ParagraphKind::Wrong, format!("Wrong: {own}")),
            (false, Some(why)) => paragraph(ParagraphKind::Wrong, format!("Wrong: {own}. {why}")),
        }];
        if let (false, Some(other)) = (right, holds.iter().position(|holds| *holds)) {
            let other = letter(other, &options[other].text);
            spoken.push(paragraph(ParagraphKind::Text, format!("The answer is {other}")));
        }
        let holding =
            options.iter().zip(&holds).find_map(|(option, holds)| holds.then_some(option));
        if let Some(found) =
            holding.and_then(|option| in_words(&option.claim, &self.runner.lab.app))
        {
            spoken.push(paragraph(ParagraphKind::Quiet, format!("Measured: {found}.")));
        }
        Ok((spoken, (right, Truth::Options(holds))))
    }

    pub(super) fn judge_number(
        &self,
        value: &LineText,
        within: &LineText,
        typed: Option<f64>,
    ) -> Result<JudgedAnswer, Diagnostic> {
        let app = &self.runner.lab.app;
        let (value, within) = (assertion::value(app, value)?, assertion::value(app, within)?);
        let number = typed.unwrap_or(f64::NAN);
        let right = (number - value).abs() <= within;
        let (kind, word) = spoken(right);
        let (number, found, near) = (short(number), short(value), short(within));
        let text = format!(
            "{word}: you predicted {number}; the answer is {found} (within {near} counts as right)."
        );
        Ok((vec![paragraph(kind, text)], (right, Truth::Value(value, within))))
    }

    /// As the others, and the point or the curve of the motion.
    pub(super) fn judge_place(
        &self,
        prediction: &Prediction,
        since: f64,
    ) -> (Vec<Paragraph>, (bool, Truth), Vec<[f64; 2]>) {
        let found = self.motion_along(prediction, since);
        let distance = prediction.distance(&found);
        let right = distance.is_some_and(|distance| distance <= 1.0);
        let (kind, word) = spoken(right);
        let [x, y] = prediction.axes.map(|axis| short(axis.within));
        let names = self.names(prediction);
        let text = match (prediction.points.last(), found.last()) {
            (Some(own), Some(found)) if !prediction.is_curve => {
                // the last digits of what vanishes say nothing
                let shown = |at: &[f64; 2]| {
                    let known = |k: usize| at[k].abs() > ROUNDING * prediction.axes[k].within;
                    let at = [0, 1].map(|k| short(if known(k) { at[k] } else { 0.0 }));
                    format!("{} = {}, {} = {}", names[0], at[0], names[1], at[1])
                };
                let [own, found] = [own, found].map(shown);
                format!(
                    "{word}: you predicted {own}; the answer is {found} (within {x} and {y} counts as right)."
                )
            }
            _ if right => format!(
                "{word}: your curve is within {x} in {} and {y} in {} of the motion.",
                names[0], names[1]
            ),
            _ => {
                let [across, upwards] = names;
                let right = format!("within {x} in {across} and {y} in {upwards}");
                match distance {
                    Some(distance) => {
                        let times = significant(distance, 2, 1e-3..1e6);
                        format!(
                            "{word}: your curve is off by up to {times} times what counts as \
                             right ({right})."
                        )
                    }
                    None => format!(
                        "{word}: your curve is not near the motion ({right} counts as right)."
                    ),
                }
            }
        };
        (vec![paragraph(kind, text)], (right, Truth::Place(found.clone())), found)
    }

    /// Where the motion is on the axes of a prediction, or the curve that it has drawn there since a time.
    fn motion_along(&self, prediction: &Prediction, since: f64) -> Vec<[f64; 2]> {
        let Some(snapshot) = self.runner.lab.app.lab.as_ref().and_then(|lab| lab.seen()) else {
            return Vec::new();
        };
        let channels = prediction.axes.map(|axis| axis.channel);
        let value = |channel: &usize| snapshot.values.get(*channel).copied().unwrap_or(f64::NAN);
        let now = channels.map(|channel| channel.as_ref().map_or(snapshot.time, value));
        if !prediction.is_curve {
            return vec![now];
        }
        let rows = snapshot.trail.rows().filter(|row| row.first().is_some_and(|t| *t >= since));
        let place = |row: &[f64]| {
            channels.map(|channel| {
                row.get(channel.map_or(0, |channel| 1 + channel)).copied().unwrap_or(f64::NAN)
            })
        };
        let finite = |at: &[f64; 2]| at.iter().all(|x| x.is_finite());
        rows.map(place).chain([now]).filter(finite).collect()
    }

    /// A prediction on the axes that a script names; begins to ask for it.
    pub(super) fn prediction(
        &mut self,
        place: &SourceRange,
        is_curve: bool,
        axes: &[AskedAxis; 2],
    ) -> Result<Prediction, Diagnostic> {
        let [across, upwards] = axes;
        let axes = [self.axis(across, true)?, self.axis(upwards, false)?];
        let prediction =
            Prediction { axes, is_curve, points: Vec::new(), outcome: Vec::new(), before: None };
        if self.runner.lab.app.begin_prediction(prediction.clone()) {
            return Ok(prediction);
        }
        let message = format!("no plot shows {} against {}", upwards.of.text, across.of.text);
        let help = "the system needs a view of kind \"phase\" of the two, or \"time\" against t";
        Err(Diagnostic::error(place.clone(), message).with_help(help))
    }

    fn axis(&self, asked: &AskedAxis, across: bool) -> Result<PredictedAxis, Diagnostic> {
        let app = &self.runner.lab.app;
        let channel = match asked.of.text.as_str() {
            "t" if across => None,
            _ => Some(assertion::column(app, &asked.of)?),
        };
        let within = assertion::value(app, &asked.within)?;
        if within <= 0.0 {
            let message = format!("nobody predicts a place exactly; this is within {within}");
            return Err(Diagnostic::error(asked.within.place.clone(), message));
        }
        let range = asked.range.as_ref().map(|ends| assertion::range(app, ends)).transpose()?;
        Ok(PredictedAxis { channel, range, within })
    }

    pub(super) fn names(&self, prediction: &Prediction) -> [String; 2] {
        let lab = self.runner.lab.app.lab.as_ref();
        prediction.axes.map(|axis| match axis.channel {
            None => "t".to_owned(),
            Some(channel) => {
                let channels = lab.map(|lab| lab.loaded.system.channels());
                let named = channels.and_then(|channels| channels.get(channel));
                named.map_or_else(String::new, |channel| channel.shown.clone())
            }
        })
    }
}

fn spoken(right: bool) -> (ParagraphKind, &'static str) {
    if right { (ParagraphKind::Right, "Right") } else { (ParagraphKind::Wrong, "Wrong") }
}

pub(super) fn letter(index: usize, text: &str) -> String {
    let letter = char::from(b'a' + (index.min(25) as u8));
    format!("{letter}) {text}")
}
