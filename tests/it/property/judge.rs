//! The property: a run is completed and accurate, or it ends with a failure that has a position.

use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use phaselab::cancel::Cancel;
use phaselab::claims::false_claims;
use phaselab::diagnostic::{Document, Severity};
use phaselab::experiment::{AdvanceOutcome, Experiment, Setup, Status, Verdict};
use phaselab::integrate::METHODS;
use phaselab::mechanics::derive;
use phaselab::system::{ChannelKind, InitialOverride, System};

use super::case::{Case, Law};
use super::extrapolation::{Arrival, Lost, follow};
use super::oracle::{energy, momentum, rounding_of_terms};
use super::processor_time::ProcessorTime;

/// The kinds of failure.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(crate) enum Kind {
    Panic,
    Hang,
    /// It takes many more steps than the motion needs.
    Slow,
    /// A correct file is refused.
    Refused,
    /// `check` rejects a file that runs.
    CheckRefuses,
    /// `check` accepts a file that cannot start.
    DoesNotStart,
    /// The default method fails though the motion continues.
    GivesUp,
    /// Another method fails where the default does not, without saying so.
    Unhelpful,
    /// The report of a failure lacks its cause or position.
    NoPlace,
    /// The run is completed, but wrong.
    Wrong,
    /// The energy is not conserved, and this is not reported.
    Silent,
    /// The reported energy is not that of the state.
    EnergyWrong,
    /// A quantity is reported as conserved, but changes.
    FalselyConserved,
    /// A quantity is conserved by the form of the law, but not reported as such.
    NotConserved,
    /// The result depends on the units.
    UnitsMatter,
}

/// A failed case.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Failure {
    pub(crate) kind: Kind,
    pub(crate) message: String,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}: {}", self.kind, self.message)
    }
}

/// The outcome of a case.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum Outcome {
    /// Completed and accurate.
    Accurate,
    /// A failure with a position, where the motion indeed ends or cannot be judged.
    Stopped,
    /// The method is not applicable and reports that.
    Unfit,
    /// The judge cannot decide.
    Undecided(&'static str),
    Failed(Failure),
}

fn failed(kind: Kind, message: impl Into<String>) -> Outcome {
    Outcome::Failed(Failure { kind, message: message.into() })
}

/// The limits on the work for a case.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Budget {
    /// Steps and rows of the program.
    pub(crate) steps: u64,
    /// Evaluations of the judge.
    pub(crate) evaluations: u64,
    pub(crate) watchdog: Duration,
}

/// How often the time that a case has taken is looked at.
const ASKED: Duration = Duration::from_millis(200);

/// A case that has spent less than its processor time is a hang after this many times as long.
const MOST_SHARED: u32 = 40;

/// Judges a case.
pub(crate) fn judged(case: &Case, budget: Budget) -> Outcome {
    judged_as(case, case, budget)
}

