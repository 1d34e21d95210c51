//! A lesson or demo that has the lab's screen: opened, left.
//!
//! In: the guide chosen. Out: the lab as it was, with the progress of the lesson. Never here: its script.

use tracing::info;

use super::super::frame_loop::ScreenRequest;
use super::super::guided::{Guided, guides};
use super::Session;
use crate::app::{AppEvent, Guide};
use crate::experiment::{Command, Status};

impl Session {
    /// Finds the lessons and demos.
    pub(super) fn find_guides(&mut self) {
        self.app.picker.guides = guides(&self.app.picker.entries);
    }

    /// Gives the screen to a lesson or demo, while the lab's own motion waits.
    pub(super) fn take_guide(&mut self, guide: &Guide) {
        info!("take {guide:?}");
        match Guided::open(guide, self.style.full().clone()) {
            Ok(mut guided) => {
                let status = self.app.snapshot().map(|snapshot| &snapshot.status);
                guided.was_running = status == Some(&Status::Running);
                if guided.was_running {
                    self.worker.execute(Command::Pause);
                }
                self.guided = Some(guided);
            }
            Err(wrong) => self.guide_left(Some(wrong)),
        }
    }

    /// Takes the screen back.
    pub(super) fn leave_guide(&mut self) {
        let Some(guided) = self.guided.take() else { return };
        if guided.was_running {
            self.worker.execute(Command::Play);
        }
        let wrong = guided.leave();
        self.guide_left(wrong);
    }

    fn guide_left(&mut self, wrong: Option<String>) {
        let guides = guides(&self.app.picker.entries);
        self.update(AppEvent::GuideLeft { guides, wrong });
    }

    /// Hands what the lesson or demo asks of the terminal on; where it ends, the lab continues.
    pub(super) fn asked_by_guide(&mut self, request: ScreenRequest) -> ScreenRequest {
        if request == ScreenRequest::Quit {
            self.leave_guide();
            return ScreenRequest::Nothing;
        }
        request
    }
}
