//! The command line: the subcommands and their selection.
//!
//! In: words. Out: an exit code. Never here: what a subcommand does.

use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue};
use clap::parser::ValueSource;
use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand};

use super::actions;
use super::assignment::number;
use super::bracket;
use super::check;
use super::completions;
use super::config;
use super::demo;
use super::demo_source;
use super::derive;
use super::doctor;
use super::equilibria;
use super::error::CommandError;
use super::exit;
use super::flow;
use super::fmt;
use super::interrupt::Interrupt;
use super::invariants;
use super::lab;
use super::lesson;
use super::list;
use super::lyapunov;
use super::manual;
use super::methods;
use super::new;
use super::orbit;
use super::path;
use super::play;
use super::plot;
use super::record;
use super::reverse;
use super::run;
use super::section;
use super::spectrum;
use super::standard_output::stdout;
use super::stderr;
use super::sweep;
use super::symmetries;
use super::theme;
use crate::diagnostic::nearest;
use crate::preset::{Catalog, file_here, is_path};
use crate::printable;
use crate::shell::Options;
use crate::shell::options::{Words, with_defaults};

/// A laboratory for analytical mechanics.
///
/// Without a command it opens the laboratory on the screen, at a preset or a file, or at the
/// picker if no name is given. A name with a `/` in it or ending in `.toml` is a file, any
/// other a preset; your own presets (in `phaselab/presets` of your configuration folder) come
/// before shipped ones of the same name.
#[derive(Debug, Parser)]
#[command(name = "phaselab", version, args_conflicts_with_subcommands = true)]
pub(super) struct Arguments {
    #[command(flatten)]
    pub(super) lab: lab::Arguments,
    #[command(subcommand)]
    command: Option<CliCommand>,
}

/// The text below the help of the program itself.
const EXAMPLES: &str = "\
Examples:
  phaselab tour                        begin here: three minutes, to a Lagrangian of your own
  phaselab                             choose a system and watch it move
  phaselab double-pendulum             open a preset
  phaselab pendulum --set l=2          with another length (Ctrl-y copies it)
  phaselab my/system.toml              open a file
  phaselab derive heavy-top            what follows from its Lagrangian
  phaselab --demo                      a tour of ten seconds that ends by itself
  phaselab run pendulum > swing.csv    the same motion without a screen
  phaselab man | man -l -              the manual, with all keys";

/// The whole command line, from which help, completions and the manual are made.
pub fn command() -> clap::Command {
    let exits = exit::lines(80);
    let takes = |command: clap::Command, name: &str| {
        command.mut_subcommand(name, |sub| sub.args(screen_options()))
    };
    let command = ON_SCREEN.into_iter().fold(Arguments::command(), takes);
    command.after_help(format!("{EXAMPLES}\n\nExit status:\n{exits}"))
}

/// The options of the laboratory that commands on its screen take, before their name or after it.
fn screen_options() -> Vec<clap::Arg> {
    let lab = Options::augment_args(clap::Command::new("options"));
    let own = lab.get_arguments().filter(|option| {
        option.get_long().is_some_and(|name| !OF_LAB_ALONE.iter().any(|other| other[2..] == *name))
    });
    own.map(|option| option.clone().help_heading("Screen")).collect()
}

/// Takes the options of the laboratory among the arguments of a command on its screen, as words.
fn options_after(matches: &clap::ArgMatches) -> Vec<OsString> {
    let Some((_, given)) = matches.subcommand().filter(|(name, _)| ON_SCREEN.contains(name)) else {
        return Vec::new();
    };
    let options = screen_options();
    let given = options.iter().filter_map(|option| {
        let id = option.get_id().as_str();
        if given.value_source(id) != Some(ValueSource::CommandLine) {
            return None;
        }
        let mut word = OsString::from(format!("--{}=", option.get_long()?));
        word.push(given.get_raw(id)?.next()?);
        Some(word)
    });
    given.collect()
}

