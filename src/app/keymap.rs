//! The table of key bindings: what each key does, where it is active, and what the help says about it.
//!
//! In: a key and the active places. Out: an [`Action`]. The help page, the hints in the footer, the palette and the
//! README's table are generated from [`KEYS`]. Never here: how an action is carried out.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use super::action::{Action, ArrowDirection, AxisChoice};
use super::{EditCommand, Page, key};

/// A context in which a key is active.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Place {
    /// Everywhere, even while text is typed.
    Always,
    /// Wherever no text is being typed.
    Anywhere,
    /// The list of systems.
    Picker,
    /// The search field above that list.
    Search,
    /// Every page of a loaded system.
    Experiment,
    /// The page of panes.
    Lab,
    /// A pane with the motion in space.
    Space,
    /// A pane with axes.
    Plot,
    /// A list of values: parameters or initial values.
    Values,
    /// The list of conserved quantities and their drifts.
    Gauges,
    /// The law of motion.
    Law,
    /// The page of equations.
    Equations,
    /// A page of text, the help included.
    Text,
    /// The key help.
    Help,
    /// The search among its keys, and in a page of text.
    HelpSearch,
    /// What is wrong with a file that cannot be opened.
    Message,
    /// The plain-reading page.
    Plain,
    /// A pop-up list.
    Menu,
    /// The editor of a system's file.
    Workbench,
    /// A field in which a value is typed.
    Field,
    /// Wherever letters are typed as text: fields and searches.
    Typing,
}

impl Place {
    /// Every place, in the order of the help page.
    pub const ALL: [Self; 21] = [
        Self::Anywhere,
        Self::Picker,
        Self::Search,
        Self::Experiment,
        Self::Lab,
        Self::Space,
        Self::Plot,
        Self::Values,
        Self::Gauges,
        Self::Law,
        Self::Equations,
        Self::Text,
        Self::Help,
        Self::HelpSearch,
        Self::Message,
        Self::Plain,
        Self::Menu,
        Self::Workbench,
        Self::Field,
        Self::Typing,
        Self::Always,
    ];

    /// Returns its title on the help page.
    pub fn title(self) -> &'static str {
        match self {
            Self::Always => "Always, also while typing",
            Self::Anywhere => "Anywhere",
            Self::Picker => "Choosing a system",
            Self::Search => "While searching",
            Self::Experiment => "Time and method",
            Self::Lab => "Panes",
            Self::Space => "Motion in space",
            Self::Plot => "Plots",
            Self::Values => "Parameters and initial values",
            Self::Gauges => "Gauges",
            Self::Law => "Law of motion",
            Self::Equations => "Equations",
            Self::Text => "Pages of text",
            Self::Help => "This help",
            Self::HelpSearch => "Searching a text",
            Self::Message => "The errors of a file",
            Self::Plain => "Plain reading",
            Self::Menu => "Pop-up lists",
            Self::Workbench => "Editing the file",
            Self::Field => "Typing a value",
            Self::Typing => "Wherever text is typed",
        }
    }
}

/// The combinations of places that can be active together, the innermost first.
#[rustfmt::skip]
pub const CHAINS: [&[Place]; 17] = {
    use Place::{Always, Anywhere, Equations, Experiment, Field, Gauges, Help, HelpSearch, Lab, Law, Menu, Message, Picker, Plain, Plot, Search, Space, Text, Typing, Values, Workbench};
    [
        &[Picker, Anywhere, Always],
        &[Search, Typing, Always],
        &[Space, Lab, Experiment, Anywhere, Always],
        &[Plot, Lab, Experiment, Anywhere, Always],
        &[Values, Lab, Experiment, Anywhere, Always],
        &[Gauges, Lab, Experiment, Anywhere, Always],
        &[Law, Lab, Experiment, Anywhere, Always],
        &[Equations, Text, Experiment, Anywhere, Always],
        &[Text, Experiment, Anywhere, Always],
        &[Plain, Experiment, Anywhere, Always],
        &[Help, Text, Anywhere, Always],
        &[HelpSearch, Typing, Always],
        &[Message, Text, Anywhere, Always],
        &[Menu, Anywhere, Always],
        &[Menu, Typing, Always],
        &[Field, Typing, Always],
        &[Workbench, Typing, Always],
    ]
};

