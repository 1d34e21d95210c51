//! The observable quantities of a state: names, order, values, conversions of form, level curves.

use phaselab::mechanics::derive;
use phaselab::model::{self, Model};
use phaselab::preset;
use phaselab::system::{ChannelKind, CompileError, Form, State, System};

use super::{compile, parameters};

const TOP: &str = include_str!("../../../presets/rigid-body/heavy-top.toml");

const PENDULUM: &str = r#"
title = "Pendulum"
[coordinates]
theta = { initial = 2.0, velocity = 0.5, period = "2*pi*m" }
[parameters]
m = 2.0
[lagrangian]
L = "1/2*m*theta'^2 + m*cos(theta)"
[[observables]]
name = "pull"
expression = "theta'' + action"
[[views]]
kind = "phase"
x = "theta"
y = "p_theta"
[[views]]
kind = "time"
y = "sin(theta)"
"#;

fn names(system: &System) -> Vec<&str> {
    system.channels().iter().map(|c| c.name.as_str()).collect()
}

fn values(system: &System, model: &Model, state: &State) -> Vec<f64> {
    let mut out = vec![0.0; system.channels().len()];
    system.observer(&parameters(model)).observe(state, &mut out).expect("regular");
    out
}

#[test]
fn columns_stand_in_the_order_of_the_format() {
    let (_, system) = compile(TOP);
    let columns = &names(&system)[..system.columns()];
    assert_eq!(
        columns,
        [
            "theta",
            "phi",
            "psi",
            "theta'",
            "phi'",
            "psi'",
            "p_theta",
            "p_phi",
            "p_psi",
            "energy",
            "nutation energy",
            "axial spin"
        ]
    );
    let theta = &system.channels()[0];
    assert_eq!((theta.shown.as_str(), theta.unit.as_str(), theta.periodic), ("θ", "rad", false));
    assert_eq!(system.channels()[4].shown, "φ′");
    assert!(system.channels()[1].periodic);
}

#[test]
fn extra_channels_are_columns_after_the_observables() {
    let mut model = preset::read(PENDULUM).expect("right").model;
    let q = model.coordinates[0].position;
    let expression = model.pool.variable(q);
    let expression = model.pool.powi(expression, 2);
    let equations = derive(&model).expect("small");
    let extra = model::WrittenExpr { written: "theta^2".to_owned(), expression };
    let system = System::compile(&model, &equations, &[extra]).expect("complete");
    let columns = &names(&system)[..system.columns()];
    assert_eq!(columns, ["theta", "theta'", "p_theta", "energy", "pull", "theta^2"]);
    assert_eq!(system.channels()[5].kind, ChannelKind::Extra(0));
}

#[test]
fn channels_are_found_by_their_expressions() {
    let (model, system) = compile(PENDULUM);
    let view = &model.views[0];
    let place = |c: &model::WrittenExpr| system.channel_of(c.expression);
    assert_eq!(place(&view.axes[0][0]), Some(0));
    assert_eq!(place(&view.axes[1][0]), Some(2));
    let sine = place(&model.views[1].axes[0][0]).expect("it is watched");
    assert_eq!(system.channels()[sine].kind, ChannelKind::Expression);
    assert!(sine >= system.columns());
    let state = system.initial(0.0, &parameters(&model), &[]).expect("regular");
    assert_eq!(values(&system, &model, &state)[sine], 2.0_f64.sin());
    let conserved = |c: &phaselab::system::Channel| c.kind == ChannelKind::Conserved(0);
    assert!(system.channels().iter().any(conserved), "the energy is conserved");
    assert_eq!(system.period(0, &[2.0]), Some(4.0 * std::f64::consts::PI));
    assert_eq!(system.period(1, &[2.0]), None);
}

#[test]
fn values_follow_from_the_state() {
    let (model, system) = compile(PENDULUM);
    let mut state = system.initial(0.0, &parameters(&model), &[]).expect("regular");
    assert_eq!(state.values, [2.0, 0.5, 0.0], "the action is carried along, and begins at zero");
    state.values[2] = 0.25;
    let out = values(&system, &model, &state);
    let pull = -2.0_f64.sin() + 0.25;
    assert_eq!(out[..5], [2.0, 0.5, 1.0, 0.25 - 2.0 * 2.0_f64.cos(), pull]);
}

