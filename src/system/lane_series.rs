//! The series of one of several orbits, by itself.
//!
//! In: the series of a [`BatchSeries`], a lane. Out: its coefficients one after another. Never here: how they are built.

use super::batch_series::BatchSeries;
use super::step_series::StepSeries;
use crate::num::DoubleDouble;

/// The series of all numbers of the state of one lane.
#[derive(Clone, Debug)]
pub struct LaneSeries {
    coefficients: Vec<f64>,
    order: usize,
    time: DoubleDouble,
    scale: f64,
}

impl LaneSeries {
    /// No series.
    pub const EMPTY: LaneSeries =
        LaneSeries { coefficients: Vec::new(), order: 0, time: DoubleDouble::ZERO, scale: 1.0 };

    /// Copies those of a lane.
    pub fn take(&mut self, series: &BatchSeries, lane: usize) {
        self.coefficients.clear();
        for i in 0..series.len() {
            self.coefficients.extend(series.coefficients(i).iter().map(|c| c.0[lane]));
        }
        self.order = series.order();
        (self.time, self.scale) = (series.time(lane), series.scale().0[lane]);
    }
}

impl StepSeries for LaneSeries {
    fn order(&self) -> usize {
        self.order
    }

    fn count(&self) -> usize {
        self.coefficients.len() / (self.order + 1)
    }

    fn time(&self) -> DoubleDouble {
        self.time
    }

    fn scale(&self) -> f64 {
        self.scale
    }

    fn coefficients(&self, i: usize) -> &[f64] {
        &self.coefficients[i * (self.order + 1)..][..=self.order]
    }
}
