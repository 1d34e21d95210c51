//! The governor: how often frames are sent over a connection of limited bandwidth, and how detailed they are.
//!
//! In: the bytes of each frame and when they were sent. Out: when the next frame is due, its maximum size in bytes,
//! and how much of the picture to leave out. Never here: a clock, the terminal, or which details are left out.
//!
//! If the connection is too slow, frames come less often, down to [`FEWEST`] per second. If that is not enough,
//! there are fewer colours, then less detail; a frame that is still too large is split over several frames. Bytes
//! are counted, not estimated: the next frame has to wait until what was sent has been transmitted.

use std::time::{Duration, Instant};

use crate::view::Detail;

/// The minimum number of frames per second, however slow the connection is.
const FEWEST: f64 = 2.0;

/// A frame whose transmission takes longer than this, in seconds, is too large; the detail is then reduced.
const SLOW: f64 = 0.4;

/// A frame that takes less than this leaves room for more detail, which may take three times as much.
const EASY: f64 = 0.125;

/// How long frames must be too large before the detail is reduced.
const SLOWNESS: Duration = Duration::from_secs(1);

/// How long there must be room before the detail is raised. The time doubles after every premature raise, up to the
/// second value.
const EASE: [Duration; 2] = [Duration::from_secs(3), Duration::from_secs(60)];

/// A reduction this soon after a raise means that the raise was premature.
const SOON: Duration = Duration::from_secs(10);

/// The averaging time for the need of a frame, in seconds.
const MEMORY: f64 = 1.0;

/// The interval between frames while the window has no focus: two per second are enough to show that the program
/// runs.
const UNWATCHED: Duration = Duration::from_millis(500);

/// Controls the rate and detail of frames.
#[derive(Debug)]
pub struct Governor {
    frames: u16,
    /// The bytes per second; `None` if there is no limit.
    budget: Option<f64>,
    /// Whether the window has the focus.
    pub watched: bool,
    /// When the last frame was sent.
    at: Instant,
    /// The bytes that had not been transmitted then.
    backlog: f64,
    /// The average transmission time of a frame, in seconds.
    need: f64,
    detail: Detail,
    /// How long frames have been too large, or small.
    slow: Duration,
    easy: Duration,
    ease: Duration,
    risen: Option<Instant>,
}

impl Governor {
    /// Creates a governor for at most this many frames and this many bytes per second.
    pub fn new(frames: u16, budget: Option<u32>, now: Instant) -> Self {
        Self {
            frames: frames.max(1),
            budget: budget.map(|bytes| f64::from(bytes.max(1))),
            watched: true,
            at: now,
            backlog: 0.0,
            need: 0.0,
            detail: Detail::default(),
            slow: Duration::ZERO,
            easy: Duration::ZERO,
            ease: EASE[0],
            risen: None,
        }
    }

    /// Sets the number of frames per second.
    pub fn want(&mut self, frames: u16) {
        self.frames = frames.max(1);
    }

    /// Returns the level of detail of the picture.
    pub fn detail(&self) -> Detail {
        self.detail
    }

    /// Returns the maximum size of the next frame in bytes.
    pub fn most(&self) -> usize {
        self.budget.map_or(usize::MAX, |budget| (budget / FEWEST) as usize)
    }

    /// Registers a frame of this many bytes, zero if nothing had changed.
    pub fn sent(&mut self, bytes: usize, now: Instant) {
        let passed = now.saturating_duration_since(self.at);
        self.at = now;
        let Some(budget) = self.budget else { return };
        self.backlog = (self.backlog - passed.as_secs_f64() * budget).max(0.0) + bytes as f64;
        let share = passed.as_secs_f64() / (passed.as_secs_f64() + MEMORY);
        self.need += (bytes as f64 / budget - self.need) * share;
        self.judge(passed, now);
    }

    /// Returns when the next frame is due.
    pub fn due(&self) -> Instant {
        let interval = if self.watched { self.interval() } else { self.interval().max(UNWATCHED) };
        self.paid().max(self.at + interval)
    }

    /// Returns when it is due if the user has typed something and waits for the result.
    pub fn soon(&self, now: Instant) -> Instant {
        self.paid().max(now + self.interval())
    }

    fn interval(&self) -> Duration {
        Duration::from_secs(1) / u32::from(self.frames)
    }

    /// Returns when everything sent will have been transmitted.
    fn paid(&self) -> Instant {
        self.at + Duration::from_secs_f64(self.budget.map_or(0.0, |budget| self.backlog / budget))
    }

    /// Reduces or raises the detail if frames have been too large, or small, for long enough.
    fn judge(&mut self, passed: Duration, now: Instant) {
        self.slow = if self.need > SLOW { self.slow + passed } else { Duration::ZERO };
        self.easy = if self.need < EASY { self.easy + passed } else { Duration::ZERO };
        let poorer = self.detail.poorer().filter(|_| self.slow >= SLOWNESS);
        let richer = self.detail.richer().filter(|_| self.easy >= self.ease);
        if let Some(detail) = poorer {
            let soon = self.risen.is_some_and(|risen| now - risen < SOON);
            self.ease = if soon { (self.ease * 2).min(EASE[1]) } else { EASE[0] };
            // The need of a less detailed picture is still unknown.
            (self.detail, self.need, self.slow) =
                (detail, f64::midpoint(EASY, SLOW), Duration::ZERO);
        } else if let Some(detail) = richer {
            (self.detail, self.easy, self.risen) = (detail, Duration::ZERO, Some(now));
        }
    }
}
