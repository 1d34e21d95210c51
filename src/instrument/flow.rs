//! `flow`: the derivative of the flow M(t) = ∂η(t)/∂η(0) of the motion from its initial values: ‖MJMᵀ − J‖ for the map of the
//! method and for that of the exact flow; under friction det M beside what Liouville's theorem predicts of it.
//!
//! The job follows the variational equations along the motion ([`flow_course`]), over a time that is doubled when the motion has
//! come to its end. Where the law was changed on the way, the motion is that since then, and M = ∂η(t)/∂η there. An impulse carries M on by its own derivative.
//! Never here: constraints, for which `phaselab flow` has the map at one time.

use nalgebra::DMatrix;

use super::conditions::PlotConditions;
use super::{
    Across, Answer, Columns, Entry, Heading, Ink, Instrument, Layer, Level, Measure, Need, Offer,
    Physics, Picture, Plot, PlotContext, Present, Properties, Upwards,
};
use crate::dynamics::{FlowAtTime, PhaseSpace, flow_course};
use crate::expr::Expr;
use crate::integrate::{Method, Settings, method_named};
use crate::job::{Job, Progress};
use crate::model::Model;
use crate::num::{math, significant};
use crate::system::State;

const BESIDE: Level = 0;
const CURVE: Level = 1;
const NOW: Level = 2;

/// The first time followed, in seconds of the wall clock at the file's own speed, and how often it is doubled.
const SECONDS: f64 = 10.0;
const DOUBLINGS: u32 = 8;

/// The times at which M is taken.
const TIMES: usize = 120;

/// A job counts its progress in so many parts.
const PARTS: f64 = 1000.0;

/// The method whose map is that of the flow, to rounding.
const EXACT: &str = "taylor";

/// What is below this power of ten is drawn there: 0 has no logarithm.
const LEAST_POWER: f64 = -17.0;

/// The most entries of M that are written.
const ENTRIES: usize = 4;

pub(super) struct FlowPlot;

struct ComputedFlow {
    conditions: PlotConditions,
    doublings: u32,
    begin: f64,
    end: f64,
    outcome: Result<Courses, String>,
}

/// The derivatives of the map of the method, and of the exact flow where the method is another one.
struct Courses {
    own: Vec<FlowAtTime>,
    exact: Option<Vec<FlowAtTime>>,
    /// Whether nothing but H acts.
    is_hamiltonian: bool,
    /// When one of them ends early, and why.
    errors: Vec<(f64, String)>,
}

const PROPERTIES: Properties = Properties {
    name: "flow",
    measures: &[
        Measure::new(
            "determinant",
            "det M of the method's map, now",
            |PlotContext { present, answer, .. }| determinant(now(present, &courses(answer)?.own)?),
        ),
        Measure::new(
            "expected",
            "what Liouville's theorem expects of it",
            |PlotContext { present, answer, .. }| {
                Some(now(present, &courses(answer)?.own)?.determinant_expected)
            },
        ),
        Measure::new(
            "residual",
            "the largest entry of |MJMᵀ − J| of the method's map, now",
            |PlotContext { present, answer, .. }| residual(now(present, &courses(answer)?.own)?),
        ),
        Measure::new(
            "exact_residual",
            "the same of the exact flow, where the method is another one",
            |PlotContext { present, answer, .. }| {
                residual(now(present, courses(answer)?.exact.as_deref()?)?)
            },
        ),
    ],
    ..Properties::PLAIN
};

