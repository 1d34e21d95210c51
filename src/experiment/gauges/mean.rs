//! A mean over time.
//!
//! In: samples with their times. Out: their mean, each weighted by the time since the one before. Never here: what is sampled.

/// A mean over time of a sampled quantity.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Mean {
    /// The time of the last sample.
    time: f64,
    value: f64,
    weight: f64,
}

impl Mean {
    /// An empty mean that begins at a time.
    pub(super) fn beginning(time: f64) -> Mean {
        Mean { time, ..Mean::default() }
    }

    /// The time of the last sample.
    pub(super) fn time(&self) -> f64 {
        self.time
    }

    pub(super) fn of(value: f64, weight: f64, time: f64) -> Mean {
        Mean { time, value, weight }
    }

    #[inline]
    pub(super) fn note(&mut self, time: f64, value: f64) {
        if value.is_finite() {
            let weight = (time - self.time).abs();
            self.weight += weight;
            if self.weight > 0.0 {
                self.value += (value - self.value) * (weight / self.weight);
            } else {
                self.value = value;
            }
            self.time = time;
        }
    }

    #[inline]
    pub(super) fn value(&self) -> f64 {
        self.value
    }
}
