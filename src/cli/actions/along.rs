//! The action and the angle variable of one coordinate along its motion.
//!
//! In: a motion, times. Out: at each time energy, action, frequency and w = ∂S/∂J, and how far w is from growing evenly. Of a
//! law that depends on the time they are those of the system frozen at that instant. Never here: how they are computed.
//! Source: *The Principles of Dynamics*, §§ 4.2, 4.3.

use serde_json::{Value, json};

use super::Arguments;
use crate::action_angle::{AngleAtTime, FrozenSystem};
use crate::cli::cells::{self, TableCell, TableFormat};
use crate::cli::count_bar::CountBar;
use crate::cli::decimal::divisions;
use crate::cli::error::CommandError;
use crate::cli::interrupt::Interrupt;
use crate::cli::motion_options::{CompiledMotion, ModelReading};
use crate::cli::output::Output;
use crate::ensemble::SystemFlow;
use crate::printable;
use crate::system::ChannelKind;

/// The rows, and whether the law depends on the time.
struct ActionsAlong {
    coordinate: String,
    places: Vec<f64>,
    moments: Vec<AngleAtTime>,
    depends_on_time: bool,
    /// Why it ends before its time.
    why: Option<String>,
}

/// Follows the motion of a coordinate until a time.
pub(super) fn execute(
    arguments: &Arguments,
    reading: ModelReading,
    (index, until): (usize, f64),
    interrupt: &Interrupt,
) -> Result<(), CommandError> {
    let compiled = arguments.motion.compile(reading, &[], "", interrupt)?;
    if until <= compiled.start.time {
        let [until, start] = [until, compiled.start.time].map(printable::number);
        let message = format!("the motion begins at {start}; --until {until} is not after it");
        return Err(CommandError::WrongUse(message));
    }
    interrupt.ends_by_itself(|| ());
    let along = followed(&compiled, (index, until, arguments.count), interrupt)?;
    if along.moments.is_empty() {
        return Err(match (interrupt.signal(), along.why) {
            (Some(signal), _) => CommandError::Signal(signal),
            (None, why) => CommandError::CouldNot(why.unwrap_or_default()),
        });
    }
    let out = Output::open(arguments.output.as_deref(), arguments.format.form())?;
    let stopped = interrupt.signal().is_some();
    out.write_after_signal(|| along.written(arguments.format, &compiled, stopped), interrupt)?;
    match (interrupt.signal(), along.why) {
        (Some(signal), _) => Err(CommandError::Signal(signal)),
        (None, Some(why)) => Err(CommandError::CouldNot(why)),
        (None, None) => Ok(()),
    }
}

fn followed(
    compiled: &CompiledMotion,
    (index, until, count): (usize, f64, u32),
    interrupt: &Interrupt,
) -> Result<ActionsAlong, CommandError> {
    let could_not = |why: String| CommandError::CouldNot(why);
    let (system, start) = (&compiled.system, &compiled.start);
    let frozen =
        FrozenSystem::of(&compiled.model, index, FrozenSystem::PRECISE, interrupt.cancel())
            .map_err(|why| could_not(why.to_string()))?;
    let degrees = compiled.model.coordinates.len();
    let kinds =
        (0..degrees).map(ChannelKind::Position).chain((0..degrees).map(ChannelKind::Momentum));
    let channels: Option<Vec<usize>> =
        kinds.map(|kind| system.channels().iter().position(|c| c.kind == kind)).collect();
    let channels = channels.ok_or_else(|| could_not("the motion has no momenta".to_owned()))?;
    let state = start.state(system).map_err(|why| could_not(why.to_string()))?;
    let flow = SystemFlow {
        system: system.clone(),
        method: (compiled.method, compiled.settings),
        parameters: start.parameters.clone(),
        start: start.time,
        effort: None,
    };
    let times: Vec<f64> = divisions(start.time, until, count).collect();
    let seen = flow.carry(&state, &times, &channels).seen;
    let mut along = ActionsAlong {
        coordinate: compiled.model.coordinates[index].name.clone(),
        places: Vec::new(),
        moments: Vec::new(),
        depends_on_time: frozen.depends_on_time(),
        why: None,
    };
    let mut bar = CountBar::new(0, times.len());
    for (&time, values) in times.iter().zip(&seen) {
        if interrupt.signal().is_some() {
            return Ok(along);
        }
        let (positions, momenta) = values.split_at(degrees);
        match AngleAtTime::of(&frozen, time, &start.parameters, [positions, momenta]) {
            Ok(moment) => {
                along.places.push(positions[index]);
                along.moments.push(moment.after(along.moments.last()));
            }
            Err(why) => {
                let at = printable::number(time);
                along.why = Some(format!("there is no angle variable at t = {at}: {why}"));
                return Ok(along);
            }
        }
        bar.add();
    }
    if seen.len() < times.len() {
        let at = printable::number(times[seen.len()]);
        along.why = Some(format!("the motion ends before t = {at}"));
    }
    Ok(along)
}

impl ActionsAlong {
    /// How far w is from w₀ + ν (t − t₀) at each time; none where the law depends on the time.
    fn residuals(&self) -> Option<Vec<f64>> {
        let first = self.moments.first().filter(|_| !self.depends_on_time)?;
        Some(self.moments.iter().map(|moment| moment.angle - first.even(moment.time)).collect())
    }

    fn written(&self, format: TableFormat, compiled: &CompiledMotion, stopped: bool) -> String {
        let residuals = self.residuals();
        let mut names = vec!["t", &self.coordinate, "energy", "action", "frequency", "angle"];
        if residuals.is_some() {
            names.push("residual");
        }
        let row = |k: usize| {
            let AngleAtTime { time, angle, frequency, action, energy } = self.moments[k];
            let mut row = vec![time, self.places[k], energy, action, frequency, angle];
            row.extend(residuals.as_ref().map(|all| all[k]));
            row
        };
        let rows: Vec<Vec<f64>> = (0..self.moments.len()).map(row).collect();
        let largest = residuals.as_ref().map(|all| all.iter().fold(0.0_f64, |m, x| m.max(x.abs())));
        if format == TableFormat::Json {
            let mut members = compiled.header().members();
            let along = json!({
                "columns": names,
                "rows": rows,
                "depends_on_time": self.depends_on_time,
                "largest_residual": largest,
            });
            members.insert("along".to_owned(), along);
            let (status, message) = match &self.why {
                None if stopped => ("stopped", "stopped by a signal".into()),
                None => ("completed", Value::Null),
                Some(why) => ("faulted", why.clone().into()),
            };
            members.insert("status".to_owned(), status.into());
            members.insert("message".to_owned(), message);
            return cells::object(&members);
        }
        let names: Vec<String> = names.into_iter().map(str::to_owned).collect();
        let table: Vec<Vec<TableCell>> =
            rows.into_iter().map(|row| row.into_iter().map(TableCell::Number).collect()).collect();
        if format == TableFormat::Csv {
            return compiled.header().lines()
                + &cells::record(names)
                + &cells::csv(table.iter().map(Vec::as_slice));
        }
        let evenly = match largest {
            Some(largest) => format!(
                "w = w0 + frequency*(t - t0) to {} of a turn\n",
                crate::num::short(largest)
            ),
            None => "the law depends on the time: action, frequency and angle are those of the system frozen \
                     at each instant\n"
                .to_owned(),
        };
        cells::text(&names, &table) + &evenly
    }
}
