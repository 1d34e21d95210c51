//! A motion at an instant by action and angle, and its angle counted on from an earlier one.
//!
//! In: a frozen system, the state of a motion. Out: energy, action, frequency, and w in turns. Never here: the motion between.
//! Source: *The Principles of Dynamics*, § 4.2.

use super::FrozenSystem;

/// Why there is no angle where the rate of the coordinate depends on another one.
const UNEVEN: &str = "its returns take different times, as its rate depends on another coordinate; ∂S/∂J has then a part of \
                      that one as well";

/// The motion of one coordinate at an instant.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct AngleAtTime {
    /// When the motion is there.
    pub time: f64,
    /// w = ∂S/∂J, in turns; from 0 to 1 until it is counted on.
    pub angle: f64,
    /// ν = dE/dJ.
    pub frequency: f64,
    /// ∮ p dq.
    pub action: f64,
    /// That of the frozen system at the motion's state.
    pub energy: f64,
}

impl AngleAtTime {
    /// The motion at coordinates and momenta.
    ///
    /// # Errors
    /// Returns an error if the motion does not return, or has no such state.
    pub fn of(
        frozen: &FrozenSystem,
        time: f64,
        parameters: &[f64],
        state: [&[f64]; 2],
    ) -> Result<AngleAtTime, String> {
        let mut motion = frozen.at(time, parameters, state).map_err(|why| why.to_string())?;
        let own = motion.own().map_err(|why| why.to_string())?;
        let row = own.row.map_err(|why| why.to_string())?;
        if row.is_uneven {
            return Err(UNEVEN.to_owned());
        }
        let angle = motion.angle(&row).map_err(|why| why.to_string())?;
        let (action, energy) = (row.action, own.energy);
        Ok(AngleAtTime { time, angle, frequency: 1.0 / row.period, action, energy })
    }

    /// The same with as many whole turns as have gone by since another.
    #[must_use]
    pub fn after(self, last: Option<&AngleAtTime>) -> AngleAtTime {
        let Some(last) = last else { return self };
        let mean = f64::midpoint(last.frequency, self.frequency);
        let expected = last.angle + mean * (self.time - last.time);
        AngleAtTime { angle: self.angle + (expected - self.angle).round(), ..self }
    }

    /// The angle at a time of a motion that continues evenly from here, w + ν (t − t₀).
    pub fn even(&self, time: f64) -> f64 {
        self.angle + self.frequency * (time - self.time)
    }
}