/// A row of the table.
#[derive(Clone, Copy, Debug)]
pub struct Binding {
    /// The keys; the first one is shown.
    pub keys: &'static [KeyEvent],
    /// Where they are active.
    pub place: Place,
    /// What they do.
    pub action: Action,
    /// One or two words for the footer; empty if the binding is not shown there.
    pub hint: &'static str,
    /// A line for the help page and the palette.
    pub help: &'static str,
}

const fn row(
    place: Place,
    keys: &'static [KeyEvent],
    action: Action,
    hint: &'static str,
    help: &'static str,
) -> Binding {
    Binding { keys, place, action, hint, help }
}

impl Binding {
    /// Returns the names of its keys.
    pub fn key_names(&self) -> Vec<String> {
        self.keys.iter().map(key::name).collect()
    }
}

const fn plain(code: KeyCode) -> KeyEvent {
    KeyEvent::new(code, KeyModifiers::NONE)
}

const fn shift(code: KeyCode) -> KeyEvent {
    KeyEvent::new(code, KeyModifiers::SHIFT)
}

const fn c(character: char) -> KeyEvent {
    plain(KeyCode::Char(character))
}

const fn ctrl(character: char) -> KeyEvent {
    KeyEvent::new(KeyCode::Char(character), KeyModifiers::CONTROL)
}

const fn change(sign: i8, coarse: bool) -> Action {
    Action::Change { sign, coarse }
}

const UP: KeyEvent = plain(KeyCode::Up);
const DOWN: KeyEvent = plain(KeyCode::Down);
const LEFT: KeyEvent = plain(KeyCode::Left);
const RIGHT: KeyEvent = plain(KeyCode::Right);
const ENTER: KeyEvent = plain(KeyCode::Enter);
const ESC: KeyEvent = plain(KeyCode::Esc);
const TAB: KeyEvent = plain(KeyCode::Tab);
const BACKTAB: KeyEvent = shift(KeyCode::BackTab);
const BACKSPACE: KeyEvent = plain(KeyCode::Backspace);
const DELETE: KeyEvent = plain(KeyCode::Delete);
const HOME: KeyEvent = plain(KeyCode::Home);
const END: KeyEvent = plain(KeyCode::End);
const PAGE_UP: KeyEvent = plain(KeyCode::PageUp);
const PAGE_DOWN: KeyEvent = plain(KeyCode::PageDown);
const SHIFT_LEFT: KeyEvent = shift(KeyCode::Left);
const SHIFT_RIGHT: KeyEvent = shift(KeyCode::Right);

