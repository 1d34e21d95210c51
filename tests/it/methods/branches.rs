//! Systems for which p = ∂L/∂q̇ is not one-to-one: a motion stays on the branch of its velocity.

use phaselab::integrate::Settings;
use phaselab::system::{Form, InitialOverride, MotionErrorKind};

use crate::build::{hamiltonian, lagrangian};

use super::{Case, case, named};

/// p = v³ − v, and v = ±1/√3 is where its branches end.
fn branched(velocity: f64) -> Case {
    let l = "x'^4/4 - x'^2/2 - x^2/2";
    case(lagrangian(&["x"], &[], l), Form::Velocity, &[0.3, velocity])
}

#[test]
fn gauss_stays_on_the_branch_of_the_start() {
    for (start, time) in [(1.5, 1.5), (1.1, 0.8), (-1.1, 0.8), (-0.3, 0.4), (0.2, 0.4)] {
        let case = branched(start);
        let exact = case.exact(time);
        for name in ["gauss4", "gauss6"] {
            let settings = Settings { step: Some(0.01), tolerance: None };
            let mut stepper = case.stepper_with(named(name), settings);
            while stepper.time() < time {
                stepper.step(time).expect("goes on");
            }
            let mut state = stepper.state().clone();
            // between two steps too
            for at in [time - 0.004, time] {
                stepper.at(at, &mut state).expect("inside");
            }
            let own = case.system.convert_near(&state, &exact, &case.parameters).expect("near");
            let error = super::distance(&own, &exact);
            assert!(error < 1e-5, "{name} from {start}: {error:e}");
        }
    }
}

#[test]
fn where_the_branch_ends_the_motion_does() {
    let case = branched(1.1);
    for name in ["gauss4", "gauss6"] {
        let mut stepper = case.stepper(named(name), 0.01);
        let error = loop {
            if let Err(error) = stepper.step(2.0) {
                break error;
            }
            assert!(stepper.time() < 0.9, "{name} went on");
        };
        // the velocity falls to 1/√3 there, as the series finds it
        assert!((error.time - 0.839).abs() < 0.02, "{name}: {error}");
    }
}

#[test]
fn momenta_that_belong_to_several_velocities_are_refused() {
    let case = branched(1.5);
    let start =
        |p: f64| case.system.initial(0.0, &case.parameters, &[InitialOverride::Momentum(0, p)]);
    let message = start(0.1).expect_err("three roots").to_string();
    for root in ["0.9456492739235914", "0.10103125788101082", "1.046680531804602"] {
        assert!(message.contains(root), "{message}");
    }
    assert!(message.contains("give one of these instead"), "{message}");
    // beyond 2/√27 = 0.385 there is one
    assert!(start(0.384).is_err());
    match start(0.386) {
        Ok(only) => {
            let v = only.values[1];
            assert!((v * v * v - v - 0.386).abs() < 1e-15, "{v}");
        }
        // from rest the iteration is trapped where the branches end, and reports that it found nothing
        Err(error) => assert_eq!(error.kind, MotionErrorKind::NoVelocities),
    }
}

#[test]
fn velocities_that_belong_to_several_momenta_are_refused() {
    let h = hamiltonian(&["x"], &[], "p_x^4/4 - p_x^2/2 + x^2/2");
    let case = case(h, Form::Momentum, &[0.3, 1.5]);
    let start = |v: f64| case.system.initial(0.0, &[], &[InitialOverride::Velocity(0, v)]);
    assert!(start(0.1).is_err());
    assert!(start(0.5).is_ok());
}

#[test]
fn a_velocity_that_is_exactly_zero_is_found() {
    let l = "3/4*a'^2 + 4/25*b'^2 + 2/5*a'*b'*cos(a - b)";
    let case = case(lagrangian(&["a", "b"], &[], l), Form::Velocity, &[0.0; 4]);
    let given = [InitialOverride::Momentum(0, 0.5), InitialOverride::Momentum(1, 0.4)];
    let start = case.system.initial(0.0, &case.parameters, &given).expect("found");
    assert!(start.values[2].abs() < 1e-30, "{}", start.values[2]);
    assert_eq!(start.values[3], 1.25);
    // and beside one that is not linear
    let l = "1/2*(x'^2 + y'^2 + x'*y') + y'^4/4";
    let case = self::case(lagrangian(&["x", "y"], &[], l), Form::Velocity, &[0.0; 4]);
    // with x' = 0, p_x = y'/2 and p_y = y' + y'³
    let given = [InitialOverride::Momentum(0, 0.5), InitialOverride::Momentum(1, 2.0)];
    let start = case.system.initial(0.0, &case.parameters, &given).expect("found");
    assert!(start.values[2].abs() < 1e-25, "{}", start.values[2]);
    assert_eq!(start.values[3], 1.0);
}
