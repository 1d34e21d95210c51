//! When the landscape of the energy is surveyed: for a plane of one degree of freedom that is shown, anew only where
//! a parameter changed or the motion left the window.
//!
//! In: the lab and a snapshot. Out: surveyed planes. Never here: how it is surveyed or drawn.

use super::Lab;
use super::plot::Plot;
use crate::analysis::{Landscape, Plane};
use crate::experiment::Snapshot;
use crate::system::{ChannelKind, Form, System};

/// A landscape and what it was surveyed for.
#[derive(Clone, Debug)]
pub(super) struct Survey {
    form: Form,
    landscape: Landscape,
    parameters: Vec<f64>,
    motion: [[f64; 2]; 2],
    periodic: bool,
}

/// The landscapes of all planes that the lab shows.
pub(super) fn surveyed(lab: &Lab, snapshot: &Snapshot) -> Vec<Survey> {
    let (system, equations) = (&lab.loaded.system, &lab.loaded.equations);
    let time = lab.loaded.model.symbols.time;
    // With more degrees of freedom the plane is a shadow of phase space; with explicit time its curves would move.
    if system.degrees() != 1 || equations.pool.depends(equations.energy, time) {
        return Vec::new();
    }
    let mut found: Vec<Survey> = Vec::new();
    for plot in &lab.plots {
        let Some((form, channels)) = plane(system, plot) else { continue };
        if found.iter().any(|l| l.form == form) {
            continue;
        }
        let bounds = |channel: usize| snapshot.bounds.get(channel).map(|(lo, hi)| [*lo, *hi]);
        let Some((x, y)) = bounds(channels[0]).zip(bounds(channels[1])) else { continue };
        let old = lab.surveys.iter().find(|l| l.form == form);
        let kept = old.filter(|l| l.still_holds(snapshot, [x, y])).cloned();
        let new = || {
            let parameters = &snapshot.parameters;
            let period = system.period(channels[0], parameters);
            let plane = Plane { system, parameters, time: snapshot.time, form, period };
            Some(Survey {
                form,
                landscape: Landscape::survey(&plane, [x, y])?,
                parameters: parameters.to_vec(),
                motion: [x, y],
                periodic: period.is_some(),
            })
        };
        found.extend(kept.or_else(new));
    }
    found
}

impl Lab {
    /// The landscape behind a plot, if it shows a plane that has one.
    pub fn landscape(&self, plot: &Plot) -> Option<&Landscape> {
        let (form, _) = plane(&self.loaded.system, plot)?;
        self.surveys.iter().find(|survey| survey.form == form).map(|survey| &survey.landscape)
    }
}

/// The form of the phase plane that a plot shows, and its channels.
fn plane(system: &System, plot: &Plot) -> Option<(Form, [usize; 2])> {
    let Plot::Phase { x, y, .. } = plot else { return None };
    let kind = |channel: usize| system.channels().get(channel).map(|c| c.kind);
    match (kind(*x)?, kind(*y)?) {
        (ChannelKind::Position(0), ChannelKind::Velocity(0)) => Some((Form::Velocity, [*x, *y])),
        (ChannelKind::Position(0), ChannelKind::Momentum(0)) => Some((Form::Momentum, [*x, *y])),
        _ => None,
    }
}

impl Survey {
    /// Whether the parameters are the same and the motion neither left the window nor shrank to a small part of it.
    /// A periodic coordinate wraps, and its window stays.
    fn still_holds(&self, snapshot: &Snapshot, motion: [[f64; 2]; 2]) -> bool {
        let held = |axis: usize| {
            let [lo, hi] = motion[axis];
            let [from, to] = self.landscape.window[axis];
            let before = self.motion[axis];
            lo >= from && hi <= to && (hi - lo) >= 0.3 * (before[1] - before[0])
        };
        *self.parameters == *snapshot.parameters && (self.periodic || held(0)) && held(1)
    }
}
