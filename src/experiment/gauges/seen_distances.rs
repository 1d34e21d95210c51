//! The distances of a gauge that its value shows: those of accurate values, beyond the last digits of their terms.
//!
//! In: distances, and by how much rounding of the state changes the value. Out: the greatest of them, when they first exceeded a
//! limit, and whether rounding of the state explains them. Never here: whether they count.

use crate::analysis::RoundedInput;
use crate::system::TermWatch;

/// A change of a value by more than this many ε of its terms is one of the state.
const LAST_DIGITS: f64 = 4.0;

/// A distance is rounding of the state up to this multiple of the change by half a digit of each of its numbers.
const OF_STATE: f64 = 4.0;

/// By how much rounding of the state that was observed last changes a quantity, in units of ε, and the variable that changes it most.
pub(in crate::experiment) fn by_rounding_of_state(
    terms: &TermWatch,
    quantity: usize,
) -> Option<(f64, RoundedInput)> {
    let (change, name, value) = terms.change_by_rounding(quantity)?;
    let (name, value) = (name.to_owned(), value.abs());
    Some((change / f64::EPSILON, RoundedInput { name, digits: value.next_up() - value }))
}

/// The distances that were seen since the reference was taken.
#[derive(Clone, Debug, Default)]
pub(super) struct SeenDistances {
    /// Each at least twice the one before, with their times.
    distances: Vec<(f64, f64)>,
    /// The greatest change of the value by rounding of the state alone, in units of ε, and the variable that changes it most.
    by_rounding: Option<(f64, RoundedInput)>,
}

impl SeenDistances {
    /// What the last digits of terms of this size hide.
    pub(super) fn hidden(size: f64) -> f64 {
        LAST_DIGITS * f64::EPSILON * size
    }

    /// Records the distance of an accurate value if it is more than the last digits of terms of this size.
    pub(super) fn note(&mut self, time: f64, distance: f64, size: f64) {
        let is_far = self.distances.is_empty() || distance > 2.0 * self.greatest();
        if is_far && distance > Self::hidden(size) {
            self.distances.push((time, distance));
        }
    }

    /// Records a distance, with what made it, if it is no more than rounding of the state; `change` is that of the value.
    #[inline]
    pub(super) fn note_if_rounding(
        &mut self,
        (time, distance): (f64, f64),
        size: f64,
        change: Option<(f64, RoundedInput)>,
    ) -> bool {
        let limit = change.as_ref().map_or(0.0, |(change, _)| OF_STATE * f64::EPSILON * change);
        let is_rounding = change.is_some() && distance <= limit;
        if is_rounding {
            self.note_rounding(change);
            self.note(time, distance, size);
        }
        is_rounding
    }

    /// Continues from the greatest distance of a motion that was saved, seen at this time.
    pub(super) fn resume(&mut self, time: f64, distance: f64) {
        self.distances.push((time, distance));
    }

    /// Begins anew with the motion.
    pub(super) fn begin(&mut self) {
        self.distances.clear();
    }

    /// The greatest distance, up to a factor of two.
    pub(super) fn greatest(&self) -> f64 {
        self.distances.last().map_or(0.0, |&(_, distance)| distance)
    }

    /// When a distance first exceeded a limit, or the greatest was seen if none did.
    pub(super) fn first_beyond(&self, limit: f64) -> Option<f64> {
        let beyond = |&&(_, distance): &&(f64, f64)| distance > limit;
        self.distances.iter().find(beyond).or(self.distances.last()).map(|&(time, _)| time)
    }

    /// Records by how much rounding of the state changes the value.
    pub(super) fn note_rounding(&mut self, change: Option<(f64, RoundedInput)>) {
        self.by_rounding = greater(self.by_rounding.take(), change);
    }

    /// The variable whose rounding explains a distance, if rounding of the state does, now or before; `floor` is the rounding
    /// error of a value of size 1.
    pub(super) fn explained(
        &self,
        distance: f64,
        floor: f64,
        now: Option<(f64, RoundedInput)>,
    ) -> Option<RoundedInput> {
        let (change, input) = greater(self.by_rounding.clone(), now)?;
        (distance <= floor * change).then_some(input)
    }
}

/// The greater of two changes of a value, each with what makes it.
fn greater(
    one: Option<(f64, RoundedInput)>,
    other: Option<(f64, RoundedInput)>,
) -> Option<(f64, RoundedInput)> {
    match (one, other) {
        (Some(one), Some(other)) => Some(if other.0 > one.0 { other } else { one }),
        (one, other) => one.or(other),
    }
}

#[cfg(test)]
mod tests {
    use super::SeenDistances;
    use crate::analysis::RoundedInput;

    #[test]
    fn a_change_is_one_of_the_state_beyond_four_units_in_the_last_place_of_its_terms() {
        let seen = |units: f64, size: f64| {
            let mut seen = SeenDistances::default();
            seen.note(1.0, units * f64::EPSILON * size, size);
            seen.greatest() > 0.0
        };
        for size in [1e-300, 3.0, 1e200] {
            assert!(!seen(3.9, size) && seen(4.1, size), "{size}");
        }
    }

    #[test]
    fn rounding_of_the_state_explains_four_times_the_change_by_half_a_digit() {
        let is_rounding = |units: f64| {
            let mut seen = SeenDistances::default();
            let input = RoundedInput { name: "x".to_owned(), digits: f64::EPSILON };
            seen.note_if_rounding((1.0, units * f64::EPSILON), 0.0, Some((1.0, input)))
        };
        assert!(is_rounding(3.9) && !is_rounding(4.1));
        let unknown = SeenDistances::default().note_if_rounding((1.0, 0.0), 0.0, None);
        assert!(!unknown, "where no change is known nothing is explained");
    }
}
