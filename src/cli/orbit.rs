//! `phaselab orbit`: the periodic orbit near a start.

use serde_json::{Map, Value, json};

use super::assignment::number;
use super::failure::CommandError;
use super::interrupt::Interrupt;
use super::study::{self, Study, StudyArguments, shown};
use crate::dynamics::{Fixed, Orbit, Removed, periodic_orbit};

/// Close the periodic orbit near the start.
///
/// Newton's method on the flow map finds the orbit of the start's energy, or of another energy or
/// of a given period; where energy is not conserved, the limit cycle. Its multipliers are those of
/// the monodromy matrix: with a conserved energy two of them are 1, those along the orbit and
/// across the energy.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab orbit henon-heiles --init x=0 --init y=-0.18 --init p_x=0.46 --init p_y=0
  phaselab orbit pendulum --energy 0.5
  phaselab orbit figure-eight --period 6.3259 --format json")]
pub(super) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// The period of the orbit, or beside --energy where to begin with it.
    #[arg(long, value_name = "T", value_parser = number)]
    period: Option<f64>,
    /// The energy of the orbit; that of the start where neither is given.
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = number)]
    energy: Option<f64>,
}

pub(super) fn perform(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    let study = Study::open(&arguments.study, interrupt)?;
    let fixed = fixed(arguments, &study)?;
    interrupt.ends_by_itself(|| ());
    let method = (study.method, study.settings);
    let found = periodic_orbit(&study.space, method, &study.start, arguments.period, fixed);
    let orbit = found.map_err(|error| match interrupt.signal() {
        Some(signal) => CommandError::Signal(signal),
        None => study::failed(error),
    })?;
    let result = (object(&study, &orbit), text(&study, &orbit));
    study::write(&arguments.study, result, None, interrupt)
}

/// What the orbit is to have.
fn fixed(arguments: &Arguments, study: &Study) -> Result<Fixed, CommandError> {
    let space = &study.space;
    let wrong = |what: &str| Err(CommandError::WrongUse(what.to_owned()));
    let conserved = space.is_hamiltonian() && space.is_autonomous();
    match (arguments.energy, arguments.period) {
        (_, Some(period)) if period <= 0.0 => wrong("--period: a period is above zero"),
        (Some(_), _) if !conserved => {
            wrong("--energy: the energy of this system is not that of an orbit, as it changes")
        }
        (Some(energy), _) => Ok(Fixed::Energy(energy)),
        // a limit cycle has the period that it has
        (None, Some(_)) if space.is_autonomous() && !conserved => Ok(Fixed::Nothing),
        (None, Some(period)) => Ok(Fixed::Period(period)),
        (None, None) if conserved => {
            let energy = space.system().energy(&study.start, space.parameters());
            energy.map(Fixed::Energy).map_err(|fault| CommandError::CouldNot(fault.to_string()))
        }
        (None, None) => Ok(Fixed::Nothing),
    }
}

fn trivial(what: Removed) -> &'static [&'static str] {
    match what {
        Removed::Nothing => &[],
        Removed::Flow => &["flow"],
        Removed::FlowAndEnergy => &["flow", "energy"],
    }
}

/// All multipliers, the trivial ones last.
fn multipliers(orbit: &Orbit) -> Vec<[f64; 2]> {
    let mut all = orbit.multipliers.clone();
    all.extend(std::iter::repeat_n([1.0, 0.0], orbit.trivial.count()));
    all
}

fn object(study: &Study, orbit: &Orbit) -> Map<String, Value> {
    let mut object = study.head(orbit.settings);
    let mut insert = |name: &str, value: Value| object.insert(name.to_owned(), value);
    insert("period", json!(orbit.period));
    insert("start", study.named(study.space.variables(&orbit.state)));
    insert("energy", json!(orbit.energy));
    insert("action", json!(orbit.action));
    insert("closure", json!(orbit.closure));
    insert("multipliers", json!(multipliers(orbit)));
    insert("trivial", json!(trivial(orbit.trivial)));
    insert("trace", json!(orbit.transverse.trace()));
    insert("stable", json!(orbit.stable));
    object
}

fn text(study: &Study, orbit: &Orbit) -> String {
    let names = study.space.names();
    let start = names.iter().zip(study.space.variables(&orbit.state));
    let start: Vec<String> = start.map(|(name, &x)| format!("{name} = {x:?}")).collect();
    let complex = |z: &[f64; 2]| match z[1] {
        0.0 => shown(z[0]),
        im => format!("{} {} {}i", shown(z[0]), if im < 0.0 { '−' } else { '+' }, shown(im.abs())),
    };
    let all: Vec<String> = orbit.multipliers.iter().map(complex).collect();
    let stable = if orbit.stable { "stable" } else { "unstable" };
    let mut text = format!("{stable} periodic orbit\n\n");
    text.push_str(&format!("period   {:?}\n", orbit.period));
    text.push_str(&format!("energy   {:?}\n", orbit.energy));
    if let Some(action) = orbit.action {
        text.push_str(&format!("∮ p dq   {action:?}\n"));
    }
    text.push_str(&format!("start    {}\n", start.join(", ")));
    text.push_str(&format!("closure  {:.1e}\n", orbit.closure));
    let all = if all.is_empty() { "none but these".to_owned() } else { all.join(", ") };
    text.push_str(&format!("\nmultipliers {all}\n"));
    if orbit.trivial.count() > 0 {
        let names = trivial(orbit.trivial).join(" and of the ");
        text.push_str(&format!("and 1 of the {names}\n"));
    }
    text
}
