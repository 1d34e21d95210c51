//! Flows applied to the state, which carry an orbit to another orbit of the same system: that of a constant of the
//! motion, dq/dε = ∂I/∂p, dp/dε = −∂I/∂q, at the same energy, and that of a symmetry of the equations of motion.
//!
//! In: what generates the flow, how far. Out: a job that follows the flow, then a command that begins the motion at its
//! end. Never here: how a flow is derived.
//! Source: *The Principles of Dynamics*, §§ 3.3.2, 3.4.

use std::sync::Arc;

use super::computation::Asker;
use super::field::{InputField, number};
use super::menu::{Choice, Choosing, Item, Menu};
use super::{App, Effect, Lab, Loaded, Notification, Overlay};
use crate::experiment::{Derived, Experiment, Setup, Status};
use crate::expr::{Expr, Pool};
use crate::instrument::Answer;
use crate::integrability::symmetry_flow;
use crate::job::{Job, Outcome, Progress};
use crate::mechanics::{Equations, GeneratorFlow, flow_of};
use crate::model::{Allowed, Model, Scope};
use crate::num::significant;
use crate::system::{ChannelKind, InitialOverride};

/// The steps of integration between two checks of the token that stops them.
const SLICE: u64 = 200;

/// The most slices before it is given up.
const SLICES: u32 = 2_000;

/// What a flow leads to, or why it leads nowhere.
type FlowOutcome = Result<FlowEnd, String>;

/// The initial values of the new orbit.
#[derive(Clone, Debug)]
struct FlowEnd {
    values: Vec<InitialOverride>,
    /// The energy before and after, of a flow of a function G.
    energies: Option<[f64; 2]>,
    /// Whether [H, G] = 0 is proved.
    keeps_energy: bool,
}

/// Energies that differ by less than this part are the same to rounding.
const SAME: f64 = 1e-12;

#[derive(Clone, Debug)]
pub(super) enum FlowGenerator {
    Constant(Expr),
    /// A change of time, and of each coordinate.
    Symmetry(Expr, Vec<Expr>),
}

impl FlowGenerator {
    /// A channel of the system as a variable of the flow, if it is one.
    fn variable(&self, degrees: usize, kind: ChannelKind, value: f64) -> Option<InitialOverride> {
        match (self, kind) {
            (_, ChannelKind::Position(i)) => Some(InitialOverride::Position(i, value)),
            (Self::Constant(_), ChannelKind::Momentum(i)) => {
                Some(InitialOverride::Momentum(i, value))
            }
            (Self::Symmetry(..), ChannelKind::Velocity(i)) => {
                Some(InitialOverride::Position(degrees + i, value))
            }
            _ => None,
        }
    }

    /// A channel of the flow as an initial value of the system, if it is one.
    fn initial_value(
        &self,
        degrees: usize,
        kind: ChannelKind,
        value: f64,
    ) -> Option<InitialOverride> {
        match (self, kind) {
            (Self::Symmetry(..), ChannelKind::Position(k)) if k >= degrees => {
                Some(InitialOverride::Velocity(k - degrees, value))
            }
            (_, ChannelKind::Position(i)) => Some(InitialOverride::Position(i, value)),
            (Self::Constant(_), ChannelKind::Momentum(i)) => {
                Some(InitialOverride::Momentum(i, value))
            }
            _ => None,
        }
    }

    /// What leads forwards where this leads backwards.
    fn reversed(&self, pool: &mut Pool) -> FlowGenerator {
        match self {
            FlowGenerator::Constant(e) => FlowGenerator::Constant(pool.neg(*e)),
            FlowGenerator::Symmetry(time, changes) => FlowGenerator::Symmetry(
                pool.neg(*time),
                changes.iter().map(|&e| pool.neg(e)).collect(),
            ),
        }
    }
}

struct FlowStart {
    model: Model,
    equations: Equations,
    generator: FlowGenerator,
    epsilon: f64,
    time: f64,
    parameters: Vec<f64>,
    state: Vec<(ChannelKind, f64)>,
}

impl FlowStart {
    fn law(&self, progress: &Progress) -> Result<(Model, Equations), String> {
        let mut equations = self.equations.clone();
        equations.pool.set_cancel(progress.token().clone());
        let mut source = self.model.clone();
        source.pool = equations.pool.clone();
        let generator = if self.epsilon < 0.0 {
            self.generator.reversed(&mut equations.pool)
        } else {
            self.generator.clone()
        };
        match generator {
            FlowGenerator::Constant(e) => {
                flow_of(&source, &mut equations, ("I", e), &[], self.time)
                    .map(|GeneratorFlow { model, equations, .. }| (model, equations))
                    .map_err(|why| why.to_string())
            }
            FlowGenerator::Symmetry(time, changes) => {
                symmetry_flow(&source, &mut equations, (time, &changes), self.time)
                    .map_err(|why| why.to_string())
            }
        }
    }

