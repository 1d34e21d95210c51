//! `section`: where orbits cross a surface, or the instants of a stroboscope.
//!
//! The crossings of the running motion are its own, located while it is computed. Its job computes many other orbits of
//! the same energy, their starts spread over what the energy allows, and the boundary of that region; it is done in
//! parts, so that the picture fills while it is seen, and begun again when a parameter, the method or the energy changes.

mod measures;
mod periodic;
mod portrait;
mod regularity;
mod surface;

use std::sync::Arc;

use super::equilibria::{lies_on, marks, value_at};
use super::{
    Across, Answer, Axis, Entry, Heading, Ink, Instrument, Layer, Level, MarkerShape, Need,
    NoStart, Offer, Physics, Picture, Plot, PlotContext, PlotTable, Present, Properties, Seed,
    StartValues, Upwards,
};
use crate::ensemble::{NotInPlane, PhaseShift, SectionPlan, SectionPlane, Start};
use crate::expr::Expr;
use crate::integrate::method_named;
use crate::job::Job;
use crate::mechanics::Valuation;
use crate::model::View;
use crate::system::InitialOverride;
use measures::MEASURES;
use portrait::{
    COUNT, DrawnOrbit, IDLE, Portrait, SectionConditions, SectionTask, StartedPortrait, TRANSIENT,
};
use regularity::{by_chaos, chaos_ink, newest_rotation, own_rotation, to_its_error};
pub(super) use surface::zero;
use surface::{crossing, surface, view};

const BOUNDARY: Level = 0;
const ORBITS: Level = 1;
const OWN: Level = 2;
const NOW: Level = 3;

/// The colours of regular orbits, in turn: none of the running motion's, and none that is like that of chaotic ones.
const SINGLE: [usize; 5] = [2, 3, 4, 5, 6];

pub(super) struct SectionPlot;

const PROPERTIES: Properties = Properties {
    name: "section",
    written: &[Axis::ACROSS, Axis::UPWARDS],
    is_section: true,
    takes_seeds: true,
    shows_a_view: true,
    classifies_orbits: true,
    has_equal_axes: true,
    measures: &MEASURES,
    ..Properties::PLAIN
};

