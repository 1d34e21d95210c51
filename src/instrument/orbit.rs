//! `orbit`: the periodic orbit near the motion, with its period, its action, its multipliers and its stability.
//!
//! The job closes the orbit near the state at which the picture was begun, or was asked for again, by Newton's method
//! ([`nearest_orbit`]), and follows it once around; where there is none, another job finds out what the motion is instead. It
//! begins again where a parameter, the method or the initial values change.

use std::sync::Arc;

use super::closed_orbit::{ClosedOrbit, beginning, closed_orbit};
use super::conditions::PlotConditions;
use super::equilibria::start;
use super::orbit_crossings::periodic_points;
use super::{
    Across, Answer, Axis, Entry, Heading, Ink, Instrument, Layer, Level, MarkerShape, Measure,
    Need, NoStart, Offer, PeriodicOrbits, Physics, Picture, Plot, PlotContext, Present, Properties,
    Seed, StartValues, Upwards,
};
use crate::dynamics::{DynamicsError, Orbit as Closed, OrbitStability, explained};
use crate::ensemble::{Start, SystemFlow};
use crate::integrate::{Method, Settings, method_named};
use crate::job::{Job, Progress};
use crate::num::{math, significant};
use crate::system::System;

const TRAIL: Level = 0;
const CURVE: Level = 2;
const NOW: Level = 4;

const POINTS: usize = 2048;

/// What is beyond the extent of an orbit is this part of it.
const MARGIN: f64 = 0.25;

pub(super) struct OrbitPlot;

struct ComputedOrbit {
    conditions: PlotConditions,
    /// The time of the motion when it was asked for.
    asked: f64,
    outcome: Result<Described, String>,
    /// The start near which no orbit was found, and the error, if it is still to say what the motion is instead.
    unexplained: Option<(Start, DynamicsError)>,
}

/// An orbit, and its points in the plane of the picture.
struct Described {
    orbit: Closed,
    points: Vec<[f64; 2]>,
    extent: [[f64; 2]; 2],
    drive: Option<f64>,
    /// Where it crosses the surfaces of section.
    periodic: Arc<PeriodicOrbits>,
}

const PROPERTIES: Properties = Properties {
    name: "orbit",
    written: &[Axis::ACROSS, Axis::UPWARDS],
    takes_seeds: true,
    has_equal_axes: true,
    measures: &[
        Measure::new("period", "the period of the periodic orbit", |context| {
            Some(described(context.answer)?.orbit.period)
        }),
        Measure::new(
            "multiple",
            "its period over that of the drive, for a law that depends on time",
            |context| {
                let found = described(context.answer)?;
                Some((found.orbit.period / found.drive?).round())
            },
        ),
        Measure::new("action", "the action ∫ p dq along it", |context| {
            described(context.answer)?.orbit.action
        }),
        Measure::new("energy", "the energy on it", |context| {
            Some(described(context.answer)?.orbit.energy)
        }),
        Measure::new("trace", "the sum of its multipliers without the trivial ones", |context| {
            Some(described(context.answer)?.orbit.transverse.trace())
        }),
        Measure::new(
            "residue",
            "Greene's residue (2 − trace)/4, for two degrees of freedom or one with a drive",
            |context| described(context.answer)?.orbit.residue(),
        ),
        Measure::new(
            "stable",
            "1 if no multiplier lies outside the unit circle, else 0",
            |context| Some(f64::from(u8::from(described(context.answer)?.orbit.stable))),
        ),
    ],
    ..Properties::PLAIN
};

