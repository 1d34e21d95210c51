//! `phaselab derive`: the consequences of a law of motion for reading, for typesetting, or for
//! another program.

mod against;
mod json;
mod text;

use std::ffi::OsString;

use self::against::LagrangianComparison;
use super::error::CommandError;
use super::format::Format;
use super::open;
use super::output::Output;
use super::script::MathScript;
use crate::experiment::Derived;
use crate::mechanics::{Further, NamedRamps, Report, Valuation, latex};

/// Show what follows from L or H: equations of motion, and what is conserved and why.
///
/// Momenta, mass matrix, equations of motion, the Hamiltonian (or why it has no closed form), the
/// energy and the law of its change, cyclic coordinates, what is conserved and why; of every
/// declared observable whether it is conserved; of constraints on the velocities whether they are
/// holonomic; whether Hamilton-Jacobi separates in these coordinates; of transformations whether they
/// are canonical, and K; of generators [H, G]; of a complete integral whether it is one.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab derive heavy-top
  phaselab derive my/system.toml --format latex > equations.tex
  phaselab derive planet --format json | jq .equations
  phaselab derive harmonic-oscillator --against \"1/2*m*x'^2 - 1/2*k*x^2 + 2*x*x'\"")]
pub(super) struct Arguments {
    /// A preset's name, or a file.
    #[arg(value_name = "PRESET|FILE")]
    name: OsString,
    /// Another Lagrangian, as an expression, a preset or a file: does it differ by a total derivative?
    #[arg(long, value_name = "EXPR|PRESET|FILE", allow_hyphen_values = true)]
    against: Option<String>,
    /// How it is written.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

pub(super) fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let document = open::find(&arguments.name)?;
    let model = open::read(&document)?;
    let Derived { model, mut equations } = open::derive(&document, model)?;
    equations.find_closed_forms();
    let further = Further::of(&model, &mut equations);
    let values = Valuation::of_parameters(&model, &model.parameter_values());
    equations.note_energy_conserved_at(&model, &values);
    let given = arguments.against.as_deref();
    let compared =
        given.map(|given| LagrangianComparison::of(&model, &mut equations, given)).transpose()?;
    let report = Report::of(&model, &equations);
    let mut text = match (arguments.format, NamedRamps::readable(&equations, &further)) {
        (Format::Json, _) => json::write(&report, &further, compared.as_ref()),
        (format, Some((named, further))) => {
            let report = Report::of(&named.model, &named.equations);
            written(format, &report, &further)
        }
        (format, None) => written(format, &report, &further),
    };
    match (arguments.format, &compared) {
        (Format::Text, Some(known)) => {
            text.push_str(&known.text(&equations.pool, MathScript::of_locale()));
        }
        (Format::Latex, Some(known)) => text.push_str(&known.latex(&equations.pool)),
        _ => {}
    }
    Output::print(arguments.format.form(), &text)
}

/// The report as text or for typesetting.
fn written(format: Format, report: &Report<'_>, further: &Further) -> String {
    match format {
        Format::Latex => latex(report, further),
        Format::Text | Format::Json => text::write(report, further, MathScript::of_locale()),
    }
}
