//! States carried by the flow of a system, and what is seen of them at given times.
//!
//! In: a system, a method, a state. Out: channels at the times, and the state at the last of them, from which it can be
//! carried on. Never here: which states, pictures.

use crate::integrate::{Method, Propagator, Reached, Settings, Stepping};
use crate::system::{MotionError, State, System};

/// The steps between two looks at the token.
const STEPS_PER_LOOK: u64 = 64;

/// The flow of a system at fixed parameters, by a method.
#[derive(Clone)]
pub struct Flow {
    /// The system.
    pub system: System,
    /// The method, and its step or tolerance.
    pub method: (&'static Method, Settings),
    /// The parameters.
    pub parameters: Vec<f64>,
    /// The time at which the motion of the system began, from which periodic impulses count.
    pub start: f64,
}

/// A state that was carried.
#[derive(Clone, Debug, Default)]
pub struct Carried {
    /// The channels at each time, up to where the motion could be followed.
    pub seen: Vec<Vec<f64>>,
    /// The state at the last time; `None` if it did not get there.
    pub end: Option<State>,
}

impl Flow {
    /// The same flow with the step that a fixed method chooses at a state, so that it is one map for all states.
    #[must_use]
    pub fn settled(mut self, at: &State) -> Flow {
        let (method, settings) = self.method;
        if method.stepping == Stepping::Fixed
            && settings.step.is_none()
            && let Ok(mut motion) =
                Propagator::new(&self.system, method, settings, &self.parameters)
            && motion.begin(at, &self.parameters).is_ok()
        {
            let step = Some(motion.step_size().abs()).filter(|step| step.is_normal());
            self.method.1.step = step;
        }
        self
    }

    /// Carries a state forwards through these times, which do not decrease and are not before it, and reads these channels
    /// at each.
    pub fn carry(&self, from: &State, times: &[f64], channels: &[usize]) -> Carried {
        let mut carried = Carried::default();
        // where it ends early is what is there
        let end = self.follow(from, times, channels, &mut carried.seen);
        carried.end = end.ok().flatten();
        carried
    }

    fn follow(
        &self,
        from: &State,
        times: &[f64],
        channels: &[usize],
        seen: &mut Vec<Vec<f64>>,
    ) -> Result<Option<State>, MotionError> {
        let (method, settings) = self.method;
        let Ok(mut motion) = Propagator::new(&self.system, method, settings, &self.parameters)
        else {
            return Ok(None);
        };
        motion.restore(from, &self.parameters, self.start, &[])?;
        let mut observer = motion.system().observer(&self.parameters);
        // those after the columns are computed only where one of them is read
        let columns = self.system.columns();
        let leading = channels.iter().all(|&channel| channel < columns);
        let count = if leading { columns } else { self.system.channels().len() };
        let mut values = vec![0.0; count];
        let last = times.last().copied().unwrap_or(from.time);
        for &time in times {
            loop {
                match motion.reach(time, last, &mut STEPS_PER_LOOK.clone())? {
                    Reached::There => break,
                    Reached::Ended => return Ok(None),
                    Reached::Underway | Reached::Happened(_) => {}
                }
                if self.system.cancel().is_cancelled() {
                    return Ok(None);
                }
            }
            if leading {
                observer.observe_columns(motion.state(), &mut values)?;
            } else {
                observer.observe(motion.state(), &mut values)?;
            }
            seen.push(channels.iter().map(|&c| values[c]).collect());
        }
        Ok(Some(motion.state().clone()))
    }
}
