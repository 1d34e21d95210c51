//! The keys of a lesson: to continue, to answer, to leave; in a task all others are the lab's.
//!
//! In: a key. Out: a [`Lesson`] that has continued, or that the person leaves. Never here: what is right.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use super::lesson::{Lesson, LessonStage, paragraph};
use super::lesson_question::{GivenAnswer, QuestionKind};
use super::lesson_view::LessonView;
use crate::app::{AppEvent, key as keys};
use crate::view::lesson::ParagraphKind;

/// What a key did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pressed {
    /// The lesson continues.
    Taken,
    /// The person leaves.
    Leave,
}

impl Lesson {
    /// Handles a key.
    pub fn press(&mut self, key: KeyEvent) -> Pressed {
        let pressed = key.modifiers.contains(KeyModifiers::CONTROL);
        self.share_keys();
        let notice = self.notice.take();
        match key.code {
            KeyCode::Char('c') if pressed => return Pressed::Leave,
            // in the lab they close what lies on top first
            KeyCode::Char('q') if !pressed && !self.has_lab() => return Pressed::Leave,
            KeyCode::Esc if !self.has_lab() => {
                if notice.as_deref() == Some(ESC_AGAIN) {
                    return Pressed::Leave;
                }
                self.notice = Some(ESC_AGAIN.to_owned());
                return Pressed::Taken;
            }
            _ => {}
        }
        let nothing = format!("{} does nothing here", keys::name(&key));
        let reads = matches!(self.stage, LessonStage::Reading | LessonStage::Choosing(_));
        if reads && self.changes_view(key) {
            return Pressed::Taken;
        }
        let continues = matches!(key.code, KeyCode::Enter | KeyCode::Char(' ') | KeyCode::F(9));
        match &mut self.stage {
            LessonStage::Reading if continues => self.proceed(),
            LessonStage::Ended if continues => return Pressed::Leave,
            LessonStage::Playing | LessonStage::Reading | LessonStage::Ended => {
                self.notice = Some(nothing);
            }
            LessonStage::Choosing(selected) => {
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
                        self.commit(GivenAnswer::Option(chosen));
                    }
                    _ => self.notice = Some(nothing),
                }
            }
            LessonStage::Typing(text, wrong) => match key.code {
                KeyCode::Char('u') if key.modifiers.contains(KeyModifiers::CONTROL) => {
                    text.clear();
                    *wrong = None;
                }
                KeyCode::Char(c) if !pressed && text.chars().count() < LONGEST_NUMBER => {
                    text.push(c);
                    *wrong = None;
                }
                KeyCode::Backspace => {
                    text.pop();
                    *wrong = None;
                }
                KeyCode::Enter => match number(text) {
                    Some(number) => self.commit(GivenAnswer::Number(number)),
                    None if text.is_empty() => *wrong = Some("Type a number first.".into()),
                    None => *wrong = Some("This is not a number; write it as 1.5 or 3/2.".into()),
                },
                KeyCode::Tab | KeyCode::BackTab => {
                    self.changes_view(key);
                }
                _ => self.notice = Some(nothing),
            },
            LessonStage::Pointing(wrong) => {
                *wrong = None;
                if !self.set_point(key) {
                    self.notice = Some(nothing);
                }
            }
            LessonStage::Free if key.code == KeyCode::F(9) => self.proceed(),
            LessonStage::Task { hinted, hint, .. } if key.code == KeyCode::F(9) => {
                match hint.take().filter(|_| !*hinted) {
                    Some(hint) => {
                        *hinted = true;
                        self.spoken.push(paragraph(ParagraphKind::Quiet, hint));
                    }
                    None => self.proceed(),
                }
            }
            LessonStage::Task { .. } | LessonStage::Free => {
                self.runner.lab.update(AppEvent::Key(key));
                if self.is_left() {
                    return Pressed::Leave;
                }
                self.complete_task();
            }
        }
        Pressed::Taken
    }

    fn changes_view(&mut self, key: KeyEvent) -> bool {
        LessonView::handle_key(&mut self.view, &mut self.runner.lab, key)
    }
}

/// Said of Esc, which would leave in the middle of a sentence.
const ESC_AGAIN: &str = "Esc again leaves";

/// The most characters of a number that is typed.
const LONGEST_NUMBER: usize = 24;

/// A number as a person types it: `1.5`, `-2e-3`, `3/2`.
fn number(text: &str) -> Option<f64> {
    let text = text.trim().replace('−', "-");
    let one = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
    match text.split_once('/') {
        Some((above, below)) => Some(one(above)? / one(below)?).filter(|number| number.is_finite()),
        None => one(&text),
    }
}
