//! Equilibria of the system in the lab: the search for them, where they are on a plot, and how a motion begins there or
//! along one of their modes.
//!
//! In: a system and its current state. Out: [`FoundEquilibria`], coordinates on plots, initial values. Never here: lists,
//! keys, how the search works ([`equilibria`](crate::dynamics::equilibria)).

use super::mode_amplitude::mode_amplitude;
use super::{Ink, Layer, Level, MarkerShape, Physics, Present};
use crate::dynamics::{
    Equilibrium, EquilibriumKind, PhaseSpace, VirtualWork, equilibria_watched, name_equilibria,
    with_virtual_work,
};
use crate::ensemble::Start;
use crate::expr::Expr;
use crate::job::Progress;
use crate::num::significant;
use crate::system::{ChannelKind, ConstraintProjector, Form, InitialOverride, State};

/// How far a motion along a mode is displaced at most, in the largest coordinate: as an angle, and as a part of its range so far.
const AMPLITUDE: f64 = 0.1;

/// An equilibrium lies on a surface up to this part of what the expression that vanishes there is compared with.
const ON_SURFACE: f64 = 1e-9;

/// The equilibria at certain parameters.
#[derive(Debug)]
pub struct FoundEquilibria {
    /// The equilibria by energy.
    pub found: Vec<Equilibrium>,
    /// The coordinates in which the law is periodic, with the period: of places that differ by it one is found.
    pub periods: Vec<(usize, f64)>,
    /// Those at which the search was made.
    pub parameters: Vec<f64>,
    /// Whether the search came to its end; otherwise there may be more.
    pub is_complete: bool,
}

/// The search around the current state, as the work of a job; its error is a sentence.
pub fn equilibria_search(
    present: &Present<'_>,
) -> impl Fn(&Progress) -> Result<FoundEquilibria, String> + Send + Sync + 'static {
    let Physics { model, equations, system } = present.physics;
    let (model, equations, system) = (model.clone(), equations.clone(), system.clone());
    let start = start(present, present.time);
    move |progress| {
        let system = system.with_cancel(progress.token().clone());
        let space = PhaseSpace::without_impulses((&model, &equations, &system), &start.parameters);
        let space = space.map_err(|why| why.to_string())?;
        let state = start.state(&system).and_then(|state| space.state(&state));
        let state = state.map_err(|error| error.to_string())?;
        let mut report = |done: usize, all: usize| {
            progress.expect(all as u64);
            progress.reach(done as u64);
        };
        let found =
            equilibria_watched(&space, &state, &mut report).map_err(|why| why.to_string())?;
        let (periods, is_complete) = (found.periods, found.is_complete);
        let parameters = start.parameters.clone();
        let mut found = found.found;
        with_virtual_work((&model, &equations), &parameters, &mut found);
        name_equilibria(&model, &parameters, &mut found);
        Ok(FoundEquilibria { found, periods, parameters, is_complete })
    }
}

/// The motion as it is, as one that begins at a time.
pub(super) fn start(present: &Present<'_>, time: f64) -> Start {
    let overrides = given(present.physics, |channel| present.value(channel));
    Start { time, parameters: present.parameters.to_vec(), overrides }
}

/// The coordinates, and the rates that belong to the state, by a value of each channel.
pub(super) fn given(physics: Physics<'_>, value: impl Fn(usize) -> f64) -> Vec<InitialOverride> {
    let form = physics.system.form();
    let channels = physics.system.channels().iter().enumerate();
    let one = |(channel, kind): (usize, ChannelKind)| match kind {
        ChannelKind::Position(i) => Some(InitialOverride::Position(i, value(channel))),
        ChannelKind::Velocity(i) if form == Form::Velocity => {
            Some(InitialOverride::Velocity(i, value(channel)))
        }
        ChannelKind::Momentum(i) if form == Form::Momentum => {
            Some(InitialOverride::Momentum(i, value(channel)))
        }
        _ => None,
    };
    channels.filter_map(|(channel, c)| one((channel, c.kind))).collect()
}

