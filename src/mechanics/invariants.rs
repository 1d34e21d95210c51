//! Finds conserved quantities symbolically, without input from the user: cyclic momenta, coordinates
//! whose momenta are absent from H, the energy, the momenta of common translations and rotations
//! (`symmetry`), and those of the file's observables whose rate of change vanishes.
//! Source: *The Principles of Dynamics*, §§ 1.4.2, 3.2.3.

use std::collections::HashMap;

use super::equations::{Conserved, Equations, Flow, Reason};
use super::symmetry;
use crate::expr::{Expr, FunctionId, Node, Pool, Symbol, Zero};
use crate::model::{Action, Mechanics, Model, Observable};
use crate::num::Number;

/// Fills `cyclic` and `conserved`.
pub(super) fn find(equations: &mut Equations, model: &Model) {
    let rates = match &equations.flow {
        Flow::Lagrange { momentum_rates, .. } | Flow::Hamilton { momentum_rates, .. } => {
            momentum_rates.clone()
        }
        Flow::Poisson { .. } => Vec::new(),
    };
    let jumps = equations.law_jumps();
    for (i, (&rate, coordinate)) in rates.iter().zip(&model.coordinates).enumerate() {
        let reason = match equations.pool.is_zero(rate) {
            _ if jumps && !is_absent(equations, model, i) => continue,
            Zero::No | Zero::Unknown => continue,
            Zero::Numerically => Reason::Numerically,
            // a force that balances a slope leaves p constant, but the coordinate is not cyclic
            Zero::Proved if is_absent(equations, model, i) => {
                equations.cyclic.push(i);
                Reason::Cyclic(coordinate.shown.clone())
            }
            Zero::Proved => proved(equations, model),
        };
        equations.conserved.push(Conserved {
            name: format!("p_{}", coordinate.name),
            expression: equations.momenta[i],
            reason,
        });
    }
    if !jumps {
        find_constant_coordinates(equations, model);
    }
    let energy = Conserved {
        name: "energy".to_owned(),
        expression: equations.energy,
        reason: energy_reason(equations, model),
    };
    let rate = equations.energy_rate;
    match equations.pool.is_zero(rate) {
        _ if jumps => {}
        Zero::Proved => equations.conserved.push(energy),
        Zero::Numerically => {
            equations.conserved.push(Conserved { reason: Reason::Numerically, ..energy });
        }
        Zero::No | Zero::Unknown => {}
    }
    if let Mechanics::Poisson { casimirs, forces, .. } = &model.mechanics {
        for (name, casimir, _) in casimirs {
            let rate = casimir_rate(equations, *casimir, forces);
            if rate == Expr::ZERO {
                let (name, reason) = (name.clone(), Reason::Casimir);
                equations.conserved.push(Conserved { name, expression: *casimir, reason });
            }
        }
    } else if !jumps {
        symmetry::find(equations, model, &rates);
    }
    // a consequence of a constraint is lost once the constraint is released
    let released = model.events.iter().any(|e| matches!(e.action, Action::Release(_)));
    for observable in &model.observables {
        name_observable(equations, model, observable, released);
    }
    for i in 0..equations.conserved.len() {
        let quantity = equations.conserved[i].expression;
        if is_changed_by_impulse(equations, model, quantity) {
            let reason = Box::new(equations.conserved[i].reason.clone());
            equations.conserved[i].reason = Reason::BetweenImpulses(reason);
        }
    }
}

/// Adds the coordinates whose momenta do not appear in H. Nothing but H moves a coordinate: forces, constraints and
/// impulses act on momenta.
fn find_constant_coordinates(equations: &mut Equations, model: &Model) {
    let Flow::Hamilton { velocities, .. } = &equations.flow else { return };
    for (velocity, coordinate) in velocities.clone().into_iter().zip(&model.coordinates) {
        if equations.pool.is_zero(velocity) != Zero::Proved {
            continue;
        }
        let momentum = equations.pool.symbol_info(coordinate.momentum).unicode.clone();
        let expression = equations.pool.variable(coordinate.position);
        let (name, reason) = (coordinate.name.clone(), Reason::AbsentMomentum(momentum));
        equations.conserved.push(Conserved { name, expression, reason });
    }
}

