//! The frequency of a motion at given parameters and initial values.
//!
//! In: a motion among those of a picture, how long it is followed. Out: ω of its first coordinate: of an angle that goes round
//! the mean rate, otherwise the strongest line of the spectrum. With one degree of freedom that is 2π/T: a coordinate that goes
//! to and fro between two turning points is monotonic over half a period, and of its Fourier coefficients, by
//! |sin kt| ≤ k sin t, the first is the largest. Never here: the search for lines (`dynamics`), pictures.

use std::f64::consts::TAU;

use super::varied::VariedMotions;
use crate::dynamics::{SampledSpectrum, SpectrumRequest, sampled_spectrum};
use crate::ensemble::{Start, SystemFlow};
use crate::expr::Expr;
use crate::system::{ChannelKind, System};

/// How many numbers are taken of a motion, first and at most, and the lines that are searched for.
const COUNTS: [usize; 2] = [2048, 16_384];
const LINES: usize = 4;

/// A frequency is that of at least so many turns, and known to this part of it.
const TURNS: f64 = 3.0;
const KNOWN: f64 = 1e-3;

impl VariedMotions {
    /// The frequency of the motion over a time; `system` may be cancelled. Where the energy changes, as long a time is left out
    /// before.
    pub(super) fn frequency(
        &self,
        system: &System,
        start: &Start,
        length: f64,
    ) -> Result<f64, String> {
        let channels = system.channels();
        let first = channels.iter().position(|c| c.kind == ChannelKind::Position(0));
        let channel = first.ok_or_else(|| "there is no coordinate".to_owned())?;
        let name = &channels[channel].shown;
        let flow = SystemFlow {
            system: system.clone(),
            method: self.method,
            parameters: start.parameters.clone(),
            start: start.time,
            effort: None,
        };
        let state = start.state(system).map_err(|why| why.to_string())?;
        let settles = self.equations.energy_rate != Expr::ZERO;
        let begin = start.time + if settles { length } else { 0.0 };
        let turn = system.period(channel, &start.parameters);
        let request = SpectrumRequest {
            span: [begin, begin + length],
            counts: COUNTS,
            is_angle: turn.is_some(),
            lines: (LINES, 1),
            drive: None,
        };
        let mut sample = |times: &[f64]| {
            let seen = flow.carry(&state, times, &[channel]).seen;
            seen.iter().map(|row| row[0]).collect()
        };
        let mut report = |_| !system.cancel().is_cancelled();
        let sampled =
            sampled_spectrum(&request, &mut sample, &mut report).map_err(|why| why.to_string())?;
        let is_too_fast = sampled.is_false() || sampled.is_strongest_left_out();
        let SampledSpectrum { spectrum: found, rate, .. } = sampled;
        let rounds = |rate: f64, turn: f64| (rate * length / turn).abs();
        if let (Some(rate), Some(turn)) = (rate, turn)
            && rounds(rate.rate, turn) >= TURNS
            && rate.error <= KNOWN * rate.rate.abs()
        {
            return Ok((rate.rate * TAU / turn).abs());
        }
        if is_too_fast {
            return Err(format!("{name} is faster than so many values can show"));
        }
        let strongest = found.lines.first().filter(|_| !found.is_continuous());
        let line = strongest.ok_or_else(|| format!("no frequency of {name} stands out"))?;
        let turns = line.frequency * length / TAU;
        if turns < TURNS || line.error > KNOWN * line.frequency {
            return Err(format!("{name} makes too few turns for a frequency"));
        }
        Ok(line.frequency)
    }
}
