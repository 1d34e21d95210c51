//! The equations of motion as a derivation of functions of the state, evaluated at random points over a prime field.
//!
//! In: a model and its equations. Out: the variables of the state, points that satisfy the constraints, and the rate
//! of each variable there. M q̈ = f + Aᵀλ is solved at the point, never symbolically. Never here: how equations are
//! derived.

use std::collections::HashMap;

use rustc_hash::FxHashMap;

use super::echelon::{Echelon, solve};
use super::evaluator::{ResidueEvaluator, ResidueRates, SamplePoint};
use super::random::Random;
use crate::expr::{Expr, Pool, Symbol};
use crate::mechanics::{Equations, Flow};
use crate::model::Model;
use crate::num::{PrimeField, Residue};

/// How the rates of the variables are known.
#[derive(Clone, Debug)]
pub(super) enum RateRule {
    Explicit(Vec<Expr>),
    /// Positions, then velocities: M q̈ − Aᵀλ = f, A q̈ = γ.
    Solved {
        mass: Vec<Vec<Expr>>,
        force: Vec<Expr>,
        rows: Vec<LawConstraint>,
    },
}

/// A constraint A q̇ + a = 0, with f(q) = 0 where it is holonomic.
#[derive(Clone, Debug)]
pub(super) struct LawConstraint {
    pub(super) slopes: Vec<Expr>,
    rate: Expr,
    bias: Expr,
    position: Option<Expr>,
}

/// Returns whether constants are searched in phase space, where they have brackets: nothing but H acts.
pub fn is_hamiltonian(model: &Model, equations: &mut Equations) -> bool {
    let driven = model.mechanics.forces().iter().any(|&f| f != Expr::ZERO);
    let free = model.mechanics.dissipation() == Expr::ZERO && model.constraints.is_empty();
    free && !driven && equations.hamiltonian().is_ok()
}

impl LawConstraint {
    /// Whether it does not move by itself: A q̇ = 0 without time.
    pub(super) fn is_scleronomic(&self, pool: &Pool, time: Symbol) -> bool {
        self.rate == Expr::ZERO && !self.slopes.iter().any(|&a| pool.depends(a, time))
    }
}

#[derive(Clone, Debug)]
pub(super) struct Law {
    /// The variables of the state; of canonical ones all positions come first.
    pub(super) variables: Vec<Symbol>,
    /// The number of positions; 0 for the variables of a Poisson system, which are all alike.
    pub(super) positions: usize,
    pub(super) rule: RateRule,
    /// H, or Jacobi's h.
    pub(super) energy: Expr,
    pub(super) time: Symbol,
    /// Whether q̇ = ∂H/∂p, ṗ = −∂H/∂q, or ẋ = {x, H}, and nothing else acts.
    pub(super) hamiltonian: bool,
}

impl Law {
    /// The law of a model, in phase space where H is known in closed form and nothing else acts.
    pub(super) fn of(model: &Model, equations: &mut Equations) -> Law {
        let undriven = is_hamiltonian(model, equations);
        let symbols = equations.coordinates.clone();
        let positions: Vec<Symbol> = symbols.iter().map(|c| c.position).collect();
        let momenta = symbols.iter().map(|c| c.momentum);
        let phase: Vec<Symbol> = positions.iter().copied().chain(momenta).collect();
        let time = equations.symbols.time;
        let (variables, rule, hamiltonian, energy) = match equations.flow.clone() {
            Flow::Poisson { rates } => {
                (positions.clone(), RateRule::Explicit(rates), undriven, equations.energy)
            }
            Flow::Hamilton { velocities, momentum_rates } => {
                let rates = velocities.into_iter().chain(momentum_rates).collect();
                (phase, RateRule::Explicit(rates), undriven, equations.energy)
            }
            Flow::Lagrange { mass, force, .. } => match equations.hamiltonian().clone() {
                Ok(h) if undriven => {
                    let pool = &mut equations.pool;
                    let mut rates = Vec::new();
                    rates.extend(symbols.iter().map(|c| pool.derivative(h, c.momentum)));
                    for c in &symbols {
                        let slope = pool.derivative(h, c.position);
                        rates.push(pool.neg(slope));
                    }
                    (phase, RateRule::Explicit(rates), true, h)
                }
                _ => {
                    let velocities = symbols.iter().map(|c| c.velocity);
                    let state = positions.iter().copied().chain(velocities).collect();
                    let rows = equations.constraints.iter().map(|c| LawConstraint {
                        slopes: c.row.clone(),
                        rate: c.rate,
                        bias: c.bias,
                        position: c.position,
                    });
                    let rule = RateRule::Solved { mass, force, rows: rows.collect() };
                    (state, rule, false, equations.energy)
                }
            },
        };
        let positions = if model.is_poisson() { 0 } else { positions.len() };
        Law { variables, positions, rule, energy, time, hamiltonian }
    }

