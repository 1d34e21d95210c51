//! Warnings about the limits of a method, before a run or after it.

use crate::cli::stderr;
use crate::experiment::Experiment;
use crate::integrate::{METHODS, Method};
use crate::system::System;

/// Warns before the run about a method that ignores the kinks of the motion.
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

/// Warns after the run about a fixed step beyond the stability limit.
pub(super) fn after(experiment: &Experiment) {
    if let Some(sentence) = experiment.unstable() {
        stderr::tell(&sentence);
    }
}
