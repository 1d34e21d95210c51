//! `space`: the motion in space, the shapes of the file through a camera.

use super::{
    Across, Columns, Entry, Heading, Instrument, Offer, Physics, Picture, Plot, PlotContext,
    Present, Properties,
};

pub(super) struct Space;

const PROPERTIES: Properties = Properties { name: "space", is_scene: true, ..Properties::PLAIN };

impl Instrument for Space {
    fn properties(&self) -> &'static Properties {
        &PROPERTIES
    }

    fn opening(&self, physics: Physics<'_>) -> Vec<Columns> {
        if physics.model.picture.shapes.is_empty() { Vec::new() } else { vec![Vec::new()] }
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let offer = |columns| Offer::new("motion in space", "the system in space", columns);
        self.opening(physics).into_iter().map(offer).collect()
    }

    fn words(&self, _plot: &Plot, _physics: Physics<'_>) -> String {
        "motion in space".to_owned()
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let (eye, model) = (plot.eye()?, present.physics.model);
        let view = eye.view.and_then(|view| model.views.get(view));
        // A view's title applies only to the frame that the file gives it.
        let own = view.filter(|view| view.frame == eye.frame && !view.title.is_empty());
        let frame = eye.frame.and_then(|frame| model.frames.get(frame));
        let seen = |name: &str| Entry::Words(format!("seen from {name}"));
        Some(match own {
            Some(view) => Heading { title: view.title.clone(), given: true, entries: Vec::new() },
            None => Heading {
                title: "Motion".to_owned(),
                given: false,
                entries: frame.map(|frame| seen(&frame.name)).into_iter().collect(),
            },
        })
    }

    fn across(&self, _context: PlotContext<'_>) -> Across {
        Across::Nothing
    }

    fn picture(&self, context: PlotContext<'_>, _seen: [f64; 2]) -> Option<Picture> {
        context.plot.eye().map(Picture::Scene)
    }
}