/// The value of a channel at an equilibrium; `None` if it has none there, or is none of the state.
pub fn value_at(physics: Physics<'_>, one: &Equilibrium, channel: usize) -> Option<f64> {
    let n = physics.system.degrees();
    let rate = |i: usize| one.rates.iter().find(|(cyclic, _)| *cyclic == i).map(|(_, rate)| *rate);
    match physics.system.channels().get(channel)?.kind {
        // a cyclic coordinate keeps moving
        ChannelKind::Position(i) if rate(i).is_none() => one.variables.get(i).copied(),
        ChannelKind::Velocity(i) => Some(rate(i).unwrap_or(0.0)),
        ChannelKind::Momentum(i) => one.variables.get(n + i).copied(),
        _ => None,
    }
}

/// The initial values of the motion that stays there.
pub fn start_at(physics: Physics<'_>, one: &Equilibrium) -> Vec<InitialOverride> {
    let n = physics.system.degrees();
    let places = (0..n).map(|i| InitialOverride::Position(i, one.variables[i]));
    if physics.system.constraints() > 0 {
        // constraints are conditions on the velocities
        let rate = |i: usize| one.rates.iter().find(|(cyclic, _)| *cyclic == i);
        let rates = (0..n).map(|i| InitialOverride::Velocity(i, rate(i).map_or(0.0, |r| r.1)));
        return places.chain(rates).collect();
    }
    let momenta = one.variables.iter().enumerate().skip(n);
    places.chain(momenta.map(|(i, &p)| InitialOverride::Momentum(i - n, p))).collect()
}

/// The initial values of a small oscillation in one of its modes: displaced along the mode, with the velocity that it has
/// there.
pub fn start_along(present: &Present<'_>, one: &Equilibrium, mode: usize) -> Vec<InitialOverride> {
    let physics = present.physics;
    let n = physics.system.degrees();
    let Some(mode) = one.modes.get(mode) else { return Vec::new() };
    let size = |i: &f64| i.abs();
    let largest =
        (0..n).max_by(|a, b| size(&mode.in_phase[*a]).total_cmp(&size(&mode.in_phase[*b])));
    let channel = largest.and_then(|i| physics.channel(ChannelKind::Position(i)));
    let range = channel.and_then(|channel| {
        let period = physics.system.period(channel, present.parameters);
        let (lo, hi) = present.bounds.get(channel)?;
        let extent = hi - lo;
        period.map(|period| period / std::f64::consts::TAU).or((extent > 0.0).then_some(extent))
    });
    let wanted = AMPLITUDE * range.unwrap_or(1.0);
    let cyclic = |i: usize| one.rates.iter().find(|(other, _)| *other == i).map(|(_, rate)| *rate);
    // q(t) = a (in phase · cos ωt − quadrature · sin ωt)
    let place = |amplitude: f64, i: usize| one.variables[i] + amplitude * mode.in_phase[i];
    let speed = |amplitude: f64, i: usize| -amplitude * mode.frequency * mode.quadrature[i];
    if let Some(mut projector) = physics.system.projector(present.parameters) {
        let places: Vec<f64> = (0..n).map(|i| place(wanted, i)).collect();
        let speeds: Vec<f64> = (0..n).map(|i| speed(wanted, i)).collect();
        return on_the_surface(&mut projector, present, (&places, &speeds), cyclic);
    }
    let given = |amplitude: f64| -> Vec<InitialOverride> {
        let of_one = |i: usize| {
            let rate = match cyclic(i) {
                Some(_) => InitialOverride::Momentum(i, one.variables[n + i]),
                None => InitialOverride::Velocity(i, speed(amplitude, i)),
            };
            [InitialOverride::Position(i, place(amplitude, i)), rate]
        };
        (0..n).flat_map(of_one).collect()
    };
    given(mode_amplitude(present, one, wanted, given))
}

/// The same where constraints hold the coordinates: a displacement along a tangent is moved onto their surface. Nothing, if
/// that cannot be reached.
fn on_the_surface(
    projector: &mut ConstraintProjector,
    present: &Present<'_>,
    (places, speeds): (&[f64], &[f64]),
    cyclic: impl Fn(usize) -> Option<f64>,
) -> Vec<InitialOverride> {
    let system = present.physics.system;
    let n = system.degrees();
    let mut values = vec![0.0; system.state_len()];
    for i in 0..n {
        values[i] = places[i];
        values[n + i] = cyclic(i).unwrap_or(speeds[i]);
    }
    let mut state = State::new(present.time, Form::Velocity, values);
    if projector.project(&mut state).is_err() {
        return Vec::new();
    }
    let places = (0..n).map(|i| InitialOverride::Position(i, state.values[i]));
    let rates = (0..n).map(|i| InitialOverride::Velocity(i, state.values[n + i]));
    places.chain(rates).collect()
}

