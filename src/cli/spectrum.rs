//! `phaselab spectrum`: the frequencies of a motion.

use serde_json::{Map, Value, json};

use super::assignment::{number, whole};
use super::error::CommandError;
use super::interrupt::Interrupt;
use super::motion_options::CompiledMotion;
use super::slow_notice::with_notice;
use super::study::{self, StudyArguments, shown, table};
use crate::dynamics::{
    FrequencyDrift, MeanRate, NoSpectrum, PhaseSpace, SampledSpectrum, SpectralLine,
    SpectrumRequest, independent_frequencies, sampled_spectrum,
};
use crate::ensemble::SystemFlow;
use crate::num::{significant, to_its_error};
use crate::system::ChannelKind;

/// The numbers taken first where none are asked for, and at most if these do not show the motion, and how long the motion is followed then, in seconds of the lab's clock at
/// the file's own speed.
const COUNTS: [usize; 2] = [2048, 65_536];
const SECONDS: f64 = 90.0;

/// The column of an expression, which may already be one of the file.
const COLUMN: &str = "quantity";

/// Find the frequencies of a motion.
///
/// The lines of a quantity, the strongest first: found one after the other under a window, polished together,
/// and named as combinations k·ω of as few fundamental frequencies as the system has. The quantity is taken at
/// equal intervals from the start; from an angle that advances, its mean advance is subtracted, and its mean rate
/// (over 2π, the rotation number per unit of time) is given by a weighted average that converges fast. The drift of the
/// strongest frequency, between the halves of the time, measures chaos.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab spectrum pendulum
  phaselab spectrum henon-heiles --of x --until 2000 --count 4096
  phaselab spectrum toda-three --of q1 --lines 6 --format json")]
pub(super) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// The quantity: a coordinate, an observable, any expression; by default the first coordinate.
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true)]
    of: Option<String>,
    /// When to end; by default as the file says, but not before 90 seconds of the lab at the file's own speed.
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = number)]
    until: Option<f64>,
    /// How many samples are taken, at equal intervals; by default 2048, or as many more as the motion needs.
    #[arg(long, allow_hyphen_values = true, value_name = "N", value_parser = whole::<u32>(64, 65_536))]
    count: Option<u32>,
    /// How many lines to search for.
    #[arg(long, allow_hyphen_values = true, value_name = "N", default_value_t = 10, value_parser = whole::<u32>(1, 64))]
    lines: u32,
}

struct FoundSpectrum {
    of: String,
    from: f64,
    until: f64,
    sampled: SampledSpectrum,
    /// The frequency of the drive, if the motion has one.
    drive: Option<f64>,
}

