//! `phaselab actions`: action, period and frequency of one coordinate.

mod along;
mod own;

use std::path::PathBuf;

use serde_json::{Value, json};

use self::own::{containing, own_start};
use super::assignment::{number, whole};
use super::cells::{self, TableCell, TableFormat};
use super::error::CommandError;
use super::interrupt::Interrupt;
use super::motion_options::{CompiledMotion, ModelReading, MotionOptions};
use super::output::Output;
use super::section::surface;
use super::stderr;
use crate::action_angle::{
    ActionRow, ActionSystems, AllowedInterval, EffectivePotential, NoAction, RegionKind,
    Separatrix, action_row, action_rows, average_returns, cyclic_row,
};
use crate::diagnostic::nearest;
use crate::ensemble::add_section;
use crate::expr::Expr;
use crate::model::{Direction, EventAction, Model, MotionEvent};
use crate::num::significant;
use crate::printable;
use crate::system::ChannelKind;

/// Compute action, period and frequency of one degree of freedom.
///
/// For each energy one row for every region that it allows, from left to right: libration between
/// two turning points, or rotation; the action ∮ p dq, the period T, the frequency dE/dJ = 1/T.
/// The separatrices follow, with the actions of their lobes. Without --energy the rows are those
/// of the region in which the start lies. With several coordinates, one is taken in which the system separates;
/// for a cyclic one the frequency is that of its mean advance; where it has no period, and so no action,
/// the angular frequency is its mean rate.
///
/// With --until the motion is followed: in place of that table, action, frequency and the angle
/// variable w = ∂S/∂J, in turns, at times up to then, and how far w is from growing evenly, w₀ + ν (t − t₀).
/// w is a quadrature over places, ν the time of a return. For a law that depends on the time they are those of the
/// system frozen at each instant: the action is then its adiabatic invariant.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab actions pendulum
  phaselab actions double-well --energy=-1/8,0.5 --format json
  phaselab actions planet --coordinate r
  phaselab actions pendulum-action --until 20 --count 40
  phaselab actions slow-oscillator --until 80 --format csv")]
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
    /// Follows the motion until then: the angle variable and its growth.
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = number, conflicts_with = "energy")]
    until: Option<f64>,
    /// Into how many equal intervals the time until then is divided.
    #[arg(
        long,
        allow_hyphen_values = true,
        value_name = "N",
        default_value_t = 24,
        requires = "until"
    )]
    #[arg(value_parser = whole::<u32>(1, 100_000))]
    count: u32,
    /// How the table is written.
    #[arg(long, value_enum, default_value_t = TableFormat::Text)]
    format: TableFormat,
    /// Writes to a file, which appears when it is complete and replaces an old one.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