/// An equilibrium in words: its kind, where it is, and its frequencies.
pub fn described(physics: Physics<'_>, one: &Equilibrium) -> (String, String) {
    let kind = one.kind.map_or("equilibrium", EquilibriumKind::word);
    let stable = match one.stable {
        None if !one.is_linearly_stable() => "neutral",
        _ => one.stability(),
    };
    let short = |x: f64| significant(x, 4, 1e-4..1e5).replace('-', "−");
    let places = physics.positions().filter_map(|(_, channel)| {
        let value = value_at(physics, one, channel)?;
        let value = part_of_pi(value).unwrap_or_else(|| short(value));
        Some(format!("{} = {value}", physics.shown(channel)))
    });
    let places: Vec<String> = places.collect();
    let modes: Vec<String> = one.modes.iter().map(|mode| short(mode.frequency)).collect();
    let modes =
        if modes.is_empty() { String::new() } else { format!(", ω = {}", modes.join(", ")) };
    let energy = short(one.energy);
    let name = if one.name.is_empty() { String::new() } else { format!("{}: ", one.name) };
    let family = match one.family.len() {
        0 => String::new(),
        dimension => format!(", one of a family of dimension {dimension}"),
    };
    (
        format!("{name}{}: {stable} {kind}{family}", places.join(", ")),
        format!("E = {energy}{modes}"),
    )
}

/// The layers that mark equilibria at their points: a sign by their stability, with the name, or where there are several and this
/// one has none the number in the list.
pub(super) fn marks(
    present: &Present<'_>,
    level: Level,
    point: impl Fn(&Equilibrium) -> Option<[f64; 2]>,
) -> Vec<(Level, Layer)> {
    let mut layers = Vec::new();
    for (index, one) in present.equilibria.iter().enumerate() {
        let Some(at) = point(one) else { continue };
        let (sign, ink) = match one.stable {
            Some(false) => (MarkerShape::Cross, Ink::Separatrix),
            Some(true) => (MarkerShape::Ring, Ink::Curve(2)),
            None => (MarkerShape::Ring, Ink::Plain),
        };
        layers.push((level, Layer::Point(at, sign, ink)));
        let name = match one.name.as_str() {
            "" if present.equilibria.len() > 1 => (index + 1).to_string(),
            name => name.to_owned(),
        };
        layers.push((level, Layer::Name(at, name)));
    }
    layers
}

/// Whether an equilibrium lies on the surface on which an expression of the state, the parameters and the time vanishes: but for
/// rounding, in whatever units. What the expression is compared with is how much it changes where one of the values that it
/// is made of is changed by as much as the motion changed it.
pub(super) fn lies_on(present: &Present<'_>, one: &Equilibrium, when: Expr) -> bool {
    let Physics { model, equations, system } = present.physics;
    let law = (model.as_ref(), equations.as_ref());
    let mut values = present.values.to_vec();
    for (channel, value) in values.iter_mut().enumerate() {
        if let Some(there) = value_at(present.physics, one, channel) {
            *value = there;
        }
    }
    let value = |values: &[f64]| {
        let known = system.valuation(law, present.time, present.parameters, values);
        known.value(&model.pool, when)
    };
    let there = value(&values);
    let mut scale = 0.0_f64;
    for channel in 0..values.len() {
        if value_at(present.physics, one, channel).is_none() {
            continue;
        }
        let (lo, hi) = present.bounds.get(channel).copied().unwrap_or((0.0, 0.0));
        let own = values[channel];
        let reach = lo.abs().max(hi.abs()).max(own.abs());
        // half of it too, as what is periodic may be the same after the whole
        for by in [reach, 0.5 * reach] {
            values[channel] = own + by;
            let change = (value(&values) - there).abs();
            scale = scale.max(if change.is_finite() { change } else { 0.0 });
        }
        values[channel] = own;
    }
    is_on_surface(there, scale)
}

/// Whether a value is zero beside changes of this size.
fn is_on_surface(value: f64, scale: f64) -> bool {
    value.abs() <= ON_SURFACE * scale
}

