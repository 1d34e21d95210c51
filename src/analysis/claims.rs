//! Whether what a file claims of itself is true: what it says is conserved is, and its numbers are
//! what the motion gives.
//!
//! In: a model and what follows from it. Out: a mistake for each claim that is false, at its
//! place. What is proved symbolically is not integrated. Never here: how claims are written.

use super::brackets::false_brackets;
use crate::expr::{Expr, Symbol};
use crate::integrate::{self, Happening, Reached, Settings, method_named};
use crate::mechanics::{self, Conserved, Equations};
use crate::model::{ExpectedValue, Model, Place};
use crate::preset::Mistake;
use crate::system::{ChannelKind, Fault, FaultKind, Observer, System};

/// How far a conserved quantity may drift, relative to the size of its terms.
const TOLERANCE: f64 = 1e-10;

/// How often it is looked at.
const LOOKS: u32 = 200;

/// How long a motion is followed where the file does not say.
const LENGTH: f64 = 10.0;

/// The most steps taken for one file.
const MOST_STEPS: u64 = 5_000_000;

/// The claims of a model that are false, as mistakes at their places.
pub fn false_claims(model: &Model, equations: &Equations) -> Vec<Mistake> {
    let mut mistakes = flaws(model, equations);
    if !mistakes.is_empty() {
        // the motion of what is no Poisson structure says nothing
        return mistakes;
    }
    mistakes.extend(denied(model, equations));
    mistakes.extend(false_brackets(model, equations));
    let claims = open_claims(model, equations);
    let system = match System::compile(model, equations, &[]) {
        Ok(system) => system,
        Err(why) => {
            mistakes.push(Mistake::error(0..0, why.to_string()));
            return mistakes;
        }
    };
    match Motion::begin(model, &system) {
        Ok(motion) => motion.follow(model, equations, claims, &mut mistakes),
        Err((place, why)) => {
            mistakes.push(Mistake::error(place, format!("the motion cannot begin: {why}")));
        }
    }
    for name in system.redundant() {
        let constraint = model.constraints.iter().find(|c| c.name == name);
        let message = format!("the constraint `{name}` repeats what those before it say");
        let warning = Mistake::warning(constraint.map_or(0..0, |c| c.place.clone()), message);
        mistakes.push(warning.with_help("their multipliers are those of least norm"));
    }
    mistakes
}

/// What is false in the brackets and Casimirs of a file: with such a mistake it has no motion.
pub fn flaws(model: &Model, equations: &Equations) -> Vec<Mistake> {
    let flaws = mechanics::flaws(model, equations).into_iter();
    flaws.map(|flaw| Mistake::error(flaw.place, flaw.message).with_help(flaw.help)).collect()
}

/// Observables said not to be conserved that are.
fn denied(model: &Model, equations: &Equations) -> Vec<Mistake> {
    let wrong = |name: &str, place: &Place| {
        let reason = &known(equations, name)?.reason;
        let message = format!("`{name}` is said not to be conserved, but it is");
        Some(Mistake::error(place.clone(), message).with_help(format!("why: {reason}")))
    };
    let denied = model.observables.iter().filter(|o| o.conserved == Some(false));
    denied.filter_map(|o| wrong(&o.name, &o.place)).collect()
}

/// What is found to be conserved under that name, and not only said to be.
fn known<'a>(equations: &'a Equations, name: &str) -> Option<&'a Conserved> {
    equations.conserved.iter().find(|c| c.name == name && !c.reason.is_declared())
}

/// A quantity said to be conserved, of which that is not known.
struct Claim {
    name: String,
    place: Place,
    expression: Expr,
    first: f64,
    size: f64,
    farthest: f64,
}

fn open_claims(model: &Model, equations: &Equations) -> Vec<Claim> {
    let observed = model.observables.iter().filter(|o| o.conserved == Some(true));
    let observed = observed.map(|o| (&o.name, o.expression, &o.place));
    let expected = model.expect.conserves.iter().map(|(name, e, place)| (name, *e, place));
    observed
        .chain(expected)
        .filter(|(name, ..)| known(equations, name).is_none())
        .map(|(name, expression, place)| Claim {
            name: name.clone(),
            place: place.clone(),
            expression,
            first: f64::NAN,
            size: 0.0,
            farthest: 0.0,
        })
        .collect()
}

/// The motion that claims are held against.
struct Motion<'a> {
    system: &'a System,
    course: integrate::Motion,
    observer: Observer,
    values: Vec<f64>,
    budget: u64,
    happenings: Vec<Happening>,
}

/// Why a motion did not come as far as a claim.
enum Short {
    Fault(Fault),
    Long,
    Ended(f64),
}

