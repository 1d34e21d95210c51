//! A lesson: a script with a person in it, who predicts before the outcome is shown.
//!
//! In: a [`Script`] with lines of a lesson, answers, time. Out: how each question was answered. What is
//! right is decided by the claims of the script at the moment of the outcome, never by the script itself. Between
//! questions time passes as in a demo; while the lesson speaks it stands still, so that whoever reads long sees the
//! same as whoever reads fast. Never here: keys (`lesson_keys`), the pane
//! (`lesson_speech`), a terminal, a file.

use std::time::Duration;

use ratatui::layout::Size;

use super::assertion::AssertionResult;
use super::clock::Micros;
use super::headless_lab::Budget;
use super::lesson_finding::in_words;
use super::lesson_order::errors_in;
use super::lesson_question::{AnswerChoice, AnswerVerdict, GivenAnswer, Question, QuestionKind};
use super::lesson_view::LessonView;
use super::recording::rows;
use super::script::{Asked, Assert, LessonStep, Script, ScriptStep};
use super::script_runner::{RunnerEvent, ScriptRunner};
use crate::app::{KeyHints, Page};
use crate::diagnostic::{Diagnostic, Document, SourceRange};
use crate::view::lesson::{Paragraph, ParagraphKind};

/// A lesson being taken.
pub struct Lesson {
    pub(super) runner: ScriptRunner,
    pub(super) title: String,
    pub(super) stage: LessonStage,
    /// The question whose outcome is not known yet.
    pub(super) question: Option<Question>,
    /// The answers so far, those of earlier visits not included.
    pub(super) verdicts: Vec<AnswerVerdict>,
    /// Claims (`Assert`) that were found false; searched for only where nobody watches.
    pub(super) false_claims: Vec<Diagnostic>,
    /// What was said last.
    pub(super) spoken: Vec<Paragraph>,
    /// The time that may have passed, of the clock of the lab.
    time: Micros,
    /// The step from which a later visit may continue.
    safe: usize,
    /// Whether the lab is still as the person left it after a task.
    pub(super) personal: bool,
    /// What was seen before somebody looked around.
    pub(super) view: Option<LessonView>,
    /// What is said of a key that does nothing.
    pub(super) notice: Option<String>,
    unattended: bool,
}

pub(super) enum LessonStage {
    /// Time passes.
    Playing,
    /// It waits to be read.
    Reading,
    /// It waits for an option to be chosen.
    Choosing(usize),
    /// It waits for a number, with what is wrong with the last.
    Typing(String, Option<String>),
    /// It waits for a point or a curve on a plot, with what is wrong with the last.
    Pointing(Option<String>),
    /// The lab is the person's until a claim holds.
    Task { place: SourceRange, hint: Option<String>, claim: Assert, hinted: bool },
    /// The lab is the person's until a key.
    Free,
    /// It is over.
    Ended,
}

pub(super) fn paragraph(kind: ParagraphKind, text: impl Into<String>) -> Paragraph {
    Paragraph { kind, text: text.into() }
}

impl Lesson {
    /// Begins a lesson for a person.
    ///
    /// # Errors
    /// Returns the errors of the script, or that its system cannot be opened.
    pub fn watched(
        script: Script,
        document: &Document,
        called: &str,
    ) -> Result<Lesson, Vec<Diagnostic>> {
        Lesson::new(script, document, called, Budget::WATCHED)
    }

    pub(super) fn new(
        script: Script,
        document: &Document,
        called: &str,
        budget: Budget,
    ) -> Result<Lesson, Vec<Diagnostic>> {
        let diagnostics = errors_in(&script);
        if !diagnostics.is_empty() {
            return Err(diagnostics);
        }
        let title = script.head.title.clone().unwrap_or_else(|| called.to_owned());
        let size = Size::new(80, 24);
        let runner = ScriptRunner::new(script, document, called, size, budget);
        Ok(Lesson {
            runner: runner.map_err(|diagnostic| vec![diagnostic])?,
            title,
            stage: LessonStage::Playing,
            question: None,
            verdicts: Vec::new(),
            false_claims: Vec::new(),
            spoken: Vec::new(),
            time: 0,
            safe: 0,
            personal: false,
            view: None,
            notice: None,
            unattended: budget.is_unattended(),
        })
    }

