//! What the picker's selection and the keys of a value open: a system, or a field to type in.
//!
//! In: what is selected, the purpose of a field. Out: the changed state and the effects. Never here: keys; what is typed.

use super::field::InputField;
use super::{Above, App, Effect, Overlay, Page, Purpose};
use crate::experiment::Command;
use crate::integrate::{METHODS, Stepping};
use crate::num::no_longer_than;

/// How far a flow leads where nothing else is typed.
const FLOW: f64 = 0.1;

impl App {
    pub(super) fn open_selected(&mut self) -> Vec<Effect> {
        if let Some(session) = self.picker.selected_session().cloned() {
            return self.continue_session(session);
        }
        match self.picker.selected_above() {
            Some(Above::Unsaved) => return self.return_to_text(),
            Some(Above::Guides) => return self.open_guides(),
            Some(Above::NewSystem) => return self.new_system(),
            Some(Above::Session) | None => {}
        }
        let Some(name) = self.picker.take() else {
            return self.notify("No system fits this search.");
        };
        if let Some(error) = self.picker.error.clone().filter(|error| error.name == name) {
            self.text.scroll = 0;
            self.overlay = Some(Overlay::Message(error));
            return Vec::new();
        }
        let here = self.lab.as_ref().is_some_and(|lab| lab.loaded.name == name);
        let later = self.awaited.system.as_ref().is_some_and(|request| request.name != name);
        if here && !later {
            self.go(Page::Lab);
            return vec![Effect::Execute(Command::Reset), Effect::Execute(Command::Play)];
        }
        if let Some(request) = self.awaited.system.as_mut().filter(|request| request.name == name) {
            request.opens = true;
            return Vec::new();
        }
        vec![self.ask(name, true)]
    }

    pub(super) fn open_field(&mut self, purpose: Purpose) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let method = lab.snapshot.as_ref().map(|s| &s.method);
        let idle = lab.method().and_then(|name| idle(purpose, name));
        if let Some(sentence) = idle {
            return self.notify(sentence);
        }
        let now = match purpose {
            Purpose::Value(target) => lab.value(target),
            Purpose::Flow(_) | Purpose::SymmetryFlow(_) | Purpose::GeneratorFlow(_) => Some(FLOW),
            Purpose::TypedFlow | Purpose::Ramp(_) | Purpose::Surface(_) => None,
            Purpose::Step => method.map(|m| m.step),
            Purpose::Tolerance => method.and_then(|m| m.tolerance),
        };
        self.overlay =
            Some(Overlay::Field(InputField::new(purpose, now.map_or_else(String::new, written))));
        Vec::new()
    }
}

/// Returns why a method has no use for this setting, or `None` if it has.
fn idle(purpose: Purpose, method: &str) -> Option<String> {
    let stepping = METHODS.iter().find(|m| m.name == method)?.stepping;
    match (purpose, stepping) {
        (Purpose::Step, Stepping::Adaptive) => {
            Some(format!("{method} chooses its steps itself; its tolerance is set by a."))
        }
        (Purpose::Tolerance, Stepping::Fixed) => {
            Some(format!("{method} has no tolerance; its step is set by s."))
        }
        _ => None,
    }
}

/// Formats a number for typing: short, without loss.
fn written(value: f64) -> String {
    no_longer_than(value, 12)
}