impl Instrument for FlowPlot {
    fn properties(&self) -> &'static Properties {
        &PROPERTIES
    }

    fn offers(&self, _physics: Physics<'_>) -> Vec<Offer> {
        vec![Offer::new(
            "flow map",
            "M = ∂η(t)/∂η(0): det M, and how symplectic it is, by this method and exactly",
            Columns::new(),
        )]
    }

    fn words(&self, _plot: &Plot, _physics: Physics<'_>) -> String {
        "flow map".to_owned()
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let mut entries =
            vec![Entry::Words(format!("M = ∂η(t)/∂η({}) by {}", origin(present), present.method))];
        if present.method != EXACT && only_h_acts(present.physics.model) {
            entries = vec![
                Entry::Line(0, present.method.to_owned()),
                Entry::Line(1, "exact flow".to_owned()),
            ];
        }
        Some(plot.heading(present.physics, "Flow map", entries))
    }

    fn across(&self, PlotContext { present, answer, .. }: PlotContext<'_>) -> Across {
        let start = present.began();
        let span = |known: &ComputedFlow| [known.begin, known.end];
        Across::Times(
            followed(answer).map_or_else(|| [start, start + length(present.physics, 0)], span),
        )
    }

    fn awaits(&self, PlotContext { answer, .. }: PlotContext<'_>) -> Option<String> {
        match followed(answer).map(|known| &known.outcome) {
            None => Some(
                "M, the derivative of the state with respect to the initial one, against time: how far M J Mᵀ is \
                 from J, or det M. It is being computed."
                    .to_owned(),
            ),
            Some(Err(why)) => Some(why.clone()),
            Some(Ok(_)) => None,
        }
    }

    fn picture(&self, context: PlotContext<'_>, _seen: [f64; 2]) -> Option<Picture> {
        let mut layers = vec![(NOW, Layer::Legend(sentences(context)))];
        let Some(courses) = courses(context.answer) else {
            let upwards = Upwards::Named("‖MJMᵀ − J‖".to_owned(), [0.0, 1.0]);
            return Some(Picture::Axes { upwards, layers, occurrences: None });
        };
        let curve = |flows: &[FlowAtTime], of: &dyn Fn(&FlowAtTime) -> Option<f64>| {
            let point = |flow: &FlowAtTime| Some([flow.time, of(flow)?]);
            flows.iter().filter_map(point).collect::<Vec<[f64; 2]>>()
        };
        let mut lines = Vec::new();
        let name = if courses.is_hamiltonian {
            let exact = courses.exact.as_deref().unwrap_or_default();
            lines.push((BESIDE, curve(exact, &power), Ink::Curve(1)));
            lines.push((CURVE, curve(&courses.own, &power), Ink::Curve(0)));
            "log₁₀ ‖MJMᵀ − J‖"
        } else {
            let expected = |flow: &FlowAtTime| Some(flow.determinant_expected);
            lines.push((BESIDE, curve(&courses.own, &expected), Ink::Level));
            lines.push((CURVE, curve(&courses.own, &determinant), Ink::Curve(0)));
            "det M"
        };
        let heights = || lines.iter().flat_map(|(_, line, _)| line).map(|point| point[1]);
        let highest = heights().fold(f64::NEG_INFINITY, f64::max);
        let lowest =
            heights().fold(if courses.is_hamiltonian { LEAST_POWER } else { 0.0 }, f64::min);
        let highest = if highest > lowest { highest } else { lowest + 1.0 };
        let upwards = Upwards::Named(name.to_owned(), [lowest, highest]);
        layers.extend(
            lines.into_iter().map(|(level, line, ink)| (level, Layer::Line(line, ink.into()))),
        );
        Some(Picture::Axes { upwards, layers, occurrences: None })
    }

    fn job(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Need {
        let conditions = PlotConditions::of_recorded(present, &plot.seeds);
        let start = conditions.begin(present.physics.model.run.start);
        let known = followed(answer).filter(|known| known.conditions == conditions);
        if let Some(known) = known
            && (present.time <= known.end
                || known.doublings >= DOUBLINGS
                || !known.outcome.as_ref().is_ok_and(|courses| courses.errors.is_empty()))
        {
            return Need::Valid;
        }
        let is_short = |n: &u32| start + length(present.physics, *n) < present.time;
        let doublings = (0..DOUBLINGS).find(|n| !is_short(n)).unwrap_or(DOUBLINGS);
        let Some(method) = method_named(present.method) else { return Need::Nothing };
        let Physics { model, equations, system } = present.physics;
        let (model, equations, system) = (model.clone(), equations.clone(), system.clone());
        let end = start + length(present.physics, doublings);
        let job = Job::new("flow map", move |progress| {
            let system = system.with_cancel(progress.token().clone());
            let (parameters, of) = (&conditions.parameters, (&*model, &*equations, &system));
            let space = PhaseSpace::without_end(of, parameters)
                .or_else(|_| PhaseSpace::through_impulses(of, parameters));
            let outcome = space.map_err(|why| why.to_string()).and_then(|space| {
                let state = conditions.state(space.system(), start);
                let state = state.and_then(|state| space.state(&state));
                let state = state.map_err(|why| why.to_string())?;
                follow(&space, (method, conditions.settings), (&state, end), progress)
            });
            let conditions = conditions.clone();
            Answer::new(ComputedFlow { conditions, doublings, begin: start, end, outcome })
        });
        Need::Job(job)
    }
}

