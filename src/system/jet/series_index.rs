//! Which registers of a program are read as whole series.
//!
//! In: a program. Out: the registers, and the place of each among their series. Never here: numbers.

use std::collections::BTreeMap;

use crate::expr::FunctionId;
use crate::system::program::{Guard, Op, PARAMETRIC_POWER_BITS, Program, Register};

#[derive(Debug)]
pub(super) struct SeriesIndex {
    pub(super) registers: Vec<Register>,
    /// Those that are copies of registers, each with its place among all. The factors of a parametric power are stored
    /// nowhere else.
    pub(super) copies: Vec<(Register, u32)>,
    /// The functions that are not constant, each with its argument.
    pub(super) arguments: Vec<(FunctionId, Register)>,
    /// The bases of high negative powers.
    pub(super) steep_poles: Vec<SteepPole>,
    /// What is divided by.
    pub(super) divisors: Vec<Register>,
    /// The arguments of tangents, each with what is to be taken from it to have the pole at π/2.
    pub(super) tangents: Vec<(Register, f64)>,
    /// For each register of the program, its place among these; [`NOWHERE`] if it has none.
    places: Vec<u32>,
}

/// A factor of high negative power, c/u^n.
#[derive(Clone, Copy, Debug)]
pub(super) struct SteepPole {
    pub(super) base: Register,
    pub(super) degree: PoleDegree,
    /// c, if it depends on parameters only; else it counts as 1.
    pub(super) above: Option<Register>,
}

/// The n of 1/u^n.
#[derive(Clone, Copy, Debug)]
pub(super) enum PoleDegree {
    Number(f64),
    /// Less the exponent, which depends on parameters.
    Parameter(Register),
}

/// The least degree of a pole whose power is below the range of `f64` where a motion may begin: u^−32 is beyond 10⁹.
const STEEP_POLE: f64 = 32.0;

/// The place of a register that is not read as a series.
const NOWHERE: u32 = u32::MAX;

impl SeriesIndex {
    /// The switches, the guards, the arguments of functions, the angles of points, the bases of high negative powers, all factors of parametric
    /// powers, and the outputs if these are read.
    pub(super) fn of(program: &Program, outputs: bool) -> SeriesIndex {
        let mut wanted = vec![false; program.ops.len()];
        let mut factors = wanted.clone();
        let mut keep = |register: Register| wanted[register as usize] = true;
        program.switches.iter().copied().for_each(&mut keep);
        for guard in &program.guards {
            keep(guard.value);
            guard.argument.into_iter().chain(guard.under).for_each(&mut keep);
        }
        if outputs {
            program.outputs.iter().copied().for_each(&mut keep);
        }
        for (register, op) in (0..).zip(&program.ops) {
            match *op {
                Op::Call(function, [argument, _]) => {
                    keep(argument);
                    if function == FunctionId::Atan2 {
                        keep(register);
                    }
                }
                Op::ParametricPower(base, _) => {
                    keep(base);
                    keep(register);
                    for factor in (register + 1..).take(2 * PARAMETRIC_POWER_BITS) {
                        keep(factor);
                        factors[factor as usize] = true;
                    }
                }
                _ => {}
            }
        }
        let steep_poles = steep_poles(program);
        for pole in &steep_poles {
            wanted[pole.base as usize] = true;
        }
        let divisors = divisors(program);
        for &divisor in &divisors {
            wanted[divisor as usize] = true;
        }
        let registers: Vec<Register> =
            (0..).zip(&wanted).filter_map(|(r, wanted)| wanted.then_some(r)).collect();
        let mut places = vec![NOWHERE; wanted.len()];
        for (place, &register) in (0..).zip(&registers) {
            places[register as usize] = place;
        }
        let copies = (0..).zip(&registers).filter(|&(_, &register)| !factors[register as usize]);
        let copies = copies.map(|(place, &register)| (register, place)).collect();
        let calls = program.body.iter().map(|&r| program.ops[r as usize]);
        let arguments = calls.filter_map(|op| match op {
            Op::Call(function, [argument, _]) => Some((function, argument)),
            _ => None,
        });
        let arguments: Vec<(FunctionId, Register)> = arguments.collect();
        let tangents = arguments.iter().filter_map(|&(function, u)| match function {
            FunctionId::Tan => Some((u, 0.0)),
            FunctionId::Cot => Some((u, std::f64::consts::FRAC_PI_2)),
            _ => None,
        });
        let tangents = tangents.collect();
        SeriesIndex { registers, copies, arguments, steep_poles, divisors, tangents, places }
    }

    /// Where the series of a register begins, if they are `stride` apart.
    pub(super) fn start(&self, register: Register, stride: usize) -> usize {
        self.places[register as usize] as usize * stride
    }
}

fn steep_poles(program: &Program) -> Vec<SteepPole> {
    let mut poles = Vec::new();
    for &r in &program.body {
        match program.ops[r as usize] {
            Op::Divide(above, below) => {
                let high = |&(_, degree): &(Register, f64)| degree >= STEEP_POLE;
                let factors = factors(program, below).into_iter().filter(high);
                poles.extend(factors.map(|(base, degree)| SteepPole {
                    base,
                    degree: PoleDegree::Number(degree),
                    above: program.fixed[above as usize].then_some(above),
                }));
            }
            Op::Power(base, exponent) => {
                let degree = -program.constants[exponent as usize].high;
                if degree >= STEEP_POLE {
                    poles.push(SteepPole { base, degree: PoleDegree::Number(degree), above: None });
                }
            }
            Op::ParametricPower(base, exponent) => {
                let degree = PoleDegree::Parameter(exponent);
                poles.push(SteepPole { base, degree, above: None });
            }
            _ => {}
        }
    }
    poles
}

/// The varying factors of what is divided by, each once.
fn divisors(program: &Program) -> Vec<Register> {
    let mut divisors = Vec::new();
    for &r in &program.body {
        let below = match program.ops[r as usize] {
            Op::Divide(_, below) if !program.fixed[below as usize] => factors(program, below),
            Op::Power(base, exponent) if program.constants[exponent as usize].high < 0.0 => {
                vec![(base, 1.0)]
            }
            _ => continue,
        };
        divisors.extend(below.into_iter().map(|(base, _)| base));
    }
    // a root is checked where it may vanish: with it vanishes what it divides, as in v/|v| of friction where a velocity touches zero
    divisors.retain(|&r| {
        // what a parameter decides may be a pole
        let is_of = |guard: &Guard| {
            let is_root = guard.exponent.is_none();
            is_root && (guard.value == r || guard.argument == Some(r) || guard.under == Some(r))
        };
        !program.guards.iter().any(is_of)
    });
    divisors.sort_unstable();
    divisors.dedup();
    divisors
}

/// The varying factors that are multiplied in a register, each with its degree.
fn factors(program: &Program, register: Register) -> Vec<(Register, f64)> {
    // operations follow those of their parts
    let mut open = BTreeMap::from([(register, 1.0)]);
    let mut found = Vec::new();
    while let Some((r, degree)) = open.pop_last() {
        let mut part = |part: Register, degree: f64| *open.entry(part).or_insert(0.0) += degree;
        match program.ops[r as usize] {
            Op::Square(a) => part(a, 2.0 * degree),
            Op::Scale(_, a) => part(a, degree),
            Op::Multiply(a, b) => {
                part(a, degree);
                part(b, degree);
            }
            _ => found.push((r, degree)),
        }
    }
    found
}
