//! A generalised coordinate with its four symbols.

use crate::diagnostic::SourceRange;
use crate::expr::{Expr, Pool, Rank, Symbol, latex_of_unicode, unicode_name};

/// A generalised coordinate.
#[derive(Clone, Debug)]
pub struct Coordinate {
    /// As written in expressions: `theta`.
    pub name: String,
    /// As shown: `θ`.
    pub shown: String,
    /// Its unit, empty if none is given.
    pub unit: String,
    /// q.
    pub position: Symbol,
    /// q̇, written `theta'`.
    pub velocity: Symbol,
    /// q̈, written `theta''`; it may be used in observables only.
    pub acceleration: Symbol,
    /// The momentum conjugate to it, written `p_theta`.
    pub momentum: Symbol,
    /// The initial value, in terms of parameters.
    pub initial: Expr,
    /// The initial velocity (Lagrangian) or momentum (Hamiltonian), in terms of parameters; zero if
    /// the file omits it.
    pub initial_rate: Expr,
    /// Whether the file gives the initial rate; under constraints an omitted velocity is solved
    /// for.
    pub rate_given: bool,
    /// The period of the coordinate, in terms of parameters; for drawing only.
    pub period: Option<Expr>,
    /// The place of its name in the file.
    pub place: SourceRange,
}

impl Coordinate {
    /// Creates a coordinate with initial values zero and introduces its four symbols into the pool.
    /// `shown` is the symbol the file gives; if it is empty, the symbol follows from the name.
    pub fn new(pool: &mut Pool, name: &str, shown: &str, unit: &str) -> Coordinate {
        Coordinate::introduce(pool, name, shown, unit, &format!("p_{name}"))
    }

    /// Creates a variable of a Poisson system. It has no momentum: the symbol in that place has a
    /// name that no file can write, so a variable may be called `p_x` beside one called `x`.
    pub fn variable(pool: &mut Pool, name: &str, shown: &str, unit: &str) -> Coordinate {
        Coordinate::introduce(pool, name, shown, unit, &format!("no momentum of {name}"))
    }

    fn introduce(
        pool: &mut Pool,
        name: &str,
        shown: &str,
        unit: &str,
        momentum: &str,
    ) -> Coordinate {
        let shown = if shown.is_empty() { unicode_name(name) } else { shown.to_owned() };
        let latex = latex_of_unicode(&shown);
        let mut introduce = |written: String, unicode: String, latex: String, rank| {
            let symbol = pool.symbol(&written);
            pool.describe(symbol, &unicode, &latex, rank);
            symbol
        };
        let position = introduce(name.to_owned(), shown.clone(), latex.clone(), Rank::Variable);
        let velocity = introduce(
            format!("{name}'"),
            format!("{shown}′"),
            format!("\\dot{{{latex}}}"),
            Rank::Rate,
        );
        let acceleration = introduce(
            format!("{name}''"),
            format!("{shown}″"),
            format!("\\ddot{{{latex}}}"),
            Rank::Rate,
        );
        let momentum = introduce(
            momentum.to_owned(),
            format!("p{}", subscript(&shown)),
            format!("p_{{{latex}}}"),
            Rank::Momentum,
        );
        Coordinate {
            name: name.to_owned(),
            shown,
            unit: unit.to_owned(),
            position,
            velocity,
            acceleration,
            momentum,
            initial: Expr::ZERO,
            initial_rate: Expr::ZERO,
            rate_given: false,
            period: None,
            place: 0..0,
        }
    }
}

/// The subscript of a momentum: below the line where it is a number.
fn subscript(shown: &str) -> String {
    let number = shown.chars().all(|c| ('₀'..='₉').contains(&c));
    if number { shown.to_owned() } else { format!("_{shown}") }
}
