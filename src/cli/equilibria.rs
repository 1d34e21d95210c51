//! `phaselab equilibria`: places of rest and small oscillations about them.

use serde_json::{Map, Value, json};

use super::assignment::Assignment;
use super::error::CommandError;
use super::interrupt::Interrupt;
use super::study::{self, Study, StudyArguments, shown, table};
use crate::dynamics::{
    Equilibria, Equilibrium, EquilibriumKind, PhaseSpace, VirtualWork, equilibria, name_equilibria,
    with_virtual_work,
};
use crate::mechanics::ConstraintRow;
use crate::view::glyphs::Glyphs;

/// Find equilibria and the small oscillations about them.
///
/// Every equilibrium around the start, with its kind (what the effective potential does there),
/// the eigenvalues of the linearised motion, frequencies and modes. Where a coordinate is cyclic it
/// keeps moving with its momentum at the start while all others rest (relative
/// equilibrium). It is stable where that is proved, and linearly stable where the linearised motion
/// only oscillates, which proves nothing of the full one. Under constraints the places are those on their surface, and each has its multipliers.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab equilibria double-pendulum
  phaselab equilibria restricted-three-body --set mu=0.01215 --format json
  phaselab equilibria pendulum-rod
  phaselab equilibria henon-heiles --around x=0 --around y=1")]
pub(super) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// The centre of the search, if not the start: a coordinate.
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    around: Vec<Assignment>,
}

pub(super) fn execute(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    let study = Study::open(&arguments.study, interrupt, PhaseSpace::without_impulses)?;
    let middle = study.around(&arguments.around)?;
    interrupt.ends_by_itself(|| ());
    let mut found = equilibria(&study.space, &middle).map_err(study::failed)?;
    let law = (&*study.model, &*study.equations);
    with_virtual_work(law, study.space.parameters(), &mut found.found);
    name_equilibria(&study.model, study.space.parameters(), &mut found.found);
    let result = (object(&study, &found), text(&study, &found));
    study::write(&arguments.study, result, None, interrupt)
}

fn object(study: &Study, found: &Equilibria) -> Map<String, Value> {
    let mut object = study.head(study.settings);
    let one = |one: &Equilibrium| {
        let frequencies: Vec<f64> = one.modes.iter().map(|mode| mode.frequency).collect();
        let modes: Vec<&[f64]> = one.modes.iter().map(|mode| &mode.in_phase[..]).collect();
        let quarter: Vec<&[f64]> = one.modes.iter().map(|mode| &mode.quadrature[..]).collect();
        let names = study.space.names();
        let rates = one.rates.iter().map(|&(i, rate)| (format!("{}'", names[i]), rate.into()));
        json!({
            "name": if one.name.is_empty() { Value::Null } else { one.name.as_str().into() },
            "state": study.named(&one.variables),
            "rates": Value::Object(rates.collect()),
            "energy": one.energy,
            "multipliers": multipliers(study, one),
            "virtual_work": one.work.iter().map(|work| balance(names, work)).collect::<Vec<_>>(),
            "kind": one.kind.map(EquilibriumKind::word),
            "family": one.family.iter().map(|along| study.named(along)).collect::<Vec<_>>(),
            "eigenvalues": one.eigenvalues,
            "frequencies": frequencies,
            "modes": modes,
            "modes_quadrature": quarter,
            "stable": one.stable,
            "stability": one.stability(),
        })
    };
    let all: Vec<Value> = found.found.iter().map(one).collect();
    object.insert("equilibria".to_owned(), Value::Array(all));
    let names = study.space.names();
    let periods = found.periods.iter().map(|&(i, period)| (names[i].clone(), period.into()));
    object.insert("periods".to_owned(), Value::Object(periods.collect()));
    object.insert("complete".to_owned(), found.is_complete.into());
    let status = if found.cancelled { "stopped" } else { "completed" };
    object.insert("status".to_owned(), status.into());
    object
}

/// The multiplier of each constraint, by its column's name.
fn multipliers(study: &Study, one: &Equilibrium) -> Value {
    let rows = study.equations.constraints.iter().zip(&one.multipliers);
    let pool = &study.equations.pool;
    let name = |row: &ConstraintRow| pool.symbol_info(row.multiplier).name.clone();
    Value::Object(rows.map(|(row, &value)| (name(row), value.into())).collect())
}

