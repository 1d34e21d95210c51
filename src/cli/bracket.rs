//! `phaselab bracket`: the Poisson bracket of any two expressions.

use std::ffi::OsString;

use serde_json::{Value, json};

use super::assignment::{self, Assignment};
use super::error::CommandError;
use super::format::Format;
use super::open;
use super::output::Output;
use super::script::MathScript;
use crate::experiment::Derived;
use crate::expr::{Expr, Symbol, Zero};
use crate::mechanics::{
    self, ChainRule, ChartBracket, Equations, NoClosedForm, Recognised, Valuation,
};
use crate::model::{Model, WrittenExpr};
use crate::num::shortest;
use crate::system::{ChannelKind, InitialOverride, System};

/// Compute the Poisson bracket of two expressions.
///
/// [F, G] = Σ ∂F/∂q ∂G/∂p − ∂F/∂p ∂G/∂q, or ∇F · B ∇G where the file gives the brackets B of its
/// variables; symbolically, and its value at the start. F and G may use whatever an observable
/// may; H is the energy. Where the file has transformations, the same bracket follows in the new variables of each: it
/// is equal where the map is canonical. Constraints are ignored.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  phaselab bracket planet p_theta energy
  phaselab bracket spherical-pendulum \"theta'\" \"phi'\" --init theta=1 --format json")]
pub(super) struct Arguments {
    /// A preset's name, or a file.
    #[arg(value_name = "PRESET|FILE")]
    name: OsString,
    /// The first expression.
    #[arg(value_name = "F", allow_hyphen_values = true)]
    f: String,
    /// The second expression.
    #[arg(value_name = "G", allow_hyphen_values = true)]
    g: String,
    /// Sets a parameter.
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    set: Vec<Assignment>,
    /// Sets an initial value: a coordinate `x`, a velocity `x'` or a momentum `p_x`.
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    init: Vec<Assignment>,
    /// How it is written.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

pub(super) fn execute(arguments: &Arguments) -> Result<(), CommandError> {
    let document = open::find(&arguments.name)?;
    let mut model = open::read(&document)?;
    let parameters = assignment::parameters(&model, &arguments.set)?;
    let given = assignment::initial(&model, &parameters, &arguments.init)?;
    model.run.start = assignment::start(&model, &parameters, &arguments.init)?;
    let mut derived = open::derive(&document, model)?;
    let Derived { model, equations } = &mut derived;
    let f = assignment::expression_with_energy(model, &mut equations.pool, &arguments.f, "F")?;
    let g = assignment::expression_with_energy(model, &mut equations.pool, &arguments.g, "G")?;

    let expression = mechanics::bracket(model, equations, f, g);
    let recognised = match &expression {
        Ok(e) => mechanics::recognise(model, equations, *e),
        Err(_) => None,
    };
    let start = BracketPoint { parameters, given };
    let value = match &expression {
        Ok(e) => start.value(&derived, *e),
        Err(_) => match mechanics::unreduced_bracket(model, equations, f, g) {
            Ok(e) => start.value(&derived, e),
            Err(_) => start.value_by_chain_rule(&mut derived, f, g),
        },
    };
    let Derived { model, equations } = &mut derived;
    let charts = ChartBracket::all(model, equations, [f, g]);
    let here = if charts.is_empty() { None } else { start.valuation(&derived).ok() };
    let Derived { model, equations } = &derived;
    let charts = charts.into_iter().map(|chart| {
        let value = here.as_ref().and_then(|here| chart.value(equations, here));
        (chart, value)
    });
    let charts = charts.collect();
    let answer = BracketReport { arguments, model, f, g, expression, recognised, value, charts };
    let text = match arguments.format {
        Format::Text => answer.text(equations, MathScript::of_locale()),
        Format::Latex => answer.latex(equations),
        Format::Json => answer.json(equations),
    };
    Output::print(arguments.format.form(), &text)
}

/// The point at which the value is evaluated.
struct BracketPoint {
    parameters: Vec<f64>,
    given: Vec<InitialOverride>,
}

impl BracketPoint {
    /// The value of a function on phase space.
    fn value(&self, derived: &Derived, e: Expr) -> Result<f64, String> {
        let channel = WrittenExpr { written: "bracket".to_owned(), expression: e };
        let system = derived.compile(&[channel]).map_err(|e| e.to_string())?;
        let values = self.values(&derived.model, &system)?;
        let extra = system.channels().iter().position(|c| c.kind == ChannelKind::Extra(0));
        finite(extra.map(|i| values[i]))
    }

