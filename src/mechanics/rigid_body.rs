//! A rigid body assembled from pieces: its mass, centre of mass, inertia tensor, principal moments
//! and principal axes.
//!
//! In: pieces, each a standard solid with a position and an orientation. Out: a [`RigidBody`] of
//! expressions in the parameters, and the principal moments of a tensor of numbers. Never here:
//! motion.
//! Source: *The Principles of Dynamics*, § 2.2: I_ij = Σ m (r² δ_ij − x_i x_j), so products carry
//! the minus sign; parallel axes: I = I_cm + M (R² 1 − R Rᵀ).

use nalgebra::{Matrix3, SymmetricEigen};

use super::structure_error::StructureError;
use super::valuation::Valuation;
use crate::expr::{Expr, FunctionId, Pool, Symbol};
use crate::model::{Body, Model, Piece, PieceOrientation, Point, Solid};
use crate::num::{DoubleDouble, Number};

/// A rigid body as a whole.
#[derive(Clone, Debug)]
pub struct RigidBody {
    /// M.
    pub mass: Expr,
    /// The centre of mass.
    pub centre: Point,
    /// Ixx, Iyy, Izz, Ixy, Ixz, Iyz about the centre of mass, along the file's axes.
    pub inertia: [Expr; 6],
}

/// The row and column of each of the six components.
pub const COMPONENTS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// Nine expressions, by rows.
pub type Tensor = [[Expr; 3]; 3];

pub(super) fn compose(pool: &mut Pool, body: &Body) -> RigidBody {
    let masses: Vec<Expr> = body.pieces.iter().map(|piece| piece.mass).collect();
    let mass = pool.sum(&masses);
    let mass = pool.simplify(mass);
    let centre = [0, 1, 2].map(|i| {
        if let [piece] = &body.pieces[..] {
            return piece.at[i];
        }
        let moments: Vec<Expr> =
            body.pieces.iter().map(|piece| pool.mul(piece.mass, piece.at[i])).collect();
        let moment = pool.sum(&moments);
        let moment = pool.simplify(moment);
        let place = pool.div(moment, mass);
        pool.simplify(place)
    });
    let tensors: Vec<Tensor> = body
        .pieces
        .iter()
        .map(|piece| {
            let own = turned(pool, piece);
            let away = [0, 1, 2].map(|i| pool.sub(piece.at[i], centre[i]));
            let shift = parallel(pool, piece.mass, away);
            plus(pool, own, shift)
        })
        .collect();
    let inertia = COMPONENTS.map(|(i, j)| {
        let parts: Vec<Expr> = tensors.iter().map(|tensor| tensor[i][j]).collect();
        let sum = pool.sum(&parts);
        pool.simplify(sum)
    });
    RigidBody { mass, centre, inertia }
}

/// The principal moments of a solid about its centre of mass, along its own axes.
///
/// With radius a, length l, height h, edges b: ball ⅖Ma², spherical shell ⅔Ma²; cylinder ½Ma² and
/// ¼Ma² + Ml²/12; tube Ma² and ½Ma² + Ml²/12; cone 3Ma²/10 and 3Ma²/20 + 3Mh²/80; disc ½Ma², ¼Ma²;
/// ring Ma², ½Ma²; rod Ml²/12; cuboid M(b² + c²)/12.
fn moments(pool: &mut Pool, piece: &Piece) -> [Expr; 3] {
    let mut term = |n: i64, d: i64, length: Expr| {
        let square = (length, Number::integer(2));
        let factors = [(piece.mass, Number::ONE), square];
        pool.monomial(Number::ratio(n.into(), d.into()), &factors)
    };
    let (across, along) = match piece.solid {
        Solid::Point => return [Expr::ZERO; 3],
        Solid::Sphere(r) => return [term(2, 5, r); 3],
        Solid::SphericalShell(r) => return [term(2, 3, r); 3],
        Solid::Cuboid(edges) => {
            let [a, b, c] = edges.map(|edge| term(1, 12, edge));
            return [pool.add(b, c), pool.add(c, a), pool.add(a, b)];
        }
        Solid::Cylinder { radius, length } => {
            ([term(1, 4, radius), term(1, 12, length)], term(1, 2, radius))
        }
        Solid::CylindricalShell { radius, length } => {
            ([term(1, 2, radius), term(1, 12, length)], term(1, 1, radius))
        }
        Solid::Cone { radius, height } => {
            ([term(3, 20, radius), term(3, 80, height)], term(3, 10, radius))
        }
        Solid::Disc(r) => ([term(1, 4, r), Expr::ZERO], term(1, 2, r)),
        Solid::Ring(r) => ([term(1, 2, r), Expr::ZERO], term(1, 1, r)),
        Solid::Rod(length) => ([term(1, 12, length), Expr::ZERO], Expr::ZERO),
    };
    let across = pool.sum(&across);
    [across, across, along]
}