pub(super) fn execute(arguments: &Arguments, interrupt: &Interrupt) -> Result<(), CommandError> {
    let motion = &arguments.study.motion;
    let reading = motion.read()?;
    let (kind, column) = match arguments.of.as_deref().map(str::trim) {
        None => (ChannelKind::Position(0), None),
        Some(of) => match reading.model.coordinates.iter().position(|c| c.name == of) {
            Some(i) => (ChannelKind::Position(i), None),
            None => (ChannelKind::Extra(0), Some(format!("{COLUMN}={of}"))),
        },
    };
    let compiled = motion.compile(reading, column.as_slice(), "--of", interrupt)?;
    let CompiledMotion { model, equations, system, start, method, settings } = &compiled;
    let channel = system.channels().iter().position(|channel| channel.kind == kind);
    let channel =
        channel.ok_or_else(|| CommandError::CouldNot("there is no such quantity".to_owned()))?;
    let speed = Some(model.run.speed).filter(|s| s.is_finite() && *s > 0.0).unwrap_or(1.0);
    let least = start.time + SECONDS * speed;
    let until = arguments.until.or(model.run.until.filter(|&until| until > least)).unwrap_or(least);
    if until <= start.time {
        let why = format!("--until: it must be after the start, t = {:?}", start.time);
        return Err(CommandError::WrongUse(why));
    }
    interrupt.ends_by_itself(|| ());
    let state = start.state(system).map_err(|error| CommandError::CouldNot(error.to_string()))?;
    let flow = SystemFlow {
        system: system.clone(),
        method: (*method, *settings),
        parameters: start.parameters.clone(),
        start: start.time,
        effort: None,
    };
    let is_angle = system.period(channel, &start.parameters).is_some()
        && matches!(system.channels()[channel].kind, ChannelKind::Position(_));
    let space = PhaseSpace::on_constraints((model, equations, system), &start.parameters).ok();
    let drive = space.and_then(|space| space.drive()).map(|period| std::f64::consts::TAU / period);
    let fundamentals = independent_frequencies(model, equations, system);
    let asked = arguments.count.map(|count| [count as usize; 2]);
    let request = SpectrumRequest {
        span: [start.time, until],
        counts: asked.unwrap_or(COUNTS),
        is_angle,
        lines: (arguments.lines as usize, fundamentals),
        drive,
    };
    let mut sample = |times: &[f64]| {
        let carry = || flow.carry(&state, times, &[channel]).seen;
        let seen = with_notice("following the motion", carry);
        seen.iter().map(|row| row[0]).collect()
    };
    let sampled = sampled_spectrum(&request, &mut sample, &mut |_| true).map_err(|why| {
        CommandError::CouldNot(match why {
            NoSpectrum::Ends(time) => {
                let time = significant(time, 6, 1e-4..1e6);
                format!("the motion ends before t = {time}: choose an earlier --until")
            }
            NoSpectrum::NotFinite => "the quantity has no finite values".to_owned(),
        })
    })?;
    if sampled.is_false() {
        return Err(CommandError::CouldNot(too_few(sampled.count, asked.is_some())));
    }
    let of = arguments.of.clone().unwrap_or_else(|| system.channels()[channel].name.clone());
    let found = FoundSpectrum { of, from: start.time, until, sampled, drive };
    let mut head = study::head(model, system, &start.parameters, (*method, *settings));
    head.append(&mut object(&found));
    study::write(&arguments.study, (head, text(&found)), None, interrupt)
}

/// The error where the values do not show the motion.
fn too_few(count: usize, is_asked: bool) -> String {
    let help = if is_asked { "take more with --count" } else { "choose an earlier --until" };
    format!(
        "{count} values are too few: the quantity oscillates faster than they are taken, and none of the lines found belongs to it; {help}"
    )
}

fn object(found: &FoundSpectrum) -> Map<String, Value> {
    let FoundSpectrum { of, from, until, sampled, drive } = found;
    let SampledSpectrum { count, spectrum, rate, drift, between, .. } = sampled;
    let line = |line: &SpectralLine| {
        json!({
            "frequency": line.frequency,
            "error": line.error,
            "amplitude": line.amplitude,
            "phase": line.phase,
            "combination": line.combination,
            "drive_multiple": line.drive,
        })
    };
    let mut object = Map::new();
    let mut insert = |name: &str, value: Value| object.insert(name.to_owned(), value);
    insert("of", json!(of));
    insert("from", json!(from));
    insert("until", json!(until));
    insert("count", json!(count));
    insert("mean", json!(spectrum.mean));
    insert("change_of_mean", json!(spectrum.change_of_mean()));
    insert("lines", spectrum.lines.iter().map(line).collect());
    insert("fundamentals", json!(spectrum.fundamentals));
    insert("drive", json!(drive));
    let close = spectrum.close.as_ref().map(|close| json!({ "frequency": close.frequency, "apart": close.apart, "parted_at": from + close.time_to_part() }));
    insert("close_lines", json!(close));
    insert("left", json!(spectrum.left));
    insert("left_between", json!(between));
    insert("images", sampled.images.iter().map(|image| image.frequency).collect());
    insert("resolved", json!(sampled.is_resolved()));
    insert("turns", json!(spectrum.turns));
    let halves = |d: &FrequencyDrift| json!({ "first": d.first, "second": d.second, "relative": d.relative(), "error": d.relative_error() });
    insert("frequency_drift", drift.as_ref().map_or(Value::Null, halves));
    insert("mean_rate", rate.map_or(Value::Null, |r| json!({ "rate": r.rate, "error": r.error })));
    object
}

