//! Expressions in Unicode notation: `½ m l² θ̇² + m g l cos θ`.

use super::function::FUNCTIONS;
use super::node::{Expr, FunctionId, Node};
use super::notation::{FRACTIONS, RAISED_N, raised_digit, superscript};
use super::pool::Pool;
use super::print::{BindingStrength, PrintedPiece, Printer, Style};
use crate::num::Number;

impl Pool {
    /// The expression in Unicode mathematics.
    pub fn unicode(&self, e: Expr) -> String {
        self.in_textbook_form(e, |pool, e| Printer { pool, style: &Unicode }.piece(e).text)
    }

    /// A text from a file with its names and powers as they are shown, a minus sign and a dot between them, otherwise as it
    /// is: `theta1 - k*theta2^2` → `θ₁ − k·θ₂²`.
    pub fn with_shown_names(&self, text: &str) -> String {
        let of_name = |c: char| c.is_alphanumeric() || c == '_';
        let mut shown = String::new();
        let mut rest = text;
        while let Some(first) = rest.chars().next() {
            let letters = rest.find(|c| !of_name(c)).unwrap_or(rest.len());
            let primes = rest[letters..].len() - rest[letters..].trim_start_matches('\'').len();
            let (word, after) = match letters {
                0 => rest.split_at(first.len_utf8()),
                _ => rest.split_at(letters + primes),
            };
            let exponent = shown.ends_with(['e', 'E']) && last_is_number(&shown);
            match (first, self.find_symbol(word)) {
                ('-', _) if !exponent => shown.push('−'),
                ('*', _) => shown.push('·'),
                ('^', _) => {
                    let (raised, after) = raised_power(after);
                    shown.push_str(&raised);
                    rest = after;
                    continue;
                }
                (_, Some(symbol)) => shown.push_str(&self.symbol_info(symbol).unicode),
                (_, None) => shown.push_str(word),
            }
            rest = after;
        }
        shown
    }
}

/// The power that a text begins with after its sign, above the line where it can be, and the rest.
fn raised_power(text: &str) -> (String, &str) {
    let sign = text.len() - text.strip_prefix('-').unwrap_or(text).len();
    let word = text[sign..].find(|c: char| !(c.is_alphanumeric() || c == '_' || c == '.'));
    let (power, rest) = text.split_at(word.map_or(text.len(), |end| sign + end));
    match power.parse() {
        // a tower has one power above the line, and what is above that is lost
        _ if rest.starts_with('^') => ("^".to_owned(), text),
        Ok(n) => (superscript(n), rest),
        Err(_) if power == "n" => (RAISED_N.to_string(), rest),
        Err(_) => ("^".to_owned(), text),
    }
}

/// Whether the last word of a text begins with a digit: `2*1e` of `2*1e-3`.
fn last_is_number(text: &str) -> bool {
    let word = text.rsplit(|c: char| !c.is_alphanumeric() && c != '_').next();
    word.is_some_and(|word| word.starts_with(|c: char| c.is_ascii_digit()))
}

struct Unicode;

fn glyph(n: Number) -> Option<char> {
    let Number::Rational(n, d) = n else { return None };
    FRACTIONS.iter().find(|f| (f.0, f.1) == (n, d)).map(|f| f.2)
}

