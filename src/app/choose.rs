//! What the pop-up lists offer, and what taking a line of them or a typed value does.
//!
//! In: the loaded system, the table of methods, the table of keys. Out: menus, commands, changed plots.
//! Never here: how a list is moved in.

use super::plot::Lens;
use super::{
    App, Choice, Choosing, Effect, Eye, Field, Item, Lab, Menu, Over, Pane, Plot, Purpose,
};
use crate::experiment::Command;
use crate::integrate::{METHODS, Stepping};
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
        let now = lab.snapshot.as_ref().map(|s| Choice::Method(s.method.name));
        self.over = Some(Over::Menu(match now {
            Some(now) => menu.on(now),
            None => menu,
        }));
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
        self.over = Some(Over::Menu(menu));
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
        self.over = Some(Over::Menu(match now {
            Some(now) => menu.on(Choice::Channel(now)),
            None => menu,
        }));
        Vec::new()
    }

    /// Enter, in a list or a field.
    pub(super) fn accept(&mut self) -> Vec<Effect> {
        match self.over.take() {
            Some(Over::Menu(menu)) => self.accept_line(menu),
            Some(Over::Field(field)) => self.accept_value(field),
            Some(Over::Prompt(prompt)) => self.answer(prompt),
            Some(Over::Workbench) => {
                self.over = Some(Over::Workbench);
                self.accept_at_bench()
            }
            other => {
                self.over = other;
                Vec::new()
            }
        }
    }

    fn accept_line(&mut self, menu: Menu) -> Vec<Effect> {
        let Some((_, item)) = menu.current() else {
            self.over = Some(Over::Menu(menu));
            return self.say("Nothing fits what is typed.");
        };
        if let Some(reason) = &item.refusal {
            let sentence = format!("{} cannot be used here: {reason}", item.label);
            self.over = Some(Over::Menu(menu));
            return self.say(sentence);
        }
        match (menu.purpose, item.choice) {
            (_, Choice::Method(name)) => vec![Effect::Tell(Command::Method(name.to_owned()))],
            (_, Choice::Blow(index)) => self.strike_by(index),
            (_, Choice::Action(action)) => self.perform(action),
            (_, Choice::System(index)) => self.open_system(index),
            (_, Choice::Value(target)) => self.type_into(target),
            (_, Choice::Pane(pane)) => self.look_at(pane),
            (Choosing::Across { plot }, Choice::Space) => {
                self.put(plot, |lab| Plot::Space(Eye::for_shapes(&lab.loaded)))
            }
            (Choosing::Across { plot }, Choice::View(view)) => {
                self.put(plot, |_| Plot::Potential { view, lens: Lens::WHOLE })
            }
            (Choosing::Across { plot }, Choice::Time) => self.open_upwards(plot, None),
            (Choosing::Across { plot }, Choice::Channel(x)) => self.open_upwards(plot, Some(x)),
            (Choosing::Upwards { plot, x: Some(x) }, Choice::Channel(y)) => {
                self.put(plot, |_| Plot::Phase { x, y, lens: Lens::WHOLE })
            }
            (Choosing::Upwards { plot, x: None }, Choice::Channel(_)) => {
                self.put(plot, |_| Plot::Time { y: menu.channels(), lens: Lens::WHOLE })
            }
            _ => Vec::new(),
        }
    }

    fn put(&mut self, plot: usize, make: impl FnOnce(&Lab) -> Plot) -> Vec<Effect> {
        if let Some(lab) = &mut self.lab {
            let new = make(lab);
            if let Some(place) = lab.plots.get_mut(plot) {
                *place = new;
                lab.focus = Pane::Plot(plot);
            }
            // A plane that was not shown before needs its landscape.
            if let Some(snapshot) = lab.snapshot.clone() {
                lab.see(snapshot);
            }
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
                self.over = Some(Over::Field(field));
                return Vec::new();
            }
        };
        match field.purpose {
            Purpose::Value(target) => {
                let beyond = lab.facts(target).and_then(|facts| {
                    let (min, max, _) = facts.range?;
                    let outside = !(min..=max).contains(&value);
                    outside.then(|| {
                        format!("{} is now beyond its usual range, {min} to {max}.", facts.shown)
                    })
                });
                let effects = lab.change(target, value);
                if let Some(sentence) = beyond {
                    self.say(sentence);
                }
                effects
            }
            Purpose::Step => {
                let name = lab.snapshot.as_ref().map_or("", |s| s.method.name);
                let adaptive =
                    METHODS.iter().any(|m| m.name == name && m.stepping == Stepping::Adaptive);
                if adaptive {
                    self.say(format!(
                        "{name} chooses its own steps; this one is for methods of fixed step."
                    ));
                }
                vec![Effect::Tell(Command::StepSize(value))]
            }
            Purpose::Tolerance => vec![Effect::Tell(Command::Tolerance(value))],
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