    /// Continues to a place where an earlier visit ended, without waiting for anybody on the way.
    ///
    /// # Errors
    /// Returns an error of the script that only its system reveals.
    pub fn resume(&mut self, place: usize) -> Result<(), Diagnostic> {
        while self.runner.next < place && !matches!(self.stage, LessonStage::Ended) {
            match self.runner.next_event()? {
                RunnerEvent::Lesson(_, LessonStep::Task { .. } | LessonStep::Free(_)) => {
                    self.begin_anew();
                }
                RunnerEvent::Overlay => self.enter(LessonStage::Ended),
                _ => {}
            }
        }
        self.time = self.runner.now();
        self.safe = self.runner.next;
        Ok(())
    }

    /// The place from which a later visit may continue.
    pub fn place(&self) -> usize {
        self.safe
    }

    /// Whether the lesson was taken to its end.
    pub fn is_finished(&self) -> bool {
        matches!(self.stage, LessonStage::Ended)
    }

    /// How many questions were answered rightly, and how many were answered.
    pub fn score(&self) -> (usize, usize) {
        (self.verdicts.iter().filter(|verdict| verdict.right).count(), self.verdicts.len())
    }

    /// Whether text or a number is being typed.
    pub fn is_typing(&self) -> bool {
        match self.stage {
            LessonStage::Typing(..) => true,
            LessonStage::Task { .. } | LessonStage::Free => self.runner.lab.app.is_typing(),
            _ => false,
        }
    }

    /// Whether the lab is the person's.
    pub(super) fn has_lab(&self) -> bool {
        matches!(self.stage, LessonStage::Task { .. } | LessonStage::Free)
    }

    /// Gives the lab's keys to the person, or takes them for the lesson.
    pub(super) fn share_keys(&mut self) {
        self.runner.lab.app.footer.hints = match self.stage {
            _ if self.has_lab() => KeyHints::LabInLesson,
            LessonStage::Pointing(_) => KeyHints::Cursor,
            _ => KeyHints::Hidden,
        };
    }

    /// Whether the person has left by a key or a click of the lab: it was quit, or exchanged for the list of systems.
    pub fn is_left(&self) -> bool {
        let lab = &self.runner.lab;
        self.has_lab() && (lab.left || lab.app.page == Page::Picker)
    }

    /// Whether time passes.
    pub fn is_moving(&self) -> bool {
        matches!(self.stage, LessonStage::Playing | LessonStage::Task { .. } | LessonStage::Free)
    }

    /// Lets time pass. Returns whether anything visible has changed.
    ///
    /// # Errors
    /// Returns an error of the script that only its system reveals.
    pub fn advance(&mut self, elapsed: Micros) -> Result<bool, Diagnostic> {
        match self.stage {
            LessonStage::Playing => {
                self.time += elapsed;
                let before = self.runner.now();
                while matches!(self.stage, LessonStage::Playing)
                    && (self.runner.lab.clock.left() == 0
                        || self.runner.lab.clock.next() <= self.time)
                {
                    self.next_event()?;
                }
                Ok(before != self.runner.now() || !matches!(self.stage, LessonStage::Playing))
            }
            LessonStage::Task { .. } | LessonStage::Free => {
                self.runner.lab.clock.pass(elapsed);
                let before = self.runner.now();
                while self.runner.lab.clock.left() > 0 {
                    self.runner.frame();
                }
                self.complete_task();
                Ok(before != self.runner.now() || !self.is_moving())
            }
            // What is said of a motion that waits expires all the same.
            _ => Ok(self.runner.lab.app.tick_notifications(Duration::from_micros(elapsed))),
        }
    }

