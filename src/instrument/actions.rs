//! `actions`: the action variable J = ∮ p dq of a coordinate over the energy E, with the separatrices, and where the motion is.
//!
//! Where the law depends on the time the curve is that of the system frozen at this instant, and the way of the motion over
//! (E, J) since the start is drawn: a slow change moves it along E and leaves J. The job computes curve and motion; what it
//! found of earlier instants is kept. Never here: how an action is computed (`action_angle`).
//! Source: *The Principles of Dynamics*, §§ 4.2, 4.3.

mod action_at_time;
mod computed;

use std::sync::Arc;

use super::motion_state::{self, CoordinateState, FrozenCourse};
use super::{
    Across, Answer, Axis, Entry, Heading, Ink, Instrument, Layer, Level, MarkerShape, Measure,
    Need, Offer, Physics, Picture, Plot, PlotContext, Present, Properties, Upwards,
};
use crate::action_angle::{RegionKind, is_adiabatic};
use crate::job::{Job, Progress};
use crate::num::significant;
use crate::system::ChannelKind;
use action_at_time::{ActionAtTime, signed};
use computed::{ComputedActions, Found};

const SEPARATRIX: Level = 0;
const CURVE: Level = 1;
const PAST: Level = 2;
const NOW: Level = 3;

/// Relative changes below this tell nothing of how slow the change is, and those below the second nothing against it: at the
/// beginning of a ramp J swings with its rate, while E has hardly moved.
const CHANGED: f64 = 0.01;
const SWINGS: f64 = 0.1;

/// What is said as long as nothing is known.
const BEING_COMPUTED: &str = "being computed";

pub(super) struct ActionsPlot;

const PROPERTIES: Properties = Properties {
    name: "actions",
    written: &[Axis { heading: "Coordinate", coordinate: true, ..Axis::ACROSS }],
    measures: &[
        Measure::new("action", "∮ p dq of the motion", |context| {
            Some(found(context.answer)?.own.row.as_ref().ok()?.action)
        }),
        Measure::new("period", "its period", |context| {
            found(context.answer)?.own.row.as_ref().ok()?.even_period()
        }),
        Measure::new(
            "separatrix",
            "∮ p dq of the first lobe of the first separatrix that has an end",
            |context| {
                let mut actions = found(context.answer)?.separatrices.first()?.actions.iter();
                actions.find(|action| action.is_finite()).copied()
            },
        ),
        Measure::new(
            "last_change",
            "by what fraction it has changed since the last ramp by a key",
            |context| {
                let computed = computed(context.answer)?;
                computed.changes_since(computed.replaced.last()?).map(|[action, _]| action)
            },
        ),
        Measure::new(
            "change",
            "by what fraction the action has changed since the start",
            |context| computed(context.answer)?.changes().map(|[action, _]| action),
        ),
    ],
    ..Properties::PLAIN
};