/// The coordinates in which each stands for others, in words.
pub fn classes(physics: Physics<'_>, periods: &[(usize, f64)]) -> Option<String> {
    let shown = |&(i, _): &(usize, f64)| {
        physics.channel(ChannelKind::Position(i)).map(|channel| physics.shown(channel).to_owned())
    };
    let names: Vec<String> = periods.iter().filter_map(shown).collect();
    (!names.is_empty()).then(|| format!("one per turn of {}", names.join(", ")))
}

/// The coordinate along which a virtual displacement is taken.
pub fn displaced(physics: Physics<'_>, work: &VirtualWork) -> String {
    let channel = physics.channel(ChannelKind::Position(work.coordinate));
    channel.map_or("?", |channel| physics.shown(channel)).to_owned()
}

/// A mode in words: its frequency, and how far each coordinate goes.
pub fn described_mode(physics: Physics<'_>, one: &Equilibrium, mode: usize) -> String {
    let Some(mode) = one.modes.get(mode) else { return String::new() };
    let part = |(i, channel): (usize, usize)| {
        let amplitude = amplitude(mode.in_phase[i], mode.quadrature[i])?;
        Some(format!("{} {amplitude}", physics.shown(channel)))
    };
    let parts: Vec<String> = physics.positions().filter_map(part).collect();
    format!("ω = {}: {}", short(mode.frequency), parts.join(", "))
}

/// The denominators of parts of π, and how near a value is to one that is written so.
const PARTS: [f64; 5] = [1.0, 2.0, 3.0, 4.0, 6.0];
const NEAR: f64 = 1e-9;

/// A value as a part of π, or a few times π, if it is one: `π`, `−π/2`, `2π/3`.
fn part_of_pi(x: f64) -> Option<String> {
    let turns = x / std::f64::consts::PI;
    let is_whole = |part: f64| (turns * part - (turns * part).round()).abs() < NEAR;
    let part = PARTS.into_iter().find(|&part| is_whole(part))?;
    let count = (turns * part).round();
    let sign = if count < 0.0 { "−" } else { "" };
    let times = match count.abs() {
        0.0 => return None,
        1.0 => String::new(),
        times if times <= 12.0 => format!("{times}"),
        _ => return None,
    };
    let below = if part == 1.0 { String::new() } else { format!("/{part}") };
    Some(format!("{sign}{times}π{below}"))
}

fn short(x: f64) -> String {
    significant(x, 3, 1e-3..1e5).replace('-', "−")
}

/// A complex amplitude in words, `None` for zero.
fn amplitude(real: f64, imaginary: f64) -> Option<String> {
    let sign = if imaginary < 0.0 { "−" } else { "+" };
    match (real == 0.0, imaginary == 0.0) {
        (true, true) => None,
        (_, true) => Some(short(real)),
        (true, _) => Some(format!("{}i", short(imaginary))),
        _ => Some(format!("{} {sign} {}i", short(real), short(imaginary.abs()))),
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::{amplitude, is_on_surface, part_of_pi};

    #[test]
    fn an_equilibrium_is_on_a_surface_to_a_billionth_of_what_moves() {
        for size in [1e-30, 1.0, 1e30] {
            assert!(is_on_surface(-0.9e-9 * size, size) && !is_on_surface(1.1e-9 * size, size));
        }
        assert!(is_on_surface(0.0, 0.0));
    }

    #[test]
    fn parts_of_pi_are_written_so_and_nothing_else_is() {
        for (x, shown) in [
            (PI, "π"),
            (-PI, "−π"),
            (2.0 * PI, "2π"),
            (PI / 2.0, "π/2"),
            (-2.0 * PI / 3.0, "−2π/3"),
            (5.0 * PI / 6.0, "5π/6"),
        ] {
            assert_eq!(part_of_pi(x).as_deref(), Some(shown));
        }
        for x in [0.0, 1.0, 3.1, PI + 1e-6, 100.0 * PI, PI / 5.0, f64::NAN, f64::INFINITY] {
            assert_eq!(part_of_pi(x), None, "{x}");
        }
    }

    #[test]
    fn an_amplitude_has_one_sign_before_its_imaginary_part() {
        let shown = |re: f64, im: f64| amplitude(re, im).unwrap_or_default();
        assert_eq!(shown(0.423, -0.461), "0.423 − 0.461i");
        assert_eq!(shown(-0.423, 0.461), "−0.423 + 0.461i");
        assert_eq!([shown(0.0, -0.5), shown(-1.0, 0.0), shown(0.0, 0.0)], ["−0.5i", "−1", ""]);
    }
}
