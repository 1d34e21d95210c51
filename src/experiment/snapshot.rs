//! The observable state of an experiment at one instant. It is cheap to clone because everything long is shared.

use std::sync::Arc;

use super::{Companion, EventLog, Hull, LastChange, Return, RunToken, Setup, Trail};
use crate::analysis::{CrossingLog, DistanceHistory, Verdict};
use crate::system::{Form, State};

/// The state of an experiment as the screen and the reports see it.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// A count of rebuilt systems; two snapshots of one epoch belong to the same system.
    pub epoch: u64,
    /// The simulated time.
    pub time: f64,
    /// Whether time runs backwards.
    pub backwards: bool,
    /// How it has returned along the run before, if time was reversed.
    pub returned: Option<Return>,
    /// What of the motion is recorded and can be shown again: from when, to when, and whether it is shown now.
    pub recorded: Recorded,
    /// Whether time is running, paused, ended or failed.
    pub status: Status,
    /// The requested simulated seconds per second; infinite for as fast as possible.
    pub speed: f64,
    /// The parameters, in the model's order.
    pub parameters: Arc<[f64]>,
    /// The initial values: coordinates, then velocities or momenta.
    pub initial: Arc<[f64]>,
    /// The setup that a restart begins with.
    pub setup: Arc<Setup>,
    /// The exact state; it is empty if the motion has not begun.
    pub state: Arc<State>,
    /// The current value of every channel, in the order of the system's channels.
    pub values: Arc<[f64]>,
    /// The least and greatest value of every channel since the last restart, for axes that do not move.
    pub bounds: Arc<[(f64, f64)]>,
    /// What contains the points of the picture in space since the last restart, tighter than the bounds.
    pub hulls: Arc<[Hull]>,
    /// The recorded motion: every channel at past times.
    pub trail: Trail,
    /// One gauge for each monitored invariant.
    pub gauges: Arc<[Gauge]>,
    /// The method and its step.
    pub method: MethodFact,
    /// The notices to the user, such as "energy reference taken anew: …", the newest last.
    pub notices: Arc<[String]>,
    /// The events and impulses since the last restart, in order of time.
    pub occurrences: EventLog,
    /// The crossings of the surfaces of section since the last restart or change of a parameter.
    pub crossings: CrossingLog,
    /// The motions beside this one.
    pub companions: Arc<[Companion]>,
    /// Their numbers and distances.
    pub separations: Arc<[(usize, Arc<DistanceHistory>)]>,
    /// The indices of the released constraints.
    pub released: Vec<usize>,
    /// Whether the motion was resumed from a checkpoint.
    pub restored: bool,
}

impl Snapshot {
    /// An empty snapshot.
    pub fn empty(epoch: u64) -> Snapshot {
        Snapshot {
            epoch,
            time: 0.0,
            backwards: false,
            returned: None,
            recorded: Recorded::default(),
            status: Status::Paused,
            speed: 1.0,
            parameters: Arc::default(),
            initial: Arc::default(),
            setup: Arc::default(),
            state: Arc::new(State::new(0.0, Form::Velocity, Vec::new())),
            values: Arc::default(),
            bounds: Arc::default(),
            hulls: Arc::default(),
            trail: Trail::default(),
            gauges: Arc::default(),
            method: MethodFact { name: "", step: 0.0, steps: 0, tolerance: None },
            notices: Arc::default(),
            occurrences: EventLog::default(),
            crossings: CrossingLog::default(),
            companions: Arc::default(),
            separations: Arc::default(),
            released: Vec::new(),
            restored: false,
        }
    }
}

/// The recorded past of a motion, which can be shown again.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Recorded {
    /// The first time that can be shown; it is later than `to` if time runs backwards.
    pub from: f64,
    /// The time that the motion has reached.
    pub to: f64,
    /// Whether a time before is shown.
    pub scrubbed: bool,
    /// Where the law was changed last, if it was since the start.
    pub changed: Option<Arc<LastChange>>,
    /// What distinguishes this run from others.
    pub run: RunToken,
}

/// Whether time runs.
#[derive(Clone, PartialEq, Debug)]
pub enum Status {
    /// Time is running.
    Running,
    /// Paused by the user.
    Paused,
    /// Ended by the event of this name.
    Ended(String),
    /// The motion cannot continue.
    Failed(RunError),
}

