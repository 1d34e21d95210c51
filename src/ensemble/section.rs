//! Where an orbit crosses a surface of section, or the instants of a stroboscope.
//!
//! In: a start, an expression that vanishes on the surface. Out: the values of all columns at each crossing. The
//! crossings are those of an event without effect on the motion (H. Poincaré, Les méthodes nouvelles, vol. III, ch.
//! XXVII), located on the dense output of the method: the state there is as exact as the method's own, and no step is
//! different from what it is without the section. A start on the surface is no crossing. Never here: many orbits, files.

use super::Start;
use crate::cancel::Cancel;
use crate::expr::Expr;
use crate::integrate::{Method, OccurrenceKind, Propagator, Reached, Settings, spacing};
use crate::model::{Direction, EventAction, Model, MotionEvent};
use crate::num::short;
use crate::system::{MotionError, Observer, State, System};

/// The event of a section in a compiled system, and when an orbit ends.
#[derive(Clone, PartialEq, Debug)]
pub struct SectionPlan {
    /// The event's index in the compiled system, from [`add_section`] or [`Model::event_of_section`].
    pub event: usize,
    /// The number of crossings after which an orbit ends.
    pub count: Option<u64>,
    /// The time at which it ends.
    pub until: Option<f64>,
    /// An orbit without an end in time ends after so many steps without a crossing.
    pub idle: u64,
    /// Whether a crossing has all channels of the system, and not only its columns.
    pub all_channels: bool,
}

/// How an orbit ended.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum OrbitStatus {
    /// All that was asked for is there.
    Completed,
    /// An event of the system or the user ended it, or it crosses no more.
    Stopped,
    /// The motion could not continue.
    Failed,
    /// It could not begin.
    Refused,
}

impl OrbitStatus {
    /// The word in tables.
    pub fn word(self) -> &'static str {
        match self {
            OrbitStatus::Completed => "completed",
            OrbitStatus::Stopped => "stopped",
            OrbitStatus::Failed => "faulted",
            OrbitStatus::Refused => "refused",
        }
    }
}

/// The crossings of one orbit.
#[derive(Clone, PartialEq, Debug)]
pub struct Crossings {
    /// For each crossing the time, then the value of every column, or every channel, of the system.
    pub rows: Vec<Vec<f64>>,
    /// How the orbit ended.
    pub status: OrbitStatus,
    /// Why it ended, if that needs a sentence.
    pub message: Option<String>,
}

impl SectionPlan {
    /// The number of values of a crossing.
    pub(super) fn width(&self, system: &System) -> usize {
        if self.all_channels { system.channels().len() } else { system.columns() }
    }

    pub(super) fn see(
        &self,
        observer: &mut Observer,
        state: &State,
        values: &mut [f64],
    ) -> Result<(), MotionError> {
        if self.all_channels {
            observer.observe(state, values)
        } else {
            observer.observe_columns(state, values)
        }
    }
}

/// How far an orbit that begins at a time is followed at first, and a time that no step goes beyond. Where there is no end
/// in time, no step ends early at one.
pub(super) fn first_limit(plan: &SectionPlan, start: f64) -> (f64, f64) {
    let target = plan.until.unwrap_or(start + span_ahead(start, FIRST_SPAN));
    (target, plan.until.unwrap_or(target + span_ahead(target, FIRST_SPAN)))
}

/// The same for an orbit without an end in time that was followed to `target`, by a last step of this size.
pub(super) fn next_limit(target: f64, step: f64) -> (f64, f64) {
    let ahead = span_ahead(target, (STEPS_AHEAD * step.abs()).max(FIRST_SPAN));
    (target + ahead, target + ahead + ahead)
}

/// How far to advance from a time on: `wanted`, or where that is lost in the digits of the time the least that is not.
fn span_ahead(from: f64, wanted: f64) -> f64 {
    wanted.max(2.0 * spacing(from))
}

/// Why no crossing can be located after a first step of this size: times there are so far apart that the step is lost in
/// their digits.
pub(super) fn too_coarse(time: f64, step: f64) -> Option<String> {
    let spacing = spacing(time);
    (spacing > step.abs() / LEAST_TIMES).then(|| {
        format!(
            "at t = {} times are {} apart, which is too much for steps of {} to locate a crossing in",
            short(time),
            short(spacing),
            short(step.abs())
        )
    })
}

/// An orbit that a signal has ended.
pub(super) fn stopped_by_a_signal(rows: Vec<Vec<f64>>) -> Crossings {
    let message = Some("stopped by a signal".to_owned());
    Crossings { rows, status: OrbitStatus::Stopped, message }
}

impl Crossings {
    /// An orbit that could not begin.
    pub fn refused(why: &impl ToString) -> Crossings {
        let message = Some(why.to_string());
        Crossings { rows: Vec::new(), status: OrbitStatus::Refused, message }
    }
}

/// Adds the event of a section to a model before its equations are derived, and returns the event's index in the system compiled from
/// it. No other event or impulse has its name.
pub fn add_section(model: &mut Model, when: Expr, direction: Direction) -> usize {
    let name = section_name(model);
    let event = model.events.len();
    model.events.push(MotionEvent {
        name,
        when,
        direction,
        action: EventAction::Mark,
        place: None,
    });
    event
}

/// A name for the event of a section, which no other event, section or impulse has.
pub fn section_name(model: &Model) -> String {
    let mut name = "section".to_owned();
    let taken = |name: &str| {
        model.located_events().any(|event| event.name == name)
            || model.impulses.iter().any(|impulse| impulse.name == name)
    };
    while taken(&name) {
        name.push('\'');
    }
    name
}

/// The steps between two checks of the token.
const STEPS_PER_CHECK: u64 = 64;

