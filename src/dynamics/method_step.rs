//! One step of a method of integration as a map of phase space, held against a transformation.
//!
//! In: a transformation of the file, a method, its step. Out: how far the images of both lie apart, and their derivatives,
//! at points near the start. Never here: words.
//!
//! A step of symplectic Euler is the canonical map that q P + h H(q, P) generates (E. Hairer, C. Lubich, G. Wanner,
//! *Geometric Numerical Integration*, § VI.5). The derivative of the step is carried through its own operations, that of
//! the transformation follows from its relations: neither knows of the other.

use nalgebra::DMatrix;

use super::carrier::Carrier;
use super::error::DynamicsError;
use super::phase_space::PhaseSpace;
use crate::integrate::{Method, Settings};
use crate::mechanics::{Equations, POINTS, TRIES, Valuation, phase_maps};
use crate::model::Model;
use crate::system::{Form, State, System};

/// A step of a method beside a transformation.
#[derive(Clone, Debug)]
pub struct MethodStep {
    /// The number of points at which both were compared.
    pub points: usize,
    /// The greatest distance of the images, relative to the larger of the variable before and after the step.
    pub image: f64,
    /// The greatest difference of an entry of M = ∂(Q, P)/∂(q, p), relative to the largest entry, in units in which all variables
    /// are of like size.
    pub derivative: f64,
    /// M of the transformation and of the step at the first of the points.
    pub first: [DMatrix<f64>; 2],
}

impl MethodStep {
    /// Compares the transformation of this name with a step of the method, at points near the start of the file.
    ///
    /// # Errors
    /// Returns an error if the motion has no derivative everywhere, the method does not suit it, or the map has no image near
    /// the start.
    pub fn beside(
        (model, equations, system): (&Model, &mut Equations, &System),
        name: &str,
        (method, step): (&'static Method, f64),
    ) -> Result<MethodStep, DynamicsError> {
        let unsuited = |why: &str| DynamicsError::Unsuited(why.to_owned());
        let parameters = model.parameter_values();
        let space = PhaseSpace::of((model, equations, system), &parameters)?;
        if space.form() != Form::Momentum {
            return Err(unsuited("brackets of variables have no canonical coordinates"));
        }
        let maps = phase_maps(model, equations);
        let map = maps.iter().find(|map| map.name == name);
        let map = map.ok_or_else(|| unsuited("the transformation cannot be written down"))?;
        let start = space.state(&system.initial(model.run.start, &parameters, &[])?)?;
        let mut carrier = Carrier::new(
            &space,
            method,
            Settings { step: Some(step), tolerance: None },
            space.dimension(),
        )?;
        let mut found: Option<MethodStep> = None;
        for n in 0..TRIES {
            let point = Valuation::near_start(model, equations, n);
            let old: Vec<f64> = map.old.iter().map(|&s| point.at(s)).collect();
            // a step of an atom is nothing beside a time of order one
            let time =
                if space.is_autonomous() { start.time } else { point.at(model.symbols.time) };
            let at = State { time, time_carry: 0.0, ..space.state_at(&start, &old) };
            let image = map.image(&equations.pool, &point);
            let tangent = image.as_ref().and_then(|image| map.tangent(&equations.pool, image));
            let (Some(image), Some(tangent)) = (image, tangent) else { continue };
            let size = space.dimension();
            let begun = carrier.start(&at, &DMatrix::identity(size, size));
            let stepped = begun.and_then(|()| Ok(carrier.step(time + step)?));
            let (state, own) = match stepped.and_then(|()| Ok(carrier.at(carrier.time())?)) {
                Err(why) if why.is_cancelled() => return Err(why),
                // no step leads from there
                Err(_) => continue,
                Ok(carried) => carried,
            };
            let new: Vec<f64> = map.implicit.new.iter().map(|&s| image.at(s)).collect();
            let sizes = sizes(&old, &new);
            let stepped = new.iter().zip(space.variables(&state));
            let apart = stepped.zip(&sizes).map(|((a, b), size)| (a - b).abs() / size);
            let apart = apart.fold(0.0, larger);
            let largest = in_units(&tangent, &sizes).amax();
            let differ = in_units(&(&tangent - &own), &sizes).amax() / largest;
            let known = found.get_or_insert(MethodStep {
                points: 0,
                image: 0.0,
                derivative: 0.0,
                first: [tangent, own],
            });
            known.points += 1;
            known.image = larger(known.image, apart);
            known.derivative = larger(known.derivative, differ);
            if known.points == POINTS {
                break;
            }
        }
        found.ok_or_else(|| unsuited("the map has no image near the start"))
    }
}

/// The sizes of the variables: before the step or after it, or of the largest where one is zero in both.
fn sizes(old: &[f64], new: &[f64]) -> Vec<f64> {
    let sizes: Vec<f64> = old.iter().zip(new).map(|(a, b)| a.abs().max(b.abs())).collect();
    let largest = sizes.iter().copied().fold(0.0, f64::max);
    let instead = if largest > 0.0 { largest } else { 1.0 };
    sizes.into_iter().map(|size| if size > 0.0 { size } else { instead }).collect()
}

/// M in units in which the variables have the size 1.
fn in_units(matrix: &DMatrix<f64>, sizes: &[f64]) -> DMatrix<f64> {
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)] * sizes[j] / sizes[i])
}

/// The larger of two distances; what is not a number is farther than any.
fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}