pub(super) fn execute(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    let reading = arguments.motion.read()?;
    let index = coordinate(&reading.model, arguments.coordinate.as_deref())?;
    if let Some(until) = arguments.until {
        return along::execute(arguments, reading, (index, until), interrupt);
    }
    let name = reading.model.coordinates[index].name.clone();
    let motion = &arguments.motion;
    let along = partner(motion, &reading, index, interrupt)?;
    let systems = Systems::compile(motion, reading, along.unwrap_or(index), interrupt)?;
    let could_not = |why: String| CommandError::CouldNot(why);
    let mut potential = systems.potential()?;
    if let Some([place, rest]) = potential.greatest() {
        return Err(could_not(NoAction::GreatestAtRest { place, rest }.to_string()));
    }
    let own = own_start(&systems.turning, systems.index).map_err(could_not)?;
    let mut rows: Vec<ActionRow> = Vec::new();
    interrupt.ends_by_itself(|| ());
    'energies: for &energy in arguments.energy.as_deref().unwrap_or(&[own.energy]) {
        let mut regions = potential.regions(energy);
        if arguments.energy.is_none() {
            regions = containing(&regions, own.place, potential.period());
        }
        for region in regions {
            let systems_of = systems.systems();
            let found = match (along, arguments.energy.is_some()) {
                (None, true) => action_rows(&mut potential, &systems_of, region, energy),
                (None, false) => action_row(&mut potential, &systems_of, region, (energy, own.way))
                    .map(|row| vec![row]),
                (Some(_), _) => {
                    systems.of_cyclic(&mut potential, index, region, energy).map(|row| vec![row])
                }
            };
            if interrupt.signal().is_some() {
                break 'energies;
            }
            let mut found = found.map_err(|why| could_not(why.to_string()))?;
            average_returns(&mut potential, &systems_of, &mut found)
                .map_err(|why| could_not(why.to_string()))?;
            rows.extend(found);
        }
    }
    let separatrices = match along {
        None => Separatrix::all(&mut potential, || interrupt.signal().is_some())
            .map_err(|why| could_not(why.to_string()))?,
        Some(_) => Vec::new(),
    };
    if let Some(signal) = interrupt.signal().filter(|_| rows.is_empty()) {
        return Err(CommandError::Signal(signal));
    }
    let out = Output::open(arguments.output.as_deref(), arguments.format.form())?;
    let stopped = interrupt.signal().is_some();
    let found = (&rows[..], &separatrices[..]);
    let text = || written(arguments.format, &systems.turning, found, stopped);
    out.write_after_signal(text, interrupt)?;
    if let Some(signal) = interrupt.signal() {
        return Err(CommandError::Signal(signal));
    }
    if rows.is_empty() {
        let rest = potential.at(own.place);
        let is_below = own.energy < rest && !potential.profile.is_same_energy(own.energy, rest);
        let why = if arguments.energy.is_none() && is_below {
            "has less energy at the start than it would have at rest there: no effective potential describes its motion"
        } else {
            "cannot move at the energies given"
        };
        return Err(could_not(format!("{name} {why}")));
    }
    let is_impulse = |event: &MotionEvent| matches!(event.action, EventAction::Impulse(_));
    if systems.turning.model.events.iter().any(is_impulse) {
        stderr::report(
            "impulses at events are left out: these are the actions of the motion without them",
        );
    }
    if rows.iter().any(|row| row.is_uneven) {
        stderr::report(&format!(
            "the returns of {name} take different times, as its rate depends on another coordinate: period and frequency are \
             those of their mean"
        ));
    }
    let [first, last] = potential.profile.resolved();
    let range = match (first.is_finite(), last.is_finite()) {
        (false, false) => String::new(),
        (true, true) => format!("from {name} = {first:.4} to {last:.4}"),
        (true, false) => format!("from {name} = {first:.4} on"),
        (false, true) => format!("up to {name} = {last:.4}"),
    };
    if !range.is_empty() {
        stderr::report(&format!(
            "wells and separatrices are listed {range}; the potential has more of them beyond. If {name} is an angle, give its `period` in \
             the file"
        ));
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

/// The only coordinate that is not cyclic, if the one that is asked for is: its motion repeats itself, and the other one
/// advances by the same angle each time.
fn partner(
    motion: &MotionOptions,
    reading: &ModelReading,
    index: usize,
    interrupt: &Interrupt,
) -> Result<Option<usize>, CommandError> {
    if reading.model.coordinates.len() == 1 {
        return Ok(None);
    }
    let compiled = motion.compile(reading.clone(), &[], "--coordinate", interrupt)?;
    let cyclic = &compiled.equations.cyclic;
    let others: Vec<usize> =
        (0..compiled.model.coordinates.len()).filter(|i| !cyclic.contains(i)).collect();
    Ok(match others[..] {
        [one] if cyclic.contains(&index) => Some(one),
        _ => None,
    })
}

/// A system compiled with the events by which the return of a coordinate is located.
struct Systems {
    index: usize,
    turning: CompiledMotion,
    turns: usize,
    rotating: Option<(CompiledMotion, usize)>,
}

impl Systems {
    fn compile(
        motion: &MotionOptions,
        mut reading: ModelReading,
        index: usize,
        interrupt: &Interrupt,
    ) -> Result<Systems, CommandError> {
        // the time of the return is counted from zero
        reading.start.time = 0.0;
        reading.model.run.start = 0.0;
        let name = reading.model.coordinates[index].name.clone();
        let plain = reading.clone();
        let rotates = plain.model.coordinates[index].period.is_some();
        let zero = surface(&mut reading.model, &format!("{name}'"), "--coordinate")?;
        let turns = add_section(&mut reading.model, zero, Direction::Either);
        let columns = [format!("{} = action", unused_column(&reading.model))];
        let turning = motion.compile(reading, &columns, "--coordinate", interrupt)?;
        refuse_where_energy_is_not_conserved(&turning)?;
        let mut systems = Systems { index, turning, turns, rotating: None };
        let period = systems.potential()?.period().filter(|_| rotates);
        if let Some(period) = period {
            let mut reading = plain;
            let sine = format!("sin(pi*{name}/{period:?})");
            let zero = surface(&mut reading.model, &sine, "--coordinate")?;
            let event = add_section(&mut reading.model, zero, Direction::Either);
            let compiled = motion.compile(reading, &columns, "--coordinate", interrupt)?;
            systems.rotating = Some((compiled, event));
        }
        Ok(systems)
    }

    fn potential(&self) -> Result<EffectivePotential<'_>, CommandError> {
        EffectivePotential::survey(&self.turning.system, &self.turning.start, self.index)
            .map_err(|why| CommandError::CouldNot(why.to_string()))
    }

    /// The column of a quantity in a row of crossings.
    fn column(&self, kind: ChannelKind) -> usize {
        let channels = self.turning.system.channels();
        1 + channels.iter().position(|c| c.kind == kind).unwrap_or(0)
    }

    fn systems(&self) -> ActionSystems<'_> {
        ActionSystems {
            turning: &self.turning.system,
            turns: self.turns,
            rotating: self.rotating.as_ref().map(|(compiled, event)| (&compiled.system, *event)),
            column: self.column(ChannelKind::Position(self.index)),
            method: self.turning.method,
            settings: self.turning.settings,
        }
    }

    /// The row of a cyclic coordinate beside the one that librates.
    fn of_cyclic(
        &self,
        potential: &mut EffectivePotential<'_>,
        cyclic: usize,
        region: AllowedInterval,
        energy: f64,
    ) -> Result<ActionRow, NoAction> {
        let columns =
            [ChannelKind::Position(cyclic), ChannelKind::Momentum(cyclic)].map(|k| self.column(k));
        let parameters = &self.turning.start.parameters;
        let turn = self.turning.system.period(cyclic, parameters);
        cyclic_row(potential, &self.systems(), region, energy, columns, turn)
    }
}

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
        let names = names.collect::<Vec<_>>().join(" or ");
        return wrong(format!("there are several coordinates: give --coordinate {names}"));
    };
    match model.coordinate(wanted) {
        Some(index) => Ok(index),
        None => {
            let shown = printable::quoted(wanted);
            let help = match nearest(wanted, names.clone()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("there are {}", names.collect::<Vec<_>>().join(", ")),
            };
            wrong(format!("unknown coordinate `{shown}`; {help}"))
        }
    }
}

