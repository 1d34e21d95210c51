//! The times at which the motion is looked at, and for what.
//!
//! In: a model. Out: times in ascending order. Never here: the motion, what is seen of it.

use super::quantity_sizes::QuantitySizes;
use crate::model::Model;

/// The number of samples of the motion for what is claimed to be conserved.
const SAMPLES: u32 = 200;

/// What is looked at at a time.
#[derive(Clone, Copy)]
pub(super) enum Look {
    /// The quantities that are claimed to be conserved.
    Claims,
    /// How large the quantities are that have an expected value.
    Sizes,
    /// An expected value, by its index.
    Value(usize),
}

impl Look {
    /// The index of the expected value.
    pub(super) fn value(self) -> Option<usize> {
        if let Look::Value(i) = self { Some(i) } else { None }
    }
}

/// When to look at the motion until `end`.
pub(super) fn schedule(
    model: &Model,
    end: f64,
    sizes: &QuantitySizes<'_>,
    has_claims: bool,
) -> Vec<(f64, Look)> {
    let start = model.run.start;
    let samples = if has_claims { SAMPLES } else { 0 };
    let sample_time = |k| start + (end - start) * f64::from(k) / f64::from(SAMPLES - 1);
    let samples = (0..samples).map(|k| (sample_time(k), Look::Claims));
    let looks = sizes.looks(start).into_iter().map(|time| (time, Look::Sizes));
    let values = model.expect.values.iter().enumerate();
    let values = values.map(|(k, value)| (value.at, Look::Value(k)));
    let mut schedule: Vec<(f64, Look)> = samples.chain(looks).chain(values).collect();
    schedule.sort_by(|a, b| a.0.total_cmp(&b.0));
    schedule
}
