//! What a session saves of a plot.
//!
//! In: plots, and plots as saved. Out: [`SavedPlot`]s, and the plots that they are in a system. Never here: files.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{CameraPose, MOST_SEEDS, Physics, Plot, Seed, Sight, Viewport, named};
use super::{Instrument, varied};
use crate::model::{Model, Variation};
use crate::system::Channel;

/// A plot as saved in a session, with quantities by name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedPlot {
    /// The kind's name.
    pub kind: String,
    /// The index of the view of the file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub view: Option<usize>,
    /// What it runs over.
    #[serde(default, skip_serializing_if = "SavedVariations::is_empty")]
    pub over: SavedVariations,
    /// The camera, if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub eye: Option<CameraPose>,
    /// The window on its axes, if it has axes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[serde(rename = "lens")]
    pub viewport: Option<Viewport>,
    /// The orbits added to a section.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub seeds: Vec<Seed>,
    /// The quantities chosen for each axis, by the axis's key.
    #[serde(flatten)]
    pub axes: BTreeMap<String, Chosen>,
}

/// What a plot runs over, by name: a parameter, or the coordinate, velocity or momentum of an initial value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum SavedVariations {
    /// One of them.
    One(String),
    /// More than one, or none.
    Several(Vec<String>),
}

impl Default for SavedVariations {
    fn default() -> Self {
        Self::Several(Vec::new())
    }
}

impl SavedVariations {
    fn of(plot: &Plot, physics: Physics<'_>) -> Self {
        let mut names: Vec<String> =
            plot.over.iter().map(|&over| varied::written(physics, over).to_owned()).collect();
        match &mut names[..] {
            [only] => Self::One(std::mem::take(only)),
            _ => Self::Several(names),
        }
    }

    fn is_empty(&self) -> bool {
        matches!(self, Self::Several(names) if names.is_empty())
    }

    /// What they are in a system, if all are there.
    fn place(&self, physics: Physics<'_>) -> Option<Vec<Variation>> {
        let names = match self {
            Self::One(name) => std::slice::from_ref(name),
            Self::Several(names) => &names[..],
        };
        let parameters = (0..physics.model.parameters.len()).map(Variation::Parameter);
        let all: Vec<Variation> =
            parameters.chain((0..physics.model.moving()).map(Variation::Initial)).collect();
        let known = |name: &String| {
            all.iter().find(|&&over| varied::written(physics, over) == name).copied()
        };
        names.iter().map(known).collect()
    }
}

/// The quantities chosen for an axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Chosen {
    /// For an axis that takes one quantity.
    One(Quantity),
    /// For an axis that takes several.
    Several(Vec<Quantity>),
}

/// A channel by its name, or by its index if it has none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quantity {
    name: String,
    place: usize,
}

impl SavedPlot {
    /// Converts a plot for saving.
    pub fn of(plot: &Plot, physics: Physics<'_>) -> Self {
        let quantity = |&place: &usize| {
            let channel = physics.system.channels().get(place);
            Quantity { name: channel.map_or_else(String::new, |c| c.name.clone()), place }
        };
        let axes = plot.kind.chosen().iter().zip(&plot.columns).filter_map(|(axis, column)| {
            let mut quantities = column.iter().map(quantity);
            let chosen = if axis.several {
                Chosen::Several(quantities.collect())
            } else {
                Chosen::One(quantities.next()?)
            };
            Some((axis.key.to_owned(), chosen))
        });
        Self {
            kind: plot.kind.name().to_owned(),
            view: plot.view,
            over: SavedVariations::of(plot, physics),
            eye: plot.eye(),
            viewport: plot.viewport(),
            seeds: plot.seeds.clone(),
            axes: axes.collect(),
        }
    }

    /// Whether a quantity of one of these names is on an axis.
    pub fn shows_one_of(&self, names: &[String]) -> bool {
        let chosen = self.axes.values().flat_map(|chosen| match chosen {
            Chosen::One(quantity) => std::slice::from_ref(quantity),
            Chosen::Several(all) => &all[..],
        });
        chosen.into_iter().any(|quantity| names.contains(&quantity.name))
    }

    /// The plot in a system, or `None` if the system lacks something that it shows.
    pub fn place(&self, physics: Physics<'_>) -> Option<Plot> {
        let (model, channels) = (physics.model, physics.system.channels());
        let kind = named(&self.kind)?;
        let channel = |quantity: &Quantity| {
            let named = |c: &Channel| c.name == quantity.name;
            match quantity.name.as_str() {
                "" => Some(quantity.place).filter(|&i| channels.get(i).is_some_and(named)),
                _ => channels.iter().position(named),
            }
        };
        let column = |key: &str| -> Option<Vec<usize>> {
            let found: Vec<usize> = match self.axes.get(key)? {
                Chosen::One(quantity) => channel(quantity).into_iter().collect(),
                Chosen::Several(all) => all.iter().filter_map(channel).collect(),
            };
            (!found.is_empty()).then_some(found)
        };
        let columns = kind.chosen().iter().map(|axis| column(axis.key)).collect::<Option<_>>()?;
        let sight = match (kind.properties().is_scene, self.eye, self.viewport) {
            (true, Some(eye), _) => {
                let framed = eye.frame.is_none_or(|frame| frame < model.frames.len());
                let viewed = eye.view.is_none_or(|view| is_view_of(model, view, kind));
                let fits = framed && viewed && !eye.shapes(model).is_empty();
                fits.then_some(Sight::Camera(eye))?
            }
            (false, _, Some(viewport)) => Sight::Axes(viewport),
            _ => return None,
        };
        let view = self.view.filter(|_| kind.properties().shows_a_view);
        let shown = view.map(|view| model.views.get(view).ok_or(())).transpose().ok()?;
        let over = self.over.place(physics)?;
        if !kind.shows(shown) {
            return None;
        }
        let finite = |seed: &Seed| match seed {
            Seed::Spread(window) | Seed::Fill(window) => {
                window.as_flattened().iter().all(|x| x.is_finite())
            }
            Seed::Through(point) => point.iter().all(|x| x.is_finite()),
            Seed::Shell => true,
        };
        let seeds: Vec<Seed> =
            self.seeds.iter().filter(|seed| finite(seed)).take(MOST_SEEDS).copied().collect();
        Some(Plot { kind, columns, view, over, sight, seeds })
    }
}

fn is_view_of(model: &Model, view: usize, kind: &dyn Instrument) -> bool {
    model.views.get(view).is_some_and(|view| view.kind == kind.name())
}
