//! The Lyapunov exponents of a motion.
//!
//! Tangent vectors are carried along and made orthonormal again and again; the logarithms of their
//! growth add up (G. Benettin et al., Meccanica 15 (1980) 9). The direction of the motion, and where
//! H is conserved that of the energy, are taken out: their exponents are zero, and left in they
//! hide the pairing λᵢ = −λ₂ₙ₊₁₋ᵢ. What is left is carried in symplectic frames, in which pairs hold
//! at every time.
//!
//! In: a state, a time. Out: exponents with their uncertainty, MEGNO, a verdict with its reason.
//! Never here: text.

use nalgebra::{DMatrix, DVector};

use super::carrier::Carrier;
use super::direction::{FlowDirection, basis_of_range};
use super::error::DynamicsError;
use super::megno::Megno;
use super::phase_space::{NOTHING_MOVES, PhaseSpace};
use super::tangent_growth::TangentGrowth;
use super::transverse::{self, Removed};
use crate::integrate::{Method, Settings};
use crate::num::{math, short};
use crate::system::{Form, State};

/// Vectors are made orthonormal where one has grown or shrunk by this factor, …
const GROWN: f64 = 8.0;

/// … and at least so often on the way.
const LEAST_ROUNDS: f64 = 256.0;

/// The points of the curve.
const POINTS: usize = 200;

/// A verdict needs this many steps of a series, or ten times as many of fixed size.
const STEPS: u64 = 120;

/// MEGNO up to which a motion is regular, and from which it is chaotic.
const REGULAR: f64 = 2.8;
const CHAOTIC: f64 = 5.0;

/// Beyond the first, MEGNO of regular motion has not grown by the second since half of the time; of chaotic motion it doubles.
const SETTLED: f64 = 2.2;
const RISING: f64 = 1.5;

/// A chaotic motion has grown by this many powers of e.
const GROWTH: f64 = 8.0;

/// A momentum over its displacement that differs from 1 by no more than this factor needs no units.
const ORDINARY: f64 = 1e3;

/// Whether neighbouring motions part exponentially.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Chaos {
    /// They do not.
    Regular,
    /// They do.
    Chaotic,
    /// It cannot be decided.
    Undecided,
}

/// The exponents of a motion.
#[derive(Clone, Debug)]
pub struct Lyapunov {
    /// The time reached.
    pub time: f64,
    /// All exponents, the largest first.
    pub exponents: Vec<f64>,
    /// Their uncertainties.
    pub uncertainty: Vec<f64>,
    /// Whether the mean rate of each has settled; where it has not, the uncertainty is a lower bound.
    pub settled: Vec<bool>,
    /// Which directions were taken out; their exponents are zero.
    pub removed: Removed,
    /// MEGNO, averaged over the time.
    pub megno: f64,
    /// The verdict.
    pub verdict: Chaos,
    /// Its reason.
    pub reason: String,
    /// The sum of all exponents: the mean divergence.
    pub sum: f64,
    /// The largest |λᵢ + λ₂ₙ₊₁₋ᵢ|; `None` where pairs are not expected.
    pub pairing_residual: Option<f64>,
    /// The plain mean of the largest exponent up to a time.
    pub curve: Vec<(f64, f64)>,
    /// The step or tolerance used.
    pub settings: Settings,
    /// Why the motion ended early.
    pub failure: Option<DynamicsError>,
}

