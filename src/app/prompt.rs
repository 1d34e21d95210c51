//! The prompt at which one asks for a bracket, or whether something is conserved.
//!
//! In: characters. Out: the question, its answer, or a mistake at its place. Never here: how either is found.

use tui_input::Input;

use super::field::edit;
use super::{App, Effect, Key, Lab, Overlay};
use crate::analysis::Inquiry;
use crate::expr::{Symbol, SyntaxError};
use crate::mechanics::body_values;
use crate::system::ChannelKind;

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
    /// The present value of a symbol of the system; not a number for one that has none.
    pub fn now(&self, symbol: Symbol) -> f64 {
        let Some(snapshot) = self.seen() else { return f64::NAN };
        let (model, equations) = (&self.loaded.model, &self.loaded.equations);
        if symbol == equations.symbols.time {
            return snapshot.time;
        }
        if let Some(index) = model.parameters.iter().position(|p| p.symbol == symbol) {
            return snapshot.parameters[index];
        }
        let coordinates = equations.coordinates.iter().enumerate();
        let of_coordinate = coordinates.flat_map(|(i, c)| {
            [
                (c.position, ChannelKind::Position(i)),
                (c.velocity, ChannelKind::Velocity(i)),
                (c.momentum, ChannelKind::Momentum(i)),
            ]
        });
        let rows = equations.constraints.iter().enumerate();
        let multipliers = rows.map(|(k, row)| (row.multiplier, ChannelKind::Multiplier(k)));
        let energy = [(equations.symbols.energy, ChannelKind::Energy)];
        let entries = equations.beside.attitude_symbols.iter().flatten().flatten().enumerate();
        let attitude = entries.map(|(i, symbol)| (*symbol, ChannelKind::Attitude(i)));
        let mut known = of_coordinate.chain(multipliers).chain(energy).chain(attitude);
        let kind = known.find(|(s, _)| *s == symbol);
        let channels = self.loaded.system.channels();
        let place = kind.and_then(|(_, kind)| channels.iter().position(|c| c.kind == kind));
        if let Some(place) = place {
            return snapshot.values[place];
        }
        let body = equations.beside.body.as_ref();
        let constants = body_values(model, &equations.pool, body, &snapshot.parameters);
        constants.into_iter().find(|(s, _)| *s == symbol).map_or(f64::NAN, |(_, value)| value)
    }
}
