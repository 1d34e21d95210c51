//! Where the law itself jumps, not only its derivatives.
//!
//! In: L (or H). Out: whether a sign or the cut of an angle is a step of it, where the force is an impulse that no derivative
//! shows. Never here: where a motion meets it.

use super::equations::{Equations, Flow};
use super::rate_of_change::is_multiple;
use crate::expr::{Expr, FunctionId, Node, Pool, Symbol, Zero, is_never_negative, keeps_its_sign};
use crate::num::Number;

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

impl Equations {
    /// Returns whether L (or H) has a step, so that its derivatives are not the whole answer.
    pub fn law_jumps(&self) -> bool {
        self.has_sign_of(self.law, &self.moving()) || self.law_cut().is_some()
    }

    /// Returns whether a motion may come to a step of L (or H), where the force is an impulse that no derivative shows. At a step in
    /// time there is none: forces jump there, or velocities.
    pub fn has_impulses_at_steps(&self) -> bool {
        self.has_sign_of(self.law, &self.places()) || self.law_cut_at_a_place().is_some()
    }

    /// The functions of the time alone, finite at all times, at whose zeros L (or H), and the energy with it, or a momentum of L as a
    /// function of the velocities has a step.
    pub fn steps_in_time(&self) -> Vec<Expr> {
        let mut steps = self.value_steps();
        steps.extend(self.momentum_steps());
        steps.sort_unstable();
        steps.dedup();
        steps
    }

    /// Returns whether the energy jumps at such zeros with L (or H), while the state is continuous.
    pub fn energy_jumps_in_time(&self) -> bool {
        !self.value_steps().is_empty() && !self.momenta_jump()
    }

    /// The functions among these at whose zeros L (or H) itself has a step. Where it has roots or poles in the time there are none: a
    /// motion that is begun anew there might begin at a singularity.
    fn value_steps(&self) -> Vec<Expr> {
        let (time, places) = ([self.symbols.time], self.places());
        let mut steps = self.signs_of(self.law, &time);
        // one with a kink may be zero for a while, and leave it where no sign changes
        steps.retain(|&e| {
            let is_of_time = !self.pool.depends_on_any(e, &places);
            is_of_time && !self.may_have_poles(e) && !self.pool.may_have_kink(e, &time)
        });
        if steps.is_empty() || self.is_singular_in_time() { Vec::new() } else { steps }
    }

    /// Whether L (or H) has a root, a power that is not whole, or a pole of the time alone.
    fn is_singular_in_time(&self) -> bool {
        let (time, places) = (self.symbols.time, self.places());
        let is_of_time =
            |e: Expr| self.pool.depends_on_any(e, &[time]) && !self.pool.depends_on_any(e, &places);
        self.pool.reachable(&[self.law]).into_iter().any(|e| match self.pool.node(e) {
            Node::Product(_, factors) => factors.iter().any(|&(base, n)| {
                is_of_time(base) && (n.is_negative() || n.as_integer().is_none())
            }),
            Node::Power(base, _) => is_of_time(*base),
            Node::Call(
                FunctionId::Asin
                | FunctionId::Acos
                | FunctionId::Ln
                | FunctionId::Tan
                | FunctionId::Cot,
                argument,
            ) => is_of_time(argument[0]),
            _ => false,
        })
    }

    /// Returns whether the energy jumps at a time with L (or H) that is not a zero of one of [these
    /// functions](Equations::steps_in_time): by how much depends on where the motion is, and the rate of the energy does not show it.
    pub fn energy_jumps_elsewhere_in_time(&self) -> bool {
        let places = self.places();
        let is_of_time = |e: &Expr| !self.pool.depends_on_any(*e, &places);
        let known = self.steps_in_time();
        let mut steps = self.steps_of(self.law, &[self.symbols.time]).into_iter();
        steps.any(|e| is_of_time(&e) && !known.contains(&e))
            || self.law_cuts().iter().any(is_of_time)
    }

