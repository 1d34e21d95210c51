//! `phaselab methods`: the table of integrators.

use clap::ValueEnum;
use serde_json::{Value, json};

use super::error::CommandError;
use super::output::{Output, OutputForm};
use crate::integrate::{METHODS, Method, Preserves, Stepping};

/// List the integrators: order, what they preserve, what they need.
///
/// Their order, how they choose their steps, what they preserve and what they need of a system.
/// `run --method` and the key `m` in the lab take these names.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab methods
  phaselab methods --format json         one object, {\"methods\": [...]}")]
pub(super) struct Arguments {
    /// How the list is written.
    #[arg(long, value_enum, default_value_t)]
    format: MethodsFormat,
}

#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum MethodsFormat {
    /// For reading.
    #[default]
    Text,
    /// One object, `{"methods": [...]}`.
    Json,
}

impl MethodsFormat {
    fn form(self) -> OutputForm {
        match self {
            MethodsFormat::Text => OutputForm::Text,
            MethodsFormat::Json => OutputForm::Json,
        }
    }
}

pub(super) fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let text = match arguments.format {
        MethodsFormat::Text => METHODS.iter().map(text).collect::<Vec<_>>().join("\n"),
        MethodsFormat::Json => {
            let methods: Vec<Value> = METHODS.iter().map(object).collect();
            format!("{:#}\n", json!({ "methods": methods }))
        }
    };
    Output::print(arguments.format.form(), &text)
}

fn text(method: &Method) -> String {
    let order = match method.order {
        Some(order) => format!("order {order}"),
        None => "order by tolerance".to_owned(),
    };
    let needs = match method.needs {
        "" => String::new(),
        needs => format!("    needs {needs}\n"),
    };
    format!(
        "{}: {}\n    {order}, {}; preserves {}\n{needs}    {}\n",
        method.name,
        method.title,
        stepping(method.stepping),
        preserves(method.preserves),
        method.about
    )
}

fn stepping(stepping: Stepping) -> &'static str {
    match stepping {
        Stepping::Adaptive => "steps chosen by a tolerance",
        Stepping::Fixed => "equal steps",
    }
}

fn preserves(preserves: Preserves) -> &'static str {
    match preserves {
        Preserves::Nothing => "nothing but its accuracy",
        Preserves::Symplectic => "the symplectic form",
        Preserves::SymplecticReversible => "the symplectic form and reversibility",
    }
}

fn object(method: &Method) -> Value {
    json!({
        "name": method.name,
        "title": method.title,
        "order": method.order,
        "adaptive": method.stepping == Stepping::Adaptive,
        "symplectic": method.preserves.is_symplectic(),
        "needs": method.needs,
        "about": method.about,
    })
}
