//! What is recorded of an occurrence, and the sentence that reports it.
//!
//! In: an occurrence of the motion. Out: rows of the trail, an entry of the log, a notice. Never here: when it occurs.

use super::running_experiment::Experiment;
use crate::integrate::{Occurrence, OccurrenceKind};
use crate::num::short;
use crate::system;

/// A change of the energy below this share of it is rounding.
const ROUNDING: f64 = 1e-12;

impl Experiment {
    /// Records an occurrence: rows of the trail before and after it, and gauges that continue from the state after an
    /// impulse. Returns a sentence about it.
    pub(super) fn note(
        &mut self,
        mut occurrence: Occurrence,
    ) -> Result<String, system::MotionError> {
        let clock = occurrence.time;
        occurrence.time = self.motion.sign() * clock;
        let lead = format!("{} at t = {}", occurrence.name, short(occurrence.time));
        let sentence = match &occurrence.kind {
            OccurrenceKind::Mark | OccurrenceKind::Crossing(_) => lead,
            OccurrenceKind::Stop => {
                self.run.ended = Some(occurrence.name.clone());
                format!("{lead}: the motion ends")
            }
            OccurrenceKind::Release(constraint) => {
                let name = &self.model.constraints[*constraint].name;
                format!("{lead}: the constraint {name} no longer holds")
            }
            OccurrenceKind::StepInTime => {
                let before = self.motion.values_before()?;
                self.recorder.insert(clock, &before);
                self.recorder.insert(clock, self.motion.values());
                // no event of the file
                let time = short(occurrence.time);
                let system = self.motion.system();
                let law = if self.model.is_lagrangian() { "L" } else { "H" };
                let jumps = if system.discontinuities().momenta_jump {
                    "the velocities jump, the momenta do not"
                } else {
                    "the energy jumps with it"
                };
                return Ok(format!("{law} has a step at t = {time}: {jumps}"));
            }
            OccurrenceKind::Impulse { .. } => {
                let before = self.motion.values_before()?;
                self.recorder.insert(clock, &before);
                let after = self.motion.values();
                self.gauges.shift(clock, &before, after);
                let energy = self.energy_of(&before);
                let given = self.energy_of(after) - energy;
                if !given.is_finite() {
                    lead
                } else if is_rounding(given, energy.abs() + self.motion_of(&before)) {
                    format!("{lead}: energy unchanged")
                } else {
                    let sign = if given < 0.0 { '−' } else { '+' };
                    format!("{lead}: energy {sign}{}", short(given.abs()))
                }
            }
        };
        self.recorder.insert(clock, self.motion.values());
        self.log.occurrences.push(occurrence);
        Ok(sentence)
    }
}

/// Whether a change of the energy is rounding, beside what it is and what moves of it.
fn is_rounding(change: f64, size: f64) -> bool {
    change.abs() <= ROUNDING * size
}

#[cfg(test)]
mod tests {
    use super::is_rounding;

    #[test]
    fn the_energy_changes_beyond_1e_12_of_its_size() {
        assert!(is_rounding(-1.9e-12, 2.0) && !is_rounding(-2.1e-12, 2.0));
    }
}
