//! The second evaluator of a program: normalised Taylor coefficients in time, order by order.
//!
//! The caller sets the coefficients of order k of the inputs (and of the time), evaluates order k,
//! and reads the outputs of order k, from which the inputs of order k + 1 follow. A register that
//! depends on parameters only stays zero above order 0.
//!
//! Rules: À. Jorba, M. Zou, Experimental Mathematics 14 (2005) 99, section 2.

use std::sync::Arc;

use super::program::{LIVE_POWER_BITS, Op, Program, Register, Singular};
use super::solve::Factored;
use crate::expr::{FunctionId, Rule};
use crate::num::{DoubleDouble, Real};

/// The branch that functions with a kink take while a series is built.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Side {
    /// The branch where the switch is positive.
    Positive,
    /// The branch where the switch is negative.
    Negative,
    /// Between the branches: their mean, plus half their difference times a weight in [−1, 1] that
    /// keeps the switch at zero.
    Between,
}

/// The registers of one program as power series, in one precision.
#[derive(Clone, Debug)]
pub struct Jet<R> {
    program: Arc<Program>,
    stride: usize,
    coefficients: Vec<R>,
    blocks: Vec<Factored<R>>,
    right: Vec<R>,
    sides: Vec<Side>,
    /// The weights of the sides [`Side::Between`], one series for each switch.
    weights: Vec<R>,
}

impl<R: Real> Jet<R> {
    /// Allocates registers for a program, up to an order. The parameters must be set before it is
    /// evaluated.
    pub fn new(program: Arc<Program>, order: usize) -> Jet<R> {
        let stride = order + 1;
        let blocks: Vec<_> = program.blocks.iter().map(|b| Factored::new(b.size())).collect();
        let widest = program.blocks.iter().map(super::program::Block::size).max().unwrap_or(0);
        Jet {
            stride,
            coefficients: vec![R::ZERO; program.ops.len() * stride],
            blocks,
            right: vec![R::ZERO; widest],
            sides: vec![Side::Positive; program.switches.len()],
            weights: vec![R::ZERO; program.switches.len() * stride],
            program,
        }
    }

    /// The highest order there is room for.
    pub fn order(&self) -> usize {
        self.stride - 1
    }

    /// Sets the parameters and evaluates everything that depends on them alone.
    pub fn set_parameters(&mut self, parameters: &[DoubleDouble]) {
        let program = Arc::clone(&self.program);
        for &r in &program.prologue {
            match program.ops[r as usize] {
                Op::Parameter(i) => {
                    self.coefficients[r as usize * self.stride] = R::of(parameters[i as usize]);
                }
                _ => self.run(&program, r, 0),
            }
        }
    }

    /// Sets a coefficient of an input.
    pub fn set_input(&mut self, input: usize, order: usize, coefficient: R) {
        let register = self.program.inputs[input] as usize;
        self.coefficients[register * self.stride + order] = coefficient;
    }

    /// Chooses the branch at a switch.
    pub fn set_side(&mut self, switch: usize, side: Side) {
        self.sides[switch] = side;
    }

    /// The branch taken at a switch.
    pub fn side(&self, switch: usize) -> Side {
        self.sides[switch]
    }

    /// The number of switches.
    pub fn switches(&self) -> usize {
        self.sides.len()
    }

    /// Sets a coefficient of the weight at a switch whose side is [`Side::Between`].
    pub fn set_weight(&mut self, switch: usize, order: usize, coefficient: R) {
        self.weights[switch * self.stride + order] = coefficient;
    }

    /// Evaluates all registers at order `k`, at a time that advances in units of `scale`. The lower
    /// orders must have been evaluated, and the inputs' coefficients of order `k` set.
    pub fn advance(&mut self, k: usize, time: R, scale: f64) -> Result<(), Singular> {
        let program = Arc::clone(&self.program);
        for &r in &program.body {
            match program.ops[r as usize] {
                Op::Time => {
                    let x = [time, R::ONE * scale, R::ZERO];
                    self.coefficients[r as usize * self.stride + k] = x[k.min(2)];
                }
                Op::Solve(block) => self.solve(&program, r, block, k)?,
                _ => self.run(&program, r, k),
            }
        }
        Ok(())
    }

    /// A coefficient of an output.
    pub fn output(&self, i: usize, order: usize) -> R {
        self.coefficients[self.program.outputs[i] as usize * self.stride + order]
    }

    /// The series of a switch.
    pub fn switch(&self, i: usize) -> &[R] {
        &self.coefficients[self.program.switches[i] as usize * self.stride..][..self.stride]
    }

    /// The series of the weight at a switch.
    pub fn weight(&self, i: usize) -> &[R] {
        &self.weights[i * self.stride..][..self.stride]
    }