    /// The symbols that move, but the time.
    fn places(&self) -> Vec<Symbol> {
        let time = self.symbols.time;
        self.moving().into_iter().filter(|s| *s != time).collect()
    }

    /// Returns whether a momentum of L, as a function of the velocities, jumps at a time. The momentum itself does not, so that the
    /// velocities do.
    pub fn momenta_jump(&self) -> bool {
        !self.momentum_steps().is_empty() || self.momenta_jump_at_poles()
    }

    /// The functions of the time alone, finite at all times, at whose zeros a momentum of L jumps, as a function of the velocities.
    pub fn momentum_steps(&self) -> Vec<Expr> {
        let mut steps = self.momentum_steps_by(|p, time| self.signs_of(p, &[time]));
        steps.retain(|&e| !self.may_have_poles(e));
        steps
    }

    /// Returns whether a momentum jumps at a pole of a function of the time, as that of sign(1/t) or arctan(1/t).
    pub fn momenta_jump_at_poles(&self) -> bool {
        let signs = self.momentum_steps_by(|p, time| self.signs_of(p, &[time]));
        signs.into_iter().any(|e| self.may_have_poles(e))
            || !self.momentum_steps_by(|p, time| self.saturated_poles(p, &[time])).is_empty()
    }

    /// Returns whether the rates of momenta, or of the variables, switch at zeros of these functions, too.
    pub fn momentum_rates_switch_at(&self, steps: &[Expr]) -> bool {
        let (Flow::Lagrange { momentum_rates: rates, .. }
        | Flow::Hamilton { momentum_rates: rates, .. }
        | Flow::Poisson { rates }) = &self.flow;
        self.pool.reachable(rates).into_iter().any(|e| match self.pool.node(e) {
            Node::Call(FunctionId::Sign | FunctionId::Abs, arguments) => {
                arguments.iter().any(|a| steps.contains(a))
            }
            _ => false,
        })
    }

    fn momentum_steps_by(&self, steps_of: impl Fn(Expr, Symbol) -> Vec<Expr>) -> Vec<Expr> {
        if !self.is_lagrangian() {
            return Vec::new();
        }
        let (time, others) = (self.symbols.time, self.places());
        let mut steps: Vec<Expr> = self.momenta.iter().flat_map(|&p| steps_of(p, time)).collect();
        steps.retain(|&e| !self.pool.depends_on_any(e, &others));
        steps.sort_unstable();
        steps.dedup();
        steps
    }

    /// Whether a function of the time may change its sign where it is infinite, which a logarithm does not.
    fn may_have_poles(&self, e: Expr) -> bool {
        let varies = |e: Expr| self.pool.depends_on_any(e, &[self.symbols.time]);
        self.pool.reachable(&[e]).into_iter().any(|part| match self.pool.node(part) {
            Node::Call(FunctionId::Tan | FunctionId::Cot, argument) => varies(argument[0]),
            _ => self.divisors(part).into_iter().any(|(divisor, _)| varies(divisor)),
        })
    }

    /// Whether a function jumps with the sign of something that depends on some symbols.
    fn has_sign_of(&self, function: Expr, symbols: &[Symbol]) -> bool {
        !self.steps_of(function, symbols).is_empty()
    }

    /// What depends on some symbols and where it is zero, or has a pole, a function jumps.
    fn steps_of(&self, function: Expr, symbols: &[Symbol]) -> Vec<Expr> {
        [self.signs_of(function, symbols), self.saturated_poles(function, symbols)].concat()
    }

