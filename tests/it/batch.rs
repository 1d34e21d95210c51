//! Orbits carried side by side: the bits of each alone, in every shipped system where that is possible, and the orbits
//! that must be followed alone.

use phaselab::app::Loaded;
use phaselab::ensemble::{
    Carried, SectionPlan, Start, SystemFlow, add_section, crossings, crossings_of_all,
};
use phaselab::integrate::{
    BatchPropagator, LaneStatus, Propagator, Reached, Settings, method_named,
};
use phaselab::mechanics::derive;
use phaselab::model::{Allowed, Direction, Scope};
use phaselab::num::BATCH;
use phaselab::system::{InitialOverride, State, System};

use crate::fixtures::{catalog, compiled, loaded, lowered};
use crate::nonempty;

const TOLERANCES: [f64; 2] = [1e-15, 1e-9];

fn settings(tolerance: f64) -> Settings {
    Settings { tolerance: Some(tolerance), ..Settings::default() }
}

fn flow(ready: &Loaded, tolerance: f64) -> SystemFlow {
    let method = method_named("taylor").unwrap();
    let parameters = ready.model.parameter_values();
    let system = System::clone(&ready.system);
    SystemFlow {
        system,
        method: (method, settings(tolerance)),
        parameters,
        start: ready.model.run.start,
        effort: None,
    }
}

/// States near that of the file, in no order of size.
fn states(ready: &Loaded, count: usize) -> Vec<State> {
    let parameters = ready.model.parameter_values();
    let first = ready.system.initial(ready.model.run.start, &parameters, &[]).unwrap();
    let one = |i: usize| {
        let mut state = first.clone();
        for (j, x) in state.values[..ready.system.moving()].iter_mut().enumerate() {
            let off = ((i * 37 + j * 11) % 101) as f64 / 101.0 - 0.5;
            *x += 0.05 * off * (1.0 + x.abs()) * f64::from(u8::from(i > 0));
        }
        state
    };
    (0..count).map(one).collect()
}

fn bits(one: &Carried) -> (Vec<Vec<u64>>, Option<Vec<u64>>) {
    let of = |row: &Vec<f64>| row.iter().map(|x| x.to_bits()).collect();
    let all = |state: &State| {
        let time = [state.time, state.time_carry];
        let numbers = state.values.iter().chain(&state.carry).chain(&time);
        numbers.map(|x| x.to_bits()).collect()
    };
    (one.seen.iter().map(of).collect(), one.end.as_ref().map(all))
}

/// Whether orbits of a system are carried side by side.
fn goes_side_by_side(ready: &Loaded) -> bool {
    let method = method_named("taylor").unwrap();
    BatchPropagator::new(&ready.system.without_marks(), method, settings(1e-15)).is_some()
}

#[test]
fn every_orbit_has_the_bits_that_it_has_alone() {
    let mut seen = Vec::new();
    for entry in catalog().entries() {
        let ready = compiled(&entry.name);
        if !goes_side_by_side(&ready) {
            continue;
        }
        let states = states(&ready, 2 * BATCH + 3);
        // of different lengths, so that lanes are refilled at different steps
        let start = ready.model.run.start;
        let length = 3.0 * Some(ready.model.run.speed).filter(|s| s.is_finite()).unwrap_or(1.0);
        let times: Vec<f64> = (0..5).map(|k| start + 0.25 * f64::from(k) * length).collect();
        let channels: Vec<usize> = (0..ready.system.columns()).collect();
        for tolerance in TOLERANCES {
            let flow = flow(&ready, tolerance);
            let from: Vec<Option<&State>> = states.iter().map(Some).chain([None]).collect();
            let together = flow.carry_all(&from, &times, &channels, |_| ()).unwrap();
            assert_eq!(together.len(), from.len());
            for (i, state) in states.iter().enumerate() {
                let alone = flow.carry(state, &times, &channels);
                assert_eq!(bits(&together[i]), bits(&alone), "{} {tolerance} {i}", entry.name);
            }
            assert!(together[states.len()].seen.is_empty());
        }
        seen.push(entry.name.clone());
    }
    // some with linear equations in them, some with functions, some with the time
    for name in ["henon-heiles", "double-pendulum", "heavy-top", "pendulum", "spherical-pendulum"] {
        assert!(seen.iter().any(|s| s == name), "{name} not among {seen:?}");
    }
}