    /// The symbols that move: the variables and the time.
    pub(super) fn moving(&self) -> Vec<Symbol> {
        self.variables.iter().copied().chain([self.time]).collect()
    }

    pub(super) fn expressions(&self) -> Vec<Expr> {
        let mut all = vec![self.energy];
        match &self.rule {
            RateRule::Explicit(rates) => all.extend(rates),
            RateRule::Solved { mass, force, rows } => {
                all.extend(mass.concat());
                all.extend(force);
                for row in rows {
                    all.extend(&row.slopes);
                    all.extend([row.rate, row.bias]);
                    all.extend(row.position);
                }
            }
        }
        all
    }

    /// The same law with symbols replaced.
    pub(super) fn substituted(&self, pool: &mut Pool, map: &HashMap<Symbol, Expr>) -> Law {
        let mut law = self.clone();
        let mut put = |e: &mut Expr| *e = pool.substitute(*e, map);
        put(&mut law.energy);
        match &mut law.rule {
            RateRule::Explicit(rates) => rates.iter_mut().for_each(&mut put),
            RateRule::Solved { mass, force, rows } => {
                mass.iter_mut().flatten().for_each(&mut put);
                force.iter_mut().for_each(&mut put);
                for row in rows {
                    row.slopes.iter_mut().for_each(&mut put);
                    [&mut row.rate, &mut row.bias].into_iter().for_each(&mut put);
                    row.position.iter_mut().for_each(&mut put);
                }
            }
        }
        law
    }

    /// The momenta, or velocities; none of a Poisson system.
    pub(super) fn momenta(&self) -> &[Symbol] {
        if self.positions == 0 { &[] } else { &self.variables[self.positions..] }
    }

    pub(super) fn is_driven(&self, pool: &Pool) -> bool {
        self.expressions().into_iter().any(|e| pool.depends(e, self.time))
    }

    /// dF/dt along the motion as an expression; `None` where accelerations are solved for at points.
    pub(super) fn rate(&self, pool: &mut Pool, f: Expr) -> Option<Expr> {
        let RateRule::Explicit(rates) = &self.rule else { return None };
        let mut seeds: Vec<(Symbol, Expr)> =
            self.variables.iter().copied().zip(rates.iter().copied()).collect();
        seeds.push((self.time, Expr::ONE));
        Some(pool.derivation(f, &seeds))
    }

    /// A random state that satisfies the constraints, with the rates of everything compiled. `None` where something
    /// has no value there; another point is then drawn.
    pub(super) fn draw(
        &self,
        evaluator: &ResidueEvaluator,
        field: PrimeField,
        random: &mut Random,
        constants: &FxHashMap<Symbol, Residue>,
        seed: u64,
    ) -> Option<DrawnPoint> {
        let mut state = constants.clone();
        let drawn = self.variables.iter().chain([&self.time]).copied();
        evaluator.draw(field, random, drawn, &mut state);
        let begin = random.clone();
        *random = Random::new(random.next());
        let evaluate = |state: &FxHashMap<Symbol, Residue>| {
            evaluator.point(field, &mut begin.clone(), seed, &|s| state.get(&s).copied())
        };
        if let RateRule::Solved { rows, .. } = &self.rule {
            self.constrain(rows, evaluator, field, &mut state, &evaluate)?;
        }
        let point = evaluate(&state)?;
        let rates = self.rates_at(evaluator, &point, &state)?;
        let all = evaluator.rates(&point, &|s| rates.get(&s).copied().unwrap_or_default())?;
        Some(DrawnPoint { point, rates: all })
    }

