//! `angle`: the angle variable w of a coordinate over the time, and how far it is from growing evenly, w₀ + ν (t − t₀).
//!
//! The job finds J, ν and w of the motion as it is now, again after a part of a period. w is a quadrature over places and ν the
//! time of a return, so that the line is no consequence of how the points were found. Of a law that depends on the time w is
//! that of the system frozen at the instant, and grows with the ν of that instant; there is no line. Never here: how they are
//! computed (`action_angle`).
//! Source: *The Principles of Dynamics*, § 4.2.

use std::sync::Arc;

use super::motion_state::{self, CoordinateState, FrozenCourse};
use super::{
    Across, Answer, Axis, Entry, Heading, Ink, Instrument, Layer, Level, MarkerShape, Measure,
    Need, Offer, Physics, Picture, Plot, PlotContext, Present, Properties, Upwards,
};
use crate::action_angle::AngleAtTime;
use crate::job::{Job, Progress};
use crate::num::significant;

const LINE: Level = 0;
const POINTS: Level = 1;
const NOW: Level = 2;

/// The part of a period after which the angle is evaluated again.
const OF_A_PERIOD: f64 = 1.0 / 24.0;

/// So many points are kept; beyond, every other one is left out.
const MOST: usize = 2000;

pub(super) struct AnglePlot;

struct ComputedAngle {
    course: FrozenCourse<AngleAtTime>,
    /// Why there is no angle now.
    lost: Option<String>,
}

const PROPERTIES: Properties = Properties {
    name: "angle",
    written: &[Axis { heading: "Coordinate", coordinate: true, ..Axis::ACROSS }],
    is_over_time: true,
    measures: &[
        Measure::new(
            "angle",
            "the angle variable of the motion, in turns from 0 to 1",
            |context| Some(computed(context.answer)?.course.past.last()?.angle.rem_euclid(1.0)),
        ),
        Measure::new("frequency", "its frequency ν = dE/dJ", |context| {
            Some(computed(context.answer)?.course.past.last()?.frequency)
        }),
        Measure::new("action", "∮ p dq of the motion", |context| {
            Some(computed(context.answer)?.course.past.last()?.action)
        }),
        Measure::new(
            "residual",
            "the largest |w − w₀ − ν (t − t₀)| so far, in turns",
            |context| computed(context.answer)?.residual().map(|[_, largest]| largest),
        ),
    ],
    ..Properties::PLAIN
};

impl Instrument for AnglePlot {
    fn properties(&self) -> &'static Properties {
        &PROPERTIES
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let about = "w over the time, and how far it is from growing evenly";
        motion_state::offers(physics, "angle variable", about)
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

    fn across(&self, PlotContext { present, answer, .. }: PlotContext<'_>) -> Across {
        let start = present.physics.model.run.start;
        let past = computed(answer).map_or(&[][..], |computed| &computed.course.past[..]);
        let first = past.first().map_or(start, |first| first.time);
        let period = past.last().map_or(1.0, |last| 1.0 / last.frequency);
        Across::Times([first, present.time.max(first + period)])
    }

    fn awaits(&self, PlotContext { answer, .. }: PlotContext<'_>) -> Option<String> {
        match computed(answer) {
            None => Some(
                "The angle variable w against time, a straight line where J is constant. It is being \
                 computed."
                    .to_owned(),
            ),
            Some(computed) if computed.course.past.is_empty() => {
                computed.lost.clone().or_else(|| computed.course.frozen.as_ref().err().cloned())
            }
            Some(_) => None,
        }
    }

    fn picture(
        &self,
        PlotContext { answer, .. }: PlotContext<'_>,
        [_, to]: [f64; 2],
    ) -> Option<Picture> {
        let mut layers = Vec::new();
        let mut top = 1.0_f64;
        if let Some(computed) = computed(answer) {
            if let Some(line) = computed.line() {
                let first = computed.course.past[0];
                let ends = [first.time, to].map(|time| [time, line(time)]);
                layers.push((LINE, Layer::Line(ends.to_vec(), Ink::Level.into())));
            }
            let points: Vec<[f64; 2]> =
                computed.course.past.iter().map(|moment| [moment.time, moment.angle]).collect();
            top = points.iter().map(|at| at[1]).fold(top, f64::max);
            if let Some(&now) = points.last() {
                layers.push((NOW, Layer::Point(now, MarkerShape::Disc, Ink::Accent)));
            }
            layers.push((POINTS, Layer::Points(Arc::new(points), Ink::Curve(0))));
        }
        layers.push((NOW, Layer::Legend(sentences(answer))));
        let upwards = Upwards::Named("w".to_owned(), [0.0, top]);
        Some(Picture::Axes { upwards, layers, occurrences: None })
    }

    fn job(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Need {
        let Some(state) = CoordinateState::of(plot, present) else { return Need::Nothing };
        let known = computed(answer);
        if known.is_some_and(|known| known.course.leads_to(&state) && known.holds_at(state.time)) {
            return Need::Valid;
        }
        let known = known.map(|known| known.course.clone());
        let model = Arc::clone(present.physics.model);
        Need::Job(Job::new("angle", move |progress: &Progress| {
            let known = known.as_ref();
            let mut course = FrozenCourse::continued(known, &state, &model, progress, |m| m.time);
            let CoordinateState { time, parameters, positions, momenta, .. } = &state;
            let found = course.frozen.as_ref().map_err(Clone::clone).and_then(|frozen| {
                AngleAtTime::of(frozen, *time, parameters, [positions, momenta])
            });
            let lost = match found {
                Ok(found) => {
                    course.past.push(found.after(course.past.last()));
                    None
                }
                Err(why) => Some(why),
            };
            if course.past.len() > MOST {
                course.past = course.past.into_iter().step_by(2).collect();
            }
            Answer::new(ComputedAngle { course, lost })
        }))
    }
}

impl ComputedAngle {
    fn holds_at(&self, time: f64) -> bool {
        let FrozenCourse { state, frozen, past, .. } = &self.course;
        if frozen.is_err() {
            return true;
        }
        let period = past.last().map_or(0.0, |last| 1.0 / last.frequency);
        state.time <= time && time - state.time <= OF_A_PERIOD * period && self.lost.is_none()
            || state.time == time
    }

    /// w₀ + ν (t − t₀), unless the law depends on the time.
    fn line(&self) -> Option<impl Fn(f64) -> f64 + use<>> {
        let first = *self.course.past.first()?;
        (!self.course.moves()).then_some(move |time| first.even(time))
    }

    /// How far w is from it now, and at most so far.
    fn residual(&self) -> Option<[f64; 2]> {
        let line = self.line()?;
        let past = &self.course.past;
        let off = |moment: &AngleAtTime| moment.angle - line(moment.time);
        let largest = past.iter().map(|moment| off(moment).abs()).fold(0.0, f64::max);
        Some([off(past.last()?), largest])
    }
}

fn computed(answer: Option<&Answer>) -> Option<&ComputedAngle> {
    answer?.of::<ComputedAngle>()
}

/// What is said of the angle, or why there is none.
fn sentences(answer: Option<&Answer>) -> Vec<String> {
    let Some(computed) = computed(answer) else { return vec!["being computed".to_owned()] };
    let short = |x: f64, digits| significant(x, digits, 1e-3..1e5).replace('-', "−");
    let mut lines = Vec::new();
    match (&computed.course.frozen, &computed.lost, computed.course.past.last()) {
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
        None if !computed.course.past.is_empty() => {
            lines.push("the law depends on the time: ν is that of this instant".to_owned());
        }
        None => {}
    }
    lines
}
