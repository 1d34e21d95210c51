//! The flow of a constant of the motion, applied to the state: dq/dε = ∂I/∂p, dp/dε = −∂I/∂q. It carries an orbit to
//! another orbit of the same system, with the same energy.
//!
//! In: the constant, how far. Out: a job that follows the flow, then a command that begins the motion at its end. Never
//! here: how a flow is derived.
//! Source: *The Principles of Dynamics*, §§ 3.3.2, 3.4.

use std::sync::Arc;

use super::computation::Asker;
use super::menu::{Choice, Choosing, Item, Menu};
use super::{App, Effect, Notification, Overlay};
use crate::experiment::{Command, Derived, Experiment, Setup, Status};
use crate::expr::Expr;
use crate::instrument::Answer;
use crate::job::{Job, Outcome, Progress};
use crate::mechanics::{Equations, GeneratorFlow, flow_of};
use crate::model::Model;
use crate::system::{ChannelKind, InitialOverride};

/// The steps of integration between two looks at the token that stops them.
const SLICE: u64 = 200;

/// The most slices before it is given up.
const SLICES: u32 = 2_000;

/// What a flow leads to: the initial values of the new orbit, or why there are none.
type FlowOutcome = Result<Vec<InitialOverride>, String>;

/// What is carried.
struct FlowStart {
    model: Model,
    equations: Equations,
    generator: Expr,
    epsilon: f64,
    time: f64,
    parameters: Vec<f64>,
    state: Vec<InitialOverride>,
}

impl FlowStart {
    fn carried(&self, progress: &Progress) -> FlowOutcome {
        let mut equations = self.equations.clone();
        equations.pool.set_cancel(progress.token().clone());
        let mut source = self.model.clone();
        source.pool = equations.pool.clone();
        // backwards along I is forwards along −I
        let generator =
            if self.epsilon < 0.0 { equations.pool.neg(self.generator) } else { self.generator };
        let moved = flow_of(&source, &mut equations, ("I", generator), &[], self.time);
        let GeneratorFlow { mut model, equations, .. } = moved.map_err(|why| why.to_string())?;
        "auto".clone_into(&mut model.run.method);
        model.run.method_place = None;
        model.run.step = None;
        model.run.start = 0.0;
        let system = Derived { model: model.clone(), equations: equations.clone() }.compile(&[]);
        let system = system.map_err(|why| why.to_string())?;
        let setup = Setup {
            parameters: self.parameters.clone(),
            overrides: self.state.clone(),
            ..Setup::of(&model)
        };
        let (model, equations) = (Arc::new(model), Arc::new(equations));
        let mut experiment =
            Experiment::new(&model, &equations, &system, setup).map_err(|why| why.to_string())?;
        let end = self.epsilon.abs();
        for _ in 0..SLICES {
            if progress.is_cancelled() || experiment.time() >= end {
                break;
            }
            experiment.advance(end, SLICE);
            if let Status::Failed(failure) = experiment.snapshot().status {
                return Err(failure.message);
            }
        }
        let snapshot = experiment.snapshot();
        if snapshot.time < end {
            return Err(format!("the flow was followed to {} only", snapshot.time));
        }
        let channels = system.channels().iter().zip(snapshot.values.iter());
        Ok(channels.filter_map(|(c, &value)| initial(c.kind, value)).collect())
    }
}

/// A coordinate or momentum as an initial value.
fn initial(kind: ChannelKind, value: f64) -> Option<InitialOverride> {
    match kind {
        ChannelKind::Position(i) => Some(InitialOverride::Position(i, value)),
        ChannelKind::Momentum(i) => Some(InitialOverride::Momentum(i, value)),
        _ => None,
    }
}

impl App {
    /// Lists the constants of the motion that have a flow.
    pub(super) fn open_flows(&mut self) -> Vec<Effect> {
        if let Some(why) = self.lack(super::Action::ApplyFlow) {
            return self.notify(format!("There is nothing to apply: {why}."));
        }
        let Some(lab) = &self.lab else { return Vec::new() };
        let Some(Ok(findings)) = lab.findings() else { return Vec::new() };
        let line = |(index, (name, e)): (usize, (String, Expr))| Item {
            label: name,
            about: findings.equations.pool.unicode(e),
            keys: String::new(),
            refusal: None,
            choice: Choice::Flow(index),
        };
        let items = lab.flows().into_iter().enumerate().map(line).collect();
        let title = "Carry the state along the flow of a constant of the motion";
        self.overlay = Some(Overlay::Menu(Menu::new(title, Choosing::Flow, items)));
        Vec::new()
    }

    /// Follows the flow of a constant from the current state.
    pub(super) fn follow_flow(&mut self, index: usize, epsilon: f64) -> Vec<Effect> {
        let Some(lab) = &self.lab else { return Vec::new() };
        let (Some(snapshot), Some(Ok(findings))) = (lab.seen(), lab.findings()) else {
            return Vec::new();
        };
        let Some((_, generator)) = lab.flows().into_iter().nth(index) else { return Vec::new() };
        let channels = lab.loaded.system.channels().iter().zip(snapshot.values.iter());
        let start = FlowStart {
            model: (*lab.loaded.model).clone(),
            equations: findings.equations.clone(),
            generator,
            epsilon,
            time: snapshot.time,
            parameters: snapshot.parameters.to_vec(),
            state: channels.filter_map(|(c, &value)| initial(c.kind, value)).collect(),
        };
        let job =
            Job::new("following the flow", move |progress| Answer::new(start.carried(progress)));
        let computation = self.computation(Asker::Flow, job);
        if let Some(lab) = &mut self.lab {
            lab.flow = Some(computation.ticket);
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
        lab.flow.take_if(|waited| *waited == ticket)?;
        let carried = match outcome {
            Outcome::Done(answer) => answer.of::<FlowOutcome>()?.clone(),
            Outcome::Failed(why) => Err(why.clone()),
            Outcome::Cancelled => return Some(Vec::new()),
        };
        Some(match carried {
            Ok(overrides) => {
                let sentence = "The motion begins where the flow leads, on another orbit.";
                self.notice = Some(Notification::info(sentence));
                vec![Effect::Tell(Command::Start(overrides))]
            }
            Err(why) => self.notify(format!("The flow cannot be followed: {why}.")),
        })
    }
}
