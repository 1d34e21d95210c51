//! The derivative of a program: tangent vectors carried through it operation by operation.
//!
//! In: a program with inputs x and outputs f. Out: one with inputs (x, δx₁ … δxₘ) and outputs
//! (f, δf₁ … δfₘ), δf = (∂f/∂x) δx, in which the operations of f are the same in the same order: f
//! has the same bits in both. Every evaluator runs it, so that numbers, series in time and the
//! stages of a method have derivatives alike. Never here: states, the time, steps.
//!
//! The rules are those of forward differentiation (A. Griewank, A. Walther, Evaluating Derivatives,
//! SIAM 2008, chapter 3). A function with a kink has the derivative of the branch that is taken.

mod append;

use std::sync::Arc;

use rustc_hash::FxHashMap;

use super::program::{Block, LinearTerm, Op, PARAMETRIC_POWER_BITS, Program, Register};
use crate::expr::FunctionId;
use crate::num::DoubleDouble;

/// Where the tangent vectors of a program stand.
#[derive(Clone, Copy, Debug)]
pub(super) struct TangentLayout {
    pub(super) count: usize,
    /// The number of leading inputs that vary; the others are constant in the derivative.
    pub(super) moving: usize,
    /// The index of the first input of the first tangent vector, after all others.
    pub(super) first: usize,
    /// The number of leading outputs that are differentiated.
    pub(super) outputs: usize,
    /// The number of last outputs that stay behind the derivatives.
    pub(super) last: usize,
}

impl Program {
    /// The same program with `count` tangent vectors: their components are inputs behind its own,
    /// vector by vector, and the derivatives of all outputs along them stand behind its own
    /// outputs.
    #[must_use]
    pub fn with_tangents(&self, count: usize) -> Arc<Program> {
        let (moving, outputs) = (self.inputs.len(), self.outputs.len());
        self.tangent(TangentLayout { count, moving, first: moving, outputs, last: 0 })
    }

    /// The same program with tangent vectors, laid out as required.
    pub(super) fn tangent(&self, layout: TangentLayout) -> Arc<Program> {
        let mut builder = Builder::new(self);
        while builder.program.inputs.len() < layout.first {
            builder.input();
        }
        let needed = self.needed(layout.outputs);
        let mut derivatives = Vec::with_capacity(layout.count * layout.outputs);
        for _ in 0..layout.count {
            let vector: Vec<Register> = (0..layout.moving).map(|_| builder.input()).collect();
            let delta = builder.along(self, &needed, &vector);
            for &output in &self.outputs[..layout.outputs] {
                let derivative = delta[output as usize];
                derivatives.push(derivative.unwrap_or_else(|| builder.constant(0.0)));
            }
        }
        let place = self.outputs.len() - layout.last;
        builder.program.outputs.splice(place..place, derivatives);
        Arc::new(builder.program)
    }

    /// The registers whose derivatives enter those of the first outputs.
    pub(super) fn needed(&self, outputs: usize) -> Vec<bool> {
        let mut needed = vec![false; self.ops.len()];
        for &output in &self.outputs[..outputs] {
            needed[output as usize] = true;
        }
        for r in (0..self.ops.len()).rev() {
            if !needed[r] {
                continue;
            }
            let mut mark = |register: Register| needed[register as usize] = true;
            match self.ops[r] {
                Op::Constant(_) | Op::Parameter(_) | Op::Time | Op::Input(_) => {}
                Op::Linear { first, count, .. } => {
                    let terms = &self.terms[first as usize..(first + count) as usize];
                    for term in terms {
                        mark(term.register);
                    }
                }
                Op::Scale(a, b) | Op::Multiply(a, b) | Op::Divide(a, b) => {
                    mark(a);
                    mark(b);
                }
                Op::Square(a) | Op::Root(a) | Op::Power(a, _) | Op::ParametricPower(a, _) => {
                    mark(a);
                }
                Op::Call(_, [a, b]) => {
                    mark(a);
                    mark(b);
                }
                Op::Select { positive, negative, .. } => {
                    mark(positive);
                    mark(negative);
                }
                Op::Solve(block) => {
                    let block = &self.blocks[block as usize];
                    block.matrix.iter().chain(&block.right).for_each(|&register| mark(register));
                }
                Op::Written => mark(r as Register - 1),
            }
        }
        needed
    }
}

struct Builder {
    program: Program,
    /// The operations appended, so that equal ones share a register.
    written: FxHashMap<Op, Register>,
    /// The derivative of a function by its argument, where it is a register of its own.
    slopes: FxHashMap<Register, Register>,
}

/// A derivative: the register of its value, or `None` if it is zero.
type Delta = Option<Register>;