impl std::fmt::Display for Short {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Short::Fault(fault) => fault.fmt(f),
            Short::Ended(time) => write!(f, "an event has ended the motion at t = {time}"),
            Short::Long => write!(f, "{MOST_STEPS} steps did not lead so far"),
        }
    }
}

/// Where in the file to look for the reason of a start that is none.
fn place_of(model: &Model, fault: &Fault) -> Place {
    let constraint = match &fault.kind {
        FaultKind::ConstraintMissed(name, _) => model.constraints.iter().find(|c| c.name == *name),
        FaultKind::FreeVelocities(_) => model.constraints.first(),
        _ => None,
    };
    constraint.map_or(0..0, |c| c.place.clone())
}

impl<'a> Motion<'a> {
    fn begin(model: &Model, system: &'a System) -> Result<Motion<'a>, (Place, String)> {
        let nowhere = |why: String| (0..0, why);
        let parameters = model.parameter_values();
        let method = method_named("auto").ok_or_else(|| nowhere("there is no method".into()))?;
        let course = integrate::Motion::new(system, method, Settings::default(), &parameters);
        let mut course = course.map_err(|refusal| nowhere(refusal.to_string()))?;
        let state = system.initial(model.run.start, &parameters, &[]);
        let state = state.map_err(|fault| (place_of(model, &fault), fault.to_string()))?;
        let begun = course.begin(&state, &parameters);
        begun.map_err(|fault| nowhere(fault.to_string()))?;
        let observer = system.observer(&parameters);
        let values = vec![f64::NAN; system.channels().len()];
        let happenings = Vec::new();
        Ok(Motion { system, course, observer, values, budget: MOST_STEPS, happenings })
    }

    /// Follows the motion through all that is claimed of it.
    fn follow(
        mut self,
        model: &Model,
        equations: &Equations,
        mut claims: Vec<Claim>,
        mistakes: &mut Vec<Mistake>,
    ) {
        let start = model.run.start;
        let end = model.run.until.unwrap_or(start + LENGTH);
        let looks = if claims.is_empty() { 0 } else { LOOKS };
        let look = |k| start + (end - start) * f64::from(k) / f64::from(LOOKS - 1);
        let values = model.expect.values.iter().map(|value| (value.at, Some(value)));
        let mut schedule: Vec<(f64, Option<&ExpectedValue>)> =
            (0..looks).map(|k| (look(k), None)).chain(values).collect();
        schedule.sort_by(|a, b| a.0.total_cmp(&b.0));
        let last = schedule.last().map_or(end, |(time, _)| *time);
        let last = model.expect.counts.iter().map(|count| count.until).fold(last, f64::max);
        let last = model.expect.events.iter().map(|event| event.at + 1.0).fold(last, f64::max);
        for (k, &(time, value)) in schedule.iter().enumerate() {
            if let (true, Some(value)) = (time < start, value) {
                let message = format!("the motion begins at {start}; {time} is before it");
                mistakes.push(Mistake::error(value.place.clone(), message));
                continue;
            }
            if let Err(short) = self.reach(time, last) {
                let left =
                    schedule[k..].iter().filter_map(|(_, value)| Some(&value.as_ref()?.place));
                let left = left.chain(claims.iter().map(|claim| &claim.place)).cloned();
                let message = format!("this cannot be checked: {short}");
                return mistakes.extend(left.map(|place| Mistake::error(place, message.clone())));
            }
            match value {
                Some(value) => mistakes.extend(self.compare(value)),
                None => self.look(model, equations, &mut claims),
            }
        }
        mistakes.extend(claims.iter().filter_map(|claim| claim.mistake(equations, end)));
        if !(model.expect.events.is_empty() && model.expect.counts.is_empty()) {
            let short = self.reach(last, last).err().filter(|why| !matches!(why, Short::Ended(_)));
            mistakes.extend(self.false_happenings(model, short.as_ref()));
        }
    }

    /// Events that did not happen when, or as often as, the file says.
    fn false_happenings(&self, model: &Model, short: Option<&Short>) -> Vec<Mistake> {
        let times = |name: &str| -> Vec<f64> {
            self.happenings.iter().filter(|h| h.name == name).map(|h| h.time).collect()
        };
        let until = short.map_or(String::new(), |why| format!("; {why}"));
        let mut mistakes = Vec::new();
        for expected in &model.expect.events {
            let (name, nth, at) = (&expected.name, expected.nth, expected.at);
            let message = match times(name).get(nth.wrapping_sub(1)) {
                Some(&time) if (time - at).abs() <= expected.within => continue,
                Some(time) => format!(
                    "`{name}` happens at t = {time}, not {at}: it is off by {:.1e}",
                    (time - at).abs()
                ),
                None => format!("`{name}` does not happen {nth} times{until}"),
            };
            mistakes.push(Mistake::error(expected.place.clone(), message));
        }
        for expected in &model.expect.counts {
            let (name, is) = (&expected.name, expected.is);
            let found = times(name).iter().filter(|time| **time <= expected.until).count();
            if found != is {
                let message = format!(
                    "`{name}` happens {found} times until t = {}, not {is}",
                    expected.until
                );
                mistakes.push(Mistake::error(expected.place.clone(), message));
            }
        }
        mistakes
    }

    fn reach(&mut self, time: f64, limit: f64) -> Result<(), Short> {
        loop {
            match self.course.reach(time, limit, &mut self.budget).map_err(Short::Fault)? {
                Reached::There => break,
                Reached::Underway => return Err(Short::Long),
                Reached::Ended => return Err(Short::Ended(self.course.state().time)),
                Reached::Happened(happening) => {
                    if matches!(happening.kind, integrate::Kind::Release(_)) {
                        let parameters = self.observer.parameters().to_vec();
                        self.observer = self.course.system().observer(&parameters);
                    }
                    self.happenings.push(happening);
                }
            }
        }
        self.observer.observe(self.course.state(), &mut self.values).map_err(Short::Fault)
    }

    fn compare(&self, expected: &ExpectedValue) -> Option<Mistake> {
        let ExpectedValue { name, at, is, within, .. } = expected;
        let channel = self.system.channel_of(expected.expression)?;
        let value = self.values[channel];
        let error = (value - is).abs();
        // written so that a value that is not a number is wrong
        if error <= *within {
            return None;
        }
        let message = format!("{name}: this is {value} at t = {at}, not {is}");
        let help = format!("it is off by {error:.1e}; up to {within:e} would be right");
        Some(Mistake::error(expected.place.clone(), message).with_help(help))
    }

    fn look(&mut self, model: &Model, equations: &Equations, claims: &mut [Claim]) {
        let kind = |kind| self.system.channels().iter().position(|c| c.kind == kind);
        let value = |wanted| kind(wanted).map_or(f64::NAN, |i| self.values[i]);
        let body = self.system.body_values(&model.parameter_values());
        let of_body = |symbol| body.iter().find(|(s, _)| *s == symbol).map(|(_, value)| *value);
        let at = |symbol: Symbol| {
            let place = |i: usize| {
                let c = &equations.coordinates[i];
                let all = [
                    (c.position, ChannelKind::Position(i)),
                    (c.velocity, ChannelKind::Velocity(i)),
                    (c.momentum, ChannelKind::Momentum(i)),
                ];
                all.into_iter().find(|(s, _)| *s == symbol).map(|(_, kind)| value(kind))
            };
            let coordinate = (0..equations.coordinates.len()).find_map(place);
            let parameter = || model.parameters.iter().find(|p| p.symbol == symbol);
            match coordinate {
                Some(value) => value,
                None if symbol == equations.symbols.time => self.course.state().time,
                None if symbol == equations.symbols.energy => value(ChannelKind::Energy),
                None => match parameter() {
                    Some(p) => p.value,
                    None => of_body(symbol).unwrap_or(f64::NAN),
                },
            }
        };
        for claim in claims {
            let Some(channel) = self.system.channel_of(claim.expression) else { continue };
            let value = self.values[channel];
            let (_, size) = equations.pool.evaluate_with_size(claim.expression, &at);
            claim.look(value, if size.is_finite() { size } else { value.abs() });
        }
    }
}

impl Claim {
    fn look(&mut self, value: f64, size: f64) {
        if self.first.is_nan() {
            self.first = value;
        }
        self.size = self.size.max(size);
        let distance = (value - self.first).abs();
        self.farthest =
            if distance.is_finite() { self.farthest.max(distance) } else { f64::INFINITY };
    }

    fn mistake(&self, equations: &Equations, end: f64) -> Option<Mistake> {
        let Claim { name, .. } = self;
        if self.first.is_nan() {
            let message = format!("`{name}` is said to be conserved, but it is not a number");
            return Some(Mistake::error(self.place.clone(), message));
        }
        if self.farthest <= TOLERANCE * self.size {
            return None;
        }
        let drift = self.farthest / self.size;
        let message = format!("`{name}` is said to be conserved, but it is not");
        let mut help = format!("it drifts by {drift:.1e} of its size until t = {end}");
        if name == "energy" {
            let rate = equations.pool.unicode(equations.energy_rate);
            help = format!("{help}; dE/dt = {rate}");
        }
        Some(Mistake::error(self.place.clone(), message).with_help(help))
    }
}
