//! Where the operations of one or two programs lie in one file of registers, and the instructions that compute them.
//!
//! In: programs of rates, which numbers of a state they move, and which of these together. Out: instructions, the table of sums that they
//! read, the registers of the numbers and of their rates. Never here: numbers.

use std::sync::Arc;

use super::instruction::{BlockPlaces, CHUNK, Instruction, InstructionSum, Moved, REGISTERS};
use super::program::{Op, Program, Register};

/// What instructions refer to.
#[derive(Clone, Debug)]
pub(super) struct RegisterMap {
    programs: Vec<Arc<Program>>,
    /// The register of every operation of each program.
    places: Vec<Vec<u8>>,
    /// Registers that depend on parameters only: the program, the operation, the register.
    pub(super) fixed: Vec<(u8, Register, u8)>,
    /// The register of every number of a state.
    pub(super) numbers: Vec<u8>,
    /// The register of the time, where programs may depend on it.
    pub(super) time: Option<u8>,
    pub(super) sums: Vec<InstructionSum>,
    /// The blocks of more than one equation.
    pub(super) blocks: Vec<BlockPlaces>,
    /// The register that holds a one.
    pub(super) one: u8,
    /// The first register that is free.
    next: usize,
}

impl RegisterMap {
    /// Registers for groups of numbers of a state, those of a group side by side. Returns `None` where there are more
    /// numbers than registers.
    pub(super) fn new<const N: usize>(groups: [&[usize]; N], timed: bool) -> Option<RegisterMap> {
        let count = groups.iter().map(|group| group.len()).sum();
        let mut map = RegisterMap {
            programs: Vec::new(),
            places: Vec::new(),
            fixed: Vec::new(),
            numbers: vec![0; count],
            time: None,
            sums: Vec::new(),
            blocks: Vec::new(),
            one: 0,
            next: 0,
        };
        for numbers in groups {
            let first = map.room_for(numbers.len())?;
            for (k, &i) in numbers.iter().enumerate() {
                map.numbers[i] = first + k as u8;
            }
        }
        map.one = map.room_for_one()?;
        if timed {
            map.time = Some(map.room_for_one()?);
        }
        Some(map)
    }

    /// Registers side by side, from a multiple of [`CHUNK`] on.
    fn room_for(&mut self, count: usize) -> Option<u8> {
        let first = self.next.next_multiple_of(CHUNK);
        self.next = (first + count).next_multiple_of(CHUNK);
        (self.next <= REGISTERS).then_some(first as u8)
    }

    fn room_for_one(&mut self) -> Option<u8> {
        self.next += 1;
        (self.next <= REGISTERS).then(|| (self.next - 1) as u8)
    }

