//! What dragging a mass needs of its system, derived once for a drag: the coordinates that bring it to a place, the momenta at rest.
//!
//! In: a system, the place of the mouse in the units of the picture. Out: initial values, at rest. Never here: the mouse, pictures.

mod descent;
mod mass_matrix;
mod mass_search;
mod rest;

use std::f64::consts::TAU;

use super::Loaded;
use crate::dynamics::common_turn;
use crate::expr::{Expr, Symbol};
use crate::mechanics::{Flow, Valuation};
use crate::model::Shape;
use crate::system::{ChannelKind, InitialOverride};
use mass_matrix::{MassMatrix, is_singular_on_the_way};
use mass_search::MassSearch;
use rest::Rest;

/// A turn is a whole number of periods of the law up to this part of one.
const WHOLE: f64 = 1e-9;

/// What dragging a mass needs of its system, derived once for a drag.
#[derive(Clone, Debug)]
pub(super) struct DraggedMass {
    /// Its place, and the coordinates from which it follows.
    place: [Expr; 2],
    moved: Vec<usize>,
    search: MassSearch,
    masses: MassMatrix,
    rest: Rest,
    /// The initial values given last.
    given: Vec<InitialOverride>,
}

/// The place of a shape if it is a mass that can be dragged, and the coordinates from which it follows: nothing ties these
/// together, and the law has momenta.
pub(super) fn draggable(loaded: &Loaded, shape: &Shape) -> Option<([Expr; 2], Vec<usize>)> {
    let (model, equations) = (&loaded.model, &loaded.equations);
    if !model.constraints.is_empty() || matches!(equations.flow, Flow::Poisson { .. }) {
        return None;
    }
    let Shape::Mass { at: [x, y, Expr::ZERO], .. } = shape else { return None };
    let symbols: Vec<Symbol> = [x, y].iter().flat_map(|e| equations.pool.symbols_of(**e)).collect();
    let is_place = |symbol: &Symbol| equations.coordinates.iter().any(|c| c.position == *symbol);
    let is_known = |symbol: &Symbol| model.parameters.iter().any(|p| p.symbol == *symbol);
    let positions = equations.coordinates.iter().map(|c| c.position).enumerate();
    let moved: Vec<usize> =
        positions.filter(|(_, position)| symbols.contains(position)).map(|(i, _)| i).collect();
    let follows = symbols.iter().all(|symbol| is_place(symbol) || is_known(symbol));
    (follows && !moved.is_empty()).then_some(([*x, *y], moved))
}

/// The symbol of a coordinate.
fn position(loaded: &Loaded, index: usize) -> Symbol {
    loaded.equations.coordinates[index].position
}

impl DraggedMass {
    /// A shape of a system, if it is a mass that can be dragged.
    pub(super) fn of(loaded: &Loaded, shape: &Shape) -> Option<Self> {
        let equations = &loaded.equations;
        let (place, moved) = draggable(loaded, shape)?;
        let coordinates = &equations.coordinates;
        let symbols = moved.iter().map(|i| coordinates[*i].position).collect();
        let momenta: Vec<Symbol> = coordinates.iter().map(|c| c.momentum).collect();
        Some(Self {
            place,
            search: MassSearch::new(equations.pool.clone(), place, symbols),
            masses: MassMatrix::of(&equations.flow, &equations.pool, &momenta),
            rest: Rest::of(equations)?,
            moved,
            given: Vec::new(),
        })
    }