    /// The series of the arguments of all functions that are not constant.
    pub fn arguments(&self) -> impl Iterator<Item = (FunctionId, &[R])> {
        self.program.body.iter().filter_map(|&r| match self.program.ops[r as usize] {
            Op::Call(function, [u, _]) => Some((function, self.series(u))),
            _ => None,
        })
    }

    /// The series of any register.
    pub(super) fn series(&self, register: Register) -> &[R] {
        &self.coefficients[register as usize * self.stride..][..self.stride]
    }

    /// Copies the orders below `orders` from a jet of the same program in another precision, and
    /// factors the matrices that it has factored.
    pub fn take_over<S: Real>(&mut self, other: &Jet<S>, orders: usize) -> Result<(), Singular> {
        self.copy(other, orders);
        let program = Arc::clone(&self.program);
        (0..program.blocks.len()).try_for_each(|block| self.factor(&program, block))
    }

    /// Copies the orders below `orders`, for reading only.
    pub fn copy<S: Real>(&mut self, other: &Jet<S>, orders: usize) {
        let program = Arc::clone(&self.program);
        for register in 0..program.ops.len() {
            if program.fixed[register] {
                continue;
            }
            for k in 0..orders {
                self.coefficients[register * self.stride + k] =
                    R::of(other.coefficients[register * other.stride + k].double());
            }
        }
        for switch in 0..program.switches.len() {
            self.sides[switch] = other.sides[switch];
            for k in 0..orders {
                self.weights[switch * self.stride + k] =
                    R::of(other.weights[switch * other.stride + k].double());
            }
        }
    }

    fn run(&mut self, program: &Program, register: Register, k: usize) {
        let (stride, at) = (self.stride, register as usize);
        let (below, own) = self.coefficients.split_at_mut(at * stride);
        let series = |r: Register| &below[r as usize * stride..][..stride];
        let constant = |c: u32| program.constants[c as usize];
        own[k] = match program.ops[at] {
            Op::Constant(c) => R::of(constant(c)),
            Op::Linear { constant: c, first, count } => {
                let terms = &program.terms[first as usize..(first + count) as usize];
                let start = if k == 0 { R::of(constant(c)) } else { R::ZERO };
                terms.iter().fold(start, |sum, term| {
                    sum + series(term.register)[k] * R::of(term.coefficient)
                })
            }
            Op::Scale(a, b) => series(a)[0] * series(b)[k],
            Op::Multiply(a, b) => product(series(a), series(b), k),
            Op::Square(a) => square(series(a), k),
            Op::Divide(a, b) => quotient(series(a)[k], series(b), own, k),
            Op::Root(a) => root(series(a), own, k),
            Op::Power(a, exponent) => power(series(a), constant(exponent), own, k),
            Op::ParametricPower(a, exponent) => {
                live_power(series(a), series(exponent)[0].double(), own, k, stride)
            }
            Op::Call(function, [a, b]) => {
                let Rule::Series(rule) = &function.row().rule else { return };
                let (y, w) = own.split_at_mut(stride);
                R::step_of(rule)(k, &[series(a), series(b)], y, &mut w[..stride]);
                return;
            }
            Op::Select { switch, mode, positive, negative } => {
                let (positive, negative) = (series(positive), series(negative));
                let side = match mode {
                    Some(mode) => self.sides[mode as usize],
                    None if series(switch)[0].value() > 0.0 => Side::Positive,
                    None if series(switch)[0].value() < 0.0 => Side::Negative,
                    None => Side::Between,
                };
                match side {
                    Side::Positive => positive[k],
                    Side::Negative => negative[k],
                    Side::Between => {
                        let weights = match mode {
                            Some(mode) => &self.weights[mode as usize * stride..][..stride],
                            None => &[],
                        };
                        let half = (0..=k).zip(weights).fold(R::ZERO, |sum, (j, &w)| {
                            sum + w * (positive[k - j] - negative[k - j])
                        });
                        (positive[k] + negative[k] + half) * 0.5
                    }
                }
            }
            Op::Parameter(_) | Op::Time | Op::Input(_) | Op::Solve(_) | Op::Written => return,
        };
    }

    fn factor(&mut self, program: &Program, at: usize) -> Result<(), Singular> {
        let (block, coefficients, stride) = (&program.blocks[at], &self.coefficients, self.stride);
        let n = block.size();
        let entry = |i, j| coefficients[block.matrix[i * n + j] as usize * stride];
        if self.blocks[at].factor(entry) { Ok(()) } else { Err(Singular { block: at as u32 }) }
    }

