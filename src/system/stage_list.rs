//! The steps of a splitting method as one straight list of instructions: the operations of both
//! halves of the motion and the sums between them, on one file of registers that holds the state.
//!
//! ```text
//! registers   moved by T alone │ by V alone │ by both │ the operations, each rate where it is added
//!
//! open        kick · its sums
//! step        (drift · its sums · kick · its sums)… · the last sums of a step and the first of the next
//! end         the same without the sums of the next step, which are
//! lead
//! ```
//!
//! In: the programs of both halves, the weights of the composition. Out: instructions. Never here:
//! numbers, and systems whose halves depend on time or solve equations: these are evaluated operation
//! by operation.

use std::sync::Arc;

use super::program::{Op, Program, Register};
use super::rates::Rates;

/// The number of registers: an index of eight bits needs no check.
pub(super) const REGISTERS: usize = 256;

/// As many numbers are moved side by side. Those that are moved together begin at a multiple of it.
pub(super) const CHUNK: usize = 4;

/// One instruction. It writes the register `to`, or moves numbers of the state.
#[derive(Clone, Copy, Debug)]
pub(super) enum Instruction {
    /// A sum of one, two or three terms, from the table.
    Sum1 {
        sum: u8,
        to: u8,
    },
    Sum2 {
        sum: u8,
        to: u8,
    },
    Sum3 {
        sum: u8,
        to: u8,
    },
    /// The same where a term is a product.
    Products1 {
        sum: u8,
        to: u8,
    },
    Products2 {
        sum: u8,
        to: u8,
    },
    Products3 {
        sum: u8,
        to: u8,
    },
    /// A longer sum.
    Sum {
        sum: u8,
        to: u8,
    },
    Multiply {
        a: u8,
        b: u8,
        to: u8,
    },
    Divide {
        a: u8,
        b: u8,
        to: u8,
    },
    Root {
        a: u8,
        to: u8,
    },
    Copy {
        a: u8,
        to: u8,
    },
    /// Any other operation of a half, with its companion in the next register.
    Other {
        half: Half,
        operation: Register,
        to: u8,
    },
    /// Adds `factor · rate` to some numbers.
    Move {
        factor: u8,
        moved: Moved,
    },
    /// Adds two multiples of the rates, one after the other.
    MoveTwice {
        factors: [u8; 2],
        moved: Moved,
    },
}

/// Numbers that move together: the first of them, of their rates, and how many there are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moved {
    pub(super) number: u8,
    pub(super) rate: u8,
    pub(super) count: u8,
}

impl Moved {
    /// Whether they fill no more than one [`CHUNK`].
    #[inline(always)]
    pub(super) fn is_short(self) -> bool {
        usize::from(self.count) <= CHUNK
    }
}

/// One half of the motion.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Half {
    Drift,
    Kick,
}

use Half::{Drift, Kick};

/// `constant + Σ coefficient · (register · register)`; the second register of a term that is no
/// product holds a one.
#[derive(Clone, Debug)]
pub(super) struct Sum {
    pub(super) constant: f64,
    /// The first terms.
    pub(super) coefficients: [f64; 3],
    pub(super) registers: [[u8; 2]; 3],
    /// The terms after these.
    pub(super) further: Vec<(f64, [u8; 2])>,
}

/// The instructions of one method and system.
#[derive(Clone, Debug)]
pub(super) struct StageList {
    programs: [Arc<Program>; 2],
    /// The register of every operation of each half.
    places: [Vec<u8>; 2],
    /// Registers that depend on parameters only: the half, the operation, the register.
    pub(super) fixed: Vec<(Half, Register, u8)>,
    /// The register of every number of a state.
    pub(super) numbers: Vec<u8>,
    pub(super) sums: Vec<Sum>,
    /// The register that holds a one.
    pub(super) one: u8,
    pub(super) open: Vec<Instruction>,
    pub(super) step: Vec<Instruction>,
    pub(super) end: Vec<Instruction>,
    pub(super) lead: Vec<Instruction>,
    weights: Vec<f64>,
    /// The first register that is free.
    next: usize,
}

