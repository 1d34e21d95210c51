//! States known to 30 digits, compared with the whole path from a file to an experiment.
//!
//! Each `tests/reference/NAME.toml` is a system; `NAME.expected.toml` beside it contains the known values
//! at given times, the typical size of each (`scale`), and the factor by which the motion magnifies
//! a relative error of its start (`condition`). The values are q, q̇ and p, the multipliers
//! (`lambda`, in the order of the constraints), and for a Poisson system its variables (`x`);
//! with `[comparison]` those of the wrong mechanics (`other_q`, `other_v`); with `[attitude]` its matrix (`A`).
//! `body` is the rigid body composed of the pieces; `bracket` has values at the start;
//! `events` are all occurrences up to the last row, and `status` is how the motion ends.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use phaselab::diagnostic::Document;
use phaselab::experiment::{AdvanceOutcome, Experiment, Setup, Status};
use phaselab::expr::Pool;
use phaselab::integrate::{Occurrence, OccurrenceKind as occurrence};
use phaselab::mechanics;
use phaselab::model::{Coordinate, Model, WrittenExpr};
use phaselab::system::{ChannelKind, System};

use serde::Deserialize;

/// The known values of a motion.
#[derive(Deserialize)]
struct Expected {
    condition: f64,
    status: Option<String>,
    events: Option<Vec<Happened>>,
    scale: BTreeMap<OccurrenceKind, Vec<f64>>,
    reference: Vec<Known>,
    #[serde(default)]
    bracket: Vec<Bracket>,
    body: Option<Body>,
}

/// A body composed of pieces, about its centre of mass.
#[derive(Deserialize)]
struct Body {
    mass: String,
    centre_of_mass: Vec<String>,
    inertia: Vec<Vec<String>>,
    principal_moments: Vec<String>,
}

/// The Poisson bracket of two expressions, and its value at the start.
#[derive(Deserialize)]
struct Bracket {
    f: String,
    g: String,
    value: String,
}

/// A row: the known values of each kind at a time.
#[derive(Deserialize)]
struct Known {
    at: f64,
    #[serde(flatten)]
    values: BTreeMap<OccurrenceKind, Vec<String>>,
}

/// An occurrence; for an impulse, its jumps of the momenta and the reactions of the constraints.
#[derive(Deserialize)]
struct Happened {
    name: String,
    t: String,
    #[serde(default)]
    jump: BTreeMap<String, String>,
    #[serde(default)]
    reaction: BTreeMap<String, String>,
}

/// A kind of values in a row; an unknown one is refused.
#[derive(Deserialize, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
#[serde(rename_all = "snake_case")]
enum OccurrenceKind {
    Q,
    V,
    P,
    Lambda,
    X,
    OtherQ,
    OtherV,
    #[serde(rename = "A")]
    Attitude,
}

impl OccurrenceKind {
    /// The channel of the value at this position in the list.
    fn channel(self, place: usize, degrees: usize) -> ChannelKind {
        let place = if self == OccurrenceKind::OtherV { place + degrees } else { place };
        match self {
            OccurrenceKind::Q | OccurrenceKind::X => ChannelKind::Position(place),
            OccurrenceKind::V => ChannelKind::Velocity(place),
            OccurrenceKind::P => ChannelKind::Momentum(place),
            OccurrenceKind::Lambda => ChannelKind::Multiplier(place),
            OccurrenceKind::OtherQ | OccurrenceKind::OtherV => ChannelKind::Extra(place),
            OccurrenceKind::Attitude => ChannelKind::Attitude(place),
        }
    }
}

/// The worst error of a system, in units of the rounding of the sizes, and its origin.
struct Worst {
    name: String,
    error: f64,
    condition: f64,
    place: String,
}

impl Worst {
    /// Compares a value with its digits, relative to `size`.
    fn look(
        &mut self,
        value: f64,
        digits: &str,
        size: f64,
        place: impl Fn() -> String,
    ) -> Result<(), String> {
        let truth: f64 = digits.parse().map_err(|_| format!("{digits} is not a number"))?;
        let error = (value - truth).abs() / (size * f64::EPSILON);
        // the negation makes NaN the worst error of all
        if error.is_nan() || error > self.error {
            self.error = if error.is_nan() { f64::INFINITY } else { error };
            self.place = place();
        }
        Ok(())
    }
}

/// The error allowed, in units in the last place of the size: the rounding of a result, and a small multiple
/// of the effect of rounding the start.
fn allowed(condition: f64) -> f64 {
    2.0 + 0.1 * condition
}

