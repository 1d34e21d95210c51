//! `exponents`: the largest Lyapunov exponent of the motion as a curve λ(t), with its uncertainty and a verdict.
//!
//! The job follows the variational equations along the motion from its initial values, over a time that is doubled until
//! the exponent has been followed long enough ([`lyapunov`](crate::dynamics::lyapunov)); the picture fills as it does.

use super::conditions::PlotConditions;
use super::{
    Across, Answer, Columns, Entry, Heading, Ink, Instrument, Layer, Level, Measure, Need, Offer,
    Physics, Picture, Plot, PlotContext, Present, Properties, Stroke, Upwards,
};
use crate::dynamics::{Chaos, Lyapunov, PhaseSpace, lyapunov};
use crate::integrate::{Method, Settings, method_named};
use crate::job::{Job, Progress};
use crate::num::significant;

const BAND: Level = 0;
const CURVE: Level = 1;

/// The first time followed, in seconds of the wall clock at the file's own speed, and how often it is doubled.
const SECONDS: f64 = 60.0;
const DOUBLINGS: u32 = 5;

/// A job counts its progress in so many parts.
const PARTS: f64 = 1000.0;

pub(super) struct Exponents;

/// What was measured, and of which motion.
struct Measured {
    conditions: PlotConditions,
    doublings: u32,
    found: Result<Lyapunov, String>,
}

const PROPERTIES: Properties = Properties {
    name: "exponents",
    measures: &[
        Measure::new("largest", "the largest Lyapunov exponent", |context| {
            found(context.answer)?.exponents.first().copied()
        }),
        Measure::new("uncertainty", "its uncertainty", |context| {
            found(context.answer)?.uncertainty.first().copied()
        }),
        Measure::new(
            "megno",
            "MEGNO: about 2 for regular motion, growing for chaotic",
            |context| found(context.answer).map(|found| found.megno),
        ),
        Measure::new(
            "chaotic",
            "1 if the motion is chaotic, 0 if it is regular or unstable; undecided has no value",
            |context| match found(context.answer)?.verdict {
                Chaos::Chaotic => Some(1.0),
                Chaos::Regular | Chaos::Unstable => Some(0.0),
                Chaos::Undecided => None,
            },
        ),
    ],
    ..Properties::PLAIN
};

