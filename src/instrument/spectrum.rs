//! `spectrum`: the lines of one quantity of the motion, with their frequencies, named as combinations k·ω of few; and the
//! mean rate of an angle.
//!
//! The job follows the motion from its initial values at equal intervals of time, and finds the lines
//! ([`spectrum`](crate::dynamics::spectrum)).

use super::conditions::PlotConditions;
use super::{
    Across, Answer, Axis, Entry, Heading, Ink, Instrument, Layer, Level, Measure, Need, Offer,
    Physics, Picture, Plot, PlotContext, Present, Properties, Upwards,
};
use crate::dynamics::{
    FrequencyDrift, MeanRate, PhaseSpace, SampledSpectrum, SpectralLine, Spectrum as Lines,
    SpectrumRequest, independent_frequencies, sampled_spectrum,
};
use crate::ensemble::SystemFlow;
use crate::integrate::method_named;
use crate::job::{Job, Progress};
use crate::num::{math, significant, to_its_error};
use crate::system::ChannelKind;

const CURVE: Level = 0;
const LINES: Level = 2;

/// How long the motion is followed, in seconds of the wall clock at the file's own speed, and how many numbers are taken
/// first, and at most if these do not show the motion.
const SECONDS: f64 = 90.0;
const COUNTS: [usize; 2] = [2048, 32_768];

/// The most lines that are searched for, and that are listed.
const MOST: usize = 10;
const LINES_NAMED: usize = 6;

/// What is shown goes down so many powers of ten, and so much beyond the last line.
const POWERS: f64 = 9.0;
const BEYOND: f64 = 1.3;

pub(super) struct SpectrumPlot;

struct ComputedSpectrum {
    conditions: PlotConditions,
    /// The frequency of the drive, if the motion has one.
    drive: Option<f64>,
    outcome: Result<Analysis, String>,
}

impl ComputedSpectrum {
    fn has_images(&self) -> bool {
        self.outcome.as_ref().is_ok_and(|found| found.has_images)
    }
}

/// What a signal is made of.
struct Analysis {
    lines: Lines,
    /// Whether others were left out as images of faster ones.
    has_images: bool,
    rate: Option<MeanRate>,
    drift: Option<FrequencyDrift>,
}

const PROPERTIES: Properties = Properties {
    name: "spectrum",
    written: &[Axis::UPWARDS],
    measures: &[
        Measure::new("lines", "how many lines were found", |context| {
            Some(lines(context.answer)?.lines.len() as f64)
        }),
        Measure::new("frequency", "ω of the strongest line", |context| {
            Some(lines(context.answer)?.lines.first()?.frequency)
        }),
        Measure::new("amplitude", "the amplitude of the strongest line", |context| {
            Some(lines(context.answer)?.lines.first()?.amplitude)
        }),
        Measure::new(
            "fundamentals",
            "how many frequencies the lines are combinations of",
            |context| Some(lines(context.answer)?.fundamentals.len() as f64),
        ),
        Measure::new("second", "the second of those frequencies", |context| {
            lines(context.answer)?.fundamentals.get(1).copied()
        }),
        Measure::new(
            "left",
            "the part of the motion that the lines leave: large where it is chaotic",
            |context| Some(lines(context.answer)?.part_left()),
        ),
        Measure::new(
            "drift",
            "by which part the strongest ω differs between the halves of the time: large where it is chaotic",
            |context| Some(drift(context.answer)?.relative()),
        ),
        Measure::new("rate", "the mean rate of an angle", |context| {
            Some(mean(context.answer)?.rate)
        }),
    ],
    ..Properties::PLAIN
};

