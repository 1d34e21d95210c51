//! The registers of a basic block.
//!
//! In: a basic block, room in memory for what finds no register. Out: its bytes, and how much of the room is used. Never
//! here: how an instruction is encoded.
//!
//! Where all registers are taken, the number gives way that is read again last (L. A. Belady, IBM Syst. J. 5 (1966) 78).
//! Every number is made once, so that it is spilled at most once.

use super::basic_block::{BasicBlock, MachineInstruction, Operand, VirtualRegister, Width};
use super::encoding::{Bytes, Source, VectorRegister};
use super::layout::{Address, Area};
use super::product_loops::{self, ProductLoops};

/// The number of vector registers.
const REGISTERS: usize = 16;

/// About how many bytes an instruction has.
const BYTES: usize = 7;

/// What is not read again.
const NEVER: u32 = u32::MAX;

#[derive(Clone, Copy, Debug, Default)]
struct Location {
    register: Option<VectorRegister>,
    memory: Option<Address>,
    width: Option<Width>,
    /// The instruction that reads it next.
    next: u32,
}

struct Allocator {
    bytes: Bytes,
    loops: ProductLoops,
    places: Vec<Location>,
    registers: [Option<VirtualRegister>; REGISTERS],
    /// The registers that hold nothing.
    empty: u16,
    /// The registers that the current instruction reads.
    pinned: u16,
    room: usize,
    /// The least number of `f64` of a spilled number.
    slot: usize,
}

/// Assembles a block. What finds no register is spilled to the stretch of work from `room` on, in slots of at least so many
/// `f64`; returns the bytes and where that ends.
pub(super) fn assemble(block: &BasicBlock, room: usize, slot: usize) -> (Vec<u8>, usize) {
    let (first, next) = uses(block);
    let places = first.into_iter().map(|next| Location { next, ..Location::default() }).collect();
    let mut allocator = Allocator {
        bytes: Bytes(Vec::with_capacity(BYTES * block.instructions.len())),
        loops: ProductLoops::default(),
        places,
        registers: [None; REGISTERS],
        empty: u16::MAX,
        pinned: 0,
        room,
        slot,
    };
    for (instruction, next) in block.instructions.iter().zip(&next) {
        allocator.write(instruction, next);
    }
    let Allocator { mut bytes, loops, room, .. } = allocator;
    bytes.end();
    loops.write(&mut bytes);
    (bytes.0, room)
}

/// The first instruction that reads each number, and for each instruction those that read its operands next.
fn uses(block: &BasicBlock) -> (Vec<u32>, Vec<[u32; 3]>) {
    let mut coming = vec![NEVER; block.values as usize];
    let mut next = vec![[NEVER; 3]; block.instructions.len()];
    for (i, instruction) in block.instructions.iter().enumerate().rev() {
        let reads = instruction.reads();
        for (next, value) in next[i].iter_mut().zip(reads) {
            *next = value.map_or(NEVER, |value| coming[value.0 as usize]);
        }
        for value in reads.into_iter().flatten() {
            coming[value.0 as usize] = i as u32;
        }
    }
    (coming, next)
}

impl Allocator {
    fn write(&mut self, instruction: &MachineInstruction, next: &[u32; 3]) {
        self.pinned = 0;
        let reads = instruction.reads();
        match *instruction {
            MachineInstruction::Zero { width, made } => {
                let to = self.make(made, width);
                self.bytes.zero(to);
            }
            MachineInstruction::Load { width, from, made } => {
                let to = self.make(made, width);
                self.bytes.load(width, to, from);
            }
            MachineInstruction::LoadBehind { from, offset, made } => {
                let to = self.make(made, Width::One);
                self.bytes.load_behind(to, from, offset);
            }
            MachineInstruction::Binary { operation, width, left, right, made } => {
                let left = self.read(left);
                let right = match right {
                    Operand::At(address) => Source::Memory(address.into()),
                    Operand::Made(right) => self.source(right, next[1]),
                };
                self.advance(&reads, next);
                let to = self.make(made, width);
                self.bytes.binary(operation, width, to, left, right);
            }
            MachineInstruction::ProductError { width, left, right, product, made } => {
                let [left, right, product] = [left, right, product].map(|value| self.read(value));
                if next[0] == NEVER {
                    self.advance(&reads, next);
                    self.make_in(left, made, width);
                    self.bytes.product_error(width, left, right, product);
                } else {
                    // it is written before the others are read
                    let to = self.make(made, width);
                    self.bytes.copy(width, to, left);
                    self.bytes.product_error(width, to, right, product);
                    self.advance(&reads, next);
                }
            }
            MachineInstruction::Store { width, value, to, stays } => {
                let from = self.read(value);
                self.bytes.store(width, from, to);
                if stays && self.places[value.0 as usize].width == Some(width) {
                    self.places[value.0 as usize].memory = Some(to);
                }
                self.advance(&reads, next);
            }
            MachineInstruction::InnerProducts { products, made } => {
                for register in 0..product_loops::REGISTERS {
                    self.evict(register);
                }
                let to = self.loops.call(&mut self.bytes, products);
                self.places[made.0 as usize].width = Some(products.width);
                if self.places[made.0 as usize].next != NEVER {
                    self.take(to, made);
                }
            }
        }
    }

