//! `phaselab doctor`: the detected capabilities of the terminal with their reasons, and the glyph sets for
//! inspection.

use std::io::{IsTerminal, stdout};

use rustix::termios::tcgetwinsize;

use super::error::CommandError;
use super::output::{Output, OutputForm};
use crate::shell::diagnosis;
use crate::view::card::card;
use crate::view::glyphs::Glyphs;
use crate::view::words;

/// The columns that a finding has room in, what was found and the evidence each wrapped in its own: 80 in all.
const SUBJECT: usize = 12;
const FOUND: usize = 20;
const EVIDENCE: usize = 45;

/// Report what the laboratory knows about the terminal, and why.
///
/// The terminal itself is not queried; what is reported comes from the environment.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab doctor
  phaselab doctor --glyphs               every set of glyphs in your font")]
pub(super) struct Arguments {
    /// Show every set of glyphs, to see which of them the font has.
    #[arg(long)]
    glyphs: bool,
}

pub(super) fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let variables = |name: &str| std::env::var(name).ok();
    let near = stdout().is_terminal();
    let text = if arguments.glyphs {
        glyphs(Glyphs::from_environment(&variables), near)
    } else {
        let size = tcgetwinsize(rustix::stdio::stdout()).ok().filter(|_| near);
        findings(&variables, size.map(|size| (size.ws_col, size.ws_row)))
    };
    Output::print(OutputForm::Coloured, &text)
}

fn findings(variables: &dyn Fn(&str) -> Option<String>, size: Option<(u16, u16)>) -> String {
    let mut text = String::new();
    for finding in diagnosis(variables, size) {
        let (found, why) = (words(&finding.found, FOUND), words(&finding.why, EVIDENCE));
        for row in 0..found.len().max(why.len()) {
            let subject = if row == 0 { finding.what } else { "" };
            let [found, why] =
                [&found, &why].map(|lines| lines.get(row).map_or("", String::as_str));
            let line = format!("{subject:<SUBJECT$} {found:<FOUND$}  {why}");
            text.push_str(line.trim_end());
            text.push('\n');
        }
    }
    text + "\n--color, --glyphs, --fps and --bandwidth override this;\n\
        `phaselab doctor --glyphs` shows which glyphs the font has.\n"
}

fn glyphs(chosen: Glyphs, near: bool) -> String {
    let mut text = String::new();
    if !near {
        text += "This is not a terminal: run it in the one you use.\n";
    }
    if chosen.is_ascii() {
        text += "The locale is not UTF-8, so plots are drawn in ASCII; what is not ASCII below\n\
            can be judged only where the terminal takes UTF-8.\n";
    }
    text += "A set is in your font where its curve is unbroken, its block at the right is full\n\
        and the bars at the right end are in one column. Select it with --glyphs NAME.\n";
    text += &format!("The default here is {}.\n\n", chosen.name());
    text + &card().join("\n") + "\n"
}
