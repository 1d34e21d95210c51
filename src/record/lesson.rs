//! A lesson: a script with a person in it, who predicts before the outcome is shown.
//!
//! In: a [`Script`] with lines of a lesson, keys, time. Out: the screen, and how each question was answered. What is
//! right is decided by the claims of the script at the moment of the outcome, never by the script itself. Between
//! questions time passes as in a demo; while the lesson speaks it stands still, so that whoever reads long sees the
//! same as whoever reads fast. Never here: a clock, a terminal, a file.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};

use super::assertion::{self, Finding};
use super::clock::Micros;
use super::headless_lab::Budget;
use super::lesson_order::{mistakes_in, steps_of_person};
use super::recording::rows;
use super::script::{Assert, LessonStep, Script, Step, Text};
use super::script_runner::{RunnerEvent, ScriptRunner};
use crate::app::Event;
use crate::diagnostic::{Diagnostic, Document, SourceRange};
use crate::num::significant;
use crate::view::RenderStyle;
use crate::view::lesson::{self, Paragraph, ParagraphKind, Speech};

/// A lesson being taken.
pub struct Lesson {
    pub(super) runner: ScriptRunner,
    title: String,
    pub(super) stage: Stage,
    /// The question whose outcome is not known yet.
    pub(super) question: Option<Question>,
    /// The answers so far, those of earlier visits not included.
    pub(super) verdicts: Vec<Verdict>,
    /// Claims (`Assert`) that were found false; looked for only where nobody watches.
    pub(super) false_claims: Vec<Diagnostic>,
    /// What was said last.
    said: Vec<Paragraph>,
    /// The time that may have passed, of the clock of the lab.
    time: Micros,
    /// The step from which a later visit may go on.
    safe: usize,
    unattended: bool,
}

/// What a lesson is doing.
pub(super) enum Stage {
    /// Time passes.
    Playing,
    /// It waits to be read.
    Said,
    /// It waits for an option to be chosen.
    Choosing(usize),
    /// It waits for a number, with what is wrong with the last.
    Typing(String, Option<String>),
    /// The lab is the person's until a claim holds.
    Task { place: SourceRange, hint: Option<String>, claim: Assert, hinted: bool },
    /// The lab is the person's until a key.
    Free,
    /// It is over.
    Ended,
}

/// A question.
#[derive(Clone, Debug)]
pub(super) struct Question {
    pub(super) place: SourceRange,
    pub(super) text: String,
    pub(super) kind: QuestionKind,
}

#[derive(Clone, Debug)]
pub(super) enum QuestionKind {
    Choice { options: Vec<Choice>, chosen: Option<usize> },
    Number { value: Text, within: Text, said: Option<f64> },
}

#[derive(Clone, Debug)]
pub(super) struct Choice {
    pub(super) place: SourceRange,
    pub(super) text: String,
    pub(super) why: Option<String>,
    pub(super) claim: Assert,
}

/// How a question was answered.
#[derive(Clone, Debug)]
pub(super) struct Verdict {
    pub(super) question: Question,
    pub(super) right: bool,
    /// Which options are right, or the number and how far a prediction may be off.
    pub(super) truth: Truth,
}

#[derive(Clone, Debug)]
pub(super) enum Truth {
    Options(Vec<bool>),
    Value(f64, f64),
}

/// What a key did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pressed {
    /// The lesson goes on.
    Taken,
    /// The person leaves.
    Leave,
}

fn paragraph(kind: ParagraphKind, text: impl Into<String>) -> Paragraph {
    Paragraph { kind, text: text.into() }
}

