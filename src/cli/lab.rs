//! `phaselab [PRESET|FILE]`: the laboratory on the screen, and `--demo`: a demo in it.

use std::ffi::OsString;
use std::io::IsTerminal;

use super::error::CommandError;
use super::output::{Output, OutputForm};
use super::start_options::StartOptions;
use super::{config, demo_source, record, stderr};
use crate::preset::{Catalog, PresetOrigin, is_path};
use crate::record::ScriptRunner;
use crate::shell::{
    self, Ending, LabError, Options, Request, SessionError, options, options::Words,
};

/// What to open and how to show it.
#[derive(Debug, clap::Args)]
#[group(skip)]
pub(super) struct Arguments {
    /// A preset's name, or a file.
    #[arg(value_name = "PRESET|FILE", conflicts_with = "resume")]
    pub(super) name: Option<String>,
    /// Perform a demo, then end: a preset's own, a script, or a tour if none is named.
    #[arg(long, conflicts_with_all = ["resume", "watch", "log", "set", "init", "method", "step", "tolerance"])]
    demo: bool,
    #[command(flatten)]
    start: StartOptions,
    #[command(flatten)]
    pub(super) options: Options,
}

impl Arguments {
    /// The name of the system to open; a demo's name is not one.
    pub(super) fn system(&self) -> Option<&str> {
        self.name.as_deref().filter(|_| !self.demo)
    }
}

/// Reads the options among the words of the command line, over defaults for them.
pub(super) type ReadOptions = fn(Words, &[OsString]) -> Result<Options, CommandError>;

/// The request for a terminal: the options of the command line, then those of the environment, then the
/// configuration.
pub(super) fn request(
    name: Option<String>,
    words: &[OsString],
    read: ReadOptions,
) -> Result<Request, CommandError> {
    let variable = |name: &str| std::env::var(name).ok();
    let environment = options::of_environment(&variable).map_err(CommandError::WrongUse)?;
    let mut defaults = config::options()?;
    // many programs use this variable, which takes precedence over the configuration
    if variable("NO_COLOR").is_some_and(|value| !value.is_empty()) {
        defaults.retain(|(name, _)| *name != "color");
    }
    defaults.extend(environment);
    Ok(Request::new(name, &read(defaults, words)?))
}

pub(super) fn execute(
    arguments: &Arguments,
    words: &[OsString],
    read: ReadOptions,
) -> Result<(), CommandError> {
    if arguments.options.resume && arguments.start.is_given() {
        let what = "--resume continues a motion as it was; --set, --init, --method, --step and --tolerance begin another";
        return Err(CommandError::WrongUse(what.to_owned()));
    }
    let start = arguments.start.checkpoint(arguments.system())?;
    if arguments.demo {
        return play_demo(arguments, words, read);
    }
    if arguments.options.watch {
        watchable(arguments.name.as_deref())?;
    }
    let mut request = request(arguments.name.clone(), words, read)?;
    request.start = start;
    let mut ended = shell::run(&request);
    let not_found = matches!(ended, Err(LabError::SessionError(_) | LabError::NotFound(_)));
    if not_found && request.resume && !arguments.options.resume {
        // a session is resumed only if there is one; here there is none yet, or none that can be resumed
        request.resume = false;
        ended = shell::run(&request);
    }
    if matches!(ended, Ok(Ending::Quit)) && std::io::stderr().is_terminal() && shell::has_session()
    {
        stderr::report("`phaselab --resume` continues where you left off");
    }
    how_it_ended(ended)
}

/// Performs a demo on the terminal. Its last picture stays, and errors in its script are reported after the
/// terminal is restored.
fn play_demo(
    arguments: &Arguments,
    words: &[OsString],
    read: ReadOptions,
) -> Result<(), CommandError> {
    let request = request(None, words, read)?;
    let source = demo_source::source(arguments.name.as_deref())?;
    let (script, system, name) = demo_source::scripted(&source)?;
    let wrong = |diagnostic| record::located(&source, &[diagnostic]);
    let script = ScriptRunner::watched(script, &system, &name).map_err(wrong)?;
    let (ending, outcome) = match shell::play_demo(script, &request) {
        Ok(done) => done,
        Err(error) => return how_it_ended(Err(error)),
    };
    if let (Ending::Quit, Some(picture)) = (ending, outcome.map_err(wrong)?) {
        Output::print(OutputForm::Coloured, &picture)?;
    }
    how_it_ended(Ok(ending))
}

/// Refuses to watch a shipped preset, which has no file that could change.
fn watchable(name: Option<&str>) -> Result<(), CommandError> {
    let Some(name) = name.filter(|name| !is_path(name)) else { return Ok(()) };
    let catalog = Catalog::load();
    let entry = catalog.entries().iter().find(|entry| entry.name == name);
    match entry.map(|entry| &entry.origin) {
        Some(PresetOrigin::Shipped) => Err(CommandError::WrongUse(format!(
            "`{name}` is shipped with phaselab and has no file to be watched; open it, press E and Ctrl-s to save a \
             copy of your own, and watch that"
        ))),
        _ => Ok(()),
    }
}

/// Converts the end of the laboratory to an exit code.
pub(super) fn how_it_ended(ended: Result<Ending, LabError>) -> Result<(), CommandError> {
    match ended {
        Ok(Ending::Quit) => Ok(()),
        Ok(Ending::HungUp) => Err(CommandError::Signal(signal_hook::consts::SIGHUP)),
        Ok(Ending::Signal(number)) => Err(CommandError::Signal(number)),
        Err(error @ LabError::System(_)) => Err(CommandError::CouldNot(error.to_string())),
        Err(error @ (LabError::Unsaved(_) | LabError::Unrecorded(_) | LabError::LogError(_))) => {
            Err(CommandError::CouldNotWrite(error.to_string()))
        }
        Err(LabError::SessionError(
            why @ (SessionError::Newer { .. } | SessionError::Malformed { .. }),
        )) => Err(CommandError::WrongFile(why.to_string())),
        Err(error) => Err(CommandError::WrongUse(error.to_string())),
    }
}
