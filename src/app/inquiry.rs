//! Questions asked at the prompt.
//!
//! In: what was typed. Out: the job that answers it. Never here: how it is answered.

use std::sync::Arc;

use super::{App, Asker, Effect, Overlay, Prompt, UnderWay};
use crate::analysis::Inquiry;
use crate::instrument::Answer;
use crate::job::Job;

impl App {
    pub(super) fn open_prompt(&mut self) -> Vec<Effect> {
        if self.lab.is_some() {
            self.overlay = Some(Overlay::Prompt(Prompt::default()));
        }
        Vec::new()
    }

    /// Submits the typed question; the prompt stays open for the answer and the next question.
    pub(super) fn answer(&mut self, mut prompt: Prompt) -> Vec<Effect> {
        let text = prompt.input.value().to_owned();
        let mut effects = Vec::new();
        if let Some(lab) = self.lab.as_ref().filter(|_| !text.trim().is_empty()) {
            let (model, equations) =
                (Arc::clone(&lab.loaded.model), Arc::clone(&lab.loaded.equations));
            let asked = text.clone();
            let job = Job::new("deriving", move |progress| {
                Answer::new(Inquiry::of(&model, &equations, &asked, progress.token()))
            });
            let computation = self.jobs.request(Asker::Prompt, job);
            prompt.under_way = Some((text, UnderWay::new(&computation)));
            effects.push(Effect::Compute(computation));
        }
        self.overlay = Some(Overlay::Prompt(prompt));
        effects
    }
}
