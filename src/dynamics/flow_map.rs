//! The derivative of the flow: M(t) = ∂η(t)/∂η(0), from the variational equations.
//!
//! In: a state. Out: M at a later time, how symplectic it is, its determinant beside the one that
//! Liouville's theorem predicts, exp ∫ div f dt (V. I. Arnold, Mathematical Methods of Classical
//! Mechanics, §16). Never here: what the map is used for.
//!
//! Under constraints M is taken of displacements that they allow, M = Dφ P with the projection P onto these. If the
//! constraints are holonomic and nothing but L acts, the states form a symplectic manifold of their own, with the form 𝕁
//! restricted to it, and the flow preserves that: Mᵀ𝕁M = Pᵀ𝕁P (Arnold, §§ 17, 37). The determinant is then that of the
//! volumes which the form defines.

use nalgebra::DMatrix;

use super::amplified_rounding::{AmplifiedRounding, MapRounding};
use super::carrier::Carrier;
use super::error::DynamicsError;
use super::phase_space::PhaseSpace;
use super::tangent_step::TangentStep;
use super::vector_field::VectorField;

use crate::integrate::{Method, Settings, Stepping};
use crate::num::{gauss, math};
use crate::system::{MotionError, MotionErrorKind, State};

/// The nodes in a step at which the divergence is summed: a long step of a series.
const NODES: usize = 16;

/// The nodes in a short step of a method of fixed step, whose states between cost a step each.
const FEW_NODES: usize = 3;

/// The derivative of a motion by its initial values.
#[derive(Clone, Debug)]
pub struct FlowMap {
    /// The time reached, and the state there, in the variables of the space.
    pub time: f64,
    /// The state at that time.
    pub state: State,
    /// ∂η_i(t)/∂η_j(0).
    pub matrix: DMatrix<f64>,
    /// The dimension of the displacements it is taken of: that of the space, less what constraints remove.
    pub dimension: usize,
    /// Its determinant, under constraints that of its volumes on them; `None` where these have no volume that H preserves.
    pub determinant: Option<f64>,
    /// exp ∫ div f dt along the motion: 1 where nothing but H acts. Over impulses, times the
    /// determinants of their own derivatives.
    pub determinant_expected: Option<f64>,
    /// The largest entry of |M𝕁Mᵀ − 𝕁|, under constraints of |Mᵀ𝕁M − Pᵀ𝕁P|; `None` if the variables are not canonical, or
    /// no form is preserved on the constraints.
    pub symplectic_residual: Option<f64>,
    /// What rounding may leave of it: that of M at the end, and that of every step, amplified by the flow after it; under
    /// constraints that of M and P alone. `None` also next to where M has no limit.
    pub symplectic_rounding: Option<f64>,
    /// What rounding may leave of M itself; `None` under constraints.
    pub rounding: Option<MapRounding>,
    /// The step or tolerance used.
    pub settings: Settings,
    /// Why the motion ended early.
    pub error: Option<MotionError>,
}

/// Follows a motion from a state of the space until a time, and `report`s the time after each step.
///
/// # Errors
/// Returns an error if the motion cannot begin. If it cannot continue, or is cancelled, the result
/// is that of the time reached.
pub fn flow_map(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    start: &State,
    until: f64,
    report: &mut dyn FnMut(f64),
) -> Result<FlowMap, DynamicsError> {
    let mut report_time = |time| {
        report(time);
        true
    };
    let divergence = (!space.is_constrained()).then(|| Divergence::of(space, method));
    followed(space, (method, settings), (start, until), divergence, &mut report_time)
}

/// The same for as long as `report` returns true, otherwise the result is that of the time reached; and without the
/// determinant that Liouville's theorem predicts, whose integral takes longer than the motion.
pub(super) fn flow_map_while(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    start: &State,
    until: f64,
    report: &mut dyn FnMut(f64) -> bool,
) -> Result<FlowMap, DynamicsError> {
    followed(space, (method, settings), (start, until), None, report)
}