/// Whether nothing but H acts, so that two curves are drawn.
fn only_h_acts(model: &Model) -> bool {
    let forces = model.mechanics.forces();
    model.mechanics.dissipation() == Expr::ZERO && forces.iter().all(|&e| e == Expr::ZERO)
}

/// Follows the motion to a time by its method, and by the exact one where that is another one and is drawn.
fn follow(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    (state, end): (&State, f64),
    progress: &Progress,
) -> Result<Courses, String> {
    progress.expect(PARTS as u64);
    let begin = state.time;
    let at = |i: usize| begin + (end - begin) * i as f64 / TIMES as f64;
    let times: Vec<f64> = (0..=TIMES).map(at).collect();
    let is_hamiltonian = space.is_hamiltonian();
    let exact = method_named(EXACT).filter(|exact| is_hamiltonian && exact.name != method.name);
    let share = if exact.is_some() { 0.5 } else { 1.0 };
    let part = |time: f64| share * ((time - begin) / (end - begin)).min(1.0) * PARTS;
    let mut report = |time: f64| progress.reach(part(time) as u64);
    let own = flow_course(space, (method, settings), state, &times, &mut report);
    let (own, error) = own.map_err(|why| why.to_string())?;
    let mut errors: Vec<(f64, String)> =
        error.into_iter().map(|error| (error.time, error.to_string())).collect();
    let mut report = |time: f64| progress.reach((part(time) + share * PARTS) as u64);
    let exact = exact.and_then(|exact| {
        let settings = Settings { step: None, tolerance: None };
        let (found, error) = match flow_course(space, (exact, settings), state, &times, &mut report)
        {
            Ok((found, error)) => (Some(found), error.map(|error| (error.time, error.to_string()))),
            Err(why) => (None, Some((begin, why.to_string()))),
        };
        // where both end for one reason it is said once
        let error = error.filter(|(_, why)| errors.iter().all(|(_, own)| own != why));
        errors.extend(error.map(|(time, why)| (time, format!("the exact flow: {why}"))));
        found
    });
    Ok(Courses { own, exact, is_hamiltonian, errors })
}

