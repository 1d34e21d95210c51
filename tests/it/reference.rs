//! States known to 30 digits, held against the whole way from a file to an experiment.
//!
//! Each `tests/reference/NAME.toml` is a system; `NAME.expected.toml` beside it holds what is known
//! at given times, the typical size of each (`scale`), and by how much the motion magnifies
//! a relative error of its beginning (`condition`). Known are q, q̇ and p, the multipliers
//! (`lambda`, in the order of the constraints), and of a Poisson system its variables (`x`).

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use phaselab::experiment::{Experiment, Progress, Setup, Status};
use phaselab::mechanics;
use phaselab::preset::Document;
use phaselab::system::{ChannelKind, System};

use serde::Deserialize;

/// What is known of a motion.
#[derive(Deserialize)]
struct Expected {
    condition: f64,
    scale: BTreeMap<Kind, Vec<f64>>,
    reference: Vec<Known>,
}

/// A row: what is known of each kind at a time.
#[derive(Deserialize)]
struct Known {
    at: f64,
    #[serde(flatten)]
    values: BTreeMap<Kind, Vec<String>>,
}

/// A kind of values in a row; an unknown one is refused.
#[derive(Deserialize, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
#[serde(rename_all = "snake_case")]
enum Kind {
    Q,
    V,
    P,
    Lambda,
    X,
}

impl Kind {
    /// The channel that shows the value of this place in the list.
    fn channel(self, place: usize) -> ChannelKind {
        match self {
            Kind::Q | Kind::X => ChannelKind::Position(place),
            Kind::V => ChannelKind::Velocity(place),
            Kind::P => ChannelKind::Momentum(place),
            Kind::Lambda => ChannelKind::Multiplier(place),
        }
    }
}

/// The worst of a system: its error in units of the rounding of the sizes, and where.
struct Worst {
    name: String,
    error: f64,
    condition: f64,
    place: String,
}

/// The error allowed, in units in the last place of the size: rounding a result, and a little of
/// what rounding the beginning would make.
fn allowed(condition: f64) -> f64 {
    2.0 + 0.1 * condition
}

/// The systems, by name.
fn systems() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference");
    let files = std::fs::read_dir(folder).expect("the folder of references");
    let mut files: Vec<PathBuf> = files.map(|file| file.expect("a file").path()).collect();
    files.retain(|file| file.with_extension("expected.toml").exists());
    files.sort();
    files
}

fn experiment(file: &Path) -> Result<Experiment, String> {
    let document = Document::open(file).map_err(|why| why.to_string())?;
    let read = document.read();
    let model = read.map_err(|mistakes| document.report(&mistakes, false))?.model;
    let equations = mechanics::derive(&model).map_err(|why| why.to_string())?;
    let system = System::compile(&model, &equations, &[]).map_err(|why| why.to_string())?;
    let (model, equations) = (Arc::new(model), Arc::new(equations));
    let setup = Setup { speed: f64::INFINITY, ..Setup::of(&model) };
    Experiment::new(&model, &equations, &system, setup).map_err(|why| why.to_string())
}

/// The present value of a channel, and its name.
fn find(experiment: &Experiment, kind: ChannelKind) -> Result<(f64, &str), String> {
    let mut channels = experiment.system().channels().iter().zip(experiment.values());
    let found = channels.find(|(channel, _)| channel.kind == kind);
    let (channel, &value) = found.ok_or_else(|| format!("no {kind:?}"))?;
    Ok((value, &channel.name))
}

/// The worst error of a system's motion.
fn worst(file: &Path) -> Result<Worst, String> {
    let name = file.file_stem().expect("a file has a name").to_string_lossy().into_owned();
    let text = std::fs::read_to_string(file.with_extension("expected.toml"));
    let text = text.map_err(|why| why.to_string())?;
    let expected: Expected = toml::from_str(&text).map_err(|why| why.to_string())?;
    let mut experiment = experiment(file)?;
    let mut worst = Worst { name, error: 0.0, condition: expected.condition, place: String::new() };
    for known in &expected.reference {
        while experiment.advance(known.at, 1_000_000) == Progress::Underway {}
        if let Status::Faulted(fault) = experiment.status() {
            return Err(fault.message);
        }
        for (&kind, digits) in &known.values {
            let sizes = expected.scale.get(&kind).ok_or(format!("no scale of {kind:?}"))?;
            if sizes.len() != digits.len() {
                return Err(format!("{kind:?}: {} values, {} sizes", digits.len(), sizes.len()));
            }
            for (place, (digits, size)) in digits.iter().zip(sizes).enumerate() {
                let (value, shown) = find(&experiment, kind.channel(place))?;
                let truth: f64 = digits.parse().map_err(|_| format!("{digits} is not a number"))?;
                let error = (value - truth).abs() / (size * f64::EPSILON);
                // written so that an error that is not a number is the worst of all
                if error.is_nan() || error > worst.error {
                    worst.error = if error.is_nan() { f64::INFINITY } else { error };
                    worst.place = format!("{shown} at t = {}", known.at);
                }
            }
        }
    }
    Ok(worst)
}

#[test]
fn every_motion_is_right_to_the_last_digits() {
    let files = systems();
    assert!(files.len() >= 100, "{} systems", files.len());
    let mut table = String::new();
    let mut failures = 0;
    let mut results: Vec<Result<Worst, String>> = files.iter().map(|f| worst(f)).collect();
    results.sort_by_key(|result| match result {
        Ok(worst) => (worst.error / allowed(worst.condition) * -1e6) as i64,
        Err(_) => i64::MIN,
    });
    for result in results {
        let line = match &result {
            Err(why) => format!("    cannot  {why}"),
            Ok(Worst { name, error, condition, place }) => {
                let allowed = allowed(*condition);
                format!(
                    "{error:10.3} of {allowed:10.3}  {name}, {place} (condition {condition:.1})"
                )
            }
        };
        let right = result.is_ok_and(|worst| worst.error <= allowed(worst.condition));
        failures += usize::from(!right);
        let mark = if right { ' ' } else { '!' };
        writeln!(table, "{mark} {line}").expect("a string takes all");
    }
    assert_eq!(failures, 0, "errors in units of the last place of the sizes\n{table}");
}