#[test]
fn every_orbit_by_equal_steps_too() {
    let mut seen = Vec::new();
    for entry in catalog().entries() {
        let ready = compiled(&entry.name);
        let unit = Some(ready.model.run.speed).filter(|s| s.is_finite()).unwrap_or(1.0);
        // the default step takes far longer to find than the motion to follow
        let is_found = ["henon-heiles", "pendulum"].contains(&entry.name.as_str());
        for (name, step) in [
            ("leapfrog", (!is_found).then_some(0.02 * unit)),
            ("yoshida6", Some(0.05 * unit)),
            ("symplectic-euler", Some(0.01 * unit)),
            ("rk4", Some(0.05 * unit)),
        ] {
            let method = method_named(name).unwrap();
            let settings = Settings { step, tolerance: None };
            let system = ready.system.without_marks();
            if BatchPropagator::new(&system, method, settings).is_none() {
                continue;
            }
            let flow = SystemFlow { method: (method, settings), ..flow(&ready, 1e-9) };
            let states = states(&ready, BATCH + 3);
            let from: Vec<Option<&State>> = states.iter().map(Some).collect();
            // some times within steps, some between which there are none
            let start = ready.model.run.start;
            let times = [0.0, 0.05, 0.11, 0.12, 0.5, 1.03].map(|after| start + after * unit);
            let channels: Vec<usize> = (0..ready.system.columns()).collect();
            let together = flow.carry_all(&from, &times, &channels, |_| ()).unwrap();
            for (i, state) in states.iter().enumerate() {
                let alone = flow.carry(state, &times, &channels);
                assert_eq!(bits(&together[i]), bits(&alone), "{} {name} {i}", entry.name);
            }
            seen.push(format!("{} {name}", entry.name));
        }
    }
    // with the time in the rates, with equations to be solved, with rates of velocities
    let some = [
        "henon-heiles leapfrog",
        "pendulum leapfrog",
        "solar-system leapfrog",
        "pendulum yoshida6",
        "solar-system yoshida6",
        "henon-heiles symplectic-euler",
        "driven-damped-pendulum rk4",
        "double-pendulum rk4",
        "heavy-top rk4",
    ];
    for name in some {
        assert!(seen.iter().any(|s| s == name), "{name} not among {seen:?}");
    }
}

#[test]
fn orbits_of_a_smooth_system_stay_side_by_side() {
    let ready = compiled("henon-heiles");
    let method = method_named("taylor").unwrap();
    let mut batch =
        BatchPropagator::new(&ready.system.without_marks(), method, settings(1e-12)).unwrap();
    let parameters = ready.model.parameter_values();
    for (lane, state) in nonempty(states(&ready, BATCH)).iter().enumerate() {
        assert_eq!(batch.begin(lane, state, &parameters), LaneStatus::Underway);
    }
    while (0..BATCH).any(|lane| batch.state(lane).time < 50.0) {
        assert!(batch.steps_unobserved(&[50.0; BATCH], &[f64::NEG_INFINITY; BATCH]));
        assert!((0..BATCH).all(|lane| batch.status(lane) == LaneStatus::Underway));
    }
}

/// The first unit of time is all that is to go, and another one is looked for in the lanes.
#[test]
fn orbits_with_far_to_go_stay_side_by_side() {
    for name in ["henon-heiles", "double-pendulum", "pendulum"] {
        let ready = compiled(name);
        let method = method_named("taylor").unwrap();
        let system = ready.system.without_marks();
        let mut batch = BatchPropagator::new(&system, method, settings(1e-12)).unwrap();
        let parameters = ready.model.parameter_values();
        let states = states(&ready, BATCH);
        for (lane, state) in states.iter().enumerate() {
            assert_eq!(batch.begin(lane, state, &parameters), LaneStatus::Underway);
        }
        // as far as this for some, and near for others
        let limits: [f64; BATCH] = std::array::from_fn(|i| [1e9, 2.0, 3e5][i % 3]);
        for _ in 0..20 {
            assert!(batch.steps_unobserved(&limits, &[f64::NEG_INFINITY; BATCH]));
            assert!((0..BATCH).all(|lane| batch.status(lane) == LaneStatus::Underway), "{name}");
        }
        // more steps than are allowed before the end, so that it ends
        let flow = SystemFlow { effort: Some(400), ..flow(&ready, 1e-12) };
        let from: Vec<Option<&State>> = states.iter().map(Some).collect();
        let times = [0.0, 1.0, 4.0, 1e9];
        let together = flow.carry_all(&from, &times, &[0, 1], |_| ()).unwrap();
        for (one, state) in together.iter().zip(&states) {
            assert_eq!(bits(one), bits(&flow.carry(state, &times, &[0, 1])), "{name}");
            assert_eq!(one.seen.len(), 3);
        }
    }
}