    pub(super) fn next_event(&mut self) -> Result<(), Diagnostic> {
        // what is said of a task is said of what the person did
        let next = self.runner.script.steps.get(self.runner.next).map(|(_, step)| step);
        let is_about_the_task = matches!(
            next,
            None | Some(ScriptStep::Lesson(LessonStep::Say(_) | LessonStep::Solution(_)))
        );
        if self.personal && !is_about_the_task {
            self.begin_anew();
        }
        match self.runner.next_event()? {
            RunnerEvent::Lesson(place, step) => self.take(place, step)?,
            RunnerEvent::Claim(place, claim) if self.unattended => {
                let finding = self.find(&claim)?;
                if !finding.holds {
                    let message = format!("this is false: {}", finding.sentence);
                    self.false_claims.push(Diagnostic::error(place, message));
                }
            }
            RunnerEvent::Overlay => self.end(),
            _ => {}
        }
        if !self.is_moving() {
            self.time = self.runner.now();
        }
        // a motion that began again is observed from its beginning
        let now = self.runner.lab.app.snapshot().map_or(f64::INFINITY, |snapshot| snapshot.time);
        if let Some(QuestionKind::Place { since, .. }) =
            self.question.as_mut().map(|question| &mut question.kind)
        {
            *since = since.min(now);
        }
        self.runner.suspend(!self.is_moving());
        Ok(())
    }

    pub(super) fn find(&self, claim: &Assert) -> Result<AssertionResult, Diagnostic> {
        let screen = match claim {
            Assert::Screen(_) => {
                rows(&self.runner.picture(&self.runner.script.head.render_style()))
            }
            _ => Vec::new(),
        };
        self.runner.find(claim, &screen)
    }

    fn take(&mut self, place: SourceRange, step: LessonStep) -> Result<(), Diagnostic> {
        if self.question.is_none() {
            // the step itself is to be seen again
            self.safe = self.runner.next - 1;
        }
        if asks_anew(&step)
            && let Some(lab) = &mut self.runner.lab.app.lab
        {
            lab.prediction = None;
        }
        match step {
            LessonStep::Say(text) => {
                self.spoken = vec![paragraph(ParagraphKind::Text, text)];
                self.enter(LessonStage::Reading);
            }
            LessonStep::Ask(text) => {
                let options = self.options();
                self.runner.next += options.len();
                let kind = QuestionKind::Choice { options, chosen: None };
                self.question = Some(Question { place, text, kind });
                self.enter(LessonStage::Choosing(0));
            }
            LessonStep::Predict { text, asked: Asked::Value { value, within } } => {
                let kind = QuestionKind::Number { value, within, typed: None };
                self.question = Some(Question { place, text, kind });
                self.enter(LessonStage::Typing(String::new(), None));
            }
            LessonStep::Predict { text, asked: Asked::Place { is_curve, axes } } => {
                let prediction = self.prediction(&place, is_curve, &axes)?;
                let kind = QuestionKind::Place { prediction, since: 0.0 };
                self.question = Some(Question { place, text, kind });
                self.enter(LessonStage::Pointing(None));
            }
            LessonStep::Outcome => {
                self.judge()?;
                self.safe = self.runner.next;
            }
            LessonStep::Task { text, hint, claim } => {
                self.spoken = vec![paragraph(ParagraphKind::Text, text)];
                self.runner.lab.app.show_parameters();
                self.enter(LessonStage::Task { place, hint, claim, hinted: false });
            }
            LessonStep::Free(text) => {
                self.spoken = vec![paragraph(ParagraphKind::Text, text)];
                self.enter(LessonStage::Free);
            }
            // read with the question or the task above
            LessonStep::Option { .. } | LessonStep::Solution(_) => {}
        }
        Ok(())
    }

    /// The options below the question that was just read.
    fn options(&self) -> Vec<AnswerChoice> {
        let below = self.runner.script.steps[self.runner.next..].iter();
        let options = below.map_while(|(place, step)| match step {
            ScriptStep::Lesson(LessonStep::Option { text, why, claim }) => Some(AnswerChoice {
                place: place.clone(),
                text: text.clone(),
                why: why.clone(),
                claim: claim.clone(),
            }),
            _ => None,
        });
        options.collect()
    }

