//! The equations of motion as programs: rates of change of a state, in both of its forms, and split
//! in two if H is separable.

use std::collections::HashMap;
use std::sync::Arc;

use super::kkt::ConstraintSystem;
use super::lower::Lowering;
use super::machine_code::CodeCache;
use super::program::{Program, Register};
use super::separability::NotSeparable;
use super::state::Form;
use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::{AuxiliaryRates, CoordinateSymbols, Equations, Flow};

/// Which integrals along the motion a state carries after its coordinates and rates.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Quadratures {
    pub(super) action: bool,
    pub(super) work: bool,
}

impl Quadratures {
    pub(super) fn count(self) -> usize {
        usize::from(self.action) + usize::from(self.work)
    }
}

/// H = T(p) + V(q, t), with the motion that each part alone generates.
#[derive(Clone, Debug)]
pub(super) struct SplitHamiltonian {
    /// q̇, then the rates of the quadratures, under T alone, as functions of (q, p).
    pub(super) drift: Arc<Program>,
    /// ṗ, then the rates of the quadratures, under V alone, as functions of (q, p).
    pub(super) kick: Arc<Program>,
}

/// The equations of motion, in every form a method may request.
#[derive(Debug)]
pub(super) struct MotionPrograms {
    /// The rates as functions of a state in the native form.
    pub(super) native: Arc<Program>,
    /// The series of these rates as machine code.
    pub(super) code: CodeCache,
    /// The rates as functions of (q, p) or, if the flag is false, of (q, q̇).
    pub(super) canonical: (Arc<Program>, bool),
    /// The two parts of a separable system, or the reason why it is not separable.
    pub(super) split: Result<SplitHamiltonian, NotSeparable>,
}

#[derive(Debug)]
pub(super) struct Tangents {
    pub(super) count: usize,
    pub(super) motion: MotionPrograms,
    /// The relation between velocities and momenta, along one vector.
    pub(super) legendre: Arc<Program>,
}

/// The context for building any of the programs.
pub(super) struct ProgramBuilder<'a> {
    pub(super) pool: Pool,
    pub(super) equations: &'a Equations,
    pub(super) parameters: Vec<Symbol>,
    pub(super) quadratures: Quadratures,
    pub(super) kkt: ConstraintSystem,
    /// Whether the time of the programs is −t: the motion is run backwards.
    pub(super) backwards: bool,
}