/// One coordinate with this Lagrangian.
fn line(lagrangian: &str, more: &str) -> Loaded {
    lowered(&format!(
        "title = \"line\"\n[coordinates]\nx = {{ initial = 1.0, velocity = 0.5 }}\n\
         [lagrangian]\nL = \"{lagrangian}\"\n{more}"
    ))
}

#[test]
fn orbits_that_part_from_each_other_go_alone() {
    assert!(goes_side_by_side(&line("1/2*x'^2 - 1/2*x^2", "")));
    for (lagrangian, more) in [
        ("1/2*x'^2 - abs(x)", ""),
        ("1/2*x'^2 - sqrt(x)", ""),
        ("1/2*x'^2 - x^40", ""),
        ("1/2*x'^2 - x", "[[events]]\nname = \"floor\"\nwhen = \"x\"\naction = \"stop\"\n"),
        ("1/2*x'^2", "[[impulses]]\nname = \"kick\"\nat = [1.0]\nchange = { p_x = \"1\" }\n"),
    ] {
        assert!(!goes_side_by_side(&line(lagrangian, more)), "{lagrangian} {more}");
    }
    // nor where the lowest orders are in double-double, or by another method
    let oscillator = line("1/2*x'^2 - 1/2*x^2", "");
    let of = |name: &str, settings| {
        BatchPropagator::new(&oscillator.system, method_named(name).unwrap(), settings).is_some()
    };
    assert!(!of("taylor", Settings::default()));
    assert!(!of("dop853", settings(1e-12)));
    assert!(of("yoshida4", Settings::default()));
    assert!(!of("gauss4", Settings::default()));
    let rotor = line("1/2*(1 + x^2)*x'^2", "");
    let leapfrog = method_named("leapfrog").unwrap();
    assert!(BatchPropagator::new(&rotor.system, leapfrog, Settings::default()).is_none());
}

#[test]
fn an_orbit_that_leaves_the_ordinary_is_carried_alone_and_the_others_go_on() {
    // 1/x falls into its singularity from here, and does not from far away
    let ready = line("1/2*x'^2 + 1/x", "");
    let parameters = ready.model.parameter_values();
    let flow = flow(&ready, 1e-12);
    let state = |x: f64, v: f64| {
        let mut state = ready.system.initial(0.0, &parameters, &[]).unwrap();
        (state.values[0], state.values[1]) = (x, v);
        state
    };
    let states = [state(1.0, -1.0), state(30.0, 0.0), state(2.0, 5.0), state(0.0, 1.0)];
    let from: Vec<Option<&State>> = states.iter().map(Some).collect();
    let together = flow.carry_all(&from, &[0.0, 5.0], &[0], |_| ()).unwrap();
    for (one, state) in together.iter().zip(&states) {
        assert_eq!(bits(one), bits(&flow.carry(state, &[0.0, 5.0], &[0])));
    }
    let arrived: Vec<bool> = together.iter().map(|one| one.end.is_some()).collect();
    assert_eq!(arrived, [false, true, true, false]);
}

/// Side by side, none passes a barrier that its series does not show.
#[test]
fn thin_barriers_reflect_every_orbit() {
    let ready = line("1/2*x'^2 - 1e-25/x^2", "");
    assert!(goes_side_by_side(&ready));
    let first = ready.system.initial(0.0, &ready.model.parameter_values(), &[]).unwrap();
    let states: Vec<State> = (0..BATCH + 3)
        .map(|i| {
            let mut state = first.clone();
            (state.values[0], state.values[1]) = (1.0 + 0.1 * i as f64, [-1.0, 0.5][i % 2]);
            state
        })
        .collect();
    let from: Vec<Option<&State>> = states.iter().map(Some).collect();
    for tolerance in TOLERANCES {
        let flow = flow(&ready, tolerance);
        let together = flow.carry_all(&from, &[0.0, 5.0], &[0], |_| ()).unwrap();
        for (i, (one, state)) in together.iter().zip(&states).enumerate() {
            assert_eq!(bits(one), bits(&flow.carry(state, &[0.0, 5.0], &[0])), "{tolerance} {i}");
            let start = 1.0 + 0.1 * i as f64;
            let expected = [5.0 - start, start + 2.5][i % 2];
            let end = one.end.as_ref().expect("it arrives").values[0];
            assert!((end - expected).abs() < 1e-7, "{tolerance} {i}: {end}, not {expected}");
        }
    }
}

