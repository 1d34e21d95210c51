//! The prompt for Poisson brackets and for questions whether a quantity is conserved.
//!
//! In: characters. Out: the question, its answer, or an error with its position. Never here: how either is
//! computed.

use std::time::Duration;

use crossterm::event::KeyEvent;
use tui_input::Input;

use super::UnderWay;
use super::field::edit;
use crate::analysis::Inquiry;
use crate::expr::SyntaxError;
use crate::instrument::Answer;
use crate::job::Outcome;

/// A question being typed, and the answer to the last one.
#[derive(Clone, Debug, Default)]
pub struct Prompt {
    /// What is typed so far, with the cursor.
    pub input: Input,
    /// The question answered last, and its answer.
    pub answered: Option<(String, Box<Inquiry>)>,
    /// The syntax error of the text submitted last.
    pub diagnostic: Option<SyntaxError>,
    /// The question that is being answered.
    pub under_way: Option<(String, UnderWay)>,
}

impl Prompt {
    /// Handles an editing key and clears the last error message.
    pub(super) fn press(&mut self, key: KeyEvent) {
        if edit(&mut self.input, key) {
            self.diagnostic = None;
        }
    }

    pub(super) fn tick(&mut self, elapsed: Duration) {
        if let Some((_, job)) = &mut self.under_way {
            job.tick(elapsed);
        }
    }

    pub(super) fn awaits(&self, ticket: u64) -> bool {
        self.under_way.as_ref().is_some_and(|(_, job)| job.ticket == ticket)
    }

    pub(super) fn take(&mut self, outcome: &Outcome<Answer>) {
        let Some((text, _)) = self.under_way.take() else { return };
        let Outcome::Done(answer) = outcome else { return };
        match answer.of::<Result<Inquiry, SyntaxError>>() {
            Some(Ok(inquiry)) => {
                self.diagnostic = None;
                self.answered = Some((text, Box::new(inquiry.clone())));
            }
            Some(Err(diagnostic)) => {
                (self.diagnostic, self.answered) = (Some(diagnostic.clone()), None);
            }
            None => {}
        }
    }
}
