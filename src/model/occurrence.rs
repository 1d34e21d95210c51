//! What happens to a motion at single instants: given impulses, and crossings to be located.

use crate::diagnostic::SourceRange;
use crate::expr::Expr;

/// An impulse: p jumps, q does not.
#[derive(Clone, Debug)]
pub struct Impulse {
    /// As written in the file.
    pub name: String,
    /// The times at which it is applied, in terms of parameters.
    pub times: Vec<Expr>,
    /// The interval at whose multiples after the start it is also applied, in terms of parameters.
    pub period: Option<Expr>,
    /// The applied impulse Q̂ on each coordinate (the jump of each variable of a Poisson system),
    /// as a function of the state before it; zero if there is none.
    pub change: Vec<Expr>,
    /// Its description.
    pub about: String,
}

/// An event: a crossing to be located on the motion.
#[derive(Clone, Debug)]
pub struct MotionEvent {
    /// As written in the file.
    pub name: String,
    /// The expression whose zero crossings are located, written as an observable is.
    pub when: Expr,
    /// Which crossings count.
    pub direction: Direction,
    /// The action it triggers.
    pub action: EventAction,
    /// Its place in the file; `None` for what an option has added.
    pub place: Option<SourceRange>,
}

/// The direction of a zero crossing.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Direction {
    /// From below.
    Rising,
    /// From above.
    Falling,
    /// From either side.
    Either,
}

impl Direction {
    /// All directions.
    pub const ALL: [Direction; 3] = [Direction::Rising, Direction::Falling, Direction::Either];

    /// Its word in files.
    pub fn word(self) -> &'static str {
        match self {
            Direction::Rising => "rising",
            Direction::Falling => "falling",
            Direction::Either => "either",
        }
    }

    /// The direction of a function of −t that has this direction as a function of t.
    #[must_use]
    pub fn reversed(self) -> Direction {
        match self {
            Direction::Rising => Direction::Falling,
            Direction::Falling => Direction::Rising,
            Direction::Either => Direction::Either,
        }
    }
}

/// What happens at a crossing.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum EventAction {
    /// It is only recorded.
    Mark,
    /// The motion ends.
    Stop,
    /// The constraint of this index is released.
    Release(usize),
    /// The impulse of this index is applied.
    Impulse(usize),
    /// The surface of section of this index is crossed, which is recorded for its picture only.
    Section(usize),
}