/// Returns whether an impulse of the file may change a quantity. An impulse on one momentum changes every velocity that
/// the kinetic energy couples to it, and under constraints, whose reactions are impulses too, all of them.
pub fn is_changed_by_impulse(equations: &mut Equations, model: &Model, quantity: Expr) -> bool {
    let n = equations.coordinates.len();
    let changed: Vec<bool> = (0..n)
        .map(|i| model.impulses.iter().any(|impulse| impulse.change[i] != Expr::ZERO))
        .collect();
    if !changed.contains(&true) {
        return false;
    }
    let energy = equations.symbols.energy;
    if model.is_poisson() {
        let variables = equations.coordinates.iter().map(|c| c.position);
        let moved: Vec<Symbol> =
            variables.zip(&changed).filter(|(_, changed)| **changed).map(|(s, _)| s).collect();
        return equations.pool.depends_on_any(quantity, &moved)
            || equations.pool.depends(quantity, energy);
    }
    let constrained = !model.constraints.is_empty();
    let quantity = if equations.is_lagrangian() { quantity } else { equations.open(quantity) };
    if !constrained && (0..n).any(|i| !changed[i] && equations.momenta[i] == quantity) {
        return false;
    }
    // the velocities that the kinetic energy couples to a momentum that an impulse changes
    let mut coupled = changed.clone();
    let depends = |i: usize, j: usize| {
        equations.pool.depends(equations.momenta[i], equations.coordinates[j].velocity)
    };
    loop {
        let more: Vec<usize> = (0..n)
            .filter(|&j| {
                !coupled[j] && (0..n).any(|i| coupled[i] && (depends(i, j) || depends(j, i)))
            })
            .collect();
        if more.is_empty() {
            break;
        }
        for j in more {
            coupled[j] = true;
        }
    }
    let mut moved = vec![energy];
    for (i, c) in equations.coordinates.iter().enumerate() {
        if changed[i] || constrained {
            moved.push(c.momentum);
        }
        if coupled[i] || constrained {
            moved.extend([c.velocity, c.acceleration]);
        }
    }
    equations.pool.depends_on_any(quantity, &moved)
}

/// Whether two expressions as they stand are multiples of each other.
fn is_multiple(pool: &Pool, a: Expr, b: Expr) -> bool {
    let (Node::Sum(c, terms), Node::Sum(d, others)) = (pool.node(a), pool.node(b)) else {
        return a == b;
    };
    let Some(ratio) = terms.first().zip(others.first()).map(|(a, b)| a.0 * b.0.recip()) else {
        return a == b;
    };
    // numbers that are no rationals of 64 bits were rounded on their way into each sum
    let same = |m: Number, n: Number| {
        m == n || (m.value() - n.value()).abs() <= 8.0 * f64::EPSILON * m.value().abs()
    };
    let pairs = || terms.iter().zip(others);
    terms.len() == others.len()
        && same(*c, ratio * *d)
        && pairs().all(|(&(m, a), &(n, b))| a == b && same(m, ratio * n))
}

/// Whether a product has the factors of an expression, so that it vanishes where that does; what does not depend on the
/// `moving` symbols never does.
fn has_factors_of(pool: &Pool, factors: &[(Expr, Number)], of: Expr, moving: &[Symbol]) -> bool {
    let among = |wanted: Expr, power: Number| {
        let enough = |n: Number| n.value() >= power.value();
        factors.iter().any(|&(e, n)| enough(n) && is_multiple(pool, e, wanted))
    };
    match pool.node(of) {
        Node::Product(_, parts) => {
            let mut varying = parts.iter().filter(|(e, _)| pool.depends_on_any(*e, moving));
            varying.all(|&(e, n)| n.value() > 0.0 && among(e, n)) || among(of, Number::ONE)
        }
        _ => among(of, Number::ONE),
    }
}

/// Returns whether nothing but the law acts: no forces, no dissipation, no constraints.
fn is_free(model: &Model) -> bool {
    model.constraints.is_empty()
        && model.mechanics.dissipation() == Expr::ZERO
        && model.mechanics.forces().iter().all(|&force| force == Expr::ZERO)
}

/// The reason for a quantity whose rate is proved to vanish: by the bracket if the motion is
/// Hamiltonian.
fn proved(equations: &mut Equations, model: &Model) -> Reason {
    if is_free(model) && equations.hamiltonian().is_ok() {
        Reason::Commutes
    } else {
        Reason::Proved
    }
}

