//! A prediction in the lab: begun on the plot that has its axes, and ended.
//!
//! In: a [`Prediction`]. Out: the plot and the cursor with which it is set. Never here: whether it is right.

use super::{App, Lab, Pane, Prediction};

impl Lab {
    /// The range that an axis shows at least, because something is predicted there.
    pub fn predicted_range(&self, channel: Option<usize>) -> Option<[f64; 2]> {
        let axes = &self.prediction.as_ref()?.axes;
        axes.iter().find(|axis| axis.channel == channel)?.range
    }
}

impl App {
    /// Asks for a prediction: focuses the first plot with its axes, and puts the cursor in the middle. Returns whether
    /// there is such a plot.
    pub fn begin_prediction(&mut self, mut prediction: Prediction) -> bool {
        let Some(lab) = &mut self.lab else { return false };
        let Some(index) = lab.plots.iter().position(|plot| prediction.is_on(plot)) else {
            return false;
        };
        prediction.before = Some(lab.focus.pane);
        lab.focus.choose(Pane::Plot(index));
        if let Some(viewport) = lab.plots[index].viewport_mut() {
            (viewport.zoom, viewport.pan) = ([1.0; 2], [0.0; 2]);
            viewport.put_cursor(Some([0.5; 2]));
        }
        lab.prediction = Some(Box::new(prediction));
        true
    }

    /// The coordinates of the cursor of the focused plot, as it was last drawn.
    pub fn cursor_reading(&self) -> Option<[f64; 2]> {
        self.drawn.reading
    }

    /// Takes the cursor off the plot on which something was predicted, and gives the focus back.
    pub fn end_prediction(&mut self) {
        let Some(lab) = &mut self.lab else { return };
        let Some(prediction) = &lab.prediction else { return };
        lab.focus.pane = prediction.before.unwrap_or(lab.focus.pane);
        let Some(plot) = lab.plots.iter_mut().find(|plot| prediction.is_on(plot)) else { return };
        if let Some(viewport) = plot.viewport_mut() {
            viewport.put_cursor(None);
        }
    }
}
