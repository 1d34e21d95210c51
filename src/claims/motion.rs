//! The motion against which the claims of a file are checked: followed from event to event within a budget of steps.
//!
//! In: a model, its equations and its system. Out: a diagnostic for each value, event and conserved quantity that is
//! not as the file has it, and for a motion that cannot start. Never here: what is proved symbolically.

use super::conservation::Claim;
use super::observation::{self, Observation};
use super::own_method::{self, LENGTH};
use super::quantity_sizes::{QuantitySizes, tolerated_delay};
use super::start;
use super::unresolved::unresolved_feature;
use crate::diagnostic::{Diagnostic, SourceRange};
use crate::expr::Symbol;
use crate::integrate::{self, Occurrence, Reached, Settings, method_named};
use crate::mechanics::{Equations, Valuation};
use crate::model::{ExpectedEvent, ExpectedValue, Model};
use crate::system::{ChannelKind, MotionError, MotionErrorKind, Observer, System};

/// The assumed relative error of the values of a motion where a rate is evaluated.
const SLACK: f64 = 1e-9;

/// A late event is waited for over this part of the time to when it is expected.
const LATER: f64 = 0.5;

/// The work allowed for the claims of one file: the number of steps for a system whose equations
/// have one term. Larger systems get fewer.
const WORK: u64 = 4_000_000;

/// The minimal number of steps, however large the system.
const FEWEST_STEPS: u64 = 5_000;

/// How far the motion has come is reported once in so many steps.
const STEPS_PER_REPORT: u64 = 64;

/// The cost of an event in steps, since it is located and divides a step.
const EVENT: u64 = 4;

/// The number of steps allowed for claims: the larger the equations, the fewer.
fn steps_for(equations: &Equations) -> u64 {
    let pool = &equations.pool;
    let roots = equations.flow.expressions();
    (WORK / (pool.reachable(&roots).len() as u64).max(1)).max(FEWEST_STEPS)
}

/// The motion against which claims are checked.
pub(super) struct ClaimedMotion<'a> {
    system: &'a System,
    course: integrate::Propagator,
    observer: Observer,
    values: Vec<f64>,
    /// The number of steps allowed in total, and the number left.
    allowed: u64,
    budget: u64,
    occurrences: Vec<Occurrence>,
    /// The propagator's count of changes of its constraints when the observer was created.
    active_set_changes: u64,
}

/// Why a motion ended before a claim could be checked.
enum Short {
    MotionError(MotionError),
    Long(u64, f64),
    Ended(f64),
}

impl std::fmt::Display for Short {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Short::MotionError(error) => error.fmt(f),
            Short::Ended(time) => write!(f, "an event has ended the motion at t = {time}"),
            Short::Long(steps, time) => {
                write!(f, "the {steps} steps that a check may take led only to t = {time}")
            }
        }
    }
}

impl Short {
    /// The time it reached.
    fn time(&self) -> f64 {
        match self {
            Short::MotionError(error) => error.time,
            Short::Long(_, time) | Short::Ended(time) => *time,
        }
    }
}

/// The place in the file that explains why a start is impossible.
fn place_of(model: &Model, error: &MotionError) -> SourceRange {
    let constraint = match &error.kind {
        MotionErrorKind::ConstraintMissed(name, _)
        | MotionErrorKind::VelocitiesMissed(name, _)
        | MotionErrorKind::ConstraintInconsistent(name, _)
        | MotionErrorKind::ConstraintContradicts(name) => {
            model.constraints.iter().find(|c| c.name == *name)
        }
        MotionErrorKind::FreeVelocities(_) => model.constraints.first(),
        _ => None,
    };
    constraint.map_or(0..0, |c| c.place.clone())
}

fn seen(system: &System, values: &[f64], kind: ChannelKind) -> f64 {
    let channel = system.channels().iter().position(|c| c.kind == kind);
    channel.map_or(f64::NAN, |i| values[i])
}

