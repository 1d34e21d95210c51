//! The numbers of a section that scripts may claim.
//!
//! In: a plot with its present and its portrait. Out: one number each. Never here: how they are computed.

use super::periodic;
use super::portrait::Portrait;
use super::regularity::own_rotation;
use super::surface::view;
use crate::instrument::{Measure, PlotContext};

pub(super) const MEASURES: [Measure; 9] = [
    Measure::new(
        "points",
        "how often the running motion has crossed the surface",
        |PlotContext { plot, present, .. }| {
            let section = view(plot, present.physics)?.section?;
            present.crossings.counts().get(section).map(|count| *count as f64)
        },
    ),
    Measure::new(
        "own_rotation",
        "the rotation number of the running motion",
        |PlotContext { plot, present, .. }| {
            let section = view(plot, present.physics)?.section?;
            own_rotation(plot, present, section).map(|found| found.number)
        },
    ),
    Measure::new("orbits", "how many other orbits are drawn", |context| {
        Portrait::of(context.answer).map(|p| p.orbits.len() as f64)
    }),
    Measure::new("crossings", "how many crossings of other orbits are drawn", |context| {
        Portrait::of(context.answer).map(|drawn| drawn.crossings() as f64)
    }),
    Measure::new("rotating", "how many of them have a rotation number", |context| {
        let rotating = Portrait::of(context.answer)?.orbits.iter().filter(|o| o.rotation.is_ok());
        Some(rotating.count() as f64)
    }),
    Measure::new(
        "regular",
        "how many of them are regular: those, and crescents that do not go round their middle",
        |context| {
            let orbits = Portrait::of(context.answer)?.orbits.iter();
            Some(orbits.filter(|orbit| orbit.regular() == Some(true)).count() as f64)
        },
    ),
    Measure::new(
        "chaotic",
        "how many of them have none, as their average turn differs as that of random numbers does",
        |context| {
            let orbits = Portrait::of(context.answer)?.orbits.iter();
            Some(orbits.filter(|orbit| orbit.regular() == Some(false)).count() as f64)
        },
    ),
    Measure::new(
        "periodic",
        "how many points of periodic orbits are marked",
        |PlotContext { plot, present, .. }| {
            let section = view(plot, present.physics)?.section?;
            let channels = [plot.column(0)?, plot.column(1)?];
            let orbits = periodic::points(present, section, channels);
            Some(orbits.map(|(_, points)| points.len()).sum::<usize>() as f64)
        },
    ),
    Measure::new("rotation", "the rotation number of the newest of them", |context| {
        let newest = Portrait::of(context.answer)?.orbits.last()?.rotation.as_ref().ok();
        newest.map(|rotation| rotation.number)
    }),
];
