//! Hit targets: what a position on the screen shows, for the mouse.
//!
//! In: nothing. Out: [`HitTarget`]s, which `view` finds, and [`Grab`], what the mouse drags. Never here: where
//! anything is on the screen, or what a click does.

use super::{Above, Action, Page, Pane, ValueId};

/// What is under the mouse. Positions are fractions of a picture's width from the left and of its height from
/// below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HitTarget {
    /// The name of a page in the line of tabs.
    Page(Page),
    /// A key's hint.
    Hint(Action),
    /// A page of text.
    Text,
    /// The area of a pop-up list outside its lines.
    Menu,
    /// A line of it, counted among those shown.
    Line(usize),
    /// The area of the list of systems outside its lines.
    Systems,
    /// A system, counted among those shown.
    System(usize),
    /// A row above them.
    Above(Above),
    /// The frame or the name of a pane.
    Pane(Pane),
    /// A value in a list.
    Value(ValueId),
    /// The slider of a value.
    Bar {
        /// The value's identifier.
        target: ValueId,
        /// The value at this column.
        value: f64,
    },
    /// A line of the list of gauges, by its index.
    Gauge(usize),
    /// The time bar, at this time.
    Time(f64),
    /// A spatial view of the motion.
    Space {
        /// Its index among the pictures.
        index: usize,
        /// The position in it.
        place: [f64; 2],
    },
    /// A mass in a picture of a plane that can be dragged.
    Mass {
        /// The index of the picture.
        index: usize,
        /// The index of the mass among its shapes.
        shape: usize,
        /// The position in the picture.
        place: [f64; 2],
        /// The coordinates of the centre of the cell.
        at: [f64; 2],
        /// The window of the picture.
        window: DragWindow,
    },
    /// The inside of a plot's frame.
    Plot {
        /// The index of the plot.
        index: usize,
        /// The position in it.
        place: [f64; 2],
        /// The coordinates of the centre of the cell.
        at: [f64; 2],
    },
}

/// What a picture of a plane shows, and where, so that a drag in it does not depend on what is drawn next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DragWindow {
    /// The ranges of the horizontal and of the vertical axis.
    pub ranges: [[f64; 2]; 2],
    /// The column and the row of its first cell.
    pub corner: [u16; 2],
    /// The number of columns and of rows.
    pub cells: [u16; 2],
}

/// What the mouse drags while its button is down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grab {
    /// The knob of a value's slider.
    Bar(ValueId),
    /// The time bar.
    Time,
    /// A mass.
    Mass {
        /// The index of the picture.
        index: usize,
        /// The index of the mass among its shapes.
        shape: usize,
        /// The window of the picture when the button was pressed, in which the mass is dragged.
        window: DragWindow,
        /// Whether the motion runs again when the mass is let go.
        resumes: bool,
        /// Whether the mass has been moved since the button was pressed.
        moved: bool,
    },
    /// A view of the motion or a plot, which follows the mouse.
    Picture {
        /// Which one of the lab.
        index: usize,
        /// The last position of the mouse.
        place: [f64; 2],
        /// Whether the mouse has moved since the button was pressed.
        moved: bool,
    },
}