/// Where no end is given, the time is first advanced so far, and then by so many of the steps taken: far more than the greatest
/// ratio of a step to the one before, as the state at each of these times is computed.
const FIRST_SPAN: f64 = 1.0;
const STEPS_AHEAD: f64 = 64.0;

/// A step in which a crossing can be located has at least so many times.
const LEAST_TIMES: f64 = 16.0;

/// Follows an orbit from one crossing to the next.
pub fn crossings(
    system: &System,
    method: &'static Method,
    settings: Settings,
    start: &Start,
    plan: &SectionPlan,
) -> Crossings {
    let begin = |motion: &mut Propagator| {
        start.state(system).and_then(|state| motion.begin(&state, &start.parameters))
    };
    followed((system, method, settings), (start.time, &start.parameters), plan, begin)
}

/// The same from a state of a motion on, at which what happens at its time is past.
pub fn crossings_from(
    system: &System,
    method: (&'static Method, Settings),
    state: &State,
    parameters: &[f64],
    plan: &SectionPlan,
) -> Crossings {
    let begin = |motion: &mut Propagator| motion.restore(state, parameters, state.time, &[]);
    followed((system, method.0, method.1), (state.time, parameters), plan, begin)
}

fn followed(
    (system, method, settings): (&System, &'static Method, Settings),
    (start, parameters): (f64, &[f64]),
    plan: &SectionPlan,
    begin: impl FnOnce(&mut Propagator) -> Result<(), MotionError>,
) -> Crossings {
    let made = Propagator::new(system, method, settings, parameters);
    let mut motion = match made {
        Ok(motion) => motion,
        Err(why) => return Crossings::refused(&why),
    };
    if let Err(why) = begin(&mut motion) {
        return Crossings::refused(&motion.explained(why));
    }
    let observer = motion.system().observer(parameters);
    let values = vec![0.0; plan.width(system)];
    let mut orbit = SectionOrbit {
        motion,
        observer,
        values,
        active_set_changes: 0,
        plan,
        start,
        parameters,
        rows: Vec::new(),
    };
    let (status, message) = orbit.follow(system.cancel());
    Crossings { rows: orbit.rows, status, message }
}

struct SectionOrbit<'a> {
    motion: Propagator,
    observer: Observer,
    values: Vec<f64>,
    active_set_changes: u64,
    plan: &'a SectionPlan,
    start: f64,
    parameters: &'a [f64],
    rows: Vec<Vec<f64>>,
}

impl SectionOrbit<'_> {
    fn follow(&mut self, cancel: &Cancel) -> (OrbitStatus, Option<String>) {
        let stopped = || {
            let Crossings { status, message, .. } = stopped_by_a_signal(Vec::new());
            (status, message)
        };
        let (mut target, mut limit) = first_limit(self.plan, self.start);
        let begun = self.motion.steps();
        let (mut last, mut is_first) = (begun, true);
        loop {
            if self.plan.count.is_some_and(|count| self.rows.len() as u64 >= count) {
                return (OrbitStatus::Completed, None);
            }
            let reached = self.motion.reach(target, limit, &mut STEPS_PER_CHECK.clone());
            let step = self.motion.step_size();
            // an impulse begins the motion anew, without a step
            if is_first && self.motion.steps() > begun && step != 0.0 {
                is_first = false;
                let time = self.motion.computed().time;
                if let Some(why) = too_coarse(time, step) {
                    return (OrbitStatus::Failed, Some(why));
                }
            }
            match reached {
                // a step that a signal has cancelled is no error
                Err(_) if cancel.is_cancelled() => return stopped(),
                Err(error) => return (OrbitStatus::Failed, Some(error.to_string())),
                Ok(Reached::Arrived) if self.plan.until.is_some() => {
                    return (OrbitStatus::Completed, None);
                }
                Ok(Reached::Arrived) => {
                    (target, limit) = next_limit(target, self.motion.step_size());
                }
                Ok(Reached::OutOfBudget) => {}
                Ok(Reached::Occurred(occurrence)) => {
                    if occurrence.event == Some(self.plan.event) {
                        last = self.motion.steps();
                        if let Err(error) = self.record(occurrence.time) {
                            return (OrbitStatus::Failed, Some(error.to_string()));
                        }
                    } else if occurrence.kind == OccurrenceKind::Stop {
                        return (
                            OrbitStatus::Stopped,
                            Some(ended(&occurrence.name, occurrence.time)),
                        );
                    }
                }
                Ok(Reached::Ended) => return (OrbitStatus::Stopped, None),
            }
            if cancel.is_cancelled() {
                return stopped();
            }
            if self.plan.until.is_none() && self.motion.steps() - last > self.plan.idle {
                return (OrbitStatus::Stopped, Some(self.crosses_no_more()));
            }
        }
    }

    fn record(&mut self, time: f64) -> Result<(), MotionError> {
        // constraints are released by events, and enforced in turn where some are redundant
        if self.motion.system().constraints() > 0
            || self.active_set_changes != self.motion.active_set_changes()
        {
            self.active_set_changes = self.motion.active_set_changes();
            self.observer = self.motion.system().observer(self.parameters);
        }
        self.plan.see(&mut self.observer, self.motion.state(), &mut self.values)?;
        self.rows.push([&[time], &self.values[..]].concat());
        Ok(())
    }

    fn crosses_no_more(&self) -> String {
        let time = short(self.motion.computed().time);
        format!(
            "no crossing in {} steps, up to t = {time}; without an end in time it is not followed longer",
            self.plan.idle
        )
    }
}

fn ended(name: &str, time: f64) -> String {
    format!("`{name}` ended the motion at t = {}", short(time))
}
