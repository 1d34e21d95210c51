//! How an experiment begins: values, method, and the spacing of its recorded rows.

use crate::diagnostic::nearest;
use crate::integrate::{METHODS, Method, MethodError, Settings};
use crate::model::Model;
use crate::printable;
use crate::system::{InitialOverride, System};

/// The setup of an experiment.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Setup {
    /// The parameters, in the model's order.
    pub parameters: Vec<f64>,
    /// The overrides of the file's initial values.
    pub overrides: Vec<InitialOverride>,
    /// The method's name in the table of methods, or `auto`.
    pub method: String,
    /// Its step or tolerance.
    pub settings: Settings,
    /// The time of the initial values.
    pub start: f64,
    /// The time that no step may pass; `None` for a motion without an end.
    pub end: Option<f64>,
    /// The least time between two recorded rows, and between two samples of the gauges. The spacing grows if steps
    /// are long and time runs fast.
    pub spacing: f64,
    /// Simulated seconds per second of wall time.
    pub speed: f64,
}

/// Rows per second of wall time at the file's speed: two per frame.
const ROWS_PER_SECOND: f64 = 120.0;

impl Setup {
    /// The setup that the file proposes.
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
}

/// The overrides after the initial value of an index is set. The index counts coordinates first, then velocities or
/// momenta.
pub fn with_override(
    system: &System,
    before: &[InitialOverride],
    index: usize,
    value: f64,
) -> Vec<InitialOverride> {
    let n = system.degrees();
    let same = |g: &&InitialOverride| match g {
        InitialOverride::Position(i, _) => *i == index,
        InitialOverride::Velocity(i, _) | InitialOverride::Momentum(i, _) => i + n == index,
    };
    before
        .iter()
        .filter(|g| !same(g))
        .copied()
        .chain([system.initial_override(index, value)])
        .collect()
}

/// Why a method cannot be used.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum MethodNotFound {
    /// There is no method of that name.
    #[error("unknown method `{}`{}", printable::quoted(.name), help(near.as_deref()))]
    Unknown {
        /// The requested name.
        name: String,
        /// The most similar name.
        near: Option<&'static str>,
    },
    /// The method does not suit the system.
    #[error(transparent)]
    Refused(#[from] MethodError),
}

fn help(near: Option<&str>) -> String {
    match near {
        Some(name) => format!("; did you mean `{name}`?"),
        None => {
            let names: Vec<&str> = METHODS.iter().map(|method| method.name).collect();
            format!("; there are auto, {}", names.join(", "))
        }
    }
}

/// Finds the method of a name and checks that it suits the system; `auto` selects the first suitable one in the
/// table.
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
