//! An axis that is typed: an expression that the list of quantities does not have becomes an observable of the view.
//!
//! In: what was typed above the list. Out: the observable, with which the text is checked and run once more, unchanged itself;
//! the plot with it on its axis, as soon as that runs. Never here: the list, or how a text is checked.

use super::pending::{AwaitedView, TypedAxis};
use super::{App, Choosing, Effect, Lab, Menu, Notification, Overlay};
use crate::diagnostic::{Diagnostic, Severity};
use crate::instrument::{Plot, SavedPlot, named};
use crate::model::{Allowed, Scope};
use crate::preset::NewObservable;

impl App {
    /// Takes what was typed above a list of quantities for an axis. Returns `None` if nothing was, or it is another list.
    pub(super) fn type_axis(&mut self, menu: &Menu) -> Option<Vec<Effect>> {
        let (Choosing::Contents { plot } | Choosing::Axis { plot, .. }) = menu.purpose else {
            return None;
        };
        let typed = menu.filter.as_ref()?.value().trim().to_owned();
        let lab = self.lab.as_ref().filter(|_| !typed.is_empty())?;
        let model = &lab.loaded.model;
        let mut pool = lab.loaded.equations.pool.clone();
        let mut scope = Scope::new(model, Allowed::Observable, "an axis");
        let Some(expression) = scope.read(&mut pool, &typed) else {
            let what = scope.diagnostics.first().map(ToString::to_string);
            let what = what.unwrap_or_else(|| "it cannot be read".to_owned());
            let sentence = format!("No line has `{typed}`, and as an expression: {what}.");
            self.overlay = Some(Overlay::Menu(menu.clone()));
            return Some(self.fail(sentence));
        };
        let channel_name = |channel: usize| {
            lab.loaded.system.channels().get(channel).map_or_else(String::new, |c| c.name.clone())
        };
        let begun = menu.begun.as_ref().map(|(plot, label)| {
            let names = |columns: &Vec<usize>| columns.iter().map(|&c| channel_name(c)).collect();
            (plot.clone(), plot.columns.iter().map(names).collect(), label.clone())
        });
        let known = lab.loaded.system.channel_of(expression).map(channel_name);
        let known = known.filter(|name| !name.is_empty());
        // An expression with a rate has the name that was typed, which no prime or dot above a letter changes.
        let shown = model.pool.with_shown_names(&typed);
        let has_rate = shown.contains(['′', '″', '\u{307}', '\u{308}']);
        let shown = if has_rate { typed.clone() } else { shown };
        let name = known.clone().unwrap_or(shown);
        let axis = TypedAxis { plot, begun, name: name.clone() };
        if known.is_some() {
            return Some(self.set_typed_axis(axis));
        }
        if let Err(effects) = self.check_again() {
            return Some(effects);
        }
        if let Some(lab) = &mut self.lab {
            lab.typed.push(NewObservable { name, expression: typed });
        }
        self.awaited.plots.axis = Some(axis);
        Some(Vec::new())
    }

    /// Gives up the quantities typed for axes that no longer fit this text, as errors behind it say; the text is then checked
    /// without them. Returns whether it does.
    pub(super) fn gives_up_typed(&mut self, diagnostics: &[Diagnostic], own: &str) -> bool {
        let Some(lab) = self.lab.as_mut().filter(|lab| !lab.typed.is_empty()) else { return false };
        let is_error = |one: &&Diagnostic| one.severity == Severity::Error;
        let places = || diagnostics.iter().filter(is_error).map(|error| error.place.start);
        if !places().all(|place| place > own.len()) {
            return false;
        }
        let mut text = own.to_owned();
        let (lost, valid): (Vec<_>, Vec<_>) = lab.typed.drain(..).partition(|one| {
            let from = text.len();
            text = one.behind(&text);
            places().any(|place| (from..text.len()).contains(&place))
        });
        // where it cannot be said which of them it is, all are given up
        let (lost, valid) = if lost.is_empty() { (valid, lost) } else { (lost, valid) };
        let lost: Vec<String> = lost.into_iter().map(|one| one.name).collect();
        lab.typed = valid;
        lab.take_off_axes(&lost);
        if let Some(view) = &mut self.awaited.view {
            view.take_off_axes(&lost, lab);
        }
        let (was, its) = if lost.len() == 1 {
            ("was removed from its axis", "its")
        } else {
            ("were removed from their axes", "their")
        };
        let names = lost.join("`, `");
        let sentence = format!("`{names}` {was}: the text no longer defines all of {its} names.");
        self.notifications.show(Notification::error(sentence));
        self.check_again().is_ok()
    }

    /// Puts the quantity of a text that runs now on the axis that waits for it.
    pub(super) fn take_typed_axis(&mut self) -> Vec<Effect> {
        self.awaited.plots.axis.take().map_or(Vec::new(), |axis| self.set_typed_axis(axis))
    }

    fn set_typed_axis(&mut self, axis: TypedAxis) -> Vec<Effect> {
        let TypedAxis { plot, begun, name } = axis;
        let Some(lab) = &self.lab else { return Vec::new() };
        let Some(channel) = channel(lab, &name) else { return Vec::new() };
        let label = lab.loaded.physics().shown(channel).to_owned();
        let physics = lab.loaded.physics();
        match begun {
            Some((mut begun, names, first)) => {
                let place = |names: &Vec<String>| {
                    names.iter().filter_map(|name| self::channel(lab, name)).collect()
                };
                begun.columns = names.iter().map(place).collect();
                begun.columns.push(vec![channel]);
                self.choose_on(plot, begun, first)
            }
            None => {
                let Some(kind) = named("phase") else { return Vec::new() };
                let begun = Plot::new(kind, (vec![vec![channel]], None), physics.model);
                self.choose_on(plot, begun.opened(physics), label)
            }
        }
    }
}

impl Lab {
    /// Shows what the file shows in place of the pictures with a quantity of one of these names.
    fn take_off_axes(&mut self, names: &[String]) {
        let physics = self.loaded.physics();
        let opening = Plot::opening(physics);
        for (plot, first) in self.plots.iter_mut().zip(opening) {
            if SavedPlot::of(plot, physics).shows_one_of(names) {
                *plot = first;
            }
        }
    }
}

impl AwaitedView {
    /// The same for pictures that wait.
    fn take_off_axes(&mut self, names: &[String], lab: &Lab) {
        let physics = lab.loaded.physics();
        for (plot, first) in self.saved.plots.iter_mut().zip(Plot::opening(physics)) {
            if plot.shows_one_of(names) {
                *plot = SavedPlot::of(&first, physics);
            }
        }
    }
}

fn channel(lab: &Lab, name: &str) -> Option<usize> {
    lab.loaded.physics().named().find(|(_, channel)| channel.name == name).map(|(index, _)| index)
}