/// A piece's tensor about its own centre of mass, along the file's axes: R diag Rᵀ.
fn turned(pool: &mut Pool, piece: &Piece) -> Tensor {
    let moments = moments(pool, piece);
    if matches!(piece.turn, PieceOrientation::None) || moments.iter().all(|&m| m == moments[0]) {
        return [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { moments[i] } else { Expr::ZERO }));
    }
    let rotation = rotation(pool, &piece.turn);
    // A 1 + Σ (moment − A) e eᵀ over the own axes e whose moment differs from the first
    let base = moments[0];
    let mut tensor = [[Expr::ZERO; 3]; 3];
    for (i, row) in tensor.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            let mut terms = vec![if i == j { base } else { Expr::ZERO }];
            for (k, &moment) in moments.iter().enumerate().skip(1) {
                let more = pool.sub(moment, base);
                terms.push(pool.product(&[more, rotation[i][k], rotation[j][k]]));
            }
            *entry = pool.sum(&terms);
        }
    }
    tensor
}

/// The rotation from a piece's own axes to the file's; its columns are the piece's axes.
fn rotation(pool: &mut Pool, turn: &PieceOrientation) -> Tensor {
    match turn {
        PieceOrientation::None => identity(),
        PieceOrientation::Euler(angles) => {
            // about z by ψ, then about x by θ, then about z by φ
            let [phi, theta, psi] = *angles;
            let (outer, middle, inner) =
                (about_z(pool, phi), about_x(pool, theta), about_z(pool, psi));
            let outer = times(pool, outer, middle);
            times(pool, outer, inner)
        }
        PieceOrientation::Axis { axis, angle } => {
            // Rodrigues: cos α 1 + (1 − cos α) n nᵀ + sin α [n]×
            let squares: Vec<Expr> = axis.iter().map(|&a| pool.powi(a, 2)).collect();
            let square = pool.sum(&squares);
            let length = pool.sqrt(square);
            let [x, y, z] = axis.map(|a| pool.div(a, length));
            let n = [x, y, z];
            let (sine, cosine) = circular(pool, *angle);
            let rest = pool.sub(Expr::ONE, cosine);
            let minus = [x, y, z].map(|e| pool.neg(e));
            let cross =
                [[Expr::ZERO, minus[2], y], [z, Expr::ZERO, minus[0]], [minus[1], x, Expr::ZERO]];
            [0, 1, 2].map(|i| {
                [0, 1, 2].map(|j| {
                    let both = pool.product(&[rest, n[i], n[j]]);
                    let turning = pool.mul(sine, cross[i][j]);
                    let same = if i == j { cosine } else { Expr::ZERO };
                    pool.sum(&[same, both, turning])
                })
            })
        }
    }
}

fn identity() -> Tensor {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { Expr::ONE } else { Expr::ZERO }))
}

fn circular(pool: &mut Pool, angle: Expr) -> (Expr, Expr) {
    (pool.call(FunctionId::Sin, &[angle]), pool.call(FunctionId::Cos, &[angle]))
}

/// The right-hand rotation about z.
fn about_z(pool: &mut Pool, angle: Expr) -> Tensor {
    let (s, c) = circular(pool, angle);
    let (o, minus) = (Expr::ZERO, pool.neg(s));
    [[c, minus, o], [s, c, o], [o, o, Expr::ONE]]
}

