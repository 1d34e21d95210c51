//! What the derivatives of a motion tell, against closed forms and published numbers.

mod action;
mod bracket_orbits;
mod constrained;
mod equilibria;
mod event_orbits;
mod family;
mod flow;
mod gali;
mod impulses;
mod lyapunov;
mod lyapunov_batch;
mod method_step;
mod orbit;
mod pole;
mod principles;
mod return_growth;
mod rotation;
mod spectrum;
mod spectrum_images;

use phaselab::dynamics::{CompiledLaw, DynamicsError, PhaseSpace};
use phaselab::integrate::{Method, Settings, method_named};
use phaselab::system::{InitialOverride, State};

use crate::fixtures::{loaded, lowered};

/// A phase space and a state in its variables.
struct Case {
    space: PhaseSpace,
    start: State,
}

/// A shipped preset with these parameters and these variables at the start, those left out as in
/// the file.
fn preset(name: &str, set: &[(&str, f64)], start: &[f64]) -> Case {
    case(&loaded(name, 1), set, start)
}

/// A file of its own.
fn file(text: &str, start: &[f64]) -> Case {
    case(&lowered(text), &[], start)
}

fn case(loaded: &phaselab::app::Loaded, set: &[(&str, f64)], start: &[f64]) -> Case {
    case_in(loaded, set, start, PhaseSpace::of)
}

/// The same in a phase space made in this way.
fn case_in(
    loaded: &phaselab::app::Loaded,
    set: &[(&str, f64)],
    start: &[f64],
    space: impl Fn(CompiledLaw<'_>, &[f64]) -> Result<PhaseSpace, DynamicsError>,
) -> Case {
    let mut parameters = loaded.model.parameter_values();
    for (name, value) in set {
        parameters[loaded.model.parameter(name).expect("a parameter")] = *value;
    }
    let (model, equations) = (&loaded.model, &loaded.equations);
    let space = space((model, equations, &loaded.system), &parameters).unwrap();
    let n = loaded.system.degrees();
    let given: Vec<InitialOverride> = start
        .iter()
        .enumerate()
        .map(|(i, &x)| match i {
            i if i < n => InitialOverride::Position(i, x),
            i => InitialOverride::Momentum(i - n, x),
        })
        .collect();
    let state = loaded.system.initial(model.run.start, &parameters, &given).unwrap();
    let start = space.state(&state).unwrap();
    Case { space, start }
}

/// The default method.
fn taylor() -> (&'static Method, Settings) {
    method("taylor", None)
}

fn method(name: &str, step: Option<f64>) -> (&'static Method, Settings) {
    (method_named(name).unwrap(), Settings { step, tolerance: None })
}
