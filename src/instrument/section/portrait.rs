//! The orbits of a section: those at first, their starts spread over what the energy allows, and those of each addition.
//!
//! In: a plane of section, what is there already. Out: a portrait, a part of it at a time. Never here: what is drawn of it.

use std::ops::{ControlFlow, Range};
use std::sync::Arc;

use crate::dynamics::{NoRotation, Rotation, rotation};
use crate::ensemble::{
    Crossings, PhaseShift, Region, SectionPlan, SectionPlane, Start, crossings, crossings_of_all,
    in_order, section_group, spread,
};
use crate::instrument::{Answer, MOST_SEEDS, PlotTable, Present, Seed};
use crate::integrate::{Method, Settings};
use crate::job::Progress;
use crate::mechanics::Equations;
use crate::model::Model;
use crate::system::{ChannelKind, System};

/// The orbits of a picture at first and those of each addition, and the crossings of each.
const BATCH: usize = 16;
pub(super) const COUNT: u64 = 120;

/// The orbits of an addition that fills the section, and the crossings of each.
const FILL: usize = 100;
const COUNT_FILLING: u64 = 100;

/// The orbits of one part of the work, after which the picture is drawn anew: a share of all, and these at least.
const SHARE: usize = 5;
const PART: usize = 16;

/// The crossings of an orbit through a point that a person chose.
const COUNT_CHOSEN: u64 = 240;

/// The crossings that are left out where friction draws all orbits to an attractor.
pub(super) const TRANSIENT: usize = 20;

/// How many points are tried for each start that is found.
const TRIES: usize = 24;

/// An orbit ends after so many steps without a crossing.
pub(super) const IDLE: u64 = 4000;

/// The relative change of the energy beyond which the other orbits are computed again.
const DRIFT: f64 = 1e-3;

/// The orbits computed so far, and the conditions they were computed for.
pub(super) struct Portrait {
    pub(super) conditions: SectionConditions,
    /// The additions whose orbits are there, and those at first.
    pub(super) seeds: Vec<Seed>,
    pub(super) region: Region,
    pub(super) orbits: Vec<DrawnOrbit>,
    /// The starts of the orbits to come, and the crossings of each.
    pub(super) pending: (Vec<[f64; 2]>, u64),
}

impl Portrait {
    pub(super) fn of(answer: Option<&Answer>) -> Option<&Portrait> {
        answer?.of::<Portrait>()
    }

    pub(super) fn crossings(&self) -> usize {
        self.orbits.iter().map(|orbit| orbit.points.len()).sum()
    }

    /// A row for each point: the number of its orbit, from 1 on, and its place.
    pub(super) fn table(&self, [x, y]: [String; 2]) -> PlotTable {
        let row = |index: usize, at: &[f64; 2]| vec![(index + 1) as f64, at[0], at[1]];
        let orbits = self.orbits.iter().enumerate();
        let rows = orbits
            .flat_map(|(index, orbit)| orbit.points.iter().map(move |at| row(index, at)))
            .collect();
        PlotTable { columns: vec!["orbit".to_owned(), x, y], counts: 1, rows }
    }
}

/// The points of an orbit, and its rotation number.
#[derive(Clone)]
pub(super) struct DrawnOrbit {
    pub(super) points: Arc<Vec<[f64; 2]>>,
    pub(super) rotation: Result<Rotation, NoRotation>,
}

impl DrawnOrbit {
    /// Whether its average turn converges, to a rotation number or to whole turns; `None` if its crossings do not tell.
    pub(super) fn regular(&self) -> Option<bool> {
        match self.rotation {
            // crescents, as in a resonance, do not go round their middle, but averages along them converge
            Ok(_) | Err(NoRotation::NotAround | NoRotation::NotEnclosing) => Some(true),
            Err(NoRotation::AllTurns | NoRotation::Diverges(_)) => Some(false),
            Err(_) => None,
        }
    }
}

