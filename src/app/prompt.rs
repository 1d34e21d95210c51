//! The prompt at which one asks for a bracket, or whether something is conserved.
//!
//! In: characters. Out: the question, its answer, or a mistake at its place. Never here: how either is found.

use std::sync::Arc;
use std::time::Duration;

use crossterm::event::KeyEvent;
use tui_input::Input;

use super::field::edit;
use super::{App, Asker, Effect, Overlay, UnderWay};
use crate::analysis::Inquiry;
use crate::expr::SyntaxError;
use crate::instrument::Answer;
use crate::job::{Job, Outcome};

/// A question being typed, and what was answered to the last one.
#[derive(Clone, Debug, Default)]
pub struct Prompt {
    /// What is typed so far, with the cursor.
    pub input: Input,
    /// The question that was answered, and the answer.
    pub answered: Option<(String, Box<Inquiry>)>,
    /// What is wrong with what was typed when it was last to be answered.
    pub mistake: Option<SyntaxError>,
    /// The question that is being answered.
    pub under_way: Option<(String, UnderWay)>,
}

impl Prompt {
    /// Handles a key of editing; whatever it was, the last complaint is answered.
    pub(super) fn press(&mut self, key: KeyEvent) {
        if edit(&mut self.input, key) {
            self.mistake = None;
        }
    }

    /// Time has passed.
    pub(super) fn tick(&mut self, elapsed: Duration) {
        if let Some((_, job)) = &mut self.under_way {
            job.tick(elapsed);
        }
    }

    /// Whether the job of a number is the one it waits for.
    pub(super) fn awaits(&self, ticket: u64) -> bool {
        self.under_way.as_ref().is_some_and(|(_, job)| job.ticket == ticket)
    }

    /// The answer is there, or there will be none.
    pub(super) fn take(&mut self, outcome: &Outcome<Answer>) {
        let Some((text, _)) = self.under_way.take() else { return };
        let Outcome::Done(answer) = outcome else { return };
        match answer.of::<Result<Inquiry, SyntaxError>>() {
            Some(Ok(inquiry)) => {
                self.mistake = None;
                self.answered = Some((text, Box::new(inquiry.clone())));
            }
            Some(Err(mistake)) => (self.mistake, self.answered) = (Some(mistake.clone()), None),
            None => {}
        }
    }
}

impl App {
    pub(super) fn open_prompt(&mut self) -> Vec<Effect> {
        if self.lab.is_some() {
            self.overlay = Some(Overlay::Prompt(Prompt::default()));
        }
        Vec::new()
    }

    /// Asks what is typed; the prompt stays for the answer and for the next question.
    pub(super) fn answer(&mut self, mut prompt: Prompt) -> Vec<Effect> {
        let text = prompt.input.value().to_owned();
        let mut effects = Vec::new();
        if let Some(lab) = self.lab.as_ref().filter(|_| !text.trim().is_empty()) {
            let (model, equations) =
                (Arc::clone(&lab.loaded.model), Arc::clone(&lab.loaded.equations));
            let asked = text.clone();
            let job = Job::new("deriving", move |progress| {
                Answer::new(Inquiry::with(&model, &equations, &asked, progress.token()))
            });
            let computation = self.computation(Asker::Prompt, job);
            prompt.under_way = Some((text, UnderWay::new(&computation)));
            effects.push(Effect::Compute(computation));
        }
        self.overlay = Some(Overlay::Prompt(prompt));
        effects
    }
}
