//! Splitting: H = T(p) + V(q, t) is integrated by V alone and by T alone in turn, each exactly.
//!
//! A step of Störmer and Verlet is half a kick, a drift, half a kick. A symmetric composition of
//! steps w₁ h, w₂ h, … with sum h has a higher order for suitable w. A whole kick and then a whole drift are a
//! [step of symplectic Euler](super::symplectic_euler).
//!
//! Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration, I.1.4, II.4, II.5.

use super::fixed::{FixedStep, ManySteps, Scheme, add};
use super::method::{Method, MethodError, Settings, StepperResult};
use super::stability::{self, Modes};
use crate::system::{Composition, Form, KinkSides, MotionError, Rates, SplitStep, State, System};

/// What it requires of a system.
pub(super) const NEEDS: &str = "H = T(p) + V(q, t)";

pub(super) fn fits(method: &Method, system: &System) -> Result<(), MethodError> {
    system.separable().map_err(|why| MethodError { method: method.name, reason: why.to_owned() })
}

pub(super) fn make(method: &Method, system: &System, settings: &Settings) -> StepperResult {
    fits(method, system)?;
    let Some(scheme) = Splitting::new(system, &Composition::Leapfrogs((method.leapfrogs)())) else {
        return Err(MethodError { method: method.name, reason: format!("{NEEDS} does not hold") });
    };
    Ok(Box::new(FixedStep::new(method.name, system, settings, scheme)?))
}

/// Kicks and drifts in turn.
#[derive(Clone)]
pub(super) struct Splitting {
    drift: Rates,
    kick: Rates,
    /// Many steps at once, where they can be a list of instructions.
    many: Option<SplitStep>,
    before: State,
    /// The parts of the step that the leapfrogs take; none where a step is a kick and a drift.
    weights: Vec<f64>,
    /// No mode with |z| up to this is amplified.
    harmless: f64,
    velocity: Vec<f64>,
    force: Vec<f64>,
    /// Whether `force` is that of the current positions: that of the last kick, which changed only
    /// momenta.
    known: bool,
}

impl Splitting {
    /// The steps of a composition; `None` where H does not separate.
    pub(super) fn new(system: &System, composition: &Composition) -> Option<Splitting> {
        let (drift, kick) = system.split_rates()?;
        let (velocity, force) = (vec![0.0; system.state_len()], vec![0.0; system.state_len()]);
        let many = SplitStep::new(&drift, &kick, composition);
        let weights = match composition {
            Composition::Leapfrogs(weights) => weights.clone(),
            Composition::KickDrift => Vec::new(),
        };
        let before = State::new(0.0, Form::Momentum, Vec::new());
        Some(Splitting {
            harmless: stability::harmless(growth, modes_of(&weights)),
            drift,
            kick,
            many,
            before,
            weights,
            velocity,
            force,
            known: false,
        })
    }
}

impl Scheme for Splitting {
    fn form(&self) -> Form {
        Form::Momentum
    }

    fn begin(&mut self, parameters: &[f64]) {
        self.drift.set_parameters(parameters);
        self.kick.set_parameters(parameters);
        if let Some(many) = &mut self.many {
            many.set_parameters(parameters);
        }
        self.known = false;
    }

    fn forget(&mut self) {
        self.known = false;
    }

    fn advance_many(&mut self, step: f64, count: u64, states: ManySteps<'_>) -> bool {
        let Some(many) = &mut self.many else { return false };
        self.known = false;
        let ManySteps { state, before, seen } = states;
        match seen {
            Some(seen) => many.advance_seen(step, count, state, before, seen),
            None => many.advance(step, count, state, before),
        }
    }

    fn advance(&mut self, step: f64, state: &mut State) -> Result<(), MotionError> {
        if let Some(many) = &mut self.many
            && many.advance(step, 1, state, &mut self.before)
        {
            self.known = false;
            return Ok(());
        }
        if !self.known {
            self.kick.evaluate(state.time, &state.values, &mut self.force)?;
        }
        if self.weights.is_empty() {
            add(state, step, &self.force);
            self.drift.evaluate(state.time, &state.values, &mut self.velocity)?;
            add(state, step, &self.velocity);
            self.known = false;
            return Ok(());
        }
        self.known = false;
        let (mut before, mut elapsed) = (0.0, 0.0);
        for &w in &self.weights {
            add(state, 0.5 * (before + w) * step, &self.force);
            self.drift.evaluate(state.time, &state.values, &mut self.velocity)?;
            add(state, w * step, &self.velocity);
            elapsed += w;
            self.kick.evaluate(state.time + elapsed * step, &state.values, &mut self.force)?;
            before = w;
        }
        add(state, 0.5 * before * step, &self.force);
        self.known = true;
        Ok(())
    }

    fn modes(&self) -> Option<Modes<'_>> {
        let weights = modes_of(&self.weights);
        Some(Modes { growth, weights, harmless: self.harmless })
    }

    fn rates(&mut self, time: f64, numbers: &[f64], out: &mut [f64]) -> Result<(), MotionError> {
        self.drift.evaluate(time, numbers, out)?;
        self.kick.evaluate(time, numbers, out)
    }

    fn sides(&mut self) -> Vec<KinkSides> {
        vec![self.drift.sides(), self.kick.sides()]
    }
}

/// The leapfrogs that amplify modes as steps with these weights do. A kick and a drift are conjugate to one.
fn modes_of(weights: &[f64]) -> &[f64] {
    if weights.is_empty() { &[1.0] } else { weights }
}

/// The growth of an oscillation q' = p, p' = −θ² q in one step of size 1, with iθ = z; modes that
/// do not oscillate are not judged. The step is a matrix of determinant 1, so its trace determines
/// the growth.
pub(super) fn growth(weights: &[f64], [re, im]: [f64; 2]) -> f64 {
    if im.abs() <= 10.0 * re.abs() {
        return 1.0;
    }
    let square = im * im;
    // the columns of the matrix, as the states (q, p) that begin at (1, 0) and (0, 1)
    let mut states = [[1.0, 0.0], [0.0, 1.0]];
    for [q, p] in &mut states {
        for w in weights {
            *p -= 0.5 * w * square * *q;
            *q += w * *p;
            *p -= 0.5 * w * square * *q;
        }
    }
    let half = 0.5 * (states[0][0] + states[1][1]).abs();
    if half <= 1.0 { 1.0 } else { half + (half * half - 1.0).sqrt() }
}
