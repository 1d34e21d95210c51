//! The derivative of the flow: M(t) = ∂η(t)/∂η(0), from the variational equations.
//!
//! In: a state. Out: M at a later time, how symplectic it is, its determinant beside the one that
//! Liouville's theorem predicts, exp ∫ div f dt (V. I. Arnold, Mathematical Methods of Classical
//! Mechanics, §16). Never here: what the map is used for.

use nalgebra::DMatrix;

use super::amplified_rounding::AmplifiedRounding;
use super::carrier::Carrier;
use super::error::DynamicsError;
use super::phase_space::PhaseSpace;

use crate::integrate::{Method, Settings, Stepping};
use crate::num::{gauss, math};
use crate::system::{MotionError, State};

/// The nodes in a step at which the divergence is summed: a long step of a series, …
const NODES: usize = 16;

/// … and a short one of a method of fixed step, whose states between cost a step each.
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
    /// Its determinant.
    pub determinant: f64,
    /// exp ∫ div f dt along the motion: 1 where nothing but H acts. Over impulses, times the
    /// determinants of their own derivatives.
    pub determinant_expected: f64,
    /// The largest entry of |M𝕁Mᵀ − 𝕁|; `None` if the variables are not canonical.
    pub symplectic_residual: Option<f64>,
    /// What rounding may leave of it: that of M at the end, and that of every step, amplified by the flow after it.
    pub symplectic_rounding: Option<f64>,
    /// The step or tolerance used.
    pub settings: Settings,
    /// Why the motion ended early.
    pub failure: Option<MotionError>,
}

/// Follows a motion from a state of the space until a time, and `look`s on after each step.
///
/// # Errors
/// Returns an error if the motion cannot begin. If it cannot continue, or is cancelled, the result
/// is that of the time reached.
pub fn flow_map(
    space: &PhaseSpace,
    (method, settings): (&'static Method, Settings),
    start: &State,
    until: f64,
    look: &mut dyn FnMut(f64),
) -> Result<FlowMap, DynamicsError> {
    if space.has_jumps() && until < start.time {
        return Err(DynamicsError::Unsuited(
            "impulses act on the motion, which is then followed forwards only".to_owned(),
        ));
    }
    let n = space.dimension();
    let mut carrier = Carrier::new(space, method, settings, n)?;
    carrier.start(start, &DMatrix::identity(n, n))?;
    let rule = gauss(if method.stepping == Stepping::Fixed { FEW_NODES } else { NODES });
    let mut field = (!space.is_hamiltonian()).then(|| space.vector_field());
    let canonical = space.form() == crate::system::Form::Momentum;
    let mut rounding = canonical.then(|| AmplifiedRounding::new(n));
    let forwards = until >= start.time;
    let (mut logarithm, mut failure, mut time) = (0.0, None, start.time);
    while carrier.is_before(until, forwards) {
        if let Err(fault) = carrier.step(until) {
            failure = Some(fault);
            break;
        }
        let (begin, end) = carrier.interval();
        let end = if (end < until) == forwards { end } else { until };
        if let Some(field) = &mut field {
            for &(part, weight) in &rule {
                let now = begin + part * (end - begin);
                let (state, _) = carrier.at(now)?;
                field.evaluate(now, space.variables(&state))?;
                logarithm += weight * (end - begin) * field.derivative().trace();
            }
        }
        time = end;
        if let Some(rounding) = &mut rounding {
            rounding.step(&carrier.at(time)?.1);
        }
        look(time);
    }
    let (state, matrix) = carrier.at(time)?;
    let symplectic = rounding.map(|rounding| {
        let hamiltonian = space.is_hamiltonian();
        let left = rounding.left(&|m| {
            if hamiltonian {
                Some(PhaseSpace::symplectic_inverse(m))
            } else {
                m.clone().try_inverse()
            }
        });
        PhaseSpace::symplectic_residual(&matrix, &left)
    });
    Ok(FlowMap {
        time,
        determinant: matrix.determinant(),
        determinant_expected: math::exp(logarithm) * carrier.jump_determinant(),
        symplectic_residual: symplectic.map(|(residual, _)| residual),
        symplectic_rounding: symplectic.map(|(_, rounding)| rounding),
        state,
        matrix,
        settings: carrier.settings(),
        failure,
    })
}