    /// The values of all symbols at the start.
    fn valuation(&self, derived: &Derived) -> Result<Valuation, String> {
        let system = derived.compile(&[]).map_err(|e| e.to_string())?;
        let Derived { model, equations } = derived;
        let values = self.values(model, &system)?;
        Ok(system.valuation((model, equations), model.run.start, &self.parameters, &values))
    }

    /// The value of \[f, g\] if the velocities are not known as functions of the momenta.
    fn value_by_chain_rule(&self, derived: &mut Derived, f: Expr, g: Expr) -> Result<f64, String> {
        let rule = ChainRule::of(&mut derived.equations, f, g).map_err(|why| why.to_string())?;
        let system = derived.compile(&[]).map_err(|e| e.to_string())?;
        let Derived { model, equations } = derived;
        let values = self.values(model, &system)?;
        let (start, parameters) = (model.run.start, &self.parameters);
        let known = system.valuation((model, equations), start, parameters, &values);
        finite(rule.value(equations, &|symbol| known.at(symbol)))
    }

    /// The value of every channel at the start.
    fn values(&self, model: &Model, system: &System) -> Result<Vec<f64>, String> {
        let state = system.initial(model.run.start, &self.parameters, &self.given);
        let state = state.map_err(|error| error.to_string())?;
        let mut values = vec![f64::NAN; system.channels().len()];
        let outcome = system.observer(&self.parameters).observe(&state, &mut values);
        outcome.map_err(|error| error.to_string())?;
        Ok(values)
    }
}

fn finite(value: Option<f64>) -> Result<f64, String> {
    value.filter(|x| x.is_finite()).ok_or_else(|| "it is not finite there".to_owned())
}

/// The contents of the report.
struct BracketReport<'a> {
    arguments: &'a Arguments,
    model: &'a Model,
    f: Expr,
    g: Expr,
    expression: Result<Expr, NoClosedForm>,
    recognised: Option<Recognised>,
    value: Result<f64, String>,
    /// The bracket in the new variables of each transformation, and its value at the start.
    charts: Vec<(ChartBracket, Option<f64>)>,
}

/// The note for a system with constraints.
const UNCONSTRAINED: &str = "the bracket of the phase space without the constraints";

