//! The log of events and impulses in order of time, sealed in shared chunks so that a snapshot
//! copies only the open one.

use std::collections::VecDeque;
use std::sync::Arc;

use crate::integrate::{Occurrence, OccurrenceKind};

/// The number of occurrences in a sealed chunk.
const CHUNK: usize = 256;

/// The greatest number of chunks, a million occurrences; beyond it the oldest are dropped.
const CHUNKS: usize = 4096;

/// The greatest size in bytes, for occurrences with many numbers such as the jumps of sixty
/// coordinates.
const BYTES: usize = 128 << 20;

/// Occurrences, the oldest first, and the count of each.
#[derive(Clone, Debug, Default)]
pub struct EventLog {
    sealed: VecDeque<Arc<Vec<Occurrence>>>,
    open: Arc<Vec<Occurrence>>,
    counts: Arc<Vec<EventCount>>,
    /// The size of the sealed chunks in bytes.
    bytes: usize,
    only_counts: bool,
}

/// How often something has happened, and when it last did.
#[derive(Clone, PartialEq, Debug)]
pub struct EventCount {
    /// The name of the event or impulse.
    pub name: String,
    /// The count, including dropped occurrences.
    pub count: u64,
    /// The time of the last occurrence.
    pub last: f64,
}

impl EventLog {
    pub(super) fn clear(&mut self) {
        *self = EventLog { only_counts: self.only_counts, ..EventLog::default() };
    }

    /// Only counts occurrences from now on, without storing them.
    pub(super) fn only_count(&mut self) {
        self.only_counts = true;
    }

    pub(super) fn push(&mut self, occurrence: Occurrence) {
        let counts = Arc::make_mut(&mut self.counts);
        match counts.iter_mut().find(|entry| entry.name == occurrence.name) {
            Some(entry) => (entry.count, entry.last) = (entry.count + 1, occurrence.time),
            None => {
                let (name, last) = (occurrence.name.clone(), occurrence.time);
                counts.push(EventCount { name, count: 1, last });
            }
        }
        if self.only_counts {
            return;
        }
        let open = Arc::make_mut(&mut self.open);
        open.push(occurrence);
        if open.len() == CHUNK {
            let full = std::mem::take(&mut self.open);
            self.bytes += size(&full);
            self.sealed.push_back(full);
            while self.sealed.len() > CHUNKS || (self.bytes > BYTES && self.sealed.len() > 1) {
                let Some(oldest) = self.sealed.pop_front() else { break };
                self.bytes -= size(&oldest);
            }
        }
    }

    /// Forgets what happened after a time; with the sign −1, what happened at earlier ones.
    pub(super) fn rewind(&mut self, time: f64, sign: f64) {
        let later = |occurrence: &&Occurrence| sign * occurrence.time > sign * time;
        let removed: Vec<String> = self.iter().filter(later).map(|o| o.name.clone()).collect();
        if removed.is_empty() {
            return;
        }
        let mut counts = (*self.counts).clone();
        let mut rest: EventLog = self.iter().filter(|o| !later(o)).cloned().collect();
        for entry in &mut counts {
            entry.count -= removed.iter().filter(|name| **name == entry.name).count() as u64;
            let left = rest.counts().iter().find(|left| left.name == entry.name);
            entry.last = left.map_or(entry.last, |left| left.last);
        }
        counts.retain(|entry| entry.count > 0);
        (rest.counts, rest.only_counts) = (Arc::new(counts), self.only_counts);
        *self = rest;
    }

    /// The stored occurrences, the oldest first.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &Occurrence> {
        self.sealed.iter().chain(std::iter::once(&self.open)).flat_map(|chunk| chunk.iter())
    }

    /// The count of each occurrence, in the order of first appearance.
    pub fn counts(&self) -> &[EventCount] {
        &self.counts
    }

    /// The total number of occurrences.
    pub fn count(&self) -> u64 {
        self.counts.iter().map(|entry| entry.count).sum()
    }

    /// The number of occurrences that were dropped.
    pub fn forgotten(&self) -> u64 {
        self.count() - (self.sealed.len() * CHUNK + self.open.len()) as u64
    }

    /// Whether nothing has happened.
    pub fn is_empty(&self) -> bool {
        self.counts.is_empty()
    }
}

