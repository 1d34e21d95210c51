//! Questions about one expression or two: is G conserved, and what is \[f, g\]?
//!
//! In: a typed text, a model and its equations. Out: an [`Inquiry`] with its answer, or a syntax
//! error with its place. Never here: where the question is typed or shown; the motion, except for
//! values supplied by the caller.

use crate::cancel::Cancel;
use crate::diagnostic::SourceRange;
use crate::expr::{Expr, Symbol, SyntaxError, Zero};
use crate::mechanics::{
    self, ChainRule, ChartBracket, Class, Equations, NoClosedForm, Recognised, Valuation,
};
use crate::model::{Allowed, Model, Observable, Scope};

/// A question that was understood, and its answer.
#[derive(Clone, Debug)]
pub struct Inquiry {
    /// The equations, extended by the question.
    equations: Equations,
    /// The question and its answer.
    pub answer: InquiryAnswer,
}

/// The answer to a question.
#[derive(Clone, Debug)]
pub enum InquiryAnswer {
    /// The bracket of two expressions.
    Bracket {
        /// \[f, g\] of (q, p, t), or why it is not known in closed form.
        bracket: Result<Expr, NoClosedForm>,
        /// The bracket in terms of names of the file; zero if it vanishes.
        recognised: Option<Recognised>,
        /// Its numerical values, if there is no closed form.
        rule: Option<Box<ChainRule>>,
        /// The bracket in the new variables of each transformation of the file.
        charts: Vec<ChartBracket>,
    },
    /// Whether an expression is conserved.
    Conservation {
        /// Whether it is conserved, and how that is known.
        class: Class,
        /// Its rate of change along the motion.
        rate: Result<Expr, NoClosedForm>,
    },
}

impl Inquiry {
    /// Parses a question, `f, g` or one expression, and answers it. `H` is the energy if the file
    /// does not define that name. The whole may be enclosed in brackets. Once the token is set, the result is meaningless.
    ///
    /// # Errors
    /// Returns an error with its place if the text is not valid.
    pub fn of(
        model: &Model,
        equations: &Equations,
        text: &str,
        cancel: &Cancel,
    ) -> Result<Inquiry, SyntaxError> {
        let mut equations = equations.clone();
        equations.pool.set_cancel(cancel.clone());
        let parts = parts(text);
        let mut read = |(start, part): &(usize, &str)| read(model, &mut equations, *start, part);
        let answer = match parts.as_slice() {
            [one] => {
                let of = read(one)?;
                conservation(model, &mut equations, of)
            }
            [one, other] => {
                let sides = [read(one)?, read(other)?];
                bracket(model, &mut equations, sides)
            }
            more => {
                let (start, part) = more[2];
                let message = "a bracket takes two expressions, and this is a third";
                let span = crate::expr::Span { start, end: start + part.len() };
                return Err(SyntaxError::new(span, message));
            }
        };
        Ok(Inquiry { equations, answer })
    }

    /// An expression of the answer in Unicode mathematics, or in the syntax of files.
    pub fn written(&self, e: Expr, unicode: bool) -> String {
        let pool = &self.equations.pool;
        if unicode { pool.unicode(e) } else { pool.text(e) }
    }

    /// The number of nodes of an expression.
    pub fn weight(&self, e: Expr) -> u64 {
        self.equations.pool.weight(e)
    }

    /// The variables of a chart, as formulas show them.
    pub fn variables(&self, chart: &ChartBracket, unicode: bool) -> String {
        let shown = |&symbol: &Symbol| {
            let info = self.equations.pool.symbol_info(symbol);
            if unicode { info.unicode.clone() } else { info.name.clone() }
        };
        chart.variables.iter().map(shown).collect::<Vec<_>>().join(", ")
    }

    /// The value of the bracket in a chart at a point.
    pub fn value_in(&self, chart: &ChartBracket, at: &Valuation) -> Option<f64> {
        chart.value(&self.equations, at)
    }

    /// The value of the bracket, or of the rate, for these values of the symbols, or `None` if it
    /// has none.
    pub fn value(&self, at: &dyn Fn(Symbol) -> f64) -> Option<f64> {
        let of = |e: Expr| self.equations.value_with_images(e, at);
        match &self.answer {
            InquiryAnswer::Bracket { bracket: Ok(e), .. }
            | InquiryAnswer::Conservation { rate: Ok(e), .. } => of(*e),
            InquiryAnswer::Bracket { rule: Some(rule), .. } => rule.value(&self.equations, at),
            InquiryAnswer::Bracket { .. } | InquiryAnswer::Conservation { .. } => None,
        }
    }
}