impl BracketReport<'_> {
    /// `[` and `]`, or `{` and `}` if the file gives its own brackets.
    fn braces(&self) -> (&'static str, &'static str) {
        if self.model.is_poisson() { ("{", "}") } else { ("[", "]") }
    }

    fn text(&self, equations: &Equations, script: MathScript) -> String {
        let (open, close) = self.braces();
        let (f, g) = (self.arguments.f.trim(), self.arguments.g.trim());
        let head = format!("{open}{f}, {g}{close}");
        let gap = " ".repeat(unicode_width::UnicodeWidthStr::width(head.as_str()));
        let math = |e| script.math(&equations.pool, e);
        let mut text = match &self.expression {
            Ok(e) => format!("{head} = {}\n", math(*e)),
            Err(why) => format!("{head}\n  {}\n", script.words(&why.to_string())),
        };
        if let Some(known) = &self.recognised {
            let proof = match known.proof {
                Zero::Proved => "proved",
                _ => "to rounding at every point tried; there is no proof",
            };
            if self.expression == Ok(known.expression) {
                text = format!("{}   ({proof})\n", text.trim_end());
            } else {
                text.push_str(&format!("{gap} = {}   ({proof})\n", math(known.expression)));
            }
        }
        let value = match &self.value {
            Ok(value) => shortest(*value).unwrap_or_default(),
            Err(why) => script.words(why),
        };
        text.push_str(&format!("at the start: {value}\n"));
        for (chart, value) in &self.charts {
            let shown = |&s: &Symbol| equations.pool.symbol_info(s).clone();
            let infos = chart.variables.iter().map(shown);
            let names: Vec<String> = infos.map(|info| script.words(&info.unicode)).collect();
            let value = value.and_then(shortest).unwrap_or_else(|| "not known".to_owned());
            text.push_str(&format!("in {} of {}: ", names.join(", "), chart.name));
            match chart.bracket {
                Ok(e) => text.push_str(&format!("{}; at the start: {value}\n", math(e))),
                Err(_) => text.push_str(&format!("at the start {value}\n")),
            }
        }
        if !self.model.constraints.is_empty() {
            text.push_str(&format!("({UNCONSTRAINED})\n"));
        }
        text
    }

    fn latex(&self, equations: &Equations) -> String {
        let pool = &equations.pool;
        let (open, close) = if self.model.is_poisson() { ("\\{", "\\}") } else { ("[", "]") };
        let (f, g) = (pool.latex(self.f), pool.latex(self.g));
        let mut sides = Vec::new();
        if let Ok(e) = &self.expression {
            sides.push(pool.latex(*e));
        }
        if let Some(known) = &self.recognised
            && self.expression != Ok(known.expression)
        {
            sides.push(pool.latex(known.expression));
        }
        if sides.is_empty() {
            sides.extend(self.value.iter().map(f64::to_string));
        }
        let sides: Vec<String> = sides.iter().map(|side| format!(" &= {side}")).collect();
        let left = format!("\\left{open} {f},\\, {g} \\right{close}");
        format!("\\begin{{align*}}\n{left}{}\n\\end{{align*}}\n", sides.join(" \\\\\n"))
    }

    fn json(&self, equations: &Equations) -> String {
        let text = |e: Expr| Value::String(equations.pool.text(e));
        let recognised = self.recognised.as_ref().map(|known| {
            let proof = if known.proof == Zero::Proved { "proved" } else { "to rounding" };
            json!({ "is": text(known.expression), "how": proof })
        });
        let mut object = json!({
            "phaselab": env!("CARGO_PKG_VERSION"),
            "title": self.model.info.title,
            "f": self.arguments.f.trim(),
            "g": self.arguments.g.trim(),
            "bracket": self.expression.as_ref().map_or(Value::Null, |e| text(*e)),
            "recognised": recognised,
            "value": self.value.as_ref().ok(),
        });
        if !self.charts.is_empty() {
            let name = |&s: &Symbol| equations.pool.symbol_info(s).name.clone();
            let charts = self.charts.iter().map(|(chart, value)| {
                json!({
                    "transformation": chart.name,
                    "variables": chart.variables.iter().map(name).collect::<Vec<_>>(),
                    "bracket": chart.bracket.as_ref().map_or(Value::Null, |e| text(*e)),
                    "value": value,
                })
            });
            object["charts"] = charts.collect();
        }
        let bracket = self.expression.as_ref().err().map(|why| format!("bracket: {why}"));
        let value = self.value.as_ref().err().map(|why| format!("value: {why}"));
        let why: Vec<String> = bracket.into_iter().chain(value).collect();
        if !why.is_empty() {
            object["why"] = Value::String(why.join("; "));
        }
        if !self.model.constraints.is_empty() {
            object["note"] = Value::String(UNCONSTRAINED.to_owned());
        }
        format!("{object:#}\n")
    }
}
