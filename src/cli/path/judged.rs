//! What is known of a path between configurations: its action, whether that is stationary, and the actions of paths beside it.
//!
//! In: a system, the ends of a path or its functions of the time. Out: a [`JudgedPath`]. Never here: how it is written.

use crate::cli::assignment::Assignment;
use crate::cli::decimal::divisions;
use crate::cli::error::CommandError;
use crate::cli::motion_options::CompiledMotion;
use crate::cli::path_function::PathFunctions;
use crate::cli::{stderr, study};
use crate::dynamics::{
    DynamicsError, Hamiltonian, Lagrangian, PathKind, PhaseSpace, StationaryPath,
    abbreviated_action, action_at_energy, conjugate_points, morse_index, nearest_stationary_path,
    stationary_path_between,
};
use crate::expr::{Expr, Pool};
use crate::mechanics::{Equations, Valuation, body_constants};
use crate::model::Model;

/// The number of intervals between rows.
const INTERVALS: u32 = 200;

/// The equations of motion hold along a written path if what is left of them is below this part of their terms, and a variation
/// vanishes at an end below this part of its largest value.
const HOLDS: f64 = 1e-9;

/// A path with what is known of it.
pub(super) struct JudgedPath {
    pub(super) action: f64,
    /// ∫ Σ p dq, where it has a value.
    pub(super) abbreviated: Option<f64>,
    /// `None` if it does not make the action stationary.
    pub(super) nature: Option<(usize, PathKind)>,
    pub(super) conjugate: Option<Vec<f64>>,
    pub(super) rows: Vec<Vec<f64>>,
    pub(super) varied: Vec<VariedPath>,
}

pub(super) struct VariedPath {
    pub(super) epsilon: f64,
    /// Hamilton's action, or that in phase space.
    pub(super) action: f64,
    /// The abbreviated action at the energy of the path that is varied, or why there is none.
    pub(super) abbreviated: Result<f64, String>,
}

/// A path that is to be judged.
pub(super) enum BasePath {
    /// One that was searched for, and makes the action stationary.
    Solved(StationaryPath),
    /// One that was written, and whether the equations of motion hold along it.
    Written(PathFunctions, bool),
}

impl BasePath {
    /// q and q̇ at a time from its beginning.
    fn state(&self, pool: &Pool, constants: &Valuation, t: f64) -> Vec<f64> {
        match self {
            BasePath::Solved(path) => path.at(t),
            BasePath::Written(along, _) => along.state(pool, constants, t),
        }
    }
}

pub(super) struct PathVariation {
    positions: Option<PathFunctions>,
    momenta: Option<MomentumVariation>,
}

/// By what its momenta are varied, in phase space.
struct MomentumVariation {
    momenta: PathFunctions,
    lagrangian: Lagrangian,
    hamiltonian: Hamiltonian,
}

/// Paths of one system that take the same time.
pub(super) struct PathStudy<'a> {
    compiled: &'a CompiledMotion,
    equations: Equations,
    /// The parameters, and the constants that follow from a body.
    constants: Valuation,
    lagrangian: Lagrangian,
    duration: f64,
}