/// Why the energy's rate vanishes: either the law does not contain the time and nothing else acts
/// except scleronomic constraints, or the contributions balance.
fn energy_reason(equations: &mut Equations, model: &Model) -> Reason {
    let (_, law) = model.mechanics.function();
    let explicit = equations.pool.derivative(law, equations.symbols.time);
    let undriven = model.mechanics.dissipation() == Expr::ZERO
        && model.mechanics.forces().iter().all(|&force| force == Expr::ZERO)
        && equations.constraints.iter().all(|c| c.rate == Expr::ZERO);
    if undriven && equations.pool.is_zero(explicit) == Zero::Proved {
        Reason::TimeTranslation(if equations.is_lagrangian() { 'L' } else { 'H' })
    } else {
        Reason::Proved
    }
}

/// dC/dt = ∇C · f for a Casimir, which H does not change. The result is exactly zero if it is
/// proved to vanish.
pub fn casimir_rate(equations: &mut Equations, casimir: Expr, forces: &[Expr]) -> Expr {
    let variables = equations.coordinates.iter().map(|c| c.position);
    let seeds: Vec<(Symbol, Expr)> = variables.zip(forces.iter().copied()).collect();
    let rate = equations.pool.derivation(casimir, &seeds);
    if equations.pool.is_zero(rate) == Zero::Proved {
        Expr::ZERO
    } else {
        equations.pool.simplify(rate)
    }
}

/// Adds a conserved observable. If it has already been found, as the momentum of a symmetry, it
/// only receives the file's name.
fn name_observable(
    equations: &mut Equations,
    model: &Model,
    observable: &Observable,
    released: bool,
) {
    let expression = observable.expression;
    let opened = equations.open(expression);
    for i in 0..equations.conserved.len() {
        let known = &equations.conserved[i];
        let symmetry = matches!(
            known.reason,
            Reason::Translation(_) | Reason::CommonRotation(_) | Reason::Rotation(_)
        );
        if !symmetry {
            continue;
        }
        let difference = equations.pool.sub(opened, known.expression);
        if equations.pool.is_zero(difference) == Zero::Proved {
            observable.name.clone_into(&mut equations.conserved[i].name);
            return;
        }
    }
    let reason = match equations.knowledge_of(expression, released) {
        Some(ConservedBy::Always) => proved(equations, model),
        Some(ConservedBy::OnConstraints) => Reason::ProvedOnConstraints,
        Some(ConservedBy::ByValues) => Reason::Numerically,
        None if observable.conserved == Some(true) => Reason::Declared,
        None => return,
    };
    equations.conserved.push(Conserved { name: observable.name.clone(), expression, reason });
}

/// Returns whether the i-th coordinate does not appear in L (or H), or has no effect there.
fn is_absent(equations: &mut Equations, model: &Model, i: usize) -> bool {
    let (_, f) = model.mechanics.function();
    let position = model.coordinates[i].position;
    if equations.law_jumps() && equations.pool.depends(f, position) {
        return false;
    }
    let slope = equations.pool.derivative(f, position);
    equations.pool.is_zero(slope) == Zero::Proved
}

/// How it is known that a quantity is conserved.
enum ConservedBy {
    /// Its rate is proved to vanish.
    Always,
    /// Its rate is proved to vanish where the constraints are satisfied.
    OnConstraints,
    /// Its rate is zero to rounding.
    ByValues,
}

impl Equations {
    /// How it is known that an observable is conserved, or `None` if it is not. If constraints may
    /// be `released`, only what holds for any constraint forces counts.
    fn knowledge_of(&mut self, observable: Expr, released: bool) -> Option<ConservedBy> {
        if self.may_jump(observable) {
            return None;
        }
        if let Some(rate) = self.rate_by_momenta(observable)
            && self.pool.is_zero(rate) == Zero::Proved
        {
            return Some(ConservedBy::Always);
        }
        if self.constraints.is_empty() {
            return match self.is_conserved(observable)? {
                Zero::Proved => Some(ConservedBy::Always),
                Zero::Numerically => Some(ConservedBy::ByValues),
                Zero::Unknown | Zero::No => None,
            };
        }
        if released {
            return None;
        }
        let rate = self.rate_of(observable)?;
        match self.pool.is_zero(rate) {
            Zero::Proved => Some(ConservedBy::OnConstraints),
            Zero::Numerically => Some(ConservedBy::ByValues),
            Zero::Unknown | Zero::No => {
                self.vanishes_on_constraints(rate).then_some(ConservedBy::OnConstraints)
            }
        }
    }

