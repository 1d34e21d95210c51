//! What kinds of quantities a place in a file may use, and the sentence for each that it may not.

/// What may be used where.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Allowed {
    /// Parameters only: initial values, periods, the times of impulses.
    Parameters,
    /// Parameters, but nothing that follows from a body: what the body is made of.
    Pieces,
    /// q, t, parameters: how a frame turns, Euler's angles.
    Configuration,
    /// q, q̇, t, parameters: a Lagrangian, Rayleigh's function, forces, constraints and impulses
    /// beside a Lagrangian.
    Lagrangian,
    /// q, p, t, parameters: a Hamiltonian, forces and impulses beside it.
    Hamiltonian,
    /// The variables, t, parameters: the H of brackets, the brackets, forces and impulses.
    Poisson,
    /// The variables and parameters: a Casimir.
    Casimir,
    /// q, q̇, p, t, parameters, `energy`: the two sides of a bracket.
    Bracket,
    /// All that an observable may use but the other motion of a comparison: what an event watches.
    Event,
    /// All of it and q̈, λ, `energy`, `action`: observables, views, shapes, expectations.
    Observable,
}

/// What a symbol is to mechanics. Parameters, and whatever else is constant, are not listed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    Time,
    Position,
    Velocity,
    Acceleration,
    Momentum,
    Energy,
    Action,
    /// λ of a constraint.
    Multiplier,
    /// A moment, mass or place that follows from the pieces of a body: constant as a parameter is.
    Inertia,
    /// An entry of the matrix of a body's attitude.
    Attitude,
    /// A coordinate or velocity of the other motion of a comparison.
    Other,
}

impl Allowed {
    /// Why a place, called so in messages, may not use a quantity of some kind, if it may not.
    pub(super) fn refusal(self, kind: Kind, place: &str) -> Option<String> {
        use Allowed::{
            Bracket, Casimir, Configuration, Event, Hamiltonian, Lagrangian, Observable,
            Parameters, Pieces, Poisson,
        };
        use Kind::{Action, Energy, Inertia, Momentum, Other, Position, Time, Velocity};
        Some(match (self, kind) {
            (Event, Other) => format!("{place} watches the right motion alone"),
            (Observable | Event, _)
            | (Configuration | Poisson, Time | Position)
            | (Lagrangian, Time | Position | Velocity)
            | (Hamiltonian, Time | Position | Momentum)
            | (Casimir, Position)
            | (Bracket, Time | Position | Velocity | Momentum | Energy) => return None,
            (Pieces, Inertia) => format!("{place} stands before what follows from the body"),
            (_, Inertia) => return None,
            (Parameters | Pieces, _) => format!("{place} is made of parameters only"),
            (Bracket, _) => format!("{place} is a function of q, p and t"),
            (_, Energy | Action) => {
                format!("{place} stands before energy and action, which follow from it")
            }
            (Configuration, _) => format!("{place} is a function of q and t"),
            (Hamiltonian, _) => format!("{place} is a function of q, p and t"),
            (Lagrangian, _) => format!("{place} is a function of q, q' and t"),
            (Poisson, _) => format!("{place} is a function of the variables and t"),
            (Casimir, _) => format!("{place} is a function of the variables alone"),
        })
    }
}