impl Instrument for SpectrumPlot {
    fn properties(&self) -> &'static Properties {
        &PROPERTIES
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let known = physics.named().filter(|(index, _)| *index < physics.system.columns());
        let offer = |(index, channel): (usize, &crate::system::Channel)| {
            Offer::new(
                format!("spectrum of {}", channel.shown),
                "the frequencies of the motion, and what they are combinations of",
                vec![vec![index]],
            )
        };
        known.map(offer).collect()
    }

    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String {
        format!("spectrum of {}", plot.column(0).map_or("?", |channel| physics.shown(channel)))
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let entries = vec![Entry::Words("of the motion from its initial values".to_owned())];
        Some(plot.heading(present.physics, "Spectrum", entries))
    }

    fn across(&self, PlotContext { answer, .. }: PlotContext<'_>) -> Across {
        let last = lines(answer).map_or(1.0, |found| {
            let greatest = found.lines.iter().map(|line| line.frequency).fold(0.0, f64::max);
            let known = found.curve.last().map_or(1.0, |at| at[0]);
            if greatest > 0.0 { (BEYOND * greatest).min(known) } else { known }
        });
        Across::Named("ω".to_owned(), [0.0, last])
    }

    fn awaits(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Option<String> {
        match found(answer).map(|found| &found.outcome) {
            None => {
                let name = present.physics.shown(plot.column(0)?);
                Some(format!(
                    "The frequencies ω of {name}, as lines of its spectrum. They are being computed; w finds them again."
                ))
            }
            Some(Err(why)) => Some(why.clone()),
            Some(Ok(_)) => None,
        }
    }

    fn picture(&self, context: PlotContext<'_>, _seen: [f64; 2]) -> Option<Picture> {
        let PlotContext { plot, present, answer } = context;
        let name = present.physics.shown(plot.column(0)?);
        let axes = |range, layers| {
            let upwards = Upwards::Named(format!("lg amplitude of {name}"), range);
            Some(Picture::Axes { upwards, layers, occurrences: None })
        };
        let legend = (LINES, Layer::Legend(sentences(present.physics, answer)));
        let Some(found) = lines(answer) else { return axes([-POWERS, 0.0], vec![legend]) };
        let power = |x: f64| math::ln(x.max(f64::MIN_POSITIVE)) / std::f64::consts::LN_10;
        let most = found.curve.iter().map(|at| at[1]).fold(0.0, f64::max);
        let top = power(most).max(-300.0);
        let floor = top - POWERS;
        let curve = found.curve.iter().map(|at| [at[0], power(at[1]).max(floor)]).collect();
        let line = |line: &SpectralLine| {
            // from below the lower edge of the picture
            let ends = [floor - POWERS, power(line.amplitude)].map(|y| [line.frequency, y]);
            (LINES, Layer::Line(ends.to_vec(), Ink::Curve(1).into()))
        };
        let mut layers = vec![(CURVE, Layer::Line(curve, Ink::Level.into()))];
        layers.extend(found.lines.iter().map(line));
        layers.push(legend);
        axes([floor, top + 1.0], layers)
    }

    fn job(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Need {
        let conditions = PlotConditions::of(present, &plot.seeds);
        if found(answer).is_some_and(|known| known.conditions == conditions) {
            return Need::Valid;
        }
        let Physics { model, equations, system } = present.physics;
        let (Some(channel), Some(method)) = (plot.column(0), method_named(present.method)) else {
            return Need::Nothing;
        };
        let (begin, speed, system) = (model.run.start, model.run.speed, system.clone());
        let fundamentals = independent_frequencies(model, equations, &system);
        let space =
            PhaseSpace::on_constraints((model, equations, &system), present.parameters).ok();
        let drive =
            space.and_then(|space| space.drive()).map(|period| std::f64::consts::TAU / period);
        let is_angle = matches!(system.channels()[channel].kind, ChannelKind::Position(_))
            && system.period(channel, present.parameters).is_some();
        Need::Job(Job::new("spectrum", move |progress: &Progress| {
            let flow = SystemFlow {
                system: system.with_cancel(progress.token().clone()),
                method: (method, conditions.settings),
                parameters: conditions.parameters.clone(),
                start: begin,
                effort: None,
            };
            let speed = if speed.is_finite() && speed > 0.0 { speed } else { 1.0 };
            let request = SpectrumRequest {
                span: [begin, begin + SECONDS * speed],
                counts: COUNTS,
                is_angle,
                lines: (MOST, fundamentals),
                drive,
            };
            let start = conditions.state(&system, begin).map_err(|error| error.to_string());
            let outcome = start.and_then(|start| {
                progress.expect(MOST as u64);
                let mut report = |count: usize| {
                    progress.reach(count as u64);
                    !progress.is_cancelled()
                };
                let mut sample = |times: &[f64]| {
                    let seen = flow.carry(&start, times, &[channel]).seen;
                    seen.iter().map(|row| row[0]).collect()
                };
                let sampled = sampled_spectrum(&request, &mut sample, &mut report);
                let sampled = sampled.map_err(|why| why.to_string())?;
                if sampled.is_false() {
                    return Err("it is faster than so many values can show".to_owned());
                }
                let has_images = sampled.has_images();
                let SampledSpectrum { spectrum: lines, rate, drift, .. } = sampled;
                Ok(Analysis { lines, has_images, rate, drift })
            });
            Answer::new(ComputedSpectrum { conditions: conditions.clone(), drive, outcome })
        }))
    }
}

fn found(answer: Option<&Answer>) -> Option<&ComputedSpectrum> {
    answer?.of::<ComputedSpectrum>()
}

fn lines(answer: Option<&Answer>) -> Option<&Lines> {
    found(answer)?.outcome.as_ref().ok().map(|found| &found.lines)
}

fn mean(answer: Option<&Answer>) -> Option<MeanRate> {
    found(answer)?.outcome.as_ref().ok().and_then(|found| found.rate)
}

fn drift(answer: Option<&Answer>) -> Option<FrequencyDrift> {
    found(answer)?.outcome.as_ref().ok().and_then(|found| found.drift)
}

/// What is said of the lines, or why there are none.
fn sentences(physics: Physics<'_>, answer: Option<&Answer>) -> Vec<String> {
    let lines = match found(answer).map(|found| &found.outcome) {
        None => return vec!["searching for lines".to_owned()],
        Some(Err(why)) => return vec![why.clone()],
        Some(Ok(found)) => &found.lines,
    };
    let short = |x: f64| significant(x, 9, 1e-4..1e6).replace('-', "−");
    let known = |x: f64, error: f64| to_its_error(x, error, 9, 1e-4..1e6).replace('-', "−");
    let brief = |x: f64| significant(x, 3, 1e-3..1e5).replace('-', "−");
    let unit = match physics.model.time_unit() {
        "" => String::new(),
        unit => format!(" rad/{unit}"),
    };
    let mut all: Vec<String> = lines
        .lines
        .iter()
        .take(LINES_NAMED)
        .map(|line| {
            // of what is no sum of lines no frequency is a combination of others
            let name = line.name().filter(|_| !lines.is_continuous());
            let name = name.unwrap_or_else(|| "ω".to_owned());
            let (frequency, error) =
                (known(line.frequency, line.error), significant(line.error, 1, 1.0..10.0));
            format!("{name} = {frequency} ± {error}{unit}, a = {}", brief(line.amplitude))
        })
        .collect();
    let names = lines.lines.iter().filter_map(SpectralLine::name);
    if let Some(drive) = found(answer).and_then(|found| found.drive)
        && names.take(LINES_NAMED).any(|name| name.contains('Ω'))
    {
        all.push(format!("Ω = {}{unit}, the drive", short(drive)));
    }
    // after the first line, since a small pane has no room for all
    let second = all.len().min(1);
    all.splice(
        second..second,
        drift(answer).map(|drift| {
            let [apart, error] = [drift.relative(), drift.relative_error()];
            let [apart, error] = [apart, error].map(|x| significant(x, 1, 1.0..10.0));
            format!("halves: ω differs by {apart} ± {error}")
        }),
    );
    if found(answer).is_some_and(ComputedSpectrum::has_images) {
        all.insert(second, "lines too fast for so many values are left out".to_owned());
    }
    if let Some(close) = &lines.close {
        let (at, apart) = (brief(close.frequency), brief(close.apart));
        all.insert(
            second,
            format!("two lines around {at}, {apart} apart, cannot be resolved in this time"),
        );
    } else if lines.is_continuous() && lines.turns.is_none() {
        all.insert(0, format!("not a sum of lines: they leave {:.0} %", 100.0 * lines.part_left()));
    }
    if let Some(turns) = lines.turns {
        all.push(format!("no line: nothing has returned, {} of a turn at most", brief(turns)));
    } else if lines.lines.is_empty() {
        all.push("no line stands out".to_owned());
    }
    all.extend(
        lines.change_of_mean().map(|change| format!("the mean changes by {}", brief(change))),
    );
    let advances = mean(answer).filter(|rate| rate.rate.abs() > rate.error);
    all.extend(advances.map(|rate| {
        let error = significant(rate.error, 1, 1.0..10.0);
        format!("mean rate {} ± {error}{unit}", known(rate.rate, rate.error))
    }));
    all
}
