//! Which registers of a program are read as whole series.
//!
//! In: a program. Out: the registers, and the place of each among their series. Never here: numbers.

use crate::system::program::{Op, PARAMETRIC_POWER_BITS, Program, Register};

/// The registers that are read as whole series.
#[derive(Debug)]
pub(super) struct SeriesIndex {
    pub(super) registers: Vec<Register>,
    /// Those that are copies of registers, each with its place among all. The factors of a parametric power are stored
    /// nowhere else.
    pub(super) copies: Vec<(Register, u32)>,
    /// For each register of the program, its place among these; [`NOWHERE`] if it has none.
    places: Vec<u32>,
}

/// The place of a register that is not read as a series.
const NOWHERE: u32 = u32::MAX;

impl SeriesIndex {
    /// The switches, the guards, the arguments of functions, all factors of parametric powers, and
    /// the outputs if these are read.
    pub(super) fn of(program: &Program, outputs: bool) -> SeriesIndex {
        let mut wanted = vec![false; program.ops.len()];
        let mut factors = wanted.clone();
        let mut keep = |register: Register| wanted[register as usize] = true;
        program.switches.iter().copied().for_each(&mut keep);
        for guard in &program.guards {
            keep(guard.value);
            guard.under.into_iter().for_each(&mut keep);
        }
        if outputs {
            program.outputs.iter().copied().for_each(&mut keep);
        }
        for (register, op) in (0..).zip(&program.ops) {
            match *op {
                Op::Call(_, [argument, _]) => keep(argument),
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
        let registers: Vec<Register> =
            (0..).zip(&wanted).filter_map(|(r, wanted)| wanted.then_some(r)).collect();
        let mut places = vec![NOWHERE; wanted.len()];
        for (place, &register) in (0..).zip(&registers) {
            places[register as usize] = place;
        }
        let copies = (0..).zip(&registers).filter(|&(_, &register)| !factors[register as usize]);
        let copies = copies.map(|(place, &register)| (register, place)).collect();
        SeriesIndex { registers, copies, places }
    }

    /// Where the series of a register begins, if they are `stride` apart.
    pub(super) fn start(&self, register: Register, stride: usize) -> usize {
        self.places[register as usize] as usize * stride
    }
}