impl ProgramBuilder<'_> {
    pub(super) fn lowering(&mut self) -> Lowering<'_> {
        let time = self.equations.symbols.time;
        let mut lowering = Lowering::new(&mut self.pool, &self.parameters, time);
        if self.backwards {
            let clock = lowering.variable(time);
            let t = lowering.negative(clock);
            lowering.bind(time, t);
        }
        lowering
    }

    pub(super) fn native(&self) -> Form {
        match self.equations.flow {
            Flow::Lagrange { .. } => Form::Velocity,
            Flow::Hamilton { .. } => Form::Momentum,
            Flow::Poisson { .. } => Form::Variables,
        }
    }

    /// A program whose inputs are a state in the native form.
    pub(super) fn on_native_state(&mut self) -> Lowering<'_> {
        let (form, equations) = (self.native(), self.equations);
        let mut lowering = self.lowering();
        bind_state(&mut lowering, &equations.coordinates, form);
        lowering
    }

    /// The same, followed by the auxiliary numbers.
    pub(super) fn on_full_state(&mut self) -> Lowering<'_> {
        let equations = self.equations;
        let mut lowering = self.on_native_state();
        bind_auxiliary(&mut lowering, equations);
        lowering
    }

    /// The index, among the auxiliary numbers, at which an attitude begins.
    pub(super) fn attitude(&self) -> Option<usize> {
        self.auxiliary_index(self.equations.supplements.attitude_symbols?[0][0])
    }

    /// The index, among the auxiliary numbers, at which the comparison motion begins.
    pub(super) fn comparison(&self) -> Option<usize> {
        self.auxiliary_index(self.equations.supplements.vakonomic.as_ref()?.first?)
    }

    fn auxiliary_index(&self, first: Symbol) -> Option<usize> {
        let mut auxiliary =
            self.equations.supplements.auxiliary.iter().flat_map(|auxiliary| &auxiliary.symbols);
        auxiliary.position(|&symbol| symbol == first)
    }

    /// The initial auxiliary numbers, as functions of a state in the native form.
    pub(super) fn auxiliary_start(&mut self) -> Result<Arc<Program>, Symbol> {
        let equations = self.equations;
        let mut lowering = self.on_native_state();
        let mut outputs = Vec::new();
        for auxiliary in &equations.supplements.auxiliary {
            outputs.extend(lower_auxiliary(&mut lowering, &auxiliary.initial));
        }
        lowering.finish(outputs)
    }

    pub(super) fn native_rates(&mut self) -> Result<Arc<Program>, Symbol> {
        let (equations, quadratures) = (self.equations, self.quadratures);
        let (kkt, backwards) = (self.kkt.clone(), self.backwards);
        let mut lowering = self.on_full_state();
        lowering.switch_at_cuts();
        if equations.momenta_jump() {
            // velocities jump there, also where no force does
            lowering.lower_all(&equations.momenta);
        }
        let mut outputs = match &equations.flow {
            Flow::Lagrange { force, .. } => {
                let accelerations = kkt.bind(&mut lowering, equations, force);
                let mut outputs = velocities(&mut lowering, &equations.coordinates);
                outputs.extend(accelerations);
                outputs
            }
            Flow::Hamilton { velocities, momentum_rates } => {
                let mut outputs = lowering.lower_all(velocities);
                outputs.extend(lowering.lower_all(momentum_rates));
                outputs
            }
            Flow::Poisson { rates } => lowering.lower_all(rates),
        };
        outputs.extend(auxiliary_rates(&mut lowering, equations));
        outputs.extend(quadrature_rates(&mut lowering, equations, quadratures));
        finish_rates(lowering, outputs, backwards)
    }

    /// A program whose inputs are a state (q, p), with the velocities of a Lagrangian system known
    /// too. Returns `None` if these require iteration.
    fn on_canonical_state(&mut self) -> Option<Lowering<'_>> {
        let equations = self.equations;
        let coordinates = &equations.coordinates;
        let Flow::Lagrange { mass, .. } = &equations.flow else {
            return Some(self.on_native_state());
        };
        let velocity_symbols: Vec<Symbol> = coordinates.iter().map(|c| c.velocity).collect();
        if self.equations.is_quadratic() {
            // L is quadratic in q̇, so M q̇ = p − b with b the momentum at q̇ = 0
            let rest: HashMap<Symbol, Expr> =
                velocity_symbols.iter().map(|&v| (v, Expr::ZERO)).collect();
            let offsets: Vec<Expr> =
                equations.momenta.iter().map(|&p| self.pool.substitute(p, &rest)).collect();
            let mut lowering = self.lowering();
            let momenta = bind_state(&mut lowering, coordinates, Form::Momentum);
            let right: Vec<Register> = momenta
                .iter()
                .zip(&offsets)
                .map(|(&p, &b)| match b {
                    Expr::ZERO => p,
                    _ => {
                        let b = lowering.lower(b);
                        lowering.difference(p, b)
                    }
                })
                .collect();
            let solution = lowering.solve(mass, &right);
            for (c, v) in coordinates.iter().zip(solution) {
                lowering.bind(c.velocity, v);
            }
            return Some(lowering);
        }
        let closed = equations.velocities.as_ref().ok()?;
        let mut lowering = self.lowering();
        bind_state(&mut lowering, coordinates, Form::Momentum);
        for (c, &v) in coordinates.iter().zip(closed) {
            let register = lowering.lower(v);
            lowering.bind(c.velocity, register);
        }
        Some(lowering)
    }

    /// The same, followed by the auxiliary numbers.
    pub(super) fn on_full_canonical_state(&mut self) -> Option<Lowering<'_>> {
        let equations = self.equations;
        let mut lowering = self.on_canonical_state()?;
        bind_auxiliary(&mut lowering, equations);
        Some(lowering)
    }

    /// Rates of change of a state (q, p). For a Lagrangian system without velocities in closed
    /// form, they are functions of (q, q̇) and the flag is `false`.
    pub(super) fn canonical_rates(&mut self) -> Result<(Arc<Program>, bool), Symbol> {
        let (equations, quadratures) = (self.equations, self.quadratures);
        let Flow::Lagrange { momentum_rates, .. } = &equations.flow else {
            return Ok((self.native_rates()?, true));
        };
        let (kkt, backwards) = (self.kkt.clone(), self.backwards);
        let finish = |mut lowering: Lowering<'_>| {
            if let (false, Flow::Lagrange { force, .. }) =
                (equations.constraints.is_empty(), &equations.flow)
            {
                kkt.bind(&mut lowering, equations, force);
            }
            let mut outputs = velocities(&mut lowering, &equations.coordinates);
            outputs.extend(lowering.lower_all(momentum_rates));
            outputs.extend(auxiliary_rates(&mut lowering, equations));
            outputs.extend(quadrature_rates(&mut lowering, equations, quadratures));
            finish_rates(lowering, outputs, backwards)
        };
        if let Some(lowering) = self.on_full_canonical_state() {
            return Ok((finish(lowering)?, true));
        }
        Ok((finish(self.on_full_state())?, false))
    }

    /// The two parts of a separable system. The action splits with H: Σ p ∂T/∂p − T and −V.
    pub(super) fn split(&mut self) -> Option<Result<SplitHamiltonian, Symbol>> {
        let equations = self.equations;
        let (separable, hamiltonian) =
            (equations.separable.as_ref().ok()?, *equations.hamiltonian.as_ref().ok()?);
        let at_rest: HashMap<Symbol, Expr> =
            equations.coordinates.iter().map(|c| (c.momentum, Expr::ZERO)).collect();
        let potential = self.pool.substitute(hamiltonian, &at_rest);
        let kinetic = self.pool.sub(hamiltonian, potential);
        let mut terms = vec![self.pool.neg(kinetic)];
        for (c, &v) in equations.coordinates.iter().zip(&separable.velocities) {
            let p = self.pool.variable(c.momentum);
            terms.push(self.pool.mul(p, v));
        }
        let drift_action = self.pool.sum(&terms);
        let kick_action = self.pool.neg(potential);
        let drift = self.half(&separable.velocities, drift_action, Expr::ZERO);
        let kick = self.half(&separable.momentum_rates, kick_action, equations.energy_rate);
        Some(drift.and_then(|drift| Ok(SplitHamiltonian { drift, kick: kick? })))
    }

    fn half(&mut self, rates: &[Expr], action: Expr, work: Expr) -> Result<Arc<Program>, Symbol> {
        let (equations, quadratures) = (self.equations, self.quadratures);
        let backwards = self.backwards;
        let mut lowering = self.lowering();
        bind_state(&mut lowering, &equations.coordinates, Form::Momentum);
        let mut outputs = lowering.lower_all(rates);
        if quadratures.action {
            outputs.push(lowering.lower(action));
        }
        if quadratures.work {
            outputs.push(lowering.lower(work));
        }
        finish_rates(lowering, outputs, backwards)
    }
}

