//! When a run begins and ends, and when it gives a row.

use crate::cli::decimal::{divisions, multiples};
use crate::cli::failure::Failure;
use crate::model::RunSettings;
use crate::printable;

/// How long a run is where nobody says.
const LENGTH: f64 = 10.0;

/// How many intervals lie between its rows where nobody says.
const INTERVALS: u32 = 200;

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
    /// The times asked for; what is left open the file says, or custom.
    pub(super) fn plan(
        run: &RunSettings,
        until: Option<f64>,
        every: Option<f64>,
        at: Option<&[f64]>,
    ) -> Result<Times, Failure> {
        let start = run.start;
        let wrong = |message: String| Err(Failure::WrongUse(message));
        let told = printable::number;
        let end = match (until, at.and_then(<[f64]>::last)) {
            (Some(until), _) => until,
            (None, Some(&last)) => last,
            (None, None) => run.until.unwrap_or(start + LENGTH),
        };
        let mut pairs = at.unwrap_or_default().iter().zip(at.unwrap_or_default().iter().skip(1));
        if let Some((before, after)) = pairs.find(|(before, after)| after <= before) {
            return wrong(format!(
                "--at: times increase, but {} follows {}",
                told(*after),
                told(*before)
            ));
        }
        for &time in at.unwrap_or_default().iter().chain(&[end]) {
            if time < start {
                return wrong(format!(
                    "the motion begins at {}; {} is before it",
                    told(start),
                    told(time)
                ));
            }
            if time > end {
                return wrong(format!(
                    "--at: {} is after the end, --until {}",
                    told(time),
                    told(end)
                ));
            }
        }
        let rows = match (every, at) {
            (Some(gap), _) if gap <= 0.0 => {
                return wrong(format!(
                    "--every {}: the time between two rows is above zero",
                    told(gap)
                ));
            }
            (Some(gap), _) => Which::Every(gap),
            (None, Some(at)) => Which::At(at.to_vec()),
            (None, None) => Which::Even,
        };
        Ok(Times { start, end, rows })
    }

    /// The time of the initial values.
    pub(super) fn start(&self) -> f64 {
        self.start
    }

    /// When the run ends.
    pub(super) fn end(&self) -> f64 {
        self.end
    }

    /// From the start to the end; 1 where they are one.
    pub(super) fn length(&self) -> f64 {
        let length = self.end - self.start;
        if length > 0.0 { length } else { 1.0 }
    }

    /// The times of the rows.
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
