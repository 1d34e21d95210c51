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

use super::carrier::Carrier;
use super::chaos::{Chaos, Evidence, has_separated, is_escape, last_closing};
use super::closing::closing;
use super::error::DynamicsError;
use super::excursion::Departure;
use super::lyapunov_course::{CarriedMotion, LyapunovCourse};
use super::megno::Megno;
use super::phase_space::PhaseSpace;
use super::transverse::Removed;
use super::vector_fidelity::VectorFidelity;
use crate::integrate::{Method, Settings};
use crate::num::short;
use crate::system::{MotionErrorKind, State};

const POINTS: usize = 200;

/// The exponents of a motion.
#[derive(Clone, Debug)]
pub struct Lyapunov {
    /// The time reached.
    pub time: f64,
    /// All exponents, the largest first.
    pub exponents: Vec<f64>,
    /// How far each of them is known.
    pub uncertainty: Vec<f64>,
    /// Whether the mean rate of each has settled; where it has not, the uncertainty is a lower bound.
    pub settled: Vec<bool>,
    /// Which directions were taken out; their exponents are zero.
    pub removed: Removed,
    /// MEGNO, averaged over the time.
    pub megno: f64,
    /// Whether they show chaos.
    pub verdict: Chaos,
    /// Its reason.
    pub reason: String,
    /// The sum of all exponents: the mean divergence.
    pub sum: f64,
    /// The largest |λᵢ + λ₂ₙ₊₁₋ᵢ|; `None` where pairs are not expected.
    pub pairing_residual: Option<f64>,
    /// The mean of the largest exponent up to a time, weighted as it is: the last is the exponent itself.
    pub curve: Vec<(f64, f64)>,
    /// The step or tolerance used.
    pub settings: Settings,
    /// Why the motion ended early.
    pub error: Option<DynamicsError>,
}

/// Follows a motion from a state of the space until a time, and `report`s the time after each step.
///
/// # Errors
/// Returns an error if the motion cannot begin, or is too short for any exponent. If it cannot
/// continue, or is cancelled, the result is that of the time reached.
pub fn lyapunov(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    start: &State,
    until: f64,
    report: &mut dyn FnMut(f64),
) -> Result<Lyapunov, DynamicsError> {
    let by = (method, settings);
    let (mut course, motion, error) = followed(space, by, (start, until, false), report)?;
    let (departs, error) = match error {
        None => match departure(space, by, &mut course) {
            Ok(departs) => (departs, None),
            // what was followed until then is the result
            Err(error) => (None, Some(error)),
        },
        Some(_) => (None, error),
    };
    let Some(departure) = departs else {
        return exponents(space, method, &course, &motion, error);
    };
    // the directions of the flow and of the energy have exponents of their own
    let end = if let Departure::Separatrix(time) = departure { time } else { until };
    let (course, motion, error) = followed(space, by, (start, end, true), report)?;
    departing(space, method, (&course, departure), &motion, error)
}