    /// The operations of a program that its outputs need, in order, and what they move: the numbers of each group, which
    /// lie side by side. Returns `None` where it depends on a time that has no register, and where there are not enough
    /// registers.
    pub(super) fn lower<const N: usize>(
        &mut self,
        (program, places_moved): (&Arc<Program>, &[usize]),
        groups: [&[usize]; N],
    ) -> Option<(Vec<Instruction>, Vec<Moved>)> {
        let program = Arc::clone(program);
        let own = self.programs.len() as u8;
        let mut needed = needed(&program, self.time.is_some())?;
        let factors = take_products(&program, &mut needed);
        let mut places: Vec<Option<u8>> = vec![None; program.ops.len()];
        for (i, &r) in program.inputs.iter().enumerate() {
            places[r as usize] = Some(*self.numbers.get(i)?);
        }
        let mut copies = Vec::new();
        let mut moved = Vec::new();
        for group in groups.into_iter().filter(|group| !group.is_empty()) {
            let output = |i: &usize| places_moved.iter().position(|place| place == i);
            let outputs: Option<Vec<Register>> =
                group.iter().map(|i| Some(program.outputs[output(i)?])).collect();
            let outputs = outputs?;
            let rate = match self.side_by_side(&program, &outputs, &groups) {
                Some(rate) => rate,
                None => {
                    let first = self.room_for(group.len())?;
                    for (&r, to) in outputs.iter().zip(first..) {
                        let at = r as usize;
                        if program.fixed[at] {
                            self.fixed.push((own, r, to));
                        } else if places[at].is_none() && is_single(program.ops[at]) {
                            places[at] = Some(to);
                        } else {
                            copies.push((r, to));
                        }
                    }
                    first
                }
            };
            let number = self.numbers[group[0]];
            moved.push(Moved { number, rate, count: group.len() as u8 });
        }
        for (r, place) in places.iter_mut().enumerate().filter(|&(r, _)| needed[r]) {
            if program.ops[r] == Op::Time {
                *place = self.time;
            }
            if place.is_none() {
                *place = Some(self.room_for_one()?);
            }
            if program.fixed[r] {
                self.fixed.push((own, r as Register, (*place)?));
            }
        }
        let places: Vec<u8> = places.into_iter().map(Option::unwrap_or_default).collect();
        let mut list = Vec::new();
        for r in (0..program.ops.len()).filter(|&r| needed[r] && !program.fixed[r]) {
            if !matches!(program.ops[r], Op::Input(_) | Op::Written | Op::Time) {
                let operation = (own, r as Register);
                list.push(self.lowered(&program, operation, (&places, &factors))?);
            }
        }
        let copy = |(r, to): (Register, u8)| Instruction::Copy { a: places[r as usize], to };
        list.extend(copies.into_iter().map(copy));
        self.programs.push(program);
        self.places.push(places);
        Some((list, moved))
    }

    /// The first of numbers of the state that are these rates, in order, as the momenta may be the
    /// velocities. None of them may be moved by the same program.
    fn side_by_side(
        &self,
        program: &Program,
        outputs: &[Register],
        moved: &[&[usize]],
    ) -> Option<u8> {
        let input = |r: Register| program.inputs.iter().position(|&input| input == r);
        let numbers: Option<Vec<usize>> = outputs.iter().map(|&r| input(r)).collect();
        let numbers = numbers?;
        let own = |i: &usize| moved.iter().any(|group| group.contains(i));
        let first = self.numbers[numbers[0]];
        let mut places = numbers.iter().zip(first..);
        let fits = !numbers.iter().any(own)
            && usize::from(first).is_multiple_of(CHUNK)
            && places.all(|(&i, place)| self.numbers[i] == place);
        fits.then_some(first)
    }

