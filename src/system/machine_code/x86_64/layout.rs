//! Where the numbers of compiled series lie.
//!
//! In: a program, its schedule, the orders. Out: an address for every number that the code reads or writes. Never here:
//! code.
//!
//! ```text
//!   values   order 0 of all registers, from a jet
//!   state    the series of the numbers of the state ┐ one after another, the orders of each side by side;
//!   series   those that are read whole              ┘ exact ones apart
//!   work     the units of time, values in `f64` beside exact ones, factored matrices, operands of inner products, four series side by side, right ones from
//!            their ends; constants; what finds no register
//!
//!              left   a_0 c_0 e_0 g_0  a_1 c_1 …        right   …  b_1 d_1 f_1 h_1  b_0 d_0 f_0 h_0
//! ```

use rustc_hash::FxHashMap;

use crate::system::jet::JetPlan;

/// The size of a cache line, which a group of operands must not cross.
pub(super) const LINE: usize = 8;

/// A stretch of memory that the code is given.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Area {
    Values,
    Work,
    Series,
    State,
    ExactSeries,
    ExactState,
}

/// The place of a number, counted in `f64`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Address {
    pub(super) area: Area,
    pub(super) offset: usize,
}

impl Address {
    /// The place so many `f64` on.
    pub(super) fn plus(self, count: usize) -> Address {
        Address { offset: self.offset + count, ..self }
    }
}

/// A factored matrix: its rows in the order of the pivots, what is right of the pivots over these, the row of each pivot, room for a
/// right-hand side.
#[derive(Clone, Copy, Debug)]
pub(super) struct FactoredPlace {
    pub(super) size: usize,
    pub(super) entries: usize,
    pub(super) upper: usize,
    pub(super) rows: usize,
    pub(super) right: usize,
}

#[derive(Clone, Debug)]
pub(super) struct SeriesPlaces {
    /// The number of `f64` of a number.
    pub(super) size: usize,
    /// The number of inner products side by side.
    side: usize,
    /// The number of orders.
    pub(super) stride: usize,
    /// Where order 0 of all registers begins.
    pub(super) values: Address,
    series: Area,
    state: Area,
    pub(super) factored: Vec<FactoredPlace>,
    /// Where the groups of left and right operands begin in the stretch of work, and the products of an order.
    left: usize,
    right: usize,
    products: usize,
}

impl SeriesPlaces {
    pub(super) fn value(&self, register: usize) -> Address {
        self.values.plus(register * self.size)
    }

    pub(super) fn of_state(&self, number: usize, k: usize) -> Address {
        Address { area: self.state, offset: (number * self.stride + k) * self.size }
    }

    /// A coefficient of a series that is read whole.
    pub(super) fn of_series(&self, place: usize, k: usize) -> Address {
        Address { area: self.series, offset: (place * self.stride + k) * self.size }
    }

    /// Order `k` of the left operands of a group.
    pub(super) fn left(&self, group: usize, k: usize) -> Address {
        self.group(self.left, group, k)
    }

    /// Order `k` of the right operands of a group, which are followed by the orders below.
    pub(super) fn right(&self, group: usize, k: usize) -> Address {
        self.group(self.right, group, self.stride - 1 - k)
    }

    /// The inner products of a group at the current order.
    pub(super) fn products(&self, group: usize) -> Address {
        Address { area: Area::Work, offset: self.products + group * self.side * self.size }
    }

    fn group(&self, start: usize, group: usize, place: usize) -> Address {
        let offset = start + (group * self.stride + place) * self.side * self.size;
        Address { area: Area::Work, offset }
    }
}

/// What series in one precision need of the stretch of work.
#[derive(Clone, Copy, Debug)]
pub(super) struct Precision {
    pub(super) size: usize,
    pub(super) side: usize,
    pub(super) stride: usize,
    /// Whether order 0 of all registers is copied into the stretch of work.
    pub(super) copies_values: bool,
    pub(super) areas: (Area, Area),
}

/// All places, which grow while code is written.
#[derive(Clone, Debug)]
pub(super) struct MemoryLayout {
    /// The unit of time, or those of several orbits.
    pub(super) scale: Address,
    /// The length of the stretch of work.
    pub(super) work: usize,
    /// Numbers that stay as they are, with their places.
    constants: Vec<(usize, Vec<f64>)>,
    /// The same by the bits of the first of the numbers.
    by_first: FxHashMap<u64, Vec<usize>>,
}

impl MemoryLayout {
    /// One with room for units of time alone.
    pub(super) fn new() -> MemoryLayout {
        let scale = Address { area: Area::Work, offset: 0 };
        MemoryLayout { scale, work: LINE, constants: Vec::new(), by_first: FxHashMap::default() }
    }

    /// Makes room for the series of a program.
    pub(super) fn series(&mut self, plan: &JetPlan<'_>, precision: Precision) -> SeriesPlaces {
        let Precision { size, side, stride, copies_values, areas: (series, state) } = precision;
        let values = if copies_values {
            let offset = self.room(plan.values * size);
            Address { area: Area::Work, offset }
        } else {
            Address { area: Area::Values, offset: 0 }
        };
        let factored = plan.program.blocks.iter().map(|block| {
            let n = block.size();
            let (entries, upper) = (self.room(n * n * size), self.room(n * n * size));
            let (rows, right) = (self.room(n), self.room(n * size));
            FactoredPlace { size: n, entries, upper, rows, right }
        });
        let factored = factored.collect();
        let groups = plan.schedule.pairs.len().div_ceil(side);
        let operands = groups * stride * side * size;
        let (left, right) = (self.room(operands), self.room(operands));
        let products = self.room(groups * side * size);
        SeriesPlaces { size, side, stride, values, series, state, factored, left, right, products }
    }

    /// Room for so many numbers in the stretch of work, from the start of a cache line on.
    fn room(&mut self, count: usize) -> usize {
        let first = self.work;
        self.work += count.next_multiple_of(LINE);
        first
    }

    /// Where numbers lie that stay as they are.
    pub(super) fn constant(&mut self, numbers: &[f64]) -> Address {
        let same = |known: &[f64]| {
            known.len() == numbers.len()
                && known.iter().zip(numbers).all(|(x, y)| x.to_bits() == y.to_bits())
        };
        let begins_alike =
            self.by_first.entry(numbers.first().map_or(0, |x| x.to_bits())).or_default();
        let known = begins_alike.iter().find(|&&i| same(&self.constants[i].1));
        let offset = known.map_or(self.work, |&i| self.constants[i].0);
        if known.is_none() {
            begins_alike.push(self.constants.len());
            self.work += numbers.len().next_multiple_of(2);
            self.constants.push((offset, numbers.to_vec()));
        }
        Address { area: Area::Work, offset }
    }

    pub(super) fn first_work(&self) -> Vec<f64> {
        let mut work = vec![0.0; self.work];
        for (place, numbers) in &self.constants {
            work[*place..][..numbers.len()].copy_from_slice(numbers);
        }
        work
    }
}
