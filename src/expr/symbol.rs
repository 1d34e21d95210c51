//! Names in a pool: how a symbol is written in a file, on a screen and in LaTeX, and where it
//! stands among the factors of a product. What a name *means* is not known here.

/// An interned name.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Symbol(pub(super) u32);

impl Symbol {
    /// The place of the symbol in its pool, counted from 0 in order of introduction.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// Where a symbol stands among the factors of a printed product (constants before variables before
/// their rates, as in `½ m l² θ̇²`) and among the terms of a sum (rates first: kinetic before
/// potential).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Default)]
pub enum Rank {
    /// A parameter.
    #[default]
    Constant,
    /// Time or a coordinate.
    Variable,
    /// A momentum.
    Momentum,
    /// A velocity or an acceleration.
    Rate,
}

/// What a pool keeps of a symbol.
#[derive(Clone, Debug)]
pub struct SymbolInfo {
    /// As written in a file: `theta'`.
    pub name: String,
    /// As shown on a screen: `θ̇`.
    pub unicode: String,
    /// As typeset: `\dot\theta`.
    pub latex: String,
    /// Its place among factors.
    pub rank: Rank,
}
