//! Rotating frames: the position of a particle as seen from one, and the apparent forces on it
//! there.
//!
//! In: the frames of a model, whose angle and origin may depend on q and t. Out: an [`Apparent`]
//! for each particle of each frame, as a function of (q, q̇, q̈, t). Never here: real forces, or
//! drawing.
//! Source: *The Principles of Dynamics*, § 2.1.1: with ω = α' n,
//!
//! ```text
//! r' = R(−α)(r − o)      centrifugal −m ω×(ω×r')      Coriolis −2m ω×v'      Euler −m ω'×r'
//!                        and, of an origin that is accelerated, −m R(−α) o''
//! ```
//!
//! The axis n is the same in both frames.

use super::equations::{Apparent, Equations};
use crate::expr::{Expr, FunctionId, Pool, Symbol};
use crate::model::{Frame, Model, Point};

/// The particles of every frame as seen from it.
pub(super) fn find(model: &Model, equations: &mut Equations) -> Vec<Vec<Apparent>> {
    let seen = |frame: &Frame| {
        let particles = if frame.attitude { &[] } else { &frame.particles[..] };
        particles.iter().map(|(at, mass)| apparent(equations, frame, *at, *mass)).collect()
    };
    model.frames.iter().map(seen).collect()
}

fn apparent(equations: &mut Equations, frame: &Frame, r: Point, mass: Expr) -> Apparent {
    let mut seeds = vec![(equations.symbols.time, Expr::ONE)];
    for c in equations.coordinates.clone() {
        seeds.push((c.position, equations.pool.variable(c.velocity)));
        seeds.push((c.velocity, equations.pool.variable(c.acceleration)));
    }
    let pool = &mut equations.pool;
    let axis = unit(pool, frame.axis);
    let rate = pool.derivation(frame.angle, &seeds);
    let second = pool.derivation(rate, &seeds);
    let from_origin = [0, 1, 2].map(|k| pool.sub(r[k], frame.origin[k]));
    let at = turned_back(pool, axis, frame.angle, from_origin);
    let velocity = at.map(|e| derived(pool, e, &seeds));
    let omega = axis.map(|n| pool.mul(rate, n));
    let inner = cross(pool, omega, at);
    let centrifugal = cross(pool, omega, inner);
    let coriolis = cross(pool, omega, velocity);
    let omega_rate = axis.map(|n| pool.mul(second, n));
    let euler = cross(pool, omega_rate, at);
    let moving = frame.origin.map(|e| pool.derivation(e, &seeds));
    let moving = moving.map(|e| pool.derivation(e, &seeds));
    let dragging = turned_back(pool, axis, frame.angle, moving);
    let mut force = |factor: i64, vector: Point| {
        vector.map(|e| {
            let scale = pool.integer(factor);
            let scaled = pool.mul(scale, mass);
            let product = pool.mul(scaled, e);
            pool.simplify(product)
        })
    };
    let (centrifugal, coriolis) = (force(-1, centrifugal), force(-2, coriolis));
    let (euler, dragging) = (force(-1, euler), force(-1, dragging));
    Apparent { at, velocity, centrifugal, coriolis, euler, dragging }
}

fn derived(pool: &mut Pool, e: Expr, seeds: &[(Symbol, Expr)]) -> Expr {
    let rate = pool.derivation(e, seeds);
    pool.simplify(rate)
}

/// A direction of length 1.
fn unit(pool: &mut Pool, axis: Point) -> Point {
    let squares = axis.map(|e| pool.powi(e, 2));
    let sum = pool.sum(&squares);
    let length = pool.call(FunctionId::Sqrt, &[sum]);
    axis.map(|e| pool.div(e, length))
}

/// R(−α) v = v cos α − (n×v) sin α + n (n·v)(1 − cos α), Rodrigues' formula.
fn turned_back(pool: &mut Pool, n: Point, angle: Expr, v: Point) -> Point {
    let (sin, cos) = (pool.call(FunctionId::Sin, &[angle]), pool.call(FunctionId::Cos, &[angle]));
    let across = cross(pool, n, v);
    let products = [0, 1, 2].map(|k| pool.mul(n[k], v[k]));
    let along = pool.sum(&products);
    let rest = pool.sub(Expr::ONE, cos);
    [0, 1, 2].map(|k| {
        let scaled = pool.mul(v[k], cos);
        let turned = pool.mul(across[k], sin);
        let shared = pool.mul(n[k], along);
        let shared = pool.mul(shared, rest);
        let difference = pool.sub(scaled, turned);
        let sum = pool.add(difference, shared);
        pool.simplify(sum)
    })
}

fn cross(pool: &mut Pool, a: Point, b: Point) -> Point {
    [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let (one, other) = (pool.mul(a[i], b[j]), pool.mul(a[j], b[i]));
        pool.sub(one, other)
    })
}
