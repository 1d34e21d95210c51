//! What a lesson says and shows at each moment.
//!
//! In: a [`Lesson`]. Out: its [`Speech`], and the screen with the lab above. Never here: how the pane looks, or what
//! comes next.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::assertion::short;
use super::lesson::{Lesson, LessonStage, paragraph};
use super::lesson_judge::letter;
use super::lesson_order::steps_of_person;
use super::lesson_question::{Question, QuestionKind};
use crate::app::{Overlay, Page};
use crate::view::RenderStyle;
use crate::view::lesson::{self, Paragraph, ParagraphKind, Speech};

/// The least rows of the pane, with its frame: where it keeps its size, and where it does not.
const LEAST_ROWS: u16 = 5;
const LEAST_PANE: u16 = 3;

/// The rows from which a screen keeps the pane the same throughout, and the least rows of the picture in a lower one.
const STANDARD: u16 = 20;
const LEAST_PICTURE: u16 = 3;

impl Lesson {
    /// Draws the lab, and below it what the lesson says.
    pub fn draw(&mut self, style: &RenderStyle, area: Rect, buffer: &mut Buffer) {
        let speech = self.speech();
        let rows = self.pane_rows(&speech, area);
        let above = Rect { height: area.height - rows, ..area };
        self.share_keys();
        self.runner.draw(style, above, buffer);
        // what the cursor reads is known once it is drawn
        let speech = self.speech();
        let below = Rect { y: above.bottom(), height: rows, ..area };
        lesson::draw(style, &speech, below, buffer);
    }

    /// The rows of the pane: the same throughout, so that the picture keeps its place; on a low screen those of what is
    /// said now, so that there is a picture.
    fn pane_rows(&self, speech: &Speech, area: Rect) -> u16 {
        let rows = lesson::rows(&speech.paragraphs, area.width).max(LEAST_PANE);
        if area.height < STANDARD {
            return if rows + LEAST_PICTURE > area.height { area.height } else { rows };
        }
        let steps = self.runner.script.steps.iter();
        let texts =
            steps_of_person(&self.runner.script).map(|spoken| lesson::rows(&spoken, area.width));
        let least = if steps.len() == 0 { 0 } else { LEAST_ROWS };
        let most = (area.height / 2).max(LEAST_ROWS);
        texts.max().unwrap_or(0).max(least).min(most).max(rows).min(area.height)
    }

    /// What the lesson says now.
    pub fn speech(&self) -> Speech {
        let mut spoken = self.spoken.clone();
        let keys = match &self.stage {
            LessonStage::Playing => match &self.question {
                Some(question) => {
                    spoken = vec![paragraph(ParagraphKind::Text, question.text.clone())];
                    spoken.push(paragraph(ParagraphKind::Quiet, question.answer()));
                    "watch what happens · q leaves"
                }
                None => "watch · q leaves",
            },
            LessonStage::Reading => "Enter continues · Tab other panes · q leaves",
            LessonStage::Ended => "Enter leaves",
            LessonStage::Task { .. } | LessonStage::Free if self.is_typing_in_lab() => {
                "Enter accepts what is typed · Esc cancels"
            }
            LessonStage::Task { .. } | LessonStage::Free if self.is_off_the_lab() => {
                "1 returns to the lab · q leaves"
            }
            LessonStage::Free => "the lab is yours · F9 continues · q leaves",
            LessonStage::Task { hint, .. } => match hint {
                Some(_) => "the lab is yours · F9 hint · q leaves",
                None => "the lab is yours · F9 skips this · q leaves",
            },
            LessonStage::Choosing(selected) => {
                spoken =
                    self.question.as_ref().map_or(Vec::new(), |question| question.asked(*selected));
                "↑ ↓ choose · Enter confirms · Tab other panes · q leaves"
            }
            LessonStage::Pointing(wrong) => {
                let question = self.question.as_ref();
                spoken = question.map_or(Vec::new(), |question| question.asked(0));
                spoken.push(paragraph(ParagraphKind::Selected, self.pointed()));
                spoken.extend(wrong.iter().map(|why| paragraph(ParagraphKind::Wrong, why.clone())));
                if question.is_some_and(Question::is_curve) {
                    "arrows or mouse · Space sets, Backspace removes · Enter confirms · q leaves"
                } else {
                    "arrows or mouse · Enter confirms · q leaves"
                }
            }
            LessonStage::Typing(text, wrong) => {
                let question = self.question.as_ref().map(|question| question.text.clone());
                spoken = vec![paragraph(ParagraphKind::Text, question.unwrap_or_default())];
                spoken.push(paragraph(ParagraphKind::Typed, format!("{text}_")));
                spoken.extend(wrong.iter().map(|why| paragraph(ParagraphKind::Wrong, why.clone())));
                "type a number · Enter confirms · Tab other panes · q leaves"
            }
        };
        let all = self.runner.script.steps.len();
        let place = format!("{} %", 100 * self.runner.next.min(all) / all.max(1));
        let keys = match &self.notice {
            Some(notice) => format!("{notice} · {keys}"),
            None => keys.to_owned(),
        };
        let focused = !self.has_lab() && !matches!(self.stage, LessonStage::Pointing(_));
        Speech { title: self.title.clone(), place, paragraphs: spoken, keys, focused }
    }
}

