//! `phaselab actions`: action, period and frequency of one coordinate.

use std::path::PathBuf;

use serde_json::{Value, json};

use super::assignment::number;
use super::cells::{self, Cell, TableFormat};
use super::crowd;
use super::failure::CommandError;
use super::interrupt::Interrupt;
use super::motion_options::{Laid, MotionOptions};
use super::output::Output;
use super::section::surface;
use crate::diagnostic::nearest;
use crate::ensemble::add_section;
use crate::expr::Expr;
use crate::model::{Direction, Model};
use crate::orbits::{
    ActionRow, ActionSystems, EffectivePotential, Region, RegionKind, action_between, action_row,
};
use crate::printable;
use crate::system::ChannelKind;

/// Action, period and frequency of one degree of freedom.
///
/// For each energy one row for every region that it allows, from left to right: libration between
/// two turning points, or rotation; the action ∮ p dq, the period T, the frequency dE/dJ = 1/T.
/// The separatrices follow, with the actions of their lobes. Without --energy there is the region
/// in which the start lies. Of several coordinates one is taken in which the system separates.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab actions pendulum
  phaselab actions double-well --energy=-1/8,0.5 --format json
  phaselab actions planet --coordinate r")]
pub(super) struct Arguments {
    #[command(flatten)]
    motion: MotionOptions,
    /// The coordinate; needed where there are several.
    #[arg(long, value_name = "X")]
    coordinate: Option<String>,
    /// The energies, in place of that of the start.
    #[arg(long, value_name = "E,…", allow_hyphen_values = true, value_parser = number)]
    #[arg(value_delimiter = ',')]
    energy: Option<Vec<f64>>,
    /// How the table is written.
    #[arg(long, value_enum, default_value_t = TableFormat::Text)]
    format: TableFormat,
    /// Writes to a file, which appears when it is complete and takes the place of an old one.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// A separatrix with the actions of its lobes.
struct Separatrix {
    energy: f64,
    actions: Vec<f64>,
}

pub(super) fn perform(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    let mut reading = arguments.motion.read()?;
    let index = coordinate(&reading.model, arguments.coordinate.as_deref())?;
    // the time of the return is counted from zero
    reading.start.time = 0.0;
    reading.model.run.start = 0.0;
    let name = reading.model.coordinates[index].name.clone();
    let plain = reading.clone();
    let rotates = plain.model.coordinates[index].period.is_some();
    let motion = &arguments.motion;
    let zero = surface(&mut reading.model, &format!("{name}'"), "--coordinate")?;
    let turns = add_section(&mut reading.model, zero, Direction::Either);
    let columns = [format!("{} = action", unused_column(&plain.model))];
    let turning = motion.compile(reading, &columns, "--coordinate", interrupt)?;
    refuse_where_energy_is_not_conserved(&turning)?;
    let start = &turning.start;
    let mut potential = EffectivePotential::survey(&turning.system, start, index)
        .map_err(|why| CommandError::CouldNot(why.to_string()))?;
    let rotating = match potential.period().filter(|_| rotates) {
        None => None,
        Some(period) => {
            let mut reading = plain;
            let sine = format!("sin(pi*{name}/{period:?})");
            let zero = surface(&mut reading.model, &sine, "--coordinate")?;
            let event = add_section(&mut reading.model, zero, Direction::Either);
            Some((motion.compile(reading, &columns, "--coordinate", interrupt)?, event))
        }
    };
    let place = |kind| turning.system.channels().iter().position(|c| c.kind == kind).unwrap_or(0);
    let systems = ActionSystems {
        turning: &turning.system,
        turns: &turns,
        rotating: rotating.as_ref().map(|(laid, event)| (&laid.system, event.as_str())),
        column: 1 + place(ChannelKind::Position(index)),
        method: turning.method,
        settings: turning.settings,
    };
    let could_not = |why: String| CommandError::CouldNot(why);
    let own = own_start(&turning, index).map_err(could_not)?;
    let mut rows: Vec<ActionRow> = Vec::new();
    for &energy in arguments.energy.as_deref().unwrap_or(&[own.energy]) {
        let mut regions = potential.regions(energy);
        if arguments.energy.is_none() {
            regions = containing(&regions, own.place, potential.period());
        }
        for region in regions {
            let row = action_row(&mut potential, &systems, region, energy);
            rows.push(row.map_err(|why| could_not(why.to_string()))?);
        }
    }
    let mut separatrices = Vec::new();
    for top in potential.tops() {
        let mut actions = Vec::new();
        for lobe in potential.lobes(top) {
            actions.push(match (lobe.left, lobe.right) {
                (Some(left), Some(right)) => action_between(&mut potential, left, right, top[1])
                    .map_err(|why| could_not(why.to_string()))?,
                _ => f64::INFINITY,
            });
        }
        separatrices.push(Separatrix { energy: top[1], actions });
    }
    if let Some(signal) = interrupt.signal() {
        return Err(CommandError::Signal(signal));
    }
    let out = Output::open(arguments.output.as_deref(), arguments.format.form())?;
    crowd::write(out, &written(arguments.format, &turning, &rows, &separatrices), interrupt)?;
    if rows.is_empty() {
        return Err(could_not(format!("{name} cannot move at that energy")));
    }
    Ok(())
}

/// A name that no column of the file has.
fn unused_column(model: &Model) -> String {
    let mut name = "S".to_owned();
    let coordinates = || model.coordinates.iter().map(|c| c.name.as_str());
    while coordinates().chain(model.observables.iter().map(|o| o.name.as_str())).any(|n| n == name)
    {
        name.push('_');
    }
    name
}

/// The coordinate that is asked for.
fn coordinate(model: &Model, wanted: Option<&str>) -> Result<usize, CommandError> {
    let wrong = |message: String| Err(CommandError::WrongUse(message));
    if model.is_poisson() {
        return wrong(
            "variables given by their brackets have no momenta, and no actions here".to_owned(),
        );
    }
    if !model.constraints.is_empty() {
        return wrong(
            "a system with constraints has no actions here: choose coordinates that need none"
                .to_owned(),
        );
    }
    let names = model.coordinates.iter().map(|c| c.name.as_str());
    let Some(wanted) = wanted else {
        if let [_] = model.coordinates.as_slice() {
            return Ok(0);
        }
        let names = names.collect::<Vec<_>>().join(", ");
        return wrong(format!("of several coordinates one is taken, --coordinate: {names}"));
    };
    match model.coordinate(wanted) {
        Some(index) => Ok(index),
        None => {
            let shown = printable::quoted(wanted);
            let help = match nearest(wanted, names.clone()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("there are {}", names.collect::<Vec<_>>().join(", ")),
            };
            wrong(format!("there is no coordinate `{shown}`; {help}"))
        }
    }
}

fn refuse_where_energy_is_not_conserved(laid: &Laid) -> Result<(), CommandError> {
    let impulses = laid.model.impulses.iter().any(|i| i.period.is_some() || !i.times.is_empty());
    if laid.equations.energy_rate == Expr::ZERO && !impulses {
        return Ok(());
    }
    let message = "the energy of this system is not conserved, and a motion has no action";
    Err(CommandError::CouldNot(message.to_owned()))
}

/// Where the coordinate is at the start, and the energy there.
struct Own {
    place: f64,
    energy: f64,
}

fn own_start(laid: &Laid, index: usize) -> Result<Own, String> {
    let state = laid.start.state(&laid.system).map_err(|why| why.to_string())?;
    let mut values = vec![0.0; laid.system.columns()];
    let mut observer = laid.system.observer(&laid.start.parameters);
    observer.observe_columns(&state, &mut values).map_err(|why| why.to_string())?;
    let value = |kind| {
        let place = laid.system.channels().iter().position(|c| c.kind == kind);
        place.map_or(f64::NAN, |place| values[place])
    };
    let place = value(ChannelKind::Position(index));
    Ok(Own { place, energy: value(ChannelKind::Energy) })
}

/// The region that a place lies in; a start at rest lies on its edge.
fn containing(regions: &[Region], place: f64, period: Option<f64>) -> Vec<Region> {
    let distance = |region: &Region| {
        let at = |place: f64| {
            let left = region.left.map_or(0.0, |left| left - place);
            let right = region.right.map_or(0.0, |right| place - right);
            left.max(right).max(0.0)
        };
        let turns = period.map_or(vec![0.0], |period| vec![-period, 0.0, period]);
        turns.into_iter().map(|turn| at(place + turn)).fold(f64::INFINITY, f64::min)
    };
    regions.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).copied().into_iter().collect()
}

