//! The prompt at which one asks for a bracket, or whether something is conserved.
//!
//! In: characters. Out: the question, its answer, or a mistake at its place. Never here: how either is found.

use tui_input::Input;

use super::field::edit;
use super::{App, Effect, Key, Lab, Loaded, Overlay};
use crate::analysis::Inquiry;
use crate::expr::{Symbol, SyntaxError};
use crate::mechanics::Valuation;

/// A question being typed, and what was answered to the last one.
#[derive(Clone, Debug, Default)]
pub struct Prompt {
    /// What is typed so far, with the cursor.
    pub input: Input,
    /// The question that was answered, and the answer.
    pub answered: Option<(String, Box<Inquiry>)>,
    /// What is wrong with what was typed when it was last to be answered.
    pub mistake: Option<SyntaxError>,
}

impl Prompt {
    /// Handles a key of editing; whatever it was, the last complaint is answered.
    pub(super) fn press(&mut self, key: Key) {
        if edit(&mut self.input, key) {
            self.mistake = None;
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

    /// Answers what is typed; the prompt stays for the next question.
    pub(super) fn answer(&mut self, mut prompt: Prompt) -> Vec<Effect> {
        let text = prompt.input.value().to_owned();
        if let Some(lab) = self.lab.as_ref().filter(|_| !text.trim().is_empty()) {
            match Inquiry::of(&lab.loaded.model, &lab.loaded.equations, &text) {
                Ok(inquiry) => {
                    prompt.mistake = None;
                    prompt.answered = Some((text, Box::new(inquiry)));
                }
                Err(mistake) => (prompt.mistake, prompt.answered) = (Some(mistake), None),
            }
        }
        self.overlay = Some(Overlay::Prompt(prompt));
        Vec::new()
    }
}

impl Lab {
    /// What the symbols of the system are worth at present; nothing before the motion was seen.
    pub fn valuation(&self) -> Valuation {
        let Some(snapshot) = self.seen() else { return Valuation::default() };
        let Loaded { model, equations, system, .. } = &self.loaded;
        let known = (&**model, &**equations);
        system.valuation(known, snapshot.time, &snapshot.parameters, &snapshot.values)
    }

    /// The present value of a symbol of the system; not a number for one that has none.
    pub fn now(&self, symbol: Symbol) -> f64 {
        self.valuation().at(symbol)
    }
}
