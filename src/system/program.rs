//! The flat program that expressions are lowered to: a list of operations, each of which writes one
//! register and reads earlier ones only. Two evaluators run it: [`Evaluator`](super::Evaluator) and
//! [`Jet`](super::Jet).

#[cfg(target_arch = "x86_64")]
use super::made_once::MadeOnce;
use crate::expr::FunctionId;
use crate::num::DoubleDouble;

/// The index of a number in a program, which is that of the operation that writes it.
pub(super) type Register = u32;

/// The number of squarings for an integer power with a live exponent: exponents up to 63.
pub(super) const PARAMETRIC_POWER_BITS: usize = 6;

/// One operation. It writes the register of its own index.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Op {
    /// A number from the table of constants.
    Constant(u32),
    Parameter(u32),
    Time,
    /// A number supplied by the caller of the evaluator.
    Input(u32),
    /// `constant + Σ coefficient · register`, over a range of the table of terms.
    Linear {
        constant: u32,
        first: u32,
        count: u32,
    },
    /// A product whose first factor depends on parameters only.
    Scale(Register, Register),
    Multiply(Register, Register),
    Square(Register),
    Divide(Register, Register),
    /// A square root.
    Root(Register),
    /// A power with an exponent from the table of constants.
    Power(Register, u32),
    /// A power whose exponent depends on parameters only. If the exponent happens to be an integer,
    /// the following registers contain squares and partial products.
    ParametricPower(Register, Register),
    /// A function of one or two arguments; the following register contains its companion.
    Call(FunctionId, [Register; 2]),
    /// One of two branches, selected by the sign of a switch.
    Select {
        switch: Register,
        mode: Option<u32>,
        positive: Register,
        negative: Register,
    },
    /// The solution of a block of linear equations, in as many registers as it has rows.
    Solve(u32),
    /// A register written by an operation before it.
    Written,
}

/// One summand of a [`Op::Linear`].
#[derive(Clone, Copy, Debug)]
pub(super) struct LinearTerm {
    pub(super) coefficient: DoubleDouble,
    pub(super) register: Register,
}

/// A block of linear equations `M x = f`.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// M, row by row.
    pub(super) matrix: Vec<Register>,
    /// f.
    pub(super) right: Vec<Register>,
    /// The inputs M depends on, reported if it is singular.
    pub(super) inputs: Vec<usize>,
}

/// A function of which a series follows only one branch, and leaves the intended one where its root
/// passes zero: roots, fractional powers, inverse sines and cosines.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guard {
    /// A value that is positive on the intended branch.
    pub(super) value: Register,
    /// The argument, where it is a root or a power that is not steep.
    pub(super) argument: Option<Register>,
    /// The argument of a root or power through whose zero a motion may continue.
    pub(super) under: Option<Register>,
    /// Whether the value itself passes zero where the branch is left.
    pub(super) passes: bool,
    /// The exponent of a power, where that depends on parameters.
    pub(super) exponent: Option<Register>,
}

/// The series of a power with a larger exponent may be far off before its argument comes near zero.
pub(super) const STEEPEST_FOLLOWED: f64 = 4.0;

impl Guard {
    /// Whether there are branches at the values of a program: a whole power has none.
    pub(super) fn has_branches(&self, value: impl Fn(Register) -> f64) -> bool {
        self.exponent.is_none_or(|exponent| value(exponent).fract() != 0.0)
    }

    /// The argument through whose zero a motion may continue, at the values of a program: not that of a whole power, or of one with a
    /// pole.
    pub(super) fn under(&self, value: impl Fn(Register) -> f64) -> Option<Register> {
        let has_pole = self.exponent.is_some_and(|exponent| value(exponent) <= -1.0);
        self.under.filter(|_| !has_pole && self.has_branches(value))
    }

    /// The argument of a root, or of a power that is not steep at the values of a program.
    pub(super) fn argument(&self, value: impl Fn(Register) -> f64) -> Option<Register> {
        let is_steep =
            self.exponent.is_some_and(|exponent| value(exponent).abs() > STEEPEST_FOLLOWED);
        self.argument.filter(|_| !is_steep)
    }
}

