//! A system frozen at an instant: whatever depends on the time keeps the value it has then, so that the energy is
//! conserved and the motion of one coordinate returns.
//!
//! In: a model, a coordinate, the time and the state of a motion. Out: the action, period and energy of that coordinate as if
//! nothing changed any more: of a motion whose parameters change slowly, its adiabatic invariant. Never here: the motion
//! itself.
//! Source: *The Principles of Dynamics*, § 4.3.

use std::collections::HashMap;

use super::{
    ActionRow, ActionSystems, AllowedInterval, EffectivePotential, NoAction, RegionKind,
    Separatrix, action_row, angle,
};
use crate::cancel::Cancel;
use crate::ensemble::{NotOnShell, Root, Start, add_section};
use crate::expr::{Expr, FunctionId, Pool, Symbol};
use crate::integrate::{METHODS, Method, Settings};
use crate::mechanics::{NoClosedForm, derive_for_motion};
use crate::model::{
    Direction, EventAction, Expect, Impulse, Model, MotionEvent, Parameter, RangeSpacing,
    WrittenExpr,
};
use crate::num::Number;
use crate::system::{ChannelKind, CompileError, InitialOverride, MotionError, System};

/// Why a system has no action variable, as a sentence for the user.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum NotFrozen {
    /// Its variables are given by their brackets.
    #[error("variables given by their brackets have no momenta, and no actions")]
    NoMomenta,
    /// It is subject to constraints.
    #[error(
        "under constraints there is no action of a coordinate: choose coordinates that need none"
    )]
    Constrained,
    /// Impulses act on it.
    #[error("impulses act on the motion: p is not a function of q on its curve of equal energy")]
    Impulses,
    /// Forces change its energy.
    #[error("forces change the energy even while the parameters stand still: no motion returns")]
    EnergyNotConserved,
    /// It cannot be derived.
    #[error(transparent)]
    Derivation(#[from] NoClosedForm),
    /// It cannot be compiled.
    #[error("{0}")]
    Compile(String),
}

impl From<CompileError> for NotFrozen {
    fn from(why: CompileError) -> Self {
        NotFrozen::Compile(why.to_string())
    }
}

/// The coordinate as the motion has it.
#[derive(Clone, PartialEq, Debug)]
pub struct OwnMotion {
    /// That of the frozen system at the motion's state.
    pub energy: f64,
    /// The action, the period, the kind of motion; or why there is none.
    pub row: Result<ActionRow, NoAction>,
}

/// A system of which everything that depends on the time stands still, compiled with the events by which returns are
/// located.
pub struct FrozenSystem {
    coordinate: usize,
    turning: System,
    turns: usize,
    rotating: Option<(System, usize)>,
    /// Whether the law depends on the time, so that the actions do.
    depends_on_time: bool,
    method: (&'static Method, Settings),
}

impl FrozenSystem {
    /// Settings of the motions by which returns are located, for more digits than are shown.
    pub const PRECISE: Settings = Settings { step: None, tolerance: Some(1e-15) };

    /// Holds a model at instants to come; `settings` are those of the motions by which returns are located.
    ///
    /// # Errors
    /// Returns an error if a coordinate of it has no action variable.
    pub fn of(
        model: &Model,
        coordinate: usize,
        settings: Settings,
        cancel: &Cancel,
    ) -> Result<Self, NotFrozen> {
        if model.is_poisson() {
            return Err(NotFrozen::NoMomenta);
        }
        if !model.constraints.is_empty() {
            return Err(NotFrozen::Constrained);
        }
        let scheduled = |impulse: &Impulse| !impulse.times.is_empty() || impulse.period.is_some();
        let applies_impulse = |event: &MotionEvent| matches!(event.action, EventAction::Impulse(_));
        if model.impulses.iter().any(scheduled) || model.events.iter().any(applies_impulse) {
            return Err(NotFrozen::Impulses);
        }
        let mut model = model.clone();
        model.leave_views_out();
        model.impulses.clear();
        model.events.clear();
        model.generators.clear();
        model.complete_integral = None;
        model.comparison = None;
        model.frames.clear();
        model.observables.clear();
        model.picture.shapes.clear();
        model.transformations.clear();
        model.with_ramps_named = None;
        model.expect = Expect::default();
        model.run.start = 0.0;
        model.pool.set_cancel(cancel.clone());
        let depends_on_time = freeze_time(&mut model);
        let action = model.pool.variable(model.symbols.action);
        let columns = [WrittenExpr { written: "action".to_owned(), expression: action }];
        let compile = |model: &Model| -> Result<System, NotFrozen> {
            let equations = derive_for_motion(model)?;
            if equations.energy_rate != Expr::ZERO {
                return Err(NotFrozen::EnergyNotConserved);
            }
            Ok(System::compile(model, &equations, &columns)?.with_cancel(cancel.clone()))
        };
        let moving = &model.coordinates[coordinate];
        let (position, velocity, period) = (moving.position, moving.velocity, moving.period);
        let mut plain = model.clone();
        let zero = model.pool.variable(velocity);
        let turns = add_section(&mut model, zero, Direction::Either);
        let turning = compile(&model)?;
        let rotating = match period {
            Some(period) => {
                let whole = sine_of_a_turn(&mut plain.pool, position, period);
                let event = add_section(&mut plain, whole, Direction::Either);
                Some((compile(&plain)?, event))
            }
            None => None,
        };
        let method = (&METHODS[0], settings);
        Ok(Self { coordinate, turning, turns, rotating, depends_on_time, method })
    }