/// How a motion whose directions of the flow and of the energy were taken out departs from one for which their exponents are 0.
///
/// # Errors
/// Returns an error if it is cancelled.
fn departure(
    space: &PhaseSpace,
    by: (&'static Method, Settings),
    course: &mut LyapunovCourse,
) -> Result<Option<Departure>, DynamicsError> {
    let found = course.departure();
    if found == Some(Departure::Unreturned)
        && closing(space, by, course.excursion(), course.growth().end())?.is_some()
    {
        course.has_closed();
        return Ok(None);
    }
    Ok(found)
}

/// Follows a motion from a state until a time, with vectors in all directions or across those whose exponents are 0.
fn followed(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    (start, until, all): (&State, f64, bool),
    report: &mut dyn FnMut(f64),
) -> Result<(LyapunovCourse, CarriedMotion, Option<DynamicsError>), DynamicsError> {
    let (mut course, vectors) = LyapunovCourse::begin(space, start, until, all)?;
    let mut carrier = Carrier::new(space, method, settings, course.vectors())?;
    carrier.start(start, &vectors)?;
    let mut error = None;
    while carrier.is_before(until, true) {
        if let Err(why) = carrier.step(until) {
            error = Some(DynamicsError::Motion(why));
            break;
        }
        let renewed = course.observe(space, &mut carrier)?;
        report(carrier.time());
        if let Some((state, vectors)) = renewed {
            carrier.start(&state, &vectors)?;
        }
    }
    let motion = CarriedMotion {
        settings: carrier.settings(),
        fixed: carrier.is_fixed(),
        steps: carrier.steps(),
    };
    Ok((course, motion, error))
}

/// The exponents of a motion that has been followed to its end, or to a failure.
///
/// # Errors
/// Returns an error if it is too short for any exponent, or cancelled.
pub(super) fn exponents(
    space: &PhaseSpace,
    method: &'static Method,
    course: &LyapunovCourse,
    motion: &CarriedMotion,
    error: Option<DynamicsError>,
) -> Result<Lyapunov, DynamicsError> {
    let mut found = measured(space, course, motion, error)?;
    if found.verdict != Chaos::Chaotic {
        return Ok(found);
    }
    let excursion = course.excursion();
    let growth = course.growth();
    let [whole, half] = [growth.end(), f64::midpoint(growth.begin(), growth.end())]
        .map(|time| if growth.logarithms[0].is_empty() { 0.0 } else { growth.at(0, time) });
    let why = if excursion.rests() {
        Some("the motion is at rest, at an unstable equilibrium, which is not chaos".to_owned())
    } else if is_escape(excursion.widening(), whole - half) {
        Some("the motion itself goes away from its start as fast, and does not return".to_owned())
    } else {
        let most = last_closing(growth.begin(), found.exponents[0]);
        let end = most.min(growth.end());
        let closes = match closing(space, (method, motion.settings), excursion, end) {
            Ok(closes) => closes,
            Err(stopped) => {
                let reason = "whether the motion closes was not found out".to_owned();
                let error = Some(found.error.unwrap_or(stopped));
                return Ok(Lyapunov { verdict: Chaos::Undecided, reason, error, ..found });
            }
        };
        match closes {
            Some(period) => Some(format!(
                "the motion is back at its start after {}, to rounding: an unstable periodic orbit, which is not chaos",
                short(period)
            )),
            None => excursion.is_linear().then(|| {
                "they follow linear equations, the same wherever the motion is, which is not chaos".to_owned()
            }),
        }
    };
    if let Some(why) = why {
        found.verdict = Chaos::Unstable;
        found.reason = format!("{}; {why}", separation_words(whole, growth.end() - growth.begin()));
    }
    Ok(found)
}

/// The exponents of a motion that does not keep returning, which was followed in all directions.
///
/// # Errors
/// Returns an error if it is too short for any exponent, or cancelled.
fn departing(
    space: &PhaseSpace,
    method: &'static Method,
    (course, departure): (&LyapunovCourse, Departure),
    motion: &CarriedMotion,
    error: Option<DynamicsError>,
) -> Result<Lyapunov, DynamicsError> {
    let mut found = exponents(space, method, course, motion, error)?;
    let growth = course.growth();
    // the first vector may lie along the flow, which contracts as it comes to rest
    let vectors = 0..growth.logarithms[0].len();
    let grown = vectors.map(|i| growth.at(i, growth.end())).fold(0.0, f64::max);
    let known = found.error.is_none() && found.exponents[0] > 2.0 * found.uncertainty[0];
    let why = match departure {
        Departure::Separatrix(time) => format!(
            "at t = {} the motion is at an unstable equilibrium, to rounding, which decides what comes after: it is on a separatrix",
            short(time)
        ),
        Departure::Escape => {
            "the motion itself goes away from its start exponentially, and does not return"
                .to_owned()
        }
        Departure::Rest => "the motion itself comes to rest at an unstable equilibrium".to_owned(),
        Departure::Unreturned if found.verdict != Chaos::Chaotic => return Ok(found),
        Departure::Unreturned => "the motion does not return".to_owned(),
    };
    if known && has_separated(grown) {
        found.verdict = Chaos::Unstable;
        found.reason = format!("{}; {why}", separation_words(grown, growth.end() - growth.begin()));
    } else if found.verdict == Chaos::Regular || found.verdict == Chaos::Chaotic {
        found.verdict = Chaos::Undecided;
        found.reason = format!("{why}, and λ is known to ± {:.1e}", found.uncertainty[0]);
    }
    Ok(found)
}

/// By how much neighbours part.
fn separation_words(grown: f64, time: f64) -> String {
    format!("neighbouring motions separate by e^{grown:.1} in a time of {}", short(time))
}

/// What was measured on the way, and what it shows by itself.
fn measured(
    space: &PhaseSpace,
    course: &LyapunovCourse,
    motion: &CarriedMotion,
    error: Option<DynamicsError>,
) -> Result<Lyapunov, DynamicsError> {
    if course.growth().times.len() < 2 {
        return Err(error.unwrap_or_else(|| {
            DynamicsError::Unsuited("the motion is too short for any exponent".to_owned())
        }));
    }
    Ok(result(space, course, motion, error))
}

fn result(
    space: &PhaseSpace,
    course: &LyapunovCourse,
    motion: &CarriedMotion,
    error: Option<DynamicsError>,
) -> Lyapunov {
    let (what, growth, megno) = (course.removed(), course.growth(), course.megno());
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
    let weighted = |vector: &usize| growth.weighted(*vector, begin, end);
    let fastest = (0..count).max_by(|a, b| weighted(a).total_cmp(&weighted(b)));
    // what was taken out has the exponent 0, which may be the largest
    let fastest = fastest.filter(|vector| Some(&weighted(vector)) == exponents.first());
    let curve = match fastest {
        Some(vector) => growth.means(vector, POINTS),
        None => vec![(begin, 0.0), (end, 0.0)],
    };
    let mean = megno.mean();
    let pairing = space.is_hamiltonian().then_some(pairing);
    let followed = VectorFidelity {
        motion,
        growth,
        single_steps: course.single_steps(),
        largest: exponents.first().copied().unwrap_or(0.0),
        // under constraints they hold in the mean alone
        pairing: pairing.filter(|_| !space.is_constrained()),
        volumes: course.volumes(),
        jumps: space.has_jumps(),
    };
    let judged = if count == 0 && course.departure().is_some() {
        let reason = "the motion has not returned in the time followed, which is too short to tell";
        (Chaos::Undecided, reason.to_owned())
    } else {
        judged(&followed, (&exponents, &uncertainty), megno)
    };
    // a motion that ends cannot be followed further
    let (verdict, reason) = match (&error, judged) {
        // neighbours that separate next to a pole of the coordinates tell nothing of the motion, which continues
        (Some(DynamicsError::Motion(error)), _) if error.kind == MotionErrorKind::NoDerivative => {
            let reason = format!(
                "the tangent vectors have no limit after {}, which is too short to tell",
                short(end - begin)
            );
            (Chaos::Undecided, reason)
        }
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
        Chaos::Chaotic | Chaos::Unstable | Chaos::Undecided => settled,
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
        pairing_residual: pairing,
        curve,
        settings: motion.settings,
        error,
    }
}

/// The verdict and its reason.
fn judged(
    followed: &VectorFidelity<'_>,
    (exponents, uncertainty): (&[f64], &[f64]),
    megno: &Megno,
) -> (Chaos, String) {
    let (motion, growth) = (followed.motion, followed.growth);
    if growth.logarithms[0].is_empty() {
        let reason = "a motion of one degree of freedom with conserved energy that returns has no exponent but 0";
        return (Chaos::Regular, reason.to_owned());
    }
    let evidence = Evidence {
        motion,
        lasted: growth.end() - growth.begin(),
        grown: growth.at(0, growth.end()),
        megno: megno.mean(),
        megno_growth: megno.growth(),
        largest: exponents[0],
        uncertainty: uncertainty[0],
    };
    match evidence.too_short().or_else(|| followed.doubt()) {
        Some(reason) => (Chaos::Undecided, reason),
        None => evidence.verdict(),
    }
}
