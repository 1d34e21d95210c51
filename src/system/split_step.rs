//! The steps of a splitting method as one straight list of instructions: the operations of both
//! halves of the motion and the sums between them, on one file of registers that holds the state.
//!
//! ```text
//! programs of drift and kick ──▶ lead: kick · stages: (drift, kick)… · turn: the last kick of a
//!                                step and the first of the next · close: the last kick of all
//! ```
//!
//! In: the rates of both halves, the weights of the composition. Out: the state after many steps,
//! with the bits that single steps give. Never here: a number that is not finite, time, which steps
//! to take; for these the motion is evaluated operation by operation.

use super::State;
use super::program::{Op, Program, Register};
use super::rates::Rates;
use super::value::value_of;
use crate::num::accumulate;

/// The number of registers: an index of eight bits needs no check.
const REGISTERS: usize = 256;

/// One instruction. It writes the register `to`, or moves one number of the state.
#[derive(Clone, Copy, Debug)]
enum Instruction {
    /// `constant + Σ coefficient · register`.
    Linear {
        constant: f64,
        first: u32,
        count: u32,
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
    /// Any other operation of a half, with its companion in the next register.
    Other {
        half: bool,
        operation: Register,
        to: u8,
    },
    /// Adds `factor · rate` to a number of the state.
    Move {
        factor: u8,
        rate: u8,
        number: u8,
    },
    /// Adds two multiples of a rate, one after the other.
    MoveTwice {
        factors: [u8; 2],
        rate: u8,
        number: u8,
    },
}

/// The register of every operation of one half.
type Places = Vec<u8>;

/// Many steps of one splitting method.
#[derive(Clone, Debug)]
pub struct SplitStep {
    halves: [Rates; 2],
    places: [Places; 2],
    /// Registers that depend on parameters only: the half, the operation, the register.
    fixed: Vec<(bool, Register, u8)>,
    weights: Vec<f64>,
    terms: Vec<(f64, u8)>,
    lead: Vec<Instruction>,
    stages: Vec<Instruction>,
    turn: Vec<Instruction>,
    close: Vec<Instruction>,
    registers: Box<[f64; REGISTERS]>,
    carries: Box<[f64; REGISTERS]>,
    factors: Box<[f64; REGISTERS]>,
    /// Whether the list gives what single steps give at these parameters.
    suits: bool,
}

impl SplitStep {
    /// The list of instructions for the rates under T alone and under V alone, and these weights.
    /// Returns `None` where V depends on time, where equations are solved, and where there are more
    /// numbers than registers.
    pub fn new(drift: &Rates, kick: &Rates, weights: &[f64]) -> Option<SplitStep> {
        let numbers = drift.system().state_len();
        if numbers >= REGISTERS || 2 * weights.len() + 1 >= REGISTERS {
            return None;
        }
        let mut step = SplitStep {
            halves: [drift.clone(), kick.clone()],
            places: [Vec::new(), Vec::new()],
            fixed: Vec::new(),
            weights: weights.to_vec(),
            terms: Vec::new(),
            lead: Vec::new(),
            stages: Vec::new(),
            turn: Vec::new(),
            close: Vec::new(),
            registers: Box::new([0.0; REGISTERS]),
            carries: Box::new([0.0; REGISTERS]),
            factors: Box::new([0.0; REGISTERS]),
            suits: false,
        };
        let mut next = numbers;
        let drift_operations = step.lower(false, &mut next)?;
        let kick_operations = step.lower(true, &mut next)?;
        if [false, true].into_iter().any(|half| step.moves_its_rates(half)) {
            return None;
        }
        // the kicks have the factors 0, 2, 4, …, the drifts between them 1, 3, 5, …
        let last = 2 * weights.len();
        step.lead = step.moves(true, 0);
        step.close = step.moves(true, last);
        for k in 0..weights.len() {
            step.stages.extend_from_slice(&drift_operations);
            let moves = step.moves(false, 2 * k + 1);
            step.stages.extend(moves);
            step.stages.extend_from_slice(&kick_operations);
            if 2 * (k + 1) < last {
                let moves = step.moves(true, 2 * (k + 1));
                step.stages.extend(moves);
            }
        }
        step.turn = step.close.iter().map(|&instruction| twice(instruction)).collect();
        Some(step)
    }