impl Instrument for OrbitPlot {
    fn properties(&self) -> &'static Properties {
        &PROPERTIES
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let offer = |(x, y): (usize, usize)| {
            Offer::new(
                format!("orbit: {} against {}", physics.shown(y), physics.shown(x)),
                "the periodic orbit near the motion: period, action, multipliers",
                vec![vec![x], vec![y]],
            )
        };
        let neighbours = physics.neighbouring_positions().into_iter();
        neighbours.chain(physics.phase_planes()).map(offer).collect()
    }

    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String {
        format!("periodic orbit, {}", plot.against(physics))
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let of = |k| Some(Entry::Channel(plot.column(k)?));
        Some(plot.heading(present.physics, "Periodic orbit", vec![of(0)?, of(1)?]))
    }

    fn across(&self, context: PlotContext<'_>) -> Across {
        context.plot.across(range(context, 0))
    }

    fn picture(&self, context: PlotContext<'_>, _seen: [f64; 2]) -> Option<Picture> {
        let PlotContext { plot, present, answer } = context;
        let channels = [plot.column(0)?, plot.column(1)?];
        let now = channels.map(|channel| present.value(channel));
        let mut layers = vec![
            (TRAIL, Layer::Trail(channels)),
            (NOW, Layer::Point(now, MarkerShape::Disc, Ink::Accent)),
        ];
        if let Some(found) = described(answer) {
            layers.push((CURVE, Layer::Line(found.points.clone(), Ink::Curve(1).into())));
        }
        layers.push((NOW, Layer::Legend(legend(present.physics, answer))));
        let upwards = Upwards::Channel(channels[1], range(context, 1));
        Some(Picture::Axes { upwards, layers, occurrences: None })
    }

    fn start(&self, context: PlotContext<'_>, at: [f64; 2]) -> StartValues {
        let found = super::phase::initial_values(context.plot, context.present.physics, at);
        found.ok_or(NoStart::Nothing)
    }

    /// The time at which the orbit is asked for again.
    fn seed(&self, PlotContext { present, .. }: PlotContext<'_>) -> Option<Seed> {
        Some(Seed::Through([present.time, 0.0]))
    }

    fn job(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Need {
        let conditions = PlotConditions::of(present, &plot.seeds);
        let known = found(answer)
            .filter(|known| known.conditions == conditions && known.asked <= present.time);
        let unexplained = known.map(|known| (known.asked, &known.unexplained));
        if let Some((_, None)) = unexplained {
            return Need::Valid;
        }
        let (Some(x), Some(y), Some(method)) =
            (plot.column(0), plot.column(1), method_named(present.method))
        else {
            return Need::Nothing;
        };
        let Physics { model, equations, system } = present.physics;
        let (model, equations, system) = (model.clone(), equations.clone(), system.clone());
        let settings = present.settings;
        if let Some((asked, Some((start, error)))) = unexplained {
            let (start, error) = (start.clone(), error.clone());
            return Need::Job(Job::new("what the motion is", move |progress: &Progress| {
                let system = system.with_cancel(progress.token().clone());
                let physics =
                    Physics { model: &model, equations: &equations, system: &system.into() };
                let of = (&start, &conditions);
                let why = character(physics, (method, settings), of, &error, progress);
                let (conditions, outcome) = (conditions.clone(), Err(why));
                Answer::new(ComputedOrbit { conditions, asked, outcome, unexplained: None })
            }));
        }
        let asked = present.time;
        let start = start(present, asked);
        Need::Job(Job::new("periodic orbit", move |progress: &Progress| {
            let system = system.with_cancel(progress.token().clone());
            let physics = Physics { model: &model, equations: &equations, system: &system.into() };
            let of = (&start, &conditions);
            let outcome = close(physics, (method, settings), of, ([x, y], progress));
            let unexplained = match &outcome {
                Err(error @ DynamicsError::Unclosed(_)) => Some((start.clone(), error.clone())),
                _ => None,
            };
            let (conditions, outcome) =
                (conditions.clone(), outcome.map_err(|why| why.to_string()));
            Answer::new(ComputedOrbit { conditions, asked, outcome, unexplained })
        }))
    }

    fn periodic(&self, answer: &Answer) -> Option<Arc<PeriodicOrbits>> {
        Some(Arc::clone(&described(Some(answer))?.periodic))
    }
}

