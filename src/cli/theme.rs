//! `phaselab theme list`: the themes of the laboratory, in their colours if the terminal shows them.

use std::io::IsTerminal;

use ratatui::style::{Color, Style};

use super::error::CommandError;
use super::output::{Output, OutputForm};
use crate::view::colour::ColourDepth;
use crate::view::sgr;
use crate::view::theme::{CURVES, PALETTES, Role, Theme};

/// Show the themes of the laboratory.
///
/// The key `T` chooses one in the lab, `--theme` opens it with one, and so does `theme` in the
/// configuration.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab theme list                    where colour is allowed, with swatches")]
pub(super) struct Arguments {
    #[command(subcommand)]
    command: ThemeCommand,
}

#[derive(Debug, clap::Subcommand)]
enum ThemeCommand {
    /// List the themes, with their colours where a terminal shows them.
    List,
}

pub(super) fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let ThemeCommand::List = arguments.command;
    let variable = |name: &str| std::env::var(name).ok();
    let depth = if std::io::stdout().is_terminal() {
        ColourDepth::from_environment(&variable)
    } else {
        ColourDepth::None
    };
    Output::print(OutputForm::Coloured, &text(depth))
}

/// One line per theme.
fn text(depth: ColourDepth) -> String {
    let widest = PALETTES.iter().map(|palette| palette.name.len()).max().unwrap_or(0);
    let line = |palette| {
        let theme = Theme::new(palette, depth);
        format!("{:widest$}  {}{}\n", palette.name, swatches(&theme), palette.about)
    };
    PALETTES.iter().map(line).collect()
}

/// A block in the colour of each curve, and the verdicts in theirs; empty without colour.
fn swatches(theme: &Theme) -> String {
    if theme.depth() == ColourDepth::None {
        return String::new();
    }
    let blocks: String = (0..CURVES).map(|curve| painted("██", theme.curve(curve))).collect();
    let words = [("good", Role::Good), ("warn", Role::Warn), ("bad", Role::Bad)];
    let words = words.map(|(word, role)| painted(word, theme[role]));
    format!("{blocks}  {}  ", words.join(" "))
}

fn painted(text: &str, style: Style) -> String {
    let code = sgr::colour(style.fg.unwrap_or(Color::Reset), sgr::FOREGROUND);
    format!("\x1b[{}m{text}\x1b[39m", sgr::written(&code))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_theme_is_listed_with_its_colours_where_there_are_any() {
        let plain = text(ColourDepth::None);
        assert!(!plain.contains('\x1b'));
        for palette in &PALETTES {
            let line = plain.lines().find(|line| line.starts_with(palette.name)).expect("a line");
            assert!(line.ends_with(palette.about), "{line}");
        }
        let coloured = text(ColourDepth::True);
        let full = coloured.lines().filter(|line| line.matches("38;2;").count() == CURVES + 3);
        assert_eq!(full.count(), PALETTES.len() - 1, "all but the terminal's own: {coloured:?}");
        assert!(text(ColourDepth::Ansi256).contains("38;5;"));
        assert!(text(ColourDepth::Ansi16).lines().all(|line| !line.contains("38;")));
    }
}