#[test]
fn accelerations_of_a_hamiltonian_follow_its_flow() {
    let (model, system) = compile(
        r#"
title = "Relativistic charge in a driven field"
[coordinates]
x = { initial = 0.3, momentum = 0.8 }
[hamiltonian]
H = "sqrt(1 + (p_x - t*x)^2) + 1/2*x^2"
[[observables]]
name = "acceleration"
expression = "x''"
"#,
    );
    let parameters = parameters(&model);
    let at = |t: f64, x: f64, p: f64| {
        let state = State::new(t, Form::Momentum, vec![x, p, 0.0]);
        let out = values(&system, &model, &state);
        (out[1], out[4])
    };
    // the velocity a little later and earlier on the same path, by the equations of motion
    let (t, x, p, h) = (0.7, 0.3, 0.8, 1e-5);
    let k = p - t * x;
    let root = f64::sqrt(1.0 + k * k);
    let (velocity, force) = (k / root, k * t / root - x);
    let slope = (at(t + h, x + h * velocity, p + h * force).0
        - at(t - h, x - h * velocity, p - h * force).0)
        / (2.0 * h);
    assert!((at(t, x, p).1 - slope).abs() < 1e-9);
    assert_eq!(parameters.len(), 0);
}

#[test]
fn both_forms_show_the_same() {
    let (model, system) = compile(TOP);
    let p = parameters(&model);
    let state = system.initial(0.0, &p, &[]).expect("regular");
    let canonical = system.convert(&state, Form::Momentum, &p).expect("regular");
    assert_eq!(canonical.form, Form::Momentum);
    let (a, b) = (values(&system, &model, &state), values(&system, &model, &canonical));
    for (i, (a, b)) in a.iter().zip(&b).enumerate() {
        let name = &system.channels()[i].name;
        assert!((a - b).abs() <= 4e-16 * a.abs() + 1e-30, "{name}: {a} and {b}");
    }
}

#[test]
fn the_energy_on_a_grid_is_the_energy() {
    let (model, system) = compile(PENDULUM);
    let mut observer = system.observer(&parameters(&model));
    let (positions, rates) = ([-1.0, 0.0, 2.0], [0.5, 3.0]);
    let mut grid = [0.0; 6];
    observer.energy_on_grid(0.0, Form::Velocity, &positions, &rates, &mut grid);
    assert_eq!(grid[5], 9.0 - 2.0 * 2.0_f64.cos());
    observer.energy_on_grid(0.0, Form::Momentum, &positions, &rates, &mut grid);
    assert_eq!(grid[3], 9.0 / 4.0 - 2.0 * (-1.0_f64).cos());
    assert_eq!(grid[1], 0.25 / 4.0 - 2.0);
}

#[test]
fn a_row_of_the_grid_has_the_energy_of_every_point() {
    let (model, system) = compile(
        r#"
title = "A step that is smooth"
[coordinates]
x = { initial = 1.0 }
[lagrangian]
L = "1/2*(2 + cos(x))*x'^2 - exp(x)/(1 + exp(x)) + ln(x + 5)"
"#,
    );
    let mut observer = system.observer(&parameters(&model));
    // exp(800) leaves the range of numbers, ln(-1) has no value, and 19 is no multiple of anything
    let positions: Vec<f64> =
        (0..19).map(|i| if i == 3 { 800.0 } else { f64::from(i) - 6.0 }).collect();
    for form in [Form::Velocity, Form::Momentum] {
        let mut grid = [0.0; 38];
        let rates = [0.3, -7.0];
        observer.energy_on_grid(0.0, form, &positions, &rates, &mut grid);
        for (k, energy) in grid.into_iter().enumerate() {
            let (x, rate) = (positions[k % 19], rates[k / 19]);
            let mass = 2.0 + x.cos();
            let kinetic =
                0.5 * rate * rate * if form == Form::Velocity { mass } else { 1.0 / mass };
            let exact = kinetic + 1.0 / (1.0 + (-x).exp()) - (x + 5.0).ln();
            let right = if x <= -5.0 {
                !energy.is_finite()
            } else {
                (energy - exact).abs() < 1e-15 * (kinetic + 8.0)
            };
            assert!(right, "{energy} at {x}, and not {exact}");
        }
    }
}

/// What depends on the place alone is evaluated once for all rates.
#[test]
fn a_grid_has_the_bits_of_its_points() {
    let (model, system) = compile(
        r#"
title = "A well with an edge"
[coordinates]
x = { initial = 1.0 }
[lagrangian]
L = "1/2*(2 + cos(x))*x'^2 + sin(x)*x' - sqrt(x + 2)"
"#,
    );
    let mut observer = system.observer(&parameters(&model));
    let positions: Vec<f64> = (0..21).map(|i| 0.37 * f64::from(i) - 4.0).collect();
    let rates = [-1.3, 0.0, 0.7, 1e200, 4.0];
    for form in [Form::Velocity, Form::Momentum] {
        let mut grid = vec![0.0; positions.len() * rates.len()];
        observer.energy_on_grid(0.0, form, &positions, &rates, &mut grid);
        assert_eq!(grid.iter().filter(|energy| energy.is_nan()).count(), 6 * rates.len());
        for (k, energy) in grid.into_iter().enumerate() {
            let (x, rate) = (positions[k % 21], rates[k / 21]);
            let mut alone = [0.0];
            observer.energy_on_grid(0.0, form, &[x], &[rate], &mut alone);
            let same =
                alone[0].to_bits() == energy.to_bits() || alone[0].is_nan() && energy.is_nan();
            assert!(same, "{energy} at {x}, {rate}, alone {}", alone[0]);
        }
    }
}

