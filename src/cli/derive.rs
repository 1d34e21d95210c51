//! `phaselab derive`: what follows from a law of motion, to be read, typeset or checked by another
//! program.

mod body;
mod json;
mod latex;
mod text;

use std::io::Write;

use super::failure::Failure;
use super::format::Format;
use super::open;
use super::output::Output;
use super::script::Script;
use crate::mechanics;

/// Show what follows from L or H.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A preset's name, or a file.
    #[arg(value_name = "PRESET|FILE")]
    name: String,
    /// How it is written.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

pub(super) fn perform(arguments: &Arguments) -> Result<(), Failure> {
    let document = open::find(&arguments.name)?;
    let model = open::read(&document)?;
    let mut equations = open::derive(&document, &model)?;
    let classes = mechanics::classes(&model, &mut equations);
    let text = match arguments.format {
        Format::Text => text::write(&model, &equations, &classes, Script::of_locale()),
        Format::Latex => latex::write(&model, &equations),
        Format::Json => json::write(&model, &equations, &classes),
    };
    let mut out = Output::open(None)?;
    out.write_all(text.as_bytes()).map_err(|error| out.failed(&error))?;
    out.finish()
}
