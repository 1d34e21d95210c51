//! Why a motion cannot continue or begin: what happened, when and where.

use std::fmt;

use crate::num::no_longer_than;
use crate::printable;

/// An error of a motion, where its equations have no valid numerical solution.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub struct MotionError {
    /// The time of the error.
    pub time: f64,
    /// What happened.
    pub kind: MotionErrorKind,
    /// The place of the error: coordinates by their display names, with their values.
    pub place: Vec<(String, f64)>,
}

/// Another method that was seen to pass a place where this one stops.
#[derive(Clone, PartialEq, Debug)]
pub struct Passage {
    /// The method's name.
    pub method: &'static str,
    /// The step size of the trial, if the method has fixed steps.
    pub step: Option<f64>,
}

impl fmt::Display for Passage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "--method {}", self.method)?;
        self.step.map_or(Ok(()), |step| write!(f, " --step {}", short(step)))
    }
}

/// The kind of an error of a motion.
#[derive(Clone, PartialEq, Debug)]
pub enum MotionErrorKind {
    /// An error at a place that another method passes.
    Passable(Box<MotionErrorKind>, Passage),
    /// The comparison motion, which is integrated beside the motion, has this error; the motion itself continues.
    OfComparison(Box<MotionErrorKind>),
    /// A pivot of the mass matrix vanishes.
    SingularMass,
    /// The same within a step of fixed length, which may have left the motion.
    SingularMassInStep,
    /// Under constraints, the momenta do not determine the velocities: a coordinate has no mass of its own.
    NoMass,
    /// The constraints are dependent, or singular together with the mass matrix. Contains how to
    /// pass the place, if known.
    SingularConstraints(Option<Passage>),
    /// This constraint was redundant at the start and contradicts the others here.
    ConstraintContradicts(String),
    /// This constraint has a corner here, where the motion needs an impulse that the law does not determine.
    ConstraintCorner(String),
    /// No state nearby satisfies this constraint.
    ConstraintLost(String),
    /// The same after a step of fixed size, which may be too long.
    ConstraintLostInStep(String),
    /// The initial values violate this constraint, by this part of the size of its terms.
    ConstraintMissed(String, f64),
    /// The initial velocities violate this constraint, by this part of the size of its terms.
    VelocitiesMissed(String, f64),
    /// This constraint has the direction of those before it at the start, and another rate, by this part of the size of its
    /// terms.
    ConstraintInconsistent(String, f64),
    /// The given initial velocities and momenta contradict the constraints.
    Contradiction,
    /// The constraints do not determine these initial velocities.
    FreeVelocities(Vec<String>),
    /// The given initial momenta belong to each of these velocities (or the reverse).
    SeveralStarts(Vec<String>),
    /// A number of the state or of its rate of change, given by its name, is not finite.
    NotFinite(String),
    /// The same in a step of fixed size, which may be too long.
    NotFiniteInStep(String),
    /// A number of the state, given by its name, or the time has grown beyond what a number can hold.
    OutOfRange(Option<String>),
    /// The same in a step of fixed size where the motion itself does not grow so.
    OutOfRangeInStep(String, f64),
    /// This coordinate or variable reaches infinity at the time of the error.
    BlowsUp(String),
    /// A number that is given at the start, by its name, is below those that keep all their digits.
    TooSmall(String),
    /// The functions of the events swing too often within one step to be followed.
    Swings,
    /// The change of the momenta by this impulse, or what it leads to, is not a finite number.
    ImpulseNotFinite(String),
    /// No velocities were found for the given momenta (or the reverse).
    NoVelocities,
    /// The same in a step of fixed size, which may be too long.
    NoVelocitiesInStep,
    /// A step led to velocities on another branch for the same momenta.
    BranchLeft,
    /// A step led to where a logarithm of the energy has no value.
    LogarithmLeft,
    /// The equations of an implicit step were not solved. Contains the step size.
    NoConvergence(f64),
    /// The step became too small to advance the time. Contains the step size.
    StepUnderflow(f64),
    /// The same where forces have grown without bound and velocities have not, as on the way to x = 0 with the potential |x|^0.1.
    ForceUnbounded(f64),
    /// Ever shorter steps come ever nearer to an instant and do not reach it, as that of sin(1/(1 − t)). Contains the instant and the
    /// step size.
    Unreachable(f64, f64),
    /// Tangent vectors cannot be carried on, while the motion itself continues.
    NoDerivative,
    /// The time has too few digits for the next step or impulse. Contains the spacing of
    /// representable times.
    ClockStands(f64),
    /// This recurring impulse has an invalid interval: zero, negative or not finite.
    NoInterval(String, f64),
    /// There are too many fixed steps of this size up to this time.
    TooManySteps(f64, f64),
    /// This event occurs at ever shorter intervals, without end.
    EventsAccumulate(String),
    /// The motion grazes the surface of this event, and has no derivative there.
    Grazes(String),
    /// Another impulse acts at the time of the one that this event causes; derivatives depend on
    /// which is first.
    Coincides(String),
    /// This event has ended a motion that was to be differentiated further.
    Ended(String),
    /// The computation was cancelled.
    Cancelled,
    /// The motion reaches a point from which no series continues it.
    Rough,
    /// The motion is on a kink that no side leads away from, and along which it cannot be followed.
    NoSide,
    /// The motion sticks on a kink where both sides push back, and cannot be followed.
    Sticks,
}