/// The commands, described with their arguments.
#[derive(Debug, Subcommand)]
enum CliCommand {
    List(list::Arguments),
    Derive(derive::Arguments),
    Check(check::Arguments),
    New(new::Arguments),
    Fmt(fmt::Arguments),
    Bracket(bracket::Arguments),
    Invariants(invariants::Arguments),
    Symmetries(symmetries::Arguments),
    Run(Box<run::Arguments>),
    Flow(Box<flow::Arguments>),
    Lyapunov(Box<lyapunov::Arguments>),
    Reverse(Box<reverse::Arguments>),
    Orbit(Box<orbit::Arguments>),
    Spectrum(Box<spectrum::Arguments>),
    Equilibria(Box<equilibria::Arguments>),
    Section(Box<section::Arguments>),
    Sweep(Box<sweep::Arguments>),
    Path(Box<path::Arguments>),
    Actions(Box<actions::Arguments>),
    Record(Box<record::Arguments>),
    Script(demo::Arguments),
    Play(play::Arguments),
    Plot(plot::Arguments),
    Tour(lesson::Tour),
    Lessons(lesson::Lessons),
    Lesson(lesson::Check),
    Methods(methods::Arguments),
    Doctor(doctor::Arguments),
    Config(config::Arguments),
    Completions(completions::Arguments),
    Man(manual::Arguments),
    Theme(theme::Arguments),
}

/// Executes the arguments, of which the first is the program's name.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let words: Vec<OsString> = arguments.into_iter().collect();
    let mut whole = command();
    let (of_screen, words) = match options_first(&whole, &words) {
        Ok(parts) => parts,
        Err(message) => {
            stderr::report(&message);
            return CommandError::WrongUse(message).code();
        }
    };
    let read = whole.try_get_matches_from_mut(&words);
    let read = read.and_then(|m| Ok((Arguments::from_arg_matches(&m)?, options_after(&m))));
    let (arguments, after) = match read {
        Ok(read) => read,
        Err(error) => {
            // a request for help is not an error
            if let Some(message) = misspelt(&words).filter(|_| error.use_stderr()) {
                stderr::report(&message);
                return CommandError::WrongUse(message).code();
            }
            return refused(&words, &error);
        }
    };
    match execute(arguments, &words, &[of_screen, after].concat()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            stderr::report(error.message());
            error.code()
        }
    }
}

fn parse(command: clap::Command, words: &[OsString]) -> Result<Arguments, clap::Error> {
    Arguments::from_arg_matches(&command.try_get_matches_from(words)?)
}

/// The options of the lab among the words, over defaults for them.
fn options(defaults: Words, words: &[OsString]) -> Result<Options, CommandError> {
    // the words were already valid, and so are the defaults
    let arguments = parse(with_defaults(command(), defaults), words)
        .map_err(|why| CommandError::WrongUse(why.to_string().trim_end().to_owned()))?;
    Ok(arguments.lab.options)
}

/// The commands that show something on the screen of the laboratory, and take its options before their name or after it.
const ON_SCREEN: [&str; 3] = ["tour", "lessons", "play"];

/// The options of the laboratory that none of these takes.
const OF_LAB_ALONE: [&str; 4] = ["--resume", "--watch", "--log", "--demo"];

/// Takes options of the laboratory before the name of a command apart from the words of the command, or says that they do
/// not belong there. Words without such a command are left as they are.
fn options_first(
    whole: &clap::Command,
    words: &[OsString],
) -> Result<(Vec<OsString>, Vec<OsString>), String> {
    let names: Vec<&str> = whole.get_subcommands().map(clap::Command::get_name).collect();
    let is_command = |word: &OsString| word.to_str().is_some_and(|word| names.contains(&word));
    let only_options = |at: &usize| {
        let read = parse(whole.clone(), &words[..*at]);
        read.is_ok_and(|a| a.command.is_none() && a.lab.name.is_none())
    };
    let found = (2..words.len()).find(|at| is_command(&words[*at]));
    let Some(at) = found.filter(only_options) else {
        let program = words.first().into_iter().cloned().collect();
        return Ok((program, words.to_vec()));
    };
    let name = words[at].to_string_lossy();
    let given = words[1..at].iter().map(|word| word.to_string_lossy());
    let mut given = given.filter(|word| word.starts_with('-'));
    let bare = |word: &str| word.split('=').next().unwrap_or_default().to_owned();
    let of_lab = |word: &str| OF_LAB_ALONE.contains(&&*bare(word)) || !word.starts_with("--");
    let misplaced = given.find(|word| !ON_SCREEN.contains(&&*name) || of_lab(word));
    match misplaced {
        Some(word) => Err(format!(
            "`{}` is an option of the laboratory, which `{name}` does not take",
            printable::quoted(&bare(&word))
        )),
        None => {
            let program = &words[..1];
            Ok((words[..at].to_vec(), [program, &words[at..]].concat()))
        }
    }
}

