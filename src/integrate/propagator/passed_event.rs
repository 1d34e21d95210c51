//! Impulses at events that stop the motion and do not hold it: a ball whose restitution is 0 falls through its floor.
//!
//! In: such events. Out: the first after which the motion continued to the other side. Never here: how they are seen (`passed_event_watch`).

/// An event whose impulse stopped the motion towards its other side.
#[derive(Clone, Copy, Debug)]
pub(super) struct StoppedEvent {
    pub(super) event: usize,
    pub(super) time: f64,
    /// The sign that its function was about to have.
    pub(super) side: f64,
}

/// What is known of such events along one motion.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PassedEvents {
    /// The last one, until a step has shown to which side it leads.
    pub(super) open: Option<StoppedEvent>,
    /// The first after which the motion continued to the other side.
    pub(super) first: Option<StoppedEvent>,
}
