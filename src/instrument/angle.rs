//! `angle`: the angle variable w of a coordinate over the time, and how far it is from growing evenly, w₀ + ν (t − t₀).
//!
//! The job finds J, ν and w of the motion as it is now, again after a part of a period. w is a quadrature over places and ν the
//! time of a return, so that the line is no consequence of how the points were found. Of a law that depends on the time w is
//! that of the system held at the instant, and grows with the ν of that instant; there is no line. Never here: how they are
//! computed (`action_angle`).
//! Source: *The Principles of Dynamics*, § 4.2.

use std::sync::Arc;

use super::motion_state::MotionState;
use super::{
    Across, Answer, Axis, Entry, Heading, Ink, Instrument, Layer, Level, Measure, Need, Offer,
    Physics, Picture, Plot, Present, Sign, Upwards,
};
use crate::action_angle::{AngleMoment, HeldSystem};
use crate::integrate::Settings;
use crate::job::{Job, Progress};
use crate::num::significant;

/// The levels of the picture.
const LINE: Level = 0;
const POINTS: Level = 1;
const NOW: Level = 2;

/// The part of a period after which the angle is looked at again.
const OF_A_PERIOD: f64 = 1.0 / 24.0;

/// So many points are kept; beyond, every other one is left out.
const MOST: usize = 2000;

/// The settings of the motions by which returns are located: more digits than a picture has.
const SETTINGS: Settings = Settings { step: None, tolerance: Some(1e-15) };

/// The row.
pub(super) struct AnglePlot;

/// What was found, and of what.
struct Computed {
    coordinate: usize,
    parameters: Vec<f64>,
    initial: Vec<f64>,
    time: f64,
    held: Result<Arc<HeldSystem>, String>,
    /// Why there is no angle now.
    lost: Option<String>,
    past: Vec<AngleMoment>,
}

impl Instrument for AnglePlot {
    fn name(&self) -> &'static str {
        "angle"
    }

    fn written(&self) -> &'static [Axis] {
        const { &[Axis { heading: "Coordinate", coordinate: true, ..Axis::ACROSS }] }
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let model = physics.model;
        if model.is_poisson() || !model.constraints.is_empty() {
            return Vec::new();
        }
        let offer = |(index, channel): (usize, usize)| Offer {
            label: format!("angle variable of {}", model.coordinates[index].shown),
            about: "w over the time, and how far it is from growing evenly".to_owned(),
            columns: vec![vec![channel]],
            view: None,
            over: Vec::new(),
        };
        physics.positions().map(offer).collect()
    }

    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String {
        let name = plot.column(0).map_or("?", |channel| physics.shown(channel));
        format!("angle variable of {name}")
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let channel = plot.column(0)?;
        let name = present.physics.shown(channel);
        let entries = vec![
            Entry::Words(format!("w = ∂S/∂J, J = ∮ p d{name}, in turns")),
            Entry::Channel(channel),
        ];
        Some(plot.heading(present.physics, "Angle variable", entries))
    }

    fn across(&self, _plot: &Plot, present: &Present<'_>, answer: Option<&Answer>) -> Across {
        let start = present.physics.model.run.start;
        let past = computed(answer).map_or(&[][..], |computed| &computed.past[..]);
        let first = past.first().map_or(start, |first| first.time);
        let period = past.last().map_or(1.0, |last| 1.0 / last.frequency);
        Across::Times([first, present.time.max(first + period)])
    }

    fn picture(
        &self,
        _plot: &Plot,
        _present: &Present<'_>,
        [_, to]: [f64; 2],
        answer: Option<&Answer>,
    ) -> Option<Picture> {
        let mut layers = Vec::new();
        let mut top = 1.0_f64;
        if let Some(computed) = computed(answer) {
            if let Some(line) = computed.line() {
                let first = computed.past[0];
                let ends = [first.time, to].map(|time| [time, line(time)]);
                layers.push((LINE, Layer::Line(ends.to_vec(), Ink::Level.into())));
            }
            let points: Vec<[f64; 2]> =
                computed.past.iter().map(|moment| [moment.time, moment.angle]).collect();
            top = points.iter().map(|at| at[1]).fold(top, f64::max);
            if let Some(&now) = points.last() {
                layers.push((NOW, Layer::Point(now, Sign::Disc, Ink::Accent)));
            }
            layers.push((POINTS, Layer::Points(Arc::new(points), Ink::Curve(0))));
        }
        layers.push((NOW, Layer::Legend(sentences(answer))));
        let upwards = Upwards::Named("w".to_owned(), [0.0, top]);
        Some(Picture::Axes { upwards, layers, occurrences: None })
    }

    fn job(&self, plot: &Plot, present: &Present<'_>, answer: Option<&Answer>) -> Need {
        let Some(state) = MotionState::of(plot, present) else { return Need::Nothing };
        let MotionState { coordinate, time, parameters, initial, positions, momenta } = state;
        let known = computed(answer).filter(|known| known.coordinate == coordinate);
        let same = known.filter(|known| known.parameters == parameters && known.initial == initial);
        if same.is_some_and(|known| known.holds_at(time)) {
            return Need::Held;
        }
        let held = known.map(|known| known.held.clone());
        let past = same.map_or_else(Vec::new, |known| known.past.clone());
        let model = Arc::clone(present.physics.model);
        Need::Job(Job::new("angle", move |progress: &Progress| {
            let held = held.clone().unwrap_or_else(|| {
                HeldSystem::of(&model, coordinate, SETTINGS, progress.token())
                    .map(Arc::new)
                    .map_err(|why| why.to_string())
            });
            let found = held
                .as_ref()
                .map_err(Clone::clone)
                .and_then(|held| AngleMoment::of(held, time, &parameters, [&positions, &momenta]));
            let mut past: Vec<AngleMoment> =
                past.iter().copied().filter(|moment| moment.time < time).collect();
            let lost = match found {
                Ok(found) => {
                    past.push(found.after(past.last()));
                    None
                }
                Err(why) => Some(why),
            };
            if past.len() > MOST {
                past = past.into_iter().step_by(2).collect();
            }
            let (parameters, initial) = (parameters.clone(), initial.clone());
            Answer::new(Computed { coordinate, parameters, initial, time, held, lost, past })
        }))
    }

    fn measures(&self) -> &'static [Measure] {
        &[
            Measure {
                word: "angle",
                about: "the angle variable of the motion, in turns from 0 to 1",
                value: |_, _, answer| Some(computed(answer)?.past.last()?.angle.rem_euclid(1.0)),
            },
            Measure {
                word: "frequency",
                about: "its frequency ν = dE/dJ",
                value: |_, _, answer| Some(computed(answer)?.past.last()?.frequency),
            },
            Measure {
                word: "action",
                about: "∮ p dq of the motion",
                value: |_, _, answer| Some(computed(answer)?.past.last()?.action),
            },
            Measure {
                word: "residual",
                about: "the largest |w − w₀ − ν (t − t₀)| so far, in turns",
                value: |_, _, answer| computed(answer)?.residual().map(|[_, largest]| largest),
            },
        ]
    }
}