fn balance(names: &[String], work: &VirtualWork) -> Value {
    let terms = work.terms.iter().map(|(term, value)| json!({ "term": term, "value": value }));
    json!({
        "coordinate": names[work.coordinate],
        "terms": terms.collect::<Vec<_>>(),
        "sum": work.sum(),
    })
}

fn text(study: &Study, found: &Equilibria) -> String {
    let names = study.space.names();
    if found.found.is_empty() {
        return "no equilibrium was found near the start\n".to_owned();
    }
    let mut text = String::new();
    for one in &found.found {
        let kind = one.kind.map_or("equilibrium", EquilibriumKind::word);
        let stable = one.stability();
        let name = if one.name.is_empty() { String::new() } else { format!("{}: ", one.name) };
        let energy = match one.energy {
            energy if energy.is_finite() => format!("energy {}", shown(energy)),
            _ => "where the energy has no value".to_owned(),
        };
        let family = match one.family.len() {
            0 => String::new(),
            dimension => format!("family of equilibria of dimension {dimension}, "),
        };
        text.push_str(&format!("{name}{family}{kind}, {stable}, {energy}\n"));
        let places = names.iter().zip(&one.variables);
        let places: Vec<String> =
            places.map(|(name, &x)| format!("{name} = {}", shown(x))).collect();
        text.push_str(&format!("  {}\n", places.join(", ")));
        for along in &one.family {
            let parts = names.iter().zip(along).filter(|(_, x)| **x != 0.0);
            let parts: Vec<String> =
                parts.map(|(name, &x)| format!("{name} {}", shown(x))).collect();
            text.push_str(&format!("  along the family {}\n", parts.join("  ")));
        }
        for &(i, rate) in &one.rates {
            text.push_str(&format!("  {}' = {}\n", names[i], shown(rate)));
        }
        for work in &one.work {
            text.push_str(&format!("  δW/δ{} = {}\n", names[work.coordinate], work.balance()));
        }
        let complex = |z: &[f64; 2]| match z[1] {
            0.0 => shown(z[0]),
            im if z[0].abs() <= 1e-7 * im.abs() => format!("{}i", shown(im)),
            im => {
                format!("{} {} {}i", shown(z[0]), if im < 0.0 { '−' } else { '+' }, shown(im.abs()))
            }
        };
        let values: Vec<String> = one.eigenvalues.iter().map(complex).collect();
        let values = if values.is_empty() { "not found".to_owned() } else { values.join(", ") };
        let zeros = if one.family.is_empty() { "" } else { " (0 along the family)" };
        text.push_str(&format!("  eigenvalues {values}{zeros}\n"));
        let degrees = study.space.system().degrees();
        let rows: Vec<Vec<String>> = one
            .modes
            .iter()
            .map(|mode| {
                let mut row = vec![format!("  ω = {}", shown(mode.frequency))];
                let parts = mode.in_phase.iter().zip(&mode.quadrature).zip(&names[..degrees]);
                row.extend(parts.map(|((&a, &b), name)| match b {
                    0.0 => format!("{name} {}", shown(a)),
                    b => format!(
                        "{name} {} {} {}i",
                        shown(a),
                        if b < 0.0 { '−' } else { '+' },
                        shown(b.abs())
                    ),
                }));
                row
            })
            .collect();
        text.push_str(&table(&rows));
        text.push('\n');
    }
    if !found.is_complete {
        text.push_str("the search ended after this many: there may be more\n\n");
    }
    if !found.periods.is_empty() {
        let turn = |&(i, period): &(usize, f64)| format!("{} by {}", names[i], shown(period));
        let turns: Vec<String> = found.periods.iter().map(turn).collect();
        text.push_str(&format!(
            "each stands for all that differ from it in {}\n",
            turns.join(", or in ")
        ));
    }
    if found.is_complete {
        text.push_str("found by a search around the start: there may be others\n");
    }
    text.truncate(text.trim_end().len());
    text.push('\n');
    Glyphs::Braille.text(&text).into_owned()
}
