//! `phaselab orbit`: the periodic orbit near a start.

use std::str::FromStr;

use serde_json::{Map, Value, json};

use super::assignment::{self, name_in_letters, number};
use super::decimal;
use super::error::CommandError;
use super::interrupt::Interrupt;
use super::slow_notice::with_notice;
use super::study::{self, Study, StudyArguments, shown, table};
use crate::dynamics::{
    Along, Bifurcation, Family, Fixed, NOT_ISOLATED, Orbit, OrbitStability, PhaseSpace,
    drive_period, driven_family, driven_orbit, family, periodic_orbit,
};

/// Find the periodic orbit near the start.
///
/// Newton's method on the flow map finds the orbit of the start's energy, or of another energy or
/// of a given period; where energy is not conserved, the limit cycle. Its multipliers are those of
/// the monodromy matrix: with a conserved energy two of them are 1, those along the orbit and
/// across the energy. Impulses, also those that events cause, are part of an orbit, and carry its
/// multipliers on by their own derivatives. --along follows the family of the orbit, in both directions, through folds,
/// and names where it turns back or others branch off.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab orbit henon-heiles --init x=0 --init y=-0.18 --init p_x=0.46 --init p_y=0
  phaselab orbit pendulum --energy 0.5
  phaselab orbit pendulum --along energy=-9:9:10
  phaselab orbit bouncing-ball --set eps=1 --set vx=0
  phaselab orbit figure-eight --period 6.3259 --format json")]
pub(super) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// The period of the orbit, or beside --energy where to begin with it.
    #[arg(long, allow_hyphen_values = true, value_name = "T", value_parser = number)]
    period: Option<f64>,
    /// The energy of the orbit; that of the start where neither is given.
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = number)]
    energy: Option<f64>,
    /// Follows the family of the orbit over values of `energy`, `period` or a parameter.
    #[arg(long, value_name = "NAME=FROM:TO:COUNT", allow_hyphen_values = true)]
    along: Option<SweptValues>,
}

/// Values of something, from one to another.
#[derive(Clone, PartialEq, Debug)]
struct SweptValues {
    name: String,
    values: Vec<f64>,
}

/// The most values of a family.
const MOST: u32 = 10_000;

impl FromStr for SweptValues {
    type Err = String;

    fn from_str(text: &str) -> Result<SweptValues, String> {
        let shape = || "write it as NAME=FROM:TO:COUNT".to_owned();
        let (name, range) = text.split_once('=').ok_or_else(shape)?;
        let [from, to, count] = range.split(':').collect::<Vec<_>>()[..] else {
            return Err(shape());
        };
        let (from, to) = (number(from)?, number(to)?);
        let count: u32 = count.trim().parse().map_err(|_| shape())?;
        if !(2..=MOST).contains(&count) || from == to {
            return Err(format!("a family has 2 to {MOST} values, between two different ends"));
        }
        Ok(SweptValues {
            name: name_in_letters(name),
            values: decimal::divisions(from, to, count - 1).collect(),
        })
    }
}

pub(super) fn execute(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    let study = Study::open(&arguments.study, interrupt, PhaseSpace::on_constraints)?;
    let fixed = fixed(arguments, &study)?;
    let along = arguments.along.as_ref().map(|values| along(values, &study)).transpose()?;
    interrupt.ends_by_itself(|| ());
    let method = (study.method, study.settings);
    let find = || match (arguments.period, study.space.drive()) {
        (None, Some(drive)) => driven_orbit(&study.space, method, &study.start, drive),
        (period, _) => periodic_orbit(&study.space, method, &study.start, period, fixed),
    };
    let orbit = with_notice("searching for the orbit", find).map_err(study::failed)?;
    let fixed = if study.space.is_autonomous() { fixed } else { Fixed::Period(orbit.period) };
    let values = arguments.along.as_ref().map_or(&[][..], |along| &along.values);
    let follow = || {
        along.map(|along| {
            let (model, equations) = (&study.model, &study.equations);
            let drive = |parameters: &[f64]| {
                drive_period(model, equations, study.space.system(), parameters)
            };
            if study.space.is_autonomous() {
                family(&study.space, method, &orbit, (along, fixed), (values, &|_| ()))
            } else {
                driven_family(&study.space, method, &orbit, (along, &drive), (values, &|_| ()))
            }
        })
    };
    let family = with_notice("following the family of orbits", follow);
    let family = family.transpose().map_err(study::failed)?;
    let (mut object, mut text) = (object(&study, &orbit), text(&study, &orbit));
    if let (Some(family), Some(along)) = (&family, &arguments.along) {
        object.insert("along".to_owned(), along.name.as_str().into());
        object.insert("family".to_owned(), members(&study, family));
        object.insert("isolated".to_owned(), json!(family.isolated));
        object.insert("ended".to_owned(), json!(family.ended));
        text.push_str(&rows(family, &along.name));
    }
    let result = (object, text);
    study::write(&arguments.study, result, None, interrupt)
}