fn execute(
    arguments: Arguments,
    words: &[OsString],
    of_screen: &[OsString],
) -> Result<(), CommandError> {
    let Some(command) = arguments.command else {
        return match arguments.lab.system().and_then(unknown) {
            Some(message) => Err(CommandError::WrongUse(message)),
            None => lab::execute(&arguments.lab, words, options),
        };
    };
    let interrupt = Interrupt::watch();
    dispatch(command, &interrupt, of_screen).map_err(|error| match interrupt.signal() {
        // whatever failed, the signal stopped it
        Some(signal) => CommandError::Signal(signal),
        None => error,
    })
}

fn dispatch(
    command: CliCommand,
    interrupt: &Interrupt,
    of_screen: &[OsString],
) -> Result<(), CommandError> {
    let lessons = lesson::LessonHost {
        scripted: demo_source::scripted,
        request: &|| lab::request(None, of_screen, options),
        ended: lab::how_it_ended,
    };
    match command {
        CliCommand::List(arguments) => list::execute(&arguments),
        CliCommand::Derive(arguments) => derive::execute(&arguments),
        CliCommand::Check(arguments) => check::execute(&arguments, interrupt),
        CliCommand::New(arguments) => new::execute(&arguments),
        CliCommand::Fmt(arguments) => fmt::execute(&arguments),
        CliCommand::Bracket(arguments) => bracket::execute(&arguments),
        CliCommand::Invariants(arguments) => invariants::execute(&arguments),
        CliCommand::Symmetries(arguments) => symmetries::execute(&arguments),
        CliCommand::Run(arguments) => run::execute(&arguments, interrupt),
        CliCommand::Flow(arguments) => flow::execute(&arguments, interrupt),
        CliCommand::Lyapunov(arguments) => lyapunov::execute(&arguments, interrupt),
        CliCommand::Reverse(arguments) => reverse::execute(&arguments, interrupt),
        CliCommand::Orbit(arguments) => orbit::execute(&arguments, interrupt),
        CliCommand::Spectrum(arguments) => spectrum::execute(&arguments, interrupt),
        CliCommand::Equilibria(arguments) => equilibria::execute(&arguments, interrupt),
        CliCommand::Section(arguments) => section::execute(&arguments, interrupt),
        CliCommand::Sweep(arguments) => sweep::execute(&arguments, interrupt),
        CliCommand::Path(arguments) => path::execute(&arguments, interrupt),
        CliCommand::Actions(arguments) => actions::execute(&arguments, interrupt),
        CliCommand::Record(arguments) => record::execute(&arguments),
        CliCommand::Script(arguments) => demo::execute(&arguments),
        CliCommand::Plot(arguments) => plot::execute(&arguments, interrupt),
        CliCommand::Play(arguments) => play::execute(&arguments, of_screen, options, interrupt),
        CliCommand::Tour(arguments) => lesson::tour(&arguments, interrupt, &lessons),
        CliCommand::Lessons(arguments) => lesson::execute(&arguments, interrupt, &lessons),
        CliCommand::Lesson(arguments) => lesson::check(&arguments, &lessons),
        CliCommand::Methods(arguments) => methods::execute(&arguments),
        CliCommand::Doctor(arguments) => doctor::execute(&arguments),
        CliCommand::Config(arguments) => config::execute(&arguments),
        CliCommand::Completions(arguments) => completions::execute(&arguments, self::command()),
        CliCommand::Man(arguments) => manual::execute(&arguments, self::command()),
        CliCommand::Theme(arguments) => theme::execute(&arguments),
    }
}

/// Shows help, the version, or what is wrong with the words.
fn refused(words: &[OsString], error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        let printed = stdout().and_then(|mut out| error.print().and_then(|()| out.flush()));
        return match printed.map_err(|why| CommandError::writing("standard output", &why)) {
            Ok(()) | Err(CommandError::NobodyReads) => ExitCode::SUCCESS,
            Err(error) => {
                stderr::report(error.message());
                error.code()
            }
        };
    }
    let rendered = error.render().to_string();
    let shown = fit(&rendered, words);
    if shown == rendered {
        // in colour, if that is wanted; a failure to write is ignored
        let _ = error.print();
    } else {
        stderr::show(&shown);
    }
    if let Some(hint) = assigned(words, error) {
        stderr::report(&hint);
    }
    ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(exit::WRONG_USE))
}

