//! `action`, `abbreviated`, `phase-action`: the three principles of stationary action on the running motion, each by the action
//! of what lies beside it with the same ends.
//!
//! The job follows the motion from its initial values up to now. Hamilton's principle and that of Maupertuis add ε sin(kπs)/k
//! to one coordinate, s from 0 to 1 on the way: the first takes every path in the same time, the second with the same energy. In
//! phase space q and p are varied apart. Every curve is level at ε = 0; the first turns over once the motion has passed a
//! kinetic focus, and its action is no longer least. Never here: the integrals (`dynamics`).
//! Source: *The Principles of Dynamics*, §§ 0, 1.4.1, 3.1.3.

mod along_motion;
mod ends;
mod in_phase_space;
mod principle;

use self::along_motion::{ActionAlongMotion, Actions, beside};
use self::ends::by_its_ends;
use self::in_phase_space::{beside_by, nature};
pub(super) use self::principle::Principle;
use super::path_so_far::{PathSoFar, nothing_yet};
use super::{
    Across, Answer, Axis, Entry, Heading, Ink, Instrument, Layer, Level, MarkerShape, Measure,
    Need, Offer, Physics, Picture, Plot, PlotContext, Present, Properties, Upwards,
};
use crate::dynamics::{PhaseSpace, VARIATIONS, VariedAction};
use crate::job::{Job, Progress};
use crate::num::significant;

const AXIS: Level = 0;
const CURVES: Level = 1;
const MOTION: Level = 2;

/// An action below this part of what those of paths beside it differ by is a rounding error.
const ROUNDING: f64 = 1e-14;

pub(super) struct ActionPlot(pub(super) Principle);

struct ComputedAction {
    principle: Principle,
    path: PathSoFar,
    outcome: Result<ActionAlongMotion, String>,
}

const MEASURES: &[Measure] = &[
    Measure::new("value", "the action of the motion up to now", |context| {
        Some(varied(context.answer)?.action)
    }),
    Measure::new("foci", "how many kinetic foci it has passed", |context| {
        Some(found(context.answer)?.foci.as_ref()?.len() as f64)
    }),
    Measure::new("by_place", "of Hamilton's action: ∂S/∂q at its end, which is p", |context| {
        Some(varied(context.answer)?.ends?[1].by_position)
    }),
    Measure::new(
        "by_time",
        "of Hamilton's action: ∂S/∂t at its end, which is −H",
        |context| Some(varied(context.answer)?.ends?[1].by_time),
    ),
    Measure::new(
        "rise",
        "how much greater the action is at the greatest ε, for k = 1",
        |context| Some(varied(context.answer)?.curves.first()?.last()?[1]),
    ),
];

/// The constants of one of the three principles.
const fn properties(name: &'static str, other: &'static dyn Instrument) -> Properties {
    Properties {
        name,
        other: Some(other),
        written: &[Axis { heading: "Coordinate to vary", coordinate: true, ..Axis::ACROSS }],
        measures: MEASURES,
        ..Properties::PLAIN
    }
}

