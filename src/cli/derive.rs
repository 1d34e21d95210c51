//! `phaselab derive`: what follows from a law of motion, to be read, typeset or checked by another
//! program.

mod body;
mod json;
mod latex;
mod text;

use std::ffi::OsString;

use super::failure::CommandError;
use super::format::Format;
use super::open;
use super::output::Output;
use super::script::Script;
use crate::mechanics;

/// Show what follows from L or H: equations of motion, and what is conserved and why.
///
/// Momenta, mass matrix, equations of motion, the Hamiltonian (or why it has no closed form), the
/// energy and the law of its change, cyclic coordinates, what is conserved and why; of every
/// declared observable whether it is conserved.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab derive heavy-top
  phaselab derive my/system.toml --format latex > equations.tex
  phaselab derive planet --format json | jq .equations")]
pub(super) struct Arguments {
    /// A preset's name, or a file.
    #[arg(value_name = "PRESET|FILE")]
    name: OsString,
    /// How it is written.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

pub(super) fn perform(arguments: &Arguments) -> Result<(), CommandError> {
    let document = open::find(&arguments.name)?;
    let model = open::read(&document)?;
    let mut equations = open::derive(&document, &model)?;
    let classes = mechanics::classes(&model, &mut equations);
    let text = match arguments.format {
        Format::Text => text::write(&model, &equations, &classes, Script::of_locale()),
        Format::Latex => latex::write(&model, &equations),
        Format::Json => json::write(&model, &equations, &classes),
    };
    Output::print(arguments.format.form(), &text)
}