    fn carried(&self, progress: &Progress) -> FlowOutcome {
        let degrees = self.model.coordinates.len();
        let (mut model, equations) = self.law(progress)?;
        "auto".clone_into(&mut model.run.method);
        model.run.method_place = None;
        model.run.step = None;
        model.run.start = 0.0;
        let system = Derived { model: model.clone(), equations: equations.clone() }.compile(&[]);
        let system = system.map_err(|why| why.to_string())?;
        let setup = Setup {
            parameters: self.parameters.clone(),
            overrides: self
                .state
                .iter()
                .filter_map(|&(kind, value)| self.generator.variable(degrees, kind, value))
                .collect(),
            ..Setup::of(&model)
        };
        let (model, equations) = (Arc::new(model), Arc::new(equations));
        let mut experiment =
            Experiment::new(&model, &equations, &system, setup).map_err(|why| why.to_string())?;
        let energy = |experiment: &Experiment| {
            let place = system.channels().iter().position(|c| c.kind == ChannelKind::Energy)?;
            experiment.snapshot().values.get(place).copied()
        };
        let before = energy(&experiment);
        let end = self.epsilon.abs();
        for _ in 0..SLICES {
            if progress.is_cancelled() || experiment.time() >= end {
                break;
            }
            experiment.advance(end, SLICE);
            if let Status::Failed(error) = experiment.snapshot().status {
                return Err(error.message);
            }
        }
        let snapshot = experiment.snapshot();
        if snapshot.time < end {
            return Err(format!("the flow was followed to {} only", snapshot.time));
        }
        let channels = system.channels().iter().zip(snapshot.values.iter());
        let reached =
            channels.filter_map(|(c, &value)| self.generator.initial_value(degrees, c.kind, value));
        let values = reached.collect();
        let after = energy(&experiment);
        let of_function = matches!(self.generator, FlowGenerator::Constant(_));
        let energies = before.zip(after).map(|(before, after)| [before, after]);
        let keeps_energy = of_function && equations.energy_rate == Expr::ZERO;
        Ok(FlowEnd { values, energies: energies.filter(|_| of_function), keeps_energy })
    }
}

impl FlowEnd {
    fn sentence(&self) -> String {
        let begins = "The motion begins where the flow leads";
        let Some([before, after]) = self.energies else {
            return format!("{begins}, on another orbit.");
        };
        let same = (after - before).abs() <= SAME * before.abs().max(after.abs());
        let [from, to] = [before, after].map(|x| significant(x, 6, 1e-4..1e7).replace('-', "−"));
        match (self.keeps_energy, same) {
            (true, _) => format!("{begins}: H = {to} as before, since [H, G] = 0."),
            (false, true) => format!("{begins}: H = {to} as before, though [H, G] is not 0."),
            (false, false) => format!("{begins}: H has changed from {from} to {to}."),
        }
    }
}

impl App {
    /// Lists the constants of the motion that have a flow, and the way to the symmetries. Constants that are not known yet are
    /// searched for, and join the list.
    pub(super) fn open_flows(&mut self) -> Vec<Effect> {
        if let Some(why) = self.lack(super::Action::ApplyFlow) {
            return self.notify(format!("There is nothing to apply: {why}."));
        }
        let Some(lab) = &mut self.lab else { return Vec::new() };
        let search = lab.wants_search(&mut self.jobs).map(Effect::Compute);
        let menu = Menu::new(FLOWS, Choosing::Flow, lab.flow_lines());
        self.overlay = Some(Overlay::Menu(menu));
        search.into_iter().collect()
    }

    /// Lists constants that a search has found meanwhile, if they are being chosen from.
    pub(super) fn renew_flows(&mut self) {
        let (Some(lab), Some(Overlay::Menu(menu))) = (&self.lab, &mut self.overlay) else { return };
        if menu.title == FLOWS {
            menu.replace_items(lab.flow_lines());
        }
    }
}

/// The title of that list.
const FLOWS: &str = "Carry the state along the flow of a constant of the motion, or of a symmetry";

impl Lab {
    fn flow_lines(&self) -> Vec<Item> {
        let lab = self;
        let mut items = Vec::new();
        if let Some(Ok(findings)) = lab.findings() {
            let pool = &findings.equations.pool;
            let flows = lab.flows().into_iter().enumerate();
            items.extend(
                flows.map(|(index, (name, e))| {
                    Item::plain(name, pool.unicode(e), Choice::Flow(index))
                }),
            );
        }
        let model = &lab.loaded.model;
        let generators = model.generators.iter().enumerate();
        items.extend(generators.map(|(index, generator)| {
            let about =
                format!("generator of the file: {}", model.pool.unicode(generator.expression));
            Item::plain(generator.name.clone(), about, Choice::Generator(index))
        }));
        if model.constraints.is_empty() {
            let about = "any function of q and p, typed; H changes unless [H, G] = 0";
            items.push(Item::plain("another G …", about, Choice::TypedGenerator));
        }
        if lab.may_have_symmetries() {
            let about = "changes of time and coordinates that map motions to motions";
            items.push(Item::plain("symmetries …", about, Choice::Symmetries));
        }
        if lab.searches.constants.under_way.is_some() {
            let unavailable = Some("they join this list in a moment".to_owned());
            let label = "searching for constants of the motion …";
            items.push(Item { unavailable, ..Item::plain(label, "", Choice::Symmetries) });
        }
        items
    }
}

