//! A motion beside the main one at one instant: from another start, a neighbour, or a run that was pinned.
//!
//! In, out: facts, as a snapshot has them. Never here: how it moves, see `companion_motion`.

use std::sync::Arc;

use super::Trail;
use crate::analysis::CrossingLog;
use crate::integrate::Settings;
use crate::system::{InitialOverride, State};

/// How a motion beside the main one came to be.
#[derive(Clone, PartialEq, Debug)]
pub enum CompanionOrigin {
    /// A motion from other initial values, with the parameters and the method of the main one.
    Start(Vec<InitialOverride>),
    /// A motion that began beside the main one, each coordinate displaced by this.
    Neighbour(Vec<f64>),
    /// A run as it was, with its initial values, its parameters and its method.
    Pinned(Vec<InitialOverride>),
    /// The run before time was reversed.
    Before,
}

impl CompanionOrigin {
    /// What the motion of this number is, as a sentence without a full stop.
    pub(super) fn sentence(&self, number: usize) -> String {
        let is = match self {
            CompanionOrigin::Start(_) => "begins there, beside the main one",
            CompanionOrigin::Neighbour(_) => "begins close beside the main one",
            CompanionOrigin::Pinned(_) => {
                "is this run, pinned; what changes from now on is seen beside it"
            }
            CompanionOrigin::Before => "is the run before time was reversed",
        };
        format!("motion {number} {is}")
    }

    /// In one or two words, for lists.
    pub fn word(&self) -> &'static str {
        match self {
            CompanionOrigin::Start(_) => "start",
            CompanionOrigin::Neighbour(_) => "neighbour",
            CompanionOrigin::Pinned(_) => "pinned run",
            CompanionOrigin::Before => "run before",
        }
    }
}

/// A motion beside the main one at one instant, cheap to clone.
#[derive(Clone, Debug)]
pub struct Companion {
    /// Its number, from 1 on, by which it is labelled and coloured.
    pub number: usize,
    /// What it is.
    pub origin: CompanionOrigin,
    /// Its time, which is behind that of the main motion until it has caught up.
    pub time: f64,
    /// The value of each channel.
    pub values: Arc<[f64]>,
    /// Those that it moves at, in the order of the model.
    pub parameters: Arc<[f64]>,
    /// The name of its method.
    pub method: &'static str,
    /// Its step and tolerance, as they were set.
    pub settings: Settings,
    /// The step in use, set or chosen, if all steps are equal.
    pub fixed_step: Option<f64>,
    /// The constraints that were released.
    pub released: Arc<[usize]>,
    /// Its state, where it has come to.
    pub state: Arc<State>,
    /// Its recorded motion.
    pub trail: Trail,
    /// Its crossings of the surfaces of section.
    pub crossings: CrossingLog,
    /// Why it does not continue.
    pub message: Option<String>,
}