impl Instrument for ActionPlot {
    fn properties(&self) -> &'static Properties {
        match self.0 {
            Principle::Hamilton => {
                const { &properties("action", &ActionPlot(Principle::Maupertuis)) }
            }
            Principle::Maupertuis => {
                const { &properties("abbreviated", &ActionPlot(Principle::PhaseSpace)) }
            }
            Principle::PhaseSpace => {
                const { &properties("phase-action", &ActionPlot(Principle::Hamilton)) }
            }
        }
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let offer = |(index, channel): (usize, usize)| {
            Offer::new(
                format!("{}, {} varied", self.0.action(), physics.model.coordinates[index].shown),
                self.0.about(),
                vec![vec![channel]],
            )
        };
        physics.positions().map(offer).collect()
    }

    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String {
        let name = plot.column(0).map_or("?", |channel| physics.shown(channel));
        format!("{}, {name} varied", self.0.action())
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let name = present.physics.shown(plot.column(0)?);
        let action = format!("{} = {}", self.0.letter(), self.0.integral());
        let mut entries = vec![Entry::Words(action)];
        entries.extend(match self.0 {
            Principle::Hamilton | Principle::Maupertuis => vec![Entry::Words(format!(
                "{name} + ε sin(kπs)/k, s = 0 … 1 on the way, k = 1 … {VARIATIONS}"
            ))],
            Principle::PhaseSpace => vec![
                Entry::Line(0, format!("{name} + ε sin πs")),
                Entry::Line(1, "p + ε c cos πs".to_owned()),
                Entry::Line(2, format!("{name}, p = ∂L/∂q′")),
            ],
        });
        let kind = match self.0 {
            Principle::Hamilton => "Action",
            Principle::Maupertuis => "Abbreviated action",
            Principle::PhaseSpace => "Action in phase space",
        };
        Some(plot.heading(present.physics, kind, entries))
    }

    fn across(&self, PlotContext { answer, .. }: PlotContext<'_>) -> Across {
        let reach = varied(answer).and_then(|varied| varied.curves.first()?.last().copied());
        let reach = reach.map_or(1.0, |at| at[0]);
        Across::Named("ε".to_owned(), [-reach, reach])
    }

    fn awaits(&self, PlotContext { present, answer, .. }: PlotContext<'_>) -> Option<String> {
        let letter = self.0.letter();
        let what = format!("{letter} of paths beside this motion that have the same ends");
        match (nothing_yet(present), computed(answer).map(|known| &known.outcome)) {
            (Some(why), _) => Some(format!("{what}: {why}.{}", present.how_to_begin())),
            (None, None) => Some(format!("{what}. It is being computed.")),
            (None, Some(Err(why))) => Some(why.clone()),
            (None, Some(Ok(_))) => None,
        }
    }

    fn picture(
        &self,
        PlotContext { plot, present, answer }: PlotContext<'_>,
        [from, to]: [f64; 2],
    ) -> Option<Picture> {
        let name = plot.column(0).map(|channel| present.physics.shown(channel));
        let (lines, answer) = match nothing_yet(present) {
            Some(line) => (vec![line], None),
            None => (sentences(answer, name), answer),
        };
        let legend = (MOTION, Layer::Legend(lines));
        let named = |range, layers| {
            let letter = self.0.letter();
            let upwards = Upwards::Named(format!("{letter}(ε) − {letter}(0)"), range);
            Some(Picture::Axes { upwards, layers, occurrences: None })
        };
        let Some(varied) = varied(answer) else { return named([0.0, 1.0], vec![legend]) };
        let values = varied.curves.iter().flatten().map(|at| at[1]);
        let (least, greatest) =
            values.fold((0.0_f64, 0.0_f64), |(lo, hi), value| (lo.min(value), hi.max(value)));
        let mut layers = vec![(AXIS, Layer::Line(vec![[from, 0.0], [to, 0.0]], Ink::Level.into()))];
        let curves = varied.curves.iter().enumerate().rev();
        layers.extend(
            curves.map(|(k, points)| (CURVES, Layer::Line(points.clone(), Ink::Curve(k).into()))),
        );
        layers.push((MOTION, Layer::Point([0.0; 2], MarkerShape::Disc, Ink::Accent)));
        layers.push(legend);
        named([least, greatest], layers)
    }

    fn job(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Need {
        let Physics { model, equations, system } = present.physics;
        let Some((path, method)) = PathSoFar::of(plot, present) else { return Need::Nothing };
        let principle = self.0;
        if computed(answer)
            .is_some_and(|known| (known.principle, &known.path) == (principle, &path))
        {
            return Need::Valid;
        }
        let (model, equations, system) = (model.clone(), equations.clone(), system.clone());
        Need::Job(Job::new("action", move |progress: &Progress| {
            let system = system.with_cancel(progress.token().clone());
            let parameters = &path.conditions.parameters;
            let outcome = PhaseSpace::without_end((&model, &equations, &system), parameters)
                .map_err(|why| why.to_string())
                .and_then(|space| {
                    let mut own = (*equations).clone();
                    let of = (principle, path.begin);
                    let actions = Actions::of((&model, &mut own), parameters, of)?;
                    let start = (path.begin, model.run.start);
                    let of = (method, &path.conditions, start);
                    beside(&space, actions, of, path.coordinate, path.duration)
                });
            Answer::new(ComputedAction { principle, path: path.clone(), outcome })
        }))
    }
}

