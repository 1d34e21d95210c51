//! `phaselab [PRESET|FILE]`: the laboratory on the screen, and `--demo`: a demo in it.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Arg, ArgAction, ArgMatches, Command, FromArgMatches};

use super::failure::CommandError;
use super::output::{Form, Output};
use super::{config, play, record};
use crate::preset::{Catalog, Origin, is_path};
use crate::record::ScriptRunner;
use crate::shell::options::{Choice, Kind, OPTIONS};
use crate::shell::{self, Ending, LabError, Options, Request, SessionError};

/// What to open and how to show it: a name, and an argument for each row of [`OPTIONS`].
#[derive(Debug)]
pub(super) struct Arguments {
    name: Option<String>,
    demo: bool,
    options: Options,
}

/// The flag that has a demo performed.
const DEMO: &str = "demo";

impl clap::Args for Arguments {
    fn augment_args(command: Command) -> Command {
        let name = Arg::new("name").value_name("PRESET|FILE").help("A preset's name, or a file");
        let demo = Arg::new(DEMO)
            .long(DEMO)
            .action(ArgAction::SetTrue)
            .conflicts_with_all(["resume", "watch", "log"])
            .help(
                "Perform a demo, then end: a preset's own, a script, or a tour where none is named",
            );
        OPTIONS
            .iter()
            .fold(command.arg(name).arg(demo), |command, choice| command.arg(argument(choice)))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for Arguments {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let mut options = Options::default();
        for choice in OPTIONS {
            if let Some(word) = matches.get_one::<String>(choice.name) {
                options.ask(choice.name, word);
            }
        }
        let demo = matches.get_flag(DEMO);
        Ok(Self { name: matches.get_one("name").cloned(), demo, options })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// A row of the table as an argument.
fn argument(choice: &'static Choice) -> Arg {
    let about = choice.about.trim_end_matches('.').to_owned();
    let argument = Arg::new(choice.name).long(choice.name);
    let argument = match choice.letter {
        Some(letter) => argument.short(letter),
        None => argument,
    };
    let argument = if choice.excludes_name { argument.conflicts_with("name") } else { argument };
    match choice.kind {
        Kind::Switch => argument
            .num_args(0..=1)
            .require_equals(true)
            .default_missing_value("true")
            .value_name("true|false")
            .value_parser(["true", "false"])
            .hide_possible_values(true)
            .help(about),
        Kind::Word(words) => {
            let value = |&(word, about): &(&'static str, &'static str)| {
                PossibleValue::new(word).help(about)
            };
            argument
                .value_name("WORD")
                .value_parser(PossibleValuesParser::new(words.iter().map(value)))
                .help(about)
        }
        Kind::Text { shape, bare, .. } => {
            let argument = match bare {
                Some(bare) => {
                    argument.num_args(0..=1).require_equals(true).default_missing_value(bare)
                }
                None => argument,
            };
            argument
                .value_name("WORD")
                .allow_hyphen_values(true)
                .value_parser(clap::builder::StringValueParser::new().try_map(|word: String| {
                    choice.accept(&word).map(|()| word).map_err(|wrong| wrong.message)
                }))
                .help(format!("{about}: {shape}"))
        }
        Kind::Count { auto, .. } => argument
            .value_name("N")
            .allow_hyphen_values(true)
            .value_parser(clap::builder::StringValueParser::new().try_map(|word: String| {
                choice.accept(&word).map(|()| word).map_err(|wrong| wrong.message)
            }))
            .help(format!("{about}; where it is left out {auto}")),
    }
}

/// What a terminal is to be used with: what was asked for, else the environment, else the configuration.
pub(super) fn request(name: Option<String>, asked: Options) -> Result<Request, CommandError> {
    let variable = |name: &str| std::env::var(name).ok();
    let environment = Options::of_environment(&variable).map_err(CommandError::WrongUse)?;
    let configured = config::options()?.within(&variable);
    Ok(Request::new(name, &asked.or(environment).or(configured)))
}

pub(super) fn perform(arguments: &Arguments) -> Result<(), CommandError> {
    if arguments.demo {
        return perform_demo(arguments);
    }
    if let Some(message) = arguments.name.as_deref().and_then(super::unknown) {
        return Err(CommandError::WrongUse(message));
    }
    if arguments.options.is_on("watch") {
        watchable(arguments.name.as_deref())?;
    }
    let mut request = request(arguments.name.clone(), arguments.options.clone())?;
    let mut ended = shell::run(&request);
    let gone = matches!(ended, Err(LabError::SessionError(_) | LabError::NotFound(_)));
    if gone && request.resume && !arguments.options.is_on("resume") {
        // a session is gone on with wherever there is one; here there is none yet, or none that can be gone on with
        request.resume = false;
        ended = shell::run(&request);
    }
    how_it_ended(ended)
}

/// A demo on the terminal. Its last picture stays, and what is wrong with its script is reported, once the terminal is given
/// back.
fn perform_demo(arguments: &Arguments) -> Result<(), CommandError> {
    let request = request(None, arguments.options.clone())?;
    let source = play::source(arguments.name.as_deref())?;
    let (script, system, name) = play::scripted(&source)?;
    let wrong = |mistake| record::told(&source, &[mistake]);
    let performance = ScriptRunner::watched(script, &system, &name).map_err(wrong)?;
    let (ending, outcome) = match shell::perform_demo(performance, &request) {
        Ok(done) => done,
        Err(refusal) => return how_it_ended(Err(refusal)),
    };
    if let (Ending::Quit, Some(picture)) = (ending, outcome.map_err(wrong)?) {
        Output::print(Form::Coloured, &picture)?;
    }
    how_it_ended(Ok(ending))
}

/// What is shipped has no file that could change.
fn watchable(name: Option<&str>) -> Result<(), CommandError> {
    let Some(name) = name.filter(|name| !is_path(name)) else { return Ok(()) };
    let catalog = Catalog::load();
    let entry = catalog.entries().iter().find(|entry| entry.name == name);
    match entry.map(|entry| &entry.origin) {
        Some(Origin::Shipped) => Err(CommandError::WrongUse(format!(
            "`{name}` is shipped with phaselab and has no file to be watched; open it, press E and Ctrl-s to save a \
             copy of your own, and watch that"
        ))),
        _ => Ok(()),
    }
}

/// What an ending on the terminal means for the exit code.
pub(super) fn how_it_ended(ended: Result<Ending, LabError>) -> Result<(), CommandError> {
    match ended {
        Ok(Ending::Quit) => Ok(()),
        Ok(Ending::Gone) => Err(CommandError::Signal(signal_hook::consts::SIGHUP)),
        Ok(Ending::Signal(number)) => Err(CommandError::Signal(number)),
        Err(refusal @ LabError::System(_)) => Err(CommandError::CouldNot(refusal.to_string())),
        Err(refusal @ (LabError::Unsaved(_) | LabError::Unrecorded(_) | LabError::LogError(_))) => {
            Err(CommandError::CouldNotWrite(refusal.to_string()))
        }
        Err(LabError::SessionError(
            why @ (SessionError::Newer { .. } | SessionError::Malformed { .. }),
        )) => Err(CommandError::WrongFile(why.to_string())),
        Err(refusal) => Err(CommandError::WrongUse(refusal.to_string())),
    }
}