    /// Returns whether dG/dt = 0 along the motion, for G written as an observable is, or `None` if
    /// the rate is not known in closed form.
    pub fn is_conserved(&mut self, observable: Expr) -> Option<Zero> {
        if self.may_jump(observable) {
            return Some(Zero::Unknown);
        }
        if let Some(rate) = self.rate_by_momenta(observable)
            && self.pool.is_zero(rate) == Zero::Proved
        {
            return Some(Zero::Proved);
        }
        let rate = self.rate_of(observable)?;
        match self.pool.is_zero(rate) {
            Zero::Unknown | Zero::No if self.vanishes_on_constraints(rate) => Some(Zero::Proved),
            zero => Some(zero),
        }
    }

    /// Returns whether an observable may jump, so that its rate is not the whole answer: the
    /// observable, or the law by which it is conserved, contains a sign or an angle of something
    /// that is not constant, or a quotient that is a sign in disguise, as x/√(x²) and x/|x|.
    pub(super) fn may_jump(&mut self, observable: Expr) -> bool {
        if self.law_jumps() {
            return true;
        }
        let opened = self.open(observable);
        let arguments: Vec<Expr> = self
            .pool
            .reachable(&[opened])
            .into_iter()
            .flat_map(|part| match self.pool.node(part) {
                Node::Call(FunctionId::Sign | FunctionId::Atan2, arguments) => arguments.to_vec(),
                _ => self.steep_divisors(part),
            })
            .collect();
        let jumps = arguments.into_iter().any(|argument| {
            let rate = self.rate_of(argument);
            rate.is_none_or(|rate| self.pool.is_zero(rate) != Zero::Proved)
        });
        jumps || self.may_jump_on_constraints(opened)
    }

    /// Divisors that vanish on a surface at which the quotient may have another limit on each side without a pole: the
    /// quotient has kinks, or the divisor stands under a root that has one, or in an arctangent.
    fn steep_divisors(&self, part: Expr) -> Vec<Expr> {
        let pool = &self.pool;
        let moving = self.moving();
        let has_kink = |e: Expr| {
            pool.reachable(&[e]).into_iter().any(|part| match pool.node(part) {
                // |u| is also e^{½ ln u²}
                Node::Call(FunctionId::Ln, u) => pool.touches_zero(u[0], &moving),
                Node::Call(function, _) => matches!(
                    function,
                    FunctionId::Abs | FunctionId::Max | FunctionId::Min | FunctionId::Sign
                ),
                Node::Product(_, factors) => {
                    let mut factors = factors.iter();
                    factors.any(|(e, n)| n.as_integer().is_none() && pool.touches_zero(*e, &moving))
                }
                _ => false,
            })
        };
        match pool.node(part) {
            Node::Call(FunctionId::Atan, argument) => {
                let mut steep = Vec::new();
                for part in pool.reachable(argument) {
                    // a tangent has poles
                    if let Node::Call(FunctionId::Tan | FunctionId::Cot, angle) = pool.node(part) {
                        steep.extend(angle.iter().filter(|&&e| pool.depends_on_any(e, &moving)));
                    }
                    let below = self.divisors(part).into_iter().map(|(e, _)| e);
                    steep.extend(below.filter(|&e| pool.vanishes(e, &moving)));
                }
                steep
            }
            _ => {
                let below = self.divisors(part);
                let kinked = !below.is_empty() && has_kink(part);
                below
                    .into_iter()
                    .filter(|&(e, root)| {
                        root && pool.touches_zero(e, &moving) || kinked && pool.vanishes(e, &moving)
                    })
                    .map(|(e, _)| e)
                    .collect()
            }
        }
    }

    /// The time, coordinates, velocities and momenta.
    pub(super) fn moving(&self) -> Vec<Symbol> {
        let mut moving = vec![self.symbols.time];
        moving.extend(self.coordinates.iter().flat_map(|c| [c.position, c.velocity, c.momentum]));
        moving
    }