impl MotionErrorKind {
    /// Whether no motion is known to continue from there, whatever follows it: not where another method passes, and not where only
    /// the method, the digits of the clock at its beginning or the number of steps is at its end. Steps that vanish on the way
    /// count, though a motion that passes a singularity within the digits of its time has no more of them than one that ends there.
    pub fn ends_motion(&self) -> bool {
        matches!(
            self,
            MotionErrorKind::SingularMass
                | MotionErrorKind::NoMass
                | MotionErrorKind::SingularConstraints(None)
                | MotionErrorKind::ConstraintLost(_)
                | MotionErrorKind::ConstraintCorner(_)
                | MotionErrorKind::NotFinite(_)
                | MotionErrorKind::OutOfRange(_)
                | MotionErrorKind::BlowsUp(_)
                | MotionErrorKind::NoVelocities
                | MotionErrorKind::BranchLeft
                | MotionErrorKind::LogarithmLeft
                | MotionErrorKind::StepUnderflow(_)
                | MotionErrorKind::ForceUnbounded(_)
                | MotionErrorKind::Rough
        )
    }
}

impl fmt::Display for MotionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let time = printable::number(self.time);
        if let MotionErrorKind::Passable(kind, passage) = &self.kind {
            let MotionError { time, place, .. } = self.clone();
            let plain = MotionError { time, kind: (**kind).clone(), place };
            return write!(f, "{plain}; {passage} passes it");
        }
        if let MotionErrorKind::OfComparison(kind) = &self.kind {
            let MotionError { time, place, .. } = self.clone();
            let plain = MotionError { time, kind: (**kind).clone(), place };
            return write!(f, "the motion of [comparison]: {plain}");
        }
        match &self.kind {
            MotionErrorKind::Passable(..) | MotionErrorKind::OfComparison(_) => {}
            MotionErrorKind::SingularMass | MotionErrorKind::SingularMassInStep => {
                write!(f, "the mass matrix is singular at t = {time}")?;
            }
            MotionErrorKind::NoMass => {
                write!(f, "the momenta do not determine the velocities at t = {time}")?;
            }
            MotionErrorKind::SingularConstraints(_) => {
                write!(f, "singular configuration of the constraints at t = {time}")?;
            }
            MotionErrorKind::ConstraintContradicts(name) => write!(
                f,
                "the constraint `{name}`, which repeated those before it where the motion began, \
                 contradicts them after t = {time}"
            )?,
            MotionErrorKind::ConstraintCorner(name) => {
                write!(f, "the motion comes to a corner of the constraint `{name}` at t = {time}")?;
            }
            MotionErrorKind::ConstraintLost(name) | MotionErrorKind::ConstraintLostInStep(name) => {
                write!(f, "the constraint `{name}` cannot be kept at t = {time}")?;
            }
            MotionErrorKind::ConstraintMissed(name, part) => write!(
                f,
                "the values at the start do not keep the constraint `{name}`: it is off by {part:.1e} of its terms"
            )?,
            MotionErrorKind::VelocitiesMissed(name, part) => write!(
                f,
                "the velocities at the start do not keep the constraint `{name}`: its rate is off by {part:.1e} of its terms"
            )?,
            MotionErrorKind::ConstraintInconsistent(name, part) => write!(
                f,
                "the constraint `{name}` contradicts those before it at the start: its rate is off by {part:.1e} of its terms"
            )?,
            MotionErrorKind::Contradiction => f.write_str(
                "the velocities and momenta given at the start contradict the constraints",
            )?,
            MotionErrorKind::FreeVelocities(names) => write!(
                f,
                "the constraints leave velocities at the start undetermined: give {}",
                names.join(", ")
            )?,
            MotionErrorKind::SeveralStarts(starts) => write!(
                f,
                "what is given belongs to several starts ({}): give one of these instead",
                starts.join("; ")
            )?,
            MotionErrorKind::NotFinite(name) | MotionErrorKind::NotFiniteInStep(name) => {
                write!(f, "{name} is no longer finite at t = {time}")?;
            }
            MotionErrorKind::BlowsUp(name) => {
                write!(f, "the motion grows without bound: {name} reaches infinity at t = {time}")?;
            }
            MotionErrorKind::OutOfRange(Some(name))
            | MotionErrorKind::OutOfRangeInStep(name, _) => {
                write!(f, "{name} grows beyond the range of numbers, 1.8e308, after t = {time}")?;
            }
            MotionErrorKind::OutOfRange(None) => {
                write!(f, "the time leaves the range of numbers after t = {time}")?;
            }
            MotionErrorKind::TooSmall(name) => {
                write!(f, "{name} is too small at t = {time}")?;
            }
            MotionErrorKind::NoVelocities | MotionErrorKind::NoVelocitiesInStep => {
                write!(f, "no velocities were found that belong to the momenta at t = {time}")?;
            }
            MotionErrorKind::BranchLeft => {
                write!(f, "the branch of the velocities ends after t = {time}")?;
            }
            MotionErrorKind::LogarithmLeft => {
                write!(f, "the motion leaves the domain of ln after t = {time}")?;
            }
            MotionErrorKind::NoConvergence(step) => {
                write!(f, "the implicit step of size {step:e} was not solved at t = {time}")?;
            }
            MotionErrorKind::StepUnderflow(_) | MotionErrorKind::ForceUnbounded(_) => {
                write!(f, "the step became too small to move the clock at t = {time}")?;
            }
            MotionErrorKind::Unreachable(instant, step) => write!(
                f,
                "no number of steps reaches t = {}: they have come to {step:.1e} at t = {time}",
                printable::number(*instant)
            )?,
            MotionErrorKind::NoDerivative => {
                write!(f, "the tangent vectors have no limit at t = {time}")?;
            }
            MotionErrorKind::ClockStands(spacing) => write!(
                f,
                "the clock cannot continue from t = {time}: its digits are {} apart there",
                short(*spacing)
            )?,
            MotionErrorKind::NoInterval(name, interval) => {
                write!(f, "the impulse `{name}` cannot act every {}", short(*interval))?;
            }
            MotionErrorKind::ImpulseNotFinite(name) => {
                write!(f, "the impulse `{name}` has no finite value at t = {time}")?;
            }
            MotionErrorKind::TooManySteps(step, until) => write!(
                f,
                "steps of size {step:e} from t = {time} are too many to be counted up to t = {until}"
            )?,
            MotionErrorKind::EventsAccumulate(name) => {
                write!(f, "`{name}` happens ever faster and accumulates at t = {time}")?;
            }
            MotionErrorKind::Grazes(name) => write!(
                f,
                "the motion grazes the surface of `{name}` at t = {time}, where it has no derivative"
            )?,
            MotionErrorKind::Coincides(name) => write!(
                f,
                "another impulse acts together with that of `{name}` at t = {time}, where the \
                 motion has no derivative"
            )?,
            MotionErrorKind::Ended(name) => write!(f, "`{name}` ends the motion at t = {time}")?,
            MotionErrorKind::Sticks => write!(f, "the motion sticks at t = {time}")?,
            MotionErrorKind::Rough => write!(
                f,
                "the motion comes to a kink or to the end of a function's domain, and cannot be followed through it at t = {time}"
            )?,
            MotionErrorKind::NoSide => {
                write!(
                    f,
                    "the motion comes to a kink that it cannot be followed through at t = {time}"
                )?;
            }
            MotionErrorKind::Swings => write!(
                f,
                "the function of an event oscillates too often within one step at t = {time}"
            )?,
            MotionErrorKind::Cancelled => write!(f, "stopped on the way at t = {time}")?,
        }
        for (name, value) in &self.place {
            write!(f, ", {name} = {}", short(*value))?;
        }
        f.write_str(match &self.kind {
            MotionErrorKind::SingularMass => ": a chart singularity or a degenerate Lagrangian",
            MotionErrorKind::SingularMassInStep => {
                ": try a smaller step, unless a chart singularity lies there"
            }
            MotionErrorKind::NoMass => {
                ": a coordinate that the constraints alone move has no mass of its own, and what works with momenta needs \
                 one for each; put its constraint into L by hand"
            }
            MotionErrorKind::SingularConstraints(passage) => {
                f.write_str(": their directions depend on each other there, or one has none")?;
                let Some(passage) = passage else { return Ok(()) };
                return write!(f, "; {passage} passes it, on the smooth one of its branches");
            }
            MotionErrorKind::ConstraintContradicts(_) => {
                ": the motion began at a singular configuration of the constraints"
            }
            MotionErrorKind::ConstraintCorner(_) => {
                ": its direction jumps there, and the law does not say with which impulse the motion goes on; round the corner, \
                 as |x| to sqrt(x^2 + e^2)"
            }
            MotionErrorKind::ConstraintLost(_) => ": no configuration nearby meets it",
            MotionErrorKind::ConstraintLostInStep(_) => {
                ": no configuration near the end of the step meets it; try a smaller step"
            }
            MotionErrorKind::ConstraintMissed(..)
            | MotionErrorKind::VelocitiesMissed(..)
            | MotionErrorKind::ConstraintInconsistent(..)
            | MotionErrorKind::FreeVelocities(_)
            | MotionErrorKind::SeveralStarts(_)
            | MotionErrorKind::Passable(..)
            | MotionErrorKind::OfComparison(_)
            | MotionErrorKind::Ended(_)
            | MotionErrorKind::BlowsUp(_)
            | MotionErrorKind::OutOfRange(Some(_))
            | MotionErrorKind::Cancelled => "",
            MotionErrorKind::OutOfRangeInStep(_, step) => {
                return write!(
                    f,
                    ", which the motion itself does not: the step {} is too long for it; try a smaller step",
                    short(*step)
                );
            }
            MotionErrorKind::OutOfRange(None) => ": what is searched for does not happen before",
            MotionErrorKind::Grazes(_) => ": nearby motions meet it or pass by",
            MotionErrorKind::Coincides(_) => {
                ": which of them comes first is different in nearby motions"
            }
            MotionErrorKind::Contradiction => ": give fewer of them",
            MotionErrorKind::NotFinite(_) => ": a collision, a pole, or a value outside a function",
            MotionErrorKind::NotFiniteInStep(_) => {
                ": try a smaller step, unless a collision, a pole or the end of a function's domain \
                 lies there"
            }
            MotionErrorKind::TooSmall(_) => {
                ": numbers below 2.2e-308 do not keep all their digits; give 0, or choose other units"
            }
            MotionErrorKind::NoVelocities => ": the momenta may lie outside their range",
            MotionErrorKind::NoVelocitiesInStep => {
                ": try a smaller step, unless the momenta lie outside their range"
            }
            MotionErrorKind::BranchLeft => {
                ": a step led beyond the place where the momenta p = ∂L/∂q′ turn back"
            }
            MotionErrorKind::LogarithmLeft => {
                ": a step led to where the energy has no value, although the forces have one; try a smaller step or \
                 tolerance, unless a collision lies there"
            }
            MotionErrorKind::NoConvergence(_) | MotionErrorKind::Swings => ": try a smaller step",
            MotionErrorKind::ForceUnbounded(_) => {
                ": the force grows without bound there, while the velocity does not; what it does to the motion within the last \
                 digit of the time is more than can be neglected"
            }
            MotionErrorKind::StepUnderflow(_) => ": a collision or another singularity lies ahead",
            MotionErrorKind::Unreachable(..) => {
                ": the law has an essential singularity there; end the motion before it"
            }
            MotionErrorKind::NoDerivative => {
                ": the motion itself continues, so that no collision lies there, but a pole of the coordinates or another place at \
                 which motions have no derivative by their start; other coordinates may have one"
            }
            MotionErrorKind::ClockStands(_) => ", and the next step, impulse or event comes sooner",
            MotionErrorKind::NoInterval(..) => ": its interval must be above zero",
            MotionErrorKind::TooManySteps(..) => ": try a larger step",
            MotionErrorKind::ImpulseNotFinite(_) => {
                ": its change lies outside a function's domain, or beyond the range of numbers"
            }
            MotionErrorKind::EventsAccumulate(_) => ": give the file an event that stops it before",
            MotionErrorKind::Rough => ": the rates of change have no limit there, or no value beyond",
            MotionErrorKind::NoSide => ": no side of it leads away, and a motion along it cannot be followed",
            MotionErrorKind::Sticks => ": both sides of a kink push towards it",
        })
    }
}

/// Formats a number with no more digits than it has.
fn short(value: f64) -> String {
    no_longer_than(value, LONGEST)
}

/// The maximal length of a number written out: an `f64` has 17 digits, a sign and a point.
const LONGEST: usize = 24;