impl Lesson {
    /// Begins a lesson for a person.
    ///
    /// # Errors
    /// Returns the mistakes of the script, or that its system cannot be opened.
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
        let mistakes = mistakes_in(&script);
        if !mistakes.is_empty() {
            return Err(mistakes);
        }
        let title = script.head.title.clone().unwrap_or_else(|| called.to_owned());
        let size = Size::new(80, 24);
        let runner = ScriptRunner::new(script, document, called, size, budget);
        Ok(Lesson {
            runner: runner.map_err(|mistake| vec![mistake])?,
            title,
            stage: Stage::Playing,
            question: None,
            verdicts: Vec::new(),
            false_claims: Vec::new(),
            said: Vec::new(),
            time: 0,
            safe: 0,
            unattended: budget.is_unattended(),
        })
    }

    /// Goes on to a place where an earlier visit ended, without waiting for anybody on the way.
    ///
    /// # Errors
    /// Returns a mistake of the script that only its system reveals.
    pub fn resume(&mut self, place: usize) -> Result<(), Diagnostic> {
        while self.runner.next < place && !matches!(self.stage, Stage::Ended) {
            match self.runner.beat()? {
                RunnerEvent::Lesson(_, LessonStep::Task { .. } | LessonStep::Free(_)) => {
                    self.begin_anew();
                }
                RunnerEvent::Overlay => self.stage = Stage::Ended,
                _ => {}
            }
        }
        self.time = self.runner.now();
        self.safe = self.runner.next;
        Ok(())
    }

    /// The place from which a later visit may go on.
    pub fn place(&self) -> usize {
        self.safe
    }

    /// Whether the lesson was taken to its end.
    pub fn is_finished(&self) -> bool {
        matches!(self.stage, Stage::Ended)
    }

    /// How many questions were answered rightly, and how many were answered.
    pub fn score(&self) -> (usize, usize) {
        (self.verdicts.iter().filter(|verdict| verdict.right).count(), self.verdicts.len())
    }

    /// Whether text or a number is being typed.
    pub fn is_typing(&self) -> bool {
        match self.stage {
            Stage::Typing(..) => true,
            Stage::Task { .. } | Stage::Free => self.runner.lab.app.is_typing(),
            _ => false,
        }
    }

    /// Whether time passes.
    pub fn is_moving(&self) -> bool {
        matches!(self.stage, Stage::Playing | Stage::Task { .. } | Stage::Free)
    }

    /// Lets time pass. Returns whether anything visible has changed.
    ///
    /// # Errors
    /// Returns a mistake of the script that only its system reveals.
    pub fn advance(&mut self, elapsed: Micros) -> Result<bool, Diagnostic> {
        match self.stage {
            Stage::Playing => {
                self.time += elapsed;
                let before = self.runner.now();
                while matches!(self.stage, Stage::Playing)
                    && (self.runner.lab.clock.left() == 0
                        || self.runner.lab.clock.next() <= self.time)
                {
                    self.beat()?;
                }
                Ok(before != self.runner.now() || !matches!(self.stage, Stage::Playing))
            }
            Stage::Task { .. } | Stage::Free => {
                self.runner.lab.clock.pass(elapsed);
                let before = self.runner.now();
                while self.runner.lab.clock.left() > 0 {
                    self.runner.frame();
                }
                self.look_at_task();
                Ok(before != self.runner.now() || !self.is_moving())
            }
            _ => Ok(false),
        }
    }

    /// Performs the next action of the script.
    pub(super) fn beat(&mut self) -> Result<(), Diagnostic> {
        match self.runner.beat()? {
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
        let waits = !self.is_moving() && !matches!(self.stage, Stage::Ended);
        self.runner.hold(waits);
        Ok(())
    }

    fn find(&self, claim: &Assert) -> Result<Finding, Diagnostic> {
        let screen = match claim {
            Assert::Screen(_) => rows(&self.runner.picture(&self.runner.script.head.look())),
            _ => Vec::new(),
        };
        self.runner.find(claim, &screen)
    }

    fn take(&mut self, place: SourceRange, step: LessonStep) -> Result<(), Diagnostic> {
        if self.question.is_none() {
            // the step itself is to be seen again
            self.safe = self.runner.next - 1;
        }
        match step {
            LessonStep::Say(text) => {
                self.said = vec![paragraph(ParagraphKind::Text, text)];
                self.stage = Stage::Said;
            }
            LessonStep::Ask(text) => {
                let options = self.options();
                self.runner.next += options.len();
                let kind = QuestionKind::Choice { options, chosen: None };
                self.question = Some(Question { place, text, kind });
                self.stage = Stage::Choosing(0);
            }
            LessonStep::Predict { text, value, within } => {
                let kind = QuestionKind::Number { value, within, said: None };
                self.question = Some(Question { place, text, kind });
                self.stage = Stage::Typing(String::new(), None);
            }
            LessonStep::Outcome => {
                self.judge()?;
                self.safe = self.runner.next;
            }
            LessonStep::Task { text, hint, claim } => {
                self.said = vec![paragraph(ParagraphKind::Text, text)];
                self.stage = Stage::Task { place, hint, claim, hinted: false };
            }
            LessonStep::Free(text) => {
                self.said = vec![paragraph(ParagraphKind::Text, text)];
                self.stage = Stage::Free;
            }
            // read with the question or the task above
            LessonStep::Option { .. } | LessonStep::Solution(_) => {}
        }
        Ok(())
    }

    /// The options below the question that was just read.
    fn options(&self) -> Vec<Choice> {
        let below = self.runner.script.steps[self.runner.next..].iter();
        let options = below.map_while(|(place, step)| match step {
            Step::Lesson(LessonStep::Option { text, why, claim }) => Some(Choice {
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
        let (mut said, right, truth);
        match &question.kind {
            QuestionKind::Choice { options, chosen } => {
                let findings: Vec<Finding> = options
                    .iter()
                    .map(|option| self.find(&option.claim))
                    .collect::<Result<_, _>>()?;
                let holds: Vec<bool> = findings.iter().map(|finding| finding.holds).collect();
                let chosen = chosen.unwrap_or(0);
                right = holds[chosen];
                let own = letter(chosen, &options[chosen].text);
                said = vec![match (right, &options[chosen].why) {
                    (true, _) => paragraph(ParagraphKind::Right, format!("Right: {own}")),
                    (false, None) => paragraph(ParagraphKind::Wrong, format!("Not so: {own}")),
                    (false, Some(why)) => {
                        paragraph(ParagraphKind::Wrong, format!("Not so: {own} {why}"))
                    }
                }];
                if let (false, Some(other)) = (right, holds.iter().position(|holds| *holds)) {
                    let other = letter(other, &options[other].text);
                    said.push(paragraph(ParagraphKind::Text, format!("It is {other}")));
                }
                if let Some(at) = holds.iter().position(|holds| *holds) {
                    let found = format!("Found: {}.", findings[at].sentence);
                    said.push(paragraph(ParagraphKind::Quiet, found));
                }
                truth = Truth::Options(holds);
            }
            QuestionKind::Number { value, within, said: number } => {
                let app = &self.runner.lab.app;
                let (value, within) =
                    (assertion::value(app, value)?, assertion::value(app, within)?);
                let number = number.unwrap_or(f64::NAN);
                right = (number - value).abs() <= within;
                let (kind, word) = match right {
                    true => (ParagraphKind::Right, "Right"),
                    false => (ParagraphKind::Wrong, "Not so"),
                };
                let (number, found) = (short(number), short(value));
                let near = short(within);
                let text =
                    format!("{word}: you predicted {number}, it is {found} (right within {near}).");
                said = vec![paragraph(kind, text)];
                truth = Truth::Value(value, within);
            }
        }
        self.said = said;
        self.verdicts.push(Verdict { question, right, truth });
        self.stage = Stage::Said;
        Ok(())
    }

    /// Ends a task whose claim holds.
    pub(super) fn look_at_task(&mut self) {
        let Stage::Task { claim, .. } = &self.stage else { return };
        // in another system, or before anything has happened, a claim need not have a meaning: it does not hold
        let Ok(finding) = self.find(claim) else { return };
        if finding.holds {
            let found = format!("Done: {}.", finding.sentence);
            self.said.push(paragraph(ParagraphKind::Right, found));
            self.begin_anew_later();
        }
    }

    fn begin_anew_later(&mut self) {
        self.runner.hold(true);
        self.stage = Stage::Said;
    }

    /// Opens the system again as its file says, so that what follows does not depend on what the person did.
    fn begin_anew(&mut self) {
        self.runner.lab = self.runner.lab.anew(self.runner.script.head.fps);
        self.runner.keys.clear();
        self.time = 0;
    }

    fn end(&mut self) {
        let (right, all) = self.score();
        let text = match all {
            0 => "This is the end of the lesson.".to_owned(),
            _ => format!("This is the end of the lesson: {right} of {all} predictions were right."),
        };
        self.said = vec![paragraph(ParagraphKind::Text, text)];
        self.stage = Stage::Ended;
    }

    /// Goes on from what was said.
    pub(super) fn go_on(&mut self) {
        let last = self.runner.next.checked_sub(1).and_then(|at| self.runner.script.steps.get(at));
        let personal = |step: &Step| {
            matches!(step, Step::Lesson(LessonStep::Task { .. } | LessonStep::Free(_)))
        };
        if last.is_some_and(|(_, step)| personal(step)) {
            self.begin_anew();
        }
        self.runner.hold(false);
        self.stage = Stage::Playing;
    }

    /// Commits an answer to the question: an option, or a number.
    pub(super) fn commit(&mut self, option: usize, number: f64) {
        match self.question.as_mut().map(|question| &mut question.kind) {
            Some(QuestionKind::Choice { chosen, options }) => {
                *chosen = Some(option.min(options.len().saturating_sub(1)));
            }
            Some(QuestionKind::Number { said, .. }) => *said = Some(number),
            None => {}
        }
        self.said.clear();
        self.go_on();
    }

    /// Handles a key.
    pub fn press(&mut self, key: KeyEvent) -> Pressed {
        let held = key.modifiers.contains(KeyModifiers::CONTROL);
        let typing = self.is_typing() && !matches!(self.stage, Stage::Typing(..));
        let covered = self.runner.lab.app.overlay.is_some()
            && matches!(self.stage, Stage::Task { .. } | Stage::Free);
        match key.code {
            KeyCode::Char('c') if held => return Pressed::Leave,
            KeyCode::Char('q') if !held && !typing => return Pressed::Leave,
            KeyCode::Esc if !covered => return Pressed::Leave,
            _ => {}
        }
        let goes_on = matches!(key.code, KeyCode::Enter | KeyCode::Char(' ') | KeyCode::F(9));
        match &mut self.stage {
            Stage::Playing => {}
            Stage::Said if goes_on => self.go_on(),
            Stage::Said => {}
            Stage::Ended if goes_on => return Pressed::Leave,
            Stage::Ended => {}
            Stage::Choosing(selected) => {
                let Some(QuestionKind::Choice { options, .. }) =
                    self.question.as_ref().map(|question| &question.kind)
                else {
                    return Pressed::Taken;
                };
                let last = options.len().saturating_sub(1);
                match key.code {
                    KeyCode::Up => *selected = selected.saturating_sub(1),
                    KeyCode::Down => *selected = (*selected + 1).min(last),
                    KeyCode::Char(c @ 'a'..='i') if (c as usize - 'a' as usize) <= last => {
                        *selected = c as usize - 'a' as usize;
                    }
                    KeyCode::Enter => {
                        let chosen = *selected;
                        self.commit(chosen, f64::NAN);
                    }
                    _ => {}
                }
            }
            Stage::Typing(text, wrong) => match key.code {
                KeyCode::Char(c) if !held && text.chars().count() < LONGEST_NUMBER => {
                    text.push(c);
                    *wrong = None;
                }
                KeyCode::Backspace => {
                    text.pop();
                    *wrong = None;
                }
                KeyCode::Enter => match number(text) {
                    Some(number) => self.commit(0, number),
                    None => *wrong = Some("This is not a number; write it as 1.5 or 3/2.".into()),
                },
                _ => {}
            },
            Stage::Free if key.code == KeyCode::F(9) => self.go_on(),
            Stage::Task { hinted, hint, .. } if key.code == KeyCode::F(9) => {
                match hint.take().filter(|_| !*hinted) {
                    Some(hint) => {
                        *hinted = true;
                        self.said.push(paragraph(ParagraphKind::Quiet, hint));
                    }
                    None => self.go_on(),
                }
            }
            Stage::Task { .. } | Stage::Free => {
                self.runner.lab.happen(Event::Key(key));
                self.look_at_task();
            }
        }
        Pressed::Taken
    }

    /// Draws the lab, and below it what the lesson says.
    pub fn draw(&mut self, style: &RenderStyle, area: Rect, buffer: &mut Buffer) {
        let rows = self.pane_rows(area);
        let above = Rect { height: area.height - rows, ..area };
        self.runner.draw(style, above, buffer);
        let below = Rect { y: above.bottom(), height: rows, ..area };
        lesson::draw(style, &self.speech(), below, buffer);
    }

    /// The rows of the pane, the same throughout, so that the picture keeps its place.
    fn pane_rows(&self, area: Rect) -> u16 {
        let steps = self.runner.script.steps.iter();
        let texts =
            steps_of_person(&self.runner.script).map(|said| lesson::rows(&said, area.width));
        let least = if steps.len() == 0 { 0 } else { LEAST_ROWS };
        texts.max().unwrap_or(0).max(least).min((area.height / 2).max(LEAST_ROWS)).min(area.height)
    }

    /// What the lesson says now.
    pub fn speech(&self) -> Speech {
        let mut said = self.said.clone();
        let keys = match &self.stage {
            Stage::Playing => match &self.question {
                Some(question) => {
                    said = vec![paragraph(ParagraphKind::Text, question.text.clone())];
                    said.push(paragraph(ParagraphKind::Quiet, question.answer()));
                    "watch what happens · q leaves"
                }
                None => "watch · q leaves",
            },
            Stage::Said => "Enter goes on · q leaves",
            Stage::Ended => "Enter leaves",
            Stage::Free => "the lab is yours · F9 goes on · q leaves",
            Stage::Task { hint, .. } => match hint {
                Some(_) => "the lab is yours · F9 hint · q leaves",
                None => "the lab is yours · F9 skips this · q leaves",
            },
            Stage::Choosing(selected) => {
                said =
                    self.question.as_ref().map_or(Vec::new(), |question| question.asked(*selected));
                "↑ ↓ choose · Enter commits · q leaves"
            }
            Stage::Typing(text, wrong) => {
                let question = self.question.as_ref().map(|question| question.text.clone());
                said = vec![paragraph(ParagraphKind::Text, question.unwrap_or_default())];
                said.push(paragraph(ParagraphKind::Selected, format!("{text}_")));
                said.extend(wrong.iter().map(|why| paragraph(ParagraphKind::Wrong, why.clone())));
                "type a number · Enter commits · q leaves"
            }
        };
        let all = self.runner.script.steps.len();
        let place = format!("{} %", 100 * self.runner.next.min(all) / all.max(1));
        Speech { title: self.title.clone(), place, paragraphs: said, keys: keys.to_owned() }
    }
}

impl Question {
    /// The question with its options.
    pub(super) fn asked(&self, selected: usize) -> Vec<Paragraph> {
        let mut said = vec![paragraph(ParagraphKind::Text, self.text.clone())];
        if let QuestionKind::Choice { options, .. } = &self.kind {
            said.extend(options.iter().enumerate().map(|(index, option)| {
                let chosen = index == selected;
                let kind = if chosen { ParagraphKind::Selected } else { ParagraphKind::Option };
                paragraph(kind, letter(index, &option.text))
            }));
        }
        said
    }

    /// The committed answer.
    fn answer(&self) -> String {
        match &self.kind {
            QuestionKind::Choice { options, chosen: Some(chosen) } => {
                format!("Your answer: {}", letter(*chosen, &options[*chosen].text))
            }
            QuestionKind::Number { said: Some(number), .. } => {
                format!("Your prediction: {}", short(*number))
            }
            _ => String::new(),
        }
    }
}

/// The most characters of a number that is typed.
const LONGEST_NUMBER: usize = 24;

/// The least rows of the pane, with its frame.
const LEAST_ROWS: u16 = 5;

/// A number as a person types it: `1.5`, `-2e-3`, `3/2`.
fn number(text: &str) -> Option<f64> {
    let text = text.trim().replace('−', "-");
    let one = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
    match text.split_once('/') {
        Some((above, below)) => Some(one(above)? / one(below)?).filter(|number| number.is_finite()),
        None => one(&text),
    }
}

/// An option with its letter.
pub(super) fn letter(index: usize, text: &str) -> String {
    let letter = char::from(b'a' + (index.min(25) as u8));
    format!("{letter}) {text}")
}

/// A number with four digits, for display only.
fn short(x: f64) -> String {
    significant(x, 4, 1e-3..1e6)
}
