//! What can be measured on an orbit beside its end: one row of a table for each measure.
//!
//! In: orbits from their starts to an end in time, and an expression where the measure takes one. Out: a number for each; NaN
//! where an orbit has none. A new measure is a constant below and a line in [`MEASURES`]; what it needs of the system beyond
//! the equations of motion, it does with the [`System`] that it is handed. Never here: tables, names of columns.

use crate::dynamics::{LyapunovOrbit, PhaseSpace, lyapunov_of_all};
use crate::ensemble::{Crossings, OrbitStatus, SectionPlan, Start, crossings_of_all};
use crate::integrate::{Method, Settings};
use crate::mechanics::Equations;
use crate::model::Model;
use crate::system::System;

/// A number that is taken of an orbit, as a row of the table.
pub struct OrbitMeasure {
    /// Its name on the command line.
    pub name: &'static str,
    /// What it is, in a sentence.
    pub about: &'static str,
    /// The expression whose zeros it locates.
    pub of: Zeros,
    /// Measures orbits, several of them side by side where that is possible; `None` for one that was cancelled.
    pub measure: fn(&MeasuredOrbits<'_>) -> Vec<Option<f64>>,
}

/// The expression whose rising zeros a measure locates.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Zeros {
    /// One that the user gives.
    Given,
    /// The first velocity with its sign changed, so that the zeros are maxima of the first coordinate, unless the user
    /// gives another.
    Maxima,
    /// None: it follows the orbit itself.
    None,
}

/// What a measure is given: a system, and where each orbit begins and ends.
pub struct MeasuredOrbits<'a> {
    /// The model.
    pub model: &'a Model,
    /// What was derived from the model.
    pub equations: &'a Equations,
    /// The system, with the measure's zeros as an event.
    pub system: &'a System,
    /// The event's index, if it counts zeros.
    pub event: Option<usize>,
    /// By which orbits are integrated.
    pub method: &'static Method,
    /// Those of the method.
    pub settings: Settings,
    /// Where each orbit begins, and the time at which it ends.
    pub orbits: &'a [(&'a Start, f64)],
}

impl MeasuredOrbits<'_> {
    /// A number of the zeros on each orbit, at most `count`, up to its end or to an error.
    fn of_zeros(&self, count: Option<u64>, number: fn(&Crossings) -> f64) -> Vec<Option<f64>> {
        let Some(event) = self.event else { return vec![Some(f64::NAN); self.orbits.len()] };
        let together = |orbits: &[(&Start, f64)]| {
            let plan = SectionPlan {
                event,
                count,
                until: Some(orbits[0].1),
                idle: u64::MAX,
                all_channels: false,
            };
            let starts = orbits.iter().map(|&(start, _)| Ok(start.clone())).collect();
            crossings_of_all(self.system, self.method, self.settings, starts, &plan)
        };
        // those that end at one time
        let groups = self.orbits.chunk_by(|(_, a), (_, b)| a == b);
        let found: Vec<Crossings> = groups.flat_map(together).collect();
        let cancelled = self.system.cancel().is_cancelled();
        found.iter().map(|found| (!cancelled).then(|| number(found))).collect()
    }

    /// An orbit in its phase space, if it can begin there.
    fn in_phase_space(&self, (start, until): (&Start, f64)) -> Option<LyapunovOrbit> {
        let parameters = &start.parameters;
        let space =
            PhaseSpace::on_constraints((self.model, self.equations, self.system), parameters)
                .ok()?;
        let start = start.state(self.system).and_then(|state| space.state(&state)).ok()?;
        Some(LyapunovOrbit { space, start, until })
    }

    /// The largest Lyapunov exponent of each orbit up to its end; NaN where it has none or does not reach it.
    fn exponents(&self) -> Vec<f64> {
        let mut exponents = vec![f64::NAN; self.orbits.len()];
        let begun = self.orbits.iter().enumerate();
        let begun = begun.filter_map(|(i, &orbit)| Some((i, self.in_phase_space(orbit)?)));
        let (places, orbits): (Vec<usize>, Vec<LyapunovOrbit>) = begun.unzip();
        let found = lyapunov_of_all(&orbits, (self.method, self.settings));
        for (place, found) in places.into_iter().zip(found) {
            let reached = found.ok().filter(|found| found.error.is_none());
            if let Some(&largest) = reached.as_ref().and_then(|found| found.exponents.first()) {
                exponents[place] = largest;
            }
        }
        exponents
    }
}

/// All rows, in the order of lists.
pub const MEASURES: &[OrbitMeasure] = &[PERIOD, ESCAPE, CROSSINGS, LYAPUNOV];

/// Finds a row by the word that a person writes.
pub fn measure_named(name: &str) -> Option<&'static OrbitMeasure> {
    MEASURES.iter().find(|measure| measure.name == name)
}

const PERIOD: OrbitMeasure = OrbitMeasure {
    name: "period",
    about: "the mean time between maxima of the first coordinate, or with =EXPR between upward zeros of an expression; empty where there are fewer than two",
    of: Zeros::Maxima,
    measure: |orbits| {
        orbits.of_zeros(None, |found| match (found.rows.first(), found.rows.last()) {
            (Some(first), Some(last)) if found.rows.len() > 1 => {
                (last[0] - first[0]) / (found.rows.len() - 1) as f64
            }
            _ => f64::NAN,
        })
    },
};

const ESCAPE: OrbitMeasure = OrbitMeasure {
    name: "escape",
    about: "the first time at which EXPR of escape=EXPR rises through zero; empty where it does not",
    of: Zeros::Given,
    measure: |orbits| {
        orbits.of_zeros(Some(1), |found| found.rows.first().map_or(f64::NAN, |row| row[0]))
    },
};

const CROSSINGS: OrbitMeasure = OrbitMeasure {
    name: "crossings",
    about: "how often EXPR of crossings=EXPR rises through zero",
    of: Zeros::Given,
    measure: |orbits| {
        orbits.of_zeros(None, |found| {
            let begun = found.status != OrbitStatus::Refused;
            if begun { found.rows.len() as f64 } else { f64::NAN }
        })
    },
};

const LYAPUNOV: OrbitMeasure = OrbitMeasure {
    name: "lyapunov",
    about: "the largest Lyapunov exponent over the time of the run; empty where the orbit cannot be followed to its end",
    of: Zeros::None,
    measure: |orbits| {
        let found = orbits.exponents();
        let cancelled = orbits.system.cancel().is_cancelled();
        // an orbit that was over before has its own
        let is_known = |exponent: &f64| !(cancelled && exponent.is_nan());
        found.into_iter().map(|exponent| Some(exponent).filter(is_known)).collect()
    },
};