impl Lesson {
    /// Whether a field of the lab takes the keys.
    fn is_typing_in_lab(&self) -> bool {
        matches!(self.runner.lab.app.overlay, Some(Overlay::Field(_)))
    }

    /// Whether another page than the lab is shown.
    fn is_off_the_lab(&self) -> bool {
        let app = &self.runner.lab.app;
        app.overlay.is_none() && app.page != Page::Lab
    }

    /// Where the cursor is, and how many points there are.
    fn pointed(&self) -> String {
        let app = &self.runner.lab.app;
        let prediction = app.lab.as_ref().and_then(|lab| lab.prediction.as_ref());
        let Some(prediction) = prediction else { return String::new() };
        let Some(at) = app.cursor_reading() else {
            let none = if prediction.is_curve { "no point is set yet" } else { "" };
            return none.to_owned();
        };
        let [x, y] = self.names(prediction);
        let cursor = format!("{x} = {}, {y} = {}", short(at[0]), short(at[1]));
        match prediction.points.len() {
            _ if !prediction.is_curve => cursor,
            0 => format!("{cursor}; no point is set yet"),
            1 => format!("{cursor}; 1 point is set"),
            many => format!("{cursor}; {many} points are set"),
        }
    }
}

impl Question {
    fn is_curve(&self) -> bool {
        matches!(&self.kind, QuestionKind::Place { prediction, .. } if prediction.is_curve)
    }

    /// The question with its options.
    pub(super) fn asked(&self, selected: usize) -> Vec<Paragraph> {
        let mut spoken = vec![paragraph(ParagraphKind::Text, self.text.clone())];
        if let QuestionKind::Choice { options, .. } = &self.kind {
            spoken.extend(options.iter().enumerate().map(|(index, option)| {
                let chosen = index == selected;
                let kind = if chosen { ParagraphKind::Selected } else { ParagraphKind::Option };
                paragraph(kind, letter(index, &option.text))
            }));
        }
        spoken
    }

    fn answer(&self) -> String {
        match &self.kind {
            QuestionKind::Choice { options, chosen: Some(chosen) } => {
                format!("Your answer: {}", letter(*chosen, &options[*chosen].text))
            }
            QuestionKind::Number { typed: Some(number), .. } => {
                format!("Your prediction: {}", short(*number))
            }
            QuestionKind::Place { prediction, .. } => match prediction.points.last() {
                Some(_) if !prediction.is_curve => {
                    "Your prediction: the point in the picture".to_owned()
                }
                _ => "Your prediction: the curve in the picture".to_owned(),
            },
            _ => String::new(),
        }
    }
}
