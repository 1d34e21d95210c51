//! A point where the function of an event changes its sign.
//!
//! In: a time, a side. Out: whether it counts. Never here: how it is found, and what follows from
//! it.

use super::probe::earlier;
use crate::model::Direction;
use crate::num::DoubleDouble;

/// A crossing of one function.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Crossing {
    /// The time.
    pub(super) exact: DoubleDouble,
    /// The sign after the crossing.
    pub(super) side: f64,
    /// Whether the function changes sign at a pole rather than at a zero.
    pub(super) pole: bool,
}

/// An event found.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct LocatedEvent {
    pub(super) event: usize,
    /// The exact time; the nearest `f64` is the time of the event.
    pub(super) exact: DoubleDouble,
}

impl Crossing {
    /// A crossing of zero.
    pub(super) fn at(exact: DoubleDouble, side: f64) -> Crossing {
        Crossing { exact, side, pole: false }
    }

    /// Whether it counts for an event of this direction.
    pub(super) fn counts(&self, direction: Direction) -> bool {
        let awaited = match direction {
            Direction::Rising => self.side > 0.0,
            Direction::Falling => self.side < 0.0,
            Direction::Either => true,
        };
        awaited && !self.pole
    }
}

/// The first crossing that counts of all functions, where each list has the crossings up to its own
/// first, and the others at its time, with the sides afterwards. Also updates the side of each function that has crossed by
/// then; the others at its time have not.
pub(super) fn first(
    passed: &[Vec<Crossing>],
    directions: &[Direction],
    sides: &mut [f64],
    to: f64,
) -> (Option<LocatedEvent>, Vec<(LocatedEvent, f64)>) {
    let counted: Vec<(LocatedEvent, f64)> = passed
        .iter()
        .enumerate()
        .filter_map(|(event, crossings)| {
            let last = crossings.last().filter(|crossing| crossing.counts(directions[event]))?;
            Some((LocatedEvent { event, exact: last.exact }, last.side))
        })
        .collect();
    let mut found: Option<LocatedEvent> = None;
    for (event, _) in &counted {
        if found.is_none_or(|first| earlier(event.exact, first.exact)) {
            found = Some(*event);
        }
    }
    let until = found.map_or(to, |found| found.exact.high);
    for (event, crossings) in passed.iter().enumerate() {
        let mine = found.is_some_and(|found| found.event == event);
        let mut gone = crossings.iter().filter(|c| c.exact.high < until || mine);
        if let Some(last) = gone.next_back() {
            sides[event] = last.side;
        }
    }
    let others = counted.into_iter().filter(|(event, _)| {
        found.is_some_and(|found| found.event != event.event) && event.exact.high == until
    });
    (found, others.collect())
}