/// The right-hand rotation about x.
fn about_x(pool: &mut Pool, angle: Expr) -> Tensor {
    let (s, c) = circular(pool, angle);
    let (o, minus) = (Expr::ZERO, pool.neg(s));
    [[Expr::ONE, o, o], [o, c, minus], [o, s, c]]
}

fn times(pool: &mut Pool, a: Tensor, b: Tensor) -> Tensor {
    [0, 1, 2].map(|i| {
        [0, 1, 2].map(|j| {
            let terms = [0, 1, 2].map(|k| pool.mul(a[i][k], b[k][j]));
            pool.sum(&terms)
        })
    })
}

fn plus(pool: &mut Pool, a: Tensor, b: Tensor) -> Tensor {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| pool.add(a[i][j], b[i][j])))
}

/// m (d² 1 − d dᵀ).
fn parallel(pool: &mut Pool, mass: Expr, away: Point) -> Tensor {
    [0, 1, 2].map(|i| {
        [0, 1, 2].map(|j| {
            if i == j {
                let others = [(i + 1) % 3, (i + 2) % 3].map(|k| pool.powi(away[k], 2));
                let square = pool.sum(&others);
                pool.mul(mass, square)
            } else {
                let product = pool.product(&[mass, away[i], away[j]]);
                pool.neg(product)
            }
        })
    })
}

/// The symmetric matrix with these six components.
pub fn matrix<T: Copy>(inertia: &[T; 6]) -> [[T; 3]; 3] {
    let [xx, yy, zz, xy, xz, yz] = *inertia;
    [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
}

/// Principal moments, in ascending order, and their axes, one per row: unit vectors, right-handed.
///
/// The moments of a diagonal tensor are its entries. Otherwise they come from an eigendecomposition
/// and are refined to the last digit of an `f64` by the Rayleigh quotient v·Iv / v·v, whose error
/// is the square of the axis's error.
pub fn principal(inertia: &[DoubleDouble; 6]) -> ([DoubleDouble; 3], [[f64; 3]; 3]) {
    let tensor = matrix(inertia);
    let mut found: Vec<(DoubleDouble, [f64; 3])> = Vec::new();
    if inertia[3..].iter().all(|x| x.high == 0.0) {
        for i in 0..3 {
            found.push((tensor[i][i], [0, 1, 2].map(|j| f64::from(u8::from(i == j)))));
        }
    } else if inertia.iter().all(|x| x.is_finite()) {
        let eigen = SymmetricEigen::new(Matrix3::from_fn(|i, j| tensor[i][j].high));
        for axis in eigen.eigenvectors.column_iter() {
            let axis = [axis[0], axis[1], axis[2]];
            found.push((quotient(&tensor, axis), axis));
        }
    } else {
        let nothing = DoubleDouble::from(f64::NAN);
        return ([nothing; 3], [[f64::NAN; 3]; 3]);
    }
    found.sort_by(|a, b| a.0.high.total_cmp(&b.0.high).then(a.0.low.total_cmp(&b.0.low)));
    let mut axes = [0, 1, 2].map(|k| upright(found[k].1));
    let [a, b, c] = axes;
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    if cross.iter().zip(c).map(|(x, y)| x * y).sum::<f64>() < 0.0 {
        axes[2] = c.map(|x| 0.0 - x);
    }
    ([0, 1, 2].map(|k| found[k].0), axes)
}

/// The Rayleigh quotient v·Iv / v·v.
fn quotient(tensor: &[[DoubleDouble; 3]; 3], axis: [f64; 3]) -> DoubleDouble {
    let v = axis.map(DoubleDouble::from);
    let (mut above, mut below) = (DoubleDouble::ZERO, DoubleDouble::ZERO);
    for i in 0..3 {
        below = below + v[i] * v[i];
        for j in 0..3 {
            above = above + v[i] * tensor[i][j] * v[j];
        }
    }
    above / below
}

/// Returns the axis or its opposite, whichever has a positive component of largest magnitude.
fn upright(axis: [f64; 3]) -> [f64; 3] {
    let largest = axis.iter().copied().fold(0.0, |a: f64, x| if x.abs() > a.abs() { x } else { a });
    if largest < 0.0 { axis.map(|x| 0.0 - x) } else { axis }
}

/// The values of a body's names at these parameters, in the order of
/// [`BodyNames::all`](crate::model::BodyNames::all); empty if there is no body.
pub fn body_values(
    model: &Model,
    pool: &Pool,
    body: Option<&RigidBody>,
    parameters: &[f64],
) -> Vec<(Symbol, f64)> {
    let (Some(names), Some(body)) = (model.body.as_ref().map(|b| b.names), body) else {
        return Vec::new();
    };
    let known = Valuation::of_parameters(model, parameters);
    let value = |e: Expr| known.value(pool, e);
    let inertia = body.inertia.map(value);
    let (moments, _) = principal(&inertia.map(DoubleDouble::from));
    let moments = moments.map(|m| m.high);
    let single = [value(body.mass)];
    let all = [&inertia[..], &moments, &single, &body.centre.map(value)].concat();
    names.all().into_iter().zip(all).collect()
}

/// The values of a body's names at these parameters, computed before anything is derived.
pub fn body_constants(model: &Model, parameters: &[f64]) -> Vec<(Symbol, f64)> {
    let Some(body) = &model.body else { return Vec::new() };
    let mut pool = model.pool.clone();
    let whole = compose(&mut pool, body);
    body_values(model, &pool, Some(&whole), parameters)
}

/// A = B(ψ) C(θ) D(φ), which takes components along space axes to those along body axes: the
/// transpose of the rotation about z by ψ, then x by θ, then z by φ.
pub(super) fn attitude(pool: &mut Pool, angles: Point) -> Tensor {
    let rotation = rotation(pool, &PieceOrientation::Euler(angles));
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| rotation[j][i]))
}