impl StageList {
    /// The list for the rates under T alone and under V alone, and these weights. Returns `None`
    /// where V depends on time, where equations are solved, and where there are more numbers than
    /// registers.
    pub(super) fn new(drift: &Rates, kick: &Rates, weights: &[f64]) -> Option<StageList> {
        let count = drift.system().state_len();
        let mut list = StageList {
            programs: [Arc::clone(&drift.program), Arc::clone(&kick.program)],
            places: [Vec::new(), Vec::new()],
            fixed: Vec::new(),
            numbers: vec![0; count],
            sums: Vec::new(),
            one: 0,
            open: Vec::new(),
            step: Vec::new(),
            end: Vec::new(),
            lead: Vec::new(),
            weights: weights.to_vec(),
            next: 0,
        };
        let moves = |half: &Rates, i: usize| half.places.contains(&i);
        let group = |by: [bool; 2]| {
            (0..count).filter(|&i| [moves(drift, i), moves(kick, i)] == by).collect::<Vec<usize>>()
        };
        let own = [group([true, false]), group([false, true])];
        let (both, neither) = (group([true, true]), group([false, false]));
        for numbers in [&own[0], &own[1], &both, &neither] {
            let first = list.room_for(numbers.len())?;
            for (k, &i) in numbers.iter().enumerate() {
                list.numbers[i] = first + k as u8;
            }
        }
        list.one = list.room_for_one()?;
        let (drift_operations, drifted) = list.lower(Drift, drift, [&own[0], &both])?;
        let (kick_operations, kicked) = list.lower(Kick, kick, [&own[1], &both])?;
        list.put_together((&drift_operations, &drifted), (&kick_operations, &kicked))?;
        Some(list)
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

    /// The operations of one half that its outputs need, in order, and what they move.
    fn lower(
        &mut self,
        half: Half,
        rates: &Rates,
        groups: [&[usize]; 2],
    ) -> Option<(Vec<Instruction>, Vec<Moved>)> {
        let program = Arc::clone(&rates.program);
        let mut needed = needed(&program)?;
        let factors = take_products(&program, &mut needed);
        let mut places: Vec<Option<u8>> = vec![None; program.ops.len()];
        for (i, &r) in program.inputs.iter().enumerate() {
            places[r as usize] = Some(self.numbers.get(i).copied().unwrap_or_default());
        }
        let mut copies = Vec::new();
        let mut moved = Vec::new();
        for group in groups.into_iter().filter(|group| !group.is_empty()) {
            let output = |i: &usize| rates.places.iter().position(|place| place == i);
            let outputs: Option<Vec<Register>> =
                group.iter().map(|i| Some(program.outputs[output(i)?])).collect();
            let outputs = outputs?;
            let rate = match self.side_by_side(&program, &outputs, groups) {
                Some(rate) => rate,
                None => {
                    let first = self.room_for(group.len())?;
                    for (&r, to) in outputs.iter().zip(first..) {
                        let at = r as usize;
                        if program.fixed[at] {
                            self.fixed.push((half, r, to));
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
            if place.is_none() {
                *place = Some(self.room_for_one()?);
            }
            if program.fixed[r] {
                self.fixed.push((half, r as Register, place.unwrap_or_default()));
            }
        }
        let places: Vec<u8> = places.into_iter().map(Option::unwrap_or_default).collect();
        let mut list = Vec::new();
        for r in (0..program.ops.len()).filter(|&r| needed[r] && !program.fixed[r]) {
            if !matches!(program.ops[r], Op::Input(_) | Op::Written) {
                list.push(self.lowered(half, &program, r as Register, (&places, &factors))?);
            }
        }
        let copy = |(r, to): (Register, u8)| Instruction::Copy { a: places[r as usize], to };
        list.extend(copies.into_iter().map(copy));
        self.places[half as usize] = places;
        Some((list, moved))
    }

    /// The first of numbers of the state that are these rates, in order, as the momenta may be the
    /// velocities. None of them may be moved by the same half.
    fn side_by_side(
        &self,
        program: &Program,
        outputs: &[Register],
        moved: [&[usize]; 2],
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
        half: Half,
        program: &Program,
        operation: Register,
        (places, factors): (&[u8], &[Option<[Register; 2]>]),
    ) -> Option<Instruction> {
        let at = |r: Register| places[r as usize];
        let to = at(operation);
        Some(match program.ops[operation as usize] {
            Op::Time | Op::Solve(_) => return None,
            Op::Linear { constant, first, count } => {
                let terms = &program.terms[first as usize..(first + count) as usize];
                let one = self.one;
                let mut terms = terms.iter().map(|term| {
                    let factors = factors[term.register as usize];
                    let registers = factors.map_or([at(term.register), one], |f| f.map(at));
                    (term.coefficient.high, registers)
                });
                let mut sum = Sum {
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
            Op::Root(a) => Instruction::Root { a: at(a), to },
            _ => Instruction::Other { half, operation, to },
        })
    }

    /// Puts the parts of a step together. The kicks have the factors 0, 2, 4, …, the drifts between
    /// them 1, 3, 5, …
    fn put_together(
        &mut self,
        (drift, drifted): (&[Instruction], &[Moved]),
        (kick, kicked): (&[Instruction], &[Moved]),
    ) -> Option<()> {
        let last = u8::try_from(2 * self.weights.len()).ok()?;
        let moves = |moved: &[Moved], factor: u8| -> Vec<Instruction> {
            moved.iter().map(|&moved| Instruction::Move { factor, moved }).collect()
        };
        let mut stages = Vec::new();
        for factor in (1..last).step_by(2) {
            stages.extend_from_slice(drift);
            stages.extend(moves(drifted, factor));
            stages.extend_from_slice(kick);
            if factor + 1 < last {
                stages.extend(moves(kicked, factor + 1));
            }
        }
        let turn = kicked.iter().map(|&moved| Instruction::MoveTwice { factors: [last, 0], moved });
        self.lead = moves(kicked, 0);
        self.open = [kick, &self.lead].concat();
        self.end = [stages.clone(), moves(kicked, last)].concat();
        self.step = stages.into_iter().chain(turn).collect();
        Some(())
    }

    /// The factors of the sums for a step.
    pub(super) fn factors(&self, step: f64) -> impl Iterator<Item = f64> + '_ {
        let weights = self.weights.iter();
        let before = std::iter::once(&0.0).chain(weights.clone());
        let inner = weights.clone().zip(before);
        let last = self.weights.last().map(|w| 0.5 * w * step);
        inner.flat_map(move |(&w, before)| [0.5 * (before + w) * step, w * step]).chain(last)
    }

    /// A half and the register of each of its operations.
    pub(super) fn half(&self, half: Half) -> (&Program, &[u8]) {
        (&self.programs[half as usize], &self.places[half as usize])
    }
}

/// Whether an operation writes no other register than its own.
fn is_single(op: Op) -> bool {
    !matches!(op, Op::Input(_) | Op::Call(..) | Op::Written | Op::ParametricPower(..))
}

/// Which operations the outputs of a program need. `None` if one of them is not for a list: the
/// time, or a block of equations.
fn needed(program: &Program) -> Option<Vec<bool>> {
    let mut needed = vec![false; program.ops.len()];
    for &r in &program.outputs {
        needed[r as usize] = true;
    }
    for r in (0..program.ops.len()).rev().filter(|&r| !program.fixed[r]) {
        match program.ops[r] {
            _ if !needed[r] => continue,
            Op::Time | Op::Solve(_) => return None,
            // with its companion
            Op::Call(..) => needed[r + 1] = true,
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
