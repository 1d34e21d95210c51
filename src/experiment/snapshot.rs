//! What can be seen of an experiment at one moment. Cheap to clone: everything long is shared.

use std::sync::Arc;

use super::{EventLog, Setup, Trail};
use crate::analysis::Verdict;
use crate::system::{Form, State};

/// The state of an experiment as the screen and the reports see it.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// Counts rebuilt systems; two snapshots of one epoch speak of the same system.
    pub epoch: u64,
    /// Simulated time.
    pub time: f64,
    /// Running, paused or faulted.
    pub status: Status,
    /// Simulated seconds per second asked for; infinite means flat out.
    pub speed: f64,
    /// Parameters, in the model's order.
    pub parameters: Arc<[f64]>,
    /// Initial values: coordinates, then velocities or momenta.
    pub initial: Arc<[f64]>,
    /// What a restart would begin with: all that was asked for.
    pub setup: Arc<Setup>,
    /// Where the motion is, to the last bit; without numbers where it has not begun.
    pub state: Arc<State>,
    /// The value of every channel now, in the order of the system's channels.
    pub values: Arc<[f64]>,
    /// The least and greatest value of every channel since the last restart, for axes that keep
    /// still.
    pub bounds: Arc<[(f64, f64)]>,
    /// The recorded motion: every channel at past times.
    pub trail: Trail,
    /// One gauge for each invariant watched.
    pub gauges: Arc<[Gauge]>,
    /// The method and its step.
    pub method: MethodFact,
    /// What the user is reported in passing: "energy reference taken anew: …". The newest last.
    pub notices: Arc<[String]>,
    /// What happened since the last restart, in time.
    pub occurrences: EventLog,
    /// The constraints that were let go, by index.
    pub released: Vec<usize>,
    /// Whether a motion left elsewhere was taken up.
    pub taken_up: bool,
}

impl Snapshot {
    /// A snapshot that shows nothing.
    pub fn empty(epoch: u64) -> Snapshot {
        Snapshot {
            epoch,
            time: 0.0,
            status: Status::Paused,
            speed: 1.0,
            parameters: Arc::default(),
            initial: Arc::default(),
            setup: Arc::default(),
            state: Arc::new(State::new(0.0, Form::Velocity, Vec::new())),
            values: Arc::default(),
            bounds: Arc::default(),
            trail: Trail::default(),
            gauges: Arc::default(),
            method: MethodFact { name: "", step: 0.0, steps: 0, tolerance: None },
            notices: Arc::default(),
            occurrences: EventLog::default(),
            released: Vec::new(),
            taken_up: false,
        }
    }
}

/// Whether time runs.
#[derive(Clone, PartialEq, Debug)]
pub enum Status {
    /// Time runs.
    Running,
    /// Held by the user.
    Paused,
    /// Ended by the event of this name.
    Ended(String),
    /// It cannot go on.
    Failed(Failure),
}

/// Why a motion cannot go on.
#[derive(Clone, PartialEq, Debug)]
pub struct Failure {
    /// When.
    pub time: f64,
    /// What happened, where, and what may help, in a sentence or two.
    pub message: String,
}

/// An invariant under watch.
#[derive(Clone, Debug)]
pub struct Gauge {
    /// `energy`, `p_phi`, an observable's name, `energy ledger`.
    pub name: String,
    /// As shown: `E`, `p_φ`.
    pub shown: String,
    /// Where it comes from: `cyclic φ`, `∂L/∂t = 0`, `declared`.
    pub reason: String,
    /// Whether it follows from the law of motion, without a number being looked at.
    pub proved: bool,
    /// Its value now.
    pub value: f64,
    /// Its value when the reference was taken.
    pub initial: f64,
    /// What its drift is relative to, see `drift`.
    pub scale: f64,
    /// The greatest distance from the reference since it was taken.
    pub farthest: f64,
    /// The value that drift is measured from: the initial one, and what impulses have added to it.
    pub reference: f64,
    /// When that was taken.
    pub reference_time: f64,
    /// |value − reference| over what moves: what the terms of the quantity have more than at rest, and by how much the
    /// rest of them has changed; on the mean. What rounding explains is relative to the
    /// terms themselves.
    pub drift: f64,
    /// The greatest drift since the reference, over all steps; each over what moved until then on the mean, or at that
    /// time where that was more.
    pub max_drift: f64,
    /// Since when it is more than a millionth, if the physics keeps the quantity.
    pub left: Option<f64>,
    /// Drift at past times (evenly thinned), the oldest first: the small history.
    pub history: Arc<[f32]>,
    /// What to think of it.
    pub verdict: Verdict,
}

impl Gauge {
    /// Of those that the law of motion keeps the one that has left its value by the most, if any has by more than a
    /// millionth of what moves: the motion computed is not the one of that law.
    pub fn departed(gauges: &[Gauge]) -> Option<&Gauge> {
        let departed = gauges.iter().filter(|gauge| gauge.proved && gauge.left.is_some());
        departed.max_by(|a, b| a.max_drift.total_cmp(&b.max_drift))
    }
}

/// The method in use.
#[derive(Clone, PartialEq, Debug)]
pub struct MethodFact {
    /// Its name in the table of methods.
    pub name: &'static str,
    /// The step last taken.
    pub step: f64,
    /// Steps taken since the last reset.
    pub steps: u64,
    /// The tolerance of an adaptive method.
    pub tolerance: Option<f64>,
}

impl From<crate::system::MotionError> for Failure {
    fn from(fault: crate::system::MotionError) -> Failure {
        Failure { time: fault.time, message: fault.to_string() }
    }
}
