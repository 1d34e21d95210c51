//! Expressions in LaTeX: `\frac{1}{2} m l^{2} \dot\theta^{2}`.

use super::node::{Expr, FunctionId, Node};
use super::pool::Pool;
use super::print::{BindingStrength, PrintedPiece, Printer, Style};
use crate::num::Number;

impl Pool {
    /// The expression in LaTeX, for math mode.
    pub fn latex(&self, e: Expr) -> String {
        self.in_textbook_form(e, |pool, e| Printer { pool, style: &Latex }.piece(e).text)
    }
}

struct Latex;

impl Style for Latex {
    fn symbol<'p>(&self, pool: &'p Pool, e: Expr) -> &'p str {
        pool.as_symbol(e).map_or("", |s| &pool.symbol_info(s).latex)
    }

    fn pi(&self) -> &'static str {
        "\\pi"
    }

    fn minus(&self) -> &'static str {
        "-"
    }

    fn number(&self, n: Number) -> PrintedPiece {
        let text = match n {
            Number::Rational(n, 1) => n.to_string(),
            Number::Rational(n, d) => format!("\\frac{{{n}}}{{{d}}}"),
            Number::Real(x) => match format!("{x:?}").split_once('e') {
                Some((mantissa, exponent)) => format!("{mantissa}\\cdot 10^{{{exponent}}}"),
                None => format!("{x:?}"),
            },
        };
        PrintedPiece { text, level: BindingStrength::Atom }
    }

    fn parenthesise(&self, inner: &str) -> String {
        format!("\\left({inner}\\right)")
    }

    fn join(&self, factors: &[String]) -> String {
        factors.join(" ")
    }

    fn fraction(&self, above: &PrintedPiece, below: &PrintedPiece) -> PrintedPiece {
        let text = format!("\\frac{{{}}}{{{}}}", above.text, below.text);
        PrintedPiece { text, level: BindingStrength::Power }
    }

    fn numeric_power(&self, printer: &Printer<'_>, base: Expr, exponent: Number) -> PrintedPiece {
        if exponent == Number::HALF {
            let text = format!("\\sqrt{{{}}}", printer.piece(base).text);
            return PrintedPiece { text, level: BindingStrength::Atom };
        }
        if let (Node::Call(function, arguments), Some(n)) =
            (printer.pool.node(base), exponent.as_integer())
            && function.row().arity == 1
            && *function != FunctionId::Abs
        {
            let name = format!("{}^{{{n}}}", function.row().latex);
            return applied(printer, &name, arguments[0]);
        }
        // a dotted symbol takes an exponent directly; a power or a fraction needs parentheses
        let (power, exponent) = (exponent, self.number(exponent));
        self.power(&printer.raised(base, power), &exponent)
    }

    fn power(&self, base: &str, exponent: &PrintedPiece) -> PrintedPiece {
        PrintedPiece {
            text: format!("{{{base}}}^{{{}}}", exponent.text),
            level: BindingStrength::Power,
        }
    }

    fn call(
        &self,
        printer: &Printer<'_>,
        function: FunctionId,
        arguments: &[Expr],
    ) -> PrintedPiece {
        if let ([argument], false) =
            (arguments, matches!(function, FunctionId::Abs | FunctionId::Exp))
        {
            return applied(printer, function.row().latex, *argument);
        }
        let inner: Vec<String> = arguments.iter().map(|&a| printer.piece(a).text).collect();
        let text = match function {
            FunctionId::Abs => format!("\\left|{}\\right|", inner[0]),
            FunctionId::Exp => {
                return PrintedPiece {
                    text: format!("e^{{{}}}", inner[0]),
                    level: BindingStrength::Power,
                };
            }
            _ => format!("{}\\left({}\\right)", function.row().latex, inner.join(", ")),
        };
        PrintedPiece { text, level: BindingStrength::Atom }
    }

    fn coefficient_in_front(&self, n: Number, has_denominator: bool) -> bool {
        !has_denominator && matches!(n, Number::Rational(_, d) if d != 1)
    }
}

/// `\sin \theta`, `\sin\left(2 \theta\right)`.
fn applied(printer: &Printer<'_>, name: &str, argument: Expr) -> PrintedPiece {
    let inner = printer.piece(argument).text;
    let text = if printer.pool.as_symbol(argument).is_some() && name.starts_with('\\') {
        format!("{name} {inner}")
    } else {
        format!("{name}\\left({inner}\\right)")
    };
    PrintedPiece { text, level: BindingStrength::Power }
}
