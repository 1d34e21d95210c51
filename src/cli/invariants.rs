//! `phaselab invariants`: constants of the motion that nobody wrote down, and what was searched without result.

mod json;
mod text;

use std::ffi::OsString;
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Instant;

use super::assignment::{self, Assignment, name_in_letters, number, seconds, whole};
use super::error::CommandError;
use super::format::Format;
use super::open;
use super::output::Output;
use super::script::MathScript;
use crate::experiment::Derived;
use crate::integrability::{
    Invariants, Limits, Relations, invariants, is_hamiltonian, relations, separates,
};
use crate::mechanics::Equations;
use crate::model::Model;
use crate::printable;

/// Find constants of the motion that the file does not name.
///
/// Searches the polynomials in the momenta whose coefficients are polynomials in what the law is
/// made of (coordinates, sines and cosines, roots, exponentials), by linear algebra modulo a prime;
/// proves each one found symbolically; and says exactly what was searched, so that whatever is not
/// found is proved not to exist. The degree grows until the time allowed has run out.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab invariants planet
  phaselab invariants henon-heiles --degree 4 --format json
  phaselab invariants swinging-atwood --scan M=2:4:0.5")]
pub(super) struct Arguments {
    /// A preset's name, or a file.
    #[arg(value_name = "PRESET|FILE")]
    name: OsString,
    /// The greatest degree in the momenta; 6 by default.
    #[arg(long, allow_hyphen_values = true, value_name = "N", value_parser = whole::<u32>(1, 12))]
    degree: Option<u32>,
    /// The seconds the search may take; 1 by default, and no limit where a degree is
    /// given.
    #[arg(long, allow_hyphen_values = true, value_name = "S", value_parser = seconds)]
    budget: Option<f64>,
    /// Adds the brackets of all constants: which commute, and what the others are.
    #[arg(long)]
    jacobi: bool,
    /// Searches at each of these values of a parameter.
    #[arg(long, value_name = "NAME=FROM:TO:STEP", allow_hyphen_values = true)]
    scan: Option<Scan>,
    /// Sets a parameter.
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    set: Vec<Assignment>,
    /// How it is written.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    /// Writes to a file, which appears when it is complete and replaces an old one.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// The values of a parameter at which to search.
#[derive(Clone, PartialEq, Debug)]
struct Scan {
    name: String,
    values: Vec<f64>,
}

const MOST_VALUES: f64 = 10_000.0;

impl FromStr for Scan {
    type Err = String;

    fn from_str(text: &str) -> Result<Scan, String> {
        let form = "write it as NAME=FROM:TO:STEP";
        let (name, range) = text.split_once('=').ok_or(form)?;
        let ends: Vec<&str> = range.split(':').collect();
        let [from, to, step] = ends[..] else { return Err(form.to_owned()) };
        let [from, to, step] = [number(from)?, number(to)?, number(step)?];
        let count = (to - from) / step;
        if !count.is_finite() || count < 0.0 {
            return Err("the step does not lead from FROM to TO".to_owned());
        }
        if count > MOST_VALUES {
            return Err(format!("a scan takes at most {MOST_VALUES} values"));
        }
        // a rounding error must not cost the last one
        let last = (count + 1e-9).floor() as u32;
        let values = (0..=last).map(|k| from + step * f64::from(k)).collect();
        Ok(Scan { name: name_in_letters(name), values })
    }
}

/// The budget of time where neither it nor a degree is given, in seconds.
const BUDGET: f64 = 1.0;

/// The result at one value of the scanned parameter.
struct At {
    value: f64,
    invariants: Invariants,
}

struct InvariantsReport<'a> {
    model: &'a Model,
    equations: &'a Equations,
    invariants: Invariants,
    relations: Relations,
    hamiltonian: bool,
    /// Whether Hamilton–Jacobi separates in the file's coordinates.
    separates: Option<bool>,
    jacobi: bool,
    scan: Option<(String, Vec<At>)>,
}

pub(super) fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let document = open::find(&arguments.name)?;
    let mut model = open::read(&document)?;
    let parameters = assignment::parameters(&model, &arguments.set)?;
    model.set_parameters(&parameters);
    let scanned = match &arguments.scan {
        None => None,
        Some(scan) => Some((scan, parameter(&model, &scan.name)?)),
    };
    model.name_literals();
    let mut derived = open::derive(&document, model)?;
    let scan = match scanned {
        None => None,
        Some((scan, i)) => Some((scan.name.clone(), arguments.scan_values(&derived, scan, i)?)),
    };
    let Derived { model, equations } = &mut derived;
    let invariants = arguments.search(model, equations)?;
    let hamiltonian = is_hamiltonian(model, equations);
    let relations = relations(model, equations, &invariants, hamiltonian);
    let separates = separates(model, equations);
    let jacobi = arguments.jacobi;
    let answer = InvariantsReport {
        model,
        equations,
        invariants,
        relations,
        hamiltonian,
        separates,
        jacobi,
        scan,
    };
    let text = match arguments.format {
        Format::Text => text::write(&answer, MathScript::of_locale()),
        Format::Latex => text::latex(&answer),
        Format::Json => json::write(&answer),
    };
    Output::open(arguments.output.as_deref(), arguments.format.form())?.write_text(&text)
}

/// The index of the parameter that is scanned.
fn parameter(model: &Model, name: &str) -> Result<usize, CommandError> {
    model.parameter(name).ok_or_else(|| {
        let names: Vec<&str> = model.parameters.iter().map(|p| p.name.as_str()).collect();
        let shown = printable::quoted(name);
        let known = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        CommandError::WrongUse(format!("--scan: unknown parameter `{shown}`; there are {known}"))
    })
}

impl Arguments {
    fn search(&self, model: &Model, equations: &mut Equations) -> Result<Invariants, CommandError> {
        let budget = self.budget.or(self.degree.is_none().then_some(BUDGET));
        let begin = Instant::now();
        let is_over = || budget.is_some_and(|seconds| begin.elapsed().as_secs_f64() > seconds);
        let limits = Limits { degree: self.degree, is_over: &is_over };
        invariants(model, equations, &limits).map_err(|why| CommandError::CouldNot(why.to_string()))
    }

    fn scan_values(
        &self,
        derived: &Derived,
        scan: &Scan,
        parameter: usize,
    ) -> Result<Vec<At>, CommandError> {
        let at = |&value: &f64| {
            let Derived { mut model, mut equations } = derived.clone();
            model.parameters[parameter].value = value;
            let invariants = self.search(&model, &mut equations)?;
            Ok(At { value, invariants })
        };
        scan.values.iter().map(at).collect()
    }
}