/// Where L has a term linear in the velocity, and a mass that depends on the place and vanishes somewhere.
#[test]
fn the_energy_on_a_grid_follows_from_momenta_that_are_not_zero_at_rest() {
    let (model, system) = compile(
        r#"
title = "Beside a singular point"
[coordinates]
x = { initial = 1.0 }
[lagrangian]
L = "1/2*x^2*x'^2 + 3*x*x' - x^4"
"#,
    );
    let mut observer = system.observer(&parameters(&model));
    let (positions, rates) = ([-1.5, 0.0, 2.0], [-0.7, 5.0]);
    let mut grid = [0.0; 6];
    observer.energy_on_grid(0.0, Form::Momentum, &positions, &rates, &mut grid);
    for (k, energy) in grid.into_iter().enumerate() {
        let (x, p) = (positions[k % 3], rates[k / 3]);
        let exact = (p - 3.0 * x) * (p - 3.0 * x) / (2.0 * x * x) + x * x * x * x;
        let right = if x == 0.0 { energy.is_nan() } else { (energy / exact - 1.0).abs() < 1e-15 };
        assert!(right, "{energy} at {x}, {p}, and not {exact}");
    }
}

#[test]
fn where_there_is_no_energy_the_grid_has_no_number() {
    let (model, system) = compile(
        r#"
title = "Relativistic particle"
[coordinates]
x = { initial = 1.0 }
[lagrangian]
L = "-sqrt(1 - x'^2) + sqrt(x)"
"#,
    );
    let mut observer = system.observer(&parameters(&model));
    let mut grid = [0.0; 4];
    observer.energy_on_grid(0.0, Form::Velocity, &[1.0, -1.0], &[0.6, 2.0], &mut grid);
    assert!((grid[0] - 0.25).abs() < 1e-15);
    assert!(grid[1..].iter().all(|x| x.is_nan()), "{grid:?}");
    observer.energy_on_grid(0.0, Form::Momentum, &[1.0, -1.0], &[0.75, 20.0], &mut grid);
    assert!((grid[0] - 0.25).abs() < 1e-15);
    // the energy of a speed of 0.99875 changes 8000 times as fast as the speed
    assert!((grid[2] - (401.0_f64.sqrt() - 1.0)).abs() < 1e-11, "{grid:?}");
}

#[test]
fn the_ledger_stands_where_energy_is_not_conserved() {
    let (_, system) = compile(PENDULUM);
    assert!(system.channels().iter().all(|c| c.kind != ChannelKind::EnergyBalance));
    let (model, system) = compile(include_str!("../../../presets/pendulums/damped-pendulum.toml"));
    let balance = system.channels().iter().position(|c| c.kind == ChannelKind::EnergyBalance);
    let balance = balance.expect("friction does work");
    let mut state = system.initial(0.0, &parameters(&model), &[]).expect("regular");
    let before = values(&system, &model, &state);
    let last = state.values.len() - 1;
    state.values[last] = -1.5;
    let after = values(&system, &model, &state);
    assert_eq!(before[3], before[balance]);
    assert!((after[balance] - before[balance] - 1.5).abs() < 1e-14);
}

#[test]
fn what_has_no_value_is_refused() {
    let mut model = preset::read(PENDULUM).expect("right").model;
    let stray = model.pool.named("stray");
    model.observables[0].expression = stray;
    let equations = derive(&model).expect("small");
    let outcome = System::compile(&model, &equations, &[]);
    assert_eq!(outcome.err(), Some(CompileError::Unknown("stray".to_owned())));
}

#[test]
fn momenta_and_energies_have_the_units_that_follow_from_the_file() {
    for (name, channel, unit) in [
        ("pendulum", "p_theta", "kg m²/s"),
        ("pendulum", "energy", "J"),
        ("planet", "p_r", "M⊕ au/yr"),
        ("elastic-pendulum", "p_r", "kg m/s"),
        ("pendulum-rod", "tension", "N"),
        ("smooth-sphere", "reaction", "N"),
    ] {
        let Ok(document) = crate::fixtures::catalog().find(name) else {
            panic!("no preset {name}")
        };
        let model = document.read().unwrap().model;
        let equations = phaselab::mechanics::derive(&model).unwrap();
        let system = phaselab::system::System::compile(&model, &equations, &[]).unwrap();
        let found = system.channels().iter().find(|c| c.name == channel);
        let found = found.unwrap_or_else(|| panic!("{name} has no {channel}"));
        assert_eq!(found.unit, unit, "{name} {channel}");
    }
}