    /// The instruction of an operation, if there is one.
    fn lowered(
        &mut self,
        program: &Program,
        (own, operation): (u8, Register),
        (places, factors): (&[u8], &[Option<[Register; 2]>]),
    ) -> Option<Instruction> {
        let at = |r: Register| places[r as usize];
        let to = at(operation);
        Some(match program.ops[operation as usize] {
            Op::Time => return None,
            Op::Linear { constant, first, count } => {
                let terms = &program.terms[first as usize..(first + count) as usize];
                let one = self.one;
                let mut terms = terms.iter().map(|term| {
                    let factors = factors[term.register as usize];
                    let registers = factors.map_or([at(term.register), one], |f| f.map(at));
                    (term.coefficient.high, registers)
                });
                let mut sum = InstructionSum {
                    constant: program.constants[constant as usize].high,
                    coefficients: [0.0; 3],
                    registers: [[one; 2]; 3],
                    further: Vec::new(),
                };
                for (k, term) in terms.by_ref().take(3).enumerate() {
                    (sum.coefficients[k], sum.registers[k]) = term;
                }
                sum.further = terms.collect();
                let products = sum.registers.iter().any(|[_, second]| *second != one);
                self.sums.push(sum);
                let sum = u8::try_from(self.sums.len() - 1).ok()?;
                match (count, products) {
                    (0, _) => return None,
                    (1, false) => Instruction::Sum1 { sum, to },
                    (2, false) => Instruction::Sum2 { sum, to },
                    (3, false) => Instruction::Sum3 { sum, to },
                    (1, true) => Instruction::Products1 { sum, to },
                    (2, true) => Instruction::Products2 { sum, to },
                    (3, true) => Instruction::Products3 { sum, to },
                    _ => Instruction::Sum { sum, to },
                }
            }
            Op::Scale(a, b) | Op::Multiply(a, b) => {
                Instruction::Multiply { a: at(a), b: at(b), to }
            }
            Op::Square(a) => Instruction::Multiply { a: at(a), b: at(a), to },
            Op::Divide(a, b) => Instruction::Divide { a: at(a), b: at(b), to },
            Op::Solve(block) => {
                let block = &program.blocks[block as usize];
                if block.size() == 1 {
                    return Some(Instruction::Divide {
                        a: at(block.right[0]),
                        b: at(block.matrix[0]),
                        to,
                    });
                }
                let places = |registers: &[Register]| registers.iter().map(|&r| at(r)).collect();
                let (matrix, right) = (places(&block.matrix), places(&block.right));
                self.blocks.push(BlockPlaces { matrix, right });
                Instruction::Solve { block: u8::try_from(self.blocks.len() - 1).ok()?, to }
            }
            Op::Root(a) => Instruction::Root { a: at(a), to },
            _ => Instruction::Other { program: own, operation, to },
        })
    }

    /// A program and the register of each of its operations.
    pub(super) fn program(&self, program: u8) -> (&Program, &[u8]) {
        (&self.programs[usize::from(program)], &self.places[usize::from(program)])
    }
}

/// Whether an operation writes no other register than its own.
fn is_single(op: Op) -> bool {
    !matches!(
        op,
        Op::Input(_)
            | Op::Time
            | Op::Call(..)
            | Op::Solve(_)
            | Op::Written
            | Op::ParametricPower(..)
    )
}

/// Which operations the outputs of a program need. `None` if one of them is the time and that has no register.
fn needed(program: &Program, timed: bool) -> Option<Vec<bool>> {
    let mut needed = vec![false; program.ops.len()];
    for &r in &program.outputs {
        needed[r as usize] = true;
    }
    for r in (0..program.ops.len()).rev().filter(|&r| !program.fixed[r]) {
        match program.ops[r] {
            _ if !needed[r] => continue,
            Op::Time if !timed => return None,
            // with its companion
            Op::Call(..) => needed[r + 1] = true,
            // with all its unknowns
            Op::Solve(block) => {
                needed[r..r + program.blocks[block as usize].size()].fill(true);
            }
            _ => {}
        }
        program.each_operand(r as Register, &mut |operand| needed[operand as usize] = true);
    }
    Some(needed)
}

/// The factors of each product that a single sum reads, and nothing else; the product itself is no longer
/// needed.
fn take_products(program: &Program, needed: &mut [bool]) -> Vec<Option<[Register; 2]>> {
    let mut readers = vec![0; program.ops.len()];
    program.outputs.iter().for_each(|&r| readers[r as usize] += 2);
    for r in (0..program.ops.len()).filter(|&r| needed[r] && !program.fixed[r]) {
        // what is no sum counts twice
        let weight = if matches!(program.ops[r], Op::Linear { .. }) { 1 } else { 2 };
        program.each_operand(r as Register, &mut |a| readers[a as usize] += weight);
    }
    let mut factors = vec![None; program.ops.len()];
    for r in (0..program.ops.len()).filter(|&r| readers[r] == 1 && !program.fixed[r]) {
        factors[r] = match program.ops[r] {
            Op::Scale(a, b) | Op::Multiply(a, b) => Some([a, b]),
            Op::Square(a) => Some([a, a]),
            _ => None,
        };
        needed[r] &= factors[r].is_none();
    }
    factors
}