    /// Returns whether L (or H) has a step, where the force is an impulse that no derivative shows.
    pub fn law_jumps(&self) -> bool {
        let moving = self.moving();
        let pool = &self.pool;
        let steps = |e: Expr| match pool.node(e) {
            Node::Call(FunctionId::Sign, argument) => {
                pool.depends_on_any(e, &moving).then_some(argument[0])
            }
            _ => None,
        };
        let jumps = |e: Expr| {
            let node = pool.node(e);
            node.parts().into_iter().filter_map(steps).any(|argument| match node {
                // u sign(c u) = ±|u|
                Node::Product(_, factors) => !has_factors_of(pool, factors, argument, &moving),
                _ => true,
            })
        };
        steps(self.law).is_some() || pool.reachable(&[self.law]).into_iter().any(jumps)
    }

    /// dG/dt of a function of q, p, t and the energy of a Lagrangian system, in the symbols of q,
    /// q̇, p, t and λ. It uses ṗ and Ė directly, so no acceleration has to be solved for. Returns
    /// `None` for any other function.
    fn rate_by_momenta(&mut self, observable: Expr) -> Option<Expr> {
        let Flow::Lagrange { momentum_rates, .. } = &self.flow else { return None };
        let momentum_rates = momentum_rates.clone();
        let map = self.attitude_map();
        let g = self.pool.substitute(observable, &map);
        let fast = self.coordinates.iter().flat_map(|c| [c.velocity, c.acceleration]);
        let others = self.constraints.iter().map(|c| c.multiplier);
        let auxiliary =
            self.supplements.auxiliary.iter().flat_map(|auxiliary| auxiliary.symbols.clone());
        let others: Vec<Symbol> =
            fast.chain(others).chain(auxiliary).chain([self.symbols.action]).collect();
        if self.pool.depends_on_any(g, &others) {
            return None;
        }
        let mut seeds =
            vec![(self.symbols.time, Expr::ONE), (self.symbols.energy, self.energy_rate)];
        for (c, &rate) in self.coordinates.clone().iter().zip(&momentum_rates) {
            seeds.push((c.position, self.pool.variable(c.velocity)));
            seeds.push((c.momentum, rate));
        }
        let rate = self.pool.derivation(g, &seeds);
        let mut opened: HashMap<Symbol, Expr> =
            self.coordinates.iter().map(|c| c.momentum).zip(self.momenta.clone()).collect();
        opened.insert(self.symbols.energy, self.energy);
        Some(self.pool.substitute(rate, &opened))
    }

    /// dG/dt along the motion, in the variables of the state. Returns `None` if the accelerations
    /// are not known in closed form or G contains the action.
    pub fn rate_of(&mut self, observable: Expr) -> Option<Expr> {
        if let Some(rate) = self.rate_by_momenta(observable) {
            // the multipliers, if any, as functions of the state
            let multipliers: Vec<Symbol> = self.constraints.iter().map(|c| c.multiplier).collect();
            if !self.pool.depends_on_any(rate, &multipliers) {
                return Some(rate);
            }
            if self.multipliers().is_ok() {
                return Some(self.open(rate));
            }
        }
        let g = self.open(observable);
        let solved = self.solved().clone().ok()?;
        let accelerations = self.coordinates.iter().map(|c| c.acceleration);
        let multipliers = self.constraints.iter().map(|c| c.multiplier);
        let unknown: Vec<Symbol> =
            accelerations.chain(multipliers).chain([self.symbols.action]).collect();
        if self.pool.depends_on_any(g, &unknown) {
            return None;
        }
        let mut seeds = self.along_the_flow();
        for auxiliary in &self.supplements.auxiliary {
            if auxiliary.rates.plain.len() == auxiliary.symbols.len() {
                seeds.extend(auxiliary.symbols.iter().copied().zip(auxiliary.rates.plain.clone()));
            } else if self.pool.depends_on_any(g, &auxiliary.symbols) {
                return None;
            }
        }
        if self.is_lagrangian() {
            for (c, &acceleration) in self.coordinates.clone().iter().zip(&solved) {
                let velocity = self.pool.variable(c.velocity);
                seeds.push((c.position, velocity));
                seeds.push((c.velocity, acceleration));
            }
        }
        Some(self.pool.derivation(g, &seeds))
    }
}
