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
use super::error::DynamicsError;
use super::lyapunov_course::{CarriedMotion, LyapunovCourse};
use super::megno::Megno;
use super::phase_space::PhaseSpace;
use super::transverse::Removed;
use super::vector_fidelity::Followed;
use crate::integrate::{Method, Settings};
use crate::num::{math, short};
use crate::system::{MotionErrorKind, State};

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

impl Chaos {
    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            Chaos::Regular => "regular",
            Chaos::Chaotic => "chaotic",
            Chaos::Undecided => "undecided",
        }
    }
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
    let (mut course, vectors) = LyapunovCourse::begin(space, start, until)?;
    let mut carrier = Carrier::new(space, method, settings, course.vectors())?;
    carrier.start(start, &vectors)?;
    let mut failure = None;
    while carrier.is_before(until, true) {
        if let Err(fault) = carrier.step(until) {
            failure = Some(DynamicsError::Motion(fault));
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
    exponents(space, &course, &motion, failure)
}

/// The exponents of a motion that has been followed to its end, or to a failure.
///
/// # Errors
/// Returns an error if it is too short for any exponent.
pub(super) fn exponents(
    space: &PhaseSpace,
    course: &LyapunovCourse,
    motion: &CarriedMotion,
    failure: Option<DynamicsError>,
) -> Result<Lyapunov, DynamicsError> {
    if course.growth().times.len() < 2 {
        return Err(failure.unwrap_or_else(|| {
            DynamicsError::Unsuited("the motion is too short for any exponent".to_owned())
        }));
    }
    Ok(result(space, course, motion, failure))
}

fn result(
    space: &PhaseSpace,
    course: &LyapunovCourse,
    motion: &CarriedMotion,
    failure: Option<DynamicsError>,
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
    let curve = (1..=POINTS).map(|i| begin + (end - begin) * i as f64 / POINTS as f64);
    let largest = |time| if count > 0 { growth.plain(0, begin, time) } else { 0.0 };
    let curve: Vec<(f64, f64)> = curve.map(|time| (time, largest(time))).collect();
    let mean = megno.mean();
    let pairing = space.is_hamiltonian().then_some(pairing);
    let followed = Followed {
        motion,
        growth,
        single_steps: course.single_steps(),
        largest: exponents.first().copied().unwrap_or(0.0),
        // under constraints they hold in the mean alone
        pairing: pairing.filter(|_| !space.is_constrained()),
        jumps: space.has_jumps(),
    };
    let judged = judged(&followed, (&exponents, &uncertainty), megno);
    // what ends is not followed for as long as one wishes
    let (verdict, reason) = match (&failure, judged) {
        // neighbours that part next to a pole of the coordinates tell nothing of the motion, which continues
        (Some(DynamicsError::Motion(fault)), _) if fault.kind == MotionErrorKind::NoDerivative => {
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
        pairing_residual: pairing,
        curve,
        settings: motion.settings,
        failure,
    }
}

/// The verdict and its reason.
fn judged(
    followed: &Followed<'_>,
    (exponents, uncertainty): (&[f64], &[f64]),
    mean_growth: &Megno,
) -> (Chaos, String) {
    let (motion, growth, megno) = (followed.motion, followed.growth, mean_growth.mean());
    if growth.logarithms[0].is_empty() {
        let reason =
            "a motion of one degree of freedom with conserved energy has no exponent but 0";
        return (Chaos::Regular, reason.to_owned());
    }
    let grown = growth.at(0, growth.end());
    let least = if motion.fixed { 10 * STEPS } else { STEPS };
    let (largest, off) = (exponents[0], uncertainty[0]);
    let time = short(growth.end() - growth.begin());
    if motion.steps < least {
        let reason =
            format!("the motion is too short: {} steps, and {least} are needed", motion.steps);
        return (Chaos::Undecided, reason);
    }
    if let Some(reason) = followed.doubt() {
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
    if !rises && megno <= REGULAR && grown < GROWTH + math::ln(motion.steps as f64) {
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