impl App {
    pub(super) fn follow_flow(&mut self, index: usize, epsilon: f64) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let Some(Ok(findings)) = lab.findings() else { return Vec::new() };
        let Some((_, generator)) = lab.flows().into_iter().nth(index) else { return Vec::new() };
        let law = (findings.model.clone(), findings.equations.clone());
        self.follow(FlowGenerator::Constant(generator), law, epsilon)
    }

    pub(super) fn follow_generator(&mut self, index: usize, epsilon: f64) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let Some(generator) = lab.loaded.model.generators.get(index) else { return Vec::new() };
        let generator = generator.expression;
        let law = ((*lab.loaded.model).clone(), (*lab.loaded.equations).clone());
        self.follow(FlowGenerator::Constant(generator), law, epsilon)
    }

    /// Follows the flow of a generator that was typed: `G; ε`.
    pub(super) fn accept_typed_flow(&mut self, mut field: InputField) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let typed = field.input.value().to_owned();
        let (written, far) = typed.split_once(';').unwrap_or((&typed, "0.1"));
        let model = &lab.loaded.model;
        let parameters = lab.seen().map_or(Vec::new(), |s| s.parameters.to_vec());
        let mut equations = (*lab.loaded.equations).clone();
        let mut scope = Scope::new(model, Allowed::Bracket, "a generator");
        let read = scope.read(&mut equations.pool, written).ok_or_else(|| {
            let diagnostic = scope.diagnostics.first();
            let what = diagnostic.map_or("it cannot be read".to_owned(), ToString::to_string);
            format!("`{}` is not a generator: {what}.", written.trim())
        });
        match read.and_then(|e| Ok((e, number(model, &parameters, far)?))) {
            Ok((generator, epsilon)) => {
                let law = ((**model).clone(), equations);
                self.follow(FlowGenerator::Constant(generator), law, epsilon)
            }
            Err(sentence) => {
                field.diagnostic = Some(sentence);
                self.overlay = Some(Overlay::Field(field));
                Vec::new()
            }
        }
    }

    /// Follows a flow from the current state; its generator stands in these equations, whose model may have more
    /// parameters than the file.
    pub(super) fn follow(
        &mut self,
        generator: FlowGenerator,
        (searched, equations): (Model, Equations),
        epsilon: f64,
    ) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let Some(snapshot) = lab.seen() else { return Vec::new() };
        let Loaded { model, equations: law, system, .. } = &lab.loaded;
        // the new motion begins with the clock of the file: where that matters, so does what is carried
        let values = if system.exact_rates().depends_on_time() {
            match Experiment::new(model, law, system, (*snapshot.setup).clone()) {
                Ok(experiment) => experiment.snapshot().values,
                Err(why) => return self.fail(format!("The flow cannot be followed: {why}.")),
            }
        } else {
            Arc::clone(&snapshot.values)
        };
        let channels = system.channels().iter().zip(values.iter());
        let mut parameters = snapshot.parameters.to_vec();
        let further = searched.parameters.iter().skip(parameters.len());
        parameters.extend(further.map(|parameter| parameter.value));
        let time = searched.run.start;
        let start = FlowStart {
            model: searched,
            equations,
            generator,
            epsilon,
            time,
            parameters,
            state: channels.map(|(c, &value)| (c.kind, value)).collect(),
        };
        let job =
            Job::new("following the flow", move |progress| Answer::new(start.carried(progress)));
        let computation = self.jobs.request(Asker::Flow, job);
        if let Some(lab) = &mut self.lab {
            lab.searches.flow = Some(computation.ticket);
        }
        vec![Effect::Compute(computation)]
    }

    /// Takes in the state that a flow leads to, if it is one that is waited for.
    pub(super) fn carried(
        &mut self,
        ticket: u64,
        outcome: &Outcome<Answer>,
    ) -> Option<Vec<Effect>> {
        let lab = self.lab.as_mut()?;
        lab.searches.flow.take_if(|waited| *waited == ticket)?;
        let carried = match outcome {
            Outcome::Done(answer) => answer.of::<FlowOutcome>()?.clone(),
            Outcome::Failed(why) => Err(why.clone()),
            Outcome::Cancelled => return Some(Vec::new()),
        };
        Some(match carried {
            Ok(end) => {
                let effects = lab.start_carried(end.values.clone());
                self.notifications.show(Notification::info(end.sentence()));
                effects
            }
            Err(why) => self.fail(format!("The flow cannot be followed: {why}.")),
        })
    }
}
