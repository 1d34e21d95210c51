//! The longest step that the series of several orbits allow, each its own.
//!
//! In: the series of a [`BatchSeries`]. Out: for each lane the step that [`StepSize`](super::step_size::StepSize)
//! finds for that orbit alone, to the last bit. Never here: the rule and its constants.
//!
//! Beside one another the rule would take more: what one orbit need not ask, the seven others would wait for. So the series are put
//! together orbit by orbit, and each is asked by itself.

use super::argument_step::{
    FARTHEST_ARGUMENT, before_pole, may_pass_pole, of_argument, of_steep_pole,
};
use super::last_orders::LANES;
use super::step_size::{SeriesCounts, SeriesOrders, StepSize};
use crate::num::{BATCH, Batch, FourLaneKernel, FourLanes, in_four_lanes};
use crate::system::BatchSeries;

/// The rule for several orbits.
#[derive(Clone, Debug)]
pub(super) struct BatchStepSize {
    rule: StepSize,
    /// The number whose series allowed the least last time, in each lane.
    least: [usize; BATCH],
    /// The series of all numbers of one orbit after those of another, padded to whole chunks.
    gathered: Vec<[f64; LANES]>,
}

impl BatchStepSize {
    pub(super) fn new(tolerance: f64, orders: SeriesOrders) -> BatchStepSize {
        let rule = StepSize::new(tolerance, orders);
        BatchStepSize { rule, least: [0; BATCH], gathered: Vec::new() }
    }

    /// The longest step of each lane, in its unit; infinite for a polynomial, NaN where a coefficient
    /// is not finite.
    pub(super) fn longest(&mut self, series: &BatchSeries) -> Batch {
        let mut shortest = in_four_lanes(BatchByCoefficients { rule: self, series });
        for (function, u) in series.arguments() {
            for lane in 0..BATCH {
                let alone = || -> Vec<f64> { u.iter().map(|c| c.0[lane]).collect() };
                if may_pass_pole(function) && !shortest.0[lane].is_nan() {
                    shortest.0[lane] = shortest.0[lane].min(before_pole(&alone()));
                }
                let h = shortest.0[lane];
                let far = |k: usize, h: f64| u[k].0[lane].abs() * h > FARTHEST_ARGUMENT;
                let (square, cube) = (h * h, h * h * h);
                let moves_far = far(1, h) || far(2, square) || far(3, cube) || !cube.is_finite();
                if moves_far && !h.is_nan() {
                    shortest.0[lane] = h.min(of_argument(function, &alone(), None));
                }
            }
        }
        for (degree, above, u) in series.steep_poles() {
            for (lane, shortest) in shortest.0.iter_mut().enumerate() {
                let alone: Vec<f64> = u.iter().map(|c| c.0[lane]).collect();
                let own = of_steep_pole(degree.0[lane], above.0[lane], &alone);
                // a NaN remains
                if own < *shortest {
                    *shortest = own;
                }
            }
        }
        shortest
    }

    #[inline(always)]
    fn by_coefficients<L: FourLanes>(&mut self, lanes: L, series: &BatchSeries) -> Batch {
        let BatchStepSize { rule, least, gathered } = self;
        let (len, inputs, terms) = (series.len(), series.inputs(), series.order() + 1);
        let stride = terms.div_ceil(LANES);
        gathered.resize(BATCH * len * stride, [0.0; LANES]);
        // zero, or NaN where a coefficient is not finite
        let zero = lanes.splat(0.0);
        let mut finite = [zero; BATCH / LANES];
        for i in 0..len {
            let coefficients = series.coefficients(i);
            for chunk in 0..stride {
                let rows = &coefficients[LANES * chunk..terms.min(LANES * (chunk + 1))];
                for half in 0..BATCH / LANES {
                    let mut four = [zero; LANES];
                    for row in 0..rows.len() {
                        four[row] = rows[row].half(lanes, half);
                        finite[half] = lanes.add(finite[half], lanes.mul(four[row], zero));
                    }
                    let columns = lanes.transposed(four);
                    for column in 0..LANES {
                        let lane = LANES * half + column;
                        gathered[(lane * len + i) * stride + chunk] =
                            lanes.to_array(columns[column]);
                    }
                }
            }
        }
        let counts = SeriesCounts { inputs, switches: 0, integrals: len - inputs };
        let mut steps = Batch::splat(f64::NAN);
        for lane in 0..BATCH {
            if lanes.to_array(finite[lane / LANES])[lane % LANES].is_nan() {
                continue;
            }
            let own = gathered[lane * len * stride..][..len * stride].as_flattened();
            rule.least = least[lane];
            let of = |i: usize| &own[LANES * stride * i..][..terms];
            steps.0[lane] = rule.by_coefficients(lanes, counts, of);
            least[lane] = rule.least;
        }
        steps
    }
}

/// The kernel of the rule.
struct BatchByCoefficients<'a> {
    rule: &'a mut BatchStepSize,
    series: &'a BatchSeries,
}

impl FourLaneKernel for BatchByCoefficients<'_> {
    type Output = Batch;

    #[inline(always)]
    fn run<L: FourLanes, const FUSED: bool>(self, lanes: L) -> Batch {
        self.rule.by_coefficients(lanes, self.series)
    }
}