impl Instrument for Exponents {
    fn properties(&self) -> &'static Properties {
        &PROPERTIES
    }

    fn offers(&self, _physics: Physics<'_>) -> Vec<Offer> {
        vec![Offer::new(
            "exponents",
            "the largest Lyapunov exponent against time, regular or chaotic",
            Columns::new(),
        )]
    }

    fn words(&self, _plot: &Plot, _physics: Physics<'_>) -> String {
        "Lyapunov exponents".to_owned()
    }

    /// Without an answer it cannot say more than its name: the answer is in the picture.
    fn heading(&self, _plot: &Plot, _present: &Present<'_>) -> Option<Heading> {
        let entries = vec![Entry::Words("of the motion from its initial values".to_owned())];
        Some(Heading { title: "Exponent".to_owned(), given: false, entries })
    }

    fn across(&self, PlotContext { present, answer, .. }: PlotContext<'_>) -> Across {
        let start = present.physics.model.run.start;
        let end = found(answer).map_or(start + first(present.physics), |found| found.time);
        Across::Times([start, end])
    }

    fn awaits(&self, PlotContext { answer, .. }: PlotContext<'_>) -> Option<String> {
        match measured(answer).map(|measured| &measured.found) {
            None => Some(
                "λ against time: how fast neighbouring motions separate, measured from the initial \
                 values on. It is being computed; V measures it again."
                    .to_owned(),
            ),
            Some(Err(why)) => Some(why.clone()),
            Some(Ok(_)) => None,
        }
    }

    fn picture(&self, context: PlotContext<'_>, _seen: [f64; 2]) -> Option<Picture> {
        let PlotContext { present, answer, .. } = context;
        let axes = |name: &str, range, layers| {
            let upwards = Upwards::Named(name.to_owned(), range);
            Some(Picture::Axes { upwards, layers, occurrences: None })
        };
        let measured = measured(answer);
        let found = match measured.map(|measured| &measured.found) {
            None => return axes("λ   being measured", [0.0, 1.0], Vec::new()),
            Some(Err(why)) => {
                return axes("λ", [0.0, 1.0], vec![(CURVE, Layer::Legend(vec![why.clone()]))]);
            }
            Some(Ok(found)) => found,
        };
        let start = present.physics.model.run.start;
        let (largest, off) = (found.exponents.first()?, found.uncertainty.first()?);
        let curve: Vec<[f64; 2]> = found.curve.iter().map(|(t, x)| [*t, *x]).collect();
        let level = |x: f64| {
            let stroke = Stroke { ink: Ink::Separatrix, covering: Some(0.4) };
            (BAND, Layer::Line(vec![[start, x], [found.time, x]], stroke))
        };
        // the beginning says where a vector turned to, and would squeeze all else
        let settled = &curve[curve.len() / 10..];
        let (least, greatest) = settled.iter().fold((-off, off + 0.0), |(lo, hi), [_, x]| {
            (x.min(lo.min(largest - off)), x.max(hi.max(largest + off)))
        });
        let short = |x: f64| significant(x, 3, 1e-4..1e4);
        let (largest_words, off_words) = (short(*largest), significant(*off, 1, 1e-4..1e4));
        let settled = found.settled.first().copied().unwrap_or(true);
        let known = if settled { "" } else { " or more: the average has not settled" };
        // what is known to be zero has no uncertainty
        let value = match (*largest, *off) {
            (0.0, 0.0) => "λ = 0, exactly".to_owned(),
            _ => format!("λ = {largest_words} ± {off_words}{known}"),
        };
        let legend = vec![
            format!("{}: {value}", found.verdict.word()),
            format!("MEGNO {}", short(found.megno)),
            found.reason.clone(),
        ];
        let layers = vec![
            level(largest - off),
            level(largest + off),
            (CURVE, Layer::Line(curve, Ink::Accent.into())),
            (CURVE, Layer::Legend(legend)),
        ];
        axes("λ", [least.min(0.0), greatest], layers)
    }

    fn job(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Need {
        let conditions = PlotConditions::of(present, &plot.seeds);
        let known = measured(answer).filter(|known| known.conditions == conditions);
        let doublings = match known {
            None => 0,
            Some(Measured { found: Err(_), .. }) => return Need::Valid,
            Some(known) if known.doublings >= DOUBLINGS => return Need::Valid,
            Some(known) => known.doublings + 1,
        };
        let Some(method) = method_named(present.method) else { return Need::Nothing };
        let Physics { model, equations, system } = present.physics;
        let (model, equations, system) = (model.clone(), equations.clone(), system.clone());
        let length = first(present.physics) * f64::from(1 << doublings);
        let job = Job::new("exponents", move |progress| {
            let system = system.with_cancel(progress.token().clone());
            let space =
                PhaseSpace::on_constraints((&model, &equations, &system), &conditions.parameters);
            let start = model.run.start;
            let found = space.map_err(|why| why.to_string()).and_then(|space| {
                let state = state(&space, &conditions, start)?;
                follow(&space, (method, conditions.settings), (&state, start + length), progress)
            });
            Answer::new(Measured { conditions: conditions.clone(), doublings, found })
        });
        if doublings == 0 { Need::Job(job) } else { Need::Addition(job) }
    }
}

/// The initial state, in the variables of the space.
fn state(
    space: &PhaseSpace,
    conditions: &PlotConditions,
    start: f64,
) -> Result<crate::system::State, String> {
    let state = conditions.state(space.system(), start).and_then(|state| space.state(&state));
    state.map_err(|error| error.to_string())
}

/// Measures until a time.
fn follow(
    space: &PhaseSpace,
    method: (&'static Method, Settings),
    (state, until): (&crate::system::State, f64),
    progress: &Progress,
) -> Result<Lyapunov, String> {
    progress.expect(PARTS as u64);
    let begin = state.time;
    let mut report = |time: f64| progress.reach(((time - begin) / (until - begin) * PARTS) as u64);
    lyapunov(space, method, state, until, &mut report).map_err(|why| why.to_string())
}

/// The time followed at first.
fn first(physics: Physics<'_>) -> f64 {
    SECONDS * physics.model.run.speed
}

fn measured(answer: Option<&Answer>) -> Option<&Measured> {
    answer?.of::<Measured>()
}

fn found(answer: Option<&Answer>) -> Option<&Lyapunov> {
    measured(answer)?.found.as_ref().ok()
}