#[derive(Clone, PartialEq, Debug)]
pub(super) struct SectionConditions {
    pub(super) parameters: Vec<f64>,
    pub(super) energy: f64,
    pub(super) method: &'static str,
    pub(super) settings: Settings,
}

impl SectionConditions {
    pub(super) fn of(present: &Present<'_>) -> Self {
        let kind = ChannelKind::Energy;
        let energy = present.physics.channel(kind).map_or(f64::NAN, |c| present.value(c));
        Self {
            parameters: present.parameters.to_vec(),
            energy,
            method: present.method,
            settings: present.settings,
        }
    }

    /// Whether orbits of this energy are on the same section.
    pub(super) fn is_near(&self, energy: f64) -> bool {
        (self.energy - energy).abs() <= DRIFT * self.energy.abs().max(1e-9)
    }

    /// Whether the orbits of one are those of the other. Where the plane has no bound the energy does not matter.
    pub(super) fn are_unchanged(&self, now: &Self, bounded: bool) -> bool {
        let near = !bounded || self.is_near(now.energy);
        near && (&self.parameters, self.method, self.settings)
            == (&now.parameters, now.method, now.settings)
    }
}

/// What a job computes: the orbits of a picture at first, or those of its next addition.
pub(super) struct SectionTask {
    pub(super) plane: SectionPlane,
    /// The law by which a stroboscope's points are carried back to the phase of the initial values.
    pub(super) law: (Arc<Model>, Arc<Equations>),
    pub(super) system: Arc<System>,
    pub(super) method: &'static Method,
    pub(super) conditions: SectionConditions,
    pub(super) plan: SectionPlan,
    pub(super) columns: [usize; 2],
    pub(super) transient: usize,
    pub(super) known: Option<StartedPortrait>,
    pub(super) given: [Option<[f64; 2]>; 2],
    /// The initial values of the motion, and the range of each axis that it has reached so far.
    pub(super) own: Start,
    pub(super) around: [[f64; 2]; 2],
    pub(super) seed: Option<Seed>,
    pub(super) seeds: Vec<Seed>,
}

pub(super) struct StartedPortrait {
    pub(super) region: Region,
    pub(super) orbits: Vec<DrawnOrbit>,
    pub(super) pending: (Vec<[f64; 2]>, u64),
}

impl SectionTask {
    pub(super) fn portrait(&self, progress: &Progress) -> Portrait {
        let system = self.system.with_cancel(progress.token().clone());
        let begun = self.known.as_ref();
        let region = begun.map_or_else(
            || Region::of(&self.plane, &system, self.given, self.reach(&system), progress.token()),
            |begun| begun.region.clone(),
        );
        let mut orbits = begun.map_or_else(Vec::new, |begun| begun.orbits.clone());
        let (mut points, count) = match (self.seed, begun) {
            // each addition continues where the one before ended
            (Some(Seed::Spread(window)), _) => {
                let places = Self::places(BATCH, self.seeds.len());
                (self.starts(&system, &region, window, places), COUNT)
            }
            (Some(Seed::Fill(window)), _) => {
                let places = Self::places(FILL, self.seeds.len());
                (self.starts(&system, &region, window, places), COUNT_FILLING)
            }
            (Some(Seed::Through(point)), _) => (vec![point], COUNT_CHOSEN),
            (None, Some(begun)) => begun.pending.clone(),
            (Some(Seed::Shell), _) | (None, None) => {
                (self.starts(&system, &region, region.window, Self::places(BATCH, 0)), COUNT)
            }
        };
        let part = PART.max(if count == COUNT_FILLING { FILL / SHARE } else { 0 });
        let pending = (points.split_off(points.len().min(part)), count);
        let plan = SectionPlan { count: Some(count), ..self.plan.clone() };
        progress.expect(points.len() as u64);
        let shift = points.first().and_then(|&at| self.shift(&system, at));
        let settings = self.method.fast(self.conditions.settings);
        let size = section_group(&system, self.method, settings);
        let groups: Vec<&[[f64; 2]]> = points.chunks(size).collect();
        let group = |i: usize| {
            let mut observer = system.observer(self.plane.parameters());
            let mut start = |&at: &[f64; 2]| {
                let through = self.plane.through(&system, &mut observer, (at, shift.as_ref()));
                through.map_err(|why| Crossings::refused(&why))
            };
            let starts = groups[i].iter().map(&mut start).collect();
            let found = crossings_of_all(&system, self.method, settings, starts, &plan);
            let drawn = |(found, &at)| self.drawn(&found, at);
            found.into_iter().zip(groups[i]).map(drawn).collect()
        };
        let mut done = 0;
        let take = |_, group: Vec<Vec<[f64; 2]>>| {
            done += group.len() as u64;
            progress.reach(done);
            // an orbit that never comes back is no part of a section
            for orbit in group.into_iter().filter(|orbit| orbit.len() > 1) {
                let periods = self.columns.map(|c| system.period(c, self.plane.parameters()));
                let rotation = rotation(&orbit, periods);
                orbits.push(DrawnOrbit { points: Arc::new(orbit), rotation });
            }
            ControlFlow::Continue(())
        };
        // without threads the picture has no further orbits
        let _ = in_order(0, groups.len(), progress.token(), group, take);
        let seeds = self.seeds.clone();
        Portrait { conditions: self.conditions.clone(), seeds, region, orbits, pending }
    }

