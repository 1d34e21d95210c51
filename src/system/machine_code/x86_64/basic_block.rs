//! A basic block: arithmetic in a straight line, before its numbers have registers.
//!
//! In: operations on numbers that were made before or lie in memory. Out: the instructions in their order, each of which
//! makes at most one number; long inner products are one of them, which is a call. Never here: registers, bytes, what is computed.
//!
//! An [`Operand`] in memory is read where it is used: it must not have been overwritten by then.

use super::layout::Address;

/// A number that an instruction makes, or several side by side.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct VirtualRegister(pub(super) u32);

/// What an instruction reads.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Operand {
    Made(VirtualRegister),
    At(Address),
}

impl From<VirtualRegister> for Operand {
    fn from(value: VirtualRegister) -> Operand {
        Operand::Made(value)
    }
}

/// How many numbers lie side by side.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Width {
    One,
    Two,
    Four,
    Eight,
}

impl Width {
    pub(super) fn numbers(self) -> usize {
        match self {
            Width::One => 1,
            Width::Two => 2,
            Width::Four => 4,
            Width::Eight => 8,
        }
    }
}

/// An operation on each lane.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Operation {
    Add,
    Subtract,
    Multiply,
    Divide,
    /// The square root of the right operand, of one number.
    Root,
    /// Exclusive or of the bits.
    Xor,
    /// The first number of each operand, side by side.
    Pair,
    /// Two and two side by side.
    Join,
    /// The second number of each operand, side by side.
    Odd,
    /// The upper two of four.
    Upper,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum MachineInstruction {
    Zero {
        width: Width,
        made: VirtualRegister,
    },
    Load {
        width: Width,
        from: Address,
        made: VirtualRegister,
    },
    /// Loads the number at `from` and as many bytes on as the integer at `offset` says.
    LoadBehind {
        from: Address,
        offset: Address,
        made: VirtualRegister,
    },
    Binary {
        operation: Operation,
        width: Width,
        left: VirtualRegister,
        right: Operand,
        made: VirtualRegister,
    },
    /// `left · right − product` with one rounding.
    ProductError {
        width: Width,
        left: VirtualRegister,
        right: VirtualRegister,
        product: VirtualRegister,
        made: VirtualRegister,
    },
    /// `stays` says that nothing else is written there.
    Store {
        width: Width,
        value: VirtualRegister,
        to: Address,
        stays: bool,
    },
    InnerProducts {
        products: InnerProductOperands,
        made: VirtualRegister,
    },
}

/// Inner products `Σ a_j b_j` of several lanes. Four sums are kept apart.
#[derive(Clone, Copy, Debug)]
pub(super) struct InnerProductOperands {
    pub(super) width: Width,
    /// The first operands.
    pub(super) left: Address,
    pub(super) right: Address,
    /// The number of `f64` from one operand to the next.
    pub(super) distance: usize,
    pub(super) terms: usize,
}

impl MachineInstruction {
    /// The made numbers that it reads.
    pub(super) fn reads(&self) -> [Option<VirtualRegister>; 3] {
        match *self {
            MachineInstruction::Zero { .. }
            | MachineInstruction::Load { .. }
            | MachineInstruction::LoadBehind { .. }
            | MachineInstruction::InnerProducts { .. } => [None; 3],
            MachineInstruction::Binary { left, right, .. } => match right {
                Operand::Made(right) => [Some(left), Some(right), None],
                Operand::At(_) => [Some(left), None, None],
            },
            MachineInstruction::ProductError { left, right, product, .. } => {
                [Some(left), Some(right), Some(product)]
            }
            MachineInstruction::Store { value, .. } => [Some(value), None, None],
        }
    }
}

/// The instructions so far.
#[derive(Debug, Default)]
pub(super) struct BasicBlock {
    pub(super) instructions: Vec<MachineInstruction>,
    /// The number of values that were made.
    pub(super) values: u32,
}

impl BasicBlock {
    fn next(&mut self) -> VirtualRegister {
        self.values += 1;
        VirtualRegister(self.values - 1)
    }

    fn push(
        &mut self,
        instruction: impl FnOnce(VirtualRegister) -> MachineInstruction,
    ) -> VirtualRegister {
        let made = self.next();
        self.instructions.push(instruction(made));
        made
    }

    pub(super) fn zero(&mut self, width: Width) -> VirtualRegister {
        self.push(|made| MachineInstruction::Zero { width, made })
    }

    pub(super) fn load(&mut self, width: Width, from: Address) -> VirtualRegister {
        self.push(|made| MachineInstruction::Load { width, from, made })
    }

    /// The number so many bytes behind an address.
    pub(super) fn load_behind(&mut self, from: Address, offset: Address) -> VirtualRegister {
        self.push(|made| MachineInstruction::LoadBehind { from, offset, made })
    }

    /// An operand, loaded where it lies in memory.
    pub(super) fn made(&mut self, width: Width, operand: Operand) -> VirtualRegister {
        match operand {
            Operand::Made(value) => value,
            Operand::At(from) => self.load(width, from),
        }
    }

    pub(super) fn binary(
        &mut self,
        operation: Operation,
        width: Width,
        left: Operand,
        right: Operand,
    ) -> VirtualRegister {
        let commutes = matches!(operation, Operation::Add | Operation::Multiply);
        let (left, right) = match (left, right) {
            (Operand::At(_), Operand::Made(_)) if commutes => (right, left),
            _ => (left, right),
        };
        let left = self.made(width, left);
        self.push(|made| MachineInstruction::Binary { operation, width, left, right, made })
    }

    pub(super) fn product_error(
        &mut self,
        width: Width,
        (left, right): (VirtualRegister, VirtualRegister),
        product: VirtualRegister,
    ) -> VirtualRegister {
        self.push(|made| MachineInstruction::ProductError { width, left, right, product, made })
    }

    /// Stores an operand where nothing else is written, or where it is overwritten later.
    pub(super) fn store(&mut self, width: Width, operand: Operand, to: Address, stays: bool) {
        let value = self.made(width, operand);
        self.instructions.push(MachineInstruction::Store { width, value, to, stays });
    }
}

impl BasicBlock {
    pub(super) fn inner_products(&mut self, products: InnerProductOperands) -> VirtualRegister {
        self.push(|made| MachineInstruction::InnerProducts { products, made })
    }
}

impl MachineInstruction {
    /// The memory that it reads or writes, but for what lies behind an offset that is read: where, and how many `f64`.
    pub(super) fn memory(&self) -> [Option<(Address, usize)>; 2] {
        match *self {
            MachineInstruction::Load { width, from, .. } => [Some((from, width.numbers())), None],
            MachineInstruction::LoadBehind { from, offset, .. } => {
                [Some((from, 1)), Some((offset, 1))]
            }
            MachineInstruction::Binary { operation, width, right: Operand::At(from), .. } => {
                // of a pair one number is read
                let count = if operation == Operation::Pair { 1 } else { width.numbers() };
                [Some((from, count)), None]
            }
            MachineInstruction::Store { width, to, .. } => [Some((to, width.numbers())), None],
            MachineInstruction::InnerProducts { products, .. } => {
                let InnerProductOperands { width, left, right, distance, terms } = products;
                let count = terms.saturating_sub(1) * distance + width.numbers();
                [Some((left, count)), Some((right, count))]
            }
            MachineInstruction::Zero { .. }
            | MachineInstruction::Binary { .. }
            | MachineInstruction::ProductError { .. } => [None; 2],
        }
    }
}
