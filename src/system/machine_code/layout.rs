//! Where the numbers of compiled series lie.
//!
//! In: a program, its schedule, the orders. Out: an address for every number that the code reads or writes. Never here:
//! code.
//!
//! ```text
//!   values   order 0 of all registers, from the jet
//!   state    the series of the numbers of the state ┐ one after another, the orders of each side by side
//!   series   those that are read whole              ┘
//!   work     1, 2, …, constants, factored matrices, series of left operands, and of right operands from their ends:
//!
//!              left   a_0  a_1  …  a_{k−1}  …        right   …  b_{k−1}  …  b_1  b_0
//! ```

use crate::system::jet::JetPlan;
use crate::system::program::Register;

/// A stretch of memory that the code is given.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Area {
    Values,
    Work,
    Series,
    State,
}

/// The place of a number, counted in numbers.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Address {
    pub(super) area: Area,
    pub(super) offset: usize,
}

impl Address {
    /// The place so many numbers on.
    pub(super) fn plus(self, count: usize) -> Address {
        Address { offset: self.offset + count, ..self }
    }
}

/// A factored matrix: its rows in the order of the pivots, the row of each pivot, room for a right-hand side.
#[derive(Clone, Copy, Debug)]
pub(super) struct FactoredPlace {
    pub(super) size: usize,
    pub(super) entries: usize,
    pub(super) rows: usize,
    pub(super) right: usize,
}

/// All places.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    /// The number of orders.
    pub(super) stride: usize,
    /// The number of registers and slopes.
    pub(super) values: usize,
    /// The lengths of the stretches.
    pub(super) work: usize,
    pub(super) series: usize,
    pub(super) state: usize,
    /// The numbers that stay as they are, after 0, 1, 2, ….
    pub(super) constants: Vec<f64>,
    pub(super) factored: Vec<FactoredPlace>,
    /// Where the series of each register or slope begins as a left operand.
    pub(super) left: Vec<Option<Address>>,
    /// The same as a right operand, from its end.
    pub(super) right: Vec<Option<Address>>,
    /// Where that of each register begins that is read whole.
    pub(super) whole: Vec<Option<Address>>,
    /// The registers whose series would be compared with zero: the code takes it that their values are not zero.
    pub(super) vanishing: Vec<Register>,
}

impl Layout {
    /// For a state of so many numbers. The series of the first of them are those of the inputs.
    pub(super) fn of(plan: &JetPlan<'_>, numbers: usize) -> Layout {
        let (program, stride) = (plan.program, plan.stride);
        let operands = program.ops.len() + plan.schedule.slopes.len();
        let mut whole = vec![None; program.ops.len()];
        for &(register, place) in plan.copies {
            let offset = place as usize * stride;
            whole[register as usize] = Some(Address { area: Area::Series, offset });
        }
        let mut layout = Layout {
            stride,
            values: operands,
            work: stride,
            series: plan.series,
            state: numbers * stride,
            constants: Vec::new(),
            factored: Vec::new(),
            left: vec![None; operands],
            right: vec![None; operands],
            whole,
            vanishing: plan.schedule.relations.iter().filter_map(|r| r.vanishing).collect(),
        };
        for block in &program.blocks {
            let size = block.size();
            let entries = layout.room(size * size);
            let (rows, right) = (layout.room(size), layout.room(size));
            layout.factored.push(FactoredPlace { size, entries, rows, right });
        }
        for (i, &input) in program.inputs.iter().enumerate() {
            layout.left[input as usize] = Some(Address { area: Area::State, offset: i * stride });
        }
        for pair in &plan.schedule.pairs {
            if layout.left[pair.left as usize].is_none() {
                let offset = layout.room(stride);
                layout.left[pair.left as usize] = Some(Address { area: Area::Work, offset });
            }
            if layout.right[pair.right as usize].is_none() {
                let offset = layout.room(stride);
                layout.right[pair.right as usize] = Some(Address { area: Area::Work, offset });
            }
        }
        layout
    }

    /// The length of a stretch.
    pub(super) fn length(&self, area: Area) -> usize {
        match area {
            Area::Values => self.values,
            Area::Work => self.work + self.constants.len(),
            Area::Series => self.series,
            Area::State => self.state,
        }
    }

    fn room(&mut self, count: usize) -> usize {
        let first = self.work;
        self.work += count;
        first
    }

    /// Where a number lies that stays as it is.
    pub(super) fn constant(&mut self, number: f64) -> Address {
        let known = self.constants.iter().position(|x| x.to_bits() == number.to_bits());
        let place = known.unwrap_or_else(|| {
            self.constants.push(number);
            self.constants.len() - 1
        });
        // behind everything else
        Address { area: Area::Work, offset: self.work + place }
    }

    /// Where the integer of an order lies.
    pub(super) fn order(k: usize) -> Address {
        Address { area: Area::Work, offset: k }
    }

    /// The places to which the coefficient of order `k` of a register is written.
    pub(super) fn copies(&self, register: Register, k: usize) -> impl Iterator<Item = Address> {
        let whole = self.whole[register as usize].map(|address| address.plus(k));
        self.operands(register as usize, k).chain(whole)
    }

    /// Those of a register or a slope as an operand of inner products, which are in the stretch of work.
    pub(super) fn operands(&self, place: usize, k: usize) -> impl Iterator<Item = Address> {
        let left = self.left[place].filter(|address| address.area == Area::Work);
        let right = self.right[place].map(|address| address.plus(self.stride - 1 - k));
        left.map(|address| address.plus(k)).into_iter().chain(right)
    }

    /// The stretch of work as it is at first.
    pub(super) fn first_work(&self) -> Vec<f64> {
        let orders = (0..self.stride).map(|k| k as f64);
        let room = std::iter::repeat_n(0.0, self.work - self.stride);
        orders.chain(room).chain(self.constants.iter().copied()).collect()
    }
}
