//! Rigid bodies composed of pieces: tensors compared with integrals over the solids, principal moments,
//! names that follow the parameters, attitudes.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use phaselab::claims::structure_diagnostics;
use phaselab::expr::{Expr, Pool, Zero};
use phaselab::integrate::{Settings, method_named};
use phaselab::mechanics::{self, COMPONENTS, Class, body_constants, principal};
use phaselab::model::{
    Attitude, AttitudeSource, Body, BodyNames, Model, Observable, Piece, PieceOrientation, Solid,
    WrittenExpr,
};
use phaselab::num::DoubleDouble;
use phaselab::preset;
use phaselab::system::System;

use crate::build::{lagrangian, names, read};
use crate::poisson::BODY;

/// The three nodes of Gauss–Legendre quadrature on (0, 1), exact to the fifth degree.
const NODES: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 5.0 / 18.0),
    (0.5, 4.0 / 9.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// Points with masses that sum to one and have the second moments of a solid.
fn points(solid: &str, [a, b, c]: [f64; 3]) -> Vec<(Vector3<f64>, f64)> {
    let round = || (0..8).map(|k| (f64::from(k) + 0.3) * TAU / 8.0);
    let mut all = Vec::new();
    match solid {
        "point" => all.push((Vector3::zeros(), 1.0)),
        "sphere" | "shell" => {
            let radii: Vec<(f64, f64)> = match solid {
                "sphere" => NODES.iter().map(|&(s, w)| (a * s, 3.0 * w * s * s)).collect(),
                _ => vec![(a, 1.0)],
            };
            for (r, w) in radii {
                for (u, v) in NODES.map(|(u, v)| (2.0 * u - 1.0, v)) {
                    let across = r * (1.0 - u * u).sqrt();
                    all.extend(round().map(|f| {
                        (Vector3::new(across * f.cos(), across * f.sin(), r * u), w * v / 8.0)
                    }));
                }
            }
        }
        "cuboid" => {
            for (x, u) in NODES {
                for (y, v) in NODES {
                    for (z, w) in NODES {
                        let at = Vector3::new(a * (x - 0.5), b * (y - 0.5), c * (z - 0.5));
                        all.push((at, u * v * w));
                    }
                }
            }
        }
        _ => {
            // (radius, share) in the cross-section, (height, taper) along the axis
            let full: Vec<(f64, f64)> = NODES.iter().map(|&(s, w)| (a * s, 2.0 * w * s)).collect();
            let radii = match solid {
                "cylinder" | "cone" | "disc" => full,
                "rod" => vec![(0.0, 1.0)],
                _ => vec![(a, 1.0)],
            };
            let heights: Vec<(f64, f64, f64)> = match solid {
                "disc" | "ring" => vec![(0.0, 1.0, 1.0)],
                "cone" => NODES
                    .iter()
                    .map(|&(s, w)| (b * (s - 0.25), 3.0 * w * (1.0 - s).powi(2), 1.0 - s))
                    .collect(),
                _ => NODES.iter().map(|&(s, w)| (b * (s - 0.5), w, 1.0)).collect(),
            };
            for &(z, share, taper) in &heights {
                for &(r, w) in &radii {
                    all.extend(round().map(|f| {
                        let r = r * taper;
                        (Vector3::new(r * f.cos(), r * f.sin(), z), share * w / 8.0)
                    }));
                }
            }
        }
    }
    all
}

fn solid(name: &str, [a, b, c]: [Expr; 3]) -> Solid {
    match name {
        "point" => Solid::Point,
        "sphere" => Solid::Sphere(a),
        "shell" => Solid::SphericalShell(a),
        "cuboid" => Solid::Cuboid([a, b, c]),
        "cylinder" => Solid::Cylinder { radius: a, length: b },
        "tube" => Solid::CylindricalShell { radius: a, length: b },
        "cone" => Solid::Cone { radius: a, height: b },
        "disc" => Solid::Disc(a),
        "ring" => Solid::Ring(a),
        "rod" => Solid::Rod(b),
        _ => panic!("{name}"),
    }
}

fn body_names(pool: &mut Pool) -> BodyNames {
    let mut symbols = |names: [&str; 3]| names.map(|name| pool.symbol(name));
    let [xx, yy, zz] = symbols(["Ixx", "Iyy", "Izz"]);
    let [xy, xz, yz] = symbols(["Ixy", "Ixz", "Iyz"]);
    let principal = symbols(["I1", "I2", "I3"]);
    let centre = symbols(["body_x", "body_y", "body_z"]);
    let mass = pool.symbol("body_mass");
    BodyNames { inertia: [xx, yy, zz, xy, xz, yz], principal, mass, centre }
}

/// A piece: solid, sizes, mass, position, rotation.
type Written<'a> = (&'a str, [&'a str; 3], &'a str, [&'a str; 3], Turned<'a>);

#[derive(Clone, Copy)]
enum Turned<'a> {
    Not,
    Axis([&'a str; 3], &'a str),
    Euler([&'a str; 3]),
}

fn with_body(mut model: Model, pieces: &[Written<'_>]) -> Model {
    let pieces = pieces
        .iter()
        .map(|&(name, sizes, mass, at, turn)| {
            let mut point = |all: [&str; 3]| all.map(|text| read(&mut model, text));
            let (sizes, at) = (point(sizes), point(at));
            let turn = match turn {
                Turned::Not => PieceOrientation::None,
                Turned::Euler(angles) => PieceOrientation::Euler(point(angles)),
                Turned::Axis(axis, angle) => {
                    let axis = point(axis);
                    PieceOrientation::Axis { axis, angle: read(&mut model, angle) }
                }
            };
            Piece { solid: solid(name, sizes), mass: read(&mut model, mass), at, turn, place: 5..9 }
        })
        .collect();
    let names = body_names(&mut model.pool);
    model.body = Some(Body { pieces, names, place: 1..3 });
    model
}

/// The values of the names, in their order.
fn values(model: &Model) -> Vec<f64> {
    body_constants(model, &model.parameter_values()).into_iter().map(|(_, x)| x).collect()
}

fn number(text: &str) -> f64 {
    let mut model = names(&["x"], &[]);
    let e = read(&mut model, text);
    model.pool.evaluate(e, &|_| f64::NAN)
}

/// The rotation of a piece, built by another library.
fn rotation(turn: Turned<'_>) -> Rotation3<f64> {
    match turn {
        Turned::Not => Rotation3::identity(),
        Turned::Axis(axis, angle) => {
            let axis = Unit::new_normalize(Vector3::from(axis.map(number)));
            Rotation3::from_axis_angle(&axis, number(angle))
        }
        Turned::Euler(angles) => {
            let [phi, theta, psi] = angles.map(number);
            let about = |axis, angle| Rotation3::from_axis_angle(&axis, angle);
            let (x, z) = (Vector3::x_axis(), Vector3::z_axis());
            about(z, phi) * about(x, theta) * about(z, psi)
        }
    }
}

/// Compares a body's derived values with sums over points.
fn check(pieces: &[Written<'_>]) -> Vec<f64> {
    let found = values(&with_body(names(&["x"], &[]), pieces));
    let mut all: Vec<(Vector3<f64>, f64)> = Vec::new();
    for &(name, sizes, mass, at, turn) in pieces {
        let (rotation, at) = (rotation(turn), Vector3::from(at.map(number)));
        let own = points(name, sizes.map(number)).into_iter();
        all.extend(own.map(|(x, share)| (rotation * x + at, share * number(mass))));
    }
    let mass: f64 = all.iter().map(|(_, m)| m).sum();
    let centre = all.iter().map(|(x, m)| x * *m).sum::<Vector3<f64>>() / mass;
    let tensor = all.iter().fold(Matrix3::zeros(), |sum, (x, m)| {
        let d = x - centre;
        sum + (Matrix3::identity() * d.norm_squared() - d * d.transpose()) * *m
    });
    let scale = tensor.amax().max(1e-300);
    let label = pieces[0].0;
    for (&(i, j), x) in COMPONENTS.iter().zip(&found) {
        assert!(
            (x - tensor[(i, j)]).abs() < 1e-14 * scale,
            "{label} {i}{j}: {x}, not {}",
            tensor[(i, j)]
        );
    }
    assert!((found[9] - mass).abs() < 1e-14 * mass.abs(), "{label}: mass {}", found[9]);
    for k in 0..3 {
        let size = centre.amax().max(1.0);
        assert!((found[10 + k] - centre[k]).abs() < 1e-14 * size, "{label}: {}", found[10 + k]);
    }
    found
}

const SOLIDS: [&str; 10] =
    ["point", "sphere", "shell", "cuboid", "cylinder", "tube", "cone", "disc", "ring", "rod"];

#[test]
fn every_solid_has_the_tensor_of_the_integral_over_it() {
    for name in SOLIDS {
        for turn in [
            Turned::Not,
            Turned::Axis(["1", "-2", "1/2"], "pi/3"),
            Turned::Axis(["0", "3", "0"], "-0.7"),
            Turned::Euler(["0.4", "1.1", "-2.3"]),
        ] {
            check(&[(name, ["0.7", "1.3", "2.1"], "2.5", ["0.3", "-1.2", "0.8"], turn)]);
        }
    }
}

#[test]
fn a_body_of_many_pieces_is_their_sum_by_parallel_axes() {
    let turn = Turned::Euler(["0.4", "1.1", "-2.3"]);
    check(&[
        ("cuboid", ["1", "2", "3"], "4", ["0", "0", "1"], turn),
        ("cone", ["0.5", "1.5", "0"], "2", ["1", "-1", "0"], Turned::Axis(["1", "1", "1"], "1")),
        ("point", ["0"; 3], "0.25", ["-2", "0.5", "0"], Turned::Not),
        // a hole
        ("sphere", ["0.2", "0", "0"], "-0.1", ["0", "0", "1"], Turned::Not),
    ]);
    // two points: I = 2 m d² about a perpendicular axis, nothing about their own
    let found = values(&with_body(
        names(&["x"], &[]),
        &[
            ("point", ["0"; 3], "3", ["2", "0", "0"], Turned::Not),
            ("point", ["0"; 3], "3", ["-2", "0", "0"], Turned::Not),
        ],
    ));
    assert_eq!(found, [0.0, 24.0, 24.0, 0.0, 0.0, 0.0, 0.0, 24.0, 24.0, 6.0, 0.0, 0.0, 0.0]);
    // a cube about a corner's axes: the product of inertia carries the minus sign
    let found = values(&with_body(
        names(&["x"], &[]),
        &[
            ("point", ["0"; 3], "1", ["1", "1", "0"], Turned::Not),
            ("point", ["0"; 3], "1", ["-1", "-1", "0"], Turned::Not),
        ],
    ));
    assert_eq!(found[3], -2.0, "Ixy = −Σ m x y");
}

#[test]
fn a_turned_body_has_the_same_moments_about_turned_axes() {
    let upright = check(&[("cuboid", ["1", "2", "3"], "12", ["0"; 3], Turned::Not)]);
    assert_eq!(upright[6..9], [5.0, 10.0, 13.0]);
    let turn = Turned::Axis(["1", "-2", "1/2"], "1.2");
    let turned = check(&[("cuboid", ["1", "2", "3"], "12", ["0"; 3], turn)]);
    for (a, b) in turned[6..9].iter().zip([5.0, 10.0, 13.0]) {
        assert!((a - b).abs() < 4e-15 * b, "{a} is not {b}");
    }
    let tensor: [f64; 6] = turned[..6].try_into().unwrap();
    let (moments, axes) = principal(&tensor.map(DoubleDouble::from));
    let matrix = Matrix3::from_fn(|i, j| mechanics::matrix(&tensor)[i][j]);
    let own = rotation(turn);
    // the edges of 3, 2 and 1 are the axes of the least, middle and greatest moment
    for (k, edge) in [(0, 2), (1, 1), (2, 0)] {
        let axis = Vector3::from(axes[k]);
        assert!((matrix * axis - axis * moments[k].high).amax() < 2e-14);
        assert!((axis.dot(&(own * Vector3::ith(edge, 1.0))).abs() - 1.0).abs() < 1e-14);
    }
    let determinant = Matrix3::from_fn(|i, j| axes[i][j]).determinant();
    assert!((determinant - 1.0).abs() < 1e-14, "{determinant}");
}

#[test]
fn moments_are_ascending_and_exact_where_the_tensor_is_diagonal() {
    let tenth = DoubleDouble::from_decimal(0.1);
    let diagonal = [DoubleDouble::integer(3), tenth, DoubleDouble::integer(2)];
    let zero = [DoubleDouble::ZERO; 3];
    let tensor: [DoubleDouble; 6] = [diagonal, zero].concat().try_into().unwrap();
    let (moments, axes) = principal(&tensor);
    assert_eq!(moments, [tenth, DoubleDouble::integer(2), DoubleDouble::integer(3)]);
    assert_eq!(axes[0], [0.0, 1.0, 0.0]);
    assert_eq!(axes[1], [0.0, 0.0, 1.0]);
    assert_eq!(axes[2], [1.0, 0.0, 0.0]);
    // (x, y) = (2 1; 1 2): moments 1 and 3, beside 2
    let mut tensor = [DoubleDouble::integer(2); 6];
    (tensor[3], tensor[4], tensor[5]) = (DoubleDouble::ONE, DoubleDouble::ZERO, DoubleDouble::ZERO);
    let (moments, _) = principal(&tensor);
    for (moment, right) in moments.iter().zip([1.0, 2.0, 3.0]) {
        assert!((moment.high - right).abs() + moment.low.abs() < 1e-28, "{moment:?}");
    }
    assert!(principal(&[DoubleDouble::from(f64::NAN); 6]).0[0].high.is_nan());
}

#[test]
fn its_names_follow_the_parameters_into_the_motion() {
    let model = names(&["theta"], &["m", "a", "h", "k"]);
    let mut model = with_body(
        model,
        &[
            ("cylinder", ["a", "h", "0"], "m", ["0", "0", "h/2"], Turned::Not),
            ("point", ["0"; 3], "2*m", ["a", "0", "0"], Turned::Euler(["0", "0", "0"])),
        ],
    );
    let body = model.body.clone();
    let scope = |model: &mut Model, text: &str| read(model, text);
    let l = scope(&mut model, "1/2*(Izz + body_mass*body_x^2)*theta'^2 - k*theta^2/2");
    model.mechanics = lagrangian(&["theta"], &[], "0").mechanics;
    if let phaselab::model::Mechanics::Lagrangian { lagrangian, .. } = &mut model.mechanics {
        *lagrangian = l;
    }
    model.body = body;
    model.coordinates[0].initial = scope(&mut model, "I3/I1");
    let watched = scope(&mut model, "theta''");
    let equations = mechanics::derive(&model).expect("derivable");
    let extra = WrittenExpr { written: "a".to_owned(), expression: watched };
    let system = System::compile(&model, &equations, &[extra]).expect("compiles");
    let place = system.channels().iter().position(|c| c.name == "a").unwrap();
    for [m, a, h, k] in [[1.0_f64, 1.0, 1.0, 1.0], [2.0, 0.5, 3.0, 0.7]] {
        let parameters = [m, a, h, k];
        // derived on paper: centre at (2a/3, 0, h/6)
        let [x, z] = [2.0 * a / 3.0, h / 6.0];
        let [dz, dx] = [h / 2.0 - z, a - x];
        let across = m * (a * a / 4.0 + h * h / 12.0);
        let xx = across + m * dz * dz + 2.0 * m * z * z;
        let yy = across + m * (dz * dz + x * x) + 2.0 * m * (z * z + dx * dx);
        let zz = m * a * a / 2.0 + m * x * x + 2.0 * m * dx * dx;
        let xz = m * x * dz + 2.0 * m * dx * z;
        let half = ((xx - zz) / 2.0).hypot(xz);
        let middle = f64::midpoint(xx, zz);
        let mut moments = [middle - half, yy, middle + half];
        moments.sort_by(f64::total_cmp);
        let state = system.initial(0.0, &parameters, &[]).expect("a start");
        let ratio = moments[2] / moments[0];
        assert!((state.values[0] - ratio).abs() < 1e-14 * ratio, "{} {ratio}", state.values[0]);
        let mut values = vec![0.0; system.channels().len()];
        system.observer(&parameters).observe(&state, &mut values).expect("values");
        let right = -k * ratio / (zz + 3.0 * m * x * x);
        assert!((values[place] - right).abs() < 1e-14 * right.abs(), "{} {right}", values[place]);
        let values = system.body_values(&parameters);
        assert!((values[8].1 - moments[2]).abs() < 1e-14 * moments[2]);
    }
}

#[test]
fn senseless_bodies_are_refused_at_their_place() {
    let diagnostics_of = |pieces: &[Written<'_>]| {
        let model = with_body(names(&["x"], &[]), pieces);
        let equations = mechanics::derive(&model).expect("derivable");
        let found = structure_diagnostics(&model, &equations).into_iter();
        found.map(|m| (m.place, m.message)).collect::<Vec<_>>()
    };
    let ball = ("sphere", ["0.5", "0", "0"], "1", ["0"; 3], Turned::Not);
    assert!(diagnostics_of(&[ball]).is_empty());
    let negative =
        diagnostics_of(&[("cuboid", ["1", "-2", "1"], "1", ["0"; 3], Turned::Not), ball]);
    assert_eq!(negative, [(5..9, "a size of this piece is -2".to_owned())]);
    let hole = ("sphere", ["0.5", "0", "0"], "-1", ["1", "0", "0"], Turned::Not);
    assert_eq!(
        diagnostics_of(&[ball, hole]),
        [(1..3, "the masses of this body sum to 0".to_owned())]
    );
    let still = ("rod", ["0", "1", "0"], "1", ["0"; 3], Turned::Axis(["0"; 3], "1"));
    assert_eq!(diagnostics_of(&[still])[0].1, "the axis this piece is turned about has no length");
}

#[test]
fn an_attitude_by_angles_is_the_matrix_of_the_books() {
    // Goldstein, *Classical Mechanics*, eq. (4.46), A = BCD
    let mut model = names(&["theta", "phi", "psi"], &[]);
    let l = read(&mut model, "(theta'^2 + phi'^2 + psi'^2)/2");
    if let phaselab::model::Mechanics::Lagrangian { lagrangian, .. } = &mut model.mechanics {
        *lagrangian = l;
    }
    let angles = ["phi", "theta", "psi"].map(|text| read(&mut model, text));
    let symbol = |model: &mut Model, i, j| model.pool.symbol(&format!("A{i}{j}"));
    let matrix = [1, 2, 3].map(|i| [1, 2, 3].map(|j| symbol(&mut model, i, j)));
    model.attitude = Some(Attitude { matrix, source: AttitudeSource::Euler(angles) });
    let trace =
        matrix.concat().iter().step_by(4).map(|&s| model.pool.variable(s)).collect::<Vec<_>>();
    let trace = model.pool.sum(&trace);
    for (i, value) in [3, 5, -7].into_iter().enumerate() {
        model.coordinates[i].initial = model.pool.ratio(value, 10);
    }
    let mut equations = mechanics::derive(&model).expect("derivable");
    let channels: Vec<WrittenExpr> = matrix
        .concat()
        .iter()
        .map(|&s| WrittenExpr { written: String::new(), expression: equations.pool.variable(s) })
        .chain([WrittenExpr { written: String::new(), expression: trace }])
        .collect();
    let system = System::compile(&model, &equations, &channels).expect("compiles");
    let state = system.initial(0.0, &[], &[]).expect("a start");
    let mut values = vec![0.0; system.channels().len()];
    system.observer(&[]).observe(&state, &mut values).expect("values");
    let found = &values[system.columns() - 10..system.columns()];
    let [[s, c], [sf, cf], [sp, cp]] = [0.3, 0.5, -0.7_f64].map(|x| [x.sin(), x.cos()]);
    let right = [
        cp * cf - c * sf * sp,
        cp * sf + c * cf * sp,
        sp * s,
        -sp * cf - c * sf * cp,
        -sp * sf + c * cf * cp,
        cp * s,
        s * sf,
        -s * cf,
        c,
    ];
    for (k, right) in right.iter().enumerate() {
        assert!((found[k] - right).abs() < 1e-15, "A{k}: {} is not {right}", found[k]);
    }
    // Euler's theorem: tr A = 1 + 2 cos Φ, cos(Φ/2) = cos(θ/2) cos((φ + ψ)/2)
    let half = 0.15_f64.cos() * (-0.1_f64).cos();
    assert!((found[9] - (4.0 * half * half - 1.0)).abs() < 1e-15, "{}", found[9]);
    // and the rate of A33 = cos θ is known
    let last = equations.pool.variable(matrix[2][2]);
    let rate = equations.rate_of(last).expect("a closed form");
    assert_eq!(equations.pool.text(rate), "-theta'*sin(theta)");
}

/// A free body with its attitude, from Euler's angles (φ, θ, ψ) = (0.3, 0.4, 0.5).
fn turning() -> Model {
    let mut model = preset::read(BODY).expect("a right file").model;
    let omega = ["L1/I1", "L2/I2", "L3/I3"].map(|text| read(&mut model, text));
    let start = ["0.3", "0.4", "0.5"].map(|text| read(&mut model, text));
    let matrix = [1, 2, 3].map(|i| [1, 2, 3].map(|j| model.pool.symbol(&format!("A{i}{j}"))));
    let source = AttitudeSource::Rate { omega, start };
    model.attitude = Some(Attitude { matrix, source });
    model
}

#[test]
fn a_free_body_keeps_its_angular_momentum_in_space() {
    let mut model = turning();
    let l = |model: &mut Model, j: usize| {
        let terms = [1, 2, 3].map(|i| format!("A{i}{j}*L{i}"));
        read(model, &terms.join(" + "))
    };
    for j in 1..=3 {
        let expression = l(&mut model, j);
        let (name, place) = (format!("l{j}"), 0..0);
        model.observables.push(Observable {
            name,
            expression,
            conserved: None,
            unit: String::new(),
            place,
        });
    }
    let norm = [1, 2, 3].map(|j| format!("A1{j}^2 + A2{j}^2 + A3{j}^2")).join(" + ");
    let norm = read(&mut model, &norm);
    let place = 0..0;
    let name = "alone".to_owned();
    let expression = read(&mut model, "A11");
    model.observables.push(Observable {
        name,
        expression,
        conserved: None,
        unit: String::new(),
        place,
    });
    let mut equations = mechanics::derive(&model).expect("derivable");
    let classes = mechanics::classes(&model, &mut equations);
    let found: Vec<Class> = classes.iter().map(|c| c.class).collect();
    assert_eq!(found, [Class::Proved, Class::Proved, Class::Proved, Class::Changing]);
    assert_eq!(equations.is_conserved(norm), Some(Zero::Proved));
    let (f, g) = (norm, equations.pool.named("L1"));
    let why = mechanics::bracket(&model, &mut equations, f, g).expect_err("not of phase space");
    assert!(why.to_string().contains("carried along"), "{why}");

    // and numerically, up to the end of five turns of the racket
    let mut channels = Vec::new();
    for e in [norm].into_iter().chain(model.observables.iter().map(|o| o.expression)) {
        channels.push(WrittenExpr { written: String::new(), expression: e });
    }
    let system = System::compile(&model, &equations, &channels).expect("compiles");
    let parameters = model.parameter_values();
    let state = system.initial(0.0, &parameters, &[]).expect("a start");
    let (mut first, mut last) = (vec![0.0; system.channels().len()], Vec::new());
    let mut observer = system.observer(&parameters);
    observer.observe(&state, &mut first).expect("values");
    let method = method_named("taylor").expect("the table has it");
    let mut stepper = (method.make)(&system, &Settings::default()).expect("it fits");
    stepper.start(&state, &parameters).expect("a start");
    while stepper.time() < 100.0 {
        stepper.step(100.0).expect("a step");
    }
    last.resize(first.len(), 0.0);
    observer.observe(stepper.state(), &mut last).expect("values");
    let columns = system.columns() - channels.len();
    for k in 0..4 {
        let (a, b) = (first[columns + k], last[columns + k]);
        assert!((a - b).abs() < 2e-13, "{k}: {a} became {b}");
    }
    assert!((first[columns] - 3.0).abs() < 1e-15);
    let moved = (first[columns + 4] - last[columns + 4]).abs();
    assert!(moved > 0.1, "A11 moved by {moved}");
}

#[test]
fn the_attitude_of_a_top_is_that_of_its_angles() {
    // ω from given Euler angles, integrated, gives BCD again
    let mut model = names(&["theta", "phi", "psi"], &[]);
    let l = read(&mut model, "(theta'^2 + phi'^2 + psi'^2)/2");
    if let phaselab::model::Mechanics::Lagrangian { lagrangian, .. } = &mut model.mechanics {
        *lagrangian = l;
    }
    for (c, (at, rate)) in model.coordinates.iter_mut().zip([(4, 2), (1, -3), (2, 9)]) {
        c.initial = model.pool.ratio(at, 10);
        c.initial_rate = model.pool.ratio(rate, 10);
        c.rate_given = true;
    }
    let omega = [
        "phi'*sin(theta)*sin(psi) + theta'*cos(psi)",
        "phi'*sin(theta)*cos(psi) - theta'*sin(psi)",
        "phi'*cos(theta) + psi'",
    ]
    .map(|text| read(&mut model, text));
    let start = ["0.1", "0.4", "0.2"].map(|text| read(&mut model, text));
    let matrix = [1, 2, 3].map(|i| [1, 2, 3].map(|j| model.pool.symbol(&format!("A{i}{j}"))));
    let source = AttitudeSource::Rate { omega, start };
    model.attitude = Some(Attitude { matrix, source });
    let written = [
        ("A11", "cos(psi)*cos(phi) - cos(theta)*sin(phi)*sin(psi)"),
        ("A12", "cos(psi)*sin(phi) + cos(theta)*cos(phi)*sin(psi)"),
        ("A23", "cos(psi)*sin(theta)"),
        ("A31", "sin(theta)*sin(phi)"),
        ("A33", "cos(theta)"),
    ];
    let mut channels = Vec::new();
    for (entry, right) in written {
        let entry = model.pool.named(entry);
        let right = read(&mut model, right);
        let expression = model.pool.sub(entry, right);
        channels.push(WrittenExpr { written: String::new(), expression });
    }
    let equations = mechanics::derive(&model).expect("derivable");
    let system = System::compile(&model, &equations, &channels).expect("compiles");
    let state = system.initial(0.0, &[], &[]).expect("a start");
    let method = method_named("taylor").expect("the table has it");
    let mut stepper = (method.make)(&system, &Settings::default()).expect("it fits");
    stepper.start(&state, &[]).expect("a start");
    while stepper.time() < 7.0 {
        stepper.step(7.0).expect("a step");
    }
    let mut values = vec![0.0; system.channels().len()];
    system.observer(&[]).observe(stepper.state(), &mut values).expect("values");
    let columns = system.columns() - channels.len();
    for (k, (entry, _)) in written.iter().enumerate() {
        assert!(values[columns + k].abs() < 2e-14, "{entry} is off by {:e}", values[columns + k]);
    }
}
