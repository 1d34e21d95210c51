//! The virtual clock: frames at whole microseconds, and simulated time in step with them.
//!
//! In: the frame rate, and requests for time to pass. Out: the time of each frame. Never here: the time of day.

use std::time::Duration;

/// A time in microseconds.
pub type Micros = u64;

pub(super) const SECOND: Micros = 1_000_000;

#[derive(Clone, Copy, Debug)]
pub(super) struct Clock {
    fps: u32,
    frame: u64,
    /// The time up to which frames were requested.
    until: Micros,
}

impl Clock {
    /// Starts at the first frame.
    pub(super) fn new(fps: u32) -> Clock {
        Clock { fps: fps.max(1), frame: 0, until: 0 }
    }

    /// The current frame, counted from 0.
    pub(super) fn frame(&self) -> u64 {
        self.frame
    }

    /// The time of the current frame. Each frame time is rounded down to whole microseconds separately, so the times
    /// never drift.
    pub(super) fn now(&self) -> Micros {
        self.time_of(self.frame)
    }

    fn time_of(&self, frame: u64) -> Micros {
        frame.saturating_mul(SECOND) / u64::from(self.fps)
    }

    pub(super) fn next(&self) -> Micros {
        self.time_of(self.frame + 1)
    }

    /// Lets time pass; [`Clock::tick`] yields the frames within it. A fraction of a frame is carried over.
    pub(super) fn pass(&mut self, time: Micros) {
        self.until = self.until.saturating_add(time);
    }

    /// The number of frames remaining in the requested time.
    pub(super) fn left(&self) -> u64 {
        let last = (u128::from(self.until) * u128::from(self.fps) / u128::from(SECOND)) as u64;
        last.saturating_sub(self.frame)
    }

    /// Advances to the next frame if it is due, and returns the time since the last one.
    pub(super) fn tick(&mut self) -> Option<Duration> {
        if self.left() == 0 {
            return None;
        }
        let before = self.now();
        self.frame += 1;
        Some(Duration::from_micros(self.now() - before))
    }

    /// The seconds between frames that are so many frames apart.
    pub(super) fn seconds(&self, frames: u64) -> f64 {
        frames as f64 / f64::from(self.fps)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_do_not_drift() {
        let mut clock = Clock::new(30);
        for _ in 0..300 {
            clock.pass(100_000);
            while clock.tick().is_some() {}
        }
        assert_eq!((clock.frame(), clock.now()), (900, 30 * SECOND));
    }

    #[test]
    fn parts_of_a_frame_are_added_up() {
        let mut clock = Clock::new(10);
        let mut frames = 0;
        for _ in 0..10 {
            clock.pass(30_000);
            while clock.tick().is_some() {
                frames += 1;
            }
        }
        assert_eq!(frames, 3);
    }
}