fn refuse_where_energy_is_not_conserved(compiled: &CompiledMotion) -> Result<(), CommandError> {
    let impulses =
        compiled.model.impulses.iter().any(|i| i.period.is_some() || !i.times.is_empty());
    if compiled.equations.energy_rate == Expr::ZERO && !impulses {
        return Ok(());
    }
    let message = "the energy of this system is not conserved, so a motion has no action";
    Err(CommandError::CouldNot(message.to_owned()))
}

/// A number of the table for reading.
fn legibly(x: f64) -> String {
    significant(x, 10, 1e-4..1e6)
}

/// Why there are only some of the rows.
const STOPPED: &str = "stopped by a signal";

/// The table in a format, and whether a signal has stopped it.
fn written(
    format: TableFormat,
    compiled: &CompiledMotion,
    (rows, separatrices): (&[ActionRow], &[Separatrix]),
    stopped: bool,
) -> String {
    let frequency = |row: &ActionRow| match row.kind {
        RegionKind::Unbounded => f64::NAN,
        _ => 1.0 / row.period,
    };
    let period = |row: &ActionRow| match row.kind {
        RegionKind::Unbounded => f64::NAN,
        _ => row.period,
    };
    let action =
        |row: &ActionRow| if row.kind == RegionKind::Unbounded { f64::NAN } else { row.action };
    if format == TableFormat::Json {
        let mut members = compiled.header().members();
        let rows = rows.iter().map(|row| {
            json!({
                "energy": row.energy,
                "kind": row.kind.word(),
                "turning_points": row.turning_points.iter().flatten().collect::<Vec<_>>(),
                "action": action(row),
                "period": period(row),
                "frequency": frequency(row),
                "angular_frequency": row.angular_frequency(),
            })
        });
        members.insert("rows".to_owned(), rows.collect::<Value>());
        let separatrices = separatrices
            .iter()
            .map(|s| json!({ "energy": s.energy, "actions": s.actions, "turn": s.turn.map(|turn| turn[0]), "backward_turn": s.turn.map(|turn| turn[1]) }));
        members.insert("separatrices".to_owned(), separatrices.collect::<Value>());
        members.insert("status".to_owned(), if stopped { "stopped" } else { "completed" }.into());
        members.insert("message".to_owned(), json!(stopped.then_some(STOPPED)));
        return cells::object(&members);
    }
    let names =
        ["energy", "kind", "left", "right", "action", "period", "frequency", "angular_frequency"]
            .map(str::to_owned);
    let csv = format == TableFormat::Csv;
    // an energy near a separatrix is distinguished from it, and an action from that of the separatrix
    let number = |x: f64| {
        let legible = !csv && x.is_finite();
        if legible { TableCell::Word(legibly(x)) } else { TableCell::Number(x) }
    };
    let cell = |row: &ActionRow| {
        let [left, right] = row.turning_points.map(|point| point.unwrap_or(f64::NAN));
        vec![
            number(row.energy),
            TableCell::Word(row.kind.word().to_owned()),
            number(left),
            number(right),
            number(action(row)),
            number(period(row)),
            number(frequency(row)),
            number(row.angular_frequency()),
        ]
    };
    let table: Vec<Vec<TableCell>> = rows.iter().map(cell).collect();
    let lead = if csv { "# " } else { "" };
    let shown = |x: f64| if csv { printable::number(x) } else { legibly(x) };
    let line = |s: &Separatrix| {
        let lobe = |&x: &f64| if x.is_finite() { shown(x) } else { "unbounded".to_owned() };
        let actions: Vec<String> = s.actions.iter().map(lobe).collect();
        let (energy, actions) = (shown(s.energy), actions.join(", "));
        let turn =
            s.turn.map_or_else(String::new, |[right, left]| match (shown(right), shown(left)) {
                (right, left) if right == left => {
                    format!(" of libration, {right} a turn of rotation")
                }
                (right, left) => {
                    format!(
                        " of libration, {right} a turn of rotation, {left} of backward rotation"
                    )
                }
            });
        format!("{lead}separatrix at energy {energy}: actions {actions}{turn}\n")
    };
    let separatrices = separatrices.iter().map(line).collect::<Vec<_>>().concat();
    let end = if stopped { format!("{lead}stopped: {STOPPED}\n") } else { String::new() };
    if csv {
        compiled.header().lines()
            + &separatrices
            + &cells::record(names)
            + &cells::csv(table.iter().map(Vec::as_slice))
            + &end
    } else {
        cells::text(&names, &table) + &separatrices + &end
    }
}
