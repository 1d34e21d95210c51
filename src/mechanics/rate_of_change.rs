//! The rate of change of an observable along the motion, and whether it vanishes.
//!
//! In: an observable. Out: its rate as a function of the state, whether it is conserved, whether it may jump. Never here:
//! which observables are evaluated.
//! Source: *The Principles of Dynamics*, §§ 1.4.2, 3.2.3.

use std::collections::HashMap;

use super::equations::{Equations, Flow};
use crate::expr::{Expr, FunctionId, Node, Pool, Symbol, Zero};
use crate::num::Number;

/// Whether two expressions as they stand are multiples of each other.
pub(super) fn is_multiple(pool: &Pool, a: Expr, b: Expr) -> bool {
    have_one_ratio(pool, [a, b], true)
}

/// The same but for constant terms.
fn is_multiple_but_constants(pool: &Pool, a: Expr, b: Expr) -> bool {
    have_one_ratio(pool, [a, b], false)
}

/// Whether the terms of two sums are the same but for one factor, the constant ones as well where they count.
fn have_one_ratio(pool: &Pool, both: [Expr; 2], constants_count: bool) -> bool {
    let [(c, terms), (d, others)] = both.map(|e| match pool.node(e) {
        Node::Sum(constant, terms) => (*constant, terms.to_vec()),
        _ => (Number::ZERO, vec![(Number::ONE, e)]),
    });
    let Some(ratio) = terms.first().zip(others.first()).map(|(a, b)| a.0 * b.0.recip()) else {
        return both[0] == both[1];
    };
    // numbers that are no rationals of 64 bits were rounded on their way into each sum
    let same = |m: Number, n: Number| {
        m == n || (m.value() - n.value()).abs() <= 8.0 * f64::EPSILON * m.value().abs()
    };
    let pairs = || terms.iter().zip(&others);
    terms.len() == others.len()
        && (!constants_count || same(c, ratio * d))
        && pairs().all(|(&(m, a), &(n, b))| a == b && same(m, ratio * n))
}

pub(super) enum ConservedBy {
    /// Its rate is proved to vanish.
    Always,
    /// Its rate is proved to vanish where the constraints are satisfied.
    OnConstraints,
    /// Its rate is zero to rounding.
    ByValues,
}

impl Equations {
    /// Whether a function, written as an observable is, shows without any proof that it is constant along the motion: it is
    /// one of the parameters, of the energy and of momenta whose rates are zero as they are written, or the energy written out.
    pub fn is_plainly_constant(&self, function: Expr) -> bool {
        let rates = match &self.flow {
            Flow::Lagrange { momentum_rates, .. } | Flow::Hamilton { momentum_rates, .. } => {
                momentum_rates
            }
            Flow::Poisson { .. } => return false,
        };
        let mut moving: Vec<Symbol> = vec![self.symbols.time, self.symbols.action];
        for (c, &rate) in self.coordinates.iter().zip(rates) {
            moving.extend([c.position, c.velocity, c.acceleration]);
            if rate != Expr::ZERO {
                moving.push(c.momentum);
            }
        }
        if self.energy_rate != Expr::ZERO {
            moving.push(self.symbols.energy);
        }
        moving.extend(self.constraints.iter().map(|c| c.multiplier));
        moving.extend(self.supplements.auxiliary.iter().flat_map(|a| a.symbols.iter().copied()));
        let is_energy = self.energy_rate == Expr::ZERO
            && is_multiple_but_constants(&self.pool, function, self.energy);
        (is_energy || !self.pool.depends_on_any(function, &moving))
            && !self.has_images(function)
            && !self.law_jumps()
    }

    /// Whether two functions are multiples of each other as they are written.
    pub fn are_multiples(&self, one: Expr, other: Expr) -> bool {
        is_multiple(&self.pool, one, other)
    }

    /// How it is known that an observable is conserved, or `None` if it is not. If constraints may
    /// be `released`, only what holds for any constraint forces counts.
    pub(super) fn knowledge_of(&mut self, observable: Expr, released: bool) -> Option<ConservedBy> {
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
    pub fn moving(&self) -> Vec<Symbol> {
        let mut moving = vec![self.symbols.time];
        moving.extend(self.supplements.ramp_rates.iter().map(|(symbol, _)| *symbol));
        moving.extend(self.coordinates.iter().flat_map(|c| [c.position, c.velocity, c.momentum]));
        moving
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
        let mut seeds = self.by_time();
        seeds.push((self.symbols.energy, self.energy_rate));
        for (c, &rate) in self.coordinates.clone().iter().zip(&momentum_rates) {
            seeds.push((c.position, self.pool.variable(c.velocity)));
            seeds.push((c.momentum, rate));
        }
        let rate = self.derivation(g, &seeds).ok()?;
        if self.has_images(g) {
            if self.pool.depends(g, self.symbols.energy) {
                return None;
            }
            // in q and p, from which the new variables follow
            let known = self.velocities().clone().ok()?;
            let map = self.coordinates.iter().map(|c| c.velocity).zip(known).collect();
            let rate = self.pool.substitute(rate, &map);
            return self.in_generating_variables(rate).ok();
        }
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
        if self.is_lagrangian() && self.has_images(observable) {
            return None;
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
        let rate = self.derivation(g, &seeds).ok()?;
        self.in_generating_variables(rate).ok()
    }
}
