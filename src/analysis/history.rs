//! The history of one quantity in bounded memory: equal stretches of time, each with its least,
//! greatest and mean value, joined two by two whenever there are too many.
//!
//! In: values at whatever times. Out: [`Stretch`]es. Never here: what to think of them.

/// How many stretches are kept at most; between half as many and all of them are in use.
const CAPACITY: usize = 128;

/// A piece of a history.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Stretch {
    /// The time of its first value.
    pub start: f64,
    /// The time of its last value.
    pub end: f64,
    /// The least value in it.
    pub least: f64,
    /// The greatest value in it.
    pub greatest: f64,
    /// The mean of its values.
    pub mean: f64,
    count: u64,
    /// Which stretch of time it is, counted from the first.
    slot: u64,
}

impl Stretch {
    fn new(slot: u64, time: f64, value: f64) -> Stretch {
        let (start, end) = (time, time);
        Stretch { start, end, least: value, greatest: value, mean: value, count: 1, slot }
    }

    /// The two pieces as one.
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

    /// The middle of its time.
    pub fn middle(&self) -> f64 {
        0.5 * (self.start + self.end)
    }

    /// The greatest size of a value in it.
    pub fn peak(&self) -> f64 {
        self.greatest.abs().max(self.least.abs())
    }
}

/// A history of values at times that rise on the whole.
#[derive(Clone, Debug, Default)]
pub struct History {
    stretches: Vec<Stretch>,
    /// The first time, and how long a stretch is; zero before there are two times.
    origin: f64,
    width: f64,
}

/// What rounding may leave a time short of the stretch it begins.
const EDGE: f64 = 1e-6;

impl History {
    /// An empty history.
    pub fn new() -> History {
        History { stretches: Vec::with_capacity(CAPACITY), origin: 0.0, width: 0.0 }
    }

    /// Adds a value; one that is not finite is passed over. A value may be a little older than the last.
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

    /// Which stretch a time lies in.
    fn slot(&self, time: f64) -> u64 {
        if self.width > 0.0 { ((time - self.origin) / self.width + EDGE) as u64 } else { 0 }
    }

    /// Makes stretches twice as long.
    fn coarsen(&mut self) {
        self.width *= 2.0;
        let mut joined: Vec<Stretch> = Vec::with_capacity(CAPACITY);
        for stretch in self.stretches.drain(..) {
            let stretch = Stretch { slot: stretch.slot / 2, ..stretch };
            match joined.last_mut() {
                Some(last) if last.slot == stretch.slot => *last = last.join(&stretch),
                _ => joined.push(stretch),
            }
        }
        self.stretches = joined;
    }

    /// The stretches, the oldest first. All are equally long but the last, which may be unfinished; where nothing was
    /// looked at there is none.
    pub fn stretches(&self) -> &[Stretch] {
        &self.stretches
    }

    /// How many values went in.
    pub fn len(&self) -> u64 {
        self.stretches.iter().map(|s| s.count).sum()
    }

    /// Whether nothing went in.
    pub fn is_empty(&self) -> bool {
        self.stretches.is_empty()
    }

    /// The greatest size of a value.
    pub fn peak(&self) -> f64 {
        self.stretches.iter().map(Stretch::peak).fold(0.0, f64::max)
    }
}
