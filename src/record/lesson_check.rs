//! A lesson taken by nobody: with the right answer and with every wrong answer.
//!
//! In: a [`Script`] and its system. Out: every claim of the lesson that is false, in its place. Never here: a person.

use super::headless_lab::Budget;
use super::lesson::{Lesson, LessonStage};
use super::lesson_question::{AnswerVerdict, GivenAnswer, Question, QuestionKind, Truth};
use super::script::{LessonStep, Script, ScriptStep};
use crate::app::AppEvent;
use crate::diagnostic::{Diagnostic, Document};

/// What was found in a lesson without errors.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LessonReport {
    /// The number of questions.
    pub questions: usize,
    /// The number of answers that were given and called wrong.
    pub wrong: usize,
    /// The number of tasks.
    pub tasks: usize,
}

/// How long the keys of a solution may take to fulfil a task, in microseconds.
const TIME_LIMIT: u64 = 60_000_000;

/// Takes a lesson with the right answers, and then with every wrong one.
///
/// # Errors
/// Returns every claim of the lesson that is false.
pub fn check_lesson(
    script: &Script,
    document: &Document,
    called: &str,
) -> Result<LessonReport, Vec<Diagnostic>> {
    let pass = |answer: &dyn Fn(usize, &Question) -> GivenAnswer| {
        let mut lesson = Lesson::new(script.clone(), document, called, Budget::RECORDED)?;
        let tasks = take(&mut lesson, answer)?;
        if lesson.false_claims.is_empty() {
            Ok((lesson.verdicts, tasks))
        } else {
            Err(lesson.false_claims)
        }
    };
    // the truth does not depend on what is answered
    let (truth, tasks) = pass(&|_, question| question.any_answer())?;
    let mut diagnostics: Vec<Diagnostic> = truth.iter().flat_map(question_diagnostics).collect();
    if !diagnostics.is_empty() {
        return Err(diagnostics);
    }
    let (answered, _) = pass(&|index, _| truth[index].right_answer())?;
    for verdict in answered.iter().filter(|verdict| !verdict.right) {
        let message = "the right answer is called wrong";
        diagnostics.push(Diagnostic::error(verdict.question.place.clone(), message));
    }
    let mut wrong = 0;
    let most = truth.iter().map(|verdict| verdict.wrong_answers().len()).max().unwrap_or(0);
    for round in 0..most {
        let choose = |index: usize| {
            let wrong = truth[index].wrong_answers();
            wrong.get(round).or(wrong.last()).cloned().unwrap_or(GivenAnswer::Option(0))
        };
        let (answered, _) = pass(&|index, _| choose(index))?;
        for (verdict, before) in answered.iter().zip(&truth) {
            wrong += usize::from(round < before.wrong_answers().len());
            if verdict.right {
                let message = "a wrong answer is called right";
                diagnostics.push(Diagnostic::error(verdict.question.place.clone(), message));
            }
        }
    }
    let questions = truth.len();
    if diagnostics.is_empty() {
        Ok(LessonReport { questions, wrong, tasks })
    } else {
        Err(diagnostics)
    }
}

/// Takes a lesson to its end; returns the number of tasks.
fn take(
    lesson: &mut Lesson,
    answer: &dyn Fn(usize, &Question) -> GivenAnswer,
) -> Result<usize, Vec<Diagnostic>> {
    let mut tasks = 0;
    loop {
        match &lesson.stage {
            LessonStage::Playing => lesson.next_event().map_err(|diagnostic| vec![diagnostic])?,
            LessonStage::Reading | LessonStage::Free => lesson.proceed(),
            LessonStage::Choosing(_) | LessonStage::Typing(..) | LessonStage::Pointing(_) => {
                let index = lesson.verdicts.len();
                let answer = lesson.question.as_ref().map(|question| answer(index, question));
                lesson.commit(answer.unwrap_or(GivenAnswer::Option(0)));
            }
            LessonStage::Task { .. } => {
                solve(lesson).map_err(|diagnostic| vec![diagnostic])?;
                tasks += 1;
            }
            LessonStage::Ended => return Ok(tasks),
        }
    }
}

