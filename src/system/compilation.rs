//! A model compiled: its programs, one after the other.
//!
//! In: a [`Model`], its [`Equations`], and expressions to observe. Out: a [`System`], and the same run backwards. Never here: how
//! an expression becomes operations (`lower`), and numbers.

use std::sync::Arc;

use super::active_set::Constrained;
use super::compiled::{Shared, System};
use super::consistent_initial::KnownVelocity;
use super::inertia::Inertia;
use super::kkt::ConstraintSystem;
use super::machine_code::CodeCache;
use super::observables::{ObservableList, has_work};
use super::rhs::{MotionPrograms, ProgramBuilder, Quadratures};
use super::separability::NotSeparable;
use super::terms::ConservedTerms;
use super::variations::Variations;
use super::{Discontinuities, legendre, steep_program};
use crate::expr::{Expr, Symbol};
use crate::mechanics::Equations;
use crate::model::{self, Model};

/// Why a model cannot be compiled.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum CompileError {
    /// The equations exceed the size of the pool.
    #[error("the equations of this system grow beyond a million nodes")]
    TooLarge,
    /// A symbol has no meaning where it is used.
    #[error("`{0}` has no value where it is used")]
    Unknown(String),
}

/// Returns what the file specifies about an initial rate.
fn known(coordinate: &model::Coordinate) -> KnownVelocity {
    if coordinate.rate_given { KnownVelocity::InitialOverride } else { KnownVelocity::LeftOut }
}

impl System {
    /// Compiles `equations`, which were derived from `model`. All expressions, including those of
    /// the `extra` channels, belong to `equations.pool`.
    ///
    /// # Errors
    /// Returns an error if an expression depends on a symbol that has no number in a state.
    pub fn compile(
        model: &Model,
        equations: &Equations,
        extra: &[model::WrittenExpr],
    ) -> Result<System, CompileError> {
        Self::compile_along(model, equations, extra, false)
    }

    /// The same system run the other way: the time of its states is −t, and their rates of change are dx/d(−t) =
    /// −dx/dt. Coordinates, velocities, momenta and all channels mean what they mean here, so that a state
    /// belongs to both systems but for the sign of its time. Functions of events that only count in one direction count
    /// in the same direction of t. Impulses are not undone. `model` and `equations` are those it was compiled from.
    ///
    /// # Errors
    /// As [`System::compile`].
    pub fn reversed(&self, model: &Model, equations: &Equations) -> Result<System, CompileError> {
        let backwards = !self.is_backwards();
        let reversed = Self::compile_along(model, equations, &self.shared.extra, backwards)?;
        Ok(reversed.with_cancel(self.cancel.clone()))
    }

    fn compile_along(
        model: &Model,
        equations: &Equations,
        extra: &[model::WrittenExpr],
        backwards: bool,
    ) -> Result<System, CompileError> {
        let mut equations = equations.clone();
        let list = ObservableList::of(model, &mut equations, extra);
        let quantities = ConservedTerms::of(model, &mut equations);
        if !equations.has_moving_mass() {
            // splitting methods need it; where M moves there is nothing to find
            equations.separable();
        }
        if equations.is_lagrangian() && !equations.is_quadratic() {
            // where L is not quadratic, no block of linear equations gives q̇ in terms of p
            equations.velocities();
        }
        let equations = Arc::new(equations);
        let quadratures = Quadratures {
            action: list.depends(&equations, equations.symbols.action)
                || Discontinuities::depend(model, &equations, equations.symbols.action),
            work: has_work(model, &equations),
        };
        let mut builder = ProgramBuilder {
            pool: equations.pool.clone(),
            parameters: model.parameters.iter().map(|p| p.symbol).collect(),
            equations: &equations,
            quadratures,
            kkt: ConstraintSystem::default(),
            backwards,
        };
        let unknown =
            |symbol| CompileError::Unknown(equations.pool.symbol_info(symbol).name.clone());
        let inertia = Inertia::of(model, &mut builder).map_err(unknown)?;
        builder.parameters.extend(inertia.iter().flat_map(|m| m.names().to_vec()));
        let constraints =
            Constrained::of(model, &mut builder, inertia.as_ref()).map_err(unknown)?;
        let (constraints, active_set) = constraints.unzip();
        let shared = Self::write(model, &equations, &mut builder, (list, quantities), constraints)
            .map_err(unknown)?;
        if builder.pool.is_full() {
            return Err(CompileError::TooLarge);
        }
        let active_set = active_set.unwrap_or_default();
        let cancel = equations.pool.cancel().clone();
        let shared = Arc::new(Shared { inertia, extra: extra.to_vec(), ..shared });
        Ok(System {
            shared,
            active_set,
            cancel,
            tangents: None,
            unmarked: false,
            interpreted: false,
        })
    }

    fn write(
        model: &Model,
        equations: &Arc<Equations>,
        builder: &mut ProgramBuilder<'_>,
        (list, quantities): (ObservableList, ConservedTerms),
        constraints: Option<Constrained>,
    ) -> Result<Shared, Symbol> {
        let split = match builder.split() {
            Some(split) => Ok(split?),
            None => Err(NotSeparable::of(equations)),
        };
        let motion = MotionPrograms {
            native: builder.native_rates()?,
            code: CodeCache::new(),
            canonical: builder.canonical_rates()?,
            split,
        };
        let mut lowering = builder.lowering();
        let coordinates = &model.coordinates;
        let mut outputs: Vec<_> = coordinates.iter().map(|c| lowering.lower(c.initial)).collect();
        outputs.extend(coordinates.iter().map(|c| lowering.lower(c.initial_rate)));
        let periods = coordinates.iter().map(|c| c.period.unwrap_or(Expr::ZERO));
        outputs.extend(periods.map(|e| lowering.lower(e)));
        let initial = lowering.finish(outputs)?;
        let energy = builder.equations.energy;
        let mut lowering = builder.on_native_state();
        let outputs = vec![lowering.lower(energy)];
        let energy = lowering.finish(outputs)?;
        Ok(Shared {
            native: builder.native(),
            degrees: coordinates.len(),
            quadratures: builder.quadratures,
            motion,
            legendre: legendre::program(builder)?,
            initial,
            constraints,
            attitude: builder.attitude(),
            comparison: builder.comparison(),
            auxiliary: builder.auxiliary_start()?,
            known: coordinates.iter().map(known).collect(),
            energy,
            discontinuities: Discontinuities::of(model, builder)?,
            steep: steep_program::program(builder)?,
            divisors: steep_program::divisors(builder)?,
            signed_divisors: steep_program::signed_divisors(builder)?,
            observables: list.compile(builder)?,
            terms: quantities.compile(builder)?,
            inertia: None,
            backwards: builder.backwards,
            extra: Vec::new(),
            variations: Variations::default(),
        })
    }
}