impl<'a> PathStudy<'a> {
    pub(super) fn new(
        compiled: &'a CompiledMotion,
        duration: f64,
    ) -> Result<PathStudy<'a>, CommandError> {
        let (model, parameters) = (&*compiled.model, &compiled.start.parameters);
        let mut equations = (*compiled.equations).clone();
        let constants =
            Valuation::of_parameters(model, parameters).with(body_constants(model, parameters));
        let lagrangian =
            Lagrangian::of(model, &mut equations, parameters).map_err(study::failed)?;
        Ok(PathStudy { compiled, equations, constants, lagrangian, duration })
    }

    /// Reads functions of the time; `None` if none are given.
    pub(super) fn read(
        &mut self,
        given: &[Assignment],
        option: &str,
    ) -> Result<Option<PathFunctions>, CommandError> {
        PathFunctions::read(&self.compiled.model, &mut self.equations, given, option)
    }

    /// Reads a variation of coordinates and momenta; `None` if there is none.
    pub(super) fn variation(
        &mut self,
        positions: &[Assignment],
        momenta: &[Assignment],
    ) -> Result<Option<PathVariation>, CommandError> {
        let positions = self.read(positions, "--vary")?;
        let momenta = match self.read(momenta, "--vary")? {
            None => None,
            Some(momenta) => {
                let (model, parameters) = (&self.compiled.model, &self.compiled.start.parameters);
                let equations = &mut self.equations;
                Some(MomentumVariation {
                    momenta,
                    lagrangian: Lagrangian::of(model, equations, parameters)
                        .map_err(study::failed)?,
                    hamiltonian: Hamiltonian::of(model, equations, parameters)
                        .map_err(study::failed)?,
                })
            }
        };
        let is_given = positions.is_some() || momenta.is_some();
        Ok(is_given.then_some(PathVariation { positions, momenta }))
    }

    pub(super) fn along(&mut self, along: PathFunctions) -> BasePath {
        let (model, equations) = (&self.compiled.model, &mut self.equations);
        let is_stationary = stationary(model, equations, &along, &self.constants, self.duration);
        BasePath::Written(along, is_stationary)
    }

    /// The stationary path between two configurations, near another one if that is given.
    pub(super) fn between(
        &mut self,
        [from, to]: &[Vec<f64>; 2],
        near: Option<&PathFunctions>,
    ) -> Result<BasePath, CommandError> {
        let (pool, duration) = (&self.equations.pool, self.duration);
        let path = match near {
            Some(near) => {
                // the ends are those that are asked for
                let guess = |t: f64| match t / duration {
                    part if part <= 0.0 => from.clone(),
                    part if part >= 1.0 => to.clone(),
                    _ => near.at(pool, &self.constants, t, 0),
                };
                nearest_stationary_path(&mut self.lagrangian, &guess, duration)
            }
            None => stationary_path_between(&mut self.lagrangian, [from, to], duration),
        };
        path.map(BasePath::Solved).map_err(study::failed)
    }

    /// What is known of a path, without variations of it.
    pub(super) fn judge(&mut self, path: &BasePath) -> Result<JudgedPath, CommandError> {
        let Self { equations, constants, lagrangian, duration, .. } = self;
        let duration = *duration;
        let base = |t: f64| path.state(&equations.pool, constants, t);
        let (action, nature) = match path {
            BasePath::Solved(path) => (path.action, Some((path.index, path.kind))),
            BasePath::Written(_, is_stationary) => {
                let action =
                    lagrangian.action(&mut |t: f64| base(t), duration).map_err(study::failed)?;
                let nature = is_stationary.then(|| morse_index(lagrangian, &base, duration));
                (action, nature.transpose().map_err(study::failed)?)
            }
        };
        let mut rows = Vec::new();
        for t in divisions(0.0, duration, INTERVALS) {
            let state = base(t);
            let momenta = lagrangian.momenta(t, &state);
            let energy = lagrangian.energy(t, &state);
            rows.push([&[t][..], &state, &momenta, &[energy]].concat());
        }
        let conjugate = if nature.is_some() {
            let state = base(0.0);
            let momenta = lagrangian.momenta(0.0, &state);
            let variables = [&state[..momenta.len()], &momenta].concat();
            let times = conjugates(self.compiled, equations, &variables, duration);
            times
                .inspect_err(|why| {
                    stderr::report(&format!("conjugate points are not known: {why}"));
                })
                .ok()
        } else {
            Some(Vec::new())
        };
        let abbreviated = abbreviated_action(lagrangian, &mut |t: f64| base(t), duration).ok();
        Ok(JudgedPath { action, abbreviated, nature, conjugate, rows, varied: Vec::new() })
    }

    /// The actions of a path to which these parts of a variation are added.
    pub(super) fn vary(
        &mut self,
        path: &BasePath,
        variation: PathVariation,
        epsilons: &[f64],
    ) -> Result<Vec<VariedPath>, CommandError> {
        let Self { equations, constants, lagrangian, duration, .. } = self;
        let (pool, constants, duration) = (&equations.pool, &*constants, *duration);
        let base = |t: f64| path.state(pool, constants, t);
        let energy = lagrangian.energy(0.0, &base(0.0));
        let PathVariation { positions, mut momenta } = variation;
        if let Some(positions) = &positions {
            report_free_ends(|t| positions.at(pool, constants, t, 0), duration);
        }
        let mut varied = Vec::new();
        for &epsilon in epsilons {
            let mut path = |t: f64| -> Vec<f64> {
                let state = base(t);
                let by = match &positions {
                    Some(positions) => positions.state(pool, constants, t),
                    None => vec![0.0; state.len()],
                };
                state.iter().zip(by).map(|(x, d)| x + epsilon * d).collect()
            };
            let (action, abbreviated) = match &mut momenta {
                Some(MomentumVariation { momenta, lagrangian: own, hamiltonian }) => {
                    let mut in_phase_space = |t: f64| -> Vec<f64> {
                        let own = own.momenta(t, &base(t)).into_iter();
                        let by = momenta.at(pool, constants, t, 0);
                        let momenta = own.zip(by).map(|(p, d)| p + epsilon * d);
                        path(t).into_iter().chain(momenta).collect()
                    };
                    let action =
                        hamiltonian.phase_action(lagrangian, &mut in_phase_space, duration);
                    let why = "its momenta are not those of its velocities".to_owned();
                    (action.map_err(study::failed)?, Err(why))
                }
                None => {
                    let action = lagrangian.action(&mut path, duration).map_err(study::failed)?;
                    let at_energy = action_at_energy(lagrangian, &mut path, duration, energy);
                    (action, at_energy.map_err(|why| why.to_string()))
                }
            };
            varied.push(VariedPath { epsilon, action, abbreviated });
        }
        Ok(varied)
    }
}