/// The table in a format.
fn written(
    format: TableFormat,
    laid: &Laid,
    rows: &[ActionRow],
    separatrices: &[Separatrix],
) -> String {
    let frequency = |row: &ActionRow| 1.0 / row.period;
    let action =
        |row: &ActionRow| if row.kind == RegionKind::Unbounded { f64::NAN } else { row.action };
    if format == TableFormat::Json {
        let mut members = crowd::members(&laid.header());
        let rows = rows.iter().map(|row| {
            json!({
                "energy": row.energy,
                "kind": row.kind.word(),
                "turning_points": row.turning_points,
                "action": action(row),
                "period": row.period,
                "frequency": frequency(row),
            })
        });
        members.insert("rows".to_owned(), rows.collect::<Value>());
        let separatrices =
            separatrices.iter().map(|s| json!({ "energy": s.energy, "actions": s.actions }));
        members.insert("separatrices".to_owned(), separatrices.collect::<Value>());
        return cells::object(&members);
    }
    let names =
        ["energy", "kind", "left", "right", "action", "period", "frequency"].map(str::to_owned);
    let cell = |row: &ActionRow| {
        let point = |i: usize| row.turning_points.get(i).copied().unwrap_or(f64::NAN);
        vec![
            Cell::Number(row.energy),
            Cell::Word(row.kind.word().to_owned()),
            Cell::Number(point(0)),
            Cell::Number(point(1)),
            Cell::Number(action(row)),
            Cell::Number(row.period),
            Cell::Number(frequency(row)),
        ]
    };
    let table: Vec<Vec<Cell>> = rows.iter().map(cell).collect();
    let lead = if format == TableFormat::Csv { "# " } else { "" };
    let shown = |x: f64| {
        if format == TableFormat::Csv { printable::number(x) } else { crate::num::short(x) }
    };
    let line = |s: &Separatrix| {
        let actions: Vec<String> = s.actions.iter().map(|&x| shown(x)).collect();
        let (energy, actions) = (shown(s.energy), actions.join(", "));
        format!("{lead}separatrix at energy {energy}: actions {actions}\n")
    };
    let separatrices = separatrices.iter().map(line).collect::<Vec<_>>().concat();
    if format == TableFormat::Csv {
        crowd::lead(&laid.header())
            + &separatrices
            + &cells::record(names)
            + &cells::csv(table.iter().map(Vec::as_slice))
    } else {
        cells::text(&names, &table) + &separatrices
    }
}
