//! `phaselab lessons` and `phaselab lesson check`: lessons listed, taken on the terminal, and checked.

use std::path::Path;

use clap::Subcommand;
use clap::ValueEnum;
use serde_json::{Value, json};

use super::error::CommandError;
use super::interrupt::Interrupt;
use super::output::{Output, OutputForm};
use super::slow_notice::with_notice;
use super::{record, script, stderr};
use crate::diagnostic::{Document, nearest};
use crate::preset::{self, is_path};
use crate::printable;
use crate::record::{Lesson, Script, check_lesson};
use crate::shell::{self, Ending, LabError, LessonMark, LessonProgress, Request};

/// List the lessons, or take one.
///
/// A lesson is a demo with a person in it: you say what you expect before it happens. Right or
/// wrong is decided by the motion. It can be left at any time (q) and continues there the next time.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab lessons                       all lessons, with a tick where one was finished
  phaselab lessons kepler                take one, or continue where you left off
  phaselab lessons kepler --restart      from its beginning
  phaselab lessons my/own.lesson         one of your own")]
pub(super) struct Lessons {
    /// A lesson's name, or a file.
    #[arg(value_name = "NAME|FILE")]
    lesson: Option<String>,
    /// Start from the beginning instead of where you left the lesson.
    #[arg(long, requires = "lesson")]
    restart: bool,
    /// How the list is written.
    #[arg(long, value_enum, default_value_t, conflicts_with = "lesson")]
    format: LessonFormat,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum LessonFormat {
    /// For reading.
    #[default]
    Text,
    /// One object, `{"lessons": [...]}`.
    Json,
}

/// Take the tour: three minutes, from the pendulum to a Lagrangian of your own.
///
/// It is the lesson `tour`. It can be left at any time (q) and continues there the next time.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab tour
  phaselab tour --restart                from its beginning")]
pub(super) struct Tour {
    /// Start from the beginning instead of where you left the tour.
    #[arg(long)]
    restart: bool,
}

pub(super) fn tour(
    arguments: &Tour,
    interrupt: &Interrupt,
    shared: &LessonHost<'_>,
) -> Result<(), CommandError> {
    take("tour", arguments.restart, interrupt, shared)
}

/// Check lessons.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab lesson check
  phaselab lesson check my/own.lesson")]
pub(super) struct Check {
    #[command(subcommand)]
    command: LessonCommand,
}

#[derive(Debug, Subcommand)]
enum LessonCommand {
    /// Take lessons with the right answer and with every wrong answer, without a terminal.
    ///
    /// A question without exactly one right option, a claim that is false, a task that its solution
    /// does not do: each is reported in its place, on standard error. Without a name the shipped
    /// lessons are checked.
    Check {
        /// Lessons' names, or files.
        #[arg(value_name = "NAME|FILE")]
        names: Vec<String>,
    },
}

/// What lessons share with the commands that perform scripts on the terminal.
pub(super) struct LessonHost<'a> {
    /// A script with its system and the system's name on the screen.
    pub(super) scripted: fn(&Document) -> Result<(Script, Document, String), CommandError>,
    /// How the terminal is asked for.
    pub(super) request: &'a dyn Fn() -> Result<Request, CommandError>,
    /// The exit code of how it ended.
    pub(super) ended: fn(Result<Ending, LabError>) -> Result<(), CommandError>,
}

/// The text of a lesson: a shipped one's, or a file's.
fn source(name: &str) -> Result<Document, CommandError> {
    let path = Path::new(name);
    if is_path(name) || path.extension().is_some_and(|ending| ending == "lesson") {
        return Document::open(path).map_err(|why| CommandError::reading(path, &why));
    }
    preset::lesson(name).ok_or_else(|| {
        let near = nearest(name, preset::lessons());
        let help = near.map_or_else(
            || format!("there are {}", preset::lessons().join(", ")),
            |near| format!("did you mean `{near}`?"),
        );
        CommandError::WrongUse(format!("unknown lesson `{}`; {help}", printable::quoted(name)))
    })
}

