//! How an experiment begins: values, method, and the spacing of what it records.

use crate::diagnostic::nearest;
use crate::expr::Symbol;
use crate::integrate::{METHODS, Method, MethodError, Settings};
use crate::model::Model;
use crate::printable;
use crate::system::{Form, InitialOverride, System};

/// Everything an experiment is reported at its beginning.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Setup {
    /// The parameters, in the model's order.
    pub parameters: Vec<f64>,
    /// Initial values that take the place of the file's.
    pub overrides: Vec<InitialOverride>,
    /// The method's name in the table of methods, or `auto`.
    pub method: String,
    /// Its step or tolerance.
    pub settings: Settings,
    /// The time of the initial values.
    pub start: f64,
    /// No step is to reach beyond this time; `None` where the motion has no end.
    pub end: Option<f64>,
    /// The least time between two recorded rows, and between two looks at the gauges. It becomes
    /// longer where steps are long and time runs fast.
    pub spacing: f64,
    /// Simulated seconds per second of the wall clock.
    pub speed: f64,
}

/// Rows per second of the wall clock, at the speed the file proposes: two a frame.
const ROWS_PER_SECOND: f64 = 120.0;

impl Setup {
    /// As the file proposes.
    pub fn of(model: &Model) -> Setup {
        let run = &model.run;
        Setup {
            parameters: model.parameter_values(),
            overrides: Vec::new(),
            method: run.method.clone(),
            settings: Settings { step: run.step, tolerance: run.tolerance },
            start: run.start,
            end: None,
            spacing: run.speed / ROWS_PER_SECOND,
            speed: run.speed,
        }
    }

    /// The value of the symbol of a parameter, or of what follows from a body; not a number for any
    /// other.
    pub(super) fn constant(&self, model: &Model, body: &[(Symbol, f64)], symbol: Symbol) -> f64 {
        let index = model.parameters.iter().position(|p| p.symbol == symbol);
        let of_body = || body.iter().find(|(s, _)| *s == symbol).map(|(_, value)| *value);
        index.map(|i| self.parameters[i]).or_else(of_body).unwrap_or(f64::NAN)
    }
}

/// What is given in place of the file's initial values once the one of an index (coordinates first, then velocities or
/// momenta) is given too.
pub fn with_override(
    system: &System,
    before: &[InitialOverride],
    index: usize,
    value: f64,
) -> Vec<InitialOverride> {
    let n = system.degrees();
    let overrides = match (index < n, system.form()) {
        (true, _) => InitialOverride::Position(index, value),
        (false, Form::Velocity) => InitialOverride::Velocity(index - n, value),
        (false, Form::Momentum | Form::Variables) => InitialOverride::Momentum(index - n, value),
    };
    let same = |g: &&InitialOverride| match g {
        InitialOverride::Position(i, _) => *i == index,
        InitialOverride::Velocity(i, _) | InitialOverride::Momentum(i, _) => i + n == index,
    };
    before.iter().filter(|g| !same(g)).copied().chain([overrides]).collect()
}

/// Why a method cannot be had.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum MethodNotFound {
    /// There is none of that name.
    #[error("there is no method `{}`{}", printable::quoted(.name), help(near.as_deref()))]
    Unknown {
        /// What was asked for.
        name: String,
        /// The most similar name there is.
        near: Option<&'static str>,
    },
    /// It does not fit the system.
    #[error(transparent)]
    Refused(#[from] MethodError),
}

fn help(near: Option<&str>) -> String {
    near.map_or(String::new(), |name| format!("; did you mean `{name}`?"))
}

/// The method of a name, if it fits the system; for `auto` the first in the table that does.
pub fn choose_method(system: &System, name: &str) -> Result<&'static Method, MethodNotFound> {
    if name == "auto" {
        let fits = |method: &&Method| (method.fits)(system).is_ok();
        return METHODS.iter().find(fits).ok_or_else(|| unknown(name));
    }
    let method = METHODS.iter().find(|method| method.name == name).ok_or_else(|| unknown(name))?;
    (method.fits)(system)?;
    Ok(method)
}

fn unknown(name: &str) -> MethodNotFound {
    let near = nearest(name, METHODS.iter().map(|method| method.name));
    MethodNotFound::Unknown { name: name.to_owned(), near }
}
