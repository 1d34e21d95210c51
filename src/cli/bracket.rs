//! `phaselab bracket`: Poisson's bracket of any two expressions.

use std::ffi::OsString;

use serde_json::{Value, json};

use super::assignment::{self, Assignment};
use super::decimal::shortest;
use super::failure::CommandError;
use super::format::Format;
use super::open;
use super::output::Output;
use super::script::Script;
use crate::expr::{Expr, Symbol, Zero};
use crate::mechanics::{self, ChainRule, Equations, NoClosedForm, Recognised};
use crate::model::{Channel, Model};
use crate::system::{ChannelKind, InitialOverride, System};

/// Take Poisson's bracket of two expressions.
///
/// [F, G] = Σ ∂F/∂q ∂G/∂p − ∂F/∂p ∂G/∂q, or ∇F · B ∇G where the file gives the brackets B of its
/// variables; symbolically, and its value at the start. F and G may use whatever an observable
/// may. Constraints are not looked at.
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

pub(super) fn perform(arguments: &Arguments) -> Result<(), CommandError> {
    let document = open::find(&arguments.name)?;
    let mut model = open::read(&document)?;
    let parameters = assignment::parameters(&model, &arguments.set)?;
    let given = assignment::initial(&model, &parameters, &arguments.init)?;
    model.run.start = assignment::start(&model, &parameters, &arguments.init)?;
    let mut equations = open::derive(&document, &model)?;
    let pool = &mut equations.pool;
    let f = assignment::expression(&model, pool, &arguments.f, "F")?;
    let g = assignment::expression(&model, pool, &arguments.g, "G")?;

    let expression = mechanics::bracket(&model, &mut equations, f, g);
    let recognised = match &expression {
        Ok(e) => mechanics::recognise(&model, &mut equations, *e),
        Err(_) => None,
    };
    let start = Start { parameters, given };
    let value = match &expression {
        Ok(e) => start.value(&model, &equations, *e),
        Err(_) => start.value_by_chain_rule(&model, &mut equations, f, g),
    };
    let answer = Answer { arguments, model: &model, f, g, expression, recognised, value };
    let text = match arguments.format {
        Format::Text => answer.text(&equations, Script::of_locale()),
        Format::Latex => answer.latex(&equations),
        Format::Json => answer.json(&equations),
    };
    Output::print(arguments.format.form(), &text)
}

/// The point at which the value is wanted.
struct Start {
    parameters: Vec<f64>,
    given: Vec<InitialOverride>,
}

impl Start {
    /// The value of a function of phase space.
    fn value(&self, model: &Model, equations: &Equations, e: Expr) -> Result<f64, String> {
        let channel = Channel { written: "bracket".to_owned(), expression: e };
        let system = System::compile(model, equations, &[channel]).map_err(|e| e.to_string())?;
        let values = self.values(model, &system)?;
        let extra = system.channels().iter().position(|c| c.kind == ChannelKind::Extra(0));
        finite(extra.map(|i| values[i]))
    }

    /// The value of \[f, g\] where velocities are not known in terms of momenta.
    fn value_by_chain_rule(
        &self,
        model: &Model,
        equations: &mut Equations,
        f: Expr,
        g: Expr,
    ) -> Result<f64, String> {
        let rule = ChainRule::of(equations, f, g).map_err(|why| why.to_string())?;
        let system = System::compile(model, equations, &[]).map_err(|e| e.to_string())?;
        let values = self.values(model, &system)?;
        let body = system.body_values(&self.parameters);
        let value = |kind| {
            let channel = system.channels().iter().position(|c| c.kind == kind);
            channel.map_or(f64::NAN, |i| values[i])
        };
        let at = |symbol: Symbol| {
            let coordinates = &equations.coordinates;
            if let Some(i) = coordinates.iter().position(|c| c.position == symbol) {
                value(ChannelKind::Position(i))
            } else if let Some(i) = coordinates.iter().position(|c| c.velocity == symbol) {
                value(ChannelKind::Velocity(i))
            } else if symbol == equations.symbols.time {
                model.run.start
            } else {
                let parameter = model.parameters.iter().position(|p| p.symbol == symbol);
                let of_body = || body.iter().find(|(s, _)| *s == symbol).map(|(_, value)| *value);
                parameter.map(|i| self.parameters[i]).or_else(of_body).unwrap_or(f64::NAN)
            }
        };
        finite(rule.value(equations, &at))
    }

    /// Every channel's value at the start.
    fn values(&self, model: &Model, system: &System) -> Result<Vec<f64>, String> {
        let state = system.initial(model.run.start, &self.parameters, &self.given);
        let state = state.map_err(|fault| fault.to_string())?;
        let mut values = vec![f64::NAN; system.channels().len()];
        let outcome = system.observer(&self.parameters).observe(&state, &mut values);
        outcome.map_err(|fault| fault.to_string())?;
        Ok(values)
    }
}

fn finite(value: Option<f64>) -> Result<f64, String> {
    value.filter(|x| x.is_finite()).ok_or_else(|| "it is not finite there".to_owned())
}

/// All that is reported.
struct Answer<'a> {
    arguments: &'a Arguments,
    model: &'a Model,
    f: Expr,
    g: Expr,
    expression: Result<Expr, NoClosedForm>,
    recognised: Option<Recognised>,
    value: Result<f64, String>,
}

/// What is said where there are constraints.
const UNCONSTRAINED: &str = "the bracket of the phase space without the constraints";

impl Answer<'_> {
    /// `[` and `]`, or `{` and `}` where the file gives brackets of its own.
    fn braces(&self) -> (&'static str, &'static str) {
        if self.model.is_poisson() { ("{", "}") } else { ("[", "]") }
    }

    fn text(&self, equations: &Equations, script: Script) -> String {
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