fn followed(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    (start, until): (&State, f64),
    mut divergence: Option<Divergence>,
    report: &mut dyn FnMut(f64) -> bool,
) -> Result<FlowMap, DynamicsError> {
    if space.has_jumps() && until < start.time {
        return Err(DynamicsError::Unsuited(
            "impulses act on the motion, which is then followed forwards only".to_owned(),
        ));
    }
    if space.is_constrained() && until < start.time {
        return Err(DynamicsError::Unsuited(
            "constraints act on the motion, which is then followed forwards only".to_owned(),
        ));
    }
    let n = space.dimension();
    let mut carrier = Carrier::new(space, method, settings, n)?;
    let (allowed, dimension) = space.allowed_displacements(start)?;
    carrier.start(start, &allowed)?;
    let free = !space.is_constrained();
    let canonical = free && space.form() == crate::system::Form::Momentum;
    let mut rounding = free.then(|| AmplifiedRounding::new(n));
    let forwards = until >= start.time;
    let (mut logarithm, mut error, mut time) = (0.0, None, start.time);
    while carrier.is_before(until, forwards) {
        if let Err(why) = carrier.step(until) {
            error = Some(why);
            break;
        }
        let (begin, end) = carrier.interval();
        let end = if (end < until) == forwards { end } else { until };
        if let Some(divergence) = &mut divergence {
            logarithm += divergence.along(space, &mut carrier, [begin, end])?;
        }
        time = end;
        if let Some(rounding) = &mut rounding {
            rounding.step(&carrier.at(time)?.1, time);
        }
        if !report(time) {
            break;
        }
    }
    let (state, matrix) = carrier.at(time)?;
    if !free {
        let preserved =
            space.is_hamiltonian().then(|| on_constraints(&matrix, &allowed, dimension));
        return Ok(FlowMap {
            time,
            dimension,
            determinant: preserved.map(|(_, determinant)| determinant),
            determinant_expected: preserved.map(|_| 1.0),
            symplectic_residual: preserved.map(|((residual, _), _)| residual),
            symplectic_rounding: preserved.map(|((_, rounding), _)| rounding),
            rounding: None,
            state,
            matrix,
            settings: carrier.settings(),
            error,
        });
    }
    // next to where M has no limit it is known to no digits that rounding alone would leave
    let no_limit = |error: &MotionError| matches!(error.kind, MotionErrorKind::NoDerivative);
    let has_limit = !error.as_ref().is_some_and(no_limit);
    let hamiltonian = canonical && space.is_hamiltonian();
    let inverse = |m: &DMatrix<f64>| {
        if hamiltonian { Some(PhaseSpace::symplectic_inverse(m)) } else { m.clone().try_inverse() }
    };
    let symplectic = rounding
        .as_ref()
        .filter(|_| canonical)
        .map(|rounding| PhaseSpace::symplectic_residual(&matrix, &rounding.left(&inverse)));
    Ok(FlowMap {
        time,
        dimension,
        determinant: Some(matrix.determinant()),
        determinant_expected: divergence.map(|_| math::exp(logarithm) * carrier.jump_determinant()),
        symplectic_residual: symplectic.map(|(residual, _)| residual),
        symplectic_rounding: symplectic.filter(|_| has_limit).map(|(_, rounding)| rounding),
        rounding: rounding.map(|rounding| rounding.of_map(&inverse)),
        state,
        matrix,
        settings: carrier.settings(),
        error,
    })
}

/// The divergence of the rates along a motion, by which the volume of phase space changes.
pub(super) struct Divergence {
    /// The rates; `None` where nothing but H acts, and their divergence is 0.
    field: Option<VectorField>,
    rule: Vec<(f64, f64)>,
}

impl Divergence {
    pub(super) fn of(space: &PhaseSpace, method: &Method) -> Divergence {
        let nodes = if method.stepping == Stepping::Fixed { FEW_NODES } else { NODES };
        Divergence::at_nodes(space, nodes)
    }

    /// The same to a few digits.
    pub(super) fn rough(space: &PhaseSpace) -> Divergence {
        Divergence::at_nodes(space, FEW_NODES)
    }

    fn at_nodes(space: &PhaseSpace, nodes: usize) -> Divergence {
        let field = (!space.is_hamiltonian()).then(|| space.vector_field());
        Divergence { field, rule: gauss(nodes) }
    }

    /// ∫ div f dt over a part of the last step.
    ///
    /// # Errors
    /// Returns an error if the rates or the motion cannot be evaluated.
    pub(super) fn along(
        &mut self,
        space: &PhaseSpace,
        step: &mut dyn TangentStep,
        [begin, end]: [f64; 2],
    ) -> Result<f64, DynamicsError> {
        let Some(field) = &mut self.field else { return Ok(0.0) };
        let mut sum = 0.0;
        for &(part, weight) in &self.rule {
            let now = begin + part * (end - begin);
            let (state, _) = step.at(now)?;
            field.evaluate(now, space.variables(&state))?;
            sum += weight * (end - begin) * field.derivative().trace();
        }
        Ok(sum)
    }
}

/// The largest entry of |Mᵀ𝕁M − Pᵀ𝕁P| with what rounding may leave of that entry, ε times its entry of |M|ᵀ|𝕁||M| + |P|ᵀ|𝕁||P|:
/// entries have units. Then the factor by which M changes the volume that the form 𝕁 defines on the displacements of this
/// dimension that P allows: √(det Mᵀ𝕁M/det Pᵀ𝕁P) in a basis of them.
fn on_constraints(
    matrix: &DMatrix<f64>,
    allowed: &DMatrix<f64>,
    dimension: usize,
) -> ((f64, f64), f64) {
    let n = matrix.nrows() / 2;
    let unit = DMatrix::from_fn(2 * n, 2 * n, |i, j| {
        f64::from(i8::from(j == i + n) - i8::from(i == j + n))
    });
    let form = |of: &DMatrix<f64>| of.transpose() * &unit * of;
    let sizes = |of: &DMatrix<f64>| of.abs().transpose() * unit.abs() * of.abs();
    let (after, before) = (form(matrix), form(allowed));
    let off = (&after - &before).abs();
    let bounds = (sizes(matrix) + sizes(allowed)) * f64::EPSILON;
    let residual = off.amax();
    let of_the_largest = off.iter().zip(&bounds).filter(|(entry, _)| **entry == residual);
    let rounding = of_the_largest.map(|(_, &bound)| bound).fold(f64::INFINITY, f64::min);
    // displacements whose images under P are independent: columns of the unit matrix, as pivoting chooses them
    let mut chosen = DMatrix::identity(2 * n, 2 * n);
    allowed.clone().col_piv_qr().p().permute_columns(&mut chosen);
    let basis = chosen.columns(0, dimension);
    let volume = |form: &DMatrix<f64>| (basis.transpose() * form * basis).determinant();
    ((residual, rounding), (volume(&after) / volume(&before)).sqrt())
}
