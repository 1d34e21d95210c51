//! Spots: what a place on the screen shows, for the mouse.
//!
//! In: nothing. Out: [`HitTarget`]s, which `view` finds, and [`Drag`], what the mouse holds on to. Never here: where anything
//! stands on the screen, or what a click does.

use super::{Action, Page, Pane, ValueId};

/// What is under the mouse. Places are parts of a picture's width from the left and of its height from below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HitTarget {
    /// The name of a page in the line of headings.
    Page(Page),
    /// A key's hint.
    Hint(Action),
    /// A page of text.
    Text,
    /// The lines of a pop-up list, beside all of them.
    Menu,
    /// A line of it, counted among those shown.
    Line(usize),
    /// The list of systems, beside all of them.
    Systems,
    /// A system, counted among those shown.
    System(usize),
    /// The frame or the name of a pane.
    Pane(Pane),
    /// A value in a list.
    Value(ValueId),
    /// The bar of a value.
    Bar {
        /// Whose.
        target: ValueId,
        /// The value that has its knob in this column.
        value: f64,
    },
    /// A gauge.
    Gauge(usize),
    /// A picture of the motion in space.
    Space {
        /// Its place among the pictures.
        index: usize,
        /// Where in it.
        place: [f64; 2],
    },
    /// A plot.
    Plot {
        /// Its place among the pictures.
        index: usize,
        /// Where in it.
        place: [f64; 2],
        /// The coordinates of the middle of the cell.
        at: [f64; 2],
    },
}

/// What the mouse holds while its button is down: it goes with the mouse, wherever that goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drag {
    /// The knob of a value's bar.
    Bar(ValueId),
    /// A picture.
    Picture {
        /// Its place among the pictures.
        index: usize,
        /// Where the mouse was last.
        place: [f64; 2],
        /// Whether it has moved since the button went down.
        moved: bool,
    },
}
