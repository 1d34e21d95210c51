//! Mathematics as the reader's terminal can show it.

use crate::expr::{Expr, Pool, Symbol};
use crate::view::glyphs::Glyphs;

/// The script that the reader's terminal can show.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum MathScript {
    /// `θ″ = −(g/l) sin θ`, with the primes of the screen and of files.
    Unicode,
    /// `theta'' = -(g/l)*sin(theta)`.
    Ascii,
}

impl MathScript {
    pub(super) fn of_locale() -> MathScript {
        let glyphs = Glyphs::from_environment(&|name| std::env::var(name).ok());
        if glyphs.is_ascii() { MathScript::Ascii } else { MathScript::Unicode }
    }

    pub(super) fn math(self, pool: &Pool, e: Expr) -> String {
        match self {
            MathScript::Unicode => primed(&pool.unicode(e)),
            MathScript::Ascii => pool.ascii(e),
        }
    }

    pub(super) fn symbol(self, pool: &Pool, symbol: Symbol) -> String {
        let info = pool.symbol_info(symbol);
        match self {
            MathScript::Unicode => primed(&info.unicode),
            MathScript::Ascii => info.name.clone(),
        }
    }

    pub(super) fn words(self, text: &str) -> String {
        match self {
            MathScript::Unicode => text.to_owned(),
            MathScript::Ascii => Glyphs::Ascii.text(text).into_owned(),
        }
    }
}

/// Formulas with a prime for each dot above a letter.
fn primed(formula: &str) -> String {
    Glyphs::Braille.text(formula).into_owned()
}