    /// Moves a state onto the constraints: one position for each holonomic one, where it is at most quadratic in it,
    /// then velocities.
    fn constrain(
        &self,
        rows: &[LawConstraint],
        evaluator: &ResidueEvaluator,
        field: PrimeField,
        state: &mut FxHashMap<Symbol, Residue>,
        evaluate: &dyn Fn(&FxHashMap<Symbol, Residue>) -> Option<SamplePoint>,
    ) -> Option<()> {
        let mut used: Vec<Symbol> = Vec::new();
        let holonomic: Vec<Expr> = rows.iter().filter_map(|row| row.position).collect();
        for (k, &f) in holonomic.iter().enumerate() {
            let mut solved = false;
            for &q in &self.variables[..self.positions] {
                if used.contains(&q) {
                    continue;
                }
                // c₀ + c₁ q + c₂ q², confirmed at a fourth value
                let mut at = |n: i128| {
                    state.insert(q, field.integer(n));
                    evaluate(state).map(|point| evaluator.value(&point, f))
                };
                let [f0, f1, f2, f3] = [at(0)?, at(1)?, at(-1)?, at(2)?];
                let half = field.inverse(field.residue(2))?;
                let c2 = field.sub(field.mul(half, field.add(f1, f2)), f0);
                let c1 = field.mul(half, field.sub(f1, f2));
                let four = field.mul(field.residue(4), c2);
                if field.add(field.add(f0, field.add(c1, c1)), four) != f3
                    || (c1.is_zero() && c2.is_zero())
                {
                    continue;
                }
                let value = if c2.is_zero() {
                    field.neg(field.mul(f0, field.inverse(c1)?))
                } else {
                    let under = field
                        .sub(field.mul(c1, c1), field.mul(field.mul(field.residue(4), c2), f0));
                    let root = field.root(under, 2)?;
                    // either root may be meant
                    let root =
                        if field.value(f3).is_multiple_of(2) { root } else { field.neg(root) };
                    field.mul(field.sub(root, c1), field.inverse(field.add(c2, c2))?)
                };
                state.insert(q, value);
                // those before it must not have moved
                let point = evaluate(state)?;
                if holonomic[..=k].iter().all(|&g| evaluator.value(&point, g).is_zero()) {
                    used.push(q);
                    solved = true;
                    break;
                }
            }
            if !solved {
                return None;
            }
        }
        // A v + a = 0: the velocities with a leading coefficient follow from the others
        let point = evaluate(state)?;
        let velocities = &self.variables[self.positions..];
        let augmented: Vec<Vec<Residue>> = rows
            .iter()
            .map(|row| {
                let all = row.slopes.iter().chain([&row.rate]);
                all.map(|&e| evaluator.value(&point, e)).collect()
            })
            .collect();
        let order: Vec<usize> = (0..velocities.len()).collect();
        for row in super::echelon::reduced(field, &augmented, &order) {
            let lead = row[..velocities.len()].iter().position(|x| !x.is_zero())?;
            let mut sum = row[velocities.len()];
            for (k, &v) in velocities.iter().enumerate().filter(|(k, _)| *k != lead) {
                sum = field.add(sum, field.mul(row[k], state[&v]));
            }
            state.insert(velocities[lead], field.neg(sum));
        }
        Some(())
    }

