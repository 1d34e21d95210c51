//! `phaselab path`: paths between configurations, and their action.

mod judged;

use std::path::PathBuf;

use serde_json::{Value, json};

use judged::{JudgedPath, PathStudy, VariedPath};

use super::assignment::{self, Assignment, number};
use super::cells::{self, TableCell, TableFormat};
use super::decimal::divisions;
use super::error::CommandError;
use super::interrupt::Interrupt;
use super::motion_options::{CompiledMotion, MotionOptions};
use super::output::Output;
use super::path_function::{is_momentum, of_coordinates};
use super::stderr;
use crate::dynamics::PathKind;
use crate::expr::Expr;
use crate::model::Model;
use crate::printable;
use crate::system::InitialOverride;

/// Find the path between two configurations that makes the action stationary, or the action of a path.
///
/// With --to the motion that takes the time --in from one configuration to the other: its action
/// ∫ L dt, its Morse index (how many ways of varying it reduce the action), and the conjugate
/// points, beyond which it is not least. With --along the action of a path that you write, t
/// counted from its beginning; --vary adds ε times a variation to either. Beside Hamilton's action
/// stands the abbreviated one, ∫ Σ p dq, of varied paths at the energy of the path (Maupertuis,
/// Jacobi); where momenta are varied, too, the action is that in phase space, ∫ (Σ p dq − H dt).
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab path pendulum --in 1.5 --from theta=0 --to theta=1
  phaselab path pendulum --in 4 --from theta=0 --to theta=0 --near 'theta=sin(pi*t/4)'
  phaselab path harmonic-oscillator --in 10 --along 'x=cos(t)' --vary 'x=sin(pi*t/10)'")]