fn fixed(arguments: &Arguments, study: &Study) -> Result<Fixed, CommandError> {
    let space = &study.space;
    let wrong = |what: &str| Err(CommandError::WrongUse(what.to_owned()));
    let conserved = space.has_energy_levels();
    match (arguments.energy, arguments.period) {
        (_, Some(period)) if period <= 0.0 => wrong("--period: a period must be above zero"),
        (Some(_), _) if !conserved => wrong(
            "--energy: the energy is not conserved, or everywhere the same, so it cannot select an orbit",
        ),
        (Some(energy), _) => Ok(Fixed::Energy(energy)),
        // a limit cycle has the period that it has
        (None, Some(_)) if space.is_autonomous() && !conserved => Ok(Fixed::Nothing),
        (None, Some(period)) => Ok(Fixed::Period(period)),
        (None, None) if conserved => {
            let energy = space.system().energy(&study.start, space.parameters());
            energy.map(Fixed::Energy).map_err(|error| CommandError::CouldNot(error.to_string()))
        }
        (None, None) => Ok(Fixed::Nothing),
    }
}

fn along(values: &SweptValues, study: &Study) -> Result<Along, CommandError> {
    match values.name.as_str() {
        "energy" => Ok(Along::Energy),
        "period" => Ok(Along::Period),
        name => match study.model.parameter(name) {
            Some(index) => Ok(Along::Parameter(index)),
            None => {
                let parameters = study.model.parameters.iter().map(|p| p.name.as_str());
                let names: Vec<&str> = parameters.chain(["energy", "period"]).collect();
                Err(assignment::unknown("parameter", name, &names))
            }
        },
    }
}

fn members(study: &Study, family: &Family) -> Value {
    let member = |member: &crate::dynamics::Member| {
        json!({
            "value": member.value,
            "period": member.orbit.period,
            "energy": member.orbit.energy,
            "start": study.named(study.space.variables(&member.orbit.state)),
            "closure": member.orbit.closure,
            "multipliers": multipliers(&member.orbit),
            "trace": member.orbit.transverse.trace(),
            "stable": member.is_stable(),
            "stability": member.stability().word(),
            "bifurcation": member.bifurcation.map(Bifurcation::word),
        })
    };
    Value::Array(family.members.iter().map(member).collect())
}

/// The family as a table, and why it ends early.
fn rows(family: &Family, name: &str) -> String {
    let head = [name, "period", "energy", "trace", "", ""];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for member in &family.members {
        let orbit = &member.orbit;
        rows.push(vec![
            shown(member.value),
            shown(orbit.period),
            shown(orbit.energy),
            shown(orbit.transverse.trace()),
            member.stability().word().to_owned(),
            member.bifurcation.map_or("", Bifurcation::word).to_owned(),
        ]);
    }
    let mut text = format!("\n{}", table(&rows));
    if !family.isolated {
        text.push_str(&format!("{NOT_ISOLATED}\n"));
    }
    for why in &family.ended {
        text.push_str(&format!("{why}\n"));
    }
    text
}

/// All multipliers, the trivial ones last.
fn multipliers(orbit: &Orbit) -> Vec<[f64; 2]> {
    let mut all = orbit.multipliers.clone();
    all.extend(std::iter::repeat_n([1.0, 0.0], orbit.trivial_names().len()));
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
    insert("closes_to_rounding", json!(orbit.closes_to_rounding));
    insert("multipliers", json!(multipliers(orbit)));
    let exponents = orbit.multipliers.iter().map(|z| orbit.exponent(*z));
    insert("multipliers_error", json!(orbit.rounding));
    let trivial_ones = std::iter::repeat_n(Some(0.0), orbit.trivial_names().len());
    insert("exponents", exponents.chain(trivial_ones).collect());
    insert("trivial", json!(orbit.trivial_names()));
    insert("trace", json!(orbit.transverse.trace()));
    insert("residue", json!(orbit.residue()));
    insert("stable", json!(orbit.is_stable()));
    insert("stability", json!(orbit.stability().word()));
    object
}

