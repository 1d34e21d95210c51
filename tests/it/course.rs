//! A lab with a motion and a pane of one kind, for tests of what the pane shows on the way.

use std::sync::Arc;

use phaselab::app::{App, AppEvent};
use phaselab::diagnostic::Document;
use phaselab::experiment::{Command, Experiment, Prepared};
use phaselab::instrument::{Ink, Layer, Picture, Plot};

use crate::fixtures::{begun, press};

pub(crate) struct Course {
    pub(crate) app: App,
    pub(crate) experiment: Experiment,
    kind: &'static str,
}

impl Course {
    /// The lab of a file with a view of a kind, over the coordinate `q` where it is over one.
    pub(crate) fn showing(kind: &'static str, text: &str) -> Course {
        let axis = if kind == "flow" { "" } else { "x = \"q\"\n" };
        let text = format!("{text}\n[[views]]\nkind = \"{kind}\"\n{axis}");
        let app = begun(&text);
        let ready =
            Prepared::of(&Document::new("test", &text)).unwrap_or_else(|why| panic!("{why}"));
        let mut experiment = ready.experiment;
        experiment.set_epoch(1);
        Course { app, experiment, kind }
    }

    pub(crate) fn go(&mut self, time: f64) {
        self.experiment.advance(time, 1_000_000);
        self.app.update(AppEvent::Snapshot(Arc::new(self.experiment.snapshot())));
        press(&mut self.app, "Wait");
    }

    pub(crate) fn set(&mut self, index: usize, value: f64) {
        self.experiment.execute(Command::Parameter { index, value });
    }

    pub(crate) fn plot(&self) -> Plot {
        let plots = &self.app.lab.as_ref().unwrap().plots;
        plots.iter().find(|plot| plot.kind.name() == self.kind).expect("a picture").clone()
    }

    pub(crate) fn measure(&self, word: &str) -> Option<f64> {
        let (lab, plot) = (self.app.lab.as_ref().unwrap(), self.plot());
        let measure = plot.kind.measure(word);
        let value = measure.expect("it is measured").value;
        value(lab.context(&plot, &lab.present().expect("a motion")))
    }

    /// A measure that has a value.
    pub(crate) fn value(&self, word: &str) -> f64 {
        self.measure(word).expect("it is measured")
    }

    pub(crate) fn layers(&self) -> Vec<Layer> {
        let (lab, plot) = (self.app.lab.as_ref().unwrap(), self.plot());
        let present = lab.present().expect("a motion");
        let picture = plot.kind.picture(lab.context(&plot, &present), [0.0, 1.0]);
        let Some(Picture::Axes { layers, .. }) = picture else { panic!("no axes") };
        layers.into_iter().map(|(_, layer)| layer).collect()
    }

    pub(crate) fn legend(&self) -> String {
        let legend = self.layers().into_iter().find_map(|layer| match layer {
            Layer::Legend(lines) => Some(lines.join("\n")),
            _ => None,
        });
        legend.expect("words")
    }

    /// The first of the curves, as they are drawn.
    pub(crate) fn curves(&self) -> Vec<Vec<[f64; 2]>> {
        let line = |layer| match layer {
            Layer::Line(points, stroke) if stroke.ink == Ink::Curve(0) => Some(points),
            _ => None,
        };
        self.layers().into_iter().filter_map(line).collect()
    }
}
