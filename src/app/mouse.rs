//! The mouse as the application knows it, free of any terminal library.
//!
//! In: what the shell reads. Out: [`Mouse`]. Never here: what lies at a place, or what a click there does.

/// Something done with the mouse. Only the left button and the wheel are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Mouse {
    /// The column it happened in, from 0.
    pub column: u16,
    /// The row, from 0 at the top.
    pub row: u16,
    /// What was done.
    pub act: Act,
}

/// What was done with the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Act {
    /// The left button went down.
    Press,
    /// It moved while the left button was down.
    Drag,
    /// The left button came up.
    Release,
    /// The wheel was turned away from the person.
    WheelUp,
    /// The wheel was turned towards the person.
    WheelDown,
}
