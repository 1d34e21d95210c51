//! The kinds of quantities that a place in a file may use, and the error message for each of the
//! others.

/// The quantities allowed at a place.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Allowed {
    /// Parameters only: initial values, periods, the times of impulses.
    Parameters,
    /// Parameters, but nothing derived from a body: the pieces of the body.
    Pieces,
    /// q, t, parameters: the angle and origin of a frame, Euler's angles.
    Configuration,
    /// q, q̇, t, parameters: a Lagrangian, Rayleigh's function, and forces, constraints and
    /// impulses of a Lagrangian system.
    Lagrangian,
    /// q, p, t, parameters: a Hamiltonian, and forces and impulses of a Hamiltonian system.
    Hamiltonian,
    /// The variables, t, parameters: H, brackets, forces and impulses of a Poisson system.
    Poisson,
    /// The variables and parameters: a Casimir.
    Casimir,
    /// q, q̇, p, t, parameters, `energy`: the two sides of a bracket.
    Bracket,
    /// q, p, t, parameters and new variables: a generating function, an explicit transformation.
    Transformation,
    /// Everything an observable may use except the comparison motion: the expression of an event.
    Event,
    /// Everything, including q̈, λ, `energy` and `action`: observables, views, shapes,
    /// expectations.
    Observable,
}

/// The role of a symbol in mechanics. Parameters and other constants are not listed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum SymbolRole {
    Time,
    Position,
    Velocity,
    Acceleration,
    Momentum,
    Energy,
    Action,
    /// λ of a constraint.
    Multiplier,
    /// A moment of inertia, mass or position that follows from the pieces of a body; constant like
    /// a parameter.
    Inertia,
    /// An entry of the matrix of a body's attitude.
    Attitude,
    /// A coordinate or velocity of the comparison motion.
    Other,
    /// A new variable of a transformation of the file.
    New,
}

impl Allowed {
    /// Why a place, which messages call `place`, may not use a kind of quantity, or `None` if it
    /// may.
    pub(super) fn objection(self, kind: SymbolRole, place: &str) -> Option<String> {
        use Allowed::{
            Bracket, Casimir, Configuration, Event, Hamiltonian, Lagrangian, Observable,
            Parameters, Pieces, Poisson, Transformation,
        };
        use SymbolRole::{Action, Energy, Inertia, Momentum, New, Other, Position, Time, Velocity};
        Some(match (self, kind) {
            (Event, Other) => format!("{place} refers to the right motion only"),
            (Observable | Event, _)
            | (Configuration | Poisson, Time | Position)
            | (Lagrangian, Time | Position | Velocity)
            | (Hamiltonian, Time | Position | Momentum)
            | (Transformation, Time | Position | Momentum | New)
            | (Casimir, Position)
            | (Bracket, Time | Position | Velocity | Momentum | Energy | New) => return None,
            (Pieces, Inertia) => format!("{place} comes before what follows from the body"),
            (_, Inertia) => return None,
            (Parameters | Pieces, _) => format!("{place} is made of parameters only"),
            (Bracket, _) => format!("{place} is a function of q, p and t"),
            (_, Energy | Action) => {
                format!("{place} comes before energy and action, which follow from it")
            }
            (Transformation, _) => format!("{place} is a function of q, p, t and new variables"),
            (Configuration, _) => format!("{place} is a function of q and t"),
            (Hamiltonian, _) => format!("{place} is a function of q, p and t"),
            (Lagrangian, _) => format!("{place} is a function of q, q' and t"),
            (Poisson, _) => format!("{place} is a function of the variables and t"),
            (Casimir, _) => format!("{place} is a function of the variables alone"),
        })
    }
}
