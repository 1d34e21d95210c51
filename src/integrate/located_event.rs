//! A point where the function of an event changes its sign.
//!
//! In: a time, a side. Out: whether it counts. Never here: how it is found, and what follows from
//! it.

use super::clock::{DIGITS, spacing};
use super::probe::earlier;
use crate::model::{Direction, EventAction};
use crate::num::DoubleDouble;
use crate::system::CompiledAction;

/// What an event does to the motion, in the order in which those at the same time happen.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum EventRole {
    /// It only sees it.
    Sees,
    StepInTime,
    /// It acts on it.
    Acts,
}

impl EventRole {
    pub(super) fn of(action: CompiledAction) -> EventRole {
        match action {
            CompiledAction::StepInTime => EventRole::StepInTime,
            CompiledAction::Written(EventAction::Mark | EventAction::Section(_)) => EventRole::Sees,
            CompiledAction::Written(
                EventAction::Stop | EventAction::Release(_) | EventAction::Impulse(_),
            ) => EventRole::Acts,
        }
    }
}

#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Crossing {
    pub(super) exact: DoubleDouble,
    /// The sign after the crossing.
    pub(super) side: f64,
    /// Whether the function changes sign at a pole rather than at a zero.
    pub(super) pole: bool,
}

#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct LocatedEvent {
    pub(super) event: usize,
    /// The exact time; the nearest `f64` is the time of the event.
    pub(super) exact: DoubleDouble,
}

impl Crossing {
    pub(super) fn at(exact: DoubleDouble, side: f64) -> Crossing {
        Crossing { exact, side, pole: false }
    }

    pub(super) fn counts(&self, direction: Direction) -> bool {
        let awaited = match direction {
            Direction::Rising => self.side > 0.0,
            Direction::Falling => self.side < 0.0,
            Direction::Either => true,
        };
        awaited && !self.pole
    }
}

#[derive(Clone, Debug, Default)]
pub(super) struct LocatedEvents {
    /// The events, each with the side of its function afterwards, in the order in which they happen.
    pub(super) events: Vec<(LocatedEvent, f64)>,
    /// Those whose functions cross zero there, in a direction that counts or not.
    pub(super) crossing: Vec<usize>,
}

impl LocatedEvents {
    /// The next of them, with the side of its function afterwards.
    pub(super) fn next(&mut self) -> Option<(LocatedEvent, f64)> {
        (!self.events.is_empty()).then(|| self.events.remove(0))
    }

    /// The next of them, if it is at this time.
    pub(super) fn next_at(&mut self, time: f64) -> Option<(LocatedEvent, f64)> {
        self.events.first().filter(|(next, _)| next.exact.high == time)?;
        self.next()
    }
}

/// Whether two times are the same but for the rounding of roots.
pub(super) fn is_same_time(a: f64, b: f64) -> bool {
    (a - b).abs() <= DIGITS * spacing(a)
}

/// The first crossing that counts of all functions, where each list has the crossings up to its own
/// first, and the others at its time. What only sees the motion there comes before a step in time of its law, and that before what
/// acts on the motion, as their `roles` say. Also updates the side of
/// each function that has crossed by then, with that of the first event; the others at its time have not.
pub(super) fn first(
    passed: &[Vec<Crossing>],
    (directions, roles): (&[Direction], &[EventRole]),
    sides: &mut [f64],
    to: f64,
) -> LocatedEvents {
    let counted = passed.iter().enumerate().filter_map(|(event, crossings)| {
        let last = crossings.last().filter(|crossing| crossing.counts(directions[event]))?;
        Some((LocatedEvent { event, exact: last.exact }, last.side))
    });
    let counted: Vec<(LocatedEvent, f64)> = counted.collect();
    let mut found: Option<LocatedEvent> = None;
    for (event, _) in &counted {
        if found.is_none_or(|first| earlier(event.exact, first.exact)) {
            found = Some(*event);
        }
    }
    let mut here = LocatedEvents::default();
    if let Some(found) = found {
        let time = found.exact.high;
        let is_here = |event: &LocatedEvent| {
            let sees = |event: &LocatedEvent| roles[event.event] == EventRole::Sees;
            let is_seen = !sees(&found) && sees(event);
            event.exact.high == time || is_seen && is_same_time(time, event.exact.high)
        };
        let all = counted.into_iter().filter(|(event, _)| is_here(event));
        let at_time = |(event, side): (LocatedEvent, f64)| {
            let exact = if event.exact.high == time { event.exact } else { found.exact };
            (LocatedEvent { exact, ..event }, side)
        };
        here.events = all.map(at_time).collect();
        here.events.sort_by_key(|(event, _)| (roles[event.event], event.event != found.event));
        let crosses = |crossings: &&Vec<Crossing>| {
            crossings.iter().any(|crossing| is_same_time(time, crossing.exact.high))
        };
        let crossing = passed.iter().enumerate().filter(|(_, crossings)| crosses(crossings));
        here.crossing = crossing.map(|(event, _)| event).collect();
    }
    let first = here.events.first().map(|(event, _)| *event);
    let until = first.map_or(to, |first| first.exact.high);
    for (event, crossings) in passed.iter().enumerate() {
        let mine = first.is_some_and(|first| first.event == event);
        let mut before = crossings.iter().filter(|c| c.exact.high < until || mine);
        if let Some(last) = before.next_back() {
            sides[event] = last.side;
        }
    }
    here
}