    /// What depends on some symbols and with whose sign a function jumps.
    fn signs_of(&self, function: Expr, symbols: &[Symbol]) -> Vec<Expr> {
        let pool = &self.pool;
        let sign = |e: Expr| match pool.node(e) {
            Node::Call(FunctionId::Sign, argument) => {
                pool.depends_on_any(e, symbols).then_some(argument[0])
            }
            _ => None,
        };
        let moving = self.moving();
        let signs = |e: Expr| -> Vec<Expr> {
            let node = pool.node(e);
            let jumps = |argument: &Expr| match node {
                // u sign(c u) = ±|u|
                Node::Product(_, factors) => !has_factors_of(pool, factors, *argument, &moving),
                _ => true,
            };
            node.parts().into_iter().filter_map(sign).filter(jumps).collect()
        };
        // u/|u|, and odd powers of it
        let quotients = |e: Expr| -> Vec<Expr> {
            let Node::Product(_, factors) = pool.node(e) else { return Vec::new() };
            let size = |&(size, n): &(Expr, Number)| match (pool.node(size), n.as_integer()) {
                (Node::Call(FunctionId::Abs, argument), Some(n)) if n % 2 != 0 => {
                    let is_same = |&(base, m): &(Expr, Number)| {
                        m.as_integer() == Some(-n) && is_multiple(pool, base, argument[0])
                    };
                    let jumps = pool.depends_on_any(size, symbols) && factors.iter().any(is_same);
                    jumps.then_some(argument[0])
                }
                _ => None,
            };
            factors.iter().filter_map(size).collect()
        };
        let mut steps: Vec<Expr> = sign(function).into_iter().collect();
        for e in pool.reachable(&[function]) {
            steps.extend(signs(e));
            steps.extend(quotients(e));
        }
        let mut others = self.zeros_beside_kinks(function);
        others.retain(|e| !steps.contains(e));
        steps.extend(self.at_whose_zeros_it_jumps(function, symbols, others));
        steps
    }

    /// The divisors, and the tangents, that depend on some symbols, and at whose poles a function jumps since they are the arguments
    /// of what is bounded there, as in arctan(1/x), arctan(tan x) or 1/(1 + e^{1/x}).
    fn saturated_poles(&self, function: Expr, symbols: &[Symbol]) -> Vec<Expr> {
        let pool = &self.pool;
        let bounded = pool.reachable(&[function]).into_iter().flat_map(|e| match pool.node(e) {
            Node::Call(FunctionId::Atan | FunctionId::Tanh | FunctionId::Exp, argument) => {
                pool.reachable(argument)
            }
            _ => Vec::new(),
        });
        let poles: Vec<Expr> = bounded
            .flat_map(|part| match pool.node(part) {
                Node::Call(FunctionId::Tan | FunctionId::Cot, _) => vec![part],
                _ => self.divisors(part).into_iter().map(|(e, _)| e).collect(),
            })
            .collect();
        self.at_whose_zeros_it_jumps(function, symbols, poles)
    }

    fn at_whose_zeros_it_jumps(
        &self,
        function: Expr,
        symbols: &[Symbol],
        mut among: Vec<Expr>,
    ) -> Vec<Expr> {
        among.sort_unstable();
        among.dedup();
        let (pool, moving) = (&self.pool, self.moving());
        // a jump may be small beside the other terms, in whatever units
        let terms = match pool.node(function) {
            Node::Sum(_, terms) => terms.iter().map(|&(_, term)| term).collect(),
            _ => vec![function],
        };
        among.retain(|&e| {
            let own = |term: &&Expr| pool.reachable(&[**term]).contains(&e);
            pool.depends_on_any(e, symbols)
                && terms.iter().filter(own).any(|&term| pool.jumps_at_zeros(term, e, &moving))
        });
        among
    }

