//! How fast things go: frames and integration steps per second of the wall clock.
//!
//! In: ticks and the step counts of snapshots. Out: two numbers that change twice a second, so that they can be read.
//! Never here: a clock.

use std::time::Duration;

/// For how long is counted before a number is shown.
const WINDOW: Duration = Duration::from_millis(500);

/// Frames in a second that can be asked for, one after the other.
const RATES: [u16; 8] = [2, 4, 8, 15, 20, 30, 60, 120];

/// Counts frames and steps.
#[derive(Clone, Debug)]
pub struct RateMeter {
    /// Frames per second that are asked for.
    pub asked: u16,
    /// The most that may be asked for.
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
    /// The next greater (`more`) or smaller number of frames to ask for; `None` at the end.
    pub(super) fn next_rate(&self, more: bool) -> Option<u16> {
        let mut rates = RATES.iter().copied().filter(|rate| *rate <= self.most);
        if more {
            rates.find(|rate| *rate > self.asked)
        } else {
            rates.rfind(|rate| *rate < self.asked)
        }
    }

    /// A frame has passed.
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

    /// The experiment has taken this many steps since its last reset.
    pub fn count(&mut self, steps: u64) {
        if self.first.is_none_or(|first| steps < first) {
            self.first = Some(steps);
        }
        self.last = steps;
    }

    /// Another experiment is looked at.
    pub fn forget(&mut self) {
        (self.steps, self.first, self.last) = (None, None, 0);
    }
}
