//! What a motion is, near which no periodic orbit was found: chaotic, or on a torus with frequencies that have no common period.
//!
//! In: the state at which the search began. Out: a sentence. Never here: how an orbit is searched for.

use nalgebra::DMatrix;

use super::carrier::Carrier;
use super::chaos::Chaos;
use super::error::DynamicsError;
use super::lyapunov::lyapunov;
use super::phase_space::PhaseSpace;
use super::torus::{Signal, Torus};
use crate::integrate::{Method, Settings, Stepping};
use crate::system::{Form, State};

/// The steps over which the motion is followed, of a series and of a fixed size, and the periods of a drive.
const STEPS: u64 = 1500;
const STEPS_FIXED: u64 = 40_000;
const PERIODS: u32 = 1024;

/// Under a drive so many times as many steps, and a motion is analysed only over so many periods at least.
const DRIVEN: u64 = 8;
const FEWEST: u32 = 128;

/// A number of periods that lacks less than this of a whole one is one.
const WHOLE: f64 = 1e-6;

/// The work of finding out what a motion is, of which the exponents take this part.
const WORK: u64 = 100;
const PART: u64 = 90;

/// The number of samples over them.
const SAMPLES: u32 = 4096;

/// A time later than the end of any step.
const ENDLESS: f64 = 1e150;

/// The most frequencies that are searched for.
const FREQUENCIES: usize = 3;

/// Is given how much of the work is done, of how much.
type ProgressReport<'a> = &'a mut dyn FnMut(u64, u64);

/// Adds to an error of a search for a periodic orbit what the motion from the start is instead, where that can be known;
/// other errors are returned unchanged. `report` is given the work done and the total.
pub fn explained(
    error: DynamicsError,
    space: &PhaseSpace,
    method: (&'static Method, Settings),
    start: &State,
    report: ProgressReport<'_>,
) -> DynamicsError {
    let DynamicsError::Unclosed(why) = error else { return error };
    match character(space, method, start, report) {
        Err(error) if error.is_cancelled() => error,
        Ok(Some(character)) => {
            DynamicsError::Unsuited(format!("{why}. The motion from there {character}"))
        }
        // what cannot be followed further says nothing of it
        Ok(None) | Err(_) => DynamicsError::Unsuited(why),
    }
}

/// What the motion from a state is; nothing if it cannot be followed.
fn character(
    space: &PhaseSpace,
    method: (&'static Method, Settings),
    start: &State,
    report: ProgressReport<'_>,
) -> Result<Option<String>, DynamicsError> {
    let drive = if space.is_autonomous() { None } else { space.drive() };
    let Some((end, count)) = end(space, method, start, drive)? else { return Ok(None) };
    report(1, WORK);
    let part = |time: f64| (PART as f64 * (time - start.time) / (end - start.time)) as u64;
    let found = lyapunov(space, method, start, end, &mut |time| report(1 + part(time), WORK))?;
    if let Some(error) = found.error {
        return if error.is_cancelled() { Err(error) } else { Ok(None) };
    }
    let reason = &found.reason;
    Ok(Some(match found.verdict {
        Chaos::Chaotic => format!("is chaotic: {reason}"),
        Chaos::Unstable => format!("is unstable: {reason}"),
        Chaos::Undecided => format!("may be regular or chaotic, which is undecided: {reason}"),
        Chaos::Regular => match torus(space, method, (start, end, count), drive)? {
            Some(torus) => torus.sentence(),
            None => format!("is regular: {reason}"),
        },
    }))
}

/// The time until which the motion is followed, and the number of samples until then; nothing if it ends before. Under a drive
/// it is a number of its periods, as many as there are steps for.
fn end(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    start: &State,
    drive: Option<f64>,
) -> Result<Option<(f64, u32)>, DynamicsError> {
    let mut carrier = Carrier::new(space, method, settings, 0)?;
    carrier.start(start, &DMatrix::zeros(space.dimension(), 0))?;
    let steps = if method.stepping == Stepping::Fixed { STEPS_FIXED } else { STEPS };
    let steps = if drive.is_some() { DRIVEN * steps } else { steps };
    let last = drive.map_or(ENDLESS, |drive| start.time + f64::from(PERIODS) * drive);
    for _ in 0..steps {
        if carrier.time() >= last {
            break;
        }
        if let Err(error) = carrier.step(last) {
            let error = DynamicsError::from(error);
            return if error.is_cancelled() { Err(error) } else { Ok(None) };
        }
    }
    let end = carrier.time();
    Ok(match drive {
        Some(drive) => {
            let count = ((end - start.time) / drive + WHOLE).floor() as u32;
            (count >= FEWEST).then(|| (start.time + f64::from(count) * drive, count))
        }
        None => (end < ENDLESS).then_some((end, SAMPLES)),
    })
}

/// The torus on which a regular motion of a conservative system lies, if its frequencies are found.
fn torus(
    space: &PhaseSpace,
    method: (&'static Method, Settings),
    (start, end, count): (&State, f64, u32),
    drive: Option<f64>,
) -> Result<Option<Torus>, DynamicsError> {
    let (_, dimension) = space.allowed_displacements(start)?;
    let degrees = dimension / 2;
    let conserves = space.is_conservative() || drive.is_some() && space.is_hamiltonian();
    if !conserves || space.form() == Form::Variables || !(1..=FREQUENCIES).contains(&degrees) {
        return Ok(None);
    }
    let spacing = (end - start.time) / f64::from(count);
    let mut signals: Vec<Signal> = (space.periods().iter().take(space.dimension() / 2))
        .map(|turn| Signal { values: Vec::new(), turn: *turn })
        .collect();
    let mut carrier = Carrier::new(space, method.0, method.1, 0)?;
    carrier.start(start, &DMatrix::zeros(space.dimension(), 0))?;
    // between the times of impulses, which are multiples of the period of their drive
    let mut times = (0..count).map(|k| start.time + (f64::from(k) + 0.5) * spacing).peekable();
    while times.peek().is_some() {
        carrier.step(end)?;
        let (_, reached) = carrier.interval();
        while let Some(time) = times.next_if(|time| *time <= reached) {
            let (state, _) = carrier.at(time)?;
            for (signal, x) in signals.iter_mut().zip(space.variables(&state)) {
                signal.values.push(*x);
            }
        }
    }
    Ok(Torus::of(&signals, spacing, degrees, drive.map(|period| std::f64::consts::TAU / period)))
}