pub(super) fn check(arguments: &Check, shared: &LessonHost<'_>) -> Result<(), CommandError> {
    let LessonCommand::Check { names } = &arguments.command;
    let shipped = || preset::lessons().into_iter().map(str::to_owned).collect();
    let names: Vec<String> = if names.is_empty() { shipped() } else { names.clone() };
    let mut wrong = Vec::new();
    for name in &names {
        match check_one(&source(name)?, shared) {
            Err(CommandError::WrongFile(what)) => wrong.push(what),
            other => other?,
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(CommandError::WrongFile(wrong.join("\n"))) }
}

fn check_one(source: &Document, shared: &LessonHost<'_>) -> Result<(), CommandError> {
    let (script, system, name) = (shared.scripted)(source)?;
    let what = format!("taking {} with every answer", source.path);
    let report = with_notice(&what, || check_lesson(&script, &system, &name));
    let report = report.map_err(|diagnostics| record::located(source, &diagnostics))?;
    let counted = |count: usize, one: &str, many: &str| {
        format!("{count} {}", if count == 1 { one } else { many })
    };
    stderr::report(&format!(
        "{}: right answers to {}, {}, {}; all as the lesson says",
        printable::line(&source.path),
        counted(report.questions, "question", "questions"),
        counted(report.wrong, "wrong answer", "wrong answers"),
        counted(report.tasks, "task", "tasks"),
    ));
    Ok(())
}

pub(super) fn execute(
    arguments: &Lessons,
    interrupt: &Interrupt,
    shared: &LessonHost<'_>,
) -> Result<(), CommandError> {
    match &arguments.lesson {
        Some(name) => take(name, arguments.restart, interrupt, shared),
        None => list(arguments.format),
    }
}

fn title(name: &str) -> String {
    let script = preset::lesson(name).and_then(|source| Script::read(&source).ok());
    script.and_then(|script| script.head.title).unwrap_or_else(|| name.to_owned())
}

fn list(format: LessonFormat) -> Result<(), CommandError> {
    let progress = LessonProgress::known().unwrap_or_else(|why| {
        stderr::report(&why.to_string());
        LessonProgress::default()
    });
    let mark = |name: &str| progress.lessons.get(name).copied().unwrap_or_default();
    if format == LessonFormat::Json {
        let lessons: Vec<Value> = preset::lessons()
            .into_iter()
            .map(|name| {
                let LessonMark { finished, step } = mark(name);
                let begun = step > 0;
                json!({ "name": name, "title": title(name), "finished": finished, "begun": begun })
            })
            .collect();
        return Output::print(OutputForm::Json, &format!("{:#}\n", json!({ "lessons": lessons })));
    }
    let width = preset::lessons().iter().map(|name| name.len()).max().unwrap_or(0);
    let ascii = script::MathScript::of_locale() == script::MathScript::Ascii;
    let (tick, begun) = if ascii { ("x", "~") } else { ("✓", "…") };
    let mut text = String::new();
    for name in preset::lessons() {
        let mark = match mark(name) {
            LessonMark { finished: true, .. } => tick,
            LessonMark { step: 0, .. } => " ",
            LessonMark { .. } => begun,
        };
        text.push_str(&format!("{mark} {name:width$}  {}\n", title(name)));
    }
    Output::print(OutputForm::Text, &text)
}

fn take(
    name: &str,
    restart: bool,
    interrupt: &Interrupt,
    shared: &LessonHost<'_>,
) -> Result<(), CommandError> {
    let request = (shared.request)()?;
    let source = source(name)?;
    let (script, system, called) = (shared.scripted)(&source)?;
    let located = |diagnostics: Vec<_>| record::located(&source, &diagnostics);
    let mut lesson = Lesson::watched(script, &system, &called).map_err(located)?;
    // the progress of a file of one's own is not kept: another file may have its name tomorrow
    let file =
        if preset::lesson(name).is_some() { LessonProgress::file().map(Some) } else { Ok(None) };
    let file = file.unwrap_or_else(|why| {
        stderr::report(&why.to_string());
        None
    });
    if let (Some(file), false) = (&file, restart) {
        match LessonProgress::read(file) {
            Ok(progress) => {
                let step = progress.lessons.get(name).map_or(0, |mark| mark.step);
                lesson.resume(step).map_err(|diagnostic| located(vec![diagnostic]))?;
            }
            Err(why) => stderr::report(&why.to_string()),
        }
    }
    // the terminal must be restored first
    interrupt.stand_down();
    let (ending, outcome) = match shell::take_lesson(&mut lesson, &request) {
        Ok(done) => done,
        Err(error) => return (shared.ended)(Err(error)),
    };
    let mark = LessonMark::of(&lesson);
    if let Some(file) = &file {
        LessonProgress::note(file, name, mark)
            .map_err(|why| CommandError::CouldNotWrite(why.to_string()))?;
    }
    outcome.map_err(|diagnostic| located(vec![diagnostic]))?;
    if ending == Ending::Quit && !mark.finished && file.is_some() {
        stderr::report(&format!("`phaselab lessons {}` continues here", printable::line(name)));
    }
    (shared.ended)(Ok(ending))
}
