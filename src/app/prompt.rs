//! The prompt for Poisson brackets and for questions whether a quantity is conserved.
//!
//! In: characters. Out: the question, its answer, or an error with its position. Never here: how either is
//! computed.

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

/// A question being typed, and the answer to the last one.
#[derive(Clone, Debug, Default)]
pub struct Prompt {
    /// What is typed so far, with the cursor.
    pub input: Input,
    /// The question answered last, and its answer.
    pub answered: Option<(String, Box<Inquiry>)>,
    /// The syntax error of the text submitted last.
    pub mistake: Option<SyntaxError>,
    /// The question that is being answered.
    pub under_way: Option<(String, UnderWay)>,
}

impl Prompt {
    /// Handles an editing key and clears the last error message.
    pub(super) fn press(&mut self, key: KeyEvent) {
        if edit(&mut self.input, key) {
            self.mistake = None;
        }
    }

    /// Advances the time.
    pub(super) fn tick(&mut self, elapsed: Duration) {
        if let Some((_, job)) = &mut self.under_way {
            job.tick(elapsed);
        }
    }

    /// Whether it waits for the job with this ticket.
    pub(super) fn awaits(&self, ticket: u64) -> bool {
        self.under_way.as_ref().is_some_and(|(_, job)| job.ticket == ticket)
    }

    /// Takes in the outcome of the job.
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

    /// Submits the typed question; the prompt stays open for the answer and the next question.
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