fn computed(answer: Option<&Answer>) -> Option<&ComputedAction> {
    answer?.of::<ComputedAction>()
}

fn found(answer: Option<&Answer>) -> Option<&ActionAlongMotion> {
    computed(answer)?.outcome.as_ref().ok()
}

fn varied(answer: Option<&Answer>) -> Option<&VariedAction> {
    found(answer).map(|found| &found.varied)
}

/// The action of the motion: 0 where rounding alone keeps it from that, as terms show that are as large as those beside it.
fn value(varied: &VariedAction) -> f64 {
    let beside = varied.curves.iter().flatten().map(|at| at[1].abs()).fold(0.0, f64::max);
    if varied.action.abs() <= ROUNDING * beside { 0.0 } else { varied.action }
}

/// What is said of the motion's action, or why it has none.
fn sentences(answer: Option<&Answer>, coordinate: Option<&str>) -> Vec<String> {
    let Some(computed) = computed(answer) else { return vec!["being computed".to_owned()] };
    let found = match &computed.outcome {
        Err(why) => return vec![why.clone()],
        Ok(found) => found,
    };
    let short = |x: f64| significant(x, 5, 1e-3..1e5).replace('-', "−");
    let at = |focus: &f64| format!("t = {}", short(computed.path.begin + focus));
    // as many negative directions as foci that were passed (M. Morse)
    let not_least = |foci: usize| match computed.principle {
        Principle::Maupertuis => "not a minimum at this energy".to_owned(),
        Principle::Hamilton | Principle::PhaseSpace => format!("not least: Morse index {foci}"),
    };
    let rest = match found.foci.as_deref() {
        Some(_) if computed.principle == Principle::PhaseSpace => {
            let name = coordinate.unwrap_or("q");
            [vec![nature(&found.varied)], beside_by(&found.varied, name)].concat()
        }
        Some(_) if computed.principle == Principle::Maupertuis && found.varied.action == 0.0 => {
            vec!["at rest: no path that could be varied".to_owned()]
        }
        Some(_) if computed.principle == Principle::Maupertuis && found.degrees == 1 => {
            vec!["one coordinate: no other path at this H".to_owned()]
        }
        Some([]) if computed.principle == Principle::Maupertuis => {
            vec!["least among nearby paths of equal H".to_owned()]
        }
        None => vec!["not stationary: forces act that have no potential".to_owned()],
        Some([]) => vec!["least of all paths nearby".to_owned()],
        Some([focus]) => {
            vec![not_least(1), format!("kinetic focus at {}", at(focus))]
        }
        Some(foci @ [first, ..]) => {
            let count = foci.len();
            vec![not_least(count), format!("{count} kinetic foci from {}", at(first))]
        }
    };
    let (letter, value) = (computed.principle.letter(), short(value(&found.varied)));
    // the heading has the integral
    let action = format!("{letter} = {value} up to {}", at(&computed.path.duration));
    // of a motion that does not make the action stationary these slopes say nothing
    let ends = found.varied.ends.filter(|_| found.foci.is_some());
    let ends = ends.map_or_else(Vec::new, |ends| {
        by_its_ends(&ends, found.method_errors, coordinate.unwrap_or("q"))
    });
    let since = computed.path.conditions.since().into_iter().collect();
    [vec![action], rest, ends, since].concat()
}
