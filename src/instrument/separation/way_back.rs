//! The way back of a motion whose time was reversed: the distance from the run before, and what is expected of it.
//!
//! In: the present, the growth of errors as the job of the picture has found it. Out: heading and picture. Never here: how
//! time is reversed.

use std::sync::Arc;

use super::super::{
    Answer, Entry, Heading, Ink, Layer, Level, Need, Physics, Picture, PlotContext, Returned,
    Stroke, Upwards,
};
use crate::dynamics::{PhaseSpace, ReturnGrowth, growth_after, return_growth};
use crate::integrate::{Settings, method_named};
use crate::job::Job;
use crate::num::significant;
use crate::system::State;

const LINE: Level = 2;

/// The pieces of the line of what is expected.
const PARTS: u32 = 60;

/// What the growth of errors depends on.
#[derive(Clone, PartialEq)]
struct WayConditions {
    parameters: Vec<f64>,
    turned: Arc<State>,
    start: f64,
    method: &'static str,
    settings: Settings,
}

/// The growth of errors on a way back; `None` where derivatives are not known on it.
struct ComputedGrowth {
    conditions: WayConditions,
    growth: Option<Vec<ReturnGrowth>>,
}

/// What is to be computed: the growth of errors along the way back.
pub(super) fn job(PlotContext { present, answer, .. }: PlotContext<'_>) -> Need {
    let Some((turned, start)) = present.turned else { return Need::Nothing };
    let Some(method) = method_named(present.method) else { return Need::Nothing };
    let conditions = WayConditions {
        parameters: present.parameters.to_vec(),
        turned: Arc::clone(turned),
        start,
        method: present.method,
        settings: present.settings,
    };
    if computed(answer).is_some_and(|known| known.conditions == conditions) {
        return Need::Valid;
    }
    let Physics { model, equations, system } = present.physics;
    let (model, equations) = (Arc::clone(model), Arc::clone(equations));
    let system = Arc::clone(system);
    Need::Job(Job::new("return error", move |progress| {
        let system = system.with_cancel(progress.token().clone());
        let WayConditions { parameters, turned, start, settings, .. } = &conditions;
        let space = PhaseSpace::on_constraints((&model, &equations, &system), parameters).ok();
        let growth = space.and_then(|space| {
            let turned = space.state(turned).ok()?;
            return_growth(&space, (method, *settings), &turned, *start)
        });
        Answer::new(ComputedGrowth { conditions: conditions.clone(), growth })
    }))
}

fn computed(answer: Option<&Answer>) -> Option<&ComputedGrowth> {
    answer?.of::<ComputedGrowth>()
}

/// The error that is expected after a time elapsed back, once its growth is known.
pub(super) fn expected(returned: Returned, answer: Option<&Answer>, elapsed: f64) -> Option<f64> {
    let known = computed(answer)?.growth.as_ref()?;
    let growth = growth_after(known, elapsed)?;
    let (error, step, independent) = returned.step_error;
    Some(growth.expected(error, step, independent))
}

/// What the error is expected to be, in a few words.
fn law(returned: Returned) -> &'static str {
    if returned.step_error.2 { "ε √Σ|∂φ|²" } else { "ε Σ|∂φ|" }
}

/// What stands above the distance of a motion that goes back.
pub(super) fn heading(returned: Returned) -> Heading {
    let mut entries = Vec::new();
    match (returned.error, returned.distance) {
        (Some(error), _) => entries.push(Entry::Number("returned to".to_owned(), error)),
        (None, Some(distance)) => entries.push(Entry::Number("d =".to_owned(), distance)),
        (None, None) => {}
    }
    if returned.step_error.0 > 0.0 {
        let error = significant(returned.step_error.0, 3, 1e-4..1e4);
        entries.push(Entry::Words(format!("ε = {error} a step")));
    }
    Heading { title: "Return error ln d".to_owned(), given: false, entries }
}

/// The distance from the run before over the time elapsed back, with what is expected of it.
pub(super) fn picture(
    (returned, answer): (Returned, Option<&Answer>),
    mut layers: Vec<(Level, Layer)>,
    mut range: Option<[f64; 2]>,
) -> Picture {
    let all = returned.elapsed[1];
    let name = match returned.distance {
        Some(0.0) => "ln d   identical, to the last bit".to_owned(),
        _ => "ln d from the run before".to_owned(),
    };
    let at = |k: u32| {
        let elapsed = all * f64::from(k) / f64::from(PARTS);
        let value = expected(returned, answer, elapsed).filter(|value| *value > 0.0)?;
        Some([elapsed, crate::num::math::ln(value)])
    };
    let line: Vec<[f64; 2]> = (1..=PARTS).filter_map(at).collect();
    if let (Some(first), Some(last)) = (line.first(), line.last()) {
        let seen = range.unwrap_or([first[1], last[1]]);
        let ends = [first[1], last[1]];
        range = Some([seen[0].min(ends[0]).min(ends[1]), seen[1].max(ends[0]).max(ends[1])]);
        let stroke = Stroke { ink: Ink::Accent, covering: Some(0.5) };
        layers.push((LINE, Layer::Line(line, stroke)));
        let now = expected(returned, answer, returned.elapsed[0]);
        let now = now.map(|value| format!(" = {}", significant(value, 2, 1e-4..1e4)));
        let words = format!("dotted: expected {}{}", law(returned), now.unwrap_or_default());
        layers.push((LINE, Layer::Legend(vec![words])));
    }
    let upwards = Upwards::Named(name, range.unwrap_or([-40.0, 0.0]));
    Picture::Axes { upwards, layers, occurrences: None }
}
