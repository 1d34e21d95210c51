//! How mathematics is written.

use clap::ValueEnum;

use super::output::OutputForm;

/// The three ways.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub(super) enum Format {
    /// For reading: Unicode mathematics, or the syntax of files where the locale is not UTF-8.
    #[default]
    Text,
    /// For typesetting: a fragment for LaTeX with amsmath.
    #[value(alias = "tex")]
    Latex,
    /// One object, its expressions in the syntax of files.
    Json,
}

impl Format {
    pub(super) fn form(self) -> OutputForm {
        match self {
            Format::Text | Format::Latex => OutputForm::Text,
            Format::Json => OutputForm::Json,
        }
    }
}
