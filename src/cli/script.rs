//! Mathematics as the reader's terminal can show it.

use crate::expr::{Expr, Pool, Symbol};
use crate::view::glyphs::Glyphs;

/// The script that the reader's terminal can show.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Script {
    /// `θ̈ = −(g/l) sin θ`.
    Unicode,
    /// `theta'' = -g*sin(theta)/l`.
    Ascii,
}

impl Script {
    /// The script of the locale.
    pub(super) fn of_locale() -> Script {
        let glyphs = Glyphs::from_environment(&|name| std::env::var(name).ok());
        if glyphs.is_ascii() { Script::Ascii } else { Script::Unicode }
    }

    /// Formats an expression.
    pub(super) fn math(self, pool: &Pool, e: Expr) -> String {
        match self {
            Script::Unicode => pool.unicode(e),
            Script::Ascii => pool.ascii(e),
        }
    }

    /// Formats a symbol.
    pub(super) fn symbol(self, pool: &Pool, symbol: Symbol) -> String {
        let info = pool.symbol_info(symbol);
        match self {
            Script::Unicode => info.unicode.clone(),
            Script::Ascii => info.name.clone(),
        }
    }

    /// Formats text.
    pub(super) fn words(self, text: &str) -> String {
        match self {
            Script::Unicode => text.to_owned(),
            Script::Ascii => Glyphs::Ascii.text(text).into_owned(),
        }
    }
}
