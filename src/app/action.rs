//! The actions that keys and the palette trigger: one name for each, whatever key it is bound to.
//!
//! In: nothing. Out: [`Action`]. Never here: the key bindings, or how an action is carried out.

use super::Page;

/// Something the user asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Action {
    /// End the program.
    Quit,
    /// Leave the program, whatever lies over the page.
    QuitAll,
    /// Suspend the process, as Ctrl-Z does in a shell.
    Suspend,
    /// Redraw every cell.
    Repaint,
    /// Show or hide the key help.
    Help,
    /// Search all actions by name.
    Palette,
    /// Draw fewer frames per second.
    FewerFrames,
    /// Draw more frames per second.
    MoreFrames,
    /// Choose a colour theme.
    ChooseTheme,
    /// Capture the mouse, or leave it to the terminal again.
    Mouse,
    /// Leave the innermost open element.
    Back,
    /// Show a page.
    Show(Page),
    /// Read the current state on the plain-reading page.
    ReadAnew,
    /// Turn automatic re-reading on or off.
    ReadOn,
    /// Run or pause the simulation.
    PlayPause,
    /// Take a single integration step.
    Step,
    /// Take a single step back.
    StepBack,
    /// Reverse time.
    Reverse,
    /// Look at an earlier time of the recorded past.
    ShowEarlier,
    /// Look at a later time of the recorded past.
    ShowLater,
    /// Set a mark at the time that is seen, or take it away.
    MarkTime,
    /// Look at the mark before.
    GoToMark,
    /// Look at the mark after.
    GoToNextMark,
    /// Slow the simulation down.
    Slower,
    /// Speed the simulation up.
    Faster,
    /// Return to the initial values.
    Reset,
    /// Return to all values of the file.
    FullReset,
    /// Reset the gauges' reference.
    Reference,
    /// Undo the last change.
    Undo,
    /// Redo the change undone last.
    Redo,
    /// Ask for a Poisson bracket, or whether a quantity is conserved.
    Ask,
    /// Search further for constants of the motion.
    SearchFurther,
    /// Open or close the table of brackets of the constants of the motion.
    Brackets,
    /// Carry the state along the flow of a constant of the motion.
    ApplyFlow,
    /// Let the selected parameter go to another value in the course of time.
    Ramp,
    /// Edit the system's file.
    Edit,
    /// Begin a system of one's own in the editor.
    NewSystem,
    /// List the lessons and demos.
    Guides,
    /// Apply an editor command to the text being edited.
    EditCommand(EditCommand),
    /// Save a still image of the screen.
    Still,
    /// Copy the command line that opens the lab as it is set.
    Share,
    /// Copy the equations as LaTeX.
    CopyLatex,
    /// Export the recorded motion as a table.
    Data,
    /// Start or stop recording the screen as a cast.
    Record,
    /// Switch to the next reference frame of the file.
    NextFrame,
    /// Apply an impulse that is triggered by a key.
    ApplyImpulse,
    /// Choose a method of integration.
    ChooseMethod,
    /// Type the step of a fixed-step method.
    TypeStep,
    /// Type the tolerance of an adaptive method.
    TypeTolerance,
    /// Focus the next pane.
    NextPane,
    /// Bring the next match of the search in a page into view.
    NextMatch,
    /// Bring the match before into view.
    PreviousMatch,
    /// Show the next of the panes that share a frame.
    NextTab,
    /// Focus the previous pane.
    PreviousPane,
    /// Zoom the focused pane to fill the page, or restore it.
    Zoom,
    /// Choose what the focused pane shows.
    ChooseAxes,
    /// Begin the motion at the cursor of the focused plot, or choose what it shows.
    StartHere,
    /// Add a motion that begins at the cursor of the focused plot beside the others.
    AddStart,
    /// Add a motion that begins close beside the main one, and show their separation.
    AddNeighbour,
    /// Look for equilibria in the background, and list them.
    Equilibria,
    /// Show the largest Lyapunov exponent of the motion, measured in the background.
    Exponents,
    /// Carry a cloud of starts along with the motion, as a density with ∮ p dq around it.
    Ensemble,
    /// Find the periodic orbit near the motion; again where it is shown: near where the motion is now.
    PeriodicOrbit,
    /// Find the frequencies of the motion.
    Spectrum,
    /// Shows what becomes of the motion over the range of the selected parameter.
    Diagram,
    /// Lets a transformation move the point in place of the coordinates, or the coordinates again.
    Active,
    /// Show or hide the vector field of a phase portrait, with its nullclines.
    VectorField,
    /// Colours the orbits of a section by whether they are regular, or each in its own colour.
    ByChaos,
    /// Keep the current run beside what follows.
    Pin,
    /// Remove all motions beside the main one.
    ClearCompanions,
    /// Add orbits to a section: the one through its cursor, or some spread over what is seen.
    AddOrbits,
    /// Type the surface of a section.
    TypeSurface,
    /// Count the crossings of a section in the next direction.
    TurnDirection,
    /// Fill what is seen of a section with many orbits.
    FillSection,
    /// Remove the orbits that were added to a section, and the past crossings of the motion.
    ClearOrbits,
    /// Move within the focused element.
    Move(ArrowDirection),
    /// Go to the first line.
    First,
    /// Go to the last line.
    Last,
    /// Go one page up.
    PageUp,
    /// Go one page down.
    PageDown,
    /// Change the selected value by one step, up (+1) or down (−1); a coarse step is ten times as large.
    Change {
        /// +1 or −1.
        sign: i8,
        /// Whether the step is coarse.
        coarse: bool,
    },
    /// Type the selected value.
    TypeValue,
    /// Restore the selected value to the one in the file.
    Restore,
    /// Export the current state as a system file.
    Export,
    /// Zoom in.
    Closer(AxisChoice),
    /// Zoom out.
    Farther(AxisChoice),
    /// Switch the vertical axis between logarithmic and linear.
    Log,
    /// Give both axes the same scale, or let the plot fill its pane again.
    Equal,
    /// Show or hide a cursor that reads coordinates off the plot.
    Cursor,
    /// Restore the initial view.
    Home,
    /// Start typing a search.
    Search,
    /// Open the selected item.
    Open,
    /// Accept the typed text or the selected item.
    Accept,
    /// Mark the selected line, in addition to others.
    Mark,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the four directions")]
pub enum ArrowDirection {
    Up,
    Down,
    Left,
    Right,
}

impl ArrowDirection {
    /// Returns a unit step: to the right, and up.
    pub(super) fn step(self) -> [f64; 2] {
        match self {
            Self::Left => [-1.0, 0.0],
            Self::Right => [1.0, 0.0],
            Self::Up => [0.0, 1.0],
            Self::Down => [0.0, -1.0],
        }
    }
}

/// The axes of a plot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "one axis, the other, or both")]
pub enum AxisChoice {
    Both,
    Across,
    Upwards,
}

impl AxisChoice {
    /// Returns whether the horizontal axis is meant, and whether the vertical one is.
    pub(super) fn chosen(self) -> [bool; 2] {
        [self != Self::Upwards, self != Self::Across]
    }
}

/// A command of the editor, besides typing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EditCommand {
    /// Write it to its file.
    Save,
    /// Search for a text.
    Find,
    /// Search for it again.
    FindNext,
    /// Go to the next error (+1) or the previous one (−1).
    Diagnostic(i8),
    /// Cut the selection, or the line.
    Cut,
    /// Copy the selection, or the line.
    Copy,
    /// Paste what was cut or copied.
    PutBack,
    /// Undo the last change.
    Undo,
    /// Make again the change undone last.
    Redo,
    /// Read the file again.
    Reread,
}