/// The files of the systems, sorted by name.
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
    let model = read.map_err(|diagnostics| document.report(&diagnostics, false))?.model;
    let mut equations = mechanics::derive(&model).map_err(|why| why.to_string())?;
    let others = others(&model, &mut equations.pool);
    let system = System::compile(&model, &equations, &others).map_err(|why| why.to_string())?;
    let (model, equations) = (Arc::new(model), Arc::new(equations));
    let setup = Setup { speed: f64::INFINITY, ..Setup::of(&model) };
    Experiment::new(&model, &equations, &system, setup).map_err(|why| why.to_string())
}

/// Compares what happened with what is known; times have their own scale, jumps are relative to the sizes
/// of the quantities that jump, and reactions to the largest of them.
fn occurrences(
    experiment: &mut Experiment,
    expected: &Expected,
    events: &[Happened],
    worst: &mut Worst,
) -> Result<(), String> {
    if expected.status.as_deref() == Some("stopped") {
        while experiment.advance(1e3 * (1.0 + experiment.time()), 1_000_000)
            == AdvanceOutcome::Underway
        {}
        if !matches!(experiment.status(), Status::Ended(_)) {
            return Err("it is not stopped".into());
        }
    }
    let model = Arc::clone(experiment.model());
    let mut found: Vec<Occurrence> = experiment.occurrences().iter().cloned().collect();
    if found.len() != events.len() {
        let names: Vec<String> = found.iter().map(|h| format!("{} {}", h.name, h.time)).collect();
        return Err(format!("{} events, not {}: {names:?}", found.len(), events.len()));
    }
    let of_digits = |digits: &String| digits.parse::<f64>().map_or(0.0, f64::abs);
    let largest =
        events.iter().flat_map(|e| e.reaction.values()).map(of_digits).fold(0.0, f64::max);
    let (kind, prefix) =
        if model.is_poisson() { (OccurrenceKind::X, "") } else { (OccurrenceKind::P, "p_") };
    for (known, found) in events.iter().zip(&mut found) {
        let Occurrence { name, time, kind: what, .. } = found;
        if *name != known.name {
            return Err(format!("{name} at {time} in place of {} at {}", known.name, known.t));
        }
        let time = *time;
        worst.look(time, &known.t, of_digits(&known.t), || format!("time of {name}, {time}"))?;
        let (jumps, reactions) = match what {
            occurrence::Impulse { jump, reaction } => (jump.as_slice(), reaction.as_slice()),
            _ => (&[][..], &[][..]),
        };
        if jumps.len() != known.jump.len() || reactions.len() != known.reaction.len() {
            return Err(format!("{name} has {} jumps, {} reactions", jumps.len(), reactions.len()));
        }
        for (i, (&jump, c)) in jumps.iter().zip(&model.coordinates).enumerate() {
            let key = format!("{prefix}{}", c.name);
            let digits = known.jump.get(&key).ok_or_else(|| format!("no jump of {key}"))?;
            let size = expected.scale[&kind][i];
            worst.look(jump, digits, size, || format!("jump of {key} at {time}"))?;
        }
        for (&reaction, constraint) in reactions.iter().zip(&model.constraints) {
            let key = &model.pool.symbol_info(constraint.multiplier).name;
            let digits = known.reaction.get(key).ok_or_else(|| format!("no {key}"))?;
            worst.look(reaction, digits, largest, || format!("reaction {key} at {time}"))?;
        }
    }
    Ok(())
}

/// The current value of a channel, and its name.
fn find(experiment: &Experiment, kind: ChannelKind) -> Result<(f64, &str), String> {
    let mut channels = experiment.system().channels().iter().zip(experiment.values());
    let found = channels.find(|(channel, _)| channel.kind == kind);
    let (channel, &value) = found.ok_or_else(|| format!("no {kind:?}"))?;
    Ok((value, &channel.name))
}

/// The coordinates and velocities of the wrong mechanics, if the file asks for them.
fn others(model: &Model, pool: &mut Pool) -> Vec<WrittenExpr> {
    if model.comparison.is_none() {
        return Vec::new();
    }
    let mut channel = |c: &Coordinate, prime: &str| {
        let written = format!("other_{}{prime}", c.name);
        WrittenExpr { expression: pool.named(&written), written }
    };
    let positions: Vec<WrittenExpr> = model.coordinates.iter().map(|c| channel(c, "")).collect();
    let velocities = model.coordinates.iter().map(|c| channel(c, "'"));
    positions.into_iter().chain(velocities).collect()
}

