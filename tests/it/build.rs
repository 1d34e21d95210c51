//! Small models built in a line, for tests of the layers below the file format.

use phaselab::expr::{Expr, Symbol, SyntaxError};
use phaselab::model::{
    Allowed, Constraint, Coordinate, Mechanics, Model, Parameter, RangeSpacing, Scope,
};

/// A model with coordinates and parameters, and no law yet.
pub(crate) fn names(coordinates: &[&str], parameters: &[&str]) -> Model {
    let mut model = Model::new("test");
    for name in parameters {
        let symbol = model.pool.symbol(name);
        model.parameters.push(Parameter {
            name: (*name).to_owned(),
            shown: (*name).to_owned(),
            symbol,
            value: 1.0,
            min: 0.0,
            max: 2.0,
            scale: RangeSpacing::Linear,
            unit: String::new(),
            about: String::new(),
        });
    }
    for name in coordinates {
        let coordinate = Coordinate::new(&mut model.pool, name, "", "");
        model.coordinates.push(coordinate);
    }
    model
}

/// A Lagrangian system with Rayleigh's function and forces ("0" for none).
pub(crate) fn dissipative(
    coordinates: &[&str],
    parameters: &[&str],
    l: &str,
    f: &str,
    forces: &[&str],
) -> Model {
    let mut model = names(coordinates, parameters);
    let lagrangian = read(&mut model, l);
    let dissipation = read(&mut model, f);
    let forces = forces.iter().map(|q| read(&mut model, q)).collect();
    model.mechanics = Mechanics::Lagrangian { lagrangian, dissipation, forces };
    model
}

/// A Lagrangian system.
pub(crate) fn lagrangian(coordinates: &[&str], parameters: &[&str], l: &str) -> Model {
    dissipative(coordinates, parameters, l, "0", &[])
}

/// A Hamiltonian system.
pub(crate) fn hamiltonian(coordinates: &[&str], parameters: &[&str], h: &str) -> Model {
    let mut model = names(coordinates, parameters);
    let hamiltonian = read(&mut model, h);
    model.mechanics = Mechanics::Hamiltonian { hamiltonian, forces: Vec::new() };
    model
}

/// Parses an expression in a model's names.
pub(crate) fn try_read(model: &mut Model, text: &str) -> Result<Expr, Vec<SyntaxError>> {
    let mut scope = Scope::new(model, Allowed::Observable, "a test");
    let e = scope.read(&mut model.pool, text);
    e.ok_or(scope.diagnostics)
}

/// Parses a valid expression in a model's names.
pub(crate) fn read(model: &mut Model, text: &str) -> Expr {
    try_read(model, text).unwrap_or_else(|diagnostics| panic!("{text}: {diagnostics:?}"))
}

/// A reproducible value in (0.2, 1.2) for each symbol; it depends on the seed.
pub(crate) fn sample(seed: u64) -> impl Fn(Symbol) -> f64 {
    move |s| {
        let mut x =
            (s.index() as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ (seed << 32 | seed);
        x ^= x >> 33;
        x = x.wrapping_mul(0xFF51_AFD7_ED55_8CCD);
        x ^= x >> 29;
        0.2 + (x >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Adds constraints, by name and expression.
pub(crate) fn constrain(model: &mut Model, constraints: &[(&str, &str)]) {
    for (name, text) in constraints {
        let e = read(model, text);
        let only = constraints.len() == 1;
        let constraint = Constraint::new(&mut model.pool, name, e, only);
        model.constraints.push(constraint);
    }
}