impl Instrument for ActionsPlot {
    fn properties(&self) -> &'static Properties {
        &PROPERTIES
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let about = "J = ∮ p dq over the energy, with the separatrices; a slow change conserves it";
        motion_state::offers(physics, "action variable", about)
    }

    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String {
        format!(
            "action variable of {}",
            plot.column(0).map_or("?", |channel| physics.shown(channel))
        )
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let name = present.physics.shown(plot.column(0)?);
        let energy = present.physics.channel(ChannelKind::Energy)?;
        let entries = vec![Entry::Words(format!("J = ∮ p d{name}")), Entry::Channel(energy)];
        Some(plot.heading(present.physics, "Action variable", entries))
    }

    fn across(&self, PlotContext { present, answer, .. }: PlotContext<'_>) -> Across {
        let energy = if bottom(answer).is_some() { "E − V₀" } else { "E" };
        let name = energy_unit(present.physics)
            .map_or_else(|| energy.to_owned(), |unit| format!("{energy} [{unit}]"));
        Across::Named(name, ranges(answer)[0])
    }

    fn awaits(&self, PlotContext { answer, .. }: PlotContext<'_>) -> Option<String> {
        match computed(answer) {
            None => Some(
                "The action J = ∮ p dq of each energy, and the place of this motion on its curve. It is \
                 being computed."
                    .to_owned(),
            ),
            Some(computed) if computed.course.past.is_empty() => {
                computed.found.as_ref().err().cloned()
            }
            Some(_) => None,
        }
    }

    fn picture(&self, context: PlotContext<'_>, _seen: [f64; 2]) -> Option<Picture> {
        let PlotContext { present, answer, .. } = context;
        let [_, high] = ranges(answer);
        let from = bottom(answer);
        let above = |[energy, action]: [f64; 2]| [energy - from.unwrap_or(0.0), action];
        let mut layers = Vec::new();
        if let Some(found) = found(answer) {
            for separatrix in &found.separatrices {
                let line = [0.0, 2.0 * high[1]].map(|action| above([separatrix.energy, action]));
                layers.push((SEPARATRIX, Layer::Line(line.to_vec(), Ink::Separatrix.into())));
            }
            layers.extend(found.curves.iter().map(|curve| {
                let curve = curve.iter().map(|&at| above(at)).collect();
                (CURVE, Layer::Line(curve, Ink::Curve(0).into()))
            }));
            if let Ok(row) = &found.own.row {
                let now = above([found.own.energy, row.action]);
                layers.push((NOW, Layer::Point(now, MarkerShape::Disc, Ink::Accent)));
            }
        }
        let past = computed(answer).map_or(&[][..], |computed| &computed.course.past[..]);
        if past.len() > 1 {
            let line = past.iter().map(|instant| instant.seen(from)).collect();
            layers.push((PAST, Layer::Line(line, Ink::Warn.into())));
        }
        if let [first, _, ..] = past {
            layers.push((NOW, Layer::Point(first.seen(from), MarkerShape::Ring, Ink::Warn)));
        }
        layers.push((NOW, Layer::Legend(sentences(context))));
        let units = energy_unit(present.physics).zip(Some(present.physics.model.time_unit()));
        let name = match units.filter(|(_, time)| !time.is_empty()) {
            Some((energy, time)) => format!("J [{energy} {time}]"),
            None => "J".to_owned(),
        };
        Some(Picture::Axes { upwards: Upwards::Named(name, high), layers, occurrences: None })
    }

    fn job(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Need {
        let Some(state) = CoordinateState::of(plot, present) else { return Need::Nothing };
        let known = computed(answer);
        let leads = known.is_some_and(|known| known.course.leads_to(&state));
        if leads && known.is_some_and(|known| known.holds_at(&state)) {
            return Need::Valid;
        }
        let replaced = known.filter(|_| leads).map_or(&[][..], |known| &known.replaced);
        // a paused motion continues at the very moment
        let before = |instant: &&ActionAtTime| instant.time <= state.time;
        let replaced: Vec<ActionAtTime> = replaced.iter().filter(before).copied().collect();
        let known = known.map(|known| known.course.clone());
        let (model, system) =
            (Arc::clone(present.physics.model), Arc::clone(present.physics.system));
        Need::Job(Job::new("actions", move |progress: &Progress| {
            let known = known.as_ref();
            let mut course = FrozenCourse::continued(known, &state, &model, progress, |m| m.time);
            let frozen = course.frozen.clone();
            let motion =
                frozen.as_ref().map_err(Clone::clone).and_then(|frozen| state.frozen(frozen));
            let found = motion.and_then(|mut motion| Found::of(&mut motion));
            if course.moves() {
                // however late one looks, the change is that since the motion began
                if course.past.is_empty()
                    && let Ok(frozen) = &frozen
                    && let Ok(first) = state.beginning(&system, model.run.start)
                    && let Ok(mut motion) = first.frozen(frozen)
                {
                    let own = motion.own().ok();
                    course
                        .past
                        .extend(own.and_then(|own| ActionAtTime::of(&motion, &own, first.time)));
                }
                let now = found.as_ref().ok().and_then(|found| found.moment(state.time));
                course.past.extend(
                    now.filter(|now| course.past.last().is_none_or(|last| last.time < now.time)),
                );
            }
            Answer::new(ComputedActions { course, found, replaced: replaced.clone() })
        }))
    }

    fn inherited(&self, answer: &Answer) -> Option<Answer> {
        let known = answer.of::<ComputedActions>()?;
        let mut replaced = known.replaced.clone();
        replaced.push(*known.course.past.last()?);
        let course = known.course.of_a_replaced_law();
        Some(Answer::new(ComputedActions {
            course,
            found: Err(BEING_COMPUTED.to_owned()),
            replaced,
        }))
    }
}

/// The unit of the energy, if it is known.
fn energy_unit(physics: Physics<'_>) -> Option<&str> {
    let channel = physics.channel(ChannelKind::Energy)?;
    let unit = physics.system.channels()[channel].unit.as_str();
    (!unit.is_empty()).then_some(unit)
}

fn computed(answer: Option<&Answer>) -> Option<&ComputedActions> {
    answer?.of::<ComputedActions>()
}

fn found(answer: Option<&Answer>) -> Option<&Found> {
    computed(answer)?.found.as_ref().ok()
}

/// The least energy of the coordinate, above which energies are drawn where it may move with the law: else the way of the
/// motion would be that of V₀, however little it does itself.
fn bottom(answer: Option<&Answer>) -> Option<f64> {
    let computed = computed(answer).filter(|computed| computed.course.moves())?;
    let found = computed.found.as_ref().ok()?;
    let bottom = found.own.energy - found.height;
    bottom.is_finite().then_some(bottom)
}

