//! Stages side by side: the bits that they have one by one. A parameter that nothing uses, so large that products with it
//! could leave the range of `f64`, sends the stages of the same law one by one.

use phaselab::integrate::{Settings, method_named};
use phaselab::mechanics;
use phaselab::model::Model;
use phaselab::preset;
use phaselab::system::{State, System};

use crate::fixtures::catalog;

const HUGE: &str = "[parameters]\nhuge_and_unused = 1e200\n";

struct Laws {
    model: Model,
    system: System,
}

fn read(text: &str) -> Option<Laws> {
    let model = preset::read(text).ok()?.model;
    let equations = mechanics::derive(&model).ok()?;
    let system = System::compile(&model, &equations, &[]).ok()?;
    (system.constraints() == 0).then_some(Laws { model, system })
}

impl Laws {
    fn parameters(&self) -> Vec<f64> {
        self.model.parameter_values()
    }

    fn goes_side_by_side(&self) -> bool {
        let mut rates = self.system.canonical_rates();
        rates.set_parameters(&self.parameters());
        rates.of_stages(3).is_some_and(|mut stages| stages.set_parameters(&rates))
    }

    /// The state after every step, up to one that fails.
    fn steps(&self, method: &str, step: f64, count: usize) -> Vec<State> {
        let (system, parameters) = (&self.system, self.parameters());
        let start = system.initial(self.model.run.start, &parameters, &[]).unwrap();
        let settings = Settings { step: Some(step), tolerance: None };
        let method = method_named(method).unwrap();
        let Ok(mut stepper) = (method.make)(system, &settings) else { return Vec::new() };
        stepper.start(&start, &parameters).unwrap();
        let mut states = Vec::new();
        while states.len() < count && stepper.step(f64::INFINITY).is_ok() {
            states.push(stepper.state().clone());
        }
        states
    }
}

#[test]
fn stages_have_the_bits_that_they_have_one_by_one() {
    let mut compared = 0;
    for entry in catalog().entries() {
        let text = entry.document().unwrap().text.clone();
        let huge = match text.split_once("[parameters]\n") {
            Some((before, after)) => format!("{before}{HUGE}{after}"),
            None => format!("{text}\n{HUGE}"),
        };
        let (Some(laws), Some(alone)) = (read(&text), read(&huge)) else { continue };
        assert!(!alone.goes_side_by_side(), "{}", entry.name);
        // with such a parameter a law that changes in time by a ramp is evaluated anew in a wider range, in which it has
        // other last digits
        let has_ramp = text.contains("[[ramps]]") || entry.name == "three-ramps";
        if !laws.goes_side_by_side() || has_ramp {
            continue;
        }
        // few passes and many, and one by one where they do not converge
        for (method, step, count) in [
            ("gauss4", 0.03, 100),
            ("gauss6", 0.0012, 600),
            ("gauss6", 0.1, 100),
            ("symplectic-euler", 0.03, 100),
        ] {
            let (own, other) = (laws.steps(method, step, count), alone.steps(method, step, count));
            assert!(own == other, "{} by {method}, {step}", entry.name);
            compared += own.len();
        }
    }
    assert!(compared > 40_000, "{compared} steps");
}
