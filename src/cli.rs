//! The command line: one file per subcommand, each over the same stages as the laboratory.
//!
//! In: arguments. Out: data on standard output (and nothing else there), mistakes and messages on
//! standard error, an exit code of [`EXITS`]. Output that nobody reads any more (`| head`) ends a
//! command quietly, as done. Never here: mechanics, numbers in motion.

mod assignment;
mod bracket;
mod check;
mod completions;
mod config;
mod decimal;
mod demo;
mod derive;
mod doctor;
mod events;
mod exit;
mod failure;
mod format;
mod lab;
mod list;
mod manual;
mod methods;
mod open;
mod output;
mod play;
mod record;
mod report;
mod rows;
mod run;
mod script;
mod stderr;
mod theme;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::expr::nearest;

use failure::Failure;

pub use exit::{EXITS, Exit};

/// A laboratory for analytical mechanics.
///
/// Without a command it opens the laboratory on the screen, at a preset or a file, or at the
/// picker where no name is given. A name with a `/` in it or ending in `.toml` is a file, any
/// other a preset; your own presets (in `phaselab/presets` of your configuration folder) come
/// before shipped ones of the same name.
#[derive(Debug, Parser)]
#[command(name = "phaselab", version, args_conflicts_with_subcommands = true)]
struct Arguments {
    #[command(flatten)]
    lab: lab::Arguments,
    #[command(subcommand)]
    command: Option<Command>,
}

/// What stands below the help of the program itself.
const EXAMPLES: &str = "\
Examples:
  phaselab                             choose a system and watch it move
  phaselab double-pendulum             open a preset
  phaselab my/system.toml              open a file
  phaselab derive heavy-top            what follows from its Lagrangian
  phaselab --demo                      a tour of ten seconds that ends by itself
  phaselab run pendulum > swing.csv    the same motion without a screen
  phaselab man | man -l -              the manual, with all keys";

/// The whole command line, as help, completions and the manual are made from it.
pub fn command() -> clap::Command {
    let exits = exit::lines(80);
    Arguments::command().after_help(format!("{EXAMPLES}\n\nExit status:\n{exits}"))
}

/// The commands; what each is for stands with its arguments.
#[derive(Debug, Subcommand)]
enum Command {
    List(list::Arguments),
    Derive(derive::Arguments),
    Check(check::Arguments),
    Bracket(bracket::Arguments),
    Run(Box<run::Arguments>),
    Record(Box<record::Arguments>),
    Script(demo::Arguments),
    Play(play::Arguments),
    Methods(methods::Arguments),
    Doctor(doctor::Arguments),
    Config(config::Arguments),
    Completions(completions::Arguments),
    Man(manual::Arguments),
    Theme(theme::Arguments),
}

/// Does what the arguments say; the first is the program's name.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let words: Vec<OsString> = arguments.into_iter().collect();
    let arguments = match parse(&words) {
        Ok(arguments) => arguments,
        Err(error) => {
            if let Some(message) = misspelt(&words) {
                stderr::tell(&message);
                return Failure::WrongUse(message).code();
            }
            // help asked for goes to standard output, and both may have nobody to read them
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(exit::WRONG_USE));
        }
    };
    match perform(arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            stderr::tell(failure.message());
            failure.code()
        }
    }
}

fn parse(words: &[OsString]) -> Result<Arguments, clap::Error> {
    Arguments::from_arg_matches(&command().try_get_matches_from(words)?)
}

fn perform(arguments: Arguments) -> Result<(), Failure> {
    match arguments.command {
        Some(Command::List(arguments)) => list::perform(&arguments),
        Some(Command::Derive(arguments)) => derive::perform(&arguments),
        Some(Command::Check(arguments)) => check::perform(&arguments),
        Some(Command::Bracket(arguments)) => bracket::perform(&arguments),
        Some(Command::Run(arguments)) => run::perform(&arguments),
        Some(Command::Record(arguments)) => record::perform(&arguments),
        Some(Command::Script(arguments)) => demo::perform(&arguments),
        Some(Command::Play(arguments)) => play::perform(&arguments),
        Some(Command::Methods(arguments)) => methods::perform(&arguments),
        Some(Command::Doctor(arguments)) => doctor::perform(&arguments),
        Some(Command::Config(arguments)) => config::perform(&arguments),
        Some(Command::Completions(arguments)) => completions::perform(&arguments),
        Some(Command::Man(arguments)) => manual::perform(&arguments),
        Some(Command::Theme(arguments)) => theme::perform(&arguments),
        None => lab::perform(&arguments.lab),
    }
}

/// What is to be said where the first of several words is almost a command; by itself it would be
/// a preset's name.
fn misspelt(words: &[OsString]) -> Option<String> {
    let [_, first, _, ..] = words else { return None };
    let first = first.to_str().filter(|first| !first.starts_with('-'))?;
    let command = Arguments::command();
    let names: Vec<&str> = command.get_subcommands().map(clap::Command::get_name).collect();
    let near = nearest(first, names.iter().copied()).filter(|near| *near != first)?;
    Some(format!("there is no command `{first}`; did you mean `{near}`?"))
}
