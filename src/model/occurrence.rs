//! What happens to a motion at single moments: impulses that are given, and crossings that are looked
//! for.

use super::SourceRange;
use crate::expr::Expr;

/// An impulse: p jumps, q does not.
#[derive(Clone, Debug)]
pub struct Impulse {
    /// As written in the file.
    pub name: String,
    /// At these times, in parameters.
    pub times: Vec<Expr>,
    /// And at every multiple of this interval after the start, in parameters.
    pub period: Option<Expr>,
    /// The applied impulse Q̂ on each coordinate (the jump of each variable of a Poisson system), of
    /// the state before it; zero where there is none.
    pub change: Vec<Expr>,
    /// What it is, in words.
    pub about: String,
    /// Where it stands in the file.
    pub place: SourceRange,
}

/// A crossing to be located on the motion.
#[derive(Clone, Debug)]
pub struct Event {
    /// As written in the file.
    pub name: String,
    /// It happens where this crosses zero. As in an observable.
    pub when: Expr,
    /// Which crossings count.
    pub direction: Direction,
    /// What follows.
    pub action: Action,
    /// Where it stands in the file.
    pub place: SourceRange,
}

/// The sense of a crossing of zero.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Direction {
    /// From below.
    Rising,
    /// From above.
    Falling,
    /// Both.
    Either,
}

/// What an event does.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Action {
    /// It is recorded.
    Mark,
    /// The motion ends.
    Stop,
    /// The constraint of this index holds no longer.
    Release(usize),
    /// The impulse of this index strikes.
    Impulse(usize),
}
