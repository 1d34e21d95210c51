//! Expressions in the syntax of preset files, which parse back to the same expression.

use super::node::{Expr, FunctionId};
use super::pool::Pool;
use super::print::{BindingStrength, PrintedPiece, Printer, Style};
use crate::num::Number;

impl Pool {
    /// The expression as a textbook writes it, in the syntax of preset files.
    pub fn ascii(&self, e: Expr) -> String {
        self.in_textbook_form(e, |pool, e| {
            Printer { pool, style: &Text { textbook: true } }.piece(e).text
        })
    }

    /// The expression in the syntax of preset files, which parses back to the same expression.
    pub fn text(&self, e: Expr) -> String {
        Printer { pool: self, style: &Text { textbook: false } }.piece(e).text
    }
}

/// The syntax of files, ordered as in a textbook or by handles.
struct Text {
    textbook: bool,
}

impl Style for Text {
    fn symbol<'p>(&self, pool: &'p Pool, e: Expr) -> &'p str {
        pool.as_symbol(e).map_or("", |s| &pool.symbol_info(s).name)
    }

    fn pi(&self) -> &'static str {
        "pi"
    }

    fn minus(&self) -> &'static str {
        "-"
    }

    fn number(&self, n: Number) -> PrintedPiece {
        match n {
            Number::Rational(n, 1) => {
                PrintedPiece { text: n.to_string(), level: BindingStrength::Atom }
            }
            Number::Rational(n, d) => {
                PrintedPiece { text: format!("{n}/{d}"), level: BindingStrength::Product }
            }
            Number::Real(x) => {
                PrintedPiece { text: format!("{x:?}"), level: BindingStrength::Atom }
            }
        }
    }

    fn parenthesise(&self, inner: &str) -> String {
        format!("({inner})")
    }

    fn join(&self, factors: &[String]) -> String {
        factors.join("*")
    }

    fn numeric_power(&self, printer: &Printer<'_>, base: Expr, exponent: Number) -> PrintedPiece {
        if exponent == Number::HALF {
            let inner = printer.piece(base).text;
            return PrintedPiece { text: format!("sqrt({inner})"), level: BindingStrength::Atom };
        }
        let (power, exponent) = (exponent, self.number(exponent));
        self.power(&printer.raised(base, power), &exponent)
    }

    fn call(
        &self,
        printer: &Printer<'_>,
        function: FunctionId,
        arguments: &[Expr],
    ) -> PrintedPiece {
        let arguments: Vec<String> = arguments.iter().map(|&a| printer.piece(a).text).collect();
        let text = format!("{}({})", function.row().name, arguments.join(", "));
        PrintedPiece { text, level: BindingStrength::Atom }
    }

    fn coefficient_in_front(&self, n: Number, has_denominator: bool) -> bool {
        !(self.textbook && has_denominator) && matches!(n, Number::Rational(1, d) if d != 1)
    }

    fn textbook(&self) -> bool {
        self.textbook
    }

    fn constants_apart(&self) -> bool {
        self.textbook
    }
}