/// Finds what is physically meaningless in a body at the file's parameters: negative sizes, no
/// mass, an axis without direction.
pub(super) fn structure_errors(
    model: &Model,
    pool: &Pool,
    whole: Option<&RigidBody>,
) -> Vec<StructureError> {
    let (Some(body), Some(whole)) = (&model.body, whole) else { return Vec::new() };
    let known = Valuation::of_parameters(model, &model.parameter_values());
    let value = |e: Expr| known.value(pool, e);
    let mut structure_errors = Vec::new();
    let mut report = |place: &crate::diagnostic::SourceRange, message: String, help: &str| {
        structure_errors.push(StructureError {
            place: Some(place.clone()),
            message,
            help: help.to_owned(),
        });
    };
    for piece in &body.pieces {
        let sizes: Vec<Expr> = match piece.solid {
            Solid::Point => Vec::new(),
            Solid::Sphere(r) | Solid::SphericalShell(r) | Solid::Disc(r) | Solid::Ring(r) => {
                vec![r]
            }
            Solid::Rod(length) => vec![length],
            Solid::Cuboid(edges) => edges.to_vec(),
            Solid::Cylinder { radius, length } | Solid::CylindricalShell { radius, length } => {
                vec![radius, length]
            }
            Solid::Cone { radius, height } => vec![radius, height],
        };
        if let Some(size) = sizes.into_iter().map(value).find(|size| *size < 0.0) {
            let message = format!("a size of this piece is {size}");
            report(&piece.place, message, "sizes are not below zero; a hole has a negative mass");
        }
        if let PieceOrientation::Axis { axis, .. } = piece.turn
            && axis.into_iter().all(|a| value(a) == 0.0)
        {
            let message = "the axis this piece is turned about has no length".to_owned();
            report(&piece.place, message, "any vector but zero is an axis: [\"0\", \"0\", \"1\"]");
        }
    }
    let mass = value(whole.mass);
    let greatest = body.pieces.iter().map(|piece| value(piece.mass).abs()).fold(0.0, f64::max);
    if mass.abs() <= 1e-14 * greatest || greatest == 0.0 {
        let message = "the masses of this body sum to 0".to_owned();
        report(&body.place, message, "without mass there is no centre of mass");
    }
    structure_errors
}
