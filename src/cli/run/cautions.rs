//! What a method cannot do well, said before a run or after it.

use crate::cli::stderr;
use crate::experiment::Experiment;
use crate::integrate::{METHODS, Method};
use crate::system::System;

/// Before the run: a method that passes over the kinks of the motion.
pub(super) fn before(system: &System, method: &Method) {
    if system.has_kinks() && !method.locates_kinks {
        let others: Vec<&str> =
            METHODS.iter().filter(|m| m.locates_kinks).map(|m| m.name).collect();
        stderr::tell(&format!(
            "{} steps over the kinks of this motion and loses accuracy there; {} locates them",
            method.name,
            others.join(", ")
        ));
    }
}

/// After it: a fixed step beyond what is stable.
pub(super) fn after(experiment: &Experiment) {
    if let Some(sentence) = experiment.unstable() {
        stderr::tell(&sentence);
    }
}
