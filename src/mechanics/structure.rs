//! What is known of the structure of a system: of each constraint whether it is holonomic, and whether Hamilton–Jacobi
//! separates.
//!
//! Never here: how it is determined (`frobenius`, `separation`).

use crate::expr::{Expr, Symbol};

/// Whether a constraint is holonomic.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Holonomy {
    /// It is given as a relation between the coordinates and the time.
    Given,
    /// It follows from such a relation, proved.
    Holonomic {
        /// What is constant, where it is found: a function of the coordinates and the time.
        constant: Option<Expr>,
        /// Whether the other constraints are needed for it.
        together: bool,
        /// Whether it is so at the file's values of the parameters only.
        at_these_parameters: bool,
    },
    /// There is no such relation, proved by a component of dω_β ∧ ω_1 ∧ … ∧ ω_m that does not vanish.
    Not {
        /// The variables of the component.
        variables: Vec<Symbol>,
        /// The one that does not vanish.
        component: Expr,
    },
    /// Neither is proved.
    Unknown,
}

impl Holonomy {
    /// Yes or no, where either is proved.
    pub fn answer(&self) -> Option<bool> {
        match self {
            Holonomy::Given | Holonomy::Holonomic { .. } => Some(true),
            Holonomy::Not { .. } => Some(false),
            Holonomy::Unknown => None,
        }
    }
}

/// Whether Hamilton–Jacobi separates.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Separation {
    /// It does: Levi-Civita's conditions are proved.
    Separates {
        /// Whether it does so at the file's values of the parameters only.
        at_these_parameters: bool,
    },
    /// It does not: the condition of these two coordinates does not hold.
    Not(Symbol, Symbol),
    /// Neither is proved, or it is no question, for this reason.
    Unknown(String),
}

impl Separation {
    /// Yes or no, where either is proved.
    pub fn answer(&self) -> Option<bool> {
        match self {
            Separation::Separates { .. } => Some(true),
            Separation::Not(..) => Some(false),
            Separation::Unknown(_) => None,
        }
    }
}