pub(super) struct Arguments {
    #[command(flatten)]
    motion: MotionOptions,
    /// How long the path takes.
    #[arg(long = "in", value_name = "T", value_parser = number, allow_hyphen_values = true)]
    duration: f64,
    /// Where the path ends, one coordinate; needed for each.
    #[arg(long, value_name = "X=VALUE", allow_hyphen_values = true, conflicts_with = "along")]
    to: Vec<Assignment>,
    /// Where it begins, if not at the start of the file.
    #[arg(long, value_name = "X=VALUE", allow_hyphen_values = true, conflicts_with = "along")]
    from: Vec<Assignment>,
    /// The path to begin the search with, in place of the straight one: a coordinate as a function of t.
    #[arg(long, value_name = "X=EXPR", allow_hyphen_values = true, conflicts_with = "along")]
    near: Vec<Assignment>,
    /// A path: a coordinate as a function of t, 0 … T, and parameters.
    #[arg(long, value_name = "X=EXPR", allow_hyphen_values = true)]
    along: Vec<Assignment>,
    /// A variation, which is added ε times: of a coordinate, or of a momentum `p_x`.
    #[arg(long, value_name = "X=EXPR", allow_hyphen_values = true)]
    vary: Vec<Assignment>,
    /// The values of ε.
    #[arg(long, value_name = "FROM:TO:COUNT", allow_hyphen_values = true, requires = "vary")]
    #[arg(default_value = "-0.2:0.2:9", value_parser = Epsilons::parse)]
    epsilons: Epsilons,
    /// How the result is written.
    #[arg(long, value_enum, default_value_t = TableFormat::Text)]
    format: TableFormat,
    /// Writes to a file, which appears when it is complete and replaces an old one.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Evenly spaced values of ε.
#[derive(Clone, Debug)]
struct Epsilons(Vec<f64>);

impl Epsilons {
    fn parse(text: &str) -> Result<Epsilons, String> {
        let form = "write it as from:to:count";
        let parts: Vec<&str> = text.split(':').collect();
        let &[from, to, count] = parts.as_slice() else { return Err(form.to_owned()) };
        let (from, to) = (number(from)?, number(to)?);
        let count: u32 = count.trim().parse().map_err(|_| form.to_owned())?;
        match count {
            0 => Err("COUNT must be at least 1".to_owned()),
            1 => Ok(Epsilons(vec![from])),
            2..=10_000 => Ok(Epsilons(divisions(from, to, count - 1).collect())),
            _ => Err("COUNT must be at most 10000".to_owned()),
        }
    }
}

pub(super) fn execute(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    if arguments.duration <= 0.0 {
        return Err(CommandError::WrongUse("--in: the time must be above zero".to_owned()));
    }
    if arguments.to.is_empty() && arguments.along.is_empty() {
        let why = "say where the path ends, --to x=VALUE, or write one, --along x=EXPR";
        return Err(CommandError::WrongUse(why.to_owned()));
    }
    let reading = arguments.motion.read()?;
    let compiled = arguments.motion.compile(reading, &[], "--observe", interrupt)?;
    let mechanics = &compiled.model.mechanics;
    let acts = |force: &&Expr| **force != Expr::ZERO;
    if [mechanics.dissipation()].iter().chain(mechanics.forces()).find(acts).is_some() {
        stderr::report(
            "friction or forces act beside L: a path that makes ∫ L dt stationary is a motion of L alone, not of this file",
        );
    }
    let found = found(arguments, &compiled)?;
    // until here there is nothing to finish, so that a signal ends the search at once
    interrupt.ends_by_itself(|| ());
    let out = Output::open(arguments.output.as_deref(), arguments.format.form())?;
    out.write_after_signal(|| found.written(arguments.format, &compiled), interrupt)
}

/// The path, and what is known of it.
fn found(arguments: &Arguments, compiled: &CompiledMotion) -> Result<JudgedPath, CommandError> {
    let model = &*compiled.model;
    let mut study = PathStudy::new(compiled, arguments.duration)?;
    let along = study.read(&arguments.along, "--along")?;
    let near = study.read(&arguments.near, "--near")?;
    let (momenta, positions): (Vec<Assignment>, Vec<Assignment>) =
        arguments.vary.iter().cloned().partition(|one| is_momentum(model, one.name()));
    let variation = study.variation(&positions, &of_coordinates(&momenta))?;
    let path = match along {
        Some(along) => study.along(along),
        None => study.between(&ends(arguments, compiled)?, near.as_ref())?,
    };
    let mut judged = study.judge(&path)?;
    if let Some(variation) = variation {
        judged.varied = study.vary(&path, variation, &arguments.epsilons.0)?;
    }
    Ok(judged)
}

fn ends(arguments: &Arguments, compiled: &CompiledMotion) -> Result<[Vec<f64>; 2], CommandError> {
    let (model, parameters) = (&*compiled.model, &compiled.start.parameters);
    let state = compiled
        .start
        .state(&compiled.system)
        .map_err(|why| CommandError::CouldNot(why.to_string()))?;
    let n = model.coordinates.len();
    let own: Vec<f64> = state.values[..n].to_vec();
    let place = |given: &[Assignment], option: &str, before: Option<&[f64]>| {
        let mut values: Vec<Option<f64>> = match before {
            Some(own) => own.iter().map(|&x| Some(x)).collect(),
            None => vec![None; n],
        };
        for one in assignment::given_by(option, model, parameters, given)? {
            let InitialOverride::Position(i, x) = one else {
                let why = "the ends of a path are coordinates";
                return Err(CommandError::WrongUse(format!("{option}: {why}")));
            };
            values[i] = Some(x);
        }
        let missing = values.iter().position(Option::is_none);
        if let Some(i) = missing {
            let name = &model.coordinates[i].name;
            let message = format!("{option}: say where `{name}` ends, too: {option} {name}=VALUE");
            return Err(CommandError::WrongUse(message));
        }
        Ok(values.into_iter().flatten().collect::<Vec<f64>>())
    };
    Ok([place(&arguments.from, "--from", Some(&own))?, place(&arguments.to, "--to", None)?])
}

fn word(kind: PathKind) -> &'static str {
    match kind {
        PathKind::Minimum => "minimum",
        PathKind::Saddle => "saddle",
        PathKind::Degenerate => "degenerate",
    }
}