/// Follows a motion from a state of the space until a time, and `look`s on after each step.
///
/// # Errors
/// Returns an error if the motion cannot begin, or is too short for any exponent. If it cannot
/// continue, or is cancelled, the result is that of the time reached.
pub fn lyapunov(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    start: &State,
    until: f64,
    look: &mut dyn FnMut(f64),
) -> Result<Lyapunov, DynamicsError> {
    if until <= start.time {
        return Err(DynamicsError::WrongRequest(
            "exponents are means over the time to come: the end lies after the start".to_owned(),
        ));
    }
    let n = space.dimension();
    let mut direction = FlowDirection::new(space);
    let what = removed(space, direction.moves(start, until - start.time)?);
    let units = displacement_units(space, start, until - start.time);
    let rates = direction.at(start)?.component_div(&units);
    let (allowed, dimension) = space.allowed_displacements(start)?;
    if dimension == 0 {
        return Err(DynamicsError::Unsuited(NOTHING_MOVES.to_owned()));
    }
    let frame = if space.is_constrained() {
        transverse::frame_within(&basis_of_range(&allowed, dimension), &rates, what)
    } else {
        transverse::frame(&rates, what, space.is_hamiltonian())
    };
    let count = frame.ncols();
    // one more vector, in general position, that is never turned: for MEGNO
    let free = DVector::from_fn(n, |i, _| 0.5 + math::sin(2.4 * (i as f64 + 1.0)).abs());
    let free = allowed * free;
    let mut vectors = frame.insert_column(count, 0.0);
    vectors.set_column(count, &free.normalize());
    let mut carrier = Carrier::new(space, method, settings, count + 1)?;
    carrier.start(start, &scaled(&vectors, &units))?;
    let in_units = units.map(|unit| 1.0 / unit);

    let mut growth = TangentGrowth { times: vec![start.time], logarithms: vec![vec![0.0; count]] };
    let mut megno = Megno::new(start.time);
    let mut failure = None;
    let round = (until - start.time) / LEAST_ROUNDS;
    while carrier.is_before(until, true) {
        if let Err(fault) = carrier.step(until) {
            failure = Some(DynamicsError::Motion(fault));
            break;
        }
        let (begin, end) = carrier.interval();
        for part in 1..=MEGNO_PARTS {
            let now = begin + (end - begin) * f64::from(part) / f64::from(MEGNO_PARTS);
            let (_, vectors) = carrier.at(now)?;
            megno.add(now, math::ln(vectors.column(count).component_mul(&in_units).norm()));
        }
        let (state, vectors) = carrier.at(end)?;
        let mut vectors = scaled(&vectors, &in_units);
        look(end);
        let due = end - growth.times[growth.times.len() - 1] >= round || end >= until;
        let sizes = vectors.column_iter().map(|v| v.norm());
        let due = due || sizes.into_iter().any(|size| !(1.0 / GROWN..GROWN).contains(&size));
        if due && !carrier.awaits_occurrence() {
            let rates = direction.at(&state)?.component_div(&units);
            let free = vectors.column(count).into_owned();
            megno.rescale(free.norm());
            let mut turned = vectors.columns(0, count).into_owned();
            let lengths = if space.is_constrained() {
                let (allowed, dimension) = space.allowed_displacements(&state)?;
                let basis = basis_of_range(&allowed, dimension);
                transverse::orthonormalise_within(&mut turned, &basis, &rates, what)
            } else {
                transverse::orthonormalise(&mut turned, &rates, what)
            };
            let last = &growth.logarithms[growth.logarithms.len() - 1];
            let now = last.iter().zip(&lengths).map(|(sum, x)| sum + math::ln(*x)).collect();
            growth.times.push(end);
            growth.logarithms.push(now);
            vectors.columns_mut(0, count).copy_from(&turned);
            vectors.set_column(count, &free.normalize());
            carrier.start(&state, &scaled(&vectors, &units))?;
        }
    }
    if growth.times.len() < 2 {
        return Err(failure.unwrap_or_else(|| {
            DynamicsError::Unsuited("the motion is too short for any exponent".to_owned())
        }));
    }
    Ok(result(space, &carrier, what, &growth, &megno, failure))
}

/// Units of displacements, in which a momentum is as large as the velocity that it causes moves its coordinate in the time
/// of the motion: else a growth that is one of the units, as of a vector from p to q, hides that of the motion. The product of
/// the units of a pair is 1, so that symplectic frames stay symplectic, and they are powers of two, so that no digit changes.
pub(super) fn displacement_units(space: &PhaseSpace, start: &State, duration: f64) -> DVector<f64> {
    let n = space.dimension();
    let mut units = DVector::from_element(n, 1.0);
    let mut field = space.vector_field();
    let is_plain = space.form() == Form::Momentum && !space.is_constrained();
    if !is_plain || field.evaluate(start.time, space.variables(start)).is_err() {
        return units;
    }
    let (derivative, degrees) = (field.derivative(), n / 2);
    let mobility = |i: usize| derivative[(i, degrees + i)].abs();
    // the fastest oscillation about the start, or the whole time where nothing pulls
    let squares = (0..degrees).map(|i| mobility(i) * derivative[(degrees + i, i)].abs());
    let rate = squares.fold(0.0, f64::max).sqrt().max(1.0 / duration);
    for i in 0..degrees {
        let impedance = rate / mobility(i);
        if impedance.is_normal() && !(1.0 / ORDINARY..=ORDINARY).contains(&impedance) {
            let power = math::powi(2.0, (0.5 * math::log2(impedance)).round() as i32);
            (units[i], units[degrees + i]) = (1.0 / power, power);
        }
    }
    units
}

/// Columns with each row multiplied by a factor.
pub(super) fn scaled(vectors: &DMatrix<f64>, factors: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(vectors.nrows(), vectors.ncols(), |i, j| vectors[(i, j)] * factors[i])
}

/// The parts of a step at which MEGNO is summed.
const MEGNO_PARTS: u32 = 4;

/// Which directions are taken out.
fn removed(space: &PhaseSpace, moves: bool) -> Removed {
    match (space.is_hamiltonian(), moves && space.is_autonomous()) {
        (true, true) => Removed::FlowAndEnergy,
        (false, true) if space.is_conservative() => Removed::Flow,
        // with friction a motion may come to rest, and has no direction there
        _ => Removed::Nothing,
    }
}

