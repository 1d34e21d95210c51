//! Steep powers: about u = 0 the series of u^40 has no term below the fortieth, so that a series of
//! lower order shows nothing of the force, and nothing limits the step. Where a law has such powers,
//! the rates near the end of a step are compared with the slopes of the series there; and if the last
//! terms vanish, also at times ever nearer to its beginning, since a force such as u²⁹/(1 + u³⁰)² vanishes
//! on both sides of where it acts.

use super::super::roots::value_and_slope;
use super::last_orders::{FAINT, last_orders};
use crate::system::{ExactRates, Series};

/// The deviation of a rate over the step, relative to the largest term of its series, that is
/// rounding of the series in any case.
const ROUNDING: f64 = 1e-13;

/// The part of a step where they are compared: before the end, which may lie on a kink.
const NEAR_THE_END: f64 = 0.98;

/// The ratio of two times at which they are compared where the last terms vanish, and how many there are: where those of
/// all numbers do nothing limits the step, and it may be as much longer than what it passes over as these reach; else few
/// suffice.
const NEARER: f64 = std::f64::consts::FRAC_1_SQRT_2;
const SAMPLES: usize = 140;
const FEW_SAMPLES: usize = 8;

/// The parts of a step where rates and slopes are compared.
pub(super) fn parts(series: &Series) -> impl Iterator<Item = f64> + use<> {
    let ends = |i: &usize| {
        let coefficients = series.coefficients(*i);
        last_orders(series.order()).all(|k| coefficients[k].abs() < FAINT)
    };
    let ending = (0..series.inputs()).filter(ends).count();
    let count = match ending {
        0 => 1,
        _ if ending < series.inputs() => FEW_SAMPLES,
        _ => SAMPLES,
    };
    std::iter::successors(Some(NEAR_THE_END), |part| Some(part * NEARER)).take(count)
}

/// Whether the rates at a state, a time `after` the origin in the unit of the series, are not those
/// of the series.
pub(super) fn missed(series: &Series, after: f64, rates: &ExactRates, tolerance: f64) -> bool {
    let allowed = ROUNDING.max(tolerance);
    (0..series.inputs().min(rates.moving())).any(|i| {
        let coefficients = series.coefficients(i);
        let (_, slope) = value_and_slope(coefficients, after);
        let rate = rates.rate(i).high * series.scale() / series.unit(i);
        let powers = std::iter::successors(Some(1.0), |power| Some(power * after));
        let terms = coefficients
            .iter()
            .zip(powers)
            .zip(0..)
            .map(|((c, power), k): (_, u32)| (c * power * f64::from(k.max(1))).abs());
        let size = terms.fold(0.0, f64::max);
        // a NaN is missed, and what underflows is not
        let apart = ((rate - slope) * after).abs();
        let agrees = apart <= allowed * size || apart * series.unit(i) < FAINT;
        slope.is_finite() && !agrees
    })
}

#[cfg(test)]
mod tests {
    use super::ROUNDING;

    #[test]
    fn what_is_allowed_is_above_rounding_and_below_what_shows() {
        // a sum of thirty terms with factors up to thirty, and the drift that gauges report
        const { assert!(ROUNDING > 30.0 * 30.0 * 0.5 * f64::EPSILON && ROUNDING < 1e-11) }
    }
}
