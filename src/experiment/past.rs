//! The recorded past of a motion: what a checkpoint takes along to where the motion is resumed.
//!
//! In: a snapshot. Out: a [`Past`], and an experiment that has it before it. Never here: the state of the motion
//! (`checkpoint`).

use std::fmt;

use super::advance::HORIZON;
use super::run_log::RunLog;
use super::{Experiment, RunToken, Snapshot, Trail};
use crate::system::{Channel, System};

/// Recorded rows of a motion and the names of their channels.
#[derive(Clone)]
pub struct Past {
    names: Vec<String>,
    trail: Trail,
    /// The run of the motion, and what happened on it.
    run: RunToken,
    log: RunLog,
}

/// A past is long, and commands that carry one are logged on one line.
impl fmt::Debug for Past {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Past of {} rows", self.trail.len())
    }
}

/// Two pasts are equal if they have recorded the same.
impl PartialEq for Past {
    fn eq(&self, other: &Self) -> bool {
        self.names == other.names && self.trail == other.trail
    }
}

impl Past {
    pub(super) fn of(system: &System, snapshot: &Snapshot) -> Past {
        Past {
            names: system.channels().iter().map(|channel| channel.name.clone()).collect(),
            trail: snapshot.trail.clone(),
            run: snapshot.recorded.run.clone(),
            log: RunLog {
                occurrences: snapshot.occurrences.clone(),
                crossings: snapshot.crossings.clone(),
            },
        }
    }

    /// Converts this past's rows before `time` to rows of the given channels. A channel that was not recorded becomes
    /// NaN.
    fn row(&self, channels: &[Channel], time: f64) -> impl Fn(&[f64]) -> Option<Vec<f64>> {
        // channels that share a name are matched in order
        let place = |(at, channel): (usize, &Channel)| {
            let earlier = channels[..at].iter().filter(|other| other.name == channel.name).count();
            let mut places = (0..self.names.len()).filter(|&i| self.names[i] == channel.name);
            places.nth(earlier)
        };
        let places: Vec<Option<usize>> = channels.iter().enumerate().map(place).collect();
        move |row| {
            let value = |place: &Option<usize>| place.and_then(|i| row.get(i + 1).copied());
            let values = places.iter().map(|place| value(place).unwrap_or(f64::NAN));
            (row[0] < time).then(|| std::iter::once(row[0]).chain(values).collect())
        }
    }
}

impl Experiment {
    /// Prepends the recorded past, if the coordinates are the same. A run of this very system is resumed: its motion
    /// continues as it would have, and can be shown from where it could be.
    pub(super) fn restore_past(&mut self, past: &Past, time: f64, coordinates: &[String]) {
        let own = self.model.coordinates.iter();
        let same =
            own.len() == coordinates.len() && own.clone().all(|c| coordinates.contains(&c.name));
        if !same {
            return;
        }
        let row = past.row(self.motion.system().channels(), time);
        self.recorder.precede(&past.trail, row);
        if self.run.error.is_some() {
            return;
        }
        let limit = time + HORIZON * self.setup.spacing;
        match self.motion.resume(&past.run, (time, limit), self.setup.start) {
            Ok(true) => self.log = past.log.clone(),
            Ok(false) => {}
            Err(error) => self.run.error = Some(self.motion.dated(error).into()),
        }
    }
}
