//! `phaselab path`: paths between configurations, and their action.

use std::path::PathBuf;

use serde_json::{Value, json};

use super::assignment::{self, Assignment, number};
use super::cells::{self, TableCell, TableFormat};
use super::crowd;
use super::decimal::divisions;
use super::failure::CommandError;
use super::interrupt::Interrupt;
use super::motion_options::{Laid, MotionOptions};
use super::output::Output;
use super::path_function::{PathFunctions, is_momentum, of_coordinates};
use super::{stderr, study};
use crate::dynamics::{
    DynamicsError, Hamiltonian, Lagrangian, PathKind, PhaseSpace, abbreviated_action,
    action_at_energy, conjugate_points, morse_index, nearest_stationary_path,
    stationary_path_between,
};
use crate::expr::Expr;
use crate::mechanics::{Equations, Valuation, body_constants};
use crate::model::Model;
use crate::printable;
use crate::system::InitialOverride;

/// Find the path between two configurations that makes the action stationary, or the action of a path.
///
/// With --to the motion that takes the time --in from one configuration to the other: its action
/// ∫ L dt, its Morse index (how many ways of varying it lessen the action), and the conjugate
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
            0 => Err("there is at least one ε".to_owned()),
            1 => Ok(Epsilons(vec![from])),
            2..=10_000 => Ok(Epsilons(divisions(from, to, count - 1).collect())),
            _ => Err("there are at most 10000 of ε".to_owned()),
        }
    }
}

/// The number of intervals between rows.
const INTERVALS: u32 = 200;

/// The equations of motion hold along a written path if what is left of them is below this part of their terms, and a variation
/// vanishes at an end below this part of its largest value.
const HOLDS: f64 = 1e-9;

/// A path with what is known of it.
struct JudgedPath {
    action: f64,
    /// ∫ Σ p dq, where it has a value.
    abbreviated: Option<f64>,
    /// `None` if it does not make the action stationary.
    nature: Option<(usize, PathKind)>,
    conjugate: Option<Vec<f64>>,
    rows: Vec<Vec<f64>>,
    varied: Vec<VariedPath>,
}

/// A varied path.
struct VariedPath {
    epsilon: f64,
    /// Hamilton's action, or that in phase space.
    action: f64,
    /// The abbreviated action at the energy of the path that is varied, or why there is none.
    abbreviated: Result<f64, String>,
}