impl Block {
    pub(super) fn size(&self) -> usize {
        self.right.len()
    }
}

/// A compiled list of expressions. It is immutable; evaluators share it and own their registers.
#[derive(Clone, Debug, Default)]
pub struct Program {
    pub(super) ops: Vec<Op>,
    pub(super) constants: Vec<DoubleDouble>,
    pub(super) terms: Vec<LinearTerm>,
    pub(super) blocks: Vec<Block>,
    /// Which registers depend on constants and parameters only.
    pub(super) fixed: Vec<bool>,
    /// The operations that write these, in order, evaluated when parameters change.
    pub(super) prologue: Vec<Register>,
    /// The operations that depend on time or inputs, in order.
    pub(super) body: Vec<Register>,
    pub(super) switches: Vec<Register>,
    /// The functions whose branch must be checked.
    pub(super) guards: Vec<Guard>,
    /// Whether there is a power so high that a series may end before its first term.
    pub(super) steep: bool,
    /// The operations whose results may hide an overflow, where the numbers of a state are moderate.
    pub(super) hiding: Vec<Register>,
    pub(super) inputs: Vec<Register>,
    pub(super) outputs: Vec<Register>,
    /// What its values are computed by, where that is not the list of operations.
    #[cfg(target_arch = "x86_64")]
    pub(super) values: MadeOnce,
}

/// A matrix in the program is singular.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Singular {
    /// The index of the block of equations.
    pub(super) block: u32,
}

impl Program {
    /// The number of outputs.
    pub fn outputs(&self) -> usize {
        self.outputs.len()
    }

    /// The number of inputs.
    pub fn inputs(&self) -> usize {
        self.inputs.len()
    }

    /// The number of switching surfaces.
    pub fn switches(&self) -> usize {
        self.switches.len()
    }

    /// The input that a switch is equal to, if any.
    pub fn switch_input(&self, switch: usize) -> Option<usize> {
        self.inputs.iter().position(|&r| r == self.switches[switch])
    }

    /// The number of operations.
    pub fn len(&self) -> usize {
        self.ops.len()
    }

    /// The number of operations evaluated again at every time; the others are evaluated only when a
    /// parameter changes.
    pub fn live_len(&self) -> usize {
        self.body.iter().filter(|&&r| self.ops[r as usize] != Op::Time).count()
    }

    pub(super) fn depends_on_time(&self) -> bool {
        let mut timed = vec![false; self.ops.len()];
        for r in 0..self.ops.len() {
            let mut own = self.ops[r] == Op::Time;
            self.each_operand(r as Register, &mut |operand| own |= timed[operand as usize]);
            timed[r] = own;
        }
        self.outputs.iter().any(|&r| timed[r as usize])
    }

    /// The operations of the body that depend on an input, in order, but for the input itself.
    pub(super) fn body_of_input(&self, input: usize) -> Vec<Register> {
        let Some(&own) = self.inputs.get(input) else { return Vec::new() };
        let mut depends = vec![false; self.ops.len()];
        depends[own as usize] = true;
        for r in 0..self.ops.len() {
            let mut reads = depends[r];
            self.each_operand(r as Register, &mut |operand| reads |= depends[operand as usize]);
            depends[r] = reads;
        }
        self.body.iter().copied().filter(|&r| depends[r as usize] && r != own).collect()
    }

    /// Whether a switch depends on an input, and not on the time and the parameters alone.
    pub(super) fn has_switches_of_inputs(&self) -> bool {
        let mut of_inputs = vec![false; self.ops.len()];
        for r in 0..self.ops.len() {
            let mut own = matches!(self.ops[r], Op::Input(_));
            self.each_operand(r as Register, &mut |operand| own |= of_inputs[operand as usize]);
            of_inputs[r] = own;
        }
        self.switches.iter().any(|&r| of_inputs[r as usize])
    }

