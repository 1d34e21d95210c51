//! Names in a pool: the notation of a symbol in a file, in Unicode and in LaTeX, and its rank among
//! the factors of a product. The *meaning* of a name is not known here.

/// An interned name.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Symbol(pub(super) u32);

impl Symbol {
    /// The index of the symbol in its pool, counted from 0 in order of introduction.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The rank of a symbol among the factors of a printed product (constants before variables before
/// their rates, as in `½ m l² θ̇²`) and among the terms of a sum (rates first: kinetic before
/// potential).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Default)]
pub enum Rank {
    /// A parameter.
    #[default]
    Constant,
    /// Time or a coordinate.
    Variable,
    /// After coordinates, before velocities.
    Momentum,
    /// A velocity or an acceleration.
    Rate,
}

/// The notation of a symbol.
#[derive(Clone, Debug)]
pub struct SymbolInfo {
    /// Its name in a file: `theta'`.
    pub name: String,
    /// Its Unicode notation: `θ̇`.
    pub unicode: String,
    /// Its LaTeX notation: `\dot\theta`.
    pub latex: String,
    /// Its rank among factors.
    pub rank: Rank,
}