/// The size of a chunk in bytes.
fn size(chunk: &[Occurrence]) -> usize {
    let numbers = |occurrence: &Occurrence| match &occurrence.kind {
        OccurrenceKind::Impulse { jump, reaction } => jump.len() + reaction.len(),
        OccurrenceKind::Mark
        | OccurrenceKind::Crossing(_)
        | OccurrenceKind::Stop
        | OccurrenceKind::StepInTime
        | OccurrenceKind::Release(_) => 0,
    };
    let own = |occurrence: &Occurrence| {
        size_of::<Occurrence>() + occurrence.name.len() + size_of::<f64>() * numbers(occurrence)
    };
    chunk.iter().map(own).sum()
}

impl FromIterator<Occurrence> for EventLog {
    fn from_iter<I: IntoIterator<Item = Occurrence>>(occurrences: I) -> EventLog {
        let mut event_log = EventLog::default();
        occurrences.into_iter().for_each(|occurrence| event_log.push(occurrence));
        event_log
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ticks(count: usize) -> impl Iterator<Item = Occurrence> {
        let name = |k: usize| ["tick", "tock"][k % 2].to_owned();
        (0..count).map(move |k| Occurrence {
            name: name(k),
            event: None,
            time: k as f64,
            kind: OccurrenceKind::Mark,
        })
    }

    #[test]
    fn the_newest_are_stored_in_order_and_all_are_counted() {
        let most = CHUNK * CHUNKS;
        let count = most + 1000;
        let event_log: EventLog = ticks(count).collect();
        let times: Vec<f64> = event_log.iter().map(|occurrence| occurrence.time).collect();
        assert!((most..most + CHUNK).contains(&times.len()), "{}", times.len());
        assert!(times.windows(2).all(|pair| pair[1] == pair[0] + 1.0));
        assert_eq!(times.last(), Some(&(count as f64 - 1.0)));
        assert_eq!(event_log.forgotten() as usize, count - times.len());
        let mut back = event_log.clone();
        back.rewind(count as f64 - 10.5, 1.0);
        assert_eq!(back.count(), count as u64 - 10);
        assert_eq!(back.forgotten(), event_log.forgotten());
        assert_eq!(back.iter().next_back().map(|o| o.time), Some(count as f64 - 11.0));
        let half = count as u64 / 2;
        let entry = |name: &str, last| EventCount { name: name.to_owned(), count: half, last };
        let last = count as f64;
        assert_eq!(event_log.counts(), [entry("tick", last - 2.0), entry("tock", last - 1.0)]);
    }

    #[test]
    fn occurrences_of_many_numbers_are_bounded_by_their_size() {
        let wide = |k: usize| Occurrence {
            name: "kick".to_owned(),
            event: None,
            time: k as f64,
            kind: OccurrenceKind::Impulse { jump: vec![1.0; 2000], reaction: vec![1.0; 2000] },
        };
        let each = size(&[wide(0)]);
        let fits = BYTES / (CHUNK * each) * CHUNK;
        let all: EventLog = (0..fits).map(wide).collect();
        assert_eq!(all.forgotten(), 0, "they fit just so");
        let more: EventLog = (0..fits + 2 * CHUNK).map(wide).collect();
        assert_eq!(more.forgotten() as usize, 2 * CHUNK);
        assert_eq!(more.iter().next_back().map(|h| h.time), Some((fits + 2 * CHUNK) as f64 - 1.0));
    }

    #[test]
    fn what_is_only_counted_is_not_stored() {
        let mut event_log = EventLog::default();
        event_log.only_count();
        ticks(3 * CHUNK).for_each(|occurrence| event_log.push(occurrence));
        assert_eq!((event_log.count(), event_log.iter().count()), (3 * CHUNK as u64, 0));
        event_log.clear();
        ticks(2).for_each(|occurrence| event_log.push(occurrence));
        assert_eq!((event_log.count(), event_log.iter().count()), (2, 0));
    }

    #[test]
    fn a_copy_keeps_what_it_saw() {
        let mut event_log: EventLog = ticks(CHUNK - 1).collect();
        let before = event_log.clone();
        ticks(3 * CHUNK).for_each(|occurrence| event_log.push(occurrence));
        assert_eq!((before.count(), before.iter().count()), (CHUNK as u64 - 1, CHUNK - 1));
        assert_eq!((event_log.forgotten(), event_log.iter().count()), (0, 4 * CHUNK - 1));
        assert!(EventLog::default().is_empty() && !before.is_empty());
    }
}
