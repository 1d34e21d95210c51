//! Rates by straight lists of instructions: those of the program, for one state and for the stages of a step side by side.

use phaselab::experiment::Prepared;
use phaselab::num::{Batch, DoubleDouble};
use phaselab::system::{STAGES, State};

use crate::hand::catalog;
use crate::nonempty;

/// States near that of the file, at different times.
fn states(ready: &Prepared) -> Vec<State> {
    let parameters = ready.model.parameter_values();
    let first = ready.system.initial(ready.model.run.start, &parameters, &[]).unwrap();
    let one = |i: usize| {
        let mut state = first.clone();
        state.time += 0.25 * i as f64;
        for (j, x) in state.values[..ready.system.moving()].iter_mut().enumerate() {
            let off = ((i * 37 + j * 11) % 101) as f64 / 101.0 - 0.5;
            *x += 0.05 * off * (1.0 + x.abs()) * f64::from(u8::from(i > 0));
        }
        state
    };
    (0..STAGES).map(one).collect()
}

#[test]
fn every_stage_has_the_bits_that_it_has_alone() {
    let mut compared = 0;
    for entry in catalog().entries() {
        let ready = Prepared::of(&entry.document().unwrap()).unwrap();
        let parameters = ready.model.parameter_values();
        for mut rates in [ready.system.native_rates(), ready.system.canonical_rates()] {
            rates.set_parameters(&parameters);
            let Some(mut stages) = rates.of_stages(STAGES) else { continue };
            if !stages.set_parameters(&rates) {
                continue;
            }
            let states = states(&ready);
            for i in 0..ready.system.state_len() {
                let number = std::array::from_fn(|stage| states[stage].values[i]);
                stages.set_number(i, Batch(number));
            }
            stages.set_times(Batch(std::array::from_fn(|stage| states[stage].time)));
            stages.evaluate();
            let places = stages.places().to_vec();
            let (_, side_by_side) = stages.moving();
            for (stage, state) in states.iter().enumerate() {
                let mut alone = vec![0.0; state.values.len()];
                rates.evaluate(state.time, &state.values, &mut alone).unwrap();
                for (rate, &i) in side_by_side.iter().zip(&places) {
                    let (rate, alone) = (rate.0[stage], alone[i]);
                    assert_eq!(
                        rate.to_bits(),
                        alone.to_bits(),
                        "{} {i}: {rate} {alone}",
                        entry.name
                    );
                }
            }
            compared += 1;
        }
    }
    assert!(compared > 60, "{compared} systems with lists");
}

#[test]
fn rates_are_those_in_double_double_but_for_rounding() {
    for entry in nonempty(catalog().entries()) {
        let ready = Prepared::of(&entry.document().unwrap()).unwrap();
        let parameters = ready.model.parameter_values();
        let mut rates = ready.system.native_rates();
        rates.set_parameters(&parameters);
        let mut exact = ready.system.exact_rates();
        exact.set_parameters(&ready.system.inputs(&parameters));
        for state in nonempty(states(&ready)) {
            let numbers: Vec<DoubleDouble> =
                state.values.iter().map(|&x| DoubleDouble::from(x)).collect();
            exact.evaluate(DoubleDouble::from(state.time), &numbers).unwrap();
            let mut rounded = vec![0.0; numbers.len()];
            rates.evaluate(state.time, &state.values, &mut rounded).unwrap();
            let moving = ready.system.moving();
            let largest = rounded[..moving].iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            for i in 0..moving {
                let error = (exact.rate(i) - DoubleDouble::from(rounded[i])).high.abs();
                assert!(error <= 1e-12 * largest, "{} {i}: {error:e} of {largest}", entry.name);
            }
        }
    }
}