/// An orbit that takes more steps than are allowed is given up, after as many of them whether it is carried alone or not.
#[test]
fn an_orbit_that_takes_too_many_steps_is_given_up() {
    let ready = line("1/2*x'^2 - 1/2*x^2 - 1/4*x^4", "");
    let parameters = ready.model.parameter_values();
    let states: Vec<State> = (0..BATCH + 3)
        .map(|i| {
            let mut state = ready.system.initial(0.0, &parameters, &[]).unwrap();
            // the larger the amplitude, the shorter the period and the steps
            state.values[0] = 0.1 * 2.0_f64.powi(i as i32);
            state
        })
        .collect();
    let from: Vec<Option<&State>> = states.iter().map(Some).collect();
    let times = [0.0, 2.0, 10.0];
    let free = flow(&ready, 1e-15);
    let whole = free.carry_all(&from, &times, &[0], |_| ()).unwrap();
    let mut counts = Vec::new();
    for effort in [1, 10, 30, 100, 300, 100_000] {
        let flow = SystemFlow { effort: Some(effort), ..free.clone() };
        let together = flow.carry_all(&from, &times, &[0], |_| ()).unwrap();
        for ((one, state), unbounded) in together.iter().zip(&states).zip(&whole) {
            assert_eq!(bits(one), bits(&flow.carry(state, &times, &[0])), "{effort}");
            // what is there is what would be there without the bound
            let (seen, all) = (&one.seen, &unbounded.seen);
            assert_eq!(seen[..], all[..seen.len()]);
            assert_eq!(one.end.is_some(), seen.len() == times.len());
        }
        counts.push(together.iter().filter(|one| one.end.is_some()).count());
    }
    assert!(counts.is_sorted() && counts[0] == 0 && counts[5] == states.len(), "{counts:?}");
    assert!(counts.iter().any(|&count| count > 0 && count < states.len()), "{counts:?}");
}

/// A system with a surface of section, and the index of its event.
fn with_section(name: &str, written: &str, direction: Direction) -> (System, Vec<f64>, usize) {
    let mut model = loaded(name, 1).model.as_ref().clone();
    let mut pool = model.pool.clone();
    let read = Scope::new(&model, Allowed::Event, "a section").read(&mut pool, written);
    model.pool = pool;
    let event = add_section(&mut model, read.unwrap(), direction);
    let equations = derive(&model).unwrap();
    (System::compile(&model, &equations, &[]).unwrap(), model.parameter_values(), event)
}

/// Starts of a system with two degrees of freedom or one, in no order of size.
fn starts(system: &System, parameters: &[f64], count: usize) -> Vec<Start> {
    let degrees = system.degrees();
    let one = |i: usize| {
        let off = |j: usize| ((i * 37 + j * 11) % 101) as f64 / 101.0 - 0.5;
        let positions = (0..degrees).map(|j| InitialOverride::Position(j, 0.4 * off(j)));
        let rates = (0..degrees).map(|j| InitialOverride::Velocity(j, 0.3 * off(j + 5)));
        let overrides = positions.chain(rates).collect();
        Start { time: 0.0, parameters: parameters.to_vec(), overrides }
    };
    (0..count).map(one).collect()
}

#[test]
fn every_crossing_has_the_bits_that_it_has_alone() {
    let method = method_named("taylor").unwrap();
    let surfaces = [
        // a number of the motion itself, polynomials, functions of the time, one that is not often crossed
        ("henon-heiles", "x", Direction::Rising),
        ("henon-heiles", "x*(1 + y) - 0.05", Direction::Either),
        ("duffing", "sin(w*t)", Direction::Rising),
        ("duffing", "x'", Direction::Falling),
        ("double-pendulum", "theta1", Direction::Rising),
        ("pendulum", "cos(theta) - 0.995", Direction::Either),
    ];
    for (name, written, direction) in surfaces {
        let (system, parameters, event) = with_section(name, written, direction);
        let settings = settings(1e-12);
        assert!(BatchPropagator::with_events(&system, method, settings).is_some(), "{name}");
        let starts = starts(&system, &parameters, 2 * BATCH + 3);
        for (count, until) in [(Some(12), None), (None, Some(20.0)), (Some(3), Some(40.0))] {
            let plan = SectionPlan { event, count, until, idle: 4000, all_channels: false };
            let all = starts.iter().cloned().map(Ok).collect();
            let together = crossings_of_all(&system, method, settings, all, &plan);
            let mut rows = 0;
            for (i, (start, found)) in starts.iter().zip(&together).enumerate() {
                let alone = crossings(&system, method, settings, start, &plan);
                rows += alone.rows.len();
                assert_eq!(*found, alone, "{name} {written} {count:?} {until:?} {i}");
            }
            assert!(rows > starts.len(), "{name} {written} {count:?} {until:?}: {rows}");
        }
    }
}

