//! What the pop-up lists offer, and what taking a line of them or a typed value does.
//!
//! In: the loaded system, the table of methods, the table of keys. Out: menus, commands, changed plots.
//! Never here: how a list is moved in.

use super::plot::Viewport;
use super::{
    App, CameraPose, Choice, Choosing, Effect, Field, Item, Lab, Menu, Overlay, Pane, Plot, Purpose,
};
use crate::integrate::METHODS;
use crate::model::ViewKind;

impl App {
    pub(super) fn open_methods(&mut self) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let item = |method: &'static crate::integrate::Method| Item {
            label: method.name.to_owned(),
            about: format!("{}. {}", method.title, method.about),
            keys: String::new(),
            refusal: (method.fits)(&lab.loaded.system).err().map(|refusal| refusal.reason),
            choice: Choice::Method(method.name),
        };
        let menu = Menu::new(
            "Method of integration",
            Choosing::Method,
            METHODS.iter().map(item).collect(),
        );
        let now = lab.method().map(Choice::Method);
        self.overlay = Some(Overlay::Menu(match now {
            Some(now) => menu.on(now),
            None => menu,
        }));
        Vec::new()
    }

    pub(super) fn open_themes(&mut self) -> Vec<Effect> {
        let line = |(index, (name, about)): (usize, &(&str, &str))| {
            line(name, about, Choice::Theme(index))
        };
        let items: Vec<Item> = self.themes.iter().enumerate().map(line).collect();
        if items.is_empty() {
            return self.notify("There is only one theme here.");
        }
        let now = self.themes.iter().position(|(name, _)| Some(*name) == self.theme);
        let menu = Menu::new("Theme", Choosing::Theme, items);
        self.overlay = Some(Overlay::Menu(menu.on(Choice::Theme(now.unwrap_or(0)))));
        Vec::new()
    }

    pub(super) fn open_axes(&mut self) -> Vec<Effect> {
        let Some((plot, shown)) = self.lab.as_ref().and_then(Lab::focused_plot) else {
            return Vec::new();
        };
        let now = match shown {
            Plot::Space(_) => Choice::Space,
            Plot::Phase { x, .. } => Choice::Channel(*x),
            Plot::Time { .. } => Choice::Time,
            Plot::Potential { view, .. } => Choice::View(*view),
        };
        let Some(lab) = &self.lab else { return Vec::new() };
        let mut items = Vec::new();
        if !lab.loaded.model.space.is_empty() {
            items.push(line("motion in space", "the picture of the thing itself", Choice::Space));
        }
        for (index, view) in lab.loaded.model.views.iter().enumerate() {
            if let (ViewKind::Potential, Some(x), Some(y)) = (view.kind, &view.x, view.y.first()) {
                let label = format!("potential over {}", x.written);
                items.push(line(&label, &y.written, Choice::View(index)));
            }
        }
        items.push(line("t", "time, with one or several quantities upwards", Choice::Time));
        items.extend(channels(lab));
        let menu = Menu::new("Along the axis", Choosing::Across { plot }, items).on(now);
        self.overlay = Some(Overlay::Menu(menu));
        Vec::new()
    }

    fn open_upwards(&mut self, plot: usize, x: Option<usize>) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let now = match lab.plots.get(plot) {
            Some(Plot::Phase { y, .. }) => Some(*y),
            Some(Plot::Time { y, .. }) => y.first().copied(),
            _ => None,
        };
        let across = x.and_then(|x| lab.loaded.system.channels().get(x));
        let across = across.map_or("t", |channel| &channel.shown);
        let menu = Menu::new(
            format!("Upwards, against {across}"),
            Choosing::Upwards { plot, x },
            channels(lab),
        );
        self.overlay = Some(Overlay::Menu(match now {
            Some(now) => menu.on(Choice::Channel(now)),
            None => menu,
        }));
        Vec::new()
    }

    /// Enter, in a list or a field.
    pub(super) fn accept(&mut self) -> Vec<Effect> {
        match self.overlay.take() {
            Some(Overlay::Menu(menu)) => self.accept_line(menu),
            Some(Overlay::Field(field)) => self.accept_value(field),
            Some(Overlay::Prompt(prompt)) => self.answer(prompt),
            Some(Overlay::Workbench) => {
                self.overlay = Some(Overlay::Workbench);
                self.accept_in_buffer()
            }
            other => {
                self.overlay = other;
                Vec::new()
            }
        }
    }

    fn accept_line(&mut self, menu: Menu) -> Vec<Effect> {
        let Some((_, item)) = menu.current() else {
            self.overlay = Some(Overlay::Menu(menu));
            return self.notify("Nothing fits what is typed.");
        };
        if let Some(reason) = &item.refusal {
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
                self.theme = self.themes.get(index).map(|(name, _)| *name);
                Vec::new()
            }
            (_, Choice::Action(action)) => self.perform(action),
            (_, Choice::System(index)) => self.open_system(index),
            (_, Choice::Value(target)) => self.type_into(target),
            (_, Choice::Pane(pane)) => self.look_at(pane),
            (Choosing::Across { plot }, Choice::Space) => {
                self.put(plot, |lab| Plot::Space(CameraPose::for_shapes(&lab.loaded)))
            }
            (Choosing::Across { plot }, Choice::View(view)) => {
                self.put(plot, |_| Plot::Potential { view, viewport: Viewport::WHOLE })
            }
            (Choosing::Across { plot }, Choice::Time) => self.open_upwards(plot, None),
            (Choosing::Across { plot }, Choice::Channel(x)) => self.open_upwards(plot, Some(x)),
            (Choosing::Upwards { plot, x: Some(x) }, Choice::Channel(y)) => {
                self.put(plot, |_| Plot::Phase { x, y, viewport: Viewport::WHOLE })
            }
            (Choosing::Upwards { plot, x: None }, Choice::Channel(_)) => {
                self.put(plot, |_| Plot::Time { y: menu.channels(), viewport: Viewport::WHOLE })
            }
            _ => Vec::new(),
        }
    }

    fn put(&mut self, plot: usize, make: impl FnOnce(&Lab) -> Plot) -> Vec<Effect> {
        if let Some(lab) = &mut self.lab {
            let new = make(lab);
            lab.redraw(plot, |plot, _| *plot = new);
            lab.focus = Pane::Plot(plot);
        }
        Vec::new()
    }

    fn accept_value(&mut self, mut field: Field) -> Vec<Effect> {
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let parameters = lab.snapshot.as_ref().map_or(Vec::new(), |s| s.parameters.to_vec());
        let value = match field.read(&lab.loaded.model, &parameters) {
            Ok(value) => value,
            Err(sentence) => {
                field.mistake = Some(sentence);
                self.overlay = Some(Overlay::Field(field));
                return Vec::new();
            }
        };
        match field.purpose {
            Purpose::Value(target) => {
                let beyond = lab.value_info(target).and_then(|value_info| {
                    let (min, max, _) = value_info.range?;
                    let outside = !(min..=max).contains(&value);
                    outside.then(|| {
                        format!(
                            "{} is now beyond its usual range, {min} to {max}.",
                            value_info.shown
                        )
                    })
                });
                let effects = lab.change(target, value);
                if let Some(sentence) = beyond {
                    self.notify(sentence);
                }
                effects
            }
            Purpose::Step => lab.step_by(value),
            Purpose::Tolerance => lab.tolerate(value),
        }
    }
}

fn line(label: &str, about: &str, choice: Choice) -> Item {
    Item {
        label: label.to_owned(),
        about: about.to_owned(),
        keys: String::new(),
        refusal: None,
        choice,
    }
}

/// A line for every channel that can be told from the others.
fn channels(lab: &Lab) -> Vec<Item> {
    let all = lab.loaded.system.channels();
    let named =
        all.iter().enumerate().filter(|(_, channel)| !channel.name.is_empty()).filter(
            |(index, channel)| !all[..*index].iter().any(|before| before.name == channel.name),
        );
    named
        .map(|(index, channel)| {
            let unit = if channel.unit.is_empty() {
                String::new()
            } else {
                format!(" [{}]", channel.unit)
            };
            line(&channel.shown, &format!("{}{unit}", channel.name), Choice::Channel(index))
        })
        .collect()
}