impl Style for Unicode {
    fn symbol<'p>(&self, pool: &'p Pool, e: Expr) -> &'p str {
        pool.as_symbol(e).map_or("", |s| &pool.symbol_info(s).unicode)
    }

    fn pi(&self) -> &'static str {
        "π"
    }

    fn minus(&self) -> &'static str {
        "−"
    }

    fn number(&self, n: Number) -> PrintedPiece {
        if let Some(glyph) = glyph(n) {
            return PrintedPiece { text: glyph.to_string(), level: BindingStrength::Atom };
        }
        match n {
            Number::Rational(n, 1) => {
                PrintedPiece { text: n.to_string(), level: BindingStrength::Atom }
            }
            Number::Rational(_, d) if is_decimal(d) => {
                PrintedPiece { text: n.value().to_string(), level: BindingStrength::Atom }
            }
            Number::Rational(n, d) => {
                PrintedPiece { text: format!("{n}/{d}"), level: BindingStrength::Product }
            }
            Number::Real(x) => PrintedPiece { text: scientific(x), level: BindingStrength::Atom },
        }
    }

    fn parenthesise(&self, inner: &str) -> String {
        format!("({inner})")
    }

    /// One piece over another: sin θ/l. Over a number or a function, a function without parentheses has some around it:
    /// (sin θ)/7.
    fn fraction(&self, above: &PrintedPiece, below: &PrintedPiece) -> PrintedPiece {
        let wrap = |piece: &PrintedPiece, wrapped| {
            if wrapped { self.parenthesise(&piece.text) } else { piece.text.clone() }
        };
        let name = below.text.starts_with(char::is_alphabetic) && !below.text.contains(' ');
        let bare = below.level >= BindingStrength::Power && !name && ends_bare(&above.text);
        let above = wrap(above, above.level < BindingStrength::Product || bare);
        let text = format!("{above}/{}", wrap(below, below.level < BindingStrength::Power));
        PrintedPiece { text, level: BindingStrength::Product }
    }

    /// Factors with a space between them, or a dot before one that begins with a digit: 40·2ⁿ.
    fn join(&self, factors: &[String]) -> String {
        let mut text = String::new();
        for factor in factors {
            match factor.starts_with(|c: char| c.is_ascii_digit()) {
                _ if text.is_empty() => {}
                true => text.push('·'),
                false => text.push(' '),
            }
            text.push_str(factor);
        }
        text
    }

    fn power(&self, base: &str, exponent: &PrintedPiece) -> PrintedPiece {
        let text = match exponent.level {
            BindingStrength::Atom if exponent.text == "n" => format!("{base}{RAISED_N}"),
            BindingStrength::Atom => format!("{base}^{}", exponent.text),
            _ => format!("{base}^{}", self.parenthesise(&exponent.text)),
        };
        PrintedPiece { text, level: BindingStrength::Power }
    }

    fn numeric_power(&self, printer: &Printer<'_>, base: Expr, exponent: Number) -> PrintedPiece {
        if exponent == Number::HALF {
            let text = format!("√{}", printer.at_least(base, BindingStrength::Atom));
            return PrintedPiece { text, level: BindingStrength::Power };
        }
        let Some(n) = exponent.as_integer() else {
            let exponent = self.number(exponent);
            return self.power(&printer.at_least(base, BindingStrength::Atom), &exponent);
        };
        if let Node::Call(function, arguments) = printer.pool.node(base)
            && function.row().arity == 1
            && *function != FunctionId::Abs
        {
            let name = format!("{}{}", function.row().unicode, superscript(n));
            return applied(printer, &name, arguments[0]);
        }
        let text = format!("{}{}", printer.raised(base, exponent), superscript(n));
        PrintedPiece { text, level: BindingStrength::Power }
    }

    fn call(
        &self,
        printer: &Printer<'_>,
        function: FunctionId,
        arguments: &[Expr],
    ) -> PrintedPiece {
        if function == FunctionId::Abs {
            let inner = printer.piece(arguments[0]).text;
            // nested bars could open or close
            let text =
                if inner.contains('|') { format!("abs({inner})") } else { format!("|{inner}|") };
            return PrintedPiece { text, level: BindingStrength::Atom };
        }
        if function == FunctionId::Exp && !printer.pool.shows("e") {
            return self.power("e", &printer.piece(arguments[0]));
        }
        if let [argument] = arguments {
            return applied(printer, function.row().unicode, *argument);
        }
        let arguments: Vec<String> = arguments.iter().map(|&a| printer.piece(a).text).collect();
        let text = format!("{}({})", function.row().unicode, arguments.join(", "));
        PrintedPiece { text, level: BindingStrength::Atom }
    }

    fn coefficient_in_front(&self, n: Number, has_denominator: bool) -> bool {
        matches!(n, Number::Rational(_, d) if is_decimal(d))
            || !has_denominator && glyph(n).is_some()
    }
}

/// Returns whether a text ends in a function without parentheses.
fn ends_bare(text: &str) -> bool {
    let mut words = text.rsplit(' ');
    let argument = words.next().unwrap_or_default();
    let function = words.next().unwrap_or_default();
    let function = function.trim_end_matches(|c| raised_digit(c).is_some());
    let function = function.trim_start_matches('−');
    !argument.ends_with([')', '|']) && FUNCTIONS.iter().any(|row| row.unicode == function)
}

/// `sin θ`, `sin(2 θ)`.
fn applied(printer: &Printer<'_>, name: &str, argument: Expr) -> PrintedPiece {
    let inner = printer.piece(argument);
    if inner.level == BindingStrength::Atom && !inner.text.contains(' ') {
        PrintedPiece { text: format!("{name} {}", inner.text), level: BindingStrength::Power }
    } else {
        PrintedPiece { text: format!("{name}({})", inner.text), level: BindingStrength::Atom }
    }
}

/// Returns whether 1/d is a short decimal that reads better than a fraction: 9.81, not 981/100.
fn is_decimal(d: i64) -> bool {
    d > 8 && 1_000_000 % d == 0
}

/// A real with its exponent as a power of ten.
fn scientific(x: f64) -> String {
    let text = format!("{x:?}");
    match text.split_once('e') {
        Some((mantissa, exponent)) => match exponent.parse() {
            Ok(n) => format!("{mantissa}·10{}", superscript(n)),
            Err(_) => text,
        },
        None => text,
    }
}