    /// Whether the law depends on the time, so that its actions do.
    pub fn depends_on_time(&self) -> bool {
        self.depends_on_time
    }

    /// The system at an instant, at coordinates and momenta.
    ///
    /// # Errors
    /// Returns an error if there is no such state.
    pub fn at<'a>(
        &'a self,
        time: f64,
        parameters: &[f64],
        [positions, momenta]: [&[f64]; 2],
    ) -> Result<FrozenMotion<'a>, MotionError> {
        let mut parameters = parameters.to_vec();
        parameters.push(time);
        let positions = positions.iter().enumerate();
        let momenta = momenta.iter().enumerate();
        let overrides = positions
            .map(|(i, &x)| InitialOverride::Position(i, x))
            .chain(momenta.map(|(i, &x)| InitialOverride::Momentum(i, x)))
            .collect();
        let start = Start { time: 0.0, parameters, overrides };
        let potential = EffectivePotential::survey(&self.turning, &start, self.coordinate)?;
        Ok(FrozenMotion { frozen: self, start, potential })
    }

    /// The place of a quantity among the columns of the system.
    fn column(&self, kind: ChannelKind) -> usize {
        self.turning.channels().iter().position(|c| c.kind == kind).unwrap_or(0)
    }

    fn systems(&self) -> ActionSystems<'_> {
        ActionSystems {
            turning: &self.turning,
            turns: self.turns,
            rotating: self.rotating.as_ref().map(|(system, event)| (system, *event)),
            column: 1 + self.column(ChannelKind::Position(self.coordinate)),
            method: self.method.0,
            settings: self.method.1,
        }
    }
}

/// A frozen system at one instant, with the other coordinates as they are.
pub struct FrozenMotion<'a> {
    frozen: &'a FrozenSystem,
    start: Start,
    potential: EffectivePotential<'a>,
}