impl JudgedPath {
    fn columns(model: &Model) -> Vec<String> {
        let all = model.coordinates.iter();
        let positions = all.clone().map(|c| c.name.clone());
        let velocities = all.clone().map(|c| format!("{}'", c.name));
        let momenta = all.map(|c| format!("p_{}", c.name));
        let inner = positions.chain(velocities).chain(momenta);
        ["t".to_owned()].into_iter().chain(inner).chain(["energy".to_owned()]).collect()
    }

    fn written(&self, format: TableFormat, compiled: &CompiledMotion) -> String {
        let columns = JudgedPath::columns(&compiled.model);
        let (index, kind) = (self.nature.map(|n| n.0), self.nature.map(|n| word(n.1)));
        if format == TableFormat::Json {
            let mut members = compiled.header().members();
            let varied = self.varied.iter().map(|varied| {
                let abbreviated = varied.abbreviated.as_ref().ok();
                json!({ "epsilon": varied.epsilon, "action": varied.action, "abbreviated": abbreviated })
            });
            let fields = [
                ("action", json!(self.action)),
                ("abbreviated", json!(self.abbreviated)),
                ("stationary", json!(self.nature.is_some())),
                ("kind", json!(kind)),
                ("index", json!(index)),
                ("conjugate", json!(self.conjugate)),
                ("columns", json!(columns)),
                ("rows", json!(self.rows)),
                ("varied", varied.collect::<Value>()),
            ];
            for (name, value) in fields {
                members.insert(name.to_owned(), value);
            }
            return cells::object(&members);
        }
        let csv = format == TableFormat::Csv;
        let lead = if csv { "# " } else { "" };
        let shown = |x: f64| if csv { printable::number(x) } else { crate::num::short(x) };
        let mut text = format!("{lead}action {}\n", shown(self.action));
        if let Some(abbreviated) = self.abbreviated.map(shown) {
            text.push_str(&format!("{lead}abbreviated action ∫ p dq {abbreviated}\n"));
        }
        match (kind, index) {
            (Some(kind), Some(index)) => {
                text.push_str(&format!("{lead}stationary: {kind}, index {index}\n"));
            }
            _ => text.push_str(&format!("{lead}not stationary\n")),
        }
        if let Some(times) = self.conjugate.as_ref().filter(|times| !times.is_empty()) {
            let times: Vec<String> = times.iter().map(|&t| shown(t)).collect();
            text.push_str(&format!("{lead}conjugate points at t = {}\n", times.join(", ")));
        }
        for VariedPath { epsilon, action, abbreviated } in &self.varied {
            let (epsilon, action) = (shown(*epsilon), shown(*action));
            let beside = abbreviated.as_ref().ok().map(|w| format!(", abbreviated {}", shown(*w)));
            let beside = beside.unwrap_or_default();
            text.push_str(&format!("{lead}varied by ε = {epsilon}: action {action}{beside}\n"));
        }
        // what all lack has one reason
        let whys = self.varied.iter().map(|varied| varied.abbreviated.as_ref().err());
        if let Some(why) = whys.flatten().next() {
            text.push_str(&format!("{lead}abbreviated action: {why}\n"));
        }
        let every = if csv { 1 } else { 20 };
        let table: Vec<Vec<TableCell>> = self
            .rows
            .iter()
            .step_by(every)
            .map(|row| row.iter().map(|&x| TableCell::Number(x)).collect())
            .collect();
        if csv {
            let rows = cells::csv(table.iter().map(Vec::as_slice));
            compiled.header().lines() + &text + &cells::record(columns) + &rows
        } else {
            text + "\n" + &cells::text(&columns, &table)
        }
    }
}
