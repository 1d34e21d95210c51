//! The table of methods: measurements of the properties it states.

mod batches;
mod branches;
mod errors;
mod kepler;
mod order;
mod presets;
mod side_by_side;
mod stability;
mod structure;
mod turning_point;

use phaselab::integrate::{METHODS, Method, Settings, Stepper, Stepping, method_named};
use phaselab::mechanics;
use phaselab::model::{Model, WrittenExpr};
use phaselab::system::{Form, State, System};

use crate::build::{hamiltonian, lagrangian, read};

/// A system and its initial state.
struct Case {
    system: System,
    start: State,
    parameters: Vec<f64>,
}

fn case(mut model: Model, form: Form, numbers: &[f64]) -> Case {
    // watching the action adds it to every state
    let action = read(&mut model, "action");
    let equations = mechanics::derive(&model).expect("derivable");
    let extra = WrittenExpr { written: "action".to_owned(), expression: action };
    let system = System::compile(&model, &equations, &[extra]).expect("compiles");
    let mut values = numbers.to_vec();
    values.resize(system.state_len(), 0.0);
    Case { start: State::new(0.0, form, values), parameters: model.parameter_values(), system }
}

impl Case {
    fn stepper(&self, method: &Method, step: f64) -> Box<dyn Stepper> {
        let settings = Settings { step: Some(step), tolerance: None };
        self.stepper_with(method, settings)
    }

    fn stepper_with(&self, method: &Method, settings: Settings) -> Box<dyn Stepper> {
        let mut stepper = (method.make)(&self.system, &settings).expect("fits");
        stepper.start(&self.start, &self.parameters).expect("starts");
        stepper
    }

    /// The state at `time`, in the form of the start.
    fn run(&self, method: &Method, step: f64, time: f64) -> State {
        let mut stepper = self.stepper(method, step);
        self.continue_to(stepper.as_mut(), time)
    }

    fn continue_to(&self, stepper: &mut dyn Stepper, time: f64) -> State {
        let forwards = time > stepper.time();
        while stepper.time() != time && (stepper.time() < time) == forwards {
            stepper.step(time).expect("goes on");
        }
        let mut state = stepper.state().clone();
        stepper.at(time, &mut state).expect("inside the step");
        self.system.convert(&state, self.start.form, &self.parameters).expect("converts")
    }

    fn exact(&self, time: f64) -> State {
        self.run(named("taylor"), 0.0, time)
    }
}

fn named(name: &str) -> &'static Method {
    method_named(name).unwrap_or_else(|| panic!("no method {name}"))
}

fn fixed() -> impl Iterator<Item = &'static Method> {
    METHODS.iter().filter(|method| method.stepping == Stepping::Fixed)
}

/// The greatest difference of any number.
fn distance(a: &State, b: &State) -> f64 {
    a.values.iter().zip(&b.values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn pendulum() -> Case {
    case(hamiltonian(&["q"], &[], "p_q^2/2 - cos(q)"), Form::Momentum, &[1.2, 0.5])
}

/// A driven system: V depends on time, so the work is part of the state.
fn driven() -> Case {
    let h = "p_q^2/2 - cos(q) + q*cos(3*t/2)/2";
    case(hamiltonian(&["q"], &[], h), Form::Momentum, &[1.2, 0.5])
}

/// A system that is neither separable nor autonomous.
fn entangled() -> Case {
    let h = "(1 + q^2)*(1 + p_q^2)/2 + q*sin(t)/4";
    case(hamiltonian(&["q"], &[], h), Form::Momentum, &[0.6, 0.3])
}

fn double_pendulum() -> Case {
    let l = "x'^2 + y'^2/2 + x'*y'*cos(x - y) + 2*cos(x) + cos(y)";
    case(lagrangian(&["x", "y"], &[], l), Form::Velocity, &[0.9, -0.4, 0.2, 0.5])
}

/// L is not quadratic in the velocity, and p = q̇ + q̇³ is solved by iteration.
fn quartic() -> Case {
    let l = "x'^2/2 + x'^4/4 + x'^6/6 - x^2/2 - x^4/4";
    case(lagrangian(&["x"], &[], l), Form::Velocity, &[0.8, 0.3])
}

fn heavy_top() -> Case {
    let l = "1/2*(theta'^2 + phi'^2*sin(theta)^2) + 1/5*(psi' + phi'*cos(theta))^2 - cos(theta)";
    let start = [0.6, 0.0, 0.0, 0.0, 0.0, 10.0];
    case(lagrangian(&["theta", "phi", "psi"], &[], l), Form::Velocity, &start)
}

fn henon_heiles() -> Case {
    let h = "(p_x^2 + p_y^2 + x^2 + y^2)/2 + x^2*y - y^3/3";
    let start = [0.0, -0.25, 0.42081, 0.0];
    case(hamiltonian(&["x", "y"], &[], h), Form::Momentum, &start)
}

/// Kepler's problem with eccentricity e and semi-major axis 1, from the pericentre.
fn kepler(e: f64) -> Case {
    let h = "(p_x^2 + p_y^2)/2 - 1/sqrt(x^2 + y^2)";
    let start = [1.0 - e, 0.0, 0.0, ((1.0 + e) / (1.0 - e)).sqrt()];
    case(hamiltonian(&["x", "y"], &[], h), Form::Momentum, &start)
}
