//! The numbers of a map: those of the motions that begin at the places of a lattice.
//!
//! In: motions over a plane, what is known of them. Out: the numbers at the next places. Never here: what is drawn of them.

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::ensemble::{
    Carried, Crossings, SectionPlan, Start, SystemFlow, crossings_of_all, in_order, section_group,
};
use crate::instrument::Field;
use crate::instrument::varied::{self, VariedConditions, VariedMotions};
use crate::job::Progress;
use crate::system::{MotionError, State, System};

/// The places of the lattice, and how many of them make one part of the work, after which the picture is drawn anew.
pub(super) const LATTICE: [usize; 2] = [128, 64];
pub(super) const PART: usize = 64;

/// The distance of neighbours in the first pass, a power of two; each further pass halves it.
const COARSE: usize = 16;

/// The part of the numbers that the ramp of shades spans: single ones may be far above.
const SHADED: f64 = 0.98;

/// What was computed, and under which conditions.
pub(super) struct ComputedMap {
    pub(super) conditions: VariedConditions,
    pub(super) length: f64,
    /// The numbers at the places, in their order.
    pub(super) values: Vec<f64>,
    pub(super) field: Arc<Field>,
    /// Why a motion could not be followed, where none could.
    pub(super) refused: Option<String>,
}

#[derive(Clone, Copy, PartialEq)]
pub(super) enum MapNumber {
    /// Its largest Lyapunov exponent.
    Exponent,
    /// When it first crosses the surface of section of this index.
    FirstCrossing(usize),
    AtTheEnd(usize),
}

/// What a job computes: the numbers at the next places.
pub(super) struct MapTask {
    pub(super) motions: VariedMotions,
    pub(super) number: MapNumber,
    pub(super) length: f64,
    pub(super) values: Vec<f64>,
}

impl MapTask {
    pub(super) fn next_part(&self, progress: &Progress) -> ComputedMap {
        let system = self.motions.system.with_cancel(progress.token().clone());
        let mut values = self.values.clone();
        let places = places();
        let next = places.get(values.len()..).unwrap_or_default();
        let next = &next[..next.len().min(PART)];
        progress.expect(places.len() as u64);
        progress.reach(values.len() as u64);
        let mut refused = None;
        let groups: Vec<_> = next.chunks(self.group(&system)).collect();
        let group = |i: usize| {
            let starts = groups[i].iter().map(|(place, _)| self.motions.start(&self.at(*place)));
            self.numbers(&system, starts.collect())
        };
        let mut done = values.len() as u64;
        let take = |_, found: Vec<Result<f64, String>>| {
            done += found.len() as u64;
            progress.reach(done);
            // a place without a motion is left blank; the reason is shown where none has one
            values.extend(found.into_iter().map(|found| {
                found.unwrap_or_else(|why| {
                    refused.get_or_insert(why);
                    f64::NAN
                })
            }));
            ControlFlow::Continue(())
        };
        if let Err(why) = in_order(0, groups.len(), progress.token(), group, take) {
            refused = Some(why.to_string());
        }
        let nothing = values.iter().all(|x| x.is_nan());
        let refused = refused.filter(|_| nothing);
        let (conditions, length) = (self.motions.conditions.clone(), self.length);
        let field = Arc::new(field(&conditions.window, &places, &values));
        ComputedMap { conditions, length, values, field, refused }
    }

    fn at(&self, place: [usize; 2]) -> [f64; 2] {
        coordinates(&self.motions.conditions.window, place)
    }

    /// How many motions one thread follows at a time.
    fn group(&self, system: &System) -> usize {
        let (method, settings) = self.motions.method;
        match self.number {
            MapNumber::FirstCrossing(_) => section_group(system, method, settings),
            MapNumber::AtTheEnd(_) => self.flow(system).group(),
            MapNumber::Exponent => self.motions.exponent_group(system),
        }
    }

    fn numbers(&self, system: &System, starts: Vec<Start>) -> Vec<Result<f64, String>> {
        match self.number {
            MapNumber::Exponent => {
                let found = self.motions.exponents(system, &starts, self.length).into_iter();
                found.map(|found| Ok(found?.unwrap_or(f64::NAN))).collect()
            }
            MapNumber::FirstCrossing(section) => self.first_crossings(system, section, starts),
            MapNumber::AtTheEnd(channel) => self.at_the_end(system, &starts, channel),
        }
    }