    /// The register of a number, loaded again if it gave way.
    fn read(&mut self, value: VirtualRegister) -> VectorRegister {
        let place = self.places[value.0 as usize];
        let register = place.register.unwrap_or_else(|| {
            let register = self.free();
            if let (Some(width), Some(memory)) = (place.width, place.memory) {
                self.bytes.load(width, register, memory);
            }
            self.take(register, value);
            register
        });
        self.pinned |= 1 << register.0;
        register
    }

    /// The same where it may be read from memory, if it is not read again.
    fn source(&mut self, value: VirtualRegister, next: u32) -> Source {
        let place = self.places[value.0 as usize];
        match (place.register, place.memory) {
            (None, Some(memory)) if next == NEVER => Source::Memory(memory.into()),
            _ => Source::Register(self.read(value)),
        }
    }

    /// Takes note of when the operands of an instruction are read next. The registers of those that are not are free.
    fn advance(&mut self, reads: &[Option<VirtualRegister>; 3], next: &[u32; 3]) {
        for (value, &next) in reads.iter().zip(next) {
            let Some(value) = value else { continue };
            let place = &mut self.places[value.0 as usize];
            place.next = next;
            if next == NEVER
                && let Some(register) = place.register.take()
            {
                self.registers[register.0 as usize] = None;
                self.empty |= 1 << register.0;
                self.pinned &= !(1 << register.0);
            }
        }
    }

    /// A register for a number that is made.
    fn make(&mut self, value: VirtualRegister, width: Width) -> VectorRegister {
        let register = self.free();
        self.make_in(register, value, width);
        register
    }

    fn make_in(&mut self, register: VectorRegister, value: VirtualRegister, width: Width) {
        self.places[value.0 as usize].width = Some(width);
        if self.places[value.0 as usize].next != NEVER {
            self.take(register, value);
        }
    }

    fn take(&mut self, register: VectorRegister, value: VirtualRegister) {
        self.registers[register.0 as usize] = Some(value);
        self.empty &= !(1 << register.0);
        self.places[value.0 as usize].register = Some(register);
    }

    /// A register that holds nothing, or nothing any more.
    fn free(&mut self) -> VectorRegister {
        if self.empty != 0 {
            return VectorRegister(self.empty.trailing_zeros() as u8);
        }
        let last = (0..REGISTERS).filter(|&r| self.pinned & 1 << r == 0).max_by_key(|&r| {
            self.registers[r].map_or(NEVER, |value| self.places[value.0 as usize].next)
        });
        let last = last.unwrap_or(0);
        self.evict(last);
        VectorRegister(last as u8)
    }

    /// Empties a register.
    fn evict(&mut self, register: usize) {
        if let Some(value) = self.registers[register].take() {
            self.spill(value, VectorRegister(register as u8));
        }
        self.empty |= 1 << register;
    }

    /// Writes a number to memory, unless it is there.
    fn spill(&mut self, value: VirtualRegister, register: VectorRegister) {
        let place = &mut self.places[value.0 as usize];
        place.register = None;
        if place.memory.is_none() {
            let width = place.width.unwrap_or(Width::One);
            let to = Address { area: Area::Work, offset: self.room };
            place.memory = Some(to);
            self.room += width.numbers().max(self.slot);
            self.bytes.store(width, register, to);
        }
    }
}
