//! The motion of the start: its place, its energy, the region in which it lies.
//!
//! In: a compiled system. Out: the same as numbers, the region among those of an energy. Never here: actions.

use crate::action_angle::AllowedInterval;
use crate::cli::motion_options::CompiledMotion;
use crate::ensemble::Root;
use crate::system::ChannelKind;

/// Where the coordinate is at the start, the energy there, and which way it goes.
pub(super) struct Own {
    pub(super) place: f64,
    pub(super) energy: f64,
    pub(super) way: Root,
}

pub(super) fn own_start(compiled: &CompiledMotion, index: usize) -> Result<Own, String> {
    let state = compiled.start.state(&compiled.system).map_err(|why| why.to_string())?;
    let mut values = vec![0.0; compiled.system.columns()];
    let mut observer = compiled.system.observer(&compiled.start.parameters);
    observer.observe_columns(&state, &mut values).map_err(|why| why.to_string())?;
    let value = |kind| {
        let place = compiled.system.channels().iter().position(|c| c.kind == kind);
        place.map_or(f64::NAN, |place| values[place])
    };
    let place = value(ChannelKind::Position(index));
    let is_backward = value(ChannelKind::Velocity(index)) < 0.0;
    let way = if is_backward { Root::Negative } else { Root::Positive };
    Ok(Own { place, energy: value(ChannelKind::Energy), way })
}

/// The region that a place lies in; a start at rest lies on its edge.
pub(super) fn containing(
    regions: &[AllowedInterval],
    place: f64,
    period: Option<f64>,
) -> Vec<AllowedInterval> {
    let distance = |region: &AllowedInterval| {
        let at = |place: f64| {
            let left = region.left.map_or(0.0, |left| left - place);
            let right = region.right.map_or(0.0, |right| place - right);
            left.max(right).max(0.0)
        };
        let turns = period.map_or(vec![0.0], |period| vec![-period, 0.0, period]);
        turns.into_iter().map(|turn| at(place + turn)).fold(f64::INFINITY, f64::min)
    };
    regions.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).copied().into_iter().collect()
}