/// The finished program of rates of change; backwards, dx/d(−t) = −dx/dt.
fn finish_rates(
    mut lowering: Lowering<'_>,
    mut outputs: Vec<Register>,
    backwards: bool,
) -> Result<Arc<Program>, Symbol> {
    if backwards {
        for rate in &mut outputs {
            *rate = lowering.negative(*rate);
        }
    }
    lowering.finish(outputs)
}

/// Makes a state's coordinates and rates the next inputs and returns the registers of the rates.
fn bind_state(
    lowering: &mut Lowering<'_>,
    coordinates: &[CoordinateSymbols],
    form: Form,
) -> Vec<Register> {
    for c in coordinates {
        let register = lowering.input();
        lowering.bind(c.position, register);
    }
    let with_rates = if form == Form::Variables { &[] } else { coordinates };
    let rates = with_rates.iter().map(|c| {
        let register = lowering.input();
        let symbol = if form == Form::Velocity { c.velocity } else { c.momentum };
        lowering.bind(symbol, register);
        register
    });
    rates.collect()
}

/// Makes the auxiliary numbers the next inputs.
fn bind_auxiliary(lowering: &mut Lowering<'_>, equations: &Equations) {
    for &symbol in equations.supplements.auxiliary.iter().flat_map(|auxiliary| &auxiliary.symbols) {
        let register = lowering.input();
        lowering.bind(symbol, register);
    }
}

fn auxiliary_rates(lowering: &mut Lowering<'_>, equations: &Equations) -> Vec<Register> {
    let all = equations.supplements.auxiliary.iter();
    all.flat_map(|auxiliary| lower_auxiliary(lowering, &auxiliary.rates)).collect()
}

fn lower_auxiliary(lowering: &mut Lowering<'_>, rates: &AuxiliaryRates) -> Vec<Register> {
    let mut outputs = lowering.lower_all(&rates.plain);
    let right = lowering.lower_all(&rates.right);
    outputs.extend(lowering.solve(&rates.matrix, &right));
    outputs
}

fn velocities(lowering: &mut Lowering<'_>, coordinates: &[CoordinateSymbols]) -> Vec<Register> {
    coordinates.iter().map(|c| lowering.variable(c.velocity)).collect()
}

fn quadrature_rates(
    lowering: &mut Lowering<'_>,
    equations: &Equations,
    quadratures: Quadratures,
) -> Vec<Register> {
    let mut outputs = Vec::new();
    if quadratures.action {
        outputs.push(lowering.lower(equations.action_rate));
    }
    if quadratures.work {
        outputs.push(lowering.lower(equations.energy_rate));
    }
    outputs
}
