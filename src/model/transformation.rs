//! Transformations of phase space, their infinitesimal kin, and a complete integral.

use crate::diagnostic::SourceRange;
use crate::expr::{Expr, Symbol};

/// A transformation (q, p) → (Q, P).
#[derive(Clone, Debug)]
pub struct Transformation {
    /// As written in the file.
    pub name: String,
    /// How it is given.
    pub law: TransformationLaw,
    /// Q and P of each pair, in the order of the coordinates.
    pub new: Vec<[Symbol; 2]>,
    /// The largest entry of |M 𝕁 Mᵀ − 𝕁|, if it has a name.
    pub residual: Option<Symbol>,
    /// The place of its law in the file.
    pub place: SourceRange,
}

/// How a transformation is given.
#[derive(Clone, Debug)]
pub enum TransformationLaw {
    /// By a generating function, of one old and one new variable of each pair, and t.
    Generating {
        /// Which two, for each pair.
        types: Vec<GeneratingType>,
        /// F.
        function: Expr,
    },
    /// By Q(q, p, t) and P(q, p, t).
    Explicit {
        /// Q of each pair.
        positions: Vec<Expr>,
        /// P of each pair.
        momenta: Vec<Expr>,
    },
    /// The inverse of the transformation with this index, which stands before it.
    Inverse(usize),
    /// Those with these indices, which stand before it, one after the other.
    Composition(Vec<usize>),
    /// Several one after the other that cannot be written as one, each with a law of its own.
    Chain(Vec<ChainPart>),
}

/// One of several transformations that are applied one after the other.
#[derive(Clone, Debug)]
pub struct ChainPart {
    /// The transformation.
    pub of: Transformation,
    /// Whether its inverse is applied.
    pub inverted: bool,
}

/// Which variables of a pair a generating function depends on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum GeneratingType {
    /// F1(q, Q): p = ∂F/∂q, P = −∂F/∂Q.
    F1,
    /// F2(q, P): p = ∂F/∂q, Q = ∂F/∂P.
    F2,
    /// F3(p, Q): q = −∂F/∂p, P = −∂F/∂Q.
    F3,
    /// F4(p, P): q = −∂F/∂p, Q = ∂F/∂P.
    F4,
}

impl GeneratingType {
    /// The type of this name.
    pub fn by_name(name: &str) -> Option<GeneratingType> {
        GeneratingType::ALL.into_iter().find(|known| known.name() == name)
    }

    /// All of them.
    pub const ALL: [GeneratingType; 4] =
        [GeneratingType::F1, GeneratingType::F2, GeneratingType::F3, GeneratingType::F4];

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            GeneratingType::F1 => "F1",
            GeneratingType::F2 => "F2",
            GeneratingType::F3 => "F3",
            GeneratingType::F4 => "F4",
        }
    }

    /// Its name as it is shown.
    pub fn shown(self) -> &'static str {
        match self {
            GeneratingType::F1 => "F₁",
            GeneratingType::F2 => "F₂",
            GeneratingType::F3 => "F₃",
            GeneratingType::F4 => "F₄",
        }
    }

    /// Whether F depends on the old coordinate of the pair; else on its momentum.
    pub fn has_position(self) -> bool {
        matches!(self, GeneratingType::F1 | GeneratingType::F2)
    }

    /// Whether F depends on the new coordinate of the pair; else on its momentum.
    pub fn has_new_position(self) -> bool {
        matches!(self, GeneratingType::F1 | GeneratingType::F3)
    }
}

/// The generator of an infinitesimal transformation.
#[derive(Clone, Debug)]
pub struct Generator {
    /// As written in the file.
    pub name: String,
    /// G, in q, p (or q̇), t and `energy`.
    pub expression: Expr,
}

/// A solution S(q, α, t) of the Hamilton–Jacobi equation that a file calls complete.
#[derive(Clone, Debug)]
pub struct CompleteIntegral {
    /// S.
    pub function: Expr,
    /// Its constants.
    pub constants: Vec<IntegralConstant>,
    /// The place of S in the file.
    pub place: SourceRange,
}

/// A constant of a complete integral.
#[derive(Clone, Debug)]
pub struct IntegralConstant {
    /// As the file calls it.
    pub name: String,
    /// α.
    pub symbol: Symbol,
    /// β = ∂S/∂α, written `beta_<name>`.
    pub conjugate: Symbol,
}
