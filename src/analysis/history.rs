//! The history of one quantity in bounded memory: equal intervals of time, each with its least,
//! greatest and mean value, joined in pairs whenever there are too many.
//!
//! In: values at any times. Out: [`Stretch`]es. Never here: their assessment.

/// The maximal number of intervals; between half and all of them are in use.
const CAPACITY: usize = 128;

/// One interval of a history.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Stretch {
    /// The time of the first value.
    pub start: f64,
    /// The time of the last value.
    pub end: f64,
    /// The least value.
    pub least: f64,
    /// The greatest value.
    pub greatest: f64,
    /// The mean of the values.
    pub mean: f64,
    count: u64,
    /// The index of the interval, counted from the first.
    slot: u64,
}

impl Stretch {
    fn new(slot: u64, time: f64, value: f64) -> Stretch {
        let (start, end) = (time, time);
        Stretch { start, end, least: value, greatest: value, mean: value, count: 1, slot }
    }

    /// Joins two intervals.
    fn join(&self, other: &Stretch) -> Stretch {
        let count = self.count + other.count;
        let weight = other.count as f64 / count as f64;
        Stretch {
            start: self.start.min(other.start),
            end: self.end.max(other.end),
            least: self.least.min(other.least),
            greatest: self.greatest.max(other.greatest),
            mean: self.mean + weight * (other.mean - self.mean),
            count,
            slot: self.slot,
        }
    }

    /// The middle of the interval.
    pub fn middle(&self) -> f64 {
        0.5 * (self.start + self.end)
    }

    /// The largest absolute value.
    pub fn peak(&self) -> f64 {
        self.greatest.abs().max(self.least.abs())
    }
}

/// A history of values at nearly increasing times, or at nearly decreasing ones.
#[derive(Clone, Debug, Default)]
pub struct History {
    stretches: Vec<Stretch>,
    /// The first time, and the length of an interval; zero before there are two times.
    origin: f64,
    width: f64,
}

/// The tolerance for a time just short of the interval it begins because of rounding, as a part of
/// an interval.
const EDGE: f64 = 1e-6;

impl History {
    /// An empty history.
    pub fn new() -> History {
        History { stretches: Vec::with_capacity(CAPACITY), origin: 0.0, width: 0.0 }
    }

    /// Adds a value, and ignores one that is not finite. A value may be a little older than the
    /// last.
    pub fn push(&mut self, time: f64, value: f64) {
        if !value.is_finite() || !time.is_finite() {
            return;
        }
        let Some(last) = self.stretches.last() else {
            self.origin = time;
            self.stretches.push(Stretch::new(0, time, value));
            return;
        };
        if self.width == 0.0 {
            self.width = (time - last.end).abs();
        }
        let mut slot = self.slot(time);
        while slot >= CAPACITY as u64 {
            self.coarsen();
            slot = self.slot(time);
        }
        let next = Stretch::new(slot, time, value);
        match self.stretches.iter().rposition(|s| s.slot <= slot) {
            Some(at) if self.stretches[at].slot == slot => {
                self.stretches[at] = self.stretches[at].join(&next);
            }
            at => self.stretches.insert(at.map_or(0, |at| at + 1), next),
        }
    }

    fn slot(&self, time: f64) -> u64 {
        if self.width > 0.0 { ((time - self.origin).abs() / self.width + EDGE) as u64 } else { 0 }
    }

    fn coarsen(&mut self) {
        self.width *= 2.0;
        let mut joined: Vec<Stretch> = Vec::with_capacity(CAPACITY);
        for interval in self.stretches.drain(..) {
            let interval = Stretch { slot: interval.slot / 2, ..interval };
            match joined.last_mut() {
                Some(last) if last.slot == interval.slot => *last = last.join(&interval),
                _ => joined.push(interval),
            }
        }
        self.stretches = joined;
    }

    /// The intervals, the oldest first. All have the same length except the last, which may be
    /// incomplete. Intervals without values are omitted.
    pub fn stretches(&self) -> &[Stretch] {
        &self.stretches
    }

    /// The number of values added.
    pub fn len(&self) -> u64 {
        self.stretches.iter().map(|s| s.count).sum()
    }

    /// Whether no value was added.
    pub fn is_empty(&self) -> bool {
        self.stretches.is_empty()
    }

    /// The largest absolute value.
    pub fn peak(&self) -> f64 {
        self.stretches.iter().map(Stretch::peak).fold(0.0, f64::max)
    }
}
