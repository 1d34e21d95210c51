//! What a key can ask for. One name for each thing a person does, whatever key it is on.
//!
//! In: nothing. Out: [`Action`]. Never here: which key it is, or how it is done.

use super::{EditCommand, Page};

/// Something a person wants done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Action {
    /// End the program.
    Quit,
    /// Stop the process, as Ctrl-Z does everywhere.
    Suspend,
    /// Draw every cell anew.
    Repaint,
    /// Show the keys, or hide them.
    Help,
    /// Search all actions by name.
    Palette,
    /// Draw fewer frames in a second.
    FewerFrames,
    /// Draw more frames in a second.
    MoreFrames,
    /// Choose the colours.
    ChooseTheme,
    /// Have the mouse reported, or leave it to the terminal again.
    Mouse,
    /// Leave the innermost thing that is open.
    Back,
    /// Show a page.
    Show(Page),
    /// Read the present on the page of plain reading.
    ReadAnew,
    /// Read it anew by itself, or only when asked.
    ReadOn,
    /// Start or hold time.
    PlayPause,
    /// One single step.
    Step,
    /// Time goes slower.
    Slower,
    /// Time goes faster.
    Faster,
    /// Back to the initial values.
    Reset,
    /// Back to all values of the file.
    FullReset,
    /// Take the gauges' reference anew.
    Reference,
    /// Take back the last change of a value.
    Undo,
    /// Do it again.
    Redo,
    /// Ask for a bracket, or whether something is conserved.
    Ask,
    /// Edit the system's file.
    Edit,
    /// Do something to the text being edited.
    EditCommand(EditCommand),
    /// Write a still of the screen.
    Still,
    /// Write the recorded motion as a table.
    Data,
    /// Record what is shown into a cast, or end the recording.
    Record,
    /// Look from the next frame of the file.
    NextFrame,
    /// Strike an impulse that waits for a key.
    ApplyImpulse,
    /// Choose a method of integration.
    ChooseMethod,
    /// Type the step of a method of fixed step.
    TypeStep,
    /// Type the tolerance of an adaptive method.
    TypeTolerance,
    /// Focus the next pane.
    NextPane,
    /// Focus the previous pane.
    PreviousPane,
    /// Let the focused pane fill the page, or put it back.
    Zoom,
    /// Choose what the focused pane shows.
    ChooseAxes,
    /// Move within the focused thing.
    Move(Direction),
    /// To its first line.
    First,
    /// To its last line.
    Last,
    /// A screenful back.
    PageUp,
    /// A screenful on.
    PageDown,
    /// Change the selected value by a step, up (+1) or down (−1), ten times as much if coarse.
    Change {
        /// +1 or −1.
        sign: i8,
        /// Whether the step is coarse.
        coarse: bool,
    },
    /// Type the selected value.
    TypeValue,
    /// Give the selected value back as the file has it.
    Restore,
    /// Write the present as a file of a system.
    Export,
    /// Look closer.
    Closer(Axes),
    /// Look from farther away.
    Farther(Axes),
    /// Make the axis upwards logarithmic, or linear again.
    Log,
    /// Make a unit as long across as upwards, or let the plot fill its pane again.
    Equal,
    /// Put a cursor on the plot that reads coordinates, or take it away.
    Cursor,
    /// The view as it was at first.
    Home,
    /// Start typing a search.
    Search,
    /// Open what is selected.
    Open,
    /// Accept what is typed or selected.
    Accept,
    /// Mark the selected line besides others.
    Mark,
}

/// A direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the four directions")]
pub enum Direction {
    Up,
    Down,
    Left,
    Right,
}

/// The axes of a plot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "one axis, the other, or both")]
pub enum Axes {
    Both,
    Across,
    Upwards,
}
