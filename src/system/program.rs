//! The flat program that expressions are lowered to: a list of operations, each writing one
//! register and reading earlier ones only. Two evaluators run it: [`Evaluator`](super::Values) and
//! [`Jet`](super::Jet).

use std::sync::Arc;

use super::lower::Lowering;
use crate::expr::{Expr, FunctionId, Pool, Symbol};
use crate::num::DoubleDouble;

/// The place of a number in a program: the operation that writes it.
pub(super) type Register = u32;

/// How many squares an integer power with a live exponent may take: exponents up to 63.
pub(super) const LIVE_POWER_BITS: usize = 6;

/// One operation. It writes the register it stands at.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Op {
    /// A number of the table of constants.
    Constant(u32),
    /// A parameter.
    Parameter(u32),
    /// The time.
    Time,
    /// A number that whoever evaluates gives.
    Input(u32),
    /// `constant + Σ coefficient · register`, over a range of the table of terms.
    Linear { constant: u32, first: u32, count: u32 },
    /// A product whose first factor depends on parameters only.
    Scale(Register, Register),
    /// A product.
    Multiply(Register, Register),
    /// A square.
    Square(Register),
    /// A quotient.
    Divide(Register, Register),
    /// A square root.
    Root(Register),
    /// A power with an exponent from the table of constants.
    Power(Register, u32),
    /// A power whose exponent depends on parameters only; squares and partial products for an
    /// exponent that happens to be an integer stand in the registers behind it.
    ParametricPower(Register, Register),
    /// A function of one or two arguments; its companion stands in the register behind it.
    Call(FunctionId, [Register; 2]),
    /// One of two branches, by the sign of a switch.
    Select { switch: Register, mode: Option<u32>, positive: Register, negative: Register },
    /// The solution of a block of linear equations; as many registers as it has rows.
    Solve(u32),
    /// Written by an operation before it.
    Written,
}

/// One summand of a [`Op::Linear`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Term {
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
    /// Which inputs M depends on: what to name where it turns out singular.
    pub(super) inputs: Vec<usize>,
}

/// A function of which a series follows one branch, and leaves the branch that is meant where its
/// root passes zero: roots, fractional powers, inverse sines and cosines.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guard {
    /// What is positive on the branch meant.
    pub(super) value: Register,
    /// What stands under the root.
    pub(super) under: Option<Register>,
    /// Whether the value itself passes zero where the branch is left.
    pub(super) passes: bool,
}

impl Block {
    pub(super) fn size(&self) -> usize {
        self.right.len()
    }
}

/// A compiled list of expressions. Immutable; evaluators share it and hold their own registers.
#[derive(Clone, Debug, Default)]
pub struct Program {
    pub(super) ops: Vec<Op>,
    pub(super) constants: Vec<DoubleDouble>,
    pub(super) terms: Vec<Term>,
    pub(super) blocks: Vec<Block>,
    /// The registers that depend on constants and parameters only.
    pub(super) fixed: Vec<bool>,
    /// The operations that do, in order: evaluated when parameters change.
    pub(super) prologue: Vec<Register>,
    /// The operations that depend on time or inputs, in order.
    pub(super) body: Vec<Register>,
    /// The switching surfaces, one register each.
    pub(super) switches: Vec<Register>,
    /// The functions whose branch is to be watched.
    pub(super) guards: Vec<Guard>,
    pub(super) inputs: Vec<Register>,
    pub(super) outputs: Vec<Register>,
}

/// A matrix met on the way is singular.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Singular {
    /// Which block of equations.
    pub(super) block: u32,
}

impl Program {
    /// Compiles expressions of a pool, as functions of parameters, time and inputs.
    ///
    /// # Errors
    /// The first symbol that is none of these.
    pub fn compile(
        pool: &mut Pool,
        parameters: &[Symbol],
        time: Symbol,
        inputs: &[Symbol],
        outputs: &[Expr],
    ) -> Result<Arc<Program>, Symbol> {
        let mut lowering = Lowering::new(pool, parameters, time);
        for &symbol in inputs {
            let register = lowering.input();
            lowering.bind(symbol, register);
        }
        let outputs = lowering.lower_all(outputs);
        lowering.finish(outputs)
    }

    /// How many numbers it computes.
    pub fn outputs(&self) -> usize {
        self.outputs.len()
    }

    /// How many inputs it reads.
    pub fn inputs(&self) -> usize {
        self.inputs.len()
    }

    /// How many switching surfaces it has.
    pub fn switches(&self) -> usize {
        self.switches.len()
    }

    /// The input that a switch is, if it is one.
    pub fn switch_input(&self, switch: usize) -> Option<usize> {
        self.inputs.iter().position(|&r| r == self.switches[switch])
    }

    /// How many operations it takes.
    pub fn len(&self) -> usize {
        self.ops.len()
    }

    /// How many of these have to be done anew at every time; the others wait for a change of a
    /// parameter.
    pub fn live_len(&self) -> usize {
        self.body.iter().filter(|&&r| self.ops[r as usize] != Op::Time).count()
    }

    /// Whether any output depends on the time.
    pub(super) fn depends_on_time(&self) -> bool {
        let mut timed = vec![false; self.ops.len()];
        for r in 0..self.ops.len() {
            let on = |list: &[Register]| list.iter().any(|&r| timed[r as usize]);
            timed[r] = match self.ops[r] {
                Op::Time => true,
                Op::Constant(_) | Op::Parameter(_) | Op::Input(_) => false,
                Op::Linear { first, count, .. } => self.terms
                    [first as usize..(first + count) as usize]
                    .iter()
                    .any(|term| timed[term.register as usize]),
                Op::Scale(a, b)
                | Op::Multiply(a, b)
                | Op::Divide(a, b)
                | Op::ParametricPower(a, b) => on(&[a, b]),
                Op::Square(a) | Op::Root(a) | Op::Power(a, _) => on(&[a]),
                Op::Call(_, arguments) => on(&arguments),
                Op::Select { switch, positive, negative, .. } => on(&[switch, positive, negative]),
                Op::Solve(block) => {
                    let block = &self.blocks[block as usize];
                    on(&block.matrix) || on(&block.right)
                }
                Op::Written => timed[r - 1],
            };
        }
        self.outputs.iter().any(|&r| timed[r as usize])
    }

    /// Whether it computes nothing.
    pub fn is_empty(&self) -> bool {
        self.ops.is_empty()
    }

    /// The inputs a singular matrix depends on.
    pub fn inputs_of(&self, singular: Singular) -> &[usize] {
        &self.blocks[singular.block as usize].inputs
    }
}