fn text(study: &Study, orbit: &Orbit) -> String {
    let names = study.space.names();
    let start = names.iter().zip(study.space.variables(&orbit.state));
    let start: Vec<String> = start.map(|(name, &x)| format!("{name} = {x:?}")).collect();
    let headline = match orbit.stability() {
        OrbitStability::Neutral if orbit.levels.len() > 1 => {
            "periodic orbit, one of a family in E and the Casimirs"
        }
        OrbitStability::Neutral => "periodic orbit, one of a family in E",
        OrbitStability::Parabolic => {
            "parabolic periodic orbit: all multipliers are 1, as on a torus filled with periodic orbits"
        }
        OrbitStability::Stable => "stable periodic orbit",
        OrbitStability::Unstable => "unstable periodic orbit",
    };
    let mut text = format!("{headline}\n\n");
    text.push_str(&format!("period   {:?}\n", orbit.period));
    text.push_str(&format!("energy   {:?}\n", orbit.energy));
    if let Some(action) = orbit.action {
        text.push_str(&format!("∮ p dq   {action:?}\n"));
    }
    text.push_str(&format!("start    {}\n", start.join(", ")));
    let only = if orbit.closes_to_rounding { "" } else { " (larger than rounding explains)" };
    text.push_str(&format!("closure  {}{only}\n", decimal::magnitude(orbit.closure)));
    text.push_str("\nmultipliers\n");
    let rows = multiplier_rows(orbit);
    let widest = rows.iter().map(|(value, _)| value.chars().count()).max().unwrap_or(0);
    for (value, meaning) in rows {
        text.push_str(&format!("  {value:<widest$}  {meaning}\n"));
    }
    if let Some(error) = orbit.rounding.filter(|error| *error > crate::dynamics::NOTICED_ROUNDING) {
        text.push_str(&format!("rounding    {error:.0e} in the entries of their matrix\n"));
    }
    if let Some(residue) = orbit.residue() {
        text.push_str(&format!("residue     {}\n", shown(residue)));
    }
    text
}

/// The flow and the energy with their article; a Casimir is called by its name.
fn of(trivial: &str) -> String {
    if ["flow", "energy"].contains(&trivial) {
        format!("the {trivial}")
    } else {
        trivial.to_owned()
    }
}

/// A row for each multiplier or conjugate pair: what it is, and its exponent or its angle. Those that symmetries hold at 1 are
/// one row.
fn multiplier_rows(orbit: &Orbit) -> Vec<(String, String)> {
    let off_one = |z: &[f64; 2]| crate::num::math::hypot(z[0] - 1.0, z[1]);
    let (ones, others): (Vec<usize>, Vec<usize>) =
        (0..orbit.multipliers.len()).partition(|&i| orbit.is_one(i));
    let values = |places: Vec<usize>| places.into_iter().map(|i| &orbit.multipliers[i]);
    let (ones, others): (Vec<_>, Vec<_>) = (values(ones).collect(), values(others).collect());
    let mut rows = Vec::new();
    let (small, others): (Vec<&[f64; 2]>, Vec<&[f64; 2]>) =
        others.into_iter().partition(|z| orbit.nearly_vanishes(**z));
    let (lost, others): (Vec<&[f64; 2]>, Vec<&[f64; 2]>) =
        others.into_iter().partition(|z| orbit.is_lost(**z));
    for &z in others.into_iter().filter(|z| z[1] >= 0.0) {
        let value = match z[1] {
            0.0 => shown(z[0]),
            im => format!("{} ± {}i", shown(z[0]), shown(im)),
        };
        let meaning = match orbit.rotation(z) {
            Some(turns) => format!("ν = {turns:.12}"),
            None => orbit.exponent(z).map_or(String::new(), |x| format!("ln|μ|/T = {x:.12}")),
        };
        rows.push((value, meaning));
    }
    if let Some(error) = orbit.rounding.filter(|_| !lost.is_empty()) {
        let times = if lost.len() > 1 { format!("{} times, ", lost.len()) } else { String::new() };
        rows.push((
            "not known".to_owned(),
            format!("{times}at most {error:.0e}: lost in rounding"),
        ));
    }
    if let Some(error) = orbit.rounding.filter(|_| !small.is_empty()) {
        let times =
            if small.len() > 1 { format!("{} times, ", small.len()) } else { String::new() };
        rows.push(("0".to_owned(), format!("{times}to {error:.0e}: lost in rounding")));
    }
    if !ones.is_empty() {
        let spread = ones.iter().map(|z| off_one(z)).fold(0.0, f64::max);
        let times = if ones.len() > 1 { format!("{} times, ", ones.len()) } else { String::new() };
        rows.push(("1".to_owned(), format!("{times}to {spread:.0e}")));
    }
    let trivial = orbit.trivial_names();
    if let Some((last, others)) = trivial.split_last() {
        let others = match others {
            [] => String::new(),
            others => format!(
                "{} and of ",
                others.iter().map(|name| of(name)).collect::<Vec<_>>().join(", of ")
            ),
        };
        rows.push(("1".to_owned(), format!("of {others}{}", of(last))));
    }
    rows
}
