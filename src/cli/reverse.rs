//! `phaselab reverse`: a motion carried on, its time reversed, and carried back to where it began.
//!
//! In: arguments. Out: how far it comes back from its start, beside what the exponents of the motion predict. Never here: how
//! time is reversed (`experiment`).

use serde_json::{Map, Value, json};

use super::assignment::number;
use super::error::CommandError;
use super::interrupt::Interrupt;
use super::motion_options::CompiledMotion;
use super::run::progress::Bar;
use super::study::{self, StudyArguments, shown};
use crate::dynamics::{DynamicsError, PhaseSpace, lyapunov, return_growth};
use crate::experiment::{AdvanceOutcome, Command, Experiment, Return, Setup, Status};
use crate::integrate::Stepping;
use crate::printable;

/// Reverse a motion and bring it back.
///
/// The motion is carried to T and from there back to its start by the same method. Each step, there
/// and back, errs by ε, and its error grows on the rest of the way: like e^{λt} in chaos, λ the
/// largest exponent of the reversed motion, −λₙ; in proportion to the time where the motion is
/// regular. What is expected is the sum of all, by the derivative of the flow. ε is the tolerance,
/// or the rounding where a step back is the inverse of one forwards: errors that are independent,
/// and add up as the root of their squares. For rk4, dop853 and symplectic-euler ε is measured over
/// steps there and back; such errors have one sign, and the sum is a bound. Where there is no way
/// back, as over impulses or dry friction, the reason is given.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab reverse pendulum --until 50
  phaselab reverse henon-heiles --until 200 --tolerance 1e-12
  phaselab reverse double-pendulum --until 10 --format json")]
pub(super) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// When to reverse; by default as the file says, or 10 after the start.
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = number)]
    until: Option<f64>,
}

/// The steps between two checks of the time and of signals.
const STEPS: u64 = 256;

/// The number of times that the gauges are sampled on the way.
const OBSERVATIONS: f64 = 1000.0;

pub(super) fn execute(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    let motion = &arguments.study.motion;
    let compiled = motion.compile(motion.read()?, &[], "", interrupt)?;
    let start = compiled.start.time;
    let until = arguments.until.or(compiled.model.run.until).unwrap_or(start + 10.0);
    if until.partial_cmp(&start) != Some(std::cmp::Ordering::Greater) {
        let [until, start] = [until, start].map(printable::number);
        let message = format!("a motion begins at {start}; --until {until} is not after it");
        return Err(CommandError::WrongUse(message));
    }
    interrupt.ends_by_itself(|| ());
    let (returned, steps) = returned(&compiled, until, interrupt)?;
    let rate = rate(&compiled, returned.turned);
    let bounded = returned.step.is_some() || compiled.method.stepping == Stepping::Adaptive;
    let over_kinks = compiled.system.has_kinks() && !compiled.method.locates_kinks;
    let expected = if over_kinks { None } else { expected(&compiled, &returned) };
    let found = ReversedRun { bounded, returned, steps, rate, expected, over_kinks };
    let result = (found.object(&compiled), found.text());
    study::write(&arguments.study, result, None, interrupt)
}

/// The error that is expected at the start, by the growth of the errors of all steps on the way back. `None` where that is
/// not known.
fn expected(compiled: &CompiledMotion, returned: &Return) -> Option<f64> {
    let parameters = &compiled.start.parameters;
    let CompiledMotion { model, equations, system, .. } = compiled;
    let space = PhaseSpace::on_constraints((model, equations, system), parameters).ok()?;
    let turned = space.state(&returned.state).ok()?;
    let growth =
        return_growth(&space, (compiled.method, compiled.settings), &turned, returned.start)?;
    let growth =
        growth.last().filter(|last| last.elapsed == (returned.turned - returned.start).abs())?;
    let expected =
        growth.expected(returned.step_error, returned.mean_step, returned.step.is_none());
    Some(expected).filter(|expected| expected.is_finite())
}

/// How the motion returned, and what was expected.
struct ReversedRun {
    /// Whether what is expected is a bound.
    bounded: bool,
    returned: Return,
    steps: u64,
    /// The largest exponent of the reversed motion and its uncertainty, or why it is not known.
    rate: Result<(f64, f64), String>,
    expected: Option<f64>,
    /// Whether the method steps over kinks, whose errors are neither independent nor of one size.
    over_kinks: bool,
}