pub(super) fn perform(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    let duration = arguments.duration;
    if duration <= 0.0 {
        return Err(CommandError::WrongUse("--in: a path takes a time above zero".to_owned()));
    }
    if arguments.to.is_empty() && arguments.along.is_empty() {
        let why = "say where the path ends, --to x=VALUE, or write one, --along x=EXPR";
        return Err(CommandError::WrongUse(why.to_owned()));
    }
    let reading = arguments.motion.read()?;
    let laid = arguments.motion.compile(reading, &[], "--observe", interrupt)?;
    let model = &*laid.model;
    let mechanics = &model.mechanics;
    let acts = |force: &&Expr| **force != Expr::ZERO;
    if [mechanics.dissipation()].iter().chain(mechanics.forces()).find(acts).is_some() {
        stderr::report(
            "friction or forces act beside L: where ∫ L dt is stationary is no motion of this file, but of L alone",
        );
    }
    let mut equations = (*laid.equations).clone();
    let parameters = laid.start.parameters.clone();
    let constants =
        Valuation::of_parameters(model, &parameters).with(body_constants(model, &parameters));
    let mut lagrangian =
        Lagrangian::of(model, &mut equations, &parameters).map_err(study::failed)?;
    let read = |equations: &mut Equations, given: &[Assignment], option: &str| {
        PathFunctions::read(model, equations, given, option)
    };
    let along = read(&mut equations, &arguments.along, "--along")?;
    let near = read(&mut equations, &arguments.near, "--near")?;
    let (momenta, vary): (Vec<Assignment>, Vec<Assignment>) =
        arguments.vary.iter().cloned().partition(|one| is_momentum(model, one.name()));
    let vary = read(&mut equations, &vary, "--vary")?;
    let momenta = of_coordinates(&momenta);
    let vary_momenta = read(&mut equations, &momenta, "--vary")?;
    let failed = study::failed;
    let mut of_path = Lagrangian::of(model, &mut equations, &parameters).map_err(failed)?;
    let mut hamiltonian = match &vary_momenta {
        Some(_) => Some(Hamiltonian::of(model, &mut equations, &parameters).map_err(failed)?),
        None => None,
    };
    let time = model.symbols.time;
    let at = |equations: &Equations, written: &PathFunctions, t: f64, order: usize| -> Vec<f64> {
        let point = constants.clone().with([(time, t)]);
        written.values[order].iter().map(|&e| point.value(&equations.pool, e)).collect()
    };
    let pair = |equations: &Equations, written: &PathFunctions, t: f64| {
        [at(equations, written, t, 0), at(equations, written, t, 1)].concat()
    };
    let mut solved = None;
    let stationary = match &along {
        Some(along) => stationary(model, &mut equations, along, &constants, duration),
        None => {
            let ends = ends(arguments, &laid)?;
            let [from, to] = &ends;
            let path = match &near {
                Some(near) => {
                    // the ends are those that are asked for
                    let guess = |t: f64| match t / duration {
                        part if part <= 0.0 => from.clone(),
                        part if part >= 1.0 => to.clone(),
                        _ => at(&equations, near, t, 0),
                    };
                    nearest_stationary_path(&mut lagrangian, &guess, duration)
                }
                None => stationary_path_between(&mut lagrangian, [from, to], duration),
            };
            solved = Some(path.map_err(study::failed)?);
            true
        }
    };
    let base = |t: f64| -> Vec<f64> {
        match (&solved, &along) {
            (Some(path), _) => path.at(t),
            (None, Some(along)) => pair(&equations, along, t),
            (None, None) => Vec::new(),
        }
    };
    let action = match &solved {
        Some(path) => path.action,
        None => lagrangian.action(&mut |t: f64| base(t), duration).map_err(failed)?,
    };
    let nature = match &solved {
        Some(path) => Some((path.index, path.kind)),
        None if stationary => Some(morse_index(&mut lagrangian, &base, duration).map_err(failed)?),
        None => None,
    };
    let mut rows = Vec::new();
    for t in divisions(0.0, duration, INTERVALS) {
        let state = base(t);
        let momenta = lagrangian.momenta(t, &state);
        let energy = lagrangian.energy(t, &state);
        rows.push([&[t][..], &state, &momenta, &[energy]].concat());
    }
    let conjugate = if stationary {
        let state = base(0.0);
        let momenta = lagrangian.momenta(0.0, &state);
        let n = model.coordinates.len();
        match conjugates(&laid, &equations, &[&state[..n], &momenta].concat(), duration) {
            Ok(times) => Some(times),
            Err(why) => {
                stderr::report(&format!("conjugate points are not known: {why}"));
                None
            }
        }
    } else {
        Some(Vec::new())
    };
    let abbreviated = abbreviated_action(&mut lagrangian, &mut |t: f64| base(t), duration);
    let abbreviated = abbreviated.ok();
    let energy = lagrangian.energy(0.0, &base(0.0));
    let n = model.coordinates.len();
    if let Some(vary) = &vary {
        let size =
            |t: f64| at(&equations, vary, t, 0).iter().fold(0.0_f64, |most, d| most.max(d.abs()));
        let greatest = divisions(0.0, duration, INTERVALS).map(size).fold(0.0, f64::max);
        if size(0.0).max(size(duration)) > HOLDS * greatest {
            stderr::report(
                "the variation does not vanish at both ends: where it does not, the action changes by p δq, also on a true path",
            );
        }
    }
    let mut varied = Vec::new();
    for &epsilon in vary.iter().chain(&vary_momenta).take(1).flat_map(|_| &arguments.epsilons.0) {
        let mut path = |t: f64| -> Vec<f64> {
            let by =
                vary.as_ref().map_or_else(|| vec![0.0; 2 * n], |vary| pair(&equations, vary, t));
            base(t).iter().zip(by).map(|(x, d)| x + epsilon * d).collect()
        };
        let (action, abbreviated) = match (&vary_momenta, &mut hamiltonian) {
            (Some(of_momenta), Some(hamiltonian)) => {
                let mut in_phase_space = |t: f64| -> Vec<f64> {
                    let own = of_path.momenta(t, &base(t)).into_iter();
                    let by = at(&equations, of_momenta, t, 0);
                    let momenta = own.zip(by).map(|(p, d)| p + epsilon * d);
                    path(t).into_iter().chain(momenta).collect()
                };
                let action =
                    hamiltonian.phase_action(&mut lagrangian, &mut in_phase_space, duration);
                let why = "its momenta are not those of its velocities".to_owned();
                (action.map_err(failed)?, Err(why))
            }
            _ => {
                let action = lagrangian.action(&mut path, duration).map_err(failed)?;
                let at_energy = action_at_energy(&mut lagrangian, &mut path, duration, energy);
                (action, at_energy.map_err(|why| why.to_string()))
            }
        };
        varied.push(VariedPath { epsilon, action, abbreviated });
    }
    let found = JudgedPath { action, abbreviated, nature, conjugate, rows, varied };
    // until here there is nothing to finish, so that a signal ends the search at once
    interrupt.ends_by_itself(|| ());
    let out = Output::open(arguments.output.as_deref(), arguments.format.form())?;
    crowd::write(out, &found.written(arguments.format, &laid), interrupt)
}