    /// Checks that it can be at rest where it is, with a mass that is finite there.
    ///
    /// # Errors
    /// Returns a sentence that says why it cannot.
    pub(super) fn can_begin(&self, loaded: &Loaded, now: &Valuation) -> Result<(), &'static str> {
        let here: Vec<f64> = self.moved.iter().map(|i| now.at(position(loaded, *i))).collect();
        let Some((here, _)) = self.at_rest(loaded, now, &here) else {
            return Err("It cannot be dragged: no momentum brings it to rest here.");
        };
        if self.masses.determinant(&|symbol| here.at(symbol)).is_infinite() {
            return Err("It cannot be dragged: at rest its mass is infinite.");
        }
        Ok(())
    }

    /// The values at rest with these coordinates at the start, and the momenta.
    fn at_rest(
        &self,
        loaded: &Loaded,
        now: &Valuation,
        places: &[f64],
    ) -> Option<(Valuation, Vec<f64>)> {
        let (model, coordinates) = (&loaded.model, &loaded.equations.coordinates);
        // the motion that begins there begins at the start
        let moved = self.moved.iter().map(|i| position(loaded, *i));
        let here = now
            .clone()
            .with([(model.symbols.time, model.run.start)])
            .with(coordinates.iter().map(|c| (c.velocity, 0.0)))
            .with(moved.zip(places.iter().copied()));
        let momenta = self.rest.momenta(&|symbol| here.at(symbol))?;
        let at_rest = coordinates.iter().map(|c| c.momentum).zip(momenta.iter().copied());
        Some((here.with(at_rest), momenta))
    }

    /// The initial values with which it is at rest at a place in the plane, or as near to it as it can be; the other coordinates stay
    /// as they are now. `None` where there are none, and where the masses become singular on the way.
    pub(super) fn drag_to(
        &mut self,
        loaded: &Loaded,
        now: &Valuation,
        at: [f64; 2],
    ) -> Option<Vec<InitialOverride>> {
        let given = self.placed(loaded, now, at)?;
        self.given.clone_from(&given);
        Some(given)
    }

    fn placed(
        &self,
        loaded: &Loaded,
        now: &Valuation,
        at: [f64; 2],
    ) -> Option<Vec<InitialOverride>> {
        let Self { moved, search, masses, rest, .. } = self;
        let equations = &loaded.equations;
        let positions: Vec<Symbol> = equations.coordinates.iter().map(|c| c.position).collect();
        let before: Vec<f64> = moved.iter().map(|i| now.at(positions[*i])).collect();
        let after = search.nearest(at, before.clone(), &|symbol| now.at(symbol))?;
        let at_rest = |places: &[f64]| self.at_rest(loaded, now, places);
        let determinant = |share: f64| {
            let ways = before.iter().zip(&after).map(|(from, to)| from + share * (to - from));
            let Some((here, _)) = at_rest(&ways.collect::<Vec<_>>()) else { return f64::NAN };
            masses.determinant(&|symbol| here.at(symbol))
        };
        if is_singular_on_the_way(determinant) {
            return None;
        }
        let (here, momenta) = at_rest(&after)?;
        let place = |i: usize| InitialOverride::Position(i, here.at(positions[i]));
        let places = (0..positions.len()).map(place);
        let rates: Vec<InitialOverride> = match rest {
            Rest::Velocities => {
                (0..positions.len()).map(|i| InitialOverride::Velocity(i, 0.0)).collect()
            }
            Rest::Momenta(..) | Rest::Search(_) => {
                let momenta = momenta.into_iter().enumerate();
                momenta.map(|(i, p)| InitialOverride::Momentum(i, p)).collect()
            }
        };
        Some(places.chain(rates).collect())
    }

    /// The initial values at which it was left, with its angles brought back to the turn about zero; `None` if none is beyond it.
    pub(super) fn brought_back(
        &self,
        loaded: &Loaded,
        parameters: &[f64],
    ) -> Option<Vec<InitialOverride>> {
        let back = |given: &InitialOverride| match *given {
            InitialOverride::Position(i, angle) if self.moved.contains(&i) => {
                let turn = self.turn(loaded, parameters, i).unwrap_or(f64::INFINITY);
                // −π is the same as π, which stays
                let turns = (angle / turn - 0.5).ceil();
                let is_there = turns == 0.0;
                InitialOverride::Position(i, if is_there { angle } else { angle - turns * turn })
            }
            given => given,
        };
        let brought: Vec<InitialOverride> = self.given.iter().map(back).collect();
        (brought != self.given).then_some(brought)
    }

    /// The whole turn of a coordinate after which the law, the mass and the events of the system are the same, if it is an angle.
    fn turn(&self, loaded: &Loaded, parameters: &[f64], coordinate: usize) -> Option<f64> {
        let Loaded { model, equations, system, .. } = loaded;
        let channel = loaded.physics().channel(ChannelKind::Position(coordinate))?;
        let turn = system.period(channel, parameters).unwrap_or(TAU);
        let events = model.events.iter().map(|event| event.when);
        let also: Vec<Expr> = self.place.into_iter().chain(events).collect();
        let law = (model.as_ref(), equations.as_ref());
        let periods = turn / common_turn(law, parameters, coordinate, also)?;
        ((periods - periods.round()).abs() <= WHOLE && periods > 0.5).then_some(turn)
    }
}