impl Computed {
    /// Whether it is still what is to be seen at a time.
    fn holds_at(&self, time: f64) -> bool {
        if self.held.is_err() {
            return true;
        }
        let period = self.past.last().map_or(0.0, |last| 1.0 / last.frequency);
        self.time <= time && time - self.time <= OF_A_PERIOD * period && self.lost.is_none()
            || self.time == time
    }

    /// w₀ + ν (t − t₀), unless the law depends on the time.
    fn line(&self) -> Option<impl Fn(f64) -> f64 + use<>> {
        let first = *self.past.first()?;
        let still = self.held.as_ref().is_ok_and(|held| !held.depends_on_time());
        still.then_some(move |time| first.even(time))
    }

    /// How far w is from it now, and at most so far.
    fn residual(&self) -> Option<[f64; 2]> {
        let line = self.line()?;
        let off = |moment: &AngleMoment| moment.angle - line(moment.time);
        let largest = self.past.iter().map(|moment| off(moment).abs()).fold(0.0, f64::max);
        Some([off(self.past.last()?), largest])
    }
}

fn computed(answer: Option<&Answer>) -> Option<&Computed> {
    answer?.of::<Computed>()
}

/// What is said of the angle, or why there is none.
fn sentences(answer: Option<&Answer>) -> Vec<String> {
    let Some(computed) = computed(answer) else { return vec!["being computed".to_owned()] };
    let short = |x: f64, digits| significant(x, digits, 1e-3..1e5).replace('-', "−");
    let mut lines = Vec::new();
    match (&computed.held, &computed.lost, computed.past.last()) {
        (Err(why), _, _) | (_, Some(why), _) => lines.push(why.clone()),
        (_, _, Some(now)) => {
            let [action, frequency] = [now.action, now.frequency].map(|x| short(x, 5));
            lines.push(format!("J = {action}, ν = dE/dJ = {frequency}"));
        }
        (_, _, None) => {}
    }
    match computed.residual() {
        Some([now, largest]) => {
            lines.push(format!("w − w₀ − ν (t − t₀) = {}", short(now, 2)));
            lines.push(format!("at most {} of a turn", short(largest, 2)));
        }
        None if !computed.past.is_empty() => {
            lines.push("the law depends on the time: ν is that of this instant".to_owned());
        }
        None => {}
    }
    lines
}
