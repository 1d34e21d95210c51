//! The contents of the pop-up lists, and the effect of choosing a line or entering a value.
//!
//! In: the loaded system, the table of methods, the table of keys. Out: menus, commands, changed plots.
//! Never here: navigation within a list.

use super::{App, Choice, Choosing, Effect, InputField, Item, Lab, Menu, Overlay, Pane, Purpose};
use crate::instrument::{Plot, offers};
use crate::integrate::METHODS;

impl App {
    pub(super) fn open_methods(&mut self) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let item = |method: &'static crate::integrate::Method| Item {
            label: method.name.to_owned(),
            about: format!("{}. {}", method.title, method.about),
            keys: String::new(),
            unavailable: (method.fits)(&lab.loaded.system).err().map(|error| error.reason),
            choice: Choice::Method(method.name),
        };
        let menu = Menu::new(
            "Method of integration",
            Choosing::Method,
            METHODS.iter().map(item).collect(),
        );
        let now = lab.method().map(Choice::Method);
        self.overlay = Some(Overlay::Menu(menu.at(now)));
        Vec::new()
    }

    pub(super) fn open_themes(&mut self) -> Vec<Effect> {
        let line = |(index, (name, about)): (usize, &(&str, &str))| {
            Item::plain(*name, *about, Choice::Theme(index))
        };
        let items: Vec<Item> = self.themes.available.iter().enumerate().map(line).collect();
        if items.is_empty() {
            return self.notify("Only one theme is available here.");
        }
        let now =
            self.themes.available.iter().position(|(name, _)| Some(*name) == self.themes.chosen);
        let menu = Menu::new("Theme", Choosing::Theme, items);
        self.overlay = Some(Overlay::Menu(menu.on(Choice::Theme(now.unwrap_or(0)))));
        Vec::new()
    }

    pub(super) fn open_axes(&mut self) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let Some((plot, shown)) = lab.focused_plot() else { return Vec::new() };
        let mut items = Vec::new();
        let mut now = None;
        for (index, (kind, offer)) in offers(lab.loaded.physics()).into_iter().enumerate() {
            let begins = shown.kind == kind
                && shown.view == offer.view
                && shown.columns.starts_with(&offer.columns);
            now = now.or(begins.then_some(Choice::Offer(index)));
            items.push(Item::plain(offer.label, offer.about, Choice::Offer(index)));
        }
        let menu =
            Menu::new("Choose a view or the horizontal axis", Choosing::Contents { plot }, items);
        self.overlay = Some(Overlay::Menu(menu.at(now)));
        Vec::new()
    }

    /// Chooses an offer for a plot; any further axes are asked for next.
    pub(super) fn take_offer(&mut self, plot: usize, index: usize) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let physics = lab.loaded.physics();
        let Some((kind, offer)) = offers(physics).into_iter().nth(index) else {
            return Vec::new();
        };
        let mut begun = Plot::new(kind, (offer.columns, offer.view), physics.model).opened(physics);
        if begun.over.is_empty() {
            begun.over = offer.over;
        }
        self.choose_on(plot, begun, offer.label)
    }

    /// Shows the new contents of a plot once all axes are chosen; otherwise asks for the next axis.
    pub(super) fn choose_on(&mut self, plot: usize, begun: Plot, label: String) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let Some(axis) = begun.kind.chosen().get(begun.columns.len()) else {
            // which axes make a plane is known once all of them are
            let begun = begun.opened(lab.loaded.physics());
            lab.redraw(plot, |plot, _| *plot = begun);
            lab.focus.pane = Pane::Plot(plot);
            return Vec::new();
        };
        let shown = lab.plots.get(plot);
        let now = shown.and_then(|shown| {
            let same = shown.kind.chosen().iter().position(|other| other.key == axis.key);
            shown.column(same?).map(Choice::Channel)
        });
        let purpose = Choosing::Axis { plot, several: axis.several };
        let menu = Menu::new(format!("{}, against {label}", axis.heading), purpose, channels(lab));
        self.overlay = Some(Overlay::Menu(Menu { begun: Some((begun, label)), ..menu.at(now) }));
        Vec::new()
    }

    /// Handles Enter in a list or a field.
    pub(super) fn accept(&mut self) -> Vec<Effect> {
        match self.overlay.take() {
            Some(Overlay::Menu(menu)) => self.accept_line(menu),
            Some(Overlay::Field(field)) => self.accept_value(field),
            Some(Overlay::Prompt(prompt)) => self.answer(prompt),
            Some(Overlay::Workbench) => {
                self.overlay = Some(Overlay::Workbench);
                self.accept_in_buffer()
            }
            Some(Overlay::Help { scroll, below, search, .. }) => {
                // An empty search shows all keys.
                let search = search.filter(|input| !input.value().trim().is_empty());
                self.overlay = Some(Overlay::Help { scroll, below, search, typing: false });
                Vec::new()
            }
            other => {
                self.overlay = other;
                if let Some(search) = self.typed_search() {
                    search.typing = false;
                    let is_empty = search.input.value().trim().is_empty();
                    self.text.search.take_if(|_| is_empty);
                }
                Vec::new()
            }
        }
    }

    fn accept_line(&mut self, menu: Menu) -> Vec<Effect> {
        let Some((_, item)) = menu.current() else {
            if let Some(effects) = self.type_axis(&menu) {
                return effects;
            }
            self.overlay = Some(Overlay::Menu(menu));
            return self.notify("No match.");
        };
        if let Some(reason) = &item.unavailable {
            let sentence = format!("{} cannot be used here: {reason}", item.label);
            self.overlay = Some(Overlay::Menu(menu));
            return self.notify(sentence);
        }
        match (menu.purpose, item.choice) {
            (_, Choice::Method(name)) => {
                self.lab.as_mut().map_or(Vec::new(), |lab| lab.integrate_by(name))
            }
            (_, Choice::Impulse(index)) => self.apply_impulse(index),
            (_, Choice::Theme(index)) => {
                self.themes.chosen = self.themes.name(index);
                Vec::new()
            }
            (_, Choice::Guide(index)) => self.take_guide(index),
            (_, Choice::Flow(index)) => self.open_field(Purpose::Flow(index)),
            (_, Choice::Generator(index)) => self.open_field(Purpose::GeneratorFlow(index)),
            (_, Choice::TypedGenerator) => self.open_field(Purpose::TypedFlow),
            (_, Choice::Symmetries) => self.find_symmetries(),
            (_, Choice::Symmetry(index)) => self.open_field(Purpose::SymmetryFlow(index)),
            (_, Choice::Equilibrium(index)) => self.begin_at_equilibrium(index, None),
            (_, Choice::Mode(index, mode)) => self.begin_at_equilibrium(index, Some(mode)),
            (_, Choice::Action(action)) => self.handle_action(action),
            (_, Choice::ActionAt(context, action)) => self.handle_action_in(context, action),
            (_, Choice::System(index)) => self.open_system(index),
            (_, Choice::Value(target)) => self.type_into(target),
            (_, Choice::Pane(pane)) => self.show_pane(pane),
            (_, Choice::Show(index)) => self.show_nearest(index),
            (Choosing::Contents { plot }, Choice::Offer(index)) => self.take_offer(plot, index),
            (Choosing::Axis { plot, .. }, Choice::Channel(_)) => {
                let channels = menu.channels();
                let Some((mut begun, label)) = menu.begun else { return Vec::new() };
                begun.columns.push(channels);
                self.choose_on(plot, begun, label)
            }
            _ => Vec::new(),
        }
    }

    fn accept_value(&mut self, mut field: InputField) -> Vec<Effect> {
        match field.purpose {
            Purpose::Ramp(index) => return self.accept_ramp(field, index),
            Purpose::Surface(plot) => return self.accept_surface(field, plot),
            Purpose::TypedFlow => return self.accept_typed_flow(field),
            _ => {}
        }
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let parameters = lab.snapshot.as_ref().map_or(Vec::new(), |s| s.parameters.to_vec());
        let value = match field.read(&lab.loaded.model, &parameters) {
            Ok(value) => value,
            Err(sentence) => {
                field.diagnostic = Some(sentence);
                self.overlay = Some(Overlay::Field(field));
                return Vec::new();
            }
        };
        match field.purpose {
            Purpose::Value(target) => {
                let range = lab.value_info(target).and_then(|value_info| {
                    let (min, max, _) = value_info.range?;
                    let sentence = format!(
                        "{} is now beyond its usual range, {min} to {max}.",
                        value_info.shown
                    );
                    Some((sentence, (min..=max).contains(&value)))
                });
                let effects = lab.change(target, value);
                match range {
                    Some((sentence, true)) => self.notifications.withdraw(&sentence),
                    Some((sentence, false)) => {
                        self.notify(sentence);
                    }
                    None => {}
                }
                effects
            }
            Purpose::Flow(index) => self.follow_flow(index, value),
            Purpose::GeneratorFlow(index) => self.follow_generator(index, value),
            Purpose::TypedFlow | Purpose::Ramp(_) | Purpose::Surface(_) => Vec::new(),
            Purpose::SymmetryFlow(index) => self.follow_symmetry(index, value),
            Purpose::Step => lab.step_by(value),
            Purpose::Tolerance => lab.tolerate(value),
        }
    }
}

/// Returns a line for each distinguishable channel.
fn channels(lab: &Lab) -> Vec<Item> {
    let named = lab.loaded.physics().named();
    named
        .map(|(index, channel)| {
            let unit = if channel.unit.is_empty() {
                String::new()
            } else {
                format!(" [{}]", channel.unit)
            };
            Item::plain(&channel.shown, format!("{}{unit}", channel.name), Choice::Channel(index))
        })
        .collect()
}