/// Presses the keys of the solution.
fn solve(lesson: &mut Lesson) -> Result<(), Diagnostic> {
    let LessonStage::Task { place, claim, .. } = &lesson.stage else { return Ok(()) };
    let (place, claim) = (place.clone(), claim.clone());
    // an unknown name must not pass for a claim that does not hold yet
    if lesson.runner.find(&claim, &[])?.holds {
        let message = "this task is done before it begins";
        return Err(Diagnostic::error(place, message));
    }
    let below = lesson.runner.script.steps.get(lesson.runner.next).map(|(_, step)| step.clone());
    let Some(ScriptStep::Lesson(LessonStep::Solution(keys))) = below else { return Ok(()) };
    for key in keys {
        lesson.runner.lab.update(AppEvent::Key(key));
        lesson.advance(100_000)?;
    }
    let mut passed = 0;
    while matches!(lesson.stage, LessonStage::Task { .. }) && passed < TIME_LIMIT {
        lesson.advance(100_000)?;
        passed += 100_000;
    }
    if !matches!(lesson.stage, LessonStage::Task { .. }) {
        return Ok(());
    }
    let found = lesson.runner.find(&claim, &[])?.sentence;
    let message = format!("the solution does not do this: {found}");
    Err(Diagnostic::error(place, message))
}

/// What is wrong with a question, once its outcome is known.
fn question_diagnostics(verdict: &AnswerVerdict) -> Vec<Diagnostic> {
    let question = &verdict.question;
    let mut diagnostics = Vec::new();
    match (&question.kind, &verdict.truth) {
        (QuestionKind::Choice { options, .. }, Truth::Options(holds)) => {
            let right = holds.iter().filter(|holds| **holds).count();
            if right != 1 {
                let message = match right {
                    0 => "none of the options is right: every claim is false".to_owned(),
                    _ => format!("{right} of the options are right: their claims hold together"),
                };
                diagnostics.push(Diagnostic::error(question.place.clone(), message));
            }
            for (option, holds) in options.iter().zip(holds) {
                if !holds && option.why.is_none() {
                    let message = "this option is wrong and does not say why";
                    let help = "add why \"TEXT\" before `if`";
                    diagnostics
                        .push(Diagnostic::error(option.place.clone(), message).with_help(help));
                }
            }
        }
        (QuestionKind::Number { within, .. }, Truth::Value(_, near)) if *near <= 0.0 => {
            let message = format!("nobody predicts a number exactly; this is within {near}");
            diagnostics.push(Diagnostic::error(within.place.clone(), message));
        }
        _ => {}
    }
    diagnostics
}

/// The number of points through which the right curve is drawn, as a person would set them.
const POINTS: usize = 12;

impl Question {
    /// An answer, be it right or wrong.
    fn any_answer(&self) -> GivenAnswer {
        match &self.kind {
            QuestionKind::Choice { .. } => GivenAnswer::Option(0),
            QuestionKind::Number { .. } => GivenAnswer::Number(0.0),
            QuestionKind::Place { .. } => GivenAnswer::Points(Vec::new()),
        }
    }
}

impl AnswerVerdict {
    fn right_answer(&self) -> GivenAnswer {
        match &self.truth {
            Truth::Options(holds) => {
                GivenAnswer::Option(holds.iter().position(|holds| *holds).unwrap_or(0))
            }
            Truth::Value(value, _) => GivenAnswer::Number(*value),
            Truth::Place(found) => GivenAnswer::Points(match &self.question.kind {
                QuestionKind::Place { prediction, .. } => prediction.spread(found, POINTS),
                _ => found.clone(),
            }),
        }
    }

    fn wrong_answers(&self) -> Vec<GivenAnswer> {
        match (&self.truth, self.right_answer()) {
            (Truth::Options(holds), _) => {
                let wrong = holds.iter().enumerate().filter(|(_, holds)| !**holds);
                wrong.map(|(index, _)| GivenAnswer::Option(index)).collect()
            }
            (Truth::Value(value, near), _) => {
                vec![
                    GivenAnswer::Number(value - 2.0 * near),
                    GivenAnswer::Number(value + 2.0 * near),
                ]
            }
            // a curve that is moved is as far from where it was as it was moved: its farthest point in that direction is
            (Truth::Place(_), GivenAnswer::Points(points)) => {
                let QuestionKind::Place { prediction, .. } = &self.question.kind else {
                    return Vec::new();
                };
                let within = prediction.axes.map(|axis| axis.within);
                let moves = [[2.0, 0.0], [-2.0, 0.0], [0.0, 2.0], [0.0, -2.0]];
                let moved = moves.map(|by| {
                    let place = |at: &[f64; 2]| [0, 1].map(|k| at[k] + by[k] * within[k]);
                    GivenAnswer::Points(points.iter().map(place).collect())
                });
                moved.into()
            }
            (Truth::Place(_), _) => Vec::new(),
        }
    }
}