/// What is said of the map as it is now.
fn sentences(PlotContext { present, answer, .. }: PlotContext<'_>) -> Vec<String> {
    let courses = match followed(answer).map(|known| &known.outcome) {
        None => return vec!["being computed".to_owned()],
        Some(Err(why)) => return vec![why.clone()],
        Some(Ok(courses)) => courses,
    };
    let since = followed(answer).and_then(|known| known.conditions.since());
    let Some(own) = now(present, &courses.own) else { return since.into_iter().collect() };
    let short = |x: f64, digits| significant(x, digits, 1e-3..1e4).replace('-', "−");
    let size = |x: f64| if x == 0.0 { "0".to_owned() } else { short(x, 2) };
    let mut lines = Vec::new();
    let unit = present.physics.model.time_unit();
    let at = format!("{} {unit}", short(own.time, 4));
    let expected = short(own.determinant_expected, 6);
    let found = match determinant(own) {
        Some(found) => format!("det M = {}", short(found, 6)),
        None => "det M is lost in rounding".to_owned(),
    };
    lines.push(format!("t = {}: {found}, expected {expected}", at.trim_end()));
    if courses.is_hamiltonian && own.symplectic_residual.is_some() {
        let of_square = |flow: &FlowAtTime, residual: f64| {
            let largest = flow.matrix.amax();
            format!("{} of |M|²", size(residual / (largest * largest)))
        };
        let beside = courses.exact.as_deref().and_then(|exact| now(present, exact));
        let beside = beside.and_then(|flow| Some((flow, residual(flow)?)));
        let exact = beside.map_or_else(String::new, |(flow, x)| {
            if flow.is_at_rounding() {
                format!(", at rounding ({}) by the exact flow", of_square(flow, x))
            } else {
                format!(", {} by the exact flow", size(x))
            }
        });
        lines.push(match residual(own) {
            Some(x) if own.is_at_rounding() => {
                let method = present.method;
                format!("‖MJMᵀ − J‖ at rounding ({}) by {method}{exact}", of_square(own, x))
            }
            Some(x) => format!("‖MJMᵀ − J‖ = {} by {}{exact}", size(x), present.method),
            None => {
                let entries = short(own.matrix.amax(), 1);
                format!("‖MJMᵀ − J‖ is lost in rounding: M has entries of {entries}{exact}")
            }
        });
    }
    if own.matrix.len() <= ENTRIES {
        lines.push(format!("M = ({})", rows(&own.matrix, &|x| short(x, 4))));
    }
    let failed = courses.errors.iter().filter(|(time, _)| *time <= present.time);
    lines.extend(failed.map(|(_, why)| why.clone()));
    lines.extend(since);
    lines
}

/// The rows of a matrix, parted by a bar.
fn rows(matrix: &DMatrix<f64>, short: &dyn Fn(f64) -> String) -> String {
    let row = |i: usize| {
        let entries = matrix.row(i).iter().map(|&x| short(x)).collect::<Vec<_>>();
        entries.join(" ")
    };
    (0..matrix.nrows()).map(row).collect::<Vec<_>>().join(" | ")
}

/// The last derivative at a time that the motion has passed.
fn now<'a>(present: &Present<'_>, flows: &'a [FlowAtTime]) -> Option<&'a FlowAtTime> {
    let passed = flows.partition_point(|flow| flow.time <= present.time);
    flows.get(passed.checked_sub(1)?)
}

/// det M, where rounding leaves something of it.
fn determinant(flow: &FlowAtTime) -> Option<f64> {
    (!flow.determinant_lost).then_some(flow.determinant)
}

/// ‖MJMᵀ − J‖, where it is more than rounding of large entries.
fn residual(flow: &FlowAtTime) -> Option<f64> {
    flow.symplectic_residual.filter(|_| !flow.residual_lost)
}

/// The power of ten of ‖MJMᵀ − J‖; at rounding that of what rounding leaves, so that it is seen as a floor.
fn power(flow: &FlowAtTime) -> Option<f64> {
    let residual = residual(flow)?;
    let seen = if flow.is_at_rounding() { flow.rounding_floor } else { residual };
    let power = math::ln(seen) / math::ln(10.0);
    (!power.is_nan()).then_some(power.max(LEAST_POWER))
}

/// The time from which M is, in its formula.
fn origin(present: &Present<'_>) -> String {
    significant(present.began(), 3, 1e-3..1e5).replace('-', "−")
}

/// How long the motion is followed.
fn length(physics: Physics<'_>, doublings: u32) -> f64 {
    SECONDS * physics.model.run.speed * f64::from(1 << doublings)
}

fn followed(answer: Option<&Answer>) -> Option<&ComputedFlow> {
    answer?.of::<ComputedFlow>()
}

fn courses(answer: Option<&Answer>) -> Option<&Courses> {
    followed(answer)?.outcome.as_ref().ok()
}