    /// Holds the answer against what the engine says now.
    fn judge(&mut self) -> Result<(), Diagnostic> {
        let Some(question) = self.question.take() else { return Ok(()) };
        let (spoken, verdict) = match &question.kind {
            QuestionKind::Choice { options, chosen } => self.judge_choice(options, *chosen)?,
            QuestionKind::Number { value, within, typed } => {
                self.judge_number(value, within, *typed)?
            }
            QuestionKind::Place { prediction, since } => {
                let (spoken, verdict, outcome) = self.judge_place(prediction, *since);
                let lab = self.runner.lab.app.lab.as_mut();
                if let Some(shown) = lab.and_then(|lab| lab.prediction.as_mut()) {
                    shown.outcome = outcome;
                }
                (spoken, verdict)
            }
        };
        self.spoken = spoken;
        let (right, truth) = verdict;
        self.verdicts.push(AnswerVerdict { question, right, truth });
        self.enter(LessonStage::Reading);
        Ok(())
    }

    /// Ends a task whose claim holds.
    pub(super) fn complete_task(&mut self) {
        let LessonStage::Task { claim, .. } = &self.stage else { return };
        // whoever types has not finished
        if self.runner.lab.app.is_typing() {
            return;
        }
        // in another system, or before anything has happened, a claim need not have a meaning: it does not hold
        let Ok(finding) = self.find(claim) else { return };
        if finding.holds {
            let found = in_words(claim, &self.runner.lab.app);
            let done = found.map_or_else(|| "Done.".to_owned(), |found| format!("Done: {found}."));
            self.spoken.push(paragraph(ParagraphKind::Right, done));
            self.runner.suspend(true);
            self.enter(LessonStage::Reading);
        }
    }

    /// Opens the system again as its file says, so that what follows does not depend on what the person did.
    fn begin_anew(&mut self) {
        self.runner.lab = self.runner.lab.anew(self.runner.script.head.fps);
        self.runner.lab.app.footer.shown = self.runner.script.head.footer;
        self.runner.set_least_ranges();
        self.runner.keys.clear();
        self.time = 0;
        self.personal = false;
    }

    fn end(&mut self) {
        let (right, all) = self.score();
        let text = match all {
            0 => "This is the end.".to_owned(),
            _ => format!("This is the end. Right predictions: {right} of {all}."),
        };
        self.spoken = vec![paragraph(ParagraphKind::Text, text)];
        self.enter(LessonStage::Ended);
    }

    /// Begins a stage. What was said of a key in the one before is no longer true.
    fn enter(&mut self, stage: LessonStage) {
        self.notice = None;
        self.stage = stage;
    }

    /// Continues from what was said.
    pub(super) fn proceed(&mut self) {
        if let Some(view) = self.view.take() {
            view.restore(&mut self.runner.lab);
        }
        let last = self.runner.next.checked_sub(1).and_then(|at| self.runner.script.steps.get(at));
        let personal = |step: &ScriptStep| {
            matches!(step, ScriptStep::Lesson(LessonStep::Task { .. } | LessonStep::Free(_)))
        };
        self.personal |= last.is_some_and(|(_, step)| personal(step));
        self.runner.suspend(false);
        self.enter(LessonStage::Playing);
    }

    pub(super) fn commit(&mut self, answer: GivenAnswer) {
        let app = &mut self.runner.lab.app;
        match (self.question.as_mut().map(|question| &mut question.kind), answer) {
            (Some(QuestionKind::Choice { chosen, options }), GivenAnswer::Option(option)) => {
                *chosen = Some(option.min(options.len().saturating_sub(1)));
            }
            (Some(QuestionKind::Number { typed, .. }), GivenAnswer::Number(number)) => {
                *typed = Some(number);
            }
            (Some(QuestionKind::Place { prediction, since }), GivenAnswer::Points(points)) => {
                prediction.points = points;
                *since = app.snapshot().map_or(0.0, |snapshot| snapshot.time);
                app.end_prediction();
                if let Some(lab) = &mut app.lab {
                    lab.prediction = Some(Box::new(prediction.clone()));
                }
            }
            _ => {}
        }
        self.spoken.clear();
        self.proceed();
    }
}

/// Whether a line asks for something, so that what was predicted before no longer counts.
fn asks_anew(step: &LessonStep) -> bool {
    matches!(
        step,
        LessonStep::Ask(_)
            | LessonStep::Predict { .. }
            | LessonStep::Task { .. }
            | LessonStep::Free(_)
    )
}