/// Both ends of the path.
fn ends(arguments: &Arguments, laid: &Laid) -> Result<[Vec<f64>; 2], CommandError> {
    let (model, parameters) = (&*laid.model, &laid.start.parameters);
    let state =
        laid.start.state(&laid.system).map_err(|why| CommandError::CouldNot(why.to_string()))?;
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

/// Whether d/dt ∂L/∂q̇ − ∂L/∂q vanishes along a written path.
fn stationary(
    model: &Model,
    equations: &mut Equations,
    along: &PathFunctions,
    constants: &Valuation,
    duration: f64,
) -> bool {
    let Ok(lagrangian) = equations.lagrangian().clone() else { return false };
    let time = model.symbols.time;
    let mut seeds = vec![(time, Expr::ONE)];
    let pool = &mut equations.pool;
    for c in &model.coordinates {
        seeds.push((c.position, pool.variable(c.velocity)));
        seeds.push((c.velocity, pool.variable(c.acceleration)));
    }
    let mut residuals = Vec::new();
    for c in &model.coordinates {
        let momentum = pool.derivative(lagrangian, c.velocity);
        let rate = pool.derivation(momentum, &seeds);
        let force = pool.derivative(lagrangian, c.position);
        residuals.push(pool.sub(rate, force));
    }
    divisions(0.0, duration, 37).all(|t| {
        let on_path = constants.clone().with([(time, t)]);
        let mut point = constants.clone().with([(time, model.run.start + t)]);
        for (i, c) in model.coordinates.iter().enumerate() {
            let symbols = [c.position, c.velocity, c.acceleration];
            for (symbol, values) in symbols.into_iter().zip(&along.values) {
                point.set(symbol, on_path.value(pool, values[i]));
            }
        }
        residuals.iter().all(|&e| {
            let (value, size) = pool.evaluate_with_size(e, &|s| point.at(s));
            value.abs() <= HOLDS * size.max(f64::MIN_POSITIVE)
        })
    })
}

/// The conjugate points of the motion from these canonical variables.
fn conjugates(
    laid: &Laid,
    equations: &Equations,
    variables: &[f64],
    duration: f64,
) -> Result<Vec<f64>, DynamicsError> {
    let parameters = &laid.start.parameters;
    let space = PhaseSpace::without_end(&laid.model, equations, &laid.system, parameters)?;
    let state =
        laid.start.state(&laid.system).map_err(|why| DynamicsError::Unsuited(why.to_string()))?;
    let start = space.state_at(&space.state(&state)?, variables);
    conjugate_points(&space, (laid.method, laid.settings), &start, duration)
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

    /// The result in a format.
    fn written(&self, format: TableFormat, laid: &Laid) -> String {
        let columns = JudgedPath::columns(&laid.model);
        let (index, kind) = (self.nature.map(|n| n.0), self.nature.map(|n| word(n.1)));
        if format == TableFormat::Json {
            let mut members = crowd::members(&laid.header());
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
            crowd::lead(&laid.header()) + &text + &cells::record(columns) + &rows
        } else {
            text + "\n" + &cells::text(&columns, &table)
        }
    }
}