/// All key bindings.
#[rustfmt::skip]
pub const KEYS: &[Binding] = &[
    row(Place::Always, &[ctrl('c')], Action::QuitAll, "", "quit, whatever is being typed"),
    row(Place::Always, &[ctrl('z')], Action::Suspend, "", "suspend until the shell's fg"),
    row(Place::Always, &[ctrl('l')], Action::Repaint, "", "redraw the screen"),

    row(Place::Anywhere, &[c('?'), plain(KeyCode::F(1))], Action::Help, "help", "show the help: these keys"),
    row(Place::Anywhere, &[c('q')], Action::Quit, "quit", "quit, or close what lies on top; the session is saved"),
    row(Place::Anywhere, &[c(':')], Action::Palette, "", "search all actions by name"),
    row(Place::Anywhere, &[c('T')], Action::ChooseTheme, "", "choose the theme: the colours of the screen"),
    row(Place::Anywhere, &[plain(KeyCode::F(2))], Action::Guides, "", "take a lesson or watch a demo; q leaves it for the list, Esc closes the list"),
    row(Place::Anywhere, &[ESC], Action::Back, "", "go back: close or shrink; twice in the lab: to the list of systems"),

    row(Place::Picker, &[UP], Action::Move(ArrowDirection::Up), "", "the system above"),
    row(Place::Picker, &[DOWN], Action::Move(ArrowDirection::Down), "choose", "the system below"),
    row(Place::Picker, &[PAGE_UP], Action::PageUp, "", "ten systems up"),
    row(Place::Picker, &[PAGE_DOWN], Action::PageDown, "", "ten systems down"),
    row(Place::Picker, &[HOME], Action::First, "", "the first system"),
    row(Place::Picker, &[END], Action::Last, "", "the last system"),
    row(Place::Picker, &[ENTER], Action::Open, "open", "open the system in the lab"),
    row(Place::Picker, &[c('/')], Action::Search, "search", "search by name, topic or summary; any other letter begins it too"),

    row(Place::Picker, &[ctrl('n')], Action::NewSystem, "new", "begin a new system, a file of your own, in the editor; nothing is written until it is saved"),

    row(Place::Search, &[UP], Action::Move(ArrowDirection::Up), "", "the match above"),
    row(Place::Search, &[DOWN, TAB], Action::Move(ArrowDirection::Down), "choose", "the match below"),
    row(Place::Search, &[PAGE_UP], Action::PageUp, "", "ten matches up"),
    row(Place::Search, &[PAGE_DOWN], Action::PageDown, "", "ten matches down"),
    row(Place::Search, &[HOME], Action::First, "", "the first match"),
    row(Place::Search, &[END], Action::Last, "", "the last match"),
    row(Place::Search, &[ENTER], Action::Open, "open", "open the match in the lab"),

    row(Place::Experiment, &[c(' '), c('p')], Action::PlayPause, "pause", "pause or resume"),
    row(Place::Experiment, &[c('.')], Action::Step, "step", "step forward by one frame, 1/60 s at this speed, and pause"),
    row(Place::Experiment, &[c(',')], Action::StepBack, "", "step back by one frame, exactly to where the motion was, and pause"),
    row(Place::Experiment, &[c('Z')], Action::Reverse, "", "reverse time: from here on the motion runs backwards by the same method, and is compared with where it was"),
    row(Place::Experiment, &[c('(')], Action::LookEarlier, "", "pause and look at an earlier time of the recorded past; so does the mouse on the time bar"),
    row(Place::Experiment, &[c(')')], Action::LookLater, "", "look at a later time, up to the current one; what acts on the motion continues it from the time shown"),
    row(Place::Experiment, &[c(';')], Action::MarkTime, "", "set a mark at the time shown, or remove the one there"),
    row(Place::Experiment, &[c('\'')], Action::GoToMark, "", "go to the previous mark, from the first to the last"),
    row(Place::Experiment, &[c('"')], Action::GoToNextMark, "", "go to the next mark, from the last to the first"),
    row(Place::Experiment, &[c('[')], Action::Slower, "slower", "go slower"),
    row(Place::Experiment, &[c(']')], Action::Faster, "faster", "go faster; beyond ×1000, as fast as possible"),
    row(Place::Experiment, &[c('r')], Action::Reset, "reset", "reset to the initial values; parameters stay as they are"),
    row(Place::Experiment, &[c('R')], Action::FullReset, "", "reset to all values of the file"),
    row(Place::Experiment, &[c('e')], Action::Reference, "", "measure the drift of energy and all gauges from here"),
    row(Place::Experiment, &[c('m')], Action::ChooseMethod, "method", "choose the method of integration"),
    row(Place::Experiment, &[c('s')], Action::TypeStep, "", "type the step of a method of fixed step"),
    row(Place::Experiment, &[c('a')], Action::TypeTolerance, "", "type the accuracy (tolerance) of an adaptive method"),
    row(Place::Experiment, &[c('u')], Action::Undo, "", "undo the last change of a value, method or picture"),
    row(Place::Experiment, &[c('U'), ctrl('r')], Action::Redo, "", "redo the last undone change"),
    row(Place::Experiment, &[c('{'), c('i')], Action::Ask, "ask", "ask for a bracket [f, g], or whether something is an invariant"),
    row(Place::Experiment, &[c('I')], Action::SearchFurther, "", "search for constants of the motion; each time further: to a higher degree, for longer"),
    row(Place::Experiment, &[c('B')], Action::Brackets, "", "show or hide the table of brackets of the constants of the motion"),
    row(Place::Experiment, &[c('J')], Action::ApplyFlow, "", "carry the state along the flow of a constant of the motion, of a generator of the file or your own, or of a symmetry"),
    row(Place::Experiment, &[c('P')], Action::Pin, "", "pin this run: it continues beside what follows, with its values and its method"),
    row(Place::Experiment, &[c('d')], Action::AddNeighbour, "", "add a neighbour, a motion that starts close by, and show how they separate: ln d against time"),
    row(Place::Experiment, &[c('F')], Action::Equilibria, "", "find equilibria and their small oscillations, and start at one or along a mode"),
    row(Place::Experiment, &[c('V')], Action::Exponents, "", "measure the Lyapunov exponent of the motion: regular or chaotic"),
    row(Place::Experiment, &[c('K')], Action::Ensemble, "", "carry an ensemble of starts along with the motion: its density, and the action ∫ p dq around it"),
    row(Place::Experiment, &[c('t')], Action::PeriodicOrbit, "", "find the periodic orbit near the motion: period, action, multipliers; again: near its current state"),
    row(Place::Experiment, &[c('w')], Action::Spectrum, "", "find the frequencies ω of the motion: lines, and what they are combinations of"),
    row(Place::Experiment, &[c('C')], Action::ClearCompanions, "", "clear all motions beside the main one"),
    row(Place::Experiment, &[c('W')], Action::Export, "", "write a preset file of the system as it is now, with every changed value"),
    row(Place::Experiment, &[c('E')], Action::Edit, "edit", "edit the system's file while it runs; the motion follows the text"),
    row(Place::Experiment, &[ctrl('n')], Action::NewSystem, "", "begin a new system, a file of your own, in the editor; this motion can be continued from the list of systems"),
    row(Place::Experiment, &[c('S')], Action::Still, "", "write a screenshot (a drawing, SVG) into the current folder"),
    row(Place::Experiment, &[c('D')], Action::Data, "", "write a table (CSV) into the current folder: what the focused diagram, map or section has computed, otherwise the motion so far"),
    row(Place::Experiment, &[c('O')], Action::Record, "", "record the screen into a cast in the current folder, or end the recording"),
    row(Place::Experiment, &[c('1')], Action::Show(Page::Lab), "", "show page 1: the lab"),
    row(Place::Experiment, &[c('2')], Action::Show(Page::Equations), "", "show page 2: what follows from L or H"),
    row(Place::Experiment, &[c('3')], Action::Show(Page::Notes), "", "show page 3: notes, source and expectations"),
    row(Place::Experiment, &[c('4')], Action::Show(Page::Numbers), "", "show page 4: energy, momenta and every other quantity as numbers"),
    row(Place::Experiment, &[c('<')], Action::FewerFrames, "", "lower the frame rate, for a slow connection"),
    row(Place::Experiment, &[c('>')], Action::MoreFrames, "", "raise the frame rate"),
    row(Place::Experiment, &[c('M')], Action::Mouse, "", "use the mouse here, or leave it to the terminal to select text"),

    row(Place::Experiment, &[c('9')], Action::Show(Page::Plain), "", "show page 9: the screen as plain text that does not move, to be read line by line"),

    row(Place::Lab, &[TAB], Action::NextPane, "pane", "focus the next pane in view"),
    row(Place::Lab, &[BACKTAB], Action::PreviousPane, "", "focus the previous pane in view"),
    row(Place::Lab, &[c('\\')], Action::NextTab, "tabs", "show the next of the tabs: the panes that share a frame"),
    row(Place::Lab, &[c('/')], Action::Palette, "", "search all actions by name, as : does"),
    row(Place::Lab, &[c('b')], Action::ApplyImpulse, "impulse", "apply an impulse that waits for a key"),
    row(Place::Lab, &[c('f')], Action::NextFrame, "frame", "view the motion in space in the next reference frame of the file, or in the original one again"),
    row(Place::Lab, &[c('Q')], Action::Active, "", "switch between the active view of a transformation (the point moves) and the passive one (the coordinates do); of an action, the next principle: Hamilton, Maupertuis, phase space; of a diagram, frequency or period"),
    row(Place::Lab, &[c('z')], Action::Zoom, "zoom", "zoom the focused pane until it fills the page, or put it back"),

    row(Place::Space, &[LEFT, c('h')], Action::Move(ArrowDirection::Left), "turn", "turn the picture to the left"),
    row(Place::Space, &[RIGHT, c('l')], Action::Move(ArrowDirection::Right), "", "turn the picture to the right"),
    row(Place::Space, &[UP, c('k')], Action::Move(ArrowDirection::Up), "", "look from higher up"),
    row(Place::Space, &[DOWN, c('j')], Action::Move(ArrowDirection::Down), "", "look from lower down"),
    row(Place::Space, &[c('+'), c('=')], Action::Closer(AxisChoice::Both), "closer", "look closer"),
    row(Place::Space, &[c('-')], Action::Farther(AxisChoice::Both), "", "look from further away"),
    row(Place::Space, &[HOME, c('0')], Action::Home, "", "return to the initial view"),
    row(Place::Space, &[c('c')], Action::Cursor, "", "show the cursor of the nearest plot, which gets the focus"),
    row(Place::Space, &[ENTER, c('v')], Action::ChooseAxes, "view", "choose the view that this pane shows"),

    row(Place::Plot, &[c('v')], Action::ChooseAxes, "axes", "choose what this pane shows: the variables on its axes"),
    row(Place::Plot, &[ENTER], Action::StartHere, "", "begin the motion at the cursor; without a cursor, choose what this pane shows"),
    row(Place::Plot, &[c('A'), shift(KeyCode::Enter)], Action::AddStart, "", "add a motion beside the others that begins at the cursor; so does Shift-click, or the right button"),
    row(Place::Plot, &[c('n')], Action::AddOrbits, "", "add orbits to a section: the one through the cursor, or several over the visible part; start an ensemble there, and again to spread it over its energy shell"),
    row(Place::Plot, &[c('L')], Action::TypeSurface, "", "type the surface of a section: x = 0, rising; every 2*pi/w; event NAME; a plot without one becomes a section"),
    row(Place::Plot, &[c('|')], Action::TurnDirection, "", "choose the direction in which a section is crossed: rising, falling, either"),
    row(Place::Plot, &[c('G')], Action::FillSection, "", "fill the visible part of a section: a hundred orbits of 120 crossings each"),
    row(Place::Plot, &[c('N')], Action::ClearOrbits, "", "clear a section: the orbits added to it, and the past crossings of the motion"),
    row(Place::Plot, &[c('+'), c('=')], Action::Closer(AxisChoice::Both), "closer", "look closer"),
    row(Place::Plot, &[c('-')], Action::Farther(AxisChoice::Both), "", "look from further away"),
    row(Place::Plot, &[c('x')], Action::Closer(AxisChoice::Across), "", "stretch the horizontal axis"),
    row(Place::Plot, &[c('X')], Action::Farther(AxisChoice::Across), "", "shrink the horizontal axis"),
    row(Place::Plot, &[c('y')], Action::Closer(AxisChoice::Upwards), "", "stretch the vertical axis"),
    row(Place::Plot, &[c('Y')], Action::Farther(AxisChoice::Upwards), "", "shrink the vertical axis"),
    row(Place::Plot, &[c('g')], Action::Log, "", "make the vertical axis logarithmic, or linear again"),
    row(Place::Plot, &[c('o')], Action::Equal, "", "make the scales of both axes equal, or fill the pane again"),
    row(Place::Plot, &[c('H')], Action::ByChaos, "", "colour the orbits of a section by whether they are regular or chaotic, or each in its own colour"),
    row(Place::Plot, &[c('c')], Action::Cursor, "cursor", "show or hide a cursor on the plot that reads coordinates"),
    row(Place::Plot, &[LEFT, c('h')], Action::Move(ArrowDirection::Left), "move", "move the window, or the cursor, to the left"),
    row(Place::Plot, &[RIGHT, c('l')], Action::Move(ArrowDirection::Right), "", "move the window, or the cursor, to the right"),
    row(Place::Plot, &[UP, c('k')], Action::Move(ArrowDirection::Up), "", "move the window, or the cursor, up"),
    row(Place::Plot, &[DOWN, c('j')], Action::Move(ArrowDirection::Down), "", "move the window, or the cursor, down"),
    row(Place::Plot, &[HOME, c('0')], Action::Home, "", "show the whole motion, as at the beginning"),

    row(Place::Values, &[UP, c('k')], Action::Move(ArrowDirection::Up), "", "the value above"),
    row(Place::Values, &[DOWN, c('j')], Action::Move(ArrowDirection::Down), "choose", "the value below"),
    row(Place::Values, &[PAGE_UP], Action::PageUp, "", "ten values up"),
    row(Place::Values, &[PAGE_DOWN], Action::PageDown, "", "ten values down"),
    row(Place::Values, &[HOME], Action::First, "", "the first value"),
    row(Place::Values, &[END], Action::Last, "", "the last value"),
    row(Place::Values, &[LEFT, c('h')], change(-1, false), "", "less, by a fine step"),
    row(Place::Values, &[RIGHT, c('l')], change(1, false), "change", "more, by a fine step"),
    row(Place::Values, &[SHIFT_LEFT, c('H'), c('-')], change(-1, true), "", "less, by a coarse step"),
    row(Place::Values, &[SHIFT_RIGHT, c('L'), c('+'), c('=')], change(1, true), "", "more, by a coarse step"),
    row(Place::Values, &[ENTER], Action::TypeValue, "type", "type the value: a number or an expression, such as pi, sqrt(2) or 2*l"),
    row(Place::Values, &[c('v')], Action::Diagram, "", "show how the motion depends on this parameter or initial value: a bifurcation diagram where the file has a surface of section, otherwise the Lyapunov exponent; the frequency where a single coordinate keeps its energy"),
    row(Place::Values, &[c('g')], Action::Ramp, "", "ramp this parameter gradually to another value in a given time; a slow ramp conserves J, which is shown"),
    row(Place::Values, &[c('c')], Action::Cursor, "", "show the cursor of the nearest plot, which gets the focus"),
    row(Place::Values, &[BACKSPACE, DELETE], Action::Restore, "", "restore the value of the file"),

    row(Place::Gauges, &[UP, c('k')], Action::Move(ArrowDirection::Up), "", "the gauge above"),
    row(Place::Gauges, &[DOWN, c('j')], Action::Move(ArrowDirection::Down), "choose", "the gauge below"),
    row(Place::Gauges, &[PAGE_UP], Action::PageUp, "", "ten gauges up"),
    row(Place::Gauges, &[PAGE_DOWN], Action::PageDown, "", "ten gauges down"),
    row(Place::Gauges, &[HOME], Action::First, "", "the first gauge"),
    row(Place::Gauges, &[END], Action::Last, "", "the last gauge"),
    row(Place::Gauges, &[c('c')], Action::Cursor, "", "show the cursor of the nearest plot, which gets the focus"),

    row(Place::Law, &[UP, c('k')], Action::Move(ArrowDirection::Up), "", "a line up"),
    row(Place::Law, &[DOWN, c('j')], Action::Move(ArrowDirection::Down), "scroll", "a line down"),
    row(Place::Law, &[PAGE_UP], Action::PageUp, "", "ten lines up"),
    row(Place::Law, &[PAGE_DOWN], Action::PageDown, "", "ten lines down"),
    row(Place::Law, &[HOME], Action::First, "", "to the beginning"),
    row(Place::Law, &[END], Action::Last, "", "to the end"),
    row(Place::Law, &[c('c')], Action::Cursor, "", "show the cursor of the nearest plot, which gets the focus"),

    row(Place::Equations, &[c('y')], Action::CopyLatex, "copy", "copy the equations as LaTeX, or write them into a file where the terminal has no clipboard"),

    row(Place::Text, &[UP, c('k')], Action::Move(ArrowDirection::Up), "", "a line up"),
    row(Place::Text, &[DOWN, c('j')], Action::Move(ArrowDirection::Down), "scroll", "a line down"),
    row(Place::Text, &[PAGE_UP, c('b')], Action::PageUp, "", "a page up"),
    row(Place::Text, &[PAGE_DOWN, c('f')], Action::PageDown, "", "a page down"),
    row(Place::Text, &[HOME, c('g')], Action::First, "", "to the beginning"),
    row(Place::Text, &[END, c('G')], Action::Last, "", "to the end"),

    row(Place::Text, &[c('/')], Action::Search, "search", "search the text, or the keys in this help; a capital letter matches itself only"),
    row(Place::Text, &[c('n')], Action::NextMatch, "", "the next match in a page of text"),
    row(Place::Text, &[c('N')], Action::PreviousMatch, "", "the previous match in a page of text"),

    row(Place::HelpSearch, &[UP], Action::Move(ArrowDirection::Up), "", "a line up"),
    row(Place::HelpSearch, &[DOWN], Action::Move(ArrowDirection::Down), "scroll", "a line down"),
    row(Place::HelpSearch, &[PAGE_UP], Action::PageUp, "", "a page up"),
    row(Place::HelpSearch, &[PAGE_DOWN], Action::PageDown, "", "a page down"),
    row(Place::HelpSearch, &[HOME], Action::First, "", "to the beginning"),
    row(Place::HelpSearch, &[END], Action::Last, "", "to the end"),
    row(Place::HelpSearch, &[ENTER], Action::Accept, "keep", "keep the matches and stop typing"),

    row(Place::Message, &[c('E')], Action::Edit, "edit", "edit the file, at its first error; once it has none the motion begins"),

    row(Place::Plain, &[ENTER], Action::ReadAnew, "read", "read the current state"),
    row(Place::Plain, &[c('A')], Action::ReadOn, "by itself", "read the current state by itself, every two seconds, or only when asked"),
    row(Place::Plain, &[UP, c('k')], Action::Move(ArrowDirection::Up), "", "the line above"),
    row(Place::Plain, &[DOWN, c('j')], Action::Move(ArrowDirection::Down), "line", "the line below"),
    row(Place::Plain, &[PAGE_UP], Action::PageUp, "", "a page up"),
    row(Place::Plain, &[PAGE_DOWN], Action::PageDown, "", "a page down"),
    row(Place::Plain, &[HOME, c('g')], Action::First, "", "the first line"),
    row(Place::Plain, &[END, c('G')], Action::Last, "", "the last line"),

    row(Place::Menu, &[UP], Action::Move(ArrowDirection::Up), "", "the line above"),
    row(Place::Menu, &[DOWN], Action::Move(ArrowDirection::Down), "choose", "the line below"),
    row(Place::Menu, &[PAGE_UP], Action::PageUp, "", "ten lines up"),
    row(Place::Menu, &[PAGE_DOWN], Action::PageDown, "", "ten lines down"),
    row(Place::Menu, &[HOME], Action::First, "", "the first line"),
    row(Place::Menu, &[END], Action::Last, "", "the last line"),
    row(Place::Menu, &[TAB], Action::Mark, "mark", "mark the line, where several can be selected"),
    row(Place::Menu, &[ENTER], Action::Accept, "select", "select the line"),

    row(Place::Workbench, &[ctrl('s')], Action::EditCommand(EditCommand::Save), "save", "save the file; for a shipped system, a copy under a name of your own"),
    row(Place::Workbench, &[ctrl('n'), plain(KeyCode::F(8))], Action::EditCommand(EditCommand::Diagnostic(1)), "error", "go to the next error"),
    row(Place::Workbench, &[ctrl('p')], Action::EditCommand(EditCommand::Diagnostic(-1)), "", "go to the previous error"),
    row(Place::Workbench, &[ctrl('f')], Action::EditCommand(EditCommand::Find), "find", "find words in the text"),
    row(Place::Workbench, &[ctrl('g'), plain(KeyCode::F(3))], Action::EditCommand(EditCommand::FindNext), "", "find the next match"),
    row(Place::Workbench, &[ctrl('u')], Action::EditCommand(EditCommand::Undo), "undo", "undo the last change of the text"),
    row(Place::Workbench, &[ctrl('r')], Action::EditCommand(EditCommand::Redo), "", "redo the last undone change"),
    row(Place::Workbench, &[ctrl('x')], Action::EditCommand(EditCommand::Cut), "cut", "cut what is selected (Shift and arrows), or else the line"),
    row(Place::Workbench, &[ctrl('y')], Action::EditCommand(EditCommand::Copy), "", "copy it"),
    row(Place::Workbench, &[ctrl('v')], Action::EditCommand(EditCommand::PutBack), "", "paste what was cut or copied last"),
    row(Place::Workbench, &[ctrl('o')], Action::EditCommand(EditCommand::Reread), "", "reload the file from disk; for a shipped system, its original text"),

    row(Place::Field, &[ENTER], Action::Accept, "accept", "accept what is typed"),

    row(Place::Typing, &[plain(KeyCode::F(1))], Action::Help, "help", "show the help, then continue typing"),
    row(Place::Typing, &[ESC], Action::Back, "cancel", "cancel, or close the list; q is a letter here"),
];

/// Returns the action of a key where these places are active, the innermost first.
pub fn action(key: KeyEvent, places: &[Place]) -> Option<Action> {
    let holds = |row: &&Binding| places.contains(&row.place) && row.keys.contains(&key);
    KEYS.iter().find(holds).map(|row| row.action)
}
