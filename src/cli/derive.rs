//! `phaselab derive`: the consequences of a law of motion for reading, for typesetting, or for
//! another program.

mod json;
mod text;

use std::ffi::OsString;

use super::failure::CommandError;
use super::format::Format;
use super::open;
use super::output::Output;
use super::script::Script;
use crate::experiment::Derived;
use crate::mechanics::{Further, Report, latex};

/// Show what follows from L or H: equations of motion, and what is conserved and why.
///
/// Momenta, mass matrix, equations of motion, the Hamiltonian (or why it has no closed form), the
/// energy and the law of its change, cyclic coordinates, what is conserved and why; of every
/// declared observable whether it is conserved; of transformations whether they are canonical, and
/// K; of generators [H, G]; of a complete integral whether it is one.
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
    let Derived { model, mut equations } = open::derive(&document, model)?;
    equations.find_closed_forms();
    let further = Further::of(&model, &mut equations);
    let report = Report::of(&model, &equations);
    let text = match arguments.format {
        Format::Text => text::write(&report, &further, Script::of_locale()),
        Format::Latex => latex(&report, &further),
        Format::Json => json::write(&report, &further),
    };
    Output::print(arguments.format.form(), &text)
}