/// The worst error of a system's motion.
fn worst(file: &Path) -> Result<Worst, String> {
    let name = file.file_stem().expect("a file has a name").to_string_lossy().into_owned();
    let text = std::fs::read_to_string(file.with_extension("expected.toml"));
    let text = text.map_err(|why| why.to_string())?;
    let expected: Expected = toml::from_str(&text).map_err(|why| why.to_string())?;
    let mut experiment = experiment(file)?;
    let mut worst = Worst { name, error: 0.0, condition: expected.condition, place: String::new() };
    let degrees = experiment.model().coordinates.len();
    for known in &expected.reference {
        while experiment.advance(known.at, 1_000_000) == AdvanceOutcome::Underway {}
        if let Status::Failed(error) = experiment.status() {
            return Err(error.message);
        }
        if experiment.time() != known.at {
            return Err(format!("it ended at {}", experiment.time()));
        }
        for (&kind, digits) in &known.values {
            let sizes = expected.scale.get(&kind).ok_or(format!("no scale of {kind:?}"))?;
            if sizes.len() != digits.len() {
                return Err(format!("{kind:?}: {} values, {} sizes", digits.len(), sizes.len()));
            }
            for (place, (digits, &size)) in digits.iter().zip(sizes).enumerate() {
                let (value, shown) = find(&experiment, kind.channel(place, degrees))?;
                worst.look(value, digits, size, || format!("{shown} at t = {}", known.at))?;
            }
        }
    }
    if let Some(events) = &expected.events {
        occurrences(&mut experiment, &expected, events, &mut worst)?;
    }
    Ok(worst)
}

#[test]
fn every_bracket_has_its_value_at_the_start() {
    let mut count = 0;
    for file in systems() {
        let text = std::fs::read_to_string(file.with_extension("expected.toml"));
        let expected: Expected = toml::from_str(&text.expect("a file")).expect("what is known");
        for Bracket { f, g, value } in expected.bracket {
            let output = std::process::Command::new(env!("CARGO_BIN_EXE_phaselab"))
                .args(["bracket", &file.to_string_lossy(), &f, &g, "--format", "json"])
                .output()
                .expect("it runs");
            let answer: serde_json::Value =
                serde_json::from_slice(&output.stdout).expect("an object");
            let found = answer["value"].as_f64().expect("a number");
            let truth: f64 = value.parse().expect("a number");
            // terms of size 1 that cancel leave a few roundings
            let within = 4.0 * f64::EPSILON * truth.abs().max(1.0);
            assert!(
                (found - truth).abs() <= within,
                "[{f}, {g}] of {file:?}: {found}, not {truth}"
            );
            count += 1;
        }
    }
    assert!(count >= 25, "{count} brackets");
}

#[test]
fn every_body_has_its_inertia() {
    let mut count = 0;
    for file in systems() {
        let text = std::fs::read_to_string(file.with_extension("expected.toml"));
        let expected: Expected = toml::from_str(&text.expect("a file")).expect("what is known");
        let Some(body) = expected.body else { continue };
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_phaselab"))
            .args(["derive", &file.to_string_lossy(), "--format", "json"])
            .output()
            .expect("it runs");
        let answer: serde_json::Value = serde_json::from_slice(&output.stdout).expect("an object");
        let found = &answer["body"];
        let number = |digits: &String| digits.parse::<f64>().expect("a number");
        // each relative to the size of its own kind: the mass, the farthest position, the largest moment
        let hold = |what: &str, found: &serde_json::Value, digits: &[String], size: f64| {
            let found = found.as_array().expect("a list");
            assert_eq!(found.len(), digits.len(), "{what} of {file:?}");
            for (found, digits) in found.iter().zip(digits) {
                let error = (found.as_f64().expect("a number") - number(digits)).abs();
                assert!(error <= 2.0 * f64::EPSILON * size, "{what} of {file:?}: off {error:e}");
            }
        };
        let largest = body.principal_moments.iter().map(number).fold(0.0, f64::max);
        let centre = &body.centre_of_mass;
        let far = centre.iter().map(|x| number(x).abs()).fold(0.0, f64::max);
        let reach = far.max((largest / number(&body.mass)).sqrt());
        hold(
            "mass",
            &serde_json::json!([found["mass"]]),
            std::slice::from_ref(&body.mass),
            number(&body.mass),
        );
        hold("centre", &found["centre_of_mass"], centre, reach);
        for (i, row) in body.inertia.iter().enumerate() {
            hold("inertia", &found["inertia"][i], row, largest);
        }
        hold("moments", &found["principal_moments"], &body.principal_moments, largest);
        count += 1;
    }
    assert!(count >= 16, "{count} bodies");
}

#[test]
fn every_motion_is_right_to_the_last_digits() {
    let files = systems();
    assert!(files.len() >= 100, "{} systems", files.len());
    let mut table = String::new();
    let mut errors = 0;
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
        errors += usize::from(!right);
        let mark = if right { ' ' } else { '!' };
        writeln!(table, "{mark} {line}").expect("a string takes all");
    }
    assert_eq!(errors, 0, "errors in units of the last place of the sizes\n{table}");
}