#[test]
fn events_with_effects_are_not_followed_side_by_side() {
    let method = method_named("taylor").unwrap();
    let with = |name: &str, written: &str| {
        let (system, ..) = with_section(name, written, Direction::Rising);
        BatchPropagator::with_events(&system, method, settings(1e-12)).is_some()
    };
    assert!(!with("bouncing-ball", "y - 0.1"));
    // the exact accuracy is that of an orbit alone
    let (system, ..) = with_section("henon-heiles", "x", Direction::Rising);
    assert!(BatchPropagator::with_events(&system, method, Settings::default()).is_none());
    let leapfrog = method_named("leapfrog").unwrap();
    assert!(BatchPropagator::with_events(&system, leapfrog, Settings::default()).is_none());
}

/// Otherwise the orbits could all be followed alone, and nothing would be compared.
#[test]
fn events_are_found_in_the_lanes_themselves() {
    let method = method_named("taylor").unwrap();
    let (system, parameters, _) = with_section("henon-heiles", "x*(1 + y)", Direction::Rising);
    let mut batch = BatchPropagator::with_events(&system, method, settings(1e-12)).unwrap();
    let starts = starts(&system, &parameters, BATCH);
    let mut here = starts[0].state(&system).unwrap();
    for (lane, start) in starts.iter().enumerate() {
        let state = start.state(&system).unwrap();
        assert_eq!(batch.begin(lane, &state, &parameters), LaneStatus::Underway);
    }
    let mut times = vec![Vec::new(); BATCH];
    while (0..BATCH).any(|lane| batch.state(lane).time < 30.0) {
        assert!(batch.steps_unobserved(&[30.0; BATCH], &[f64::NEG_INFINITY; BATCH]));
        for (lane, times) in times.iter_mut().enumerate() {
            while let Some(event) = batch.next_event(lane, &mut here).unwrap() {
                assert_eq!(here.time, event.time);
                times.push(event.time);
            }
        }
    }
    for (start, times) in starts.iter().zip(&times) {
        let mut motion = Propagator::new(&system, method, settings(1e-12), &parameters).unwrap();
        motion.begin(&start.state(&system).unwrap(), &parameters).unwrap();
        let mut alone = Vec::new();
        while let Reached::Occurred(event) = motion.reach(30.0, 30.0, &mut 10_000).unwrap() {
            alone.push(event.time);
        }
        assert!(alone.len() >= 3, "{alone:?}");
        assert_eq!(*times, alone);
    }
}

/// Otherwise a map over a parameter would show the motions of the flow's own.
#[test]
fn states_with_parameters_of_their_own_are_carried_as_each_alone() {
    let ready = compiled("henon-heiles");
    let states = states(&ready, 2 * BATCH + 3);
    let own = |i: usize| {
        let mut parameters = ready.model.parameter_values();
        for x in &mut parameters {
            *x *= 1.0 + 0.05 * ((i * 37) % 11) as f64;
        }
        parameters
    };
    let parameters: Vec<Vec<f64>> = (0..states.len()).map(own).collect();
    assert!(parameters[0] != parameters[1], "a system with parameters");
    let from: Vec<_> = states.iter().map(Some).zip(parameters.iter().map(|p| &p[..])).collect();
    let channels: Vec<usize> = (0..ready.system.columns()).collect();
    for tolerance in TOLERANCES {
        let flow = flow(&ready, tolerance);
        assert_eq!(flow.group(), BATCH);
        let together = flow.carry_each(&from, &[1.0, 12.5], &channels);
        for ((one, state), parameters) in together.iter().zip(&states).zip(&parameters) {
            let flow = SystemFlow { parameters: parameters.clone(), ..flow.clone() };
            assert_eq!(bits(one), bits(&flow.carry(state, &[1.0, 12.5], &channels)));
        }
    }
}
