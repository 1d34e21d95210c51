//! The table of commands: one row for each word that a line of a script may begin with.
//!
//! In: the rest of the line. Out: its meaning. Never here: lines and ranges, or execution.

use crossterm::event::KeyEvent;

use super::claim::claim;
use super::line::ScriptLine;
use super::{Asked, AskedAxis, LessonStep, ScriptHeader, ScriptStep, SweepPath, Word};
use crate::app::key;
use crate::diagnostic::Diagnostic;
use crate::view::colour::ColourDepth;
use crate::view::glyphs::Glyphs;
use crate::view::theme::PALETTES;

/// What a line of a script means.
pub(super) enum ParsedLine {
    /// A setting of the whole demo.
    Setting(Box<dyn FnOnce(&mut ScriptHeader)>),
    Step(ScriptStep),
}

/// One row of the table.
pub struct CommandRow {
    /// The word.
    pub name: &'static str,
    /// The syntax of the line; the parts in brackets are optional.
    pub form: &'static str,
    /// A description in one sentence.
    pub about: &'static str,
    pub(super) read: fn(&mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic>,
}

const fn row(
    name: &'static str,
    form: &'static str,
    about: &'static str,
    read: fn(&mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic>,
) -> CommandRow {
    CommandRow { name, form, about, read }
}

/// All commands; those for the whole demo come first.
#[rustfmt::skip]
pub const COMMANDS: &[CommandRow] = &[
    row("Open", "Open NAME", "the preset or file the demo is about; the command line may name another", open),
    row("Title", "Title \"TEXT\"", "the title of the cast; by default that of the system", title),
    row("Size", "Size 100x30", "columns and rows of the screen, the line of captions included", size),
    row("Fps", "Fps 20", "frames in a second, 1 to 60; 20 by default", fps),
    row("Theme", "Theme dark", "the theme, a name from `phaselab theme list`", theme),
    row("Color", "Color true", "how many colours are used: `true` (the default), `256`, `16` or `never`", colour),
    row("Glyphs", "Glyphs braille", "what is drawn with: `braille` (the default), `half`, `ascii`, …", glyphs),
    row("Hide", "Hide footer", "hide the two lines below the panes, the status and the keys, to give their room to the picture", hide),
    row("Pace", "Pace 150ms", "how long each key from here on is shown", pace),
    row("Press", "Press KEY [xN] [KEY …]", "press keys: `z`, `Tab`, `Down x3`, `Shift-Left`, `Ctrl-r`", press),
    row("Type", "Type \"TEXT\"", "type a text, key by key", typed),
    row("Wait", "Wait 2s", "let time pass: `2s`, `0.5s`, `150ms`", wait),
    row("Set", "Set NAME = EXPR", "set a parameter, or an initial value (which restarts the motion)", set),
    row("Sweep", "Sweep NAME [from EXPR] to EXPR [and NAME …] in 3s", "change parameters or initial values linearly to other values while time passes; together they are undone as one change", sweep),
    row("Speed", "Speed EXPR", "simulated seconds in a second", speed),
    row("Look", "Look at EXPR", "pause and look at a time of the recorded past; what acts on the motion continues it from there", scrub_to),
    row("Focus", "Focus PANE", "focus a pane and bring it into view: a picture by its kind, as `phase`, or `parameters`, `initial`, `gauges`, `law`", focus),
    row("Extent", "Extent [NAME from EXPR to EXPR [and NAME …]]", "the least range of quantities in the pictures, so that their scale does not change with the motion; without a name, as the motion has it", extent),
    row("Caption", "Caption \"TEXT\"", "write a line below the screen; without a text, remove it", caption),
    row("Marker", "Marker \"NAME\"", "begin a chapter: players can jump to it, and stills can be taken of it", marker),
    row("Assert", "Assert CLAIM", "claim something about this moment; a false claim is an error", assert),
    row("Say", "Say \"TEXT\"", "lesson: say something, and wait for a key; the motion waits too", say),
    row("Ask", "Ask \"QUESTION\"", "lesson: ask; the options follow on the lines below, and `Outcome` says which is right", ask),
    row("Option", "Option \"TEXT\" [why \"TEXT\"] if CLAIM", "lesson: an option of the question above, right if the claim holds at the outcome; `why` is shown to whoever chooses it wrongly", option),
    row("Predict", "Predict \"QUESTION\" EXPR within EPS", "lesson: ask for a number, the value of EXPR at the outcome; a `point` or `curve` of a plot is set by its cursor", predict),
    row("Outcome", "Outcome", "lesson: compare the answer to the last question with what has happened since", outcome),
    row("Task", "Task \"TEXT\" [hint \"TEXT\"] until CLAIM", "lesson: give the lab to the person until the claim holds; after what is said of it, the system restarts as its file says", task),
    row("Solution", "Solution KEY [xN] [KEY …]", "lesson: the keys that fulfil the task above, which `lesson check` presses", solution),
    row("Free", "Free \"TEXT\"", "lesson: give the lab to the person until F9; after what is said of it, the system restarts as its file says", free),
];

fn head(say: impl FnOnce(&mut ScriptHeader) + 'static) -> ParsedLine {
    ParsedLine::Setting(Box::new(say))
}

fn open(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    let name = line.name("the name of a preset or file")?;
    Ok(head(|head| head.open = Some(name)))
}

fn title(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    let title = line.quoted("a title")?.text;
    Ok(head(|head| head.title = Some(title)))
}

/// The least and the greatest screen.
const SIZES: [(u16, u16); 2] = [(40, 11), (400, 150)];

/// Reads a size of the screen, `100x30`.
pub fn read_size(text: &str) -> Result<(u16, u16), String> {
    let sides =
        text.split_once(['x', '×']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    let (width, height) = sides.ok_or("a size is written 100x30, columns and rows")?;
    let [least, most] = SIZES;
    if (least.0..=most.0).contains(&width) && (least.1..=most.1).contains(&height) {
        return Ok((width, height));
    }
    let ((a, b), (c, d)) = (least, most);
    Err(format!("a screen has from {a}x{b} to {c}x{d} characters"))
}

fn size(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    let word = line.need("a size")?;
    let size = read_size(&word.text).map_err(|why| Diagnostic::error(word.place, why))?;
    Ok(head(move |head| head.size = Some(size)))
}

fn fps(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    let word = line.need("a number of frames")?;
    let fps = word.text.parse().ok().filter(|n| (1..=60).contains(n)).ok_or_else(|| {
        Diagnostic::error(
            word.place,
            format!("`{}`: there are 1 to 60 frames in a second", word.text),
        )
    })?;
    Ok(head(move |head| head.fps = fps))
}

fn theme(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    let names: Vec<Word> = PALETTES.iter().map(|palette| palette.name).collect();
    let name = line.one_of("a theme", &names)?;
    Ok(head(move |head| head.theme = name))
}

fn colour(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    let name = line.one_of("a depth of colour", &["true", "256", "16", "never"])?;
    Ok(head(move |head| head.colour = ColourDepth::named(name).unwrap_or(ColourDepth::True)))
}

fn glyphs(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    let word = line.need("a set of glyphs")?;
    let glyphs = Glyphs::named(&word.text).ok_or_else(|| {
        let message = format!("`{}` is not a set of glyphs", word.text);
        Diagnostic::error(word.place, message).with_help("there are braille half ascii")
    })?;
    Ok(head(move |head| head.glyphs = glyphs))
}

fn hide(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    line.one_of("what is hidden", &["footer"])?;
    Ok(head(|head| head.footer = false))
}

fn pace(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    Ok(ParsedLine::Step(ScriptStep::Pace(line.time()?)))
}

/// The most times that a key may be pressed in a row.
const MOST_PRESSES: usize = 1000;

fn press(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    Ok(ParsedLine::Step(ScriptStep::Press(keys(line)?)))
}

/// The names of keys to the end of the line.
fn keys(line: &mut ScriptLine<'_>) -> Result<Vec<KeyEvent>, Diagnostic> {
    let mut keys = Vec::new();
    while let Some(word) = line.word() {
        let count = word.text.strip_prefix('x').and_then(|count| count.parse().ok());
        match (count, keys.last().copied()) {
            (Some(count), Some(last)) if (1..=MOST_PRESSES).contains(&count) => {
                keys.extend(std::iter::repeat_n(last, count - 1));
            }
            (Some(_), Some(_)) => {
                let message = format!("a key is pressed 1 to {MOST_PRESSES} times in a row");
                return Err(Diagnostic::error(word.place, message));
            }
            (Some(_), None) => {
                let message = format!("`{}` belongs after a key", word.text);
                return Err(Diagnostic::error(word.place, message).with_help("as in Press Down x3"));
            }
            (None, _) => keys.push(key::named(&word.text).map_err(|near| {
                let diagnostic =
                    Diagnostic::error(word.place, format!("unknown key `{}`", word.text));
                match near {
                    Some(near) => diagnostic.with_help(format!("did you mean `{near}`?")),
                    None => diagnostic.with_help("keys are z Tab Enter Shift-Left Ctrl-r F1 …"),
                }
            })?),
        }
    }
    if keys.is_empty() { Err(line.missing("a key")) } else { Ok(keys) }
}

fn typed(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    Ok(ParsedLine::Step(ScriptStep::Type(line.quoted("a text")?.text)))
}

fn wait(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    Ok(ParsedLine::Step(ScriptStep::Wait(line.time()?)))
}

fn set(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    let name = line.until(&["="], "the name of a parameter or an initial value")?;
    expect(line, "=")?;
    let value = line.until(&[], "a value")?;
    Ok(ParsedLine::Step(ScriptStep::Set(name, value)))
}

fn sweep(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    let mut ways: Vec<SweepPath> = Vec::new();
    loop {
        let name = line.name("the name of a parameter or an initial value")?;
        if let Some(first) = ways.iter().find(|way| way.name.text == name.text) {
            let message = format!("`{}` cannot be swept twice at once", name.text);
            let diagnostic = Diagnostic::error(name.place, message);
            return Err(diagnostic.with_also(first.name.place.clone(), "it is swept here already"));
        }
        let from = line.take("from").then(|| line.until(&["to"], "a value")).transpose()?;
        expect(line, "to")?;
        let to = line.until(&["and", "in"], "a value")?;
        ways.push(SweepPath { name, from, to });
        if !line.take("and") {
            break;
        }
    }
    expect(line, "in")?;
    Ok(ParsedLine::Step(ScriptStep::Sweep { ways, time: line.time()? }))
}

fn expect(line: &mut ScriptLine<'_>, word: &str) -> Result<(), Diagnostic> {
    if line.take(word) {
        return Ok(());
    }
    let here = line.word().map_or(line.here()..line.here(), |word| word.place);
    Err(Diagnostic::error(here, format!("here `{word}` is missing")))
}

fn speed(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    Ok(ParsedLine::Step(ScriptStep::Speed(line.until(&[], "a speed")?)))
}

fn scrub_to(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    expect(line, "at")?;
    Ok(ParsedLine::Step(ScriptStep::ScrubTo(line.until(&[], "a time")?)))
}

fn focus(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    Ok(ParsedLine::Step(ScriptStep::Focus(line.until(&[], "a pane")?)))
}

fn extent(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    let mut ranges = Vec::new();
    while !line.is_over() {
        let of = line.until(&["from"], "the name of a quantity")?;
        expect(line, "from")?;
        let from = line.until(&["to"], "the end of a range")?;
        expect(line, "to")?;
        ranges.push((of, [from, line.until(&["and"], "the other end of the range")?]));
        if line.take("and") && line.is_over() {
            return Err(line.missing("the name of a quantity"));
        }
    }
    Ok(ParsedLine::Step(ScriptStep::Extent(ranges)))
}

fn caption(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    let text = if line.is_over() { String::new() } else { line.quoted("a text")?.text };
    Ok(ParsedLine::Step(ScriptStep::Caption(text)))
}

fn marker(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    let name = line.quoted("a name")?;
    if name.text.trim().is_empty() {
        return Err(Diagnostic::error(name.place, "a chapter has a name"));
    }
    Ok(ParsedLine::Step(ScriptStep::Marker(name.text)))
}

fn assert(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    Ok(ParsedLine::Step(ScriptStep::Assert(claim(line)?)))
}

fn lesson(step: LessonStep) -> ParsedLine {
    ParsedLine::Step(ScriptStep::Lesson(step))
}

fn say(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    Ok(lesson(LessonStep::Say(line.quoted("a text")?.text)))
}

fn ask(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    Ok(lesson(LessonStep::Ask(line.quoted("a question")?.text)))
}

/// A quoted text after a word, if the word comes next.
fn remark(line: &mut ScriptLine<'_>, word: &str) -> Result<Option<String>, Diagnostic> {
    let text = line.take(word).then(|| line.quoted("a text")).transpose()?;
    Ok(text.map(|text| text.text))
}

fn option(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    let text = line.quoted("an option")?.text;
    let why = remark(line, "why")?;
    expect(line, "if")?;
    Ok(lesson(LessonStep::Option { text, why, claim: claim(line)? }))
}

fn predict(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    let text = line.quoted("a question")?.text;
    let is_curve = line.take("curve");
    if is_curve || line.take("point") {
        let asked = Asked::Place { is_curve, axes: Box::new(axes(line)?) };
        return Ok(lesson(LessonStep::Predict { text, asked }));
    }
    let value = line.until(&["within"], "what is to be predicted")?;
    expect(line, "within")?;
    let asked = Asked::Value { value, within: line.until(&[], "a tolerance")? };
    Ok(lesson(LessonStep::Predict { text, asked }))
}

/// The axes of a plot: `X [from A to B] and Y [from A to B] within EPS [and EPS]`.
fn axes(line: &mut ScriptLine<'_>) -> Result<[AskedAxis; 2], Diagnostic> {
    let axis = |line: &mut ScriptLine<'_>, end: &str| {
        let of = line.until(&["from", end], "the quantity on an axis")?;
        if !line.take("from") {
            return Ok((of, None));
        }
        let from = line.until(&["to"], "the end of an axis")?;
        expect(line, "to")?;
        let to = line.until(&[end], "the other end of the axis")?;
        Ok((of, Some([from, to])))
    };
    let (across, window) = axis(line, "and")?;
    expect(line, "and")?;
    let (upwards, height) = axis(line, "within")?;
    expect(line, "within")?;
    let within = line.until(&["and"], "a tolerance")?;
    let also = if line.take("and") { line.until(&[], "a tolerance")? } else { within.clone() };
    Ok([
        AskedAxis { of: across, range: window, within },
        AskedAxis { of: upwards, range: height, within: also },
    ])
}

#[expect(clippy::unnecessary_wraps, reason = "a reader of the table")]
fn outcome(_: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    Ok(lesson(LessonStep::Outcome))
}

fn task(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    let text = line.quoted("a text")?.text;
    let hint = remark(line, "hint")?;
    expect(line, "until")?;
    Ok(lesson(LessonStep::Task { text, hint, claim: claim(line)? }))
}

fn solution(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    Ok(lesson(LessonStep::Solution(keys(line)?)))
}

fn free(line: &mut ScriptLine<'_>) -> Result<ParsedLine, Diagnostic> {
    Ok(lesson(LessonStep::Free(line.quoted("a text")?.text)))
}