    fn rates_at(
        &self,
        evaluator: &ResidueEvaluator,
        point: &SamplePoint,
        state: &FxHashMap<Symbol, Residue>,
    ) -> Option<FxHashMap<Symbol, Residue>> {
        let field = point.field;
        let mut rates: FxHashMap<Symbol, Residue> = FxHashMap::default();
        rates.insert(self.time, field.one());
        match &self.rule {
            RateRule::Explicit(all) => {
                for (&s, &e) in self.variables.iter().zip(all) {
                    rates.insert(s, evaluator.value(point, e));
                }
            }
            RateRule::Solved { mass, force, rows } => {
                let (n, value) = (force.len(), |e: Expr| evaluator.value(point, e));
                let all = n + rows.len();
                let entry = |i: usize, j: usize| match (i < n, j < n) {
                    (true, true) => value(mass[i][j]),
                    (true, false) => field.neg(value(rows[j - n].slopes[i])),
                    (false, true) => value(rows[i - n].slopes[j]),
                    (false, false) => Residue::ZERO,
                };
                let matrix = (0..all).map(|i| (0..all).map(|j| entry(i, j)).collect()).collect();
                let right = force.iter().copied().chain(rows.iter().map(|row| row.bias));
                let solution = solve(field, matrix, right.map(value).collect())?;
                let (q, v) = self.variables.split_at(self.positions);
                for i in 0..n {
                    rates.insert(q[i], state[&v[i]]);
                    rates.insert(v[i], solution[i]);
                }
            }
        }
        Some(rates)
    }

    /// The rank of the gradients of functions with respect to the state, at a random point. What is reported is a
    /// lower bound, and equal to the rank but for a chance of the order of 2⁻⁵⁰.
    pub(super) fn independent(
        &self,
        evaluator: &ResidueEvaluator,
        point: &SamplePoint,
        functions: &[Expr],
    ) -> Option<Vec<bool>> {
        let field = point.field;
        let mut columns = Vec::new();
        for direction in self.directions(evaluator, point) {
            let seed = |s: Symbol| {
                let k = self.variables.iter().position(|&v| v == s);
                k.map_or(Residue::ZERO, |k| direction[k])
            };
            let rates = evaluator.rates(point, &seed)?;
            columns.push(functions.iter().map(|&f| evaluator.rate(&rates, f)).collect::<Vec<_>>());
        }
        let mut echelon = Echelon::new(field, columns.len());
        let gradient = |i: usize| columns.iter().map(|c| c[i]).collect::<Vec<_>>();
        Some((0..functions.len()).map(|i| echelon.add(gradient(i))).collect())
    }

    pub(super) fn dimension(&self, evaluator: &ResidueEvaluator, point: &SamplePoint) -> usize {
        self.directions(evaluator, point).len()
    }

    /// The directions in which a state may vary: all, or those along the constraints on positions and velocities.
    fn directions(&self, evaluator: &ResidueEvaluator, point: &SamplePoint) -> Vec<Vec<Residue>> {
        let field = point.field;
        let width = self.variables.len();
        let mut conditions = Echelon::new(field, width);
        if let RateRule::Solved { rows, .. } = &self.rule {
            let (q, v) = self.variables.split_at(self.positions);
            for row in rows {
                let value = |e: Expr| evaluator.value(point, e);
                if row.position.is_some() {
                    let mut condition: Vec<Residue> =
                        row.slopes.iter().map(|&a| value(a)).collect();
                    condition.resize(width, Residue::ZERO);
                    conditions.add(condition);
                }
                // d(A v + a) = 0 in all directions
                let mut condition = vec![Residue::ZERO; width];
                for (k, &s) in q.iter().enumerate() {
                    let Some(slopes) = evaluator
                        .rates(point, &|x| if x == s { field.one() } else { Residue::ZERO })
                    else {
                        continue;
                    };
                    let mut sum = evaluator.rate(&slopes, row.rate);
                    for (&a, &vel) in row.slopes.iter().zip(v) {
                        let speed = evaluator.symbol_value(point, vel);
                        sum = field.add(sum, field.mul(evaluator.rate(&slopes, a), speed));
                    }
                    condition[k] = sum;
                }
                for (k, &a) in row.slopes.iter().enumerate() {
                    condition[self.positions + k] = value(a);
                }
                conditions.add(condition);
            }
        }
        conditions.null_space()
    }
}

/// A point of the state with the rates of everything there.
#[derive(Clone, Debug)]
pub(super) struct DrawnPoint {
    pub(super) point: SamplePoint,
    pub(super) rates: ResidueRates,
}
