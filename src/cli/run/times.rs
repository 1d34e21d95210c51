//! The start and end of a run, and the times of its rows.

use crate::cli::decimal::{divisions, multiples};
use crate::cli::error::CommandError;
use crate::integrate::spacing;
use crate::model::RunSettings;
use crate::printable;

const LENGTH: f64 = 10.0;

/// The default number of intervals between rows.
const INTERVALS: u32 = 200;

/// The shortest time between two rows; below it the powers of a step underflow.
const SHORTEST: f64 = 1e-280;

/// The times of a run.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Times {
    start: f64,
    end: f64,
    rows: Which,
}

#[derive(Clone, PartialEq, Debug)]
enum Which {
    Even,
    Every(f64),
    At(Vec<f64>),
}

impl Times {
    /// The requested times, completed from the file or the defaults.
    pub(super) fn plan(
        run: &RunSettings,
        until: Option<f64>,
        every: Option<f64>,
        at: Option<&[f64]>,
    ) -> Result<Times, CommandError> {
        let start = run.start;
        let wrong = |message: String| Err(CommandError::WrongUse(message));
        let shown = printable::number;
        let end = match (until, at.and_then(<[f64]>::last)) {
            (Some(until), _) => until,
            (None, Some(&last)) => last,
            (None, None) => run.until.unwrap_or(start + LENGTH),
        };
        let mut pairs = at.unwrap_or_default().iter().zip(at.unwrap_or_default().iter().skip(1));
        if let Some((before, after)) = pairs.find(|(before, after)| after <= before) {
            return wrong(format!(
                "--at: times increase, but {} follows {}",
                shown(*after),
                shown(*before)
            ));
        }
        for &time in at.unwrap_or_default().iter().chain(&[end]) {
            if time < start {
                return wrong(format!(
                    "the motion begins at {}; {} is before it",
                    shown(start),
                    shown(time)
                ));
            }
            if time > end {
                return wrong(format!(
                    "--at: {} is after the end, --until {}",
                    shown(time),
                    shown(end)
                ));
            }
        }
        if !(end - start).is_finite() {
            return wrong(format!("from {start:e} to {end:e} is farther than the clock reaches"));
        }
        if end == start && at.is_none() && until.is_none() && run.until.is_none() {
            return wrong(format!(
                "the clock cannot tell t = {start:e} from {LENGTH} later: its digits are {:e} apart \
                 there; begin earlier, or say --until",
                spacing(start)
            ));
        }
        let rows = match (every, at) {
            (Some(gap), _) if gap <= 0.0 => {
                return wrong(format!(
                    "--every {}: the time between two rows must be above zero",
                    shown(gap)
                ));
            }
            (Some(gap), _) => Which::Every(gap),
            (None, Some(at)) => Which::At(at.to_vec()),
            (None, None) => Which::Even,
        };
        let times = Times { start, end, rows };
        times.check()?;
        Ok(times)
    }

    /// Whether the rows are at listed times and no other.
    pub(super) fn are_listed(&self) -> bool {
        matches!(self.rows, Which::At(_))
    }

    /// Checks that the rows are separated by more than the resolution of the time.
    fn check(&self) -> Result<(), CommandError> {
        let Times { start, end, .. } = *self;
        let gap = match &self.rows {
            _ if end == start => return Ok(()),
            Which::Even => (end - start) / f64::from(INTERVALS),
            Which::Every(gap) => *gap,
            // they were already checked to increase
            Which::At(_) => end - start,
        };
        let finest = spacing(start.abs().max(end.abs()));
        if gap < finest {
            let message = format!(
                "the clock cannot tell rows {gap:e} apart at t = {:e}: its digits are {finest:e} \
                 apart there",
                if end.abs() > start.abs() { end } else { start }
            );
            return Err(CommandError::WrongUse(message));
        }
        if gap < SHORTEST {
            let message = format!(
                "rows {gap:e} apart are closer than a motion can be followed, {SHORTEST:e}; take a \
                 larger unit of time"
            );
            return Err(CommandError::WrongUse(message));
        }
        if end - start < SHORTEST {
            let message = format!(
                "from {start:e} to {end:e} is shorter than a motion can be followed, {SHORTEST:e}; \
                 take a larger unit of time"
            );
            return Err(CommandError::WrongUse(message));
        }
        Ok(())
    }

    pub(super) fn start(&self) -> f64 {
        self.start
    }

    pub(super) fn end(&self) -> f64 {
        self.end
    }

    /// The length from the start to the end; 1 if they are equal.
    pub(super) fn length(&self) -> f64 {
        let length = self.end - self.start;
        if length > 0.0 { length } else { 1.0 }
    }

    pub(super) fn rows(&self) -> Box<dyn Iterator<Item = f64>> {
        let Times { start, end, .. } = *self;
        match &self.rows {
            Which::Even if end == start => Box::new(std::iter::once(start)),
            Which::Even => Box::new(divisions(start, end, INTERVALS)),
            Which::Every(gap) => Box::new(multiples(start, *gap, end)),
            Which::At(times) => Box::new(times.clone().into_iter()),
        }
    }
}
