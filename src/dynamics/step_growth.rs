//! By how much a tangent vector grows within single steps: one that stands out leads past a pole of the coordinates.
//!
//! In: the logarithm of the vector's length after each step. Out: the greatest growth. Never here: the vector, or a verdict.

/// Within one step of a motion that it resolves, neighbours part by less than this power of e.
const SEPARATED: f64 = 1.0;

/// A step stands out where neighbours part in it by so many times as much as on the average: under a map, whose steps
/// are long, they part by more than that power in all of them.
const OUTSTANDING: f64 = 20.0;

/// By how much a vector has grown within single steps.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StepGrowth {
    /// The logarithm of its length at the end of the last step.
    last: f64,
    /// The greatest growth, and when the step ended.
    greatest: (f64, f64),
    sum: f64,
}

impl StepGrowth {
    /// A step has ended, with a vector whose length has this logarithm.
    pub(super) fn reach(&mut self, time: f64, size: f64) {
        let grown = size - self.last;
        if grown > self.greatest.0 {
            self.greatest = (grown, time);
        }
        self.sum += grown.abs();
        self.last = size;
    }

    /// The vector has the length 1 from now on.
    pub(super) fn renew(&mut self) {
        self.last = 0.0;
    }

    /// The growth within a step that stands out among so many, and when it ended.
    pub(super) fn outstanding(&self, steps: u64) -> Option<(f64, f64)> {
        let (grown, _) = self.greatest;
        let mean = self.sum / steps as f64;
        (grown > SEPARATED && grown > OUTSTANDING * mean).then_some(self.greatest)
    }
}

#[cfg(test)]
mod tests {
    use super::StepGrowth;

    /// Whether a step in which the vector grows by `one` stands out among 99 of this growth.
    fn stands_out(one: f64, others: f64) -> bool {
        let (mut growth, mut size) = (StepGrowth::default(), 0.0);
        for k in 0..100_u32 {
            size += if k == 40 { one } else { others };
            growth.reach(f64::from(k), size);
        }
        let found = growth.outstanding(100);
        assert!(found.is_none_or(|(grown, time)| (grown - one).abs() < 1e-12 && time == 40.0));
        found.is_some()
    }

    #[test]
    fn a_step_stands_out_by_more_than_e_and_twenty_times_the_mean() {
        for (one, others, expected) in [
            (1.01, 0.0, true),
            (0.99, 0.0, false),
            (1.01, 0.03, true),
            (0.99, 0.03, false),
            // 20 (99 a + 3)/100 is 3 for a = 4/33
            (3.0, 0.1212, true),
            (3.0, 0.1213, false),
            (50.0, 2.02, true),
            (50.0, 2.03, false),
            // what shrinks counts in the mean
            (3.0, -0.1213, false),
        ] {
            assert_eq!(stands_out(one, others), expected, "{one} among {others}");
        }
    }
}