fn result(
    space: &PhaseSpace,
    carrier: &Carrier,
    what: Removed,
    growth: &TangentGrowth,
    megno: &Megno,
    failure: Option<DynamicsError>,
) -> Lyapunov {
    let (begin, end) = (growth.begin(), growth.end());
    let count = growth.logarithms[0].len();
    let mut all: Vec<(f64, (f64, bool))> = (0..count)
        .map(|i| (growth.weighted(i, begin, end), growth.uncertainty(i)))
        .chain(std::iter::repeat_n((0.0, (0.0, true)), what.count()))
        .collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (exponents, known): (Vec<f64>, Vec<(f64, bool)>) = all.into_iter().unzip();
    let (uncertainty, settled): (Vec<f64>, Vec<bool>) = known.into_iter().unzip();
    let pairs = exponents.iter().zip(exponents.iter().rev());
    let pairing = pairs.map(|(a, b)| (a + b).abs()).fold(0.0, f64::max);
    let curve = (1..=POINTS).map(|i| begin + (end - begin) * i as f64 / POINTS as f64);
    let largest = |time| if count > 0 { growth.plain(0, begin, time) } else { 0.0 };
    let curve: Vec<(f64, f64)> = curve.map(|time| (time, largest(time))).collect();
    let mean = megno.mean();
    let judged = judged(carrier, growth, (&exponents, &uncertainty), megno);
    // what ends is not followed for as long as one wishes
    let (verdict, reason) = match (&failure, judged) {
        (Some(why), (Chaos::Regular, _)) if !why.is_cancelled() => {
            let reason =
                format!("the motion ends after {}, which is too short to tell", short(end - begin));
            (Chaos::Undecided, reason)
        }
        (_, judged) => judged,
    };
    // the exponents of regular motion are 0, towards which they go like 1/t
    let settled = match verdict {
        Chaos::Regular => vec![true; settled.len()],
        Chaos::Chaotic | Chaos::Undecided => settled,
    };
    Lyapunov {
        time: end,
        sum: exponents.iter().sum(),
        exponents,
        uncertainty,
        settled,
        removed: what,
        megno: mean,
        verdict,
        reason,
        pairing_residual: space.is_hamiltonian().then_some(pairing),
        curve,
        settings: carrier.settings(),
        failure,
    }
}

/// The verdict and its reason.
fn judged(
    carrier: &Carrier,
    growth: &TangentGrowth,
    (exponents, uncertainty): (&[f64], &[f64]),
    mean_growth: &Megno,
) -> (Chaos, String) {
    let megno = mean_growth.mean();
    if growth.logarithms[0].is_empty() {
        let reason =
            "a motion of one degree of freedom with conserved energy has no exponent but 0";
        return (Chaos::Regular, reason.to_owned());
    }
    let grown = growth.at(0, growth.end());
    let least = if carrier.is_fixed() { 10 * STEPS } else { STEPS };
    let (largest, off) = (exponents[0], uncertainty[0]);
    let time = short(growth.end() - growth.begin());
    if carrier.steps() < least {
        let reason =
            format!("the motion is too short: {} steps, and {least} are needed", carrier.steps());
        return (Chaos::Undecided, reason);
    }
    if grown >= GROWTH && megno >= CHAOTIC && largest > 2.0 * off {
        let reason = format!(
            "neighbouring motions part by e^{grown:.1} in a time of {time}, and MEGNO is {megno:.1}, \
             where regular motion has 2"
        );
        return (Chaos::Chaotic, reason);
    }
    let rises = megno > SETTLED && mean_growth.growth() > RISING;
    if !rises && megno <= REGULAR && grown < GROWTH + math::ln(carrier.steps() as f64) {
        let reason = format!(
            "neighbouring motions part no faster than in proportion to time: MEGNO is \
             {megno:.2}, and chaotic motion exceeds {CHAOTIC}"
        );
        return (Chaos::Regular, reason);
    }
    let between = megno > REGULAR && megno < CHAOTIC;
    let reason = if rises && megno <= REGULAR {
        format!(
            "MEGNO is {megno:.2} (regular up to {REGULAR}, chaotic from {CHAOTIC}), but rises in proportion to time, and λ is \
             known to ± {off:.1e}: a longer time may tell"
        )
    } else if between {
        format!(
            "neighbouring motions part by e^{grown:.1} in a time of {time} and MEGNO is {megno:.1}, between regular (up to \
             {REGULAR}) and chaotic (from {CHAOTIC}): a longer time may tell"
        )
    } else {
        format!(
            "MEGNO is {megno:.1} (regular up to {REGULAR}, chaotic from {CHAOTIC}), but neighbouring motions part by \
             e^{grown:.1} in a time of {time}, and λ is known to ± {off:.1e}: a longer time may tell"
        )
    };
    (Chaos::Undecided, reason)
}