    /// What a function divides by, what is squared below its roots and what its kinks are at, if it has any kink: at a zero of these it
    /// may have a step, as √(u²)/u, (|u| + u)/u or e^{½ ln u²}/u at that of u. A quotient of smooth functions has a pole.
    fn zeros_beside_kinks(&self, function: Expr) -> Vec<Expr> {
        let pool = &self.pool;
        let moving = self.moving();
        let parts = pool.reachable(&[function]);
        let varies = |e: Expr| pool.depends_on_any(e, &moving);
        // an even power of u, alone or in a product
        let squared = |e: Expr| -> Vec<Expr> {
            let Node::Product(_, factors) = pool.node(e) else { return Vec::new() };
            let even = |n: Number| n.as_integer().is_some_and(|n| n % 2 == 0);
            factors.iter().filter(|(u, n)| even(*n) && varies(*u)).map(|&(u, _)| u).collect()
        };
        let is_kink = |e: &Expr| match pool.node(*e) {
            Node::Call(FunctionId::Abs | FunctionId::Max | FunctionId::Min, _) => varies(*e),
            Node::Call(FunctionId::Atan2, arguments) => arguments.iter().any(|&e| varies(e)),
            Node::Call(FunctionId::Ln, argument) => !squared(argument[0]).is_empty(),
            Node::Product(_, factors) => factors.iter().any(|&(base, n)| {
                let is_root = n.as_integer().is_none() && varies(base);
                is_root && (!squared(base).is_empty() || pool.touches_zero(base, &moving))
            }),
            _ => false,
        };
        if !parts.iter().any(is_kink) {
            return Vec::new();
        }
        let zeros = parts.iter().flat_map(|&e| match pool.node(e) {
            Node::Call(FunctionId::Abs, argument) => argument.to_vec(),
            // the cut of an angle that moves in a plane is none of them: see `law_cut`
            Node::Call(FunctionId::Atan2, arguments)
                if arguments.iter().any(|&e| !pool.depends_on_any(e, &moving)) =>
            {
                arguments.to_vec()
            }
            Node::Product(_, factors) => {
                let below =
                    factors.iter().filter(|(_, n)| n.is_negative() || n.as_integer().is_none());
                below.flat_map(|&(base, _)| [squared(base), vec![base]].concat()).collect()
            }
            _ => Vec::new(),
        });
        zeros.filter(|&e| !is_never_negative(pool, e)).collect()
    }

    /// Such an angle as [`Equations::law_cut`], if it depends on more than the time.
    pub fn law_cut_at_a_place(&self) -> Option<Expr> {
        let places = self.places();
        self.law_cuts().into_iter().find(|&angle| self.pool.depends_on_any(angle, &places))
    }

    /// An angle in L (or H), atan2(y, x), at whose cut, y = 0 and x < 0, that jumps. A parameter is taken for positive.
    pub fn law_cut(&self) -> Option<Expr> {
        self.law_cuts().first().copied()
    }

    /// All of them.
    fn law_cuts(&self) -> Vec<Expr> {
        let moving = self.moving();
        let is_cut = |e: &Expr| {
            let Node::Call(FunctionId::Atan2, arguments) = self.pool.node(*e) else { return false };
            let (y, x) = (arguments[0], arguments[1]);
            let may_be_negative = self.pool.depends_on_any(x, &moving)
                || matches!(self.pool.node(x), Node::Number(_));
            self.pool.depends_on_any(y, &moving)
                && may_be_negative
                && !is_never_negative(&self.pool, x)
        };
        let cuts: Vec<Expr> = self.pool.reachable(&[self.law]).into_iter().filter(is_cut).collect();
        if cuts.is_empty() {
            return Vec::new();
        }
        let mut pool = self.pool.clone();
        let jumps = |angle: &Expr| {
            let angle = *angle;
            let Node::Call(_, arguments) = pool.node(angle) else { return false };
            let y = arguments[0];
            // an angle that has one sign comes to its cut from one side only
            if keeps_its_sign(&mut pool, y) {
                return false;
            }
            let jump = pool.jump_of_angle(self.law, angle);
            let vanishes_with = match pool.node(jump) {
                Node::Product(_, factors) => has_factors_of(&pool, factors, y, &moving),
                _ => is_multiple(&pool, jump, y),
            };
            !vanishes_with && !matches!(pool.is_zero(jump), Zero::Proved | Zero::Numerically)
        };
        cuts.into_iter().filter(jumps).collect()
    }
}