impl Builder {
    fn new(program: &Program) -> Builder {
        Builder {
            program: program.clone(),
            written: FxHashMap::default(),
            slopes: FxHashMap::default(),
        }
    }

    /// The derivatives of all needed registers of `primal` along a vector.
    fn along(&mut self, primal: &Program, needed: &[bool], vector: &[Register]) -> Vec<Delta> {
        let mut delta: Vec<Delta> = vec![None; primal.ops.len()];
        for r in 0..primal.ops.len() {
            if !needed[r] || primal.fixed[r] {
                continue;
            }
            let register = r as Register;
            let d = |register: Register| delta[register as usize];
            match primal.ops[r] {
                Op::Input(i) => delta[r] = vector.get(i as usize).copied(),
                Op::Linear { first, count, .. } => {
                    let terms = &primal.terms[first as usize..(first + count) as usize];
                    let terms: Vec<LinearTerm> = terms
                        .iter()
                        .filter_map(|term| {
                            Some(LinearTerm { register: d(term.register)?, ..*term })
                        })
                        .collect();
                    delta[r] = self.sum(&terms);
                }
                Op::Scale(a, b) | Op::Multiply(a, b) => {
                    let (da, db) = (d(a), d(b));
                    let products = [self.product(b, da), self.product(a, db)];
                    delta[r] = self.combination(&[(1.0, products[0]), (1.0, products[1])]);
                }
                Op::Square(a) => {
                    let product = self.product(a, d(a));
                    delta[r] = self.combination(&[(2.0, product)]);
                }
                Op::Divide(a, b) => {
                    // δ(a/b) = (δa − (a/b) δb)/b
                    let (da, db) = (d(a), d(b));
                    let product = self.product(register, db);
                    let numerator = self.combination(&[(1.0, da), (-1.0, product)]);
                    delta[r] = self.quotient(numerator, b);
                }
                Op::Root(a) => {
                    let half = self.combination(&[(0.5, d(a))]);
                    delta[r] = self.quotient(half, register);
                }
                Op::Power(a, exponent) => {
                    let da = d(a);
                    delta[r] = self.power(primal, register, (a, exponent), da);
                }
                Op::ParametricPower(a, exponent) => {
                    let da = d(a);
                    delta[r] = self.parametric_power(register, (a, exponent), da);
                }
                Op::Call(function, [a, b]) => {
                    let (da, db) = (d(a), d(b));
                    let companion = register + 1;
                    delta[r] = self.call(function, register, (a, da), (b, db));
                    let sign = match function {
                        FunctionId::Sin => -1.0,
                        FunctionId::Sinh => 1.0,
                        _ => continue,
                    };
                    if needed[companion as usize] {
                        let product = self.product(register, da);
                        delta[companion as usize] = self.combination(&[(sign, product)]);
                    }
                }
                Op::Select { switch, mode, positive, negative } => {
                    let (on_one, on_other) = (d(positive), d(negative));
                    if on_one.is_some() || on_other.is_some() {
                        let positive = on_one.unwrap_or_else(|| self.constant(0.0));
                        let negative = on_other.unwrap_or_else(|| self.constant(0.0));
                        delta[r] = Some(self.push(Op::Select { switch, mode, positive, negative }));
                    }
                }
                Op::Solve(block) => {
                    self.solve(&primal.blocks[block as usize], register, &mut delta);
                }
                Op::Constant(_) | Op::Parameter(_) | Op::Time | Op::Written => {}
            }
        }
        delta
    }

    /// M δx = δf − δM x.
    fn solve(&mut self, block: &Block, register: Register, delta: &mut [Delta]) {
        let n = block.size();
        let mut right = Vec::with_capacity(n);
        for i in 0..n {
            let mut terms = vec![(1.0, delta[block.right[i] as usize])];
            for j in 0..n {
                let entry = delta[block.matrix[i * n + j] as usize];
                terms.push((-1.0, self.product(register + j as Register, entry)));
            }
            right.push(self.combination(&terms));
        }
        if right.iter().all(Option::is_none) {
            return;
        }
        let right: Vec<Register> =
            right.into_iter().map(|r| r.unwrap_or_else(|| self.constant(0.0))).collect();
        let own = Block { matrix: block.matrix.clone(), right, inputs: block.inputs.clone() };
        let first = self.push(Op::Solve(self.program.blocks.len() as u32));
        self.program.blocks.push(own);
        for j in 0..n {
            if j > 0 {
                self.push(Op::Written);
            }
            delta[register as usize + j] = Some(first + j as Register);
        }
    }