    /// The operations of one half that its outputs need, in order.
    fn lower(&mut self, half: bool, next: &mut usize) -> Option<Vec<Instruction>> {
        let program = self.halves[usize::from(half)].program.clone();
        let needed = needed(&program)?;
        let mut places: Places = vec![0; program.ops.len()];
        for (i, &r) in program.inputs.iter().enumerate() {
            places[r as usize] = u8::try_from(i).ok()?;
        }
        let is_input = |r: Register| matches!(program.ops[r as usize], Op::Input(_));
        for (r, _) in needed.iter().enumerate().filter(|&(_, &needed)| needed) {
            if !is_input(r as Register) {
                places[r] = u8::try_from(*next).ok()?;
                *next += 1;
            }
        }
        let mut list = Vec::new();
        for (r, op) in program.ops.iter().enumerate().filter(|&(r, _)| needed[r]) {
            let (to, operation) = (places[r], r as Register);
            let at = |r: Register| places[r as usize];
            if program.fixed[r] {
                self.fixed.push((half, operation, to));
                continue;
            }
            list.push(match *op {
                Op::Input(_) | Op::Written => continue,
                Op::Time | Op::Solve(_) => return None,
                Op::Linear { constant, first, count } => {
                    let own = u32::try_from(self.terms.len()).ok()?;
                    let terms = &program.terms[first as usize..(first + count) as usize];
                    self.terms.extend(terms.iter().map(|t| (t.coefficient.high, at(t.register))));
                    let constant = program.constants[constant as usize].high;
                    Instruction::Linear { constant, first: own, count, to }
                }
                Op::Scale(a, b) | Op::Multiply(a, b) => {
                    Instruction::Multiply { a: at(a), b: at(b), to }
                }
                Op::Square(a) => Instruction::Multiply { a: at(a), b: at(a), to },
                Op::Divide(a, b) => Instruction::Divide { a: at(a), b: at(b), to },
                Op::Root(a) => Instruction::Root { a: at(a), to },
                _ => Instruction::Other { half, operation, to },
            });
        }
        self.places[usize::from(half)] = places;
        Some(list)
    }

    /// Whether a rate of one half is a number that the same half moves.
    fn moves_its_rates(&self, half: bool) -> bool {
        let moves = self.moves(half, 0);
        let moved = |place: u8| {
            moves.iter().any(|i| matches!(i, Instruction::Move { number, .. } if *number == place))
        };
        moves.iter().any(|i| matches!(i, Instruction::Move { rate, .. } if moved(*rate)))
    }

    /// The sums that move what one half moves, by the factor of this index.
    fn moves(&self, half: bool, factor: usize) -> Vec<Instruction> {
        let rates = &self.halves[usize::from(half)];
        let places = &self.places[usize::from(half)];
        let outputs = rates.places.iter().zip(&rates.program.outputs);
        let moved = outputs.map(|(&number, &r)| Instruction::Move {
            factor: factor as u8,
            rate: places[r as usize],
            number: number as u8,
        });
        moved.collect()
    }

    /// Sets the parameters. Must be called before the first step.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        for half in &mut self.halves {
            half.set_parameters(parameters);
        }
        self.suits = self.halves.iter().all(|half| half.values.is_ordinary());
        for &(half, operation, to) in &self.fixed {
            self.registers[usize::from(to)] =
                self.halves[usize::from(half)].values.register(operation);
        }
    }

    /// Moves the numbers of a state by `count` steps, at least one. Returns false, with the state
    /// unchanged, where a number is or may be not what single steps give.
    #[must_use]
    pub fn advance(&mut self, step: f64, count: u64, state: &mut State) -> bool {
        if !self.suits || count == 0 {
            return false;
        }
        let numbers = state.values.len();
        self.registers[..numbers].copy_from_slice(&state.values);
        self.carries[..numbers].copy_from_slice(&state.carry);
        let mut before = 0.0;
        for (k, &w) in self.weights.iter().enumerate() {
            self.factors[2 * k] = 0.5 * (before + w) * step;
            self.factors[2 * k + 1] = w * step;
            before = w;
        }
        self.factors[2 * self.weights.len()] = 0.5 * before * step;
        // the force at the beginning is what the stages compute last
        let force = self.stages.len() - self.kick_len();
        let mut machine = Machine {
            halves: &self.halves,
            places: &self.places,
            terms: &self.terms,
            registers: &mut self.registers,
            carries: &mut self.carries,
            factors: &self.factors,
        };
        machine.run(&self.stages[force..]);
        machine.run(&self.lead);
        for _ in 1..count {
            machine.run(&self.stages);
            machine.run(&self.turn);
        }
        machine.run(&self.stages);
        machine.run(&self.close);
        // what is not finite stays so
        let end = (&self.registers[..numbers], &self.carries[..numbers]);
        if !end.0.iter().chain(end.1).all(|x| x.is_finite()) {
            return false;
        }
        state.values.copy_from_slice(end.0);
        state.carry.copy_from_slice(end.1);
        true
    }

    /// The number of operations of a kick.
    fn kick_len(&self) -> usize {
        let moved = |i: &&Instruction| !matches!(i, Instruction::Move { .. });
        self.stages.iter().rev().take_while(moved).count()
    }
}