    /// How long each motion takes to the section.
    fn first_crossings(
        &self,
        system: &System,
        section: usize,
        starts: Vec<Start>,
    ) -> Vec<Result<f64, String>> {
        let VariedMotions { model, method: (method, settings), .. } = &self.motions;
        // all begin when the file says
        let begun = model.run.start;
        let plan = SectionPlan {
            event: model.event_of_section(section),
            count: Some(1),
            until: Some(begun + self.length),
            idle: u64::MAX,
            all_channels: false,
        };
        let time = |found: Crossings| match (found.rows.first(), found.message) {
            (Some(row), _) => Ok(row[0] - begun),
            (None, Some(why)) => Err(why),
            (None, None) => Ok(f64::NAN),
        };
        let starts = starts.into_iter().map(Ok).collect();
        let found = crossings_of_all(system, method, *settings, starts, &plan);
        found.into_iter().map(time).collect()
    }

    fn at_the_end(
        &self,
        system: &System,
        starts: &[Start],
        channel: usize,
    ) -> Vec<Result<f64, String>> {
        let states: Vec<_> = starts.iter().map(|start| start.state(system)).collect();
        let from: Vec<_> = states
            .iter()
            .zip(starts)
            .map(|(state, start)| (state.as_ref().ok(), &start.parameters[..]))
            .collect();
        // all begin when the file says
        let end = self.motions.model.run.start + self.length;
        let carried = self.flow(system).carry_each(&from, &[end], &[channel]);
        let value = |(carried, start): (&Carried, &Start)| {
            let value = carried.seen.first().and_then(|row| row.first());
            let value = *value.ok_or("the motion cannot be followed to its end")?;
            Ok(varied::within(value, system.period(channel, &start.parameters)))
        };
        let found = carried.iter().zip(starts).map(value);
        let begun = |(found, state): (_, &Result<State, MotionError>)| match state {
            Ok(_) => found,
            Err(why) => Err(ToString::to_string(why)),
        };
        found.zip(&states).map(begun).collect()
    }

    /// The flow of the motions, each of which brings its own parameters.
    fn flow(&self, system: &System) -> SystemFlow {
        SystemFlow {
            system: system.clone(),
            method: self.motions.method,
            parameters: self.motions.model.parameter_values(),
            start: self.motions.model.run.start,
            effort: None,
        }
    }
}

pub(super) fn coordinates(window: &[[f64; 2]], place: [usize; 2]) -> [f64; 2] {
    [0, 1].map(|axis| {
        let [from, to] = window[axis];
        from + (to - from) * (place[axis] as f64 + 0.5) / LATTICE[axis] as f64
    })
}

/// The places of the lattice in the order in which they are taken, each with the distance to its neighbours of the pass.
pub(super) fn places() -> Vec<([usize; 2], usize)> {
    let mut all = Vec::new();
    let mut stride = COARSE;
    while stride > 0 {
        for j in (0..LATTICE[1]).step_by(stride) {
            for i in (0..LATTICE[0]).step_by(stride) {
                let before = stride < COARSE && i % (2 * stride) == 0 && j % (2 * stride) == 0;
                if !before {
                    all.push(([i, j], stride));
                }
            }
        }
        stride /= 2;
    }
    all
}

/// The numbers so far, each over the block that is its own until finer ones are there.
fn field(window: &[[f64; 2]], places: &[([usize; 2], usize)], values: &[f64]) -> Field {
    let [columns, rows] = LATTICE;
    let mut lattice = vec![f64::NAN; columns * rows];
    for (&([i, j], stride), &value) in places.iter().zip(values) {
        for row in j..(j + stride).min(rows) {
            lattice[row * columns..][i..(i + stride).min(columns)].fill(value);
        }
    }
    let mut finite: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    finite.sort_by(f64::total_cmp);
    let (low, most) = (finite.first(), finite.last());
    let high = finite.get((SHADED * finite.len() as f64) as usize).filter(|&x| Some(x) > low);
    let range = [low, high.or(most)].map(|x| x.copied().unwrap_or(0.0));
    let window = [0, 1].map(|axis| window.get(axis).copied().unwrap_or_default());
    Field { window, columns, values: lattice, range }
}
