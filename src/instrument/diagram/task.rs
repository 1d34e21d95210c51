//! The numbers of a diagram: those of the motions at the next values of the parameter.
//!
//! In: the motions, and what is known. Out: the numbers at each value, and as points. Never here: the picture.

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::Arc;

use super::super::varied::{self, VariedConditions, VariedMotions};
use crate::ensemble::{Crossings, SectionPlan, Start, crossings_of_all, in_order, section_group};
use crate::expr::Expr;
use crate::job::Progress;
use crate::system::System;

/// The values of the parameter, and how many of them make one part of the work, after which the picture is drawn anew.
pub(super) const MOST: usize = 256;
pub(super) const PART: usize = 16;

/// The crossings at each value, and those before them that are left out where friction draws all motions to an attractor.
const COUNT: usize = 80;
const TRANSIENT: usize = 160;

/// A motion ends after so many steps without a crossing.
const IDLE: u64 = 4000;

/// An exponent is followed over so many seconds of the wall clock at the file's own speed.
const SECONDS: f64 = 120.0;

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in super::super) enum DiagramQuantity {
    /// Its crossings of a surface, or its largest exponent where there is none.
    Crossings,
    /// The frequency of the first coordinate.
    Frequency,
    /// 2π divided by it.
    Period,
}

/// What was computed, and under which conditions.
pub(super) struct ComputedDiagram {
    pub(super) number: DiagramQuantity,
    pub(super) conditions: VariedConditions,
    /// The numbers at each value of the parameter.
    pub(super) columns: Vec<(f64, Vec<f64>)>,
    pub(super) points: Arc<Vec<[f64; 2]>>,
    /// The range of the numbers.
    pub(super) extent: [f64; 2],
    /// Why a motion could not be followed.
    pub(super) refused: Option<String>,
}

/// What a job computes: the numbers at the next values of the parameter.
pub(super) struct DiagramTask {
    pub(super) number: DiagramQuantity,
    pub(super) motions: VariedMotions,
    pub(super) section: Option<usize>,
    /// The quantity at the crossings.
    pub(super) channel: Option<usize>,
    pub(super) columns: Vec<(f64, Vec<f64>)>,
}

impl DiagramTask {
    pub(super) fn next_part(&self, progress: &Progress) -> ComputedDiagram {
        let conditions = self.motions.conditions.clone();
        let system = self.motions.system.with_cancel(progress.token().clone());
        let mut columns = self.columns.clone();
        let first = columns.len();
        let [from, to] = conditions.window.first().copied().unwrap_or_default();
        let at = |i: usize| from + (to - from) * evenly(first + i);
        // what is awaited is the whole picture, which has a part of it already
        progress.expect(MOST as u64);
        progress.reach(first as u64);
        let mut refused = None;
        let places: Vec<f64> = (0..PART).map(at).collect();
        let groups: Vec<&[f64]> = places.chunks(self.group(&system)).collect();
        let group = |i: usize| self.numbers(&system, groups[i]);
        let mut done = first as u64;
        let take = |i: usize, found: Vec<Result<Vec<f64>, String>>| {
            done += found.len() as u64;
            progress.reach(done);
            for (&value, found) in groups[i].iter().zip(found) {
                // a value without a motion leaves a gap; the reason is shown where none has one
                let numbers = found.unwrap_or_else(|why| {
                    refused.get_or_insert(why);
                    Vec::new()
                });
                columns.push((value, numbers));
            }
            ControlFlow::Continue(())
        };
        let threads = in_order(0, groups.len(), progress.token(), group, take);
        if let Err(why) = threads {
            refused = Some(why.to_string());
        }
        let nothing = columns.iter().all(|(_, numbers)| numbers.is_empty());
        let refused = refused.filter(|_| nothing);
        let points: Vec<[f64; 2]> =
            columns.iter().flat_map(|(x, all)| all.iter().map(|y| [*x, *y])).collect();
        let finite = points.iter().map(|at| at[1]).filter(|y| y.is_finite());
        let extent = finite
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| [low.min(y), high.max(y)]);
        let number = self.number;
        ComputedDiagram { number, conditions, columns, points: Arc::new(points), extent, refused }
    }

    /// How many motions one thread follows at a time.
    fn group(&self, system: &System) -> usize {
        let (method, settings) = self.motions.method;
        match (self.number, self.section) {
            (DiagramQuantity::Crossings, None) => self.motions.exponent_group(system),
            (_, Some(_)) => section_group(system, method, settings),
            (_, None) => 1,
        }
    }

    /// The crossings of the motions at values of the parameter, or their largest exponents.
    fn numbers(&self, system: &System, values: &[f64]) -> Vec<Result<Vec<f64>, String>> {
        let VariedMotions { model, method: (method, settings), .. } = &self.motions;
        let starts: Vec<Start> = values.iter().map(|&x| self.motions.start(&[x])).collect();
        if self.number != DiagramQuantity::Crossings {
            let length = SECONDS * model.run.speed.abs();
            let number = |start: &Start| {
                let frequency = self.motions.frequency(system, start, length)?;
                Ok(vec![if self.number == DiagramQuantity::Period {
                    TAU / frequency
                } else {
                    frequency
                }])
            };
            return starts.iter().map(number).collect();
        }
        let (Some(section), Some(channel)) = (self.section, self.channel) else {
            let length = SECONDS * model.run.speed;
            let found = self.motions.exponents(system, &starts, length).into_iter();
            return found.map(|found| Ok(found?.into_iter().collect())).collect();
        };
        let dissipates = model.mechanics.dissipation() != Expr::ZERO;
        let transient = if dissipates { TRANSIENT } else { 0 };
        let plan = SectionPlan {
            event: model.event_of_section(section),
            count: Some((transient + COUNT) as u64),
            until: None,
            idle: IDLE,
            all_channels: true,
        };
        let numbers = |(found, period): (Crossings, Option<f64>)| {
            let rows = found.rows.iter().skip(transient);
            let numbers: Vec<f64> = rows
                .filter_map(|row| row.get(1 + channel).map(|&x| varied::within(x, period)))
                .collect();
            match found.message {
                Some(why) if numbers.is_empty() => Err(why),
                _ => Ok(numbers),
            }
        };
        let periods: Vec<Option<f64>> =
            starts.iter().map(|start| system.period(channel, &start.parameters)).collect();
        let starts = starts.into_iter().map(Ok).collect();
        let found = crossings_of_all(system, method, *settings, starts, &plan);
        found.into_iter().zip(periods).map(numbers).collect()
    }
}

/// The i-th of numbers that fill the interval from 0 to 1 ever more closely: the binary digits of i, mirrored at the
/// point (J. G. van der Corput, 1935).
fn evenly(i: usize) -> f64 {
    (i as u64).reverse_bits() as f64 / u64::MAX as f64
}