    /// `M_0 a_k = f_k − Σ_{j≥1} M_j a_{k−j}`.
    fn solve(
        &mut self,
        program: &Program,
        register: Register,
        at: u32,
        k: usize,
    ) -> Result<(), Singular> {
        if k == 0 {
            self.factor(program, at as usize)?;
        }
        let (block, stride) = (&program.blocks[at as usize], self.stride);
        let (below, own) = self.coefficients.split_at_mut(register as usize * stride);
        let n = block.size();
        for i in 0..n {
            let mut sum = below[block.right[i] as usize * stride + k];
            for j in 0..n {
                let entry = block.matrix[i * n + j];
                if !program.fixed[entry as usize] {
                    let m = &below[entry as usize * stride..][..stride];
                    let a = &own[j * stride..][..stride];
                    for l in 1..=k {
                        sum = sum - m[l] * a[k - l];
                    }
                }
            }
            self.right[i] = sum;
        }
        self.blocks[at as usize].solve(&mut self.right[..n]);
        for i in 0..n {
            own[i * stride + k] = self.right[i];
        }
        Ok(())
    }
}

/// `Σ_{j=0}^{k} a_j b_{k−j}`.
fn product<R: Real>(a: &[R], b: &[R], k: usize) -> R {
    (0..=k).fold(R::ZERO, |sum, j| sum + a[j] * b[k - j])
}

/// The same for `b = a`.
fn square<R: Real>(a: &[R], k: usize) -> R {
    let pairs = (0..k.div_ceil(2)).fold(R::ZERO, |sum, j| sum + a[j] * a[k - j]) * 2.0;
    if k.is_multiple_of(2) { pairs + a[k / 2] * a[k / 2] } else { pairs }
}

/// `y = a/b`: `y_k = (a_k − Σ_{j=1}^{k} b_j y_{k−j}) / b_0`.
fn quotient<R: Real>(a_k: R, b: &[R], y: &[R], k: usize) -> R {
    (1..=k).fold(a_k, |sum, j| sum - b[j] * y[k - j]) / b[0]
}

/// `y = √a`: `y_k = (a_k − Σ_{j=1}^{k−1} y_j y_{k−j}) / 2 y_0`.
fn root<R: Real>(a: &[R], y: &[R], k: usize) -> R {
    if k == 0 {
        return a[0].sqrt();
    }
    let rest = (1..k).fold(a[k], |sum, j| sum - y[j] * y[k - j]);
    if vanishes(a, k) { R::ZERO } else { rest / (y[0] * 2.0) }
}

/// `y = a^α`: `y_k = Σ_{j=0}^{k−1} (α (k − j) − j) a_{k−j} y_j / (k a_0)`.
fn power<R: Real>(a: &[R], exponent: DoubleDouble, y: &[R], k: usize) -> R {
    if k == 0 {
        return a[0].power(exponent);
    }
    if vanishes(a, k) && exponent.high > 0.0 {
        return R::ZERO;
    }
    let alpha = R::of(exponent);
    let sum = (0..k).fold(R::ZERO, |sum, j| {
        let factor = alpha * (k - j) as f64 - R::ONE * j as f64;
        sum + factor * a[k - j] * y[j]
    });
    sum / (a[0] * k as f64)
}

/// Whether a series is identically zero as far as it is known.
fn vanishes<R: Real>(a: &[R], k: usize) -> bool {
    a[..=k].iter().all(|c| c.value() == 0.0)
}

/// `y = a^n` with `n` known at run time. An integer power uses repeated squaring, which also works
/// at the zeros of `a`: the registers after `y` contain, for each bit of the exponent, the square
/// and the product of the factors so far.
fn live_power<R: Real>(
    a: &[R],
    exponent: DoubleDouble,
    own: &mut [R],
    k: usize,
    stride: usize,
) -> R {
    let n = exponent.high;
    if exponent.low != 0.0 || n.fract() != 0.0 || n.abs() >= f64::from(1 << LIVE_POWER_BITS) {
        return power(a, exponent, own, k);
    }
    let size = n.abs() as u32;
    let mut last: Option<usize> = None;
    for bit in 0..LIVE_POWER_BITS {
        let (squares, products) = (stride * (1 + 2 * bit), stride * (2 + 2 * bit));
        if size >> bit == 0 {
            break;
        }
        let squared = match bit {
            0 => a[k],
            _ => square(&own[squares - 2 * stride..][..stride], k),
        };
        own[squares + k] = squared;
        let this = &own[squares..][..stride];
        own[products + k] = match (size >> bit & 1, last) {
            (1, Some(last)) => product(this, &own[last..][..stride], k),
            (1, None) => this[k],
            (_, Some(last)) => own[last + k],
            (_, None) => continue,
        };
        last = Some(products);
    }
    let whole = match last {
        Some(last) => &own[last..][..stride],
        None => return if k == 0 { R::ONE } else { R::ZERO },
    };
    if n > 0.0 {
        whole[k]
    } else {
        let one = if k == 0 { R::ONE } else { R::ZERO };
        quotient(one, whole, own, k)
    }
}