/// A sum that ends a step, followed by the one that begins the next.
fn twice(instruction: Instruction) -> Instruction {
    match instruction {
        Instruction::Move { factor, rate, number } => {
            Instruction::MoveTwice { factors: [factor, 0], rate, number }
        }
        other => other,
    }
}

/// Which operations the outputs of a program need. `None` if one of them is not for a list: the
/// time, or a block of equations.
fn needed(program: &Program) -> Option<Vec<bool>> {
    let mut needed = vec![false; program.ops.len()];
    for &r in &program.outputs {
        needed[r as usize] = true;
    }
    for r in (0..program.ops.len()).rev() {
        if !needed[r] || program.fixed[r] {
            continue;
        }
        let mut need = |list: &[Register]| list.iter().for_each(|&a| needed[a as usize] = true);
        match program.ops[r] {
            Op::Time | Op::Solve(_) => return None,
            Op::Constant(_) | Op::Parameter(_) | Op::Input(_) => {}
            Op::Linear { first, count, .. } => {
                let terms = &program.terms[first as usize..(first + count) as usize];
                for term in terms {
                    need(&[term.register]);
                }
            }
            Op::Scale(a, b) | Op::Multiply(a, b) | Op::Divide(a, b) | Op::ParametricPower(a, b) => {
                need(&[a, b]);
            }
            Op::Square(a) | Op::Root(a) | Op::Power(a, _) => need(&[a]),
            // with its companion
            Op::Call(_, arguments) => {
                need(&arguments);
                needed[r + 1] = true;
            }
            Op::Select { switch, positive, negative, .. } => need(&[switch, positive, negative]),
            Op::Written => need(&[r as Register - 1]),
        }
    }
    Some(needed)
}

/// Runs instructions.
struct Machine<'a> {
    halves: &'a [Rates; 2],
    places: &'a [Places; 2],
    terms: &'a [(f64, u8)],
    registers: &'a mut [f64; REGISTERS],
    carries: &'a mut [f64; REGISTERS],
    factors: &'a [f64; REGISTERS],
}

impl Machine<'_> {
    #[inline(always)]
    fn run(&mut self, list: &[Instruction]) {
        let at = usize::from;
        for instruction in list {
            match *instruction {
                Instruction::Linear { constant, first, count, to } => {
                    let mut sum = constant;
                    for &(coefficient, r) in &self.terms[first as usize..][..count as usize] {
                        sum += self.registers[at(r)] * coefficient;
                    }
                    self.registers[at(to)] = sum;
                }
                Instruction::Multiply { a, b, to } => {
                    self.registers[at(to)] = self.registers[at(a)] * self.registers[at(b)];
                }
                Instruction::Divide { a, b, to } => {
                    self.registers[at(to)] = self.registers[at(a)] / self.registers[at(b)];
                }
                Instruction::Root { a, to } => {
                    self.registers[at(to)] = self.registers[at(a)].sqrt();
                }
                Instruction::Other { half, operation, to } => self.other(half, operation, to),
                Instruction::Move { factor, rate, number } => {
                    let rate = self.registers[at(rate)];
                    self.add(number, self.factors[at(factor)], rate);
                }
                Instruction::MoveTwice { factors: [last, first], rate, number } => {
                    let rate = self.registers[at(rate)];
                    self.add(number, self.factors[at(last)], rate);
                    self.add(number, self.factors[at(first)], rate);
                }
            }
        }
    }

    #[inline(always)]
    fn add(&mut self, number: u8, factor: f64, rate: f64) {
        if rate != 0.0 {
            let number = usize::from(number);
            let (value, carry) = (&mut self.registers[number], &mut self.carries[number]);
            accumulate(value, carry, factor * rate);
        }
    }

    #[inline(never)]
    fn other(&mut self, half: bool, operation: Register, to: u8) {
        let program = &self.halves[usize::from(half)].program;
        let places = &self.places[usize::from(half)];
        let get = |r: Register| self.registers[usize::from(places[r as usize])];
        let op = program.ops[operation as usize];
        if let Some((value, companion)) = value_of(program, op, get) {
            self.registers[usize::from(to)] = value;
            if let Some(companion) = companion {
                self.registers[usize::from(to) + 1] = companion;
            }
        }
    }
}