/// Carries the motion there and back.
fn returned(
    compiled: &CompiledMotion,
    until: f64,
    interrupt: &Interrupt,
) -> Result<(Return, u64), CommandError> {
    let start = compiled.start.time;
    let setup = Setup {
        parameters: compiled.start.parameters.clone(),
        overrides: compiled.start.overrides.clone(),
        method: compiled.method.name.to_owned(),
        settings: compiled.settings,
        spacing: (until - start) / OBSERVATIONS,
        ..Setup::of(&compiled.model)
    };
    let mut experiment =
        Experiment::new(&compiled.model, &compiled.equations, &compiled.system, setup)
            .map_err(|why| CommandError::WrongUse(why.to_string()))?;
    let (there, back) = (until, 2.0 * until - start);
    let mut bar = Bar::new(start, back);
    advance(&mut experiment, until, interrupt, &mut |clock| bar.show(clock))?;
    experiment.execute(Command::Reverse);
    if !experiment.is_backwards() {
        let notices = experiment.snapshot().notices;
        let why = notices.last().map_or("time is not reversed here", String::as_str);
        return Err(CommandError::CouldNot(why.to_owned()));
    }
    let home = -start;
    advance(&mut experiment, home, interrupt, &mut |clock| bar.show(clock + 2.0 * there))?;
    drop(bar);
    let snapshot = experiment.snapshot();
    match snapshot.returned {
        Some(returned) => Ok((returned, snapshot.method.steps)),
        None => Err(CommandError::CouldNot("the way there was not recorded".to_owned())),
    }
}

fn advance(
    experiment: &mut Experiment,
    clock: f64,
    interrupt: &Interrupt,
    report: &mut dyn FnMut(f64),
) -> Result<(), CommandError> {
    loop {
        let progress = experiment.advance(clock, STEPS);
        report(experiment.clock());
        if let Some(signal) = interrupt.signal() {
            return Err(CommandError::Signal(signal));
        }
        if let Status::Failed(error) = experiment.status() {
            return Err(CommandError::CouldNot(error.message));
        }
        if progress != AdvanceOutcome::Underway {
            return Ok(());
        }
    }
}

/// The largest exponent of the reversed motion, and its uncertainty.
fn rate(compiled: &CompiledMotion, until: f64) -> Result<(f64, f64), String> {
    let in_words = |why: DynamicsError| why.to_string();
    let parameters = &compiled.start.parameters;
    let space = PhaseSpace::on_constraints(
        (&compiled.model, &compiled.equations, &compiled.system),
        parameters,
    )
    .map_err(in_words)?;
    let start = compiled.start.state(&compiled.system).and_then(|state| space.state(&state));
    let start = start.map_err(|why| why.to_string())?;
    let method = (compiled.method, compiled.settings);
    let found = lyapunov(&space, method, &start, until, &mut |_| {}).map_err(in_words)?;
    if let Some(error) = found.error {
        return Err(error.to_string());
    }
    let pairs = found.exponents.iter().zip(&found.uncertainty);
    let least = pairs.min_by(|a, b| a.0.total_cmp(b.0));
    // the direction of the motion itself neither grows nor shrinks
    Ok(least.map_or((0.0, 0.0), |(rate, off)| ((-rate).max(0.0), *off)))
}

impl ReversedRun {
    fn object(&self, compiled: &CompiledMotion) -> Map<String, Value> {
        let parameters = &compiled.start.parameters;
        let method = (compiled.method, compiled.settings);
        let mut object = study::head(&compiled.model, &compiled.system, parameters, method);
        let mut insert = |name: &str, value: Value| object.insert(name.to_owned(), value);
        let rate = self.rate.as_ref().ok();
        insert("turned", json!(self.returned.turned));
        insert("t", json!(self.returned.start));
        insert("steps", json!(self.steps));
        insert("return_error", json!(self.returned.error));
        insert("step_error", json!(self.returned.step_error));
        insert("step", json!(self.returned.step));
        insert("exponent", json!(rate.map(|(rate, _)| rate)));
        insert("uncertainty", json!(rate.map(|(_, off)| off)));
        insert("expected", json!(self.expected));
        insert("message", json!(self.rate.as_ref().err()));
        object
    }

    fn text(&self) -> String {
        let Return { turned, start, step_error, error, .. } = &self.returned;
        let [turned, start] = [turned, start].map(|&time| shown(time));
        let error = match error {
            Some(0.0) => "to the last bit".to_owned(),
            Some(error) => format!("{error:.1e} from where it began"),
            None => "not to the start".to_owned(),
        };
        let mut text = format!("from t = {turned} back to t = {start}: {error}\n\n");
        text.push_str(&format!("ε, the error of a step  {step_error:.1e}\n"));
        match &self.rate {
            Ok((rate, off)) => {
                text.push_str(&format!("λ                       {} ± {off:.1e}\n", shown(*rate)));
            }
            Err(why) => text.push_str(&format!("λ is not known: {why}\n")),
        }
        if let Some(expected) = self.expected {
            // a tolerance bounds the error of a step, and so does what is measured of one sign; rounding is as large as it is
            let sum = if self.bounded {
                "of all steps, carried   ≤"
            } else {
                "of all steps, carried  "
            };
            text.push_str(&format!("{sum} {expected:.1e}\n"));
        } else if self.over_kinks {
            text.push_str(
                "what is expected is not known: the method steps over the kinks of this motion\n",
            );
        }
        text
    }
}