/// Judges the run of another system as if it were this case's, on a separate thread: one that does not return is a
/// hang.
pub(crate) fn judged_as(case: &Case, run: &Case, budget: Budget) -> Outcome {
    let (sender, receiver) = channel();
    let (case, run) = (case.clone(), run.clone());
    let cancel = Cancel::new();
    let token = cancel.clone();
    let (known, own) = channel();
    let work = move || {
        let clock = ProcessorTime::of_this_thread();
        let judging = || {
            let motion = know(&case, budget);
            let _ = known.send(clock);
            judge(&case, motion, &run, budget, &token)
        };
        let outcome = catch_unwind(AssertUnwindSafe(judging));
        let outcome = outcome.unwrap_or_else(|panic| {
            let text = panic.downcast_ref::<String>().cloned();
            let text = text.or_else(|| panic.downcast_ref::<&str>().map(|s| (*s).to_owned()));
            failed(Kind::Panic, text.unwrap_or_default())
        });
        let _ = sender.send(outcome);
    };
    std::thread::spawn(work);
    // the judge's own work has an end, its budget, and is no part of the time that the program is given
    let clock = own.recv().unwrap_or_else(|_| ProcessorTime::of_this_thread());
    let begun = clock.spent();
    let waiting = Instant::now();
    loop {
        match receiver.recv_timeout(ASKED) {
            Ok(outcome) => return outcome,
            Err(RecvTimeoutError::Disconnected) => {
                return failed(Kind::Panic, "the thread is gone");
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
        // where other programs run beside this one a thread is given a part of the time; one that waits spends none
        let spent = match (clock.spent(), begun) {
            (Some(now), Some(begun)) => now.saturating_sub(begun),
            _ => waiting.elapsed(),
        };
        if spent >= budget.watchdog || waiting.elapsed() >= MOST_SHARED * budget.watchdog {
            cancel.cancel();
            return failed(Kind::Hang, format!("no answer within {:?}", budget.watchdog));
        }
    }
}

/// A gauge at the end of a run.
struct Gauge {
    name: String,
    word: &'static str,
    broken: bool,
    max_drift: f64,
    /// The greatest distance from the reference, in natural units if it is that of the energy.
    farthest: f64,
}

/// The program's results for a case, in natural units.
struct RunReport {
    end: End,
    time: f64,
    state: Vec<f64>,
    energy: Option<f64>,
    steps: u64,
    gauges: Vec<Gauge>,
    conserved: Vec<String>,
    check: Vec<String>,
    /// Whether its method steps over kinks of the motion, which `run` says.
    over_kinks: bool,
}

enum End {
    Completed,
    Stopped,
    OutOfBudget,
    Error(String),
}

/// Runs a case; an error is an outcome.
fn run(case: &Case, budget: Budget, cancel: &Cancel) -> Result<RunReport, Outcome> {
    let document = Document::new("case.toml", case.toml());
    let refused = |what: String| failed(Kind::Refused, what);
    let checked = document.read().map_err(|m| refused(document.report(&m, false)))?;
    let mut model = checked.model;
    model.pool.set_cancel(cancel.clone());
    let equations = derive(&model).map_err(|why| refused(why.to_string()))?;
    let diagnostics = false_claims(&model, &equations);
    let errors = diagnostics.iter().filter(|m| m.severity == Severity::Error);
    let check = errors.map(|m| m.message.clone()).collect();
    let system =
        System::compile(&model, &equations, &[]).map_err(|why| refused(why.to_string()))?;
    let conserved = equations.conserved.iter().map(|c| c.name.clone()).collect();
    let (model, equations) = (Arc::new(model), Arc::new(equations));
    let end = case.length * case.units.time;
    let units = case.state_units();
    let given = case.by_momentum.iter().map(|&i| {
        let p = momentum(case, 0.0, &case.start, i);
        InitialOverride::Momentum(i, p * case.units.energy * case.units.time / units[i])
    });
    let setup = Setup {
        end: Some(end),
        spacing: end / 1000.0,
        overrides: given.collect(),
        ..Setup::of(&model)
    };
    let mut experiment =
        Experiment::new(&model, &equations, &system, setup).map_err(|_| Outcome::Unfit)?;
    let mut left = budget.steps;
    let reached = loop {
        let part = left.min(4096);
        left -= part;
        match experiment.advance(end, part) {
            AdvanceOutcome::Arrived => break End::Completed,
            AdvanceOutcome::Ended => break End::Stopped,
            AdvanceOutcome::Stuck => break End::Error(String::new()),
            AdvanceOutcome::Underway if left == 0 => break End::OutOfBudget,
            AdvanceOutcome::Underway => {}
        }
    };
    let reached = match experiment.status() {
        Status::Failed(error) => End::Error(error.message),
        _ => reached,
    };
    let snapshot = experiment.snapshot();
    let find = |kind: ChannelKind| system.channels().iter().position(|c| c.kind == kind);
    let value = |kind| find(kind).map_or(f64::NAN, |channel| snapshot.values[channel]);
    let n = case.count();
    let mut state: Vec<f64> = (0..n).map(|i| value(ChannelKind::Position(i))).collect();
    match case.law {
        Law::Lagrangian => state.extend((0..n).map(|i| value(ChannelKind::Velocity(i)))),
        Law::Hamiltonian => state.extend((0..n).map(|i| value(ChannelKind::Momentum(i)))),
        Law::Poisson => {}
    }
    state.iter_mut().zip(case.state_units()).for_each(|(x, unit)| *x /= unit);
    let gauge = |gauge: &phaselab::experiment::Gauge| Gauge {
        name: gauge.name.clone(),
        word: gauge.verdict.word(),
        broken: matches!(gauge.verdict, Verdict::Broken(_)),
        max_drift: gauge.max_drift,
        farthest: gauge.farthest / case.units.energy,
    };
    Ok(RunReport {
        end: reached,
        time: snapshot.time / case.units.time,
        state,
        energy: find(ChannelKind::Energy)
            .map(|channel| snapshot.values[channel] / case.units.energy),
        steps: snapshot.method.steps,
        gauges: snapshot.gauges.iter().map(gauge).collect(),
        conserved,
        check,
        over_kinks: system.has_kinks()
            && METHODS.iter().any(|m| m.name == case.method && !m.locates_kinks),
    })
}

/// The motion as computed by the judge.
struct Known {
    arrival: Arrival,
    /// The magnitude of its components.
    scale: f64,
}

/// How far a motion can be known. A result within what is allowed to every motion needs no more than the motion itself.
struct Sensitivity {
    /// The growth of a small change of the start.
    growth: f64,
    /// The judge's own error, relative to the scale.
    error: f64,
}

/// The sensitivity of the steadiest motion, which is allowed the least.
const INSENSITIVE: Sensitivity = Sensitivity { growth: 1.0, error: 0.0 };

fn distance(a: &[f64], b: &[f64]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, |most, d| if d.is_nan() { d } else { d.max(most) })
}

/// Whether the method of a case chooses its steps.
fn is_adaptive(case: &Case) -> bool {
    ["auto", "taylor", "dop853"].contains(&case.method.as_str())
}

fn know(case: &Case, budget: Budget) -> Result<Known, Lost> {
    let arrival = follow(case, &case.start, 1e-13, budget.evaluations)?;
    let states = arrival.way.iter().map(|(_, state)| state);
    let scale = states.chain([&case.start]).flatten().fold(1e-3_f64, |most, x| most.max(x.abs()));
    if case.keeps_energy() {
        // a wall that a step of the judge has jumped into unseen
        let (first, of_first) = energy(case, 0.0, &case.start);
        let (last, of_last) = energy(case, arrival.time, &arrival.state);
        let terms = arrival.way.iter().map(|(time, state)| energy(case, *time, state).1);
        let terms = terms.filter(|terms| terms.is_finite()).fold(of_first.max(of_last), f64::max);
        if (last - first).abs() > OWN_DRIFT * terms {
            return Err(Lost::Inaccurate);
        }
    }
    Ok(Known { arrival, scale })
}

/// Follows the motion three times more: it is asked only where a result differs by more than every motion is allowed.
fn sensitivity(case: &Case, known: &Known, budget: Budget) -> Result<Sensitivity, Lost> {
    let Known { arrival, scale } = known;
    let coarse = follow(case, &case.start, 1e-10, budget.evaluations)?;
    // the same accuracy once more, for errors that do not follow the tolerance: rounding that the motion enlarges on its
    // way, where it is as sensitive as it is not at its start
    let again = follow(case, &case.start, 2e-13, budget.evaluations)?;
    let mut error = distance(&arrival.state, &coarse.state) / scale;
    error = error.max((arrival.time - coarse.time).abs() / case.length);
    let mut growth = (error / 1e-10).max(1.0);
    if arrival.stopped != coarse.stopped || arrival.stopped != again.stopped {
        return Err(Lost::Sticks);
    }
    // a motion may go far beyond the size of its start; beside its constraints it is as sensitive as on them
    let size = case.start.iter().fold(1e-3_f64, |most, x| most.max(x.abs()));
    let push = |(i, x): (usize, &f64)| x + 1e-9 * size * if i % 2 == 0 { 1.0 } else { -1.0 };
    let start: Vec<f64> = case.start.iter().enumerate().map(push).collect();
    let pushed = follow(case, &start, 1e-12, budget.evaluations)?;
    if arrival.stopped != pushed.stopped {
        return Err(Lost::Sticks);
    }
    let moved = distance(&arrival.state, &pushed.state) / scale;
    growth = growth.max((moved + (arrival.time - pushed.time).abs() / case.length) / 1e-9);
    let apart = distance(&arrival.state, &again.state) / scale;
    let apart = apart.max((arrival.time - again.time).abs() / case.length);
    // the coarse solution's error is a hundred times as large
    let error = (0.01 * error).max(apart) + 1e-14 * growth;
    Ok(Sensitivity { growth, error })
}

/// A drift that `run` reports.
const REPORTED: f64 = 1e-6;

/// The part of its terms by which the energy of the judge's own motion may be off.
const OWN_DRIFT: f64 = 1e-6;

/// The tolerance beyond which a case is left undecided.
const UNREPORTED: f64 = 0.01;

fn judge(
    case: &Case,
    known: Result<Known, Lost>,
    as_run: &Case,
    budget: Budget,
    cancel: &Cancel,
) -> Outcome {
    let reported = match run(as_run, budget, cancel) {
        Ok(reported) => reported,
        Err(outcome) => return outcome,
    };
    if let End::Error(message) = &reported.end {
        let has_place =
            [" at t = ", " after t = ", " from t = "].iter().any(|place| message.contains(place));
        if !has_place && reported.time > 0.0 || message.is_empty() {
            return failed(Kind::NoPlace, message);
        }
        if message.contains("belongs to several starts") {
            return Outcome::Stopped;
        }
        let says_what_helps = message.contains("try a smaller step")
            || !is_adaptive(case) && message.contains(" passes it");
        if reported.time == 0.0
            && reported.check.is_empty()
            && case.by_momentum.is_empty()
            && !says_what_helps
        {
            return failed(Kind::DoesNotStart, format!("`check` is silent; {message}"));
        }
    }
    if let (End::Error(_), true) =
        (&reported.end, reported.time == 0.0 && !reported.check.is_empty())
        && !energy(case, 0.0, &case.start).0.is_finite()
    {
        // a pole, as `check` says
        return Outcome::Stopped;
    }
    let known = match known {
        Ok(known) => known,
        Err(Lost::AtStart) => {
            return match reported.end {
                End::Error(_) => Outcome::Stopped,
                _ => failed(Kind::Wrong, "it runs from where nothing is finite"),
            };
        }
        Err(why) => return unknown(&reported, why),
    };
    let run = (as_run, &reported);
    let outcome = compare(case, &known, &INSENSITIVE, run, budget, cancel);
    if outcome == Outcome::Accurate || !is_adaptive(case) {
        return outcome;
    }
    match sensitivity(case, &known, budget) {
        Ok(sensitivity) => compare(case, &known, &sensitivity, run, budget, cancel),
        Err(why) => unknown(&reported, why),
    }
}

/// The outcome of a run where there is no motion for comparison.
fn unknown(reported: &RunReport, why: Lost) -> Outcome {
    match (&reported.end, why) {
        (End::Error(_), _) => Outcome::Stopped,
        (_, Lost::NotFinite) => Outcome::Undecided("a pole"),
        (_, Lost::TooLong) => Outcome::Undecided("too long"),
        (_, Lost::Inaccurate) => Outcome::Undecided("the judge's own energy"),
        (_, _) => Outcome::Undecided("a kink that holds"),
    }
}

/// Compares a run, and that in natural units, with the motion.
fn compare(
    case: &Case,
    known: &Known,
    sensitivity: &Sensitivity,
    (as_run, reported): (&Case, &RunReport),
    budget: Budget,
    cancel: &Cancel,
) -> Outcome {
    let adaptive = is_adaptive(case);
    let default = case.method == "auto";
    match &reported.end {
        End::Error(message) if default => {
            return failed(Kind::GivesUp, message);
        }
        End::Error(message)
            if !message.contains("passes it") && !message.contains("try a smaller step") =>
        {
            return failed(Kind::Unhelpful, message);
        }
        End::Error(_) => return Outcome::Stopped,
        End::OutOfBudget if adaptive && known.arrival.way.len() < 1000 => {
            let message = format!("{} steps to t = {}", reported.steps, reported.time);
            return failed(Kind::Slow, message);
        }
        End::OutOfBudget => return Outcome::Undecided("out of budget"),
        End::Completed | End::Stopped => {}
    }
    if !reported.check.is_empty() {
        return failed(Kind::CheckRefuses, reported.check.join("; "));
    }
    if let Some(failure) = energy_failure(case, known, reported) {
        return Outcome::Failed(failure);
    }
    if let Some(failure) = form_failure(case, reported) {
        return Outcome::Failed(failure);
    }
    if !adaptive {
        return Outcome::Accurate;
    }
    let least = if case.method == "dop853" { 1e-13 } else { 1e-15 };
    let asked = case.tolerance.unwrap_or(least).max(least);
    let room = if case.method == "dop853" { 30.0 } else { 100.0 };
    let steps = (10 + reported.steps) as f64;
    let allowed = 1e-11 + room * steps * asked * sensitivity.growth + 10.0 * sensitivity.error;
    if allowed.is_nan() || allowed > UNREPORTED {
        return Outcome::Undecided("too sensitive");
    }
    if matches!(reported.end, End::Stopped) != known.arrival.stopped {
        let (t, end) = (reported.time, known.arrival.time);
        return failed(Kind::Wrong, format!("the event is missed: t = {t} in place of {end}"));
    }
    let off = distance(&reported.state, &known.arrival.state) / known.scale;
    // `run` says in a line that the energy has left its value by so much
    let is_said = reported.gauges.iter().any(|gauge| {
        gauge.name == "energy" && gauge.max_drift > REPORTED && gauge.max_drift > 0.1 * off
    });
    if case.tolerance.is_some() && off > allowed && is_said {
        return Outcome::Stopped;
    }
    if off.is_nan() || off > allowed {
        let message = format!(
            "off by {off:.1e} where {allowed:.1e} is allowed (growth {:.1e}, {} steps): {:?} in place of {:?}",
            sensitivity.growth, reported.steps, reported.state, known.arrival.state
        );
        return failed(Kind::Wrong, message);
    }
    let late = (reported.time - known.arrival.time).abs() / case.length;
    if late > allowed {
        return failed(Kind::Wrong, format!("the event is {late:.1e} of the run late"));
    }
    // a drift is relative to what moves: that of a state at its tolerance may be large where what moves is small beside
    // what does not; it is then called by its name
    let terms = known.arrival.way.iter().map(|(t, state)| energy(case, *t, state).1);
    let terms = terms.fold(0.0, f64::max);
    let is_named = |g: &Gauge| {
        let accurate = g.name == "energy" && g.farthest <= 1000.0 * allowed * terms;
        accurate && ["secular", "lost"].contains(&g.word)
    };
    let limit = 1e-8_f64.max(1000.0 * allowed);
    let drifts = |g: &&Gauge| !g.broken && g.max_drift > limit && !is_named(g);
    if let Some(gauge) = reported.gauges.iter().find(drifts) {
        let Gauge { name, word, max_drift, .. } = gauge;
        let message = format!("`{name}` drifts by {max_drift:.1e}, {word}");
        return failed(Kind::FalselyConserved, message);
    }
    let allowed = allowed * known.scale;
    // a verdict may be open only on a motion that has hardly come back, or that something drives
    let is_short = turns(&known.arrival.way) <= FEW_TURNS || !case.keeps_energy();
    let failure = twin_failure(as_run, reported, (allowed, is_short), budget, cancel);
    failure.map_or(Outcome::Accurate, Outcome::Failed)
}

/// The turns after which errors have turned often enough for a verdict: those that accumulate must have come back three times.
const FEW_TURNS: usize = 16;

/// How often the coordinate that turns most often does so along a way.
pub(crate) fn turns(way: &[(f64, Vec<f64>)]) -> usize {
    let count = way.first().map_or(0, |(_, state)| state.len());
    let turns_of = |i: usize| {
        let steps = way.windows(2).map(|pair| pair[1].1[i] - pair[0].1[i]);
        let ways: Vec<bool> = steps.filter(|step| *step != 0.0).map(|step| step > 0.0).collect();
        ways.windows(2).filter(|pair| pair[0] != pair[1]).count()
    };
    (0..count).map(turns_of).max().unwrap_or(0)
}

/// Checks the energy at the end, and the reports about it.
fn energy_failure(case: &Case, known: &Known, reported: &RunReport) -> Option<Failure> {
    let (now, size) = energy(case, reported.time, &reported.state);
    let wrong = |kind, message: String| Some(Failure { kind, message });
    let shown = reported.energy?;
    let rounding = rounding_of_energy(case, reported.time, &reported.state);
    if size.is_finite() && (shown - now).abs() > 1e-9 * size + 10.0 * rounding + 1e-300 {
        return wrong(Kind::EnergyWrong, format!("{shown} is shown, {now} it is"));
    }
    if !case.keeps_energy() {
        return None;
    }
    let (first, first_size) = energy(case, 0.0, &case.start);
    let way = known.arrival.way.iter().map(|(t, state)| energy(case, *t, state).1);
    let size = way.fold(first_size, f64::max).max(1e-300);
    if !(now.is_finite() && size.is_finite()) && reported.state.iter().all(|x| x.is_finite()) {
        // the terms overflow as they are written here
        return None;
    }
    // NaN stays NaN
    let drift = ((now - first).abs() - 10.0 * rounding) / size;
    let gauge = reported.gauges.iter().find(|g| g.name == "energy")?;
    let said = gauge.max_drift;
    // a drift is relative to what moves, also where the motion is wrong
    if drift > 1e-3 && said < 0.1 * drift.min(1.0) {
        return wrong(
            Kind::Silent,
            format!("the energy is off by {drift:.1e}, {said:.1e} is reported"),
        );
    }
    if drift.is_nan() || drift > 0.3 && ["exact", "bounded"].contains(&gauge.word) {
        let word = gauge.word;
        return wrong(Kind::Silent, format!("the energy is off by {drift:.1e}, {word}"));
    }
    None
}

/// The change of the energy by the last digits of a state, large near the speed of light, and by those of its terms.
fn rounding_of_energy(case: &Case, time: f64, state: &[f64]) -> f64 {
    let here = energy(case, time, state).0;
    let change = |i: usize| {
        let mut moved = state.to_vec();
        moved[i] *= 1.0 - f64::EPSILON;
        (energy(case, time, &moved).0 - here).abs()
    };
    let changes = (0..state.len()).map(change).chain([rounding_of_terms(case, time, state)]);
    changes.filter(|x| x.is_finite()).sum()
}

/// Finds a quantity that is conserved by the form of the law but not reported as such.
fn form_failure(case: &Case, reported: &RunReport) -> Option<Failure> {
    let wrong = |message: String| Some(Failure { kind: Kind::NotConserved, message });
    let gauge = reported.gauges.iter().find(|g| g.name == "energy");
    if case.keeps_energy() && gauge.is_none_or(|g| g.broken) {
        return wrong("the energy".to_owned());
    }
    let momentum = |i: &usize| format!("p_{}", case.names[*i]);
    let mut cyclic = (0..case.count()).filter(|i| case.is_cyclic(*i)).map(|i| momentum(&i));
    let missed = cyclic.find(|name| !reported.conserved.contains(name));
    missed.and_then(wrong)
}

/// Compares the result with that in natural units.
fn twin_failure(
    case: &Case,
    reported: &RunReport,
    (allowed, is_short): (f64, bool),
    budget: Budget,
    cancel: &Cancel,
) -> Option<Failure> {
    let natural = case.in_natural_units();
    if natural.units == case.units {
        return None;
    }
    let wrong = |message: String| Some(Failure { kind: Kind::UnitsMatter, message });
    let Ok(vakonomic) = run(&natural, budget, cancel) else {
        return wrong("the twin is refused".to_owned());
    };
    if vakonomic.conserved != reported.conserved {
        let (here, there) = (reported.conserved.join(", "), vakonomic.conserved.join(", "));
        return wrong(format!("conserved are {here}; in natural units {there}"));
    }
    let off = distance(&vakonomic.state, &reported.state);
    if off.is_nan() || off > 2.0 * allowed {
        return wrong(format!("off by {off:.1e} in natural units"));
    }
    // if drifts are rounding errors, verdicts may depend on the digits; the steps of an adaptive method that conserves
    // nothing depend on them too, and whether their errors show a trend may lie on the border; errors at kinks that are
    // stepped over are as large as chance has it
    let on_the_border = |a: &Gauge, b: &Gauge| {
        // and so does whether the errors of a short motion have turned often enough to be called anything
        let words = &["bounded", "secular", "open"][..if is_short { 3 } else { 2 }];
        let alike = a.max_drift.max(b.max_drift) < 10.0 * a.max_drift.min(b.max_drift);
        (reported.over_kinks || case.tolerance.is_some() && alike)
            && words.contains(&a.word)
            && words.contains(&b.word)
    };
    let differs = |(a, b): &(&Gauge, &Gauge)| {
        a.word != b.word && a.max_drift.max(b.max_drift) > 1e-10 && !on_the_border(a, b)
    };
    let pairs = reported.gauges.iter().zip(&vakonomic.gauges);
    let (a, b) = pairs.into_iter().find(differs)?;
    wrong(format!("`{}` is {} and in natural units {}", a.name, a.word, b.word))
}
