//! The times at which the motion is observed, and for what.
//!
//! In: a model. Out: times in ascending order. Never here: the motion, what is seen of it.

use super::quantity_sizes::QuantitySizes;
use crate::model::Model;

/// The number of samples of the motion for what is claimed to be conserved.
const SAMPLES: u32 = 200;

#[derive(Clone, Copy)]
pub(super) enum Observation {
    Claims,
    /// How large the quantities are that have an expected value.
    Sizes,
    /// An expected value, by its index.
    Value(usize),
}

impl Observation {
    pub(super) fn value(self) -> Option<usize> {
        if let Observation::Value(i) = self { Some(i) } else { None }
    }
}

/// When to observe the motion until `end`.
pub(super) fn schedule(
    model: &Model,
    end: f64,
    sizes: &QuantitySizes<'_>,
    has_claims: bool,
) -> Vec<(f64, Observation)> {
    let start = model.run.start;
    let samples = if has_claims { SAMPLES } else { 0 };
    let sample_time = |k| start + (end - start) * f64::from(k) / f64::from(SAMPLES - 1);
    let samples = (0..samples).map(|k| (sample_time(k), Observation::Claims));
    let of_sizes = sizes.times(start).into_iter().map(|time| (time, Observation::Sizes));
    let values = model.expect.values.iter().enumerate();
    let values = values.map(|(k, value)| (value.at, Observation::Value(k)));
    let mut schedule: Vec<(f64, Observation)> = samples.chain(of_sizes).chain(values).collect();
    schedule.sort_by(|a, b| a.0.total_cmp(&b.0));
    schedule
}