impl Instrument for SectionPlot {
    fn properties(&self) -> &'static Properties {
        &PROPERTIES
    }

    fn offers(&self, physics: Physics<'_>) -> Vec<Offer> {
        let views = physics.model.views.iter().enumerate();
        let offer = |(index, view): (usize, &View)| {
            view.section?;
            Some(Offer {
                label: format!("section at {}", surface(physics, view)),
                about: "where orbits cross a surface, two quantities of your choice".to_owned(),
                columns: Vec::new(),
                view: Some(index),
                over: Vec::new(),
            })
        };
        views.filter_map(offer).collect()
    }

    fn words(&self, plot: &Plot, physics: Physics<'_>) -> String {
        let on = view(plot, physics).map_or_else(String::new, |view| surface(physics, view));
        format!("section at {on}, {}", plot.against(physics))
    }

    fn heading(&self, plot: &Plot, present: &Present<'_>) -> Option<Heading> {
        let view = view(plot, present.physics)?;
        let section = view.section?;
        let own = own_rotation(plot, present, section);
        let rotation = own.map(|own| format!("rotation {}", to_its_error(own.number, own.error)));
        let (words, zero) = (surface(present.physics, view), zero(present.physics, view));
        // the title may say it
        let titled = plot.title(present.physics).is_some_and(|title| title.contains(&zero));
        let on = if titled { words.split(", ").nth(1) } else { Some(words.as_str()) };
        let is_portrait = present.physics.equations.energy_rate == Expr::ZERO && !by_chaos(plot);
        let coloured = is_portrait.then(|| "regular orbits in several colours".to_owned());
        let on = on.map(str::to_owned);
        // where there is little room the first are shown
        let entries = rotation.into_iter().chain(on).chain(coloured);
        let mut entries: Vec<Entry> = entries.map(Entry::Words).collect();
        if by_chaos(plot) {
            let keys = [(Some(true), "regular"), (Some(false), "chaotic"), (None, "undecided")];
            let key =
                |(regular, words): (_, &str)| Entry::Key(chaos_ink(regular), words.to_owned());
            entries.splice(0..0, keys.map(key));
        } else if !dissipates(present.physics) {
            entries.push(Entry::Key(chaos_ink(Some(false)), "chaotic".to_owned()));
        }
        Some(plot.heading(present.physics, "Section", entries))
    }

    /// The points of the running motion and those of the orbits beside it.
    fn counted(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Option<Entry> {
        let view = view(plot, present.physics)?;
        let own = present.crossings.counts().get(view.section?).copied().unwrap_or(0);
        let count = own as usize + Portrait::of(answer).map_or(0, Portrait::crossings);
        let word = crossing(present.physics, view);
        let plural = if count == 1 { "" } else { "s" };
        Some(Entry::Words(format!("{count} {word}{plural}")))
    }

    fn across(&self, context: PlotContext<'_>) -> Across {
        context.plot.across(range(context, 0))
    }

    fn awaits(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Option<String> {
        let view = view(plot, present.physics)?;
        let own = present.crossings.counts().get(view.section?).copied().unwrap_or(0);
        let orbits = Portrait::of(answer).is_some_and(|portrait| portrait.crossings() > 0);
        if own > 0 || orbits || !present.separations.is_empty() || !present.equilibria.is_empty() {
            return None;
        }
        let begin = present.how_to_begin();
        let (on, of) = (surface(present.physics, view), crossing(present.physics, view));
        Some(format!(
            "A dot for each {of} ({on}); none so far.{begin} n adds orbits, G fills the section with them."
        ))
    }

    fn picture(&self, context: PlotContext<'_>, _seen: [f64; 2]) -> Option<Picture> {
        let PlotContext { plot, present, answer } = context;
        let channels = [plot.column(0)?, plot.column(1)?];
        let section = view(plot, present.physics)?.section?;
        let mut layers = Vec::new();
        if let Some(portrait) = Portrait::of(answer) {
            let line = |pair: &[[f64; 2]; 2]| Layer::Line(pair.to_vec(), Ink::Separatrix.into());
            layers.extend(portrait.region.boundary.iter().map(|pair| (BOUNDARY, line(pair))));
            // orbits on an attractor show one thing
            let dissipates = dissipates(present.physics);
            let by_chaos = by_chaos(plot);
            let points = |(index, orbit): (usize, &DrawnOrbit)| {
                let ink = match orbit.regular() {
                    regular if by_chaos => chaos_ink(regular),
                    _ if dissipates => Ink::Curve(0),
                    // one chaotic orbit is like the next
                    Some(false) => chaos_ink(Some(false)),
                    _ => Ink::Curve(SINGLE[index % SINGLE.len()]),
                };
                (ORBITS, Layer::Points(Arc::clone(&orbit.points), ink))
            };
            layers.extend(portrait.orbits.iter().enumerate().map(points));
        }
        layers.push((OWN, Layer::CompanionCrossings { section, channels }));
        layers.push((OWN, Layer::Crossings { section, channels, ink: Ink::Accent }));
        layers.push((NOW, Layer::LastCrossing { section, channels, shape: MarkerShape::Disc }));
        layers.extend(marks(present, NOW, |one| {
            let [x, y] = channels.map(|channel| value_at(present.physics, one, channel));
            let when = present.physics.model.sections.get(section)?.when;
            if lies_on(present, one, when) { Some([x?, y?]) } else { None }
        }));
        layers.extend(periodic::marks(present, section, channels));
        let (channel, range) = (channels[1], range(context, 1));
        let upwards = match Portrait::of(answer).and_then(newest_rotation) {
            Some(words) => Upwards::Annotated { channel, range, words },
            None => Upwards::Channel(channel, range),
        };
        Some(Picture::Axes { upwards, layers, occurrences: None })
    }

    fn start(&self, context: PlotContext<'_>, at: [f64; 2]) -> StartValues {
        let PlotContext { plot, present, .. } = context;
        let plane = plane(plot, present).ok_or(NoStart::Nothing)?;
        let given = beginning(plot, present, &plane, at);
        given.map_err(|why| NoStart::Refused(capitalised(&why.to_string())))
    }

    fn seed(&self, context: PlotContext<'_>) -> Option<Seed> {
        let PlotContext { plot, present, .. } = context;
        plane(plot, present)?;
        let viewport = plot.viewport()?;
        let window = [range(context, 0)?, range(context, 1)?];
        Some(Seed::Spread([0, 1].map(|axis| viewport.part(axis, window[axis]))))
    }

    fn job(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Need {
        let Some(plane) = plane(plot, present) else { return Need::Nothing };
        let Physics { model, equations, system } = present.physics;
        // without a constant energy there is no shell to spread starts over
        if plane.is_bounded() && equations.energy_rate != Expr::ZERO {
            return Need::Nothing;
        }
        let Some(section) = view(plot, present.physics).and_then(|view| view.section) else {
            return Need::Nothing;
        };
        let (Some(x), Some(y), Some(method)) =
            (plot.column(0), plot.column(1), method_named(present.method))
        else {
            return Need::Nothing;
        };
        let conditions = SectionConditions::of(present);
        let known = Portrait::of(answer).filter(|known| {
            known.conditions.are_unchanged(&conditions, plane.is_bounded())
                && plot.seeds.starts_with(&known.seeds)
        });
        let seed = match known {
            None => None,
            Some(known) if !known.pending.0.is_empty() => None,
            Some(known) => match plot.seeds.get(known.seeds.len()) {
                None => return Need::Valid,
                seed => seed.copied(),
            },
        };
        let bounds = |channel: usize| {
            let known = present.bounds.get(channel);
            known.map_or([f64::NAN; 2], |(lo, hi)| [*lo, *hi])
        };
        let task = SectionTask {
            plane,
            // the token of the motion is not that of a picture
            law: (Arc::clone(model), Arc::clone(equations)),
            system: Arc::clone(system),
            method,
            conditions: known.map_or(conditions, |known| known.conditions.clone()),
            plan: SectionPlan {
                event: model.event_of_section(section),
                count: Some(COUNT),
                until: None,
                idle: IDLE,
                all_channels: true,
            },
            columns: [x, y],
            transient: if dissipates(present.physics) { TRANSIENT } else { 0 },
            // orbits of a picture that was begun continue in it
            known: known.map(|known| StartedPortrait {
                region: known.region.clone(),
                orbits: known.orbits.clone(),
                pending: known.pending.clone(),
            }),
            given: [given(plot, present, 0), given(plot, present, 1)],
            own: own_start(present),
            around: [bounds(x), bounds(y)],
            seed,
            seeds: known.iter().flat_map(|known| known.seeds.clone()).chain(seed).collect(),
        };
        let job = Job::new("orbits", move |progress| Answer::new(task.portrait(progress)));
        // what a person asks for is computed at once, and what follows from other values when these rest
        let shown = Portrait::of(answer).map_or(0, |portrait| portrait.seeds.len());
        let is_asked = !plot.seeds.is_empty() && (known.is_some() || shown < plot.seeds.len());
        if is_asked { Need::Job(job) } else { Need::AtRest(job) }
    }

    fn table(&self, PlotContext { plot, present, answer }: PlotContext<'_>) -> Option<PlotTable> {
        let channels = present.physics.system.channels();
        let named = |k| Some(channels.get(plot.column(k)?)?.name.clone());
        Some(Portrait::of(answer)?.table([named(0)?, named(1)?]))
    }
}

/// The plane of a plot, if its points are starts and its quantities are columns of an orbit.
fn plane(plot: &Plot, present: &Present<'_>) -> Option<SectionPlane> {
    let Physics { model, system, .. } = present.physics;
    let axes = [plot.column(0)?, plot.column(1)?];
    if axes.iter().any(|axis| *axis >= system.columns()) {
        return None;
    }
    let section = view(plot, present.physics)?.section?;
    let energy = SectionConditions::of(present).energy;
    let at = (model.run.start, present.parameters, energy);
    let plane = SectionPlane::new((model, system), section, axes, at);
    plane.filter(|plane| energy.is_finite() || !plane.is_bounded())
}

fn own_start(present: &Present<'_>) -> Start {
    let Physics { model, system, .. } = present.physics;
    let given = present.initial.iter().enumerate();
    Start {
        time: model.run.start,
        parameters: present.parameters.to_vec(),
        overrides: given.map(|(i, &x)| system.initial_override(i, x)).collect(),
    }
}

/// The initial values of a motion that passes a point of the picture.
fn beginning(
    plot: &Plot,
    present: &Present<'_>,
    plane: &SectionPlane,
    at: [f64; 2],
) -> Result<Vec<InitialOverride>, NotInPlane> {
    let Physics { model, equations, system } = present.physics;
    let mut observer = system.observer(present.parameters);
    let section = view(plot, present.physics).and_then(|view| view.section);
    let shift = match (section, method_named(present.method)) {
        (Some(section), Some(method)) if plane.is_at_another_phase() => {
            let event = model.event_of_section(section);
            let start = plane.start(system, &mut observer, at)?;
            let backwards = system.reversed(model, equations)?;
            let method = (method, present.settings);
            Some(PhaseShift::new((system, backwards), method, &start, event)?)
        }
        _ => None,
    };
    Ok(plane.through(system, &mut observer, (at, shift.as_ref()))?.overrides)
}

/// The range that the file gives an axis, if it shows the same quantity.
fn given(plot: &Plot, present: &Present<'_>, axis: usize) -> Option<[f64; 2]> {
    let Physics { model, system, .. } = present.physics;
    let view = view(plot, present.physics)?;
    let channel = plot.column(axis)?;
    let written = view.axes.get(axis)?.first()?;
    if let Some(ends) = view.ranges[axis]
        && system.channel_of(written.expression) == Some(channel)
    {
        let known = Valuation::of_parameters(model, present.parameters);
        let [from, to] = ends.map(|end| known.value(&model.pool, end));
        if from.is_finite() && to.is_finite() && from < to {
            return Some([from, to]);
        }
    }
    let period = system.period(channel, present.parameters)?;
    Some([-period / 2.0, period / 2.0])
}

/// The range of an axis: the file's, or that of the region.
fn range(PlotContext { plot, present, answer }: PlotContext<'_>, axis: usize) -> Option<[f64; 2]> {
    let region = Portrait::of(answer).map(|portrait| portrait.region.window[axis]);
    given(plot, present, axis).or(region)
}

/// Whether friction acts.
fn dissipates(physics: Physics<'_>) -> bool {
    physics.model.mechanics.dissipation() != Expr::ZERO
}

fn capitalised(sentence: &str) -> String {
    let mut letters = sentence.chars();
    let first = letters.next().map(|letter| letter.to_uppercase().collect::<String>());
    format!("{}{}.", first.unwrap_or_default(), letters.as_str())
}
