//! A parameter that is changed in the course of time while one looks: by a ramp from now on, written into the file's text.
//!
//! In: the selected parameter, what is typed: `2 in 60`. Out: the text with the ramp, which is checked and run as any change
//! of the text, so that the motion continues; the pane with the action variable. Never here: what a ramp does to a law.
//! Source: *The Principles of Dynamics*, § 4.3.

use super::field::{InputField, Purpose, number};
use super::{App, Effect, Lab, Loaded, Notification, Overlay, ValueId};
use crate::experiment::Checkpoint;
use crate::instrument::{Plot, named};
use crate::model::{Model, RampForm};
use crate::preset::NewRamp;

/// What is typed: where the parameter goes, in which time, and how.
struct RampRequest {
    to: f64,
    duration: f64,
    form: &'static str,
}

impl RampRequest {
    /// Reads `VALUE in TIME [FORM]`, or `VALUE:TIME[:FORM]` as on the command line.
    fn read(model: &Model, parameters: &[f64], typed: &str) -> Result<RampRequest, String> {
        let forms = RampForm::NAMED.map(|(name, _)| name);
        let text = typed.trim();
        let named = forms.iter().find_map(|&form| {
            let rest = text.strip_suffix(form)?;
            Some((rest.trim_end().trim_end_matches(':'), form))
        });
        let (text, form) = named.unwrap_or((text, forms[0]));
        let parts = text.split_once(" in ").or_else(|| text.split_once(':'));
        let Some((to, duration)) = parts else {
            return Err("Write the final value and the duration: 2 in 60.".to_owned());
        };
        let to = number(model, parameters, to)?;
        let duration = number(model, parameters, duration)?;
        if duration <= 0.0 {
            return Err("The duration of a ramp must be above zero.".to_owned());
        }
        Ok(RampRequest { to, duration, form })
    }
}

impl App {
    /// Asks where the selected parameter goes.
    pub(super) fn open_ramp(&mut self) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let Some(ValueId::Parameter(index)) = lab.selected() else {
            return self.notify("A ramp changes a parameter: choose one.");
        };
        if lab.loaded.model.body.is_some() {
            return self.notify("Parameters cannot change with time in a file with a [body].");
        }
        self.open_field(Purpose::Ramp(index))
    }

    /// Writes the ramp that was typed into the text of the system.
    pub(super) fn accept_ramp(&mut self, mut field: InputField, index: usize) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let Some(snapshot) = lab.seen() else { return Vec::new() };
        let model = &lab.loaded.model;
        let read = RampRequest::read(model, &snapshot.parameters, field.input.value());
        let Some(parameter) = model.parameters.get(index) else { return Vec::new() };
        let (name, start) = (parameter.name.clone(), snapshot.time);
        let request = match read {
            Ok(request) => request,
            Err(sentence) => {
                field.diagnostic = Some(sentence);
                self.overlay = Some(Overlay::Field(field));
                return Vec::new();
            }
        };
        let RampRequest { to, duration, form } = request;
        let ramp = NewRamp { parameter: name.clone(), to, start, duration, form };
        if let Err(effects) = self.change_text(|text| ramp.added_to(text)) {
            return effects;
        }
        if let Some(lab) = &mut self.lab {
            lab.pause_for_ramp(&name);
            lab.show_action_variable();
        }
        let sentence = format!(
            "{name} goes to {to} from t = {start:.3} on, in {duration}, once the law is rebuilt; E shows the ramp."
        );
        self.notifications.show(Notification::info(sentence));
        Vec::new()
    }
}

impl Lab {
    /// Whether the motion waits for the law with a ramp that was typed.
    pub fn waits_for_law(&self) -> bool {
        self.restoration.waits_for_rebuild()
    }

    /// Lets the motion continue from what is seen, once the law with the ramp is there: the ramp begins at that very time, so
    /// that nothing jumps.
    fn pause_for_ramp(&mut self, name: &str) {
        let Some(seen) = self.seen() else { return };
        let Loaded { model, system, .. } = &self.loaded;
        let checkpoint = Checkpoint::of(model, system, seen).with_past(system, seen);
        let checkpoint = checkpoint.with_another_law(name);
        self.restoration.begin_after_rebuild(checkpoint);
    }

    /// Adds the pane with the action variable of the only coordinate, if it is not there, and brings it into view. The focus
    /// stays on the parameter, so that the next ramp begins with the same key.
    fn show_action_variable(&mut self) {
        let Some(kind) = named("actions") else { return };
        let known = self.plots.iter().position(|shown| shown.kind == kind);
        let physics = self.loaded.physics();
        let index = known.or_else(|| {
            let [offer] = &kind.offers(physics)[..] else { return None };
            let plot = Plot::new(kind, (offer.columns.clone(), None), physics.model);
            let plot = plot.opened(physics);
            self.plots.push(plot);
            Some(self.plots.len() - 1)
        });
        if let Some(index) = index {
            self.focus.bring_to_front(index);
            self.answers.stale = true;
        }
    }
}