/// The parts separated by commas outside parentheses, each with the offset of its first byte.
fn parts(text: &str) -> Vec<(usize, &str)> {
    let trimmed = text.trim();
    let begin = text.len() - text.trim_start().len();
    let bracketed = [('[', ']'), ('{', '}')]
        .iter()
        .any(|(open, close)| trimmed.starts_with(*open) && trimmed.ends_with(*close));
    let (begin, inner) = if bracketed && trimmed.len() >= 2 {
        (begin + 1, &trimmed[1..trimmed.len() - 1])
    } else {
        (begin, trimmed)
    };
    let mut parts = Vec::new();
    let (mut depth, mut start) = (0_usize, 0);
    for (at, character) in inner.char_indices() {
        match character {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            ',' if depth == 0 => {
                parts.push((begin + start, &inner[start..at]));
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push((begin + start, &inner[start..]));
    parts
}

/// Parses one expression, with errors placed in the whole text.
fn read(
    model: &Model,
    equations: &mut Equations,
    start: usize,
    text: &str,
) -> Result<Expr, SyntaxError> {
    let mut scope = Scope::new(model, Allowed::Observable, "an observable");
    let taken = |name: &str| {
        model.parameter(name).is_some()
            || model.coordinate(name).is_some()
            || model.definitions.iter().any(|(defined, _)| defined == name)
            || model.observables.iter().any(|o| o.name == name)
    };
    if !taken("H") {
        scope.define("H", equations.pool.variable(model.symbols.energy));
    }
    if let Some(e) = scope.read(&mut equations.pool, text) {
        return Ok(e);
    }
    let whole = crate::expr::Span { start: 0, end: text.len() };
    let unknown = || SyntaxError::new(whole, "this cannot be read");
    let mut diagnostic = scope.diagnostics.into_iter().next().unwrap_or_else(unknown);
    diagnostic.span.start += start;
    diagnostic.span.end += start;
    Err(diagnostic)
}

fn bracket(model: &Model, equations: &mut Equations, sides: [Expr; 2]) -> InquiryAnswer {
    let [f, g] = sides;
    let bracket = mechanics::bracket(model, equations, f, g);
    let (recognised, rule) = match &bracket {
        Ok(e) => (mechanics::recognise(model, equations, *e), None),
        Err(_) => (None, ChainRule::of(equations, f, g).ok().map(Box::new)),
    };
    let charts = ChartBracket::all(model, equations, sides);
    InquiryAnswer::Bracket { bracket, recognised, rule, charts }
}

fn conservation(model: &Model, equations: &mut Equations, of: Expr) -> InquiryAnswer {
    // treated as if the file declared it
    let name = "what is asked".to_owned();
    let observable = Observable {
        name,
        expression: of,
        conserved: None,
        unit: String::new(),
        place: SourceRange::default(),
    };
    let mut asked = model.clone();
    asked.observables = vec![observable];
    let classed = mechanics::classes(&asked, equations).pop();
    match classed {
        Some(classed) => InquiryAnswer::Conservation { class: classed.class, rate: classed.rate },
        None => InquiryAnswer::Conservation {
            class: Class::Unknown,
            rate: Err(NoClosedForm("it could not be derived".to_owned())),
        },
    }
}

impl InquiryAnswer {
    /// Whether the bracket vanishes, or the expression is conserved, and how that is known.
    pub fn vanishes(&self) -> Zero {
        match self {
            InquiryAnswer::Bracket { recognised: Some(known), .. }
                if known.expression == Expr::ZERO =>
            {
                known.proof
            }
            InquiryAnswer::Bracket { .. } => Zero::No,
            InquiryAnswer::Conservation { class: Class::Proved, .. } => Zero::Proved,
            InquiryAnswer::Conservation { class: Class::Numerically, .. } => Zero::Numerically,
            InquiryAnswer::Conservation {
                class: Class::AtTheseParameters | Class::Unknown,
                ..
            } => Zero::Unknown,
            InquiryAnswer::Conservation { class: Class::Changing, .. } => Zero::No,
        }
    }
}
