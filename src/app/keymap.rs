//! The table of key bindings: what each key does, where it is active, and what the help says about it.
//!
//! In: a key and the active contexts. Out: an [`Action`]. The help page, the hints in the footer, the palette and the
//! README's table are generated from [`KEYS`]. Never here: how an action is carried out.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

use super::action::{Action, ArrowDirection, AxisChoice};
use super::{EditCommand, Page, key};

/// A context in which a key is active.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum KeyContext {
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

impl KeyContext {
    /// Every context, in the order of the help page.
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

/// The combinations of contexts that can be active together, the innermost first.
#[rustfmt::skip]
pub const CHAINS: [&[KeyContext]; 17] = {
    use KeyContext::{Always, Anywhere, Equations, Experiment, Field, Gauges, Help, HelpSearch, Lab, Law, Menu, Message, Picker, Plain, Plot, Search, Space, Text, Typing, Values, Workbench};
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
    pub context: KeyContext,
    /// What they do.
    pub action: Action,
    /// One or two words for the footer; empty if the binding is not shown there.
    pub hint: &'static str,
    /// A line for the help page and the palette.
    pub help: &'static str,
}

const fn row(
    context: KeyContext,
    keys: &'static [KeyEvent],
    action: Action,
    hint: &'static str,
    help: &'static str,
) -> Binding {
    Binding { keys, context, action, hint, help }
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
    row(KeyContext::Always, &[ctrl('c')], Action::QuitAll, "", "quit, whatever is being typed"),
    row(KeyContext::Always, &[ctrl('z')], Action::Suspend, "", "suspend until the shell's fg"),
    row(KeyContext::Always, &[ctrl('l')], Action::Repaint, "", "redraw the screen"),

    row(KeyContext::Anywhere, &[c('?'), plain(KeyCode::F(1))], Action::Help, "help", "show the help: these keys"),
    row(KeyContext::Anywhere, &[c('q')], Action::Quit, "quit", "quit, or close what lies on top; the session is saved"),
    row(KeyContext::Anywhere, &[c(':')], Action::Palette, "", "search all actions by name"),
    row(KeyContext::Anywhere, &[c('T')], Action::ChooseTheme, "", "choose the theme: the colours of the screen"),
    row(KeyContext::Anywhere, &[plain(KeyCode::F(2))], Action::Guides, "", "take a lesson or watch a demo; q leaves it for the list, Esc closes the list"),
    row(KeyContext::Anywhere, &[ESC], Action::Back, "", "go back: close or shrink; twice in the lab: to the list of systems"),

    row(KeyContext::Picker, &[UP], Action::Move(ArrowDirection::Up), "", "the system above"),
    row(KeyContext::Picker, &[DOWN], Action::Move(ArrowDirection::Down), "choose", "the system below"),
    row(KeyContext::Picker, &[PAGE_UP], Action::PageUp, "", "ten systems up"),
    row(KeyContext::Picker, &[PAGE_DOWN], Action::PageDown, "", "ten systems down"),
    row(KeyContext::Picker, &[HOME], Action::First, "", "the first system"),
    row(KeyContext::Picker, &[END], Action::Last, "", "the last system"),
    row(KeyContext::Picker, &[ENTER], Action::Open, "open", "open the system in the lab"),
    row(KeyContext::Picker, &[c('/')], Action::Search, "search", "search by name, topic or summary; any other letter begins it too"),

    row(KeyContext::Picker, &[ctrl('n')], Action::NewSystem, "new", "begin a new system, a file of your own, in the editor; nothing is written until it is saved"),

    row(KeyContext::Search, &[UP], Action::Move(ArrowDirection::Up), "", "the match above"),
    row(KeyContext::Search, &[DOWN, TAB], Action::Move(ArrowDirection::Down), "choose", "the match below"),
    row(KeyContext::Search, &[PAGE_UP], Action::PageUp, "", "ten matches up"),
    row(KeyContext::Search, &[PAGE_DOWN], Action::PageDown, "", "ten matches down"),
    row(KeyContext::Search, &[HOME], Action::First, "", "the first match"),
    row(KeyContext::Search, &[END], Action::Last, "", "the last match"),
    row(KeyContext::Search, &[ENTER], Action::Open, "open", "open the match in the lab"),

    row(KeyContext::Experiment, &[c(' '), c('p')], Action::PlayPause, "pause", "pause or resume"),
    row(KeyContext::Experiment, &[c('.')], Action::Step, "step", "step forward by one frame, 1/60 s at this speed, and pause"),
    row(KeyContext::Experiment, &[c(',')], Action::StepBack, "", "step back by one frame, exactly to where the motion was, and pause"),
    row(KeyContext::Experiment, &[c('Z')], Action::Reverse, "", "reverse time: from here on the motion runs backwards by the same method, and is compared with where it was"),
    row(KeyContext::Experiment, &[c('(')], Action::ShowEarlier, "", "pause and look at an earlier time of the recorded past; so does the mouse on the time bar"),
    row(KeyContext::Experiment, &[c(')')], Action::ShowLater, "", "look at a later time, up to the current one; what acts on the motion continues it from the time shown"),
    row(KeyContext::Experiment, &[c(';')], Action::MarkTime, "", "set a mark at the time shown, or remove the one there"),
    row(KeyContext::Experiment, &[c('\'')], Action::GoToMark, "", "go to the previous mark, from the first to the last"),
    row(KeyContext::Experiment, &[c('"')], Action::GoToNextMark, "", "go to the next mark, from the last to the first"),
    row(KeyContext::Experiment, &[c('[')], Action::Slower, "slower", "go slower"),
    row(KeyContext::Experiment, &[c(']')], Action::Faster, "faster", "go faster; beyond ×1000, as fast as possible"),
    row(KeyContext::Experiment, &[c('r')], Action::Reset, "reset", "reset to the initial values; parameters stay as they are"),
    row(KeyContext::Experiment, &[c('R')], Action::FullReset, "", "reset to all values of the file"),
    row(KeyContext::Experiment, &[c('e')], Action::Reference, "", "measure the drift of energy and all gauges from here"),
    row(KeyContext::Experiment, &[c('m')], Action::ChooseMethod, "method", "choose the method of integration"),
    row(KeyContext::Experiment, &[c('s')], Action::TypeStep, "", "type the step of a fixed-step method"),
    row(KeyContext::Experiment, &[c('a')], Action::TypeTolerance, "", "type the accuracy (tolerance) of an adaptive method"),
    row(KeyContext::Experiment, &[c('u')], Action::Undo, "", "undo the last change of a value, method or picture"),
    row(KeyContext::Experiment, &[c('U'), ctrl('r')], Action::Redo, "", "redo the last undone change"),
    row(KeyContext::Experiment, &[c('{'), c('i')], Action::Ask, "ask", "ask for a bracket [f, g], or whether something is an invariant"),
    row(KeyContext::Experiment, &[c('I')], Action::SearchFurther, "", "search for constants of the motion; each time further: to a higher degree, for longer"),
    row(KeyContext::Experiment, &[c('B')], Action::Brackets, "", "show or hide the table of brackets of the constants of the motion"),
    row(KeyContext::Experiment, &[c('J')], Action::ApplyFlow, "", "carry the state along the flow of a constant of the motion, of a generator of the file or your own, or of a symmetry"),
    row(KeyContext::Experiment, &[c('P')], Action::Pin, "", "pin this run: it continues beside what follows, with its values and its method"),
    row(KeyContext::Experiment, &[c('d')], Action::AddNeighbour, "", "add a neighbour, a motion that starts close by, and show how they separate: ln d against time"),
    row(KeyContext::Experiment, &[c('F')], Action::Equilibria, "", "find equilibria and their small oscillations, and start at one or along a mode"),
    row(KeyContext::Experiment, &[c('V')], Action::Exponents, "", "measure the Lyapunov exponent of the motion: regular or chaotic"),
    row(KeyContext::Experiment, &[c('K')], Action::Ensemble, "", "carry an ensemble of starts along with the motion: its density, and the action ∫ p dq around it"),
    row(KeyContext::Experiment, &[c('t')], Action::PeriodicOrbit, "", "find the periodic orbit near the motion: period, action, multipliers; again: near its current state"),
    row(KeyContext::Experiment, &[c('w')], Action::Spectrum, "", "find the frequencies ω of the motion: lines, and what they are combinations of"),
    row(KeyContext::Experiment, &[c('C')], Action::ClearCompanions, "", "clear all motions beside the main one"),
    row(KeyContext::Experiment, &[c('W')], Action::Export, "", "write a preset file of the system as it is now, with every changed value"),
    row(KeyContext::Experiment, &[c('E')], Action::Edit, "edit", "edit the system's file while it runs; the motion follows the text"),
    row(KeyContext::Experiment, &[ctrl('n')], Action::NewSystem, "", "begin a new system, a file of your own, in the editor; this motion can be continued from the list of systems"),
    row(KeyContext::Experiment, &[c('S')], Action::Still, "", "write a screenshot (a drawing, SVG) into the current folder"),
    row(KeyContext::Experiment, &[c('D')], Action::Data, "", "write a table (CSV) into the current folder: what the focused diagram, map or section has computed, otherwise the motion so far"),
    row(KeyContext::Experiment, &[c('O')], Action::Record, "", "record the screen into a cast in the current folder, or stop recording"),
    row(KeyContext::Experiment, &[ctrl('y')], Action::Share, "", "share: copy the command that opens this system with these values and this method, or write it into a file where the terminal has no clipboard"),
    row(KeyContext::Experiment, &[c('1')], Action::Show(Page::Lab), "", "show page 1: the lab"),
    row(KeyContext::Experiment, &[c('2')], Action::Show(Page::Equations), "", "show page 2: what follows from L or H"),
    row(KeyContext::Experiment, &[c('3')], Action::Show(Page::Notes), "", "show page 3: notes, source and expectations"),
    row(KeyContext::Experiment, &[c('4')], Action::Show(Page::Numbers), "", "show page 4: energy, momenta and every other quantity as numbers"),
    row(KeyContext::Experiment, &[c('<')], Action::FewerFrames, "", "lower the frame rate, for a slow connection"),
    row(KeyContext::Experiment, &[c('>')], Action::MoreFrames, "", "raise the frame rate"),
    row(KeyContext::Experiment, &[c('M')], Action::Mouse, "", "use the mouse here, or leave it to the terminal to select text"),

    row(KeyContext::Experiment, &[c('9')], Action::Show(Page::Plain), "", "show page 9: the screen as plain text that does not move, to be read line by line"),

    row(KeyContext::Lab, &[TAB], Action::NextPane, "pane", "focus the next pane in view"),
    row(KeyContext::Lab, &[BACKTAB], Action::PreviousPane, "", "focus the previous pane in view"),
    row(KeyContext::Lab, &[c('\\')], Action::NextTab, "tabs", "show the next of the tabs: the panes that share a frame"),
    row(KeyContext::Lab, &[c('/')], Action::Palette, "", "search all actions by name, as : does"),
    row(KeyContext::Lab, &[c('b')], Action::ApplyImpulse, "impulse", "apply an impulse that waits for a key"),
    row(KeyContext::Lab, &[c('f')], Action::NextFrame, "frame", "view the motion in space in the next reference frame of the file, or in the original one again"),
    row(KeyContext::Lab, &[c('Q')], Action::Active, "", "switch between the active view of a transformation (the point moves) and the passive one (the coordinates do); of an action, the next principle: Hamilton, Maupertuis, phase space; of a diagram, frequency or period"),
    row(KeyContext::Lab, &[c('*')], Action::VectorField, "", "show or hide the vector field of a phase portrait, with its nullclines: the curves on which one of the two rates vanishes; they cross at the equilibria"),
    row(KeyContext::Lab, &[c('z')], Action::Zoom, "zoom", "zoom the focused pane until it fills the page, or put it back"),

    row(KeyContext::Space, &[LEFT, c('h')], Action::Move(ArrowDirection::Left), "turn", "turn the picture to the left"),
    row(KeyContext::Space, &[RIGHT, c('l')], Action::Move(ArrowDirection::Right), "", "turn the picture to the right"),
    row(KeyContext::Space, &[UP, c('k')], Action::Move(ArrowDirection::Up), "", "look from higher up"),
    row(KeyContext::Space, &[DOWN, c('j')], Action::Move(ArrowDirection::Down), "", "look from lower down"),
    row(KeyContext::Space, &[c('+'), c('=')], Action::Closer(AxisChoice::Both), "closer", "look closer"),
    row(KeyContext::Space, &[c('-')], Action::Farther(AxisChoice::Both), "", "look from further away"),
    row(KeyContext::Space, &[HOME, c('0')], Action::Home, "", "return to the initial view"),
    row(KeyContext::Space, &[c('c')], Action::Cursor, "", "show the cursor of the nearest plot, which gets the focus"),
    row(KeyContext::Space, &[ENTER, c('v')], Action::ChooseAxes, "view", "choose the view that this pane shows"),

    row(KeyContext::Plot, &[c('v')], Action::ChooseAxes, "axes", "choose what this pane shows: the variables on its axes"),
    row(KeyContext::Plot, &[ENTER], Action::StartHere, "", "begin the motion at the cursor; without a cursor, choose what this pane shows"),
    row(KeyContext::Plot, &[c('A'), shift(KeyCode::Enter)], Action::AddStart, "", "add a motion beside the others that begins at the cursor; so does Shift-click, or the right button"),
    row(KeyContext::Plot, &[c('n')], Action::AddOrbits, "", "add orbits to a section: the one through the cursor, or several over the visible part; start an ensemble there, and again to spread it over its energy shell"),
    row(KeyContext::Plot, &[c('L')], Action::TypeSurface, "", "type the surface of a section: x = 0, rising; every 2*pi/w; event NAME; a plot without one becomes a section"),
    row(KeyContext::Plot, &[c('|')], Action::TurnDirection, "", "choose the direction in which a section is crossed: rising, falling, either"),
    row(KeyContext::Plot, &[c('G')], Action::FillSection, "", "fill the visible part of a section: a hundred orbits of 120 crossings each"),
    row(KeyContext::Plot, &[c('N')], Action::ClearOrbits, "", "clear a section: the orbits added to it, and the past crossings of the motion"),
    row(KeyContext::Plot, &[c('+'), c('=')], Action::Closer(AxisChoice::Both), "closer", "look closer"),
    row(KeyContext::Plot, &[c('-')], Action::Farther(AxisChoice::Both), "", "look from further away"),
    row(KeyContext::Plot, &[c('x')], Action::Closer(AxisChoice::Across), "", "stretch the horizontal axis"),
    row(KeyContext::Plot, &[c('X')], Action::Farther(AxisChoice::Across), "", "shrink the horizontal axis"),
    row(KeyContext::Plot, &[c('y')], Action::Closer(AxisChoice::Upwards), "", "stretch the vertical axis"),
    row(KeyContext::Plot, &[c('Y')], Action::Farther(AxisChoice::Upwards), "", "shrink the vertical axis"),
    row(KeyContext::Plot, &[c('g')], Action::Log, "", "make the vertical axis logarithmic, or linear again"),
    row(KeyContext::Plot, &[c('o')], Action::Equal, "", "make the scales of both axes equal, or fill the pane again"),
    row(KeyContext::Plot, &[c('H')], Action::ByChaos, "", "colour the orbits of a section by whether they are regular or chaotic, or each in its own colour"),
    row(KeyContext::Plot, &[c('c')], Action::Cursor, "cursor", "show or hide a cursor on the plot that reads coordinates"),
    row(KeyContext::Plot, &[LEFT, c('h')], Action::Move(ArrowDirection::Left), "move", "move the window, or the cursor, to the left"),
    row(KeyContext::Plot, &[RIGHT, c('l')], Action::Move(ArrowDirection::Right), "", "move the window, or the cursor, to the right"),
    row(KeyContext::Plot, &[UP, c('k')], Action::Move(ArrowDirection::Up), "", "move the window, or the cursor, up"),
    row(KeyContext::Plot, &[DOWN, c('j')], Action::Move(ArrowDirection::Down), "", "move the window, or the cursor, down"),
    row(KeyContext::Plot, &[HOME, c('0')], Action::Home, "", "show the whole motion, as at the beginning"),

    row(KeyContext::Values, &[UP, c('k')], Action::Move(ArrowDirection::Up), "", "the value above"),
    row(KeyContext::Values, &[DOWN, c('j')], Action::Move(ArrowDirection::Down), "choose", "the value below"),
    row(KeyContext::Values, &[PAGE_UP], Action::PageUp, "", "ten values up"),
    row(KeyContext::Values, &[PAGE_DOWN], Action::PageDown, "", "ten values down"),
    row(KeyContext::Values, &[HOME], Action::First, "", "the first value"),
    row(KeyContext::Values, &[END], Action::Last, "", "the last value"),
    row(KeyContext::Values, &[LEFT, c('h')], change(-1, false), "", "less, by a fine step"),
    row(KeyContext::Values, &[RIGHT, c('l')], change(1, false), "change", "more, by a fine step"),
    row(KeyContext::Values, &[SHIFT_LEFT, c('H'), c('-')], change(-1, true), "", "less, by a coarse step"),
    row(KeyContext::Values, &[SHIFT_RIGHT, c('L'), c('+'), c('=')], change(1, true), "", "more, by a coarse step"),
    row(KeyContext::Values, &[ENTER], Action::TypeValue, "type", "type the value: a number or an expression, such as pi, sqrt(2) or 2*l"),
    row(KeyContext::Values, &[c('v')], Action::Diagram, "", "show how the motion depends on this parameter or initial value: a bifurcation diagram where the file has a surface of section, otherwise the Lyapunov exponent; the frequency where a single coordinate keeps its energy"),
    row(KeyContext::Values, &[c('g')], Action::Ramp, "", "ramp this parameter gradually to another value in a given time; a slow ramp conserves J, which is shown"),
    row(KeyContext::Values, &[c('c')], Action::Cursor, "", "show the cursor of the nearest plot, which gets the focus"),
    row(KeyContext::Values, &[BACKSPACE, DELETE], Action::Restore, "", "restore the value of the file"),

    row(KeyContext::Gauges, &[UP, c('k')], Action::Move(ArrowDirection::Up), "", "the gauge above"),
    row(KeyContext::Gauges, &[DOWN, c('j')], Action::Move(ArrowDirection::Down), "choose", "the gauge below"),
    row(KeyContext::Gauges, &[PAGE_UP], Action::PageUp, "", "ten gauges up"),
    row(KeyContext::Gauges, &[PAGE_DOWN], Action::PageDown, "", "ten gauges down"),
    row(KeyContext::Gauges, &[HOME], Action::First, "", "the first gauge"),
    row(KeyContext::Gauges, &[END], Action::Last, "", "the last gauge"),
    row(KeyContext::Gauges, &[c('c')], Action::Cursor, "", "show the cursor of the nearest plot, which gets the focus"),

    row(KeyContext::Law, &[UP, c('k')], Action::Move(ArrowDirection::Up), "", "a line up"),
    row(KeyContext::Law, &[DOWN, c('j')], Action::Move(ArrowDirection::Down), "scroll", "a line down"),
    row(KeyContext::Law, &[PAGE_UP], Action::PageUp, "", "ten lines up"),
    row(KeyContext::Law, &[PAGE_DOWN], Action::PageDown, "", "ten lines down"),
    row(KeyContext::Law, &[HOME], Action::First, "", "to the beginning"),
    row(KeyContext::Law, &[END], Action::Last, "", "to the end"),
    row(KeyContext::Law, &[c('c')], Action::Cursor, "", "show the cursor of the nearest plot, which gets the focus"),

    row(KeyContext::Equations, &[c('y')], Action::CopyLatex, "copy", "copy the equations as LaTeX, or write them into a file where the terminal has no clipboard"),

    row(KeyContext::Text, &[UP, c('k')], Action::Move(ArrowDirection::Up), "", "a line up"),
    row(KeyContext::Text, &[DOWN, c('j')], Action::Move(ArrowDirection::Down), "scroll", "a line down"),
    row(KeyContext::Text, &[PAGE_UP, c('b')], Action::PageUp, "", "a page up"),
    row(KeyContext::Text, &[PAGE_DOWN, c('f')], Action::PageDown, "", "a page down"),
    row(KeyContext::Text, &[HOME, c('g')], Action::First, "", "to the beginning"),
    row(KeyContext::Text, &[END, c('G')], Action::Last, "", "to the end"),

    row(KeyContext::Text, &[c('/')], Action::Search, "search", "search the text, or the keys in this help; a capital letter matches itself only"),
    row(KeyContext::Text, &[c('n')], Action::NextMatch, "", "the next match in a page of text"),
    row(KeyContext::Text, &[c('N')], Action::PreviousMatch, "", "the previous match in a page of text"),

    row(KeyContext::HelpSearch, &[UP], Action::Move(ArrowDirection::Up), "", "a line up"),
    row(KeyContext::HelpSearch, &[DOWN], Action::Move(ArrowDirection::Down), "scroll", "a line down"),
    row(KeyContext::HelpSearch, &[PAGE_UP], Action::PageUp, "", "a page up"),
    row(KeyContext::HelpSearch, &[PAGE_DOWN], Action::PageDown, "", "a page down"),
    row(KeyContext::HelpSearch, &[HOME], Action::First, "", "to the beginning"),
    row(KeyContext::HelpSearch, &[END], Action::Last, "", "to the end"),
    row(KeyContext::HelpSearch, &[ENTER], Action::Accept, "keep", "keep the matches and stop typing"),

    row(KeyContext::Message, &[c('E')], Action::Edit, "edit", "edit the file, at its first error; once it has none the motion begins"),

    row(KeyContext::Plain, &[ENTER], Action::ReadAnew, "read", "read the current state"),
    row(KeyContext::Plain, &[c('A')], Action::ReadOn, "by itself", "read the current state by itself, every two seconds, or only when asked"),
    row(KeyContext::Plain, &[UP, c('k')], Action::Move(ArrowDirection::Up), "", "the line above"),
    row(KeyContext::Plain, &[DOWN, c('j')], Action::Move(ArrowDirection::Down), "line", "the line below"),
    row(KeyContext::Plain, &[PAGE_UP], Action::PageUp, "", "a page up"),
    row(KeyContext::Plain, &[PAGE_DOWN], Action::PageDown, "", "a page down"),
    row(KeyContext::Plain, &[HOME, c('g')], Action::First, "", "the first line"),
    row(KeyContext::Plain, &[END, c('G')], Action::Last, "", "the last line"),

    row(KeyContext::Menu, &[UP], Action::Move(ArrowDirection::Up), "", "the line above"),
    row(KeyContext::Menu, &[DOWN], Action::Move(ArrowDirection::Down), "choose", "the line below"),
    row(KeyContext::Menu, &[PAGE_UP], Action::PageUp, "", "ten lines up"),
    row(KeyContext::Menu, &[PAGE_DOWN], Action::PageDown, "", "ten lines down"),
    row(KeyContext::Menu, &[HOME], Action::First, "", "the first line"),
    row(KeyContext::Menu, &[END], Action::Last, "", "the last line"),
    row(KeyContext::Menu, &[TAB], Action::Mark, "mark", "mark the line, where several can be selected"),
    row(KeyContext::Menu, &[ENTER], Action::Accept, "select", "select the line"),

    row(KeyContext::Workbench, &[ctrl('s')], Action::EditCommand(EditCommand::Save), "save", "save the file; for a shipped system, a copy under a name of your own"),
    row(KeyContext::Workbench, &[ctrl('n'), plain(KeyCode::F(8))], Action::EditCommand(EditCommand::Diagnostic(1)), "error", "go to the next error"),
    row(KeyContext::Workbench, &[ctrl('p')], Action::EditCommand(EditCommand::Diagnostic(-1)), "", "go to the previous error"),
    row(KeyContext::Workbench, &[ctrl('f')], Action::EditCommand(EditCommand::Find), "find", "find words in the text"),
    row(KeyContext::Workbench, &[ctrl('g'), plain(KeyCode::F(3))], Action::EditCommand(EditCommand::FindNext), "", "find the next match"),
    row(KeyContext::Workbench, &[ctrl('u')], Action::EditCommand(EditCommand::Undo), "undo", "undo the last change of the text"),
    row(KeyContext::Workbench, &[ctrl('r')], Action::EditCommand(EditCommand::Redo), "", "redo the last undone change"),
    row(KeyContext::Workbench, &[ctrl('x')], Action::EditCommand(EditCommand::Cut), "cut", "cut what is selected (Shift and arrows), or else the line"),
    row(KeyContext::Workbench, &[ctrl('y')], Action::EditCommand(EditCommand::Copy), "", "copy it"),
    row(KeyContext::Workbench, &[ctrl('v')], Action::EditCommand(EditCommand::PutBack), "", "paste what was cut or copied last"),
    row(KeyContext::Workbench, &[ctrl('o')], Action::EditCommand(EditCommand::Reread), "", "reload the file from disk; for a shipped system, its original text"),

    row(KeyContext::Field, &[ENTER], Action::Accept, "accept", "accept what is typed"),

    row(KeyContext::Typing, &[plain(KeyCode::F(1))], Action::Help, "help", "show the help, then continue typing"),
    row(KeyContext::Typing, &[ESC], Action::Back, "cancel", "cancel, or close the list; q is a letter here"),
];

/// Returns the action of a key where these contexts are active, the innermost first.
pub fn action(key: KeyEvent, contexts: &[KeyContext]) -> Option<Action> {
    let holds = |row: &&Binding| contexts.contains(&row.context) && row.keys.contains(&key);
    KEYS.iter().find(holds).map(|row| row.action)
}
