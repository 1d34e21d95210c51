//! The history of one quantity in bounded memory: equal stretches of time, each with its least,
//! greatest and mean value, joined two by two whenever there are too many.
//!
//! In: values at rising times. Out: [`Stretch`]es. Never here: what to think of them.

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
}

impl Stretch {
    fn new(time: f64, value: f64) -> Stretch {
        Stretch { start: time, end: time, least: value, greatest: value, mean: value, count: 1 }
    }

    /// The two pieces as one; `later` follows `self`.
    fn join(&self, later: &Stretch) -> Stretch {
        let count = self.count + later.count;
        let weight = later.count as f64 / count as f64;
        Stretch {
            start: self.start,
            end: later.end,
            least: self.least.min(later.least),
            greatest: self.greatest.max(later.greatest),
            mean: self.mean + weight * (later.mean - self.mean),
            count,
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

/// A history of values at rising, evenly spaced times.
#[derive(Clone, Debug, Default)]
pub struct History {
    stretches: Vec<Stretch>,
    per_stretch: u64,
}

impl History {
    /// An empty history.
    pub fn new() -> History {
        History { stretches: Vec::with_capacity(CAPACITY), per_stretch: 1 }
    }

    /// Adds a value; one that is not finite is passed over.
    pub fn push(&mut self, time: f64, value: f64) {
        if !value.is_finite() {
            return;
        }
        let next = Stretch::new(time, value);
        match self.stretches.last_mut() {
            Some(last) if last.count < self.per_stretch => *last = last.join(&next),
            _ => {
                if self.stretches.len() == CAPACITY {
                    self.stretches =
                        self.stretches.chunks_exact(2).map(|p| p[0].join(&p[1])).collect();
                    self.per_stretch *= 2;
                }
                self.stretches.push(next);
            }
        }
    }

    /// The stretches, the oldest first. All hold equally many values but the last, which may be
    /// unfinished.
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