/// Reports a variation that does not vanish at both ends.
fn report_free_ends(variation: impl Fn(f64) -> Vec<f64>, duration: f64) {
    if has_free_ends(variation, duration) {
        stderr::report(
            "the variation does not vanish at both ends: where it does not, the action changes by p δq, also on a true path",
        );
    }
}

/// Whether a variation does not vanish at both ends.
fn has_free_ends(variation: impl Fn(f64) -> Vec<f64>, duration: f64) -> bool {
    let size = |t: f64| variation(t).iter().fold(0.0_f64, |most, d| most.max(d.abs()));
    let greatest = divisions(0.0, duration, INTERVALS).map(size).fold(0.0, f64::max);
    size(0.0).max(size(duration)) > HOLDS * greatest
}

/// Whether what is left of an equation vanishes beside its terms.
fn holds(left: f64, size: f64) -> bool {
    left.abs() <= HOLDS * size.max(f64::MIN_POSITIVE)
}

/// Whether d/dt ∂L/∂q̇ − ∂L/∂q vanishes along a written path.
fn stationary(
    model: &Model,
    equations: &mut Equations,
    along: &PathFunctions,
    constants: &Valuation,
    duration: f64,
) -> bool {
    let Ok(lagrangian) = equations.lagrangian().clone() else { return false };
    let time = model.symbols.time;
    let mut seeds = vec![(time, Expr::ONE)];
    let pool = &mut equations.pool;
    for c in &model.coordinates {
        seeds.push((c.position, pool.variable(c.velocity)));
        seeds.push((c.velocity, pool.variable(c.acceleration)));
    }
    let mut residuals = Vec::new();
    for c in &model.coordinates {
        let momentum = pool.derivative(lagrangian, c.velocity);
        let rate = pool.derivation(momentum, &seeds);
        let force = pool.derivative(lagrangian, c.position);
        residuals.push(pool.sub(rate, force));
    }
    divisions(0.0, duration, 37).all(|t| {
        let on_path = constants.clone().with([(time, t)]);
        let mut point = constants.clone().with([(time, model.run.start + t)]);
        for (i, c) in model.coordinates.iter().enumerate() {
            let symbols = [c.position, c.velocity, c.acceleration];
            for (symbol, values) in symbols.into_iter().zip(&along.values) {
                point.set(symbol, on_path.value(pool, values[i]));
            }
        }
        residuals.iter().all(|&e| {
            let (value, size) = pool.evaluate_with_size(e, &|s| point.at(s));
            holds(value, size)
        })
    })
}

/// The conjugate points of the motion from these canonical variables.
fn conjugates(
    compiled: &CompiledMotion,
    equations: &Equations,
    variables: &[f64],
    duration: f64,
) -> Result<Vec<f64>, DynamicsError> {
    let parameters = &compiled.start.parameters;
    let space =
        PhaseSpace::without_end((&compiled.model, equations, &compiled.system), parameters)?;
    let state = compiled
        .start
        .state(&compiled.system)
        .map_err(|why| DynamicsError::Unsuited(why.to_string()))?;
    let start = space.state_at(&space.state(&state)?, variables);
    conjugate_points(&space, (compiled.method, compiled.settings), &start, duration)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_equation_holds_to_a_billionth_of_its_terms() {
        assert!(holds(-1.9e-9, 2.0) && !holds(-2.1e-9, 2.0));
        assert!(holds(0.0, 0.0) && !holds(f64::NAN, 2.0));
    }

    /// 2 t (1 − t/3) of at most 1.5, and a part of it at one end.
    #[test]
    fn a_variation_vanishes_at_its_ends_to_a_billionth_of_its_largest_value() {
        let is_free = |end: f64, value: f64| {
            has_free_ends(
                |t| vec![0.0, 2.0 * t * (1.0 - t / 3.0) + if t == end { value } else { 0.0 }],
                3.0,
            )
        };
        for end in [0.0, 3.0] {
            assert!(!is_free(end, -1.4e-9), "{end}");
            assert!(is_free(end, -1.6e-9), "{end}");
        }
    }
}