    /// Whether an output or a switch depends on each operation; the others need not be evaluated.
    pub(super) fn live(&self) -> Vec<bool> {
        let mut live = vec![false; self.ops.len()];
        self.outputs.iter().chain(&self.switches).for_each(|&r| live[r as usize] = true);
        for r in (0..self.ops.len()).rev() {
            if live[r] {
                self.each_operand(r as Register, &mut |operand| live[operand as usize] = true);
            }
        }
        live
    }

    /// Whether each input is read by an operation or is an output itself.
    pub(super) fn inputs_read(&self) -> Vec<bool> {
        let mut read = vec![false; self.ops.len()];
        for &r in self.body.iter().chain(&self.prologue) {
            self.each_operand(r, &mut |operand| read[operand as usize] = true);
        }
        self.outputs.iter().chain(&self.switches).for_each(|&r| read[r as usize] = true);
        self.inputs.iter().map(|&r| read[r as usize]).collect()
    }

    /// The degree of the outputs and switches as polynomials in the inputs and the time, if they are polynomials.
    pub(super) fn degree(&self) -> Option<usize> {
        let mut degrees: Vec<Option<usize>> = Vec::with_capacity(self.ops.len());
        for (op, &fixed) in self.ops.iter().zip(&self.fixed) {
            let of = |register: Register| degrees[register as usize];
            let degree = match *op {
                _ if fixed => Some(0),
                Op::Time | Op::Input(_) => Some(1),
                Op::Linear { first, count, .. } => {
                    let terms = &self.terms[first as usize..(first + count) as usize];
                    terms.iter().try_fold(0, |most, term| Some(of(term.register)?.max(most)))
                }
                Op::Scale(_, a) => of(a),
                Op::Multiply(a, b) => of(a).zip(of(b)).map(|(a, b)| a.saturating_add(b)),
                Op::Square(a) => of(a).map(|a| a.saturating_mul(2)),
                Op::Divide(a, b) if self.fixed[b as usize] => of(a),
                _ => None,
            };
            degrees.push(degree);
        }
        let all = self.outputs.iter().chain(&self.switches);
        all.copied().try_fold(0, |most, r| Some(degrees[r as usize]?.max(most)))
    }

    pub(super) fn outputs_as_inputs(&self) -> Option<Vec<usize>> {
        let input = |output: &Register| self.inputs.iter().position(|input| input == output);
        self.outputs.iter().map(input).collect()
    }

    /// Calls `visit` on each register that an operation reads.
    pub(super) fn each_operand(&self, register: Register, visit: &mut dyn FnMut(Register)) {
        let mut all = |list: &[Register]| list.iter().for_each(|&r| visit(r));
        match self.ops[register as usize] {
            Op::Time | Op::Constant(_) | Op::Parameter(_) | Op::Input(_) => {}
            Op::Linear { first, count, .. } => {
                let terms = &self.terms[first as usize..(first + count) as usize];
                for term in terms {
                    all(&[term.register]);
                }
            }
            Op::Scale(a, b) | Op::Multiply(a, b) | Op::Divide(a, b) | Op::ParametricPower(a, b) => {
                all(&[a, b]);
            }
            Op::Square(a) | Op::Root(a) | Op::Power(a, _) => all(&[a]),
            Op::Call(_, arguments) => all(&arguments),
            Op::Select { switch, positive, negative, .. } => all(&[switch, positive, negative]),
            Op::Solve(block) => {
                let block = &self.blocks[block as usize];
                all(&block.matrix);
                all(&block.right);
            }
            Op::Written => all(&[register - 1]),
        }
    }

    /// Whether it has no operations.
    pub fn is_empty(&self) -> bool {
        self.ops.is_empty()
    }

    /// The inputs a singular matrix depends on.
    pub fn inputs_of(&self, singular: Singular) -> &[usize] {
        &self.blocks[singular.block as usize].inputs
    }
}
