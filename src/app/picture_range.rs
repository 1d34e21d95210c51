//! The ranges that the pictures show at least, as a script or a prediction sets them.
//!
//! In: quantities as they are written, and their ranges. Out: the least range of a channel. Never here: who sets
//! them, or how pictures are drawn.

use super::{Lab, LeastRange};
use crate::model::{Allowed, Scope};

impl Lab {
    /// The channel of a quantity: of its name, or of an expression that a picture shows. `None` if no picture shows it.
    ///
    /// # Errors
    /// Returns the scope that says what is wrong with an expression that cannot be read.
    pub fn shown_channel(&self, of: &str) -> Result<Option<usize>, Box<Scope>> {
        let system = &self.loaded.system;
        let is_named = |at: &usize| {
            let channel = &system.channels()[*at];
            channel.name == of || channel.shown == of
        };
        if let Some(named) = (0..system.channels().len()).find(is_named) {
            return Ok(Some(named));
        }
        let mut pool = self.loaded.equations.pool.clone();
        let mut scope = Scope::new(&self.loaded.model, Allowed::Observable, "a script");
        match scope.read(&mut pool, of) {
            Some(e) => Ok(system.channel_of(e)),
            None => Err(Box::new(scope)),
        }
    }

    /// Sets the least ranges. A quantity that this system does not have waits for one that has it.
    pub fn set_least_ranges(&mut self, ranges: Vec<LeastRange>) {
        let found = |range: LeastRange| {
            let channel = self.shown_channel(&range.of).ok().flatten();
            LeastRange { channel, ..range }
        };
        self.least_ranges = ranges.into_iter().map(found).collect();
    }

    /// The range of a channel that pictures show at least: that of a prediction, or one that a script sets.
    pub fn least_range(&self, channel: usize) -> Option<[f64; 2]> {
        let set = || self.least_ranges.iter().find(|least| least.channel == Some(channel));
        self.predicted_range(Some(channel)).or_else(|| set().map(|least| least.range))
    }
}