/// Why a motion cannot continue.
#[derive(Clone, PartialEq, Debug)]
pub struct RunError {
    /// The time of the failure.
    pub time: f64,
    /// What happened, where, and what may help, in a sentence or two.
    pub message: String,
    /// Whether the motion itself ends there, not only what its method can follow.
    pub ends_motion: bool,
}

/// A monitored invariant.
#[derive(Clone, Debug)]
pub struct Gauge {
    /// `energy`, `p_phi`, an observable's name, `energy balance`.
    pub name: String,
    /// The name as shown: `E`, `p_φ`.
    pub shown: String,
    /// Why it is conserved: `cyclic φ`, `∂L/∂t = 0`, `stated by the file`.
    pub reason: String,
    /// Whether it follows from the law of motion, independently of any numbers.
    pub proved: bool,
    /// The current value.
    pub value: f64,
    /// The value when the reference was taken.
    pub initial: f64,
    /// The scale of the drift, see `drift`.
    pub scale: f64,
    /// The greatest distance from the reference since it was taken.
    pub farthest: f64,
    /// The value that drift is measured from: the initial one plus the jumps of impulses.
    pub reference: f64,
    /// When the reference was taken.
    pub reference_time: f64,
    /// |value − reference| over the mean moving part of the quantity: the excess of its terms over those at rest, and
    /// the change of the rest. A distance that rounding of the terms explains is relative to the terms themselves.
    pub drift: f64,
    /// The greatest drift since the reference, over all steps. Each distance is relative to the mean moving part up
    /// to that time, or to the moving part at that time if it was greater; where physics changes the quantity, to the
    /// greatest moving part up to that time.
    pub max_drift: f64,
    /// Since when the drift has exceeded a millionth, if the physics conserves the quantity.
    pub left: Option<f64>,
    /// The drift at past times (evenly thinned), the oldest first, for the sparkline; of what the physics does not conserve its
    /// change, with the sign.
    pub history: Arc<[f32]>,
    /// What the history of its drift shows.
    pub verdict: Verdict,
}

impl Gauge {
    /// The gauge with the greatest drift among those conserved by the law of motion, if any drift exceeds a
    /// millionth. In that case the computed motion does not follow the law.
    pub fn departed(gauges: &[Gauge]) -> Option<&Gauge> {
        let departed = gauges.iter().filter(|gauge| gauge.proved && gauge.left.is_some());
        departed.max_by(|a, b| a.max_drift.total_cmp(&b.max_drift))
    }
}

#[cfg(test)]
impl Gauge {
    /// A gauge of a declared quantity that is one, and has drifted this far.
    pub(crate) fn drifted(max_drift: f64) -> Gauge {
        Gauge {
            name: "G".to_owned(),
            shown: "G".to_owned(),
            reason: "stated by the file".to_owned(),
            proved: true,
            value: 1.0,
            initial: 1.0,
            scale: 1.0,
            farthest: max_drift,
            reference: 1.0,
            reference_time: 0.0,
            drift: max_drift,
            max_drift,
            left: None,
            history: Arc::default(),
            verdict: Verdict::Bounded,
        }
    }
}

/// The method in use.
#[derive(Clone, PartialEq, Debug)]
pub struct MethodFact {
    /// Its name in the table of methods.
    pub name: &'static str,
    /// The last step.
    pub step: f64,
    /// The steps taken since the last reset.
    pub steps: u64,
    /// The tolerance of an adaptive method.
    pub tolerance: Option<f64>,
}

impl From<crate::system::MotionError> for RunError {
    fn from(error: crate::system::MotionError) -> RunError {
        let ends_motion = error.kind.ends_motion();
        RunError { time: error.time, message: error.to_string(), ends_motion }
    }
}

/// The greatest drift of the energy, or of the energy less the work done; NaN if neither is monitored.
pub fn energy_drift(gauges: &[Gauge]) -> f64 {
    let gauge = |name: &str| gauges.iter().find(|gauge| gauge.name == name);
    let energy = gauge("energy balance").or_else(|| gauge("energy"));
    energy.map_or(f64::NAN, |gauge| gauge.max_drift)
}
