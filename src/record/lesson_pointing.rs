//! A point or a curve that is predicted on a plot: set by its cursor, with keys or the mouse.
//!
//! In: keys, mouse events. Out: points in the lab's prediction, and the answer. Never here: what is right.

use crossterm::event::{KeyCode, KeyEvent, MouseButton, MouseEventKind};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::lesson::{Lesson, LessonStage};
use super::lesson_question::GivenAnswer;
use super::script_runner::ScriptRunner;
use crate::app::{AppEvent, HitTarget, Prediction};
use crate::view::{Painter, RenderStyle, hit_test};

const MOST_POINTS: usize = 40;

impl Lesson {
    /// Handles a key while a point or a curve is set. Returns whether it does anything.
    pub(super) fn set_point(&mut self, key: KeyEvent) -> bool {
        let is_curve = self.predicted().is_some_and(|prediction| prediction.is_curve);
        match key.code {
            KeyCode::Left
            | KeyCode::Right
            | KeyCode::Up
            | KeyCode::Down
            | KeyCode::Char('h' | 'j' | 'k' | 'l' | '+' | '=' | '-') => {
                self.runner.lab.update(AppEvent::Key(key));
            }
            KeyCode::Char(' ') if is_curve => {
                let at = self.runner.reading();
                self.add_point(at);
            }
            KeyCode::Backspace | KeyCode::Delete if is_curve => {
                if let Some(prediction) = self.predicted() {
                    prediction.points.pop();
                }
            }
            KeyCode::Enter if is_curve => {
                let points = self.predicted().map_or(Vec::new(), |found| found.points.clone());
                if points.len() >= 2 {
                    self.commit(GivenAnswer::Points(points));
                } else {
                    let why = "A curve takes two points at least; Space sets one at the cursor.";
                    self.stage = LessonStage::Pointing(Some(why.to_owned()));
                }
            }
            KeyCode::Enter => {
                if let Some(at) = self.runner.reading() {
                    self.commit(GivenAnswer::Points(vec![at]));
                }
            }
            _ => return false,
        }
        true
    }

    fn predicted(&mut self) -> Option<&mut Prediction> {
        self.runner.lab.app.lab.as_mut()?.prediction.as_deref_mut()
    }

    fn add_point(&mut self, at: Option<[f64; 2]>) {
        let (Some(at), Some(prediction)) = (at, self.predicted()) else { return };
        if prediction.points.len() < MOST_POINTS && prediction.points.last() != Some(&at) {
            prediction.points.push(at);
        }
    }

    /// Handles a mouse event at a position of the screen: a click puts the cursor on the plot, and sets a point of a
    /// curve; where the lab is the person's, it is the lab's.
    pub fn point(&mut self, kind: MouseEventKind, style: &RenderStyle, [column, row]: [u16; 2]) {
        let pressed = kind == MouseEventKind::Down(MouseButton::Left);
        match self.stage {
            LessonStage::Task { .. } | LessonStage::Free => {
                if pressed {
                    // Not every terminal reports the release of a button.
                    self.runner.lab.app.end_group();
                }
                if let Some(hit) = self.runner.hit(style, column, row) {
                    self.runner.lab.update(AppEvent::Mouse(kind, hit));
                    self.complete_task();
                }
            }
            LessonStage::Pointing(_) if pressed => {
                let Some(HitTarget::Plot { index, place, at }) =
                    self.runner.hit(style, column, row)
                else {
                    return;
                };
                let Some(lab) = self.runner.lab.app.lab.as_mut() else { return };
                let (Some(prediction), Some(plot)) = (&lab.prediction, lab.plots.get_mut(index))
                else {
                    return;
                };
                if !prediction.is_on(plot) {
                    return;
                }
                let is_curve = prediction.is_curve;
                if let Some(viewport) = plot.viewport_mut() {
                    viewport.put_cursor(Some(place));
                }
                self.stage = LessonStage::Pointing(None);
                if is_curve {
                    self.add_point(Some(at));
                }
            }
            _ => {}
        }
    }
}

impl ScriptRunner {
    /// The coordinates of the cursor of the focused plot, as it stands after the last key.
    fn reading(&mut self) -> Option<[f64; 2]> {
        let style = self.script.head.render_style();
        let area = Rect::from(self.size);
        let mut buffer = Buffer::empty(area);
        let drawn = self.paint(&mut Painter::default(), &style, area, &mut buffer);
        let reading = drawn.reading;
        self.lab.update(AppEvent::Drawn(drawn));
        reading
    }

    /// What lies under a position of the screen as it was last drawn.
    fn hit(&self, style: &RenderStyle, column: u16, row: u16) -> Option<HitTarget> {
        let height = self.size.height.saturating_sub(self.caption_rows(self.size.width));
        let area = Rect { height, ..Rect::from(self.size) };
        hit_test(&self.lab.app, style, area, column, row)
    }
}
