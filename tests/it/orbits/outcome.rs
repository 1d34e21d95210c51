//! The end of a run and the drift of its energy: the same bytes whether orbits are followed side by side or one alone.

use std::sync::Arc;

use phaselab::ensemble::Start;
use phaselab::experiment::Prepared;
use phaselab::integrate::Settings;
use phaselab::orbits::RunPlan;
use phaselab::system::{InitialOverride, System};

use crate::fixtures::catalog;
use crate::nonempty;

#[test]
fn a_run_has_the_same_bytes_side_by_side_and_alone() {
    for (name, method, step, tolerance) in [
        ("henon-heiles", "taylor", None, Some(1e-12)),
        ("double-pendulum", "taylor", None, Some(1e-9)),
        ("driven-damped-pendulum", "taylor", None, Some(1e-12)),
        ("henon-heiles", "leapfrog", Some(0.3), None),
        ("double-pendulum", "rk4", Some(0.05), None),
    ] {
        let ready = Prepared::of(&catalog().find(name).unwrap()).unwrap();
        let plan = RunPlan {
            model: Arc::clone(&ready.model),
            equations: Arc::clone(&ready.equations),
            system: System::clone(&ready.system),
            method: method.to_owned(),
            settings: Settings { step, tolerance },
        };
        assert!(plan.is_side_by_side(), "{name} {method}");
        let parameters = ready.model.parameter_values();
        let starts: Vec<Start> = (0..11)
            .map(|i| Start {
                time: 0.0,
                parameters: parameters.clone(),
                overrides: vec![InitialOverride::Position(0, 0.02 * f64::from(i))],
            })
            .collect();
        let runs: Vec<(&Start, f64)> = starts.iter().map(|start| (start, 37.3)).collect();
        let mut together = vec![None; runs.len()];
        plan.run_all(&runs, |i, outcome| together[i] = Some(outcome));
        let together: Vec<_> = nonempty(together).into_iter().flatten().collect();
        assert_eq!(together.len(), runs.len());
        for ((start, end), outcome) in nonempty(runs).into_iter().zip(together) {
            let alone = plan.run(start, end).unwrap();
            assert!(outcome.energy_drift.is_finite(), "{name} {method}");
            let bits = |x: f64| x.to_bits();
            assert_eq!(bits(outcome.energy_drift), bits(alone.energy_drift), "{name} {method}");
            assert_eq!(outcome, alone, "{name} {method}");
        }
    }
}
