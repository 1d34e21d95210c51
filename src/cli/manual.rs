//! `phaselab man`: the manual, generated from the program's own tables.

use std::io::{self, Write};

use clap_mangen::Man;
use clap_mangen::roff::{Roff, bold, roman};

use super::error::CommandError;
use super::exit::EXITS;
use super::output::{Output, OutputForm};
use crate::app::gestures::{GESTURES, MOUSE};
use crate::app::keymap::{KEYS, KeyContext};
use crate::shell::options::rows;

/// Print the manual page of phaselab, or of one of its commands.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab man | man -l -             read it
  phaselab man derive | man -l -      the page of a command
  phaselab man > ~/.local/share/man/man1/phaselab.1")]
pub(super) struct Arguments {
    /// The command, in one or more words.
    #[arg(value_name = "COMMAND")]
    command: Vec<String>,
}

/// The files that the program reads and writes, relative to the user's folders.
const FILES: &[(&str, &str)] = &[
    (
        "~/.config/phaselab/config.toml",
        "The configuration: an option of the lab for each key. \
         phaselab config print-default prints one to begin with.",
    ),
    (
        "~/.config/phaselab/presets/",
        "Systems of your own, one TOML file each; they stand beside the shipped ones and take precedence over those of the same name.",
    ),
    (
        "~/.local/state/phaselab/session.toml",
        "The last session, saved whenever the lab is left; --resume continues it.",
    ),
    (
        "~/.local/state/phaselab/texts.toml",
        "Texts with unsaved changes; they are there when their systems are edited again.",
    ),
];

/// The environment variables, apart from those of the options, which come first.
const ENVIRONMENT: &[(&str, &str)] = &[
    ("NO_COLOR", "No colours, whatever the configuration says."),
    ("COLORTERM, TERM", "How many colours the terminal has. The lab does not run where TERM=dumb."),
    ("LC_ALL, LC_CTYPE, LANG", "Whether mathematics and plots may be drawn in UTF-8."),
    ("SSH_CONNECTION, SSH_TTY", "That the terminal is at the other end of an ssh connection."),
    ("XDG_CONFIG_HOME, HOME", "Where the configuration and your presets are."),
    ("XDG_STATE_HOME", "Where the last session is kept."),
];

/// `command` is the whole command line.
pub(super) fn execute(arguments: &Arguments, command: clap::Command) -> Result<(), CommandError> {
    let page = match arguments.command.as_slice() {
        [] => whole(command),
        words => of_command(command, words)?,
    };
    let mut out = Output::open(None, OutputForm::Text)?;
    page.and_then(|page| out.write_all(&page)).map_err(|error| out.failed(&error))?;
    out.finish()
}

/// The page of the program.
fn whole(command: clap::Command) -> io::Result<Vec<u8>> {
    let examples = examples(&command);
    let man = Man::new(command.disable_help_subcommand(true)).manual("phaselab");
    let mut page = head(&man)?;
    man.render_subcommands_section(&mut page)?;
    let mut roff = Roff::new();
    keys(&mut roff);
    roff.control("SH", ["FILES"]);
    for (path, about) in FILES {
        entry(&mut roff, path, about);
    }
    roff.control("SH", ["ENVIRONMENT"]);
    for row in rows() {
        entry(&mut roff, &row.variable(), &format!("As --{}: {}", row.name, row.about));
    }
    for (names, about) in ENVIRONMENT {
        entry(&mut roff, names, about);
    }
    roff.control("SH", ["EXIT STATUS"]);
    for exit in EXITS {
        entry(&mut roff, exit.code, exit.when);
    }
    show(&mut roff, &examples);
    roff.to_writer(&mut page)?;
    man.render_version_section(&mut page)?;
    Ok(page)
}

/// What every page begins with.
fn head(man: &Man) -> io::Result<Vec<u8>> {
    let mut page = Vec::new();
    man.render_title(&mut page)?;
    man.render_name_section(&mut page)?;
    man.render_synopsis_section(&mut page)?;
    man.render_description_section(&mut page)?;
    man.render_options_section(&mut page)?;
    Ok(page)
}

fn of_command(
    mut command: clap::Command,
    words: &[String],
) -> Result<io::Result<Vec<u8>>, CommandError> {
    command.build();
    let mut found = &command;
    for word in words {
        found = found.find_subcommand(word).ok_or_else(|| {
            let names = found.get_subcommands().map(clap::Command::get_name);
            let near = crate::diagnostic::nearest(word, names);
            let help = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            let word = crate::printable::quoted(word);
            CommandError::WrongUse(format!("unknown command `{word}`{help}"))
        })?;
    }
    let examples = examples(found);
    let man = Man::new(found.clone()).manual("phaselab");
    let render = move || {
        let mut page = head(&man)?;
        let mut roff = Roff::new();
        show(&mut roff, &examples);
        roff.control("SH", ["SEE ALSO"]);
        roff.text([bold("phaselab"), roman("(1)")]);
        roff.to_writer(&mut page)?;
        Ok(page)
    };
    Ok(render())
}

/// The keys, by context, and the mouse.
fn keys(roff: &mut Roff) {
    roff.control("SH", ["KEYS"]);
    for context in KeyContext::ALL {
        let rows: Vec<_> = KEYS.iter().filter(|row| row.context == context).collect();
        if rows.is_empty() {
            continue;
        }
        roff.control("SS", [context.title()]);
        for row in rows {
            entry(roff, &row.key_names().join("  "), row.help);
        }
    }
    roff.control("SS", [MOUSE]);
    for (what, does) in GESTURES {
        entry(roff, what, does);
    }
}

fn entry(roff: &mut Roff, name: &str, about: &str) {
    roff.control("TP", []);
    roff.text([bold(name)]);
    roff.text([roman(about)]);
}

/// The lines below `Examples:` in a command's help.
fn examples(command: &clap::Command) -> Vec<String> {
    let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
    let lines = help.lines().skip_while(|line| *line != "Examples:").skip(1);
    lines.take_while(|line| line.starts_with("  ")).map(|line| line[2..].to_owned()).collect()
}

fn show(roff: &mut Roff, examples: &[String]) {
    if examples.is_empty() {
        return;
    }
    roff.control("SH", ["EXAMPLES"]);
    roff.control("nf", []);
    for line in examples {
        roff.text([roman(line.as_str())]);
    }
    roff.control("fi", []);
}
