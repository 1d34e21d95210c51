//! Runs simulated time at a chosen speed relative to wall time.

use std::time::{Duration, Instant};

/// How far simulated time may fall behind before the lost time is given up, so that an experiment
/// that was too slow does not rush when it becomes fast again.
const MOST_BEHIND: Duration = Duration::from_millis(50);

/// A simulated time, its instant of wall time, and the speed since.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace {
    wall: Instant,
    time: f64,
    speed: f64,
}

impl Pace {
    /// Starts at simulated `time` with `speed`.
    pub(super) fn new(now: Instant, time: f64, speed: f64) -> Pace {
        Pace { wall: now, time, speed }
    }

    /// The simulated time that should be reached now; infinite for an unlimited speed. `time` is
    /// the time actually reached.
    pub(super) fn target(&mut self, now: Instant, time: f64) -> f64 {
        if self.speed.is_infinite() {
            return f64::INFINITY;
        }
        let target = self.time + self.speed * now.duration_since(self.wall).as_secs_f64();
        let furthest = time + self.speed * MOST_BEHIND.as_secs_f64();
        if target > furthest {
            *self = Pace { wall: now, time: furthest, speed: self.speed };
            return furthest;
        }
        target
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_delay_is_made_up_for_and_a_long_one_is_given_up() {
        let start = Instant::now();
        let after = |milliseconds: u64| start + Duration::from_millis(milliseconds);
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        // 45 ms at twice the speed are not lost
        let mut pace = Pace::new(start, 1.0, 2.0);
        assert!(near(pace.target(after(45), 1.0), 1.09));
        assert!(near(pace.target(after(90), 1.09), 1.18));
        // of 60 ms, 10 ms are lost for good
        let mut pace = Pace::new(start, 1.0, 2.0);
        assert!(near(pace.target(after(60), 1.0), 1.1));
        assert!(near(pace.target(after(70), 1.1), 1.12));
    }
}