impl<'a> ClaimedMotion<'a> {
    /// The motion at its start, with a first step that is known to succeed.
    pub(super) fn begin(
        model: &Model,
        equations: &Equations,
        system: &'a System,
    ) -> Result<ClaimedMotion<'a>, Diagnostic> {
        let refused = |place: SourceRange, why: String| {
            Diagnostic::error(place, format!("the motion cannot begin: {why}"))
        };
        let parameters = model.parameter_values();
        let method =
            method_named("auto").ok_or_else(|| refused(0..0, "there is no method".into()))?;
        let course = integrate::Propagator::new(system, method, Settings::default(), &parameters);
        let course = course.map_err(|error| refused(0..0, error.to_string()))?;
        let allowed = steps_for(equations);
        let mut motion = ClaimedMotion {
            system,
            course,
            observer: system.observer(&parameters),
            values: system.coordinates_of_start(&parameters, &[]),
            allowed,
            budget: allowed,
            occurrences: Vec::new(),
            active_set_changes: 0,
        };
        let state = system.initial(model.run.start, &parameters, &[]);
        let state = state.map_err(|error| match &error.kind {
            MotionErrorKind::ConstraintMissed(..)
            | MotionErrorKind::VelocitiesMissed(..)
            | MotionErrorKind::ConstraintInconsistent(..) => {
                refused(place_of(model, &error), error.to_string())
            }
            MotionErrorKind::FreeVelocities(names) => {
                let name = names.first().map_or("x", |name| name.trim_end_matches('\''));
                let help = format!("{name} = {{ initial = ..., velocity = 0 }} starts from rest");
                refused(place_of(model, &error), error.to_string()).with_help(help)
            }
            _ => motion
                .at_the_start(model, equations, Some(&error))
                .unwrap_or_else(|| refused(place_of(model, &error), error.to_string())),
        })?;
        let begun = motion.course.begin(&state, &parameters);
        // also where the motion cannot begin, since the values give the reason
        let outcome = motion.observer.observe(&state, &mut motion.values);
        let outcome = begun.and(outcome);
        // the first step, taken once more afterwards from the start
        let stepped = outcome.and_then(|()| {
            let end = model.run.until.unwrap_or(model.run.start + LENGTH);
            motion.course.reach(end, end, &mut 1)?;
            motion.course.begin(&state, &parameters)
        });
        let error = stepped.err().filter(|error| error.time == model.run.start);
        let own = || own_method::first_step(model, system, &state, &parameters);
        let error = error.filter(|_| !matches!(own(), Some(Ok(()))));
        if let Some(error @ MotionError { kind: MotionErrorKind::ConstraintContradicts(_), .. }) =
            &error
        {
            return Err(refused(place_of(model, error), error.to_string()));
        }
        match motion.at_the_start(model, equations, error.as_ref()) {
            Some(diagnostic) => Err(diagnostic),
            None => {
                if motion.course.begin(&state, &parameters).is_err() {
                    return Err(refused(model.law_place.clone(), "its state is lost".into()));
                }
                Ok(motion)
            }
        }
    }

    /// The reason why it cannot start, if it cannot.
    fn at_the_start(
        &self,
        model: &Model,
        equations: &Equations,
        error: Option<&MotionError>,
    ) -> Option<Diagnostic> {
        let energy = self.seen(ChannelKind::Energy);
        let known = self.valuation(model, equations, model.run.start);
        start::diagnostic(model, equations, error, energy, &|symbol| known.at(symbol))
    }

    /// What it may pass unseen.
    pub(super) fn unresolved_feature(
        &self,
        model: &Model,
        equations: &Equations,
    ) -> Option<Diagnostic> {
        let law = (model, equations, self.system);
        unresolved_feature(law, self.course.state(), &model.parameter_values())
    }

    /// The value of a channel at the last sample.
    fn seen(&self, kind: ChannelKind) -> f64 {
        seen(self.system, &self.values, kind)
    }

    /// The values of all symbols at the last sample.
    fn valuation(&self, model: &Model, equations: &Equations, time: f64) -> Valuation {
        let parameters = model.parameter_values();
        self.system.valuation((model, equations), time, &parameters, &self.values)
    }

    /// Follows the motion and checks all its claims.
    pub(super) fn follow(
        mut self,
        (model, equations): (&Model, &Equations),
        mut claims: Vec<Claim>,
        diagnostics: &mut Vec<Diagnostic>,
        report: &dyn Fn(&str, f64),
    ) {
        let start = model.run.start;
        let end = model.run.until.unwrap_or(start + LENGTH);
        let (expected, mut sizes) = (&model.expect.values, QuantitySizes::of(model));
        let schedule = observation::schedule(model, end, &sizes, !claims.is_empty());
        let last = schedule.last().map_or(end, |(time, _)| *time);
        let last = model.expect.counts.iter().map(|count| count.until).fold(last, f64::max);
        let later = |event: &ExpectedEvent| {
            event.at + (LATER * (event.at - start)).max(tolerated_delay(event, start))
        };
        let last = model.expect.events.iter().map(later).fold(last, f64::max);
        for (k, &(time, observation)) in schedule.iter().enumerate() {
            if let (true, Observation::Value(i)) = (time < start, observation) {
                let message = format!("the motion begins at {start}; {time} is before it");
                diagnostics.push(Diagnostic::error(expected[i].place.clone(), message));
                continue;
            }
            let claim = match observation {
                Observation::Value(i) => Some(&expected[i].name),
                Observation::Claims => claims.first().map(|claim| &claim.name),
                Observation::Sizes => expected.first().map(|value| &value.name),
            };
            let claim = claim.cloned().unwrap_or_default();
            if let Err(short) = self.reach(time, last, &|time| report(&claim, time)) {
                let values =
                    schedule[k..].iter().filter_map(|(_, observation)| observation.value());
                let values = values.map(|i| (&expected[i].name, &expected[i].place));
                let unchecked = |(name, place): (&String, &SourceRange)| {
                    let message = format!("`{name}` cannot be checked: {short}");
                    Diagnostic::error(place.clone(), message)
                };
                diagnostics.extend(values.map(unchecked));
                // what is conserved is so until the motion ends
                if matches!(short, Short::Ended(_)) {
                    self.sample(model, equations, &mut claims);
                    break;
                }
                let claims = claims.iter().map(|claim| (&claim.name, &claim.place));
                return diagnostics.extend(claims.map(unchecked));
            }
            let known = self.valuation(model, equations, time);
            sizes.observe(equations, time, &|symbol| known.at(symbol));
            match observation {
                Observation::Value(i) => {
                    diagnostics.extend(self.compare(&expected[i], sizes.tolerance(i)));
                }
                Observation::Claims => self.sample(model, equations, &mut claims),
                Observation::Sizes => {}
            }
        }
        let known = self.valuation(model, equations, end);
        let at = |symbol: Symbol| known.at(symbol);
        diagnostics.extend(claims.iter().filter_map(|claim| {
            let seen = claim.diagnostic(equations, end);
            let unseen = || claim.unseen(equations, end);
            seen.or_else(unseen).or_else(|| claim.one_sided(equations, &at, end))
        }));
        if !(model.expect.events.is_empty() && model.expect.counts.is_empty()) {
            let events = model.expect.events.iter().map(|event| &event.name);
            let counts = model.expect.counts.iter().map(|count| &count.name);
            let claim = events.chain(counts).next().cloned().unwrap_or_default();
            let report = |time: f64| report(&claim, time);
            let short =
                self.reach(last, last, &report).err().filter(|why| !matches!(why, Short::Ended(_)));
            diagnostics.extend(self.false_occurrences(model, short.as_ref()));
        }
    }

    /// Events that did not occur when, or as often as, the file states.
    fn false_occurrences(&self, model: &Model, short: Option<&Short>) -> Vec<Diagnostic> {
        let times = |name: &str| -> Vec<f64> {
            self.occurrences.iter().filter(|h| h.name == name).map(|h| h.time).collect()
        };
        let until = short.map_or(String::new(), |why| format!("; {why}"));
        let mut diagnostics = Vec::new();
        for expected in &model.expect.events {
            let (name, nth, at) = (&expected.name, expected.nth, expected.at);
            let message = match times(name).get(nth.wrapping_sub(1)) {
                Some(&time) if (time - at).abs() <= tolerated_delay(expected, model.run.start) => {
                    continue;
                }
                Some(time) => format!(
                    "`{name}` happens at t = {time}, not {at}: it is off by {:.1e}",
                    (time - at).abs()
                ),
                None => format!("`{name}` does not happen {nth} times{until}"),
            };
            diagnostics.push(Diagnostic::error(expected.place.clone(), message));
        }
        for expected in &model.expect.counts {
            let (name, is) = (&expected.name, expected.is);
            let found = times(name).iter().filter(|time| **time <= expected.until).count();
            let unseen = short.filter(|why| why.time() < expected.until);
            let message = match unseen {
                Some(why) if found <= is => format!(
                    "`{name}` cannot be counted until t = {}: {why}; it happens {found} times until \
                     then",
                    expected.until
                ),
                None if found == is => continue,
                Some(why) => format!("`{name}` happens {found} times and more, not {is}: {why}"),
                None => {
                    format!("`{name}` happens {found} times until t = {}, not {is}", expected.until)
                }
            };
            diagnostics.push(Diagnostic::error(expected.place.clone(), message));
        }
        diagnostics
    }

    fn reach(&mut self, time: f64, limit: f64, report: &dyn Fn(f64)) -> Result<(), Short> {
        loop {
            report(self.course.undisturbed().1);
            let portion = self.budget.min(STEPS_PER_REPORT);
            let mut left = portion;
            let reached = self.course.reach(time, limit, &mut left);
            self.budget -= portion - left;
            match reached.map_err(Short::MotionError)? {
                Reached::Arrived => break,
                Reached::OutOfBudget if self.budget > 0 => {}
                Reached::OutOfBudget => {
                    // the state itself is that of the last sample
                    return Err(Short::Long(self.allowed, self.course.undisturbed().1));
                }
                Reached::Ended => return Err(Short::Ended(self.course.state().time)),
                // no claim is made of the crossings of a picture, and of the steps of a law
                Reached::Occurred(integrate::Occurrence {
                    kind:
                        integrate::OccurrenceKind::Crossing(_) | integrate::OccurrenceKind::StepInTime,
                    ..
                }) => {}
                Reached::Occurred(occurrence) => {
                    if self.budget < EVENT {
                        return Err(Short::Long(self.allowed, occurrence.time));
                    }
                    self.budget -= EVENT;
                    if matches!(occurrence.kind, integrate::OccurrenceKind::Release(_)) {
                        let parameters = self.observer.parameters().to_vec();
                        self.observer = self.course.system().observer(&parameters);
                    }
                    self.occurrences.push(occurrence);
                }
            }
        }
        if self.active_set_changes != self.course.active_set_changes() {
            self.active_set_changes = self.course.active_set_changes();
            let parameters = self.observer.parameters().to_vec();
            self.observer = self.course.system().observer(&parameters);
        }
        self.observer.observe(self.course.state(), &mut self.values).map_err(Short::MotionError)
    }

    fn compare(&self, expected: &ExpectedValue, within: f64) -> Option<Diagnostic> {
        let ExpectedValue { name, at, is, .. } = expected;
        let channel = self.system.channel_of(expected.expression)?;
        let value = self.values[channel];
        let error = (value - is).abs();
        // written so that a NaN is wrong
        if error <= within {
            return None;
        }
        let message = format!("{name}: this is {value} at t = {at}, not {is}");
        let help = format!("it is off by {error:.1e}; up to {within:e} would be right");
        Some(Diagnostic::error(expected.place.clone(), message).with_help(help))
    }

    fn sample(&mut self, model: &Model, equations: &Equations, claims: &mut [Claim]) {
        let time = self.course.state().time;
        let known = self.valuation(model, equations, time);
        let at = |symbol: Symbol| known.at(symbol);
        for claim in claims {
            let Some(channel) = self.system.channel_of(claim.expression) else { continue };
            let value = self.values[channel];
            let (_, size) = equations.pool.evaluate_with_size(claim.expression, &at);
            claim.underflows |=
                size < f64::MIN_POSITIVE && equations.pool.underflows(claim.expression, &at);
            claim.sample(value, if size.is_finite() { size } else { value.abs() });
            claim.see_sides(equations, &at);
            claim.refuted |= claim
                .rate
                .is_some_and(|e| equations.pool.vanishes_at(e, SLACK, &at) == Some(false));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Expr;
    use crate::mechanics::{self, Flow};

    fn steps(law: &str) -> (u64, u64) {
        let text = format!(
            "title = \"a\"\n[coordinates]\nx = {{ initial = 1 }}\n[lagrangian]\nL = \"{law}\""
        );
        let model = crate::preset::read(&text).expect("right").model;
        let equations = mechanics::derive(&model).expect("derivable");
        let Flow::Lagrange { mass, force, .. } = &equations.flow else { panic!("a Lagrangian") };
        let roots: Vec<Expr> = mass.concat().into_iter().chain(force.clone()).collect();
        (steps_for(&equations), equations.pool.reachable(&roots).len() as u64)
    }

    #[test]
    fn claims_are_worth_four_million_evaluations_of_one_part() {
        let (steps, parts) = steps("1/2*x'^2 - 1/2*x^2");
        assert!(parts < 20);
        assert_eq!(steps, 4_000_000 / parts);
    }

    #[test]
    fn large_systems_are_still_given_five_thousand_steps() {
        let terms: Vec<String> = (1..400).map(|k| format!("sin({k}*x)/({k} + x^2)")).collect();
        let (steps, parts) = steps(&format!("1/2*x'^2 - ({})", terms.join(" + ")));
        assert!(parts > 800, "{parts}");
        assert_eq!(steps, 5_000);
    }
}
