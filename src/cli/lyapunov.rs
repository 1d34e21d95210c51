//! `phaselab lyapunov`: the exponents of a motion.

use serde_json::{Map, Value, json};

use super::assignment::{number, whole};
use super::error::CommandError;
use super::interrupt::Interrupt;
use super::run::progress::Bar;
use super::study::{self, Study, StudyArguments, shown, table};
use crate::dynamics::{Gali, Lyapunov, PhaseSpace, Removed, gali, lyapunov};

/// Measure how fast neighbouring motions separate.
///
/// All Lyapunov exponents with their uncertainty, the largest first, MEGNO (about 2 for regular
/// motion, growing for chaotic), and a verdict with its reason: regular, chaotic, unstable or undecided.
/// Neighbours that separate exponentially mean chaos only if the motion itself does not escape, come
/// to rest, close or follow linear equations; otherwise it is unstable.
/// An exponent is the mean rate of growth under a weight that vanishes smoothly at both ends of
/// the time; after ± stands the standard error of the mean over parts of it, with 2/t for the
/// direction of the vector.
/// Where H is conserved the direction of the motion and that of the energy are taken out; their
/// exponents are zero.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab lyapunov henon-heiles --until 1000
  phaselab lyapunov double-pendulum --until 200 --exponents 1
  phaselab lyapunov henon-heiles --until 1000 --gali 4
  phaselab lyapunov duffing --until 500 --format json")]
pub(super) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// When to end; by default as the file says, or 10 after the start.
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = number)]
    until: Option<f64>,
    /// How many exponents are written, the largest first.
    #[arg(long, allow_hyphen_values = true, value_name = "K|all", default_value = "all", value_parser = count)]
    exponents: Count,
    /// Measures GALI2 to GALIK too: the volumes that tangent vectors span, which fall exponentially in chaos.
    #[arg(long, allow_hyphen_values = true, value_name = "K", value_parser = whole::<u8>(2, 64))]
    gali: Option<u8>,
}

/// A number of exponents.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Count {
    All,
    First(usize),
}

fn count(text: &str) -> Result<Count, String> {
    match text.parse::<usize>() {
        _ if text == "all" => Ok(Count::All),
        Ok(count @ 1..) => Ok(Count::First(count)),
        _ => Err("write a whole number from 1 on, or all".to_owned()),
    }
}

pub(super) fn execute(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    let study = Study::open(&arguments.study, interrupt, PhaseSpace::on_constraints)?;
    let until = study.until(arguments.until);
    interrupt.ends_by_itself(|| ());
    let mut bar = Bar::new(study.start.time, until);
    let method = (study.method, study.settings);
    let found = lyapunov(&study.space, method, &study.start, until, &mut |time| bar.show(time));
    let mut found = found.map_err(study::failed)?;
    let volumes = match arguments.gali {
        Some(count) if found.error.is_none() => {
            let mut report = |time| bar.show(time);
            let until = (&study.start, found.time);
            Some(
                gali(&study.space, method, until, count.into(), &mut report)
                    .map_err(study::failed)?,
            )
        }
        _ => None,
    };
    drop(bar);
    let count = match arguments.exponents {
        Count::All => found.exponents.len(),
        Count::First(count) => count.min(found.exponents.len()),
    };
    found.exponents.truncate(count);
    found.uncertainty.truncate(count);
    found.settled.truncate(count);
    let (mut object, mut text) = (object(&study, &found), text(&study, &found));
    if let Some(volumes) = volumes {
        object.insert("gali".to_owned(), series(&volumes));
        text.push_str(&lines(&volumes));
        found.error = volumes.error;
    }
    let result = (object, text);
    study::write(&arguments.study, result, found.error, interrupt)
}

/// ln GALIₖ over time by k.
fn series(volumes: &Gali) -> Value {
    let most = volumes.logarithms.first().map_or(0, |row| row.len() + 1);
    let all = (2..=most).map(|k| (k.to_string(), json!(volumes.of(k))));
    Value::Object(all.collect())
}

fn lines(volumes: &Gali) -> String {
    let Some(last) = volumes.logarithms.last() else { return String::new() };
    let all = last.iter().enumerate();
    let all = all.map(|(i, x)| format!("ln GALI{} = {}\n", i + 2, shown(*x)));
    format!("\n{}", all.collect::<String>())
}

fn removed(what: Removed) -> &'static [&'static str] {
    match what {
        Removed::Nothing => &[],
        Removed::Flow => &["flow"],
        Removed::FlowAndEnergy => &["flow", "energy"],
    }
}

fn object(study: &Study, found: &Lyapunov) -> Map<String, Value> {
    let mut object = study.head(found.settings);
    let mut insert = |name: &str, value: Value| object.insert(name.to_owned(), value);
    insert("t", json!(found.time));
    insert("exponents", json!(found.exponents));
    insert("uncertainty", json!(found.uncertainty));
    insert("settled", json!(found.settled));
    insert("trivial", json!(removed(found.removed)));
    insert("megno", json!(found.megno));
    insert("verdict", json!(found.verdict.word()));
    insert("reason", json!(found.reason));
    insert("sum", json!(found.sum));
    insert("pairing_residual", json!(found.pairing_residual));
    insert("curve", json!(found.curve));
    insert("status", json!(study::status(found.error.as_ref())));
    insert("message", json!(found.error.as_ref().map(ToString::to_string)));
    object
}

fn text(study: &Study, found: &Lyapunov) -> String {
    let mut rows = Vec::new();
    let known = found.uncertainty.iter().zip(&found.settled);
    for (i, (exponent, (off, settled))) in found.exponents.iter().zip(known).enumerate() {
        let known = match (*off == 0.0, settled) {
            (true, _) => "exact".to_owned(),
            (false, true) => format!("± {off:.1e}"),
            (false, false) => {
                format!("± {off:.1e} or more: undecided, the average has not settled")
            }
        };
        rows.push(vec![format!("λ{}", i + 1), shown(*exponent), known]);
    }
    let mut text = format!(
        "{} from t = {} to {}\n\n",
        found.verdict.word(),
        shown(study.start.time),
        shown(found.time)
    );
    text.push_str(&table(&rows));
    text.push_str(&format!("\nsum {}, MEGNO {}\n", shown(found.sum), shown(found.megno)));
    if let Some(residual) = found.pairing_residual {
        text.push_str(&format!("largest |λᵢ + λⱼ| of a pair: {residual:.1e}\n"));
    }
    if found.removed.count() > 0 {
        let names = removed(found.removed).join(" and that of the ");
        text.push_str(&format!("taken out: the direction of the {names}, with exponent 0\n"));
    }
    text.push_str(&format!("{}\n", found.reason));
    text
}