fn text(found: &FoundSpectrum) -> String {
    let FoundSpectrum { of, from, until, sampled, drive } = found;
    let SampledSpectrum { count, spectrum, rate, drift, between, .. } = sampled;
    let mut text = format!("{of} from t = {from:?} to {until:?}, {count} values\n\n");
    let head = ["", "ω", "", "amplitude", "phase"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for line in &spectrum.lines {
        rows.push(vec![
            line.name().filter(|_| !spectrum.is_continuous()).unwrap_or_else(|| "?".to_owned()),
            to_its_error(line.frequency, line.error, 12, 1e-4..1e6),
            format!("± {:.0e}", line.error),
            shown(line.amplitude),
            shown(line.phase),
        ]);
    }
    if let Some(turns) = spectrum.turns {
        text.push_str(&format!(
            "no line: the strongest would make {turns:.2} of a turn in this time; nothing has come back yet, as where a \
             motion escapes\n"
        ));
    } else if spectrum.lines.is_empty() {
        text.push_str("no line stands out\n");
    } else {
        text.push_str(&table(&rows));
    }
    let all = if sampled.has_images() { "lines and the images" } else { "lines" };
    text.push_str(&format!(
        "\nmean {}, what the {all} leave {:.1e}\n",
        shown(spectrum.mean),
        spectrum.left
    ));
    if !sampled.is_resolved() {
        let images = match &sampled.images[..] {
            [] => "and fainter lines may be their images".to_owned(),
            [one] => format!("whose image at ω = {} is left out", shown(one.frequency)),
            several => {
                let all: Vec<String> = several.iter().map(|image| shown(image.frequency)).collect();
                format!("whose images at ω = {} are left out", all.join(", "))
            }
        };
        text.push_str(&format!(
            "between the values they leave {between:.1e}: there are lines too fast for so few values, {images}; take more with --count\n"
        ));
    }
    if let Some(close) = &spectrum.close {
        text.push_str(&format!(
            "around ω = {} two lines lie {} apart, too close to be resolved in this time: a run until after t = {} would resolve \
             them\n",
            significant(close.frequency, 6, 1e-4..1e6),
            significant(close.apart, 2, 1e-4..1e6),
            significant(from + close.time_to_part(), 3, 1e-4..1e6)
        ));
    }
    if let Some(change) = spectrum.change_of_mean() {
        text.push_str(&format!(
            "the mean changes by {} in this time: a slow change is fitted beside the lines\n",
            shown(change)
        ));
    }
    if spectrum.is_continuous() && spectrum.turns.is_none() && spectrum.close.is_none() {
        let part = 100.0 * spectrum.part_left();
        text.push_str(&format!("that is {part:.0} % of it: it is not a sum of a few lines\n"));
    }
    if let Some(drift) = drift {
        text.push_str(&format!(
            "the strongest ω changes by a fraction of {:.0e} ± {:.0e} from the first half of the time to the second\n",
            drift.relative(),
            drift.relative_error()
        ));
    }
    if let Some(drive) = drive {
        text.push_str(&format!("Ω of the drive {}\n", significant(*drive, 12, 1e-4..1e6)));
    }
    if let Some(MeanRate { rate, error }) = rate {
        let rate = to_its_error(*rate, *error, 12, 1e-4..1e6);
        text.push_str(&format!("mean rate {rate} ± {error:.0e}\n"));
    }
    text
}