    /// δ(a^α) = α a^(α − 1) δa.
    fn power(
        &mut self,
        primal: &Program,
        register: Register,
        (a, exponent): (Register, u32),
        da: Delta,
    ) -> Delta {
        let da = da?;
        let exponent = primal.constants[exponent as usize];
        let less = self.slopes.get(&register).copied().unwrap_or_else(|| {
            let less = self.constant_index(exponent - DoubleDouble::ONE);
            self.push(Op::Power(a, less))
        });
        self.slopes.insert(register, less);
        let product = self.product(less, Some(da))?;
        self.sum(&[LinearTerm { coefficient: exponent, register: product }])
    }

    /// The same with an exponent that depends on parameters.
    fn parametric_power(
        &mut self,
        register: Register,
        (a, exponent): (Register, Register),
        da: Delta,
    ) -> Delta {
        let da = da?;
        let slope = self.slopes.get(&register).copied().unwrap_or_else(|| {
            let one = LinearTerm { coefficient: DoubleDouble::ONE, register: exponent };
            let opposite = LinearTerm { coefficient: -DoubleDouble::ONE, register: exponent };
            // the slope of a⁰ is 0 · a⁰ and not 0/a, so that it is zero where a is: at a zero of
            // its switch a Select is the mean of its branches, which is 0 here
            let switch = self.push(Op::Square(exponent));
            let positive = self.linear(-1.0, &[one]);
            let negative = self.linear(1.0, &[opposite]);
            let exponent_less = self.push(Op::Select { switch, mode: None, positive, negative });
            let less = self.push(Op::ParametricPower(a, exponent_less));
            for _ in 0..2 * PARAMETRIC_POWER_BITS {
                self.push(Op::Written);
            }
            self.push(Op::Scale(exponent, less))
        });
        self.slopes.insert(register, slope);
        self.product(slope, Some(da))
    }

    /// The derivative of a function, whose value is in `y` and its companion behind it.
    fn call(
        &mut self,
        function: FunctionId,
        y: Register,
        (u, du): (Register, Delta),
        (v, dv): (Register, Delta),
    ) -> Delta {
        let companion = y + 1;
        match function {
            FunctionId::Sin | FunctionId::Sinh => self.product(companion, du),
            FunctionId::Exp => self.product(y, du),
            FunctionId::Ln => self.quotient(du, u),
            FunctionId::Asin => self.quotient(du, companion),
            FunctionId::Acos => {
                let opposite = self.combination(&[(-1.0, du)]);
                self.quotient(opposite, companion)
            }
            FunctionId::Tan => self.by_square(y, du, 1.0, 1.0),
            FunctionId::Cot => self.by_square(y, du, -1.0, -1.0),
            FunctionId::Tanh => self.by_square(y, du, 1.0, -1.0),
            FunctionId::Atan => {
                du?;
                let denominator = self.slope(y, |builder| builder.one_and_square(u, 1.0, 1.0));
                self.quotient(du, denominator)
            }
            FunctionId::Atan2 => {
                // of (y, x): (x δy − y δx)/(x² + y²)
                let products = [self.product(v, du), self.product(u, dv)];
                let numerator = self.combination(&[(1.0, products[0]), (-1.0, products[1])]);
                numerator?;
                let denominator = self.slope(y, |builder| {
                    let squares = [u, v].map(|r| builder.push(Op::Square(r)));
                    let one = DoubleDouble::ONE;
                    let terms = squares.map(|register| LinearTerm { coefficient: one, register });
                    builder.linear(0.0, &terms)
                });
                self.quotient(numerator, denominator)
            }
            // pairs are led by their first, the others are powers or branches
            FunctionId::Cos
            | FunctionId::Cosh
            | FunctionId::Sqrt
            | FunctionId::Abs
            | FunctionId::Sign
            | FunctionId::Min
            | FunctionId::Max => None,
        }
    }

    /// (constant + coefficient y²) δu.
    fn by_square(&mut self, y: Register, du: Delta, constant: f64, coefficient: f64) -> Delta {
        du?;
        let slope = self.slope(y, |builder| builder.one_and_square(y, constant, coefficient));
        self.product(slope, du)
    }

    fn one_and_square(&mut self, r: Register, constant: f64, coefficient: f64) -> Register {
        let square = self.push(Op::Square(r));
        let coefficient = DoubleDouble::from(coefficient);
        self.linear(constant, &[LinearTerm { coefficient, register: square }])
    }

    /// The register of a derivative, made once.
    fn slope(&mut self, y: Register, make: impl FnOnce(&mut Builder) -> Register) -> Register {
        if let Some(&slope) = self.slopes.get(&y) {
            return slope;
        }
        let slope = make(self);
        self.slopes.insert(y, slope);
        slope
    }
}
