//! `phaselab symmetries`: Noether's symmetries of a Lagrangian, and what is constant because of each; the other point
//! symmetries of the equations of motion; mechanical similarity.

mod similar;

use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Instant;

use serde_json::{Map, Value, json};

use self::similar::Others;
use super::assignment::{self, Assignment, seconds};
use super::error::CommandError;
use super::format::Format;
use super::open;
use super::output::Output;
use super::script::MathScript;
use crate::experiment::Derived;
use crate::expr::{Expr, latex_name};
use crate::integrability::{
    Symmetries, Symmetry, Unsupported, found_names, point_symmetries, symmetries,
};
use crate::mechanics::Equations;
use crate::model::Model;

/// Find symmetries: Noether's of a Lagrangian, and Lie's of the equations of motion.
///
/// Each is a change of time and coordinates that changes L dt by a total derivative only: shifts,
/// rotations, boosts, dilations. Beside it stands what is constant because of it. Then come the
/// changes that only map motions to motions, such as Kepler's third law, and the virial theorem where T
/// and V are homogeneous. The parameters have their values.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab symmetries free-particle
  phaselab symmetries planet --format json")]
pub(super) struct Arguments {
    /// A preset's name, or a file.
    #[arg(value_name = "PRESET|FILE")]
    name: OsString,
    /// The seconds the search may take; 10 by default.
    #[arg(long, allow_hyphen_values = true, value_name = "S", value_parser = seconds)]
    budget: Option<f64>,
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

/// The budget of time in seconds where none is given.
const BUDGET: f64 = 10.0;

pub(super) fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let document = open::find(&arguments.name)?;
    let mut model = open::read(&document)?;
    let parameters = assignment::parameters(&model, &arguments.set)?;
    model.set_parameters(&parameters);
    model.name_literals();
    let Derived { model, mut equations } = open::derive(&document, model)?;
    let most = arguments.budget.unwrap_or(BUDGET);
    let begin = Instant::now();
    let is_over = || begin.elapsed().as_secs_f64() > most;
    let mut found = symmetries(&model, &mut equations, &is_over);
    let points = point_symmetries(&model, &mut equations, found.as_mut().ok(), &is_over);
    if let (Err(why), Err(_)) = (&found, &points) {
        return Err(CommandError::CouldNot(why.to_string()));
    }
    let similarity = equations.similarity();
    let has_lagrangian = equations.lagrangian().is_ok();
    let listed = found.iter().flat_map(|found| &found.found).filter(|s| s.proved).count();
    let others = Others { has_lagrangian, listed, points, similarity };
    let text = match arguments.format {
        Format::Text => {
            let script = MathScript::of_locale();
            let own = match &found {
                Ok(found) => text(&model, &equations, found, script),
                Err(why) => {
                    format!("{}\n\nNoether's symmetries: {why}\n", model.info.title)
                }
            };
            own + &others.text(&equations, script)
        }
        Format::Latex => match &found {
            Ok(found) => latex(&model, &equations, found) + &others.latex(&equations),
            Err(_) => others.latex(&equations),
        },
        Format::Json => {
            let mut object = json(&model, &equations, &found);
            others.json(&equations, &mut object);
            format!("{object:#}\n")
        }
    };
    Output::open(arguments.output.as_deref(), arguments.format.form())?.write_text(&text)
}

fn text(model: &Model, equations: &Equations, found: &Symmetries, script: MathScript) -> String {
    let math = |e: Expr| script.math(&equations.pool, e);
    let mut text = format!("{}\n", model.info.title);
    for symmetry in &found.found {
        text.push_str(&format!("\n{}\n", symmetry.name));
        let moved = similar::moved(equations, script, symmetry.time, &symmetry.coordinates);
        text.push_str(&format!("  moves {moved}\n"));
        if symmetry.gauge != Expr::ZERO {
            text.push_str(&format!("  L changes by the derivative of {}\n", math(symmetry.gauge)));
        }
        let proof = match (symmetry.proved, symmetry.for_all_parameters) {
            (true, true) => "proved",
            (true, false) => "proved at these parameters",
            (false, _) => "not proved",
        };
        let between = if symmetry.between_impulses { ", between impulses" } else { "" };
        text.push_str(&format!("  constant: {}   ({proof}{between})\n", math(symmetry.conserved)));
    }
    let count = found.found.len();
    let complete = if found.complete { ", and there are no others (proved)" } else { "" };
    text.push_str(&format!("\n{count} found{complete} among\n  {}\n", found.searched));
    text.push_str(&similar::missing(found.unwritten, found.unfinished));
    text
}

fn latex(model: &Model, equations: &Equations, found: &Symmetries) -> String {
    let names = found_names(model, &equations.pool, &[], found.found.len());
    let lines: Vec<String> = names
        .iter()
        .zip(&found.found)
        .map(|(name, s)| format!("{} &= {}", latex_name(name), equations.pool.latex(s.conserved)))
        .collect();
    format!("\\begin{{align*}}\n{}\n\\end{{align*}}\n", lines.join(" \\\\\n"))
}

fn json(model: &Model, equations: &Equations, found: &Result<Symmetries, Unsupported>) -> Value {
    let text = |e: Expr| Value::String(equations.pool.text(e));
    let one = |s: &Symmetry| {
        let coordinates: Map<String, Value> = model
            .coordinates
            .iter()
            .zip(&s.coordinates)
            .map(|(c, &e)| (c.name.clone(), text(e)))
            .collect();
        json!({
            "name": s.name,
            "time": text(s.time),
            "coordinates": coordinates,
            "gauge": text(s.gauge),
            "conserved": text(s.conserved),
            "proved": s.proved,
            "for_all_parameters": s.proved && s.for_all_parameters,
            "between_impulses": s.between_impulses,
        })
    };
    let parameters: Map<String, Value> =
        model.parameters.iter().map(|p| (p.name.clone(), json!(p.value))).collect();
    let mut object = json!({
        "phaselab": env!("CARGO_PKG_VERSION"),
        "title": model.info.title,
        "parameters": parameters,
        "method": null,
        "symmetries": found.iter().flat_map(|f| &f.found).map(one).collect::<Vec<_>>(),
        "searched": found.as_ref().ok().map(|f| f.searched.as_str()),
        "complete": found.as_ref().is_ok_and(|f| f.complete),
        "unwritten": found.as_ref().ok().map(|f| f.unwritten),
        "unfinished": found.as_ref().ok().map(|f| f.unfinished),
    });
    if let Err(why) = found {
        object["why"] = Value::String(why.to_string());
    }
    object
}