impl FrozenMotion<'_> {
    /// The coordinate as the motion has it.
    ///
    /// # Errors
    /// Returns an error if the state cannot be observed.
    pub fn own(&mut self) -> Result<OwnMotion, MotionError> {
        let system = &self.frozen.turning;
        let mut values = vec![0.0; system.columns()];
        let state = self.start.state(system)?;
        system.observer(&self.start.parameters).observe_columns(&state, &mut values)?;
        let place = values[self.frozen.column(ChannelKind::Position(self.frozen.coordinate))];
        let energy = values[self.frozen.column(ChannelKind::Energy)];
        let along = (energy, way(self.potential.velocity(&self.start)?));
        let regions = self.potential.regions(energy);
        let row = match nearest(&regions, place, self.potential.period()) {
            Some(region) => action_row(&mut self.potential, &self.frozen.systems(), region, along),
            None => Err(NoAction::NoReturn("the coordinate is at rest".to_owned())),
        };
        Ok(OwnMotion { energy, row })
    }

    /// The angle variable of the coordinate as the motion has it, in turns; `row` is its own.
    ///
    /// # Errors
    /// Returns an error if the motion does not return, or the state cannot be observed.
    pub fn angle(&mut self, row: &ActionRow) -> Result<f64, NoAction> {
        let system = &self.frozen.turning;
        let mut values = vec![0.0; system.columns()];
        let observed = self.start.state(system).and_then(|state| {
            system.observer(&self.start.parameters).observe_columns(&state, &mut values)
        });
        observed.map_err(|why| NoAction::NoReturn(why.to_string()))?;
        let value = |kind| values[self.frozen.column(kind)];
        let place = value(ChannelKind::Position(self.frozen.coordinate));
        let velocity = value(ChannelKind::Velocity(self.frozen.coordinate));
        angle(&mut self.potential, row, place, velocity)
    }

    /// The rows of all regions of an energy in which the motion returns, from left to right; a rotation goes the way of the motion.
    ///
    /// # Errors
    /// Returns an error if a motion does not come back to where it began.
    pub fn rows(&mut self, energy: f64) -> Result<Vec<ActionRow>, NoAction> {
        let velocity = self.potential.velocity(&self.start).map_err(NotOnShell::from)?;
        let along = (energy, way(velocity));
        let mut rows = Vec::new();
        for region in self.potential.regions(energy) {
            let row = action_row(&mut self.potential, &self.frozen.systems(), region, along)?;
            if row.kind != RegionKind::Unbounded {
                rows.push(row);
            }
        }
        Ok(rows)
    }

    /// The separatrices, from left to right.
    ///
    /// # Errors
    /// Returns an error if a lobe has no momentum somewhere.
    pub fn separatrices(&mut self) -> Result<Vec<Separatrix>, NoAction> {
        Ok(Separatrix::all(&mut self.potential, || false)?)
    }

    /// The least energy of the coordinate between the points where a motion turns; of one that does not turn, the least at
    /// all.
    pub fn bottom(&self, motion: &OwnMotion) -> f64 {
        let turns = motion.row.as_ref().map_or([None, None], |row| row.turning_points);
        let between = match turns {
            [Some(from), Some(to)] => self.potential.profile.bottom_between([from, to]),
            _ => None,
        };
        between.unwrap_or_else(|| self.potential.profile.bottom())
    }
}

fn way(velocity: f64) -> Root {
    if velocity < 0.0 { Root::Negative } else { Root::Positive }
}

/// Puts a parameter in the place of the time, the last of all, and returns whether the law depends on it.
fn freeze_time(model: &mut Model) -> bool {
    const NAME: &str = "the instant at which it is frozen";
    let symbol = model.pool.symbol(NAME);
    let frozen = model.pool.variable(symbol);
    let time = model.symbols.time;
    let map: HashMap<Symbol, Expr> = HashMap::from([(time, frozen)]);
    let Model { pool, mechanics, parameters, .. } = model;
    let mut depends = false;
    for e in mechanics.expressions_mut() {
        depends |= pool.depends(*e, time);
        *e = pool.substitute(*e, &map);
    }
    parameters.push(Parameter {
        name: NAME.to_owned(),
        shown: NAME.to_owned(),
        symbol,
        value: 0.0,
        min: 0.0,
        max: 1.0,
        scale: RangeSpacing::Linear,
        unit: String::new(),
        about: String::new(),
    });
    depends
}

/// sin(π q/P), which vanishes once a turn.
fn sine_of_a_turn(pool: &mut Pool, position: Symbol, period: Expr) -> Expr {
    let (pi, q) = (pool.pi(), pool.variable(position));
    let angle = pool.monomial(Number::ONE, &[(pi, Number::ONE), (q, Number::ONE)]);
    let angle = pool.div(angle, period);
    pool.call(FunctionId::Sin, &[angle])
}

/// The region that a place lies in; a motion at rest is on its edge.
fn nearest(
    regions: &[AllowedInterval],
    place: f64,
    period: Option<f64>,
) -> Option<AllowedInterval> {
    let outside = |region: &AllowedInterval, place: f64| {
        let left = region.left.map_or(0.0, |left| left - place);
        let right = region.right.map_or(0.0, |right| place - right);
        left.max(right).max(0.0)
    };
    let distance = |region: &AllowedInterval| match (period, region.left) {
        // the same place of the turn that begins where the region does
        (Some(turn), Some(left)) => {
            let within = left + (place - left).rem_euclid(turn);
            outside(region, within).min(outside(region, within - turn))
        }
        _ => outside(region, place),
    };
    regions.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).copied()
}
