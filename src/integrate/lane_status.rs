//! How an orbit carried beside others stands. Never here: the orbit.

/// The status of a lane of a batch.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum LaneStatus {
    /// Nothing is in it.
    Empty,
    /// Its orbit is carried on.
    Underway,
    /// Its orbit needs what is not done side by side; it is to be followed alone, from its beginning.
    Irregular,
}