    /// How far the motion comes on the section: where nothing bounds that, it is followed as far as the orbits beside it, since
    /// it may have only begun.
    fn reach(&self, system: &System) -> [[f64; 2]; 2] {
        let mut reach = self.around;
        if self.plane.is_bounded() || self.given.iter().all(Option::is_some) {
            return reach;
        }
        let settings = self.method.fast(self.conditions.settings);
        let found = crossings(system, self.method, settings, &self.own, &self.plan);
        for row in found.rows.iter().skip(self.transient) {
            for (ends, column) in reach.iter_mut().zip(self.columns) {
                // a range that is not known yet is NaN, which these leave out
                *ends = [ends[0].min(row[1 + column]), ends[1].max(row[1 + column])];
            }
        }
        reach
    }

    /// The flow from the phase of the points to that of the initial values, where the two differ.
    fn shift(&self, system: &System, at: [f64; 2]) -> Option<PhaseShift> {
        if !self.plane.is_at_another_phase() {
            return None;
        }
        let mut observer = system.observer(self.plane.parameters());
        let start = self.plane.start(system, &mut observer, at).ok()?;
        let backwards = system.reversed(&self.law.0, &self.law.1).ok()?;
        let method = (self.method, self.conditions.settings);
        PhaseShift::new((system, backwards), method, &start, self.plan.event).ok()
    }

    /// The number of starts that an addition has, and where they are tried, apart from those of additions before.
    fn places(count: usize, before: usize) -> (usize, Range<usize>) {
        let first = if count == FILL { MOST_SEEDS * BATCH * TRIES } else { 0 };
        let from = first + before * count * TRIES;
        (count, from..from + count * TRIES)
    }

    fn starts(
        &self,
        system: &System,
        region: &Region,
        window: [[f64; 2]; 2],
        (count, places): (usize, Range<usize>),
    ) -> Vec<[f64; 2]> {
        let mut observer = system.observer(self.plane.parameters());
        let points = places.map(|index| spread(index, window));
        points
            .filter(|&at| {
                region.contains(at) && self.plane.start(system, &mut observer, at).is_ok()
            })
            .take(count)
            .collect()
    }

    /// The points of an orbit: its start, if that is a crossing, and its crossings.
    fn drawn(&self, found: &Crossings, start: [f64; 2]) -> Vec<[f64; 2]> {
        let [x, y] = self.columns;
        let first = (self.plane.is_bounded()).then_some(start);
        let crossed =
            found.rows.iter().filter_map(|row| Some([*row.get(1 + x)?, *row.get(1 + y)?]));
        first.into_iter().chain(crossed).skip(self.transient).collect()
    }
}
