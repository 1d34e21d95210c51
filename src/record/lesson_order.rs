//! The order of the lines of a lesson, and how much each says at once.
//!
//! In: a [`Script`]. Out: the errors in its order, and the paragraphs that its pane has to hold. Never here: playing it.

use super::script::{LessonStep, Script, ScriptStep};
use crate::diagnostic::{Diagnostic, SourceRange};
use crate::view::lesson::{Paragraph, ParagraphKind, rows};

/// The most rows of the pane on a screen of 80 columns and 24 rows, with its frame.
const MOST_ROWS: u16 = 11;

const MOST_OPTIONS: usize = 6;

/// The errors in the order of a lesson.
pub(super) fn errors_in(script: &Script) -> Vec<Diagnostic> {
    let mut diagnostics = Vec::new();
    let mut wrong = |place: &SourceRange, message: &str, help: &str| {
        diagnostics.push(Diagnostic::error(place.clone(), message.to_owned()).with_help(help));
    };
    let mut open: Option<SourceRange> = None;
    let no_outcome = "the outcome of this question is never shown";
    for (index, (place, step)) in script.steps.iter().enumerate() {
        let ScriptStep::Lesson(step) = step else { continue };
        let above = index.checked_sub(1).map(|above| &script.steps[above].1);
        let asks = matches!(
            step,
            LessonStep::Ask(_)
                | LessonStep::Predict { .. }
                | LessonStep::Task { .. }
                | LessonStep::Free(_)
        );
        if let Some(first) = open.take_if(|_| asks) {
            wrong(&first, no_outcome, "put `Outcome` before the next question or task");
        }
        match step {
            LessonStep::Ask(_) => {
                let below = &script.steps[index + 1..];
                let option = |step: &ScriptStep| {
                    matches!(step, ScriptStep::Lesson(LessonStep::Option { .. }))
                };
                let count = below.iter().take_while(|(_, step)| option(step)).count();
                if !(2..=MOST_OPTIONS).contains(&count) {
                    let help = "an option is written Option \"TEXT\" why \"TEXT\" if CLAIM";
                    wrong(place, "a question has two to six options, on the lines below it", help);
                }
                open = Some(place.clone());
            }
            LessonStep::Predict { .. } => open = Some(place.clone()),
            LessonStep::Outcome => {
                if open.take().is_none() {
                    wrong(
                        place,
                        "no question waits for its outcome",
                        "ask one above, or leave it out",
                    );
                }
            }
            LessonStep::Option { .. } => {
                let fits = matches!(
                    above,
                    Some(ScriptStep::Lesson(LessonStep::Ask(_) | LessonStep::Option { .. }))
                );
                if !fits {
                    wrong(place, "this option belongs to no question", "put it below its `Ask`");
                }
            }
            LessonStep::Task { .. } => {
                let below = script.steps.get(index + 1).map(|(_, step)| step);
                if !matches!(below, Some(ScriptStep::Lesson(LessonStep::Solution(_)))) {
                    let help = "put `Solution KEY …` below it";
                    wrong(place, "nothing shows that this task can be done", help);
                }
            }
            LessonStep::Solution(_) => {
                if !matches!(above, Some(ScriptStep::Lesson(LessonStep::Task { .. }))) {
                    wrong(place, "this solution belongs to no task", "put it below its `Task`");
                }
            }
            LessonStep::Say(_) | LessonStep::Free(_) => {}
        }
    }
    if let Some(first) = open {
        wrong(&first, no_outcome, "put `Outcome` where it has been seen");
    }
    if !script.steps.iter().any(|(_, step)| matches!(step, ScriptStep::Lesson(_))) {
        wrong(
            &(0..0),
            "this is a demo, not a lesson: nothing is asked",
            "say something with `Say`",
        );
    }
    for ((place, _), texts) in spoken(script) {
        let rows = rows(&texts, 80);
        if rows > MOST_ROWS {
            let message = format!(
                "this takes {} rows on a screen of 80 columns; there are {}",
                rows - 2,
                MOST_ROWS - 2
            );
            wrong(place, &message, "say it in fewer words, or in two steps");
        }
    }
    diagnostics
}

/// The paragraphs of each step that speaks, as long as they can become.
pub(super) fn steps_of_person(script: &Script) -> impl Iterator<Item = Vec<Paragraph>> {
    spoken(script).map(|(_, texts)| texts)
}

fn spoken(script: &Script) -> impl Iterator<Item = (&(SourceRange, ScriptStep), Vec<Paragraph>)> {
    let text = |text: &str| Paragraph { kind: ParagraphKind::Text, text: text.to_owned() };
    script.steps.iter().enumerate().filter_map(move |(index, line)| {
        let ScriptStep::Lesson(step) = &line.1 else { return None };
        let texts = match step {
            LessonStep::Say(texts) | LessonStep::Free(texts) => vec![text(texts)],
            LessonStep::Predict { text: asked, .. } => vec![text(asked), text("1"), text("wrong")],
            LessonStep::Task { text: asked, hint, .. } => {
                let found = text("Done: the number that was found, with all of its digits.");
                [Some(text(asked)), hint.as_deref().map(text), Some(found)]
                    .into_iter()
                    .flatten()
                    .collect()
            }
            LessonStep::Ask(asked) => {
                let below = script.steps[index + 1..].iter();
                let options = below.map_while(|(_, step)| match step {
                    ScriptStep::Lesson(LessonStep::Option { text, .. }) => Some(format!("a) {text}")),
                    _ => None,
                });
                let mut texts = vec![text(asked)];
                texts.extend(options.map(|option| text(&option)));
                texts
            }
            // what is said of it once it was chosen wrongly, with the right one of the same length
            LessonStep::Option { text: option, why, .. } => vec![
                text(&format!("Wrong: a) {option}. {}", why.as_deref().unwrap_or_default())),
                text(&format!("The answer is a) {option}")),
                text("Measured: the number that was found, with all of its digits, and what it is near to."),
            ],
            LessonStep::Outcome | LessonStep::Solution(_) => return None,
        };
        Some((line, texts))
    })
}