/// Why no orbit was found, and what the motion is instead.
fn character(
    physics: Physics<'_>,
    method: (&'static Method, Settings),
    of: (&Start, &PlotConditions),
    error: &DynamicsError,
    progress: &Progress,
) -> String {
    let Ok((space, state)) = beginning(physics, of) else { return error.to_string() };
    let mut report = |done, all| {
        progress.expect(all);
        progress.reach(done);
    };
    explained(error.clone(), &space, method, &state, &mut report).to_string()
}

/// Closes the orbit near a start, and follows it once around.
fn close(
    physics: Physics<'_>,
    method: (&'static Method, Settings),
    (start, conditions): (&Start, &PlotConditions),
    (channels, progress): ([usize; 2], &Progress),
) -> Result<Described, DynamicsError> {
    let (system, parameters) = (physics.system, &start.parameters);
    let report = |done, all| {
        progress.expect(all);
        progress.reach(done);
    };
    let ClosedOrbit { space, orbit, .. } =
        closed_orbit(physics, method, (start, conditions), &report)?;
    let flow = SystemFlow {
        system: System::clone(system),
        method: (method.0, orbit.settings),
        parameters: parameters.clone(),
        start: orbit.state.time,
        effort: None,
    };
    let part = |k: usize| orbit.state.time + orbit.period * k as f64 / POINTS as f64;
    let times: Vec<f64> = (0..=POINTS).map(part).collect();
    let around = flow.carry(&orbit.state, &times, &channels);
    let points: Vec<[f64; 2]> = around.seen.iter().map(|row| [row[0], row[1]]).collect();
    let mut extent = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for at in &points {
        for (ends, x) in extent.iter_mut().zip(at) {
            *ends = [ends[0].min(*x), ends[1].max(*x)];
        }
    }
    let crossed = periodic_points(physics, method.0, &orbit, parameters);
    let periodic = Arc::new(PeriodicOrbits { orbit: crossed, family: Vec::new() });
    Ok(Described { orbit, points, extent, drive: space.drive(), periodic })
}

fn found(answer: Option<&Answer>) -> Option<&ComputedOrbit> {
    answer?.of::<ComputedOrbit>()
}

fn described(answer: Option<&Answer>) -> Option<&Described> {
    found(answer)?.outcome.as_ref().ok()
}

/// What is said of the orbit, or why there is none.
fn legend(physics: Physics<'_>, answer: Option<&Answer>) -> Vec<String> {
    let found = match found(answer) {
        None => return vec!["searching for the periodic orbit near the motion".to_owned()],
        Some(ComputedOrbit { outcome: Err(why), unexplained, .. }) => {
            let more = if unexplained.is_some() {
                "; what the motion is instead is being computed"
            } else {
                ""
            };
            return vec![format!("{why}{more}")];
        }
        Some(ComputedOrbit { outcome: Ok(found), .. }) => found,
    };
    let orbit = &found.orbit;
    let short = |x: f64| significant(x, 8, 1e-4..1e6).replace('-', "−");
    let brief = |x: f64| significant(x, 5, 1e-3..1e5).replace('-', "−");
    let unit = physics.model.time_unit();
    let mut lines = vec![format!("T = {} {unit}", short(orbit.period)).trim_end().to_owned()];
    lines.extend(found.drive.map(|drive| match (orbit.period / drive).round() {
        1.0 => "that of the drive".to_owned(),
        count => format!("{count} × that of the drive"),
    }));
    if !orbit.closes_to_rounding {
        lines.push(format!("closes only to {:.0e} of its size", orbit.closure).replace('-', "−"));
    }
    let how = match orbit.stability() {
        OrbitStability::Neutral if orbit.levels.len() > 1 => {
            "neutral: one of a family in E and the Casimirs".to_owned()
        }
        OrbitStability::Neutral => "neutral: one of a family in E".to_owned(),
        OrbitStability::Parabolic => "parabolic: all multipliers are 1".to_owned(),
        other => other.word().to_owned(),
    };
    let residue = orbit.residue().map(|residue| format!(", residue {}", brief(residue)));
    lines.push(how + &residue.unwrap_or_default());
    lines.extend(orbit.action.map(|action| format!("action = {}", short(action))));
    let multiplier = |[re, im]: [f64; 2]| {
        if im == 0.0 {
            brief(re)
        } else {
            let sign = if im < 0.0 { '−' } else { '+' };
            format!("{} {sign} {}i", brief(re), brief(im.abs()))
        }
    };
    let shown = |&z: &[f64; 2]| match (orbit.nearly_vanishes(z), orbit.is_lost(z)) {
        (true, _) => multiplier([0.0, 0.0]),
        (false, true) => "one not known".to_owned(),
        (false, false) => multiplier(z),
    };
    let own: Vec<String> = orbit.multipliers.iter().map(shown).collect();
    let trivial: Vec<String> =
        orbit.trivial_names().iter().map(|name| format!("1 ({name})")).collect();
    let all = [own.join(", "), trivial.join(", ")];
    let all: Vec<String> = all.into_iter().filter(|part| !part.is_empty()).collect();
    lines.push(format!("multipliers {}", all.join(", ")));
    if let Some(error) = orbit.rounding.filter(|error| *error > crate::dynamics::NOTICED_ROUNDING) {
        lines.push(format!("rounding {error:.0e} in their matrix").replace('-', "−"));
    }
    lines
}

/// The range of an axis: the orbit and the motion, or a turn.
fn range(PlotContext { plot, present, answer }: PlotContext<'_>, axis: usize) -> Option<[f64; 2]> {
    let channel = plot.column(axis)?;
    let [lo, hi] = described(answer)?.extent[axis];
    let margin = MARGIN * (hi - lo);
    let [lo, hi] = [lo - margin, hi + margin];
    let turn = present.turn_within(channel, [lo, hi]);
    turn.or((lo < hi && math::hypot(lo, hi).is_finite()).then_some([lo, hi]))
}