/// How a parameter is set, where words try to set one in another way: `l=2` or `--l 2`.
fn assigned(words: &[OsString], error: &clap::Error) -> Option<String> {
    if error.kind() != clap::error::ErrorKind::UnknownArgument {
        return None;
    }
    // a misspelt option is no parameter, and not every command sets one
    let command = Arguments::command();
    let takes_parameters = |word: &OsString| {
        let command = command.find_subcommand(word)?;
        command.get_arguments().any(|argument| argument.get_long() == Some("set")).then_some(())
    };
    words.iter().find_map(takes_parameters)?;
    let ContextValue::String(given) = error.get(ContextKind::InvalidArg)? else { return None };
    let (name, value) = match (given.strip_prefix("--"), given.split_once('=')) {
        (Some(option), _) => {
            let at = words.iter().position(|word| word.to_str() == Some(given))?;
            (option, words.get(at + 1)?.to_str()?)
        }
        (None, assigned) => assigned?,
    };
    number(value).ok()?;
    let [name, value] = [name, value].map(printable::quoted);
    Some(format!(
        "a parameter is set by `--set {name}={value}`, an initial value by `--init {name}={value}`"
    ))
}

/// Makes a message about the words of a command line safe to display, and limits its length.
fn fit(message: &str, words: &[OsString]) -> String {
    let mut text = message.to_owned();
    for word in words.iter().filter_map(|word| word.to_str()) {
        let parts = [Some(word), word.split_once('=').map(|(_, value)| value)];
        for part in parts.into_iter().flatten() {
            let shown = printable::quoted(part);
            if shown != part {
                text = text.replace(part, &shown);
            }
        }
    }
    let lines = text.split('\n').map(|line| printable::shortened(line, LONGEST_LINE));
    printable::lines(&lines.collect::<Vec<_>>().join("\n")).into_owned()
}

/// The greatest length of a line about wrong words; help is narrower.
const LONGEST_LINE: usize = 400;

/// The message if several words begin with no command: with one that resembles it, with an unknown word, or with the name of a
/// system that another name follows. A single word would be the name of a preset.
fn misspelt(words: &[OsString]) -> Option<String> {
    let [_, first, second, ..] = words else { return None };
    let first = first.to_str().filter(|first| !first.starts_with('-'))?;
    let command = Arguments::command();
    let names: Vec<&str> = command.get_subcommands().map(clap::Command::get_name).collect();
    let is_question = first == "help";
    let first = if is_question { second.to_str()? } else { first };
    if names.contains(&first) {
        return None;
    }
    let shown = printable::quoted(first);
    if let Some(near) = nearest(first, names.iter().copied()) {
        return Some(format!("unknown command `{shown}`; did you mean `{near}`?"));
    }
    // an option after a preset's name belongs to the lab, and its errors are reported there
    if second.as_encoded_bytes().starts_with(b"-") {
        return None;
    }
    let is_system =
        || is_path(first) || Catalog::load().entries().iter().any(|entry| entry.name == first);
    if !is_question && is_system() {
        let second = printable::quoted(&second.to_string_lossy());
        return Some(format!(
            "the laboratory opens one system: `{second}` follows `{shown}`; no command is called `{shown}`"
        ));
    }
    Some(format!("unknown command `{shown}`; `phaselab --help` lists the commands"))
}

/// The message for a word that is neither a command nor a preset, with the nearest that is.
fn unknown(word: &str) -> Option<String> {
    let catalog = Catalog::load();
    let presets = || catalog.entries().iter().map(|entry| entry.name.as_str());
    if is_path(word) || presets().any(|preset| preset == word) {
        return None;
    }
    let command = Arguments::command();
    let commands: Vec<&str> = command.get_subcommands().map(clap::Command::get_name).collect();
    let file = file_here(word);
    let names = || nearest(word, commands.iter().copied().chain(presets()));
    let near = catalog.titled(word).or_else(names).or_else(|| catalog.nearest(word));
    let help = match (file, near) {
        (Some(file), _) => format!("did you mean the file `{}`?", printable::quoted(&file)),
        (None, Some(near)) => format!("did you mean `{}`?", printable::line(near)),
        (None, None) => {
            "`phaselab list` lists the presets, `phaselab --help` the commands".to_owned()
        }
    };
    Some(format!("unknown command or preset `{}`; {help}", printable::quoted(word)))
}