/// The ranges of the energy and of the action.
fn ranges(answer: Option<&Answer>) -> [[f64; 2]; 2] {
    let Some(found) = found(answer) else { return [[0.0, 1.0]; 2] };
    let past = computed(answer).into_iter().flat_map(|computed| &computed.course.past);
    let from = bottom(answer);
    let past = past.map(|instant| instant.seen(from));
    let curves = found.curves.iter().flatten();
    let curves = curves.map(|[energy, action]| [energy - from.unwrap_or(0.0), *action]);
    let all = curves.chain(past);
    let all = all.filter(|[e, j]| e.is_finite() && j.is_finite());
    let [mut low, mut high, mut top] = [f64::INFINITY, f64::NEG_INFINITY, 0.0_f64];
    for [energy, action] in all {
        (low, high, top) = (low.min(energy), high.max(energy), top.max(action));
    }
    if low < high { [[low, high], [0.0, 1.1 * top]] } else { [[0.0, 1.0]; 2] }
}

/// What is said of the motion, or why it has no action.
fn sentences(PlotContext { present, answer, .. }: PlotContext<'_>) -> Vec<String> {
    let Some(computed) = computed(answer) else { return vec![BEING_COMPUTED.to_owned()] };
    let found = match &computed.found {
        Err(why) => return vec![why.clone()],
        Ok(found) => found,
    };
    let short = |x: f64| significant(x, 5, 1e-3..1e5).replace('-', "−");
    let changes = computed.changes().filter(|_| computed.course.past.len() > 1);
    let mut lines = Vec::new();
    match &found.own.row {
        Err(why) => lines.push(why.to_string()),
        Ok(row) if row.kind == RegionKind::Unbounded => {
            lines.push("the motion escapes and does not return".to_owned());
        }
        Ok(row) => {
            let [action, over] = [row.action, row.action / std::f64::consts::TAU].map(short);
            let [number, slope] = [
                format!("J = {action} = 2π · {over}"),
                match row.even_period() {
                    Some(period) => {
                        format!("T = dJ/dE = {}, ν = {}", short(period), short(1.0 / period))
                    }
                    None => "its returns take different times".to_owned(),
                },
            ];
            lines.extend(if changes.is_some() {
                [number, format!("{}: {slope}", row.kind.word())]
            } else {
                [format!("{}: {number}", row.kind.word()), slope]
            });
        }
    }
    for separatrix in &found.separatrices {
        // a lobe without end has no action
        let lobes = separatrix.actions.iter().filter(|action| action.is_finite());
        let actions: Vec<String> = lobes.map(|&x| short(x)).collect();
        let from = bottom(answer);
        let name = if from.is_some() { "E − V₀" } else { "E" };
        let energy = short(separatrix.energy - from.unwrap_or(0.0));
        let actions = actions.join(" and ");
        let turn = separatrix.turn.map_or_else(String::new, |turn| match turn.map(short) {
            [right, left] if right == left => format!(", {right} a turn"),
            [right, left] => format!(", {right} a turn, {left} backwards"),
        });
        lines.push(format!("separatrix at {name} = {energy}: J = {actions}{turn}"));
    }
    if let Some([action, height]) = changes {
        let since = computed.course.past.first().map_or(present.time, |first| first.time);
        // what is behind a fast motion is of its own time
        let late = Some(computed.course.state.time).filter(|_| computed.is_behind(present.time));
        let at = late.map_or_else(String::new, |time| format!(" at t = {}", short(time)));
        // a low plot has room for the first lines only, which are J beside E
        let change = format!("ΔJ/J = {}: {}{at}", signed(action), verdict([action, height]));
        let height = format!("since t = {}: ΔE/(E − V₀) = {}", short(since), signed(height));
        lines.splice(0..0, [change, height]);
    }
    if let Some(last) = computed.replaced.last()
        && let Some(changes) = computed.changes_since(last)
    {
        lines.push(format!("since t = {}, before the last ramp:", short(last.time)));
        let [action, height] = changes.map(signed);
        lines.push(format!("ΔJ/J = {action}, ΔE/(E − V₀) = {height}"));
    }
    lines
}

/// Whether the action has stayed, by which part it and the height of the energy have changed.
fn verdict([action, height]: [f64; 2]) -> &'static str {
    if height.abs() >= CHANGED && is_adiabatic(action, height) {
        "adiabatic"
    } else if action.abs().max(height.abs()) < SWINGS {
        "undecided so far"
    } else {
        "not adiabatic"
    }
}

#[cfg(test)]
mod tests {
    use super::verdict;

    #[test]
    fn a_change_of_a_hundredth_tells_that_it_is_slow_and_one_of_a_tenth_that_it_is_not() {
        for (changes, word) in [
            ([0.0, 0.0101], "adiabatic"),
            ([0.0, 0.0099], "undecided so far"),
            ([-0.099, 0.0], "undecided so far"),
            ([-0.101, 0.0], "not adiabatic"),
            ([0.099, -0.099], "undecided so far"),
            ([0.099, -0.101], "not adiabatic"),
        ] {
            assert_eq!(verdict(changes), word, "{changes:?}");
        }
    }
}
