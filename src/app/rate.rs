//! Rates: frames and integration steps per second of wall-clock time.
//!
//! In: ticks and the step counts of snapshots. Out: two numbers that change twice a second, so that they stay
//! readable.
//! Never here: a clock.

use std::time::Duration;

/// The interval over which is counted before a number is shown.
const WINDOW: Duration = Duration::from_millis(500);

/// The frame rates to choose from, per second.
const RATES: [u16; 8] = [2, 4, 8, 15, 20, 30, 60, 120];

/// Counts frames and steps.
#[derive(Clone, Debug)]
pub struct RateMeter {
    /// The requested frames per second.
    pub asked: u16,
    /// The maximum that may be requested.
    pub most: u16,
    /// Frames per second, once known.
    pub frames: Option<f64>,
    /// Steps per second, once known.
    pub steps: Option<f64>,
    counted: u32,
    elapsed: Duration,
    first: Option<u64>,
    last: u64,
}

impl Default for RateMeter {
    fn default() -> Self {
        Self {
            asked: 30,
            most: 240,
            frames: None,
            steps: None,
            counted: 0,
            elapsed: Duration::ZERO,
            first: None,
            last: 0,
        }
    }
}

impl RateMeter {
    /// Returns the next higher (`more`) or lower frame rate, or `None` at the end.
    pub(super) fn next_rate(&self, more: bool) -> Option<u16> {
        let mut rates = RATES.iter().copied().filter(|rate| *rate <= self.most);
        if more {
            rates.find(|rate| *rate > self.asked)
        } else {
            rates.rfind(|rate| *rate < self.asked)
        }
    }

    /// Counts a frame.
    pub fn tick(&mut self, elapsed: Duration) {
        self.counted += 1;
        self.elapsed = self.elapsed.saturating_add(elapsed);
        if self.elapsed < WINDOW {
            return;
        }
        let seconds = self.elapsed.as_secs_f64();
        self.frames = Some(f64::from(self.counted) / seconds);
        self.steps = self.first.map(|first| self.last.saturating_sub(first) as f64 / seconds);
        (self.counted, self.elapsed) = (0, Duration::ZERO);
        self.first = self.first.map(|_| self.last);
    }

    /// Takes in the number of steps since the experiment's last reset.
    pub fn count(&mut self, steps: u64) {
        if self.first.is_none_or(|first| steps < first) {
            self.first = Some(steps);
        }
        self.last = steps;
    }

    /// Restarts the count for another experiment.
    pub fn forget(&mut self) {
        (self.steps, self.first, self.last) = (None, None, 0);
    }
}
